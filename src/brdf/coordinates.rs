//! Coordinates of a pair of directions: half and difference angles, and the parameterisations in which tables are kept.
//!
//! ```text
//! h = (ω_i + ω_o)/|ω_i + ω_o|                     θ_h, φ_h: its angles to the normal and about it
//! d = R_y(−θ_h) R_z(−φ_h) ω_i                     θ_d, φ_d: its angles to h and about it
//! ```
//!
//! Exchanging ω_i and ω_o turns φ_d by π; a reciprocal material needs only 0 ≤ φ_d < π. An isotropic one does not depend on φ_h.
//!
//! The angles are taken from components whose small ones carry the small angles (atan2, never acos), so that they keep their
//! relative precision at the poles: θ_h → 0 (mirror directions), θ_d → 0 (retro-reflection). At a pole itself the azimuth is 0.
//! θ_h is below π/2 whenever both directions are above the horizon; the converse does not hold, and [`HalfDiff::directions`] may
//! give directions below it.
//!
//! Reference: S. M. Rusinkiewicz, *A New Change of Variables for Efficient BRDF Representation*, Rendering Techniques '98.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::geometry::direction::{from_angles, phi, theta};

/// Half and difference angles in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfDiff {
    /// Angle of the half vector to the normal, 0 to π/2.
    pub theta_h: f64,
    /// Azimuth of the half vector, 0 to 2π.
    pub phi_h: f64,
    /// Angle of ω_i to the half vector, 0 to π/2.
    pub theta_d: f64,
    /// Azimuth of ω_i about the half vector, 0 to 2π.
    pub phi_d: f64,
}

impl HalfDiff {
    /// The coordinates of two unit vectors that are not opposite to one another (for which there is no half vector: all 0).
    #[must_use]
    pub fn new(incident: DVec3, outgoing: DVec3) -> Self {
        let h = incident + outgoing;
        let across = h.x.hypot(h.y);
        let length = h.length();
        if length == 0.0 {
            return Self { theta_h: 0.0, phi_h: 0.0, theta_d: 0.0, phi_d: 0.0 };
        }
        // The difference vector holds sinθ_d to full relative precision; half of it is ω_i without its part along h.
        let half = 0.5 * (incident - outgoing);
        let (x, y) = if across == 0.0 { (1.0, 0.0) } else { (h.x / across, h.y / across) };
        let along = (h.z * (x * half.x + y * half.y) - across * half.z) / length;
        let sideways = x * half.y - y * half.x;
        Self {
            theta_h: across.atan2(h.z),
            phi_h: if across == 0.0 { 0.0 } else { turn(h.y.atan2(h.x)) },
            theta_d: half.length().atan2(0.5 * length),
            phi_d: if along == 0.0 && sideways == 0.0 { 0.0 } else { turn(sideways.atan2(along)) },
        }
    }

    /// The two directions, ω_i first.
    #[must_use]
    pub fn directions(&self) -> (DVec3, DVec3) {
        let (sin_h, cos_h) = self.theta_h.sin_cos();
        let (sin_p, cos_p) = self.phi_h.sin_cos();
        let d = from_angles(self.theta_d, self.phi_d);
        let turned = |d: DVec3| {
            let (x, z) = (cos_h * d.x + sin_h * d.z, cos_h * d.z - sin_h * d.x);
            DVec3::new(cos_p * x - sin_p * d.y, sin_p * x + cos_p * d.y, z)
        };
        (turned(d), turned(DVec3::new(-d.x, -d.y, d.z)))
    }
}

/// An angle of atan2 in 0 … 2π.
fn turn(angle: f64) -> f64 {
    if angle < 0.0 { angle + TAU } else { angle }
}

/// The parameterisations in which tables of points come; angles in radians, names as in ALTA's files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Parameterisation {
    /// cosθ_h alone.
    CosHalf,
    /// θ_h alone.
    Half,
    /// θ_h, θ_d.
    HalfDifference,
    /// θ_h, θ_d, φ_d.
    HalfDifferenceIsotropic,
    /// θ_h, φ_h, θ_d, φ_d.
    HalfDifferenceFull,
    /// θ_o, θ_i, φ_o − φ_i.
    ViewLightAzimuth,
    /// θ_i, θ_o cosΔφ, θ_o sinΔφ with Δφ = φ_o − φ_i.
    LightViewProjected,
    /// θ_i, φ_i, θ_o, φ_o.
    Spherical,
    /// ω_o, ω_i as vectors.
    Cartesian,
}

impl Parameterisation {
    /// All of them with their names in ALTA's files.
    pub const ALL: [(Self, &'static str); 9] = [
        (Self::CosHalf, "COS_TH"),
        (Self::Half, "RUSIN_TH"),
        (Self::HalfDifference, "RUSIN_TH_TD"),
        (Self::HalfDifferenceIsotropic, "RUSIN_TH_TD_PD"),
        (Self::HalfDifferenceFull, "RUSIN_TH_PH_TD_PD"),
        (Self::ViewLightAzimuth, "ISOTROPIC_TV_TL_DPHI"),
        (Self::LightViewProjected, "ISOTROPIC_TL_TV_PROJ_DPHI"),
        (Self::Spherical, "SPHERICAL_TL_PL_TV_PV"),
        (Self::Cartesian, "CARTESIAN"),
    ];

    /// Its name in ALTA's files.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(p, _)| *p == self).map_or("", |(_, name)| name)
    }

    /// The parameterisation of a name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, n)| *n == name).map(|(p, _)| *p)
    }

    /// How many coordinates it has.
    #[must_use]
    pub fn dimension(self) -> usize {
        match self {
            Self::CosHalf | Self::Half => 1,
            Self::HalfDifference => 2,
            Self::HalfDifferenceIsotropic | Self::ViewLightAzimuth | Self::LightViewProjected => 3,
            Self::HalfDifferenceFull | Self::Spherical => 4,
            Self::Cartesian => 6,
        }
    }

    /// Whether a table in it takes the material for isotropic.
    #[must_use]
    pub fn is_isotropic(self) -> bool {
        self.dimension() < 4
    }

    /// Two directions, ω_i first, that have these coordinates. What the coordinates leave open is 0 (θ_d, φ_d, φ_h, φ_i).
    ///
    /// # Panics
    /// Where there are fewer coordinates than [`Parameterisation::dimension`].
    #[must_use]
    pub fn directions(self, c: &[f64]) -> (DVec3, DVec3) {
        let half = |theta_h, phi_h, theta_d, phi_d| HalfDiff { theta_h, phi_h, theta_d, phi_d }.directions();
        match self {
            Self::CosHalf => half(((1.0 - c[0]) * (1.0 + c[0])).max(0.0).sqrt().atan2(c[0]), 0.0, 0.0, 0.0),
            Self::Half => half(c[0], 0.0, 0.0, 0.0),
            Self::HalfDifference => half(c[0], 0.0, c[1], 0.0),
            Self::HalfDifferenceIsotropic => half(c[0], 0.0, c[1], c[2]),
            Self::HalfDifferenceFull => half(c[0], c[1], c[2], c[3]),
            Self::ViewLightAzimuth => (from_angles(c[1], 0.0), from_angles(c[0], c[2])),
            Self::LightViewProjected => (from_angles(c[0], 0.0), from_angles(c[1].hypot(c[2]), c[2].atan2(c[1]))),
            Self::Spherical => (from_angles(c[0], c[1]), from_angles(c[2], c[3])),
            Self::Cartesian => (DVec3::new(c[3], c[4], c[5]), DVec3::new(c[0], c[1], c[2])),
        }
    }

    /// Writes the coordinates of two directions and gives their number.
    ///
    /// # Panics
    /// Where `c` is shorter than [`Parameterisation::dimension`].
    pub fn coordinates(self, incident: DVec3, outgoing: DVec3, c: &mut [f64]) -> usize {
        let azimuth = || turn((phi(outgoing) - phi(incident)) % TAU);
        match self {
            Self::CosHalf => c[0] = HalfDiff::new(incident, outgoing).theta_h.cos(),
            Self::Half => c[0] = HalfDiff::new(incident, outgoing).theta_h,
            Self::HalfDifference => {
                let a = HalfDiff::new(incident, outgoing);
                c[..2].copy_from_slice(&[a.theta_h, a.theta_d]);
            }
            Self::HalfDifferenceIsotropic => {
                let a = HalfDiff::new(incident, outgoing);
                c[..3].copy_from_slice(&[a.theta_h, a.theta_d, a.phi_d]);
            }
            Self::HalfDifferenceFull => {
                let a = HalfDiff::new(incident, outgoing);
                c[..4].copy_from_slice(&[a.theta_h, a.phi_h, a.theta_d, a.phi_d]);
            }
            Self::ViewLightAzimuth => c[..3].copy_from_slice(&[theta(outgoing), theta(incident), azimuth()]),
            Self::LightViewProjected => {
                let (t, (sin, cos)) = (theta(outgoing), azimuth().sin_cos());
                c[..3].copy_from_slice(&[theta(incident), t * cos, t * sin]);
            }
            Self::Spherical => {
                c[..4].copy_from_slice(&[theta(incident), phi(incident), theta(outgoing), phi(outgoing)]);
            }
            Self::Cartesian => {
                c[..3].copy_from_slice(&outgoing.to_array());
                c[3..6].copy_from_slice(&incident.to_array());
            }
        }
        self.dimension()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use proptest::prelude::*;

    use super::*;

    fn near(a: DVec3, b: DVec3) -> bool {
        (a - b).length() < 1e-14
    }

    #[test]
    fn mirror_and_retro_directions_stand_at_the_poles() {
        let i = from_angles(1.1, 0.4);
        let mirror = HalfDiff::new(i, from_angles(1.1, 0.4 + PI));
        assert!(mirror.theta_h < 1e-15 && (mirror.theta_d - 1.1).abs() < 1e-15, "{mirror:?}");
        let retro = HalfDiff::new(i, i);
        assert_eq!((retro.theta_d, retro.phi_d), (0.0, 0.0));
        assert!((retro.theta_h - 1.1).abs() < 1e-15 && (retro.phi_h - 0.4).abs() < 1e-15);
    }

    #[test]
    fn tiny_angles_keep_their_digits() {
        // ω_i = (ε, 0, 1), ω_o = (0, 0, 1): θ_h = θ_d = ε/2 to first order, with acos both would be lost below 1e-8.
        for e in [1e-9_f64, 1e-12] {
            let a = HalfDiff::new(from_angles(e, 0.0), DVec3::Z);
            assert!((a.theta_h / (0.5 * e) - 1.0).abs() < 1e-9 && (a.theta_d / (0.5 * e) - 1.0).abs() < 1e-9, "{a:?}");
        }
    }

    proptest! {
        #[test]
        fn directions_come_back(ti in 0.0..FRAC_PI_2, pi in 0.0..TAU, to in 0.0..FRAC_PI_2, po in 0.0..TAU) {
            let (i, o) = (from_angles(ti, pi), from_angles(to, po));
            let (i2, o2) = HalfDiff::new(i, o).directions();
            prop_assert!(near(i, i2) && near(o, o2), "{i2} {o2}");
            let mut c = [0.0; 6];
            for (p, _) in Parameterisation::ALL {
                let n = p.coordinates(i, o, &mut c);
                let (a, b) = p.directions(&c[..n]);
                let mut again = [0.0; 6];
                p.coordinates(a, b, &mut again);
                for (x, y) in c[..n].iter().zip(&again[..n]) {
                    // An azimuth of 2π − ε may come back as 0.
                    let off = (x - y).abs();
                    prop_assert!(off < 1e-7 || (off - TAU).abs() < 1e-7, "{p:?}: {:?} {:?}", c, again);
                }
                if p.dimension() >= 4 {
                    prop_assert!(near(a, i) && near(b, o), "{p:?}");
                } else if p.dimension() == 3 {
                    prop_assert!((a.dot(b) - i.dot(o)).abs() < 1e-14 && (a.z - i.z).abs() < 1e-14);
                }
            }
        }

        #[test]
        fn exchange_turns_the_difference_by_half(ti in 0.01..1.5, to in 0.01..1.5, po in 0.1..6.2) {
            let (i, o) = (from_angles(ti, 0.0), from_angles(to, po));
            let (a, b) = (HalfDiff::new(i, o), HalfDiff::new(o, i));
            prop_assert_eq!((a.theta_h, a.phi_h, a.theta_d), (b.theta_h, b.phi_h, b.theta_d));
            prop_assert!(((a.phi_d - b.phi_d).abs() - PI).abs() < 1e-12);
        }
    }
}
