//! Channel names of the spectral layout.

use crate::constants::SPEED_OF_LIGHT;

/// What the name of a spectral channel says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Name {
    /// Stokes component 0 to 3 of light, at a wavelength in nm.
    Light(u8, f64),
    /// Reflectance or transmittance at a wavelength in nm.
    Reflectance(f64),
    /// Re-radiation: from one wavelength (nm) to another.
    Reradiation(f64, f64),
}

/// Reads a channel name: `S0.550,0nm`, `T.0,55um`, `S0.5E14Hz`, `T.400nm.500nm`; `None` where it is none of the layout.
///
/// Wavelengths of frequencies are those in vacuum, c/ν.
#[must_use]
pub fn parse_name(name: &str) -> Option<Name> {
    let (component, rest) = name.split_once('.')?;
    let (first, second) = wavelengths(rest)?;
    match (component, second) {
        ("T", None) => Some(Name::Reflectance(first)),
        ("T", Some(second)) => Some(Name::Reradiation(first, second)),
        ("S0" | "S1" | "S2" | "S3", None) => Some(Name::Light(component.as_bytes()[1] - b'0', first)),
        _ => None,
    }
}

/// One wavelength, or two joined by a full stop. A full stop in place of the decimal comma is understood, too.
fn wavelengths(text: &str) -> Option<(f64, Option<f64>)> {
    if let Some(one) = wavelength_nm(text) {
        return Some((one, None));
    }
    text.match_indices('.').find_map(|(at, _)| {
        let (first, second) = (wavelength_nm(&text[..at])?, wavelength_nm(&text[at + 1..])?);
        Some((first, Some(second)))
    })
}

/// A number with a decimal comma, an SI prefix, and `m` or `Hz`.
fn wavelength_nm(text: &str) -> Option<f64> {
    let (text, frequency) = match text.strip_suffix("Hz") {
        Some(text) => (text, true),
        None => (text.strip_suffix('m')?, false),
    };
    let (digits, prefix) = text.split_at(text.trim_end_matches(|c: char| c.is_ascii_alphabetic()).len());
    let exponent = match prefix {
        "" => 0,
        "Y" => 24,
        "Z" => 21,
        "E" => 18,
        "P" => 15,
        "T" => 12,
        "G" => 9,
        "M" => 6,
        "k" => 3,
        "h" => 2,
        "da" => 1,
        "d" => -1,
        "c" => -2,
        "m" => -3,
        "u" => -6,
        "n" => -9,
        "p" => -12,
        "f" => -15,
        "a" => -18,
        "z" => -21,
        "y" => -24,
        _ => return None,
    };
    if !digits.starts_with(|c: char| c.is_ascii_digit() || c == ',' || c == '.') {
        return None;
    }
    let number: f64 = digits.replace(',', ".").parse().ok()?;
    let nanometres = match (frequency, exponent) {
        (false, -9) => number,
        (false, _) => number * f64::powi(10.0, exponent + 9),
        (true, _) => SPEED_OF_LIGHT / (number * f64::powi(10.0, exponent)) * 1e9,
    };
    (nanometres > 0.0 && nanometres.is_finite()).then_some(nanometres)
}

/// The name of a channel: shortest decimal digits that give the wavelength back, with a comma.
#[must_use]
pub fn channel_name(name: Name) -> String {
    let comma = |nanometres: f64| format!("{nanometres:?}").replace('.', ",");
    match name {
        Name::Light(component, nm) => format!("S{component}.{}nm", comma(nm)),
        Name::Reflectance(nm) => format!("T.{}nm", comma(nm)),
        Name::Reradiation(from, to) => format!("T.{}nm.{}nm", comma(from), comma(to)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_the_layout_has_them() {
        for (text, name) in [
            ("S0.550nm", Name::Light(0, 550.0)),
            ("S3.560,000000nm", Name::Light(3, 560.0)),
            ("T.400,0nm", Name::Reflectance(400.0)),
            ("T.0,4um", Name::Reflectance(400.0)),
            ("S0.5,5E-7m", Name::Light(0, 550.0)),
            ("S0.550.5nm", Name::Light(0, 550.5)),
            ("T.400,0nm.500,0nm", Name::Reradiation(400.0, 500.0)),
        ] {
            let got = parse_name(text).unwrap_or_else(|| panic!("{text}"));
            let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
            let same = match (got, name) {
                (Name::Light(a, x), Name::Light(b, y)) => a == b && close(x, y),
                (Name::Reflectance(x), Name::Reflectance(y)) => close(x, y),
                (Name::Reradiation(a, b), Name::Reradiation(x, y)) => close(a, x) && close(b, y),
                _ => false,
            };
            assert!(same, "{text}: {got:?}");
        }
        // c / 545.077 THz = 550.0 nm (299 792 458 / 545.077 196 364e12).
        let Some(Name::Light(0, nm)) = parse_name("S0.545,077196364THz") else { panic!("a frequency") };
        assert!((nm - 550.0).abs() < 1e-6, "{nm}");
        for text in [
            "R",
            "S0",
            "S4.550nm",
            "S0.nm",
            "S0.-5nm",
            "S0.infnm",
            "S0.0nm",
            "S0.550",
            "T.550lm",
            "S0.1e999nm",
            "T..",
            "S0.550nm.600nm",
        ] {
            assert_eq!(parse_name(text), None, "{text}");
        }
    }

    #[test]
    fn names_come_back() {
        for name in
            [Name::Light(0, 380.0), Name::Light(2, 555.016), Name::Reflectance(0.1), Name::Reradiation(1e3, 2e3)]
        {
            assert_eq!(parse_name(&channel_name(name)), Some(name));
        }
    }
}
