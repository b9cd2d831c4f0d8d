//! `image probe`: shapes hold the pixels they should, and figures are those of closed forms and of `convert`.

use std::collections::HashSet;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use photopic::image::probe::{Line, Measures, Projection, Shape, ShapeError, View, probe};
use photopic::image::{Channel, Content, Description, Meaning, Memory, Photometric, Region, Settings};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use serde_json::Value;

const WIDTH: usize = 40;
const HEIGHT: usize = 30;

fn config() -> ProptestConfig {
    ProptestConfig { cases: 200, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() }
}

fn held(shape: &Shape) -> HashSet<(usize, usize)> {
    match shape.pixels(WIDTH, HEIGHT) {
        Ok(pixels) => pixels.spans().iter().flat_map(|(y, s)| s.clone().map(move |x| (x, *y))).collect(),
        Err(ShapeError::Empty { .. }) => HashSet::new(),
        Err(error) => panic!("{error}"),
    }
}

/// Places at multiples of 1/4, so that corners and edges meet pixel centres, too.
fn place() -> impl Strategy<Value = (f64, f64)> {
    (0..=4 * WIDTH, 0..=4 * HEIGHT).prop_map(|(x, y)| (x as f64 / 4.0, y as f64 / 4.0))
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_rectangle_is_the_polygon_of_its_corners(
        (x, width) in (0..WIDTH).prop_flat_map(|x| (Just(x), 1..=WIDTH - x)),
        (y, height) in (0..HEIGHT).prop_flat_map(|y| (Just(y), 1..=HEIGHT - y)),
    ) {
        let (x0, y0, x1, y1) = (x as f64, y as f64, (x + width) as f64, (y + height) as f64);
        let polygon = Shape::Polygon(vec![(x0, y0), (x1, y0), (x1, y1), (x0, y1)]);
        let rectangle = held(&Shape::Rectangle(Region { x, y, width, height }));
        prop_assert_eq!(rectangle.len(), width * height);
        prop_assert_eq!(held(&polygon), rectangle);
    }

    #[test]
    fn polygons_about_a_place_share_no_pixel_and_leave_none_out(middle in place()) {
        let (w, h) = (WIDTH as f64, HEIGHT as f64);
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
        let mut all = HashSet::new();
        for i in 0..4 {
            for pixel in held(&Shape::Polygon(vec![middle, corners[i], corners[(i + 1) % 4]])) {
                prop_assert!(all.insert(pixel), "{pixel:?} twice");
            }
        }
        prop_assert_eq!(all.len(), WIDTH * HEIGHT);
    }

    #[test]
    fn the_way_round_and_the_first_corner_do_not_matter(mut corners in prop::collection::vec(place(), 3..8)) {
        let one = held(&Shape::Polygon(corners.clone()));
        corners.reverse();
        corners.rotate_left(1);
        prop_assert_eq!(held(&Shape::Polygon(corners)), one);
    }

    #[test]
    fn a_circle_holds_about_its_area_and_its_mirror_images(radius in 0.6..14.0_f64) {
        let circle = |x: f64, y: f64| held(&Shape::Circle { centre: (x, y), radius_px: radius });
        let pixels = circle(20.0, 15.0);
        // A pixel whose square the circle cuts has its middle within √½ of it.
        let ring = |r: f64| PI * r.max(0.0) * r.max(0.0);
        let (least, most) = (ring(radius - 0.5_f64.sqrt()), ring(radius + 0.5_f64.sqrt()));
        prop_assert!((least..=most).contains(&(pixels.len() as f64)));
        let mirrored: HashSet<_> = pixels.iter().map(|(x, y)| (39 - x, 29 - y)).collect();
        prop_assert_eq!(&mirrored, &pixels);
        let moved: HashSet<_> = pixels.iter().map(|(x, y)| (x + 1, *y)).collect();
        prop_assert_eq!(circle(21.0, 15.0), moved);
    }

    #[test]
    fn a_line_is_unbroken_and_near(from in (0..WIDTH, 0..HEIGHT), to in (0..WIDTH, 0..HEIGHT)) {
        let pixels = Line { from, to }.pixels(WIDTH, HEIGHT).expect("inside");
        prop_assert_eq!((pixels.first(), pixels.last()), (Some(&from), Some(&to)));
        let (dx, dy) = (to.0 as f64 - from.0 as f64, to.1 as f64 - from.1 as f64);
        prop_assert_eq!(pixels.len() as f64, dx.abs().max(dy.abs()) + 1.0);
        for pair in pixels.windows(2) {
            prop_assert!(pair[0].0.abs_diff(pair[1].0).max(pair[0].1.abs_diff(pair[1].1)) == 1);
        }
        for (x, y) in pixels {
            let (px, py) = (x as f64 - from.0 as f64, y as f64 - from.1 as f64);
            // Half a pixel along the shorter axis.
            prop_assert!((px * dy - py * dx).abs() <= 0.5 * dx.abs().max(dy.abs()) + 1e-9);
        }
    }
}

#[test]
fn a_spot_has_the_solid_angle_of_its_cone_wherever_it_looks() {
    // A cone of half angle δ has 2π (1 − cos δ); pixels of about 0.04° leave a rim of at most half of them.
    for (projection, fov) in [(Projection::Pinhole, 90.0), (Projection::Equidistant, 120.0)] {
        let (width, height) = (2400, 1600);
        let view = View::new(projection, fov, (width, height)).expect("a view");
        for centre in [(1200.0, 800.0), (1900.0, 500.0), (300.5, 1300.5)] {
            let shape = Shape::Spot { centre, diameter_deg: 6.0, view };
            let pixels = shape.pixels(width, height).expect("inside");
            let of = |(y, columns): &(usize, std::ops::Range<usize>)| {
                columns.clone().map(|x| shape.weight(x, *y)).sum::<f64>()
            };
            let sum: f64 = pixels.spans().iter().map(of).sum();
            let exact = 2.0 * PI * (1.0 - 3.0_f64.to_radians().cos());
            assert!((sum / exact - 1.0).abs() < 2e-3, "{projection:?} {centre:?}: {}", sum / exact);
        }
    }
    // In the middle of a pinhole's picture it is a circle of radius f tan(δ/2).
    let view = View::new(Projection::Pinhole, 90.0, (WIDTH, HEIGHT)).expect("a view");
    let radius_px = 20.0 * 15.0_f64.to_radians().tan();
    let spot = held(&Shape::Spot { centre: (20.0, 15.0), diameter_deg: 30.0, view });
    assert_eq!(spot, held(&Shape::Circle { centre: (20.0, 15.0), radius_px }));
}

/// Light of one band at 555 nm by `f(x, y)`, between two dark ones; the unit makes 5 nm of it 1 W/(m²·sr).
fn cube(f: impl Fn(usize, usize) -> f32) -> Memory {
    let channels = [550.0, 555.0, 560.0].map(|w| Channel::band(format!("{w}"), "W/m2/sr/nm", w)).to_vec();
    let mut description = Description::planes(WIDTH, HEIGHT, channels);
    description.content = Content::Light { quantity: None, unit: Some("W/m2/sr/nm".parse().expect("a unit")) };
    let row = |y: usize| (0..3).flat_map(move |c| (0..WIDTH).map(move |x| (x, y, c)));
    let samples = (0..HEIGHT).flat_map(row).map(|(x, y, c)| if c == 1 { f(x, y) } else { 0.0 });
    Memory::new(description, samples.collect())
}

fn measures(image: &Memory) -> Measures {
    use photopic::image::Source;
    let settings = Settings::default();
    let luminance = Photometric::luminance(image.description(), Default::default(), &settings).expect("light").value;
    let xyz = Photometric::xyz(image.description(), Default::default(), &settings).expect("light").value;
    Measures::new(image.description(), Some(luminance), Some(xyz))
}

/// K_m V(555 nm) 5 nm: cd/m² of 1 W/(m²·sr·nm) at 555 nm (CIE 018:2019).
const PER_SAMPLE: f64 = 683.002 * 5.0;

#[test]
fn figures_of_a_ramp_are_those_of_an_arithmetic_series() {
    // Sample x + 1: 1 to 40 in each row.
    let mut image = cube(|x, _| x as f32 + 1.0);
    let measures = measures(&image);
    let shape = Shape::Rectangle(Region { x: 0, y: 3, width: WIDTH, height: 7 });
    let pixels = shape.pixels(WIDTH, HEIGHT).expect("inside");
    let found = probe(&mut image, &measures, &shape, &pixels, &[0.0, 25.0, 50.0, 100.0]).expect("memory does not fail");
    let l = found.luminance.clone().expect("a luminance");
    let close = |got: f64, want: f64| assert!((got / PER_SAMPLE / want - 1.0).abs() < 2e-7, "{got} {want}");
    // Mean (n + 1)/2 and variance (n² − 1)/12 of 1 … n; each value stands seven times.
    close(l.mean, 20.5);
    close(l.standard_deviation, ((1600.0_f64 - 1.0) / 12.0).sqrt());
    close(l.min, 1.0);
    close(l.max, 40.0);
    assert_eq!((l.min_at, l.max_at), ((0, 3), (39, 3)));
    close(l.percentiles[0], 1.0);
    // numpy 2.3: numpy.percentile(numpy.repeat(numpy.arange(1, 41), 7), [25, 50]).
    close(l.percentiles[1], 10.75);
    close(l.percentiles[2], 20.5);
    close(l.percentiles[3], 40.0);
    assert!((l.u0().expect("light") - 1.0 / 20.5).abs() < 1e-8 && (l.ud().expect("light") - 1.0 / 40.0).abs() < 1e-8);
    assert_eq!(found.channels, [0.0, 20.5, 0.0]);
    assert_eq!((found.pixels, found.counted), (280, 280));
    assert!((found.xyz.expect("a colour")[1] / l.mean - 1.0).abs() < 1e-7);
}

#[test]
fn pixels_without_a_value_are_counted_and_left_out_of_all_figures() {
    let mut image = cube(|x, y| match (x, y) {
        (0, 0) => f32::NAN,
        (1, 0) => f32::INFINITY,
        (2, 0) => -4.0,
        _ => 2.0,
    });
    let measures = measures(&image);
    let shape = Shape::Rectangle(Region { x: 0, y: 0, width: 4, height: 1 });
    let pixels = shape.pixels(WIDTH, HEIGHT).expect("inside");
    let found = probe(&mut image, &measures, &shape, &pixels, &[50.0]).expect("memory does not fail");
    assert_eq!((found.nan, found.infinite, found.negative, found.counted), (1, 1, 1, 1));
    assert_eq!(found.channels, [0.0, 2.0, 0.0]);
    // (−4 + 2) / 2
    assert!((found.mean_with_negative.expect("there is one") / PER_SAMPLE + 1.0).abs() < 1e-6);
    let shape = Shape::Pixel(0, 0);
    let pixels = shape.pixels(WIDTH, HEIGHT).expect("inside");
    let none = probe(&mut image, &measures, &shape, &pixels, &[50.0]).expect("memory does not fail");
    assert_eq!((none.luminance, none.xyz, none.channels), (None, None, Vec::new()));
}

#[test]
fn a_spot_reads_as_a_meter_does() {
    // Luminance L₀ cosθ, which a meter of half angle δ about the axis reads as ∫ L₀ cosθ dω / Ω = L₀ (1 + cos δ)/2.
    let (width, height) = (801, 801);
    let view = View::new(Projection::Pinhole, 100.0, (width, height)).expect("a view");
    let value = |x: usize, y: usize| view.direction(x as f64 + 0.5, y as f64 + 0.5).z as f32;
    let samples = (0..width * height).map(|i| value(i % width, i / width)).collect();
    let description = Description::planes(width, height, vec![Channel::new("Y", "cd/m²", Meaning::Photopic)]);
    let mut image = Memory::new(description, samples);
    let measures = {
        use photopic::image::Source;
        let settings = Settings::default();
        let way = Photometric::luminance(image.description(), Default::default(), &settings).expect("a plane");
        Measures::new(image.description(), Some(way.value), None)
    };
    let shape = Shape::Spot { centre: (400.5, 400.5), diameter_deg: 80.0, view };
    let pixels = shape.pixels(width, height).expect("inside");
    let found = probe(&mut image, &measures, &shape, &pixels, &[]).expect("memory does not fail");
    let want = (1.0 + 40.0_f64.to_radians().cos()) / 2.0;
    let got = found.luminance.expect("a luminance").mean;
    // The rim of 282 pixels' radius is right to half a pixel in the mean of 1800: far below 1e-4 of the area.
    assert!((got / want - 1.0).abs() < 1e-4, "{got} {want}");
}

fn photopic() -> Command {
    Command::cargo_bin("photopic").expect("the binary")
}

/// A cube with bands from 400 to 700 nm by 10; each pixel has another spectrum.
fn write_cube(folder: &Path) {
    let bands: Vec<String> = (0..31).map(|i| (400 + 10 * i).to_string()).collect();
    let header = format!(
        "ENVI\nsamples = 6\nlines = 4\nbands = 31\ndata type = 4\nbyte order = 0\ninterleave = bip\n\
        wavelength units = Nanometers\nwavelength = {{{}}}\ndata units = mW/m2/sr/nm\n",
        bands.join(", ")
    );
    fs::write(folder.join("cube.hdr"), header).expect("written");
    let sample = |i: usize| ((i * 7919) % 1009) as f32 * 0.01;
    fs::write(folder.join("cube.img"), (0..6 * 4 * 31).flat_map(|i| sample(i).to_le_bytes()).collect::<Vec<_>>())
        .expect("written");
}

fn json(folder: &Path, args: &[&str]) -> Value {
    let out = photopic().current_dir(folder).args(args).assert().success();
    serde_json::from_slice(&out.get_output().stdout).expect("JSON")
}

#[test]
fn the_spectrum_table_converts_to_the_luminance_that_was_probed() {
    let folder = tempfile::tempdir().expect("a folder");
    write_cube(folder.path());
    let parts = ["--pixel", "corner=5,3", "--rect", "part=1,1,4,2", "--polygon", "0,0,6,0,3,4"];
    let args = [&["image", "probe", "cube.hdr"], &parts[..]].concat();
    let probed = json(folder.path(), &[&args[..], &["--json"]].concat());
    photopic().current_dir(&folder).args(&args).args(["--csv", "-o", "spectra.csv"]).assert().success();
    let converted = json(folder.path(), &["convert", "spectra.csv", "--json"]);
    let (probed, converted) = (&probed["results"], &converted["results"]);
    assert_eq!(converted.as_array().map(Vec::len), Some(3));
    for i in 0..3 {
        assert_eq!(probed[i]["name"], converted[i]["name"]);
        assert_eq!(converted[i]["quantity"], "radiance");
        let mean = probed[i]["luminance_cd_per_m2"]["mean"].as_f64().expect("a number");
        let want = converted[i]["photopic"]["luminance_cd_per_m2"].as_f64().expect("a number");
        // Each pixel's luminance is rounded to a float, 6e-8.
        assert!((mean / want - 1.0).abs() < 1e-7, "{mean} {want}");
        for k in 0..3 {
            let (a, b) = (probed[i]["xyz"][k].as_f64(), converted[i]["xyz"][k].as_f64());
            let (a, b) = (a.expect("a number"), b.expect("a number"));
            assert!((a / b - 1.0).abs() < 1e-7, "{k}: {a} {b}");
        }
    }
}

#[test]
fn every_form_of_output_has_the_same_figures() {
    let folder = tempfile::tempdir().expect("a folder");
    write_cube(folder.path());
    let args = ["image", "probe", "cube.hdr", "--rect", "part=1,1,4,2", "--percentiles", "50"];
    let probed = json(folder.path(), &[&args[..], &["--json"]].concat());
    let figures = &probed["results"][0]["luminance_cd_per_m2"];
    let out = photopic().current_dir(&folder).args(args).arg("--csv=figures").assert().success();
    let mut table = csv::Reader::from_reader(&out.get_output().stdout[..]);
    let header = table.headers().expect("a header").clone();
    let row = table.records().next().expect("a row").expect("cells");
    let cell = |name: &str| row[header.iter().position(|h| h == name).expect("a column")].to_owned();
    assert_eq!((cell("name"), cell("shape"), cell("pixels")), ("part".into(), "rectangle".into(), "8".into()));
    for (column, value) in [
        ("mean", &figures["mean"]),
        ("max", &figures["max"]),
        ("percentile_50", &figures["percentiles"][0]["value"]),
        ("uniformity_u0", &figures["uniformity_u0"]),
        ("X", &probed["results"][0]["xyz"][0]),
    ] {
        assert_eq!(cell(column).parse::<f64>().ok(), value.as_f64(), "{column}");
    }
    let out = photopic().current_dir(&folder).args(args).assert().success();
    let text = String::from_utf8_lossy(&out.get_output().stdout).into_owned();
    assert!(text.contains("rectangle of 4 × 2 pixels at 1, 1: 8 pixels") && text.contains("U0 0."), "{text}");
    // A line has a row per pixel, and each pixel is what --pixel says.
    let line = ["image", "probe", "cube.hdr", "--line", "0,0,5,3", "--csv"];
    let out = photopic().current_dir(&folder).args(line).assert().success();
    let rows: Vec<csv::StringRecord> =
        csv::Reader::from_reader(&out.get_output().stdout[..]).records().map(|r| r.expect("cells")).collect();
    assert_eq!(rows.len(), 6);
    let pixel = json(folder.path(), &["image", "probe", "cube.hdr", "--pixel", "5,3", "--json"]);
    let mean = pixel["results"][0]["luminance_cd_per_m2"]["mean"].as_f64();
    assert_eq!(rows[5][5].parse::<f64>().ok(), mean);
    assert_eq!((&rows[5][2], &rows[5][3]), ("5", "3"));
}

#[test]
fn places_come_in_the_order_of_the_command_line() {
    let folder = tempfile::tempdir().expect("a folder");
    write_cube(folder.path());
    let places = ["--line", "a=0,0,5,3", "--pixel", "b=5,3", "--rect=c=0,0,2,2", "--pixel", "d=0,0"];
    let more = ["--circle", "e=3,2,2", "--json", "--polygon", "f=0,0,6,0,3,4", "--line", "g=0,0,1,1"];
    // The image may stand among them, too.
    let args = [&["image", "probe"], &places[..], &["cube.hdr"], &more[..]].concat();
    let probed = json(folder.path(), &args);
    let results = probed["results"].as_array().expect("a list");
    let told: Vec<_> = results.iter().map(|r| (r["name"].as_str(), r["shape"]["kind"].as_str())).collect();
    let kinds = ["line", "pixel", "rectangle", "pixel", "circle", "polygon", "line"].map(Some);
    let names = ["a", "b", "c", "d", "e", "f", "g"].map(Some);
    assert_eq!(told, names.into_iter().zip(kinds).collect::<Vec<_>>());
}

#[test]
fn what_cannot_be_probed_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    write_cube(folder.path());
    for (args, want) in [
        (vec![], "nothing to look at; expected --pixel"),
        (vec!["--pixel", "6,0"], "pixel 6, 0 reaches beyond the image of 6 × 4 pixels"),
        (vec!["--pixel", "0.5,0"], "expected whole numbers of pixels"),
        (vec!["--pixel", "1,2,3"], "expected 2 numbers"),
        (vec!["--pixel", "nan,0"], "expected 2 numbers"),
        (vec!["--rect", "0,0,0,2"], "expected one with a width and a height"),
        (vec!["--rect", "3,0,4,1"], "reaches beyond the image"),
        (vec!["--rect", "1,0,4294967295,1"], "reaches beyond the image"),
        (vec!["--polygon", "0,0,1,1"], "expected the corners x,y of a polygon, at least three"),
        (vec!["--polygon", "0,0,1,1,2,2"], "no pixel's centre lies in the polygon"),
        (vec!["--polygon", "0,0,7,1,2,2"], "reaches beyond"),
        (vec!["--circle", "2,2,0.1"], "no pixel's centre lies in the circle"),
        (vec!["--circle", "2,2,-1"], "expected a radius above 0"),
        (vec!["--circle", "1,1,2"], "reaches beyond"),
        (vec!["--spot", "3,2,1"], "--fov"),
        (vec!["--spot", "3,2,1", "--fov", "180"], "--fov 180: expected an angle above 0° and below 180°"),
        (vec!["--spot", "3,2,70", "--fov", "60"], "reaches beyond"),
        (vec!["--line", "0,0,6,0"], "line from 0, 0 to 6, 0 reaches beyond"),
        (vec!["--pixel", "0,0", "--percentiles", "50,101"], "expected numbers from 0 to 100"),
        (vec!["--pixel", "0,0", "--csv=profile"], "expected --line"),
        (vec!["--pixel", "0,0", "--json", "--csv"], "cannot be used with"),
    ] {
        let out = photopic().current_dir(&folder).args(["image", "probe", "cube.hdr"]).args(&args).assert().code(2);
        let stderr = String::from_utf8_lossy(&out.get_output().stderr).into_owned();
        assert!(stderr.contains(want), "{args:?}: {stderr}");
    }
    // Reflectance has a spectrum without a light, and says what is missing.
    let args = ["image", "probe", "cube.hdr", "--reflectance", "--pixel", "0,0", "--json"];
    let out = json(folder.path(), &args);
    assert_eq!(out["findings"][0]["code"], "I040");
    assert_eq!(out["results"][0]["spectrum"]["values"].as_array().map(Vec::len), Some(31));
    assert!(out["results"][0].get("luminance_cd_per_m2").is_none());
    let lit = json(folder.path(), &[&args[..], &["--illuminant", "D65"]].concat());
    assert!(lit["results"][0]["photopic"]["mean"].is_number(), "{lit}");
}
