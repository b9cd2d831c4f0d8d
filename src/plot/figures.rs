//! A block of key figures: names and values in columns, as at the head of a datasheet.

use super::axis::{self, MARGIN};
use super::font;
use super::sheet::{Align, DARK, Rect, SOFT, Sheet, clean};

/// Key figures in columns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FiguresPanel {
    /// Above the figures; may be empty.
    pub title: String,
    /// Name and value, the value with its unit.
    pub figures: Vec<(String, String)>,
}

const TEXT: f64 = 13.0;
const LINE: f64 = 1.6 * TEXT;
/// Least width of a column.
const COLUMN: f64 = 300.0;

impl FiguresPanel {
    /// Height that the block needs on a sheet of this width.
    pub(super) fn height(&self, width: f64) -> f64 {
        let rows = self.figures.len().div_ceil(columns(width));
        let title = if self.title.is_empty() { MARGIN } else { MARGIN + 24.0 };
        title + 6.0 + LINE * rows as f64 + MARGIN
    }

    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title) + 6.0;
        let columns = columns(area.width());
        let rows = self.figures.len().div_ceil(columns).max(1);
        let width = (area.width() - 2.0 * MARGIN) / columns as f64;
        let names = self.figures.iter().map(|f| font::width(&clean(&f.0), TEXT)).fold(0.0, f64::max);
        let names = names.min(0.5 * width);
        for (i, (name, value)) in self.figures.iter().enumerate() {
            let (x, y) = (area.x0 + MARGIN + width * (i / rows) as f64, top + LINE * (i % rows) as f64 + TEXT);
            if y > area.y1 {
                continue;
            }
            sheet.text((x, y), &font::fit(&clean(name), TEXT, names), TEXT, SOFT, Align::Start);
            let room = width - names - 28.0;
            sheet.text((x + names + 12.0, y), &font::fit(&clean(value), TEXT, room), TEXT, DARK, Align::Start);
        }
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few columns")]
fn columns(width: f64) -> usize {
    ((width - 2.0 * MARGIN) / COLUMN).floor().clamp(1.0, 3.0) as usize
}
