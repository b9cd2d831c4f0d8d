//! The production light of Pixar: a point light under a cinematographer's controls, each a factor on the intensity.
//!
//! ```text
//! E_b = I_b cosθ · falloff(r) · beam(α) · shape · clip(z) · Π blockers · slide_b · noise
//! ```
//!
//! The light's own space has +z along the axis, +x to the right and +y up as one looks along it (a left-handed frame); (X, Y) = (x/z, y/z) − shear is the place on the window one
//! metre before it, in which shape, slide and noise are given (tangents of angles).
//!
//! | control | factor | parameters |
//! |---|---|---|
//! | falloff, power | (1/r₀²)(r₀/r)^n: n = 2 is the square law, n = 0 none | n, r₀ (m) |
//! | falloff, controlled | (1/r₀²) M exp(s (r/r₀)^β) within r₀, the power law beyond; s = −ln M, β = n/ln M join them smoothly | n, r₀, M > 1 (the most, at the light) |
//! | beam | cosᵏ of the angle α to the axis; 0 behind | k |
//! | shape | a soft [`Superellipse`](super::superellipse::Superellipse) on the window, or none | |
//! | shear | moves the window: barn doors | (X, Y) |
//! | cut-on, cut-off | smooth steps in z: from near − edge to near, from far to far + edge | m |
//! | blockers | cards across the axis (cucoloris): 1 − opacity · coverage where the way to the light crosses them | depth, middle (m), [`Superellipse`](super::superellipse::Superellipse) (m), opacity |
//! | slide | Σ_c k_c(X, Y) S_c,b, bilinear; 0 beyond it | picture, half extents |
//! | noise | 1 − amplitude (½ + ½ g(f X, f Y)), g gradient noise | f, amplitude, seed |
//! | shadow | whether anything may stand in its way: the renderer asks [`Light::casts_shadows`] | |
//!
//! Limits: controls that act along a ray (another falloff than the square law, cut-on, cut-off, blockers), and shining through what stands in the
//! way, are no light that travels.
//! [`Light::emit`] and [`Light::flux`] are those of the intensity far away, falloff as the square law, all depths shown; they stand for
//! the light only where [`Light::emits_what_arrives`] says so.
//!
//! Source: R. Barzel, *Lighting Controls for Computer Cinematography*, Journal of Graphics Tools 2 (1997).

mod controls;

use glam::{DMat3, DVec2, DVec3};

use super::superellipse::smooth_step;
use super::{Error, Light, add, placed, sound, unit, way, write};
use crate::math::cubature::{Tolerance, rectangle};
use crate::math::noise::gradient;
use crate::math::sampling::{cosine_power, cosine_power_pdf};
use crate::render::ray::{Ray, Towards};

pub use controls::{Blocker, Clip, Controls, Falloff, Noise, Slide};

/// The light.
#[derive(Debug, Clone, PartialEq)]
pub struct Barzel {
    position: DVec3,
    to_world: DMat3,
    controls: Controls,
    intensity: Box<[f64]>,
    flux: Box<[f64]>,
    /// A bound on the intensity, summed over the bands.
    bound: f64,
}

impl Barzel {
    /// At a position, shining along `axis` with `up` upwards (any lengths, not parallel), of an intensity per band before all factors,
    /// W/(sr·nm) or W/sr.
    ///
    /// # Errors
    /// [`Error::Value`], [`Error::Direction`], [`Error::Count`].
    pub fn new(position: DVec3, axis: DVec3, up: DVec3, intensity: &[f64], controls: Controls) -> Result<Self, Error> {
        let z = unit("an axis of a light", axis)?;
        let right = unit("an upward direction beside the axis", z.cross(unit("an upward direction", up)?))?;
        let intensity = sound("an intensity (W/(sr nm))", intensity)?;
        controls.check(intensity.len())?;
        let to_world = DMat3::from_cols(right, right.cross(z), z);
        let bound = match &controls.slide {
            None => intensity.iter().sum(),
            Some(slide) => slide.spectra.iter().enumerate().map(|(c, s)| slide.most(c) * dot(s, &intensity)).sum(),
        };
        let position = placed("a coordinate of a light (m)", position)?;
        let mut made = Self { position, to_world, controls, flux: intensity.clone(), intensity, bound };
        made.flux = made.integrate();
        Ok(made)
    }

    /// The factor of beam, shape, noise and blockers in a direction of the light's space (any length, z > 0), and the place on the
    /// window; of the blockers those nearer than a depth.
    fn gain(&self, local: DVec3, depth: f64) -> (f64, DVec2) {
        let Controls { beam_exponent, shape, shear, blockers, noise, .. } = &self.controls;
        let slope = local.truncate() / local.z;
        let window = slope - *shear;
        let mut gain = (local.z / local.length()).powf(*beam_exponent);
        if let Some(shape) = shape {
            gain *= shape.coverage(window);
        }
        if let Some(Noise { frequency, amplitude, seed }) = noise {
            gain *= 1.0 - amplitude * (0.5 + 0.5 * gradient(*frequency * window, *seed));
        }
        for card in blockers.iter().filter(|card| card.depth_m < depth) {
            gain *= 1.0 - card.opacity * card.outline.coverage(card.depth_m * slope - card.middle_m);
        }
        (gain, window)
    }

    /// Writes a factor times the intensity through the slide.
    fn through_slide(&self, window: DVec2, factor: f64, out: &mut [f64]) {
        let Some(slide) = &self.controls.slide else { return write(out, &self.intensity, factor) };
        out.fill(0.0);
        for (channel, spectrum) in slide.spectra.iter().enumerate() {
            add(out, spectrum, slide.at(window, channel));
        }
        for (out, intensity) in out.iter_mut().zip(&self.intensity) {
            *out *= factor * intensity;
        }
    }

    /// The flux: over the window where there is a shape or a slide, else over the half space, by adaptive quadrature to
    /// 1e-6, or by half a million points where hard edges do not let it.
    fn integrate(&self) -> Box<[f64]> {
        let slide = self.controls.slide.as_ref();
        let channels = slide.map_or(1, |s| s.spectra.len());
        let coefficient = |window, channel| slide.map_or(1.0, |s| s.at(window, channel));
        let tolerance = Tolerance { absolute: 0.0, relative: 1e-6, evaluations: 500_000 };
        let mut sums = vec![0.0; channels];
        let integrand = |u: [f64; 2], values: &mut [f64]| {
            let (local, pdf) = self.draw(u);
            let (gain, window) = if local.z > 0.0 { self.gain(local, f64::INFINITY) } else { (0.0, DVec2::ZERO) };
            for (channel, value) in values.iter_mut().enumerate() {
                *value = if gain > 0.0 { gain / pdf * coefficient(window, channel) } else { 0.0 };
            }
        };
        rectangle(integrand, [0.0, 0.0], [1.0, 1.0], tolerance, &mut sums);
        let mut flux = vec![0.0; self.intensity.len()];
        match slide {
            None => write(&mut flux, &self.intensity, sums[0]),
            Some(slide) => {
                for (sum, spectrum) in sums.iter().zip(&slide.spectra) {
                    add(&mut flux, spectrum, *sum);
                }
                flux.iter_mut().zip(&self.intensity).for_each(|(f, i)| *f *= i);
            }
        }
        flux.into()
    }

    /// A direction of the light's space and its density, 1/sr: even over the window that shape and slide leave, or with the beam.
    fn draw(&self, [u, v]: [f64; 2]) -> (DVec3, f64) {
        match self.window() {
            Some(half) => {
                let window = half * DVec2::new(2.0 * u - 1.0, 2.0 * v - 1.0) + self.controls.shear;
                let direction = window.extend(1.0).normalize();
                (direction, even_pdf(half, direction.z))
            }
            None => {
                let direction = cosine_power([u, v], self.controls.beam_exponent);
                (direction, cosine_power_pdf(direction.z, self.controls.beam_exponent))
            }
        }
    }

    /// The density of [`Barzel::draw`] in a direction of the light's space (unit), 1/sr.
    fn pdf(&self, local: DVec3) -> f64 {
        if local.z <= 0.0 {
            return 0.0;
        }
        match self.window() {
            Some(half) => {
                let away = (local.truncate() / local.z - self.controls.shear).abs();
                if away.cmple(half).all() { even_pdf(half, local.z) } else { 0.0 }
            }
            None => cosine_power_pdf(local.z, self.controls.beam_exponent),
        }
    }

    /// Half of the extents of the part of the window that shape and slide leave, about the shear; `None` without both.
    fn window(&self) -> Option<DVec2> {
        let sides = [self.controls.shape.map(|s| s.outer()), self.controls.slide.as_ref().map(|s| s.half)];
        sides.into_iter().flatten().reduce(DVec2::min)
    }
}

/// Density per solid angle, at a cosine to the axis, of places that are even over a window of half the extents `half`.
fn even_pdf(half: DVec2, cos: f64) -> f64 {
    1.0 / (4.0 * half.x * half.y * cos.powi(3))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Light for Barzel {
    fn sample_towards(&self, from: DVec3, _: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let (direction, distance, _) = way(from, self.position)?;
        let (factor, window) = self.factor(from)?;
        self.through_slide(window, factor, arriving);
        let shines = arriving.iter().any(|e| *e > 0.0);
        shines.then_some(Towards { direction, distance, pdf: 1.0, delta: true })
    }

    fn emit(&self, [u, v, ..]: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        let (local, pdf) = self.draw([u, v]);
        let (gain, window) = self.gain(local, f64::INFINITY);
        self.through_slide(window, gain / pdf, flux);
        (gain > 0.0).then(|| Ray { origin: self.position, direction: self.to_world * local })
    }

    fn emission_density(&self, _: DVec3, direction: DVec3, distance: f64) -> f64 {
        if self.emits_what_arrives() {
            self.pdf(self.to_world.transpose() * -direction) / distance / distance
        } else {
            0.0
        }
    }

    fn is_one_direction(&self) -> bool {
        true
    }

    fn flux(&self, flux: &mut [f64]) {
        flux.copy_from_slice(&self.flux);
    }

    fn importance(&self, from: DVec3) -> f64 {
        self.factor(from).map_or(0.0, |(factor, _)| factor * self.bound)
    }

    fn casts_shadows(&self) -> bool {
        self.controls.shadows
    }

    fn emits_what_arrives(&self) -> bool {
        let Controls { falloff, clip, blockers, shadows, .. } = &self.controls;
        // What shines through surfaces lights what no packet comes to.
        matches!(falloff, Falloff::Power { exponent: 2.0, .. }) && clip.is_none() && blockers.is_empty() && *shadows
    }
}

impl Barzel {
    /// Irradiance over intensity at a point, 1/m², before the slide, and the place on the window; `None` behind the light.
    fn factor(&self, from: DVec3) -> Option<(f64, DVec2)> {
        let local = self.to_world.transpose() * (from - self.position);
        if local.z <= 0.0 {
            return None;
        }
        let (gain, window) = self.gain(local, local.z);
        let clip = self.controls.clip.map_or(1.0, |c| {
            // An edge of no length is a step.
            let step = |x: f64, edge: f64| if x >= edge { 1.0 } else { smooth_step(x / edge) };
            step(local.z - (c.near_m - c.near_edge_m), c.near_edge_m)
                * (1.0 - step((local.z - c.far_m).max(0.0), c.far_edge_m.max(f64::MIN_POSITIVE)))
        });
        let factor = gain * clip * self.controls.falloff.at(local.length());
        (factor > 0.0 && factor.is_finite()).then_some((factor, window))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::super::check;
    use super::super::superellipse::Superellipse;
    use super::*;

    const HERE: DVec3 = DVec3::new(1.0, -2.0, 3.0);

    fn light(controls: Controls) -> Barzel {
        Barzel::new(HERE, DVec3::new(0.0, 0.6, -0.8), DVec3::Z, &[100.0, 40.0], controls).expect("a light")
    }

    /// E over I on a facing surface at a point of the light's space.
    fn at(light: &Barzel, x: f64, y: f64, z: f64) -> f64 {
        let point = HERE + light.to_world * DVec3::new(x, y, z);
        let e = check::irradiance_at(light, point, (HERE - point).normalize());
        assert!((e[1] / e[0] - 0.4).abs() < 1e-14 || e[0] == 0.0);
        e[0] / 100.0
    }

    fn ellipse(inner: f64, outer: f64) -> Superellipse {
        Superellipse::new(DVec2::splat(inner), DVec2::splat(outer), 1.0).expect("a region")
    }

    #[test]
    fn without_controls_it_is_a_point_in_the_half_space() {
        let light = light(Controls::default());
        assert!((at(&light, 0.0, 0.0, 2.0) - 0.25).abs() < 1e-15 && (at(&light, 3.0, 0.0, 4.0) - 0.04).abs() < 1e-15);
        assert_eq!(at(&light, 0.0, 0.0, -1.0), 0.0);
        assert!(light.casts_shadows() && light.emits_what_arrives());
        check::emission(&light, 2);
        let mut flux = [0.0; 2];
        light.flux(&mut flux);
        assert!((flux[0] / (100.0 * TAU) - 1.0).abs() < 1e-9);
        // Looking along +y and down, +x is to the right and +z upwards.
        let (right, up) = (light.to_world * DVec3::X, light.to_world * DVec3::Y);
        assert!(
            (right - DVec3::X).length() < 1e-15 && (up - DVec3::new(0.0, 0.8, 0.6)).length() < 1e-15,
            "{right} {up}"
        );
    }

    #[test]
    fn distance_falls_off_as_told() {
        let power =
            |exponent| Controls { falloff: Falloff::Power { exponent, reference_m: 2.0 }, ..Controls::default() };
        for (exponent, at_4) in [(0.0, 0.25), (1.0, 0.125), (2.0, 0.0625), (3.0, 0.03125)] {
            let light = light(power(exponent));
            assert!(
                (at(&light, 0.0, 0.0, 4.0) - at_4).abs() < 1e-15 && (at(&light, 0.0, 0.0, 2.0) - 0.25).abs() < 1e-15
            );
            assert_eq!(light.emits_what_arrives(), exponent == 2.0);
        }
        let controlled = Falloff::Controlled { exponent: 2.0, reference_m: 2.0, most: 8.0 };
        let light = light(Controls { falloff: controlled, ..Controls::default() });
        // 8 times the value at r₀ close by, the square law beyond, without step or kink between.
        assert!((at(&light, 0.0, 0.0, 1e-8) - 2.0).abs() < 1e-6 && (at(&light, 0.0, 0.0, 4.0) - 0.0625).abs() < 1e-15);
        let (h, slope) = (1e-6, |a: f64, b: f64| (controlled.at(b) - controlled.at(a)) / (b - a));
        assert!((controlled.at(2.0 - 1e-12) / controlled.at(2.0) - 1.0).abs() < 1e-11);
        assert!((slope(2.0 - h, 2.0) / slope(2.0, 2.0 + h) - 1.0).abs() < 1e-5);
    }

    /// The hard square pyramid of ±45° sends I into a sixth of the sphere; the beam cosᵏ into 2π/(k + 1).
    #[test]
    fn fluxes_are_closed_forms_where_there_are_any() {
        let flux = |controls| {
            let light = light(controls);
            check::emission(&light, 2);
            let mut flux = [0.0; 2];
            light.flux(&mut flux);
            flux[0] / 100.0
        };
        let square = Superellipse::new(DVec2::ONE, DVec2::ONE, 0.0).expect("a region");
        let pyramid = flux(Controls { shape: Some(square), ..Controls::default() });
        assert!((pyramid / (4.0 * PI / 6.0) - 1.0).abs() < 1e-6, "{pyramid}");
        for k in [1.0, 20.0] {
            let beam = flux(Controls { beam_exponent: k, ..Controls::default() });
            assert!((beam * (k + 1.0) / TAU - 1.0).abs() < 1e-6, "{beam}");
        }
        // A hard circular cone: 2π (1 − cos 45°), to what adaptive cells resolve of its edge.
        let cone = flux(Controls { shape: Some(ellipse(1.0, 1.0)), ..Controls::default() });
        assert!((cone / (TAU * (1.0 - 0.5_f64.sqrt())) - 1.0).abs() < 2e-4, "{cone}");
    }

    /// The mean of 1/pdf over the draws that shine is the solid angle into which the light shines: 2π of a half space, a sixth of the sphere of the
    /// square pyramid of ±45°, 2π (1 − cos 45°) of the cone.
    #[test]
    fn rays_are_drawn_with_the_density_that_is_told() {
        let square = Superellipse::new(DVec2::ONE, DVec2::ONE, 0.0).expect("a region");
        let with = |shape| Controls { shape, ..Controls::default() };
        let wide = Controls { beam_exponent: 0.5, ..Controls::default() };
        for (controls, expected) in [
            (with(None), TAU),
            (wide, TAU),
            (with(Some(square)), 4.0 * PI / 6.0),
            (Controls { shear: DVec2::new(0.3, -0.2), ..with(Some(square)) }, f64::NAN),
            (with(Some(ellipse(1.0, 1.0))), TAU * (1.0 - 0.5_f64.sqrt())),
        ] {
            let light = light(controls);
            let mut random = crate::math::random::Stream::new(5, 0);
            let (mut flux, mut sum, mut squares) = ([0.0; 2], 0.0, 0.0);
            const DRAWS: u32 = 100_000;
            for _ in 0..DRAWS {
                let Some(ray) = light.emit(random.uniforms(), &mut flux) else { continue };
                // 3 m away, per area.
                let x = 1.0 / (9.0 * light.emission_density(HERE, -ray.direction, 3.0));
                sum += x;
                squares += x * x;
                // I/pdf is what a ray carries, where nothing but the beam dims it.
                let beam = (light.to_world.z_axis.dot(ray.direction)).powf(light.controls.beam_exponent);
                assert!((flux[0] / (100.0 * beam * x) - 1.0).abs() < 1e-9);
            }
            let n = f64::from(DRAWS);
            let (mean, error) = (sum / n, ((squares / n - (sum / n).powi(2)).max(0.0) / n).sqrt());
            assert!(expected.is_nan() || (mean - expected).abs() <= 4.5 * error + 1e-9, "{mean} ± {error}, {expected}");
        }
        // Beside the window, behind the light, and of a light that does not travel as light does.
        let pyramid = light(with(Some(square)));
        let towards = |l: &Barzel, d: DVec3| l.emission_density(HERE, -(l.to_world * d).normalize(), 1.0);
        assert_eq!(towards(&pyramid, DVec3::new(1.01, 0.0, 1.0)), 0.0);
        assert_eq!(towards(&pyramid, DVec3::NEG_Z), 0.0);
        let ghost = light(Controls { shadows: false, ..Controls::default() });
        assert!(towards(&ghost, DVec3::Z) == 0.0 && !ghost.emits_what_arrives());
    }

    #[test]
    fn shape_shear_and_clip_are_where_they_belong() {
        let clip = Clip { near_m: 2.0, near_edge_m: 1.0, far_m: 5.0, far_edge_m: 2.0 };
        let falloff = Falloff::Power { exponent: 0.0, reference_m: 1.0 };
        let shear = DVec2::new(0.5, 0.0);
        let light =
            light(Controls { falloff, shape: Some(ellipse(0.1, 0.3)), shear, clip: Some(clip), ..Controls::default() });
        for (z, expected) in [(0.9, 0.0), (1.5, 0.5), (2.0, 1.0), (5.0, 1.0), (6.0, 0.5), (7.0, 0.0)] {
            assert!((at(&light, 0.5 * z, 0.0, z) - expected).abs() < 1e-14, "{z}");
        }
        // Half way through the soft edge, to the right of the sheared middle and above it.
        assert!(
            (at(&light, 0.7 * 3.0, 0.0, 3.0) - 0.5).abs() < 1e-14 && (at(&light, 1.5, 0.6, 3.0) - 0.5).abs() < 1e-14
        );
        assert_eq!(at(&light, 0.0, 0.0, 3.0), 0.0);
        let step = Clip { near_m: 0.0, near_edge_m: 0.0, far_m: 5.0, far_edge_m: 0.0 };
        let light = self::light(Controls { falloff, clip: Some(step), ..Controls::default() });
        assert_eq!([4.999, 5.001].map(|z| at(&light, 0.0, 0.0, z)), [1.0, 0.0]);
        assert!(!light.emits_what_arrives());
    }

    #[test]
    fn blockers_shade_what_is_behind_them() {
        let card = Blocker { depth_m: 2.0, middle_m: DVec2::new(0.4, 0.0), outline: ellipse(0.1, 0.2), opacity: 0.75 };
        let light = light(Controls { blockers: vec![card], ..Controls::default() });
        let shade = |x: f64, z: f64| at(&light, x, 0.0, z) * (x * x + z * z);
        // Half way along the axis the card is seen at twice its place; before it nothing is shaded.
        assert!((shade(0.8, 4.0) - 0.25).abs() < 1e-14 && (shade(0.2, 1.0) - 1.0).abs() < 1e-14);
        assert!((shade(0.0, 4.0) - 1.0).abs() < 1e-14);
        // The middle of the soft edge takes half of the opacity: coverage ½ at t = ½, 0.15 m from the middle.
        assert!((shade(1.1, 4.0) - (1.0 - 0.375)).abs() < 1e-12);
        check::emission(&light, 2);
    }

    #[test]
    fn slides_colour_the_right_side_and_noise_is_steady() {
        // Red left, blue right; the top is brighter: two channels, two bands.
        let coefficients = vec![2.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 1.0];
        let slide = Slide {
            width: 2,
            height: 2,
            coefficients,
            spectra: vec![vec![1.0, 0.0], vec![0.0, 0.5]],
            half: DVec2::new(1.0, 0.5),
        };
        let noise = Noise { frequency: 3.0, amplitude: 0.5, seed: 1 };
        let plain = light(Controls { slide: Some(slide.clone()), ..Controls::default() });
        let through = |x: f64, y: f64| {
            let point = HERE + plain.to_world * DVec3::new(x, y, 1.0);
            let r2 = 1.0 + x * x + y * y;
            check::irradiance_at(&plain, point, (HERE - point).normalize()).map(|e| e * r2)
        };
        let near =
            |a: [f64; 2], b: [f64; 2]| assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} {b:?}");
        near(through(-0.7, 0.4), [200.0, 0.0]);
        near(through(0.7, -0.4), [0.0, 20.0]);
        near(through(0.0, 0.0), [75.0, 15.0]);
        near(through(1.1, 0.0), [0.0, 0.0]);
        check::emission(&plain, 2);
        let noisy = light(Controls { noise: Some(noise), slide: Some(slide), ..Controls::default() });
        check::emission(&noisy, 2);
        let dim = light(Controls { noise: Some(noise), ..Controls::default() });
        let (a, b) = (at(&dim, 0.1, 0.2, 1.0) * 1.05, at(&dim, 0.2, 0.4, 2.0) * 4.2);
        assert!((a - b).abs() < 1e-14 && (0.5..=1.0).contains(&a));
        let mut flux = [0.0; 2];
        dim.flux(&mut flux);
        // A mean of zero over many cells: three quarters of the light.
        assert!((flux[0] / (75.0 * TAU) - 1.0).abs() < 0.05);
    }

    #[test]
    fn extremes_stay_finite_and_bad_values_are_refused() {
        let controls = Controls { shape: Some(ellipse(0.5e-6, 1e-6)), beam_exponent: 4.0, ..Controls::default() };
        let needle = Barzel::new(DVec3::ZERO, DVec3::X, DVec3::Z, &[1.0, 0.0], controls).expect("a light");
        check::emission(&needle, 2);
        for r in [1e-8, 1.0, 1e8] {
            let e = check::irradiance_at(&needle, r * DVec3::X, DVec3::NEG_X)[0];
            assert!((e * r * r - 1.0).abs() < 1e-14, "{r}");
        }
        let refused = |controls| Barzel::new(HERE, DVec3::X, DVec3::Z, &[1.0], controls).is_err();
        assert!(refused(Controls { beam_exponent: -1.0, ..Controls::default() }));
        assert!(refused(Controls {
            falloff: Falloff::Power { exponent: 2.0, reference_m: 0.0 },
            ..Controls::default()
        }));
        let falloff = Falloff::Controlled { exponent: 2.0, reference_m: 1.0, most: 1.0 };
        assert!(refused(Controls { falloff, ..Controls::default() }));
        let clip = Clip { near_m: 2.0, near_edge_m: 0.0, far_m: 1.0, far_edge_m: 0.0 };
        assert!(refused(Controls { clip: Some(clip), ..Controls::default() }));
        assert!(Barzel::new(HERE, DVec3::Z, DVec3::Z, &[1.0], Controls::default()).is_err());
    }
}
