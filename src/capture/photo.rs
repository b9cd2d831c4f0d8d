//! A photograph: its codes, and the exposure time in its EXIF data.

use std::io::{BufRead, Cursor, Seek};
use std::ops::Range;

use super::Error;
use super::rows::{PhotoRows, undecodable};

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
        let mut rows = PhotoRows::open(Cursor::new(bytes))?;
        rows.next(rows.height)
    }

    /// Some of its rows.
    #[must_use]
    pub fn rows(&self, rows: Range<usize>) -> Self {
        let samples = rows.start * self.width * self.channels..rows.end * self.width * self.channels;
        let codes = match &self.codes {
            Codes::Eight(v) => Codes::Eight(v[samples].to_vec()),
            Codes::Sixteen(v) => Codes::Sixteen(v[samples].to_vec()),
            Codes::Linear(v) => Codes::Linear(v[samples].to_vec()),
        };
        Self { height: rows.len(), codes, ..*self }
    }

    /// Adds rows below it.
    ///
    /// # Panics
    /// For rows of another photograph: of another width, or of codes of another kind.
    pub fn append(&mut self, below: &Self) {
        assert_eq!((self.width, self.channels), (below.width, below.channels), "rows of one photograph");
        self.height += below.height;
        match (&mut self.codes, &below.codes) {
            (Codes::Eight(v), Codes::Eight(more)) => v.extend_from_slice(more),
            (Codes::Sixteen(v), Codes::Sixteen(more)) => v.extend_from_slice(more),
            (Codes::Linear(v), Codes::Linear(more)) => v.extend_from_slice(more),
            _ => panic!("rows of one photograph"),
        }
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
        size(self.width, self.height, self.channels)
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

/// Size and channels in words.
pub(super) fn size(width: usize, height: usize, channels: usize) -> String {
    format!("{width} × {height} pixels in {channels} channel(s)")
}

/// Decodes a file that cannot be decoded by rows: JPEG.
pub(super) fn decode_whole(input: impl BufRead + Seek) -> Result<Photo, Error> {
    let mut reader = image::ImageReader::new(input).with_guessed_format().map_err(undecodable)?;
    reader.no_limits();
    let picture = reader.decode().map_err(undecodable)?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let grey = !picture.color().has_color();
    let codes = Codes::Eight(if grey { picture.into_luma8().into_raw() } else { picture.into_rgb8().into_raw() });
    Ok(Photo { width, height, channels: if grey { 1 } else { 3 }, codes })
}

/// The exposure time that the EXIF data of a photograph state, s; `None` where there are none or no time in them.
#[must_use]
pub fn exif_time_s(input: &mut (impl BufRead + Seek)) -> Option<f64> {
    let exif = exif::Reader::new().read_from_container(input).ok()?;
    let field = exif.get_field(exif::Tag::ExposureTime, exif::In::PRIMARY)?;
    match &field.value {
        exif::Value::Rational(times) => times.first().map(exif::Rational::to_f64).filter(|t| t.is_finite() && *t > 0.0),
        _ => None,
    }
}
