//! What a table consists of: its kind, its axes, its nodes.

use super::Table;
use crate::brdf::coordinates::Parameterisation;

/// An axis of a table; angles in degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What runs along it: `θ_h`, `θ_i`, …
    pub name: &'static str,
    /// Number of nodes, bins or patches.
    pub nodes: usize,
    /// The first.
    pub low_deg: f64,
    /// The last.
    pub high_deg: f64,
}

impl Axis {
    pub(super) fn new(name: &'static str, nodes: usize, low_deg: f64, high_deg: f64) -> Self {
        Self { name, nodes, low_deg, high_deg }
    }

    pub(super) fn of(name: &'static str, angles_deg: &[f64]) -> Self {
        let [low, high] = [angles_deg.first(), angles_deg.last()].map(|a| a.copied().unwrap_or(0.0));
        Self::new(name, angles_deg.len(), low, high)
    }
}

impl Table {
    /// The kind of table in words.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::HalfAngle(_) => "bins in half and difference angles",
            Self::Angular(_) => "grid in the angles of both directions",
            Self::Specular(_) => "grid about the mirror direction",
            Self::Patches(_) => "matrix over pairs of patches",
            Self::Points(_) => "scattered points",
            Self::Adaptive(_) => "adaptive parameterisation",
        }
    }

    /// The coordinates in which the nodes are written without loss.
    #[must_use]
    pub fn parameterisation(&self) -> Parameterisation {
        match self {
            Self::HalfAngle(_) => Parameterisation::HalfDifferenceIsotropic,
            Self::Points(t) => t.parameterisation(),
            _ if self.is_isotropic() => Parameterisation::ViewLightAzimuth,
            _ => Parameterisation::Spherical,
        }
    }

    /// The axes of the grid; none for scattered points.
    #[must_use]
    pub fn axes(&self) -> Vec<Axis> {
        match self {
            Self::HalfAngle(t) => {
                let n = t.resolution();
                vec![
                    Axis::new("θ_h", n.theta_h, 0.0, 90.0),
                    Axis::new("θ_d", n.theta_d, 0.0, 90.0),
                    Axis::new("φ_d", n.phi_d, 0.0, 180.0),
                ]
            }
            Self::Angular(t) => t.axes(),
            Self::Specular(t) => t.axes(),
            Self::Patches(t) => t.axes(),
            Self::Points(_) => Vec::new(),
            Self::Adaptive(t) => t.axes(),
        }
    }

    /// Smallest and largest value of the nodes in 1/sr, over all channels; `None` where all are missing.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        self.entries(&mut |entry| {
            for v in entry.values {
                range = [range[0].min(*v), range[1].max(*v)];
            }
        });
        (range[0] <= range[1]).then_some(range)
    }
}
