//! α-opic quantities of CIE S 026/E:2018: how strongly light acts on the five photoreceptors of the human eye.

use std::sync::OnceLock;

use crate::constants::K_M;
use crate::spectrum::integrate::{self, Contract, RuleError, Weighting, dot};
use crate::spectrum::{Grid, Sampling};
use crate::tables;

use super::luminous::{Efficiency, ratio};

/// Range of the action spectra, nm; the luminous integral beside them is taken over the same (CIE S 026, 3.1).
pub const RANGE_NM: (f64, f64) = (380.0, 780.0);

/// The receptors in the order of results; each is the name of the table's column, too.
pub const RECEPTORS: [&str; 5] = ["s_cone_opic", "m_cone_opic", "l_cone_opic", "rhodopic", "melanopic"];

/// Recommended melanopic equivalent daylight illuminance at the eye of healthy adults, measured vertically at about 1.2 m
/// (Brown et al. 2022, PLoS Biology 20(3), e3001571).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recommendation {
    /// Key in the results.
    pub when: &'static str,
    /// The recommendation in words.
    pub word: &'static str,
    /// The bound, lx.
    pub bound_lx: f64,
    /// Whether the bound is the least.
    pub at_least: bool,
}

impl Recommendation {
    /// Whether an illuminance keeps it.
    #[must_use]
    pub fn is_met(&self, edi_lx: f64) -> bool {
        if self.at_least { edi_lx >= self.bound_lx } else { edi_lx <= self.bound_lx }
    }
}

/// The three recommendations.
pub const RECOMMENDATIONS: [Recommendation; 3] = [
    Recommendation { when: "day", word: "by day at least 250 lx", bound_lx: 250.0, at_least: true },
    Recommendation {
        when: "evening",
        word: "in the three hours before bed at most 10 lx",
        bound_lx: 10.0,
        at_least: false,
    },
    Recommendation { when: "night", word: "asleep at most 1 lx", bound_lx: 1.0, at_least: false },
];

/// The action of one light on one receptor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlphaOpic {
    /// Key of the receptor, such as `melanopic`.
    pub receptor: &'static str,
    /// ∫ X_λ s_α(λ) dλ, in the unit of the samples times nm (W/m² for irradiance).
    pub radiometric: f64,
    /// α-opic efficacy of luminous radiation, W/lm.
    pub efficacy_w_per_lm: Option<f64>,
    /// α-opic daylight (D65) efficacy ratio.
    pub der: Option<f64>,
    /// α-opic equivalent daylight (D65) quantity: the illuminance (lx), luminance … of D65 that acts as strongly.
    pub equivalent_daylight: f64,
}

/// The action spectra compiled for one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    luminous: Vec<f64>,
    actions: [Vec<f64>; 5],
    k_m: f64,
}

/// The action spectra in the order of [`RECEPTORS`].
///
/// # Panics
/// Where the embedded table is broken, which a test excludes.
#[must_use]
pub fn action_spectra() -> [Weighting; 5] {
    let table = tables::get("cie-s026").expect("the action spectra are embedded");
    RECEPTORS
        .map(|column| Weighting::table(table.wavelengths_nm(), table.column(column).expect("one column per receptor")))
}

/// A contract with its range narrowed to [`RANGE_NM`].
#[must_use]
pub fn within_range(contract: &Contract) -> Contract {
    let (low, high) = contract.range_nm.unwrap_or(RANGE_NM);
    Contract { rule: contract.rule, range_nm: Some((low.max(RANGE_NM.0), high.min(RANGE_NM.1))) }
}

/// α-opic efficacies of luminous radiation of D65, W/lm, in the order of [`RECEPTORS`]: summed over the 5 nm table of D65
/// with K_m = 683.002 (melanopic 1.326 348 mW/lm; the standard prints 1.3262, the 1 nm table of D65 gives 1.326 209).
#[must_use]
pub fn daylight_efficacies() -> [f64; 5] {
    static EFFICACIES: OnceLock<[f64; 5]> = OnceLock::new();
    *EFFICACIES.get_or_init(|| {
        let table = tables::get("cie-illuminants").expect("the illuminants are embedded");
        let d65 = table.column("D65").expect("D65 is among them");
        let grid = Grid::new(table.wavelengths_nm().to_vec()).expect("the table ascends");
        let plan = Plan::new(K_M, &grid, Sampling::Density, &Contract::default()).expect("the table is uniform");
        let luminous = K_M * dot(&plan.luminous, d65);
        [0, 1, 2, 3, 4].map(|k| dot(&plan.actions[k], d65) / luminous)
    })
}

impl Plan {
    /// Compiles the action spectra; the contract's range is narrowed to 380–780 nm.
    ///
    /// # Errors
    /// [`RuleError`] where the contract's rule does not fit the grid.
    pub fn new(k_m: f64, grid: &Grid, sampling: Sampling, contract: &Contract) -> Result<Self, RuleError> {
        let contract = within_range(contract);
        let of = |w: &Weighting| integrate::weights(grid, sampling, w, &contract);
        let [s, m, l, rod, mel] = action_spectra();
        Ok(Self {
            luminous: of(&Efficiency::Cie1924.weighting())?,
            actions: [of(&s)?, of(&m)?, of(&l)?, of(&rod)?, of(&mel)?],
            k_m,
        })
    }

    /// The actions of a spectrum's values on the plan's grid, in the order of [`RECEPTORS`].
    #[must_use]
    pub fn evaluate(&self, values: &[f64]) -> [AlphaOpic; 5] {
        let luminous = self.k_m * dot(&self.luminous, values);
        let daylight = daylight_efficacies();
        std::array::from_fn(|k| {
            let radiometric = dot(&self.actions[k], values);
            let efficacy = ratio(radiometric, luminous);
            AlphaOpic {
                receptor: RECEPTORS[k],
                radiometric,
                efficacy_w_per_lm: efficacy,
                der: efficacy.map(|e| e / daylight[k]),
                equivalent_daylight: radiometric / daylight[k],
            }
        })
    }
}
