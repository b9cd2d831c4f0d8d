//! Which bands paths keep where dispersion splits them: those that count in what is read.
//!
//! A path of one band that was drawn with the probability p adds w f/p to a quantity that weighs bands by w; the variance of that is least for
//! p ∝ w f. What is read of most scenes is luminance, and colours are looked at: with f the spectrum of a light
//!
//! ```text
//! p_b = a/n + (1 − a) q_b/Σ q,    q_b = max_l s_b Φ_lb / Σ_c s_c Φ_lc,    s = √(ȳ² + β (x̄² + z̄²))
//! ```
//!
//! s is the root of a sum of squares because that makes the sum of several quantities' variances least. Of several lights the largest counts:
//! what a laser alone lights, or a lamp beside it, has little more noise than if the other were not there. No band is forgotten, as a is not 0,
//! and none has more than 1/a of the variance that it would have if all n were drawn alike.
//!
//! Reference: R. Y. Rubinstein, D. P. Kroese, *Simulation and the Monte Carlo Method*, 3rd ed., 2016, §5.7 (the density of least variance).

use std::sync::Arc;

use super::instrument::{Instrument, Kind, Quantities};
use crate::render::light::Light;

/// β: what the variances of X and Z count beside that of Y. Of equal energy Y has 1.11 times the least second moment that way, X 1.65, Z 8.2;
/// with bands by luminance alone (and as many alike) 1.05, 2.2, 24.
const COLOUR: f64 = 0.01;
/// a where quantities of all bands are read, and where bands themselves are.
const ALIKE: f64 = 0.1;
const ALIKE_READ: f64 = 0.5;

/// The probabilities p of the bands. Where something `fluoresces`, bands are seen that no light has.
pub(super) fn probabilities(
    quantities: &Quantities,
    lights: &[Arc<dyn Light>],
    fluoresces: bool,
    instruments: &[Instrument],
) -> Vec<f64> {
    let seen: Vec<f64> =
        (quantities.tristimulus.iter()).map(|[x, y, z]| (y * y + COLOUR * (x * x + z * z)).sqrt()).collect();
    let n = seen.len();
    let (mut best, mut flux) = (vec![0.0_f64; n], vec![0.0; n]);
    for light in lights.iter().filter(|_| !fluoresces) {
        light.flux(&mut flux);
        flux.iter_mut().zip(&seen).for_each(|(f, s)| *f = s * f.max(0.0));
        let sum: f64 = flux.iter().sum();
        if sum > 0.0 && sum.is_finite() {
            best.iter_mut().zip(&flux).for_each(|(b, f)| *b = b.max(f / sum));
        }
    }
    let weights = if best.iter().any(|b| *b > 0.0) { best } else { seen };
    let bands_are_read = |i: &Instrument| i.spectrum || matches!(i.kind, Kind::Gonioreflectometer(_));
    let alike = if instruments.iter().any(bands_are_read) { ALIKE_READ } else { ALIKE };
    let sum: f64 = weights.iter().sum();
    #[expect(clippy::cast_precision_loss, reason = "a number of bands")]
    let same = 1.0 / n as f64;
    // What has no luminance is drawn alike.
    weights.iter().map(|w| if sum > 0.0 { alike * same + (1.0 - alike) * w / sum } else { same }).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::render::bands::Bands;
    use crate::render::light::point::Point;
    use crate::render::measure::{Meter, Place};
    use crate::render::ray::SurfacePoint;
    use crate::render::sensor::response::Response;

    fn quantities() -> Quantities {
        // All alike, as the figures below were summed.
        let bands = Bands::nodes((0..47).map(|i| 365.0 + 10.0 * f64::from(i)).collect(), 10.0);
        Quantities::new(&bands)
    }

    fn light(intensity: impl Fn(usize) -> f64) -> Arc<dyn Light> {
        let bands: Vec<f64> = (0..47).map(intensity).collect();
        Arc::new(Point::new(DVec3::X, &bands).expect("a light"))
    }

    /// Σ w²/p over (Σ w)²: the second moment of what a kept band adds to a quantity, of equal energy. The figures are those of numpy with the
    /// observer's table of colour-science 0.4.7 at the 47 wavelengths, to the digits printed.
    #[test]
    fn luminance_and_colours_have_little_noise() {
        let quantities = quantities();
        let p = probabilities(&quantities, &[], false, &[]);
        assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let moment = |of: fn(&[f64; 3]) -> f64| {
            let w = || quantities.tristimulus.iter().map(of);
            w().zip(&p).map(|(w, p)| w * w / p).sum::<f64>() / w().sum::<f64>().powi(2)
        };
        for (found, expected) in
            [(moment(|q| q[0]), 1.648_65), (moment(|q| q[1]), 1.112_08), (moment(|q| q[2]), 8.231_63)]
        {
            assert!((found - expected).abs() < 5e-6, "{found} {expected}");
        }
        assert!(p.iter().all(|p| *p >= ALIKE / 47.0));
        // Light of equal energy changes nothing.
        let equal = probabilities(&quantities, &[light(|_| 2.0)], false, &[]);
        assert!(p.iter().zip(equal).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    /// One instrument that reports its spectrum has half of all draws alike.
    #[test]
    fn bands_that_are_read_have_at_most_twice_the_variance() {
        let quantities = quantities();
        let instrument = |spectrum| {
            let place = Place::Point(SurfacePoint::meter(DVec3::ZERO, DVec3::Z, 0.0));
            let kind = Kind::Meter(Meter { place, response: Response::Cone { sin: 0.5 } });
            Instrument { name: "meter".to_owned(), spectrum, target: None, kind }
        };
        let least = |spectra: &[bool]| {
            let instruments: Vec<Instrument> = spectra.iter().map(|s| instrument(*s)).collect();
            probabilities(&quantities, &[], false, &instruments).into_iter().fold(1.0, f64::min)
        };
        assert!(least(&[false, true]) >= 0.5 / 47.0);
        assert!(least(&[false, false]) < 0.11 / 47.0);
    }

    /// Bands of a faint lamp beside a laser keep half of what they have of the lamp alone; where something fluoresces the lights say nothing.
    #[test]
    fn every_light_counts() {
        let quantities = quantities();
        let lamp = |band: usize| if (10..20).contains(&band) { 1e-6 } else { 0.0 };
        let laser = |band: usize| if band == 30 { 1e3 } else { 0.0 };
        let of = |lights: &[Arc<dyn Light>]| probabilities(&quantities, lights, false, &[]);
        let (alone, both) = (of(&[light(lamp)]), of(&[light(lamp), light(laser)]));
        let above = |p: f64| p - ALIKE / 47.0;
        for band in 10..20 {
            assert!((above(both[band]) / above(alone[band]) - 0.5).abs() < 1e-9, "{band}");
        }
        assert!((above(both[30]) - 0.5 * (1.0 - ALIKE)).abs() < 1e-12);
        // Without any light, and with one that has no band, all bands that are seen count.
        assert_eq!(of(&[]), of(&[light(|_| 0.0)]));
        assert_eq!(of(&[]), probabilities(&quantities, &[light(laser)], true, &[]));
    }
}
