//! NPY, NumPy's format for one array ("NEP 1", versions 1.0 to 3.0), by hand.
//!
//! An image is an array of shape (rows, columns, channels), or (rows, columns) for one channel; its elements are any of the types
//! that ENVI knows, or 16-bit floats, in either byte order. In C order the channels of a pixel lie beside one another; in Fortran order the rows of
//! a column do, and reading a few rows at a time takes many short pieces of the file. An array says nothing of wavelengths, units
//! or quantities: the caller does. Written are little-endian 32-bit floats in C order.

use std::io::{Read, Seek, SeekFrom, Write};

use exr::prelude::f16;

use super::envi::{ByteOrder, DataType, Envi, Header, Interleave, Options, WriteOptions, open_numbers, write_numbers};
use crate::finding::{Checked, Finding};
use crate::image::description::Description;
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{self, Region, Source};

/// The first bytes of every file.
pub const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// The longest header that is read.
const LONGEST_HEADER: usize = 1 << 16;
/// Bytes before the first number come in multiples of this.
const ALIGNMENT: usize = 64;

/// An array being read.
pub struct Npy<R> {
    /// The numbers; of an array in Fortran order as an image whose rows are the columns.
    numbers: Envi<R>,
    description: Description,
    fortran: bool,
    /// The numbers are the bits of 16-bit floats.
    half: bool,
    /// What was read of `numbers`; kept between reads.
    columns: Vec<f32>,
}

/// Opens an array. `wavelengths_nm` has one entry per channel, or none where the channels are no bands.
///
/// # Errors
/// Where it is no array of an image's shape and type, is cut off, or has another number of channels.
pub fn open<R: Read + Seek + Send>(
    mut input: R,
    wavelengths_nm: Vec<f64>,
    options: Options,
) -> Result<Checked<Npy<R>>, Error> {
    let (mut header, Layout { fortran, half }) = header(&mut input)?;
    let bands = header.bands;
    if !wavelengths_nm.is_empty() && wavelengths_nm.len() != bands {
        let expected = format!("{bands}, one for each channel of the array");
        let kind = ErrorKind::Count { found: wavelengths_nm.len(), field: "the wavelengths".to_owned(), expected };
        return Err(kind.into());
    }
    header.wavelengths = wavelengths_nm;
    header.wavelength_unit = Some(crate::spectrum::WavelengthUnit::Nanometre);
    let Checked { value: numbers, findings } = open_numbers(header, input, options)?;
    let mut description = numbers.description().clone();
    if fortran {
        (description.width, description.height) = (description.height, description.width);
    }
    Ok(Checked { value: Npy { numbers, description, fortran, half, columns: Vec::new() }, findings })
}

impl<R: Read + Seek + Send> Source for Npy<R> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        if !self.fortran {
            self.numbers.read(region, channels, out)?;
            if self.half {
                floats(out);
            }
            return Ok(());
        }
        source::check(&self.description, region, channels, out);
        let Region { width, height, .. } = region;
        self.columns.resize(out.len(), 0.0);
        let turned = Region { x: region.y, y: region.x, width: height, height: width };
        self.numbers.read(turned, channels, &mut self.columns)?;
        if self.half {
            floats(&mut self.columns);
        }
        let count = channels.len();
        for (i, out) in out.chunks_exact_mut(width.max(1)).enumerate() {
            let (y, k) = (i / count, i % count);
            for (x, out) in out.iter_mut().enumerate() {
                *out = self.columns[(x * count + k) * height + y];
            }
        }
        Ok(())
    }

    fn findings(&self) -> Vec<Finding> {
        self.numbers.findings()
    }
}

/// Makes 16-bit floats of their bits, which were read as integers.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65535")]
fn floats(samples: &mut [f32]) {
    samples.iter_mut().for_each(|v| *v = f16::from_bits(*v as u16).to_f32());
}

/// What a header says that one of ENVI's does not.
struct Layout {
    fortran: bool,
    half: bool,
}

/// The number of channels of an array.
///
/// # Errors
/// As [`open`].
pub fn channels(input: &mut (impl Read + Seek)) -> Result<usize, Error> {
    header(input).map(|(header, _)| header.bands)
}

/// What the header says, as one of ENVI's, and the rest.
fn header(input: &mut (impl Read + Seek)) -> Result<(Header, Layout), Error> {
    let (text, offset) = header_text(input)?;
    let (data_type, byte_order, half) = element(field(&text, "descr")?)?;
    let fortran = match field(&text, "fortran_order")? {
        "False" => false,
        "True" => true,
        other => {
            let (field, expected) = ("`fortran_order`".to_owned(), "True or False".to_owned());
            return Err(ErrorKind::Value { found: other.to_owned(), field, expected }.into());
        }
    };
    let shape = field(&text, "shape")?;
    let sizes: Option<Vec<usize>> = shape
        .trim_matches(['(', ')'])
        .split(',')
        .map(str::trim)
        .filter(|s| !s.is_empty())
        .map(|s| s.parse().ok().filter(|n| *n > 0))
        .collect();
    let (lines, samples, bands) = match sizes.as_deref() {
        Some([lines, samples]) => (*lines, *samples, 1),
        Some([lines, samples, bands]) => (*lines, *samples, *bands),
        _ => {
            let expected = "(rows, columns, channels) or (rows, columns), none of them 0".to_owned();
            return Err(ErrorKind::Value { found: shape.to_owned(), field: "`shape`".to_owned(), expected }.into());
        }
    };
    let mut header = if fortran {
        Header::new(lines, samples, bands, data_type)
    } else {
        Header::new(samples, lines, bands, data_type)
    };
    header.interleave = if fortran { Interleave::Bsq } else { Interleave::Bip };
    (header.byte_order, header.offset) = (byte_order, offset);
    Ok((header, Layout { fortran, half }))
}

/// The dictionary, and where the numbers begin.
fn header_text(input: &mut (impl Read + Seek)) -> Result<(String, u64), Error> {
    input.seek(SeekFrom::Start(0))?;
    let mut start = [0; 8];
    fill(input, &mut start)?;
    if !start.starts_with(MAGIC) {
        let expected = "an NPY file".to_owned();
        return Err(ErrorKind::Unexpected { found: "other first bytes".to_owned(), expected }.into());
    }
    let (length, before) = if start[6] == 1 {
        let mut length = [0; 2];
        fill(input, &mut length)?;
        (usize::from(u16::from_le_bytes(length)), 10)
    } else {
        let mut length = [0; 4];
        fill(input, &mut length)?;
        (u32::from_le_bytes(length) as usize, 12)
    };
    if length > LONGEST_HEADER {
        let expected = format!("at most {LONGEST_HEADER}");
        let field = "the length of the header".to_owned();
        return Err(ErrorKind::Value { found: length.to_string(), field, expected }.into());
    }
    let mut text = vec![0; length];
    fill(input, &mut text)?;
    Ok((String::from_utf8_lossy(&text).into_owned(), (before + length) as u64))
}

/// Reads as many bytes as `out` has, of a header.
fn fill(input: &mut impl Read, out: &mut [u8]) -> Result<(), Error> {
    input.read_exact(out).map_err(|error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof => {
            let (found, expected) = ("the end of the file in its header", "a whole NPY file");
            ErrorKind::Unexpected { found: found.to_owned(), expected: expected.to_owned() }.into()
        }
        _ => error.into(),
    })
}

/// The value of a key in the dictionary literal.
fn field<'a>(text: &'a str, key: &str) -> Result<&'a str, Error> {
    let missing =
        || ErrorKind::Missing { field: key.to_owned(), expected: "it in the header of an NPY file".to_owned() };
    let quoted = [format!("'{key}'"), format!("\"{key}\"")];
    let at = quoted.iter().find_map(|q| Some(text.find(q.as_str())? + q.len())).ok_or_else(missing)?;
    let rest = text[at..].trim_start().strip_prefix(':').ok_or_else(missing)?.trim_start();
    let end = if rest.starts_with('(') { rest.find(')').map(|e| e + 1) } else { rest.find([',', '}']) };
    Ok(rest[..end.ok_or_else(missing)?].trim().trim_matches(['\'', '"']))
}

/// The type and order that `<f4`, `>u2`, `|u1` … stand for, and whether they are the bits of 16-bit floats.
fn element(descr: &str) -> Result<(DataType, ByteOrder, bool), Error> {
    let order = match descr.chars().next() {
        Some('<' | '|') => Some(ByteOrder::Little),
        Some('>') => Some(ByteOrder::Big),
        _ => None,
    };
    let kind = match descr.get(1..) {
        Some("u1") => Some(DataType::U8),
        Some("i2") => Some(DataType::I16),
        Some("i4") => Some(DataType::I32),
        Some("f4") => Some(DataType::F32),
        Some("f8") => Some(DataType::F64),
        Some("u2" | "f2") => Some(DataType::U16),
        Some("u4") => Some(DataType::U32),
        Some("i8") => Some(DataType::I64),
        Some("u8") => Some(DataType::U64),
        _ => None,
    };
    let half = descr.ends_with("f2");
    kind.zip(order).map(|(kind, order)| (kind, order, half)).ok_or_else(|| {
        let expected = "one of u1, u2, u4, u8, i2, i4, i8, f2, f4, f8 with its byte order, such as <f4".to_owned();
        ErrorKind::Value { found: format!("`{descr}`"), field: "`descr`".to_owned(), expected }.into()
    })
}

/// Writes an image as an array of shape (rows, columns, channels), or (rows, columns) where it has one channel.
///
/// # Errors
/// Those of the source and of the writer.
pub fn write<W: Write + Seek>(mut out: W, source: &mut dyn Source) -> Result<Vec<Finding>, Error> {
    let d = source.description();
    let shape = match d.channels.len() {
        1 => format!("({}, {})", d.height, d.width),
        channels => format!("({}, {}, {channels})", d.height, d.width),
    };
    let mut text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (10 + text.len() + 1).next_multiple_of(ALIGNMENT) - 10;
    text.push_str(&" ".repeat(length - text.len() - 1));
    text.push('\n');
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    // The text is a few dozen bytes and two or three numbers.
    out.write_all(&u16::try_from(length).unwrap_or(u16::MAX).to_le_bytes())?;
    out.write_all(text.as_bytes())?;
    let options = WriteOptions { interleave: Interleave::Bip, ..WriteOptions::default() };
    write_numbers(out, source, options, 10 + length as u64)
}
