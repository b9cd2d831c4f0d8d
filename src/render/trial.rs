//! How the samples of a picture are best taken, found out by a few that are thrown away.
//!
//! What counts is the work w that a given noise takes, w v, where v is the variance of a sample. Of a number of branches n
//! ([`PathTracer::branching`](super::integrator::path::PathTracer::branching)) two are tried, of which others follow:
//!
//! ```text
//! v(n) = a + b/n     w(n) = c + d n     w v is least at n = √(b c / (a d))
//! ```
//!
//! The work is counted in searches along rays, which are the same on every machine.

/// Numbers of branches that are tried.
pub(super) const BRANCHES: [u32; 2] = [1, 4];
/// The most branches that a picture of so many samples a pixel is given: its edges are made of the rays of the camera.
pub(super) fn most_branches(samples: u64) -> u32 {
    let root = u32::try_from(samples.isqrt() / 2).unwrap_or(u32::MAX);
    [16, 8, 4, 2].into_iter().find(|most| root >= *most).unwrap_or(1)
}

/// A way of taking samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Way {
    pub(super) virtual_lights: bool,
    /// Ways by which a path leaves the first surface that scatters.
    pub(super) branches: u32,
}

/// What came of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Attempt {
    pub(super) way: Way,
    pub(super) work: f64,
    pub(super) variance: f64,
}

impl Attempt {
    /// The work that a given noise takes.
    pub(super) fn price(&self) -> f64 {
        self.work * self.variance
    }

    /// With as many branches as suit best, from two of this way with other numbers of them.
    fn between(&self, more: &Self, most: u32) -> Self {
        let [few, many] = [self, more].map(|attempt| f64::from(attempt.way.branches));
        let b = (self.variance - more.variance) / (1.0 / few - 1.0 / many);
        let (a, d) = (self.variance - b / few, (more.work - self.work) / (many - few));
        let c = self.work - d * few;
        let best = (b.max(0.0) * c.max(0.0) / (a.max(0.0) * d)).sqrt();
        // Points of nets lie best in numbers that are powers of two. No number: neither makes any noise.
        let n = if best.is_nan() { 1.0 } else { best.clamp(1.0, f64::from(most)).log2().round().exp2() };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let way = Way { branches: n as u32, ..self.way };
        Self { way, work: c + d * n, variance: a + b / n }
    }
}

/// The best of some ways with no more than so many branches, those of other numbers of branches one behind the other; `None` where there is no choice.
pub(super) fn best(ways: &[Way], most: u32, attempt: impl Fn(Way) -> Attempt) -> Option<Way> {
    if ways.len() < 2 {
        return None;
    }
    let attempts: Vec<Attempt> = ways.iter().map(|way| attempt(*way)).collect();
    let alike = attempts.chunk_by(|a, b| a.way.virtual_lights == b.way.virtual_lights);
    let refined = alike.map(|alike| match alike {
        [few, many] => few.between(many, most),
        [first, ..] => *first,
        [] => unreachable!("chunks are not empty"),
    });
    refined.min_by(|a, b| a.price().total_cmp(&b.price())).map(|attempt| attempt.way)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// v = 1 + 16/n and w = 4 + n: least at √(16 · 4 / 1) = 8, where w v = 36.
    fn known(way: Way) -> Attempt {
        let n = f64::from(way.branches);
        let (work, variance) = if way.virtual_lights { (10.0 + n, 4.0) } else { (4.0 + n, 1.0 + 16.0 / n) };
        Attempt { way, work, variance }
    }

    #[test]
    fn the_number_of_branches_is_the_one_of_least_work() {
        let ways = BRANCHES.map(|branches| Way { virtual_lights: false, branches });
        let found = best(&ways, 16, known);
        assert_eq!(found, Some(Way { virtual_lights: false, branches: 8 }));
        let [few, many] = ways.map(known);
        let between = few.between(&many, 16);
        assert!((between.price() - 36.0).abs() < 1e-12, "{between:?}");
        assert_eq!(best(&ways[..1], 16, known), None);
        assert_eq!(best(&ways, 4, known), Some(Way { virtual_lights: false, branches: 4 }));
        assert_eq!([1, 15, 16, 63, 64, 1 << 40].map(most_branches), [1, 1, 2, 2, 4, 16]);
    }

    /// Where branches do not lessen the noise there is one: 11 · 4 is more than 36.
    #[test]
    fn virtual_lights_are_taken_where_they_are_better() {
        let of = |virtual_lights| BRANCHES.map(|branches| Way { virtual_lights, branches });
        let all = [of(false), of(true)].concat();
        assert_eq!(best(&all, 16, known), Some(Way { virtual_lights: false, branches: 8 }));
        assert_eq!(best(&of(true), 16, known), Some(Way { virtual_lights: true, branches: 1 }));
        let cheaper = |way: Way| {
            let attempt = known(way);
            Attempt { work: if way.virtual_lights { 0.5 } else { 1.0 } * attempt.work, ..attempt }
        };
        assert_eq!(best(&all, 16, cheaper), Some(Way { virtual_lights: true, branches: 1 }));
    }

    #[test]
    fn no_noise_takes_no_branches() {
        let ways = BRANCHES.map(|branches| Way { virtual_lights: false, branches });
        let silent = |way| Attempt { way, work: 1.0, variance: 0.0 };
        assert_eq!(best(&ways, 16, silent).map(|way| way.branches), Some(1));
    }
}
