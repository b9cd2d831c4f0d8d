//! Lights that are no surfaces.

use std::f64::consts::PI;
use std::ops::Range;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::colour::Colour;
use super::picture::Of;
use super::{Builder, Quantities};
use crate::luminaire::placement::{Orientation, Placement};
use crate::luminaire::{Kind as LampKind, Luminaire};
use crate::render::bands::Bands;
use crate::render::description::Error;
use crate::render::description::light::{
    Environment as Surroundings, Lamp, Light as Described, Projection as Layout, Sun as DescribedSun,
};
use crate::render::description::quantity::{Angle, Kind};
use crate::render::light::Light;
use crate::render::light::bounding::BoundingSphere;
use crate::render::light::distant::Distant;
use crate::render::light::environment::{Environment, Picture};
use crate::render::light::goniometric::{Goniometric, Opening, per_unit};
use crate::render::light::point::Point;
use crate::render::light::projection::Projection;
use crate::render::light::sky::{Sky, SkyType};
use crate::render::light::spot::{Profile, Spot};
use crate::render::light::sun::{Air, Moment, SunPosition};

/// The name of a light in reports.
pub(super) fn name(light: &Described, number: usize) -> String {
    light.name.as_ref().map_or_else(|| format!("light {}", number + 1), |n| n.get_ref().clone())
}

/// The place of a light's kind in the text.
pub(super) fn span(light: &Described) -> Range<usize> {
    let kinds = [
        light.point.as_ref().map(toml::Spanned::span),
        light.spot.as_ref().map(toml::Spanned::span),
        light.lamp.as_ref().map(toml::Spanned::span),
        light.distant.as_ref().map(toml::Spanned::span),
        light.environment.as_ref().map(toml::Spanned::span),
        light.barzel.as_ref().map(toml::Spanned::span),
        light.sky.as_ref().map(toml::Spanned::span),
        light.sun.as_ref().map(toml::Spanned::span),
        light.name.as_ref().map(toml::Spanned::span),
    ];
    kinds.into_iter().flatten().next().unwrap_or(0..0)
}

/// An angle in degrees, without the rounding of the way through radians.
pub(super) fn degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    let even = (1e9 * degrees).round() / 1e9;
    if (degrees - even).abs() <= 4.0 * f64::EPSILON * degrees.abs() { even } else { degrees }
}

/// The two quantities that a light may state, one of which it must.
enum Amount {
    Flux(f64, Kind),
    Intensity(f64, Kind),
}

impl Builder<'_> {
    pub(super) fn light(
        &self,
        light: &Described,
        number: usize,
        bands: &Bands,
        quantities: &Quantities,
        sphere: BoundingSphere,
    ) -> Result<Arc<dyn Light>, Error> {
        let at = span(light);
        let colour = Colour::of_light(self, light.spectrum.as_ref())?;
        let kinds = [
            light.point.is_some(),
            light.spot.is_some(),
            light.lamp.is_some(),
            light.distant.is_some(),
            light.environment.is_some(),
            light.barzel.is_some(),
            light.sky.is_some(),
            light.sun.is_some(),
        ];
        if kinds.iter().filter(|k| **k).count() != 1 {
            let message = format!(
                "light {} has not one kind; expected one of point, spot, lamp, distant, environment, barzel, sky, sun",
                number + 1
            );
            return Err(self.wrong(&at, message));
        }
        let wrong = |e: crate::render::light::Error| self.wrong(&at, e);
        if let Some(point) = &light.point {
            let p = point.get_ref();
            let position = DVec3::from_array(p.at);
            return Ok(
                match self.amount(p.flux.map(|f| (f.value, f.kind)), p.intensity.map(|i| (i.value, i.kind)), &at)? {
                    Amount::Flux(value, kind) => {
                        let flux = self.scaled(&colour, value, kind, bands, quantities, &at)?;
                        Arc::new(Point::from_flux(position, &flux).map_err(wrong)?)
                    }
                    Amount::Intensity(value, kind) => {
                        let intensity = self.scaled(&colour, value, kind, bands, quantities, &at)?;
                        Arc::new(Point::new(position, &intensity).map_err(wrong)?)
                    }
                },
            );
        }
        if let Some(spot) = &light.spot {
            let s = spot.get_ref();
            let (position, aim) = (DVec3::from_array(s.at), DVec3::from_array(s.aim));
            if let Some(Angle(half)) = s.half_angle.filter(|half| !(half.0 > 1e-150 && half.0 <= PI)) {
                let message = format!("`half_angle` is {} deg; expected above 0 to 180 deg", degrees(half));
                return Err(self.wrong_key(&at, &["half_angle"], message));
            }
            let profile = s.half_angle.map_or(Profile::Cosine, |a| Profile::Cone { half_angle_rad: a.0 });
            return Ok(
                match self.amount(s.flux.map(|f| (f.value, f.kind)), s.intensity.map(|i| (i.value, i.kind)), &at)? {
                    Amount::Flux(value, kind) => {
                        let flux = self.scaled(&colour, value, kind, bands, quantities, &at)?;
                        Arc::new(Spot::from_flux(position, aim - position, profile, &flux).map_err(wrong)?)
                    }
                    Amount::Intensity(value, kind) => {
                        let intensity = self.scaled(&colour, value, kind, bands, quantities, &at)?;
                        Arc::new(Spot::new(position, aim - position, profile, &intensity).map_err(wrong)?)
                    }
                },
            );
        }
        if let Some(distant) = &light.distant {
            let d = distant.get_ref();
            let irradiance = self.scaled(&colour, d.irradiance.value, d.irradiance.kind, bands, quantities, &at)?;
            let radius = d.diameter.map_or(0.0, |a| 0.5 * a.0);
            let light = Distant::new(DVec3::from_array(d.from), radius, &irradiance, sphere).map_err(wrong)?;
            return Ok(Arc::new(light));
        }
        if let Some(all) = &light.environment {
            let colour = light.spectrum.as_ref().map(|_| &colour);
            return self.environment(all.get_ref(), &at, colour, bands, quantities, sphere);
        }
        if let Some(barzel) = &light.barzel {
            return self.barzel(barzel.get_ref(), &at, &colour, bands, quantities);
        }
        if let Some(sky) = &light.sky {
            let s = sky.get_ref();
            let kind = SkyType::new(s.r#type).map_err(|e| self.wrong_key(&at, &["type"], e))?;
            let sun = DVec3::from_array(s.sun.unwrap_or([0.0, 0.0, 1.0]));
            return Ok(Arc::new(match (s.zenith, s.horizontal) {
                (Some(l), None) => {
                    let radiance = self.scaled(&colour, l.value, l.kind, bands, quantities, &at)?;
                    Sky::from_zenith(kind, DVec3::Z, sun, &radiance, sphere).map_err(wrong)?
                }
                (None, Some(e)) => {
                    let irradiance = self.scaled(&colour, e.value, e.kind, bands, quantities, &at)?;
                    Sky::from_horizontal(kind, DVec3::Z, sun, &irradiance, sphere).map_err(wrong)?
                }
                (zenith, _) => return Err(self.not_one(&at, zenith.is_some(), ["zenith", "horizontal"])),
            }));
        }
        if let Some(sun) = &light.sun {
            let s = sun.get_ref();
            let position = self.sun(s, &at)?;
            let irradiance = self.scaled(&colour, s.irradiance.value, s.irradiance.kind, bands, quantities, &at)?;
            return Ok(Arc::new(position.light(&irradiance, sphere).map_err(wrong)?));
        }
        let lamp = light.lamp.as_ref().expect("one of the kinds");
        Ok(Arc::new(self.goniometric(lamp.get_ref(), &lamp.span(), &colour, bands, quantities)?))
    }

    /// Surroundings; `colour` is the light's own, where it has one.
    fn environment(
        &self,
        e: &Surroundings,
        at: &Range<usize>,
        colour: Option<&Colour>,
        bands: &Bands,
        quantities: &Quantities,
        sphere: BoundingSphere,
    ) -> Result<Arc<dyn Light>, Error> {
        let wrong = |e: crate::render::light::Error| self.wrong(at, e);
        let Some(file) = &e.file else {
            let Some(r) = e.radiance else {
                return Err(self.wrong(at, "neither `radiance` nor `file`; expected one of them"));
            };
            if e.projection != Layout::default() || e.field_of_view.is_some() || e.look.is_some() || e.up.is_some() {
                let message = "`projection`, `field_of_view`, `look` and `up` of surroundings without a `file`; expected a picture";
                return Err(self.wrong(at, message));
            }
            let colour = colour.unwrap_or(&Colour::Constant(1.0));
            let radiance = self.scaled(colour, r.value, r.kind, bands, quantities, at)?;
            return Ok(Arc::new(Environment::constant(&radiance, sphere).map_err(wrong)?));
        };
        let picture = self.picture(file, Of::Light, at)?;
        let white = match (picture.in_colours, e.radiance) {
            (true, Some(r)) => {
                let own = picture.white.colour();
                self.scaled(colour.unwrap_or(&own), r.value, r.kind, bands, quantities, at)?
            }
            // Without power in lines, as any density.
            (false, None) if colour.is_none() => {
                self.scaled(&Colour::Constant(1.0), 1.0, Kind::Spectral, bands, quantities, at)?
            }
            (true, None) => {
                let message = "a picture in colours without a `radiance`; expected what its white (R = G = B = 1) stands for, such as `1 cd/m2`";
                return Err(self.wrong(at, message));
            }
            (false, _) => {
                let message =
                    "a `radiance` or a `spectrum` beside a spectral picture, which has its own; expected neither";
                return Err(self.wrong(at, message));
            }
        };
        let half_field_rad = 0.5 * e.field_of_view.map_or(std::f64::consts::PI, |a| a.0);
        let projection = match e.projection {
            Layout::Equirectangular => Projection::Equirectangular,
            Layout::MirrorBall => Projection::MirrorBall,
            Layout::Fisheye => Projection::Equidistant { half_field_rad },
            Layout::EquisolidFisheye => Projection::Equisolid { half_field_rad },
        };
        if e.field_of_view.is_some() && matches!(e.projection, Layout::Equirectangular | Layout::MirrorBall) {
            let message = "a `field_of_view` of a picture that shows all directions; expected it only of a fisheye";
            return Err(self.wrong_key(at, &["field_of_view"], message));
        }
        let look = DVec3::from_array(e.look.unwrap_or([1.0, 0.0, 0.0]));
        let up = DVec3::from_array(e.up.unwrap_or([0.0, 0.0, 1.0]));
        let frame = look.try_normalize().zip(up.cross(look).try_normalize());
        let Some((x, y)) = frame else {
            return Err(self.wrong(at, "a `look` along `up`, or without length; expected two directions that differ"));
        };
        let to_world = DMat3::from_cols(x, y, x.cross(y));
        let picture = Picture {
            width: picture.width,
            height: picture.height,
            projection,
            coefficients: picture.coefficients.clone(),
            spectra: picture.spectra(bands, &white),
        };
        Ok(Arc::new(Environment::new(picture, to_world, sphere).map_err(wrong)?))
    }

    /// Where the sun stands, its direction as refracted by standard air.
    fn sun(&self, sun: &DescribedSun, at: &Range<usize>) -> Result<SunPosition, Error> {
        let span = sun.date.span();
        let found = sun.date.get_ref();
        let (Some(date), Some(time), Some(offset)) = (found.date, found.time, found.offset) else {
            let message =
                format!("found `{found}`; expected a date, a time and its offset, such as 2026-06-21T12:00:00+02:00");
            return Err(self.wrong(&span, message));
        };
        let minutes = match offset {
            toml::value::Offset::Z => 0,
            toml::value::Offset::Custom { minutes } => minutes,
        };
        let seconds = f64::from(time.second.unwrap_or(0)) + 1e-9 * f64::from(time.nanosecond.unwrap_or(0));
        let hours = f64::from(time.hour) + (f64::from(time.minute) - f64::from(minutes)) / 60.0 + seconds / 3600.0;
        let moment = Moment::utc(i32::from(date.year), date.month.into(), date.day.into(), hours);
        let moment = moment.map_err(|e| self.wrong(&span, e))?;
        for (key, angle, most) in [("latitude", sun.latitude, 90.0), ("longitude", sun.longitude, 360.0)] {
            let found = degrees(angle.0);
            if found.abs() > most {
                let message = format!("`{key}` is {found} deg; expected -{most} to {most} deg");
                return Err(self.wrong_key(at, &[key], message));
            }
        }
        let air = Some(Air { pressure_hpa: 1013.25, temperature_c: 15.0 });
        let position = SunPosition::new(moment, sun.latitude.0.to_degrees(), sun.longitude.0.to_degrees(), air);
        let position = position.map_err(|e| self.wrong(&span, e))?;
        if position.direction().z <= 0.0 {
            return Err(
                self.wrong(&span, "the sun is below the horizon then and there; expected a time at which it is up")
            );
        }
        Ok(position)
    }

    /// The light of a lamp file.
    pub(super) fn goniometric(
        &self,
        lamp: &Lamp,
        at: &Range<usize>,
        colour: &Colour,
        bands: &Bands,
        quantities: &Quantities,
    ) -> Result<Goniometric, Error> {
        let luminaire: Luminaire = self.files.luminaire(&lamp.file).map_err(|e| self.wrong(at, e))?;
        let degrees = |a: Option<crate::render::description::quantity::Angle>| a.map_or(0.0, |a| a.0.to_degrees());
        let orientation = match lamp.aim {
            Some(aim) => {
                if lamp.rotation.is_some() || lamp.tilt.is_some() {
                    return Err(self.wrong(at, "`aim` beside `rotation` or `tilt`; expected one way to turn the lamp"));
                }
                Orientation::Aim { at_m: DVec3::from_array(aim), towards_c_deg: 0.0, spin_deg: degrees(lamp.spin) }
            }
            None => Orientation::Angles {
                rotation_deg: degrees(lamp.rotation),
                tilt_deg: degrees(lamp.tilt),
                towards_c_deg: 0.0,
                spin_deg: degrees(lamp.spin),
            },
        };
        let placement =
            Placement::new(DVec3::from_array(lamp.at), orientation, lamp.dimming).map_err(|e| self.wrong(at, e))?;
        let opening = luminaire.opening.as_ref().and_then(Opening::of);
        let weights = match luminaire.kind {
            LampKind::Luminous => &quantities.luminous,
            LampKind::Radiant => &quantities.radiant,
            LampKind::Photon => return Err(self.wrong(at, "a lamp file of photon intensities; expected cd or W/sr")),
        };
        let values = colour.values(bands).map_err(|nm| self.wrong(at, format!("a line at {nm} nm without a band")))?;
        let unit = per_unit(&values, weights).map_err(|e| self.wrong(at, e))?;
        let table = match lamp.flux {
            None => luminaire.distribution,
            Some(flux) => {
                let file = luminaire.distribution.total_flux();
                let same = matches!(
                    (flux.kind, luminaire.kind),
                    (Kind::Luminous, LampKind::Luminous) | (Kind::Radiant, LampKind::Radiant)
                );
                if !(same && file > 0.0) {
                    return Err(self.wrong(at, "a `flux` that the lamp file cannot be scaled to; expected lm for a file in cd, W for one in W/sr, and a file with light"));
                }
                luminaire.distribution.scaled(flux.value / file)
            }
        };
        let made = Goniometric::new(table, &placement, &unit).map_err(|e| self.wrong(at, e))?;
        if !lamp.opening {
            return Ok(made);
        }
        let opening =
            opening.ok_or_else(|| self.wrong(at, "`opening` of a lamp file that states no flat luminous opening"))?;
        Ok(made.with_opening(opening))
    }

    /// Either of two quantities.
    fn amount(
        &self,
        flux: Option<(f64, Kind)>,
        intensity: Option<(f64, Kind)>,
        at: &Range<usize>,
    ) -> Result<Amount, Error> {
        match (flux, intensity) {
            (Some((value, kind)), None) => Ok(Amount::Flux(value, kind)),
            (None, Some((value, kind))) => Ok(Amount::Intensity(value, kind)),
            (flux, _) => Err(self.not_one(at, flux.is_some(), ["flux", "intensity"])),
        }
    }

    /// The values of a spectrum in the bands, scaled to an amount: in the luminous sense so that the bands' own sum gives it, in the
    /// radiant sense so that the whole spectrum does.
    pub(super) fn scaled(
        &self,
        colour: &Colour,
        amount: f64,
        kind: Kind,
        bands: &Bands,
        quantities: &Quantities,
        at: &Range<usize>,
    ) -> Result<Vec<f64>, Error> {
        let mut values =
            colour.values(bands).map_err(|nm| self.wrong(at, format!("a line at {nm} nm without a band")))?;
        let content = match kind {
            Kind::Luminous => values.iter().zip(&quantities.luminous).map(|(v, w)| v * w).sum(),
            Kind::Radiant => colour.total(),
            Kind::Spectral => 1.0,
        };
        let factor = amount / content;
        if !factor.is_finite() {
            let message = "a spectrum without any of the quantity that it is to be scaled to; expected light in it";
            return Err(self.wrong_key(at, &["spectrum"], message));
        }
        values.iter_mut().for_each(|v| *v *= factor);
        Ok(values)
    }
}
