//! What a run says on standard error: findings, errors, progress.

use std::io::{self, IsTerminal, Write};

use indicatif::{ProgressBar, ProgressStyle};

use super::Talk;
use crate::finding::{Finding, Severity};

/// From this many bytes of input a progress bar is worth its place.
const LONG_BYTES: u64 = 8 << 20;
/// From this many files.
const LONG_FILES: usize = 200;
/// Findings of one code printed per input before the rest is counted.
const PRINTED_PER_CODE: usize = 3;

/// What is said on standard error.
pub(super) struct Notes {
    talk: Talk,
    /// Something could not be done.
    pub failed: bool,
    /// Bytes or files read so far; hidden for short runs and where nobody watches.
    pub progress: ProgressBar,
}

impl Notes {
    pub(super) fn new(paths: &[String], talk: Talk) -> Self {
        Self { talk, failed: false, progress: progress(paths, talk) }
    }

    /// The same for inputs that are read whole, counted by file.
    pub(super) fn counting(files: usize, talk: Talk) -> Self {
        let worth_it = files >= LONG_FILES;
        let template = "{bar:40} {pos}/{len} files, {eta} left";
        Self { talk, failed: false, progress: bar(files as u64, template, worth_it, talk) }
    }

    /// Prints a line above the progress bar.
    pub(super) fn say(&self, line: &str) {
        self.progress.suspend(|| {
            let _ = writeln!(io::stderr().lock(), "{line}");
        });
    }

    /// Says what is being done, where somebody watches.
    pub(super) fn stage(&self, words: &str) {
        if !self.talk.quiet && io::stderr().is_terminal() {
            self.say(&format!("… {words}"));
        }
    }

    /// Prints why something could not be done.
    pub(super) fn refuse(&mut self, message: &str) {
        self.failed = true;
        self.say(message);
    }

    /// Prints findings, a few of each code, and counts the rest.
    pub(super) fn print(&self, findings: &[Finding]) {
        let least = match (self.talk.quiet, self.talk.verbose) {
            (true, _) => Severity::Error,
            (_, true) => Severity::Info,
            _ => Severity::Warning,
        };
        let mut counts: Vec<(&str, usize)> = Vec::new();
        for finding in findings.iter().filter(|f| f.severity >= least) {
            let at = counts.iter().position(|(code, _)| *code == finding.code).unwrap_or_else(|| {
                counts.push((finding.code, 0));
                counts.len() - 1
            });
            counts[at].1 += 1;
            if counts[at].1 <= PRINTED_PER_CODE {
                self.say(&finding.to_string());
            }
        }
        for (code, count) in counts.into_iter().filter(|(_, count)| *count > PRINTED_PER_CODE) {
            self.say(&format!("  … and {} more of {code}", count - PRINTED_PER_CODE));
        }
    }
}

fn progress(paths: &[String], talk: Talk) -> ProgressBar {
    let size = |path: &String| std::fs::metadata(path).map_or(0, |m| if m.is_file() { m.len() } else { 0 });
    let total: u64 = paths.iter().map(size).sum();
    bar(total, "{bar:40} {bytes}/{total_bytes} {bytes_per_sec}, {eta} left", total >= LONG_BYTES, talk)
}

/// A bar, hidden for short runs and where nobody watches.
pub(in crate::cli) fn bar(total: u64, template: &str, worth_it: bool, talk: Talk) -> ProgressBar {
    if !worth_it || talk.quiet || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style)
}
