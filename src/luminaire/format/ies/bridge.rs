//! From [`RawIes`] to [`Luminaire`].

use super::super::error::Error;
use super::super::plausible;
use super::opening::opening;
use super::{RawIes, Tilt, Version, angles, radiometric};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::{Body, Distribution, LampSet, Luminaire, Symmetry, keyword};

/// A luminous opening beyond this is in the wrong unit, m.
const LARGEST_M: f64 = 20.0;

/// Planes of 0° and 360° that differ by more than this share of the peak are reported.
const SAME_PLANE: f64 = 0.005;

/// Keywords whose text becomes a field of the luminaire.
const FIELDS: [&str; 4] = ["LUMINAIRE", "MANUFAC", "LUMCAT", "LAMP"];

impl RawIes {
    /// The luminaire that the file describes: intensities with all factors, angles ascending, the turn closed.
    ///
    /// # Errors
    /// Two units of radiant intensity in one file; or a table that makes no distribution, which [`parse`](super::parse)
    /// never gives.
    pub fn into_luminaire(self) -> Result<Checked<Luminaire>, Error> {
        let mut findings = Vec::new();
        let (kind, unit, finding) = radiometric::kind(&self)?;
        findings.extend(finding);
        let opening = self.body(&mut findings);
        let facts = Facts::of(&self, unit);
        let distribution = self.distribution(unit, &mut findings)?;
        let value = Luminaire {
            name: facts.name,
            manufacturer: facts.manufacturer,
            catalogue_number: facts.catalogue_number,
            kind,
            distribution,
            absolute: facts.lamp.flux_lm.is_none(),
            input_power_w: facts.lamp.power_w,
            lamps: vec![facts.lamp],
            declared_flux: facts.declared_flux,
            declared_output_ratio: None,
            declared_downward_fraction: None,
            opening,
            housing: None,
            spectrum: None,
            angular_spectra: None,
            keywords: facts.keywords,
        };
        findings.extend(plausible::check(&value));
        Ok(Checked { value, findings })
    }

    fn body(&self, findings: &mut Vec<Finding>) -> Option<Body> {
        let dimensions = self.opening.map(|v| v * self.units.metres());
        let [w, l, h] = self.opening;
        if let Some(largest) = dimensions.iter().map(|v| v.abs()).find(|v| *v > LARGEST_M) {
            let message = format!("a luminous opening of {largest} m: the unit may be wrong");
            findings.push(Finding::warning("L018", message));
        }
        match opening(self.version, dimensions) {
            Some(found) => {
                if !found.own_edition {
                    let message = format!(
                        "the signs of the opening ({w} {l} {h}) are not those of {}; read as those of another edition",
                        self.version
                    );
                    findings.push(Finding::info("L017", message));
                }
                Some(found.body)
            }
            None => {
                let message =
                    format!("the signs of the opening ({w} {l} {h}) mean no shape in any edition; opening not known");
                findings.push(Finding::warning("L017", message));
                None
            }
        }
    }

    fn distribution(mut self, unit: f64, findings: &mut Vec<Finding>) -> Result<Distribution, Error> {
        let factor = self.factor() * unit;
        if factor != 1.0 {
            self.candela.iter_mut().for_each(|v| *v *= factor);
        }
        let rows = self.vertical_deg.len().max(1);
        // Reversing the whole table reverses planes and rows; reversing each plane, rows only.
        if angles::descending(&self.horizontal_deg) {
            self.horizontal_deg.reverse();
            self.candela.reverse();
            self.candela.chunks_mut(rows).for_each(<[f64]>::reverse);
        }
        if angles::descending(&self.vertical_deg) {
            self.vertical_deg.reverse();
            self.candela.chunks_mut(rows).for_each(<[f64]>::reverse);
        }
        angles::snap(&mut self.vertical_deg);
        let invalid = |e: crate::luminaire::Error| Error::new(Location::default(), e);
        if self.horizontal_deg.is_empty() {
            return Err(invalid(crate::luminaire::Error::Count { found: self.candela.len(), expected: 0 }));
        }
        let planes = angles::planes(self.system, &self.horizontal_deg).map_err(|expected| {
            let found = (self.horizontal_deg[0], self.horizontal_deg[self.horizontal_deg.len() - 1]);
            invalid(crate::luminaire::Error::Angles { which: "horizontal", found, expected })
        })?;
        if planes.symmetry == Symmetry::Rotational {
            let only = self.horizontal_deg[0];
            if only != 0.0 {
                let message = format!("the only plane is at {only}°, not at 0°; taken for all planes");
                findings.push(Finding::info("L024", message));
            }
        } else {
            angles::snap(&mut self.horizontal_deg);
        }
        if planes.open {
            let last = self.horizontal_deg[self.horizontal_deg.len() - 1];
            let message = format!("the planes end at {last}°; the plane of 0° closes the turn at 360°");
            findings.push(Finding::warning("L022", message));
        }
        let values = std::mem::take(&mut self.candela);
        if self.horizontal_deg.last() == Some(&360.0) && values.len() > rows {
            let peak = values.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
            let pairs = values[..rows].iter().zip(&values[values.len() - rows..]);
            let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if worst > SAME_PLANE * peak {
                let message = format!(
                    "the planes of 0° and 360° are the same but differ by up to {:.1} % of the peak",
                    worst / peak * 100.0
                );
                findings.push(Finding::warning("L023", message));
            }
        }
        Distribution::new(self.system, planes.symmetry, self.horizontal_deg, self.vertical_deg, values).map_err(invalid)
    }
}

impl TryFrom<RawIes> for Checked<Luminaire> {
    type Error = Error;

    fn try_from(raw: RawIes) -> Result<Self, Error> {
        raw.into_luminaire()
    }
}

/// What a luminaire knows besides its intensities.
struct Facts {
    name: String,
    manufacturer: String,
    catalogue_number: String,
    lamp: LampSet,
    declared_flux: Option<f64>,
    keywords: Vec<(String, String)>,
}

impl Facts {
    fn of(raw: &RawIes, unit: f64) -> Self {
        let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let text =
            |name: &str, label: &str| one_line(raw.keyword(name).or_else(|| labelled(raw, label)).unwrap_or_default());
        let mut name = text("LUMINAIRE", "LUMINAIRE");
        if name.is_empty() {
            // Files of 1986 begin with what the lamp is.
            name = raw.keywords.iter().find(|k| k.name.is_empty()).map(|k| one_line(&k.text)).unwrap_or_default();
        }
        let mut lamp_name = text("LAMP", "LAMPS");
        if lamp_name.is_empty() {
            lamp_name = text("LAMPCAT", "LAMP");
        }
        let lamp = LampSet {
            count: (raw.lamps > 0.0).then_some(raw.lamps),
            name: lamp_name,
            flux_lm: raw.lumens_per_lamp.map(|lm| lm * raw.lamps).filter(|lm| *lm > 0.0),
            power_w: (raw.input_watts > 0.0).then_some(raw.input_watts),
            ..LampSet::default()
        };
        let mut taken = Vec::new();
        let mut keywords = Vec::new();
        for keyword in &raw.keywords {
            let known = keyword.name.as_str();
            if FIELDS.contains(&known) && !taken.contains(&known) {
                taken.push(known);
                continue;
            }
            let name = if known.is_empty() { "OTHER" } else { known };
            keywords.push((name.to_owned(), keyword.text.clone()));
        }
        match &raw.tilt {
            Tilt::None => {}
            Tilt::Include(table) => keywords.push(("TILT".to_owned(), table.to_keyword())),
            Tilt::File(name) => keywords.push(("TILT".to_owned(), name.clone())),
        }
        if raw.version == Version::Lm63_2019 {
            keywords.push((keyword::FILE_GENERATION.to_owned(), format!("{:.5}", raw.photometric_factor)));
        }
        Self {
            name,
            manufacturer: text("MANUFAC", "MANUFACTURER"),
            catalogue_number: text("LUMCAT", "CATALOG NUMBER"),
            lamp,
            declared_flux: declared(raw).map(|flux| flux * unit),
            keywords,
        }
    }
}

/// The text behind `LABEL:` in a line without keyword.
fn labelled<'r>(raw: &'r RawIes, label: &str) -> Option<&'r str> {
    raw.keywords.iter().filter(|k| k.name.is_empty()).find_map(|k| {
        let (name, text) = k.text.split_once(':')?;
        name.trim().eq_ignore_ascii_case(label).then_some(text)
    })
}

/// The luminaire's flux by its keywords.
fn declared(raw: &RawIes) -> Option<f64> {
    raw.keywords.iter().filter(|k| keyword::declares_flux(&k.name)).find_map(|k| amount(&k.text))
}

/// The number that a text begins with, also with commas between thousands.
fn amount(text: &str) -> Option<f64> {
    let text = text.trim_start();
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ',')).unwrap_or(text.len());
    let digits = text[..end].trim_end_matches(['.', ',']);
    let groups: Vec<&str> = digits.split('.').next()?.split(',').collect();
    if groups.len() > 1 && groups[1..].iter().any(|g| g.len() != 3) {
        return None;
    }
    digits.replace(',', "").parse().ok().filter(|v: &f64| *v > 0.0)
}
