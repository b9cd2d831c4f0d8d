//! Photometers: how well a responsivity follows V(λ), and what a lamp other than the calibration source makes of that
//! (ISO/CIE 19476:2014).
//!
//! ```text
//! f₁′ = Σ |s*(λ) − V(λ)| / Σ V(λ)            380–780 nm by 1 nm
//! s*(λ) = s(λ) · Σ S_C V / Σ S_C s
//! F = (∫ S_Z V · ∫ S_C s) / (∫ S_Z s · ∫ S_C V)
//! ```
//!
//! s: relative spectral responsivity; S_C: the calibration source (illuminant A); S_Z: the lamp measured. A reading times F is right.

use super::luminous::Efficiency;
use crate::constants::SecondRadiation;
use crate::illuminant::planck;
use crate::spectrum::integrate::{Contract, Quadrature, RuleError, Weighting, dot, weights};
use crate::spectrum::{Grid, Spectrum};

/// Range of f₁′, nm.
pub const RANGE_NM: (f64, f64) = (380.0, 780.0);
/// Samples of f₁′: one per nm.
const SAMPLES: usize = 401;

/// Illuminant A by its formula (CIE 15:2018, 4.1: a blackbody with c₂/T = 1.435e-2/2848 m), relative, 300–830 nm by 1 nm.
///
/// # Panics
/// Never: the grid ascends and the values are finite.
#[must_use]
pub fn illuminant_a() -> Spectrum {
    let grid = Grid::uniform(300.0, 1.0, 531).expect("ascending");
    let at = |w: f64| {
        planck::radiance(w, 2848.0, SecondRadiation::Nbs1931)
            / planck::radiance(560.0, 2848.0, SecondRadiation::Nbs1931)
    };
    let values = grid.wavelengths_nm().iter().map(|w| 100.0 * at(*w)).collect();
    Spectrum::density(grid, values).expect("finite")
}

/// A photometer's figures compiled for a grid of its responsivity, a calibration source and lamps.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Two samples of the responsivity and the share of the second, per sample of f₁′; none beyond the responsivity.
    between: Vec<Option<(usize, f64)>>,
    v: Vec<f64>,
    /// The calibration source at the samples of f₁′.
    calibration: Vec<f64>,
    /// The calibration source as V(λ) and the detector see it.
    source: Response,
    lamps: Vec<Response>,
}

/// A source as V(λ) and as a detector sees it.
#[derive(Debug, Clone, PartialEq)]
struct Response {
    photopic: f64,
    /// One weight per sample of the responsivity.
    weights: Vec<f64>,
}

impl Response {
    fn new(grid: &Grid, source: &Spectrum) -> Result<Self, RuleError> {
        let contract = Contract::default();
        let on = |w: &Weighting| weights(source.grid(), source.sampling(), w, &contract);
        let v = on(&Efficiency::Cie1924.weighting())?;
        // ∫ S s is linear in the samples of s as well as in those of S.
        let hats = Weighting::table(grid.wavelengths_nm().to_vec(), vec![0.0; grid.len()]);
        let rule = Quadrature::new(source.grid(), source.sampling(), &hats, &contract)?;
        Ok(Self { photopic: dot(&v, source.values()), weights: rule.entries(source.values(), grid.len()) })
    }
}

/// A photometer's figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// f₁′, a fraction of 1; NaN where the detector does not see the calibration source.
    pub f1_prime: f64,
    /// F of each lamp; NaN where the detector or V(λ) does not see it.
    pub mismatch_factors: Vec<f64>,
}

impl Plan {
    /// Compiles the figures for responsivities on `grid`, straight lines between its samples and nothing beyond.
    ///
    /// # Errors
    /// [`RuleError`] where a source cannot be summed; the default rule fits all.
    pub fn new(grid: &Grid, calibration: &Spectrum, lamps: &[&Spectrum]) -> Result<Self, RuleError> {
        let x = grid.wavelengths_nm();
        let (first, last) = grid.range_nm();
        let wavelengths = (0..SAMPLES).map(|i| RANGE_NM.0 + i as f64);
        let place = |w: f64| {
            if w < first || w > last {
                return None;
            }
            let i = x.partition_point(|v| *v <= w).saturating_sub(1).min(x.len().saturating_sub(2));
            let width = x.get(i + 1).map_or(1.0, |next| next - x[i]);
            Some((i, (w - x[i]) / width))
        };
        let v = Efficiency::Cie1924.weighting();
        let s_c = Weighting::table(calibration.wavelengths_nm().to_vec(), calibration.values().to_vec());
        Ok(Self {
            between: wavelengths.clone().map(place).collect(),
            v: wavelengths.clone().map(|w| v.at(w)).collect(),
            calibration: wavelengths.map(|w| s_c.at(w)).collect(),
            source: Response::new(grid, calibration)?,
            lamps: lamps.iter().map(|l| Response::new(grid, l)).collect::<Result<_, _>>()?,
        })
    }

    /// Number of lamps.
    #[must_use]
    pub fn lamps(&self) -> usize {
        self.lamps.len()
    }

    /// Writes f₁′, then the mismatch factor of every lamp, for a responsivity on the plan's grid, of any scale.
    ///
    /// # Panics
    /// Where `out` does not hold one more number than there are lamps.
    pub fn evaluate(&self, responsivity: &[f64], out: &mut [f64]) {
        let at = |place: &Option<(usize, f64)>| match *place {
            Some((i, 0.0)) => responsivity[i],
            Some((i, t)) => responsivity[i] + t * (responsivity[i + 1] - responsivity[i]),
            None => 0.0,
        };
        let samples = || self.between.iter().map(at).zip(&self.v);
        let (seen, right) = (samples().zip(&self.calibration))
            .fold((0.0, 0.0), |(seen, right), ((s, v), c)| (seen + c * s, right + c * v));
        let scale = right / seen;
        let off: f64 = samples().map(|(s, v)| (scale * s - v).abs()).sum();
        out[0] = off / self.v.iter().sum::<f64>();
        let calibrated = dot(&self.source.weights, responsivity) / self.source.photopic;
        for (lamp, out) in self.lamps.iter().zip(&mut out[1..]) {
            *out = calibrated * lamp.photopic / dot(&lamp.weights, responsivity);
        }
    }

    /// The figures of a responsivity on the plan's grid.
    #[must_use]
    pub fn figures(&self, responsivity: &[f64]) -> Figures {
        let mut out = vec![0.0; 1 + self.lamps.len()];
        self.evaluate(responsivity, &mut out);
        Figures { f1_prime: out[0], mismatch_factors: out.split_off(1) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::illuminant::named;

    fn source(name: &str) -> Spectrum {
        named::source(name, SecondRadiation::default()).expect("a source").spectrum
    }

    /// A detector whose responsivity is V(λ) shifted.
    fn shifted(by_nm: f64) -> (Grid, Vec<f64>) {
        let v = Efficiency::Cie1924.weighting();
        let grid = Grid::uniform(360.0, 1.0, 471).expect("ascending");
        let values = grid.wavelengths_nm().iter().map(|w| v.at(w - by_nm)).collect();
        (grid, values)
    }

    #[test]
    fn shifted_photometers_have_their_known_f1_prime() {
        // Computed apart from this project from CIE's tables of V(λ) and illuminant A, 380–780 nm by 1 nm, as printed.
        for (by_nm, want) in [(1.0, 0.019_103), (2.0, 0.038_067), (5.0, 0.094_127), (-3.0, 0.058_140), (0.0, 0.0)] {
            let (grid, s) = shifted(by_nm);
            let plan = Plan::new(&grid, &illuminant_a(), &[]).expect("sums");
            let got = plan.figures(&s).f1_prime;
            assert!((got - want).abs() < 5.000_001e-7, "{by_nm}: {got}");
        }
    }

    #[test]
    fn a_perfect_photometer_needs_no_correction_and_a_line_tells_the_ratio_itself() {
        let (grid, s) = shifted(0.0);
        let lamps = [source("LED-B3"), source("FL11"), source("D65"), source("line:589nm")];
        let plan = Plan::new(&grid, &source("A"), &lamps.each_ref()).expect("sums");
        assert!(plan.figures(&s).mismatch_factors.iter().all(|f| (f - 1.0).abs() < 1e-12));
        let (grid, s) = shifted(2.0);
        let plan = Plan::new(&grid, &source("A"), &lamps.each_ref()).expect("sums");
        let figures = plan.figures(&s);
        // Of a line F is s*(A)/… = V(589)/V(587) · ∫A V(λ − 2) / ∫A V, the sums being over the 5 nm of A's table.
        let a = source("A");
        let v = Efficiency::Cie1924.weighting();
        let sum = |by: f64| a.wavelengths_nm().iter().zip(a.values()).map(|(w, c)| c * v.at(w - by)).sum::<f64>();
        let want = v.at(589.0) / v.at(587.0) * sum(2.0) / sum(0.0);
        assert!((figures.mismatch_factors[3] / want - 1.0).abs() < 1e-12, "{figures:?} {want}");
        // The calibration source needs none, whatever the detector.
        let plan = Plan::new(&grid, &source("A"), &[&a]).expect("sums");
        assert!((plan.figures(&s).mismatch_factors[0] - 1.0).abs() < 1e-14);
    }
}
