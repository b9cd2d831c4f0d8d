//! Intensity over an angle from the axis, what the polar and the Cartesian diagram share: curves, their look, their legend.

use super::axis::MARGIN;
use super::font;
use super::sheet::{Align, DARK, Ink, Point, Rect, SOFT, Sheet, clean};

/// Intensity in one plane through the axis; between entries the intensity is linear in the angle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AngularCurve {
    /// For the legend, such as `C0–C180`.
    pub name: String,
    /// Signed angle from the axis, degrees, ascending (equal neighbours make a step): positive angles are drawn on the right.
    pub angles_deg: Vec<f64>,
    /// One value for each angle, in the unit of the panel.
    pub values: Vec<f64>,
}

impl AngularCurve {
    pub(super) fn samples(&self) -> impl Iterator<Item = (f64, f64)> {
        self.angles_deg.iter().copied().zip(self.values.iter().copied()).filter(|s| s.0.is_finite() && s.1.is_finite())
    }
}

/// Curves in one diagram that stay apart in grey print, each having its own dashes.
pub const MOST_ANGULAR_CURVES: usize = 6;

/// Colour and dashes by the place of the curve: the first plane solid and the second dashed, as makers draw C0/C180 and C90/C270.
/// The colours are told apart with any colour vision (after Okabe and Ito 2008, darkened for white paper).
const STYLES: [(Ink, &[f64]); MOST_ANGULAR_CURVES] = [
    (Ink::rgb([0, 84, 150]), &[]),
    (Ink::rgb([200, 70, 0]), &[9.0, 4.5]),
    (Ink::rgb([0, 122, 88]), &[2.5, 3.0]),
    (Ink::rgb([150, 40, 110]), &[12.0, 3.5, 2.5, 3.5]),
    (Ink::rgb([30, 30, 30]), &[20.0, 5.0]),
    (Ink::rgb([120, 84, 20]), &[9.0, 3.0, 2.5, 3.0, 2.5, 3.0]),
];
const WIDTH: f64 = 2.2;
const LEGEND_TEXT: f64 = 13.0;
/// Length of a line in the legend, long enough to show two periods of its dashes.
const SAMPLE: f64 = 40.0;

/// Draws the curve at `index` through points of the sheet.
pub(super) fn trace(sheet: &mut Sheet, index: usize, points: &[Point]) {
    let (ink, dashes) = STYLES[index % STYLES.len()];
    match dashes {
        [] => sheet.stroke(points.to_vec(), WIDTH, ink),
        pattern => sheet.dashed(points, pattern, WIDTH, ink),
    }
}

pub(super) fn ink(index: usize) -> Ink {
    STYLES[index % STYLES.len()].0
}

/// The curves' names and the unit below `top`, in as many rows as they need; gives the y below.
pub(super) fn legend(sheet: &mut Sheet, area: Rect, top: f64, names: &[&str], unit: &str) -> f64 {
    let (left, right) = (area.x0 + MARGIN, area.x1 - MARGIN);
    let step = 1.5 * LEGEND_TEXT;
    let unit = clean(unit);
    let taken = sheet.text((right, top + LEGEND_TEXT), &unit, LEGEND_TEXT, SOFT, Align::End);
    let (mut x, mut y) = (left, top);
    for (i, name) in names.iter().enumerate() {
        let room = right - left - SAMPLE - 8.0 - if y == top { taken.width() + 16.0 } else { 0.0 };
        let name = font::fit(&clean(name), LEGEND_TEXT, room);
        let width = SAMPLE + 8.0 + font::width(&name, LEGEND_TEXT);
        let end = if y == top { taken.x0 - 16.0 } else { right };
        if x > left && x + width > end {
            (x, y) = (left, y + step);
        }
        let middle = y + 0.62 * LEGEND_TEXT;
        trace(sheet, i, &[(x, middle), (x + SAMPLE, middle)]);
        sheet.text((x + SAMPLE + 8.0, y + LEGEND_TEXT), &name, LEGEND_TEXT, DARK, Align::Start);
        x += width + 22.0;
    }
    y + step + 4.0
}

/// Steps that divide a half circle into parts people use.
const ANGLE_STEPS: [f64; 7] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0];

/// The least usual step of an angular scale that leaves at most `most` parts of `span_deg`.
pub(super) fn angle_step(span_deg: f64, most: f64) -> f64 {
    ANGLE_STEPS.into_iter().find(|s| span_deg / s <= most + 1e-9).unwrap_or(90.0)
}

/// `−30°`
pub(super) fn degrees(angle: f64) -> String {
    format!("{}°", super::axis::number(angle, 0))
}
