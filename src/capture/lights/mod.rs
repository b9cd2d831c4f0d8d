//! Where the lights were, from photographs of balls.
//!
//! ```text
//! r = v − 2 (v·n) n      ray v of the camera, normal n of the mirror ball: the light lies on P + s r
//! z = b + a max(0, n·l)  code z of a diffuse ball under a distant light l
//! ```
//!
//! - [`view`]: rays of pixels, stated camera or parallel ones, and where they meet a ball.
//! - [`outline`]: the circle of a ball from its mask or in a photograph.
//! - [`highlight`]: the lamp in a mirror ball, and from it a direction or, with two balls or a distance, a place.
//! - [`shading`]: directions from a diffuse ball, and how far they hang on what is assumed of its surface and of the codes.
//! - [`adjust`]: balls, lights and camera at once, and how far the observations disagree.
//! - [`list`]: lists of directions made elsewhere, compared with what the photographs show.
//! - [`environment`]: the surroundings in a mirror ball as an equirectangular picture.
//!
//! Without a camera the rays are parallel, lengths are pixels, and directions are those of photometric stereo: x to the right, y upwards,
//! z towards the camera.

pub mod adjust;
pub mod environment;
pub mod highlight;
pub mod list;
pub mod outline;
pub mod shading;
pub mod view;

/// The angle between two directions of any length, degrees; well conditioned also where they are nearly alike.
#[must_use]
pub fn angle_deg(a: glam::DVec3, b: glam::DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}
