//! A scene, ready to be rendered: surfaces with their materials and emissions, lights, bands.

use std::sync::Arc;

use glam::DVec3;

use super::accelerate::Surfaces;
use super::bands::Bands;
use super::emission::Emission;
use super::light::Light;
use super::light::area::AreaLight;
use super::material::{Material, Nature};
use super::ray::{Crossing, Ray, SurfacePoint};
use super::shape::{Bounds, Shape};

/// One surface of a scene with what it is made of.
#[derive(Debug, Clone)]
pub struct Part {
    /// Where it is.
    pub shape: Arc<dyn Shape>,
    /// How it scatters, for the scene's bands.
    pub material: Arc<dyn Material>,
    /// What it emits, for the scene's bands.
    pub emission: Option<Arc<Emission>>,
}

/// Surfaces, lights and bands.
#[derive(Debug)]
pub struct Scene {
    bands: Bands,
    surfaces: Surfaces,
    materials: Vec<Arc<dyn Material>>,
    emissions: Vec<Option<Arc<Emission>>>,
    lights: Vec<Arc<dyn Light>>,
    /// The light that a surface is, by surface.
    light_of_surface: Vec<Option<usize>>,
    /// The surface that a light is, by light.
    surface_of_light: Vec<Option<usize>>,
    chooses_bands: bool,
}

impl Scene {
    /// Puts a scene together; every emitting surface of finite area becomes a light behind `lights`.
    #[must_use]
    pub fn new(bands: Bands, parts: Vec<Part>, lights: Vec<Arc<dyn Light>>) -> Self {
        let mut lights = lights;
        let mut surface_of_light = vec![None; lights.len()];
        let mut light_of_surface = Vec::with_capacity(parts.len());
        let (mut shapes, mut materials, mut emissions) = (Vec::new(), Vec::new(), Vec::new());
        for (index, part) in parts.into_iter().enumerate() {
            let light = part.emission.as_ref().filter(|_| part.shape.area().is_finite()).map(|emission| {
                lights.push(Arc::new(AreaLight::new(Arc::clone(&part.shape), Arc::clone(emission))));
                surface_of_light.push(Some(index));
                lights.len() - 1
            });
            light_of_surface.push(light);
            shapes.push(part.shape);
            materials.push(part.material);
            emissions.push(part.emission);
        }
        let surfaces = Surfaces::new(shapes);
        let alike = |material: &dyn Material| material.is_diffuse() && material.nature() == Nature::default();
        let chooses_bands = !materials.iter().all(|material| alike(material.as_ref()));
        Self { bands, surfaces, materials, emissions, lights, light_of_surface, surface_of_light, chooses_bands }
    }

    /// The wavelengths it was prepared for.
    #[must_use]
    pub fn bands(&self) -> &Bands {
        &self.bands
    }

    /// Where rays are sought.
    #[must_use]
    pub fn surfaces(&self) -> &Surfaces {
        &self.surfaces
    }

    /// The material of a surface.
    #[must_use]
    pub fn material(&self, surface: usize) -> &dyn Material {
        self.materials[surface].as_ref()
    }

    /// The point of a surface at a crossing, with texture coordinates where its material has to do with them.
    #[must_use]
    pub fn surface_point(&self, surface: usize, ray: &Ray, crossing: &Crossing) -> SurfacePoint {
        let shape = &self.surfaces.shapes()[surface];
        if self.materials[surface].converts() {
            shape.surface(ray, crossing)
        } else {
            shape.plain_surface(ray, crossing)
        }
    }

    /// Whether any material asks for a band of which a path is the path: not where all are diffuse.
    #[must_use]
    pub fn chooses_bands(&self) -> bool {
        self.chooses_bands
    }

    /// The emission of a surface.
    #[must_use]
    pub fn emission(&self, surface: usize) -> Option<&Emission> {
        self.emissions[surface].as_deref()
    }

    /// All lights: those without a surface, then those of surfaces.
    #[must_use]
    pub fn lights(&self) -> &[Arc<dyn Light>] {
        &self.lights
    }

    /// The light that a surface is, if it emits and is bounded.
    #[must_use]
    pub fn light_of_surface(&self, surface: usize) -> Option<usize> {
        self.light_of_surface[surface]
    }

    /// The surface that a light is.
    #[must_use]
    pub fn surface_of_light(&self, light: usize) -> Option<usize> {
        self.surface_of_light[light]
    }

    /// The box of all bounded surfaces.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.surfaces.bounds()
    }

    /// A bound on the rounding of a position near `position`, m: a few units in the last place of the scene's coordinates.
    #[must_use]
    pub fn rounding_at(&self, position: DVec3) -> f64 {
        8.0 * f64::EPSILON * position.abs().max_element()
    }
}
