//! Luminaires.

use std::f64::consts::PI;

use super::Check;
use crate::luminaire::{Distribution, Symmetry, System};

/// The flux of a lamp of one plane; NaN where the table is none.
fn flux(vertical_deg: &[f64], values: &[f64]) -> f64 {
    let table =
        Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vertical_deg.to_vec(), values.to_vec());
    table.map_or(f64::NAN, |d| d.total_flux())
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
    ]
}
