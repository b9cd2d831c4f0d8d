//! The outline of a ball in a picture: a circle, from its mask or from the brightness around it.

use glam::{DMat3, DVec2, DVec3};

use crate::capture::Error;

/// Directions in which an edge is sought.
const SPOKES: u32 = 180;
/// How far from the expected radius an edge is sought, parts of it.
const REACH: f64 = 0.15;
/// Least part of the spokes whose edges lie on one circle.
const LEAST_FOUND: f64 = 0.4;
/// Part of the greatest brightness along a spoke that the fall over an edge has.
const PART: f64 = 0.2;
/// Pixels from the circle beyond which a point is none of it.
const OFF: f64 = 1.5;
/// Least radius, pixels, that tells anything.
const LEAST_RADIUS: f64 = 4.0;

/// A circle fitted to points.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Its middle, pixels.
    pub centre: DVec2,
    /// Its radius, pixels.
    pub radius: f64,
    /// Rms distance of the points from it, pixels.
    pub rms: f64,
    /// The points.
    pub points: Vec<DVec2>,
}

impl Outline {
    /// The circle of least squared distances through points (Gauss-Newton from the algebraic fit); `None` for points on a line.
    #[must_use]
    pub fn through(points: Vec<DVec2>) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let middle = points.iter().sum::<DVec2>() / points.len() as f64;
        let solve = |rows: &mut dyn Iterator<Item = (DVec3, f64)>| {
            let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
            for (row, value) in rows {
                normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
                right += row * value;
            }
            Some(normal.inverse() * right).filter(|v| v.is_finite())
        };
        // |p|² = 2 c·p + k, k = r² − |c|².
        let start = solve(&mut points.iter().map(|p| {
            let p = *p - middle;
            (DVec3::new(2.0 * p.x, 2.0 * p.y, 1.0), p.length_squared())
        }))?;
        let mut centre = start.truncate();
        let mut radius = (start.z + centre.length_squared()).sqrt();
        for _ in 0..20 {
            let step = solve(&mut points.iter().map(|p| {
                let away = *p - middle - centre;
                let distance = away.length();
                (DVec3::new(away.x / distance, away.y / distance, 1.0), distance - radius)
            }))?;
            centre += step.truncate();
            radius += step.z;
            if step.length() < 1e-10 * radius {
                break;
            }
        }
        let centre = centre + middle;
        let squares: f64 = points.iter().map(|p| (p.distance(centre) - radius).powi(2)).sum();
        let rms = (squares / points.len() as f64).sqrt();
        (rms.is_finite() && radius > 0.0).then_some(Self { centre, radius, rms, points })
    }

    /// A circle that is stated.
    #[must_use]
    pub fn stated([x, y, radius]: [f64; 3]) -> Self {
        let centre = DVec2::new(x, y);
        let at = |k: u32| centre + DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(SPOKES)) * radius;
        Self { centre, radius, rms: 0.0, points: (0..SPOKES).map(at).collect() }
    }

    /// That of a mask in rows of `width`: the circle through the middles between pixels inside and outside, without those beside it.
    ///
    /// # Errors
    /// [`Error::Setup`] for a mask without a disc.
    pub fn of_mask(mask: &[bool], width: usize) -> Result<Self, Error> {
        let none = |found: &str| Error::Setup {
            found: found.to_owned(),
            expected: "a mask that is bright where the ball is and dark around it",
        };
        let (inside, height) = (mask.iter().filter(|m| **m).count(), mask.len() / width.max(1));
        if inside == 0 || inside == mask.len() {
            return Err(none(if inside == 0 {
                "a mask that is dark all over"
            } else {
                "a mask that is bright all over"
            }));
        }
        let mut points = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let here = mask[y * width + x];
                let (fx, fy) = (x as f64, y as f64);
                if x + 1 < width && mask[y * width + x + 1] != here {
                    points.push(DVec2::new(fx + 0.5, fy));
                }
                if y + 1 < height && mask[(y + 1) * width + x] != here {
                    points.push(DVec2::new(fx, fy + 0.5));
                }
            }
        }
        let outline = trimmed(points).ok_or_else(|| none("a mask without a round edge"))?;
        if outline.radius < LEAST_RADIUS || outline.rms > OFF {
            return Err(none("a mask that is no disc"));
        }
        Ok(outline)
    }

    /// That of a bright ball before a dark background: of the pixels above the threshold that parts them best (Otsu 1979), refined.
    #[must_use]
    pub fn of_photo(luma: &[f32], width: usize) -> Option<Self> {
        let threshold = otsu(luma)?;
        let mask: Vec<bool> = luma.iter().map(|v| *v > threshold).collect();
        let outline = Self::of_mask(&mask, width).ok()?;
        Self::refined(luma, width, &outline)
    }

    /// The circle through the steepest places along spokes about an expected one; `None` unless 40 % of them lie on one circle.
    #[must_use]
    pub fn refined(luma: &[f32], width: usize, expected: &Self) -> Option<Self> {
        let height = luma.len() / width.max(1);
        let at = |p: DVec2| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "tested to be within the picture"
            )]
            let inside = (p.x >= 0.0 && p.y >= 0.0 && p.x < width as f64 - 1.0 && p.y < height as f64 - 1.0)
                .then_some((p.x as usize, p.y as usize));
            inside.map(|(x, y)| {
                let (s, t) = (p.x - x as f64, p.y - y as f64);
                let pixel = |x: usize, y: usize| f64::from(luma[y * width + x]);
                (1.0 - t) * ((1.0 - s) * pixel(x, y) + s * pixel(x + 1, y))
                    + t * ((1.0 - s) * pixel(x, y + 1) + s * pixel(x + 1, y + 1))
            })
        };
        let reach = (REACH * expected.radius).max(3.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few pixels")]
        let steps = (4.0 * reach) as u32;
        let mut points = Vec::new();
        for k in 0..SPOKES {
            let out = DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(SPOKES));
            let place = |i: u32| expected.centre + out * (expected.radius - reach + 0.5 * f64::from(i));
            // The fall over a pixel, outwards.
            let falls: Option<Vec<f64>> = (1..steps).map(|i| Some(at(place(i - 1))? - at(place(i + 1))?)).collect();
            let Some(falls) = falls else { continue };
            let Some(most) = (0..falls.len()).max_by(|a, b| falls[*a].total_cmp(&falls[*b])) else { continue };
            let peak = (0..=steps).filter_map(|i| at(place(i))).fold(0.0, f64::max);
            if most == 0 || most + 1 == falls.len() || falls[most] < f64::max(2.0, PART * peak) {
                continue;
            }
            // The top of the parabola through three falls.
            let (a, b, c) = (falls[most - 1], falls[most], falls[most + 1]);
            let shift = 0.5 * (a - c) / (a - 2.0 * b + c).min(-f64::EPSILON);
            let index = most as f64 + 1.0 + shift;
            points.push(expected.centre + out * (expected.radius - reach + 0.5 * index));
        }
        let found = trimmed(points)?;
        (found.points.len() as f64 >= LEAST_FOUND * f64::from(SPOKES) && found.radius >= LEAST_RADIUS).then_some(found)
    }

    /// Part of the spokes along which an edge was found on the circle, 0 to 1; of a mask 1 or more.
    #[must_use]
    pub fn around(&self) -> f64 {
        self.points.len() as f64 / f64::from(SPOKES)
    }

    /// Whether a place is within the circle, by `margin` parts of its radius.
    #[must_use]
    pub fn holds(&self, p: DVec2, margin: f64) -> bool {
        p.distance_squared(self.centre) < (self.radius * (1.0 - margin)).powi(2)
    }
}

/// The circle through most of the points: fitted again without those further off than twice the median distance.
fn trimmed(mut points: Vec<DVec2>) -> Option<Outline> {
    let mut outline = Outline::through(points.clone())?;
    for _ in 0..12 {
        let off = |p: &DVec2| (p.distance(outline.centre) - outline.radius).abs();
        let mut all: Vec<f64> = points.iter().map(off).collect();
        let half = all.len() / 2;
        let median = *all.select_nth_unstable_by(half, f64::total_cmp).1;
        let reach = (2.5 * median).max(OFF);
        let kept: Vec<DVec2> = points.iter().filter(|p| off(p) <= reach).copied().collect();
        let settled = kept.len() == points.len();
        points = kept;
        outline = Outline::through(points.clone())?;
        if settled {
            break;
        }
    }
    Some(outline)
}

/// The threshold that parts dark from bright with the largest variance between them, of 256 steps to the greatest value.
fn otsu(luma: &[f32]) -> Option<f32> {
    let most = luma.iter().copied().filter(|v| v.is_finite()).fold(0.0, f32::max);
    if most <= 0.0 {
        return None;
    }
    let mut counts = [0.0_f64; 256];
    for v in luma.iter().filter(|v| v.is_finite()) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let bin = (255.0 * v.max(0.0) / most) as usize;
        counts[bin.min(255)] += 1.0;
    }
    let total: f64 = counts.iter().sum();
    let sum: f64 = counts.iter().zip(0_u32..).map(|(n, k)| n * f64::from(k)).sum();
    let (mut below, mut below_sum, mut best) = (0.0, 0.0, (0.0, 0.0));
    for (n, k) in counts.iter().zip(0_u16..) {
        below += n;
        below_sum += n * f64::from(k);
        let above = total - below;
        if below <= 0.0 || above <= 0.0 {
            continue;
        }
        let between = below * above * (below_sum / below - (sum - below_sum) / above).powi(2);
        if between > best.0 {
            best = (between, f32::from(k) + 1.0);
        }
    }
    (best.0 > 0.0).then(|| most * best.1 / 255.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 120;

    fn disc(value: impl Fn(f64) -> f32) -> Vec<f32> {
        let away = |i: usize| DVec2::new((i % WIDTH) as f64, (i / WIDTH) as f64).distance(DVec2::new(61.3, 47.8));
        (0..WIDTH * 100).map(|i| value(away(i))).collect()
    }

    #[test]
    fn a_disc_is_found_in_its_mask_and_in_its_picture() {
        let mask: Vec<bool> = disc(|d| f32::from(u8::from(d < 31.25))).iter().map(|v| *v > 0.5).collect();
        let found = Outline::of_mask(&mask, WIDTH).unwrap();
        assert!(
            found.centre.distance(DVec2::new(61.3, 47.8)) < 0.05 && (found.radius - 31.25).abs() < 0.05,
            "{found:?}"
        );
        #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
        let picture = disc(|d| (10.0 + 150.0 * (31.75 - d).clamp(0.0, 1.0)) as f32);
        let found = Outline::of_photo(&picture, WIDTH).unwrap();
        assert!(found.centre.distance(DVec2::new(61.3, 47.8)) < 0.1 && (found.radius - 31.25).abs() < 0.2, "{found:?}");
        assert!(Outline::of_photo(&disc(|_| 0.0), WIDTH).is_none());
        assert!(Outline::of_photo(&disc(|_| 255.0), WIDTH).is_none());
    }

    #[test]
    fn masks_that_are_no_disc_say_so() {
        let message = |mask: &[bool]| Outline::of_mask(mask, 10).unwrap_err().to_string();
        assert!(message(&[false; 100]).starts_with("found a mask that is dark all over"));
        assert!(message(&[true; 100]).starts_with("found a mask that is bright all over"));
    }
}
