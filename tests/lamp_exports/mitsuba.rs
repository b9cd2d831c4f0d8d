//! Mitsuba 3: six `projector`s, each a pinhole camera in reverse; the pictures are read bilinearly. The rule is that of
//! `projector.cpp` and `perspective_projection`; `scripts/check_lamp_exports.py` asks Mitsuba itself.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use photopic::luminaire::Luminaire;
use photopic::luminaire::export::mitsuba::write;

use super::lamp::{asymmetric, directions, exr_pixels, flux_bound, lamp, slope, tables};

struct Projector {
    to_world: DMat3,
    side: usize,
    pixels: Vec<f32>,
}

impl Projector {
    /// Radiant intensity in a direction: π · texture / cos³θ inside the field of view.
    fn at(&self, direction: DVec3) -> f64 {
        let local = self.to_world.inverse() * direction;
        // With 90° the sides of the picture are at X = ±Z, and X points to the left.
        let (u, v) = (0.5 - 0.5 * local.x / local.z, 0.5 - 0.5 * local.y / local.z);
        if local.z <= 0.0 || !(0.0..=1.0).contains(&u) || !(0.0..=1.0).contains(&v) {
            return 0.0;
        }
        let last = self.side - 1;
        let pixel = |x: f64| (x * self.side as f64 - 0.5).clamp(0.0, last as f64);
        let (x, y) = (pixel(u), pixel(v));
        let (i, j) = (x as usize, y as usize);
        let texel = |i: usize, j: usize| f64::from(self.pixels[j.min(last) * self.side + i.min(last)]);
        let (s, t) = (x - i as f64, y - j as f64);
        let row = |j: usize| (1.0 - s) * texel(i, j) + s * texel(i + 1, j);
        PI * ((1.0 - t) * row(j) + t * row(j + 1)) / local.z.powi(3)
    }
}

fn read(luminaire: &Luminaire, side: Option<usize>) -> Vec<Projector> {
    let files = write(luminaire, "lamp", side).expect("exported").value;
    let scene = String::from_utf8(files[0].bytes.clone()).expect("text");
    assert_eq!(files[0].suffix, ".xml");
    let document = roxmltree::Document::parse(&scene).expect("XML");
    let emitters = document.descendants().filter(|n| n.attribute("type") == Some("projector"));
    let projectors: Vec<Projector> = emitters
        .map(|emitter| {
            let value = |name: &str| {
                let node = emitter.descendants().find(|n| n.attribute("name") == Some(name));
                node.and_then(|n| n.attribute("value")).unwrap_or_else(|| panic!("{name}"))
            };
            assert_eq!((value("fov"), value("raw"), value("wrap_mode")), ("90", "true", "clamp"));
            let matrix = emitter.descendants().find(|n| n.has_tag_name("matrix")).and_then(|n| n.attribute("value"));
            let m: Vec<f64> =
                matrix.expect("a matrix").split_whitespace().map(|w| w.parse().expect("a number")).collect();
            // Row by row, as Mitsuba reads it.
            let row = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
            let to_world = DMat3::from_cols(row(0), row(1), row(2)).transpose();
            assert!((to_world.determinant() - 1.0).abs() < 1e-12);
            let suffix = value("filename").strip_prefix("lamp").expect("the stem");
            let file = files.iter().find(|f| f.suffix == suffix).expect("a picture");
            let (width, height, pixels, comment) = exr_pixels(&file.bytes);
            assert!(width == height && comment.contains("-z is the photometric axis"), "{comment}");
            Projector { to_world, side: width, pixels }
        })
        .collect();
    assert_eq!(projectors.len(), files.len() - 1, "every picture is used");
    projectors
}

#[test]
fn the_sum_of_the_projectors_is_the_lamp() {
    let luminaire = asymmetric();
    let projectors = read(&luminaire, None);
    assert_eq!(projectors.len(), 6);
    // Four pixels around a direction are at most 2√2/N in X and Y away from it, angles no more; the factor cos³θ between them
    // changes by at most 3·|Δ|, of the peak.
    let reach = 2.0 * 2.0_f64.sqrt() / projectors[0].side as f64;
    let bound = (slope(&luminaire.distribution) + 3.0 * luminaire.distribution.peak().0) * reach;
    assert!(bound < 20.0, "{bound}");
    for d in directions(20_000) {
        let got: f64 = projectors.iter().map(|p| p.at(d)).sum();
        let expected = luminaire.distribution.towards(d);
        assert!((got - expected).abs() <= bound, "{d}: {got} {expected}");
    }
    // A pixel's solid angle is (2/N)² cos³θ, so that cos³θ cancels.
    let sum: f64 = projectors.iter().flat_map(|p| &p.pixels).map(|v| f64::from(*v)).sum();
    let flux = PI * sum * (2.0 / projectors[0].side as f64).powi(2);
    assert!((flux - luminaire.distribution.total_flux()).abs() <= flux_bound(bound), "{flux}");
}

#[test]
fn the_centre_of_a_face_is_exact() {
    // An odd number has a pixel in the middle, which a direction along an axis meets.
    let luminaire = asymmetric();
    let projectors = read(&luminaire, Some(9));
    for d in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
        let got: f64 = projectors.iter().map(|p| p.at(d)).sum();
        let expected = luminaire.distribution.towards(d);
        assert!((got / expected - 1.0).abs() < 1e-6, "{d}: {got} {expected}");
    }
}

#[test]
fn names_are_written_so_that_xml_holds_them() {
    let files = write(&asymmetric(), "R&D <1>", Some(8)).expect("exported").value;
    let scene = String::from_utf8(files[0].bytes.clone()).expect("text");
    let document = roxmltree::Document::parse(&scene).expect("XML");
    assert!(document.descendants().any(|n| n.attribute("value") == Some("R&D <1>-down.exr")), "{scene}");
    assert!(write(&asymmetric(), "cost$", Some(8)).is_err());
}

#[test]
fn faces_without_light_are_left_out() {
    // Light for γ up to 75° does not reach the face above.
    let downlight = lamp(tables().remove(5));
    assert_eq!(read(&downlight, Some(16)).len(), 5);
    let dark = lamp(downlight.distribution.scaled(0.0));
    assert_eq!(read(&dark, Some(16)).len(), 1);
    // `--` in a name does not end the comment: the scene above was parsed.
    assert!(dark.name.contains("--"));
}
