//! The luminaire classification system for outdoor luminaires: flux in ten solid angles.

use super::distribution::Distribution;
use super::unavailable::Unavailable;
use super::zonal::mean_table;

/// Flux in the ten solid angles of the LCS, lm.
///
/// *Forward* is the half space within 90° of the street side, *back* the house side. By γ: low 0–30°, mid 30–60°, high 60–80°,
/// very high 80–90°; uplight low 90–100°, high 100–180°.
///
/// # Reference
/// IES TM-15-11, 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lcs {
    /// Forward: FL, FM, FH, FVH.
    pub forward: [f64; 4],
    /// Back: BL, BM, BH, BVH.
    pub back: [f64; 4],
    /// Uplight: UL, UH.
    pub up: [f64; 2],
}

impl Lcs {
    /// Names and values in the standard's order.
    #[must_use]
    pub fn named(&self) -> [(&'static str, f64); 10] {
        let ([fl, fm, fh, fvh], [bl, bm, bh, bvh], [ul, uh]) = (self.forward, self.back, self.up);
        [
            ("fl", fl),
            ("fm", fm),
            ("fh", fh),
            ("fvh", fvh),
            ("bl", bl),
            ("bm", bm),
            ("bh", bh),
            ("bvh", bvh),
            ("ul", ul),
            ("uh", uh),
        ]
    }
}

/// Ends of the four zones below the horizontal and of the two above, degrees.
const DOWN_DEG: [f64; 5] = [0.0, 30.0, 60.0, 80.0, 90.0];
const UP_DEG: [f64; 3] = [90.0, 100.0, 180.0];

/// Where LM-63 files of roadway and area luminaires have the street: C0 (IES TM-15-11: forward light is 270°–90°).
pub const STREET_C_DEG_IES: f64 = 0.0;
/// Where EULUMDAT files of road luminaires have it: C90, C0–C180 lying along the road (EN 13201-3, CIE 140).
pub const STREET_C_DEG_EULUMDAT: f64 = 90.0;

/// Flux in the solid angles of the LCS for a street side towards `street_c_deg`.
///
/// # Errors
/// [`Unavailable::NotTypeC`].
pub fn lcs(distribution: &Distribution, street_c_deg: f64) -> Result<Lcs, Unavailable> {
    let whole = mean_table(distribution)?;
    let zone = |table: &Distribution, edges: &[f64], i: usize| table.flux_between(edges[i], edges[i + 1]);
    let forward = half_fluxes(distribution, street_c_deg);
    let back = std::array::from_fn(|i: usize| {
        let rest = zone(&whole, &DOWN_DEG, i) - forward[i];
        // A dark back must not be a rounding error of the whole.
        if rest.abs() < 1e-12 * forward[i].abs() { 0.0 } else { rest }
    });
    Ok(Lcs { forward, back, up: std::array::from_fn(|i| zone(&whole, &UP_DEG, i)) })
}

/// Flux of the half space within 90° of a C-plane in each zone below the horizontal, as exactly as the total flux.
fn half_fluxes(distribution: &Distribution, centre_deg: f64) -> [f64; 4] {
    // Between the planes and their mirror images the intensity is a polynomial in C: linear, or cubic.
    let offset = |c: f64| (c - centre_deg + 90.0).rem_euclid(360.0);
    let planes = distribution.horizontal_deg().iter();
    let images = planes.flat_map(|h| [*h, -*h, 180.0 - *h, 180.0 + *h]).map(offset);
    let mut edges: Vec<f64> = images.filter(|c| *c < 180.0).chain([0.0, 180.0]).collect();
    edges.sort_by(f64::total_cmp);
    // Simpson's rule is exact for both.
    let integral = |g: f64| {
        let at = |c: f64| distribution.at(c + centre_deg - 90.0, g);
        let part = |a: f64, b: f64| (b - a).to_radians() / 6.0 * (at(a) + 4.0 * at(0.5 * (a + b)) + at(b));
        edges.windows(2).map(|w| part(w[0], w[1])).sum::<f64>()
    };
    std::array::from_fn(|i| distribution.flux_along(&distribution.cuts(DOWN_DEG[i], DOWN_DEG[i + 1]), integral))
}

#[cfg(test)]
mod tests {
    use super::super::distribution::{Symmetry, System};
    use super::*;

    fn lopsided() -> Distribution {
        // 1 towards C0, falling to 0 at C180, at every γ up to 120°.
        let values = [1.0, 0.5, 0.0].iter().flat_map(|v| [*v; 3]).collect();
        let planes = vec![0.0, 90.0, 180.0];
        Distribution::new(System::TypeC, Symmetry::BilateralC0, planes, vec![0.0, 60.0, 120.0], values).expect("sound")
    }

    #[test]
    fn the_zones_add_up_and_know_the_street() {
        let d = lopsided();
        let z = lcs(&d, STREET_C_DEG_IES).expect("Type C");
        let sum: f64 = z.named().iter().map(|(_, v)| v).sum();
        assert!((sum / d.total_flux() - 1.0).abs() < 1e-14);
        // The mean of the front half is ¾, of the back ¼.
        for (f, b) in z.forward.iter().zip(z.back) {
            assert!((f / b - 3.0).abs() < 1e-12);
        }
        let turned = lcs(&d, STREET_C_DEG_EULUMDAT).expect("Type C");
        assert!((turned.forward[1] - turned.back[1]).abs() < 1e-12 && (turned.up[0] - z.up[0]).abs() < 1e-12);
        let behind = lcs(&d, 180.0).expect("Type C");
        assert!((behind.forward[2] - z.back[2]).abs() < 1e-12);
    }
}
