//! Luminaires as JSON and text.

mod compare;
mod info;
mod spectral;
mod tables;

pub use compare::{compare, compare_text};
pub use info::{info, info_text};
pub use spectral::{Context, Source, spectral, spectral_header, spectral_rows, spectral_text};
pub use tables::{cu, rows_text, ugr};
