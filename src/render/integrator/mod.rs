//! Solvers of the rendering equation.
//!
//! ```text
//! L_o(x, ω_o) = L_e(x, ω_o) + ∫ f_s(ω_i, ω_o) L_i(x, ω_i) |cosθ_i| dω_i
//! ```
//!
//! Reference: J. T. Kajiya, *The Rendering Equation*, SIGGRAPH 1986.

pub mod bidirectional;
pub mod frame;
pub mod guide;
pub mod light;
pub mod limits;
pub mod packet;
pub mod path;
pub mod polarisation;
pub mod virtual_lights;
pub mod waiting;
