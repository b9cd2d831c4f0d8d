//! Numerical tools without units: interpolation kernels and bracketed minimisation.

pub mod interpolate;
pub mod minimise;
