//! The renderer against closed forms.

#[path = "../common/mod.rs"]
mod common;

mod analytic;
mod audits;
mod bidirectional;
mod cli;
mod denoise;
mod endless;
mod files;
mod guiding;
mod honest;
mod instruments;
mod keys;
mod knobs;
mod lights;
mod measured;
mod meshes;
mod meters_from_lights;
mod mistakes;
mod packets;
mod pictures;
mod radiosity;
mod reflectometer;
mod scenes;
mod shapes;
mod slab;
mod trade;
mod virtual_lights;
