//! What every material must keep, by one harness: draws follow their density, weights are f |cosθ| / pdf, no more flux comes out than
//! goes in, the same path is as good both ways, and nothing is NaN or negative however extreme.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec3;

use super::compensated::Compensated;
use super::dielectric::Dielectric;
use super::fluorescent::Fluorescent;
use super::measured::Measured;
use super::mixture::Mixture;
use super::opaque::Opaque;
use super::rough_dielectric::RoughDielectric;
use super::textured::{Checkerboard, Textured};
use super::thin_slab::ThinSlab;
use super::{Material, Transport};
use crate::brdf::Brdf;
use crate::brdf::fresnel::Fresnel;
use crate::brdf::lambert::Lambert;
use crate::brdf::microfacet::{Distribution, Masking, Microfacet};
use crate::brdf::specular::Specular;
use crate::brdf::table::{Channel, HalfAngle, Resolution, SampledTable, Table};
use crate::geometry::direction::from_degrees;
use crate::math::random::Stream;
use crate::render::bands::Bands;

/// A material under test.
struct Case {
    name: &'static str,
    material: Arc<dyn Material>,
    /// n of the inside over n of the outside, of the first band.
    eta: f64,
    /// It absorbs nothing, to this accuracy.
    conserves: Option<f64>,
}

fn diffuse(reflectance: f64) -> Arc<dyn Material> {
    Arc::new(Opaque::new(Box::new(Lambert::new(vec![reflectance]).unwrap()), true))
}

fn metal(alpha: [f64; 2], fresnel: Fresnel) -> Arc<dyn Material> {
    let facets = Microfacet::new(Distribution::Ggx(alpha), Masking::Smith, fresnel).unwrap();
    Arc::new(Opaque::new(Box::new(Compensated::new(facets).unwrap()), true))
}

fn white() -> Fresnel {
    Fresnel::constant(vec![1.0]).unwrap()
}

fn ground(alpha: [f64; 2], outside: f64, inside: f64) -> Arc<dyn Material> {
    Arc::new(RoughDielectric::new(alpha, &[outside], &[inside]).unwrap())
}

fn dye() -> Arc<dyn Material> {
    Arc::new(Fluorescent::dye(&Bands::nodes(vec![500.0], 1.0), &[0.5], &[0.5], &[1.0], 1.0, true).unwrap())
}

/// A model in bins of half and difference angles.
fn bins(model: &dyn Brdf) -> Arc<dyn Material> {
    const RESOLUTION: Resolution = Resolution { theta_h: 30, theta_d: 30, phi_d: 36 };
    let value = |bin: usize| {
        let (i, o) = RESOLUTION.centre(bin).directions();
        let mut value = [f64::NAN];
        if i.z > 0.0 && o.z > 0.0 {
            model.evaluate(i, o, &mut value);
        }
        value[0] as f32
    };
    let values = (0..RESOLUTION.bins()).map(value).collect();
    let table = HalfAngle::new(RESOLUTION, vec![Channel::Wavelength(555.0)], values).unwrap();
    Arc::new(Measured::new(Arc::new(SampledTable::new(Table::from(table))), &[vec![1.0]], true).unwrap())
}

fn cases() -> Vec<Case> {
    let case = |name, material, eta, conserves| Case { name, material, eta, conserves };
    let half = |a: Arc<dyn Material>, b: Arc<dyn Material>| -> Arc<dyn Material> {
        Arc::new(Mixture::new(vec![(vec![0.5], a), (vec![0.5], b)]).unwrap())
    };
    let gold = Fresnel::conductor(&[0.2], &[3.0]).unwrap();
    let facets = Microfacet::new(Distribution::Ggx([0.3; 2]), Masking::Smith, gold).unwrap();
    let board = || Box::new(Checkerboard::new(vec![0.2], vec![0.9], [2, 2]).unwrap());
    vec![
        case("diffuse", diffuse(1.0), 1.0, Some(1e-12)),
        case("metal", metal([0.5; 2], Fresnel::conductor(&[0.2], &[3.0]).unwrap()), 1.0, None),
        case("white metal", metal([0.5; 2], white()), 1.0, Some(5e-4)),
        case("white metal, roughest", metal([1.0; 2], white()), 1.0, Some(5e-4)),
        case("white metal with a grain", metal([0.2, 0.7], white()), 1.0, Some(5e-4)),
        case("ground glass", ground([0.3; 2], 1.0, 1.5), 1.5, Some(5e-4)),
        case("ground glass, roughest", ground([1.0; 2], 1.0, 1.5), 1.5, Some(5e-4)),
        case("ground glass with a grain", ground([0.2, 0.6], 1.0, 1.8), 1.8, Some(5e-4)),
        case("ground bubble", ground([0.5; 2], 1.33, 1.0), 1.0 / 1.33, Some(5e-4)),
        case("half ground glass, half diffuse", half(ground([0.4; 2], 1.0, 1.5), diffuse(1.0)), 1.5, Some(5e-4)),
        case("textured", Arc::new(Textured::new(diffuse(1.0), board())), 1.0, Some(1e-12)),
        case("fluorescent", dye(), 1.0, Some(1e-12)),
        // Single precision.
        case("bins of a diffuser", bins(&Lambert::new(vec![1.0]).unwrap()), 1.0, Some(1e-7)),
        case("bins of a metal", bins(&facets), 1.0, None),
    ]
}

/// With Dirac lobes: no density to compare with.
fn dirac_cases() -> Vec<Case> {
    let case = |name, material, eta, conserves| Case { name, material, eta, conserves };
    let mirror: Arc<dyn Material> = Arc::new(Opaque::new(Box::new(Specular::new(white())), true));
    let mixed = Mixture::new(vec![(vec![0.3], Arc::clone(&mirror)), (vec![0.7], diffuse(1.0))]).unwrap();
    vec![
        case("mirror", mirror, 1.0, Some(1e-12)),
        case("half mirror, half diffuse", Arc::new(mixed), 1.0, Some(1e-12)),
        case("glass", Arc::new(Dielectric::new(&[1.0], &[1.5]).unwrap()), 1.5, Some(1e-12)),
        case("diamond in glass", Arc::new(Dielectric::new(&[1.5], &[2.4]).unwrap()), 1.6, Some(1e-12)),
        case("pane", Arc::new(ThinSlab::new(&[1.5], &[1.0]).unwrap()), 1.0, Some(1e-12)),
        case("grey pane", Arc::new(ThinSlab::new(&[1.5], &[0.6]).unwrap()), 1.0, None),
    ]
}

const OUTGOING_DEG: [[f64; 2]; 6] =
    [[0.0, 0.0], [35.0, 20.0], [75.0, 250.0], [88.0, 100.0], [130.0, 60.0], [100.0, 300.0]];

fn direction(numbers: &mut Stream) -> DVec3 {
    let [u, v] = numbers.uniforms();
    let z = 2.0 * u - 1.0;
    let (sin, cos) = (TAU * v).sin_cos();
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * cos, r * sin, z)
}

/// Pearson's χ² of draws in equal cells of the sphere against the density's integral over them, with one more cell for draws that
/// came to nothing. Limit: the normal quantile of 1e-6 in Wilson and Hilferty's approximation.
#[test]
fn draws_follow_their_density() {
    const ROWS: usize = 16;
    const COLUMNS: usize = 16;
    const FINE: usize = 96;
    const ACROSS: usize = 12;
    const DRAWS: usize = 60_000;
    for case in cases() {
        for [theta, phi] in OUTGOING_DEG {
            let outgoing = from_degrees(theta, phi);
            let mut numbers = Stream::new(3, 7);
            let mut counts = vec![0.0; ROWS * COLUMNS + 1];
            let mut weights = [0.0];
            for _ in 0..DRAWS {
                let drawn = case.material.sample(outgoing, numbers.uniforms(), Transport::Radiance, 0, &mut weights);
                let cell = drawn.map_or(ROWS * COLUMNS, |d| {
                    let row = ((0.5 + 0.5 * d.direction.z) * ROWS as f64) as usize;
                    let turn = d.direction.y.atan2(d.direction.x).rem_euclid(TAU) / TAU;
                    row.min(ROWS - 1) * COLUMNS + ((turn * COLUMNS as f64) as usize).min(COLUMNS - 1)
                });
                counts[cell] += 1.0;
            }
            let mut expected = vec![0.0; ROWS * COLUMNS + 1];
            // Rows are of equal height z, and within them the net is even in θ, so that lobes about the poles are resolved.
            let edge = |row: usize| (2.0 * row as f64 / ROWS as f64 - 1.0).acos();
            for row in 0..ROWS {
                let step = (edge(row) - edge(row + 1)) / FINE as f64;
                for fine in 0..FINE {
                    let (r, z) = (edge(row + 1) + step * (fine as f64 + 0.5)).sin_cos();
                    let cell = step * r * TAU / (COLUMNS * ACROSS) as f64 * DRAWS as f64;
                    for column in 0..COLUMNS * ACROSS {
                        let (sin, cos) = (TAU * (column as f64 + 0.5) / (COLUMNS * ACROSS) as f64).sin_cos();
                        let incident = DVec3::new(r * cos, r * sin, z);
                        expected[row * COLUMNS + column / ACROSS] += cell * case.material.pdf(outgoing, incident, 0);
                    }
                }
            }
            let whole: f64 = expected.iter().sum::<f64>() / DRAWS as f64;
            assert!(whole < 1.0 + 2e-3, "{} at {theta}: the density integrates to {whole}", case.name);
            expected[ROWS * COLUMNS] = (1.0 - whole).max(0.0) * DRAWS as f64;
            let (mut chi2, mut freedom, mut few) = (0.0, -1.0, [0.0; 2]);
            for (count, expected) in counts.iter().zip(&expected) {
                if *expected < 10.0 {
                    few = [few[0] + count, few[1] + expected];
                } else {
                    chi2 += (count - expected) * (count - expected) / expected;
                    freedom += 1.0;
                }
            }
            if few[1] > 5.0 {
                chi2 += (few[0] - few[1]) * (few[0] - few[1]) / few[1];
                freedom += 1.0;
            }
            let spread: f64 = 2.0 / (9.0 * freedom);
            let z = ((chi2 / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
            assert!(
                z < 4.75,
                "{} at {theta}: χ² {chi2} of {freedom}, z {z}, {:?}",
                case.name,
                (few, counts.last(), expected.last())
            );
        }
    }
}

/// A drawn weight is f |cosθ| / pdf of the direction it comes with.
#[test]
fn weights_belong_to_their_directions() {
    for case in cases() {
        let mut numbers = Stream::new(5, 1);
        for [theta, phi] in OUTGOING_DEG {
            let outgoing = from_degrees(theta, phi);
            for transport in [Transport::Radiance, Transport::Flux] {
                for _ in 0..500 {
                    let (mut weight, mut value) = ([0.0], [0.0]);
                    let Some(drawn) = case.material.sample(outgoing, numbers.uniforms(), transport, 0, &mut weight)
                    else {
                        continue;
                    };
                    let pdf = case.material.pdf(outgoing, drawn.direction, 0);
                    case.material.evaluate(drawn.direction, outgoing, transport, &mut value);
                    let expected = value[0] * drawn.direction.z.abs() / pdf;
                    assert!((pdf / drawn.pdf - 1.0).abs() < 1e-9, "{} {drawn:?} {pdf}", case.name);
                    assert!((weight[0] / expected - 1.0).abs() < 1e-9, "{} {drawn:?}", case.name);
                }
            }
        }
    }
}

/// f_s(ω_i → ω_o)/n_o² = f_s(ω_o → ω_i)/n_i² (Veach 1997, §5.2), and flux one way is radiance the other way.
#[test]
fn the_same_path_is_as_good_both_ways() {
    for case in cases() {
        let mut numbers = Stream::new(8, 2);
        let n2 = |d: DVec3| if d.z > 0.0 { 1.0 } else { case.eta * case.eta };
        for _ in 0..5000 {
            let (i, o) = (direction(&mut numbers), direction(&mut numbers));
            let value = |i, o, transport| {
                let mut v = [f64::NAN];
                case.material.evaluate(i, o, transport, &mut v);
                v[0]
            };
            let (there, back) = (value(i, o, Transport::Radiance), value(o, i, Transport::Radiance));
            let flux = value(o, i, Transport::Flux);
            assert!(there >= 0.0 && there.is_finite());
            assert!((there / n2(o) - back / n2(i)).abs() <= 1e-11 * there, "{} {i} {o}: {there} {back}", case.name);
            assert!((there - flux).abs() <= 1e-11 * there, "{} {i} {o}: {there} {flux}", case.name);
        }
    }
}

/// The mean weight of flux is the albedo: 1 where nothing is absorbed, within four standard errors and the table's accuracy, never
/// more.
#[test]
fn flux_is_conserved() {
    const DRAWS: u32 = 40_000;
    for case in cases().into_iter().chain(dirac_cases()) {
        for [theta, phi] in OUTGOING_DEG {
            let outgoing = from_degrees(theta, phi);
            let mut numbers = Stream::new(21, 4);
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..DRAWS {
                let mut weight = [0.0];
                let drawn = case.material.sample(outgoing, numbers.uniforms(), Transport::Flux, 0, &mut weight);
                let weight = if drawn.is_some() { weight[0] } else { 0.0 };
                sum += weight;
                squares += weight * weight;
            }
            let n = f64::from(DRAWS);
            let mean = sum / n;
            let error = ((squares / n - mean * mean).max(0.0) / n).sqrt();
            let allowed = 4.0 * error + case.conserves.unwrap_or(0.0);
            assert!(mean <= 1.0 + allowed, "{} at {theta}: {mean} ± {error}", case.name);
            assert!(error < 5e-3, "{} at {theta}: ± {error}", case.name);
            if case.conserves.is_some() {
                assert!(mean >= 1.0 - allowed - 1e-12, "{} at {theta}: {mean} ± {error}", case.name);
            }
        }
    }
}

/// Roughness from 1e-4 to 1, indices from 1 to 1000, grazing to 89.9999°: finite, not negative, and no weight that a path could not
/// carry.
#[test]
fn extremes_stay_finite() {
    let mut materials: Vec<(String, Arc<dyn Material>)> = Vec::new();
    for alpha in [[1e-4; 2], [1e-2; 2], [1.0; 2], [1e-3, 1.0]] {
        materials.push((format!("metal {alpha:?}"), metal(alpha, Fresnel::conductor(&[0.05], &[1e3]).unwrap())));
        for eta in [1.0001, 1.5, 1e3] {
            materials.push((format!("ground {alpha:?} {eta}"), ground(alpha, 1.0, eta)));
            materials.push((format!("ground bubble {alpha:?} {eta}"), ground(alpha, eta, 1.0)));
        }
    }
    for eta in [1.0, 1.0001, 1e3] {
        materials.push((format!("glass {eta}"), Arc::new(Dielectric::new(&[1.0], &[eta]).unwrap())));
        materials.push((format!("pane {eta}"), Arc::new(ThinSlab::new(&[eta], &[0.5]).unwrap())));
    }
    for (name, material) in materials {
        let mut numbers = Stream::new(77, 0);
        for theta in [0.0, 1e-5, 45.0, 89.0, 89.9999, 90.0, 90.0001, 135.0, 180.0] {
            let outgoing = from_degrees(theta, 33.0);
            for _ in 0..300 {
                let mut weight = [0.0];
                let sampled = material.sample(outgoing, numbers.uniforms(), Transport::Flux, 0, &mut weight);
                if let Some(drawn) = sampled {
                    assert!(weight[0] >= 0.0 && weight[0] < 100.0, "{name} at {theta}: {weight:?} {drawn:?}");
                    assert!(drawn.pdf > 0.0 && drawn.pdf.is_finite(), "{name} at {theta}: {drawn:?}");
                    assert!((drawn.direction.length() - 1.0).abs() < 1e-12, "{name} at {theta}: {drawn:?}");
                }
                let incident = direction(&mut numbers);
                let mut value = [f64::NAN];
                material.evaluate(incident, outgoing, Transport::Radiance, &mut value);
                assert!(value[0] >= 0.0 && value[0].is_finite(), "{name} at {theta}: {value:?}");
                let pdf = material.pdf(outgoing, incident, 0);
                assert!(pdf >= 0.0 && pdf.is_finite(), "{name} at {theta}: {pdf}");
            }
        }
    }
}

/// Ground glass that disperses: each hero's own draws bring the albedo of its band.
#[test]
fn dispersing_ground_glass_conserves_every_band() {
    let glass = RoughDielectric::new([0.4; 2], &[1.0; 3], &[1.5, 1.53, 1.6]).unwrap();
    assert!(glass.splits());
    for [theta, phi] in OUTGOING_DEG {
        for hero in 0..3 {
            let mut numbers = Stream::new(2, hero as u64);
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..20_000 {
                let mut weights = [0.0; 3];
                let drawn =
                    glass.sample(from_degrees(theta, phi), numbers.uniforms(), Transport::Flux, hero, &mut weights);
                if let Some(drawn) = drawn {
                    assert!(drawn.split && (0..3).all(|b| b == hero || weights[b] == 0.0));
                    sum += weights[hero];
                    squares += weights[hero] * weights[hero];
                }
            }
            let mean: f64 = sum / 20_000.0;
            let error = ((squares / 20_000.0 - mean * mean) / 20_000.0).sqrt();
            assert!((mean - 1.0).abs() < 4.0 * error + 5e-4, "{theta} {hero}: {mean} ± {error}");
        }
    }
}

#[test]
fn what_cannot_be_mixed_is_refused() {
    assert!(Mixture::new(vec![(vec![1.0], dye())]).is_err());
    assert!(Mixture::new(vec![]).is_err());
    assert!(Mixture::new(vec![(vec![0.6], diffuse(1.0)), (vec![0.5], diffuse(1.0))]).is_err());
    assert!(RoughDielectric::new([0.1; 2], &[1.5], &[1.5]).is_err());
    assert!(RoughDielectric::new([2.0; 2], &[1.0], &[1.5]).is_err());
}
