//! The ABC and SGD fits of a hundred measured materials, against values by an independent program.

use std::collections::HashMap;

use photopic::brdf::Brdf;
use photopic::brdf::abc::Abc;
use photopic::brdf::audit::{Limits, audit};
use photopic::brdf::sgd::{Band, Sgd};
use photopic::geometry::direction::from_degrees;
use photopic::math::random::Stream;

use crate::common::{rows, shared};

pub(crate) type Row = HashMap<String, String>;

fn number(row: &Row, key: &str) -> f64 {
    row[key].parse().unwrap_or_else(|_| panic!("{key}: {}", row[key]))
}

fn three(row: &Row, key: &str) -> Vec<f64> {
    ["R", "G", "B"].map(|c| number(row, &format!("{key}_{c}"))).to_vec()
}

fn abc(row: &Row) -> Box<dyn Brdf> {
    let (b, c, eta) = (number(row, "B"), number(row, "C"), vec![number(row, "ior"); 3]);
    Box::new(
        Abc::new(three(row, "kD"), three(row, "A"), b, c, eta).unwrap_or_else(|e| panic!("{}: {e}", row["material"])),
    )
}

pub(crate) fn sgd(row: &Row) -> Box<dyn Brdf> {
    let band = |c: &str| {
        let v = |key: &str| number(row, &format!("{key}_{c}"));
        Band {
            rho_d: v("rhoD"),
            rho_s: v("rhoS"),
            alpha: v("alpha"),
            p: v("p"),
            kappa: v("kap"),
            f0: v("f0"),
            f1: v("f1"),
            lambda: v("lam"),
            gamma: v("c"),
            k: v("k"),
            theta0: v("th0"),
        }
    };
    let bands = ["R", "G", "B"].map(band).to_vec();
    Box::new(Sgd::new(bands).unwrap_or_else(|e| panic!("{}: {e}", row["material"])))
}

/// All fits by model and material.
fn fits() -> Option<HashMap<(String, String), Box<dyn Brdf>>> {
    let (a, s) = (shared("brdf/merl_abc_params.csv")?, shared("brdf/merl_sgd_params.csv")?);
    let mut out: HashMap<(String, String), Box<dyn Brdf>> = HashMap::new();
    for row in rows(&a) {
        out.insert(("ABC".into(), row["material"].clone()), abc(&row));
    }
    for row in rows(&s) {
        out.insert(("SGD".into(), row["material"].clone()), sgd(&row));
    }
    assert_eq!(out.len(), 200);
    Some(out)
}

#[test]
fn a_hundred_materials_have_the_values_of_an_independent_program() {
    let (Some(fits), Some(path)) = (fits(), shared("brdf/merl_fits_probe_values.csv")) else { return };
    let mut compared = 0;
    for row in rows(&path) {
        let brdf = &fits[&(row["model"].clone(), row["material"].clone())];
        let [ti, to, phi] = ["theta_i", "theta_o", "dphi"].map(|k| number(&row, k));
        let mut got = [0.0; 3];
        brdf.evaluate(from_degrees(ti, 0.0), from_degrees(to, phi), &mut got);
        for (got, key) in got.iter().zip(["fR", "fG", "fB"]) {
            let expected = number(&row, key);
            // Printed to eight significant digits.
            let printed = 0.5 * 10f64.powf(expected.abs().log10().floor() - 7.0);
            assert!((got - expected).abs() <= 1.001 * printed, "{row:?} {key}: {got}");
            compared += 1;
        }
    }
    assert_eq!(compared, 5400);
}

#[test]
fn their_albedos_are_those_of_the_independent_quadrature() {
    let (Some(fits), Some(path)) = (fits(), shared("brdf/merl_fits_albedo.csv")) else { return };
    let Some(parameters) = shared("brdf/merl_sgd_params.csv") else { return };
    let widths: HashMap<String, Row> = rows(&parameters).into_iter().map(|r| (r["material"].clone(), r)).collect();
    let (mut broad, mut narrow) = (0, 0);
    for row in rows(&path) {
        let brdf = &fits[&(row["model"].clone(), row["material"].clone())];
        let mut got = [0.0; 3];
        brdf.albedo(from_degrees(number(&row, "theta_i"), 0.0), &mut got);
        for (got, key) in got.iter().zip(["R", "G", "B"]) {
            let expected = number(&row, key);
            let printed = 0.5 * 10f64.powf(expected.log10().floor() - 5.0);
            // The other program's net of directions passes over narrow lobes and finds too little there (chrome at 75°: less
            // than a third). Where it resolves them, six printed digits agree; elsewhere ours is not the smaller one.
            let resolved = row["model"] == "SGD" && number(&widths[&row["material"]], &format!("alpha_{key}")) > 0.06;
            assert!(got - expected >= -2.0 * printed, "{row:?} {key}: {got}");
            assert!(!resolved || got - expected <= 2.0 * printed, "{row:?} {key}: {got}");
            *(if resolved { &mut broad } else { &mut narrow }) += 1;
        }
    }
    assert!(broad > 200 && broad + narrow == 1800, "{broad} {narrow}");
}

#[test]
fn narrow_lobes_have_the_albedo_that_their_samplers_find() {
    let Some(fits) = fits() else { return };
    // Those with which the other program differs most.
    for (model, name) in
        [("SGD", "ss440"), ("SGD", "tungsten-carbide"), ("ABC", "chrome"), ("ABC", "steel"), ("SGD", "black-obsidian")]
    {
        let brdf = &fits[&(model.to_owned(), name.to_owned())];
        let direction = from_degrees(75.0, 0.0);
        let (mut stream, mut weights, mut rho) = (Stream::new(5, 0), [0.0; 3], [0.0; 3]);
        let error = brdf.albedo(direction, &mut rho);
        let (n, mut sum, mut squares) = (300_000, 0.0, 0.0);
        for _ in 0..n {
            if brdf.sample(direction, stream.uniforms(), &mut weights).is_some() {
                sum += weights[1];
                squares += weights[1] * weights[1];
            }
        }
        let mean = sum / f64::from(n);
        let standard = ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
        assert!(
            (mean - rho[1]).abs() <= 4.5 * standard + error,
            "{model} {name}: {mean} ± {standard}, {} ± {error}",
            rho[1]
        );
        assert!(standard < 0.02 * mean, "{model} {name}: {mean} ± {standard} says little");
    }
}

#[test]
fn the_audit_says_that_the_white_paint_gives_more_light_than_it_gets() {
    let Some(fits) = fits() else { return };
    let brdf = &fits[&("SGD".to_owned(), "white-paint".to_owned())];
    let found = audit(brdf.as_ref(), &Limits::default());
    assert!(!found.passes);
    let at_75 = found.albedo.iter().find(|a| a.theta_i_deg == 75.0).expect("an angle of the audit");
    let largest = at_75.reflectance.iter().copied().fold(0.0, f64::max);
    // 1.42 at 75°, two decimals printed.
    assert!((largest - 1.42).abs() <= 0.005, "{largest}");
}
