//! Lines of equal value over a rectangular grid (marching squares).

/// The lines on which a field sampled on a grid takes the value `level`, as open or closed polylines in the grid's own
/// coordinates; a closed one ends where it begins.
///
/// `values` is row by row: `values[row * x.len() + column]` belongs to (`x[column]`, `y[row]`); both axes ascend. The field is
/// linear along the edges of the cells, so a line crosses an edge where linear interpolation meets the level. A saddle is
/// parted by the mean of its corners. A value equal to the level counts as above. Cells with a NaN corner are left out, and
/// lines end there.
///
/// # Panics
/// Where `values` is not `x.len() × y.len()`.
///
/// # Reference
/// W. E. Lorensen, H. E. Cline, "Marching cubes", SIGGRAPH 1987, in two dimensions; the mean of the corners as in G. M. Nielson,
/// B. Hamann, "The asymptotic decider", IEEE Visualization 1991.
#[must_use]
pub fn contours(x: &[f64], y: &[f64], values: &[f64], level: f64) -> Vec<Vec<(f64, f64)>> {
    assert_eq!(values.len(), x.len() * y.len(), "one value per point of the grid");
    let mut pieces = Pieces::default();
    for row in 0..y.len().saturating_sub(1) {
        for column in 0..x.len().saturating_sub(1) {
            cell(x.len(), values, level, (column, row), &mut pieces);
        }
    }
    let place = |edge: Edge| {
        let ((c0, r0), (c1, r1)) = edge.ends();
        let (a, b) = (values[r0 * x.len() + c0], values[r1 * x.len() + c1]);
        let t = (level - a) / (b - a);
        (x[c0] + t * (x[c1] - x[c0]), y[r0] + t * (y[r1] - y[r0]))
    };
    pieces.joined().into_iter().map(|line| line.into_iter().map(place).collect()).collect()
}

/// An edge of the grid by its lower end: along x, or along y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Edge {
    column: usize,
    row: usize,
    along_x: bool,
}

impl Edge {
    fn ends(self) -> ((usize, usize), (usize, usize)) {
        let other = if self.along_x { (self.column + 1, self.row) } else { (self.column, self.row + 1) };
        ((self.column, self.row), other)
    }
}

/// The pieces of line within one cell.
fn cell(columns: usize, values: &[f64], level: f64, (c, r): (usize, usize), pieces: &mut Pieces) {
    let at = |c: usize, r: usize| values[r * columns + c];
    // Counter-clockwise from the corner of lowest x and y; edge i leads from corner i to the next.
    let corners = [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)];
    if corners.iter().any(|v| v.is_nan()) {
        return;
    }
    let above = corners.map(|v| v >= level);
    let edge = |i: usize| match i {
        0 => Edge { column: c, row: r, along_x: true },
        1 => Edge { column: c + 1, row: r, along_x: false },
        2 => Edge { column: c, row: r + 1, along_x: true },
        _ => Edge { column: c, row: r, along_x: false },
    };
    let crossed: Vec<usize> = (0..4).filter(|i| above[*i] != above[(i + 1) % 4]).collect();
    match crossed[..] {
        [a, b] => pieces.add(edge(a), edge(b)),
        [_, _, _, _] => {
            // Corners 0 and 2 are joined where the middle is as they are: then the other two are cut off, each by one line.
            let middle = corners.iter().map(|v| 0.25 * v).sum::<f64>() >= level;
            let cut_off = if middle == above[0] { [1, 3] } else { [0, 2] };
            for corner in cut_off {
                pieces.add(edge((corner + 3) % 4), edge(corner));
            }
        }
        _ => {}
    }
}

/// Pieces of line between edges, each edge having at most two.
#[derive(Debug, Default)]
struct Pieces {
    /// In the order found, so that the same field gives the same lines.
    order: Vec<Edge>,
    next: std::collections::HashMap<Edge, Vec<Edge>>,
}

impl Pieces {
    fn add(&mut self, a: Edge, b: Edge) {
        for (from, to) in [(a, b), (b, a)] {
            let list = self.next.entry(from).or_insert_with(|| {
                self.order.push(from);
                Vec::with_capacity(2)
            });
            list.push(to);
        }
    }

    /// The pieces joined to lines: open ones from end to end first, then closed ones.
    fn joined(mut self) -> Vec<Vec<Edge>> {
        let order = std::mem::take(&mut self.order);
        let ends: Vec<Edge> = order.iter().copied().filter(|e| self.next[e].len() == 1).collect();
        let mut lines = Vec::new();
        for start in ends.into_iter().chain(order) {
            let mut line = vec![start];
            let mut at = start;
            while let Some(to) = self.step(at) {
                line.push(to);
                at = to;
            }
            if line.len() > 1 {
                lines.push(line);
            }
        }
        lines
    }

    /// Takes one piece away from an edge and says where it led.
    fn step(&mut self, from: Edge) -> Option<Edge> {
        let to = self.next.get_mut(&from)?.pop()?;
        let back = self.next.get_mut(&to)?;
        let i = back.iter().position(|e| *e == from)?;
        back.swap_remove(i);
        Some(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> Vec<f64> {
        (0..n).map(|i| -1.0 + 2.0 * i as f64 / (n - 1) as f64).collect()
    }

    fn field(x: &[f64], y: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        y.iter().flat_map(|y| x.iter().map(|x| f(*x, *y)).collect::<Vec<_>>()).collect()
    }

    #[test]
    fn a_cone_has_one_closed_circle() {
        let g = grid(81);
        let lines = contours(&g, &g, &field(&g, &g, |x, y| x.hypot(y)), 0.5);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        // Linear interpolation of the distance along a cell's edge of h = 1/40 is off by at most h²/(8 r).
        let bound = (1.0f64 / 40.0).powi(2) / (8.0 * 0.475);
        assert!(lines[0].iter().all(|(x, y)| (x.hypot(*y) - 0.5).abs() <= bound));
    }

    #[test]
    fn a_plane_has_one_open_line() {
        let (x, y) = (grid(5), grid(4));
        let lines = contours(&x, &y, &field(&x, &y, |x, _| x), 0.3);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].len(), 4);
        assert!(lines[0].iter().all(|(x, _)| (x - 0.3).abs() < 1e-15));
    }

    #[test]
    fn a_saddle_is_parted_by_its_middle() {
        let (x, y) = ([0.0, 1.0], [0.0, 1.0]);
        // High on the diagonal 0–2. Above the middle's value the high corners are parted, below it joined.
        let values = [1.0, 0.0, 0.0, 1.0];
        for (level, apart) in [(0.6, true), (0.4, false)] {
            let lines = contours(&x, &y, &values, level);
            assert_eq!(lines.len(), 2);
            let cuts_off_origin = lines.iter().any(|l| l.iter().all(|(x, y)| x + y < 1.0));
            assert_eq!(cuts_off_origin, apart, "{level}: {lines:?}");
        }
    }

    #[test]
    fn a_level_outside_the_field_has_no_line_and_nan_ends_one() {
        let g = grid(3);
        let mut values = field(&g, &g, |x, _| x);
        assert!(contours(&g, &g, &values, 2.0).is_empty());
        values[0] = f64::NAN;
        assert_eq!(contours(&g, &g, &values, -0.5), vec![vec![(-0.5, 0.0), (-0.5, 1.0)]]);
    }
}
