//! Luminous flux of a distribution, twice: the exact integral of the interpolated intensity, and the trade's zonal rule.

use std::f64::consts::TAU;

use super::distribution::{Distribution, Interpolation, Symmetry, System, locate};
use crate::math::interpolate::hermite_cell;

/// Weights wⱼ with ∫ f(x) k(x) dx = Σ wⱼ f(xⱼ) for the piecewise-linear f through its samples (angles in degrees), where
/// `zero` and `first` give ∫ k and ∫ (x − a) k over an interval [a, b] in radians.
fn weights(angles_deg: &[f64], zero: impl Fn(f64, f64) -> f64, first: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let mut out = vec![0.0; angles_deg.len()];
    for i in 0..angles_deg.len().saturating_sub(1) {
        let (a, b) = (angles_deg[i].to_radians(), angles_deg[i + 1].to_radians());
        // f = f₀ + (f₁ − f₀)(x − a)/(b − a)
        let (m0, m1) = (zero(a, b), first(a, b) / (b - a));
        out[i] += m0 - m1;
        out[i + 1] += m1;
    }
    out
}

/// ∫ sin x dx from a to b, without cancellation.
fn sine_zone(a: f64, b: f64) -> f64 {
    2.0 * (0.5 * (a + b)).sin() * (0.5 * (b - a)).sin()
}

/// ∫ cos x dx from a to b, without cancellation.
fn cosine_zone(a: f64, b: f64) -> f64 {
    2.0 * (0.5 * (a + b)).cos() * (0.5 * (b - a)).sin()
}

/// sin d − d cos d = ∫₀ᵈ t sin t dt, without cancellation.
fn first_moment(d: f64) -> f64 {
    /// Below, its series: Σ (−1)^(k+1) 2k/(2k+1)! d^(2k+1), to rounding with seven terms.
    const SMALL: f64 = 0.5;
    if d.abs() > SMALL {
        return d.sin() - d * d.cos();
    }
    let q = d * d;
    let terms = [3.0, 30.0, 840.0, 45_360.0, 3_991_680.0, 518_918_400.0, 93_405_312_000.0];
    d * q * terms.iter().rev().fold(0.0, |sum, t| 1.0 / t - q * sum)
}

/// For k = sin γ. About the middle m of an interval of half-width d, ∫ (x − a) sin x = 2 d sin m sin d + 2 cos m (sin d − d cos d).
fn sine_weights(angles_deg: &[f64]) -> Vec<f64> {
    weights(angles_deg, sine_zone, |a, b| {
        let (m, d) = (0.5 * (a + b), 0.5 * (b - a));
        2.0 * (d * m.sin() * d.sin() + m.cos() * first_moment(d))
    })
}

/// For k = cos x: ∫ (x − a) cos x = 2 d cos m sin d − 2 sin m (sin d − d cos d).
fn cosine_weights(angles_deg: &[f64]) -> Vec<f64> {
    weights(angles_deg, cosine_zone, |a, b| {
        let (m, d) = (0.5 * (a + b), 0.5 * (b - a));
        2.0 * (d * m.cos() * d.sin() - m.sin() * first_moment(d))
    })
}

/// For k = 1: trapezoids.
fn even_weights(angles_deg: &[f64]) -> Vec<f64> {
    weights(angles_deg, |a, b| b - a, |a, b| 0.5 * (b - a) * (b - a))
}

/// Abscissae and weights of the eight-point Gauss–Legendre rule on [−1, 1], the positive half (Abramowitz & Stegun, 25.4.30):
/// exact to the fifteenth degree.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_29),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// Places in an interval and their weights, which add up to its width.
fn gauss(a: f64, b: f64) -> impl Iterator<Item = (f64, f64)> {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    GAUSS.into_iter().flat_map(move |(x, w)| [(middle - half * x, half * w), (middle + half * x, half * w)])
}

impl Distribution {
    /// How often the tabulated planes stand for the whole.
    pub(super) fn copies(&self) -> f64 {
        match (self.system(), self.symmetry()) {
            (System::TypeC, Symmetry::Quadrant) => 4.0,
            (System::TypeC, Symmetry::BilateralC0 | Symmetry::BilateralC90) | (_, Symmetry::Quadrant) => 2.0,
            _ => 1.0,
        }
    }

    /// Weights of the planes: their share of the full turn in radians, symmetric copies counted.
    fn plane_weights(&self) -> Vec<f64> {
        match (self.system(), self.symmetry()) {
            (_, Symmetry::Rotational) => vec![TAU],
            (System::TypeB, _) => cosine_weights(self.horizontal_deg()),
            _ => even_weights(self.horizontal_deg()),
        }
        .into_iter()
        .map(|w| w * self.copies())
        .collect()
    }

    /// ∫ I dω over all directions: lm for cd, W for W/sr.
    ///
    /// Exactly for the bilinear intensity. For the monotone cubic by Gauss–Legendre quadrature, eight points for each interval
    /// of either angle: exact but for the kinks along the vertical angle where a slope across the planes becomes 0, which on the
    /// real files tried change the flux by less than 2e-6 of it.
    #[must_use]
    pub fn total_flux(&self) -> f64 {
        if self.interpolation() == Interpolation::MonotoneCubic {
            return self.flux_along(self.vertical_deg(), |v| self.integral_across(v));
        }
        let across = self.plane_weights();
        let along = self.row_weights(self.vertical_deg());
        across.iter().enumerate().map(|(i, w)| w * dot(self.plane(i), &along)).sum()
    }

    /// The solid angle that each tabulated value stands for, sr, symmetric copies counted, in the order of
    /// [`Distribution::values`]: the sum of solid angle times value is [`Distribution::total_flux`] of the
    /// bilinear intensity.
    #[must_use]
    pub fn solid_angles_sr(&self) -> Vec<f64> {
        let along = self.row_weights(self.vertical_deg());
        self.plane_weights().iter().flat_map(|plane| along.iter().map(move |row| plane * row)).collect()
    }

    /// The flux by the zonal-constant rule of the trade's tools on the native intervals: per zone, the mean of the intensities at
    /// its two ends times the zone's solid angle (IES LM-79, zonal lumen summation). Types A and B use the same rule in
    /// their own zones.
    #[must_use]
    pub fn total_flux_zonal(&self) -> f64 {
        let solid = |zone: fn(f64, f64) -> f64, angles: &[f64]| {
            let mut out = vec![0.0; angles.len()];
            for i in 0..angles.len().saturating_sub(1) {
                let half = 0.5 * zone(angles[i].to_radians(), angles[i + 1].to_radians());
                out[i] += half;
                out[i + 1] += half;
            }
            out
        };
        let even: fn(f64, f64) -> f64 = |a, b| b - a;
        let (across, along) = match self.system() {
            System::TypeC => (self.plane_weights(), solid(sine_zone, self.vertical_deg())),
            System::TypeA => (self.plane_weights(), solid(cosine_zone, self.vertical_deg())),
            System::TypeB => {
                let copies = self.copies();
                let across = solid(cosine_zone, self.horizontal_deg()).into_iter().map(|w| w * copies).collect();
                (across, solid(even, self.vertical_deg()))
            }
        };
        across.iter().enumerate().map(|(i, w)| w * dot(self.plane(i), &along)).sum()
    }

    /// ∫ k f dv between the first and the last of some vertical angles, k dv being the vertical angle's part of the solid angle;
    /// f is linear between these angles where the table is bilinear.
    pub(super) fn flux_along(&self, vertical_deg: &[f64], f: impl Fn(f64) -> f64) -> f64 {
        if self.interpolation() == Interpolation::Bilinear {
            let values: Vec<f64> = vertical_deg.iter().map(|v| f(*v)).collect();
            return dot(&values, &self.row_weights(vertical_deg));
        }
        let kernel = |v: f64| match self.system() {
            System::TypeC => v.to_radians().sin(),
            System::TypeA => v.to_radians().cos(),
            System::TypeB => 1.0,
        };
        let nodes = vertical_deg.windows(2).flat_map(|w| gauss(w[0], w[1]));
        nodes.map(|(v, weight)| weight.to_radians() * kernel(v) * f(v)).sum()
    }

    /// Weights of values at some vertical angles, linear between them, in the integral over the vertical angle.
    fn row_weights(&self, vertical_deg: &[f64]) -> Vec<f64> {
        match self.system() {
            System::TypeC => sine_weights(vertical_deg),
            System::TypeA => cosine_weights(vertical_deg),
            System::TypeB => even_weights(vertical_deg),
        }
    }

    /// ∫ I k dh over all planes of a cubically interpolated table at one vertical angle, symmetric copies counted.
    fn integral_across(&self, vertical_deg: f64) -> f64 {
        let (row, t) = locate(self.vertical_deg(), vertical_deg);
        let h = self.horizontal_deg();
        let values: Vec<f64> = (0..h.len()).map(|plane| self.along(plane, row, t)).collect();
        if self.symmetry() == Symmetry::Rotational {
            return TAU * values[0];
        }
        let slopes: Vec<f64> = (0..h.len()).map(|plane| self.slope_across(plane, &|p| values[p])).collect();
        let cell = |i: usize| {
            let width = h[i + 1] - h[i];
            let at = |x: f64| {
                hermite_cell(width, (x - h[i]) / width, [values[i], values[i + 1]], [slopes[i], slopes[i + 1]])
            };
            let kernel = |x: f64| if self.system() == System::TypeB { x.to_radians().cos() } else { 1.0 };
            gauss(h[i], h[i + 1]).map(|(x, weight)| weight.to_radians() * kernel(x) * at(x)).sum::<f64>()
        };
        self.copies() * (0..h.len() - 1).map(cell).sum::<f64>()
    }

    /// Mean over all planes at one γ of a Type C table; 0 beyond the table.
    #[must_use]
    pub fn zonal_mean(&self, gamma_deg: f64) -> f64 {
        let (first, last) = (self.vertical_deg()[0], self.vertical_deg()[self.vertical_deg().len() - 1]);
        if gamma_deg < first || gamma_deg > last {
            return 0.0;
        }
        if self.interpolation() == Interpolation::MonotoneCubic {
            return self.integral_across(gamma_deg) / TAU;
        }
        let (row, t) = locate(self.vertical_deg(), gamma_deg);
        let means = self.zonal_means();
        means[row] + t * (means[(row + 1).min(means.len() - 1)] - means[row])
    }

    /// Mean over all planes at each vertical angle of a Type C table: what zonal figures are made of.
    #[must_use]
    pub fn zonal_means(&self) -> Vec<f64> {
        if self.interpolation() == Interpolation::MonotoneCubic {
            return self.vertical_deg().iter().map(|g| self.integral_across(*g) / TAU).collect();
        }
        let across = self.plane_weights();
        let total: f64 = across.iter().sum();
        (0..self.vertical_deg().len())
            .map(|row| across.iter().enumerate().map(|(i, w)| w * self.plane(i)[row]).sum::<f64>() / total)
            .collect()
    }

    /// The part of the table between two vertical angles: these, and its own between them; none where it has no part.
    pub(super) fn cuts(&self, from_deg: f64, to_deg: f64) -> Vec<f64> {
        let angles = self.vertical_deg();
        let (low, high) = (from_deg.max(angles[0]), to_deg.min(angles[angles.len() - 1]));
        if low >= high {
            return Vec::new();
        }
        let mut cuts = vec![low];
        cuts.extend(angles.iter().copied().filter(|a| *a > low && *a < high));
        cuts.push(high);
        cuts
    }

    /// Flux between two γ of a Type C table, as exactly as [`total_flux`](Self::total_flux).
    #[must_use]
    pub fn flux_between(&self, from_deg: f64, to_deg: f64) -> f64 {
        let cuts = self.cuts(from_deg, to_deg);
        if self.interpolation() == Interpolation::MonotoneCubic {
            return self.flux_along(&cuts, |g| self.integral_across(g));
        }
        let means = self.zonal_means();
        let angles = self.vertical_deg();
        let at = |g: f64| {
            let i = angles.partition_point(|&a| a <= g).saturating_sub(1).min(angles.len().saturating_sub(2));
            let t = if angles.len() > 1 { (g - angles[i]) / (angles[i + 1] - angles[i]) } else { 0.0 };
            means[i] + t * (means[(i + 1).min(means.len() - 1)] - means[i])
        };
        TAU * self.flux_along(&cuts, at)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn table(
        system: System,
        symmetry: Symmetry,
        horizontal: Vec<f64>,
        vertical: Vec<f64>,
        f: impl Fn(f64, f64) -> f64,
    ) -> Distribution {
        let values = horizontal.iter().flat_map(|h| vertical.iter().map(|v| f(*h, *v)).collect::<Vec<_>>()).collect();
        Distribution::new(system, symmetry, horizontal, vertical, values).expect("a sound table")
    }

    fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
        (0..=((to - from) / step).round() as usize).map(|i| from + step * i as f64).collect()
    }

    #[test]
    fn an_even_source_has_four_pi_in_every_system() {
        for (system, horizontal, vertical) in [
            (System::TypeC, steps(0.0, 360.0, 45.0), steps(0.0, 180.0, 15.0)),
            (System::TypeC, steps(0.0, 330.0, 30.0), steps(0.0, 180.0, 30.0)),
        ] {
            let d = table(system, Symmetry::None, horizontal, vertical, |_, _| 1.0);
            assert!((d.total_flux() - 4.0 * PI).abs() < 1e-13, "{}", d.total_flux());
            assert!((d.total_flux_zonal() - 4.0 * PI).abs() < 1e-13);
        }
        for system in [System::TypeA, System::TypeB] {
            // A and B tables of −90°–90° cover the half space before the lamp.
            let d = table(system, Symmetry::None, steps(-90.0, 90.0, 10.0), steps(-90.0, 90.0, 10.0), |_, _| 1.0);
            assert!((d.total_flux() - TAU).abs() < 1e-13, "{system:?}: {}", d.total_flux());
            let q = table(system, Symmetry::Quadrant, steps(0.0, 90.0, 10.0), steps(-90.0, 90.0, 10.0), |_, _| 1.0);
            assert!((q.total_flux() - TAU).abs() < 1e-13);
        }
    }

    #[test]
    fn a_linear_ramp_has_its_closed_form() {
        // I = γ on 0–90°: 2π ∫ γ sin γ dγ = 2π (sin γ − γ cos γ) = 2π at π/2, in units of rad; two rows suffice.
        let d = table(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 90.0], |_, v| v.to_radians());
        assert!((d.total_flux() - TAU).abs() < 1e-14);
        assert!((d.flux_between(0.0, 180.0) - TAU).abs() < 1e-14);
        // From 30° to 60°: sin − γ cos at both ends.
        let f = |g: f64| g.to_radians().sin() - g.to_radians() * g.to_radians().cos();
        assert!((d.flux_between(30.0, 60.0) - TAU * (f(60.0) - f(30.0))).abs() < 1e-14);
    }

    #[test]
    fn symmetric_and_unfolded_tables_agree() {
        let f = |h: f64, v: f64| 10.0 + v * h.to_radians().cos().powi(2) + (0.3 * v).sin();
        let vertical = steps(0.0, 90.0, 5.0);
        let whole = table(System::TypeC, Symmetry::None, steps(0.0, 360.0, 15.0), vertical.clone(), f);
        for (symmetry, planes) in [
            (Symmetry::Quadrant, steps(0.0, 90.0, 15.0)),
            (Symmetry::BilateralC0, steps(0.0, 180.0, 15.0)),
            (Symmetry::BilateralC90, steps(90.0, 270.0, 15.0)),
        ] {
            let folded = table(System::TypeC, symmetry, planes, vertical.clone(), f);
            assert!((folded.total_flux() / whole.total_flux() - 1.0).abs() < 1e-14, "{symmetry:?}");
            for c in [0.0, 37.0, 95.0, 181.0, 269.9, 300.0, 359.0] {
                assert!((folded.at(c, 42.0) - whole.at(c, 42.0)).abs() < 1e-9, "{symmetry:?} {c}");
            }
        }
    }

    #[test]
    fn directions_and_angles_are_inverse() {
        for system in [System::TypeA, System::TypeB, System::TypeC] {
            let (horizontal, vertical) = match system {
                System::TypeC => (steps(0.0, 360.0, 90.0), steps(0.0, 180.0, 90.0)),
                _ => (steps(-90.0, 90.0, 45.0), steps(-90.0, 90.0, 45.0)),
            };
            let d = table(system, Symmetry::None, horizontal, vertical, |_, _| 1.0);
            for h in [0.0, 10.0, 33.3, 80.0] {
                for v in [1.0, 25.0, 77.0] {
                    let (a, b) = d.angles(d.direction(h, v));
                    assert!((a - h).abs() < 1e-12 && (b - v).abs() < 1e-12, "{system:?} {h} {v}: {a} {b}");
                }
            }
        }
    }
}
