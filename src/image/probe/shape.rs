//! Which pixels a shape holds: those whose centres lie in it.
//!
//! Places are in pixels from the upper left corner of the image: pixel (column i, row j) covers i to i + 1 and j to j + 1, its
//! centre is at (i + ½, j + ½). So a rectangle and the polygon of its corners hold the same pixels, and polygons that share an
//! edge share no pixel.

use std::fmt;
use std::ops::Range;

use super::view::View;
use crate::image::Region;

/// A part of an image.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// One pixel: column and row.
    Pixel(usize, usize),
    /// Whole pixels.
    Rectangle(Region),
    /// Corners in order; where the outline crosses itself, even-odd.
    Polygon(Vec<(f64, f64)>),
    /// A circle in the picture.
    Circle {
        /// Its middle.
        centre: (f64, f64),
        /// Its radius, pixels.
        radius_px: f64,
    },
    /// The acceptance cone of a luminance meter that stands where the camera does.
    Spot {
        /// Where its axis meets the picture.
        centre: (f64, f64),
        /// Its full opening angle, degrees.
        diameter_deg: f64,
        /// The camera.
        view: View,
    },
}

/// Why a shape holds no pixels.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// It reaches beyond the image.
    #[error("the {shape} reaches beyond the image of {width} × {height} pixels; expected one inside it")]
    Beyond {
        /// The shape.
        shape: String,
        /// Columns of the image.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// No pixel's centre lies in it.
    #[error(
        "no pixel's centre lies in the {shape}; expected a larger one (pixel x, y has its centre at x + 0.5, y + 0.5)"
    )]
    Empty {
        /// The shape.
        shape: String,
    },
    /// It is not a shape.
    #[error("found {found}; expected {expected}")]
    Degenerate {
        /// What it is.
        found: String,
        /// What it would be.
        expected: &'static str,
    },
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pixel(x, y) => write!(f, "pixel {x}, {y}"),
            Self::Rectangle(r) => write!(f, "rectangle of {} × {} pixels at {}, {}", r.width, r.height, r.x, r.y),
            Self::Polygon(corners) => write!(f, "polygon of {} corners", corners.len()),
            Self::Circle { centre: (x, y), radius_px } => {
                write!(f, "circle of radius {radius_px} pixels about {x}, {y}")
            }
            Self::Spot { centre: (x, y), diameter_deg, .. } => write!(f, "spot of {diameter_deg}° about {x}, {y}"),
        }
    }
}

impl Shape {
    /// The word for its kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Pixel(..) => "pixel",
            Self::Rectangle(_) => "rectangle",
            Self::Polygon(_) => "polygon",
            Self::Circle { .. } => "circle",
            Self::Spot { .. } => "spot",
        }
    }

    /// The weight of a pixel in a mean: its solid angle in sr for a spot, as a meter sees it; 1 for all else.
    #[must_use]
    pub fn weight(&self, x: usize, y: usize) -> f64 {
        match self {
            Self::Spot { view, .. } => view.solid_angle(x as f64 + 0.5, y as f64 + 0.5),
            _ => 1.0,
        }
    }

    /// The pixels held, in an image of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`ShapeError`] where the shape reaches beyond the image, or holds none.
    pub fn pixels(&self, width: usize, height: usize) -> Result<Pixels, ShapeError> {
        self.check(width, height)?;
        let bounds = self.bounds(width, height);
        let mut spans = Vec::new();
        for y in bounds.y..bounds.y + bounds.height {
            let mut row = self.row(y, bounds.x..bounds.x + bounds.width);
            row.retain(|span| !span.is_empty());
            spans.extend(row.into_iter().map(|span| (y, span)));
        }
        let (Some(first), Some(last)) = (spans.first(), spans.last()) else {
            return Err(ShapeError::Empty { shape: self.to_string() });
        };
        let (top, bottom) = (first.0, last.0 + 1);
        let left = spans.iter().map(|(_, s)| s.start).min().unwrap_or(0);
        let right = spans.iter().map(|(_, s)| s.end).max().unwrap_or(0);
        Ok(Pixels { bounds: Region { x: left, y: top, width: right - left, height: bottom - top }, spans })
    }

    fn check(&self, width: usize, height: usize) -> Result<(), ShapeError> {
        let (w, h) = (width as f64, height as f64);
        let degenerate = |found: String, expected| Err(ShapeError::Degenerate { found, expected });
        let inside = match self {
            Self::Pixel(x, y) => *x < width && *y < height,
            Self::Rectangle(r) if r.width == 0 || r.height == 0 => {
                return degenerate(format!("a {self}"), "one with a width and a height");
            }
            Self::Rectangle(r) => {
                r.x.checked_add(r.width).is_some_and(|x| x <= width)
                    && r.y.checked_add(r.height).is_some_and(|y| y <= height)
            }
            Self::Polygon(corners) if corners.len() < 3 => return degenerate(format!("a {self}"), "at least three"),
            Self::Polygon(corners) => corners.iter().all(|(x, y)| (0.0..=w).contains(x) && (0.0..=h).contains(y)),
            Self::Circle { radius_px, .. } if *radius_px <= 0.0 || !radius_px.is_finite() => {
                return degenerate(format!("a {self}"), "a radius above 0");
            }
            Self::Circle { centre: (x, y), radius_px: r } => (*r..=w - r).contains(x) && (*r..=h - r).contains(y),
            Self::Spot { diameter_deg, .. } if !(*diameter_deg > 0.0 && *diameter_deg < 180.0) => {
                return degenerate(format!("a {self}"), "an angle above 0° and below 180°");
            }
            Self::Spot { centre: (x, y), .. } => {
                // Pixels just outside of the image, were there any, would belong to it.
                let across = (0..=width + 1).flat_map(|i| [(i as f64 - 0.5, -0.5), (i as f64 - 0.5, h + 0.5)]);
                let along = (0..height).flat_map(|j| [(-0.5, j as f64 + 0.5), (w + 0.5, j as f64 + 0.5)]);
                (0.0..=w).contains(x) && (0.0..=h).contains(y) && !across.chain(along).any(|(x, y)| self.contains(x, y))
            }
        };
        if inside { Ok(()) } else { Err(ShapeError::Beyond { shape: self.to_string(), width, height }) }
    }

    /// Rows and columns outside of which there are no pixels of it.
    fn bounds(&self, width: usize, height: usize) -> Region {
        let whole = Region { x: 0, y: 0, width, height };
        let around = |x0: f64, y0: f64, x1: f64, y1: f64| {
            let (x, right) = (floor(x0).min(width), floor(x1.ceil()).min(width));
            let (y, bottom) = (floor(y0).min(height), floor(y1.ceil()).min(height));
            Region { x, y, width: right.saturating_sub(x), height: bottom.saturating_sub(y) }
        };
        match self {
            Self::Pixel(x, y) => Region { x: *x, y: *y, width: 1, height: 1 },
            Self::Rectangle(r) => *r,
            Self::Polygon(corners) => {
                let ends = |v: fn(&(f64, f64)) -> f64| {
                    let all = corners.iter().map(v);
                    (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max))
                };
                let ((x0, x1), (y0, y1)) = (ends(|c| c.0), ends(|c| c.1));
                around(x0, y0, x1, y1)
            }
            Self::Circle { centre: (x, y), radius_px: r } => around(x - r, y - r, x + r, y + r),
            Self::Spot { .. } => whole,
        }
    }

    /// Whether a place lies in a circle or spot.
    fn contains(&self, x: f64, y: f64) -> bool {
        match self {
            Self::Circle { centre, radius_px } => (x - centre.0).hypot(y - centre.1) <= *radius_px,
            Self::Spot { centre, diameter_deg, view } => {
                // The chord between two directions is 2 sin(angle / 2), which is precise for small angles.
                let chord = view.direction(x, y).distance(view.direction(centre.0, centre.1));
                view.sees(x, y) && chord <= 2.0 * (0.25 * diameter_deg).to_radians().sin()
            }
            _ => true,
        }
    }

    /// The pixels of one row, among the columns given.
    fn row(&self, y: usize, columns: Range<usize>) -> Vec<Range<usize>> {
        let middle = y as f64 + 0.5;
        match self {
            Self::Pixel(..) | Self::Rectangle(_) => vec![columns],
            Self::Polygon(corners) => {
                let edges = corners.iter().zip(corners.iter().cycle().skip(1));
                let mut crossings: Vec<f64> = edges
                    .filter(|(a, b)| (a.1 <= middle) != (b.1 <= middle))
                    // Always from the upper end, so that neighbours with a common edge cross it at the same place to the bit.
                    .map(|(a, b)| if a.1 < b.1 { (a, b) } else { (b, a) })
                    .map(|(a, b)| a.0 + (middle - a.1) / (b.1 - a.1) * (b.0 - a.0))
                    .collect();
                crossings.sort_by(f64::total_cmp);
                // A centre on the left edge is inside, one on the right edge is not.
                let first = |x: f64| floor((x - 0.5).ceil()).clamp(columns.start, columns.end);
                crossings.chunks_exact(2).map(|pair| first(pair[0])..first(pair[1])).collect()
            }
            Self::Circle { .. } | Self::Spot { .. } => {
                let mut spans: Vec<Range<usize>> = Vec::new();
                for x in columns.filter(|x| self.contains(*x as f64 + 0.5, middle)) {
                    match spans.last_mut() {
                        Some(last) if last.end == x => last.end += 1,
                        _ => spans.push(x..x + 1),
                    }
                }
                spans
            }
        }
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "negative places become 0")]
fn floor(v: f64) -> usize {
    v.max(0.0) as usize
}

/// The pixels of a shape, as runs within rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Pixels {
    bounds: Region,
    /// Row and columns, from the top and from the left.
    spans: Vec<(usize, Range<usize>)>,
}

impl Pixels {
    /// The smallest rectangle around them.
    #[must_use]
    pub fn bounds(&self) -> Region {
        self.bounds
    }

    /// Row and columns of each run, from the top and from the left.
    #[must_use]
    pub fn spans(&self) -> &[(usize, Range<usize>)] {
        &self.spans
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.spans.iter().map(|(_, s)| s.len() as u64).sum()
    }

    /// The runs within a part of the image.
    pub fn within(&self, part: Region) -> impl Iterator<Item = (usize, Range<usize>)> + '_ {
        let from = self.spans.partition_point(|(y, _)| *y < part.y);
        let rows = self.spans[from..].iter().take_while(move |(y, _)| *y < part.y + part.height);
        rows.map(move |(y, s)| (*y, s.start.max(part.x)..s.end.min(part.x + part.width))).filter(|(_, s)| !s.is_empty())
    }
}
