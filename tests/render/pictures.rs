//! What tests of pictures have in common.

use photopic::render::build::{Built, Kind, NoFiles, build};
use photopic::render::description::Description;
use photopic::render::sensor::camera::Camera;

pub fn built(text: &str) -> Built {
    let description = Description::parse(text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    build(text, &description, &NoFiles).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

pub fn camera(built: &Built) -> &Camera {
    let found = built.instruments.iter().find_map(|i| match &i.kind {
        Kind::Camera(camera) => Some(camera),
        _ => None,
    });
    found.expect("a camera")
}

/// Mean and standard error of independent numbers.
pub fn figure(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt())
}
