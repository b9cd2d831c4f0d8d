//! Pictures of cameras and screens: PNG, JPEG and TIFF as linear RGB.
//!
//! | file | samples become linear by | primaries |
//! |---|---|---|
//! | PNG, cICP | the sRGB, BT.709/BT.2020 or linear curve | those of BT.709, BT.2020 or P3 |
//! | PNG, iCCP | the sRGB curve: the profile itself is not applied (I103) | sRGB |
//! | PNG, sRGB chunk, or none | the sRGB curve of IEC 61966-2-1 | sRGB |
//! | PNG, gAMA and cHRM | v^(1/gAMA) (I104) | those of cHRM, else sRGB |
//! | JPEG, 8- and 16-bit TIFF | the sRGB curve; profiles as in PNG | sRGB |
//! | TIFF of floats | they are linear | sRGB |
//!
//! The order is that of the PNG specification (third edition, 4.3): cICP before iCCP before sRGB before gAMA and cHRM. Grey
//! pictures are R = G = B. Coverage (alpha) is not applied (I105). A picture says nothing of its light: white, (1, 1, 1), has the
//! luminance that the user states, or values are relative to it.
//!
//! Pictures are compressed whole and are held as stored, 1, 2 or 4 bytes per sample, beside the compressed file for JPEG alone; more
//! than 2²⁸ pixels are refused. TIFF may have its components beside one another or one after the other.

mod jpeg;
mod png;
mod profile;
mod tiff;

use std::io::{BufReader, Read, Seek, SeekFrom};

use rayon::prelude::*;

use crate::colorimetry::rgb::{Encoding, SRGB, Space};
use crate::finding::{Checked, Finding};
use crate::image::description::{Channel, Description, Meaning, RgbSpace};
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{self, Region, Source};

pub use png::{Bits, write as write_png};

/// The largest picture that is read, in pixels.
pub(super) const MOST_PIXELS: usize = 1 << 28;

/// Whether the first bytes of a file are those of a picture.
#[must_use]
pub fn is_picture(start: &[u8]) -> bool {
    matches!(
        start,
        [0x89, b'P', b'N', b'G', ..]
            | [0xff, 0xd8, 0xff, ..]
            | [b'I', b'I', 42 | 43, 0, ..]
            | [b'M', b'M', 0, 42 | 43, ..]
    )
}

/// Samples as they are stored.
enum Stored {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// The curve from what is stored (0 to 1) to light.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Curve {
    Of(Encoding),
    /// v^exponent.
    Power(f64),
}

impl Curve {
    #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
    fn linear(self, stored: f64) -> f32 {
        match self {
            Self::Of(encoding) => encoding.decode(stored) as f32,
            Self::Power(exponent) => stored.powf(exponent) as f32,
        }
    }
}

/// A picture decoded, without its meaning.
struct Decoded {
    width: usize,
    height: usize,
    /// Samples per pixel: grey, grey and alpha, RGB, RGB and alpha.
    samples: usize,
    /// Component after component, instead of the samples of a pixel beside one another.
    planar: bool,
    stored: Stored,
    space: Space,
    curve: Curve,
    findings: Vec<Finding>,
}

/// A picture that has been read.
pub struct Picture {
    description: Description,
    stored: Stored,
    /// Grey is red, green and blue.
    grey: bool,
    /// Places from a pixel to the next, and from a component to the next.
    steps: (usize, usize),
    /// The linear value of each stored integer.
    table: Vec<f32>,
}

/// How a picture is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// The integers are linear, whatever the file says.
    pub linear: bool,
}

/// Reads a picture.
///
/// # Errors
/// Where it is none of the formats, damaged or cut off, larger than 2²⁸ pixels, or neither grey nor RGB.
pub fn open<R: Read + Seek>(mut input: R, options: Options) -> Result<Checked<Picture>, Error> {
    input.seek(SeekFrom::Start(0))?;
    let mut start = Vec::new();
    input.by_ref().take(4).read_to_end(&mut start)?;
    input.seek(SeekFrom::Start(0))?;
    let mut decoded = match start.as_slice() {
        [] => return Err(ErrorKind::Empty.into()),
        [0x89, b'P', b'N', b'G', ..] => png::decode(BufReader::new(input))?,
        [0xff, 0xd8, ..] => {
            let mut bytes = Vec::new();
            input.read_to_end(&mut bytes)?;
            jpeg::decode(&bytes)?
        }
        _ => tiff::decode(BufReader::new(input))?,
    };
    if options.linear {
        decoded.curve = Curve::Of(Encoding::Linear);
    }
    if decoded.samples.is_multiple_of(2) {
        let message = "the picture has alpha, which is not applied: samples are read as they are";
        decoded.findings.push(Finding::warning("I105", message));
    }
    let channels = (0..).zip(["R", "G", "B"]).map(|(k, name)| Channel::new(name, "", Meaning::Primary(k))).collect();
    let mut description = Description::planes(decoded.width, decoded.height, channels);
    let space = Space { encoding: Encoding::Linear, ..decoded.space };
    description.rgb = Some(RgbSpace { space, encoded: false, white_luminance: None });
    let linear = |most: u32| (0..=most).map(|v| decoded.curve.linear(f64::from(v) / f64::from(most))).collect();
    let table = match &decoded.stored {
        Stored::U8(_) => linear(u32::from(u8::MAX)),
        Stored::U16(_) => linear(u32::from(u16::MAX)),
        Stored::F32(_) => Vec::new(),
    };
    let steps = if decoded.planar { (1, description.pixels()) } else { (decoded.samples, 1) };
    let value = Picture { description, stored: decoded.stored, grey: decoded.samples < 3, steps, table };
    Ok(Checked { value, findings: decoded.findings })
}

pub(super) fn damaged(what: &str, error: &dyn std::fmt::Display) -> Error {
    let found = format!("a damaged {what} ({error})");
    ErrorKind::Unexpected { found, expected: "a whole one".to_owned() }.into()
}

/// Refuses what would not fit.
fn check_size(width: usize, height: usize) -> Result<(), Error> {
    if width.saturating_mul(height) <= MOST_PIXELS {
        return Ok(());
    }
    let found = format!("a picture of {width} × {height} pixels");
    Err(ErrorKind::Unsupported { found, expected: format!("up to {MOST_PIXELS} pixels") }.into())
}

fn not_rgb(found: String) -> Error {
    ErrorKind::Unsupported { found, expected: "a grey or an RGB picture".to_owned() }.into()
}

/// The space and curve where a file has only a profile, or nothing: sRGB, with a finding that says so.
fn assumed(profile: Option<&[u8]>) -> Finding {
    match profile {
        None => Finding::info("I102", "no colour space stated; sRGB taken"),
        Some(profile) => {
            let name = profile::name(profile).unwrap_or_else(|| "without a name".to_owned());
            let message = format!("the ICC profile ({name}) is not applied; sRGB taken");
            if name.contains("sRGB") {
                return Finding::info("I103", message);
            }
            Finding::warning("I103", message).hint("convert the picture to sRGB first")
        }
    }
}

impl Source for Picture {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        if out.is_empty() {
            return Ok(());
        }
        let (width, (to_pixel, to_component)) = (self.description.width, self.steps);
        let rows = out.par_chunks_exact_mut(channels.len() * region.width).enumerate();
        rows.for_each(|(y, out)| {
            let first = (region.y + y) * width + region.x;
            for (channel, out) in channels.iter().zip(out.chunks_exact_mut(region.width)) {
                let component = if self.grey { 0 } else { *channel };
                let places = (first..first + region.width).map(|pixel| pixel * to_pixel + component * to_component);
                let out = out.iter_mut().zip(places);
                match &self.stored {
                    Stored::U8(stored) => out.for_each(|(o, at)| *o = self.table[usize::from(stored[at])]),
                    Stored::U16(stored) => out.for_each(|(o, at)| *o = self.table[usize::from(stored[at])]),
                    Stored::F32(stored) => out.for_each(|(o, at)| *o = stored[at]),
                }
            }
        });
        Ok(())
    }
}

/// sRGB without a word about it.
fn srgb() -> (Space, Curve) {
    (SRGB, Curve::Of(Encoding::Srgb))
}
