//! Colour.

use super::Check;
use crate::colorimetry::chromaticity::xy;
use crate::colorimetry::difference::{ciede2000, lab};
use crate::colorimetry::rgb::Encoding;

pub(super) fn checks() -> Vec<Check> {
    let check =
        |case, source, expected, found, allowed| Check { area: "colour", case, source, expected, found, allowed };
    let x = |scale: f64| xy([0.5 * scale, scale, 1.25 * scale]).map_or(f64::NAN, |xy| xy[0]);
    let white = [0.95, 1.0, 1.09];
    let lightness = |scale: f64| lab(white.map(|w| scale * w), white)[0];
    let ratio = "X/(X + Y + Z)";
    let cie_lab = "CIE 15, 50 digits";
    let grey = [50.0, 0.0, 0.0];
    vec![
        check("XYZ of 1e-300: x", ratio, 0.5 / 2.75, x(1e-300), 1e-15),
        check("XYZ of 1e306: x", ratio, 0.5 / 2.75, x(1e306), 1e-15),
        // 116 f − 16 cancels at the dark end.
        check("Y/Y_n = 1e-9: L*", cie_lab, 9.032_962_962_962_964e-7, lightness(1e-9), 1e-8),
        check("Y/Y_n = 1: L*", cie_lab, 100.0, lightness(1.0), 1e-15),
        check("Y/Y_n = 1e12: L*", cie_lab, 1_159_984.0, lightness(1e12), 1e-14),
        check("CIEDE2000 of a colour and itself", "0", 0.0, ciede2000(grey, grey), 0.0),
        check(
            "CIEDE2000 of L* 50 and 50 + 2⁻³⁰",
            "S_L = 1",
            2_f64.powi(-30),
            ciede2000(grey, [50.0 + 2_f64.powi(-30), 0.0, 0.0]),
            1e-14,
        ),
        check("sRGB of 1e-300", "IEC 61966-2-1", 12.92e-300, Encoding::Srgb.encode(1e-300), 1e-15),
        check("sRGB of 1e9", "IEC 61966-2-1, 50 digits", 5_932.645_980_758_183, Encoding::Srgb.encode(1e9), 1e-14),
    ]
}
