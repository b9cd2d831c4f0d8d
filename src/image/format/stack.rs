//! Stacks: one grey picture per band (PNG, TIFF or EXR), as filter wheels and tunable light sources give them.
//!
//! Samples are the stored numbers, taken as linear: (number − dark) · gain per picture. Pictures are compressed whole, so they
//! are read one after the other into a scratch file of plain `f32`, from which regions are then read: memory holds one picture,
//! whatever their number.

use std::io::{BufReader, Cursor, Read, Seek, SeekFrom, Write};

use tiff::decoder::{Decoder, DecodingResult, Limits};

use super::envi::{DataType, Envi, Header, Options, open_numbers};
use super::exr;
use super::picture::{MOST_PIXELS, damaged};
use crate::finding::{Checked, Location};
use crate::image::error::{Error, ErrorKind};
use crate::image::memory::Memory;
use crate::image::source::Source;
use crate::spectrum::WavelengthUnit;

/// One band of a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// The picture's file, as in the list.
    pub file: String,
    /// Centre wavelength, nm.
    pub wavelength_nm: f64,
    /// What the stored number less the dark one is multiplied by.
    pub gain: f64,
    /// The stored number of darkness.
    pub dark: f64,
}

/// The wavelength (nm) in a file's name: the number before `nm`, or else the only number of three or four digits.
#[must_use]
pub fn wavelength_of_name(name: &str) -> Option<f64> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_lowercase();
    let mut numbers: Vec<(f64, bool)> = Vec::new();
    let mut rest = stem.as_str();
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit()) {
        let digits = &rest[at..];
        let end = digits.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(digits.len());
        let number = digits[..end].trim_end_matches('.');
        let unit = digits[end..].trim_start_matches(['_', '-', ' ']).starts_with("nm");
        numbers.extend(number.parse().ok().map(|n| (n, unit)));
        rest = &digits[end..];
    }
    let named: Vec<f64> = numbers.iter().filter(|n| n.1).map(|n| n.0).collect();
    let likely: Vec<f64> = numbers.iter().map(|n| n.0).filter(|n| (100.0..10_000.0).contains(n)).collect();
    match (named.as_slice(), likely.as_slice()) {
        ([one], _) | ([], [one]) if *one > 0.0 => Some(*one),
        _ => None,
    }
}

/// Reads a list of bands: a CSV table with the columns `file` (which may be absent), `wavelength_nm` and, where wanted, `gain`
/// and `dark`.
///
/// # Errors
/// Where a column or a number is missing; with the line.
pub fn read_list(text: &str) -> Result<Vec<Band>, Error> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let broken = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        let found = format!("a broken table ({error})");
        Error::new(Location::line(line), ErrorKind::Unexpected { found, expected: "rows of equal length".to_owned() })
    };
    let headers = reader.headers().map_err(broken)?.clone();
    let column = |name: &str| headers.iter().position(|h| h.eq_ignore_ascii_case(name));
    let Some(wavelength) = column("wavelength_nm") else {
        let expected = "a header row with it, and file, gain, dark where wanted".to_owned();
        return Err(Error::new(Location::line(1), ErrorKind::Missing { field: "wavelength_nm".to_owned(), expected }));
    };
    let mut out = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(1, csv::Position::line);
        let number = |at: Option<usize>, name: &str, absent: f64| {
            let Some(text) = at.map(|i| &record[i]).filter(|t| !t.is_empty()) else { return Ok(absent) };
            text.parse().ok().filter(|v: &f64| v.is_finite()).ok_or_else(|| {
                let (found, field) = (format!("`{text}`"), name.to_owned());
                Error::new(Location::line(line), ErrorKind::Value { found, field, expected: "a number".to_owned() })
            })
        };
        out.push(Band {
            file: column("file").map_or(String::new(), |i| record[i].to_owned()),
            wavelength_nm: number(Some(wavelength), "wavelength_nm", f64::NAN)?,
            gain: number(column("gain"), "gain", 1.0)?,
            dark: number(column("dark"), "dark", 0.0)?,
        });
    }
    if out.is_empty() {
        let expected = "a row per band".to_owned();
        return Err(Error::new(Location::line(1), ErrorKind::Unexpected { found: "no row".to_owned(), expected }));
    }
    Ok(out)
}

/// A picture's samples, row after row.
struct Picture {
    width: usize,
    height: usize,
    samples: Vec<f32>,
}

/// Reads the pictures of a stack one after the other and opens them as one image by way of `scratch`, which is overwritten.
///
/// # Errors
/// Where a picture cannot be read, is not grey, or has another size than the first; with its file.
pub fn gather<S: Read + Write + Seek + Send>(
    bands: &[Band],
    mut picture: impl FnMut(&Band) -> std::io::Result<Vec<u8>>,
    mut scratch: S,
    options: Options,
) -> Result<Checked<Envi<S>>, Error> {
    let mut size = None;
    scratch.seek(SeekFrom::Start(0))?;
    for band in bands {
        let bytes = picture(band).map_err(|e| Error::from(e).in_file(&band.file))?;
        let read = grey(bytes).map_err(|e| e.in_file(&band.file))?;
        let (width, height) = *size.get_or_insert((read.width, read.height));
        if (read.width, read.height) != (width, height) {
            let found = format!("{} × {} pixels", read.width, read.height);
            let expected = format!("{width} × {height} as in {}", bands[0].file);
            return Err(Error::from(ErrorKind::Unexpected { found, expected }).in_file(&band.file));
        }
        let bytes: Vec<u8> = read.samples.iter().flat_map(|v| v.to_le_bytes()).collect();
        scratch.write_all(&bytes)?;
    }
    scratch.flush()?;
    let (width, height) = size.ok_or(ErrorKind::Empty)?;
    let mut header = Header::new(width, height, bands.len(), DataType::F32);
    header.wavelengths = bands.iter().map(|b| b.wavelength_nm).collect();
    header.wavelength_unit = Some(WavelengthUnit::Nanometre);
    header.gains = bands.iter().map(|b| b.gain).collect();
    header.offsets = bands.iter().map(|b| -b.dark * b.gain).collect();
    open_numbers(header, scratch, options)
}

/// A grey picture by its first bytes.
fn grey(bytes: Vec<u8>) -> Result<Picture, Error> {
    match bytes.as_slice() {
        [0x89, b'P', b'N', b'G', ..] => png(&bytes),
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => tiff(&bytes),
        [0x76, 0x2f, 0x31, 0x01, ..] => exr(bytes),
        [] => Err(ErrorKind::Empty.into()),
        _ => {
            let expected = "a PNG, TIFF or EXR picture".to_owned();
            Err(ErrorKind::Unexpected { found: "another kind of file".to_owned(), expected }.into())
        }
    }
}

fn not_grey(found: String) -> Error {
    let error = Error::from(ErrorKind::Unsupported { found, expected: "a grey picture of one channel".to_owned() });
    error.with_hint("save one channel per wavelength")
}

fn png(bytes: &[u8]) -> Result<Picture, Error> {
    let mut reader = image::ImageReader::with_format(Cursor::new(bytes), image::ImageFormat::Png);
    reader.limits(image::Limits::no_limits());
    let picture = reader.decode().map_err(|e| damaged("PNG picture", &e))?;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let samples = match picture {
        image::DynamicImage::ImageLuma8(p) => p.into_raw().into_iter().map(f32::from).collect(),
        image::DynamicImage::ImageLuma16(p) => p.into_raw().into_iter().map(f32::from).collect(),
        other => return Err(not_grey(format!("a PNG picture of type {:?}", other.color()))),
    };
    Ok(Picture { width, height, samples })
}

#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "pixels are f32")]
fn tiff(bytes: &[u8]) -> Result<Picture, Error> {
    let failed = |e: tiff::TiffError| damaged("TIFF picture", &e);
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_PIXELS * 4;
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(failed)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(failed)?;
    let kind = decoder.colortype().map_err(failed)?;
    if !matches!(kind, tiff::ColorType::Gray(_)) {
        return Err(not_grey(format!("a TIFF picture of type {kind:?}")));
    }
    let samples: Vec<f32> = match decoder.read_image().map_err(failed)? {
        DecodingResult::U8(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::U16(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::U32(v) => v.into_iter().map(|v| v as f32).collect(),
        DecodingResult::U64(v) => v.into_iter().map(|v| v as f32).collect(),
        DecodingResult::I8(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::I16(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::I32(v) => v.into_iter().map(|v| v as f32).collect(),
        DecodingResult::I64(v) => v.into_iter().map(|v| v as f32).collect(),
        DecodingResult::F32(v) => v,
        DecodingResult::F64(v) => v.into_iter().map(|v| v as f32).collect(),
        _ => return Err(not_grey(format!("a TIFF picture of type {kind:?}"))),
    };
    let (width, height) = (width as usize, height as usize);
    if samples.len() != width * height {
        return Err(damaged("TIFF picture", &format!("{} samples", samples.len())));
    }
    Ok(Picture { width, height, samples })
}

fn exr(bytes: Vec<u8>) -> Result<Picture, Error> {
    let mut source = exr::open(BufReader::new(Cursor::new(bytes)))?.value;
    let d = source.description();
    if d.channels.len() != 1 || d.pixels() > MOST_PIXELS {
        return Err(not_grey(format!("an EXR picture of {} channels and {} pixels", d.channels.len(), d.pixels())));
    }
    let image = Memory::load(&mut source)?;
    let (width, height) = (image.description().width, image.description().height);
    Ok(Picture { width, height, samples: image.samples().to_vec() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_are_found_in_names() {
        for (name, wavelength) in [
            ("550nm.tif", Some(550.0)),
            ("scene3_band12_632.8-nm.png", Some(632.8)),
            ("img_0550.png", Some(550.0)),
            ("shot-2-700.exr", Some(700.0)),
            ("a_400_500.tif", None),
            ("flower.tif", None),
            ("0nm.tif", None),
        ] {
            assert_eq!(wavelength_of_name(name), wavelength, "{name}");
        }
    }
}
