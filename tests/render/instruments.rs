//! Instruments around a scene and on a plane: goniophotometer, integrating sphere, light map.

use std::f64::consts::PI;
use std::path::Path;

use assert_cmd::Command;
use photopic::luminaire::Luminaire;
use photopic::luminaire::format::{ReadOptions, read};
use predicates::str::contains;
use serde_json::Value;

use crate::common::shared;

pub(crate) fn photopic() -> Command {
    Command::cargo_bin("photopic").expect("the binary")
}

/// Renders a scene in a folder, files and all.
pub(crate) fn render(folder: &Path, scene: &str) -> Value {
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene is written");
    let mut command = photopic();
    let output = command.current_dir(folder).args(["render", "scene.toml", "--json"]).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let out: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    out["results"][0]["sensors"].clone()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn lamp(path: &Path) -> Luminaire {
    let bytes = std::fs::read(path).expect("a lamp file");
    read(&bytes, &ReadOptions { format: None, repair: false }).expect("it is read").value
}

/// No plane like another, light above and below, and no symmetry.
const MADE: &str = "IESNA:LM-63-2002\r\n[TEST] made\r\nTILT=NONE\r\n1 -1 1 5 5 1 2 0 0 0\r\n1 1 0\r\n0 45 90 135 180\r\n\
0 90 180 270 360\r\n100 200 300 150 50\r\n100 400 120 80 50\r\n100 90 60 30 50\r\n100 250 700 20 50\r\n100 200 300 150 50\r\n";

/// Turns of a lamp, degrees: `rotation` about the vertical, `tilt` that lifts its axis towards C0, `spin` about its own axis.
const TURNS: [[f64; 3]; 5] = [[0.0; 3], [90.0, 0.0, 0.0], [0.0, 90.0, 0.0], [0.0, 70.0, 90.0], [35.0, 50.0, -100.0]];

/// The direction in the lamp's frame of a direction in the room: the turns of docs/scenes.md undone one after the other.
fn undone([rotation, tilt, spin]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let about_z = |degrees: f64, [x, y, z]: [f64; 3]| {
        let (s, c) = degrees.to_radians().sin_cos();
        [c * x - s * y, s * x + c * y, z]
    };
    let [x, y, z] = about_z(-rotation, [x, y, z]);
    // The lifted axis is (sin, 0, −cos) and stands for −z, the lifted C0 is (cos, 0, sin) and stands for +x.
    let (s, c) = tilt.to_radians().sin_cos();
    about_z(-spin, [c * x + s * z, y, -(s * x - c * z)])
}

/// A lamp gives back the file that it came from, in whatever way it is turned.
fn gives_back(path: &Path, c_step: f64, gamma_step: f64) {
    let folder = tempfile::tempdir().expect("a folder");
    let extension = path.extension().and_then(|e| e.to_str()).expect("an extension").to_lowercase();
    std::fs::copy(path, folder.path().join(format!("in.{extension}"))).expect("a copy");
    let before = lamp(path);
    let (peak, flux) = (before.distribution.peak().0, before.distribution.total_flux());
    for turn in TURNS {
        let [rotation, tilt, spin] = turn;
        let sensors = render(
            folder.path(),
            &format!(
                r#"
[render]
meter_samples = 8192
[[light]]
lamp = {{ file = "in.{extension}", at = [1, -2, 3], rotation = "{rotation} deg", tilt = "{tilt} deg", spin = "{spin} deg" }}
spectrum = "LED-B3"
[[sensor]]
name = "out"
goniophotometer = {{ c_step = "{c_step} deg", gamma_step = "{gamma_step} deg", file = "out.{extension}" }}
"#
            ),
        );
        let after = lamp(&folder.path().join(format!("out.{extension}"))).distribution;
        // Only the last digits that the file's writer keeps, 5e-7 of the peak in EULUMDAT, are lost; and the error of the sums over
        // wavelength cancels, because a lamp's spectrum is scaled to its candela.
        let allowed = 2e-6 * peak;
        for c in (0..).map(|i| f64::from(i) * c_step).take_while(|c| *c < 360.0) {
            for gamma in (0..).map(|i| f64::from(i) * gamma_step).take_while(|g| *g <= 180.0) {
                let ((sc, cc), (s, k)) = (c.to_radians().sin_cos(), gamma.to_radians().sin_cos());
                let [x, y, z] = undone(turn, [s * cc, s * sc, -k]);
                let own = (y.atan2(x).to_degrees(), x.hypot(y).atan2(-z).to_degrees());
                // Where the planes of a file do not agree about a pole, it has no one value there.
                let is_pole = own.1 < 1e-4 || own.1 > 180.0 - 1e-4;
                let of = |plane: &f64| before.distribution.at(*plane, own.1);
                let planes = before.distribution.horizontal_deg();
                if is_pole && planes.iter().any(|p| (of(p) - of(&planes[0])).abs() > allowed) {
                    continue;
                }
                let (expected, got) = (before.distribution.at(own.0, own.1), after.at(c, gamma));
                let name = path.display();
                assert!(
                    (got - expected).abs() < allowed,
                    "{name} {turn:?} C {c} γ {gamma}: {got}, expected {expected}"
                );
            }
        }
        let (got, error) = (number(&sensors[0]["value"]), number(&sensors[0]["standard_error"]));
        assert!((got - flux).abs() <= 3.0 * error + 1e-9 * flux, "{turn:?}: {got} ± {error} lm, expected {flux}");
        assert_eq!(sensors[0]["unit"], "lm");
        let (told, written) = (number(&sensors[0]["intensity"]["table_flux_lm"]), after.total_flux());
        assert!((told - written).abs() < 4.0 * PI * allowed, "{turn:?}: {told} lm, {written} in the file");
    }
}

#[test]
fn a_made_lamp_gives_back_its_file_in_any_turn() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("made.ies");
    std::fs::write(&path, MADE).expect("a lamp is written");
    // On the file's own grid, and on a finer one.
    gives_back(&path, 90.0, 45.0);
    gives_back(&path, 30.0, 10.0);
}

#[test]
fn real_lamps_give_back_their_files_in_any_turn() {
    for file in [
        "echowuzangye+CU-calculations-based-on-IES-file/ies/3.IES",
        "dlippok+photometric-viewer/tests/data/photometrics/ldt/no_symmetry.ldt",
    ] {
        let Some(path) = shared(&format!("luminaires/files/{file}")) else { return };
        gives_back(&path, 15.0, 5.0);
    }
}

/// Behind a ball of glass of index 1, which changes nothing, all light is scattered light: the cells hold the means of the table.
#[test]
fn light_through_a_ball_is_sorted_into_its_cells() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("made.ies"), MADE).expect("a lamp is written");
    let sensors = render(
        folder.path(),
        r#"
[[material]]
name = "air"
dielectric = { index = 1 }
[[shape]]
material = "air"
sphere = { centre = [0, 0, 0], radius = "0.3 m" }
[[light]]
lamp = { file = "made.ies", at = [0, 0, 0], tilt = "50 deg", spin = "-100 deg" }
[[sensor]]
name = "out"
goniophotometer = { c_step = "30 deg", gamma_step = "15 deg" }
"#,
    );
    let measured = &sensors[0]["intensity"];
    let (values, errors) = (numbers(&measured["values"]), numbers(&measured["standard_errors"]));
    assert_eq!(values, numbers(&measured["scattered"]), "nothing goes straight");
    let table = lamp(&folder.path().join("made.ies")).distribution;
    let in_room = |c: f64, gamma: f64| {
        let ((sc, cc), (s, k)) = (c.to_radians().sin_cos(), gamma.to_radians().sin_cos());
        let [x, y, z] = undone([0.0, 50.0, -100.0], [s * cc, s * sc, -k]);
        table.at(y.atan2(x).to_degrees(), x.hypot(y).atan2(-z).to_degrees())
    };
    let rows = 13;
    let mut squares = 0.0;
    for (index, (value, error)) in values.iter().zip(&errors).enumerate() {
        let (c, gamma) = ((index / rows) as f64 * 30.0, (index % rows) as f64 * 15.0);
        // The mean over the cell's solid angle; at the poles over the whole cap.
        let (low, high) = ((gamma - 7.5).max(0.0), (gamma + 7.5).min(180.0));
        let half = if gamma == 0.0 || gamma == 180.0 { 180.0 } else { 15.0 };
        let (mut sum, mut weight) = (0.0, 0.0);
        for i in 0..60 {
            let g = low + (high - low) * (f64::from(i) + 0.5) / 60.0;
            let sine = g.to_radians().sin();
            for j in 0..120 {
                sum += sine * in_room(c - half + 2.0 * half * (f64::from(j) + 0.5) / 120.0, g);
                weight += sine;
            }
        }
        let off = (value - sum / weight) / error;
        // Student's t of 31 degrees of freedom beyond 5.5 has a probability of 5e-6, for 156 cells below 1e-3.
        assert!(off.abs() < 5.5, "C {c} γ {gamma}: {value} ± {error}, expected {}", sum / weight);
        squares += off * off;
    }
    // Mean square of t with 31 degrees of freedom: 31/29, of 133 independent cells ± 4 · √(2/133).
    let mean = squares / values.len() as f64;
    assert!((0.55..1.6).contains(&mean), "{mean}");
}

/// A diffuse disk of 1000 cd/m² and 0.01 m²: I = L A cosγ below it, nothing above, Φ = π A L.
#[test]
fn a_diffuse_disk_shines_by_the_cosine() {
    let folder = tempfile::tempdir().expect("a folder");
    let radius = (0.01 / PI).sqrt();
    let sensors = render(
        folder.path(),
        &format!(
            r#"
[[shape]]
disk = {{ centre = [5, 0, 1], normal = [1, 0, 0], radius = "{radius} m" }}
emission = {{ radiance = "1000 cd/m2", spectrum = "A" }}
[[sensor]]
name = "turned"
goniophotometer = {{ down = [1, 0, 0], c0 = [0, 0, 1], c_step = "90 deg", gamma_step = "10 deg" }}
"#
        ),
    );
    let measured = &sensors[0]["intensity"];
    for (index, value) in numbers(&measured["values"]).into_iter().enumerate() {
        let expected = 10.0 * (10.0 * (index % 19) as f64).to_radians().cos().max(0.0);
        assert!((value - expected).abs() < 1e-9, "{index}: {value}, expected {expected}");
    }
    let flux = number(&sensors[0]["value"]);
    assert!((flux - PI * 10.0).abs() < 1e-9, "{flux}");
}

/// A lamp over a disk of reflectance ρ: the disk takes 1 − ρ of the share ½ (1 − h/√(h² + R²)) of the flux that meets it.
#[test]
fn an_integrating_sphere_reads_what_leaves() {
    let folder = tempfile::tempdir().expect("a folder");
    let sensors = render(
        folder.path(),
        r#"
[[material]]
name = "grey"
reflectance = 0.3
[[shape]]
material = "grey"
disk = { centre = [0, 0, 0], normal = [0, 0, 1], radius = "1 m" }
[[light]]
point = { at = [0, 0, 0.5], flux = "800 lm" }
spectrum = "A"
[[sensor]]
name = "sphere"
spectrum = true
integrating_sphere = {}
"#,
    );
    let sphere = &sensors[0];
    let share = 0.5 * (1.0 - 0.5 / 1.25_f64.sqrt());
    let expected = 800.0 * (1.0 - 0.7 * share);
    let (value, error) = (number(&sphere["value"]), number(&sphere["standard_error"]));
    assert!((value - expected).abs() <= 3.0 * error, "{value} ± {error}, expected {expected}");
    assert!(error < 1e-3 * value, "{error}");
    assert_eq!((sphere["unit"].as_str(), sphere["radiant"]["unit"].as_str()), (Some("lm"), Some("W")));
    assert_eq!(sphere["quantity"], "luminous flux");
    let cct = number(&sphere["spectrum"]["cct_k"]);
    assert!((cct - 2856.0).abs() < 15.0, "{cct}");
}

/// E = I h/(h² + r²)^1.5 at every point of the table; map and table are written where they are named.
#[test]
fn a_light_map_is_drawn_and_tabulated() {
    let folder = tempfile::tempdir().expect("a folder");
    let sensors = render(
        folder.path(),
        r#"
[render]
meter_samples = 64
[[shape]]
name = "table"
rectangle = { corner = [-2, -1, 0.75], edges = [[4, 0, 0], [0, 2, 0]] }
[[light]]
point = { at = [0.5, 0, 2.75], intensity = "1000 cd" }
[[sensor]]
name = "table"
illuminance = { grid = { on = "table", points = [40, 20], isolux = "map.png", csv = "map.csv" } }
[[sensor]]
name = "upright"
illuminance = { grid = { corner = [-2, 3, 0], edges = [[4, 0, 0], [0, 0, 3]], points = [8, 6], isolux = "map.svg" } }
"#,
    );
    let table = std::fs::read_to_string(folder.path().join("map.csv")).expect("a table");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("x_m,y_m,z_m,illuminance_lx,standard_error_lx"));
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(',').map(|f| f.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.len(), 800);
    for row in &rows {
        let expected = 1000.0 * 2.0 / (4.0 + (row[0] - 0.5).powi(2) + row[1].powi(2)).powf(1.5);
        assert!((row[3] - expected).abs() < 1e-9 * expected && row[2] == 0.75, "{row:?}, expected {expected}");
    }
    assert_eq!((rows[0][0], rows[0][1], rows[1][1]), (-1.95, -0.95, -0.95), "along the first edge first");
    assert_eq!(numbers(&sensors[0]["grid"]["size_m"]), [4.0, 2.0]);
    assert!(std::fs::read(folder.path().join("map.png")).expect("a map").starts_with(b"\x89PNG"));
    let drawing = std::fs::read_to_string(folder.path().join("map.svg")).expect("a map");
    assert!(drawing.contains("lx") && drawing.contains("upright"), "unit and title");
}

#[test]
fn what_cannot_be_measured_is_refused_where_it_stands() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    let light = "[[light]]\npoint = { at = [0, 0, 2], intensity = \"1 cd\" }\n[[sensor]]\nname = \"s\"\n";
    let sky = light.replace("[[sensor]]", "[[light]]\nsky = { type = 16, horizontal = \"1 lx\" }\n[[sensor]]");
    for (before, sensor, place, words) in [
        (light, "goniophotometer = { file = \"a.xml\" }", ":5:19:", "ends in .ies or .ldt"),
        (light, "goniophotometer = { c_step = \"7 deg\" }", ":5:19:", "divides 360 deg"),
        (light, "goniophotometer = { gamma_step = \"0.01 deg\" }", ":5:19:", "from 0.1 to 90 deg"),
        (light, "goniophotometer = { down = [1, 0, 0], c0 = [2, 0, 0] }", ":5:19:", "two directions"),
        (light, "goniophotometer = { step = 1 }", ":5:21:", "unknown field `step`"),
        (light, "goniophotometer = {}\ntarget = \"1 %\"", ":6:10:", "expected `meter_samples`"),
        (light, "integrating_sphere = { of = 1 }", ":5:24:", "unknown field `of`"),
        (&sky, "integrating_sphere = {}", ":7:22:", "light 2 shines from outside"),
        (
            light,
            "illuminance = { grid = { on = \"x\", points = [2, 2] } }",
            ":5:31:",
            "no rectangle, sphere or cylinder is called `x`",
        ),
        (light, "illuminance = { grid = { points = [2, 2] } }", ":5:15:", "without one place"),
        (
            light,
            "illuminance = { grid = { corner = [0, 0, 0], edges = [[1, 0, 0], [1, 1, 0]], points = [2, 2], isolux = \"a.png\" } }",
            ":5:15:",
            "right angles",
        ),
    ] {
        std::fs::write(&path, format!("{before}{sensor}\n")).expect("a scene is written");
        let refused = photopic().arg("render").arg(&path).assert().code(2);
        refused.stderr(contains(place)).stderr(contains(words));
    }
    std::fs::write(&path, format!("{light}goniophotometer = {{}}\n")).expect("a scene is written");
    let state = folder.path().join("state");
    let refused = photopic().arg("render").arg(&path).arg("--checkpoint").arg(&state).assert().code(2);
    refused.stderr(contains("a state is kept only for meters and pictures"));
}

/// Parallel light of E₀ on a column and on a ball: E₀ cosθ where the surface faces it, at the places that the table says.
#[test]
fn light_maps_go_around_columns_and_balls() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
[render]
meter_samples = 64
[[shape]]
name = "column"
cylinder = { from = [0, 0, 0], to = [0, 0, 1], radius = "0.25 m", closed = true }
[[shape]]
name = "ball"
sphere = { centre = [0, 3, 0], radius = "0.5 m" }
[[light]]
distant = { from = [1, 0, 0], irradiance = "1000 lx" }
[[sensor]]
name = "column"
illuminance = { grid = { on = "column", points = [12, 3], isolux = "column.svg", csv = "column.csv" } }
[[sensor]]
name = "ball"
illuminance = { grid = { on = "ball", points = [10, 6], isolux = "ball.png", csv = "ball.csv" } }
"#;
    let sensors = render(folder.path(), text);
    for (name, centre, radius, points, size) in
        [("column", [0.0, 0.0], 0.25, 36, [2.0 * PI * 0.25, 1.0]), ("ball", [0.0, 3.0], 0.5, 60, [PI, 1.0])]
    {
        let table = std::fs::read_to_string(folder.path().join(format!("{name}.csv"))).expect("a table");
        let mut count = 0;
        for line in table.lines().skip(1) {
            let row: Vec<f64> = line.split(',').map(|f| f.parse().expect("a number")).collect();
            let [x, y, z, value, _] = row[..] else { panic!("{line}") };
            let (dx, dy) = (x - centre[0], y - centre[1]);
            let from_axis = if name == "ball" { dx.hypot(dy).hypot(z) } else { dx.hypot(dy) };
            assert!((from_axis - radius).abs() < 1e-12, "{line}");
            let expected = 1000.0 * (dx / radius).max(0.0);
            assert!((value - expected).abs() < 1e-9 * 1000.0, "{line}, expected {expected}");
            count += 1;
        }
        assert_eq!(count, points);
        let sensor = sensors.as_array().expect("sensors").iter().find(|s| s["name"] == name).expect("the sensor");
        let told = numbers(&sensor["grid"]["size_m"]);
        assert!((told[0] - size[0]).abs() < 1e-12 && (told[1] - size[1]).abs() < 1e-12, "{told:?}");
    }
    assert!(folder.path().join("column.svg").exists() && folder.path().join("ball.png").exists());
}

/// A lamp on the floor that shines down, a spot that looks away and a lamp behind the meter's back light nothing: they are left out, and named;
/// with `--model full` they are there, and the reading is the same.
#[test]
fn lights_that_reach_nothing_are_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
[[material]]
name = "grey"
reflectance = 0.5
[[shape]]
name = "floor"
material = "grey"
rectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }
[[shape]]
name = "away"
emission = { radiance = "100 cd/m2" }
rectangle = { corner = [-1, -1, 3], edges = [[2, 0, 0], [0, 2, 0]] }
[[shape]]
name = "down"
emission = { radiance = "100 cd/m2" }
rectangle = { corner = [-0.5, -0.5, 2.5], edges = [[0, 1, 0], [1, 0, 0]] }
[[light]]
name = "sky beam"
spot = { at = [0, 0, 4], aim = [0, 0, 9], intensity = "1000 cd", half_angle = "30 deg" }
[[light]]
name = "lamp"
point = { at = [0, 0, 2], flux = "100 lm" }
[[sensor]]
name = "floor"
illuminance = { at = [0.2, 0, 0] }
"#;
    std::fs::write(folder.path().join("scene.toml"), text).expect("a scene");
    let run = |extent: &str| {
        let mut command = photopic();
        command.current_dir(folder.path()).args(["render", "scene.toml", "--json", "--packets", "0"]);
        let output = command.args(["--meter-samples", "8192", "--model", extent]).output().expect("it runs");
        let out: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        out["results"][0].clone()
    };
    let (minimal, full) = (run("minimal"), run("full"));
    assert_eq!(minimal["model"]["lights"]["out_of_reach"], serde_json::json!(["sky beam", "away"]));
    assert_eq!(full["model"]["lights"]["out_of_reach"], serde_json::json!([]));
    let [a, b] = [&minimal, &full].map(|out| &out["sensors"][0]);
    let error = number(&a["standard_error"]).hypot(number(&b["standard_error"]));
    let difference = number(&a["value"]) - number(&b["value"]);
    // The choice of wavelengths is good to 0.001.
    assert!(difference.abs() < 4.5 * error + 1e-3 * number(&b["value"]), "{a} {b}");
    // Seen by a camera from above, the lamp that faces away matters.
    let above = "[[sensor]]\nname = \"view\"\ncamera = { at = [0, 0, 5], look_at = [0, 0, 0], up = [0, 1, 0], resolution = [2, 2] }\n";
    std::fs::write(folder.path().join("scene.toml"), format!("{text}{above}")).expect("a scene");
    assert_eq!(run("minimal")["model"]["lights"]["out_of_reach"], serde_json::json!([]));
}
