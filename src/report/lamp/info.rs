//! `lamp info`: the facts and figures of one luminaire, and how each is defined.

use serde_json::{Map, Value, json};

use crate::luminaire::format::{File, Format};
use crate::luminaire::{Body, Kind, Symmetry, System, beam, bug, cone, lcs, luminance, nema, spacing, zonal};

/// Distances of the cone's rows, m.
const CONE_DISTANCES_M: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];

/// Definition of each figure of `lamp info` by its key; of fluxes and intensities in any unit.
const DEFINITIONS: [(&str, &str); 17] = [
    ("declared_flux", "as the file states it: luminaire flux, or rated flux of the lamps"),
    ("total_flux", "exact integral of the intensity interpolated linearly in both angles"),
    (
        "total_flux_zonal",
        "zonal-constant rule: native intervals, mean of the ends times the zone's solid angle (IES LM-79)",
    ),
    (
        "peak_direction_deg",
        "first largest entry of the table; C and γ, for Types A and B horizontal and vertical angle",
    ),
    (
        "beam_angle_deg",
        "50 %: fwhm of the plane's maximum; outermost of the maximum of all planes (IES LM-35); of the value at nadir",
    ),
    ("field_angle_deg", "10 %: as beam_angle_deg"),
    ("nema_type", "horizontal, vertical: by the outermost 10 % of the maximum (NEMA FA 1); Types A and B only"),
    ("lcs_lm", "flux in the ten solid angles of IES TM-15-11; street side C0 in LM-63, C90 in EULUMDAT and TM-33"),
    ("bug_rating", "IES TM-15-11, Addendum A; Type V where the quadrants agree within a tenth of the maximum"),
    ("luminance_cd_per_m2", "intensity over the projected area of the luminous opening (CIE 117, EN 13032-2)"),
    ("downward_flux_fraction", "flux below the horizontal over all flux (DFF, CIE 121)"),
    ("cie_flux_code", "N1 to N5, per cent (CIE 52, EN 13032-2)"),
    ("zonal_flux_lm", "exact integral by zones of 10° of γ"),
    ("luminous_efficacy_lm_per_w", "flux of the luminaire over its input power"),
    ("light_output_ratio", "flux of the luminaire over the rated flux of its lamps"),
    (
        "spacing_criterion",
        "spacing over mounting height at which the midpoint falls below the point under one luminaire (IES Handbook)",
    ),
    ("equivalent_cone", "circular cone of the solid angle in which the intensity reaches half of its maximum"),
];

/// Definitions of the figures, for the settings of a run.
#[must_use]
pub fn definitions() -> Value {
    DEFINITIONS.into_iter().map(|(key, text)| (key.to_owned(), Value::from(text))).collect::<Map<_, _>>().into()
}

/// Keys of one kind of intensity.
struct Keys {
    flux: &'static str,
    peak: &'static str,
    /// What the intensity makes on the axis.
    axis: &'static str,
}

fn keys(kind: Kind) -> Keys {
    match kind {
        Kind::Luminous => Keys { flux: "flux_lm", peak: "peak_intensity_cd", axis: "axis_illuminance_lx" },
        Kind::Radiant => Keys { flux: "flux_w", peak: "peak_intensity_w_per_sr", axis: "axis_irradiance_w_per_m2" },
        Kind::Photon => Keys {
            flux: "flux_umol_per_s",
            peak: "peak_intensity_umol_per_s_sr",
            axis: "axis_photon_irradiance_umol_per_m2_s",
        },
    }
}

/// C-plane of the street side: C0 in LM-63, C90 in EULUMDAT and TM-33.
fn street_side(file: &File) -> f64 {
    match file.format {
        Format::Ies => lcs::STREET_C_DEG_IES,
        _ => lcs::STREET_C_DEG_EULUMDAT,
    }
}

/// The object of `lamp info` in `results[]`; figures that do not apply are absent.
#[must_use]
pub fn info(file: &File) -> Map<String, Value> {
    let lamp = &file.luminaire;
    let d = &lamp.distribution;
    let luminous = lamp.kind == Kind::Luminous;
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    for (key, text) in
        [("name", &lamp.name), ("manufacturer", &lamp.manufacturer), ("catalogue_number", &lamp.catalogue_number)]
    {
        if !text.is_empty() {
            set(key, text.clone().into());
        }
    }
    set("format", file.format.to_string().into());
    set("format_version", file.version.clone().into());
    set("photometry_type", system(d.system()).into());
    set("symmetry", symmetry(d.symmetry()).into());
    set("vertical_angles", d.vertical_deg().len().into());
    set("horizontal_angles", d.horizontal_deg().len().into());
    set("absolute", lamp.absolute.into());
    let keys = keys(lamp.kind);
    if let Some(value) = lamp.declared_flux.or_else(|| zonal::lamp_flux_lm(lamp)) {
        set(&format!("declared_{}", keys.flux), value.into());
    }
    set(&format!("total_{}", keys.flux), d.total_flux().into());
    set(&keys.flux.replacen("flux", "total_flux_zonal", 1), d.total_flux_zonal().into());
    let (peak, h, v) = d.peak();
    set(keys.peak, peak.into());
    set("peak_direction_deg", json!({"c": h, "gamma": v}));
    let angles = |list: [beam::PlaneAngles; 3]| -> Value {
        list.iter()
            .map(|a| json!({"definition": a.definition.name(), "c0_c180": a.c0_c180, "c90_c270": a.c90_c270}))
            .collect::<Vec<_>>()
            .into()
    };
    set("beam_angle_deg", angles(beam::beam_angles(d)));
    set("field_angle_deg", angles(beam::field_angles(d)));
    if let Some((horizontal, vertical)) = nema::nema_types(d) {
        set("nema_type", json!([horizontal, vertical]));
    }
    if let (true, Ok(zones)) = (luminous, lcs::lcs(d, street_side(file))) {
        let named: Map<String, Value> = zones.named().iter().map(|(k, v)| ((*k).to_owned(), (*v).into())).collect();
        set("lcs_lm", named.into());
        set("bug_rating", bug::bug_rating(&zones, bug::lateral(d)).to_string().into());
    }
    if let (true, Ok(rows)) = (luminous, luminance::luminance_table(lamp, &luminance::TABLE_GAMMA_DEG)) {
        let rows: Vec<Value> = rows
            .iter()
            .map(|r| json!({"c_deg": r.c_deg, "gamma_deg": luminance::TABLE_GAMMA_DEG, "cd_per_m2": r.cd_per_m2}))
            .collect();
        set("luminance_cd_per_m2", rows.into());
    }
    if let Ok(fraction) = zonal::downward_flux_fraction(d) {
        set("downward_flux_fraction", fraction.into());
    }
    if let Ok(code) = zonal::cie_flux_code(lamp) {
        let all: Vec<f64> = code.n1_to_n4.into_iter().chain(code.n5).collect();
        set("cie_flux_code", json!(all));
    }
    if let (true, Ok(zones)) = (luminous, zonal::zones(d, 10.0)) {
        let zones: Vec<Value> =
            zones.iter().map(|z| json!({"from_deg": z.from_deg, "to_deg": z.to_deg, "flux_lm": z.flux})).collect();
        set("zonal_flux_lm", zones.into());
    }
    if let Some(watts) = lamp.input_power_w {
        set("input_power_w", watts.into());
    }
    if let (true, Some(efficacy)) = (luminous, zonal::efficacy(lamp)) {
        set("luminous_efficacy_lm_per_w", efficacy.into());
    }
    if let Some(ratio) = zonal::light_output_ratio(lamp) {
        set("light_output_ratio", ratio.into());
    }
    if let Ok(s) = spacing::spacing_criterion(d) {
        set("spacing_criterion", json!({"c0_c180": s.c0_c180, "c90_c270": s.c90_c270, "diagonal": s.diagonal}));
    }
    if let Some(e) = cone::equivalent_cone(d) {
        set(
            "equivalent_cone",
            json!({"angle_deg": e.angle_deg, "solid_angle_sr": e.solid_angle_sr, keys.flux: e.flux}),
        );
    }
    let cone = cone::cone(d, &CONE_DISTANCES_M);
    let cone = cone.iter().map(|r| json!({"distance_m": r.distance_m, keys.axis: r.axis_lx, "width_c0_c180_m": r.width_m[0], "width_c90_c270_m": r.width_m[1]}));
    set("cone", cone.collect::<Vec<_>>().into());
    if let Some(opening) = &lamp.opening {
        set("luminous_opening_m", body(opening));
    }
    set("interpolation", d.interpolation().name().into());
    out
}

fn body(b: &Body) -> Value {
    json!({"shape": b.shape.name(), "length_m": b.length_m, "width_m": b.width_m, "height_m": b.height_m})
}

fn system(system: System) -> &'static str {
    match system {
        System::TypeA => "A",
        System::TypeB => "B",
        System::TypeC => "C",
    }
}

fn symmetry(symmetry: Symmetry) -> &'static str {
    match symmetry {
        Symmetry::Rotational => "rotational",
        Symmetry::Quadrant => "quadrant",
        Symmetry::BilateralC0 => "bilateral_c0_c180",
        Symmetry::BilateralC90 => "bilateral_c90_c270",
        Symmetry::None => "none",
    }
}
