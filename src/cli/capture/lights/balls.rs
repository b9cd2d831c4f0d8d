//! The balls of the photographs, and where they are.

use glam::DVec3;

use super::message;
use super::run::Run;
use crate::capture::lights::adjust::Start;
use crate::capture::lights::outline::Outline;
use crate::capture::lights::view::Ball;
use crate::capture::manifest::Stack;
use crate::capture::{Error, Photo, setup};
use crate::cli::Failure;
use crate::cli::capture::photos::Photos;
use crate::report::capture_lights::BallSeen;

/// A ball, and where it is.
pub(super) struct BallInUse {
    pub name: String,
    pub outline: Outline,
    pub start: Start,
    pub parallel: bool,
}

impl BallInUse {
    pub(super) fn seen(&self) -> BallSeen {
        let ball = (!self.parallel).then_some(self.start.ball);
        BallSeen { name: self.name.clone(), outline: self.outline.clone(), ball }
    }
}

impl Run {
    /// Number of the ball of a stack, found when first met.
    pub(super) fn ball(
        &mut self,
        photos: &mut Photos,
        stack: &Stack,
        all: &[Stack],
        photo: &Photo,
    ) -> Result<usize, Failure> {
        let described = described(photos, stack)?;
        if let Some(n) = self.balls.iter().position(|b| b.name == described.name) {
            return Ok(n);
        }
        let stated = described.centre_m.zip(described.radius_m).filter(|_| self.view.camera.is_some());
        let outline = match (&described.circle_px, &described.mask) {
            (Some(circle), _) => Some(Outline::stated(*circle)),
            (None, Some(mask)) => Some(mask_outline(photos, mask, photo)?),
            (None, None) if stated.is_some() => None,
            (None, None) => Some(brightest(photos, all, stack, photo).ok_or_else(|| {
                Failure::Message(format!(
                    "found no round edge of ball {} in its photographs; expected `mask` or `circle_px` in its [[ball]], or --mask",
                    described.name
                ))
            })?),
        };
        let ball = match stated {
            Some((centre, radius)) => Ball { centre: DVec3::from_array(centre), radius },
            None => {
                let outline = outline.as_ref().ok_or_else(|| message("found no outline of a ball; expected one"))?;
                self.view.ball(outline, described.radius_m).map_err(message)?
            }
        };
        let start = Start { ball, outline: outline.clone(), stated: stated.is_some() };
        let outline = match outline {
            Some(outline) => outline,
            None => self.view.outline(&ball).ok_or_else(|| {
                message("found a ball out of the camera's sight; expected camera and centre in one frame")
            })?,
        };
        self.balls.push(BallInUse { name: described.name, outline, start, parallel: self.view.camera.is_none() });
        Ok(self.balls.len() - 1)
    }
}

/// The description of the ball in a stack.
fn described(photos: &Photos, stack: &Stack) -> Result<setup::Ball, Failure> {
    let manifest = &photos.manifest;
    let named = |name: &String| {
        manifest.ball.iter().find(|b| b.name == *name).cloned().ok_or_else(|| {
            Failure::Message(format!(
                "stack {}: found no [[ball]] called {name}; expected `ball` to name one",
                stack.name
            ))
        })
    };
    match (&stack.ball, manifest.ball.as_slice(), &manifest.sphere) {
        (Some(name), _, _) => named(name),
        (None, [one], _) => Ok(one.clone()),
        (None, [], Some(sphere)) if manifest.camera.is_some() => Ok(setup::Ball {
            name: "sphere".to_owned(),
            mask: None,
            circle_px: None,
            centre_m: Some(sphere.centre_m),
            radius_m: Some(sphere.radius_m),
        }),
        _ => Err(Failure::Message(format!(
            "stack {}: found {} [[ball]]; expected `ball` to name one",
            stack.name,
            manifest.ball.len()
        ))),
    }
}

/// The shortest exposure of a stack, where the lamp is least spread, and its name.
pub(super) fn shortest(photos: &mut Photos, stack: &Stack) -> Result<(Photo, String), Failure> {
    let by_time = |e: &&crate::capture::manifest::Exposure| e.time_s.unwrap_or(f64::INFINITY);
    let first = stack.exposures.iter().min_by(|a, b| by_time(a).total_cmp(&by_time(b)));
    let name = first.map(|e| e.photo.clone());
    let name = name.ok_or_else(|| Failure::Message(format!("found no photograph in {}; expected one", stack.name)))?;
    Ok((photos.photo(&name)?, name))
}

fn mask_outline(photos: &mut Photos, mask: &str, photo: &Photo) -> Result<Outline, Failure> {
    let path = photos.path(mask);
    let bytes = photos.bytes(&path)?;
    let wrong = |e: Error| Failure::Message(format!("{path}: {e}"));
    let picture = Photo::decode(&bytes).map_err(wrong)?;
    if (picture.width, picture.height) != (photo.width, photo.height) {
        return Err(wrong(Error::Setup {
            found: format!(
                "a mask of {} × {} pixels beside photographs of {} × {}",
                picture.width, picture.height, photo.width, photo.height
            ),
            expected: "a mask of the size of the photographs",
        }));
    }
    let inside: Vec<bool> = picture.luma().iter().map(|v| *v > 127.5).collect();
    Outline::of_mask(&inside, picture.width).map_err(wrong)
}

/// The outline in the brightest of all photographs of the same ball, pixel by pixel.
fn brightest(photos: &mut Photos, all: &[Stack], stack: &Stack, photo: &Photo) -> Option<Outline> {
    let mut most = photo.luma();
    for other in all.iter().filter(|s| s.ball == stack.ball && s.shows == stack.shows && s.name != stack.name) {
        let Ok((other, _)) = shortest(photos, other) else { continue };
        if (other.width, other.height) == (photo.width, photo.height) {
            most.iter_mut().zip(other.luma()).for_each(|(m, v)| *m = m.max(v));
        }
    }
    Outline::of_photo(&most, photo.width)
}
