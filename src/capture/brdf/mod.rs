//! From pictures of an object of known shape to its BRDF: every valid pixel is one measurement.
//!
//! ```text
//! f_r = L / E      E = I cosθ_i / d²  (near light)      E = E_n cosθ_i  (distant light)
//! ```
//!
//! The pixel's ray is that of its centre through the lens; where it meets the surface gives point and normal. σ is that of the radiance
//! alone, divided by E: errors of camera, object and lights are not in it. A sphere lights no part of itself and casts no shadow on itself
//! but the attached one, so nothing else has to be masked. Of other shapes, pixels of which a corner sees another part or none are masked as
//! silhouette; of meshes also those to which the object itself stands before the light, and those whose hemisphere it fills too much of.
//!
//! A sensor averages over the area of a pixel: a lobe in its picture is wider than it is. L is therefore corrected to the pixel's centre by
//! 1/24 of the Laplacian of the picture.
//!
//! - [`Scene::observe`]: the measurements of one picture, and how many pixels were masked for which reason.
//! - [`Observations`]: those of all pictures; [`Gathered`]: the same in bounded memory; [`bin`]: per bin in half and difference angles; [`strength_from`]: a light from a diffuse sphere;
//!   [`Filled`]: bins that nobody measured, on request.
//! - [`Scene::maps`]: a picture beside what a model says; [`deviations`]: pictures that disagree with the others; [`reciprocity`]: of the measurements themselves; [`next_lights`]: what to photograph
//!   next.
//!
//! Reference: W. Matusik et al., *A Data-Driven Reflectance Model*, ACM Trans. Graph. 22 (2003), for the principle.

mod agreement;
mod bins;
mod digest;
mod fill;
mod gather;
mod maps;
mod next;
mod observe;
mod reciprocity;
mod scale;
mod surface;

pub use agreement::{apart, deviations};
pub use bins::{Bin, Binned, bin};
pub use fill::Filled;
pub use gather::Gathered;
pub use maps::{Growing, Maps};
pub use next::{Next, next_lights};
pub use observe::{Counts, Limits, Scene, Seen, View};
pub use reciprocity::{Reciprocity, reciprocity};
pub use scale::{Strength, reference_factor_sd, strength_from};
pub use surface::{Hit, Surface};

use glam::DVec3;

use crate::brdf::fit::{self, Samples};
use crate::brdf::table::Channel;

/// Measurements in no order.
#[derive(Debug, Clone, PartialEq)]
pub struct Observations {
    /// The bands.
    pub channels: Vec<Channel>,
    /// ω_i and ω_o in the frame of the surface, +z its normal, turned about it at will.
    pub directions: Vec<(DVec3, DVec3)>,
    /// f_r in 1/sr, the bands of a measurement side by side.
    pub values: Vec<f64>,
    /// Standard errors in the same order; 0 where nobody stated one.
    pub errors: Vec<f64>,
    /// What was added to the values because a pixel is an average, in the same order ([`Seen::corrections`]).
    pub corrections: Vec<f32>,
}

impl Observations {
    /// None yet, of `bands` bands: one is called `Y`, three `R`, `G`, `B`.
    #[must_use]
    pub fn new(bands: usize) -> Self {
        let channels = if bands == 3 { Channel::rgb() } else { vec![Channel::Named("Y".to_owned()); bands] };
        Self { channels, directions: Vec::new(), values: Vec::new(), errors: Vec::new(), corrections: Vec::new() }
    }

    /// None yet, in narrow bands: one for each wavelength.
    #[must_use]
    pub fn of_wavelengths(wavelengths_nm: &[f64]) -> Self {
        let channels = wavelengths_nm.iter().map(|nm| Channel::Wavelength(*nm)).collect();
        Self { channels, ..Self::new(0) }
    }

    /// Adds one.
    pub fn push(&mut self, seen: &Seen<'_>) {
        self.directions.push((seen.incident, seen.outgoing));
        self.values.extend_from_slice(seen.values);
        self.errors.extend_from_slice(seen.errors);
        #[expect(clippy::cast_possible_truncation, reason = "small beside the values")]
        self.corrections.extend(seen.corrections.iter().map(|c| *c as f32));
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.directions.is_empty()
    }

    /// Whether all standard errors are known.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors.iter().all(|e| *e > 0.0)
    }

    /// Keeps the first, third, fifth, … of them.
    fn halve(&mut self) {
        fn every_second<T: Copy>(all: &mut Vec<T>, together: usize) {
            let kept = all.len().div_ceil(together).div_ceil(2);
            (1..kept).for_each(|n| all.copy_within(2 * n * together..(2 * n + 1) * together, n * together));
            all.truncate(kept * together);
        }
        let bands = self.channels.len();
        every_second(&mut self.directions, 1);
        [&mut self.values, &mut self.errors].into_iter().for_each(|all| every_second(all, bands));
        every_second(&mut self.corrections, bands);
    }

    /// Removes all of them.
    fn clear(&mut self) {
        self.directions.clear();
        self.values.clear();
        self.errors.clear();
        self.corrections.clear();
    }

    /// Multiplies all values and errors.
    pub fn scale(&mut self, factor: f64) {
        self.values.iter_mut().chain(&mut self.errors).for_each(|v| *v *= factor);
        #[expect(clippy::cast_possible_truncation, reason = "as the corrections are kept")]
        self.corrections.iter_mut().for_each(|c| *c *= factor as f32);
    }

    /// For a fit: weighted by 1/σ² where all σ are known, else alike. `pixel_variance_sd` is the relative standard uncertainty of the variance
    /// of the places that pixels are averages over ([`Scene::pixel_variance_sd`]), an error that all have in common.
    ///
    /// # Errors
    /// [`fit::Error::NoPlaces`] for none.
    pub fn samples(&self, pixel_variance_sd: f64) -> Result<Samples, fit::Error> {
        let errors = self.has_errors().then_some(self.errors.as_slice());
        let all = Samples::scattered(self.channels.clone(), self.directions.clone(), self.values.clone(), errors)?;
        if pixel_variance_sd <= 0.0 {
            return Ok(all);
        }
        all.with_common(self.corrections.iter().map(|c| pixel_variance_sd * f64::from(*c)).collect())
    }
}
