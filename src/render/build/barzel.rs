//! The production light of a description.

use std::ops::Range;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::colour::Colour;
use super::picture::Of;
use super::{Builder, Quantities};
use crate::render::bands::Bands;
use crate::render::description::Error;
use crate::render::description::light::{Barzel as Described, Falloff as DescribedFalloff, SoftShape};
use crate::render::description::quantity::Kind;
use crate::render::light::barzel::{Barzel, Blocker, Clip, Controls, Falloff, Noise, Slide};
use crate::render::light::superellipse::Superellipse;
use crate::render::light::{self, Light};

impl Builder<'_> {
    pub(super) fn barzel(
        &self,
        b: &Described,
        at: &Range<usize>,
        colour: &Colour,
        bands: &Bands,
        quantities: &Quantities,
    ) -> Result<Arc<dyn Light>, Error> {
        let wrong = |e: light::Error| self.wrong(at, e);
        let controls = self.controls(b, at, bands)?;
        let (position, aim) = (DVec3::from_array(b.at), DVec3::from_array(b.aim));
        let up = DVec3::from_array(b.up.unwrap_or([0.0, 0.0, 1.0]));
        let with = |intensity: &[f64]| Barzel::new(position, aim - position, up, intensity, controls.clone());
        let intensity = match (b.flux, b.intensity) {
            (None, Some(i)) => self.scaled(colour, i.value, i.kind, bands, quantities, at)?,
            (Some(flux), None) => {
                if controls.slide.is_some() && flux.kind != Kind::Luminous {
                    let message =
                        "a radiant `flux` of a light with a slide, whose colours vary; expected lm, or an `intensity`";
                    return Err(self.wrong(at, message));
                }
                // The geometry's part: flux per intensity, sr.
                let one = self.scaled(colour, 1.0, Kind::Luminous, bands, quantities, at)?;
                let mut through = vec![0.0; bands.len()];
                with(&one).map_err(wrong)?.flux(&mut through);
                let per_intensity: f64 = through.iter().zip(&quantities.luminous).map(|(f, w)| f * w).sum();
                if per_intensity <= 0.0 {
                    return Err(self.wrong(at, "a `flux` of a light whose controls let nothing through"));
                }
                self.scaled(colour, flux.value / per_intensity, flux.kind, bands, quantities, at)?
            }
            (flux, _) => return Err(self.not_one(at, flux.is_some(), ["flux", "intensity"])),
        };
        Ok(Arc::new(with(&intensity).map_err(wrong)?))
    }

    fn controls(&self, b: &Described, at: &Range<usize>, bands: &Bands) -> Result<Controls, Error> {
        let wrong = |e: light::Error| self.wrong(at, e);
        let shape = |s: &SoftShape| {
            let outer = s.outer.unwrap_or(s.inner);
            Superellipse::new(DVec2::from_array(s.inner), DVec2::from_array(outer), s.roundness).map_err(wrong)
        };
        let clip = b.clip.as_ref().map(|c| Clip {
            near_m: c.near.map_or(0.0, |l| l.0),
            near_edge_m: c.near_edge.map_or(0.0, |l| l.0),
            far_m: c.far.map_or(f64::INFINITY, |l| l.0),
            far_edge_m: c.far_edge.map_or(0.0, |l| l.0),
        });
        let card = |c: &crate::render::description::light::Blocker| {
            Ok(Blocker {
                depth_m: c.depth.0,
                middle_m: DVec2::from_array(c.middle),
                outline: shape(&c.outline)?,
                opacity: c.opacity,
            })
        };
        let slide = match &b.slide {
            None => None,
            Some(s) => {
                let picture = self.picture(&s.file, Of::Factors, at)?;
                Some(Slide {
                    width: picture.width,
                    height: picture.height,
                    coefficients: picture.coefficients.clone(),
                    spectra: picture.spectra(bands, &vec![1.0; bands.len()]),
                    half: DVec2::from_array(s.half),
                })
            }
        };
        Ok(Controls {
            falloff: b.falloff.as_ref().map_or(Falloff::SQUARE, falloff),
            beam_exponent: b.beam_exponent,
            shape: b.shape.as_ref().map(shape).transpose()?,
            shear: DVec2::from_array(b.shear),
            clip,
            blockers: b.blockers.iter().map(card).collect::<Result<_, Error>>()?,
            slide,
            noise: b.noise.as_ref().map(|n| Noise { frequency: n.frequency, amplitude: n.amplitude, seed: n.seed }),
            shadows: b.shadows,
        })
    }
}

fn falloff(f: &DescribedFalloff) -> Falloff {
    let (exponent, reference_m) = (f.exponent, f.reference.map_or(1.0, |l| l.0));
    match f.most {
        None => Falloff::Power { exponent, reference_m },
        Some(most) => Falloff::Controlled { exponent, reference_m, most },
    }
}
