//! Images and cameras.

use glam::DVec2;

use super::Check;
use crate::geometry::lens::Distortion;
use crate::image::{Channel, Content, Converted, Description, Memory, Plan, Settings, Source as _, Target};
use crate::photometry::luminous::Efficiency;

/// The luminance of a pixel of flat radiance, W/(m² sr nm), over 360–830 nm by 1 nm; NaN where it cannot be had.
fn luminance(radiance: f32) -> f64 {
    let channels = (360..=830).map(|nm| Channel::band(format!("{nm} nm"), "", f64::from(nm))).collect();
    let mut description = Description::planes(1, 1, channels);
    let Ok(unit) = "W/m2/sr/nm".parse() else { return f64::NAN };
    description.content = Content::Light { quantity: None, unit: Some(unit) };
    let image = Memory::new(description, vec![radiance; 471]);
    let plan = Plan::new(image.description(), &Target::Luminance(Efficiency::default()), &Settings::default());
    let Ok(plan) = plan else { return f64::NAN };
    Memory::load(&mut Converted::new(image, plan.value)).map_or(f64::NAN, |m| f64::from(m.at(0, 0, 0)))
}

pub(super) fn checks() -> Vec<Check> {
    let check =
        |case, source, expected, found, allowed| Check { area: "pictures", case, source, expected, found, allowed };
    let sum = "CIE 018: K_m Σ V, in single precision";
    // Single precision, and the tenth that the sum is printed to.
    let digits = 0.05 / 72_983.5 + f64::from(f32::EPSILON);
    let lens = Distortion { k1: -0.3, k2: 0.1, ..Distortion::default() };
    let distorted = lens.distort(DVec2::new(0.5, 0.4));
    let back = lens.undistort(distorted).map_or(f64::NAN, |p| (p - DVec2::new(0.5, 0.4)).length());
    vec![
        check("a pixel of 1 W/(m² sr nm) [cd/m²]", sum, 72_983.5, luminance(1.0), digits),
        check("a pixel of 1e-30 W/(m² sr nm) [cd/m²]", sum, 7.298_35e-26, luminance(1e-30), digits),
        check("a pixel of 1e30 W/(m² sr nm) [cd/m²]", sum, 7.298_35e34, luminance(1e30), digits),
        check("a lens of k₁ = −0.3, k₂ = 0.1: x of (0.5, 0.4)", "x (1 + k₁r² + k₂r⁴)", 0.446_905, distorted.x, 1e-15),
        check("the same lens undone: distance", "0", 0.0, back, 1e-15),
    ]
}
