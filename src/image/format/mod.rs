//! Image files; one folder or file per format.

pub mod envi;
pub mod exr;
pub mod npy;
pub mod picture;
pub mod radiance;
pub mod stack;
