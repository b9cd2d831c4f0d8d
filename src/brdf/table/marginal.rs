//! A stack of densities on the unit square, bilinear between their nodes, and the map that makes each of them uniform.
//!
//! The density of a row is cumulated along x (the conditional), the totals of the rows along y (the marginal): a point of the
//! square becomes the two cumulated shares. Between the densities of a stack, densities are blended, not points.

/// Layers of `height` rows of `width` nodes on the unit square, both at least 2.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Marginal {
    width: usize,
    height: usize,
    /// Per layer and node, normalised to 1 over the square in units of cells.
    density: Vec<f64>,
    /// Density cumulated along each row, from 0.
    along: Vec<f64>,
    /// Totals of the rows, cumulated along y, from 0 to 1.
    upwards: Vec<f64>,
}

impl Marginal {
    /// From values of any scale. A layer that is zero everywhere counts as uniform.
    pub(super) fn new(width: usize, height: usize, values: &[f32]) -> Self {
        let cells = width * height;
        let mut density = Vec::with_capacity(values.len());
        let (mut along, mut upwards) = (Vec::with_capacity(values.len()), Vec::new());
        for layer in values.chunks_exact(cells) {
            let empty = layer.iter().all(|v| *v <= 0.0);
            let start = density.len();
            density.extend(layer.iter().map(|v| if empty { 1.0 } else { f64::from(v.max(0.0)) }));
            let total_start = upwards.len();
            for row in density[start..].chunks_exact(width) {
                cumulate(row.iter().copied(), &mut along);
            }
            let totals = along[start..].chunks_exact(width).map(|row| row[width - 1]);
            cumulate(totals, &mut upwards);
            let total = upwards[upwards.len() - 1];
            density[start..]
                .iter_mut()
                .chain(&mut along[start..])
                .chain(&mut upwards[total_start..])
                .for_each(|v| *v /= total);
        }
        Self { width, height, density, along, upwards }
    }

    /// Where a point of the unit square goes, for a blend of layers.
    pub(super) fn invert(&self, layers: impl Iterator<Item = (f64, usize)>, x: f64, y: f64) -> [f64; 2] {
        let ((column, fx), (row, fy)) = (cell(x, self.width), cell(y, self.height));
        let (mut across, mut total, mut up) = (0.0, 0.0, 0.0);
        for (weight, layer) in layers {
            let first = (layer * self.height + row) * self.width;
            let [near, far] = [first, first + self.width].map(|start| {
                let (a, b) = (self.density[start + column], self.density[start + column + 1]);
                (self.along[start + column] + fx * (a + 0.5 * fx * (b - a)), self.along[start + self.width - 1])
            });
            across += weight * (near.0 + fy * (far.0 - near.0));
            total += weight * (near.1 + fy * (far.1 - near.1));
            up += weight * (self.upwards[layer * self.height + row] + fy * (near.1 + 0.5 * fy * (far.1 - near.1)));
        }
        [if total > 0.0 { across / total } else { x }, up]
    }
}

/// Cell and place within it of a coordinate of the unit square on nodes 0 … count − 1.
pub(super) fn cell(x: f64, count: usize) -> (usize, f64) {
    if count < 2 {
        return (0, 0.0);
    }
    let place = x.clamp(0.0, 1.0) * (count - 1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the nodes")]
    let cell = (place as usize).min(count - 2);
    (cell, place - cell as f64)
}

/// Appends the trapezoidal sums of values one apart, from 0.
fn cumulate(values: impl Iterator<Item = f64>, sums: &mut Vec<f64>) {
    let (mut sum, mut before) = (0.0, None);
    for value in values {
        sum += before.map_or(0.0, |b: f64| 0.5 * (b + value));
        before = Some(value);
        sums.push(sum);
    }
}
