//! An image in memory: for what is small, made by calculation, or in a test.

use super::description::Description;
use super::error::Error;
use super::source::{self, Region, Source};

/// An image with all its samples, in the order described at [`crate::image`].
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    description: Description,
    samples: Vec<f32>,
}

impl Memory {
    /// An image of the samples given.
    ///
    /// # Panics
    /// Where there are not as many samples as pixels times channels.
    #[must_use]
    pub fn new(description: Description, samples: Vec<f32>) -> Self {
        assert_eq!(
            samples.len(),
            description.pixels() * description.channels.len(),
            "samples for every pixel and channel"
        );
        Self { description, samples }
    }

    /// The whole of another image; the caller answers for its size.
    ///
    /// # Errors
    /// Those of the source.
    pub fn load(source: &mut dyn Source) -> Result<Self, Error> {
        let description = source.description().clone();
        let channels: Vec<usize> = (0..description.channels.len()).collect();
        let mut samples = vec![0.0; description.pixels() * channels.len()];
        source.read(Region::rows(&description, 0, description.height), &channels, &mut samples)?;
        Ok(Self { description, samples })
    }

    /// The samples.
    #[must_use]
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// One sample.
    ///
    /// # Panics
    /// Outside of the image.
    #[must_use]
    pub fn at(&self, x: usize, y: usize, channel: usize) -> f32 {
        assert!(x < self.description.width && channel < self.description.channels.len(), "inside the image");
        self.samples[(y * self.description.channels.len() + channel) * self.description.width + x]
    }
}

impl Source for Memory {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        let (width, count) = (self.description.width, self.description.channels.len());
        let wanted = (region.y..region.y + region.height).flat_map(|y| channels.iter().map(move |c| (y, c)));
        for ((y, c), out) in wanted.zip(out.chunks_exact_mut(region.width.max(1))) {
            let start = (y * count + c) * width + region.x;
            out.copy_from_slice(&self.samples[start..start + region.width]);
        }
        Ok(())
    }
}
