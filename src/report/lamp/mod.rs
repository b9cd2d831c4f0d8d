//! Luminaires as JSON, CSV and text.

mod check;
mod compare;
mod grid;
mod info;
mod spectral;
mod table;
mod tables;
mod text;

pub use check::{check, check_text};
pub use compare::{compare, compare_text};
pub use grid::{grid, grid_key, grid_text};
pub use info::{definitions, info};
pub use spectral::{Context, Source, spectral, spectral_header, spectral_rows, spectral_text};
pub use table::Table;
pub use tables::{cu, cu_text, ugr, ugr_text};
pub use text::info_text;
