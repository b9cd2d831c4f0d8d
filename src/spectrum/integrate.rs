//! The contract under which a spectrum is integrated against a weighting function, and a bound on its error.
//!
//! Every rule is linear in the samples, so a rule, a weighting and a grid are compiled once into one weight per sample
//! ([`weights`]); each spectrum on that grid then costs a dot product.
//!
//! | rule | what is summed | where it is right |
//! |---|---|---|
//! | [`Rule::Summation`] | Δλ Σ S(λᵢ) w(λᵢ) | CIE 15:2018, 7.1: equal steps of 1 nm or 5 nm. The default up to 5 nm |
//! | [`Rule::Trapezoid`] | trapezoids of the product S·w, the ends of a range or band interpolated | equal or unequal steps |
//! | [`Rule::Exact`] | the integral of the straight lines between samples times those between the table's entries, without further error | unequal or coarse steps. The default there |
//! | [`Rule::Lines`] | Σ S(λᵢ) w(λᵢ) | line spectra; the only rule for them |
//!
//! Where the weighting is not tabulated it is zero. Between its entries it is a straight line.

use std::borrow::Cow;

use serde::Serialize;

use super::{Grid, Sampling, Spectrum};
use crate::math::interpolate;

/// A weighting function of wavelength: straight lines between its entries, zero beyond them.
#[derive(Debug, Clone, PartialEq)]
pub struct Weighting {
    wavelengths_nm: Cow<'static, [f64]>,
    values: Cow<'static, [f64]>,
    /// The weighting ends in a step and not by fading out: a trapezoid must not lean over its end.
    sharp: bool,
}

/// Beyond any wavelength; the knots of weightings that are not bounded by a table.
const UNBOUNDED_NM: f64 = 1e12;

impl Weighting {
    /// The entries of a table: ascending wavelengths in nm and one value each.
    ///
    /// # Panics
    /// Where the two differ in length or have fewer than two entries.
    pub fn table(wavelengths_nm: impl Into<Cow<'static, [f64]>>, values: impl Into<Cow<'static, [f64]>>) -> Self {
        let (wavelengths_nm, values) = (wavelengths_nm.into(), values.into());
        assert_eq!(wavelengths_nm.len(), values.len(), "a weighting has one value per wavelength");
        assert!(wavelengths_nm.len() > 1, "a weighting has at least two entries");
        Self { wavelengths_nm, values, sharp: false }
    }

    /// One at every wavelength: the integral is that of the spectrum itself.
    #[must_use]
    pub fn unity() -> Self {
        Self::table(vec![0.0, UNBOUNDED_NM], vec![1.0, 1.0])
    }

    /// Proportional to wavelength (nm) from `low_nm` to `high_nm` and zero elsewhere, as photon numbers are.
    #[must_use]
    pub fn wavelength_between(low_nm: f64, high_nm: f64) -> Self {
        Self { sharp: true, ..Self::table(vec![low_nm, high_nm], vec![low_nm, high_nm]) }
    }

    /// Proportional to wavelength (nm) everywhere.
    #[must_use]
    pub fn wavelength() -> Self {
        Self::wavelength_between(0.0, UNBOUNDED_NM)
    }

    /// One from `low_nm` to `high_nm`, zero elsewhere.
    #[must_use]
    pub fn band(low_nm: f64, high_nm: f64) -> Self {
        Self { sharp: true, ..Self::table(vec![low_nm, high_nm], vec![1.0, 1.0]) }
    }

    /// The part of a table at and above one of its wavelengths, which ends there in a step.
    ///
    /// # Panics
    /// Where fewer than two entries are left.
    #[must_use]
    pub fn from(&self, low_nm: f64) -> Self {
        let first = self.wavelengths_nm.partition_point(|w| *w < low_nm);
        let part = Self::table(self.wavelengths_nm[first..].to_vec(), self.values[first..].to_vec());
        Self { sharp: true, ..part }
    }

    /// The value at a wavelength.
    #[must_use]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let (low, high) = self.range_nm();
        if wavelength_nm < low || wavelength_nm > high {
            return 0.0;
        }
        interpolate::linear(&self.wavelengths_nm, &self.values, wavelength_nm)
    }

    /// The two entries between which a wavelength lies and their shares in the value there; none of either outside.
    fn entries_at(&self, wavelength_nm: f64) -> [(usize, f64); 2] {
        let x = &self.wavelengths_nm;
        let i = interpolate::interval(x, wavelength_nm);
        let t = (wavelength_nm - x[i]) / (x[i + 1] - x[i]);
        if (0.0..=1.0).contains(&t) { [(i, 1.0 - t), (i + 1, t)] } else { [(i, 0.0), (i + 1, 0.0)] }
    }

    /// First and last wavelength of the table, nm.
    #[must_use]
    pub fn range_nm(&self) -> (f64, f64) {
        (self.wavelengths_nm[0], self.wavelengths_nm[self.wavelengths_nm.len() - 1])
    }

    /// The entries' wavelengths, nm.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// The entries' values.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// This weighting times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            wavelengths_nm: self.wavelengths_nm.clone(),
            values: self.values.iter().map(|v| v * factor).collect::<Vec<_>>().into(),
            sharp: self.sharp,
        }
    }

    /// ∫ |w| dλ from `low_nm` to `high_nm`.
    fn absolute_integral(&self, low_nm: f64, high_nm: f64) -> f64 {
        let (first, last) = self.range_nm();
        let (low, high) = (low_nm.max(first), high_nm.min(last));
        if low >= high {
            return 0.0;
        }
        self.pieces(low, high).map(|(a, b)| 0.5 * (b - a) * (self.at(a).abs() + self.at(b).abs())).sum()
    }

    /// The parts of `[low, high]` between the table's entries.
    fn pieces(&self, low: f64, high: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let x = &self.wavelengths_nm;
        let from = x.partition_point(|&v| v <= low);
        let to = x.partition_point(|&v| v < high);
        let inner = x[from..to.max(from)].iter().copied();
        let starts = std::iter::once(low).chain(inner.clone());
        let ends = inner.chain(std::iter::once(high));
        starts.zip(ends)
    }
}

/// A rule of integration as carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rule {
    /// Δλ Σ S w (CIE 15:2018, 7.1).
    Summation,
    /// Trapezoids of the product.
    Trapezoid,
    /// The exact integral of the two piecewise-linear functions' product.
    Exact,
    /// Σ S w over lines of no width.
    Lines,
}

impl Rule {
    /// The lower-case word used on the command line and in JSON.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Summation => "summation",
            Self::Trapezoid => "trapezoid",
            Self::Exact => "exact",
            Self::Lines => "lines",
        }
    }
}

/// The coarsest steps that are summed by default, nm: CIE 15:2018, 7.1 knows sums over 1 nm and 5 nm. (A little more than 5,
/// for steps computed from printed wavelengths.)
const COARSEST_SUM_NM: f64 = 5.0001;

/// How to integrate: the rule (`None` chooses by the grid) and the range, both printed with every number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Contract {
    /// The rule; `None` takes [`Rule::Summation`] on equal steps up to 5 nm and [`Rule::Exact`] otherwise.
    pub rule: Option<Rule>,
    /// Wavelengths in nm beyond which nothing counts, both ends included; `None` for all there is.
    pub range_nm: Option<(f64, f64)>,
}

/// Why a rule cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RuleError {
    /// Summation needs one Δλ.
    #[error(
        "summation of samples with unequal steps (up to {widest_step_nm} nm); expected equal steps, or the rule trapezoid or exact, or --resample"
    )]
    NotUniform {
        /// The widest step, nm.
        widest_step_nm: f64,
    },
    /// The line rule needs a line spectrum, and the other way round.
    #[error("the rule `{}` on a {} spectrum; expected {}", rule.word(), if *lines { "line" } else { "continuous" }, if *lines { "the rule lines" } else { "summation, trapezoid or exact" })]
    Sampling {
        /// The rule asked for.
        rule: Rule,
        /// The spectrum is one of lines.
        lines: bool,
    },
}

impl Contract {
    /// The rule that this contract means on a grid.
    ///
    /// # Errors
    /// [`RuleError`] where the rule asked for does not fit the grid or the sampling.
    pub fn rule_on(&self, grid: &Grid, sampling: Sampling) -> Result<Rule, RuleError> {
        let lines = sampling == Sampling::Lines;
        let uniform = grid.step_nm().is_some();
        match self.rule {
            None if lines => Ok(Rule::Lines),
            None if grid.step_nm().is_some_and(|step| step <= COARSEST_SUM_NM) => Ok(Rule::Summation),
            None => Ok(Rule::Exact),
            Some(rule) if lines != (rule == Rule::Lines) => Err(RuleError::Sampling { rule, lines }),
            Some(Rule::Summation) if !uniform => Err(RuleError::NotUniform { widest_step_nm: grid.widest_step_nm() }),
            Some(rule) => Ok(rule),
        }
    }
}

/// One weight per sample of `grid`, so that Σ weightᵢ·valueᵢ is the integral of the spectrum times `weighting`.
///
/// # Errors
/// [`RuleError`] where the contract's rule does not fit.
pub fn weights(
    grid: &Grid,
    sampling: Sampling,
    weighting: &Weighting,
    contract: &Contract,
) -> Result<Vec<f64>, RuleError> {
    Ok(Quadrature::new(grid, sampling, weighting, contract)?.weights(&weighting.values))
}

/// A rule on one grid for weightings tabulated at the same wavelengths.
///
/// Weights are linear in the entries of the table; their factors depend on wavelengths alone and are found once, however many
/// columns the table has.
#[derive(Debug, Clone, PartialEq)]
pub struct Quadrature {
    samples: usize,
    /// By sample, then by entry.
    terms: Vec<Term>,
}

/// What one entry of the table adds to the weight of one sample, per unit of its value.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Term {
    sample: usize,
    entry: usize,
    factor: f64,
}

impl Quadrature {
    /// The rule that `contract` means on `grid`, for weightings with the wavelengths of `weighting`.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit.
    pub fn new(grid: &Grid, sampling: Sampling, weighting: &Weighting, contract: &Contract) -> Result<Self, RuleError> {
        let rule = contract.rule_on(grid, sampling)?;
        let x = grid.wavelengths_nm();
        let (first, last) = grid.range_nm();
        let (low, high) = contract.range_nm.unwrap_or((0.0, UNBOUNDED_NM));
        let (table_low, table_high) = weighting.range_nm();
        let (from, to) = (low.max(table_low).max(first), high.min(table_high).min(last));
        Ok(match (rule, grid.step_nm()) {
            (Rule::Summation, Some(step)) => Self::points(x, weighting, (low, high), step),
            (Rule::Trapezoid, _) if weighting.sharp => Self::trapezoid(x, weighting, from, to),
            (Rule::Trapezoid, _) => Self::trapezoid(x, weighting, low.max(first), high.min(last)),
            (Rule::Exact, _) => Self::exact(x, weighting, from, to),
            (Rule::Summation | Rule::Lines, _) => Self::points(x, weighting, (low, high), 1.0),
        })
    }

    /// The weighting at each sample times a step.
    fn points(x: &[f64], weighting: &Weighting, (low, high): (f64, f64), step: f64) -> Self {
        let mut out = Self { samples: x.len(), terms: Vec::new() };
        for (i, &w) in x.iter().enumerate() {
            if (low..=high).contains(&w) {
                out.add(i, step, weighting, w);
            }
        }
        out
    }

    /// Trapezoids of the product from `from` to `to`; at those ends the spectrum is interpolated and the weighting looked up.
    fn trapezoid(x: &[f64], weighting: &Weighting, from: f64, to: f64) -> Self {
        let mut out = Self { samples: x.len(), terms: Vec::new() };
        for (i, w) in x.windows(2).enumerate() {
            let (a, b) = (w[0].max(from), w[1].min(to));
            if a >= b {
                continue;
            }
            for end in [a, b] {
                let half = 0.5 * (b - a);
                let t = (end - w[0]) / (w[1] - w[0]);
                out.add(i, half * (1.0 - t), weighting, end);
                out.add(i + 1, half * t, weighting, end);
            }
        }
        out.merged()
    }

    /// ∫ φᵢ w dλ for the hat function φᵢ of each sample. On each piece φ and w are straight lines, and the integral of their
    /// product is (q − p)/6 · (φₚ(2wₚ + w_q) + φ_q(wₚ + 2w_q)).
    fn exact(x: &[f64], weighting: &Weighting, from: f64, to: f64) -> Self {
        let mut out = Self { samples: x.len(), terms: Vec::new() };
        for (i, w) in x.windows(2).enumerate() {
            let (a, b) = (w[0].max(from), w[1].min(to));
            if a >= b {
                continue;
            }
            let h = w[1] - w[0];
            for (p, q) in weighting.pieces(a, b) {
                let sixth = (q - p) / 6.0;
                let (tp, tq) = ((p - w[0]) / h, (q - w[0]) / h);
                for (sample, fp, fq) in [(i, 1.0 - tp, 1.0 - tq), (i + 1, tp, tq)] {
                    out.add(sample, sixth * (2.0 * fp + fq), weighting, p);
                    out.add(sample, sixth * (fp + 2.0 * fq), weighting, q);
                }
            }
        }
        out.merged()
    }

    /// Adds to the weight of `sample` a factor times the weighting at a wavelength.
    fn add(&mut self, sample: usize, factor: f64, weighting: &Weighting, wavelength_nm: f64) {
        let entries = weighting.entries_at(wavelength_nm).into_iter().filter(|(_, share)| *share != 0.0);
        self.terms.extend(entries.map(|(entry, share)| Term { sample, entry, factor: factor * share }));
    }

    /// In order, one term for each pair.
    fn merged(mut self) -> Self {
        self.terms.sort_by_key(|t| (t.sample, t.entry));
        self.terms.dedup_by(|next, kept| {
            let same = (next.sample, next.entry) == (kept.sample, kept.entry);
            if same {
                kept.factor += next.factor;
            }
            same
        });
        self
    }

    /// One weight per entry of the table for the spectrum of these values: Σ weightⱼ·entryⱼ is the same integral, seen as one of the
    /// weighting.
    ///
    /// # Panics
    /// Where there are fewer values than samples, or fewer than `entries` wavelengths in the table.
    #[must_use]
    pub fn entries(&self, values: &[f64], entries: usize) -> Vec<f64> {
        let mut out = vec![0.0; entries];
        for term in &self.terms {
            out[term.entry] += term.factor * values[term.sample];
        }
        out
    }

    /// One weight per sample for the weighting of these values, one per wavelength of the table.
    ///
    /// # Panics
    /// Where there are fewer values than wavelengths.
    #[must_use]
    pub fn weights(&self, values: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.samples];
        for term in &self.terms {
            out[term.sample] += term.factor * values[term.entry];
        }
        out
    }
}

/// Σ weightᵢ·valueᵢ in eight independent partial sums, which a compiler turns into vector code; the rounding error of a
/// sum of n terms is then about n/8 units in the last place at most, instead of n.
#[must_use]
pub fn dot(weights: &[f64], values: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut sums = [0.0_f64; LANES];
    let (w, v) = (weights.chunks_exact(LANES), values.chunks_exact(LANES));
    let rest: f64 = w.remainder().iter().zip(v.remainder()).map(|(a, b)| a * b).sum();
    for (w, v) in w.zip(v) {
        for k in 0..LANES {
            sums[k] += w[k] * v[k];
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (b + f)) + ((c + g) + (d + h)) + rest
}

/// The weights of `N` integrals on one grid side by side, sample by sample: the integrals of many spectra as a product of
/// matrices, (spectra × samples) · (samples × N).
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix<const N: usize> {
    by_sample: Vec<[f64; N]>,
}

impl<const N: usize> Matrix<N> {
    /// Spectra summed at a time: their sums fit the vector registers, and a weight once read serves them all.
    const ROWS: usize = 4;

    /// The columns, one [`weights`] each.
    ///
    /// # Panics
    /// Where they differ in length.
    #[must_use]
    pub fn new(columns: [&[f64]; N]) -> Self {
        let samples = columns.first().map_or(0, |c| c.len());
        assert!(columns.iter().all(|c| c.len() == samples), "all weights are of one grid");
        Self { by_sample: (0..samples).map(|i| columns.map(|c| c[i])).collect() }
    }

    /// The integrals of the spectra in `values`, one spectrum after the other, each as long as the grid.
    ///
    /// # Panics
    /// Where `values` does not hold as many spectra as `out`.
    pub fn integrals(&self, values: &[f64], out: &mut [[f64; N]]) {
        let samples = self.by_sample.len();
        assert_eq!(values.len(), samples * out.len(), "as many values as spectra times samples");
        if samples == 0 {
            return out.fill([0.0; N]);
        }
        let mut blocks = values.chunks_exact(samples * Self::ROWS);
        let mut outs = out.chunks_exact_mut(Self::ROWS);
        for (block, out) in blocks.by_ref().zip(outs.by_ref()) {
            let (ab, cd) = block.split_at(2 * samples);
            let ((a, b), (c, d)) = (ab.split_at(samples), cd.split_at(samples));
            let mut sums = [[0.0; N]; 4];
            for ((((w, a), b), c), d) in self.by_sample.iter().zip(a).zip(b).zip(c).zip(d) {
                for (sum, v) in sums.iter_mut().zip([a, b, c, d]) {
                    for (s, w) in sum.iter_mut().zip(w) {
                        *s += v * w;
                    }
                }
            }
            out.copy_from_slice(&sums);
        }
        for (row, out) in blocks.remainder().chunks_exact(samples).zip(outs.into_remainder()) {
            *out = [0.0; N];
            for (w, v) in self.by_sample.iter().zip(row) {
                for (s, w) in out.iter_mut().zip(w) {
                    *s += v * w;
                }
            }
        }
    }
}

/// A bound on the error of one integral, relative to the integral.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorBound {
    /// From the parts of the weighting that lie beyond the samples, if the spectrum there is nowhere larger than its
    /// largest sample. `None` where the integral is zero.
    pub truncation_relative: Option<f64>,
    /// From what happens between samples: the rule's distance from the exact integral of straight lines between them, plus
    /// ⅛h²|S″| weighted, S″ being the larger of the second differences at either end of each interval. A structure
    /// narrower than the step is invisible to this bound as to the data. `None` where the integral is zero.
    pub step_relative: Option<f64>,
}

/// What [`ErrorBound`]s of spectra on one grid need, compiled once.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorModel {
    sampling: Sampling,
    exact: Vec<f64>,
    intervals: Vec<f64>,
    outside: f64,
}

impl ErrorModel {
    /// The model for spectra on `grid` weighted with `weighting` inside the contract's range.
    #[must_use]
    pub fn new(grid: &Grid, sampling: Sampling, weighting: &Weighting, contract: &Contract) -> Self {
        let x = grid.wavelengths_nm();
        let (table_low, table_high) = weighting.range_nm();
        let (low, high) = contract.range_nm.unwrap_or((0.0, UNBOUNDED_NM));
        let (low, high) = (low.max(table_low), high.min(table_high));
        let (first, last) = grid.range_nm();
        let exact = Quadrature::exact(x, weighting, low.max(first), high.min(last)).weights(&weighting.values);
        let intervals = x.windows(2).map(|w| weighting.absolute_integral(w[0].max(low), w[1].min(high))).collect();
        let outside =
            weighting.absolute_integral(low, first.min(high)) + weighting.absolute_integral(last.max(low), high);
        Self { sampling, exact, intervals, outside }
    }

    /// The bound for a spectrum on the model's grid whose integral under the contract came out as `integral`.
    #[must_use]
    pub fn bound(&self, spectrum: &Spectrum, integral: f64) -> ErrorBound {
        if integral == 0.0 {
            return ErrorBound { truncation_relative: None, step_relative: None };
        }
        if self.sampling == Sampling::Lines {
            return ErrorBound { truncation_relative: Some(0.0), step_relative: Some(0.0) };
        }
        let (x, y) = (spectrum.wavelengths_nm(), spectrum.values());
        let largest = y.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        // Second derivative at each inner sample, from the divided difference of three.
        let curvature = |i: usize| {
            if i == 0 || i + 1 >= x.len() {
                return 0.0;
            }
            let (left, right) = (x[i] - x[i - 1], x[i + 1] - x[i]);
            (2.0 * ((y[i + 1] - y[i]) / right - (y[i] - y[i - 1]) / left) / (left + right)).abs()
        };
        let mut between = 0.0;
        let mut here = curvature(0);
        for (i, weight) in self.intervals.iter().enumerate() {
            let next = curvature(i + 1);
            let h = x[i + 1] - x[i];
            between += 0.125 * h * h * here.max(next) * weight;
            here = next;
        }
        let rule = (integral - dot(&self.exact, y)).abs();
        ErrorBound {
            truncation_relative: Some(largest * self.outside / integral.abs()),
            step_relative: Some((rule + between) / integral.abs()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle of height 1 on 500–600 nm, tabulated each 10 nm.
    fn triangle() -> Weighting {
        let x: Vec<f64> = (0..=10).map(|i| 500.0 + 10.0 * f64::from(i)).collect();
        let y: Vec<f64> = x.iter().map(|w| 1.0 - (w - 550.0).abs() / 50.0).collect();
        Weighting::table(x, y)
    }

    fn integral(x: Vec<f64>, y: &[f64], rule: Rule, range_nm: Option<(f64, f64)>) -> f64 {
        let grid = Grid::new(x).expect("ascending");
        let contract = Contract { rule: Some(rule), range_nm };
        dot(&weights(&grid, Sampling::Density, &triangle(), &contract).expect("rule fits"), y)
    }

    #[test]
    fn exact_is_exact_on_any_grid() {
        // ∫ (λ − 500) · triangle dλ = 50 · 50 by symmetry; two samples carry the straight line λ − 500.
        let two = integral(vec![400.0, 700.0], &[-100.0, 200.0], Rule::Exact, None);
        assert!((two - 2500.0).abs() < 1e-9, "{two}");
        let uneven =
            integral(vec![499.0, 513.3, 551.7, 580.0, 601.0], &[-1.0, 13.3, 51.7, 80.0, 101.0], Rule::Exact, None);
        assert!((uneven - 2500.0).abs() < 1e-9, "{uneven}");
        // Clipped to the left half: ∫ (λ−500)·(λ−500)/50 from 500 to 550 = 50²/3.
        let half = integral(vec![400.0, 700.0], &[-100.0, 200.0], Rule::Exact, Some((400.0, 550.0)));
        assert!((half - 2500.0 / 3.0).abs() < 1e-9, "{half}");
    }

    #[test]
    fn trapezoid_and_summation_of_a_constant() {
        let x: Vec<f64> = (0..=10).map(|i| 500.0 + 10.0 * f64::from(i)).collect();
        let ones = vec![1.0; 11];
        for rule in [Rule::Trapezoid, Rule::Summation, Rule::Exact] {
            assert!((integral(x.clone(), &ones, rule, None) - 50.0).abs() < 1e-12);
        }
        // Summation counts both ends of a range in full, the trapezoid half: 0.5 + … + 1 + … + 0.5 from 525 to 575.
        let x: Vec<f64> = (0..=20).map(|i| 500.0 + 5.0 * f64::from(i)).collect();
        let ones = vec![1.0; 21];
        let (sum, trap) = (
            integral(x.clone(), &ones, Rule::Summation, Some((525.0, 575.0))),
            integral(x, &ones, Rule::Trapezoid, Some((525.0, 575.0))),
        );
        assert!((sum - (37.5 + 2.5)).abs() < 1e-12, "{sum}");
        assert!((trap - 37.5).abs() < 1e-12, "{trap}");
    }

    #[test]
    fn a_matrix_is_as_many_dot_products() {
        let columns: [Vec<f64>; 3] = [0.3, 1.7, 2.9].map(|f: f64| (0..13).map(|i| (f * f64::from(i)).sin()).collect());
        let matrix = Matrix::new(columns.each_ref().map(Vec::as_slice));
        // Whole blocks and every remainder, none included.
        for count in 0..=9 {
            let values: Vec<f64> = (0..13 * count).map(|i| (0.1 * i as f64).cos()).collect();
            let mut out = vec![[f64::NAN; 3]; count];
            matrix.integrals(&values, &mut out);
            for (row, got) in values.chunks_exact(13).zip(&out) {
                for (column, got) in columns.iter().zip(got) {
                    assert!((dot(column, row) - got).abs() < 1e-14, "{count} rows: {got}");
                }
            }
        }
    }

    #[test]
    fn columns_of_one_table_share_their_factors() {
        // Twice the triangle from the factors of the triangle, on an irregular grid and a clipped range.
        let grid = Grid::new(vec![490.0, 503.0, 541.5, 560.0, 577.0, 590.0]).expect("ascending");
        let double: Vec<f64> = triangle().values().iter().map(|v| 2.0 * v).collect();
        for rule in [Rule::Trapezoid, Rule::Exact] {
            let contract = Contract { rule: Some(rule), range_nm: Some((495.0, 585.0)) };
            let factors = Quadrature::new(&grid, Sampling::Density, &triangle(), &contract).expect("fits");
            let direct = weights(&grid, Sampling::Density, &triangle().scaled(2.0), &contract).expect("fits");
            assert_eq!(factors.weights(&double), direct);
        }
    }

    #[test]
    fn rules_that_do_not_fit_are_refused() {
        let grid = Grid::new(vec![400.0, 410.0, 430.0]).expect("ascending");
        let contract = |rule| Contract { rule: Some(rule), range_nm: None };
        assert!(matches!(
            contract(Rule::Summation).rule_on(&grid, Sampling::Density),
            Err(RuleError::NotUniform { .. })
        ));
        assert!(contract(Rule::Exact).rule_on(&grid, Sampling::Lines).is_err());
        assert!(contract(Rule::Lines).rule_on(&grid, Sampling::Density).is_err());
        assert_eq!(Contract::default().rule_on(&grid, Sampling::Density), Ok(Rule::Exact));
    }

    #[test]
    fn the_bound_holds_for_gaussians_of_every_width_and_step() {
        // The truth is a fine exact integral of the Gaussian itself; the bound must cover each coarser sampling of it
        // that still resolves it (step ≤ σ).
        for sigma in [8.0, 15.0, 40.0] {
            for centre in [520.0, 547.3, 590.0] {
                let gauss = |w: f64| (-0.5 * ((w - centre) / sigma).powi(2)).exp();
                let sample = |step: f64| {
                    let n = (400.0 / step) as usize + 1;
                    let grid = Grid::uniform(350.0, step, n).expect("ascending");
                    let values: Vec<f64> = grid.wavelengths_nm().iter().map(|&w| gauss(w)).collect();
                    Spectrum::density(grid, values).expect("finite")
                };
                let fine = sample(0.05);
                let truth = dot(
                    &weights(
                        fine.grid(),
                        Sampling::Density,
                        &triangle(),
                        &Contract { rule: Some(Rule::Exact), range_nm: None },
                    )
                    .expect("fits"),
                    fine.values(),
                );
                for step in [1.0, 2.0, 4.0, 8.0] {
                    let s = sample(step);
                    for rule in [Rule::Summation, Rule::Trapezoid, Rule::Exact] {
                        let contract = Contract { rule: Some(rule), range_nm: None };
                        let got = dot(
                            &weights(s.grid(), Sampling::Density, &triangle(), &contract).expect("fits"),
                            s.values(),
                        );
                        let bound = ErrorModel::new(s.grid(), Sampling::Density, &triangle(), &contract).bound(&s, got);
                        let error = (got / truth - 1.0).abs();
                        let step_bound = bound.step_relative.expect("not zero");
                        assert!(
                            error <= step_bound * 1.2 + 1e-6,
                            "σ {sigma} at {centre}, step {step}, {rule:?}: {error} > {step_bound}"
                        );
                    }
                }
            }
        }
    }
}
