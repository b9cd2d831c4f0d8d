//! The formats that `lamp convert` writes.

use std::path::Path;

use clap::ValueEnum;

use crate::finding::{Checked, Finding};
use crate::luminaire::export::{self, ExportFile};
use crate::luminaire::format::{Format, eulumdat, ies, tm33};
use crate::luminaire::{Kind, Luminaire, Symmetry};

/// A format to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Target {
    /// IES LM-63.
    Ies,
    /// EULUMDAT.
    Ldt,
    /// TM-33-23.
    Xml,
    /// The intensity table, with comments.
    Csv,
    /// Radiance: .rad and .dat.
    Rad,
    /// pbrt-v4: .pbrt and .exr.
    Pbrt,
    /// Mitsuba 3: .xml and up to six .exr.
    Mitsuba,
    /// An equirectangular picture of the intensity.
    Exr,
}

/// What decides how a lamp is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    pub(super) target: Target,
    /// Edition of LM-63.
    pub(super) lm63: ies::Version,
    /// Pixels on a side of pictures.
    pub(super) pixels: Option<usize>,
}

impl Target {
    /// The format that a file name's ending means.
    pub(super) fn of_name(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        Self::value_variants().iter().copied().find(|t| *t != Self::Mitsuba && t.ending() == ending)
    }

    /// The ending of its main file.
    pub(super) fn ending(self) -> &'static str {
        match self {
            Self::Ies => "ies",
            Self::Ldt => "ldt",
            Self::Xml | Self::Mitsuba => "xml",
            Self::Csv => "csv",
            Self::Rad => "rad",
            Self::Pbrt => "pbrt",
            Self::Exr => "exr",
        }
    }

    /// Whether it is one file, which can go to standard output.
    pub(super) fn is_one_file(self) -> bool {
        !matches!(self, Self::Rad | Self::Pbrt | Self::Mitsuba)
    }
}

/// The files of a lamp, the main one first; `stem` is what their names begin with.
pub(super) fn encode(
    lamp: &Luminaire,
    from: Format,
    stem: &str,
    choice: Choice,
) -> Result<Checked<Vec<ExportFile>>, String> {
    let one = |written: Checked<String>, statement: Finding| {
        let mut files = written.map(|text| {
            let suffix = format!(".{}", choice.target.ending());
            vec![ExportFile { suffix, bytes: text.into_bytes() }]
        });
        files.findings.insert(0, statement);
        files
    };
    let exported = match choice.target {
        Target::Ies => {
            let written = ies::write(lamp, choice.lm63).map_err(|e| e.to_string())?;
            return Ok(one(written, stated(lamp, from, Format::Ies, &choice.lm63.to_string())));
        }
        Target::Ldt => {
            let written = eulumdat::write(lamp).map_err(|e| e.to_string())?;
            return Ok(one(written, stated(lamp, from, Format::Eulumdat, "EULUMDAT")));
        }
        Target::Xml => {
            let written = tm33::write(lamp).map_err(|e| e.to_string())?;
            return Ok(one(written, stated(lamp, from, Format::Tm33, "TM-33-23")));
        }
        Target::Csv => export::csv::write(lamp),
        Target::Rad => export::radiance::write(lamp, stem),
        Target::Pbrt => export::pbrt::write(lamp, stem, choice.pixels),
        Target::Mitsuba => export::mitsuba::write(lamp, stem, choice.pixels),
        Target::Exr => export::equirectangular::write(lamp, choice.pixels),
    };
    exported.map_err(|e| e.to_string())
}

/// The finding that states what was written: edition, scaling, and what became of the C-planes.
///
/// All formats keep the C-planes, so that the light stays where it is about the luminaire's axes. What differs is the name of the
/// housing's sides: the length of EULUMDAT and TM-33 lies along C90–C270, that of LM-63 along C0–C180. Programs that line
/// lamps up by their length therefore turn one of the two by 90°.
fn stated(lamp: &Luminaire, from: Format, to: Format, edition: &str) -> Finding {
    let scaling = match (lamp.kind, lamp.absolute) {
        (Kind::Luminous, false) => "relative photometry (scaled to the flux of the lamps)",
        _ => "absolute photometry",
    };
    let message = format!("written as {edition}, {scaling}");
    let renamed = (from == Format::Ies) != (to == Format::Ies);
    if !renamed || lamp.distribution.symmetry() == Symmetry::Rotational {
        return Finding::info("L510", message);
    }
    let (lengthwise, crosswise) = if to == Format::Ies { ("width", "length") } else { ("length", "width") };
    let message = format!(
        "{message}; the C-planes are those of the {from} file, not turned by 90°: {to} calls the extent along C0–C180 \
         {crosswise} and that along C90–C270 {lengthwise}, {from} the other way round"
    );
    Finding::info("L510", message).hint("programs that line lamps up by their length may show it turned by 90°")
}
