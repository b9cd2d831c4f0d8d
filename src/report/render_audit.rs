//! `render`: where the energy went, and what readings and materials lose.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::render::audit::Audit;
use crate::render::audit::energy::Energy;
use crate::render::build::Built;
use crate::render::estimate::Figure;
use crate::units::significant;

/// Losses of an albedo below this are in the JSON alone.
const WORTH_A_LINE: f64 = 1e-3;

fn watts(figure: Figure) -> Value {
    json!({"value_w": figure.value, "standard_error_w": figure.standard_error})
}

/// `energy` of the result; `null` where it was not asked for or nothing shines.
#[must_use]
pub fn energy(built: &Built, audit: &Audit) -> Value {
    let Some(e) = &audit.energy else { return Value::Null };
    let lights = e.lights.iter().zip(&built.light_names).map(|(light, name)| {
        json!({
            "name": name,
            "stated_w": light.stated_w,
            "packets": light.packets,
            "emitted": watts(light.emitted_w),
            "travels_as_light": light.travels,
        })
    });
    let materials = e.materials.iter().zip(&built.material_names).filter(|(m, _)| m.arrived_w.value != 0.0);
    let materials = materials.map(|(m, name)| {
        let mut out = Map::new();
        out.insert("name".to_owned(), name.as_str().into());
        out.insert("arrived".to_owned(), watts(m.arrived_w));
        out.insert("absorbed".to_owned(), watts(m.absorbed_w));
        if let Some(excess) = m.excess {
            let value = json!({"value": excess.value, "standard_error": excess.standard_error});
            out.insert("scattered_beyond_albedo".to_owned(), value);
        }
        Value::from(out)
    });
    json!({
        "packets": e.packets,
        "lights": lights.collect::<Vec<_>>(),
        "materials": materials.collect::<Vec<_>>(),
        "escaped": watts(e.escaped_w),
        "balance": watts(e.balance_w),
    })
}

/// `bias` of the result.
#[must_use]
pub fn bias(built: &Built, audit: &Audit) -> Value {
    let sensors = built.instruments.iter().zip(&audit.lost).filter_map(|(instrument, lost)| {
        let lost = lost.as_ref()?;
        Some(json!({
            "name": instrument.name,
            "lost": lost.lost.value,
            "standard_error": lost.lost.standard_error,
            "share": lost.share(),
        }))
    });
    let materials = built.single_scattering.iter().map(|(name, lost)| {
        json!({
            "name": name,
            "lost_albedo": {"at_0_deg": lost.at_0_deg, "at_60_deg": lost.at_60_deg, "mean": lost.mean},
        })
    });
    json!({
        "paths": sensors.collect::<Vec<_>>(),
        "single_scattering": materials.collect::<Vec<_>>(),
        "clamping": "none",
    })
}

/// The audits for people.
#[must_use]
pub fn text(built: &Built, audit: &Audit) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    if let Some(e) = &audit.energy {
        energy_text(&mut out, built, e);
    }
    for (instrument, lost) in built.instruments.iter().zip(&audit.lost) {
        if let Some(l) = lost {
            let _ = writeln!(
                out,
                "{}: the solver leaves out {} % of the light ({} ± {} in the unit of the reading)",
                instrument.name,
                significant(100.0 * l.share(), 3),
                significant(l.lost.value, 4),
                significant(l.lost.standard_error, 2)
            );
        }
    }
    for (name, lost) in
        built.single_scattering.iter().filter(|(_, lost)| lost.at_0_deg.max(lost.at_60_deg) > WORTH_A_LINE)
    {
        let _ = writeln!(
            out,
            "material {name}: facets that scatter once lose {} of the light along the normal, {} at 60°",
            significant(lost.at_0_deg, 2),
            significant(lost.at_60_deg, 2)
        );
    }
    out
}

/// Emitted, absorbed by each material that light met, escaped.
fn energy_text(out: &mut String, built: &Built, e: &Energy) {
    let watts = |f: Figure| {
        if f.value == 0.0 && f.standard_error == 0.0 {
            return "nothing".to_owned();
        }
        format!("{} ± {} W", significant(f.value, 4), significant(f.standard_error, 2))
    };
    // Writing to a string cannot fail.
    let _ = writeln!(out, "energy: {} W emitted ({} packets)", significant(e.emitted_w(), 4), e.packets);
    for (m, name) in e.materials.iter().zip(&built.material_names).filter(|(m, _)| m.arrived_w.value != 0.0) {
        let (absorbed, arrived) = (watts(m.absorbed_w), significant(m.arrived_w.value, 4));
        let _ = writeln!(out, "        {name} absorbed {absorbed} of {arrived} W that arrived");
    }
    let (escaped, balance) = (watts(e.escaped_w), watts(e.balance_w));
    let _ = writeln!(out, "        {escaped} escaped; unaccounted for: {balance}");
}
