//! Results as JSON, CSV and text: the only writer of result JSON.
//!
//! Keys and their order are those of `docs/json.md`; they end in their unit, a figure that does not apply is absent, one that
//! could not be determined is `null` beside a finding that says why.

pub mod brdf;
pub mod brdf_compress;
pub mod brdf_fit;
pub mod capture;
pub mod capture_brdf;
pub mod compare;
pub mod conversion;
pub mod csv;
pub mod detector;
pub mod envelope;
pub mod image;
pub mod lamp;
pub mod render;
pub mod render_audit;
pub mod text;
pub mod uncertainty;
