//! CIECAM02 and its uniform colour space CAM02-UCS, as colour-fidelity calculations use them.

use glam::{DMat3, DVec3};

/// Adapting luminance, cd/m² (CIE 224:2017, 4.3).
const ADAPTING_LUMINANCE: f64 = 100.0;
/// Relative background luminance Y_b.
const BACKGROUND: f64 = 20.0;
/// Surround factor c (average).
const SURROUND: f64 = 0.69;
/// Chromatic induction N_c (average).
const INDUCTION: f64 = 1.0;

/// CIECAM02 under one white with the viewing conditions of CIE 224:2017: L_A = 100 cd/m², Y_b = 20, average surround,
/// complete adaptation (D = 1).
///
/// Reference: CIE 159:2004; the UCS coefficients are those of Luo, Cui & Li, Color Res. Appl. 31 (2006).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cam02 {
    to_cones: DMat3,
    luminance_factor: f64,
    n_bb: f64,
    /// c·z, the exponent of lightness.
    lightness_exponent: f64,
    /// (1.64 − 0.29ⁿ)^0.73 · F_L^¼, from t^0.9·√(J/100) to colourfulness.
    colourfulness_factor: f64,
    achromatic_white: f64,
}

fn rows(r: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&r).transpose()
}

impl Cam02 {
    /// The model under a white of tristimulus values `white` (any scale; only ratios to Y count).
    ///
    /// `None` where a sharpened cone signal of the white is not positive.
    #[must_use]
    pub fn new(white: [f64; 3]) -> Option<Self> {
        let cat02 = rows([[0.7328, 0.4296, -0.1624], [-0.7036, 1.6975, 0.0061], [0.0030, 0.0136, 0.9834]]);
        let hpe = rows([[0.38971, 0.68898, -0.07868], [-0.22981, 1.18340, 0.04641], [0.0, 0.0, 1.0]]);
        let white = DVec3::from(white) * (100.0 / white[1]);
        let sharpened = cat02 * white;
        if !(sharpened.is_finite() && sharpened.min_element() > 0.0) {
            return None;
        }
        // D = 1: each sharpened signal is scaled to Y_w = 100.
        let to_cones = hpe * cat02.inverse() * DMat3::from_diagonal(100.0 / sharpened) * cat02;
        let k = 1.0 / (5.0 * ADAPTING_LUMINANCE + 1.0);
        let k4 = k.powi(4);
        let luminance_factor = k4 * ADAPTING_LUMINANCE + 0.1 * (1.0 - k4).powi(2) * (5.0 * ADAPTING_LUMINANCE).cbrt();
        let n = BACKGROUND / 100.0;
        let mut model = Self {
            to_cones,
            luminance_factor,
            n_bb: 0.725 * n.powf(-0.2),
            lightness_exponent: SURROUND * (1.48 + n.sqrt()),
            colourfulness_factor: (1.64 - 0.29_f64.powf(n)).powf(0.73) * luminance_factor.powf(0.25),
            achromatic_white: 1.0,
        };
        model.achromatic_white = model.achromatic(model.compress(white));
        Some(model)
    }

    /// Post-adaptation signals R′a, G′a, B′a of XYZ on the scale where white has Y = 100.
    fn compress(&self, xyz: DVec3) -> DVec3 {
        let f = |v: f64| {
            let p = (self.luminance_factor * v.abs() / 100.0).powf(0.42);
            (400.0 * p / (p + 27.13)).copysign(v) + 0.1
        };
        let cones = self.to_cones * xyz;
        DVec3::new(f(cones.x), f(cones.y), f(cones.z))
    }

    fn achromatic(&self, c: DVec3) -> f64 {
        (2.0 * c.x + c.y + c.z / 20.0 - 0.305) * self.n_bb
    }

    /// J′, a′, b′ of tristimulus values on the scale where white has Y = 100.
    #[must_use]
    pub fn ucs(&self, xyz: [f64; 3]) -> [f64; 3] {
        let c = self.compress(DVec3::from(xyz));
        let a = c.x - 12.0 * c.y / 11.0 + c.z / 11.0;
        let b = (c.x + c.y - 2.0 * c.z) / 9.0;
        // cos h and sin h without the angle; without chroma the hue does not matter.
        let length = (a * a + b * b).sqrt();
        let (cos, sin) = if length > 0.0 { (a / length, b / length) } else { (1.0, 0.0) };
        let (sin_2, cos_2) = 2.0_f64.sin_cos();
        let eccentricity = 0.25 * (cos * cos_2 - sin * sin_2 + 3.8);
        let ratio = (self.achromatic(c) / self.achromatic_white).max(0.0);
        let j = ratio.powf(self.lightness_exponent);
        let t = 50_000.0 / 13.0 * INDUCTION * self.n_bb * eccentricity * length / (c.x + c.y + 1.05 * c.z);
        let colourfulness = t.max(0.0).powf(0.9) * j.sqrt() * self.colourfulness_factor;
        let m = (0.0228 * colourfulness).ln_1p() / 0.0228;
        [170.0 * j / (1.0 + 0.7 * j), m * cos, m * sin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_lightness_100_without_colour() {
        for white in [[95.047, 100.0, 108.883], [109.85, 100.0, 35.585], [0.95, 1.0, 1.09]] {
            let model = Cam02::new(white).expect("positive cones");
            let [j, a, b] = model.ucs(white.map(|v| v * 100.0 / white[1]));
            // J = 100 for white by definition, and D = 1 leaves it without chroma; the first HPE row of
            // CIE 159 adds up to 1.00001, which the factor 50000/13 of t turns into up to 1e-2 in a′.
            assert!((j - 100.0).abs() < 1e-9 && a.abs() < 1e-2 && b.abs() < 1e-2, "{j} {a} {b}");
        }
        assert_eq!(Cam02::new([1.0, 0.0, 0.0]), None);
        assert_eq!(Cam02::new([f64::NAN, 1.0, 1.0]), None);
    }
}
