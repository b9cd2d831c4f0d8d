//! RGL tensor files built from the published description.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use photopic::brdf::format::{Format, detect, open, rgl};
use photopic::brdf::table::{Channel, Known, Table};
use photopic::geometry::direction::from_angles;

use super::codes;

/// A field: name, type, sizes, bytes.
type Field = (&'static str, u8, Vec<u64>, Vec<u8>);

fn floats(name: &'static str, shape: &[u64], value: impl Fn(usize) -> f64) -> Field {
    let count: u64 = shape.iter().product();
    let data = (0..count as usize).flat_map(|i| (value(i) as f32).to_le_bytes()).collect();
    (name, 10, shape.to_vec(), data)
}

pub fn tensor_file(fields: &[Field]) -> Vec<u8> {
    let mut head = b"tensor_file\0\x01\0".to_vec();
    head.extend_from_slice(&(fields.len() as u32).to_le_bytes());
    let size = |f: &Field| 2 + f.0.len() + 2 + 1 + 8 + 8 * f.2.len();
    let mut offset = head.len() + fields.iter().map(size).sum::<usize>();
    let mut data = Vec::new();
    for field in fields {
        head.extend_from_slice(&(field.0.len() as u16).to_le_bytes());
        head.extend_from_slice(field.0.as_bytes());
        head.extend_from_slice(&(field.2.len() as u16).to_le_bytes());
        head.push(field.1);
        head.extend_from_slice(&(offset as u64).to_le_bytes());
        field.2.iter().for_each(|n| head.extend_from_slice(&n.to_le_bytes()));
        offset += field.3.len();
        data.extend_from_slice(&field.3);
    }
    head.extend_from_slice(&data);
    head
}

/// GGX of this roughness.
const ALPHA: f64 = 0.4;

fn ndf(theta: f64) -> f64 {
    let (sin2, cos2) = (theta.sin().powi(2), theta.cos().powi(2));
    ALPHA * ALPHA / (PI * (cos2 * ALPHA * ALPHA + sin2).powi(2))
}

/// Projected area of GGX facets, σ(θ) = (cosθ + √(cos²θ + α² sin²θ))/2.
fn area(theta: f64) -> f64 {
    0.5 * (theta.cos() + (theta.cos().powi(2) + (ALPHA * theta.sin()).powi(2)).sqrt())
}

/// A white GGX surface whose S is 1 everywhere in the first channel and equal to the place u along θ in the second.
pub fn file(n: u64) -> Vec<u8> {
    let thetas = [0.0, 0.3, 0.6, 0.9, 1.2, 1.5];
    let axis = |i: usize| i as f64 / (n - 1) as f64;
    let theta_m = |i: usize| axis(i % n as usize).powi(2) * FRAC_PI_2;
    let phi_m = |i: usize| (2.0 * axis(i / n as usize % n as usize) - 1.0) * PI;
    let visible = |i: usize| {
        let theta_i: f64 = thetas[i / (n * n) as usize];
        let m = from_angles(theta_m(i), phi_m(i));
        let cos = m.dot(from_angles(theta_i, 0.0)).max(0.0);
        // Density over the unit square: dω = sinθ dθ dφ = sinθ · π u · 2π du dv.
        ndf(theta_m(i)) * cos / area(theta_i) * theta_m(i).sin() * PI * axis(i % n as usize) * TAU
    };
    tensor_file(&[
        ("description", 1, vec![9], b"white GGX".to_vec()),
        floats("theta_i", &[6], |i| thetas[i]),
        floats("phi_i", &[1], |_| 0.0),
        floats("ndf", &[n, n], |i| ndf(theta_m(i))),
        floats("sigma", &[n, n], |i| area(theta_m(i))),
        floats("vndf", &[1, 6, n, n], visible),
        floats("spectra", &[1, 6, 2, 2, 2], |i| if i / 4 % 2 == 0 { 1.0 } else { (i % 2) as f64 }),
        floats("wavelengths", &[2], |i| [500.0, 600.0][i]),
        ("jacobian", 1, vec![1], vec![1]),
    ])
}

#[test]
fn a_white_surface_of_microfacets_comes_out_as_its_formula() {
    let bytes = file(256);
    assert_eq!(detect(&bytes), Some(Format::Rgl));
    let read = open(&bytes, None).expect("a table");
    assert_eq!(codes(&read.findings), ["B109"]);
    let Table::Adaptive(table) = &read.value.table else { panic!("adaptive") };
    assert_eq!(table.channels(), [Channel::Wavelength(500.0), Channel::Wavelength(600.0)]);
    let mut v = [0.0; 2];
    for (ti, to, dphi) in [(0.3, 0.3, PI), (0.6, 0.2, 2.0), (0.9, 1.0, 3.0), (0.6, 0.6, 0.1), (1.2, 0.5, 4.0)] {
        let (i, o) = (from_angles(ti, 0.8), from_angles(to, 0.8 + dphi));
        let m = (i + o).normalize();
        // f cosθ_o = D/(4 σ) where S = 1.
        let expected = ndf(m.z.acos()) / (4.0 * area(ti)) / o.z;
        assert_eq!(read.value.table.value(i, o, &mut v), Known::Measured);
        // Bilinear interpolation on 256 nodes of curves of unit scale: some 1e-4.
        assert!((v[0] / expected - 1.0).abs() < 2e-3, "{ti} {to} {dphi}: {} {expected}", v[0]);
    }
    assert_eq!(read.value.table.value(from_angles(1.55, 0.0), from_angles(0.3, 2.0), &mut v), Known::Inferred);
}

#[test]
fn visible_normals_are_made_uniform() {
    // Over the samples that the visible normals make, u is uniform: the mean of u D(ω_m)/4σ over ω_o is 1/2 of that of D/4σ
    // where no reflection goes below the horizon. At normal incidence all of ω_m within 45° go above it; the rest is a part of
    // what both channels lose.
    let read = open(&file(128), None).expect("a table").value.table;
    let mut v = [0.0; 2];
    let (mut white, mut along) = (0.0, 0.0);
    // u is the conditional along θ_m: below a θ_m its share is ∫ D cosθ dω = sin²θ/(cos²θ α² + sin²θ) for GGX.
    for k in 1..400 {
        let theta_m = f64::from(k) / 400.0 * 0.25 * PI;
        let o = from_angles(2.0 * theta_m, 1.0);
        if o.z <= 0.01 {
            break;
        }
        read.value(from_angles(0.0, 0.0), o, &mut v);
        let sin2 = theta_m.sin().powi(2);
        let share = sin2 / (theta_m.cos().powi(2) * ALPHA * ALPHA + sin2);
        assert!((v[1] / v[0] - share).abs() < 5e-3, "{theta_m}: {} {share}", v[1] / v[0]);
        white += v[0];
        along += v[1];
    }
    assert!(white > along && along > 0.0);
}

#[test]
fn quarters_of_the_circle_are_mirrored() {
    // S depends on φ_i alone, tabulated from −π to −π/2: the same for all four mirror images.
    let bytes = tensor_file(&[
        floats("theta_i", &[2], |i| [0.0, 1.5][i]),
        floats("phi_i", &[3], |i| -PI + 0.25 * PI * i as f64),
        floats("ndf", &[2, 2], |_| 1.0),
        floats("sigma", &[2, 2], |_| 1.0),
        floats("vndf", &[3, 2, 2, 2], |_| 1.0),
        floats("rgb", &[3, 2, 3, 2, 2], |i| (i / 24) as f64 + 1.0),
        ("jacobian", 1, vec![1], vec![0]),
    ]);
    let table = rgl::parse(&bytes).expect("a table").value;
    let mut v = [0.0; 3];
    for phi in [0.125 * PI, -0.125 * PI, 0.875 * PI, -0.875 * PI] {
        let o = from_angles(0.3, 1.0);
        table.value(from_angles(0.5, phi), o, &mut v);
        // Half way between the slices 1 and 2.
        assert!((v[0] * o.z - 1.5).abs() < 1e-6, "{phi}: {}", v[0] * o.z);
    }
    assert!(!table.is_isotropic());
}
