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

impl Builder<'_> {
    /// Takes the lights away that reach neither a surface nor an instrument, of surfaces their emission; the names of them.
    ///
    /// A light is kept where nothing is known of how far it reaches ([`Light::can_reach`]), where a surface has no bounds, and where an
    /// instrument surrounds the scene.
    pub(super) fn out_of_reach(
        &self,
        parts: &mut [Part],
        surfaces: &[Range<usize>],
        lights: &mut Vec<(String, Arc<dyn Light>)>,
    ) -> Vec<String> {
        let Some(places) = self.description.sensor.iter().map(place).collect::<Option<Vec<Bounds>>>() else {
            return Vec::new();
        };
        let bounds: Vec<Bounds> = parts.iter().map(|part| part.shape.bounds()).collect();
        if bounds.iter().any(|b| !b.is_finite()) {
            return Vec::new();
        }
        let mut names = Vec::new();
        lights.retain(|(name, light)| {
            let matters = bounds.iter().chain(&places).any(|b| light.can_reach(b));
            if !matters {
                names.push(name.clone());
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
                    names.push(surface::name(shape, number));
                }
            }
        }
        names
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
