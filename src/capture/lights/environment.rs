//! The surroundings in a mirror ball, as an equirectangular picture of radiance by direction.
//!
//! The middle of the picture looks along the camera's forward direction and its upper edge is the camera's up: columns are in proportion to
//! the azimuth, growing to the right, rows to the angle to up. With `look` and `up` of the camera the renderer takes it as an environment.
//!
//! All directions around that from the camera to the ball are crowded at the ball's edge; those whose normals are further than 84° from the
//! camera are taken from there and marked: channel `seen` is 0 (about 1 % of the sphere). Surroundings are taken as far away.
//!
//! Reference: G. S. Miller and C. R. Hoffman, *Illumination and Reflection Maps*, SIGGRAPH 84 course notes.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::view::{Ball, View};
use crate::capture::radiance::Radiance;
use crate::image::{Channel, Description, Meaning, Memory};

/// Least cosine between normal and camera.
const EDGE: f64 = 0.1;
/// Places along each side of a pixel that are averaged.
const PLACES: usize = 2;

/// A picture of `width` × `width`/2 pixels; radiances are those of the ball over its reflectance.
///
/// # Panics
/// For a width below 2.
#[must_use]
pub fn equirectangular(view: &View, ball: &Ball, picture: &Radiance, reflectance: f64, width: usize) -> Memory {
    let height = width / 2;
    let names: &[&str] = if picture.channels == 1 { &["Y"] } else { &["R", "G", "B"] };
    let mut channels: Vec<Channel> = names.iter().map(|n| Channel::new(*n, "", Meaning::Other)).collect();
    channels.push(Channel::new("seen", "", Meaning::Other));
    let count = channels.len();
    let mut samples = vec![0.0_f32; width * height * count];
    let axes = view.axes();
    let (right, up, forward) = (axes.x_axis, -axes.y_axis, axes.z_axis);
    samples.par_chunks_exact_mut(width * count).enumerate().for_each(|(y, row)| {
        let mut sum = vec![0.0; count];
        for x in 0..width {
            sum.fill(0.0);
            for place in 0..PLACES * PLACES {
                let sub = |k: usize| (k as f64 + 0.5) / PLACES as f64;
                let azimuth = ((x as f64 + sub(place % PLACES)) / width as f64 - 0.5) * TAU;
                let theta = (y as f64 + sub(place / PLACES)) / height as f64 * PI;
                let level = azimuth.cos() * forward + azimuth.sin() * right;
                let direction = theta.sin() * level + theta.cos() * up;
                let (pixel, seen) = place_of(view, ball, direction);
                sum[count - 1] += f64::from(u8::from(seen));
                for (c, s) in sum[..count - 1].iter_mut().enumerate() {
                    *s += sample(picture, pixel, c) / (reflectance * picture.time_s);
                }
            }
            #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
            for (c, s) in sum.iter().enumerate() {
                row[c * width + x] = (s / (PLACES * PLACES) as f64) as f32;
            }
        }
    });
    Memory::new(Description::planes(width, height, channels), samples)
}

/// Where a ball shows a far direction, and whether it can be told there.
fn place_of(view: &View, ball: &Ball, direction: DVec3) -> (DVec2, bool) {
    let mut back = view.back(ball.centre);
    let mut normal = back;
    let mut seen = true;
    // The normal halves the way between light and camera, whose direction changes a little over the ball.
    for _ in 0..6 {
        normal = (direction + back).try_normalize().unwrap_or(view.axes().x_axis);
        let cos = normal.dot(back);
        seen = cos >= EDGE;
        if !seen {
            let across = (normal - cos * back).try_normalize().unwrap_or(view.axes().x_axis);
            normal = EDGE * back + (1.0 - EDGE * EDGE).sqrt() * across;
        }
        back = view.back(ball.centre + ball.radius * normal);
    }
    (view.pixel(ball.centre + ball.radius * normal), seen)
}

/// A sample between pixels, linear in both directions; the border continues.
fn sample(picture: &Radiance, at: DVec2, channel: usize) -> f64 {
    let (w, h) = (picture.width, picture.height);
    let (x, y) = (at.x.clamp(0.0, (w - 1) as f64), at.y.clamp(0.0, (h - 1) as f64));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the picture")]
    let (i, j) = (x as usize, y as usize);
    let (s, t) = (x - i as f64, y - j as f64);
    let value =
        |i: usize, j: usize| f64::from(picture.values[(j.min(h - 1) * w + i.min(w - 1)) * picture.channels + channel]);
    (1.0 - t) * ((1.0 - s) * value(i, j) + s * value(i + 1, j))
        + t * ((1.0 - s) * value(i, j + 1) + s * value(i + 1, j + 1))
}
