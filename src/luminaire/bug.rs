//! Backlight, uplight and glare ratings of outdoor luminaires.

use std::fmt;

use super::distribution::{Distribution, Symmetry, System};
use super::lcs::Lcs;

/// A BUG rating, each figure 0 to 5.
///
/// # Reference
/// IES TM-15-11, Addendum A, tables. Public texts confirm the limits of U2 and U3 (user's guide of the IDA/IES Model Lighting
/// Ordinance 2011: 50 lm and 500 lm in each of UL and UH) and those of U0, U1 and of FVH and BVH in G0 (I. Ashdown, "Photometric Imprecision Can Limit
/// BUG Rating Utility": 0 lm, 10 lm, 10 lm). The others
/// could not be held against a public copy; the crate `eulumdat` has other limits of G (FH 180, 600, 2000, 4000 lm).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BugRating {
    /// Backlight.
    pub backlight: u8,
    /// Uplight.
    pub uplight: u8,
    /// Glare.
    pub glare: u8,
}

impl fmt::Display for BugRating {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "B{}-U{}-G{}", self.backlight, self.uplight, self.glare)
    }
}

/// Which table of glare limits applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lateral {
    /// Types I to IV.
    Asymmetric,
    /// Types V and V square: the same at all lateral angles, or four times the same.
    QuadrilateralSymmetric,
}

/// Largest flux for each rating 0 to 4, lm; more is 5.
type Limits = [f64; 5];

/// Table A-1: BL and BH, BM.
const BACK_LOW_HIGH: Limits = [110.0, 500.0, 1000.0, 2500.0, 5000.0];
const BACK_MID: Limits = [220.0, 1000.0, 2500.0, 5000.0, 8500.0];
/// Table A-2: UL and UH.
const UP: Limits = [0.0, 10.0, 50.0, 500.0, 1000.0];
/// Table A-3: FVH and BVH; FH (and BH of Type V); BH of Types I to IV.
const VERY_HIGH: Limits = [10.0, 100.0, 225.0, 500.0, 750.0];
const FORWARD_HIGH: Limits = [660.0, 1800.0, 5000.0, 7500.0, 12000.0];
const BACK_HIGH_ASYMMETRIC: Limits = [110.0, 500.0, 1000.0, 2500.0, 5000.0];

/// The rating of a flux: how many limits it exceeds. A flux counts to the 0.1 lm to which reports print it, so that the tail
/// of an interpolation at 90° is no uplight.
fn rating(flux_lm: f64, limits: &Limits) -> u8 {
    let printed = (10.0 * flux_lm).round() / 10.0;
    limits.iter().filter(|limit| printed > **limit).count() as u8
}

/// The BUG rating of the zones of an outdoor luminaire; each figure is the worst of its zones.
#[must_use]
pub fn bug_rating(lcs: &Lcs, lateral: Lateral) -> BugRating {
    let ([_, _, fh, fvh], [bl, bm, bh, bvh], [ul, uh]) = (lcs.forward, lcs.back, lcs.up);
    let back_high = match lateral {
        Lateral::Asymmetric => &BACK_HIGH_ASYMMETRIC,
        Lateral::QuadrilateralSymmetric => &FORWARD_HIGH,
    };
    let worst = |ratings: &[u8]| ratings.iter().copied().max().unwrap_or(0);
    BugRating {
        backlight: worst(&[rating(bl, &BACK_LOW_HIGH), rating(bm, &BACK_MID), rating(bh, &BACK_LOW_HIGH)]),
        uplight: worst(&[rating(ul, &UP), rating(uh, &UP)]),
        glare: worst(&[
            rating(fvh, &VERY_HIGH),
            rating(bvh, &VERY_HIGH),
            rating(fh, &FORWARD_HIGH),
            rating(bh, back_high),
        ]),
    }
}

/// Whether a distribution is four times the same, within a tenth of its maximum: Type V or V square.
///
/// The standard leaves "essentially the same at all lateral angles" to the eye. Here I(C, γ) and I(C + 90°, γ) at the table's
/// planes and angles may differ by no more than [`QUADRILATERAL_TOLERANCE`] of the maximum.
#[must_use]
pub fn lateral(distribution: &Distribution) -> Lateral {
    if distribution.system() != System::TypeC {
        return Lateral::Asymmetric;
    }
    let (peak, ..) = distribution.peak();
    let planes = distribution.horizontal_deg().iter();
    let same = |c: f64, g: f64| {
        let turned = [90.0, 180.0, 270.0].map(|turn| (distribution.at(c + turn, g) - distribution.at(c, g)).abs());
        turned.iter().all(|d| *d <= QUADRILATERAL_TOLERANCE * peak)
    };
    let all = || planes.clone().all(|c| distribution.vertical_deg().iter().all(|g| same(*c, *g)));
    if distribution.symmetry() == Symmetry::Rotational || all() {
        Lateral::QuadrilateralSymmetric
    } else {
        Lateral::Asymmetric
    }
}

/// How far quadrants of a quadrilaterally symmetric luminaire may differ, relative to its maximum.
pub const QUADRILATERAL_TOLERANCE: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_figure_is_the_worst_of_its_zones() {
        let lcs = Lcs { forward: [900.0, 3000.0, 1800.0, 90.0], back: [400.0, 1001.0, 501.0, 11.0], up: [0.04, 0.0] };
        // BM 1001 → 2, BH 501 → 2; U0 (0.04 lm prints as 0.0); FH 1800 → 1, BH 501 → 2 (asymmetric), FVH 90 → 1.
        let rated = bug_rating(&lcs, Lateral::Asymmetric);
        assert_eq!(rated.to_string(), "B2-U0-G2");
        assert_eq!(bug_rating(&lcs, Lateral::QuadrilateralSymmetric).glare, 1);
        let dazzling = Lcs { forward: [0.0, 0.0, 0.0, 750.1], back: [0.0; 4], up: [0.1, 1000.1] };
        assert_eq!(bug_rating(&dazzling, Lateral::Asymmetric).to_string(), "B0-U5-G5");
    }

    #[test]
    fn a_street_light_is_not_type_v() {
        let table = |values: Vec<f64>| {
            Distribution::new(System::TypeC, Symmetry::Quadrant, vec![0.0, 90.0], vec![0.0, 90.0], values)
                .expect("sound")
        };
        assert_eq!(lateral(&table(vec![1.0, 1.0, 1.0, 0.95])), Lateral::QuadrilateralSymmetric);
        assert_eq!(lateral(&table(vec![1.0, 1.0, 1.0, 0.5])), Lateral::Asymmetric);
    }
}
