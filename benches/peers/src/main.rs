//! `peers IMPLEMENTATION TASK` does one task once to warm up and then until 0.1 s have passed, and prints JSON: CPU seconds
//! for one pass, the spectra in it, and the mean result, which it has checked.
//!
//! Implementations: `photopic`, `photopic-1` (one spectrum at a time), `colorimetry` (the crate), `colorimetry-1nm` (its
//! resampling to 401 samples done beforehand). Tasks: `xyz`, `cct`, `cri`, `tm30`, and of photopic `cold`: the first
//! conversion in a process, tables and plans included, and `image`: 1024 rows of 1024 pixels of 31 bands to X, Y, Z, beside
//! which `read` reads the same bytes. `lm63-plain` and `lm63-long` of photopic and `eulumdat`: see `lamps`.

mod lamps;
#[path = "../../samples/mod.rs"]
mod samples;

use std::hint::black_box;

use colorimetry::illuminant::{CFI, CRI, Illuminant};
use colorimetry::observer::Observer::Cie1931;
use colorimetry::spectrum::Spectrum as OneNanometre;
use cpu_time::ThreadTime;
use photopic::colorimetry::observer::{self, Observer};
use photopic::colorimetry::{cct, chromaticity, cri, tm30};
use photopic::constants::{K_M, SecondRadiation};
use photopic::conversion::{Converter, Settings};
use photopic::photometry::luminous::{self, Efficacy, Efficiency};
use photopic::image::kernel::Weights;
use photopic::spectrum::integrate::{Contract, Matrix, Rule};
use photopic::spectrum::{Grid, Quantity, Sampling, Spectrum};
use samples::{
    IMAGE_BANDS, IMAGE_SIZE, MEAN_CCT, MEAN_IMAGE_Y, MEAN_RA, MEAN_RF, MEAN_XYZ, SAMPLES, assert_mean, grid, rows, spectra_at,
};

const C2: SecondRadiation = SecondRadiation::Its90;
const SAMPLING: Sampling = Sampling::Density;
/// Time to measure for, s.
const AT_LEAST: f64 = 0.1;

fn main() {
    let mut words = std::env::args().skip(1);
    let (implementation, task) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    match (implementation.as_str(), task.as_str()) {
        ("photopic", "xyz") => photopic_xyz(),
        ("photopic-1", "xyz") => photopic_xyz_one_by_one(),
        ("photopic", "cct") => photopic_cct(),
        ("photopic", "cri") => photopic_cri(),
        ("photopic", "tm30") => photopic_tm30(),
        ("photopic", "cold") => photopic_cold(),
        ("photopic", "image") => photopic_image(),
        ("read", "image") => read_image(),
        ("colorimetry", "xyz") => crate_xyz(),
        ("colorimetry-1nm", "xyz") => crate_xyz_ready(),
        ("colorimetry-1nm", "cct") => crate_cct(),
        ("colorimetry-1nm", "cri") => crate_cri(),
        ("colorimetry-1nm", "tm30") => crate_tm30(),
        (implementation, task) if task.starts_with("lm63") => lamps::run(implementation, task),
        _ => panic!("no task `{task}` of `{implementation}`"),
    }
}

/// Times passes that fill `out`, in CPU time so that other programs do not count, and prints; the mean of `out` is held against `want`.
fn race<T>(out: &mut [T], value: impl Fn(&T) -> f64, (want, tolerance): (f64, f64), mut pass: impl FnMut(&mut [T])) {
    pass(out);
    let start = ThreadTime::now();
    let mut passes = 0;
    while passes == 0 || start.elapsed().as_secs_f64() < AT_LEAST {
        pass(black_box(out));
        passes += 1;
    }
    let seconds = start.elapsed().as_secs_f64() / f64::from(passes);
    let values: Vec<f64> = out.iter().map(value).collect();
    assert_mean(&values, want, tolerance);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    println!(r#"{{"seconds": {seconds:e}, "spectra": {}, "mean": {mean}}}"#, out.len());
}

fn plans() -> (observer::Plan, luminous::Plan) {
    let (grid, contract) = (grid(), Contract::default());
    let colour = observer::Plan::new(Observer::Cie1931, &grid, SAMPLING, &contract);
    let luminous = luminous::Plan::new(Efficiency::default(), Efficacy::default(), &grid, SAMPLING, &contract);
    (colour.expect("a rule for equal steps"), luminous.expect("a rule for equal steps"))
}

fn kelvin(plan: &observer::Plan, row: &[f64]) -> f64 {
    let uv = chromaticity::uv_1960(plan.xyz(row)).expect("light");
    cct::nearest(uv, C2).expect("near the locus").kelvin
}

fn photopic_xyz() {
    let (colour, luminous) = plans();
    let luminance: Vec<f64> = luminous.photopic_weights().iter().map(|w| w * K_M).collect();
    let [x, y, z] = colour.weights().each_ref().map(Vec::as_slice);
    let matrix = Matrix::new([x, y, z, &luminance]);
    let values = rows(100_000);
    let want = (K_M * MEAN_XYZ[1], 1e-5);
    race(&mut vec![[0.0; 4]; 100_000], |v| v[3], want, |out| matrix.integrals(&values, out));
}

/// The image of `IMAGE_SIZE`² pixels: by row, then band, then pixel.
fn image() -> Vec<f32> {
    let mut out = vec![0.0; IMAGE_SIZE * IMAGE_SIZE * IMAGE_BANDS];
    for (i, spectrum) in spectra_at(400.0, 10.0, IMAGE_BANDS).take(IMAGE_SIZE * IMAGE_SIZE).enumerate() {
        let (x, y) = (i % IMAGE_SIZE, i / IMAGE_SIZE);
        for (band, value) in spectrum.enumerate() {
            out[(y * IMAGE_BANDS + band) * IMAGE_SIZE + x] = value as f32;
        }
    }
    out
}

fn photopic_image() {
    let grid = Grid::uniform(400.0, 10.0, IMAGE_BANDS).expect("ascending");
    let sum = Contract { rule: Some(Rule::Summation), range_nm: None };
    let plan = observer::Plan::new(Observer::Cie1931, &grid, SAMPLING, &sum).expect("a rule for equal steps");
    let weights = Weights::new(plan.weights());
    let image = image();
    let mean_y = |row: &Vec<f32>| {
        row[IMAGE_SIZE..2 * IMAGE_SIZE].iter().map(|v| f64::from(*v)).sum::<f64>() / IMAGE_SIZE as f64
    };
    race(&mut vec![vec![0.0; 3 * IMAGE_SIZE]; IMAGE_SIZE], mean_y, (MEAN_IMAGE_Y, 1e-4), |out| {
        for (row, out) in image.chunks_exact(IMAGE_SIZE * IMAGE_BANDS).zip(out) {
            weights.apply(row, IMAGE_SIZE, out, IMAGE_SIZE);
        }
    });
}

fn read_image() {
    let image = image();
    race(&mut vec![0_u32; IMAGE_SIZE], |v| f64::from(*v), (0.0, f64::INFINITY), |out| {
        for (row, out) in image.chunks_exact(IMAGE_SIZE * IMAGE_BANDS).zip(out) {
            let mut sums = [0_u32; 32];
            for chunk in row.chunks_exact(32) {
                sums.iter_mut().zip(chunk).for_each(|(s, v)| *s = s.wrapping_add(v.to_bits()));
            }
            *out = sums.into_iter().fold(0, u32::wrapping_add);
        }
    });
}

fn photopic_xyz_one_by_one() {
    let (colour, luminous) = plans();
    let values = rows(100_000);
    race(
        &mut vec![([0.0; 3], 0.0); 100_000],
        |v| v.1,
        (K_M * MEAN_XYZ[1], 1e-5),
        |out| {
            for (row, out) in values.chunks_exact(SAMPLES).zip(out) {
                *out = (colour.xyz(row), luminous.evaluate(row).photopic);
            }
        },
    );
}

fn photopic_cct() {
    let (colour, _) = plans();
    let xyz: Vec<[f64; 3]> = rows(10_000).chunks_exact(SAMPLES).map(|row| colour.xyz(row)).collect();
    race(
        &mut vec![0.0; xyz.len()],
        |v| *v,
        (MEAN_CCT, 1e-4),
        |out| {
            for (xyz, out) in xyz.iter().zip(out) {
                let uv = chromaticity::uv_1960(*xyz).expect("light");
                *out = cct::nearest(uv, C2).expect("near the locus").kelvin;
            }
        },
    );
}

fn photopic_cri() {
    let (colour, _) = plans();
    let plan = cri::Plan::new(&grid(), SAMPLING, &Contract::default(), C2).expect("compiles");
    let values = rows(1000);
    race(
        &mut vec![0.0; 1000],
        |v| *v,
        (MEAN_RA, 0.2),
        |out| {
            for (row, out) in values.chunks_exact(SAMPLES).zip(out) {
                *out = plan.evaluate(row, kelvin(&colour, row)).expect("light").ra;
            }
        },
    );
}

fn photopic_tm30() {
    let (colour, _) = plans();
    let plan = tm30::Plan::new(&grid(), SAMPLING, &Contract::default(), C2).expect("compiles");
    let values = rows(100);
    race(
        &mut vec![0.0; 100],
        |v| *v,
        (MEAN_RF, 0.02),
        |out| {
            for (row, out) in values.chunks_exact(SAMPLES).zip(out) {
                *out = plan.evaluate(row, kelvin(&colour, row)).expect("a white light").rf;
            }
        },
    );
}

fn photopic_cold() {
    let spectrum = Spectrum::density(grid(), rows(1)).expect("finite");
    let start = ThreadTime::now();
    let done = Converter::new(Settings::default()).convert("", Quantity::Relative, &spectrum).expect("converts");
    let seconds = start.elapsed().as_secs_f64();
    let rf = done.value.tm30.expect("a white light").rf;
    println!(r#"{{"seconds": {seconds:e}, "spectra": 1, "mean": {rf}}}"#);
}

/// The crate's spectrum of 401 samples by 1 nm.
fn resampled(row: &[f64]) -> OneNanometre {
    OneNanometre::linear_interpolate(&[380.0, 780.0], row).expect("81 samples")
}

fn illuminants(count: usize) -> Vec<Illuminant> {
    rows(count).chunks_exact(SAMPLES).map(|row| Illuminant::new(resampled(row))).collect()
}

/// The crate sums by 1 nm and puts K_m in front; straight lines between samples and fewer spectra make 0.1 %.
fn crate_luminance() -> (f64, f64) {
    (683.0 * MEAN_XYZ[1], 60.0)
}

fn crate_xyz() {
    let values = rows(10_000);
    race(
        &mut vec![[0.0; 3]; 10_000],
        |v| v[1],
        crate_luminance(),
        |out| {
            for (row, out) in values.chunks_exact(SAMPLES).zip(out) {
                *out = Cie1931.xyz_from_spectrum(&resampled(row)).to_array();
            }
        },
    );
}

fn crate_xyz_ready() {
    let spectra: Vec<OneNanometre> = rows(10_000).chunks_exact(SAMPLES).map(resampled).collect();
    race(
        &mut vec![[0.0; 3]; 10_000],
        |v| v[1],
        crate_luminance(),
        |out| {
            for (spectrum, out) in spectra.iter().zip(out) {
                *out = Cie1931.xyz_from_spectrum(spectrum).to_array();
            }
        },
    );
}

fn crate_cct() {
    let spectra = rows(10_000);
    let xyz: Vec<_> = spectra.chunks_exact(SAMPLES).map(|row| Cie1931.xyz_from_spectrum(&resampled(row))).collect();
    race(
        &mut vec![0.0; xyz.len()],
        |v| *v,
        (MEAN_CCT, 5.0),
        |out| {
            for (xyz, out) in xyz.iter().zip(out) {
                *out = xyz.cct().expect("near the locus").t();
            }
        },
    );
}

fn crate_cri() {
    let lights = illuminants(1000);
    race(
        &mut vec![0.0; 1000],
        |v| *v,
        (MEAN_RA, 0.5),
        |out| {
            for (light, out) in lights.iter().zip(out) {
                *out = CRI::try_from(light).expect("a white light").ra();
            }
        },
    );
}

fn crate_tm30() {
    let lights = illuminants(100);
    race(
        &mut vec![0.0; 100],
        |v| *v,
        (MEAN_RF, 0.5),
        |out| {
            for (light, out) in lights.iter().zip(out) {
                *out = CFI::new(light).expect("a white light").color_fidelity_index();
            }
        },
    );
}
