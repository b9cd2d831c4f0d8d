//! What an image is, without its pixels.

use std::sync::Arc;

use crate::colorimetry::rgb::{Encoding, Space};
use crate::spectrum::{self, Grid, Quantity, SpectralUnit};

/// What the samples of one channel mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meaning {
    /// A spectral sample: of the light's total power (Stokes component S₀), or of a reflectance.
    Band {
        /// Centre wavelength, nm.
        wavelength_nm: f64,
        /// Full width at half maximum of the band, nm, where the file states one.
        fwhm_nm: Option<f64>,
        /// False where the file marks the band as bad; bad bands take part in no integral.
        good: bool,
    },
    /// A Stokes component S₁, S₂ or S₃ of polarised light; carried through, never integrated.
    Stokes {
        /// 1, 2 or 3.
        component: u8,
        /// Centre wavelength, nm.
        wavelength_nm: f64,
    },
    /// A photopic quantity (cd/m², lx …).
    Photopic,
    /// Another weighted integral; the channel's name says which.
    Weighted,
    /// Tristimulus value X, Y or Z: 0, 1 or 2.
    Tristimulus(u8),
    /// Red, green or blue, 0, 1 or 2, of [`Description::rgb`].
    Primary(u8),
    /// Coverage of the pixel, 0 to 1.
    Alpha,
    /// Anything else; carried through.
    Other,
}

/// One plane of an image.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name: the file's own, or `Y`, `X`, `R`, `scotopic` ….
    pub name: String,
    /// Unit of the samples as printed; empty for pure numbers and unknown units.
    pub unit: String,
    /// What they mean.
    pub meaning: Meaning,
}

impl Channel {
    /// A channel.
    #[must_use]
    pub fn new(name: impl Into<String>, unit: impl Into<String>, meaning: Meaning) -> Self {
        Self { name: name.into(), unit: unit.into(), meaning }
    }

    /// A good spectral band without a stated width.
    #[must_use]
    pub fn band(name: impl Into<String>, unit: impl Into<String>, wavelength_nm: f64) -> Self {
        Self::new(name, unit, Meaning::Band { wavelength_nm, fwhm_nm: None, good: true })
    }
}

/// What the bands are of, as far as the file says.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Light: spectral samples of a radiometric quantity.
    Light {
        /// The quantity stated.
        quantity: Option<Quantity>,
        /// The unit stated.
        unit: Option<SpectralUnit>,
    },
    /// Reflectance factor or transmittance, a pure number: it has a colour only under an illuminant.
    Reflectance,
    /// No bands: finished planes.
    Planes,
}

/// The space of red, green and blue channels.
#[derive(Debug, Clone, PartialEq)]
pub struct RgbSpace {
    /// Its primaries, white and, where the samples are encoded, the curve.
    pub space: Space,
    /// The samples are encoded with the curve of the space; otherwise they are linear.
    pub encoded: bool,
    /// Luminance of (1, 1, 1), cd/m²; `None` where nobody knows.
    pub white_luminance: Option<f64>,
}

impl RgbSpace {
    /// The linear value of a stored one.
    #[must_use]
    pub fn encoding(&self) -> Encoding {
        if self.encoded { self.space.encoding } else { Encoding::Linear }
    }
}

/// An image without its pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The planes, in the order of the file.
    pub channels: Vec<Channel>,
    /// What the bands are of.
    pub content: Content,
    /// The space of [`Meaning::Primary`] channels; of an image of X, Y, Z or luminance without a unit only the luminance of 1
    /// counts.
    pub rgb: Option<RgbSpace>,
    /// Everything else that is known, by name, in order: the file's own attributes, and the contract under which planes were
    /// integrated (names `photopic:…`).
    pub attributes: Vec<(String, String)>,
}

impl Description {
    /// An image of finished planes, without attributes.
    #[must_use]
    pub fn planes(width: usize, height: usize, channels: Vec<Channel>) -> Self {
        Self { width, height, channels, content: Content::Planes, rgb: None, attributes: Vec::new() }
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// Channel number and wavelength (nm) of the bands that take part in integrals, by ascending wavelength.
    #[must_use]
    pub fn bands(&self) -> Vec<(usize, f64)> {
        let mut bands: Vec<(usize, f64)> = (self.channels.iter().enumerate())
            .filter_map(|(i, c)| match c.meaning {
                Meaning::Band { wavelength_nm, good: true, .. } => Some((i, wavelength_nm)),
                _ => None,
            })
            .collect();
        bands.sort_by(|a, b| a.1.total_cmp(&b.1));
        bands
    }

    /// The wavelengths of [`Description::bands`] as a grid.
    ///
    /// # Errors
    /// Where there are none, one is not positive, or two are alike.
    pub fn grid(&self) -> Result<Arc<Grid>, spectrum::Error> {
        Grid::new(self.bands().into_iter().map(|(_, w)| w).collect()).map(Arc::new)
    }

    /// The number of the channel of a meaning.
    #[must_use]
    pub fn find(&self, meaning: Meaning) -> Option<usize> {
        self.channels.iter().position(|c| c.meaning == meaning)
    }

    /// The attribute of a name.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    /// Sets an attribute, in place of one of the same name.
    pub fn set_attribute(&mut self, name: &str, value: impl Into<String>) {
        match self.attributes.iter_mut().find(|(n, _)| n == name) {
            Some((_, v)) => *v = value.into(),
            None => self.attributes.push((name.to_owned(), value.into())),
        }
    }
}
