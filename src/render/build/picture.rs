//! Pictures of a scene as coefficients of a few spectra.
//!
//! A **spectral** picture is linear between its wavelengths: each of its bands stands for a hat that is 1 at its wavelength and 0 at
//! its neighbours'. Beyond the first and the last band a reflectance goes on as it ends, a radiance is 0.
//!
//! A picture in **colours** says nothing about wavelengths. Its pixels are taken as mixtures of three parts of white light, cut at
//! 490 and 590 nm with transitions of 30 nm, which add up to 1 at every wavelength:
//!
//! ```text
//! F(λ) = Σ_j k_j p_j(λ),   k = M⁻¹ T (R, G, B),   M_ij = ∫ x̄_i p_j S dλ
//! ```
//!
//! T is the matrix of the picture's space to XYZ, S the light of its white (D65, or equal energy), x̄ the CIE 1931 observer. Under
//! that light every pixel has its own colour, exactly; greys are grey under any light. All colours of sRGB have k from 0 to 1, so that
//! they are reflectances, too; colours beyond the parts are refused. What a pixel reflects of other lights is one possibility of many.

use std::ops::Range;
use std::rc::Rc;

use glam::{DMat3, DVec3};

use super::Builder;
use super::colour::{Colour, Edge, Role};
use crate::colorimetry::observer::Observer;
use crate::colorimetry::rgb::{SRGB, Space, same_xy};
use crate::constants::SecondRadiation;
use crate::illuminant::named;
use crate::image::{Content, Description, Meaning, RgbSpace};
use crate::render::bands::{Bands, RANGE_NM, as_function};
use crate::render::description::Error;
use crate::render::description::spectrum::SpectrumSource;
use crate::spectrum::integrate::Weighting;

/// A picture of a file: its description and all samples, in the order of [`crate::image`].
#[derive(Debug, Clone, PartialEq)]
pub struct PictureFile {
    /// What it is.
    pub description: Description,
    /// Sample (x, y, channel c) stands at `(y·channels + c)·width + x`.
    pub samples: Vec<f32>,
}

/// What a picture's numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// Radiance, or colours of light.
    Light,
    /// Factors from 0 to 1.
    Factors,
}

/// A picture as coefficients of spectra.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Channels {
    pub width: usize,
    pub height: usize,
    /// Rows from the top, pixels from the left, channels.
    pub coefficients: Vec<f32>,
    /// What each channel stands for.
    pub colours: Vec<Colour>,
    /// The numbers are colours, not values at wavelengths.
    pub in_colours: bool,
    /// The white of a picture in colours.
    pub white: White,
}

/// The light under which a picture's white is white.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum White {
    D65,
    EqualEnergy,
}

impl White {
    /// As a function of wavelength.
    pub(super) fn colour(self) -> Colour {
        match self {
            Self::EqualEnergy => Colour::Constant(1.0),
            Self::D65 => {
                let d65 = named::source("D65", SecondRadiation::default()).expect("a standard illuminant");
                Colour::Table(as_function(&d65.spectrum), Edge::Dark)
            }
        }
    }
}

/// Where white light is cut, nm, and over how many nm each cut goes.
const CUTS_NM: [f64; 2] = [490.0, 590.0];
const TRANSITION_NM: f64 = 30.0;
/// Coefficients so far below 0, relative to the pixel's largest, are rounding of the file's numbers.
const ROUNDING: f64 = 1e-3;

impl Builder<'_> {
    /// The picture of a file, read once.
    pub(super) fn picture(&self, file: &str, of: Of, at: &Range<usize>) -> Result<Rc<Channels>, Error> {
        let key = (file.to_owned(), of == Of::Light);
        if let Some(known) = self.pictures.borrow().get(&key) {
            return Ok(Rc::clone(known));
        }
        let read = self.files.picture(file).map_err(|e| self.wrong(at, e))?;
        let channels = Rc::new(channels(read, of).map_err(|e| self.wrong(at, format!("{file}: {e}")))?);
        self.pictures.borrow_mut().insert(key, Rc::clone(&channels));
        Ok(channels)
    }
}

impl Channels {
    /// What each channel stands for in the bands, times a factor per band.
    pub(super) fn spectra(&self, bands: &Bands, factor: &[f64]) -> Vec<Vec<f64>> {
        let of = |colour: &Colour| {
            bands.wavelengths_nm().iter().zip(factor).map(|(&nm, factor)| colour.at(nm) * factor).collect()
        };
        self.colours.iter().map(of).collect()
    }

    /// The spectra that decide which wavelengths are needed: the three of a picture in colours, the mean of a spectral one.
    pub(super) fn typical(&self) -> Vec<Colour> {
        if self.in_colours {
            return self.colours.clone();
        }
        let count = self.colours.len();
        let mut sums = vec![0.0; count];
        for pixel in self.coefficients.chunks_exact(count) {
            sums.iter_mut().zip(pixel).for_each(|(s, k)| *s += f64::from(*k));
        }
        let pixels = (self.width * self.height) as f64;
        let nm: Vec<f64> = (0..).map(|i| RANGE_NM.0 + f64::from(i)).take_while(|nm| *nm <= RANGE_NM.1).collect();
        let mean = nm.iter().map(|&nm| self.colours.iter().zip(&sums).map(|(c, s)| c.at(nm) * s / pixels).sum());
        let values: Vec<f64> = mean.collect();
        vec![Colour::Table(Weighting::table(nm, values), Edge::Constant)]
    }
}

/// The emissions of surroundings by a picture, as far as the choice of wavelengths goes.
pub(super) fn emissions(
    b: &Builder<'_>,
    file: &str,
    spectrum: Option<&toml::Spanned<SpectrumSource>>,
    at: &Range<usize>,
) -> Result<Vec<Colour>, Error> {
    let picture = b.picture(file, Of::Light, at)?;
    if !picture.in_colours {
        return Ok(picture.typical());
    }
    let white = spectrum.map_or_else(|| Ok(picture.white.colour()), |s| Colour::of(b, s, &Role::LIGHT))?;
    if matches!(white, Colour::Lines(_)) {
        return Err(b.wrong(at, "a line spectrum of a picture in colours; expected a density"));
    }
    let nm: Vec<f64> = Bands::uniform(RANGE_NM.0, 1.0).wavelengths_nm().to_vec();
    let times = |part: &Colour| {
        let values: Vec<f64> = nm.iter().map(|&nm| part.at(nm) * white.at(nm)).collect();
        Colour::Table(Weighting::table(nm.clone(), values), Edge::Dark)
    };
    Ok(picture.colours.iter().map(times).chain([white.clone()]).collect())
}

/// From a pixel's numbers to its coefficients.
type Convert<'a> = &'a dyn Fn(&[f64], &mut Vec<f32>) -> Result<(), String>;

/// A picture's channels, or why it is none, in words.
fn channels(file: PictureFile, of: Of) -> Result<Channels, String> {
    let d = &file.description;
    let (width, height) = (d.width, d.height);
    let gather = |planes: &[usize], convert: Convert<'_>| {
        let mut coefficients = Vec::with_capacity(width * height * planes.len());
        let mut pixel = vec![0.0; planes.len()];
        for y in 0..height {
            for x in 0..width {
                for (value, plane) in pixel.iter_mut().zip(planes) {
                    *value = f64::from(file.samples[(y * d.channels.len() + plane) * width + x]);
                }
                if let Some(bad) = pixel.iter().find(|v| !v.is_finite()) {
                    return Err(format!("pixel ({x}, {y}) is {bad}; expected finite numbers"));
                }
                convert(&pixel, &mut coefficients).map_err(|e| format!("pixel ({x}, {y}): {e}"))?;
            }
        }
        Ok(coefficients)
    };
    let planes: Vec<usize> = d.bands().iter().map(|b| b.0).collect();
    if !planes.is_empty() {
        let grid = d.grid().map_err(|e| e.to_string())?;
        let nm = grid.wavelengths_nm();
        let (scale, edge) = match (&d.content, of) {
            (Content::Reflectance, Of::Factors) => (vec![1.0; nm.len()], Edge::Constant),
            (Content::Light { unit, .. }, Of::Light) => {
                (nm.iter().map(|nm| unit.as_ref().map_or(1.0, |u| u.to_si(*nm, 1.0))).collect(), Edge::Dark)
            }
            (Content::Reflectance, Of::Light) => {
                return Err("a picture of reflectances; expected one of radiance, or one in colours".to_owned());
            }
            _ => return Err("a picture of light; expected one of reflectances, or one in colours".to_owned()),
        };
        let plain = |pixel: &[f64], out: &mut Vec<f32>| {
            out.extend(pixel.iter().zip(&scale).map(|(v, s)| (v * s) as f32));
            Ok(())
        };
        let coefficients = gather(&planes, &plain)?;
        let colours = (0..nm.len()).map(|i| hat(nm, i, edge)).collect();
        return Ok(Channels { width, height, coefficients, colours, in_colours: false, white: White::D65 });
    }
    let primaries: Option<Vec<usize>> = (0..3).map(|k| d.find(Meaning::Primary(k))).collect();
    if let (Some(planes), Some(rgb)) = (primaries, &d.rgb) {
        let (white, matrix) = parts(&rgb.space)?;
        let encoding = RgbSpace::encoding(rgb);
        let convert = |pixel: &[f64], out: &mut Vec<f32>| {
            let linear = DVec3::from_slice(pixel).to_array().map(|v| encoding.decode(v));
            let k = matrix * DVec3::from(linear);
            if k.min_element() < -ROUNDING * k.abs().max_element() {
                return Err("a colour beyond what three parts of white light make; expected less saturated colours, or a spectral picture".to_owned());
            }
            out.extend(k.max(DVec3::ZERO).to_array().map(|k| k as f32));
            Ok(())
        };
        let coefficients = gather(&planes, &convert)?;
        let colours = (0..3).map(part).collect();
        return Ok(Channels { width, height, coefficients, colours, in_colours: true, white });
    }
    if let Some(plane) = d.find(Meaning::Photopic) {
        let coefficients = gather(&[plane], &|pixel, out| {
            out.push(pixel[0] as f32);
            Ok(())
        })?;
        let colours = vec![Colour::Constant(1.0)];
        return Ok(Channels { width, height, coefficients, colours, in_colours: true, white: White::EqualEnergy });
    }
    Err("neither bands nor red, green and blue; expected a spectral picture or one in colours".to_owned())
}

/// 1 at one of the wavelengths, 0 at its neighbours; an edge that goes on is 1 beyond the first or the last.
fn hat(nm: &[f64], i: usize, edge: Edge) -> Colour {
    let mut corners = Vec::with_capacity(3);
    if i > 0 {
        corners.push((nm[i - 1], 0.0));
    }
    corners.push((nm[i], 1.0));
    if i + 1 < nm.len() {
        corners.push((nm[i + 1], 0.0));
    }
    if corners.len() == 1 {
        return Colour::Constant(1.0);
    }
    let (nm, values): (Vec<f64>, Vec<f64>) = corners.into_iter().unzip();
    Colour::Table(Weighting::table(nm, values), edge)
}

/// The long, the middle or the short part of white light.
fn part(index: usize) -> Colour {
    let [low, high] = CUTS_NM.map(|cut| [cut - 0.5 * TRANSITION_NM, cut + 0.5 * TRANSITION_NM]);
    let (nm, values) = match index {
        0 => (high.to_vec(), vec![0.0, 1.0]),
        1 => ([low, high].concat(), vec![0.0, 1.0, 1.0, 0.0]),
        _ => (low.to_vec(), vec![1.0, 0.0]),
    };
    Colour::Table(Weighting::table(nm, values), Edge::Constant)
}

/// What 1 in each of red, green and blue of linear sRGB is of the three parts: a row for each part.
pub(super) fn parts_of_srgb() -> [(Colour, [f64; 3]); 3] {
    let (_, matrix) = parts(&SRGB).expect("a space whose white is D65");
    [0, 1, 2].map(|k| (part(k), matrix.row(k).to_array()))
}

/// The white of a space and the matrix from its linear colours to coefficients of the parts.
fn parts(space: &Space) -> Result<(White, DMat3), String> {
    let d65 = [0.3127, 0.3290];
    // Radiance prints the equal-energy white with four digits.
    let equal = [1.0 / 3.0; 2];
    let white = match space.white {
        white if same_xy(white, d65) => White::D65,
        white if same_xy(white, equal) => White::EqualEnergy,
        [x, y] => return Err(format!("colours whose white is x {x}, y {y}; expected D65 or equal energy")),
    };
    let light = white.colour();
    let bands = Bands::uniform(RANGE_NM.0, 1.0);
    let observer = Observer::Cie1931.colour_matching_functions().map(|w| bands.weights(&w));
    let xyz_of = |index: usize| {
        let part = part(index);
        let values: Vec<f64> = bands.wavelengths_nm().iter().map(|&nm| light.at(nm) * part.at(nm)).collect();
        DVec3::from(observer.each_ref().map(|w| w.iter().zip(&values).map(|(w, v)| w * v).sum::<f64>()))
    };
    let columns = [0, 1, 2].map(xyz_of);
    // The light itself is the white, so that greys are the same in all three parts whatever the digits of the space's white.
    let whole = columns[0] + columns[1] + columns[2];
    let of_primary = space.primaries.map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
    let primaries = DMat3::from_cols(of_primary[0], of_primary[1], of_primary[2]);
    let to_xyz = primaries * DMat3::from_diagonal(primaries.inverse() * whole);
    let matrix = DMat3::from_cols(columns[0], columns[1], columns[2]).inverse() * to_xyz;
    if matrix.is_finite() { Ok((white, matrix)) } else { Err("primaries that span no colours".to_owned()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Channel;

    fn picture(values: [f32; 3], space: Space) -> PictureFile {
        let channels = (0..3).map(|k| Channel::new("c", "", Meaning::Primary(k))).collect();
        let mut description = Description::planes(1, 1, channels);
        description.rgb = Some(RgbSpace { space, encoded: false, white_luminance: None });
        PictureFile { description, samples: values.to_vec() }
    }

    /// Under D65 a pixel has the colour that IEC 61966-2-1 gives it: x, y of its primaries, Y of its matrix (0.2126, 0.7152, 0.0722).
    #[test]
    fn pixels_have_their_own_colour_under_d65() {
        let bands = Bands::uniform(RANGE_NM.0, 1.0);
        let light = White::D65.colour();
        let observer = Observer::Cie1931.colour_matching_functions().map(|w| bands.weights(&w));
        let xyz = |values: &[f64]| {
            observer.each_ref().map(|w| {
                w.iter().zip(values).zip(bands.wavelengths_nm()).map(|((w, v), &nm)| w * v * light.at(nm)).sum::<f64>()
            })
        };
        let [_, white, _] = xyz(&vec![1.0; bands.len()]);
        for (rgb, expected_y, expected_xy) in [
            ([1.0, 0.0, 0.0], 0.2126, [0.64, 0.33]),
            ([0.0, 1.0, 0.0], 0.7152, [0.30, 0.60]),
            ([0.0, 0.0, 1.0], 0.0722, [0.15, 0.06]),
            ([0.5, 0.5, 0.5], 0.5, [0.3127, 0.3290]),
        ] {
            let made = channels(picture(rgb, SRGB), Of::Factors).expect("a colour of sRGB");
            let spectra = made.spectra(&bands, &vec![1.0; bands.len()]);
            let sum: Vec<f64> = (0..bands.len())
                .map(|b| spectra.iter().zip(&made.coefficients).map(|(s, k)| s[b] * f64::from(*k)).sum())
                .collect();
            assert!(sum.iter().all(|f| (0.0..=1.0 + 1e-6).contains(f)), "{rgb:?}");
            let [x, y, z] = xyz(&sum);
            // The standard's four digits.
            assert!((y / white - expected_y).abs() < 1e-4, "{rgb:?}: {}", y / white);
            let found = [x / (x + y + z), y / (x + y + z)];
            assert!(found.iter().zip(expected_xy).all(|(a, b)| (a - b).abs() < 1e-4), "{rgb:?}: {found:?}");
        }
    }

    #[test]
    fn what_three_parts_cannot_make_is_refused() {
        let green = channels(picture([0.0, 1.0, 0.0], crate::colorimetry::rgb::REC2020), Of::Light);
        assert!(green.is_err_and(|e| e.starts_with("pixel (0, 0): a colour beyond")));
        let infinite = channels(picture([0.0, f32::INFINITY, 0.0], SRGB), Of::Light);
        assert!(infinite.is_err_and(|e| e.contains("expected finite numbers")));
    }

    #[test]
    fn bands_are_hats() {
        let channels = vec![Channel::band("a", "", 500.0), Channel::band("b", "", 600.0)];
        let content = Content::Reflectance;
        let description = Description { content, ..Description::planes(1, 1, channels) };
        let made =
            super::channels(PictureFile { description, samples: vec![0.2, 0.6] }, Of::Factors).expect("a picture");
        let at =
            |nm: f64| made.colours.iter().zip(&made.coefficients).map(|(c, k)| c.at(nm) * f64::from(*k)).sum::<f64>();
        for (nm, expected) in [(400.0, 0.2), (500.0, 0.2), (550.0, 0.4), (600.0, 0.6), (700.0, 0.6)] {
            assert!((at(nm) - expected).abs() < 1e-7, "{nm}: {}", at(nm));
        }
    }
}
