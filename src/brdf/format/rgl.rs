//! RGL `.bsdf` tensor files: named arrays of the adaptive parameterisation ([`Adaptive`]).
//!
//! ```text
//! "tensor_file\0"  version (u8, u8)  number of fields (u32)
//! per field: length of the name (u16), name, dimensions (u16), type (u8), offset of the data (u64), sizes (u64 each)
//! ```
//!
//! Little-endian. Types: 1 u8, 10 f32; others (2 … 9, 11) are skipped unless a field that is needed has them. `spectra` with
//! `wavelengths` (nm) is read where present, else `rgb`. `luminance` serves sampling alone and is not read.
//!
//! Reference: J. Dupuy & W. Jakob (2018) and the description of the files published with the RGL material database.

use super::error::{Error, ErrorKind};
use crate::brdf::table::{Adaptive, AdaptiveFields, Channel};
use crate::finding::{Checked, Finding, Location};

/// How a file begins.
pub(super) const MAGIC: &[u8] = b"tensor_file\0";
/// More fields than any file has.
const MOST_FIELDS: u32 = 1000;
const U8: u8 = 1;
const F32: u8 = 10;

/// A field as its description tells; the data are those bytes of the file.
struct Field<'a> {
    name: &'a [u8],
    kind: u8,
    shape: Vec<usize>,
    data: &'a [u8],
}

/// Reads bytes from the front.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Error> {
        let taken = self.bytes.get(self.at..).and_then(|rest| rest.get(..count));
        self.at = self.at.saturating_add(count);
        taken.ok_or_else(|| {
            let what = "the description of the fields".to_owned();
            error(ErrorKind::Length { found: self.bytes.len() as u64, expected: self.at as u64, what })
        })
    }

    fn number(&mut self, bytes: usize) -> Result<u64, Error> {
        Ok(self.take(bytes)?.iter().rev().fold(0, |n, b| n << 8 | u64::from(*b)))
    }
}

fn error(kind: ErrorKind) -> Error {
    Error::new(Location::default(), kind)
}

/// Reads a table.
///
/// # Errors
/// [`Error`] for a file that is cut off, fields that are missing or have other shapes than the format says. Nothing is allocated
/// beyond the bytes that the file has.
pub fn parse(bytes: &[u8]) -> Result<Checked<Adaptive>, Error> {
    let fields = fields(bytes)?;
    let field = |name: &str| fields.iter().find(|f| f.name == name.as_bytes());
    let needed =
        |name: &str| field(name).ok_or_else(|| error(ErrorKind::unexpected(format!("no field `{name}`"), "one")));
    let (theta_i, phi_i) = (angles(needed("theta_i")?)?, angles(needed("phi_i")?)?);
    let (ndf, sigma, vndf) = (needed("ndf")?, needed("sigma")?, needed("vndf")?);
    let (spectra, channels) = match (field("spectra"), field("wavelengths")) {
        (Some(spectra), Some(wavelengths)) => {
            (spectra, angles(wavelengths)?.into_iter().map(Channel::Wavelength).collect())
        }
        _ => (needed("rgb")?, Channel::rgb()),
    };
    let incidences = [phi_i.len(), theta_i.len()];
    let ndf_shape = shape(ndf, &[])?;
    let sigma_shape = shape(sigma, &[])?;
    let vndf_shape = shape(vndf, &incidences)?;
    let spectra_shape = shape(spectra, &[phi_i.len(), theta_i.len(), channels.len()])?;
    let jacobian = needed("jacobian")?;
    if jacobian.kind != U8 || jacobian.data.is_empty() {
        return Err(error(ErrorKind::unexpected("a field `jacobian` of another type", "one byte")));
    }
    let mut findings = Vec::new();
    if let Some(description) = field("description").filter(|f| f.kind == U8) {
        let words = String::from_utf8_lossy(description.data);
        findings.push(Finding::info("B109", format!("the file's own description: {}", words.trim_end_matches('\0'))));
    }
    let table = Adaptive::new(AdaptiveFields {
        theta_i,
        phi_i,
        channels,
        ndf_shape,
        ndf: floats(ndf)?,
        sigma_shape,
        sigma: floats(sigma)?,
        vndf_shape,
        vndf: floats(vndf)?,
        spectra_shape,
        spectra: floats(spectra)?,
        jacobian: jacobian.data[0] != 0,
    })?;
    Ok(Checked { value: table, findings })
}

fn fields(bytes: &[u8]) -> Result<Vec<Field<'_>>, Error> {
    let mut cursor = Cursor { bytes, at: 0 };
    if cursor.take(MAGIC.len())? != MAGIC {
        return Err(error(ErrorKind::unexpected("a file without the mark `tensor_file`", "an RGL tensor file")));
    }
    let version = cursor.take(2)?;
    if version[0] != 1 {
        let found = format!("version {}.{}", version[0], version[1]);
        return Err(error(ErrorKind::unexpected(found, "version 1 of the tensor files")));
    }
    #[expect(clippy::cast_possible_truncation, reason = "four bytes")]
    let count = cursor.number(4)? as u32;
    if count > MOST_FIELDS {
        return Err(error(ErrorKind::unexpected(format!("{count} fields"), format!("at most {MOST_FIELDS}"))));
    }
    (0..count).map(|_| read_field(&mut cursor)).collect()
}

fn read_field<'a>(cursor: &mut Cursor<'a>) -> Result<Field<'a>, Error> {
    let length = usize::try_from(cursor.number(2)?).unwrap_or(usize::MAX);
    let name = cursor.take(length)?;
    let dimensions = cursor.number(2)?;
    let kind = cursor.take(1)?[0];
    let offset = cursor.number(8)?;
    if dimensions > 8 {
        return Err(error(ErrorKind::unexpected(format!("a field of {dimensions} dimensions"), "at most 8")));
    }
    let sizes = (0..dimensions).map(|_| cursor.number(8)).collect::<Result<Vec<u64>, _>>()?;
    let width: u64 = match kind {
        U8 | 2 => 1,
        3 | 4 | 9 => 2,
        5 | 6 | F32 => 4,
        7 | 8 | 11 => 8,
        _ => return Err(error(ErrorKind::unexpected(format!("a field of type {kind}"), "a type from 1 to 11"))),
    };
    let length = sizes.iter().try_fold(width, |n, size| n.checked_mul(*size));
    let end = length.and_then(|l| l.checked_add(offset)).unwrap_or(u64::MAX);
    let data = usize::try_from(offset).ok().zip(usize::try_from(end).ok()).and_then(|(a, b)| cursor.bytes.get(a..b));
    let Some(data) = data else {
        let what = format!("the field `{}`", String::from_utf8_lossy(name));
        return Err(error(ErrorKind::Length { found: cursor.bytes.len() as u64, expected: end, what })
            .with_hint("the file may be cut off"));
    };
    // Each size divides the length of data that is there, unless one of them is 0.
    let shape = sizes.iter().map(|s| usize::try_from(*s).unwrap_or(usize::MAX)).collect();
    Ok(Field { name, kind, shape, data })
}

/// The last two sizes of a field whose others are as told.
fn shape(field: &Field<'_>, outer: &[usize]) -> Result<[usize; 2], Error> {
    match field.shape.as_slice() {
        [before @ .., rows, columns] if before == outer => Ok([*rows, *columns]),
        _ => {
            let found = format!("a field `{}` of sizes {:?}", String::from_utf8_lossy(field.name), field.shape);
            Err(error(ErrorKind::unexpected(found, format!("{outer:?}, rows and columns"))))
        }
    }
}

fn floats(field: &Field<'_>) -> Result<Vec<f32>, Error> {
    if field.kind != F32 {
        let found = format!("a field `{}` of type {}", String::from_utf8_lossy(field.name), field.kind);
        return Err(error(ErrorKind::unexpected(found, "32-bit floats (type 10)")));
    }
    Ok(field.data.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
}

/// A field of one dimension.
fn angles(field: &Field<'_>) -> Result<Vec<f64>, Error> {
    if field.shape.len() != 1 {
        let found = format!("a field `{}` of {} dimensions", String::from_utf8_lossy(field.name), field.shape.len());
        return Err(error(ErrorKind::unexpected(found, "one dimension")));
    }
    Ok(floats(field)?.into_iter().map(f64::from).collect())
}
