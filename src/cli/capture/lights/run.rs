//! What the photographs tell of the lights: a highlight or a shading each.

use glam::DVec3;

use super::balls::{BallInUse, shortest};
use super::message;
use crate::capture::Error;
use crate::capture::lights::adjust::{Evidence, Observation};
use crate::capture::lights::highlight::{self, Highlight};
use crate::capture::lights::outline::Outline;
use crate::capture::lights::shading::{self, Entanglement, Points, Shaded};
use crate::capture::lights::view::{Ray, View};
use crate::capture::manifest::{Shows, Stack};
use crate::capture::setup::Place;
use crate::cli::Failure;
use crate::cli::capture::photos::Photos;
use crate::finding::{Finding, Location};
use crate::report::capture_lights::{Seen, What};

/// Pixels between a mask and the edge in a photograph from which on it is told.
const MOVED_PX: f64 = 1.5;
/// Part of the ball's edge that has to be seen for that.
const WHOLE: f64 = 0.8;
/// Least spread that shading is believed to have, degrees: no real surface is Lambert's to better.
const LEAST_SPREAD_DEG: f64 = 0.5;

/// What is known so far.
pub(super) struct Run {
    pub view: View,
    pub linear: bool,
    pub names: Vec<String>,
    pub balls: Vec<BallInUse>,
    pub seen: Vec<Seen>,
    /// Of the diffuse balls, in the order of those in `seen`.
    pub points: Vec<Points>,
}

impl Run {
    /// Looks at all stacks; those that tell no light are left out.
    pub(super) fn look(&mut self, photos: &mut Photos) -> Result<(), Failure> {
        let wanted = |s: &&Stack| s.shows == Shows::MirrorBall || (s.shows != Shows::Flat && s.ball.is_some());
        let stacks: Vec<Stack> = photos.manifest.stack.iter().filter(wanted).cloned().collect();
        for stack in &stacks {
            let looked = self.stack(photos, stack, &stacks);
            match looked {
                Ok(()) => {}
                Err(failure @ Failure::Message(_)) if stacks.len() > 1 => photos.left_out(&stack.name, &failure),
                Err(failure) => return Err(failure),
            }
        }
        Ok(())
    }

    fn stack(&mut self, photos: &mut Photos, stack: &Stack, all: &[Stack]) -> Result<(), Failure> {
        let (photo, name) = shortest(photos, stack)?;
        let ball = self.ball(photos, stack, all, &photo)?;
        let in_use = &self.balls[ball];
        let wrong = |e: Error| message(e);
        let luma = photo.luma();
        if let Some(edge) = Outline::refined(&luma, photo.width, &in_use.outline) {
            let away = edge.centre.distance(in_use.outline.centre).max((edge.radius - in_use.outline.radius).abs());
            // Where part of the ball is in the dark, what ends there is the light.
            if away > MOVED_PX && edge.around() > WHOLE {
                let words = format!(
                    "the edge of the ball is {away:.1} px from its outline: middle {:.1}, {:.1}, radius {:.1} px",
                    edge.centre.x, edge.centre.y, edge.radius
                );
                let hint = "was the ball moved, or is the mask of another picture?";
                photos.findings.push(Finding::warning("K020", words).hint(hint).at(Location::default().of_item(&name)));
            }
        }
        let what = if stack.shows == Shows::MirrorBall {
            let ball = &in_use.start.ball;
            What::Highlight(highlight::find(&name, &photo, &in_use.outline, &self.view, ball).map_err(wrong)?)
        } else {
            let points = Points::of(&photo, &self.view, &in_use.start.ball, &in_use.outline);
            let shaded = shading::direction(&name, &points, self.linear || photo.is_linear()).map_err(wrong)?;
            self.points.push(points);
            What::Shading(shaded)
        };
        let light = stack.light.as_deref().unwrap_or(&stack.name);
        let light = self.names.iter().position(|n| n == light).unwrap_or_else(|| {
            self.names.push(light.to_owned());
            self.names.len() - 1
        });
        self.seen.push(Seen { stack: stack.name.clone(), photo: name, light, ball, what });
        Ok(())
    }

    /// The reflected ray of a highlight.
    pub(super) fn ray(&self, seen: &Seen) -> Option<Ray> {
        let What::Highlight(Highlight { pixel, .. }) = seen.what else { return None };
        self.balls[seen.ball].start.ball.reflected(self.view.ray(pixel)?)
    }

    /// Where each light seems to be: near where two balls or a distance tell it, else distant.
    pub(super) fn places(&self, distance: Option<f64>) -> Result<Vec<Place>, Failure> {
        let place = |k: usize| {
            let mine: Vec<&Seen> = self.seen.iter().filter(|s| s.light == k).collect();
            let rays: Vec<Ray> = mine.iter().filter_map(|s| self.ray(s)).collect();
            let turn = |s: &&Seen| match s.what {
                What::Highlight(h) => self.balls[s.ball].start.ball.turn_per_pixel(&self.view, h.pixel),
                What::Shading(_) => None,
            };
            // Rays that meet under less than three pixels' turn tell no distance.
            let least = 3.0 * mine.iter().filter_map(turn).fold(0.0, f64::max);
            if self.view.camera.is_some() {
                if let Some(p) = highlight::position(&rays, least) {
                    return Ok(Place::Near(p.to_array()));
                }
                if let (Some(distance), Some(ray)) = (distance, rays.first()) {
                    let centre = self.balls[0].start.ball.centre;
                    let p = highlight::at_distance(ray, centre, distance).ok_or_else(|| {
                        Failure::Message(format!("found a --distance of {distance} m; expected one beyond the ball"))
                    })?;
                    return Ok(Place::Near(p.to_array()));
                }
            }
            let shaded =
                mine.iter().filter_map(|s| if let What::Shading(s) = s.what { Some(s.direction) } else { None });
            let direction = highlight::direction(&rays).or_else(|| shaded.sum::<DVec3>().try_normalize());
            direction.map(|d| Place::Distant(d.to_array())).ok_or_else(|| {
                Failure::Message(format!("found sights of light {} that cancel out; expected one lamp", self.names[k]))
            })
        };
        (0..self.names.len()).map(place).collect()
    }

    pub(super) fn observations(&self) -> Vec<Observation> {
        let one = |s: &Seen| {
            let evidence = match s.what {
                What::Highlight(h) => Evidence::Highlight(h.pixel),
                What::Shading(Shaded { direction, spread_deg, .. }) => {
                    Evidence::Shading(direction, spread_deg.max(LEAST_SPREAD_DEG).to_radians())
                }
            };
            Observation { light: s.light, ball: s.ball, evidence }
        };
        self.seen.iter().map(one).collect()
    }

    /// What shading tells apart, under the lights found.
    pub(super) fn entanglement(&self, direction: impl Fn(usize) -> DVec3) -> Option<Entanglement> {
        if self.linear {
            return None;
        }
        let lights = self.seen.iter().filter(|s| matches!(s.what, What::Shading(_))).map(|s| direction(s.light));
        let all: Vec<(&Points, DVec3)> = self.points.iter().zip(lights).collect();
        (!all.is_empty()).then(|| shading::entanglement(&all)).flatten()
    }
}
