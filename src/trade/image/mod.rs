//! The trade of a spectral image: how many bands, how many pixels and how many bits its luminance and colours take.
//!
//! | knob | values |
//! |---|---|
//! | `bands` | the image's own, 81, 32, 16, 8 (as far as they are fewer), RGB |
//! | `filter` | bands sampled (a renderer's) or averaged (a camera's): [`Bands`] |
//! | `block` | pixels as they are, or means over 2 × 2, 4 × 4, 8 × 8 of them |
//! | `precision` | samples as `f32`, or rounded to `f16` |
//!
//! **RGB** is linear sRGB, negative parts cut: of light its colour; of reflectance the surface under D65 and the illuminant, multiplied
//! channel by channel, as renderers in RGB do.
//!
//! **Figures**, over the pixels: `luminance` and `melanopic`, root of the mean square error over the mean; `chromaticity_xy`, root of the
//! mean square distance; CIEDE2000, mean and largest, of light against D65 as bright as the brightest pixel, of reflectance against the
//! perfect diffuser. A reduced pixel stands for all pixels of its block.
//!
//! **Reference**: all bands and pixels, under the same contract. What lies between the bands is not known: what a cubic spline through
//! them, sampled four times as finely, changes counts as the reference's own error, with half a unit in the last place of `f32`.

mod kept;
mod seen;

use self::kept::{Kept, Rgb};
use self::seen::{Reference, Seen, refined};
use super::timing::interleaved;
use super::{Estimate, Figure, Sweep, Trial};
use crate::image::reduced::Bands;
use crate::image::{Error, Memory, PlanError, Region, Settings, Source};

/// Numbers of bands that are tried.
const BANDS: [usize; 4] = [81, 32, 16, 8];
/// Sides of the blocks that are tried.
const BLOCKS: [usize; 4] = [1, 2, 4, 8];
/// Samples of an image that are tried at most.
const MOST_SAMPLES: usize = 1 << 22;

/// How many figures are watched.
const COUNT: usize = 5;
/// The figures watched, in the order of the errors.
pub static FIGURES: [Figure; COUNT] = [
    Figure::relative("luminance"),
    Figure::absolute("chromaticity_xy", ""),
    Figure::absolute("delta_e_2000", ""),
    Figure::absolute("delta_e_2000_worst", ""),
    Figure::relative("melanopic"),
];

/// Which bands a trial has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spectral {
    /// All.
    Own,
    /// So many.
    Fewer(usize, Bands),
    /// Linear sRGB.
    Rgb,
}

/// How an image was kept in a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// Its bands.
    pub spectral: Spectral,
    /// Side of the blocks of pixels.
    pub block: usize,
    /// Samples in half precision.
    pub half: bool,
}

impl Choice {
    fn words(&self) -> Vec<String> {
        let (bands, filter) = match self.spectral {
            Spectral::Own => ("own".to_owned(), "none"),
            Spectral::Fewer(n, how) => (n.to_string(), how.word()),
            Spectral::Rgb => ("rgb".to_owned(), "none"),
        };
        vec![bands, filter.to_owned(), self.block.to_string(), if self.half { "f16" } else { "f32" }.to_owned()]
    }
}

/// Why an image could not be traded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// It has no tristimulus values.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Fewer than three bands leave nothing to choose from.
    #[error("the image has {found} bands; expected a spectral image of 3 or more")]
    Bands {
        /// Its bands.
        found: usize,
    },
    /// All pixels are dark, or no numbers.
    #[error("no pixel has a luminance above 0; expected an image of light, or of surfaces under one")]
    Dark,
}

/// A sweep, and what was chosen in each of its trials.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageSweep {
    /// The trials; the figures are [`FIGURES`].
    pub sweep: Sweep,
    /// Their choices.
    pub choices: Vec<Choice>,
}

/// An image in memory: the whole of it, or of a large one as many pixels about its middle as 4 Mi samples are.
///
/// # Errors
/// Those of the source.
pub fn middle(source: &mut dyn Source) -> Result<Memory, Error> {
    let mut description = source.description().clone();
    let channels: Vec<usize> = (0..description.channels.len()).collect();
    let all = (description.pixels() * channels.len()) as f64;
    let share = (MOST_SAMPLES as f64 / all).sqrt().min(1.0);
    let side = |pixels: usize| ((pixels as f64 * share).ceil() as usize).clamp(1, pixels.max(1));
    let (width, height) = (side(description.width), side(description.height));
    let (x, y) = ((description.width - width) / 2, (description.height - height) / 2);
    let mut samples = vec![0.0; width * height * channels.len()];
    source.read(Region { x, y, width, height }, &channels, &mut samples)?;
    (description.width, description.height) = (width, height);
    Ok(Memory::new(description, samples))
}

/// Tries an image in memory, each choice timed `repeats` times: the time to its X, Y and Z. `settings` are those of its conversion.
///
/// # Errors
/// [`ImageError`].
pub fn sweep(image: &Memory, settings: &Settings, repeats: usize) -> Result<ImageSweep, ImageError> {
    let description = image.description();
    let own = description.bands().len();
    if own < 3 {
        return Err(ImageError::Bands { found: own });
    }
    let reference = Seen::of(image, settings)?;
    let reference = Reference::new(description, reference, settings)?;
    let smooth = Seen::of(&refined(image), settings)?;
    let last_place = f64::from(f32::EPSILON) / 2.0;
    let own_errors = reference.errors(&smooth, 1).map(|e| e.map(|e| e + last_place));
    let fewer = BANDS.into_iter().filter(|n| *n < own);
    let spectral: Vec<Spectral> = std::iter::once(Spectral::Own)
        .chain(fewer.flat_map(|n| [Bands::Sampled, Bands::Averaged].map(|how| Spectral::Fewer(n, how))))
        .chain([Spectral::Rgb])
        .collect();
    let rgb = Rgb::of(image, settings)?;
    let mut kept = Vec::new();
    for spectral in spectral {
        for block in BLOCKS.into_iter().filter(|b| *b <= description.width.min(description.height)) {
            for half in [false, true] {
                let choice = Choice { spectral, block, half };
                match Kept::new(image, &rgb, choice, settings) {
                    Ok(one) => kept.push((choice, one)),
                    // A rule may refuse bands that are far apart: such a choice is none.
                    Err(ImageError::Plan(_)) if spectral != Spectral::Own => {}
                    Err(error) => return Err(error),
                }
            }
        }
    }
    let mut errors = Vec::with_capacity(kept.len());
    for (choice, kept) in &kept {
        errors.push(reference.errors(&kept.seen(settings)?, choice.block));
    }
    let timings = interleaved(kept.len(), repeats, |i| Ok::<_, ImageError>(kept[i].1.xyz()))?;
    let choices: Vec<Choice> = kept.iter().map(|(choice, _)| *choice).collect();
    let trials = choices.iter().zip(timings).zip(errors).map(|((choice, timing), errors)| Trial {
        settings: choice.words(),
        offered: choice.spectral != Spectral::Rgb,
        timing,
        errors: errors.iter().map(|e| e.map(Estimate::exact)).collect(),
    });
    let (width, height) = (description.width, description.height);
    let sweep = Sweep {
        reference: format!(
            "all {own} bands of {width} × {height} pixels, give or take the difference to a spline through the bands"
        ),
        knobs: vec!["bands", "filter", "block", "precision"],
        figures: FIGURES.to_vec(),
        reference_errors: own_errors.to_vec(),
        trials: trials.collect(),
    };
    Ok(ImageSweep { sweep, choices })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::SecondRadiation;
    use crate::illuminant::named;
    use crate::image::{Channel, Content, Description, Meaning};
    use crate::spectrum::integrate::{Contract, Rule};

    /// 380–780 nm by 1 nm; the sample at (x, y) is that of `f`.
    fn cube(width: usize, height: usize, content: Content, f: impl Fn(usize, usize, f64) -> f64) -> Memory {
        let nm = |b: usize| 380.0 + b as f64;
        let mut description = Description::planes(
            width,
            height,
            (0..401).map(|b| Channel::band(format!("{}", nm(b)), "", nm(b))).collect(),
        );
        description.content = content;
        let mut samples = Vec::new();
        for y in 0..height {
            for b in 0..401 {
                samples.extend((0..width).map(|x| f(x, y, nm(b)) as f32));
            }
        }
        Memory::new(description, samples)
    }

    const LIGHT: Content = Content::Light { quantity: None, unit: None };

    fn exact(illuminant: Option<&str>) -> Settings {
        let light = illuminant.map(|name| named::source(name, SecondRadiation::default()).expect("a source"));
        Settings {
            contract: Contract { rule: Some(Rule::Exact), range_nm: None },
            illuminant: light.map(|l| (l.name, l.spectrum)),
            ..Settings::default()
        }
    }

    fn error(s: &ImageSweep, choice: Choice, key: &str) -> Option<f64> {
        let figure = FIGURES.iter().position(|f| f.key == key).expect("a figure");
        let trial = s.choices.iter().position(|c| *c == choice).expect("it was tried");
        s.sweep.trials[trial].errors[figure].map(|e| e.error)
    }

    #[test]
    fn straight_lines_between_fewer_bands_lose_with_the_square_of_their_distance() {
        // Straight lines through 1 + a (λ − λ₀)² at a distance h are too high by a h²/6 in the mean.
        let a = 1.0 / 40_000.0;
        let s = |nm: f64| 1.0 + a * (nm - 580.0).powi(2);
        let found = sweep(&cube(2, 2, LIGHT, |_, _, nm| s(nm)), &exact(None), 1).expect("a sweep");
        let y = crate::tables::get("cie-1931-2deg").expect("a table");
        let bar = y.wavelengths_nm().iter().zip(y.column("y_bar").expect("a column"));
        let bar: Vec<(f64, f64)> =
            bar.map(|(nm, v)| (*nm, *v)).filter(|(nm, _)| (380.0..=780.0).contains(nm)).collect();
        let (whole, weighted) = bar.iter().fold((0.0, 0.0), |(w, s2), (nm, v)| (w + v, s2 + v * s(*nm)));
        let mut points = Vec::new();
        for count in [32, 81] {
            let h = 400.0 / (count - 1) as f64;
            let expected = a * (h * h - 1.0) / 6.0 * whole / weighted;
            let choice = Choice { spectral: Spectral::Fewer(count, Bands::Sampled), block: 1, half: false };
            let error = error(&found, choice, "luminance").expect("a luminance");
            // ȳ weighs the lines' places unevenly where they are far apart.
            assert!((error / expected - 1.0).abs() < 0.02, "{count}: {error}, expected {expected}");
            points.push((h.ln(), error.ln()));
        }
        let slope = (points[0].1 - points[1].1) / (points[0].0 - points[1].0);
        assert!((slope - 2.0).abs() < 0.05, "{slope}");
        let own = Choice { spectral: Spectral::Own, block: 1, half: false };
        assert_eq!(error(&found, own, "luminance"), Some(0.0));
        // Colours have no melanopic content.
        assert_eq!(error(&found, Choice { spectral: Spectral::Rgb, ..own }, "melanopic"), None);
    }

    #[test]
    fn blocks_of_a_ramp_err_by_the_spread_within_them() {
        // The spread of b equal steps about their mean is √((b² − 1)/12) steps.
        let found = sweep(&cube(16, 8, LIGHT, |x, _, _| 10.0 + x as f64), &exact(None), 1).expect("a sweep");
        for block in BLOCKS {
            let choice = Choice { spectral: Spectral::Own, block, half: false };
            let expected = (((block * block - 1) as f64) / 12.0).sqrt() / 17.5;
            let error = error(&found, choice, "luminance").expect("a luminance");
            assert!((error - expected).abs() < 1e-6, "{block}: {error}, expected {expected}");
        }
        // Half precision has 11 bits: no sample is off by more than 2⁻¹¹ of it.
        let half = Choice { spectral: Spectral::Own, block: 1, half: true };
        assert!(error(&found, half, "luminance").expect("a luminance") <= f64::powi(2.0, -11));
    }

    #[test]
    fn rgb_is_right_under_its_own_white_and_for_greys_alone() {
        // A green, and a grey; both inside sRGB.
        let surface = |x: usize, _: usize, nm: f64| {
            if x == 0 { 0.3 } else { 0.2 + 0.3 * (-((nm - 540.0) / 60.0).powi(2)).exp() }
        };
        let image = |x0: usize| cube(1, 1, Content::Reflectance, move |_, y, nm| surface(x0, y, nm));
        let rgb = Choice { spectral: Spectral::Rgb, block: 1, half: false };
        let off = |x0: usize, light: &str| {
            let found = sweep(&image(x0), &exact(Some(light)), 1).expect("a sweep");
            error(&found, rgb, "delta_e_2000").expect("a difference")
        };
        // Three roundings to f32 of values near white: ΔE of 1e-4 would be 1e-6 of them.
        assert!(off(0, "D65") < 1e-3 && off(1, "D65") < 1e-3 && off(0, "A") < 1e-3);
        assert!(off(1, "A") > 0.5);
    }

    #[test]
    fn large_images_are_tried_about_their_middle() {
        let channels = (0..3).map(|b| Channel::band(format!("{b}"), "", 500.0 + 50.0 * b as f64)).collect();
        let description = Description::planes(2048, 1024, channels);
        let samples = (0..1024).flat_map(|y| (0..3).flat_map(move |b| (0..2048).map(move |x| (x + y + b) as f32)));
        let mut whole = Memory::new(description, samples.collect());
        let part = middle(&mut whole).expect("memory does not fail");
        let (width, height) = (part.description().width, part.description().height);
        assert!(width * height * 3 >= MOST_SAMPLES && width * height * 3 <= MOST_SAMPLES + 3 * (width + height + 1));
        let (x, y) = ((2048 - width) / 2, (1024 - height) / 2);
        assert_eq!(part.at(0, 0, 1), whole.at(x, y, 1));
        let few = Memory::new(Description::planes(1, 1, vec![Channel::new("Y", "", Meaning::Photopic)]), vec![1.0]);
        assert_eq!(sweep(&few, &Settings::default(), 1), Err(ImageError::Bands { found: 0 }));
    }
}
