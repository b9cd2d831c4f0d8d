//! Closed spaces that keep all light: refused where nothing ends a path, rendered where a number of edges does.

use std::f64::consts::PI;

use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

use crate::cli::{json, photopic, scene};

const WHITE: &str = "[[material]]\nname = \"white\"\nreflectance = 1\n";
const INSIDE: &str = "[[sensor]]\nname = \"in\"\nilluminance = { at = [0, 0, 0.5] }\n";
const OUTSIDE: &str =
    "[[sensor]]\nname = \"out\"\ncamera = { at = [0, -9, 3], look_at = [0, 0, 0], resolution = [4, 4] }\n";
const LAMP: &str = "[[light]]\npoint = { at = [0.1, 0.2, 0], flux = \"1000 lm\" }\n";
const ROOM: &str =
    "[[shape]]\nname = \"room\"\nmaterial = \"white\"\nbox = { from = [-1, -1, -1], to = [1, 1, 1], inwards = true }\n";
const BALL: &str =
    "[[shape]]\nname = \"ball\"\nmaterial = \"white\"\nsphere = { centre = [0, 0, 0], radius = \"1 m\" }\n";

fn shape(material: &str, kind: &str) -> String {
    format!("[[shape]]\nmaterial = \"{material}\"\n{kind}\n")
}

fn rectangle(corner: [f64; 3], a: [f64; 3], b: [f64; 3]) -> String {
    shape("white", &format!("rectangle = {{ corner = {corner:?}, edges = [{a:?}, {b:?}] }}"))
}

/// A room of rectangles turned about z, the ceiling in two parts that meet in the middle of the walls' edges, `cut` of it left away.
fn turned(cut: f64) -> String {
    let (sin, cos) = 0.3_f64.sin_cos();
    let at = |x: f64, y: f64, z: f64| [x * cos - y * sin, x * sin + y * cos, z];
    let (x, y, z) = (at(2.0, 0.0, 0.0), at(0.0, 2.0, 0.0), [0.0, 0.0, 2.0]);
    let half = |length: f64| at(length, 0.0, 0.0);
    [
        rectangle(at(-1.0, -1.0, -1.0), x, y),
        rectangle(at(-1.0, -1.0, -1.0), z, x),
        rectangle(at(-1.0, -1.0, -1.0), y, z),
        rectangle(at(-1.0, 1.0, -1.0), x, z),
        rectangle(at(1.0, -1.0, -1.0), z, y),
        rectangle(at(-1.0, -1.0, 1.0), y, half(0.7)),
        rectangle(at(-0.3, -1.0, 1.0), y, half(1.3 - cut)),
    ]
    .concat()
}

#[test]
fn what_has_no_steady_state_is_refused_before_it_is_rendered() {
    let folder = tempfile::tempdir().expect("a folder");
    let refuses = |text: &str, message: &str| {
        let path = scene(&folder, text);
        for more in [&["--check"][..], &[]] {
            let told = contains("absorbs nothing").and(contains(message.to_owned()));
            photopic().arg("render").arg(&path).args(more).assert().code(2).stderr(told);
        }
    };
    let in_room = |more: &str| format!("{WHITE}{ROOM}{LAMP}{INSIDE}{more}");
    // At the material's name of the first wall.
    refuses(&in_room(""), "scene.toml:6:12: a space closed by `room` that absorbs nothing");
    refuses(&in_room(""), "expected a reflectance below 1, an opening, or `max_edges`");
    refuses(&format!("{WHITE}{}{LAMP}{INSIDE}", turned(0.0)), "`shape 1`, `shape 2`, `shape 3`, 4 more");
    refuses(&format!("{WHITE}{BALL}{LAMP}{INSIDE}"), "`ball`");
    // Glass, a white screen and a mirror take nothing away.
    let glass = "[[material]]\nname = \"glass\"\ndielectric = { medium = \"BK7\" }\n[[material]]\nname = \"mirror\"\nbrdf = \"mirror()\"\n";
    let within = [
        glass,
        &shape("glass", "sphere = { centre = [0.4, 0, 0], radius = \"0.2 m\" }"),
        &rectangle([-0.5, -0.5, -0.5], [0.3, 0.0, 0.0], [0.0, 0.0, 0.4]),
        &shape("mirror", "disk = { centre = [0, 0.5, 0], normal = [0, 1, 0], radius = \"0.2 m\" }"),
    ]
    .concat();
    refuses(&in_room(&within), "`room`");
    // A black floor that is nowhere in it does not help, nor does a wall that is black outside.
    let ground = "[[shape]]\nplane = { point = [0, 0, -1.5], normal = [0, 0, 1] }\n";
    refuses(&in_room(ground), "`room`");
    let one_sided = WHITE.replace("reflectance = 1", "reflectance = 1\none_sided = true");
    refuses(&format!("{one_sided}{ROOM}{LAMP}{INSIDE}"), "`room`");
    // Tubes: with its ends, or with disks for them.
    let tube = |closed: bool| {
        shape(
            "white",
            &format!("cylinder = {{ from = [0, 0, -1], to = [0, 0, 1], radius = \"1 m\", closed = {closed} }}"),
        )
    };
    refuses(&format!("{WHITE}{}{LAMP}{INSIDE}", tube(true)), "`shape 1`");
    let lid =
        |z: f64| shape("white", &format!("disk = {{ centre = [0, 0, {z}], normal = [0, 0, 1], radius = \"1 m\" }}"));
    refuses(
        &format!("{WHITE}{}{}{}{LAMP}{INSIDE}", tube(false), lid(-1.0), lid(1.0)),
        "`shape 1`, `shape 2`, `shape 3`",
    );
    // Only the lamp is within, only the meter; a wall that shines.
    refuses(&format!("{WHITE}{BALL}{LAMP}{OUTSIDE}"), "`ball`");
    refuses(&format!("{WHITE}{BALL}{INSIDE}"), "`ball`");
    let shines = ROOM.replace("box", "emission = { exitance = \"1 W/m2\" }\nbox");
    refuses(&format!("{WHITE}{shines}{INSIDE}"), "`room`");
    // Mirrors end no path of Whitted's.
    let whitted = "[render]\nsolver = \"whitted\"\n";
    let mirrors = "[[material]]\nname = \"white\"\nbrdf = \"mirror()\"\n";
    refuses(&format!("{whitted}{mirrors}{ROOM}{LAMP}{INSIDE}"), "`max_edges`");
    // What knows no number of edges.
    let edges = "[render]\nmax_edges = 5\n";
    let no_limit = contains("expected a reflectance below 1, an opening\n");
    let counts = "[[sensor]]\nname = \"all\"\nintegrating_sphere = {}\n";
    for text in [format!("{edges}solver = \"radiosity\"\n{}", in_room("")), format!("{edges}{}", in_room(counts))] {
        let path = scene(&folder, &text);
        photopic().arg("render").arg(path).arg("--check").assert().code(2).stderr(no_limit.clone());
    }
}

#[test]
fn what_ends_is_not_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let takes = |text: &str| {
        let path = scene(&folder, text);
        photopic().arg("render").arg(&path).arg("--check").assert().success();
    };
    let grey = WHITE.replace('1', "0.99999");
    takes(&format!("{grey}{ROOM}{LAMP}{INSIDE}"));
    takes(&format!("{WHITE}{}{LAMP}{INSIDE}", turned(1e-3)));
    // Something black within: a lamp without a material, a disk, a tube's wall of which a band is grey.
    let lamp = "[[shape]]\nemission = { flux = \"10 lm\" }\nrectangle = { corner = [0, 0, 0.9], edges = [[0, 0.1, 0], [0.1, 0, 0]] }\n";
    takes(&format!("{WHITE}{ROOM}{lamp}{INSIDE}"));
    // Black on the side that is within.
    let one_sided = WHITE.replace("reflectance = 1", "reflectance = 1\none_sided = true");
    takes(&format!("{one_sided}{BALL}{LAMP}{INSIDE}"));
    // The furnace: nothing is in the ball. A room that is looked at from outside.
    let sky = "[[light]]\nenvironment = { radiance = \"1 W/m2/sr/nm\" }\n";
    takes(&format!("{WHITE}{BALL}{sky}{OUTSIDE}"));
    takes(&format!("{WHITE}{ROOM}{sky}{OUTSIDE}"));
    // A tube without lids, and direct light alone.
    let tube = shape("white", "cylinder = { from = [0, 0, -1], to = [0, 0, 1], radius = \"1 m\" }");
    takes(&format!("{WHITE}{tube}{LAMP}{INSIDE}"));
    for solver in ["direct", "whitted", "preview"] {
        takes(&format!("[render]\nsolver = \"{solver}\"\n{WHITE}{ROOM}{LAMP}{INSIDE}"));
    }
}

/// With a lamp in its middle every order of reflection adds Φ/A to the wall of a sphere that absorbs nothing: m edges find m of them.
#[test]
fn a_number_of_edges_makes_it_finite() {
    let folder = tempfile::tempdir().expect("a folder");
    let lamp = LAMP.replace("0.1, 0.2, 0", "0, 0, 0");
    let wall = "[[sensor]]\nname = \"wall\"\nilluminance = { at = [0, 0, -0.999999], normal = [0, 0, 1] }\n";
    for solver in ["path", "bidirectional"] {
        let head = format!("[render]\nsolver = \"{solver}\"\nmax_edges = 5\nmeter_samples = 8192\n");
        let path = scene(&folder, &format!("{head}{WHITE}{BALL}{lamp}{wall}"));
        let out = json(photopic().arg("render").arg(path).arg("--json"));
        let sensor = &out["results"][0]["sensors"][0];
        let (value, error) = (sensor["value"].as_f64().expect("lx"), sensor["standard_error"].as_f64().expect("lx"));
        let expected = 5.0 * 1000.0 / (4.0 * PI);
        assert!((value - expected).abs() <= 4.0 * error + 1e-4 * expected, "{solver}: {value} ± {error}, {expected}");
        // What is left out has no end, so that nothing follows it.
        assert!(out["results"][0]["energy"].is_null(), "{out}");
        let findings = out["findings"].as_array().expect("findings");
        assert!(findings.iter().any(|f: &Value| f["code"] == "R009"), "{findings:?}");
    }
    // A picture, too.
    let camera = "[[sensor]]\nname = \"in\"\ncamera = { at = [0, 0, 0.2], look_at = [1, 0, 0], resolution = [8, 8] }\n";
    let path = scene(&folder, &format!("[render]\nmax_edges = 6\nsamples = 16\n{WHITE}{BALL}{lamp}{camera}"));
    photopic().arg("render").arg(path).arg("--folder").arg(folder.path()).assert().success();
}

/// A room of a mesh, and a block that stands on its floor: the bottom of one and the other in one place.
#[test]
fn rooms_of_meshes_close_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let corners: Vec<[i32; 3]> = (0..8).map(|i| [0, 1, 2].map(|bit| if i >> bit & 1 == 1 { 1 } else { -1 })).collect();
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mesh = |faces: &[[usize; 4]]| {
        let lines = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let faces = faces.iter().map(|f| format!("f {} {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1, f[3] + 1));
        lines.chain(faces).collect::<String>()
    };
    std::fs::write(folder.path().join("closed.obj"), mesh(&faces)).expect("written");
    std::fs::write(folder.path().join("open.obj"), mesh(&faces[..5])).expect("written");
    let block = shape("white", "box = { from = [-0.5, -0.5, -1], to = [0.2, 0.1, -0.4] }");
    let check = |file: &str| {
        let path = scene(
            &folder,
            &format!("{WHITE}{}{block}{LAMP}{INSIDE}", shape("white", &format!("mesh = {{ file = \"{file}\" }}"))),
        );
        photopic().arg("render").arg(path).arg("--check").assert()
    };
    check("closed.obj").code(2).stderr(contains("absorbs nothing"));
    check("open.obj").success();
}
