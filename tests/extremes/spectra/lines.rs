//! Monochromatic light: K(λ) = K_m V(λ) at both ends of the tables and at the peak, as lines of no width and as densities 1 nm
//! and 0.1 nm wide.

use photopic::spectrum::{Grid, Quantity, Spectrum};

use crate::{K_M, close, convert, density, has, photopic, sound_json, v};

/// λ, V(λ) (CIE 018:2019, Table 1), V′(λ) (Table 2) and x̄, z̄ (CIE 018:2019, Table 6) as printed; `None` beyond a table.
type Printed = (f64, f64, Option<f64>, f64, f64);
const PRINTED: [Printed; 5] = [
    (360.0, 0.000003917, None, 0.000129900, 0.000606100),
    (380.0, 0.0000390, Some(0.000589), 0.001368, 0.006450001),
    (555.0, 1.0, Some(0.402), 0.5120501, 0.005749999),
    (780.0, 0.00001499, Some(0.000000139), 0.00004150994, 0.0),
    (830.0, 0.00000045181, None, 0.000001251141, 0.0),
];
const PLANCK: f64 = 6.626_070_15e-34;
const SPEED_OF_LIGHT: f64 = 299_792_458.0;

fn line(wavelength: f64, value: f64) -> Spectrum {
    Spectrum::lines(Grid::new(vec![wavelength]).expect("positive"), vec![value]).expect("finite")
}

#[test]
fn a_line_has_the_efficacy_that_the_standard_prints() {
    for (wavelength, v, v_prime, x_bar, z_bar) in PRINTED {
        let got = convert(Quantity::Flux, &line(wavelength, 2.5));
        sound_json(&got, &format!("{wavelength} nm"));
        let c = got.value;
        close(c.efficacy_lm_per_w.expect("light"), K_M * v, 1e-15, "K");
        close(photopic(&c), 2.5 * K_M * v, 1e-15, "lumens");
        close(c.absolute[0].scotopic, 2.5 * 1700.06 * v_prime.unwrap_or(0.0), 1e-15, "scotopic lumens");
        let sum = x_bar + v + z_bar;
        let xy = c.xy.expect("light");
        close(xy[0], x_bar / sum, 1e-14, "x");
        close(xy[1], v / sum, 1e-14, "y");
        // N = Φλ/(hc).
        let photons = c.photons.expect("asked for").total_count;
        close(photons, 2.5 * wavelength * 1e-9 / (PLANCK * SPEED_OF_LIGHT), 1e-13, "photons");
        assert_eq!((c.peak_wavelength_nm, c.fwhm_nm), (Some(wavelength), None));
        close(c.centroid_wavelength_nm.expect("light"), wavelength, 1e-15, "centroid");
        let bound = c.integration.error_bound;
        assert_eq!((bound.step_relative, bound.truncation_relative), (Some(0.0), Some(0.0)), "a line is what it is");
    }
}

#[test]
fn a_line_beyond_the_tables_has_no_luminous_content_and_says_so() {
    for wavelength in [1.0, 200.0, 359.9, 830.1, 10_600.0, 1e9] {
        let got = convert(Quantity::Flux, &line(wavelength, 1.0));
        sound_json(&got, &format!("{wavelength} nm"));
        assert_eq!(photopic(&got.value), 0.0);
        assert!(has(&got.findings, "P005"), "{wavelength}: {:?}", got.findings);
        assert_eq!((got.value.xy, got.value.cct, got.value.efficacy_lm_per_w), (None, None, None));
        // The watt is still a watt.
        assert_eq!(got.value.absolute[0].radiometric, 1.0);
    }
}

#[test]
fn two_lines_add_up() {
    // K of 1 W at 500 nm and 3 W at 600 nm: (0.323 + 3·0.631)/4 of K_m (CIE 018:2019, Table 1).
    let lines = Spectrum::lines(Grid::new(vec![500.0, 600.0]).expect("ascending"), vec![1.0, 3.0]).expect("finite");
    let got = convert(Quantity::Flux, &lines).value;
    close(got.efficacy_lm_per_w.expect("light"), K_M * (0.323 + 3.0 * 0.631) / 4.0, 1e-14, "K");
}

#[test]
fn a_narrow_triangle_has_the_closed_form_of_a_line_of_its_width() {
    for (wavelength, printed, ..) in PRINTED {
        for width in [1.0, 0.1] {
            // A triangle of half-base `width` and area 1 on an irregular grid: the exact rule. On each side V is straight,
            // and ∫₀ʷ (1/w)(1 − t/w)(V₀ + g t) dt = V₀/2 + g w²/6 with g the slope of V there; nothing beyond the table.
            let spectrum = density(
                vec![wavelength - width, wavelength, wavelength + width, wavelength + 3.0 * width],
                vec![0.0, 1.0 / width, 0.0, 0.0],
            );
            let side = |neighbour: f64| {
                if (360.0..=830.0).contains(&neighbour) {
                    0.5 * printed + (v(neighbour) - printed) * width / 6.0
                } else {
                    0.0
                }
            };
            let want = side(wavelength - 1.0) + side(wavelength + 1.0);
            let got = convert(Quantity::Flux, &spectrum);
            let what = format!("{wavelength} nm, {width} nm wide");
            sound_json(&got, &what);
            let c = got.value;
            // 1/w and differences of wavelengths carry 830/w units in the last place: 1e-12 for 0.1 nm.
            close(c.absolute[0].radiometric, 1.0, 2e-12, &what);
            close(photopic(&c), K_M * want, 4e-12, &what);
            close(c.fwhm_nm.expect("falls to half"), width, 2e-12, &what);
            close(c.centroid_wavelength_nm.expect("light"), wavelength, 2e-12, &what);
        }
    }
}

#[test]
fn a_narrow_triangle_on_equal_steps_is_a_line_to_the_summation() {
    for (wavelength, printed, ..) in PRINTED {
        for width in [1.0, 0.1] {
            // Δλ Σ S V = w · (1/w) · V(λ): what CIE 15's summation makes of it.
            let spectrum =
                density(vec![wavelength - width, wavelength, wavelength + width], vec![0.0, 1.0 / width, 0.0]);
            let got = convert(Quantity::Flux, &spectrum);
            sound_json(&got, "a triangle");
            close(got.value.efficacy_lm_per_w.expect("light"), K_M * printed, 2e-12, "K");
        }
    }
}

#[test]
fn a_narrow_density_in_the_middle_is_a_line_up_to_the_curvature_of_v() {
    // V″ at 555 nm: (0.9997482 − 2 + 0.9998567) = −3.95e-4 per nm² (CIE 018:2019); a triangle of half-base w sees w²/12 of it
    // where V is smooth, and w/6 of the kink where V is straight between its entries.
    for (width, allowed) in [(1.0, 3.951e-4 / 6.0), (0.1, 3.951e-5 / 6.0)] {
        let spectrum = density(vec![555.0 - width, 555.0, 555.0 + width, 558.0], vec![0.0, 1.0 / width, 0.0, 0.0]);
        let got = convert(Quantity::Flux, &spectrum).value.efficacy_lm_per_w.expect("light");
        assert!((got / K_M - 1.0).abs() <= allowed * 1.0001, "{width}: {got}");
    }
}

#[test]
fn the_candela_is_where_the_si_puts_it() {
    // 540 THz is 555.016 nm in standard air (n = 1.000 2777, CIE 018:2019), where K is 683 lm/W by the SI; K_m is rounded to
    // six digits.
    let got = convert(Quantity::Flux, &line(555.016, 1.0)).value.efficacy_lm_per_w.expect("light");
    assert!((got - 683.0).abs() < 1e-3, "{got}");
}

#[test]
fn a_line_is_its_own_dominant_wavelength_with_a_purity_of_one() {
    for (wavelength, ..) in PRINTED {
        let got = convert(Quantity::Flux, &line(wavelength, 1.0)).value.dominant.expect("coloured");
        assert!((got.excitation_purity - 1.0).abs() < 1e-9, "{wavelength} nm: {got:?}");
        // Spectral light is no purple, of which alone the complementary wavelength (negative) is told. Beyond 699 nm the
        // standard's chromaticities stand still, and before 380 nm they turn back: no more than the end can be told.
        let (low, high) = match wavelength {
            w if w >= 699.0 => (698.9, w),
            w if w <= 380.0 => (360.0, 410.0),
            w => (w - 1e-6, w + 1e-6),
        };
        assert!((low..=high).contains(&got.wavelength_nm), "{wavelength} nm: {got:?}");
    }
}
