//! The rows of a picture as they were sampled.

use super::plane::Plane;
use super::record::Layout;

/// The rows of a picture as they were sampled.
pub(super) struct Rows<'a> {
    pub(super) layout: Layout,
    pub(super) rows: &'a [Vec<f32>],
    pub(super) width: usize,
}

impl Rows<'_> {
    pub(super) fn channel(&self, y: usize, channel: usize) -> &[f32] {
        &self.rows[y][channel * self.width..][..self.width]
    }

    pub(super) fn at(&self, x: usize, y: usize, channel: usize) -> f64 {
        f64::from(self.rows[y][channel * self.width + x])
    }

    pub(super) fn count(&self, x: usize, y: usize, half: usize) -> f64 {
        self.at(x, y, self.layout.count(half))
    }

    /// The share that a half has of a pixel's samples.
    pub(super) fn share(&self, x: usize, y: usize, half: usize) -> f64 {
        let (own, other) = (self.count(x, y, half), self.count(x, y, 1 - half));
        if own + other > 0.0 { own / (own + other) } else { 0.5 }
    }

    /// What the camera saw, by all samples and rays.
    pub(super) fn seen(&self, x: usize, y: usize, feature: usize) -> f64 {
        let layout = self.layout;
        let places = [0, 1].map(|half| (layout.count(half), layout.feature(half)));
        let places = places.into_iter().chain([(layout.looks(), layout.seen())]);
        let (sum, count) = places.fold((0.0, 0.0), |(sum, count), (number, first)| {
            let number = self.at(x, y, number);
            (sum + number * self.at(x, y, first + feature), count + number)
        });
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// The luminance of a half.
    pub(super) fn luminance(&self, half: usize, luminous: &[f64]) -> Plane {
        let first = self.layout.band(half);
        Plane::sums(self.width, self.rows.len(), |y| {
            luminous.iter().zip(first..).map(move |(by, channel)| (*by, self.channel(y, channel)))
        })
    }
}
