//! Luminous flux of a distribution, twice: the exact integral of the interpolated intensity, and the trade's zonal rule.

use std::f64::consts::{PI, TAU};

use super::distribution::{Distribution, Symmetry, System};

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

/// For k = sin γ.
fn sine_weights(angles_deg: &[f64]) -> Vec<f64> {
    // cos a − cos b without cancellation; ∫ (x − a) sin x = sin b − sin a − (b − a) cos b.
    weights(
        angles_deg,
        |a, b| 2.0 * (0.5 * (a + b)).sin() * (0.5 * (b - a)).sin(),
        |a, b| b.sin() - a.sin() - (b - a) * b.cos(),
    )
}

/// For k = cos x.
fn cosine_weights(angles_deg: &[f64]) -> Vec<f64> {
    // ∫ (x − a) cos x = cos b − cos a + (b − a) sin b.
    weights(
        angles_deg,
        |a, b| 2.0 * (0.5 * (a + b)).cos() * (0.5 * (b - a)).sin(),
        |a, b| b.cos() - a.cos() + (b - a) * b.sin(),
    )
}

/// For k = 1: trapezoids.
fn even_weights(angles_deg: &[f64]) -> Vec<f64> {
    weights(angles_deg, |a, b| b - a, |a, b| 0.5 * (b - a) * (b - a))
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

    /// Weights of the vertical angles, exact for the bilinear intensity.
    fn row_weights(&self) -> Vec<f64> {
        match self.system() {
            System::TypeC => sine_weights(self.vertical_deg()),
            System::TypeA => cosine_weights(self.vertical_deg()),
            System::TypeB => even_weights(self.vertical_deg()),
        }
    }

    /// ∫ I dω over all directions, exactly for the bilinear intensity: lm for cd, W for W/sr.
    #[must_use]
    pub fn total_flux(&self) -> f64 {
        let (across, along) = (self.plane_weights(), self.row_weights());
        across.iter().enumerate().map(|(i, w)| w * dot(self.plane(i), &along)).sum()
    }

    /// The solid angle that each tabulated value stands for, sr, symmetric copies counted, in the order of
    /// [`Distribution::values`]: the sum of solid angle times value is [`Distribution::total_flux`].
    #[must_use]
    pub fn solid_angles_sr(&self) -> Vec<f64> {
        let along = self.row_weights();
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
        let sine: fn(f64, f64) -> f64 = |a, b| a.cos() - b.cos();
        let cosine: fn(f64, f64) -> f64 = |a, b| b.sin() - a.sin();
        let even: fn(f64, f64) -> f64 = |a, b| b - a;
        let (across, along) = match self.system() {
            System::TypeC => (self.plane_weights(), solid(sine, self.vertical_deg())),
            System::TypeA => (self.plane_weights(), solid(cosine, self.vertical_deg())),
            System::TypeB => {
                let copies = self.copies();
                let across = solid(cosine, self.horizontal_deg()).into_iter().map(|w| w * copies).collect();
                (across, solid(even, self.vertical_deg()))
            }
        };
        across.iter().enumerate().map(|(i, w)| w * dot(self.plane(i), &along)).sum()
    }

    /// Mean over all planes at each vertical angle of a Type C table: what zonal figures are made of.
    #[must_use]
    pub fn zonal_means(&self) -> Vec<f64> {
        let across = self.plane_weights();
        let total: f64 = across.iter().sum();
        (0..self.vertical_deg().len())
            .map(|row| across.iter().enumerate().map(|(i, w)| w * self.plane(i)[row]).sum::<f64>() / total)
            .collect()
    }

    /// Flux between two γ of a Type C table, exactly for the bilinear intensity.
    #[must_use]
    pub fn flux_between(&self, from_deg: f64, to_deg: f64) -> f64 {
        let means = self.zonal_means();
        let angles = self.vertical_deg();
        let at = |g: f64| {
            let i = angles.partition_point(|&a| a <= g).saturating_sub(1).min(angles.len().saturating_sub(2));
            let t = if angles.len() > 1 { (g - angles[i]) / (angles[i + 1] - angles[i]) } else { 0.0 };
            means[i] + t * (means[(i + 1).min(means.len() - 1)] - means[i])
        };
        let (low, high) = (from_deg.max(angles[0]), to_deg.min(angles[angles.len() - 1]));
        if low >= high {
            return 0.0;
        }
        let mut cuts = vec![low];
        cuts.extend(angles.iter().copied().filter(|a| *a > low && *a < high));
        cuts.push(high);
        let values: Vec<f64> = cuts.iter().map(|&g| at(g)).collect();
        2.0 * PI * dot(&values, &sine_weights(&cuts))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
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
