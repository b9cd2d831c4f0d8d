//! Luminaires turned, converted, resampled, made symmetric, scaled and merged: closed forms, symmetries that physics gives, and
//! real files, whose flux and peak have to survive.

mod common;

use std::f64::consts::PI;
use std::fs;

use glam::DVec3;
use photopic::finding::{Finding, Severity};
use photopic::luminaire::format::{self, eulumdat, ies, tm33};
use photopic::luminaire::transform::{
    Axis, Change, Error, Grid, Part, Resampling, Scale, Turn, merge, scale, symmetrise, turn,
};
use photopic::luminaire::{Body, Distribution, Interpolation, Kind, Luminaire, Shape, Symmetry, System, zonal};
use proptest::prelude::*;

fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..=((to - from) / step).round() as usize).map(|i| from + step * i as f64).collect()
}

fn table(
    (system, symmetry): (System, Symmetry),
    horizontal: &[f64],
    vertical: &[f64],
    f: impl Fn(f64, f64) -> f64,
) -> Distribution {
    let values = horizontal.iter().flat_map(|h| vertical.iter().map(|v| f(*h, *v)).collect::<Vec<_>>()).collect();
    Distribution::new(system, symmetry, horizontal.to_vec(), vertical.to_vec(), values).expect("a sound table")
}

/// A luminaire with nothing but a distribution, an opening of 1.2 m along C90 and 0.3 m along C0, and a lamp of 1000 lm.
fn lamp(distribution: Distribution) -> Luminaire {
    let text = "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] ours\nTILT=NONE\n\
                1 1000 1 2 1 1 2 1.2 0.3 0\n1 1 10\n0 90\n0\n1 0\n";
    let read = format::read(text.as_bytes(), &Default::default()).expect("a file").value;
    Luminaire { distribution, ..read }
}

fn only(by: Turn) -> impl Fn(&Luminaire) -> Luminaire {
    move |lamp| turn(lamp, &by, lamp.distribution.system(), &Resampling::default()).expect("turned").value
}

fn about_axis(about_axis_deg: f64) -> Turn {
    Turn { about_axis_deg, ..Turn::default() }
}

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(|f| f.code).collect()
}

const SYSTEMS: [System; 3] = [System::TypeA, System::TypeB, System::TypeC];
/// I = I₀ cosⁿ of the angle to an axis: flux 2π I₀/(n + 1).
const POWER: i32 = 20;
const I0: f64 = 1000.0;
const FLUX: f64 = 2.0 * PI * I0 / (POWER as f64 + 1.0);

/// The beam's axis, 25° from nadir towards C40.
fn axis() -> DVec3 {
    let ((sg, cg), (sc, cc)) = (25_f64.to_radians().sin_cos(), 40_f64.to_radians().sin_cos());
    DVec3::new(sg * cc, sg * sc, -cg)
}

/// That beam tabulated in a system.
fn beam(system: System, step: f64, axis: DVec3) -> Distribution {
    let (h, v) = match system {
        System::TypeC => (steps(0.0, 360.0, step), steps(0.0, 90.0, step)),
        _ => (steps(-90.0, 90.0, step), steps(-90.0, 90.0, step)),
    };
    let frame = table((system, Symmetry::None), &h, &[0.0], |_, _| 0.0);
    table((system, Symmetry::None), &h, &v, |h, v| I0 * frame.direction(h, v).dot(axis).max(0.0).powi(POWER))
}

#[test]
fn the_three_types_agree_on_a_beam_of_known_flux() {
    for system in SYSTEMS {
        // Chords are short in the second order of the step: extrapolated to none, the closed form is left.
        let [coarse, fine] = [1.0, 0.5].map(|step| beam(system, step, axis()));
        let limit = (4.0 * fine.total_flux() - coarse.total_flux()) / 3.0;
        assert!((limit / FLUX - 1.0).abs() < 1e-6, "{system:?}: {limit} against {FLUX}");
        for to in SYSTEMS {
            let lamp = lamp(fine.clone());
            let made = turn(&lamp, &Turn::default(), to, &Resampling::default()).expect("converted");
            let d = &made.value.distribution;
            assert_eq!(d.system(), to);
            let change = Change::between(&fine, d);
            assert!(change.flux.abs() <= 1e-4 && change.peak.abs() <= 1e-4, "{system:?} to {to:?}: {change:?}");
            // Chords are off by h²/8 of the second derivative at most, which along C is 20 I₀ sin²γ and a part of the slope:
            // 0.007 I₀ at γ 30° for the widest steps tried, 5°.
            let direct = beam(to, 0.5, axis());
            for (h, v) in [(10.0, 12.0), (30.0, 5.0), (14.0, 20.0)] {
                let (a, b) = (d.at(h, v), direct.at(h, v));
                assert!((a - b).abs() < 0.01 * I0, "{system:?} to {to:?} at {h} {v}: {a} against {b}");
            }
            assert!(made.findings.iter().all(|f| f.severity == Severity::Info), "{:?}", made.findings);
            assert_eq!(made.value.opening, lamp.opening);
        }
    }
}

#[test]
fn a_tilted_beam_is_the_beam_about_the_tilted_axis() {
    let straight = lamp(beam(System::TypeC, 0.5, DVec3::NEG_Z));
    let by = Turn { about_axis_deg: 77.0, tilt_deg: 25.0, tilt_towards_deg: 40.0 };
    assert!((by.rotation() * DVec3::NEG_Z - axis()).length() < 1e-14);
    for system in SYSTEMS {
        let made = turn(&straight, &by, system, &Resampling::default()).expect("turned");
        let d = &made.value.distribution;
        // The chords of ½° are short by about (n + 1) h²/12 = 1.3e-4, the sampling by 1e-4 more at most.
        assert!((d.total_flux() / FLUX - 1.0).abs() < 2.4e-4, "{system:?}: {}", d.total_flux());
        assert!((d.peak().0 / I0 - 1.0).abs() <= 1e-4);
        assert!((d.towards(axis()) / I0 - 1.0).abs() <= 1e-4, "{system:?}: {}", d.towards(axis()));
        assert_eq!(codes(&made.findings), ["L401", "L403"]);
        assert_eq!(made.value.opening, None);
        // And back again.
        let back = Turn { tilt_towards_deg: 220.0, about_axis_deg: 0.0, tilt_deg: 25.0 };
        let again = turn(&made.value, &back, System::TypeC, &Resampling::default()).expect("turned").value.distribution;
        assert!((again.at(0.0, 0.0) / I0 - 1.0).abs() < 2e-4, "{}", again.at(0.0, 0.0));
    }
    // What shines upwards has no place before a Type B luminaire.
    let up = Turn { tilt_deg: 100.0, ..Turn::default() };
    let refused = turn(&straight, &up, System::TypeB, &Resampling::default());
    assert!(matches!(refused, Err(Error::Behind { share }) if share > 0.5), "{refused:?}");
}

#[test]
fn an_even_half_space_is_one_in_every_type() {
    // 2π in closed form, the step at 90° being the end of the table.
    let d = table((System::TypeB, Symmetry::None), &steps(-90.0, 90.0, 10.0), &steps(-90.0, 90.0, 10.0), |_, _| 1.0);
    let made = turn(&lamp(d), &Turn::default(), System::TypeC, &Resampling::default()).expect("converted").value;
    assert_eq!(made.distribution.symmetry(), Symmetry::Rotational);
    assert!((made.distribution.total_flux() / (2.0 * PI) - 1.0).abs() < 1e-12);
}

fn any_table() -> impl Strategy<Value = Distribution> {
    let symmetry = prop_oneof![
        Just((Symmetry::Rotational, 0.0, 0.0)),
        Just((Symmetry::Quadrant, 0.0, 90.0)),
        Just((Symmetry::BilateralC0, 0.0, 180.0)),
        Just((Symmetry::BilateralC90, 90.0, 270.0)),
        Just((Symmetry::None, 0.0, 360.0)),
    ];
    (symmetry, 2_usize..7, 2_usize..8, prop_oneof![Just(90.0), Just(180.0)]).prop_flat_map(
        |((symmetry, from, to), planes, rows, end)| {
            let planes = if symmetry == Symmetry::Rotational { 1 } else { planes };
            proptest::collection::vec(0.0..1000.0_f64, planes * rows).prop_map(move |mut values| {
                if symmetry == Symmetry::None {
                    let (first, rest) = values.split_at_mut(rows);
                    rest[(planes - 2) * rows..].copy_from_slice(first);
                }
                let even = |from: f64, to: f64, n: usize| -> Vec<f64> {
                    (0..n).map(|i| if n == 1 { from } else { from + (to - from) * i as f64 / (n - 1) as f64 }).collect()
                };
                Distribution::new(System::TypeC, symmetry, even(from, to, planes), even(0.0, end, rows), values)
                    .expect("a sound table")
            })
        },
    )
}

fn directions() -> Vec<(f64, f64)> {
    (0..40).map(|i| (f64::from(i) * 47.3 % 360.0, f64::from(i) * 13.7 % 180.0)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn turning_about_the_axis_moves_every_value_and_no_flux(d in any_table(), by in -400.0..400.0_f64) {
        let given = lamp(d);
        let made = only(about_axis(by))(&given).distribution;
        let before = &given.distribution;
        prop_assert!((made.total_flux() - before.total_flux()).abs() <= 1e-12 * before.total_flux());
        prop_assert!((made.peak().0 - before.peak().0).abs() <= 1e-9 * before.peak().0);
        for (c, g) in directions() {
            // Angles are rounded to a billionth of a degree.
            prop_assert!((made.at(c + by, g) - before.at(c, g)).abs() < 1e-6, "C{} γ{}", c, g);
        }
    }

    #[test]
    fn n_turns_of_an_nth_are_none(d in any_table(), n in 1_u32..9) {
        let given = lamp(d);
        let turned = (0..n).fold(given.clone(), |lamp, _| only(about_axis(360.0 / f64::from(n)))(&lamp));
        for (c, g) in directions() {
            prop_assert!((turned.distribution.at(c, g) - given.distribution.at(c, g)).abs() < 1e-5);
        }
        if 4 % n == 0 {
            prop_assert_eq!(turned.opening, given.opening);
        }
    }

    #[test]
    fn symmetric_images_average_to_the_same_flux(d in any_table()) {
        for symmetry in [Symmetry::Rotational, Symmetry::Quadrant, Symmetry::BilateralC0, Symmetry::BilateralC90] {
            let made = symmetrise(&lamp(d.clone()), symmetry).expect("Type C").value;
            let after = &made.distribution;
            prop_assert_eq!(after.symmetry(), symmetry);
            prop_assert!((after.total_flux() - d.total_flux()).abs() <= 1e-12 * d.total_flux());
            prop_assert!(after.peak().0 <= d.peak().0 * (1.0 + 1e-14));
            for (c, g) in directions() {
                let mean = match symmetry {
                    Symmetry::BilateralC0 => 0.5 * (d.at(c, g) + d.at(-c, g)),
                    Symmetry::BilateralC90 => 0.5 * (d.at(c, g) + d.at(180.0 - c, g)),
                    Symmetry::Quadrant => {
                        0.25 * (d.at(c, g) + d.at(-c, g) + d.at(180.0 - c, g) + d.at(180.0 + c, g))
                    }
                    _ => d.zonal_mean(g),
                };
                prop_assert!((after.at(c, g) - mean).abs() < 1e-6, "{:?} C{} γ{}", symmetry, c, g);
            }
            // What is symmetric stays.
            let again = symmetrise(&made, symmetry).expect("Type C").value;
            prop_assert!(Change::between(after, &again.distribution).flux.abs() < 1e-12);
        }
    }

    #[test]
    fn merged_luminaires_add_up(a in any_table(), b in any_table(), by in 0.0..360.0_f64, dim in 0.0..2.0_f64) {
        let (first, second) = (lamp(a.clone()), lamp(b.clone()));
        let parts = [
            Part { luminaire: &first, rotate_deg: 0.0, dim: 1.0 },
            Part { luminaire: &second, rotate_deg: by, dim },
        ];
        let sum = merge(&parts).expect("one kind").value;
        let expected = a.total_flux() + dim * b.total_flux();
        // A table that ends at 90° with light falls to nothing within 1e-4°.
        prop_assert!((sum.distribution.total_flux() / expected - 1.0).abs() < 1e-5);
        for (c, g) in directions().into_iter().filter(|(_, g)| (g - 90.0).abs() > 0.01) {
            prop_assert!((sum.distribution.at(c, g) - a.at(c, g) - dim * b.at(c - by, g)).abs() < 1e-4);
        }
        prop_assert_eq!(sum.lamps.len(), 1);
        prop_assert!((sum.lamps[0].flux_lm.expect("rated") - 1000.0 * (1.0 + dim)).abs() < 1e-9);
    }

    #[test]
    fn a_finer_grid_with_the_same_angles_changes_nothing(d in any_table()) {
        let given = lamp(d);
        let (h, v) = (given.distribution.horizontal_deg(), given.distribution.vertical_deg());
        let finer = |list: &[f64]| -> Vec<f64> {
            list.windows(2).flat_map(|w| [w[0], 0.3 * w[0] + 0.7 * w[1]]).chain([list[list.len() - 1]]).collect()
        };
        let grid = Grid { horizontal: Axis::List(finer(h)), vertical: Axis::List(finer(v)) };
        let resampling = Resampling { grid: Some(grid), keep_flux: false };
        let made = turn(&given, &Turn::default(), System::TypeC, &resampling).expect("resampled").value.distribution;
        prop_assert_eq!(made.symmetry(), given.distribution.symmetry());
        let change = Change::between(&given.distribution, &made);
        prop_assert!(change.flux.abs() < 1e-12 && change.peak.abs() < 1e-12, "{:?}", change);
    }
}

#[test]
fn scaling_takes_lamps_and_declared_flux_along() {
    let d = table((System::TypeC, Symmetry::Rotational), &[0.0], &[0.0, 90.0, 180.0], |_, _| 50.0);
    let mut given = lamp(d);
    given.declared_flux = Some(600.0);
    given.keywords.push(("_ABSOLUTELUMENS".into(), "600".into()));
    let made = scale(&given, &Scale::Flux(800.0)).expect("lit");
    assert!((made.value.distribution.total_flux() - 800.0).abs() < 1e-9);
    let factor = 800.0 / (200.0 * PI);
    assert!((made.value.declared_flux.expect("declared") - 600.0 * factor).abs() < 1e-9);
    assert!((zonal::light_output_ratio(&made.value).expect("rated") - 0.2 * PI).abs() < 1e-12);
    assert_eq!((made.value.input_power_w, codes(&made.findings)), (Some(10.0), vec!["L404", "L405"]));
    assert!(made.value.keywords.iter().all(|(label, _)| label != "_ABSOLUTELUMENS"));
    let rated = scale(&given, &Scale::FluxPerLamp(2500.0)).expect("rated").value;
    assert_eq!(zonal::lamp_flux_lm(&rated), Some(2500.0));
    assert!((rated.distribution.peak().0 - 125.0).abs() < 1e-12);
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(scale(&given, &Scale::Factor(wrong)), Err(Error::Argument { .. })), "{wrong}");
    }
    given.absolute = true;
    assert_eq!(scale(&given, &Scale::FluxPerLamp(1.0)), Err(Error::NoLampFlux));
    given.distribution = given.distribution.scaled(0.0);
    assert_eq!(scale(&given, &Scale::Flux(1.0)), Err(Error::Dark));
}

#[test]
fn the_opening_goes_along_by_its_axes() {
    let d = table((System::TypeC, Symmetry::BilateralC0), &[0.0, 180.0], &[0.0, 90.0], |c, g| 90.0 + c - g);
    let given = lamp(d);
    // LM-63's width 1.2 m lies along C90.
    let opening = Body { shape: Shape::Rectangle, length_m: 1.2, width_m: 0.3, height_m: 0.0 };
    assert_eq!(given.opening, Some(opening));
    let quarter = only(about_axis(90.0))(&given);
    assert_eq!(quarter.opening, Some(Body { length_m: 0.3, width_m: 1.2, ..opening }));
    assert_eq!(quarter.distribution.symmetry(), Symmetry::BilateralC90);
    let written = ies::write(&quarter, ies::Version::Lm63_2019).expect("written").value;
    assert!(written.contains(" 0.3 1.2 0\r\n"), "{written}");
    let odd = turn(&given, &about_axis(30.0), System::TypeC, &Resampling::default()).expect("turned");
    assert_eq!((odd.value.opening, codes(&odd.findings)), (None, vec!["L402", "L403"]));
}

#[test]
fn unlike_luminaires_are_merged_or_refused() {
    let even = table((System::TypeC, Symmetry::Rotational), &[0.0], &[0.0, 90.0, 180.0], |_, _| 50.0);
    let flood = table((System::TypeB, Symmetry::Quadrant), &[0.0, 90.0], &[-90.0, 90.0], |_, _| 10.0);
    let (a, b) = (lamp(even), lamp(flood));
    let part = |luminaire, dim| Part { luminaire, rotate_deg: 0.0, dim };
    let sum = merge(&[part(&a, 1.0), part(&b, 1.0)]).expect("both of candela");
    assert_eq!(sum.value.distribution.system(), System::TypeC);
    assert!((sum.value.distribution.total_flux() / (220.0 * PI) - 1.0).abs() < 1e-5);
    assert_eq!((sum.value.input_power_w, sum.value.opening), (Some(20.0), a.opening));
    let two = merge(&[part(&b, 1.0), part(&b, 1.0)]).expect("alike").value;
    assert_eq!((two.distribution.system(), two.distribution.peak().0), (System::TypeB, 20.0));
    let dimmed = merge(&[part(&a, 1.0), part(&a, 0.5)]).expect("alike");
    assert_eq!((dimmed.value.input_power_w, dimmed.value.lamps[0].power_w), (None, None));
    assert!(codes(&dimmed.findings).contains(&"L407"));
    let radiant = Luminaire { kind: Kind::Radiant, ..a.clone() };
    assert!(matches!(merge(&[part(&a, 1.0), part(&radiant, 1.0)]), Err(Error::Kinds { .. })));
    assert!(matches!(merge(&[part(&a, -1.0)]), Err(Error::Argument { .. })));
    assert_eq!(merge(&[]), Err(Error::Nothing));
    assert_eq!(symmetrise(&b, Symmetry::Rotational), Err(Error::NotTypeC));
    assert_eq!(symmetrise(&b, Symmetry::Quadrant).map(|s| s.value), Ok(b));
}

#[test]
fn a_coarse_grid_says_what_it_costs_and_keeps_the_flux_on_request() {
    let gamma = steps(0.0, 90.0, 1.0);
    let cosine = table((System::TypeC, Symmetry::Rotational), &[0.0], &gamma, |_, g| g.to_radians().cos());
    let given = lamp(cosine);
    let grid = Grid { horizontal: Axis::Step(15.0), vertical: Axis::Step(30.0) };
    let resample = |keep_flux| {
        let resampling = Resampling { grid: Some(grid.clone()), keep_flux };
        turn(&given, &Turn::default(), System::TypeC, &resampling).expect("resampled")
    };
    // Chords of h through cos γ, by parts: 2π ∫ chord sin γ dγ = 2π (1 − tan(h/2)/h).
    let chords = |h: f64| 1.0 - (0.5 * h.to_radians()).tan() / h.to_radians();
    let coarse = resample(false);
    let change = Change::between(&given.distribution, &coarse.value.distribution);
    assert!((change.flux - (chords(30.0) / chords(1.0) - 1.0)).abs() < 1e-12 && change.peak == 0.0, "{change:?}");
    assert_eq!((coarse.findings[0].code, coarse.findings[0].severity), ("L401", Severity::Warning));
    let kept = resample(true).value.distribution;
    let again = Change::between(&given.distribution, &kept);
    assert!(again.flux.abs() < 1e-14 && (again.peak - (1.0 / (1.0 + change.flux) - 1.0)).abs() < 1e-12);
    for wrong in [Axis::Step(0.0), Axis::Step(f64::NAN), Axis::List(vec![0.0, 200.0]), Axis::Step(1e-9)] {
        let grid = Some(Grid { horizontal: Axis::Step(15.0), vertical: wrong.clone() });
        let made = turn(&given, &Turn::default(), System::TypeC, &Resampling { grid, keep_flux: false });
        assert!(made.is_err(), "{wrong:?}");
    }
}

/// The real files that the reference could read, with its figures.
fn real_files() -> Option<Vec<(String, Luminaire, f64, f64)>> {
    let folder = common::shared("luminaires")?;
    let rows = common::rows(&folder.join("reference.csv"));
    let real = rows.into_iter().filter(|row| row["kind"] == "real" && row["ref_status"] == "ok");
    Some(
        real.map(|row| {
            let bytes = fs::read(folder.join("files").join(&row["file"])).expect("a listed file");
            let read = format::read(&bytes, &Default::default()).unwrap_or_else(|e| panic!("{}: {e}", row["file"]));
            let number = |key: &str| row[key].parse().expect("a number");
            (row["file"].clone(), read.value, number("flux_exact"), number("peak_cd"))
        })
        .collect(),
    )
}

#[test]
fn the_flood_keeps_its_flux_and_peak_in_every_type() {
    let Some(files) = real_files() else { return };
    let (_, flood, flux, peak) = files.into_iter().find(|(name, ..)| name.ends_with("flood/2.1.IES")).expect("listed");
    assert_eq!((flux, peak, flood.distribution.system()), (10698.335, 5287.0, System::TypeB));
    for system in [System::TypeC, System::TypeA] {
        let made = turn(&flood, &Turn::default(), system, &Resampling::default()).expect("converted").value;
        let d = &made.distribution;
        assert!((d.total_flux() / flux - 1.0).abs() < 1e-4, "{system:?}: {}", d.total_flux());
        assert!((d.peak().0 / peak - 1.0).abs() < 1e-8, "{system:?}: {:?}", d.peak());
        // It was symmetric about the vertical plane, and is.
        let expected = if system == System::TypeC { Symmetry::BilateralC90 } else { Symmetry::Quadrant };
        assert_eq!(d.symmetry(), expected);
        let back = turn(&made, &Turn::default(), System::TypeB, &Resampling::default()).expect("converted").value;
        assert!((back.distribution.total_flux() / flux - 1.0).abs() < 2e-4, "{system:?} and back");
    }
    let exact = Resampling { grid: None, keep_flux: true };
    let kept = turn(&flood, &Turn::default(), System::TypeC, &exact).expect("converted").value.distribution;
    assert!((kept.total_flux() / flux - 1.0).abs() < 1e-7 && (kept.peak().0 / peak - 1.0).abs() < 1e-4);
}

#[test]
fn flux_and_peak_survive_every_way_between_the_formats() {
    let Some(files) = real_files() else { return };
    let (mut worst, mut count) = ((0.0_f64, String::new()), 0);
    for (name, lamp, flux, peak) in &files {
        let read = |bytes: &[u8]| format::read(bytes, &Default::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        type Way = fn(&Luminaire) -> String;
        let to_ies: Way = |l| ies::write(l, ies::Version::Lm63_2019).expect("LM-63").value;
        let to_ldt: Way = |l| eulumdat::write(l).expect("EULUMDAT").value;
        let to_xml: Way = |l| tm33::write(l).expect("TM-33").value;
        let mut ways = vec![vec![to_ies, to_xml, to_ies]];
        if lamp.kind == Kind::Luminous {
            ways.extend([vec![to_ldt, to_ies, to_xml, to_ldt], vec![to_xml, to_ldt, to_xml], vec![to_ies, to_ldt]]);
            assert!((lamp.distribution.total_flux() / flux - 1.0).abs() < 1e-5, "{name}");
        }
        for way in ways {
            let mut now = lamp.clone();
            for write in way {
                now = read(write(&now).as_bytes()).value;
                let change = Change::between(&lamp.distribution, &now.distribution);
                let most = change.flux.abs().max(change.peak.abs());
                assert!(most <= 1e-4, "{name}: {change:?}");
                if most > worst.0 {
                    worst = (most, name.clone());
                }
            }
        }
        if lamp.kind == Kind::Luminous {
            assert!((lamp.distribution.peak().0 / peak - 1.0).abs() < 1e-5, "{name}");
            count += 1;
        }
    }
    eprintln!("{count} luminous files, worst change {:.1e} ({})", worst.0, worst.1);
    assert!(count > 50);
}

#[test]
fn transformed_luminaires_are_written_as_sound_eulumdat_files() {
    let Some(files) = real_files() else { return };
    // What is wrong with a table stays wrong.
    let inherent = ["L110", "L111", "L112", "L113", "L114", "L212", "L214", "L216", "L219"];
    for (name, lamp, ..) in files.iter().filter(|(_, lamp, ..)| lamp.kind == Kind::Luminous).step_by(3) {
        for by in [
            about_axis(90.0),
            about_axis(7.5),
            Turn { tilt_deg: 20.0, ..Turn::default() },
            Turn { tilt_deg: 35.0, tilt_towards_deg: 90.0, about_axis_deg: 45.0 },
        ] {
            let made = turn(lamp, &by, System::TypeC, &Resampling::default()).expect("turned").value;
            let text = eulumdat::write(&made).expect("written").value;
            let back = eulumdat::read(text.as_bytes()).unwrap_or_else(|e| panic!("{name} {by:?}: {e}"));
            let new: Vec<&Finding> = back.findings.iter().filter(|f| !inherent.contains(&f.code)).collect();
            assert!(new.is_empty(), "{name} {by:?}: {new:?}");
            let change = Change::between(&made.distribution, &back.value.distribution);
            assert!(change.flux.abs() < 1e-5 && change.peak.abs() < 1e-5, "{name} {by:?}: {change:?}");
        }
    }
}

#[test]
fn cubic_tables_are_turned_and_converted_too() {
    let cubic = beam(System::TypeB, 2.5, axis()).with_interpolation(Interpolation::MonotoneCubic);
    let given = lamp(cubic);
    // Interpolated smoothly, steps of 2.5° are enough to come within a thousandth of the closed form.
    assert!((given.distribution.total_flux() / FLUX - 1.0).abs() < 1e-3, "{}", given.distribution.total_flux());
    let made = turn(&given, &Turn::default(), System::TypeC, &Resampling::default()).expect("converted").value;
    assert_eq!(made.distribution.interpolation(), Interpolation::MonotoneCubic);
    let change = Change::between(&given.distribution, &made.distribution);
    assert!(change.flux.abs() <= 1e-4 && change.peak.abs() <= 1e-4, "{change:?}");
    assert!(made.distribution.values().iter().all(|v| *v >= 0.0));
}
