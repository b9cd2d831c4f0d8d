//! Colours of no light and of all light, differences below and beyond what anybody sees, temperatures beyond the Planckian locus's ends.

use photopic::colorimetry::Observer;
use photopic::colorimetry::cct;
use photopic::colorimetry::chromaticity::{uv_1960, uv_prime, xy, xyz_of_xy};
use photopic::colorimetry::difference::{ciede2000, lab};
use photopic::colorimetry::dominant::{dominant, spectral_locus};
use photopic::colorimetry::rgb::Encoding;
use photopic::constants::SecondRadiation;
use photopic::tables;

use crate::close;

/// A chromaticity is a ratio: it has the same digits for starlight and for the sun, to the ends of a double.
#[test]
fn chromaticity_is_the_same_at_any_level() {
    let of = |scale: f64| [0.5 * scale, scale, 1.25 * scale];
    for scale in [1e-320, 1e-300, 1e-6, 1.0, 2e9, 1e300, 1e306] {
        // Denormal numbers have fewer bits: 1e-320 is 2024 of them.
        let digits = if scale < 1e-307 { 1.0 / 1000.0 } else { 1e-15 };
        let [x, y] = xy(of(scale)).unwrap_or_else(|| panic!("{scale:e} has a chromaticity"));
        close(x, 0.5 / 2.75, digits, "x");
        close(y, 1.0 / 2.75, digits, "y");
        let [u, v] = uv_prime(of(scale)).unwrap_or_else(|| panic!("{scale:e} has u′, v′"));
        // u′ = 4X/(X + 15Y + 3Z), v′ = 9Y/(X + 15Y + 3Z) (CIE 15, 5.3): the denominator is 19.25.
        close(u, 2.0 / 19.25, digits, "u′");
        close(v, 9.0 / 19.25, digits, "v′");
    }
    for nothing in [[0.0; 3], [f64::NAN, 1.0, 1.0], [-1.0, 0.5, 0.5]] {
        assert!(xy(nothing).is_none() && uv_prime([0.0; 3]).is_none() && uv_1960([0.0; 3]).is_none(), "{nothing:?}");
    }
    assert!(xyz_of_xy([0.3, 0.0]).is_none());
}

/// CIE 15, 8.2.1: below (6/29)³ L* is 903.3 Y/Y_n, (29/3)³ exactly; above a cube root.
#[test]
fn lightness_runs_from_nothing_to_a_sun_on_paper() {
    let white = [0.95, 1.0, 1.09];
    let of = |scale: f64| lab(white.map(|w| w * scale), white);
    assert!(of(0.0).iter().all(|v| v.abs() < 1e-14), "{:?}", of(0.0));
    for (scale, lightness) in [(1e-9, 9.032_962_962_962_964e-7), (1.0, 100.0), (1e12, 1_159_984.0)] {
        let [l, a, b] = of(scale);
        // 116 f − 16 cancels at the dark end: what is left is of the size of rounding of 16.
        assert!((l - lightness).abs() <= 1e-15 * (16.0 + 2.0 * lightness), "{scale}: {l}");
        assert!(
            a.abs() <= 1e-15 * 500.0 * (1.0 + lightness) && b.abs() <= 1e-15 * 200.0 * (1.0 + lightness),
            "{a} {b}"
        );
    }
}

/// CIEDE2000: nothing between alike colours, S_L = 1 for ΔL at L* = 50, no step across the seam of the hue.
#[test]
fn differences_of_colour_vanish_with_the_difference() {
    for colour in [[0.0; 3], [50.0, 0.0, 0.0], [100.0, -128.0, 128.0], [50.0, 1e-300, -1e-300], [1e6, 1e6, -1e6]] {
        assert_eq!(ciede2000(colour, colour), 0.0, "{colour:?}");
    }
    for exponent in [-40, -30, -10] {
        let step = 2_f64.powi(exponent);
        let (grey, lighter) = ([50.0, 0.0, 0.0], [50.0 + step, 0.0, 0.0]);
        // ΔL' = step exactly, and S_L at a mean of 50 + step/2 is 1 + 0.015 (step/2)²/√20.
        close(ciede2000(grey, lighter), step, 1e-14 + step * step, "ΔE₀₀");
        assert_eq!(ciede2000(lighter, grey), ciede2000(grey, lighter));
    }
    // A turn of the hue by 2e-9 rad across 0° is one of 2e-9 rad anywhere: C ΔH is 1e-7, over S_H > 1.
    let across = ciede2000([50.0, 50.0, 5e-8], [50.0, 50.0, -5e-8]);
    assert!(across > 0.0 && across < 1e-7, "{across}");
}

/// The Planckian locus ends where T → ∞, L ∝ λ⁻⁴ (Rayleigh and Jeans); beyond there is no temperature.
#[test]
fn temperatures_are_found_to_the_ends_of_the_locus_and_not_beyond() {
    let c2 = SecondRadiation::Its90;
    for kelvin in [500.0, 1000.0, 6504.0, 25_000.0, 100_000.0] {
        let found = cct::nearest(cct::planckian_uv(kelvin, c2), c2).expect("on the locus");
        // Rounding of u and v, 1e-16 where a mired moves them by 1e-5 at least, is 1e-11 of the 10 mired that are 1e5 K.
        close(found.kelvin, kelvin, 1e-9, "its own temperature");
        assert!(found.duv.abs() < 1e-12, "{found:?}");
    }
    let table = tables::get("cie-1931-2deg").expect("embedded");
    let sum = |name| {
        let bar = table.wavelengths_nm().iter().zip(table.column(name).expect("its column"));
        bar.map(|(nm, v)| v * (nm / 560.0).powi(-4)).sum::<f64>()
    };
    let limit = uv_1960(["x_bar", "y_bar", "z_bar"].map(sum)).expect("a colour");
    // The next term of the series is hc/(2λkT): 1e-8 of it at 1e12 K.
    let end = cct::planckian_uv(1e12, c2);
    close(end[0], limit[0], 1e-7, "u at the end");
    close(end[1], limit[1], 1e-7, "v at the end");
    // Deep blue and deep red have none.
    for xy in [[0.15, 0.05], [0.73, 0.26], [0.2, 0.2]] {
        let xyz = xyz_of_xy(xy).expect("y > 0");
        assert!(cct::nearest(uv_1960(xyz).expect("a colour"), c2).is_err(), "{xy:?}");
    }
}

#[test]
fn white_has_no_hue_and_the_locus_is_pure() {
    let white = [1.0 / 3.0, 1.0 / 3.0];
    let found = dominant(white, white, Observer::Cie1931);
    assert!(found.is_none_or(|d| d.excitation_purity.abs() < 1e-9), "{found:?}");
    let locus = spectral_locus(Observer::Cie1931);
    let green = locus.iter().find(|p| p[0] == 520.0).expect("520 nm");
    let pure = dominant([green[1], green[2]], white, Observer::Cie1931).expect("a hue");
    assert!((pure.wavelength_nm - 520.0).abs() < 1e-6 && (pure.excitation_purity - 1.0).abs() < 1e-9, "{pure:?}");
    // All but white.
    let nearly = white.map(|v| v + 1e-12);
    assert!(dominant(nearly, white, Observer::Cie1931).is_none_or(|d| d.excitation_purity < 1e-10));
}

/// IEC 61966-2-1 beyond 0 to 1, and what falls below its straight part.
#[test]
fn tone_curves_go_on_beyond_their_ends() {
    for (linear, coded) in
        [(1e-300, 12.92e-300), (1e9, 5_932.645_980_758_183), (-1e9, -5_932.645_980_758_183), (0.0, 0.0)]
    {
        close(Encoding::Srgb.encode(linear), coded, 1e-14, "sRGB");
        close(Encoding::Srgb.decode(coded), linear, 1e-14, "and back");
    }
}
