//! Luminaires as JSON and text.

mod compare;
mod info;
mod tables;

pub use compare::{compare, compare_text};
pub use info::{info, info_text};
pub use tables::{cu, rows_text, ugr};
