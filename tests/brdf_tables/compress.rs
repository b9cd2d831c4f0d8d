//! Compression of the 300 columns of the fitted SGD materials, five-fold, against an independent program's figures
//! (`../shared/README.md`).

use std::collections::HashMap;

use photopic::brdf::Brdf;
use photopic::brdf::compress::file::{BasisFile, FileError};
use photopic::brdf::compress::{Collection, Error, Grid, Training};
use photopic::brdf::sgd::{Band, Sgd};
use photopic::brdf::table::{Channel, HalfAngle, Known, Resolution};

use super::common;

const RESOLUTION: Resolution = Resolution { theta_h: 45, theta_d: 45, phi_d: 36 };

/// Figures of the other program: number of components or samples, median ln-rms from components, from samples.
#[expect(clippy::approx_constant, reason = "0.318 is a measured figure, not 1/π")]
const TARGETS: [(usize, f64, f64); 3] = [(5, 0.230, 0.318), (10, 0.100, 0.146), (20, 0.037, 0.072)];

fn material(row: &HashMap<String, String>) -> Sgd {
    let band = |c: &str| {
        let n = |key: &str| row[&format!("{key}_{c}")].parse::<f64>().expect("a number");
        Band {
            rho_d: n("rhoD"),
            rho_s: n("rhoS"),
            alpha: n("alpha"),
            p: n("p"),
            kappa: n("kap"),
            f0: n("f0"),
            f1: n("f1"),
            lambda: n("lam"),
            gamma: n("c"),
            k: n("k"),
            theta0: n("th0"),
        }
    };
    Sgd::new(["R", "G", "B"].map(band).to_vec()).expect("parameters in range")
}

/// A table of a material, the bins that the other program left out marked as missing.
fn table(material: &Sgd) -> HalfAngle {
    let mut values = vec![f32::NAN; 3 * RESOLUTION.bins()];
    let mut v = [0.0; 3];
    for bin in 0..RESOLUTION.bins() {
        let (i, o) = RESOLUTION.centre(bin).directions();
        if i.z > 0.02 && o.z > 0.02 {
            material.evaluate(i, o, &mut v);
            (0..3).for_each(|c| values[3 * bin + c] = v[c] as f32);
        }
    }
    HalfAngle::new(RESOLUTION, Channel::rgb(), values).expect("a table")
}

fn collect<'a>(tables: impl Iterator<Item = &'a HalfAngle>) -> (Grid, Training) {
    let mut collection = Collection::new(RESOLUTION);
    tables.for_each(|t| collection.add(t).expect("one resolution"));
    collection.train().expect("enough columns")
}

fn columns<'a>(grid: &'a Grid, table: &'a HalfAngle) -> impl Iterator<Item = Vec<f32>> + 'a {
    (0..3).map(|c| grid.bins().iter().map(|b| table.bin(*b)[c]).collect())
}

fn median(mut v: Vec<f64>) -> f64 {
    v.sort_by(f64::total_cmp);
    0.5 * (v[v.len() / 2] + v[(v.len() - 1) / 2])
}

#[test]
fn held_out_materials_come_back_as_well_as_from_another_program() {
    let Some(path) = common::shared("brdf/merl_sgd_params.csv") else { return };
    let tables: Vec<HalfAngle> = common::rows(&path).iter().map(|row| table(&material(row))).collect();
    assert_eq!(tables.len(), 100);
    let mut from_components = [const { Vec::new() }; 3];
    let mut from_samples = [const { Vec::new() }; 3];
    for fold in 0..5 {
        let part = |held: bool| tables.iter().enumerate().filter(move |(i, _)| (i % 5 == fold) == held).map(|(_, t)| t);
        let (grid, training) = collect(part(false));
        let covariance = training.covariance(60);
        let chosen = covariance.choose(20);
        let bases: Vec<_> = TARGETS.iter().map(|t| training.basis(t.0)).collect();
        for column in part(true).flat_map(|t| columns(&grid, t)) {
            for (k, (basis, (n, ..))) in bases.iter().zip(TARGETS).enumerate() {
                let back = basis.reconstruct(&basis.project(&column).expect("its bins")).expect("its components");
                from_components[k].push(basis.distance(&back, &column).expect("its bins"));
                let measured: Vec<(usize, f64)> = chosen[..n].iter().map(|&b| (b, f64::from(column[b]))).collect();
                let inferred = covariance.infer(&measured).expect("bins of the grid");
                assert_eq!(inferred.known.iter().filter(|k| **k == Known::Measured).count(), n);
                from_samples[k].push(covariance.distance(&inferred.values, &column).expect("its bins"));
            }
        }
    }
    for (k, (n, components, samples)) in TARGETS.into_iter().enumerate() {
        let found = [median(from_components[k].clone()), median(from_samples[k].clone())];
        println!("{n}: components {:.4} ({components}), samples {:.4} ({samples})", found[0], found[1]);
        // As printed: three digits.
        assert_eq!(from_components[k].len(), 300);
        assert!(found[0] < components + 5e-4, "{n} components: {}", found[0]);
        assert!(found[1] < samples + 5e-4, "{n} samples: {}", found[1]);
    }
}

/// Columns that two components span exactly, in x.
fn plane(bins: usize, columns: usize) -> (Vec<Vec<f32>>, Vec<f32>) {
    let value = |b: usize, c: usize| {
        let (s, t) = ((c as f64 * 1.3).sin(), (c as f64 * 0.7).cos());
        (0.5 + s * (b as f64 * 0.1).sin() + t * (b as f64 * 0.05).cos()).exp()
    };
    // With w = 1 and large values ε does not matter but for 1e-3/f.
    ((0..columns).map(|c| (0..bins).map(|b| (100.0 * value(b, c)) as f32).collect()).collect(), vec![1.0; bins])
}

#[test]
fn what_two_components_span_comes_back_from_two_samples() {
    let (columns, weights) = plane(300, 12);
    let training = Training::new(columns.clone(), weights).expect("columns");
    let (basis, covariance) = (training.basis(2), training.covariance(10));
    let chosen = covariance.choose(2);
    for column in &columns {
        let back = basis.reconstruct(&basis.project(column).expect("bins")).expect("two");
        // f + ε = exp(…): ε is 1e-5 of the values, which leaves the plane by as much.
        assert!(basis.distance(&back, column).expect("bins") < 1e-4);
        let measured: Vec<(usize, f64)> = chosen.iter().map(|&b| (b, f64::from(column[b]))).collect();
        let inferred = covariance.infer(&measured).expect("bins");
        assert!(chosen.iter().all(|&b| inferred.values[b] == column[b] && inferred.known[b] == Known::Measured));
        // The assumed noise of 3 % holds the prediction back by some per cent.
        assert!(covariance.distance(&inferred.values, column).expect("bins") < 0.1);
    }
}

#[test]
fn bins_that_one_table_lacks_take_no_part() {
    let resolution = Resolution { theta_h: 4, theta_d: 4, phi_d: 4 };
    let table = |lacking: usize| {
        let values = (0..64).map(|b| if b == lacking { f32::NAN } else { b as f32 + 1.0 }).collect();
        HalfAngle::new(resolution, vec![Channel::Wavelength(550.0)], values).expect("a table")
    };
    let mut collection = Collection::new(resolution);
    let before = collection.grid().bins().len();
    collection.add(&table(1)).expect("a table");
    collection.add(&table(2)).expect("a table");
    assert_eq!(collection.grid().bins().len(), before - 2);
    assert!(!collection.grid().bins().contains(&1) && !collection.grid().bins().contains(&2));
    let (grid, training) = collection.train().expect("two columns");
    assert_eq!(training.basis(5).components(), 0, "two equal columns have no components");
    let column: Vec<f32> = grid.bins().iter().map(|b| *b as f32 + 1.0).collect();
    let back = training.basis(1).reconstruct(&[]).expect("the mean");
    assert!(back.iter().zip(&column).all(|(a, b)| (a / b - 1.0).abs() < 1e-5));
}

#[test]
fn what_does_not_fit_is_refused() {
    let (columns, weights) = plane(20, 3);
    assert_eq!(Training::new(columns[..1].to_vec(), weights.clone()).err(), Some(Error::TooFew { found: 1 }));
    let basis = Training::new(columns, weights).expect("columns").basis(2);
    assert!(matches!(basis.project(&[1.0]), Err(Error::Count { found: 1, expected: 20, .. })));
    assert_eq!(basis.infer(&[(20, 1.0)]).err(), Some(Error::Bin { bin: 20, bins: 20 }));
    assert_eq!(basis.infer(&[(3, 1.0), (3, 1.0)]).err(), Some(Error::Bin { bin: 3, bins: 20 }));
}

#[test]
fn a_basis_file_comes_back_and_no_damage_passes() {
    let resolution = Resolution { theta_h: 4, theta_d: 4, phi_d: 4 };
    let mut collection = Collection::new(resolution);
    for table in 1..4 {
        let values = (0..64).map(|b| ((b * table) as f32 * 0.37).sin() + 1.5).collect();
        let table = HalfAngle::new(resolution, vec![Channel::Wavelength(550.0)], values).expect("a table");
        collection.add(&table).expect("a table");
    }
    let (grid, training) = collection.train().expect("three columns");
    let (basis, variance) = (training.covariance(2), training.variance());
    let file = BasisFile { grid, basis, weighted: false, columns: 3, variance, sources: Vec::new() };
    let mut bytes = Vec::new();
    let checksum = file.write(&mut bytes).expect("a vector takes all");
    let read = |bytes: &[u8]| BasisFile::read(&mut &bytes[..]);
    assert_eq!(read(&bytes).expect("our own file"), (file, checksum));
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x40;
        assert!(read(&damaged).is_err(), "byte {at}");
        assert!(read(&bytes[..at]).is_err(), "cut off at {at}");
    }
    bytes.push(0);
    assert!(matches!(read(&bytes), Err(FileError::Trailing)));
}
