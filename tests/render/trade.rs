//! What a trade of a scene promises: error curves with the slope of theory, and recommendations that hold with other seeds.

use std::cell::Cell;

use glam::DVec3;
use photopic::brdf::table::Table;
use photopic::image::description::Meaning;
use photopic::image::format::exr;
use photopic::image::source::{Region, Source};
use photopic::luminaire::Luminaire;
use photopic::render::build::{Built, Files, Kind, Meshes, NoFiles, Origin, PictureFile, build};
use photopic::render::description::Description;
use photopic::render::estimate::REPLICATES;
use photopic::render::format::Object;
use photopic::render::measure::{Board, Settings};
use photopic::render::mesh::MeshData;
use photopic::render::spool::Share;
use photopic::spectrum::Spectrum;
use predicates::str::contains;
use serde_json::Value;

use crate::cli::{json, photopic, scene};
use crate::denoise::{EVEN, SPHERE};

/// A grey hollow sphere with a small lamp in it: light of many bounces, and noise.
const HOLLOW: &str = r#"
[render]
meter_samples = 16384
[[material]]
name = "grey"
reflectance = 0.6
[[shape]]
name = "wall"
material = "grey"
sphere = { centre = [0, 0, 0], radius = "1 m" }
[[shape]]
name = "lamp"
emission = { radiance = "1000 cd/m2" }
rectangle = { corner = [-0.1, -0.1, 0.5], edges = [[0, 0.2, 0], [0.2, 0, 0]] }
[[sensor]]
name = "low"
illuminance = { at = [0, 0, -0.5] }
[[sensor]]
name = "aside"
illuminance = { at = [0.3, 0.1, 0], normal = [1, 0, 0] }
"#;

/// The readings of a built scene's points with a seed.
fn read(built: &Built, samples: u64, seed: u64) -> Vec<f64> {
    let meters = (0..).zip(&built.instruments).map(|(n, i)| match &i.kind {
        Kind::Meter(meter) => (n << 32, meter.clone()),
        _ => panic!("a scene of points"),
    });
    let settings = Settings { seed, ..built.settings.clone() };
    let meters: Vec<_> = meters.collect();
    let count = meters.len();
    let mut board = Board::new(&built.scene, &settings, Share::WHOLE, meters);
    board.sample_until(samples.div_ceil(REPLICATES as u64));
    (0..count).map(|m| board.estimate(m).figure(&built.quantities.luminous).value).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn errors_fall_as_theory_says_and_what_is_recommended_holds_in_95_of_100_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let best = folder.path().join("best.toml");
    let arguments = ["trade", "render", "--error", "2%", "--sensor", "aside", "--json", "--repeats", "10"];
    let path = scene(&folder, HOLLOW);
    let document = json(photopic().args(arguments).arg("--settings").arg(&best).arg(&path));
    let result = &document["results"][0];
    let trials = result["trials"].as_array().expect("trials");
    let knob = |t: &Value, name: &str| t["settings"][name].as_str().expect("a word").to_owned();
    let of_samples = |t: &&Value| {
        let others = [
            ("solver", "path"),
            ("max_edges", "any"),
            ("roulette_from", "4"),
            ("sampler", "sobol"),
            ("wavelengths", "to 0.001"),
            ("wavelengths_per_path", "all"),
            ("model", "minimal"),
        ];
        others.iter().all(|(name, value)| knob(t, name) == *value)
    };
    let points: Vec<(f64, f64)> = (trials.iter().filter(of_samples))
        .map(|t| {
            let samples: f64 = knob(t, "meter_samples").parse().expect("a number");
            (samples.ln(), number(&t["errors"]["aside"]["error"]).ln())
        })
        .collect();
    assert_eq!(points.len(), 5);
    // N^(−1/2) at least. The root of a mean of 12 squares (two runs to warm up) scatters by 1/√24, so that a line through five of them, 4
    // times the samples apart, has a slope with a standard error of 0.2/(ln 4 · √10) = 0.047; three of these are allowed.
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>();
    assert!(slope < -0.5 + 3.0 * 0.047, "{slope}: {points:?}");
    // Cut paths and direct light lose what bounces on: of ρ = 0.6 that is more than any noise, and it is told.
    let effects = &result["effects"];
    assert!(effects["solver"]["matters"] == true && effects["max_edges"]["matters"] == true, "{effects}");
    // Every knob is turned alone.
    assert_eq!(effects.as_object().map(serde_json::Map::len), Some(8), "{effects}");
    // 200 runs of what was recommended with seeds of their own, against a long one.
    let of = |text: &str| build(text, &Description::parse(text).expect("a scene"), &NoFiles).expect("a scene");
    let truth = read(&of(HOLLOW), 1 << 19, 1 << 60)[1];
    let written = std::fs::read_to_string(&best).expect("settings");
    let keys: Vec<&str> = written.lines().skip(2).filter(|l| *l != "max_edges = \"any\"").collect();
    let built = of(&HOLLOW.replace("meter_samples = 16384", &keys.join("\n")));
    let chosen = &result["recommended"]["settings"];
    let samples: u64 = chosen["meter_samples"].as_str().expect("a word").parse().expect("a number");
    assert_eq!((chosen["solver"].as_str(), chosen["max_edges"].as_str()), (Some("path"), Some("any")));
    let within = (0..200).filter(|seed| (read(&built, samples, 1000 + seed)[1] / truth - 1.0).abs() <= 0.02).count();
    assert!(within >= 190, "{within} of 200 with {chosen}");
    // The file is taken by the renderer itself: as many samples of every meter.
    let rendered = json(photopic().arg("render").arg(&path).arg("--json").arg("--settings").arg(&best));
    assert_eq!(rendered["results"][0]["sensors"][1]["samples"], samples);
}

#[test]
fn scenes_and_files_that_do_not_fit_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(&folder, HOLLOW);
    let trade = || {
        let mut command = photopic();
        command.args(["trade", "render", "--repeats", "5"]).arg(&path);
        command
    };
    trade().args(["--sensor", "high"]).assert().code(2).stderr(contains("no such sensor; expected one of low, aside"));
    trade().args(["--error", "5K", "--meter-samples", "64"]).assert().code(2).stderr(contains("expected per cent"));
    let wrong = folder.path().join("wrong.toml");
    std::fs::write(&wrong, "[render]\nmeter_samples = 0\n").expect("written");
    let mut render = photopic();
    render.arg("render").arg(&path).arg("--settings").arg(&wrong);
    render.assert().code(2).stderr(contains("wrong.toml:2:17: found 0 samples; expected 1 or more"));
    let gonio = "[[sensor]]\nname = \"lamp\"\ngoniophotometer = { c_step = \"30 deg\", gamma_step = \"15 deg\" }\n";
    let path = scene(&folder, &(HOLLOW.split("[[sensor]]").next().expect("the shapes").to_owned() + gonio));
    let mut command = photopic();
    command.args(["trade", "render"]).arg(&path);
    command.assert().code(2).stderr(contains("the scene has no meter; expected a sensor that reads a number"));
    let path = scene(&folder, SPHERE);
    let mut command = photopic();
    command.args(["trade", "render", "--samples", "15"]).arg(&path);
    command.assert().code(2).stderr(contains("15 samples a pixel; expected 16 or more"));
}

/// The errors of pictures are those of the truth, which is the same at every pixel; what is recommended keeps to what was asked.
#[test]
fn errors_of_pictures_are_true_and_what_is_recommended_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let best = folder.path().join("best.toml");
    let path = scene(&folder, SPHERE);
    let trade = |error: &str| {
        let mut command = photopic();
        command.args(["trade", "render", "--json", "--samples", "16", "--repeats", "5", "--error", error]);
        json(command.arg("--settings").arg(&best).arg(&path))["results"][0].clone()
    };
    // The error of a picture, as root mean square over its pixels: as a file has it.
    let rendered = |settings: &std::path::Path, seed: &str| -> f64 {
        let mut render = photopic();
        render.current_dir(&folder).arg("render").arg(&path).args(["--seed", seed, "--packets", "0", "--settings"]);
        render.arg(settings).assert().success();
        let file = std::fs::File::open(folder.path().join("view.exr")).expect("a picture");
        let mut picture = exr::open(std::io::BufReader::new(file)).expect("a picture").value;
        let description = picture.description().clone();
        let y = description.channels.iter().position(|c| c.meaning == Meaning::Tristimulus(1)).expect("Y");
        let mut pixels = vec![0.0; 480];
        picture.read(Region::rows(&description, 0, 20), &[y], &mut pixels).expect("pixels");
        (pixels.iter().map(|l| (f64::from(*l) / EVEN - 1.0).powi(2)).sum::<f64>() / 480.0).sqrt()
    };
    let result = trade("10%");
    let trials = result["trials"].as_array().expect("trials");
    let of = |samples: &str, denoise: &str, virtual_lights: &str| {
        let knob = |t: &Value, name: &str, value: &str| t["settings"][name] == value;
        let own = |t: &&Value| {
            knob(t, "samples", samples)
                && knob(t, "denoise", denoise)
                && knob(t, "virtual_lights", virtual_lights)
                && ["branches", "guiding"].iter().all(|name| knob(t, name, "chosen"))
                && knob(t, "solver", "path")
                && knob(t, "max_edges", "any")
                && knob(t, "roulette_from", "4")
                && knob(t, "sampler", "sobol")
                && knob(t, "model", "minimal")
                && knob(t, "adaptive", "yes")
                && knob(t, "wavelengths_per_path", "all")
        };
        let own = trials.iter().find(own).unwrap_or_else(|| panic!("{samples} {denoise} {virtual_lights}"));
        number(&own["errors"]["view"]["error"])
    };
    let cases = [
        ("16", "no", "no"),
        ("4", "no", "chosen"),
        ("16", "no", "yes"),
        ("16", "no", "chosen"),
        ("16", "yes", "chosen"),
    ];
    for (samples, denoise, virtual_lights) in cases {
        let file = folder.path().join("one.toml");
        let said = match virtual_lights {
            "chosen" => "",
            "yes" => "virtual_lights = true\n",
            _ => "virtual_lights = false\n",
        };
        std::fs::write(&file, format!("[render]\nsamples = {samples}\ndenoise = {}\n{said}", denoise == "yes"))
            .expect("written");
        // The very pictures that were tried, five and two to warm up, each a seed of 2³² further: what is left is what the references scatter, to which filtered
        // pictures are nearer.
        let seeds = (1..=7_u64).map(|n| (n << 32).to_string());
        let mean = seeds.map(|seed| rendered(&file, &seed).powi(2)).sum::<f64>() / 7.0;
        let allowed = if denoise == "yes" { 0.25 } else { 0.1 };
        let off = (of(samples, denoise, virtual_lights) / mean.sqrt()).ln();
        assert!(off.abs() < allowed, "{samples} {denoise} {virtual_lights}: {off}");
    }
    assert!(of("16", "yes", "chosen") < of("16", "no", "chosen"), "{trials:?}");
    // Of cut paths half of the light is lost at each reflection, all but the first: it is told.
    assert!(result["effects"]["max_edges"]["matters"] == true && result["effects"]["denoise"]["matters"] == true);
    assert_eq!(result["effects"].as_object().map(serde_json::Map::len), Some(13), "{}", result["effects"]);
    let chosen = &result["recommended"]["settings"];
    let within = (200..220).filter(|seed: &i32| rendered(&best, &seed.to_string()) <= 0.1).count();
    assert!(within >= 19, "{within} of 20 with {chosen}");
}

#[test]
fn what_a_scene_requires_is_confirmed_by_rendering_both_ways() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(&folder, HOLLOW);
    let document = json(photopic().args(["require", "--json", "--error", "1%", "--meter-samples", "4096"]).arg(&path));
    let result = &document["results"][0];
    assert_eq!(result["kind"], "scene");
    let of = |name: &str| {
        let all = result["requirements"].as_array().expect("requirements");
        all.iter().find(|r| r["question"] == name).unwrap_or_else(|| panic!("{name} in {result}")).clone()
    };
    let paths = of("paths");
    assert_eq!(paths["needed"]["model"], "paths of any length", "{paths}");
    assert_eq!(paths["simpler"]["model"], "paths of up to 6 edges", "{paths}");
    let simpler = number(&paths["simpler"]["error"]);
    // The same by `render`, with seeds of its own: beyond the error, and as far off as was said.
    let cut = folder.path().join("cut.toml");
    std::fs::write(&cut, "[render]\nmax_edges = 6\n").expect("written");
    let readings = |options: &[&std::ffi::OsStr]| {
        let mut render = photopic();
        render.arg("render").arg(&path).args(["--json", "--seed", "77", "--meter-samples", "32768", "--packets", "0"]);
        let document = json(render.args(options));
        let of = |s: &Value| (number(&s["value"]), number(&s["standard_error"]));
        document["results"][0]["sensors"].as_array().expect("sensors").iter().map(of).collect::<Vec<_>>()
    };
    let (all, six) = (readings(&[]), readings(&["--settings".as_ref(), cut.as_os_str()]));
    let off = all.iter().zip(&six).map(|((a, _), (b, _))| (b / a - 1.0).abs());
    let noise = all.iter().chain(&six).map(|(v, s)| s / v).fold(0.0, f64::max);
    let off = off.fold(0.0, f64::max);
    assert!(off > 0.01 && off < simpler + 3.0 * noise, "{off} ± {noise}, {simpler}");
    // Grey walls under equal energy: three colours multiply as wavelengths do.
    assert_eq!(of("wavelengths")["needed"]["model"], "RGB (linear sRGB)");
    // Wavelengths: the renderer's own choice at that error, and one rung lower is beyond it.
    let wavelengths = of("wavelengths");
    assert!(number(&wavelengths["needed"]["error"]) <= 0.01, "{wavelengths}");
    assert!(wavelengths["simpler"].is_null() || number(&wavelengths["simpler"]["error"]) > 0.01, "{wavelengths}");
    assert_eq!(of("polarisation")["needed"]["model"], "unpolarised light");
    assert_eq!(of("azimuth")["needed"]["model"], "isotropic scattering");
    // Where nothing scatters, direct light is all there is.
    let bare = HOLLOW.replace("reflectance = 0.6", "reflectance = 0");
    let path = scene(&folder, &bare);
    let document = json(photopic().args(["require", "--json", "--error", "1%", "--meter-samples", "4096"]).arg(&path));
    let all = document["results"][0]["requirements"].as_array().expect("requirements").clone();
    let paths = all.iter().find(|r| r["question"] == "paths").expect("paths");
    assert_eq!(paths["needed"]["model"], "direct light", "{paths}");
    assert!(paths["because"].as_str().is_some_and(|b| b.contains("nothing scatters")), "{paths}");
}

/// A green ball under an orange lamp of few wavelengths: three colours do not carry it, and the wavelengths that do are confirmed by rendering
/// with them, with those of the rung below, and with all.
#[test]
fn the_wavelengths_that_a_scene_requires_are_confirmed_by_rendering_both_ways() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = HOLLOW
        .replace("reflectance = 0.6", "reflectance = [[500, 0.02], [520, 0.2], [560, 0.2], [600, 0.02]]")
        .replace("radiance = \"1000 cd/m2\"", "radiance = \"1000 cd/m2\", spectrum = \"FL11\"");
    let path = scene(&folder, &text);
    let document = json(photopic().args(["require", "--json", "--error", "1%", "--meter-samples", "64"]).arg(&path));
    let all = document["results"][0]["requirements"].as_array().expect("requirements").clone();
    let wavelengths = all.iter().find(|r| r["question"] == "wavelengths").expect("wavelengths");
    let rungs = wavelengths["rungs"].as_array().expect("rungs");
    assert!(rungs[0]["model"] == "RGB (linear sRGB)" && number(&rungs[0]["error"]) > 0.01, "{wavelengths}");
    let file = folder.path().join("few.toml");
    let render = |key: &str| {
        std::fs::write(&file, format!("[render]\n{key}\n")).expect("written");
        let mut render = photopic();
        render.arg("render").arg(&path).args(["--json", "--meter-samples", "65536", "--packets", "0", "--settings"]);
        json(render.arg(&file))["results"][0].clone()
    };
    let full = render("model = \"full\"");
    for rung in ["needed", "simpler"] {
        let error = number(&wavelengths[rung]["error"]);
        assert_eq!(error <= 0.01, rung == "needed", "{wavelengths}");
        let few = render(&format!("wavelength_tolerance = {}", error * (1.0 + 1e-9)));
        let count = format!("{} wavelengths", few["model"]["wavelengths"]["count"]);
        assert_eq!(wavelengths[rung]["model"], count.as_str());
        // One seed, and the same paths: what differs is the sum over wavelength, up to what chance ends elsewhere.
        for (a, b) in
            full["sensors"].as_array().expect("sensors").iter().zip(few["sensors"].as_array().expect("sensors"))
        {
            let noise = number(&a["standard_error"]).hypot(number(&b["standard_error"])) / number(&a["value"]);
            let off = (number(&b["value"]) / number(&a["value"]) - 1.0).abs();
            // Errors are relative to the largest of X, Y and Z, of which Y is more than 0.9 here; more than two reflections, which are not among
            // the products that wavelengths are chosen by, are 0.2³/0.8 = 1 % of the light.
            assert!(off < 1.2 * error + 4.5 * noise, "{rung}: {off} ± {noise}, {error}");
        }
    }
}

/// Counts how often a mesh is read: a triangle and a sliver.
struct Counted(Cell<usize>);

impl Files for Counted {
    fn spectrum(&self, file: &str) -> Result<Spectrum, String> {
        NoFiles.spectrum(file)
    }

    fn luminaire(&self, file: &str) -> Result<Luminaire, String> {
        NoFiles.luminaire(file)
    }

    fn meshes(&self, _: &str) -> Result<Vec<Object>, String> {
        self.0.set(self.0.get() + 1);
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, 2.0 * DVec3::X];
        let mesh = MeshData { positions, triangles: vec![[0, 1, 2], [0, 1, 3]], ..MeshData::default() };
        Ok(vec![Object { mesh, ..Object::default() }])
    }

    fn picture(&self, file: &str) -> Result<PictureFile, String> {
        NoFiles.picture(file)
    }

    fn table(&self, file: &str) -> Result<Table, String> {
        NoFiles.table(file)
    }
}

/// Scenes of one text read a mesh once for all choices of settings, and each tells what the mesh lost.
#[test]
fn scenes_of_one_text_share_their_meshes() {
    let text = "[[shape]]\nmesh = { file = \"a.ply\" }\n[[sensor]]\nname = \"s\"\nilluminance = { at = [0, 0, 1] }\n";
    let (files, meshes) = (Counted(Cell::new(0)), Meshes::default());
    let mut description = Description::parse(text).expect("a scene");
    for step in [None, Some(10.0)] {
        description.render.wavelength_step_nm = step;
        let built = Origin::new(text, &files, &meshes).build(&description).expect("sound");
        assert_eq!(built.incomplete.iter().map(|i| (i.triangles, i.of, i.first)).collect::<Vec<_>>(), [(1, 2, 2)]);
    }
    assert_eq!(files.0.get(), 1);
}
