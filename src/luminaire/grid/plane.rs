//! Rectangles in the room with a regular grid of points.

use glam::DVec3;

use super::Error;

/// Most points of one grid: beyond it lies a mistyped step, not a calculation.
pub const MOST_POINTS: usize = 4_000_000;
/// How far from a right angle the sides may be (cosine of the angle between them).
const SQUARE: f64 = 1e-6;

/// Where the points of a grid lie in its cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PointsAt {
    /// In the middle of equal cells: the mean over the points is the mean over the area (EN 12464-1, EN 13201-3).
    Centres,
    /// On the corners of the cells, the edges of the plane included.
    Nodes,
}

/// A rectangle with points in rows along its first side.
///
/// Point `row * columns + column` is the `column`-th along the first side u and the `row`-th along the second side v. The
/// normal is u × v: a floor with u along +x and v along +y looks up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    origin_m: DVec3,
    side_u_m: DVec3,
    side_v_m: DVec3,
    columns: usize,
    rows: usize,
    at: PointsAt,
}

impl Plane {
    /// A rectangle from its first corner along two sides, m, with `columns` × `rows` points.
    ///
    /// # Errors
    /// [`Error::Sides`], [`Error::Count`], [`Error::TooManyPoints`].
    pub fn new(
        origin_m: DVec3,
        [side_u_m, side_v_m]: [DVec3; 2],
        [columns, rows]: [usize; 2],
        at: PointsAt,
    ) -> Result<Self, Error> {
        let (u, v) = (side_u_m.length(), side_v_m.length());
        let sound = origin_m.is_finite() && u.is_finite() && v.is_finite() && u > 0.0 && v > 0.0;
        if !sound || (side_u_m / u).dot(side_v_m / v).abs() > SQUARE {
            return Err(Error::Sides);
        }
        let least = if at == PointsAt::Nodes { 2 } else { 1 };
        if columns < least || rows < least {
            return Err(Error::Count { found: [columns, rows], least });
        }
        if columns.checked_mul(rows).is_none_or(|n| n > MOST_POINTS) {
            return Err(Error::TooManyPoints { columns: columns as f64, rows: rows as f64 });
        }
        Ok(Self { origin_m, side_u_m, side_v_m, columns, rows, at })
    }

    /// A rectangle with points no more than `step_m` apart along either side.
    ///
    /// # Errors
    /// [`Error::Step`], and those of [`Plane::new`].
    pub fn with_step(origin_m: DVec3, sides_m: [DVec3; 2], step_m: f64, at: PointsAt) -> Result<Self, Error> {
        if !(step_m.is_finite() && step_m > 0.0) {
            return Err(Error::Step { found: step_m });
        }
        // A whole number of steps is not made one more by the last digit of the division.
        let cells = sides_m.map(|side| (side.length() / step_m - 1e-9).ceil().max(1.0));
        let points = cells.map(|n| if at == PointsAt::Nodes { n + 1.0 } else { n });
        if points[0] * points[1] > MOST_POINTS as f64 {
            return Err(Error::TooManyPoints { columns: points[0], rows: points[1] });
        }
        Self::new(origin_m, sides_m, points.map(|n| n as usize), at)
    }

    /// The same rectangle with points no more than `step_m` apart.
    ///
    /// # Errors
    /// [`Error::Step`], [`Error::TooManyPoints`].
    pub fn stepped(&self, step_m: f64) -> Result<Self, Error> {
        Self::with_step(self.origin_m, [self.side_u_m, self.side_v_m], step_m, self.at)
    }

    /// First corner, m.
    #[must_use]
    pub fn origin_m(&self) -> DVec3 {
        self.origin_m
    }

    /// Directions of the sides u and v (unit vectors).
    #[must_use]
    pub fn axes(&self) -> [DVec3; 2] {
        [self.side_u_m.normalize(), self.side_v_m.normalize()]
    }

    /// The unit vector u × v.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.side_u_m.cross(self.side_v_m).normalize()
    }

    /// Lengths of the sides, m.
    #[must_use]
    pub fn size_m(&self) -> [f64; 2] {
        [self.side_u_m.length(), self.side_v_m.length()]
    }

    /// Points along u and along v.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Never: a plane has a point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Where the points lie in the cells.
    #[must_use]
    pub fn points_at(&self) -> PointsAt {
        self.at
    }

    /// Distances between neighbouring points along u and v, m.
    #[must_use]
    pub fn spacing_m(&self) -> [f64; 2] {
        let cells = |n: usize| if self.at == PointsAt::Nodes { n - 1 } else { n } as f64;
        let [u, v] = self.size_m();
        [u / cells(self.columns), v / cells(self.rows)]
    }

    /// Share of a side before the point of an index.
    fn share(&self, index: usize, count: usize) -> f64 {
        match self.at {
            PointsAt::Centres => (index as f64 + 0.5) / count as f64,
            PointsAt::Nodes => index as f64 / (count - 1) as f64,
        }
    }

    /// A point by its index, m.
    #[must_use]
    pub fn point_m(&self, index: usize) -> DVec3 {
        let (column, row) = (index % self.columns, index / self.columns);
        self.origin_m + self.side_u_m * self.share(column, self.columns) + self.side_v_m * self.share(row, self.rows)
    }

    /// Distances of the columns from the first corner along u, m.
    #[must_use]
    pub fn u_m(&self) -> Vec<f64> {
        let length = self.side_u_m.length();
        (0..self.columns).map(|i| length * self.share(i, self.columns)).collect()
    }

    /// Distances of the rows from the first corner along v, m.
    #[must_use]
    pub fn v_m(&self) -> Vec<f64> {
        let length = self.side_v_m.length();
        (0..self.rows).map(|i| length * self.share(i, self.rows)).collect()
    }
}

/// Largest distance between grid points that EN 12464-1 allows for an area with sides of `a_m` and `b_m`:
/// `p = 0.2 · 5^(log₁₀ d)`, at most 10 m, with d the longer side, or the shorter one where the longer is twice as long or more.
///
/// # Reference
/// EN 12464-1, illuminance grid, as Fagerhult ("Number of calculation points", with the table of examples) and Esse-ci ("Griglie di
/// calcolo", with the rule for long areas, from EN 12193) print it; the standard itself was not at hand.
#[must_use]
pub fn standard_step_m(a_m: f64, b_m: f64) -> f64 {
    let (short, long) = (a_m.min(b_m), a_m.max(b_m));
    let d = if long < 2.0 * short { long } else { short };
    (0.2 * 5f64.powf(d.log10())).min(10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_fill_the_rectangle() {
        let sides = [DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0)];
        let p = Plane::with_step(DVec3::new(1.0, 1.0, 0.5), sides, 1.0, PointsAt::Centres).expect("a plane");
        assert_eq!((p.counts(), p.len(), p.spacing_m()), ([4, 2], 8, [1.0, 1.0]));
        assert_eq!(p.point_m(0), DVec3::new(1.5, 1.5, 0.5));
        assert_eq!(p.point_m(7), DVec3::new(4.5, 2.5, 0.5));
        assert_eq!(p.normal(), DVec3::Z);
        let n = Plane::with_step(DVec3::ZERO, sides, 1.0, PointsAt::Nodes).expect("a plane");
        assert_eq!((n.counts(), n.point_m(n.len() - 1)), ([5, 3], DVec3::new(4.0, 2.0, 0.0)));
        // Ten steps of a tenth are ten steps.
        let tenths = Plane::with_step(DVec3::ZERO, [DVec3::X, DVec3::Y], 0.1, PointsAt::Centres).expect("a plane");
        assert_eq!(tenths.counts(), [10, 10]);
    }

    #[test]
    fn what_is_no_grid_is_refused() {
        let sides = [DVec3::X, DVec3::Y];
        let skewed = [DVec3::X, DVec3::new(0.1, 1.0, 0.0)];
        let new = |sides, counts| Plane::new(DVec3::ZERO, sides, counts, PointsAt::Centres).expect_err("no plane");
        assert_eq!(new(skewed, [2, 2]), Error::Sides);
        assert_eq!(new([DVec3::ZERO, DVec3::Y], [2, 2]), Error::Sides);
        assert_eq!(new(sides, [0, 2]), Error::Count { found: [0, 2], least: 1 });
        assert!(matches!(new(sides, [usize::MAX, 2]), Error::TooManyPoints { .. }));
        let step = |step| Plane::with_step(DVec3::ZERO, sides, step, PointsAt::Centres).expect_err("no plane");
        assert!(matches!(step(1e-9), Error::TooManyPoints { .. }));
        assert_eq!(step(0.0), Error::Step { found: 0.0 });
    }

    #[test]
    fn the_standard_step_is_that_of_en_12464_1_table_a1() {
        // The table of EN 12464-1 as Fagerhult prints it: length of area, distance, one digit. Left out are its rows of 0.40 m
        // (0.15 m) and 0.60 m (0.20 m): three points at least decide there, not the formula, which gives 0.11 m and 0.14 m.
        for (d, printed) in
            [(1.0, "2e-1"), (2.0, "3e-1"), (5.0, "6e-1"), (10.0, "1e0"), (25.0, "2e0"), (50.0, "3e0"), (100.0, "5e0")]
        {
            assert_eq!(format!("{:.0e}", standard_step_m(d, d)), printed, "{d} m");
        }
        assert_eq!(standard_step_m(10.0, 100.0), standard_step_m(10.0, 10.0));
    }
}
