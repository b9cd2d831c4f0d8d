//! `lamp compare`: closed forms of the shapes, turned lamps, types mixed by direction, and the command's exit codes.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::luminaire::shape::{best_turn_deg, compare};
use photopic::luminaire::{Distribution, Symmetry, System};
use proptest::prelude::*;
use serde_json::Value;

fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..=((to - from) / step).round() as u32).map(|i| from + step * f64::from(i)).collect()
}

fn table(
    system: System,
    symmetry: Symmetry,
    horizontal: Vec<f64>,
    vertical: Vec<f64>,
    f: impl Fn(f64, f64) -> f64,
) -> Distribution {
    let values = horizontal.iter().flat_map(|h| vertical.iter().map(|v| f(*h, *v)).collect::<Vec<_>>()).collect();
    Distribution::new(system, symmetry, horizontal, vertical, values).expect("a sound table")
}

/// cosⁿ γ in the lower hemisphere.
fn cosine(n: i32, step: f64) -> Distribution {
    let f = move |_, v: f64| v.to_radians().cos().max(0.0).powi(n);
    table(System::TypeC, Symmetry::Rotational, vec![0.0], steps(0.0, 90.0, step), f)
}

/// A lobe towards C = `towards`, without any symmetry.
fn lobe(towards: f64, step: f64) -> Distribution {
    let f = move |c: f64, v: f64| {
        let phase = (c - towards).to_radians();
        v.to_radians().cos()
            * (1.0 + 0.6 * v.to_radians().sin() * phase.cos() + 0.3 * v.to_radians().sin() * (2.0 * phase + 0.5).sin())
    };
    table(System::TypeC, Symmetry::None, steps(0.0, 360.0, step), steps(0.0, 90.0, 5.0), f)
}

#[test]
fn powers_of_the_cosine_have_their_closed_forms() {
    // ∫ cosⁿ cosᵐ dω = 2π/(n + m + 1) over the hemisphere, so the correlation is √((2n+1)(2m+1))/(n+m+1).
    // A table by ¼° is off by h²/8 · n ≤ 2.4e-6 n of the peak between its samples.
    for (n, m) in [(1, 2), (1, 5), (2, 10), (3, 4)] {
        let got = compare(&cosine(n, 0.25), &cosine(m, 0.25), 0.0);
        let (n, m) = (f64::from(n), f64::from(m));
        let want = ((2.0 * n + 1.0) * (2.0 * m + 1.0)).sqrt() / (n + m + 1.0);
        assert!((got.correlation - want).abs() < 2.4e-6 * (n + m), "{n} {m}: {} {want}", got.correlation);
        // Shapes (n+1)cosⁿ/2π cross where cos^(m−n) = (n+1)/(m+1) = x^(m−n); ∫|a − b| = 2 (x^(n+1) − x^(m+1)).
        let x = ((n + 1.0) / (m + 1.0)).powf(1.0 / (m - n));
        let want = 2.0 * (x.powf(n + 1.0) - x.powf(m + 1.0));
        let off = 2.4e-6 * 4.0 * (n + m) + got.quadrature_error;
        assert!((got.mean_absolute_difference - want).abs() < off, "{n} {m}: {got:?} {want}");
        assert!(got.exact && got.quadrature_error < 1e-4, "{got:?}");
        // Largest at nadir: ((m+1) − (n+1))/(n+1) of the first's peak.
        assert!((got.max_local_difference / ((m - n) / (n + 1.0)) - 1.0).abs() < 1e-4, "{got:?}");
        assert_eq!(got.max_direction_deg.1, 0.0);
    }
}

#[test]
fn a_table_and_its_unfolded_self_are_the_same_shape_and_disjoint_ones_have_nothing_in_common() {
    let f = |c: f64, v: f64| 2.0 + v / 90.0 * c.to_radians().cos().powi(2);
    let quadrant = table(System::TypeC, Symmetry::Quadrant, steps(0.0, 90.0, 15.0), steps(0.0, 90.0, 30.0), f);
    let whole = table(System::TypeC, Symmetry::None, steps(0.0, 360.0, 15.0), steps(0.0, 90.0, 30.0), f);
    let got = compare(&quadrant, &whole.scaled(3.0), 0.0);
    assert!(got.correlation > 1.0 - 1e-14 && got.mean_absolute_difference < 1e-12, "{got:?}");
    // Down and up, each to 80° only.
    let down = table(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 80.0], |_, _| 1.0);
    let up = table(System::TypeC, Symmetry::Rotational, vec![0.0], vec![100.0, 180.0], |_, _| 1.0);
    let got = compare(&down, &up, 0.0);
    assert!(got.correlation == 0.0 && (got.mean_absolute_difference - 2.0).abs() < 1e-12, "{got:?}");
}

#[test]
fn even_types_a_b_and_c_are_the_same_shape_by_direction() {
    // One lamp of cos(angle to the axis) before it, in all three systems, by 1°.
    let make = |system: System| {
        let horizontal = if system == System::TypeC { steps(0.0, 360.0, 5.0) } else { steps(-90.0, 90.0, 1.0) };
        let vertical = if system == System::TypeC { steps(0.0, 90.0, 1.0) } else { steps(-90.0, 90.0, 1.0) };
        let f = move |h: f64, v: f64| match system {
            System::TypeC => v.to_radians().cos(),
            _ => h.to_radians().cos() * v.to_radians().cos(),
        };
        table(system, Symmetry::None, horizontal, vertical, f)
    };
    let all = [System::TypeA, System::TypeB, System::TypeC].map(make);
    for a in &all {
        for b in &all {
            let got = compare(a, b, 0.0);
            // Off by h²/8 = 3.8e-5 of the peak in each table, and as much between the directions looked up.
            assert!(got.correlation > 1.0 - 1e-6, "{:?} {:?}: {got:?}", a.system(), b.system());
            assert!(got.mean_absolute_difference < 3e-4, "{:?} {:?}: {got:?}", a.system(), b.system());
            assert_eq!(got.exact, a.system() == b.system());
        }
    }
}

#[test]
fn a_turned_lamp_is_found() {
    // The convention error of 90° between LM-63 and EULUMDAT, and any other turn.
    for turn in [90.0, -90.0, 180.0, 35.0, -120.0] {
        let (a, b) = (lobe(turn, 5.0), lobe(0.0, 5.0));
        assert_eq!(best_turn_deg(&a, &b), turn);
        let got = compare(&a, &b, turn);
        assert!(got.correlation > 1.0 - 1e-12 && got.mean_absolute_difference < 1e-9, "{turn}: {got:?}");
        assert!(compare(&a, &b, 0.0).correlation < 0.99);
    }
    // Not a multiple of the step: straight lines between planes of 1° blur the lobe by no more than 1e-3 of a degree.
    assert!((best_turn_deg(&lobe(33.4, 1.0), &lobe(0.0, 1.0)) - 33.4).abs() < 0.02);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn shapes_are_compared_alike_both_ways(values in proptest::collection::vec(0.01..1.0_f64, 24), factor in 0.1..10.0_f64) {
        let of = |v: &[f64]| {
            let (planes, gamma) = (vec![0.0, 30.0, 90.0], vec![0.0, 20.0, 50.0, 90.0]);
            Distribution::new(System::TypeC, Symmetry::Quadrant, planes, gamma, v.to_vec()).expect("a table")
        };
        let (a, b) = (of(&values[..12]), of(&values[12..]).scaled(factor));
        let (there, back) = (compare(&a, &b, 0.0), compare(&b, &a, 0.0));
        prop_assert!((there.correlation - back.correlation).abs() < 1e-12);
        let off = there.quadrature_error + back.quadrature_error + 1e-12;
        prop_assert!((there.mean_absolute_difference - back.mean_absolute_difference).abs() <= off);
        prop_assert!((0.0..=1.0).contains(&there.correlation) && (0.0..=2.0).contains(&there.mean_absolute_difference));
        let own = compare(&a, &a, 0.0);
        prop_assert!(own.correlation > 1.0 - 1e-14 && own.mean_absolute_difference == 0.0 && own.max_local_difference == 0.0);
    }
}

/// An LM-63 lamp of four planes; `order` moves the planes on by quarters of a turn.
fn ies(order: usize, factor: f64) -> String {
    let mut planes = ["100 90 60 0", "100 120 150 30", "100 80 50 10", "100 70 30 0"].map(str::to_owned).to_vec();
    planes.rotate_right(order);
    planes.push(planes[0].clone());
    format!(
        "IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] none\n[ISSUEDATE] 2026\n[MANUFAC] ours\nTILT=NONE\n1 -1 {factor} 4 5 1 2 0.3 0.2 0\n1 1 10\n\
         0 30 60 90\n0 90 180 270 360\n{}\n",
        planes.join("\n")
    )
}

fn run(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_photopic")).current_dir(folder).args(["lamp", "compare"]).args(arguments).assert()
}

fn result(assert: &assert_cmd::assert::Assert) -> Value {
    let mut document: Value = serde_json::from_slice(&assert.get_output().stdout).expect("one JSON document");
    document["results"][0].take()
}

#[test]
fn the_command_says_what_differs_and_no_beyond_the_tolerance() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).expect("written");
    write("a.ies", ies(0, 1.0));
    write("half.ies", ies(0, 0.5));
    write("turned.ies", ies(1, 1.0));
    let number = |v: &Value| v.as_f64().expect("a number");
    let own = result(&run(folder.path(), &["a.ies", "a.ies", "--json", "--tolerance", "0%"]).code(0));
    assert_eq!((number(&own["shape"]["correlation"]), number(&own["shape"]["mean_absolute_difference"])), (1.0, 0.0));
    assert_eq!((&own["passes"], number(&own["total_flux_lm"]["difference"])), (&Value::Bool(true), 0.0));
    let half = result(&run(folder.path(), &["a.ies", "half.ies", "--json"]).code(0));
    assert!((number(&half["total_flux_lm"]["difference_relative"]) + 0.5).abs() < 1e-12);
    assert!((number(&half["peak_intensity_cd"]["difference_relative"]) + 0.5).abs() < 1e-12);
    assert!((number(&half["shape"]["correlation"]) - 1.0).abs() < 1e-12);
    assert!(half.get("passes").is_none() && half.get("best_turn").is_none());
    run(folder.path(), &["a.ies", "half.ies", "--tolerance", "49%"]).code(1);
    run(folder.path(), &["a.ies", "half.ies", "--tolerance", "0.51"]).code(0);
    // B's planes come a quarter of a turn later: turned back by 90° it is A.
    let turned = result(&run(folder.path(), &["a.ies", "turned.ies", "--json", "--tolerance", "1%"]).code(1));
    assert_eq!(turned["best_turn"]["turn_b_deg"], -90.0);
    assert!(number(&turned["best_turn"]["correlation"]) > 1.0 - 1e-12);
    assert_eq!(turned["passes"], false);
    assert!(
        (number(&turned["peak_separation_deg"])
            - 2.0 * (0.5_f64.sqrt() * 60_f64.to_radians().sin()).asin().to_degrees())
        .abs()
            < 1e-9
    );
    let text = String::from_utf8(run(folder.path(), &["a.ies", "turned.ies"]).code(0).get_output().stdout.clone());
    let text = text.expect("UTF-8");
    assert!(text.contains("turned by -90.000°") && text.contains("∫ a b dω"), "{text}");
    for bad in [&["a.ies", "no-such.ies"][..], &["a.ies", "a.ies", "--tolerance", "x"], &["-", "-"], &["a.ies"]] {
        run(folder.path(), bad).code(2);
    }
    let lit = ies(0, 1.0);
    let (head, _) = lit.rsplit_once("360\n").expect("the planes");
    write("dark.ies", format!("{head}360\n{}", "0 0 0 0\n".repeat(5)));
    run(folder.path(), &["a.ies", "dark.ies"]).code(2);
}

#[test]
fn an_even_lamp_has_the_flux_of_the_sphere() {
    // The definition's ½(a + b): a lamp even over the sphere and one over the lower half share 1/(4π) of each below.
    let sphere = table(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 180.0], |_, _| 1.0);
    let half = table(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 90.0], |_, _| 1.0);
    let got = compare(&sphere, &half, 0.0);
    // |1/4π − 1/2π| · 2π + 1/4π · 2π = ½ + ½; correlation (1/4π · 1/2π · 2π)/√(1/4π · 1/2π) = 1/√2.
    assert!((got.mean_absolute_difference - 1.0).abs() < 1e-12, "{got:?}");
    assert!((got.correlation - 0.5_f64.sqrt()).abs() < 1e-12);
    assert!((sphere.total_flux() / (4.0 * PI) - 1.0).abs() < 1e-12);
}
