//! Refractive indices n − ik of a few substances, by name.
//!
//! | name | what | source | range |
//! |---|---|---|---|
//! | `Ag`, `Au`, `Cu` | silver, gold, copper: evaporated films | Johnson & Christy 1972 | 354.2–892 nm |
//! | `Al` | aluminium: evaporated film | Rakić 1995 | 326.28–885.61 nm |
//! | `BK7`, `SF10` | crown and dense flint glass (Schott N-BK7, N-SF10) | Schott's Sellmeier coefficients | 300–2500, 380–2500 nm |
//! | `water` | distilled, 20 °C | Daimon & Masumura 2007 | 182–1129 nm |
//!
//! Metals are tables (`data/refractive`), read linearly; glasses and water are n² = 1 + Σ b λ²/(λ² − c), λ in µm, k = 0. Upper
//! and lower case are one; `silver`, `gold`, `copper`, `aluminium` are understood too. Outside of its range a substance is refused.
//! All are relative to air.

use crate::tables;

/// Why a refractive index could not be given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No such substance.
    #[error("no substance is called `{name}`; expected one of {}", NAMES.join(", "))]
    Unknown {
        /// What was asked for.
        name: String,
    },
    /// A wavelength at which it was not measured.
    #[error("`{name}` is known from {low_nm} to {high_nm} nm; {wavelength_nm} nm was asked for")]
    Outside {
        /// The substance.
        name: String,
        /// The wavelength.
        wavelength_nm: f64,
        /// First known.
        low_nm: f64,
        /// Last known.
        high_nm: f64,
    },
}

/// The substances.
pub const NAMES: [&str; 7] = ["Ag", "Al", "Au", "Cu", "BK7", "SF10", "water"];

/// A transparent substance: pairs (b, c) of n² = 1 + Σ b λ²/(λ² − c) with λ in µm.
struct Sellmeier {
    name: &'static str,
    range_nm: (f64, f64),
    terms: &'static [(f64, f64)],
    /// The index of what the formula is relative to, relative to air.
    outside: f64,
}

const GLASSES: [Sellmeier; 3] = [
    // SCHOTT optical glass catalogue, 2017-01-20.
    Sellmeier {
        name: "BK7",
        range_nm: (300.0, 2500.0),
        terms: &[(1.039_612_12, 0.006_000_698_67), (0.231_792_344, 0.020_017_914_4), (1.010_469_45, 103.560_653)],
        outside: 1.0,
    },
    Sellmeier {
        name: "SF10",
        range_nm: (380.0, 2500.0),
        terms: &[(1.621_539_02, 0.012_224_145_7), (0.256_287_842, 0.059_573_677_5), (1.644_475_52, 147.468_793)],
        outside: 1.0,
    },
    // M. Daimon & A. Masumura, Appl. Opt. 46 (2007), 20.0 °C.
    Sellmeier {
        name: "water",
        range_nm: (182.0, 1129.0),
        terms: &[
            (0.568_402_756_5, 0.005_101_829_712),
            (0.172_617_739_1, 0.018_211_539_36),
            (0.020_861_895_78, 0.026_207_222_93),
            (0.113_074_868_8, 10.697_927_21),
        ],
        // The formula is relative to vacuum; air of 20 °C has n = 1.000272 in the visible, 1e-5 more in the ultraviolet.
        outside: 1.0 / 1.000_272,
    },
];

/// n and k of a substance at the wavelengths.
///
/// # Errors
/// [`Error::Unknown`], [`Error::Outside`].
pub fn refractive_index(name: &str, wavelengths_nm: &[f64]) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let within = |low_nm: f64, high_nm: f64| match wavelengths_nm.iter().find(|w| !(low_nm..=high_nm).contains(*w)) {
        Some(w) => Err(Error::Outside { name: name.to_owned(), wavelength_nm: *w, low_nm, high_nm }),
        None => Ok(()),
    };
    if let Some(glass) = GLASSES.iter().find(|g| g.name.eq_ignore_ascii_case(name)) {
        within(glass.range_nm.0, glass.range_nm.1)?;
        let n = wavelengths_nm.iter().map(|w| {
            let l2 = (1e-3 * w) * (1e-3 * w);
            glass.outside * (1.0 + glass.terms.iter().map(|(b, c)| b * l2 / (l2 - c)).sum::<f64>()).sqrt()
        });
        return Ok((n.collect(), vec![0.0; wavelengths_nm.len()]));
    }
    let unknown = || Error::Unknown { name: name.to_owned() };
    let table = tables::get(name).map_err(|_| unknown())?;
    let (Some(n), Some(k), true) = (table.column("n"), table.column("k"), table.name().starts_with("nk-")) else {
        return Err(unknown());
    };
    let nm = table.wavelengths_nm();
    within(nm[0], nm[nm.len() - 1])?;
    Ok((
        wavelengths_nm.iter().map(|w| linear(nm, n, *w)).collect(),
        wavelengths_nm.iter().map(|w| linear(nm, k, *w)).collect(),
    ))
}

/// The value at `x` on the line through its neighbours; the end values outside.
pub(crate) fn linear(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let after = xs.partition_point(|v| *v <= x);
    match after {
        0 => ys[0],
        _ if after == xs.len() => ys[after - 1],
        _ => {
            let (a, b) = (after - 1, after);
            ys[a] + (ys[b] - ys[a]) * (x - xs[a]) / (xs[b] - xs[a])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn catalogue_values() {
        // n at the Fraunhofer lines d, F, C as Schott's data sheets print them (N-BK7 517642, N-SF10 728285).
        for (name, nm, printed) in [
            ("BK7", 587.5618, 1.516_80),
            ("bk7", 486.1327, 1.522_38),
            ("BK7", 656.2725, 1.514_32),
            ("SF10", 587.5618, 1.728_28),
        ] {
            let (n, k) = refractive_index(name, &[nm]).expect("a glass");
            assert!((n[0] - printed).abs() <= 0.5e-5, "{name} {nm}: {}", n[0]);
            assert_eq!(k, [0.0]);
        }
        // Water at 20 °C and 589.3 nm: 1.3330 in every handbook.
        assert!((refractive_index("water", &[589.3]).expect("water").0[0] - 1.3330).abs() <= 0.5e-4);
        // Johnson & Christy's row of 2.26 eV, and halfway to the next.
        assert_eq!(refractive_index("Au", &[548.6]), Ok((vec![0.43], vec![2.455])));
        let (n, _) = refractive_index("gold", &[0.5 * (548.6 + 582.1)]).expect("gold");
        assert!((n[0] - 0.36).abs() < 1e-12);
    }

    #[test]
    fn strangers_and_far_wavelengths_are_refused() {
        assert!(matches!(refractive_index("unobtainium", &[500.0]), Err(Error::Unknown { .. })));
        assert!(matches!(refractive_index("d65", &[500.0]), Err(Error::Unknown { .. })));
        let error = refractive_index("Ag", &[500.0, 1000.0]).expect_err("too far");
        assert_eq!(error.to_string(), "`Ag` is known from 354.2 to 892 nm; 1000 nm was asked for");
        assert!(NAMES.iter().all(|n| refractive_index(n, &[555.0]).is_ok()));
    }
}
