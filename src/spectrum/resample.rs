//! Bringing a spectrum to another grid, with the interpolation and the extrapolation named by the caller.

use std::sync::Arc;

use serde::Serialize;

use super::{Grid, Sampling, Spectrum};
use crate::math::interpolate;

/// How values between samples are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Interpolation {
    /// Straight lines. Never overshoots; right for irregular and line-like spectra.
    Linear,
    /// Sprague's fifth-order polynomials (CIE 167:2005), for equally spaced smooth data; needs six samples.
    Sprague,
    /// Natural cubic spline.
    Cubic,
    /// Piecewise cubic Hermite that keeps monotone data monotone.
    Pchip,
}

impl Interpolation {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Sprague, Self::Cubic, Self::Pchip];

    /// Its name on the command line and in results.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Sprague => "sprague",
            Self::Cubic => "cubic",
            Self::Pchip => "pchip",
        }
    }
}

/// What stands beyond the ends of the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Extrapolation {
    /// Nothing: asking is an error.
    Refuse,
    /// Zero.
    Zero,
    /// The value of the nearest sample (CIE 15:2018, 9.3 advises it where the truth is unknown).
    Constant,
    /// The line through the two nearest samples; may go negative.
    Linear,
}

/// Why a spectrum was not resampled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ResampleError {
    /// A line spectrum has nothing between its lines.
    #[error("a line spectrum cannot be resampled: nothing lies between its lines")]
    Lines,
    /// The target reaches beyond the samples and extrapolation was not asked for.
    #[error(
        "the target grid {target_low}–{target_high} nm reaches beyond the samples {low}–{high} nm; expected a grid inside them, or an extrapolation (zero, constant, linear)"
    )]
    Outside {
        /// Shortest wavelength wanted.
        target_low: f64,
        /// Longest wavelength wanted.
        target_high: f64,
        /// Shortest wavelength there is.
        low: f64,
        /// Longest wavelength there is.
        high: f64,
    },
    /// Sprague's method needs equal spacing.
    #[error(
        "Sprague interpolation of {samples} samples with steps up to {widest_step_nm} nm; expected at least 6 equally spaced ones"
    )]
    NotUniform {
        /// Number of samples.
        samples: usize,
        /// The widest step, nm.
        widest_step_nm: f64,
    },
}

/// The spectrum's values at the wavelengths of `target`.
///
/// Values at wavelengths that the source holds come out unchanged.
///
/// # Errors
/// [`ResampleError`]: lines, a target beyond the samples under [`Extrapolation::Refuse`], Sprague on an irregular grid.
pub fn resample(
    spectrum: &Spectrum,
    target: Arc<Grid>,
    interpolation: Interpolation,
    extrapolation: Extrapolation,
) -> Result<Spectrum, ResampleError> {
    if spectrum.sampling() == Sampling::Lines {
        return Err(ResampleError::Lines);
    }
    let (x, y) = (spectrum.wavelengths_nm(), spectrum.values());
    let (low, high) = spectrum.grid().range_nm();
    let (target_low, target_high) = target.range_nm();
    if extrapolation == Extrapolation::Refuse && (target_low < low || target_high > high) {
        return Err(ResampleError::Outside { target_low, target_high, low, high });
    }
    if interpolation == Interpolation::Sprague && (x.len() < 6 || spectrum.grid().step_nm().is_none()) {
        return Err(ResampleError::NotUniform { samples: x.len(), widest_step_nm: spectrum.grid().widest_step_nm() });
    }
    let slopes = match interpolation {
        Interpolation::Cubic => interpolate::spline_slopes(x, y),
        Interpolation::Pchip => interpolate::pchip_slopes(x, y),
        Interpolation::Linear | Interpolation::Sprague => Vec::new(),
    };
    let inside = |at: f64| match interpolation {
        Interpolation::Linear => interpolate::linear(x, y, at),
        Interpolation::Cubic | Interpolation::Pchip => interpolate::hermite(x, y, &slopes, at),
        Interpolation::Sprague => {
            let i = interpolate::interval(x, at);
            interpolate::sprague(y, i, (at - x[i]) / (x[i + 1] - x[i]))
        }
    };
    let beyond = |at: f64| {
        let (edge, other) = if at < low { (0, 1.min(x.len() - 1)) } else { (x.len() - 1, x.len().saturating_sub(2)) };
        match extrapolation {
            Extrapolation::Refuse | Extrapolation::Zero => 0.0,
            Extrapolation::Linear if edge != other => {
                y[edge] + (at - x[edge]) * (y[other] - y[edge]) / (x[other] - x[edge])
            }
            Extrapolation::Constant | Extrapolation::Linear => y[edge],
        }
    };
    let values = target
        .wavelengths_nm()
        .iter()
        .map(|&at| match x.binary_search_by(|v| v.total_cmp(&at)) {
            Ok(i) => y[i],
            Err(_) if (low..=high).contains(&at) => inside(at),
            Err(_) => beyond(at),
        })
        .collect();
    Ok(Spectrum { grid: target, values, sampling: Sampling::Density })
}

/// The samples that straight lines between them need to stay within `tolerance` times the largest absolute value of all that are left out: an
/// adaptive step, short where the spectrum bends.
///
/// Between the first and the last sample the one farthest from the line (along the axis of values) is kept, if it is farther than that,
/// and so on on both sides of it: D. Douglas, T. Peucker, *Cartographica* 10(2) (1973) 112. An integral of straight lines with a weighting w
/// changes by no more than `tolerance` · max |y| · ∫|w|.
///
/// # Errors
/// [`ResampleError::Lines`].
pub fn thinned(spectrum: &Spectrum, tolerance: f64) -> Result<Spectrum, ResampleError> {
    if spectrum.sampling() == Sampling::Lines {
        return Err(ResampleError::Lines);
    }
    let (x, y) = (spectrum.wavelengths_nm(), spectrum.values());
    let allowed = tolerance * y.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let mut kept = vec![false; x.len()];
    let mut open = vec![(0, x.len() - 1)];
    while let Some((a, b)) = open.pop() {
        (kept[a], kept[b]) = (true, true);
        let slope = (y[b] - y[a]) / (x[b] - x[a]);
        let off = |i: usize| (y[i] - (y[a] + (x[i] - x[a]) * slope)).abs();
        let farthest = (a + 1..b).max_by(|i, j| off(*i).total_cmp(&off(*j)));
        if let Some(farthest) = farthest.filter(|i| off(*i) > allowed) {
            open.extend([(a, farthest), (farthest, b)]);
        }
    }
    let left = |of: &[f64]| of.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(v, _)| *v).collect();
    // Ascending as the spectrum's own.
    let grid = Arc::new(Grid::new(left(x)).map_err(|_| ResampleError::Lines)?);
    Ok(Spectrum { grid, values: left(y), sampling: Sampling::Density })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_adaptive_step_keeps_corners_and_as_much_of_a_bend_as_is_asked_for() {
        let of = |f: &dyn Fn(f64) -> f64| {
            let grid = Grid::uniform(400.0, 1.0, 257).expect("ascending");
            let values = grid.wavelengths_nm().iter().map(|nm| f(*nm)).collect();
            Spectrum::density(grid, values).expect("finite")
        };
        let kept = |s: &Spectrum, t: f64| thinned(s, t).expect("a density").wavelengths_nm().to_vec();
        let triangle = of(&|nm| 1.0 - (nm - 500.0).abs() / 200.0);
        // Exact in binary but for the division: rounding is no bend.
        assert_eq!(kept(&triangle, 1e-12), [400.0, 500.0, 656.0]);
        assert_eq!(kept(&of(&|_| 2.0), 0.0), [400.0, 656.0]);
        // A chord of h nm is a h²/4 off a parabola a λ² in its middle: halved until a h²/4 ≤ t · max, each time in the middle.
        let parabola = of(&|nm| ((nm - 400.0) / 256.0).powi(2));
        for (tolerance, h) in [(0.25, 256.0), (0.24, 128.0), (0.06, 64.0), (0.25 / 1024.0, 8.0)] {
            let expected: Vec<f64> = (0..).map(|i| 400.0 + f64::from(i) * h).take_while(|nm| *nm <= 656.0).collect();
            assert_eq!(kept(&parabola, tolerance), expected, "{tolerance}");
        }
        // Nothing that is left out is farther off than allowed.
        let bump = of(&|nm| (-((nm - 530.0) / 9.0).powi(2)).exp() - 0.2 * (-((nm - 450.0) / 30.0).powi(2)).exp());
        let few = thinned(&bump, 0.01).expect("a density");
        let back =
            resample(&few, Arc::clone(bump.grid()), Interpolation::Linear, Extrapolation::Refuse).expect("inside");
        assert!(few.values().len() < 40, "{}", few.values().len());
        for (a, b) in bump.values().iter().zip(back.values()) {
            assert!((a - b).abs() <= 0.01 + 1e-15, "{a} {b}");
        }
        let lines = Spectrum::lines(Grid::new(vec![435.8, 546.1]).expect("ascending"), vec![1.0, 2.0]).expect("finite");
        assert_eq!(thinned(&lines, 0.1), Err(ResampleError::Lines));
    }

    fn spectrum(values: &[f64]) -> Spectrum {
        let grid = Grid::uniform(400.0, 10.0, values.len()).expect("ascending");
        Spectrum::density(grid, values.to_vec()).expect("finite")
    }

    #[test]
    fn beyond_the_ends_the_policy_decides() {
        let s = spectrum(&[1.0, 2.0, 4.0]);
        let target = Arc::new(Grid::new(vec![390.0, 405.0, 430.0]).expect("ascending"));
        let at = |e| resample(&s, Arc::clone(&target), Interpolation::Linear, e).map(|s| s.values().to_vec());
        assert!(matches!(at(Extrapolation::Refuse), Err(ResampleError::Outside { .. })));
        assert_eq!(at(Extrapolation::Zero), Ok(vec![0.0, 1.5, 0.0]));
        assert_eq!(at(Extrapolation::Constant), Ok(vec![1.0, 1.5, 4.0]));
        assert_eq!(at(Extrapolation::Linear), Ok(vec![0.0, 1.5, 6.0]));
    }

    #[test]
    fn lines_and_short_tables_are_refused() {
        let grid = Grid::new(vec![435.8, 546.1]).expect("ascending");
        let lines = Spectrum::lines(grid, vec![1.0, 2.0]).expect("finite");
        let target = Arc::new(Grid::uniform(440.0, 1.0, 5).expect("ascending"));
        let go = |s: &Spectrum, i| resample(s, Arc::clone(&target), i, Extrapolation::Zero);
        assert_eq!(go(&lines, Interpolation::Linear), Err(ResampleError::Lines));
        let short = spectrum(&[1.0, 2.0, 3.0]);
        assert!(matches!(go(&short, Interpolation::Sprague), Err(ResampleError::NotUniform { samples: 3, .. })));
    }
}
