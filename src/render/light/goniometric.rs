//! A luminaire as a light: the intensities of a photometric file, in its place, with its spectrum.
//!
//! ```text
//! E = I(ω) cosθ / r²        I_b(ω) = δ I(ω) s_b
//! ```
//!
//! with the table I(ω) (cd, W/sr), the dimming δ and, per band b, the watts per steradian (and nanometre) that one unit of the table
//! stands for, s_b; or one table per band, where a file has angular spectra (TM-33). Between its entries a table is interpolated as it
//! declares, in its own angles (types A, B, C), and it is zero beyond them.
//!
//! Parameters: the [`Distribution`] and its [`Placement`]; s_b, from a relative spectrum by [`per_unit`]; the flat luminous
//! opening, if the light is to be more than a point.
//!
//! **The opening.** A file knows only I(ω), the far field. With an [`Opening`] every part of it shines alike, L(ω) = I(ω)/(A cosθ),
//! the assumption of all near-field calculation with photometric files (five-times rule, EN 13032-1). Points of the opening are drawn
//! evenly, each with the whole I(ω): the cosines at the lamp cancel, E = (1/A) ∫ I(ω) cosθ/r² dA. Soft shadows and light close by are
//! then right; mirrors and cameras do not show the opening. A surface that is to be seen takes its radiance from
//! [`Goniometric::radiance`].
//!
//! Rays are emitted by the table's own cells: a cell in proportion to its solid angle times the mean of its corners, a direction in it
//! uniform over solid angle, weighted with the exact I(ω). The flux is that of [`Distribution::total_flux`].
//!
//! Limits: no negative intensities; a Type B table of a single plane does not say how far it reaches, and is refused. Close to an
//! opening the 1/r² of its points makes noise. An opening of some height is no flat one.
//!
//! Source: ANSI/IES LM-63-19, LM-75-01 (angles), TM-33-18; CIE 121-1996.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};

use super::cells::Cells;
use super::{Error, Light, near_bound, sound, way, write};
use crate::luminaire::placement::Placement;
use crate::luminaire::{AngularSpectra, Body, Distribution, Shape, Symmetry, System};
use crate::math::sampling::disk;
use crate::render::bands::{Bands, Width};
use crate::render::ray::{Ray, Towards};
use crate::spectrum::Sampling;

/// What one unit of a table (cd) stands for, per band: the relative spectrum, scaled so that Σ weight · s = 1. The weights are those
/// of the table's quantity, K_m V(λ) Δλ for cd (K_m V(λ) in a line band), Δλ for W/sr.
///
/// # Errors
/// [`Error::Count`]; [`Error::Value`] for a spectrum that has nothing of that quantity.
pub fn per_unit(relative: &[f64], weights: &[f64]) -> Result<Vec<f64>, Error> {
    if relative.len() != weights.len() {
        return Err(Error::Count { what: "weights of bands", found: weights.len(), expected: relative.len() });
    }
    let content: f64 = relative.iter().zip(weights).map(|(s, w)| s * w).sum();
    let sound = content > 0.0 && (1.0 / content).is_finite();
    let content = super::within("a weighted sum of the spectrum", content, sound, "a spectrum with such content")?;
    Ok(relative.iter().map(|s| s / content).collect())
}

/// A flat luminous opening in the luminaire's x-y plane, its middle at the photometric centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Opening {
    /// Half of its extents along x (C0) and y (C90), m.
    Rectangle(DVec2),
    /// Semi-axes along x and y, m.
    Ellipse(DVec2),
}

impl Opening {
    /// That of a luminaire; `None` where it is a point or not flat.
    #[must_use]
    pub fn of(body: &Body) -> Option<Self> {
        let half = 0.5 * DVec2::new(body.width_m, body.length_m);
        match body.shape {
            _ if body.height_m > 0.0 || half.min_element() <= 0.0 => None,
            Shape::Rectangle => Some(Self::Rectangle(half)),
            Shape::Round => Some(Self::Ellipse(half)),
            _ => None,
        }
    }

    /// A point of it, uniform over its area, from two uniform numbers.
    fn point(self, [u, v]: [f64; 2]) -> DVec3 {
        match self {
            Self::Rectangle(half) => (half * DVec2::new(2.0 * u - 1.0, 2.0 * v - 1.0)).extend(0.0),
            Self::Ellipse(semi) => (semi * disk([u, v])).extend(0.0),
        }
    }

    /// The farthest of its points from the middle, m.
    fn radius(self) -> f64 {
        match self {
            Self::Rectangle(half) => half.length(),
            Self::Ellipse(semi) => semi.max_element(),
        }
    }
}

/// How the bands follow from the tables.
#[derive(Debug, Clone, PartialEq)]
enum Spectra {
    /// One table, and what its unit stands for in each band.
    Shared(Box<[f64]>),
    /// A table per band, of the same angles.
    PerBand(Vec<Distribution>),
}

/// A luminaire as a light.
#[derive(Debug, Clone, PartialEq)]
pub struct Goniometric {
    position: DVec3,
    to_room: DMat3,
    /// The table; where there is one per band, their sum.
    table: Distribution,
    spectra: Spectra,
    /// Horizontal angles of the whole, symmetric copies unfolded, degrees: the columns of the cells. Rows are vertical angles.
    horizontal_deg: Vec<f64>,
    cells: Cells,
    opening: Option<Opening>,
    flux: Box<[f64]>,
}

impl Goniometric {
    /// A table in its place, with what its unit stands for in each band (see [`per_unit`]), W/(sr·nm) or W/sr.
    ///
    /// # Errors
    /// [`Error::Value`] for a negative intensity, [`Error::OnePlane`].
    pub fn new(table: Distribution, placement: &Placement, per_unit: &[f64]) -> Result<Self, Error> {
        let per_unit: Vec<f64> = per_unit.iter().map(|s| s * placement.dimming()).collect();
        let per_unit = sound("a spectral intensity (W/(sr nm))", &per_unit)?;
        let flux = per_unit.iter().map(|s| s * table.total_flux()).collect();
        Self::build(table, placement, Spectra::Shared(per_unit), flux)
    }

    /// Spectra by direction in their place. Bands that sample a density take it from the straight line between the two wavelengths
    /// around them, and nothing beyond the first and the last; a line band takes the line of its wavelength.
    ///
    /// # Errors
    /// [`Error::Value`] for a negative intensity, [`Error::OnePlane`].
    pub fn spectral(spectra: &AngularSpectra, placement: &Placement, bands: &Bands) -> Result<Self, Error> {
        let band = |wavelength_nm, width: &Width| {
            let weights = match (width, spectra.sampling()) {
                (Width::Density { .. }, Sampling::Density) => between(spectra.grid().wavelengths_nm(), wavelength_nm),
                (Width::Line, Sampling::Lines) => {
                    spectra.grid().wavelengths_nm().iter().map(|w| f64::from(u8::from(*w == wavelength_nm))).collect()
                }
                _ => vec![0.0; spectra.grid().len()],
            };
            spectra.weighted(&weights).map(|table| table.scaled(placement.dimming()))
        };
        let beyond = |_| Error::Value { what: "a spectral intensity", found: f64::INFINITY, expected: "finite sums" };
        let tables: Vec<Distribution> = (bands.wavelengths_nm().iter().zip(bands.widths()))
            .map(|(wavelength_nm, width)| band(*wavelength_nm, width))
            .collect::<Result<_, _>>()
            .map_err(beyond)?;
        let sums = (0..spectra.directions()).map(|i| tables.iter().map(|t| t.values()[i]).sum()).collect();
        let table = spectra.frame().with_values(sums).map_err(beyond)?;
        let flux = tables.iter().map(Distribution::total_flux).collect();
        Self::build(table, placement, Spectra::PerBand(tables), flux)
    }

    fn build(table: Distribution, placement: &Placement, spectra: Spectra, flux: Box<[f64]>) -> Result<Self, Error> {
        let tables = match &spectra {
            Spectra::Shared(_) => std::slice::from_ref(&table),
            Spectra::PerBand(tables) => tables,
        };
        for table in tables {
            sound("an intensity", table.values())?;
        }
        if table.system() == System::TypeB && table.symmetry() == Symmetry::Rotational {
            return Err(Error::OnePlane);
        }
        let horizontal_deg = unfolded(&table);
        let corners = |rows: &[f64], columns: &[f64]| {
            let sum: f64 = rows.iter().flat_map(|v| columns.iter().map(|h| table.at(*h, *v))).sum();
            0.25 * sum * solid_angle(table.system(), [columns[0], columns[1]], [rows[0], rows[1]])
        };
        let weights = (table.vertical_deg().windows(2))
            .flat_map(|rows| horizontal_deg.windows(2).map(move |columns| corners(rows, columns)));
        let cells = Cells::new(horizontal_deg.len() - 1, weights);
        let (position, to_room) = (placement.position_m(), placement.to_room());
        Ok(Self { position, to_room, table, spectra, horizontal_deg, cells, opening: None, flux })
    }

    /// The same light, shining from an opening.
    #[must_use]
    pub fn with_opening(self, opening: Opening) -> Self {
        Self { opening: Some(opening), ..self }
    }

    /// Writes the radiance, W/(m²·sr·nm) or W/(m²·sr), of an opening that shows `projected_area_m2` (A |cosθ| for a flat one of area
    /// A) in `direction` (unit, world, away from the luminaire): L(ω) = I(ω)/A_p(ω), the same from every part; zero where it shows none.
    pub fn radiance(&self, direction: DVec3, projected_area_m2: f64, radiance: &mut [f64]) {
        let (h, v) = self.table.angles(self.to_room.transpose() * direction);
        let factor = if projected_area_m2 > 0.0 { 1.0 / projected_area_m2 } else { 0.0 };
        self.intensity(h, v, factor, radiance);
    }

    /// Writes a factor times the greatest intensity of the table, W/(sr·nm) or W/sr; zero for spectra by direction, which have no one
    /// peak.
    pub fn peak_intensity(&self, factor: f64, out: &mut [f64]) {
        match &self.spectra {
            Spectra::Shared(per_unit) => write(out, per_unit, factor * self.table.peak().0),
            Spectra::PerBand(_) => out.fill(0.0),
        }
    }

    /// The intensity in `direction` (unit, world, away from the luminaire) over the greatest; 0 where there is none.
    #[must_use]
    pub fn relative_intensity(&self, direction: DVec3) -> f64 {
        let peak = self.table.peak().0;
        if peak > 0.0 { self.table.towards(self.to_room.transpose() * direction) / peak } else { 0.0 }
    }

    /// The flux over the greatest intensity, sr.
    #[must_use]
    pub fn flux_per_peak(&self) -> f64 {
        let peak = self.table.peak().0;
        if peak > 0.0 { self.table.total_flux() / peak } else { 0.0 }
    }

    /// Writes a factor times the intensity per band at angles of the table, degrees.
    fn intensity(&self, horizontal_deg: f64, vertical_deg: f64, factor: f64, out: &mut [f64]) {
        match &self.spectra {
            Spectra::Shared(per_unit) => write(out, per_unit, factor * self.table.at(horizontal_deg, vertical_deg)),
            Spectra::PerBand(tables) => {
                for (out, table) in out.iter_mut().zip(tables) {
                    *out = factor * table.at(horizontal_deg, vertical_deg);
                }
            }
        }
    }

    /// A point of the light in the room.
    fn origin(&self, u: [f64; 2]) -> DVec3 {
        self.opening.map_or(self.position, |opening| self.position + self.to_room * opening.point(u))
    }
}

impl Light for Goniometric {
    fn sample_towards(&self, from: DVec3, [u, v, _]: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let (direction, distance, inverse_square) = way(from, self.origin([u, v]))?;
        let (h, v) = self.table.angles(self.to_room.transpose() * -direction);
        self.intensity(h, v, inverse_square, arriving);
        let shines = arriving.iter().any(|e| *e > 0.0);
        shines.then_some(Towards { direction, distance, pdf: 1.0, delta: true })
    }

    fn emit(&self, [u, v, s, t, _]: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        let drawn = self.cells.draw([u, v])?;
        let side = |angles: &[f64], index: usize| [angles[index], angles[index + 1]];
        let (columns, rows) = (side(&self.horizontal_deg, drawn.column), side(self.table.vertical_deg(), drawn.row));
        let system = self.table.system();
        let (h, v) = within_cell(system, columns, rows, drawn.place);
        self.intensity(h, v, solid_angle(system, columns, rows) / drawn.probability, flux);
        let direction = self.to_room * self.table.direction(h, v);
        Some(Ray { origin: self.origin([s, t]), direction })
    }

    /// As if rays were drawn in proportion to the intensity itself, not to the mean of its corners in a cell.
    fn emission_density(&self, _: DVec3, direction: DVec3, distance: f64) -> f64 {
        let flux = self.flux_per_peak();
        if flux > 0.0 { self.relative_intensity(-direction) / flux / distance / distance } else { 0.0 }
    }

    fn is_one_direction(&self) -> bool {
        self.opening.is_none()
    }

    fn flux(&self, flux: &mut [f64]) {
        flux.copy_from_slice(&self.flux);
    }

    fn importance(&self, from: DVec3) -> f64 {
        let unit = match &self.spectra {
            Spectra::Shared(per_unit) => per_unit,
            Spectra::PerBand(_) => &[1.0][..],
        };
        match self.opening {
            None => {
                let towards = self.to_room.transpose() * (from - self.position);
                near_bound(unit, self.table.towards(towards), from, self.position)
            }
            // Any part of the opening may shine in any direction.
            Some(opening) => {
                let nearest = (from.distance(self.position) - opening.radius()).max(0.1 * opening.radius());
                self.table.peak().0 * unit.iter().sum::<f64>() / (nearest * nearest)
            }
        }
    }
}

/// Weights of the wavelengths with which a straight line between neighbours is read at one.
fn between(wavelengths_nm: &[f64], at_nm: f64) -> Vec<f64> {
    let mut weights = vec![0.0; wavelengths_nm.len()];
    let above = wavelengths_nm.partition_point(|w| *w < at_nm);
    if wavelengths_nm.get(above) == Some(&at_nm) {
        weights[above] = 1.0;
    } else if above > 0 && above < wavelengths_nm.len() {
        let (low, high) = (wavelengths_nm[above - 1], wavelengths_nm[above]);
        weights[above] = (at_nm - low) / (high - low);
        weights[above - 1] = 1.0 - weights[above];
    }
    weights
}

/// All horizontal angles of a table with what its symmetry stands for, ascending, degrees.
fn unfolded(table: &Distribution) -> Vec<f64> {
    let own = table.horizontal_deg().to_vec();
    let mirrored = |angles: Vec<f64>, about: f64| -> Vec<f64> {
        let mut both: Vec<f64> = angles.iter().flat_map(|a| [*a, 2.0 * about - a]).collect();
        both.sort_by(f64::total_cmp);
        // Files print degrees to at most four decimals.
        both.dedup_by(|a, b| (*a - *b).abs() <= 1e-6);
        both
    };
    match (table.system(), table.symmetry()) {
        (_, Symmetry::Rotational) => vec![0.0, 360.0],
        (_, Symmetry::None) => own,
        (System::TypeC, Symmetry::Quadrant) => mirrored(mirrored(own, 90.0), 180.0),
        (System::TypeC, Symmetry::BilateralC90) => mirrored(own, 270.0),
        (System::TypeC, Symmetry::BilateralC0) => mirrored(own, 180.0),
        _ => mirrored(own, 0.0),
    }
}

/// Of the two angles the latitude, whose measure is not even: γ of type C, V of type A, H of type B.
fn latitude(system: System, columns: [f64; 2], rows: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    match system {
        System::TypeB => (columns, rows),
        System::TypeA | System::TypeC => (rows, columns),
    }
}

/// Height on the unit sphere, from its lower pole for γ (by half angles, which keep their digits at the pole), else from its equator.
fn height(system: System, latitude_deg: f64) -> f64 {
    match system {
        System::TypeC => 2.0 * (0.5 * latitude_deg.to_radians()).sin().powi(2),
        System::TypeA | System::TypeB => latitude_deg.to_radians().sin(),
    }
}

/// Solid angle of a cell, sr.
fn solid_angle(system: System, columns: [f64; 2], rows: [f64; 2]) -> f64 {
    let (latitude, longitude) = latitude(system, columns, rows);
    let [low, high] = latitude.map(|a| height(system, a));
    TAU * (longitude[1] - longitude[0]) / 360.0 * (high - low)
}

/// Horizontal and vertical angle of a place in a cell, degrees, even in solid angle.
fn within_cell(system: System, columns: [f64; 2], rows: [f64; 2], [along, across]: [f64; 2]) -> (f64, f64) {
    let lerp = |[low, high]: [f64; 2], t: f64| low + t * (high - low);
    let even = |ends: [f64; 2], t: f64| {
        let height = lerp(ends.map(|a| height(system, a)), t);
        let angle = if system == System::TypeC { 2.0 * (0.5 * height).sqrt().asin() } else { height.asin() };
        angle.to_degrees().clamp(ends[0], ends[1])
    };
    match system {
        System::TypeB => (even(columns, along), lerp(rows, across)),
        System::TypeA | System::TypeC => (lerp(columns, along), even(rows, across)),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;
    use std::sync::Arc;

    use super::super::check;
    use super::super::point::Point;
    use super::*;
    use crate::luminaire::grid::{Placed, Plane, PointsAt, Receiver, Settings, illuminance};
    use crate::luminaire::placement::Orientation;
    use crate::luminaire::{Interpolation, Luminaire};
    use crate::math::random::Stream;
    use crate::spectrum::Grid;

    fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
        (0..=((to - from) / step).round() as usize).map(|i| from + step * i as f64).collect()
    }

    fn table(system: System, symmetry: Symmetry, horizontal: Vec<f64>, vertical: Vec<f64>) -> Distribution {
        let value =
            |h: f64, v: f64| 100.0 + 50.0 * (h.to_radians() + 0.3).sin() * (0.7 * v.to_radians()).cos() + 0.2 * v;
        let values =
            horizontal.iter().flat_map(|h| vertical.iter().map(|v| value(*h, *v)).collect::<Vec<_>>()).collect();
        Distribution::new(system, symmetry, horizontal, vertical, values).expect("a sound table")
    }

    /// One of every system and symmetry, none of them symmetric beyond what it says; one reaches over a part of the sphere.
    fn tables() -> Vec<Distribution> {
        let (all, half) = (steps(0.0, 180.0, 15.0), steps(-90.0, 90.0, 10.0));
        let c = |symmetry, from, to| table(System::TypeC, symmetry, steps(from, to, 22.5), all.clone());
        vec![
            c(Symmetry::None, 0.0, 360.0),
            c(Symmetry::Quadrant, 0.0, 90.0),
            c(Symmetry::BilateralC0, 0.0, 180.0),
            c(Symmetry::BilateralC90, 90.0, 270.0),
            table(System::TypeC, Symmetry::Rotational, vec![0.0], steps(20.0, 70.0, 10.0)),
            c(Symmetry::None, 0.0, 360.0).with_interpolation(Interpolation::MonotoneCubic),
            table(System::TypeA, Symmetry::None, steps(-90.0, 60.0, 10.0), half.clone()),
            table(System::TypeB, Symmetry::None, steps(-90.0, 60.0, 10.0), half.clone()),
            table(System::TypeB, Symmetry::Quadrant, steps(0.0, 50.0, 10.0), half),
        ]
    }

    fn luminaire(distribution: Distribution, opening: Option<Body>) -> Luminaire {
        Luminaire { opening, ..Luminaire::of(distribution) }
    }

    /// Turned about each of its own axes, and about all.
    fn placements() -> Vec<Placement> {
        let at = |rotation_deg, tilt_deg, towards_c_deg, spin_deg| {
            let o = Orientation::Angles { rotation_deg, tilt_deg, towards_c_deg, spin_deg };
            Placement::new(DVec3::new(0.3, -0.2, 2.5), o, 0.8).expect("a placement")
        };
        vec![
            at(0.0, 0.0, 0.0, 0.0),
            at(0.0, 0.0, 0.0, 37.0),
            at(0.0, 50.0, 0.0, 0.0),
            at(0.0, 50.0, 90.0, 0.0),
            at(25.0, 65.0, 30.0, 10.0),
        ]
    }

    fn plane() -> Plane {
        let sides = [DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 0.0)];
        Plane::new(DVec3::new(-2.0, -1.5, 0.0), sides, [5, 4], PointsAt::Centres).expect("a plane")
    }

    #[test]
    fn lamps_light_a_grid_the_right_way_round_as_points() {
        let settings = Settings { near_ratio: 0.0, ..Settings::default() };
        for (table, placement) in
            tables().into_iter().flat_map(|t| placements().into_iter().map(move |p| (t.clone(), p)))
        {
            let lamp = luminaire(table.clone(), None);
            let placed = [Placed { luminaire: &lamp, placement }];
            let grid = illuminance(&placed, &plane(), &Receiver::Planar(DVec3::Z), &settings).expect("a grid");
            let light = Goniometric::new(table, &placement, &[1.0, 0.5]).expect("a light");
            for (i, expected) in grid.values.iter().enumerate() {
                let e = check::irradiance_at(&light, plane().point_m(i), DVec3::Z);
                assert!((e[0] - expected).abs() <= 1e-12 * expected && e[1] == 0.5 * e[0], "{e:?} {expected}");
            }
        }
    }

    #[test]
    fn emission_is_the_intensity_and_the_flux_of_the_table() {
        for table in tables() {
            let placement = placements()[4];
            let light = Goniometric::new(table.clone(), &placement, &[1.0, 0.25]).expect("a light");
            // 2e-6: the quadrature of `total_flux` for cubic tables.
            check::emission(&light, 2);
            let local = placement.to_room().transpose();
            check::emitted_intensity(&light, placement.position_m(), |d| 0.8 * table.towards(local * d));
        }
    }

    /// A needle of a beam in a table of 10° steps, and one with a bright pole: no cell is too dark for what is in it.
    #[test]
    fn steep_tables_are_emitted_too() {
        let mut values = vec![0.0; 19];
        (values[0], values[18]) = (1e6, 10.0);
        let table = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], steps(0.0, 180.0, 10.0), values)
            .expect("a table");
        let light = Goniometric::new(table.clone(), &placements()[0], &[1.0]).expect("a light");
        check::emission(&light, 1);
    }

    #[test]
    fn a_point_a_small_area_and_a_lamp_of_the_same_intensity_agree() {
        let (vertical, place) = (steps(0.0, 180.0, 30.0), placements()[0]);
        let flat = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vertical, vec![70.0; 7]);
        let lamp = Goniometric::new(flat.expect("a table"), &place, &[1.0]).expect("a light");
        let point = Point::new(place.position_m(), &[0.8 * 70.0]).expect("a light");
        let from = DVec3::new(1.0, 0.7, 0.0);
        let expected = check::irradiance_at(&point, from, DVec3::Z)[0];
        assert!((check::irradiance_at(&lamp, from, DVec3::Z)[0] / expected - 1.0).abs() < 1e-14);
        // An opening of half extent s seen from r deviates by no more than 3 s/r in 1/r² and cosθ.
        let half = 1e-6;
        let small = lamp.with_opening(Opening::Rectangle(DVec2::splat(half)));
        let e = check::irradiance_at(&small, from, DVec3::Z)[0];
        assert!((e / expected - 1.0).abs() < 3.0 * half, "{e} {expected}");
        // Its radiance times the area it shows is the intensity again.
        let mut radiance = [0.0];
        small.radiance(DVec3::new(0.6, 0.0, -0.8), 4.0 * half * half * 0.8, &mut radiance);
        assert!((radiance[0] * 4.0 * half * half * 0.8 / 56.0 - 1.0).abs() < 1e-14);
        small.radiance(DVec3::X, 0.0, &mut radiance);
        assert_eq!(radiance, [0.0]);
    }

    /// L = 1000, R = 0.5 m, h = 1 m: E = π L R²/(R² + h²) on the axis (`disk_L1000_R0.5_h1_d0`), with the table of a Lambertian disk
    /// in steps of 1°, whose straight lines lie below the cosine by no more than (1°)²/8.
    #[test]
    fn a_lambertian_opening_is_the_disk_of_the_closed_form() {
        let intensity = 1000.0 * PI * 0.25;
        let gammas = steps(0.0, 90.0, 1.0);
        let values = gammas.iter().map(|g| intensity * g.to_radians().cos()).collect();
        let table = Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], gammas, values).expect("a table");
        let place = Placement::new(DVec3::Z, Orientation::DOWN, 1.0).expect("a placement");
        let light = Goniometric::new(table, &place, &[1.0]).expect("a light");
        let light = light.with_opening(Opening::Ellipse(DVec2::splat(0.5)));
        for (d, expected) in [(0.0, 628.318_530_717_958_7), (0.5, 460.075_592_255_305_1), (1.0, 206.963_188_380_936_54)]
        {
            let n = 300;
            let net = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
            let mut sum = 0.0;
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut arriving = [0.0];
                let t = light.sample_towards(DVec3::X * d, [net(i), net(j), 0.5], &mut arriving).expect("light");
                sum += arriving[0] * t.direction.z;
            }
            let e = sum / f64::from(n * n);
            assert!((e / expected - 1.0).abs() < 1.0_f64.to_radians().powi(2) / 8.0 + 1e-5, "{d}: {e} {expected}");
        }
    }

    /// Both read the near field from the same assumption, the grid by subdivision, the light by random points.
    #[test]
    fn openings_of_all_shapes_light_a_grid_as_subdivided_ones() {
        let settings = Settings { tolerance: 1e-7, ..Settings::default() };
        for shape in [Shape::Rectangle, Shape::Round] {
            let body = Body { shape, length_m: 1.2, width_m: 0.6, height_m: 0.0 };
            let (table, placement) = (tables().swap_remove(0), placements()[4]);
            let lamp = luminaire(table.clone(), Some(body));
            let placed = [Placed { luminaire: &lamp, placement }];
            let grid = illuminance(&placed, &plane(), &Receiver::Planar(DVec3::Z), &settings).expect("a grid");
            let light = Goniometric::new(table, &placement, &[1.0]).expect("a light");
            let light = light.with_opening(Opening::of(&body).expect("flat"));
            check::emission(&light, 1);
            for i in [0, 7, 19] {
                let (mut sum, mut squares, n) = (0.0, 0.0, 20_000);
                let mut stream = Stream::new(5, i as u64);
                for _ in 0..n {
                    let mut arriving = [0.0];
                    let t = light.sample_towards(plane().point_m(i), stream.uniforms(), &mut arriving).expect("light");
                    let e = arriving[0] * t.direction.z;
                    (sum, squares) = (sum + e, squares + e * e);
                }
                let mean = sum / f64::from(n);
                let error = ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
                assert!(
                    (mean - grid.values[i]).abs() < 4.5 * error + 1e-6 * mean,
                    "{mean} ± {error} {}",
                    grid.values[i]
                );
            }
        }
        assert_eq!(Opening::of(&Body { shape: Shape::Sphere, length_m: 1.0, width_m: 1.0, height_m: 0.0 }), None);
    }

    #[test]
    fn spectra_by_direction_and_a_shared_one_agree_where_they_are_the_same() {
        let shape = tables().swap_remove(0);
        let grid = Arc::new(Grid::new(vec![500.0, 600.0]).expect("a grid"));
        let spectra = AngularSpectra::new(grid, &[shape.scaled(1.0), shape.scaled(3.0)]).expect("two tables");
        // Midpoints 525 and 575 nm: 1.5 and 2.5 by the straight line.
        let bands = Bands::nodes(vec![525.0, 575.0], 50.0);
        let by_direction = Goniometric::spectral(&spectra, &placements()[3], &bands).expect("a light");
        let shared = Goniometric::new(shape, &placements()[3], &[1.5, 2.5]).expect("a light");
        let from = DVec3::new(0.4, 0.1, 0.0);
        let (a, b) =
            (check::irradiance_at(&by_direction, from, DVec3::Z), check::irradiance_at(&shared, from, DVec3::Z));
        assert!(a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-14), "{a:?} {b:?}");
        check::emission(&by_direction, 2);
        assert_eq!(between(&[500.0, 600.0], 499.0), [0.0, 0.0]);
        assert_eq!(between(&[500.0, 600.0], 600.0), [0.0, 1.0]);
    }

    #[test]
    fn the_square_law_holds_from_1e_8_to_1e8_metres() {
        let direction = DVec3::new(0.48, -0.6, -0.64);
        let table = tables().swap_remove(0);
        let place = Placement::new(DVec3::ZERO, Orientation::DOWN, 1.0).expect("a placement");
        let light = Goniometric::new(table.clone(), &place, &[1.0]).expect("a light");
        for exponent in -8..=8 {
            let r = 10.0_f64.powi(exponent);
            let e = check::irradiance_at(&light, r * direction, -direction)[0] * r * r;
            assert!((e / table.towards(direction) - 1.0).abs() < 1e-13, "{r}: {e}");
            assert!(light.importance(r * direction).is_finite());
        }
        assert_eq!(light.sample_towards(DVec3::ZERO, [0.5; 3], &mut [0.0]), None);
    }

    #[test]
    fn units_are_scaled_and_bad_tables_refused() {
        let s = per_unit(&[1.0, 3.0], &[683.0 * 10.0, 68.3 * 10.0]).expect("a scale");
        assert!((s[0] * 6830.0 + s[1] * 683.0 - 1.0).abs() < 1e-15);
        assert!(per_unit(&[1.0], &[0.0]).is_err() && per_unit(&[1.0], &[]).is_err());
        let place = placements()[0];
        let negative = tables()[0].with_values(vec![-1.0; tables()[0].values().len()]).expect("a table");
        assert!(Goniometric::new(negative, &place, &[1.0]).is_err());
        let one = table(System::TypeB, Symmetry::Rotational, vec![0.0], steps(-90.0, 90.0, 10.0));
        assert_eq!(Goniometric::new(one, &place, &[1.0]), Err(Error::OnePlane));
        assert!(Goniometric::new(tables().swap_remove(0), &place, &[f64::NAN]).is_err());
    }
}
