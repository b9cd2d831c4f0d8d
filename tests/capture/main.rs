//! `capture`: the camera, its response and merging, against OpenCV's figures, closed forms and synthetic pictures.

#[path = "../common/mod.rs"]
mod common;

mod brdf;
mod camera;
mod cli;
mod lights;
mod photographs;
mod rendered;
mod response;
mod shapes;
mod spectral;
mod spheres;
mod trade;
