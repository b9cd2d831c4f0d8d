//! The tables that a budget names: an uncertainty over wavelength, a covariance over two.

use nalgebra::{DMatrix, SymmetricEigen};

use crate::math::interpolate;
use crate::mistake::Mistake;
use crate::spectrum::Grid;

/// What is wrong with a table, and where.
pub type Error = Mistake;

/// Asymmetry, or a negative variance, beyond this share of the largest variance is no rounding of printed digits.
const ROUNDING: f64 = 1e-3;

/// A column over wavelength: straight lines between the rows, the outermost values beyond them.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    wavelengths_nm: Vec<f64>,
    values: Vec<f64>,
}

/// A covariance between wavelengths.
#[derive(Debug, Clone, PartialEq)]
pub struct Covariance {
    wavelengths_nm: Vec<f64>,
    /// Columns L of C = L Lᵀ, one per mode that has any variance.
    modes: DMatrix<f64>,
}

/// The cells of a CSV text with line and column of each; lines beginning with `#` are left out.
fn cells(text: &str) -> impl Iterator<Item = (u64, Vec<(u64, &str)>)> {
    let lines = (1..).zip(text.lines()).filter(|(_, l)| !l.trim().is_empty() && !l.starts_with('#'));
    lines.map(|(line, content)| {
        let mut column = 1;
        let row = content.split([',', ';', '\t']).map(|cell| {
            let at = column;
            column += cell.chars().count() as u64 + 1;
            (at, cell.trim())
        });
        (line, row.collect())
    })
}

fn number(line: u64, (column, cell): (u64, &str)) -> Result<f64, Error> {
    cell.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| Mistake {
        line,
        column,
        message: format!("found `{cell}`; expected a finite number"),
    })
}

fn ascending(line: u64, column: u64, before: Option<&f64>, found: f64) -> Result<(), Error> {
    if found > 0.0 && before.is_none_or(|b| found > *b) {
        return Ok(());
    }
    Err(Mistake { line, column, message: format!("found wavelength {found}; expected ascending wavelengths in nm") })
}

/// Reads a CSV text of two columns of numbers, the first ascending, the second not negative; a header row and lines with `#` may stand
/// above. `what` says what both are.
///
/// # Errors
/// A mistake with its line and column.
pub(crate) fn pairs(text: &str, what: &str) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let (mut x, mut y): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for (index, (line, row)) in cells(text).enumerate() {
        if index == 0 && row[0].1.parse::<f64>().is_err() {
            continue;
        }
        let [first, second] = row[..] else {
            let message = format!("found {} cells; expected two: {what}", row.len());
            return Err(Mistake { line, column: 1, message });
        };
        let (at, value) = (number(line, first)?, number(line, second)?);
        if x.last().is_some_and(|b| at <= *b) {
            return Err(Mistake { line, column: first.0, message: format!("found {at}; expected ascending numbers") });
        }
        if value < 0.0 {
            let message = format!("found `{value}`; expected a number that is not negative");
            return Err(Mistake { line, column: second.0, message });
        }
        x.push(at);
        y.push(value);
    }
    if x.len() < 2 {
        return Err(Mistake { line: 1, column: 1, message: "found fewer than two rows; expected a table".into() });
    }
    Ok((x, y))
}

/// First row, first column, and what stands between.
type Rectangle = (Vec<f64>, Vec<f64>, DMatrix<f64>);

/// Reads a CSV text of numbers between two axes: wavelengths in nm in the first row (after one cell) and in the first column, both
/// ascending. Gives the first row, the first column and the matrix, row by row as in the text.
///
/// # Errors
/// A mistake with its line and column.
pub(crate) fn rectangle(text: &str) -> Result<Rectangle, Error> {
    let whole = |message: String| Mistake { line: 1, column: 1, message };
    let mut lines = cells(text);
    let (line, header) = lines.next().ok_or_else(|| whole("found nothing; expected a matrix".into()))?;
    let mut columns = Vec::new();
    for cell in &header[1..] {
        let w = number(line, *cell)?;
        ascending(line, cell.0, columns.last(), w)?;
        columns.push(w);
    }
    let n = columns.len();
    if n < 1 {
        return Err(whole("found no wavelength in the first row; expected some".into()));
    }
    let (mut rows, mut numbers) = (Vec::new(), Vec::new());
    for (line, row) in lines {
        if row.len() != n + 1 {
            let message = format!("found {} cells in row {}; expected {}", row.len(), rows.len() + 1, n + 1);
            return Err(Mistake { line, column: 1, message });
        }
        let w = number(line, row[0])?;
        ascending(line, row[0].0, rows.last(), w)?;
        rows.push(w);
        for cell in &row[1..] {
            numbers.push(number(line, *cell)?);
        }
    }
    if rows.len() < 2 {
        return Err(whole(format!("found {} rows; expected at least two", rows.len())));
    }
    let matrix = DMatrix::from_row_slice(rows.len(), n, &numbers);
    Ok((columns, rows, matrix))
}

impl Table {
    /// Reads a CSV text of two columns, wavelength in nm and standard uncertainty; a header row and lines with `#` may stand above.
    ///
    /// # Errors
    /// A mistake with its line and column.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let (wavelengths_nm, values) = pairs(text, "wavelength in nm, uncertainty")?;
        Ok(Self { wavelengths_nm, values })
    }

    /// A column over the wavelengths of a grid; one value per wavelength.
    #[must_use]
    pub fn of(grid: &Grid, values: &[f64]) -> Self {
        Self { wavelengths_nm: grid.wavelengths_nm().to_vec(), values: values.to_vec() }
    }

    /// The uncertainty at a wavelength, nm.
    #[must_use]
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        let (first, last) = self.range_nm();
        interpolate::linear(&self.wavelengths_nm, &self.values, wavelength_nm.clamp(first, last))
    }

    /// Shortest and longest wavelength, nm.
    #[must_use]
    pub fn range_nm(&self) -> (f64, f64) {
        (self.wavelengths_nm[0], self.wavelengths_nm[self.wavelengths_nm.len() - 1])
    }
}

impl Covariance {
    /// Reads a CSV text: wavelengths in nm in the first row (after one cell) and the first column, covariance between: relative, or in
    /// the unit of the samples squared, as the budget has it.
    ///
    /// # Errors
    /// A mistake with its line and column: cells, order, a matrix that is not symmetric or has a negative variance beyond what
    /// printed digits make (0.1 % of the largest variance).
    pub fn parse(text: &str) -> Result<Self, Error> {
        let whole = |message: String| Mistake { line: 1, column: 1, message };
        let (wavelengths_nm, rows, matrix) = rectangle(text)?;
        if rows != wavelengths_nm {
            let found = rows.iter().zip(&wavelengths_nm).find(|(r, c)| r != c);
            return Err(whole(match found {
                Some((r, c)) => format!("found {r} in the first column; expected {c} as in the first row"),
                None => format!(
                    "found {} rows; expected {}, one per wavelength of the first row",
                    rows.len(),
                    wavelengths_nm.len()
                ),
            }));
        }
        let largest = matrix.diagonal().max();
        let asymmetry = (&matrix - matrix.transpose()).amax();
        if asymmetry > ROUNDING * largest {
            return Err(whole(format!(
                "found a matrix that differs from its transpose by {asymmetry:.2e}; expected a symmetric one"
            )));
        }
        let eigen = SymmetricEigen::new(0.5 * (&matrix + matrix.transpose()));
        let smallest = eigen.eigenvalues.min();
        if smallest < -ROUNDING * largest {
            return Err(whole(format!(
                "found an eigenvalue of {smallest:.2e}; expected a covariance, which has none below 0"
            )));
        }
        let mut modes = eigen.eigenvectors;
        for (mut column, value) in modes.column_iter_mut().zip(eigen.eigenvalues.iter()) {
            column *= value.max(0.0).sqrt();
        }
        Ok(Self { wavelengths_nm, modes })
    }

    /// The modes at the wavelengths given (nm): values × modes, straight lines between the matrix's wavelengths, its outermost
    /// values beyond them. Modes without variance are left out.
    #[must_use]
    pub fn modes_at(&self, wavelengths_nm: &[f64]) -> DMatrix<f64> {
        let (first, last) = self.range_nm();
        let largest = self.modes.column_iter().map(|c| c.norm_squared()).fold(0.0, f64::max);
        let kept: Vec<Vec<f64>> = (self.modes.column_iter())
            .filter(|c| c.norm_squared() > 1e-14 * largest)
            .map(|c| c.iter().copied().collect())
            .collect();
        DMatrix::from_fn(wavelengths_nm.len(), kept.len(), |r, c| {
            interpolate::linear(&self.wavelengths_nm, &kept[c], wavelengths_nm[r].clamp(first, last))
        })
    }

    /// Shortest and longest wavelength, nm.
    #[must_use]
    pub fn range_nm(&self) -> (f64, f64) {
        (self.wavelengths_nm[0], self.wavelengths_nm[self.wavelengths_nm.len() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_held_beyond_its_ends() {
        let t = Table::parse("# from a certificate\nnm;u\n400;0.02\n500;0.01").expect("a table");
        assert_eq!([300.0, 450.0, 900.0].map(|w| t.at(w)), [0.02, 0.015, 0.01]);
        let message = |text: &str| Table::parse(text).expect_err(text).to_string();
        assert!(message("400,0.1\n390,0.1").starts_with("2:1: found 390; expected ascending"));
        assert!(message("400,0.1\n500,x").starts_with("2:5: found `x`"));
        assert!(message("400,0.1\n500,-1").starts_with("2:5: found `-1`"));
        assert!(message("400,0.1\n500").starts_with("2:1: found 1 cells"));
        assert!(message("").starts_with("1:1: found fewer than two rows"));
    }

    #[test]
    fn a_covariance_is_that_of_its_modes() {
        let c =
            Covariance::parse("nm,400,500,600\n400,4e-4,2e-4,0\n500,2e-4,4e-4,2e-4\n600,0,2e-4,4e-4\n").expect("one");
        let modes = c.modes_at(&[400.0, 450.0, 700.0]);
        let back = &modes * modes.transpose();
        // Half way the variance is (4 + 2·2 + 4)/4 e-4 = 3e-4; beyond the end it is that of 600 nm.
        for (at, want) in [((0, 0), 4e-4), ((1, 1), 3e-4), ((0, 1), 3e-4), ((2, 2), 4e-4), ((0, 2), 0.0)] {
            assert!((back[at] - want).abs() < 1e-15, "{at:?}: {}", back[at]);
        }
        let message = |text: &str| Covariance::parse(text).expect_err(text).to_string();
        assert!(message("nm,400,500\n400,1,2\n500,2,1\n").contains("eigenvalue"));
        assert!(message("nm,400,500\n400,1,0.5\n500,0.2,1\n").contains("transpose"));
        assert!(message("nm,400,500\n400,1,0.5\n").contains("1 rows; expected at least two"));
        assert!(
            message("nm,400,500\n410,1,0.5\n500,0.5,1\n")
                .starts_with("1:1: found 410 in the first column; expected 400")
        );
    }
}
