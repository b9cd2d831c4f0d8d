//! One trial of the simulation: an erring spectrum.

use nalgebra::DMatrix;

use super::{Kind, Model, Number};
use crate::math::interpolate;
use crate::math::random::Stream;
use crate::uncertainty::budget::Distribution;

/// Single errors of a trial, standardised ones turned into amounts.
#[derive(Debug, Clone, Copy)]
struct Errors {
    offset_nm: f64,
    /// Scale and where it is right.
    scale: (f64, f64),
    bandwidth: f64,
    linearity: f64,
    stray_light: f64,
    factor: f64,
}

impl Model {
    /// The erring spectrum of one trial, in place of what `out` held.
    ///
    /// `factors` is room for one number per sample, kept from trial to trial.
    pub(in crate::uncertainty) fn trial(&self, stream: &mut Stream, factors: &mut Vec<f64>, out: &mut [f64]) {
        let mut errors =
            Errors { offset_nm: 0.0, scale: (0.0, 0.0), bandwidth: 0.0, linearity: 0.0, stray_light: 0.0, factor: 1.0 };
        // Single numbers first: they act on the spectrum itself.
        for input in &self.inputs {
            if let Kind::Number(what, u, distribution) = input.kind {
                let e = u * standardised(stream, distribution);
                match what {
                    Number::Offset => errors.offset_nm += e,
                    Number::WavelengthScale { about_nm } => errors.scale = (e, about_nm),
                    Number::Bandwidth { fwhm_nm } => {
                        errors.bandwidth = ((fwhm_nm + e).powi(2) - fwhm_nm.powi(2)) / 12.0
                    }
                    Number::Linearity => errors.linearity += e,
                    Number::StrayLight => errors.stray_light += e,
                    Number::InverseSquare { value } => errors.factor *= (value / (value + e)).powi(2),
                    Number::Factor => errors.factor *= 1.0 + e,
                }
            }
        }
        self.deform(&errors, out);
        for input in &self.inputs {
            match &input.kind {
                Kind::Together(relative, distribution) => {
                    let z = standardised(stream, *distribution);
                    out.iter_mut().zip(relative).for_each(|(v, r)| *v *= 1.0 + z * r);
                }
                Kind::Chain { relative, correlation } => {
                    let mut before = 0.0;
                    each_normal(stream, out.len(), |i, z| {
                        let r = correlation[i];
                        before = r * before + (1.0 - r * r).sqrt() * z;
                        out[i] *= 1.0 + before * relative[i];
                    });
                }
                Kind::Modes(modes) => Self::modes(modes, stream, factors, out),
                Kind::Noise(_) | Kind::AbsoluteModes(_) | Kind::Number(..) => {}
            }
        }
        for input in &self.inputs {
            match &input.kind {
                Kind::Noise(standard) => each_normal(stream, out.len(), |i, z| out[i] += z * standard[i]),
                Kind::AbsoluteModes(modes) => each_normal(stream, modes.ncols(), |k, z| {
                    out.iter_mut().zip(modes.column(k).iter()).for_each(|(v, m)| *v += z * m);
                }),
                _ => {}
            }
        }
    }

    /// out · (1 + M z).
    fn modes(modes: &DMatrix<f64>, stream: &mut Stream, factors: &mut Vec<f64>, out: &mut [f64]) {
        factors.clear();
        factors.resize(out.len(), 1.0);
        each_normal(stream, modes.ncols(), |k, z| {
            factors.iter_mut().zip(modes.column(k).iter()).for_each(|(f, m)| *f += z * m);
        });
        out.iter_mut().zip(factors).for_each(|(v, f)| *v *= *f);
    }

    /// The spectrum under errors of wavelength, bandwidth, linearity, stray light and scale.
    fn deform(&self, e: &Errors, out: &mut [f64]) {
        let (x, y) = (&self.wavelengths_nm, &self.values);
        let still = e.offset_nm == 0.0 && e.scale.0 == 0.0;
        let mut cell = 0;
        for (i, out) in out.iter_mut().enumerate() {
            let shifted = if still {
                y[i]
            } else {
                let at = x[i] - e.offset_nm - e.scale.0 * (x[i] - e.scale.1);
                let at = at.clamp(x[0], x[x.len() - 1]);
                // Shifted wavelengths ascend: the cell is never far from the last.
                while cell + 2 < x.len() && x[cell + 1] < at {
                    cell += 1;
                }
                let h = x[cell + 1] - x[cell];
                interpolate::hermite_cell(
                    h,
                    (at - x[cell]) / h,
                    [y[cell], y[cell + 1]],
                    [self.slopes[cell], self.slopes[cell + 1]],
                )
            };
            let broadened = shifted + e.bandwidth * self.curvatures[i];
            let read = broadened * (1.0 + e.linearity * (1.0 - y[i] / self.peak)) + e.stray_light * self.mean;
            *out = e.factor * read;
        }
    }
}

/// Calls `f` with each index below `count` and a standard normal number.
fn each_normal(stream: &mut Stream, count: usize, mut f: impl FnMut(usize, f64)) {
    for i in (0..count).step_by(2) {
        let [a, b] = stream.normals();
        f(i, a);
        if i + 1 < count {
            f(i + 1, b);
        }
    }
}

/// A number of mean 0 and standard deviation 1.
fn standardised(stream: &mut Stream, distribution: Distribution) -> f64 {
    match distribution {
        Distribution::Normal => stream.normals()[0],
        Distribution::Rectangular => 3f64.sqrt() * (2.0 * stream.uniform() - 1.0),
        Distribution::Triangular => 6f64.sqrt() * (stream.uniform() + stream.uniform() - 1.0),
    }
}
