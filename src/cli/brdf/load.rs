//! Materials from the command line: descriptions, files that hold one, and measured tables.

use std::fs;
use std::io::{self, Read};
use std::path::Path;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use sha2::{Digest, Sha256};

use crate::brdf::Brdf;
use crate::brdf::description::{Bands, Error, Material, toml};
use crate::brdf::format::{self, File, Format};
use crate::brdf::table::{Channel, Resolution, Table};
use crate::finding::{Checked, Finding};
use crate::report::envelope::Input;

/// Where the materials come from and on which bands they are wanted.
#[derive(Debug, Args)]
pub(super) struct MaterialArgs {
    /// Materials: a description such as 'ggx(alpha=0.1, medium=Au)', a TOML file, a measured table, or `-`.
    ///
    /// Models: lambert, oren-nayar, mirror, dielectric, conductor, phong, blinn-phong, ward, ashikhmin-shirley, ggx,
    /// beckmann, blinn, abc, sgd; `0.3*MODEL(…) + MODEL(…)` is a sum. A wrong parameter is answered with the model's list of
    /// them, and `brdf info` prints it. Tables: MERL, RGL, UTIA, ASTM E1392, Zemax, Klems XML, ALTA, CSV, told apart by their
    /// content.
    #[arg(required = true, value_name = "MATERIAL")]
    pub materials: Vec<String>,
    #[command(flatten)]
    pub bands: BandArgs,
}

/// The bands of a material, and the format of its file.
#[derive(Debug, Default, Args)]
pub(super) struct BandArgs {
    /// Wavelengths in nm: a list `450,550`, a range `400:700:50`, or both. A table of wavelengths is read linearly between its
    /// own; materials given per channel keep their channels.
    #[arg(short, long, value_name = "NM")]
    pub wavelength: Option<Numbers>,
    /// Channels of a table, by name and in this order: `R,G,B`, `550 nm`.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', conflicts_with = "wavelength")]
    pub channels: Option<Vec<String>>,
    /// The format of table files, where their content does not say it.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<FormatName>,
}

/// Formats by the names of the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum FormatName {
    /// MERL `.binary`.
    Merl,
    /// RGL `.bsdf` tensor file.
    Rgl,
    /// UTIA `.bin`.
    Utia,
    /// ASTM E1392, E2387.
    Astm,
    /// Zemax `.bsdf`.
    Zemax,
    /// WINDOW and Radiance XML.
    Klems,
    /// ALTA, text or binary.
    Alta,
    /// CSV of points.
    Csv,
}

impl From<FormatName> for Format {
    fn from(name: FormatName) -> Self {
        match name {
            FormatName::Merl => Self::Merl,
            FormatName::Rgl => Self::Rgl,
            FormatName::Utia => Self::Utia,
            FormatName::Astm => Self::Astm,
            FormatName::Zemax => Self::Zemax,
            FormatName::Klems => Self::Klems,
            FormatName::Alta => Self::Alta,
            FormatName::Csv => Self::Csv,
        }
    }
}

/// A list of numbers: `0,30,60` or `0:80:10`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Numbers(pub Vec<f64>);

/// Most numbers that a range may have.
const MOST: f64 = 100_000.0;

impl FromStr for Numbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |s: &str| {
            let parsed = s.trim().parse::<f64>().ok().filter(|v| v.is_finite());
            parsed.ok_or_else(|| format!("found `{s}`; expected a number, a list `0,30,60` or a range `0:80:10`"))
        };
        let mut out = Vec::new();
        for item in text.split(',') {
            match item.split(':').collect::<Vec<_>>()[..] {
                [one] => out.push(number(one)?),
                [low, high, step] => {
                    let (low, high, step) = (number(low)?, number(high)?, number(step)?);
                    let steps = ((high - low) / step + 1e-9).floor();
                    if !(0.0..MOST).contains(&steps) {
                        return Err(format!("found `{item}`; expected a range from low to high by a step above 0"));
                    }
                    let mut i = 0.0;
                    while i <= steps {
                        out.push(low + i * step);
                        i += 1.0;
                    }
                }
                _ => return Err(format!("found `{item}`; expected a range `low:high:step`")),
            }
        }
        Ok(Self(out))
    }
}

/// Numbers of bins as a user writes them: `90x90x180`.
#[derive(Debug, Clone, Copy)]
pub(in crate::cli) struct Bins(pub Resolution);

impl FromStr for Bins {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<usize>> = text.split(['x', '×', ',']).map(|n| n.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[theta_h @ 1..=180, theta_d @ 1..=180, phi_d @ 1..=360]) => {
                Ok(Self(Resolution { theta_h, theta_d, phi_d }))
            }
            _ => Err(format!("found `{text}`; expected bins in θh, θd and φd such as 90x90x180, at most 180x180x360")),
        }
    }
}

/// What an argument stands for.
#[derive(Debug, Clone)]
pub(super) enum Subject {
    /// A material in words.
    Described(Material),
    /// A measured table.
    Measured(Box<File>),
}

/// A material read.
pub(super) struct Loaded {
    /// What to call it: the file and the name in it, or the description.
    pub name: String,
    pub input: Input,
    /// The material, and what its reader noticed.
    pub subject: Result<Checked<Subject>, String>,
}

pub(super) fn load(argument: &str, format: Option<Format>) -> Loaded {
    let mut input = Input { path: argument.to_owned(), sha256: None };
    let is_file = argument == "-" || Path::new(argument).exists();
    if !is_file {
        let subject = if argument.contains('(') {
            let material = argument.parse::<Material>().map_err(|e| format!("{argument}: {e}"));
            material.map(|m| Checked { value: Subject::Described(m), findings: Vec::new() })
        } else {
            let hint = "expected a file, or a description such as 'lambert(reflectance=0.5)'";
            Err(format!("{argument}: there is no such file; {hint}"))
        };
        return Loaded { name: argument.to_owned(), input, subject };
    }
    let bytes = if argument == "-" {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(argument)
    };
    let mut name = argument.to_owned();
    let subject = match bytes {
        Err(error) => Err(format!("{argument}: cannot be read: {error}; expected a material file or a BRDF table")),
        Ok(bytes) => {
            input.sha256 = Some(Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect());
            of_bytes(argument, &bytes, format, &mut name)
        }
    };
    Loaded { name, input, subject }
}

/// A table where the content is one, or the user says so; else a description.
fn of_bytes(
    argument: &str,
    bytes: &[u8],
    format: Option<Format>,
    name: &mut String,
) -> Result<Checked<Subject>, String> {
    let table = || -> Result<Checked<Subject>, String> {
        let read = format::open(bytes, format).map_err(|e| e.in_file(argument).to_string())?;
        let in_file = |mut f: Finding| {
            f.location.path = Some(argument.to_owned());
            f
        };
        let findings = read.findings.into_iter().map(in_file).collect();
        Ok(Checked { value: Subject::Measured(Box::new(read.value)), findings })
    };
    if format.is_some() || format::detect(bytes).is_some() {
        return table();
    }
    let is_toml = Path::new(argument).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let text = std::str::from_utf8(bytes).ok().filter(|t| !t.contains('\0'));
    let named = match text {
        Some(text) if is_toml || !text.trim().is_empty() => toml::read(text),
        None if is_toml => return Err(format!("{argument}: not UTF-8; expected a material in TOML")),
        _ => return table(),
    };
    match named {
        Ok(named) => {
            *name = named.name.map_or(name.clone(), |n| format!("{argument} [{n}]"));
            Ok(Checked { value: Subject::Described(named.material), findings: Vec::new() })
        }
        // Whether it was meant to be a material shows in its first words.
        Err(error) if is_toml || text.is_some_and(looks_like_toml) => Err(in_file(argument, &error)),
        Err(_) => table(),
    }
}

/// A key with a value, or a section, in the first line that says anything.
fn looks_like_toml(text: &str) -> bool {
    let first = text.lines().map(str::trim).find(|l| !l.is_empty() && !l.starts_with('#')).unwrap_or_default();
    let key = first.split_once('=').map(|(key, _)| key.trim());
    first.starts_with('[')
        || key.is_some_and(|k| !k.is_empty() && k.chars().all(|c| c.is_alphanumeric() || "_-\"".contains(c)))
}

/// `FILE:LINE:COLUMN: …`; for a description the text itself stands for the file.
pub(super) fn in_file(path: &str, error: &Error) -> String {
    let separator = if path.contains('(') { ": " } else { ":" };
    format!("{path}{separator}{error}")
}

/// A material on its bands.
pub(super) struct Ready {
    pub bands: Vec<Channel>,
    pub brdf: Box<dyn Brdf>,
}

/// A material on its channels, or on the wavelengths; a table on its own bands where none are asked for.
pub(super) fn prepare(path: &str, subject: &Subject, wanted: &BandArgs, default_nm: &[f64]) -> Result<Ready, String> {
    match subject {
        Subject::Described(material) => {
            if wanted.channels.is_some() {
                return Err(format!("{path}: is a model; expected a measured table for --channels"));
            }
            let wavelengths_nm = wanted.wavelength.as_ref().map_or(default_nm, |n| &n.0);
            let bands = material.channels().map_or(Bands::Wavelengths(wavelengths_nm), Bands::Channels);
            let brdf = material.prepare(bands).map_err(|e| in_file(path, &e))?;
            let bands = match bands {
                Bands::Wavelengths(nm) => nm.iter().map(|nm| Channel::Wavelength(*nm)).collect(),
                Bands::Channels(n) => (1..=n).map(|i| Channel::Named(format!("channel {i}"))).collect(),
            };
            Ok(Ready { bands, brdf })
        }
        Subject::Measured(file) => {
            let table = on_bands(path, &file.table, wanted)?;
            Ok(Ready { bands: table.channels().to_vec(), brdf: Box::new(table) })
        }
    }
}

/// A table on the bands asked for, else on its own. Channels that are no wavelengths stay as they are.
pub(super) fn on_bands(path: &str, table: &Table, wanted: &BandArgs) -> Result<Table, String> {
    let is_spectral = table.channels().iter().all(|c| matches!(c, Channel::Wavelength(_)));
    let chosen = match (&wanted.channels, &wanted.wavelength) {
        (Some(names), _) => table.of_channels(names),
        (_, Some(nm)) if is_spectral => table.at_wavelengths(&nm.0),
        _ => Ok(table.clone()),
    };
    chosen.map_err(|e| format!("{path}: {e}"))
}
