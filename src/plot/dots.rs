//! The panel of data against a model: dots for what was measured, lines for what is computed, on logarithmic values.

use super::axis::{self, AXIS_TEXT, BELOW, MARGIN, Scale, TICK_TEXT};
use super::font;
use super::lobe::COLOURS;
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Point, Rect, Sheet};

/// Decades shown at most.
const DECADES: f64 = 8.0;

/// Dots and the line that belongs to them, in one colour.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Its name in the legend; without one it has no line there.
    pub name: String,
    /// Measured.
    pub dots: Vec<(f64, f64)>,
    /// Computed, in the order in which the points are joined.
    pub line: Vec<(f64, f64)>,
}

/// Dots and lines over one axis; values at or below 0 are not drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DotsPanel {
    /// Above the drawing.
    pub title: String,
    /// Below the horizontal axis, with its unit.
    pub x_label: String,
    /// Beside the vertical axis, with its unit.
    pub y_label: String,
    /// The horizontal axis is logarithmic, too, and has the range of the vertical one.
    pub both_logarithmic: bool,
    /// What is drawn.
    pub series: Vec<Series>,
}

impl DotsPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let points = || self.series.iter().flat_map(|s| s.dots.iter().chain(&s.line).copied());
        let seen = |v: &f64| *v > 0.0 && v.is_finite();
        let highest = points().map(|p| p.1).filter(seen).fold(0.0, f64::max);
        if highest <= 0.0 {
            return;
        }
        let lowest = points().map(|p| p.1).filter(seen).fold(highest, f64::min);
        let high = highest.log10().ceil();
        let low = lowest.log10().floor().max(high - DECADES).min(high - 1.0);
        let named: Vec<(usize, &Series)> = self.series.iter().enumerate().filter(|(_, s)| !s.name.is_empty()).collect();
        let legend = 20.0 * named.len() as f64;
        let plot = Rect::new(area.x0 + MARGIN + 66.0, top + legend, area.x1 - MARGIN - 8.0, area.y1 - MARGIN - BELOW);
        let y = Scale::new(low, high, plot.y1, plot.y0);
        let x = if self.both_logarithmic {
            Scale::new(low, high, plot.x0, plot.x1)
        } else {
            let (left, right) = points().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.0), b.max(p.0)));
            Scale::new(left, right, plot.x0, plot.x1)
        };
        self.axes(sheet, plot, (x, low, high), y, area.x0 + MARGIN + AXIS_TEXT);
        let across = |v: f64| if self.both_logarithmic { v.log10() } else { v };
        let place = |p: &(f64, f64)| (x.at(across(p.0)), y.at(p.1.log10()));
        let inside = |p: &Point| p.0.is_finite() && p.1.is_finite() && plot.contains(*p);
        for (i, series) in self.series.iter().enumerate() {
            let ink = Ink::rgb(COLOURS[i % COLOURS.len()]);
            let radius = if series.dots.len() > 500 { 1.2 } else { 3.0 };
            for dot in series.dots.iter().map(place).filter(inside) {
                sheet.disc(dot, radius, ink);
            }
            let line = if self.both_logarithmic { FRAME } else { ink };
            let mut run: Vec<Point> = Vec::new();
            for point in series.line.iter().map(place) {
                if inside(&point) {
                    run.push(point);
                } else {
                    sheet.stroke(std::mem::take(&mut run), 1.6, line);
                }
            }
            sheet.stroke(run, 1.6, line);
        }
        for (row, (i, series)) in named.into_iter().enumerate() {
            let (ink, line) = (Ink::rgb(COLOURS[i % COLOURS.len()]), top + 6.0 + 20.0 * row as f64);
            sheet.line((plot.x0, line), (plot.x0 + 26.0, line), 1.6, ink);
            sheet.disc((plot.x0 + 13.0, line), 3.0, ink);
            let name = font::fit(&series.name, TICK_TEXT, plot.width() - 40.0);
            sheet.text((plot.x0 + 34.0, line + 0.36 * TICK_TEXT), &name, TICK_TEXT, DARK, Align::Start);
        }
        sheet.frame(plot, 1.0, FRAME);
    }

    fn axes(&self, sheet: &mut Sheet, plot: Rect, (x, low, high): (Scale, f64, f64), y: Scale, title_x: f64) {
        let mut decade = low;
        while decade <= high {
            #[expect(clippy::cast_possible_truncation, reason = "a whole number below 400")]
            let label = axis::power_of_ten(decade as i32).replace('×', "");
            sheet.line((plot.x0, y.at(decade)), (plot.x1, y.at(decade)), 1.0, GRID);
            sheet.text((plot.x0 - 9.0, y.at(decade) + 0.36 * TICK_TEXT), &label, TICK_TEXT, DARK, Align::End);
            if self.both_logarithmic {
                sheet.line((x.at(decade), plot.y0), (x.at(decade), plot.y1), 1.0, GRID);
                sheet.text((x.at(decade), plot.y1 + 18.0), &label, TICK_TEXT, DARK, Align::Middle);
            }
            decade += 1.0;
        }
        let ticks = x.ticks_every(30.0);
        if self.both_logarithmic {
            sheet.text((0.5 * (plot.x0 + plot.x1), plot.y1 + 42.0), &self.x_label, AXIS_TEXT, DARK, Align::Middle);
        } else {
            for &v in &ticks.values {
                sheet.line((x.at(v), plot.y0), (x.at(v), plot.y1), 1.0, GRID);
            }
            axis::below(sheet, plot, x, &ticks, &self.x_label);
        }
        axis::upright(sheet, plot, &self.y_label, title_x);
    }
}
