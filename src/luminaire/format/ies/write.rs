//! From [`Luminaire`] to the text of a file, in any edition.

use super::super::error::{Error, ErrorKind};
use super::label::{ascii, labels};
use super::opening::dimensions;
use super::{TiltTable, Version};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::{Distribution, Kind, Luminaire, Symmetry, System, keyword};

/// Columns of the lines of numbers: every edition allows them, and a screen shows them.
const COLUMNS: usize = 78;

/// Digits of the peak: what is written differs from what was given by less than a billionth of the peak.
const PEAK_DIGITS: i32 = 9;

/// Writes a luminaire as an LM-63 file of an edition: ASCII, lines ended by CR LF, all factors 1, dimensions in metres.
/// Findings say what the edition cannot carry.
///
/// # Errors
/// Photon intensities, which LM-63 has no words for, and a Type A or B table of one plane.
pub fn write(luminaire: &Luminaire, version: Version) -> Result<Checked<String>, Error> {
    let unfit = |found: &str, expected: &str| {
        let kind = ErrorKind::Unexpected { found: found.into(), expected: expected.into() };
        Err(Error::new(Location::default(), kind))
    };
    let distribution = &luminaire.distribution;
    if luminaire.kind == Kind::Photon {
        return unfit("intensities in µmol/(s·sr)", "candela or W/sr, which LM-63 can carry");
    }
    if distribution.system() != System::TypeC && distribution.symmetry() == Symmetry::Rotational {
        return unfit("a Type A or B table of one plane", "two horizontal angles or more");
    }
    let mut findings = Vec::new();
    let mut out = String::new();
    if let Some(line) = version.line() {
        out.push_str(line);
        out.push_str("\r\n");
    }
    let (labels, unit) = labels(luminaire, version, &mut findings);
    for label in labels {
        label.write(&mut out, version.line_length());
    }
    tilt(&mut out, luminaire, version, &mut findings);
    not_carried(luminaire, &mut findings);
    lamp_line(&mut out, luminaire, version, &mut findings);
    let watts = luminaire.input_power_w.unwrap_or(0.0);
    list(&mut out, [exact(1.0), factor(luminaire, version), exact(watts)]);
    list(&mut out, degrees(distribution.vertical_deg()));
    list(&mut out, degrees(distribution.horizontal_deg()));
    candela(&mut out, distribution, unit.map_or(1.0, |u| 1.0 / u.watts_per_sr));
    Ok(Checked { value: out, findings })
}

fn exact(value: f64) -> String {
    trimmed(format!("{value}"))
}

fn decimals(value: f64, decimals: usize) -> String {
    trimmed(format!("{value:.decimals$}"))
}

/// Without zeros behind the point, and without a negative zero.
fn trimmed(mut text: String) -> String {
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    if text == "-0" { "0".to_owned() } else { text }
}

/// Numbers separated by blanks, wrapped.
fn list(out: &mut String, values: impl IntoIterator<Item = String>) {
    let mut column = 0;
    for value in values {
        if column > 0 && column + 1 + value.len() > COLUMNS {
            out.push_str("\r\n");
            column = 0;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(&value);
        column += value.len();
    }
    out.push_str("\r\n");
}

/// Angles to a millionth of a degree, or in full where that would make two of them one.
fn degrees(angles: &[f64]) -> Vec<String> {
    let short: Vec<String> = angles.iter().map(|a| decimals(*a, 6)).collect();
    if short.windows(2).any(|w| w[0] == w[1]) { angles.iter().map(|a| exact(*a)).collect() } else { short }
}

fn candela(out: &mut String, distribution: &Distribution, unit: f64) {
    let peak = distribution.values().iter().fold(0.0_f64, |a, v| a.max(v.abs())) * unit;
    let before = if peak > 0.0 { peak.log10().floor() as i32 + 1 } else { 1 };
    let digits = usize::try_from(PEAK_DIGITS - before).unwrap_or(0);
    for plane in distribution.values().chunks(distribution.vertical_deg().len()) {
        list(out, plane.iter().map(|v| decimals(v * unit, digits)));
    }
}

fn tilt(out: &mut String, luminaire: &Luminaire, version: Version, findings: &mut Vec<Finding>) {
    let text = luminaire.keywords.iter().find(|(name, _)| name == "TILT").map(|(_, text)| text.as_str());
    match (text, text.and_then(TiltTable::from_keyword)) {
        (None, _) => out.push_str("TILT=NONE\r\n"),
        (Some(_), Some(table)) => {
            out.push_str("TILT=INCLUDE\r\n");
            list(out, [table.geometry.to_string()]);
            list(out, [table.angles_deg.len().to_string()]);
            list(out, table.angles_deg.iter().map(|v| exact(*v)));
            list(out, table.factors.iter().map(|v| exact(*v)));
        }
        (Some(name), None) if version < Version::Lm63_2019 => {
            out.push_str("TILT=");
            out.push_str(&ascii(name).0);
            out.push_str("\r\n");
        }
        (Some(name), None) => {
            let message = format!("LM-63-2019 has no TILT=<file name>: `{name}` was left out");
            findings.push(Finding::warning("L040", message));
            out.push_str("TILT=NONE\r\n");
        }
    }
}

fn lamp_line(out: &mut String, luminaire: &Luminaire, version: Version, findings: &mut Vec<Finding>) {
    let flux: Option<f64> = luminaire.lamps.iter().map(|l| l.flux_lm).sum();
    let flux = flux.filter(|lm| *lm > 0.0 && !luminaire.absolute && luminaire.kind == Kind::Luminous);
    let count: f64 = luminaire.lamps.iter().filter_map(|l| l.count).sum();
    let count = if count > 0.0 { count } else { 1.0 };
    let distribution = &luminaire.distribution;
    let system = match distribution.system() {
        System::TypeC => "1",
        System::TypeB => "2",
        System::TypeA => "3",
    };
    let mut opening = [0.0; 3];
    if let Some(body) = &luminaire.opening {
        let (signed, carried) = dimensions(version, body);
        opening = signed;
        if !carried {
            let message = format!("{version} has no signs for an opening like this: {}", body.shape.name());
            findings.push(Finding::warning("L040", message));
        }
    }
    let mut fields = vec![
        exact(count),
        flux.map_or("-1".to_owned(), |lm| exact(lm / count)),
        "1".to_owned(),
        distribution.vertical_deg().len().to_string(),
        distribution.horizontal_deg().len().to_string(),
        system.to_owned(),
        "2".to_owned(),
    ];
    fields.extend(opening.map(|v| decimals(v, 6)));
    list(out, fields);
}

/// The field between ballast factor and watts.
fn factor(luminaire: &Luminaire, version: Version) -> String {
    if version < Version::Lm63_2019 {
        return "1".to_owned();
    }
    let code =
        luminaire.keywords.iter().find(|(name, _)| name == keyword::FILE_GENERATION).and_then(|(_, t)| t.parse().ok());
    match code.filter(|code| super::file_generation(*code).is_some()) {
        Some(code) => format!("{code:.5}"),
        None => "1.00001".to_owned(),
    }
}

fn not_carried(luminaire: &Luminaire, findings: &mut Vec<Finding>) {
    let mut lost = Vec::new();
    if luminaire.housing.is_some() {
        lost.push("the housing's dimensions");
    }
    if luminaire.lamps.len() > 1 {
        lost.push("lamp sets apart from one another (written as one)");
    }
    if luminaire.declared_output_ratio.is_some() || luminaire.declared_downward_fraction.is_some() {
        lost.push("the declared light output ratio and downward fraction (both follow from the intensities)");
    }
    if !lost.is_empty() {
        findings.push(Finding::info("L040", format!("LM-63 cannot carry {}", lost.join(", "))));
    }
    if luminaire.spectrum.is_some() {
        findings.push(Finding::warning("L040", "LM-63 cannot carry the spectrum").hint("TM-33 can"));
    }
    if luminaire.angular_spectra.is_some() {
        findings.push(Finding::warning("L040", "LM-63 cannot carry the angular spectra").hint("TM-33 can"));
    }
}
