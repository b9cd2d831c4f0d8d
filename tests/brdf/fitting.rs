//! Fitting against closed forms and known truths.

use std::f64::consts::PI;

use glam::DVec3;
use nalgebra::{DMatrix, DVector};
use photopic::brdf::Brdf;
use photopic::brdf::coordinates::Parameterisation;
use photopic::brdf::description::template::Template;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::fit::{
    Error, Fit, Metric, Options, Samples, Scope, Selection, Uncertainty, Weighting, compare, fit,
};
use photopic::brdf::table::{Channel, HalfAngle, Points, Resolution, Table};
use photopic::geometry::direction::from_degrees;
use photopic::math::random::Stream;

fn template(text: &str) -> Template {
    text.parse().unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn material(text: &str, bands: usize) -> Box<dyn Brdf> {
    let material: Material = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
    material.prepare(Bands::Channels(bands)).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// Directions in and off the plane of incidence, on both sides, dense about the mirror direction.
fn directions() -> Vec<(DVec3, DVec3)> {
    let mut out = Vec::new();
    for ti in [5.0_f64, 20.0, 40.0, 60.0, 72.0] {
        for pi in [0.0, 50.0] {
            for to in [2.0, 15.0, 30.0, 45.0, 60.0, 75.0] {
                out.extend([0.0, 35.0, 90.0, 150.0, 180.0].map(|p| (from_degrees(ti, pi), from_degrees(to, pi + p))));
            }
            for (by, side) in [(0.5, 0.0), (1.5, 1.0), (4.0, -2.0), (-0.5, 0.5), (-2.0, 4.0), (-5.0, 0.0)] {
                out.push((from_degrees(ti, pi), from_degrees((ti + by).clamp(0.5, 85.0), pi + 180.0 + side)));
            }
        }
    }
    out
}

fn names(bands: usize) -> Vec<Channel> {
    (1..=bands).map(|b| Channel::Named(b.to_string())).collect()
}

/// A table of a material's values, each changed by `noise(number, value)`.
fn points(brdf: &dyn Brdf, mut noise: impl FnMut(usize, f64) -> f64) -> Table {
    let directions = directions();
    let n = brdf.bands();
    let mut values = vec![0.0; directions.len() * n];
    for ((i, o), v) in directions.iter().zip(values.chunks_exact_mut(n)) {
        brdf.evaluate(*i, *o, v);
    }
    values.iter_mut().enumerate().for_each(|(k, v)| *v = noise(k, *v));
    Table::Points(Points::new(Parameterisation::Spherical, names(n), directions, values).expect("a table"))
}

fn samples(table: &Table) -> Samples {
    Samples::new(table, &Selection::default()).expect("places")
}

fn fitted(text: &str, samples: &Samples, options: &Options) -> Fit {
    fit(&template(text), samples, options).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn values(fit: &Fit) -> Vec<f64> {
    fit.estimates.iter().map(|e| e.value).collect()
}

fn standard(fit: &Fit, i: usize) -> (f64, f64) {
    match fit.estimates[i].uncertainty {
        Uncertainty::Known { standard, robust } => (standard, robust),
        other => panic!("{i}: {other:?}"),
    }
}

/// A normal number from two uniform ones (Box and Muller).
fn normal(random: &mut Stream) -> f64 {
    let [u, v] = random.uniforms();
    (-2.0 * (1.0 - u).ln()).sqrt() * (2.0 * PI * v).cos()
}

#[test]
fn data_without_noise_give_the_parameters_back() {
    // The truth in the order of the open parameters, and what is fitted to it.
    for (truth, open, expected) in [
        ("lambert(reflectance=0.37)", "lambert", vec![0.37]),
        ("oren-nayar(reflectance=0.8, sigma_deg=23)", "oren-nayar", vec![0.8, 23.0]),
        ("oren-nayar(reflectance=0.6, sigma_deg=35, form=full)", "oren-nayar(form=full)", vec![0.6, 35.0]),
        ("phong(kd=0.3, ks=0.4, n=21)", "phong", vec![0.3, 0.4, 21.0]),
        ("phong(kd=0.1, ks=2, n=21, form=classic)", "phong(kd=?, form=classic)", vec![0.1, 2.0, 21.0]),
        ("blinn-phong(kd=0.2, ks=0.7, n=80)", "blinn-phong", vec![0.2, 0.7, 80.0]),
        ("ward(kd=0.2, ks=0.3, alpha=0.15)", "ward", vec![0.2, 0.3, 0.15]),
        ("ward(kd=0.2, ks=0.3, alpha=0.15, form=ward)", "ward(kd=?, form=ward)", vec![0.2, 0.3, 0.15]),
        ("ward(kd=0.2, ks=0.3, alpha=0.25, form=duer)", "ward(kd=?, form=duer)", vec![0.2, 0.3, 0.25]),
        ("ward(ks=0.3, alpha_x=0.1, alpha_y=0.3)", "ward(ks=?, alpha_x=?)", vec![0.3, 0.1, 0.3]),
        (
            "ashikhmin-shirley(rd=0.3, rs=0.06, nu=60, nv=200)",
            "ashikhmin-shirley(rd=?, nv=?)",
            vec![0.3, 200.0, 0.06, 60.0],
        ),
        ("ggx(alpha=0.12, f0=0.5)", "ggx", vec![0.12, 0.5]),
        ("ggx(alpha=0.3, eta=1.7)", "ggx(eta=?)", vec![1.7, 0.3]),
        ("ggx(alpha=0.3, eta=0.8, k=2.5)", "ggx(eta=0.8, k=?)", vec![2.5, 0.3]),
        ("ggx(alpha_x=0.1, alpha_y=0.4, f0=0.5)", "ggx(alpha_x=?)", vec![0.1, 0.4, 0.5]),
        ("beckmann(alpha=0.2, f0=0.04)", "beckmann", vec![0.2, 0.04]),
        ("blinn(n=60, f0=0.3)", "blinn", vec![60.0, 0.3]),
        ("abc(kd=0.1, a=20, b=400, c=1.2, eta=1.5)", "abc", vec![0.1, 20.0, 400.0, 1.2, 1.5]),
        ("lambert(reflectance=0.2) + 0.3*ward(ks=1, alpha=0.2)", "lambert + ?*ward(ks=1)", vec![0.2, 0.3, 0.2]),
        ("lambert(reflectance=0.3) + ggx(alpha=0.25, f0=0.05)", "lambert + ggx", vec![0.3, 0.25, 0.05]),
    ] {
        let samples = samples(&points(material(truth, 1).as_ref(), |_, v| v));
        let fit = fitted(open, &samples, &Options::default());
        for (got, expected) in values(&fit).iter().zip(&expected) {
            assert!((got - expected).abs() <= 1e-6 * expected, "{truth}: {:?} for {expected:?}", values(&fit));
        }
        assert_eq!(fit.estimates.len(), expected.len(), "{truth}");
        assert!(fit.converged && fit.measures.largest < 1e-6, "{truth}: {:?}", fit.measures);
    }
}

#[test]
fn eleven_parameters_are_found_from_a_start_nearby() {
    // κ only scales the lobe beside rho_s: it is given. The truth is near alum-bronze's red channel.
    let truth = "sgd(rho_d=0.05, rho_s=0.4, alpha=0.05, p=0.5, kappa=15, f0=0.5, f1=0.4, lambda=2.5, gamma=0.01, k=20, theta0=0.2)";
    let open = "sgd(rho_d=?0.1, rho_s=?0.5, alpha=?0.07, p=?0.6, kappa=15, f0=?0.4, f1=?0.3, lambda=2.5, gamma=0.01, k=20, theta0=0.2)";
    let samples = samples(&points(material(truth, 1).as_ref(), |_, v| v));
    let fit = fitted(open, &samples, &Options { starts: 1, ..Options::default() });
    for (got, expected) in values(&fit).iter().zip([0.05, 0.4, 0.05, 0.5, 0.5, 0.4]) {
        assert!((got - expected).abs() <= 1e-6 * expected, "{:?}", values(&fit));
    }
}

#[test]
fn a_linear_model_agrees_with_the_closed_form() {
    // f = w₁ g₁ + w₂ g₂ with weights, noise, and the covariances of linear regression.
    let mut random = Stream::new(3, 0);
    let truth = material("0.3*lambert(reflectance=1) + 0.2*ggx(alpha=0.3, reflectance=1)", 1);
    let table = points(truth.as_ref(), |_, v| v + 0.01 * normal(&mut random));
    let samples = samples(&table);
    let fit = fitted("?*lambert(reflectance=1) + ?*ggx(alpha=0.3, reflectance=1)", &samples, &Options::default());
    let basis = ["lambert(reflectance=1)", "ggx(alpha=0.3, reflectance=1)"].map(|t| material(t, 1));
    let mut rows: Vec<([f64; 2], f64)> = Vec::new();
    table.entries(&mut |e| {
        let mut row = [0.0; 2];
        for (g, b) in row.iter_mut().zip(&basis) {
            b.evaluate(e.incident, e.outgoing, std::slice::from_mut(g));
            *g *= e.incident.z;
        }
        rows.push((row, e.values[0] * e.incident.z));
    });
    let x = DMatrix::from_fn(rows.len(), 2, |r, c| rows[r].0[c]);
    let y = DVector::from_fn(rows.len(), |r, _| rows[r].1);
    let inverse = (x.transpose() * &x).try_inverse().expect("regular");
    let beta = &inverse * x.transpose() * &y;
    let residuals = &y - &x * &beta;
    let n = rows.len() as f64;
    let variance = residuals.norm_squared() / (n - 2.0);
    let meat = x.transpose() * DMatrix::from_diagonal(&residuals.map(|r| r * r)) * &x;
    let robust = &inverse * meat * &inverse * (n / (n - 2.0));
    for i in 0..2 {
        // Differences of models are good to about 1e-9.
        assert!((fit.estimates[i].value - beta[i]).abs() < 1e-9, "{:?} {beta}", values(&fit));
        let got = standard(&fit, i);
        for (got, expected) in [(got.0, variance * inverse[(i, i)]), (got.1, robust[(i, i)])] {
            assert!((got / expected.sqrt() - 1.0).abs() < 1e-7, "{got} {}", expected.sqrt());
        }
    }
    let correlation = inverse[(0, 1)] / (inverse[(0, 0)] * inverse[(1, 1)]).sqrt();
    assert!((fit.correlations[0][1].expect("known") - correlation).abs() < 1e-7, "{:?}", fit.correlations);
    // AIC = N ln(RSS/N) + 2K with the variance among the parameters.
    let criteria = fit.criteria.expect("noise");
    let aic = n * (residuals.norm_squared() / n).ln() + 2.0 * 3.0;
    assert!((criteria.aic - aic).abs() < 1e-6 && criteria.parameters == 3, "{criteria:?} {aic}");
    assert!((criteria.bic - (aic - 6.0 + 3.0 * n.ln())).abs() < 1e-6, "{criteria:?}");
    assert!((criteria.aicc.expect("many values") - (aic + 24.0 / (n - 4.0))).abs() < 1e-6, "{criteria:?}");
}

/// Of `draws` intervals of ±1.96 standard errors so many may hold the truth: 95 % of them, ± 4 binomial deviations.
fn binomial(draws: f64) -> (f64, f64) {
    let deviation = (draws * 0.95 * 0.05).sqrt();
    (0.95 * draws - 4.0 * deviation, 0.95 * draws + 4.0 * deviation)
}

#[test]
fn parameters_come_back_within_their_standard_errors() {
    let draws = 200;
    let truth = material("lambert(reflectance=0.3) + ggx(alpha=0.2, f0=0.08)", 1);
    let expected = [0.3, 0.2, 0.08];
    // Equal variances of the residuals c f (so of f they go as 1/c²), then variances that rise with the value: only the robust errors
    // are right there.
    for proportional in [false, true] {
        let mut inside = [0.0; 3];
        for draw in 0..draws {
            let (mut random, mut cosines) = (Stream::new(7, draw), Vec::new());
            points(truth.as_ref(), |_, v| v).entries(&mut |e| cosines.push(e.incident.z));
            let noise = |k: usize, v: f64| {
                let deviation = if proportional { 0.1 * v } else { 0.005 / cosines[k] };
                v + deviation * normal(&mut random)
            };
            let samples = samples(&points(truth.as_ref(), noise));
            let fit = fitted("lambert + ggx", &samples, &Options { starts: 2, ..Options::default() });
            for (i, expected) in expected.iter().enumerate() {
                let errors = standard(&fit, i);
                let error = if proportional { errors.1 } else { errors.0 };
                inside[i] += f64::from(u8::from((fit.estimates[i].value - expected).abs() <= 1.96 * error));
            }
        }
        let (low, high) = binomial(draws as f64);
        assert!(
            inside.iter().all(|n| (low..=high).contains(n)),
            "{proportional}: {inside:?} of {draws}, {low} to {high}"
        );
    }
}

#[test]
fn bands_have_their_own_values_or_share_them() {
    let truth = material("lambert(reflectance=[0.1, 0.3, 0.6]) + ggx(alpha=0.2, f0=0.05)", 3);
    let samples = samples(&points(truth.as_ref(), |_, v| v));
    let scope = Scope { shared: vec!["ggx.f0".into()], per_band: Vec::new() };
    let fit = fitted("lambert + ggx", &samples, &Options { scope, ..Options::default() });
    let expected = [0.1, 0.3, 0.6, 0.2, 0.05];
    assert!(values(&fit).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6 * b), "{:?}", values(&fit));
    let bands: Vec<Option<usize>> = fit.estimates.iter().map(|e| e.band).collect();
    assert_eq!(bands, [Some(0), Some(1), Some(2), None, None]);
    // All shared but one.
    let scope = Scope { shared: vec!["all".into()], per_band: vec!["1.reflectance".into()] };
    let fit = fitted("lambert + ggx", &samples, &Options { scope, ..Options::default() });
    assert_eq!(fit.estimates.len(), 5);
    let fit = fitted("lambert + ggx", &samples, &Options::default());
    assert_eq!(fit.estimates.len(), 7);
    assert!((fit.estimates[6].value - 0.05).abs() < 1e-7, "{:?}", values(&fit));
    // The material that comes out is the fit.
    let again: Material = fit.material.to_string().parse().expect("a description");
    assert_eq!(again.prepare(Bands::Channels(3)).expect("a material").bands(), 3);
}

#[test]
fn what_the_data_cannot_tell_is_said() {
    let mut random = Stream::new(11, 0);
    let samples =
        samples(&points(material("lambert(reflectance=0.5)", 1).as_ref(), |_, v| v + 1e-3 * normal(&mut random)));
    // Two diffuse parts: only their sum is known.
    let fit = fitted("lambert + ?*lambert(reflectance=0.5)", &samples, &Options::default());
    assert_eq!(fit.inseparable, [0, 1], "{:?} {}", fit.estimates, fit.condition);
    assert!(fit.estimates.iter().all(|e| e.uncertainty == Uncertainty::Inseparable));
    // A lobe that is not there rests at 0.
    let fit = fitted("lambert + ?*ggx(alpha=0.05, reflectance=1)", &samples, &Options::default());
    let weight = &fit.estimates[1];
    assert!(weight.value == 0.0 && weight.uncertainty == Uncertainty::AtLow || weight.value < 1e-4, "{weight:?}");
    // kd + ks = 1 holds.
    let bright = self::samples(&points(
        material("0.9*lambert(reflectance=1) + 0.8*ward(ks=1, alpha=0.3)", 1).as_ref(),
        |_, v| v,
    ));
    let fit = fitted("ward", &bright, &Options::default());
    let sum = fit.estimates[0].value + fit.estimates[1].value;
    assert!((sum - 1.0).abs() < 1e-12, "{:?}", fit.estimates);
}

#[test]
fn two_models_that_are_the_same_cannot_be_told_apart() {
    let mut random = Stream::new(13, 0);
    let truth = material("ggx(alpha=0.3, f0=0.5)", 1);
    let samples = samples(&points(truth.as_ref(), |_, v| v + 0.02 * normal(&mut random)));
    let fits: Vec<Fit> = ["beckmann", "ggx", "?*ggx(f0=1)", "lambert"]
        .iter()
        .map(|t| fitted(t, &samples, &Options::default()))
        .collect();
    let found = compare(&fits.iter().collect::<Vec<_>>()).expect("noise");
    assert_eq!(found.ranked[0].fit, 1, "{found:?}");
    assert_eq!(found.ranked[3].fit, 3, "{found:?}");
    let sum: f64 = found.ranked.iter().map(|r| r.weight).sum();
    assert!((sum - 1.0).abs() < 1e-12 && found.ranked[0].delta_aicc == 0.0);
    // The same model written in two ways.
    let twice: Vec<Fit> = ["ggx(f0=?)", "ggx"].iter().map(|t| fitted(t, &samples, &Options::default())).collect();
    let found = compare(&twice.iter().collect::<Vec<_>>()).expect("noise");
    assert_eq!(found.as_good.len(), 1, "{found:?}");
    assert!((found.ranked[1].weight - 0.5).abs() < 1e-6, "{found:?}");
}

#[test]
fn one_start_may_end_in_another_valley() {
    // A needle on a hill, and a model with one lobe: it may follow either.
    let truth = material("0.002*ggx(alpha=0.02, f0=1) + 0.5*ggx(alpha=0.5, f0=1)", 1);
    let samples = samples(&points(truth.as_ref(), |_, v| v));
    // The sum of squares over the width, with the best height for each width.
    let profile = |alpha: f64| {
        let model = material(&format!("ggx(alpha={alpha}, f0=1)"), 1);
        let (mut gg, mut gy, mut yy) = (0.0, 0.0, 0.0);
        for (i, o) in directions() {
            let (mut g, mut y) = ([0.0], [0.0]);
            model.evaluate(i, o, &mut g);
            truth.evaluate(i, o, &mut y);
            let (g, y) = (g[0] * i.z, y[0] * i.z);
            (gg, gy, yy) = (gg + g * g, gy + g * y, yy + y * y);
        }
        yy - gy * gy / gg
    };
    let sums: Vec<f64> = (0..=100).map(|i| profile(0.01 * 100_f64.powf(f64::from(i) / 100.0))).collect();
    let valleys = sums.windows(3).filter(|w| w[1] < w[0] && w[1] < w[2]).count();
    let least = sums.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(valleys >= 2, "{sums:?}");
    let of = |text: &str, starts| {
        let fit = fitted(text, &samples, &Options { starts, ..Options::default() });
        (fit.measures.cosine_rms.powi(2) * fit.values as f64, fit)
    };
    let (many, fit) = of("?*ggx(f0=1)", 12);
    assert!(
        many <= least * (1.0 + 1e-9) && fit.starts.0 == 12 && (1..12).contains(&fit.starts.1),
        "{many} {least} {:?}",
        fit.starts
    );
    let (worst, _) = [0.02, 0.6]
        .map(|alpha| of(&format!("?*ggx(alpha=?{alpha}, f0=1)"), 1))
        .into_iter()
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .expect("two");
    assert!(worst > 1.1 * many, "{worst} {many}");
}

#[test]
fn each_metric_is_least_where_it_was_minimised() {
    let truth = material("lambert(reflectance=0.2) + beckmann(alpha=0.3, f0=0.2)", 1);
    let samples = samples(&points(truth.as_ref(), |_, v| v));
    let of = |metric| fitted("lambert + ggx", &samples, &Options { metric, ..Options::default() });
    let fits = [Metric::Cosine, Metric::Log, Metric::Relative, Metric::Largest].map(of);
    let figures = |f: &Fit| [f.measures.cosine_rms, f.measures.log_rms, f.measures.relative_rms, f.measures.largest];
    for (i, best) in fits.iter().enumerate() {
        for other in &fits {
            assert!(
                figures(best)[i] <= figures(other)[i] * (1.0 + 1e-9),
                "{i}: {:?} {:?}",
                figures(best),
                figures(other)
            );
        }
    }
    assert!(fits[3].criteria.is_none() && fits[3].estimates.iter().all(|e| e.uncertainty == Uncertainty::Undefined));
}

#[test]
fn the_least_largest_difference_is_approached() {
    // A constant to values from 0 to 1: the mean of the least and the largest is the best there is, 1/2 off.
    let at: Vec<(DVec3, DVec3)> = (1..=9).map(|i| (DVec3::Z, from_degrees(f64::from(i) * 5.0, 0.0))).collect();
    let values = vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let table = Points::new(Parameterisation::Spherical, names(1), at, values).expect("a table");
    let samples = samples(&Table::Points(table));
    let fit = fitted("?*lambert(reflectance=1)", &samples, &Options { metric: Metric::Largest, ..Options::default() });
    // n^(1/64) at most, with n = 9: 1.035.
    assert!((0.5..0.5 * 9_f64.powf(1.0 / 64.0)).contains(&fit.measures.largest), "{:?}", fit.measures);
}

#[test]
fn half_angle_bins_are_integrated_by_their_solid_angles() {
    // ∫∫ dω_i dω_o over both hemispheres with both orders is (2π)²; one order and half a turn of φ_d of it are in the table.
    let resolution = Resolution { theta_h: 90, theta_d: 90, phi_d: 36 };
    let table = HalfAngle::new(resolution, names(1), vec![0.25; resolution.bins()]).expect("a table");
    let table = Table::HalfAngle(table);
    let (mut sum, mut cosines) = (0.0, 0.0);
    table.entries(&mut |e| {
        // Per bin in φ_d: 2π of φ_h, π/36 of φ_d and both orders.
        let share = e.measure * 2.0 * PI * (PI / 36.0) * 2.0;
        sum += share;
        cosines += share * e.incident.z * e.outgoing.z;
    });
    // ∫∫ cosθ_i cosθ_o = π². Bins cut by the horizon count whole or not at all: some per cent.
    assert!((sum / (4.0 * PI * PI) - 1.0).abs() < 0.02, "{sum}");
    assert!((cosines / (PI * PI) - 1.0).abs() < 5e-3, "{cosines}");
    // A constant is found whatever the weights.
    for weighting in [Weighting::SolidAngle, Weighting::Equal] {
        let selection = Selection { weighting, max_theta_deg: 80.0, bands: None };
        let samples = Samples::new(&table, &selection).expect("places");
        let fit = fitted("lambert", &samples, &Options::default());
        assert!((fit.estimates[0].value - 0.25 * PI).abs() < 1e-9, "{:?}", fit.estimates);
        assert!(samples.len() < samples.places());
    }
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let table = points(material("lambert(reflectance=[0.1, 0.2])", 2).as_ref(), |_, v| v);
    let samples = samples(&table);
    let options = Options::default();
    let error = |text: &str, options: &Options| fit(&template(text), &samples, options).expect_err(text).to_string();
    assert!(error("lambert(reflectance=0.5)", &options).starts_with("no parameter is open"));
    assert!(error("mirror", &options).contains("nothing but a Dirac lobe"));
    assert!(error("ggx(medium=Au)", &options).contains("needs wavelengths"));
    let scope = Scope { shared: vec!["rho".into()], per_band: Vec::new() };
    let expected = "no open parameter is called `rho`; expected one of lambert.reflectance, or `all`";
    assert_eq!(error("lambert", &Options { scope, ..Options::default() }), expected);
    let scope = Scope { shared: Vec::new(), per_band: vec!["alpha".into()] };
    assert!(error("ggx", &Options { scope, ..Options::default() }).starts_with("`alpha` is one number for all bands"));
    let beyond = Selection { bands: Some(vec![2]), ..Selection::default() };
    assert_eq!(Samples::new(&table, &beyond), Err(Error::Band { band: 3, bands: 2 }));
    let narrow = Selection { max_theta_deg: 1.0, ..Selection::default() };
    assert!(matches!(Samples::new(&table, &narrow), Err(Error::NoPlaces { .. })));
    let one =
        Points::new(Parameterisation::Spherical, names(1), vec![(DVec3::Z, DVec3::Z)], vec![0.1]).expect("a table");
    let few = self::samples(&Table::Points(one));
    let error = fit(&template("ggx"), &few, &options).expect_err("too few");
    assert_eq!(error, Error::TooFew { values: 1, parameters: 2 });
}
