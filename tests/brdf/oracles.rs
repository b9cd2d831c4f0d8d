//! Values of other programs: `scripts/brdf_tables.py` made the tables and says how.

use std::path::Path;

use glam::DVec3;
use photopic::brdf::fresnel;
use photopic::geometry::direction::{from_degrees, mirror};

use crate::{material, value};

/// A table of tests/data/brdf without its comments, rows of cells.
fn table(name: &str) -> Vec<Vec<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/brdf").join(name);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).expect("a committed table");
    let rows = reader.records().map(|r| r.expect("a row").iter().map(str::to_owned).collect());
    rows.collect()
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("{cell}: a number"))
}

#[test]
fn fresnel_against_fifty_digits() {
    let rows = table("fresnel.csv");
    assert!(rows.len() > 250, "{}", rows.len());
    for row in rows {
        let [cos, n, k, expected] = [0, 1, 2, 3].map(|i| number(&row[i]));
        // The rounding of some thirty operations; next to Brewster's angle of n = 1 + 1e-6 the p part is nothing but rounding.
        let close = |got: f64| (got - expected).abs() <= 2e-14 * expected;
        let got = fresnel::conductor(cos, n, k);
        assert!(close(got), "{row:?}: {got:e}, {:e} off", got / expected - 1.0);
        if k == 0.0 {
            let got = fresnel::dielectric(cos, n);
            assert!(close(got), "{row:?}: {got:e}, {:e} off", got / expected - 1.0);
        }
    }
}

#[test]
fn microfacets_against_fifty_digits() {
    for row in table("microfacet.csv") {
        let brdf = material(&format!("{}(alpha={}, reflectance=1)", row[0], row[1]));
        let v: Vec<f64> = row[2..].iter().map(|c| number(c)).collect();
        let (incident, outgoing) = (DVec3::new(v[0], v[1], v[2]), DVec3::new(v[3], v[4], v[5]));
        let got = value(brdf.as_ref(), incident, outgoing);
        // ω_i + ω_o is rounded to 1e-16 of its parts: its slope, in units of α, is off by δ/α, and a distribution that falls as
        // e^(−t²) or t^(−4) answers with a relative 4 t δ/α, t the slope in units of α. (t ≤ 26 where e^(−t²) is not 0.)
        let (alpha, h) = (number(&row[1]), incident + outgoing);
        let t = (h.x.hypot(h.y) / h.z / alpha).max(1.0);
        let steep = if row[0] == "ggx" { 1.0 } else { t };
        let bound = 1e-14 + 4.0 * steep * 2.3e-16 / (alpha * h.z);
        let expected = v[6];
        assert!(
            (got - expected).abs() <= bound * expected + 1e-300,
            "{row:?}: {got:e}, {:e} off, bound {bound:e}",
            got / expected - 1.0
        );
    }
}

#[test]
fn models_against_mitsuba() {
    let rows = table("mitsuba.csv");
    assert!(rows.len() > 120, "{}", rows.len());
    for row in rows {
        let brdf = material(&row[0]);
        let [ti, to, phi, expected] = [1, 2, 3, 4].map(|i| number(&row[i]));
        let (incident, outgoing) = (from_degrees(ti, 0.0), from_degrees(to, phi));
        let got = if brdf.is_delta() {
            assert!((mirror(incident) - outgoing).length() < 1e-9);
            let mut out = [0.0];
            brdf.specular(incident, &mut out);
            out[0]
        } else {
            value(brdf.as_ref(), incident, outgoing)
        };
        // Single precision: 6e-8 in the directions, whose half vector's slope decides; α = 0.05 and slopes of up to 10 α
        // amplify it to 1e-4. Walter's rational function stands for Λ in its Beckmann masking: 0.35 % for each direction.
        let bound = if row[0].starts_with("beckmann") { 7.1e-3 } else { 1e-4 };
        assert!(
            (got / expected - 1.0).abs() <= bound || got == expected || (got < 1e-12 && expected < 1e-12),
            "{row:?}: {got}"
        );
    }
}
