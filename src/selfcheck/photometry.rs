//! Solid angles, vision, photons.

use std::f64::consts::PI;

use super::Check;
use crate::geometry::solid_angle::{cone, disk, polygon, rectangle_corners};
use crate::photometry::mesopic::adaptation;
use crate::photometry::photon;
use crate::photometry::transfer::illuminance_of_point;
use crate::spectrum::integrate::Contract;
use crate::spectrum::{Grid, Sampling};
use crate::units::{Candela, Metre, Radian};

/// Photons of an energy at 555 nm; NaN where they cannot be counted.
fn photons(joules: f64) -> f64 {
    let plan =
        Grid::new(vec![555.0]).ok().and_then(|g| photon::Plan::new(&g, Sampling::Lines, &Contract::default()).ok());
    plan.map_or(f64::NAN, |p| p.evaluate(&[joules]).total_count)
}

/// The mesopic luminance of a field of S/P = 2.
fn mesopic(luminance: f64) -> f64 {
    adaptation(luminance, 2.0).map_or(f64::NAN, |a| a.luminance_mesopic)
}

pub(super) fn checks() -> Vec<Check> {
    let check =
        |case, source, expected, found, allowed| Check { area: "photometry", case, source, expected, found, allowed };
    let digits = "the formula, 50 digits";
    let distance = 1e140;
    let square = illuminance_of_point(Candela(2.0), Metre(distance), Radian(0.0)).0 * distance * distance;
    let (tiny, slit) = (2_f64.powi(-30), 2_f64.powi(-40));
    vec![
        check("a cone of 1e-9 rad [sr]", digits, 3.141_592_653_589_793_6e-18, cone(1e-9), 1e-15),
        check("a cone of 180° [sr]", "4π", 4.0 * PI, cone(PI), 1e-15),
        check("a disk of radius 1e9 at 1 [sr]", digits, 6.283_185_300_896_401, disk(1e9, 1.0), 1e-15),
        check(
            "a square of side 2⁻³⁰ at 1 [sr]",
            digits,
            8.673_617_379_884_035e-19,
            polygon(&rectangle_corners(tiny, tiny, 1.0)),
            1e-14,
        ),
        check(
            "a slit of 1 × 2⁻⁴⁰ at 1 [sr]",
            digits,
            8.134_767_913_360_664e-13,
            polygon(&rectangle_corners(1.0, slit, 1.0)),
            1e-14,
        ),
        check("2 cd at 1e140 m: E d² [cd]", "the inverse square", 2.0, square, 1e-15),
        check("starlight, 1e-4 cd/m², S/P 2: mesopic [cd/m²]", "CIE 191: scotopic", 2e-4, mesopic(1e-4), 1e-14),
        check("0.3 cd/m², S/P 2: mesopic [cd/m²]", "CIE 191, 50 digits", 0.359_530_384_225_770_7, mesopic(0.3), 1e-14),
        check("the sun's disc, 2e9 cd/m²: mesopic [cd/m²]", "CIE 191: photopic", 2e9, mesopic(2e9), 1e-14),
        check("1e-300 J at 555 nm [photons]", "λ/(hc), 50 digits", 2.793_934_694_986_204e-282, photons(1e-300), 1e-14),
        check("1 J at 555 nm [photons]", "λ/(hc), 50 digits", 2.793_934_694_986_204e18, photons(1.0), 1e-14),
    ]
}
