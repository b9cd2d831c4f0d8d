//! Geometry that connects one quantity with another: inverse square, solid angles, areas, Lambert's law, time.
//!
//! Every relation here is a factor that is the same at all wavelengths, so it holds for the radiometric, the photometric and
//! the photon quantity alike. [`derive()`] follows the relations that a [`Geometry`] opens from a quantity to all others.

use std::f64::consts::PI;

use serde::Serialize;

use crate::geometry::solid_angle;
use crate::spectrum::Quantity;
use crate::units::{
    Candela, CandelaPerSquareMetre, Lumen, LumenPerSquareMetre, Lux, Metre, Radian, SquareMetre, Steradian,
};

/// Illuminance from a point source of intensity `i` at a distance, its light at `incidence` to the normal: E = I cosθ / r².
#[must_use]
pub fn illuminance_of_point(i: Candela, distance: Metre, incidence: Radian) -> Lux {
    Lux(i.0 * incidence.0.cos() / (distance.0 * distance.0))
}

/// Intensity of a point source that gives `e` at normal incidence: I = E r².
#[must_use]
pub fn intensity_of_point(e: Lux, distance: Metre) -> Candela {
    Candela(e.0 * distance.0 * distance.0)
}

/// Luminance of a perfectly diffuse (Lambertian) surface of reflectance `rho` (0 to 1) under `e`: L = ρE/π.
#[must_use]
pub fn lambertian_luminance(e: Lux, rho: f64) -> CandelaPerSquareMetre {
    CandelaPerSquareMetre(rho * e.0 / PI)
}

/// Luminous exitance of a Lambertian emitter: M = πL.
#[must_use]
pub fn lambertian_exitance(l: CandelaPerSquareMetre) -> LumenPerSquareMetre {
    LumenPerSquareMetre(PI * l.0)
}

/// Flux of a uniform Lambertian emitter: Φ = πAL.
#[must_use]
pub fn lambertian_flux(l: CandelaPerSquareMetre, area: SquareMetre) -> Lumen {
    Lumen(PI * area.0 * l.0)
}

/// Flux of a uniform intensity within a solid angle: Φ = IΩ.
#[must_use]
pub fn uniform_flux(i: Candela, omega: Steradian) -> Lumen {
    Lumen(i.0 * omega.0)
}

/// Illuminance under a source of uniform luminance and projected solid angle `omega`: E = LΩ⊥.
#[must_use]
pub fn illuminance_of_uniform(l: CandelaPerSquareMetre, omega: Steradian) -> Lux {
    Lux(l.0 * omega.0)
}

/// An extended source on the axis of the receiver, facing it; lengths in m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// A sphere whose centre is at the distance.
    Sphere {
        /// Radius.
        radius_m: f64,
    },
    /// A disk.
    Disk {
        /// Radius.
        radius_m: f64,
    },
    /// A rectangle.
    Rectangle {
        /// Width.
        width_m: f64,
        /// Height.
        height_m: f64,
    },
    /// An isosceles triangle, its centroid on the axis.
    Triangle {
        /// Base.
        base_m: f64,
        /// Height.
        height_m: f64,
    },
}

impl Shape {
    /// Area as seen from the receiver's direction from afar, m².
    #[must_use]
    pub fn projected_area_m2(self) -> f64 {
        match self {
            Self::Sphere { radius_m } | Self::Disk { radius_m } => PI * radius_m * radius_m,
            Self::Rectangle { width_m, height_m } => width_m * height_m,
            Self::Triangle { base_m, height_m } => 0.5 * base_m * height_m,
        }
    }

    /// Emitting area, m².
    #[must_use]
    pub fn area_m2(self) -> f64 {
        match self {
            Self::Sphere { .. } => 4.0 * self.projected_area_m2(),
            _ => self.projected_area_m2(),
        }
    }

    /// Largest angle between the axis and any point of the source, seen from a receiver `distance_m` away, rad.
    #[must_use]
    pub fn half_extent_rad(self, distance_m: f64) -> f64 {
        match self {
            Self::Sphere { radius_m } => (radius_m / distance_m).asin(),
            Self::Disk { radius_m } => radius_m.atan2(distance_m),
            Self::Rectangle { width_m, height_m } => (0.5 * width_m.hypot(height_m)).atan2(distance_m),
            // Two thirds of the height above the centroid, or a corner of the base.
            Self::Triangle { base_m, height_m } => {
                (2.0 * height_m / 3.0).max((0.5 * base_m).hypot(height_m / 3.0)).atan2(distance_m)
            }
        }
    }

    /// Solid angle at a receiver `distance_m` away, sr.
    #[must_use]
    pub fn solid_angle_sr(self, distance_m: f64) -> f64 {
        match self {
            Self::Sphere { radius_m } => solid_angle::sphere(radius_m, distance_m),
            Self::Disk { radius_m } => solid_angle::disk(radius_m, distance_m),
            Self::Rectangle { width_m, height_m } => {
                solid_angle::polygon(&solid_angle::rectangle_corners(width_m, height_m, distance_m))
            }
            Self::Triangle { base_m, height_m } => {
                solid_angle::polygon(&solid_angle::triangle_corners(base_m, height_m, distance_m))
            }
        }
    }

    /// Projected solid angle on the receiver's normal, sr.
    #[must_use]
    pub fn projected_solid_angle_sr(self, distance_m: f64) -> f64 {
        match self {
            Self::Sphere { radius_m } => solid_angle::sphere_projected(radius_m, distance_m),
            Self::Disk { radius_m } => solid_angle::disk_projected(radius_m, distance_m),
            Self::Rectangle { width_m, height_m } => {
                solid_angle::polygon_projected(&solid_angle::rectangle_corners(width_m, height_m, distance_m))
            }
            Self::Triangle { base_m, height_m } => {
                solid_angle::polygon_projected(&solid_angle::triangle_corners(base_m, height_m, distance_m))
            }
        }
    }
}

/// What is known of the arrangement; every field opens relations, none is assumed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Geometry {
    /// Distance from source to receiver, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_m: Option<f64>,
    /// Angle of incidence at the receiver, rad; 0 where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub incidence_rad: Option<f64>,
    /// Emitting area, m²; for an irradiance without distance, the receiving area.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub area_m2: Option<f64>,
    /// Solid angle that the light fills evenly, sr.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solid_angle_sr: Option<f64>,
    /// Half-angle of the cone that the light fills, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cone_half_angle_rad: Option<f64>,
    /// The source emits by Lambert's cosine law.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub lambertian: bool,
    /// The source emits alike into the whole sphere.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub isotropic: bool,
    /// An extended source of uniform radiance, facing the receiver.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Duration, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
}

/// Why a geometry makes no sense.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A length, area, angle or time that is not positive, or too large.
    #[error("{what} of {found} {unit}; expected {expected}")]
    Range {
        /// Which.
        what: &'static str,
        /// The number.
        found: f64,
        /// Its unit.
        unit: &'static str,
        /// What it should be.
        expected: &'static str,
    },
    /// Two assumptions about the same thing.
    #[error("{first} and {second} contradict one another; expected one of them")]
    Contradiction {
        /// One option.
        first: &'static str,
        /// The other.
        second: &'static str,
    },
    /// A shape without a distance.
    #[error("an extended source without a distance; expected --distance beside --source")]
    ShapeWithoutDistance,
    /// Part of the source is behind the receiver's plane.
    #[error(
        "a source that reaches {source_deg:.1}° from its axis, at an incidence of {incidence_deg:.1}°, dips below the receiver's horizon; expected the two to add up to at most 90°"
    )]
    Horizon {
        /// Angular extent of the source from its axis.
        source_deg: f64,
        /// Angle of incidence.
        incidence_deg: f64,
    },
    /// Inside the sphere.
    #[error("a distance of {distance_m} m to a sphere of radius {radius_m} m; expected a distance beyond its surface")]
    Inside {
        /// Distance.
        distance_m: f64,
        /// Radius.
        radius_m: f64,
    },
}

/// A quantity reached from the measured one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Derived {
    /// The quantity.
    pub quantity: Quantity,
    /// Multiply the measured quantity by this.
    pub factor: f64,
    /// The chain of relations, in the radiometric symbols of `physics.md`: `I = E r²/cosθ`, then the next.
    pub relations: Vec<String>,
}

struct Edge {
    from: Quantity,
    to: Quantity,
    factor: f64,
    forward: String,
    backward: String,
}

impl Geometry {
    /// Whether nothing is known.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Checks that every number can be what it says and that no two assumptions contradict one another.
    ///
    /// # Errors
    /// [`Error`].
    pub fn check(&self) -> Result<(), Error> {
        let positive = |what, value: Option<f64>, unit, largest: f64, expected| match value {
            Some(found) if !(found > 0.0 && found <= largest && found.is_finite()) => {
                Err(Error::Range { what, found, unit, expected })
            }
            _ => Ok(()),
        };
        let any = "a positive finite number";
        positive("a distance", self.distance_m, "m", f64::MAX, any)?;
        positive("an area", self.area_m2, "m²", f64::MAX, any)?;
        positive("a time", self.time_s, "s", f64::MAX, any)?;
        positive("a solid angle", self.solid_angle_sr, "sr", 4.0 * PI, "a number above 0 and up to 4π = 12.566 sr")?;
        positive("a cone's half-angle", self.cone_half_angle_rad, "rad", PI, "an angle above 0 and up to 180°")?;
        if let Some(found) = self.incidence_rad.filter(|a| !(0.0..0.5 * PI).contains(a)) {
            let expected = "an angle from 0 to less than 90°";
            return Err(Error::Range { what: "an angle of incidence", found, unit: "rad", expected });
        }
        let contradiction = |first, second| Err(Error::Contradiction { first, second });
        match (self.solid_angle_sr, self.cone_half_angle_rad, self.isotropic, self.lambertian) {
            (Some(_), Some(_), ..) => return contradiction("--solid-angle", "--cone"),
            (Some(_), _, true, _) => return contradiction("--solid-angle", "--isotropic"),
            (_, Some(_), true, _) => return contradiction("--cone", "--isotropic"),
            (_, _, true, true) => return contradiction("--isotropic", "--lambertian"),
            (Some(_), _, _, true) => return contradiction("--solid-angle", "--lambertian"),
            _ => {}
        }
        if self.lambertian && self.cone_half_angle_rad.is_some_and(|a| a > 0.5 * PI) {
            return contradiction("--lambertian", "a --cone beyond 90°");
        }
        match (self.shape, self.distance_m) {
            (Some(_), None) => return Err(Error::ShapeWithoutDistance),
            (Some(Shape::Sphere { radius_m }), Some(distance_m)) if distance_m <= radius_m => {
                return Err(Error::Inside { distance_m, radius_m });
            }
            _ => {}
        }
        match (self.shape, self.incidence_rad) {
            (Some(_), _) if self.area_m2.is_some() => {
                return contradiction("--source", "--area (the source has its own)");
            }
            (Some(Shape::Sphere { .. }), _) if self.lambertian && self.cone_half_angle_rad.is_some() => {
                return contradiction("--cone", "a Lambertian sphere, which shines in all directions");
            }
            (Some(Shape::Triangle { .. }), Some(angle)) if angle > 0.0 => {
                return contradiction("--incidence", "--source triangle, which does not look alike from all sides");
            }
            _ => {}
        }
        self.check_horizon()
    }

    /// The cosine of the angle of incidence stands for the whole source only while all of it is before the receiver's plane.
    fn check_horizon(&self) -> Result<(), Error> {
        let Some(incidence) = self.incidence_rad.filter(|a| *a > 0.0) else { return Ok(()) };
        let extent = match (self.shape, self.distance_m) {
            (Some(shape), Some(distance)) => shape.half_extent_rad(distance),
            (None, None) => self.seen_half_angle_rad().unwrap_or(0.0),
            _ => 0.0,
        };
        if extent + incidence > 0.5 * PI * (1.0 + 1e-12) {
            return Err(Error::Horizon { source_deg: extent.to_degrees(), incidence_deg: incidence.to_degrees() });
        }
        Ok(())
    }

    /// Half-angle of the cone that --cone or --solid-angle describe.
    fn seen_half_angle_rad(&self) -> Option<f64> {
        self.cone_half_angle_rad.or(self.solid_angle_sr.map(solid_angle::cone_half_angle))
    }

    /// The relations that this geometry opens for a measurement of `start`.
    fn edges(&self, start: Quantity) -> Vec<Edge> {
        use Quantity::{Energy, Exitance, Exposure, Flux, Intensity, Irradiance, Radiance};
        let mut edges = Vec::new();
        let mut edge = |from, to, factor, forward: &str, backward: &str| {
            edges.push(Edge { from, to, factor, forward: forward.to_owned(), backward: backward.to_owned() });
        };
        let incidence = self.incidence_rad.unwrap_or(0.0).cos();
        let received = matches!(start, Irradiance | Radiance | Exposure) && self.distance_m.is_none();
        if let (Some(shape), Some(distance)) = (self.shape, self.distance_m) {
            let omega = shape.projected_solid_angle_sr(distance) * incidence;
            edge(
                Radiance,
                Irradiance,
                omega,
                "E = L Ω⊥ (uniform source on the axis)",
                "L = E/Ω⊥ (uniform source on the axis)",
            );
            edge(Radiance, Intensity, shape.projected_area_m2(), "I = L A⊥", "L = I/A⊥");
        } else if let Some(distance) = self.distance_m {
            edge(Intensity, Irradiance, incidence / (distance * distance), "E = I cosθ/r²", "I = E r²/cosθ");
        }
        // A Lambertian source confined to a cone emits sin²τ of what it would into the hemisphere.
        let lambert = PI * self.cone_half_angle_rad.map_or(1.0, |a| a.sin().powi(2));
        let omega = (self.solid_angle_sr)
            .or(self.cone_half_angle_rad.map(solid_angle::cone))
            .or(self.isotropic.then_some(4.0 * PI));
        if self.lambertian {
            edge(
                Radiance,
                Exitance,
                lambert,
                "M = π sin²τ L (Lambert; τ = 90° without --cone)",
                "L = M/(π sin²τ) (Lambert; τ = 90° without --cone)",
            );
            if matches!(self.shape, Some(Shape::Sphere { .. })) {
                edge(Intensity, Flux, 4.0 * PI, "Φ = 4π I (Lambertian sphere)", "I = Φ/4π (Lambertian sphere)");
            } else {
                edge(
                    Intensity,
                    Flux,
                    lambert,
                    "Φ = π sin²τ I₀ (cosine law; τ = 90° without --cone)",
                    "I₀ = Φ/(π sin²τ) (cosine law; τ = 90° without --cone)",
                );
            }
        } else if received {
            // Of a source, nobody sees more than the hemisphere before the receiver.
            if let Some(half_angle) = self.seen_half_angle_rad().filter(|a| *a <= 0.5 * PI * (1.0 + 1e-12)) {
                let projected = solid_angle::cone_projected(half_angle) * incidence;
                edge(Radiance, Irradiance, projected, "E = π sin²τ cosθ L", "L = E/(π sin²τ cosθ)");
            }
        } else if let Some(omega) = omega {
            edge(Intensity, Flux, omega, "Φ = I Ω", "I = Φ/Ω");
        }
        let area = self.area_m2.or(self.shape.map(Shape::area_m2));
        if let Some(area) = area {
            if self.area_m2.is_some() && matches!(start, Irradiance | Exposure) && self.distance_m.is_none() {
                edge(Irradiance, Flux, area, "Φ = E A (receiving area)", "E = Φ/A (receiving area)");
                edge(Exposure, Energy, area, "Q = H A (receiving area)", "H = Q/A (receiving area)");
            } else {
                edge(Exitance, Flux, area, "Φ = M A", "M = Φ/A");
                if self.shape.is_none() {
                    edge(Radiance, Intensity, area, "I = L A (along the normal)", "L = I/A (along the normal)");
                }
            }
        }
        if let Some(time) = self.time_s {
            edge(Flux, Energy, time, "Q = Φ t", "Φ = Q/t");
            edge(Irradiance, Exposure, time, "H = E t", "E = H/t");
        }
        edges
    }
}

/// Every quantity that `geometry` connects with a measurement of `start`, the shortest chain first; `start` itself is not
/// among them.
///
/// # Errors
/// [`Error`] where the geometry makes no sense.
pub fn derive(start: Quantity, geometry: &Geometry) -> Result<Vec<Derived>, Error> {
    geometry.check()?;
    if start == Quantity::Relative {
        return Ok(Vec::new());
    }
    let edges = geometry.edges(start);
    let mut found = vec![Derived { quantity: start, factor: 1.0, relations: Vec::new() }];
    let mut next = 0;
    while next < found.len() {
        let here = found[next].clone();
        for e in &edges {
            let step = if e.from == here.quantity {
                (e.to, e.factor, &e.forward)
            } else if e.to == here.quantity {
                (e.from, 1.0 / e.factor, &e.backward)
            } else {
                continue;
            };
            if found.iter().all(|d| d.quantity != step.0) {
                let mut relations = here.relations.clone();
                relations.push(step.2.clone());
                found.push(Derived { quantity: step.0, factor: here.factor * step.1, relations });
            }
        }
        next += 1;
    }
    found.remove(0);
    Ok(found)
}

/// Which options would connect a quantity with another, for the message that refuses to guess them.
#[must_use]
pub fn what_connects(from: Quantity, to: Quantity) -> &'static str {
    use Quantity::{Energy, Exitance, Exposure, Flux, Intensity, Irradiance, Radiance, Relative};
    match (from, to) {
        (Relative, _) | (_, Relative) => "an absolute quantity and unit (--quantity, --unit) or --scale-to",
        (Irradiance, Intensity) | (Intensity, Irradiance) => "--distance",
        (Flux, Intensity) | (Intensity, Flux) => "--cone, --solid-angle, --isotropic or --lambertian",
        (Flux, Irradiance) => "--distance with --cone, --solid-angle, --isotropic or --lambertian",
        (Irradiance, Flux) => {
            "--area (of the receiver), or --distance with --cone, --solid-angle, --isotropic or --lambertian"
        }
        (Radiance, Irradiance) | (Irradiance, Radiance) => {
            "--cone or --solid-angle of the source as seen from the receiver, or --source with --distance"
        }
        (Radiance, Intensity) | (Intensity, Radiance) => "--area",
        (Radiance, Exitance) | (Exitance, Radiance) => "--lambertian",
        (Radiance, Flux) | (Flux, Radiance) => "--area with --lambertian",
        (Exitance, Flux) | (Flux, Exitance) => "--area",
        (Flux, Energy) | (Energy, Flux) | (Irradiance, Exposure) | (Exposure, Irradiance) => "--time",
        _ => "a chain of --distance, --area, --solid-angle, --cone, --isotropic, --lambertian, --source and --time",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(start: Quantity, to: Quantity, geometry: &Geometry) -> Option<f64> {
        derive(start, geometry).expect("sound geometry").into_iter().find(|d| d.quantity == to).map(|d| d.factor)
    }

    #[test]
    fn the_named_relations_are_those_of_the_lecture() {
        // physics.md, S1 and S4: E = I cosθ/r², its inverse, L = ρE/π, M = πL, Φ = πAL, Φ = IΩ, E = LΩ⊥.
        let e = illuminance_of_point(Candela(100.0), Metre(2.0), Radian(PI / 3.0));
        assert!((e.0 - 12.5).abs() < 1e-13, "100 cd · cos 60° / 4 m²: {e}");
        assert_eq!(intensity_of_point(Lux(25.0), Metre(2.0)), Candela(100.0));
        let l = lambertian_luminance(Lux(PI), 0.5);
        assert!((l.0 - 0.5).abs() < 1e-15);
        assert!((lambertian_exitance(l).0 - 0.5 * PI).abs() < 1e-15, "M = ρE");
        assert!((lambertian_flux(l, SquareMetre(2.0)).0 - PI).abs() < 1e-15);
        assert!((uniform_flux(Candela(1.0), Steradian(4.0 * PI)).0 - 4.0 * PI).abs() < 1e-14);
        assert!((illuminance_of_uniform(l, Steradian(PI)).0 - 0.5 * PI).abs() < 1e-15, "a uniform hemisphere: E = πL");
    }

    #[test]
    fn nothing_follows_from_no_geometry() {
        for q in Quantity::ABSOLUTE {
            assert_eq!(derive(q, &Geometry::default()), Ok(Vec::new()));
        }
    }

    #[test]
    fn every_relation_runs_both_ways() {
        let g = Geometry {
            distance_m: Some(2.0),
            incidence_rad: Some(0.5),
            area_m2: Some(0.01),
            lambertian: true,
            time_s: Some(10.0),
            ..Geometry::default()
        };
        for a in Quantity::ABSOLUTE {
            for b in Quantity::ABSOLUTE {
                if a != b {
                    let (there, back) = (factor(a, b, &g).expect("connected"), factor(b, a, &g).expect("connected"));
                    assert!((there * back - 1.0).abs() < 1e-14, "{a} {b}: {there} {back}");
                }
            }
        }
    }

    #[test]
    fn closed_forms_of_the_lecture() {
        // A Lambertian emitter: Φ = πAL; a point: E = Φ/(4πr²); a cone spot: Φ = 2πI(1 − cos τ).
        let lambert = Geometry { area_m2: Some(0.5), lambertian: true, ..Geometry::default() };
        let flux = factor(Quantity::Radiance, Quantity::Flux, &lambert).expect("connected");
        assert!((flux - 0.5 * PI).abs() < 1e-15);
        let point = Geometry { distance_m: Some(3.0), isotropic: true, ..Geometry::default() };
        let e = factor(Quantity::Flux, Quantity::Irradiance, &point).expect("connected");
        assert!((e - 1.0 / (4.0 * PI * 9.0)).abs() < 1e-16);
        let spot = Geometry { cone_half_angle_rad: Some(PI / 3.0), ..Geometry::default() };
        let flux = factor(Quantity::Intensity, Quantity::Flux, &spot).expect("connected");
        assert!((flux - PI).abs() < 1e-14, "2π(1 − cos 60°) = π: {flux}");
        // A uniform sky: E = πL; the sun's disc of half-angle 0.2666° overhead: E = πL sin²τ.
        let sky = Geometry { cone_half_angle_rad: Some(PI / 2.0), ..Geometry::default() };
        let e = factor(Quantity::Radiance, Quantity::Irradiance, &sky).expect("connected");
        assert!((e - PI).abs() < 1e-15);
        // A receiver of 1 cm² under E.
        let cell = Geometry { area_m2: Some(1e-4), ..Geometry::default() };
        assert_eq!(factor(Quantity::Irradiance, Quantity::Flux, &cell), Some(1e-4));
    }

    #[test]
    fn an_extended_source_is_not_a_point() {
        // A disk as wide as far: E = πL r²/(r² + d²) = πL/2, where the point formula would say πL.
        let disk =
            Geometry { distance_m: Some(1.0), shape: Some(Shape::Disk { radius_m: 1.0 }), ..Geometry::default() };
        let e = factor(Quantity::Radiance, Quantity::Irradiance, &disk).expect("connected");
        assert!((e - PI / 2.0).abs() < 1e-15);
        assert!((factor(Quantity::Radiance, Quantity::Intensity, &disk).expect("connected") - PI).abs() < 1e-15);
    }

    #[test]
    fn contradictions_and_nonsense_are_refused() {
        for g in [
            Geometry { distance_m: Some(-1.0), ..Geometry::default() },
            Geometry { solid_angle_sr: Some(13.0), ..Geometry::default() },
            Geometry { isotropic: true, lambertian: true, ..Geometry::default() },
            Geometry { incidence_rad: Some(1.6), ..Geometry::default() },
            Geometry { shape: Some(Shape::Disk { radius_m: 1.0 }), ..Geometry::default() },
            Geometry { area_m2: Some(f64::NAN), ..Geometry::default() },
        ] {
            assert!(derive(Quantity::Irradiance, &g).is_err(), "{g:?}");
        }
    }
}
