//! The monotone cubic between the entries of a table: exact at them, never beyond them, respecting turn and symmetry, converging
//! to a smooth intensity whose flux has a closed form.

mod common;

use std::f64::consts::PI;
use std::fs;

use photopic::luminaire::{Distribution, Interpolation, Symmetry, System, beam, format, zonal};
use proptest::prelude::*;

fn steps(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
}

fn table(
    (system, symmetry): (System, Symmetry),
    horizontal: &[f64],
    vertical: &[f64],
    f: impl Fn(f64, f64) -> f64,
) -> Distribution {
    let values = horizontal.iter().flat_map(|h| vertical.iter().map(|v| f(*h, *v)).collect::<Vec<_>>()).collect();
    Distribution::new(system, symmetry, horizontal.to_vec(), vertical.to_vec(), values)
        .expect("a sound table")
        .with_interpolation(Interpolation::MonotoneCubic)
}

const RANGES: [(System, Symmetry, f64, f64); 8] = [
    (System::TypeC, Symmetry::Quadrant, 0.0, 90.0),
    (System::TypeC, Symmetry::BilateralC0, 0.0, 180.0),
    (System::TypeC, Symmetry::BilateralC90, 90.0, 270.0),
    (System::TypeC, Symmetry::None, 0.0, 360.0),
    (System::TypeB, Symmetry::Quadrant, 0.0, 90.0),
    (System::TypeB, Symmetry::None, -90.0, 90.0),
    (System::TypeA, Symmetry::Quadrant, 0.0, 90.0),
    (System::TypeA, Symmetry::None, -90.0, 90.0),
];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn it_is_exact_at_the_entries_and_never_beyond_them(
        range in 0..RANGES.len(), rows in 2_usize..7, planes in 2_usize..7,
        values in proptest::collection::vec(prop_oneof![Just(0.0), 0.0..1.0_f64, 0.0..1e6_f64], 36),
        at in proptest::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 20),
    ) {
        let (system, symmetry, from, to) = RANGES[range];
        let (v0, v1) = if system == System::TypeC { (0.0, 180.0) } else { (-90.0, 90.0) };
        let (h, v) = (steps(from, to, planes - 1), steps(v0, v1, rows - 1));
        let mut values = values[..rows * planes].to_vec();
        if symmetry == Symmetry::None && system == System::TypeC {
            let (first, rest) = values.split_at_mut(rows);
            rest[(planes - 2) * rows..].copy_from_slice(first);
        }
        let d = Distribution::new(system, symmetry, h.clone(), v.clone(), values).expect("a sound table")
            .with_interpolation(Interpolation::MonotoneCubic);
        for (i, c) in h.iter().enumerate() {
            for (j, g) in v.iter().enumerate() {
                prop_assert_eq!(d.at(*c, *g), d.plane(i)[j]);
            }
        }
        for (x, y) in at {
            let (i, j) = ((x * (planes - 1) as f64) as usize, (y * (rows - 1) as f64) as usize);
            let (c, g) = (from + x * (to - from), v0 + y * (v1 - v0));
            let corners = [d.plane(i)[j], d.plane(i)[j + 1], d.plane(i + 1)[j], d.plane(i + 1)[j + 1]];
            let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
            let high = corners.iter().copied().fold(0.0, f64::max);
            let value = d.at(c, g);
            // Rounding of a sum of four products of numbers up to the largest.
            prop_assert!(value >= low - 1e-14 * high && value <= high * (1.0 + 1e-14), "{} in {:?}", value, corners);
            prop_assert!(value >= 0.0);
        }
        // The bilinear flux of the same entries bounds nothing, but the largest entry does.
        prop_assert!(d.total_flux() <= 4.0 * PI * d.peak().0 * (1.0 + 1e-12));
    }
}

#[test]
fn symmetric_and_unfolded_tables_agree() {
    let f = |h: f64, v: f64| 10.0 + v * h.to_radians().cos().powi(2) + (0.3 * v).sin();
    let vertical = steps(0.0, 90.0, 18);
    let whole = table((System::TypeC, Symmetry::None), &steps(0.0, 360.0, 24), &vertical, f);
    for (symmetry, from, to) in
        [(Symmetry::Quadrant, 0.0, 90.0), (Symmetry::BilateralC0, 0.0, 180.0), (Symmetry::BilateralC90, 90.0, 270.0)]
    {
        let planes = steps(from, to, ((to - from) / 15.0) as usize);
        let folded = table((System::TypeC, symmetry), &planes, &vertical, f);
        assert!((folded.total_flux() / whole.total_flux() - 1.0).abs() < 1e-13, "{symmetry:?}");
        for c in [0.0, 3.0, 37.0, 88.0, 95.0, 181.0, 269.9, 300.0, 359.0] {
            for g in [0.0, 2.5, 42.0, 89.0] {
                assert!((folded.at(c, g) - whole.at(c, g)).abs() < 1e-12, "{symmetry:?} C{c} γ{g}");
            }
        }
    }
    for system in [System::TypeA, System::TypeB] {
        let vertical = steps(-90.0, 90.0, 18);
        let whole = table((system, Symmetry::None), &steps(-90.0, 90.0, 18), &vertical, |h, v| 90.0 - h.abs() + v);
        let half = table((system, Symmetry::Quadrant), &steps(0.0, 90.0, 9), &vertical, |h, v| 90.0 - h.abs() + v);
        assert!((half.total_flux() / whole.total_flux() - 1.0).abs() < 1e-13);
        for h in [-89.0, -3.0, 0.0, 4.0, 55.0] {
            assert!((half.at(h, 7.0) - whole.at(h, 7.0)).abs() < 1e-12, "{system:?} {h}");
        }
    }
}

/// I = 1 + ½ cos C sin γ has the flux 4π: an even source and a dipole, which adds nothing.
fn dipole(c: f64, g: f64) -> f64 {
    1.0 + 0.5 * c.to_radians().cos() * g.to_radians().sin()
}

#[test]
fn it_converges_to_a_smooth_intensity() {
    // Largest distance over the sphere. The intensity has extrema along both angles, where a monotone cubic is of second order.
    let error = |n: usize, interpolation: Interpolation| {
        let d = table((System::TypeC, Symmetry::None), &steps(0.0, 360.0, 2 * n), &steps(0.0, 180.0, n), dipole)
            .with_interpolation(interpolation);
        let mut worst = 0.0_f64;
        for c in (0..3600).step_by(7).map(|c| 0.1 * f64::from(c)) {
            for g in (0..1800).step_by(7).map(|g| 0.1 * f64::from(g)) {
                worst = worst.max((d.at(c, g) - dipole(c, g)).abs());
            }
        }
        (worst, (d.total_flux() / (4.0 * PI) - 1.0).abs())
    };
    // An odd number of intervals keeps the extremum at γ 90° off the rows.
    let (coarse, fine) = (error(9, Interpolation::MonotoneCubic), error(27, Interpolation::MonotoneCubic));
    let order = (coarse.0 / fine.0).log(3.0);
    assert!((1.9..2.3).contains(&order), "order {order}");
    assert!(coarse.1 < 1e-12 && fine.1 < 1e-12, "the dipole's flux cancels: {coarse:?} {fine:?}");
    assert!(fine.0 < error(27, Interpolation::Bilinear).0);
}

#[test]
fn its_flux_is_nearer_to_that_of_a_cosine_than_that_of_chords() {
    // I = cos γ on 0–90°: π lm. Interpolated linearly the flux is short by about π h²/12.
    let short = |step: usize, interpolation: Interpolation| {
        let gamma: Vec<f64> = (0..=90).step_by(step).map(f64::from).collect();
        let d = table((System::TypeC, Symmetry::Rotational), &[0.0], &gamma, |_, g| g.to_radians().cos());
        1.0 - d.with_interpolation(interpolation).total_flux() / PI
    };
    let h2 = |step: usize| (step as f64).to_radians().powi(2) / 12.0;
    assert!((short(5, Interpolation::Bilinear) / h2(5) - 1.0).abs() < 0.01);
    assert!(
        short(5, Interpolation::MonotoneCubic).abs() < 0.02 * h2(5),
        "{:e}",
        short(5, Interpolation::MonotoneCubic)
    );
}

#[test]
fn figures_follow_the_interpolation() {
    let gamma = steps(0.0, 90.0, 6);
    let d = table((System::TypeC, Symmetry::Rotational), &[0.0], &gamma, |_, g| g.to_radians().cos());
    // The cosine is 0.8 at 36.87°, well within an interval.
    let width = |d: &Distribution| beam::angles(d, 0.8, beam::Definition::Outermost).c0_c180.expect("lit");
    let off = |d: &Distribution| (width(d) - 2.0 * 0.8_f64.acos().to_degrees()).abs();
    let chords = d.clone().with_interpolation(Interpolation::Bilinear);
    assert!(off(&d) < 0.2 * off(&chords), "{} {}", width(&d), width(&chords));
    // Zones add up to the whole, and the mean at a γ is the value where all planes are one.
    let zones: f64 = zonal::zones(&d, 10.0).expect("Type C").iter().map(|z| z.flux).sum();
    assert!((zones / d.total_flux() - 1.0).abs() < 1e-12);
    assert!((d.zonal_mean(33.0) - d.at(0.0, 33.0)).abs() < 1e-15);
    assert_eq!(d.zonal_means().len(), d.vertical_deg().len());
}

#[test]
fn the_flux_of_real_files_does_not_depend_on_how_finely_it_is_summed() {
    let Some(folder) = common::shared("luminaires") else { return };
    let (mut worst, mut count) = (0.0_f64, 0);
    for row in common::rows(&folder.join("reference.csv")) {
        if row["kind"] != "real" || row["ref_status"] != "ok" {
            continue;
        }
        let bytes = fs::read(folder.join("files").join(&row["file"])).expect("a listed file");
        let lamp = format::read(&bytes, &Default::default()).expect("a real file is read").value;
        let d = lamp.distribution.with_interpolation(Interpolation::MonotoneCubic);
        assert_eq!(d.peak(), d.clone().with_interpolation(Interpolation::Bilinear).peak(), "{}", row["file"]);
        if d.system() != System::TypeC {
            continue;
        }
        let v = d.vertical_deg();
        let thirds = v.windows(2).flat_map(|w| [0, 1, 2].map(|i| w[0] + (w[1] - w[0]) * f64::from(i) / 3.0));
        let cuts: Vec<f64> = thirds.chain([v[v.len() - 1]]).collect();
        let fine: f64 = cuts.windows(2).map(|w| d.flux_between(w[0], w[1])).sum();
        worst = worst.max((d.total_flux() / fine - 1.0).abs());
        count += 1;
    }
    eprintln!("{count} files, worst {worst:.1e}");
    assert!(count > 50 && worst < 2e-6, "{worst:e}");
}
