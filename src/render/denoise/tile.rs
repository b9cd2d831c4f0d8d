//! Some pixels of a row that are filtered together, and those about them.

use super::rows::Rows;

/// Pixels to each side that a pixel borrows from.
const REACH: usize = 5;
/// Rows and columns of those that it borrows from.
const SIDE: usize = 2 * REACH + 1;
/// Those that it borrows from, itself among them.
pub(super) const NEIGHBOURS: usize = SIDE * SIDE;
/// Pixels of a tile: numbers of so many fill four of the widest registers, and all that is kept of a tile stays in a core's nearest caches.
pub(super) const TILE: usize = 64;
/// One number for each pixel of a tile.
pub(super) type Tile = [f32; TILE];

/// Columns and rows to a neighbour of that number.
#[inline(always)]
pub(super) fn neighbour(number: usize) -> [isize; 2] {
    [number % SIDE, number / SIDE].map(|along| along.cast_signed() - REACH.cast_signed())
}

/// One number for each pixel of a tile and of what lies about it: [`REACH`] rows and columns to each side, 0 outside of the picture.
pub(super) struct Window {
    rows: [[f32; TILE + 2 * REACH]; SIDE],
}

impl Default for Window {
    fn default() -> Self {
        Self { rows: [[0.0; TILE + 2 * REACH]; SIDE] }
    }
}

impl Window {
    /// Reads what lies about the tile of row y that begins at column `first`.
    #[inline(always)]
    pub(super) fn load(&mut self, records: &Rows<'_>, channel: usize, first: usize, y: usize) {
        // Columns are counted from where those about the first tile begin, which lies to the left of the picture.
        let (left, right) = (first.max(REACH), (first + TILE + 2 * REACH).min(records.width + REACH));
        for (row, out) in (y..).zip(&mut self.rows) {
            let Some(row) = row.checked_sub(REACH).filter(|row| *row < records.rows.len()) else {
                *out = [0.0; TILE + 2 * REACH];
                continue;
            };
            let own = &records.channel(row, channel)[left - REACH..right - REACH];
            if let Some(whole) = own.first_chunk() {
                *out = *whole;
            } else {
                *out = [0.0; TILE + 2 * REACH];
                out[left - first..][..own.len()].copy_from_slice(own);
            }
        }
    }

    /// The numbers of a neighbour of each pixel.
    #[inline(always)]
    pub(super) fn of(&self, number: usize) -> &Tile {
        self.rows[number / SIDE][number % SIDE..].first_chunk().expect("a window reaches beyond the tile")
    }
}
