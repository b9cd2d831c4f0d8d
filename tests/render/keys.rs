//! What a scene can say, key by key: each gives what its closed form says, and what is wrong with it is told.

use predicates::str::contains;

use crate::cli::{json, photopic, scene};

/// A mesh with a sliver and a corner that is none: both are left out with a word, once for all shapes that name the file.
#[test]
fn triangles_that_are_left_out_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let obj = "o kite\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 2 0 1\nv nan 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n";
    std::fs::write(folder.path().join("kite.obj"), obj).expect("written");
    let text = r#"
[[shape]]
mesh = { file = "kite.obj" }
[[shape]]
mesh = { file = "kite.obj", flat = true, transform = [{ translate = [5, 0, 0] }] }
[[shape]]
mesh = { file = "kite.obj", transform = [{ translate = [9, 0, 0] }] }
[[light]]
distant = { from = [0, 0, 1], irradiance = "500 lx" }
[[sensor]]
name = "below"
illuminance = { grid = { corner = [0, 0, 0], edges = [[15, 0, 0], [0, 0.6, 0]], points = [15, 1] } }
"#;
    let path = scene(&folder, text);
    for more in [&["--check"][..], &["--meter-samples", "32"]] {
        let out = json(photopic().arg("render").arg(&path).arg("--json").args(more));
        let findings = out["findings"].as_array().expect("findings");
        assert_eq!(findings.len(), 1, "{findings:?}");
        let (code, message) = (findings[0]["code"].as_str(), findings[0]["message"].as_str().expect("a message"));
        assert_eq!(code, Some("R003"));
        assert!(message.starts_with("2 of 3 triangles of `kite`") && message.ends_with("triangle 2"), "{message}");
        assert!(message.contains("kite.obj"), "{message}");
        // The place in the scene that asks for the file first.
        let place = &findings[0]["location"];
        assert!(place["path"].as_str().is_some_and(|p| p.ends_with("scene.toml")), "{place}");
        assert_eq!((place["line"].as_u64(), place["column"].as_u64()), (Some(3), Some(8)));
    }
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "32"]));
    let row = &out["results"][0]["sensors"][0]["grid"]["values"][0];
    // The middles of the cells, (n + ½, 0.3): under the three kites alone it is dark.
    for n in 0..15 {
        let expected = if [0, 5, 9].contains(&n) { 0.0 } else { 500.0 };
        assert!((row[n].as_f64().expect("a number") - expected).abs() < 1e-9, "{n}: {}", row[n]);
    }
    photopic().arg("render").arg(&path).args(["--meter-samples", "32"]).assert().success().stderr(contains("R003"));
}

/// The readings of a scene's sensors and their standard errors, in order.
fn readings(folder: &tempfile::TempDir, text: &str, samples: &str) -> Vec<(f64, f64)> {
    let out = json(photopic().arg("render").arg(scene(folder, text)).args(["--json", "--meter-samples", samples]));
    let number = |v: &serde_json::Value| v.as_f64().expect("a number");
    let sensors = out["results"][0]["sensors"].as_array().expect("sensors");
    sensors.iter().map(|s| (number(&s["value"]), number(&s["standard_error"]))).collect()
}

fn refuses(folder: &tempfile::TempDir, text: &str, message: &str) {
    photopic().arg("render").arg(scene(folder, text)).arg("--check").assert().code(2).stderr(contains(message));
}

/// Rows of red, green and blue.
fn picture(folder: &tempfile::TempDir, name: &str, rows: &[&[[u8; 3]]]) {
    let mut image = image::RgbImage::new(rows[0].len() as u32, rows.len() as u32);
    for (y, row) in rows.iter().enumerate() {
        row.iter().enumerate().for_each(|(x, p)| image.put_pixel(x as u32, y as u32, image::Rgb(*p)));
    }
    image.save(folder.path().join(name)).expect("written");
}

const UP: &str = "[[sensor]]\nname = \"up\"\nilluminance = { at = [0, 0, 0] }\n";
const WHITE: [u8; 3] = [255; 3];
const BLACK: [u8; 3] = [0; 3];

/// A square of side 2 one metre above gives E = L 4 s atan(s), s = 1/√2; a triangle that is half of it, half of that; a plane without
/// bounds has no flux and is refused.
#[test]
fn a_triangle_and_a_polyhedron_shine() {
    let folder = tempfile::tempdir().expect("a folder");
    let s = 0.5_f64.sqrt();
    let whole = 1000.0 * 4.0 * s * s.atan();
    let polyhedron = "polyhedron = { vertices = [[-1,-1,1], [1,-1,1], [1,1,1], [-1,1,1], [-1,-1,2], [1,-1,2], [1,1,2], [-1,1,2]], \
        faces = [[0,3,2,1], [4,5,6,7], [0,1,5,4], [1,2,6,5], [2,3,7,6], [3,0,4,7]] }";
    for (shape, expected) in
        [(polyhedron, whole), ("triangle = { corners = [[-1,-1,1], [1,1,1], [1,-1,1]] }", 0.5 * whole)]
    {
        let text = format!("[[shape]]\nemission = {{ radiance = \"1000 cd/m2\" }}\n{shape}\n{UP}");
        let (value, error) = readings(&folder, &text, "65536")[0];
        assert!(
            error < 2e-3 * expected && (value - expected).abs() < 3.0 * error.max(1e-9 * expected),
            "{shape}: {value} ± {error}, {expected}"
        );
    }
    let turned = polyhedron.replace("[0,3,2,1]", "[0,1,2,3]");
    refuses(&folder, &format!("[[shape]]\n{turned}\n{UP}"), ":2:14: ");
    refuses(&folder, &format!("[[shape]]\ntriangle = {{ corners = [[0,0,0], [1,0,0], [2,0,0]] }}\n{UP}"), ":2:12: ");
    let plane = "[[shape]]\nplane = { point = [0,0,3], normal = [0,0,-1] }\nemission = { radiance = \"1 cd/m2\" }\n";
    refuses(
        &folder,
        &format!("{plane}{UP}"),
        ":3:12: a plane without bounds that emits; expected a shape of finite area",
    );
}

/// The production light, control by control, two metres above the meter: I = 100 cd is 25 lx but for the factor of the control.
#[test]
fn a_production_light_has_all_its_controls() {
    let folder = tempfile::tempdir().expect("a folder");
    picture(&folder, "half.png", &[&[WHITE, BLACK], &[WHITE, BLACK]]);
    // R. Barzel's controlled falloff within r₀ = 4 m at half of it: M exp(−ln M (1/2)^(n/ln M)) with M = e, n = 2: e^(1 − 1/4), over r₀².
    let controlled = 100.0 * 0.75_f64.exp() / 16.0;
    for (controls, expected) in [
        ("intensity = \"100 cd\"", 25.0),
        // A half space: Φ = 2π I.
        ("flux = \"628.3185307179587 lm\"", 25.0),
        ("intensity = \"100 cd\", falloff = { exponent = 0, reference = \"1 m\" }", 100.0),
        ("intensity = \"100 cd\", falloff = { exponent = 1, reference = \"4 m\" }", 12.5),
        (
            "intensity = \"100 cd\", falloff = { exponent = 2, reference = \"4 m\", most = 2.718281828459045 }",
            controlled,
        ),
        (
            "intensity = \"100 cd\", blockers = [{ depth = \"50 cm\", outline = { inner = [0.1, 0.1] }, opacity = 0.25 }]",
            18.75,
        ),
        (
            "intensity = \"100 cd\", blockers = [{ depth = \"1 m\", middle = [0.5, 0], outline = { inner = [0.1, 0.1], roundness = 1 } }]",
            25.0,
        ),
        ("intensity = \"100 cd\", clip = { far = \"1.5 m\" }", 0.0),
        // Half way up the rise, a smooth step of ½.
        ("intensity = \"100 cd\", clip = { near = \"3 m\", near_edge = \"2 m\" }", 12.5),
        ("intensity = \"100 cd\", shape = { inner = [0.1, 0.1], outer = [0.2, 0.2], roundness = 1 }", 25.0),
        ("intensity = \"100 cd\", shape = { inner = [0.1, 0.1] }, shear = [0.3, 0]", 0.0),
        ("intensity = \"100 cd\", noise = { frequency = 0, amplitude = 0.5 }", 18.75),
    ] {
        let text =
            format!("[[light]]\nbarzel = {{ at = [0, 0, 2], aim = [0, 0, 0], up = [0, 1, 0], {controls} }}\n{UP}");
        let (value, _) = readings(&folder, &text, "32")[0];
        // The flux is a quadrature to 1e-6.
        assert!((value - expected).abs() < 2e-6 * 25.0, "{controls}: {value}, expected {expected}");
    }
    // Looking down with +y up, x is on the right: a slide whose left half is white lights what is at −x.
    let text = "[[light]]\nbarzel = { at = [0, 0, 2], aim = [0, 0, 0], up = [0, 1, 0], intensity = \"100 cd\", slide = { file = \"half.png\", half = [0.5, 0.5] } }\n\
        [[sensor]]\nname = \"a\"\nilluminance = { at = [0.6, 0, 0] }\n[[sensor]]\nname = \"b\"\nilluminance = { at = [-0.6, 0, 0] }\n";
    let found = readings(&folder, text, "32");
    let beside = 100.0 * 2.0 / (4.0_f64 + 0.36).powf(1.5);
    assert!(found[0].0.abs() < 1e-9 && (found[1].0 - beside).abs() < 1e-3 * beside, "{found:?} {beside}");
    let bad = "[[light]]\nbarzel = { at = [0, 0, 2], aim = [0, 0, 0], up = [0, 1, 0], intensity = \"100 cd\", WHAT }\n";
    for (what, message) in [
        ("falloff = { exponent = 11 }", "an exponent of the falloff of 11; expected 0 to 10"),
        ("flux = \"1 lm\"", "both `flux` and `intensity`; expected one of them"),
        ("slide = { file = \"none.png\", half = [1, 1] }", "none.png"),
        ("beam = 3", ":2:83: unknown field `beam`"),
    ] {
        refuses(&folder, &format!("{}{UP}", bad.replace("WHAT", what)), message);
    }
}

/// A picture whose upper half is white makes E = π L on a meter that faces up, none on one that faces down and half of it on one that
/// stands upright; turned on its side it lights that side. Its white has the luminance stated, whatever its spectrum.
#[test]
fn surroundings_are_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    picture(&folder, "sky.png", &[&[WHITE, WHITE], &[BLACK, BLACK]]);
    let meters = "[[sensor]]\nname = \"up\"\nilluminance = { at = [0, 0, 0] }\n[[sensor]]\nname = \"down\"\nilluminance = { at = [0, 0, 0], normal = [0, 0, -1] }\n\
        [[sensor]]\nname = \"x\"\nilluminance = { at = [0, 0, 0], normal = [1, 0, 0] }\n[[sensor]]\nname = \"y\"\nilluminance = { at = [0, 0, 0], normal = [0, 1, 0] }\n";
    let pi = std::f64::consts::PI;
    let check = |keys: &str, expected: [f64; 4]| {
        let text = format!("[[light]]\nenvironment = {{ radiance = \"100 cd/m2\", {keys} }}\n{meters}");
        for ((value, error), expected) in readings(&folder, &text, "65536").into_iter().zip(expected) {
            assert!((value - 100.0 * expected).abs() < 4.0 * error + 1e-9, "{keys}: {value} ± {error}, {expected}");
        }
    };
    check("file = \"sky.png\"", [pi, 0.0, 0.5 * pi, 0.5 * pi]);
    check("file = \"sky.png\", look = [0, 0, -1], up = [1, 0, 0]", [0.5 * pi, 0.5 * pi, pi, 0.5 * pi]);
    // The left half of a picture that looks along +x is +y.
    picture(&folder, "left.png", &[&[WHITE, BLACK], &[WHITE, BLACK]]);
    check("file = \"left.png\"", [0.5 * pi, 0.5 * pi, 0.5 * pi, pi]);
    check("file = \"left.png\", projection = \"mirror-ball\"", [0.5 * pi, 0.5 * pi, 0.5 * pi, pi]);
    // A fisheye of the hemisphere before the camera, of which the left half is white.
    check("file = \"left.png\", projection = \"fisheye\"", [0.25 * pi, 0.25 * pi, 0.5 * pi, 0.5 * pi]);
    for (keys, message) in [
        ("file = \"sky.png\"", "without a `radiance`"),
        ("", "neither `radiance` nor `file`"),
        ("radiance = \"1 nit\", up = [0, 1, 0]", "expected a picture"),
        ("radiance = \"1 nit\", file = \"sky.png\", up = [1, 0, 0]", "a `look` along `up`"),
        ("radiance = \"1 nit\", file = \"sky.png\", field_of_view = \"90 deg\"", "only of a fisheye"),
        ("radiance = \"1 nit\", file = \"scene.toml\"", "scene.toml"),
        ("radiance = \"1 nit\", file = \"sky.png\", projection = \"cube\"", "unknown variant `cube`"),
    ] {
        refuses(&folder, &format!("[[light]]\nenvironment = {{ {keys} }}\n{meters}"), message);
    }
}

/// What a camera saw all around is the light of another scene: the spectral picture carries its own unit.
#[test]
fn a_spectral_picture_lights_as_what_it_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let steps = "[render]\nwavelength_step_nm = 10\nsamples = 4\n";
    let text = format!(
        "{steps}[[light]]\nenvironment = {{ radiance = \"100 cd/m2\" }}\nspectrum = \"A\"\n\
         [[sensor]]\nname = \"around\"\ncamera = {{ at = [0, 0, 0], look_at = [1, 0, 0], projection = \"equirectangular\", resolution = [8, 4], exr = \"around.exr\" }}\n"
    );
    let path = scene(&folder, &text);
    photopic().arg("render").arg(&path).arg("--folder").arg(folder.path()).assert().success();
    let text = format!("{steps}[[light]]\nenvironment = {{ file = \"around.exr\" }}\n{UP}");
    let (value, error) = readings(&folder, &text, "65536")[0];
    let expected = 100.0 * std::f64::consts::PI;
    // Pixels are f32.
    assert!((value - expected).abs() < 4.0 * error + 1e-6 * expected, "{value} ± {error}");
    refuses(
        &folder,
        &format!("[[light]]\nenvironment = {{ file = \"around.exr\", radiance = \"1 nit\" }}\n{UP}"),
        "beside a spectral picture",
    );
    let textured = "[[material]]\nname = \"m\"\nreflectance = 1\ntexture = { file = \"around.exr\" }\n";
    refuses(&folder, &format!("{textured}{UP}"), "expected one of reflectances");
}

/// Four pixels on a wall under 1000 lx: L = ρ E/π in the middle of each, the first row above, u to the right along the first edge. Red of
/// sRGB reflects 0.2126 of D65 (IEC 61966-2-1).
#[test]
fn textures_are_reflectances() {
    let folder = tempfile::tempdir().expect("a folder");
    picture(&folder, "four.png", &[&[WHITE, [255, 0, 0]], &[[188; 3], [0, 255, 0]]]);
    let text = "[[material]]\nname = \"wall\"\nreflectance = 0.5\ntexture = { file = \"four.png\" }\n\
        [[shape]]\nmaterial = \"wall\"\nrectangle = { corner = [0, 0, 0], edges = [[1, 0, 0], [0, 1, 0]] }\n\
        [[light]]\ndistant = { from = [0, 0, 1], irradiance = \"1000 lx\" }\nspectrum = \"D65\"\n";
    // The curve of IEC 61966-2-1.
    let grey = ((188.0_f64 / 255.0 + 0.055) / 1.055).powf(2.4);
    let places = [(0.25, 0.75, 1.0), (0.75, 0.75, 0.2126), (0.25, 0.25, grey), (0.75, 0.25, 0.7152)];
    let meters = |places: &[(f64, f64, f64)]| -> String {
        let one = |(x, y, _): &(f64, f64, f64)| {
            format!(
                "[[sensor]]\nname = \"{x} {y}\"\nluminance = {{ at = [{x}, {y}, 1], look_at = [{x}, {y}, 0], acceptance = \"0.0001 deg\" }}\n"
            )
        };
        places.iter().map(one).collect()
    };
    let found = readings(&folder, &format!("{text}{}", meters(&places)), "32");
    for ((value, _), (x, y, factor)) in found.into_iter().zip(places) {
        let expected = 0.5 * factor * 1000.0 / std::f64::consts::PI;
        // The standard's four digits, the wavelengths' 1e-3 and what is seen beside the middle of the pixel.
        assert!((value - expected).abs() < 5e-4 * expected.max(1.0) + 1e-3 * expected, "{x} {y}: {value} {expected}");
    }
    // Twice along u: the four pixels stand on each half.
    let twice = text.replace("\"four.png\"", "\"four.png\", repeat = [2, 1]");
    let white = [(0.125, 0.75, 1.0), (0.625, 0.75, 1.0)];
    for (value, _) in readings(&folder, &format!("{twice}{}", meters(&white)), "32") {
        assert!((value - 500.0 / std::f64::consts::PI).abs() < 0.1, "{value}");
    }
    refuses(&folder, &format!("{}{UP}", text.replace("four.png", "none.png")), "none.png");
    refuses(
        &folder,
        &format!("{}{UP}", text.replace("\"four.png\"", "\"four.png\", repeat = [0, 1]")),
        ":4:11: a `repeat` of 0",
    );
}

/// The panel's opening of its file, from far away a point, close by less: E of a diffuse disk or square falls off slower than 1/r².
#[test]
fn a_lamp_shines_from_its_opening() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/lamps/panel.ldt");
    let read = |height: f64, more: &str| {
        let text = format!("[[light]]\nlamp = {{ file = \"{file}\", at = [0, 0, {height}]{more} }}\n{UP}");
        readings(&folder, &text, "65536")[0]
    };
    let (far, point) = (read(1e4, ", opening = true"), read(1e4, ""));
    // The panel is 0.6 m wide: γ up to 4.3e-5, over which a table of 5° steps that is linear in angle falls by no more than a few
    // per cent per radian (cos 5° = 0.9962).
    assert!((far.0 / point.0 - 1.0).abs() < 3e-6, "{far:?} {point:?}");
    let (near, point) = (read(0.3, ", opening = true"), read(0.3, ""));
    assert!(near.0 + 5.0 * near.1 < 0.8 * point.0, "{near:?} {point:?}");
}

/// A panel that is seen lights as the same lamp with its opening does, close by and far away, states the file's flux (3597.71 lm by its
/// exact integral) and has the luminance I/A of its file along its axis (1145.92 cd on 0.36 m²).
#[test]
fn a_surface_shines_as_a_lamp_file_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/lamps/panel.ldt");
    let panel = format!(
        "[[shape]]\nname = \"panel\"\nemission = {{ lamp = {{ file = \"{file}\" }} }}\nrectangle = {{ corner = [-0.3, -0.3, 2], edges = [[0, 0.6, 0], [0.6, 0, 0]] }}\n"
    );
    let lamp = format!("[[light]]\nlamp = {{ file = \"{file}\", at = [0, 0, 2], opening = true }}\n");
    let meters: String = [(0.0, 1.7), (0.5, 1.5), (1.0, 0.0)]
        .iter()
        .map(|(x, z)| format!("[[sensor]]\nname = \"{x} {z}\"\nilluminance = {{ at = [{x}, 0, {z}] }}\n"))
        .collect();
    let (seen, unseen) = (
        readings(&folder, &format!("{panel}{meters}"), "65536"),
        readings(&folder, &format!("{lamp}{meters}"), "65536"),
    );
    for (a, b) in seen.into_iter().zip(unseen) {
        let error = a.1.hypot(b.1);
        assert!((a.0 - b.0).abs() < 4.5 * error && error < 0.01 * a.0, "{a:?} {b:?}");
    }
    let spot = "[[sensor]]\nname = \"nits\"\nluminance = { at = [0, 0, 0], look_at = [0, 0, 2], acceptance = \"0.0001 deg\" }\n";
    let path = scene(&folder, &format!("{panel}{spot}"));
    let out = json(photopic().arg("render").arg(&path).args(["--json", "--meter-samples", "64"]));
    let result = &out["results"][0];
    let luminance = result["sensors"][0]["value"].as_f64().expect("a number");
    // The figures' printed digits.
    assert!((luminance / (1145.92 / 0.36) - 1.0).abs() < 1e-5, "{luminance}");
    let checked = json(photopic().arg("render").arg(&path).args(["--check", "--json"]));
    let flux = checked["results"][0]["lights"][0]["flux_lm"].as_f64().expect("a number");
    assert!((flux - 3597.71).abs() < 0.005, "{flux}");
    assert_eq!(out["findings"], serde_json::json!([]), "the packets carry that flux");
    let ball = panel.replace(
        "rectangle = { corner = [-0.3, -0.3, 2], edges = [[0, 0.6, 0], [0.6, 0, 0]] }",
        "sphere = { centre = [0, 0, 2], radius = \"1 m\" }",
    );
    refuses(&folder, &format!("{ball}{UP}"), ":3:12: `lamp` of a shape that is not flat");
    refuses(
        &folder,
        &format!("{}{UP}", panel.replace("} }\nrect", "}, radiance = \"1 nit\" }\nrect")),
        "beside another distribution",
    );
}

/// A glTF triangle, y upwards as the format has it, three metres above the meter and in its light.
#[test]
fn a_gltf_mesh_casts_its_shadow() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut bytes = Vec::new();
    for p in [[-1.0_f32, 3.0, -1.0], [3.0, 3.0, -1.0], [-1.0, 3.0, 3.0]] {
        p.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    }
    std::fs::write(folder.path().join("t.bin"), bytes).expect("written");
    let gltf = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"uri":"t.bin","byteLength":36}]}"#;
    std::fs::write(folder.path().join("t.gltf"), gltf).expect("written");
    let text = format!(
        "[[shape]]\nmesh = {{ file = \"t.gltf\" }}\n[[light]]\ndistant = {{ from = [0, 0, 1], irradiance = \"500 lx\" }}\n{UP}\
         [[sensor]]\nname = \"beside\"\nilluminance = {{ at = [0, 2, 0] }}\n"
    );
    let found = readings(&folder, &text, "32");
    // glTF's z from −1 to 3 is y from 1 to −3 here.
    assert!(found[0].0 == 0.0 && (found[1].0 - 500.0).abs() < 1e-9, "{found:?}");
    std::fs::write(folder.path().join("t.bin"), [0; 35]).expect("written");
    refuses(&folder, &text, "35 bytes of buffer 0; expected 36 of them");
}

/// A dyed floor under a laser of 440 nm, which it does not reflect: L = K_m/π Q a E_e λ/∫eλ dλ ∫V e dλ, from the photons that the dye takes and gives
/// back; the light meter beside it reads the laser alone, K_m V E_e. V from the embedded CIE table, e in its nanometres.
#[test]
fn a_dye_is_seen_in_the_light_that_it_gives() {
    use photopic::photometry::luminous::Efficiency;
    let v = Efficiency::default().weighting();
    let emission = |nm: f64| if nm < 530.0 { (nm - 500.0) / 30.0 } else { (580.0 - nm) / 50.0 };
    let (mut photons, mut luminous) = (0.0, 0.0);
    for nm in (501..580).map(f64::from) {
        photons += emission(nm) * nm;
        luminous += emission(nm) * v.at(nm);
    }
    // 100 lx of the laser.
    let expected = 100.0 / v.at(440.0) * 0.9 * 0.8 * 440.0 / photons * luminous / std::f64::consts::PI;
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
[render]
wavelength_step_nm = 1
[[material]]
name = "dyed"
dye = { reflectance = 0, absorption = 0.8, emission = [[500, 0], [530, 1], [580, 0]], quantum_yield = 0.9 }
[[shape]]
material = "dyed"
rectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }
[[light]]
distant = { from = [0, 0, 1], irradiance = "100 lx" }
spectrum = "line:440nm"
[[sensor]]
name = "dye"
luminance = { at = [0.5, 0, 1], look_at = [0, 0, 0], acceptance = "1 deg" }
"#;
    let (value, standard_error) = readings(&folder, text, "65536")[0];
    assert!(
        (value - expected).abs() <= 3.0 * standard_error && standard_error < 0.02 * value,
        "{value} ± {standard_error}, expected {expected}"
    );
}
