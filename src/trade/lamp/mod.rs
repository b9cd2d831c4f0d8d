//! The trade of a lamp: how fine its table has to be, how it is interpolated, and from where on a point does for the whole opening.
//!
//! | knob | values |
//! |---|---|
//! | `every_horizontal`, `every_vertical` | all angles of the table, or every 2nd, 4th and 8th, while three are left |
//! | `interpolation` | bilinear, monotone cubic |
//! | `near_ratio` | a point at any distance (0), an area nearer than 5 or 20 times its largest dimension |
//! | `precision` | entries as `f64`, or rounded to `f32`, to 3 and to 2 decimal digits (tried with the whole table) |
//!
//! **Figures**: flux, peak intensity, beam angles (half of the plane's maximum), the mean illuminance of the floor beneath the lamp, the
//! largest error of its points as a share of that mean, and the illuminance that faces the lamp in the direction of its peak, 1, 2, 5 and
//! 10 times its largest dimension away: the five-times rule. Of radiometric files they are irradiances.
//!
//! **Reference**: the whole table, bilinear as all files are read, the opening as an area at any distance. What lies between the entries is
//! not known: the difference to the monotone cubic counts as the reference's own error, with the tolerance of the area's integral.

mod places;

use self::places::Places;
use super::timing::interleaved;
use super::{Estimate, Figure, Sweep, Trial};
use crate::luminaire::grid::{Settings, beneath, has_opening};
use crate::luminaire::transform::thinned;
use crate::luminaire::{Interpolation, Luminaire, grid, transform};

/// Parts of the angles that are tried.
const EVERY: [usize; 4] = [1, 2, 4, 8];
/// Fewest steps of an angle that are left.
const FEWEST_STEPS: usize = 2;
/// Near ratios that are tried.
const NEAR: [f64; 3] = [0.0, 5.0, 20.0];
/// The default of `lamp grid`, where the precision is tried.
const USUAL: f64 = 5.0;
/// Every distance is near.
const ALWAYS: f64 = 1000.0;
/// Tolerance of the reference's integral over the opening.
const TOLERANCE: f64 = 1e-6;
/// Cells along a side of the floor.
const CELLS: usize = 16;

/// How many figures are watched.
const COUNT: usize = 10;
/// The figures watched, in the order of the errors.
pub static FIGURES: [Figure; COUNT] = [
    Figure::relative("flux"),
    Figure::relative("peak_intensity"),
    Figure::absolute("beam_angle_c0_c180", "deg"),
    Figure::absolute("beam_angle_c90_c270", "deg"),
    Figure::relative("mean_illuminance"),
    Figure::relative("illuminance"),
    Figure::relative("illuminance_1x"),
    Figure::relative("illuminance_2x"),
    Figure::relative("illuminance_5x"),
    Figure::relative("illuminance_10x"),
];

/// How the entries of the table are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// As they are.
    Double,
    /// Rounded to single precision.
    Single,
    /// Rounded to so many decimal digits.
    Digits(usize),
}

/// How a lamp was taken in a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Every n-th horizontal and vertical angle.
    pub every: [usize; 2],
    /// Between the entries.
    pub interpolation: Interpolation,
    /// Nearer than so many times its largest dimension the lamp is an area.
    pub near_ratio: f64,
    /// Of the entries.
    pub precision: Precision,
}

impl Choice {
    fn words(&self) -> Vec<String> {
        let precision = match self.precision {
            Precision::Double => "f64".to_owned(),
            Precision::Single => "f32".to_owned(),
            Precision::Digits(n) => format!("{n} digits"),
        };
        let [horizontal, vertical] = self.every.map(|n| n.to_string());
        vec![horizontal, vertical, self.interpolation.name().to_owned(), self.near_ratio.to_string(), precision]
    }

    fn of(&self, luminaire: &Luminaire) -> Result<Luminaire, transform::Error> {
        let table = thinned(&luminaire.distribution, self.every)?;
        let values = table.values().iter().map(|v| match self.precision {
            Precision::Double => *v,
            Precision::Single => f64::from(*v as f32),
            Precision::Digits(n) => rounded(*v, n),
        });
        let table = table.with_values(values.collect())?.with_interpolation(self.interpolation);
        Ok(Luminaire { distribution: table, ..luminaire.clone() })
    }
}

/// A number to so many decimal digits, as a file prints it.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// A sweep, and what was chosen in each of its trials.
#[derive(Debug, Clone, PartialEq)]
pub struct LampSweep {
    /// The trials; the figures are [`FIGURES`].
    pub sweep: Sweep,
    /// Their choices.
    pub choices: Vec<Choice>,
}

/// Why a lamp could not be traded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LampError {
    /// The floor beneath it.
    #[error(transparent)]
    Grid(#[from] grid::Error),
    /// Its table.
    #[error(transparent)]
    Table(#[from] transform::Error),
}

/// Tries a lamp that hangs `height_m` above the floor, each choice timed `repeats` times.
///
/// # Errors
/// [`LampError`]: a height that is none.
pub fn sweep(luminaire: &Luminaire, height_m: f64, repeats: usize) -> Result<LampSweep, LampError> {
    let floor = beneath(luminaire, height_m, CELLS, &Settings { near_ratio: 0.0, ..Settings::default() })?.plane;
    let places = Places::new(luminaire, height_m, floor)?;
    let finest = Settings { near_ratio: ALWAYS, tolerance: TOLERANCE, ..Settings::default() };
    let whole = |interpolation| {
        let choice = Choice { every: [1; 2], interpolation, near_ratio: ALWAYS, precision: Precision::Double };
        choice.of(luminaire)
    };
    let reference = places.values(&whole(Interpolation::Bilinear)?, &finest)?;
    let smooth = places.values(&whole(Interpolation::MonotoneCubic)?, &finest)?;
    let own = reference.errors(&smooth).into_iter().zip(&FIGURES).map(|(error, figure)| {
        let integral = if figure.key.contains("illuminance") { TOLERANCE } else { 0.0 };
        Some(error? + integral)
    });
    let reference_errors = own.collect();
    let choices = choices(luminaire);
    let lamps = choices.iter().map(|c| c.of(luminaire)).collect::<Result<Vec<_>, _>>()?;
    let settings = |c: &Choice| Settings { near_ratio: c.near_ratio, ..Settings::default() };
    let mut errors = Vec::with_capacity(choices.len());
    for (choice, lamp) in choices.iter().zip(&lamps) {
        errors.push(reference.errors(&places.values(lamp, &settings(choice))?));
    }
    let timings =
        interleaved(choices.len(), repeats, |i| places.values(&lamps[i], &settings(&choices[i])).map(|v| v.flux))?;
    let trials = choices.iter().zip(timings).zip(errors).map(|((choice, timing), errors)| Trial {
        settings: choice.words(),
        offered: choice.precision == Precision::Double,
        timing,
        errors: errors.into_iter().map(|e| e.map(Estimate::exact)).collect(),
    });
    let sweep = Sweep {
        reference:
            "the whole table, bilinear, give or take the difference to the monotone cubic; the opening as an area"
                .to_owned(),
        knobs: vec!["every_horizontal", "every_vertical", "interpolation", "near_ratio", "precision"],
        figures: FIGURES.to_vec(),
        reference_errors,
        trials: trials.collect(),
    };
    Ok(LampSweep { sweep, choices })
}

/// The errors of [`FIGURES`] of another lamp against this one, both as `lamp grid` takes them.
pub(super) fn difference(a: &Luminaire, b: &Luminaire, height_m: f64) -> Result<Vec<Option<f64>>, LampError> {
    let settings = Settings::default();
    let floor = beneath(a, height_m, CELLS, &Settings { near_ratio: 0.0, ..settings })?.plane;
    let places = Places::new(a, height_m, floor)?;
    Ok(places.values(a, &settings)?.errors(&places.values(b, &settings)?))
}

/// Everything that is tried, the whole table first.
fn choices(luminaire: &Luminaire) -> Vec<Choice> {
    let d = &luminaire.distribution;
    let parts = |angles: &[f64]| {
        let steps = angles.len() - 1;
        EVERY.into_iter().filter(move |n| *n == 1 || steps / n >= FEWEST_STEPS).collect::<Vec<usize>>()
    };
    // Without an opening a lamp is a point at any distance.
    let near = if has_opening(luminaire) { &NEAR[..] } else { &NEAR[..1] };
    let mut out = Vec::new();
    for horizontal in parts(d.horizontal_deg()) {
        for vertical in parts(d.vertical_deg()) {
            for interpolation in [Interpolation::Bilinear, Interpolation::MonotoneCubic] {
                let every = [horizontal, vertical];
                let with = |n: &f64| Choice { every, interpolation, near_ratio: *n, precision: Precision::Double };
                out.extend(near.iter().map(with));
            }
        }
    }
    let near_ratio = if near.contains(&USUAL) { USUAL } else { 0.0 };
    let all =
        Choice { every: [1; 2], interpolation: Interpolation::Bilinear, near_ratio, precision: Precision::Double };
    let rounded = [Precision::Single, Precision::Digits(3), Precision::Digits(2)];
    out.extend(rounded.map(|precision| Choice { precision, ..all }));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::luminaire::{Body, Distribution, Shape, Symmetry, System};
    use std::f64::consts::PI;

    /// A round opening of luminance 1 cd/m² and diameter 0.1 m, its cosine in a table of `steps` steps.
    fn disc(steps: u32, opening: bool) -> Luminaire {
        let gamma: Vec<f64> = (0..=steps).map(|i| 90.0 * f64::from(i) / f64::from(steps)).collect();
        let area = PI * 0.05 * 0.05;
        let values = gamma.iter().map(|g| area * g.to_radians().cos()).collect();
        let distribution =
            Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], gamma, values).expect("a sound table");
        let body = Body { shape: Shape::Round, length_m: 0.1, width_m: 0.1, height_m: 0.0 };
        Luminaire { opening: opening.then_some(body), ..Luminaire::of(distribution) }
    }

    fn errors(s: &LampSweep, key: &str, is: impl Fn(&Choice) -> bool) -> Vec<(Choice, f64)> {
        let figure = FIGURES.iter().position(|f| f.key == key).expect("a figure");
        let tried = s.choices.iter().zip(&s.sweep.trials).filter(|(c, _)| is(c));
        tried.filter_map(|(c, t)| Some((*c, t.errors[figure]?.error))).collect()
    }

    #[test]
    fn straight_lines_through_a_cosine_lose_flux_with_the_square_of_the_step() {
        // ∫ sin γ of straight lines through cos γ at multiples of h is 1 − tan(h/2)/h over a quarter turn (by parts; the sum of
        // sin 2γ over the middles of the steps is 1/sin h), and the flux 2π I₀ times that: π I₀ (1 − h²/12) for small h.
        let s = sweep(&disc(64, false), 3.0, 1).expect("a sweep");
        let share = |n: usize| {
            let h = n as f64 * PI / 128.0;
            1.0 - (0.5 * h).tan() / h
        };
        let tried = errors(&s, "flux", |c| {
            c.interpolation == Interpolation::Bilinear && c.precision == Precision::Double && c.near_ratio == 0.0
        });
        assert_eq!(tried.iter().map(|(c, _)| c.every).collect::<Vec<_>>(), EVERY.map(|n| [1, n]));
        for (choice, error) in &tried {
            let expected = (share(choice.every[1]) / share(1) - 1.0).abs();
            assert!((error - expected).abs() < 1e-13, "{choice:?}: {error}, expected {expected}");
        }
        // The whole table is as far from the cosine as its own error says: the cubic comes nearer by an order.
        let own = s.sweep.reference_errors[0].expect("a flux");
        let away = 1.0 / (2.0 * share(1)) - 1.0;
        assert!((own / away - 1.0).abs() < 0.1, "{own}, {away}");
        // Nothing is known of the opening: no distance is near, and nothing faces the lamp at so many times its size.
        assert!(
            s.choices.iter().all(|c| c.near_ratio == 0.0) && s.sweep.reference_errors[6..].iter().all(Option::is_none)
        );
    }

    #[test]
    fn a_point_for_a_disc_errs_by_the_square_of_radius_over_distance() {
        // On the axis of a Lambertian disc E = π L R²/(d² + R²), of the point πR²L/d²: too much by R²/d² (the five-times rule: 1 %).
        let s = sweep(&disc(900, true), 50.0, 1).expect("a sweep");
        let whole = |c: &Choice| {
            c.every == [1; 2] && c.interpolation == Interpolation::Bilinear && c.precision == Precision::Double
        };
        for (key, times) in
            [("illuminance_1x", 1.0), ("illuminance_2x", 2.0), ("illuminance_5x", 5.0), ("illuminance_10x", 10.0)]
        {
            let of_point = 0.25 / f64::powi(times, 2);
            for (choice, error) in errors(&s, key, whole) {
                let expected = if times < choice.near_ratio { 0.0 } else { of_point };
                // The tolerance of `lamp grid`, and what 0.1° steps leave of a cosine (h²/8).
                assert!((error - expected).abs() < 1e-4 + 4e-7, "{key} {choice:?}: {error}, expected {expected}");
            }
        }
        // 5 % is met by a point five diameters away, not two; 0.5 % not before ten.
        let figure = |times: &str| FIGURES.iter().position(|f| f.key == times).expect("a figure");
        let near = |key: &str, target: f64| Some(s.choices[s.sweep.recommend(figure(key), target)?].near_ratio);
        assert!(near("illuminance_2x", 0.05).is_some_and(|n| n > 2.0));
        assert!(near("illuminance_5x", 0.005).is_some_and(|n| n > 5.0));
    }

    #[test]
    fn numbers_are_rounded_as_printed() {
        assert_eq!(
            [rounded(1234.5, 3), rounded(0.018_75, 2), rounded(0.0, 2), rounded(-99.96, 3)],
            [1230.0, 0.019, 0.0, -100.0]
        );
    }
}
