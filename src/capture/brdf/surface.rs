//! The surface of the object: where a ray of the camera meets it, and whether it stands in its own light.

use std::fmt::Debug;

use glam::{DMat3, DVec3};

use crate::capture::{Error, setup};

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The point, m.
    pub point: DVec3,
    /// Unit normal, to the outside.
    pub normal: DVec3,
    /// Unit normal of the face, where that is not the surface's: of a mesh with interpolated normals.
    pub face: DVec3,
}

/// A surface in the frame that camera and lights share.
pub trait Surface: Debug + Send + Sync {
    /// What it is: `sphere`.
    fn kind(&self) -> &'static str;

    /// Where a ray, given by a point and a unit vector, first meets the surface.
    fn hit(&self, origin: DVec3, ray: DVec3) -> Option<Hit>;

    /// A point that lights are looked at from, m.
    fn middle(&self) -> DVec3;

    /// Whether it ends somewhere but at its silhouette, or turns sharply: pixels there see two things.
    fn has_edges(&self) -> bool {
        true
    }

    /// Whether no part of it sees another: then there is no cast shadow, and no light from one part on another.
    fn is_convex(&self) -> bool {
        true
    }

    /// Whether it stands between a point of its own and what is in a direction (a unit vector) at a distance, m.
    fn hides(&self, from: &Hit, towards: DVec3, distance: f64) -> bool {
        let _ = (from, towards, distance);
        false
    }

    /// Whether a point is inside.
    fn holds(&self, point: DVec3) -> bool {
        let _ = point;
        false
    }
}

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sphere {
    centre: DVec3,
    radius: f64,
}

impl Sphere {
    pub(super) fn new(stated: &setup::Sphere) -> Self {
        Self { centre: DVec3::from_array(stated.centre_m), radius: stated.radius_m }
    }
}

impl Surface for Sphere {
    fn kind(&self) -> &'static str {
        "sphere"
    }

    fn hit(&self, origin: DVec3, ray: DVec3) -> Option<Hit> {
        let from = origin - self.centre;
        let along = -from.dot(ray);
        // The nearest point of the ray to the centre: better conditioned than the discriminant of the distances.
        let nearest = from + along * ray;
        let half_chord2 = self.radius * self.radius - nearest.length_squared();
        (half_chord2 > 0.0 && along > 0.0).then(|| {
            let normal = (nearest - half_chord2.sqrt() * ray).normalize();
            Hit { point: self.centre + self.radius * normal, normal, face: normal }
        })
    }

    fn middle(&self) -> DVec3 {
        self.centre
    }

    fn has_edges(&self) -> bool {
        false
    }

    fn holds(&self, point: DVec3) -> bool {
        point.distance(self.centre) <= self.radius
    }
}

/// The curved side of a cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cylinder {
    centre: DVec3,
    /// Unit vector.
    axis: DVec3,
    radius: f64,
    half_length: f64,
}

impl Cylinder {
    pub(super) fn new(stated: &setup::Cylinder) -> Self {
        let axis = DVec3::from_array(stated.axis).normalize();
        let half_length = 0.5 * stated.length_m;
        Self { centre: DVec3::from_array(stated.centre_m), axis, radius: stated.radius_m, half_length }
    }
}

impl Surface for Cylinder {
    fn kind(&self) -> &'static str {
        "cylinder"
    }

    fn hit(&self, origin: DVec3, ray: DVec3) -> Option<Hit> {
        let from = origin - self.centre;
        let across = |v: DVec3| v - self.axis * v.dot(self.axis);
        let (start, step) = (across(from), across(ray));
        let step2 = step.length_squared();
        let along = -start.dot(step) / step2;
        let nearest = start + along * step;
        let half_chord = ((self.radius * self.radius - nearest.length_squared()) / step2).sqrt();
        let t = along - half_chord;
        let height = (from + t * ray).dot(self.axis);
        // Only from outside: what is seen through an open end is not the side that is lit. Without a crossing t is no number.
        (t > 0.0 && height.abs() <= self.half_length).then(|| {
            let normal = (nearest - half_chord * step).normalize();
            Hit { point: self.centre + self.axis * height + self.radius * normal, normal, face: normal }
        })
    }

    fn middle(&self) -> DVec3 {
        self.centre
    }

    fn holds(&self, point: DVec3) -> bool {
        let from = point - self.centre;
        let height = from.dot(self.axis);
        height.abs() <= self.half_length && (from - self.axis * height).length() <= self.radius
    }
}

/// One side of a plane, or a rectangle of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plane {
    centre: DVec3,
    /// Across and up the rectangle, and the normal: unit vectors.
    axes: DMat3,
    /// Half of its sides; infinite where none are stated.
    half: [f64; 2],
}

impl Plane {
    /// # Errors
    /// [`Error::Setup`] for an `up` along the normal, or a camera behind the plane.
    pub(super) fn new(stated: &setup::Plane, camera: DVec3) -> Result<Self, Error> {
        let normal = DVec3::from_array(stated.normal).normalize();
        let right = DVec3::from_array(stated.up).cross(normal).try_normalize();
        let right = right.or(stated.size_m.is_none().then_some(DVec3::ZERO)).ok_or_else(|| Error::Setup {
            found: format!("`up` {:?} along the normal {:?} of the plane", stated.up, stated.normal),
            expected: "two directions across one another",
        })?;
        let centre = DVec3::from_array(stated.centre_m);
        if (camera - centre).dot(normal) <= 0.0 {
            return Err(Error::Setup {
                found: format!("the camera at {:?}, behind the plane", camera.to_array()),
                expected: "a camera on the side that the normal points to",
            });
        }
        let half = stated.size_m.map_or([f64::INFINITY; 2], |s| s.map(|s| 0.5 * s));
        Ok(Self { centre, axes: DMat3::from_cols(right, normal.cross(right), normal), half })
    }
}

impl Surface for Plane {
    fn kind(&self) -> &'static str {
        "plane"
    }

    fn hit(&self, origin: DVec3, ray: DVec3) -> Option<Hit> {
        let normal = self.axes.z_axis;
        let t = (self.centre - origin).dot(normal) / ray.dot(normal);
        let point = origin + t * ray;
        let within = |axis: DVec3, half: f64| (point - self.centre).dot(axis).abs() <= half;
        let met = t > 0.0
            && t.is_finite()
            && within(self.axes.x_axis, self.half[0])
            && within(self.axes.y_axis, self.half[1]);
        met.then_some(Hit { point, normal, face: normal })
    }

    fn middle(&self) -> DVec3 {
        self.centre
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_is_met_from_outside_and_between_its_ends() {
        let stated = setup::Cylinder {
            centre_m: [1.0, 2.0, 3.0],
            axis: [0.0, 0.0, 2.0],
            radius_m: 0.5,
            length_m: 4.0,
            mask: None,
        };
        let cylinder = Cylinder::new(&stated);
        // Towards −x at 0.3 beside the axis: 3-4-5.
        let hit = cylinder.hit(DVec3::new(9.0, 2.3, 4.5), DVec3::NEG_X).expect("a crossing");
        assert!(hit.point.distance(DVec3::new(1.4, 2.3, 4.5)) < 1e-12, "{hit:?}");
        assert!(hit.normal.distance(DVec3::new(0.8, 0.6, 0.0)) < 1e-12, "{hit:?}");
        // Beyond its end, beside it, behind the camera, along the axis, and through the open end onto the inside.
        for (origin, ray) in [
            (DVec3::new(9.0, 2.3, 5.01), DVec3::NEG_X),
            (DVec3::new(9.0, 2.51, 4.0), DVec3::NEG_X),
            (DVec3::new(9.0, 2.3, 4.0), DVec3::X),
            (DVec3::new(1.1, 2.0, 9.0), DVec3::NEG_Z),
            (DVec3::new(2.0, 2.0, 6.5), DVec3::new(-1.0, 0.0, -1.2).normalize()),
        ] {
            assert_eq!(cylinder.hit(origin, ray), None, "{origin} {ray}");
        }
        assert!(cylinder.holds(DVec3::new(1.2, 2.2, 4.9)) && !cylinder.holds(DVec3::new(1.2, 2.2, 5.1)));
    }

    #[test]
    fn a_plane_ends_where_it_is_stated_to() {
        let stated = |size_m| setup::Plane {
            centre_m: [0.0, 0.0, 1.0],
            normal: [0.0, 0.0, 1.0],
            up: [0.0, 3.0, 0.0],
            size_m,
            mask: None,
        };
        let eye = DVec3::new(0.0, 0.0, 5.0);
        let plane = Plane::new(&stated(Some([2.0, 1.0])), eye).expect("a plane");
        let at = |x: f64, y: f64| plane.hit(eye, (DVec3::new(x, y, 1.0) - eye).normalize());
        assert!(at(0.99, 0.49).is_some_and(|h| h.point.distance(DVec3::new(0.99, 0.49, 1.0)) < 1e-12));
        assert!(at(1.01, 0.0).is_none() && at(0.0, 0.51).is_none());
        assert!(Plane::new(&stated(None), eye).is_ok_and(|p| p.hit(eye, DVec3::new(0.6, 0.0, -0.8)).is_some()));
        assert!(Plane::new(&stated(None), eye).is_ok_and(|p| p.hit(eye, DVec3::Z).is_none()));
        assert!(Plane::new(&stated(None), DVec3::ZERO).is_err_and(|e| e.to_string().contains("behind the plane")));
        let along = setup::Plane { up: [0.0, 0.0, 1.0], ..stated(Some([1.0, 1.0])) };
        assert!(Plane::new(&along, eye).is_err_and(|e| e.to_string().contains("along the normal")));
    }
}
