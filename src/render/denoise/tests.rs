use std::f64::consts::TAU;

use super::record::FEATURES;
use super::*;
use crate::image::description::{Channel, Meaning};
use crate::math::random::Stream;

/// Numbers of the standard normal distribution (Box and Muller).
fn normal(stream: &mut Stream) -> f64 {
    let radius = (-2.0 * (1.0 - stream.uniform()).ln()).sqrt();
    radius * (TAU * stream.uniform()).cos()
}

/// A picture of one band, which is its luminance: `of` gives a pixel's luminance, its features and σ of the mean of each half, of 8 samples each.
fn sampled(size: [usize; 2], seed: u64, of: impl Fn(usize, usize) -> (f64, [f64; FEATURES], f64)) -> Denoised {
    let [width, height] = size;
    let (layout, mut stream) = (Layout { bands: 1 }, Stream::new(seed, 0));
    let rows: Vec<Vec<f32>> = (0..height)
        .map(|y| {
            let mut row = vec![0.0; layout.channels() * width];
            for x in 0..width {
                let (luminance, features, sigma) = of(x, y);
                for half in 0..HALVES {
                    let mut set = |channel: usize, value: f64| row[channel * width + x] = narrow(value);
                    set(layout.band(half), luminance + sigma * normal(&mut stream));
                    (0..).zip(features).for_each(|(k, f)| set(layout.feature(half) + k, f));
                    set(layout.variance(half), sigma * sigma);
                    set(layout.count(half), 8.0);
                }
            }
            row
        })
        .collect();
    let channels = vec![Channel::band("555 nm", "", 555.0), Channel::new("Y", "", Meaning::Tristimulus(1))];
    denoise(Description::planes(width, height, channels), &[[0.0, 1.0, 0.0]], &rows)
}

/// The luminances of a picture, row by row.
fn luminances(picture: &Denoised) -> Vec<f64> {
    let width = picture.description.width;
    picture.rows.iter().flat_map(|row| row[2 * width..3 * width].iter().map(|v| f64::from(*v))).collect()
}

/// The mean squared error, relative as in [`Price`].
fn error(picture: &Denoised, truth: impl Fn(usize, usize) -> f64) -> f64 {
    let (found, width) = (luminances(picture), picture.description.width);
    let truth: Vec<f64> = (0..found.len()).map(|i| truth(i % width, i / width)).collect();
    let n = found.len() as f64;
    let dark = DARK * found.iter().sum::<f64>() / n;
    found.iter().zip(&truth).map(|(l, t)| (l - t).powi(2) / (l * l + dark * dark)).sum::<f64>() / n
}

/// A plane wall: position, normal, reflectance.
fn wall(x: usize, y: usize) -> [f64; FEATURES] {
    [x as f64, y as f64, 7.0, 0.0, 0.0, 1.0, 0.5, 0.0]
}

/// Without noise nothing is borrowed, in pictures of several tiles.
#[test]
fn what_has_no_noise_stays_as_it_is() {
    let truth = |x: usize, y: usize| 1.0 + ((x * 7 + y * 13) % 5) as f64;
    let picture = sampled([150, 12], 1, |x, y| (truth(x, y), wall(x, y), 0.0));
    let found = luminances(&picture);
    // What f32 rounds.
    assert!(found.iter().enumerate().all(|(i, l)| (l / truth(i % 150, i / 150) - 1.0).abs() < 1e-6));
    assert_eq!(picture.price(), Price { before: 0.0, after: picture.price().after });
    assert!(picture.price().after < 1e-6);
}

/// What is linear in the features is kept however much is borrowed: a texture, a slope. The ridge takes a thousandth off slopes.
#[test]
fn what_the_camera_sees_is_kept() {
    let reflectance = |x: usize, y: usize| if (x / 2 + y / 3).is_multiple_of(2) { 0.9 } else { 0.2 };
    let truth = |x: usize, y: usize| 10.0 * reflectance(x, y) + 0.05 * x as f64 - 0.02 * y as f64 + 3.0;
    let sigma = 0.3;
    let picture = sampled([150, 8], 2, |x, y| {
        let mut features = wall(x, y);
        features[6] = reflectance(x, y);
        (truth(x, y), features, sigma)
    });
    let found = luminances(&picture);
    // A fit of five numbers to the pixels of both halves leaves σ √(5/242), in a corner σ √(5/72) = 0.26 σ, times √2 where weights halve their number:
    // 0.37 σ, and four and a half times that at the worst of 1200 pixels.
    let worst = found.iter().enumerate().map(|(i, l)| (l - truth(i % 150, i / 150)).abs()).fold(0.0, f64::max);
    let rms =
        (found.iter().enumerate().map(|(i, l)| (l - truth(i % 150, i / 150)).powi(2)).sum::<f64>() / 1200.0).sqrt();
    assert!(rms < 0.37 * sigma && worst < 1.7 * sigma, "{rms} {worst}");
}

/// Even pictures of normal noise: σ/√2 L before; what is left is what the price says.
#[test]
fn noise_is_lessened_by_what_the_price_says() {
    let sigma = 2.0;
    let (mut true_square, mut stated) = (0.0, 0.0);
    for seed in 0..10 {
        let picture = sampled([48, 40], 10 + seed, |x, y| (5.0, wall(x, y), sigma));
        let price = picture.price();
        let before = sigma / 2.0_f64.sqrt() / 5.0;
        // The variance of 1920 squares is 2/1920 of it; what they are relative to is not quite even.
        assert!((price.before / before - 1.0).abs() < 0.08, "{} {before}", price.before);
        assert!(price.after < 0.45 * price.before, "{price:?}");
        true_square += error(&picture, |_, _| 5.0) / 10.0;
        stated += price.after.powi(2) / 10.0;
    }
    // At most so much, and not less than half: the halves share nothing but the way in which they are filtered.
    assert!((0.4..1.05).contains(&(true_square / stated)), "{true_square} {stated}");
}

/// Stripes that the features do not tell, and noise that hides them: blurred, and the price says so.
#[test]
fn the_price_counts_the_bias() {
    let truth = |x: usize, _: usize| if (x / 3).is_multiple_of(2) { 1.0 } else { 2.0 };
    let (mut true_square, mut stated, mut noise) = (0.0, 0.0, 0.0);
    for seed in 0..10 {
        let picture = sampled([48, 40], 30 + seed, |x, y| (truth(x, y), wall(x, y), 1.0));
        true_square += error(&picture, truth) / 10.0;
        stated += picture.price().after.powi(2) / 10.0;
        noise += picture.price().before.powi(2) / 10.0;
    }
    // (1/2)² of each pixel, relative to (3/2)², were all averaged away: 0.111.
    assert!(true_square > 0.05 && stated < noise, "{true_square} {stated} {noise}");
    assert!((0.4..1.1).contains(&(true_square / stated)), "{true_square} {stated}");
}

/// From a dark night to the sun in one picture: everything finite, nothing below 0, for pictures of any size.
#[test]
fn nothing_overflows_or_falls_below_0() {
    for (seed, size) in (50..).zip([[1, 1], [1, 7], [9, 1], [3, 2], [40, 33]]) {
        let luminance = |x: usize, y: usize| 10.0_f64.powi((x * 31 + y * 17) as i32 % 16 - 6);
        let picture = sampled(size, seed, |x, y| {
            let mut features = wall(x, y);
            features[7] = luminance(x, y) / 700.0;
            features[0] *= 1e3;
            (luminance(x, y), features, 0.1 * luminance(x, y))
        });
        let all = picture.rows.iter().flatten();
        assert!(all.clone().all(|v| v.is_finite() && *v >= 0.0), "{size:?}");
        let price = picture.price();
        assert!(price.before.is_finite() && price.after.is_finite());
    }
}
