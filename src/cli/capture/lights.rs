//! `capture lights`: where the lights were, from photographs of balls.

use std::io::BufWriter;
use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use serde_json::json;

use super::develop::Darkroom;
use super::photos::{Form, Given, Photos, is_manifest};
use crate::capture::lights::adjust::{Evidence, Observation, Start, adjust};
use crate::capture::lights::highlight::{self, Highlight};
use crate::capture::lights::list::{self, Listed};
use crate::capture::lights::outline::Outline;
use crate::capture::lights::shading::{self, Entanglement, Points, Shaded};
use crate::capture::lights::view::{Ball, Ray, View};
use crate::capture::lights::{angle_deg, environment};
use crate::capture::manifest::{Shows, Stack};
use crate::capture::setup::{self, Place};
use crate::capture::{Error, Photo};
use crate::cli::output::Whole;
use crate::cli::{Failure, Talk};
use crate::finding::{Finding, Location};
use crate::image::format::exr;
use crate::report::capture_lights::{self as report, BallSeen, Compared, Seen, What};

/// Photographs, lists to compare and the form of the answer.
#[derive(Debug, Args)]
#[command(after_long_help = "\
A mirror ball shows the lamp: stacks that say shows = \"mirror-ball\". A diffuse ball (shows = \"object\" or \"reference\", with a [[ball]])
tells the direction of a distant light by its shading, to a few degrees. Without [camera] rays are parallel and directions are x to the
right, y upwards, z towards the camera. Two balls, or --distance, tell the place of a near light.

Examples:
  photopic capture lights capture.toml
  photopic capture lights chrome.*.png --mask chrome.mask.png --list lights.txt
  photopic capture lights capture.toml --environment surroundings.exr --json")]
pub(in crate::cli) struct LightsArgs {
    #[command(flatten)]
    given: Given,
    /// Mask of the ball, where photographs of a mirror ball are named directly.
    #[arg(long, value_name = "PICTURE")]
    mask: Option<PathBuf>,
    /// Directions from elsewhere to be compared: three numbers a line, or a name and three; by name, else in the order of the lights.
    #[arg(long, value_name = "FILE")]
    list: Vec<PathBuf>,
    /// Distance of all lamps from the first ball, m, where one ball is all there is.
    #[arg(long, value_name = "M")]
    distance: Option<f64>,
    /// Write the surroundings in the mirror ball of the first such stack as an equirectangular EXR.
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Width of that picture, pixels; it is half as high.
    #[arg(long, value_name = "PIXELS", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(2..=16384))]
    width: u32,
    /// Reflectance of the mirror ball.
    #[arg(long, value_name = "R", default_value_t = 1.0)]
    reflectance: f64,
    #[command(flatten)]
    form: Form,
    /// The lights as one table.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Write to a file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Angle between a list and the photographs from which on it is told, degrees: that of a highlight is known to a quarter of one.
const WRONG_DEG: f64 = 1.0;
/// Disagreement in standard errors from which on it is told.
const DISAGREES: f64 = 4.0;
/// Pixels between a mask and the edge in a photograph from which on it is told.
const MOVED_PX: f64 = 1.5;
/// Part of the ball's edge that has to be seen for that.
const WHOLE: f64 = 0.8;
/// Correlation from which on two numbers are told to be inseparable.
const INSEPARABLE: f64 = 0.9;

fn message(error: impl ToString) -> Failure {
    Failure::Message(error.to_string())
}

pub(super) fn lights(a: &LightsArgs, talk: Talk) -> Result<(), Failure> {
    if a.distance.is_some_and(|d| !(d > 0.0 && d.is_finite())) || !(a.reflectance > 0.0 && a.reflectance <= 1.0) {
        let words = "found a --distance or --reflectance out of range; expected above 0 m, and above 0 to 1";
        return Err(Failure::Message(words.to_owned()));
    }
    let mut photos = Photos::open("capture lights", &a.given, talk)?;
    if !a.given.files.iter().any(|f| is_manifest(f)) {
        direct(&mut photos, a);
    }
    let view = View::new(photos.manifest.camera.as_ref()).map_err(message)?;
    let linear = photos.manifest.response.linear;
    let mut run = Run { view, linear, names: Vec::new(), balls: Vec::new(), seen: Vec::new(), points: Vec::new() };
    run.look(&mut photos)?;
    if run.seen.is_empty() {
        photos.notes.print(&photos.findings);
        let words = "found no photograph that tells a light; expected stacks with shows = \"mirror-ball\", or of a diffuse [[ball]]";
        return Err(Failure::Message(words.to_owned()));
    }
    let places = run.places(a.distance)?;
    let starts: Vec<Start> = run.balls.iter().map(|b| b.start.clone()).collect();
    let adjusted = adjust(view, &starts, &places, &run.observations()).map_err(message)?;
    let entanglement = run.entanglement(|k| report::direction(&adjusted, k));
    let mut compared = run.stated(&photos, &adjusted);
    for path in &a.list {
        let path = path.display().to_string();
        let text = String::from_utf8_lossy(&photos.bytes(&path)?).into_owned();
        let listed = list::parse(&text).map_err(|e| Failure::Message(format!("{path}:{e}")))?;
        compared.push(run.listed(&path, &listed, |k| report::direction(&adjusted, k))?);
    }
    let balls: Vec<BallSeen> = run.balls.iter().map(BallInUse::seen).collect();
    let answer = report::Answer {
        names: &run.names,
        balls: &balls,
        seen: &run.seen,
        adjusted: &adjusted,
        compared: &compared,
        entanglement: entanglement.as_ref(),
    };
    notice(&mut photos, &run, &answer);
    if let Some(path) = &a.environment {
        run.environment(&mut photos, a, path, &adjusted.balls)?;
    }
    let settings = json!({
        "distance_m": a.distance, "lists": a.list.iter().map(|p| p.display().to_string()).collect::<Vec<_>>(),
        "reflectance": a.reflectance, "view": if view.camera.is_some() { "camera" } else { "parallel" },
    });
    let text = if a.csv { report::csv(&answer) } else { report::text(&answer) };
    photos.print(&settings, &[report::object(&answer)], &text, a.form.json, a.output.as_deref())
}

/// Photographs named directly: each is a stack of a mirror ball under a light of the same name.
fn direct(photos: &mut Photos, a: &LightsArgs) {
    let stacks = photos.manifest.stack.drain(..).flat_map(|s| s.exposures);
    let one = |exposure: crate::capture::manifest::Exposure| {
        let name =
            Path::new(&exposure.photo).file_stem().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        Stack { shows: Shows::MirrorBall, ..Stack::new(name, vec![exposure]) }
    };
    photos.manifest.stack = stacks.map(one).collect();
    let mask = a.mask.as_ref().map(|m| m.display().to_string());
    photos.manifest.ball = vec![setup::Ball { name: "ball".to_owned(), mask, ..setup::Ball::default() }];
}

/// A ball, and where it is.
struct BallInUse {
    name: String,
    outline: Outline,
    start: Start,
    parallel: bool,
}

impl BallInUse {
    fn seen(&self) -> BallSeen {
        let ball = (!self.parallel).then_some(self.start.ball);
        BallSeen { name: self.name.clone(), outline: self.outline.clone(), ball }
    }
}

/// What is known so far.
struct Run {
    view: View,
    linear: bool,
    names: Vec<String>,
    balls: Vec<BallInUse>,
    seen: Vec<Seen>,
    /// Of the diffuse balls, in the order of those in `seen`.
    points: Vec<Points>,
}

impl Run {
    /// Looks at all stacks; those that tell no light are left out.
    fn look(&mut self, photos: &mut Photos) -> Result<(), Failure> {
        let wanted = |s: &&Stack| s.shows == Shows::MirrorBall || (s.shows != Shows::Flat && s.ball.is_some());
        let stacks: Vec<Stack> = photos.manifest.stack.iter().filter(wanted).cloned().collect();
        for stack in &stacks {
            let looked = self.stack(photos, stack, &stacks);
            match looked {
                Ok(()) => {}
                Err(failure @ Failure::Message(_)) if stacks.len() > 1 => photos.left_out(&stack.name, &failure),
                Err(failure) => return Err(failure),
            }
        }
        Ok(())
    }

    fn stack(&mut self, photos: &mut Photos, stack: &Stack, all: &[Stack]) -> Result<(), Failure> {
        let (photo, name) = shortest(photos, stack)?;
        let ball = self.ball(photos, stack, all, &photo)?;
        let in_use = &self.balls[ball];
        let wrong = |e: Error| message(e);
        let luma = photo.luma();
        if let Some(edge) = Outline::refined(&luma, photo.width, &in_use.outline) {
            let away = edge.centre.distance(in_use.outline.centre).max((edge.radius - in_use.outline.radius).abs());
            // Where part of the ball is in the dark, what ends there is the light.
            if away > MOVED_PX && edge.around() > WHOLE {
                let words = format!(
                    "the edge of the ball is {away:.1} px from its outline: middle {:.1}, {:.1}, radius {:.1} px",
                    edge.centre.x, edge.centre.y, edge.radius
                );
                let hint = "was the ball moved, or is the mask of another picture?";
                photos.findings.push(Finding::warning("K020", words).hint(hint).at(Location::default().of_item(&name)));
            }
        }
        let what = if stack.shows == Shows::MirrorBall {
            What::Highlight(highlight::find(&name, &photo, &in_use.outline).map_err(wrong)?)
        } else {
            let points = Points::of(&photo, &self.view, &in_use.start.ball, &in_use.outline);
            let shaded = shading::direction(&name, &points, self.linear || photo.is_linear()).map_err(wrong)?;
            self.points.push(points);
            What::Shading(shaded)
        };
        let light = stack.light.as_deref().unwrap_or(&stack.name);
        let light = self.names.iter().position(|n| n == light).unwrap_or_else(|| {
            self.names.push(light.to_owned());
            self.names.len() - 1
        });
        self.seen.push(Seen { stack: stack.name.clone(), photo: name, light, ball, what });
        Ok(())
    }

    /// Number of the ball of a stack, found when first met.
    fn ball(&mut self, photos: &mut Photos, stack: &Stack, all: &[Stack], photo: &Photo) -> Result<usize, Failure> {
        let described = described(photos, stack)?;
        if let Some(n) = self.balls.iter().position(|b| b.name == described.name) {
            return Ok(n);
        }
        let stated = described.centre_m.zip(described.radius_m).filter(|_| self.view.camera.is_some());
        let outline = match (&described.circle_px, &described.mask) {
            (Some(circle), _) => Some(Outline::stated(*circle)),
            (None, Some(mask)) => Some(mask_outline(photos, mask, photo)?),
            (None, None) if stated.is_some() => None,
            (None, None) => Some(brightest(photos, all, stack, photo).ok_or_else(|| {
                Failure::Message(format!(
                    "found no round edge of ball {} in its photographs; expected `mask` or `circle_px` in its [[ball]], or --mask",
                    described.name
                ))
            })?),
        };
        let ball = match stated {
            Some((centre, radius)) => Ball { centre: DVec3::from_array(centre), radius },
            None => {
                let outline = outline.as_ref().ok_or_else(|| message("found no outline of a ball; expected one"))?;
                self.view.ball(outline, described.radius_m).map_err(message)?
            }
        };
        let start = Start { ball, outline: outline.clone(), stated: stated.is_some() };
        let outline = match outline {
            Some(outline) => outline,
            None => self.view.outline(&ball).ok_or_else(|| {
                message("found a ball out of the camera's sight; expected camera and centre in one frame")
            })?,
        };
        self.balls.push(BallInUse { name: described.name, outline, start, parallel: self.view.camera.is_none() });
        Ok(self.balls.len() - 1)
    }

    /// The reflected ray of a highlight.
    fn ray(&self, seen: &Seen) -> Option<Ray> {
        let What::Highlight(Highlight { pixel, .. }) = seen.what else { return None };
        self.balls[seen.ball].start.ball.reflected(self.view.ray(pixel)?)
    }

    /// Where each light seems to be: near where two balls or a distance tell it, else distant.
    fn places(&self, distance: Option<f64>) -> Result<Vec<Place>, Failure> {
        let place = |k: usize| {
            let mine: Vec<&Seen> = self.seen.iter().filter(|s| s.light == k).collect();
            let rays: Vec<Ray> = mine.iter().filter_map(|s| self.ray(s)).collect();
            let turn = |s: &&Seen| match s.what {
                What::Highlight(h) => self.balls[s.ball].start.ball.turn_per_pixel(&self.view, h.pixel),
                What::Shading(_) => None,
            };
            // Rays that meet under less than three pixels' turn tell no distance.
            let least = 3.0 * mine.iter().filter_map(turn).fold(0.0, f64::max);
            if self.view.camera.is_some() {
                if let Some(p) = highlight::position(&rays, least) {
                    return Ok(Place::Near(p.to_array()));
                }
                if let (Some(distance), Some(ray)) = (distance, rays.first()) {
                    let centre = self.balls[0].start.ball.centre;
                    let p = highlight::at_distance(ray, centre, distance).ok_or_else(|| {
                        Failure::Message(format!("found a --distance of {distance} m; expected one beyond the ball"))
                    })?;
                    return Ok(Place::Near(p.to_array()));
                }
            }
            let shaded =
                mine.iter().filter_map(|s| if let What::Shading(s) = s.what { Some(s.direction) } else { None });
            let direction = highlight::direction(&rays).or_else(|| shaded.sum::<DVec3>().try_normalize());
            direction.map(|d| Place::Distant(d.to_array())).ok_or_else(|| {
                Failure::Message(format!("found sights of light {} that cancel out; expected one lamp", self.names[k]))
            })
        };
        (0..self.names.len()).map(place).collect()
    }

    fn observations(&self) -> Vec<Observation> {
        let one = |s: &Seen| {
            let evidence = match s.what {
                What::Highlight(h) => Evidence::Highlight(h.pixel),
                What::Shading(Shaded { direction, spread_deg, .. }) => {
                    Evidence::Shading(direction, spread_deg.max(LEAST_SPREAD_DEG).to_radians())
                }
            };
            Observation { light: s.light, ball: s.ball, evidence }
        };
        self.seen.iter().map(one).collect()
    }

    /// What shading tells apart, under the lights found.
    fn entanglement(&self, direction: impl Fn(usize) -> DVec3) -> Option<Entanglement> {
        if self.linear {
            return None;
        }
        let lights = self.seen.iter().filter(|s| matches!(s.what, What::Shading(_))).map(|s| direction(s.light));
        let all: Vec<(&Points, DVec3)> = self.points.iter().zip(lights).collect();
        (!all.is_empty()).then(|| shading::entanglement(&all)).flatten()
    }

    /// The directions that the manifest states for lights that were found too.
    fn stated(&self, photos: &Photos, adjusted: &crate::capture::lights::adjust::Adjusted) -> Vec<Compared> {
        let centre = adjusted.balls[0].centre;
        let listed: Vec<Listed> = (photos.manifest.light.iter())
            .filter(|l| self.names.contains(&l.name))
            .map(|l| {
                let direction = match l.place {
                    Place::Near(p) => DVec3::from_array(p) - centre,
                    Place::Distant(d) => DVec3::from_array(d),
                };
                Listed { name: Some(l.name.clone()), direction }
            })
            .collect();
        if listed.is_empty() {
            return Vec::new();
        }
        self.listed("the manifest", &listed, |k| report::direction(adjusted, k)).into_iter().collect()
    }

    /// A list beside the lights found: by name where its names are theirs, else in order.
    fn listed(&self, source: &str, listed: &[Listed], direction: impl Fn(usize) -> DVec3) -> Result<Compared, Failure> {
        let named = |l: &Listed| l.name.as_ref().and_then(|n| self.names.iter().position(|m| m == n));
        let by_name: Vec<(usize, DVec3)> = listed.iter().filter_map(|l| named(l).map(|k| (k, l.direction))).collect();
        let pairs = match () {
            () if by_name.len() == listed.len() => by_name,
            () if listed.len() == self.names.len() => {
                listed.iter().enumerate().map(|(k, l)| (k, l.direction)).collect()
            }
            () => {
                return Err(Failure::Message(format!(
                    "{source}: found {} lights; expected {}, one for each light of the photographs, or their names",
                    listed.len(),
                    self.names.len()
                )));
            }
        };
        let (lights, listed): (Vec<usize>, Vec<DVec3>) = pairs.into_iter().unzip();
        let found: Vec<DVec3> = lights.iter().map(|k| direction(*k)).collect();
        let difference = list::compare(&listed, &found);
        Ok(Compared { source: source.to_owned(), lights, listed, difference })
    }

    /// Writes the surroundings that the first mirror ball shows.
    fn environment(&self, photos: &mut Photos, a: &LightsArgs, path: &Path, balls: &[Ball]) -> Result<(), Failure> {
        let seen = self.seen.iter().find(|s| matches!(s.what, What::Highlight(_)));
        let seen = seen.ok_or_else(|| message("found no mirror ball; expected one for --environment"))?;
        let stack = photos.manifest.stack.iter().find(|s| s.name == seen.stack).cloned();
        let stack = stack.ok_or_else(|| message("found no stack of the mirror ball; expected one"))?;
        let picture = Darkroom::open(photos)?.picture(photos, &stack)?.0;
        let map =
            environment::equirectangular(&self.view, &balls[seen.ball], &picture, a.reflectance, a.width as usize);
        write_exr(photos, path, map)
    }
}

/// Least spread that shading is believed to have, degrees: no real surface is Lambert's to better.
const LEAST_SPREAD_DEG: f64 = 0.5;

fn write_exr(photos: &Photos, path: &Path, mut map: crate::image::Memory) -> Result<(), Failure> {
    let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).collect();
    let mut whole = Whole::open(path, &read)?;
    let out = BufWriter::with_capacity(1 << 18, whole.file());
    exr::write(out, &mut map, exr::Depth::Float)
        .map_err(|e| Failure::Message(format!("{}: cannot be written: {e}", path.display())))?;
    whole.finish()
}

/// The description of the ball in a stack.
fn described(photos: &Photos, stack: &Stack) -> Result<setup::Ball, Failure> {
    let manifest = &photos.manifest;
    let named = |name: &String| {
        manifest.ball.iter().find(|b| b.name == *name).cloned().ok_or_else(|| {
            Failure::Message(format!(
                "stack {}: found no [[ball]] called {name}; expected `ball` to name one",
                stack.name
            ))
        })
    };
    match (&stack.ball, manifest.ball.as_slice(), &manifest.sphere) {
        (Some(name), _, _) => named(name),
        (None, [one], _) => Ok(one.clone()),
        (None, [], Some(sphere)) if manifest.camera.is_some() => Ok(setup::Ball {
            name: "sphere".to_owned(),
            mask: None,
            circle_px: None,
            centre_m: Some(sphere.centre_m),
            radius_m: Some(sphere.radius_m),
        }),
        _ => Err(Failure::Message(format!(
            "stack {}: found {} [[ball]]; expected `ball` to name one",
            stack.name,
            manifest.ball.len()
        ))),
    }
}

/// The shortest exposure of a stack, where the lamp is least spread, and its name.
fn shortest(photos: &mut Photos, stack: &Stack) -> Result<(Photo, String), Failure> {
    let by_time = |e: &&crate::capture::manifest::Exposure| e.time_s.unwrap_or(f64::INFINITY);
    let first = stack.exposures.iter().min_by(|a, b| by_time(a).total_cmp(&by_time(b)));
    let name = first.map(|e| e.photo.clone());
    let name = name.ok_or_else(|| Failure::Message(format!("found no photograph in {}; expected one", stack.name)))?;
    Ok((photos.photo(&name)?, name))
}

fn mask_outline(photos: &mut Photos, mask: &str, photo: &Photo) -> Result<Outline, Failure> {
    let path = photos.path(mask);
    let bytes = photos.bytes(&path)?;
    let wrong = |e: Error| Failure::Message(format!("{path}: {e}"));
    let picture = Photo::decode(&bytes).map_err(wrong)?;
    if (picture.width, picture.height) != (photo.width, photo.height) {
        return Err(wrong(Error::Setup {
            found: format!(
                "a mask of {} × {} pixels beside photographs of {} × {}",
                picture.width, picture.height, photo.width, photo.height
            ),
            expected: "a mask of the size of the photographs",
        }));
    }
    let inside: Vec<bool> = picture.luma().iter().map(|v| *v > 127.5).collect();
    Outline::of_mask(&inside, picture.width).map_err(wrong)
}

/// The outline in the brightest of all photographs of the same ball, pixel by pixel.
fn brightest(photos: &mut Photos, all: &[Stack], stack: &Stack, photo: &Photo) -> Option<Outline> {
    let mut most = photo.luma();
    for other in all.iter().filter(|s| s.ball == stack.ball && s.shows == stack.shows && s.name != stack.name) {
        let Ok((other, _)) = shortest(photos, other) else { continue };
        if (other.width, other.height) == (photo.width, photo.height) {
            most.iter_mut().zip(other.luma()).for_each(|(m, v)| *m = m.max(v));
        }
    }
    Outline::of_photo(&most, photo.width)
}

/// What a user should know.
fn notice(photos: &mut Photos, run: &Run, a: &report::Answer<'_>) {
    let mut found = Vec::new();
    if run.names.len() == 1 {
        let hint = "a BRDF wants eight lights from near the camera to behind the object";
        found.push(Finding::warning("K010", "one light only: nothing confirms it").hint(hint));
    }
    for s in &run.seen {
        if let What::Highlight(Highlight { others, .. }) = s.what
            && others > 0
        {
            let words =
                format!("{others} more highlight(s) of a fifth of the lamp's flux or more; the brightest was taken");
            found.push(
                Finding::warning("K021", words).hint("was another light on?").at(Location::default().of_item(&s.photo)),
            );
        }
    }
    for (k, name) in run.names.iter().enumerate() {
        let from = angle_deg(a.direction(k), run.view.back(a.adjusted.balls[0].centre));
        if from > 90.0 {
            let words = format!("light {name} is behind the ball, {from:.1} degrees from the camera's direction");
            found.push(Finding::warning("K022", words).hint("it lights less than half of what the camera sees"));
        }
    }
    for (s, off) in run.seen.iter().zip(&a.adjusted.off_sigma).filter(|(_, off)| **off > DISAGREES) {
        let words = format!("what it tells of light {} is {off:.1} standard errors off the whole", run.names[s.light]);
        let hint = "was the lamp or a ball moved between photographs, or are two of them swapped?";
        found.push(Finding::warning("K023", words).hint(hint).at(Location::default().of_item(&s.photo)));
    }
    for c in a.compared {
        found.extend(wrong_list(run, a, c));
    }
    if let Some(e) = a.entanglement {
        let names = ["offset and gamma", "offset and roughness", "gamma and roughness"];
        for (names, r) in names.iter().zip(e.correlations).filter(|(_, r)| r.abs() > INSEPARABLE) {
            let words =
                format!("{names} of the diffuse ball are not told apart by these photographs (correlation {r:.3})");
            found.push(
                Finding::warning("K025", words).hint("`capture response` from several exposure times settles gamma"),
            );
        }
    }
    photos.findings.extend(found);
}

/// A list that is off by degrees.
fn wrong_list(run: &Run, a: &report::Answer<'_>, c: &Compared) -> Option<Finding> {
    let d = &c.difference;
    let highlighted = |k: usize| run.seen.iter().any(|s| s.light == k && matches!(s.what, What::Highlight(_)));
    // Shading alone is believed to three times its spread.
    let bound = |k: usize| {
        let spread = run.seen.iter().filter(|s| s.light == k).map(|s| match s.what {
            What::Shading(s) => 3.0 * s.spread_deg,
            What::Highlight(_) => 0.0,
        });
        if highlighted(k) { WRONG_DEG.max(3.0 * a.adjusted.errors_deg[k]) } else { spread.fold(WRONG_DEG, f64::max) }
    };
    let far: Vec<usize> = (0..c.lights.len()).filter(|i| d.angles_deg[*i] > bound(c.lights[*i])).collect();
    if far.is_empty() {
        return None;
    }
    let angles = far.iter().map(|i| d.angles_deg[*i]);
    let (least, most) = (angles.clone().fold(f64::INFINITY, f64::min), angles.fold(0.0, f64::max));
    let mut words = format!(
        "{} of {} directions of {} are {least:.1} to {most:.1} degrees off what the photographs show",
        far.len(),
        c.lights.len(),
        c.source
    );
    let listed = |l: usize| c.lights.iter().position(|k| *k == l).map(|at| c.listed[at]);
    let shading = report::from_shading(a.seen, listed).zip(report::from_shading(a.seen, |l| Some(a.direction(l))));
    if let Some((list, photographs)) = shading {
        words += &format!(
            "; the shading of the diffuse ball is {list:.1} degrees from them in the mean, {photographs:.1} from these"
        );
    }
    let left = d.turned_deg.iter().sum::<f64>() / d.turned_deg.len() as f64;
    let hint = match d.mirrored {
        Some(axis) => format!("its {axis} axis points the other way"),
        None => format!("one rotation of {:.1} degrees leaves {left:.1} in the mean", d.rotation_deg),
    };
    Some(Finding::warning("K024", words).hint(hint))
}
