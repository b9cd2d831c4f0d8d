//! One number per pixel of a picture.

use rayon::prelude::*;

use super::record::narrow;

/// Numbers row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plane {
    width: usize,
    values: Vec<f32>,
}

impl Plane {
    /// Of a number for each column and row.
    pub(super) fn of(width: usize, height: usize, number: impl Fn(usize, usize) -> f64 + Sync) -> Self {
        Self::by_rows(width, height, |y, row| {
            row.iter_mut().enumerate().for_each(|(x, value)| *value = narrow(number(x, y)));
        })
    }

    /// Of weighted sums: for each row, other rows and what each of them counts.
    pub(super) fn sums<'a, T>(width: usize, height: usize, terms: impl Fn(usize) -> T + Sync) -> Self
    where
        T: Iterator<Item = (f64, &'a [f32])>,
    {
        Self::by_rows(width, height, |y, row| {
            let mut sums = vec![0.0; width];
            for (by, values) in terms(y) {
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += by * f64::from(*value));
            }
            row.iter_mut().zip(sums).for_each(|(value, sum)| *value = narrow(sum));
        })
    }

    fn by_rows(width: usize, height: usize, write: impl Fn(usize, &mut [f32]) + Sync) -> Self {
        let mut values = vec![0.0; width * height];
        values.par_chunks_exact_mut(width).enumerate().for_each(|(y, row)| write(y, row));
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
