//! pbrt-v4: the scene's `Rotate`, the swap of y and z, the equal-area octahedral mapping and the nearest pixel.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DMat3, DVec3};
use photopic::luminaire::export::pbrt::write;
use photopic::luminaire::{Distribution, Luminaire, Symmetry, System};

use super::lamp::{asymmetric, directions, exr_pixels, flux_bound, lamp, slope, steps, tables, type_b};

/// From the sphere to the unit square (Clarberg 2008): the upper half on the inner diamond, the lower half folded outside.
fn square(d: DVec3) -> (f64, f64) {
    let (x, y) = (d.x.abs(), d.y.abs());
    let r = (1.0 - d.z.abs()).max(0.0).sqrt();
    let turn = if x == 0.0 && y == 0.0 { 0.0 } else { y.atan2(x) / FRAC_PI_2 };
    let (mut u, mut v) = (r * (1.0 - turn), r * turn);
    if d.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    (0.5 * (u.copysign(d.x) + 1.0), 0.5 * (v.copysign(d.y) + 1.0))
}

/// From the unit square to the sphere, the inverse.
fn sphere(s: f64, t: f64) -> DVec3 {
    let (u, v) = (2.0 * s - 1.0, 2.0 * t - 1.0);
    let distance = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - distance.abs();
    let phi = if r == 0.0 { PI / 4.0 } else { ((v.abs() - u.abs()) / r + 1.0) * PI / 4.0 };
    let across = r * (2.0 - r * r).max(0.0).sqrt();
    let z = (1.0 - r * r).copysign(distance);
    DVec3::new(phi.cos().copysign(u) * across, phi.sin().copysign(v) * across, z)
}

/// A table with all its planes, for its slope.
fn unfolded(d: &Distribution) -> Distribution {
    if d.symmetry() == Symmetry::Rotational {
        return d.clone();
    }
    let planes = steps(0.0, 360.0, 7.5);
    let values = planes.iter().flat_map(|c| d.vertical_deg().iter().map(|g| d.at(*c, *g))).collect();
    Distribution::new(System::TypeC, Symmetry::None, planes.clone(), d.vertical_deg().to_vec(), values)
        .expect("a table")
}

/// The light as pbrt reads it.
struct Light {
    /// From the picture's frame to the scene's.
    to_scene: DMat3,
    side: usize,
    pixels: Vec<f32>,
    scale: f64,
}

impl Light {
    fn read(luminaire: &Luminaire, side: Option<usize>) -> Self {
        let files = write(luminaire, "lamp", side).expect("exported").value;
        assert_eq!(files.iter().map(|f| f.suffix.as_str()).collect::<Vec<_>>(), [".pbrt", ".exr"]);
        let scene = String::from_utf8(files[0].bytes.clone()).expect("text");
        let statements: Vec<&str> = scene.lines().map(str::trim).filter(|l| !l.starts_with('#')).collect();
        let rotate = statements.iter().find_map(|l| l.strip_prefix("Rotate ")).expect("a rotation");
        let n: Vec<f64> = rotate.split(' ').map(|w| w.parse().expect("a number")).collect();
        let rotation = DMat3::from_axis_angle(DVec3::new(n[1], n[2], n[3]), n[0].to_radians());
        // GoniometricLight::Create appends a matrix that swaps y and z.
        let swap = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y);
        let light = statements.iter().find(|l| l.starts_with("LightSource \"goniometric\"")).expect("a light");
        assert!(light.contains("\"string filename\" \"lamp.exr\""), "{light}");
        let scale = light.split("\"float scale\"").nth(1).expect("a scale").trim().parse().expect("a number");
        let (width, height, pixels, comment) = exr_pixels(&files[1].bytes);
        assert!(width == height && comment.contains("centre = photometric axis (-z), right = C0"), "{comment}");
        Self { to_scene: rotation * swap, side: width, pixels, scale }
    }

    fn at(&self, direction: DVec3) -> f64 {
        let (s, t) = square(self.to_scene.inverse() * direction);
        let pixel = |x: f64| ((x * self.side as f64) as usize).min(self.side - 1);
        self.scale * f64::from(self.pixels[pixel(t) * self.side + pixel(s)])
    }

    /// From a pixel's centre to any of its points: dθ ≤ 2 d(|u| + |v|), and a pixel is 2/N wide in u and v.
    fn reach_rad(&self) -> f64 {
        4.0 / self.side as f64
    }
}

#[test]
fn the_published_mapping_is_its_own_inverse() {
    for d in directions(2000) {
        let (s, t) = square(d);
        assert!((sphere(s, t) - d).length() < 1e-7, "{d}");
    }
    // The centre is +z, the corners −z, the right side +x.
    assert!((sphere(0.5, 0.5) - DVec3::Z).length() < 1e-15 && (sphere(0.0, 1.0) + DVec3::Z).length() < 1e-15);
    assert!((sphere(1.0, 0.5) - DVec3::X).length() < 1e-15 && (sphere(0.5, 1.0) - DVec3::Y).length() < 1e-15);
}

#[test]
fn every_symmetry_and_type_is_as_near_as_its_pixel() {
    let whole = tables().into_iter().take(5).map(|d| (slope(&unfolded(&d)), d));
    // Type B: the formula's gradient and a tenth for the table's slopes; it is dark behind.
    let gradient = 1.1 * DVec3::new(200.0, 120.0, 300.0).length();
    for (slope, distribution) in whole.chain([(gradient, type_b())]) {
        let light = Light::read(&lamp(distribution.clone()), Some(256));
        let bound = slope * light.reach_rad();
        assert!(bound < 20.0, "{bound}");
        for d in directions(2000) {
            let (got, expected) = (light.at(d), distribution.towards(d));
            if distribution.system() == System::TypeC || d.z.abs() > light.reach_rad() {
                assert!((got - expected).abs() <= bound, "{d}: {got} {expected}");
            }
        }
    }
}

#[test]
fn half_a_sphere_of_light_is_half_of_the_picture() {
    let distribution =
        Distribution::new(System::TypeC, Symmetry::Rotational, vec![0.0], vec![0.0, 90.0], vec![100.0, 100.0]);
    let light = Light::read(&lamp(distribution.expect("a table")), Some(64));
    let mean = light.pixels.iter().map(|v| f64::from(*v)).sum::<f64>() / light.pixels.len() as f64;
    assert!((mean - 50.0).abs() < 1e-6, "{mean}");
}

#[test]
fn any_direction_is_as_near_as_its_pixel() {
    let luminaire = asymmetric();
    let light = Light::read(&luminaire, None);
    let bound = slope(&luminaire.distribution) * light.reach_rad();
    assert!(bound < 0.01 * 500.0, "{bound}");
    for d in directions(20_000) {
        let (got, expected) = (light.at(d), luminaire.distribution.towards(d));
        assert!((got - expected).abs() <= bound, "{d}: {got} {expected}");
    }
    let sum: f64 = light.pixels.iter().map(|v| f64::from(*v)).sum();
    let flux = light.scale * 4.0 * PI * sum / light.pixels.len() as f64;
    assert!((flux - luminaire.distribution.total_flux()).abs() <= flux_bound(bound), "{flux}");
}

#[test]
fn what_a_point_light_loses_is_said() {
    let dark = lamp(asymmetric().distribution.scaled(-1.0));
    let findings = write(&dark, "lamp", Some(8)).expect("exported").findings;
    let codes: Vec<&str> = findings.iter().map(|f| f.code).collect();
    assert_eq!(codes, ["L501", "L505", "L502", "L504"]);
    assert!(write(&dark, "lamp", Some(7)).is_err() && write(&dark, "lamp", Some(8193)).is_err());
}
