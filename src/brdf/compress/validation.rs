//! How well tables come back that the set does not hold.

use rayon::prelude::*;

use super::{Basis, Collection, Error, Training};

/// Components of the covariance that samples are chosen and columns inferred with.
pub const COVARIANCE: usize = 60;

/// Distances of held-out columns to what came back of them ([`Basis::distance`]), in the order of the columns fold by fold.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Number of components, and of samples.
    pub count: usize,
    /// From so many components of a basis made for that number ([`Training::basis`]).
    pub from_components: Vec<f64>,
    /// From so many samples at the bins that [`Basis::choose`] chose.
    pub from_samples: Vec<f64>,
}

/// Holds out the tables whose number modulo `folds` is 0, 1, …, trains on the others, and measures how well the held-out columns come
/// back, for each number of components and samples.
///
/// # Errors
/// [`Error::Folds`], [`Error::TooFew`], [`Error::NothingInCommon`].
pub fn cross_validate(collection: &Collection, folds: usize, counts: &[usize]) -> Result<Vec<Score>, Error> {
    let tables = collection.tables();
    if folds < 2 || tables < folds {
        return Err(Error::Folds { tables, folds });
    }
    let empty = |&count| Score { count, from_components: Vec::new(), from_samples: Vec::new() };
    let mut scores: Vec<Score> = counts.iter().map(empty).collect();
    for fold in 0..folds {
        let (rest, held) = collection.split(folds, fold);
        let (_, training) = rest.train()?;
        for score in &mut scores {
            let basis = training.basis(score.count);
            let back = |column: &&[f32]| basis.distance(&basis.reconstruct(&basis.project(column)?)?, column);
            score.from_components.extend(held.par_iter().map(back).collect::<Result<Vec<_>, _>>()?);
        }
        from_samples(&training, &held, &mut scores)?;
    }
    Ok(scores)
}

fn from_samples(training: &Training, held: &[&[f32]], scores: &mut [Score]) -> Result<(), Error> {
    let most = scores.iter().map(|s| s.count).max().unwrap_or(0);
    let covariance: Basis = training.covariance(COVARIANCE);
    let chosen = covariance.choose(most);
    for score in scores {
        let chosen = &chosen[..score.count.min(chosen.len())];
        let back = |column: &&[f32]| {
            let measured: Vec<(usize, f64)> = chosen.iter().map(|&b| (b, f64::from(column[b]))).collect();
            covariance.distance(&covariance.infer(&measured)?.values, column)
        };
        score.from_samples.extend(held.par_iter().map(back).collect::<Result<Vec<_>, _>>()?);
    }
    Ok(())
}
