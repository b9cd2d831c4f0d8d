#![doc = include_str!("../README.md")]
#![warn(missing_docs)]

pub mod constants;
pub mod finding;
pub mod math;
pub mod spectrum;
