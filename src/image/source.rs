//! Where pixels come from: regions on request, in bounded memory.

use super::description::Description;
use super::error::Error;
use crate::finding::Finding;

/// Samples that a stage of the pipeline holds at a time, at most, where the file's own blocks allow it: 8 Mi samples of 4 bytes.
pub const SAMPLES_AT_ONCE: usize = 8 << 20;

/// A rectangle of pixels; x counts from the left, y from the top.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Region {
    /// First column.
    pub x: usize,
    /// First row.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Region {
    /// Whole rows of an image.
    #[must_use]
    pub fn rows(description: &Description, y: usize, height: usize) -> Self {
        Self { x: 0, y, width: description.width, height }
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }
}

/// An image that gives its pixels region by region.
///
/// Samples come in the order described at [`crate::image`]: `out[(y·channels.len() + c)·region.width + x]`.
pub trait Source: Send {
    /// What the image is.
    fn description(&self) -> &Description;

    /// Columns and rows of the blocks in which the image is stored: regions made of whole blocks cost least. Whoever reads in
    /// other pieces may pay for a block several times.
    fn block(&self) -> (usize, usize) {
        (self.description().width, 1)
    }

    /// Reads the channels listed (numbers in the description, in any order) of a region into `out`.
    ///
    /// # Errors
    /// Where the file cannot be read or is damaged.
    ///
    /// # Panics
    /// Where the region or a channel lies outside of the image, or `out` has another length than pixels times channels.
    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error>;

    /// What was noticed in the pixels read so far.
    fn findings(&self) -> Vec<Finding> {
        Vec::new()
    }
}

impl<S: Source + ?Sized> Source for Box<S> {
    fn description(&self) -> &Description {
        (**self).description()
    }

    fn block(&self) -> (usize, usize) {
        (**self).block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        (**self).read(region, channels, out)
    }

    fn findings(&self) -> Vec<Finding> {
        (**self).findings()
    }
}

impl<S: Source + ?Sized> Source for &mut S {
    fn description(&self) -> &Description {
        (**self).description()
    }

    fn block(&self) -> (usize, usize) {
        (**self).block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        (**self).read(region, channels, out)
    }

    fn findings(&self) -> Vec<Finding> {
        (**self).findings()
    }
}

/// Checks the promises that a caller of [`Source::read`] makes.
///
/// # Panics
/// Where they are broken.
pub(crate) fn check(description: &Description, region: Region, channels: &[usize], out: &[f32]) {
    assert!(
        region.x + region.width <= description.width && region.y + region.height <= description.height,
        "{region:?} inside {} × {} pixels",
        description.width,
        description.height
    );
    assert!(channels.iter().all(|c| *c < description.channels.len()), "channels of the image");
    assert_eq!(out.len(), region.pixels() * channels.len(), "room for the samples");
}

/// The rows to ask for at a time so that `samples_per_pixel` per pixel of whole rows stay within [`SAMPLES_AT_ONCE`]: as many
/// whole blocks as fit, or fewer rows than a block where not even one fits.
#[must_use]
pub fn rows_at_once(width: usize, samples_per_pixel: usize, block_rows: usize) -> usize {
    let fit = (SAMPLES_AT_ONCE / (width * samples_per_pixel).max(1)).max(1);
    let block_rows = block_rows.max(1);
    if fit >= block_rows { fit / block_rows * block_rows } else { fit }
}

/// Cuts a region into pieces of at most `pixels` pixels along the blocks of an image: whole rows where a row of blocks fits,
/// else as many blocks side by side as do.
pub fn pieces(region: Region, block: (usize, usize), pixels: usize) -> impl Iterator<Item = Region> {
    let (block_width, block_height) = (block.0.clamp(1, region.width.max(1)), block.1.max(1));
    let pixels = pixels.max(1);
    let rows = pixels / region.width.max(1);
    let (width, height) = if rows >= block_height {
        (region.x + region.width, rows / block_height * block_height)
    } else {
        let height = block_height.min((pixels / block_width).max(1));
        let columns = pixels / height;
        (if columns >= block_width { columns / block_width * block_width } else { columns }, height)
    };
    steps(region.y, region.height, height).flat_map(move |(y, height)| {
        steps(region.x, region.width, width).map(move |(x, width)| Region { x, y, width, height })
    })
}

/// `[start, start + length)` cut at the multiples of `step`: first element and length of each part.
fn steps(start: usize, length: usize, step: usize) -> impl Iterator<Item = (usize, usize)> + Clone {
    let end = start + length;
    let mut at = start;
    std::iter::from_fn(move || {
        if at >= end {
            return None;
        }
        let next = ((at / step + 1) * step).min(end);
        let part = (at, next - at);
        at = next;
        Some(part)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_cover_a_region_once_and_stay_small() {
        for (region, block, pixels) in [
            (Region { x: 0, y: 0, width: 100, height: 70 }, (100, 1), 250),
            (Region { x: 0, y: 0, width: 100, height: 70 }, (32, 32), 1024),
            (Region { x: 0, y: 0, width: 100, height: 70 }, (32, 32), 40),
            (Region { x: 5, y: 9, width: 31, height: 7 }, (16, 16), 100),
            (Region { x: 0, y: 0, width: 7, height: 3 }, (64, 64), 1_000_000),
            (Region { x: 3, y: 2, width: 1, height: 1 }, (1, 1), 1),
        ] {
            let mut seen = vec![0_u8; 200 * 200];
            for piece in pieces(region, block, pixels) {
                assert!(piece.pixels() <= pixels, "{piece:?} of {region:?}");
                for y in piece.y..piece.y + piece.height {
                    for x in piece.x..piece.x + piece.width {
                        seen[y * 200 + x] += 1;
                    }
                }
            }
            for y in 0..200 {
                for x in 0..200 {
                    let inside = (region.x..region.x + region.width).contains(&x)
                        && (region.y..region.y + region.height).contains(&y);
                    assert_eq!(seen[y * 200 + x], u8::from(inside), "({x}, {y}) of {region:?}");
                }
            }
        }
    }

    #[test]
    fn rows_are_whole_blocks_where_they_fit() {
        assert_eq!(rows_at_once(1024, 31, 16) % 16, 0);
        assert_eq!(rows_at_once(SAMPLES_AT_ONCE, 2, 16), 1);
        assert_eq!(rows_at_once(0, 0, 0), SAMPLES_AT_ONCE);
    }
}
