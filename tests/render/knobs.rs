//! What only speed and noise depend on: where chance ends paths, how the random numbers lie, how many wavelengths a path carries. Whatever
//! is chosen, the mean is that of the closed form.

use std::f64::consts::PI;

use photopic::render::build::{Kind, NoFiles, build};
use photopic::render::description::Description;
use photopic::render::estimate::REPLICATES;
use photopic::render::measure::{Board, Settings};
use photopic::render::sampler::Points;
use photopic::render::spool::Share;
use photopic::tables;
use predicates::str::contains;

use crate::cli::{json, photopic, scene};

/// A lamp in the middle of a hollow sphere of 1 m: its wall gets E = Φ/4π straight away, and what it reflects lights all of it alike.
const SPHERE: &str = r#"
[render]
wavelength_step_nm = 20
[[material]]
name = "wall"
reflectance = [[400, 0.3], [700, 0.8]]
[[shape]]
material = "wall"
sphere = { centre = [0, 0, 0], radius = "1 m" }
[[light]]
point = { at = [0, 0, 0], flux = "1000 lm" }
[[sensor]]
name = "spot"
luminance = { at = [0, 0, 0.2], look_at = [0, 0, 1], acceptance = "20 deg" }
"#;

/// The wall's luminance, cd/m², of a flat spectrum at the nodes: Σ V (E/π) Σ_k ρ^k / Σ V, after all reflections or so many.
fn luminance(reflections: Option<i32>) -> f64 {
    let table = tables::get("cie-1924-v").expect("embedded");
    let v = table.wavelengths_nm().iter().zip(table.column("V").expect("its column"));
    let (mut sum, mut seen) = (0.0, 0.0);
    // The middle of the first 20 nm of 360–830 nm, and so on.
    for (nm, v) in v.filter(|(nm, _)| **nm >= 370.0 && (**nm - 370.0) % 20.0 == 0.0) {
        let rho = 0.3 + 0.5 * ((nm - 400.0) / 300.0).clamp(0.0, 1.0);
        let left = reflections.map_or(1.0, |n| 1.0 - rho.powi(n));
        // Nodes stand for what is nearest to them, those at the ends for all from 359.5 to 830.5 nm.
        let v = v * if *nm == 370.0 {
            20.5
        } else if *nm == 830.0 {
            10.5
        } else {
            20.0
        };
        sum += v;
        seen += v * left * rho / (1.0 - rho);
    }
    1000.0 / (4.0 * PI) / PI * seen / sum
}

#[test]
fn no_choice_moves_the_mean() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, file) = (scene(&folder, SPHERE), folder.path().join("knobs.toml"));
    // Value and standard error with keys of `[render]` in place of the scene's.
    let read = |keys: &str| {
        std::fs::write(&file, format!("[render]\n{keys}\n")).expect("written");
        let mut render = photopic();
        render.arg("render").arg(&path).args(["--json", "--packets", "0", "--meter-samples", "65536", "--settings"]);
        let sensor = json(render.arg(&file))["results"][0]["sensors"][0].clone();
        ["value", "standard_error"].map(|key| sensor[key].as_f64().expect("a number"))
    };
    let expected = luminance(None);
    let mut errors = Vec::new();
    for keys in [
        "",
        "sampler = \"independent\"",
        "wavelengths_per_path = \"one\"",
        "roulette_from = 1",
        "roulette_from = 16",
        "wavelengths_per_path = \"one\"\nroulette_from = 1\nsampler = \"independent\"",
    ] {
        let [value, error] = read(keys);
        // 4.5 standard errors, of Student's t of the replicates' 15 degrees of freedom: 4e-4 for each.
        assert!((value - expected).abs() < 4.5 * error, "{keys}: {value} ± {error}, expected {expected}");
        assert!(error < 0.02 * expected, "{keys}: {error}");
        errors.push(error);
    }
    // Chance is all that scatters here: the later it begins, the less, and one wavelength scatters by its own.
    assert!(errors[2] > 2.0 * errors[0] && errors[3] > errors[0] && errors[0] > 2.0 * errors[4], "{errors:?}");
    // Of six edges there are five reflections, and where chance never ends a path nothing scatters.
    let [value, error] = read("max_edges = 6\nroulette_from = 7");
    let expected = luminance(Some(5));
    assert!((value / expected - 1.0).abs() < 1e-12 && error < 1e-12 * expected, "{value} ± {error}, {expected}");
    let [value, error] = read("max_edges = 6");
    assert!((value - expected).abs() < 4.5 * error && error > 1e-6 * expected, "{value} ± {error}, {expected}");
}

#[test]
fn keys_that_do_not_fit_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, file) = (scene(&folder, SPHERE), folder.path().join("knobs.toml"));
    for (keys, expected) in [
        ("roulette_from = 0", "knobs.toml:2:17: a `roulette_from` of 0; expected the number of an edge, from 1"),
        ("branches = 65", "knobs.toml:2:12: `branches` of 65; expected 1 to 64"),
        ("sampler = \"halton\"", "knobs.toml:2:11: unknown variant `halton`, expected `sobol` or `independent`"),
        ("max_edges = \"few\"", "expected a number of edges, or \"any\""),
        ("wavelength_step_nm = 0.5", "a `wavelength_step_nm` of 0.5; expected 1 to 100"),
    ] {
        std::fs::write(&file, format!("[render]\n{keys}\n")).expect("written");
        let mut render = photopic();
        render.arg("render").arg(&path).arg("--settings").arg(&file).assert().code(2).stderr(contains(expected));
    }
    std::fs::write(&file, "").expect("written");
    let mut render = photopic();
    render.arg("render").arg(&path).arg("--settings").arg(&file);
    render.assert().code(2).stderr(contains("knobs.toml:1:1: found nothing; expected a table [render]"));
}

/// The parts of a render have one set of settings: joined they are the whole, and a part with others is refused.
#[test]
fn parts_of_a_render_keep_their_settings() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, file) = (scene(&folder, SPHERE), folder.path().join("knobs.toml"));
    std::fs::write(&file, "[render]\nsolver = \"direct\"\nmeter_samples = 4096\n").expect("written");
    let shards = ["a", "b"].map(|name| folder.path().join(name));
    let render = |shard: &str, to: &std::path::Path| {
        let mut render = photopic();
        render.arg("render").arg(&path).args(["--shard", shard]).arg("-o").arg(to);
        render
    };
    for (shard, to) in ["1/2", "2/2"].into_iter().zip(&shards) {
        render(shard, to).arg("--settings").arg(&file).assert().success();
    }
    let joined = json(photopic().arg("merge").args(&shards).arg("--json"));
    let whole = json(photopic().arg("render").arg(&path).arg("--json").arg("--settings").arg(&file));
    let result = |document: &serde_json::Value| document["results"][0].clone();
    assert_eq!(result(&joined)["model"], result(&whole)["model"]);
    assert_eq!(result(&joined)["model"]["solver"], "direct");
    assert_eq!(result(&joined)["sensors"], result(&whole)["sensors"]);
    let other = folder.path().join("c");
    render("2/2", &other).args(["--meter-samples", "4096"]).assert().success();
    photopic().arg("merge").args([&shards[0], &other]).assert().code(2);
}

/// Renders whose errors are averaged.
const SEEDS: u64 = 96;

/// The root of the mean square error of a lamp's illuminance over seeds, for some numbers of samples.
fn errors(points: Points) -> Vec<(f64, f64)> {
    /// Of each replicate.
    const SAMPLES: [u64; 4] = [16, 64, 256, 1024];
    // A square of 1 m 1 m above: π L F with F = (4/2π) · 2 (a/√(1 + a²)) atan(a/√(1 + a²)) of its quarters, a = 1/2 (Howell's catalogue, B-3).
    let quarter = 0.5 / 1.25_f64.sqrt();
    let expected = 1000.0 * 4.0 * quarter * quarter.atan();
    let text = r#"
[[shape]]
emission = { radiance = "1000 cd/m2" }
rectangle = { corner = [-0.5, -0.5, 1], edges = [[0, 1, 0], [1, 0, 0]] }
[[sensor]]
name = "below"
illuminance = { at = [0, 0, 0] }
"#;
    let built = build(text, &Description::parse(text).expect("a scene"), &NoFiles).expect("a scene");
    let Kind::Meter(meter) = &built.instruments[0].kind else { panic!("a meter") };
    let one = |samples: u64, seed: u64| {
        let settings = Settings { seed, points, ..built.settings.clone() };
        let mut board = Board::new(&built.scene, &settings, Share::WHOLE, vec![(0, meter.clone())]);
        board.sample_until(samples);
        board.estimate(0).figure(&built.quantities.luminous).value / expected - 1.0
    };
    let rms = |samples| ((0..SEEDS).map(|seed| one(samples, seed).powi(2)).sum::<f64>() / SEEDS as f64).sqrt();
    SAMPLES.map(|n| ((n * REPLICATES as u64) as f64, rms(n))).to_vec()
}

/// Slope of ln y over ln x.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let (x, y) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

#[test]
fn errors_of_random_numbers_fall_with_their_root_and_of_sobol_points_faster() {
    // The root of a mean of n squares scatters by 1/√(2n); the slope of a line through four of them, ln 4 apart, by that over ln 4 · √5.
    let scatter = (2.0 * SEEDS as f64).sqrt().recip() / (4_f64.ln() * 5_f64.sqrt());
    let (random, sobol) = (errors(Points::Independent), errors(Points::Sobol));
    let (a, b) = (slope(&random), slope(&sobol));
    assert!((a + 0.5).abs() < 3.0 * scatter, "{a}: {random:?}");
    assert!(b < -0.5 - 6.0 * scatter, "{b}: {sobol:?}");
    assert!(random.iter().zip(&sobol).all(|(r, s)| s.1 < r.1), "{random:?} {sobol:?}");
}
