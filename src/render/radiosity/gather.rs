//! What meters and cameras see of a solution: direct light anew at every point, reflected light from the patches (final gathering).
//!
//! A meter sums over all patches, in closed form where it can, each behind the rays that reach it. What a camera sees of a surface is the direct
//! light at the very point and, of reflected light, what four points of the patch receive, with straight lines between them.

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use super::lights::spread;
use super::patches::{Node, Patch};
use super::reflection::Reflection;
use super::{Solution, factor};
use crate::render::integrator::frame::Frame;
use crate::render::measure::{Meter, Place};
use crate::render::ray::{Ray, SurfacePoint};
use crate::render::sensor::response::Response;
use crate::render::shape::Shape;

/// Directions in which a meter, and a point of a picture, sees a light of some extent.
const OF_METER: u32 = 1024;
const OF_POINT: u32 = 64;
/// Rays of a meter that looks into a cone.
const IN_CONE: u32 = 1024;

/// Looks at a solution. One for all threads.
#[derive(Debug)]
pub struct Gatherer<'a> {
    solution: &'a Solution<'a>,
    reflection: Reflection<'a>,
    /// By element: reflected light that its points receive, band by band, point by point; made when first asked for.
    received: Vec<OnceLock<Vec<f64>>>,
}

/// What of the exitance of patches is gathered.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    Reflected,
    Emitted,
}

impl<'a> Gatherer<'a> {
    /// For a solution.
    #[must_use]
    pub fn new(solution: &'a Solution<'a>) -> Self {
        let received = (0..2 * solution.patches.all.len()).map(|_| OnceLock::new()).collect();
        Self { solution, reflection: Reflection::new(solution.scene), received }
    }

    /// What a meter reads per band; `None` for one around the scene.
    #[must_use]
    pub fn reading(&self, meter: &Meter) -> Option<Vec<f64>> {
        match &meter.place {
            Place::Point(point) => Some(self.at(point, &meter.response)),
            Place::Area(shape) => Some(self.on(shape)),
            Place::Around => None,
        }
    }

    /// The mean irradiance of the outside of a surface of the scene.
    fn on(&self, shape: &Arc<dyn Shape>) -> Vec<f64> {
        let s = self.solution;
        let n = s.scene.bands().len();
        let is_it = |patch: &Patch| Arc::ptr_eq(&s.scene.surfaces().shapes()[patch.surface], shape);
        let (mut sum, mut area) = (vec![0.0; n], 0.0);
        for (index, patch) in s.patches.all.iter().enumerate().filter(|(_, p)| is_it(p)) {
            let own = &s.irradiance[2 * index * n..][..n];
            sum.iter_mut().zip(own).for_each(|(sum, e)| *sum += patch.area * e);
            area += patch.area;
        }
        sum.iter_mut().for_each(|sum| *sum /= area);
        sum
    }

    fn at(&self, point: &SurfacePoint, response: &Response) -> Vec<f64> {
        let n = self.solution.scene.bands().len();
        let frame = Frame::of(point.normal, point.tangent);
        let mut sum = vec![0.0; n];
        if let Response::Cone { .. } = response {
            for index in 0..IN_CONE {
                let [u, v, _] = spread(index, 0);
                let (local, weight) = response.sample([u, v]);
                let direction = frame.world(local);
                let radiance = self.radiance(&Ray { origin: point.origin_towards(direction), direction });
                sum.iter_mut().zip(radiance).for_each(|(s, l)| *s += weight * l / f64::from(IN_CONE));
            }
            return sum;
        }
        self.direct(point, (OF_METER, 0), &mut sum, |towards| response.weight(frame.local(towards)));
        self.gather(point, Some(response), Part::All, &mut sum);
        sum
    }

    /// Adds the light that was not reflected yet, from what is no diffuse surface.
    fn direct(&self, point: &SurfacePoint, samples: (u32, u32), sum: &mut [f64], weight: impl Fn(glam::DVec3) -> f64) {
        let mut arriving = vec![0.0; sum.len()];
        let s = self.solution;
        s.lights.visit(s.scene, point, samples, &mut arriving, |towards, irradiance| {
            let weight = weight(towards);
            sum.iter_mut().zip(irradiance).for_each(|(s, e)| *s += weight * e);
        });
    }

    /// Adds what patches send to a point: its irradiance, or what another response makes of it.
    fn gather(&self, point: &SurfacePoint, response: Option<&Response>, part: Part, sum: &mut [f64]) {
        let all = 2 * self.solution.patches.all.len();
        if part == Part::Emitted {
            self.solution.emitters.iter().for_each(|e| self.add(*e, point, response, part, sum));
        } else {
            (0..all).for_each(|e| self.add(e, point, response, part, sum));
        }
    }

    fn add(&self, element: usize, point: &SurfacePoint, response: Option<&Response>, part: Part, sum: &mut [f64]) {
        let s = self.solution;
        let n = sum.len();
        let (patch, back) = (&s.patches.all[element / 2], element % 2 == 1);
        let reflected = &s.reflected[element * n..][..n];
        let emission = s.emitters.binary_search(&element).ok().and_then(|_| s.scene.emission(patch.surface));
        let is_dark = match part {
            Part::Emitted => emission.is_none(),
            Part::Reflected => reflected.iter().all(|r| *r == 0.0),
            Part::All => emission.is_none() && reflected.iter().all(|r| *r == 0.0),
        };
        if is_dark {
            return;
        }
        let weight = self.weight(patch, back, point, response, emission.is_some());
        if weight == 0.0 {
            return;
        }
        if part != Part::Emitted {
            sum.iter_mut().zip(reflected).for_each(|(s, m)| *s += weight / PI * m);
        }
        if let (Some(emission), true) = (emission, part != Part::Reflected) {
            sum.iter_mut().zip(emission.radiance()).for_each(|(s, l)| *s += weight * l);
        }
    }

    /// ∫ R(ω) dω over what is seen of a side of a patch; R is cosθ above the point where there is no response.
    fn weight(
        &self,
        patch: &Patch,
        back: bool,
        point: &SurfacePoint,
        response: Option<&Response>,
        shines: bool,
    ) -> f64 {
        let planar = response.is_none_or(|r| *r == Response::Planar);
        // Behind the patch, or the patch below the horizon: the common case, told at once.
        if patch.cell.height(point.position).is_some_and(|h| (h < 0.0) != back || h == 0.0) {
            return 0.0;
        }
        if planar && (patch.centre - point.position).dot(point.normal) < -patch.radius {
            return 0.0;
        }
        let frame = Frame::of(point.normal, point.tangent);
        // What a part of the patch about a node adds.
        let of = |node: &Node, area: f64| {
            let way = node.spot.position - point.position;
            let square = way.length_squared();
            let direction = way / square.sqrt();
            let facing = if back { direction.dot(node.spot.normal) } else { -direction.dot(node.spot.normal) };
            let seen = response.map_or(point.normal.dot(direction).max(0.0), |r| r.weight(frame.local(direction)));
            if facing > 0.0 { area * node.weight * seen * facing / square } else { 0.0 }
        };
        let clear = |node: &Node| {
            let way = node.spot.position - point.position;
            let distance = way.length();
            let direction = way / distance;
            let ray = Ray { origin: point.origin_towards(direction), direction };
            !self.solution.scene.surfaces().is_occluded(&ray, distance * (1.0 - factor::SHORT), None)
        };
        let closed = if planar { patch.cell.projected_solid_angle(point.position, point.normal) } else { None };
        let part = |nodes: &[Node]| {
            let (mut all, mut lit) = (0.0, 0.0);
            for node in nodes {
                let weight = of(node, patch.area);
                all += weight;
                if weight > 0.0 && clear(node) {
                    lit += weight;
                }
            }
            (all, lit)
        };
        let whole = |sum: f64| closed.unwrap_or_else(|| self.near(patch, back, point, &of).unwrap_or(sum));
        let (all, lit) = part(&patch.coarse);
        // Four rays do where they agree; emitters make the edges of shadows and get sixteen.
        if !shines && all > 0.0 && (lit == 0.0 || lit == all) {
            return if lit == 0.0 { 0.0 } else { whole(all) };
        }
        let (all, lit) = part(&patch.fine);
        if lit == 0.0 { 0.0 } else { whole(all) * lit / all }
    }

    /// The integral over a patch that is not far from the point, adaptively; `None` where a few nodes do.
    fn near(&self, patch: &Patch, back: bool, point: &SurfacePoint, of: &dyn Fn(&Node, f64) -> f64) -> Option<f64> {
        use crate::math::cubature::{Tolerance, rectangle};
        const TOLERANCE: Tolerance = Tolerance { absolute: 1e-7, relative: 1e-4, evaluations: 3000 };
        let gap = patch.centre.distance(point.position);
        // On the inside of a round surface nothing is ever near in the sense of a steep kernel.
        if gap > 8.0 * patch.radius || (back && !patch.cell.is_flat()) {
            return None;
        }
        let mut sum = [0.0];
        let f = |p: [f64; 2], value: &mut [f64]| {
            let (spot, weight) = patch.cell.at(p);
            value[0] = of(&Node { spot, weight }, patch.area);
        };
        rectangle(f, [0.0; 2], [1.0; 2], TOLERANCE, &mut sum);
        Some(sum[0])
    }

    /// Radiance along a ray, per band.
    #[must_use]
    pub fn radiance(&self, ray: &Ray) -> Vec<f64> {
        let s = self.solution;
        let n = s.scene.bands().len();
        let mut out = vec![0.0; n];
        let Some((surface, crossing)) = s.scene.surfaces().closest(ray, f64::INFINITY) else {
            let mut one = vec![0.0; n];
            for light in s.scene.lights() {
                one.fill(0.0);
                light.add_radiance(ray.direction, &mut one);
                out.iter_mut().zip(&one).for_each(|(o, l)| *o += l);
            }
            return out;
        };
        let point = s.scene.surfaces().surface_point(surface, ray, &crossing);
        let back = ray.direction.dot(point.normal) > 0.0;
        let mut facing = point;
        if back {
            facing.normal = -point.normal;
        }
        if let Some(patch) = s.patches.find(surface, &crossing, point.position) {
            self.irradiance(patch, back, &facing, &mut out);
            let mut scratch = vec![0.0; n];
            self.reflection.apply(surface, back, point.uv, &mut out, &mut scratch);
            out.iter_mut().for_each(|l| *l /= PI);
        }
        if let Some(emission) = s.scene.emission(surface) {
            let profile = emission.profile_towards(-ray.direction, -point.normal.dot(ray.direction));
            out.iter_mut().zip(emission.radiance()).for_each(|(o, l)| *o += profile * l);
        }
        out
    }

    /// Adds the irradiance of a point of a patch.
    fn irradiance(&self, patch: usize, back: bool, point: &SurfacePoint, sum: &mut [f64]) {
        let n = sum.len();
        self.direct(point, (OF_POINT, 0), sum, |towards| towards.dot(point.normal).max(0.0));
        self.gather(point, None, Part::Emitted, sum);
        let element = 2 * patch + usize::from(back);
        let cell = &self.solution.patches.all[patch].cell;
        let received = self.received[element].get_or_init(|| self.received(patch, back));
        let weights = between(cell.locate(point.position), cell.is_triangle());
        for (weight, values) in weights.iter().zip(received.chunks_exact(n)) {
            sum.iter_mut().zip(values).for_each(|(s, e)| *s += weight * e);
        }
        // Straight lines may cross 0 where a patch is dark on one side.
        sum.iter_mut().for_each(|s| *s = s.max(0.0));
    }

    /// The reflected light that the coarse nodes of a side of a patch receive.
    fn received(&self, patch: usize, back: bool) -> Vec<f64> {
        let n = self.solution.scene.bands().len();
        let own = &self.solution.patches.all[patch];
        let mut out = vec![0.0; n * own.coarse.len()];
        for (node, sum) in own.coarse.iter().zip(out.chunks_exact_mut(n)) {
            self.gather(&own.point(&node.spot, back), None, Part::Reflected, sum);
        }
        out
    }
}

/// The weights of the four coarse nodes at coordinates of a cell. In a triangle the second coordinate means nothing at its corner, where the
/// nodes are weighed alike.
fn between([u, v]: [f64; 2], is_triangle: bool) -> [f64; 4] {
    use super::patches::GAUSS2;
    let place = |x: f64| (x - GAUSS2[0].0) / (GAUSS2[1].0 - GAUSS2[0].0);
    let (a, mut b) = (place(u), place(v));
    if is_triangle {
        b = 0.5 + (b - 0.5) * (u / GAUSS2[1].0).min(1.0);
    }
    [(1.0 - a) * (1.0 - b), (1.0 - a) * b, a * (1.0 - b), a * b]
}
