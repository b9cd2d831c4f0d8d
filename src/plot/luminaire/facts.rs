//! Figures of a luminaire: the cone diagram and the head of the sheet.

use super::super::{ConePanel, ConeStep, FiguresPanel};
use super::{Drawn, Error, View, angle, signed, unit};
use crate::luminaire::beam::{self, BEAM_FRACTION, Definition, FIELD_FRACTION, PlaneAngles};
use crate::luminaire::cone::cone;
use crate::luminaire::cut::Cut;
use crate::luminaire::{Kind, Symmetry, System, zonal};
use crate::units::significant;

/// Distances of a cone diagram are whole multiples of one of these, m.
const DISTANCE_STEPS_M: [f64; 5] = [20.0, 10.0, 5.0, 2.0, 1.0];
/// The farthest of five distances is one at which a lamp still gives this much on the axis, lx.
const LEAST_LX: f64 = 50.0;
/// Beams whose angles differ by less are round, degrees.
const ROUND_DEG: f64 = 0.05;

/// The cone diagram of the half-peak beam.
///
/// # Errors
/// [`Error::NoCone`].
pub fn cone_panel(drawn: &Drawn<'_>, view: &View) -> Result<ConePanel, Error> {
    let d = &drawn.luminaire.distribution;
    let axis = d.at(0.0, 0.0);
    if axis <= 0.0 {
        return Err(Error::NoCone("the axis is dark"));
    }
    let beside = |plane: f64| {
        let beam = Cut::of(d, plane).limits(BEAM_FRACTION, Definition::Fwhm, d.peak().0);
        beam.is_some_and(|(low, high)| low > 0.0 || high < 0.0)
    };
    if beside(0.0) || beside(90.0) {
        return Err(Error::NoCone("the half-peak beam lies beside it"));
    }
    let distances_m = if view.distances_m.is_empty() {
        let enough = |step: &f64| axis / (25.0 * step * step) >= LEAST_LX;
        let luminous = drawn.luminaire.kind == Kind::Luminous;
        let step = DISTANCE_STEPS_M.into_iter().find(|s| luminous && enough(s)).unwrap_or(1.0);
        (1..=5).map(|i| step * f64::from(i)).collect()
    } else {
        view.distances_m.clone()
    };
    let rows = cone(d, &distances_m);
    if rows.iter().all(|r| r.width_m == [None; 2]) {
        return Err(Error::NoCone("the half-peak beam is 180° or wider"));
    }
    let steps = rows.iter().map(|r| ConeStep { distance_m: r.distance_m, on_axis: r.axis_lx, width_m: r.width_m });
    let beam = beam::angles(d, BEAM_FRACTION, Definition::Fwhm);
    let names = if d.system() == System::TypeC { ["C0–C180", "C90–C270"] } else { ["H", "V"] };
    let alike = beam.c0_c180.zip(beam.c90_c270).is_some_and(|(a, b)| (a - b).abs() < ROUND_DEG);
    let round = alike || (d.system() == System::TypeC && d.symmetry() == Symmetry::Rotational);
    let [first, second] = names.map(str::to_owned);
    Ok(ConePanel {
        title: if view.named { drawn.name } else { "cone diagram" }.to_owned(),
        steps: steps.collect(),
        unit: match drawn.luminaire.kind {
            Kind::Luminous => "lx",
            Kind::Radiant => "W/m²",
            Kind::Photon => "µmol/(m²·s)",
        }
        .to_owned(),
        planes: [(if round { String::new() } else { first }, beam.c0_c180), (second, beam.c90_c270)],
        round,
    })
}

/// The head of the sheet: names and key figures.
#[must_use]
pub fn figures_panel(drawn: &Drawn<'_>) -> FiguresPanel {
    let lamp = drawn.luminaire;
    let d = &lamp.distribution;
    let mut figures: Vec<(String, String)> = Vec::new();
    let mut add = |name: &str, value: String| {
        if !value.trim().is_empty() {
            figures.push((name.to_owned(), signed(&value)));
        }
    };
    let (flux, per_power) = match lamp.kind {
        Kind::Luminous => (("luminous flux", "lm"), ("efficacy", "lm/W")),
        Kind::Radiant => (("radiant flux", "W"), ("efficiency", "W/W")),
        Kind::Photon => (("photon flux", "µmol/s"), ("photon efficacy", "µmol/J")),
    };
    let percent = |part: f64| format!("{} %", significant(100.0 * part, 3));
    add(flux.0, format!("{} {}", significant(d.total_flux(), 4), flux.1));
    if let Some(lamps) = zonal::lamp_flux_lm(lamp) {
        add("rated lamps", format!("{} lm", significant(lamps, 4)));
    }
    if let Some(ratio) = zonal::light_output_ratio(lamp) {
        add("light output ratio", percent(ratio));
    }
    if let Some(power) = lamp.input_power_w.filter(|w| *w > 0.0) {
        add("input power", format!("{} W", significant(power, 3)));
    }
    if let Some(ratio) = zonal::efficacy(lamp) {
        add(per_power.0, format!("{} {}", significant(ratio, 3), per_power.1));
    }
    let (peak, h, v) = d.peak();
    let [first, second] = if d.system() == System::TypeC { ["C", "γ "] } else { ["H ", "V "] };
    let at = format!("{first}{}°, {second}{}°", angle(h), angle(v));
    add("peak intensity", format!("{} {} at {at}", significant(peak, 4), unit(lamp.kind, false)));
    add("beam angle (50 %)", pair(beam::angles(d, BEAM_FRACTION, Definition::Fwhm)));
    add("field angle (10 %)", pair(beam::angles(d, FIELD_FRACTION, Definition::Fwhm)));
    if let Ok(part) = zonal::downward_flux_fraction(d) {
        add("downward flux", percent(part));
    }
    if let Ok(code) = zonal::cie_flux_code(lamp) {
        let all: Vec<String> = code.n1_to_n4.into_iter().chain(code.n5).map(|n| format!("{n:.0}")).collect();
        add("CIE flux code", all.join(" "));
    }
    figures.extend(
        [("maker", &lamp.manufacturer), ("catalogue number", &lamp.catalogue_number)]
            .into_iter()
            .filter(|(_, text)| !text.trim().is_empty())
            .map(|(name, text)| (name.to_owned(), text.clone())),
    );
    FiguresPanel { title: drawn.name.to_owned(), figures }
}

/// `38.2° × 41°`, or one angle where both are the same.
fn pair(angles: PlaneAngles) -> String {
    let one = |a: Option<f64>| a.map_or("–".to_owned(), |a| format!("{}°", angle(a)));
    match (angles.c0_c180, angles.c90_c270) {
        (None, None) => String::new(),
        (Some(a), Some(b)) if (a - b).abs() < ROUND_DEG => one(Some(a)),
        (a, b) => format!("{} × {}", one(a), one(b)),
    }
}
