//! Honest times: every run once unmeasured, then all of them in turns, so that a drift of the machine hits them alike.

use std::time::{Duration, Instant};

use serde::Serialize;

/// A run shorter than this is repeated within one measurement, for the clock's sake.
const SHORTEST: Duration = Duration::from_micros(200);

/// Runs of each before those that are measured, in [`interleaved`]: one to warm up, one to see how long it takes.
pub const WARM_UPS: usize = 2;

/// How long a run took.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Timing {
    /// Median, s.
    pub median_s: f64,
    /// Lower quartile, s.
    pub low_s: f64,
    /// Upper quartile, s.
    pub high_s: f64,
    /// Measurements.
    pub repeats: usize,
}

impl Timing {
    /// Of measured times, of which there is at least one.
    fn of(mut seconds: Vec<f64>) -> Self {
        seconds.sort_by(f64::total_cmp);
        // The value at a share of the order, straight between neighbours.
        let at = |share: f64| {
            let place = share * (seconds.len() - 1) as f64;
            let below = seconds[place.floor() as usize];
            below + (place - place.floor()) * (seconds[place.ceil() as usize] - below)
        };
        Self { median_s: at(0.5), low_s: at(0.25), high_s: at(0.75), repeats: seconds.len() }
    }
}

/// Times runs side by side: [`WARM_UPS`] of each, then `repeats` rounds in which every run has its turn; every other round goes
/// backwards. A run is given its own number and returns what keeps the compiler from leaving its work out.
///
/// # Errors
/// The first that a run returns.
pub fn interleaved<T, E>(
    runs: usize,
    repeats: usize,
    mut run: impl FnMut(usize) -> Result<T, E>,
) -> Result<Vec<Timing>, E> {
    let repeats = repeats.max(1);
    let mut batches = Vec::with_capacity(runs);
    for i in 0..runs {
        std::hint::black_box(run(i)?);
        let start = Instant::now();
        std::hint::black_box(run(i)?);
        let once = start.elapsed().max(Duration::from_nanos(20));
        batches.push((SHORTEST.as_secs_f64() / once.as_secs_f64()).ceil().max(1.0) as usize);
    }
    let mut seconds = vec![Vec::with_capacity(repeats); runs];
    for round in 0..repeats {
        for turn in 0..runs {
            let i = if round % 2 == 0 { turn } else { runs - 1 - turn };
            let start = Instant::now();
            for _ in 0..batches[i] {
                std::hint::black_box(run(i)?);
            }
            seconds[i].push(start.elapsed().as_secs_f64() / batches[i] as f64);
        }
    }
    Ok(seconds.into_iter().map(Timing::of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_lie_between_neighbours() {
        let t = Timing::of(vec![4.0, 1.0, 3.0, 2.0]);
        assert_eq!((t.low_s, t.median_s, t.high_s, t.repeats), (1.75, 2.5, 3.25, 4));
    }

    #[test]
    fn every_run_has_its_turns_and_an_error_ends_all() {
        let mut counts = [0; 3];
        let long = |i: usize| {
            std::thread::sleep(Duration::from_micros(300));
            i
        };
        let timings = interleaved(3, 4, |i| {
            counts[i] += 1;
            Ok::<_, ()>(long(i))
        });
        // Two runs to warm up and to see how long it takes, then one per round, for they are longer than the shortest.
        assert_eq!((timings.expect("no error").len(), counts), (3, [6; 3]));
        assert_eq!(interleaved(2, 4, |i| if i == 0 { Ok(()) } else { Err("no") }), Err("no"));
    }
}
