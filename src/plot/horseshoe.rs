//! The spectral locus with its colours and wavelengths, and the Planckian locus with its temperatures.

use super::axis::Scale;
use super::background;
use super::chromaticity::{ChromaticityPanel, Diagram, PlanckPoint};
use super::clip;
use super::labels::{Labels, Manner};
use super::sheet::{DARK, Ink, Point, Rect, SOFT, Sheet};

/// From CIE 1931 chromaticities to places on the sheet, and back.
#[derive(Debug, Clone, Copy)]
pub(super) struct Map {
    pub diagram: Diagram,
    pub x: Scale,
    pub y: Scale,
}

impl Map {
    /// Coordinates of the diagram.
    pub(super) fn coordinates(diagram: Diagram, (x, y): Point) -> Point {
        match diagram {
            Diagram::Cie1931 => (x, y),
            Diagram::Cie1976 => {
                let d = -2.0 * x + 12.0 * y + 3.0;
                (4.0 * x / d, 9.0 * y / d)
            }
        }
    }

    pub(super) fn place(&self, xy: Point) -> Point {
        let (a, b) = Self::coordinates(self.diagram, xy);
        (self.x.at(a), self.y.at(b))
    }

    /// The chromaticity at a place on the sheet.
    fn chromaticity(&self, (px, py): Point) -> Point {
        let back = |s: Scale, p: f64| s.low + (p - s.start) / (s.end - s.start) * (s.high - s.low);
        let (a, b) = (back(self.x, px), back(self.y, py));
        match self.diagram {
            Diagram::Cie1931 => (a, b),
            Diagram::Cie1976 => {
                let d = 6.0 * a - 16.0 * b + 12.0;
                (9.0 * a / d, 4.0 * b / d)
            }
        }
    }
}

const WAVELENGTHS: [f64; 14] =
    [520.0, 620.0, 480.0, 560.0, 540.0, 500.0, 580.0, 600.0, 460.0, 700.0, 420.0, 640.0, 490.0, 510.0];
const TEMPERATURES: [f64; 6] = [2000.0, 4000.0, f64::INFINITY, 3000.0, 6500.0, 10_000.0];
const PLANCK: Ink = Ink::grey(40);

/// The coloured area, its outline and the wavelengths along it.
pub(super) fn draw(sheet: &mut Sheet, panel: &ChromaticityPanel, map: &Map, labels: &mut Labels) {
    let outline = outline(panel, map);
    if outline.len() < 3 {
        return;
    }
    let clip = outline.clone();
    colours(sheet, map, clip, 2.5);
    let mut closed = outline.clone();
    closed.extend([outline[0], outline[1]]);
    sheet.stroke(closed.clone(), 1.6, DARK);
    labels.avoid(closed);

    let middle = map.place((1.0 / 3.0, 1.0 / 3.0));
    for nm in WAVELENGTHS {
        let (Some(at), Some(before), Some(after)) = (locus(panel, nm), locus(panel, nm - 1.0), locus(panel, nm + 1.0))
        else {
            continue;
        };
        let (at, before, after) = (map.place(at), map.place(before), map.place(after));
        let (tx, ty) = (after.0 - before.0, after.1 - before.1);
        let length = tx.hypot(ty).max(1e-9);
        let (mut nx, mut ny) = (-ty / length, tx / length);
        if nx * (at.0 - middle.0) + ny * (at.1 - middle.1) < 0.0 {
            (nx, ny) = (-nx, -ny);
        }
        let manner = Manner { size: 12.0, ink: SOFT, clearance: 6.0, towards: (nx, ny), plate: false, leader: false };
        // The minor wavelengths carry a tick only.
        let named = !matches!(nm as i32, 490 | 510 | 640);
        if !named || labels.place(sheet, at, &format!("{nm:.0}"), manner) {
            let length = if named { 6.0 } else { 4.0 };
            sheet.line(at, (at.0 + length * nx, at.1 + length * ny), 1.2, DARK);
        }
    }
}

/// Fill `clip` with the colours of its chromaticities.
pub(super) fn colours(sheet: &mut Sheet, map: &Map, clip: Vec<Point>, cell: f64) {
    let fold = |f: fn(f64, f64) -> f64, pick: fn(&Point) -> f64| clip.iter().map(pick).reduce(f).unwrap_or(0.0);
    let area =
        Rect::new(fold(f64::min, |p| p.0), fold(f64::min, |p| p.1), fold(f64::max, |p| p.0), fold(f64::max, |p| p.1));
    // The margin keeps the soft edge of an enlarged picture out of sight.
    let area = area.grown(2.0 * cell);
    sheet.ops.push(background::picture(area, cell, clip, |p| background::of_chromaticity(map.chromaticity(p))));
}

/// The spectral locus on the sheet, without its closing line.
pub(super) fn outline(panel: &ChromaticityPanel, map: &Map) -> Vec<Point> {
    let points = panel.locus.iter().map(|p| map.place((p.x, p.y)));
    let mut out: Vec<Point> = points.filter(|p| p.0.is_finite() && p.1.is_finite()).collect();
    out.dedup_by(|a, b| (a.0 - b.0).hypot(a.1 - b.1) < 0.05);
    out
}

fn locus(panel: &ChromaticityPanel, nm: f64) -> Option<Point> {
    let pair = panel.locus.windows(2).find(|w| w[0].wavelength_nm <= nm && nm <= w[1].wavelength_nm)?;
    let t = (nm - pair[0].wavelength_nm) / (pair[1].wavelength_nm - pair[0].wavelength_nm);
    let t = if t.is_finite() { t } else { 0.0 };
    Some((pair[0].x + t * (pair[1].x - pair[0].x), pair[0].y + t * (pair[1].y - pair[0].y)))
}

/// The Planckian locus with marks at a few temperatures; those within `elsewhere` are labelled there.
pub(super) fn temperatures(
    sheet: &mut Sheet,
    panel: &ChromaticityPanel,
    map: &Map,
    plot: Rect,
    labels: &mut Labels,
    elsewhere: Option<Rect>,
) {
    let planck = Planck::new(&panel.planck);
    let line = planck.line(map);
    for part in clip::line(&line, plot) {
        sheet.stroke(part.clone(), 1.6, PLANCK);
        labels.avoid(part);
    }
    for t in TEMPERATURES {
        let Some(ends) = planck.isotherm(t, 0.008).map(|(a, b)| (map.place(a), map.place(b))) else { continue };
        if !plot.contains(ends.0) || !plot.contains(ends.1) {
            continue;
        }
        sheet.line(ends.0, ends.1, 1.2, PLANCK);
        labels.avoid(vec![ends.0, ends.1]);
    }
    for t in TEMPERATURES {
        let Some((high, low)) = planck.isotherm(t, 0.008).map(|(a, b)| (map.place(a), map.place(b))) else { continue };
        let middle = ((high.0 + low.0) / 2.0, (high.1 + low.1) / 2.0);
        if !plot.contains(middle) || elsewhere.is_some_and(|r| r.contains(middle)) {
            continue;
        }
        let text = if t.is_finite() { format!("{t:.0} K") } else { "∞ K".to_owned() };
        let manner = Manner { size: 12.0, ink: DARK, clearance: 0.0, towards: (0.7, 0.8), plate: false, leader: false };
        labels.place(sheet, low, &text, manner);
    }
}

/// The Planckian locus by rising reciprocal temperature.
pub(super) struct Planck {
    /// Reciprocal megakelvins, and chromaticity.
    table: Vec<(f64, Point)>,
}

impl Planck {
    pub(super) fn new(points: &[PlanckPoint]) -> Self {
        let usable = points.iter().filter(|p| p.temperature_k > 0.0 && p.x.is_finite() && p.y.is_finite());
        let mut table: Vec<(f64, Point)> = usable.map(|p| (1e6 / p.temperature_k, (p.x, p.y))).collect();
        table.sort_by(|a, b| a.0.total_cmp(&b.0));
        table.dedup_by(|a, b| a.0 == b.0);
        Self { table }
    }

    pub(super) fn line(&self, map: &Map) -> Vec<Point> {
        self.table.iter().map(|p| map.place(p.1)).collect()
    }

    /// The ends of the isotemperature line of `t` kelvins: above and below the locus, `reach` to each side in u, v.
    pub(super) fn isotherm(&self, t: f64, reach: f64) -> Option<(Point, Point)> {
        let mired = 1e6 / t;
        let pair = self.table.windows(2).find(|w| w[0].0 <= mired && mired <= w[1].0)?;
        let part = (mired - pair[0].0) / (pair[1].0 - pair[0].0);
        let (a, b) = (to_uv(pair[0].1), to_uv(pair[1].1));
        let (u, v) = (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1));
        let (du, dv) = (b.0 - a.0, b.1 - a.1);
        let length = du.hypot(dv);
        // At right angles to the locus in the CIE 1960 diagram, where correlated colour temperature is defined.
        let (nu, nv) = (-dv / length * reach, du / length * reach);
        let ends = (to_xy((u + nu, v + nv)), to_xy((u - nu, v - nv)));
        (length > 0.0).then_some(ends)
    }

    /// Distance in u, v from a chromaticity to the nearest tabulated point.
    pub(super) fn distance(&self, xy: Point) -> f64 {
        let (u, v) = to_uv(xy);
        let each = self.table.iter().map(|p| to_uv(p.1)).map(|q| (q.0 - u).hypot(q.1 - v));
        each.fold(f64::INFINITY, f64::min)
    }
}

/// CIE 1960 u, v.
fn to_uv((x, y): Point) -> Point {
    let d = -2.0 * x + 12.0 * y + 3.0;
    (4.0 * x / d, 6.0 * y / d)
}

fn to_xy((u, v): Point) -> Point {
    let d = 2.0 * u - 8.0 * v + 4.0;
    (3.0 * u / d, 2.0 * v / d)
}
