//! A picture beside what a model says it should be.

use glam::DVec2;

use super::Scene;
use crate::brdf::Brdf;
use crate::capture::merge::State;
use crate::capture::radiance::{Radiance, Strip};
use crate::capture::setup::Place;

/// The part of a picture that shows the object, as a square, and the same from a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Maps {
    /// Columns and rows.
    pub side: usize,
    /// Radiance of the picture over that of a sample of 1 at 1 s: rows from the top, bands side by side.
    pub measured: Vec<f64>,
    /// The same by the model, 0 beside the object and where it is not lit.
    pub modelled: Vec<f64>,
    /// Measured over modelled less 1, the mean over bands; NaN where there is no measurement.
    pub residual: Vec<f32>,
}

impl Maps {
    /// Median of the absolute residuals and root of the mean of their squares; `None` without measurements.
    #[must_use]
    pub fn spread(&self) -> Option<(f64, f64)> {
        let mut all: Vec<f64> = self.residual.iter().filter(|r| !r.is_nan()).map(|r| f64::from(r.abs())).collect();
        if all.is_empty() {
            return None;
        }
        let rms = (all.iter().map(|r| r * r).sum::<f64>() / all.len() as f64).sqrt();
        let middle = all.len() / 2;
        Some((*all.select_nth_unstable_by(middle, f64::total_cmp).1, rms))
    }
}

impl Scene {
    /// A picture and what `brdf` says that it should be, on at most `side` × `side` of its pixels; `None` where it does not show the object.
    /// `strength` is as for [`Scene::observe`], with as many bands as picture and model.
    #[must_use]
    pub fn maps(
        &self,
        picture: &Radiance,
        place: Place,
        strength: &[f64],
        brdf: &dyn Brdf,
        side: usize,
    ) -> Option<Maps> {
        let mut out = self.empty_maps((picture.width, picture.height), picture.channels, side)?;
        self.add_to_maps(&mut out, &Strip::whole(picture), place, strength, brdf);
        Some(out.maps)
    }

    /// Maps without anything in them yet, of pictures of `size` (columns, rows); `None` where they do not show the object.
    #[must_use]
    pub fn empty_maps(&self, size: (usize, usize), bands: usize, side: usize) -> Option<Growing> {
        let pixel = |x: usize, y: usize| DVec2::new(x as f64, y as f64);
        // Every fourth pixel finds the object; a margin of eight makes up for it.
        let (mut low, mut high) = ((usize::MAX, usize::MAX), (0, 0));
        for y in (0..size.1).step_by(4) {
            for x in (0..size.0).step_by(4).filter(|x| self.hit(pixel(*x, y)).is_some()) {
                low = (low.0.min(x), low.1.min(y));
                high = (high.0.max(x), high.1.max(y));
            }
        }
        if low.0 > high.0 {
            return None;
        }
        let whole = (high.0 - low.0).max(high.1 - low.1) + 16;
        let side = side.min(whole);
        let places = side * side;
        let maps = Maps {
            side,
            measured: vec![0.0; places * bands],
            modelled: vec![0.0; places * bands],
            residual: vec![f32::NAN; places],
        };
        Some(Growing { maps, middle: [(low.0 + high.0) as f64 / 2.0, (low.1 + high.1) as f64 / 2.0], whole })
    }

    /// Adds the pixels that are in a strip of the picture; `strength` as for [`Scene::maps`].
    pub fn add_to_maps(&self, out: &mut Growing, strip: &Strip<'_>, place: Place, strength: &[f64], brdf: &dyn Brdf) {
        let picture = strip.picture;
        let bands = picture.channels;
        let mut f = vec![0.0; bands];
        for at in 0..out.maps.side * out.maps.side {
            let Some((x, y)) = out.pixel(at).filter(|(x, y)| *x < picture.width && strip.rows.contains(y)) else {
                continue;
            };
            let first = strip.at(x, y) * bands;
            let samples = first..first + bands;
            let here = at * bands..(at + 1) * bands;
            for (to, i) in out.maps.measured[here.clone()].iter_mut().zip(samples.clone()) {
                *to = f64::from(picture.values[i]) / picture.time_s;
            }
            let Some(spot) = self.spot(x, y, place) else { continue };
            let view = self.view_of(&spot.hit, place);
            if view.irradiance <= 0.0 {
                continue;
            }
            brdf.evaluate(view.incident, view.outgoing, &mut f);
            for (to, (f, s)) in out.maps.modelled[here.clone()].iter_mut().zip(f.iter().zip(strength)) {
                *to = f * s * view.irradiance;
            }
            let whole = !spot.edge && !spot.shadow;
            if whole && self.is_within_limits(&view) && self.state(picture, samples) == State::Valid {
                let each = out.maps.measured[here.clone()].iter().zip(&out.maps.modelled[here]);
                let each = each.map(|(m, l)| m / l - 1.0);
                #[expect(clippy::cast_possible_truncation, reason = "a picture")]
                let mean = (each.sum::<f64>() / bands as f64) as f32;
                out.maps.residual[at] = if mean.is_finite() { mean } else { f32::NAN };
            }
        }
    }
}

/// Maps of which the pixels are added strip by strip.
#[derive(Debug, Clone)]
pub struct Growing {
    /// With the pixels that were added; measured and modelled are 0 and residuals NaN where none was.
    pub maps: Maps,
    /// Of the part that is shown, pixels.
    middle: [f64; 2],
    /// Its sides, pixels.
    whole: usize,
}

impl Growing {
    /// The pixel of a place in the maps; it may lie beyond the picture's right or lower edge, and is `None` beyond the others.
    fn pixel(&self, at: usize) -> Option<(usize, usize)> {
        let side = self.maps.side;
        let along =
            |n: usize, middle: f64| (middle + ((n as f64 + 0.5) / side as f64 - 0.5) * self.whole as f64).round();
        let (x, y) = (along(at % side, self.middle[0]), along(at / side, self.middle[1]));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 or more")]
        (x >= 0.0 && y >= 0.0).then_some((x as usize, y as usize))
    }
}
