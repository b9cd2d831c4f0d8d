//! Lamps of one plane, of no candela, of half a sphere, with a beam of a thousandth of a degree, seen along their opening.

use std::f64::consts::PI;

use glam::DVec3;
use photopic::luminaire::beam::{beam_angles, field_angles};
use photopic::luminaire::grid::{Placed, Plane, PointsAt, Receiver, Settings, illuminance};
use photopic::luminaire::placement::{Orientation, Placement};
use photopic::luminaire::{Distribution, Interpolation, Luminaire, Symmetry, System};

use crate::close;

/// A lamp of one plane.
fn rotational(vertical_deg: &[f64], values: &[f64]) -> Distribution {
    Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vertical_deg.to_vec(), values.to_vec())
        .expect("a sound table")
}

/// A point's illuminance straight below a lamp at a height.
fn below(table: &Distribution, height_m: f64) -> f64 {
    let luminaire = Luminaire::of(table.clone());
    let placement = Placement::new(DVec3::new(0.0, 0.0, height_m), Orientation::DOWN, 1.0).expect("a place");
    let half = 1e-9 * height_m;
    let sides = [DVec3::X * 2.0 * half, DVec3::Y * 2.0 * half];
    let plane = Plane::new(DVec3::new(-half, -half, 0.0), sides, [1, 1], PointsAt::Centres).expect("a plane");
    let placed = [Placed { luminaire: &luminaire, placement }];
    illuminance(&placed, &plane, &Receiver::Planar(DVec3::Z), &Settings::default()).expect("it is lit").values[0]
}

/// ∫ I sinγ dγ dC of a straight line from a at γ₀ to 0 at γ₁: 2π a (cos γ₀ − (sin γ₁ − sin γ₀)/(γ₁ − γ₀)).
fn edge(a: f64, from_deg: f64, to_deg: f64) -> f64 {
    let (from, to) = (from_deg.to_radians(), to_deg.to_radians());
    2.0 * PI * a * (from.cos() - (to.sin() - from.sin()) / (to - from))
}

#[test]
fn lamps_of_any_strength_have_their_flux_and_their_angles() {
    for candela in [1e-300, 1e-6, 1.0, 1e9, 1e300] {
        let table = rotational(&[0.0, 60.0, 90.0], &[candela, candela, 0.0]);
        // A cone of 60°, 2π(1 − ½), and the edge.
        close(table.total_flux(), PI * candela + edge(candela, 60.0, 90.0), 1e-14, "flux");
        assert_eq!(table.peak().0, candela);
        // Half of the peak at 75°, a tenth at 87°, on both sides.
        for angles in beam_angles(&table) {
            close(angles.c0_c180.expect("a beam"), 150.0, 1e-12, "beam");
        }
        close(field_angles(&table)[0].c90_c270.expect("a field"), 174.0, 1e-12, "field");
        close(below(&table, 1.0), candela, 1e-12, "1 m below");
    }
}

#[test]
fn a_dark_lamp_has_no_beam_and_no_numbers_that_are_none() {
    for interpolation in [Interpolation::Bilinear, Interpolation::MonotoneCubic] {
        let dark = rotational(&[0.0, 90.0, 180.0], &[0.0; 3]).with_interpolation(interpolation);
        assert_eq!(
            (dark.total_flux(), dark.total_flux_zonal(), dark.peak().0, below(&dark, 1.0)),
            (0.0, 0.0, 0.0, 0.0)
        );
        for angles in beam_angles(&dark).into_iter().chain(field_angles(&dark)) {
            assert!(
                angles.c0_c180.is_none_or(f64::is_finite) && angles.c90_c270.is_none_or(f64::is_finite),
                "{angles:?}"
            );
        }
    }
}

#[test]
fn an_empty_hemisphere_gets_nothing() {
    let up = rotational(&[0.0, 90.0, 90.0 + 1e-9, 180.0], &[0.0, 0.0, 5.0, 5.0]);
    assert_eq!((below(&up, 2.0), up.flux_between(0.0, 90.0)), (0.0, 0.0));
    // 2π sr of 5 cd, but for an edge of 1e-9°.
    close(up.total_flux(), 10.0 * PI, 1e-10, "upward flux");
    close(up.flux_between(90.0, 180.0), 10.0 * PI, 1e-10, "the same by zones");
    // A table that ends at 90° says nothing of what is above: dark.
    let down = rotational(&[0.0, 90.0], &[7.0, 7.0]);
    close(down.total_flux(), 14.0 * PI, 1e-14, "downward flux");
    assert_eq!(down.at(0.0, 90.01), 0.0);
}

#[test]
fn one_plane_is_every_plane_and_many_alike_are_one() {
    let single = rotational(&[0.0, 30.0, 90.0], &[100.0, 80.0, 0.0]);
    let planes: Vec<f64> = (0..360).map(f64::from).collect();
    let values = planes.iter().flat_map(|_| [100.0, 80.0, 0.0]).collect();
    let many =
        Distribution::new(System::TypeC, Symmetry::None, planes, vec![0.0, 30.0, 90.0], values).expect("a table");
    // 360 sums of doubles.
    close(many.total_flux(), single.total_flux(), 1e-13, "flux");
    for c in [0.0, 123.456, 359.999_999] {
        assert_eq!(single.at(c, 45.0), 60.0 * 80.0 / 80.0);
        close(many.at(c, 45.0), 60.0, 1e-14, "between the planes");
    }
}

/// A searchlight of 0.001°: α²/6 of 2π sr; the sines that its flux is made of agree to nine digits.
#[test]
fn a_thousandth_of_a_degree_keeps_its_digits() {
    for degrees in [1e-3, 1e-6] {
        let beam = rotational(&[0.0, degrees, 90.0], &[1e9, 0.0, 0.0]);
        let a = degrees.to_radians();
        close(beam.total_flux(), 2e9 * PI * (a * a / 6.0 - a.powi(4) / 120.0), 1e-12, "flux");
        close(beam_angles(&beam)[0].c0_c180.expect("a beam"), degrees, 1e-9, "beam");
    }
}

#[test]
fn the_inverse_square_holds_from_a_hair_to_a_light_year() {
    let even = rotational(&[0.0, 180.0], &[3.0, 3.0]);
    // Nearer than a micrometre a point is in the lamp.
    for height in [1e-3, 1.0, 1e6, 9.46e15] {
        close(below(&even, height) * height * height, 3.0, 1e-12, "E h²");
    }
}

#[test]
fn what_is_no_table_is_refused() {
    let make = |vertical: Vec<f64>, values: Vec<f64>| {
        Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vertical, values)
    };
    for (vertical, values) in [
        (vec![], vec![]),
        (vec![0.0, 90.0], vec![1.0]),
        (vec![0.0, 90.0], vec![1.0, f64::NAN]),
        (vec![0.0, 90.0], vec![f64::INFINITY, 1.0]),
        (vec![0.0, 0.0], vec![1.0, 1.0]),
        (vec![90.0, 0.0], vec![1.0, 1.0]),
        (vec![0.0, 181.0], vec![1.0, 1.0]),
        (vec![f64::NAN, 90.0], vec![1.0, 1.0]),
    ] {
        assert!(make(vertical.clone(), values).is_err(), "{vertical:?}");
    }
}
