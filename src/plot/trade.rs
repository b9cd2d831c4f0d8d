//! The panel of a trade: the guaranteed error of settings over their time, both logarithmic, with the front of those that nothing
//! beats.

use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT};
use super::lobe::COLOURS;
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Rect, Sheet};
use crate::trade::{Measure, Sweep};

/// Decades of error shown at most.
const DECADES: f64 = 8.0;
/// What is free of error is drawn on this line.
const LOWEST: f64 = 1e-16;

/// Dots, a front and a target.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TradePanel {
    /// Above the drawing.
    pub title: String,
    /// Beside the vertical axis, with its unit.
    pub y_label: String,
    /// Seconds and error of all.
    pub dots: Vec<(f64, f64)>,
    /// Those of the front, from the fastest on.
    pub front: Vec<(f64, f64)>,
    /// The one that is recommended.
    pub recommended: Option<(f64, f64)>,
    /// The error asked for.
    pub target: Option<f64>,
}

/// The panel of a sweep, for one of its figures.
#[must_use]
pub fn trade_panel(sweep: &Sweep, title: &str, figure: usize, target: Option<f64>) -> TradePanel {
    let point = |i: usize| Some((sweep.trials[i].timing.median_s, sweep.bound(i, figure)?.max(LOWEST)));
    let Some(f) = sweep.figures.get(figure) else { return TradePanel::default() };
    let unit = match (f.measure, f.unit) {
        (Measure::Relative, _) => " (relative)".to_owned(),
        (_, "") => String::new(),
        (_, unit) => format!(" [{unit}]"),
    };
    TradePanel {
        title: title.to_owned(),
        y_label: format!("guaranteed error of {}{unit}", f.key),
        dots: (0..sweep.trials.len()).filter_map(point).collect(),
        front: sweep.front(figure).into_iter().filter_map(point).collect(),
        recommended: target.and_then(|t| sweep.recommend(figure, t)).and_then(point),
        target,
    }
}

impl TradePanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let seen = |p: &&(f64, f64)| p.0 > 0.0 && p.1 > 0.0 && p.0.is_finite() && p.1.is_finite();
        let decades = |of: fn(&(f64, f64)) -> f64, more: Option<f64>| {
            let all = || self.dots.iter().filter(seen).map(of).chain(more.filter(|v| *v > 0.0));
            let low = all().fold(f64::INFINITY, f64::min).log10().floor();
            let high = all().fold(0.0, f64::max).log10().ceil();
            (low, high.max(low + 1.0))
        };
        if !self.dots.iter().any(|p| seen(&p)) {
            return;
        }
        let (x_low, x_high) = decades(|p| p.0, None);
        let (y_low, y_high) = decades(|p| p.1, self.target);
        let y_low = y_low.max(y_high - DECADES);
        let plot = Rect::new(area.x0 + MARGIN + 66.0, top + 6.0, area.x1 - MARGIN - 8.0, area.y1 - MARGIN - BELOW);
        let (x, y) = (Scale::new(x_low, x_high, plot.x0, plot.x1), Scale::new(y_low, y_high, plot.y1, plot.y0));
        axes(sheet, plot, (x, x_low, x_high), (y, y_low, y_high));
        sheet.text((0.5 * (plot.x0 + plot.x1), plot.y1 + 42.0), "time [s]", AXIS_TEXT, DARK, Align::Middle);
        axis::upright(sheet, plot, &self.y_label, area.x0 + MARGIN + AXIS_TEXT);
        let place = |p: &(f64, f64)| (x.at(p.0.log10()), y.at(p.1.log10().max(y_low)));
        let [dot, best] = [0, 1].map(|i| Ink::rgb(COLOURS[i]));
        if let Some(target) = self.target.filter(|t| *t > 0.0) {
            let at = y.at(target.log10().max(y_low));
            sheet.line((plot.x0, at), (plot.x1, at), 1.6, DARK);
            sheet.text((plot.x1 - 6.0, at - 6.0), "asked for", TICK_TEXT, DARK, Align::End);
        }
        for point in self.dots.iter().filter(seen).map(place) {
            sheet.disc(point, 3.0, dot);
        }
        sheet.stroke(self.front.iter().filter(seen).map(place).collect(), 1.6, best);
        for point in self.front.iter().filter(seen).map(place) {
            sheet.disc(point, 4.0, best);
        }
        if let Some(point) = self.recommended.as_ref().map(place) {
            sheet.disc(point, 9.0, best);
            sheet.disc(point, 5.0, DARK);
        }
        sheet.frame(plot, 1.0, FRAME);
    }
}

/// A line and a label for every decade.
fn axes(sheet: &mut Sheet, plot: Rect, (x, x_low, x_high): (Scale, f64, f64), (y, y_low, y_high): (Scale, f64, f64)) {
    let label = |decade: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "a whole number below 400")]
        let text = axis::power_of_ten(decade as i32);
        text.replace('×', "")
    };
    let mut decade = x_low;
    while decade <= x_high {
        sheet.line((x.at(decade), plot.y0), (x.at(decade), plot.y1), 1.0, GRID);
        sheet.text((x.at(decade), plot.y1 + 18.0), &label(decade), TICK_TEXT, DARK, Align::Middle);
        decade += 1.0;
    }
    decade = y_low;
    while decade <= y_high {
        sheet.line((plot.x0, y.at(decade)), (plot.x1, y.at(decade)), 1.0, GRID);
        sheet.text((plot.x0 - 9.0, y.at(decade) + 0.36 * TICK_TEXT), &label(decade), TICK_TEXT, DARK, Align::End);
        decade += 1.0;
    }
}
