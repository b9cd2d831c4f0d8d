//! Skies: the fifteen of the CIE standard general sky, and the traditional overcast sky.
//!
//! ```text
//! L(Z, χ)/L_z = f(χ) φ(Z) / (f(Z_s) φ(0))
//! φ(Z) = 1 + a exp(b/cos Z)      f(χ) = 1 + c (exp(d χ) − exp(d π/2)) + e cos²χ
//! ```
//!
//! with Z the angle to the zenith, Z_s that of the sun, χ the angle to the sun, L_z the zenith's luminance. The traditional overcast
//! sky (type 16) is L/L_z = (1 + 2 cos Z)/3.
//!
//! | type | sky |
//! |---|---|
//! | 1, 2 | overcast, darkening steeply to the horizon: alike all around; slightly brighter towards the sun |
//! | 3, 4 | overcast, darkening moderately: alike all around; slightly brighter towards the sun |
//! | 5 | uniform |
//! | 6, 7, 8 | partly cloudy, no gradation: slightly brighter towards the sun; brighter around it; a corona |
//! | 9, 10, 11 | partly cloudy, sun obscured; brighter around it; white-blue with a corona |
//! | 12, 13 | clear; clear and polluted |
//! | 14, 15 | cloudless and turbid with a broad corona; white-blue and turbid with a broad corona |
//! | 16 | traditional overcast |
//!
//! Parameters: the type; the directions of zenith and sun; radiance of the zenith per band, or irradiance of the sky alone on the
//! horizontal; the scene's bounding sphere. The spectrum is the same all over the sky.
//!
//! The sun itself is another light ([`super::sun`]). Directions are drawn from a net of cells that have equal solid angles.
//!
//! Limits: below the horizon there is no light; the ground is the scene's. A sun below the horizon is beyond the model.
//!
//! Source: ISO 15469:2004 / CIE S 011:2003, Table 1; the parameters are those of R. Kittler, R. Perez & S. Darula (1997).

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::bounding::BoundingSphere;
use super::cells::Cells;
use super::{Error, Light, add, sound, unit, within, write};
use crate::geometry::direction::tangents;
use crate::math::cubature::{Tolerance, rectangle};
use crate::render::ray::{Ray, Towards};

/// Parameters a, b of the gradation and c, d, e of the indicatrix, types 1 to 15.
const STANDARD: [[f64; 5]; 15] = [
    [4.0, -0.70, 0.0, -1.0, 0.0],
    [4.0, -0.70, 2.0, -1.5, 0.15],
    [1.1, -0.8, 0.0, -1.0, 0.0],
    [1.1, -0.8, 2.0, -1.5, 0.15],
    [0.0, -1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 2.0, -1.5, 0.15],
    [0.0, -1.0, 5.0, -2.5, 0.30],
    [0.0, -1.0, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.30],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

/// Rows of cells in height, columns in azimuth.
const CELLS: [usize; 2] = [48, 96];

/// Which sky.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SkyType(u8);

impl SkyType {
    /// The traditional overcast sky.
    pub const OVERCAST: Self = Self(16);

    /// By its number in the standard, 1 to 16.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn new(number: u8) -> Result<Self, Error> {
        let found = f64::from(number);
        within(
            "a type of sky",
            found,
            (1..=16).contains(&number),
            "1 to 15 (CIE standard general sky) or 16 (overcast)",
        )?;
        Ok(Self(number))
    }

    /// Its number.
    #[must_use]
    pub fn number(self) -> u8 {
        self.0
    }

    /// Luminance over that of the zenith, at the cosine of the angle to the zenith (0 or more), the angle to the sun and the sun's
    /// angle to the zenith, rad.
    #[must_use]
    pub fn relative(self, cos_zenith: f64, to_sun_rad: f64, sun_zenith_rad: f64) -> f64 {
        let Some([a, b, c, d, e]) = STANDARD.get(usize::from(self.0) - 1) else {
            return (1.0 + 2.0 * cos_zenith) / 3.0;
        };
        // b < 0: at the horizon exp(−∞) = 0.
        let gradation = |cos: f64| 1.0 + a * (b / cos).exp();
        let indicatrix = |x: f64| 1.0 + c * ((d * x).exp() - (d * 0.5 * PI).exp()) + e * x.cos().powi(2);
        indicatrix(to_sun_rad) * gradation(cos_zenith) / (indicatrix(sun_zenith_rad) * gradation(1.0))
    }
}

/// A sky as a light.
#[derive(Debug, Clone, PartialEq)]
pub struct Sky {
    sky: SkyType,
    up: DVec3,
    /// Horizontal, (east, north, up) right-handed.
    across: [DVec3; 2],
    sun: DVec3,
    sun_zenith_rad: f64,
    /// Radiance of the zenith per band.
    zenith: Box<[f64]>,
    /// Over that: irradiance on the horizontal, and ∫ L dω, sr.
    horizontal_over_zenith: f64,
    integral_over_zenith: f64,
    cells: Cells,
    scene: BoundingSphere,
}

impl Sky {
    /// Of a radiance of the zenith per band, W/(m²·sr·nm) or W/(m²·sr); `up` and `sun` (towards it) of any length. Type 16 and the
    /// overcast and uniform types 1, 3 and 5 do not depend on the sun.
    ///
    /// # Errors
    /// [`Error::Direction`]; [`Error::Value`] for a radiance below 0 or a sun below the horizon.
    pub fn from_zenith(
        sky: SkyType,
        up: DVec3,
        sun: DVec3,
        radiance: &[f64],
        scene: BoundingSphere,
    ) -> Result<Self, Error> {
        let (up, sun) = (unit("a zenith", up)?, unit("a sun", sun)?);
        let height =
            within("a sine of the sun's altitude", up.dot(sun), up.dot(sun) >= -1e-12, "0 or more: a sun that is up")?;
        let (x, y) = tangents(up);
        let mut made = Self {
            sky,
            up,
            across: [x, y],
            sun,
            sun_zenith_rad: up.cross(sun).length().atan2(height),
            zenith: sound("a radiance of the zenith (W/(m2 sr nm))", radiance)?,
            horizontal_over_zenith: 0.0,
            integral_over_zenith: 0.0,
            cells: Cells::new(1, []),
            scene,
        };
        // About the sun's azimuth the sky is symmetric: over half a turn, with cos Z = √(1 − s) and dω = ds dφ/(2 cos Z). The square
        // s = t (2 − t) takes the root away: cos Z = 1 − t.
        let towards = (sun - height * up).try_normalize().unwrap_or(x);
        let sideways = up.cross(towards);
        let mut out = [0.0; 2];
        let tolerance = Tolerance { absolute: 0.0, relative: 1e-9, evaluations: 400_000 };
        let at = |[t, turn]: [f64; 2], values: &mut [f64]| {
            let (cos, sin) = (1.0 - t, (t * (2.0 - t)).sqrt());
            let (s, c) = turn.sin_cos();
            let relative = made.relative(sin * (c * towards + s * sideways) + cos * up);
            values.copy_from_slice(&[2.0 * relative * cos, 2.0 * relative]);
        };
        rectangle(at, [0.0, 0.0], [1.0, PI], tolerance, &mut out);
        [made.horizontal_over_zenith, made.integral_over_zenith] = out;
        let [rows, columns] = CELLS;
        let weight = |row: usize, column: usize| {
            let places = [[0.5, 0.5], [0.01, 0.01], [0.99, 0.01], [0.01, 0.99], [0.99, 0.99]];
            places.into_iter().map(|place| made.relative(made.in_cell(row, column, place))).sum::<f64>()
        };
        let weights = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        made.cells = Cells::new(columns, weights.map(|(row, column)| weight(row, column)).collect::<Vec<_>>());
        Ok(made)
    }

    /// Of an irradiance per band that the sky (without the sun) makes on the horizontal, W/(m²·nm) or W/m².
    ///
    /// # Errors
    /// As [`Sky::from_zenith`].
    pub fn from_horizontal(
        sky: SkyType,
        up: DVec3,
        sun: DVec3,
        irradiance: &[f64],
        scene: BoundingSphere,
    ) -> Result<Self, Error> {
        let mut made = Self::from_zenith(sky, up, sun, irradiance, scene)?;
        for value in &mut made.zenith {
            *value /= made.horizontal_over_zenith;
        }
        Ok(made)
    }

    /// Irradiance on the horizontal over the radiance of the zenith, sr (π for the uniform sky, 7π/9 for the overcast one).
    #[must_use]
    pub fn horizontal_over_zenith(&self) -> f64 {
        self.horizontal_over_zenith
    }

    /// Radiance over that of the zenith in a direction (unit) above the horizon.
    fn relative(&self, direction: DVec3) -> f64 {
        // By the chord: the indicatrix is steepest next to the sun, where an arc cosine is worst.
        let to_sun = 2.0 * (0.5 * direction.distance(self.sun)).min(1.0).asin();
        self.sky.relative(direction.dot(self.up).max(0.0), to_sun, self.sun_zenith_rad)
    }

    /// A direction in a cell, uniform over its solid angle.
    fn in_cell(&self, row: usize, column: usize, [along, upwards]: [f64; 2]) -> DVec3 {
        let z = (row as f64 + upwards) / CELLS[0] as f64;
        let (s, c) = (TAU * (column as f64 + along) / CELLS[1] as f64).sin_cos();
        let [x, y] = self.across;
        (1.0 - z * z).sqrt() * (c * x + s * y) + z * self.up
    }

    /// Solid angle of a cell, sr.
    fn cell_solid_angle() -> f64 {
        TAU / (CELLS[0] * CELLS[1]) as f64
    }

    fn draw(&self, u: [f64; 2]) -> Option<(DVec3, f64)> {
        let drawn = self.cells.draw(u)?;
        Some((self.in_cell(drawn.row, drawn.column, drawn.place), drawn.probability / Self::cell_solid_angle()))
    }
}

impl Light for Sky {
    fn sample_towards(&self, _: DVec3, [u, v, _]: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        let (direction, pdf) = self.draw([u, v])?;
        write(arriving, &self.zenith, self.relative(direction));
        Some(Towards { direction, distance: f64::INFINITY, pdf, delta: false })
    }

    fn pdf_towards(&self, _: DVec3, direction: DVec3) -> f64 {
        let z = direction.dot(self.up);
        if z < 0.0 {
            return 0.0;
        }
        let turn = direction.dot(self.across[1]).atan2(direction.dot(self.across[0])) / TAU;
        let index = |x: f64, n: usize| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the net")]
            let index = (x * n as f64) as usize;
            index.min(n - 1)
        };
        let (row, column) = (index(z, CELLS[0]), index(turn.rem_euclid(1.0), CELLS[1]));
        self.cells.probability(row, column) / Self::cell_solid_angle()
    }

    fn add_radiance(&self, direction: DVec3, radiance: &mut [f64]) {
        if direction.dot(self.up) >= 0.0 {
            add(radiance, &self.zenith, self.relative(direction));
        }
    }

    fn emit(&self, [u, v, s, t, _]: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        let (direction, pdf) = self.draw([u, v])?;
        write(flux, &self.zenith, self.relative(direction) * self.scene.cross_section() / pdf);
        Some(self.scene.ray_from(direction, [s, t]))
    }

    fn emission_density(&self, from: DVec3, direction: DVec3, _: f64) -> f64 {
        self.pdf_towards(from, direction) * self.scene.density_at(from, direction)
    }

    fn flux(&self, flux: &mut [f64]) {
        write(flux, &self.zenith, self.integral_over_zenith * self.scene.cross_section());
    }

    fn importance(&self, _: DVec3) -> f64 {
        self.integral_over_zenith * self.zenith.iter().sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;

    const UP: DVec3 = DVec3::new(0.6, 0.0, 0.8);

    fn scene() -> BoundingSphere {
        BoundingSphere::new(DVec3::ZERO, 3.0).expect("a sphere")
    }

    /// A sun at that altitude, some azimuth, about [`UP`].
    fn sun(altitude_deg: f64) -> DVec3 {
        let (x, y) = tangents(UP);
        let (sin, cos) = altitude_deg.to_radians().sin_cos();
        cos * (0.8 * x - 0.6 * y) + sin * UP
    }

    fn sky(number: u8, altitude_deg: f64) -> Sky {
        let kind = SkyType::new(number).expect("a type");
        Sky::from_zenith(kind, UP, sun(altitude_deg), &[2.0, 5.0], scene()).expect("a sky")
    }

    /// `CIE_overcast_Eh_over_Lz` = 7π/9 and `CIE_overcast_Ev_over_Lz` = π/6 + 4/9; the uniform sky: π and π/2.
    #[test]
    fn overcast_and_uniform_skies_are_the_closed_forms() {
        for (number, horizontal, vertical, whole) in
            [(16, 7.0 * PI / 9.0, PI / 6.0 + 4.0 / 9.0, 4.0 * PI / 3.0), (5, PI, 0.5 * PI, TAU)]
        {
            let sky = sky(number, 30.0);
            assert!((sky.horizontal_over_zenith() / horizontal - 1.0).abs() < 1e-9, "{number}");
            assert!((sky.integral_over_zenith / whole - 1.0).abs() < 1e-9, "{number}");
            check::irradiance(&sky, DVec3::ZERO, UP, 2.0 * horizontal);
            check::irradiance(&sky, DVec3::ZERO, DVec3::Y, 2.0 * vertical);
        }
    }

    /// The CIE standard clear sky (CIE 22-1973; as Radiance's `gensky` has it), which the general sky holds as its type 12:
    /// (0.91 + 10 e^(−3χ) + 0.45 cos²χ)(1 − e^(−0.32/cos Z)) over its value at the zenith, where 0.91 is 1 − 10 e^(−3π/2) in print.
    #[test]
    fn type_12_is_the_standard_clear_sky() {
        let f = |x: f64| 0.91 + 10.0 * (-3.0 * x).exp() + 0.45 * x.cos().powi(2);
        let sun_zenith = 1.1;
        for (cos, chi) in [(0.9, 0.3), (0.2, 1.0), (0.5, 2.0), (0.01, 0.1)] {
            let expected = f(chi) * (1.0 - f64::exp(-0.32 / cos)) / (f(sun_zenith) * (1.0 - f64::exp(-0.32)));
            let relative = SkyType(12).relative(cos, chi, sun_zenith);
            assert!((relative / expected - 1.0).abs() < 0.005 / 0.91, "{relative} {expected}");
        }
    }

    /// What the standard calls them: steep gradation is 1 : 3 from horizon to zenith, moderate 2 : 3 (S. Darula & R. Kittler 2002).
    #[test]
    fn gradations_are_those_of_the_names() {
        let horizon = |number| SkyType(number).relative(0.0, 0.5 * PI, 0.5 * PI);
        assert!((horizon(1) - 1.0 / 3.0).abs() < 0.005 && (horizon(3) - 2.0 / 3.0).abs() < 0.005);
        assert!((6..=8).all(|number| (horizon(number) - 1.0).abs() < 1e-12));
        for number in 1..=16 {
            assert!((SkyType(number).relative(1.0, 0.7, 0.7) - 1.0).abs() < 1e-15, "{number}");
        }
    }

    #[test]
    fn draws_follow_their_density_and_make_the_flux() {
        for (number, altitude_deg) in [(1, 0.0), (7, 20.0), (12, 60.0), (15, 5.0), (14, 90.0), (16, 0.0)] {
            let sky = sky(number, altitude_deg);
            check::density(&sky, DVec3::ZERO, UP, 1.0, 48);
            check::emission(&sky, 2);
            check::irradiance(&sky, DVec3::ZERO, UP, 2.0 * sky.horizontal_over_zenith());
        }
    }

    #[test]
    fn horizontal_irradiance_is_what_was_asked_for() {
        for number in 1..=16 {
            let kind = SkyType::new(number).expect("a type");
            let sky = Sky::from_horizontal(kind, UP, sun(35.0), &[10_000.0], scene()).expect("a sky");
            check::irradiance(&sky, DVec3::ZERO, UP, 10_000.0);
        }
    }

    #[test]
    fn below_the_horizon_there_is_nothing_and_bad_values_are_refused() {
        let sky = sky(8, 10.0);
        let mut radiance = [0.0; 2];
        sky.add_radiance(-UP, &mut radiance);
        assert_eq!((radiance, sky.pdf_towards(DVec3::ZERO, -UP)), ([0.0; 2], 0.0));
        assert!(SkyType::new(0).is_err() && SkyType::new(17).is_err());
        let make = |sun, radiance| Sky::from_zenith(SkyType::OVERCAST, UP, sun, &[radiance], scene());
        assert!(make(-UP, 1.0).is_err() && make(UP, -1.0).is_err() && make(DVec3::ZERO, 1.0).is_err());
    }
}
