//! Materials that are measured tables: readings are those of the table, whatever its format, and what is wrong with one is told.

use std::f64::consts::PI;
use std::path::Path;

use photopic::brdf::Brdf;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::format::merl;
use photopic::brdf::table::{Channel, HalfAngle, Resolution, SampledTable, Table};
use photopic::geometry::direction::from_degrees;
use predicates::str::contains;

use crate::cli::{json, photopic, scene};

fn model(text: &str) -> Box<dyn Brdf> {
    text.parse::<Material>().expect("a material").prepare(Bands::Wavelengths(&[555.0])).expect("a model")
}

/// A model in MERL's bins, the same in all three channels; what lies below the horizon is missing.
fn bins(model: &dyn Brdf, resolution: Resolution) -> HalfAngle {
    let value = |bin: usize| {
        let (i, o) = resolution.centre(bin).directions();
        let mut value = [f64::NAN];
        if i.z > 0.0 && o.z > 0.0 {
            model.evaluate(i, o, &mut value);
        }
        [value[0] as f32; 3]
    };
    HalfAngle::new(resolution, Channel::rgb(), (0..resolution.bins()).flat_map(value).collect()).expect("a table")
}

const SOME: Resolution = Resolution { theta_h: 60, theta_d: 30, phi_d: 36 };

fn write(folder: &Path, name: &str, table: &HalfAngle) {
    std::fs::write(folder.join(name), merl::write(table).expect("three channels")).expect("written");
}

/// A CSV of one direction: what is the same for all of them.
fn constant(folder: &Path, name: &str, column: &str, values: &[(&str, f64)]) {
    let mut text = format!("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,{column},value\n");
    for (theta_i, theta_o) in [(0, 0), (30, 60)] {
        values.iter().for_each(|(channel, value)| text += &format!("{theta_i},0,{theta_o},180,{channel},{value}\n"));
    }
    std::fs::write(folder.join(name), text).expect("written");
}

/// A floor of a material, seen under `theta_o` from x > 0 with light from x < 0 or from all over.
fn floor(file: &str, light: &str, theta_o: f64) -> String {
    let (sin, cos) = theta_o.to_radians().sin_cos();
    format!(
        "[[material]]\nname = \"m\"\nmeasured = {{ file = \"{file}\" }}\n\
         [[shape]]\nmaterial = \"m\"\nrectangle = {{ corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }}\n\
         [[light]]\n{light}\n\
         [[sensor]]\nname = \"s\"\nluminance = {{ at = [{sin}, 0, {cos}], look_at = [0, 0, 0], acceptance = \"0.02 deg\" }}\n"
    )
}

/// The reading and its standard error; no audit has anything to say.
fn reading(folder: &tempfile::TempDir, text: &str, samples: &str) -> (f64, f64) {
    let out = json(photopic().arg("render").arg(scene(folder, text)).args(["--json", "--meter-samples", samples]));
    assert_eq!(out["findings"].as_array().map(Vec::len), Some(0), "{}", out["findings"]);
    let sensor = &out["results"][0]["sensors"][0];
    (sensor["value"].as_f64().expect("a number"), sensor["standard_error"].as_f64().expect("a number"))
}

/// L = E f under a light of one direction: 1000 lx along the normal, f what the table holds between its wavelengths, beyond them, in its
/// colours under D65 (Y of the primaries of IEC 61966-2-1), in its only channel.
#[test]
fn what_does_not_depend_on_directions_is_read_as_it_stands() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    write(at, "lambert.binary", &bins(model("lambert(reflectance=0.5)").as_ref(), SOME));
    constant(at, "wavelengths.csv", "wavelength_nm", &[("450", 0.1), ("650", 0.2)]);
    constant(at, "red.csv", "channel", &[("R", 0.2), ("G", 0.0), ("B", 0.0)]);
    constant(at, "below.csv", "channel", &[("R", 0.2), ("G", -0.3), ("B", -0.1)]);
    constant(at, "grey.csv", "channel", &[("Visible", 0.2)]);
    for (file, spectrum, expected, accuracy) in [
        // Single precision.
        ("lambert.binary", "D65", 0.5 / PI, 1e-7),
        ("lambert.binary", "line:470nm", 0.5 / PI, 1e-7),
        ("wavelengths.csv", "line:500nm", 0.125, 1e-12),
        ("wavelengths.csv", "line:700nm", 0.2, 1e-12),
        ("wavelengths.csv", "line:420nm", 0.1, 1e-12),
        // The standard's four digits, and the tolerance of the wavelengths carried.
        ("red.csv", "D65", 0.2 * 0.2126, 1.5e-3),
        ("below.csv", "D65", 0.2 * 0.2126, 1.5e-3),
        ("grey.csv", "line:700nm", 0.2, 1e-12),
    ] {
        let light = format!("distant = {{ from = [0, 0, 1], irradiance = \"1000 lx\" }}\nspectrum = \"{spectrum}\"");
        let (value, error) = reading(&folder, &floor(file, &light, 35.0), "32");
        let off = value / (1000.0 * expected) - 1.0;
        assert!(off.abs() < accuracy && error < 1e-9 * value, "{file} {spectrum}: {value} ± {error}, {off}");
    }
}

/// Under a light of one direction the floor shows the bin of the two directions, as `photopic brdf eval` has it. Under light from everywhere it
/// shows the table's albedo, as the quadrature has it, and the model's up to what the bins make of it.
#[test]
fn a_lobe_in_bins_reads_as_the_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = model("0.5*lambert(reflectance=0.6) + 0.5*ggx(alpha=0.2, medium=Au)");
    let table = bins(own.as_ref(), SOME);
    write(folder.path(), "gold.binary", &table);
    let table = Table::from(table);
    for (theta_i, theta_o) in [(30.0_f64, 29.3), (30.0, 41.0), (62.0, 20.0)] {
        let (sin, cos) = theta_i.to_radians().sin_cos();
        let light = format!("distant = {{ from = [{}, 0, {cos}], irradiance = \"1000 lx\" }}", -sin);
        let (value, _) = reading(&folder, &floor("gold.binary", &light, theta_o), "32");
        let mut f = [0.0; 3];
        table.evaluate(from_degrees(theta_i, 180.0), from_degrees(theta_o, 0.0), &mut f);
        // All rays of the meter are within one bin; the file's numbers are single precision.
        assert!((value / (1000.0 * cos * f[0]) - 1.0).abs() < 1e-6, "{theta_i} {theta_o}: {value} {}", f[0]);
    }
    for theta_o in [5.0, 50.0] {
        let light = "environment = { radiance = \"1000 cd/m2\" }";
        let (value, error) = reading(&folder, &floor("gold.binary", light, theta_o), "65536");
        let (mut rho, mut of_model) = ([0.0; 3], [0.0]);
        let bound = table.albedo(from_degrees(theta_o, 0.0), &mut rho);
        own.albedo(from_degrees(theta_o, 0.0), &mut of_model);
        assert!(error < 2e-3 * value, "{value} ± {error}");
        assert!(
            (value - 1000.0 * rho[0]).abs() < 3.0 * error + 1000.0 * bound,
            "{theta_o}: {value} ± {error}, {rho:?}"
        );
        // θ_h of a bin is up to 1.6° wide where the lobe is (30° of 60 bins), a tenth of it.
        assert!((rho[0] / of_model[0] - 1.0).abs() < 0.02, "{theta_o}: {rho:?} {of_model:?}");
    }
    // The sampler that paths take is that of the table.
    assert!(SampledTable::new(table).pdf(from_degrees(30.0, 180.0), from_degrees(30.0, 0.0)) > 0.5);
}

/// In surroundings of 1000 cd/m² a diffuser of reflectance 0.5 in a table shows 500 cd/m² whatever its shape, also from both ends, under a texture of
/// one half, and in a mixture.
#[test]
fn a_furnace_shows_the_reflectance() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "lambert.binary", &bins(model("lambert(reflectance=0.5)").as_ref(), SOME));
    let body = |material: &str, solver: &str| {
        format!(
            "[render]\nsolver = \"{solver}\"\n\
             [[material]]\nname = \"m\"\nmeasured = {{ file = \"lambert.binary\" }}\n\
             [[material]]\nname = \"half\"\nmeasured = {{ file = \"lambert.binary\" }}\ncheckerboard = {{ even = 0.5, odd = 0.5, fields = [1, 1] }}\n\
             [[material]]\nname = \"mixed\"\nmixture = [{{ material = \"m\", share = 0.6 }}]\n\
             [[shape]]\nmaterial = \"{material}\"\nsphere = {{ centre = [0, 0, 0], radius = \"1 m\" }}\n\
             [[light]]\nenvironment = {{ radiance = \"1000 cd/m2\" }}\n\
             [[sensor]]\nname = \"s\"\nluminance = {{ at = [0, -4, 0.3], look_at = [0, 0, 0.3], acceptance = \"20 deg\" }}\n"
        )
    };
    for (material, solver, expected) in
        [("m", "path", 500.0), ("m", "bidirectional", 500.0), ("half", "path", 250.0), ("mixed", "path", 300.0)]
    {
        let (value, error) = reading(&folder, &body(material, solver), "65536");
        assert!(error < 2e-3 * expected, "{material}: {value} ± {error}");
        assert!((value - expected).abs() < 3.0 * error + 1e-6 * expected, "{material} {solver}: {value} ± {error}");
    }
}

/// One error, at the place in the scene that asks for the table.
#[test]
fn what_is_wrong_with_a_table_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let mut bytes = merl::write(&bins(model("lambert(reflectance=0.5)").as_ref(), SOME)).expect("three channels");
    bytes.truncate(bytes.len() - 8);
    std::fs::write(at.join("cut.binary"), bytes).expect("written");
    std::fs::write(at.join("model.toml"), "model = \"lambert\"\nreflectance = 0.5\n").expect("written");
    std::fs::write(at.join("words.csv"), "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,value\n0,0,0,0,R,many\n")
        .expect("written");
    constant(at, "xyz.csv", "channel", &[("X", 0.2), ("Y", 0.2), ("Z", 0.2)]);
    let light = "distant = { from = [0, 0, 1], irradiance = \"1000 lx\" }";
    for (file, expected) in [
        ("none.binary", "none.binary: no such file; expected a measured BRDF"),
        ("cut.binary", "bytes; expected"),
        ("model.toml", "found a model; expected a measured BRDF"),
        ("words.csv", "`many`; expected a finite number"),
        ("xyz.csv", "a table of X, Y, Z; expected wavelengths, red, green and blue, or one channel"),
    ] {
        let path = scene(&folder, &floor(file, light, 35.0));
        let refused = photopic().arg("render").arg(path).arg("--check").assert().code(2);
        refused.stderr(contains("scene.toml:3:12: ")).stderr(contains(expected));
    }
    // A table in the place of a model.
    let text = floor("x", light, 35.0).replace("measured = { file = \"x\" }", "brdf = \"xyz.csv\"");
    let refused = photopic().arg("render").arg(scene(&folder, &text)).arg("--check").assert().code(2);
    refused.stderr(contains("a measured table is `measured = { file = \"NAME\" }`"));
}

/// f = 0.4/sr in all directions is a reflectance of 0.4 π = 1.257: more than there is, which is told and not corrected.
#[test]
fn a_table_that_gives_back_more_than_it_gets_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    constant(folder.path(), "bright.csv", "channel", &[("Y", 0.4)]);
    let text = floor("bright.csv", "environment = { radiance = \"1000 cd/m2\" }", 35.0);
    let out = json(photopic().arg("render").arg(scene(&folder, &text)).args(["--json", "--meter-samples", "4096"]));
    let finding = out["findings"].as_array().expect("findings").iter().find(|f| f["code"] == "R013").expect("R013");
    assert_eq!((finding["location"]["line"].as_u64(), finding["location"]["column"].as_u64()), (Some(3), Some(12)));
    assert!(finding["message"].as_str().is_some_and(|m| m.contains("`m` gives back 1.2")), "{finding}");
    let value = out["results"][0]["sensors"][0]["value"].as_f64().expect("a number");
    assert!((value / (400.0 * PI) - 1.0).abs() < 0.01, "{value}");
}
