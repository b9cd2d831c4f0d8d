//! Chromatic adaptation: what a colour under one white looks like under another (von Kries in a sharpened cone space).

use std::fmt;
use std::str::FromStr;

use glam::{DMat3, DVec3};
use serde::Serialize;

/// The space in which the cone signals are scaled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Default)]
#[serde(rename_all = "lowercase")]
pub enum Transform {
    /// Bradford (Lam 1985), linear form, as ICC profiles use it. The default.
    #[default]
    Bradford,
    /// CAT16 (Li et al., Color Res. Appl. 42, 2017).
    Cat16,
    /// No adaptation: the colour as it is.
    None,
}

/// The adaptation's name is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown chromatic adaptation `{found}`; expected bradford, cat16 or none")]
pub struct UnknownTransform {
    /// The word met.
    pub found: String,
}

impl FromStr for Transform {
    type Err = UnknownTransform;

    fn from_str(text: &str) -> Result<Self, UnknownTransform> {
        match text.to_lowercase().as_str() {
            "bradford" => Ok(Self::Bradford),
            "cat16" => Ok(Self::Cat16),
            "none" => Ok(Self::None),
            _ => Err(UnknownTransform { found: text.to_owned() }),
        }
    }
}

impl fmt::Display for Transform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bradford => "Bradford",
            Self::Cat16 => "CAT16",
            Self::None => "none",
        })
    }
}

impl Transform {
    /// XYZ to the sharpened cone space.
    fn cone_matrix(self) -> DMat3 {
        // Rows as published; glam wants columns.
        let rows = match self {
            Self::Bradford => [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]],
            Self::Cat16 => {
                [[0.401288, 0.650173, -0.051461], [-0.250268, 1.204414, 0.045854], [-0.002079, 0.048952, 0.953127]]
            }
            Self::None => return DMat3::IDENTITY,
        };
        DMat3::from_cols_array_2d(&rows).transpose()
    }

    /// The matrix that takes XYZ seen under `from` white to XYZ that looks alike under `to` white (full adaptation, D = 1).
    ///
    /// Both whites in XYZ of the same scale (Y = 1). `None` where the white point has no positive cone signals.
    #[must_use]
    pub fn matrix(self, from: [f64; 3], to: [f64; 3]) -> Option<DMat3> {
        if self == Self::None {
            return Some(DMat3::IDENTITY);
        }
        let cone = self.cone_matrix();
        let (a, b) = (cone * DVec3::from(from), cone * DVec3::from(to));
        let scale = b / a;
        (a.min_element() > 0.0 && scale.is_finite()).then(|| cone.inverse() * DMat3::from_diagonal(scale) * cone)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_white_point_maps_onto_the_other() {
        let (a, d65) = ([1.09850, 1.0, 0.35585], [0.95047, 1.0, 1.08883]);
        for t in [Transform::Bradford, Transform::Cat16] {
            let got = t.matrix(a, d65).expect("positive cones") * DVec3::from(a);
            assert!((got - DVec3::from(d65)).abs().max_element() < 1e-14, "{t}: {got}");
        }
    }

    #[test]
    fn bradford_d65_to_d50_is_the_published_matrix() {
        // B. Lindbloom, "Chromatic Adaptation", Bradford D65 → D50 with the ASTM E308 whites, seven decimals.
        let got = Transform::Bradford.matrix([0.95047, 1.0, 1.08883], [0.96422, 1.0, 0.82521]).expect("positive cones");
        let want = [
            [1.0478112, 0.0228866, -0.0501270],
            [0.0295424, 0.9904844, -0.0170491],
            [-0.0092345, 0.0150436, 0.7521316],
        ];
        for (r, row) in want.iter().enumerate() {
            for (c, v) in row.iter().enumerate() {
                assert!((got.col(c)[r] - v).abs() < 5.1e-8, "{r} {c}: {} {v}", got.col(c)[r]);
            }
        }
    }
}
