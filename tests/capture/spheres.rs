//! `photopic capture brdf` as a user meets it: a white sphere photographed here, its table, its report, bins filled on request.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use glam::DVec3;
use photopic::brdf::table::Resolution;
use serde_json::Value;
use tempfile::TempDir;
use tiff::encoder::{TiffEncoder, colortype};

use crate::cli::{has_finding, json, run};

/// A white diffuse sphere of reflectance 0.5 under one distant light, as a linear TIFF of 16 bits in three channels: radiance 1 is full.
fn sphere(path: &Path, light: DVec3) {
    let (centre, side, focal) = (DVec3::new(0.0, 0.0, 10.0), 64_u32, 300.0);
    let pixel = |i: u32| {
        let at = |n: u32| (f64::from(n) - 31.5) / focal;
        let ray = DVec3::new(at(i % side), at(i / side), 1.0).normalize();
        let (b, c) = (ray.dot(centre), centre.length_squared() - 1.0);
        let root = b * b - c;
        let normal = ray * (b - root.max(0.0).sqrt()) - centre;
        let radiance =
            if root > 0.0 { 0.5 / std::f64::consts::PI * 3.0 * normal.dot(light.normalize()).max(0.0) } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65535")]
        let sample = (65535.0 * radiance).round() as u16;
        sample
    };
    let samples: Vec<u16> = (0..side * side).flat_map(|i| [pixel(i); 3]).collect();
    let mut file = fs::File::create(path).expect("a file");
    let mut encoder = TiffEncoder::new(&mut file).expect("a TIFF");
    encoder.write_image::<colortype::RGB16>(side, side, &samples).expect("written");
}

const SPHERE: &str = "title = \"a <white> ball\"
[camera]
fx = 300.0
fy = 300.0
cx = 31.5
cy = 31.5
places_per_side = 1
[sphere]
centre_m = [0.0, 0.0, 10.0]
radius_m = 1.0
[radiance]
unit_w_per_m2_sr = 1.0
absolute_error = 5e-6
";

/// A folder with a manifest of the sphere under lights from these directions, each with its photograph.
pub(crate) fn spheres(lights: &[[f64; 3]]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let mut manifest = SPHERE.to_owned();
    for (n, direction) in lights.iter().enumerate() {
        sphere(&folder.path().join(format!("{n}.tif")), DVec3::from_array(*direction));
        manifest.push_str(&format!(
            "[[light]]\nname = \"{n}\"\ndirection = {direction:?}\nirradiance_w_per_m2 = 3.0\n\
             [[stack]]\nname = \"{n}\"\nexposures = [{{ photo = \"{n}.tif\" }}]\n"
        ));
    }
    fs::write(folder.path().join("capture.toml"), manifest).expect("a manifest");
    folder
}

pub(crate) const LIGHTS: [[f64; 3]; 3] = [[0.3, 0.2, -1.0], [1.0, 0.0, -0.5], [-0.5, -0.8, -0.4]];

#[test]
fn a_sphere_gives_its_brdf_and_a_report() {
    let folder = spheres(&LIGHTS);
    let arguments =
        ["brdf", "capture.toml", "-m", "lambert", "--resolution", "30x30x36", "--report", "ball.html", "--json"];
    let (code, out, error) = run(folder.path(), &arguments);
    assert_eq!(code, 0, "{error}");
    let result = &json(&out)["results"][0];
    // Rounding to 1/65535 where cosθ_i is a sixth: 1/(2 · 0.08 · 65535) of the value at most.
    let found = result["fits"][0]["parameters"][0]["value"].as_f64().expect("a reflectance");
    assert!((found - 0.5).abs() < 0.5 * 1e-4, "{found}");
    assert!(result["audit"]["albedo_max"].as_f64().is_some_and(|a| (a - 0.5).abs() < 1e-4), "{result}");
    assert!(result["reciprocity"]["median_relative"].as_f64().is_some_and(|r| r < 1e-3), "{}", result["reciprocity"]);
    assert_eq!(result["residuals"].as_array().map(Vec::len), Some(3));
    // No light stands near the middle of what these three leave: the first one named is apart from all of them.
    let to_camera = |l: [f64; 3]| DVec3::from_array(l).normalize().dot(DVec3::NEG_Z).acos().to_degrees();
    let next = result["next_lights"][0]["to_camera_deg"].as_f64().expect("a light");
    assert!(LIGHTS.iter().all(|l| (to_camera(*l) - next).abs() > 5.0), "{next}");
    let shares: Vec<f64> = result["next_lights"]
        .as_array()
        .expect("lights")
        .iter()
        .filter_map(|n| n["reachable_coverage_fraction"].as_f64())
        .collect();
    assert!(shares.is_sorted() && shares[0] > result["reachable_coverage_fraction"].as_f64().expect("a share"));
    let page = fs::read_to_string(folder.path().join("ball.html")).expect("a report");
    assert!(page.contains("<title>a &lt;white&gt; ball</title>") && page.contains("What to photograph next"));
    for file in json(&out)["inputs"].as_array().expect("inputs") {
        assert!(page.contains(file["sha256"].as_str().expect("a checksum")), "{file}");
    }
    // Self-contained: nothing is fetched, and no script is needed.
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http") && !page.contains("<script"));
    assert!(page.matches("<img src=\"data:image/").count() >= 12);
}

#[test]
fn spheres_that_tell_little_or_nothing_say_so() {
    let folder = spheres(&LIGHTS[..1]);
    let fit = ["brdf", "capture.toml", "-m", "lambert", "--resolution", "30x30x36"];
    let (code, _, error) = run(folder.path(), &fit);
    assert!(code == 0 && error.contains("K010"), "{error}");
    image::GrayImage::new(7, 7).save(folder.path().join("mask.png")).expect("written");
    let (code, out, error) = run(folder.path(), &[&fit[..], &["--mask", "mask.png"]].concat());
    assert!(code == 2 && out.is_empty() && error.contains("found a mask of another size than 64 × 64"), "{error}");
    // One of three lights behind the sphere: the others stand.
    let folder = spheres(&[LIGHTS[0], LIGHTS[1], [0.0, 0.0, 1.0]]);
    let (code, out, error) = run(folder.path(), &[&fit[..], &["--json"]].concat());
    let document = json(&out);
    assert!(code == 2 && has_finding(&document, "K001") && error.contains("below the horizon"), "{error}");
    assert!(document["results"][0]["measurements"].as_u64().is_some_and(|n| n > 1000), "{document}");
    // Alone it is an error, as is a stack of codes.
    let folder = spheres(&[[0.0, 0.0, 1.0]]);
    let (code, out, error) = run(folder.path(), &fit);
    assert!(code == 2 && out.is_empty() && error.contains("below the horizon"), "{error}");
    let manifest = fs::read_to_string(folder.path().join("capture.toml")).expect("a manifest");
    fs::write(folder.path().join("capture.toml"), manifest.replace("0.tif", "missing.tif")).expect("written");
    let (code, _, error) = run(folder.path(), &fit);
    assert!(code == 2 && error.contains("missing.tif: cannot be read"), "{error}");
}

/// Rows of a table by their first three cells, and how many columns it has.
fn rows(csv: &str) -> (Vec<String>, BTreeMap<String, Vec<String>>) {
    let mut lines = csv.lines().map(|l| l.split(',').map(str::to_owned).collect::<Vec<_>>());
    let head = lines.next().expect("a head");
    (head, lines.map(|l| (l[..3].join(","), l)).collect())
}

const COARSE: [&str; 6] = ["brdf", "capture.toml", "-m", "lambert", "--resolution", "12x10x8"];

#[test]
fn bins_are_filled_only_on_request_and_are_marked() {
    let folder = spheres(&LIGHTS);
    let table = |more: &[&str]| {
        let (code, out, error) = run(folder.path(), &[&COARSE[..], more].concat());
        assert_eq!(code, 0, "{error}");
        out
    };
    let (head, measured) = rows(&table(&["--csv", "-o", "plain.binary", "-o", "plain.csv"]));
    let (filled_head, filled) = rows(&table(&["--csv", "--fill", "model", "-o", "full.binary", "-o", "full.csv"]));
    // Without --fill there is no word of it, and no file beside.
    assert!(!head.contains(&"known".to_owned()) && !folder.path().join("plain.binary.mask").exists());
    assert_eq!(filled_head[5], "known");
    let (mut inferred, exact) = (0, 0.5 / PI);
    for (place, row) in &filled {
        let value: f64 = row[6].parse().expect("a value");
        if let Some(own) = measured.get(place) {
            assert!(row[5] == "measured" && row[..5] == own[..5] && row[6..] == own[5..], "{row:?} {own:?}");
        } else {
            inferred += 1;
            // The fit holds the reflectance to 10⁻⁴, a test of its own says; no standard error stands beside what nobody measured.
            assert!(row[3] == "0" && row[5] == "inferred" && (value / exact - 1.0).abs() < 1e-4, "{row:?}");
            assert!(row[7].is_empty() && row[9].is_empty() && row[11].is_empty(), "{row:?}");
        }
    }
    assert!(inferred > 100 && measured.keys().all(|k| filled.contains_key(k)));
    // Table and mask: 12 bytes of numbers, then the bins; −1 where nothing is known.
    let read = |name: &str| fs::read(folder.path().join(name)).expect(name);
    let (plain, full, mask) = (read("plain.binary"), read("full.binary"), read("full.binary.mask"));
    let red = |file: &[u8], bin: usize| f64::from_le_bytes(file[12 + 8 * bin..][..8].try_into().expect("8 bytes"));
    assert!(mask[..12] == full[..12] && mask.len() == 12 + 12 * 10 * 8);
    let mut counts = [0; 3];
    for (bin, mark) in mask[12..].iter().enumerate() {
        counts[usize::from(*mark)] += 1;
        match mark {
            2 => assert_eq!(red(&full, bin).to_bits(), red(&plain, bin).to_bits()),
            // 1500 of the file's red units are 1/sr.
            1 => assert!((red(&full, bin) / 1500.0 / exact - 1.0).abs() < 1e-4 && red(&plain, bin) < 0.0),
            _ => assert!(red(&full, bin) < 0.0 && red(&plain, bin) < 0.0),
        }
    }
    assert_eq!((counts[1], counts[2]), (inferred, measured.len()));
    let marked = String::from_utf8(read("full.csv")).expect("text");
    assert!(marked.starts_with("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,value,known\n"));
    let of = |how: &str| marked.lines().filter(|l| l.ends_with(how)).count();
    // Three channels; those measured bins whose middle is below the horizon are no points.
    assert!(of(",inferred") == 3 * inferred && of(",measured") <= 3 * measured.len() && of(",measured") > 0);
    // The points are read again without the marks.
    let info = Command::cargo_bin("photopic")
        .expect("the program")
        .arg("brdf")
        .args(["info", "full.csv"])
        .current_dir(folder.path())
        .output();
    assert!(info.expect("it runs").status.success());
    let (code, out, _) =
        run(folder.path(), &[&COARSE[..], &["--fill", "model", "--json", "--report", "full.html"]].concat());
    let document = json(&out);
    assert!(code == 0 && has_finding(&document, "K028"));
    let told = &document["results"][0]["filled"];
    assert_eq!(told["kind"], "model");
    assert_eq!(
        (told["inferred_bins"].as_u64(), told["measured_bins"].as_u64()),
        (Some(counts[1] as u64), Some(counts[2] as u64))
    );
    let page = fs::read_to_string(folder.path().join("full.html")).expect("a report");
    assert!(
        page.contains("bins were filled by the model lambert") && page.contains("Orange: nothing measured, inferred.")
    );
    // Formats without a place for marks, and options that do not go together.
    for (more, words) in [
        (&["--fill", "model", "-o", "x.alta"][..], "no place for what is inferred"),
        (&["--fill", "model", "--basis", "x"], "found --basis with --fill model"),
        (&["--fill", "pca"], "--basis <FILE>"),
        (&["--basis", "x"], "--fill <HOW>"),
        (&["--fill", "pca", "--basis", "plain.csv"], "plain.csv: found no basis"),
    ] {
        let (code, out, error) = run(folder.path(), &[&COARSE[..], more].concat());
        assert!(code == 2 && out.is_empty() && error.contains(words), "{more:?}: {error}");
    }
}

#[test]
fn a_basis_that_holds_the_material_fills_bins_with_it() {
    let folder = spheres(&LIGHTS);
    let train = ["brdf", "compress", "train", "--resolution", "12x10x8", "-o", "white.basis"];
    let set = ["lambert(reflectance=0.2)", "lambert(reflectance=0.5)", "lambert(reflectance=0.8)"];
    let mut command = Command::cargo_bin("photopic").expect("the program");
    command.current_dir(folder.path()).args(train).args(set).assert().success();
    let fill = ["brdf", "capture.toml", "-m", "lambert", "--fill", "pca", "--basis", "white.basis", "--json"];
    let (code, out, error) = run(folder.path(), &[&fill[..], &["-o", "white.binary"]].concat());
    assert_eq!(code, 0, "{error}");
    let document = json(&out);
    assert_eq!(document["results"][0]["filled"]["kind"], "pca");
    assert_eq!(document["settings"]["resolution"], serde_json::json!([12, 10, 8]));
    let read = |name: &str| fs::read(folder.path().join(name)).expect(name);
    let (full, mask) = (read("white.binary"), read("white.binary.mask"));
    let bins = 12 * 10 * 8;
    let marked = |mark: u8| (0..bins).filter(|b| mask[12 + b] == mark).collect::<Vec<_>>();
    // The material is in the set, so that only the prior pulls: with σ² = 10⁻³ and Σc²/v ≤ 3 (three columns of a set of nine are this one) the
    // norm of what it changes over the N measured bins is σ√3 at most, in ln(f w + 0.001). Bins where f w is far above 0.001 are alike: √N of it
    // in each.
    let bound = (3e-3_f64).sqrt() / (marked(2).len() as f64).sqrt();
    let resolution = Resolution { theta_h: 12, theta_d: 10, phi_d: 8 };
    let alike = |bin: &usize| {
        let (i, o) = resolution.centre(*bin).directions();
        i.z * o.z > 0.2
    };
    let inferred: Vec<usize> = marked(1).into_iter().filter(alike).collect();
    assert!(inferred.len() > 50 && bound < 0.01, "{} {bound}", inferred.len());
    for bin in inferred {
        let value = f64::from_le_bytes(full[12 + 8 * bin..][..8].try_into().expect("8 bytes")) / 1500.0;
        assert!((value / (0.5 / PI)).ln().abs() < bound, "{bin}: {value}, {bound}");
    }
    // A basis knows absolute values: a relative result is warned of.
    let manifest = fs::read_to_string(folder.path().join("capture.toml")).expect("a manifest");
    fs::write(folder.path().join("capture.toml"), manifest.replace("unit_w_per_m2_sr = 1.0", "")).expect("written");
    let (code, out, error) = run(folder.path(), &fill);
    let document = json(&out);
    let warned = |f: &Value| f["code"] == "K028" && f["severity"] == "warning";
    assert!(code == 0 && document["findings"].as_array().expect("findings").iter().any(warned), "{error}");
    let (code, out, error) = run(folder.path(), &[&fill[..], &["--resolution", "30x30x36"]].concat());
    assert!(code == 2 && out.is_empty() && error.contains("found a table of [30, 30, 36] bins"), "{error}");
}

#[test]
fn swapped_pictures_are_named() {
    let lights = [LIGHTS[0], LIGHTS[1], LIGHTS[2], [-0.2, 0.6, -1.0], [0.4, -0.5, -0.9], [-0.9, 0.1, -0.7]];
    let folder = spheres(&lights);
    let named = || {
        let (code, out, error) = run(folder.path(), &["brdf", "capture.toml", "-m", "lambert", "--json"]);
        assert_eq!(code, 0, "{error}");
        let document = json(&out);
        let of = document["findings"].as_array().expect("findings").iter().filter(|f| f["code"] == "K029");
        of.map(|f| f["location"]["item"].as_str().expect("a stack").to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(named(), [""; 0]);
    let path = |n: u32| folder.path().join(format!("{n}.tif"));
    fs::rename(path(1), path(9)).expect("renamed");
    fs::rename(path(2), path(1)).expect("renamed");
    fs::rename(path(9), path(2)).expect("renamed");
    assert_eq!(named(), ["1", "2"]);
}
