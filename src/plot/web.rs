//! The intensity solid of a luminaire: every direction at a distance that is its intensity, seen from outside.

use super::axis::{self, MARGIN};
use super::font;
use super::png::mix;
use super::sheet::{Align, DARK, FRAME, Ink, Op, Point, Rect, SOFT, Sheet, clean};

/// The surface over a grid of directions, drawn in parallel projection from a little above, between C0 and C90.
///
/// Patches that look away are left out and the others are painted from the back; each is as bright as its slope to the light
/// from the upper left makes it. Negative values count as zero.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WebPanel {
    /// Above the drawing; may be empty.
    pub title: String,
    /// Azimuths, degrees, ascending from 0 to 360: 0 is towards C0 (H), 90 towards C90 (V).
    pub azimuth_deg: Vec<f64>,
    /// Angles from the axis, degrees, ascending within 0 to 180.
    pub gamma_deg: Vec<f64>,
    /// Azimuth by azimuth: `values[azimuth * gamma_deg.len() + gamma]`.
    pub values: Vec<f64>,
    /// Lines of the web run along γ at whole multiples of this, degrees, and each 15° about the axis.
    pub web_step_deg: f64,
    /// Value of the ring in the horizontal plane, such as the maximum.
    pub ring: f64,
    /// What the ring stands for, below the drawing, such as `ring: 5161 cd (maximum)`.
    pub note: String,
    /// Names at the axes towards azimuth 0 and 90, and at the photometric axis.
    pub axes: [String; 3],
}

type Vec3 = [f64; 3];

/// Where one looks from: azimuth and height, degrees.
const VIEW: (f64, f64) = (32.0, 22.0);
/// Towards the light that shades the solid: left, up, and towards the viewer.
const LIGHT: Vec3 = [-0.45, 0.55, 0.70];
const DULL: [u8; 3] = [120, 104, 70];
const BRIGHT: [u8; 3] = [255, 236, 178];
const EDGE: Ink = Ink::rgb([104, 84, 40]);
const TEXT: f64 = 13.0;

/// Something to paint, with its distance to the viewer (larger is nearer).
struct Item {
    depth: f64,
    ops: Vec<Op>,
}

/// From the luminaire's frame to right, up and towards the viewer.
struct Eye {
    right: Vec3,
    up: Vec3,
    near: Vec3,
}

impl Eye {
    fn new() -> Self {
        let ((sa, ca), (sh, ch)) = (VIEW.0.to_radians().sin_cos(), VIEW.1.to_radians().sin_cos());
        Self { right: [-sa, ca, 0.0], up: [-ca * sh, -sa * sh, ch], near: [ca * ch, sa * ch, sh] }
    }

    fn see(&self, p: Vec3) -> Vec3 {
        [dot(self.right, p), dot(self.up, p), dot(self.near, p)]
    }
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn direction(azimuth_deg: f64, gamma_deg: f64) -> Vec3 {
    let ((sc, cc), (sg, cg)) = (azimuth_deg.to_radians().sin_cos(), gamma_deg.to_radians().sin_cos());
    [sg * cc, sg * sc, -cg]
}

fn times(p: Vec3, factor: f64) -> Vec3 {
    p.map(|v| factor * v)
}

impl WebPanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let room = Rect::new(area.x0 + MARGIN, top, area.x1 - MARGIN, area.y1 - MARGIN - 1.8 * TEXT);
        let whole = self.values.len() == self.azimuth_deg.len() * self.gamma_deg.len();
        let ring = self.ring;
        if !whole || !ring.is_finite() || ring <= 0.0 || room.width() < 40.0 || room.height() < 40.0 {
            return;
        }
        let eye = Eye::new();
        let seen: Vec<Vec3> = self.points().into_iter().map(|p| eye.see(p)).collect();
        let lines = self.lines();
        let scale =
            Fit::new(room, seen.iter().copied().chain(lines.iter().flat_map(|l| l.points.iter().map(|p| eye.see(*p)))));

        let mut items = self.patches(&seen, &scale);
        for line in &lines {
            for pair in line.points.windows(2) {
                let (a, b) = (eye.see(pair[0]), eye.see(pair[1]));
                let op = Op::Stroke { points: vec![scale.at(a), scale.at(b)], width: line.width, ink: line.ink };
                items.push(Item { depth: 0.5 * (a[2] + b[2]), ops: vec![op] });
            }
        }
        items.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        sheet.ops.extend(items.into_iter().flat_map(|i| i.ops));

        for (name, tip) in self.axes.iter().zip(self.tips()) {
            let tip = scale.at(eye.see(tip));
            let (w, gap) = (font::width(name, TEXT) / 2.0, 6.0);
            let from = scale.at([0.0; 3]);
            let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
            let length = dx.hypot(dy).max(1e-9);
            let at = (tip.0 + dx / length * (w + gap), tip.1 + dy / length * (0.5 * TEXT + gap) + 0.36 * TEXT);
            sheet.text(at, name, TEXT, DARK, Align::Middle);
        }
        let note = font::fit(&clean(&self.note), TEXT, area.width() - 2.0 * MARGIN);
        sheet.text(((area.x0 + area.x1) / 2.0, area.y1 - MARGIN), &note, TEXT, SOFT, Align::Middle);
    }

    /// Places on the solid in units of the ring.
    fn points(&self) -> Vec<Vec3> {
        let n = self.gamma_deg.len();
        let place = |(i, v): (usize, &f64)| {
            let part = if v.is_finite() { v.max(0.0) / self.ring } else { 0.0 };
            times(direction(self.azimuth_deg[i / n], self.gamma_deg[i % n]), part)
        };
        self.values.iter().enumerate().map(place).collect()
    }

    /// The patches that look at the viewer, with the lines of the web on their edges.
    fn patches(&self, seen: &[Vec3], scale: &Fit) -> Vec<Item> {
        let n = self.gamma_deg.len();
        let mut out = Vec::new();
        for (i, azimuths) in self.azimuth_deg.windows(2).enumerate() {
            for (j, gammas) in self.gamma_deg.windows(2).enumerate() {
                let corners = [i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1].map(|k| seen[k]);
                // Half the cross product of the diagonals: area and outward normal.
                let (p, q) = (minus(corners[2], corners[0]), minus(corners[3], corners[1]));
                let normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
                let length = dot(normal, normal).sqrt();
                if normal[2] <= 1e-9 * length || length < 1e-12 {
                    continue;
                }
                // Half the light comes from everywhere, so that what looks away from the lamp is shaped too.
                let facing = dot(normal, LIGHT) / length / dot(LIGHT, LIGHT).sqrt();
                let shade = (0.5 + 0.5 * facing).clamp(0.0, 1.0);
                let colour = Ink::rgb(mix(DULL, BRIGHT, shade));
                let flat = corners.map(|c| scale.at(c));
                let mut ops = vec![Op::Fill { points: grown(flat), ink: colour }];
                let main = |angle: f64, step: f64| (angle / step - (angle / step).round()).abs() < 1e-6;
                let edges = [
                    (main(azimuths[0], 15.0), [flat[0], flat[3]]),
                    (main(azimuths[1], 15.0), [flat[1], flat[2]]),
                    (main(gammas[0], self.web_step_deg), [flat[0], flat[1]]),
                    (main(gammas[1], self.web_step_deg), [flat[3], flat[2]]),
                ];
                for (_, ends) in edges.into_iter().filter(|e| e.0) {
                    ops.push(Op::Stroke { points: ends.to_vec(), width: 0.9, ink: EDGE });
                }
                let depth = corners.iter().map(|c| c[2]).sum::<f64>() / 4.0;
                out.push(Item { depth, ops });
            }
        }
        out
    }

    /// Ends of the three axes, a little beyond the ring and the solid.
    fn tips(&self) -> [Vec3; 3] {
        let low = self.points().into_iter().map(|p| -p[2]).fold(0.0, f64::max);
        [[1.2, 0.0, 0.0], [0.0, 1.2, 0.0], [0.0, 0.0, -(low + 0.15).max(0.4)]]
    }

    /// Axes and the ring in the horizontal plane, cut short so that the solid can hide parts of them.
    fn lines(&self) -> Vec<Line> {
        let pieces = |from: Vec3, to: Vec3| -> Vec<Vec3> {
            (0..=60).map(|i| f64::from(i) / 60.0).map(|t| [0, 1, 2].map(|k| from[k] + t * (to[k] - from[k]))).collect()
        };
        let ring = (0..=120).map(|i| direction(3.0 * f64::from(i), 90.0)).collect();
        let mut out = vec![Line { points: ring, width: 1.0, ink: Ink::grey(150) }];
        for tip in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            out.push(Line { points: pieces(times(tip, -1.0), [0.0; 3]), width: 1.0, ink: Ink::grey(150) });
        }
        for tip in self.tips() {
            out.push(Line { points: pieces([0.0; 3], tip), width: 1.4, ink: FRAME });
        }
        out
    }
}

struct Line {
    points: Vec<Vec3>,
    width: f64,
    ink: Ink,
}

fn minus(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A patch a little larger than it is, so that no white shows between neighbours.
fn grown(flat: [Point; 4]) -> Vec<Point> {
    let middle = (flat.iter().map(|p| p.0).sum::<f64>() / 4.0, flat.iter().map(|p| p.1).sum::<f64>() / 4.0);
    let out = |p: Point| {
        let (dx, dy) = (p.0 - middle.0, p.1 - middle.1);
        let length = dx.hypot(dy);
        let factor = if length > 0.0 { 1.0 + 0.5 / length.max(0.5) } else { 1.0 };
        (middle.0 + factor * dx, middle.1 + factor * dy)
    };
    flat.map(out).to_vec()
}

/// From seen places to the sheet, everything inside the room but the words at the tips.
struct Fit {
    scale: f64,
    offset: Point,
}

impl Fit {
    fn new(room: Rect, seen: impl Iterator<Item = Vec3>) -> Self {
        let mut bounds = Rect::new(f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
        for p in seen {
            bounds = Rect::new(bounds.x0.min(p[0]), bounds.y0.min(-p[1]), bounds.x1.max(p[0]), bounds.y1.max(-p[1]));
        }
        let room = Rect::new(room.x0 + 44.0, room.y0 + 14.0, room.x1 - 44.0, room.y1 - 20.0);
        let scale = (room.width() / bounds.width()).min(room.height() / bounds.height());
        let offset = (
            (room.x0 + room.x1) / 2.0 - scale * (bounds.x0 + bounds.x1) / 2.0,
            (room.y0 + room.y1) / 2.0 - scale * (bounds.y0 + bounds.y1) / 2.0,
        );
        Self { scale, offset }
    }

    fn at(&self, p: Vec3) -> Point {
        (self.offset.0 + self.scale * p[0], self.offset.1 - self.scale * p[1])
    }
}
