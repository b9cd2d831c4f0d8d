//! The level panel: where a figure lies between reference values, on a logarithmic axis.

use super::axis::{self, BELOW, MARGIN, Scale, TICK_TEXT, Ticks};
use super::font;
use super::lobe::COLOURS;
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Rect, SOFT, Sheet};

/// Room for the names of the reference values, one line each.
const NAME: f64 = 17.0;

/// A figure among reference values.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LevelPanel {
    /// Above the drawing.
    pub title: String,
    /// Name of the axis, with its unit.
    pub axis: String,
    /// Positive figures with their intervals, if known, and what is written beside them.
    pub figures: Vec<LevelFigure>,
    /// Positive reference values and their names.
    pub references: Vec<(f64, String)>,
}

/// One figure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LevelFigure {
    /// Its value.
    pub value: f64,
    /// Its interval.
    pub interval: Option<[f64; 2]>,
    /// What is written beside it.
    pub text: String,
}

impl LevelPanel {
    /// Height of a drawing of its own.
    pub(super) fn height(&self) -> f64 {
        let rows = 34.0 * self.figures.len() as f64 + NAME * self.references.len() as f64;
        // No picture is lower than the least side.
        (rows + BELOW + 2.0 * MARGIN + 36.0).max(f64::from(super::SIDES.0))
    }

    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title) + 6.0 + NAME * self.references.len() as f64;
        let plot = Rect::new(area.x0 + 3.0 * MARGIN, top, area.x1 - 3.0 * MARGIN, area.y1 - MARGIN - BELOW);
        let all = self.figures.iter().map(|f| f.value).chain(self.references.iter().map(|(v, _)| *v));
        let logs: Vec<f64> = all.filter(|v| *v > 0.0 && v.is_finite()).map(f64::log10).collect();
        let (low, high) = logs.iter().fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
        if low > high {
            return;
        }
        let (low, high) = ((low - 0.1).floor(), (high + 0.1).ceil());
        let x = Scale::new(low, high, plot.x0, plot.x1);
        let at = |value: f64| x.at(value.max(f64::MIN_POSITIVE).log10()).clamp(plot.x0, plot.x1);
        let mut ticks = Ticks::multiples(low, high, 1.0);
        for decade in std::mem::take(&mut ticks.values) {
            let end = x.at(decade);
            sheet.line((end, plot.y0), (end, plot.y1 + 5.0), 1.0, GRID);
            let label = axis::plain(10_f64.powf(decade));
            sheet.text((end, plot.y1 + 9.0 + 0.73 * TICK_TEXT), &label, TICK_TEXT, DARK, Align::Middle);
        }
        axis::below(sheet, plot, x, &ticks, &self.axis);
        for (i, (value, name)) in self.references.iter().enumerate() {
            let (end, y) = (at(*value), plot.y0 - 6.0 - NAME * (self.references.len() - 1 - i) as f64);
            sheet.dashed(&[(end, y - 9.0), (end, plot.y1)], &[6.0, 4.0], 1.6, SOFT);
            // On the side that has the room.
            let right = end < 0.5 * (plot.x0 + plot.x1);
            let room = if right { area.x1 - MARGIN - end } else { end - area.x0 - MARGIN };
            let text = font::fit(name, TICK_TEXT, room - 8.0);
            let (start, align) = if right { (end + 6.0, Align::Start) } else { (end - 6.0, Align::End) };
            sheet.text((start, y), &text, TICK_TEXT, DARK, align);
        }
        let step = plot.height() / self.figures.len().max(1) as f64;
        for (i, figure) in self.figures.iter().enumerate() {
            let (y, ink) = (plot.y0 + (i as f64 + 0.5) * step, Ink::rgb(COLOURS[i % COLOURS.len()]));
            if let Some([a, b]) = figure.interval {
                sheet.line((at(a), y), (at(b), y), 3.0, ink);
                for end in [at(a), at(b)] {
                    sheet.line((end, y - 6.0), (end, y + 6.0), 1.6, ink);
                }
            }
            let centre = at(figure.value);
            sheet.disc((centre, y), 5.0, ink);
            let ends = figure.interval.map_or(centre, |[_, b]| at(b));
            let right = ends + font::width(&figure.text, TICK_TEXT) + 22.0 < plot.x1;
            let beyond = figure.interval.map_or(centre, |[a, b]| at(if right { b } else { a }));
            let (start, align) = if right { (beyond + 11.0, Align::Start) } else { (beyond - 11.0, Align::End) };
            sheet.text((start, y + 0.36 * TICK_TEXT), &figure.text, TICK_TEXT, DARK, align);
        }
        sheet.frame(plot, 1.0, FRAME);
    }
}
