//! The sun: where it stands by date, time and place, and its disc as a light.
//!
//! Position by the low-accuracy method of J. Meeus, *Astronomical Algorithms*, 2nd ed. (1998): chapters 7 (Julian day), 12 (sidereal
//! time), 13 (horizontal coordinates), 22 (obliquity, nutation to its largest term), 25 (the sun, ±0.01°), with the sun's parallax.
//! For 1950 to 2050 zenith angle and azimuth are within 0.01° of the almanac; UT1 is taken for UTC (0.004°), and terrestrial time
//! is 69 s ahead of it (as between 2015 and 2030; ten seconds more or less are 1e-4°).
//!
//! Refraction, if asked for, lifts the sun by
//!
//! ```text
//! R = P/1010 · 283/(273 + T) · 1.02′ / tan(h + 10.3/(h + 5.11))       (h in degrees, P in hPa, T in °C)
//! ```
//!
//! (Sæmundsson 1986, Meeus eq. 16.4; ±0.1′ at h above 15°, some minutes at the horizon). Below an altitude of −0.8333°, where the
//! upper limb has set, none is added.
//!
//! The disc has the radius asin(959.63″/r), r the distance in astronomical units (IAU): 0.533° across at r = 1. It shines as a
//! [`Distant`] light with the irradiance that it makes on a surface that faces it; its limb is not darkened.

use glam::DVec3;

use super::bounding::BoundingSphere;
use super::distant::Distant;
use super::{Error, within};

/// Radius of the sun's disc from one astronomical unit, arc seconds.
const RADIUS_ARCSEC: f64 = 959.63;
/// Parallax of the sun from one astronomical unit, arc seconds.
const PARALLAX_ARCSEC: f64 = 8.794;
/// Terrestrial time less universal time, s.
const DELTA_T_S: f64 = 69.0;
/// Altitude at which the upper limb stands on the horizon, degrees.
const SET_DEG: f64 = -0.8333;

/// A moment in universal time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    julian_day: f64,
}

impl Moment {
    /// A date of the Gregorian calendar and hours of UTC since its midnight, of which there may be more than 24 or fewer than 0 (a local
    /// time less its zone).
    ///
    /// # Errors
    /// [`Error::Value`] for years beyond 1583 to 2500, months and days that there are not.
    pub fn utc(year: i32, month: u32, day: u32, hours: f64) -> Result<Self, Error> {
        let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
        let length = match month {
            2 => 28 + u32::from(leap),
            4 | 6 | 9 | 11 => 30,
            _ => 31,
        };
        within("a year", f64::from(year), (1583..=2500).contains(&year), "1583 to 2500")?;
        within("a month", f64::from(month), (1..=12).contains(&month), "1 to 12")?;
        within("a day", f64::from(day), (1..=length).contains(&day), "a day of that month")?;
        within("a time (h)", hours, hours.abs() <= 1e4, "hours since midnight")?;
        // Meeus 7.1: January and February are the 13th and 14th month of the year before.
        let (y, m) = if month <= 2 { (year - 1, month + 12) } else { (year, month) };
        let (y, m) = (f64::from(y), f64::from(m));
        let century = (y / 100.0).floor();
        let correction = 2.0 - century + (century / 4.0).floor();
        let days = (365.25 * (y + 4716.0)).floor() + (30.6001 * (m + 1.0)).floor() + f64::from(day);
        Ok(Self { julian_day: days + correction - 1524.5 + hours / 24.0 })
    }
}

/// Air, for refraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Pressure at the place (not reduced to sea level), hPa.
    pub pressure_hpa: f64,
    /// Temperature, °C.
    pub temperature_c: f64,
}

/// Where the sun stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunPosition {
    /// Angle to the zenith of the sun's centre, degrees, 0 to 180.
    pub zenith_deg: f64,
    /// From north through east, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// Distance, astronomical units.
    pub distance_au: f64,
}

/// Right ascension, declination (degrees) and distance (astronomical units) of the apparent sun, and the apparent sidereal time of
/// Greenwich, degrees.
fn apparent(moment: Moment) -> ([f64; 3], f64) {
    let day = moment.julian_day - 2_451_545.0;
    let t = (day + DELTA_T_S / 86_400.0) / 36_525.0;
    let sin = |deg: f64| deg.to_radians().sin();
    // Meeus 25.2 to 25.8.
    let longitude = 280.466_46 + 36_000.769_83 * t + 0.000_303_2 * t * t;
    let anomaly = 357.529_11 + 35_999.050_29 * t - 0.000_153_7 * t * t;
    let eccentricity = 0.016_708_634 - 0.000_042_037 * t - 0.000_000_126_7 * t * t;
    let centre = (1.914_602 - 0.004_817 * t - 0.000_014 * t * t) * sin(anomaly)
        + (0.019_993 - 0.000_101 * t) * sin(2.0 * anomaly)
        + 0.000_289 * sin(3.0 * anomaly);
    let distance = 1.000_001_018 * (1.0 - eccentricity * eccentricity)
        / (1.0 + eccentricity * (anomaly + centre).to_radians().cos());
    let node = 125.04 - 1934.136 * t;
    let apparent_longitude = (longitude + centre - 0.00569 - 0.00478 * sin(node)).to_radians();
    let obliquity = 23.0 + (26.0 + (21.448 - 46.8150 * t - 0.00059 * t * t + 0.001_813 * t * t * t) / 60.0) / 60.0;
    let obliquity = (obliquity + 0.00256 * node.to_radians().cos()).to_radians();
    let ascension = (obliquity.cos() * apparent_longitude.sin()).atan2(apparent_longitude.cos());
    let declination = (obliquity.sin() * apparent_longitude.sin()).asin();
    // Meeus 12.4, with the equation of the equinoxes.
    let u = day / 36_525.0;
    let sidereal = 280.460_618_37 + 360.985_647_366_29 * day + 0.000_387_933 * u * u
        - u * u * u / 38_710_000.0
        - 0.00478 * sin(node) * obliquity.cos();
    ([ascension.to_degrees(), declination.to_degrees(), distance], sidereal)
}

impl SunPosition {
    /// At a moment and a place, latitude −90 to 90 (north positive) and longitude −360 to 360 (east positive), degrees; with
    /// refraction in some air, or the true direction.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn new(moment: Moment, latitude_deg: f64, longitude_deg: f64, air: Option<Air>) -> Result<Self, Error> {
        let latitude = within("a latitude (deg)", latitude_deg, latitude_deg.abs() <= 90.0, "-90 to 90")?.to_radians();
        let longitude = within("a longitude (deg)", longitude_deg, longitude_deg.abs() <= 360.0, "-360 to 360")?;
        let ([ascension, declination, distance_au], sidereal) = apparent(moment);
        let hour_angle = (sidereal + longitude - ascension).to_radians();
        let (sin_d, cos_d) = declination.to_radians().sin_cos();
        let (sin_l, cos_l) = latitude.sin_cos();
        let (sin_h, cos_h) = hour_angle.sin_cos();
        // As a vector: east, north, up.
        let (east, north, up) =
            (-cos_d * sin_h, sin_d * cos_l - cos_d * cos_h * sin_l, sin_d * sin_l + cos_d * cos_h * cos_l);
        let across = east.hypot(north);
        let geocentric = up.atan2(across);
        let parallax = (PARALLAX_ARCSEC / 3600.0).to_radians() / distance_au * geocentric.cos();
        let altitude_deg = (geocentric - parallax).to_degrees();
        let lifted_deg = match air {
            Some(air) => altitude_deg + refraction_deg(altitude_deg, air)?,
            None => altitude_deg,
        };
        let azimuth_deg = east.atan2(north).to_degrees().rem_euclid(360.0);
        Ok(Self { zenith_deg: 90.0 - lifted_deg, azimuth_deg, distance_au })
    }

    /// Unit vector towards the sun: +x east, +y north, +z up.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        let ((sin_z, cos_z), (sin_a, cos_a)) =
            (self.zenith_deg.to_radians().sin_cos(), self.azimuth_deg.to_radians().sin_cos());
        DVec3::new(sin_z * sin_a, sin_z * cos_a, cos_z)
    }

    /// Radius of the disc, rad.
    #[must_use]
    pub fn angular_radius_rad(&self) -> f64 {
        ((RADIUS_ARCSEC / 3600.0).to_radians().sin() / self.distance_au).asin()
    }

    /// The disc as a light that makes the irradiance per band, W/(m²·nm) or W/m², on a surface that faces it, in a world whose +x is
    /// east, +y north and +z up.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn light(&self, normal_irradiance: &[f64], scene: BoundingSphere) -> Result<Distant, Error> {
        Distant::new(self.direction(), self.angular_radius_rad(), normal_irradiance, scene)
    }
}

/// What refraction adds to a true altitude, degrees.
fn refraction_deg(altitude_deg: f64, air: Air) -> Result<f64, Error> {
    let (p, t) = (air.pressure_hpa, air.temperature_c);
    let pressure = within("an air pressure (hPa)", p, (0.0..=1200.0).contains(&p), "0 to 1200")?;
    let temperature = within("an air temperature (°C)", t, (-100.0..=100.0).contains(&t), "-100 to 100")?;
    if altitude_deg < SET_DEG {
        return Ok(0.0);
    }
    let angle = (altitude_deg + 10.3 / (altitude_deg + 5.11)).to_radians();
    // The formula turns slightly negative at the zenith, where there is none.
    Ok((pressure / 1010.0 * 283.0 / (273.0 + temperature) * 1.02 / (60.0 * angle.tan())).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;

    /// Meeus, example 7.a (1957 October 4.81: JD 2436116.31), table of chapter 7 (1600 January 1.0, 1987 June 19.5, 2000 January 1.5).
    #[test]
    fn julian_days_are_those_of_the_book() {
        for (year, month, day, hours, expected) in [
            (1957, 10, 4, 0.81 * 24.0, 2_436_116.31),
            (2000, 1, 1, 12.0, 2_451_545.0),
            (1987, 6, 19, 12.0, 2_446_966.0),
            (1600, 1, 1, 0.0, 2_305_447.5),
        ] {
            let moment = Moment::utc(year, month, day, hours).expect("a date");
            assert!((moment.julian_day - expected).abs() < 1e-6, "{moment:?} {expected}");
        }
    }

    /// Meeus, example 25.a: 1992 October 13.0 TD; α = 198.38083°, δ = −7.78507°, R = 0.99766.
    #[test]
    fn the_apparent_sun_is_that_of_the_book() {
        let moment = Moment::utc(1992, 10, 13, -DELTA_T_S / 3600.0).expect("a date");
        let ([ascension, declination, distance], _) = apparent(moment);
        assert!((ascension + 360.0 - 198.38083).abs() < 1e-5, "{ascension}");
        assert!((declination + 7.78507).abs() < 1e-5 && (distance - 0.99766).abs() < 1e-5, "{declination} {distance}");
    }

    /// I. Reda & A. Andreas, *Solar Position Algorithm for Solar Radiation Applications*, NREL/TP-560-34302 (2008), the example of the
    /// appendix: zenith 50.11162°, azimuth 194.34024° with refraction at 820 hPa and 11 °C, R = 0.9965422974; to the 0.01° stated.
    #[test]
    fn the_example_of_nrel() {
        let moment = Moment::utc(2003, 10, 17, 12.0 + 30.5 / 60.0 + 7.0).expect("a date");
        let air = Air { pressure_hpa: 820.0, temperature_c: 11.0 };
        let sun = SunPosition::new(moment, 39.742476, -105.1786, Some(air)).expect("a place");
        assert!((sun.zenith_deg - 50.11162).abs() < 0.01, "{sun:?}");
        assert!((sun.azimuth_deg - 194.34024).abs() < 0.01, "{sun:?}");
        assert!((sun.distance_au - 0.996_542_297_4).abs() < 5e-5, "{sun:?}");
    }

    /// The NREL algorithm (0.0003°) as pvlib 0.16.1 has it (`spa_python`, altitude 0, its own ΔT), zenith and azimuth printed to 1e-4°:
    /// the directions differ by no more than the 0.01° stated.
    #[test]
    fn directions_are_those_of_pvlib() {
        for (date, hours, place, zenith_deg, azimuth_deg) in [
            ((1960, 2, 29), 5.0, (-33.87, 151.21), 47.3019, 293.1046),
            ((2000, 12, 21), 16.75, (78.2, 15.6), 112.3600, 262.2792),
            ((2024, 3, 20), 3.1, (0.0, 100.0), 35.3562, 90.0),
            ((2024, 6, 20), 12.0, (51.48, 0.0), 28.0453, 179.1677),
            ((2030, 9, 1), 21.5, (40.71, -74.0), 68.5585, 261.9233),
            ((2049, 7, 4), 18.0 + 1.0 / 6.0, (19.43, -99.13), 7.9985, 63.9098),
            ((2026, 11, 25), 23.0 + 1.0 / 3.0, (-77.85, 166.67), 57.7770, 22.3148),
        ] {
            let moment = Moment::utc(date.0, date.1, date.2, hours).expect("a date");
            let sun = SunPosition::new(moment, place.0, place.1, None).expect("a place");
            let other = SunPosition { zenith_deg, azimuth_deg, ..sun };
            let apart = sun.direction().distance(other.direction()).to_degrees();
            assert!(apart < 0.01, "{date:?} {hours}: {sun:?}, {apart}° apart");
        }
    }

    /// Meeus, example 16.a: at an apparent altitude of 0.5° refraction is 28.754′ (Bennett's formula, of which Sæmundsson's is the
    /// inverse to within 0.1′).
    #[test]
    fn refraction_lifts_the_low_sun() {
        let air = Air { pressure_hpa: 1010.0, temperature_c: 10.0 };
        let at = |altitude| refraction_deg(altitude, air).expect("air") * 60.0;
        assert!((at(0.5 - 28.754 / 60.0) - 28.754).abs() < 0.1, "{}", at(0.5 - 28.754 / 60.0));
        assert!(at(90.0) == 0.0 && at(-1.0) == 0.0);
        assert!(refraction_deg(10.0, Air { pressure_hpa: -1.0, temperature_c: 0.0 }).is_err());
    }

    #[test]
    fn the_disc_is_half_a_degree_across_and_stands_in_the_south_at_noon() {
        let moment = Moment::utc(2024, 6, 20, 12.0).expect("a date");
        let sun = SunPosition::new(moment, 51.48, 0.0, None).expect("a place");
        let direction = sun.direction();
        assert!(direction.y < -0.4 && direction.x.abs() < 0.02 && direction.z > 0.88, "{direction}");
        let one = SunPosition { distance_au: 1.0, ..sun };
        assert!((2.0 * one.angular_radius_rad().to_degrees() - 0.533).abs() < 5e-4);
        let scene = BoundingSphere::new(DVec3::ZERO, 1.0).expect("a sphere");
        let light = sun.light(&[1e5], scene).expect("a light");
        check::irradiance(&light, DVec3::ZERO, direction, 1e5);
    }

    #[test]
    fn dates_and_places_that_there_are_not_are_refused() {
        assert!(Moment::utc(2023, 2, 29, 0.0).is_err() && Moment::utc(2024, 2, 29, 0.0).is_ok());
        assert!(Moment::utc(2024, 13, 1, 0.0).is_err() && Moment::utc(1500, 1, 1, 0.0).is_err());
        assert!(Moment::utc(2024, 4, 31, 0.0).is_err() && Moment::utc(2024, 4, 30, f64::NAN).is_err());
        let moment = Moment::utc(2024, 1, 1, 0.0).expect("a date");
        assert!(SunPosition::new(moment, 91.0, 0.0, None).is_err());
        assert!(SunPosition::new(moment, 0.0, f64::NAN, None).is_err());
    }
}
