//! Luminaires.

use std::f64::consts::PI;

use glam::DVec3;

use super::Check;
use crate::luminaire::grid::{Placed, Plane, PointsAt, Receiver, Settings, illuminance};
use crate::luminaire::placement::{Orientation, Placement};
use crate::luminaire::{Body, Distribution, Luminaire, Shape, Symmetry, System};

/// The flux of a lamp of one plane; NaN where the table is none.
fn flux(vertical_deg: &[f64], values: &[f64]) -> f64 {
    let table =
        Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vertical_deg.to_vec(), values.to_vec());
    table.map_or(f64::NAN, |d| d.total_flux())
}

/// By how much a point is too bright for a Lambertian disc so many diameters above a floor; NaN where it cannot be had.
fn point_for_a_disc(diameters: f64) -> f64 {
    let gamma: Vec<f64> = (0..=900).map(|i| 0.1 * f64::from(i)).collect();
    let cosine = gamma.iter().map(|g| g.to_radians().cos()).collect();
    let table = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], gamma, cosine);
    let Ok(distribution) = table else { return f64::NAN };
    let luminaire = Luminaire {
        opening: Some(Body { shape: Shape::Round, length_m: 1.0, width_m: 1.0, height_m: 0.0 }),
        ..Luminaire::of(distribution)
    };
    let below = |near_ratio: f64| {
        let placement = Placement::new(DVec3::new(0.0, 0.0, diameters), Orientation::DOWN, 1.0).ok()?;
        let sides = [DVec3::X, DVec3::Y];
        let plane = Plane::new(DVec3::new(-0.5, -0.5, 0.0), sides, [1, 1], PointsAt::Centres).ok()?;
        let settings = Settings { near_ratio, tolerance: 1e-9, ..Settings::default() };
        let placed = [Placed { luminaire: &luminaire, placement }];
        illuminance(&placed, &plane, &Receiver::Planar(DVec3::Z), &settings).ok().map(|e| e.values[0])
    };
    below(0.0).zip(below(1000.0)).map_or(f64::NAN, |(point, area)| point / area - 1.0)
}

pub(super) fn checks() -> Vec<Check> {
    let check =
        |case, source, expected, found, allowed| Check { area: "lamps", case, source, expected, found, allowed };
    let whole = [0.0, 180.0];
    vec![
        check("100 cd all around [lm]", "4π I", 400.0 * PI, flux(&whole, &[100.0; 2]), 1e-14),
        check("1e-30 cd all around [lm]", "4π I", 4e-30 * PI, flux(&whole, &[1e-30; 2]), 1e-14),
        check("1e30 cd all around [lm]", "4π I", 4e30 * PI, flux(&whole, &[1e30; 2]), 1e-14),
        check("0 cd all around [lm]", "0", 0.0, flux(&whole, &[0.0; 2]), 0.0),
        check(
            "straight from 1 cd at 0° to 0 at 90° [lm]",
            "2π − 4",
            2.0 * PI - 4.0,
            flux(&[0.0, 90.0], &[1.0, 0.0]),
            1e-14,
        ),
        // 2π I (1 − sinα/α) for a straight line from 1 at 0 to 0 at α, of which α²/6 − α⁴/120 is left.
        check(
            "a beam of 0.001° [lm]",
            "2π (α²/6 − α⁴/120)",
            {
                let a = 0.001_f64.to_radians();
                2.0 * PI * (a * a / 6.0 - a.powi(4) / 120.0)
            },
            flux(&[0.0, 0.001, 90.0], &[1.0, 0.0, 0.0]),
            1e-13,
        ),
        // Straight lines through a cosine by 0.1° are within 3.9e-7 of it.
        check("a point for a disc 5 diameters away: too bright by", "R²/d²", 0.01, point_for_a_disc(5.0), 1e-4),
        check("a point for a disc 1 diameter away: too bright by", "R²/d²", 0.25, point_for_a_disc(1.0), 1e-5),
    ]
}
