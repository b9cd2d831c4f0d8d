//! `image falsecolor`.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::convert::MeaningArgs;
use super::look::{When, look};
use super::open::Reading;
use super::seen::{Look, Seen, settings_json};
use crate::cli::notes::Notes;
use crate::cli::output::write_file;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::image::Picture;
use crate::plot::luminance::{End, FalseColour};
use crate::plot::{ColourMap, Format, Panel, SIDES, draw};
use crate::report::envelope::Envelope;
use crate::report::image as report;

/// Arguments of `image falsecolor`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  photopic image falsecolor render.exr -o nits.png
  photopic image falsecolor room.hdr -o room.png --scale log --limits 1:10000 --contours=10,100,1000
  photopic image falsecolor display.exr -o display.svg --scale linear --limits 0:99.5% --map inferno
  photopic image falsecolor leaf.hdr -o leaf.png --illuminant D65 --white-luminance 100
  photopic image falsecolor cube.hdr                          (a quick look in the terminal)")]
pub(in crate::cli) struct FalsecolorArgs {
    /// An image (spectral EXR, ENVI header or data, NPY), a folder or a list of grey pictures, or `-` for standard input.
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<String>,
    /// The picture to write; its ending says the format: .png or .svg. Without it the image is shown in the terminal.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    colours: Colours,
    /// Columns of the picture; wider images are averaged over areas.
    #[arg(long, value_name = "PIXELS", default_value_t = 1200, value_parser = clap::value_parser!(u32).range(16..=8000))]
    width: u32,
    /// Title; by default the image's name and quantity.
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Show it in the terminal; `--look=always` in a pipe, too.
    #[arg(long, value_enum, value_name = "WHEN", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    look: Option<When>,
    /// One JSON document: what the colours stand for.
    #[arg(long, conflicts_with = "look", requires = "output")]
    json: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    meaning: MeaningArgs,
}

/// How values become colours.
#[derive(Debug, Args)]
#[command(next_help_heading = "Colours")]
pub(super) struct Colours {
    /// Scale of the colours; auto is logarithmic where the brightest thousandth has over 20 times the median.
    #[arg(long, value_enum, default_value = "auto")]
    scale: ScaleArg,
    /// What the first and the last colour stand for: values, percentiles such as 1%, or nothing for the smallest and the largest
    /// value (of a logarithmic scale at most six decades).
    #[arg(long, value_name = "LOW:HIGH", value_parser = ends, allow_hyphen_values = true)]
    limits: Option<Ends>,
    /// Contour lines at round values, or at those given, such as --contours=100,300,1000.
    #[arg(long, value_name = "VALUE,…", num_args = 0..=1, require_equals = true, value_parser = levels, default_missing_value = "")]
    contours: Option<Levels>,
    /// Colours.
    #[arg(long, value_enum, default_value = "viridis")]
    map: MapArg,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ScaleArg {
    Auto,
    Linear,
    Log,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MapArg {
    /// Dark violet over green to yellow.
    Viridis,
    /// Black over violet to pale yellow.
    Magma,
    /// Black over red to pale yellow.
    Inferno,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Ends {
    low: Option<End>,
    high: Option<End>,
}

#[derive(Debug, Clone, PartialEq)]
struct Levels(Vec<f64>);

fn ends(text: &str) -> Result<Ends, String> {
    let expected = || format!("`{text}`; expected LOW:HIGH such as 0.1:1000, 1%:99% or 0:");
    let end = |text: &str| match text.trim() {
        "" => Ok(None),
        text => {
            let (number, percent) = text.strip_suffix('%').map_or((text, false), |n| (n.trim(), true));
            let value = number.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(expected)?;
            match percent {
                true if !(0.0..=100.0).contains(&value) => Err(expected()),
                true => Ok(Some(End::Percentile(value))),
                false => Ok(Some(End::Value(value))),
            }
        }
    };
    let (low, high) = text.split_once(':').ok_or_else(expected)?;
    let ends = Ends { low: end(low)?, high: end(high)? };
    match ends {
        Ends { low: Some(End::Value(low)), high: Some(End::Value(high)) } if low >= high => {
            Err(format!("`{text}`; expected the lower value first"))
        }
        ends => Ok(ends),
    }
}

fn levels(text: &str) -> Result<Levels, String> {
    if text.is_empty() {
        return Ok(Levels(Vec::new()));
    }
    let one = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let all = text.split(',').map(one).collect::<Option<_>>();
    all.map(Levels).ok_or_else(|| format!("`{text}`; expected values such as 100,300,1000"))
}

impl Colours {
    pub(super) fn false_colour(&self) -> FalseColour {
        FalseColour {
            low: self.limits.and_then(|r| r.low),
            high: self.limits.and_then(|r| r.high),
            logarithmic: match self.scale {
                ScaleArg::Auto => None,
                ScaleArg::Linear => Some(false),
                ScaleArg::Log => Some(true),
            },
            map: match self.map {
                MapArg::Viridis => ColourMap::Viridis,
                MapArg::Magma => ColourMap::Magma,
                MapArg::Inferno => ColourMap::Inferno,
            },
            contours: self.contours.as_ref().map(|levels| levels.0.clone()),
        }
    }
}

/// The format of a picture's name.
pub(super) fn picture_format(path: &Path) -> Option<Format> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("png") => Some(Format::Png),
        Some("svg") => Some(Format::Svg),
        _ => None,
    }
}

pub(super) fn run(arguments: &FalsecolorArgs, talk: Talk) -> Result<(), Failure> {
    let target = match &arguments.output {
        Some(path) => {
            let format = picture_format(path).ok_or_else(|| {
                Failure::Message(format!("{}: expected a name ending in .png or .svg", path.display()))
            })?;
            Some((path, format))
        }
        None => None,
    };
    let shown = match (arguments.look, target) {
        (Some(when), _) => when.now(None),
        (None, None) if io::stdout().is_terminal() => true,
        (None, None) => {
            let message = "the output is no terminal; expected -o FILE.png, or --look=always for text";
            return Err(Failure::Message(message.to_owned()));
        }
        (None, Some(_)) => false,
    };
    let notes = Notes::new(&arguments.images, talk);
    let settings = arguments.meaning.settings()?;
    let how = Look {
        reading: &arguments.reading,
        meaning: &arguments.meaning,
        settings: &settings,
        checksums: arguments.json,
    };
    let mut seen = Seen::open(&arguments.images, &how, &notes)?;
    let way = seen.luminance()?.clone();
    let colours = arguments.colours.false_colour();
    let mut findings = Vec::new();
    if let Some((path, format)) = target {
        let side = arguments.width as usize;
        // As high as a drawing can be with its title.
        let most = SIDES.1 as usize - 100;
        let picture =
            Picture::of(&mut *way.of(&mut seen.source), 0, side, most).map_err(|e| Failure::Message(e.to_string()))?;
        let refused = |e: &dyn std::fmt::Display| Failure::Message(format!("{}: {e}", seen.path));
        let title = arguments.title.clone().unwrap_or_else(|| report::title(&seen.path, &way));
        let panel = colours.panel(&title, &picture, way.unit()).map_err(|e| refused(&e))?;
        findings.extend(odd(&picture).map(|f| f.at(Location::default().in_file(&seen.path))));
        let mut described = settings_json(&arguments.meaning, &settings);
        described["width"] = arguments.width.into();
        let legend = report::Legend {
            range: [panel.range.low, panel.range.high],
            logarithmic: panel.range.logarithmic,
            map: format!("{:?}", panel.map).to_lowercase(),
            contours: panel.levels.iter().map(|l| l.value).collect(),
        };
        let result = report::falsecolor(&seen.path, path, &way, &picture, &legend);
        let bytes = draw(&[Panel::from(panel)], None, format).map_err(|e| refused(&e))?;
        write_file(path, &bytes, &arguments.images)?;
        findings.extend(seen.noticed());
        if arguments.json {
            let mut envelope = Envelope::begin(io::stdout().lock(), "image falsecolor", &described)?;
            envelope.result(&result.into())?;
            std::mem::take(&mut seen.inputs).into_iter().for_each(|input| envelope.input(input));
            findings.iter().cloned().for_each(|f| envelope.finding(f));
            envelope.end().map(drop)?;
        }
    }
    if shown {
        let text = look(&mut seen.source, &way, &colours)?;
        io::stdout().lock().write_all(text.as_bytes())?;
        findings.extend(seen.noticed());
    }
    notes.progress.finish_and_clear();
    notes.print(&findings);
    Ok(())
}

/// Pixels without a value.
fn odd(picture: &Picture) -> Option<Finding> {
    let s = &picture.statistics;
    let message = format!(
        "{} pixels are no numbers ({} NaN, {} infinite) and take part in no average",
        s.nan + s.infinite,
        s.nan,
        s.infinite
    );
    (s.nan + s.infinite > 0).then(|| Finding::warning("I041", message))
}
