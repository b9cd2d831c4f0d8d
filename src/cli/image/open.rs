//! Opening images: files by content, ENVI pairs by name, folders and lists of pictures.

use std::fs::{self, File};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::ProgressBar;
use sha2::{Digest, Sha256};

use crate::cli::Failure;
use crate::finding::{Checked, Finding};
use crate::image::error::{Error, ErrorKind};
use crate::image::format::stack::{self, Band};
use crate::image::format::{envi, exr, npy, picture, radiance};
use crate::image::{Description, Region, Source};
use crate::report::envelope::Input;
use crate::spectrum::WavelengthUnit;

/// Endings that the data of an ENVI header may have.
const DATA_ENDINGS: [&str; 9] = ["", "img", "dat", "raw", "bil", "bip", "bsq", "cube", "bin"];
/// Endings of the pictures of a stack.
const PICTURES: [&str; 4] = ["png", "tif", "tiff", "exr"];

/// How the input is read.
#[derive(Debug, Args)]
#[command(next_help_heading = "Reading")]
pub(in crate::cli) struct Reading {
    /// Wavelengths (nm) of an NPY array or a stack: START:STEP, or a CSV file with a column wavelength_nm and, for a stack, file,
    /// gain and dark where wanted.
    #[arg(long, value_name = "START:STEP|FILE")]
    pub wavelengths: Option<String>,
    /// Unit of the wavelengths where an ENVI header states none: nm (the default), um, m, angstrom.
    #[arg(long, value_name = "UNIT")]
    pub wavelength_unit: Option<WavelengthUnit>,
    /// The samples are reflectances (0 to 1), where the file does not say so.
    #[arg(long)]
    pub reflectance: bool,
    /// PNG, JPEG, TIFF: integers are linear, without the sRGB curve.
    #[arg(long)]
    pub linear: bool,
    /// Stacks: what a stored number less the dark one is multiplied by.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    pub gain: f64,
    /// Stacks: the stored number of darkness.
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0, allow_negative_numbers = true)]
    pub dark: f64,
}

/// An image ready to be read.
pub(in crate::cli) struct Opened {
    /// Its pixels.
    pub source: Box<dyn Source>,
    /// What was noticed on opening.
    pub findings: Vec<Finding>,
    /// All files that it consists of.
    pub files: Vec<String>,
    /// The name that messages use.
    pub path: String,
}

impl Opened {
    fn new<S: Source + 'static>(path: &str, files: Vec<String>, checked: Checked<S>) -> Self {
        let mut findings = checked.findings;
        findings.iter_mut().for_each(|f| f.location.path = Some(path.to_owned()));
        let source = Box::new(Named { source: checked.value, path: path.to_owned() });
        Self { source, findings, files, path: path.to_owned() }
    }

    /// The files with their checksums.
    pub(in crate::cli) fn inputs(&self) -> Result<Vec<Input>, Failure> {
        let one = |path: &String| {
            let mut digest = Sha256::new();
            let mut file = File::open(path).map_err(|e| cannot(path, &e))?;
            let mut buffer = vec![0; 1 << 20];
            loop {
                match file.read(&mut buffer).map_err(|e| cannot(path, &e))? {
                    0 => break,
                    count => digest.update(&buffer[..count]),
                }
            }
            let sha256 = digest.finalize().iter().map(|b| format!("{b:02x}")).collect();
            Ok(Input { path: path.clone(), sha256: Some(sha256) })
        };
        self.files.iter().map(one).collect()
    }
}

/// A source whose errors and findings carry the file's name: those without a name are then of the output.
struct Named<S> {
    source: S,
    path: String,
}

impl<S: Source> Source for Named<S> {
    fn description(&self) -> &Description {
        self.source.description()
    }

    fn block(&self) -> (usize, usize) {
        self.source.block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        self.source.read(region, channels, out).map_err(|e| e.in_file(&self.path))
    }

    fn findings(&self) -> Vec<Finding> {
        let mut findings = self.source.findings();
        findings.iter_mut().for_each(|f| f.location.path = Some(self.path.clone()));
        findings
    }
}

/// A source that moves the progress bar, which counts bytes of the input.
pub(super) struct Watched {
    pub source: Box<dyn Source>,
    pub progress: ProgressBar,
}

impl Source for Watched {
    fn description(&self) -> &Description {
        self.source.description()
    }

    fn block(&self) -> (usize, usize) {
        self.source.block()
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        self.source.read(region, channels, out)?;
        let (all, done) = (self.description().pixels() as f64, region.pixels() as f64);
        let bytes = self.progress.length().unwrap_or(0) as f64;
        self.progress.inc((bytes * done / all) as u64);
        Ok(())
    }

    fn findings(&self) -> Vec<Finding> {
        self.source.findings()
    }
}

fn cannot(path: &str, error: &io::Error) -> Failure {
    Failure::Message(format!("{path}: cannot be read: {error}; expected a readable image"))
}

fn refused(path: &str) -> impl Fn(Error) -> Failure {
    move |error| Failure::Message(error.in_file(path).to_string())
}

/// Opens the image that one path, or the pictures of several, make.
pub(in crate::cli) fn open(paths: &[String], reading: &Reading) -> Result<Opened, Failure> {
    match paths {
        [path] if Path::new(path).is_dir() => {
            let pictures = folder(path)?;
            pictures_of(path, &pictures, reading)
        }
        [path] if path == "-" => {
            let mut spool = tempfile::tempfile()?;
            io::copy(&mut io::stdin().lock(), &mut spool)?;
            one(path, spool, reading)
        }
        // One picture is a stack of one band where somebody says its wavelength.
        [path] if path != "-" && reading.wavelengths.is_some() && is_picture(path) => pictures_of(path, paths, reading),
        [path] => one(path, File::open(path).map_err(|e| cannot(path, &e))?, reading),
        _ => pictures_of("the stack", paths, reading),
    }
}

fn one(path: &str, mut file: File, reading: &Reading) -> Result<Opened, Failure> {
    let mut start = Vec::new();
    file.rewind().and_then(|()| (&mut file).take(8).read_to_end(&mut start)).map_err(|e| cannot(path, &e))?;
    let files = if path == "-" { Vec::new() } else { vec![path.to_owned()] };
    let options = envi::Options { wavelength_unit: reading.wavelength_unit, reflectance: reading.reflectance };
    match start.as_slice() {
        [] => Err(refused(path)(ErrorKind::Empty.into())),
        [0x76, 0x2f, 0x31, 0x01, ..] => Ok(Opened::new(path, files, exr::open(file).map_err(refused(path))?)),
        start if start.starts_with(npy::MAGIC) => {
            let wavelengths = match &reading.wavelengths {
                Some(text) => {
                    let channels = npy::channels(&mut file).map_err(refused(path))?;
                    wavelengths(text, channels)?.into_iter().map(|b| b.wavelength_nm).collect()
                }
                None => Vec::new(),
            };
            Ok(Opened::new(path, files, npy::open(file, wavelengths, options).map_err(refused(path))?))
        }
        [b'#', b'?', ..] => Ok(Opened::new(path, files, radiance::open(file).map_err(refused(path))?)),
        start if picture::is_picture(start) => {
            let options = picture::Options { linear: reading.linear };
            Ok(Opened::new(path, files, picture::open(file, options).map_err(refused(path))?))
        }
        [b'E', b'N', b'V', b'I', ..] => {
            let data = data_of(Path::new(path))?;
            pair(path, &data.to_string_lossy(), path, options)
        }
        _ => match header_of(Path::new(path)) {
            Some(header) => pair(&header.to_string_lossy(), path, path, options),
            None => {
                let found = "neither an OpenEXR, an NPY, a Radiance nor an ENVI file (no .hdr beside it), nor a PNG, JPEG or TIFF".to_owned();
                Err(refused(path)(ErrorKind::UnknownFormat { found }.into()))
            }
        },
    }
}

/// An ENVI header and its data; errors in the header are told at the header.
fn pair(header: &str, data: &str, path: &str, options: envi::Options) -> Result<Opened, Failure> {
    let bytes = fs::read(header).map_err(|e| cannot(header, &e))?;
    let numbers = File::open(data).map_err(|e| cannot(data, &e))?;
    let opened = envi::open(&bytes, numbers, options).map_err(|error| {
        refused(if matches!(error.kind(), ErrorKind::CutOff { .. }) { data } else { header })(error)
    })?;
    Ok(Opened::new(path, vec![header.to_owned(), data.to_owned()], opened))
}

/// The data of a header: the name without `.hdr`, alone or with a usual ending.
fn data_of(header: &Path) -> Result<PathBuf, Failure> {
    let stem = header.with_extension("");
    let named =
        DATA_ENDINGS.iter().map(|ending| if ending.is_empty() { stem.clone() } else { stem.with_extension(ending) });
    // `cube.img.hdr` belongs to `cube.img`, where the name without `.hdr` is the file itself.
    let mut found = named.filter(|p| p != header && p.is_file());
    found.next().ok_or_else(|| {
        let endings = DATA_ENDINGS[1..].join(", .");
        let stem = stem.display();
        Failure::Message(format!(
            "{}: found no data beside it; expected {stem} or {stem} with .{endings}",
            header.display()
        ))
    })
}

fn header_of(data: &Path) -> Option<PathBuf> {
    let mut appended = data.as_os_str().to_owned();
    appended.push(".hdr");
    [data.with_extension("hdr"), PathBuf::from(appended)].into_iter().find(|p| {
        let mut start = [0; 4];
        File::open(p).and_then(|mut f| f.read_exact(&mut start)).is_ok() && start == *b"ENVI"
    })
}

fn is_picture(path: &str) -> bool {
    let mut start = [0; 4];
    File::open(path).and_then(|mut f| f.read_exact(&mut start)).is_ok() && picture::is_picture(&start)
}

/// The pictures in a folder, by name.
fn folder(path: &str) -> Result<Vec<String>, Failure> {
    let mut out = Vec::new();
    for entry in fs::read_dir(path).map_err(|e| cannot(path, &e))? {
        let file = entry.map_err(|e| cannot(path, &e))?.path();
        let ending = file.extension().and_then(|e| e.to_str()).map(str::to_lowercase);
        if ending.is_some_and(|e| PICTURES.contains(&e.as_str())) {
            out.push(file.to_string_lossy().into_owned());
        }
    }
    out.sort();
    if out.is_empty() {
        return Err(Failure::Message(format!(
            "{path}: found no picture in the folder; expected {}",
            PICTURES.join(", ")
        )));
    }
    Ok(out)
}

/// The bands that `--wavelengths` says, for as many channels.
fn wavelengths(text: &str, channels: usize) -> Result<Vec<Band>, Failure> {
    let range = text.split_once(':').and_then(|(start, step)| {
        let (start, step) = (start.trim().parse::<f64>().ok()?, step.trim().parse::<f64>().ok()?);
        (start > 0.0 && step.is_finite() && step != 0.0).then_some((start, step))
    });
    if let Some((start, step)) = range {
        let band =
            |i: usize| Band { file: String::new(), wavelength_nm: start + step * i as f64, gain: 1.0, dark: 0.0 };
        return Ok((0..channels).map(band).collect());
    }
    let table = fs::read_to_string(text).map_err(|e| {
        Failure::Message(format!("--wavelengths {text}: {e}; expected START:STEP in nm, or a CSV file"))
    })?;
    stack::read_list(&table).map_err(refused(text))
}

fn pictures_of(path: &str, pictures: &[String], reading: &Reading) -> Result<Opened, Failure> {
    let mut bands = Vec::new();
    let listed = reading.wavelengths.as_ref().map(|text| wavelengths(text, pictures.len())).transpose()?;
    if let Some(listed) = &listed
        && listed.iter().all(|b| b.file.is_empty())
        && listed.len() != pictures.len()
    {
        let message = format!("{path}: {} pictures for {} wavelengths; expected as many", pictures.len(), listed.len());
        return Err(Failure::Message(message));
    }
    for (i, picture) in pictures.iter().enumerate() {
        let name = Path::new(picture).file_name().map_or(picture.as_str(), |n| n.to_str().unwrap_or(picture));
        let found = match &listed {
            Some(listed) if listed.iter().any(|b| !b.file.is_empty()) => {
                listed.iter().find(|b| b.file == name || b.file == *picture).cloned()
            }
            Some(listed) => listed.get(i).cloned(),
            None => stack::wavelength_of_name(name).map(|wavelength_nm| Band {
                file: String::new(),
                wavelength_nm,
                gain: 1.0,
                dark: 0.0,
            }),
        };
        let Some(band) = found else {
            let expected = "a name such as 550nm.tif, or --wavelengths with a table";
            return Err(Failure::Message(format!("{picture}: found no wavelength for it; expected {expected}")));
        };
        let dark = if band.dark == 0.0 { reading.dark } else { band.dark };
        bands.push(Band { file: picture.clone(), dark, gain: band.gain * reading.gain, ..band });
    }
    let options = envi::Options { wavelength_unit: None, reflectance: reading.reflectance };
    let scratch = tempfile::tempfile()?;
    let opened = stack::gather(&bands, |band| fs::read(&band.file), scratch, options).map_err(refused(path))?;
    Ok(Opened::new(path, pictures.to_vec(), opened))
}
