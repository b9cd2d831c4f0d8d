//! The spectrum panel: what it takes, its axes, its column of key figures.

use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT};
use super::font;
use super::sheet::{Align, DARK, FRAME, Ink, Rect, SOFT, Sheet, clean};
use super::spectrum_curves as curves;

/// How the values of a curve are to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CurveKind {
    /// A density over wavelength, drawn as a line; missing values (NaN) leave a gap.
    #[default]
    Density,
    /// Separate spectral lines, drawn as sticks.
    Lines,
}

/// Values at wavelengths.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// For the legend, which appears with the second curve.
    pub name: String,
    /// Wavelengths in nanometres, in any order.
    pub wavelengths_nm: Vec<f64>,
    /// One value for each wavelength, in the unit that the panel's `value_label` names.
    pub values: Vec<f64>,
    /// Density or lines.
    pub kind: CurveKind,
}

impl Curve {
    /// A density over wavelength.
    pub fn density(name: impl Into<String>, wavelengths_nm: Vec<f64>, values: Vec<f64>) -> Self {
        Self { name: name.into(), wavelengths_nm, values, kind: CurveKind::Density }
    }

    /// Separate spectral lines.
    pub fn lines(name: impl Into<String>, wavelengths_nm: Vec<f64>, values: Vec<f64>) -> Self {
        Self { name: name.into(), wavelengths_nm, values, kind: CurveKind::Lines }
    }

    /// Pairs with a finite wavelength, by rising wavelength; values may still be NaN.
    pub(super) fn samples(&self) -> Vec<(f64, f64)> {
        let pairs = self.wavelengths_nm.iter().copied().zip(self.values.iter().copied());
        let mut out: Vec<(f64, f64)> = pairs.filter(|s| s.0.is_finite()).collect();
        out.sort_by(|a, b| a.0.total_cmp(&b.0));
        out
    }
}

/// A relative curve with its own axis from 0 to 1 on the right, such as V(λ).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Weighting {
    /// Written at the curve and at its axis.
    pub name: String,
    /// Wavelength in nanometres and relative value.
    pub samples: Vec<(f64, f64)>,
}

/// Spectral curves over wavelength.
///
/// A single curve is filled with the `colours` of its wavelengths; several are drawn as coloured lines with a legend.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpectrumPanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// The curves, the first drawn lowest.
    pub curves: Vec<Curve>,
    /// Quantity and unit of the values, such as `spectral irradiance [W/(m²·nm)]`.
    pub value_label: String,
    /// Wavelength in nanometres and the sRGB colour standing for it; without any, the area is grey.
    pub colours: Vec<(f64, [u8; 3])>,
    /// A curve such as V(λ) to be drawn dashed over the others.
    pub weighting: Option<Weighting>,
    /// Lines of key figures, such as `500 lx`; they stand in a column on the right.
    pub figures: Vec<String>,
    /// First and last wavelength in nanometres; without it the range of the data and at least 380 to 780 nm.
    pub range_nm: Option<(f64, f64)>,
}

/// Size of key figures and legend.
const FIGURE_TEXT: f64 = 15.0;
const LEGEND_TEXT: f64 = 13.0;
const LINE: f64 = 1.5;

impl SpectrumPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let (low_nm, high_nm) = self.range();
        let (low, high, power) = self.values_in(low_nm, high_nm);
        let column = self.column_width(area);
        let right_axis = if self.weighting.is_some() { 54.0 } else { 18.0 };

        let head = if power == 0 { 8.0 } else { 24.0 };
        let mut plot = Rect::new(0.0, top + head, area.x1 - MARGIN - column - right_axis, area.y1 - MARGIN - BELOW);
        let (floor, ceiling) = padded(low, high);
        let y = Scale::new(floor, ceiling, plot.y1, plot.y0);
        let y_ticks = y.ticks(48.0);
        plot.x0 = area.x0 + MARGIN + AXIS_TEXT + 22.0 + y_ticks.width();
        let x = Scale::new(low_nm, high_nm, plot.x0, plot.x1);
        let x_ticks = x.ticks(80.0);

        axis::grid(sheet, plot, (x, &x_ticks), (y, &y_ticks));
        curves::draw(sheet, self, plot, x, y, power);
        if floor < 0.0 {
            sheet.line((plot.x0, y.at(0.0)), (plot.x1, y.at(0.0)), 1.0, FRAME);
        }
        let taken = curves::outline_heights(self, plot, x, y, power);
        if let Some(weighting) = &self.weighting {
            let zero_and_one = if high >= 0.3 * (high - low) && high > 0.0 {
                (y.at(0.0), y.at(high))
            } else {
                (plot.y1, plot.y0 + 0.08 * plot.height())
            };
            let scale = Scale::new(0.0, 1.0, zero_and_one.0, zero_and_one.1);
            right(sheet, plot, scale, &weighting.name);
            curves::weighting(sheet, weighting, plot, x, scale, &taken);
        }
        sheet.frame(plot, 1.2, FRAME);
        axis::below(sheet, plot, x, &x_ticks, "wavelength [nm]");
        axis::left(sheet, plot, y, &y_ticks, &clean(&self.value_label), area.x0 + MARGIN + AXIS_TEXT);
        if power != 0 {
            let start = plot.x0 - 9.0 - y_ticks.width();
            sheet.text((start, plot.y0 - 9.0), &axis::power_of_ten(power), TICK_TEXT, DARK, Align::Start);
        }
        self.remark(sheet, plot, low, high);
        let left = area.x1 - MARGIN - column + 18.0;
        self.column(sheet, Rect::new(left, plot.y0, area.x1 - MARGIN, area.y1 - MARGIN));
    }

    fn range(&self) -> (f64, f64) {
        if let Some((a, b)) = self.range_nm {
            let (low, high) = (a.min(b), a.max(b));
            if low.is_finite() && high.is_finite() && low < high {
                return (low, high);
            }
        }
        let all = self.curves.iter().flat_map(|c| &c.wavelengths_nm).copied().filter(|w| w.is_finite());
        let (low, high) = extent(all).unwrap_or((380.0, 780.0));
        if low < 830.0 && high > 360.0 {
            (low.min(380.0), high.max(780.0))
        } else if high - low > 1e-6 * high.abs() {
            (low, high)
        } else {
            (low - 50.0f64.max(0.1 * low.abs()), high + 50.0f64.max(0.1 * high.abs()))
        }
    }

    /// Least and largest value shown (and zero), divided by ten to the power that comes with them.
    fn values_in(&self, low_nm: f64, high_nm: f64) -> (f64, f64, i32) {
        let shown = self.curves.iter().flat_map(Curve::samples).filter(|s| (low_nm..=high_nm).contains(&s.0));
        let (low, high) = extent(shown.map(|s| s.1).filter(|v| v.is_finite())).unwrap_or((0.0, 0.0));
        let power = axis::exponent(low.abs().max(high.abs()));
        (axis::divided(low.min(0.0), power), axis::divided(high.max(0.0), power), power)
    }

    fn remark(&self, sheet: &mut Sheet, plot: Rect, low: f64, high: f64) {
        let empty = !self.curves.iter().flat_map(|c| c.wavelengths_nm.iter().zip(&c.values)).any(|s| s.1.is_finite());
        let remark = match (empty, low == 0.0 && high == 0.0) {
            (true, _) => "no values",
            (_, true) => "all values are zero",
            _ => return,
        };
        let middle = ((plot.x0 + plot.x1) / 2.0, plot.y0 + 0.8 * plot.height());
        sheet.text(middle, remark, FIGURE_TEXT, SOFT, Align::Middle);
    }

    fn column_width(&self, area: Rect) -> f64 {
        let figures = self.figures.iter().map(|f| font::width(&clean(f), FIGURE_TEXT));
        let names = self.curves.iter().map(|c| font::width(&clean(&c.name), LEGEND_TEXT) + 34.0);
        let names = names.filter(|_| self.curves.len() > 1);
        let widest = figures.chain(names).fold(0.0, f64::max);
        if widest == 0.0 { 0.0 } else { (widest + 22.0).min(0.26 * area.width()) }
    }

    /// Key figures, and under them the legend.
    fn column(&self, sheet: &mut Sheet, r: Rect) {
        let mut y = r.y0;
        for figure in &self.figures {
            for line in font::wrap(&clean(figure), FIGURE_TEXT, r.width()) {
                if y + FIGURE_TEXT * LINE > r.y1 {
                    return;
                }
                sheet.text((r.x0, y + FIGURE_TEXT), &line, FIGURE_TEXT, DARK, Align::Start);
                y += FIGURE_TEXT * LINE;
            }
            y += 3.0;
        }
        if self.curves.len() < 2 {
            return;
        }
        y += if self.figures.is_empty() { 0.0 } else { 8.0 };
        let step = LEGEND_TEXT * LINE;
        for (i, curve) in self.curves.iter().enumerate() {
            let left = self.curves.len() - i;
            if left > 1 && y + 2.0 * step > r.y1 {
                sheet.text((r.x0, y + LEGEND_TEXT), &format!("and {left} more"), LEGEND_TEXT, SOFT, Align::Start);
                return;
            }
            let (ink, dash) = curves::style(i, self.curves.len());
            let middle = y + 0.62 * LEGEND_TEXT;
            curves::trace(sheet, &[(r.x0, middle), (r.x0 + 26.0, middle)], 2.4, ink, dash);
            let name = font::fit(&clean(&curve.name), LEGEND_TEXT, r.width() - 34.0);
            sheet.text((r.x0 + 34.0, y + LEGEND_TEXT), &name, LEGEND_TEXT, DARK, Align::Start);
            y += step;
        }
    }
}

/// The axis of the weighting curve.
fn right(sheet: &mut Sheet, plot: Rect, scale: Scale, name: &str) {
    const INK: Ink = curves::WEIGHTING;
    let ticks = scale.ticks(40.0);
    for &v in &ticks.values {
        let y = scale.at(v);
        sheet.line((plot.x1, y), (plot.x1 + 5.0, y), 1.0, FRAME);
        sheet.text((plot.x1 + 9.0, y + 0.36 * TICK_TEXT), &ticks.label(v), TICK_TEXT, INK, Align::Start);
    }
    let middle = (scale.at(0.0) + scale.at(1.0)) / 2.0;
    let at = (plot.x1 + 13.0 + ticks.width() + AXIS_TEXT, middle);
    let room = (scale.at(0.0) - scale.at(1.0)).abs();
    sheet.text_up(at, &font::fit(&clean(name), AXIS_TEXT, room), AXIS_TEXT, INK, Align::Middle);
}

/// Some air above the highest and below the lowest value.
fn padded(low: f64, high: f64) -> (f64, f64) {
    let span = high - low;
    if span == 0.0 {
        return (0.0, 1.0);
    }
    let below = if low < 0.0 { 0.07 * span } else { 0.0 };
    (low - below, high + 0.07 * span)
}

fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |e, v| Some(e.map_or((v, v), |(a, b): (f64, f64)| (a.min(v), b.max(v)))))
}
