//! Reflectances ρ(Ω_i; Ω_o) between directions, cones and hemispheres: all nine combinations of Nicodemus.
//!
//! ```text
//! ρ(Ω_i; Ω_o) = 1/Ω⊥_i ∫_Ω_i ∫_Ω_o f_r(ω_i, ω_o) cosθ_o dω_o cosθ_i dω_i      Ω⊥ = ∫_Ω cosθ dω
//! R(Ω_i; Ω_o) = ρ π / Ω⊥_o                                                     reflectance factor
//! ```
//!
//! With a single direction in the place of Ω_i there is no average over it. With a single direction in the place of Ω_o the
//! reflected part is infinitely small: ρ is given per steradian, ρ' = cosθ_o ⟨f_r⟩, and R = π ⟨f_r⟩ as in the limit of a narrow
//! cone.
//!
//! The integrals run over polar coordinates about the mirror direction, radii on a logarithmic scale between exact bounds, so
//! that lobes of a millionth of a radian are found; what lies within 1e-9 of the outer radius (a part of 1e-18 of the solid
//! angle) is left out.
//!
//! Reference: F. E. Nicodemus et al., *Geometrical Considerations and Nomenclature for Reflectance*, NBS Monograph 160 (1977).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::Brdf;
use crate::geometry::direction::{mirror, tangents};
use crate::math::cubature::{Tolerance, rectangle};

/// What the quadratures aim at.
#[derive(Debug, Clone, Copy)]
struct Aims {
    /// One integral over directions.
    fine: Tolerance,
    /// The inner one of a double integral.
    inner: Tolerance,
    /// The outer one.
    outer: Tolerance,
}

impl Aims {
    const SMOOTH: Self = Self {
        fine: Tolerance { absolute: 1e-9, relative: 1e-7, evaluations: 200_000 },
        inner: Tolerance { absolute: 1e-7, relative: 1e-5, evaluations: 20_000 },
        outer: Tolerance { absolute: 1e-6, relative: 1e-4, evaluations: 1_500 },
    };
    /// Of tables, which bend or jump between their nodes and are known to some per cent.
    const TABLE: Self = Self {
        fine: Tolerance { absolute: 1e-6, relative: 1e-4, evaluations: 20_000 },
        inner: Tolerance { absolute: 1e-5, relative: 1e-3, evaluations: 2_000 },
        outer: Tolerance { absolute: 1e-4, relative: 1e-3, evaluations: 400 },
    };

    fn of<B: Brdf + ?Sized>(brdf: &B) -> Self {
        if brdf.is_tabulated() { Self::TABLE } else { Self::SMOOTH }
    }
}

/// Span of the logarithmic radius: e²⁰·⁷ = 1e9.
const SPAN: f64 = 20.723_265_836_946_41;

/// Directions within an angle of an axis, as far as they are above the horizon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// The middle; a unit vector.
    pub axis: DVec3,
    /// Half of the opening angle, above 0 to π/2.
    pub half_angle_rad: f64,
}

impl Cone {
    /// All directions above the horizon.
    pub const HEMISPHERE: Self = Self { axis: DVec3::Z, half_angle_rad: FRAC_PI_2 };

    fn contains(&self, direction: DVec3) -> bool {
        let across = self.axis.cross(direction).length();
        direction.z > 0.0 && across.atan2(self.axis.dot(direction)) <= self.half_angle_rad
    }

    /// Its projected solid angle Ω⊥ in sr: π sin²τ cosθ where the horizon does not cut it.
    #[must_use]
    pub fn projected_solid_angle(&self) -> f64 {
        let elevation = self.axis.z.clamp(-1.0, 1.0).asin();
        if *self == Self::HEMISPHERE || elevation >= self.half_angle_rad {
            return if *self == Self::HEMISPHERE { PI } else { PI * self.half_angle_rad.sin().powi(2) * self.axis.z };
        }
        let mut out = [0.0];
        over_cone(self.axis, self, Aims::SMOOTH.fine, 1.0, &mut |direction, v| v[0] = direction.z, &mut out);
        out[0]
    }
}

/// One side of a reflectance: a direction, or directions that are lit or gathered together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beam {
    /// One direction.
    Directional(DVec3),
    /// A cone, clipped at the horizon; [`Cone::HEMISPHERE`] for all directions.
    Conical(Cone),
}

impl Beam {
    /// All directions above the horizon.
    pub const HEMISPHERICAL: Self = Self::Conical(Cone::HEMISPHERE);
}

/// What [`between`] found, per band.
#[derive(Debug, Clone, PartialEq)]
pub struct Reflectance {
    /// ρ; for a directional Ω_o ρ' in 1/sr.
    pub reflectance: Vec<f64>,
    /// R: relative to the perfect diffuser under the same geometry.
    pub factor: Vec<f64>,
    /// Bound on the absolute error of `reflectance`, as far as the quadratures can tell.
    pub error: f64,
}

/// Reflectance and reflectance factor between two beams; `None` where it does not exist: both directional, and a Dirac lobe
/// between them.
#[must_use]
pub fn between<B: Brdf + ?Sized>(brdf: &B, incident: Beam, outgoing: Beam) -> Option<Reflectance> {
    let aims = Aims::of(brdf);
    let mut rho = vec![0.0; brdf.bands()];
    let (error, per_factor) = match (incident, outgoing) {
        (Beam::Directional(i), Beam::Directional(o)) => {
            if brdf.has_delta() && (mirror(i) - o).length() < 1e-9 {
                return None;
            }
            brdf.evaluate(i, o, &mut rho);
            rho.iter_mut().for_each(|v| *v *= o.z);
            (0.0, o.z / PI)
        }
        (Beam::Directional(i), Beam::Conical(cone)) => {
            (directional(brdf, i, &cone, &mut rho), cone.projected_solid_angle() / PI)
        }
        (Beam::Conical(cone), Beam::Directional(o)) => {
            let projected = cone.projected_solid_angle();
            let mut f = |direction: DVec3, v: &mut [f64]| {
                brdf.evaluate(direction, o, v);
                v.iter_mut().for_each(|v| *v *= direction.z);
            };
            let mut error = over_cone(mirror(o), &cone, aims.fine, SPAN, &mut f, &mut rho);
            if brdf.has_delta() && cone.contains(mirror(o)) {
                add_specular(brdf, mirror(o), &mut rho);
            }
            rho.iter_mut().for_each(|v| *v *= o.z / projected);
            error *= o.z / projected;
            (error, o.z / PI)
        }
        (Beam::Conical(from), Beam::Conical(to)) => {
            let projected = from.projected_solid_angle();
            let mut inner = 0.0_f64;
            let mut f = |direction: DVec3, v: &mut [f64]| {
                inner = inner.max(directional_to(brdf, direction, &to, aims.inner, v));
                v.iter_mut().for_each(|v| *v *= direction.z);
            };
            let outer = over_cone(from.axis, &from, aims.outer, 1.0, &mut f, &mut rho);
            rho.iter_mut().for_each(|v| *v /= projected);
            (outer / projected + inner, to.projected_solid_angle() / PI)
        }
    };
    let factor = rho.iter().map(|v| if per_factor > 0.0 { v / per_factor } else { 0.0 }).collect();
    Some(Reflectance { reflectance: rho, factor, error })
}

/// Writes ρ(ω_i; Ω_o) = ∫ f_r cosθ_o dω_o over the part of a cone above the horizon, Dirac lobe included, per band; gives the
/// bound on its absolute error. Zero for a direction at or below the horizon.
pub fn directional<B: Brdf + ?Sized>(brdf: &B, incident: DVec3, cone: &Cone, reflectance: &mut [f64]) -> f64 {
    directional_to(brdf, incident, cone, Aims::of(brdf).fine, reflectance)
}

/// [`directional`] over the hemisphere to 1e-4, as of a table: for what a figure of no more digits is added to.
pub(crate) fn hemispherical_as_table<B: Brdf + ?Sized>(brdf: &B, incident: DVec3, reflectance: &mut [f64]) -> f64 {
    directional_to(brdf, incident, &Cone::HEMISPHERE, Aims::TABLE.fine, reflectance)
}

fn directional_to<B: Brdf + ?Sized>(
    brdf: &B,
    incident: DVec3,
    cone: &Cone,
    tolerance: Tolerance,
    reflectance: &mut [f64],
) -> f64 {
    reflectance.fill(0.0);
    if incident.z <= 0.0 {
        return 0.0;
    }
    let mut error = 0.0;
    if !brdf.is_delta() {
        let mut f = |direction: DVec3, v: &mut [f64]| {
            brdf.evaluate(incident, direction, v);
            v.iter_mut().for_each(|v| *v *= direction.z);
        };
        error = over_cone(mirror(incident), cone, tolerance, SPAN, &mut f, reflectance);
    }
    if brdf.has_delta() && cone.contains(mirror(incident)) {
        add_specular(brdf, incident, reflectance);
    }
    error
}

fn add_specular<B: Brdf + ?Sized>(brdf: &B, incident: DVec3, reflectance: &mut [f64]) {
    let mut specular = vec![0.0; reflectance.len()];
    brdf.specular(incident, &mut specular);
    reflectance.iter_mut().zip(specular).for_each(|(r, s)| *r += s);
}

/// ∫ f(ω) dω over the part of a cone above the horizon, in polar coordinates about `pole`; gives the error.
///
/// `span` is that of the logarithmic radius: [`SPAN`] where f may peak at the pole, 1 where it is smooth.
fn over_cone(
    pole: DVec3,
    cone: &Cone,
    tolerance: Tolerance,
    span: f64,
    f: &mut dyn FnMut(DVec3, &mut [f64]),
    integrals: &mut [f64],
) -> f64 {
    let (t, b) = tangents(pole);
    // A great circle leaves the pole at every azimuth. It meets a convex cone in one stretch, which has a closed form; where the
    // pole is outside, only the azimuths that meet the cone are taken, on a scale that keeps the length of the stretch smooth.
    let apart = pole.cross(cone.axis).length().atan2(pole.dot(cone.axis));
    let towards = cone.axis.dot(b).atan2(cone.axis.dot(t));
    let outside = apart > cone.half_angle_rad;
    let spread = if outside { (cone.half_angle_rad.sin() / apart.sin()).min(1.0).asin() } else { PI };
    let at = |[x, y]: [f64; 2], values: &mut [f64]| {
        let (azimuth, stretch) = if outside {
            (towards + spread * (FRAC_PI_2 * x).sin(), spread * FRAC_PI_2 * (FRAC_PI_2 * x).cos())
        } else {
            (towards + PI * x, PI)
        };
        let (sin, cos) = azimuth.sin_cos();
        let along = t * cos + b * sin;
        let [low, high] = intersection(
            arc(pole.dot(cone.axis), along.dot(cone.axis), cone.half_angle_rad),
            arc(pole.z, along.z, FRAC_PI_2),
        );
        if high <= low {
            return values.fill(0.0);
        }
        let inner = low.max(high * (-span).exp());
        let (radius, slope) = if span > 1.0 {
            let ratio = (high / inner).ln();
            let radius = high * (-ratio * (1.0 - y)).exp();
            (radius, radius * ratio)
        } else {
            (low + (high - low) * y, high - low)
        };
        let (sin, cos) = radius.sin_cos();
        // Not below the horizon by a rounding.
        let mut direction = pole * cos + along * sin;
        direction.z = direction.z.max(0.0);
        f(direction, values);
        values.iter_mut().for_each(|v| *v *= sin * slope * stretch);
    };
    // A cone of the whole turn is met by azimuths over 2π, the scale above by one over its half width.
    rectangle(at, [-1.0, 0.0], [1.0, 1.0], tolerance, integrals).error
}

/// The stretch [from, to] of radii 0 to π on a great circle within `half` of an axis whose cosine to the pole is `pole` and to
/// the circle's direction at the pole is `along`.
fn arc(pole: f64, along: f64, half: f64) -> [f64; 2] {
    let reach = pole.hypot(along);
    let cos = if half == FRAC_PI_2 { 0.0 } else { half.cos() };
    if cos > reach || reach == 0.0 {
        return [0.0, if cos > 0.0 { 0.0 } else { PI }];
    }
    let (middle, width) = (along.atan2(pole), (cos / reach).acos());
    // An axis behind the pole is reached the long way round only by a wide cone; the nearer passage counts.
    let middle = if middle + width < 0.0 { middle + TAU } else { middle };
    [(middle - width).max(0.0), (middle + width).min(PI)]
}

fn intersection([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a.max(c), b.min(d)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::lambert::Lambert;
    use crate::geometry::direction::from_degrees;

    fn cone(theta_deg: f64, phi_deg: f64, half_deg: f64) -> Cone {
        Cone { axis: from_degrees(theta_deg, phi_deg), half_angle_rad: half_deg.to_radians() }
    }

    #[test]
    fn a_diffuser_in_all_nine_geometries() {
        let white = Lambert::new(vec![0.8]).expect("a reflectance");
        let direction = Beam::Directional(from_degrees(50.0, 20.0));
        let narrow = Beam::Conical(cone(40.0, 200.0, 7.0));
        for from in [direction, narrow, Beam::HEMISPHERICAL] {
            for to in [direction, narrow, Beam::HEMISPHERICAL] {
                let r = between(&white, from, to).expect("no Dirac lobe");
                let projected = match to {
                    Beam::Directional(o) => o.z / PI,
                    Beam::Conical(c) => c.projected_solid_angle() / PI,
                };
                // f is ρ/π everywhere: R = ρ, and ρ(Ω_o) is ρ Ω⊥/π.
                assert!((r.factor[0] - 0.8).abs() <= r.error / projected + 1e-12, "{from:?} {to:?}: {r:?}");
                assert!((r.reflectance[0] - 0.8 * projected).abs() <= r.error + 1e-12, "{r:?}");
                assert!(r.error < 1e-3, "{r:?}");
            }
        }
    }

    #[test]
    fn projected_solid_angles_of_whole_and_of_cut_cones() {
        // π sin²τ cosθ, and half of it for a cone whose axis lies in the horizon: ∫ of the half disc's height is τ − sinτ cosτ.
        assert!((cone(30.0, 0.0, 10.0).projected_solid_angle() - 0.082_039_115).abs() < 1e-8);
        let tau = 20.0_f64.to_radians();
        let cut = cone(90.0, 45.0, 20.0).projected_solid_angle();
        // A lune: the projection of the half cap onto the plane is a circular segment of half-angle τ in the unit disc.
        assert!((cut - (tau - tau.sin() * tau.cos())).abs() < 1e-7, "{cut}");
    }

    #[test]
    fn directional_reflectance_of_a_diffuser_into_every_kind_of_cone() {
        let white = Lambert::new(vec![1.0]).expect("a reflectance");
        for theta in [0.0, 30.0, 80.0, 89.0] {
            for c in [Cone::HEMISPHERE, cone(0.0, 0.0, 30.0), cone(60.0, 180.0, 10.0), cone(20.0, 77.0, 60.0)] {
                let mut out = [0.0];
                let error = directional(&white, from_degrees(theta, 0.0), &c, &mut out);
                let expected = c.projected_solid_angle() / PI;
                assert!((out[0] - expected).abs() <= error + 1e-9, "{theta} {c:?}: {} {expected} {error}", out[0]);
                assert!(error < 1e-6);
            }
        }
    }
}
