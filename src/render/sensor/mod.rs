//! Virtual instruments: cameras, and meters that read irradiance, radiance and their relatives at a point.

pub mod camera;
pub mod response;
