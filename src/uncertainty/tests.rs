//! Closed forms, both propagations against each other, and how often the intervals hold the truth.

use super::*;
use crate::conversion::{Groups, Settings};
use crate::math::random::Stream;
use crate::spectrum::Grid;

const K_M: f64 = 683.002;

fn budget(text: &str) -> Budget {
    Budget::parse(text, |path| Err(format!("{path} is not here"))).expect("a budget")
}

fn converter(groups: Groups) -> Converter {
    Converter::new(Settings { groups, ..Settings::default() })
}

/// A white LED: a narrow blue and a broad yellow part, W/(m²·nm), by 5 nm.
fn led() -> Spectrum {
    let grid = Grid::uniform(380.0, 5.0, 81).expect("ascending");
    let values = grid
        .wavelengths_nm()
        .iter()
        .map(|w| 1e-3 * ((-((w - 450.0) / 12.0).powi(2)).exp() + 0.7 * (-((w - 570.0) / 75.0).powi(2)).exp()));
    let values = values.collect();
    Spectrum::density(grid, values).expect("finite")
}

/// A light of 17 800 K, its samples as λ⁻³ below the peak.
fn bluish(peak: f64) -> Spectrum {
    let grid = Grid::uniform(380.0, 5.0, 81).expect("ascending");
    let values = grid.wavelengths_nm().iter().map(|w| peak * (380.0 / w).powi(3)).collect();
    Spectrum::density(grid, values).expect("finite")
}

fn uncertainty(groups: Groups, text: &str, spectrum: &Spectrum) -> Uncertainty {
    evaluate(&converter(groups), &budget(text), Quantity::Irradiance, spectrum).expect("evaluates").value
}

fn stated(u: &Uncertainty, measurand: Measurand) -> Stated {
    u.figure(measurand).and_then(|f| f.stated).unwrap_or_else(|| panic!("{measurand} has an uncertainty"))
}

#[test]
fn a_factor_scales_amounts_and_leaves_ratios_alone() {
    let u = uncertainty(Groups::ALL, "scale = [{ relative = 0.02 }]\nmonte_carlo = { trials = 2000 }", &led());
    for f in u.figures.iter().filter(|f| f.value.is_finite()) {
        let s = f.stated.expect("defined");
        if f.measurand.is_linear() {
            assert!((s.standard / f.value - 0.02).abs() < 1e-10, "{}: {s:?} of {}", f.measurand, f.value);
            // 1.959964 · 2 %.
            assert!(((s.expanded_95[1] - f.value) / f.value - 0.039_199_279_690_801_08).abs() < 1e-10, "{s:?}");
        } else {
            // Rounding, and the convergence of CCT.
            assert!(s.standard < 1e-9 * f.value.abs().max(1.0), "{}: {s:?} of {}", f.measurand, f.value);
        }
    }
}

#[test]
fn independent_noise_has_its_closed_form() {
    // u(E)² = K_m² Δλ² Σ (V u)², with V from the embedded CIE table.
    let spectrum = led();
    let u = uncertainty(Groups::NONE, "noise = [{ relative = 0.05, absolute = 1e-5 }]", &spectrum);
    let v = crate::photometry::luminous::Efficiency::Cie1924.weighting();
    let square = |(w, s): (&f64, &f64)| v.at(*w).powi(2) * ((0.05 * s).powi(2) + 1e-10);
    let want = K_M * 5.0 * spectrum.wavelengths_nm().iter().zip(spectrum.values()).map(square).sum::<f64>().sqrt();
    assert!((stated(&u, Measurand::Photopic).standard / want - 1.0).abs() < 1e-8);
}

#[test]
fn distance_and_aperture_count_twice_and_a_tilted_spectrum_shifts() {
    let text =
        "distance = { distance_m = 2.0, standard_m = 0.004 }\naperture = { diameter_m = 0.05, standard_m = 5e-5 }";
    let u = uncertainty(Groups::NONE, text, &led());
    let f = u.figure(Measurand::Photopic).expect("lux");
    // 2·0.004/2 and 2·5e-5/0.05.
    for (c, want) in u.contributions.iter().zip([0.004, 0.002]) {
        let at = u.figures.iter().position(|f| f.measurand == Measurand::Photopic).expect("there");
        assert!((c.standard[at] / f.value - want).abs() < 1e-10, "{}", c.name);
    }
    assert_eq!(u.ranking(Measurand::Photopic)[0].0, "distance");
    // S = c λ: an offset of 1 nm changes the integral by c ∫V, a constant share of the ends' half slope aside, where V is below 4e-5.
    let grid = Grid::uniform(380.0, 1.0, 401).expect("ascending");
    let tilted =
        Spectrum::density(grid.clone(), grid.wavelengths_nm().iter().map(|w| 1e-6 * w).collect()).expect("finite");
    let flat = Spectrum::density(grid, vec![1e-6; 401]).expect("finite");
    let u = uncertainty(Groups::NONE, "wavelength = { offset_nm = 0.3 }", &tilted);
    let lux =
        converter(Groups::NONE).convert("", Quantity::Irradiance, &flat).expect("converts").value.absolute[0].photopic;
    assert!((stated(&u, Measurand::Photopic).standard / (0.3 * lux) - 1.0).abs() < 2e-6);
}

#[test]
fn a_calibration_goes_from_independent_to_together_with_its_correlation_length() {
    let photopic = |text: &str| stated(&uncertainty(Groups::NONE, text, &led()), Measurand::Photopic).standard;
    let together = photopic("calibration = [{ relative = 0.03 }]");
    let apart = photopic("noise = [{ relative = 0.03 }]");
    let chain =
        |length: f64| photopic(&format!("calibration = [{{ relative = 0.03, correlation_length_nm = {length} }}]"));
    assert!((chain(1e9) / together - 1.0).abs() < 1e-6 && (chain(1e-3) / apart - 1.0).abs() < 1e-9);
    let middle = chain(40.0);
    assert!(apart < middle && middle < together, "{apart} {middle} {together}");
    // The same covariance as a matrix, on the samples' own wavelengths.
    let spectrum = led();
    let x = spectrum.wavelengths_nm();
    let mut matrix = String::from("nm");
    x.iter().for_each(|w| matrix.push_str(&format!(",{w}")));
    for a in x {
        matrix.push_str(&format!("\n{a}"));
        x.iter().for_each(|b| matrix.push_str(&format!(",{}", 9e-4 * (-(a - b).abs() / 40.0).exp())));
    }
    let budget = Budget::parse("calibration = [{ covariance = \"c.csv\" }]\nmonte_carlo = { trials = 40000 }", |_| {
        Ok(matrix.clone())
    })
    .expect("a budget");
    let u = evaluate(&converter(Groups::NONE), &budget, Quantity::Irradiance, &spectrum).expect("evaluates").value;
    let f = u.figure(Measurand::Photopic).expect("lux");
    assert!((stated(&u, Measurand::Photopic).standard / middle - 1.0).abs() < 1e-8);
    // 1 % is 2.8 standard errors of the standard deviation of 40 000 trials.
    assert!((f.sampled.standard / middle - 1.0).abs() < 0.01, "{} {middle}", f.sampled.standard);
}

const EVERYTHING: &str = "\
noise = [{ relative = 0.01, of_peak = 0.002 }]
calibration = [{ relative = 0.01 }, { relative = 0.01, correlation_length_nm = 30 }]
wavelength = { offset_nm = 0.2, scale = 3e-4, distribution = \"rectangular\" }
bandwidth = { fwhm_nm = 5, standard_nm = 0.3 }
stray_light = { fraction = 1e-3 }
linearity = { relative = 0.005, distribution = \"triangular\" }
distance = { distance_m = 1, standard_m = 1e-3 }
scale = [{ relative = 0.005 }]
";

#[test]
fn both_propagations_agree_on_linear_figures() {
    // 1 % is 4.5 standard errors of a standard deviation from 100 000 trials.
    let groups = Groups { alpha_opic: true, photon: true, hazard: true, ..Groups::NONE };
    let u = uncertainty(groups, &format!("{EVERYTHING}monte_carlo = {{ trials = 100000, seed = 11 }}"), &led());
    for f in u.figures.iter().filter(|f| f.measurand.is_linear()) {
        let ratio = f.sampled.standard / f.analytic.expect("a derivative");
        assert!((ratio - 1.0).abs() < 0.01, "{}: {ratio}", f.measurand);
    }
    assert_eq!(u.trials, 100_000);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let text = format!("{EVERYTHING}monte_carlo = {{ trials = 500, seed = 5 }}");
        pool.install(|| uncertainty(Groups::ALL, &text, &led()))
    };
    let (one, three) = (run(1), run(3));
    let bits = |u: &Uncertainty| -> Vec<[u64; 4]> {
        let of = |f: &FigureUncertainty| {
            let s = &f.sampled;
            [s.mean, s.standard, s.expanded_95[0], s.expanded_95[1]].map(f64::to_bits)
        };
        u.figures.iter().map(of).collect()
    };
    assert_eq!(bits(&one), bits(&three));
    assert_eq!(one.covariance, three.covariance);
}

/// Of 1000 measurements of one lamp, each with errors of its own and an interval from its own values, about 950 hold the truth:
/// 950 ± 3.3 √(1000·.95·.05) = 927 … 973 with a probability of 0.999.
#[test]
fn intervals_of_95_per_cent_hold_the_truth_as_often() {
    let measurands = [
        Measurand::Photopic,
        Measurand::Radiometric,
        Measurand::Cct,
        Measurand::Duv,
        Measurand::Chromaticity(0),
        Measurand::DominantWavelength,
    ];
    covers(Groups { colour: true, ..Groups::NONE }, 1000, &led(), measurands);
}

/// The same of the indices of colour rendition, which are far from linear; of so many trials the ends of an interval lie a third of a per
/// cent of all nearer to its middle (order statistics), which the bounds allow for.
#[test]
fn intervals_of_colour_rendition_hold_the_truth_as_often() {
    let measurands = [Measurand::Ra, Measurand::Rf, Measurand::Rg];
    covers(Groups { cri: true, tm30: true, ..Groups::NONE }, 300, &led(), measurands);
}

/// The same near the end of the locus, where a colour temperature errs to one side.
#[test]
fn intervals_near_the_end_of_the_locus_hold_the_truth_as_often() {
    let measurands = [Measurand::Cct, Measurand::Duv, Measurand::DominantWavelength];
    covers(Groups { colour: true, ..Groups::NONE }, 1000, &bluish(1e-3), measurands);
}

fn covers<const N: usize>(groups: Groups, trials: u64, truth: &Spectrum, measurands: [Measurand; N]) {
    let text = format!(
        "\
noise = [{{ absolute = 2e-5 }}]
calibration = [{{ relative = 0.01, correlation_length_nm = 60 }}]
wavelength = {{ offset_nm = 0.2 }}
scale = [{{ relative = 0.01 }}]
monte_carlo = {{ trials = {trials} }}"
    );
    let converter = converter(groups);
    let budget = budget(&text);
    let model = Model::new(&budget, truth, &mut Vec::new()).expect("fits");
    let exact = Figures::new(&converter, Quantity::Irradiance, truth).expect("converts");
    let true_value = |m| exact.values[exact.list.iter().position(|l| *l == m).expect("listed")];
    let mut held = [0; N];
    for k in 0..1000 {
        let mut values = truth.values().to_vec();
        // Streams beyond those of the trials.
        model.trial(&mut Stream::new(77, 1 << 40 | k), &mut Vec::new(), &mut values);
        let measured = Spectrum::density(std::sync::Arc::clone(truth.grid()), values).expect("finite");
        let budget = Budget { monte_carlo: budget::MonteCarlo { seed: k, ..budget.monte_carlo }, ..budget.clone() };
        let u = evaluate(&converter, &budget, Quantity::Irradiance, &measured).expect("evaluates").value;
        for (held, m) in held.iter_mut().zip(measurands) {
            let [low, high] = stated(&u, m).expanded_95;
            *held += i32::from((low..=high).contains(&true_value(m)));
        }
    }
    for (held, m) in held.iter().zip(measurands) {
        // For the table in docs/uncertainty.md.
        println!("{m}: {held} of 1000");
        assert!((927..=973).contains(held), "{m}: {held} of 1000");
    }
}

#[test]
fn what_cannot_be_evaluated_is_refused() {
    let go = |text: &str, spectrum: &Spectrum| {
        evaluate(&converter(Groups::NONE), &budget(text), Quantity::Irradiance, spectrum).map(|_| ()).expect_err(text)
    };
    assert_eq!(go("", &led()), Error::Empty);
    let line = Spectrum::lines(Grid::new(vec![555.0]).expect("one"), vec![1.0]).expect("finite");
    assert_eq!(go("wavelength = { offset_nm = 0.1 }", &line), Error::NoSlope { samples: 1, lines: true });
    let dark = Spectrum::density(Grid::uniform(400.0, 10.0, 9).expect("nine"), vec![0.0; 9]).expect("finite");
    assert_eq!(go("scale = [{ relative = 0.1 }]", &dark), Error::Dark);
}

#[test]
fn a_strong_curvature_is_told_and_its_interval_is_lopsided() {
    // Of a bluish light it is 1/T that errs evenly, not T.
    let blue = bluish(1e6 * 380f64.powi(-3));
    let text = "calibration = [{ relative = 0.05, correlation_length_nm = 100 }]\nmonte_carlo = { trials = 10000 }";
    let groups = Groups { colour: true, ..Groups::NONE };
    let out = evaluate(&converter(groups), &budget(text), Quantity::Irradiance, &blue).expect("evaluates");
    let cct = out.value.figure(Measurand::Cct).expect("listed");
    let [low, high] = cct.sampled.expanded_95;
    assert!(high - cct.value > 1.3 * (cct.value - low), "{cct:?}");
    assert!(out.findings.iter().any(|f| f.code == "U001" && f.message.contains("CCT")), "{:?}", out.findings);
}
