//! The corners of many triangles, each with its own, one triangle after the other: what a search reads lies together.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// The corners of triangles, m.
#[derive(Debug)]
pub(super) enum Corners {
    /// All coordinates are numbers of single precision, as most files have them: nothing is lost by keeping them so.
    Single(Vec<[Vec3; 3]>),
    /// Some are not.
    Double(Vec<[DVec3; 3]>),
}

impl Corners {
    /// Of triangles that name their corners.
    ///
    /// # Panics
    /// Where a corner is not there.
    pub(super) fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let named = triangles.par_iter().map(|names| names.map(|i| positions[i as usize]));
        let is_single = |p: DVec3| p.as_vec3().as_dvec3() == p;
        if named.clone().all(|corners| corners.into_iter().all(is_single)) {
            Self::Single(named.map(|corners| corners.map(|p| p.as_vec3())).collect())
        } else {
            Self::Double(named.collect())
        }
    }

    /// The number of triangles.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Single(all) => all.len(),
            Self::Double(all) => all.len(),
        }
    }

    /// Those of a triangle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[inline]
    pub(super) fn of(&self, triangle: u32) -> [DVec3; 3] {
        match self {
            Self::Single(all) => all[triangle as usize].map(|p| p.as_dvec3()),
            Self::Double(all) => all[triangle as usize],
        }
    }
}
