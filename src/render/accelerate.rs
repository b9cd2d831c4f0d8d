//! TEMPORARY linear search.
use super::ray::{Crossing, Ray, SurfacePoint};
use super::shape::{Bounds, Shape};
use std::sync::Arc;
/// e
#[derive(Debug, thiserror::Error)]
pub enum Error {}
/// s
#[derive(Debug, Clone)]
pub enum Surface {
    /// s
    Shape(Arc<dyn Shape>),
}
impl Surface {
    /// s
    pub fn as_shape(&self) -> Arc<dyn Shape> {
        let Self::Shape(s) = self;
        Arc::clone(s)
    }
}
/// s
#[derive(Debug)]
pub struct Surfaces(Vec<Surface>);
impl Surfaces {
    /// s
    pub fn new(s: Vec<Surface>) -> Result<Self, Error> {
        Ok(Self(s))
    }
    /// s
    pub fn closest(&self, ray: &Ray, far: f64) -> Option<(usize, Crossing)> {
        let mut best = None;
        let mut far = far;
        for (i, Surface::Shape(s)) in self.0.iter().enumerate() {
            if let Some(c) = s.cross(ray, 0.0, far) {
                far = c.t;
                best = Some((i, c));
            }
        }
        best
    }
    /// s
    pub fn is_occluded(&self, ray: &Ray, far: f64, ignore: Option<usize>) -> bool {
        self.0.iter().enumerate().any(|(i, Surface::Shape(s))| Some(i) != ignore && s.cross(ray, 0.0, far).is_some())
    }
    /// s
    pub fn surface_point(&self, i: usize, ray: &Ray, c: &Crossing) -> SurfacePoint {
        let Surface::Shape(s) = &self.0[i];
        s.surface(ray, c)
    }
    /// s
    pub fn bounds(&self) -> Bounds {
        self.0.iter().fold(Bounds::EMPTY, |b, Surface::Shape(s)| b.union(s.bounds()))
    }
}
