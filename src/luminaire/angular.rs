//! Intensity over direction and wavelength: what a goniospectroradiometer measures.

use std::sync::Arc;

use super::{Distribution, Error};
use crate::spectrum::{self, Grid, Sampling, Spectrum};

/// Spectral radiant intensity over the directions of a [`Distribution`]'s table, W/(sr·nm).
///
/// Sums over wavelength are distributions of their own ([`AngularSpectra::weighted`]), with their symmetry and interpolation;
/// sums over the sphere are spectra ([`AngularSpectra::power`]). A single wavelength is a line, of W/sr.
#[derive(Debug, Clone, PartialEq)]
pub struct AngularSpectra {
    /// The angles; its values are those of the first wavelength.
    frame: Distribution,
    grid: Arc<Grid>,
    /// `values[direction * wavelengths + wavelength]`, directions in the order of the frame's values.
    values: Vec<f64>,
}

impl AngularSpectra {
    /// One table of angles per wavelength of the grid, W/(sr·nm).
    ///
    /// # Errors
    /// [`Error::Count`] where there are not as many tables as wavelengths, or their angles or symmetry are not the same.
    pub fn new(grid: Arc<Grid>, tables: &[Distribution]) -> Result<Self, Error> {
        let frame = tables.first().ok_or(Error::Count { found: 0, expected: grid.len() })?;
        let alike = tables.iter().take_while(|t| frame.same_angles(t)).count();
        if alike != grid.len() || tables.len() != grid.len() {
            return Err(Error::Count {
                found: alike * frame.values().len(),
                expected: grid.len() * frame.values().len(),
            });
        }
        let values =
            (0..frame.values().len()).flat_map(|node| tables.iter().map(move |table| table.values()[node])).collect();
        Ok(Self { frame: frame.clone(), grid, values })
    }

    /// The directions: a table whose values mean nothing here but for their order.
    #[must_use]
    pub fn frame(&self) -> &Distribution {
        &self.frame
    }

    /// The wavelengths.
    #[must_use]
    pub fn grid(&self) -> &Arc<Grid> {
        &self.grid
    }

    /// What lies between the wavelengths: a single one is a line.
    #[must_use]
    pub fn sampling(&self) -> Sampling {
        if self.grid.len() == 1 { Sampling::Lines } else { Sampling::Density }
    }

    /// Number of tabulated directions.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.frame.values().len()
    }

    /// Values of a tabulated direction, one per wavelength, W/(sr·nm); directions plane by plane.
    ///
    /// # Panics
    /// Where `direction` is not below [`AngularSpectra::directions`].
    #[must_use]
    pub fn values(&self, direction: usize) -> &[f64] {
        let count = self.grid.len();
        &self.values[direction * count..(direction + 1) * count]
    }

    /// Horizontal and vertical angle of a tabulated direction, degrees.
    ///
    /// # Panics
    /// Where `direction` is not below [`AngularSpectra::directions`].
    #[must_use]
    pub fn angles_deg(&self, direction: usize) -> (f64, f64) {
        let rows = self.frame.vertical_deg().len();
        (self.frame.horizontal_deg()[direction / rows], self.frame.vertical_deg()[direction % rows])
    }

    /// The spectrum of a tabulated direction, W/(sr·nm).
    ///
    /// # Errors
    /// None: the values of a table are finite.
    ///
    /// # Panics
    /// Where `direction` is not below [`AngularSpectra::directions`].
    pub fn spectrum(&self, direction: usize) -> Result<Spectrum, spectrum::Error> {
        Spectrum::new(Arc::clone(&self.grid), self.values(direction).to_vec(), self.sampling())
    }

    /// The sum over wavelength in each direction, with one weight per wavelength: W/sr for the weights of ∫ dλ, cd for those
    /// of K_m ∫ V dλ.
    ///
    /// # Errors
    /// [`Error::Count`] where there are not as many weights as wavelengths, [`Error::Value`] where a sum is not finite.
    pub fn weighted(&self, weights: &[f64]) -> Result<Distribution, Error> {
        if weights.len() != self.grid.len() {
            return Err(Error::Count { found: weights.len(), expected: self.grid.len() });
        }
        let sum = |direction| self.values(direction).iter().zip(weights).map(|(v, w)| v * w).sum();
        self.frame.with_values((0..self.directions()).map(sum).collect())
    }

    /// The spectrum of the flux, W/nm: each wavelength integrated over all directions, exactly for the bilinear intensity.
    ///
    /// # Errors
    /// Where a sum is not finite.
    pub fn power(&self) -> Result<Spectrum, spectrum::Error> {
        let mut sums = vec![0.0; self.grid.len()];
        for (direction, solid_angle) in self.frame.solid_angles_sr().into_iter().enumerate() {
            sums.iter_mut().zip(self.values(direction)).for_each(|(sum, v)| *sum += solid_angle * v);
        }
        Spectrum::new(Arc::clone(&self.grid), sums, self.sampling())
    }

    /// The intensity at one tabulated wavelength, W/(sr·nm).
    ///
    /// # Errors
    /// None: the values of a table are finite.
    ///
    /// # Panics
    /// Where `wavelength` is not an index of the grid.
    pub fn at_wavelength(&self, wavelength: usize) -> Result<Distribution, Error> {
        self.frame.with_values((0..self.directions()).map(|d| self.values(d)[wavelength]).collect())
    }

    /// The same spectra with the table of every wavelength changed alike.
    ///
    /// # Errors
    /// Those of the change; [`Error::Count`] where the changed tables do not all have the same angles.
    pub fn map<E: From<Error>>(&self, change: impl Fn(&Distribution) -> Result<Distribution, E>) -> Result<Self, E> {
        let changed = |wavelength| change(&self.at_wavelength(wavelength)?);
        let tables: Vec<Distribution> = (0..self.grid.len()).map(changed).collect::<Result<_, E>>()?;
        Ok(Self::new(Arc::clone(&self.grid), &tables)?)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::luminaire::{Symmetry, System};

    fn table(slope: f64) -> Distribution {
        let values = vec![1.0, 1.0 + slope];
        Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 90.0], values).expect("a table")
    }

    #[test]
    fn sums_over_wavelength_and_sphere_are_those_of_the_tables() {
        let grid = Arc::new(Grid::new(vec![500.0, 600.0]).expect("a grid"));
        let spectra = AngularSpectra::new(grid, &[table(0.0), table(1.0)]).expect("two tables");
        assert_eq!((spectra.values(1), spectra.angles_deg(1)), (&[1.0, 2.0][..], (0.0, 90.0)));
        assert_eq!(spectra.weighted(&[10.0, 1.0]).expect("two weights").values(), [11.0, 12.0]);
        assert_eq!(spectra.at_wavelength(1).expect("a table").values(), [1.0, 2.0]);
        // ∫ sin γ over 0–90° is 1, ∫ (γ/90°) sin γ is 2/π.
        let power = spectra.power().expect("finite");
        assert!((power.values()[0] / TAU - 1.0).abs() < 1e-14);
        assert!((power.values()[1] / (TAU * (1.0 + 2.0 / std::f64::consts::PI)) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn tables_of_other_angles_are_refused() {
        let grid = Arc::new(Grid::new(vec![500.0, 600.0]).expect("a grid"));
        let other = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 80.0], vec![1.0; 2])
            .expect("a table");
        assert!(AngularSpectra::new(grid.clone(), &[table(0.0), other]).is_err());
        assert!(AngularSpectra::new(grid, &[table(0.0)]).is_err());
    }
}
