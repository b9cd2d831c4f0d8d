//! Numerical tools without units: interpolation kernels.

pub mod interpolate;
