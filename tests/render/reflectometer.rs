//! The virtual gonioreflectometer: materials give back themselves.

use std::f64::consts::PI;

use photopic::brdf::Brdf;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::format::{csv, merl};
use photopic::geometry::direction::from_degrees;
use predicates::str::contains;

use crate::instruments::{number, photopic, render};

/// A square of a material under the instrument, which is turned with it so that no axis is the world's.
fn sample(material: &str, file: &str) -> String {
    format!(
        r#"
[render]
wavelength_step_nm = 100
[[material]]
name = "sample"
brdf = "{material}"
[[shape]]
material = "sample"
rectangle = {{ corner = [3, -1, -1], edges = [[0, 2, 0], [0, 0, 2]] }}
[[sensor]]
name = "sample"
gonioreflectometer = {{ at = [3, 0, 0], normal = [1, 0, 0], tangent = [0, 1, 0], radius = "10 cm", theta_i = ["0 deg", "50 deg"], theta_step = "10 deg", phi_step = "30 deg", file = "{file}" }}
"#
    )
}

/// The mean over the cell about (θ, φ), weighted with cosθ.
fn mean(brdf: &dyn Brdf, theta_i: f64, theta: f64, phi: f64) -> f64 {
    let incident = from_degrees(theta_i, 0.0);
    let (low, high) = ((theta - 5.0).max(0.0), theta + 5.0);
    let half = if theta == 0.0 { 180.0 } else { 15.0 };
    let (mut sum, mut whole) = (0.0, 0.0);
    let mut values = [0.0];
    for i in 0..40 {
        let t = low + (high - low) * (f64::from(i) + 0.5) / 40.0;
        let weight = t.to_radians().sin() * t.to_radians().cos();
        for j in 0..60 {
            let outgoing = from_degrees(t, phi - half + 2.0 * half * (f64::from(j) + 0.5) / 60.0);
            brdf.evaluate(incident, outgoing, &mut values);
            sum += weight * values[0];
            whole += weight;
        }
    }
    sum / whole
}

/// Every cell of the table within its standard error of the model's mean over it; `photopic brdf` reads the table.
fn gives_itself_back(material: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let sensors = render(folder.path(), &sample(material, "sample.csv"));
    let path = folder.path().join("sample.csv");
    let text = std::fs::read_to_string(&path).expect("a table");
    let brdf = material.parse::<Material>().expect("a material");
    let brdf = brdf.prepare(Bands::Wavelengths(&[560.0])).expect("a model");
    // A lit cell's flux is f ∫cosθ dω of the beam: 262 144 packets, each of which goes on with about its full flux.
    let (mut squares, mut cells) = (0.0, 0);
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,wavelength_nm,value,standard_error"));
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|f| f.parse().expect("a number")).collect();
        let [theta_i, _, theta, phi, _, value, error] = row[..] else { panic!("{line}") };
        let expected = mean(brdf.as_ref(), theta_i, theta, phi);
        let square = |deg: f64| deg.to_radians().sin().powi(2);
        let share = if theta == 0.0 { 1.0 } else { 1.0 / 12.0 };
        let packets = 262_144.0 * expected * PI * share * (square(theta + 5.0) - square((theta - 5.0).max(0.0)));
        // Few packets do not scatter as Gauss says.
        if packets < 100.0 {
            assert!(value * packets / expected < packets + 6.0 * packets.sqrt() + 6.0, "{line}, expected {expected}");
            continue;
        }
        let off = (value - expected) / error;
        assert!(off.abs() < 5.5, "{line}, expected {expected}");
        squares += off * off;
        cells += 1;
    }
    // Bands go along with one another: as many independent cells as there are pairs of directions. t² of 31 degrees of freedom has
    // the mean 31/29; four standard deviations of the mean of 100 or more.
    let mean = squares / f64::from(cells);
    assert!(cells > 400 && (0.5..1.7).contains(&mean), "{mean} of {cells}");
    let table = csv::parse(text.as_bytes()).expect("it is a table").value;
    assert!(table.is_isotropic());
    photopic().args(["brdf", "info"]).arg(&path).assert().success().stdout(contains("isotropic"));
    assert!(number(&sensors[0]["value"]) > 0.0);
}

#[test]
fn a_diffuse_sample_gives_itself_back() {
    gives_itself_back("lambert(reflectance=0.5)");
}

#[test]
fn a_rough_metal_gives_itself_back() {
    gives_itself_back("ggx(alpha=0.4, eta=1.5, k=3)");
}

/// A MERL table holds every cell in its bin, and nothing where the instrument did not look. Errors are those of a second instrument of the
/// same kind, which writes a CSV file.
#[test]
fn a_merl_table_holds_the_cells_and_nothing_between() {
    for material in ["lambert(reflectance=0.5)", "ggx(alpha=0.4, eta=1.5, k=3)"] {
        let folder = tempfile::tempdir().expect("a folder");
        let scene = sample(material, "sample.csv");
        let instrument = scene.rfind("[[sensor]]").expect("a sensor");
        let second = scene[instrument..].replace("sample.csv", "sample.binary").replace("\"sample\"", "\"again\"");
        std::fs::write(folder.path().join("scene.toml"), format!("{scene}{second}")).expect("a scene");
        let output = photopic().current_dir(folder.path()).args(["render", "scene.toml"]).output().expect("it runs");
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success() && told.contains("R008"), "{told}");
        let bytes = std::fs::read(folder.path().join("sample.binary")).expect("a table");
        let table = merl::parse(&bytes).expect("it is a table").value;
        let brdf = material.parse::<Material>().expect("a material");
        let brdf = brdf.prepare(Bands::Wavelengths(&[560.0])).expect("a model");
        let text = std::fs::read_to_string(folder.path().join("sample.csv")).expect("a table");
        let (mut squares, mut cells, mut places) = (0.0, 0, std::collections::HashSet::new());
        for line in text.lines().skip(1) {
            let row: Vec<f64> = line.split(',').map(|f| f.parse().expect("a number")).collect();
            let [theta_i, _, theta, phi, _, value, error] = row[..] else { panic!("{line}") };
            let (incident, outgoing) = (from_degrees(theta_i, 0.0), from_degrees(theta, phi));
            places.insert(table.bin_of(incident, outgoing));
            // Along the normal all azimuths are in one bin, with those of the same path the other way.
            if theta_i == 0.0 || theta == 0.0 {
                continue;
            }
            let read = table.nearest(incident, outgoing);
            assert!(read[0] == read[1] && read[1] == read[2], "a grey sample: {read:?}");
            let expected = mean(brdf.as_ref(), theta_i, theta, phi);
            // A cell of few packets has no error to speak of; its value is a few packets' worth.
            if error < 0.2 * value {
                let off = (f64::from(read[0]) - expected) / error;
                assert!(off.abs() < 5.5, "{line}: {read:?}, expected {expected}");
                squares += off * off;
                cells += 1;
            }
        }
        // t² of 31 degrees of freedom: 31/29 ± 1.59; four standard deviations of the mean of 50.
        let mean = squares / f64::from(cells);
        assert!(cells >= 50 && (0.17..1.97).contains(&mean), "{mean} of {cells}");
        let (bins, missing) = table.coverage();
        assert_eq!(bins - missing, places.len());
    }
}

/// White walls of a groove send everything back, however often it was reflected.
#[test]
fn a_white_groove_loses_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let sensors = render(
        folder.path(),
        r#"
[render]
meter_samples = 8192
[[material]]
name = "white"
reflectance = 1
[[shape]]
material = "white"
rectangle = { corner = [0, -100, 0], edges = [[1, 0, 1], [0, 200, 0]] }
[[shape]]
material = "white"
rectangle = { corner = [-1, -100, 1], edges = [[1, 0, -1], [0, 200, 0]] }
[[sensor]]
name = "groove"
gonioreflectometer = { at = [0, 0, 1], radius = "90 cm", theta_i = ["20 deg"], phi_i = ["90 deg"] }
"#,
    );
    let (value, error) = (number(&sensors[0]["value"]), number(&sensors[0]["standard_error"]));
    assert!((value - 1.0).abs() < 1e-12 && error < 1e-12, "{value} ± {error}");
}
