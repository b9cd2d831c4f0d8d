//! What the solver `radiosity` asks of a scene: surfaces with bounds, diffuse materials, instruments that look at surfaces.

use std::ops::Range;

use super::instrument::{Instrument, Kind};
use super::{Builder, surface};
use crate::render::description::{Error, Solver};
use crate::render::measure::Place;
use crate::render::radiosity::{Settings, diffuse};
use crate::render::scene::Scene;

impl Builder<'_> {
    /// How the scene is solved, where that is asked for; `surfaces` are the scene's that each described shape is.
    pub(super) fn radiosity(
        &self,
        scene: &Scene,
        surfaces: &[Range<usize>],
        instruments: &[Instrument],
    ) -> Result<Option<Settings>, Error> {
        let render = &self.description.render;
        if render.solver != Solver::Radiosity {
            return match &render.patch_edge {
                Some(edge) => {
                    Err(self.wrong(&edge.span(), "a `patch_edge` of another solver; expected solver = \"radiosity\""))
                }
                None => Ok(None),
            };
        }
        for (number, (shape, surfaces)) in self.description.shape.iter().zip(surfaces).enumerate() {
            let name = surface::name(shape, number);
            if let Some(plane) = &shape.plane {
                let message = format!(
                    "`{name}` is a plane without bounds; the solver \"radiosity\" expects surfaces of finite area, \"path\" takes all"
                );
                return Err(self.wrong(&plane.span(), message));
            }
            let Some(material) = &shape.material else { continue };
            if diffuse(scene.material(surfaces.start), scene.bands().len()).is_none() {
                let message = format!(
                    "material `{}` of `{name}` is not diffuse; the solver \"radiosity\" expects the same radiance in all directions, \"path\" takes all materials",
                    material.get_ref()
                );
                return Err(self.wrong(&material.span(), message));
            }
        }
        for (sensor, instrument) in self.description.sensor.iter().zip(instruments) {
            let message = match &instrument.kind {
                Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_) => "counts packets",
                Kind::Meter(meter) if matches!(meter.place, Place::Around) => "counts packets",
                _ if instrument.target.is_some() => "has a `target` for its standard error",
                _ => continue,
            };
            let message = format!(
                "sensor `{}` {message}, of which the solver \"radiosity\" knows none; expected the solver \"path\"",
                instrument.name
            );
            return Err(self.wrong(&sensor.name.span(), message));
        }
        let edge = render.patch_edge.as_ref();
        if let Some(edge) = edge.filter(|e| !(e.get_ref().0 > 0.0 && e.get_ref().0.is_finite())) {
            return Err(self.wrong(&edge.span(), "a `patch_edge` that is not above 0"));
        }
        let tolerance = render.radiosity_tolerance;
        if !(tolerance > 0.0 && tolerance < 1.0) {
            let message = format!("a `radiosity_tolerance` of {tolerance}; expected a share above 0 and below 1");
            return Err(self.wrong(&(0..0), message));
        }
        Ok(Some(Settings { edge_m: edge.map(|e| e.get_ref().0), tolerance }))
    }
}
