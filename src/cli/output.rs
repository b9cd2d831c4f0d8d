//! Where results go: standard output, or a file written beside its place and moved there when whole.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::Failure;

/// The destination of a run's results.
pub(super) enum Sink {
    /// Standard output.
    Stdout(BufWriter<io::StdoutLock<'static>>),
    /// A temporary file beside the destination.
    File(BufWriter<tempfile::NamedTempFile>, PathBuf),
}

impl Sink {
    /// Opens the destination; `-` and `None` are standard output.
    ///
    /// A destination that is one of the inputs is refused.
    pub(super) fn open(path: Option<&Path>, inputs: &[String]) -> Result<Self, Failure> {
        let Some(path) = path.filter(|p| *p != Path::new("-")) else {
            return Ok(Self::Stdout(BufWriter::with_capacity(1 << 16, io::stdout().lock())));
        };
        refuse_input(path, inputs)?;
        let file = beside(path)?;
        Ok(Self::File(BufWriter::with_capacity(1 << 16, file), path.to_owned()))
    }

    /// Flushes, and moves a file to its place.
    pub(super) fn finish(self) -> Result<(), Failure> {
        match self {
            Self::Stdout(mut out) => Ok(out.flush()?),
            Self::File(out, path) => {
                let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
                place(file, &path)
            }
        }
    }
}

impl Write for Sink {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stdout(out) => out.write(buffer),
            Self::File(out, _) => out.write(buffer),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(out) => out.flush(),
            Self::File(out, _) => out.flush(),
        }
    }
}

/// Writes a whole file at once, under the same promises.
pub(super) fn write_file(path: &Path, bytes: &[u8], inputs: &[String]) -> Result<(), Failure> {
    refuse_input(path, inputs)?;
    let mut file = beside(path)?;
    file.write_all(bytes).map_err(|e| Failure::Message(format!("{}: cannot be written: {e}", path.display())))?;
    place(file, path)
}

fn refuse_input(path: &Path, inputs: &[String]) -> Result<(), Failure> {
    let Ok(target) = fs::canonicalize(path) else { return Ok(()) };
    let same = inputs.iter().any(|i| fs::canonicalize(i).is_ok_and(|i| i == target));
    if same {
        let message = format!("{}: the output would overwrite an input; expected another file", path.display());
        return Err(Failure::Message(message));
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
    builder.tempfile_in(folder).map_err(|e| {
        Failure::Message(format!(
            "{}: cannot be written: {e}; expected a folder that can be written to",
            path.display()
        ))
    })
}

fn place(file: tempfile::NamedTempFile, path: &Path) -> Result<(), Failure> {
    file.persist(path)
        .map(|_| ())
        .map_err(|e| Failure::Message(format!("{}: cannot be written: {}", path.display(), e.error)))
}
