//! How far a mean of few values may lie from the truth (Student's t), and how far further values may lie from that mean.

/// The value that |t| exceeds in 5 % of all cases, for at least 4 degrees of freedom.
///
/// Fisher's expansion (Abramowitz & Stegun, *Handbook of Mathematical Functions*, 26.7.5) to four terms; off by less than 0.005 from 4
/// degrees of freedom on, by less than 0.0005 from 8 on.
#[must_use]
pub fn two_sided_95(freedom: f64) -> f64 {
    /// The same of the normal distribution.
    const Z: f64 = 1.959_963_984_540_054;
    let power = |n: i32| Z.powi(n);
    let g1 = (power(3) + Z) / 4.0;
    let g2 = (5.0 * power(5) + 16.0 * power(3) + 3.0 * Z) / 96.0;
    let g3 = (3.0 * power(7) + 19.0 * power(5) + 17.0 * power(3) - 15.0 * Z) / 384.0;
    let g4 = (79.0 * power(9) + 776.0 * power(7) + 1482.0 * power(5) - 1920.0 * power(3) - 945.0 * Z) / 92_160.0;
    Z + (g1 + (g2 + (g3 + g4 / freedom) / freedom) / freedom) / freedom
}

/// How many of their standard deviations to both sides of the mean of `count` normal values 95 % of all such values lie, with a confidence
/// of which `z` is the one-sided quantile of the normal distribution (1.645 of 95 %), for at least 5 values.
///
/// ```text
/// k = 1.96 √((1 + 1/n)(n − 1)/χ²),    χ² = ν (1 − 2/(9ν) − z √(2/(9ν)))³,    ν = n − 1
/// ```
///
/// W. G. Howe, JASA 64 (1969) 610; E. B. Wilson & M. M. Hilferty, PNAS 17 (1931) 684. Too large by up to 2 % at a confidence of 99 %.
#[must_use]
pub fn tolerance_95(count: f64, z: f64) -> f64 {
    let freedom = count - 1.0;
    let ninth = 2.0 / (9.0 * freedom);
    // Of 5 values it is positive up to z = 4.
    let chi_squared = freedom * (1.0 - ninth - z * ninth.sqrt()).max(1e-3).powi(3);
    1.959_963_984_540_054 * ((1.0 + 1.0 / count) * freedom / chi_squared).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{tolerance_95, two_sided_95};

    #[test]
    fn tolerance_limits_are_those_of_the_table() {
        // ISO 16269-6, two-sided, both parameters unknown, 95 % of the population: confidence of 95 % and of 99 %.
        for (count, z, expected) in [
            (10.0, 1.645, 3.379),
            (12.0, 1.645, 3.162),
            (20.0, 1.645, 2.752),
            (10.0, 2.326, 4.265),
            (20.0, 2.326, 3.168),
        ] {
            let found = tolerance_95(count, z);
            assert!((found / expected - 1.0).abs() < 0.02, "{count} {z}: {found}");
        }
    }

    #[test]
    fn the_values_are_those_of_the_table() {
        // Abramowitz & Stegun, table 26.10, A = 0.95.
        for (freedom, expected) in [(4.0, 2.776), (5.0, 2.571), (7.0, 2.365)] {
            assert!((two_sided_95(freedom) - expected).abs() < 0.005, "{freedom}: {}", two_sided_95(freedom));
        }
        for (freedom, expected) in [(8.0, 2.306), (9.0, 2.262), (15.0, 2.131), (31.0, 2.040), (120.0, 1.980)] {
            assert!((two_sided_95(freedom) - expected).abs() < 0.001, "{freedom}: {}", two_sided_95(freedom));
        }
    }
}
