//! A surface that reflects and lets nothing through: any [`Brdf`], on the outside or on both sides.

use std::fmt;

use glam::DVec3;

use super::{Material, Nature, Scattered, Transport};
use crate::brdf::Brdf;
use crate::brdf::fresnel::Components;

/// An opaque surface.
pub struct Opaque {
    brdf: Box<dyn Brdf>,
    two_sided: bool,
}

impl fmt::Debug for Opaque {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Opaque").field("brdf", &self.brdf).field("two_sided", &self.two_sided).finish()
    }
}

impl Opaque {
    /// A surface of a BRDF that was prepared for the bands of the render; a one-sided one is black from the inside.
    #[must_use]
    pub fn new(brdf: Box<dyn Brdf>, two_sided: bool) -> Self {
        Self { brdf, two_sided }
    }
}

/// Two directions on the side that a BRDF knows; `None` where the surface is dark or they are on different sides.
pub(super) fn upright(two_sided: bool, a: DVec3, b: DVec3) -> Option<(DVec3, DVec3)> {
    if a.z > 0.0 && b.z > 0.0 {
        Some((a, b))
    } else if two_sided && a.z < 0.0 && b.z < 0.0 {
        Some((flipped(a), flipped(b)))
    } else {
        None
    }
}

/// Seen from the other side: half a turn about the tangent would exchange left and right, so the grain stays and z changes sign.
pub(super) fn flipped(d: DVec3) -> DVec3 {
    DVec3::new(d.x, d.y, -d.z)
}

impl Material for Opaque {
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, _transport: Transport, values: &mut [f64]) {
        match upright(self.two_sided, incident, outgoing) {
            Some((i, o)) => self.brdf.evaluate(i, o, values),
            None => values.fill(0.0),
        }
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        _transport: Transport,
        _hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let below = outgoing.z < 0.0;
        if below && !self.two_sided {
            return None;
        }
        let drawn = self.brdf.sample(if below { flipped(outgoing) } else { outgoing }, u, weights)?;
        let direction = if below { flipped(drawn.incident) } else { drawn.incident };
        Some(Scattered { direction, pdf: drawn.pdf, delta: drawn.delta, split: false, eta: 1.0 })
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3, _hero: usize) -> f64 {
        upright(self.two_sided, incident, outgoing).map_or(0.0, |(i, o)| self.brdf.pdf(o, i))
    }

    fn polarise(&self, outgoing: DVec3, incident: DVec3, components: &mut [Components]) -> bool {
        upright(self.two_sided, incident, outgoing).is_some_and(|(i, _)| self.brdf.polarise(i, components))
    }

    fn nature(&self) -> Nature {
        Nature { anisotropic: !self.brdf.is_isotropic(), ..Nature::default() }
    }

    fn albedo(&self, arriving: DVec3, share: &mut [f64]) -> Option<f64> {
        if let Some((i, _)) = upright(self.two_sided, arriving, arriving) {
            return Some(self.brdf.albedo(i, share));
        }
        share.fill(0.0);
        Some(0.0)
    }

    fn has_delta(&self) -> bool {
        self.brdf.has_delta()
    }

    fn is_diffuse(&self) -> bool {
        self.brdf.is_diffuse()
    }

    fn is_delta(&self) -> bool {
        self.brdf.is_delta()
    }
}
