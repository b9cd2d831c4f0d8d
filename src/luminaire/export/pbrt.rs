//! A light source for pbrt-v4: `LightSource "goniometric"` with its picture.
//!
//! pbrt asks for the intensity by a square picture in the equal-area octahedral mapping of the sphere (Clarberg 2008; pbrt-v4
//! `util/math.cpp`, `EqualAreaSquareToSphere`), of which it takes the nearest pixel, and swaps y and z between the light's frame
//! and the picture's. The scene therefore turns the light by −90° about x; then the picture's own axes are
//!
//! ```text
//! centre = the photometric axis (−z)    right = C0 (+x)    down = C90 (+y)    corners = up (+z)
//! ```
//!
//! Pixels hold candela, the mean of four directions. The `illuminant` of the colour space, pbrt's default spectrum, is divided by its own luminous integral,
//! so that with `scale` 1 pictures of an unscaled film (`cie1931` sensor, exposure 1, ISO 100) are in cd/m².

use super::notes::{
    AXES, SPHERE_SR, Units, as_point, checked_stem, heading, negative, not_carried, other_kind, pixelled,
};
use super::picture::{Picture, side};
use super::{ExportFile, Exported};
use crate::finding::Checked;
use crate::luminaire::Luminaire;

/// Pixels on a side by default.
pub const SIDE: usize = 1024;

/// Where a pixel is sampled, in pixels from its corner: a turned grid, so that of a pixel across the horizon, which is a diagonal of
/// the picture, one half of the samples is on either side.
const SAMPLES: [(f64, f64); 4] = [(0.625, 0.875), (0.875, 0.375), (0.375, 0.125), (0.125, 0.625)];

/// The direction of a point of the unit square in the picture's frame, for z towards the centre.
///
/// # Reference
/// P. Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", Journal of Graphics Tools 13 (2008).
fn direction(s: f64, t: f64) -> glam::DVec3 {
    let (u, v) = (2.0 * s - 1.0, 2.0 * t - 1.0);
    // 1 at the centre, 0 on the inner diamond (the equator), −1 in the corners.
    let inside = 1.0 - u.abs() - v.abs();
    let r = 1.0 - inside.abs();
    let phi = if r == 0.0 { 0.0 } else { ((v.abs() - u.abs()) / r + 1.0) * std::f64::consts::FRAC_PI_4 };
    let across = r * (2.0 - r * r).sqrt();
    glam::DVec3::new((phi.cos() * across).copysign(u), (phi.sin() * across).copysign(v), (1.0 - r * r).copysign(inside))
}

/// Writes the scene (`STEM.pbrt`, which names `STEM.exr`) and the picture; `pixels` on a side.
///
/// # Errors
/// [`Error::Name`](super::Error::Name), [`Error::Pixels`](super::Error::Pixels), [`Error::Picture`](super::Error::Picture).
pub fn write(luminaire: &Luminaire, stem: &str, pixels: Option<usize>) -> Exported {
    checked_stem(stem)?;
    let n = side(pixels, SIDE)?;
    let d = &luminaire.distribution;
    let picture = Picture::of(n, n, |i, j| {
        let at = |(s, t): (f64, f64)| {
            let p = direction((i as f64 + s) / n as f64, (j as f64 + t) / n as f64);
            d.towards(glam::DVec3::new(p.x, p.y, -p.z)).max(0.0)
        };
        (SAMPLES.into_iter().map(at).sum::<f64>() / SAMPLES.len() as f64) as f32
    });
    let flux = picture.pixels.iter().map(|v| f64::from(*v)).sum::<f64>() * SPHERE_SR / (n * n) as f64;
    let units = Units::of(luminaire.kind);
    let mut comments = heading(luminaire, "goniometric picture for pbrt-v4");
    comments.extend([
        "equal-area octahedral mapping of the sphere; every pixel has the same solid angle".to_owned(),
        AXES.to_owned(),
        "picture: centre = photometric axis (-z), right = C0 (+x), down = C90 (+y), corners = up (+z)".to_owned(),
    ]);
    let mut scene: String = heading(luminaire, "light source for pbrt-v4").iter().map(|l| format!("# {l}\n")).collect();
    scene.push_str(&format!(
        "# {AXES}\n\
         # Include this file inside AttributeBegin/AttributeEnd behind the transformation that places the lamp; metres.\n\
         # In a scene with y up, replace the Rotate below by: Rotate 180 1 0 0 (then C0 is +x, C90 is -z, down is -y).\n\
         # Pixels are {} and scale is 1: an unscaled film (cie1931 sensor, exposure 1 s, ISO 100) is in {}.\n\
         # The light is a point, white like the colour space; give \"spectrum I\" for another spectrum.\n\
         AttributeBegin\n    \
         # From the picture's frame (pbrt swaps y and z: its centre is +y here) to the luminaire's.\n    \
         Rotate -90 1 0 0\n    \
         LightSource \"goniometric\" \"string filename\" \"{stem}.exr\" \"float scale\" 1\n\
         AttributeEnd\n",
        units.intensity, units.seen
    ));
    let mut findings = not_carried(luminaire, "pbrt", true);
    findings.extend(as_point(luminaire, "pbrt"));
    findings.extend(negative(luminaire));
    findings.extend(other_kind(luminaire));
    findings.push(pixelled(luminaire, flux, &format!("at {n} × {n} pixels of equal solid angle")));
    let bytes = picture.to_exr(&comments)?;
    let files = vec![
        ExportFile { suffix: ".pbrt".to_owned(), bytes: scene.into_bytes() },
        ExportFile { suffix: ".exr".to_owned(), bytes },
    ];
    Ok(Checked { value: files, findings })
}
