//! Both ways at polished surfaces: what a path carries on each of them.
//!
//! Glass shows two pictures, a faint one of what it mirrors and one of what is behind. A path that draws one of them by chance sees the
//! faint one seldom, and bright then. A path therefore goes on both ways, as long as both are likely enough: very faint ones are followed where the
//! camera sees the glass, others where a surface that is not polished does, whose light is a mean over many directions. Where a faint way comes to such a
//! surface it is followed by chance, but the lamps that it meets before that are seen each time.

use crate::render::integrator::polarisation::Polarisation;

/// What a path carries.
#[derive(Debug)]
pub struct Carried {
    /// Per band.
    pub throughput: Vec<f64>,
    /// What mirrors and glass polarised.
    pub polarisation: Polarisation,
    /// The hero stands for all bands.
    pub split: bool,
    /// The band that it keeps where it must be split.
    pub hero: usize,
    /// The one band in which the instrument sees what the path finds.
    pub seen: Option<usize>,
}

/// Ways that wait to be followed, each from an end `E`; those that were followed are used again, so that nothing is allocated for a sample.
#[derive(Debug)]
pub struct Waiting<E> {
    waiting: Vec<(Carried, E)>,
    free: Vec<Carried>,
}

impl<E> Default for Waiting<E> {
    fn default() -> Self {
        Self { waiting: Vec::new(), free: Vec::new() }
    }
}

impl<E> Waiting<E> {
    /// Place for what a path of so many bands carries.
    pub fn take(&mut self, bands: usize) -> Carried {
        self.free.pop().unwrap_or_else(|| Carried {
            throughput: vec![0.0; bands],
            polarisation: Polarisation::new(bands),
            split: false,
            hero: 0,
            seen: None,
        })
    }

    /// A way that is to be followed.
    pub fn push(&mut self, carried: Carried, end: E) {
        self.waiting.push((carried, end));
    }

    /// The number of ways that wait.
    #[must_use]
    pub fn count(&self) -> usize {
        self.waiting.len()
    }

    /// The last way that waits.
    pub fn pop(&mut self) -> Option<(Carried, E)> {
        self.waiting.pop()
    }

    /// What is used no more.
    pub fn give_back(&mut self, carried: Carried) {
        self.free.push(carried);
    }
}
