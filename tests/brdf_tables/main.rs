//! Measured BRDFs: real files of `../shared/brdf`, files built from the published descriptions of formats, hostile ones, and
//! compression on the set of fitted materials.

mod brdf;
#[path = "../common/mod.rs"]
mod common;
mod compress;
mod half_angle;
mod invalid;
mod real;
mod rgl;
mod synthetic;

use photopic::finding::Finding;

fn codes(findings: &[Finding]) -> Vec<&'static str> {
    findings.iter().map(|f| f.code).collect()
}

/// A file of `../shared/brdf`.
fn shared(name: &str) -> Option<Vec<u8>> {
    let path = common::shared("brdf")?.join(name);
    Some(std::fs::read(path).expect("the file of the shared folder"))
}
