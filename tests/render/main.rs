//! The renderer against closed forms.

#[path = "../common/mod.rs"]
mod common;

mod analytic;
mod cli;
mod files;
mod honest;
mod instruments;
mod lights;
mod meshes;
mod packets;
mod reflectometer;
mod shapes;
mod slab;
