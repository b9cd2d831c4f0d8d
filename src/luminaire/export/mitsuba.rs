//! A light source for Mitsuba 3: six `projector`s about one point.
//!
//! Mitsuba 3.9.1 has no goniometric emitter. Its `projector` is a point light whose intensity is a picture seen through a
//! pinhole camera, and six of them with a field of view of 90° are the faces of a cube: together a point light with any
//! distribution. Mitsuba gives a projector the intensity π · texture / cos³θ, θ from the face's centre (so that a constant texture
//! lights a plane evenly); the pictures hold
//!
//! ```text
//! texture = I cos³θ / π,    cosθ = 1 / √(1 + X² + Y²),    direction ∝ X·left + Y·top + forward
//! X = 1 − 2 (i + ½) / N,    Y = 1 − 2 (j + ½) / N        (column i, row j from the top left)
//! ```
//!
//! between which Mitsuba interpolates bilinearly. Faces without light are left out. As a delta light it does not show in pictures.

use std::f64::consts::PI;

use glam::DVec3;

use super::notes::{AXES, Units, as_point, checked_stem, heading, negative, not_carried, other_kind, pixelled};
use super::picture::{Picture, side};
use super::{Error, ExportFile, Exported};
use crate::finding::Checked;
use crate::luminaire::Luminaire;

/// Pixels on a side of each face by default.
pub const SIDE: usize = 512;

/// The faces: name, forward and top.
const FACES: [(&str, DVec3, DVec3); 6] = [
    ("down", DVec3::NEG_Z, DVec3::Y),
    ("c0", DVec3::X, DVec3::Z),
    ("c90", DVec3::Y, DVec3::Z),
    ("c180", DVec3::NEG_X, DVec3::Z),
    ("c270", DVec3::NEG_Y, DVec3::Z),
    ("up", DVec3::Z, DVec3::Y),
];

/// Writes the scene (`STEM.xml`, which names the pictures) and the pictures; `pixels` on a side of each.
///
/// # Errors
/// [`Error::Name`], [`Error::Pixels`], [`Error::Picture`].
pub fn write(luminaire: &Luminaire, stem: &str, pixels: Option<usize>) -> Exported {
    checked_stem(stem)?;
    // Mitsuba takes `$` for the name of a parameter.
    if stem.contains('$') {
        return Err(Error::Name { found: stem.to_owned() });
    }
    let n = side(pixels, SIDE)?;
    let d = &luminaire.distribution;
    let at = |i: usize| 1.0 - 2.0 * (i as f64 + 0.5) / n as f64;
    let mut emitters = String::new();
    let mut files = Vec::new();
    let mut sum = 0.0;
    for (name, forward, top) in FACES {
        let left = top.cross(forward);
        let picture = Picture::of(n, n, |i, j| {
            let towards = left * at(i) + top * at(j) + forward;
            let length = towards.length();
            (d.towards(towards / length).max(0.0) / (PI * length.powi(3))) as f32
        });
        let light: f64 = picture.pixels.iter().map(|v| f64::from(*v)).sum();
        sum += light;
        // A scene without any emitter would render black with a warning only.
        if light == 0.0 && !(name == "up" && files.is_empty()) {
            continue;
        }
        emitters.push_str(&emitter(stem, name, [left, top, forward]));
        let mut comments = heading(luminaire, "face of a projector for Mitsuba 3");
        comments.extend([
            AXES.to_owned(),
            format!("face {name}: forward {forward}, top {top}, left {left}"),
            "pixels: intensity * cos(theta)^3 / pi, theta from the face's centre".to_owned(),
        ]);
        files.push(ExportFile { suffix: format!("-{name}.exr"), bytes: picture.to_exr(&comments)? });
    }
    // A pixel of a face is (2/N)² cos³θ sr wide.
    let flux = sum * PI * (2.0 / n as f64).powi(2);
    files.insert(0, ExportFile { suffix: ".xml".to_owned(), bytes: scene(luminaire, &emitters).into_bytes() });
    let mut findings = not_carried(luminaire, "Mitsuba", true);
    findings.extend(as_point(luminaire, "Mitsuba"));
    findings.extend(negative(luminaire));
    findings.extend(other_kind(luminaire));
    findings.push(pixelled(luminaire, flux, &format!("at {n} × {n} pixels on the faces of a cube")));
    Ok(Checked { value: files, findings })
}

fn scene(luminaire: &Luminaire, emitters: &str) -> String {
    let units = Units::of(luminaire.kind);
    // Two hyphens end a comment.
    let lines = heading(luminaire, "light source for Mitsuba 3").join("\n     ").replace("--", "- -");
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n\
         <!-- {lines}\n     \
         {AXES}; metres\n     \
         Mitsuba has no goniometric emitter: these projectors (90 degrees each, one per face of a cube that has light)\n     \
         make a point light with the lamp's distribution. Intensities are {}: irradiance is in {}, pictures in {}.\n     \
         To place the lamp, set lamp_to_world before including this file; for a scene with y up, begin with\n     \
         1 0 0 0  0 0 1 0  0 -1 0 0  0 0 0 1 (then C0 is +x, C90 is -z, down is -y). -->\n\
         <scene version=\"3.0.0\">\n    \
         <default name=\"lamp_to_world\" value=\"1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\"/>\n\
         {emitters}</scene>\n",
        units.intensity, units.arriving, units.seen
    )
}

fn emitter(stem: &str, face: &str, [left, top, forward]: [DVec3; 3]) -> String {
    let stem = stem.replace('&', "&amp;").replace('<', "&lt;");
    let row = |i: usize| format!("{} {} {} 0", left[i] + 0.0, top[i] + 0.0, forward[i] + 0.0);
    format!(
        "    <emitter type=\"projector\">\n        \
         <float name=\"fov\" value=\"90\"/>\n        \
         <transform name=\"to_world\">\n            \
         <matrix value=\"{}  {}  {}  0 0 0 1\"/>\n            \
         <matrix value=\"$lamp_to_world\"/>\n        \
         </transform>\n        \
         <texture type=\"bitmap\" name=\"irradiance\">\n            \
         <string name=\"filename\" value=\"{stem}-{face}.exr\"/>\n            \
         <boolean name=\"raw\" value=\"true\"/>\n            \
         <string name=\"wrap_mode\" value=\"clamp\"/>\n        \
         </texture>\n    \
         </emitter>\n",
        row(0),
        row(1),
        row(2)
    )
}
