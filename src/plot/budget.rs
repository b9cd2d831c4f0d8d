//! The budget panel: how much of each figure's variance every contribution makes, as bars.

use super::axis::{self, BELOW, MARGIN, Scale, TICK_TEXT, Ticks};
use super::font;
use super::lobe::COLOURS;
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Rect, SOFT, Sheet};

/// Room for the figures' names, and for what is stated of them.
const NAMES: f64 = 150.0;
const STATED: f64 = 210.0;
/// A share too narrow for its number.
const LEAST_LABELLED: f64 = 0.06;

/// Shares of contributions in the variances of figures.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BudgetPanel {
    /// Above the drawing.
    pub title: String,
    /// Names of the contributions; those beyond the sixth are drawn in one colour.
    pub contributions: Vec<String>,
    /// The figures from above.
    pub bars: Vec<BudgetBar>,
}

/// One figure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BudgetBar {
    /// Its name.
    pub name: String,
    /// What is stated of it, beside the bar.
    pub stated: String,
    /// Shares in its variance, in the order of the contributions, together 1.
    pub shares: Vec<f64>,
}

impl BudgetPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let legend = 20.0 * self.contributions.len().min(COLOURS.len() + 1) as f64;
        let (left, right) = (area.x0 + MARGIN + NAMES, area.x1 - MARGIN - STATED);
        let plot = Rect::new(left, top + legend + 6.0, right, area.y1 - MARGIN - BELOW);
        let ink = |i: usize| COLOURS.get(i).map_or(SOFT, |c| Ink::rgb(*c));
        for (i, name) in self.contributions.iter().enumerate().take(COLOURS.len() + 1) {
            let y = top + 6.0 + 20.0 * i as f64;
            sheet.line((plot.x0, y), (plot.x0 + 26.0, y), 9.0, ink(i));
            let name = if i < COLOURS.len() { name.as_str() } else { "others" };
            let name = font::fit(name, TICK_TEXT, area.x1 - MARGIN - plot.x0 - 34.0);
            sheet.text((plot.x0 + 34.0, y + 0.36 * TICK_TEXT), &name, TICK_TEXT, DARK, Align::Start);
        }
        let x = Scale::new(0.0, 100.0, plot.x0, plot.x1);
        let ticks = Ticks::multiples(0.0, 100.0, 20.0);
        for v in &ticks.values {
            sheet.line((x.at(*v), plot.y0), (x.at(*v), plot.y1), 1.0, GRID);
        }
        let step = plot.height() / self.bars.len().max(1) as f64;
        for (i, bar) in self.bars.iter().enumerate() {
            let middle = plot.y0 + (i as f64 + 0.5) * step;
            let half = (0.32 * step).min(22.0);
            let mut from = 0.0;
            for (k, share) in bar.shares.iter().enumerate() {
                let (a, b) = (x.at(100.0 * from), x.at(100.0 * (from + share)));
                sheet.fill(Rect::new(a, middle - half, b, middle + half).corners().to_vec(), ink(k));
                if *share >= LEAST_LABELLED {
                    let text = format!("{:.0}", 100.0 * share);
                    let at = (0.5 * (a + b), middle + 0.36 * TICK_TEXT);
                    sheet.text(at, &text, TICK_TEXT, Ink::rgb([255; 3]), Align::Middle);
                }
                from += share;
            }
            let base = middle + 0.36 * TICK_TEXT;
            let name = font::fit(&bar.name, TICK_TEXT, NAMES - 12.0);
            sheet.text((plot.x0 - 10.0, base), &name, TICK_TEXT, DARK, Align::End);
            let stated = font::fit(&bar.stated, TICK_TEXT, STATED - 8.0);
            sheet.text((plot.x1 + 10.0, base), &stated, TICK_TEXT, DARK, Align::Start);
        }
        axis::below(
            sheet,
            plot,
            x,
            &ticks,
            "share of the variance [%]; beside it the figure ± its standard uncertainty (k = 1)",
        );
        sheet.frame(plot, 1.0, FRAME);
    }
}
