//! What a surface emits.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;

use super::light::goniometric::Goniometric;

/// Radiance of an emitting surface: the same at every point, constant or a cosine power over directions, or that of a luminaire.
///
/// ```text
/// L_e(θ) = L₀ cosᵖθ        p = 0: diffuse (Lambertian)
/// M = 2π L₀ / (p + 2)      exitance
/// ```
///
/// θ is the angle to the geometric normal; the inside of the surface is dark unless it is two-sided.
///
/// A flat surface of area A can shine as a photometric file says, every part of it alike: L(ω) = I(ω)/(A |cosθ|), out of both of its sides
/// where the file has light on both.
#[derive(Debug, Clone, PartialEq)]
pub struct Emission {
    radiance: Vec<f64>,
    power: f64,
    two_sided: bool,
    lamp: Option<Arc<Goniometric>>,
}

impl Emission {
    /// Radiance along the normal per band, W/(m²·sr·nm) or W/(m²·sr), and the power p ≥ 0 of the cosine.
    #[must_use]
    pub fn new(radiance: Vec<f64>, power: f64, two_sided: bool) -> Self {
        Self { radiance, power, two_sided, lamp: None }
    }

    /// A flat surface of the area given (m²) that shines as a luminaire, whose place does not matter; its radiance along the normal
    /// stands for the luminaire's peak intensity.
    #[must_use]
    pub fn of_lamp(lamp: Arc<Goniometric>, area_m2: f64, bands: usize) -> Self {
        let mut radiance = vec![0.0; bands];
        lamp.peak_intensity(1.0 / area_m2, &mut radiance);
        Self { radiance, power: 0.0, two_sided: true, lamp: Some(lamp) }
    }

    /// The luminaire that it shines as.
    #[must_use]
    pub fn lamp(&self) -> Option<&Goniometric> {
        self.lamp.as_deref()
    }

    /// The factor on the radiance along the normal for light that leaves in `direction` (unit, world) at a cosine `cos` to the normal; 0
    /// on a dark side.
    #[must_use]
    pub fn profile_towards(&self, direction: DVec3, cos: f64) -> f64 {
        match &self.lamp {
            Some(lamp) if cos != 0.0 => lamp.relative_intensity(direction) / cos.abs(),
            Some(_) => 0.0,
            None => self.profile(cos),
        }
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
    fn profile(&self, cos: f64) -> f64 {
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
        if let Some(lamp) = &self.lamp {
            return lamp.flux_per_peak();
        }
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
