//! From photographs of known geometry to what they measure: the camera, its response, radiance.
//!
//! - [`manifest`]: what was photographed, in TOML; [`photo`]: the codes of a photograph and when it says it was exposed; [`rows`]: the
//!   same by rows.
//! - [`response`]: the curve from code to exposure, from stacks of photographs of one scene at several times.
//! - [`noise`]: the standard error of a code; [`flat`]: vignetting from an evenly lit field.
//! - [`merge`]: such a stack into linear radiance with its standard error and a mask.
//! - [`camera`]: intrinsics and distortion from views of a chessboard.
//! - [`lamp`]: lamps of which a photometric file tells the intensities; [`lights`]: where the lights were, from mirror balls and diffuse ones.
//! - [`setup`]: camera, sphere and lights of a manifest; [`radiance`]: photographs in linear radiance; [`brdf`]: what a sphere reflects.
//!
//! # Conventions
//! - *Code*: what the file stores; here always scaled to 0–255, also between whole numbers for 16-bit files.
//! - *Exposure* (of a pixel): radiance times time, up to one factor per channel; ln g(z) is its logarithm at code z.
//! - Pixel (0, 0) has its centre at image coordinates (0, 0), as in OpenCV: x to the right, y downwards.
//! - Photographs run in rows from the top, channels interleaved: sample (x, y, c) stands at `(y·width + x)·channels + c`.

pub mod brdf;
pub mod camera;
pub mod error;
pub mod flat;
pub mod lamp;
pub mod lights;
pub mod manifest;
pub mod merge;
pub mod noise;
pub mod photo;
pub mod radiance;
pub mod response;
pub mod rows;
pub mod setup;

pub use error::Error;
pub use manifest::Manifest;
pub use photo::Photo;
