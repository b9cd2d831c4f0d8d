//! The published tables that every calculation rests on: observers, illuminants, samples and action spectra, embedded
//! in the program with their provenance.
//!
//! A table is plain numbers on its own wavelengths. Values between or outside the tabulated wavelengths are not given
//! here: that needs a rule, which [`TableInfo::interpolation`] and [`TableInfo::extrapolation`] name, and a
//! `Spectrum` to apply it to.
//!
//! Nothing is read at start-up. The manifest is read at the first call of [`get`] or [`all`], the numbers of a table at
//! the first call of [`Table::wavelengths_nm`] or [`Table::column`].
//!
//! ```
//! let table = photopic::tables::get("cie-1931-2deg")?;
//! let y = table.column("y_bar").expect("the table has this column");
//! assert_eq!(table.wavelengths_nm()[547 - 360], 547.0);
//! assert_eq!(y[547 - 360], 0.9874182); // CIE 018:2019, Table 6
//! assert_eq!(table.info().licence, "CC BY-SA 4.0");
//! # Ok::<(), photopic::tables::Error>(())
//! ```
//!
//! The numbers are made by `scripts/export_tables.py`, which holds each table against a second source. This module
//! imports nothing of the crate.

mod embedded;
mod info;

use std::sync::OnceLock;

pub use info::{Column, LookupInfo, Spot, TableInfo};

/// Why a table could not be given.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No table has this name or alias.
    #[error("no table is called '{name}'; nearest: {}", nearest.join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names of tables that resemble it most, best first; never empty.
        nearest: Vec<&'static str>,
    },
}

/// One embedded table: wavelengths, one or more columns of the same length, and where they come from.
#[derive(Debug)]
pub struct Table {
    info: TableInfo,
    csv: &'static str,
    numbers: OnceLock<Numbers>,
}

#[derive(Debug)]
struct Numbers {
    wavelengths_nm: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

impl Table {
    /// The stable name, such as `cie-1931-2deg`.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// Everything the manifest says about the table: standard, origin, licence, checksum, spot values.
    #[must_use]
    pub fn info(&self) -> &TableInfo {
        &self.info
    }

    /// Wavelengths in nm, increasing, in standard air as the publications have them. The step is
    /// [`TableInfo::step_nm`].
    ///
    /// # Panics
    ///
    /// If the embedded file is broken; a test reads them all.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.numbers().wavelengths_nm
    }

    /// Names, units and meanings of the columns, in the order of the file, the wavelengths not among them.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.info.columns
    }

    /// The values of one column, one for each of [`Table::wavelengths_nm`], in the unit that [`Table::columns`] gives;
    /// `None` if there is no such column. Upper and lower case are one.
    ///
    /// # Panics
    ///
    /// If the embedded file is broken; a test reads them all.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let index = self.info.columns.iter().position(|c| c.name.eq_ignore_ascii_case(name))?;
        Some(&self.numbers().columns[index])
    }

    /// The embedded file as it is: a header row (`wavelength_nm`, then the columns' names), then one row per wavelength.
    #[must_use]
    pub fn csv(&self) -> &'static str {
        self.csv
    }

    fn numbers(&self) -> &Numbers {
        self.numbers.get_or_init(|| parse(self.csv, &self.info))
    }
}

/// The table of this name or alias (`cie-1931-2deg`, `CIE-1931`, `d65`); upper and lower case are one.
///
/// # Errors
///
/// [`Error::Unknown`] with the nearest names.
///
/// # Panics
///
/// If the embedded manifest is broken; a test reads it.
pub fn get(name: &str) -> Result<&'static Table, Error> {
    let wanted = name.trim();
    all()
        .iter()
        .find(|t| t.info.names().any(|n| n.eq_ignore_ascii_case(wanted)))
        .ok_or_else(|| Error::Unknown { name: name.to_owned(), nearest: nearest(wanted) })
}

/// All tables, in the order of the manifest.
///
/// # Panics
///
/// If the embedded manifest is broken; a test reads it.
#[must_use]
pub fn all() -> &'static [Table] {
    static TABLES: OnceLock<Vec<Table>> = OnceLock::new();
    TABLES.get_or_init(|| {
        let infos = info::read(embedded::MANIFEST).expect("data/MANIFEST.toml is broken").table;
        let table = |info: TableInfo| Table { csv: embedded(&info.file), info, numbers: OnceLock::new() };
        infos.into_iter().map(table).collect()
    })
}

/// One embedded table over two arguments other than the wavelength.
#[derive(Debug)]
pub struct Lookup {
    info: LookupInfo,
    csv: &'static str,
}

impl Lookup {
    /// Everything the manifest says about the table.
    #[must_use]
    pub fn info(&self) -> &LookupInfo {
        &self.info
    }

    /// The embedded file as it is: a header row with the arguments of the columns, then one row per argument in the first
    /// column; a blank cell where the publication has no value.
    #[must_use]
    pub fn csv(&self) -> &'static str {
        self.csv
    }
}

/// All tables over other arguments than the wavelength, in the order of the manifest.
///
/// # Panics
///
/// If the embedded manifest is broken; a test reads it.
#[must_use]
pub fn lookups() -> &'static [Lookup] {
    static LOOKUPS: OnceLock<Vec<Lookup>> = OnceLock::new();
    LOOKUPS.get_or_init(|| {
        let infos = info::read(embedded::MANIFEST).expect("data/MANIFEST.toml is broken").lookup;
        infos.into_iter().map(|info| Lookup { csv: embedded(&info.file), info }).collect()
    })
}

fn embedded(file: &str) -> &'static str {
    embedded::file(file).unwrap_or_else(|| panic!("data/{file} is in the manifest but not embedded"))
}

/// Splits an embedded file into numbers; its header must be the manifest's columns.
fn parse(csv: &str, info: &TableInfo) -> Numbers {
    let file = &info.file;
    let mut lines = csv.lines();
    let header = lines.next().unwrap_or_default();
    let expected = info.columns.iter().map(|c| c.name.as_str());
    assert!(
        header.split(',').eq(std::iter::once("wavelength_nm").chain(expected)),
        "data/{file}: the header is not what the manifest says"
    );
    let mut wavelengths_nm = Vec::with_capacity(info.rows);
    let mut columns = vec![Vec::with_capacity(info.rows); info.columns.len()];
    for line in lines {
        let mut cells = line.split(',').map(|cell| {
            cell.parse::<f64>().unwrap_or_else(|_| panic!("data/{file}: '{cell}' in '{line}' is not a number"))
        });
        wavelengths_nm.extend(cells.next());
        for column in &mut columns {
            column.push(cells.next().unwrap_or_else(|| panic!("data/{file}: '{line}' is short")));
        }
        assert!(cells.next().is_none(), "data/{file}: '{line}' is long");
    }
    Numbers { wavelengths_nm, columns }
}

/// The names of the tables that resemble `wanted` most: those that contain it first, then by edit distance to the name
/// or an alias.
fn nearest(wanted: &str) -> Vec<&'static str> {
    const SHOWN: usize = 4;
    let wanted = wanted.to_ascii_lowercase();
    let mut ranked: Vec<(usize, &'static str)> = all()
        .iter()
        .map(|t| {
            let inside = wanted.len() > 2 && t.info.names().any(|n| n.contains(&wanted));
            let distance = t.info.names().map(|n| distance(&wanted, n)).min().unwrap_or(usize::MAX);
            (if inside { 0 } else { distance }, t.name())
        })
        .collect();
    ranked.sort();
    ranked.into_iter().take(SHOWN).map(|(_, name)| name).collect()
}

/// The number of characters to insert, remove or replace to turn `a` into `b`.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_aliases_find_a_table_in_any_case() {
        for name in ["cie-1924-v", "CIE-1924-V", "photopic", " Photopic "] {
            assert_eq!(get(name).map(Table::name), Ok("cie-1924-v"), "{name}");
        }
        let table = get("d65").expect("an alias");
        assert_eq!(table.column("d65"), table.column("D65"));
        assert_eq!(table.column("D66"), None);
    }

    #[test]
    fn an_unknown_name_comes_with_its_neighbours() {
        let error = get("cie-1932-2deg").expect_err("no such table");
        let Error::Unknown { name, nearest } = &error;
        assert_eq!(name, "cie-1932-2deg");
        assert_eq!(nearest[0], "cie-1931-2deg");
        assert!(error.to_string().contains("cie-1931-2deg"), "{error}");
        assert!(matches!(get("hazard"), Err(Error::Unknown { nearest, .. }) if nearest[0].contains("hazard")));
        assert!(matches!(get(""), Err(Error::Unknown { nearest, .. }) if !nearest.is_empty()));
    }

    #[test]
    fn edit_distance() {
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("d65", "d65"), 0);
    }

    #[test]
    fn no_two_tables_share_a_name() {
        let mut names: Vec<String> = all().iter().flat_map(|t| t.info.names()).map(str::to_ascii_lowercase).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count, "a name or alias is used twice");
    }
}
