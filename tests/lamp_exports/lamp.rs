//! Lamps to export, directions to look from, and how fast intensity changes with direction.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use photopic::luminaire::{Body, Distribution, LampSet, Luminaire, Shape, Symmetry, System};

/// An intensity without any symmetry, smooth over the sphere, cd.
pub fn formula(c_deg: f64, gamma_deg: f64) -> f64 {
    let ((sc, cc), (sg, cg)) = (c_deg.to_radians().sin_cos(), gamma_deg.to_radians().sin_cos());
    500.0 + 300.0 * cg + sg * (200.0 * cc + 120.0 * sc + 160.0 * sc * cc * sg)
}

pub fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
    (0..=((to - from) / step).round() as usize).map(|i| from + step * i as f64).collect()
}

pub fn table(symmetry: Symmetry, planes: Vec<f64>, gamma: Vec<f64>) -> Distribution {
    let values = planes.iter().flat_map(|c| gamma.iter().map(|g| formula(*c, *g))).collect();
    Distribution::new(System::TypeC, symmetry, planes, gamma, values).expect("a table")
}

/// Tables of Type C: every symmetry, and tables that end early or have uneven angles.
pub fn tables() -> Vec<Distribution> {
    let whole = || steps(0.0, 180.0, 5.0);
    vec![
        table(Symmetry::None, steps(0.0, 360.0, 15.0), whole()),
        table(Symmetry::Quadrant, steps(0.0, 90.0, 22.5), whole()),
        table(Symmetry::BilateralC0, steps(0.0, 180.0, 15.0), whole()),
        table(Symmetry::BilateralC90, steps(90.0, 270.0, 15.0), whole()),
        table(Symmetry::Rotational, vec![0.0], whole()),
        table(Symmetry::None, vec![0.0, 10.0, 100.0, 250.5, 360.0], vec![0.0, 7.0, 33.0, 61.5, 75.0]),
        table(Symmetry::None, steps(0.0, 360.0, 30.0), steps(110.0, 180.0, 10.0)),
    ]
}

/// A table of Type B of a smooth intensity that changes by at most |(200, 120, 300)| cd per radian.
pub fn type_b() -> Distribution {
    let angles = steps(-90.0, 90.0, 5.0);
    let f = |h: f64, v: f64| {
        let ((sh, ch), (sv, cv)) = (h.to_radians().sin_cos(), v.to_radians().sin_cos());
        400.0 + 200.0 * sh + 120.0 * ch * sv + 300.0 * ch * cv
    };
    let values = angles.iter().flat_map(|h| angles.iter().map(move |v| f(*h, *v))).collect();
    Distribution::new(System::TypeB, Symmetry::None, angles.clone(), angles, values).expect("a table")
}

/// A lamp with an opening of 0.2 m along C0–C180 and 0.6 m along C90–C270.
pub fn lamp(distribution: Distribution) -> Luminaire {
    Luminaire {
        name: "asymmetric \"Ω\" -- <lamp>\nwith a line".into(),
        manufacturer: "ours".into(),
        lamps: vec![LampSet::default()],
        input_power_w: Some(10.0),
        opening: Some(Body { shape: Shape::Rectangle, length_m: 0.6, width_m: 0.2, height_m: 0.0 }),
        ..Luminaire::of(distribution)
    }
}

pub fn asymmetric() -> Luminaire {
    lamp(tables().remove(0))
}

/// Directions spread over the sphere without pattern, the same in every run.
pub fn directions(count: usize) -> Vec<DVec3> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut uniform = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count)
        .map(|_| {
            let (z, azimuth) = (2.0 * uniform() - 1.0, TAU * uniform());
            let across = (1.0 - z * z).sqrt();
            DVec3::new(across * azimuth.cos(), across * azimuth.sin(), z)
        })
        .collect()
}

/// A bound on the change of intensity per radian of direction, cd/rad, for a bilinear table of Type C over the whole sphere whose
/// planes agree at the poles.
///
/// Along γ the slope of a cell is that of its sides. Along C it is D(γ)/(ΔC sinγ) with D linear in γ; as sinγ is concave, D/sinγ is
/// largest at a side of the cell that is no pole.
pub fn slope(d: &Distribution) -> f64 {
    let (planes, rows) = (d.horizontal_deg(), d.vertical_deg());
    let (mut along, mut across) = (0.0_f64, 0.0_f64);
    for i in 0..planes.len() {
        for j in 0..rows.len() {
            let value = d.plane(i)[j];
            if j + 1 < rows.len() {
                along = along.max((d.plane(i)[j + 1] - value).abs() / (rows[j + 1] - rows[j]).to_radians());
            }
            let sine = rows[j].to_radians().sin();
            if i + 1 < planes.len() && sine > 1e-9 {
                let step = (planes[i + 1] - planes[i]).to_radians();
                across = across.max((d.plane(i + 1)[j] - value).abs() / (step * sine));
            }
        }
    }
    along.hypot(across)
}

/// Flux of a picture's sampling error: every direction off by at most this many cd.
pub fn flux_bound(error_cd: f64) -> f64 {
    4.0 * PI * error_cd
}

/// Channel `Y` of an OpenEXR file: width, height, pixels by row from the top, and the comment.
pub fn exr_pixels(bytes: &[u8]) -> (usize, usize, Vec<f32>, String) {
    use exr::prelude::*;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(std::io::Cursor::new(bytes))
        .expect("an OpenEXR file");
    let layer = &image.layer_data;
    assert_eq!(layer.encoding.blocks, Blocks::ScanLines);
    let names: Vec<String> = layer.channel_data.list.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["Y"]);
    let FlatSamples::F32(pixels) = &layer.channel_data.list[0].sample_data else { panic!("32-bit numbers") };
    let comment = layer.attributes.comments.as_ref().map(ToString::to_string).unwrap_or_default();
    (layer.size.0, layer.size.1, pixels.clone(), comment)
}
