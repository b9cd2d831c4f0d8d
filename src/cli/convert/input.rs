//! Opening inputs: files, standard input and named sources, with checksum and progress counted on the way.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use indicatif::ProgressBar;
use sha2::{Digest, Sha256};

use crate::constants::SecondRadiation;
use crate::finding::{Finding, Location};
use crate::illuminant::named;
use crate::report::envelope::Input;
use crate::spectrum::format::{self, Measured, Opened, ReadOptions, RowStream};
use crate::spectrum::{Quantity, SpectralUnit};

/// An input ready to be converted.
pub(super) enum Loaded {
    /// Spectra that are in memory.
    Spectra(Vec<Item>, Input, Vec<Finding>),
    /// A table with one spectrum per row, read as it goes.
    Stream(Box<RowStream<Counted>>, Checksum),
}

/// A spectrum in memory.
pub(super) struct Item {
    pub measured: Measured,
    pub printed: Vec<format::Printed>,
    /// Made by name: its samples are what it is.
    pub defined: bool,
}

/// Why an input was not read, ready to print.
pub(in crate::cli) struct Refused {
    pub message: String,
    pub finding: Box<Finding>,
}

impl Refused {
    pub(super) fn new(path: &str, error: format::Error) -> Self {
        let located = error.in_file(path);
        let mut finding = Finding::error("S000", located.kind().to_string()).at(located.location().clone());
        finding.hint = located.hint().map(str::to_owned);
        Self { message: located.to_string(), finding: Box::new(finding) }
    }

    pub(super) fn plain(path: &str, message: &str) -> Self {
        let finding = Finding::error("S000", message).at(Location::default().in_file(path));
        Self { message: format!("{path}: {message}"), finding: Box::new(finding) }
    }
}

/// What the user says about quantity and unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Said<'a> {
    pub quantity: Option<Quantity>,
    pub unit: Option<&'a SpectralUnit>,
}

/// The running checksum of an input being read.
#[derive(Clone, Default)]
pub(super) struct Checksum(Arc<Mutex<Sha256>>);

impl Checksum {
    fn update(&self, bytes: &[u8]) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).update(bytes);
    }

    /// The input with its checksum, once it has been read to the end.
    pub(super) fn input(&self, path: &str) -> Input {
        let digest = self.0.lock().unwrap_or_else(PoisonError::into_inner).clone().finalize();
        let hex = digest.iter().map(|b| format!("{b:02x}")).collect();
        Input { path: path.to_owned(), sha256: Some(hex) }
    }
}

/// A reader that keeps the checksum and moves the progress bar.
pub(super) struct Counted {
    inner: Box<dyn Read + Send>,
    checksum: Checksum,
    progress: ProgressBar,
}

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.checksum.update(&buffer[..count]);
        self.progress.inc(count as u64);
        Ok(count)
    }
}

/// Opens one input. A file of the name goes before a source of the name.
pub(super) fn open(
    path: &str,
    options: &ReadOptions,
    said: Said<'_>,
    c2: SecondRadiation,
    progress: &ProgressBar,
) -> Result<Loaded, Refused> {
    if path != "-" && !Path::new(path).exists() && (named::is_name(path) || !looks_like_a_file(path)) {
        return source(path, c2);
    }
    let inner: Box<dyn Read + Send> = if path == "-" {
        Box::new(io::stdin())
    } else {
        let refuse = |e: io::Error| {
            Refused::plain(
                path,
                &format!("cannot be read: {}; expected a readable file, `-`, or a source by name", plain(&e)),
            )
        };
        let file = File::open(path).map_err(refuse)?;
        if file.metadata().is_ok_and(|m| m.is_dir()) {
            return Err(Refused::plain(
                path,
                "is a folder; expected a file (name its files, for example with a wildcard)",
            ));
        }
        Box::new(file)
    };
    let checksum = Checksum::default();
    let reader = Counted { inner, checksum: checksum.clone(), progress: progress.clone() };
    let file = match format::open(reader, options).map_err(|e| Refused::new(path, e))? {
        Opened::Stream(stream) => return Ok(Loaded::Stream(stream, checksum)),
        Opened::Whole(file) => file,
    };
    let mut findings = file.findings;
    let mut items = Vec::with_capacity(file.value.entries.len());
    for entry in file.value.entries {
        let resolved = entry.resolve(said.quantity, said.unit).map_err(|e| Refused::new(path, e))?;
        findings.extend(resolved.findings);
        items.push(Item { measured: resolved.value, printed: entry.printed, defined: false });
    }
    Ok(Loaded::Spectra(items, checksum.input(path), findings))
}

/// The one spectrum of an input, and what there is to say of it.
pub(in crate::cli) struct Single {
    pub measured: Measured,
    /// Made by name: its samples are what it is.
    pub defined: bool,
    pub input: Input,
    pub findings: Vec<Finding>,
}

/// All spectra of an input that holds them as columns, of the quantity given where the user knows it.
pub(in crate::cli) fn all(
    path: &str,
    quantity: Option<Quantity>,
    c2: SecondRadiation,
) -> Result<(Vec<Measured>, Input, Vec<Finding>), Refused> {
    let (items, input, findings) = columns(path, quantity, c2)?;
    Ok((items.into_iter().map(|item| item.measured).collect(), input, findings))
}

/// The same with what is known of each beside its measurement.
fn columns(
    path: &str,
    quantity: Option<Quantity>,
    c2: SecondRadiation,
) -> Result<(Vec<Item>, Input, Vec<Finding>), Refused> {
    let said = Said { quantity, unit: None };
    let (items, input, mut findings) = match open(path, &ReadOptions::default(), said, c2, &ProgressBar::hidden())? {
        Loaded::Spectra(items, input, findings) => (items, input, findings),
        Loaded::Stream(..) => {
            let message = "a table with one spectrum per row; expected one spectrum, or spectra as columns";
            return Err(Refused::plain(path, message));
        }
    };
    for finding in &mut findings {
        finding.location.path = Some(path.to_owned());
    }
    Ok((items, input, findings))
}

/// Opens an input that holds one spectrum, or the one of a name.
pub(in crate::cli) fn single(
    path: &str,
    select: Option<&str>,
    quantity: Option<Quantity>,
    c2: SecondRadiation,
) -> Result<Single, Refused> {
    let (items, input, findings) = columns(path, quantity, c2)?;
    let names: Vec<String> = items.iter().map(|i| i.measured.name.clone()).collect();
    let wanted = |i: &Item| select.is_none_or(|n| n.to_lowercase() == i.measured.name.to_lowercase());
    let mut chosen = items.into_iter().filter(wanted);
    match (chosen.next(), chosen.next()) {
        (Some(item), None) => Ok(Single { measured: item.measured, defined: item.defined, input, findings }),
        _ => {
            let some: Vec<&str> = names.iter().take(12).map(String::as_str).collect();
            let more = if names.len() > some.len() { ", …" } else { "" };
            let message =
                format!("{} spectra; expected the name of one with --select: {}{more}", names.len(), some.join(", "));
            Err(Refused::plain(path, &message))
        }
    }
}

/// The operating system's words without its number.
fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or(&text).to_lowercase()
}

/// A mistyped file should be told that there is no such file, a mistyped source which sources there are.
fn looks_like_a_file(path: &str) -> bool {
    path.contains(['/', '\\', '.'])
}

fn source(name: &str, c2: SecondRadiation) -> Result<Loaded, Refused> {
    let source = named::source(name, c2).map_err(|e| Refused::plain(name, &e.to_string()))?;
    let mut findings = Vec::new();
    if source.quantity == Quantity::Relative {
        findings.push(
            Finding::info("P001", "a source known up to a factor: only ratios are reported")
                .hint("give it a level with --scale-to"),
        );
    }
    let measured = Measured { name: source.name, quantity: source.quantity, spectrum: source.spectrum, standard: None };
    // A blackbody is Planck's law, which our samples follow; all else is tabulated or made of tables.
    let defined = !measured.name.starts_with("blackbody");
    let items = vec![Item { measured, printed: Vec::new(), defined }];
    Ok(Loaded::Spectra(items, Input { path: name.to_owned(), sha256: None }, findings))
}
