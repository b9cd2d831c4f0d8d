//! Which radiometric quantity a spectrum is of, and the unit its samples are in.
//!
//! A unit is parsed by its dimensions, never guessed from the size of the numbers: `mW/(m²·nm)`, `W m-2 nm-1`,
//! `µW/cm^2/nm`, `W/m2/sr/um` and `µmol/s/m2/nm` are all understood; `W/m2` without a wavelength in it is what it says,
//! power per band.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use crate::constants::{AVOGADRO, PLANCK, SPEED_OF_LIGHT};

/// The quantity of which a spectrum is the distribution over wavelength (CIE S 017 / ISO 80000-7 names).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Radiant flux, W (luminous: lm).
    Flux,
    /// Radiant intensity, W/sr (luminous: cd).
    Intensity,
    /// Irradiance, W/m² arriving (luminous: lx).
    Irradiance,
    /// Radiance, W/(m²·sr) (luminous: cd/m² = nit).
    Radiance,
    /// Radiant exitance, W/m² leaving (luminous: lm/m²).
    Exitance,
    /// Radiant energy, J (luminous: lm·s).
    Energy,
    /// Radiant exposure, J/m² (luminous: lx·s).
    Exposure,
    /// Unknown scale: only ratios mean anything.
    Relative,
}

impl Quantity {
    /// All absolute quantities, in the order reports use.
    pub const ABSOLUTE: [Self; 7] =
        [Self::Flux, Self::Intensity, Self::Irradiance, Self::Radiance, Self::Exitance, Self::Energy, Self::Exposure];

    /// The lower-case word used on the command line and in JSON.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Flux => "flux",
            Self::Intensity => "intensity",
            Self::Irradiance => "irradiance",
            Self::Radiance => "radiance",
            Self::Exitance => "exitance",
            Self::Energy => "energy",
            Self::Exposure => "exposure",
            Self::Relative => "relative",
        }
    }

    /// SI unit of the integrated radiometric quantity; empty for relative spectra.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Flux => "W",
            Self::Intensity => "W/sr",
            Self::Irradiance | Self::Exitance => "W/m²",
            Self::Radiance => "W/(m²·sr)",
            Self::Energy => "J",
            Self::Exposure => "J/m²",
            Self::Relative => "",
        }
    }

    /// SI unit of the integrated photometric quantity; empty for relative spectra.
    #[must_use]
    pub fn luminous_unit(self) -> &'static str {
        match self {
            Self::Flux => "lm",
            Self::Intensity => "cd",
            Self::Irradiance => "lx",
            Self::Radiance => "cd/m²",
            Self::Exitance => "lm/m²",
            Self::Energy => "lm·s",
            Self::Exposure => "lx·s",
            Self::Relative => "",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// Why a quantity or a unit was not understood.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UnitError {
    /// Not one of the quantities.
    #[error(
        "unknown quantity `{found}`; expected flux, intensity, irradiance, radiance, exitance, energy, exposure or relative"
    )]
    Quantity {
        /// The word met.
        found: String,
    },
    /// A symbol in the unit is not known.
    #[error(
        "unknown symbol `{symbol}` in the unit `{found}`; expected one like W/m2/nm, mW/(m²·sr·nm), µW/cm2/nm, W/sr/um or umol/s/m2/nm"
    )]
    Symbol {
        /// The whole unit.
        found: String,
        /// The part that is not known.
        symbol: String,
    },
    /// The dimensions are not those of a radiometric quantity.
    #[error(
        "the unit `{found}` is not one of radiant flux, intensity, irradiance, radiance, energy or exposure (per wavelength or per band)"
    )]
    Dimension {
        /// The whole unit.
        found: String,
    },
    /// The unit belongs to another quantity.
    #[error("the unit `{unit}` is one of {of}; expected a unit of {asked}")]
    Mismatch {
        /// The unit given.
        unit: String,
        /// The quantity that the unit belongs to.
        of: Quantity,
        /// The quantity asked for.
        asked: Quantity,
    },
    /// A wavelength unit is not known.
    #[error("unknown wavelength unit `{found}`; expected nm, um, m or angstrom")]
    Wavelength {
        /// The word met.
        found: String,
    },
}

impl FromStr for Quantity {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let word = text.trim().to_lowercase().replace(['-', '_'], " ");
        let word = word.trim_start_matches("spectral ").trim_start_matches("radiant ");
        Ok(match word {
            "flux" | "power" => Self::Flux,
            "intensity" => Self::Intensity,
            "irradiance" => Self::Irradiance,
            "radiance" => Self::Radiance,
            "exitance" | "radiosity" | "emittance" => Self::Exitance,
            "energy" => Self::Energy,
            "exposure" => Self::Exposure,
            "relative" => Self::Relative,
            _ => return Err(UnitError::Quantity { found: text.trim().to_owned() }),
        })
    }
}

/// The unit of a wavelength axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Default)]
#[serde(rename_all = "lowercase")]
pub enum WavelengthUnit {
    /// Nanometre.
    #[default]
    Nanometre,
    /// Micrometre.
    Micrometre,
    /// Metre.
    Metre,
    /// Ångström, 0.1 nm.
    Angstrom,
}

impl WavelengthUnit {
    /// The wavelength in nanometres. Scaling by a power of ten is a division where that is the exact one, so that
    /// 0.555 µm becomes 555 nm to the last bit that decimal input allows.
    #[must_use]
    pub fn to_nm(self, wavelength: f64) -> f64 {
        match self {
            Self::Nanometre => wavelength,
            Self::Micrometre => wavelength * 1e3,
            Self::Metre => wavelength * 1e9,
            Self::Angstrom => wavelength / 10.0,
        }
    }

    /// The symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Nanometre => "nm",
            Self::Micrometre => "µm",
            Self::Metre => "m",
            Self::Angstrom => "Å",
        }
    }
}

impl FromStr for WavelengthUnit {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let word = text.trim().trim_end_matches('.').to_lowercase().replace('\u{3bc}', "µ");
        Ok(match word.as_str() {
            "nm" | "nanometer" | "nanometers" | "nanometre" | "nanometres" => Self::Nanometre,
            "um" | "µm" | "micron" | "microns" | "micrometer" | "micrometers" | "micrometre" | "micrometres" => {
                Self::Micrometre
            }
            "m" | "meter" | "metre" | "meters" | "metres" => Self::Metre,
            "å" | "a" | "\u{212b}" | "angstrom" | "angstroms" | "ångström" | "ångstrom" => Self::Angstrom,
            _ => return Err(UnitError::Wavelength { found: text.trim().to_owned() }),
        })
    }
}

/// What a sample is per: an interval of wavelength, or its whole band.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Per {
    /// A density over wavelength; [`SpectralUnit::factor`] brings it to per nanometre.
    Wavelength,
    /// The power in the sample's own band (line lists, `W/m2` without a wavelength).
    Band,
}

/// A unit of spectral samples, reduced to what is needed to bring a sample to SI per nanometre.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralUnit {
    /// Multiply a sample by this for W or J, m², sr, per nm (or per band); for photon units, for photons instead of W or J.
    pub factor: f64,
    /// Samples count photons; [`SpectralUnit::to_si`] turns them into energy with hc/λ.
    pub photons: bool,
    /// The quantity that the dimensions are of. `W/m2` is taken as irradiance; exitance has the same dimensions and
    /// has to be asked for by name.
    pub quantity: Quantity,
    /// Density or band.
    pub per: Per,
    /// The unit as the user or the file wrote it.
    pub text: String,
}

impl SpectralUnit {
    /// The sample at a wavelength (nm) in W or J, per m², sr and nm (or band) as the quantity asks.
    #[must_use]
    pub fn to_si(&self, wavelength_nm: f64, sample: f64) -> f64 {
        let scaled = sample * self.factor;
        if self.photons { scaled * (PLANCK * SPEED_OF_LIGHT / (wavelength_nm * 1e-9)) } else { scaled }
    }

    /// This unit read as one of `quantity`, where the dimensions allow it (irradiance and exitance share theirs).
    ///
    /// # Errors
    /// [`UnitError::Mismatch`] where the dimensions differ.
    pub fn as_quantity(mut self, quantity: Quantity) -> Result<Self, UnitError> {
        let alike =
            self.quantity == quantity || (self.quantity == Quantity::Irradiance && quantity == Quantity::Exitance);
        if !alike {
            return Err(UnitError::Mismatch { unit: self.text, of: self.quantity, asked: quantity });
        }
        self.quantity = quantity;
        Ok(self)
    }
}

/// Exponents of the base units met while reading a unit.
#[derive(Default)]
struct Dimensions {
    factor: f64,
    watt: i32,
    joule: i32,
    photon: i32,
    second: i32,
    metre: i32,
    steradian: i32,
    spectral: i32,
    band: i32,
    /// A length stands in the numerator, as in `W/m2/cm-1`: a density over wavenumber, which is none over wavelength.
    wavenumber: bool,
}

impl FromStr for SpectralUnit {
    type Err = UnitError;

    /// Reads a unit such as `W/m2/nm`, `mW·m⁻²·sr⁻¹·nm⁻¹`, `uW/(cm^2 nm)`, `W/m3`, `J/m2/nm`, `umol/m2/s/nm`, `W/m2/band`.
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let trimmed = text.trim();
        let unknown = |symbol: &str| UnitError::Symbol { found: trimmed.to_owned(), symbol: symbol.to_owned() };
        let dimension = || UnitError::Dimension { found: trimmed.to_owned() };
        let plain = plain_text(trimmed);
        let mut d = Dimensions { factor: 1.0, ..Dimensions::default() };
        // After a solidus everything up to the next one, or the whole bracket, is in the denominator; `W/m2 nm` is read
        // as `W/(m2 nm)`, the only reading under which it is a spectral irradiance.
        let mut sign = 1;
        let mut rest = plain.as_str();
        let mut any = false;
        while !rest.is_empty() {
            if let Some(after) = rest.strip_prefix('/') {
                sign = -1;
                rest = after;
            } else if let Some(after) = rest.strip_prefix(['(', ')', '[', ']', ' ', '.', '*']) {
                rest = after;
            } else {
                let (token, after) = split_token(rest);
                let (symbol, exponent) = split_exponent(token).ok_or_else(|| unknown(token))?;
                if symbol.is_empty() {
                    // A bare number scales the unit: `W/m2/5nm` is per 5 nm.
                    let number: f64 = token.parse().map_err(|_| unknown(token))?;
                    if number <= 0.0 {
                        return Err(dimension());
                    }
                    d.factor *= number.powi(sign);
                } else {
                    d.add(symbol, exponent, sign).ok_or_else(|| unknown(symbol))?;
                }
                any = true;
                rest = after;
            }
        }
        if !any {
            return Err(dimension());
        }
        d.finish(trimmed).ok_or_else(dimension)
    }
}

/// ASCII exponents and separators, `µ` and `u` as one, names of compound tokens spelt as symbols.
fn plain_text(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '⁻' | '−' | '–' => out.push('-'),
            '¹' => out.push('1'),
            '²' => out.push('2'),
            '³' => out.push('3'),
            '⁴' => out.push('4'),
            '·' | '×' | '⋅' | '\u{a0}' | '_' | '\t' => out.push(' '),
            'µ' | 'μ' => out.push('u'),
            '^' => {}
            c => out.push(c),
        }
    }
    out
}

/// The next run that is one unit with its exponent (`cm2`, `nm-1`, `W`), and what follows.
fn split_token(rest: &str) -> (&str, &str) {
    let bytes = rest.as_bytes();
    let mut end = 0;
    let mut digits = false;
    while end < bytes.len() {
        let c = bytes[end];
        let stop = matches!(c, b'/' | b'(' | b')' | b'[' | b']' | b' ' | b'*')
            || (c == b'.' && !(digits && bytes.get(end + 1).is_some_and(u8::is_ascii_digit)));
        // `Wm-2nm-1`: a letter after the digits of an exponent begins the next unit; `5nm`: so does one after a number.
        if stop || (digits && !c.is_ascii_digit() && c != b'.') {
            break;
        }
        digits |= c.is_ascii_digit();
        end += 1;
    }
    let end = if end == 0 { rest.chars().next().map_or(0, char::len_utf8) } else { end };
    rest.split_at(end)
}

/// `nm-1` → (`nm`, −1); `m2` → (`m`, 2); `W` → (`W`, 1); a bare number has an empty symbol. `None` where the exponent is no
/// number that a unit could have.
fn split_exponent(token: &str) -> Option<(&str, i32)> {
    const LARGEST: i32 = 9;
    let start = token.find(|c: char| c.is_ascii_digit() || c == '-').unwrap_or(token.len());
    let (symbol, digits) = token.split_at(start);
    if symbol.is_empty() || digits.is_empty() {
        return Some((symbol, 1));
    }
    digits.parse().ok().filter(|e| (-LARGEST..=LARGEST).contains(e)).map(|exponent| (symbol, exponent))
}

impl Dimensions {
    /// Adds one unit symbol with its exponent as written, and the sign of the side of the solidus; `None` where the symbol is unknown.
    fn add(&mut self, symbol: &str, written: i32, sign: i32) -> Option<()> {
        let exponent = written * sign;
        // A wavelength, where a length is not metric area: the only use of these in a spectral unit.
        let spectral = match symbol {
            "nm" => Some(1.0),
            "um" | "micron" => Some(1e3),
            "Å" | "\u{212b}" | "A" | "angstrom" | "Angstrom" => Some(0.1),
            _ => None,
        };
        if let Some(nanometres) = spectral {
            self.spectral += exponent;
            self.factor *= f64::powi(nanometres, exponent);
            return Some(());
        }
        let Some((scale, base)) = prefixed(symbol) else {
            // `Wm-2`: two symbols written together, of which the exponent belongs to the second.
            let (first, second) = (1..symbol.len())
                .filter_map(|at| symbol.split_at_checked(at))
                .find(|(first, second)| prefixed(first).is_some() && prefixed(second).is_some())?;
            self.add(first, 1, sign)?;
            return self.add(second, written, sign);
        };
        self.factor *= f64::powi(scale, exponent);
        match base {
            "W" => self.watt += exponent,
            "J" => self.joule += exponent,
            "photon" => self.photon += exponent,
            "mol" => {
                self.photon += exponent;
                self.factor *= AVOGADRO.powi(exponent);
            }
            "s" => self.second += exponent,
            "m" => {
                self.metre += exponent;
                self.wavenumber |= exponent > 0;
            }
            "sr" => self.steradian += exponent,
            _ => self.band += exponent,
        }
        Some(())
    }

    /// The quantity that the exponents stand for; `None` where they stand for none.
    fn finish(mut self, text: &str) -> Option<SpectralUnit> {
        // Bare numbers may have driven the factor out of range.
        if self.wavenumber || !self.factor.is_normal() {
            return None;
        }
        // W/m³ and W/m are per metre of wavelength.
        if self.metre == -3 || self.metre == -1 {
            self.metre += 1;
            self.spectral -= 1;
            self.factor *= 1e-9;
        }
        // W·s is J; J/s is W; photons per second are a power.
        let (power, photons) = match (self.watt, self.joule, self.photon, self.second) {
            (1, 0, 0, 0) | (0, 1, 0, -1) => (true, false),
            (1, 0, 0, 1) | (0, 1, 0, 0) => (false, false),
            (0, 0, 1, -1) => (true, true),
            (0, 0, 1, 0) => (false, true),
            _ => return None,
        };
        let per = match (self.spectral, self.band) {
            (-1, 0) => Per::Wavelength,
            (0, 0 | -1) => Per::Band,
            _ => return None,
        };
        let quantity = match (power, self.metre, self.steradian) {
            (true, 0, 0) => Quantity::Flux,
            (true, 0, -1) => Quantity::Intensity,
            (true, -2, 0) => Quantity::Irradiance,
            (true, -2, -1) => Quantity::Radiance,
            (false, 0, 0) => Quantity::Energy,
            (false, -2, 0) => Quantity::Exposure,
            _ => return None,
        };
        Some(SpectralUnit { factor: self.factor, photons, quantity, per, text: text.to_owned() })
    }
}

/// SI prefix and base of a symbol: `mW` → (1e-3, `W`).
fn prefixed(symbol: &str) -> Option<(f64, &'static str)> {
    const BASES: [(&str, &str); 21] = [
        ("W", "W"),
        ("watt", "W"),
        ("watts", "W"),
        ("Watt", "W"),
        ("Watts", "W"),
        ("J", "J"),
        ("joule", "J"),
        ("s", "s"),
        ("sec", "s"),
        ("m", "m"),
        ("sr", "sr"),
        ("Sr", "sr"),
        ("ster", "sr"),
        ("mol", "mol"),
        ("photon", "photon"),
        ("photons", "photon"),
        ("ph", "photon"),
        ("quanta", "photon"),
        ("band", "band"),
        ("line", "band"),
        ("bin", "band"),
    ];
    const PREFIXES: [(&str, f64); 8] =
        [("", 1.0), ("m", 1e-3), ("u", 1e-6), ("n", 1e-9), ("p", 1e-12), ("k", 1e3), ("M", 1e6), ("c", 1e-2)];
    PREFIXES.iter().find_map(|&(prefix, scale)| {
        let rest = symbol.strip_prefix(prefix)?;
        BASES.iter().find(|(name, _)| *name == rest).map(|&(_, base)| (scale, base))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> SpectralUnit {
        text.parse().unwrap_or_else(|e| panic!("{text}: {e}"))
    }

    #[test]
    fn every_spelling_of_a_spectral_irradiance_is_the_same_unit() {
        for text in
            ["W/m2/nm", "W/(m²·nm)", "W m-2 nm-1", "W·m⁻²·nm⁻¹", "Wm-2nm-1", "W/m^2/nm", "W/m2 nm", "W.m-2.nm-1"]
        {
            let u = unit(text);
            assert_eq!((u.quantity, u.per, u.factor), (Quantity::Irradiance, Per::Wavelength, 1.0), "{text}");
        }
    }

    #[test]
    fn prefixes_and_lengths_scale() {
        // Expected factors are the SI prefixes written out.
        for (text, factor, quantity) in [
            ("mW/m2/nm", 1e-3, Quantity::Irradiance),
            ("µW/cm2/nm", 1e-2, Quantity::Irradiance),
            ("uW/cm^2/nm", 1e-2, Quantity::Irradiance),
            ("W/m2/um", 1e-3, Quantity::Irradiance),
            ("W/m3", 1e-9, Quantity::Irradiance),
            ("W/m2/m", 1e-9, Quantity::Irradiance),
            ("W/m2/5nm", 0.2, Quantity::Irradiance),
            ("mW/(m2 sr nm)", 1e-3, Quantity::Radiance),
            ("W/sr/m3", 1e-9, Quantity::Radiance),
            ("W/sr/nm", 1.0, Quantity::Intensity),
            ("mW/nm", 1e-3, Quantity::Flux),
            ("W/Å", 10.0, Quantity::Flux),
            ("J/m2/nm", 1.0, Quantity::Exposure),
            ("W s/nm", 1.0, Quantity::Energy),
        ] {
            let u = unit(text);
            assert!((u.factor / factor - 1.0).abs() < 1e-14, "{text}: {} for {factor}", u.factor);
            assert_eq!(u.quantity, quantity, "{text}");
            assert_eq!(u.per, Per::Wavelength, "{text}");
        }
    }

    #[test]
    fn without_a_wavelength_a_unit_is_per_band() {
        for text in ["W/m2", "W/m2/band", "mW/cm²"] {
            assert_eq!(unit(text).per, Per::Band, "{text}");
        }
    }

    #[test]
    fn photons_become_joules() {
        let u = unit("umol/m2/s/nm");
        assert!(u.photons);
        // A mole of photons of 555 nm carries N_A·h·c/λ = 215 543 … J (CODATA: N_A·h·c = 0.119 626 565 638 697 J·m/mol, exact SI).
        let joule = u.to_si(555.0, 1.0);
        assert!((joule / (0.119_626_565_638_697e-6 / 555e-9) - 1.0).abs() < 1e-12, "{joule}");
    }

    #[test]
    fn nonsense_is_refused() {
        for text in [
            "",
            "lux",
            "W/m4",
            "m2",
            "W/W",
            "kg",
            "W/m2/nm/nm",
            "0W",
            "/",
            "W/m2/cm-1",
            "W/(m2 cm-1)",
            "W/m99999999999",
        ] {
            assert!(text.parse::<SpectralUnit>().is_err(), "{text}");
        }
        assert!(format!("W/m-2147483648/{}nm", "9".repeat(400)).parse::<SpectralUnit>().is_err());
        assert!(unit("W/m2/nm").as_quantity(Quantity::Radiance).is_err());
        assert!(unit("W/m2/nm").as_quantity(Quantity::Exitance).is_ok());
    }
}
