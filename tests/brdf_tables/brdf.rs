//! Tables as BRDFs: finite everywhere, the guesses in the place of what is missing, albedo.

use std::f64::consts::{FRAC_1_PI, PI};

use photopic::brdf::Brdf;
use photopic::brdf::coordinates::Parameterisation;
use photopic::brdf::format::open;
use photopic::brdf::table::{Angular, Channel, HalfAngle, Patches, Points, Resolution, Ring, Table};
use photopic::geometry::direction::{from_angles, from_degrees};
use photopic::math::random::Stream;

use super::{rgl, shared};

const ONE: fn() -> Vec<Channel> = || vec![Channel::Wavelength(550.0)];

fn rings() -> Vec<Ring> {
    let ring = |lower_deg, upper_deg, sectors| Ring { lower_deg, upper_deg, sectors };
    vec![ring(0.0, 30.0, 1), ring(30.0, 60.0, 8), ring(60.0, 90.0, 12)]
}

/// One value everywhere, in each kind of table that is made of numbers alone.
fn flat(value: f64) -> Vec<Table> {
    let resolution = Resolution { theta_h: 8, theta_d: 8, phi_d: 6 };
    let thetas: Vec<f64> = (0..6).map(|i| f64::from(i) * 0.3).collect();
    let pairs: Vec<_> = (0..40)
        .map(|i| (from_degrees(f64::from(i % 8) * 11.0, 0.0), from_degrees(f64::from(i / 8) * 20.0, f64::from(i * 37))))
        .collect();
    vec![
        HalfAngle::new(resolution, ONE(), vec![value as f32; resolution.bins()]).expect("bins").into(),
        Angular::new(thetas, 12, ONE(), vec![value; 72 * 72]).expect("a grid").into(),
        Patches::new(rings(), ONE(), vec![value; 21 * 21]).expect("patches").into(),
        Points::new(Parameterisation::ViewLightAzimuth, ONE(), pairs, vec![value; 40]).expect("points").into(),
    ]
}

#[test]
fn a_table_of_one_value_is_a_diffuser() {
    for table in flat(0.6 * FRAC_1_PI) {
        for theta in [0.0, 45.0, 85.0] {
            let mut rho = [0.0];
            let error = table.albedo(from_degrees(theta, 20.0), &mut rho);
            // ρ = π f; single precision in the bins.
            assert!((rho[0] - 0.6).abs() <= error + 1e-7, "{theta}: {} ± {error}", rho[0]);
            assert!(error < 1e-4);
            assert!(error == 0.0 || !matches!(table, Table::Patches(_)), "a sum over patches is exact");
        }
    }
}

/// Tables with holes, and the real ones.
fn with_holes() -> Vec<Table> {
    let resolution = Resolution { theta_h: 12, theta_d: 10, phi_d: 6 };
    let bin = |b: usize| if b % 7 < 5 || b > 500 { f32::NAN } else { 0.1 };
    let patch = |i: usize| if i.is_multiple_of(3) { f64::NAN } else { 0.2 };
    let nothing = vec![f32::NAN; resolution.bins()];
    let mut out: Vec<Table> = vec![
        HalfAngle::new(resolution, ONE(), (0..resolution.bins()).map(bin).collect()).expect("bins").into(),
        HalfAngle::new(resolution, ONE(), nothing).expect("bins").into(),
        Patches::new(rings(), ONE(), (0..441).map(patch).collect()).expect("patches").into(),
        open(&rgl::file(16), None).expect("a tensor file").value.table,
    ];
    for name in
        ["retro-3M-jaune.dat", "pink-felt-1d.alta", "test_13_planesymmetric_brdf_zemax.bsdf", "test_blinds_kf.xml"]
    {
        out.extend(shared(name).map(|bytes| open(&bytes, None).expect("a table").value.table));
    }
    out
}

#[test]
fn values_are_finite_everywhere() {
    let mut random = Stream::new(8, 0);
    for table in with_holes() {
        let mut v = vec![0.0; table.bands()];
        for n in 0..4_000 {
            let [a, b, c, d] = random.uniforms();
            // Every third direction within 1e-3 to 1e-9 of the horizon, some at it and below.
            let theta = |u: f64| if n % 3 == 0 { 0.5 * PI - 10.0_f64.powf(-3.0 - 6.0 * u) } else { 0.51 * PI * u };
            let (i, o) = (from_angles(theta(a), 7.0 * b), from_angles(theta(c), 7.0 * d));
            table.evaluate(i, o, &mut v);
            assert!(v.iter().all(|v| v.is_finite()), "{i} {o}: {v:?}");
            if i.z <= 0.0 || o.z <= 0.0 {
                assert!(v.iter().all(|v| *v == 0.0), "below the horizon: {v:?}");
            }
        }
        let theta = 89.9999;
        table.evaluate(from_degrees(theta, 0.0), from_degrees(theta, 180.0), &mut v);
        assert!(v.iter().all(|v| v.is_finite()), "{v:?}");
    }
}

#[test]
fn what_is_missing_is_taken_from_the_exchanged_directions() {
    // Two rings of one patch each; light from the outer to the inner one was not measured.
    let rings = vec![
        Ring { lower_deg: 0.0, upper_deg: 45.0, sectors: 1 },
        Ring { lower_deg: 45.0, upper_deg: 90.0, sectors: 1 },
    ];
    let table: Table = Patches::new(rings, ONE(), vec![1.0, f64::NAN, 3.0, 4.0]).expect("patches").into();
    let (inner, outer) = (from_degrees(10.0, 0.0), from_degrees(70.0, 0.0));
    let mut v = [0.0];
    table.evaluate(outer, inner, &mut v);
    assert!(v == [3.0] && !table.is_measured(outer, inner));
    table.evaluate(inner, outer, &mut v);
    assert!(v == [3.0] && table.is_measured(inner, outer));
}

#[test]
fn where_nothing_is_known_the_next_half_vector_is() {
    // Two rows of θ_h: below 22.5° all bins hold 2, above nothing was measured.
    let resolution = Resolution { theta_h: 2, theta_d: 1, phi_d: 1 };
    let table: Table = HalfAngle::new(resolution, ONE(), vec![2.0, f32::NAN]).expect("bins").into();
    let back = from_degrees(60.0, 0.0);
    let mut v = [0.0];
    table.evaluate(back, back, &mut v);
    assert!(v == [2.0] && !table.is_measured(back, back));
}

#[test]
fn negative_values_stay_negative() {
    let [half, ..] = &flat(-0.01)[..] else { panic!("tables") };
    let mut v = [0.0];
    half.evaluate(from_degrees(20.0, 0.0), from_degrees(40.0, 90.0), &mut v);
    assert!((v[0] + 0.01).abs() < 1e-9);
    // A negative albedo is what such values integrate to: −π/100.
    half.albedo(from_degrees(20.0, 0.0), &mut v);
    assert!((v[0] + 0.01 * PI).abs() < 1e-5, "{}", v[0]);
}
