//! A picture beside what a model says it should be.

use glam::DVec2;

use super::Scene;
use crate::brdf::Brdf;
use crate::capture::merge::State;
use crate::capture::radiance::Radiance;
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
        let bands = picture.channels;
        let pixel = |x: usize, y: usize| DVec2::new(x as f64, y as f64);
        // Every fourth pixel finds the object; a margin of eight makes up for it.
        let (mut low, mut high) = ((usize::MAX, usize::MAX), (0, 0));
        for y in (0..picture.height).step_by(4) {
            for x in (0..picture.width).step_by(4).filter(|x| self.hit(pixel(*x, y)).is_some()) {
                low = (low.0.min(x), low.1.min(y));
                high = (high.0.max(x), high.1.max(y));
            }
        }
        if low.0 > high.0 {
            return None;
        }
        let whole = (high.0 - low.0).max(high.1 - low.1) + 16;
        let side = side.min(whole);
        let corner = ((low.0 + high.0) as f64 / 2.0, (low.1 + high.1) as f64 / 2.0);
        let places = side * side;
        let mut out = Maps {
            side,
            measured: vec![0.0; places * bands],
            modelled: vec![0.0; places * bands],
            residual: vec![f32::NAN; places],
        };
        let mut f = vec![0.0; bands];
        for at in 0..places {
            let along = |n: usize, middle: f64| middle + ((n as f64 + 0.5) / side as f64 - 0.5) * whole as f64;
            let (x, y) = (along(at % side, corner.0).round(), along(at / side, corner.1).round());
            if x < 0.0 || y < 0.0 || x >= picture.width as f64 || y >= picture.height as f64 {
                continue;
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
            let (x, y) = (x as usize, y as usize);
            let first = (y * picture.width + x) * bands;
            let samples = first..first + bands;
            let here = at * bands..(at + 1) * bands;
            for (to, i) in out.measured[here.clone()].iter_mut().zip(samples.clone()) {
                *to = f64::from(picture.values[i]) / picture.time_s;
            }
            let Some(spot) = self.spot(x, y, place) else { continue };
            let view = self.view_of(&spot.hit, place);
            if view.irradiance <= 0.0 {
                continue;
            }
            brdf.evaluate(view.incident, view.outgoing, &mut f);
            for (to, (f, s)) in out.modelled[here.clone()].iter_mut().zip(f.iter().zip(strength)) {
                *to = f * s * view.irradiance;
            }
            let whole = !spot.edge && !spot.shadow;
            if whole && self.is_within_limits(&view) && self.state(picture, samples) == State::Valid {
                let each = out.measured[here.clone()].iter().zip(&out.modelled[here]).map(|(m, l)| m / l - 1.0);
                #[expect(clippy::cast_possible_truncation, reason = "a picture")]
                let mean = (each.sum::<f64>() / bands as f64) as f32;
                out.residual[at] = if mean.is_finite() { mean } else { f32::NAN };
            }
        }
        Some(out)
    }
}
