//! Coarse steps: the bound printed with the number covers the true error for smooth spectra.

use photopic::conversion::Settings;
use photopic::spectrum::Quantity;
use photopic::spectrum::integrate::{Contract, Rule};

use crate::{K_M, close, convert_with, luminous_integral, photopic, rule, sampled};

type Shape = (String, Box<dyn Fn(f64) -> f64>);

/// Shapes that 20 nm still resolve: no feature narrower than the step.
fn shapes() -> Vec<Shape> {
    let mut out: Vec<Shape> = Vec::new();
    for centre in [420.0, 490.0, 545.3, 555.0, 563.7, 620.0, 700.0] {
        for sigma in [25.0, 40.0, 80.0] {
            let f = move |w: f64| (-0.5 * ((w - centre) / sigma).powi(2)).exp();
            out.push((format!("Gaussian of {sigma} nm at {centre} nm"), Box::new(f)));
        }
    }
    for kelvin in [1500.0, 2856.0, 6500.0, 1e5] {
        let f = move |w: f64| (560.0 / w).powi(5) / (1.4388e7 / (w * kelvin)).exp_m1();
        out.push((format!("{kelvin} K"), Box::new(f)));
    }
    for period in [150.0, 300.0] {
        for phase in [0.0, 0.7, 2.1] {
            let f = move |w: f64| 1.0 + 0.8 * (w * std::f64::consts::TAU / period + phase).sin();
            out.push((format!("wave of {period} nm, phase {phase}"), Box::new(f)));
        }
    }
    let f = |w: f64| (w - 300.0) * (900.0 - w);
    out.push(("parabola".to_owned(), Box::new(f)));
    out
}

#[test]
fn the_quadrature_that_serves_as_the_truth_is_right() {
    // Σ V at 1 nm is 106.856 917 101 171 9 (the CIE's data set); straight lines between the entries take off half of the ends.
    close(luminous_integral(|_| 1.0), 106.856_917_101_171_9 - 0.5 * (0.000003917 + 0.00000045181), 1e-13, "∫V");
}

#[test]
fn the_bound_covers_the_true_error_at_every_step_and_rule() {
    let mut failures = Vec::new();
    for (name, f) in shapes() {
        let truth = K_M * luminous_integral(&f);
        for step in [1.0, 2.0, 5.0, 10.0, 20.0] {
            for used in [Rule::Summation, Rule::Trapezoid, Rule::Exact] {
                let spectrum = sampled(340.0, 860.0, step, &f);
                let c = convert_with(rule(used), Quantity::Irradiance, &spectrum).value;
                let bound = c.integration.error_bound;
                assert_eq!(bound.truncation_relative, Some(0.0));
                let (value, bound) = (photopic(&c), bound.step_relative.expect("light"));
                let error = (value - truth).abs() / value;
                // Beside rounding: sums of 500 terms.
                if error > bound + 1e-14 {
                    failures.push(format!(
                        "{name}, {step} nm, {used:?}: error {error:.3e} > bound {bound:.3e}, {:.3}",
                        error / bound
                    ));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} cases\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn the_bound_is_no_empty_promise() {
    // For a parabola the exact rule is off by h²/12·|S″| times ∫V to first order and the bound is h²/8·|S″|: half as much again.
    let f = |w: f64| 1.0 - ((w - 555.0) / 300.0).powi(2);
    let truth = K_M * luminous_integral(f);
    for step in [5.0, 10.0, 20.0] {
        let c = convert_with(rule(Rule::Exact), Quantity::Irradiance, &sampled(340.0, 860.0, step, f)).value;
        let (error, bound) =
            ((photopic(&c) / truth - 1.0).abs(), c.integration.error_bound.step_relative.expect("light"));
        assert!(error <= bound && bound < 2.0 * error, "{step} nm: {error} {bound}");
    }
}

#[test]
fn a_straight_line_has_no_error_under_the_exact_rule_at_any_step() {
    let f = |w: f64| 0.2 + (w - 340.0) / 520.0;
    let truth = K_M * luminous_integral(f);
    for step in [1.0, 5.0, 10.0, 20.0, 40.0, 260.0, 520.0] {
        let c = convert_with(rule(Rule::Exact), Quantity::Irradiance, &sampled(340.0, 860.0, step, f)).value;
        close(photopic(&c), truth, 1e-12, &format!("{step} nm"));
        assert!(
            c.integration.error_bound.step_relative.is_some_and(|b| b < 1e-11),
            "{step} nm: {:?}",
            c.integration.error_bound
        );
    }
}

#[test]
fn finer_steps_have_smaller_bounds() {
    let f = |w: f64| (-0.5 * ((w - 545.0) / 30.0_f64).powi(2)).exp();
    let bounds: Vec<f64> = [20.0, 10.0, 5.0, 2.0, 1.0]
        .iter()
        .map(|step| {
            let c = convert_with(rule(Rule::Exact), Quantity::Irradiance, &sampled(340.0, 860.0, *step, f)).value;
            c.integration.error_bound.step_relative.expect("light")
        })
        .collect();
    assert!(bounds.windows(2).all(|b| b[1] < b[0]), "{bounds:?}");
    // ⅛h²|S″|: quartered with half the step.
    close(bounds[1] / bounds[2], 4.0, 0.1, "10 nm over 5 nm");
}

#[test]
fn within_a_range_asked_for_the_bound_is_of_that_range() {
    let f = |w: f64| (-0.5 * ((w - 545.0) / 30.0_f64).powi(2)).exp();
    let inside = |w: f64| if (500.0..=600.0).contains(&w) { f(w) } else { 0.0 };
    let truth = K_M * luminous_integral(inside);
    for step in [1.0, 2.0, 5.0, 10.0, 20.0] {
        for used in [Rule::Trapezoid, Rule::Exact] {
            let settings = Settings {
                contract: Contract { rule: Some(used), range_nm: Some((500.0, 600.0)) },
                ..Settings::default()
            };
            let c = convert_with(settings, Quantity::Irradiance, &sampled(340.0, 860.0, step, f)).value;
            let (value, bound) = (photopic(&c), c.integration.error_bound.step_relative.expect("light"));
            let error = (value - truth).abs() / value;
            assert!(error <= bound + 1e-13, "{step} nm, {used:?}: {error:.3e} > {bound:.3e}");
        }
    }
}
