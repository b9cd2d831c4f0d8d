//! The renderer against closed forms.

#[path = "../common/mod.rs"]
mod common;

mod analytic;
mod cli;
mod files;
mod honest;
mod lights;
mod meshes;
mod packets;
mod shapes;
mod slab;
