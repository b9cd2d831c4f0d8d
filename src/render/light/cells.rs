//! A density that is constant in each cell of a net: what lights that are tables or pictures are drawn from.
//!
//! Rows are drawn by their cumulated weights, then columns within the row. The probability of a cell is the difference of the same
//! cumulated weights, so that it is that of the draws whatever was rounded.

/// Weights of the cells of a net of rows and columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cells {
    columns: usize,
    /// Row by row the weights cumulated along it, up to and with each cell.
    along: Vec<f64>,
    /// Totals of the rows, cumulated.
    upwards: Vec<f64>,
}

/// A cell that was drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drawn {
    pub row: usize,
    pub column: usize,
    /// Place within the cell along the row and across it, uniform in [0, 1].
    pub place: [f64; 2],
    /// Probability of the cell.
    pub probability: f64,
}

impl Cells {
    /// From weights of 0 or more, row by row, of any scale.
    pub(super) fn new(columns: usize, weights: impl IntoIterator<Item = f64>) -> Self {
        let mut along: Vec<f64> = weights.into_iter().collect();
        let (mut upwards, mut total) = (Vec::with_capacity(along.len() / columns.max(1)), 0.0);
        for row in along.chunks_exact_mut(columns) {
            let mut sum = 0.0;
            for weight in row {
                sum += *weight;
                *weight = sum;
            }
            total += sum;
            upwards.push(total);
        }
        Self { columns, along, upwards }
    }

    /// A cell from two uniform numbers; `None` where all weights are zero.
    pub(super) fn draw(&self, [u, v]: [f64; 2]) -> Option<Drawn> {
        let (row, across, of_row) = draw(&self.upwards, v)?;
        let (column, along, of_cell) = draw(self.row(row), u)?;
        Some(Drawn { row, column, place: [along, across], probability: of_row * of_cell })
    }

    /// The probability of a cell.
    pub(super) fn probability(&self, row: usize, column: usize) -> f64 {
        share(&self.upwards, row) * share(self.row(row), column)
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.along[row * self.columns..(row + 1) * self.columns]
    }
}

/// The interval of cumulated weights that a uniform number falls into, the place within it, and its share of the whole.
fn draw(cumulated: &[f64], u: f64) -> Option<(usize, f64, f64)> {
    let total = *cumulated.last()?;
    let x = u * total;
    // Empty intervals are never found: their end is not above their start. At u = 1 the last that is not empty is.
    let mut index = cumulated.partition_point(|end| *end <= x);
    if index == cumulated.len() {
        index = cumulated.partition_point(|end| *end < total);
    }
    let (start, width) = interval(cumulated, index);
    (total > 0.0).then(|| (index, ((x - start) / width).clamp(0.0, 1.0), width / total))
}

fn share(cumulated: &[f64], index: usize) -> f64 {
    let total = cumulated[cumulated.len() - 1];
    if total > 0.0 { interval(cumulated, index).1 / total } else { 0.0 }
}

/// Start and width.
fn interval(cumulated: &[f64], index: usize) -> (f64, f64) {
    let start = if index == 0 { 0.0 } else { cumulated[index - 1] };
    (start, cumulated[index] - start)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_drawn_by_their_weights_and_empty_ones_never() {
        let cells = Cells::new(3, [0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0, 4.0, 0.0]);
        let n = 400_i32;
        let mut counts = [0_i32; 9];
        for i in 0..n * n {
            let u = [i % n, i / n].map(|i| (f64::from(i) + 0.5) / f64::from(n));
            let drawn = cells.draw(u).expect("weights");
            assert_eq!(drawn.probability, cells.probability(drawn.row, drawn.column));
            assert!(drawn.place.iter().all(|p| (0.0..=1.0).contains(p)));
            counts[drawn.row * 3 + drawn.column] += 1;
        }
        for (count, weight) in counts.into_iter().zip([0, 2, 1, 0, 0, 0, 1, 4, 0]) {
            // A net of 400 × 400 errs by less than a row and a column of its points in each cell.
            assert!((count - n * n * weight / 8).abs() <= 2 * n && (weight > 0 || count == 0), "{count} for {weight}");
        }
        // Numbers at the very ends stay with cells that have a weight.
        assert_eq!(cells.draw([0.0, 0.0]).map(|d| (d.row, d.column)), Some((0, 1)));
        assert_eq!(cells.draw([1.0, 1.0]).map(|d| (d.row, d.column)), Some((2, 1)));
        assert_eq!(Cells::new(2, [0.0; 4]).draw([0.5; 2]), None);
        assert_eq!(Cells::new(2, [0.0; 4]).probability(1, 1), 0.0);
    }
}
