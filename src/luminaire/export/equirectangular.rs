//! The distribution as a picture over its two angles, in OpenEXR.
//!
//! Width is twice the height N. The centre of the pixel in column i and row j (from the top left) looks to
//!
//! ```text
//! C = (i + ½) · 360° / (2N)      γ = 180° − (j + ½) · 180° / N
//! ```
//!
//! so that the top is up, the bottom down (the photometric axis), and C runs from left to right. C turns from x to y, which is to
//! the left for somebody at the lamp who looks outwards: seen as a panorama, the picture is mirrored. Channel `Y` holds the
//! intensity in cd (W/sr, µmol/(s·sr)) as 32-bit numbers, negative ones too.

use super::notes::{heading, not_carried, pixelled};
use super::picture::{Picture, side};
use super::{ExportFile, Exported};
use crate::finding::Checked;
use crate::luminaire::Luminaire;

/// Height in pixels by default.
pub const HEIGHT: usize = 1024;

/// Writes the picture; `pixels` is its height.
///
/// # Errors
/// [`Error::Pixels`](super::Error::Pixels), [`Error::Picture`](super::Error::Picture).
pub fn write(luminaire: &Luminaire, pixels: Option<usize>) -> Exported {
    let height = side(pixels, HEIGHT)?;
    let (width, step_deg) = (2 * height, 180.0 / height as f64);
    let d = &luminaire.distribution;
    let columns: Vec<(f64, f64)> = (0..width).map(|i| ((i as f64 + 0.5) * step_deg).to_radians().sin_cos()).collect();
    let rows: Vec<(f64, f64)> =
        (0..height).map(|j| (180.0 - (j as f64 + 0.5) * step_deg).to_radians().sin_cos()).collect();
    let picture = Picture::of(width, height, |i, j| {
        let ((sin_c, cos_c), (sin_g, cos_g)) = (columns[i], rows[j]);
        d.towards(glam::DVec3::new(sin_g * cos_c, sin_g * sin_c, -cos_g)) as f32
    });
    let turn_rad = std::f64::consts::TAU / width as f64;
    let edge = |j: usize| (j as f64 * step_deg).to_radians().cos();
    let row_flux = |j: usize| {
        let row = &picture.pixels[j * width..(j + 1) * width];
        row.iter().map(|v| f64::from(*v)).sum::<f64>() * turn_rad * (edge(j) - edge(j + 1))
    };
    let flux = (0..height).map(row_flux).sum();
    let mut comments = heading(luminaire, "equirectangular intensity picture");
    comments.extend([
        super::notes::AXES.to_owned(),
        format!("pixel (column i, row j from the top left): C = (i + 0.5) * {step_deg} deg, gamma = 180 - (j + 0.5) * {step_deg} deg"),
        "C from +x (C0) to +y (C90); gamma from -z (down, bottom row) to +z (up, top row)".to_owned(),
        "seen as a panorama from the lamp the picture is mirrored: C increases to the right here".to_owned(),
    ]);
    let mut findings = not_carried(luminaire, "a picture", false);
    findings.push(pixelled(luminaire, flux, &format!("at {width} × {height} pixels")));
    let bytes = picture.to_exr(&comments)?;
    Ok(Checked { value: vec![ExportFile { suffix: ".exr".to_owned(), bytes }], findings })
}
