//! Responses and merging: closed forms, and OpenCV's curves of the memorial stack.

use std::fs;

use photopic::capture::merge::{Merge, Range, Respond, State};
use photopic::capture::noise::Noise;
use photopic::capture::photo::Codes;
use photopic::capture::response::{Curve, Exposures, LEVELS, Sampling, check_order, debevec, monotone, robertson};
use photopic::capture::{Error, Photo};
use photopic::math::random::Stream;

use crate::common::shared;

/// A grey photograph of radiances from 10⁻³ to 1 under z = 255 (E t)^(1/γ), rounded and clipped.
fn photograph(time_s: f64, gamma: f64) -> Photo {
    let (width, height) = (64, 64);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to codes")]
    let code = |i: usize| {
        let radiance = 10.0_f64.powf(-3.0 * i as f64 / (width * height) as f64);
        (255.0 * (radiance * time_s).powf(1.0 / gamma)).clamp(0.0, 255.0).round() as u8
    };
    Photo { width, height, channels: 1, codes: Codes::Eight((0..width * height).map(code).collect()) }
}

fn stack(times_s: &[f64], gamma: f64) -> Exposures {
    let mut stack = Exposures::new("ramp");
    for t in times_s {
        stack.add(&format!("{t}"), *t, &photograph(*t, gamma), Sampling { pixels: 4096 }).expect("alike");
    }
    stack
}

#[test]
fn stacks_that_cannot_be_are_refused() {
    let good = stack(&[0.5, 2.0], 2.2);
    assert!(check_order(std::slice::from_ref(&good)).is_ok());
    let mut swapped = good.clone();
    swapped.codes.swap(0, 1);
    let error = check_order(std::slice::from_ref(&swapped)).unwrap_err();
    assert!(matches!(&error, Error::Order { longer, .. } if longer == "2"), "{error}");
    let mut one = Exposures::new("one");
    one.add("a", 1.0, &photograph(1.0, 1.0), Sampling { pixels: 9 }).expect("alike");
    assert!(matches!(monotone(&[one]), Err(Error::TooFew { count: 1, .. })));
    for (code, what) in [(0, "all are black"), (255, "all are white")] {
        let mut flat = good.clone();
        flat.codes.iter_mut().flatten().for_each(|z| *z = code);
        assert_eq!(monotone(&[flat]).unwrap_err(), Error::NothingShared { what });
    }
}

/// The memorial stack, on which OpenCV 5's Debevec decreases at 39, 15 and 5 steps (B, G, R) and its Robertson gives NaN.
#[test]
fn the_memorial_stack_gives_curves_that_rise() {
    let Some(folder) = shared("capture/exposures_memorial") else { return };
    let (mut fine, mut coarse) = (Exposures::new("memorial"), Exposures::new("memorial"));
    for n in 0..16 {
        let name = format!("memorial{:04}.png", 61 + n);
        let photo = Photo::decode(&fs::read(folder.join(&name)).expect("a photograph")).expect("a PNG");
        let time_s = 2.0_f64.powi(5 - n);
        fine.add(&name, time_s, &photo, Sampling { pixels: 4000 }).expect("alike");
        coarse.add(&name, time_s, &photo, Sampling { pixels: 70 }).expect("alike");
    }
    check_order(std::slice::from_ref(&fine)).expect("in order");
    for curve in monotone(std::slice::from_ref(&fine)).expect("a response") {
        assert!(curve.decreasing_steps() == 0 && curve.ln_g.iter().all(|g| g.is_finite()));
    }
    for curve in robertson(std::slice::from_ref(&fine), 30).expect("a response") {
        assert!(curve.ln_g.iter().all(|g| g.is_finite()));
    }
    // OpenCV solves the same equations by SVD in single precision: its solution is that of a matrix that is off by rounding, 2⁻²⁴ of its norm
    // times the larger of its sides (the customary factor: LAPACK Users' Guide, section 4.9). So the root of what its curve leaves above the
    // least sum is at most that times the norm of the solution, in each channel, also where single codes are poorly determined.
    let text = fs::read_to_string(folder.join("memorial_response_debevec_bgr.csv")).expect("OpenCV's curves");
    let ours = debevec(std::slice::from_ref(&coarse), 10.0).expect("a response");
    for (channel, curve) in ours.iter().enumerate() {
        let number = |line: &str| line.split(',').nth(2 - channel).and_then(|g| g.parse::<f64>().ok());
        let opencv: Vec<f64> = text.lines().map(|line| number(line).expect("three columns").ln()).collect();
        assert_eq!(opencv.len(), LEVELS);
        let (least, size) = sum_of_debevec(&coarse, channel, &curve.ln_g);
        let (theirs, _) = sum_of_debevec(&coarse, channel, &opencv);
        let rows = (coarse.pixels() * 16 + LEVELS) as f64;
        let bound = rows * 2.0_f64.powi(-24) * size;
        assert!(
            least <= theirs * (1.0 + 1e-12) && theirs - least <= bound * bound,
            "{channel}: {least} {theirs} {bound}"
        );
    }
}

/// The sum of squares that Debevec's method with λ = 10 and OpenCV's weights minimises, with the best radiances; and the norm of its matrix times
/// that of its solution.
fn sum_of_debevec(stack: &Exposures, channel: usize, ln_g: &[f64]) -> (f64, f64) {
    let hat = |z: usize| if z < 128 { z as f64 + 1.0 } else { 256.0 - z as f64 };
    let (mut sum, mut matrix, mut solution) = (ln_g[128].powi(2), 1.0, ln_g.iter().map(|g| g * g).sum::<f64>());
    for pixel in 0..stack.pixels() {
        let each = || {
            (0..16).map(|j| {
                let z = stack.code(j, pixel, channel);
                (hat(z).powi(2), ln_g[z] - stack.times_s[j].ln())
            })
        };
        let weights: f64 = each().map(|(w, _)| w).sum();
        let ln_e = each().map(|(w, e)| w * e).sum::<f64>() / weights;
        sum += each().map(|(w, e)| w * (e - ln_e).powi(2)).sum::<f64>();
        matrix += 2.0 * weights;
        solution += ln_e * ln_e;
    }
    for (z, g) in (1..).zip(ln_g.windows(3)) {
        let w = (10.0 * hat(z)).powi(2);
        sum += w * (g[0] - 2.0 * g[1] + g[2]).powi(2);
        matrix += 6.0 * w;
    }
    (sum, (matrix * solution).sqrt())
}

/// A camera: ln of the exposure at a code, over that of code 255; and the other way round.
#[derive(Debug, Clone, Copy)]
enum Response {
    /// A power law.
    Power(f64),
    /// IEC 61966-2-1, with so much of a smooth step mixed in.
    Srgb(f64),
    /// e^a/(e^a + h), which sets in and saturates softly.
    Film(f64, f64),
    /// 1 − exp(−k e^a): a shoulder.
    Shoulder(f64, f64),
}

impl Response {
    /// One out of its kind, by chance.
    fn draw(random: &mut Stream) -> Self {
        let (a, b) = (random.uniform(), random.uniform());
        match (4.0 * random.uniform()).floor() {
            0.0 => Self::Power(1.0 + 1.6 * a),
            1.0 => Self::Srgb(0.5 * a),
            2.0 => Self::Film(0.6 + 0.8 * a, 0.05 + 0.2 * b),
            _ => Self::Shoulder(1.0 / (1.0 + 1.4 * a), 0.1 + 3.0 * b),
        }
    }

    /// Code of an exposure from 0 to 1 that no noise has moved, 0 to 255; above 1 it goes on as it does there.
    fn code(self, e: f64) -> f64 {
        let at = |e: f64| match self {
            Self::Power(gamma) => e.powf(gamma.recip()),
            Self::Srgb(mixed) => {
                let c = if e <= 0.003_130_8 { 12.92 * e } else { 1.055 * e.powf(1.0 / 2.4) - 0.055 };
                c + mixed * (c * c * (3.0 - 2.0 * c) - c)
            }
            Self::Film(a, h) => (1.0 + h) * e.powf(a) / (e.powf(a) + h),
            Self::Shoulder(a, k) => (-k * e.powf(a)).exp_m1() / (-k).exp_m1(),
        };
        255.0 * if e > 1.0 { 1.0 + (e - 1.0) * (1.0 - at(0.999)) / 0.001 } else { at(e) }
    }

    /// ln g of a code, 0 at 128.
    fn ln_g(self, code: f64) -> f64 {
        let ln = |code: f64| {
            let (mut low, mut high) = (-60.0, 0.0);
            for _ in 0..60 {
                let middle: f64 = 0.5 * (low + high);
                *(if self.code(middle.exp()) < code { &mut low } else { &mut high }) = middle;
            }
            low
        };
        ln(code) - ln(128.0)
    }
}

/// Five exposures of `pixels` radiances over the range, under noise of `sigma` codes, rounded and clipped to `top`; of the samples, a share is
/// of something else that moved there.
fn photographed(response: Response, pixels: usize, sigma: f64, moved: f64, top: f64, random: &mut Stream) -> Exposures {
    // A sum of twelve uniform numbers: nearly normal, of variance 1.
    let normal = |random: &mut Stream| (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
    let radiances: Vec<f64> = (0..pixels).map(|_| (7.0 * random.uniform()).exp()).collect();
    let mut stack = Exposures::new("known");
    for time_s in [1.0 / 1024.0, 1.0 / 256.0, 1.0 / 64.0, 1.0 / 16.0, 0.25] {
        let code = |e: &f64| {
            let e = if random.uniform() < moved { e * (2.0 * normal(random)).exp() } else { *e };
            let z = response.code(e * time_s) + sigma * normal(random);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to codes")]
            let z = z.clamp(0.0, top).round() as u8;
            z
        };
        let codes = radiances.iter().map(code).collect();
        let photo = Photo { width: pixels, height: 1, channels: 1, codes: Codes::Eight(codes) };
        stack.add(&format!("{time_s}"), time_s, &photo, Sampling { pixels: usize::MAX >> 32 }).expect("alike");
    }
    stack
}

/// Code, deviation of a curve from the truth in standard errors, and standard error, at every 16th code up to `last`.
fn in_standard_errors(curve: &Curve, truth: Response, last: usize) -> Vec<(usize, f64, f64)> {
    let at = |z: usize| {
        let error = curve.standard_error(z as f64);
        (z, (curve.ln_g[z] - truth.ln_g(z as f64)) / error, error)
    };
    (16..=last).step_by(16).filter(|z| *z != 128).map(at).collect()
}

const KNOWN: [Response; 5] = [
    Response::Power(1.0),
    Response::Power(2.2),
    Response::Srgb(0.0),
    Response::Film(1.2, 0.1),
    Response::Shoulder(0.6, 2.0),
];

#[test]
fn a_known_response_comes_back() {
    let mut random = Stream::new(1997, 0);
    for truth in KNOWN {
        // Noise alone; rounding alone; with samples that moved, which the others outvote; and with a sensor that is full before code 255.
        for (sigma, moved, top) in [(1.0, 0.0, 255), (0.0, 0.0, 255), (1.0, 0.02, 255), (1.0, 0.0, 235)] {
            let stack = photographed(truth, 1000, sigma, moved, top as f64, &mut random);
            let curve = &monotone(std::slice::from_ref(&stack)).expect("a response")[0];
            assert_eq!(curve.decreasing_steps(), 0);
            for (z, deviation, error) in in_standard_errors(curve, truth, top - 11) {
                // Beyond four standard errors is one in 16 000.
                let told = format!("{truth:?} σ {sigma} moved {moved} top {top} code {z}: {deviation:.2} × {error:.5}");
                assert!(deviation.abs() < 4.0 && (z < 48 || error < 0.02), "{told}");
            }
        }
    }
}

#[test]
fn standard_errors_of_a_response_are_honest() {
    const STACKS: usize = 48;
    let (mut one, mut two, mut all) = (0, 0, 0);
    for n in 0..STACKS {
        let mut random = Stream::new(2026, n as u64);
        let truth = Response::draw(&mut random);
        let sigma = 2.0 * random.uniform();
        let stack = photographed(truth, 250, sigma, 0.0, 255.0, &mut random);
        let curve = &monotone(std::slice::from_ref(&stack)).expect("a response")[0];
        for (_, deviation, _) in in_standard_errors(curve, truth, 240) {
            one += usize::from(deviation.abs() <= 1.0);
            two += usize::from(deviation.abs() <= 2.0);
            all += 1;
        }
    }
    // Codes of one curve err together: there are at least as many independent cases as curves. Three standard deviations of their share.
    let bound = |p: f64| 3.0 * (p * (1.0 - p) / STACKS as f64).sqrt();
    let share = |count: usize| count as f64 / f64::from(all);
    assert!((share(one) - 0.683).abs() <= bound(0.683), "{}", share(one));
    assert!((share(two) - 0.954).abs() <= bound(0.954), "{}", share(two));
}

#[test]
fn merging_weighs_exposures_and_marks_what_is_out_of_range() {
    // Radiances 0.4, 4 and 0.001, of which code 255 is 1 at 1 s; at 1 s and 0.1 s, without rounding.
    let radiances = [0.4_f32, 4.0, 0.001];
    let photo = |time_s: f32| {
        let values = radiances.iter().map(|e| (e * time_s).min(1.0)).collect();
        Photo { width: 3, height: 1, channels: 1, codes: Codes::Linear(values) }
    };
    let mut merge = Merge::new(&photo(1.0), Range::default(), Noise::constant(1, 1.0));
    merge.add("long", 1.0, &photo(1.0), &Respond::Linear).expect("alike");
    merge.add("short", 0.1, &photo(0.1), &Respond::Linear).expect("alike");
    let samples = [0, 1, 2].map(|i| merge.sample(i));
    assert_eq!(samples.map(|s| s.state), [State::Valid, State::Valid, State::Dark]);
    assert!((samples[0].radiance - 0.4).abs() < 1e-6 && (samples[1].radiance - 4.0).abs() < 1e-5, "{samples:?}");
    // One code at 1 s is 1/255, at 0.1 s ten times that: weights 1 and 1/100.
    let expected = 1.0 / 255.0 / 1.01_f32.sqrt();
    assert!((samples[0].standard_error / expected - 1.0).abs() < 1e-4, "{samples:?}");
    assert!(samples[2].standard_error.is_infinite() && samples[2].radiance >= 0.001, "{samples:?}");
    assert_eq!(merge.counts(), [2, 0, 1, 0]);
    let grey = Curve::linear();
    let wrong = Photo { width: 2, ..photo(1.0) };
    let refused = merge.add("wrong", 1.0, &wrong, &Respond::Curves(vec![grey]));
    assert!(matches!(refused, Err(Error::Size { .. })), "{refused:?}");
}
