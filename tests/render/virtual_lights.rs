//! Virtual lights beside paths: a closed form that they have to meet in every pixel, the path tracer's pictures in every band, honest errors,
//! the same bits however a picture is asked for.

use std::f64::consts::PI;

use photopic::image::source::{Region, Source};
use photopic::render::build::Built;
use photopic::render::description::Description;
use photopic::render::film::{Film, strip};
use photopic::render::integrator::virtual_lights;
use photopic::render::measure::Settings;
use photopic::render::noise::Noise;

use crate::pictures::{ROOM, VIEW, blocks, built, camera, figure, picture};

fn settings(built: &Built, seed: u64, virtual_lights: Option<bool>) -> Settings {
    Settings { seed, virtual_lights, branches: Some(1), ..built.settings.clone() }
}

/// Beside the room's floor and red wall.
const WALL: &str = r#"
[[shape]]
material = "white"
rectangle = { corner = [-2, -2, 0], edges = [[0, 4, 0], [0, 0, 3]] }
"#;
const LAMP: &str = r#"
[[shape]]
material = "white"
emission = { radiance = "1000 cd/m2", spectrum = "D65" }
rectangle = { corner = [-1, -1, 2.5], edges = [[0, 2, 0], [2, 0, 0]] }
"#;

/// A point in the middle of a white sphere lights all of it alike: E = Φ/(4πR²(1 − ρ)), and every place has the radiance ρE/π, whichever
/// part of it comes straight, by virtual lights, or from nearby. With four edges E = Φ/(4πR²)(1 + ρ + ρ²).
#[test]
fn every_pixel_of_an_integrating_sphere_is_as_bright() {
    for (edges, series) in [("", 1.0 / (1.0 - 0.8)), ("max_edges = 4", 1.0 + 0.8 + 0.64), ("max_edges = 3", 1.8)] {
        let text = format!(
            r#"
[render]
wavelength_step_nm = 10
{edges}
[[material]]
name = "white"
reflectance = 0.8
[[shape]]
material = "white"
sphere = {{ centre = [0, 0, 0], radius = "0.5 m" }}
[[light]]
spectrum = [[360, 1], [830, 1]]
point = {{ at = [0, 0, 0], flux = "1000 lm" }}
[[sensor]]
name = "view"
camera = {{ at = [0.2, 0.1, 0.05], look_at = [0, 0.3, 0], resolution = [24, 6], projection = "equirectangular" }}
"#
        );
        let built = built(&text);
        let expected = 0.8 / PI * 1000.0 / PI * series;
        let seeds: Vec<Vec<f32>> =
            (0..24).map(|seed| picture(&built, &settings(&built, seed, Some(true)), 64).0).collect();
        let (width, height) = (24, 6);
        let channels = seeds[0].len() / width / height;
        let mut squares = 0.0;
        for y in 0..height {
            for x in 0..width {
                let place = (y * channels + channels - 2) * width + x;
                let (mean, error) = figure(&seeds.iter().map(|s| f64::from(s[place])).collect::<Vec<_>>());
                assert!(error < 0.03 * expected, "{mean} ± {error}");
                // With three edges all that is drawn is the same: what is left is the rounding of pixels to f32, 2⁻²⁴ of them, and of the band sum.
                let off = (mean - expected) / error.max(1e-6 * expected);
                // Of 23 degrees of freedom: beyond 5.5 once in 80 000, and there are 432.
                assert!(off.abs() < 5.5, "{x}, {y}: {mean} ± {error}, {expected}");
                squares += off * off;
            }
        }
        // Student's t of 23 degrees of freedom has the variance 23/21; the pixels of a row are correlated, and the rows are six.
        assert!(squares / 144.0 < 2.0, "{squares}");
    }
}

/// The same sphere from a hundredth of a micrometre to 10⁸ m, and far from the origin: virtual lights are weighed in single precision.
#[test]
fn neither_size_nor_place_matters() {
    for (size, at) in [(1e-8, 0.0), (1e-3, 50.0), (1.0, 1e6), (1e8, 0.0)] {
        let place = |x: f64| at + size * x;
        let flux = 1000.0 * size * size;
        let text = format!(
            r#"
[render]
wavelength_step_nm = 10
[[material]]
name = "white"
reflectance = 0.8
[[shape]]
material = "white"
sphere = {{ centre = [{at}, {at}, {at}], radius = "{radius} m" }}
[[light]]
spectrum = [[360, 1], [830, 1]]
point = {{ at = [{at}, {at}, {at}], flux = "{flux} lm" }}
[[sensor]]
name = "view"
camera = {{ at = [{x}, {y}, {z}], look_at = [{at}, {up}, {at}], resolution = [24, 6], projection = "equirectangular" }}
"#,
            radius = 0.5 * size,
            x = place(0.2),
            y = place(0.1),
            z = place(0.05),
            up = place(0.3),
        );
        let built = built(&text);
        let expected = 0.8 / PI * 1000.0 / PI / (1.0 - 0.8);
        let of = |seed| picture(&built, &settings(&built, seed, Some(true)), 64).1.luminance / 144.0;
        let (mean, error) = figure(&(0..24).map(of).collect::<Vec<_>>());
        // Of 23 degrees of freedom: beyond 5 once in 20 000.
        assert!(error < 0.003 * expected, "{mean} ± {error}");
        assert!((mean - expected).abs() < 5.0 * error, "{size} {at}: {mean} ± {error}, {expected}");
    }
}

/// What virtual lights and paths of several branches show is what paths find, in every band and part of the picture: textures, smooth normals, mirrors and glass between
/// diffuse surfaces, dispersion, fluorescence, skies and sun; by the scatter over seeds.
#[test]
fn pictures_are_those_of_the_path_tracer() {
    let ball = |material: &str| {
        format!(
            "{material}\n[[shape]]\nmaterial = \"ball\"\nsphere = {{ centre = [0, 0.3, 0.5], radius = \"0.5 m\" }}\n"
        )
    };
    let more = [
        (
            "block",
            "[[shape]]\nmaterial = \"white\"\nbox = { from = [-0.5, 0, 0], to = [0.5, 0.6, 0.9] }\n".to_owned(),
            "",
        ),
        ("no more than four edges", ball("[[material]]\nname = \"ball\"\nreflectance = 0.5"), "max_edges = 4"),
        ("rough", ball("[[material]]\nname = \"ball\"\nbrdf = \"oren-nayar(reflectance=0.6, sigma_deg=30)\""), ""),
        (
            "texture",
            ball(
                "[[material]]\nname = \"ball\"\nreflectance = 0.9\ncheckerboard = { even = 0.9, odd = 0.1, fields = [4, 2] }",
            ),
            "",
        ),
        ("gold", ball("[[material]]\nname = \"ball\"\nmetal = { medium = \"Au\", alpha = 0.2 }"), ""),
        ("mirror", ball("[[material]]\nname = \"ball\"\nmetal = { medium = \"Ag\" }"), ""),
        ("flint", ball("[[material]]\nname = \"ball\"\ndielectric = { medium = \"SF10\" }"), ""),
        (
            "dye",
            ball(
                "[[material]]\nname = \"ball\"\ndye = { reflectance = 0.3, absorption = [[400, 0.6], [480, 0.6], [520, 0], [830, 0]], emission = [[500, 0], [540, 1], [620, 0]], quantum_yield = 0.9 }",
            ),
            "",
        ),
    ];
    let lamps = [
        LAMP.to_owned(),
        "[[light]]\nspectrum = \"A\"\nspot = { at = [1, -1, 2.5], aim = [0.7, -0.5, 1.5], half_angle = \"30 deg\", intensity = \"1000 cd\" }\n".to_owned(),
        "[[light]]\nsky = { type = 12, horizontal = \"10000 lx\" }\n[[light]]\nspectrum = \"D65\"\ndistant = { from = [1, -1, 1], irradiance = \"5000 lx\" }\n".to_owned(),
    ];
    for (number, (name, shapes, limit)) in more.iter().enumerate() {
        // Caustics of a spot are no path's to find: balls that throw some are lit by the lamp with an extent.
        let kinds: &[usize] = if number < 4 { &[0, 1, 2] } else { &[0] };
        for lamp in kinds {
            let text =
                format!("[render]\nwavelength_step_nm = 60\n{limit}\n{ROOM}{WALL}{shapes}{}{VIEW}", lamps[*lamp]);
            let built = built(&text);
            let parts = |virtual_lights, branches, first: u64| -> Vec<Vec<f64>> {
                (first..first + 16)
                    .map(|seed| {
                        let settings = settings(&built, seed, Some(virtual_lights));
                        let settings = Settings { branches: Some(branches), ..settings };
                        blocks(&picture(&built, &settings, 64).0, camera(&built), 2)
                    })
                    .collect()
            };
            let paths = parts(false, 1, 100);
            for (virtual_lights, branches) in [(true, 1), (true, 2), (false, 4)] {
                let others = parts(virtual_lights, branches, 0);
                for part in 0..paths[0].len() {
                    let of = |all: &[Vec<f64>]| figure(&all.iter().map(|p| p[part]).collect::<Vec<_>>());
                    let ((a, da), (b, db)) = (of(&others), of(&paths));
                    let way = format!("{name}, lamp {lamp}, virtual lights: {virtual_lights}, branches: {branches}");
                    // Of about 30 degrees of freedom: beyond 5 once in 40 000, and there are 2100.
                    assert!((a - b).abs() <= 5.0 * da.hypot(db), "{way}, {part}: {a} ± {da}, {b} ± {db}");
                }
            }
        }
    }
}

/// The standard error of a picture's mean, to which all pixels of a row contribute together: the scatter over seeds.
#[test]
fn the_error_of_the_mean_is_what_it_scatters() {
    let built = built(&format!("[render]\nwavelength_step_nm = 100\n{ROOM}{WALL}{LAMP}{VIEW}"));
    for branches in [1, 4] {
        let settings = |seed| Settings { branches: Some(branches), ..settings(&built, seed, Some(true)) };
        let all: Vec<Noise> = (0..64).map(|seed| picture(&built, &settings(seed), 32).1).collect();
        let (_, error) = figure(&all.iter().map(|noise| noise.luminance).collect::<Vec<_>>());
        let scatter = error * 8.0;
        let stated = (all.iter().map(|noise| noise.variance).sum::<f64>() / 64.0).sqrt();
        // χ² of 63 degrees of freedom: within a factor of 1.4 all but once in 10 000; samples are spread evenly, which errs to the safe side.
        assert!(scatter < 1.4 * stated, "{scatter} {stated}");
        assert!(stated < 5.0 * scatter, "{scatter} {stated}");
    }
}

#[test]
fn a_part_of_a_picture_is_that_of_the_whole() {
    let built = built(&format!("[render]\nwavelength_step_nm = 100\n{ROOM}{WALL}{LAMP}{VIEW}"));
    let settings = settings(&built, 3, None);
    let mut film = Film::new(&built.scene, camera(&built), &settings, 0, 20, &built.quantities.tristimulus, |_| ());
    film.survey(true);
    let mut read = |x, y, width, height| {
        let mut out = vec![0.0; width * height];
        film.read(Region { x, y, width, height }, &[0], &mut out).expect("rows");
        out
    };
    let (whole, part) = (read(0, 0, 12, 10), read(5, 3, 4, 2));
    for y in 0..2 {
        assert_eq!(part[y * 4..][..4], whole[(y + 3) * 12 + 5..][..4]);
    }
    // Two rows of a strip without the one in between, and one of the next.
    for (y, (_, row)) in [1, 3, 5].into_iter().zip(film.rows(&[1, 3, 5])) {
        assert_eq!(row[..12], whole[y * 12..][..12]);
    }
    assert_eq!([1, 12, 256, 257, 512, 513, 8192].map(strip), [4, 4, 4, 2, 2, 1, 1]);
}

/// A room lit by a spot on its floor is rendered by them, a floor under an open sky by paths alone.
#[test]
fn they_are_taken_where_they_pay() {
    let spot = "[[light]]\nspectrum = \"A\"\nspot = { at = [0, 0, 2.5], aim = [0, 0, 0], half_angle = \"15 deg\", intensity = \"1000 cd\" }\n";
    let ceiling =
        "[[shape]]\nmaterial = \"white\"\nrectangle = { corner = [-2, -2, 3], edges = [[0, 4, 0], [4, 0, 0]] }\n";
    let sky = "[[light]]\nspectrum = \"D65\"\nenvironment = { radiance = \"1 W/m2/sr/nm\" }\n";
    // Large enough that a trial sees where it is bright.
    let view = VIEW.replace("[12, 10]", "[48, 40]");
    for (scene, pays) in [(format!("{ROOM}{WALL}{ceiling}{spot}{view}"), true), (format!("{ROOM}{sky}{view}"), false)] {
        let built = built(&format!("[render]\nwavelength_step_nm = 100\n{scene}"));
        let with = |virtual_lights| picture(&built, &settings(&built, 3, virtual_lights), 16).0;
        assert!(with(Some(true)) != with(Some(false)));
        assert!(with(None) == with(Some(pays)), "{pays}");
    }
}

#[test]
fn a_number_of_branches_out_of_range_is_told() {
    let text = format!("[render]\nbranches = 65\n{ROOM}{LAMP}{VIEW}");
    let error = Description::parse(&text).expect_err("refused").to_string();
    assert!(error.contains("2:12") && error.contains("`branches` of 65; expected 1 to 64"), "{error}");
}

/// What a floor and a wall under an open sky send to the camera is found by many directions from few of their places.
#[test]
fn branches_are_taken_where_they_pay() {
    let sky = "[[light]]\nspectrum = \"D65\"\nenvironment = { radiance = \"1 W/m2/sr/nm\" }\n";
    let built = built(&format!("[render]\nwavelength_step_nm = 100\n{ROOM}{WALL}{sky}{VIEW}"));
    let with = |branches| picture(&built, &Settings { branches, ..settings(&built, 3, Some(false)) }, 64).0;
    let found = with(None);
    let numbers: Vec<u32> = [1, 2, 4, 8, 16].into_iter().filter(|n| with(Some(*n)) == found).collect();
    assert!(matches!(numbers[..], [2..=4]), "{numbers:?}");
}

/// A plane under a sky that is the same everywhere has the radiance ρL, of which no sample is off: every direction that the plane draws is
/// worth the same.
#[test]
fn a_plane_under_a_uniform_sky_has_no_noise() {
    let scene = "[[material]]\nname = \"gray\"\nreflectance = 0.4\n[[shape]]\nmaterial = \"gray\"\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n[[light]]\nspectrum = [[360, 1], [830, 1]]\nenvironment = { radiance = \"2 W/m2/sr/nm\" }\n[[sensor]]\nname = \"view\"\ncamera = { at = [0, 0, 2], look_at = [0, 1, 0], resolution = [8, 8], field_of_view = \"30 deg\" }\n";
    let built = built(&format!("[render]\nwavelength_step_nm = 100\n{scene}"));
    for branches in [1, 4] {
        let settings = Settings { branches: Some(branches), ..settings(&built, 1, None) };
        let (pixels, noise) = picture(&built, &settings, 8);
        let bands = built.scene.bands().len();
        for row in pixels.chunks_exact(8 * (bands + 3)) {
            // Pixels are f32.
            assert!(row[..8 * bands].iter().all(|l| (l / 0.8 - 1.0).abs() < 2.0 * f32::EPSILON), "{row:?}");
        }
        assert!(noise.relative() < 1e-12, "{noise:?}");
    }
}

/// They are left where they cannot stand for all light between diffuse surfaces.
#[test]
fn scenes_that_they_suit_are_told_from_others() {
    let suits = |text: &str| {
        let built = built(text);
        virtual_lights::Source::of(&built.scene, &built.settings.limits).is_some()
    };
    assert!(suits(&format!("{ROOM}{WALL}{LAMP}{VIEW}")));
    assert!(!suits(&format!("[render]\nmax_edges = 2\n{ROOM}{WALL}{LAMP}{VIEW}")));
    assert!(!suits(&format!("[render]\nsolver = \"whitted\"\n{ROOM}{WALL}{LAMP}{VIEW}")));
    // Packets of the sky come to what is bounded alone.
    let ground = "[[shape]]\nmaterial = \"white\"\nplane = { point = [0, 0, -1], normal = [0, 0, 1] }\n";
    assert!(!suits(&format!("{ROOM}{WALL}{LAMP}{ground}{VIEW}")));
    // What no surface stops lights what no packet comes to.
    let barzel = |control: &str| {
        format!(
            "[[light]]\nbarzel = {{ at = [0, 0, 2.5], aim = [0, 0, 0], up = [0, 1, 0], intensity = \"9 cd\"{control} }}\n"
        )
    };
    assert!(suits(&format!("{ROOM}{WALL}{}{VIEW}", barzel(""))));
    for control in [", shadows = false", ", falloff = { exponent = 1 }"] {
        assert!(!suits(&format!("{ROOM}{WALL}{}{VIEW}", barzel(control))), "{control}");
    }
    let mirrors = "[[material]]\nname = \"mirror\"\nmetal = { medium = \"Ag\" }\n[[shape]]\nmaterial = \"mirror\"\nsphere = { centre = [0, 0, 0], radius = \"1 m\" }\n";
    assert!(!suits(&format!("{mirrors}{VIEW}")));
}
