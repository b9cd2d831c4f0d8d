//! The renderer against closed forms.

#[path = "../common/mod.rs"]
mod common;

mod analytic;
mod shapes;
mod slab;
