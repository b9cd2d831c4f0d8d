//! The renderer against closed forms.

#[path = "../common/mod.rs"]
mod common;

mod analytic;
mod cli;
mod honest;
mod files;
mod meshes;
mod lights;
mod shapes;
