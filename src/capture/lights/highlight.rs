//! The image of a lamp in a mirror ball, and where the lamp was.

use glam::{DMat3, DVec2, DVec3};

use super::outline::Outline;
use super::view::Ray;
use crate::capture::{Error, Photo};

/// Margin at the edge of a ball in which nothing is taken for a lamp, parts of the radius: all surroundings are crowded there.
const MARGIN: f64 = 0.02;
/// Luma from which on an 8-bit photograph is saturated.
const SATURATED: f32 = 250.0;
/// Luma below which nothing is a lamp: of codes, 0 to 255.
const LEAST: f32 = 64.0;
/// A lamp is so many times as bright as half of the ball.
const CONTRAST: f32 = 8.0;
/// Largest part of the disc that a lamp covers.
const LARGEST: f64 = 0.05;
/// Part of the brightest spot's flux from which on another one is told.
const OTHER: f64 = 0.2;

/// The brightest spot in a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Highlight {
    /// Its centre, weighted by brightness, pixels.
    pub pixel: DVec2,
    /// Pixels in it.
    pub pixels: usize,
    /// Other spots of a fifth of its flux or more.
    pub others: usize,
}

/// Finds the lamp: the connected pixels with most flux among those that are saturated, or above half of the brightest.
///
/// # Errors
/// [`Error::Highlight`] where nothing stands out.
pub fn find(name: &str, photo: &Photo, outline: &Outline) -> Result<Highlight, Error> {
    let none = |why: String| Error::Highlight { name: name.to_owned(), why };
    let luma = photo.luma();
    let width = photo.width;
    let inside: Vec<usize> = (0..luma.len())
        .filter(|i| outline.holds(DVec2::new((i % width) as f64, (i / width) as f64), MARGIN) && luma[*i].is_finite())
        .collect();
    if inside.is_empty() {
        return Err(none("the ball is outside of it".to_owned()));
    }
    let mut sorted: Vec<f32> = inside.iter().map(|i| luma[*i]).collect();
    let half = sorted.len() / 2;
    let median = *sorted.select_nth_unstable_by(half, f32::total_cmp).1;
    let most = inside.iter().map(|i| luma[*i]).fold(0.0, f32::max);
    if most <= 0.0 || (!photo.is_linear() && most < LEAST) {
        return Err(none(format!("its ball is dark (brightest code {most:.0}); was the light on?")));
    }
    if most < CONTRAST * median {
        return Err(none(format!(
            "the brightest part of its ball ({most:.0}) does not stand out from half of it ({median:.0}); is it a mirror?"
        )));
    }
    let threshold = if photo.is_linear() || most < SATURATED { 0.5 * most } else { SATURATED };
    let mut spots = spots(&luma, width, &inside, threshold);
    spots.sort_by(|a, b| b.flux.total_cmp(&a.flux));
    let first = &spots[0];
    let part = first.pixels as f64 / inside.len() as f64;
    if part > LARGEST {
        return Err(none(format!("its brightest part covers {:.0} % of the ball; a lamp is small", 100.0 * part)));
    }
    let others = spots[1..].iter().filter(|s| s.flux >= OTHER * first.flux).count();
    Ok(Highlight { pixel: first.moment / first.flux, pixels: first.pixels, others })
}

struct Spot {
    flux: f64,
    moment: DVec2,
    pixels: usize,
}

/// Connected pixels (eight neighbours) from a threshold on.
fn spots(luma: &[f32], width: usize, inside: &[usize], threshold: f32) -> Vec<Spot> {
    let mut open = vec![false; luma.len()];
    inside.iter().filter(|i| luma[**i] >= threshold).for_each(|i| open[*i] = true);
    let mut spots = Vec::new();
    let mut stack = Vec::new();
    for first in inside {
        if !std::mem::take(&mut open[*first]) {
            continue;
        }
        let mut spot = Spot { flux: 0.0, moment: DVec2::ZERO, pixels: 0 };
        stack.push(*first);
        while let Some(i) = stack.pop() {
            let (x, y) = (i % width, i / width);
            let value = f64::from(luma[i]);
            spot.flux += value;
            spot.moment += DVec2::new(x as f64, y as f64) * value;
            spot.pixels += 1;
            for near_y in y.saturating_sub(1)..=y + 1 {
                for near_x in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                    let near = near_y * width + near_x;
                    if open.get(near).copied().unwrap_or(false) {
                        open[near] = false;
                        stack.push(near);
                    }
                }
            }
        }
        spots.push(spot);
    }
    spots
}

/// The mean direction of reflected rays: the place of a distant light.
#[must_use]
pub fn direction(rays: &[Ray]) -> Option<DVec3> {
    rays.iter().map(|r| r.towards).sum::<DVec3>().try_normalize()
}

/// The point with the least sum of squared distances from two or more rays; `None` where it is behind one of them, or the rays meet
/// under less than `least_rad`, so that it would be a guess.
#[must_use]
pub fn position(rays: &[Ray], least_rad: f64) -> Option<DVec3> {
    let crossing = |a: &Ray, b: &Ray| super::angle_deg(a.towards, b.towards).to_radians();
    let widest = rays.iter().flat_map(|a| rays.iter().map(move |b| crossing(a, b))).fold(0.0, f64::max);
    if widest < least_rad || widest <= 0.0 {
        return None;
    }
    let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for ray in rays {
        let d = ray.towards;
        let across = DMat3::IDENTITY - DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        normal += across;
        right += across * ray.origin;
    }
    let point = normal.inverse() * right;
    (point.is_finite() && rays.iter().all(|r| (point - r.origin).dot(r.towards) > 0.0)).then_some(point)
}

/// The point of a ray at a distance from `centre`; `None` for a distance that does not reach the ray's origin.
#[must_use]
pub fn at_distance(ray: &Ray, centre: DVec3, distance: f64) -> Option<DVec3> {
    let from = ray.origin - centre;
    let along = from.dot(ray.towards);
    let root = along * along - from.length_squared() + distance * distance;
    let s = root.max(0.0).sqrt() - along;
    (root >= 0.0 && s > 0.0).then(|| ray.origin + s * ray.towards)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::photo::Codes;

    fn photo(spot: impl Fn(usize, usize) -> u8) -> Photo {
        Photo {
            width: 60,
            height: 60,
            channels: 1,
            codes: Codes::Eight((0..3600).map(|i| spot(i % 60, i / 60)).collect()),
        }
    }

    #[test]
    fn the_lamp_is_found_and_what_is_none_says_why() {
        let outline = Outline::stated([30.0, 30.0, 25.0]);
        let lamp = |x: usize, y: usize| {
            if (20..23).contains(&x) && (35..37).contains(&y) { 255 } else { u8::from((40, 30) == (x, y)) * 252 + 3 }
        };
        let found = find("a", &photo(lamp), &outline).unwrap();
        // A lone pixel has a sixth of the six's flux: no other lamp.
        assert_eq!(found, Highlight { pixel: DVec2::new(21.0, 35.5), pixels: 6, others: 0 });
        let message = |value: u8| find("a", &photo(|_, _| value), &outline).unwrap_err().to_string();
        assert!(message(0).contains("its ball is dark"), "{}", message(0));
        assert!(message(255).contains("does not stand out"), "{}", message(255));
        let window = find("a", &photo(|x, _| if x < 16 { 255 } else { 0 }), &outline).unwrap_err().to_string();
        assert!(window.contains("a lamp is small"), "{window}");
    }

    #[test]
    fn two_rays_tell_a_place_and_parallel_ones_do_not() {
        let lamp = DVec3::new(1.0, 2.0, 3.0);
        let ray = |origin: DVec3| Ray { origin, towards: (lamp - origin).normalize() };
        let rays = [ray(DVec3::ZERO), ray(DVec3::new(0.5, 0.0, 0.0))];
        assert!(position(&rays, 0.01).unwrap().abs_diff_eq(lamp, 1e-12));
        assert!(position(&rays, 0.5).is_none() && position(&rays[..1], 0.0).is_none());
        assert!(direction(&rays[..1]).unwrap().abs_diff_eq(lamp.normalize(), 1e-15));
        let off_centre = at_distance(&rays[1], DVec3::ZERO, lamp.length()).unwrap();
        assert!(off_centre.abs_diff_eq(lamp, 1e-12));
        assert!(at_distance(&rays[1], DVec3::ZERO, 0.1).is_none());
    }
}
