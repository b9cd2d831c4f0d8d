//! A picture in linear radiance: what `capture merge` writes, any EXR, or a 16-bit linear TIFF with its exposure time.

use std::io::{Cursor, Read, Seek, SeekFrom};
use std::ops::Range;

use super::merge::State;
use super::photo::Codes;
use super::rows::{PhotoRows, exr_channels, interleaved, undecodable};
use super::{Error, setup};
use crate::image::Source;
use crate::image::format::exr::{self, Exr};

/// Samples in rows from the top, channels interleaved.
#[derive(Debug, Clone, PartialEq)]
pub struct Radiance {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 or 3, or as many as there are narrow bands.
    pub channels: usize,
    /// Exposure time, s: radiance is a sample over it.
    pub time_s: f64,
    /// The samples, as the picture has them.
    pub values: Vec<f32>,
    /// Their standard errors, where the picture has them.
    pub errors: Option<Vec<f32>>,
    /// What became of each when exposures were merged, where the picture says it.
    pub states: Option<Vec<State>>,
}

impl Radiance {
    /// Decodes a picture.
    ///
    /// # Errors
    /// [`Error::Undecodable`], [`Error::NotLinear`] for codes of unknown response.
    pub fn decode(bytes: &[u8], time_s: f64) -> Result<Self, Error> {
        let mut rows = RadianceRows::open(Cursor::new(bytes), time_s)?;
        rows.next(rows.height)
    }

    /// Some of its rows.
    #[must_use]
    pub fn rows(&self, rows: Range<usize>) -> Self {
        let samples = rows.start * self.width * self.channels..rows.end * self.width * self.channels;
        Self {
            height: rows.len(),
            values: self.values[samples.clone()].to_vec(),
            errors: self.errors.as_ref().map(|e| e[samples.clone()].to_vec()),
            states: self.states.as_ref().map(|s| s[samples].to_vec()),
            ..*self
        }
    }

    /// Adds rows below it.
    ///
    /// # Panics
    /// For rows of another picture: of another width, or with errors or states where this one has none.
    pub fn append(&mut self, below: &Self) {
        assert_eq!((self.width, self.channels), (below.width, below.channels), "rows of one picture");
        assert_eq!(
            (self.errors.is_some(), self.states.is_some()),
            (below.errors.is_some(), below.states.is_some()),
            "rows of one picture"
        );
        self.height += below.height;
        self.values.extend_from_slice(&below.values);
        self.errors.iter_mut().for_each(|e| e.extend_from_slice(below.errors.as_deref().unwrap_or_default()));
        self.states.iter_mut().for_each(|s| s.extend_from_slice(below.states.as_deref().unwrap_or_default()));
    }

    /// Grey pictures of one view, one per band, as one picture of radiance (its time is 1 s). Each sample has the state and, unless it has its own,
    /// the standard error that `limits` give it.
    ///
    /// # Errors
    /// [`Error::Size`] for pictures of other sizes than the first, [`Error::Setup`] for one in colours.
    pub fn of_bands(mut pictures: Vec<Self>, limits: &setup::Radiance) -> Result<Self, Error> {
        let bands = pictures.len();
        let (width, height) = pictures.first().map_or((0, 0), |p| (p.width, p.height));
        let expected = format!("{width} × {height} pixels");
        for (n, picture) in pictures.iter_mut().enumerate() {
            if (picture.width, picture.height) != (width, height) {
                let name = format!("the picture of band {}", n + 1);
                return Err(Error::Size { name, found: picture.size(), expected });
            }
            if picture.channels != 1 {
                return Err(Error::Setup {
                    found: format!("a picture of one band with {} channels", picture.channels),
                    expected: "a grey one; of a colour camera the channel that sees the band",
                });
            }
            picture.mark(limits);
        }
        let known = pictures.iter().any(|p| p.errors.is_some()) || limits.states_errors();
        let mut out = Self { width, height, channels: bands, time_s: 1.0, values: vec![], errors: None, states: None };
        let samples = width * height * bands;
        out.values.reserve_exact(samples);
        let (mut errors, mut states) = (Vec::new(), Vec::with_capacity(samples));
        for i in 0..width * height {
            for picture in &pictures {
                #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
                let per_second = |v: f64| (v / picture.time_s) as f32;
                out.values.push(per_second(f64::from(picture.values[i])));
                states.push(picture.state(i, limits));
                if known {
                    errors.push(per_second(picture.error(i, limits)));
                }
            }
        }
        out.states = Some(states);
        out.errors = known.then_some(errors);
        Ok(out)
    }

    /// Gives every sample a state: its own where the picture has states, and else, or where that is valid, the one that `limits` give it.
    pub fn mark(&mut self, limits: &setup::Radiance) {
        let state = |i: usize| {
            let own = self.states.as_ref().map_or(State::Valid, |s| s[i]);
            if own == State::Valid { limits.state(f64::from(self.values[i])) } else { own }
        };
        self.states = Some((0..self.values.len()).map(state).collect());
    }

    /// The state of sample `i`: as the picture has it, or else as `limits` have it.
    #[must_use]
    pub fn state(&self, i: usize, limits: &setup::Radiance) -> State {
        self.states.as_ref().map_or_else(|| limits.state(f64::from(self.values[i])), |s| s[i])
    }

    /// The standard error of sample `i`: its own, or as `limits` state it; 0 where neither does.
    #[must_use]
    pub fn error(&self, i: usize, limits: &setup::Radiance) -> f64 {
        match &self.errors {
            Some(errors) => f64::from(errors[i]),
            None => {
                let relative = limits.relative_error.unwrap_or(0.0) * f64::from(self.values[i]);
                relative.hypot(limits.absolute_error.unwrap_or(0.0))
            }
        }
    }

    /// Multiplies values and errors, a factor per channel.
    pub fn scale(&mut self, factors: &[f64]) {
        #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
        let factors: Vec<f32> = factors.iter().map(|f| *f as f32).collect();
        for plane in std::iter::once(&mut self.values).chain(self.errors.as_mut()) {
            for pixel in plane.chunks_exact_mut(factors.len()) {
                pixel.iter_mut().zip(&factors).for_each(|(v, f)| *v *= f);
            }
        }
    }

    /// Size and channels in words.
    #[must_use]
    pub fn size(&self) -> String {
        format!("{} × {} pixels in {} channel(s)", self.width, self.height, self.channels)
    }
}

/// The number that a merged picture has for a state.
fn state(number: f32) -> State {
    match number {
        0.0 => State::Valid,
        1.0 => State::Saturated,
        2.0 => State::Dark,
        _ => State::Gap,
    }
}

/// A picture in linear radiance that is being decoded, by rows from the top.
pub struct RadianceRows<R: Read + Seek> {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 or 3.
    pub channels: usize,
    time_s: f64,
    from: From<R>,
}

enum From<R: Read + Seek> {
    /// With rows given so far, and the numbers of the channels that have values, errors and states.
    Exr(Box<Exr<R>>, usize, [Option<Vec<usize>>; 3]),
    Other(PhotoRows<R>),
}

impl<R: Read + Seek + Send> RadianceRows<R> {
    /// Opens a picture whose exposure time was `time_s`.
    ///
    /// # Errors
    /// [`Error::Undecodable`], [`Error::NotLinear`] for codes of unknown response.
    pub fn open(mut input: R, time_s: f64) -> Result<Self, Error> {
        let mut start = Vec::new();
        input.by_ref().take(4).read_to_end(&mut start).map_err(undecodable)?;
        input.seek(SeekFrom::Start(0)).map_err(undecodable)?;
        if start != [0x76, 0x2f, 0x31, 0x01] {
            let rows = PhotoRows::open(input)?;
            if !rows.is_linear {
                return Err(Error::NotLinear);
            }
            let (width, height, channels) = (rows.width, rows.height, rows.channels);
            return Ok(Self { width, height, channels, time_s, from: From::Other(rows) });
        }
        let source = exr::open(input).map_err(undecodable)?.value;
        let description = source.description();
        let values = exr_channels(description)?;
        let (width, height, channels) = (description.width, description.height, values.len());
        // All of the channels have them, or none.
        let beside = |prefix: &str| {
            let number = |c: &usize| {
                let name = format!("{prefix}{}", description.channels[*c].name);
                description.channels.iter().position(|c| c.name == name)
            };
            values.iter().map(number).collect::<Option<Vec<usize>>>()
        };
        let (errors, states) = (beside("standard_error."), beside("state."));
        let from = From::Exr(Box::new(source), 0, [Some(values), errors, states]);
        Ok(Self { width, height, channels, time_s, from })
    }

    /// The next rows, as many or what is left.
    ///
    /// # Errors
    /// [`Error::Undecodable`] where the file is damaged there. What was given before was sound.
    pub fn next(&mut self, rows: usize) -> Result<Radiance, Error> {
        let (height, values, errors, states) = match &mut self.from {
            From::Other(photo) => {
                let part = photo.next(rows)?;
                let Codes::Linear(values) = part.codes else { return Err(Error::NotLinear) };
                (part.height, values, None, None)
            }
            From::Exr(source, given, numbers) => {
                let rows = rows.min(self.height - *given);
                let mut planes = [None, None, None];
                for (plane, numbers) in planes.iter_mut().zip(numbers) {
                    if let Some(numbers) = numbers {
                        *plane = Some(interleaved(source.as_mut(), numbers, *given, rows)?);
                    }
                }
                *given += rows;
                let [values, errors, states] = planes;
                let states = states.map(|all| all.into_iter().map(state).collect());
                (rows, values.unwrap_or_default(), errors, states)
            }
        };
        Ok(Radiance { width: self.width, height, channels: self.channels, time_s: self.time_s, values, errors, states })
    }
}

/// Some rows of a picture, with the row above and the one below where the picture has them.
#[derive(Debug, Clone)]
pub struct Strip<'a> {
    /// The rows.
    pub picture: &'a Radiance,
    /// Number of the first of them in the whole picture.
    pub top: usize,
    /// Rows of the whole picture.
    pub height: usize,
    /// The rows that it is about, by their numbers in the whole picture: together with the other strips all of them, each once.
    pub rows: Range<usize>,
}

impl<'a> Strip<'a> {
    /// A whole picture.
    #[must_use]
    pub fn whole(picture: &'a Radiance) -> Self {
        Self { picture, top: 0, height: picture.height, rows: 0..picture.height }
    }

    /// Place of a pixel of the whole picture among those of `picture`.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> usize {
        (y - self.top) * self.picture.width + x
    }
}

/// Makes strips of pieces that follow one another.
#[derive(Debug, Clone)]
pub struct Strips {
    held: Option<Radiance>,
    top: usize,
    height: usize,
    done: usize,
}

impl Strips {
    /// Of a picture with so many rows.
    #[must_use]
    pub fn new(height: usize) -> Self {
        Self { held: None, top: 0, height, done: 0 }
    }

    /// The next piece; the strip is of the rows that now have a row below them.
    pub fn add(&mut self, piece: Radiance) -> Strip<'_> {
        let held = match self.held.take() {
            None => piece,
            Some(before) => {
                // The rows from the one above those that are not done yet.
                let first = self.done.saturating_sub(1);
                let mut held = before.rows(first - self.top..before.height);
                self.top = first;
                held.append(&piece);
                held
            }
        };
        let end = self.top + held.height;
        let rows = self.done..if end < self.height { end.saturating_sub(1).max(self.done) } else { end };
        self.done = rows.end;
        let picture = &*self.held.insert(held);
        Strip { picture, top: self.top, height: self.height, rows }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_have_all_rows_once_with_their_neighbours() {
        let (width, height) = (3, 17);
        let picture = Radiance {
            width,
            height,
            channels: 1,
            time_s: 1.0,
            values: (0..51_u8).map(f32::from).collect(),
            errors: Some((0..51_u8).map(|v| 0.1 * f32::from(v)).collect()),
            states: None,
        };
        for piece in [1, 2, 5, 16, 17] {
            let mut strips = Strips::new(height);
            let mut seen = Vec::new();
            for first in (0..height).step_by(piece) {
                let strip = strips.add(picture.rows(first..(first + piece).min(height)));
                for y in strip.rows.clone() {
                    for near in [y.saturating_sub(1), y, (y + 1).min(height - 1)] {
                        let at = strip.at(1, near);
                        assert_eq!(strip.picture.values[at], picture.values[near * width + 1], "{piece} {y}");
                        assert_eq!(
                            strip.picture.errors.as_ref().map(|e| e[at]),
                            Some(picture.errors.as_ref().expect("errors")[near * width + 1])
                        );
                    }
                    seen.push(y);
                }
            }
            assert_eq!(seen, (0..height).collect::<Vec<_>>(), "by {piece}");
        }
    }
}
