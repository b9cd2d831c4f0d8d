//! The position index of glare sources.

use std::sync::LazyLock;

use crate::tables;

/// CIE 117:1995, table 4.1: rows T/R, columns H/R, both in steps of 0.1; blank where the standard has none. The manifest says where
/// the digits come from and what they were held against.
const TABLE: &str = "cie-117-position-index";

/// Step of both arguments.
const STEP: f64 = 0.1;

static ROWS: LazyLock<Vec<Vec<Option<f64>>>> = LazyLock::new(|| {
    let cells = |line: &str| line.split(',').skip(1).map(|cell| cell.parse().ok()).collect();
    let table = tables::lookups().iter().find(|table| table.info().name == TABLE).expect("the table is embedded");
    table.csv().lines().skip(1).map(cells).collect()
});

/// The position index p of a glare source above the line of sight, after Guth: 1 on it, larger away from it.
///
/// Bilinear in `t_over_r` (distance aside over distance ahead, 0–3) and `h_over_r` (height over distance ahead, 0–1.9); `None`
/// outside the table, where a source does not count.
///
/// # Reference
/// CIE 117:1995, table 4.1.
///
/// # Example
/// ```
/// // A source straight ahead, as high as far.
/// assert_eq!(photopic::luminaire::ugr::position_index(0.0, 1.0), Some(7.0));
/// ```
#[must_use]
pub fn position_index(t_over_r: f64, h_over_r: f64) -> Option<f64> {
    let (row, s) = locate(t_over_r, ROWS.len() - 1)?;
    let (column, t) = locate(h_over_r, ROWS[0].len() - 1)?;
    let between = |a: Option<f64>, b: Option<f64>, at: f64| if at == 0.0 { a } else { Some(a? + at * (b? - a?)) };
    let along = |row: usize| between(ROWS[row][column], ROWS[row][column + 1], t);
    between(along(row), along(row + 1), s)
}

/// Entry before a ratio and the fraction of a step beyond it; `None` past the last entry.
fn locate(ratio: f64, last: usize) -> Option<(usize, f64)> {
    let steps = ratio / STEP;
    // Ratios such as 4.5/1.5 may miss an entry by a rounding error.
    let place = if (steps - steps.round()).abs() < 1e-9 { steps.round() } else { steps };
    let below = (place as usize).min(last - 1);
    (place >= 0.0 && place <= last as f64).then_some((below, place - below as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_whole() {
        assert_eq!(ROWS.len(), 31);
        assert!(ROWS.iter().all(|row| row.len() == 20));
        let blanks: usize = ROWS.iter().map(|row| row.iter().filter(|c| c.is_none()).count()).sum();
        assert_eq!(blanks, 4 * 2 + 5);
        // Larger upwards everywhere.
        for row in ROWS.iter() {
            let values: Vec<f64> = row.iter().flatten().copied().collect();
            assert!(values.windows(2).all(|w| w[1] > w[0]), "{values:?}");
        }
    }

    #[test]
    fn values_between_entries_are_those_behind_cie_190_table_2() {
        // K = 0.25 π (H/D)²/(4 p²) at (x/H, y/H), H = 2 m; five printed decimals.
        for (x, y, h_over_d, printed) in [
            (0.5, 1.5, 0.5345, 0.00412),
            (0.5, 4.5, 0.2157, 0.00386),
            (1.5, 2.5, 0.3244, 0.00294),
            (2.5, 5.5, 0.1633, 0.00176),
        ] {
            let p: f64 = position_index(x / y, 1.0 / y).expect("inside the table");
            let k = 0.25 * std::f64::consts::PI * h_over_d * h_over_d / (4.0 * p * p);
            assert!((k - printed).abs() < 6e-6, "{x}, {y}: {k} against {printed}");
        }
    }

    #[test]
    fn beyond_the_table_nothing_counts() {
        assert_eq!(position_index(3.01, 0.5), None);
        assert_eq!(position_index(0.0, 2.0), None);
        assert_eq!(position_index(0.1, 1.75), None);
        assert!(position_index(3.0, 0.5).is_some() && position_index(4.5 / 1.5, 1.0 / 1.5).is_some());
    }
}
