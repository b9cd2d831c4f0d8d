//! `capture brdf --fill`: bins that nobody measured.

use clap::{Args, ValueEnum};

use super::message;
use crate::brdf::compress::file::{BasisFile, Checksum};
use crate::brdf::table::{HalfAngle, Known, Resolution};
use crate::capture::brdf::Filled;
use crate::cli::Failure;
use crate::cli::brdf::open_basis;
use crate::cli::capture::photos::Photos;
use crate::finding::Finding;
use crate::report::brdf_fit;
use crate::report::capture_brdf::{FilledBy, Filling, Scale};

/// Whether and how to fill.
#[derive(Debug, Args)]
pub(super) struct FillArgs {
    /// Fill the bins that were not measured, each marked as inferred; without it none is.
    #[arg(long, value_name = "HOW")]
    fill: Option<How>,
    /// The basis for `--fill pca`, from `brdf compress train`; its bins are used unless --resolution says otherwise.
    #[arg(long, value_name = "FILE", required_if_eq("fill", "pca"), requires = "fill")]
    basis: Option<String>,
}

/// What tells the bins that were not measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum How {
    /// The best fit.
    Model,
    /// Principal components of measured materials.
    Pca,
}

/// What to fill with.
pub(super) enum Filler {
    None,
    Model,
    Basis(Box<BasisFile>, Checksum),
}

impl Filler {
    pub(super) fn open(a: &FillArgs) -> Result<Self, Failure> {
        match (a.fill, &a.basis) {
            (None, _) => Ok(Self::None),
            (Some(How::Pca), Some(path)) => {
                let (file, checksum) = open_basis(path)?;
                Ok(Self::Basis(Box::new(file), checksum))
            }
            (_, Some(_)) => Err(Failure::Message("found --basis with --fill model; expected --fill pca".to_owned())),
            (_, None) => Ok(Self::Model),
        }
    }

    /// Bins per angle, where nobody asked for others.
    pub(super) fn resolution(&self) -> Resolution {
        if let Self::Basis(file, _) = self { file.grid.resolution() } else { Resolution::MERL }
    }

    /// The table with its holes filled, `None` unless that was asked for, and a finding that says so.
    pub(super) fn fill(
        &self,
        photos: &mut Photos,
        measured: &HalfAngle,
        fits: Option<&brdf_fit::Answer<'_>>,
        scale: &Scale,
    ) -> Result<Option<Filling>, Failure> {
        let (by, filled) = match (self, fits) {
            (Self::None, _) => return Ok(None),
            (Self::Model, None) => {
                return Err(Failure::Message(
                    "found no fit to fill with; expected one that succeeds, or --fill pca".to_owned(),
                ));
            }
            (Self::Model, Some(answer)) => {
                let fit = &answer.fits[brdf_fit::best(answer)];
                (FilledBy::Model(fit.template.to_string()), Filled::by_model(measured, fit.brdf.as_ref()))
            }
            (Self::Basis(file, checksum), _) => {
                (FilledBy::Basis(checksum.short()), Filled::by_basis(measured, file).map_err(message)?)
            }
        };
        let counts = [Known::Measured, Known::Inferred].map(|k| filled.count(k));
        let words =
            format!("{} bins that were not measured are filled by {by}, beside {} measured ones", counts[1], counts[0]);
        let relative = matches!((scale, &by), (Scale::Relative { .. }, FilledBy::Basis(_)));
        photos.findings.push(if relative {
            Finding::warning("K028", words)
                .hint("the basis knows absolute values and the result is relative: state strengths or a reference")
        } else {
            Finding::info("K028", words).hint("they are marked as inferred and have no standard error")
        });
        Ok(Some(Filling { by, filled }))
    }
}
