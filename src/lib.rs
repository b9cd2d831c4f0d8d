#![doc = include_str!("../README.md")]
#![warn(missing_docs)]

pub mod brdf;
pub mod capture;
pub mod cli;
pub mod colorimetry;
pub mod constants;
pub mod conversion;
pub mod correction;
pub mod finding;
pub mod geometry;
pub mod illuminant;
pub mod image;
pub mod luminaire;
pub mod math;
pub mod mistake;
pub mod photometry;
pub mod plot;
pub mod render;
pub mod report;
pub mod selfcheck;
pub mod spectrum;
pub mod tables;
pub mod trade;
pub mod uncertainty;
pub mod units;
