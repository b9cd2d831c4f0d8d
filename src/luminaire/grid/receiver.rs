//! What light is weighed with where it arrives.

use std::f64::consts::FRAC_1_PI;

use glam::{DMat3, DVec3};

/// The receiver at each point of a grid. For light from one direction, of normal illuminance I/d², with ε the angle to the
/// receiver's normal (plane) or to its vertical axis (cylinders) and α the azimuth to the facing:
///
/// - planar: `cos ε`, zero from behind
/// - cylindrical: `sin ε / π`
/// - semicylindrical: `(1 + cos α) sin ε / π`
///
/// Directions need not have length 1.
///
/// # Reference
/// CIE S 017 (terms); EN 12464-1:2021, 4.6 (cylindrical); EN 13201-3:2015, 7.4 (semicylindrical).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Receiver {
    /// A flat one with a normal.
    Planar(DVec3),
    /// A small upright cylinder.
    Cylindrical,
    /// A small upright half cylinder that faces a horizontal direction (the vertical part of it is left out).
    Semicylindrical(DVec3),
}

/// A receiver with unit vectors in a luminaire's frame.
#[derive(Debug, Clone, Copy)]
pub(super) enum Local {
    Planar(DVec3),
    Cylindrical { up: DVec3 },
    Semicylindrical { up: DVec3, facing: DVec3 },
}

impl Receiver {
    /// In the frame that `to_local` leads to; `None` where a direction is zero, not finite, or straight up for a half cylinder.
    pub(super) fn local(&self, to_local: DMat3) -> Option<Local> {
        let up = to_local * DVec3::Z;
        Some(match self {
            Self::Planar(n) => Local::Planar(to_local * n.try_normalize()?),
            Self::Cylindrical => Local::Cylindrical { up },
            Self::Semicylindrical(f) => {
                let facing = to_local * DVec3::new(f.x, f.y, 0.0).try_normalize()?;
                Local::Semicylindrical { up, facing }
            }
        })
    }
}

impl Local {
    /// The factor for light that comes from the direction of a unit vector.
    pub(super) fn response(&self, from: DVec3) -> f64 {
        match self {
            Self::Planar(n) => n.dot(from).max(0.0),
            Self::Cylindrical { up } => up.cross(from).length() * FRAC_1_PI,
            Self::Semicylindrical { up, facing } => (up.cross(from).length() + facing.dot(from)).max(0.0) * FRAC_1_PI,
        }
    }
}
