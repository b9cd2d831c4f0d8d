//! Look-ups in a table of MERL's size at random directions, and opening its file.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use divan::counter::{BytesCount, ItemsCount};
use divan::{Bencher, black_box};
use glam::DVec3;
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

#[divan::bench(name = "brdf/lookup/merl/nearest_many")]
fn nearest_many(bencher: Bencher) {
    let (table, pairs) = (table(), pairs());
    let mut bins = vec![0; pairs.len()];
    bencher.counter(ItemsCount::new(pairs.len())).bench_local(|| {
        table.bins_of(black_box(&pairs), &mut bins);
        bins.iter().map(|b| table.bin(*b).iter().sum::<f32>()).sum::<f32>()
    });
}

/// What finding the bins costs without the table.
#[divan::bench(name = "brdf/lookup/merl/bins_alone")]
fn bins_alone(bencher: Bencher) {
    let (table, pairs) = (table(), pairs());
    let mut bins = vec![0; pairs.len()];
    bencher.counter(ItemsCount::new(pairs.len())).bench_local(|| table.bins_of(black_box(&pairs), &mut bins));
}

/// What the table costs without finding the bins.
#[divan::bench(name = "brdf/lookup/merl/memory_alone")]
fn memory_alone(bencher: Bencher) {
    let (table, pairs) = (table(), pairs());
    let mut bins = vec![0; pairs.len()];
    table.bins_of(&pairs, &mut bins);
    bencher
        .counter(ItemsCount::new(pairs.len()))
        .bench_local(|| black_box(&bins).iter().map(|b| table.bin(*b).iter().sum::<f32>()).sum::<f32>());
}

/// The same with the arithmetic of the reader that was published with the tables: the half vector by its angles, ω_i turned about two
/// axes, arc cosines and arc tangents, three planes of doubles.
#[divan::bench(name = "brdf/lookup/merl/published")]
fn published(bencher: Bencher) {
    let bins = Resolution::MERL.bins();
    let planes: Vec<f64> = (0..3 * bins).map(|i| i as f64).collect();
    let pairs = pairs();
    let turned = |v: DVec3, axis: DVec3, angle: f64| {
        let (sin, cos) = angle.sin_cos();
        v * cos + axis * (axis.dot(v) * (1.0 - cos)) + axis.cross(v) * sin
    };
    bencher.counter(ItemsCount::new(pairs.len())).bench(|| {
        let mut sum = 0.0;
        for &(i, o) in black_box(&pairs) {
            let half = (0.5 * (i + o)).normalize();
            let (theta_h, phi_h) = (half.z.acos(), half.y.atan2(half.x));
            let difference = turned(turned(i, DVec3::Z, -phi_h), DVec3::Y, -theta_h);
            let (theta_d, phi_d) = (difference.z.acos(), difference.y.atan2(difference.x));
            let phi_d = if phi_d < 0.0 { phi_d + PI } else { phi_d };
            let h = ((theta_h.max(0.0) / FRAC_PI_2 * 8100.0).sqrt() as usize).min(89);
            let d = ((theta_d / FRAC_PI_2 * 90.0) as usize).min(89);
            let p = ((phi_d / PI * 180.0) as usize).min(179);
            let bin = (h * 90 + d) * 180 + p;
            sum +=
                planes[bin] / 1500.0 + planes[bin + bins] * (1.15 / 1500.0) + planes[bin + 2 * bins] * (1.66 / 1500.0);
        }
        sum
    });
}

#[divan::bench(name = "brdf/open/merl")]
fn open(bencher: Bencher) {
    let bytes = merl::write(&table()).expect("three channels");
    bencher.counter(BytesCount::new(bytes.len())).bench(|| merl::parse(black_box(&bytes)));
}

/// What opening is measured against: the same bytes read from a file that the system has in memory.
#[divan::bench(name = "brdf/open/read")]
fn read(bencher: Bencher) {
    let bytes = merl::write(&table()).expect("three channels");
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), &bytes).expect("written");
    bencher.counter(BytesCount::new(bytes.len())).bench(|| std::fs::read(file.path()));
}

/// The table of the same file, as a user opens it.
#[divan::bench(name = "brdf/open/file")]
fn open_file(bencher: Bencher) {
    let bytes = merl::write(&table()).expect("three channels");
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), &bytes).expect("written");
    bencher.counter(BytesCount::new(bytes.len())).bench(|| {
        let mut file = std::fs::File::open(file.path()).expect("the file");
        merl::read(&mut file, bytes.len() as u64)
    });
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
