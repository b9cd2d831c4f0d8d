//! The optimiser and its standard errors against certified values: NIST's Statistical Reference Datasets, nonlinear regression
//! (certified to eleven digits in extended precision).

use nalgebra::{DMatrix, DVector};
use photopic::math::least_squares::{Limits, Linearised, Problem, invert, minimise};

/// A problem and its certified answer.
struct Dataset {
    /// Per parameter: two starts, value, standard deviation.
    parameters: Vec<[f64; 4]>,
    rss: f64,
    /// y, x.
    points: Vec<[f64; 2]>,
    /// The model and its derivatives.
    model: fn(&[f64], f64) -> (f64, Vec<f64>),
}

impl Dataset {
    fn read(text: &str, model: fn(&[f64], f64) -> (f64, Vec<f64>)) -> Self {
        let mut out = Self { parameters: Vec::new(), rss: 0.0, points: Vec::new(), model };
        for line in text.lines().filter(|l| !l.starts_with('#')) {
            let numbers: Vec<f64> = line.split(',').filter_map(|w| w.parse().ok()).collect();
            match numbers[..] {
                [a, b, c, d] => out.parameters.push([a, b, c, d]),
                [rss] => out.rss = rss,
                [y, x] => out.points.push([y, x]),
                _ => panic!("{line}"),
            }
        }
        out
    }
}

impl Problem for Dataset {
    fn cost(&self, b: &[f64]) -> Option<f64> {
        Some(self.points.iter().map(|[y, x]| ((self.model)(b, *x).0 - y).powi(2)).sum())
    }

    fn linearise(&self, b: &[f64]) -> Option<Linearised> {
        let n = b.len();
        let (mut cost, mut normal, mut gradient) = (0.0, DMatrix::zeros(n, n), DVector::zeros(n));
        for [y, x] in &self.points {
            let (f, row) = (self.model)(b, *x);
            let row = DVector::from_vec(row);
            cost += (f - y).powi(2);
            normal += &row * row.transpose();
            gradient += row * (f - y);
        }
        Some(Linearised { cost, normal, gradient })
    }
}

fn check(dataset: &Dataset, name: &str) {
    let n = dataset.parameters.len();
    let limits = Limits { iterations: 2000, step: 1e-13, gain: 1e-28 };
    for start in 0..2 {
        let from: Vec<f64> = dataset.parameters.iter().map(|p| p[start]).collect();
        let (low, high) = (vec![f64::NEG_INFINITY; n], vec![f64::INFINITY; n]);
        let found = minimise(dataset, &from, &low, &high, &limits).expect("a value");
        assert!(found.converged, "{name}, start {}: {} steps", start + 1, found.iterations);
        assert!(
            (found.at.cost - dataset.rss).abs() <= 0.5e-10 * dataset.rss,
            "{name}: {} {}",
            found.at.cost,
            dataset.rss
        );
        let free: Vec<usize> = (0..n).collect();
        let inverse = invert(&found.at.normal, &free);
        let variance = found.at.cost / (dataset.points.len() - n) as f64;
        // Eleven digits are certified; the sums are rounded, and the inverse enlarges that by the condition.
        let rounding = dataset.points.len() as f64 * f64::EPSILON / inverse.condition;
        for (i, [_, _, value, deviation]) in dataset.parameters.iter().enumerate() {
            let got = (variance * inverse.matrix[(i, i)]).sqrt();
            assert!(
                (found.x[i] - value).abs() <= 1e-10 * value.abs() + rounding * deviation,
                "{name}, start {}, b{}: {} for {value}",
                start + 1,
                i + 1,
                found.x[i]
            );
            assert!(
                (got - deviation).abs() <= (1e-10 + rounding) * deviation,
                "{name}, b{}: {got} for {deviation}",
                i + 1
            );
        }
    }
}

#[test]
fn misra1a() {
    let model = |b: &[f64], x: f64| {
        let e = (-b[1] * x).exp();
        (b[0] * (1.0 - e), vec![1.0 - e, b[0] * x * e])
    };
    check(&Dataset::read(include_str!("../data/strd/misra1a.csv"), model), "Misra1a");
}

#[test]
fn mgh09() {
    let model = |b: &[f64], x: f64| {
        let (over, under) = (x * x + x * b[1], x * x + x * b[2] + b[3]);
        let f = b[0] * over / under;
        (f, vec![over / under, b[0] * x / under, -f * x / under, -f / under])
    };
    check(&Dataset::read(include_str!("../data/strd/mgh09.csv"), model), "MGH09");
}

#[test]
fn thurber() {
    let model = |b: &[f64], x: f64| {
        let over = b[0] + x * (b[1] + x * (b[2] + x * b[3]));
        let under = 1.0 + x * (b[4] + x * (b[5] + x * b[6]));
        let f = over / under;
        let d = |power: i32, factor: f64| factor * x.powi(power) / under;
        (f, vec![d(0, 1.0), d(1, 1.0), d(2, 1.0), d(3, 1.0), d(1, -f), d(2, -f), d(3, -f)])
    };
    check(&Dataset::read(include_str!("../data/strd/thurber.csv"), model), "Thurber");
}
