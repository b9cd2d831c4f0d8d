//! Numerical tools without units: interpolation kernels, contour lines, order statistics, adaptive cubature, least squares, random
//! numbers and their warps.

pub mod contour;
pub mod cubature;
pub mod fft;
pub mod interpolate;
pub mod least_squares;
pub mod noise;
pub mod order;
pub mod random;
pub mod sampling;
pub mod student;
