//! Vignetting, from a photograph of an evenly lit field.
//!
//! ```text
//! L(x, y, c) = L_c (1 + v₁ r² + v₂ r⁴ + v₃ r⁶)      r: distance from the principal point over half the diagonal
//! ```
//!
//! cos⁴ falloff and the lens' stops are both smooth functions of r²; one shape serves all channels. A field that is not even ends up in the
//! residuals, which are told.

use glam::DVec2;
use nalgebra::{DMatrix, DVector};

use super::Error;
use super::merge::State;
use super::radiance::Radiance;

/// Terms of the polynomial.
const TERMS: usize = 3;
/// Blocks along a side into which the picture is averaged: vignetting is smooth.
const BLOCKS: usize = 48;

/// How the picture of an even field falls off.
#[derive(Debug, Clone, PartialEq)]
pub struct Vignetting {
    /// Where it is 1.
    pub centre: DVec2,
    /// Pixels of r = 1.
    pub unit_px: f64,
    /// v₁, v₂, v₃.
    pub coefficients: [f64; TERMS],
    /// Radiance of the field at the centre per channel, as the picture has it.
    pub level: Vec<f64>,
    /// Rms of the relative residuals of the blocks.
    pub rms: f64,
    /// The least value in the picture.
    pub least: f64,
}

impl Vignetting {
    /// Fits a merged picture of a field; `centre` is the principal point, else the middle of the picture.
    ///
    /// # Errors
    /// [`Error::Nothing`] for a picture without valid samples in most of its blocks.
    pub fn fit(name: &str, picture: &Radiance, centre: Option<DVec2>) -> Result<Self, Error> {
        let (w, h, n) = (picture.width, picture.height, picture.channels);
        let middle = DVec2::new((w as f64 - 1.0) / 2.0, (h as f64 - 1.0) / 2.0);
        let centre = centre.unwrap_or(middle);
        let unit_px = 0.5 * (w as f64).hypot(h as f64);
        let nothing = |why: &str| Error::Nothing { stack: name.to_owned(), why: why.to_owned() };
        // Blocks: place, channel, mean.
        let mut blocks: Vec<(f64, usize, f64)> = Vec::new();
        let (across, down) = (BLOCKS.min(w), BLOCKS.min(h));
        for b in 0..across * down {
            let (i, j) = (b % across, b / across);
            let (xs, ys) = (i * w / across..(i + 1) * w / across, j * h / down..(j + 1) * h / down);
            let place = DVec2::new((xs.start + xs.end - 1) as f64 / 2.0, (ys.start + ys.end - 1) as f64 / 2.0);
            for c in 0..n {
                let valid = |at: &usize| {
                    let i = at * n + c;
                    picture.values[i].is_finite()
                        && picture.values[i] > 0.0
                        && picture.states.as_ref().is_none_or(|s| s[i] == State::Valid)
                };
                let places = ys.clone().flat_map(|y| xs.clone().map(move |x| y * w + x));
                let values: Vec<f64> = places.filter(valid).map(|at| f64::from(picture.values[at * n + c])).collect();
                if 2 * values.len() > xs.len() * ys.len() {
                    let mean = values.iter().sum::<f64>() / values.len() as f64;
                    blocks.push(((place - centre).length_squared() / unit_px.powi(2), c, mean));
                }
            }
        }
        if 2 * blocks.len() < across * down * n {
            return Err(nothing("less than half of the field is in range; expected other exposure times"));
        }
        // L = L_c + L_c v_k r²ᵏ is not linear with one shape for all channels: with the levels of the last round it is.
        let mut level: Vec<f64> =
            (0..n).map(|c| blocks.iter().filter(|b| b.1 == c).map(|b| b.2).fold(0.0, f64::max)).collect();
        if level.iter().any(|l| *l <= 0.0) {
            return Err(nothing("a channel of the field is out of range; expected other exposure times"));
        }
        let mut coefficients = [0.0; TERMS];
        for _ in 0..20 {
            let size = TERMS + n;
            let (mut normal, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
            for (r2, c, mean) in &blocks {
                let mut row = DVector::zeros(size);
                (0..TERMS).for_each(|k| row[k] = r2.powi(k as i32 + 1));
                row[TERMS + c] = shape(&coefficients, *r2);
                // mean/L_c = 1 + Σ v_k r²ᵏ + δ_c (1 + Σ v_k r²ᵏ)
                let value = mean / level[*c] - 1.0;
                normal += &row * row.transpose();
                right += row * value;
            }
            let Some(solved) = normal.cholesky().map(|c| c.solve(&right)) else {
                return Err(nothing("its equations have no solution; expected a picture of an even field"));
            };
            (0..TERMS).for_each(|k| coefficients[k] = solved[k]);
            let mut moved: f64 = 0.0;
            for (c, l) in level.iter_mut().enumerate() {
                *l *= 1.0 + solved[TERMS + c];
                moved = moved.max(solved[TERMS + c].abs());
            }
            if moved < 1e-12 {
                break;
            }
        }
        let off = |(r2, c, mean): &(f64, usize, f64)| mean / (level[*c] * shape(&coefficients, *r2)) - 1.0;
        let rms = (blocks.iter().map(|b| off(b).powi(2)).sum::<f64>() / blocks.len() as f64).sqrt();
        let least = blocks.iter().map(|b| shape(&coefficients, b.0)).fold(1.0, f64::min);
        if least <= 0.05 {
            return Err(nothing("it falls to nothing; expected a picture of an even field"));
        }
        Ok(Self { centre, unit_px, coefficients, level, rms, least })
    }

    /// What is left of the light at a pixel, 1 at the centre.
    #[must_use]
    pub fn at(&self, pixel: DVec2) -> f64 {
        shape(&self.coefficients, (pixel - self.centre).length_squared() / self.unit_px.powi(2))
    }

    /// Takes it out of rows of a picture, of which the first has the number `top`: values and standard errors.
    pub fn undo(&self, picture: &mut Radiance, top: usize) {
        let (w, n) = (picture.width, picture.channels);
        #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
        let factor = |at: usize| self.at(DVec2::new((at % w) as f64, (top + at / w) as f64)).max(0.05).recip() as f32;
        let planes = std::iter::once(&mut picture.values).chain(picture.errors.as_mut());
        for plane in planes {
            for (at, pixel) in plane.chunks_exact_mut(n).enumerate() {
                let factor = factor(at);
                pixel.iter_mut().for_each(|v| *v *= factor);
            }
        }
    }
}

/// 1 + Σ v_k r²ᵏ.
fn shape(coefficients: &[f64; TERMS], r2: f64) -> f64 {
    1.0 + r2 * (coefficients[0] + r2 * (coefficients[1] + r2 * coefficients[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(falloff: impl Fn(f64) -> f64) -> Radiance {
        let at = |i: usize| {
            let p = DVec2::new((i / 3 % 120) as f64 - 57.0, (i / 3 / 120) as f64 - 43.0);
            #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
            let value = ([2.0, 3.0, 5.0][i % 3] * falloff(p.length())) as f32;
            value
        };
        let values = (0..120 * 90 * 3).map(at).collect();
        Radiance { width: 120, height: 90, channels: 3, time_s: 1.0, values, errors: None, states: None }
    }

    #[test]
    fn a_polynomial_comes_back_and_cos4_nearly() {
        let centre = DVec2::new(57.0, 43.0);
        // Blocks of 2.5 pixels: r² of their middles, off by the variance within, (2.5² + 1.9²)/12 px² of 75².
        let even = field(|r| 1.0 - 0.3 * (r / 75.0).powi(2) + 0.1 * (r / 75.0).powi(4));
        let found = Vignetting::fit("flat", &even, Some(centre)).unwrap();
        assert!(
            (found.at(DVec2::new(0.0, 0.0)) / (1.0 - 0.3 * 0.906_489 + 0.1 * 0.821_722) - 1.0).abs() < 5e-4,
            "{found:?}"
        );
        assert!((found.level[1] / 3.0 - 1.0).abs() < 5e-4 && found.rms < 5e-4, "{found:?}");
        let mut picture = field(|r| (r / 200.0).atan().cos().powi(4));
        let found = Vignetting::fit("flat", &picture, Some(centre)).unwrap();
        found.undo(&mut picture, 0);
        // cos⁴ is (1 + t)⁻² with t = (r/200)² up to 0.15: a cubic leaves 120 t⁴/(4! 2⁷) = 2e-5 at best, least squares several times that at
        // the corners; means over blocks of 2.5 pixels shift r² by 0.8 px², 2 · 0.8/200² = 4e-5.
        for v in picture.values.chunks_exact(3) {
            assert!((f64::from(v[2]) / 5.0 - 1.0).abs() < 4e-4, "{v:?}");
        }
        assert!(Vignetting::fit("flat", &field(|_| 0.0), None).is_err());
    }
}
