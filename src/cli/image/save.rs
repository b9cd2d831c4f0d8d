//! Writing images: the ending of the name says the format.

use std::io::BufWriter;
use std::path::Path;

use clap::ValueEnum;

use crate::cli::Failure;
use crate::cli::output::Whole;
use crate::finding::Finding;
use crate::image::Source;
use crate::image::error::{Error, ErrorKind};
use crate::image::format::envi::{self, Interleave, WriteOptions};
use crate::image::format::picture::{self, Bits};
use crate::image::format::{exr, npy, radiance};

/// A format to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// OpenEXR (.exr).
    Exr,
    /// ENVI (.hdr, with the numbers beside it as .img).
    Envi,
    /// NumPy array (.npy).
    Npy,
    /// Radiance picture of RGB, XYZ or luminance (.pic; .hdr with this option).
    Radiance,
    /// PNG picture of encoded RGB (.png).
    Png,
}

/// How it is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Options {
    pub format: Format,
    pub depth: exr::Depth,
    pub interleave: Interleave,
    pub bits: Bits,
}

/// The format of a name.
pub(super) fn format_of(path: &Path, asked: Option<Format>) -> Result<Format, Failure> {
    let ending = path.extension().and_then(|e| e.to_str()).map(str::to_lowercase);
    match (asked, ending.as_deref()) {
        (Some(format), _) => Ok(format),
        (None, Some("exr")) => Ok(Format::Exr),
        (None, Some("hdr")) => Ok(Format::Envi),
        (None, Some("npy")) => Ok(Format::Npy),
        (None, Some("pic")) => Ok(Format::Radiance),
        (None, Some("png")) => Ok(Format::Png),
        (None, _) => {
            let path = path.display();
            Err(Failure::Message(format!(
                "{path}: expected a name ending in .exr, .hdr (ENVI), .npy, .pic (Radiance) or .png, or --format"
            )))
        }
    }
}

/// Writes an image beside its place and moves it there when whole.
pub(super) fn save(
    path: &Path,
    inputs: &[String],
    source: &mut dyn Source,
    options: Options,
) -> Result<Vec<Finding>, Failure> {
    // Errors of the source have a file's name; all others are of the output.
    let failed = |error: Error| {
        Failure::Message(match &error.location().path {
            Some(_) => error.to_string(),
            // Only the system's word may come from a full disk.
            None => match error.kind() {
                ErrorKind::Io { .. } => {
                    format!("{}: cannot be written: {error}; expected room on the disk", path.display())
                }
                _ => format!("{}: cannot be written: {error}", path.display()),
            },
        })
    };
    let mut whole = Whole::open(path, inputs)?;
    let mut findings = match options.format {
        Format::Exr => {
            let out = BufWriter::with_capacity(1 << 18, whole.file());
            exr::write(out, source, options.depth).map_err(failed)?
        }
        Format::Npy => npy::write(whole.file(), source).map_err(failed)?,
        Format::Radiance => radiance::write(BufWriter::new(whole.file()), source).map_err(failed)?,
        Format::Png => picture::write_png(BufWriter::new(whole.file()), source, options.bits).map_err(failed)?,
        Format::Envi => {
            if path == Path::new("-") {
                let message = "an ENVI image is two files; expected a name for them instead of `-`";
                return Err(Failure::Message(message.to_owned()));
            }
            let place = path.with_extension("img");
            let mut data = Whole::open(&place, inputs)?;
            let write = WriteOptions { interleave: options.interleave, ..WriteOptions::default() };
            let findings = envi::write(whole.file(), data.file(), source, write).map_err(failed)?;
            // The header comes last: without it there is no image.
            data.finish()?;
            findings
        }
    };
    whole.finish()?;
    findings.extend(source.findings());
    Ok(findings)
}
