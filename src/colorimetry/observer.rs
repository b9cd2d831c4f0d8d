//! Standard observers and the tristimulus values of a spectrum.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use crate::spectrum::integrate::{self, Contract, RuleError, Weighting};
use crate::spectrum::{Grid, Sampling};
use crate::tables;

/// A set of colour-matching functions.
///
/// | observer | field | basis | use |
/// |---|---|---|---|
/// | [`Observer::Cie1931`] | 2° | Wright & Guild | lamps, displays, CCT; ȳ is V(λ). The default |
/// | [`Observer::Cie1964`] | 10° | Stiles & Burch, Speranskaya | surfaces, TM-30 samples |
/// | [`Observer::Cie2015Two`] | 2° | cone fundamentals (CIE 170-2) | research; displays with narrow primaries |
/// | [`Observer::Cie2015Ten`] | 10° | cone fundamentals (CIE 170-2) | as above, large fields |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Default)]
pub enum Observer {
    /// CIE 1931 standard colorimetric observer, 2°.
    #[default]
    #[serde(rename = "cie-1931-2deg")]
    Cie1931,
    /// CIE 1964 standard colorimetric observer, 10°.
    #[serde(rename = "cie-1964-10deg")]
    Cie1964,
    /// CIE 170-2:2015 cone-fundamental-based, 2°.
    #[serde(rename = "cie-2015-2deg")]
    Cie2015Two,
    /// CIE 170-2:2015 cone-fundamental-based, 10°.
    #[serde(rename = "cie-2015-10deg")]
    Cie2015Ten,
}

/// The observer's name is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown observer `{found}`; expected cie-1931-2deg, cie-1964-10deg, cie-2015-2deg or cie-2015-10deg")]
pub struct UnknownObserver {
    /// The word met.
    pub found: String,
}

impl FromStr for Observer {
    type Err = UnknownObserver;

    fn from_str(text: &str) -> Result<Self, UnknownObserver> {
        match text.to_lowercase().as_str() {
            "cie-1931-2deg" | "1931" | "2deg" => Ok(Self::Cie1931),
            "cie-1964-10deg" | "1964" | "10deg" => Ok(Self::Cie1964),
            "cie-2015-2deg" => Ok(Self::Cie2015Two),
            "cie-2015-10deg" => Ok(Self::Cie2015Ten),
            _ => Err(UnknownObserver { found: text.to_owned() }),
        }
    }
}

impl fmt::Display for Observer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.table_name())
    }
}

impl Observer {
    /// Name of the embedded table that holds the functions.
    #[must_use]
    pub fn table_name(self) -> &'static str {
        match self {
            Self::Cie1931 => "cie-1931-2deg",
            Self::Cie1964 => "cie-1964-10deg",
            Self::Cie2015Two => "cie-2015-2deg",
            Self::Cie2015Ten => "cie-2015-10deg",
        }
    }

    /// x̄(λ), ȳ(λ), z̄(λ) as weightings.
    ///
    /// # Panics
    /// Where the embedded table is broken, which a test excludes.
    #[must_use]
    pub fn colour_matching_functions(self) -> [Weighting; 3] {
        let table = tables::get(self.table_name()).expect("observer tables are embedded");
        ["x_bar", "y_bar", "z_bar"].map(|name| {
            Weighting::table(table.wavelengths_nm(), table.column(name).expect("an observer has three functions"))
        })
    }
}

/// An observer compiled for one grid, sampling and contract: tristimulus values are three dot products.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    weights: [Vec<f64>; 3],
}

impl Plan {
    /// Compiles the observer.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(observer: Observer, grid: &Grid, sampling: Sampling, contract: &Contract) -> Result<Self, RuleError> {
        let [x, y, z] = observer.colour_matching_functions();
        let of = |w: &Weighting| integrate::weights(grid, sampling, w, contract);
        Ok(Self { weights: [of(&x)?, of(&y)?, of(&z)?] })
    }

    /// ∫ S x̄, ∫ S ȳ, ∫ S z̄ of a spectrum's values on the plan's grid, in the values' unit times nm; no normalisation and
    /// no K_m.
    #[must_use]
    pub fn xyz(&self, values: &[f64]) -> [f64; 3] {
        [0, 1, 2].map(|k| integrate::dot(&self.weights[k], values))
    }

    /// The three weights of each sample.
    #[must_use]
    pub fn weights(&self) -> &[Vec<f64>; 3] {
        &self.weights
    }
}
