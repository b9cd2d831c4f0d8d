//! Patches cut where other surfaces meet them.
//!
//! A patch has one radiosity all over. One that lies partly beneath a block would hand light on to the block's inside, and how much of it
//! the room sees would be a guess of a few rays. So patches with straight edges are cut along the lines on which flat surfaces with straight
//! edges cross their plane, touch it, or end closely above it (a lamp below a ceiling). What is left lies beside the block or beneath it.
//!
//! Where a surface lies in another's plane, as the bottom of a block on the floor, one hides the other: [`Occluders::hide`].

use glam::DVec3;

use crate::render::shape::chart::{Cell, Chart};

/// An edge is taken for one that meets a patch up to so far from its plane, in edges of patches.
const NEAR: f64 = 0.1;
/// Cuts nearer than this to a corner are not made, in radii of the patch: they would leave splinters.
const SPLINTER: f64 = 1e-4;
/// Nor are those of lines that cross less than this of a patch.
const SHORT: f64 = 0.05;
/// A patch of which there are so many pieces is cut no more: fine meshes would leave nothing but splinters.
const MOST_PIECES: usize = 16;
/// Of the same plane, in radii.
const SAME_PLANE: f64 = 1e-9;

/// A flat piece of a surface with straight edges.
#[derive(Debug)]
struct Occluder {
    chart: Chart,
    corners: Vec<DVec3>,
    shines: bool,
}

/// All such pieces of a scene, by their number among all charts.
#[derive(Debug)]
pub(super) struct Occluders(Vec<Option<Occluder>>);

/// A line across a plane, from end to end.
pub(super) type Line = [DVec3; 2];

impl Occluders {
    /// Of charts, each with whether it shines as patches do.
    pub fn new(charts: impl Iterator<Item = (Chart, bool)>) -> Self {
        Self(charts.map(|(chart, shines)| Some(Occluder { chart, corners: chart.corners()?, shines })).collect())
    }

    /// The lines on which the others meet a chart whose patches have edges of `edge_m`; none of a curved one.
    pub fn lines(&self, own: usize, edge_m: f64) -> Vec<Line> {
        let Some(Occluder { chart, corners, .. }) = &self.0[own] else { return Vec::new() };
        let (normal, anchor) = (chart.at([0.5; 2]).normal, corners[0]);
        let (centre, radius) = around(corners);
        let near = NEAR * edge_m;
        let mut lines = Vec::new();
        for (_, other) in self.0.iter().enumerate().filter(|(number, _)| *number != own) {
            let Some(other) = other else { continue };
            let (middle, reach) = around(&other.corners);
            if middle.distance(centre) > radius + reach + near {
                continue;
            }
            let height = |p: DVec3| (p - anchor).dot(normal);
            let mut crossed = Vec::new();
            for (p, q) in edges(&other.corners) {
                let (a, b) = (height(p), height(q));
                if a.abs() <= near && b.abs() <= near {
                    lines.push([p - a * normal, q - b * normal]);
                }
                if (a >= 0.0) != (b >= 0.0) {
                    crossed.push(p + a / (a - b) * (q - p));
                }
            }
            if let [p, q] = crossed[..] {
                lines.push([p, q]);
            }
        }
        lines
    }

    /// Whether a flat patch of the chart `own` lies within another surface of the same plane that hides it: one that shines where this one
    /// does not, else the one that comes first. The hidden one receives light as the other does, but hands none on.
    pub fn hide(&self, own: usize, cell: &Cell, centre: DVec3, radius: f64) -> bool {
        let shines = self.0[own].as_ref().is_some_and(|o| o.shines);
        let goes_before = |number: usize, other: &Occluder| match (other.shines, shines) {
            (true, false) => true,
            (false, true) => false,
            _ => number < own,
        };
        // Far from the origin coordinates are rounded by more, and a small patch tilts by that.
        let rounding = 4.0 * f64::EPSILON * centre.abs().max_element();
        let within = |p: &DVec3| SAME_PLANE * radius + rounding * (1.0 + p.distance(centre) / radius);
        let in_plane = |p: &DVec3| cell.height(*p).is_some_and(|h| h.abs() <= within(p));
        (self.0.iter().enumerate())
            .filter_map(|(number, other)| Some((number, other.as_ref()?)))
            .filter(|(number, other)| *number != own && goes_before(*number, other))
            .any(|(_, other)| other.corners.iter().all(in_plane) && other.chart.outside(centre) < 0.0)
    }
}

/// A sphere that holds some points: centre and radius.
fn around(points: &[DVec3]) -> (DVec3, f64) {
    #[expect(clippy::cast_precision_loss, reason = "a number of corners")]
    let centre = points.iter().sum::<DVec3>() / points.len() as f64;
    (centre, points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max))
}

/// The edges of a polygon.
fn edges(corners: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

/// A flat cell with straight edges, cut along lines of its plane.
pub(super) fn cut(cell: Cell, lines: &[Line]) -> Vec<Cell> {
    if lines.is_empty() {
        return vec![cell];
    }
    let normal = cell.at([0.5; 2]).0.normal;
    let whole = cell.extremes();
    let (_, radius) = around(&whole);
    let mut pieces = vec![whole];
    for line in lines {
        if pieces.len() >= MOST_PIECES {
            break;
        }
        pieces = (pieces.into_iter())
            .flat_map(|piece| match split(&piece, normal, *line, radius) {
                Some(both) => both.to_vec(),
                None => vec![piece],
            })
            .collect();
    }
    if pieces.len() == 1 { vec![cell] } else { pieces.iter().flat_map(|piece| cells(piece)).collect() }
}

/// The two parts of a convex polygon on the sides of a line; `None` where the line does not cross it.
fn split(corners: &[DVec3], normal: DVec3, [from, to]: Line, radius: f64) -> Option<[Vec<DVec3>; 2]> {
    let along = (to - from).try_normalize()?;
    let across = normal.cross(along);
    let side = |p: DVec3| {
        let s = (p - from).dot(across);
        if s.abs() <= SPLINTER * radius { 0.0 } else { s }
    };
    if !(corners.iter().any(|p| side(*p) > 0.0) && corners.iter().any(|p| side(*p) < 0.0)) {
        return None;
    }
    let mut parts = [Vec::new(), Vec::new()];
    let mut met = Vec::new();
    for (p, q) in edges(corners) {
        let (a, b) = (side(p), side(q));
        if a >= 0.0 {
            parts[0].push(p);
        }
        if a <= 0.0 {
            parts[1].push(p);
        }
        if a == 0.0 {
            met.push(p);
        } else if a * b < 0.0 {
            let crossing = p + a / (a - b) * (q - p);
            parts.iter_mut().for_each(|part| part.push(crossing));
            met.push(crossing);
        }
    }
    // How much of the line's own length is between the two points at which it enters and leaves.
    let place = |p: &DVec3| (*p - from).dot(along);
    let (low, high) = met.iter().map(place).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)));
    let within = high.min(from.distance(to)) - low.max(0.0);
    (within > SHORT * radius).then_some(parts)
}

/// A convex polygon as a parallelogram or as triangles.
fn cells(corners: &[DVec3]) -> Vec<Cell> {
    let (_, radius) = around(corners);
    if let [a, b, c, d] = *corners
        && (a + c).distance(b + d) <= SAME_PLANE * radius
    {
        return vec![Cell::whole(Chart::Parallelogram { corner: a, edges: [b - a, d - a] })];
    }
    (1..corners.len() - 1)
        .map(|k| Chart::Triangle([corners[0], corners[k], corners[k + 1]]))
        .filter(|triangle| triangle.area() > SAME_PLANE * radius * radius)
        .map(Cell::whole)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(corner: [f64; 3], edges: [[f64; 3]; 2]) -> Chart {
        Chart::Parallelogram { corner: DVec3::from_array(corner), edges: edges.map(DVec3::from_array) }
    }

    /// A block on a floor, turned by any angle: the pieces make up the floor, and each is beside the block or beneath it.
    #[test]
    fn no_patch_is_partly_beneath_a_block() {
        for turn in [0.0_f64, 0.3, 0.7, 1.2] {
            let (sin, cos) = turn.sin_cos();
            let (x, y) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
            let at = |a: f64, b: f64| DVec3::new(0.13, -0.07, 0.0) + a * x + b * y;
            let floor = rectangle([-1.0, -1.0, 0.0], [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
            let side = |p: DVec3, q: DVec3| Chart::Parallelogram { corner: p, edges: [q - p, DVec3::Z] };
            let corners = [at(-0.4, -0.3), at(0.4, -0.3), at(0.4, 0.3), at(-0.4, 0.3)];
            let sides = edges(&corners).map(|(p, q)| side(p, q));
            let bottom = Chart::Parallelogram { corner: corners[0], edges: [0.6 * y, 0.8 * x] };
            let charts: Vec<Chart> = [floor].into_iter().chain(sides).chain([bottom]).collect();
            let occluders = Occluders::new(charts.iter().map(|c| (*c, false)));
            let lines = occluders.lines(0, 0.23);
            let cells: Vec<Cell> =
                floor.cells(floor.counts(0.23)).into_iter().flat_map(|cell| cut(cell, &lines)).collect();
            let area: f64 = cells.iter().map(Cell::area).sum();
            assert!((area - 4.0).abs() < 1e-12, "{turn}: {area}");
            let beneath = |p: &DVec3| {
                let d = *p - at(0.0, 0.0);
                (d.dot(x).abs() - 0.4).max(d.dot(y).abs() - 0.3)
            };
            // Areas of all that is beneath, and of what lies otherwise than most of its patch, by points in the middles of 400 parts.
            let (mut covered, mut astray) = (0.0, 0.0);
            for cell in &cells {
                let part = |k: u32| cell.at([f64::from(k % 20) + 0.5, f64::from(k / 20) + 0.5].map(|x| x / 20.0));
                let share: f64 =
                    (0..400).map(part).filter(|(spot, _)| beneath(&spot.position) < 0.0).map(|p| p.1).sum();
                covered += share / 400.0 * cell.area();
                astray += (share / 400.0).min(1.0 - share / 400.0) * cell.area();
                let (centre, radius) = around(&cell.extremes());
                assert!(!occluders.hide(0, cell, centre, radius));
            }
            // A corner of the block that pokes into a patch by less than a twentieth of its radius (0.16 m) is left alone: so much at each
            // of four. Uncut, patches along its edges (2.8 m) would be astray by some 0.1 m².
            assert!(astray < 4.0 * 0.05 * 0.16 * 0.32, "{turn}: {astray}");
            assert!((covered - 0.48).abs() < 4.0 * 0.05 * 0.16 * 0.32, "{turn}: {covered}");
            let hidden = |number: usize| {
                let cell = Cell::whole(charts[number]);
                let (centre, radius) = around(&cell.extremes());
                occluders.hide(number, &cell, centre, radius)
            };
            assert_eq!([hidden(1), hidden(5)], [false, true], "{turn}");
        }
    }

    /// The bottom of a block lies on the floor also a million metres from the origin, where coordinates are rounded to 1e-10 m.
    #[test]
    fn what_lies_on_another_is_hidden_far_away_too() {
        let far = DVec3::new(1e6, -1e6, 1e6);
        let (x, y) = (DVec3::new(0.36, 0.48, -0.8), DVec3::new(0.8, -0.6, 0.0));
        let floor = Chart::Parallelogram { corner: far - x - y, edges: [2.0 * x, 2.0 * y] };
        for edge in [0.2, 0.02] {
            let corner = far - 0.5 * edge * (x + y);
            let bottom =
                |lift: f64| Chart::Parallelogram { corner: corner + lift * y.cross(x), edges: [edge * y, edge * x] };
            let hidden = |lift: f64| {
                let occluders = Occluders::new([floor, bottom(lift)].iter().map(|c| (*c, false)));
                let cell = Cell::whole(bottom(lift));
                let (centre, radius) = around(&cell.extremes());
                occluders.hide(1, &cell, centre, radius)
            };
            // A tenth of a micrometre is more than rounding.
            assert_eq!([hidden(0.0), hidden(1e-7)], [true, false], "{edge}");
        }
    }

    /// A line beside a patch, along its edge, or one that ends before it cuts nothing; nor does one near a corner.
    #[test]
    fn only_what_is_crossed_is_cut() {
        let square = || Cell::whole(rectangle([0.0; 3], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
        let line = |a: [f64; 2], b: [f64; 2]| [a, b].map(|[x, y]| DVec3::new(x, y, 0.0));
        let pieces = |l: Line| cut(square(), &[l]).len();
        assert_eq!(pieces(line([0.0, 0.0], [1.0, 0.0])), 1);
        assert_eq!(pieces(line([-1.0, 1.5], [2.0, 1.5])), 1);
        assert_eq!(pieces(line([-1.0, 0.5], [-0.1, 0.5])), 1);
        assert_eq!(pieces(line([-1e-5, 1.0], [1.0, 1.0 - 1e-6])), 1);
        // Parallel to an edge two parallelograms, across both edges a triangle and a quadrilateral (or two) of triangles.
        assert_eq!(pieces(line([-1.0, 0.5], [2.0, 0.5])), 2);
        assert_eq!(pieces(line([0.0, 0.0], [1.0, 1.0])), 2);
        assert_eq!(pieces(line([-1.0, 0.1], [2.0, 0.4])), 4);
        assert_eq!(pieces(line([0.5, -0.2], [1.2, 0.5])), 4);
        // Through a corner alone.
        assert_eq!(pieces(line([0.5, -0.5], [1.5, 0.5])), 1);
    }
}
