//! `image probe`.

use std::io::Write;
use std::path::PathBuf;
use std::str::FromStr;

use clap::{ArgMatches, Args, Command, FromArgMatches, ValueEnum};
use serde_json::json;

use super::convert::MeaningArgs;
use super::open::Reading;
use super::seen::{Look, Seen, settings_json};
use crate::cli::notes::Notes;
use crate::cli::output::Sink;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::image::probe::{Line, Measures, Projection, Shape, ShapeError, View, probe, profile};
use crate::image::{Description, Region};
use crate::report::envelope::Envelope;
use crate::report::image::{self as report, Part, Probed, Table};

/// Arguments of `image probe`.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Places are in pixels from the upper left corner: pixel x, y covers x to x + 1 and y to y + 1. A shape holds the pixels whose \
centres (x + 0.5, y + 0.5) lie in it.

Examples:
  photopic image probe cube.hdr --pixel 120,80
  photopic image probe room.exr --rect desk=100,200,64,32 --rect wall=0,0,50,50 --percentiles 5,50,95
  photopic image probe render.exr --spot 320.5,240.5,1 --fov 40      (a 1-degree luminance meter)
  photopic image probe display.exr --line 0,240,639,240 --csv -o profile.csv
  photopic image probe cube.hdr --circle lamp=50,60,8 --csv | photopic convert - --quantity radiance")]
pub(in crate::cli) struct ProbeArgs {
    /// Images: spectral EXR, ENVI (header or data), NPY, folders of grey pictures, `-` for standard input.
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<String>,
    #[command(flatten)]
    parts: Ordered,
    /// Percentiles of the luminance, 0 to 100; exact, between two pixels in proportion.
    #[arg(long, value_name = "PERCENT,…", value_delimiter = ',', default_value = "5,50,95", value_parser = percent)]
    percentiles: Vec<f64>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    meaning: MeaningArgs,
    /// One JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One table: the mean spectra (which `convert` reads), the figures, or the samples of the lines. By default the first of
    /// the three that there is: lines if asked for, spectra if the image has bands.
    #[arg(long, value_enum, value_name = "TABLE", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    csv: Option<TableArg>,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// What is looked at; each may be given several times.
#[derive(Debug, Args)]
#[command(next_help_heading = "Where (each may be repeated, and named: wall=10,20,5,5)")]
struct Parts {
    /// One pixel: column and row, from 0.
    #[arg(long, value_name = "[NAME=]X,Y")]
    pixel: Vec<Named<2>>,
    /// A rectangle of whole pixels: its first column and row, width and height.
    #[arg(long, value_name = "[NAME=]X,Y,W,H")]
    rect: Vec<Named<4>>,
    /// A polygon: its corners.
    #[arg(long, value_name = "[NAME=]X,Y,X,Y,X,Y,…")]
    polygon: Vec<Named<0>>,
    /// A circle: its middle and its radius in pixels.
    #[arg(long, value_name = "[NAME=]X,Y,RADIUS")]
    circle: Vec<Named<3>>,
    /// A luminance meter's spot: where its axis meets the picture and its full angle in degrees. Needs --fov.
    #[arg(long, value_name = "[NAME=]X,Y,DEG", requires = "fov")]
    spot: Vec<Named<3>>,
    /// A line from one pixel to another: one row per pixel along it.
    #[arg(long, value_name = "[NAME=]X0,Y0,X1,Y1")]
    line: Vec<Named<4>>,
    /// What the camera sees from the left edge of the picture to the right one, degrees.
    #[arg(long, value_name = "DEG")]
    fov: Option<f64>,
    /// Its lens.
    #[arg(long, value_enum, default_value = "pinhole")]
    projection: ProjectionArg,
}

/// Arguments of the parts, which name the kinds in the order that [`Parts::list`] makes them.
const KINDS: [&str; 6] = ["pixel", "rect", "polygon", "circle", "spot", "line"];

/// The parts, and where on the command line each of them stands, kind by kind.
#[derive(Debug)]
struct Ordered {
    parts: Parts,
    places: Vec<usize>,
}

impl FromArgMatches for Ordered {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let places = KINDS.iter().filter_map(|kind| matches.indices_of(kind)).flatten().collect();
        Ok(Self { parts: Parts::from_arg_matches(matches)?, places })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Ordered {
    fn augment_args(command: Command) -> Command {
        Parts::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Parts::augment_args_for_update(command)
    }
}

impl Ordered {
    /// What is looked at, as asked for from left to right.
    fn list(&self, image: &Description) -> Result<Vec<(String, Where)>, Failure> {
        let mut placed: Vec<_> = self.places.iter().zip(self.parts.list(image)?).collect();
        placed.sort_by_key(|(place, _)| **place);
        Ok(placed.into_iter().map(|(_, part)| part).collect())
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TableArg {
    Auto,
    Spectra,
    Figures,
    Profile,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ProjectionArg {
    /// Without distortion.
    Pinhole,
    /// A fisheye whose distances from the middle are proportional to angles.
    Equidistant,
}

fn percent(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|p| (0.0..=100.0).contains(p));
    number.ok_or_else(|| format!("`{text}`; expected numbers from 0 to 100 such as 5,50,95"))
}

/// `[NAME=]` and `N` numbers; any even number of at least six where `N` is 0.
#[derive(Debug, Clone)]
struct Named<const N: usize> {
    name: Option<String>,
    numbers: Vec<f64>,
    text: String,
}

impl<const N: usize> FromStr for Named<N> {
    type Err = String;

    fn from_str(whole: &str) -> Result<Self, String> {
        let (name, text) = whole.rsplit_once('=').map_or((None, whole), |(name, text)| (Some(name), text));
        let numbers: Option<Vec<f64>> =
            text.split(',').map(|t| t.trim().parse::<f64>().ok().filter(|v| v.is_finite())).collect();
        let right = |n: usize| if N == 0 { n >= 6 && n.is_multiple_of(2) } else { n == N };
        let expected =
            if N == 0 { "the corners x,y of a polygon, at least three".to_owned() } else { format!("{N} numbers") };
        let numbers = numbers.filter(|n| right(n.len()));
        let numbers = numbers.ok_or_else(|| format!("`{whole}`; expected {expected} with commas between them"))?;
        let name = name.map(|n| n.trim().to_owned()).filter(|n| !n.is_empty());
        Ok(Self { name, numbers, text: text.trim().to_owned() })
    }
}

impl<const N: usize> Named<N> {
    fn name(&self, kind: &str) -> String {
        self.name.clone().unwrap_or_else(|| format!("{kind} {}", self.text))
    }

    /// The numbers as places of whole pixels.
    fn whole(&self) -> Result<[usize; N], Failure> {
        let mut out = [0; N];
        for (to, from) in out.iter_mut().zip(&self.numbers) {
            if *from < 0.0 || from.fract() != 0.0 || *from > f64::from(u32::MAX) {
                let message = format!("{}: found {from}; expected whole numbers of pixels from 0", self.text);
                return Err(Failure::Message(message));
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
            let number = *from as usize;
            *to = number;
        }
        Ok(out)
    }
}

/// What is looked at, for an image of the given size.
enum Where {
    Shape(Shape),
    Line(Line),
}

impl Parts {
    /// Kind by kind, as in [`KINDS`].
    fn list(&self, image: &Description) -> Result<Vec<(String, Where)>, Failure> {
        let mut out = Vec::new();
        for p in &self.pixel {
            let [x, y] = p.whole()?;
            out.push((p.name("pixel"), Where::Shape(Shape::Pixel(x, y))));
        }
        for p in &self.rect {
            let [x, y, width, height] = p.whole()?;
            out.push((p.name("rect"), Where::Shape(Shape::Rectangle(Region { x, y, width, height }))));
        }
        for p in &self.polygon {
            let corners = p.numbers.chunks_exact(2).map(|c| (c[0], c[1])).collect();
            out.push((p.name("polygon"), Where::Shape(Shape::Polygon(corners))));
        }
        for p in &self.circle {
            let shape = Shape::Circle { centre: (p.numbers[0], p.numbers[1]), radius_px: p.numbers[2] };
            out.push((p.name("circle"), Where::Shape(shape)));
        }
        for p in &self.spot {
            let view = self.view(image)?;
            let shape = Shape::Spot { centre: (p.numbers[0], p.numbers[1]), diameter_deg: p.numbers[2], view };
            out.push((p.name("spot"), Where::Shape(shape)));
        }
        for p in &self.line {
            let [x0, y0, x1, y1] = p.whole()?;
            out.push((p.name("line"), Where::Line(Line { from: (x0, y0), to: (x1, y1) })));
        }
        if out.is_empty() {
            let message = "nothing to look at; expected --pixel, --rect, --polygon, --circle, --spot or --line";
            return Err(Failure::Message(message.to_owned()));
        }
        Ok(out)
    }

    fn view(&self, image: &Description) -> Result<View, Failure> {
        let (projection, most) = match self.projection {
            ProjectionArg::Pinhole => (Projection::Pinhole, "below 180°"),
            ProjectionArg::Equidistant => (Projection::Equidistant, "up to 360°"),
        };
        let fov = self.fov.unwrap_or(f64::NAN);
        View::new(projection, fov, (image.width, image.height))
            .ok_or_else(|| Failure::Message(format!("--fov {fov}: expected an angle above 0° and {most}")))
    }
}

/// All that one image gives.
fn look(arguments: &ProbeArgs, path: &String, look: &Look<'_>, notes: &Notes) -> Result<(Seen, Vec<Probed>), Failure> {
    let mut seen = Seen::open(std::slice::from_ref(path), look, notes)?;
    let parts = arguments.parts.list(seen.image())?;
    let measures = Measures::new(seen.image(), seen.luminance.clone(), seen.xyz.clone());
    if let Some(why) = &seen.without {
        let message = format!("no photopic figures: {why}");
        seen.findings.push(Finding::warning("I040", message).at(Location::default().in_file(path)));
    }
    let (width, height) = (seen.image().width, seen.image().height);
    // All places are checked before the first pixel is read.
    let refused = |name: &str, error: ShapeError| Failure::Message(format!("{path}: {name}: {error}"));
    let mut checked = Vec::with_capacity(parts.len());
    for (name, part) in parts {
        let pixels = match &part {
            Where::Shape(shape) => shape.pixels(width, height).map(|p| (Some(p), Vec::new())),
            Where::Line(line) => line.pixels(width, height).map(|p| (None, p)),
        };
        let (area, along) = pixels.map_err(|e| refused(&name, e))?;
        checked.push((name, part, area, along));
    }
    let failed = |e: crate::image::Error| Failure::Message(e.to_string());
    let mut out = Vec::with_capacity(checked.len());
    for (name, part, area, along) in checked {
        let part = match (part, area) {
            (Where::Shape(shape), Some(pixels)) => {
                let probe =
                    probe(&mut seen.source, &measures, &shape, &pixels, &arguments.percentiles).map_err(failed)?;
                Part::Shape { shape, probe: Box::new(probe) }
            }
            (Where::Line(line), _) => {
                Part::Line { line, samples: profile(&mut seen.source, &measures, &along).map_err(failed)? }
            }
            (Where::Shape(_), None) => continue,
        };
        let probed = Probed::new(path, name, seen.image(), &measures, &arguments.percentiles, part);
        seen.findings.extend(probed.findings());
        out.push(probed);
    }
    Ok((seen, out))
}

pub(super) fn run(arguments: &ProbeArgs, talk: Talk) -> Result<(), Failure> {
    let mut sink = Sink::open(arguments.output.as_deref(), &arguments.images)?;
    let mut notes = Notes::new(&arguments.images, talk);
    let settings = arguments.meaning.settings()?;
    let mut described = settings_json(&arguments.meaning, &settings);
    described["coverage"] = "pixels whose centres lie in the shape".into();
    described["percentiles"] = json!(arguments.percentiles);
    if let Some(fov) = arguments.parts.parts.fov {
        described["fov_deg"] = fov.into();
        let name = arguments.parts.parts.projection.to_possible_value().map(|v| v.get_name().to_owned());
        described["projection"] = name.into();
    }
    let mut envelope = Envelope::begin(Vec::new(), "image probe", &described)?;
    let how = Look {
        reading: &arguments.reading,
        meaning: &arguments.meaning,
        settings: &settings,
        checksums: arguments.json,
    };
    let mut all = Vec::new();
    for path in &arguments.images {
        match look(arguments, path, &how, &notes) {
            Ok((mut seen, probed)) => {
                std::mem::take(&mut seen.inputs).into_iter().for_each(|input| envelope.input(input));
                let findings = seen.noticed();
                notes.print(&findings);
                findings.into_iter().for_each(|f| envelope.finding(f));
                for one in &probed {
                    envelope.result(&one.json().into())?;
                }
                all.extend(probed);
            }
            Err(Failure::Message(message)) => {
                notes.refuse(&message);
                envelope.finding(Finding::error("I000", message).at(Location::default().in_file(path)));
            }
            Err(other) => return Err(other),
        }
    }
    notes.progress.finish_and_clear();
    let worth_keeping = !all.is_empty() || arguments.json;
    let document = match arguments.csv {
        Some(table) => report::probe_csv(&all, table.into()).map_err(Failure::Message)?,
        None if arguments.json => envelope.end()?,
        None => report::probe_text(&all).into_bytes(),
    };
    sink.write_all(&document)?;
    sink.finish(worth_keeping)?;
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

impl From<TableArg> for Table {
    fn from(table: TableArg) -> Self {
        match table {
            TableArg::Auto => Self::First,
            TableArg::Spectra => Self::Spectra,
            TableArg::Figures => Self::Figures,
            TableArg::Profile => Self::Profile,
        }
    }
}
