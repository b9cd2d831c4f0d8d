//! Spectra, photometry and colour.

use super::Check;
use crate::colorimetry::cct;
use crate::constants::SecondRadiation;
use crate::illuminant::planck;
use crate::photometry::luminous::{Efficacy, Efficiency, Plan};
use crate::spectrum::integrate::Contract;
use crate::spectrum::{Grid, Sampling, Spectrum};

/// The luminous quantity of a spectrum; NaN where there is none.
fn photopic(spectrum: Option<Spectrum>) -> f64 {
    let of = |s: Spectrum| {
        let plan = Plan::new(Efficiency::default(), Efficacy::default(), s.grid(), s.sampling(), &Contract::default());
        plan.ok().map(|p| p.evaluate(s.values()).photopic)
    };
    spectrum.and_then(of).unwrap_or(f64::NAN)
}

/// A laser line at 555 nm.
fn line(watts: f64) -> Option<Spectrum> {
    Spectrum::new(Grid::new(vec![555.0]).ok()?.into(), vec![watts], Sampling::Lines).ok()
}

pub(super) fn checks() -> Vec<Check> {
    let c2 = SecondRadiation::Its90;
    let check =
        |case, source, expected, found, allowed| Check { area: "spectra", case, source, expected, found, allowed };
    let flat = Grid::uniform(360.0, 1.0, 471).ok().and_then(|g| Spectrum::density(g, vec![1.0; 471]).ok());
    let planck = "Planck's law, 40 digits";
    let mut out = vec![
        check("1 W at 555 nm [lm]", "CIE 018: K_m V(555 nm)", 683.002, photopic(line(1.0)), 1e-12),
        check("1e-300 W at 555 nm [lm]", "linearity", 6.830_02e-298, photopic(line(1e-300)), 1e-12),
        check("1e300 W at 555 nm [lm]", "linearity", 6.830_02e302, photopic(line(1e300)), 1e-12),
        // The sum's last printed digit is a tenth.
        check("1 W/(m² sr nm), flat [cd/m²]", "CIE 018: K_m Σ V", 72_983.5, photopic(flat), 0.05 / 72_983.5),
        check("ln L(555 nm) at 1 K", planck, -25_909.692_633_662_515, planck::ln_radiance(555.0, 1.0, c2), 1e-14),
        check(
            "L(555 nm) at 1 K [W/(m² sr nm)]",
            "below the smallest double",
            0.0,
            planck::radiance(555.0, 1.0, c2),
            0.0,
        ),
        check("L(555 nm) at 2856 K", planck, 258.439_221_004_602_54, planck::radiance(555.0, 2856.0, c2), 1e-13),
        check("L(555 nm) at 1e9 K", planck, 87_246_786_509.505_04, planck::radiance(555.0, 1e9, c2), 1e-13),
        check(
            "σ/π [W/(m² sr K⁴)]",
            "2π⁴k⁴/(15h³c²), exact SI",
            1.804_936_235_990_074e-8,
            planck::total_radiance(1.0, SecondRadiation::Si),
            1e-14,
        ),
    ];
    for (case, kelvin) in [("CCT of 1000 K", 1000.0), ("CCT of 2856 K", 2856.0), ("CCT of 20 000 K", 20_000.0)] {
        let found = cct::nearest(cct::planckian_uv(kelvin, c2), c2).map_or(f64::NAN, |c| c.kelvin);
        // Newton's search stops at rounding of the chromaticity, which is flat in 1/T: 1e-15 of it are some 1e-11 of T at 20 000 K.
        out.push(check(case, "a blackbody's CCT is its temperature", kelvin, found, 1e-8));
    }
    out
}
