//! Light that reaches a point without being reflected: from lights that are no surface, and from surfaces that are no diffuse emitters.
//! Diffuse emitters are patches like all others.

use glam::DVec3;

use crate::render::ray::{Ray, SurfacePoint};
use crate::render::scene::Scene;

/// The lights of a scene that shine upon patches from outside of the exchange.
#[derive(Debug)]
pub(super) struct Lights {
    /// By number in the scene.
    pub numbers: Vec<usize>,
}

/// A surface whose emission is that of a diffuse emitter.
pub(super) fn is_diffuse_emitter(scene: &Scene, surface: usize) -> bool {
    scene.emission(surface).is_some_and(|e| e.power() == 0.0 && e.lamp().is_none())
}

/// Evenly spread points of the unit cube: multiples of the powers of the root of x⁴ = x + 1 (M. Roberts, *The Unreasonable
/// Effectiveness of Quasirandom Sequences*, 2018), begun at `shift`.
pub(super) fn spread(index: u32, shift: u32) -> [f64; 3] {
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
    let place = f64::from(index) + 0.5 + 0.618_033_988_749_894_9 * f64::from(shift);
    STEPS.map(|step| (place * step).fract())
}

impl Lights {
    pub fn new(scene: &Scene) -> Self {
        let outside = |light: &usize| scene.surface_of_light(*light).is_none_or(|s| !is_diffuse_emitter(scene, s));
        Self { numbers: (0..scene.lights().len()).filter(outside).collect() }
    }

    /// Tells `arrive` of what arrives at a point: the direction it comes from, and an irradiance per band on a surface that faces it.
    /// Lights of some extent are seen in `samples` directions; `shift` distinguishes points, whose directions should not be the same.
    /// `arriving` is to work in, one per band.
    pub fn visit(
        &self,
        scene: &Scene,
        point: &SurfacePoint,
        (samples, shift): (u32, u32),
        arriving: &mut [f64],
        mut arrive: impl FnMut(DVec3, &[f64]),
    ) {
        for &number in &self.numbers {
            let light = &scene.lights()[number];
            let count = if light.is_one_direction() { 1 } else { samples };
            for index in 0..count {
                let Some(towards) = light.sample_towards(point.position, spread(index, shift), arriving) else {
                    continue;
                };
                // Points of a patch are lit from both sides: the ray starts on the side that the light is on.
                let ray = Ray { origin: point.origin_towards(towards.direction), direction: towards.direction };
                let ignored = scene.surface_of_light(number);
                if light.casts_shadows() && scene.surfaces().is_occluded(&ray, towards.distance, ignored) {
                    continue;
                }
                let weight = 1.0 / (towards.pdf * f64::from(count));
                arriving.iter_mut().for_each(|a| *a *= weight);
                arrive(towards.direction, arriving);
            }
        }
    }
}
