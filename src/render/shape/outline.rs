//! Flat outlines: their projected solid angle in closed form, and their cutting into triangles.

use glam::DVec3;

use super::error::ShapeError;
use super::facet::Facet;
use super::rounding::{cross, difference_of_products};

/// Nodes and weights of the Gauss-Legendre rule with five points on [0, 1] (Abramowitz & Stegun, table 25.4).
pub(super) const GAUSS5: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// Outlines seen smaller than this (size over distance) are integrated over their area, see [`projected`].
pub(super) const SMALL: f64 = 0.03;

/// ∫ cosθ⁺ dω of a flat outline seen from `from`, cosθ to `normal`, clipped at the horizon, sr; 0 where it is seen edge-on.
///
/// ```text
/// Ω⊥ = ½ |Σ Γᵢ ĝᵢ · n|,   Γᵢ ĝᵢ = angle between the corners of edge i, along the normal of the plane of edge and eye
/// ```
///
/// after the part below the horizon was cut off (J. H. Lambert, *Photometria*, 1760; D. R. Baum et al., SIGGRAPH 1989). The sum's
/// rounding is some 1e-16 over the angle that the outline is seen under, so a small one (below [`SMALL`]) is integrated as
/// |h| ∫ n·p/p⁴ dA by a rule of degree eight over a fan of triangles, which errs by less than that angle to the ninth power: no more than rounding.
/// The relative error stays near 1e-14 until the outline is seen so slantingly that its two sides cancel.
pub(super) fn projected(
    corners: impl Iterator<Item = DVec3> + Clone,
    facet: &Facet,
    from: DVec3,
    normal: DVec3,
) -> f64 {
    let height = facet.height(from).abs();
    if height == 0.0 {
        return 0.0;
    }
    let above = |visit: &mut dyn FnMut(DVec3)| clip(corners.clone().map(|p| p - from), normal, visit);
    let (mut first, mut size) = (None, 0.0_f64);
    above(&mut |p| {
        let first = *first.get_or_insert(p);
        size = size.max((p - first).length_squared());
    });
    let Some(first) = first else { return 0.0 };
    let mut sum = DVec3::ZERO;
    if size < SMALL * SMALL * first.length_squared() {
        let (mut last, mut small) = (first, 0.0);
        above(&mut |p| {
            small += fan(first, last, p, facet.normal, normal);
            last = p;
        });
        return (height * small).abs();
    }
    let mut last: Option<DVec3> = None;
    above(&mut |p| {
        if let Some(last) = last {
            sum += edge_angle(last, p);
        }
        last = Some(p);
    });
    sum += edge_angle(last.unwrap_or(first), first);
    (0.5 * normal.dot(sum)).abs()
}

/// Angle between two corners along the normal of their plane with the eye.
pub(super) fn edge_angle(a: DVec3, b: DVec3) -> DVec3 {
    let across = cross(a, b - a);
    let length = across.length();
    if length > 0.0 { across * (length.atan2(a.dot(b)) / length) } else { DVec3::ZERO }
}

/// ∫ n·p/p⁴ dA over a triangle, its area signed by `facing`.
fn fan(a: DVec3, b: DVec3, c: DVec3, facing: DVec3, normal: DVec3) -> f64 {
    let doubled = facing.dot(cross(b - a, c - a));
    let mut sum = 0.0;
    for (s, ws) in GAUSS5 {
        for (t, wt) in GAUSS5 {
            // The square folded into the triangle: its far side shrinks to the corner a.
            let p = a + s * ((1.0 - t) * (b - a) + t * (c - a));
            let square = p.length_squared();
            sum += ws * wt * s * (normal.dot(p) / square) / square;
        }
    }
    doubled * sum
}

/// The corners of an outline after the part with n·p < 0 was cut off, one after the other (I. E. Sutherland & G. W. Hodgman 1974).
fn clip(corners: impl Iterator<Item = DVec3> + Clone, normal: DVec3, visit: &mut dyn FnMut(DVec3)) {
    let Some(last) = corners.clone().last() else { return };
    let (mut a, mut height_a) = (last, normal.dot(last));
    for b in corners {
        let height_b = normal.dot(b);
        if (height_a < 0.0 && height_b > 0.0) || (height_a > 0.0 && height_b < 0.0) {
            visit(a + (b - a) * (height_a / (height_a - height_b)));
        }
        if height_b >= 0.0 {
            visit(b);
        }
        (a, height_a) = (b, height_b);
    }
}

/// The plane of an outline: unit normal of its (signed) area, anticlockwise, through its first corner (M. E. Newell's sum).
pub(super) fn plane(what: &'static str, corners: &[DVec3]) -> Result<Facet, ShapeError> {
    let anchor = corners[0];
    let twice: DVec3 = corners[1..].windows(2).map(|w| cross(w[0] - anchor, w[1] - anchor)).sum();
    let largest = twice.abs().max_element();
    let extent = corners.iter().map(|&p| (p - anchor).length_squared()).fold(0.0, f64::max);
    // Below the rounding of the coordinates it is the rounding's area and not the outline's.
    if largest.is_nan() || largest <= 1e-14 * extent {
        return Err(ShapeError::NoArea { what });
    }
    let normal = (twice / largest).normalize();
    Ok(Facet { anchor, normal })
}

/// Fails where a corner is further off the plane than 1e-6 of the outline's extent.
pub(super) fn check_flat(corners: &[DVec3], facet: &Facet) -> Result<(), ShapeError> {
    let extent = corners.iter().map(|&p| (p - facet.anchor).length()).fold(0.0, f64::max);
    let heights = corners.iter().map(|&p| facet.height(p).abs()).enumerate();
    match heights.max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((corner, off)) if off > 1e-6 * extent => Err(ShapeError::NotFlat { corner, off }),
        _ => Ok(()),
    }
}

/// An outline in the two coordinates of its plane that it is largest in, anticlockwise.
struct Flat {
    points: Vec<[f64; 2]>,
}

impl Flat {
    fn new(corners: &[DVec3], facet: &Facet) -> Self {
        let n = facet.normal.abs();
        let points = corners.iter().map(|&p| {
            let p = p - facet.anchor;
            let (pair, sign) = if n.x >= n.y && n.x >= n.z {
                ([p.y, p.z], facet.normal.x)
            } else if n.y >= n.z {
                ([p.z, p.x], facet.normal.y)
            } else {
                ([p.x, p.y], facet.normal.z)
            };
            [pair[0] * sign.signum(), pair[1]]
        });
        Self { points: points.collect() }
    }

    /// Twice the area of three of its points, positive where they turn left.
    fn turn(&self, i: usize, j: usize, k: usize) -> f64 {
        let [a, b, c] = [i, j, k].map(|i| self.points[i]);
        difference_of_products(b[0] - a[0], c[1] - a[1], b[1] - a[1], c[0] - a[0])
    }

    /// Whether point k, on the line through i and j, is between them.
    fn between(&self, i: usize, j: usize, k: usize) -> bool {
        let [a, b, c] = [i, j, k].map(|i| self.points[i]);
        (0..2).all(|x| a[x].min(b[x]) <= c[x] && c[x] <= a[x].max(b[x]))
    }

    /// Whether two edges, given by their ends, have a point in common.
    fn meet(&self, [a, b]: [usize; 2], [c, d]: [usize; 2]) -> bool {
        let (s, t) = (self.turn(a, b, c), self.turn(a, b, d));
        let (u, v) = (self.turn(c, d, a), self.turn(c, d, b));
        let apart = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
        (apart(s, t) && apart(u, v))
            || (s == 0.0 && self.between(a, b, c))
            || (t == 0.0 && self.between(a, b, d))
            || (u == 0.0 && self.between(c, d, a))
            || (v == 0.0 && self.between(c, d, b))
    }
}

/// Fails where an outline meets itself other than at the corners of neighbouring edges.
pub(super) fn check_simple(corners: &[DVec3], facet: &Facet) -> Result<(), ShapeError> {
    let (flat, count) = (Flat::new(corners, facet), corners.len());
    let next = |i: usize| (i + 1) % count;
    for first in 0..count {
        for second in first + 1..count {
            let crossed = if next(first) == second || next(second) == first {
                // Neighbours share a corner; they may not run back over each other.
                let (i, j, k) =
                    if next(first) == second { (first, second, next(second)) } else { (second, first, next(first)) };
                flat.turn(i, j, k) == 0.0 && (flat.between(i, j, k) || flat.between(j, k, i))
            } else {
                flat.meet([first, next(first)], [second, next(second)])
            };
            if crossed {
                return Err(ShapeError::Crossed { first, second });
            }
        }
    }
    Ok(())
}

/// Triangles of a simple outline, as indices of its corners, by cutting off ears (G. H. Meisters 1975); the ear whose
/// smallest side stands highest goes first, so that slivers stay few. Corners on a straight edge make no triangle.
pub(super) fn triangulate(corners: &[DVec3], facet: &Facet) -> Vec<[usize; 3]> {
    let flat = Flat::new(corners, facet);
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::new();
    while left.len() >= 3 {
        let count = left.len();
        let around = |i: usize| [left[(i + count - 1) % count], left[i], left[(i + 1) % count]];
        let is_ear = |i: usize| {
            let [a, b, c] = around(i);
            let blocked = |&&p: &&usize| {
                ![a, b, c].contains(&p)
                    && flat.turn(a, b, p) >= 0.0
                    && flat.turn(b, c, p) >= 0.0
                    && flat.turn(c, a, p) >= 0.0
            };
            flat.turn(a, b, c) > 0.0 && left.iter().find(blocked).is_none()
        };
        // Relative height of the triangle over its longest side.
        let shape = |i: usize| {
            let [a, b, c] = around(i);
            let longest = [(a, b), (b, c), (c, a)].map(|(i, j)| (corners[i] - corners[j]).length_squared());
            flat.turn(a, b, c) / longest.into_iter().fold(0.0, f64::max)
        };
        let straight = (0..count).find(|&i| {
            let [a, b, c] = around(i);
            flat.turn(a, b, c) == 0.0
        });
        let ears = (0..count).filter(|&i| is_ear(i));
        match straight.or_else(|| ears.max_by(|&i, &j| shape(i).total_cmp(&shape(j)))) {
            Some(i) => {
                let [a, b, c] = around(i);
                if straight.is_none() {
                    triangles.push([a, b, c]);
                }
                left.remove(i);
            }
            // A simple outline always has an ear; rounding may hide it where what is left has no area.
            None => break,
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::shape::Shape;
    use crate::render::shape::polygon::Polygon;

    fn points(corners: &[[f64; 3]]) -> Vec<DVec3> {
        corners.iter().copied().map(DVec3::from).collect()
    }

    /// The sum over the edges at 50 digits (mpmath), where nothing cancels; that of the first triangle is also the integral over its area.
    #[test]
    fn polygons_cut_by_the_horizon() {
        let triangle = [[0.3, -0.2, 0.5], [1.5, 0.4, 0.1], [-0.2, 0.9, 0.8]];
        let star = [
            [-0.5, -0.5, 0.75],
            [0.0, -0.25, 0.75],
            [0.5, -0.5, 0.75],
            [0.25, 0.0, 0.75],
            [0.5, 0.5, 0.75],
            [0.0, 0.25, 0.75],
            [-0.5, 0.5, 0.75],
            [-0.25, 0.0, 0.75],
        ];
        let tiny = [[1.0, 0.0, 1.0], [1.0, 1e-8, 1.0], [1.0, 2e-8, 1.0 + 1e-8], [1.0, 0.0, 1.0 + 2e-8]];
        let huge = [[1e8, -1e8, 1.0], [1e8, 1e8, 1.0], [-1e8, 1e8, 1.0], [-1e8, -1e8, 1.0]];
        let small = [[3.0, 0.0, -0.005], [3.0, 0.01, -0.005], [3.0, 0.01, 0.01], [3.0, 0.0, 0.01]];
        let wall = [[2.0, -1.0, -1.0], [2.0, 1.0, -1.0], [2.0, 1.0, 2.0], [2.0, -1.0, 2.0]];
        let cases: [(&[[f64; 3]], [f64; 3], f64); 7] = [
            (&triangle, [0.0, 0.0, 1.0], 0.625_244_238_286_363_1),
            (&triangle, [-1.0, 0.3, 0.2], 0.030_763_116_049_179_435),
            (&wall, [0.1, 0.2, 1.0], 0.278_682_870_610_015_8),
            (&tiny, [1.0, 1.0, 1.0], 7.216_878_317_751_178e-17),
            (&huge, [0.0, 0.6, 0.8], 2.827_433_377_518_424_9),
            (&small, [0.001, 0.0, 1.0], 3.129_576_021_123_853_5e-8),
            (&star, [0.9, 0.2, 0.1], 0.116_126_770_737_916_41),
        ];
        for (corners, normal, expected) in cases {
            let polygon = Polygon::new(points(corners)).unwrap();
            let got = polygon.projected_solid_angle(DVec3::ZERO, DVec3::from(normal).normalize()).unwrap();
            assert!((got / expected - 1.0).abs() < 1e-12, "{corners:?}: {got} {expected}");
        }
        // Seen from 1e-9 m over its plane: the sides, of size 1 each, cancel to 4e-10, and their rounding stays.
        let flat = [[0.5, 0.5, 1e-9], [2.0, 0.5, 1e-9], [2.0, 3.0, 1e-9], [0.5, 3.0, 1e-9]];
        let got = Polygon::new(points(&flat)).unwrap().projected_solid_angle(DVec3::ZERO, DVec3::X).unwrap();
        assert!((got - 4.357_957_209_527_053e-10).abs() < 4.0 * f64::EPSILON, "{got}");
    }

    #[test]
    fn concave_outlines_are_cut_into_their_area() {
        // A comb with collinear corners: seven unit squares.
        let comb = points(&[
            [0.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
            [5.0, 0.0, 0.0],
            [5.0, 2.0, 0.0],
            [4.0, 2.0, 0.0],
            [4.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
        ]);
        let facet = plane("comb", &comb).unwrap();
        check_flat(&comb, &facet).unwrap();
        check_simple(&comb, &facet).unwrap();
        let triangles = triangulate(&comb, &facet);
        let areas = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| comb[i]);
            0.5 * cross(b - a, c - a).dot(facet.normal)
        });
        let areas: Vec<f64> = areas.collect();
        assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f64>(), 7.0);
    }

    #[test]
    fn bad_outlines_are_named() {
        let error = |corners: &[[f64; 3]]| Polygon::new(points(corners)).unwrap_err();
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(error(&[a, b]), ShapeError::TooFew { what: "corners", count: 2, least: 3 });
        assert_eq!(error(&[a, b, b, c]), ShapeError::CornerTwice { corner: 2 });
        assert_eq!(error(&[a, b, c, a]), ShapeError::CornerTwice { corner: 0 });
        assert_eq!(error(&[a, b, [2.0, 0.0, 0.0]]), ShapeError::NoArea { what: "polygon" });
        assert!(matches!(error(&[a, b, c, [0.0, 1.0, 0.1]]), ShapeError::NotFlat { .. }));
        assert_eq!(error(&[a, b, d, [1.5, 1.0, 0.0]]), ShapeError::Crossed { first: 1, second: 3 });
        // An edge that runs back over the one before.
        assert_eq!(error(&[a, b, c, [1.0, 0.5, 0.0], d]), ShapeError::Crossed { first: 1, second: 2 });
        assert_eq!(error(&[a, b, [f64::NAN, 0.0, 0.0]]), ShapeError::NotFinite { what: "corner" });
    }
}
