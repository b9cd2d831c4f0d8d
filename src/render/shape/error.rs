//! What is wrong with the measures of a shape.

use glam::DVec3;

/// Why a shape cannot be made of what was given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A coordinate or measure is infinite or no number.
    #[error("{what} is not finite")]
    NotFinite {
        /// The measure.
        what: &'static str,
    },
    /// A measure must be greater than zero.
    #[error("{what} is {value} m; expected more than 0 m")]
    NotPositive {
        /// The measure.
        what: &'static str,
        /// Its value, m.
        value: f64,
    },
    /// A direction has no length.
    #[error("{what} is the zero vector; expected a direction")]
    NoDirection {
        /// The direction.
        what: &'static str,
    },
    /// The inner radius of an annulus is negative or not below the outer one.
    #[error("inner radius is {inner} m; expected at least 0 m and less than the radius, {outer} m")]
    InnerRadius {
        /// Inner radius, m.
        inner: f64,
        /// Outer radius, m.
        outer: f64,
    },
    /// Corners or edges span no area.
    #[error("{what} has no area: its corners are on one line or coincide")]
    NoArea {
        /// The shape or face.
        what: &'static str,
    },
    /// A face of fewer than three corners, or a solid of fewer than four faces.
    #[error("{count} {what}; expected at least {least}")]
    TooFew {
        /// Corners or faces.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there must be.
        least: usize,
    },
    /// Two corners in a row coincide.
    #[error("corner {corner} (from 0) coincides with the one before it")]
    CornerTwice {
        /// Index of the second.
        corner: usize,
    },
    /// The corners are not in one plane.
    #[error("corner {corner} (from 0) is {off} m off the plane of the others; expected a flat face")]
    NotFlat {
        /// The corner furthest off.
        corner: usize,
        /// Its distance from the plane, m.
        off: f64,
    },
    /// The outline crosses or touches itself.
    #[error("edges {first} and {second} (from 0) meet; expected an outline that does not cross itself")]
    Crossed {
        /// Index of an edge, that of its first corner.
        first: usize,
        /// Index of the other.
        second: usize,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} (from 0) names vertex {vertex}; expected 0 to {last}")]
    NoVertex {
        /// Index of the face.
        face: usize,
        /// The index that it names.
        vertex: usize,
        /// The greatest index there is.
        last: usize,
    },
    /// What is wrong with one face of a polyhedron.
    #[error("face {face} (from 0): {error}")]
    Face {
        /// Index of the face.
        face: usize,
        /// What is wrong.
        error: Box<ShapeError>,
    },
    /// An edge of a polyhedron is not shared by two faces that run along it in opposite directions.
    #[error(
        "the edge from vertex {from} to {to} has {back} faces against it; expected one: faces must close the solid and all be \
        anticlockwise from outside"
    )]
    Open {
        /// Index of a vertex.
        from: usize,
        /// Index of the next.
        to: usize,
        /// Number of faces that have the edge the other way round.
        back: usize,
    },
    /// The faces of a polyhedron are clockwise from outside.
    #[error(
        "the volume is {volume} m³; expected more than 0 m³: turn the order of every face round, anticlockwise from outside"
    )]
    InsideOut {
        /// Signed volume, m³.
        volume: f64,
    },
}

/// The measure, if it is finite and positive.
pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, ShapeError> {
    if !value.is_finite() {
        return Err(ShapeError::NotFinite { what });
    }
    if value > 0.0 { Ok(value) } else { Err(ShapeError::NotPositive { what, value }) }
}

/// The point or vector, if it is finite.
pub(super) fn finite(what: &'static str, value: DVec3) -> Result<DVec3, ShapeError> {
    if value.is_finite() { Ok(value) } else { Err(ShapeError::NotFinite { what }) }
}

/// The unit vector of a direction of any length but 0.
pub(super) fn direction(what: &'static str, value: DVec3) -> Result<DVec3, ShapeError> {
    // Scaled first: the square of a small or large length would leave the range of numbers.
    let largest = finite(what, value)?.abs().max_element();
    if largest > 0.0 { Ok((value / largest).normalize()) } else { Err(ShapeError::NoDirection { what }) }
}
