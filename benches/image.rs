//! Spectral images in memory, 1024 × 1024 pixels of 31 bands in `f32` (130 MB): `image/read/…` is the plain reading of those
//! bytes, the roof; `image/xyz/…` and `image/luminance/…` the conversion; `image/envi/…` a whole conversion from an ENVI file in
//! memory, numbers decoded and put in order included.

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use photopic::colorimetry::Observer;
use photopic::image::format::envi::{self, Interleave, Options, WriteOptions};
use photopic::image::kernel::Weights;
use photopic::image::{Channel, Content, Converted, Description, Memory, Plan, Region, Settings, Source, Target};
use photopic::spectrum::integrate::{Contract, weights};
use photopic::spectrum::{Grid, Sampling};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

const SIZE: usize = 1024;
const BANDS: usize = 31;
const BYTES: usize = SIZE * SIZE * BANDS * 4;

fn main() {
    divan::main();
}

/// Samples that differ from one another, all below 1.
fn samples() -> Vec<f32> {
    (0..SIZE * SIZE * BANDS).map(|i| (i as u32).wrapping_mul(2_654_435_761) as f32 * 2.0_f32.powi(-32)).collect()
}

fn xyz_weights() -> Weights {
    let grid = Grid::uniform(400.0, 10.0, BANDS).expect("ascending");
    let of = |w| weights(&grid, Sampling::Density, &w, &Contract::default()).expect("a rule");
    Weights::new(&Observer::Cie1931.colour_matching_functions().map(of))
}

/// Reads every byte once.
#[divan::bench(args = [1, 2])]
fn read(bencher: Bencher, threads: usize) {
    let samples = samples();
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    bencher.counter(BytesCount::new(BYTES)).bench_local(|| {
        let sum = |row: &[f32]| {
            let mut sums = [0_u32; 32];
            for chunk in row.chunks_exact(32) {
                sums.iter_mut().zip(chunk).for_each(|(s, v)| *s = s.wrapping_add(v.to_bits()));
            }
            sums.into_iter().fold(0, u32::wrapping_add)
        };
        pool.install(|| {
            let rows = black_box(&samples).par_chunks_exact(SIZE * BANDS);
            black_box(rows.map(sum).reduce(|| 0, u32::wrapping_add))
        })
    });
}

/// X, Y, Z of every pixel.
#[divan::bench(args = [1, 2])]
fn xyz(bencher: Bencher, threads: usize) {
    planes(bencher, threads, &xyz_weights());
}

/// One plane.
#[divan::bench(args = [1, 2])]
fn luminance(bencher: Bencher, threads: usize) {
    planes(bencher, threads, &Weights::new(&[vec![0.5; BANDS]]));
}

fn planes(bencher: Bencher, threads: usize, weights: &Weights) {
    let samples = samples();
    let mut out = vec![0.0; SIZE * SIZE * weights.outputs()];
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    bencher.counter(BytesCount::new(BYTES)).bench_local(|| {
        pool.install(|| {
            let rows = black_box(&samples).par_chunks_exact(SIZE * BANDS);
            let out = out.par_chunks_exact_mut(SIZE * weights.outputs());
            rows.zip(out).for_each(|(row, out)| weights.apply(row, SIZE, out, SIZE));
        });
        black_box(&out);
    });
}

/// A file in memory to XYZ, two threads.
#[divan::bench(args = ["bsq", "bil", "bip"])]
fn envi(bencher: Bencher, interleave: &str) {
    let channels = (0..BANDS).map(|i| Channel::band(format!("b{i}"), "", 400.0 + 10.0 * i as f64)).collect();
    let mut description = Description::planes(SIZE, SIZE, channels);
    description.content = Content::Light { quantity: None, unit: Some("W/m2/sr/nm".parse().expect("a unit")) };
    let interleave = [Interleave::Bsq, Interleave::Bil, Interleave::Bip]
        .into_iter()
        .find(|i| i.word() == interleave)
        .expect("one of three");
    let (mut header, mut data) = (Vec::new(), std::io::Cursor::new(Vec::new()));
    let options = WriteOptions { interleave, ..WriteOptions::default() };
    envi::write(&mut header, &mut data, &mut Memory::new(description, samples()), options).expect("writes");
    let source = envi::open(&header, data, Options::default()).expect("opens").value;
    let target = Target::Xyz(Observer::Cie1931);
    let plan = Plan::new(source.description(), &target, &Settings::default()).expect("a plan").value;
    let mut converted = Converted::new(source, plan);
    let region = Region { x: 0, y: 0, width: SIZE, height: SIZE };
    let mut out = vec![0.0; region.pixels() * 3];
    bencher.counter(BytesCount::new(BYTES)).bench_local(|| {
        converted.read(region, &[0, 1, 2], black_box(&mut out)).expect("memory does not fail");
    });
}
