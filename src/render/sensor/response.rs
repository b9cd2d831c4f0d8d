//! What a meter makes of the radiance from each direction: reading = ∫ R(ω) L(ω) dω.
//!
//! | reading | R(ω), θ to the meter's axis | source |
//! |---|---|---|
//! | irradiance (illuminance) on a plane | cosθ above the plane | ILV 17-21-053 |
//! | hemispherical | (1 + cosθ)/4 | EN 12665, EN 13201-3: the flux on the curved surface of half a sphere over its area |
//! | cylindrical | sinθ/π | ILV 17-21-058 |
//! | spherical (scalar) | 1/4 | a sphere's mean over its surface |
//! | flux through all that surrounds the scene | 1 | ILV 17-25-074, an ideal integrating sphere |
//! | radiance (luminance) in a cone | 1/(π sin²α) · cosθ within α | mean, weighted as an instrument's detector sees it |

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::math::sampling;

/// The directional response of a meter, in its own frame: +z is its axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Response {
    /// Irradiance on a plane that faces +z.
    Planar,
    /// Mean irradiance of a small hemisphere's curved outer surface, pole at +z.
    Hemispherical,
    /// Mean irradiance of a small upright cylinder's side, axis z.
    Cylindrical,
    /// Mean irradiance of a small sphere's surface.
    Spherical,
    /// All that leaves the scene, in full.
    Flux,
    /// Mean radiance of a cone about +z of the given sine of its half-angle, in (0, 1].
    Cone {
        /// Sine of the half-angle of acceptance.
        sin: f64,
    },
}

impl Response {
    /// R(ω), per steradian where it is a mean.
    #[must_use]
    pub fn weight(&self, direction: DVec3) -> f64 {
        let cos = direction.z;
        match *self {
            Self::Planar => cos.max(0.0),
            Self::Hemispherical => 0.25 * (1.0 + cos),
            Self::Cylindrical => direction.x.hypot(direction.y) / PI,
            Self::Spherical => 0.25,
            Self::Flux => 1.0,
            Self::Cone { sin } => {
                if cos > 0.0 && direction.x.hypot(direction.y) <= sin {
                    cos / (PI * sin * sin)
                } else {
                    0.0
                }
            }
        }
    }

    /// A direction drawn from two uniform numbers, and R(ω)/pdf.
    #[must_use]
    pub fn sample(&self, u: [f64; 2]) -> (DVec3, f64) {
        match *self {
            Self::Planar => (sampling::cosine_hemisphere(u), PI),
            Self::Cone { sin } => {
                let p = sampling::disk(u) * sin;
                (p.extend((1.0 - p.length_squared()).max(0.0).sqrt()), 1.0)
            }
            Self::Hemispherical | Self::Cylindrical | Self::Spherical | Self::Flux => {
                let z = 1.0 - 2.0 * u[0];
                let r = (1.0 - z * z).max(0.0).sqrt();
                let (y, x) = (TAU * u[1]).sin_cos();
                let direction = DVec3::new(r * x, r * y, z);
                (direction, self.weight(direction) * 2.0 * TAU)
            }
        }
    }

    /// Density per solid angle of [`Response::sample`].
    #[must_use]
    pub fn pdf(&self, direction: DVec3) -> f64 {
        match self {
            Self::Planar => sampling::cosine_hemisphere_pdf(direction.z),
            Self::Cone { .. } => self.weight(direction),
            Self::Hemispherical | Self::Cylindrical | Self::Spherical | Self::Flux => 1.0 / (2.0 * TAU),
        }
    }

    /// Whether lights are sought from the meter itself: not by one that looks at a small cone, which meets lights by looking.
    #[must_use]
    pub fn seeks_lights(&self) -> bool {
        !matches!(self, Self::Cone { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Response; 7] = [
        Response::Planar,
        Response::Hemispherical,
        Response::Cylindrical,
        Response::Spherical,
        Response::Flux,
        Response::Cone { sin: 1.0 },
        Response::Cone { sin: 0.01 },
    ];

    /// Under a uniform sky of radiance 1 all round: π on every surface that is seen from its outside, whatever its shape, 4π, and the mean radiance 1, by the
    /// integrals of the weights over the sphere.
    #[test]
    fn readings_of_a_uniform_sphere_of_light() {
        let n = 300;
        for (response, expected) in ALL.iter().zip([PI, PI, PI, PI, 2.0 * TAU, 1.0, 1.0]) {
            let mut sum = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let u = [(f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n)];
                    let (direction, weight) = response.sample(u);
                    assert!((direction.length() - 1.0).abs() < 1e-14);
                    let ratio = response.weight(direction) / response.pdf(direction);
                    assert!((weight - ratio).abs() < 1e-9 * expected, "{response:?} {weight} {ratio}");
                    sum += weight;
                }
            }
            // Midpoint rule: the root at the ends of sinθ's weight, the least smooth, costs below n^-3/2.
            let mean = sum / f64::from(n * n);
            assert!((mean / expected - 1.0).abs() < f64::from(n).powf(-1.5), "{response:?}: {mean}");
        }
    }

    /// Parallel light of irradiance 1 at the angle θ to the axis falls on half a sphere as on its shadow, half a disk and half an ellipse:
    /// π r² (1 + cosθ)/2 of its 2π r²; a sphere's shadow is a quarter of its surface, that of a cylinder's side 2 r h sinθ of 2π r h.
    #[test]
    fn means_over_a_surface_are_shadows() {
        for degrees in [0.0_f64, 30.0, 90.0, 150.0, 180.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let from = DVec3::new(0.6 * sin, 0.8 * sin, cos);
            let expected = [PI * (1.0 + cos) / 2.0 / TAU, 0.25, 2.0 * sin / TAU];
            for (response, expected) in
                [Response::Hemispherical, Response::Spherical, Response::Cylindrical].iter().zip(expected)
            {
                assert!((response.weight(from) - expected).abs() < 1e-15, "{response:?} at {degrees}°");
            }
        }
    }
}
