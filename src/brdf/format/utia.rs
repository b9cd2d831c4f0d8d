//! UTIA tables: red, green and blue planes of 288 × 288 64-bit floats, little-endian, without header.
//!
//! A plane has one row per direction of light, one column per direction of view; on both sides θ is 0, 15 … 75° (slow) and φ
//! 0, 7.5 … 352.5° (fast).
//!
//! Reference: J. Filip & R. Vávra, *Template-Based Sampling of Anisotropic BRDFs*, Comput. Graph. Forum 33 (2014).

use super::error::{Error, ErrorKind};
use crate::brdf::table::{Angular, Channel};
use crate::finding::{Checked, Finding, Location};

const THETAS: usize = 6;
const AZIMUTHS: usize = 48;
const PLANE: usize = (THETAS * AZIMUTHS) * (THETAS * AZIMUTHS);
/// Bytes of a file.
pub(super) const LENGTH: usize = 3 * 8 * PLANE;

/// Reads a table. Its numbers are taken to be in 1/sr, which the format does not say (a finding does).
///
/// # Errors
/// [`ErrorKind::Length`] where the file has another length.
pub fn parse(bytes: &[u8]) -> Result<Checked<Angular>, Error> {
    if bytes.len() != LENGTH {
        let what = "288 × 288 directions of three channels".to_owned();
        let kind = ErrorKind::Length { found: bytes.len() as u64, expected: LENGTH as u64, what };
        return Err(Error::new(Location::default(), kind));
    }
    let plane = PLANE * 8;
    let at = |channel: usize, node: usize| {
        let mut eight = [0; 8];
        eight.copy_from_slice(&bytes[channel * plane + node * 8..][..8]);
        let value = f64::from_le_bytes(eight);
        if value.is_finite() { value } else { f64::NAN }
    };
    let mut values = Vec::with_capacity(3 * PLANE);
    for node in 0..PLANE {
        values.extend([at(0, node), at(1, node), at(2, node)]);
    }
    let thetas = (0..THETAS).map(|i| (15.0 * i as f64).to_radians()).collect();
    let negative = values.iter().filter(|v| **v < 0.0).count();
    let table = Angular::new(thetas, AZIMUTHS, Channel::rgb(), values)?;
    let mut findings =
        vec![Finding::info("B107", "the format states no unit; values are taken in 1/sr, without cosine")];
    if negative > 0 {
        findings.push(Finding::warning("B108", format!("{negative} values are negative and were kept")));
    }
    if let (nodes, missing @ 1..) = table.coverage() {
        findings.push(Finding::warning("B104", format!("{missing} of {nodes} places hold no number and are missing")));
    }
    Ok(Checked { value: table, findings })
}
