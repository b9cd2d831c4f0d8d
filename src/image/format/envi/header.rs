//! The header: `key = value` lines, values in braces over several lines.

use super::number::{ByteOrder, DataType};
use crate::finding::{Checked, Finding, Location};
use crate::image::error::{Error, ErrorKind};
use crate::spectrum::WavelengthUnit;

/// The largest number of columns, rows or bands that is believed.
const LARGEST: usize = 1 << 31;
/// The largest number of bands.
const MOST_BANDS: usize = 1 << 20;

/// Order of the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interleave {
    /// Band after band.
    #[default]
    Bsq,
    /// Row after row, in it band after band.
    Bil,
    /// Pixel after pixel, in it band after band.
    Bip,
}

impl Interleave {
    /// The word in the header.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Bsq => "bsq",
            Self::Bil => "bil",
            Self::Bip => "bip",
        }
    }
}

/// A header as it stands in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Columns.
    pub samples: usize,
    /// Rows.
    pub lines: usize,
    /// Bands.
    pub bands: usize,
    /// Bytes before the first number.
    pub offset: u64,
    /// Type of the numbers.
    pub data_type: DataType,
    /// Their order.
    pub interleave: Interleave,
    /// Order of their bytes.
    pub byte_order: ByteOrder,
    /// Centre wavelengths, in the unit below; empty where not stated.
    pub wavelengths: Vec<f64>,
    /// Unit of the wavelengths; `None` where not stated.
    pub wavelength_unit: Option<WavelengthUnit>,
    /// Wavelengths are wavenumbers, in 1/cm.
    pub wavenumbers: bool,
    /// Full widths at half maximum, in the same unit; empty where not stated.
    pub fwhm: Vec<f64>,
    /// Which bands are good; empty where not stated.
    pub good: Vec<bool>,
    /// Names of the bands; empty where not stated.
    pub band_names: Vec<String>,
    /// Gain and offset of each band; empty where not stated.
    pub gains: Vec<f64>,
    /// See above.
    pub offsets: Vec<f64>,
    /// The gains make reflectances.
    pub reflectance: bool,
    /// The number that means nothing.
    pub ignore: Option<f64>,
    /// Unit of the samples.
    pub data_units: Option<String>,
    /// All other fields, in order.
    pub other: Vec<(String, String)>,
    /// The line of the wavelengths.
    pub(in crate::image::format) wavelength_line: u64,
}

impl Header {
    /// A header that states sizes and type alone: little-endian numbers from the first byte on, band after band.
    pub(in crate::image::format) fn new(samples: usize, lines: usize, bands: usize, data_type: DataType) -> Self {
        Self {
            samples,
            lines,
            bands,
            offset: 0,
            data_type,
            interleave: Interleave::Bsq,
            byte_order: ByteOrder::Little,
            wavelengths: Vec::new(),
            wavelength_unit: None,
            wavenumbers: false,
            fwhm: Vec::new(),
            good: Vec::new(),
            band_names: Vec::new(),
            gains: Vec::new(),
            offsets: Vec::new(),
            reflectance: false,
            ignore: None,
            data_units: None,
            other: Vec::new(),
            wavelength_line: 1,
        }
    }
}

/// Fields that have a place of their own here, as [`key`] spells them.
pub(super) const KNOWN: [&str; 20] = [
    "samples",
    "lines",
    "bands",
    "datatype",
    "interleave",
    "byteorder",
    "headeroffset",
    "wavelength",
    "wavelengthunits",
    "fwhm",
    "bbl",
    "bandnames",
    "datagainvalues",
    "dataoffsetvalues",
    "datareflectancegainvalues",
    "datareflectanceoffsetvalues",
    "reflectancescalefactor",
    "dataignorevalue",
    "dataunits",
    "filetype",
];

/// A field's name without what programs differ in: case, blanks and underscores.
pub(super) fn key(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace() && *c != '_').collect::<String>().to_lowercase()
}

/// One field with its place.
struct Field<'a> {
    key: String,
    name: &'a str,
    value: &'a str,
    line: u64,
}

/// The items between braces, or of a bare value.
fn items(value: &str) -> Vec<&str> {
    let inner = value.strip_prefix('{').map_or(value, |v| v.strip_suffix('}').unwrap_or(v));
    let inner = inner.trim().trim_end_matches(',');
    if inner.is_empty() { Vec::new() } else { inner.split(',').map(str::trim).collect() }
}

/// The fields of a header; the same key twice keeps both.
fn fields(text: &str) -> Result<Vec<Field<'_>>, Error> {
    let mut lines = text.lines().zip(1_u64..);
    match lines.next() {
        Some((first, _)) if first.trim_start_matches('\u{feff}').trim() == "ENVI" => {}
        Some((first, line)) => {
            // An older habit puts the first field behind the word.
            let found = format!("`{}`", first.chars().take(40).collect::<String>());
            let kind = ErrorKind::Unexpected { found, expected: "`ENVI` alone on the first line".to_owned() };
            return Err(Error::new(Location::at(line, 1), kind));
        }
        None => return Err(Error::new(Location::at(1, 1), ErrorKind::Empty)),
    }
    let mut out = Vec::new();
    let mut rest = text.split_inclusive('\n').next().map_or("", |first| &text[first.len()..]);
    let mut line = 2;
    while let Some(row) = rest.split_inclusive('\n').next() {
        let trimmed = row.trim();
        if trimmed.is_empty() || trimmed.starts_with(';') {
            rest = &rest[row.len()..];
            line += 1;
            continue;
        }
        let Some((name, value)) = row.split_once('=') else {
            let found = format!("`{}`", trimmed.chars().take(40).collect::<String>());
            let kind = ErrorKind::Unexpected { found, expected: "a line `field = value`".to_owned() };
            return Err(Error::new(Location::at(line, 1), kind));
        };
        let start = name.len() + 1;
        let (value, length) = if value.trim_start().starts_with('{') {
            let Some(end) = rest[start..].find('}') else {
                let found = format!("`{}` with an opening brace only", name.trim());
                let kind = ErrorKind::Unexpected { found, expected: "a closing brace `}`".to_owned() };
                return Err(Error::new(Location::at(line, 1), kind));
            };
            let end = start + end + 1;
            // What follows the brace on its line is nothing that the format knows.
            let tail = rest[end..].split_inclusive('\n').next().map_or(0, str::len);
            (rest[start..end].trim(), end + tail)
        } else {
            (value.trim(), row.len())
        };
        out.push(Field { key: key(name), name: name.trim(), value, line });
        line += rest[..length].matches('\n').count() as u64;
        rest = &rest[length..];
    }
    Ok(out)
}

/// The value of a field that is one thing of a kind.
fn one<T>(field: &Field<'_>, expected: &str, parse: impl Fn(&str) -> Option<T>) -> Result<T, Error> {
    parse(field.value).ok_or_else(|| {
        let kind = ErrorKind::Value {
            found: format!("`{}`", field.value.chars().take(40).collect::<String>()),
            field: format!("`{}`", field.name),
            expected: expected.to_owned(),
        };
        Error::new(Location::at(field.line, 1), kind)
    })
}

/// The numbers of a list, which must be one for each band.
fn list(field: &Field<'_>, bands: usize) -> Result<Vec<f64>, Error> {
    let items = items(field.value);
    if items.len() != bands {
        let kind = ErrorKind::Count {
            found: items.len(),
            field: format!("`{}`", field.name),
            expected: format!("{bands}, one for each of the `bands`"),
        };
        return Err(Error::new(Location::at(field.line, 1), kind));
    }
    let number = |item: &&str| item.parse::<f64>().ok().filter(|v| v.is_finite());
    items
        .iter()
        .enumerate()
        .map(|(i, item)| {
            number(item).ok_or_else(|| {
                let kind = ErrorKind::Value {
                    found: format!("`{}`", item.chars().take(40).collect::<String>()),
                    field: format!("value {} of `{}`", i + 1, field.name),
                    expected: "a finite number".to_owned(),
                };
                Error::new(Location::at(field.line, 1), kind)
            })
        })
        .collect()
}

/// Reads a header.
///
/// # Errors
/// Where it is none, a required field is missing, or one holds what it cannot; each with its line.
pub fn parse_header(bytes: &[u8]) -> Result<Checked<Header>, Error> {
    // Descriptions may be in any encoding; numbers and keys are ASCII.
    let text = String::from_utf8_lossy(bytes);
    let fields = fields(&text)?;
    let mut findings = Vec::new();
    let find = |key: &str| fields.iter().find(|f| f.key == key);
    let required = |key: &str, field: &str, expected: &str| {
        find(key).ok_or_else(|| {
            let kind = ErrorKind::Missing { field: field.to_owned(), expected: expected.to_owned() };
            Error::new(Location::line(1), kind)
        })
    };
    let size = |key: &str, most: usize, what: &str| -> Result<usize, Error> {
        let expected = format!("a whole number of {what} from 1 to {most}");
        let field = required(key, key, &expected)?;
        one(field, &expected, |v| v.parse().ok().filter(|n| (1..=most).contains(n)))
    };
    let (samples, lines) = (size("samples", LARGEST, "columns")?, size("lines", LARGEST, "rows")?);
    let bands = size("bands", MOST_BANDS, "bands")?;
    let types = "1, 2, 3, 4, 5, 12, 13, 14 or 15 (6 and 9, complex numbers, are no light)";
    let data_type = one(required("datatype", "data type", types)?, types, |v| {
        v.parse().ok().and_then(|code: u32| DataType::ALL.into_iter().find(|t| t.code() == code))
    })?;
    let interleave = match find("interleave") {
        Some(field) => one(field, "bsq, bil or bip", |v| {
            [Interleave::Bsq, Interleave::Bil, Interleave::Bip].into_iter().find(|i| v.eq_ignore_ascii_case(i.word()))
        })?,
        None if bands == 1 => Interleave::Bsq,
        None => {
            findings.push(Finding::warning("I001", "no `interleave` in the header: bsq taken, ENVI's default"));
            Interleave::Bsq
        }
    };
    let byte_order = match find("byteorder") {
        Some(field) => one(field, "0 (little endian) or 1 (big endian)", |v| match v {
            "0" => Some(ByteOrder::Little),
            "1" => Some(ByteOrder::Big),
            _ => None,
        })?,
        None => {
            if data_type.bytes() > 1 {
                findings.push(Finding::warning("I001", "no `byte order` in the header: 0, little endian, taken"));
            }
            ByteOrder::Little
        }
    };
    let offset = match find("headeroffset") {
        Some(field) => one(field, "a number of bytes", |v| v.parse().ok())?,
        None => 0,
    };
    let numbers = |key: &str| find(key).map_or(Ok(Vec::new()), |field| list(field, bands));
    let (wavelength_unit, wavenumbers) = match find("wavelengthunits") {
        Some(field) => wavelength_unit(field)?,
        None => (None, false),
    };
    let reflectance_gains = find("datareflectancegainvalues").is_some();
    let (gain_key, offset_key) = if reflectance_gains {
        ("datareflectancegainvalues", "datareflectanceoffsetvalues")
    } else {
        ("datagainvalues", "dataoffsetvalues")
    };
    let mut gains = numbers(gain_key)?;
    let offsets = numbers(offset_key)?;
    let scale = find("reflectancescalefactor")
        .map(|f| one(f, "a number above 0", |v| v.parse::<f64>().ok().filter(|s| *s > 0.0 && s.is_finite())))
        .transpose()?;
    if let Some(scale) = scale.filter(|_| !reflectance_gains) {
        gains = if gains.is_empty() { vec![1.0 / scale; bands] } else { gains.iter().map(|g| g / scale).collect() };
    }
    let names = find("bandnames").map_or(Vec::new(), |f| items(f.value));
    if !names.is_empty() && names.len() != bands {
        let message = format!("{} `band names` for {bands} bands: not used", names.len());
        findings.push(Finding::warning("I001", message));
    }
    let header = Header {
        samples,
        lines,
        bands,
        offset,
        data_type,
        interleave,
        byte_order,
        wavelengths: numbers("wavelength")?,
        wavelength_unit,
        wavenumbers,
        fwhm: numbers("fwhm")?,
        good: numbers("bbl")?.into_iter().map(|v| v != 0.0).collect(),
        band_names: if names.len() == bands { names.into_iter().map(str::to_owned).collect() } else { Vec::new() },
        gains,
        offsets,
        reflectance: reflectance_gains || scale.is_some(),
        ignore: find("dataignorevalue").map(|f| one(f, "a number", |v| v.parse().ok())).transpose()?,
        data_units: find("dataunits").map(|f| items(f.value).join(", ")),
        other: (fields.iter().filter(|f| !KNOWN.contains(&f.key.as_str())))
            .map(|f| (f.name.to_lowercase(), items(f.value).join(", ")))
            .collect(),
        wavelength_line: find("wavelength").map_or(1, |f| f.line),
    };
    Ok(Checked { value: header, findings })
}

/// A unit of wavelength; `None` for words that mean none, true for wavenumbers in 1/cm.
fn wavelength_unit(field: &Field<'_>) -> Result<(Option<WavelengthUnit>, bool), Error> {
    match field.value.to_lowercase().as_str() {
        "" | "unknown" => Ok((None, false)),
        "wavenumber" => Ok((None, true)),
        _ => {
            let expected = "Nanometers, Micrometers, Angstroms, Meters, Wavenumber or Unknown";
            one(field, expected, |v| v.parse().ok()).map(|unit| (Some(unit), false))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_read_whatever_their_shape() {
        let text = "ENVI\n; a comment\nSamples=3\nlines   = 2\nbands = 2\ndata type = 4\nbyte order = 0\ninterleave = BIL\n\
            wavelength = { 500.0,\n  600.0 }\nwavelength units = Micrometers\nbbl = {1, 0}\ndescription = {\n two\n lines }\n";
        let header = parse_header(text.as_bytes()).expect("a header").value;
        assert_eq!((header.samples, header.lines, header.bands), (3, 2, 2));
        assert_eq!((header.wavelengths, header.wavelength_line), (vec![500.0, 600.0], 9));
        assert_eq!(header.wavelength_unit, Some(WavelengthUnit::Micrometre));
        assert_eq!(header.good, [true, false]);
        assert_eq!(header.other, [("description".to_owned(), "two\n lines".to_owned())]);
    }
}
