//! Bins that were not measured, filled on request: by a fitted model, or by what a set of measured materials makes probable.
//!
//! Measured bins keep their values to the last bit; every other one that gets a value is marked [`Known::Inferred`] and has no standard
//! error: how far a model is off where nobody measured, no measurement tells. Bins whose middle is below the horizon stay missing.

use crate::brdf::Brdf;
use crate::brdf::compress;
use crate::brdf::compress::file::BasisFile;
use crate::brdf::table::{HalfAngle, Known, resample};

/// A table of which some bins were filled.
#[derive(Debug, Clone, PartialEq)]
pub struct Filled {
    /// The values.
    pub table: HalfAngle,
    /// How each bin is known, in the order of the table.
    pub known: Vec<Known>,
}

impl Filled {
    /// Fills the missing bins of `measured` with the values of a model in their middles.
    ///
    /// # Panics
    /// Where the model has another number of bands than the table.
    #[must_use]
    pub fn by_model(measured: &HalfAngle, brdf: &dyn Brdf) -> Self {
        assert_eq!(measured.channels().len(), brdf.bands(), "bands of table and model");
        let at = |i, o, values: &mut [f64]| {
            brdf.evaluate(i, o, values);
            true
        };
        Self::of(measured, &resample(measured.resolution(), measured.channels().to_vec(), at))
    }

    /// Fills them with what the principal components of a set of materials make most probable, given the measured bins of each channel: see
    /// [`compress::Basis::project`]. Bins that the basis does not have stay missing.
    ///
    /// # Errors
    /// [`compress::Error::Resolution`] for a table of other bins than the basis has, [`compress::Error::NothingInCommon`] where none of its
    /// bins was measured.
    pub fn by_basis(measured: &HalfAngle, set: &BasisFile) -> Result<Self, compress::Error> {
        let column = |channel| {
            let coefficients = set.basis.project(&set.grid.column(measured, channel)?)?;
            set.basis.reconstruct(&coefficients)
        };
        let columns = (0..measured.channels().len()).map(column).collect::<Result<Vec<_>, compress::Error>>()?;
        Ok(Self::of(measured, &set.grid.table(measured.channels().to_vec(), &columns)?))
    }

    fn of(measured: &HalfAngle, guess: &HalfAngle) -> Self {
        let bins = measured.resolution().bins();
        let mut values = Vec::with_capacity(bins * measured.channels().len());
        let mut known = Vec::with_capacity(bins);
        for bin in 0..bins {
            let (from, how) = match (measured.bin(bin), guess.bin(bin)) {
                (own, _) if !own[0].is_nan() => (own, Known::Measured),
                (_, other) if !other[0].is_nan() => (other, Known::Inferred),
                (own, _) => (own, Known::Missing),
            };
            values.extend_from_slice(from);
            known.push(how);
        }
        let table = HalfAngle::new(measured.resolution(), measured.channels().to_vec(), values);
        Self { table: table.expect("the bins of a table"), known }
    }

    /// Number of bins that are known in this way.
    #[must_use]
    pub fn count(&self, how: Known) -> usize {
        self.known.iter().filter(|k| **k == how).count()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_1_PI;

    use super::*;
    use crate::brdf::lambert::Lambert;
    use crate::brdf::table::{Channel, Resolution};

    #[test]
    fn measured_bins_stay_and_the_others_are_the_model_s_above_the_horizon() {
        let resolution = Resolution { theta_h: 6, theta_d: 5, phi_d: 4 };
        let mut values = vec![f32::NAN; resolution.bins()];
        (values[0], values[33]) = (7.0, 8.0);
        let measured = HalfAngle::new(resolution, vec![Channel::Named("Y".to_owned())], values).expect("a table");
        let filled = Filled::by_model(&measured, &Lambert::new(vec![0.5]).expect("a reflectance"));
        assert_eq!((filled.table.bin(0), filled.table.bin(33)), (&[7.0][..], &[8.0][..]));
        #[expect(clippy::cast_possible_truncation, reason = "tables keep single precision")]
        let guess = (0.5 * FRAC_1_PI) as f32;
        for bin in (0..resolution.bins()).filter(|b| *b != 0 && *b != 33) {
            let (i, o) = resolution.centre(bin).directions();
            let above = i.z > 0.0 && o.z > 0.0;
            assert_eq!(filled.known[bin], if above { Known::Inferred } else { Known::Missing }, "{bin}");
            assert!(filled.table.bin(bin)[0] == guess || !above, "{bin}");
        }
        assert_eq!(filled.count(Known::Measured), 2);
        assert!(filled.count(Known::Missing) > 0);
    }
}
