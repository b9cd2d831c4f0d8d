//! The wavelengths that a render carries, and how few of them will do.
//!
//! Every reading is an integral over wavelength, Σ_b w_b · W(λ_b) · L_b, with nodes λ_b and weights w_b that are chosen before the
//! render. Colour matching functions fade out at both ends of the visible range, so that a sum over a few equally spaced nodes comes
//! close to the sum at 1 nm. How few suffice depends on the spectra of the scene, so [`Bands::choose`] tries, on the products of
//! emission and reflectances that light can meet, steps and where to begin, against the sum at 1 nm.

use crate::spectrum::integrate::Weighting;
use crate::spectrum::{Sampling, Spectrum};

/// The range over which densities are carried, nm: that of the CIE's tables of V(λ) and of the colour matching functions.
pub const RANGE_NM: (f64, f64) = (360.0, 830.0);

/// What a band's value is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    /// A node of a quadrature over a density: the band stands for so many nanometres.
    Density {
        /// The weight of the node, nm.
        nm: f64,
    },
    /// A spectral line, whose value is a whole amount.
    Line,
}

/// The bands of a render: the nodes of densities, ascending, then the lines, ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct Bands {
    wavelengths_nm: Vec<f64>,
    widths: Vec<Width>,
}

/// Bands that were chosen, and what they leave.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// The bands.
    pub bands: Bands,
    /// The greatest difference of the weightings' integrals from those at 1 nm, relative to the largest of them for each spectrum.
    pub error: f64,
    /// The greatest relative difference of the integral of a spectrum itself: of watts.
    pub radiant_error: f64,
}

/// By how much the first and the last of so many nodes stand for more than a step, nm: down to half a nanometre below [`RANGE_NM`] and up to half a
/// nanometre above it.
fn beyond(first_nm: f64, step_nm: f64, count: usize) -> [f64; 2] {
    #[expect(clippy::cast_precision_loss, reason = "some hundreds of nodes")]
    let last_nm = first_nm + (count - 1) as f64 * step_nm;
    // Nodes that begin later leave the rest out on purpose.
    let below = if first_nm - RANGE_NM.0 < step_nm { first_nm - (RANGE_NM.0 - 0.5) - 0.5 * step_nm } else { 0.0 };
    [below, RANGE_NM.1 + 0.5 - last_nm - 0.5 * step_nm]
}

impl Bands {
    /// The nodes from `first_nm` on, a step apart, up to the end of [`RANGE_NM`]. Each stands for the wavelengths that are nearest to it; at both ends of
    /// the range, half a nanometre beyond which the sums at 1 nm end, for all that are left, so that no radiant power is lost there (below the first node
    /// where that is less than a step). From 360 nm at 1 nm they are the entries of the CIE's tables.
    ///
    /// # Panics
    /// For a step that is not above 0 or leaves no node.
    #[must_use]
    pub fn uniform(first_nm: f64, step_nm: f64) -> Self {
        assert!(step_nm > 0.0, "a step between wavelengths is above 0 nm");
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of nodes")]
        let count = ((RANGE_NM.1 - first_nm) / step_nm + 1e-9).floor() as u32 + 1;
        let mut bands = Self::nodes((0..count).map(|i| first_nm + f64::from(i) * step_nm).collect(), step_nm);
        let [below, above] = beyond(first_nm, step_nm, bands.len());
        for (node, left) in [(0, below), (bands.len() - 1, above)] {
            if let Width::Density { nm } = &mut bands.widths[node] {
                *nm += left;
            }
        }
        bands
    }

    /// Nodes at the wavelengths given, ascending, each standing for `step_nm`.
    ///
    /// # Panics
    /// For no wavelength.
    #[must_use]
    pub fn nodes(wavelengths_nm: Vec<f64>, step_nm: f64) -> Self {
        assert!(!wavelengths_nm.is_empty(), "at least one band");
        let widths = vec![Width::Density { nm: step_nm }; wavelengths_nm.len()];
        Self { wavelengths_nm, widths }
    }

    /// No densities, only the lines at the wavelengths given, ascending.
    ///
    /// # Panics
    /// For no wavelength.
    #[must_use]
    pub fn lines(wavelengths_nm: Vec<f64>) -> Self {
        assert!(!wavelengths_nm.is_empty(), "at least one band");
        let widths = vec![Width::Line; wavelengths_nm.len()];
        Self { wavelengths_nm, widths }
    }

    /// These bands and, behind them, lines.
    #[must_use]
    pub fn and_lines(mut self, wavelengths_nm: &[f64]) -> Self {
        self.wavelengths_nm.extend_from_slice(wavelengths_nm);
        self.widths.extend(wavelengths_nm.iter().map(|_| Width::Line));
        self
    }

    /// The fewest equally spaced nodes on which the integrals of all `spectra` agree with the sum at 1 nm.
    ///
    /// Each spectrum is a function of wavelength (nm). The bands are those of the largest step whose difference is at most
    /// `tolerance`, begun where it is least, and that of watts as well, which counts a twentieth of it: a table that ends within the range ends between
    /// two nodes somewhere. At 1 nm there is none.
    #[must_use]
    pub fn choose(spectra: &[&dyn Fn(f64) -> f64], weightings: &[Weighting], tolerance: f64) -> Chosen {
        const WATTS: f64 = 0.05;
        const STEPS_NM: [u32; 14] = [40, 30, 25, 20, 18, 16, 15, 12, 10, 8, 5, 4, 3, 2];
        let finest = Self::uniform(RANGE_NM.0, 1.0);
        let values: Vec<Vec<f64>> =
            spectra.iter().map(|s| finest.wavelengths_nm.iter().map(|&nm| s(nm)).collect()).collect();
        let weights: Vec<Vec<f64>> = weightings.iter().map(|w| finest.weights(w)).collect();
        let radiant = [vec![1.0; finest.len()]];
        // Both rules are sums over entries of the same table: of every entry, or of one in `step` from `phase` on.
        let difference = |weights: &[Vec<f64>], phase: u32, step: u32| -> f64 {
            let first = RANGE_NM.0 + f64::from(phase);
            let nodes = (phase as usize..finest.len()).step_by(step as usize);
            let [below, above] = beyond(first, f64::from(step), nodes.len());
            let sum = |w: &[f64], v: &[f64]| -> f64 {
                let term = |i: usize| w[i] * v[i];
                let ends = below * term(phase as usize) + nodes.clone().next_back().map_or(0.0, |i| above * term(i));
                nodes.clone().map(term).sum::<f64>() * f64::from(step) + ends
            };
            let mut worst = 0.0_f64;
            for v in &values {
                let exact: Vec<f64> = weights.iter().map(|w| w.iter().zip(v).map(|(w, v)| w * v).sum()).collect();
                let scale = exact.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
                for (w, exact) in weights.iter().zip(&exact) {
                    worst = worst.max(if scale > 0.0 { (sum(w, v) - exact).abs() / scale } else { 0.0 });
                }
            }
            worst
        };
        for step in STEPS_NM {
            let found = (0..step)
                .map(|phase| (difference(&weights, phase, step), phase))
                .filter(|(error, _)| *error <= tolerance)
                .map(|(error, phase)| (error, difference(&radiant, phase, step), phase))
                .min_by(|a, b| a.0.max(WATTS * a.1).total_cmp(&b.0.max(WATTS * b.1)));
            if let Some((error, radiant_error, phase)) = found {
                let bands = Self::uniform(RANGE_NM.0 + f64::from(phase), f64::from(step));
                return Chosen { bands, error, radiant_error };
            }
        }
        Chosen { bands: finest, error: 0.0, radiant_error: 0.0 }
    }

    /// Wavelengths, nm.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// What each band's value is.
    #[must_use]
    pub fn widths(&self) -> &[Width] {
        &self.widths
    }

    /// The number of bands.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is always one band")]
    pub fn len(&self) -> usize {
        self.wavelengths_nm.len()
    }

    /// What each band adds to the integral of a spectrum with a weighting, per unit of the band's value: without any factor K_m.
    #[must_use]
    pub fn weights(&self, weighting: &Weighting) -> Vec<f64> {
        (self.wavelengths_nm.iter().zip(&self.widths))
            .map(|(&nm, width)| {
                weighting.at(nm)
                    * match *width {
                        Width::Density { nm } => nm,
                        Width::Line => 1.0,
                    }
            })
            .collect()
    }

    /// The values of an emission spectrum in the bands: of a density, straight lines between its samples and 0 beyond them, at the
    /// nodes; of lines, their amounts in the bands of their wavelengths.
    ///
    /// # Errors
    /// The wavelength of a line for which there is no band.
    pub fn emission(&self, spectrum: &Spectrum) -> Result<Vec<f64>, f64> {
        match spectrum.sampling() {
            Sampling::Density => {
                let table = as_function(spectrum);
                Ok((self.wavelengths_nm.iter().zip(&self.widths))
                    .map(|(&nm, width)| if matches!(width, Width::Line) { 0.0 } else { table.at(nm) })
                    .collect())
            }
            Sampling::Lines => {
                let mut values = vec![0.0; self.len()];
                for (&nm, amount) in spectrum.wavelengths_nm().iter().zip(spectrum.values()) {
                    let is_band = |b: &usize| self.widths[*b] == Width::Line && self.wavelengths_nm[*b] == nm;
                    let band = (0..self.len()).find(is_band).ok_or(nm)?;
                    values[band] += amount;
                }
                Ok(values)
            }
        }
    }
}

/// A density as a function of wavelength: straight lines between its samples, 0 beyond them.
#[must_use]
pub fn as_function(spectrum: &Spectrum) -> Weighting {
    let (mut nm, mut values) = (spectrum.wavelengths_nm().to_vec(), spectrum.values().to_vec());
    if nm.len() == 1 {
        // One sample of a density has no neighbours to draw a line to: it holds at its own wavelength alone.
        nm.push(nm[0].next_up());
        values.push(0.0);
    }
    Weighting::table(nm, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::K_M;
    use crate::photometry::luminous::Efficiency;

    fn v() -> Weighting {
        Efficiency::default().weighting()
    }

    /// Issue's figure: the observer's own sum at 1 nm, 683.002 applied once: 72 983.5 lx for 1 W/(m²·nm).
    #[test]
    fn a_flat_spectrum_reads_the_observers_sum() {
        let bands = Bands::uniform(360.0, 1.0);
        assert_eq!((bands.len(), bands.wavelengths_nm()[0], bands.wavelengths_nm()[470]), (471, 360.0, 830.0));
        let lux = K_M * bands.weights(&v()).iter().sum::<f64>();
        assert!((lux - 72_983.5).abs() < 0.05, "{lux}");
    }

    /// Twenty-odd nodes integrate smooth spectra to 1e-3 of what 471 do; a narrow line-like peak needs more.
    #[test]
    fn few_nodes_suffice_for_smooth_spectra_only() {
        let smooth = |nm: f64| 1.0 + 0.5 * (nm / 70.0).sin();
        let peaked = |nm: f64| (-((nm - 530.0) / 4.0).powi(2)).exp();
        let few = Bands::choose(&[&smooth], &[v()], 1e-3);
        assert!(few.bands.len() <= 24 && few.error <= 1e-3, "{few:?}");
        let many = Bands::choose(&[&smooth, &peaked], &[v()], 1e-3);
        assert!(many.bands.len() > 2 * few.bands.len() && many.error <= 1e-3, "{many:?}");
        assert_eq!(Bands::choose(&[&peaked], &[v()], 0.0).bands.len(), 471);
    }

    /// The whole range, half a nanometre more at each end, wherever the nodes begin; what differs from the sum at 1 nm is what was said to.
    #[test]
    fn no_watt_is_lost_at_the_ends() {
        for (first, step) in [(360.0, 1.0), (365.0, 10.0), (361.0, 18.0), (399.0, 40.0), (360.0, 100.0)] {
            let bands = Bands::uniform(first, step);
            let nm = bands.widths().iter().map(|w| if let Width::Density { nm } = w { *nm } else { 0.0 }).sum::<f64>();
            assert!((nm - 471.0).abs() < 1e-12 * 471.0, "{first} {step}: {nm}");
        }
        let rising = |nm: f64| (nm / 500.0).powi(4);
        let chosen = Bands::choose(&[&rising], &[v()], 1e-3);
        let watts = |bands: &Bands| -> f64 {
            let weights = bands.weights(&Weighting::table(vec![300.0, 900.0], vec![1.0, 1.0]));
            weights.iter().zip(bands.wavelengths_nm()).map(|(w, nm)| w * rising(*nm)).sum()
        };
        let exact = watts(&Bands::uniform(360.0, 1.0));
        let off = |bands: &Bands| (watts(bands) / exact - 1.0).abs();
        assert!((off(&chosen.bands) - chosen.radiant_error).abs() < 1e-12, "{chosen:?}");
        // Less than where all stand for a step.
        let nm = chosen.bands.wavelengths_nm();
        assert!(off(&chosen.bands) < off(&Bands::nodes(nm.to_vec(), nm[1] - nm[0])), "{chosen:?}");
    }

    #[test]
    fn lines_go_to_their_own_bands() {
        let bands = Bands::uniform(365.0, 10.0).and_lines(&[546.074, 555.0]);
        let lines = Spectrum::lines(crate::spectrum::Grid::new(vec![555.0]).unwrap(), vec![2.0]).unwrap();
        let values = bands.emission(&lines).unwrap();
        let lux = K_M * bands.weights(&v()).iter().zip(&values).map(|(w, e)| w * e).sum::<f64>();
        // V(555 nm) = 1 in the CIE's table.
        assert!((lux - 2.0 * 683.002).abs() < 1e-9, "{lux}");
        let other = Spectrum::lines(crate::spectrum::Grid::new(vec![600.0]).unwrap(), vec![2.0]).unwrap();
        assert_eq!(bands.emission(&other), Err(600.0));
        let density =
            Spectrum::density(crate::spectrum::Grid::new(vec![300.0, 900.0]).unwrap(), vec![1.0, 1.0]).unwrap();
        let values = bands.emission(&density).unwrap();
        assert_eq!((values[0], values[47], values[48]), (1.0, 0.0, 0.0));
    }
}
