//! Directions and solid angles, and the conventions that the whole crate keeps.
//!
//! - Directions point **away** from the surface: ω_i towards the light, ω_o towards the observer. A BRDF is in 1/sr and has
//!   **no** cosine in it.
//! - At a surface, directions stand in its local frame: +z is the normal, +x the direction (grain, brushing) that an
//!   anisotropic material is turned by, φ counts from +x towards +y.
//! - θ is the angle to the surface normal; a luminaire's γ is measured from its downward axis, C about it (C0 towards +x,
//!   C90 towards +y).
//! - A solid angle is area over distance squared, in steradians: 4π for the whole sphere. (Some lecture notes mean a/4π, which
//!   is a fraction of the sphere.) A *projected* solid angle carries cosθ to the receiver's normal: π for the hemisphere.
//! - Lengths are in metres, angles in radians unless a name says `_deg`.

pub mod direction;
pub mod lens;
pub mod solid_angle;
