//! A measured table as a [`Brdf`]: its channels are the bands.
//!
//! - **What is missing** has the table's best guess, and [`Brdf::is_measured`] tells so. [`Table::value`] guesses from neighbours
//!   where it can; where it knows nothing, the value of the exchanged directions is taken (reciprocity), else that of the nearest
//!   known place with the same difference angles and a smaller angle of the half vector, else 0 (a table without any data).
//! - **Negative values** are given as they were measured: noise about zero has a mean only with them. [`audit`](crate::brdf::audit)
//!   counts them.
//! - **Albedo** is the sum over the patches of a matrix, without error; elsewhere a quadrature to 1e-4 ([`Brdf::is_tabulated`]).
//! - [`Brdf::sample`] draws by the cosine alone; [`SampledTable`](super::SampledTable) draws as the table reflects.

use glam::DVec3;

use super::{Known, Table};
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::{Brdf, reflectance};

/// Steps from the half vector of a place to the normal, in search of a known one.
const STEPS: u32 = 64;
/// Channels that are carried without allocating; more are taken from the heap.
const FEW: usize = 64;

impl Table {
    /// How the value of two directions is known.
    #[must_use]
    pub fn known(&self, incident: DVec3, outgoing: DVec3) -> Known {
        let n = self.channels().len();
        if n <= FEW {
            self.value(incident, outgoing, &mut [0.0; FEW][..n])
        } else {
            self.value(incident, outgoing, &mut vec![0.0; n])
        }
    }

    /// Writes what may stand for a place of which nothing is known.
    fn guess(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if self.value(outgoing, incident, values) != Known::Missing {
            return;
        }
        let here = HalfDiff::new(incident, outgoing);
        let mut steps = STEPS;
        if let Self::HalfAngle(table) = self {
            if table.value_towards_normal(&here, STEPS, values) {
                return;
            }
            steps = 1;
        }
        for step in (0..steps).rev() {
            let theta_h = here.theta_h * f64::from(step) / f64::from(STEPS);
            let (i, o) = HalfDiff { theta_h, ..here }.directions();
            if self.value(i, o, values) != Known::Missing {
                return;
            }
        }
        values.fill(0.0);
    }
}

impl Brdf for Table {
    fn bands(&self) -> usize {
        self.channels().len()
    }

    fn is_isotropic(&self) -> bool {
        self.is_isotropic()
    }

    fn is_tabulated(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if self.value(incident, outgoing, values) == Known::Missing {
            self.guess(incident, outgoing, values);
        }
        // A value at the horizon itself may overflow where a cosine was divided out.
        values.iter_mut().filter(|v| !v.is_finite()).for_each(|v| *v = 0.0);
    }

    fn albedo(&self, incident: DVec3, albedo: &mut [f64]) -> f64 {
        if let Self::Patches(table) = self
            && table.directional(incident, albedo)
        {
            return 0.0;
        }
        reflectance::directional(self, incident, &reflectance::Cone::HEMISPHERE, albedo)
    }

    fn incidences_deg(&self) -> Option<Vec<[f64; 2]>> {
        match self {
            Self::Specular(table) => {
                let turns = table.rotations_deg().iter().map(|turn| if self.is_isotropic() { 0.0 } else { *turn });
                let lit = turns.flat_map(|turn| table.incidences_deg().iter().map(move |theta| [*theta, turn]));
                Some(lit.filter(|l| l[0] < 90.0).collect()).filter(|l: &Vec<_>| !l.is_empty())
            }
            Self::Points(table) => table.incidences_deg(),
            _ => None,
        }
    }

    fn is_measured(&self, incident: DVec3, outgoing: DVec3) -> bool {
        self.known(incident, outgoing) == Known::Measured
    }
}
