//! What the elements make of the light that they receive.

use std::f64::consts::PI;

use glam::DVec3;

use super::patches::{Node, Patch};
use crate::geometry::direction;
use crate::render::material::{Material, Transport};
use crate::render::scene::Scene;

/// Directions in which a material is asked whether it is diffuse: polar angle and azimuth, degrees.
const ASKED: [(f64, f64); 6] = [(3.0, 0.0), (30.0, 20.0), (30.0, 200.0), (55.0, 95.0), (75.0, 180.0), (86.0, 310.0)];

/// The reflectance of a diffuse material, per band, of its outside and its inside (of what [`Material::convert`] leaves); `None` where it
/// is not the same in all directions.
#[must_use]
pub fn diffuse(material: &dyn Material, bands: usize) -> Option<[Vec<f64>; 2]> {
    if material.has_delta() || material.is_transmissive() || material.splits() {
        return None;
    }
    let mut found: [Option<Vec<f64>>; 2] = [None, None];
    let mut value = vec![0.0; bands];
    for (side, reflectance) in found.iter_mut().enumerate() {
        let flip = |(theta, phi): (f64, f64)| {
            let d = direction::from_degrees(theta, phi);
            if side == 0 { d } else { DVec3::new(d.x, d.y, -d.z) }
        };
        for incident in ASKED {
            for outgoing in ASKED {
                material.evaluate(flip(incident), flip(outgoing), Transport::Flux, &mut value);
                value.iter_mut().for_each(|v| *v *= PI);
                match reflectance {
                    None => *reflectance = Some(value.clone()),
                    Some(first) if first.iter().zip(&value).any(|(a, b)| (a - b).abs() > 1e-9) => return None,
                    Some(_) => {}
                }
            }
        }
    }
    let [Some(outside), Some(inside)] = found else { return None };
    Some([outside, inside])
}

/// How the elements reflect.
#[derive(Debug)]
pub(super) struct Reflection<'a> {
    scene: &'a Scene,
    /// By surface and side.
    plain: Vec<[Vec<f64>; 2]>,
}

impl<'a> Reflection<'a> {
    /// Of a scene whose materials are all [`diffuse`]; one that is not counts as black.
    pub fn new(scene: &'a Scene) -> Self {
        let n = scene.bands().len();
        let of = |surface| diffuse(scene.material(surface), n).unwrap_or_else(|| [vec![0.0; n], vec![0.0; n]]);
        Self { scene, plain: (0..scene.surfaces().shapes().len()).map(of).collect() }
    }

    /// Turns an irradiance into what leaves the surface of it, at texture coordinates `uv`.
    pub fn apply(&self, surface: usize, back: bool, uv: glam::DVec2, values: &mut [f64], scratch: &mut [f64]) {
        self.scene.material(surface).convert(uv, Transport::Flux, values, scratch);
        multiply(values, &self.plain[surface][usize::from(back)]);
    }
}

/// What an element makes of its irradiance, the mean over the patch.
pub(super) enum Operator {
    /// Each band by itself.
    Factors(Vec<f64>),
    /// Rows of outgoing bands, columns of incident ones.
    Matrix(Vec<f64>),
}

impl Operator {
    /// Of a side of a patch.
    pub fn new(reflection: &Reflection<'_>, patch: &Patch, back: bool) -> Self {
        let scene = reflection.scene;
        let (n, material) = (scene.bands().len(), scene.material(patch.surface));
        if !material.converts() {
            return Self::Factors(reflection.plain[patch.surface][usize::from(back)].clone());
        }
        // A matrix takes the square of the bands for each of them: one point of the patch stands for all.
        let nodes: &[Node] = if material.nature().fluoresces { &patch.coarse[..1] } else { &patch.fine };
        let places: Vec<_> =
            (nodes.iter()).filter_map(|node| Some((patch.surface_point(scene, &node.spot)?.uv, node.weight))).collect();
        let whole: f64 = places.iter().map(|p| p.1).sum();
        let (mut value, mut scratch) = (vec![0.0; n], vec![0.0; n]);
        // The mean of what becomes of an irradiance.
        let mut of = |start: &dyn Fn(&mut [f64])| {
            let mut mean = vec![0.0; n];
            for (uv, weight) in &places {
                start(&mut value);
                reflection.apply(patch.surface, back, *uv, &mut value, &mut scratch);
                mean.iter_mut().zip(&value).for_each(|(m, v)| *m += v * weight / whole);
            }
            mean
        };
        if !material.nature().fluoresces {
            return Self::Factors(of(&|value| value.fill(1.0)));
        }
        let mut matrix = vec![0.0; n * n];
        for incident in 0..n {
            let column = of(&|value| {
                value.fill(0.0);
                value[incident] = 1.0;
            });
            column.into_iter().enumerate().for_each(|(outgoing, v)| matrix[outgoing * n + incident] = v);
        }
        Self::Matrix(matrix)
    }

    pub fn apply(&self, irradiance: &[f64], out: &mut [f64]) {
        match self {
            Self::Factors(factors) => {
                out.iter_mut().zip(irradiance).zip(factors).for_each(|((o, e), f)| *o = e * f);
            }
            Self::Matrix(matrix) => {
                let rows = matrix.chunks_exact(irradiance.len());
                out.iter_mut().zip(rows).for_each(|(o, row)| *o = row.iter().zip(irradiance).map(|(m, e)| m * e).sum());
            }
        }
    }
}

fn multiply(values: &mut [f64], by: &[f64]) {
    values.iter_mut().zip(by).for_each(|(v, b)| *v *= b);
}
