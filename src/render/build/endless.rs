//! Closed scenes that keep all light: refused where nothing would end a path or a packet.

use std::ops::Range;

use super::instrument::{Instrument, Kind};
use super::{Builder, surface};
use crate::render::description::{Error, Solver};
use crate::render::enclosure::{self, Enclosure, Start};
use crate::render::integrator::limits::{Follow, Limits};
use crate::render::measure::Place;
use crate::render::ray::SurfacePoint;
use crate::render::scene::Scene;

/// Names of walls that a message has at most.
const NAMED: usize = 3;

impl Builder<'_> {
    /// Whether light or instruments are in a space that keeps all light, and only the solver's limits end paths there.
    ///
    /// Refuses the scene where they do not: without `max_edges`, where all light is followed; by radiosity, whose equations have no solution
    /// then; and where an instrument counts the packets of lights within, which know no limit.
    pub(super) fn endless(
        &self,
        scene: &Scene,
        surfaces: &[Range<usize>],
        instruments: &[Instrument],
        limits: &Limits,
    ) -> Result<bool, Error> {
        let cases = enclosure::cases(scene);
        if cases.is_empty() {
            return Ok(false);
        }
        let bands = scene.bands().len();
        let lights: Vec<Start> =
            scene.lights().iter().map(|light| enclosure::of_light(light.as_ref(), bands)).collect();
        let of_instrument = |i: &Instrument| match &i.kind {
            Kind::Meter(meter) => vec![enclosure::of_meter(meter)],
            Kind::Grid { meters, .. } => meters.iter().map(enclosure::of_meter).collect(),
            Kind::Camera(camera) => {
                let [x, y] = [camera.width(), camera.height()].map(|n| 0.5 * f64::from(n));
                let ray = camera.ray(x, y, [0.5; 2]);
                let place = ray.map(|ray| SurfacePoint::meter(ray.origin, ray.direction, 0.0));
                place.iter().map(enclosure::of_place).collect()
            }
            Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_) => Vec::new(),
        };
        let starts: Vec<Start> = lights.iter().cloned().chain(instruments.iter().flat_map(of_instrument)).collect();
        let Some(enclosure) = Enclosure::find(scene, &cases, &starts) else { return Ok(false) };
        let holds_light = lights.iter().any(|light| enclosure.holds(scene, light));
        let counts = |i: &Instrument| match &i.kind {
            Kind::Meter(meter) => matches!(meter.place, Place::Around),
            Kind::Goniophotometer(_) => true,
            _ => false,
        };
        let unlimited =
            self.description.render.solver == Solver::Radiosity || holds_light && instruments.iter().any(counts);
        let followed = match limits.follow {
            Follow::All => true,
            Follow::Specular => enclosure.specular,
            Follow::Nothing => false,
        };
        if !unlimited && (!followed || limits.max_edges.is_some()) {
            return Ok(true);
        }
        let walls: Vec<usize> = enclosure.walls().collect();
        let shapes = self.description.shape.iter().zip(surfaces).enumerate();
        let walls: Vec<_> = shapes
            .filter(|(_, (_, own))| walls.iter().any(|w| own.contains(w)))
            .map(|(n, (shape, _))| (n, shape))
            .collect();
        let mut names: Vec<String> =
            walls.iter().take(NAMED).map(|(n, shape)| format!("`{}`", surface::name(shape, *n))).collect();
        if walls.len() > NAMED {
            names.push(format!("{} more", walls.len() - NAMED));
        }
        let limit = if unlimited { "" } else { ", or `max_edges`" };
        let message = format!(
            "a space closed by {} that absorbs nothing: light within grows without bound and paths never end; expected a reflectance below 1, an opening{limit}",
            names.join(", ")
        );
        let span = walls.iter().find_map(|(_, shape)| shape.material.as_ref()).map_or(0..0, toml::Spanned::span);
        Err(self.wrong(&span, message))
    }
}
