//! Luminaires as JSON and text.

mod grid;
mod info;
mod tables;

pub use grid::{grid, grid_key, grid_text};
pub use info::{info, info_text};
pub use tables::{cu, rows_text, ugr};
