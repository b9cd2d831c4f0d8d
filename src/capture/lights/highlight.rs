//! The image of a lamp in a mirror ball, and where the lamp was.

use glam::{DMat3, DVec2, DVec3};

use super::outline::Outline;
use super::view::{Ball, Ray, View};
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
    /// Where the lamp itself stands in the picture before the ball, pixels: the brightest spot, which is no image of it.
    pub lamp: Option<DVec2>,
    /// Spots that go on beyond the edge of the ball, and are therefore nothing that it mirrors.
    pub crossing: usize,
}

/// Finds the image of the lamp: the connected pixels with most flux among those that are saturated, or above half of the brightest.
///
/// What is mirrored ends at the edge of the ball: spots that go on beyond it are left out. A lamp that stands in the picture before the ball is
/// brighter than its image: the brightest spot is the lamp itself where the ray of its pixel meets the reflected ray of a smaller one, before
/// the ball, and where the sizes of both are as the ball would have them; that other one is taken then.
///
/// # Errors
/// [`Error::Highlight`] where nothing stands out, or nothing that is mirrored.
pub fn find(name: &str, photo: &Photo, outline: &Outline, view: &View, ball: &Ball) -> Result<Highlight, Error> {
    let none = |why: String| Error::Highlight { name: name.to_owned(), why };
    let mut luma = photo.luma();
    // Samples beyond what half floats hold are as bright as the brightest that is held; what is no number is dark.
    let top = luma.iter().copied().filter(|v| v.is_finite()).fold(0.0, f32::max);
    luma.iter_mut().filter(|v| !v.is_finite()).for_each(|v| *v = if *v == f32::INFINITY { top } else { 0.0 });
    let width = photo.width;
    let place = |i: usize| DVec2::new((i % width) as f64, (i / width) as f64);
    let inside: Vec<usize> = (0..luma.len()).filter(|i| outline.holds(place(*i), MARGIN)).collect();
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
    let where_is = |i: usize| match place(i) {
        p if outline.holds(p, MARGIN) => Where::Inside,
        p if outline.holds(p, -MARGIN) => Where::Edge,
        _ => Where::Outside,
    };
    let mut all = spots(&luma, width, &inside, threshold, &where_is);
    all.sort_by(|a, b| b.flux.total_cmp(&a.flux));
    let largest = all.iter().map(|s| s.pixels).max().unwrap_or(0) as f64 / inside.len() as f64;
    let (crossing, spots): (Vec<Spot>, Vec<Spot>) = all.into_iter().partition(|s| s.outside > 0);
    let Some(brightest) = spots.first() else {
        return Err(none(if largest > LARGEST {
            large(largest)
        } else {
            "its brightest part goes on beyond the edge of the ball: a lamp in the picture, and no image of one"
                .to_owned()
        }));
    };
    let image = spots[1..].iter().take(MOST_IMAGES).find(|s| is_mirrored(view, ball, brightest, s));
    let (taken, lamp) = image.map_or((brightest, None), |image| (image, Some(brightest.place())));
    let part = taken.pixels as f64 / inside.len() as f64;
    if part > LARGEST {
        return Err(none(large(part)));
    }
    let not_it = |s: &&Spot| s.place() != taken.place() && Some(s.place()) != lamp;
    let others = spots.iter().filter(not_it).filter(|s| s.flux >= OTHER * taken.flux).count();
    Ok(Highlight { pixel: taken.place(), pixels: taken.pixels, others, lamp, crossing: crossing.len() })
}

fn large(part: f64) -> String {
    format!("its brightest part covers {:.0} % of the ball; a lamp is small", 100.0 * part)
}

/// Spots among which the image of a lamp is looked for, the brightest first.
const MOST_IMAGES: usize = 20;
/// Turns of the reflected ray per pixel by which it may miss the ray of the lamp itself.
const MISS: f64 = 3.0;
/// How many times as many pixels as it should an image may have, or as few: glare, and cells of a grid.
const SIZE: f64 = 8.0;

/// Whether a spot is the mirror image of a lamp that is seen itself, too.
fn is_mirrored(view: &View, ball: &Ball, lamp: &Spot, image: &Spot) -> bool {
    let found = || {
        let (direct, turn) = (view.ray(lamp.place())?, ball.turn_per_pixel(view, image.place())?);
        let reflected = ball.reflected(view.ray(image.place())?)?;
        // Where the rays come nearest to one another.
        let (apart, cos) = (reflected.origin - direct.origin, direct.towards.dot(reflected.towards));
        let sin2 = 1.0 - cos * cos;
        let along = (apart.dot(direct.towards) - cos * apart.dot(reflected.towards)) / sin2;
        let away = (cos * apart.dot(direct.towards) - apart.dot(reflected.towards)) / sin2;
        let point = direct.origin + along * direct.towards;
        let miss = point.distance(reflected.origin + away * reflected.towards);
        let before = view.camera.is_none() || along > 0.0;
        let seen =
            (point - ball.centre).length() > ball.radius && (point - ball.centre).dot(view.back(ball.centre)) > 0.0;
        // A pixel's width at the lamp, and how many pixels of the image that is.
        let beside = |x: f64| Some(view.ray(lamp.place() + DVec2::new(x, 0.0))?.at(along));
        let wide = beside(0.5)?.distance(beside(-0.5)?);
        let expected = lamp.pixels as f64 * (wide / (away * turn)).powi(2);
        let sizes = (image.pixels as f64) < SIZE * expected.max(1.0) && image.pixels as f64 > expected / SIZE;
        Some(before && seen && away > 0.0 && sin2 > 1e-12 && miss <= MISS * turn * away && sizes)
    };
    image.pixels < lamp.pixels && found().unwrap_or(false)
}

/// Where a pixel is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Where {
    Inside,
    Edge,
    Outside,
}

struct Spot {
    /// Of the pixels inside of the ball, as the next two.
    flux: f64,
    moment: DVec2,
    pixels: usize,
    /// Pixels beyond the edge of the ball.
    outside: usize,
}

impl Spot {
    fn place(&self) -> DVec2 {
        self.moment / self.flux
    }
}

/// Connected pixels (eight neighbours) from a threshold on that begin at one of those inside.
fn spots(luma: &[f32], width: usize, inside: &[usize], threshold: f32, where_is: &dyn Fn(usize) -> Where) -> Vec<Spot> {
    let mut open: Vec<bool> = luma.iter().map(|v| *v >= threshold).collect();
    let mut spots = Vec::new();
    let mut stack = Vec::new();
    for first in inside {
        if !std::mem::take(&mut open[*first]) {
            continue;
        }
        let mut spot = Spot { flux: 0.0, moment: DVec2::ZERO, pixels: 0, outside: 0 };
        stack.push(*first);
        while let Some(i) = stack.pop() {
            let (x, y) = (i % width, i / width);
            match where_is(i) {
                Where::Inside => {
                    let value = f64::from(luma[i]);
                    spot.flux += value;
                    spot.moment += DVec2::new(x as f64, y as f64) * value;
                    spot.pixels += 1;
                }
                Where::Edge => {}
                Where::Outside => spot.outside += 1,
            }
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
        let view = View::new(None).unwrap();
        let ball = view.ball(&outline, None).unwrap();
        let find = |photo: &Photo| find("a", photo, &outline, &view, &ball);
        let found = find(&photo(lamp)).unwrap();
        // A lone pixel has a sixth of the six's flux: no other lamp.
        let expected = Highlight { pixel: DVec2::new(21.0, 35.5), pixels: 6, others: 0, lamp: None, crossing: 0 };
        assert_eq!(found, expected);
        let message = |value: u8| find(&photo(|_, _| value)).unwrap_err().to_string();
        assert!(message(0).contains("its ball is dark"), "{}", message(0));
        assert!(message(255).contains("does not stand out"), "{}", message(255));
        let window = find(&photo(|x, _| if x < 16 { 255 } else { 0 })).unwrap_err().to_string();
        assert!(window.contains("a lamp is small"), "{window}");
        // What crosses the edge of the ball is not in it; what is in it is taken, however small.
        let beside = |x: usize, y: usize| (27..33).contains(&x) && y < 8;
        let only = find(&photo(|x, y| if beside(x, y) { 255 } else { 0 })).unwrap_err().to_string();
        assert!(only.contains("goes on beyond the edge"), "{only}");
        let found = find(&photo(|x, y| if beside(x, y) || (x, y) == (25, 40) { 255 } else { 0 })).unwrap();
        assert_eq!((found.pixel, found.crossing), (DVec2::new(25.0, 40.0), 1));
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
