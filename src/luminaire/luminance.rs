//! Mean luminance of the luminous opening.

use glam::DVec3;

use super::distribution::System;
use super::model::{Body, Kind, Luminaire, Shape};
use super::unavailable::Unavailable;

/// Area of a luminous opening projected on a plane across the direction (C, γ), m².
///
/// - rectangle with sides: `l w |cos γ| + h (l |cos C| + w |sin C|) sin γ`
/// - upright (elliptic) cylinder: `π/4 l w |cos γ| + h √((w sin C)² + (l cos C)²) sin γ`
/// - upright ellipse, l or w being 0: `π/4 h (l |cos C| + w |sin C|) sin γ`
/// - ellipsoid: `π/4 √((w l cos γ)² + (l h cos C sin γ)² + (w h sin C sin γ)²)`
/// - cylinder along C90: `l √((h cos C sin γ)² + (w cos γ)²) + π/4 w h |sin C| sin γ`, likewise along C0
///
/// with the length l along C90–C270, the width w along C0–C180 and the height h. A flat body's sides are zero. A lying cylinder
/// without a height is as high as it is wide across its axis, a sphere as its shorter side. The top counts above the horizontal as the bottom does below.
///
/// # Reference
/// CIE 117:1995, eq. 4.4 and EN 13032-2 (the opening as a box); IES LM-63-19 (shapes).
#[must_use]
pub fn projected_area_m2(body: &Body, c_deg: f64, gamma_deg: f64) -> f64 {
    let ((sin_c, cos_c), (sin_g, cos_g)) = (c_deg.to_radians().sin_cos(), gamma_deg.to_radians().sin_cos());
    projected_area_towards_m2(body, DVec3::new(cos_c * sin_g, sin_c * sin_g, -cos_g))
}

/// The same for a direction as a unit vector in the luminaire's frame.
pub(super) fn projected_area_towards_m2(body: &Body, direction: DVec3) -> f64 {
    use std::f64::consts::FRAC_PI_4;
    let DVec3 { x, y, z } = direction.abs();
    let Body { shape, length_m: l, width_m: w, height_m: h } = *body;
    let round_h = body.round_height_m();
    match shape {
        Shape::Point => 0.0,
        Shape::Rectangle => l * w * z + h * (l * x + w * y),
        Shape::Round if l == 0.0 || w == 0.0 => FRAC_PI_4 * h * (l * x + w * y),
        Shape::Round => FRAC_PI_4 * l * w * z + h * (w * y).hypot(l * x),
        Shape::Sphere => FRAC_PI_4 * (w * l * z).hypot(round_h * (l * x).hypot(w * y)),
        Shape::CylinderAlongC0 => w * (round_h * y).hypot(l * z) + FRAC_PI_4 * l * round_h * x,
        Shape::CylinderAlongC90 => l * (round_h * x).hypot(w * z) + FRAC_PI_4 * w * round_h * y,
    }
}

/// Luminance towards one C-plane at the γ asked for, cd/m².
#[derive(Debug, Clone, PartialEq)]
pub struct LuminanceRow {
    /// C-plane, degrees.
    pub c_deg: f64,
    /// Mean luminance at each γ; `None` where the opening shows no area.
    pub cd_per_m2: Vec<Option<f64>>,
}

/// γ of the luminance table of glare assessments, degrees (EN 12464-1, EN 13032-2).
pub const TABLE_GAMMA_DEG: [f64; 3] = [65.0, 75.0, 85.0];
/// Steps between the C-planes of that table, degrees.
pub const TABLE_C_STEP_DEG: f64 = 15.0;

/// Mean luminance of the opening in the direction (C, γ), cd/m²: intensity over projected area.
///
/// # Errors
/// [`Unavailable::NotTypeC`], [`Unavailable::NotLuminous`]; [`Unavailable::NoOpening`] where no area is seen.
pub fn luminance_cd_per_m2(luminaire: &Luminaire, c_deg: f64, gamma_deg: f64) -> Result<f64, Unavailable> {
    let body = opening(luminaire)?;
    let area = projected_area_m2(body, c_deg, gamma_deg);
    if area > 0.0 { Ok(luminaire.distribution.at(c_deg, gamma_deg) / area) } else { Err(Unavailable::NoOpening) }
}

/// The luminance table: rows C0, C15 … C345, columns the γ given ([`TABLE_GAMMA_DEG`]).
///
/// # Errors
/// [`Unavailable::NotTypeC`], [`Unavailable::NotLuminous`], [`Unavailable::NoOpening`].
pub fn luminance_table(luminaire: &Luminaire, gamma_deg: &[f64]) -> Result<Vec<LuminanceRow>, Unavailable> {
    opening(luminaire)?;
    let planes = (360.0 / TABLE_C_STEP_DEG) as usize;
    let row = |i: usize| {
        let c_deg = TABLE_C_STEP_DEG * i as f64;
        let cd_per_m2 = gamma_deg.iter().map(|g| luminance_cd_per_m2(luminaire, c_deg, *g).ok()).collect();
        LuminanceRow { c_deg, cd_per_m2 }
    };
    Ok((0..planes).map(row).collect())
}

/// The luminous opening of a luminaire whose luminance is defined.
pub(super) fn opening(luminaire: &Luminaire) -> Result<&Body, Unavailable> {
    if luminaire.kind != Kind::Luminous {
        return Err(Unavailable::NotLuminous);
    }
    if luminaire.distribution.system() != System::TypeC {
        return Err(Unavailable::NotTypeC);
    }
    let seen = |body: &&Body| projected_area_m2(body, 45.0, 45.0) > 0.0;
    luminaire.opening.as_ref().filter(seen).ok_or(Unavailable::NoOpening)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(shape: Shape, length_m: f64, width_m: f64, height_m: f64) -> Body {
        Body { shape, length_m, width_m, height_m }
    }

    #[test]
    fn areas_along_the_axes_are_the_faces() {
        use std::f64::consts::FRAC_PI_4;
        // Down, towards C0, towards C90.
        let faces = |b: Body| [(0.0, 0.0), (0.0, 90.0), (90.0, 90.0)].map(|(c, g)| projected_area_m2(&b, c, g));
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-15);
        assert!(near(faces(body(Shape::Rectangle, 3.0, 2.0, 0.5)), [6.0, 1.5, 1.0]));
        assert!(near(faces(body(Shape::Round, 3.0, 2.0, 0.5)), [FRAC_PI_4 * 6.0, 1.5, 1.0]));
        assert!(near(faces(body(Shape::Sphere, 3.0, 2.0, 0.5)), [6.0, 1.5, 1.0].map(|a| FRAC_PI_4 * a)));
        assert!(near(faces(body(Shape::CylinderAlongC90, 3.0, 2.0, 0.0)), [6.0, 6.0, FRAC_PI_4 * 4.0]));
        assert!(near(faces(body(Shape::CylinderAlongC0, 2.0, 3.0, 2.0)), [6.0, FRAC_PI_4 * 4.0, 6.0]));
        // A short drum: the axis cannot be told from the sides.
        assert!(near(faces(body(Shape::CylinderAlongC0, 2.0, 2.0, 2.0)), [4.0, FRAC_PI_4 * 4.0, 4.0]));
        assert!(near(faces(body(Shape::CylinderAlongC90, 2.0, 2.0, 2.0)), [4.0, 4.0, FRAC_PI_4 * 4.0]));
        assert!(near(faces(body(Shape::Round, 3.0, 0.0, 2.0)), [0.0, FRAC_PI_4 * 6.0, 0.0]));
        assert_eq!(faces(body(Shape::Point, 0.0, 0.0, 0.0)), [0.0; 3]);
    }

    #[test]
    fn a_sphere_looks_the_same_from_everywhere() {
        let ball = body(Shape::Sphere, 0.2, 0.2, 0.2);
        for (c, g) in [(0.0, 0.0), (17.0, 33.0), (200.0, 81.0), (301.0, 120.0)] {
            assert!((projected_area_m2(&ball, c, g) - std::f64::consts::PI * 0.01).abs() < 1e-15);
        }
    }
}
