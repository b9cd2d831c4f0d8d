//! The extremes and reference cases in short: what a user runs to see that the tool keeps its digits on his machine. The long versions
//! are the tests in `tests/extremes` and beside each module.
//!
//! Every expectation comes from outside of the code that is checked: a closed form, evaluated with 40 or 50 digits, or a standard.

mod brdfs;
mod captures;
mod colour;
mod lamps;
mod light;
mod photometry;
mod pictures;
mod scenes;

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// The part of the tool.
    pub area: &'static str,
    /// What is computed.
    pub case: &'static str,
    /// Where the expectation is from.
    pub source: &'static str,
    /// What must come out.
    pub expected: f64,
    /// What came out.
    pub found: f64,
    /// The difference that is allowed: relative, or absolute where 0 is expected.
    pub allowed: f64,
}

impl Check {
    /// The difference: relative, or absolute where 0 is expected.
    #[must_use]
    pub fn error(&self) -> f64 {
        let apart = (self.found - self.expected).abs();
        if self.expected == 0.0 { apart } else { apart / self.expected.abs() }
    }

    /// Whether it is allowed; what is no number is not.
    #[must_use]
    pub fn passes(&self) -> bool {
        self.error() <= self.allowed
    }
}

/// Runs all cases, in a second or two.
#[must_use]
pub fn run() -> Vec<Check> {
    let mut out = light::checks();
    out.extend(photometry::checks());
    out.extend(colour::checks());
    out.extend(lamps::checks());
    out.extend(brdfs::checks());
    out.extend(pictures::checks());
    out.extend(scenes::checks());
    out.extend(captures::checks());
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_passes_here() {
        for check in run() {
            assert!(check.passes(), "{check:?}");
        }
    }

    #[test]
    fn what_is_no_number_or_off_does_not_pass() {
        let check = |expected, found| Check { area: "", case: "", source: "", expected, found, allowed: 1e-3 };
        assert!(check(2.0, 2.001).passes() && !check(2.0, 2.01).passes() && !check(2.0, f64::NAN).passes());
        assert!(check(0.0, 1e-3).passes() && !check(0.0, 0.1).passes() && !check(0.0, f64::INFINITY).passes());
    }
}
