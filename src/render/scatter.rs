//! How the samples of a picture are shared out among its pixels.
//!
//! ```text
//! n ∝ σ/(L + L̄/100)/√w        σ, L, w: of the block of pixels and its neighbours
//! ```
//!
//! σ is the scatter between means of a pixel's samples, each of which is of points of its own that lie evenly, as those of the picture do: so
//! edges and textures count for no noise, and what points that lie evenly find with few samples counts for little. L counts what is
//! known of the pixels beside the samples, σ does not; pixels without light are no part of L. w is the work that a sample takes.
//!
//! So many samples a pixel make the mean of (σ/L)²/n over the picture least for a given work Σ n w (Lagrange); the hundredth of the picture's
//! mean luminance keeps dark pixels from taking all.

use super::noise::Gathered;

/// Pixels in the rows and columns of a block.
pub(super) const BLOCK: usize = 4;
/// No pixel gets less than this share of the mean, as what is rare may not have been seen.
const LEAST: f64 = 0.125;

/// Luminances of a block.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Scattered {
    pixels: f64,
    /// Means, and those of pixels with light.
    count: f64,
    lit: f64,
    sum: f64,
    /// Σ of the squares of what they are off from their pixel's mean.
    within: f64,
    known: f64,
    work: f64,
}

impl Scattered {
    /// The means of samples of a pixel, what of its luminance is known beside them, and the work that they took.
    pub(super) fn add(&mut self, pixel: &Gathered, known: f64, work: f64) {
        let Gathered { count, mean, squares: within, .. } = *pixel;
        if count > 0.0 {
            let lit = if mean + known > 0.0 { count } else { 0.0 };
            let (sum, known) = (count * mean, count * known);
            self.append(1.0, Self { pixels: 1.0, count, lit, sum, within, known, work });
        }
    }

    fn append(&mut self, weight: f64, other: Self) {
        self.pixels += weight * other.pixels;
        self.count += weight * other.count;
        self.lit += weight * other.lit;
        self.sum += weight * other.sum;
        self.within += weight * other.within;
        self.known += weight * other.known;
        self.work += weight * other.work;
    }

    /// σ; 0 where no pixel has two means.
    fn deviation(&self) -> f64 {
        if self.count > self.pixels { (self.within / (self.count - self.pixels)).sqrt() } else { 0.0 }
    }

    /// σ/(L + `dark`); 0 without light.
    fn noise(&self, dark: f64) -> f64 {
        // No number where nothing is lit.
        let luminance = (self.sum + self.known) / self.lit + dark;
        if luminance > 0.0 { self.deviation() / luminance } else { 0.0 }
    }

    /// √w, but for a factor that all have in common; 1 without samples.
    fn root_work(&self) -> f64 {
        if self.work > 0.0 { (self.work / self.count).sqrt() } else { 1.0 }
    }
}

/// Luminances by block.
#[derive(Debug)]
pub(super) struct Scatter {
    width: usize,
    height: usize,
    blocks: Vec<Scattered>,
}

impl Scatter {
    /// Of a picture of so many columns and rows.
    pub(super) fn new(width: usize, height: usize) -> Self {
        let blocks = vec![Scattered::default(); width.div_ceil(BLOCK) * height.div_ceil(BLOCK)];
        Self { width, height, blocks }
    }

    /// Luminances of a row of pixels, by block.
    pub(super) fn add(&mut self, y: usize, row: &[Scattered]) {
        let blocks = &mut self.blocks[y / BLOCK * self.width.div_ceil(BLOCK)..];
        blocks.iter_mut().zip(row).for_each(|(block, more)| block.append(1.0, *more));
    }

    /// The mean over the blocks that have samples of σ/(L + L̄/100).
    pub(super) fn noise(&self) -> f64 {
        let seen: Vec<bool> = self.blocks.iter().map(|block| block.count > 0.0).collect();
        let noises = self.near(|near, dark| near.noise(dark));
        let sum: f64 = noises.iter().zip(&seen).filter(|(_, seen)| **seen).map(|(noise, _)| noise).sum();
        sum / seen.iter().filter(|seen| **seen).count().max(1) as f64
    }

    /// A number of every block together with its neighbours, row by row; `of` is given these and a hundredth of the picture's mean luminance.
    fn near(&self, of: impl Fn(&Scattered, f64) -> f64) -> Vec<f64> {
        let columns = self.width.div_ceil(BLOCK);
        let rows = self.height.div_ceil(BLOCK);
        let mut all = Scattered::default();
        self.blocks.iter().for_each(|block| all.append(1.0, *block));
        let dark = 0.01 * (all.sum + all.known) / all.count.max(1.0);
        let around = |bx: usize, by: usize| -> f64 {
            let mut near = Scattered::default();
            for y in by.saturating_sub(1)..(by + 2).min(rows) {
                for x in bx.saturating_sub(1)..(bx + 2).min(columns) {
                    // The block itself counts as much as half of those around it.
                    near.append(if (x, y) == (bx, by) { 4.0 } else { 1.0 }, self.blocks[y * columns + x]);
                }
            }
            of(&near, dark)
        };
        (0..rows * columns).map(|b| around(b % columns, b / columns)).collect()
    }

    /// Samples of each pixel, row by row, of which there are `mean` on average (but for rounding to whole ones).
    pub(super) fn samples(&self, mean: u64) -> Vec<u32> {
        let columns = self.width.div_ceil(BLOCK);
        let blocks = self.near(|near, dark| near.noise(dark) / near.root_work());
        let average = blocks.iter().sum::<f64>() / blocks.len() as f64;
        // One sample does not tell its noise.
        let least = if mean > 1 { 2.0 } else { 1.0 };
        let share = |b: f64| if average > 0.0 { LEAST + (1.0 - LEAST) * b / average } else { 1.0 };
        let of = |x: usize, y: usize| share(blocks[y / BLOCK * columns + x / BLOCK]);
        (0..self.width * self.height)
            .map(|i| {
                let samples =
                    (mean as f64 * of(i % self.width, i / self.width)).round().clamp(least, f64::from(u32::MAX));
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
                let samples = samples as u32;
                samples
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixel(luminances: &[f64]) -> Gathered {
        let mut pixel = Gathered::default();
        luminances.iter().for_each(|l| pixel.add(*l));
        pixel
    }

    /// Blocks of luminance 1 ± σ: samples in proportion to σ, an eighth of the mean for those without noise, and as many in all.
    #[test]
    fn samples_go_where_the_noise_is() {
        let (width, height) = (62, 40);
        let mut scatter = Scatter::new(width, height);
        let sigma = |x: usize| if x < 32 { 0.0 } else { 0.5 };
        for y in 0..height {
            let mut row = vec![Scattered::default(); width.div_ceil(BLOCK)];
            for x in 0..width {
                row[x / BLOCK].add(&pixel(&[1.0 - sigma(x), 1.0 + sigma(x)]), 0.0, 1.0);
                row[x / BLOCK].add(&Gathered::default(), 0.0, 1.0);
            }
            scatter.add(y, &row);
        }
        let samples = scatter.samples(800);
        assert_eq!(samples.len(), width * height);
        assert_eq!(samples[5 * width + 3], 100);
        let (first, other) = (samples[5 * width + 45], samples[35 * width + 55]);
        assert_eq!(first, other);
        assert!(first > 1400, "{first}");
        let mean = samples.iter().map(|&n| f64::from(n)).sum::<f64>() / samples.len() as f64;
        // The last blocks are half as wide as the others, of which the mean is taken.
        assert!((mean / 800.0 - 1.0).abs() < 0.05, "{mean}");
    }

    /// The same noise matters a third as much where three times as much light is known to be.
    #[test]
    fn what_is_known_counts_as_light() {
        let mut scatter = Scatter::new(96, 4);
        let mut row = vec![Scattered::default(); 24];
        for (x, block) in row.iter_mut().enumerate() {
            block.add(&pixel(&[0.5, 1.5]), if x < 12 { 0.0 } else { 2.0 }, 1.0);
        }
        scatter.add(0, &row);
        let samples = scatter.samples(1 << 20);
        let share = |x: usize| (f64::from(samples[x]) / f64::from(1 << 20) - LEAST) / (1.0 - LEAST);
        // The picture's mean is 2, a hundredth of which is added to both.
        assert!((share(4) / share(90) - 3.02 / 1.02).abs() < 1e-4, "{} {}", share(4), share(90));
    }

    /// Of equal noise, samples of four times the work are taken half as often.
    #[test]
    fn dear_samples_are_taken_less_often() {
        let mut scatter = Scatter::new(96, 4);
        let mut row = vec![Scattered::default(); 24];
        for (x, block) in row.iter_mut().enumerate() {
            // Of two samples together.
            block.add(&pixel(&[0.5, 1.5]), 0.0, if x < 12 { 12.0 } else { 3.0 });
        }
        scatter.add(0, &row);
        let samples = scatter.samples(1 << 20);
        let share = |x: usize| (f64::from(samples[x]) / f64::from(1 << 20) - LEAST) / (1.0 - LEAST);
        assert!((share(90) / share(4) - 2.0).abs() < 1e-4, "{} {}", share(4), share(90));
        // What is compared to choose a way is the noise, whatever it took: σ² = 0.5 of a block, at the mean 1 and its hundredth.
        assert!((scatter.noise() - 0.5_f64.sqrt() / 1.01).abs() < 1e-12, "{}", scatter.noise());
    }

    #[test]
    fn a_picture_without_light_or_noise_is_sampled_evenly() {
        for luminance in [0.0, 3.0] {
            let mut scatter = Scatter::new(9, 5);
            let mut row = vec![Scattered::default(); 3];
            row.iter_mut().for_each(|block| block.add(&pixel(&[luminance; 2]), 0.0, 1.0));
            (0..5).for_each(|y| scatter.add(y, &row));
            assert!(scatter.samples(7).iter().all(|&n| n == 7));
        }
    }

    /// At a horizon, blocks a quarter of which is lit have the σ² of a quarter, at the luminance of what is lit: half of the samples.
    #[test]
    fn what_is_black_darkens_nothing() {
        let mut scatter = Scatter::new(96, 4);
        let mut row = vec![Scattered::default(); 24];
        for (x, block) in row.iter_mut().enumerate() {
            for pixel_number in 0..4 {
                let black = x < 12 && pixel_number > 0;
                block.add(&pixel(if black { &[0.0, 0.0] } else { &[0.5, 1.5] }), 0.0, 1.0);
            }
        }
        scatter.add(0, &row);
        let samples = scatter.samples(1 << 20);
        let share = |x: usize| (f64::from(samples[x]) / f64::from(1 << 20) - LEAST) / (1.0 - LEAST);
        assert!((share(90) / share(4) - 2.0).abs() < 1e-4, "{} {}", share(4), share(90));
    }

    /// A checkerboard without noise takes no more samples than a wall without.
    #[test]
    fn what_differs_from_pixel_to_pixel_is_no_noise() {
        let mut scatter = Scatter::new(96, 4);
        let mut row = vec![Scattered::default(); 24];
        for (x, block) in row.iter_mut().enumerate() {
            let board = if x < 12 { [0.5, 1.5] } else { [1.0, 1.0] };
            board.iter().for_each(|l| block.add(&pixel(&[l - 1e-3, l + 1e-3]), 0.0, 1.0));
        }
        scatter.add(0, &row);
        let samples = scatter.samples(1000);
        assert_eq!((samples[10], samples[90]), (1000, 1000));
    }
}
