//! Chromaticity diagrams: projective coordinates of tristimulus values.
//!
//! All functions give `None` where the coordinates are not defined (a zero or non-finite denominator), never NaN.

/// CIE 1931 (or the observer's own) x, y (CIE 15:2018, eq. 7.4).
#[must_use]
pub fn xy([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    quotient([x, y], x + y + z)
}

/// CIE 1976 u′, v′ (CIE 15:2018, eq. 8.27).
#[must_use]
pub fn uv_prime([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    quotient([4.0 * x, 9.0 * y], x + 15.0 * y + 3.0 * z)
}

/// CIE 1960 u, v, in which correlated colour temperature is defined: u = u′, v = ⅔v′.
#[must_use]
pub fn uv_1960([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    quotient([4.0 * x, 6.0 * y], x + 15.0 * y + 3.0 * z)
}

/// u′, v′ of x, y.
#[must_use]
pub fn uv_prime_of_xy([x, y]: [f64; 2]) -> Option<[f64; 2]> {
    quotient([4.0 * x, 9.0 * y], -2.0 * x + 12.0 * y + 3.0)
}

/// XYZ with Y = 1 of x, y.
#[must_use]
pub fn xyz_of_xy([x, y]: [f64; 2]) -> Option<[f64; 3]> {
    quotient([x, 1.0 - x - y], y).map(|[x, z]| [x, 1.0, z])
}

fn quotient([a, b]: [f64; 2], denominator: f64) -> Option<[f64; 2]> {
    let pair = [a / denominator, b / denominator];
    (denominator != 0.0 && denominator.is_finite() && pair.iter().all(|v| v.is_finite())).then_some(pair)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagrams_agree_with_one_another_and_refuse_black() {
        // Equal energy: x = y = 1/3, u′ = 4/19, v′ = 9/19.
        let white = [2.0, 2.0, 2.0];
        assert_eq!(xy(white), Some([1.0 / 3.0, 1.0 / 3.0]));
        assert_eq!(uv_prime(white), Some([4.0 / 19.0, 9.0 / 19.0]));
        assert_eq!(uv_1960(white), Some([4.0 / 19.0, 6.0 / 19.0]));
        for f in [xy, uv_prime, uv_1960] {
            assert_eq!(f([0.0; 3]), None);
            assert_eq!(f([f64::MAX; 3]), None);
        }
        assert_eq!(xyz_of_xy([0.3, 0.0]), None);
    }
}
