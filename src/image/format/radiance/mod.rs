//! Radiance pictures (`.hdr`, `.pic`): three mantissas and an exponent per pixel (G. Ward, "Real Pixels", Graphics Gems II, 1991;
//! *Radiance File Formats*).
//!
//! | header line | here |
//! |---|---|
//! | `#?RADIANCE`, `#?RGBE`, any `#?` | first line; required |
//! | `FORMAT=` | `32-bit_rle_rgbe` (where absent) or `32-bit_rle_xyze` |
//! | `EXPOSURE=` | what samples have been multiplied by; several multiply; divided out |
//! | `COLORCORR=` | the same for red, green and blue (X, Y, Z) |
//! | `PRIMARIES=` | x y of red, green, blue and white; Radiance's own where absent |
//! | `PIXASPECT=` | height over width of a pixel; several multiply; told, as pixels are not resampled |
//! | `-Y 512 +X 768` | size and orientation: all eight are read |
//!
//! Whatever else stands in the header is carried along. Lines that begin with a blank belong to pictures this one was made of.
//!
//! # Units
//! RGB samples, exposure divided out, are radiances in W/(m²·sr) by channel, and 1 of them is 179 cd/m² of white by Radiance's
//! convention ([`LUMENS_PER_WATT`]). XYZ samples, exposure divided out, are in cd/m²: `ra_xyze` writes `EXPOSURE=` 1/179 with
//! values in watts. XYZ follow from RGB by the primaries and the white of the header, as in every other format. Radiance's own
//! programs weigh RGB by their default primaries whatever `PRIMARIES` says (`pvalue -b`), or adapt white to equal energy
//! (`ra_xyze`), which differs by some per cent for saturated colours of other primaries.
//!
//! # Scan lines
//! Plain, run-length encoded as of old (pixels 1 1 1 n), or by component (2 2 and the length). A sample is (m + ½)/256 ·
//! 2^(e − 128), black where e = 0; written are truncated mantissas, as Radiance does.

mod header;
mod read;
mod scan;
mod write;

pub use header::{Header, Orientation, Pixels, parse_header};
pub use read::{Radiance, open};
pub use write::write;

/// Luminous efficacy of Radiance's white, lm/W (`WHTEFFICACY` in `src/common/color.h`).
pub const LUMENS_PER_WATT: f64 = 179.0;
