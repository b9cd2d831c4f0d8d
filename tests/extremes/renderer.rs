//! Scenes from 1e-8 to 1e8 m, by starlight and by the sun, without a lamp, without a way out, with light along the surface.

use std::f64::consts::PI;

use photopic::render::build::{Kind, NoFiles, build};
use photopic::render::description::Description;
use photopic::render::estimate::{Figure, REPLICATES};
use photopic::render::measure::Board;
use photopic::render::spool::Share;

use crate::close;

/// The readings of a scene's meters, of so many samples each.
fn read(text: &str, samples: u64) -> Vec<Figure> {
    let description = Description::parse(text).unwrap_or_else(|e| panic!("{e}: {text}"));
    let built = build(text, &description, &NoFiles).unwrap_or_else(|e| panic!("{e}: {text}"));
    let meters = (0..).zip(&built.instruments).map(|(n, i)| match &i.kind {
        Kind::Meter(meter) => (n << 32, meter.clone()),
        _ => panic!("meters alone"),
    });
    let meters: Vec<_> = meters.collect();
    let count = meters.len();
    let mut board = Board::new(&built.scene, &built.settings, Share::WHOLE, meters);
    board.sample_until(samples.div_ceil(REPLICATES as u64));
    (0..count).map(|m| board.estimate(m).figure(&built.quantities.luminous)).collect()
}

const E: &str = "[[sensor]]\nname = \"e\"\nilluminance = { at = [0, 0, 0] }\n";

#[test]
fn a_point_is_read_from_a_molecule_to_a_light_second_and_from_starlight_to_the_sun() {
    for distance in [1e-8, 1e-3, 1.0, 1e3, 3e8] {
        for candela in [1e-12, 1.0, 3e27] {
            let text =
                format!("[[light]]\npoint = {{ at = [0, 0, {distance:e}], intensity = \"{candela:e} cd\" }}\n{E}");
            let reading = &read(&text, 64)[0];
            close(reading.value * distance * distance, candela, 1e-9, &text);
            assert!(reading.standard_error <= 1e-9 * reading.value, "{reading:?}");
        }
    }
}

/// A sphere of radius r, 3 r away, with a radiance of 1000 cd/m²: π L (r/d)² at any size. A lamp as large as an atom is one.
#[test]
fn a_lamp_is_the_same_at_any_scale() {
    for radius in [1e-8, 1e-4, 1.0, 1e4, 1e8] {
        let text = format!(
            "[[shape]]\nemission = {{ radiance = \"1000 cd/m2\" }}\n\
             sphere = {{ centre = [0, 0, {:e}], radius = \"{radius:e} m\" }}\n{E}",
            3.0 * radius
        );
        let reading = &read(&text, 4096)[0];
        let expected = PI * 1000.0 / 9.0;
        assert!(
            (reading.value - expected).abs() < 4.5 * reading.standard_error + 1e-6 * expected,
            "{radius:e}: {reading:?}"
        );
        assert!(reading.standard_error < 0.01 * expected, "{radius:e}: {reading:?}");
    }
}

/// E = E_n cos θ down to 1e-4 degrees above the surface; from below the surface there is nothing.
#[test]
fn light_along_the_surface_keeps_its_cosine() {
    for degrees in [0.0_f64, 60.0, 89.0, 89.99, 89.9999, 90.0001] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let text = format!("[[light]]\ndistant = {{ from = [{sin:e}, 0, {cos:e}], irradiance = \"100000 lx\" }}\n{E}");
        let expected = 1e5 * cos.max(0.0);
        let value = read(&text, 64)[0].value;
        assert!((value - expected).abs() <= 1e-9 * expected, "{degrees}: {value}, {expected}");
    }
}

#[test]
fn where_there_is_no_light_nothing_is_read_and_nothing_is_uncertain() {
    let wall = "[[material]]\nname = \"white\"\nreflectance = 0.9\n[[shape]]\nmaterial = \"white\"\n\
                sphere = { centre = [0, 0, 0], radius = \"1 m\" }\n";
    let off = "[[light]]\npoint = { at = [0, 0, 0.5], intensity = \"0 cd\" }\n";
    for text in [E.to_owned(), format!("{wall}{E}"), format!("{wall}{off}{E}")] {
        let reading = &read(&text, 256)[0];
        assert_eq!((reading.value, reading.standard_error), (0.0, 0.0), "{text}");
    }
}

/// A hollow sphere of ρ with a lamp of Φ in its middle: E ρ/(1 − ρ) comes from the walls, E = Φ/4π. At ρ = 0.99 a path has a hundred
/// reflections, and none is cut.
#[test]
fn spheres_without_a_way_out_multiply_light() {
    for (reflectance, samples) in [(0.1, 16_384), (0.9, 16_384), (0.99, 65_536)] {
        let text = format!(
            "[[material]]\nname = \"wall\"\nreflectance = {reflectance}\n[[shape]]\nmaterial = \"wall\"\n\
             sphere = {{ centre = [0, 0, 0], radius = \"1 m\" }}\n\
             [[light]]\npoint = {{ at = [0, 0, 0], flux = \"1000 lm\" }}\n\
             [[sensor]]\nname = \"wall\"\nluminance = {{ at = [0, 0, 0.2], look_at = [0, 0, 1], acceptance = \"10 deg\" }}\n"
        );
        let reading = &read(&text, samples)[0];
        let expected = 1000.0 / (4.0 * PI) / PI * reflectance / (1.0 - reflectance);
        assert!(
            (reading.value - expected).abs() < 4.5 * reading.standard_error + 1e-9 * expected,
            "{reflectance}: {reading:?}, {expected}"
        );
        assert!(reading.standard_error < 0.03 * expected, "{reflectance}: {reading:?}");
    }
}

/// A mirror of roughness 1e-6 shows a lamp as a mirror does: its luminance, however narrow the lobe.
#[test]
fn a_surface_as_smooth_as_1e_6_is_a_mirror() {
    let of = |material: &str| {
        let text = format!(
            "[[material]]\nname = \"m\"\n{material}\n[[shape]]\nmaterial = \"m\"\n\
             rectangle = {{ corner = [-5, -5, 0], edges = [[10, 0, 0], [0, 10, 0]] }}\n\
             [[shape]]\nemission = {{ radiance = \"1000 cd/m2\" }}\n\
             rectangle = {{ corner = [-2, 3, 1], edges = [[4, 0, 0], [0, 0, 4]] }}\n\
             [[sensor]]\nname = \"l\"\nluminance = {{ at = [0, -3, 3], look_at = [0, 0, 0], acceptance = \"1 deg\" }}\n"
        );
        read(&text, 4096)[0].value
    };
    let rough = of("brdf = \"ggx(alpha=1e-6, reflectance=1)\"");
    // Facets of 1e-6 rad leave the lamp's edge, some degrees away, far beside; their albedo is 1 to 1e-12.
    close(rough, 1000.0, 1e-4, "α = 1e-6");
}
