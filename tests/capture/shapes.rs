//! Other shapes than spheres: pictures of a cylinder, a plane and meshes of a known material, made here with geometry worked out in another
//! way than the library does, and the material comes back.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::fs;
use std::path::Path;

use glam::{DMat3, DVec3};
use photopic::brdf::Brdf;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::fit::{Options, Uncertainty, fit};
use photopic::capture::Manifest;
use photopic::capture::brdf::{Counts, Limits, Observations, Scene};
use photopic::capture::radiance::Radiance;
use photopic::capture::setup::Place;
use photopic::math::random::Stream;
use tiff::encoder::{TiffEncoder, colortype};

use crate::cli::{json, run};

const SIDE: u32 = 120;
const FOCAL: f64 = 240.0;
const NOISE: f64 = 0.01;
const MATERIAL: &str = "phong(kd=0.3, ks=0.2, n=30)";
const TRUTH: [f64; 3] = [0.3, 0.2, 30.0];

/// At the origin, looking along +z, y downwards.
pub(crate) const CAMERA: &str =
    "[camera]\nfx = 240.0\nfy = 240.0\ncx = 59.5\ncy = 59.5\nplaces_per_side = 1\n[radiance]\nrelative_error = 0.01\n";

fn material() -> Box<dyn Brdf> {
    MATERIAL.parse::<Material>().expect("a material").prepare(Bands::Channels(1)).expect("one channel")
}

fn ray(x: f64, y: f64) -> DVec3 {
    DVec3::new((x - 59.5) / FOCAL, (y - 59.5) / FOCAL, 1.0).normalize()
}

/// Radiance towards the origin of a point under a light of strength 1.
fn radiance(brdf: &dyn Brdf, point: DVec3, n: DVec3, light: Place) -> f64 {
    let t = n.cross(DVec3::new(0.3, 0.5, 0.8)).normalize();
    let local = |d: DVec3| DVec3::new(t.dot(d), n.cross(t).dot(d), n.dot(d));
    let (to_light, distance2) = match light {
        Place::Near(p) => (DVec3::from_array(p) - point, (DVec3::from_array(p) - point).length_squared()),
        Place::Distant(d) => (DVec3::from_array(d), 1.0),
    };
    let (i, o) = (local(to_light.normalize()), local(-point.normalize()));
    let mut f = [0.0];
    brdf.evaluate(i, o, &mut f);
    f[0] * i.z.max(0.0) / distance2
}

/// Pictures of a surface, given by where a ray from the origin meets it and the normal there, measured by the library.
fn measure(
    manifest: &str,
    lights: &[Place],
    surface: impl Fn(DVec3) -> Option<(DVec3, DVec3)>,
) -> (Observations, Counts) {
    let scene = Scene::new(&Manifest::parse(manifest).expect("a manifest"), Limits::default()).expect("a scene");
    let brdf = material();
    let (mut all, mut last) = (Observations::new(1), Counts::default());
    for (n, light) in lights.iter().enumerate() {
        let mut random = Stream::new(1954, n as u64);
        let mut sample = |i: u32| {
            let met = surface(ray(f64::from(i % SIDE), f64::from(i / SIDE)));
            // A sum of twelve uniform numbers: nearly normal, of variance 1.
            let normal = (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
            let exact = met.map_or(0.0, |(point, n)| radiance(brdf.as_ref(), point, n, *light));
            (exact * (1.0 + NOISE * normal)) as f32
        };
        let values: Vec<f32> = (0..SIDE * SIDE).map(&mut sample).collect();
        let side = SIDE as usize;
        let picture =
            Radiance { width: side, height: side, channels: 1, time_s: 1.0, values, errors: None, states: None };
        last = scene.observe(&picture, *light, &[1.0], None, &mut |s| all.push(s)).expect("measured");
    }
    (all, last)
}

/// Every measurement is the material's value but for noise, and so are the parameters of a fit.
fn is_the_material(all: &Observations) {
    let brdf = material();
    let mut f = [0.0];
    let (mut worst, mut squares) = (0.0_f64, 0.0);
    for ((i, o), value) in all.directions.iter().zip(&all.values) {
        brdf.evaluate(*i, *o, &mut f);
        let off = value / f[0] - 1.0;
        worst = worst.max(off.abs());
        squares += off * off;
    }
    // Of 10⁴ normal deviates none is beyond 6σ; their rms is known to 1/√(2n).
    let rms = (squares / all.len() as f64).sqrt();
    assert!(worst < 6.0 * NOISE && (rms / NOISE - 1.0).abs() < 0.05, "{worst} {rms}");
    let found = fit(&"phong".parse().expect("a template"), &all.samples(0.0).expect("samples"), &Options::default());
    for (estimate, truth) in found.expect("a fit").estimates.iter().zip(TRUTH) {
        let Uncertainty::Known { standard, robust } = estimate.uncertainty else { panic!("{estimate:?}") };
        let error = standard.max(robust);
        assert!((estimate.value - truth).abs() < 3.0 * error && error < 0.02 * truth, "{estimate:?}, expected {truth}");
    }
}

#[test]
fn a_cylinder_gives_its_material() {
    let (centre, axis, radius, length) = (DVec3::new(0.1, -0.05, 3.0), DVec3::new(0.3, 1.0, 0.2), 0.4, 0.9);
    let manifest = format!(
        "{CAMERA}[cylinder]\ncentre_m = {:?}\naxis = {:?}\nradius_m = {radius}\nlength_m = {length}\n",
        centre.to_array(),
        axis.to_array()
    );
    let lights = [
        Place::Near([0.5, -0.8, 0.3]),
        Place::Near([-1.5, 0.2, 1.2]),
        Place::Near([1.8, 0.5, 2.6]),
        Place::Distant([-0.4, -0.3, -1.0]),
    ];
    // In the frame of the cylinder, its axis along z: x² + y² = r².
    let up = axis.normalize();
    let side = up.cross(DVec3::Z).normalize();
    let to_own = DMat3::from_cols(side, up.cross(side), up).transpose();
    let surface = |ray: DVec3| {
        let (o, d) = (to_own * -centre, to_own * ray);
        let (a, b, c) = (d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y, o.x * o.x + o.y * o.y - radius * radius);
        let root = b * b - a * c;
        let t = (-b - root.sqrt()) / a;
        let p = o + t * d;
        (root > 0.0 && p.z.abs() <= length / 2.0)
            .then(|| (t * ray, to_own.transpose() * DVec3::new(p.x / radius, p.y / radius, 0.0)))
    };
    let (all, counts) = measure(&manifest, &lights, surface);
    is_the_material(&all);
    // The ends and the sides of its picture are not measured, nor is it in its own shadow.
    assert!(counts.silhouette > 50 && counts.cast_shadow == 0 && counts.inter_reflection == 0, "{counts:?}");
    assert_eq!(counts.named().iter().map(|(_, n)| n).sum::<usize>(), (SIDE * SIDE) as usize);
}

#[test]
fn a_plane_gives_its_material() {
    let (centre, normal) = (DVec3::new(0.05, 0.1, 1.5), DVec3::new(0.4, -0.3, -1.0).normalize());
    let manifest = format!(
        "{CAMERA}[plane]\ncentre_m = {:?}\nnormal = {:?}\nup = [0.0, -1.0, 0.0]\nsize_m = [0.6, 0.4]\n",
        centre.to_array(),
        normal.to_array()
    );
    let lights = [
        Place::Near([0.5, -0.4, 0.9]),
        Place::Near([0.9, -0.2, 1.1]),
        Place::Near([0.1, -0.9, 0.8]),
        Place::Near([-0.5, -0.5, 0.9]),
        Place::Distant([0.4, 0.3, -1.0]),
    ];
    // In the plane's own coordinates by Cramer's rule: centre + u a + v b = t ray.
    let a = DVec3::new(0.0, -1.0, 0.0).cross(normal).normalize();
    let b = normal.cross(a);
    let surface = |ray: DVec3| {
        let whole = DMat3::from_cols(a, b, -ray).determinant();
        let solve = |m: DMat3| m.determinant() / whole;
        let u = solve(DMat3::from_cols(-centre, b, -ray));
        let v = solve(DMat3::from_cols(a, -centre, -ray));
        (u.abs() <= 0.3 && v.abs() <= 0.2).then(|| (centre + u * a + v * b, normal))
    };
    let (all, counts) = measure(&manifest, &lights, surface);
    is_the_material(&all);
    assert!(counts.valid > 1000 && counts.silhouette > 50 && counts.attached_shadow == 0, "{counts:?}");
}

/// A picture of what is in front of the camera, as a linear TIFF of 16 bits.
pub(crate) fn photograph(path: &Path, pixel: impl Fn(DVec3) -> f64) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65535")]
    let sample = |i: u32| (65535.0 * pixel(ray(f64::from(i % SIDE), f64::from(i / SIDE)))).round() as u16;
    let samples: Vec<u16> = (0..SIDE * SIDE).map(sample).collect();
    assert!(samples.iter().all(|s| *s < u16::MAX), "overexposed");
    let mut file = fs::File::create(path).expect("a file");
    let mut encoder = TiffEncoder::new(&mut file).expect("a TIFF");
    encoder.write_image::<colortype::Gray16>(SIDE, SIDE, &samples).expect("written");
}

/// Where a ray first meets one of the triangles, and the normal there towards the ray's origin; by the volumes of tetrahedra.
fn first(triangles: &[[DVec3; 3]], origin: DVec3, ray: DVec3) -> Option<(f64, DVec3)> {
    let mut nearest: Option<(f64, DVec3)> = None;
    for [a, b, c] in triangles.iter().map(|t| t.map(|p| p - origin)) {
        let volumes = [b.cross(c).dot(ray), c.cross(a).dot(ray), a.cross(b).dot(ray)];
        let inside = volumes.iter().all(|v| *v > 0.0) || volumes.iter().all(|v| *v < 0.0);
        let normal = (b - a).cross(c - a).normalize();
        let t = a.dot(normal) / ray.dot(normal);
        if inside && t > 1e-9 && nearest.is_none_or(|n| t < n.0) {
            nearest = Some((t, if normal.dot(ray) > 0.0 { -normal } else { normal }));
        }
    }
    nearest
}

/// A plate and a ball of facets before it, in millimetres, as triangles and as an OBJ file.
fn plate_and_ball() -> (Vec<[DVec3; 3]>, String) {
    let mut points = vec![(-400, -400), (400, -400), (400, 400), (-400, 400)]
        .into_iter()
        .map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), 0.0))
        .collect::<Vec<_>>();
    let mut faces = vec![[0, 1, 2], [0, 2, 3]];
    let (rings, around) = (7, 12);
    let on_ball = |ring: usize, n: usize| {
        let (theta, phi) = (PI * ring as f64 / rings as f64, TAU * n as f64 / around as f64);
        DVec3::new(60.0, -40.0, 220.0)
            + 130.0 * DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
    };
    for ring in 0..rings {
        for n in 0..around {
            let first = points.len();
            points.extend([on_ball(ring, n), on_ball(ring + 1, n), on_ball(ring + 1, n + 1), on_ball(ring, n + 1)]);
            faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    let mut obj = String::new();
    points.iter().for_each(|p| writeln!(obj, "v {:?} {:?} {:?}", p.x, p.y, p.z).expect("a string"));
    // The corners of some faces run the other way round: nothing hangs on it.
    for (n, [a, b, c]) in faces.iter().enumerate() {
        let (a, c) = if n % 3 == 0 { (c, a) } else { (a, c) };
        writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).expect("a string");
    }
    (faces.iter().map(|f| f.map(|i| points[i])).collect(), obj)
}

#[test]
fn a_mesh_in_its_pose_gives_its_material_and_masks_its_own_shadow() {
    let folder = tempfile::tempdir().expect("a folder");
    let (own, obj) = plate_and_ball();
    fs::write(folder.path().join("object.obj"), obj).expect("written");
    // Rodrigues' formula: v cosα + (k × v) sinα + k (k · v)(1 − cosα).
    let (turn, position) = (DVec3::new(2.5, 0.3, -0.4), DVec3::new(-0.03, 0.02, 2.2));
    let (alpha, k) = (turn.length(), turn.normalize());
    let pose = |p: DVec3| {
        let v = p / 1000.0;
        v * alpha.cos() + k.cross(v) * alpha.sin() + k * k.dot(v) * (1.0 - alpha.cos()) + position
    };
    let triangles: Vec<[DVec3; 3]> = own.iter().map(|t| t.map(pose)).collect();
    let lights = [[0.4, -0.5, 0.4], [-0.6, -0.3, 1.0], [0.2, 0.6, 0.2], [0.9, 0.4, 0.9]].map(Place::Near);
    let brdf = material();
    let mut manifest =
        CAMERA.replace("relative_error = 0.01\n", "absolute_error = 4.4e-6\nunit_w_per_m2_sr = 1.0\ndark = 1e-4\n");
    write!(
        manifest,
        "[mesh]\nfile = \"object.obj\"\nunit_m = 0.001\nrotation_rad = {:?}\nposition_m = {:?}\nflat = true\n",
        turn.to_array(),
        position.to_array()
    )
    .expect("a string");
    let mut hidden = 0;
    for (n, light) in lights.iter().enumerate() {
        let Place::Near(p) = *light else { continue };
        let shadow = std::cell::Cell::new(0);
        photograph(&folder.path().join(format!("{n}.tif")), |ray| {
            let Some((t, normal)) = first(&triangles, DVec3::ZERO, ray) else { return 0.0 };
            let point = t * ray;
            let to_light = DVec3::from_array(p) - point;
            let blocked = first(&triangles, point + 1e-7 * normal, to_light.normalize());
            if blocked.is_some_and(|(t, _)| t < to_light.length()) {
                shadow.set(shadow.get() + u32::from(normal.dot(to_light) > 0.2 * to_light.length()));
                return 0.0;
            }
            // Strength 2.
            2.0 * radiance(brdf.as_ref(), point, normal, *light)
        });
        hidden += shadow.get();
        write!(
            manifest,
            "[[light]]\nname = \"{n}\"\nposition_m = {p:?}\nintensity_w_per_sr = 2.0\n\
             [[stack]]\nname = \"{n}\"\nexposures = [{{ photo = \"{n}.tif\" }}]\n"
        )
        .expect("a string");
    }
    fs::write(folder.path().join("capture.toml"), manifest).expect("a manifest");
    let (code, out, error) = run(
        folder.path(),
        &[
            "brdf",
            "capture.toml",
            "-m",
            "phong",
            "--resolution",
            "30x30x36",
            "--json",
            "--report",
            "mesh.html",
            "--measurements",
            "all.csv",
        ],
    );
    assert_eq!(code, 0, "{error}");
    let result = &json(&out)["results"][0];
    assert_eq!(result["object"], "mesh");
    let count = |key: &str| result["pixels"][key].as_u64().expect("a count");
    assert!(
        count("valid") > 5_000 && count("silhouette") > 1000 && count("inter_reflection") > 500,
        "{}",
        result["pixels"]
    );
    // All of the shadow that falls on it is masked, or was for another reason.
    assert!(u64::from(hidden) > 1000 && count("cast_shadow") > u64::from(hidden) / 2, "{hidden} {}", result["pixels"]);
    // Directions and values of every measurement: rounding to 1/65535 is half of that at most, over the irradiance.
    let table = fs::read_to_string(folder.path().join("all.csv")).expect("measurements");
    let mut off = 0;
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [ti, to, phi, value, sigma] = [3, 4, 5, 6, 7].map(|i: usize| cells[i].parse::<f64>().expect("a number"));
        let direction = |theta: f64, phi: f64| {
            let (t, p) = (theta.to_radians(), phi.to_radians());
            DVec3::new(t.sin() * p.cos(), t.sin() * p.sin(), t.cos())
        };
        let mut f = [0.0];
        brdf.evaluate(direction(ti, 0.0), direction(to, phi), &mut f);
        // σ is 4.4e-6 over the irradiance.
        off += usize::from((value - f[0]).abs() > sigma / 4.4e-6 * (0.5 / 65535.0) * 1.001);
    }
    assert_eq!(off, 0, "of {}", table.lines().count());
    for (parameter, truth) in result["fits"][0]["parameters"].as_array().expect("parameters").iter().zip(TRUTH) {
        let [value, error] = ["value", "standard_error"].map(|k| parameter[k].as_f64().expect("a number"));
        assert!((value - truth).abs() < 3.0 * error && error < 1e-3 * truth, "{parameter}, expected {truth}");
    }
    let page = fs::read_to_string(folder.path().join("mesh.html")).expect("a report");
    assert!(page.contains("measurements of the BRDF of a mesh from 4 photograph(s)") && page.contains("cast shadow"));
}

/// A ball of radius 1 m at the place of that of the other tests, in fine triangles.
fn fine_ball() -> String {
    let (rings, around) = (90, 180);
    let mut obj = String::new();
    for ring in 0..=rings {
        for n in 0..around {
            let (theta, phi) = (PI * f64::from(ring) / f64::from(rings), TAU * f64::from(n) / f64::from(around));
            let p = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            writeln!(obj, "v {} {} {}", p.x, p.y, p.z).expect("a string");
        }
    }
    for ring in 0..rings {
        for n in 0..around {
            let at = |r: u32, n: u32| r * around + n % around + 1;
            let [a, b, c, d] = [at(ring, n), at(ring + 1, n), at(ring + 1, n + 1), at(ring, n + 1)];
            writeln!(obj, "f {a} {b} {c} {d}").expect("a string");
        }
    }
    obj
}

#[test]
fn a_fine_mesh_of_a_ball_is_as_good_as_the_ball() {
    let folder = crate::spheres::spheres(&crate::spheres::LIGHTS);
    fs::write(folder.path().join("ball.obj"), fine_ball()).expect("written");
    let manifest = fs::read_to_string(folder.path().join("capture.toml")).expect("a manifest");
    let sphere = "[sphere]\ncentre_m = [0.0, 0.0, 10.0]\nradius_m = 1.0\n";
    assert!(manifest.contains(sphere));
    let mesh = manifest.replace(sphere, "[mesh]\nfile = \"ball.obj\"\nposition_m = [0.0, 0.0, 10.0]\n");
    fs::write(folder.path().join("mesh.toml"), mesh).expect("a manifest");
    let (code, out, error) = run(folder.path(), &["brdf", "mesh.toml", "-m", "lambert", "--json"]);
    assert_eq!(code, 0, "{error}");
    let result = &json(&out)["results"][0];
    // Edges of 2°: what lies inside of the sphere by (2°)²/8 = 1.5·10⁻⁴ of the radius has its normal off by as much at most.
    let found = result["fits"][0]["parameters"][0]["value"].as_f64().expect("a reflectance");
    assert!((found - 0.5).abs() < 0.5 * 3e-4, "{found}");
    assert_eq!((&result["pixels"]["cast_shadow"], &result["pixels"]["inter_reflection"]), (&0.into(), &0.into()));
}

#[test]
fn objects_that_cannot_be_say_so() {
    let folder = crate::spheres::spheres(&crate::spheres::LIGHTS[..1]);
    let manifest = fs::read_to_string(folder.path().join("capture.toml")).expect("a manifest");
    let sphere = "[sphere]\ncentre_m = [0.0, 0.0, 10.0]\nradius_m = 1.0\n";
    let plane = "[plane]\ncentre_m = [0.0, 0.0, 10.0]\nnormal = [0.0, 0.0, -1.0]\n";
    fs::write(folder.path().join("empty.obj"), "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n").expect("written");
    fs::write(folder.path().join("wrong.obj"), "v 0 0 0\nf 1 2 3\n").expect("written");
    for (object, words) in [
        (format!("{sphere}{plane}"), "found more than one of [sphere], [cylinder], [plane] and [mesh]"),
        (
            String::new(),
            "found no [sphere] in the manifest; expected [camera], [sphere] (or [cylinder], [plane], [mesh])",
        ),
        (plane.replace("-1.0]", "1.0]"), "behind the plane"),
        (
            "[cylinder]\ncentre_m = [0, 0, 1]\naxis = [0, 1, 0]\nradius_m = 2\nlength_m = 1\n".to_owned(),
            "inside of the cylinder",
        ),
        (
            "[cylinder]\ncentre_m = [0, 0, 5]\naxis = [0, 0, 0]\nradius_m = 2\nlength_m = 1\n".to_owned(),
            "expected a direction of some length",
        ),
        ("[mesh]\nfile = \"missing.obj\"\n".to_owned(), "missing.obj: cannot be read"),
        ("[mesh]\nfile = \"0.tif\"\n".to_owned(), "expected a mesh whose name ends in .obj or .ply"),
        ("[mesh]\nfile = \"empty.obj\"\n".to_owned(), "empty.obj: found no triangle with an area"),
        ("[mesh]\nfile = \"wrong.obj\"\n".to_owned(), "wrong.obj:2:"),
    ] {
        fs::write(folder.path().join("x.toml"), manifest.replace(sphere, &object)).expect("written");
        let (code, out, error) = run(folder.path(), &["brdf", "x.toml", "-m", "lambert"]);
        assert!(code == 2 && out.is_empty() && error.contains(words), "{object}: {error}");
        assert_eq!(error.trim_end().lines().count(), 1, "{error}");
    }
    // What is beside the picture's object is told.
    let aside = manifest.replace("centre_m = [0.0, 0.0, 10.0]", "centre_m = [9.0, 0.0, 10.0]");
    fs::write(folder.path().join("x.toml"), aside).expect("written");
    let (code, _, error) = run(folder.path(), &["brdf", "x.toml", "-m", "lambert"]);
    assert!(code == 2 && error.contains("no ray of the camera meets the object"), "{error}");
}
