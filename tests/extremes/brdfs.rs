//! Surfaces as smooth as 1e-6, light along them, indices next to that of air, lobes that nothing can tell apart.

use std::f64::consts::PI;

use photopic::brdf::coordinates::Parameterisation;
use photopic::brdf::description::template::Template;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::fit::{Options, Samples, Selection, Uncertainty, fit};
use photopic::brdf::table::{Channel, Points, Table};
use photopic::brdf::{Brdf, fresnel};
use photopic::geometry::direction::from_degrees;

use crate::close;

fn material(words: &str) -> Box<dyn Brdf> {
    words.parse::<Material>().expect("a material").prepare(Bands::Wavelengths(&[555.0])).expect("prepared")
}

fn value(words: &str, theta_i_deg: f64, theta_o_deg: f64) -> f64 {
    let mut value = [f64::NAN];
    material(words).evaluate(from_degrees(theta_i_deg, 0.0), from_degrees(theta_o_deg, 180.0), &mut value);
    value[0]
}

fn albedo(words: &str, theta_deg: f64) -> f64 {
    let mut value = [f64::NAN];
    material(words).albedo(from_degrees(theta_deg, 0.0), &mut value);
    value[0]
}

/// Fresnel's formulas with 50 digits: along the surface, at an index that hardly differs, of metals that hardly absorb or nothing enters.
#[test]
fn fresnels_formulas_keep_their_digits() {
    let along = 2_f64.powi(-27);
    // 1 − R is what is left after a subtraction of numbers next to 1: of 1e-16 of them, 4e-8 keeps eight digits.
    close(1.0 - fresnel::dielectric(along, 1.5), 4.331_601_110_814_655e-8, 1e-8, "glass along the surface");
    close(1.0 - fresnel::conductor(along, 0.2, 3.5), 3.297_370_942_532_811e-9, 1e-7, "metal along the surface");
    close(1.0 - fresnel::conductor(1.0, 0.05, 1e6), 2.0e-13, 1e-3, "a mirror next to perfect");
    for exponent in [-30, -20, -10] {
        let step = 2_f64.powi(exponent);
        // ((n − 1)/(n + 1))², exact in n − 1.
        close(fresnel::dielectric(1.0, 1.0 + step), (step / (2.0 + step)).powi(2), 1e-14, "next to air");
    }
    assert_eq!(fresnel::dielectric(0.3, 1.0), 0.0);
    for cosine in [0.0, 1e-300, 1e-9] {
        close(fresnel::dielectric(cosine, 1.5), 1.0, 1e-8, "at the horizon");
    }
}

/// D of facets of α along the normal is 1/(π α²), so that f = F/(4π α²) there: 7.96e10/sr for 1e-6.
#[test]
fn lobes_of_smooth_surfaces_are_as_high_as_they_are_narrow() {
    for alpha in [1e-6, 1e-4, 1e-2, 1.0] {
        let words = format!("ggx(alpha={alpha:e}, reflectance=1)");
        close(value(&words, 0.0, 0.0), 1.0 / (4.0 * PI * alpha * alpha), 1e-9, &words);
        // Nothing is lost among facets of a smooth surface; a rough one loses light: 1 − ln 2 is left at α = 1 along the normal.
        let expected = if alpha == 1.0 { 1.0 - std::f64::consts::LN_2 } else { 1.0 };
        let found = albedo(&words, 0.0);
        // Single scattering loses some α² of the light.
        assert!(
            (found - expected).abs() < 1e-4 + if alpha < 1.0 { 2.0 * alpha * alpha } else { 0.0 },
            "{words}: {found}"
        );
    }
    // Beside the lobe there is its tail: α²/(π (cos²θ (α² − 1) + 1)²) falls to α²/(π sin⁴θ).
    let tail = value("ggx(alpha=1e-6, reflectance=1)", 0.0, 60.0);
    let half = 30_f64.to_radians();
    // G is 1 to α² tan²θ/4.
    close(tail, 1e-12 / (PI * half.sin().powi(4)) / (4.0 * 60_f64.to_radians().cos()), 1e-9, "the tail");
}

#[test]
fn along_the_surface_values_stay_what_they_are() {
    for theta in [89.0, 89.99, 89.9999, 89.999_999] {
        close(value("lambert(reflectance=0.5)", theta, theta), 0.5 / PI, 1e-15, "Lambert");
        // The classic Phong lobe has no cosine: k_s along its mirror, and k_d/π.
        let phong = value("phong(kd=0, ks=0.5, n=10, form=normalised)", theta, theta);
        assert!(phong.is_finite() && phong >= 0.0, "{theta}: {phong}");
        for words in ["ggx(alpha=1e-6, eta=1.5)", "ggx(alpha=1, eta=1.5)", "beckmann(alpha=0.1, eta=1.5)"] {
            let energy = albedo(words, theta);
            assert!((0.0..=1.0 + 1e-3).contains(&energy), "{words} at {theta}: {energy}");
        }
    }
    let mut below = [f64::NAN];
    material("ggx(alpha=1e-6, eta=1.5)").evaluate(from_degrees(90.0 + 1e-9, 0.0), from_degrees(0.0, 0.0), &mut below);
    assert_eq!(below, [0.0]);
}

/// Values of a material at places all over the hemisphere.
fn samples(words: &str) -> Samples {
    let brdf = material(words);
    let mut directions = Vec::new();
    for ti in [5.0, 30.0, 55.0, 70.0] {
        for to in [0.0, 20.0, 40.0, 60.0, 75.0] {
            directions.extend([0.0, 60.0, 120.0, 180.0].map(|phi| (from_degrees(ti, 0.0), from_degrees(to, phi))));
        }
    }
    let mut values = vec![0.0; directions.len()];
    directions.iter().zip(&mut values).for_each(|((i, o), v)| {
        let mut one = [0.0];
        brdf.evaluate(*i, *o, &mut one);
        *v = one[0];
    });
    let names = vec![Channel::Named("Y".to_owned())];
    let table = Points::new(Parameterisation::Spherical, names, directions, values).expect("a table");
    Samples::new(&Table::Points(table), &Selection::default()).expect("places")
}

/// Two diffuse parts, of which only the sum is known: the fit says so, and the sum is right.
#[test]
fn fits_without_an_answer_say_so() {
    let template: Template = "lambert + ?*lambert(reflectance=0.5)".parse().expect("a template");
    let found = fit(&template, &samples("lambert(reflectance=0.5)"), &Options::default()).expect("a fit");
    assert_eq!(found.inseparable, [0, 1], "{:?}", found.estimates);
    assert!(found.condition < 1e-12 && found.estimates.iter().all(|e| e.uncertainty == Uncertainty::Inseparable));
    let mut sum = [f64::NAN];
    found.brdf.evaluate(from_degrees(30.0, 0.0), from_degrees(40.0, 90.0), &mut sum);
    close(sum[0], 0.5 / PI, 1e-9, "the sum");
    // A lobe between two places is not seen at all: it rests at its bound, or is as small as nothing.
    let template: Template = "lambert + ?*ggx(alpha=1e-6, reflectance=1)".parse().expect("a template");
    let found = fit(&template, &samples("lambert(reflectance=0.5)"), &Options::default()).expect("a fit");
    close(found.estimates[0].value, 0.5, 1e-6, "the diffuse part");
    assert!(found.estimates.iter().all(|e| e.value.is_finite()), "{:?}", found.estimates);
}
