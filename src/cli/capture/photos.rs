//! The photographs of a run: those of a manifest, or those named.

use std::fs::{self, File};
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::capture::manifest::{Exposure, Manifest, Stack};
use crate::capture::photo::exif_time_s;
use crate::capture::rows::PhotoRows;
use crate::capture::{Error, Photo};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::report::envelope::{Envelope, Input};

/// Which photographs.
#[derive(Debug, Args)]
pub(super) struct Given {
    /// A manifest (.toml), or the photographs of one scene.
    #[arg(required = true, value_name = "MANIFEST|PHOTO")]
    pub files: Vec<String>,
    /// Exposure times of the photographs named: lines `PHOTO,SECONDS`, or one time per line in their order; `1/30` will do.
    #[arg(long, value_name = "CSV")]
    pub times: Option<PathBuf>,
}

/// The form of the answer.
#[derive(Debug, Args)]
pub(super) struct Form {
    /// One JSON document.
    #[arg(long)]
    pub json: bool,
}

/// What is photographed, and everything read and noticed on the way.
pub(super) struct Photos {
    pub manifest: Manifest,
    folder: PathBuf,
    pub inputs: Vec<Input>,
    pub findings: Vec<Finding>,
    pub notes: Notes,
    command: &'static str,
}

impl Photos {
    pub(super) fn open(command: &'static str, given: &Given, talk: Talk) -> Result<Self, Failure> {
        let manifests = given.files.iter().filter(|f| is_manifest(f)).count();
        let mut photos = Self {
            manifest: Manifest::default(),
            folder: PathBuf::new(),
            inputs: Vec::new(),
            findings: Vec::new(),
            notes: Notes::new(&given.files, talk),
            command,
        };
        match (manifests, given.files.as_slice()) {
            (1, [path]) => {
                let text = String::from_utf8(photos.bytes(path)?).map_err(|_| {
                    Failure::Message(format!("{path}:1:1: found bytes that are not UTF-8; expected TOML"))
                })?;
                photos.manifest = Manifest::parse(&text).map_err(|e| Failure::Message(format!("{path}:{e}")))?;
                photos.folder = Path::new(path).parent().unwrap_or(Path::new("")).to_owned();
            }
            (0, files) => {
                let exposures = files.iter().map(|f| Exposure { photo: f.clone(), time_s: None }).collect();
                photos.manifest.stack.push(Stack::new("photographs", exposures));
            }
            _ => {
                let message =
                    format!("{manifests} manifests among {} files; expected one, or photographs", given.files.len());
                return Err(Failure::Message(message));
            }
        }
        if let Some(path) = &given.times {
            photos.times(path)?;
        }
        Ok(photos)
    }

    /// A path of the manifest.
    pub(super) fn path(&self, file: &str) -> String {
        self.folder.join(file).display().to_string()
    }

    /// Reads a file and keeps its checksum.
    pub(super) fn bytes(&mut self, path: &str) -> Result<Vec<u8>, Failure> {
        let bytes = fs::read(path).map_err(|e| unreadable(path, &e))?;
        self.read(path, || Ok(Sha256::digest(&bytes)))?;
        Ok(bytes)
    }

    /// Opens a file and keeps its checksum.
    pub(super) fn file(&mut self, path: &str) -> Result<File, Failure> {
        let opened = || File::open(path).map_err(|e| unreadable(path, &e));
        self.read(path, || {
            let (mut file, mut hash, mut piece) = (opened()?, Sha256::new(), vec![0; 1 << 18]);
            loop {
                match file.read(&mut piece).map_err(|e| unreadable(path, &e))? {
                    0 => return Ok(hash.finalize()),
                    n => hash.update(&piece[..n]),
                }
            }
        })?;
        opened()
    }

    /// Notes an input, with its checksum where it is not known yet.
    fn read(
        &mut self,
        path: &str,
        checksum: impl FnOnce() -> Result<sha2::digest::Output<Sha256>, Failure>,
    ) -> Result<(), Failure> {
        if !self.inputs.iter().any(|i| i.path == path) {
            let sha256 = Some(checksum()?.iter().map(|b| format!("{b:02x}")).collect());
            self.inputs.push(Input { path: path.to_owned(), sha256 });
        }
        Ok(())
    }

    /// A photograph by rows.
    pub(super) fn rows(&mut self, file: &str) -> Result<PhotoRows<File>, Failure> {
        let path = self.path(file);
        PhotoRows::open(self.file(&path)?).map_err(|e| Failure::Message(format!("{path}: {e}")))
    }

    /// A photograph.
    pub(super) fn photo(&mut self, file: &str) -> Result<Photo, Failure> {
        let mut rows = self.rows(file)?;
        rows.next(rows.height).map_err(|e| Failure::Message(format!("{}: {e}", self.path(file))))
    }

    /// An exposure by rows and its time: stated, or that of its EXIF data.
    pub(super) fn exposure_rows(&mut self, exposure: &Exposure) -> Result<(PhotoRows<File>, f64), Failure> {
        let path = self.path(&exposure.photo);
        let time_s = self
            .time_s(exposure)?
            .ok_or_else(|| Failure::Message(format!("{path}: {}", Error::NoTime { name: exposure.photo.clone() })))?;
        Ok((self.rows(&exposure.photo)?, time_s))
    }

    /// The time of an exposure: stated, or that of its EXIF data.
    pub(super) fn time_s(&mut self, exposure: &Exposure) -> Result<Option<f64>, Failure> {
        if exposure.time_s.is_some() {
            return Ok(exposure.time_s);
        }
        let path = self.path(&exposure.photo);
        Ok(exif_time_s(&mut BufReader::new(self.file(&path)?)))
    }

    /// An exposure and its time: stated, or that of its EXIF data.
    pub(super) fn exposure(&mut self, exposure: &Exposure) -> Result<(Photo, f64), Failure> {
        let (mut rows, time_s) = self.exposure_rows(exposure)?;
        let photo = rows.next(rows.height);
        Ok((photo.map_err(|e| Failure::Message(format!("{}: {e}", self.path(&exposure.photo))))?, time_s))
    }

    /// Reads once more what was read before: what is noticed was told the first time, or will be the next.
    pub(super) fn untold<T>(&mut self, action: impl FnOnce(&mut Self) -> T) -> T {
        let (told, failed) = (self.findings.len(), self.notes.failed);
        let out = action(self);
        self.findings.truncate(told);
        self.notes.failed = failed;
        out
    }

    /// Notes that a photograph is left out, and why.
    pub(super) fn left_out(&mut self, file: &str, failure: &Failure) {
        self.notes.failed = true;
        let hint = "the result rests on the others";
        let place = Location::default().of_item(file);
        self.findings.push(Finding::error("K001", format!("left out: {failure}")).hint(hint).at(place));
    }

    fn times(&mut self, path: &Path) -> Result<(), Failure> {
        let path = path.display().to_string();
        let text = String::from_utf8_lossy(&self.bytes(&path)?).into_owned();
        let exposures: Vec<&mut Exposure> = self.manifest.stack.iter_mut().flat_map(|s| &mut s.exposures).collect();
        let lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty());
        let mut rows: Vec<(usize, Option<String>, f64)> = Vec::new();
        for (n, line) in lines {
            let (name, time) = line.rsplit_once(',').map_or((None, line), |(name, time)| (Some(name), time));
            match seconds(time) {
                Some(time_s) => rows.push((n + 1, name.map(|n| n.trim().to_owned()), time_s)),
                // A header.
                None if rows.is_empty() && name.is_some() => {}
                None => {
                    let time = time.trim();
                    let message = format!("{path}:{}:1: found `{time}`; expected seconds such as 0.5 or 1/30", n + 1);
                    return Err(Failure::Message(message));
                }
            }
        }
        let in_order = rows.iter().all(|(_, name, _)| name.is_none());
        if in_order && rows.len() != exposures.len() {
            let message =
                format!("{path}: found {} times; expected {}, one per photograph", rows.len(), exposures.len());
            return Err(Failure::Message(message));
        }
        for (i, exposure) in exposures.into_iter().enumerate() {
            let named = |row: &&(usize, Option<String>, f64)| {
                row.1.as_ref().is_some_and(|n| Path::new(n).file_name() == Path::new(&exposure.photo).file_name())
            };
            let row = if in_order { rows.get(i) } else { rows.iter().find(named) };
            exposure.time_s = row.map(|r| r.2).or(exposure.time_s);
        }
        Ok(())
    }

    /// Prints a result and what was noticed; exit code 2 where something was left out.
    pub(super) fn print(
        mut self,
        settings: &Value,
        results: &[Value],
        text: &str,
        json: bool,
        output: Option<&Path>,
    ) -> Result<(), Failure> {
        let read: Vec<String> = self.inputs.iter().map(|i| i.path.clone()).collect();
        self.notes.print(&self.findings);
        let mut sink = Sink::open(output, &read)?;
        if json {
            let mut envelope = Envelope::begin(&mut sink, self.command, settings)?;
            results.iter().try_for_each(|r| envelope.result(r))?;
            self.findings.drain(..).for_each(|f| envelope.finding(f));
            self.inputs.drain(..).for_each(|i| envelope.input(i));
            envelope.end()?;
        } else {
            sink.write_all(text.as_bytes())?;
        }
        sink.finish(true)?;
        if self.notes.failed { Err(Failure::Reported) } else { Ok(()) }
    }
}

fn unreadable(path: &str, error: &io::Error) -> Failure {
    Failure::Message(format!("{path}: cannot be read: {error}; expected a file"))
}

/// Whether a file is a manifest: its name ends in .toml.
pub(super) fn is_manifest(file: &str) -> bool {
    Path::new(file).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

/// Seconds, or a fraction of them.
fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    let value = match text.split_once('/') {
        Some((above, below)) => above.trim().parse::<f64>().ok()? / below.trim().parse::<f64>().ok()?,
        None => text.parse().ok()?,
    };
    (value > 0.0 && value.is_finite()).then_some(value)
}
