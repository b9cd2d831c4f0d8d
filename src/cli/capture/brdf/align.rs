//! The camera and the edge of the sphere.

use crate::capture::camera::{Edge, fit_to_sphere};
use crate::capture::lights::outline::Outline;
use crate::capture::lights::view::{Ball, View};
use crate::capture::manifest::{Shows, Stack};
use crate::capture::radiance::Radiance;
use crate::cli::Failure;
use crate::cli::capture::develop::Darkroom;
use crate::cli::capture::photos::Photos;
use crate::finding::Finding;

use super::message;

/// Brings a camera that the board told into line with the edge of the sphere in the brightest of all pictures.
pub(super) fn align(photos: &mut Photos, room: &mut Darkroom) -> Result<Option<Edge>, Failure> {
    let Some(calibration) = room.calibration.clone() else { return Ok(None) };
    let (Some(sphere), Some(camera)) = (photos.manifest.sphere.clone(), photos.manifest.camera.clone()) else {
        return Ok(None);
    };
    let view = View::new(Some(&camera)).map_err(message)?;
    let stacks: Vec<Stack> = photos.manifest.stack.iter().filter(|s| s.shows == Shows::Object).cloned().collect();
    let mut brightest: Option<((usize, usize), Vec<f32>)> = None;
    for stack in &stacks {
        // What cannot be read is told when it is measured.
        if let Ok(pieces) = photos.untold(|photos| brighten(photos, room, stack, &mut brightest)) {
            room.keep(stack, pieces);
        }
    }
    let centre = glam::DVec3::from_array(sphere.centre_m);
    let seen = brightest.and_then(|((width, _), most)| {
        let top = most.iter().copied().fold(0.0, f32::max).max(f32::MIN_POSITIVE);
        let levels: Vec<f32> = most.iter().map(|v| v / top * 1e5).collect();
        let expected = view.outline(&Ball { centre, radius: sphere.radius_m })?;
        Outline::refined(&levels, width, &expected)
    });
    let errors = calibration.standard_errors;
    let own = view.axes().transpose() * (centre - glam::DVec3::from_array(camera.position_m));
    let edge = seen.and_then(|outline| {
        let prior = (errors[2].max(errors[3]), errors[0].max(errors[1]) / calibration.camera.intrinsics.fx);
        fit_to_sphere(calibration.camera, own, sphere.radius_m, &outline.points, prior)
    });
    match edge {
        Some(edge) => {
            let sigma = edge.moved_px.x / errors[2].max(1e-9);
            let words = format!(
                "the camera was brought into line with the edge of the sphere: principal point moved by {:.2}, {:.2} px, focal length by \
                 {:.3} %; the edge is {:.2} px rms off",
                edge.moved_px.x,
                edge.moved_px.y,
                100.0 * (edge.zoom - 1.0),
                edge.rms_px
            );
            let far = sigma.abs().max((edge.moved_px.y / errors[3].max(1e-9)).abs()) > 4.0;
            photos.findings.push(if far {
                Finding::warning("K027", words)
                    .hint("far more than the calibration allows: are camera and sphere where they are stated?")
            } else {
                Finding::info("K027", words)
            });
            if let Some(camera) = &mut photos.manifest.camera {
                camera.set_lens(&edge.camera);
            }
            Ok(Some(edge))
        }
        None => {
            let words = "no edge of the sphere was found: the camera is as the board told it";
            photos.findings.push(Finding::warning("K027", words).hint("a dark background shows it"));
            Ok(None)
        }
    }
}

/// Takes the brighter of each pixel's values and those of a stack, whose pieces it gives where there is room for them.
fn brighten(
    photos: &mut Photos,
    room: &mut Darkroom,
    stack: &Stack,
    brightest: &mut Option<((usize, usize), Vec<f32>)>,
) -> Result<Vec<Radiance>, Failure> {
    let told = photos.findings.len();
    let mut picture = room.develop(photos, stack)?;
    let size = (picture.width, picture.height);
    let (expected, most) = brightest.get_or_insert_with(|| (size, vec![0.0; size.0 * size.1]));
    if *expected != size {
        return Err(Failure::Message(format!("found {} × {} pixels; expected it like the others", size.0, size.1)));
    }
    let (mut pieces, mut first) = (Vec::new(), 0);
    while let Some(piece) = picture.next(photos, room)? {
        let luma = piece.values.chunks_exact(piece.channels).map(|p| p.iter().sum::<f32>());
        most[first..].iter_mut().zip(luma).for_each(|(m, v)| *m = m.max(v));
        first += piece.width * piece.height;
        if size.0 * size.1 * piece.channels <= room.room() {
            pieces.push(piece);
        }
    }
    // What is damaged has to be read, and told, again.
    Ok(if photos.findings.len() > told { Vec::new() } else { pieces })
}
