//! The figures that instruments print beside a spectrum, under the keys of our own results.

use super::{Printed, number};

/// Reads one printed figure: its label as the instrument writes it and its text. `None` where the text is no number.
pub(super) fn figure(label: &str, text: &str) -> Option<Printed> {
    let text = text.trim();
    let value = number::parse(text, '.').number()?;
    let key = Some(key(&plain(label))).filter(|key| unit_fits(key, label)).unwrap_or("");
    // Purity in per cent becomes the fraction that our own figure is.
    let value = if key == "excitation_purity" && label.contains('%') { value / 100.0 } else { value };
    Some(Printed { key, label: label.trim().to_owned(), value, text: text.to_owned() })
}

/// Like [`figure`], for files of which nobody knows that they are an instrument's: only labels that we have a key for, and no
/// single letters, which may stand for anything.
pub(super) fn known_figure(label: &str, text: &str) -> Option<Printed> {
    figure(label, text).filter(|printed| !printed.key.is_empty() && label.trim().len() > 1)
}

/// The label without unit brackets and blanks at its ends, single-spaced.
fn plain(label: &str) -> String {
    let stem = label.split(['[', '(']).next().unwrap_or(label);
    stem.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Whether the unit in the label's brackets, if there is one, is that of the key: `Illuminance [fc]` is no figure in lux.
fn unit_fits(key: &str, label: &str) -> bool {
    let Some((_, unit)) = label.split_once(['[', '(']) else { return true };
    let unit = unit.trim().trim_end_matches([']', ')']).to_lowercase();
    match key {
        "photopic.illuminance_lx" => matches!(unit.as_str(), "lx" | "lux"),
        "photopic.luminance_cd_per_m2" => matches!(unit.as_str(), "cd/m2" | "cd/m²" | "nit" | "nits"),
        "photopic.luminous_flux_lm" => unit == "lm",
        "cct_k" => unit == "k",
        "peak_wavelength_nm" | "dominant_wavelength_nm" => unit == "nm",
        "excitation_purity" => unit == "%",
        "photon.ppfd_umol_per_m2_s" => unit.starts_with("umol") || unit.starts_with("µmol") || unit.starts_with("μmol"),
        "radiometric.irradiance_w_per_m2" => matches!(unit.as_str(), "w/m2" | "w/m²"),
        _ => true,
    }
}

fn key(label: &str) -> &'static str {
    // Chromaticity and tristimulus labels differ by case alone.
    match label {
        "x" | "CIE1931 x" | "CIE x" => return "chromaticity_xy.0",
        "y" | "CIE1931 y" | "CIE y" => return "chromaticity_xy.1",
        "u'" | "u’" | "u′" | "CIE1976 u'" | "CIE u'" => return "chromaticity_uv_prime.0",
        "v'" | "v’" | "v′" | "CIE1976 v'" | "CIE v'" => return "chromaticity_uv_prime.1",
        "X" | "Tristimulus Value X" => return "xyz.0",
        "Y" | "Tristimulus Value Y" => return "xyz.1",
        "Z" | "Tristimulus Value Z" => return "xyz.2",
        _ => {}
    }
    match label.to_lowercase().as_str() {
        "lux" | "illuminance" => "photopic.illuminance_lx",
        "luminance" => "photopic.luminance_cd_per_m2",
        "luminous flux" => "photopic.luminous_flux_lm",
        "cct" | "tcp" => "cct_k",
        "duv" | "δuv" | "∆uv" | "⊿uv" => "duv",
        "cri" | "ra" | "cri ra" => "cri_ra",
        "rf" | "tm-30 rf" => "tm30_rf",
        "rg" | "tm-30 rg" => "tm30_rg",
        "lambdap" | "peak wavelength" => "peak_wavelength_nm",
        "lambdad" | "dominant wavelength" => "dominant_wavelength_nm",
        "purity" | "excitation purity" => "excitation_purity",
        "ppfd" => "photon.ppfd_umol_per_m2_s",
        "irr" | "irradiance" => "radiometric.irradiance_w_per_m2",
        other => special_index(other.strip_prefix("cri ").unwrap_or(other)),
    }
}

/// `r1` … `r14`; R15 is not one of CIE 13.3.
fn special_index(label: &str) -> &'static str {
    const KEYS: [&str; 14] = [
        "cri_r.0", "cri_r.1", "cri_r.2", "cri_r.3", "cri_r.4", "cri_r.5", "cri_r.6", "cri_r.7", "cri_r.8", "cri_r.9",
        "cri_r.10", "cri_r.11", "cri_r.12", "cri_r.13",
    ];
    let number = label.strip_prefix('r').filter(|n| n.bytes().all(|b| b.is_ascii_digit()));
    number.and_then(|n| n.parse::<usize>().ok()).and_then(|n| KEYS.get(n.checked_sub(1)?)).copied().unwrap_or("")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_find_their_key() {
        for (label, text, key, value) in [
            ("LUX", "695.154907", "photopic.illuminance_lx", 695.154907),
            ("Illuminance [lx]", "30.1", "photopic.illuminance_lx", 30.1),
            ("⊿uv", "-0.0029", "duv", -0.0029),
            ("R9", "77.6", "cri_r.8", 77.6),
            ("CRI R14", "98.8", "cri_r.13", 98.8),
            ("R15", "88.6", "", 88.6),
            ("Purity [%]", "41.5", "excitation_purity", 0.415),
            ("x", "0.33", "chromaticity_xy.0", 0.33),
            ("X", "682.5", "xyz.0", 682.5),
            ("CIE1976 u'", "0.2434", "chromaticity_uv_prime.0", 0.2434),
            ("SSI-A", "44.9", "", 44.9),
            ("R", "1", "", 1.0),
            ("Illuminance [fc]", "2.79", "", 2.79),
            ("PPFD [umolm⁻²s⁻¹]", "0.4", "photon.ppfd_umol_per_m2_s", 0.4),
        ] {
            let printed = figure(label, text).unwrap_or_else(|| panic!("{label}"));
            assert_eq!((printed.key, printed.value, printed.text.as_str()), (key, value, text), "{label}");
        }
        assert_eq!(figure("SSI1", "---"), None);
    }
}
