//! What a scene requires of the model of light: only that is computed, and what was left out is said.

use std::ops::Range;
use std::sync::Arc;

use super::Builder;
use super::material::Named;
use crate::render::description;
use crate::render::description::sensor::Sensor;
use crate::render::description::surface::Shape as Described;
use crate::render::light::Light;
use crate::render::material::{Material, Nature};
use crate::render::scene::Part;

/// What of the model of light a scene needs, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// Everything was asked for, needed or not.
    pub full: bool,
    /// Whether what mirrors and glass polarise is followed to the next of them.
    pub polarisation: bool,
    /// Why, or why not.
    pub polarisation_because: &'static str,
    /// Surfaces with Dirac lobes: polished metal and glass, panes.
    pub polished_surfaces: usize,
    /// Materials in use that refract wavelengths in different directions.
    pub dispersive: Vec<String>,
    /// Materials in use that change wavelengths.
    pub fluorescent: Vec<String>,
    /// Materials in use that look different when they are turned.
    pub anisotropic: Vec<String>,
    /// Whether anything scatters: otherwise the light of the lamps is all there is.
    pub global: bool,
    /// Whether light is gathered or thrown by polished surfaces onto others, which packets from the lights find and paths from the camera do
    /// not, or hardly.
    pub caustics: bool,
    /// Why, or why not.
    pub caustics_because: &'static str,
    /// Whether paths from the camera or a meter miss some of that, or of what is thrown on the meter itself, altogether, because its light comes from one
    /// direction.
    pub caustics_missed: bool,
    /// Lights of no flux, which were left out.
    pub dark_lights: Vec<String>,
    /// Lights whose light comes to no surface and to no instrument, which were left out.
    pub out_of_reach: Vec<String>,
    /// Lights that reach a point from one direction, in closed form: no direction has to be drawn.
    pub closed_form_lights: Vec<String>,
}

/// Directions at which a material is asked whether it is black.
const ASKED: [(f64, f64); 3] = [(0.0, 0.0), (45.0, 30.0), (80.0, 200.0)];

impl Builder<'_> {
    /// What the surfaces and lights require.
    pub(super) fn analysis(
        &self,
        parts: &[Part],
        surfaces: &[Range<usize>],
        materials: &[Named],
        lights: &[(String, Arc<dyn Light>)],
        [dark_lights, out_of_reach]: [Vec<String>; 2],
        bands: usize,
    ) -> Analysis {
        let render = &self.description.render;
        let full = render.model == description::Model::Full;
        let used: Vec<(&str, &dyn Material)> = (materials.iter())
            .filter(|(_, material)| parts.iter().any(|p| Arc::ptr_eq(&p.material, material)))
            .map(|(name, material)| (name.as_str(), material.as_ref()))
            .collect();
        let of = |has: fn(&Nature) -> bool| -> Vec<String> {
            used.iter().filter(|(_, m)| has(&m.nature())).map(|(name, _)| (*name).to_owned()).collect()
        };
        let polished = |range: &Range<usize>| parts[range.clone()].iter().filter(|p| p.material.has_delta()).count();
        let polished_surfaces = surfaces.iter().map(polished).sum();
        let flat = (self.description.shape.iter().zip(surfaces)).all(|(s, range)| polished(range) == 0 || is_flat(s));
        let (polarisation, polarisation_because) = match (full, render.polarisation, polished_surfaces, flat) {
            (true, ..) => (true, "everything was asked for"),
            (_, Some(true), ..) => (true, "the scene asks for it"),
            (_, Some(false), ..) => (false, "the scene asks for none"),
            (_, _, 0, _) => (false, "nothing is polished, and everything else depolarises"),
            (_, _, 1, true) => (false, "from one flat polished surface no light comes to another"),
            _ => (true, "light can go from one polished surface to another"),
        };
        let refracts = parts.iter().any(|p| p.material.has_delta() && p.material.is_transmissive());
        let one_direction = lights.iter().any(|(_, light)| light.is_one_direction());
        let scatters = parts.iter().any(|p| !p.material.is_delta() && !is_black(p.material.as_ref(), bands));
        let is_meter = |s: &Sensor| {
            s.illuminance.is_some() || s.cylindrical.is_some() || s.hemispherical.is_some() || s.spherical.is_some()
        };
        let receives = scatters || self.description.sensor.iter().any(is_meter);
        let (caustics, caustics_because) = match (polished_surfaces, scatters, one_direction, refracts) {
            (0, ..) => (false, "nothing is polished"),
            (_, false, ..) => (false, "nothing scatters what polished surfaces throw on it"),
            (_, _, true, _) => {
                (true, "paths from a camera or a meter never meet a light of one direction in polished surfaces")
            }
            (_, _, _, true) => (true, "paths from a camera or a meter meet lights through glass only by chance"),
            _ => (true, "paths from a camera or a meter meet lights in mirrors only by chance"),
        };
        Analysis {
            full,
            caustics,
            caustics_because,
            caustics_missed: polished_surfaces > 0 && receives && one_direction,
            polarisation,
            polarisation_because,
            polished_surfaces,
            dispersive: of(|n| n.disperses),
            fluorescent: of(|n| n.fluoresces),
            anisotropic: of(|n| n.anisotropic),
            global: parts.iter().any(|p| !is_black(p.material.as_ref(), bands)),
            dark_lights,
            out_of_reach,
            closed_form_lights: (lights.iter())
                .filter(|(_, light)| light.is_one_direction())
                .map(|(name, _)| name.clone())
                .collect(),
        }
    }
}

/// Whether a shape is one flat surface.
pub(super) fn is_flat(shape: &Described) -> bool {
    shape.rectangle.is_some()
        || shape.disk.is_some()
        || shape.polygon.is_some()
        || shape.triangle.is_some()
        || shape.plane.is_some()
}

/// Whether a material scatters nothing, as far as it says.
fn is_black(material: &dyn Material, bands: usize) -> bool {
    let mut share = vec![0.0; bands];
    ASKED.iter().all(|&(theta, phi)| {
        let direction = crate::geometry::direction::from_degrees(theta, phi);
        [direction, -direction].into_iter().all(|d| {
            let known = !material.nature().fluoresces && material.albedo(d, &mut share).is_some();
            known && share.iter().all(|s| *s == 0.0)
        })
    })
}
