//! The direction of a distant light from the shading of a diffuse ball, and what hangs on the assumptions.
//!
//! ```text
//! z = b + a max(0, n·l)^(1/γ)
//! ```
//!
//! Codes of unknown response make this a guess: the offset b (stray light, black level), the exponent γ of the response and the roughness of
//! the surface all bend the same curve. The direction is found for b from the attached shadow and γ = 1, and again for other values: what it
//! turns by is its uncertainty, far larger than what noise makes. [`entanglement`] says how much these three are told apart at all.

use glam::{DMat3, DVec2, DVec3};
use nalgebra::{DMatrix, DVector};

use super::angle_deg;
use super::outline::Outline;
use super::view::{Ball, View};
use crate::capture::{Error, Photo};
use crate::math::least_squares::{Limits, Linearised, Problem, invert, minimise};

/// Margin at the edge of the ball that is not used, parts of the radius: mixed pixels.
const MARGIN: f64 = 0.05;
/// Cosine above which a point counts as lit; what is flatter is where surfaces differ most from Lambert's.
const LIT: f64 = 0.2;
/// Cosine below which a point is in the attached shadow for sure.
const SHADOW: f64 = -0.1;
/// Luma from which on an 8-bit photograph is saturated.
const SATURATED: f64 = 250.0;
/// About how many points of a ball are used.
const POINTS: f64 = 4000.0;
/// Exponents of the response that are tried where it is unknown.
const GAMMAS: [f64; 2] = [0.8, 1.25];
/// Scale of a residual at which it counts less, in robust standard deviations.
const HUBER: f64 = 1.5;

/// A photograph of a diffuse ball.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Points {
    /// Normals of the ball.
    pub normals: Vec<DVec3>,
    /// Directions to the camera.
    pub views: Vec<DVec3>,
    /// Luma there, 0 to 255.
    pub codes: Vec<f64>,
}

impl Points {
    /// About 4000 unsaturated pixels of a ball on an even grid.
    #[must_use]
    pub fn of(photo: &Photo, view: &View, ball: &Ball, outline: &Outline) -> Self {
        let luma = photo.luma();
        let area = std::f64::consts::PI * outline.radius * outline.radius;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
        let every = ((area / POINTS).sqrt() as usize).max(1);
        let mut points = Self::default();
        for y in (0..photo.height).step_by(every) {
            for x in (0..photo.width).step_by(every) {
                let pixel = DVec2::new(x as f64, y as f64);
                let code = f64::from(luma[y * photo.width + x]);
                if !outline.holds(pixel, MARGIN) || !(photo.is_linear() || code < SATURATED) || !code.is_finite() {
                    continue;
                }
                if let Some(normal) = view.ray(pixel).and_then(|r| ball.normal(r)) {
                    points.normals.push(normal);
                    points.views.push(view.back(ball.centre + ball.radius * normal));
                    points.codes.push(code);
                }
            }
        }
        points
    }

    /// The light of least squared residuals for an offset and an exponent: direction times gain, and the robust standard deviation of the
    /// residuals; `None` where nothing is lit.
    fn light(&self, offset: f64, gamma: f64) -> Option<(DVec3, f64)> {
        let values: Vec<f64> = self.codes.iter().map(|z| (z - offset).max(0.0).powf(gamma)).collect();
        // Brightness-weighted normals point near the light.
        let mut light = self.normals.iter().zip(&values).map(|(n, v)| *n * *v).sum::<DVec3>().try_normalize()?;
        light *= values.iter().copied().fold(0.0, f64::max);
        let mut sigma = f64::INFINITY;
        for _ in 0..30 {
            let least = LIT * light.length();
            let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
            let mut residuals = Vec::new();
            for (n, v) in self.normals.iter().zip(&values) {
                let expected = n.dot(light);
                if expected <= least {
                    continue;
                }
                let r = v - expected;
                residuals.push(r.abs());
                let w = if r.abs() > HUBER * sigma { HUBER * sigma / r.abs() } else { 1.0 };
                normal += DMat3::from_cols(*n * n.x, *n * n.y, *n * n.z) * w;
                right += *n * (w * v);
            }
            if residuals.len() < 10 {
                return None;
            }
            let half = residuals.len() / 2;
            sigma = 1.4826 * *residuals.select_nth_unstable_by(half, f64::total_cmp).1;
            let next = normal.inverse() * right;
            if !next.is_finite() || next == DVec3::ZERO {
                return None;
            }
            let moved = angle_deg(next, light);
            light = next;
            if moved < 1e-6 {
                break;
            }
        }
        Some((light, sigma / light.length()))
    }

    /// Median code in the attached shadow of a light; `None` where the camera sees little of it.
    fn shadow(&self, light: DVec3) -> Option<f64> {
        let light = light.normalize();
        let dark = self.normals.iter().zip(&self.codes).filter(|(n, _)| n.dot(light) < SHADOW).map(|(_, z)| *z);
        let mut dark: Vec<f64> = dark.collect();
        let half = dark.len() / 2;
        (dark.len() >= 20).then(|| *dark.select_nth_unstable_by(half, f64::total_cmp).1)
    }
}

/// A light from shading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaded {
    /// Towards it, of length 1.
    pub direction: DVec3,
    /// Largest angle to the directions under other assumptions, degrees.
    pub spread_deg: f64,
    /// Offset of the codes that it was found with.
    pub offset: f64,
    /// Robust standard deviation of the residuals over the code of a surface that faces the light, without offset.
    pub residual: f64,
}

/// The direction of a light from a diffuse ball. `linear`: codes are proportional to exposure, and only the offset is in doubt.
///
/// # Errors
/// [`Error::Shading`] where nothing of the ball is lit, or all of it alike.
pub fn direction(name: &str, points: &Points, linear: bool) -> Result<Shaded, Error> {
    let none = |why: &'static str| Error::Shading { name: name.to_owned(), why };
    let most = points.codes.iter().copied().fold(0.0, f64::max);
    if points.codes.len() < 20 {
        return Err(none("hardly a pixel of the ball is in range"));
    }
    if most <= 0.0 || (!linear && most < 16.0) {
        return Err(none("its ball is dark; was the light on?"));
    }
    if points.codes.iter().all(|z| *z >= most) {
        return Err(none("all of its ball is equally bright"));
    }
    let unlit = || none("nothing of its ball is lit as by one lamp");
    let (first, _) = points.light(0.0, 1.0).ok_or_else(unlit)?;
    let offset = points.shadow(first).unwrap_or(0.0);
    let (best, residual) = points.light(offset, 1.0).ok_or_else(unlit)?;
    let gammas = GAMMAS.iter().map(|g| (offset, *g)).filter(|_| !linear);
    let others = gammas.chain([(0.0, 1.0), (2.0 * offset, 1.0)]);
    let turned = others.filter_map(|(b, g)| points.light(b, g)).map(|(l, _)| angle_deg(l, best));
    Ok(Shaded { direction: best.normalize(), spread_deg: turned.fold(0.0, f64::max), offset, residual })
}

/// What shading tells of offset, exponent and roughness, and how far it tells them apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Entanglement {
    /// Offset b (codes), exponent γ, roughness σ (Oren and Nayar's, rad).
    pub values: [f64; 3],
    /// Their standard errors.
    pub errors: [f64; 3],
    /// Their correlations: b with γ, b with σ, γ with σ.
    pub correlations: [f64; 3],
    /// Robust rms of the residuals, codes.
    pub rms: f64,
}

/// Correlation from which on two numbers are not told apart.
pub const INSEPARABLE: f64 = 0.9;

impl Entanglement {
    /// Whether all three mean something: no two of them can stand for one another.
    #[must_use]
    pub fn is_told_apart(&self) -> bool {
        self.correlations.iter().all(|r| r.abs() <= INSEPARABLE)
    }
}

/// Fits b, γ and the roughness of Oren and Nayar's surface (1994, their qualitative model) and a gain per photograph at once, the lights
/// given. Standard errors are those of the residuals taken as independent: least values. `None` where the equations have no solution.
#[must_use]
pub fn entanglement(photographs: &[(&Points, DVec3)]) -> Option<Entanglement> {
    let rough = Rough { photographs };
    let mut start = vec![0.0, 1.0, 0.3];
    start.extend(photographs.iter().map(|(p, _)| p.codes.iter().copied().fold(0.0, f64::max)));
    let (mut low, mut high) = (vec![-50.0, 0.3, 0.0], vec![100.0, 3.5, std::f64::consts::FRAC_PI_2]);
    low.resize(start.len(), 1e-3);
    high.resize(start.len(), f64::INFINITY);
    let limits = Limits { iterations: 100, step: 1e-7, gain: 1e-9 };
    let found = minimise(&rough, &start, &low, &high, &limits)?;
    let free: Vec<usize> = (0..start.len()).filter(|i| found.resting[*i].is_none()).collect();
    let inverse = invert(&found.at.normal, &free).matrix;
    let (mut count, mut square) = (0.0, 0.0);
    rough.each(&found.x, &mut |_, r, w| {
        count += w;
        square += w * r * r;
    });
    let variance = square / (count - free.len() as f64).max(1.0);
    let entry = |i: usize, j: usize| {
        let place = |k: usize| free.iter().position(|f| *f == k);
        place(i).zip(place(j)).map_or(f64::NAN, |(a, b)| inverse[(a, b)])
    };
    let error = |i: usize| (entry(i, i) * variance).sqrt();
    let correlation = |i: usize, j: usize| entry(i, j) / (entry(i, i) * entry(j, j)).sqrt();
    Some(Entanglement {
        values: [found.x[0], found.x[1], found.x[2]],
        errors: [error(0), error(1), error(2)],
        correlations: [correlation(0, 1), correlation(0, 2), correlation(1, 2)],
        rms: variance.sqrt(),
    })
}

/// Radiance of Oren and Nayar's surface under a light of unit irradiance where it faces it, times π over its reflectance.
fn oren_nayar(normal: DVec3, light: DVec3, view: DVec3, sigma: f64) -> f64 {
    let (cos_i, cos_o) = (normal.dot(light), normal.dot(view));
    if cos_i <= 0.0 || cos_o <= 0.0 {
        return 0.0;
    }
    let s2 = sigma * sigma;
    let (a, b) = (1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
    let across = |d: DVec3, cos: f64| (d - cos * normal).normalize_or_zero();
    let cos_phi = across(light, cos_i).dot(across(view, cos_o)).max(0.0);
    let sin = |cos: f64| (1.0 - cos * cos).max(0.0).sqrt();
    // sin α tan β with α the larger and β the smaller angle.
    cos_i * (a + b * cos_phi * sin(cos_i) * sin(cos_o) / f64::max(cos_i, cos_o))
}

struct Rough<'a> {
    photographs: &'a [(&'a Points, DVec3)],
}

impl Rough<'_> {
    /// Visits the photograph, the residual in codes and the weight of each point.
    fn each(&self, x: &[f64], visit: &mut dyn FnMut(usize, f64, f64)) {
        for (k, (points, light)) in self.photographs.iter().enumerate() {
            for ((n, v), z) in points.normals.iter().zip(&points.views).zip(&points.codes) {
                if n.dot(*light) > LIT {
                    let radiance = oren_nayar(*n, *light, *v, x[2]);
                    let r = x[0] + x[3 + k] * radiance.max(0.0).powf(1.0 / x[1]) - z;
                    visit(k, r, 1.0 / (1.0 + (r / FAR).powi(2)));
                }
            }
        }
    }
}

/// Codes by which a point may be off before it counts half: stains, glints.
const FAR: f64 = 6.0;

impl Problem for Rough<'_> {
    fn cost(&self, x: &[f64]) -> Option<f64> {
        let mut cost = 0.0;
        // Cauchy's: the weights of `each` are its derivative.
        self.each(x, &mut |_, r, _| cost += FAR * FAR * (r / FAR).powi(2).ln_1p());
        cost.is_finite().then_some(cost)
    }

    fn linearise(&self, x: &[f64]) -> Option<Linearised> {
        let cost = self.cost(x)?;
        let count = x.len();
        let (mut normal, mut gradient) = (DMatrix::zeros(count, count), DVector::zeros(count));
        for (k, one) in self.photographs.iter().enumerate() {
            let part = Rough { photographs: std::slice::from_ref(one) };
            let own = [x[0], x[1], x[2], x[3 + k]];
            let columns = [0, 1, 2, 3 + k];
            let mut at = Vec::new();
            part.each(&own, &mut |_, r, w| at.push((r, w)));
            let moved: Vec<Vec<f64>> = (0..4)
                .map(|p| {
                    let h = 1e-6 * own[p].abs().max(0.01);
                    let mut there = own;
                    there[p] += h;
                    let mut column = Vec::with_capacity(at.len());
                    part.each(&there, &mut |_, r, _| column.push(r));
                    column.iter().zip(&at).map(|(r, (r0, _))| (r - r0) / h).collect()
                })
                .collect();
            for a in 0..4 {
                let ja = &moved[a];
                gradient[columns[a]] += ja.iter().zip(&at).map(|(j, (r, w))| j * r * w).sum::<f64>();
                for b in 0..4 {
                    let sum: f64 = ja.iter().zip(&moved[b]).zip(&at).map(|((a, b), (_, w))| a * b * w).sum();
                    normal[(columns[a], columns[b])] += sum;
                }
            }
        }
        Some(Linearised { cost, normal, gradient })
    }
}
