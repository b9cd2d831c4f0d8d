//! Solid angles down to 1e-18 sr, vision by starlight and by the sun, single photons.

use std::f64::consts::PI;

use photopic::geometry::solid_angle::{
    cone, cone_half_angle, disk, disk_projected, polygon, polygon_projected, rectangle_corners, sphere,
};
use photopic::photometry::mesopic::{adaptation, mesopic};
use photopic::photometry::photon;
use photopic::photometry::transfer::{Shape, illuminance_of_point, intensity_of_point};
use photopic::spectrum::integrate::Contract;
use photopic::spectrum::{Grid, Quantity, Sampling, Spectrum};
use photopic::units::{Candela, Metre, Radian};

use crate::{K_M, close, convert, photopic};

/// 2π(1 − cos τ) cancels all digits below 1e-8 rad; 4π sin²(τ/2) none.
#[test]
fn cones_and_disks_keep_their_digits() {
    // 50 digits.
    for (tau, omega) in [
        (1e-9, 3.141_592_653_589_793_6e-18),
        (1e-4, 3.141_592_650_971_799_6e-8),
        (1.5, 5.838_730_360_990_076),
        (PI, 4.0 * PI),
    ] {
        close(cone(tau), omega, 1e-15, "a cone");
        // The inverse is steep at the whole sphere: half the digits.
        close(cone_half_angle(omega), tau, if tau == PI { 1e-7 } else { 1e-15 }, "its angle");
    }
    close(disk(1e-9, 1.0), 3.141_592_653_589_793_6e-18, 1e-15, "a far disk");
    close(disk(1e9, 1.0), 6.283_185_300_896_401, 1e-15, "a near one");
    close(disk_projected(1e9, 1.0), PI, 1e-15, "a near one, projected");
    close(sphere(1e-150, 1.0), PI * 1e-300, 1e-15, "a star");
    let far = Shape::Disk { radius_m: 1e-9 };
    close(far.solid_angle_sr(1.0), 3.141_592_653_589_793_6e-18, 1e-15, "a disc in its words");
}

/// From squares of 1e-9 rad over slits of 1 × 1e-12 to the whole hemisphere.
#[test]
fn polygons_keep_their_digits() {
    let (tiny, slit, vast) = (2_f64.powi(-30), 2_f64.powi(-40), 2_f64.powi(30));
    for ((width, height), omega, projected) in [
        ((tiny, tiny), 8.673_617_379_884_035e-19, 8.673_617_379_884_035e-19),
        ((1.0, slit), 8.134_767_913_360_664e-13, 7.854_829_245_850_907e-13),
        ((vast, vast), 6.283_185_296_642_874, PI),
    ] {
        let corners = rectangle_corners(width, height, 1.0);
        // From corners a billion times as far as the plane the sums of the formula lose as many digits.
        close(polygon(&corners), omega, 1e-14_f64.max(f64::EPSILON * width), "a rectangle");
        close(polygon_projected(&corners), projected, 1e-14, "a rectangle, projected");
    }
}

#[test]
fn the_inverse_square_holds_from_atoms_to_galaxies() {
    for distance in [1e-140, 1e-10, 1.0, 1e21, 1e140] {
        let e = illuminance_of_point(Candela(2.0), Metre(distance), Radian(0.0));
        close(e.0 * distance * distance, 2.0, 1e-15, "E d²");
        close(intensity_of_point(e, Metre(distance)).0, 2.0, 1e-15, "and back");
    }
    // cos 89.9999° with 50 digits.
    let grazing = illuminance_of_point(Candela(1.0), Metre(1.0), Radian(89.9999_f64.to_radians()));
    close(grazing.0, 1.745_329_251_993_5e-6, 1e-9, "grazing");
}

/// CIE 191: by starlight (1e-4 cd/m², or 1e-300) vision is scotopic, by the sun's disc (2e9) photopic; between, the fixed point of its equation
/// with 50 digits.
#[test]
fn vision_is_scotopic_by_starlight_and_photopic_by_the_sun() {
    for (luminance, m, seen) in [
        (1e-300, 0.0, 2e-300),
        (1e-4, 0.0, 2e-4),
        (0.3, 0.618_882_248_664_800_6, 0.359_530_384_225_770_7),
        (2e9, 1.0, 2e9),
        (1e300, 1.0, 1e300),
    ] {
        let found = adaptation(luminance, 2.0).expect("a luminance");
        assert!((found.m - m).abs() < 1e-14, "{luminance}: {found:?}");
        close(found.luminance_mesopic, seen, 1e-14, "mesopic");
    }
    close(mesopic(1e-300, 3e-300, 0.0), 3e-300, 1e-15, "the scotopic end");
}

#[test]
fn photons_are_counted_one_by_one_and_by_the_mole() {
    // λ/(h c) with 50 digits, exact SI: photons in a joule at 555 nm.
    let per_joule = 2.793_934_694_986_203_7e18;
    let grid = Grid::new(vec![555.0]).expect("a line");
    let plan = photon::Plan::new(&grid, Sampling::Lines, &Contract::default()).expect("lines fit");
    for joules in [1e-300, 1.0 / per_joule, 1.0, 1e280] {
        close(plan.evaluate(&[joules]).total_count, joules * per_joule, 1e-14, "photons");
    }
    let nothing = plan.evaluate(&[0.0]);
    assert_eq!((nothing.total_count, nothing.umol_per_j, nothing.par_umol_per_par_j), (0.0, None, None));
}

/// Starlight (3e-4 lx) and sunlight (1e5 lx) of the same colour differ by their factor and nothing else.
#[test]
fn no_figure_depends_on_the_level() {
    let of = |watts: f64| {
        let line = Spectrum::lines(Grid::new(vec![555.0]).expect("a line"), vec![watts]).expect("finite");
        convert(Quantity::Irradiance, &line).value
    };
    for lux in [1e-300, 3e-4, 1e5, 1e300] {
        let c = of(lux / K_M);
        close(photopic(&c), lux, 1e-15, "illuminance");
        close(c.efficacy_lm_per_w.expect("an efficacy"), K_M, 1e-15, "efficacy");
    }
}
