//! Conversions as one table: the columns depend on the groups of figures asked for and on nothing else, so that a script can
//! rely on them; what does not apply is an empty cell.

use serde_json::{Map, Value};

use super::conversion::keys;
use crate::conversion::Groups;
use crate::photometry::alpha_opic::RECEPTORS;
use crate::spectrum::Quantity;

/// A column: its header, and the path to its value in the JSON object (`a.b.0`).
fn columns(groups: Groups, mesopic: bool, reflectance: bool) -> Vec<String> {
    let mut out: Vec<String> = ["path", "name", "quantity"].map(str::to_owned).to_vec();
    let kinds = ["photopic", "radiometric", "scotopic"].into_iter().chain(mesopic.then_some("mesopic"));
    for kind in kinds {
        for keys in Quantity::ABSOLUTE.into_iter().filter_map(keys) {
            out.push(format!("{kind}.{}", if kind == "radiometric" { keys.radiometric } else { keys.luminous }));
        }
    }
    let mut add = |list: &[&str]| out.extend(list.iter().map(|s| (*s).to_owned()));
    add(&["luminous_efficacy_of_radiation_lm_per_w", "scotopic_photopic_ratio", "xyz.0", "xyz.1", "xyz.2"]);
    add(&["chromaticity_xy.0", "chromaticity_xy.1", "chromaticity_uv_prime.0", "chromaticity_uv_prime.1"]);
    if reflectance {
        add(&["whiteness", "tint", "yellowness_e313"]);
    }
    if groups.colour {
        add(&["cct_k", "duv", "dominant_wavelength_nm", "excitation_purity"]);
    }
    if groups.shape {
        add(&["peak_wavelength_nm", "centroid_wavelength_nm", "fwhm_nm"]);
    }
    if groups.cri {
        add(&["cri_ra"]);
        out.extend((0..14).map(|i| format!("cri_r.{i}")));
    }
    let mut add = |list: &[&str]| out.extend(list.iter().map(|s| (*s).to_owned()));
    if groups.tm30 {
        add(&["tm30_rf", "tm30_rg"]);
    }
    if groups.alpha_opic {
        for receptor in RECEPTORS {
            out.extend(["der", "edi_lx", "efficacy_w_per_lm"].map(|k| format!("alpha_opic.{receptor}.{k}")));
        }
    }
    let mut add = |list: &[&str]| out.extend(list.iter().map(|s| (*s).to_owned()));
    if groups.photon {
        add(&["photon.umol_per_j", "photon.ppf_umol_per_s", "photon.ppfd_umol_per_m2_s"]);
    }
    if groups.rgb {
        add(&["rgb.srgb.0", "rgb.srgb.1", "rgb.srgb.2"]);
    }
    add(&["integration.rule", "integration.error_bound.photopic_relative"]);
    out
}

/// A table in the making.
#[derive(Debug)]
pub struct Table {
    columns: Vec<String>,
}

impl Table {
    /// The table of the groups of figures, of reflectances with their whiteness; with uncertainties each figure has three more columns.
    #[must_use]
    pub fn new(groups: Groups, mesopic: bool, reflectance: bool, uncertainty: bool) -> Self {
        let mut columns = columns(groups, mesopic, reflectance);
        if uncertainty {
            let no_figure = |c: &String| {
                ["path", "name", "quantity"].contains(&c.as_str())
                    || c.starts_with("integration.")
                    || c.starts_with("rgb.")
            };
            let figures: Vec<String> = columns.iter().filter(|c| !no_figure(c)).cloned().collect();
            for figure in figures {
                columns.extend(
                    ["standard", "expanded_95.0", "expanded_95.1"].map(|k| format!("uncertainty.{figure}.{k}")),
                );
            }
        }
        Self { columns }
    }

    /// The header row.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.columns
    }

    /// The cells of one result.
    #[must_use]
    pub fn row(&self, result: &Map<String, Value>) -> Vec<String> {
        self.columns.iter().map(|path| cell(result, path)).collect()
    }
}

/// The value at a dotted path, as a cell.
pub(super) fn cell(result: &Map<String, Value>, path: &str) -> String {
    match at(result, path) {
        Some(Value::String(s)) => s.clone(),
        Some(v @ (Value::Number(_) | Value::Bool(_))) => v.to_string(),
        _ => String::new(),
    }
}

/// The value at a dotted path such as `cri_r.8` or `photopic.illuminance_lx`.
#[must_use]
pub fn at<'a>(result: &'a Map<String, Value>, path: &str) -> Option<&'a Value> {
    let mut parts = path.split('.');
    let mut here = result.get(parts.next()?)?;
    for part in parts {
        here = match here {
            Value::Array(items) => items.get(part.parse::<usize>().ok()?)?,
            other => other.get(part)?,
        };
    }
    Some(here)
}
