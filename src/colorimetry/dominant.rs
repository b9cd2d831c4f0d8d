//! Dominant wavelength and excitation purity (CIE 15:2018, 9.2–9.3).

use std::sync::OnceLock;

use super::chromaticity;
use super::observer::Observer;

/// Below this distance from the white point in (x, y) there is no hue: the print of CIE chromaticities to four digits.
const ACHROMATIC: f64 = 1e-5;
/// Ends of the purple line, nm.
const PURPLE_NM: (f64, f64) = (380.0, 700.0);

/// The hue and strength of a chromaticity, against a white point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dominant {
    /// Dominant wavelength, nm; for purples the complementary wavelength with a minus sign, as CIE 15 writes λ_c.
    pub wavelength_nm: f64,
    /// Excitation purity: distance from white over that of the boundary (spectral locus or purple line) in the same
    /// direction; 0 at white, 1 on the boundary.
    pub excitation_purity: f64,
}

/// The spectral locus of an observer: wavelength in nm, x, y.
#[must_use]
pub fn spectral_locus(observer: Observer) -> Vec<[f64; 3]> {
    locus(observer).to_vec()
}

fn locus(observer: Observer) -> &'static [[f64; 3]] {
    static LOCI: [OnceLock<Vec<[f64; 3]>>; 4] = [const { OnceLock::new() }; 4];
    LOCI[observer as usize].get_or_init(|| {
        let [x, y, z] = observer.colour_matching_functions();
        (x.wavelengths_nm().iter())
            .filter_map(|&w| chromaticity::xy([x.at(w), y.at(w), z.at(w)]).map(|[cx, cy]| [w, cx, cy]))
            .collect()
    })
}

/// The point of a wavelength, or where the observer's table does not go so far, the point at `otherwise`.
fn at_or(locus: &[[f64; 3]], wavelength_nm: f64, otherwise: usize) -> Option<[f64; 3]> {
    locus.iter().find(|p| p[0] == wavelength_nm).or_else(|| locus.get(otherwise)).copied()
}

/// Dominant wavelength and purity of `xy` against the white point `white_xy`; `None` where the two coincide.
///
/// The ray from white through the colour is cut with the straight pieces between the 1 nm points of the spectral locus. Its
/// violet end turns back on itself within 1e-3: of several cuts the one nearest to the colour counts. Where the ray meets the purple line, the wavelength is that of the opposite ray, negative.
#[must_use]
pub fn dominant(xy: [f64; 2], white_xy: [f64; 2], observer: Observer) -> Option<Dominant> {
    let locus = locus(observer);
    let direction = [xy[0] - white_xy[0], xy[1] - white_xy[1]];
    let distance = direction[0].hypot(direction[1]);
    if distance.is_nan() || distance <= ACHROMATIC {
        return None;
    }
    // The purple line joins the ends of the visible spectrum as CIE 15 draws them; further out the locus turns back.
    let (first, last) = (at_or(locus, PURPLE_NM.0, 0)?, at_or(locus, PURPLE_NM.1, locus.len().saturating_sub(1))?);
    if let Some((t, wavelength_nm)) = cut_locus(white_xy, direction, locus) {
        return Some(Dominant { wavelength_nm, excitation_purity: 1.0 / t });
    }
    let (_, complementary) = cut_locus(white_xy, [-direction[0], -direction[1]], locus)?;
    let (t, _) = cut(white_xy, direction, [first[1], first[2]], [last[1], last[2]])?;
    Some(Dominant { wavelength_nm: -complementary, excitation_purity: 1.0 / t })
}

fn cut_locus(white: [f64; 2], direction: [f64; 2], locus: &[[f64; 3]]) -> Option<(f64, f64)> {
    let cuts = locus.windows(2).filter_map(|w| {
        let (t, s) = cut(white, direction, [w[0][1], w[0][2]], [w[1][1], w[1][2]])?;
        Some((t, w[0][0] + s * (w[1][0] - w[0][0])))
    });
    cuts.min_by(|a, b| (a.0 - 1.0).abs().total_cmp(&(b.0 - 1.0).abs()))
}

/// Where the ray `origin + t·direction`, t > 0, meets the segment a–b: (t, place on the segment from 0 to 1).
fn cut(origin: [f64; 2], direction: [f64; 2], a: [f64; 2], b: [f64; 2]) -> Option<(f64, f64)> {
    let edge = [b[0] - a[0], b[1] - a[1]];
    let to_a = [a[0] - origin[0], a[1] - origin[1]];
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let denominator = cross(direction, edge);
    let (t, s) = (cross(to_a, edge) / denominator, cross(to_a, direction) / denominator);
    // A colour that is a point of the locus may fall between its two pieces by rounding.
    let tolerance = 1e-9;
    (t > 0.0 && t.is_finite() && (-tolerance..=1.0 + tolerance).contains(&s)).then_some((t, s.clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EQUAL_ENERGY: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];

    #[test]
    fn spectral_colours_are_their_own_dominant_wavelength() {
        for [w, x, y] in spectral_locus(Observer::Cie1931) {
            let got = dominant([x, y], EQUAL_ENERGY, Observer::Cie1931).expect("coloured");
            assert!((got.excitation_purity - 1.0).abs() < 1e-9, "{w}: {got:?}");
            // Beyond 690 nm the tabulated locus stands still.
            if (420.0..=680.0).contains(&w) {
                assert!((got.wavelength_nm - w).abs() < 1e-6, "{w}: {got:?}");
            }
        }
    }

    #[test]
    fn halfway_to_white_has_half_the_purity() {
        let locus = spectral_locus(Observer::Cie1931);
        let [_, x, y] = *locus.iter().find(|p| p[0] == 580.0).expect("a wavelength of the table");
        let half = [0.5 * (x + EQUAL_ENERGY[0]), 0.5 * (y + EQUAL_ENERGY[1])];
        let got = dominant(half, EQUAL_ENERGY, Observer::Cie1931).expect("coloured");
        assert!((got.wavelength_nm - 580.0).abs() < 1e-6 && (got.excitation_purity - 0.5).abs() < 1e-9, "{got:?}");
    }

    #[test]
    fn purple_has_a_complementary_wavelength_and_white_has_none() {
        let got = dominant([0.35, 0.15], EQUAL_ENERGY, Observer::Cie1931).expect("coloured");
        assert!((-570.0..-530.0).contains(&got.wavelength_nm) && got.excitation_purity < 1.0, "{got:?}");
        assert_eq!(dominant(EQUAL_ENERGY, EQUAL_ENERGY, Observer::Cie1931), None);
        assert_eq!(dominant([f64::NAN, 0.3], EQUAL_ENERGY, Observer::Cie1931), None);
    }
}
