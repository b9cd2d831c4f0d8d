//! Spacing criterion: how far apart luminaires may hang before the floor between them looks darker than below them.

use super::distribution::{Distribution, System};
use super::unavailable::Unavailable;

/// Spacing over mounting height at which the midpoint between luminaires gets as much direct light as the point below one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpacingCriterion {
    /// Between two luminaires along C0–C180.
    pub c0_c180: f64,
    /// Between two luminaires along C90–C270.
    pub c90_c270: f64,
    /// Between four at the corners of a square.
    pub diagonal: f64,
}

/// Step in which spacings are tried and printed.
const STEPS_PER_UNIT: u32 = 50;
/// No spacing beyond this is tried: the midpoint is seen under 89°.
const LARGEST: u32 = 115;

/// The spacing criterion.
///
/// The smallest multiple of 0.02 of the mounting height at which the midpoint's illuminance falls below that at nadir of one
/// luminaire alone:
///
/// ```text
/// two:   2 I(C, γ) cos³γ < I(0),           tan γ = s/2,   C = 0° or 90°
/// four:  Σ I(45° + k 90°, γ) cos³γ < I(0), tan γ = s/√2,  k = 0…3
/// ```
///
/// These are the rules and the step by which Photometric Toolbox's printed values are met; for two luminaires it takes the
/// planes C0 and C90 alone, also where C180 and C270 differ.
///
/// # Errors
/// [`Unavailable::NotTypeC`]; [`Unavailable::Dark`] where there is no light at nadir.
///
/// # Reference
/// IES Lighting Handbook, "luminaire spacing criterion" (after Levin 1982).
pub fn spacing_criterion(distribution: &Distribution) -> Result<SpacingCriterion, Unavailable> {
    if distribution.system() != System::TypeC {
        return Err(Unavailable::NotTypeC);
    }
    let below = distribution.at(0.0, 0.0);
    if below <= 0.0 {
        return Err(Unavailable::Dark);
    }
    let first = |planes: &[f64], lamps: f64, distance_per_spacing: f64| {
        let lit = |step: u32| {
            let gamma = (f64::from(step) / f64::from(STEPS_PER_UNIT) * distance_per_spacing).atan();
            let mean =
                planes.iter().map(|c| distribution.at(*c, gamma.to_degrees())).sum::<f64>() / planes.len() as f64;
            lamps * mean * gamma.cos().powi(3) >= below
        };
        let steps = STEPS_PER_UNIT * LARGEST;
        f64::from((1..steps).find(|step| !lit(*step)).unwrap_or(steps)) / f64::from(STEPS_PER_UNIT)
    };
    Ok(SpacingCriterion {
        c0_c180: first(&[0.0], 2.0, 0.5),
        c90_c270: first(&[90.0], 2.0, 0.5),
        diagonal: first(&[45.0, 135.0, 225.0, 315.0], 4.0, std::f64::consts::FRAC_1_SQRT_2),
    })
}

#[cfg(test)]
mod tests {
    use super::super::distribution::Symmetry;
    use super::*;

    #[test]
    fn a_cosine_source_may_stand_1_29_apart() {
        let angles: Vec<f64> = (0..=90).map(f64::from).collect();
        let values = angles.iter().map(|g| g.to_radians().cos()).collect();
        let d = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], angles, values).expect("sound");
        let s = spacing_criterion(&d).expect("lit");
        // 2 cos⁴γ = 1: s = 2 tan 32.77° = 1.287; 4 cos⁴γ = 1: s = √2.
        assert_eq!((s.c0_c180, s.c90_c270, s.diagonal), (1.3, 1.3, 1.42));
    }
}
