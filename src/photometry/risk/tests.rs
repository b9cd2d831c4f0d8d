//! Against the exposure limits of Directive 2006/25/EC and IEC 62471, as the manual of a photo-radiometer made for them
//! (Delta Ohm HD2402) and public programs print them, and against closed forms.

use super::*;
use crate::spectrum::Spectrum;

/// A measured irradiance or radiance.
fn source(quantity: Quantity, subtense_rad: Option<f64>) -> Source {
    let factor = |q: Quantity| (q == quantity).then_some(1.0);
    Source {
        to_irradiance: factor(Quantity::Irradiance),
        to_radiance: factor(Quantity::Radiance),
        luminance_cd_per_m2: None,
        subtense_rad,
    }
}

fn risk(spectrum: &Spectrum, source: &Source) -> Risk {
    let plan = Plan::new(spectrum.grid(), spectrum.sampling(), &Contract::default()).expect("a rule");
    plan.evaluate(spectrum.values(), source)
}

fn of(risk: &Risk, hazard: Hazard) -> Assessment {
    *risk.assessments.iter().find(|a| a.hazard == hazard).expect("assessed")
}

fn line(nanometres: f64, value: f64) -> Spectrum {
    Spectrum::lines(Grid::new(vec![nanometres]).expect("a grid"), vec![value]).expect("a line")
}

/// One per nm from one wavelength to another.
fn flat(low: f64, high: f64) -> Spectrum {
    let grid = Grid::new(vec![low, high]).expect("a grid");
    Spectrum::density(grid, vec![1.0, 1.0]).expect("a spectrum")
}

/// What Table 6.1 prints are the exposure limits of clause 4.3 at the times of clause 6.1, rounded to the digits printed.
#[test]
fn the_limits_are_the_exposure_limits_at_the_times_of_the_groups() {
    type Limit = fn(f64) -> f64;
    let cases: [(Hazard, Limit, [f64; 3], [f64; 3]); 5] = [
        (Hazard::ActinicUv, |t| 30.0 / t, [3e4, 1e4, 1e3], [5e-4, 5e-4, 5e-3]),
        (Hazard::NearUv, |t| 1e4 / t, [1e3, 300.0, 100.0], [0.5, 0.5, 0.5]),
        (Hazard::BlueLight, |t| 1e6 / t, [1e4, 100.0, 0.25], [0.5, 0.5, 0.5]),
        (Hazard::RetinalThermal, |t| 50e3 / (0.1 * t.powf(0.25)), [10.0, 10.0, 0.25], [5e3, 5e3, 5e3]),
        (Hazard::Infrared, |t| 18e3 * t.powf(-0.75), [1e3, 100.0, 10.0], [5.0, 5.0, 50.0]),
    ];
    for (hazard, exposure, times_s, half_a_digit) in cases {
        for (k, printed) in hazard.limits(0.1).into_iter().enumerate() {
            let found = exposure(times_s[k]);
            assert!(
                (printed - found).abs() <= half_a_digit[k],
                "{hazard:?} {k}: {printed} printed, {found} by formula"
            );
        }
    }
}

/// `t_max = 30/E_S` (IEC 62471, eq. 4.2); S(254 nm) = 0.5, S(270 nm) = 1.
#[test]
fn ultraviolet_lines() {
    let mercury = risk(&line(254.0, 0.2), &source(Quantity::Irradiance, None));
    let found = of(&mercury, Hazard::ActinicUv);
    assert!((found.value - 0.1).abs() < 1e-15 && found.group == Group::Three);
    assert!((found.longest_s.expect("an end") - 300.0).abs() < 1e-9);
    // Just what 30 000 s allow is exempt, and no ultraviolet beyond 315 nm is near ultraviolet.
    let weak = risk(&line(270.0, 0.001), &source(Quantity::Irradiance, None));
    assert_eq!(of(&weak, Hazard::ActinicUv).group, Group::Exempt);
    assert_eq!(of(&weak, Hazard::NearUv).value, 0.0);
    // 20 W/m² at 365 nm: S = 0.00011, near ultraviolet for 500 s.
    let lamp = risk(&line(365.0, 20.0), &source(Quantity::Irradiance, None));
    let near = of(&lamp, Hazard::NearUv);
    assert!(near.group == Group::One && (near.longest_s.expect("an end") - 500.0).abs() < 1e-9);
    assert!((of(&lamp, Hazard::ActinicUv).value - 0.0022).abs() < 1e-15);
    assert_eq!(lamp.group(), Some(Group::One));
}

/// Times as the manual of the HD2402 gives them: `10⁶/L_B`, `(5·10⁷/(L_R α))⁴` with α in mrad, at least 11 here and at most 100,
/// `(18000/E_IR)^(4/3)`; classes 1 and 2 of blue light to 10⁴ and 4·10⁶ W/(m²·sr).
#[test]
fn times_of_a_photo_radiometer() {
    let cases = [
        (Hazard::BlueLight, 2e4, 0.1, Some(1e6 / 2e4)),
        (Hazard::RetinalThermal, 7e5, 0.05, Some((5e7_f64 / (7e5 * 50.0)).powi(4))),
        (Hazard::RetinalThermal, 4e5, 0.5, Some((5e5_f64 / 4e5).powi(4))),
        (Hazard::RetinalThermal, 2.79e5, 0.1, None),
        (Hazard::RetinalThermalWeak, 5.9e5, 0.01, Some(10.0)),
        (Hazard::Infrared, 200.0, 0.1, Some((18e3_f64 / 200.0).powf(4.0 / 3.0))),
        (Hazard::Infrared, 99.0, 0.1, None),
    ];
    for (hazard, value, subtense_rad, expected) in cases {
        let found = hazard.longest_s(value, subtense_rad);
        match (found, expected) {
            (Some(f), Some(e)) => assert!((f / e - 1.0).abs() < 1e-12, "{hazard:?}: {f} s, expected {e} s"),
            _ => assert_eq!(found, expected, "{hazard:?}"),
        }
    }
    // 6·10⁶/11 = 5.45·10⁵ W/(m²·sr) below 11 mrad.
    assert_eq!(Hazard::RetinalThermalWeak.limits(0.005)[0].round(), 545_455.0);
    let blue = |value| of(&risk(&line(437.0, value), &source(Quantity::Radiance, None)), Hazard::BlueLight).group;
    assert_eq!([99.0, 9e3, 3.9e6, 4.1e6].map(blue), [Group::Exempt, Group::One, Group::Two, Group::Three]);
}

/// ICNIRP 2013, eqs. 15–17, and IEC 62471, Table 6.1: 1 W/m² or 100 J/m²; group 1 has no room of its own.
#[test]
fn small_sources_are_judged_by_irradiance() {
    let blue =
        |value| of(&risk(&line(437.0, value), &source(Quantity::Irradiance, Some(0.01))), Hazard::BlueLightSmallSource);
    assert_eq!(
        [0.99, 1.01, 399.0, 401.0].map(|v| blue(v).group),
        [Group::Exempt, Group::Two, Group::Two, Group::Three]
    );
    assert_eq!(blue(0.99).longest_s, None);
    assert!((blue(2.0).longest_s.expect("an end") - 50.0).abs() < 1e-12);
}

/// ∫R from 500 to 700 nm is 200, from 1050 to 1150 nm 20, from 1200 to 1400 nm 4 nm.
#[test]
fn flat_radiance_meets_the_retina() {
    for (low, high, expected) in [(500.0, 700.0, 200.0), (1050.0, 1150.0, 20.0), (1200.0, 1400.0, 4.0)] {
        let found = of(&risk(&flat(low, high), &source(Quantity::Radiance, None)), Hazard::RetinalThermal);
        assert!((found.value - expected).abs() < 1e-9 && !found.complete, "{low}: {}", found.value);
    }
}

#[test]
fn what_was_not_assessed_is_said() {
    let visible = risk(&flat(380.0, 780.0), &source(Quantity::Irradiance, None));
    let missing: Vec<(Hazard, Missing)> = visible.missing.clone();
    assert_eq!(
        missing,
        [
            (Hazard::BlueLight, Missing::Radiance),
            (Hazard::RetinalThermal, Missing::Radiance),
            (Hazard::Infrared, Missing::Range),
        ]
    );
    assert!(!visible.complete());
    // Lines are all there is: a single one is assessed whole, and ultraviolet sheds no blue light whatever the radiance.
    let both = Source { to_radiance: Some(1.0), ..source(Quantity::Irradiance, None) };
    assert!(risk(&line(555.0, 1.0), &both).complete());
    assert!(risk(&line(254.0, 1.0), &source(Quantity::Irradiance, None)).complete());
    // A dim source in the visible is judged by its infrared too.
    let dim = Source { luminance_cd_per_m2: Some(9.0), ..both };
    assert_eq!(of(&risk(&line(940.0, 1e6), &dim), Hazard::RetinalThermalWeak).group, Group::Three);
}

#[test]
fn the_angle_follows_from_the_geometry() {
    let at = |shape| Geometry { shape: Some(shape), distance_m: Some(0.2), ..Geometry::default() };
    let disk = subtense_rad(Quantity::Radiance, &at(Shape::Disk { radius_m: 0.005 })).expect("an angle");
    assert!((disk - 2.0 * 0.025_f64.atan()).abs() < 1e-15);
    // The mean of both sides.
    let oblong = subtense_rad(Quantity::Radiance, &at(Shape::Rectangle { width_m: 0.01, height_m: 0.02 }));
    assert!((oblong.expect("an angle") - (0.025_f64.atan() + 0.05_f64.atan())).abs() < 1e-15);
    let cone = Geometry { cone_half_angle_rad: Some(0.02), ..Geometry::default() };
    assert_eq!(subtense_rad(Quantity::Irradiance, &cone), Some(0.04));
    // The same as a solid angle: Ω = 2π(1 − cos 0.02).
    let omega = std::f64::consts::TAU * (1.0 - 0.02_f64.cos());
    let seen = Geometry { solid_angle_sr: Some(omega), ..Geometry::default() };
    assert!((subtense_rad(Quantity::Irradiance, &seen).expect("an angle") - 0.04).abs() < 1e-9);
    // The cone of a lamp's own light says nothing of its size.
    assert_eq!(subtense_rad(Quantity::Flux, &cone), None);
}
