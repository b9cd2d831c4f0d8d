//! One number per pixel of a picture.

use super::record::narrow;

/// Numbers row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plane {
    width: usize,
    values: Vec<f32>,
}

impl Plane {
    /// Of a number for each column and row.
    pub(super) fn of(width: usize, height: usize, number: impl Fn(usize, usize) -> f64) -> Self {
        let values = (0..width * height).map(|i| narrow(number(i % width, i / width))).collect();
        Self { width, values }
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn height(&self) -> usize {
        self.values.len() / self.width
    }

    pub(super) fn row(&self, y: usize) -> &[f32] {
        &self.values[y * self.width..][..self.width]
    }

    pub(super) fn at(&self, x: usize, y: usize) -> f64 {
        f64::from(self.values[y * self.width + x])
    }

    /// The means of each pixel and the up to eight about it.
    pub(super) fn smooth(&self) -> Self {
        let (width, height) = (self.width, self.height());
        Self::of(width, height, |x, y| {
            let (rows, columns) = (y.saturating_sub(1)..(y + 2).min(height), x.saturating_sub(1)..(x + 2).min(width));
            let count = rows.len() * columns.len();
            rows.flat_map(|row| columns.clone().map(move |column| self.at(column, row))).sum::<f64>() / count as f64
        })
    }
}
