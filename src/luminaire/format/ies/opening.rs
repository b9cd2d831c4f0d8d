//! The luminous opening: three signed dimensions, and what each edition means by the signs.
//!
//! LM-63 measures the *length* along the photometric horizontal, the direction of C0 (the "horizontal cylinder along
//! photometric horizontal" has it as axis; a linear lamp's C0 plane runs along the lamp), the *width* along C90, the height
//! upwards. EULUMDAT does it the other way round: its length lies along C90–C270. [`Body`] goes by direction.
//!
//! | signs of width, length, height | 1986, 1991, 1995 | 2002, 2019 |
//! |---|---|---|
//! | 0 0 0 | point | point |
//! | + + 0, + + + | rectangle, box | rectangle, box |
//! | − 0 0, − 0 + | circle, upright cylinder of the width's diameter | — |
//! | − 0 − | sphere | upright circle or ellipse facing C0 |
//! | 0 + − | cylinder along the length | — |
//! | + 0 − | cylinder along the width | — |
//! | − + +, + − + | ellipse with height | — |
//! | − + −, + − − | ellipsoid | cylinder along the length, along the width |
//! | − − 0, − − + | — | circle or ellipse, upright cylinder |
//! | − − − | — | sphere or ellipsoid |
//!
//! A file whose signs are not in its own edition's column is read by the other's, and a finding says so.

use super::Version;
use crate::luminaire::{Body, Shape};

/// An opening and whether its signs are those of the edition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Opening {
    pub(super) body: Body,
    pub(super) own_edition: bool,
}

/// The opening that width, length and height mean (in metres or any other unit); `None` where they mean nothing.
pub(super) fn opening(version: Version, dimensions: [f64; 3]) -> Option<Opening> {
    let modern = version >= Version::Lm63_2002;
    let body = if modern { signs_2002(dimensions) } else { signs_1986(dimensions) };
    if let Some(body) = body {
        return Some(Opening { body, own_edition: true });
    }
    let body = if modern { signs_1986(dimensions) } else { signs_2002(dimensions) };
    body.map(|body| Opening { body, own_edition: false })
}

fn signs([w, l, h]: [f64; 3]) -> (i8, i8, i8) {
    let sign = |v: f64| if v > 0.0 { 1 } else { -i8::from(v < 0.0) };
    (sign(w), sign(l), sign(h))
}

/// Width along y, length along x.
fn body(shape: Shape, width: f64, length: f64, height: f64) -> Body {
    Body { shape, length_m: width.abs(), width_m: length.abs(), height_m: height.abs() }
}

fn common(dimensions: [f64; 3]) -> Option<Body> {
    let [w, l, h] = dimensions;
    match signs(dimensions) {
        (0, 0, 0) => Some(body(Shape::Point, 0.0, 0.0, 0.0)),
        // A rectangle standing upright, or a line, has one dimension of zero.
        (0 | 1, 0 | 1, 0 | 1) => Some(body(Shape::Rectangle, w, l, h)),
        _ => None,
    }
}

fn signs_1986(dimensions: [f64; 3]) -> Option<Body> {
    let [w, l, h] = dimensions;
    common(dimensions).or(match signs(dimensions) {
        (-1, 0, 0 | 1) => Some(body(Shape::Round, w, w, h)),
        (-1, 0, -1) => Some(body(Shape::Sphere, w, w, h)),
        (0, 1, -1) => Some(body(Shape::CylinderAlongC0, h, l, h)),
        (1, 0, -1) => Some(body(Shape::CylinderAlongC90, w, h, h)),
        (-1, 1, 0 | 1) | (1, -1, 0 | 1) => Some(body(Shape::Round, w, l, h)),
        (-1, 1, -1) | (1, -1, -1) => Some(body(Shape::Sphere, w, l, h)),
        _ => None,
    })
}

fn signs_2002(dimensions: [f64; 3]) -> Option<Body> {
    let [w, l, h] = dimensions;
    common(dimensions).or(match signs(dimensions) {
        (-1, -1, 0 | 1) => Some(body(Shape::Round, w, l, h)),
        (-1, -1, -1) => Some(body(Shape::Sphere, w, l, h)),
        (-1, 1, -1) => Some(body(Shape::CylinderAlongC0, w, l, h)),
        (1, -1, -1) => Some(body(Shape::CylinderAlongC90, w, l, h)),
        (-1, 0, -1) => Some(body(Shape::Round, w, 0.0, h)),
        _ => None,
    })
}

/// Width, length and height with the signs of an edition; the flag says whether the edition has a sign for the shape.
pub(super) fn dimensions(version: Version, body: &Body) -> ([f64; 3], bool) {
    let (w, l, h) = (body.length_m, body.width_m, body.height_m);
    let modern = version >= Version::Lm63_2002;
    let equal = |a: f64, b: f64| (a - b).abs() <= 1e-6 * (a + b);
    match body.shape {
        Shape::Point => ([0.0; 3], true),
        Shape::Rectangle => ([w, l, h], true),
        Shape::Round if modern => {
            ([-w, if l == 0.0 && h > 0.0 { 0.0 } else { -l }, if l == 0.0 { -h } else { h }], true)
        }
        Shape::Round if equal(w, l) => ([-w, 0.0, h], true),
        // An upright disc has no sign before 2002.
        Shape::Round if l == 0.0 => ([w, l, h], false),
        Shape::Round => (if w < l { [-w, l, h] } else { [w, -l, h] }, true),
        Shape::Sphere if modern => ([-w, -l, -h], true),
        Shape::Sphere if equal(w, l) && equal(w, h) => ([-w, 0.0, -h], true),
        Shape::Sphere => (if w < l { [-w, l, -h] } else { [w, -l, -h] }, true),
        Shape::CylinderAlongC0 if modern => ([-w, l, -h], true),
        Shape::CylinderAlongC90 if modern => ([w, -l, -h], true),
        // Before 2002 a lying cylinder is round.
        Shape::CylinderAlongC0 => ([0.0, l, -h], equal(w, h)),
        Shape::CylinderAlongC90 => ([w, 0.0, -h], equal(l, h)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_both_conventions() {
        let read = |version, dims| opening(version, dims).map(|o| (o.body.shape, o.own_edition));
        let (old, new) = (Version::Lm63_1995, Version::Lm63_2002);
        for (dims, before, after) in [
            ([0.0, 0.0, 0.0], (Shape::Point, true), (Shape::Point, true)),
            ([1.0, 2.0, 0.0], (Shape::Rectangle, true), (Shape::Rectangle, true)),
            ([-1.0, 0.0, 0.0], (Shape::Round, true), (Shape::Round, false)),
            ([-1.0, -1.0, 0.0], (Shape::Round, false), (Shape::Round, true)),
            ([-1.0, -1.0, -1.0], (Shape::Sphere, false), (Shape::Sphere, true)),
            ([-1.0, 0.0, -1.0], (Shape::Sphere, true), (Shape::Round, true)),
            ([-1.0, 2.0, -1.0], (Shape::Sphere, true), (Shape::CylinderAlongC0, true)),
            ([0.0, 2.0, -1.0], (Shape::CylinderAlongC0, true), (Shape::CylinderAlongC0, false)),
        ] {
            assert_eq!(read(old, dims), Some(before), "{dims:?}");
            assert_eq!(read(new, dims), Some(after), "{dims:?}");
        }
        assert_eq!(read(new, [0.0, -1.0, 0.0]), None);
        let lamp = opening(old, [0.0, 1.2, -0.026]).expect("a tube").body;
        assert_eq!((lamp.width_m, lamp.length_m, lamp.height_m), (1.2, 0.026, 0.026));
    }

    #[test]
    fn what_is_written_is_read_back() {
        for version in Version::ALL {
            for shape in [
                Shape::Point,
                Shape::Rectangle,
                Shape::Round,
                Shape::Sphere,
                Shape::CylinderAlongC0,
                Shape::CylinderAlongC90,
            ] {
                for (width_m, length_m, height_m) in [(0.5, 0.5, 0.5), (1.2, 0.1, 0.1), (0.1, 1.2, 0.1)] {
                    let given = match shape {
                        Shape::Point => Body { shape, width_m: 0.0, length_m: 0.0, height_m: 0.0 },
                        _ => Body { shape, width_m, length_m, height_m },
                    };
                    // Before 2002 a lying cylinder is round.
                    let oval = match shape {
                        Shape::CylinderAlongC0 => length_m != height_m,
                        Shape::CylinderAlongC90 => width_m != height_m,
                        _ => false,
                    };
                    let (signed, carried) = dimensions(version, &given);
                    assert_eq!(carried, version >= Version::Lm63_2002 || !oval, "{version} {given:?}");
                    if !carried {
                        continue;
                    }
                    let back = opening(version, signed).expect("an opening");
                    assert_eq!((back.body, back.own_edition), (given, true), "{version} {signed:?}");
                }
            }
        }
    }
}
