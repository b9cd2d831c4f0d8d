//! Where results go: standard output, or a file written beside its place and moved there when whole.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use super::Failure;

/// Bytes gathered before they are written.
const BUFFER: usize = 1 << 16;

/// The destination of a run's results.
pub(super) enum Sink {
    /// Standard output.
    Stdout(BufWriter<io::StdoutLock<'static>>),
    /// A pipe or a device: written to as it is, for it must not be replaced by a file.
    Device(BufWriter<File>),
    /// A temporary file beside the destination.
    File(BufWriter<tempfile::NamedTempFile>, PathBuf),
}

impl Sink {
    /// Opens the destination; `-` and `None` are standard output.
    ///
    /// A destination that is one of the inputs is refused.
    pub(super) fn open(path: Option<&Path>, inputs: &[String]) -> Result<Self, Failure> {
        let Some(path) = path.filter(|p| *p != Path::new("-")) else {
            return Ok(Self::Stdout(BufWriter::with_capacity(BUFFER, io::stdout().lock())));
        };
        refuse_input(path, inputs)?;
        match fs::metadata(path) {
            Ok(m) if m.is_dir() => Err(Failure::Message(format!("{}: is a folder; expected a file", path.display()))),
            Ok(m) if !m.is_file() => {
                let file = OpenOptions::new().write(true).open(path).map_err(|e| cannot(path, &e))?;
                Ok(Self::Device(BufWriter::with_capacity(BUFFER, file)))
            }
            found => {
                // Through a link, the file behind it is replaced and the link stays.
                let place =
                    if found.is_ok() { fs::canonicalize(path).map_err(|e| cannot(path, &e))? } else { path.to_owned() };
                Ok(Self::File(BufWriter::with_capacity(BUFFER, beside(&place)?), place))
            }
        }
    }

    /// Flushes, and moves a file to its place; with nothing worth keeping an earlier file stays as it was.
    pub(super) fn finish(self, worth_keeping: bool) -> Result<(), Failure> {
        match self {
            Self::Stdout(mut out) => Ok(out.flush()?),
            Self::Device(mut out) => Ok(out.flush()?),
            Self::File(..) if !worth_keeping => Ok(()),
            Self::File(out, path) => {
                let file = out.into_inner().map_err(|e| cannot(&path, e.error()))?;
                file.persist(&path).map(|_| ()).map_err(|e| cannot(&path, &e.error))
            }
        }
    }
}

impl Write for Sink {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stdout(out) => out.write(buffer),
            Self::Device(out) => out.write(buffer),
            Self::File(out, _) => out.write(buffer),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(out) => out.flush(),
            Self::Device(out) => out.flush(),
            Self::File(out, _) => out.flush(),
        }
    }
}

/// A destination that is written in any order: a temporary file, moved or copied to its place when whole.
pub(super) struct Whole {
    file: tempfile::NamedTempFile,
    end: End,
}

/// Where a [`Whole`] goes.
enum End {
    Stdout,
    /// A pipe or a device, which must not be replaced by a file.
    Device(PathBuf),
    Place(PathBuf),
}

impl Whole {
    /// Opens the destination, `-` being standard output; one that is an input is refused.
    pub(super) fn open(path: &Path, inputs: &[String]) -> Result<Self, Failure> {
        let elsewhere = || tempfile::NamedTempFile::new().map_err(Failure::from);
        if path == Path::new("-") {
            return Ok(Self { file: elsewhere()?, end: End::Stdout });
        }
        refuse_input(path, inputs)?;
        match fs::metadata(path) {
            Ok(m) if m.is_dir() => Err(Failure::Message(format!("{}: is a folder; expected a file", path.display()))),
            Ok(m) if !m.is_file() => Ok(Self { file: elsewhere()?, end: End::Device(path.to_owned()) }),
            found => {
                let place =
                    if found.is_ok() { fs::canonicalize(path).map_err(|e| cannot(path, &e))? } else { path.to_owned() };
                Ok(Self { file: beside(&place)?, end: End::Place(place) })
            }
        }
    }

    /// The temporary file.
    pub(super) fn file(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Moves or copies it to its place.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        let copy = |from: &mut File, to: &mut dyn Write| {
            from.rewind()?;
            io::copy(from, to)?;
            to.flush()
        };
        match self.end {
            End::Stdout => Ok(copy(self.file.as_file_mut(), &mut io::stdout().lock())?),
            End::Device(path) => {
                let mut device = OpenOptions::new().write(true).open(&path).map_err(|e| cannot(&path, &e))?;
                copy(self.file.as_file_mut(), &mut device).map_err(|e| cannot(&path, &e))
            }
            End::Place(path) => self.file.persist(&path).map(|_| ()).map_err(|e| cannot(&path, &e.error)),
        }
    }
}

/// Writes a whole file at once, under the same promises.
pub(super) fn write_file(path: &Path, bytes: &[u8], inputs: &[String]) -> Result<(), Failure> {
    let mut sink = Sink::open(Some(path), inputs)?;
    sink.write_all(bytes).map_err(|e| cannot(path, &e))?;
    sink.finish(true)
}

/// Writes whole files that belong together, under the same promises: none is moved to its place before all are written.
///
/// That none of them is an input is the caller's to see to.
pub(super) fn write_files(files: &[(PathBuf, &[u8])]) -> Result<(), Failure> {
    let mut sinks = Vec::with_capacity(files.len());
    for (path, bytes) in files {
        let mut sink = Sink::open(Some(path), &[])?;
        sink.write_all(bytes).map_err(|e| match e.kind() {
            io::ErrorKind::BrokenPipe => Failure::BrokenPipe,
            _ => cannot(path, &e),
        })?;
        sinks.push(sink);
    }
    sinks.into_iter().try_for_each(|sink| sink.finish(true))
}

fn cannot(path: &Path, error: &io::Error) -> Failure {
    Failure::Message(format!(
        "{}: cannot be written: {error}; expected a file in a folder that can be written to",
        path.display()
    ))
}

/// Whether two paths name one file, which need not exist yet.
pub(super) fn same_file(a: &Path, b: &Path) -> bool {
    let resolve = |p: &Path| {
        let folder = p.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::canonicalize(p).ok().or_else(|| Some(fs::canonicalize(folder).ok()?.join(p.file_name()?)))
    };
    resolve(a).is_some_and(|a| resolve(b) == Some(a))
}

/// Why an output that is an input is refused.
pub(super) fn overwrites(path: &Path) -> String {
    format!("{}: the output would overwrite an input; expected another file", path.display())
}

fn refuse_input(path: &Path, inputs: &[String]) -> Result<(), Failure> {
    let Ok(target) = fs::canonicalize(path) else { return Ok(()) };
    let same = inputs.iter().any(|i| fs::canonicalize(i).is_ok_and(|i| i == target));
    if same {
        return Err(Failure::Message(overwrites(path)));
    }
    Ok(())
}

fn beside(path: &Path) -> Result<tempfile::NamedTempFile, Failure> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".photopic-").suffix(".part");
    // Temporary files are private by default; a result is as readable as any file the user makes.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(|e| cannot(path, &e))
}
