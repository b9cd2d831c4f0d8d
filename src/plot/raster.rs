//! The raster panel: a square picture with a line below it.

use super::axis::{self, AXIS_TEXT, MARGIN};
use super::font;
use super::sheet::{Align, Op, Rect, SOFT, Sheet};

/// A picture of sRGB pixels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RasterPanel {
    /// Above the picture.
    pub title: String,
    /// Width and height in pixels.
    pub side: u32,
    /// Encoded sRGB, three bytes per pixel, rows from the top.
    pub pixels: Vec<u8>,
    /// Below the picture.
    pub caption: String,
}

impl RasterPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let room = (area.width() - 2.0 * MARGIN).min(area.y1 - top - 2.0 * MARGIN - 24.0);
        let middle = (area.x0 + area.x1) / 2.0;
        let square = Rect::new(middle - room / 2.0, top, middle + room / 2.0, top + room);
        if self.side > 0 && self.pixels.len() == 3 * (self.side as usize).pow(2) {
            sheet.ops.push(Op::Image {
                area: square,
                columns: self.side,
                rows: self.side,
                pixels: self.pixels.clone(),
                clip: square.corners().to_vec(),
            });
        }
        let caption = font::fit(&self.caption, AXIS_TEXT, area.width() - 2.0 * MARGIN);
        sheet.text((middle, square.y1 + 8.0 + AXIS_TEXT), &caption, AXIS_TEXT, SOFT, Align::Middle);
    }
}
