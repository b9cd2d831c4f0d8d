//! Corrections against closed forms.

use super::bandpass::LineSpread;
use super::lines::{Element, Line, of};
use super::*;
use crate::spectrum::Grid;

fn spectrum(x: &[f64], f: impl Fn(f64) -> f64) -> Spectrum {
    Spectrum::density(Grid::new(x.to_vec()).expect("ascending"), x.iter().map(|w| f(*w)).collect()).expect("finite")
}

fn even(first: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| first + step * i as f64).collect()
}

fn done(s: &Spectrum, u: Option<&[f64]>, plan: &Plan) -> Corrected {
    apply(s, u, plan).expect("corrects").value
}

#[test]
fn differences_undo_a_triangle_on_a_cubic_exactly_on_any_steps() {
    // M = S + w²/12 S″ exactly, where fourth derivatives vanish: w²/6 is the second moment of the triangle.
    let (w, at) = (7.0, |x: f64| x - 550.0);
    let truth = |x: f64| 3.0 + at(x) - 0.2 * at(x).powi(2) + 0.01 * at(x).powi(3);
    let second = |x: f64| -0.4 + 0.06 * at(x);
    let seen = |x: f64| truth(x) + w * w / 12.0 * second(x);
    let plan = Plan { bandpass: Some(Bandpass::stearns(w)), ..Plan::default() };
    for x in [even(500.0, 5.0, 21), even(500.0, 1.0, 101)] {
        let c = done(&spectrum(&x, seen), None, &plan);
        for (x, v) in x.iter().zip(c.spectrum.values()).skip(1).take(x.len() - 2) {
            assert!((v - truth(*x)).abs() < 1e-9, "{x}: {v}");
        }
        assert_eq!(c.standard, None);
    }
    // On unequal steps three samples tell a parabola.
    let x = [500.0, 503.0, 507.0, 512.0, 513.5, 520.0];
    let parabola = |x: f64| (x - 510.0).powi(2);
    // Every row removes w²/12 · 2 with its own scale of steps, which α = (w/h)²/12 cancels.
    let c = done(&spectrum(&x, |x| parabola(x) + w * w / 6.0), None, &plan);
    for (x, v) in x.iter().zip(c.spectrum.values()).skip(1).take(4) {
        assert!((v - parabola(*x)).abs() < 1e-10, "{x}: {v}");
    }
}

#[test]
fn the_printed_coefficient_and_the_ends_of_stearns_and_stearns() {
    // Colour 0.083, ends (1 + a) M₀ − a M₁: Stearns and Stearns 1988, as ASTM E2729 prints the weights −0.083, 1.166, −0.083.
    let s = spectrum(&even(400.0, 10.0, 4), |x| if x == 410.0 { 1.0 } else { 0.0 });
    let bandpass = Bandpass::Differences { fwhm_nm: 10.0, standard_nm: 0.0, coefficient: Some(0.083) };
    let c = done(&s, None, &Plan { bandpass: Some(bandpass), ..Plan::default() });
    for (got, want) in c.spectrum.values().iter().zip([-0.083, 1.166, -0.083, 0.0]) {
        assert!((got - want).abs() < 1e-15, "{got} {want}");
    }
}

#[test]
fn noise_grows_by_the_weights_and_a_width_errs_twice_as_much_as_what_it_takes_off() {
    let x = even(400.0, 5.0, 9);
    let u = [0.1; 9];
    let c = done(&spectrum(&x, |_| 1.0), Some(&u), &Plan { bandpass: Some(Bandpass::stearns(5.0)), ..Plan::default() });
    // √(2/144 + (7/6)²) inside.
    let want = 0.1 * (2.0f64 / 144.0 + 49.0 / 36.0).sqrt();
    assert!((c.standard.expect("known")[4] - want).abs() < 1e-15);
    // x² read with w = 5 ± 0.5 nm: 50/12 are taken off, and a tenth more or less of w is a fifth of that.
    let bandpass = Bandpass::Differences { fwhm_nm: 5.0, standard_nm: 0.5, coefficient: None };
    let c = done(&spectrum(&x, |w| (w - 420.0).powi(2)), None, &Plan { bandpass: Some(bandpass), ..Plan::default() });
    assert!((c.standard.expect("known")[4] - 0.2 * 50.0 / 12.0).abs() < 1e-12);
}

#[test]
fn iterations_narrow_a_gaussian_to_what_it_was() {
    // A Gaussian of σ seen through one of s is one of √(σ² + s²), of height σ/√(σ² + s²).
    let (sigma, s): (f64, f64) = (8.0, 4.0);
    let wide = sigma.hypot(s);
    let gauss = |x: f64, sigma: f64| (-0.5 * ((x - 550.0) / sigma).powi(2)).exp();
    let table: String =
        (-100..=100).map(|i| format!("{},{}\n", i as f64 * 0.2, (-0.5 * (i as f64 * 0.2 / s).powi(2)).exp())).collect();
    let spread = LineSpread::parse(&table).expect("a function");
    assert!((spread.fwhm_nm() - 2.354_820_045 * s).abs() < 1e-3);
    let x = even(480.0, 2.0, 71);
    let seen = spectrum(&x, |x| sigma / wide * gauss(x, wide));
    let bandpass = Bandpass::RichardsonLucy { spread, iterations: 400 };
    let c = done(&seen, None, &Plan { bandpass: Some(bandpass), ..Plan::default() });
    let Step::RichardsonLucy(d) = &c.steps[0] else { panic!("{:?}", c.steps) };
    assert_eq!((d.iterations, d.within_noise), (400, None));
    // 10.6 % of the height are missing before; less than 0.4 % of that, the moment of the fine grid, may be after.
    for (x, v) in x.iter().zip(c.spectrum.values()) {
        assert!((v - gauss(*x, sigma)).abs() < 0.004 * 0.106, "{x}: {v} {}", gauss(*x, sigma));
    }
}

#[test]
fn iterations_carry_a_scale_and_end_within_the_noise() {
    // What comes out goes with what goes in: an error of scale of 1 % stays one of 1 % in each sample (Euler).
    let x = even(500.0, 2.0, 41);
    let seen = spectrum(&x, |x| 1.0 + (-((x - 540.0) / 9.0).powi(2)).exp());
    let mut signal = Signal::new(&seen, None);
    signal.correlate().expect("few samples");
    signal.common(seen.values().iter().map(|v| 0.01 * v).collect());
    let bandpass = Bandpass::RichardsonLucy { spread: LineSpread::triangle(6.0), iterations: 25 };
    bandpass.correct(&mut signal, &mut Vec::new()).expect("corrects");
    let u = signal.standard().expect("known");
    for (v, u) in signal.values().iter().zip(u) {
        assert!((u / v - 0.01).abs() < 1e-12, "{v} {u}");
    }
    // So much noise that the first guess, the reading itself, explains the reading.
    let plan = Plan { bandpass: Some(bandpass), ..Plan::default() };
    let c = done(&seen, Some(&[1.0; 41]), &plan);
    let Step::RichardsonLucy(d) = &c.steps[0] else { panic!("{:?}", c.steps) };
    assert_eq!((d.iterations, d.within_noise), (0, Some(true)));
    let coarse = apply(&spectrum(&even(400.0, 5.0, 9), |_| 1.0), None, &plan);
    assert!(matches!(coarse, Err(Error::Bandpass(bandpass::Error::TooCoarse { .. }))));
}

#[test]
fn stray_light_put_in_is_taken_out() {
    let x = even(400.0, 10.0, 5);
    let truth = [1.0, 5.0, 0.0, 2.0, 0.5];
    let d = DMatrix::from_fn(5, 5, |i, j| if i == j { 0.0 } else { 1e-3 * (1 + i + 2 * j) as f64 });
    let seen = (DMatrix::identity(5, 5) + &d) * nalgebra::DVector::from_column_slice(&truth);
    let at = |x: f64| seen[((x - 400.0) / 10.0) as usize];
    let stray = StrayLight { wavelengths_nm: x.clone(), matrix: d, relative: 0.1 };
    let plan = Plan { stray_light: Some(stray), ..Plan::default() };
    let c = done(&spectrum(&x, at), None, &plan);
    for ((got, want), (seen, u)) in
        c.spectrum.values().iter().zip(truth).zip(seen.iter().zip(c.standard.as_ref().expect("known")))
    {
        assert!((got - want).abs() < 1e-14, "{got} {want}");
        assert!((u - 0.1 * (seen - want)).abs() < 1e-14, "a tenth of what was taken out");
    }
    let other = apply(&spectrum(&even(400.0, 10.0, 6), |_| 1.0), None, &plan);
    assert!(matches!(other, Err(Error::OtherGrid { found: 5, .. })));
}

#[test]
fn a_matrix_of_line_spreads_has_their_shoulders_per_light_in_the_line() {
    // A line of 10 at 420 nm with shoulders of 0.1 and 0.2, and one of 5 at 450 nm with 0.05 and 0.1: 1 % before, 2 % after a line.
    let text =
        "nm,420,450\n400,0.1,0.05\n410,0.1,0.05\n420,10,0.05\n430,0.2,0.05\n440,0.2,0.05\n450,0.2,5\n460,0.2,0.1\n";
    let s = StrayLight::parse_spreads(text, 5.0, 0.0).expect("a table");
    for i in 0..7 {
        for j in 0..7 {
            let want = if i == j {
                0.0
            } else if i < j {
                0.01
            } else {
                0.02
            };
            assert!((s.matrix[(i, j)] - want).abs() < 1e-15, "{i} {j}: {}", s.matrix[(i, j)]);
        }
    }
    let message = StrayLight::parse_spreads("nm,420\n400,1\n410,1\n", 5.0, 0.0).expect_err("no line in it").to_string();
    assert!(message.contains("within 5 nm of the line at 420 nm"), "{message}");
}

#[test]
fn dark_noise_adds_and_time_errs_in_common() {
    let x = even(400.0, 10.0, 3);
    let plan = Plan {
        dark: Some(Dark { spectrum: spectrum(&x, |_| 100.0), standard: Some(vec![4.0; 3]), time_s: Some(0.5) }),
        integration_time: Some(IntegrationTime { time_s: 0.5, standard_s: 0.005 }),
        ..Plan::default()
    };
    let c = done(&spectrum(&x, |_| 1100.0), Some(&[3.0; 3]), &plan);
    assert_eq!(c.spectrum.values(), [2000.0; 3]);
    // √(3² + 4²)/0.5 = 10 of noise, 1 % of 2000 in common.
    let covariance = c.covariance().expect("known");
    assert!((covariance[(0, 0)] - 500.0).abs() < 1e-9 && (covariance[(0, 1)] - 400.0).abs() < 1e-9, "{covariance}");
    // Of the sum: 3 · 100 + 9 · 400 over 3 · 500.
    assert!((c.correlation_factor() - (3900f64 / 1500.0).sqrt()).abs() < 1e-12);
    // Noise of counts: √(10² + 2 · 1000).
    let noise = Noise { read: 10.0, per_unit: 2.0, relative: 0.0 };
    assert!((noise.standard(&[1000.0])[0] - 2100f64.sqrt()).abs() < 1e-12);
}

#[test]
fn smoothing_has_the_published_weights_and_halves_the_noise() {
    // Savitzky and Golay 1964, Table I: five points of a parabola, (−3, 12, 17, 12, −3)/35.
    let x = even(400.0, 1.0, 11);
    let plan = Plan { smoothing: Some(Smoothing { window: 5, degree: 2 }), ..Plan::default() };
    let c = done(&spectrum(&x, |w| f64::from(u8::from(w == 405.0))), Some(&[1.0; 11]), &plan);
    for (got, want) in c.spectrum.values()[3..8].iter().zip([-3.0, 12.0, 17.0, 12.0, -3.0]) {
        assert!((got - want / 35.0).abs() < 1e-14, "{got} {want}");
    }
    // Of independent noise √(17/35) is left in the middle; its sum is kept, which neighbours err in together.
    assert!((c.standard.as_ref().expect("known")[5] - (17f64 / 35.0).sqrt()).abs() < 1e-14);
    // Parabolas stay, ends and unequal steps included.
    let uneven = [400.0, 401.0, 403.0, 404.0, 408.0, 410.0];
    let parabola = |w: f64| (w - 403.0).powi(2);
    for (w, v) in uneven.iter().zip(done(&spectrum(&uneven, parabola), None, &plan).spectrum.values()) {
        assert!((v - parabola(*w)).abs() < 1e-11, "{w}: {v}");
    }
    for (window, degree) in [(4, 2), (3, 3), (13, 2)] {
        let plan = Plan { smoothing: Some(Smoothing { window, degree }), ..Plan::default() };
        assert!(matches!(apply(&spectrum(&x, |_| 1.0), None, &plan), Err(Error::Window { .. })));
    }
}

#[test]
fn half_way_between_two_samples_the_noise_is_less_and_shared() {
    let x = even(400.0, 2.0, 4);
    let resampling = Resampling { step_nm: 1.0, range_nm: None, interpolation: Interpolation::Linear };
    let c = done(&spectrum(&x, |w| w), Some(&[1.0; 4]), &Plan { resampling: Some(resampling), ..Plan::default() });
    assert_eq!(c.spectrum.wavelengths_nm(), even(400.0, 1.0, 7));
    let covariance = c.covariance().expect("known");
    assert!((covariance[(1, 1)] - 0.5).abs() < 1e-15 && (covariance[(0, 1)] - 0.5).abs() < 1e-15);
    // Multiples of the step lie inside, although rounding puts the first a hair outside.
    let x: Vec<f64> = (0..41).map(|i| 0.1 * f64::from(3800 + i)).collect();
    let c = done(&spectrum(&x, |w| w), None, &Plan { resampling: Some(resampling), ..Plan::default() });
    assert_eq!(c.spectrum.grid().range_nm(), (380.0, 384.0));
}

/// A lamp whose lines are Gaussians where `place` puts them.
fn lamp(lines: &[f64], place: impl Fn(f64) -> f64, axis: &[f64]) -> Spectrum {
    let sigma = 1.2;
    spectrum(axis, |a| lines.iter().map(|l| (-0.5 * ((a - place(*l)) / sigma).powi(2)).exp()).sum::<f64>() + 1e-12)
}

#[test]
fn an_axis_bent_by_a_parabola_is_found_from_mercury_and_argon() {
    let lines = of(&[Element::Hg, Element::Ar]);
    assert!(lines.windows(2).all(|w| w[0].wavelength_nm < w[1].wavelength_nm));
    let axis = even(350.0, 0.5, 1000);
    // The axis a shows λ = a + 0.8 + 1e-6 (a − 600)²; solved for a by two steps of Newton's method.
    let wavelength = |a: f64| a + 0.8 + 1e-6 * (a - 600.0).powi(2);
    let place = |l: f64| (0..4).fold(l, |a, _| a - (wavelength(a) - l) / (1.0 + 2e-6 * (a - 600.0)));
    let all: Vec<f64> = lines.iter().map(|l| l.wavelength_nm).collect();
    let reading = lamp(&all, place, &axis);
    let lamp =
        LineLamp { reading: reading.clone(), lines, degree: 2, search_nm: 2.0, threshold: 0.05, start: Vec::new() };
    let found = wavelength::calibrate(&lamp).expect("fits").value;
    // Neighbours of Gaussians of σ 1.2 nm pull a peak by less than 0.01 nm from 4 nm on; nearer ones are not used.
    // Of mercury 365, 436 and 546 nm, of argon all but the pairs about 750, 772, 801, 811 and 841 nm stand alone.
    assert_eq!(found.matches.len(), 3 + 8, "{found:?}");
    assert!(found.unused.iter().any(|l| l.wavelength_nm == 772.3761), "0.04 nm from its neighbour");
    for a in [400.0, 550.0, 800.0] {
        let off = (found.wavelength_nm(a) - wavelength(a)).abs();
        assert!(off < 0.01 && off < 5.0 * found.standard_nm(a).max(1e-4), "{a}: {off} ± {}", found.standard_nm(a));
    }
    assert!(found.matches.iter().all(|m| (m.fwhm - 2.355 * 1.2).abs() < 0.4), "widths of the lines");
    // The corrected spectrum has the fitted wavelengths, and their errors times its slope.
    let slope = spectrum(&axis, |a| 0.01 * a);
    let c = done(&slope, None, &Plan { wavelength: Some(lamp), ..Plan::default() });
    let (i, u) = (500, c.standard.as_ref().expect("known")[500]);
    assert_eq!(c.spectrum.wavelengths_nm()[i], found.wavelength_nm(axis[i]));
    assert!((u - 0.01 * found.standard_nm(axis[i])).abs() < 1e-3 * u, "{u}");
}

#[test]
fn three_lines_off_a_straight_axis_give_the_errors_of_the_text_books() {
    // Peaks 100 apart; the known lines are off by δ, −2δ, δ, of which no straight line takes anything away.
    let delta = 0.03;
    let axis = even(350.0, 0.5, 700);
    let peaks = [400.0, 500.0, 600.0];
    let known = [400.0 - delta, 500.0 + 2.0 * delta, 600.0 - delta];
    let lines: Vec<Line> = known.iter().map(|w| Line { element: None, wavelength_nm: *w }).collect();
    let reading = lamp(&peaks, |l| l, &axis);
    let lamp = LineLamp { reading, lines, degree: 1, search_nm: 1.0, threshold: 0.1, start: Vec::new() };
    let c = wavelength::calibrate(&lamp).expect("fits").value;
    // s² = 6δ²/(3 − 2); u(slope) = s/√Σ(x − x̄)², u at the middle = s/√3.
    let s = 6f64.sqrt() * delta;
    assert!((c.residual_nm - s).abs() < 1e-6, "{}", c.residual_nm);
    assert!((c.standard_errors[1] - s / 2e4f64.sqrt()).abs() < 1e-8);
    assert!((c.standard_nm(500.0) - s / 3f64.sqrt()).abs() < 1e-6);
    assert!((c.coefficients[1] - 1.0).abs() < 1e-8 && c.coefficients[0].abs() < 1e-5, "{:?}", c.coefficients);
    let few = LineLamp { degree: 2, ..lamp };
    assert!(matches!(wavelength::calibrate(&few), Err(wavelength::Error::TooFew { matched: 3, needed: 4, .. })));
}

#[test]
fn a_dark_red_end_below_a_blue_lamp_is_told() {
    let x = even(380.0, 5.0, 145);
    let blue = |w: f64| (-((w - 450.0) / 20.0).powi(2)).exp() + 1e-4;
    let smoothing = Some(Smoothing { window: 3, degree: 1 });
    let codes = |order: SecondOrder| -> Vec<&str> {
        let plan = Plan { smoothing, second_order: order, ..Plan::default() };
        let found = apply(&spectrum(&x, blue), None, &plan).expect("corrects").findings;
        found.iter().map(|f| f.code).collect()
    };
    assert_eq!(codes(SecondOrder::default()), ["X005"]);
    assert_eq!(codes(SecondOrder { filter_from_nm: Some(700.0) }), [""; 0]);
}

#[test]
fn lines_and_no_correction_are_refused() {
    let s = spectrum(&even(400.0, 5.0, 9), |_| 1.0);
    assert!(matches!(apply(&s, None, &Plan::default()), Err(Error::Nothing)));
    let lines = Spectrum::lines(Grid::new(vec![435.8, 546.1]).expect("ascending"), vec![1.0, 2.0]).expect("finite");
    assert!(matches!(apply(&lines, None, &Plan::default()), Err(Error::Lines)));
}

#[test]
fn descriptions_tell_their_mistakes_with_the_place() {
    use super::description::{Description, schema};
    let text = "[bandpass]\nfwhm_nm = 5\n[wavelength]\nlamp = \"hg.csv\"\nelements = [\"Hg\"]\n";
    let read = Description::parse(text).expect("a description");
    assert_eq!(read.wavelength.map(|w| (w.degree, w.search_nm.0)), Some((3, 2.0)));
    let message = |from: &str, to: &str| Description::parse(&text.replacen(from, to, 1)).expect_err(to).to_string();
    assert!(message("fwhm_nm", "fwhm").starts_with("2:1: unknown field `fwhm`"));
    assert!(message("= 5", "= -5").starts_with("2:11: found `-5`; expected a positive number"));
    assert!(message("fwhm_nm = 5\n", "").starts_with("1:1: expected either fwhm_nm or line_spread"));
    assert!(message("elements = [\"Hg\"]", "").starts_with("3:1: found no lines"));
    assert!(message("\"Hg\"", "\"Xx\"").starts_with("5:13: unknown variant `Xx`"));
    assert!(schema().to_string().contains("line_spreads"));
}
