//! A photograph: its codes, and the exposure time in its EXIF data.

use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult};

use super::Error;
use crate::image::format::exr;
use crate::image::{Region, Source};

/// The codes of a photograph.
#[derive(Debug, Clone, PartialEq)]
pub struct Photo {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 (grey) or 3 (red, green, blue); what the file has besides is dropped.
    pub channels: usize,
    /// The samples.
    pub codes: Codes,
}

/// Samples as the file stores them.
#[derive(Debug, Clone, PartialEq)]
pub enum Codes {
    /// 8 bits.
    Eight(Vec<u8>),
    /// 16 bits.
    Sixteen(Vec<u16>),
    /// Linear samples of a developed raw photograph; 1 is where it saturates.
    Linear(Vec<f32>),
}

impl Photo {
    /// Decodes a photograph without touching its codes: PNG, JPEG; TIFF of 16 bits or floats and EXR, which are taken as linear.
    ///
    /// # Errors
    /// [`Error::Undecodable`].
    pub fn decode(bytes: &[u8]) -> Result<Self, Error> {
        match bytes {
            [0x76, 0x2f, 0x31, 0x01, ..] => return linear_exr(bytes),
            [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => return linear_tiff(bytes),
            _ => {}
        }
        let wrong = |e: image::ImageError| Error::Undecodable { reason: e.to_string() };
        let picture = image::load_from_memory(bytes).map_err(wrong)?;
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let grey = !picture.color().has_color();
        let deep = picture.color().bytes_per_pixel() / picture.color().channel_count() > 1;
        let codes = match (grey, deep) {
            (true, false) => Codes::Eight(picture.into_luma8().into_raw()),
            (true, true) => Codes::Sixteen(picture.into_luma16().into_raw()),
            (false, false) => Codes::Eight(picture.into_rgb8().into_raw()),
            (false, true) => Codes::Sixteen(picture.into_rgb16().into_raw()),
        };
        Ok(Self { width, height, channels: if grey { 1 } else { 3 }, codes })
    }

    /// Code of sample `i`, 0 to 255.
    #[must_use]
    pub fn code(&self, i: usize) -> f64 {
        match &self.codes {
            Codes::Eight(codes) => f64::from(codes[i]),
            Codes::Sixteen(codes) => f64::from(codes[i]) / 257.0,
            Codes::Linear(values) => 255.0 * f64::from(values[i]),
        }
    }

    /// Whether its format says that the codes are proportional to exposure.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        matches!(self.codes, Codes::Linear(_))
    }

    /// Size and channels in words.
    #[must_use]
    pub fn size(&self) -> String {
        format!("{} × {} pixels in {} channel(s)", self.width, self.height, self.channels)
    }

    /// Rec. 709 luma of the codes, 0 to 255: for finding patterns, not for measuring.
    #[must_use]
    pub fn luma(&self) -> Vec<f32> {
        #[expect(clippy::cast_possible_truncation, reason = "deliberate: pixels are f32")]
        let at = |i: usize| match self.channels {
            1 => self.code(i) as f32,
            _ => (0.2126 * self.code(3 * i) + 0.7152 * self.code(3 * i + 1) + 0.0722 * self.code(3 * i + 2)) as f32,
        };
        (0..self.width * self.height).map(at).collect()
    }
}

fn undecodable(reason: impl ToString) -> Error {
    Error::Undecodable { reason: reason.to_string() }
}

fn linear_tiff(bytes: &[u8]) -> Result<Photo, Error> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(undecodable)?;
    let (width, height) = decoder.dimensions().map_err(undecodable)?;
    let channels = match decoder.colortype().map_err(undecodable)? {
        tiff::ColorType::Gray(_) => 1,
        tiff::ColorType::RGB(_) => 3,
        other => return Err(undecodable(format!("a TIFF of {other:?}; expected grey or RGB"))),
    };
    let values = match decoder.read_image().map_err(undecodable)? {
        DecodingResult::U16(v) => v.into_iter().map(|v| f32::from(v) / 65535.0).collect(),
        DecodingResult::F32(v) => v,
        _ => return Err(undecodable("a TIFF of other than 16 bits or 32-bit floats")),
    };
    let (width, height) = (width as usize, height as usize);
    if values.len() != width * height * channels {
        return Err(undecodable("a TIFF of separate planes"));
    }
    Ok(Photo { width, height, channels, codes: Codes::Linear(values) })
}

fn linear_exr(bytes: &[u8]) -> Result<Photo, Error> {
    let mut source = exr::open(Cursor::new(bytes)).map_err(undecodable)?.value;
    let description = source.description().clone();
    let number = |name: &str| description.channels.iter().position(|c| c.name == name);
    let rgb: Vec<usize> = ["R", "G", "B"].into_iter().filter_map(number).collect();
    let numbers = match (rgb.len(), number("Y")) {
        (3, _) => rgb,
        (_, Some(grey)) => vec![grey],
        _ => return Err(undecodable("an EXR without channels R, G, B or Y")),
    };
    let (width, height, channels) = (description.width, description.height, numbers.len());
    let mut rows = vec![0.0; width * channels];
    let mut values = Vec::with_capacity(width * height * channels);
    for y in 0..height {
        source.read(Region::rows(&description, y, 1), &numbers, &mut rows).map_err(undecodable)?;
        values.extend((0..width).flat_map(|x| (0..channels).map(move |c| c * width + x)).map(|i| rows[i]));
    }
    Ok(Photo { width, height, channels, codes: Codes::Linear(values) })
}

/// The exposure time that the EXIF data of a photograph state, s; `None` where there are none or no time in them.
#[must_use]
pub fn exif_time_s(bytes: &[u8]) -> Option<f64> {
    let exif = exif::Reader::new().read_from_container(&mut Cursor::new(bytes)).ok()?;
    let field = exif.get_field(exif::Tag::ExposureTime, exif::In::PRIMARY)?;
    match &field.value {
        exif::Value::Rational(times) => times.first().map(exif::Rational::to_f64).filter(|t| t.is_finite() && *t > 0.0),
        _ => None,
    }
}
