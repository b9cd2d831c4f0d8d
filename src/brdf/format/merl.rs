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

use super::error::{Error, ErrorKind};
use crate::brdf::table::{Channel, HalfAngle, Resolution};
use crate::finding::{Checked, Finding, Location};

/// Bytes of the three numbers of bins.
const HEADER: usize = 12;
/// 1/sr per unit of the file, red, green, blue.
const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
/// What is not below it is no value: single precision could not keep it.
const MOST: f64 = 1e38;

/// Whether the length is that of a table with the numbers of bins at its beginning.
#[must_use]
pub fn is_merl(bytes: &[u8]) -> bool {
    dimensions(bytes).is_some_and(|n| Some(bytes.len() as u64) == length(n))
}

/// The numbers of bins that a file begins with, if all are positive and a table could have them.
fn dimensions(bytes: &[u8]) -> Option<[u64; 3]> {
    let header = bytes.get(..HEADER)?;
    let number = |i: usize| u64::from(u32::from_le_bytes([header[i], header[i + 1], header[i + 2], header[i + 3]]));
    let n = [number(0), number(4), number(8)];
    n.iter().all(|n| (1..=u64::from(u32::MAX >> 1)).contains(n)).then_some(n)
}

/// Bytes of a file with these numbers of bins.
fn length(n: [u64; 3]) -> Option<u64> {
    n.iter().try_fold(3 * 8_u64, |product, n| product.checked_mul(*n))?.checked_add(HEADER as u64)
}

/// Reads a table.
///
/// # Errors
/// [`ErrorKind::Length`] where the file is not as long as its numbers of bins make it (before anything is allocated),
/// [`ErrorKind::Table`] for numbers of bins out of range.
pub fn parse(bytes: &[u8]) -> Result<Checked<HalfAngle>, Error> {
    let Some(n) = dimensions(bytes) else {
        let found = format!("{} bytes without three numbers of bins", bytes.len());
        return Err(Error::new(Location::default(), ErrorKind::unexpected(found, "a MERL table")));
    };
    let expected = length(n).unwrap_or(u64::MAX);
    if expected != bytes.len() as u64 {
        let what = format!("{} × {} × {} bins of three channels", n[0], n[1], n[2]);
        let kind = ErrorKind::Length { found: bytes.len() as u64, expected, what };
        return Err(Error::new(Location::default(), kind).with_hint("the file may be cut off"));
    }
    #[expect(clippy::cast_possible_truncation, reason = "the bytes are there, so the counts fit")]
    let [theta_h, theta_d, phi_d] = n.map(|n| n as usize);
    let resolution = Resolution { theta_h, theta_d, phi_d };
    resolution.check()?;
    let bins = resolution.bins();
    let (numbers, _) = bytes[HEADER..].as_chunks::<8>();
    let (red, rest) = numbers.split_at(bins);
    let (green, blue) = rest.split_at(bins);
    // Read, scaled, interleaved and counted in one pass over memory that nobody has touched yet.
    let mut values = vec![0.0_f32; 3 * bins];
    let mut missing = 0;
    for (bin, ((r, g), b)) in values.as_chunks_mut().0.iter_mut().zip(red.iter().zip(green).zip(blue)) {
        let file = [r, g, b].map(|eight| f64::from_le_bytes(*eight));
        let measured = file.iter().fold(true, |all, v| all & (*v >= 0.0) & (*v < MOST));
        missing += usize::from(!measured);
        #[expect(clippy::cast_possible_truncation, reason = "kept in single precision")]
        let single = |c: usize| if measured { (file[c] * SCALE[c]) as f32 } else { f32::NAN };
        *bin = [single(0), single(1), single(2)];
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
