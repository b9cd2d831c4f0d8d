//! Photographs.

use super::Check;
use crate::capture::Photo;
use crate::capture::merge::{Merge, Range, Respond, State};
use crate::capture::noise::Noise;
use crate::capture::photo::Codes;

/// The radiance, or its bound, of one pixel of a stack of times and codes, and what became of it; NaN where there is none.
fn merged(exposures: &[(f64, u8)]) -> (f64, Option<State>) {
    let photo = |code: u8| Photo { width: 1, height: 1, channels: 1, codes: Codes::Eight(vec![code]) };
    let mut merge = Merge::new(&photo(0), Range::default(), Noise::constant(1, 1.0));
    for (time_s, code) in exposures {
        if merge.add("", *time_s, &photo(*code), &Respond::Linear).is_err() {
            return (f64::NAN, None);
        }
    }
    (f64::from(merge.sample(0).radiance), Some(merge.sample(0).state))
}

pub(super) fn checks() -> Vec<Check> {
    let check =
        |case, source, expected, found, allowed| Check { area: "captures", case, source, expected, found, allowed };
    let linear = "code/255/time, in single precision";
    let single = 4.0 * f64::from(f32::EPSILON);
    let valid = |exposures: &[(f64, u8)]| match merged(exposures) {
        (radiance, Some(State::Valid)) => radiance,
        _ => f64::NAN,
    };
    let bound = |exposures: &[(f64, u8)], state: State| match merged(exposures) {
        (bound, Some(found)) if found == state => bound,
        _ => f64::NAN,
    };
    vec![
        check("code 102 in 1e-6 s", linear, 4e5, valid(&[(1e-6, 102)]), single),
        check("code 102 in a day", linear, 0.4 / 86_400.0, valid(&[(86_400.0, 102)]), single),
        check(
            "white in 1 s, code 102 in 2⁻¹⁶ s",
            linear,
            0.4 * 65_536.0,
            valid(&[(1.0, 255), (2_f64.powi(-16), 102)]),
            single,
        ),
        check("code 102 in 1 s, black in 2⁻¹⁶ s", linear, 0.4, valid(&[(1.0, 102), (2_f64.powi(-16), 0)]), single),
        check(
            "white in ¼ s: at least",
            "250/255/time",
            1000.0 / 255.0,
            bound(&[(0.25, 255)], State::Saturated),
            single,
        ),
        check("black in 1 s: at most", "2/255/time", 2.0 / 255.0, bound(&[(1.0, 0)], State::Dark), single),
    ]
}
