//! One picture of the sphere under one light.

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use crate::capture::camera::Camera;
use crate::capture::merge::State;
use crate::capture::radiance::Radiance;
use crate::capture::setup::{self, Place};
use crate::capture::{Error, Manifest};
use crate::geometry::direction::tangents;

/// Which measurements are used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest angle between normal and light, degrees: beyond it the point is in the attached shadow or next to it.
    pub max_theta_i_deg: f64,
    /// Largest angle between normal and camera, degrees: beyond it the point is at the silhouette.
    pub max_theta_o_deg: f64,
    /// Every so many-th pixel of every so many-th row.
    pub every: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_theta_i_deg: 80.0, max_theta_o_deg: 80.0, every: 1 }
    }
}

/// Camera and sphere.
#[derive(Debug, Clone)]
pub struct Scene {
    camera: Camera,
    position: DVec3,
    axes: DMat3,
    centre: DVec3,
    radius: f64,
    radiance: setup::Radiance,
    /// Of the places that a sample is a mean over, px².
    pixel_variance: f64,
    /// Standard error of the place of a pixel on the sphere, px: what calibration left of it. The gradient of the picture makes it one of σ.
    pub placement_px: f64,
    /// Which measurements are used.
    pub limits: Limits,
}

/// A measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen<'a> {
    /// Column and row of the pixel.
    pub pixel: (usize, usize),
    /// ω_i in the frame of the surface.
    pub incident: DVec3,
    /// ω_o.
    pub outgoing: DVec3,
    /// f_r per band, 1/sr.
    pub values: &'a [f64],
    /// Its standard errors; 0 where none was stated.
    pub errors: &'a [f64],
}

/// What a pixel sees of the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// ω_i in the frame of the surface; below the horizon where the point is in the attached shadow.
    pub incident: DVec3,
    /// ω_o.
    pub outgoing: DVec3,
    /// cosθ_i/d², d = 1 for a distant light: irradiance over the strength of the light.
    pub irradiance: f64,
}

/// What became of the pixels of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Measurements.
    pub valid: usize,
    /// Do not see the sphere.
    pub outside: usize,
    /// Excluded by the user's mask.
    pub masked: usize,
    /// See it under too flat an angle.
    pub silhouette: usize,
    /// Are not lit, or under too flat an angle.
    pub attached_shadow: usize,
    /// Saturated in a band.
    pub saturated: usize,
    /// Dark in a band, or no number.
    pub dark: usize,
}

impl Counts {
    /// Names and numbers, valid ones first.
    #[must_use]
    pub fn named(&self) -> [(&'static str, usize); 7] {
        [
            ("valid", self.valid),
            ("outside", self.outside),
            ("masked", self.masked),
            ("silhouette", self.silhouette),
            ("attached_shadow", self.attached_shadow),
            ("saturated", self.saturated),
            ("dark", self.dark),
        ]
    }

    /// Why none is valid, in words.
    #[must_use]
    pub fn why(&self) -> &'static str {
        let on_sphere = self.masked + self.silhouette + self.attached_shadow + self.saturated + self.dark;
        match on_sphere {
            0 => "no ray of the camera meets the sphere; are camera, centre and radius in one frame?",
            _ if self.masked == on_sphere => "the mask leaves nothing of the sphere",
            _ if self.dark + self.saturated == 0 => {
                "the light is below the horizon of all that the camera sees of the sphere"
            }
            _ if self.dark >= self.saturated => "all that is lit is dark; was the light on?",
            _ => "all that is lit is saturated; expected a shorter exposure",
        }
    }
}

impl Scene {
    /// Camera and sphere of a manifest.
    ///
    /// # Errors
    /// [`Error::Setup`] where one of them is not stated, or the camera is inside of the sphere.
    pub fn new(manifest: &Manifest, limits: Limits) -> Result<Self, Error> {
        let missing = |what: &str| Error::Setup {
            found: format!("no [{what}] in the manifest"),
            expected: "[camera], [sphere] and [[light]]: `docs/capture.md` has an example",
        };
        let camera = manifest.camera.as_ref().ok_or_else(|| missing("camera"))?;
        let sphere = manifest.sphere.as_ref().ok_or_else(|| missing("sphere"))?;
        let axes = camera.axes().ok_or_else(|| Error::Setup {
            found: format!("`up` {:?} along `forward` {:?}", camera.up, camera.forward),
            expected: "two directions across one another",
        })?;
        let (position, centre) = (DVec3::from_array(camera.position_m), DVec3::from_array(sphere.centre_m));
        if position.distance(centre) <= sphere.radius_m {
            return Err(Error::Setup {
                found: format!("the camera at {:?}, inside of the sphere", camera.position_m),
                expected: "a camera outside of it",
            });
        }
        let (radius, radiance) = (sphere.radius_m, manifest.radiance);
        let pixel_variance = camera.pixel_variance();
        Ok(Self {
            camera: camera.lens()?,
            position,
            axes,
            centre,
            radius,
            radiance,
            pixel_variance,
            placement_px: 0.0,
            limits,
        })
    }

    /// The point of the sphere that a pixel's centre sees, in units of the radius from its centre: the normal there.
    #[must_use]
    pub fn normal(&self, pixel: DVec2) -> Option<DVec3> {
        let ray = (self.axes * self.camera.direction(pixel)?).normalize();
        let to_camera = self.position - self.centre;
        let along = -to_camera.dot(ray);
        // The nearest point of the ray to the centre: better conditioned than the discriminant of the distances.
        let nearest = to_camera + along * ray;
        let half_chord2 = self.radius * self.radius - nearest.length_squared();
        (half_chord2 > 0.0 && along > 0.0).then(|| (nearest - half_chord2.sqrt() * ray).normalize())
    }

    /// What a pixel's centre sees of the sphere under a light; `None` where it does not see it.
    #[must_use]
    pub fn view(&self, pixel: DVec2, place: Place) -> Option<View> {
        self.normal(pixel).map(|normal| self.view_at(normal, place))
    }

    /// The same for a point of the sphere that the camera sees.
    fn view_at(&self, normal: DVec3, place: Place) -> View {
        let outgoing = (self.position - (self.centre + self.radius * normal)).normalize();
        let (incident, distance2) = self.light(place, normal);
        let (t, b) = tangents(normal);
        let local = |d: DVec3| DVec3::new(t.dot(d), b.dot(d), normal.dot(d));
        let irradiance = normal.dot(incident) / distance2;
        View { incident: local(incident), outgoing: local(outgoing), irradiance }
    }

    /// Whether light and camera are both within the angles that are used.
    #[must_use]
    pub fn is_within_limits(&self, view: &View) -> bool {
        let within = |d: DVec3, most_deg: f64| d.z >= most_deg.to_radians().cos();
        within(view.incident, self.limits.max_theta_i_deg) && within(view.outgoing, self.limits.max_theta_o_deg)
    }

    /// From the middle of the sphere, a direction at an angle to that of the camera, to the right of it.
    #[must_use]
    pub fn beside_camera(&self, angle_rad: f64) -> DVec3 {
        let to_camera = (self.position - self.centre).normalize();
        let right =
            (self.axes.x_axis - to_camera * self.axes.x_axis.dot(to_camera)).normalize_or(tangents(to_camera).0);
        to_camera * angle_rad.cos() + right * angle_rad.sin()
    }

    /// Visits the measurements of a picture, `mask` (a value per pixel, where given) being true where the object is.
    ///
    /// `strength` is the light's: radiant intensity of a near light, irradiance of a facing surface of a distant one, per band, so that the
    /// unit of the picture over that of the strength is 1/sr (times m² for a near light).
    ///
    /// # Errors
    /// [`Error::Setup`] for a mask of another size, another number of strengths than bands, or a near light inside of the sphere.
    pub fn observe(
        &self,
        picture: &Radiance,
        place: Place,
        strength: &[f64],
        mask: Option<&[bool]>,
        visit: &mut dyn FnMut(&Seen<'_>),
    ) -> Result<Counts, Error> {
        let bands = picture.channels;
        if strength.len() != bands {
            return Err(Error::Setup {
                found: format!("a light or reference with {} bands and a picture with {bands}", strength.len()),
                expected: "one number, or as many as the picture has bands",
            });
        }
        if mask.is_some_and(|m| m.len() != picture.width * picture.height) {
            return Err(Error::Setup {
                found: format!("a mask of another size than {}", picture.size()),
                expected: "a mask of the size of the pictures",
            });
        }
        if let Place::Near(p) = place
            && DVec3::from_array(p).distance(self.centre) <= self.radius
        {
            return Err(Error::Setup {
                found: format!("a light at {p:?}, inside of the sphere"),
                expected: "a light outside of it",
            });
        }
        let (least_i, least_o) =
            (self.limits.max_theta_i_deg.to_radians().cos(), self.limits.max_theta_o_deg.to_radians().cos());
        let (mut values, mut errors) = (vec![0.0; bands], vec![0.0; bands]);
        let mut counts = Counts::default();
        let mut rows = Rows { scene: self, width: picture.width, height: picture.height, kept: Vec::new() };
        for y in (0..picture.height).step_by(self.limits.every.max(1)) {
            for x in (0..picture.width).step_by(self.limits.every.max(1)) {
                let Some(normal) = rows.normal(x, y) else {
                    counts.outside += 1;
                    continue;
                };
                let at = y * picture.width + x;
                if mask.is_some_and(|m| !m[at]) {
                    counts.masked += 1;
                    continue;
                }
                let view = self.view_at(normal, place);
                if view.outgoing.z < least_o {
                    counts.silhouette += 1;
                    continue;
                }
                if view.incident.z < least_i {
                    counts.attached_shadow += 1;
                    continue;
                }
                let samples = at * bands..(at + 1) * bands;
                match self.state(picture, samples.clone()) {
                    State::Valid => {}
                    State::Saturated => {
                        counts.saturated += 1;
                        continue;
                    }
                    State::Dark | State::Gap => {
                        counts.dark += 1;
                        continue;
                    }
                }
                let neighbours = self.neighbours(picture, place, &mut rows, (x, y));
                for (band, i) in samples.enumerate() {
                    // Samples are radiance times exposure time.
                    let exposure = strength[band] * view.irradiance * picture.time_s;
                    let (value, error) = self.at_centre(picture, i, neighbours.map(|n| n.map(|n| n * bands + band)));
                    values[band] = value / exposure;
                    errors[band] = error / exposure;
                }
                let View { incident, outgoing, .. } = view;
                visit(&Seen { pixel: (x, y), incident, outgoing, values: &values, errors: &errors });
                counts.valid += 1;
            }
        }
        Ok(counts)
    }

    /// Direction to a light from a point of the sphere, and the square of its distance (1 for a distant one).
    fn light(&self, place: Place, normal: DVec3) -> (DVec3, f64) {
        match place {
            Place::Near(p) => {
                let to_light = DVec3::from_array(p) - (self.centre + self.radius * normal);
                (to_light.normalize(), to_light.length_squared())
            }
            Place::Distant(d) => (DVec3::from_array(d).normalize(), 1.0),
        }
    }

    /// The four pixels beside one, where averages are corrected and all four are of use: lit, on the sphere, within the range.
    fn neighbours(
        &self,
        picture: &Radiance,
        place: Place,
        rows: &mut Rows<'_>,
        (x, y): (usize, usize),
    ) -> Option<[usize; 4]> {
        if self.pixel_variance.max(self.placement_px) <= 0.0
            || x == 0
            || y == 0
            || x + 1 >= picture.width
            || y + 1 >= picture.height
        {
            return None;
        }
        let bands = picture.channels;
        let mut of_use = |x: usize, y: usize| {
            let normal = rows.normal(x, y)?;
            let at = y * picture.width + x;
            let lit = self.light(place, normal).0.dot(normal) > 0.0;
            (lit && self.state(picture, at * bands..(at + 1) * bands) == State::Valid).then_some(at)
        };
        Some([of_use(x - 1, y)?, of_use(x + 1, y)?, of_use(x, y - 1)?, of_use(x, y + 1)?])
    }

    /// Sample `i` at the centre of its pixel and its standard error, given the same band of its neighbours.
    ///
    /// The mean of a smooth function over places of variance v along x and along y is its value in the middle plus v/2 of its Laplacian, up to
    /// fourth derivatives; the Laplacian is taken from the neighbours. For the area of a pixel, v = 1/12, that brings σ up by a sixth.
    fn at_centre(&self, picture: &Radiance, i: usize, neighbours: Option<[usize; 4]>) -> (f64, f64) {
        let (value, error) = (f64::from(picture.values[i]), self.error(picture, i));
        let Some(neighbours) = neighbours else { return (value, error) };
        let part = 0.5 * self.pixel_variance;
        let (mut corrected, mut variance) = (value * (1.0 + 4.0 * part), (error * (1.0 + 4.0 * part)).powi(2));
        for n in neighbours {
            corrected -= part * f64::from(picture.values[n]);
            variance += (part * self.error(picture, n)).powi(2);
        }
        let [left, right, above, below] = neighbours.map(|n| f64::from(picture.values[n]));
        let gradient = DVec2::new(right - left, below - above) / 2.0;
        variance += self.placement_px.powi(2) * gradient.length_squared();
        (corrected, variance.sqrt())
    }

    /// The worst of the states of a pixel's samples.
    pub(super) fn state(&self, picture: &Radiance, samples: std::ops::Range<usize>) -> State {
        let mut worst = State::Valid;
        for i in samples {
            let value = f64::from(picture.values[i]);
            let state = match picture.states.as_ref().map_or(State::Valid, |s| s[i]) {
                State::Valid if self.radiance.saturated.is_some_and(|s| value >= s) => State::Saturated,
                State::Valid if !(value > self.radiance.dark && value.is_finite()) => State::Dark,
                state => state,
            };
            if state == State::Saturated || worst == State::Valid {
                worst = state;
            }
        }
        worst
    }

    /// Standard error of a sample: its own, or as the manifest states; 0 where neither does.
    fn error(&self, picture: &Radiance, i: usize) -> f64 {
        match &picture.errors {
            Some(errors) => f64::from(errors[i]),
            None => {
                let relative = self.radiance.relative_error.unwrap_or(0.0) * f64::from(picture.values[i]);
                relative.hypot(self.radiance.absolute_error.unwrap_or(0.0))
            }
        }
    }
}

/// Normals of the rows about the one that is measured: rays through a lens are found once.
struct Rows<'a> {
    scene: &'a Scene,
    width: usize,
    height: usize,
    kept: Vec<(usize, Vec<Option<DVec3>>)>,
}

impl Rows<'_> {
    fn normal(&mut self, x: usize, y: usize) -> Option<DVec3> {
        let at = self.kept.iter().position(|(row, _)| *row == y).unwrap_or_else(|| {
            if self.kept.len() >= AT_ONCE {
                // Rows are asked from the top downwards.
                self.kept.retain(|(row, _)| row + 2 >= y);
            }
            let next = y..self.height.min(y + AT_ONCE);
            let known: Vec<usize> = self.kept.iter().map(|(row, _)| *row).collect();
            let row = |y: usize| {
                let normals = (0..self.width).map(|x| self.scene.normal(DVec2::new(x as f64, y as f64)));
                (y, normals.collect())
            };
            let new: Vec<_> = next.into_par_iter().filter(|y| !known.contains(y)).map(row).collect();
            self.kept.extend(new);
            self.kept.iter().position(|(row, _)| *row == y).unwrap_or(0)
        });
        self.kept[at].1[x]
    }
}

/// Rows whose normals are found at once.
const AT_ONCE: usize = 16;
