//! A material under a texture: everything that it scatters is multiplied, band by band, by a factor that depends on the place.
//!
//! ```text
//! f(u, v) = t(u, v) f        0 ≤ t ≤ 1
//! ```
//!
//! On a white diffuser t is the reflectance. (u, v) are the shape's texture coordinates; textures repeat with period 1.
//!
//! | texture | parameters |
//! |---|---|
//! | [`Checkerboard`] | factors of even and of odd fields, number of fields along u and v |
//! | [`Picture`] | width and height, a basis of spectra, coefficients per pixel; straight lines between the centres of pixels |

use std::fmt;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{Material, Nature, Scattered, Transport};
use crate::brdf::fresnel::Components;
use crate::brdf::parameter::{Error, Parameter, same_bands};

/// What a texture multiplies by.
pub const FACTOR: Parameter = Parameter::spectral("texture", 0.0, 1.0, "factor on what is scattered");

/// A factor per band for every place.
pub trait Texture: fmt::Debug + Send + Sync {
    /// Writes the factors, 0 to 1, at texture coordinates.
    fn write(&self, uv: DVec2, factors: &mut [f64]);
}

/// Fields like those of a chessboard.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkerboard {
    factors: [Vec<f64>; 2],
    fields: [u32; 2],
}

impl Checkerboard {
    /// The factors of the field at (0, 0) and of its neighbours, and how many fields there are along u and v.
    ///
    /// # Errors
    /// [`Error::Range`] for factors that are not from 0 to 1, [`Error::Bands`].
    pub fn new(even: Vec<f64>, odd: Vec<f64>, fields: [u32; 2]) -> Result<Self, Error> {
        FACTOR.check_all(&even)?;
        FACTOR.check_all(&odd)?;
        same_bands(even.len(), &[("texture", odd.len())])?;
        Ok(Self { factors: [even, odd], fields })
    }
}

impl Texture for Checkerboard {
    fn write(&self, uv: DVec2, factors: &mut [f64]) {
        let field = |x: f64, n: u32| (x.rem_euclid(1.0) * f64::from(n)).floor();
        let odd = (field(uv.x, self.fields[0]) + field(uv.y, self.fields[1])) % 2.0 == 1.0;
        factors.copy_from_slice(&self.factors[usize::from(odd)]);
    }
}

/// A picture whose pixels are coefficients on a basis of spectra.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    size: [usize; 2],
    /// One spectrum per channel, on the bands.
    basis: Vec<Vec<f64>>,
    /// How often it is repeated along u and v.
    repeat: DVec2,
    /// Rows from the top, pixels from the left, channels.
    coefficients: Vec<f32>,
}

impl Picture {
    /// Width and height, basis spectra on the bands, and coefficients: rows from the top (v = 1), pixels from the left (u = 0), one
    /// coefficient per basis spectrum.
    ///
    /// # Errors
    /// [`Error::Bands`] for a wrong number of values, [`Error::Range`] for a pixel whose factor in a band is not from 0 to 1 (to 1e-6,
    /// as pixels are rounded).
    pub fn new(size: [usize; 2], basis: Vec<Vec<f64>>, coefficients: Vec<f32>) -> Result<Self, Error> {
        let bands = basis.first().map_or(0, Vec::len);
        for spectrum in &basis {
            same_bands(bands, &[("basis", spectrum.len())])?;
        }
        let expected = size[0].saturating_mul(size[1]).saturating_mul(basis.len());
        if coefficients.len() != expected || expected == 0 {
            return Err(Error::Bands { name: "coefficients", found: coefficients.len(), expected: expected.max(1) });
        }
        let picture = Self { size, basis, repeat: DVec2::ONE, coefficients };
        let mut factors = vec![0.0; bands];
        for pixel in 0..size[0] * size[1] {
            factors.fill(0.0);
            picture.add(pixel, 1.0, &mut factors);
            if let Some(value) = factors.iter().find(|f| !(-1e-6..=1.0 + 1e-6).contains(*f)) {
                return Err(Error::Range { name: "texture", value: *value, expected: FACTOR.expected() });
            }
        }
        Ok(picture)
    }

    /// The same picture, repeated so often along u and v.
    #[must_use]
    pub fn repeated(self, repeat: [f64; 2]) -> Self {
        Self { repeat: DVec2::from_array(repeat), ..self }
    }

    fn add(&self, pixel: usize, share: f64, factors: &mut [f64]) {
        let channels = self.basis.len();
        for (coefficient, spectrum) in self.coefficients[pixel * channels..][..channels].iter().zip(&self.basis) {
            let amount = share * f64::from(*coefficient);
            factors.iter_mut().zip(spectrum).for_each(|(f, s)| *f += amount * s);
        }
    }
}

impl Texture for Picture {
    fn write(&self, uv: DVec2, factors: &mut [f64]) {
        let [width, height] = self.size;
        let uv = uv * self.repeat;
        // The two pixels whose centres are on both sides, around the edge where need be, and the share of the second.
        let between = |x: f64, n: usize| {
            let place = x.rem_euclid(1.0) * n as f64 - 0.5;
            let before = place.floor();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to n")]
            let second = (before + 1.0) as usize % n;
            (second.checked_sub(1).unwrap_or(n - 1), second, place - before)
        };
        let (x0, x1, x) = between(uv.x, width);
        let (y0, y1, y) = between(1.0 - uv.y, height);
        factors.fill(0.0);
        for (row, across) in [(y0, 1.0 - y), (y1, y)] {
            for (column, along) in [(x0, 1.0 - x), (x1, x)] {
                self.add(row * width + column, across * along, factors);
            }
        }
        // Pixels are rounded to f32.
        factors.iter_mut().for_each(|f| *f = f.clamp(0.0, 1.0));
    }
}

/// A material under a texture.
#[derive(Debug)]
pub struct Textured {
    base: Arc<dyn Material>,
    texture: Box<dyn Texture>,
}

impl Textured {
    /// Puts a texture on a material.
    #[must_use]
    pub fn new(base: Arc<dyn Material>, texture: Box<dyn Texture>) -> Self {
        Self { base, texture }
    }
}

impl Material for Textured {
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, transport: Transport, values: &mut [f64]) {
        self.base.evaluate(incident, outgoing, transport, values);
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        self.base.sample(outgoing, u, transport, hero, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3, hero: usize) -> f64 {
        self.base.pdf(outgoing, incident, hero)
    }

    fn convert(&self, uv: DVec2, transport: Transport, throughput: &mut [f64], scratch: &mut [f64]) -> bool {
        self.texture.write(uv, scratch);
        throughput.iter_mut().zip(scratch.iter()).for_each(|(t, f)| *t *= f);
        self.base.convert(uv, transport, throughput, scratch)
    }

    fn converts(&self) -> bool {
        true
    }

    fn is_diffuse(&self) -> bool {
        self.base.is_diffuse()
    }

    fn nature(&self) -> Nature {
        self.base.nature()
    }

    fn albedo(&self, arriving: DVec3, share: &mut [f64]) -> Option<f64> {
        self.base.albedo(arriving, share)
    }

    fn polarise(&self, outgoing: DVec3, incident: DVec3, components: &mut [Components]) -> bool {
        self.base.polarise(outgoing, incident, components)
    }

    fn splits(&self) -> bool {
        self.base.splits()
    }

    fn has_delta(&self) -> bool {
        self.base.has_delta()
    }

    fn is_delta(&self) -> bool {
        self.base.is_delta()
    }

    fn is_transmissive(&self) -> bool {
        self.base.is_transmissive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(texture: &dyn Texture, u: f64, v: f64) -> f64 {
        let mut factors = [f64::NAN; 2];
        texture.write(DVec2::new(u, v), &mut factors);
        assert_eq!(factors[1], 0.5 * factors[0]);
        factors[0]
    }

    #[test]
    fn fields_alternate_and_repeat() {
        let board = Checkerboard::new(vec![0.2, 0.1], vec![0.8, 0.4], [8, 4]).unwrap();
        for (u, v, expected) in [
            (0.01, 0.01, 0.2),
            (0.13, 0.01, 0.8),
            (0.13, 0.26, 0.2),
            (-0.01, 0.01, 0.8),
            (1.01, -0.99, 0.2),
            (5.0, 7.0, 0.2),
        ] {
            assert_eq!(at(&board, u, v), expected, "{u} {v}");
        }
        assert!(Checkerboard::new(vec![1.1], vec![0.0], [1, 1]).is_err());
    }

    #[test]
    fn pictures_are_read_between_the_centres_of_their_pixels() {
        // Two columns, two rows; the first row is the upper one.
        let picture = Picture::new([2, 2], vec![vec![1.0, 0.5]], vec![0.0, 1.0, 0.5, 0.25]).unwrap();
        for (u, v, expected) in [
            (0.25, 0.75, 0.0),
            (0.75, 0.75, 1.0),
            (0.25, 0.25, 0.5),
            (0.75, 0.25, 0.25),
            (0.5, 0.75, 0.5),
            (0.5, 0.5, 0.4375),
        ] {
            assert!((at(&picture, u, v) - expected).abs() < 1e-15, "{u} {v}");
        }
        // Around the edge: halfway between the last and the first column.
        assert!((at(&picture, 0.0, 0.75) - 0.5).abs() < 1e-15 && (at(&picture, 1.0 - 1e-17, 0.75) - 0.5).abs() < 1e-15);
        assert!(Picture::new([2, 2], vec![vec![1.0]], vec![0.0; 3]).is_err());
        assert!(Picture::new([1, 1], vec![vec![1.0]], vec![1.5]).is_err());
        assert!(Picture::new([0, 0], vec![], vec![]).is_err());
    }
}
