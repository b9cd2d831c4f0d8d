//! What tests of pictures have in common.

use photopic::image::source::Source;
use photopic::render::build::{Built, Kind, NoFiles, build};
use photopic::render::description::Description;
use photopic::render::film::Film;
use photopic::render::measure::Settings;
use photopic::render::noise::Noise;
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

/// Of the room.
pub const VIEW: &str = r#"
[[sensor]]
name = "view"
camera = { at = [0.1, -2.6, 1.3], look_at = [0, 0, 0.5], resolution = [12, 10], field_of_view = "45 deg" }
"#;

/// A white floor and a red wall.
pub const ROOM: &str = r#"
[[material]]
name = "white"
reflectance = 0.7
[[material]]
name = "red"
reflectance = [[400, 0.1], [600, 0.2], [650, 0.8], [830, 0.8]]
[[shape]]
name = "floor"
material = "white"
rectangle = { corner = [-2, -2, 0], edges = [[4, 0, 0], [0, 4, 0]] }
[[shape]]
material = "red"
rectangle = { corner = [-2, 2, 0], edges = [[4, 0, 0], [0, 0, 3]] }
"#;

/// All channels of all pixels, row by row, and the noise.
pub fn rendered<F: Fn(u64) + Send + Sync>(mut film: Film<'_, F>) -> (Vec<f32>, Noise) {
    let rows: Vec<usize> = (0..film.description().height).collect();
    let (mut noise, mut pixels) = (Noise::default(), Vec::new());
    for (row, samples) in film.rows(&rows) {
        noise.append(&row);
        pixels.extend(samples);
    }
    (pixels, noise)
}

/// All channels of all pixels, row by row, and the noise.
pub fn picture(built: &Built, settings: &Settings, samples: u64) -> (Vec<f32>, Noise) {
    let camera = camera(built);
    let mut film = Film::new(&built.scene, camera, settings, 0, samples, &built.quantities.tristimulus, |_| ());
    film.survey(false);
    rendered(film)
}

/// Means over blocks of the picture of each channel: `blocks` along each side.
pub fn blocks(pixels: &[f32], camera: &Camera, blocks: usize) -> Vec<f64> {
    let (width, height) = (camera.width() as usize, camera.height() as usize);
    let channels = pixels.len() / width / height;
    let mut sums = vec![0.0; channels * blocks * blocks];
    for (place, row) in pixels.chunks_exact(width).enumerate() {
        let (y, channel) = (place / channels, place % channels);
        for (x, value) in row.iter().enumerate() {
            sums[(channel * blocks + y * blocks / height) * blocks + x * blocks / width] += f64::from(*value);
        }
    }
    sums
}
