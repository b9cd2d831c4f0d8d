//! Mesopic photometry: the MES2 system of CIE 191:2010, between 0.005 and 5 cd/m².

use serde::Serialize;

/// V′(λ₀) at λ₀ = 555 nm as CIE 191 takes it: 683/1699.
const V_PRIME_555: f64 = 683.0 / 1699.0;
/// a in m = a + b lg L_mes.
const A: f64 = 0.7670;
/// b.
const B: f64 = 0.3334;
/// At and above this photopic luminance vision is photopic, cd/m².
pub const PHOTOPIC_FROM: f64 = 5.0;
/// At and below this mesopic luminance vision is scotopic, cd/m².
pub const SCOTOPIC_TO: f64 = 0.005;
/// The fixed point is approached by a factor of about 0.14/L·dL per step; far fewer are needed.
const STEPS: usize = 500;

/// The state of adaptation that MES2 finds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Adaptation {
    /// Mesopic luminance of the adapting field, cd/m².
    pub luminance_mesopic: f64,
    /// Adaptation coefficient, 0 (scotopic) to 1 (photopic).
    pub m: f64,
}

/// Why MES2 has no answer.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Not a luminance.
    #[error("an adaptation luminance of {found} cd/m²; expected a positive finite number")]
    Luminance {
        /// The number met.
        found: f64,
    },
    /// No S/P ratio to weight with.
    #[error("an S/P ratio of {found}; expected a number of at least 0")]
    Ratio {
        /// The number met.
        found: f64,
    },
}

/// The mesopic value for an adaptation coefficient m:
///
/// ```text
/// L_mes = (m L_p + (1 − m) L_s V′(λ₀)) / (m + (1 − m) V′(λ₀))
/// ```
///
/// It holds for illuminance and every other luminous quantity alike (CIE 191, eq. (4)).
#[must_use]
pub fn mesopic(photopic: f64, scotopic: f64, m: f64) -> f64 {
    (m * photopic + (1.0 - m) * scotopic * V_PRIME_555) / (m + (1.0 - m) * V_PRIME_555)
}

/// The adaptation to a field of photopic luminance `luminance` (cd/m²) whose light has the S/P ratio given.
///
/// ```text
/// m₀ = 0.5;  L_mes,n = mesopic(L_p, L_s, m_{n−1});  m_n = 0.7670 + 0.3334 lg L_mes,n,  0 ≤ m ≤ 1
/// ```
///
/// iterated to rest. m = 1 where L_mes ≥ 5 cd/m², 0 where it is ≤ 0.005 cd/m².
///
/// # Errors
/// [`Error`] for arguments that are not a luminance and a ratio.
pub fn adaptation(luminance: f64, scotopic_photopic_ratio: f64) -> Result<Adaptation, Error> {
    if !(luminance > 0.0 && luminance.is_finite()) {
        return Err(Error::Luminance { found: luminance });
    }
    if !(scotopic_photopic_ratio >= 0.0 && scotopic_photopic_ratio.is_finite()) {
        return Err(Error::Ratio { found: scotopic_photopic_ratio });
    }
    let scotopic = scotopic_photopic_ratio * luminance;
    let mut m = 0.5;
    for _ in 0..STEPS {
        let l = mesopic(luminance, scotopic, m);
        let next = if l >= PHOTOPIC_FROM {
            1.0
        } else if l <= SCOTOPIC_TO {
            0.0
        } else {
            (A + B * l.log10()).clamp(0.0, 1.0)
        };
        if next == m {
            break;
        }
        m = next;
    }
    Ok(Adaptation { luminance_mesopic: mesopic(luminance, scotopic, m), m })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_photopic_and_scotopic() {
        let day = adaptation(100.0, 2.0).expect("valid");
        assert_eq!((day.m, day.luminance_mesopic), (1.0, 100.0));
        let night = adaptation(1e-6, 2.0).expect("valid");
        assert_eq!((night.m, night.luminance_mesopic), (0.0, 2e-6));
        assert!(adaptation(0.0, 1.0).is_err() && adaptation(1.0, f64::NAN).is_err());
    }

    #[test]
    fn a_ratio_of_one_leaves_the_luminance_alone() {
        for l in [0.006, 0.1, 1.0, 4.9] {
            let got = adaptation(l, 1.0).expect("valid");
            assert!((got.luminance_mesopic / l - 1.0).abs() < 1e-15);
            assert!((got.m - (A + B * l.log10()).clamp(0.0, 1.0)).abs() < 1e-12);
        }
    }
}
