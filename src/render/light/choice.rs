//! Choosing one of many lights.
//!
//! For up to [`FEW`] lights the probability is in proportion to [`Light::importance`] at the point that is lit, asked of each; for more
//! of them in proportion to a fixed table, their importance at a place that stands for the scene, whatever the point. Every light has at
//! least a hundredth of its even share in the table, so that none is lost that matters elsewhere. The probabilities sum to 1, and the
//! estimate (what arrives)/(pmf · pdf) is unbiased by any of them.
//!
//! Where no light is of importance at a point, none is chosen.

use glam::DVec3;

use super::Light;

/// Most lights that are asked one by one.
pub const FEW: usize = 16;
/// Share of the fixed table that is even among the lights.
const EVEN: f64 = 0.01;
/// An importance counts for at most so much (a point light at the point itself is of infinite one).
const MOST: f64 = 1e200;

/// How the lights of a scene are chosen among. It does not hold them: the same lights, in the same order, come with every call.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    count: usize,
    /// For many lights: their probabilities cumulated, the last 1.
    cumulated: Vec<f64>,
}

impl Choice {
    /// Among some lights of a scene around a place.
    #[must_use]
    pub fn new(lights: &[&dyn Light], scene_centre: DVec3) -> Self {
        let count = lights.len();
        if count <= FEW {
            return Self { count, cumulated: Vec::new() };
        }
        let weights: Vec<f64> = lights.iter().map(|light| weight(*light, scene_centre)).collect();
        let total: f64 = weights.iter().sum();
        let even = 1.0 / count as f64;
        let mut sum = 0.0;
        let mut cumulated: Vec<f64> = (weights.iter())
            .map(|w| {
                sum += if total > 0.0 { EVEN * even + (1.0 - EVEN) * w / total } else { even };
                sum
            })
            .collect();
        cumulated.iter_mut().for_each(|c| *c /= sum);
        Self { count, cumulated }
    }

    /// The light for a uniform number at a point, its probability, and the number stretched to [0, 1) again; `None` where no light is of
    /// importance.
    #[must_use]
    pub fn choose(&self, lights: &[&dyn Light], from: DVec3, u: f64) -> Option<(usize, f64, f64)> {
        debug_assert_eq!(lights.len(), self.count, "the lights that the choice was made for");
        if self.count > FEW {
            let index = self.cumulated.partition_point(|end| *end <= u).min(self.count - 1);
            let (start, share) = self.interval(index);
            return Some((index, share, stretched((u - start) / share)));
        }
        let weights = few(lights, from);
        let total: f64 = weights.iter().sum();
        let (mut left, mut last) = (u * total, None);
        for (index, weight) in weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0) {
            if left < weight {
                return Some((index, weight / total, stretched(left / weight)));
            }
            left -= weight;
            last = Some((index, weight / total, stretched(1.0)));
        }
        // Rounding has left something over: it is the last light's.
        last
    }

    /// The probability with which [`Choice::choose`] takes a light at a point.
    ///
    /// # Panics
    /// Where `index` is not that of a light.
    #[must_use]
    pub fn pmf(&self, lights: &[&dyn Light], from: DVec3, index: usize) -> f64 {
        debug_assert_eq!(lights.len(), self.count, "the lights that the choice was made for");
        if self.count > FEW {
            return self.interval(index).1;
        }
        let weights = few(lights, from);
        let total: f64 = weights.iter().sum();
        if total > 0.0 { weights[index] / total } else { 0.0 }
    }

    /// Start and length of a light's part of [0, 1].
    fn interval(&self, index: usize) -> (f64, f64) {
        let start = if index == 0 { 0.0 } else { self.cumulated[index - 1] };
        (start, self.cumulated[index] - start)
    }
}

fn few(lights: &[&dyn Light], from: DVec3) -> [f64; FEW] {
    let mut weights = [0.0; FEW];
    for (weight, light) in weights.iter_mut().zip(lights) {
        *weight = self::weight(*light, from);
    }
    weights
}

fn weight(light: &dyn Light, from: DVec3) -> f64 {
    light.importance(from).clamp(0.0, MOST)
}

/// A number of [0, 1) again, whatever was rounded.
fn stretched(u: f64) -> f64 {
    u.clamp(0.0, 1.0 - f64::EPSILON / 2.0)
}

#[cfg(test)]
mod tests {
    use super::super::point::Point;
    use super::super::spot::{Profile, Spot};
    use super::*;

    fn points(count: i32) -> Vec<Point> {
        (0..count)
            .map(|i| Point::new(DVec3::new(f64::from(i), 0.0, 1.0), &[f64::from(1 + i % 5)]).expect("a light"))
            .collect()
    }

    fn shares(lights: &[&dyn Light], from: DVec3) {
        let choice = Choice::new(lights, DVec3::ZERO);
        let n = 20_000;
        let mut counts = vec![0.0; lights.len()];
        for i in 0..n {
            let u = (f64::from(i) + 0.5) / f64::from(n);
            let (index, pmf, again) = choice.choose(lights, from, u).expect("a light");
            assert!((pmf - choice.pmf(lights, from, index)).abs() < 1e-15 && (0.0..1.0).contains(&again));
            counts[index] += 1.0;
        }
        let pmf = |index| choice.pmf(lights, from, index);
        for (index, count) in counts.iter().enumerate() {
            // An even net puts as many points into an interval as it is long, give or take one.
            assert!((count - f64::from(n) * pmf(index)).abs() <= 1.0 + 1e-9, "{index}: {count} {}", pmf(index));
        }
        assert!(((0..lights.len()).map(pmf).sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn lights_are_chosen_as_often_as_said() {
        for count in [1, 2, 16, 17, 100] {
            let lights = points(count);
            let lights: Vec<&dyn Light> = lights.iter().map(|l| l as &dyn Light).collect();
            shares(&lights, DVec3::new(3.0, 1.0, 0.0));
        }
    }

    /// Two points of 1 and 4 W/sr at 1 m and 2 m are of the same importance.
    #[test]
    fn few_lights_are_chosen_by_what_they_can_do() {
        let near = Point::new(DVec3::X, &[1.0]).expect("a light");
        let far = Point::new(DVec3::new(0.0, 0.0, 2.0), &[4.0]).expect("a light");
        let away = Spot::new(DVec3::Y, DVec3::Y, Profile::Cosine, &[1e9]).expect("a light");
        let lights: [&dyn Light; 3] = [&near, &far, &away];
        let choice = Choice::new(&lights, DVec3::ZERO);
        assert_eq!([0, 1, 2].map(|i| choice.pmf(&lights, DVec3::ZERO, i)), [0.5, 0.5, 0.0]);
        assert_eq!(choice.choose(&lights, DVec3::ZERO, 0.75), Some((1, 0.5, 0.5)));
        // At a light itself.
        assert_eq!(choice.choose(&lights, DVec3::X, 0.5).map(|c| c.0), Some(0));
        assert!(choice.pmf(&lights, DVec3::X, 0) <= 1.0);
        // Where nothing shines nothing is chosen, and so with no lights.
        let dark: [&dyn Light; 1] = [&away];
        assert_eq!(Choice::new(&dark, DVec3::ZERO).choose(&dark, DVec3::ZERO, 0.5), None);
        assert_eq!(Choice::new(&[], DVec3::ZERO).choose(&[], DVec3::ZERO, 0.5), None);
    }

    #[test]
    fn no_light_of_many_is_lost() {
        let mut lights = points(39);
        lights.push(Point::new(DVec3::splat(1e8), &[1e-9]).expect("a light"));
        let lights: Vec<&dyn Light> = lights.iter().map(|l| l as &dyn Light).collect();
        let choice = Choice::new(&lights, DVec3::ZERO);
        let least = (0..40).map(|i| choice.pmf(&lights, DVec3::ZERO, i)).fold(f64::INFINITY, f64::min);
        assert!((least - 0.01 / 40.0).abs() < 1e-9, "{least}");
    }
}
