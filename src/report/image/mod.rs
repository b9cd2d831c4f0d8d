//! Images as JSON and text.

mod info;

pub use info::{info, info_text};
