//! `image convert`.

use std::fs;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::open::{Reading, Watched, open};
use super::save::{Format, Options, format_of, save};
use super::settings::ReductionArgs;
use crate::cli::convert::{RuleArg, positive, range_nm};
use crate::cli::notes::Notes;
use crate::cli::{Failure, Talk};
use crate::colorimetry::Observer;
use crate::colorimetry::adaptation::Transform;
use crate::colorimetry::rgb::{ACESCG, DISPLAY_P3, RADIANCE, REC2020, SRGB, Space};
use crate::constants::{K_M, K_M_SCOTOPIC, SecondRadiation};
use crate::finding::Location;
use crate::illuminant::named;
use crate::image::format::envi::Interleave;
use crate::image::format::exr::Depth;
use crate::image::format::picture::Bits;
use crate::image::tone::{self, Operator};
use crate::image::{Beside, Content, Converted, Plan, PlanError, Settings, Source, Target, Toned};
use crate::photometry::luminous::{Efficacy, Efficiency};
use crate::spectrum::format::{ReadOptions, read};
use crate::spectrum::integrate::{Contract, Weighting};
use crate::spectrum::{Quantity, SpectralUnit, Spectrum};

/// Arguments of `image convert`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic image convert cube.hdr -o luminance.exr
  photopic image convert render.exr -o xyz.exr --to xyz --observer cie-1964-10deg
  photopic image convert leaf.hdr -o leaf.exr --to srgb --illuminant D65
  photopic image convert cube.hdr -o cube.exr --to cube       (another format, with RGB beside the spectra)
  photopic image convert cube.hdr -o small.exr --to cube --bands 16 --block 2
  photopic image convert scene.hdr -o xyz.exr --to xyz        (a Radiance picture: 179 cd/m2 per unit)
  photopic image convert photo.png -o y.exr --white-luminance 250
  photopic image convert render.exr -o render.pic             (Radiance RGB, absolute)
  photopic image convert render.exr -o view.png --tone reinhard --key 0.18
  photopic image convert 4*nm.tif 5*nm.tif 6*nm.tif -o y.exr --dark 64 --gain 1.5e-5 --unit W/m2/sr/nm")]
pub(in crate::cli) struct ConvertArgs {
    /// An image (spectral, RGB or luminance EXR, ENVI header or data, NPY, Radiance, PNG, JPEG, TIFF), a folder or a list of grey
    /// pictures, or `-` for standard input.
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<String>,
    /// The file to write; its ending says the format: .exr, .hdr (ENVI; Radiance with --format radiance), .npy, .pic (Radiance), .png.
    /// `-` with --format is standard output.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// What to make of the bands, or of RGB, XYZ and luminance; by default luminance, for Radiance pictures its linear RGB, for
    /// PNG encoded sRGB.
    #[arg(long, value_enum, value_name = "PLANES", conflicts_with = "weighting")]
    to: Option<To>,
    /// A weighting of your own: a CSV file of wavelength (nm) and value; the result is the integral of both.
    #[arg(long, value_name = "FILE")]
    weighting: Option<String>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    meaning: MeaningArgs,
    #[command(flatten)]
    reduction: ReductionArgs,
    #[command(flatten)]
    tone: ToneArgs,
    #[command(flatten)]
    writing: Writing,
}

/// What is done so that a picture can be looked at.
#[derive(Debug, Args)]
#[command(next_help_heading = "Tone mapping (encoded RGB only, the last step)")]
struct ToneArgs {
    /// Operator.
    #[arg(long, value_enum)]
    tone: Option<ToneArg>,
    /// Exposure in stops.
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, requires = "tone")]
    exposure_ev: f64,
    /// What the log-average luminance is shown as: 0.18 by default with reinhard and filmic; linear leaves white where it is.
    #[arg(long, value_name = "KEY", value_parser = positive, requires = "tone")]
    key: Option<f64>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ToneArg {
    /// Exposure alone; what is brighter than white is cut.
    Linear,
    /// Reinhard et al., SIGGRAPH 2002, global.
    Reinhard,
    /// Hable's curve, GDC 2010.
    Filmic,
}

/// What the samples are, and how they are weighted.
#[derive(Debug, Args)]
#[command(next_help_heading = "Photometry and colour")]
pub(in crate::cli) struct MeaningArgs {
    /// What the samples are of, where the file does not say: radiance, irradiance, exitance, …, relative.
    #[arg(long, value_name = "QUANTITY")]
    quantity: Option<Quantity>,
    /// Unit of the samples, such as W/m2/sr/nm or uW/cm2/sr/nm.
    #[arg(long)]
    unit: Option<SpectralUnit>,
    /// Light on an image of reflectance: a source by name (D65, A, LED-B3, blackbody:2856K) or a spectrum file.
    #[arg(long, value_name = "NAME|FILE")]
    illuminant: Option<String>,
    /// Observer of --to xyz: cie-1931-2deg, cie-1964-10deg, cie-2015-2deg, cie-2015-10deg.
    #[arg(long, value_name = "NAME", default_value_t)]
    pub observer: Observer,
    /// Luminous efficiency function of --to luminance: cie-1924-v, judd-1951-v, judd-vos-1978-v, cie-1964-v10, cie-2008-v-2deg,
    /// cie-2008-v-10deg.
    #[arg(long, value_name = "NAME", default_value_t)]
    pub efficiency: Efficiency,
    /// Luminance (cd/m2) of RGB (1, 1, 1): of the output, and of an input that does not state its own; for reflectance, of the
    /// perfect diffuser.
    #[arg(long, value_name = "CD_PER_M2", value_parser = positive)]
    white_luminance: Option<f64>,
    /// Chromatic adaptation of RGB from the illuminant of a reflectance image, or from the white of another RGB space: bradford,
    /// cat16, none.
    #[arg(long, default_value = "bradford")]
    adaptation: Transform,
    /// Rule; by default CIE 15 summation on equal steps up to 5 nm, else the exact integral of straight lines.
    #[arg(long, value_enum)]
    rule: Option<RuleArg>,
    /// Wavelengths that count, such as 380-780 (nm); by default all there are.
    #[arg(long, value_name = "LOW-HIGH", value_parser = range_nm)]
    range: Option<(f64, f64)>,
    /// K_m in lm/W.
    #[arg(long, value_name = "LM_PER_W", default_value_t = K_M, value_parser = positive)]
    k_m: f64,
    /// K'_m in lm/W.
    #[arg(long, value_name = "LM_PER_W", default_value_t = K_M_SCOTOPIC, value_parser = positive)]
    k_m_scotopic: f64,
}

/// How the output is written.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
struct Writing {
    /// Format, where the name does not say it.
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// EXR: 16-bit floats; what they cannot hold is cut and told.
    #[arg(long)]
    half: bool,
    /// ENVI: order of the numbers.
    #[arg(long, value_enum, default_value = "bil")]
    interleave: InterleaveArg,
    /// PNG: 16 bits per sample instead of 8.
    #[arg(long)]
    sixteen_bit: bool,
    /// EXR with --to cube: without R, G, B beside the spectral channels.
    #[arg(long)]
    no_rgb: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum InterleaveArg {
    /// Band after band.
    Bsq,
    /// Row after row, in it band after band.
    Bil,
    /// Pixel after pixel.
    Bip,
}

/// What to make of the bands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum To {
    /// Luminance (cd/m2) of radiance, illuminance (lx) of irradiance.
    Luminance,
    /// The scotopic quantity.
    Scotopic,
    /// Tristimulus values.
    Xyz,
    /// Linear sRGB; (1, 1, 1) is --white-luminance; by default that of an RGB image, and 1 cd/m2 of others.
    Srgb,
    /// Encoded sRGB.
    SrgbEncoded,
    /// Linear Display P3.
    DisplayP3,
    /// Encoded Display P3.
    DisplayP3Encoded,
    /// Linear Rec. 2020.
    Rec2020,
    /// Encoded Rec. 2020.
    Rec2020Encoded,
    /// ACEScg, linear.
    Acescg,
    /// Radiance's linear RGB with the equal-energy white.
    Radiance,
    /// CIE S 026, S-cone-opic, W/m2/sr.
    SConeOpic,
    /// M-cone-opic.
    MConeOpic,
    /// L-cone-opic.
    LConeOpic,
    /// Rhodopic.
    Rhodopic,
    /// Melanopic.
    Melanopic,
    /// Melanopic equivalent daylight (D65) luminance or illuminance.
    MelanopicEdi,
    /// Every channel as it is, in another format.
    Cube,
}

impl To {
    fn target(self, meaning: &MeaningArgs) -> Option<Target> {
        let rgb = |space: Space, encoded| Some(Target::Rgb { space, encoded });
        let opic = |receptor, equivalent_daylight| Some(Target::AlphaOpic { receptor, equivalent_daylight });
        match self {
            Self::Luminance => Some(Target::Luminance(meaning.efficiency)),
            Self::Scotopic => Some(Target::Scotopic),
            Self::Xyz => Some(Target::Xyz(meaning.observer)),
            Self::Srgb => rgb(SRGB, false),
            Self::SrgbEncoded => rgb(SRGB, true),
            Self::DisplayP3 => rgb(DISPLAY_P3, false),
            Self::DisplayP3Encoded => rgb(DISPLAY_P3, true),
            Self::Rec2020 => rgb(REC2020, false),
            Self::Rec2020Encoded => rgb(REC2020, true),
            Self::Acescg => rgb(ACESCG, false),
            Self::Radiance => rgb(RADIANCE, false),
            Self::SConeOpic => opic(0, false),
            Self::MConeOpic => opic(1, false),
            Self::LConeOpic => opic(2, false),
            Self::Rhodopic => opic(3, false),
            Self::Melanopic => opic(4, false),
            Self::MelanopicEdi => opic(4, true),
            Self::Cube => None,
        }
    }
}

/// The first spectrum of a file.
fn spectrum(path: &str) -> Result<Spectrum, Failure> {
    let bytes = fs::read(path).map_err(|e| Failure::Message(format!("{path}: cannot be read: {e}")))?;
    let file = read(&bytes, &ReadOptions::default()).map_err(|e| Failure::Message(e.in_file(path).to_string()))?;
    match file.value.entries.into_iter().next() {
        Some(entry) => Ok(entry.spectrum),
        None => Err(Failure::Message(format!("{path}: found no spectrum; expected one"))),
    }
}

impl MeaningArgs {
    /// The settings of a plan.
    pub(in crate::cli) fn settings(&self) -> Result<Settings, Failure> {
        let m = self;
        let light = |name: &String| {
            let spectrum = if named::is_name(name) {
                let source = named::source(name, SecondRadiation::default());
                source.map_err(|e| Failure::Message(format!("--illuminant {name}: {e}")))?.spectrum
            } else {
                spectrum(name)?
            };
            Ok::<_, Failure>((name.clone(), spectrum))
        };
        Ok(Settings {
            contract: Contract { rule: m.rule.map(Into::into), range_nm: m.range },
            efficacy: Efficacy { k_m: m.k_m, k_m_scotopic: m.k_m_scotopic },
            quantity: m.quantity,
            unit: m.unit.clone(),
            illuminant: m.illuminant.as_ref().map(light).transpose()?,
            white_luminance: m.white_luminance,
            adaptation: m.adaptation,
        })
    }
}

impl ConvertArgs {
    fn target(&self, format: Format) -> Result<Option<Target>, Failure> {
        let Some(path) = &self.weighting else {
            let usual = match format {
                Format::Radiance => To::Radiance,
                Format::Png => To::SrgbEncoded,
                Format::Exr | Format::Envi | Format::Npy => To::Luminance,
            };
            return Ok(self.to.unwrap_or(usual).target(&self.meaning));
        };
        let spectrum = spectrum(path)?;
        if spectrum.values().len() < 2 {
            return Err(Failure::Message(format!("{path}: found one value; expected a weighting of at least two")));
        }
        let weighting = Weighting::table(spectrum.wavelengths_nm().to_vec(), spectrum.values().to_vec());
        let stem = std::path::Path::new(path).file_stem().map_or("weighted".into(), |s| s.to_string_lossy());
        Ok(Some(Target::Weighting { name: stem.into_owned(), weighting }))
    }
}

pub(super) fn convert(arguments: &ConvertArgs, talk: Talk) -> Result<(), Failure> {
    let notes = Notes::new(&arguments.images, talk);
    let reduction = arguments.reduction.read()?;
    let options = Options {
        format: format_of(&arguments.output, arguments.writing.format)?,
        depth: if arguments.writing.half || reduction.half { Depth::Half } else { Depth::Float },
        interleave: match arguments.writing.interleave {
            InterleaveArg::Bsq => Interleave::Bsq,
            InterleaveArg::Bil => Interleave::Bil,
            InterleaveArg::Bip => Interleave::Bip,
        },
        bits: if arguments.writing.sixteen_bit { Bits::Sixteen } else { Bits::Eight },
    };
    let (settings, target) = (arguments.meaning.settings()?, arguments.target(options.format)?);
    let tone = arguments.tone.settings(target.as_ref())?;
    let opened = open(&arguments.images, &arguments.reading)?;
    notes.print(&opened.findings);
    let path = opened.path;
    let refused = |error: PlanError| Failure::Message(format!("{path}: {error}"));
    let watched = Watched { source: opened.source, progress: notes.progress.clone() };
    let source = reduction.of(Box::new(watched), &path)?;
    let mut source: Box<dyn Source> = match target {
        Some(target) => {
            if tone.is_some_and(|tone| tone.key.is_none()) {
                // Without a key white stays white, so that somebody has to say what white is.
                Plan::new(source.description(), &target, &settings).map_err(refused)?;
            }
            let linear = tone.and_then(|_| without_curve(&target));
            let plan =
                Plan::new(source.description(), linear.as_ref().unwrap_or(&target), &settings).map_err(refused)?;
            let place = Location::default().in_file(&path);
            notes.print(&plan.findings.into_iter().map(|f| f.at(place.clone())).collect::<Vec<_>>());
            let converted = Converted::new(source, plan.value);
            match tone {
                Some(tone) => {
                    let toned = Toned::new(converted, tone);
                    Box::new(toned.map_err(|e| Failure::Message(e.in_file(&path).to_string()))?)
                }
                None => Box::new(converted),
            }
        }
        None if source.description().bands().is_empty() && settings.white_luminance.is_some() => {
            let message = "--to cube leaves samples as they are; expected no --white-luminance, or --to srgb or xyz";
            return Err(Failure::Message(format!("{path}: {message}")));
        }
        None => cube(source, arguments, &settings, options.format).map_err(refused)?,
    };
    let read: Vec<String> = opened.files.into_iter().chain(arguments.reduction.file()).collect();
    let findings = save(&arguments.output, &read, &mut source, options)?;
    notes.progress.finish_and_clear();
    notes.print(&findings);
    Ok(())
}

impl ToneArgs {
    /// What is asked for; refused for anything but encoded RGB.
    fn settings(&self, target: Option<&Target>) -> Result<Option<tone::Settings>, Failure> {
        let Some(tone) = self.tone else { return Ok(None) };
        if !matches!(target, Some(Target::Rgb { encoded: true, .. })) {
            let target = target.map_or("a cube".to_owned(), Target::to_string);
            let message = format!(
                "--tone: found {target}, a measurement; tone mapping is for pictures to look at: expected --to srgb-encoded, \
                 display-p3-encoded or rec2020-encoded"
            );
            return Err(Failure::Message(message));
        }
        let operator = match tone {
            ToneArg::Linear => Operator::Linear,
            ToneArg::Reinhard => Operator::Reinhard,
            ToneArg::Filmic => Operator::Filmic,
        };
        if !self.exposure_ev.is_finite() {
            return Err(Failure::Message("--exposure-ev: expected a finite number of stops".to_owned()));
        }
        let usual = if operator == Operator::Linear { None } else { Some(USUAL_KEY) };
        Ok(Some(tone::Settings { operator, exposure_ev: self.exposure_ev, key: self.key.or(usual) }))
    }
}

/// Middle grey, as in Reinhard et al. 2002.
const USUAL_KEY: f64 = 0.18;

/// The linear target before a tone curve.
fn without_curve(target: &Target) -> Option<Target> {
    match target {
        Target::Rgb { space, .. } => Some(Target::Rgb { space: *space, encoded: false }),
        _ => None,
    }
}

/// Every channel as it is; in an EXR with linear sRGB beside the spectra, so that any viewer shows something.
fn cube(
    source: Box<dyn Source>,
    arguments: &ConvertArgs,
    settings: &Settings,
    format: Format,
) -> Result<Box<dyn Source>, PlanError> {
    let description = source.description();
    let mut settings = settings.clone();
    if description.content == Content::Reflectance && settings.illuminant.is_none() {
        // The layout's own programs show reflectance under D65.
        let d65 = named::source("D65", SecondRadiation::default());
        settings.illuminant = d65.ok().map(|d65| (d65.name, d65.spectrum));
    }
    let wanted = format == Format::Exr && !arguments.writing.no_rgb && !description.bands().is_empty();
    let target = Target::Rgb { space: SRGB, encoded: false };
    match Plan::new(description, &target, &settings) {
        Ok(plan) if wanted => Ok(Box::new(Beside::new(source, plan.value))),
        // Bands beyond the visible have no colour to show.
        Ok(_) | Err(PlanError::Outside { .. } | PlanError::NoBands { .. }) => Ok(source),
        Err(error) => Err(error),
    }
}
