//! Some pixels of a row that are filtered together, and those about them.

use std::ops::Range;

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

/// A number for each pixel of a row of a tile, and for [`REACH`] columns to each side.
type Wide = [f32; TILE + 2 * REACH];

/// Room for the rows about a tile that do not lie in the picture as a whole.
pub(super) type Margin = [Wide; SIDE];
pub(super) const MARGIN: Margin = [OUTSIDE; SIDE];
const OUTSIDE: Wide = [0.0; TILE + 2 * REACH];

/// One number for each pixel of a tile and of what lies about it: [`REACH`] rows and columns to each side, 0 outside of the picture.
#[derive(Clone, Copy)]
pub(super) struct Window<'a> {
    rows: [&'a Wide; SIDE],
}

impl<'a> Window<'a> {
    /// 0 everywhere.
    pub(super) const EMPTY: Self = Self { rows: [&OUTSIDE; SIDE] };

    /// What lies about the tile of row y that begins at column `first`.
    #[inline(always)]
    pub(super) fn of(records: &'a Rows<'_>, channel: usize, first: usize, y: usize, margin: &'a mut Margin) -> Self {
        let columns = columns(records, first);
        let mut rows = [&OUTSIDE; SIDE];
        for ((row, out), margin) in (y..).zip(&mut rows).zip(margin) {
            let Some(row) = row.checked_sub(REACH).filter(|row| *row < records.rows.len()) else { continue };
            let own = &records.channel(row, channel)[columns.clone()];
            *out = own.first_chunk().unwrap_or_else(|| {
                *margin = OUTSIDE;
                margin[columns.start + REACH - first..][..own.len()].copy_from_slice(own);
                margin
            });
        }
        Self { rows }
    }

    /// The numbers of a neighbour of each pixel.
    #[inline(always)]
    pub(super) fn neighbour(&self, number: usize) -> &'a Tile {
        self.rows[number / SIDE][number % SIDE..].first_chunk().expect("a window reaches beyond the tile")
    }
}

/// Whether a number of a channel is another than `all` anywhere about the tile.
#[inline(always)]
pub(super) fn differs(records: &Rows<'_>, channel: usize, first: usize, y: usize, all: f32) -> bool {
    let rows = y.saturating_sub(REACH)..(y + REACH + 1).min(records.rows.len());
    for row in rows {
        let mut differ = false;
        for number in &records.channel(row, channel)[columns(records, first)] {
            differ |= *number != all;
        }
        if differ {
            return true;
        }
    }
    false
}

/// The columns about a tile that lie in the picture.
#[inline(always)]
fn columns(records: &Rows<'_>, first: usize) -> Range<usize> {
    first.saturating_sub(REACH)..(first + TILE + REACH).min(records.width)
}
