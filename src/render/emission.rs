//! What a surface emits.

use std::f64::consts::PI;

/// Radiance of an emitting surface: the same at every point, constant or a cosine power over directions.
///
/// ```text
/// L_e(θ) = L₀ cosᵖθ        p = 0: diffuse (Lambertian)
/// M = 2π L₀ / (p + 2)      exitance
/// ```
///
/// θ is the angle to the geometric normal; the inside of the surface is dark unless it is two-sided.
#[derive(Debug, Clone, PartialEq)]
pub struct Emission {
    radiance: Vec<f64>,
    power: f64,
    two_sided: bool,
}

impl Emission {
    /// Radiance along the normal per band, W/(m²·sr·nm) or W/(m²·sr), and the power p ≥ 0 of the cosine.
    #[must_use]
    pub fn new(radiance: Vec<f64>, power: f64, two_sided: bool) -> Self {
        Self { radiance, power, two_sided }
    }

    /// A diffuse emitter that shines from its outside.
    #[must_use]
    pub fn diffuse(radiance: Vec<f64>) -> Self {
        Self::new(radiance, 0.0, false)
    }

    /// Radiance along the normal per band.
    #[must_use]
    pub fn radiance(&self) -> &[f64] {
        &self.radiance
    }

    /// The factor cosᵖθ for a direction of cosine `cos` to the normal; 0 on a dark side.
    #[must_use]
    pub fn profile(&self, cos: f64) -> f64 {
        let cos = if self.two_sided { cos.abs() } else { cos };
        if cos <= 0.0 {
            0.0
        } else if self.power == 0.0 {
            1.0
        } else {
            cos.powf(self.power)
        }
    }

    /// Exitance over radiance along the normal, sr: ∫ cosᵖθ cosθ dω, of both sides where both shine.
    #[must_use]
    pub fn exitance_per_radiance(&self) -> f64 {
        let side = 2.0 * PI / (self.power + 2.0);
        if self.two_sided { 2.0 * side } else { side }
    }

    /// The power of the cosine.
    #[must_use]
    pub fn power(&self) -> f64 {
        self.power
    }

    /// Whether both sides shine.
    #[must_use]
    pub fn is_two_sided(&self) -> bool {
        self.two_sided
    }
}
