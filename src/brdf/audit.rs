//! Whether a BRDF is one: reciprocity, energy, sign, symmetry and coverage, with the place of the worst case.
//!
//! - **Reciprocity** (Helmholtz): |f(ω_i, ω_o) − f(ω_o, ω_i)| over the larger of the two, the largest over the net and all bands.
//!   Values below a millionth of the largest are left out: their relative difference is rounding. In a table those below a
//!   hundredth are, for theirs is noise, and so are places of which one was not measured: a guess says nothing about the material.
//! - **Energy**: ρ(ω_i; 2π) ≤ 1 at every angle of [`ALBEDO_DEG`]; a material passes while ρ minus its quadrature's error does. In a
//!   table what counts is the part of ρ that was measured ([`Albedo::measured`]): no guess convicts a material.
//! - **Sign**: the part of the net where some band is negative.
//! - **φ symmetry**: |f(φ) − f(−φ)| relative, mirrored at the plane of incidence. An anisotropic material may lack it when it is
//!   turned; at φ_i = 0, along its grain, it has it.
//! - **Coverage**: the part of the net that was measured ([`Brdf::is_measured`]), weighted by cosθ_o dω_o.
//!
//! The net: θ of both directions from 2.5° to 87.5° by 5° and at 89.9°, φ_o − φ_i from 0° to 360° by 15°, at φ_i = 0° and, for
//! anisotropic materials, 0° to 90° by 22.5°; and the mirror direction of each, which a narrow lobe has all its values at. A table that
//! was lit at few angles ([`Brdf::incidences_deg`]) is asked at these alone, for net and albedo, and they are outgoing angles too: only so
//! can directions have been measured both ways.

use glam::DVec3;

use super::Brdf;
use crate::geometry::direction::from_degrees;

/// Angles of incidence of the albedo, degrees.
pub const ALBEDO_DEG: [f64; 20] = [
    0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 88.0,
    89.0,
];

/// What is tolerated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest relative difference of exchanged directions.
    pub reciprocity: f64,
    /// Largest albedo.
    pub albedo: f64,
    /// Largest part of the net with negative values.
    pub negative: f64,
}

impl Limits {
    /// Those of a model, or of a table: exchanged directions of a measurement differ by its noise.
    #[must_use]
    pub fn of(brdf: &dyn Brdf) -> Self {
        if brdf.is_tabulated() { Self { reciprocity: 0.1, ..Self::default() } } else { Self::default() }
    }
}

impl Default for Limits {
    /// What physics asks for, and a millionth for rounding.
    fn default() -> Self {
        Self { reciprocity: 1e-6, albedo: 1.0, negative: 0.0 }
    }
}

/// Two directions in degrees; φ is φ_o − φ_i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Angle of ω_i to the normal.
    pub theta_i_deg: f64,
    /// Azimuth of ω_i.
    pub phi_i_deg: f64,
    /// Angle of ω_o to the normal.
    pub theta_o_deg: f64,
    /// Azimuth of ω_o less that of ω_i.
    pub phi_deg: f64,
}

impl Geometry {
    /// ω_i and ω_o.
    #[must_use]
    pub fn directions(&self) -> (DVec3, DVec3) {
        let outgoing = from_degrees(self.theta_o_deg, self.phi_i_deg + self.phi_deg);
        (from_degrees(self.theta_i_deg, self.phi_i_deg), outgoing)
    }
}

/// A largest value, where, and in which band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// The directions.
    pub at: Geometry,
    /// The band, from 0.
    pub band: usize,
}

/// Albedo at one angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Albedo {
    /// Angle of incidence.
    pub theta_i_deg: f64,
    /// Its azimuth.
    pub phi_i_deg: f64,
    /// ρ per band, with the best guess where a table was not measured.
    pub reflectance: Vec<f64>,
    /// The part of ρ per band from directions that were measured: all of it for a model.
    pub measured: Vec<f64>,
    /// Bound on the absolute error of both quadratures.
    pub error: f64,
}

/// What an audit found.
#[derive(Debug, Clone, PartialEq)]
pub struct Audit {
    /// Largest relative difference of exchanged directions; `None` where there is nothing but Dirac lobes, or no pair of
    /// directions was measured both ways.
    pub reciprocity: Option<Worst>,
    /// Albedo at [`ALBEDO_DEG`], for anisotropic materials at five azimuths; of a table that was lit at few angles at these.
    pub albedo: Vec<Albedo>,
    /// The number of directions of incidence of a table that was lit at few.
    pub incidences: Option<usize>,
    /// Part of the net with a negative value.
    pub negative_fraction: f64,
    /// The most negative value, 1/sr.
    pub most_negative: Option<Worst>,
    /// Largest relative difference between φ and −φ.
    pub symmetry: Option<Worst>,
    /// Part of the projected hemisphere that was measured.
    pub measured_fraction: f64,
    /// Whether the limits are kept.
    pub passes: bool,
}

impl Audit {
    /// The largest albedo over what was measured: the angle, the band, and the value.
    #[must_use]
    pub fn largest_albedo(&self) -> Option<(&Albedo, usize, f64)> {
        let all = self.albedo.iter().flat_map(|a| a.measured.iter().enumerate().map(move |(i, v)| (a, i, *v)));
        // The first of equal ones.
        all.reduce(|best, next| if next.2 > best.2 { next } else { best })
    }
}

/// Audits a BRDF.
#[must_use]
pub fn audit(brdf: &dyn Brdf, limits: &Limits) -> Audit {
    let azimuths: &[f64] = if brdf.is_isotropic() { &[0.0] } else { &[0.0, 22.5, 45.0, 67.5, 90.0] };
    let lit = brdf.incidences_deg();
    let mut net = Net::new(brdf, lit.as_deref().unwrap_or_default());
    let mut albedo_at: Vec<[f64; 2]> = Vec::new();
    if let Some(lit) = &lit {
        let mut outgoing: Vec<f64> = net_thetas().chain(lit.iter().map(|l| l[0])).collect();
        outgoing.sort_by(f64::total_cmp);
        outgoing.dedup();
        for group in lit.chunk_by(|a, b| a[1] == b[1]) {
            net.walk(group[0][1], &group.iter().map(|l| l[0]).collect::<Vec<_>>(), &outgoing);
        }
        albedo_at.extend(lit);
    } else {
        let thetas: Vec<f64> = net_thetas().collect();
        for &phi_i_deg in azimuths {
            net.walk(phi_i_deg, &thetas, &thetas);
            albedo_at.extend(ALBEDO_DEG.map(|theta| [theta, phi_i_deg]));
        }
    }
    let albedo: Vec<Albedo> = (albedo_at.into_iter())
        .map(|[theta_i_deg, phi_i_deg]| {
            let incident = from_degrees(theta_i_deg, phi_i_deg);
            let mut reflectance = vec![0.0; brdf.bands()];
            let mut error = brdf.albedo(incident, &mut reflectance);
            let mut measured = reflectance.clone();
            if !net.all_measured {
                error = error.max(MeasuredPart(brdf).albedo(incident, &mut measured));
            }
            Albedo { theta_i_deg, phi_i_deg, reflectance, measured, error }
        })
        .collect();
    let too_bright = |a: &Albedo| a.measured.iter().any(|v| *v - a.error > limits.albedo + 1e-12);
    let negative_fraction = net.negative as f64 / net.points.max(1) as f64;
    let passes = net.reciprocity.is_none_or(|w| w.value <= limits.reciprocity)
        && negative_fraction <= limits.negative
        && !albedo.iter().any(too_bright);
    Audit {
        reciprocity: net.reciprocity,
        albedo,
        incidences: lit.as_ref().map(Vec::len),
        negative_fraction,
        most_negative: net.most_negative,
        symmetry: net.symmetry,
        measured_fraction: net.measured / net.weight,
        passes,
    }
}

/// θ of the net where a material is known at all angles, degrees.
fn net_thetas() -> impl Iterator<Item = f64> {
    (0..18).map(|i| 2.5 + 5.0 * f64::from(i)).chain([89.9])
}

/// A table without its guesses: 0 where it was not measured.
#[derive(Debug)]
pub(crate) struct MeasuredPart<'a>(pub(crate) &'a dyn Brdf);

impl Brdf for MeasuredPart<'_> {
    fn bands(&self) -> usize {
        self.0.bands()
    }

    fn is_isotropic(&self) -> bool {
        self.0.is_isotropic()
    }

    fn is_tabulated(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        if self.0.is_measured(incident, outgoing) {
            self.0.evaluate(incident, outgoing, values);
        } else {
            values.fill(0.0);
        }
    }
}

/// A walk over the net.
struct Net<'a> {
    brdf: &'a dyn Brdf,
    points: usize,
    negative: usize,
    weight: f64,
    measured: f64,
    all_measured: bool,
    /// Directions of incidence of a table that was lit at few.
    lit: &'a [[f64; 2]],
    reciprocity: Option<Worst>,
    most_negative: Option<Worst>,
    symmetry: Option<Worst>,
}

impl<'a> Net<'a> {
    fn new(brdf: &'a dyn Brdf, lit: &'a [[f64; 2]]) -> Self {
        Self {
            brdf,
            points: 0,
            negative: 0,
            weight: 0.0,
            measured: 0.0,
            all_measured: true,
            lit,
            reciprocity: None,
            most_negative: None,
            symmetry: None,
        }
    }

    fn walk(&mut self, phi_i_deg: f64, thetas_i: &[f64], thetas_o: &[f64]) {
        let bands = self.brdf.bands();
        let [mut here, mut back, mut other] = [vec![0.0; bands], vec![0.0; bands], vec![0.0; bands]];
        let geometries: Vec<Geometry> = (thetas_i.iter())
            .flat_map(|&theta_i_deg| {
                let around = thetas_o.iter().flat_map(move |&theta_o_deg| {
                    (0..24).map(move |i| Geometry { theta_i_deg, phi_i_deg, theta_o_deg, phi_deg: 15.0 * f64::from(i) })
                });
                // Beside the mirror direction, where narrow lobes differ most.
                let beside = [-1.0, -0.1, 0.0, 0.1, 1.0].map(|d| Geometry {
                    theta_i_deg,
                    phi_i_deg,
                    theta_o_deg: (theta_i_deg + d).clamp(0.0, 89.99),
                    phi_deg: 180.0,
                });
                around.chain(beside)
            })
            .collect();
        let floor = if self.brdf.is_delta() {
            f64::INFINITY
        } else {
            let mut largest = 0.0_f64;
            for g in &geometries {
                let (i, o) = g.directions();
                self.brdf.evaluate(i, o, &mut here);
                largest = here.iter().fold(largest, |m, v| m.max(v.abs()));
            }
            let share = if self.brdf.is_tabulated() { 1e-2 } else { 1e-6 };
            share * largest.max(f64::MIN_POSITIVE)
        };
        for g in geometries {
            let (i, o) = g.directions();
            self.brdf.evaluate(i, o, &mut here);
            self.points += 1;
            let measured = self.brdf.is_measured(i, o);
            self.all_measured &= measured;
            // Evenly spread ones alone: others would count their surroundings twice.
            if net_thetas().any(|t| t == g.theta_o_deg) {
                let weight = i.z * o.z * g.theta_o_deg.to_radians().sin();
                self.weight += weight;
                self.measured += if measured { weight } else { 0.0 };
            }
            if let Some((band, value)) = least(&here) {
                self.negative += 1;
                if self.most_negative.is_none_or(|w| value < w.value) {
                    self.most_negative = Some(Worst { value, at: g, band });
                }
            }
            if floor == f64::INFINITY || !measured {
                continue;
            }
            let lit = self.lit.is_empty() || self.lit.iter().any(|l| l[0] == g.theta_o_deg);
            if lit && self.brdf.is_measured(o, i) {
                self.brdf.evaluate(o, i, &mut back);
                keep_largest(&mut self.reciprocity, &here, &back, floor, g);
            }
            let mirrored = Geometry { phi_deg: -g.phi_deg, ..g }.directions();
            if phi_i_deg == 0.0 && self.brdf.is_measured(mirrored.0, mirrored.1) {
                self.brdf.evaluate(mirrored.0, mirrored.1, &mut other);
                keep_largest(&mut self.symmetry, &here, &other, floor, g);
            }
        }
    }
}

/// The most negative of the bands, where one is.
fn least(values: &[f64]) -> Option<(usize, f64)> {
    let (band, value) = values.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    (value < 0.0).then_some((band, value))
}

fn keep_largest(worst: &mut Option<Worst>, a: &[f64], b: &[f64], floor: f64, at: Geometry) {
    for (band, (a, b)) in a.iter().zip(b).enumerate() {
        let size = a.abs().max(b.abs());
        let value = if size > floor { (a - b).abs() / size } else { 0.0 };
        if worst.is_none_or(|w| value > w.value) {
            *worst = Some(Worst { value, at, band });
        }
    }
}
