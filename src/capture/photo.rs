//! A photograph: its codes, and the exposure time in its EXIF data.

use std::io::Cursor;

use super::Error;

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
}

impl Photo {
    /// Decodes a PNG or a JPEG without touching its codes.
    ///
    /// # Errors
    /// [`Error::Undecodable`].
    pub fn decode(bytes: &[u8]) -> Result<Self, Error> {
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
        }
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
