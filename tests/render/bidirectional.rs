//! Packets from the lights beside paths from the camera: closed forms that no path from the camera finds, the path tracer's pictures
//! where both find all, honest errors, the same bits however it is run.

use std::f64::consts::PI;

use photopic::render::build::Built;
use photopic::render::film::Film;
use photopic::render::noise::Noise;
use photopic::render::sensor::camera::Camera;

use crate::cli::{json, photopic};
use crate::pictures::{ROOM, built, camera, figure, rendered};

/// All channels of all pixels, row by row, and the noise.
fn picture(built: &Built, seed: u64, samples: u64) -> (Vec<f32>, Noise) {
    let camera = camera(built);
    let mut settings = built.settings.clone();
    settings.seed = seed;
    let film = Film::new(&built.scene, camera, &settings, 0, samples, &built.quantities.tristimulus, |_| ());
    rendered(film)
}

/// Mean over the picture of each channel.
fn means(pixels: &[f32], camera: &Camera) -> Vec<f64> {
    let width = camera.width() as usize;
    let channels = pixels.len() / width / camera.height() as usize;
    let mut means = vec![0.0; channels];
    for (place, row) in pixels.chunks_exact(width).enumerate() {
        means[place % channels] += row.iter().map(|v| f64::from(*v)).sum::<f64>();
    }
    means.iter().map(|m| m / camera.pixels()).collect()
}

/// A pane of glass between parallel light and a floor, and the camera below it. With four edges a path is lamp, pane in, pane out, floor,
/// lens: E behind it is (1 − R)² E₀ for each wavelength, R = ((n − 1)/(n + 1))², and the floor's radiance ρ E/π. No path from a camera meets
/// parallel light through glass. The pane disperses: n by M. Herzberger's and Schott's Sellmeier coefficients of N-SF10.
#[test]
fn parallel_light_comes_through_a_pane_as_fresnel_says() {
    let (b, c) = ([1.621_539_02, 0.256_287_842, 1.644_475_52], [0.012_224_145_7, 0.059_573_677_5, 147.468_793]);
    // Paths with a wavelength of their own have more noise.
    for (samples, most, render, projection) in [
        (1024, 0.02, "", "field_of_view = \"40 deg\""),
        (1024, 0.02, "", "field_of_view = \"40 deg\", aperture_radius = \"2 cm\", focus = \"0.5 m\""),
        (4096, 0.04, "wavelengths_per_path = \"one\"", "field_of_view = \"40 deg\""),
        (1024, 0.04, "sampler = \"independent\"", "field_of_view = \"40 deg\""),
    ] {
        let text = format!(
            r#"
[render]
solver = "bidirectional"
max_edges = 4
wavelength_step_nm = 40
{render}
[[material]]
name = "flint"
dielectric = {{ sellmeier = {{ b = {b:?}, c_um2 = {c:?} }} }}
[[material]]
name = "floor"
reflectance = 0.5
[[shape]]
material = "floor"
rectangle = {{ corner = [-0.4, -0.4, 0], edges = [[0.8, 0, 0], [0, 0.8, 0]] }}
[[shape]]
material = "flint"
box = {{ from = [-0.4, -0.4, 0.7], to = [0.4, 0.4, 0.8] }}
[[light]]
spectrum = [[360, 1], [830, 1]]
distant = {{ from = [0, 0, 1], irradiance = "1000 lx" }}
[[sensor]]
name = "view"
spectrum = true
camera = {{ at = [0, 0, 0.6], look_at = [0, 0, 0], up = [0, 1, 0], resolution = [8, 8], {projection} }}
"#
        );
        let built = built(&text);
        let mut flux = vec![0.0; built.scene.bands().len()];
        let light = &built.scene.lights()[0];
        light.sample_towards(glam::DVec3::ZERO, [0.5; 3], &mut flux).expect("it shines");
        let all: Vec<Vec<f64>> = (0..16).map(|seed| means(&picture(&built, seed, samples).0, camera(&built))).collect();
        for (band, nm) in built.scene.bands().wavelengths_nm().iter().enumerate() {
            let squared = (nm / 1000.0).powi(2);
            let n = (1.0 + (0..3).map(|i| b[i] * squared / (squared - c[i])).sum::<f64>()).sqrt();
            let reflected = ((n - 1.0) / (n + 1.0)).powi(2);
            let expected = 0.5 * (1.0 - reflected).powi(2) * flux[band] / PI;
            let (mean, error) = figure(&all.iter().map(|means| means[band]).collect::<Vec<_>>());
            assert!(error < most * expected, "{nm}: {mean} ± {error}");
            // 4.5 standard errors, of Student's t of 15 degrees of freedom: 4e-4 for each.
            assert!((mean - expected).abs() < 4.5 * error, "{nm}: {mean} ± {error}, {expected}");
        }
    }
}

/// Rooms with every kind of light and surface that paths from both ends can meet.
pub(crate) fn scenes() -> Vec<(&'static str, String)> {
    let lamp = r#"
[[shape]]
emission = { radiance = "1000 cd/m2", spectrum = "D65" }
rectangle = { corner = [-1, -1, 2.5], edges = [[0, 2, 0], [2, 0, 0]] }
"#;
    let ball = |material: &str| {
        format!(
            "[[material]]\nname = \"ball\"\n{material}\n[[shape]]\nmaterial = \"ball\"\nsphere = {{ centre = [0, 0, 0.55], radius = \"0.5 m\" }}\n"
        )
    };
    let sky = "[[light]]\nspectrum = \"D65\"\nenvironment = { radiance = \"100 cd/m2\" }\n";
    let sun = "[[light]]\nspectrum = \"D65\"\ndistant = { from = [0.3, -0.5, 1], irradiance = \"1000 lx\", diameter = \"40 deg\" }\n";
    let spot = "[[light]]\nspectrum = \"A\"\nspot = { at = [0.5, -0.5, 2.5], aim = [0.5, -0.5, 0], intensity = \"500 cd\", half_angle = \"40 deg\" }\n";
    let dye = "dye = { reflectance = [[480, 0.05], [520, 0.7]], absorption = [[400, 0.8], [480, 0.8], [500, 0], [830, 0]], emission = [[360, 0], [500, 0], [540, 1], [600, 0], [830, 0]], quantum_yield = 0.9 }";
    let glass = ball(
        "dielectric = { sellmeier = { b = [1.62153902, 0.256287842, 1.64447552], c_um2 = [0.0122241457, 0.0595736775, 147.468793] } }",
    );
    let mixture = [
        "[[material]]\nname = \"glass\"\ndielectric = { index = 1.5 }\n",
        &ball("mixture = [{ material = \"white\", share = 0.5 }, { material = \"glass\", share = 0.4 }]"),
    ]
    .concat();
    vec![
        ("lamp", [ROOM, lamp].concat()),
        ("glass", [ROOM, lamp, &glass].concat()),
        ("ground glass", [ROOM, lamp, &ball("dielectric = { index = 1.5, alpha = 0.3 }")].concat()),
        ("mirror", [ROOM, lamp, &ball("metal = { medium = \"Ag\" }")].concat()),
        ("dye", [ROOM, lamp, &ball(dye)].concat()),
        ("sky", [ROOM, sky, &glass].concat()),
        ("mixture", [ROOM, lamp, &mixture].concat()),
        ("sun", [ROOM, sun].concat()),
        ("spot", [ROOM, spot, &ball("reflectance = 0.5")].concat()),
    ]
}

/// What both solvers find is the same: every kind of surface, light and camera; per pixel by the scatter over seeds.
#[test]
fn pictures_are_those_of_the_path_tracer() {
    let camera = |more: &str| {
        format!("camera = {{ at = [0.1, -2.6, 1.3], look_at = [0, 0, 0.5], resolution = [10, 8], {more} }}")
    };
    let flat = camera("field_of_view = \"45 deg\"");
    let scenes = scenes();
    let lamp = &scenes[0].1;
    let lens = camera("field_of_view = \"45 deg\", aperture_radius = \"5 cm\", focus = \"2 m\"");
    let fisheye = camera("projection = \"fisheye\", field_of_view = \"170 deg\"");
    let around = camera("projection = \"equirectangular\"");
    let cameras = [lens, fisheye, around].map(|camera| ("camera", lamp.clone(), camera));
    let all = scenes
        .iter()
        .map(|(n, t)| (*n, t.as_str(), flat.as_str()))
        .chain(cameras.iter().map(|(n, t, c)| (*n, t.as_str(), c.as_str())));
    for (name, text, camera) in all {
        let both = [("path", 0), ("bidirectional", 1000)].map(|(solver, first)| {
            let text = format!("[render]\nsolver = \"{solver}\"\nwavelength_step_nm = 30\n{text}\n[[sensor]]\nname = \"view\"\n{camera}\n");
            let built = built(&text);
            let pictures: Vec<(Vec<f32>, Noise)> = (first..first + SEEDS).map(|seed| picture(&built, seed, SAMPLES)).collect();
            // What is claimed errs to the safe side; χ² of 23 degrees of freedom is below 2.5 of them in all but 1e-4 of cases.
            let luminances: Vec<f64> = pictures.iter().map(|(_, noise)| noise.luminance).collect();
            let claimed = pictures.iter().map(|(_, noise)| noise.variance).sum::<f64>() / SEEDS as f64;
            let (_, error) = figure(&luminances);
            assert!(error * error * (SEEDS as f64) < 2.5 * claimed, "{name}, {solver}: {error} {claimed}");
            (pictures.into_iter().map(|(pixels, _)| pixels).collect::<Vec<_>>(), figure(&luminances))
        });
        let [(path, (a, ea)), (packets, (b, eb))] = both;
        assert!((a - b).abs() < 4.5 * ea.hypot(eb), "{name}: {a} ± {ea}, {b} ± {eb}");
        compare(name, &path, &packets);
    }
}

/// In a uniform surround nothing that conserves energy can be told from it: packets bring exactly what they take from the paths.
#[test]
fn a_furnace_is_the_same_from_both_ends() {
    let text = r#"
[render]
solver = "bidirectional"
wavelength_step_nm = 40
[[light]]
spectrum = "D65"
environment = { radiance = "1000 cd/m2" }
[[material]]
name = "white"
reflectance = 1.0
[[material]]
name = "glass"
dielectric = { cauchy = [1.5, 0.02, 0] }
[[shape]]
material = "white"
sphere = { centre = [0, 0, 0], radius = "1 m" }
[[shape]]
material = "glass"
sphere = { centre = [1.2, -1, 0], radius = "0.5 m" }
[[sensor]]
name = "view"
camera = { at = [0.4, -5, 1], look_at = [0.4, 0, 0], field_of_view = "30 deg", resolution = [12, 8] }
"#;
    let built = built(text);
    let luminance = built.scene.bands().len() + 1;
    let all: Vec<f64> = (0..16).map(|seed| means(&picture(&built, seed, 32).0, camera(&built))[luminance]).collect();
    let (mean, error) = figure(&all);
    assert!(error < 3.0 && (mean - 1000.0).abs() < 4.5 * error, "{mean} ± {error}");
}

/// Packets are summed in an order that does not depend on who traces them.
#[test]
fn any_number_of_threads_makes_the_same_bits() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/prism.toml")).expect("the scene");
    let text = text.replace("resolution = [256, 192]", "resolution = [24, 18]");
    let built = built(&text);
    assert!(built.settings.packets);
    let pictures = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let (pixels, noise) = pool.install(|| picture(&built, 3, 16));
        (pixels.into_iter().map(f32::to_bits).collect::<Vec<_>>(), noise)
    });
    assert!(pictures[0] == pictures[1] && pictures[1] == pictures[2]);
}

/// The mean luminance of the picture of every scene that is shipped, where the path tracer finds all light.
#[test]
fn shipped_scenes_look_the_same_from_both_ends() {
    let mut compared = 0;
    for path in crate::scenes::shipped() {
        let folder = tempfile::tempdir().expect("a folder");
        let told = ["path", "bidirectional"].map(|solver| {
            let settings = folder.path().join("settings.toml");
            std::fs::write(&settings, format!("[render]\nsolver = \"{solver}\"\n")).expect("written");
            let mut command = photopic();
            command.arg("render").arg(&path).arg("--settings").arg(&settings).arg("--folder").arg(folder.path());
            command.args(["--json", "--samples", "4", "--meter-samples", "32", "--packets", "0"]);
            json(&mut command)["results"][0].clone()
        });
        assert_eq!([0, 1].map(|i| told[i]["model"]["solver"].as_str()), [Some("path"), Some("bidirectional")]);
        let missed = told[0]["model"]["left_out"]
            .as_array()
            .expect("a list")
            .iter()
            .any(|l| l.as_str().is_some_and(|l| l.contains("throw")));
        let sensors = told.each_ref().map(|t| t["sensors"].as_array().expect("sensors"));
        for (a, b) in
            sensors[0].iter().zip(sensors[1]).filter(|(a, _)| a["quantity"] == "mean luminance of the picture")
        {
            let [(a, ea), (b, eb)] = [a, b]
                .map(|s| (s["value"].as_f64().expect("a value"), s["standard_error"].as_f64().expect("an error")));
            println!("{}: {a} ± {ea}, {b} ± {eb}, missed: {missed}", path.display());
            assert!(missed || (a - b).abs() < 4.5 * ea.hypot(eb), "{}: {a} ± {ea}, {b} ± {eb}", path.display());
            compared += usize::from(!missed);
        }
    }
    assert!(compared >= 3, "{compared}");
}

/// The scene says whether it gains by packets: something polished throws light on something that scatters.
#[test]
fn a_scene_says_whether_it_asks_for_packets() {
    let floor = "[[material]]\nname = \"floor\"\nreflectance = 0.5\n[[shape]]\nmaterial = \"floor\"\nrectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }\n";
    let ball = "[[material]]\nname = \"glass\"\ndielectric = { index = 1.5 }\n[[shape]]\nmaterial = \"glass\"\nsphere = { centre = [0, 0, 1], radius = \"0.5 m\" }\n";
    let lamp = "[[shape]]\nemission = { radiance = \"100 cd/m2\", spectrum = \"D65\" }\ndisk = { centre = [0, 0, 3], normal = [0, 0, -1], radius = \"1 m\" }\n";
    let point = "[[light]]\npoint = { at = [0, 0, 3], flux = \"100 lm\" }\n";
    let sensor = "[[sensor]]\nname = \"floor\"\nilluminance = { at = [0, 0, 0.01] }\n";
    for (parts, advised, missed) in [
        (&[floor, lamp][..], false, false),
        (&[ball, lamp], false, false),
        (&[floor, ball, lamp], true, false),
        (&[floor, ball, point], true, true),
        // Packets do not come to a point through glass either.
        (&[ball, point], false, true),
    ] {
        let analysis = built(&[&parts.concat(), sensor].concat()).analysis;
        let because = analysis.caustics_because;
        assert_eq!((analysis.caustics, analysis.caustics_missed), (advised, missed), "{parts:?}: {because}");
    }
}

const SEEDS: u64 = 24;
const SAMPLES: u64 = 24;

fn compare(name: &str, path: &[Vec<f32>], packets: &[Vec<f32>]) {
    let (mut squares, mut count) = (0.0, 0.0);
    for pixel in 0..path[0].len() {
        let of = |pictures: &[Vec<f32>]| figure(&pictures.iter().map(|p| f64::from(p[pixel])).collect::<Vec<_>>());
        let ((a, ea), (b, eb)) = (of(path), of(packets));
        if ea + eb == 0.0 {
            assert!((a - b).abs() <= 1e-6 * a.abs(), "{name}, {pixel}: {a} {b}");
            continue;
        }
        let z = (a - b) / ea.hypot(eb);
        assert!(z.abs() < 7.0, "{name}, {pixel}: {a} ± {ea}, {b} ± {eb}");
        squares += z * z;
        count += 1.0;
    }
    // The bands of a pixel move together; Student's t of some 40 degrees of freedom has a mean square of 1.05, and n of them scatter by √(2/n).
    let pixels = count / (path[0].len() / 80) as f64;
    let mean = squares / count;
    assert!(mean < 1.05 + 4.5 * (2.0 / pixels).sqrt(), "{name}: {mean} is the mean of z² of {pixels} pixels");
}
