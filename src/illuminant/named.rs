//! Sources by name: the CIE's tabulated illuminants, and blackbodies, daylight and lines with their parameter after a colon.

use super::{Error, daylight, planck};
use crate::constants::SecondRadiation;
use crate::spectrum::{Grid, Quantity, Spectrum};
use crate::tables;

/// Embedded tables whose columns are illuminants, in the order in which they are listed and searched.
const ILLUMINANT_TABLES: [&str; 4] = ["cie-illuminants", "cie-illuminant-b", "cie-fl-hp-led", "cie-l41"];

/// Below this peak radiance in the grid, W/(m²·sr·nm), a blackbody is given by its shape alone.
const SMALLEST_RADIANCE: f64 = 1e-280;

/// A source made by name.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The name in its standard spelling.
    pub name: String,
    /// Radiance for blackbodies; relative for everything that is only known up to a factor.
    pub quantity: Quantity,
    /// The spectrum, SI per nm where it has a scale.
    pub spectrum: Spectrum,
}

/// The names of the tabulated illuminants, in table order.
#[must_use]
pub fn names() -> Vec<&'static str> {
    ILLUMINANT_TABLES.iter().filter_map(|t| tables::get(t).ok()).flat_map(illuminant_columns).collect()
}

fn illuminant_columns(table: &'static tables::Table) -> impl Iterator<Item = &'static str> {
    table.columns().iter().map(|c| c.name.as_str()).filter(|name| *name != "wavelength_nm")
}

/// Whether a word can only be meant as a source and not as a file: it is a tabulated name or `kind:parameter`.
#[must_use]
pub fn is_name(word: &str) -> bool {
    let kind = word.split_once(':').map(|(kind, _)| kind.to_lowercase());
    matches!(kind.as_deref(), Some("blackbody" | "planck" | "daylight" | "line" | "laser"))
        || names().iter().any(|n| n.eq_ignore_ascii_case(word))
}

/// The source of a name.
///
/// - `A`, `D65`, `FL11`, `LED-B3` …: a tabulated illuminant, relative, on its table's grid;
/// - `blackbody:2856K`: radiance in W/(m²·sr·nm), 360–830 nm by 1 nm; the shape alone where that is too small for a double;
/// - `daylight:6504K`: relative CIE daylight, 300–830 nm by 5 nm, M₁ and M₂ rounded as CIE 15 prescribes;
/// - `line:555nm`: a line of no width, relative.
///
/// Names are matched without regard to case.
///
/// # Errors
/// [`Error::Unknown`] and the errors of the formula asked for.
pub fn source(name: &str, c2: SecondRadiation) -> Result<Source, Error> {
    if let Some((kind, parameter)) = name.split_once(':') {
        match kind.to_lowercase().as_str() {
            "blackbody" | "planck" => return blackbody(kelvin(parameter)?, c2),
            "daylight" => {
                let kelvin = kelvin(parameter)?;
                let grid = Grid::uniform(300.0, 5.0, 107)?;
                let spectrum = daylight::spectrum(grid, kelvin, daylight::Coefficients::Rounded)?;
                return Ok(Source { name: format!("daylight {kelvin} K"), quantity: Quantity::Relative, spectrum });
            }
            "line" | "laser" => return line(parameter),
            _ => {}
        }
    }
    for table in ILLUMINANT_TABLES.iter().filter_map(|t| tables::get(t).ok()) {
        if let Some(column) = illuminant_columns(table).find(|c| c.eq_ignore_ascii_case(name)) {
            let values = table.column(column).unwrap_or_default();
            let spectrum = Spectrum::density(Grid::new(table.wavelengths_nm().to_vec())?, values.to_vec())?;
            return Ok(Source { name: column.to_owned(), quantity: Quantity::Relative, spectrum });
        }
    }
    Err(Error::Unknown { name: name.to_owned(), known: names().join(", ") })
}

fn kelvin(text: &str) -> Result<f64, Error> {
    let number = text.trim().trim_end_matches(['K', 'k']).trim_end();
    number
        .parse()
        .ok()
        .filter(|k: &f64| k.is_finite() && *k > 0.0)
        .ok_or_else(|| Error::Temperature { found: text.to_owned() })
}

fn blackbody(kelvin: f64, c2: SecondRadiation) -> Result<Source, Error> {
    let name = format!("blackbody {kelvin} K");
    let grid = std::sync::Arc::new(Grid::uniform(360.0, 1.0, 471)?);
    let spectrum = planck::spectrum(std::sync::Arc::clone(&grid), kelvin, c2)?;
    if spectrum.peak().1 >= SMALLEST_RADIANCE {
        return Ok(Source { name, quantity: Quantity::Radiance, spectrum });
    }
    Ok(Source { name, quantity: Quantity::Relative, spectrum: planck::relative(grid, kelvin, c2)? })
}

fn line(text: &str) -> Result<Source, Error> {
    let wavelength = text
        .trim()
        .trim_end_matches("nm")
        .trim_end()
        .parse()
        .ok()
        .filter(|w: &f64| w.is_finite() && *w > 0.0)
        .ok_or_else(|| Error::Line { found: text.to_owned() })?;
    Ok(Source {
        name: format!("line {wavelength} nm"),
        quantity: Quantity::Relative,
        spectrum: Spectrum::lines(Grid::new(vec![wavelength])?, vec![1.0])?,
    })
}
