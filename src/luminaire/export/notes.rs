//! What every target says: units, the lamp in one line, what is lost.

use std::f64::consts::PI;

use super::Error;
use crate::finding::{Finding, Severity};
use crate::luminaire::{Kind, Luminaire, System};

/// A flux that differs by more than this share is a warning.
const NOTICEABLE: f64 = 1e-3;

/// The axes, in one line of ASCII.
pub(super) const AXES: &str = "luminaire's frame: -z is the photometric axis (down), +x is C0, +y is C90, +z is up";

/// Names of quantities and units.
pub(super) struct Units {
    /// The quantity tabulated.
    pub(super) quantity: &'static str,
    /// Its unit.
    pub(super) intensity: &'static str,
    /// Unit of its integral.
    pub(super) flux: &'static str,
    /// Unit of what arrives.
    pub(super) arriving: &'static str,
    /// Unit of what a picture shows.
    pub(super) seen: &'static str,
}

impl Units {
    pub(super) fn of(kind: Kind) -> Self {
        let [quantity, intensity, flux, arriving, seen] = match kind {
            Kind::Luminous => ["luminous intensity", "cd", "lm", "lx", "cd/m2"],
            Kind::Radiant => ["radiant intensity", "W/sr", "W", "W/m2", "W/(m2 sr)"],
            Kind::Photon => ["photon intensity", "umol/(s sr)", "umol/s", "umol/(m2 s)", "umol/(m2 s sr)"],
        };
        Self { quantity, intensity, flux, arriving, seen }
    }
}

/// The lamp's name and maker on one line.
fn name(luminaire: &Luminaire) -> String {
    let parts = [&luminaire.name, &luminaire.manufacturer, &luminaire.catalogue_number];
    let line = |text: &String| {
        text.split(|c: char| c.is_control() || c.is_whitespace())
            .filter(|w| !w.is_empty())
            .collect::<Vec<_>>()
            .join(" ")
    };
    let named: Vec<String> = parts.into_iter().map(line).filter(|t| !t.is_empty()).collect();
    if named.is_empty() { "a luminaire without name".to_owned() } else { named.join(", ") }
}

/// Lines that begin every file: who wrote it, what lamp, what flux.
pub(super) fn heading(luminaire: &Luminaire, what: &str) -> Vec<String> {
    let units = Units::of(luminaire.kind);
    vec![
        format!("photopic {}: {what}", env!("CARGO_PKG_VERSION")),
        format!("lamp: {}", name(luminaire)),
        format!(
            "{} in {}; total flux {:.6} {} ({})",
            units.quantity,
            units.intensity,
            luminaire.distribution.total_flux(),
            units.flux,
            if luminaire.absolute { "absolute photometry" } else { "relative photometry, scaled to its lamps" }
        ),
    ]
}

/// Refuses a stem that scene files cannot hold between quotation marks, or that Radiance takes for a command (`!`).
pub(super) fn checked_stem(stem: &str) -> Result<(), Error> {
    let bad = |c: char| c.is_control() || matches!(c, '"' | '\\' | char::REPLACEMENT_CHARACTER);
    if stem.is_empty() || stem.starts_with('!') || stem.contains(bad) {
        Err(Error::Name { found: stem.to_owned() })
    } else {
        Ok(())
    }
}

/// Findings on facts that the target has no place for.
///
/// Light sources treat the opening for themselves; a table has no place for it.
pub(super) fn not_carried(luminaire: &Luminaire, target: &str, is_light: bool) -> Vec<Finding> {
    let mut findings = Vec::new();
    let lost: Vec<&str> = [
        (!luminaire.lamps.is_empty(), "lamp sets"),
        (luminaire.input_power_w.is_some(), "input power"),
        (luminaire.opening.is_some() && !is_light, "luminous opening"),
        (luminaire.housing.is_some(), "housing"),
        (!luminaire.keywords.is_empty(), "keywords"),
    ]
    .into_iter()
    .filter_map(|(has, what)| has.then_some(what))
    .collect();
    if !lost.is_empty() {
        findings.push(Finding::info("L501", format!("{target} cannot carry: {}", lost.join(", "))));
    }
    let spectra = match (&luminaire.spectrum, &luminaire.angular_spectra) {
        (_, Some(_)) => Some("spectra by direction"),
        (Some(_), None) => Some("spectrum"),
        (None, None) => None,
    };
    if let Some(spectra) = spectra {
        let message = format!("{target} was written without the lamp's {spectra}");
        findings.push(Finding::warning("L501", message).hint("TM-33 carries it"));
    }
    findings
}

/// For light sources: the finding on negative intensities.
pub(super) fn negative(luminaire: &Luminaire) -> Option<Finding> {
    let lowest = luminaire.distribution.values().iter().copied().fold(0.0, f64::min);
    let unit = Units::of(luminaire.kind).intensity;
    let message = || format!("negative intensities, down to {lowest} {unit}, were written as 0");
    (lowest < 0.0).then(|| Finding::warning("L502", message()))
}

/// For renderers: what results mean when the intensities are no candela.
pub(super) fn other_kind(luminaire: &Luminaire) -> Option<Finding> {
    let units = Units::of(luminaire.kind);
    let message = || {
        format!(
            "the numbers are {} as in the lamp: irradiance comes out in {}, pictures in {}",
            units.intensity, units.arriving, units.seen
        )
    };
    (luminaire.kind != Kind::Luminous).then(|| Finding::info("L503", message()))
}

/// The finding on a flux that sampling a picture changed.
pub(super) fn pixelled(luminaire: &Luminaire, written: f64, how: &str) -> Finding {
    let finding = sampled(luminaire, written, how);
    if finding.severity == Severity::Info { finding } else { finding.hint("more pixels come nearer") }
}

/// The finding on a flux that sampling changed.
pub(super) fn sampled(luminaire: &Luminaire, written: f64, how: &str) -> Finding {
    let given = luminaire.distribution.total_flux();
    let unit = Units::of(luminaire.kind).flux;
    let share = if given == 0.0 { 0.0 } else { written / given - 1.0 };
    let message = format!("sampled {how}: {written:.6} {unit} instead of {given:.6} {unit} ({:+.4} %)", share * 100.0);
    let severity = if share.abs() < NOTICEABLE { Severity::Info } else { Severity::Warning };
    Finding::new("L504", severity, message)
}

/// For targets without extent: the finding on the opening.
pub(super) fn as_point(luminaire: &Luminaire, target: &str) -> Option<Finding> {
    let extended = luminaire.opening.is_some_and(|b| b.length_m > 0.0 || b.width_m > 0.0 || b.height_m > 0.0);
    let message = || format!("{target} has no light of this extent with a distribution: written as a point");
    extended.then(|| Finding::info("L505", message()).hint("nearer than five times its size the light falls otherwise"))
}

/// The letter of the photometric type.
pub(super) fn type_letter(system: System) -> &'static str {
    match system {
        System::TypeA => "A",
        System::TypeB => "B",
        System::TypeC => "C",
    }
}

/// Solid angle of the whole sphere.
pub(super) const SPHERE_SR: f64 = 4.0 * PI;
