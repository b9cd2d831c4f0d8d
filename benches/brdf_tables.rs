//! Look-ups in a table of MERL's size at random directions, and opening its file.

use std::f64::consts::{FRAC_PI_2, TAU};

use divan::counter::{BytesCount, ItemsCount};
use divan::{Bencher, black_box};
use glam::DVec3;
use photopic::brdf::coordinates::HalfDiff;
use photopic::brdf::format::merl;
use photopic::brdf::table::{Channel, HalfAngle, Resolution};
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
