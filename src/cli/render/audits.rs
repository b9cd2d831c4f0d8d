//! What the audits of a render have to say.

use crate::finding::{Finding, Location};
use crate::render::audit::{Audit, is_off};
use crate::render::build::Built;
use crate::units::significant;

/// Losses of a reading and of an albedo below these shares are in the JSON alone.
const WORTH_SAYING: f64 = 0.01;

/// The findings of the audits.
pub(super) fn findings(path: &str, built: &Built, audit: &Audit) -> Vec<Finding> {
    let mut out = Vec::new();
    let mut add = |finding: Finding, hint: &str| {
        out.push(finding.at(Location::default().in_file(path)).hint(hint.to_owned()));
    };
    let percent = |share: f64| significant(100.0 * share, 3);
    if let Some(e) = &audit.energy {
        if e.faulty > 0 {
            let message = format!(
                "{} of {} packets of the energy audit met a number that is none",
                e.faulty,
                e.packets + e.faulty
            );
            add(Finding::warning("R004", message), "a material or a light whose values are not finite");
        }
        if e.is_unbalanced() {
            let message = format!(
                "{} W were emitted, and {} W of them neither absorbed nor let out",
                significant(e.emitted_w(), 4),
                significant(e.balance_w.value, 3)
            );
            add(Finding::warning("R004", message), "a material that gives back more than it gets");
        }
        for (light, name) in e.lights.iter().zip(&built.light_names).filter(|(l, _)| l.is_off()) {
            let (stated, sent) = (significant(light.stated_w, 4), significant(light.emitted_w.value, 4));
            let message = format!("light `{name}` states {stated} W and sends out {sent} W");
            add(Finding::warning("R004", message), "please report it with the scene");
        }
        for (light, name) in e.lights.iter().zip(&built.light_names) {
            if !light.travels && light.stated_w > 0.0 {
                let message = format!(
                    "light `{name}` does not travel as light does: the energy audit follows it as if it fell off by the square law"
                );
                add(Finding::info("R006", message), "controls such as falloff, clip and blockers are no physics");
            }
        }
        for (m, name) in e.materials.iter().zip(&built.material_names).filter(|(m, _)| m.is_off()) {
            let excess = m.excess.expect("what is off is known");
            let than = if excess.value > 0.0 { "more" } else { "less" };
            let message = format!(
                "material `{name}` scatters {} ± {} % {than} than its reflectance",
                percent(excess.value.abs()),
                percent(excess.standard_error)
            );
            add(
                Finding::warning("R004", message),
                "normals at the corners of a mesh lose light that they would send through its surface",
            );
        }
    }
    for (instrument, lost) in built.instruments.iter().zip(&audit.lost) {
        let Some(l) = lost else { continue };
        if l.share() > WORTH_SAYING && is_off(l.lost, l.whole.value) {
            let message = format!(
                "sensor `{}` lacks {} % of the light: the solver leaves it out",
                instrument.name,
                percent(l.share())
            );
            add(Finding::warning("R005", message), "solver = \"path\" without `max_edges` follows all light");
        }
    }
    for (name, lost) in built.single_scattering.iter().filter(|(_, lost)| lost.at_0_deg.max(lost.mean) > WORTH_SAYING) {
        let message = format!(
            "material `{name}` lacks {} % of the light along its normal and {} % on average: its facets scatter once",
            percent(lost.at_0_deg),
            percent(lost.mean)
        );
        add(Finding::warning("R005", message), "`metal` and `dielectric` keep what is scattered several times");
    }
    out
}
