//! Polarisation of what a path carries, between one Dirac lobe and the next.
//!
//! Lamps and rough surfaces give unpolarised light, but what glass and metal reflect or let through at an angle is polarised, and the
//! next glass treats it accordingly: without that, a pane at 75° is 3.5 % off. A path that meets a Dirac lobe therefore carries, per
//! band, how its intensity depends on the polarisation of the light that it will find: q, u, v relative to the intensity, against a
//! reference direction across the ray. At every Dirac lobe
//!
//! ```text
//! f = 1 + b q       I ← f I       q ← (b + q)/f
//! u ← (c u − d v)/f               v ← (d u + c v)/f
//! b = (R_s − R_p)/(R_s + R_p),    c + i d = 2 r_s r_p*/(R_s + R_p)
//! ```
//!
//! in the frame of the plane of incidence, with I multiplied by the mean (R_s + R_p)/2 by whoever calls: Mueller's matrix of an
//! interface, normalised. Everything else depolarises: only I is left.
//!
//! The same formulas serve paths from the light (I, q, u, v are then Stokes' parameters of the packet) and paths from the sensor
//! (the row that the matrices are multiplied to from the right), if the frames are those of the *path's* direction: light that goes
//! back the same way meets the transposed matrix with u turned over (reciprocity), which is what exchanging the two directions does.
//!
//! References: M. Born & E. Wolf, *Principles of Optics*, 7th ed., §1.5; E. Collett, *Polarized Light* (1993), ch. 8; M. Mojzík et
//! al., *Bi-Directional Polarised Light Transport*, EGSR 2016.

use std::ops::Range;

use glam::DVec3;

use crate::brdf::fresnel::Components;
use crate::geometry::direction::tangents;

/// The polarisation that one path carries.
#[derive(Debug)]
pub struct Polarisation {
    q: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    /// Unit vector across the ray that q is measured from; `None` while q = u = v = 0.
    reference: Option<DVec3>,
    components: Vec<Components>,
}

impl Polarisation {
    /// Nothing polarised yet.
    #[must_use]
    pub fn new(bands: usize) -> Self {
        let zeros = vec![0.0; bands];
        Self {
            q: zeros.clone(),
            u: zeros.clone(),
            v: zeros,
            reference: None,
            components: vec![Components::default(); bands],
        }
    }

    /// The path begins, or was depolarised.
    pub fn clear(&mut self) {
        self.reference = None;
    }

    /// Becomes that of another path.
    pub fn copy(&mut self, other: &Self) {
        self.reference = other.reference;
        if other.reference.is_some() {
            self.q.copy_from_slice(&other.q);
            self.u.copy_from_slice(&other.u);
            self.v.copy_from_slice(&other.v);
        }
    }

    /// A Dirac lobe turns the path from the direction `before` to `after` at a surface of unit normal `normal`; `write` writes its
    /// components per band, and says whether they are known. `intensity` is corrected for the difference from unpolarised light.
    pub fn turn(
        &mut self,
        write: impl FnOnce(&mut [Components]) -> bool,
        directions: [DVec3; 2],
        normal: DVec3,
        intensity: &mut [f64],
    ) {
        self.turn_bands(write, directions, normal, 0..intensity.len(), intensity);
    }

    /// The same for a path that carries no more than the bands `bands`: no other component has to be written.
    pub fn turn_bands(
        &mut self,
        write: impl FnOnce(&mut [Components]) -> bool,
        [before, after]: [DVec3; 2],
        normal: DVec3,
        bands: Range<usize>,
        intensity: &mut [f64],
    ) {
        if !write(&mut self.components) {
            self.clear();
            return;
        }
        let across = before.cross(normal);
        let length = across.length();
        // Along the normal both components are alike, and any frame will do.
        let s = if length > 1e-12 { across / length } else { self.reference.unwrap_or_else(|| tangents(before).0) };
        let turn = self.reference.map(|reference| {
            let (cos, sin) = (s.dot(reference), s.dot(before.cross(reference)));
            (cos * cos - sin * sin, 2.0 * cos * sin)
        });
        let state = self.q[bands.clone()].iter_mut().zip(&mut self.u[bands.clone()]).zip(&mut self.v[bands.clone()]);
        let components = &self.components[bands.clone()];
        for ((((q, u), v), component), intensity) in state.zip(components).zip(&mut intensity[bands]) {
            let (q0, u0, v0) =
                turn.map_or((0.0, 0.0, 0.0), |(cos, sin)| (cos * *q + sin * *u, cos * *u - sin * *q, *v));
            let sum = component.s + component.p;
            if sum == 0.0 {
                (*q, *u, *v) = (0.0, 0.0, 0.0);
                continue;
            }
            let (b, c, d) = ((component.s - component.p) / sum, 2.0 * component.re / sum, 2.0 * component.im / sum);
            // Crossed polarisers: not below zero by a rounding.
            let f = (1.0 + b * q0).max(0.0);
            *intensity *= f;
            let scale = if f > 0.0 { 1.0 / f } else { 0.0 };
            (*q, *u, *v) = (scale * (b + q0), scale * (c * u0 - d * v0), scale * (d * u0 + c * v0));
        }
        // s is across the ray on both sides; made so to the last digit, as it is passed on from lobe to lobe.
        self.reference = Some((s - after * s.dot(after)).normalize());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(degrees: f64) -> DVec3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // s = before × normal; with the ray along z, an ideal polariser that passes s only and leaves the direction.
        DVec3::new(sin, -cos, 0.0)
    }

    fn pass_s(components: &mut [Components]) -> bool {
        components.fill(Components { s: 1.0, p: 0.0, re: 0.0, im: 0.0 });
        true
    }

    /// E. L. Malus 1809: two ideal polarisers at an angle pass cos² of it, one half of unpolarised light each for itself.
    #[test]
    fn two_polarisers_obey_malus() {
        for degrees in [0.0_f64, 20.0, 45.0, 89.0, 90.0, 133.0] {
            let mut state = Polarisation::new(1);
            let mut intensity = [1.0];
            for angle in [10.0, 10.0 + degrees] {
                intensity[0] *= 0.5;
                state.turn(pass_s, [DVec3::Z; 2], linear(angle), &mut intensity);
            }
            let expected = 0.5 * degrees.to_radians().cos().powi(2);
            assert!((intensity[0] - expected).abs() < 1e-15, "{degrees}: {} {expected}", intensity[0]);
        }
    }

    /// A half-wave plate at 22.5° between polarisers at 0° and 45° passes everything, a quarter-wave plate at 45° makes circular
    /// light, of which any polariser passes half.
    #[test]
    fn plates_delay() {
        let plate = |re: f64, im: f64| {
            move |components: &mut [Components]| {
                components.fill(Components { s: 1.0, p: 1.0, re, im });
                true
            }
        };
        let through = |re, im, at: f64, last: f64| {
            let mut state = Polarisation::new(1);
            let mut intensity = [1.0];
            state.turn(pass_s, [DVec3::Z; 2], linear(0.0), &mut intensity);
            state.turn(plate(re, im), [DVec3::Z; 2], linear(at), &mut intensity);
            state.turn(pass_s, [DVec3::Z; 2], linear(last), &mut intensity);
            0.5 * intensity[0]
        };
        assert!((through(-1.0, 0.0, 22.5, 45.0) - 1.0).abs() < 1e-15);
        for last in [0.0, 30.0, 77.0] {
            assert!((through(0.0, 1.0, 45.0, last) - 0.5).abs() < 1e-15, "{last}");
        }
        // Two quarter-wave plates are a half-wave plate.
        let mut state = Polarisation::new(1);
        let mut intensity = [1.0];
        state.turn(pass_s, [DVec3::Z; 2], linear(0.0), &mut intensity);
        (0..2).for_each(|_| state.turn(plate(0.0, -1.0), [DVec3::Z; 2], linear(22.5), &mut intensity));
        state.turn(pass_s, [DVec3::Z; 2], linear(45.0), &mut intensity);
        assert!((0.5 * intensity[0] - 1.0).abs() < 1e-15);
    }
}
