//! `lamp plot`: diagrams of luminaires.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rayon::prelude::*;

use super::load::load;
use crate::cli::notes::Notes;
use crate::cli::output::{self, Sink};
use crate::cli::{Failure, Talk};
use crate::luminaire::Luminaire;
use crate::luminaire::beam::{self, BEAM_FRACTION, Definition};
use crate::plot::grid::isolux_beneath;
use crate::plot::luminaire::{
    Drawn, Error, View, cartesian_panel, cone_panel, figures_panel, isocandela_panel, polar_panel, web_panel,
};
use crate::plot::{self, Format, Panel};

/// Arguments of `lamp plot`.
#[derive(Debug, Args)]
pub(in crate::cli) struct PlotArgs {
    /// Lamp files (IES LM-63, EULUMDAT, TM-33), or `-`.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// The picture: a .svg or .png file, `-` for standard output, or a folder that gets one picture per lamp file. Several lamps in
    /// one picture are compared in polar and Cartesian diagrams.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// What to draw.
    #[arg(long, value_enum, default_value = "sheet")]
    kind: Kind,
    /// C-planes of the polar and Cartesian diagrams, degrees: each is drawn with the plane across. For Types A and B the angle about
    /// the axis: 0 is H, 90 is V. Without it C0–C180 and C90–C270 (for four lamps or more, C0–C180).
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', value_parser = plane)]
    planes: Vec<f64>,
    /// Intensities in cd per 1000 lm of the rated lamps (of the luminaire, where its photometry is absolute).
    #[arg(long)]
    per_klm: bool,
    /// Logarithmic Cartesian diagrams.
    #[arg(long)]
    log: bool,
    /// Distances of the cone diagram, metres; without it five round ones.
    #[arg(long, value_name = "METRES", value_delimiter = ',', value_parser = distance)]
    distances: Vec<f64>,
    /// Mounting height of the isolux diagram above its floor, metres.
    #[arg(long, value_name = "METRES", default_value = "3", value_parser = distance)]
    height: f64,
    /// Width and height in pixels, such as 1200x900.
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Format of pictures on standard output and in a folder.
    #[arg(long, value_enum, default_value = "svg")]
    format: FileFormat,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
}

/// What `lamp plot` draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Key figures, the polar diagram, and the cone or the Cartesian diagram, whichever says more.
    Sheet,
    /// Intensity around the axis.
    Polar,
    /// Intensity over the angle from the axis, with beam and field angle.
    Cartesian,
    /// The intensity solid.
    Web,
    /// Lines of equal intensity over all directions.
    Isocandela,
    /// Illuminance on the axis and beam width at distances.
    Cone,
    /// Lines of equal illuminance on the floor beneath, at --height.
    Isolux,
    /// Everything that the lamp has, on one sheet.
    All,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FileFormat {
    Svg,
    Png,
}

impl From<FileFormat> for Format {
    fn from(format: FileFormat) -> Self {
        match format {
            FileFormat::Svg => Self::Svg,
            FileFormat::Png => Self::Png,
        }
    }
}

fn number(text: &str, expected: &str, fits: impl Fn(f64) -> bool) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|v| fits(*v));
    value.ok_or_else(|| format!("`{text}`; expected {expected}"))
}

fn plane(text: &str) -> Result<f64, String> {
    number(text, "an angle of 0 to 360 degrees", |v| (0.0..=360.0).contains(&v)).map(|v| v % 360.0)
}

fn distance(text: &str) -> Result<f64, String> {
    number(text, "a distance of 0.001 to 1000000 m", |v| (1e-3..=1e6).contains(&v))
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    sides.ok_or_else(|| format!("`{text}`; expected width and height in pixels, such as 1200x900"))
}

/// A lamp read.
struct Lamp {
    path: String,
    name: String,
    luminaire: Luminaire,
}

pub(super) fn plot(arguments: &PlotArgs, talk: Talk) -> Result<(), Failure> {
    let mut distances_m = arguments.distances.clone();
    distances_m.sort_by(f64::total_cmp);
    distances_m.dedup();
    let mut planes_deg = arguments.planes.clone();
    planes_deg.dedup();
    let view = View { planes_deg, per_klm: arguments.per_klm, logarithmic: arguments.log, distances_m, named: false };
    let mut notes = Notes::new(&arguments.files, talk);
    if arguments.output.is_dir() {
        each(arguments, &view, &mut notes)?;
    } else {
        together(arguments, &view, &mut notes)?;
    }
    if notes.failed { Err(Failure::Reported) } else { Ok(()) }
}

/// All lamps in one picture; nothing is drawn where one cannot be read.
fn together(arguments: &PlotArgs, view: &View, notes: &mut Notes) -> Result<(), Failure> {
    let standard = arguments.output == Path::new("-");
    let ending = arguments.output.extension().and_then(|e| e.to_str()).map(str::to_lowercase);
    let format = match ending.as_deref() {
        _ if standard => arguments.format.into(),
        Some("svg") => Format::Svg,
        Some("png") => Format::Png,
        _ => {
            let place = arguments.output.display();
            return Err(Failure::Message(format!(
                "{place}: expected a name ending in .svg or .png, or a folder that exists"
            )));
        }
    };
    let mut lamps = Vec::new();
    for path in &arguments.files {
        match read(path, arguments.repair, notes) {
            Ok(lamp) => lamps.push(lamp),
            Err(message) => notes.refuse(&message),
        }
    }
    if notes.failed {
        return Ok(());
    }
    let picture = draw(&lamps, arguments, view, format).map_err(Failure::Message)?;
    if standard {
        let mut sink = Sink::open(None, &arguments.files)?;
        sink.write_all(&picture)?;
        return sink.finish(true);
    }
    output::write_file(&arguments.output, &picture, &arguments.files)
}

/// A picture per lamp in a folder, named like the lamp's file.
fn each(arguments: &PlotArgs, view: &View, notes: &mut Notes) -> Result<(), Failure> {
    let ending = if arguments.format == FileFormat::Png { "png" } else { "svg" };
    let place = |path: &String| arguments.output.join(format!("{}.{ending}", stem(path)));
    let places: Vec<PathBuf> = arguments.files.iter().map(place).collect();
    for (i, place) in places.iter().enumerate() {
        if let Some(other) = places[..i].iter().position(|p| p == place) {
            let message = format!(
                "{} and {} would both become {}; expected files with different names",
                arguments.files[other],
                arguments.files[i],
                place.display()
            );
            return Err(Failure::Message(message));
        }
    }
    // Read in turn, so that findings stand in the order of the files; drawing is what takes time.
    let lamps: Vec<Result<Lamp, String>> =
        arguments.files.iter().map(|path| read(path, arguments.repair, notes)).collect();
    let pictures: Vec<Result<Vec<u8>, String>> = lamps
        .into_par_iter()
        .map(|lamp| draw(std::slice::from_ref(&lamp?), arguments, view, arguments.format.into()))
        .collect();
    for (picture, place) in pictures.into_iter().zip(&places) {
        match picture {
            Ok(bytes) => output::write_file(place, &bytes, &arguments.files)?,
            Err(message) => notes.refuse(&message),
        }
    }
    Ok(())
}

fn stem(path: &str) -> String {
    Path::new(path).file_stem().map_or(path.into(), |s| s.to_string_lossy()).into_owned()
}

fn read(path: &str, repair: bool, notes: &Notes) -> Result<Lamp, String> {
    let file = load(path, repair).file.map_err(|(message, _)| message)?;
    notes.print(&file.findings);
    let luminaire = file.value.luminaire;
    let own = luminaire.name.trim();
    let name = if own.is_empty() { stem(path) } else { own.to_owned() };
    Ok(Lamp { path: path.to_owned(), name, luminaire })
}

fn draw(lamps: &[Lamp], arguments: &PlotArgs, view: &View, format: Format) -> Result<Vec<u8>, String> {
    let stems: Vec<String> = lamps.iter().map(|l| stem(&l.path)).collect();
    let name = |i: usize| if lamps.len() > 1 { stems[i].as_str() } else { lamps[i].name.as_str() };
    let drawn: Vec<Drawn<'_>> =
        lamps.iter().enumerate().map(|(i, l)| Drawn { name: name(i), luminaire: &l.luminaire }).collect();
    let panels = match drawn.as_slice() {
        [one] => alone(one, arguments, view).map_err(|e| format!("{}: {e}", lamps[0].path))?,
        several => compared(several, arguments.kind, view)?,
    };
    plot::draw(&panels, arguments.size, format).map_err(|e| e.to_string())
}

/// The panels of one lamp.
fn alone(lamp: &Drawn<'_>, arguments: &PlotArgs, view: &View) -> Result<Vec<Panel>, String> {
    let one = std::slice::from_ref(lamp);
    let named = View { named: true, ..view.clone() };
    let said = |e: Error| e.to_string();
    Ok(match arguments.kind {
        Kind::Polar => vec![polar_panel(one, &named).map_err(said)?.into()],
        Kind::Cartesian => vec![cartesian_panel(one, &named).map_err(said)?.into()],
        Kind::Web => vec![web_panel(lamp, &named).map_err(said)?.into()],
        Kind::Isocandela => vec![isocandela_panel(lamp, &named).map_err(said)?.into()],
        Kind::Cone => vec![cone_panel(lamp, &named).map_err(said)?.into()],
        Kind::Isolux => vec![isolux(lamp, &format!("{}: ", lamp.name), arguments.height)?],
        Kind::Sheet => {
            let second = match cone_panel(lamp, view) {
                Ok(cone) if !view.logarithmic && cone_says_more(lamp.luminaire) => cone.into(),
                _ => cartesian_panel(one, view).map_err(said)?.into(),
            };
            vec![figures_panel(lamp).into(), polar_panel(one, view).map_err(said)?.into(), second]
        }
        Kind::All => {
            let mut panels = vec![
                figures_panel(lamp).into(),
                polar_panel(one, view).map_err(said)?.into(),
                cartesian_panel(one, view).map_err(said)?.into(),
                isocandela_panel(lamp, view).map_err(said)?.into(),
                web_panel(lamp, view).map_err(said)?.into(),
            ];
            panels.extend(isolux(lamp, "", arguments.height));
            panels.extend(cone_panel(lamp, view).map(Panel::from));
            panels
        }
    })
}

/// The isolux diagram on the floor beneath the lamp.
fn isolux(lamp: &Drawn<'_>, before: &str, height_m: f64) -> Result<Panel, String> {
    let title = format!("{before}isolux diagram, {height_m} m above the floor");
    let panel = isolux_beneath(lamp.luminaire, &title, height_m, false).map_err(|e| e.to_string())?;
    if panel.lines.is_empty() {
        return Err("no light falls on a floor beneath the luminaire; expected one that shines down".to_owned());
    }
    Ok(panel.into())
}

/// Beams narrower than this are a needle in the polar diagram: the Cartesian one shows them, degrees.
const NEEDLE_DEG: f64 = 25.0;
/// Beams wider than this have no edge that a cone could show, degrees.
const FLOOD_DEG: f64 = 90.0;

/// Whether a lamp is a downlight or spot that is brightest about its axis, whose cone says more than its Cartesian diagram.
fn cone_says_more(luminaire: &Luminaire) -> bool {
    let d = &luminaire.distribution;
    let beam = beam::angles(d, BEAM_FRACTION, Definition::Fwhm);
    let fits = |angle: Option<f64>| angle.is_some_and(|a| (NEEDLE_DEG..=FLOOD_DEG).contains(&a));
    fits(beam.c0_c180) && fits(beam.c90_c270) && d.at(0.0, 0.0) >= BEAM_FRACTION * d.peak().0
}

/// The panels of several lamps in one picture.
fn compared(lamps: &[Drawn<'_>], kind: Kind, view: &View) -> Result<Vec<Panel>, String> {
    let polar = || polar_panel(lamps, view).map(Panel::from).map_err(|e| e.to_string());
    let cartesian = || cartesian_panel(lamps, view).map(Panel::from).map_err(|e| e.to_string());
    match kind {
        Kind::Sheet => Ok(vec![polar()?, cartesian()?]),
        Kind::Polar => Ok(vec![polar()?]),
        Kind::Cartesian => Ok(vec![cartesian()?]),
        Kind::Web | Kind::Isocandela | Kind::Cone | Kind::Isolux | Kind::All => Err(format!(
            "{} files in one picture of this kind; expected one file, or a folder as output, or --kind polar or cartesian",
            lamps.len()
        )),
    }
}
