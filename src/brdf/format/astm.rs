//! ASTM E1392 and E2387 text: header lines, `VARS theta_i,phi_i,theta_s,phi_s,…`, then one point per line ([`Points`]).
//!
//! Values are named by the columns after the four angles: `R,G,B`, `X,Y,Z`, wavelengths such as `550nm`, or anything else. Angles
//! come in degrees (as the standard has them) or in radians (as renderers write them); a file with an angle above 2π has degrees,
//! any other radians, and a finding says which was taken.

use super::error::{Error, ErrorKind};
use super::text::{decode, lines};
use crate::brdf::coordinates::Parameterisation;
use crate::brdf::table::{Channel, Points};
use crate::finding::{Checked, Finding, Location};
use crate::geometry::direction::{from_angles, from_degrees};

/// Reads a table.
///
/// # Errors
/// [`Error`] with the place of what is missing or no number.
pub fn parse(bytes: &[u8]) -> Result<Checked<Points>, Error> {
    let (text, assumed) = decode(bytes);
    let mut findings: Vec<Finding> = assumed.into_iter().collect();
    let mut channels: Vec<Channel> = Vec::new();
    let (mut rows, mut announced) = (Vec::new(), None);
    for line in lines(&text) {
        let trimmed = line.text.trim();
        if channels.is_empty() {
            if let Some(rest) = trimmed.strip_prefix("VARS") {
                let names: Vec<&str> = rest.split(',').map(str::trim).collect();
                if names.len() < 5 {
                    let found = format!("{} variables", names.len());
                    return Err(line.error(ErrorKind::unexpected(found, "four angles and at least one value")));
                }
                channels = names[4..].iter().map(|n| channel(n)).collect();
            } else if let Some(rest) = trimmed.strip_prefix("NUM_POINTS") {
                announced = rest.trim().parse::<usize>().ok().map(|n| (n, line.number));
            }
            continue;
        }
        if trimmed.is_empty() || trimmed.starts_with('#') {
            continue;
        }
        let before = rows.len();
        for word in line.fields(',') {
            rows.push(word.number("an angle or a value")?);
        }
        if rows.len() - before != 4 + channels.len() {
            let found = format!("{} numbers", rows.len() - before);
            return Err(line.error(ErrorKind::unexpected(found, format!("4 angles and {} values", channels.len()))));
        }
    }
    if channels.is_empty() {
        return Err(Error::whole(ErrorKind::unexpected("no line `VARS`", "the names of the variables")));
    }
    let width = 4 + channels.len();
    let found = rows.len() / width;
    if let Some((n, line)) = announced.filter(|(n, _)| *n != found) {
        let words = format!("NUM_POINTS announces {n} points; {found} are there and were read");
        findings.push(Finding::warning("B105", words).at(Location::line(line)));
    }
    let angles = || rows.chunks_exact(width).flat_map(|r| &r[..4]);
    let degrees = angles().any(|a| a.abs() > std::f64::consts::TAU + 1e-6);
    let unit = if degrees { "degrees, as one is above 2π" } else { "radians, as none is above 2π" };
    findings.push(Finding::info("B107", format!("the file states no unit of its angles; taken in {unit}")));
    let direction = |t: f64, p: f64| if degrees { from_degrees(t, p) } else { from_angles(t, p) };
    let directions = rows.chunks_exact(width).map(|r| (direction(r[0], r[1]), direction(r[2], r[3]))).collect();
    let values = rows.chunks_exact(width).flat_map(|r| r[4..].iter().copied()).collect();
    // A sample that was lit from one azimuth alone was never turned.
    let turned = rows.chunks_exact(width).any(|r| (r[1] - rows[1]).abs() > 1e-9 && r[0] != 0.0);
    let input = if turned { Parameterisation::Spherical } else { Parameterisation::ViewLightAzimuth };
    Ok(Checked { value: Points::new(input, channels, directions, values)?, findings })
}

fn channel(name: &str) -> Channel {
    let nm = name.strip_suffix("nm").and_then(|n| n.trim().parse().ok()).filter(|nm: &f64| nm.is_finite() && *nm > 0.0);
    nm.map_or_else(|| Channel::Named(name.to_owned()), Channel::Wavelength)
}
