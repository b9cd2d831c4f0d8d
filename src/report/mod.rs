//! Results as JSON, CSV, text and HTML: the only writer of result JSON.
//!
//! Keys and their order are those of `docs/json.md`; they end in their unit, a figure that does not apply is absent, one that
//! could not be determined is `null` beside a finding that says why.

pub mod brdf;
pub mod brdf_compress;
pub mod brdf_fit;
pub mod capture;
pub mod capture_brdf;
pub mod capture_develop;
pub mod capture_lights;
pub mod capture_page;
pub mod compare;
pub mod conversion;
pub mod conversion_page;
pub mod correction;
pub mod csv;
pub mod detector;
pub mod envelope;
pub mod flicker;
pub mod html;
pub mod image;
pub mod lamp;
pub mod render;
pub mod render_audit;
pub mod require;
pub mod selfcheck;
pub mod text;
pub mod trade;
pub mod uncertainty;
