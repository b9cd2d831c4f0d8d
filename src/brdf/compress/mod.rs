//! Compact forms of measured materials: principal components in Nielsen's log-relative mapping, and whole tables from a few
//! measured directions.
//!
//! ```text
//! x = ln((f w + ε)/(f_ref w + ε))      w = max(cosθ_i cosθ_o, 0.001), ε = 0.001, f_ref w the median of the set, bin by bin
//! x ≈ x̄ + Σ c_j b_j                    b_j orthonormal over the bins
//! ```
//!
//! A *column* is one channel of one material. [`Collection`] takes tables one by one and keeps the bins that all of them measured;
//! [`Training`] maps the columns and has their Gram matrix (columns × columns: 100 tables of 4.4 M values need 1.3 GB for the
//! columns and as much again for 300 components); [`Basis`] has components, takes coefficients from a column or from a few measured
//! bins, and gives the column back, each bin marked as measured or inferred; [`mod@file`] keeps it, with its grid; [`cross_validate`]
//! tells how well columns come back that the set does not hold.
//!
//! The scale of errors is the mapping's own: rms over bins of ln((f̂ w + ε)/(f w + ε)).
//!
//! Reference: J. B. Nielsen, H. W. Jensen & R. Ramamoorthi, *On Optimal, Minimal BRDF Sampling for Reflectance Acquisition*, ACM
//! Trans. Graph. 34 (2015).

mod basis;
mod collection;
pub mod file;
mod grid;
mod mapping;
mod samples;
mod training;
mod validation;

pub use basis::Basis;
pub use collection::Collection;
pub use grid::Grid;
pub use mapping::Mapping;
pub use samples::Reconstruction;
pub use training::Training;
pub use validation::{Score, cross_validate};

/// Why a set of tables could not be compressed, or a table not be reconstructed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A table with other bins than the first.
    #[error("found a table of {found:?} bins; expected {expected:?} as the first one has")]
    Resolution {
        /// Its bins in θ_h, θ_d, φ_d.
        found: [usize; 3],
        /// Those of the others.
        expected: [usize; 3],
    },
    /// Fewer tables than parts to be held out in turn, or fewer than two parts.
    #[error("found {tables} tables for {folds} folds; expected at least two folds, and a table for each")]
    Folds {
        /// Number of tables.
        tables: usize,
        /// Number of parts.
        folds: usize,
    },
    /// Fewer columns than a mean and a component need.
    #[error("found {found} columns; expected at least 2")]
    TooFew {
        /// Number of columns.
        found: usize,
    },
    /// No bin that all tables measured.
    #[error("no bin is measured in all tables; expected some")]
    NothingInCommon,
    /// A column, list of coefficients or list of samples of another length.
    #[error("found {found} {what}; expected {expected}")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A bin that the set does not have, or twice the same.
    #[error("bin {bin} is not among the {bins} bins of the set, or is given twice")]
    Bin {
        /// Its index.
        bin: usize,
        /// Number of bins.
        bins: usize,
    },
}
