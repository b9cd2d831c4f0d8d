//! `lamp grid`: illuminance of placed luminaires on a plane, as table, isolux plot and picture.

mod layout;

use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use glam::DVec3;
use serde_json::json;

use super::interpolation::{InterpolationArgs, interpolate};
use super::load::load;
use super::settings;
use crate::cli::notes::Notes;
use crate::cli::output::{self, Sink};
use crate::cli::{Failure, Talk};
use crate::finding::{Checked, Finding, Location};
use crate::luminaire::Luminaire;
use crate::luminaire::grid::{
    Error, Illuminance, Placed, Plane, PointsAt, Receiver, Settings, has_opening, illuminance, standard_step_m,
};
use crate::luminaire::placement::{Orientation, Placement};
use crate::plot::grid::isolux_panel;
use crate::plot::{Format, draw};
use crate::report::envelope::Envelope;
use crate::report::lamp as report;

/// Most luminaires of an array.
const MOST_LUMINAIRES: usize = 100_000;
/// Cells along the longer side of a drawing at least.
const DRAWN_CELLS: f64 = 120.0;

/// Arguments of `lamp grid`.
#[derive(Debug, Args)]
#[command(
    after_help = "Lengths are in metres, angles in degrees; z points up, C0 of an unturned luminaire towards +x, C90 towards +y.\n\n\
Examples:\n  photopic lamp grid spot.ies --height 3\n  \
photopic lamp grid downlight.ldt --at 3.6,3,2.8 --array 4x3 --spacing 1.8,2 --plane '0,0 7.2,6 at 0.8' --plot room.svg\n  \
photopic lamp grid road.ldt --at 0,0,8 --tilt 10 --tilt-towards 90 --plane '-15,0 15,7' --picture road.png\n  \
photopic lamp grid --layout room.toml --plane '0,0 6,4 at 0.8'\n\n\
A layout file (TOML) has a table [[luminaire]] for each sort of luminaire:\n  \
file = \"panel.ldt\"                   beside the layout file\n  \
at_m = [[1, 1, 2.8], [3, 1, 2.8]]    one place or many\n  \
rotate_deg, tilt_deg, tilt_towards_deg, spin_deg, dim; or aim_m = [2, 2, 0] instead of rotation and tilt"
)]
pub(in crate::cli) struct GridArgs {
    /// Lamp files; `-` is standard input.
    #[arg(required_unless_present = "layout", value_name = "FILE")]
    files: Vec<String>,
    /// Luminaires, places and orientations from a file (TOML, see below).
    #[arg(long, value_name = "FILE", conflicts_with_all = ["files", "at", "height", "array", "aim", "rotate", "tilt", "tilt_towards", "spin", "dim"])]
    layout: Option<PathBuf>,
    /// Where a luminaire hangs (its photometric centre); repeated, one per file, or many for a single file.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector, conflicts_with = "height")]
    at: Vec<DVec3>,
    /// Hang all luminaires at 0,0,HEIGHT.
    #[arg(long, value_name = "M", required_unless_present_any = ["at", "layout"])]
    height: Option<f64>,
    /// An array of N × M luminaires along x and y, its middle at the place given.
    #[arg(long, value_name = "NxM", value_parser = counts, requires = "spacing")]
    array: Option<[usize; 2]>,
    /// Distances between the luminaires of the array along x and y.
    #[arg(long, value_name = "X,Y", value_parser = pair, requires = "array")]
    spacing: Option<[f64; 2]>,
    /// Aim all luminaires at a point.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector, conflicts_with_all = ["rotate", "tilt"])]
    aim: Option<DVec3>,
    /// Turn about the vertical, counter-clockwise seen from above.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    rotate: f64,
    /// Lift the axis from straight down.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    tilt: f64,
    /// The C-plane that tilt and aim lift the axis towards; road luminaires in EULUMDAT have the street at 90.
    #[arg(long, value_name = "C", default_value_t = 0.0, allow_hyphen_values = true)]
    tilt_towards: f64,
    /// Turn about the luminaire's own axis.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    spin: f64,
    /// Dimming: factor on the output, 1 is full.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    dim: f64,
    /// Maintenance factor on all values, above 0 to 1.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    maintenance: f64,
    /// The plane: two corners `X,Y X,Y [at Z]` of a floor that looks up, or `X,Y,Z X,Y,Z X,Y,Z`, a corner and the ends of both its
    /// sides. Without it the floor z = 0 about the luminaires: half a spacing around an array, else twice the height.
    #[arg(long, value_name = "CORNERS", allow_hyphen_values = true, value_parser = corners)]
    plane: Option<[DVec3; 3]>,
    /// Largest distance between points; without it that of EN 12464-1.
    #[arg(long, value_name = "M")]
    step: Option<f64>,
    /// Points on the corners of the cells, the edges included, instead of in their middles.
    #[arg(long)]
    nodes: bool,
    /// The direction that the receivers face, instead of the plane's own.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = vector)]
    facing: Option<DVec3>,
    /// The receivers: flat, upright cylinders, or upright half cylinders (with --facing).
    #[arg(long, value_enum, default_value_t = ReceiverKind::Planar)]
    receiver: ReceiverKind,
    /// Subdivide luminaires nearer than so many times their largest dimension; 0 takes all as points. Without it 5.
    #[arg(long, value_name = "TIMES")]
    near: Option<f64>,
    /// Relative tolerance of the subdivision.
    #[arg(long, value_name = "SHARE", default_value_t = 1e-4)]
    tolerance: f64,
    #[command(flatten)]
    interpolation: InterpolationArgs,
    /// A file with settings, as `trade lamp --settings` writes it; options given here go before it.
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// One row per point.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// One JSON document with figures and grid.
    #[arg(long)]
    json: bool,
    /// Draw the isolux lines into a .svg or .png file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Draw a false-colour picture with the lines into a .svg or .png file.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Repair what can be repaired safely; each repair is listed.
    #[arg(long)]
    repair: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// What receives the light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ReceiverKind {
    Planar,
    Cylindrical,
    Semicylindrical,
}

fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let parse = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let all: Option<Vec<f64>> = text.split(',').map(parse).collect();
    all.and_then(|v| v.try_into().ok()).ok_or_else(|| format!("`{text}` is not {N} numbers with commas between them"))
}

fn vector(text: &str) -> Result<DVec3, String> {
    numbers::<3>(text).map(DVec3::from)
}

fn pair(text: &str) -> Result<[f64; 2], String> {
    numbers(text)
}

fn counts(text: &str) -> Result<[usize; 2], String> {
    let parse = |t: &str| t.parse::<usize>().ok().filter(|n| *n > 0);
    let both = text.split_once(['x', '×']).and_then(|(a, b)| Some([parse(a)?, parse(b)?]));
    let both = both.ok_or_else(|| format!("`{text}` is no array; expected NxM such as 4x3"))?;
    match both[0].checked_mul(both[1]) {
        Some(n) if n <= MOST_LUMINAIRES => Ok(both),
        _ => Err(format!("`{text}`: expected at most {MOST_LUMINAIRES} luminaires")),
    }
}

/// A corner and the ends of the sides from it.
fn corners(text: &str) -> Result<[DVec3; 3], String> {
    let expected = "expected `X,Y X,Y [at Z]` or `X,Y,Z X,Y,Z X,Y,Z`";
    let words: Vec<&str> = text.split_whitespace().collect();
    let floor = |a: &str, b: &str, z: &str| {
        let ([x0, y0], [x1, y1], [z]) = (numbers::<2>(a)?, numbers::<2>(b)?, numbers::<1>(z)?);
        let (low, high) = ((x0.min(x1), y0.min(y1)), (x0.max(x1), y0.max(y1)));
        Ok([DVec3::new(low.0, low.1, z), DVec3::new(high.0, low.1, z), DVec3::new(low.0, high.1, z)])
    };
    match words[..] {
        [a, b] => floor(a, b, "0"),
        [a, b, "at", z] => floor(a, b, z),
        [a, b, c] => Ok([vector(a)?, vector(b)?, vector(c)?]),
        _ => Err(expected.to_owned()),
    }
    .map_err(|e: String| if e == expected { e } else { format!("{e}; {expected}") })
}

pub(super) fn grid(arguments: &GridArgs, talk: Talk) -> Result<(), Failure> {
    let a = arguments;
    let (plot, picture) = (target(a.plot.as_deref(), "--plot")?, target(a.picture.as_deref(), "--picture")?);
    let laid = a.layout.as_deref().map(layout::read).transpose()?;
    let given = settings::Settings::read(a.settings.as_deref())?;
    let near = a.near.or(given.near_ratio).unwrap_or(Settings::default().near_ratio);
    let interpolation = a.interpolation.or(given.interpolation);
    let files = laid.as_ref().map_or(&a.files, |l| &l.files);
    let mut read: Vec<String> = files.clone();
    read.extend(a.layout.iter().chain(&a.settings).map(|l| l.display().to_string()));
    let mut sink = Sink::open(a.output.as_deref(), &read)?;
    let notes = Notes::new(files, talk);
    let mut inputs = Vec::new();
    let mut findings = Vec::new();
    let mut lamps = Vec::new();
    for path in files {
        let loaded = load(path, a.repair);
        inputs.push(loaded.input);
        let mut file = loaded.file.map_err(|(message, _)| Failure::Message(message))?;
        findings.extend(file.findings);
        interpolate(&mut file.value, interpolation);
        let Checked { value, findings: noted } = given.thin(&file.value.luminaire)?;
        findings.extend(noted.into_iter().map(|f| f.at(Location::default().in_file(path))));
        lamps.push(value);
        if !lamps.last().is_some_and(has_opening) {
            let message = "the luminous opening is not known: the luminaire is taken as a point at any distance";
            findings.push(Finding::info("L601", message).at(Location::default().in_file(path)));
        }
    }
    let placed = match &laid {
        Some(laid) => {
            laid.luminaires.iter().map(|(file, p)| Placed { luminaire: &lamps[*file], placement: *p }).collect()
        }
        None => place(a, &lamps)?,
    };
    let plane = plane(a, &placed)?;
    let receiver = match a.receiver {
        ReceiverKind::Planar => Receiver::Planar(a.facing.unwrap_or_else(|| plane.normal())),
        ReceiverKind::Cylindrical => Receiver::Cylindrical,
        ReceiverKind::Semicylindrical => match a.facing {
            Some(facing) => Receiver::Semicylindrical(facing),
            None => return Err(Failure::Message("--receiver semicylindrical: expected --facing X,Y,0".into())),
        },
    };
    let settings = Settings { maintenance_factor: a.maintenance, near_ratio: near, tolerance: a.tolerance };
    let result = illuminance(&placed, &plane, &receiver, &settings).map_err(message)?;
    if result.undefined > 0 {
        let text = format!("{} points lie in a luminaire or on it and have no value", result.undefined);
        findings.push(Finding::warning("L602", text).hint("move the plane or the step"));
    }
    if result.unresolved > 0 {
        let text =
            format!("at {} points the subdivision did not meet its tolerance of {}", result.unresolved, a.tolerance);
        findings.push(
            Finding::warning("L603", text)
                .hint("they lie within a thousandth of a luminaire's size, or where its light is cut off"),
        );
    }
    notes.print(&findings);
    for (path, format, filled) in [(&a.plot, plot, false), (&a.picture, picture, true)] {
        let (Some(path), Some(format)) = (path, format) else { continue };
        let [u, v] = plane.size_m();
        let [du, dv] = plane.spacing_m();
        let step = u.max(v) / DRAWN_CELLS;
        let finer = if du.max(dv) > 1.01 * step {
            let fine = plane.stepped(step).map_err(message)?;
            Some(illuminance(&placed, &fine, &receiver, &settings).map_err(message)?)
        } else {
            None
        };
        let title = title(files, &lamps);
        let panel = isolux_panel(&title, &result, finer.as_ref().unwrap_or(&result), &placed, filled);
        let bytes =
            draw(&[panel.into()], None, format).map_err(|e| Failure::Message(format!("{}: {e}", path.display())))?;
        output::write_file(path, &bytes, &read)?;
    }
    let bytes = if a.json {
        let luminaires: Vec<_> = placed
            .iter()
            .map(|p| {
                let p = &p.placement;
                json!({"position_m": p.position_m().to_array(), "axis": p.axis().to_array(), "c0": p.c0().to_array(), "dimming": p.dimming()})
            })
            .collect();
        let settings = json!({"near_ratio": near, "tolerance": a.tolerance, "interpolation": interpolation.name(), "repair": a.repair, "luminaires": luminaires});
        let mut envelope = Envelope::begin(Vec::new(), "lamp grid", &settings)?;
        inputs.into_iter().for_each(|i| envelope.input(i));
        envelope.result(&report::grid(&result, a.maintenance).into())?;
        findings.into_iter().for_each(|f| envelope.finding(f));
        envelope.end()?
    } else if a.csv {
        csv(&result).into_bytes()
    } else {
        format!(
            "{}: {}\n\n{}",
            title(files, &lamps),
            if placed.len() == 1 { "1 luminaire".to_owned() } else { format!("{} luminaires", placed.len()) },
            report::grid_text(&result, a.maintenance)
        )
        .into_bytes()
    };
    sink.write_all(&bytes)?;
    sink.finish(true)
}

fn message(error: Error) -> Failure {
    Failure::Message(error.to_string())
}

fn title(files: &[String], lamps: &[Luminaire]) -> String {
    let names = files.iter().zip(lamps).map(|(path, lamp)| {
        let file = Path::new(path).file_name().map_or_else(|| path.clone(), |n| n.to_string_lossy().into_owned());
        if lamp.name.trim().is_empty() { file } else { lamp.name.trim().to_owned() }
    });
    names.collect::<Vec<_>>().join(", ")
}

fn target(path: Option<&Path>, option: &str) -> Result<Option<Format>, Failure> {
    let Some(path) = path else { return Ok(None) };
    match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("svg") => Ok(Some(Format::Svg)),
        Some("png") => Ok(Some(Format::Png)),
        _ => Err(Failure::Message(format!("{option} {}: expected a file name ending in .svg or .png", path.display()))),
    }
}

/// Every luminaire in its place.
fn place<'a>(a: &GridArgs, lamps: &'a [Luminaire]) -> Result<Vec<Placed<'a>>, Failure> {
    let places = if a.at.is_empty() { vec![DVec3::new(0.0, 0.0, a.height.unwrap_or(0.0))] } else { a.at.clone() };
    let pairs: Vec<(&Luminaire, DVec3)> = match (lamps, &places[..]) {
        ([lamp], many) => many.iter().map(|p| (lamp, *p)).collect(),
        (many, [one]) => many.iter().map(|l| (l, *one)).collect(),
        (lamps, places) if lamps.len() == places.len() => lamps.iter().zip(places.iter().copied()).collect(),
        _ => {
            let text = format!(
                "{} places for {} files; expected one place per file, or one of either",
                places.len(),
                lamps.len()
            );
            return Err(Failure::Message(text));
        }
    };
    let ([m, n], [dx, dy]) = (a.array.unwrap_or([1, 1]), a.spacing.unwrap_or([0.0; 2]));
    let orientation = match a.aim {
        Some(at_m) => Orientation::Aim { at_m, towards_c_deg: a.tilt_towards, spin_deg: a.spin },
        None => Orientation::Angles {
            rotation_deg: a.rotate,
            tilt_deg: a.tilt,
            towards_c_deg: a.tilt_towards,
            spin_deg: a.spin,
        },
    };
    let mut out = Vec::with_capacity(pairs.len() * m * n);
    for (luminaire, middle) in pairs {
        let offset = |i: usize, count: usize, step: f64| (i as f64 - 0.5 * (count - 1) as f64) * step;
        for (i, j) in (0..n).flat_map(|j| (0..m).map(move |i| (i, j))) {
            let position = middle + DVec3::new(offset(i, m, dx), offset(j, n, dy), 0.0);
            let placement =
                Placement::new(position, orientation, a.dim).map_err(|e| Failure::Message(e.to_string()))?;
            out.push(Placed { luminaire, placement });
        }
    }
    Ok(out)
}

fn plane(a: &GridArgs, placed: &[Placed<'_>]) -> Result<Plane, Failure> {
    let [origin, u, v] = a.plane.unwrap_or_else(|| {
        let all = || placed.iter().map(|p| p.placement.position_m());
        let (low, high) = (all().fold(DVec3::INFINITY, DVec3::min), all().fold(DVec3::NEG_INFINITY, DVec3::max));
        let around = 2.0 * high.z.abs();
        let [dx, dy] = a.spacing.map_or([around; 2], |s| s.map(|d| 0.5 * d));
        let (low, high) = ((low.x - dx, low.y - dy), (high.x + dx, high.y + dy));
        [DVec3::new(low.0, low.1, 0.0), DVec3::new(high.0, low.1, 0.0), DVec3::new(low.0, high.1, 0.0)]
    });
    let sides = [u - origin, v - origin];
    let step = a.step.unwrap_or_else(|| standard_step_m(sides[0].length(), sides[1].length()));
    let at = if a.nodes { PointsAt::Nodes } else { PointsAt::Centres };
    Plane::with_step(origin, sides, step, at).map_err(message)
}

fn csv(e: &Illuminance) -> String {
    let mut out = format!("x_m,y_m,z_m,{}\n", report::grid_key(e.kind));
    for (i, value) in e.values.iter().enumerate() {
        let p = e.plane.point_m(i);
        // Writing to a string cannot fail.
        let _ = write!(out, "{},{},{},", p.x, p.y, p.z);
        let _ = if value.is_nan() { writeln!(out) } else { writeln!(out, "{value}") };
    }
    out
}
