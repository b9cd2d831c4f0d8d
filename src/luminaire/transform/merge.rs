//! Several luminaires at one place as one.

use super::super::distribution::System;
use super::super::keyword;
use super::super::model::{LampSet, Luminaire};
use super::planes::folded;
use super::{Error, Resampling, Turn, facts, scale, sum, turn};
use crate::finding::{Checked, Finding};

/// A luminaire of several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part<'l> {
    /// The luminaire.
    pub luminaire: &'l Luminaire,
    /// Turned about the vertical axis by this, degrees.
    pub rotate_deg: f64,
    /// Times this, 0 or more: 1 is undimmed.
    pub dim: f64,
}

/// The luminaires added up, each turned and dimmed first. Tables of one system stay in it, others become Type C.
///
/// The lamps become one set: rated where all are, else the luminaire is absolute. The power is the sum where all powers are known and
/// nothing is dimmed, for dimming saves what no photometry knows. Opening, housing, spectrum and keywords stay where all agree.
///
/// # Errors
/// [`Error::Nothing`], [`Error::Kinds`], [`Error::Argument`] for a negative dimming, [`Error::TooLarge`], [`Error::Table`].
pub fn merge(parts: &[Part<'_>]) -> Result<Checked<Luminaire>, Error> {
    let Some(first) = parts.first() else { return Err(Error::Nothing) };
    let mut findings = Vec::new();
    let mut lamps = Vec::with_capacity(parts.len());
    let own = first.luminaire.distribution.system();
    let alike = parts.iter().all(|p| p.luminaire.distribution.system() == own);
    let system = if alike { own } else { System::TypeC };
    for part in parts {
        let (kind, other) = (first.luminaire.kind, part.luminaire.kind);
        if kind != other {
            return Err(Error::Kinds { first: kind, other });
        }
        if !(part.dim >= 0.0 && part.dim.is_finite()) {
            return Err(Error::Argument { what: "dimming", found: part.dim, expected: "a finite number of 0 or more" });
        }
        let about_axis_deg = part.rotate_deg;
        let turned = turn(part.luminaire, &Turn { about_axis_deg, ..Turn::default() }, system, &Resampling::default())?;
        findings.extend(turned.findings);
        lamps.push(scale::scaled(&turned.value, part.dim, &mut findings));
    }
    let tables: Vec<_> = lamps.iter().map(|lamp| lamp.distribution.clone()).collect();
    let distribution = folded(&sum(&tables)?.ok_or(Error::Nothing)?)?;
    let undimmed = parts.iter().all(|part| part.dim == 1.0);
    let mut lost = Vec::new();
    let powers: Option<f64> = lamps.iter().map(|lamp| lamp.input_power_w).sum();
    if powers.is_some() && !undimmed {
        let message = "the input power is not known any more: what dimming saves is no matter of photometry";
        findings.push(Finding::warning("L407", message));
    }
    let absolute = lamps.iter().any(|lamp| lamp.absolute || lamp.lamps.iter().all(|set| set.flux_lm.is_none()));
    let mut value = lamps[0].clone();
    value.distribution = distribution;
    if lamps.len() > 1 {
        facts::drop_angular_spectra(&mut value, &mut findings);
    }
    value.absolute = absolute;
    value.input_power_w = powers.filter(|_| undimmed);
    value.lamps = vec![one_set(&lamps, absolute, value.input_power_w)];
    value.declared_flux = lamps.iter().map(|lamp| lamp.declared_flux).sum();
    value.name = joined(lamps.iter().map(|lamp| lamp.name.as_str()));
    value.manufacturer = joined(lamps.iter().map(|lamp| lamp.manufacturer.as_str()));
    value.catalogue_number = joined(lamps.iter().map(|lamp| lamp.catalogue_number.as_str()));
    let differs = |same: &dyn Fn(&Luminaire) -> bool| !lamps.iter().all(same);
    let mut drop = |gone: bool, what: &str| {
        if gone {
            lost.push(what.to_owned());
        }
        gone
    };
    let facts = lamps[0].clone();
    if drop(differs(&|l| l.opening == facts.opening), "the luminous opening") {
        value.opening = None;
    }
    if drop(differs(&|l| l.housing == facts.housing), "the housing") {
        value.housing = None;
    }
    if drop(differs(&|l| l.spectrum == facts.spectrum), "the spectrum") {
        value.spectrum = None;
    }
    value.declared_output_ratio = facts.declared_output_ratio.filter(|_| lamps.len() == 1);
    value.declared_downward_fraction = facts.declared_downward_fraction.filter(|_| lamps.len() == 1);
    let kept = value.keywords.clone();
    let everywhere = |label: &str| {
        let pairs: Vec<_> = kept.iter().filter(|(l, _)| l == label).collect();
        lamps.iter().all(|lamp| pairs.iter().all(|pair| lamp.keywords.contains(pair)))
    };
    lost.extend(facts::drop_keywords(&mut value, |label| {
        let of_one = keyword::declares_flux(label) || label == keyword::FILE_GENERATION;
        !everywhere(label) || (lamps.len() > 1 && of_one)
    }));
    facts::said(&lost, &mut findings);
    if lamps.len() > 1 {
        let message = format!("{} luminaires were added up", lamps.len());
        findings.push(Finding::info("L407", message));
    }
    Ok(Checked { value, findings })
}

/// All lamps as one set.
fn one_set(lamps: &[Luminaire], absolute: bool, power_w: Option<f64>) -> LampSet {
    // Several sets of one luminaire are alternatives in EULUMDAT; the first one scales.
    let sets: Vec<&LampSet> = lamps.iter().filter_map(|lamp| lamp.lamps.first()).collect();
    let same = |text: fn(&LampSet) -> &str| {
        let first = sets.first().map(|set| text(set)).unwrap_or_default();
        if sets.iter().all(|set| text(set) == first) { first.to_owned() } else { String::new() }
    };
    LampSet {
        count: sets.iter().map(|set| set.count).sum(),
        name: joined(sets.iter().map(|set| set.name.as_str())),
        flux_lm: sets.iter().map(|set| set.flux_lm).sum::<Option<f64>>().filter(|_| !absolute),
        colour: same(|set| &set.colour),
        rendering: same(|set| &set.rendering),
        power_w,
    }
}

/// Texts joined by `+`, each once.
fn joined<'t>(texts: impl Iterator<Item = &'t str>) -> String {
    let mut all: Vec<&str> = Vec::new();
    for text in texts.filter(|text| !text.is_empty()) {
        if !all.contains(&text) {
            all.push(text);
        }
    }
    all.join(" + ")
}
