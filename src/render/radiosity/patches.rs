//! The surfaces of a scene cut into patches, and the patch that a point is on.

use glam::DVec3;

use super::Error;
use super::cut::{Occluders, cut};
use super::lights::is_diffuse_emitter;
use crate::render::ray::{Crossing, Ray, SurfacePoint};
use crate::render::scene::Scene;
use crate::render::shape::chart::{Cell, Chart, Spot};

/// Most patches: their links, two for every pair that sees each other, fill a gigabyte.
pub const MOST: usize = 8192;
/// Patches of a scene that states no edge, about.
const USUAL: f64 = 1000.0;

/// Gauss-Legendre rules of two and of four points on [0, 1] (Abramowitz & Stegun, table 25.4).
pub(super) const GAUSS2: [(f64, f64); 2] = [(0.211_324_865_405_187_13, 0.5), (0.788_675_134_594_812_9, 0.5)];
pub(super) const GAUSS4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// A point of a patch with its share of the area.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub spot: Spot,
    pub weight: f64,
}

/// A part of a surface, both sides of it.
#[derive(Debug)]
pub(super) struct Patch {
    pub surface: usize,
    pub cell: Cell,
    pub area: f64,
    pub centre: DVec3,
    /// Of a sphere about the centre that holds it, m.
    pub radius: f64,
    /// By the rules of two and of four points.
    pub coarse: Vec<Node>,
    pub fine: Vec<Node>,
    /// Another surface in the same place is seen instead of it: it receives light and hands none on.
    pub hidden: bool,
    /// How far rays start off it, m.
    offset: f64,
}

/// A chart of a surface with the patches that it was cut into.
#[derive(Debug)]
struct Grid {
    face: u32,
    chart: Chart,
    counts: [usize; 2],
    /// Where the patches of each cell begin, and the end: one, or its pieces.
    starts: Vec<usize>,
}

/// All patches of a scene.
#[derive(Debug)]
pub(super) struct Patches {
    pub all: Vec<Patch>,
    /// By surface.
    grids: Vec<Vec<Grid>>,
}

/// The nodes of a rule in both coordinates; the weights sum to 1.
fn nodes(cell: &Cell, rule: &[(f64, f64)]) -> Vec<Node> {
    let pairs = rule.iter().flat_map(|a| rule.iter().map(move |b| (a, b)));
    let node = |(&(u, a), &(v, b)): (&(f64, f64), &(f64, f64))| {
        let (spot, density) = cell.at([u, v]);
        Node { spot, weight: a * b * density }
    };
    pairs.map(node).collect()
}

impl Patch {
    fn new(surface: usize, cell: Cell) -> Self {
        let extremes = cell.extremes();
        #[expect(clippy::cast_precision_loss, reason = "a number of corners")]
        let centre = extremes.iter().sum::<DVec3>() / extremes.len() as f64;
        let radius = extremes.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        let (coarse, fine) = (nodes(&cell, &GAUSS2), nodes(&cell, &GAUSS4));
        // Beyond all rounding of the point and of the crossing of the surface itself, which a ray that starts here must not find.
        let offset = 1e-11 * (centre.abs().max_element() + radius);
        Self { surface, area: cell.area(), cell, centre, radius, coarse, fine, hidden: false, offset }
    }

    /// The point of a node as seen from one side of the patch, for rays that leave there.
    pub fn point(&self, spot: &Spot, back: bool) -> SurfacePoint {
        let normal = if back { -spot.normal } else { spot.normal };
        SurfacePoint::meter(spot.position, normal, self.offset)
    }

    /// The surface at a node, with its texture coordinates.
    pub fn surface_point(&self, scene: &Scene, spot: &Spot) -> Option<SurfacePoint> {
        let shape = scene.surfaces().shapes()[self.surface].as_ref();
        let ray = Ray { origin: spot.position + self.radius * spot.normal, direction: -spot.normal };
        let crossing = shape.cross(&ray, 0.5 * self.radius, 1.5 * self.radius)?;
        Some(shape.surface(&ray, &crossing))
    }
}

impl Patches {
    /// Cuts all surfaces into patches with edges of about `edge` (m) at most; without it, into as many as make a quick solution.
    pub fn new(scene: &Scene, edge: Option<f64>) -> Result<(Self, f64), Error> {
        let charts: Vec<_> = scene.surfaces().shapes().iter().map(|s| s.charts()).collect();
        let area: f64 = charts.iter().flatten().map(|(_, chart)| chart.area()).sum();
        let edge = edge.unwrap_or((area / USUAL).sqrt());
        let count = |[m, n]: [usize; 2]| m.saturating_mul(n);
        let found: usize = (charts.iter().flatten()).fold(0, |sum, (_, c)| sum.saturating_add(count(c.counts(edge))));
        if found > MOST {
            return Err(Error::TooMany { found, edge_m: edge });
        }
        let shining = |surface| is_diffuse_emitter(scene, surface);
        let occluders = (charts.iter().enumerate())
            .flat_map(|(surface, charts)| charts.iter().map(move |(_, chart)| (*chart, shining(surface))));
        let occluders = Occluders::new(occluders);
        let (mut all, mut grids) = (Vec::with_capacity(found), Vec::with_capacity(charts.len()));
        let mut number = 0;
        for (surface, charts) in charts.into_iter().enumerate() {
            let mut own = Vec::with_capacity(charts.len());
            for (face, chart) in charts {
                let (counts, lines) = (chart.counts(edge), occluders.lines(number, edge));
                let mut starts = Vec::with_capacity(count(counts) + 1);
                for cell in chart.cells(counts) {
                    starts.push(all.len());
                    all.extend(cut(cell, &lines).into_iter().map(|cell| {
                        let patch = Patch::new(surface, cell);
                        let hidden = occluders.hide(number, &patch.cell, patch.centre, patch.radius);
                        Patch { hidden, ..patch }
                    }));
                }
                starts.push(all.len());
                own.push(Grid { face, chart, counts, starts });
                number += 1;
            }
            grids.push(own);
        }
        match all.len() {
            found if found > MOST => Err(Error::TooMany { found, edge_m: edge }),
            _ => Ok((Self { all, grids }, edge)),
        }
    }

    /// The patch at a crossing of a surface.
    pub fn find(&self, surface: usize, crossing: &Crossing, position: DVec3) -> Option<usize> {
        let grids = &self.grids[surface];
        let first = grids.partition_point(|g| g.face < crossing.face);
        let own = grids[first..].iter().take_while(|g| g.face == crossing.face);
        let grid = own.min_by(|a, b| a.chart.outside(position).total_cmp(&b.chart.outside(position)))?;
        let index = grid.chart.index(grid.counts, position);
        let outside = |patch: &usize| self.all[*patch].cell.outside(position);
        (grid.starts[index]..grid.starts[index + 1]).min_by(|a, b| outside(a).total_cmp(&outside(b)))
    }
}
