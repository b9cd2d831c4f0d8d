//! A calibrated camera brought into line with the edge of a sphere whose place is stated.

use glam::{DMat3, DVec2, DVec3};

use super::Camera;

/// Standard error of a point of the edge, pixels, at least: pixels are averages.
const LEAST_PX: f64 = 0.1;

/// The camera after it, and what it took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// The camera.
    pub camera: Camera,
    /// Movement of the principal point, pixels.
    pub moved_px: DVec2,
    /// Focal lengths over those before.
    pub zoom: f64,
    /// Rms distance of the edge from the sphere's silhouette, pixels.
    pub rms_px: f64,
    /// Standard error of the place of the picture after it, pixels.
    pub standard_error_px: f64,
}

/// Moves the principal point and scales the focal lengths so that the silhouette of a sphere (its centre in the camera's frame) lies where its
/// edge was seen, against the standard errors of the calibration: `errors` of the principal point in pixels and of the focal length, relative.
///
/// A ray d touches the sphere where the angle between d and the centre is asin(radius/distance). `None` for fewer than ten points, or a camera
/// inside of the sphere.
#[must_use]
pub fn fit_to_sphere(camera: Camera, centre: DVec3, radius: f64, edge: &[DVec2], errors: (f64, f64)) -> Option<Edge> {
    let half = radius / centre.length();
    if edge.len() < 10 || half >= 1.0 {
        return None;
    }
    let half = half.asin();
    let off = |x: DVec3, p: DVec2| {
        let moved = moved(&camera, x);
        let d = moved.direction(p)?;
        Some((d.cross(centre).length().atan2(d.dot(centre)) - half) * moved.intrinsics.fx)
    };
    let mut x = DVec3::ZERO;
    let mut sigma = LEAST_PX;
    let mut covariance = DMat3::ZERO;
    let mut rms = f64::INFINITY;
    for _ in 0..20 {
        // The prior: calibration.
        let prior = DVec3::new(errors.0.powi(-2), errors.0.powi(-2), errors.1.powi(-2));
        let mut normal = DMat3::from_diagonal(prior);
        let mut right = -prior * x;
        let mut square = 0.0;
        for p in edge {
            let r = off(x, *p)?;
            let mut row = DVec3::ZERO;
            for (k, h) in [(0, 1e-3), (1, 1e-3), (2, 1e-6)] {
                let mut there = x;
                there[k] += h;
                row[k] = (off(there, *p)? - r) / h;
            }
            normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z) * sigma.powi(-2);
            right -= row * (r * sigma.powi(-2));
            square += r * r;
        }
        covariance = normal.inverse();
        let step = covariance * right;
        x += step;
        rms = (square / edge.len() as f64).sqrt();
        sigma = rms.max(LEAST_PX);
        if step.length() < 1e-9 {
            break;
        }
    }
    let standard_error_px = (0.5 * (covariance.x_axis.x + covariance.y_axis.y)).sqrt();
    x.is_finite().then(|| Edge {
        camera: moved(&camera, x),
        moved_px: x.truncate(),
        zoom: x.z.exp(),
        rms_px: rms,
        standard_error_px,
    })
}

/// The camera with its principal point moved by (x, y) and its focal lengths multiplied by eᶻ.
fn moved(camera: &Camera, x: DVec3) -> Camera {
    let mut out = *camera;
    out.intrinsics.cx += x.x;
    out.intrinsics.cy += x.y;
    out.intrinsics.fx *= x.z.exp();
    out.intrinsics.fy *= x.z.exp();
    out
}

#[cfg(test)]
mod tests {
    use super::super::Intrinsics;
    use super::*;
    use crate::geometry::lens::Distortion;

    #[test]
    fn the_edge_of_a_sphere_corrects_the_principal_point_and_the_focal_length() {
        let intrinsics = Intrinsics { fx: 1700.0, fy: 1690.0, cx: 250.0, cy: 260.0 };
        let truth = Camera { intrinsics, distortion: Distortion { k1: -1.2, ..Distortion::default() } };
        let centre = DVec3::new(0.1, -0.05, 8.0);
        let d2 = centre.length_squared();
        let (along, across) = (1.0 - 1.0 / d2, (1.0 - 1.0 / d2).sqrt());
        let t = centre.cross(DVec3::Y).normalize();
        let s = t.cross(centre.normalize());
        let edge: Vec<DVec2> = (0..60)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * 0.1).sin_cos();
                truth.project(centre * along + across * (cos * t + sin * s))
            })
            .collect();
        let wrong = moved(&truth, DVec3::new(1.5, -0.8, 0.002));
        let found = fit_to_sphere(wrong, centre, 1.0, &edge, (100.0, 1.0)).unwrap();
        assert!(found.moved_px.abs_diff_eq(DVec2::new(-1.5, 0.8), 1e-4), "{found:?}");
        assert!((found.zoom.ln() + 0.002).abs() < 1e-6 && found.rms_px < 1e-4, "{found:?}");
        // A calibration that is certain is not moved.
        let held = fit_to_sphere(wrong, centre, 1.0, &edge, (1e-6, 1e-9)).unwrap();
        assert!(held.moved_px.length() < 1e-4, "{held:?}");
        assert!(fit_to_sphere(wrong, centre, 9.0, &edge, (1.0, 1.0)).is_none());
    }
}
