//! The Cartesian diagram of a luminaire: intensity over the angle from the axis, linear or logarithmic.

use super::angular::{self, AngularCurve};
use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT, Ticks};
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Point, Rect, SOFT, Sheet, WHITE, clean};
use super::{clip, font};

/// A fraction of the maximum, and where each curve passes it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IntensityLevel {
    /// Written at its line, such as `50 %`.
    pub name: String,
    /// The value at which a line is drawn.
    pub value: f64,
    /// Marks on the curves: signed angle in degrees, and value.
    pub marks: Vec<(f64, f64)>,
}

/// Intensity curves over the signed angle from the axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CartesianPanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// At most [`super::MOST_ANGULAR_CURVES`] stay apart.
    pub curves: Vec<AngularCurve>,
    /// Quantity and unit of the values, such as `I [cd/klm]`.
    pub value_label: String,
    /// Quantity and unit of the angle, such as `γ [°]`.
    pub angle_label: String,
    /// Levels such as 50 % and 10 % of the maximum.
    pub levels: Vec<IntensityLevel>,
    /// First and last angle, degrees.
    pub range_deg: (f64, f64),
    /// Logarithmic values, four decades from the largest downwards.
    pub logarithmic: bool,
}

/// Decades of a logarithmic axis.
const DECADES: i32 = 4;
const LEVEL: Ink = Ink::grey(110);

impl CartesianPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let names: Vec<&str> = self.curves.iter().map(|c| c.name.as_str()).collect();
        let top = angular::legend(sheet, area, top, &names, "");
        let (low_deg, high_deg) = self.range_deg;
        let (low, high) = self.extent();
        let power = axis::exponent(high.max(-low));
        let (low, high) = (axis::divided(low, power), axis::divided(high, power));
        let mut plot = Rect::new(
            0.0,
            top + if power == 0 { 8.0 } else { 24.0 },
            area.x1 - MARGIN - 14.0,
            area.y1 - MARGIN - BELOW,
        );
        let y = if self.logarithmic { decades(high, plot) } else { linear(low, high, plot) };
        plot.x0 = area.x0 + MARGIN + AXIS_TEXT + 22.0 + y.width();
        let x = Scale::new(low_deg, high_deg, plot.x0, plot.x1);
        let step = angular::angle_step(high_deg - low_deg, (plot.width() / 40.0).floor());
        let x_ticks = Ticks::multiples(low_deg, high_deg, step);

        for v in &x_ticks.values {
            sheet.line((x.at(*v), plot.y0), (x.at(*v), plot.y1), 1.0, GRID);
        }
        for v in y.fine.iter().chain(y.labels.iter().map(|l| &l.0)) {
            sheet.line((plot.x0, y.at(*v)), (plot.x1, y.at(*v)), 1.0, GRID);
        }
        if y.scale.low < 0.0 && !self.logarithmic {
            sheet.line((plot.x0, y.at(0.0)), (plot.x1, y.at(0.0)), 1.0, FRAME);
        }
        for (i, curve) in self.curves.iter().enumerate() {
            let points: Vec<Point> = curve.samples().map(|(a, v)| (x.at(a), y.at(axis::divided(v, power)))).collect();
            for part in clip::line(&points, plot) {
                angular::trace(sheet, i, &part);
            }
        }
        for level in &self.levels {
            Self::level(sheet, level, plot, x, &y, power);
        }
        sheet.frame(plot, 1.2, FRAME);
        axis::below(sheet, plot, x, &x_ticks, &clean(&self.angle_label));
        self.left(sheet, area, plot, &y);
        if power != 0 {
            let start = plot.x0 - 9.0 - y.width();
            sheet.text((start, plot.y0 - 9.0), &axis::power_of_ten(power), TICK_TEXT, DARK, Align::Start);
        }
    }

    /// Least (at most zero) and largest value.
    fn extent(&self) -> (f64, f64) {
        let within = |s: &(f64, f64)| (self.range_deg.0..=self.range_deg.1).contains(&s.0);
        let values = self.curves.iter().flat_map(AngularCurve::samples).filter(within);
        values.fold((0.0, 0.0), |(low, high): (f64, f64), s| (low.min(s.1), high.max(s.1)))
    }

    /// A line across at the level's value, and a ring where each curve passes its own.
    fn level(sheet: &mut Sheet, level: &IntensityLevel, plot: Rect, x: Scale, y: &Values, power: i32) {
        let height = y.at(axis::divided(level.value, power));
        if !(plot.y0..=plot.y1).contains(&height) {
            return;
        }
        sheet.dashed(&[(plot.x0, height), (plot.x1, height)], &[5.0, 4.0], 1.0, LEVEL);
        let marks = level.marks.iter().map(|(a, v)| (x.at(*a), y.at(axis::divided(*v, power))));
        for at in marks.filter(|p| plot.contains(*p)) {
            sheet.disc(at, 4.2, SOFT);
            sheet.disc(at, 2.8, WHITE);
        }
        let text = super::sheet::Text {
            at: (plot.x1 - 5.0, height - 4.0),
            text: clean(&level.name),
            size: TICK_TEXT,
            ink: SOFT,
            align: Align::End,
            turned: false,
        };
        sheet.fill(text.bounds().corners().to_vec(), WHITE.alpha(0.75));
        sheet.write(text);
    }

    fn left(&self, sheet: &mut Sheet, area: Rect, plot: Rect, y: &Values) {
        for (v, label) in &y.labels {
            let height = y.at(*v);
            sheet.line((plot.x0 - 5.0, height), (plot.x0, height), 1.0, FRAME);
            sheet.text((plot.x0 - 9.0, height + 0.36 * TICK_TEXT), label, TICK_TEXT, DARK, Align::End);
        }
        axis::upright(sheet, plot, &clean(&self.value_label), area.x0 + MARGIN + AXIS_TEXT);
    }
}

/// The axis of the values; the scale of a logarithmic one counts in decades.
struct Values {
    scale: Scale,
    labels: Vec<(f64, String)>,
    /// Values with a line and no label.
    fine: Vec<f64>,
    logarithmic: bool,
}

impl Values {
    fn at(&self, value: f64) -> f64 {
        if !self.logarithmic {
            return self.scale.at(value);
        }
        // A zero lies far below the axis; where the line to it goes is cut off.
        self.scale.at(value.max(1e-12 * 10f64.powf(self.scale.high)).log10())
    }

    fn width(&self) -> f64 {
        self.labels.iter().map(|l| font::width(&l.1, TICK_TEXT)).fold(0.0, f64::max)
    }
}

fn linear(low: f64, high: f64, plot: Rect) -> Values {
    let span = if high > low { high - low } else { 1.0 };
    let below = if low < 0.0 { 0.05 * span } else { 0.0 };
    let scale = Scale::new(low - below, low + span * 1.05, plot.y1, plot.y0);
    let ticks = scale.ticks(48.0);
    let labels = ticks.values.iter().map(|v| (*v, ticks.label(*v))).collect();
    Values { scale, labels, fine: Vec::new(), logarithmic: false }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few decades")]
fn decades(high: f64, plot: Rect) -> Values {
    let top = if high > 0.0 { (high * 1.1).log10() } else { 1.0 };
    let first = top.ceil() as i32 - DECADES;
    let scale = Scale::new(f64::from(first), top, plot.y1, plot.y0);
    let powers = first..=top.floor() as i32;
    let labels = powers.clone().map(|p| (10f64.powi(p), axis::number(10f64.powi(p), (-p).max(0) as usize))).collect();
    let fine = powers.flat_map(|p| (2..10).map(move |i| f64::from(i) * 10f64.powi(p)));
    let fine = fine.filter(|v| v.log10() < top).collect();
    Values { scale, labels, fine, logarithmic: true }
}
