//! Instruments, and the quantities that they read.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::Builder;
use super::light::degrees;
use crate::colorimetry::observer::Observer;
use crate::constants::K_M;
use crate::geometry::lens::Distortion;
use crate::render::bands::{Bands, Width};
use crate::render::description::light::Light;
use crate::render::description::quantity::Angle;
use crate::render::description::sensor::{
    Camera as DescribedCamera, Goniophotometer as DescribedGoniophotometer,
    Gonioreflectometer as DescribedGonioreflectometer, Grid, Illuminance, Projection as Layout, Sensor,
};
use crate::render::description::{Error, Solver};
use crate::render::goniophotometer::Goniophotometer;
use crate::render::gonioreflectometer::{Gonioreflectometer, Spot};
use crate::render::light_map::LightMap;
use crate::render::measure::{Meter, Place};
use crate::render::ray::SurfacePoint;
use crate::render::scene::Scene;
use crate::render::sensor::camera::{Camera, Projection};
use crate::render::sensor::response::Response;
use crate::render::shape::rectangle::Rectangle;

/// What each band adds to the quantities that are read, per unit of the band's value.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantities {
    /// K_m V(λ) Δλ, lm/W times nm.
    pub luminous: Vec<f64>,
    /// Δλ, nm.
    pub radiant: Vec<f64>,
    /// K_m times the colour matching functions of the CIE 1931 observer.
    pub tristimulus: Vec<[f64; 3]>,
}

impl Quantities {
    pub(super) fn new(bands: &Bands) -> Self {
        let radiant = (bands.widths().iter())
            .map(|w| match *w {
                Width::Density { nm } => nm,
                Width::Line => 1.0,
            })
            .collect();
        let [x, y, z] = Observer::Cie1931.colour_matching_functions().map(|w| bands.weights(&w));
        let tristimulus = (0..bands.len()).map(|b| [K_M * x[b], K_M * y[b], K_M * z[b]]).collect();
        Self { luminous: super::luminous_weights(bands), radiant, tristimulus }
    }
}

/// An instrument of a scene.
#[derive(Debug)]
pub struct Instrument {
    /// Its name.
    pub name: String,
    /// Its spectrum is to be reported.
    pub spectrum: bool,
    /// The relative standard error to reach.
    pub target: Option<f64>,
    /// What it is.
    pub kind: Kind,
}

/// What an instrument is.
#[derive(Debug)]
pub enum Kind {
    /// A meter at one place.
    Meter(Meter),
    /// Meters on a grid, row by row across its map.
    Grid {
        /// The meters.
        meters: Vec<Meter>,
        /// Points across and up the map.
        counts: [usize; 2],
        /// Where they are.
        map: LightMap,
    },
    /// A goniophotometer.
    Goniophotometer(Goniophotometer),
    /// A gonioreflectometer.
    Gonioreflectometer(Gonioreflectometer),
    /// A camera.
    Camera(Camera),
}

/// Angle across the cone of a spot meter that states none, degrees.
const ACCEPTANCE_DEG: f64 = 1.0;
/// Angle across the width of a perspective picture, across the circle of a fisheye, that states none, degrees.
const FIELD_DEG: f64 = 60.0;
const FISHEYE_DEG: f64 = 180.0;
/// Steps of a goniophotometer that states none, degrees.
const C_STEP_DEG: f64 = 15.0;
const GAMMA_STEP_DEG: f64 = 5.0;
/// Steps of a gonioreflectometer that states none, degrees.
const THETA_STEP_DEG: f64 = 5.0;
const PHI_STEP_DEG: f64 = 10.0;
/// Most points of a grid.
const MOST_POINTS: u64 = 100_000;

impl Builder<'_> {
    /// The instruments; `surfaces` are the scene's surfaces that each described shape is.
    pub(super) fn instruments(&self, scene: &Scene, surfaces: &[Range<usize>]) -> Result<Vec<Instrument>, Error> {
        if self.description.sensor.is_empty() {
            return Err(self.wrong(&(0..0), "no sensor; expected at least one [[sensor]]"));
        }
        self.description.sensor.iter().map(|s| self.instrument(s, scene, surfaces)).collect()
    }

    fn instrument(&self, sensor: &Sensor, scene: &Scene, surfaces: &[Range<usize>]) -> Result<Instrument, Error> {
        let mut kinds = Vec::new();
        let meter = |at: [f64; 3], axis: DVec3, response| {
            let at = DVec3::from_array(at);
            Kind::Meter(Meter { place: point(at, axis, scene), response })
        };
        let upright = |axis: Option<[f64; 3]>, span: &Range<usize>| self.unit(axis.unwrap_or([0.0, 0.0, 1.0]), span);
        if let Some(i) = &sensor.illuminance {
            kinds.push(self.illuminance(i.get_ref(), &i.span(), scene, surfaces)?);
        }
        if let Some(l) = &sensor.luminance {
            let m = l.get_ref();
            let axis = DVec3::from_array(m.look_at) - DVec3::from_array(m.at);
            let half = 0.5 * m.acceptance.map_or(ACCEPTANCE_DEG.to_radians(), |a| a.0);
            if !(half > 0.0 && half <= std::f64::consts::FRAC_PI_2) {
                let found = degrees(2.0 * half);
                let message = format!("`acceptance` is {found} deg; expected above 0 to 180 deg");
                return Err(self.wrong_key(&l.span(), &["acceptance"], message));
            }
            kinds.push(meter(m.at, self.unit(axis.to_array(), &l.span())?, Response::Cone { sin: half.sin() }));
        }
        for (found, response) in [
            (&sensor.cylindrical, Response::Cylindrical),
            (&sensor.hemispherical, Response::Hemispherical),
            (&sensor.spherical, Response::Spherical),
        ] {
            if let Some(u) = found {
                kinds.push(meter(u.get_ref().at, upright(u.get_ref().axis, &u.span())?, response));
            }
        }
        if let Some(sphere) = &sensor.integrating_sphere {
            self.in_bounds(&sphere.span())?;
            kinds.push(Kind::Meter(Meter { place: Place::Around, response: Response::Flux }));
        }
        if let Some(g) = &sensor.goniophotometer {
            self.in_bounds(&g.span())?;
            kinds.push(Kind::Goniophotometer(self.goniophotometer(g.get_ref(), &g.span())?));
        }
        if let Some(g) = &sensor.gonioreflectometer {
            kinds.push(Kind::Gonioreflectometer(self.gonioreflectometer(g.get_ref(), &g.span())?));
        }
        if let Some(c) = &sensor.camera {
            kinds.push(Kind::Camera(self.camera(c.get_ref(), &c.span())?));
        }
        let mut kinds = kinds.into_iter();
        let (Some(kind), None) = (kinds.next(), kinds.next()) else {
            let message = format!(
                "sensor `{}` has not one kind; expected one of illuminance, luminance, cylindrical, hemispherical, spherical, integrating_sphere, goniophotometer, gonioreflectometer, camera",
                sensor.name.get_ref()
            );
            return Err(self.wrong(&sensor.name.span(), message));
        };
        let wrong_key = |key, message: &str| Err(self.wrong_key(&sensor.name.span(), &[key], message));
        if let Some(t) = sensor.target.filter(|t| t.0.is_nan() || t.0 <= 0.0) {
            return wrong_key("target", &format!("`target` is {} %; expected above 0 %", 100.0 * t.0));
        }
        let fixed = matches!(kind, Kind::Goniophotometer(_) | Kind::Gonioreflectometer(_));
        if fixed && sensor.target.is_some() {
            let message = "a `target` of an instrument that takes a fixed number of packets; expected `meter_samples`";
            return wrong_key("target", message);
        }
        if matches!(kind, Kind::Gonioreflectometer(_)) && sensor.spectrum {
            let message = "`spectrum` of a gonioreflectometer, whose table has every wavelength; expected none";
            return wrong_key("spectrum", message);
        }
        let target = sensor.target.map(|t| t.0);
        Ok(Instrument { name: sensor.name.get_ref().clone(), spectrum: sensor.spectrum, target, kind })
    }

    fn illuminance(
        &self,
        i: &Illuminance,
        span: &Range<usize>,
        scene: &Scene,
        surfaces: &[Range<usize>],
    ) -> Result<Kind, Error> {
        let response = Response::Planar;
        match (&i.at, &i.grid, &i.on) {
            (Some(at), None, None) => {
                let axis = self.unit(i.normal.unwrap_or([0.0, 0.0, 1.0]), span)?;
                Ok(Kind::Meter(Meter { place: point(DVec3::from_array(*at), axis, scene), response }))
            }
            (None, Some(grid), None) if i.normal.is_none() => self.grid(grid, span, scene, surfaces),
            (None, None, Some(on)) if i.normal.is_none() => {
                let shapes = &self.description.shape;
                let named = |n: usize| shapes[n].name.as_ref().is_some_and(|name| name.get_ref() == on.get_ref());
                let number = (0..shapes.len()).find(|n| named(*n)).filter(|n| surfaces[*n].len() == 1);
                let Some(number) = number else {
                    let message =
                        format!("no shape of one surface is called `{}`; expected the name of one", on.get_ref());
                    return Err(self.wrong(&on.span(), message));
                };
                let shape = scene.surfaces().shapes()[surfaces[number].start].clone();
                if !shape.area().is_finite() {
                    return Err(self.wrong(&on.span(), "a plane without bounds; expected a shape of finite area"));
                }
                Ok(Kind::Meter(Meter { place: Place::Area(shape), response }))
            }
            _ => Err(self.wrong(span, "not one place; expected `at` (with an optional `normal`), `grid`, or `on`")),
        }
    }

    /// Meters in the middles of the cells of a map.
    fn grid(&self, grid: &Grid, span: &Range<usize>, scene: &Scene, surfaces: &[Range<usize>]) -> Result<Kind, Error> {
        let map = match (grid.corner, grid.edges, &grid.on) {
            (Some(corner), Some(edges), None) => {
                LightMap::Flat { corner: DVec3::from_array(corner), edges: edges.map(DVec3::from_array) }
            }
            (None, None, Some(on)) => self.mapped(on, scene, surfaces)?,
            _ => return Err(self.wrong(span, "a grid without one place; expected `corner` and `edges`, or `on`")),
        };
        let [m, n] = grid.points;
        if m == 0 || n == 0 || u64::from(m) * u64::from(n) > MOST_POINTS {
            let message = format!("a grid of {m} × {n} points; expected 1 to {MOST_POINTS} of them");
            return Err(self.wrong_key(span, &["grid", "points"], message));
        }
        self.ends(grid.isolux.as_deref(), ["png", "svg"], span)?;
        let counts = [m as usize, n as usize];
        if let LightMap::Flat { edges: [u, v], .. } = map {
            self.unit(u.cross(v).to_array(), span)?;
            // A map is drawn at equal scale; edges askew have no such drawing.
            if grid.isolux.is_some() && u.dot(v).abs() > 1e-6 * u.length() * v.length() {
                return Err(self.wrong(span, "edges that are not at right angles; expected a rectangle for `isolux`"));
            }
        }
        let place = |index: usize| {
            let spot = map.middle(counts, index);
            match (map, self.description.render.solver) {
                // Packets land on areas: with them every point of a flat map is read all over its cell.
                (LightMap::Flat { edges: [u, v], .. }, Solver::Bidirectional) => {
                    let (a, b) = (u / f64::from(m), v / f64::from(n));
                    let cell = Rectangle::new(spot.position - 0.5 * (a + b), a, b).map_err(|e| self.wrong(span, e))?;
                    Ok(Place::Area(Arc::new(cell)))
                }
                _ => Ok(point(spot.position, spot.normal, scene)),
            }
        };
        let meters = (0..counts[0] * counts[1])
            .map(|index| Ok(Meter { place: place(index)?, response: Response::Planar }))
            .collect::<Result<_, Error>>()?;
        Ok(Kind::Grid { meters, counts, map })
    }

    /// The outside of a shape as a map.
    fn mapped(&self, on: &toml::Spanned<String>, scene: &Scene, surfaces: &[Range<usize>]) -> Result<LightMap, Error> {
        let shapes = self.description.shape.iter().zip(surfaces);
        let mut named = shapes.filter(|(s, _)| s.name.as_ref().is_some_and(|name| name.get_ref() == on.get_ref()));
        let map = named.next().and_then(|(shape, surfaces)| match &shape.rectangle {
            Some(r) => {
                let (corner, edges) = (r.get_ref().corner, r.get_ref().edges);
                Some(LightMap::Flat { corner: DVec3::from_array(corner), edges: edges.map(DVec3::from_array) })
            }
            None => LightMap::round(scene.surfaces().shapes()[surfaces.start].as_ref()),
        });
        map.ok_or_else(|| {
            let message =
                format!("no rectangle, sphere or cylinder is called `{}`; expected the name of one", on.get_ref());
            self.wrong(&on.span(), message)
        })
    }

    /// No meter stands on a light without extent, which is infinite there.
    pub(super) fn off_lights(&self, instruments: &[Instrument], dark_lights: &[String]) -> Result<(), Error> {
        let points = self.description.light.iter().enumerate().filter_map(|(number, light)| {
            let point = light.point.as_ref().map(|l| l.get_ref().at);
            let spot = || light.spot.as_ref().map(|l| l.get_ref().at);
            let lamp = || light.lamp.as_ref().filter(|l| !l.get_ref().opening).map(|l| l.get_ref().at);
            let at = DVec3::from_array(point.or_else(spot).or_else(lamp)?);
            let name = super::light::name(light, number);
            (!dark_lights.contains(&name)).then_some((at, name))
        });
        let points: Vec<(DVec3, String)> = points.collect();
        for (sensor, instrument) in self.description.sensor.iter().zip(instruments) {
            let (one, many) = match &instrument.kind {
                Kind::Meter(meter) => (Some(meter), &[][..]),
                Kind::Grid { meters, .. } => (None, meters.as_slice()),
                _ => continue,
            };
            let places = one.into_iter().chain(many).filter_map(|meter| match &meter.place {
                Place::Point(point) => Some(point.position),
                Place::Area(_) | Place::Around => None,
            });
            for place in places {
                // 1/r² is beyond all numbers nearer than that.
                let on = points.iter().find(|(at, _)| (1.0 / at.distance(place) / at.distance(place)).is_infinite());
                if let Some((_, name)) = on {
                    let message = format!(
                        "sensor `{}` stands on light `{name}`, whose light is infinite there; expected a place off it",
                        instrument.name
                    );
                    return Err(self.wrong(&sensor.name.span(), message));
                }
            }
        }
        Ok(())
    }

    /// Instruments around everything need lights that they can be around.
    fn in_bounds(&self, span: &Range<usize>) -> Result<(), Error> {
        let inside = |l: &Light| l.point.is_some() || l.spot.is_some() || l.lamp.is_some();
        let outside = self.description.light.iter().position(|l| !inside(l));
        outside.map_or(Ok(()), |number| {
            let name = self.description.light[number].name.as_ref().map(|n| format!(" `{}`", n.get_ref()));
            let message = format!(
                "light {}{} shines from outside of every instrument around the scene; expected points, spots, lamps and emitting shapes only",
                number + 1,
                name.unwrap_or_default()
            );
            Err(self.wrong(span, message))
        })
    }

    /// A file's name says its format.
    fn ends(&self, file: Option<&str>, endings: [&str; 2], span: &Range<usize>) -> Result<(), Error> {
        let known = |file: &str| endings.iter().any(|e| file.to_lowercase().ends_with(&format!(".{e}")));
        match file.filter(|f| !known(f)) {
            None => Ok(()),
            Some(file) => {
                let [first, second] = endings;
                let message = format!("the file `{file}`; expected a name that ends in .{first} or .{second}");
                Err(self.wrong(span, message))
            }
        }
    }

    fn goniophotometer(&self, g: &DescribedGoniophotometer, span: &Range<usize>) -> Result<Goniophotometer, Error> {
        self.ends(g.file.as_deref(), ["ies", "ldt"], span)?;
        let degrees = |angle: Option<Angle>, default: f64| angle.map_or(default, |a| a.0.to_degrees());
        let way = |given: Option<[f64; 3]>, default: DVec3| given.map_or(default, DVec3::from_array);
        Goniophotometer::new(
            way(g.down, DVec3::NEG_Z),
            way(g.c0, DVec3::X),
            degrees(g.c_step, C_STEP_DEG),
            degrees(g.gamma_step, GAMMA_STEP_DEG),
        )
        .map_err(|e| self.wrong(span, e))
    }

    fn gonioreflectometer(
        &self,
        g: &DescribedGonioreflectometer,
        span: &Range<usize>,
    ) -> Result<Gonioreflectometer, Error> {
        self.ends(g.file.as_deref(), ["csv", "binary"], span)?;
        let degrees = |a: &Angle| a.0.to_degrees();
        let azimuths = g.phi_i.as_ref().map_or(vec![0.0], |all| all.iter().map(degrees).collect());
        let incident = g.theta_i.iter().flat_map(|theta| azimuths.iter().map(|phi| [degrees(theta), *phi])).collect();
        let spot = Spot {
            centre: DVec3::from_array(g.at),
            normal: g.normal.map_or(DVec3::Z, DVec3::from_array),
            tangent: g.tangent.map_or(DVec3::X, DVec3::from_array),
            radius: g.radius.0,
        };
        let theta_step = g.theta_step.as_ref().map_or(THETA_STEP_DEG, degrees);
        let phi_step = g.phi_step.as_ref().map_or(PHI_STEP_DEG, degrees);
        Gonioreflectometer::new(&spot, incident, theta_step, phi_step).map_err(|e| self.wrong(span, e))
    }

    fn camera(&self, c: &DescribedCamera, span: &Range<usize>) -> Result<Camera, Error> {
        let degrees = |default: f64| c.field_of_view.map_or(default, |a| a.0.to_degrees());
        let lens = c.aperture_radius.is_some() || c.focus.is_some();
        let projection = match c.projection {
            Layout::Perspective if lens => {
                let (Some(aperture), Some(focus), None) = (c.aperture_radius, c.focus, c.distortion) else {
                    return Err(
                        self.wrong(span, "a thin lens needs `aperture_radius` and `focus`, and has no `distortion`")
                    );
                };
                Projection::ThinLens {
                    field_of_view_deg: degrees(FIELD_DEG),
                    aperture_radius_m: aperture.0,
                    focus_m: focus.0,
                }
            }
            Layout::Perspective => {
                let [k1, k2, p1, p2, k3] = c.distortion.unwrap_or_default();
                let distortion = Distortion { k1, k2, p1, p2, k3 };
                Projection::Perspective { field_of_view_deg: degrees(FIELD_DEG), distortion }
            }
            Layout::Fisheye => Projection::Fisheye { field_of_view_deg: degrees(FISHEYE_DEG) },
            Layout::Equirectangular => Projection::Equirectangular,
        };
        if c.projection != Layout::Perspective && (lens || c.distortion.is_some()) {
            return Err(
                self.wrong(span, "`distortion`, `aperture_radius` and `focus` belong to the perspective projection")
            );
        }
        if c.projection == Layout::Equirectangular && c.field_of_view.is_some() {
            let message =
                "`field_of_view` of a camera that sees all directions; expected it of a perspective or a fisheye";
            return Err(self.wrong_key(span, &["field_of_view"], message));
        }
        let up = DVec3::from_array(c.up.unwrap_or([0.0, 0.0, 1.0]));
        let (at, target) = (DVec3::from_array(c.at), DVec3::from_array(c.look_at));
        Camera::new(at, target, up, projection, c.resolution).map_err(|e| self.wrong(span, e))
    }

    fn unit(&self, vector: [f64; 3], span: &Range<usize>) -> Result<DVec3, Error> {
        DVec3::from_array(vector)
            .try_normalize()
            .ok_or_else(|| self.wrong(span, format!("the direction {vector:?}; expected a vector of some length")))
    }
}

/// A meter's place, off whatever surface it lies on.
fn point(at: DVec3, axis: DVec3, scene: &Scene) -> Place {
    Place::Point(SurfacePoint::meter(at, axis, scene.rounding_at(at)))
}
