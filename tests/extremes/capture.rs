//! Photographs too bright, too dark or both, of a millionth of a second or a day; stacks that tell nothing; lenses far from their middle.

use glam::DVec2;
use photopic::capture::merge::{Merge, Range, Respond, State};
use photopic::capture::noise::Noise;
use photopic::capture::photo::Codes;
use photopic::capture::response::{Exposures, Sampling, monotone};
use photopic::capture::{Error, Photo};
use photopic::geometry::lens::Distortion;

use crate::close;

fn photo(codes: &[u8]) -> Photo {
    Photo { width: codes.len(), height: 1, channels: 1, codes: Codes::Eight(codes.to_vec()) }
}

/// A merge of exposures of the same pixels under a linear response.
fn merged(exposures: &[(f64, &[u8])]) -> Merge {
    let mut merge = Merge::new(&photo(exposures[0].1), Range::default(), Noise::constant(1, 1.0));
    for (time_s, codes) in exposures {
        merge.add("a photograph", *time_s, &photo(codes), &Respond::Linear).expect("alike");
    }
    merge
}

/// Code 255 is a radiance of 1 at 1 s: L = z/255/t for times from a microsecond to a day.
#[test]
fn radiance_is_code_over_time_at_any_time() {
    for time_s in [1e-6, 1.0, 86_400.0] {
        let one = merged(&[(time_s, &[51, 102, 204])]);
        for (i, code) in [51.0, 102.0, 204.0].into_iter().enumerate() {
            let sample = one.sample(i);
            assert_eq!(sample.state, State::Valid);
            // Sums are in single precision.
            close(f64::from(sample.radiance), code / 255.0 / time_s, 4.0 * f64::from(f32::EPSILON), "L");
            assert!(sample.standard_error > 0.0 && sample.standard_error.is_finite());
        }
    }
    // Sixteen stops apart: the bright pixel is told by the short exposure, the dark one by the long.
    let both = merged(&[(1.0, &[255, 128]), (2.0_f64.powi(-16), &[128, 0])]);
    close(f64::from(both.sample(0).radiance), 128.0 / 255.0 * 65_536.0, 1e-6, "the sun");
    close(f64::from(both.sample(1).radiance), 128.0 / 255.0, 1e-6, "the shade");
    assert_eq!(both.counts(), [2, 0, 0, 0]);
}

#[test]
fn what_no_exposure_shows_has_a_bound_and_no_value() {
    let all = merged(&[(1.0, &[255, 0, 255]), (0.25, &[255, 0, 0])]);
    let [bright, dark, between] = [0, 1, 2].map(|i| all.sample(i));
    // At least 250/255 in a quarter second; at most 2/255 in one.
    assert!(bright.state == State::Saturated && bright.standard_error.is_infinite());
    close(f64::from(bright.radiance), 250.0 / 255.0 / 0.25, 1e-6, "at least");
    assert!(dark.state == State::Dark && dark.standard_error.is_infinite());
    close(f64::from(dark.radiance), 2.0 / 255.0, 1e-6, "at most");
    // Above 250/255 by one, below 2/255/0.25 by the other, which cannot be both: half the way is its error.
    assert!(between.state == State::Gap && between.standard_error.is_finite());
    assert_eq!(all.counts(), [0, 1, 1, 1]);
}

#[test]
fn exposures_that_are_none_are_refused() {
    let mut merge = Merge::new(&photo(&[1]), Range::default(), Noise::constant(1, 1.0));
    for time_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = merge.add("x", time_s, &photo(&[1]), &Respond::Linear);
        assert!(matches!(refused, Err(Error::Time { .. })), "{time_s}: {refused:?}");
    }
    assert!(matches!(merge.add("x", 1.0, &photo(&[1, 2]), &Respond::Linear), Err(Error::Size { .. })));
    // Of one exposure, or of codes that are all black or all white, no response can be told.
    for (exposures, code) in [(1, 100), (3, 0), (3, 255)] {
        let mut stack = Exposures::new("flat");
        for n in 0..exposures {
            let photo = photo(&[code; 64]);
            stack.add("x", 2.0_f64.powi(n), &photo, Sampling { pixels: 64 }).expect("alike");
        }
        assert!(monotone(&[stack]).is_err(), "{exposures} of code {code}");
    }
}

/// x (1 + k₁r²): back to the digit where it is one to one, and refused beyond the fold at r² = 1/(3|k₁|), where r(1 − |k₁|r²) has its largest
/// value, 2/3 of that r.
#[test]
fn lenses_are_undone_up_to_their_fold() {
    let lens = Distortion { k1: -0.3, ..Distortion::default() };
    let fold = (1.0 / 0.9_f64).sqrt();
    for r in [0.0, 1e-12, 1e-3, 0.5, 0.99 * fold] {
        let ideal = DVec2::new(0.6 * r, 0.8 * r);
        let seen = lens.distort(ideal);
        close(seen.length(), r * (1.0 - 0.3 * r * r), 1e-14, "distorted");
        let back = lens.undistort(seen).unwrap_or_else(|| panic!("{r} is before the fold"));
        // Near the fold the map is flat: 1 − 0.9 r² = 0.02 of the digits are lost there.
        assert!((back - ideal).length() <= 1e-13 * r / (1.0 - 0.9 * r * r), "{r}: {back}, {ideal}");
    }
    assert_eq!(lens.undistort(DVec2::new(1.01 * 2.0 / 3.0 * fold, 0.0)), None);
}
