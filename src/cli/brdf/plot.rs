//! `brdf plot`: lobes, albedo, a lit sphere, MERL's slice.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::load::{BandArgs, MaterialArgs, Ready, Subject, load, prepare};
use super::numbers::{Numbers, check_lobes};
use crate::brdf::Brdf;
use crate::brdf::table::Channel;
use crate::cli::notes::Notes;
use crate::cli::output::write_file;
use crate::cli::{Failure, Talk};
use crate::plot::brdf::{Tint, albedo_panel, lobe_panel, log_panel, slice_panel, sphere_panel, surface_panel};
use crate::plot::{Format, Panel, RasterPanel, draw};

/// Wavelengths of the colours of spheres and slices, nm.
const SPHERE_NM: (f64, f64, u32) = (400.0, 700.0, 31);

/// What to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PlotKind {
    /// Lobes polar and logarithmic, albedo, lit sphere.
    All,
    /// Lobes in the plane of incidence, polar.
    Polar,
    /// Lobes in the plane of incidence over the angle, logarithmic.
    Log,
    /// Albedo over the angle of incidence.
    Albedo,
    /// A lit sphere.
    Sphere,
    /// The lobe in space.
    Lobe,
    /// Half angle across, difference angle up, at an azimuth of 90°: MERL's slice.
    Slice,
}

/// A material and what to draw of it.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  photopic brdf plot 'ggx(alpha=0.1, medium=Au)' -o gold.svg
  photopic brdf plot paint.binary --kind slice -o paint.png

What a table does not hold is marked: dashed lines are its guess, and in a sphere, a slice or a lobe such places are pale lilac.")]
pub(in crate::cli) struct PlotArgs {
    #[command(flatten)]
    materials: MaterialArgs,
    /// What to draw.
    #[arg(short, long, value_enum, default_value = "all")]
    kind: PlotKind,
    /// Angles of incidence of the lobes, degrees.
    #[arg(long, value_name = "DEG", default_value = "15,45,75")]
    theta_i: Numbers,
    /// The picture: a name ending in .svg or .png.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

pub(super) fn plot(arguments: &PlotArgs, talk: Talk) -> Result<(), Failure> {
    let format = format_of("-o", &arguments.output)?;
    let [path] = &arguments.materials.materials[..] else {
        let count = arguments.materials.materials.len();
        return Err(Failure::Message(format!("{count} materials; expected one per picture")));
    };
    let thetas = &arguments.theta_i.0;
    check_lobes(&arguments.theta_i)?;
    let wanted = &arguments.materials.bands;
    let loaded = load(path, wanted.format);
    let read = loaded.subject.map_err(Failure::Message)?;
    Notes::new(&arguments.materials.materials, talk).print(&read.findings);
    let Ready { bands, brdf } = prepare(path, &read.value, wanted, &[555.0]).map_err(Failure::Message)?;
    let names: Vec<String> = bands.iter().map(ToString::to_string).collect();
    // Lobes are of one band: the middle one.
    let band = brdf.bands() / 2;
    let polar = || {
        Panel::from(lobe_panel(
            brdf.as_ref(),
            &format!("{}, {}", file_name(path, &loaded.name), names[band]),
            thetas,
            band,
        ))
    };
    let log = || Panel::from(log_panel(brdf.as_ref(), thetas, band));
    let albedo = || Panel::from(albedo_panel(brdf.as_ref(), &names));
    let coloured = |panel: fn(&dyn Brdf, &Tint) -> RasterPanel| -> Result<Panel, Failure> {
        let (first, last, count) = SPHERE_NM;
        let step = (last - first) / f64::from(count - 1);
        let nm: Vec<f64> = (0..count).map(|i| first + step * f64::from(i)).collect();
        let ready = match &read.value {
            Subject::Described(_) => prepare(path, &read.value, &BandArgs::default(), &nm),
            Subject::Measured(_) => prepare(path, &read.value, wanted, &nm),
        };
        let Ready { bands, brdf } = ready.map_err(Failure::Message)?;
        Ok(panel(brdf.as_ref(), &tint(&bands)).into())
    };
    let middle = thetas[thetas.len() / 2];
    let panels = match arguments.kind {
        // Dirac lobes have no values for a logarithm.
        PlotKind::All if brdf.is_delta() => vec![polar(), albedo()],
        PlotKind::All => vec![polar(), log(), albedo(), coloured(sphere_panel)?],
        PlotKind::Polar => vec![polar()],
        PlotKind::Log | PlotKind::Lobe | PlotKind::Slice if brdf.is_delta() => {
            return Err(Failure::Message(format!(
                "{path}: nothing but a Dirac lobe, which has no values; expected --kind polar, albedo or sphere"
            )));
        }
        PlotKind::Log => vec![log()],
        PlotKind::Albedo => vec![albedo()],
        PlotKind::Sphere => vec![coloured(sphere_panel)?],
        PlotKind::Slice => vec![coloured(slice_panel)?],
        PlotKind::Lobe => vec![surface_panel(brdf.as_ref(), middle, band).into()],
    };
    let panels: Vec<Panel> = match <[Panel; 1]>::try_from(panels) {
        Ok([panel]) => vec![of_material(panel, file_name(path, &loaded.name))],
        Err(panels) => panels,
    };
    let bytes = draw(&panels, None, format).map_err(|e| Failure::Message(e.to_string()))?;
    write_file(&arguments.output, &bytes, std::slice::from_ref(path))
}

/// A drawing that stands alone says what it is of; the lobes of [`lobe_panel`] do so anyway.
fn of_material(mut panel: Panel, name: &str) -> Panel {
    let title = match &mut panel {
        Panel::Curves(panel) => &mut panel.title,
        Panel::Raster(panel) => &mut panel.title,
        Panel::Surface(panel) => &mut panel.title,
        _ => return panel,
    };
    *title = format!("{name}, {title}");
    panel
}

/// A material's name without the folders of its file.
fn file_name<'a>(argument: &str, name: &'a str) -> &'a str {
    let folders = Path::new(argument).file_name().and_then(|n| n.to_str()).map_or(0, |n| argument.len() - n.len());
    if argument.contains('(') { name } else { name.get(folders..).unwrap_or(name) }
}

/// Colours of bands: by the observer where all are wavelengths, else as channels.
fn tint(bands: &[Channel]) -> Tint {
    let wavelength = |c: &Channel| if let Channel::Wavelength(nm) = c { Some(*nm) } else { None };
    match bands.iter().map(wavelength).collect::<Option<Vec<f64>>>() {
        Some(nm) => Tint::of_wavelengths(&nm),
        None => Tint::of_channels(bands.len()),
    }
}

/// The format of a picture by its name; `option` is how the name was given.
pub(super) fn format_of(option: &str, path: &Path) -> Result<Format, Failure> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("svg") => Ok(Format::Svg),
        Some("png") => Ok(Format::Png),
        _ => Err(Failure::Message(format!("{option} {}: expected a file name ending in .svg or .png", path.display()))),
    }
}
