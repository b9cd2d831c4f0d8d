//! One picture of the object under one light.

use std::sync::{Arc, OnceLock};

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::surface::{Cylinder, Hit, Plane, Sphere, Surface};
use crate::capture::camera::Camera;
use crate::capture::lamp::Pattern;
use crate::capture::merge::State;
use crate::capture::radiance::{Radiance, Strip};
use crate::capture::setup::{self, Place};
use crate::capture::{Error, Manifest};
use crate::geometry::direction::tangents;
use crate::math::sampling::cosine_hemisphere;

/// A corner of a pixel is of another part of the surface where it is further out of the tangent plane than this part of its distance, or
const OFF_PLANE: f64 = 0.1;
/// where the normal has turned by more than 10°: the cosine.
const TURNED: f64 = 0.984_807_753_012_208;
/// Relative standard uncertainty of the variance of a pixel's area: sensors are not sensitive in all of it, computed pictures sample it.
const PIXEL_SD: f64 = 0.1;
/// Rays along which a point looks out for the object itself, this many squared.
const LOOKS: u32 = 8;

/// Which measurements are used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest angle between normal and light, degrees: beyond it the point is in the attached shadow or next to it.
    pub max_theta_i_deg: f64,
    /// Largest angle between normal and camera, degrees: beyond it the point is at the silhouette.
    pub max_theta_o_deg: f64,
    /// Every so many-th pixel of every so many-th row.
    pub every: usize,
    /// Largest part of the hemisphere above a point, weighted by cosine, that the object itself fills: beyond it light comes from there too.
    pub max_self_view: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_theta_i_deg: 80.0, max_theta_o_deg: 80.0, every: 1, max_self_view: 0.05 }
    }
}

/// Camera and object.
#[derive(Debug, Clone)]
pub struct Scene {
    camera: Camera,
    position: DVec3,
    axes: DMat3,
    surface: Arc<dyn Surface>,
    /// Columns and rows of the pictures, and by pixel whether the point sees too much of the object itself; of surfaces that are not convex.
    crowded: Arc<OnceLock<(usize, usize, Vec<bool>)>>,
    /// Of the light, where it is near and does not shine alike to all sides.
    pattern: Option<Arc<Pattern>>,
    radiance: setup::Radiance,
    /// Of the places that a sample is a mean over, px².
    pixel_variance: f64,
    /// Relative standard uncertainty of that variance: 0 where it is stated how pictures were computed.
    pub pixel_variance_sd: f64,
    /// Standard error of the place of a pixel on the object, px: what calibration left of it. The gradient of the picture makes it one of σ.
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
    /// What was added to each value for the pixel's being an average: the part of it in proportion to the variance of the places averaged over.
    pub corrections: &'a [f64],
}

/// What a pixel sees of the object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// ω_i in the frame of the surface; below the horizon where the point is in the attached shadow.
    pub incident: DVec3,
    /// ω_o.
    pub outgoing: DVec3,
    /// cosθ_i/d², times the lamp's pattern, d = 1 for a distant light: irradiance over the strength of the light; 0 in the cast shadow.
    pub irradiance: f64,
}

/// What became of the pixels of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Measurements.
    pub valid: usize,
    /// Do not see the object.
    pub outside: usize,
    /// Excluded by the user's mask.
    pub masked: usize,
    /// See it under too flat an angle, or see its edge.
    pub silhouette: usize,
    /// Are not lit, or under too flat an angle.
    pub attached_shadow: usize,
    /// Are not lit in part or at all because the object stands before the light.
    pub cast_shadow: usize,
    /// See too much of the object itself, which lights them.
    pub inter_reflection: usize,
    /// Saturated in a band.
    pub saturated: usize,
    /// Dark in a band, or no number.
    pub dark: usize,
}

impl Counts {
    /// Adds those of other rows.
    pub fn add(&mut self, other: &Self) {
        self.valid += other.valid;
        self.outside += other.outside;
        self.masked += other.masked;
        self.silhouette += other.silhouette;
        self.attached_shadow += other.attached_shadow;
        self.cast_shadow += other.cast_shadow;
        self.inter_reflection += other.inter_reflection;
        self.saturated += other.saturated;
        self.dark += other.dark;
    }

    /// Names and numbers, valid ones first.
    #[must_use]
    pub fn named(&self) -> [(&'static str, usize); 9] {
        [
            ("valid", self.valid),
            ("outside", self.outside),
            ("masked", self.masked),
            ("silhouette", self.silhouette),
            ("attached_shadow", self.attached_shadow),
            ("cast_shadow", self.cast_shadow),
            ("inter_reflection", self.inter_reflection),
            ("saturated", self.saturated),
            ("dark", self.dark),
        ]
    }

    /// Why none is valid, in words.
    #[must_use]
    pub fn why(&self) -> &'static str {
        let shadow = self.attached_shadow + self.cast_shadow;
        let on_object = self.masked + self.silhouette + shadow + self.inter_reflection + self.saturated + self.dark;
        match on_object {
            0 => "no ray of the camera meets the object; are camera, object and lens in one frame?",
            _ if self.masked == on_object => "the mask leaves nothing of the object",
            _ if self.dark + self.saturated > 0 && self.dark >= self.saturated => {
                "all that is lit is dark; was the light on?"
            }
            _ if self.saturated > 0 => "all that is lit is saturated; expected a shorter exposure",
            _ if self.inter_reflection > 0 => "all that is lit sees too much of the object itself",
            _ if shadow == 0 => "the camera sees edges of the object only, or under too flat an angle",
            _ => "the light is below the horizon of all that the camera sees of the object",
        }
    }
}

impl Scene {
    /// Camera and object of a manifest: a sphere, a cylinder or a plane.
    ///
    /// # Errors
    /// [`Error::Setup`] where the camera is not stated or not one object, or the camera is inside of it; for a mesh, whose file is not read
    /// here: [`Scene::of_surface`].
    pub fn new(manifest: &Manifest, limits: Limits) -> Result<Self, Error> {
        let camera = manifest.camera.as_ref().ok_or_else(|| missing("no [camera]"))?;
        let surface: Arc<dyn Surface> = match (&manifest.sphere, &manifest.cylinder, &manifest.plane, &manifest.mesh) {
            (Some(sphere), None, None, None) => Arc::new(Sphere::new(sphere)),
            (None, Some(cylinder), None, None) => Arc::new(Cylinder::new(cylinder)),
            (None, None, Some(plane), None) => Arc::new(Plane::new(plane, DVec3::from_array(camera.position_m))?),
            (None, None, None, Some(_)) => return Err(missing("a [mesh] without the triangles of its file")),
            (None, None, None, None) => return Err(missing("no [sphere]")),
            _ => {
                return Err(Error::Setup {
                    found: "more than one of [sphere], [cylinder], [plane] and [mesh]".to_owned(),
                    expected: "one object",
                });
            }
        };
        Self::of_surface(manifest, surface, limits)
    }

    /// The camera of a manifest and any surface.
    ///
    /// # Errors
    /// [`Error::Setup`] where the camera is not stated, or is inside of the surface.
    pub fn of_surface(manifest: &Manifest, surface: Arc<dyn Surface>, limits: Limits) -> Result<Self, Error> {
        let camera = manifest.camera.as_ref().ok_or_else(|| missing("no [camera]"))?;
        let axes = camera.axes().ok_or_else(|| Error::Setup {
            found: format!("`up` {:?} along `forward` {:?}", camera.up, camera.forward),
            expected: "two directions across one another",
        })?;
        let position = DVec3::from_array(camera.position_m);
        if surface.holds(position) {
            return Err(Error::Setup {
                found: format!("the camera at {:?}, inside of the {}", camera.position_m, surface.kind()),
                expected: "a camera outside of it",
            });
        }
        Ok(Self {
            camera: camera.lens()?,
            position,
            axes,
            surface,
            crowded: Arc::default(),
            pattern: None,
            radiance: manifest.radiance,
            pixel_variance: camera.pixel_variance(),
            pixel_variance_sd: if camera.places_per_side.is_some() { 0.0 } else { PIXEL_SD },
            placement_px: 0.0,
            limits,
        })
    }

    /// The same under a near light that shines as `pattern` says, relative to its strength; `None`: alike to all sides.
    #[must_use]
    pub fn lit_by(&self, pattern: Option<Arc<Pattern>>) -> Self {
        Self { pattern, ..self.clone() }
    }

    /// What the object is: `sphere`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.surface.kind()
    }

    /// Whether only the angle between light and camera matters, as on a sphere, which shows all normals to all sides.
    pub(super) fn is_sphere(&self) -> bool {
        !self.surface.has_edges()
    }

    /// Where the ray of a place of the picture meets the object.
    #[must_use]
    pub fn hit(&self, pixel: DVec2) -> Option<Hit> {
        let ray = (self.axes * self.camera.direction(pixel)?).normalize();
        self.surface.hit(self.position, ray)
    }

    /// What a pixel's centre sees of the object under a light; `None` where it does not see it.
    #[must_use]
    pub fn view(&self, pixel: DVec2, place: Place) -> Option<View> {
        self.hit(pixel).map(|hit| self.view_of(&hit, place))
    }

    /// The same for a point that the camera sees.
    pub(super) fn view_of(&self, hit: &Hit, place: Place) -> View {
        let view = self.view_at(hit, place);
        if self.is_hidden(hit, place) { View { irradiance: 0.0, ..view } } else { view }
    }

    /// The same without cast shadows.
    fn view_at(&self, hit: &Hit, place: Place) -> View {
        let outgoing = (self.position - hit.point).normalize();
        let (incident, distance2) = light(place, hit);
        let (t, b) = tangents(hit.normal);
        let local = |d: DVec3| DVec3::new(t.dot(d), b.dot(d), hit.normal.dot(d));
        let mut irradiance = hit.normal.dot(incident) / distance2;
        if let (Some(pattern), Place::Near(_)) = (&self.pattern, place) {
            irradiance *= pattern.towards(hit.point);
        }
        View { incident: local(incident), outgoing: local(outgoing), irradiance }
    }

    /// Whether the object stands between a point of it and the light.
    fn is_hidden(&self, hit: &Hit, place: Place) -> bool {
        if self.surface.is_convex() {
            return false;
        }
        let (towards, distance2) = light(place, hit);
        let distance = if let Place::Near(_) = place { distance2.sqrt() } else { f64::INFINITY };
        self.surface.hides(hit, towards, distance)
    }

    /// What a pixel sees, its centre and its corners.
    pub(super) fn spot(&self, x: usize, y: usize, place: Place) -> Option<Spot> {
        let middle = DVec2::new(x as f64, y as f64);
        let hit = self.hit(middle)?;
        let mut spot = Spot { hit, edge: false, shadow: self.is_hidden(&hit, place) };
        if self.surface.has_edges() {
            for corner in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
                let of_one = |other: &Hit| {
                    let apart = other.point - hit.point;
                    apart.dot(hit.normal).abs() <= OFF_PLANE * apart.length() && other.normal.dot(hit.normal) >= TURNED
                };
                match self.hit(middle + DVec2::from(corner)).filter(of_one) {
                    Some(other) => spot.shadow = spot.shadow || self.is_hidden(&other, place),
                    None => spot.edge = true,
                }
            }
        }
        Some(spot)
    }

    /// By pixel, whether the point sees more of the object itself than [`Limits::max_self_view`]; `None` of a convex surface. Found once.
    fn crowded(&self, width: usize, height: usize) -> Option<&[bool]> {
        if self.surface.is_convex() {
            return None;
        }
        let every = self.limits.every.max(1);
        let (columns, rows, pixels) = self.crowded.get_or_init(|| {
            let row = |y: usize| {
                let of = |x: usize| {
                    let used = x.is_multiple_of(every) && y.is_multiple_of(every);
                    let hit = used.then(|| self.hit(DVec2::new(x as f64, y as f64))).flatten();
                    hit.is_some_and(|hit| self.self_view(&hit) > self.limits.max_self_view)
                };
                (0..width).map(of).collect::<Vec<_>>()
            };
            (width, height, (0..height).into_par_iter().flat_map_iter(row).collect())
        });
        (*columns == width && *rows == height).then_some(pixels)
    }

    /// Part of the hemisphere above a point, weighted by cosine, that the object itself fills.
    fn self_view(&self, hit: &Hit) -> f64 {
        let (t, b) = tangents(hit.normal);
        let at = |n: u32| (f64::from(n) + 0.5) / f64::from(LOOKS);
        let seen = (0..LOOKS * LOOKS).filter(|n| {
            let local = cosine_hemisphere([at(n % LOOKS), at(n / LOOKS)]);
            self.surface.hides(hit, t * local.x + b * local.y + hit.normal * local.z, f64::INFINITY)
        });
        seen.count() as f64 / f64::from(LOOKS * LOOKS)
    }

    /// Whether light and camera are both within the angles that are used, and the point is lit.
    #[must_use]
    pub fn is_within_limits(&self, view: &View) -> bool {
        let within = |d: DVec3, most_deg: f64| d.z >= most_deg.to_radians().cos();
        let angles =
            within(view.incident, self.limits.max_theta_i_deg) && within(view.outgoing, self.limits.max_theta_o_deg);
        angles && view.irradiance > 0.0
    }

    /// From the middle of the object, a direction at an angle to that of the camera, at an azimuth about it from the right of the picture.
    #[must_use]
    pub fn beside_camera(&self, angle_rad: f64, azimuth_rad: f64) -> DVec3 {
        let to_camera = (self.position - self.surface.middle()).normalize();
        let right =
            (self.axes.x_axis - to_camera * self.axes.x_axis.dot(to_camera)).normalize_or(tangents(to_camera).0);
        let aside = right * azimuth_rad.cos() + to_camera.cross(right) * azimuth_rad.sin();
        to_camera * angle_rad.cos() + aside * angle_rad.sin()
    }

    /// Visits the measurements of a picture: [`Scene::observe_rows`] of all of it.
    ///
    /// # Errors
    /// As there.
    pub fn observe(
        &self,
        picture: &Radiance,
        place: Place,
        strength: &[f64],
        mask: Option<&[bool]>,
        visit: &mut dyn FnMut(&Seen<'_>),
    ) -> Result<Counts, Error> {
        self.observe_rows(&Strip::whole(picture), place, strength, mask, visit)
    }

    /// Visits the measurements of rows of a picture, `mask` (a value per pixel of the whole picture, where given) being true where the object is.
    ///
    /// `strength` is the light's: radiant intensity of a near light, irradiance of a facing surface of a distant one, per band, so that the
    /// unit of the picture over that of the strength is 1/sr (times m² for a near light).
    ///
    /// # Errors
    /// [`Error::Setup`] for a mask of another size, another number of strengths than bands, a near light inside of the object, or
    /// pictures of several sizes of an object that is not convex.
    pub fn observe_rows(
        &self,
        strip: &Strip<'_>,
        place: Place,
        strength: &[f64],
        mask: Option<&[bool]>,
        visit: &mut dyn FnMut(&Seen<'_>),
    ) -> Result<Counts, Error> {
        let picture = strip.picture;
        let (width, height) = (picture.width, strip.height);
        let bands = picture.channels;
        if strength.len() != bands {
            return Err(Error::Setup {
                found: format!("a light or reference with {} bands and a picture with {bands}", strength.len()),
                expected: "one number, or as many as the picture has bands",
            });
        }
        if mask.is_some_and(|m| m.len() != width * height) {
            return Err(Error::Setup {
                found: format!("a mask of another size than {width} × {height} pixels"),
                expected: "a mask of the size of the pictures",
            });
        }
        if let Place::Near(p) = place
            && self.surface.holds(DVec3::from_array(p))
        {
            return Err(Error::Setup {
                found: format!("a light at {p:?}, inside of the {}", self.kind()),
                expected: "a light outside of it",
            });
        }
        let (least_i, least_o) =
            (self.limits.max_theta_i_deg.to_radians().cos(), self.limits.max_theta_o_deg.to_radians().cos());
        let [mut values, mut errors, mut corrections] = [(); 3].map(|()| vec![0.0; bands]);
        let mut counts = Counts::default();
        let mut rows = Rows { scene: self, place, width, height, kept: Vec::new() };
        let crowded = self.crowded(width, height);
        if crowded.is_none() && !self.surface.is_convex() {
            return Err(Error::Setup {
                found: format!("a picture of another size: {width} × {height} pixels"),
                expected: "pictures of one size",
            });
        }
        let every = self.limits.every.max(1);
        for y in strip.rows.clone().filter(|y| y.is_multiple_of(every)) {
            for x in (0..width).step_by(every) {
                let Some(spot) = rows.spot(x, y) else {
                    counts.outside += 1;
                    continue;
                };
                let at = y * width + x;
                if mask.is_some_and(|m| !m[at]) {
                    counts.masked += 1;
                    continue;
                }
                let view = self.view_at(&spot.hit, place);
                if spot.edge || view.outgoing.z < least_o {
                    counts.silhouette += 1;
                    continue;
                }
                if view.incident.z < least_i || view.irradiance <= 0.0 {
                    counts.attached_shadow += 1;
                    continue;
                }
                if spot.shadow {
                    counts.cast_shadow += 1;
                    continue;
                }
                if crowded.is_some_and(|c| c[at]) {
                    counts.inter_reflection += 1;
                    continue;
                }
                let here = strip.at(x, y);
                let samples = here * bands..(here + 1) * bands;
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
                let neighbours = self.neighbours(strip, &mut rows, (x, y));
                for (band, i) in samples.enumerate() {
                    // Samples are radiance times exposure time.
                    let exposure = strength[band] * view.irradiance * picture.time_s;
                    let (value, error) = self.at_centre(picture, i, neighbours.map(|n| n.map(|n| n * bands + band)));
                    values[band] = value / exposure;
                    errors[band] = error / exposure;
                    corrections[band] = (value - f64::from(picture.values[i])) / exposure;
                }
                let View { incident, outgoing, .. } = view;
                visit(&Seen {
                    pixel: (x, y),
                    incident,
                    outgoing,
                    values: &values,
                    errors: &errors,
                    corrections: &corrections,
                });
                counts.valid += 1;
            }
        }
        Ok(counts)
    }

    /// The four pixels beside one, where averages are corrected and all four are of use: lit, on the same part of the object, within the range.
    fn neighbours(&self, strip: &Strip<'_>, rows: &mut Rows<'_>, (x, y): (usize, usize)) -> Option<[usize; 4]> {
        let picture = strip.picture;
        if self.pixel_variance.max(self.placement_px) <= 0.0 && self.radiance.relative_error.is_none()
            || x == 0
            || y == 0
            || x + 1 >= picture.width
            || y + 1 >= strip.height
        {
            return None;
        }
        let bands = picture.channels;
        let mut of_use = |x: usize, y: usize| {
            let spot = rows.spot(x, y)?;
            let at = strip.at(x, y);
            let lit = !spot.edge && !spot.shadow && light(rows.place, &spot.hit).0.dot(spot.hit.normal) > 0.0;
            (lit && self.state(picture, at * bands..(at + 1) * bands) == State::Valid).then_some(at)
        };
        Some([of_use(x - 1, y)?, of_use(x + 1, y)?, of_use(x, y - 1)?, of_use(x, y + 1)?])
    }

    /// Sample `i` at the centre of its pixel and its standard error, given the same band of its neighbours.
    ///
    /// The mean of a smooth function over places of variance v along x and along y is its value in the middle plus v/2 of its Laplacian, up to
    /// fourth derivatives; the Laplacian is taken from the neighbours. For the area of a pixel, v = 1/12, that brings σ up by a sixth.
    fn at_centre(&self, picture: &Radiance, i: usize, neighbours: Option<[usize; 4]>) -> (f64, f64) {
        let (value, own) = (f64::from(picture.values[i]), picture.error(i, &self.radiance));
        let Some(neighbours) = neighbours else { return (value, own) };
        let beside = neighbours.map(|n| f64::from(picture.values[n]));
        let errors = neighbours.map(|n| picture.error(n, &self.radiance));
        // A σ in proportion to the sample itself would give those that noise has made dark more weight: that of its neighbours knows nothing of it.
        let error = if picture.errors.is_none() { 0.25 * errors.iter().sum::<f64>() } else { own };
        let part = 0.5 * self.pixel_variance;
        let corrected = value * (1.0 + 4.0 * part) - part * beside.iter().sum::<f64>();
        let mut variance = (error * (1.0 + 4.0 * part)).powi(2);
        variance += errors.iter().map(|e| (part * e).powi(2)).sum::<f64>();
        let [left, right, above, below] = beside;
        let gradient = DVec2::new(right - left, below - above) / 2.0;
        variance += self.placement_px.powi(2) * gradient.length_squared();
        (corrected, variance.sqrt())
    }

    /// The worst of the states of a pixel's samples.
    pub(super) fn state(&self, picture: &Radiance, samples: std::ops::Range<usize>) -> State {
        let mut worst = State::Valid;
        for i in samples {
            let state = picture.state(i, &self.radiance);
            if state == State::Saturated || worst == State::Valid {
                worst = state;
            }
        }
        worst
    }
}

/// What a pixel sees of the object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    /// At its centre.
    pub hit: Hit,
    /// A corner of the pixel sees something else.
    pub edge: bool,
    /// The object stands between the light and the centre or a corner.
    pub shadow: bool,
}

fn missing(what: &str) -> Error {
    Error::Setup {
        found: format!("{what} in the manifest"),
        expected: "[camera], [sphere] (or [cylinder], [plane], [mesh]) and [[light]]: `docs/capture.md` has an example",
    }
}

/// Direction to a light from a point, and the square of its distance (1 for a distant one).
fn light(place: Place, hit: &Hit) -> (DVec3, f64) {
    match place {
        Place::Near(p) => {
            let to_light = DVec3::from_array(p) - hit.point;
            (to_light.normalize(), to_light.length_squared())
        }
        Place::Distant(d) => (DVec3::from_array(d).normalize(), 1.0),
    }
}

/// What the pixels of the rows about the one that is measured see: rays through a lens are found once.
struct Rows<'a> {
    scene: &'a Scene,
    place: Place,
    width: usize,
    height: usize,
    kept: Vec<(usize, Vec<Option<Spot>>)>,
}

impl Rows<'_> {
    fn spot(&mut self, x: usize, y: usize) -> Option<Spot> {
        let at = self.kept.iter().position(|(row, _)| *row == y).unwrap_or_else(|| {
            if self.kept.len() >= AT_ONCE {
                // Rows are asked from the top downwards.
                self.kept.retain(|(row, _)| row + 2 >= y);
            }
            let next = y..self.height.min(y + AT_ONCE);
            let known: Vec<usize> = self.kept.iter().map(|(row, _)| *row).collect();
            let row = |y: usize| (y, (0..self.width).map(|x| self.scene.spot(x, y, self.place)).collect());
            let new: Vec<_> = next.into_par_iter().filter(|y| !known.contains(y)).map(row).collect();
            self.kept.extend(new);
            self.kept.iter().position(|(row, _)| *row == y).unwrap_or(0)
        });
        self.kept[at].1[x]
    }
}

/// Rows that are found at once.
const AT_ONCE: usize = 16;
