//! MERL `.binary` tables: three 32-bit numbers of bins (θ_h, θ_d, φ_d), then the red, green and blue planes as 64-bit floats,
//! little-endian, φ_d fastest.
//!
//! ```text
//! f_r = value · (1/1500, 1.15/1500, 1.66/1500)      red, green, blue; a negative value marks a bin without measurement
//! ```
//!
//! Values are kept in single precision (6e-8 relative). A bin that lacks one channel lacks all. Missing bins are written as −1.
//!
//! Reference: W. Matusik et al., *A Data-Driven Reflectance Model* (2003), and the reader published with the database.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

use super::error::{Error, ErrorKind};
use crate::brdf::table::{Channel, HalfAngle, Known, Resolution};
use crate::finding::{Checked, Finding, Location};

/// Bytes of the three numbers of bins.
pub const HEADER: usize = 12;
/// Bins that are read together: three runs of 64 KiB, which stay in a core's own cache.
const BLOCK: usize = 8192;
/// 1/sr per unit of the file, red, green, blue.
const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
/// What is not below it is no value: single precision could not keep it.
const MOST: f64 = 1e38;

/// Whether the length is that of a table with the numbers of bins at its beginning.
#[must_use]
pub fn is_merl(bytes: &[u8]) -> bool {
    begins(bytes, bytes.len() as u64)
}

/// The same from the first [`HEADER`] bytes and the length of a file.
#[must_use]
pub fn begins(start: &[u8], length: u64) -> bool {
    dimensions(start).is_some_and(|n| Some(length) == whole_length(n))
}

/// The numbers of bins that a file begins with, if all are positive and a table could have them.
fn dimensions(bytes: &[u8]) -> Option<[u64; 3]> {
    let header = bytes.get(..HEADER)?;
    let number = |i: usize| u64::from(u32::from_le_bytes([header[i], header[i + 1], header[i + 2], header[i + 3]]));
    let n = [number(0), number(4), number(8)];
    n.iter().all(|n| (1..=u64::from(u32::MAX >> 1)).contains(n)).then_some(n)
}

/// Bytes of a file with these numbers of bins.
fn whole_length(n: [u64; 3]) -> Option<u64> {
    n.iter().try_fold(3 * 8_u64, |product, n| product.checked_mul(*n))?.checked_add(HEADER as u64)
}

/// Reads a table from the bytes of its file.
///
/// # Errors
/// Those of [`read`].
pub fn parse(bytes: &[u8]) -> Result<Checked<HalfAngle>, Error> {
    read(&mut Cursor::new(bytes), bytes.len() as u64)
}

/// Reads a table from a file of `length` bytes, a block of all three planes at a time: the bytes are never whole in memory, and none but
/// the table's own pages are touched first. That takes less time than reading the file as a whole.
///
/// # Errors
/// [`ErrorKind::Length`] where the file is not as long as its numbers of bins make it (before anything is allocated),
/// [`ErrorKind::Table`] for numbers of bins out of range, [`ErrorKind::Io`] where it cannot be read.
pub fn read<R: Read + Seek>(input: &mut R, length: u64) -> Result<Checked<HalfAngle>, Error> {
    let mut start = Vec::with_capacity(HEADER);
    input.by_ref().take(HEADER as u64).read_to_end(&mut start).map_err(unreadable)?;
    let Some(n) = dimensions(&start) else {
        let found = format!("{length} bytes without three numbers of bins");
        return Err(Error::new(Location::default(), ErrorKind::unexpected(found, "a MERL table")));
    };
    let expected = whole_length(n).unwrap_or(u64::MAX);
    if expected != length {
        let what = format!("{} × {} × {} bins of three channels", n[0], n[1], n[2]);
        let kind = ErrorKind::Length { found: length, expected, what };
        return Err(Error::new(Location::default(), kind).with_hint("the file may be cut off"));
    }
    #[expect(clippy::cast_possible_truncation, reason = "the bytes are there, so the counts fit")]
    let [theta_h, theta_d, phi_d] = n.map(|n| n as usize);
    let resolution = Resolution { theta_h, theta_d, phi_d };
    resolution.check()?;
    let bins = resolution.bins();
    let mut values = vec![0.0_f32; 3 * bins];
    let mut planes = [(); 3].map(|()| vec![0; 8 * BLOCK.min(bins)]);
    let mut missing = 0;
    for (block, values) in values.as_chunks_mut().0.chunks_mut(BLOCK).enumerate() {
        for (channel, plane) in planes.iter_mut().enumerate() {
            let place = HEADER + 8 * (channel * bins + block * BLOCK);
            input.seek(SeekFrom::Start(place as u64)).map_err(unreadable)?;
            input.read_exact(&mut plane[..8 * values.len()]).map_err(unreadable)?;
        }
        missing += interleave(&planes, values);
    }
    let table = HalfAngle::of_bins(resolution, Channel::rgb(), values);
    let mut findings = Vec::new();
    if missing > 0 {
        let share = 100.0 * missing as f64 / bins as f64;
        findings
            .push(Finding::info("B104", format!("{missing} of {bins} bins ({share:.1} %) are marked as not measured")));
    }
    Ok(Checked { value: table, findings })
}

/// Scales and interleaves the values of a block of bins, and counts those that are missing.
fn interleave([red, green, blue]: &[Vec<u8>; 3], values: &mut [[f32; 3]]) -> usize {
    let [red, green, blue] = [red, green, blue].map(|plane| plane.as_chunks::<8>().0);
    let mut missing = 0;
    for (bin, ((r, g), b)) in values.iter_mut().zip(red.iter().zip(green).zip(blue)) {
        let file = [r, g, b].map(|eight| f64::from_le_bytes(*eight));
        let measured = file.iter().fold(true, |all, v| all & (*v >= 0.0) & (*v < MOST));
        missing += usize::from(!measured);
        #[expect(clippy::cast_possible_truncation, reason = "kept in single precision")]
        let single = |c: usize| if measured { (file[c] * SCALE[c]) as f32 } else { f32::NAN };
        *bin = [single(0), single(1), single(2)];
    }
    missing
}

#[expect(clippy::needless_pass_by_value, reason = "for `map_err`")]
fn unreadable(error: io::Error) -> Error {
    Error::whole(ErrorKind::Io { message: error.to_string() })
}

/// A table of three channels as the bytes of a file; `None` for another number of channels.
#[must_use]
pub fn write(table: &HalfAngle) -> Option<Vec<u8>> {
    if table.channels().len() != 3 {
        return None;
    }
    let Resolution { theta_h, theta_d, phi_d } = table.resolution();
    let bins = table.resolution().bins();
    let mut out = Vec::with_capacity(HEADER + 24 * bins);
    for n in [theta_h, theta_d, phi_d] {
        out.extend_from_slice(&u32::try_from(n).ok()?.to_le_bytes());
    }
    for (channel, scale) in SCALE.iter().enumerate() {
        for bin in 0..bins {
            let value = f64::from(table.bin(bin)[channel]);
            // What a table holds below zero cannot be told from the mark of a missing bin.
            let raw = if value >= 0.0 { value / scale } else { -1.0 };
            out.extend_from_slice(&raw.to_le_bytes());
        }
    }
    Some(out)
}

/// How each bin of a table is known, as the bytes of a file beside it: the three numbers of bins as in the table's own file, then a byte per
/// bin in its order, 0 missing, 1 inferred, 2 measured. A bin that [`write()`] has to mark as missing, for a value below zero, is missing here too.
///
/// # Panics
/// Where there is not one entry for each bin.
#[must_use]
pub fn mask(table: &HalfAngle, known: &[Known]) -> Vec<u8> {
    let Resolution { theta_h, theta_d, phi_d } = table.resolution();
    assert_eq!(known.len(), table.resolution().bins(), "one mark per bin");
    let code = |(bin, known): (usize, &Known)| match known {
        _ if table.bin(bin).iter().any(|v| *v < 0.0) => 0,
        Known::Missing => 0,
        Known::Inferred => 1,
        Known::Measured => 2,
    };
    #[expect(clippy::cast_possible_truncation, reason = "at most 360")]
    let header = [theta_h, theta_d, phi_d].into_iter().flat_map(|n| (n as u32).to_le_bytes());
    header.chain(known.iter().enumerate().map(code)).collect()
}
