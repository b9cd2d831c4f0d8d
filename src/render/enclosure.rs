//! Closed spaces that keep all light: walls around them that absorb nothing and let nothing through, and nothing within that absorbs.
//!
//! What a lamp sends into such a space stays there: the radiance grows without bound, there is no steady state, and nothing but a limit on its
//! edges ends a path that begins within. [`Enclosure::find`] finds one only where that is certain, so that no scene is refused for a guess:
//!
//! - **The walls close.** Every edge and every circle of their outlines, cut where corners of others lie on it, is that of an even number of
//!   walls. Then a ray from a point crosses the walls an odd number of times in every direction, or an even number in every direction, and from
//!   a point of odd crossings nothing leads out (parity of the crossings of a cycle modulo 2). Surfaces with an edge of their own alone, such as
//!   a screen in a room, are no walls.
//! - **They keep all light** on the side that is within: diffuse or Dirac materials whose albedo is known in closed form, the same in all
//!   directions, and 1 to within 1e-12, in one band at least.
//! - **So does what is within**: all other surfaces keep all light of that band on both sides, or lie apart from the walls' box.
//!
//! Limits, where a space that keeps all light is not found: walls that reach beyond their neighbours (a floor that goes on outside), textures that
//! are white all over, absorbers that are outside but within the box.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use glam::DVec3;

use super::integrator::frame::Frame;
use super::light::Light;
use super::material::Material;
use super::measure::{Meter, Place};
use super::ray::{Ray, SurfacePoint};
use super::scene::Scene;
use super::shape::chart::Chart;
use super::shape::{Bounds, Shape};
use crate::geometry::direction::tangents;
use crate::math::random::Stream;
use crate::math::sampling::cosine_hemisphere;

/// An albedo from which on nothing is absorbed: paths would be followed 10¹² edges on average.
const KEPT: f64 = 1.0 - 1e-12;
/// Corners nearer than this to one another are one, in extents of the walls.
const SAME: f64 = 1e-9;
/// More edges than this that no neighbour of the same surface shares are not searched for partners.
const MOST_EDGES: usize = 4096;
/// Rays whose crossings are counted: all of them must agree, as one may pass through an edge.
const RAYS: u64 = 5;
/// Crossings of a ray at most; beyond, nothing is known of it.
const MOST_CROSSINGS: usize = 10_000;

/// Walls that close a space, or several, and keep all light in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Enclosure {
    /// By surface of the scene.
    is_wall: Vec<bool>,
    /// All that is within reflects as mirrors and glass do.
    pub specular: bool,
}

/// What of the light that comes to its outside and to its inside a material keeps: all of it, or less.
type Keeps = [bool; 2];

/// Where something begins: rays that leave one place, or a light.
pub type Start = Vec<Ray>;

/// Where a light's packets begin.
#[must_use]
pub fn of_light(light: &dyn Light, bands: usize) -> Start {
    let (mut random, mut flux) = (Stream::new(0, 0), vec![0.0; bands]);
    (0..RAYS).filter_map(|_| light.emit(random.uniforms(), &mut flux)).collect()
}

/// Where paths from a meter begin; nowhere for one around the scene.
#[must_use]
pub fn of_meter(meter: &Meter) -> Start {
    match &meter.place {
        Place::Point(point) => of_place(point),
        Place::Area(shape) => of_place(&shape.sample_area([0.5, 0.4, 0.6])),
        Place::Around => Vec::new(),
    }
}

/// Rays from a place into the half space before it.
#[must_use]
pub fn of_place(point: &SurfacePoint) -> Start {
    let (t, _) = tangents(point.normal);
    let frame = Frame::of(point.normal, t);
    let mut random = Stream::new(1, 0);
    let ray = |_| {
        let direction = frame.world(cosine_hemisphere(random.uniforms()));
        Ray { origin: point.origin_towards(direction), direction }
    };
    (0..RAYS).map(ray).collect()
}

/// By surface of a scene, the sides that keep all light of some bands.
#[derive(Debug, Clone)]
pub struct Case(Vec<Keeps>);

/// The cases of a scene in which something may be a wall, for [`Enclosure::find`]; mostly none.
#[must_use]
pub fn cases(scene: &Scene) -> Vec<Case> {
    let (surfaces, bands) = (scene.surfaces().shapes().len(), scene.bands().len());
    // By material: scenes have fewer of them than surfaces.
    let mut known: HashMap<*const (), usize> = HashMap::new();
    let mut materials: Vec<(Vec<Keeps>, bool)> = Vec::new();
    let material_of: Vec<usize> = (0..surfaces)
        .map(|surface| {
            let material = scene.material(surface);
            *known.entry(std::ptr::from_ref(material).cast()).or_insert_with(|| {
                materials.push((keeps(material, bands), !material.is_transmissive()));
                materials.len() - 1
            })
        })
        .collect();
    // Bands in which the same materials keep all light are one case.
    let cases: BTreeSet<Vec<Keeps>> = (0..bands).map(|b| materials.iter().map(|(m, _)| m[b]).collect()).collect();
    let has_walls =
        |case: &Vec<Keeps>| case.iter().zip(&materials).any(|(keeps, (_, opaque))| *opaque && keeps.contains(&true));
    let of_surfaces = |case: Vec<Keeps>| Case(material_of.iter().map(|m| case[*m]).collect());
    cases.into_iter().filter(has_walls).map(of_surfaces).collect()
}

impl Enclosure {
    /// One in which all light of some bands is kept, and some of `starts` are.
    #[must_use]
    pub fn find(scene: &Scene, cases: &[Case], starts: &[Start]) -> Option<Self> {
        let mut found = cases.iter().filter_map(|Case(keeps)| Self::of_case(scene, keeps, starts));
        found.find(|enclosure| starts.iter().any(|start| enclosure.holds(scene, start)))
    }

    fn of_case(scene: &Scene, keeps: &[Keeps], starts: &[Start]) -> Option<Self> {
        let shapes = scene.surfaces().shapes();
        let may_be = |surface: &usize| keeps[*surface] != [false; 2] && !scene.material(*surface).is_transmissive();
        let candidates: Vec<usize> = (0..shapes.len()).filter(may_be).collect();
        // A white object in the open is not cut into its pieces.
        let about = candidates.iter().map(|c| shapes[*c].bounds()).fold(Bounds::EMPTY, Bounds::union);
        let is_in = |ray: &Ray| ray.origin.cmpge(about.min).all() && ray.origin.cmple(about.max).all();
        if !starts.iter().flatten().any(is_in) {
            return None;
        }
        let walls = closed(&candidates.iter().map(|s| (*s, shapes[*s].as_ref())).collect::<Vec<_>>())?;
        let mut found = Self { is_wall: vec![false; shapes.len()], specular: true };
        walls.iter().for_each(|wall| found.is_wall[*wall] = true);
        let bounds = walls.iter().map(|w| shapes[*w].bounds()).fold(Bounds::EMPTY, Bounds::union);
        for (surface, shape) in shapes.iter().enumerate() {
            if !found.is_wall[surface] && is_apart(shape.as_ref(), &bounds) {
                continue;
            }
            let sound = keeps[surface] == [true; 2]
                || found.is_wall[surface] && found.faces_inwards(scene, shape.as_ref(), keeps[surface]);
            if !sound {
                return None;
            }
            found.specular &= scene.material(surface).is_delta();
        }
        Some(found)
    }

    /// Its walls, by their number in the scene.
    pub fn walls(&self) -> impl Iterator<Item = usize> + '_ {
        self.is_wall.iter().enumerate().filter(|(_, is)| **is).map(|(surface, _)| surface)
    }

    /// Whether a start is within.
    #[must_use]
    pub fn holds(&self, scene: &Scene, start: &Start) -> bool {
        !start.is_empty() && start.iter().all(|ray| self.crossings(scene, ray).is_some_and(|n| n % 2 == 1))
    }

    /// Whether a wall's sides that are within are those that keep all light, by the middle of each of its pieces.
    fn faces_inwards(&self, scene: &Scene, shape: &dyn Shape, keeps: Keeps) -> bool {
        let off = SAME * (shape.bounds().max - shape.bounds().min).length();
        shape.charts().iter().all(|(_, chart)| {
            let spot = chart.at([0.5; 2]);
            let side = |normal| self.holds(scene, &of_place(&SurfacePoint::meter(spot.position, normal, off)));
            match [side(spot.normal), side(-spot.normal)] {
                [true, false] => keeps[0],
                [false, true] => keeps[1],
                // A ray through an edge: not known.
                _ => false,
            }
        })
    }

    /// How often a ray crosses walls. Each is asked by itself, so that two in one place count twice.
    fn crossings(&self, scene: &Scene, ray: &Ray) -> Option<usize> {
        let mut count = 0;
        for wall in self.walls() {
            let shape = scene.surfaces().shapes()[wall].as_ref();
            let mut near = 0.0;
            while let Some(crossing) = shape.cross(ray, near, f64::INFINITY) {
                (near, count) = (crossing.t, count + 1);
                if count > MOST_CROSSINGS {
                    return None;
                }
            }
        }
        Some(count)
    }
}

/// Per band, the sides on which a material keeps all light; none where that is not known in closed form.
fn keeps(material: &dyn Material, bands: usize) -> Vec<Keeps> {
    let mut out = vec![[false; 2]; bands];
    if material.converts() || !(material.is_diffuse() || material.is_delta()) {
        return out;
    }
    let mut share = vec![0.0; bands];
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        let mut all = vec![true; bands];
        for cos in [1.0, 0.8, 0.5, 0.2] {
            let arriving = DVec3::new(f64::sqrt(1.0 - cos * cos), 0.0, sign * cos);
            if material.albedo(arriving, &mut share) != Some(0.0) {
                return out;
            }
            all.iter_mut().zip(&share).for_each(|(all, share)| *all &= *share >= KEPT);
        }
        out.iter_mut().zip(all).for_each(|(out, all)| out[side] = all);
    }
    out
}

/// Whether a surface is nowhere in a box, nor touches it.
fn is_apart(shape: &dyn Shape, from: &Bounds) -> bool {
    let gap = SAME * (from.max - from.min).length();
    let own = shape.bounds();
    if (own.min - gap).cmpgt(from.max).any() || (own.max + gap).cmplt(from.min).any() {
        return true;
    }
    // A flat one, such as a plane without bounds: all of the box on one side.
    shape.facing().is_some_and(|normal| {
        let anchor = shape.sample_area([0.5; 3]).position;
        let middle = 0.5 * (from.min + from.max);
        let reach = 0.5 * (from.max - from.min).dot(normal.abs());
        (middle - anchor).dot(normal).abs() > reach + gap
    })
}

/// An outline of a piece of a surface.
#[derive(Debug, Clone, Copy)]
enum Border {
    Line([DVec3; 2]),
    Circle { centre: DVec3, axis: DVec3, radius: f64 },
}

fn borders(chart: &Chart) -> Vec<Border> {
    if let Some(corners) = chart.corners() {
        let next = corners.iter().cycle().skip(1);
        return corners.iter().zip(next).map(|(p, q)| Border::Line([*p, *q])).collect();
    }
    let circle = |centre, axis, radius| Border::Circle { centre, axis, radius };
    match *chart {
        Chart::Ring { centre, axes: [x, y], radii } => {
            radii.into_iter().filter(|r| *r > 0.0).map(|radius| circle(centre, x.cross(y), radius)).collect()
        }
        Chart::Tube { base, axes: [_, _, axis], length, radius } => {
            [base, base + length * axis].map(|centre| circle(centre, axis, radius)).to_vec()
        }
        Chart::Sphere { .. } | Chart::Parallelogram { .. } | Chart::Triangle(_) => Vec::new(),
    }
}

/// Puts a thing in, or takes it out where it is: sums modulo 2.
fn toggle<T: Eq + std::hash::Hash>(set: &mut HashSet<T>, thing: T) {
    if let Some(there) = set.take(&thing) {
        drop(there);
    } else {
        set.insert(thing);
    }
}

/// The edges of a surface that none of its own pieces shares, and its circles; `None` where its pieces are not known.
fn outline(shape: &dyn Shape) -> Option<Vec<Border>> {
    let charts = shape.charts();
    if charts.is_empty() {
        return None;
    }
    // Pieces of one surface have the same corners to the last bit; −0 is 0.
    let bits = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut edges = HashSet::new();
    let mut out = Vec::new();
    for border in charts.iter().flat_map(|(_, chart)| borders(chart)) {
        match border {
            Border::Line([p, q]) => {
                let (p, q) = (bits(p), bits(q));
                toggle(&mut edges, (p.min(q), p.max(q)));
            }
            circle @ Border::Circle { .. } => out.push(circle),
        }
    }
    let point = |bits: [u64; 3]| DVec3::from_array(bits.map(f64::from_bits));
    out.extend(edges.into_iter().map(|(p, q)| Border::Line([point(p), point(q)])));
    Some(out)
}

/// A piece of an outline by its numbers: two corners, or a circle.
type Piece = (usize, usize);

/// Those of the surfaces that close a space together: each piece of their outlines is that of an even number of them.
fn closed(surfaces: &[(usize, &dyn Shape)]) -> Option<Vec<usize>> {
    let outlines: Vec<(usize, Vec<Border>)> =
        surfaces.iter().filter_map(|(surface, shape)| Some((*surface, outline(*shape)?))).collect();
    if outlines.iter().map(|(_, outline)| outline.len()).sum::<usize>() > MOST_EDGES {
        return None;
    }
    let bounds = surfaces.iter().map(|(_, s)| s.bounds()).filter(Bounds::is_finite).fold(Bounds::EMPTY, Bounds::union);
    let near = SAME * (bounds.max - bounds.min).length();
    let (mut corners, mut circles): (Vec<DVec3>, Vec<(DVec3, DVec3, f64)>) = (Vec::new(), Vec::new());
    let mut corner = |p: DVec3| {
        corners.iter().position(|q| q.distance(p) <= near).unwrap_or_else(|| {
            corners.push(p);
            corners.len() - 1
        })
    };
    let mut numbered: Vec<(usize, Vec<Piece>, Vec<Piece>)> = Vec::new();
    for (surface, outline) in &outlines {
        let (mut lines, mut round) = (Vec::new(), Vec::new());
        for border in outline {
            match *border {
                Border::Line([p, q]) => lines.push((corner(p), corner(q))),
                Border::Circle { centre, axis, radius } => {
                    let same = |(c, a, r): &(DVec3, DVec3, f64)| {
                        c.distance(centre) <= near && (r - radius).abs() <= near && a.cross(axis).length() * r <= near
                    };
                    let number = circles.iter().position(same).unwrap_or_else(|| {
                        circles.push((centre, axis, radius));
                        circles.len() - 1
                    });
                    round.push((usize::MAX, number));
                }
            }
        }
        numbered.push((*surface, lines, round));
    }
    let mut left: BTreeMap<usize, HashSet<Piece>> = BTreeMap::new();
    for (surface, lines, round) in numbered {
        let pieces = left.entry(surface).or_default();
        round.into_iter().for_each(|piece| toggle(pieces, piece));
        lines.into_iter().flat_map(|line| cut(line, &corners, near)).for_each(|piece| toggle(pieces, piece));
    }
    loop {
        let mut counts: HashMap<Piece, usize> = HashMap::new();
        left.values().flatten().for_each(|piece| *counts.entry(*piece).or_default() += 1);
        let before = left.len();
        left.retain(|_, pieces| pieces.iter().all(|piece| counts[piece] > 1));
        if left.len() == before {
            let closes = !left.is_empty() && counts.values().all(|count| count % 2 == 0);
            return closes.then(|| left.into_keys().collect());
        }
    }
}

/// A line between two corners, cut at the corners that lie on it.
fn cut((from, to): Piece, corners: &[DVec3], near: f64) -> Vec<Piece> {
    let (start, end) = (corners[from], corners[to]);
    let length = start.distance(end);
    if length <= near {
        return Vec::new();
    }
    let along = (end - start) / length;
    let mut stops: Vec<(f64, usize)> = (corners.iter().enumerate())
        .filter_map(|(number, p)| {
            let place = (*p - start).dot(along);
            let beside = (*p - start - place * along).length();
            (place > near && place < length - near && beside <= near).then_some((place, number))
        })
        .collect();
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all: Vec<usize> = [from].into_iter().chain(stops.into_iter().map(|(_, number)| number)).chain([to]).collect();
    all.windows(2).map(|w| (w[0].min(w[1]), w[0].max(w[1]))).collect()
}
