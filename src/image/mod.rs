//! Images, spectral and in colours: planes with named channels and units, streamed to photometry in bounded memory.
//!
//! - [`Description`]: what an image is, without its pixels: size, [`Channel`]s with units, what the bands are of, attributes.
//! - [`Source`]: pixels by [`Region`]; never the whole image. Readers are sources, and so is everything that is done to an
//!   image: [`Converted`] is one around another. A writer pulls rows from the last of them, and that is the whole pipeline.
//! - [`Target`], [`Plan`]: luminance, XYZ, RGB and other weightings of the bands, under the integration contract of
//!   [`crate::spectrum::integrate`].
//! - [`tristimulus`]: the same from RGB, XYZ and luminance. [`Toned`]: tone mapping, the last step before a picture.
//! - [`format`](mod@format): EXR, spectral and RGB; ENVI, band stacks, NPY; Radiance, PNG, JPEG, TIFF; one folder or file per format.
//!
//! # Order of samples
//! Everywhere rows run from the top, and within a row the channels follow one another, each with its pixels from the left
//! ("band-interleaved by line"): sample (x, y, channel c) of a region stands at `(y·channels + c)·width + x`.
//!
//! Pixels are `f32`, as cameras and renderers deliver them; weights and sums are `f64` ([`kernel`]).

pub mod beside;
pub mod compare;
pub mod converted;
pub mod description;
pub mod error;
pub mod format;
pub mod kernel;
pub mod memory;
pub mod photometric;
pub mod plan;
pub mod probe;
pub mod reduced;
pub mod shrink;
pub mod source;
pub mod statistics;
pub mod target;
pub mod tone;
pub mod tristimulus;

pub use beside::Beside;
pub use converted::Converted;
pub use description::{Channel, Content, Description, Meaning, RgbSpace};
pub use error::{Error, ErrorKind};
pub use memory::Memory;
pub use photometric::Photometric;
pub use plan::{Plan, PlanError, Settings};
pub use reduced::Reduced;
pub use shrink::Picture;
pub use source::{Region, Source};
pub use statistics::Statistics;
pub use target::Target;
pub use tone::Toned;
