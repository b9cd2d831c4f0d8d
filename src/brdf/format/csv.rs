//! Plain CSV of points: one row per pair of directions and channel.
//!
//! ```text
//! theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,wavelength_nm,value
//! ```
//!
//! Columns in any order, separated by `,`, `;` or tabs; angles also as `…_rad`. In the place of `wavelength_nm` there may be
//! `channel` (names) or neither (one channel). Every pair of directions has all channels.

use std::collections::HashMap;
use std::fmt::Write;

use super::error::{Error, ErrorKind};
use super::text::{Line, Word, decode, lines};
use crate::brdf::coordinates::Parameterisation;
use crate::brdf::table::{Channel, Points};
use crate::finding::{Checked, Finding};
use crate::geometry::direction::{from_angles, from_degrees, phi, theta};

/// Where the columns stand.
struct Columns {
    angles: [usize; 4],
    degrees: bool,
    channel: Option<usize>,
    wavelengths: bool,
    value: usize,
}

impl Columns {
    fn of(line: Line<'_>, separator: char) -> Result<Self, Error> {
        let names: Vec<String> = line.fields(separator).map(|w| w.text.to_ascii_lowercase()).collect();
        let find = |name: &str| names.iter().position(|n| n == name);
        let need = |name: &str| {
            let missing = ErrorKind::unexpected(
                format!("no column `{name}`"),
                "theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg, value",
            );
            find(name).ok_or_else(|| line.error(missing))
        };
        let degrees = find("theta_i_rad").is_none();
        let unit = if degrees { "deg" } else { "rad" };
        let angle = |name: &str| need(&format!("{name}_{unit}"));
        let wavelength = find("wavelength_nm");
        Ok(Self {
            angles: [angle("theta_i")?, angle("phi_i")?, angle("theta_o")?, angle("phi_o")?],
            degrees,
            channel: wavelength.or_else(|| find("channel")),
            wavelengths: wavelength.is_some(),
            value: need("value")?,
        })
    }
}

/// Reads a table.
///
/// # Errors
/// [`Error`] with the place of a missing column, a missing or doubled value, or of what is no number.
pub fn parse(bytes: &[u8]) -> Result<Checked<Points>, Error> {
    let (text, assumed) = decode(bytes);
    let mut rows = lines(&text).filter(|l| !l.text.trim().is_empty() && !l.text.starts_with('#'));
    let head = rows.next().ok_or_else(|| Error::whole(ErrorKind::Empty))?;
    let separator = [',', ';', '\t'].into_iter().find(|s| head.text.contains(*s)).unwrap_or(',');
    let columns = Columns::of(head, separator)?;
    let mut channels: Vec<Channel> = Vec::new();
    let mut places: HashMap<[u64; 4], usize> = HashMap::new();
    let mut angles: Vec<([f64; 4], Line<'_>)> = Vec::new();
    let mut entries: Vec<(usize, usize, f64, Line<'_>)> = Vec::new();
    for line in rows {
        let fields: Vec<Word<'_>> = line.fields(separator).collect();
        let field = |i: usize| {
            let kind = || ErrorKind::unexpected(format!("{} columns", fields.len()), format!("at least {}", i + 1));
            fields.get(i).copied().ok_or_else(|| line.error(kind()))
        };
        let mut at = [0.0; 4];
        for (a, column) in at.iter_mut().zip(columns.angles) {
            *a = field(column)?.number("an angle")?;
        }
        let channel = match columns.channel {
            Some(c) if columns.wavelengths => Channel::Wavelength(field(c)?.number("a wavelength")?),
            Some(c) => Channel::Named(field(c)?.text.to_owned()),
            None => Channel::Named("value".to_owned()),
        };
        let channel = channels.iter().position(|c| *c == channel).unwrap_or_else(|| {
            channels.push(channel);
            channels.len() - 1
        });
        let place = *places.entry(at.map(f64::to_bits)).or_insert(angles.len());
        if place == angles.len() {
            angles.push((at, line));
        }
        entries.push((place, channel, field(columns.value)?.number("the value")?, line));
    }
    let n = channels.len();
    // One slot more than there are rows means that a row is missing; nothing is allocated before that is known.
    if angles.len().checked_mul(n) != Some(entries.len()) {
        return Err(incomplete(&angles, &entries, &channels));
    }
    let mut values = vec![f64::NAN; entries.len()];
    for &(place, channel, value, line) in &entries {
        if !values[place * n + channel].is_nan() {
            let kind = ErrorKind::unexpected("a second value for the same directions and channel", "one");
            return Err(line.error(kind));
        }
        values[place * n + channel] = value;
    }
    let direction = |t: f64, p: f64| if columns.degrees { from_degrees(t, p) } else { from_angles(t, p) };
    let directions = angles.iter().map(|(a, _)| (direction(a[0], a[1]), direction(a[2], a[3]))).collect();
    let turned = angles.iter().any(|(a, _)| a[0] != 0.0 && a[1] != 0.0);
    let input = if turned { Parameterisation::Spherical } else { Parameterisation::ViewLightAzimuth };
    let findings: Vec<Finding> = assumed.into_iter().collect();
    Ok(Checked { value: Points::new(input, channels, directions, values)?, findings })
}

/// The first pair of directions that has not one value per channel.
fn incomplete(
    angles: &[([f64; 4], Line<'_>)],
    entries: &[(usize, usize, f64, Line<'_>)],
    channels: &[Channel],
) -> Error {
    let mut counts = vec![0_usize; angles.len()];
    entries.iter().for_each(|e| counts[e.0] += 1);
    let place = counts.iter().position(|c| *c != channels.len());
    let found = format!("{} values for these directions", place.map_or(0, |p| counts[p]));
    let expected = format!("one for each of the {} channels", channels.len());
    let line = place.map_or(Line { number: 1, text: "" }, |p| angles[p].1);
    line.error(ErrorKind::unexpected(found, expected))
}

/// A table as CSV, points in order, numbers with the fewest digits that give the same double again.
#[must_use]
pub fn write(table: &Points) -> String {
    let wavelengths = matches!(table.channels().first(), Some(Channel::Wavelength(_)));
    let column = if wavelengths { "wavelength_nm" } else { "channel" };
    let mut out = format!("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,{column},value\n");
    for (incident, outgoing, values) in table.iter() {
        let [ti, pi, to, po] = [theta(incident), phi(incident), theta(outgoing), phi(outgoing)].map(f64::to_degrees);
        for (channel, value) in table.channels().iter().zip(values) {
            let channel = match channel {
                Channel::Wavelength(nm) => nm.to_string(),
                Channel::Named(name) => name.clone(),
            };
            let _ = writeln!(out, "{ti},{pi},{to},{po},{channel},{value}");
        }
    }
    out
}
