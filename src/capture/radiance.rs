//! A picture in linear radiance: what `capture merge` writes, any EXR, or a 16-bit linear TIFF with its exposure time.

use std::io::Cursor;

use super::merge::State;
use super::photo::Codes;
use super::{Error, Photo, setup};
use crate::image::format::exr;
use crate::image::{Region, Source};

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
        let photo = Photo::decode(bytes)?;
        let Codes::Linear(values) = photo.codes else {
            return Err(Error::NotLinear);
        };
        let Photo { width, height, channels, .. } = photo;
        let exr = bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]);
        let planes = |prefix| if exr { planes(bytes, prefix, channels) } else { Ok(None) };
        let errors = planes("standard_error.")?;
        let states = planes("state.")?.map(|all| all.into_iter().map(state).collect());
        Ok(Self { width, height, channels, time_s, values, errors, states })
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

/// The planes whose names begin with `prefix`, interleaved; `None` unless there is one for each channel.
fn planes(bytes: &[u8], prefix: &str, channels: usize) -> Result<Option<Vec<f32>>, Error> {
    let wrong = |e: &dyn std::fmt::Display| Error::Undecodable { reason: e.to_string() };
    let mut source = exr::open(Cursor::new(bytes)).map_err(|e| wrong(&e))?.value;
    let description = source.description().clone();
    let names: &[&str] = if channels == 1 { &["Y"] } else { &["R", "G", "B"] };
    let number = |name: &&str| description.channels.iter().position(|c| c.name == format!("{prefix}{name}"));
    let Some(numbers) = names.iter().map(number).collect::<Option<Vec<usize>>>() else { return Ok(None) };
    let width = description.width;
    let mut rows = vec![0.0; width * channels];
    let mut values = Vec::with_capacity(width * description.height * channels);
    for y in 0..description.height {
        source.read(Region::rows(&description, y, 1), &numbers, &mut rows).map_err(|e| wrong(&e))?;
        values.extend((0..width * channels).map(|i| rows[i % channels * width + i / channels]));
    }
    Ok(Some(values))
}
