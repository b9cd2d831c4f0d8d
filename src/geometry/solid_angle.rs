//! Solid angles and projected solid angles of simple sources, seen from the origin.
//!
//! Every formula is written so that it keeps its digits for sources that look small: 1 − cos τ as 2 sin²(τ/2), angles
//! between directions by atan2.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// Solid angle of a cone of half-angle `half_angle_rad` (0 to π): 2π(1 − cos τ) = 4π sin²(τ/2).
#[must_use]
pub fn cone(half_angle_rad: f64) -> f64 {
    4.0 * PI * (0.5 * half_angle_rad).sin().powi(2)
}

/// Projected solid angle of a cone about the normal, half-angle 0 to π/2: π sin²τ.
#[must_use]
pub fn cone_projected(half_angle_rad: f64) -> f64 {
    PI * half_angle_rad.sin().powi(2)
}

/// Half-angle of the cone of a solid angle (0 to 4π sr).
#[must_use]
pub fn cone_half_angle(solid_angle_sr: f64) -> f64 {
    2.0 * (solid_angle_sr / (4.0 * PI)).sqrt().asin()
}

/// Solid angle of a sphere of `radius` whose centre is `distance` away (distance > radius).
#[must_use]
pub fn sphere(radius: f64, distance: f64) -> f64 {
    cone((radius / distance).asin())
}

/// Projected solid angle of such a sphere on the normal: π (r/d)².
#[must_use]
pub fn sphere_projected(radius: f64, distance: f64) -> f64 {
    PI * (radius / distance).powi(2)
}

/// Solid angle of a disk of `radius` facing the origin from `distance` on its axis.
#[must_use]
pub fn disk(radius: f64, distance: f64) -> f64 {
    cone(radius.atan2(distance))
}

/// Projected solid angle of such a disk: π r²/(r² + d²).
#[must_use]
pub fn disk_projected(radius: f64, distance: f64) -> f64 {
    cone_projected(radius.atan2(distance))
}

/// Solid angle of a triangle with corners `a`, `b`, `c`, seen from the origin; positive for either order of the corners.
///
/// ```text
/// tan(Ω/2) = a·(b × c) / (abc + (a·b)c + (a·c)b + (b·c)a)
/// ```
///
/// Reference: A. Van Oosterom & J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983).
#[must_use]
pub fn triangle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    // Edges instead of corners in the triple product: the same number, without the cancellation of nearly equal vectors.
    let triple = a.dot((b - a).cross(c - a));
    let denominator = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    let half = triple.abs().atan2(denominator);
    2.0 * if half < 0.0 { half + PI } else { half }
}

/// Projected solid angle on the +z normal of a polygon with `corners` in order, wholly above the plane z = 0, seen from the
/// origin; positive for either order.
///
/// ```text
/// Ω⊥ = ½ |Σ Γᵢ · n|,   Γᵢ = angle between the corners of edge i, along the normal of the plane through edge and origin
/// ```
///
/// Reference: J. H. Lambert, *Photometria* (1760); D. R. Baum et al., SIGGRAPH 1989.
#[must_use]
pub fn polygon_projected(corners: &[DVec3]) -> f64 {
    let mut sum = 0.0;
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        let cross = a.cross(b - a);
        let length = cross.length();
        if length > 0.0 {
            sum += cross.z / length * length.atan2(a.dot(*b));
        }
    }
    0.5 * sum.abs()
}

/// Solid angle of a convex polygon with `corners` in order, by fanning it into triangles.
#[must_use]
pub fn polygon(corners: &[DVec3]) -> f64 {
    let Some((first, rest)) = corners.split_first() else { return 0.0 };
    rest.windows(2).map(|w| triangle(*first, w[0], w[1])).sum()
}

/// Corners of a rectangle `width` × `height` centred on the +z axis at `distance`, facing the origin.
#[must_use]
pub fn rectangle_corners(width: f64, height: f64, distance: f64) -> [DVec3; 4] {
    let (x, y) = (0.5 * width, 0.5 * height);
    [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| DVec3::new(x, y, distance))
}

/// Corners of an isosceles triangle of `base` and `height` whose centroid is on the +z axis at `distance`.
#[must_use]
pub fn triangle_corners(base: f64, height: f64, distance: f64) -> [DVec3; 3] {
    let (x, low) = (0.5 * base, -height / 3.0);
    [[-x, low], [x, low], [0.0, height + low]].map(|[x, y]| DVec3::new(x, y, distance))
}

/// ∫ cosⁿθ dω over the hemisphere: 2π/(n + 1), for n > −1.
#[must_use]
pub fn cosine_power(n: f64) -> f64 {
    TAU / (n + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms() {
        // The whole sphere, the hemisphere and its projection.
        assert!((cone(PI) - 4.0 * PI).abs() < 1e-14 && (cone(PI / 2.0) - TAU).abs() < 1e-14);
        assert!((cone_projected(PI / 2.0) - PI).abs() < 1e-15);
        assert!((cone_half_angle(cone(0.3)) - 0.3).abs() < 1e-15);
        // A cube's face from its centre is a sixth of the sphere.
        let face = rectangle_corners(2.0, 2.0, 1.0);
        assert!((polygon(&face) - 4.0 * PI / 6.0).abs() < 1e-14, "{}", polygon(&face));
        // Projected solid angle of a square of side 2a at distance a, on axis:
        // 4·(a/√(a²+d²))·atan(a/√(a²+d²)) with a = d = 1 (Hottel's form factor of parallel rectangles, differential element).
        let s = 1.0 / 2.0_f64.sqrt();
        assert!((polygon_projected(&face) - 4.0 * s * s.atan()).abs() < 1e-14);
        // An octant.
        assert!((triangle(DVec3::X, DVec3::Y, DVec3::Z) - PI / 2.0).abs() < 1e-15);
        assert!((cosine_power(1.0) - PI).abs() < 1e-15);
    }

    #[test]
    fn far_away_everything_is_area_over_distance_squared() {
        for distance in [1e3, 1e6, 1e8] {
            let rectangle = rectangle_corners(2.0, 3.0, distance);
            let (flat, d2) = (6.0, distance * distance);
            let r = triangle_corners(2.0, 6.0, distance);
            for (got, area) in [
                (polygon(&rectangle), flat),
                (polygon_projected(&rectangle), flat),
                (triangle(r[0], r[1], r[2]), flat),
                (polygon_projected(&r), flat),
                (disk(1.0, distance), PI),
                (disk_projected(1.0, distance), PI),
                (sphere(1.0, distance), PI),
                (sphere_projected(1.0, distance), PI),
            ] {
                // The next term is about (size/distance)².
                assert!((got * d2 / area - 1.0).abs() < 8.0 / d2 + 1e-12, "{distance}: {got}");
            }
        }
    }
}
