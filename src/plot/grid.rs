//! From illuminance on a plane, computed or rendered, to its isolux diagram.

use glam::DVec3;

use super::isolux::{IsoluxLine, IsoluxPanel, LuminaireMark};
use crate::luminaire::grid::{self, Illuminance, Placed, Settings};
use crate::luminaire::placement::{Orientation, Placement};
use crate::luminaire::{Body, Kind, Luminaire, Shape};
use crate::math::contour::contours;
use crate::render::light_map::LightMap;
use crate::render::reading::Points;
use crate::render::shape::chart::Chart;
use crate::units::significant;

/// Unit of the values of a kind of luminaire.
#[must_use]
pub fn unit(kind: Kind) -> &'static str {
    match kind {
        Kind::Luminous => "lx",
        Kind::Radiant => "W/m²",
        Kind::Photon => "µmol/(m²·s)",
    }
}

/// The isolux diagram of values on a plane; `drawn` may be a finer grid of the same plane, the figures are those of `result`.
#[must_use]
pub fn isolux_panel(
    title: &str,
    result: &Illuminance,
    drawn: &Illuminance,
    luminaires: &[Placed<'_>],
    filled: bool,
) -> IsoluxPanel {
    let plane = &drawn.plane;
    let [u, v] = plane.axes();
    let (ox, oy) = (along(u, plane.origin_m()), along(v, plane.origin_m()));
    let [length_u, length_v] = plane.size_m();
    let columns_m: Vec<f64> = plane.u_m().iter().map(|d| d + ox).collect();
    let rows_m: Vec<f64> = plane.v_m().iter().map(|d| d + oy).collect();
    let on_plane = |p: DVec3| {
        let d = p - plane.origin_m();
        (d.dot(u) + ox, d.dot(v) + oy)
    };
    let lines = drawn
        .figures
        .map(|f| levels(f.minimum, f.maximum))
        .unwrap_or_default()
        .into_iter()
        .flat_map(|level| {
            let lines = contours(&columns_m, &rows_m, &drawn.values, level);
            lines.into_iter().map(move |points| IsoluxLine { level, points })
        })
        .collect();
    let normal = plane.normal();
    let luminaires = luminaires
        .iter()
        .map(|p| {
            let (position, axis) = (p.placement.position_m(), p.placement.axis());
            let falls = axis.dot(normal);
            let distance = (plane.origin_m() - position).dot(normal) / falls;
            let meets = distance > 0.0 && falls.abs() < STRAIGHT;
            LuminaireMark {
                at: on_plane(position),
                outline: outline(p).into_iter().map(on_plane).collect(),
                c0: (p.placement.c0().dot(u), p.placement.c0().dot(v)),
                aim: meets.then(|| on_plane(position + distance * axis)),
            }
        })
        .collect();
    IsoluxPanel {
        title: title.to_owned(),
        figures: figures(result),
        axes: [axis_name(u, "first side"), axis_name(v, "second side")],
        extent_m: [(ox, ox + length_u), (oy, oy + length_v)],
        columns_m,
        rows_m,
        values: drawn.values.clone(),
        unit: unit(drawn.kind).to_owned(),
        lines,
        luminaires,
        filled,
    }
}

/// The light map of a grid of meters, as they read, with isolux lines; its edges are at right angles.
#[must_use]
pub fn light_map_panel(title: &str, points: &Points, unit: &str, figures: &str) -> IsoluxPanel {
    let [m, n] = points.counts;
    let lengths = points.map.size_m();
    let (origin, axes) = match points.map {
        LightMap::Flat { corner, edges } => {
            let axes = [edges[0] / lengths[0], edges[1] / lengths[1]];
            let names = [axis_name(axes[0], "first edge"), axis_name(axes[1], "second edge")];
            (axes.map(|axis| along(axis, corner)), names)
        }
        LightMap::Round(Chart::Sphere { .. }) => ([0.0; 2], ["around [m]", "height [m]"].map(str::to_owned)),
        LightMap::Round(_) => ([0.0; 2], ["around [m]", "along the axis [m]"].map(str::to_owned)),
    };
    let places = |count: usize, side: usize| -> Vec<f64> {
        #[expect(clippy::cast_precision_loss, reason = "numbers of points")]
        let at = |i: usize| origin[side] + lengths[side] * (i as f64 + 0.5) / count as f64;
        (0..count).map(at).collect()
    };
    let (columns_m, rows_m) = (places(m, 0), places(n, 1));
    let values: Vec<f64> = points.figures.iter().map(|f| f.value).collect();
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let lines = (levels(low, high).into_iter())
        .flat_map(|level| {
            let lines = contours(&columns_m, &rows_m, &values, level);
            lines.into_iter().map(move |points| IsoluxLine { level, points })
        })
        .collect();
    IsoluxPanel {
        title: title.to_owned(),
        figures: figures.to_owned(),
        axes,
        extent_m: [(origin[0], origin[0] + lengths[0]), (origin[1], origin[1] + lengths[1])],
        columns_m,
        rows_m,
        values,
        unit: unit.to_owned(),
        lines,
        luminaires: Vec::new(),
        filled: true,
    }
}

/// Cosine above which an axis meets the plane at a right angle for the eye.
const STRAIGHT: f64 = 0.9998;
/// Cells along a side of the diagram of a single luminaire.
const CELLS: usize = 160;

/// The isolux diagram of a single luminaire hung at a height over a floor, shining down with C0 towards +x.
///
/// # Errors
/// Those of [`grid::beneath`].
pub fn isolux_beneath(
    luminaire: &Luminaire,
    title: &str,
    height_m: f64,
    filled: bool,
) -> Result<IsoluxPanel, grid::Error> {
    let result = grid::beneath(luminaire, height_m, CELLS, &Settings::default())?;
    let height = grid::Error::Setting { name: "a mounting height", found: height_m, expected: "a length above 0 m" };
    let at = DVec3::new(0.0, 0.0, height_m);
    let placement = Placement::new(at, Orientation::DOWN, 1.0).map_err(|_| height)?;
    Ok(isolux_panel(title, &result, &result, &[Placed { luminaire, placement }], filled))
}

/// The room's coordinate where an axis runs along it, else the distance from the plane's first corner.
fn along(axis: DVec3, origin: DVec3) -> f64 {
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().find(|e| *e == axis).map_or(0.0, |e| e.dot(origin))
}

fn axis_name(axis: DVec3, side: &str) -> String {
    let named = [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")].into_iter().find(|(e, _)| *e == axis);
    named.map_or_else(|| format!("along the {side} [m]"), |(_, name)| format!("{name} [m]"))
}

fn figures(result: &Illuminance) -> String {
    let unit = unit(result.kind);
    let Some(f) = result.figures else { return String::new() };
    let show = |v: f64| significant(v, 3);
    let u0 = f.u0.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"));
    let [m, n] = result.plane.counts();
    format!(
        "min {}, mean {}, max {} {unit}, U0 {u0} ({m} × {n} points; direct light, unobstructed)",
        show(f.minimum),
        show(f.mean),
        show(f.maximum)
    )
}

/// Corners of the luminous opening in its plane across the axis, in the room.
fn outline(placed: &Placed<'_>) -> Vec<DVec3> {
    let Some(Body { shape, length_m, width_m, .. }) = placed.luminaire.opening else { return Vec::new() };
    let (x, y) = (0.5 * width_m, 0.5 * length_m);
    let local: Vec<(f64, f64)> = match shape {
        Shape::Point => Vec::new(),
        Shape::Round | Shape::Sphere => (0..32)
            .map(|i| (std::f64::consts::TAU * f64::from(i) / 32.0).sin_cos())
            .map(|(s, c)| (x * c, y * s))
            .collect(),
        _ => vec![(-x, -y), (x, -y), (x, y), (-x, y)],
    };
    let place = |(a, b)| placed.placement.position_m() + placed.placement.to_room() * DVec3::new(a, b, 0.0);
    local.into_iter().map(place).collect()
}

/// Round levels for the lines: even ones where the field is even, else 1–2–5 (with 1.5, 3, 7 where few) over two decades.
fn levels(low: f64, high: f64) -> Vec<f64> {
    if !(high > 0.0 && low.is_finite() && high > low) {
        return Vec::new();
    }
    let decade = |v: f64| 10f64.powf(v.log10().floor());
    let inside = |v: &f64| *v > low && *v < high;
    if low > 0.3 * high {
        let rough = (high - low) / 6.0;
        let step = [1.0, 2.0, 5.0, 10.0].map(|f| f * decade(rough)).into_iter().find(|s| *s >= rough).unwrap_or(rough);
        let first = (low / step).ceil();
        return (0..12).map(|i| (first + f64::from(i)) * step).filter(inside).collect();
    }
    let floor = low.max(0.01 * high);
    let series = |factors: &[f64]| -> Vec<f64> {
        let top = decade(high);
        let all = [-3, -2, -1, 0].into_iter().flat_map(|k| factors.iter().map(move |f| f * top * 10f64.powi(k)));
        all.filter(|v| *v > floor && *v < high).collect()
    };
    let dense = series(&[1.0, 1.5, 2.0, 3.0, 5.0, 7.0]);
    if dense.len() <= 9 { dense } else { series(&[1.0, 2.0, 5.0]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_within() {
        assert_eq!(levels(300.0, 560.0), [350.0, 400.0, 450.0, 500.0, 550.0]);
        assert_eq!(levels(0.0, 45.0), [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]);
        assert!(levels(0.0, 0.0).is_empty() && levels(5.0, 5.0).is_empty());
    }
}
