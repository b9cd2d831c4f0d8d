//! Luminous quantities: K_m ∫ X_λ V(λ) dλ and K′_m ∫ X_λ V′(λ) dλ (CIE 018:2019).

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use crate::constants::{K_M, K_M_SCOTOPIC};
use crate::spectrum::integrate::{self, Contract, ErrorModel, RuleError, Weighting, dot};
use crate::spectrum::{Grid, Sampling};
use crate::tables;

/// A photopic luminous efficiency function.
///
/// | function | field | use |
/// |---|---|---|
/// | [`Efficiency::Cie1924`] | 2° | all photometry: the SI's candela. The default |
/// | [`Efficiency::Judd1951`], [`Efficiency::JuddVos1978`] | 2° | vision science; more sensitive below 460 nm |
/// | [`Efficiency::Cie1964`] | 10° | large fields (ȳ₁₀) |
/// | [`Efficiency::Cie2008Two`], [`Efficiency::Cie2008Ten`] | 2°, 10° | cone-fundamental based (CIE 170) |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Default)]
pub enum Efficiency {
    /// V(λ), CIE 1924.
    #[default]
    #[serde(rename = "cie-1924-v")]
    Cie1924,
    /// Judd's modification of 1951.
    #[serde(rename = "judd-1951-v")]
    Judd1951,
    /// Judd-Vos, CIE 1978 (1988 V_M).
    #[serde(rename = "judd-vos-1978-v")]
    JuddVos1978,
    /// 10°, CIE 1964.
    #[serde(rename = "cie-1964-v10")]
    Cie1964,
    /// CIE 2008 physiologically relevant, 2°.
    #[serde(rename = "cie-2008-v-2deg")]
    Cie2008Two,
    /// CIE 2008 physiologically relevant, 10°.
    #[serde(rename = "cie-2008-v-10deg")]
    Cie2008Ten,
}

/// The efficiency function's name is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown luminous efficiency function `{found}`; expected one of {}", Efficiency::ALL.map(Efficiency::table_name).join(", "))]
pub struct UnknownEfficiency {
    /// The word met.
    pub found: String,
}

impl Efficiency {
    /// All functions.
    pub const ALL: [Self; 6] =
        [Self::Cie1924, Self::Judd1951, Self::JuddVos1978, Self::Cie1964, Self::Cie2008Two, Self::Cie2008Ten];

    /// Name of the embedded table that holds the function.
    #[must_use]
    pub fn table_name(self) -> &'static str {
        match self {
            Self::Cie1924 => "cie-1924-v",
            Self::Judd1951 => "judd-1951-v",
            Self::JuddVos1978 => "judd-vos-1978-v",
            Self::Cie1964 => "cie-1964-v10",
            Self::Cie2008Two => "cie-2008-v-2deg",
            Self::Cie2008Ten => "cie-2008-v-10deg",
        }
    }

    /// The function as a weighting.
    #[must_use]
    pub fn weighting(self) -> Weighting {
        single(self.table_name())
    }
}

impl fmt::Display for Efficiency {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.table_name())
    }
}

impl FromStr for Efficiency {
    type Err = UnknownEfficiency;

    fn from_str(text: &str) -> Result<Self, UnknownEfficiency> {
        let word = text.to_lowercase();
        (Self::ALL.into_iter())
            .find(|e| e.table_name() == word)
            .ok_or_else(|| UnknownEfficiency { found: text.to_owned() })
    }
}

/// V′(λ), CIE 1951, as a weighting.
#[must_use]
pub fn scotopic() -> Weighting {
    single("cie-1951-v-prime")
}

/// The one column of an embedded table.
///
/// # Panics
/// Where the embedded table is broken, which a test excludes.
pub(crate) fn single(table: &str) -> Weighting {
    let table = tables::get(table).expect("the table is embedded");
    let name = &table.columns().last().expect("a table has columns").name;
    Weighting::table(table.wavelengths_nm(), table.column(name).expect("the column is its own"))
}

/// K_m and K′_m in lm/W.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Efficacy {
    /// Photopic, 683.002 by default.
    pub k_m: f64,
    /// Scotopic, 1700.06 by default.
    pub k_m_scotopic: f64,
}

impl Default for Efficacy {
    fn default() -> Self {
        Self { k_m: K_M, k_m_scotopic: K_M_SCOTOPIC }
    }
}

/// The radiometric, photopic and scotopic integrals compiled for one grid, sampling and contract.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    radiometric: Vec<f64>,
    photopic: Vec<f64>,
    scotopic: Vec<f64>,
    /// For bounds on the photopic integral.
    pub photopic_error: ErrorModel,
    efficacy: Efficacy,
}

/// The integrals of one spectrum, each in the unit of its samples times nm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Luminous {
    /// ∫ X_λ dλ over the whole tabulated range (W/m², W, …).
    pub radiometric: f64,
    /// K_m ∫ X_λ V(λ) dλ (lx, lm, …).
    pub photopic: f64,
    /// K′_m ∫ X_λ V′(λ) dλ.
    pub scotopic: f64,
}

impl Luminous {
    /// Luminous efficacy of radiation, lm/W; `None` without radiation.
    #[must_use]
    pub fn efficacy_lm_per_w(&self) -> Option<f64> {
        ratio(self.photopic, self.radiometric)
    }

    /// S/P ratio; `None` without photopic light.
    #[must_use]
    pub fn scotopic_photopic_ratio(&self) -> Option<f64> {
        ratio(self.scotopic, self.photopic)
    }
}

/// a/b, where that is a finite number.
pub(crate) fn ratio(a: f64, b: f64) -> Option<f64> {
    let quotient = a / b;
    (b != 0.0 && quotient.is_finite()).then_some(quotient)
}

impl Plan {
    /// Compiles the integrals. The radiometric total runs over the whole spectrum, or over the contract's range.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(
        efficiency: Efficiency,
        efficacy: Efficacy,
        grid: &Grid,
        sampling: Sampling,
        contract: &Contract,
    ) -> Result<Self, RuleError> {
        let of = |w: &Weighting| integrate::weights(grid, sampling, w, contract);
        let v = efficiency.weighting();
        Ok(Self {
            radiometric: of(&Weighting::unity())?,
            photopic: of(&v)?,
            scotopic: of(&scotopic())?,
            photopic_error: ErrorModel::new(grid, sampling, &v, contract),
            efficacy,
        })
    }

    /// The integrals of a spectrum's values on the plan's grid.
    #[must_use]
    pub fn evaluate(&self, values: &[f64]) -> Luminous {
        Luminous {
            radiometric: dot(&self.radiometric, values),
            photopic: self.efficacy.k_m * dot(&self.photopic, values),
            scotopic: self.efficacy.k_m_scotopic * dot(&self.scotopic, values),
        }
    }

    /// The weights of the photopic integral, without K_m.
    #[must_use]
    pub fn photopic_weights(&self) -> &[f64] {
        &self.photopic
    }

    /// K_m and K′_m used.
    #[must_use]
    pub fn efficacy(&self) -> Efficacy {
        self.efficacy
    }
}
