//! Materials from the command line: descriptions, files that hold one, and measured tables.

use std::fs::{self, File};
use std::io::{self, Read, Seek};
use std::path::Path;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use sha2::{Digest, Sha256};

use super::numbers::Numbers;
use crate::brdf::Brdf;
use crate::brdf::description::{Bands, Error, Material, toml};
use crate::brdf::format::{self, Format, merl};
use crate::brdf::table::{Channel, Table};
use crate::cli::convert::single;
use crate::constants::SecondRadiation;
use crate::finding::{Checked, Finding};
use crate::report::envelope::Input;

/// Bytes of a checksum's file that are read together.
const BLOCK: usize = 1 << 17;

/// Where the materials come from and on which bands they are wanted.
#[derive(Debug, Args)]
pub(super) struct MaterialArgs {
    /// Materials: a description such as 'ggx(alpha=0.1, medium=Au)', a TOML file, a measured table, or `-`.
    ///
    /// Models: lambert, oren-nayar, mirror, dielectric, conductor, phong, blinn-phong, ward, ashikhmin-shirley, ggx,
    /// beckmann, blinn, abc, sgd; `0.3*MODEL(…) + MODEL(…)` is a sum. A spectrum is
    /// `[[400, 0.1], [700, 0.5]]` or a file, `lambert(reflectance=wood.csv)`. A wrong parameter is answered with the model's list of
    /// them, and `brdf info` prints it. Tables: the formats of `--format`, told apart by their content.
    #[arg(required = true, value_name = "MATERIAL")]
    pub materials: Vec<String>,
    #[command(flatten)]
    pub bands: BandArgs,
}

/// The bands of a material, and the format of its file.
#[derive(Debug, Default, Args)]
pub(in crate::cli) struct BandArgs {
    /// Wavelengths in nm: a list `450,550`, a range `400:700:50`, or both. A table of wavelengths is read linearly between its
    /// own; materials given per channel keep their channels.
    #[arg(short, long, value_name = "NM")]
    pub wavelength: Option<Numbers>,
    /// Channels of a table, by name and in this order: `R,G,B`, `550 nm`.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', conflicts_with = "wavelength")]
    pub channels: Option<Vec<String>>,
    /// The format of table files, where their content does not say it.
    #[arg(long, value_name = "FORMAT", value_parser = formats())]
    pub format: Option<Format>,
}

/// Formats by their names.
fn formats() -> impl TypedValueParser<Value = Format> {
    let names = Format::ALL.map(|f| PossibleValue::new(f.name()).help(f.to_string()));
    let of_name = |name: String| Format::ALL.into_iter().find(|f| f.name() == name);
    PossibleValuesParser::new(names).map(move |name| of_name(name).expect("one of the names above"))
}

/// What an argument stands for.
#[derive(Debug, Clone)]
pub(in crate::cli) enum Subject {
    /// A material in words.
    Described(Material),
    /// A measured table.
    Measured(Box<format::File>),
}

impl Subject {
    /// The bins of a measured table of half angles.
    pub(in crate::cli) fn bins(&self) -> Option<usize> {
        match self {
            Self::Measured(file) => match &file.table {
                Table::HalfAngle(table) => Some(table.resolution().bins()),
                _ => None,
            },
            Self::Described(_) => None,
        }
    }
}

/// A material read.
pub(in crate::cli) struct Loaded {
    /// What to call it: the file and the name in it, or the description.
    pub name: String,
    pub input: Input,
    /// The files of spectra that its description names.
    pub spectra: Vec<Input>,
    /// The material, and what its reader noticed.
    pub subject: Result<Checked<Subject>, String>,
}

/// Reads a material: a measured table, a description in a file, or the description itself. The spectra that a description
/// names are beside its file.
pub(in crate::cli) fn load(argument: &str, format: Option<Format>) -> Loaded {
    let mut loaded = read(argument, format);
    if let Ok(Checked { value: Subject::Described(material), .. }) = &mut loaded.subject {
        let folder = Path::new(argument).parent().filter(|_| !argument.contains('(')).unwrap_or(Path::new(""));
        let spectra = &mut loaded.spectra;
        let with = material.clone().with_spectra(|file| {
            let path = folder.join(file).display().to_string();
            if !Path::new(&path).is_file() {
                return Err(format!("{path}: there is no such file; expected a spectrum"));
            }
            let found = single(&path, None, None, SecondRadiation::default()).map_err(|e| e.message)?;
            if !spectra.contains(&found.input) {
                spectra.push(found.input);
            }
            Ok(found.measured.spectrum)
        });
        match with {
            Ok(with) => *material = with,
            Err(error) => loaded.subject = Err(in_file(argument, &error)),
        }
    }
    loaded
}

/// The same without the spectra.
fn read(argument: &str, format: Option<Format>) -> Loaded {
    let mut input = Input { path: argument.to_owned(), sha256: None };
    let mut name = argument.to_owned();
    let is_file = argument == "-" || Path::new(argument).exists();
    if !is_file {
        let subject = if argument.contains('(') {
            let material = argument.parse::<Material>().map_err(|e| format!("{argument}: {e}"));
            material.map(|m| Checked { value: Subject::Described(m), findings: Vec::new() })
        } else {
            let hint = "expected a file, or a description such as 'lambert(reflectance=0.5)'";
            Err(format!("{argument}: there is no such file; {hint}"))
        };
        return Loaded { name, input, spectra: Vec::new(), subject };
    }
    if format.is_none_or(|f| f == Format::Merl)
        && let Some(loaded) = merl_file(argument)
    {
        return loaded;
    }
    let subject = match bytes_of(argument) {
        Err(error) => Err(format!("{argument}: cannot be read: {error}; expected a material file or a BRDF table")),
        Ok(bytes) => {
            input.sha256 = Some(hex(&bytes));
            of_bytes(argument, &bytes, format, &mut name)
        }
    };
    Loaded { name, input, spectra: Vec::new(), subject }
}

/// The same of what must be a measured table.
pub(super) fn load_table(path: &str) -> (Input, Result<Checked<Table>, String>) {
    let Loaded { input, subject, .. } = load(path, None);
    if path != "-" && !path.contains('(') && !Path::new(path).exists() {
        let message = format!("{path}: cannot be read: there is no such file; expected a measured table");
        return (input, Err(message));
    }
    let table = subject.and_then(|read| match read.value {
        Subject::Measured(file) => Ok(Checked { value: file.table, findings: read.findings }),
        Subject::Described(_) => Err(format!("{path}: found a model; expected a measured table")),
    });
    (input, table)
}

/// A file's bytes, `-` being standard input.
pub(super) fn bytes_of(argument: &str) -> io::Result<Vec<u8>> {
    if argument != "-" {
        return fs::read(argument);
    }
    let mut bytes = Vec::new();
    io::stdin().read_to_end(&mut bytes).map(|_| bytes)
}

/// SHA-256 of bytes, hexadecimal.
pub(super) fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

/// A MERL file, the largest there are, is read block by block while another core computes its checksum; `None` for any other.
fn merl_file(path: &str) -> Option<Loaded> {
    // Before it is opened: a pipe can be opened but once.
    let length = fs::metadata(path).ok().filter(|m| path != "-" && m.is_file())?.len();
    let mut file = File::open(path).ok()?;
    let mut start = [0; merl::HEADER];
    file.read_exact(&mut start).ok().filter(|()| merl::begins(&start, length))?;
    file.rewind().ok()?;
    let (sha256, read) = rayon::join(|| checksum(path), || merl::read(&mut file, length));
    let table = |table| format::File { format: Format::Merl, table: Table::HalfAngle(table), printed_tis: Vec::new() };
    Some(Loaded {
        name: path.to_owned(),
        input: Input { path: path.to_owned(), sha256: sha256.ok() },
        spectra: Vec::new(),
        subject: read.map_err(|e| e.in_file(path).to_string()).map(|read| measured(path, read.map(table))),
    })
}

/// SHA-256 of a file, hexadecimal.
fn checksum(path: &str) -> io::Result<String> {
    let (mut file, mut hash, mut block) = (File::open(path)?, Sha256::new(), vec![0; BLOCK]);
    loop {
        match file.read(&mut block)? {
            0 => return Ok(hash.finalize().iter().map(|b| format!("{b:02x}")).collect()),
            n => hash.update(&block[..n]),
        }
    }
}

/// A table whose findings name its file.
fn measured(path: &str, read: Checked<format::File>) -> Checked<Subject> {
    let in_file = |mut f: Finding| {
        f.location.path = Some(path.to_owned());
        f
    };
    let findings = read.findings.into_iter().map(in_file).collect();
    Checked { value: Subject::Measured(Box::new(read.value)), findings }
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
        Ok(measured(argument, read))
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
pub(in crate::cli) struct Ready {
    pub bands: Vec<Channel>,
    pub brdf: Box<dyn Brdf>,
}

/// A material on its channels, or on the wavelengths; a table on its own bands where none are asked for.
pub(in crate::cli) fn prepare(
    path: &str,
    subject: &Subject,
    wanted: &BandArgs,
    default_nm: &[f64],
) -> Result<Ready, String> {
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
