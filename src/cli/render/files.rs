//! The files of a scene.

use std::cell::RefCell;
use std::fs;
use std::io::Read;
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::brdf::format::Format;
use crate::brdf::table::Table;
use crate::cli::Failure;
use crate::cli::brdf;
use crate::cli::convert::single;
use crate::cli::image;
use crate::constants::SecondRadiation;
use crate::finding::{Finding, Location};
use crate::luminaire::Luminaire;
use crate::luminaire::format::{self, ReadOptions};
use crate::render::build::{Built, Files, Instrument, Kind, PictureFile};
use crate::render::denoise::Price;
use crate::render::format::{self as mesh, Object};
use crate::render::integrator::limits::Follow;
use crate::render::measure::Place;
use crate::render::reading::Reading;
use crate::report::envelope::Input;
use crate::spectrum::Spectrum;
use crate::units::significant;

/// A scene's text and the path that its files are beside.
pub(in crate::cli) struct Scene {
    pub text: String,
    path: String,
    inputs: RefCell<Vec<Input>>,
}

fn checksum(bytes: &[u8]) -> Option<String> {
    Some(Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect())
}

impl Scene {
    /// Reads a scene; `-` is standard input, whose files are in the current folder.
    pub(in crate::cli) fn read(path: &str) -> Result<Self, Failure> {
        let mut bytes = Vec::new();
        let done = if path == "-" {
            std::io::stdin().read_to_end(&mut bytes).map(|_| ())
        } else {
            fs::read(path).map(|b| bytes = b)
        };
        done.map_err(|e| Failure::Message(format!("{path}: cannot be read: {e}; expected a scene (TOML)")))?;
        let input = Input { path: path.to_owned(), sha256: checksum(&bytes) };
        let text = String::from_utf8(bytes).map_err(|e| {
            let at = e.utf8_error().valid_up_to();
            Failure::Message(format!("{path}: byte {at} is not UTF-8; expected a scene (TOML)"))
        })?;
        Ok(Self { text, path: path.to_owned(), inputs: RefCell::new(vec![input]) })
    }

    /// The scene and all files read for it.
    pub(in crate::cli) fn inputs(&self) -> Vec<Input> {
        self.inputs.borrow().clone()
    }

    fn path(&self, file: &str) -> String {
        beside(&self.path, file)
    }

    fn note(&self, input: Input) {
        let mut inputs = self.inputs.borrow_mut();
        if !inputs.contains(&input) {
            inputs.push(input);
        }
    }
}

impl Files for Scene {
    fn spectrum(&self, file: &str) -> Result<Spectrum, String> {
        let path = self.path(file);
        if !Path::new(&path).is_file() {
            return Err(format!("{path}: no such file; expected a spectrum"));
        }
        let found = single(&path, None, None, SecondRadiation::default()).map_err(|e| e.message)?;
        self.note(found.input);
        Ok(found.measured.spectrum)
    }

    fn luminaire(&self, file: &str) -> Result<Luminaire, String> {
        let path = self.path(file);
        let bytes = fs::read(&path).map_err(|e| format!("{path}: cannot be read: {e}; expected a lamp file"))?;
        let read = format::open(&bytes, &ReadOptions { format: None, repair: false });
        let file = read.map_err(|e| e.in_file(&path).to_string())?;
        self.note(Input { path, sha256: checksum(&bytes) });
        Ok(file.value.luminaire)
    }

    fn meshes(&self, file: &str) -> Result<Vec<Object>, String> {
        let path = self.path(file);
        let bytes = fs::read(&path).map_err(|e| format!("{path}: cannot be read: {e}; expected a mesh"))?;
        let wrong = |e: mesh::Error| format!("{path}:{e}");
        let read = || {
            Ok(match Path::new(file).extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
                Some("obj") => mesh::obj::read(&bytes).map_err(wrong)?,
                Some("ply") => vec![mesh::ply::read(&bytes).map_err(wrong)?],
                Some("gltf" | "glb") => {
                    let beside = |name: &str| {
                        let own = beside(&path, name);
                        let bytes = fs::read(&own).map_err(|e| format!("{own}: cannot be read: {e}"))?;
                        self.note(Input { path: own, sha256: checksum(&bytes) });
                        Ok(bytes)
                    };
                    mesh::gltf::read(&bytes, beside).map_err(wrong)?
                }
                _ => return Err(format!("{path}: expected a mesh whose name ends in .ply, .obj, .gltf or .glb")),
            })
        };
        // Of a large file the checksum takes about as long as the triangles.
        let (objects, sha256) = std::thread::scope(|scope| {
            let sum = scope.spawn(|| checksum(&bytes));
            (read(), sum.join().expect("a checksum of bytes does not panic"))
        });
        let objects = objects?;
        self.note(Input { path, sha256 });
        Ok(objects)
    }

    fn picture(&self, file: &str) -> Result<PictureFile, String> {
        let (description, samples, inputs) = image::whole(&self.path(file)).map_err(|e| e.to_string())?;
        inputs.into_iter().for_each(|input| self.note(input));
        Ok(PictureFile { description, samples })
    }

    fn table(&self, file: &str) -> Result<Table, String> {
        let path = self.path(file);
        if !Path::new(&path).is_file() {
            return Err(format!("{path}: no such file; expected a measured BRDF"));
        }
        // A MERL table is told by its length; of one that was cut off the name says what it was to be.
        let named = Path::new(file).extension().is_some_and(|e| e.eq_ignore_ascii_case("binary"));
        let loaded = brdf::load(&path, named.then_some(Format::Merl));
        match loaded.subject?.value {
            brdf::Subject::Measured(read) => {
                self.note(loaded.input);
                Ok(read.table)
            }
            brdf::Subject::Described(_) => {
                Err(format!("{path}: found a model; expected a measured BRDF, or the model as `brdf`"))
            }
        }
    }
}

/// A file that a scene names, as a path.
fn beside(scene: &str, file: &str) -> String {
    Path::new(scene).parent().unwrap_or(Path::new("")).join(file).display().to_string()
}

/// What is to be said of a scene and of its readings beside their figures.
pub(super) fn findings(path: &str, built: &Built, readings: &[Reading]) -> Vec<Finding> {
    let incomplete = built.incomplete.iter().map(|i| {
        let name = i.mesh.as_ref().map_or_else(String::new, |n| format!(" of `{n}`"));
        let message = format!(
            "{} of {} triangles{name} in {} were left out: they span no area, or a corner is not finite; the first is triangle {}",
            i.triangles,
            i.of,
            beside(path, &i.file),
            i.first
        );
        Finding::warning("R003", message)
            .at(Location::at(i.line, i.column).in_file(path))
            .hint("faces count as the file gives them, those of more than three corners as several triangles")
    });
    // A gonioreflectometer brings its own light.
    let brings_light = |i: &Instrument| matches!(i.kind, Kind::Gonioreflectometer(_));
    let is_dark = built.scene.lights().is_empty() && !built.instruments.iter().all(brings_light);
    let dark = is_dark.then(|| {
        let finding = Finding::warning("R002", "nothing shines in the scene: every reading is 0");
        finding.at(Location::default().in_file(path)).hint("a [[light]], or a shape with an emission")
    });
    let preview = (!built.settings.limits.shadows).then(|| {
        let finding =
            Finding::warning("R007", "a preview, direct light without shadows: no figure of it is a measurement");
        finding.at(Location::default().in_file(path)).hint("the solver `path` measures")
    });
    let endless = built.endless.then(|| {
        let message = "a closed space that absorbs nothing: what the solver leaves out of it has no bound, and no audit follows it";
        let finding = Finding::warning("R009", message);
        finding.at(Location::default().in_file(path)).hint("a reflectance below 1, or an opening")
    });
    let empty = built.instruments.iter().filter_map(|i| match &i.kind {
        Kind::Gonioreflectometer(g) if !g.has_sample(&built.scene) => {
            let message =
                format!("sensor `{}`: no surface is under the spot, and nothing is reflected from there", i.name);
            let finding = Finding::warning("R011", message).at(Location::default().in_file(path));
            Some(finding.hint("`at` on the sample, `normal` to its outside"))
        }
        _ => None,
    });
    let faults = (readings.iter().filter(|r| r.faults.count() > 0)).map(|r| {
        let f = &r.faults;
        let message = format!(
            "sensor `{}`: {} samples were left out: {} with a NaN, {} infinite, {} negative",
            r.name,
            f.count(),
            f.nan,
            f.infinite,
            f.negative
        );
        Finding::warning("R001", message).at(Location::default().in_file(path))
    });
    let missed = missed(built).map(|(lights, sensors)| {
        let message = format!(
            "light of one direction ({lights}) that comes through glass or off mirrors is left out of what {sensors} read"
        );
        Finding::warning("R012", message)
            .at(Location::default().in_file(path))
            .hint("the solver `bidirectional` finds it on surfaces and flat grids, no solver at a single point; a small shape that shines has a direction to be met from")
    });
    // What is known is the error of a half, which is sampled with twice the variance.
    let is_worse = |price: &Price| price.after > std::f64::consts::SQRT_2 * price.before;
    let filtered = readings.iter().filter_map(|r| Some((r, r.denoised.filter(is_worse)?)));
    let filtered = filtered.map(|(r, price)| {
        let [after, before] = [price.after, price.before].map(|error| significant(100.0 * error, 2));
        let message =
            format!("sensor `{}`: filtered, its pixels are off by {after} %, as sampled by {before} %", r.name);
        Finding::warning("R010", message)
            .at(Location::default().in_file(path))
            .hint("leave out `denoise`, or take more samples")
    });
    let gains = built.gains.iter().map(|gain| {
        let [most, angle] = [gain.reflectance, gain.theta_deg].map(|v| significant(v, 3));
        let message = format!(
            "the table of material `{}` gives back {most} of what arrives at {angle}° to the normal: more than it gets",
            gain.material
        );
        Finding::warning("R013", message).at(Location::at(gain.line, gain.column).in_file(path)).hint(
            "what was measured stands; in a closed space of such surfaces light may grow, and paths need `max_edges`",
        )
    });
    incomplete
        .chain(gains)
        .chain(dark)
        .chain(preview)
        .chain(endless)
        .chain(empty)
        .chain(missed)
        .chain(faults)
        .chain(filtered)
        .collect()
}

/// The lights of which polished surfaces throw what no path meets, and the sensors that miss it.
fn missed(built: &Built) -> Option<(String, String)> {
    let (settings, analysis) = (&built.settings, &built.analysis);
    if !analysis.caustics_missed || built.radiosity.is_some() || settings.limits.follow == Follow::Nothing {
        return None;
    }
    // Packets land on surfaces, and are connected with lenses.
    let is_missed = |place: &Place| !settings.packets || matches!(place, Place::Point(_));
    let misses = |i: &&Instrument| match &i.kind {
        Kind::Meter(meter) => !matches!(meter.place, Place::Around) && is_missed(&meter.place),
        Kind::Grid { meters, .. } => meters.iter().any(|meter| is_missed(&meter.place)),
        Kind::Camera(_) => !settings.packets,
        Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_) => false,
    };
    let sensors: Vec<String> = built.instruments.iter().filter(misses).map(|i| format!("`{}`", i.name)).collect();
    (!sensors.is_empty()).then(|| (analysis.closed_form_lights.join(", "), sensors.join(", ")))
}
