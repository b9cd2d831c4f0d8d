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

use glam::DVec3;

use super::error::{Error, ErrorKind};
use super::text::{Line, Word, decode, lines};
use crate::brdf::coordinates::Parameterisation;
use crate::brdf::table::{Channel, Known, Points};
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

/// A table as CSV, points in order: angles to 1e-12°, values with the fewest digits that give the same double again.
///
/// An isotropic table is turned to φ_i = 0, by which the reader knows it. Points of the same directions (to 1e-10) become one with
/// their mean, as the pole of a grid does, and are counted.
#[must_use]
pub fn write(table: &Points) -> Checked<String> {
    written(table, None)
}

/// The same with a column `known`, `measured` or `inferred`, of how each point is known: `known` has one for each. Readers of [`parse`] do
/// without it. A place of several points is known as the least of them is.
///
/// # Panics
/// Where `known` is not as long as the table.
#[must_use]
pub fn write_known(table: &Points, known: &[Known]) -> Checked<String> {
    assert_eq!(known.len(), table.len(), "one mark per point");
    written(table, Some(known))
}

fn written(table: &Points, known: Option<&[Known]>) -> Checked<String> {
    let n = table.channels().len();
    let mut rows: Vec<([DVec3; 2], f64, Known)> = Vec::with_capacity(table.len());
    let mut means: Vec<f64> = Vec::with_capacity(table.len() * n);
    let mut places: HashMap<[i64; 6], usize> = HashMap::with_capacity(table.len());
    for (number, (incident, outgoing, values)) in table.iter().enumerate() {
        let how = known.map_or(Known::Measured, |k| k[number]);
        let pair = if table.is_isotropic() { unturned(incident, outgoing) } else { [incident, outgoing] };
        let place = *places.entry(same_place(&pair)).or_insert(rows.len());
        if place == rows.len() {
            rows.push((pair, 0.0, how));
            means.resize(means.len() + n, 0.0);
        }
        rows[place].1 += 1.0;
        rows[place].2 = rows[place].2.max(how);
        let count = rows[place].1;
        // Equal values keep theirs to the last digit.
        means[place * n..][..n].iter_mut().zip(values).for_each(|(m, v)| *m += (v - *m) / count);
    }
    let wavelengths = matches!(table.channels().first(), Some(Channel::Wavelength(_)));
    let column = if wavelengths { "wavelength_nm" } else { "channel" };
    let names: Vec<String> = (table.channels().iter())
        .map(|channel| match channel {
            Channel::Wavelength(nm) => nm.to_string(),
            Channel::Named(name) => name.replace([',', ';', '\t', '\n'], " "),
        })
        .collect();
    let more = if known.is_some() { ",known" } else { "" };
    let mut out = format!("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,{column},value{more}\n");
    for (([incident, outgoing], _, how), means) in rows.iter().zip(means.chunks_exact(n)) {
        // Rounding of the directions, which would make 14.999999999999998° of 15°, is not written.
        let degrees = |rad: f64| (rad.to_degrees() * 1e12).round() / 1e12;
        let [ti, pi, to, po] = [theta(*incident), phi(*incident), theta(*outgoing), phi(*outgoing)].map(degrees);
        for (name, mean) in names.iter().zip(means) {
            let _ = write!(out, "{ti},{pi},{to},{po},{name},{mean}");
            if known.is_some() {
                let _ = write!(out, ",{how}");
            }
            out.push('\n');
        }
    }
    let mut findings = Vec::new();
    let doubled = table.len() - rows.len();
    if doubled > 0 {
        let words =
            format!("{doubled} points have the directions of another one; each place is written once, with the mean");
        findings.push(Finding::info("B406", words));
    }
    Checked { value: out, findings }
}

/// The pair turned about the normal until φ_i is 0.
fn unturned(incident: DVec3, outgoing: DVec3) -> [DVec3; 2] {
    let across = incident.x.hypot(incident.y);
    if incident.y == 0.0 && incident.x >= 0.0 || across == 0.0 {
        return [incident, outgoing];
    }
    let (cos, sin) = (incident.x / across, incident.y / across);
    let turned = DVec3::new(cos * outgoing.x + sin * outgoing.y, cos * outgoing.y - sin * outgoing.x, outgoing.z);
    [DVec3::new(across, 0.0, incident.z), turned]
}

/// The cell of 1e-10 in which the pair lies.
fn same_place(pair: &[DVec3; 2]) -> [i64; 6] {
    let [i, o] = pair;
    #[expect(clippy::cast_possible_truncation, reason = "unit vectors")]
    [i.x, i.y, i.z, o.x, o.y, o.z].map(|c| (c * 1e10).round() as i64)
}
