//! Approximate colours for backgrounds: of chromaticities, and of hue angles.
//!
//! No display shows the colours outside its own gamut; these are hints for the eye, not data.

use super::sheet::{Op, Point, Rect};

/// Backgrounds are lightened by this much, so that dark text on them can be read.
const LIGHTEN: f64 = 0.14;

/// The lightest sRGB colour of a CIE 1931 chromaticity; outside the gamut the nearest by cutting negative parts.
pub(super) fn of_chromaticity((x, y): Point) -> [u8; 3] {
    let y = y.max(1e-4);
    let (big_x, big_z) = (x / y, (1.0 - x - y) / y);
    // XYZ (D65) to linear sRGB, IEC 61966-2-1.
    let linear = [
        3.2406 * big_x - 1.5372 - 0.4986 * big_z,
        -0.9689 * big_x + 1.8758 + 0.0415 * big_z,
        0.0557 * big_x - 0.2040 + 1.0570 * big_z,
    ];
    // A soft cut at zero and a soft maximum: hard ones would draw lines into the diagram that mean nothing.
    let most = linear.iter().copied().fold(1e-9, f64::max);
    let cut = linear.map(|v| v / most).map(|v| (v + v.hypot(0.16)) / 2.0);
    let most = cut.iter().map(|v| v.powi(6)).sum::<f64>().powf(1.0 / 6.0);
    encoded(cut.map(|v| v / most), LIGHTEN)
}

/// A colour of medium lightness for a hue angle of the a′b′ plane in radians, `strength` from 0 (grey) to 1.
///
/// The hue circle of Oklab (Ottosson 2020) is close enough to that of CAM02-UCS for a label.
pub(super) fn of_hue(angle: f64, lightness: f64, strength: f64) -> [u8; 3] {
    let chroma = 0.135 * strength;
    let (a, b) = (chroma * angle.cos(), chroma * angle.sin());
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ];
    encoded(linear, 0.0)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte")]
fn encoded(linear: [f64; 3], lighten: f64) -> [u8; 3] {
    linear.map(|v| {
        let v = v.clamp(0.0, 1.0);
        let v = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        (255.0 * (v + lighten * (1.0 - v))).round() as u8
    })
}

/// A picture over `area`, one cell for about `cell` pixels, of the colour at each place, seen within `clip`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred cells")]
pub(super) fn picture(area: Rect, cell: f64, clip: Vec<Point>, colour: impl Fn(Point) -> [u8; 3]) -> Op {
    let count = |length: f64| (length / cell).ceil().clamp(2.0, 400.0) as u32;
    let (columns, rows) = (count(area.width()), count(area.height()));
    let mut pixels = Vec::with_capacity(3 * columns as usize * rows as usize);
    for j in 0..rows {
        for i in 0..columns {
            let x = area.x0 + (f64::from(i) + 0.5) / f64::from(columns) * area.width();
            let y = area.y0 + (f64::from(j) + 0.5) / f64::from(rows) * area.height();
            pixels.extend(colour((x, y)));
        }
    }
    Op::Image { area, columns, rows, pixels, clip }
}
