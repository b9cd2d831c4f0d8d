//! What the heading of a column states: a wavelength, the wavelength axis, or the name, quantity and unit of a spectrum.

use super::super::{Per, Quantity, SpectralUnit, WavelengthUnit};
use super::number;

/// A heading that is itself a wavelength: `380`, `380nm`, `nm380`, `R_380`, `SPECTRAL_NM380`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WavelengthHeading {
    /// What stands before the number, lower case, without `_` and blanks at its end.
    pub prefix: String,
    pub value: f64,
    pub unit: Option<WavelengthUnit>,
}

/// Reads a heading as a wavelength; `None` where it is none.
pub(super) fn wavelength_heading(text: &str, decimal: char) -> Option<WavelengthHeading> {
    const LONGEST: usize = 40;
    let text = text.trim();
    if text.len() > LONGEST {
        return None;
    }
    let first = text.find(|c: char| c.is_ascii_digit())?;
    let digits = &text[first..];
    let length = digits.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == decimal)).unwrap_or(digits.len());
    // `R_380`: the sign of a negative number is no part of a prefix.
    if text[..first].ends_with(['-', '+', '.']) {
        return None;
    }
    let value = number::parse(&digits[..length], decimal).number()?;
    let prefix = text[..first].trim_end_matches(['_', ' ', '(', '[']).to_lowercase();
    if prefix.contains(|c: char| c.is_ascii_digit() || c == ',' || c == ';') {
        return None;
    }
    let suffix = digits[length..].trim_matches(['_', ' ', '(', ')', '[', ']']);
    let unit = match suffix {
        "" if prefix.ends_with("nm") => Some(WavelengthUnit::Nanometre),
        "" => None,
        // A metre and an ampere are spelt like labels: `R1A`, `x2m`.
        "m" | "a" | "A" => return None,
        suffix => Some(suffix.parse().ok()?),
    };
    Some(WavelengthHeading { prefix, value, unit })
}

/// The unit that a heading states for the wavelength axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum AxisUnit {
    Stated(WavelengthUnit),
    NotStated,
    /// A unit that is no length, such as `cm-1`.
    Unknown(String),
}

/// Reads a heading as that of the wavelength axis: `wavelength`, `Wavelength [nm]`, `lambda/um`, `nm`, `wavelength_nm`.
pub(super) fn axis(text: &str) -> Option<AxisUnit> {
    let text = text.trim().trim_matches('"').trim();
    let plain = text.trim_matches(['[', ']', '(', ')', ' ']);
    // `m` and `A` alone are labels of something else.
    if plain.len() > 1
        && let Ok(unit) = plain.parse()
    {
        return Some(AxisUnit::Stated(unit));
    }
    let lower = text.to_lowercase();
    const WORDS: [&str; 14] = [
        "wavelength",
        "wave length",
        "wavelengths",
        "wellenlänge",
        "wellenlaenge",
        "longueur d'onde",
        "lambda",
        "λ",
        "wl",
        "wlen",
        "wvl",
        "w.length",
        "wave",
        "longitud de onda",
    ];
    if lower.starts_with("wavenumber") || plain.eq_ignore_ascii_case("cm-1") || plain == "1/cm" {
        return Some(AxisUnit::Unknown("cm-1".to_owned()));
    }
    let word = WORDS.iter().filter(|w| lower.starts_with(**w)).max_by_key(|w| w.len())?;
    let rest = &lower[word.len()..];
    if rest.starts_with(|c: char| c.is_alphanumeric()) {
        return None;
    }
    // `Wavelength range` and `Wavelength step (nm)` head no axis: what follows has to be a unit, or stand where one would.
    let marked = rest.trim_start().starts_with(['[', '(', '/', '_', ',']);
    let unit = rest.trim_matches(|c: char| c.is_whitespace() || matches!(c, '[' | ']' | '(' | ')' | '/' | '_' | ','));
    let unit = unit.strip_prefix("in ").unwrap_or(unit);
    match unit {
        "" | "air" | "vacuum" | "vac" => Some(AxisUnit::NotStated),
        unit => match unit.parse() {
            Ok(unit) => Some(AxisUnit::Stated(unit)),
            Err(_) => marked.then(|| AxisUnit::Unknown(unit.to_owned())),
        },
    }
}

/// Whether a heading is that of the standard uncertainties of the column before it: `u(…)`, `u`, `standard_uncertainty …`.
pub(super) fn is_uncertainty(text: &str) -> bool {
    let lower = text.trim().trim_matches('"').to_lowercase();
    lower == "u" || lower.starts_with("u(") || lower.replace([' ', '-'], "_").starts_with("standard_uncertainty")
}

/// What a heading says about the values under it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct ValueHeading {
    pub name: String,
    pub quantity: Option<Quantity>,
    pub unit: Option<SpectralUnit>,
    /// Something in the place of a unit that is none.
    pub not_understood: Option<String>,
}

/// Reads the heading of a value column: `lamp 1`, `spectral irradiance [W/m2/nm]`, `Radiance (W/sr/m2/nm)`, `E / W m-2 nm-1`.
pub(super) fn value(text: &str) -> ValueHeading {
    // Headings of spreadsheets may run over lines.
    let text = &text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut heading = ValueHeading { name: text.to_owned(), quantity: quantity(text), ..ValueHeading::default() };
    if let Some((stem, inside, square)) = bracketed(text) {
        match unit(inside) {
            UnitText::Unit(unit) => heading.unit = Some(unit),
            UnitText::Dimensionless if inside == "1" && !square => return heading,
            UnitText::Dimensionless => heading.quantity = Some(Quantity::Relative),
            // `F40T12 (1)` is a name; `[W/m2/nn]` and `(W/m2/nn)` are units that nobody can read.
            UnitText::Other if square || inside.contains('/') => heading.not_understood = Some(inside.to_owned()),
            UnitText::Other => return heading,
        }
        heading.name = stem.trim().to_owned();
    } else if let Some((stem, tail)) = text.rsplit_once(" / ")
        && let UnitText::Unit(unit) = unit(tail)
    {
        heading.unit = Some(unit);
        heading.name = stem.trim().to_owned();
    } else if let UnitText::Unit(unit) = unit(text)
        && (unit.per == Per::Wavelength || text.contains('/'))
    {
        heading.unit = Some(unit);
    }
    heading
}

/// What stands in the place of a unit.
pub(super) enum UnitText {
    Unit(SpectralUnit),
    /// `a.u.`, `1`, `%`, `relative`, `counts`: stated to have no physical unit.
    Dimensionless,
    Other,
}

/// Reads a unit as files write it, with or without brackets.
pub(super) fn unit(text: &str) -> UnitText {
    let text = text.trim();
    let inner = match bracketed(text) {
        Some((stem, inside, _)) if stem.trim().is_empty() => inside.trim(),
        _ => text,
    };
    const NONE: [&str; 20] = [
        "a.u.",
        "a.u",
        "au",
        "arb. u.",
        "arb. unit",
        "arb. units",
        "arb.",
        "arbitrary",
        "arbitrary units",
        "rel.",
        "rel. units",
        "relative",
        "relative units",
        "normalised",
        "normalized",
        "1",
        "%",
        "counts",
        "count",
        "dimensionless",
    ];
    match inner.parse::<SpectralUnit>() {
        _ if NONE.contains(&inner.to_lowercase().as_str()) => UnitText::Dimensionless,
        Ok(unit) => UnitText::Unit(unit),
        Err(_) => UnitText::Other,
    }
}

/// The text before, and inside of, the bracket that ends a heading; and whether it is square.
fn bracketed(text: &str) -> Option<(&str, &str, bool)> {
    let (open, close) = match text.chars().next_back()? {
        ']' => ('[', ']'),
        ')' => ('(', ')'),
        _ => return None,
    };
    let mut depth = 0;
    for (at, c) in text.char_indices().rev() {
        if c == close {
            depth += 1;
        } else if c == open {
            depth -= 1;
            if depth == 0 {
                return Some((&text[..at], &text[at + 1..text.len() - 1], open == '['));
            }
        }
    }
    None
}

/// The quantity that a text names. `intensity`, `power`, `energy` and `exposure` alone name none: spectrometers print them
/// over counts; with `radiant` before them they do.
pub(super) fn quantity(text: &str) -> Option<Quantity> {
    let lower = text.to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphabetic()).filter(|w| !w.is_empty()).collect();
    let radiant = words.contains(&"radiant");
    words.iter().find_map(|word| match *word {
        "irradiance" => Some(Quantity::Irradiance),
        "radiance" => Some(Quantity::Radiance),
        "exitance" => Some(Quantity::Exitance),
        "flux" => Some(Quantity::Flux),
        "power" if radiant => Some(Quantity::Flux),
        "intensity" if radiant => Some(Quantity::Intensity),
        "energy" if radiant => Some(Quantity::Energy),
        "exposure" if radiant => Some(Quantity::Exposure),
        "relative" | "normalised" | "normalized" | "reflectance" | "transmittance" | "absorbance" | "absorptance"
        | "counts" => Some(Quantity::Relative),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_in_headings() {
        for (text, value, unit) in [
            ("380", 380.0, None),
            ("380.5", 380.5, None),
            ("380nm", 380.0, Some(WavelengthUnit::Nanometre)),
            ("380 [nm]", 380.0, Some(WavelengthUnit::Nanometre)),
            ("nm380", 380.0, Some(WavelengthUnit::Nanometre)),
            ("SPECTRAL_NM380", 380.0, Some(WavelengthUnit::Nanometre)),
            ("SPEC_380", 380.0, None),
            ("R_380", 380.0, None),
            ("0.38um", 0.38, Some(WavelengthUnit::Micrometre)),
        ] {
            let heading = wavelength_heading(text, '.').unwrap_or_else(|| panic!("{text}"));
            assert_eq!((heading.value, heading.unit), (value, unit), "{text}");
        }
        for text in ["", "name", "-380", "R1A", "380,5", "lamp 1 (b)", "F40T12"] {
            assert_eq!(wavelength_heading(text, '.'), None, "{text}");
        }
        assert_eq!(wavelength_heading("380,5", ',').map(|h| h.value), Some(380.5));
    }

    #[test]
    fn the_axis_states_its_unit_or_not() {
        let nm = AxisUnit::Stated(WavelengthUnit::Nanometre);
        let um = AxisUnit::Stated(WavelengthUnit::Micrometre);
        for text in [
            "wavelength_nm",
            "Wavelength [nm]",
            "Wavelength (nm)",
            "nm",
            "λ/nm",
            "lambda / nm",
            "WL nm",
            "Wavelength in nm",
            "[nm]",
        ] {
            assert_eq!(axis(text), Some(nm.clone()), "{text}");
        }
        assert_eq!(axis("wavelength (µm)"), Some(um.clone()));
        assert_eq!(axis("lambda_um"), Some(um));
        assert_eq!(axis("wavelength"), Some(AxisUnit::NotStated));
        assert_eq!(axis("Wavelength [cm-1]"), Some(AxisUnit::Unknown("cm-1".into())));
        assert_eq!(axis("wavenumber (cm-1)"), Some(AxisUnit::Unknown("cm-1".into())));
        for text in ["", "lamp", "wavelet", "m", "A", "values", "waveform", "Wavelength range", "Wavelength step (nm)"]
        {
            assert_eq!(axis(text), None, "{text}");
        }
    }

    #[test]
    fn values_state_quantity_and_unit_or_not() {
        for (text, name, q, u) in [
            ("spectral irradiance [W/m2/nm]", "spectral irradiance", Some(Quantity::Irradiance), Some("W/m2/nm")),
            ("Radiance(W/sr/m2/nm)", "Radiance", Some(Quantity::Radiance), Some("W/sr/m2/nm")),
            ("E (W/(m² nm))", "E", None, Some("W/(m² nm)")),
            ("E / W m-2 nm-1", "E", None, Some("W m-2 nm-1")),
            ("W/m²/nm", "W/m²/nm", None, Some("W/m²/nm")),
            ("F40T12/C50 (1)", "F40T12/C50 (1)", None, None),
            ("lamp W", "lamp W", None, None),
            ("J", "J", None, None),
            ("Intensity (counts)", "Intensity", Some(Quantity::Relative), None),
            ("Intensity", "Intensity", None, None),
            ("SPD [a.u.]", "SPD", Some(Quantity::Relative), None),
        ] {
            let heading = value(text);
            assert_eq!(heading.name, name, "{text}");
            assert_eq!(heading.quantity, q, "{text}");
            assert_eq!(heading.unit.map(|u| u.text), u.map(str::to_owned), "{text}");
            assert_eq!(heading.not_understood, None, "{text}");
        }
        assert_eq!(value("irradiance [W/m2/nn]").not_understood.as_deref(), Some("W/m2/nn"));
    }
}
