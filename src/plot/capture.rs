//! From photographs and what they measured to panels: a response curve, coverage, lobes against data, pictures beside a model.

use std::f64::consts::FRAC_PI_2;

use super::brdf::Tint;
use super::{ColourMap, ColourRange, CurvesPanel, DotsPanel, FalseColourPanel, Kind, NamedCurve, RasterPanel, Series};
use crate::brdf::Brdf;
use crate::brdf::coordinates::HalfDiff;
use crate::brdf::table::Known;
use crate::capture::brdf::{Binned, Filled, Maps};
use crate::capture::response::Curve;

/// Rows of θ_d whose lobes are drawn at most.
const MOST_LOBES: usize = 5;
/// Dots of a row at most.
const MOST_DOTS: usize = 120;
/// Cosine of 88°: models that grow without bound towards the horizon would fill the axis.
const GRAZING: f64 = 0.034_899_496_702_500_97;
/// Part of the pixels of a picture that are brighter than its white.
const GLARE: f64 = 0.01;

/// Exposure over code, with twice its standard error as dashes.
#[must_use]
pub fn response_panel(curves: &[Curve], names: &[String]) -> CurvesPanel {
    let one = |(curve, name): (&Curve, &String)| {
        let at = |by: f64| {
            let point = move |z: usize| (z as f64, (curve.ln_g[z] + by * curve.standard_error(z as f64)).exp());
            (0..curve.ln_g.len()).map(point)
        };
        let gap = [(f64::NAN, f64::NAN)];
        let dashed = if curve.covariance.is_some() { at(-2.0).chain(gap).chain(at(2.0)).collect() } else { Vec::new() };
        NamedCurve { name: name.clone(), points: at(0.0).collect(), dashed }
    };
    CurvesPanel {
        title: "response".to_owned(),
        x_label: "code".to_owned(),
        x_step: Some(32.0),
        y_label: "exposure, code 128 is 1".to_owned(),
        curves: curves.iter().zip(names).map(one).collect(),
        logarithmic: true,
        level: None,
        dashes: "2 standard errors".to_owned(),
    }
}

/// Colour of bins that were filled: in no map.
const INFERRED: [u8; 3] = [235, 120, 60];

/// Part of the bins in φ_d that is measured, over θ_h (to the right, as its root, 0° to 90°) and θ_d (upwards, 0° to 90°); of a colour of its own
/// where nothing was measured and bins were filled.
#[must_use]
pub fn coverage_panel(binned: &Binned, filled: Option<&Filled>) -> FalseColourPanel {
    let r = binned.resolution;
    let place = |bin: usize| (r.theta_d - 1 - bin / r.phi_d % r.theta_d) * r.theta_h + bin / (r.theta_d * r.phi_d);
    let (mut measured, mut possible) = (vec![0.0_f32; r.theta_h * r.theta_d], vec![0.0_f32; r.theta_h * r.theta_d]);
    for bin in 0..r.bins() {
        let (i, o) = r.centre(bin).directions();
        possible[place(bin)] += f32::from(u8::from(i.z > 0.0 && o.z > 0.0));
    }
    binned.bins.iter().for_each(|b| measured[place(b.bin)] += 1.0);
    let share = |(m, p): (&f32, &f32)| if *p > 0.0 { (m / p).min(1.0) } else { f32::NAN };
    let mut values: Vec<f32> = measured.iter().zip(&possible).map(share).collect();
    let known = filled.map_or(&[][..], |f| &f.known);
    for (bin, _) in known.iter().enumerate().filter(|(_, k)| **k == Known::Inferred) {
        if measured[place(bin)] == 0.0 {
            values[place(bin)] = -1.0;
        }
    }
    FalseColourPanel {
        title: "coverage".to_owned(),
        figures: "θh to the right, as √θh, θd upwards, both 0° to 90°".to_owned(),
        columns: r.theta_h,
        rows: r.theta_d,
        values,
        unit: "of φd".to_owned(),
        range: ColourRange { low: 0.0, high: 1.0, logarithmic: false },
        map: ColourMap::Viridis,
        levels: Vec::new(),
        below: filled.map(|_| Kind { name: "inferred".to_owned(), colour: INFERRED }),
    }
}

/// Measured bins across the plane of incidence (φ_d near 90°, where light and camera are alike) over θ_h as dots, the model as lines: one for each
/// of a few θ_d, those with most bins.
#[must_use]
pub fn halves_panel(binned: &Binned, brdf: &dyn Brdf, band: usize, name: &str) -> DotsPanel {
    let r = binned.resolution;
    let across = |phi_d: f64| (phi_d - FRAC_PI_2).abs() < 10.0_f64.to_radians();
    let mut rows: Vec<(usize, Vec<(f64, f64)>)> = (0..r.theta_d).map(|d| (d, Vec::new())).collect();
    for bin in &binned.bins {
        let at = r.centre(bin.bin);
        if across(at.phi_d) {
            rows[bin.bin / r.phi_d % r.theta_d].1.push((at.theta_h.to_degrees(), bin.values[band]));
        }
    }
    // Those with most bins that are apart from one another.
    rows.sort_by_key(|row| std::cmp::Reverse(row.1.len()));
    let mut chosen: Vec<(usize, Vec<(f64, f64)>)> = Vec::new();
    for row in rows.into_iter().filter(|row| !row.1.is_empty()) {
        let apart = chosen.iter().all(|c| c.0.abs_diff(row.0) * 90 >= 6 * r.theta_d);
        if apart && chosen.len() < MOST_LOBES {
            chosen.push(row);
        }
    }
    chosen.sort_by_key(|row| row.0);
    let mut f = vec![0.0; brdf.bands()];
    let mut series = |(d, mut dots): (usize, Vec<(f64, f64)>)| {
        dots.sort_by(|a, b| a.0.total_cmp(&b.0));
        let dots = dots.iter().step_by(dots.len().div_ceil(MOST_DOTS)).copied().collect();
        let theta_d = (d as f64 + 0.5) / r.theta_d as f64 * FRAC_PI_2;
        let mut line = Vec::new();
        for n in 0..=360 {
            let theta_h = 0.25 * f64::from(n);
            let half = HalfDiff { theta_h: theta_h.to_radians(), phi_h: 0.0, theta_d, phi_d: FRAC_PI_2 };
            let (i, o) = half.directions();
            if i.z.min(o.z) > GRAZING {
                brdf.evaluate(i, o, &mut f);
                line.push((theta_h, f[band]));
            }
        }
        Series { name: format!("θd = {:.0}°", theta_d.to_degrees()), dots, line }
    };
    DotsPanel {
        title: format!("lobes, {name}"),
        x_label: "θh [°]".to_owned(),
        y_label: "BRDF [1/sr], dots: bins, lines: model".to_owned(),
        both_logarithmic: false,
        series: chosen.into_iter().map(&mut series).collect(),
    }
}

/// A picture, the same by the model with the same white, and their difference.
#[must_use]
pub fn maps_panels(maps: &Maps, tint: &Tint, bands: usize) -> (RasterPanel, RasterPanel, FalseColourPanel) {
    let mut bright: Vec<f64> = maps.modelled.iter().copied().filter(|v| *v > 0.0).collect();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a length")]
    let white = (bright.len() as f64 * (1.0 - GLARE)) as usize;
    let exposure = if bright.is_empty() { 1.0 } else { 1.0 / *bright.select_nth_unstable_by(white, f64::total_cmp).1 };
    let raster = |title: &str, values: &[f64]| RasterPanel {
        title: title.to_owned(),
        side: u32::try_from(maps.side).unwrap_or(0),
        pixels: values.chunks_exact(bands).flat_map(|v| tint.pixel(v, exposure)).collect(),
        caption: String::new(),
    };
    // Four times the median holds most residuals; a fixed range would hide small ones or clip large ones.
    let reach = maps.spread().map_or(1.0, |(median, _)| (400.0 * median).clamp(0.1, 100.0));
    let difference = FalseColourPanel {
        title: "difference".to_owned(),
        figures: "measured over modelled less 1, mean of the bands".to_owned(),
        columns: maps.side,
        rows: maps.side,
        values: maps.residual.iter().map(|r| 100.0 * r).collect(),
        unit: "%".to_owned(),
        range: ColourRange { low: -reach, high: reach, logarithmic: false },
        map: ColourMap::Viridis,
        levels: Vec::new(),
        below: None,
    };
    (raster("photograph", &maps.measured), raster("model", &maps.modelled), difference)
}
