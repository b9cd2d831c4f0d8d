//! Look-ups in a table of MERL's size at random directions, and opening its file.

use std::f64::consts::{FRAC_PI_2, TAU};

use divan::counter::{BytesCount, ItemsCount};
use divan::{Bencher, black_box};
use glam::DVec3;
use photopic::brdf::coordinates::HalfDiff;
use photopic::brdf::description::template::Template;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::fit::{Options, Samples, Scope, Selection, fit};
use photopic::brdf::format::merl;
use photopic::brdf::table::{Channel, HalfAngle, Resolution, Table};
use photopic::geometry::direction::from_angles;
use photopic::math::random::Stream;

fn main() {
    divan::main();
}

fn table() -> HalfAngle {
    let values = (0..3 * Resolution::MERL.bins()).map(|i| i as f32).collect();
    HalfAngle::new(Resolution::MERL, Channel::rgb(), values).expect("a table")
}

/// Pairs of directions, cosine-distributed so that all of the table is touched.
fn pairs() -> Vec<(DVec3, DVec3)> {
    let mut random = Stream::new(1, 0);
    let mut direction = || from_angles(random.uniform().sqrt() * FRAC_PI_2, random.uniform() * TAU);
    (0..1 << 16).map(|_| (direction(), direction())).collect()
}

#[divan::bench(name = "brdf/lookup/merl/nearest")]
fn nearest(bencher: Bencher) {
    let (table, pairs) = (table(), pairs());
    bencher.counter(ItemsCount::new(pairs.len())).bench(|| {
        let mut sum = 0.0_f32;
        for &(i, o) in black_box(&pairs) {
            let bin = table.nearest(i, o);
            sum += bin[0] + bin[1] + bin[2];
        }
        sum
    });
}

/// The same by arc functions, as the published reader does it.
#[divan::bench(name = "brdf/lookup/merl/arc_functions")]
fn arc_functions(bencher: Bencher) {
    let (table, pairs) = (table(), pairs());
    bencher.counter(ItemsCount::new(pairs.len())).bench(|| {
        let mut sum = 0.0_f32;
        for &(i, o) in black_box(&pairs) {
            let a = HalfDiff::new(i, o);
            let h = ((a.theta_h / FRAC_PI_2).sqrt() * 90.0) as usize;
            let d = (a.theta_d / FRAC_PI_2 * 90.0) as usize;
            let p = (a.phi_d / TAU * 360.0) as usize % 180;
            let bin = table.bin((h.min(89) * 90 + d.min(89)) * 180 + p);
            sum += bin[0] + bin[1] + bin[2];
        }
        sum
    });
}

#[divan::bench(name = "brdf/open/merl")]
fn open(bencher: Bencher) {
    let bytes = merl::write(&table()).expect("three channels");
    bencher.counter(BytesCount::new(bytes.len())).bench(|| merl::parse(black_box(&bytes)));
}

/// What opening is measured against: the same bytes copied once.
#[divan::bench(name = "brdf/open/copy")]
fn copy(bencher: Bencher) {
    let bytes = merl::write(&table()).expect("three channels");
    bencher.counter(BytesCount::new(bytes.len())).bench(|| black_box(&bytes).clone());
}

/// The best of three parameters for all 4.4 million values of a table, from a material that the model does not meet exactly.
#[divan::bench(name = "brdf/fit/merl/three_parameters", sample_count = 5, sample_size = 1)]
fn fit_three(bencher: Bencher) {
    let material: Material = "lambert(reflectance=0.2) + beckmann(alpha=0.15, f0=0.1)".parse().expect("a material");
    let brdf = material.prepare(Bands::Channels(3)).expect("a material");
    let (mut values, mut f) = (Vec::with_capacity(3 * Resolution::MERL.bins()), [0.0; 3]);
    for bin in 0..Resolution::MERL.bins() {
        let (i, o) = Resolution::MERL.centre(bin).directions();
        brdf.evaluate(i, o, &mut f);
        values.extend(f.map(|v| v as f32));
    }
    let table = Table::HalfAngle(HalfAngle::new(Resolution::MERL, Channel::rgb(), values).expect("a table"));
    let template: Template = "lambert + ggx".parse().expect("a template");
    let scope = Scope { shared: vec!["all".into()], per_band: Vec::new() };
    let options = Options { scope, ..Options::default() };
    bencher.bench(|| {
        let samples = Samples::new(&table, &Selection::default()).expect("places");
        let found = fit(&template, &samples, &options).expect("a fit");
        assert!(found.converged && found.estimates.len() == 3);
        found.measures
    });
}
