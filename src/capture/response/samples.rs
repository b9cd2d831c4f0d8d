//! The pixels that a response is found from.

use super::LEVELS;
use crate::capture::{Error, Photo};

/// Where pixels are taken: an even grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// About how many per stack.
    pub pixels: usize,
}

/// Places of an even grid of about `count` pixels, column by column, as OpenCV's `CalibrateDebevec` takes them.
#[must_use]
pub fn grid(width: usize, height: usize, count: usize) -> Vec<(usize, usize)> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
    let columns = ((count as f64 * width as f64 / height as f64).sqrt() as usize).clamp(1, width);
    let rows = (count / columns).clamp(1, height);
    let (dx, dy) = (width / columns, height / rows);
    let place = |i: usize| (0..rows).map(move |j| (dx / 2 + i * dx, dy / 2 + j * dy));
    (0..columns).flat_map(place).filter(|(x, y)| *x < width && *y < height).collect()
}

/// The codes of sampled pixels of one stack.
#[derive(Debug, Clone, PartialEq)]
pub struct Exposures {
    /// The stack.
    pub name: String,
    /// The photographs.
    pub names: Vec<String>,
    /// Their exposure times, s.
    pub times_s: Vec<f64>,
    /// 1 or 3.
    pub channels: usize,
    /// Codes rounded to 0–255: `codes[exposure][pixel·channels + channel]`.
    pub codes: Vec<Vec<u8>>,
    /// Size of the first photograph, in words and numbers.
    size: Option<(String, usize, usize)>,
}

impl Exposures {
    /// An empty stack.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        let (names, times_s, codes) = (Vec::new(), Vec::new(), Vec::new());
        Self { name: name.into(), names, times_s, channels: 0, codes, size: None }
    }

    /// Takes the samples of a photograph.
    ///
    /// # Errors
    /// [`Error::Size`] where it differs from the first, [`Error::Time`] for a time that is not above 0.
    pub fn add(&mut self, name: &str, time_s: f64, photo: &Photo, sampling: Sampling) -> Result<(), Error> {
        if !(time_s > 0.0 && time_s.is_finite()) {
            return Err(Error::Time { name: name.to_owned(), time_s });
        }
        let size = self.size.get_or_insert_with(|| (photo.size(), photo.width, photo.height));
        if size.0 != photo.size() {
            return Err(Error::Size { name: name.to_owned(), found: photo.size(), expected: size.0.clone() });
        }
        self.channels = photo.channels;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "codes are 0 to 255")]
        let code = |i: usize| photo.code(i).round() as u8;
        let places = grid(photo.width, photo.height, sampling.pixels);
        let samples = places.iter().flat_map(|(x, y)| {
            let first = (y * photo.width + x) * photo.channels;
            (first..first + photo.channels).map(code)
        });
        self.codes.push(samples.collect());
        self.names.push(name.to_owned());
        self.times_s.push(time_s);
        Ok(())
    }

    /// Pixels taken.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.codes.first().map_or(0, |c| c.len() / self.channels.max(1))
    }

    /// Code of a pixel as a place in a curve.
    #[must_use]
    pub fn code(&self, exposure: usize, pixel: usize, channel: usize) -> usize {
        usize::from(self.codes[exposure][pixel * self.channels + channel])
    }

    /// Fails where there are not two different times.
    pub(super) fn check(&self) -> Result<(), Error> {
        let mut times = self.times_s.clone();
        times.sort_by(f64::total_cmp);
        times.dedup();
        if times.len() < 2 { Err(Error::TooFew { stack: self.name.clone(), count: times.len() }) } else { Ok(()) }
    }
}

/// What the samples of a channel are, where no two of a pixel lie within the range.
pub(super) fn nothing_shared(stacks: &[Exposures], channel: usize) -> Error {
    let codes = || stacks.iter().flat_map(|s| s.codes.iter().flat_map(|c| c.iter().skip(channel).step_by(s.channels)));
    let what = if codes().all(|c| *c == 0) {
        "all are black"
    } else if codes().all(|c| usize::from(*c) == LEVELS - 1) {
        "all are white"
    } else {
        "each pixel is dark or saturated in all but one"
    };
    Error::NothingShared { what }
}
