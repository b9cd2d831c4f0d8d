//! Luminaires as JSON, CSV and text.

mod check;
mod info;
mod table;
mod tables;
mod text;

pub use check::{check, check_text};
pub use info::{definitions, info};
pub use table::Table;
pub use tables::{cu, cu_text, ugr, ugr_text};
pub use text::info_text;
