//! Physical and photometric constants: the exact SI values, and the historical ones that standards are defined with.

/// Speed of light in vacuum, m/s (exact, SI).
pub const SPEED_OF_LIGHT: f64 = 299_792_458.0;
/// Planck constant, J·s (exact, SI 2019).
pub const PLANCK: f64 = 6.626_070_15e-34;
/// Boltzmann constant, J/K (exact, SI 2019).
pub const BOLTZMANN: f64 = 1.380_649e-23;
/// Avogadro constant, 1/mol (exact, SI 2019).
pub const AVOGADRO: f64 = 6.022_140_76e23;
/// First radiation constant for radiance, c₁L = 2hc², W·m²/sr.
pub const FIRST_RADIATION_RADIANCE: f64 = 2.0 * PLANCK * SPEED_OF_LIGHT * SPEED_OF_LIGHT;
/// Second radiation constant c₂ = hc/k of the SI, m·K (1.438 776 877…e-2).
pub const SECOND_RADIATION_SI: f64 = PLANCK * SPEED_OF_LIGHT / BOLTZMANN;
/// Second radiation constant of the ITS-90, m·K, with which CIE 15:2018 defines correlated colour temperature.
pub const SECOND_RADIATION_ITS90: f64 = 1.4388e-2;
/// Second radiation constant with which CIE standard illuminant A was defined (NBS 1931), m·K.
pub const SECOND_RADIATION_NBS1931: f64 = 1.435e-2;
/// Luminous efficacy of monochromatic radiation of 540 THz, lm/W (exact, SI).
pub const K_CD: f64 = 683.0;
/// Maximum photopic luminous efficacy K_m, lm/W: 683/V(555.016 nm), as CIE 018:2019 rounds it.
pub const K_M: f64 = 683.002;
/// Maximum scotopic luminous efficacy K′_m, lm/W: 683/V′(555.016 nm) from the 1 nm table of V′(λ) interpolated linearly
/// (0.401 750 …); some standards print 1700.05 or 1700.
pub const K_M_SCOTOPIC: f64 = 1700.06;

/// The second radiation constant c₂ to build a Planckian radiator with.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum SecondRadiation {
    /// 1.4388e-2 m·K (ITS-90): what CIE 15:2018 prescribes for correlated colour temperature. The default.
    #[default]
    Its90,
    /// 1.438 776 877…e-2 m·K, exact from the SI of 2019. Moves a CCT of 6500 K by 0.1 K.
    Si,
    /// 1.435e-2 m·K (NBS 1931): standard illuminant A is 2848 K with it, 2856 K with the ITS-90 value.
    Nbs1931,
}

impl SecondRadiation {
    /// The value in m·K.
    #[must_use]
    pub fn metre_kelvin(self) -> f64 {
        match self {
            Self::Its90 => SECOND_RADIATION_ITS90,
            Self::Si => SECOND_RADIATION_SI,
            Self::Nbs1931 => SECOND_RADIATION_NBS1931,
        }
    }
}
