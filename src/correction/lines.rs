//! Wavelengths of the strong lines of calibration lamps, in standard air.

use std::sync::LazyLock;

use crate::tables;

/// The table `nist-lines`; the manifest says where the digits come from and what they were held against.
static LINES: LazyLock<Vec<Line>> = LazyLock::new(|| {
    let table = tables::lookups().iter().find(|t| t.info().name == "nist-lines").expect("the table is embedded");
    let row = |line: &str| {
        let (number, nm) = line.split_once(',')?;
        let element = Element::ALL.into_iter().find(|e| number.parse() == Ok(e.atomic_number()))?;
        Some(Line { element: Some(element), wavelength_nm: nm.parse().ok()? })
    };
    table.csv().lines().skip(1).map(|l| row(l).expect("the table is whole")).collect()
});

/// A line of a known wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Whose; `None` for a line that the user gives.
    pub element: Option<Element>,
    /// In standard air, nm.
    pub wavelength_nm: f64,
}

/// An element whose lines are tabulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize, schemars::JsonSchema)]
#[expect(missing_docs, reason = "the symbols of the elements")]
pub enum Element {
    Ne,
    Ar,
    Kr,
    Cd,
    Hg,
}

impl Element {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Ne, Self::Ar, Self::Kr, Self::Cd, Self::Hg];

    /// Its symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Ne => "Ne",
            Self::Ar => "Ar",
            Self::Kr => "Kr",
            Self::Cd => "Cd",
            Self::Hg => "Hg",
        }
    }

    fn atomic_number(self) -> u32 {
        match self {
            Self::Ne => 10,
            Self::Ar => 18,
            Self::Kr => 36,
            Self::Cd => 48,
            Self::Hg => 80,
        }
    }
}

impl std::str::FromStr for Element {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|e| e.symbol().eq_ignore_ascii_case(text.trim()));
        found.ok_or_else(|| format!("`{text}` has no lines here; expected Ne, Ar, Kr, Cd or Hg"))
    }
}

/// The strong lines of some elements between 250 and 1020 nm, ascending (NIST ASD; `photopic tables` names the table's sources).
///
/// ```
/// use photopic::correction::lines::{Element, of};
/// let mercury = of(&[Element::Hg]);
/// assert!(mercury.iter().any(|l| l.wavelength_nm == 546.075));
/// ```
#[must_use]
pub fn of(elements: &[Element]) -> Vec<Line> {
    let mut out: Vec<Line> =
        LINES.iter().filter(|l| l.element.is_some_and(|e| elements.contains(&e))).copied().collect();
    out.sort_by(|a, b| a.wavelength_nm.total_cmp(&b.wavelength_nm));
    out
}
