//! Numerical tools without units: interpolation kernels, contour lines.

pub mod contour;
pub mod interpolate;
