//! The surface of a luminous opening as smooth patches, each with two parameters over the part that a point sees.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use super::super::model::{Body, Shape};

/// Points nearer than this to an opening (or to a luminaire without one) have no illuminance, m.
pub(super) const TOUCHING_M: f64 = 1e-6;

/// A smooth part of the surface, in the luminaire's frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    form: Form,
    centre: DVec3,
    /// The whole of a flat opening, which shines both ways.
    two_sided: bool,
}

#[derive(Debug, Clone, Copy)]
enum Form {
    /// Half sides; one of them may be zero (a line).
    Parallelogram(DVec3, DVec3),
    /// Semi-axes.
    Ellipse(DVec3, DVec3),
    /// Semi-axes of the section and half of the axis, right-handed.
    Wall(DVec3, DVec3, DVec3),
    /// Semi-axes along x, y, z.
    Ellipsoid(DVec3),
}

/// The part of a patch that a point sees: ranges of both parameters, and into how many cells they are cut at first.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    pub s: (f64, f64),
    pub t: (f64, f64),
    pub cells: (u32, u32),
    /// Axes about the direction to the point (ellipsoid).
    frame: DMat3,
}

/// An element of the surface per unit of both parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element {
    pub place: DVec3,
    /// Area along the outward normal, m².
    pub area: DVec3,
    /// Share of the whole opening, of a flat one.
    pub share: Option<f64>,
}

impl Patch {
    fn new(form: Form, centre: DVec3) -> Self {
        Self { form, centre, two_sided: false }
    }

    /// What of the patch is seen from a point; `None` for nothing.
    pub(super) fn seen_from(&self, q: DVec3) -> Option<View> {
        let d = q - self.centre;
        let faces = |n: DVec3| self.two_sided || n.dot(d) > 0.0;
        let (whole, all_round) = ((-1.0, 1.0), (0.0, TAU));
        let view = |s, t, cells| View { s, t, cells, frame: DMat3::IDENTITY };
        match self.form {
            Form::Parallelogram(u, v) => faces(u.cross(v)).then(|| view(whole, whole, (1, 1))),
            Form::Ellipse(u, v) => faces(u.cross(v)).then(|| view((0.0, 1.0), all_round, (1, 4))),
            Form::Wall(u, v, _) => {
                let at = (d.dot(u) / u.length_squared(), d.dot(v) / v.length_squared());
                let distance = at.0.hypot(at.1);
                (distance > 1.0).then(|| {
                    let (middle, half) = (at.1.atan2(at.0), (1.0 / distance).acos());
                    view((middle - half, middle + half), whole, (2, 1))
                })
            }
            Form::Ellipsoid(semi) => {
                let at = d / semi;
                let distance = at.length();
                (distance > 1.0).then(|| {
                    let towards = at / distance;
                    let (e1, e2) = towards.any_orthonormal_pair();
                    View {
                        s: (0.0, (1.0 / distance).acos()),
                        t: all_round,
                        cells: (1, 4),
                        frame: DMat3::from_cols(e1, e2, towards),
                    }
                })
            }
        }
    }

    /// The element of the surface at two parameters.
    pub(super) fn element(&self, view: &View, s: f64, t: f64) -> Element {
        match self.form {
            Form::Parallelogram(u, v) => {
                Element { place: self.centre + s * u + t * v, area: u.cross(v), share: self.two_sided.then_some(0.25) }
            }
            Form::Ellipse(u, v) => {
                let (sin, cos) = t.sin_cos();
                Element {
                    place: self.centre + s * (cos * u + sin * v),
                    area: s * u.cross(v),
                    share: self.two_sided.then_some(s / PI),
                }
            }
            Form::Wall(u, v, axis) => {
                let (sin, cos) = s.sin_cos();
                Element {
                    place: self.centre + cos * u + sin * v + t * axis,
                    area: (cos * v - sin * u).cross(axis),
                    share: None,
                }
            }
            Form::Ellipsoid(semi) => {
                let ((sin_s, cos_s), (sin_t, cos_t)) = (s.sin_cos(), t.sin_cos());
                let n = view.frame * DVec3::new(sin_s * cos_t, sin_s * sin_t, cos_s);
                let DVec3 { x: a, y: b, z: c } = semi;
                Element {
                    place: self.centre + semi * n,
                    area: sin_s * DVec3::new(b * c, a * c, a * b) * n,
                    share: None,
                }
            }
        }
    }
}

/// The surface of a luminous opening; empty for a point.
pub(super) fn patches(body: &Body) -> Vec<Patch> {
    let half = half_axes(body);
    let [x, y, z] = [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z];
    let flat = |form| vec![Patch { form, centre: DVec3::ZERO, two_sided: true }];
    let without = [half.x, half.y, half.z].iter().filter(|a| **a == 0.0).count();
    let in_plane = match (half.x == 0.0, half.y == 0.0) {
        (true, _) => (y, z),
        (_, true) => (z, x),
        _ => (x, y),
    };
    match body.shape {
        _ if without == 3 => Vec::new(),
        Shape::Point => Vec::new(),
        // A rectangle or a line: as a line, one of the two is zero.
        Shape::Rectangle if without > 0 => flat(Form::Parallelogram(in_plane.0, in_plane.1)),
        _ if without > 1 => flat(Form::Parallelogram(in_plane.0, in_plane.1)),
        Shape::Rectangle => [(x, y, z), (y, z, x), (z, x, y)]
            .into_iter()
            .flat_map(|(u, v, n)| [Patch::new(Form::Parallelogram(u, v), n), Patch::new(Form::Parallelogram(v, u), -n)])
            .collect(),
        _ if without == 1 => flat(Form::Ellipse(in_plane.0, in_plane.1)),
        Shape::Round => cylinder(x, y, z),
        Shape::Sphere => vec![Patch::new(Form::Ellipsoid(half), DVec3::ZERO)],
        Shape::CylinderAlongC0 => cylinder(y, z, x),
        Shape::CylinderAlongC90 => cylinder(z, x, y),
    }
}

/// An elliptic cylinder: section u, v, half axis, right-handed.
fn cylinder(u: DVec3, v: DVec3, axis: DVec3) -> Vec<Patch> {
    vec![
        Patch::new(Form::Wall(u, v, axis), DVec3::ZERO),
        Patch::new(Form::Ellipse(u, v), axis),
        Patch::new(Form::Ellipse(v, u), -axis),
    ]
}

/// Half extents along x (C0–C180), y (C90–C270) and z, m.
fn half_axes(body: &Body) -> DVec3 {
    let height = match body.shape {
        Shape::Sphere | Shape::CylinderAlongC0 | Shape::CylinderAlongC90 => body.round_height_m(),
        _ => body.height_m,
    };
    0.5 * DVec3::new(body.width_m, body.length_m, height)
}

/// Whether a point is in the opening or on it, within [`TOUCHING_M`].
pub(super) fn touches(body: Option<&Body>, q: DVec3) -> bool {
    let half = body.filter(|b| b.shape != Shape::Point).map_or(DVec3::ZERO, half_axes) + TOUCHING_M;
    let DVec3 { x, y, z } = (q / half).abs();
    let box_shaped = x <= 1.0 && y <= 1.0 && z <= 1.0;
    let (xx, yy, zz) = (x * x, y * y, z * z);
    box_shaped
        && match body.map(|b| b.shape) {
            None | Some(Shape::Point | Shape::Sphere) => xx + yy + zz <= 1.0,
            Some(Shape::Rectangle) => true,
            Some(Shape::Round) if half.x == TOUCHING_M => yy + zz <= 1.0,
            Some(Shape::Round) if half.y == TOUCHING_M => xx + zz <= 1.0,
            Some(Shape::Round) => xx + yy <= 1.0,
            Some(Shape::CylinderAlongC0) => yy + zz <= 1.0,
            Some(Shape::CylinderAlongC90) => xx + zz <= 1.0,
        }
}

/// Largest dimension of an opening, m: its longest side, diameter or height.
pub(super) fn largest_dimension_m(body: &Body) -> f64 {
    if body.shape == Shape::Point { 0.0 } else { 2.0 * half_axes(body).max_element() }
}
