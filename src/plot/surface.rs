//! The surface panel: a lobe in space, its facets shaded and drawn from back to front.

use super::axis::{self, AXIS_TEXT, MARGIN};
use super::font;
use super::sheet::{Align, DARK, FRAME, GRID, Ink, Point, Rect, SOFT, Sheet};

/// A place in space: x towards the mirror direction, z along the normal.
type Place = [f64; 3];

/// A closed lobe over a surface seen from above its side.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfacePanel {
    /// Above the drawing.
    pub title: String,
    /// Rings from the normal to the horizon; each has the same number of places around, in units of the largest radius.
    pub rings: Vec<Vec<Place>>,
    /// Which of these places were measured: a facet that has another one is drawn pale.
    pub measured: Vec<Vec<bool>>,
    /// Direction towards the light.
    pub light: Place,
    /// Below the drawing.
    pub caption: String,
}

/// Colours of a facet and of its edge, in full light.
type Tones = ([f64; 3], [f64; 3]);
const MEASURED: Tones = ([70.0, 150.0, 235.0], [40.0, 100.0, 180.0]);
const GUESSED: Tones = ([214.0, 214.0, 236.0], [170.0, 170.0, 200.0]);

/// A piece of the lobe.
struct Facet {
    corners: [Place; 4],
    /// How much light it gets from the eye's side.
    shade: f64,
    measured: bool,
}

/// Turned about the vertical by this angle, and seen from this height.
const TURN: f64 = 0.9;
const HEIGHT: f64 = 0.42;

/// Right, up and towards the eye.
fn seen([x, y, z]: Place) -> Place {
    let (sin, cos) = TURN.sin_cos();
    let (across, depth) = (x * sin + y * cos, x * cos - y * sin);
    let (up_sin, up_cos) = HEIGHT.sin_cos();
    [across, z * up_cos - depth * up_sin, z * up_sin + depth * up_cos]
}

impl SurfacePanel {
    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let top = axis::title(sheet, area, &self.title);
        let bottom = area.y1 - MARGIN - 24.0;
        let size = ((area.width() - 2.0 * MARGIN) / 2.1).min((bottom - top) / 1.65);
        let centre = ((area.x0 + area.x1) / 2.0, top + 1.13 * size);
        let place = |p: Place| -> Point { (centre.0 + size * seen(p)[0], centre.1 - size * seen(p)[1]) };
        let circle = |r: f64| -> Vec<Point> {
            (0..=72).map(|i| f64::from(5 * i).to_radians().sin_cos()).map(|(s, c)| place([r * c, r * s, 0.0])).collect()
        };
        sheet.fill(circle(1.0), Ink::grey(244));
        for r in [0.5, 1.0] {
            sheet.stroke(circle(r), 1.0, GRID);
        }
        let facets = self.facets();
        for Facet { corners, shade, measured } in facets {
            let outline: Vec<Point> = corners.iter().map(|p| place(*p)).collect();
            let tone = |full: f64| {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
                let level = (full * (0.35 + 0.65 * shade)).clamp(0.0, 255.0) as u8;
                level
            };
            let (face, edge) = if measured { MEASURED } else { GUESSED };
            sheet.fill(outline.clone(), Ink::rgb(face.map(tone)));
            let closed = outline.iter().copied().chain(outline.first().copied()).collect();
            sheet.stroke(closed, 0.4, Ink::rgb(edge.map(tone)));
        }
        let end = self.light.map(|v| 1.05 * v);
        sheet.dashed(&[place(end), place([0.0; 3])], &[7.0, 4.0], 2.0, Ink::rgb([213, 94, 0]));
        let (x, y) = place(end);
        sheet.text((x, y - 6.0), "light", AXIS_TEXT, DARK, Align::Middle);
        sheet.line(place([0.0; 3]), place([0.0, 0.0, 1.1]), 1.0, FRAME);
        let caption = font::fit(&self.caption, AXIS_TEXT, area.width() - 2.0 * MARGIN);
        sheet.text((centre.0, area.y1 - MARGIN), &caption, AXIS_TEXT, SOFT, Align::Middle);
    }

    /// The facets between neighbouring places, farthest first.
    fn facets(&self) -> Vec<Facet> {
        let mut out = Vec::new();
        for (rings, known) in self.rings.windows(2).zip(self.measured.windows(2)) {
            let around = rings[0].len().min(rings[1].len());
            for i in 0..around {
                let j = (i + 1) % around;
                let corners = [rings[0][i], rings[0][j], rings[1][j], rings[1][i]];
                let measured = known[0][i] && known[0][j] && known[1][j] && known[1][i];
                out.push(Facet { corners, shade: shade(&corners), measured });
            }
        }
        let depth = |f: &Facet| f.corners.iter().map(|p| seen(*p)[2]).sum::<f64>();
        out.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
        out
    }
}

/// Cosine between a facet and the way to the eye, 0 to 1.
fn shade(corners: &[Place; 4]) -> f64 {
    let [a, b, c, d] = corners.map(seen);
    let (u, v) = ([c[0] - a[0], c[1] - a[1], c[2] - a[2]], [d[0] - b[0], d[1] - b[1], d[2] - b[2]]);
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    if length > 0.0 { normal[2].abs() / length } else { 0.0 }
}
