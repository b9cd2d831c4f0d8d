//! Cutting lines and polygons to a rectangle.

use super::sheet::{Point, Rect};

/// The parts of a line through points that lie within `r`.
pub(super) fn line(points: &[Point], r: Rect) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    for pair in points.windows(2) {
        let Some((a, b)) = segment(pair[0], pair[1], r) else { continue };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&a) => part.push(b),
            _ => parts.push(vec![a, b]),
        }
    }
    parts
}

/// The part of the segment from `a` to `b` within `r` (Liang and Barsky 1984).
fn segment(a: Point, b: Point, r: Rect) -> Option<(Point, Point)> {
    if ![a.0, a.1, b.0, b.1].iter().all(|v| v.is_finite()) {
        return None;
    }
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut t0, mut t1) = (0.0f64, 1.0f64);
    for (p, q) in [(-dx, a.0 - r.x0), (dx, r.x1 - a.0), (-dy, a.1 - r.y0), (dy, r.y1 - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else {
            t1 = t1.min(q / p);
        }
    }
    if t0 > t1 {
        return None;
    }
    let at = |t: f64| if t == 0.0 { a } else { (a.0 + t * dx, a.1 + t * dy) };
    Some((at(t0), if t1 == 1.0 { b } else { at(t1) }))
}

/// The polygon within `r` (Sutherland and Hodgman 1974).
pub(super) fn polygon(points: &[Point], r: Rect) -> Vec<Point> {
    let mut out: Vec<Point> = points.to_vec();
    let sides: [fn(Point, Rect) -> f64; 4] =
        [|p, r| p.0 - r.x0, |p, r| r.x1 - p.0, |p, r| p.1 - r.y0, |p, r| r.y1 - p.1];
    for inside in sides {
        let input = std::mem::take(&mut out);
        for (i, &b) in input.iter().enumerate() {
            let a = input[(i + input.len() - 1) % input.len()];
            let (da, db) = (inside(a, r), inside(b, r));
            if (da < 0.0) != (db < 0.0) {
                let t = da / (da - db);
                out.push((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)));
            }
            if db >= 0.0 {
                out.push(b);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_where_it_leaves() {
        let r = Rect::new(0.0, 0.0, 10.0, 10.0);
        let parts = line(&[(-5.0, 5.0), (5.0, 5.0), (5.0, 20.0), (8.0, 20.0), (8.0, 5.0)], r);
        assert_eq!(parts, [vec![(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)], vec![(8.0, 10.0), (8.0, 5.0)]]);
        assert!(line(&[(f64::NAN, 0.0), (1.0, 1.0)], r).is_empty());
    }

    #[test]
    fn a_polygon_is_cut_to_the_rectangle() {
        let cut = polygon(&[(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)], Rect::new(0.0, 0.0, 10.0, 10.0));
        let area: f64 =
            (0..cut.len()).map(|i| (cut[i], cut[(i + 1) % cut.len()])).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum();
        assert!((area / 2.0 - 25.0).abs() < 1e-12, "{cut:?}");
    }
}
