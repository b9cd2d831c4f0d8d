//! Colour of light: observers, chromaticity, colour temperature, dominant wavelength, colour rendition and RGB.
//!
//! Everything that is linear in the spectrum is compiled once per grid into a `Plan` (see
//! [`crate::spectrum::integrate`]); a spectrum then costs dot products.

pub mod adaptation;
pub mod cam02;
pub mod cct;
pub mod chromaticity;
pub mod cri;
pub mod difference;
pub mod dominant;
pub mod iec_60081;
pub mod observer;
pub mod reference;
pub mod rgb;
pub mod samples;
pub mod tm30;
pub mod tolerance;
pub mod whiteness;

pub use observer::Observer;
