//! CIELAB and the colour difference CIEDE2000.

/// CIE 1976 L*, a*, b* (ISO/CIE 11664-4; CIE 15:2018, 8.2.1) of tristimulus values under a white of tristimulus values `white`
/// on the same scale.
///
/// ```text
/// L* = 116 f(Y/Yn) − 16,  a* = 500 (f(X/Xn) − f(Y/Yn)),  b* = 200 (f(Y/Yn) − f(Z/Zn))
/// f(t) = t^⅓ above (6/29)³, (841/108) t + 4/29 below
/// ```
///
/// Negative tristimulus values, as noise and colours out of a camera's gamut have, follow the straight part.
#[must_use]
pub fn lab(xyz: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    const LIMIT: f64 = 216.0 / 24_389.0;
    let f = |t: f64| if t > LIMIT { t.cbrt() } else { 841.0 / 108.0 * t + 4.0 / 29.0 };
    let [x, y, z] = std::array::from_fn(|i| f(xyz[i] / white[i]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The CIEDE2000 difference ΔE₀₀ of two colours in CIELAB, with the parametric factors k_L = k_C = k_H = 1.
///
/// Source: ISO/CIE 11664-6:2014 (CIE 142-2001). Where the standard leaves open what is meant by the mean of two hues, and by the
/// hue of a grey, this is as Sharma, Wu & Dalal (Color Res. Appl. 30, 2005) have it: the mean lies within the smaller angle, and a
/// grey has the hue of the other colour. The function is symmetric, and by them discontinuous where hues are opposite.
#[must_use]
pub fn ciede2000([l1, a1, b1]: [f64; 3], [l2, a2, b2]: [f64; 3]) -> f64 {
    let seventh = |c: f64| {
        let c7 = c.powi(7);
        (c7 / (c7 + 25.0_f64.powi(7))).sqrt()
    };
    let g = 0.5 * (1.0 - seventh(0.5 * (a1.hypot(b1) + a2.hypot(b2))));
    let (a1, a2) = ((1.0 + g) * a1, (1.0 + g) * a2);
    let (c1, c2) = (a1.hypot(b1), a2.hypot(b2));
    let hue = |a: f64, b: f64| if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a).to_degrees().rem_euclid(360.0) };
    let (h1, h2) = (hue(a1, b1), hue(a2, b2));
    let grey = c1 * c2 == 0.0;
    let turn = match h2 - h1 {
        _ if grey => 0.0,
        d if d > 180.0 => d - 360.0,
        d if d < -180.0 => d + 360.0,
        d => d,
    };
    let mean_hue = match h1 + h2 {
        sum if grey => sum,
        sum if (h1 - h2).abs() <= 180.0 => 0.5 * sum,
        sum if sum < 360.0 => 0.5 * (sum + 360.0),
        sum => 0.5 * (sum - 360.0),
    };
    let (mean_l, mean_c) = (0.5 * (l1 + l2), 0.5 * (c1 + c2));
    let cos = |degrees: f64| degrees.to_radians().cos();
    let t = 1.0 - 0.17 * cos(mean_hue - 30.0) + 0.24 * cos(2.0 * mean_hue) + 0.32 * cos(3.0 * mean_hue + 6.0)
        - 0.20 * cos(4.0 * mean_hue - 63.0);
    let from_50 = (mean_l - 50.0).powi(2);
    let lightness = (l2 - l1) / (1.0 + 0.015 * from_50 / (20.0 + from_50).sqrt());
    let chroma = (c2 - c1) / (1.0 + 0.045 * mean_c);
    let hue = 2.0 * (c1 * c2).sqrt() * (0.5 * turn).to_radians().sin() / (1.0 + 0.015 * mean_c * t);
    let rotation = -(60.0 * (-((mean_hue - 275.0) / 25.0).powi(2)).exp()).to_radians().sin() * 2.0 * seventh(mean_c);
    // Rounding may leave less than nothing under the root where both colours are alike.
    (lightness * lightness + chroma * chroma + hue * hue + rotation * chroma * hue).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pairs_of_sharma_wu_and_dalal() {
        let table = include_str!("../../tests/data/colour/ciede2000.csv");
        let rows = table.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
        let mut count = 0;
        for row in rows {
            let v: Vec<f64> = row.split(',').map(|c| c.parse().expect("a number")).collect();
            let (a, b) = ([v[0], v[1], v[2]], [v[3], v[4], v[5]]);
            for got in [ciede2000(a, b), ciede2000(b, a)] {
                assert!((got - v[6]).abs() <= 0.5e-4 + 1e-12, "{row}: {got}");
            }
            count += 1;
        }
        assert_eq!(count, 34);
    }

    #[test]
    fn white_and_grey_have_the_lightness_that_defines_them() {
        let white = [95.0, 100.0, 109.0];
        assert_eq!(lab(white, white), [100.0, 0.0, 0.0]);
        // Y/Yn = (6/29)³ is where both parts of f meet: L* = 116 · 6/29 − 16 = 8; a reflectance of 18.4187 % is L* = 50.
        let grey = |share: f64| lab(white.map(|v| share * v), white);
        assert!((grey(216.0 / 24_389.0)[0] - 8.0).abs() < 1e-12);
        assert!((grey((66.0_f64 / 116.0).powi(3))[0] - 50.0).abs() < 1e-12);
        let [l, a, b] = grey(-0.01);
        assert!((l + 0.01 * 24_389.0 / 27.0).abs() < 1e-12 && a == 0.0 && b == 0.0, "{l} {a} {b}");
    }
}
