//! Luminaires as JSON and text.

mod info;
mod tables;

pub use info::{info, info_text};
pub use tables::{cu, rows_text, ugr};
