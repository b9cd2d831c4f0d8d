//! Stray light within the instrument, taken out by a matrix (Zong, Brown, Johnson, Lykke and Ohno 2006).
//!
//! A reading is the light that falls where it belongs plus what the light of all other pixels scatters there: Y = (1 + D) Y_in, with
//! Dᵢⱼ the signal at pixel i, outside of the line itself, per signal inside the line of pixel j. So Y_in = (1 + D)⁻¹ Y.

use nalgebra::{DMatrix, DVector};

use super::signal::Signal;
use super::{Error, Step};
use crate::mistake::Mistake;
use crate::uncertainty::table;

/// A stray-light matrix on the wavelengths of an instrument.
#[derive(Debug, Clone, PartialEq)]
pub struct StrayLight {
    /// The wavelengths, nm.
    pub wavelengths_nm: Vec<f64>,
    /// D, rows where light falls, columns where it belongs.
    pub matrix: DMatrix<f64>,
    /// Relative standard uncertainty of the correction, all samples alike.
    pub relative: f64,
}

impl StrayLight {
    /// Reads D from a CSV text: wavelengths in nm of the light in the first row, of the samples in the first column, both the same.
    ///
    /// # Errors
    /// A mistake with its line and column.
    pub fn parse_matrix(text: &str, relative: f64) -> Result<Self, Mistake> {
        let (columns, rows, matrix) = table::rectangle(text)?;
        if columns != rows {
            let message = "found other wavelengths in the first column than in the first row; expected the same".into();
            return Err(Mistake { line: 1, column: 1, message });
        }
        Ok(Self { wavelengths_nm: rows, matrix, relative })
    }

    /// Makes D of line-spread functions measured with lines or lasers, a CSV text: wavelengths in nm of the lines in the first row, of
    /// the samples in the first column, readings between.
    ///
    /// Within `in_band_nm`/2 of its line a reading is the line itself; outside it is stray light, per sum of the readings inside. For
    /// light between two lines the functions are shifted to it and mixed by its distance to either, beyond the outermost line that of
    /// this line is shifted; beyond the samples of a function its outermost reading holds.
    ///
    /// # Errors
    /// A mistake with its line and column.
    pub fn parse_spreads(text: &str, in_band_nm: f64, relative: f64) -> Result<Self, Mistake> {
        let (lines, samples, readings) = table::rectangle(text)?;
        let at = |i: usize, line: f64| 2.0 * (samples[i] - line).abs() <= in_band_nm;
        let nearest = |line: f64| {
            let off = |i: &usize| (samples[*i] - line).abs();
            (0..samples.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
        };
        let mut centres = Vec::new();
        let mut spreads = Vec::new();
        for (column, line) in lines.iter().enumerate() {
            let inside: f64 = (0..samples.len()).filter(|i| at(*i, *line)).map(|i| readings[(i, column)]).sum();
            if inside <= 0.0 {
                let message = format!(
                    "found no reading within {in_band_nm} nm of the line at {line} nm; expected the line in its function"
                );
                return Err(Mistake { line: 1, column: 1, message });
            }
            centres.push(nearest(*line));
            spreads.push(readings.column(column).map(|v| v / inside));
        }
        let shifted = |k: usize, i: usize, j: usize| {
            let place = (i as i64 - j as i64 + centres[k] as i64).clamp(0, samples.len() as i64 - 1);
            spreads[k][place as usize]
        };
        let matrix = DMatrix::from_fn(samples.len(), samples.len(), |i, j| {
            if at(i, samples[j]) {
                return 0.0;
            }
            let right = lines.partition_point(|l| *l < samples[j]);
            match (right.checked_sub(1), lines.get(right)) {
                (Some(left), Some(next)) => {
                    let t = (samples[j] - lines[left]) / (next - lines[left]);
                    (1.0 - t) * shifted(left, i, j) + t * shifted(right, i, j)
                }
                (Some(left), None) => shifted(left, i, j),
                (None, _) => shifted(0, i, j),
            }
        });
        Ok(Self { wavelengths_nm: samples, matrix, relative })
    }

    pub(super) fn correct(&self, signal: &mut Signal) -> Result<Step, Error> {
        let n = self.wavelengths_nm.len();
        if self.wavelengths_nm != signal.wavelengths_nm() {
            let (low, high) = (self.wavelengths_nm[0], self.wavelengths_nm[n - 1]);
            return Err(Error::OtherGrid { what: "a stray-light matrix", found: n, low, high });
        }
        let solver = (DMatrix::identity(n, n) + &self.matrix).lu();
        if !solver.is_invertible() {
            return Err(Error::Singular);
        }
        let solve = |v: &[f64]| -> Vec<f64> {
            solver.solve(&DVector::from_column_slice(v)).map_or_else(|| v.to_vec(), |s| s.data.into())
        };
        let before = signal.values().to_vec();
        signal.replace(solve(&before));
        signal.each_mode(solve);
        let taken: Vec<f64> = before.iter().zip(signal.values()).map(|(b, a)| b - a).collect();
        signal.common(taken.iter().map(|t| self.relative * t).collect());
        let peak = before.iter().copied().fold(0.0, f64::max);
        let largest = taken.iter().copied().map(f64::abs).fold(0.0, f64::max);
        Ok(Step::StrayLight { largest: if peak > 0.0 { largest / peak } else { 0.0 }, relative: self.relative })
    }
}
