//! The enlarged part of a chromaticity diagram around points near the Planckian locus.

use super::axis::{Scale, TICK_TEXT};
use super::chromaticity::{self, ChromaticityPanel};
use super::clip;
use super::horseshoe::{self, Map, Planck};
use super::labels::{Labels, Manner};
use super::sheet::{Align, DARK, FRAME, Ink, Point, Rect, SOFT, Sheet, WHITE};

/// Points this near to the Planckian locus in u, v are white lights.
const NEAR: f64 = 0.03;
/// Smallest side of the enlarged part in units of the diagram.
const SIDE: f64 = 0.055;
/// Enlarging less than this is not worth the room.
const LEAST: f64 = 1.8;
const LINE: Ink = Ink::grey(70);
/// In the order in which they claim their place.
const TEMPERATURES: [f64; 16] = [
    4000.0,
    3000.0,
    6500.0,
    5000.0,
    2700.0,
    2000.0,
    10_000.0,
    3500.0,
    8000.0,
    2200.0,
    20_000.0,
    1500.0,
    4500.0,
    5700.0,
    1000.0,
    f64::INFINITY,
];

/// Least and largest diagram coordinates around the points near the Planckian locus.
pub(super) fn window(panel: &ChromaticityPanel) -> Option<(Point, Point)> {
    let planck = Planck::new(&panel.planck);
    let near = panel.points.iter().map(|p| (p.x, p.y)).filter(|&p| planck.distance(p) < NEAR);
    let places = near.map(|p| Map::coordinates(panel.diagram, p));
    let (low, high) = places.fold(None, |found: Option<(Point, Point)>, p| {
        let (low, high) = found.unwrap_or((p, p));
        Some(((low.0.min(p.0), low.1.min(p.1)), (high.0.max(p.0), high.1.max(p.1))))
    })?;
    let (width, height) = ((high.0 - low.0) * 1.4 + 0.02, (high.1 - low.1) * 1.4 + 0.02);
    let half = width.max(height).max(SIDE) / 2.0;
    let (x, y) = ((low.0 + high.0) / 2.0, (low.1 + high.1) / 2.0);
    Some(((x - half, y - half), (x + half, y + half)))
}

/// An enlarged part and its place.
#[derive(Debug)]
pub(super) struct Inset {
    /// Heading and frame.
    pub room: Rect,
    /// What it shows, in the whole diagram.
    pub outline: Rect,
    frame: Rect,
    map: Map,
    times: f64,
}

impl Inset {
    /// Show `window` in `room` at equal scales; none where that would enlarge too little.
    pub(super) fn new((low, high): (Point, Point), room: Rect, whole: &Map) -> Option<Self> {
        let frame = Rect::new(room.x0, room.y0 + 20.0, room.x1, room.y1);
        if frame.width() < 120.0 || frame.height() < 100.0 {
            return None;
        }
        let per_pixel = ((high.0 - low.0) / frame.width()).max((high.1 - low.1) / frame.height());
        let (half_x, half_y) = (frame.width() * per_pixel / 2.0, frame.height() * per_pixel / 2.0);
        let (x, y) = ((low.0 + high.0) / 2.0, (low.1 + high.1) / 2.0);
        let map = Map {
            diagram: whole.diagram,
            x: Scale::new(x - half_x, x + half_x, frame.x0, frame.x1),
            y: Scale::new(y - half_y, y + half_y, frame.y1, frame.y0),
        };
        let times = map.x.density() / whole.x.density();
        let ((x0, x1), (y0, y1)) = ((map.x.low, map.x.high), (map.y.high, map.y.low));
        let outline = Rect::new(whole.x.at(x0), whole.y.at(y0), whole.x.at(x1), whole.y.at(y1));
        (times >= LEAST).then_some(Self { room, outline, frame, map, times })
    }

    /// Draw the enlarged part, and its outline in the whole diagram; gives the number of points left without a label.
    pub(super) fn draw(&self, sheet: &mut Sheet, panel: &ChromaticityPanel) -> usize {
        let heading = format!("enlarged {:.1} ×", self.times);
        sheet.text((self.room.x0, self.room.y0 + TICK_TEXT), &heading, TICK_TEXT, SOFT, Align::Start);
        sheet.fill(self.frame.corners().to_vec(), WHITE);
        let visible = clip::polygon(&horseshoe::outline(panel, &self.map), self.frame);
        if visible.len() > 2 {
            horseshoe::colours(sheet, &self.map, visible, 5.0);
        }
        let mut labels = Labels::new(self.frame.grown(-3.0));
        self.locus(sheet, panel, &mut labels);
        chromaticity::regions(sheet, panel, &self.map, self.frame);
        let silent = self.points(sheet, panel, &mut labels);
        sheet.frame(self.frame, 1.2, FRAME);
        sheet.frame(self.outline, 1.0, DARK);
        silent
    }

    /// Planckian locus and isotemperature lines, as many as stand well apart.
    fn locus(&self, sheet: &mut Sheet, panel: &ChromaticityPanel, labels: &mut Labels) {
        let planck = Planck::new(&panel.planck);
        // About half as long as the frame is high; v is two thirds of v′.
        let reach = 0.17 * (self.map.y.high - self.map.y.low);
        let mut lines: Vec<(f64, Point, Point)> = Vec::new();
        let inner = self.frame.grown(-14.0);
        for t in TEMPERATURES {
            let Some((above, below)) = planck.isotherm(t, reach) else { continue };
            let (above, below) = (self.map.place(above), self.map.place(below));
            let middle = ((above.0 + below.0) / 2.0, (above.1 + below.1) / 2.0);
            let apart = |l: &(f64, Point, Point)| (l.2.0 - below.0).hypot(l.2.1 - below.1) > 26.0;
            let room = inner.contains(above) || inner.contains(below);
            if room && self.frame.grown(-4.0).contains(middle) && lines.iter().all(apart) {
                lines.push((t, above, below));
            }
        }
        for part in clip::line(&planck.line(&self.map), self.frame) {
            sheet.stroke(part.clone(), 2.0, DARK);
            labels.avoid(part);
        }
        for &(_, above, below) in &lines {
            for part in clip::line(&[above, below], self.frame) {
                sheet.stroke(part.clone(), 1.0, LINE);
                labels.avoid(part);
            }
        }
        for point in &panel.points {
            labels.block(chromaticity::around(self.map.place((point.x, point.y))));
        }
        for (t, above, below) in lines {
            let text = if t.is_finite() { format!("{t:.0} K") } else { "∞ K".to_owned() };
            for (end, other) in [(below, above), (above, below)] {
                let towards = (end.0 - other.0, end.1 - other.1);
                let manner = Manner { size: 12.0, ink: SOFT, clearance: 0.0, towards, plate: false, leader: false };
                if self.frame.grown(-2.0).contains(end) && labels.place(sheet, end, &text, manner) {
                    break;
                }
            }
        }
    }

    fn points(&self, sheet: &mut Sheet, panel: &ChromaticityPanel, labels: &mut Labels) -> usize {
        let inner = self.frame.grown(-4.0);
        let places = panel.points.iter().map(|p| (self.map.place((p.x, p.y)), p));
        let inside: Vec<_> = places.filter(|(at, _)| inner.contains(*at)).collect();
        for (at, point) in &inside {
            chromaticity::mark(sheet, *at, point.reference);
        }
        let manner = chromaticity::manner(inside.len());
        let named = inside.into_iter().filter(|(_, p)| !p.name.is_empty());
        named.filter(|(at, point)| !labels.place(sheet, *at, &point.name, manner)).count()
    }
}
