//! Which lights can matter: those that no surface and no instrument can receive anything of are left out.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::{Builder, surface};
use crate::render::description::sensor::Sensor;
use crate::render::light::Light;
use crate::render::light::area::AreaLight;
use crate::render::scene::Part;
use crate::render::shape::Bounds;

/// What was left out, by its number in the description.
#[derive(Debug, Default)]
pub(super) struct LeftOut {
    /// Lights.
    pub lights: Vec<usize>,
    /// Shapes none of whose surfaces shines any more.
    pub shapes: Vec<usize>,
    /// Surfaces that do not shine any more, by their number among all.
    pub surfaces: Vec<usize>,
    /// The lights of no flux.
    pub without_flux: Vec<String>,
    /// Those that reach nothing.
    pub out_of_reach: Vec<String>,
}

/// A light of the description: its number there and its name.
pub(super) type Numbered = (usize, String, Arc<dyn Light>);

impl Builder<'_> {
    /// Takes the lights away that have no flux, and those that reach nothing.
    pub(super) fn leave_out(
        &self,
        parts: &mut [Part],
        surfaces: &[Range<usize>],
        lights: &mut Vec<Numbered>,
        bands: usize,
    ) -> LeftOut {
        let mut out = LeftOut::default();
        let mut flux = vec![0.0; bands];
        lights.retain(|(number, name, light)| {
            light.flux(&mut flux);
            let shines = flux.iter().any(|f| *f != 0.0);
            if !shines {
                out.lights.push(*number);
                out.without_flux.push(name.clone());
            }
            shines
        });
        self.out_of_reach(parts, surfaces, lights, &mut out);
        out
    }

    /// Takes the lights away that reach neither a surface nor an instrument, of surfaces their emission.
    ///
    /// A light is kept where nothing is known of how far it reaches ([`Light::can_reach`]), where a surface has no bounds, and where an
    /// instrument surrounds the scene.
    fn out_of_reach(
        &self,
        parts: &mut [Part],
        surfaces: &[Range<usize>],
        lights: &mut Vec<Numbered>,
        out: &mut LeftOut,
    ) {
        let Some(places) = self.description.sensor.iter().map(place).collect::<Option<Vec<Bounds>>>() else {
            return;
        };
        let bounds: Vec<Bounds> = parts.iter().map(|part| part.shape.bounds()).collect();
        if bounds.iter().any(|b| !b.is_finite()) {
            return;
        }
        lights.retain(|(number, name, light)| {
            let matters = bounds.iter().chain(&places).any(|b| light.can_reach(b));
            if !matters {
                out.lights.push(*number);
                out.out_of_reach.push(name.clone());
            }
            matters
        });
        for (number, (shape, surfaces)) in self.description.shape.iter().zip(surfaces).enumerate() {
            for own in surfaces.clone() {
                let Some(emission) = parts[own].emission.clone() else { continue };
                let light = AreaLight::new(Arc::clone(&parts[own].shape), emission);
                let others = bounds.iter().enumerate().filter(|(other, _)| *other != own).map(|(_, b)| b);
                if !others.chain(&places).any(|b| light.can_reach(b)) {
                    parts[own].emission = None;
                    out.surfaces.push(own);
                    out.out_of_reach.push(surface::name(shape, number));
                }
            }
            if shape.emission.is_some() && parts[surfaces.clone()].iter().all(|p| p.emission.is_none()) {
                out.shapes.push(number);
            }
        }
    }
}

/// A box around an instrument: around nothing where it is on surfaces or brings its own light, `None` where it surrounds the scene.
fn place(sensor: &Sensor) -> Option<Bounds> {
    let at = |p: [f64; 3]| Some(DVec3::from_array(p));
    let mut points: Vec<Option<DVec3>> = Vec::new();
    if let Some(i) = &sensor.illuminance {
        let i = i.get_ref();
        points.push(i.at.and_then(at));
        if let Some((corner, [u, v])) = i.grid.as_ref().and_then(|g| g.corner.zip(g.edges)) {
            let [corner, u, v] = [corner, u, v].map(DVec3::from_array);
            points.extend([corner, corner + u, corner + v, corner + u + v].map(Some));
        }
    }
    points.push(sensor.luminance.as_ref().and_then(|l| at(l.get_ref().at)));
    for upright in [&sensor.cylindrical, &sensor.hemispherical, &sensor.spherical] {
        points.push(upright.as_ref().and_then(|u| at(u.get_ref().at)));
    }
    let mut lens = 0.0;
    if let Some(camera) = &sensor.camera {
        points.push(at(camera.get_ref().at));
        lens = camera.get_ref().aperture_radius.as_ref().map_or(0.0, |radius| radius.0);
    }
    if sensor.integrating_sphere.is_some() || sensor.goniophotometer.is_some() {
        return None;
    }
    let bounds = Bounds::of(points.into_iter().flatten());
    Some(Bounds { min: bounds.min - lens, max: bounds.max + lens })
}
