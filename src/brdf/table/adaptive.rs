//! The adaptive parameterisation of Dupuy and Jakob: samples are dense where the material's microfacets send light.
//!
//! ```text
//! f_r(ω_i, ω_o) cosθ_o = S(u; ω_i) D(ω_m) / (4 σ(ω_i))        ω_m the half vector
//! u = M(θ_m, φ_m; ω_i)     M makes the visible normals of ω_i uniform on the unit square
//! ```
//!
//! On the unit squares θ runs as √(2θ/π) and φ as (φ + π)/2π. D (`ndf`) and σ are bilinear, M is that of [`super::marginal`], S is
//! linear in all its five coordinates. ω_i is the direction for which the file tabulates, and the cosine that f_r does not have is
//! that of ω_o; where θ_i lies beyond the last tabulated angle its slice is taken and the value is inferred. Mirror symmetries that
//! a file uses (φ_i over half or a quarter of the circle) are undone.
//!
//! Reference: J. Dupuy & W. Jakob, *An Adaptive Parameterization for Efficient Material Acquisition and Rendering*, ACM Trans.
//! Graph. 37 (2018).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::axis::{self, Place, check, locate, zone};
use super::channels::{Mix, mixed};
use super::marginal::{Marginal, cell};
use super::nodes::Axis;
use super::{Channel, Entry, Error, Known};
use crate::geometry::direction::{from_angles, phi, theta};

/// The arrays of a file, as they stand in it: the last index runs fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct Fields {
    /// Angles of incidence in rad, rising.
    pub theta_i: Vec<f64>,
    /// Azimuths of incidence in rad, rising; one or two of them for an isotropic material.
    pub phi_i: Vec<f64>,
    /// What the values belong to.
    pub channels: Vec<Channel>,
    /// Rows (φ) and columns (θ) of `ndf`.
    pub ndf_shape: [usize; 2],
    /// Density of normals.
    pub ndf: Vec<f32>,
    /// Rows and columns of `sigma`.
    pub sigma_shape: [usize; 2],
    /// Projected area of the microfacets.
    pub sigma: Vec<f32>,
    /// Rows and columns of each slice of `vndf`.
    pub vndf_shape: [usize; 2],
    /// Density of visible normals: `[phi_i][theta_i][row][column]`.
    pub vndf: Vec<f32>,
    /// Rows and columns of each slice of `spectra`.
    pub spectra_shape: [usize; 2],
    /// S: `[phi_i][theta_i][channel][row][column]`.
    pub spectra: Vec<f32>,
    /// Whether S is to be multiplied with D/4σ; else it holds f cosθ_o itself.
    pub jacobian: bool,
}

/// A table in the adaptive parameterisation.
#[derive(Debug, Clone, PartialEq)]
pub struct Adaptive {
    fields: Fields,
    visible: Marginal,
    /// How often the tabulated range of φ_i goes into the circle, where it is less than all of it.
    reduction: u8,
}

impl Adaptive {
    /// A table of the arrays of a file.
    ///
    /// # Errors
    /// [`Error`] for angles that do not rise and numbers of values that do not fit.
    pub fn new(fields: Fields) -> Result<Self, Error> {
        check("theta_i", &fields.theta_i)?;
        check("phi_i", &fields.phi_i)?;
        let slices = fields.theta_i.len() * fields.phi_i.len();
        let cells = |shape: [usize; 2]| shape[0].saturating_mul(shape[1]);
        let expected = [
            ("values of ndf", fields.ndf.len(), cells(fields.ndf_shape)),
            ("values of sigma", fields.sigma.len(), cells(fields.sigma_shape)),
            ("values of vndf", fields.vndf.len(), cells(fields.vndf_shape).saturating_mul(slices)),
            (
                "values of spectra",
                fields.spectra.len(),
                cells(fields.spectra_shape).saturating_mul(slices).saturating_mul(fields.channels.len()),
            ),
        ];
        for (what, found, expected) in expected {
            if found != expected || expected == 0 {
                return Err(Error::Count { what, found, expected });
            }
        }
        for (what, size) in fields.vndf_shape.iter().chain(&fields.spectra_shape).map(|n| ("rows or columns", *n)) {
            if size < 2 {
                return Err(Error::Count { what, found: size, expected: 2 });
            }
        }
        let arrays = [&fields.ndf, &fields.sigma, &fields.vndf, &fields.spectra];
        if let Some(value) = arrays.iter().flat_map(|a| a.iter()).find(|v| !v.is_finite()) {
            return Err(Error::Range { what: "a value", value: f64::from(*value), expected: "a finite number" });
        }
        let visible = Marginal::new(fields.vndf_shape[1], fields.vndf_shape[0], &fields.vndf);
        let span = fields.phi_i[fields.phi_i.len() - 1] - fields.phi_i[0];
        let reduction = match (TAU / span).round() {
            2.0 if fields.phi_i.len() > 2 => 2,
            4.0 if fields.phi_i.len() > 2 => 4,
            _ => 1,
        };
        Ok(Self { fields, visible, reduction })
    }

    /// What the values belong to.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.fields.channels
    }

    /// Whether the sample was never turned.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        self.fields.phi_i.len() <= 2
    }

    /// The arrays.
    #[must_use]
    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// Number of places with values.
    #[must_use]
    pub fn places(&self) -> usize {
        self.fields.spectra.len() / self.fields.channels.len()
    }

    /// Writes the value at two directions.
    pub fn value(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) -> Known {
        let (incident, outgoing) = self.reduced(incident, outgoing);
        let facet = (incident + outgoing).normalize();
        let (theta_i, phi_i) = (theta(incident), incident.y.atan2(incident.x));
        let turn = if self.is_isotropic() { phi_i } else { 0.0 };
        let [x, y] = unit_square(theta(facet), phi(facet) - turn);
        let fields = &self.fields;
        let polar = locate(&fields.theta_i, theta_i);
        let azimuth = if self.is_isotropic() { Place::ONLY } else { locate(&fields.phi_i, phi_i) };
        let slices = || {
            (0..4).map(move |k| {
                let (a, p) = (k >> 1, k & 1);
                (azimuth.weights[a] * polar.weights[p], azimuth.nodes[a] * fields.theta_i.len() + polar.nodes[p])
            })
        };
        let [u, v] = self.visible.invert(slices(), x, y);
        let scale = if fields.jacobian {
            let [sx, sy] = unit_square(theta_i, phi_i);
            let area = bilinear(&fields.sigma, fields.sigma_shape, sx, sy);
            if area > 0.0 { bilinear(&fields.ndf, fields.ndf_shape, x, y) / (4.0 * area) } else { 0.0 }
        } else {
            1.0
        };
        let (layer, n) = (fields.spectra_shape[0] * fields.spectra_shape[1], values.len());
        values.fill(0.0);
        for (weight, slice) in slices().filter(|(w, _)| *w > 0.0) {
            for (c, value) in values.iter_mut().enumerate() {
                let start = (slice * n + c) * layer;
                *value += weight * bilinear(&fields.spectra[start..start + layer], fields.spectra_shape, u, v);
            }
        }
        values.iter_mut().for_each(|v| *v *= scale / outgoing.z);
        if polar.outside || azimuth.outside { Known::Inferred } else { Known::Measured }
    }

    /// Visits places at the tabulated angles of incidence, on a net of normals with as many cells as the spectra have nodes.
    pub fn entries(&self, visit: &mut dyn FnMut(&Entry<'_>)) {
        let [rows, columns] = self.fields.spectra_shape;
        let azimuths = if self.is_isotropic() { &[0.0][..] } else { &self.fields.phi_i };
        let thetas = &self.fields.theta_i;
        let mut values = vec![0.0; self.fields.channels.len()];
        // θ runs as the square of the net's coordinate.
        let bound = |column: usize| (column as f64 / columns as f64).powi(2) * FRAC_PI_2;
        for (i, phi_i) in (0..thetas.len()).flat_map(|i| azimuths.iter().map(move |p| (i, *p))) {
            let incident = from_angles(thetas[i], phi_i);
            let share = zone(axis::cell(thetas, i, 0.0, FRAC_PI_2));
            for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
                let theta_h = ((column as f64 + 0.5) / columns as f64).powi(2) * FRAC_PI_2;
                let facet = from_angles(theta_h, (row as f64 + 0.5) / rows as f64 * TAU - PI + phi_i);
                let cos = incident.dot(facet);
                let outgoing = 2.0 * cos * facet - incident;
                if cos > 0.0 && outgoing.z > 0.0 && self.value(incident, outgoing, &mut values) == Known::Measured {
                    // dω_o = 4 (ω_i·h) dω_h.
                    let measure = share * 4.0 * cos * zone([bound(column), bound(column + 1)]);
                    visit(&Entry { incident, outgoing, measure, values: &values });
                }
            }
        }
    }

    /// Both directions mirrored into the part of the circle that is tabulated.
    fn reduced(&self, mut incident: DVec3, mut outgoing: DVec3) -> (DVec3, DVec3) {
        if self.reduction >= 2 {
            // The tabulated half or quarter has y ≤ 0 (and, for a quarter, x ≤ 0): φ from −π.
            let y = incident.y;
            let x = if self.reduction == 4 { incident.x } else { y };
            for d in [&mut incident, &mut outgoing] {
                d.x = if x.is_sign_negative() { d.x } else { -d.x };
                d.y = if y.is_sign_negative() { d.y } else { -d.y };
            }
        }
        (incident, outgoing)
    }

    /// The same places with other channels.
    pub(super) fn mixed(&self, mix: &Mix) -> Self {
        let (old, layer) = (self.fields.channels.len(), self.fields.spectra_shape[0] * self.fields.spectra_shape[1]);
        let mut spectra = Vec::with_capacity(self.places() * mix.channels.len());
        for slice in self.fields.spectra.chunks_exact(old * layer) {
            for part in &mix.parts {
                #[expect(clippy::cast_possible_truncation, reason = "kept in single precision")]
                spectra.extend((0..layer).map(|at| mixed(*part, |i| f64::from(slice[i * layer + at])) as f32));
            }
        }
        Self { fields: Fields { channels: mix.channels.clone(), spectra, ..self.fields.clone() }, ..self.clone() }
    }

    pub(super) fn axes(&self) -> Vec<Axis> {
        let degrees = |angles: &[f64]| angles.iter().map(|a| a.to_degrees()).collect::<Vec<_>>();
        let [rows, columns] = self.fields.spectra_shape;
        vec![
            Axis::of("θ_i", &degrees(&self.fields.theta_i)),
            Axis::of("φ_i", &degrees(&self.fields.phi_i)),
            Axis::new("u (towards larger θ_m)", columns, 0.0, 90.0),
            Axis::new("v (around)", rows, 0.0, 360.0),
        ]
    }
}

/// Angles on the unit square: √(2θ/π) and (φ + π)/2π, the latter wrapped.
fn unit_square(theta: f64, phi: f64) -> [f64; 2] {
    [(theta / FRAC_PI_2).sqrt(), ((phi + PI) / TAU).rem_euclid(1.0)]
}

/// The value at a point of the unit square of rows and columns of nodes.
fn bilinear(values: &[f32], shape: [usize; 2], x: f64, y: f64) -> f64 {
    let ((column, fx), (row, fy)) = (cell(x, shape[1]), cell(y, shape[0]));
    let at = |r: usize, c: usize| f64::from(values[r.min(shape[0] - 1) * shape[1] + c.min(shape[1] - 1)]);
    let along = |r: usize| (1.0 - fx) * at(r, column) + fx * at(r, column + 1);
    (1.0 - fy) * along(row) + fy * along(row + 1)
}
