//! Where a luminaire stands, where it looks, and how far it is dimmed.
//!
//! The room's frame has z upwards. A luminaire that is placed without turning shines along −z with C0 towards +x and C90
//! towards +y, as in [`super::distribution`]; its position is its photometric centre, the middle of the luminous opening.

use glam::{DMat3, DVec3};

/// Why a placement was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlacementError {
    /// A number that is not finite.
    #[error("a {which} that is not finite; expected numbers")]
    NotFinite {
        /// `position`, `angle` or `aim point`.
        which: &'static str,
    },
    /// The aim point is the position itself.
    #[error("the aim point is the position of the luminaire; expected another point")]
    Aim,
    /// A dimming factor below 0 or not finite.
    #[error("a dimming factor of {found}; expected 0 (off) or more, 1 for full output")]
    Dimming {
        /// The factor.
        found: f64,
    },
}

/// How a luminaire is turned, angles in degrees.
///
/// In this order: by the *spin* about its own photometric axis, by the *tilt* that lifts the axis from nadir towards a C-plane,
/// by the *rotation* about the vertical. Spin and rotation count counter-clockwise seen from above (C0 towards C90); without
/// tilt they are the same. A road luminaire whose street side is C90 (EULUMDAT) is tilted towards C90, one of LM-63 towards C0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Orientation {
    /// By angles.
    Angles {
        /// About the vertical, degrees.
        rotation_deg: f64,
        /// From nadir, degrees: 0 straight down, 90 horizontal, 180 straight up.
        tilt_deg: f64,
        /// The C-plane that the axis is lifted towards, degrees.
        towards_c_deg: f64,
        /// About the photometric axis, degrees.
        spin_deg: f64,
    },
    /// By a point on the photometric axis; a C-plane faces upwards along it.
    Aim {
        /// The point aimed at, m.
        at_m: DVec3,
        /// The C-plane that the axis is lifted towards, degrees; towards +x where the aim is straight up or down.
        towards_c_deg: f64,
        /// About the photometric axis, degrees.
        spin_deg: f64,
    },
}

impl Orientation {
    /// Straight down, C0 towards +x.
    pub const DOWN: Self = Self::Angles { rotation_deg: 0.0, tilt_deg: 0.0, towards_c_deg: 0.0, spin_deg: 0.0 };
}

/// A luminaire's place in the room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    position_m: DVec3,
    to_room: DMat3,
    dimming: f64,
}

impl Placement {
    /// At a position, turned, with its intensities multiplied by the dimming factor (0 or more).
    ///
    /// # Errors
    /// [`PlacementError`].
    pub fn new(position_m: DVec3, orientation: Orientation, dimming: f64) -> Result<Self, PlacementError> {
        if !position_m.is_finite() {
            return Err(PlacementError::NotFinite { which: "position" });
        }
        if !(dimming.is_finite() && dimming >= 0.0) {
            return Err(PlacementError::Dimming { found: dimming });
        }
        let to_room = match orientation {
            Orientation::Angles { rotation_deg, tilt_deg, towards_c_deg, spin_deg } => {
                turned(rotation_deg + towards_c_deg, tilt_deg, spin_deg - towards_c_deg)
            }
            Orientation::Aim { at_m, towards_c_deg, spin_deg } => {
                if !at_m.is_finite() {
                    return Err(PlacementError::NotFinite { which: "aim point" });
                }
                let d = at_m - position_m;
                if d.length() == 0.0 {
                    return Err(PlacementError::Aim);
                }
                let across = d.x.hypot(d.y);
                let azimuth = if across > 0.0 { d.y.atan2(d.x) } else { 0.0 };
                turned(azimuth.to_degrees(), across.atan2(-d.z).to_degrees(), spin_deg - towards_c_deg)
            }
        };
        if !to_room.is_finite() {
            return Err(PlacementError::NotFinite { which: "angle" });
        }
        Ok(Self { position_m, to_room, dimming })
    }

    /// The photometric centre, m.
    #[must_use]
    pub fn position_m(&self) -> DVec3 {
        self.position_m
    }

    /// The turn from the luminaire's frame to the room's.
    #[must_use]
    pub fn to_room(&self) -> DMat3 {
        self.to_room
    }

    /// The factor on the intensities.
    #[must_use]
    pub fn dimming(&self) -> f64 {
        self.dimming
    }

    /// Direction of the photometric axis in the room (unit vector).
    #[must_use]
    pub fn axis(&self) -> DVec3 {
        self.to_room * DVec3::NEG_Z
    }

    /// Direction of C0 at γ = 90° in the room (unit vector).
    #[must_use]
    pub fn c0(&self) -> DVec3 {
        self.to_room * DVec3::X
    }
}

/// By `last` about z, lifting −z towards +x by `tilt`, by `first` about z; degrees, applied from right to left.
fn turned(last: f64, tilt: f64, first: f64) -> DMat3 {
    about_z(last) * lifted(tilt) * about_z(first)
}

/// Sine and cosine that are exact for quarter turns, so that a luminaire turned by 90° has its planes where they belong.
fn sin_cos(deg: f64) -> (f64, f64) {
    let quarters = (deg / 90.0).round();
    let (s, c) = (deg - 90.0 * quarters).to_radians().sin_cos();
    match quarters.rem_euclid(4.0) {
        0.0 => (s, c),
        1.0 => (c, -s),
        2.0 => (-s, -c),
        _ => (-c, s),
    }
}

fn about_z(deg: f64) -> DMat3 {
    let (s, c) = sin_cos(deg);
    DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z)
}

fn lifted(deg: f64) -> DMat3 {
    let (s, c) = sin_cos(deg);
    DMat3::from_cols(DVec3::new(c, 0.0, s), DVec3::Y, DVec3::new(-s, 0.0, c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angles(rotation_deg: f64, tilt_deg: f64, towards_c_deg: f64, spin_deg: f64) -> Placement {
        let o = Orientation::Angles { rotation_deg, tilt_deg, towards_c_deg, spin_deg };
        Placement::new(DVec3::ZERO, o, 1.0).expect("a placement")
    }

    #[track_caller]
    fn same(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-15, "{a} {b}");
    }

    #[test]
    fn turns_are_those_of_the_conventions() {
        let down = angles(0.0, 0.0, 0.0, 0.0);
        same(down.axis(), DVec3::NEG_Z);
        same(down.c0(), DVec3::X);
        same(angles(90.0, 0.0, 0.0, 0.0).c0(), DVec3::Y);
        same(angles(0.0, 0.0, 0.0, 90.0).c0(), DVec3::Y);
        // Tilted by 90° towards a plane, the axis lies in it and the plane looks up.
        same(angles(0.0, 90.0, 0.0, 0.0).axis(), DVec3::X);
        same(angles(0.0, 90.0, 0.0, 0.0).c0(), DVec3::Z);
        let road = angles(0.0, 90.0, 90.0, 0.0);
        same(road.axis(), DVec3::Y);
        same(road.c0(), DVec3::X);
        same(angles(180.0, 90.0, 90.0, 0.0).axis(), DVec3::NEG_Y);
        // A spin leaves the axis where it is.
        same(angles(30.0, 40.0, 0.0, 77.0).axis(), angles(30.0, 40.0, 0.0, 0.0).axis());
    }

    #[test]
    fn an_aim_is_hit_with_the_plane_upwards() {
        let at_m = DVec3::new(-3.0, 4.0, 2.0);
        let aim = |towards_c_deg, at_m| {
            Placement::new(DVec3::new(1.0, 1.0, 5.0), Orientation::Aim { at_m, towards_c_deg, spin_deg: 0.0 }, 1.0)
        };
        let p = aim(90.0, at_m).expect("a placement");
        same(p.axis(), (at_m - p.position_m()).normalize());
        let c90 = p.to_room() * DVec3::Y;
        assert!(c90.z > 0.0 && p.c0().z.abs() < 1e-15);
        same(aim(0.0, DVec3::new(1.0, 1.0, 0.0)).expect("a placement").c0(), DVec3::X);
        assert_eq!(aim(0.0, DVec3::new(1.0, 1.0, 5.0)), Err(PlacementError::Aim));
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let place = |p, o, d| Placement::new(p, o, d).expect_err("no placement");
        assert_eq!(place(DVec3::ZERO, Orientation::DOWN, -0.1), PlacementError::Dimming { found: -0.1 });
        assert!(matches!(place(DVec3::NAN, Orientation::DOWN, 1.0), PlacementError::NotFinite { which: "position" }));
        let o = Orientation::Aim { at_m: DVec3::INFINITY, towards_c_deg: 0.0, spin_deg: 0.0 };
        assert!(matches!(place(DVec3::ZERO, o, 1.0), PlacementError::NotFinite { which: "aim point" }));
    }
}
