//! The report of `capture brdf`: what it takes besides the measurements, and its pictures.

use std::path::Path;

use super::shots::shots;
use crate::brdf::audit::{self, audit};
use crate::brdf::fit::{Fit, wavelengths};
use crate::capture::brdf::{Scene, next_lights, reciprocity};
use crate::capture::manifest::Shows;
use crate::cli::Failure;
use crate::cli::capture::develop::Darkroom;
use crate::cli::capture::photos::Photos;
use crate::cli::output::write_file;
use crate::plot::brdf::{Tint, albedo_panel, sphere_panel};
use crate::plot::capture::{coverage_panel, halves_panel, maps_panels, response_panel};
use crate::plot::{Format, Panel, data_uri, draw};
use crate::report::brdf_fit;
use crate::report::capture::channel_name;
use crate::report::capture_brdf::{Answer, Scale, StackSeen};
use crate::report::capture_page::{More, Parts, Pictures, page};
use crate::report::html::Figure;

/// Lights that are named for the next photographs.
const NEXT: usize = 3;
/// Sides of the pictures beside a model, at most.
const SIDE: usize = 240;

/// What is known without looking at the pictures again; `size` is theirs.
pub(super) fn more(scene: &Scene, size: (usize, usize), shown: &Answer<'_>) -> More {
    let (reachable, next) = next_lights(scene, size, shown.binned, NEXT);
    More {
        audit: best(shown).map(|f| audit(f.brdf.as_ref(), &audit::Limits::of(f.brdf.as_ref()))),
        reciprocity: reciprocity(shown.all, shown.binned.resolution),
        reachable,
        next,
        residuals: Vec::new(),
    }
}

fn best<'a>(shown: &Answer<'a>) -> Option<&'a Fit> {
    shown.fits.map(|f| &f.fits[brdf_fit::best(f)])
}

/// Writes the report, and adds the residuals of the photographs to `more`.
pub(super) fn write(
    photos: &mut Photos,
    room: &mut Darkroom,
    scene: &Scene,
    shown: &Answer<'_>,
    more: &mut More,
    path: &Path,
) -> Result<(), Failure> {
    let pictures = pictures(photos, room, scene, shown, more)?;
    let Some(camera) = &photos.manifest.camera else { return Ok(()) };
    let title = format!("BRDF of a photographed {}", scene.kind());
    let parts = Parts {
        title: photos.manifest.title.as_deref().unwrap_or(&title),
        answer: shown,
        more,
        inputs: &photos.inputs,
        findings: &photos.findings,
        camera,
        pictures: &pictures,
    };
    let read: Vec<String> = photos.inputs.iter().map(|i| i.path.clone()).collect();
    write_file(path, page(&parts).html().as_bytes(), &read)
}

/// Draws the pictures, and adds the residuals of the photographs to `more`: they are read once more, one at a time.
fn pictures(
    photos: &mut Photos,
    room: &mut Darkroom,
    scene: &Scene,
    shown: &Answer<'_>,
    more: &mut More,
) -> Result<Pictures, Failure> {
    let names: Vec<String> = shown.all.channels.iter().map(ToString::to_string).collect();
    let filled = shown.filling.map(|f| &f.filled);
    let caption = match filled {
        None => "Measured part of the azimuths φd, by half angle θh and difference angle θd.",
        Some(_) => {
            "Measured part of the azimuths φd, by half angle θh and difference angle θd. Orange: nothing measured, inferred."
        }
    };
    let coverage = vec![figure(coverage_panel(shown.binned, filled).into(), caption)?];
    let mut out = Pictures { coverage, ..Pictures::default() };
    if let Some(curves) = room.curves() {
        let channels: Vec<String> = (0..curves.len()).map(|c| channel_name(curves.len(), c).to_owned()).collect();
        let caption = "The response: exposure that belongs to a code.";
        out.response.push(figure(response_panel(curves, &channels).into(), caption)?);
    }
    let Some(fit) = best(shown) else { return Ok(out) };
    for (band, name) in names.iter().enumerate() {
        let caption = format!("Bins with φd near 90° and {}, band {name}.", fit.template);
        out.lobes.push(figure(halves_panel(shown.binned, fit.brdf.as_ref(), band, name).into(), &caption)?);
    }
    let tint = match wavelengths(&shown.all.channels) {
        Some(nm) => Tint::of_wavelengths(&nm),
        None => Tint::of_channels(names.len()),
    };
    let energy = "Albedo of the best model over the angle of incidence; above 1 it reflects more than arrives.";
    out.energy.push(figure(albedo_panel(fit.brdf.as_ref(), &names).into(), energy)?);
    let sphere = "The best model as a sphere under a small lamp.";
    out.energy.push(picture(sphere_panel(fit.brdf.as_ref(), &tint).into(), sphere)?);
    let factor = if let Scale::Relative { factor } = shown.scale { *factor } else { 1.0 };
    for seen in shown.seen.iter().filter(|s| s.counts.valid > 0) {
        out.maps.extend(photos.untold(|photos| maps(photos, room, (scene, fit, factor), seen, &tint, more))?);
    }
    Ok(out)
}

/// Photograph, model and difference of a stack.
fn maps(
    photos: &mut Photos,
    room: &mut Darkroom,
    (scene, fit, factor): (&Scene, &Fit, f64),
    seen: &StackSeen,
    tint: &Tint,
    more: &mut More,
) -> Result<Vec<Figure>, Failure> {
    let shots = shots(&photos.manifest, Shows::Object)?;
    let Some(shot) = shots.iter().find(|s| s.name == seen.name) else { return Ok(Vec::new()) };
    let taking = shot.open(photos, room)?;
    let bands = taking.channels;
    // The values of a relative result were multiplied by the factor: the lights are weaker by it.
    let strength: Vec<f64> = seen.strength.iter().map(|s| s / factor).collect();
    let Some(mut growing) = scene.empty_maps(taking.size, bands, SIDE) else { return Ok(Vec::new()) };
    let scene = scene.lit_by(seen.pattern.clone());
    taking.strips(photos, room, &mut |strip| {
        scene.add_to_maps(&mut growing, strip, seen.place, &strength, fit.brdf.as_ref());
        Ok(())
    })?;
    let maps = growing.maps;
    if let Some((median, rms)) = maps.spread() {
        more.residuals.push((seen.name.clone(), median, rms));
    }
    let (photograph, model, difference) = maps_panels(&maps, tint, bands);
    let name = &seen.name;
    Ok(vec![
        picture(photograph.into(), &format!("{name}: the photograph."))?,
        picture(model.into(), &format!("{name}: the best model under the same light, with the same white."))?,
        drawn(difference.into(), &format!("{name}: measured over modelled less 1."), None, Format::Png)?,
    ])
}

/// A drawing in a page: lines and letters stay sharp, and are large enough for a phone.
fn figure(panel: Panel, caption: &str) -> Result<Figure, Failure> {
    drawn(panel, caption, Some((520, 480)), Format::Svg)
}

/// A picture of pixels in a page, small enough to be sent.
fn picture(panel: Panel, caption: &str) -> Result<Figure, Failure> {
    drawn(panel, caption, Some((480, 480)), Format::Png)
}

fn drawn(panel: Panel, caption: &str, size: Option<(u32, u32)>, format: Format) -> Result<Figure, Failure> {
    let file = draw(&[panel], size, format).map_err(|e| Failure::Message(e.to_string()))?;
    let (uri, caption) = (data_uri(&file, format), caption.to_owned());
    Ok(Figure { uri, alt: caption.clone(), caption, large_letters: true })
}
