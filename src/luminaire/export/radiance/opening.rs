//! The surfaces that stand for a luminous opening.

use std::f64::consts::{PI, TAU};

use crate::luminaire::{Body, Shape};

/// Smaller than this an opening has no extent, m; also the diameter of the sphere that stands for a point (as ies2rad).
const SMALLEST_M: f64 = 1e-3;
/// Corners of the polygon that stands for an ellipse; its own area is divided by.
const CORNERS: usize = 64;

/// The surfaces, centred on the origin; metres along x, y and z.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Surfaces {
    /// Polygons of these corners (counter-clockwise from above), facing down, up or both.
    Flat { corners: Vec<(f64, f64)>, lower: bool, upper: bool },
    /// Rings without hole.
    Disc { diameter: f64, lower: bool, upper: bool },
    /// Six rectangles, without the top or the bottom where no light goes there.
    Box { size: [f64; 3], lower: bool, upper: bool },
    /// A sphere.
    Sphere { diameter: f64 },
}

impl Surfaces {
    /// Surfaces for an opening from which light goes down, up or both; and what had to be replaced.
    pub(super) fn of(body: Option<&Body>, lower: bool, upper: bool) -> (Self, Option<String>) {
        let point = Self::Sphere { diameter: SMALLEST_M };
        let Some(body) = body.filter(|b| b.shape != Shape::Point) else {
            return (point, Some("no luminous opening: a sphere of 1 mm stands for it".to_owned()));
        };
        let (x, y, z) = (body.width_m, body.length_m, body.height_m);
        if x.max(y).max(z) < SMALLEST_M {
            return (point, Some("the luminous opening is below 1 mm: a sphere of 1 mm stands for it".to_owned()));
        }
        let thick = [x, y, z].map(|v| v.max(SMALLEST_M));
        let around = |what: &str| {
            (Self::Box { size: thick, lower, upper }, Some(format!("{what}: the box around it stands for it")))
        };
        let even = (x - y).abs() <= 1e-6 * (x + y);
        match body.shape {
            Shape::Rectangle if x < SMALLEST_M || y < SMALLEST_M => around("an upright or linear opening"),
            Shape::Rectangle if z < SMALLEST_M => {
                let (x, y) = (x / 2.0, y / 2.0);
                (Self::Flat { corners: vec![(x, -y), (x, y), (-x, y), (-x, -y)], lower, upper }, None)
            }
            Shape::Rectangle => (Self::Box { size: [x, y, z], lower, upper }, None),
            Shape::Round if x < SMALLEST_M || y < SMALLEST_M => around("an upright disc"),
            Shape::Round if z < SMALLEST_M && even => (Self::Disc { diameter: x, lower, upper }, None),
            Shape::Round if z < SMALLEST_M => {
                let corner = |i: usize| (TAU * i as f64 / CORNERS as f64).sin_cos();
                let corners = (0..CORNERS).map(corner).map(|(sin, cos)| (0.5 * x * cos, 0.5 * y * sin)).collect();
                (Self::Flat { corners, lower, upper }, None)
            }
            // Radiance samples a cylinder as a line: half of the light of one as wide as high is lost.
            Shape::Round => around("an upright cylinder"),
            Shape::Sphere => {
                let z = if z > 0.0 { z } else { x.min(y) };
                let alike = even && (z - x).abs() <= 1e-6 * (z + x);
                let what = "an ellipsoid: a sphere of its volume stands for it".to_owned();
                (Self::Sphere { diameter: (x * y * z).cbrt().max(SMALLEST_M) }, (!alike).then_some(what))
            }
            Shape::CylinderAlongC0 | Shape::CylinderAlongC90 => around("a lying cylinder"),
            Shape::Point => (point, None),
        }
    }

    /// The function of `source.cal` that makes radiance of intensity, and its arguments.
    pub(super) fn correction(&self) -> (&'static str, Vec<f64>) {
        match self {
            Self::Flat { corners, .. } => ("flatcorr", vec![1.0 / area(corners)]),
            Self::Disc { diameter, .. } => ("flatcorr", vec![4.0 / (PI * diameter * diameter)]),
            Self::Box { size: [x, y, z], .. } => ("boxcorr", vec![1.0, *x, *y, *z]),
            Self::Sphere { diameter } => ("corr", vec![4.0 / (PI * diameter * diameter)]),
        }
    }

    /// The primitives of a scene.
    pub(super) fn to_rad(&self, id: &str) -> String {
        let mut out = String::new();
        let mut surface = |kind: &str, suffix: &str, numbers: &[f64]| {
            let words: Vec<String> = numbers.iter().map(|v| short(*v)).collect();
            let lines: Vec<String> = words.chunks(if kind == "polygon" { 3 } else { 8 }).map(|l| l.join(" ")).collect();
            out.push_str(&format!(
                "\n{id}_light {kind} {id}.{suffix}\n0\n0\n{}\n{}\n",
                numbers.len(),
                lines.join("\n")
            ));
        };
        // Two flat sides do not coincide.
        let apart = SMALLEST_M / 4.0;
        match self {
            Self::Flat { corners, lower, upper } => {
                let at = |z: f64| corners.iter().flat_map(move |(x, y)| [*x, *y, z]).collect::<Vec<f64>>();
                if *lower {
                    let mut down = at(-apart);
                    // The other way round it faces down.
                    down.reverse();
                    down.chunks_mut(3).for_each(<[f64]>::reverse);
                    surface("polygon", "d", &down);
                }
                if *upper {
                    surface("polygon", "u", &at(apart));
                }
            }
            Self::Disc { diameter, lower, upper } => {
                if *lower {
                    surface("ring", "d", &[0.0, 0.0, -apart, 0.0, 0.0, -1.0, 0.0, 0.5 * diameter]);
                }
                if *upper {
                    surface("ring", "u", &[0.0, 0.0, apart, 0.0, 0.0, 1.0, 0.0, 0.5 * diameter]);
                }
            }
            Self::Box { size, lower, upper } => {
                for (suffix, axis, sign) in
                    [("d", 2, -1.0), ("u", 2, 1.0), ("x1", 0, 1.0), ("x2", 0, -1.0), ("y1", 1, 1.0), ("y2", 1, -1.0)]
                {
                    if (suffix != "d" || *lower) && (suffix != "u" || *upper) {
                        surface("polygon", suffix, &face(*size, axis, sign));
                    }
                }
            }
            Self::Sphere { diameter } => surface("sphere", "s", &[0.0, 0.0, 0.0, 0.5 * diameter]),
        }
        out
    }
}

/// Metres to a nanometre.
fn short(metres: f64) -> String {
    ((metres * 1e9).round() / 1e9 + 0.0).to_string()
}

/// Area of a polygon of corners in order.
fn area(corners: &[(f64, f64)]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    0.5 * corners.iter().zip(next).map(|((x0, y0), (x1, y1))| x0 * y1 - x1 * y0).sum::<f64>()
}

/// Corners of the side of a box across an axis, counter-clockwise from outside.
fn face(size: [f64; 3], axis: usize, sign: f64) -> Vec<f64> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turn = [(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
    if sign < 0.0 {
        turn.reverse();
    }
    let corner = |(a, b): (f64, f64)| {
        let mut point = [0.0; 3];
        (point[axis], point[u], point[v]) = (0.5 * sign * size[axis], 0.5 * a * size[u], 0.5 * b * size[v]);
        point
    };
    turn.into_iter().flat_map(corner).collect()
}
