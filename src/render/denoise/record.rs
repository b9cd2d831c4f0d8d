//! What is kept of a row of pixels to be denoised: two halves of the samples, each with what the camera saw.

use glam::DVec3;

use crate::render::integrator::path::Sight;
use crate::render::noise::Gathered;

/// Numbers that a [`Sight`] has: the place from the camera (x, y, z in m), the normal (x, y, z), the reflectance (0 to 1) and the emission in
/// W/(m²·sr·nm).
pub const FEATURES: usize = 8;
/// The halves of the samples.
pub const HALVES: usize = 2;
/// Pixels that are written together.
const TOGETHER: usize = 16;

/// Where things stand in a record: for each half the bands in W/(m²·sr·nm), the features, the variance of the luminance's mean in (cd/m²)² and the number of
/// samples; then the features as rays see them that only look, and the number of these. Each for all pixels of the row, from the left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Bands of the scene.
    pub bands: usize,
}

impl Layout {
    /// Numbers of a pixel.
    #[must_use]
    pub fn channels(self) -> usize {
        self.looks() + 1
    }

    /// The channel where the features begin that rays see which only look.
    #[must_use]
    pub fn seen(self) -> usize {
        HALVES * self.of_half()
    }

    /// The channel of the number of rays that only look.
    #[must_use]
    pub fn looks(self) -> usize {
        self.seen() + FEATURES
    }

    fn of_half(self) -> usize {
        self.bands + FEATURES + 2
    }

    /// The channel where the bands of a half begin.
    #[must_use]
    pub fn band(self, half: usize) -> usize {
        half * self.of_half()
    }

    /// The channel where the features of a half begin.
    #[must_use]
    pub fn feature(self, half: usize) -> usize {
        self.band(half) + self.bands
    }

    /// The channel of the variance of a half.
    #[must_use]
    pub fn variance(self, half: usize) -> usize {
        self.feature(half) + FEATURES
    }

    /// The channel of the number of samples of a half.
    #[must_use]
    pub fn count(self, half: usize) -> usize {
        self.variance(half) + 1
    }
}

/// The sums of a half of a pixel's samples.
#[derive(Debug, Clone, Default)]
pub(in crate::render) struct Half {
    bands: Vec<f64>,
    features: [f64; FEATURES],
    luminance: Gathered,
}

impl Half {
    pub(in crate::render) fn new(bands: usize) -> Self {
        Self { bands: vec![0.0; bands], ..Self::default() }
    }

    /// Adds a sample and what was seen, as far as it lies from `camera`; nothing where the lens shows nothing.
    pub(in crate::render) fn add(&mut self, sample: Option<(&[f64], &Sight)>, camera: DVec3, luminance: f64) {
        if let Some((sample, sight)) = sample {
            self.bands.iter_mut().zip(sample).for_each(|(sum, s)| *sum += s);
            self.features.iter_mut().zip(features(sight, camera)).for_each(|(sum, s)| *sum += s);
        }
        self.luminance.add(luminance);
    }

    /// Of the samples so far.
    pub(in crate::render) fn luminance(&self) -> &Gathered {
        &self.luminance
    }

    /// Writes the means of half number `half` of a row of pixels into its record.
    pub(in crate::render) fn write(row: &[Self], layout: Layout, half: usize, record: &mut [f32]) {
        // Channel by channel, as those of a pixel stand far apart, of so few pixels that their sums stay in a core's nearest cache.
        for (number, pixels) in row.chunks(TOGETHER).enumerate() {
            let mut put = |channel: usize, number_of: &dyn Fn(&Self) -> f64| {
                let places = &mut record[channel * row.len() + number * TOGETHER..];
                places.iter_mut().zip(pixels).for_each(|(place, pixel)| *place = narrow(number_of(pixel)));
            };
            let mean = |pixel: &Self, sum: f64| sum / pixel.luminance.count.max(1.0);
            (0..layout.bands).for_each(|band| put(layout.band(half) + band, &|pixel| mean(pixel, pixel.bands[band])));
            (0..FEATURES).for_each(|f| put(layout.feature(half) + f, &|pixel| mean(pixel, pixel.features[f])));
            put(layout.variance(half), &|pixel| pixel.luminance.variance());
            put(layout.count(half), &|pixel| pixel.luminance.count);
        }
    }
}

/// What is seen, as far as it lies from `camera`.
fn features(sight: &Sight, camera: DVec3) -> [f64; FEATURES] {
    let Sight { position, normal, reflectance, emission } = *sight;
    let way = if normal == DVec3::ZERO { DVec3::ZERO } else { position - camera };
    [way.x, way.y, way.z, normal.x, normal.y, normal.z, reflectance, emission]
}

/// What the rays of a pixel see that only look.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::render) struct See {
    features: [f64; FEATURES],
    count: f64,
    /// The least and the greatest emission.
    emission: [f64; 2],
    /// Some of them show mirrors or glass, or nothing.
    unknown: bool,
}

impl See {
    /// Adds what a ray sees; `None` where that is not known.
    pub(in crate::render) fn add(&mut self, sight: Option<&Sight>, camera: DVec3) {
        let Some(sight) = sight else {
            self.unknown = true;
            return;
        };
        self.features.iter_mut().zip(features(sight, camera)).for_each(|(sum, s)| *sum += s);
        let [least, greatest] = if self.count > 0.0 { self.emission } else { [sight.emission; 2] };
        self.emission = [least.min(sight.emission), greatest.max(sight.emission)];
        self.count += 1.0;
    }

    /// Whether something shines much more than what is beside it.
    pub(in crate::render) fn is_at_an_edge(&self) -> bool {
        let [least, greatest] = self.emission;
        !self.unknown && greatest > 2.0 * least
    }

    /// Writes the means at column `x` of a record of `width` pixels; nothing where something is not known, which would leave a part out.
    pub(in crate::render) fn write(&self, layout: Layout, x: usize, width: usize, record: &mut [f32]) {
        if self.unknown || self.count == 0.0 {
            return;
        }
        let means = self.features.iter().map(|sum| sum / self.count).chain([self.count]);
        (layout.seen()..).zip(means).for_each(|(channel, number)| record[channel * width + x] = narrow(number));
    }
}

#[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
pub(super) fn narrow(value: f64) -> f32 {
    value as f32
}
