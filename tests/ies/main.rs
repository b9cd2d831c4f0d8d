//! LM-63 files: every one in `../shared/luminaires` against an independent reader, mutants with known answers, files of our
//! own that must be refused, round trips through every edition, and hostile bytes.

#[path = "../common/mod.rs"]
mod common;
mod files;
mod properties;
mod rules;

use photopic::finding::{Checked, Finding};
use photopic::luminaire::Luminaire;
use photopic::luminaire::format::Error;
use photopic::luminaire::format::ies::{self, ReadOptions};

/// A small file of which the tests change one thing at a time: 100 cd everywhere to 90°.
const SMALL: &str = "IESNA:LM-63-1995\n[TEST] 1\n[MANUFAC] Maker\n[MORE] & Sons\nTILT=NONE\n\
    1 1000 1 3 1 1 2 0.1 0.2 0\n1 1 10\n0 45 90\n0\n100 100 100\n";

/// 2π · 100.
const SMALL_FLUX: f64 = 628.318_530_717_958_6;

fn read(bytes: &[u8]) -> Result<Checked<Luminaire>, Error> {
    ies::read(bytes, ReadOptions::default())
}

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(|f| f.code).collect()
}
