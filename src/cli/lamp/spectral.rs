//! `lamp spectral`: a lamp's intensities with its spectrum.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::load::load;
use crate::cli::convert::{Single, format_of, length, single};
use crate::cli::notes::Notes;
use crate::cli::output::{self, Sink};
use crate::cli::{Failure, Talk};
use crate::conversion::{Converter, Settings};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::format::{eulumdat, ies, tm33};
use crate::luminaire::spectral::{SpectralLamp, by_direction, combine};
use crate::luminaire::{Kind, Luminaire};
use crate::photometry::transfer::Geometry;
use crate::plot;
use crate::report::conversion as report;
use crate::report::envelope::Envelope;
use crate::report::lamp::{Context, Source, spectral as result, spectral_header, spectral_rows, spectral_text};

/// Arguments of `lamp spectral`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic lamp spectral downlight.ies LED-B3
  photopic lamp spectral downlight.ldt lamp.spdx --distance 2m
  photopic lamp spectral far-uv.ies line:222nm                     (W/sr weighted with the actinic hazard)
  photopic lamp spectral downlight.ies LED-B3 -o downlight.xml     (TM-33-23 with the spectrum)
  photopic lamp spectral grow.ies grow.csv --quantity photon -o grow.xml
  photopic lamp spectral goniospectral.xml --plot colour.svg       (its own angular spectra)")]
pub(in crate::cli) struct SpectralArgs {
    /// A lamp file (IES LM-63, EULUMDAT, TM-33), or `-`.
    #[arg(value_name = "FILE")]
    file: String,
    /// Its spectrum, of which only the shape counts: a file, or a source by name (LED-B3, D65, blackbody:2700K, line:222nm); by
    /// default the lamp file's own.
    #[arg(value_name = "SPD")]
    spd: Option<String>,
    /// Take the spectrum of this name from a file of several.
    #[arg(long, value_name = "NAME", requires = "spd")]
    select: Option<String>,
    /// Distance on the peak's axis, such as 2m, at which irradiance and illuminance are given.
    #[arg(long, value_parser = length)]
    distance: Option<f64>,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table: a row per direction.
    #[arg(long)]
    csv: bool,
    /// Write the lamp with its spectrum: .xml (TM-33-23); .ies or .ldt carry the intensities alone.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Quantity of the intensities written by --output; by default that of the file.
    #[arg(long, value_enum, requires = "output")]
    quantity: Option<KindArg>,
    /// Draw colour over angle (files with angular spectra): a .svg or .png file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum KindArg {
    /// cd.
    Luminous,
    /// W/sr.
    Radiant,
    /// µmol/(s·sr), photons of all wavelengths.
    Photon,
}

impl From<KindArg> for Kind {
    fn from(kind: KindArg) -> Self {
        match kind {
            KindArg::Luminous => Self::Luminous,
            KindArg::Radiant => Self::Radiant,
            KindArg::Photon => Self::Photon,
        }
    }
}

pub(super) fn spectral(arguments: &SpectralArgs, talk: Talk) -> Result<(), Failure> {
    let inputs: Vec<String> = [Some(arguments.file.clone()), arguments.spd.clone()].into_iter().flatten().collect();
    if inputs.len() == 2 && inputs.iter().all(|i| i == "-") {
        return Err(Failure::Message("`-` given twice; expected standard input once".into()));
    }
    let picture = arguments.plot.as_deref().map(format_of).transpose()?;
    let form = arguments.output.as_deref().map(LampFormat::of).transpose()?;
    let geometry = Geometry { distance_m: arguments.distance, ..Geometry::default() };
    geometry.check().map_err(|e| Failure::Message(e.to_string()))?;
    let settings = Settings::default();
    let converter = Converter::new(settings.clone());
    let notes = Notes::new(&inputs, talk);
    let mut shown = report::settings(&Settings { geometry, ..settings.clone() });
    shown["repair"] = arguments.repair.into();
    let mut envelope = Envelope::begin(Vec::new(), "lamp spectral", &shown)?;

    let loaded = load(&arguments.file, arguments.repair);
    envelope.input(loaded.input);
    let Checked { value: file, findings } = match loaded.file {
        Ok(file) => file,
        Err((message, finding)) => return refused(arguments, envelope, &notes, &message, *finding),
    };
    let lamp = file.luminaire;
    let mut all = findings;
    let given = match &arguments.spd {
        None => None,
        Some(spd) => match single(spd, arguments.select.as_deref(), None, settings.c2) {
            Ok(Single { measured, input, findings, .. }) => {
                envelope.input(input);
                // That a spectrum is relative does not matter here.
                all.extend(findings.into_iter().filter(|f| !matches!(f.code, "S010" | "P001")));
                Some(measured)
            }
            Err(why) => return refused(arguments, envelope, &notes, &why.message, *why.finding),
        },
    };
    let (name, source) = match (&given, &lamp.angular_spectra) {
        (Some(measured), _) => (measured.name.clone(), Source::Given),
        (None, Some(_)) => ("angular spectra".to_owned(), Source::Angular),
        (None, None) => ("own spectrum".to_owned(), Source::Own),
    };
    let made = match (&given, &lamp.angular_spectra, &lamp.spectrum) {
        (Some(measured), ..) => combine(&lamp, &name, &measured.spectrum, &converter, &geometry),
        (None, Some(spectra), _) => by_direction(spectra, &name, &converter, &geometry),
        (None, None, Some(spectrum)) => combine(&lamp, &name, spectrum, &converter, &geometry),
        (None, None, None) => {
            let why = "the file has no spectrum; expected one as second argument, such as LED-B3 or a file";
            return refused_lamp(arguments, envelope, &notes, why);
        }
    };
    let combined = match made {
        Ok(Checked { value, findings }) => {
            let place = Location::default().in_file(arguments.spd.as_deref().unwrap_or(&arguments.file));
            // The steps of a tabulated illuminant are its definition, not a coarse measurement of it.
            let defined = arguments.spd.as_deref().is_some_and(|s| s != "-" && !Path::new(s).exists());
            for mut finding in findings.into_iter().filter(|f| !(defined && f.code == "P003")) {
                if finding.code == "P003" {
                    // The hint of `convert` names options of its own.
                    finding.hint = Some("measure with smaller steps".to_owned());
                }
                all.push(finding.at(place.clone()));
            }
            value
        }
        Err(why) => return refused_lamp(arguments, envelope, &notes, &why.to_string()),
    };
    let context = Context { path: &arguments.file, lamp: &lamp, spectrum: &name, source, settings: &settings };
    envelope.result(&result(&context, &combined).into())?;
    if let (Some(path), Some(form)) = (&arguments.output, form) {
        let kind = arguments.quantity.map_or(lamp.kind, Kind::from);
        let lamp = combined.luminaire(&lamp, kind).map_err(|e| Failure::Message(format!("{}: {e}", arguments.file)))?;
        let Checked { value, findings } =
            form.write(&lamp).map_err(|e| Failure::Message(format!("{}: {e}", path.display())))?;
        output::write_file(path, value.as_bytes(), &inputs)?;
        all.extend(findings);
    }
    if let (Some(path), Some(format)) = (&arguments.plot, picture) {
        output::write_file(path, &draw(&arguments.file, &combined, format)?, &inputs)?;
    }
    notes.print(&all);
    all.into_iter().for_each(|f| envelope.finding(f));
    let document = envelope.end()?;
    let mut sink = Sink::open(None, &inputs)?;
    if arguments.json {
        sink.write_all(&document)?;
    } else if arguments.csv {
        sink.write_all(&table(&combined)?)?;
    } else {
        sink.write_all(spectral_text(&context, &combined).as_bytes())?;
    }
    sink.finish(true)
}

/// Ends a run without a result: the error on standard error, and in the JSON document where one is asked for.
fn refused(
    arguments: &SpectralArgs,
    mut envelope: Envelope<Vec<u8>>,
    notes: &Notes,
    message: &str,
    finding: Finding,
) -> Result<(), Failure> {
    notes.say(message);
    envelope.finding(finding);
    if arguments.json {
        let mut sink = Sink::open(None, &[])?;
        sink.write_all(&envelope.end()?)?;
        sink.finish(true)?;
    }
    Err(Failure::Reported)
}

fn refused_lamp(
    arguments: &SpectralArgs,
    envelope: Envelope<Vec<u8>>,
    notes: &Notes,
    why: &str,
) -> Result<(), Failure> {
    let finding = Finding::error("L000", why).at(Location::default().in_file(&arguments.file));
    refused(arguments, envelope, notes, &format!("{}: {why}", arguments.file), finding)
}

fn table(lamp: &SpectralLamp) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |e: csv::Error| Failure::Message(e.to_string());
    writer.write_record(spectral_header()).map_err(failed)?;
    for row in spectral_rows(lamp) {
        writer.write_record(row).map_err(failed)?;
    }
    writer.into_inner().map_err(|e| Failure::Message(e.to_string()))
}

fn draw(path: &str, lamp: &SpectralLamp, format: plot::Format) -> Result<Vec<u8>, Failure> {
    let fail = |message: String| Failure::Message(format!("--plot: {message}"));
    let name = Path::new(path).file_stem().map_or(path.into(), |s| s.to_string_lossy());
    let panel = plot::colour_angle::panel(&name, lamp).ok_or_else(|| {
        fail(
            "one spectrum in all directions has no colour over angle; expected a file with angular spectra and no SPD"
                .into(),
        )
    })?;
    plot::draw(&[panel.into()], None, format).map_err(|e| fail(e.to_string()))
}

/// The lamp formats that can be written.
#[derive(Debug, Clone, Copy)]
enum LampFormat {
    Ies,
    Eulumdat,
    Tm33,
}

impl LampFormat {
    fn of(path: &Path) -> Result<Self, Failure> {
        match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
            Some("ies") => Ok(Self::Ies),
            Some("ldt") => Ok(Self::Eulumdat),
            Some("xml") => Ok(Self::Tm33),
            _ => {
                let message = format!("{}: expected a name ending in .xml, .ies or .ldt", path.display());
                Err(Failure::Message(message))
            }
        }
    }

    fn write(self, lamp: &Luminaire) -> Result<Checked<String>, crate::luminaire::format::Error> {
        match self {
            Self::Ies => ies::write(lamp, ies::Version::Lm63_2019),
            Self::Eulumdat => eulumdat::write(lamp),
            Self::Tm33 => tm33::write(lamp),
        }
    }
}
