//! Unit vectors in the local frame of a surface: +z is the normal, all directions point away from the surface.

use std::f64::consts::TAU;

use glam::DVec3;

/// The direction at angle `theta_rad` to the normal and azimuth `phi_rad` (from +x towards +y).
#[must_use]
pub fn from_angles(theta_rad: f64, phi_rad: f64) -> DVec3 {
    let (sin, cos) = theta_rad.sin_cos();
    let (y, x) = phi_rad.sin_cos();
    DVec3::new(sin * x, sin * y, cos)
}

/// The direction at angles in degrees; exact at 90° and its multiples, where the cosine of a rounded π/2 is not zero.
#[must_use]
pub fn from_degrees(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let (sin, cos) = sin_cos_degrees(theta_deg);
    let (y, x) = sin_cos_degrees(phi_deg);
    DVec3::new(sin * x, sin * y, cos)
}

/// Sine and cosine of an angle in degrees, reduced to ±45° before it is turned into radians.
fn sin_cos_degrees(angle_deg: f64) -> (f64, f64) {
    let quarter = (angle_deg / 90.0).round();
    let (sin, cos) = (angle_deg - 90.0 * quarter).to_radians().sin_cos();
    match quarter.rem_euclid(4.0) {
        1.0 => (cos, -sin),
        2.0 => (-sin, -cos),
        3.0 => (-cos, sin),
        _ => (sin, cos),
    }
}

/// Angle to the normal in radians, 0 to π, with full precision near the pole and near the horizon.
#[must_use]
pub fn theta(direction: DVec3) -> f64 {
    direction.x.hypot(direction.y).atan2(direction.z)
}

/// Azimuth in radians, 0 to 2π; 0 along the normal.
#[must_use]
pub fn phi(direction: DVec3) -> f64 {
    let phi = direction.y.atan2(direction.x);
    if phi < 0.0 { phi + TAU } else { phi }
}

/// The mirror direction R = 2 (n·ω) n − ω.
#[must_use]
pub fn mirror(direction: DVec3) -> DVec3 {
    DVec3::new(-direction.x, -direction.y, direction.z)
}

/// Two unit vectors that form a right-handed frame (t, b, `normal`) with a unit vector.
///
/// Reference: T. Duff et al., *Building an Orthonormal Basis, Revisited*, JCGT 6 (2017).
#[must_use]
pub fn tangents(normal: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0_f64.copysign(normal.z);
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    let first = DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    let second = DVec3::new(b, sign + normal.y * normal.y * a, -normal.y);
    (first, second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_exact_where_they_can_be() {
        assert_eq!(from_degrees(90.0, 0.0), DVec3::X);
        assert_eq!(from_degrees(90.0, 90.0), DVec3::Y);
        assert_eq!(from_degrees(90.0, 180.0), DVec3::NEG_X);
        assert_eq!(from_degrees(90.0, 270.0), DVec3::NEG_Y);
        assert_eq!(from_degrees(0.0, 77.0), DVec3::Z);
        // cos 89.9999° = sin 0.0001°, to the last digits.
        let grazing = from_degrees(89.9999, 0.0).z;
        assert!((grazing / 1.745_329_251_993_444e-6 - 1.0).abs() < 1e-9, "{grazing}");
    }

    #[test]
    fn angles_come_back() {
        for (t, p) in [(1e-9, 0.3), (0.7, 4.0), (1.5607, 6.0), (3.0, 1.0)] {
            let d = from_angles(t, p);
            assert!((theta(d) - t).abs() < 1e-15 && (phi(d) - p).abs() < 1e-14, "{t} {p}");
            assert!((mirror(d).z - d.z).abs() == 0.0 && (mirror(d) + d).truncate().length() == 0.0);
        }
    }

    #[test]
    fn tangents_are_orthonormal_and_right_handed() {
        for n in [DVec3::Z, DVec3::NEG_Z, DVec3::X, from_angles(2.1, 0.3), from_angles(1e-8, 2.0)] {
            let (t, b) = tangents(n);
            assert!((t.cross(b) - n).length() < 1e-15, "{n}");
            assert!((t.length() - 1.0).abs() < 1e-15 && (b.length() - 1.0).abs() < 1e-15);
        }
    }
}
