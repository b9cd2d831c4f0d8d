//! The tables that a budget names: an uncertainty over wavelength, a covariance over two.

use nalgebra::{DMatrix, SymmetricEigen};

use crate::math::interpolate;
use crate::mistake::Mistake;

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

/// A relative covariance between wavelengths.
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

impl Table {
    /// Reads a CSV text of two columns, wavelength in nm and standard uncertainty; a header row and lines with `#` may stand above.
    ///
    /// # Errors
    /// A mistake with its line and column.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let mut out = Self { wavelengths_nm: Vec::new(), values: Vec::new() };
        for (index, (line, row)) in cells(text).enumerate() {
            if index == 0 && row[0].1.parse::<f64>().is_err() {
                continue;
            }
            let [wavelength, value] = row[..] else {
                let message = format!("found {} cells; expected two: wavelength in nm, uncertainty", row.len());
                return Err(Mistake { line, column: 1, message });
            };
            let (w, u) = (number(line, wavelength)?, number(line, value)?);
            ascending(line, wavelength.0, out.wavelengths_nm.last(), w)?;
            if u < 0.0 {
                let message = format!("found `{u}`; expected an uncertainty that is not negative");
                return Err(Mistake { line, column: value.0, message });
            }
            out.wavelengths_nm.push(w);
            out.values.push(u);
        }
        if out.values.len() < 2 {
            return Err(Mistake { line: 1, column: 1, message: "found fewer than two rows; expected a table".into() });
        }
        Ok(out)
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
    /// Reads a CSV text: wavelengths in nm in the first row (after one cell) and the first column, relative covariance between.
    ///
    /// # Errors
    /// A mistake with its line and column: cells, order, a matrix that is not symmetric or has a negative variance beyond what
    /// printed digits make (0.1 % of the largest variance).
    pub fn parse(text: &str) -> Result<Self, Error> {
        let whole = |message: String| Mistake { line: 1, column: 1, message };
        let mut rows = cells(text);
        let (line, header) = rows.next().ok_or_else(|| whole("found nothing; expected a covariance matrix".into()))?;
        let mut wavelengths_nm = Vec::new();
        for cell in &header[1..] {
            let w = number(line, *cell)?;
            ascending(line, cell.0, wavelengths_nm.last(), w)?;
            wavelengths_nm.push(w);
        }
        let n = wavelengths_nm.len();
        if n < 2 {
            return Err(whole(format!("found {n} wavelengths; expected at least two")));
        }
        let mut matrix = DMatrix::zeros(n, n);
        let mut count = 0;
        for (line, row) in rows {
            let place = |column: u64, message: String| Mistake { line, column, message };
            if row.len() != n + 1 || count == n {
                let message =
                    format!("found {} cells in row {}; expected {n} rows of {} cells", row.len(), count + 1, n + 1);
                return Err(place(1, message));
            }
            if number(line, row[0])? != wavelengths_nm[count] {
                let message = format!("found `{}`; expected {} as in the first row", row[0].1, wavelengths_nm[count]);
                return Err(place(1, message));
            }
            for (c, cell) in row[1..].iter().enumerate() {
                matrix[(count, c)] = number(line, *cell)?;
            }
            count += 1;
        }
        if count != n {
            return Err(whole(format!("found {count} rows; expected {n}, one per wavelength of the first row")));
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
        assert!(message("400,0.1\n390,0.1").starts_with("2:1: found wavelength 390"));
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
        assert!(message("nm,400,500\n400,1,0.5\n").contains("1 rows; expected 2"));
        assert!(message("nm,400,500\n410,1,0.5\n500,0.5,1\n").starts_with("2:1: found `410`"));
    }
}
