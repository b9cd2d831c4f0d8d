//! The curves panel: values over an angle, on a linear or a logarithmic scale.

use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT};
use super::font;
use super::lobe::COLOURS;
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Point, Rect, Sheet};

/// Lengths of dash and gap of what was not measured.
pub(super) const DASHES: [f64; 2] = [4.0, 3.0];
/// Decades shown at most on a logarithmic scale.
const DECADES: f64 = 8.0;

/// A named curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedCurve {
    /// Its name in the legend.
    pub name: String,
    /// Points in the order in which they are joined; NaN breaks the line.
    pub points: Vec<(f64, f64)>,
    /// Points of the same curve that are drawn dashed.
    pub dashed: Vec<(f64, f64)>,
}

/// Curves over one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CurvesPanel {
    /// Above the drawing.
    pub title: String,
    /// Below the horizontal axis, with its unit.
    pub x_label: String,
    /// Distance of the ticks of the horizontal axis; round values where it is not given.
    pub x_step: Option<f64>,
    /// Beside the vertical axis, with its unit.
    pub y_label: String,
    /// The curves.
    pub curves: Vec<NamedCurve>,
    /// Logarithmic values; those at or below 0 are not drawn.
    pub logarithmic: bool,
    /// A level to mark, such as an albedo of 1.
    pub level: Option<f64>,
    /// What dashes stand for: in the legend where a curve has some.
    pub dashes: String,
}

impl CurvesPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let points = || self.curves.iter().flat_map(|c| c.points.iter().chain(&c.dashed).copied());
        let (left, right) = points().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.0), b.max(p.0)));
        if left >= right {
            return;
        }
        let has_dashes = self.curves.iter().flat_map(|c| &c.dashed).any(|p| p.1.is_finite());
        let legend = 20.0 * (self.curves.len() + usize::from(has_dashes)) as f64;
        let plot = Rect::new(area.x0 + MARGIN + 66.0, top + legend, area.x1 - MARGIN - 8.0, area.y1 - MARGIN - BELOW);
        let x = Scale::new(left, right, plot.x0, plot.x1);
        let highest = points().map(|p| p.1).chain(self.level).filter(|v| v.is_finite()).fold(0.0_f64, f64::max);
        let shown = |v: f64| if self.logarithmic { v.log10() } else { v };
        let (low, high) = if self.logarithmic {
            let lowest = points().map(|p| p.1).filter(|v| *v > 0.0).fold(highest, f64::min);
            let high = highest.max(1e-300).log10().ceil();
            (lowest.max(1e-300).log10().floor().max(high - DECADES).min(high - 1.0), high)
        } else {
            (0.0, if highest > 0.0 { 1.06 * highest } else { 1.0 })
        };
        let y = Scale::new(low, high, plot.y1, plot.y0);
        let xs = self.x_step.map_or_else(|| x.ticks(70.0), |step| x.ticks_every(step));
        for &v in &xs.values {
            sheet.line((x.at(v), plot.y0), (x.at(v), plot.y1), 1.0, GRID);
        }
        let title_x = area.x0 + MARGIN + AXIS_TEXT;
        if self.logarithmic {
            let mut decade = low;
            while decade <= high {
                sheet.line((plot.x0, y.at(decade)), (plot.x1, y.at(decade)), 1.0, GRID);
                #[expect(clippy::cast_possible_truncation, reason = "a whole number below 400")]
                let label = axis::power_of_ten(decade as i32).replace('×', "");
                sheet.text((plot.x0 - 9.0, y.at(decade) + 0.36 * TICK_TEXT), &label, TICK_TEXT, DARK, Align::End);
                decade += 1.0;
            }
            axis::upright(sheet, plot, &self.y_label, title_x);
        } else {
            let ys = y.ticks(50.0);
            axis::grid(sheet, plot, (x, &xs), (y, &ys));
            axis::left(sheet, plot, y, &ys, &self.y_label, title_x);
        }
        axis::below(sheet, plot, x, &xs, &self.x_label);
        if let Some(level) = self.level {
            let height = y.at(shown(level));
            sheet.dashed(&[(plot.x0, height), (plot.x1, height)], &[7.0, 5.0], 1.5, FRAME);
        }
        for (i, curve) in self.curves.iter().enumerate() {
            let ink = Ink::rgb(COLOURS[i % COLOURS.len()]);
            let runs = |points: &[(f64, f64)]| -> Vec<Vec<Point>> {
                let place = |p: &(f64, f64)| (x.at(p.0), y.at(shown(p.1)));
                let seen = |p: &(f64, f64)| shown(p.1).is_finite() && shown(p.1) >= low;
                points.split(|p| !seen(p)).map(|run| run.iter().map(place).collect()).collect()
            };
            runs(&curve.dashed).iter().for_each(|run| sheet.dashed(run, &DASHES, 1.5, ink));
            runs(&curve.points).into_iter().for_each(|run| sheet.stroke(run, 2.0, ink));
            let line = top + 6.0 + 20.0 * i as f64;
            sheet.line((plot.x0, line), (plot.x0 + 26.0, line), 3.0, ink);
            let name = font::fit(&curve.name, TICK_TEXT, plot.width() - 40.0);
            sheet.text((plot.x0 + 34.0, line + 0.36 * TICK_TEXT), &name, TICK_TEXT, DARK, Align::Start);
        }
        if has_dashes {
            let line = top + 6.0 + 20.0 * self.curves.len() as f64;
            sheet.dashed(&[(plot.x0, line), (plot.x0 + 26.0, line)], &DASHES, 1.5, DARK);
            let words = font::fit(&self.dashes, TICK_TEXT, plot.width() - 40.0);
            sheet.text((plot.x0 + 34.0, line + 0.36 * TICK_TEXT), &words, TICK_TEXT, DARK, Align::Start);
        }
        sheet.frame(plot, 1.0, FRAME);
    }
}
