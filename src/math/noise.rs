//! Gradient noise: a smooth random function of the plane that is the same everywhere and always.
//!
//! At each point of the integer lattice stands a random unit gradient, a function of its coordinates and a seed (Philox); between them
//! the four linear functions are blended by 6t⁵ − 15t⁴ + 10t³, whose first and second derivatives vanish at the lattice.
//!
//! Reference: K. Perlin, *Improving Noise*, SIGGRAPH 2002 (the blend); *An Image Synthesizer*, SIGGRAPH 85.

use glam::DVec2;

use super::random::philox;

/// Value at a place, −1 to 1 (at most √½ in magnitude times √2), 0 at every lattice point.
#[must_use]
pub fn gradient(place: DVec2, seed: u32) -> f64 {
    let low = place.floor();
    let t = place - low;
    let corner = |offset: DVec2| {
        let lattice = low + offset;
        // Wrapped, so that any place has a gradient.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the low bits are wanted")]
        let [x, y] = [lattice.x as i64 as u32, lattice.y as i64 as u32];
        let [word, ..] = philox([seed, 0x6E6F_6973], [x, y, 0, 0]);
        let angle = f64::from(word) * (std::f64::consts::TAU / 4_294_967_296.0);
        DVec2::from_angle(angle).dot(t - offset)
    };
    let blend = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let lerp = |a: f64, b: f64, s: f64| a + s * (b - a);
    let bottom = lerp(corner(DVec2::ZERO), corner(DVec2::X), blend.x);
    let top = lerp(corner(DVec2::Y), corner(DVec2::ONE), blend.x);
    // Unit gradients reach √½ in the middle of a cell.
    std::f64::consts::SQRT_2 * lerp(bottom, top, blend.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_bounded_smooth_and_zero_on_the_lattice() {
        let (mut sum, mut most, n) = (0.0, 0.0_f64, 20_000);
        for i in 0..n {
            let place = DVec2::new(0.137 * f64::from(i) - 900.0, 0.071 * f64::from(i) + 3.0);
            let here = gradient(place, 1);
            let there = gradient(place + DVec2::new(1e-7, -1e-7), 1);
            // The slope is at most that of the gradients and the blend together: √2 (1 + 2 · 15/8).
            assert!(here.abs() <= 1.0 && (here - there).abs() < 1e-6, "{place}: {here} {there}");
            sum += here;
            most = most.max(here.abs());
        }
        assert!((sum / f64::from(n)).abs() < 0.02 && most > 0.6, "{sum} {most}");
        assert_eq!(gradient(DVec2::new(-3.0, 7.0), 5), 0.0);
        assert_ne!(gradient(DVec2::splat(0.4), 1), gradient(DVec2::splat(0.4), 2));
        assert!(gradient(DVec2::splat(1e300), 1).is_finite());
    }
}
