//! OpenEXR, with spectra in the layout of Fichet, Pacanowski and Wilkie, "An OpenEXR Layout for Spectral Images", JCGT 10(3),
//! 2021: one channel per wavelength, `S0.550,0nm` for light (`S1`–`S3`: its other Stokes components), `T.550,0nm` for reflectance
//! or transmittance, with the attributes `spectralLayoutVersion`, `emissiveUnits`, `polarisationHandedness`.
//!
//! Read: half, float and unsigned integer samples, scan lines and tiles (the full resolution of mip maps), every compression of
//! the crate `exr`, one part or several. Written: one part, scan lines, ZIP of 16 lines, as every program reads.
//!
//! The layout's units name no wavelength (`W.m^-2.sr^-1`), but the programs that write it store densities per nanometre, and
//! those that read it integrate over wavelength: so does this one, with finding I003.

mod name;
mod read;
mod write;

pub use name::{Name, channel_name, parse_name};
pub use read::{Exr, open};
pub use write::{Depth, write};

use super::super::error::{Error, ErrorKind};

/// The crate's error as one of ours.
fn refused(error: ::exr::error::Error) -> Error {
    use ::exr::error::Error as Exr;
    match error {
        Exr::Io(error) => error.into(),
        Exr::NotSupported(what) => {
            let expected = "flat images of half, float or integer samples".to_owned();
            ErrorKind::Unsupported { found: format!("an OpenEXR file with {what}"), expected }.into()
        }
        Exr::Invalid(what) => {
            let found = format!("a damaged OpenEXR file ({what})");
            ErrorKind::Unexpected { found, expected: "a whole one".to_owned() }.into()
        }
        Exr::Aborted => {
            ErrorKind::Unexpected { found: "an interruption".to_owned(), expected: "none".to_owned() }.into()
        }
    }
}
