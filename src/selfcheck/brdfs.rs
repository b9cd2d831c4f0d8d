//! Materials.

use std::f64::consts::{FRAC_1_PI, LN_2};

use super::Check;
use crate::brdf::description::{Bands, Material};
use crate::brdf::{Brdf, fresnel};
use crate::geometry::direction::from_degrees;

fn material(words: &str) -> Option<Box<dyn Brdf>> {
    words.parse::<Material>().ok()?.prepare(Bands::Wavelengths(&[555.0])).ok()
}

/// The albedo under an angle of incidence; NaN where there is no such material.
fn albedo(words: &str, theta_deg: f64) -> f64 {
    let mut value = [f64::NAN];
    if let Some(brdf) = material(words) {
        brdf.albedo(from_degrees(theta_deg, 0.0), &mut value);
    }
    value[0]
}

fn value(words: &str, theta_i_deg: f64, theta_o_deg: f64) -> f64 {
    let mut value = [f64::NAN];
    if let Some(brdf) = material(words) {
        brdf.evaluate(from_degrees(theta_i_deg, 0.0), from_degrees(theta_o_deg, 180.0), &mut value);
    }
    value[0]
}

pub(super) fn checks() -> Vec<Check> {
    let check =
        |case, source, expected, found, allowed| Check { area: "materials", case, source, expected, found, allowed };
    let grazing = 89.9999_f64.to_radians().cos();
    let fresnel_form = "Fresnel's formulas, 40 digits";
    let barely = 1.0 + 2_f64.powi(-30);
    vec![
        check(
            "glass n = 1.5 at 89.9999°: 1 − R",
            fresnel_form,
            1.014_689_551_598_913_7e-5,
            1.0 - fresnel::dielectric(grazing, 1.5),
            1e-9,
        ),
        check(
            "n = 1 + 2⁻³⁰, normal: R",
            fresnel_form,
            2.168_404_342_951_525e-19,
            fresnel::dielectric(1.0, barely),
            1e-14,
        ),
        check("n = 1000, normal: R", fresnel_form, 0.996_007_988_015_98, fresnel::dielectric(1.0, 1000.0), 1e-15),
        check(
            "metal with k = 0 as glass: R at 60°",
            "the two formulas",
            fresnel::dielectric(0.5, 1.5),
            fresnel::conductor(0.5, 1.5, 0.0),
            1e-14,
        ),
        check(
            "metal with k = 1e3, normal: R",
            "((n−1)²+k²)/((n+1)²+k²)",
            (1e6 + 0.25) / (1e6 + 6.25),
            fresnel::conductor(1.0, 1.5, 1e3),
            1e-15,
        ),
        check(
            "Lambert ρ = 0.5 at 89.9999°: f",
            "ρ/π",
            0.5 * FRAC_1_PI,
            value("lambert(reflectance=0.5)", 89.9999, 89.9999),
            1e-15,
        ),
        check("Lambert ρ = 0.999: albedo", "ρ", 0.999, albedo("lambert(reflectance=0.999)", 60.0), 1e-12),
        check(
            "GGX α = 1, F = 1, normal: albedo",
            "1 − ln 2",
            1.0 - LN_2,
            albedo("ggx(alpha=1, reflectance=1)", 0.0),
            1e-4,
        ),
        check(
            "GGX α = 1e-6, F = 1, 60°: albedo",
            "the mirror's, 1",
            1.0,
            albedo("ggx(alpha=1e-6, reflectance=1)", 60.0),
            1e-4,
        ),
    ]
}
