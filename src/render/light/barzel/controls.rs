//! The controls of the light, each with its range, and the factors of those that are more than a number.

use glam::DVec2;

use super::super::superellipse::Superellipse;
use super::super::{Error, placed, sound, within};

/// How the light falls off with distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Falloff {
    /// A power of the distance that meets the square law at a distance.
    Power {
        /// n, 0 to 10; 2 is physics.
        exponent: f64,
        /// r₀, m.
        reference_m: f64,
    },
    /// The same beyond r₀; within, a rise to `most` times the value at r₀.
    Controlled {
        /// n, above 0 to 10.
        exponent: f64,
        /// r₀, m.
        reference_m: f64,
        /// M, above 1.
        most: f64,
    },
}

impl Falloff {
    /// The square law.
    pub const SQUARE: Self = Self::Power { exponent: 2.0, reference_m: 1.0 };

    /// The factor at a distance, 1/m².
    pub(super) fn at(self, distance: f64) -> f64 {
        let (Self::Power { exponent, reference_m } | Self::Controlled { exponent, reference_m, .. }) = self;
        let ratio = distance / reference_m;
        let relative = match self {
            Self::Controlled { most, .. } if ratio < 1.0 => {
                let log = f64::ln(most);
                most * (-log * ratio.powf(exponent / log)).exp()
            }
            _ => ratio.powf(-exponent),
        };
        relative / reference_m / reference_m
    }

    fn check(self) -> Result<(), Error> {
        let (Self::Power { exponent, reference_m } | Self::Controlled { exponent, reference_m, .. }) = self;
        within("an exponent of the falloff", exponent, (0.0..=10.0).contains(&exponent), "0 to 10")?;
        within(
            "a distance of the falloff (m)",
            reference_m,
            (1e-12..=1e12).contains(&reference_m),
            "a length above 0",
        )?;
        if let Self::Controlled { most, .. } = self {
            within("an exponent of a controlled falloff", exponent, exponent > 0.0, "above 0")?;
            within("a most of the falloff", most, most > 1.0 && most < 1e100, "above 1")?;
        }
        Ok(())
    }
}

/// Where along the axis the light begins and ends, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clip {
    /// Full from here on.
    pub near_m: f64,
    /// Length of the rise before it.
    pub near_edge_m: f64,
    /// Full to here; infinite for no cut-off.
    pub far_m: f64,
    /// Length of the fall behind it.
    pub far_edge_m: f64,
}

/// A card across the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blocker {
    /// Its place on the axis, m before the light, above 0.
    pub depth_m: f64,
    /// Its middle across the axis, m.
    pub middle_m: DVec2,
    /// Its outline, m.
    pub outline: Superellipse,
    /// What it takes away, 0 to 1.
    pub opacity: f64,
}

/// A picture in the window.
#[derive(Debug, Clone, PartialEq)]
pub struct Slide {
    /// Pixels along a row.
    pub width: usize,
    /// Rows, from the top (+Y); columns run towards +X.
    pub height: usize,
    /// Coefficients of 0 or more, row by row, the channels of a pixel side by side.
    pub coefficients: Vec<f32>,
    /// Factor per band of a coefficient of 1, for each channel; 0 or more.
    pub spectra: Vec<Vec<f64>>,
    /// Half of its extents in X and Y (tangents).
    pub half: DVec2,
}

/// Noise over the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Cells per unit of X and Y.
    pub frequency: f64,
    /// What it takes away at most, 0 to 1.
    pub amplitude: f64,
    /// Which noise.
    pub seed: u32,
}

/// All controls; as they stand by default, the light is an isotropic point on the side of its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Controls {
    /// With distance.
    pub falloff: Falloff,
    /// k of cosᵏ, 0 or more.
    pub beam_exponent: f64,
    /// On the window; `None` lights all of the half space.
    pub shape: Option<Superellipse>,
    /// Of the window.
    pub shear: DVec2,
    /// Cut-on and cut-off.
    pub clip: Option<Clip>,
    /// Cards.
    pub blockers: Vec<Blocker>,
    /// Slide or cookie.
    pub slide: Option<Slide>,
    /// Noise.
    pub noise: Option<Noise>,
    /// Whether it casts shadows.
    pub shadows: bool,
}

impl Default for Controls {
    fn default() -> Self {
        Self {
            falloff: Falloff::SQUARE,
            beam_exponent: 0.0,
            shape: None,
            shear: DVec2::ZERO,
            clip: None,
            blockers: Vec::new(),
            slide: None,
            noise: None,
            shadows: true,
        }
    }
}

impl Controls {
    /// Refuses what is outside of its range, and slides of another number of bands.
    pub(super) fn check(&self, bands: usize) -> Result<(), Error> {
        let Self { falloff, beam_exponent: k, shear, clip, blockers, slide, noise, .. } = self;
        falloff.check()?;
        within("an exponent of the beam", *k, (0.0..=1e6).contains(k), "0 to 1e6")?;
        placed("a shear", shear.extend(0.0))?;
        if let Some(Clip { near_m, near_edge_m, far_m, far_edge_m }) = *clip {
            let lengths = [("a cut-on (m)", near_m), ("an edge (m)", near_edge_m), ("an edge (m)", far_edge_m)];
            for (what, length) in lengths {
                within(what, length, length >= 0.0, "a length of 0 or more")?;
            }
            if far_m.is_nan() || far_m < near_m {
                return Err(Error::Value { what: "a cut-off (m)", found: far_m, expected: "the cut-on or more" });
            }
        }
        for Blocker { depth_m, middle_m, opacity, .. } in blockers {
            within("a depth of a blocker (m)", *depth_m, *depth_m > 0.0, "a length above 0")?;
            placed("a middle of a blocker (m)", middle_m.extend(0.0))?;
            within("an opacity", *opacity, (0.0..=1.0).contains(opacity), "0 to 1")?;
        }
        if let Some(Noise { frequency, amplitude, .. }) = *noise {
            within("a frequency of noise", frequency, frequency >= 0.0, "0 or more")?;
            within("an amplitude of noise", amplitude, (0.0..=1.0).contains(&amplitude), "0 to 1")?;
        }
        let Some(Slide { width, height, coefficients, spectra, half }) = slide else { return Ok(()) };
        let count = |what, found, expected| Err(Error::Count { what, found, expected });
        if *width == 0 || *height == 0 || spectra.is_empty() {
            return count("pixels or channels of a slide", 0, 1);
        }
        if coefficients.len() != width * height * spectra.len() {
            return count("coefficients of a slide", coefficients.len(), width * height * spectra.len());
        }
        for extent in half.to_array() {
            within("half an extent of a slide", extent, extent > 0.0, "above 0")?;
        }
        if let Some(found) = coefficients.iter().find(|k| !(k.is_finite() && **k >= 0.0)) {
            return Err(Error::Value {
                what: "a pixel of a slide",
                found: f64::from(*found),
                expected: "0 or more, finite",
            });
        }
        for spectrum in spectra {
            sound("a factor of a slide", spectrum)?;
            if spectrum.len() != bands {
                return count("bands of a slide's channel", spectrum.len(), bands);
            }
        }
        Ok(())
    }
}

impl Slide {
    /// A channel at a place on the window, bilinear between the middles of the pixels; 0 beyond the slide.
    pub(super) fn at(&self, window: DVec2, channel: usize) -> f64 {
        let (u, v) = (0.5 + 0.5 * window.x / self.half.x, 0.5 - 0.5 * window.y / self.half.y);
        if !((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)) {
            return 0.0;
        }
        let cell = |x: f64, n: usize| {
            let x = (x * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the slide")]
            let low = (x as usize).min(n.saturating_sub(2));
            (low, (low + 1).min(n - 1), x - low as f64)
        };
        let ((left, right, s), (top, bottom, t)) = (cell(u, self.width), cell(v, self.height));
        let pixel = |row: usize, column: usize| {
            f64::from(self.coefficients[(row * self.width + column) * self.spectra.len() + channel])
        };
        let along = |row| pixel(row, left) + s * (pixel(row, right) - pixel(row, left));
        along(top) + t * (along(bottom) - along(top))
    }

    /// The largest coefficient of a channel.
    pub(super) fn most(&self, channel: usize) -> f64 {
        let all = self.coefficients.iter().skip(channel).step_by(self.spectra.len());
        all.fold(0.0, |most, k| f64::max(most, f64::from(*k)))
    }
}
