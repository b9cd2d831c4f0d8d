//! Choosing one of many lights for a point that is to be lit.
//!
//! Up to [`FEW`] lights are weighed anew for every point, in proportion to [`Light::importance`] there. More of them keep one table, of
//! their importance at a place that stands for the scene, in which every light has at least a hundredth of its even share, so that none
//! is lost that matters elsewhere. Either way the probabilities are those of the draws and sum to 1.
//!
//! Where no light is of importance, none is chosen.

use std::sync::Arc;

use glam::DVec3;

use super::Light;

/// Most lights that are weighed for every point.
pub const FEW: usize = 64;
/// Share of the table of many that is even among the lights.
const EVEN: f64 = 0.01;
/// An importance counts for at most so much (a point light at the point itself is of infinite one).
const MOST: f64 = 1e200;

/// The lights' shares of the choice. It does not hold the lights: the same, in the same order, come with every call.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Running sums of the weights.
    sums: Vec<f64>,
    /// One table for all points.
    fixed: bool,
    /// Lights that shine alike from everywhere are not chosen.
    found: bool,
    /// There are others, or all are chosen and there is one.
    seeks: bool,
}

impl Choice {
    /// Among some lights, weighed for a place that stands for the scene. With `found`, lights that are the same from everywhere are left to
    /// directions that are drawn for the surface or the instrument, which suit them best.
    #[must_use]
    pub fn new(lights: &[Arc<dyn Light>], scene_centre: DVec3, found: bool) -> Self {
        let sought = lights.iter().filter(|light| !(found && light.is_uniform())).count();
        let mut choice = Self { sums: Vec::with_capacity(lights.len()), fixed: false, found, seeks: sought > 0 };
        choice.prepare(lights, scene_centre);
        choice.fixed = lights.len() > FEW;
        if let (true, Some(total)) = (choice.fixed, choice.sums.last().copied()) {
            let share = |sum: f64| if total > 0.0 { sum / total } else { 0.0 };
            let mut so_far = 0;
            for (light, sum) in lights.iter().zip(&mut choice.sums) {
                so_far += usize::from(!(found && light.is_uniform()));
                *sum = EVEN * so_far as f64 / sought.max(1) as f64 + (1.0 - EVEN) * share(*sum);
            }
        }
        choice
    }

    /// Whether there is anything to choose, at any point.
    #[must_use]
    pub fn seeks(&self) -> bool {
        self.seeks
    }

    /// Weighs the lights for a point; many stay as they are. Does not allocate.
    pub fn prepare(&mut self, lights: &[Arc<dyn Light>], from: DVec3) {
        if self.fixed {
            return;
        }
        let (mut sum, found) = (0.0, self.found);
        self.sums.clear();
        self.sums.extend(lights.iter().map(|light| {
            if !(found && light.is_uniform()) {
                sum += light.importance(from).clamp(0.0, MOST);
            }
            sum
        }));
    }

    /// A light drawn by one uniform number, with its probability and the number stretched to [0, 1) again; `None` where nothing shines.
    #[must_use]
    pub fn draw(&self, u: f64) -> Option<(usize, f64, f64)> {
        let total = self.sums.last().copied().filter(|total| *total > 0.0)?;
        let target = u * total;
        // Lights of no weight are never found: their end is not above their start. At u = 1 the last of some weight is.
        let mut index = self.sums.partition_point(|end| *end <= target);
        if index == self.sums.len() {
            index = self.sums.partition_point(|end| *end < total);
        }
        let (start, share) = self.interval(index);
        Some((index, share / total, ((target - start) / share).clamp(0.0, 1.0 - f64::EPSILON / 2.0)))
    }

    /// The probability with which [`Choice::draw`] finds a light.
    ///
    /// # Panics
    /// Where `light` is not the index of one.
    #[must_use]
    pub fn probability(&self, light: usize) -> f64 {
        let total = self.sums[self.sums.len() - 1];
        if total > 0.0 { self.interval(light).1 / total } else { 0.0 }
    }

    /// Start and length of a light's part of the sums.
    fn interval(&self, index: usize) -> (f64, f64) {
        let start = if index == 0 { 0.0 } else { self.sums[index - 1] };
        (start, self.sums[index] - start)
    }
}

#[cfg(test)]
mod tests {
    use super::super::bounding::BoundingSphere;
    use super::super::environment::Environment;
    use super::super::point::Point;
    use super::super::spot::{Profile, Spot};
    use super::*;

    fn points(count: i32) -> Vec<Arc<dyn Light>> {
        let point = |i| Point::new(DVec3::new(f64::from(i), 0.0, 1.0), &[f64::from(1 + i % 5)]).expect("a light");
        (0..count).map(|i| Arc::new(point(i)) as Arc<dyn Light>).collect()
    }

    #[test]
    fn lights_are_chosen_as_often_as_said() {
        for count in [1, 2, 64, 65, 200] {
            let lights = points(count);
            let mut choice = Choice::new(&lights, DVec3::ZERO, false);
            choice.prepare(&lights, DVec3::new(3.0, 1.0, 0.0));
            let n = 20_000;
            let mut counts = vec![0.0; lights.len()];
            for i in 0..n {
                let (index, probability, again) = choice.draw((f64::from(i) + 0.5) / f64::from(n)).expect("a light");
                assert!(probability == choice.probability(index) && (0.0..1.0).contains(&again));
                counts[index] += 1.0;
            }
            let probability = |index| choice.probability(index);
            for (index, drawn) in counts.iter().enumerate() {
                // An even net puts as many points into an interval as it is long, give or take one.
                assert!((drawn - f64::from(n) * probability(index)).abs() <= 1.0 + 1e-9, "{index}: {drawn}");
            }
            assert!(((0..lights.len()).map(probability).sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    /// Two points of 1 and 4 W/sr at 1 m and 2 m are of the same importance.
    #[test]
    fn few_lights_are_chosen_by_what_they_can_do() {
        let near = Point::new(DVec3::X, &[1.0]).expect("a light");
        let far = Point::new(DVec3::new(0.0, 0.0, 2.0), &[4.0]).expect("a light");
        let away = Spot::new(DVec3::Y, DVec3::Y, Profile::Cosine, &[1e9]).expect("a light");
        let lights: [Arc<dyn Light>; 3] = [Arc::new(near), Arc::new(far), Arc::new(away)];
        let mut choice = Choice::new(&lights, DVec3::ZERO, false);
        assert_eq!([0, 1, 2].map(|i| choice.probability(i)), [0.5, 0.5, 0.0]);
        assert_eq!(choice.draw(0.75), Some((1, 0.5, 0.5)));
        assert_eq!(choice.draw(1.0).map(|c| c.0), Some(1));
        // At a light itself its importance is infinite, its probability is not.
        choice.prepare(&lights, DVec3::X);
        assert_eq!(choice.draw(0.5).map(|c| c.0), Some(0));
        assert!(choice.probability(0) <= 1.0);
        // Where nothing shines nothing is chosen, and so with no lights.
        let dark = Choice::new(&lights[2..], DVec3::ZERO, false);
        assert_eq!((dark.draw(0.5), dark.probability(0)), (None, 0.0));
        assert_eq!(Choice::new(&[], DVec3::ZERO, false).draw(0.5), None);
    }

    #[test]
    fn no_light_of_many_is_lost() {
        let mut lights = points(79);
        lights.push(Arc::new(Point::new(DVec3::splat(1e8), &[1e-9]).expect("a light")));
        let choice = Choice::new(&lights, DVec3::ZERO, false);
        let least = (0..80).map(|i| choice.probability(i)).fold(f64::INFINITY, f64::min);
        assert!((least - 0.01 / 80.0).abs() < 1e-9, "{least}");
    }

    #[test]
    fn lights_that_are_the_same_from_everywhere_are_left_out_where_they_are_found() {
        for count in [2, 79] {
            let mut lights = points(count);
            let sphere = BoundingSphere::new(DVec3::ZERO, 1.0).expect("a sphere");
            lights.insert(1, Arc::new(Environment::constant(&[1e6], sphere).expect("a sky")));
            let sum = |choice: &Choice| (0..lights.len()).map(|i| choice.probability(i)).sum::<f64>();
            let [found, sought] = [true, false].map(|found| Choice::new(&lights, DVec3::Y, found));
            assert_eq!(found.probability(1), 0.0);
            // It alone: nothing is sought where it is found.
            assert!(found.seeks() && sought.seeks());
            let alone = &lights[1..2];
            assert!(!Choice::new(alone, DVec3::Y, true).seeks() && Choice::new(alone, DVec3::Y, false).seeks());
            assert!(sought.probability(1) > 0.9);
            assert!((sum(&found) - 1.0).abs() < 1e-12 && (sum(&sought) - 1.0).abs() < 1e-12);
        }
    }
}
