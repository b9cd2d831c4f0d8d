//! A near lamp that does not shine alike to all sides: the intensities of a photometric file, in the frame of the pictures.
//!
//! ```text
//! E = I(ω) cosθ_i / d²      I(ω) = strength · p(ω)      p = 1 along the axis
//! ```
//!
//! The lamp looks along its axis (γ = 0 of types C; the axis of A and B) with C0 to a stated side. Its file knows the far field: from five times
//! the lamp's size on.

use glam::{DMat3, DVec3};

use super::Error;
use crate::geometry::direction::tangents;
use crate::luminaire::{Distribution, Symmetry};

/// Intensities over that along the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    distribution: Distribution,
    to_lamp: DMat3,
    position: DVec3,
    /// Intensity along the axis, in the unit of the file.
    pub on_axis: f64,
}

impl Pattern {
    /// Of a lamp at a place (m) whose axis goes through `aim_m`, with C0 to the side of `c0`.
    ///
    /// # Errors
    /// [`Error::Setup`] for an aim at the lamp itself, for no `c0`, or one along the axis, of a lamp that is not the same all around its axis,
    /// and for one that does not shine along its axis.
    pub fn new(
        distribution: Distribution,
        position_m: [f64; 3],
        aim_m: [f64; 3],
        c0: Option<[f64; 3]>,
    ) -> Result<Self, Error> {
        let wrong = |found: &str, expected: &'static str| Error::Setup { found: found.to_owned(), expected };
        let position = DVec3::from_array(position_m);
        let axis = (DVec3::from_array(aim_m) - position)
            .try_normalize()
            .ok_or_else(|| wrong("a lamp aimed at itself", "another point"))?;
        let across = match c0 {
            Some(c0) => {
                let c0 = DVec3::from_array(c0);
                let across = (c0 - axis * c0.dot(axis)).try_normalize();
                across.ok_or_else(|| wrong("`c0` along the axis of the lamp", "a direction across it"))?
            }
            None if distribution.symmetry() == Symmetry::Rotational => tangents(axis).0,
            None => return Err(wrong("no `c0` of a lamp that shines unlike around its axis", "the direction of C0")),
        };
        // In the lamp's own frame the axis is −z, C0 +x and C90 +y.
        let to_lamp = DMat3::from_cols(across, (-axis).cross(across), -axis).transpose();
        let on_axis = distribution.towards(DVec3::NEG_Z);
        if !(on_axis > 0.0 && on_axis.is_finite()) {
            return Err(wrong("a lamp that does not shine along its axis", "one that does"));
        }
        Ok(Self { distribution, to_lamp, position, on_axis })
    }

    /// Intensity towards a point, over that along the axis.
    #[must_use]
    pub fn towards(&self, point: DVec3) -> f64 {
        self.distribution.towards(self.to_lamp * (point - self.position).normalize()) / self.on_axis
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::luminaire::format::{ReadOptions, read};

    /// A lamp with C0, C90, C180 and C270 unlike: 100 cd down, at γ = 90° 10, 20, 30 and 40 cd.
    const FILE: &str = "IESNA:LM-63-2002\n[TEST] t\n[MANUFAC] m\nTILT=NONE\n1 -1 1 2 5 1 2 0 0 0\n1 1 10\n0 90\n0 90 180 270 360\n\
                        100 10\n100 20\n100 30\n100 40\n100 10\n";

    #[test]
    fn sides_of_a_lamp_are_where_it_is_turned_to() {
        let distribution = || read(FILE.as_bytes(), &ReadOptions::default()).expect("a lamp").value.distribution;
        // It looks along +x with C0 upwards (+z): −axis × C0 = −x × z = y is C90.
        let lamp =
            Pattern::new(distribution(), [1.0, 2.0, 3.0], [5.0, 2.0, 3.0], Some([0.3, 0.0, 2.0])).expect("a lamp");
        assert_eq!(lamp.on_axis, 100.0);
        let to = |d: DVec3| lamp.towards(DVec3::new(1.0, 2.0, 3.0) + 2.5 * d);
        for (d, expected) in
            [(DVec3::X, 1.0), (DVec3::Z, 0.1), (DVec3::Y, 0.2), (DVec3::NEG_Z, 0.3), (DVec3::NEG_Y, 0.4)]
        {
            assert!((to(d) - expected).abs() < 1e-12, "{d}: {}", to(d));
        }
        let message = |aim, c0| Pattern::new(distribution(), [0.0; 3], aim, c0).unwrap_err().to_string();
        assert!(message([0.0; 3], None).contains("aimed at itself"));
        assert!(message([1.0, 0.0, 0.0], None).contains("no `c0`"));
        assert!(message([1.0, 0.0, 0.0], Some([2.0, 0.0, 0.0])).contains("along the axis"));
    }
}
