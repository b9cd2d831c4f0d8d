//! The equirectangular picture: C by column, γ by row, as its comment says.

use photopic::luminaire::export::equirectangular::write;
use photopic::luminaire::{Kind, Luminaire};

use super::lamp::{asymmetric, exr_pixels, flux_bound, lamp, slope, tables, type_b};

#[test]
fn every_pixel_is_the_lamp_at_the_angles_that_the_file_states() {
    for luminaire in tables().into_iter().map(lamp).chain([lamp(type_b())]) {
        let files = write(&luminaire, Some(90)).expect("exported").value;
        let (width, height, pixels, comment) = exr_pixels(&files[0].bytes);
        assert_eq!((width, height), (180, 90));
        assert!(comment.contains("C = (i + 0.5) * 2 deg, gamma = 180 - (j + 0.5) * 2 deg"), "{comment}");
        let d = &luminaire.distribution;
        for (at, pixel) in pixels.iter().enumerate() {
            let (c, gamma) = (2.0 * (at % width) as f64 + 1.0, 179.0 - 2.0 * (at / width) as f64);
            let ((sc, cc), (sg, cg)) = (c.to_radians().sin_cos(), gamma.to_radians().sin_cos());
            let expected = d.towards(glam::DVec3::new(sg * cc, sg * sc, -cg));
            assert!((f64::from(*pixel) - expected).abs() <= 1e-6 * d.peak().0, "C{c} γ{gamma}: {pixel} {expected}");
        }
    }
}

#[test]
fn the_flux_of_the_picture_is_the_lamps() {
    let luminaire = asymmetric();
    let files = write(&luminaire, None).expect("exported").value;
    let (width, height, pixels, _) = exr_pixels(&files[0].bytes);
    assert_eq!((width, height), (2048, 1024));
    let edge = |j: usize| (std::f64::consts::PI * j as f64 / height as f64).cos();
    let cell = |j: usize| (edge(j) - edge(j + 1)) * std::f64::consts::TAU / width as f64;
    let flux: f64 = pixels.iter().enumerate().map(|(at, v)| f64::from(*v) * cell(at / width)).sum();
    // With slopes of at most L: a linear function times the sine is off by L h/12 · |cosγ|; a pixel with a kink, which is a change
    // of slope of at most 2L, by 2L h/8, and 35 inner rows and 23 inner planes of the table cross so many of the pixels.
    let (h, l) = (std::f64::consts::PI / height as f64, slope(&luminaire.distribution));
    let crossed = 35.0 / height as f64 + 23.0 / width as f64;
    let bound = flux_bound(l * h * (h / 12.0 + crossed / 4.0));
    assert!((flux - luminaire.distribution.total_flux()).abs() <= bound, "{flux} {bound}");
}

#[test]
fn other_quantities_keep_their_unit_and_sign() {
    let luminaire =
        Luminaire { kind: Kind::Photon, distribution: asymmetric().distribution.scaled(-1.0), ..asymmetric() };
    let files = write(&luminaire, Some(8)).expect("exported").value;
    let (_, _, pixels, comment) = exr_pixels(&files[0].bytes);
    assert!(pixels.iter().all(|v| *v < 0.0));
    assert!(comment.contains("umol/(s sr)"), "{comment}");
}
