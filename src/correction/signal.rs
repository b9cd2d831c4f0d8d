//! Samples on their way through the corrections, with their errors.

use nalgebra::DMatrix;

use super::{Error, MOST_CORRELATED};
use crate::spectrum::{Grid, Spectrum};

/// A linear map of the samples: for each sample that comes out, the first one that enters it and the weights from there on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Operator(Vec<(usize, Vec<f64>)>);

impl Operator {
    /// From pairs of the first sample and the weights.
    pub(super) fn new(rows: Vec<(usize, Vec<f64>)>) -> Self {
        Self(rows)
    }

    /// From full rows, whose zeros at either end are left out.
    pub(super) fn of_rows(rows: Vec<Vec<f64>>) -> Self {
        let trim = |row: Vec<f64>| {
            let first = row.iter().position(|v| *v != 0.0).unwrap_or(0);
            let last = row.iter().rposition(|v| *v != 0.0).map_or(first, |l| l + 1);
            (first, row[first..last].to_vec())
        };
        Self(rows.into_iter().map(trim).collect())
    }

    /// The map of some samples.
    pub(super) fn apply(&self, samples: &[f64]) -> Vec<f64> {
        let dot = |(first, weights): &(usize, Vec<f64>)| {
            weights.iter().zip(&samples[*first..]).map(|(w, s)| w * s).sum::<f64>()
        };
        self.0.iter().map(dot).collect()
    }
}

/// What is known of the errors.
#[derive(Debug, Clone)]
enum Errors {
    /// Variance of each sample, independent.
    Independent(Option<Vec<f64>>),
    /// Samples × independent errors of one standard uncertainty.
    Modes(Option<DMatrix<f64>>),
}

/// Samples, wavelengths and errors.
#[derive(Debug, Clone)]
pub(super) struct Signal {
    wavelengths_nm: Vec<f64>,
    values: Vec<f64>,
    errors: Errors,
}

impl Signal {
    pub(super) fn new(spectrum: &Spectrum, standard: Option<&[f64]>) -> Self {
        Self {
            wavelengths_nm: spectrum.wavelengths_nm().to_vec(),
            values: spectrum.values().to_vec(),
            errors: Errors::Independent(standard.map(|s| s.iter().map(|u| u * u).collect())),
        }
    }

    pub(super) fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Standard uncertainty of each sample, where anything is known.
    pub(super) fn standard(&self) -> Option<Vec<f64>> {
        match &self.errors {
            Errors::Independent(variances) => variances.as_ref().map(|v| v.iter().map(|v| v.sqrt()).collect()),
            Errors::Modes(modes) => modes.as_ref().map(|m| m.row_iter().map(|r| r.norm()).collect()),
        }
    }

    /// Other values that err as these do.
    pub(super) fn replace(&mut self, values: Vec<f64>) {
        self.values = values;
    }

    /// Adds independent errors; only before [`Signal::correlate`].
    pub(super) fn independent(&mut self, standard: &[f64]) {
        if let Errors::Independent(variances) = &mut self.errors {
            let all = variances.get_or_insert_with(|| vec![0.0; standard.len()]);
            all.iter_mut().zip(standard).for_each(|(v, u)| *v += u * u);
        }
    }

    /// From here on errors are kept with their covariance.
    pub(super) fn correlate(&mut self) -> Result<(), Error> {
        if let Errors::Independent(variances) = &self.errors {
            let found = self.values.len();
            if variances.is_some() && found > MOST_CORRELATED {
                return Err(Error::TooMany { found });
            }
            let diagonal = |v: &Vec<f64>| DMatrix::from_fn(found, found, |r, c| if r == c { v[r].sqrt() } else { 0.0 });
            self.errors = Errors::Modes(variances.as_ref().map(diagonal));
        }
        Ok(())
    }

    /// Adds an error that all samples share: its standard uncertainty in each.
    pub(super) fn common(&mut self, standard: Vec<f64>) {
        if standard.iter().all(|u| *u == 0.0) {
            return;
        }
        if let Errors::Modes(modes) = &mut self.errors {
            let rows = standard.len();
            let column = DMatrix::from_vec(rows, 1, standard);
            *modes = Some(match modes.take() {
                None => column,
                Some(m) => {
                    let at = m.ncols();
                    let mut wider = m.insert_column(at, 0.0);
                    wider.column_mut(at).copy_from(&column.column(0));
                    wider
                }
            });
        }
    }

    /// Maps samples and errors.
    pub(super) fn transform(&mut self, operator: &Operator) {
        self.values = operator.apply(&self.values);
        self.each_mode(|mode| operator.apply(mode));
    }

    /// Maps each error by `f`, which is linear.
    pub(super) fn each_mode(&mut self, f: impl Fn(&[f64]) -> Vec<f64> + Sync) {
        use rayon::prelude::*;
        if let Errors::Modes(Some(modes)) = &mut self.errors {
            let rows = modes.nrows();
            let columns: Vec<Vec<f64>> = modes.as_slice().par_chunks(rows).map(&f).collect();
            let rows = columns.first().map_or(0, Vec::len);
            *modes = DMatrix::from_vec(rows, columns.len(), columns.concat());
        }
    }

    /// The samples are of other wavelengths.
    pub(super) fn move_to(&mut self, wavelengths_nm: Vec<f64>) {
        self.wavelengths_nm = wavelengths_nm;
    }

    pub(super) fn into_parts(self) -> Result<(Spectrum, Option<DMatrix<f64>>), Error> {
        let modes = match self.errors {
            Errors::Modes(modes) => modes,
            Errors::Independent(_) => None,
        };
        Ok((Spectrum::density(Grid::new(self.wavelengths_nm)?, self.values)?, modes))
    }
}
