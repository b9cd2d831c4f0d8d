//! Numerical tools without units: interpolation kernels, contour lines, adaptive cubature, random numbers and their warps.

pub mod contour;
pub mod cubature;
pub mod interpolate;
pub mod random;
pub mod sampling;
