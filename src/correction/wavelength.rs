//! The wavelength axis from a lamp of known lines: peaks found, matched and a polynomial fitted to them.

use nalgebra::{DMatrix, DVector};

use super::Error as Refused;
use super::lines::Line;
use super::signal::Signal;
use crate::finding::{Checked, Finding};
use crate::math::interpolate;
use crate::spectrum::Spectrum;

/// A residual so many standard deviations, found without its line, from the rest is told.
const FAR: f64 = 4.0;

/// A line so many widths at half maximum from its neighbours stands alone: of one as high a Gaussian adds 0.2 % to its crest.
const APART: f64 = 1.5;

/// Why no axis was found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Too few lines.
    #[error(
        "{matched} of {known} known lines matched to {peaks} peaks; expected at least {needed} for a polynomial of degree {degree} and its residuals"
    )]
    TooFew {
        /// Lines matched.
        matched: usize,
        /// Lines known.
        known: usize,
        /// Peaks found.
        peaks: usize,
        /// Lines needed.
        needed: usize,
        /// Degree of the polynomial.
        degree: usize,
    },
    /// The polynomial turns.
    #[error("the fitted wavelengths do not ascend near {at}; expected a lower degree or other lines")]
    Turns {
        /// Where on the axis of the file.
        at: f64,
    },
}

/// A lamp of known lines as the instrument reads it, and how its axis is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct LineLamp {
    /// Its reading, on the axis to be replaced: nominal wavelengths or pixels from 1.
    pub reading: Spectrum,
    /// The lines that it has, ascending.
    pub lines: Vec<Line>,
    /// Degree of the polynomial from the axis of the file to wavelengths.
    pub degree: usize,
    /// How far from where it is expected a line is looked for, nm.
    pub search_nm: f64,
    /// Least height of a peak, relative to the highest.
    pub threshold: f64,
    /// A first guess of the wavelengths as a polynomial of the axis, constant term first; by default the axis itself.
    pub start: Vec<f64>,
}

/// A line and the peak taken for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// The line.
    pub line: Line,
    /// Where its peak stands on the axis of the file.
    pub position: f64,
    /// Full width at half maximum of the peak, in the unit of the axis.
    pub fwhm: f64,
    /// Fitted less known wavelength, nm.
    pub residual_nm: f64,
}

/// A fitted axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// λ = Σ cₖ axisᵏ, nm, constant term first.
    pub coefficients: Vec<f64>,
    /// Standard errors of the coefficients.
    pub standard_errors: Vec<f64>,
    /// Standard deviation of the residuals, nm: √(Σr²/(lines − coefficients)).
    pub residual_nm: f64,
    /// Root mean square of what each line is off a fit to all others, nm.
    pub left_out_nm: f64,
    /// The lines fitted.
    pub matches: Vec<Match>,
    /// Lines within the range that were not used: without a peak, or not apart from a neighbour.
    pub unused: Vec<Line>,
    /// Middle and half of the range of the axis, in which the fit was made.
    scaled: (f64, f64),
    /// The polynomial over the scaled axis, and L of its covariance L Lᵀ.
    fit: (DVector<f64>, DMatrix<f64>),
}

impl Calibration {
    /// Wavelength at a place of the axis, nm.
    #[must_use]
    pub fn wavelength_nm(&self, axis: f64) -> f64 {
        powers((axis - self.scaled.0) / self.scaled.1, self.fit.0.len()).dot(&self.fit.0)
    }

    /// Standard uncertainty of the wavelength at a place of the axis, nm: that of the fit alone.
    #[must_use]
    pub fn standard_nm(&self, axis: f64) -> f64 {
        self.modes_nm(axis).norm()
    }

    /// Errors of the wavelength at a place of the axis, nm, one per independent error of the fit.
    fn modes_nm(&self, axis: f64) -> DVector<f64> {
        self.fit.1.transpose() * powers((axis - self.scaled.0) / self.scaled.1, self.fit.0.len())
    }

    /// Gives the signal its wavelengths; their errors enter as −dS/dλ times each.
    pub(super) fn apply(&self, signal: &mut Signal) -> Result<(), Refused> {
        let axis = signal.wavelengths_nm().to_vec();
        let x: Vec<f64> = axis.iter().map(|a| self.wavelength_nm(*a)).collect();
        if let Some(i) = x.windows(2).position(|w| w[1] <= w[0]) {
            return Err(Error::Turns { at: axis[i] }.into());
        }
        signal.move_to(x.clone());
        let slopes = interpolate::spline_slopes(&x, signal.values());
        let modes: Vec<DVector<f64>> = axis.iter().map(|a| self.modes_nm(*a)).collect();
        for k in 0..self.fit.0.len() {
            signal.common(slopes.iter().zip(&modes).map(|(s, m)| -s * m[k]).collect());
        }
        Ok(())
    }
}

fn powers(t: f64, count: usize) -> DVector<f64> {
    DVector::from_fn(count, |k, _| t.powi(k as i32))
}

/// A peak: place, height, full width at half maximum.
#[derive(Debug, Clone, Copy)]
struct Peak {
    position: f64,
    fwhm: f64,
}

/// Highest points of Gaussians through each local maximum and its neighbours: the vertex of the parabola through the logarithms.
fn peaks(reading: &Spectrum, threshold: f64) -> Vec<Peak> {
    let (x, y) = (reading.wavelengths_nm(), reading.values());
    let least = threshold * reading.peak().1;
    let at = |i: usize| {
        let [a, b, c] = [y[i - 1], y[i], y[i + 1]];
        if !(b >= least && b > a && b >= c && a > 0.0 && c > 0.0) {
            return None;
        }
        let (h, k) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        let (left, right) = ((b / a).ln() / h, (c / b).ln() / k);
        let curvature = 2.0 * (right - left) / (h + k);
        let slope = (left * k + right * h) / (h + k);
        (curvature < 0.0).then(|| Peak {
            position: x[i] - slope / curvature,
            // A Gaussian of variance −1/curvature.
            fwhm: (8.0 * 2f64.ln() / -curvature).sqrt(),
        })
    };
    (1..y.len().saturating_sub(1)).filter_map(at).collect()
}

/// Finds the axis.
///
/// A line is taken where the nearest peak to its expected place is within `search_nm`, and where no other known line is within one and
/// a half widths of this peak or nearest to the same peak. The polynomial is fitted with equal weights.
///
/// # Errors
/// [`Error::TooFew`].
pub fn calibrate(lamp: &LineLamp) -> Result<Checked<Calibration>, Error> {
    let guess = |axis: f64| {
        if lamp.start.is_empty() { axis } else { lamp.start.iter().rev().fold(0.0, |sum, c| sum * axis + c) }
    };
    let slope = |axis: f64| {
        let terms = lamp.start.iter().enumerate().skip(1);
        if lamp.start.is_empty() { 1.0 } else { terms.map(|(k, c)| k as f64 * c * axis.powi(k as i32 - 1)).sum() }
    };
    let found = peaks(&lamp.reading, lamp.threshold);
    let (first, last) = lamp.reading.grid().range_nm();
    let (low, high) = (guess(first).min(guess(last)) - lamp.search_nm, guess(first).max(guess(last)) + lamp.search_nm);
    let known: Vec<Line> = lamp.lines.iter().filter(|l| (low..=high).contains(&l.wavelength_nm)).copied().collect();
    let nearest = |line: &Line| {
        let off = |p: &Peak| (guess(p.position) - line.wavelength_nm).abs();
        let best = (0..found.len()).min_by(|a, b| off(&found[*a]).total_cmp(&off(&found[*b])))?;
        (off(&found[best]) <= lamp.search_nm).then_some(best)
    };
    let taken: Vec<Option<usize>> = known.iter().map(nearest).collect();
    let mut widths: Vec<f64> = found.iter().map(|p| (p.fwhm * slope(p.position)).abs()).collect();
    let own = widths.clone();
    widths.sort_by(f64::total_cmp);
    // The flank of a neighbour narrows the measured width of a peak: it counts as no narrower than most.
    let usual = widths.get(widths.len() / 2).copied().unwrap_or(0.0);
    let alone = |i: usize, peak: usize| {
        let room = APART * own[peak].max(usual);
        (0..known.len()).all(|o| {
            o == i || (taken[o] != Some(peak) && (known[o].wavelength_nm - known[i].wavelength_nm).abs() > room)
        })
    };
    let mut pairs = Vec::new();
    let mut unused = Vec::new();
    for (i, line) in known.iter().enumerate() {
        match taken[i] {
            Some(peak) if alone(i, peak) => pairs.push((*line, found[peak])),
            _ => unused.push(*line),
        }
    }
    let count = lamp.degree + 1;
    if pairs.len() <= count {
        let needed = count + 1;
        let (matched, known) = (pairs.len(), lamp.lines.len());
        return Err(Error::TooFew { matched, known, peaks: found.len(), needed, degree: lamp.degree });
    }
    let calibration = fit(&pairs, unused, count, (0.5 * (first + last), 0.5 * (last - first)));
    let findings = calibration.look((first, last));
    Ok(Checked { value: calibration, findings })
}

fn fit(pairs: &[(Line, Peak)], unused: Vec<Line>, count: usize, scaled: (f64, f64)) -> Calibration {
    let n = pairs.len();
    let scale = |axis: f64| (axis - scaled.0) / scaled.1;
    let design = DMatrix::from_fn(n, count, |r, c| scale(pairs[r].1.position).powi(c as i32));
    let known = DVector::from_fn(n, |r, _| pairs[r].0.wavelength_nm);
    let (q, r) = design.clone().qr().unpack();
    // Lines at as many places as there are coefficients or more: R has an inverse.
    let inverse = r.clone().try_inverse().unwrap_or_else(|| DMatrix::identity(count, count));
    let solution = &inverse * (q.transpose() * &known);
    let residuals = &design * &solution - &known;
    let spread = (residuals.norm_squared() / (n - count) as f64).sqrt();
    let leverage = |i: usize| q.row(i).norm_squared();
    let left_out = residuals.iter().enumerate().map(|(i, r)| (r / (1.0 - leverage(i)).max(f64::EPSILON)).powi(2));
    let left_out_nm = (left_out.sum::<f64>() / n as f64).sqrt();
    // (XᵀX)⁻¹ = R⁻¹ R⁻ᵀ.
    let errors = &inverse * spread;
    // From powers of (axis − m)/h to powers of the axis.
    let expand = DMatrix::from_fn(count, count, |k, j| {
        if k > j { 0.0 } else { choose(j, k) * (-scaled.0).powi((j - k) as i32) / scaled.1.powi(j as i32) }
    });
    let in_axis = &expand * &errors;
    let matches = pairs.iter().zip(residuals.iter());
    Calibration {
        coefficients: (&expand * &solution).iter().copied().collect(),
        standard_errors: in_axis.row_iter().map(|r| r.norm()).collect(),
        residual_nm: spread,
        left_out_nm,
        matches: matches
            .map(|((line, peak), r)| Match { line: *line, position: peak.position, fwhm: peak.fwhm, residual_nm: *r })
            .collect(),
        unused,
        scaled,
        fit: (solution, errors),
    }
}

fn choose(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n - i) as f64 / (i + 1) as f64).product()
}

impl Calibration {
    /// What there is to say about a fit over a range of the axis.
    fn look(&self, (first, last): (f64, f64)) -> Vec<Finding> {
        let mut findings = Vec::new();
        let (n, count) = (self.matches.len(), self.fit.0.len());
        let squares: f64 = self.matches.iter().map(|m| m.residual_nm.powi(2)).sum();
        if n > count + 2 {
            for m in &self.matches {
                // The standard deviation of the others, from the sum of squares without this line (leverage left out: told rather late).
                let rest = ((squares - m.residual_nm.powi(2)) / (n - count - 1) as f64).sqrt();
                if m.residual_nm.abs() > FAR * rest && rest > 0.0 {
                    let message = format!(
                        "the line at {} nm is {:+.3} nm off the fit, more than {FAR} standard deviations of the others ({rest:.3} nm)",
                        m.line.wavelength_nm, m.residual_nm
                    );
                    let hint = "the peak may be that of another line: narrow search_nm or leave the line out";
                    findings.push(Finding::warning("X004", message).hint(hint));
                }
            }
        }
        let positions = self.matches.iter().map(|m| m.position);
        let (low, high) = (positions.clone().fold(f64::INFINITY, f64::min), positions.fold(0.0, f64::max));
        let beyond = ((low - first).max(last - high)) / (last - first);
        if beyond > 0.25 {
            let message = format!(
                "the lines cover {low:.1} to {high:.1} of the axis from {first} to {last}: beyond them the polynomial is extrapolated"
            );
            findings.push(Finding::warning("X007", message).hint("add a lamp with lines there, or lower the degree"));
        }
        findings
    }
}
