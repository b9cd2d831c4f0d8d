//! Choosing the light that a packet of flux comes from: in proportion to the lights' fluxes.

use std::sync::Arc;

use super::Light;

/// The lights' shares in the flux of all.
#[derive(Debug, Clone, PartialEq)]
pub struct Shares {
    /// Running sums, up to 1; NaN where nothing shines.
    sums: Vec<f64>,
}

impl Shares {
    /// Of lights whose spectra have so many bands.
    #[must_use]
    pub fn new(lights: &[Arc<dyn Light>], bands: usize) -> Self {
        let mut flux = vec![0.0; bands];
        let mut sum = 0.0;
        let mut sums: Vec<f64> = (lights.iter())
            .map(|light| {
                light.flux(&mut flux);
                // Colours beyond a picture's primaries can make a sum negative, which no probability is.
                sum += flux.iter().sum::<f64>().max(0.0);
                sum
            })
            .collect();
        sums.iter_mut().for_each(|s| *s /= sum);
        Self { sums }
    }

    /// A light, from a uniform number, and its probability; `None` where nothing shines.
    #[must_use]
    pub fn draw(&self, u: f64) -> Option<(usize, f64)> {
        let index = self.sums.partition_point(|&s| s <= u);
        let probability = self.probability(index);
        // Where nothing shines there are no shares.
        (probability > 0.0).then_some((index, probability))
    }

    /// The probability of a light; 0 for one that is not there.
    #[must_use]
    pub fn probability(&self, light: usize) -> f64 {
        let below = if light == 0 { 0.0 } else { self.sums.get(light - 1).copied().unwrap_or(0.0) };
        self.sums.get(light).map_or(0.0, |sum| sum - below)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::point::Point;
    use super::*;

    #[test]
    fn lights_are_drawn_by_their_flux() {
        let lights: Vec<Arc<dyn Light>> =
            [1.0, 0.0, 3.0].map(|i| Arc::new(Point::new(DVec3::X, &[i]).expect("a light")) as Arc<dyn Light>).to_vec();
        let shares = Shares::new(&lights, 1);
        assert_eq!([0, 1, 2, 3].map(|i| shares.probability(i)), [0.25, 0.0, 0.75, 0.0]);
        assert_eq!((shares.draw(0.2), shares.draw(0.25)), (Some((0, 0.25)), Some((2, 0.75))));
        assert_eq!(Shares::new(&lights[1..2], 1).draw(0.5), None);
        assert_eq!(Shares::new(&[], 1).draw(0.5), None);
    }
}
