//! The BRDF of a sphere: known materials come back, from the library's own evaluation and from the synthetic pictures in `../shared`.

use std::f64::consts::PI;
use std::fs;

use glam::{DVec2, DVec3};
use photopic::brdf::Brdf;
use photopic::brdf::description::{Bands, Material};
use photopic::brdf::fit::{Fit, Options, Uncertainty, fit};
use photopic::brdf::table::Resolution;
use photopic::capture::Manifest;
use photopic::capture::brdf::{Limits, Observations, Scene, Seen, bin, reference_factor_sd, strength_from};
use photopic::capture::camera::Camera;
use photopic::capture::radiance::Radiance;
use photopic::capture::setup::{Place, Reference};
use photopic::geometry::direction::mirror;
use photopic::math::random::Stream;

use crate::common::shared;

const SIDE: usize = 96;

/// A camera looking along −x at a sphere that is not at the origin, through a lens.
const MANIFEST: &str = r#"
[camera]
fx = 420.0
fy = 415.0
cx = 47.0
cy = 48.5
distortion = [-0.05, 0.09, -0.0003, 0.002, 0.0]
position_m = [2.0, 0.1, 0.2]
forward = [-1.0, 0.0, 0.0]
up = [0.0, 0.0, 1.0]
places_per_side = 1
[sphere]
centre_m = [0.0, 0.1, 0.2]
radius_m = 0.2
[radiance]
relative_error = 0.01
"#;

const LIGHTS: [Place; 5] = [
    Place::Near([1.0, 0.4, 0.5]),
    Place::Near([0.3, -0.9, 0.2]),
    Place::Near([0.0, 0.3, 1.2]),
    Place::Distant([1.0, 0.2, -0.3]),
    Place::Distant([-0.3, 1.0, 0.6]),
];

const STRENGTH: [f64; 3] = [3.0, 2.0, 1.5];

fn scene(manifest: &str) -> Scene {
    Scene::new(&Manifest::parse(manifest).expect("a manifest"), Limits::default()).expect("a scene")
}

fn black() -> Radiance {
    let values = vec![0.0; SIDE * SIDE * 3];
    Radiance { width: SIDE, height: SIDE, channels: 3, time_s: 0.5, values, errors: None, states: None }
}

/// Radiance of the sphere of [`MANIFEST`] at a place of the picture; 0 beside it. Its geometry is worked out in another way than the library
/// does: in the sphere's frame, with the quadratic equation of ray and sphere, and f_r asked in a frame built by cross products.
fn radiance(brdf: &dyn Brdf, lens: &Camera, light: Place, pixel: DVec2) -> [f64; 3] {
    let (centre, radius, eye) = (DVec3::new(0.0, 0.1, 0.2), 0.2, DVec3::new(2.0, 0.1, 0.2));
    let d = lens.direction(pixel).expect("a mild lens");
    // Looking along −x with z up: x of the picture is +y of the world, y of the picture is −z.
    let ray = DVec3::new(-d.z, d.x, -d.y).normalize();
    let from = eye - centre;
    let (b, c) = (2.0 * from.dot(ray), from.length_squared() - radius * radius);
    let root = b * b - 4.0 * c;
    if root <= 0.0 {
        return [0.0; 3];
    }
    let point = from + ray * 0.5 * (-b - root.sqrt());
    let n = point / radius;
    let t = n.cross(DVec3::new(0.3, 0.5, 0.8)).normalize();
    let local = |d: DVec3| DVec3::new(t.dot(d), n.cross(t).dot(d), n.dot(d));
    let (to_light, distance2) = match light {
        Place::Near(p) => {
            let to_light = DVec3::from_array(p) - centre - point;
            (to_light, to_light.length_squared())
        }
        Place::Distant(d) => (DVec3::from_array(d), 1.0),
    };
    let (i, o) = (local(to_light.normalize()), local(-ray));
    let mut f = [0.0; 3];
    brdf.evaluate(i, o, &mut f);
    std::array::from_fn(|band| f[band] * STRENGTH[band] * i.z.max(0.0) / distance2)
}

/// A picture of it; a pixel is the mean over `grid`² places. `noise` is the relative standard deviation of its samples, and which noise it is.
fn photograph(material: &str, light: Place, grid: usize, (noise, seed): (f64, u64)) -> Radiance {
    let brdf = prepared(material);
    let lens = Manifest::parse(MANIFEST).expect("a manifest").camera.expect("a camera").lens().expect("intrinsics");
    let mut picture = black();
    for at in 0..SIDE * SIDE {
        let mut sum = [0.0; 3];
        for sub in 0..grid * grid {
            let offset = DVec2::new((sub % grid) as f64, (sub / grid) as f64) + 0.5;
            let pixel = DVec2::new((at % SIDE) as f64, (at / SIDE) as f64) + offset / grid as f64 - 0.5;
            let part = radiance(brdf.as_ref(), &lens, light, pixel);
            sum.iter_mut().zip(part).for_each(|(s, p)| *s += p / (grid * grid) as f64);
        }
        for (band, radiance) in sum.into_iter().enumerate() {
            let mut random = Stream::new(seed, (3 * at + band) as u64);
            // A sum of twelve uniform numbers: nearly normal, of variance 1.
            let normal = (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
            picture.values[3 * at + band] = (radiance * (1.0 + normal * noise) * picture.time_s) as f32;
        }
    }
    picture
}

fn prepared(material: &str) -> Box<dyn Brdf> {
    let material: Material = material.parse().expect("a material");
    material.prepare(Bands::Channels(3)).expect("three channels")
}

fn measure(material: &str, noise: f64) -> Observations {
    measured(material, noise, 2003)
}

/// The noise of every picture is another one.
fn measured(material: &str, noise: f64, seed: u64) -> Observations {
    let mut all = Observations::new(3);
    for (n, light) in LIGHTS.into_iter().enumerate() {
        let picture = photograph(material, light, 1, (noise, seed + n as u64));
        let counts = scene(MANIFEST).observe(&picture, light, &STRENGTH, None, &mut |s| all.push(s)).expect("measured");
        assert_eq!(counts.named().iter().map(|(_, n)| n).sum::<usize>(), SIDE * SIDE);
        assert!(counts.valid > 500 && counts.outside > 1000, "{counts:?}");
    }
    all
}

/// Estimate and standard error by number in the order of the open parameters.
fn estimates(fit: &Fit) -> Vec<(f64, f64)> {
    let known = |u| if let Uncertainty::Known { standard, robust } = u { f64::max(standard, robust) } else { f64::NAN };
    fit.estimates.iter().map(|e| (e.value, known(e.uncertainty))).collect()
}

#[test]
fn known_materials_come_back() {
    for text in [
        "lambert(reflectance=[0.2,0.5,0.7])",
        "phong(kd=[0.3,0.25,0.1], ks=[0.2,0.1,0.3], n=40)",
        "ward(kd=[0.1,0.2,0.3], ks=[0.3,0.2,0.1], alpha=0.2)",
        "lambert(reflectance=[0.2,0.3,0.4]) + ggx(alpha=0.3, f0=[0.1,0.05,0.04])",
    ] {
        let brdf = prepared(text);
        let all = measure(text, 0.0);
        let mut f = [0.0; 3];
        for ((i, o), values) in all.directions.iter().zip(all.values.chunks_exact(3)) {
            brdf.evaluate(*i, *o, &mut f);
            for (value, f) in values.iter().zip(f) {
                // Samples are single precision: half a unit of 2⁻²³; directions differ by rounding, which a lobe of n = 40 magnifies little.
                assert!((value / f - 1.0).abs() < 2_f64.powi(-24) + 1e-11, "{text} at {i}, {o}: {value} {f}");
            }
        }
    }
}

#[test]
fn what_a_pixel_averages_is_undone() {
    let text = "phong(kd=0.3, ks=0.2, n=40)";
    let (brdf, light) = (prepared(text), LIGHTS[0]);
    let picture = photograph(text, light, 8, (0.0, 0));
    let error = |manifest: &str| {
        let (mut all, mut f) = (Vec::new(), [0.0; 3]);
        let mut compare = |s: &Seen<'_>| {
            brdf.evaluate(s.incident, s.outgoing, &mut f);
            all.push((s.values[0] / f[0] - 1.0).abs());
        };
        scene(manifest).observe(&picture, light, &STRENGTH, None, &mut compare).expect("measured");
        median(all)
    };
    let (as_points, as_averages) = (error(MANIFEST), error(&MANIFEST.replace("side = 1", "side = 8")));
    // What is left are fourth derivatives.
    assert!(as_averages < 0.1 * as_points && as_points > 1e-4, "{as_points} {as_averages}");
}

#[test]
fn parameters_come_back_within_their_standard_errors() {
    let all = measure("phong(kd=[0.3,0.25,0.1], ks=[0.2,0.1,0.3], n=40)", 0.01);
    let found = fit(&"phong".parse().expect("a template"), &all.samples(0.0).expect("samples"), &Options::default())
        .expect("a fit");
    let truth = [0.3, 0.25, 0.1, 0.2, 0.1, 0.3, 40.0];
    let found = estimates(&found);
    assert_eq!(found.len(), truth.len());
    for ((value, error), truth) in found.into_iter().zip(truth) {
        assert!((value - truth).abs() <= 3.0 * error, "{value} ± {error}, expected {truth}");
        assert!(error < 0.01 * truth, "{value} ± {error}");
    }
}

/// Models with parameters drawn by chance, among them a rough plastic: a diffuse base under a dielectric coat of GGX facets.
#[test]
fn drawn_materials_come_back_within_their_standard_errors() {
    let mut all = Vec::new();
    for seed in 0..9 {
        let mut random = Stream::new(1975, seed);
        let mut draw = |low: f64, high: f64| low + (high - low) * random.uniform();
        let kd = [0.05, 0.05, 0.05].map(|low| draw(low, 0.5));
        let (ks, n, alpha) = ([0.0; 3].map(|_| draw(0.05, 0.3)), draw(10.0, 80.0), draw(0.15, 0.5));
        let f0 = [0.0; 3].map(|_| draw(0.03, 0.08));
        let (template, text, truth) = match seed % 3 {
            0 => ("phong", format!("phong(kd={kd:?}, ks={ks:?}, n={n})"), [&kd[..], &ks, &[n]].concat()),
            1 => ("ward", format!("ward(kd={kd:?}, ks={ks:?}, alpha={alpha})"), [&kd[..], &ks, &[alpha]].concat()),
            _ => (
                "lambert + ggx",
                format!("lambert(reflectance={kd:?}) + ggx(alpha={alpha}, f0={f0:?})"),
                [&kd[..], &[alpha], &f0].concat(),
            ),
        };
        let samples = measured(&text, 0.01, 100 * seed).samples(0.0).expect("samples");
        let found = fit(&template.parse().expect("a template"), &samples, &Options::default()).expect("a fit");
        let found = estimates(&found);
        assert_eq!(found.len(), truth.len(), "{text}");
        for ((value, error), truth) in found.into_iter().zip(truth) {
            assert!(error < 0.05 * truth, "{text}: {value} ± {error}, expected {truth}");
            all.push((value - truth) / error);
        }
    }
    // Of 63 normal deviates 0.17 are expected beyond 3, 2.9 beyond 2; beyond 4 none is, and more than 1 or 8 hardly ever (1 %).
    let beyond = |k: f64| all.iter().filter(|z| z.abs() > k).count();
    assert!(all.len() == 63 && beyond(4.0) == 0 && beyond(3.0) <= 1 && beyond(2.0) <= 8, "{all:?}");
    // Nor are standard errors too large: the mean square of them has a deviation of √(2/63).
    let square = all.iter().map(|z| z * z).sum::<f64>() / all.len() as f64;
    assert!(square > 1.0 - 3.0 * (2.0_f64 / 63.0).sqrt(), "{square}");
}

#[test]
fn an_error_that_all_have_in_common_is_in_the_standard_errors() {
    let all = measure("lambert(reflectance=[0.2,0.5,0.7])", 0.01);
    let template = "lambert".parse().expect("a template");
    let fitted = |samples| estimates(&fit(&template, &samples, &Options::default()).expect("a fit"));
    let alone = fitted(all.samples(0.0).expect("samples"));
    // Off by 2 % of what is seen in all: then so is the reflectance, exactly.
    let common = (0..all.values.len()).map(|n| 0.02 * [0.2, 0.5, 0.7][n % 3] / PI).collect();
    let both = fitted(all.samples(0.0).expect("samples").with_common(common).expect("as many"));
    for ((a, b), rho) in alone.into_iter().zip(both).zip([0.2, 0.5, 0.7]) {
        assert!(a.0 == b.0 && (b.1 - a.1.hypot(0.02 * rho)).abs() < 1e-6 * rho, "{a:?} {b:?}");
    }
    assert!(all.samples(0.0).expect("samples").with_common(vec![0.0]).is_err());
}

#[test]
fn bins_hold_what_they_cover_and_nothing_else() {
    let all = measure("lambert(reflectance=[0.2,0.5,0.7])", 0.01);
    let resolution = Resolution { theta_h: 30, theta_d: 30, phi_d: 36 };
    let binned = bin(&all, resolution);
    assert_eq!(binned.bins.iter().map(|b| b.count).sum::<usize>(), all.len());
    // The σ of the measurements are those of a normal distribution.
    let within = |k: f64| {
        let near = |n: &usize| (all.values[*n] - [0.2, 0.5, 0.7][n % 3] / PI).abs() <= k * all.errors[*n];
        100.0 * (0..all.values.len()).filter(near).count() as f64 / all.values.len() as f64
    };
    assert!((within(1.0) - 68.3).abs() < 5.0 && (within(2.0) - 95.4).abs() < 3.0, "{} {}", within(1.0), within(2.0));
    let (mut within, mut of) = (0, 0);
    for b in &binned.bins {
        for (band, rho) in [0.2, 0.5, 0.7].into_iter().enumerate() {
            of += 1;
            within += usize::from((b.values[band] - rho / PI).abs() <= 2.0 * b.errors[band]);
        }
    }
    // Of the bins at least as many: the larger of two errors is given.
    assert!(within * 100 >= of * 92, "{within} of {of}");
    let table = binned.table(&all).expect("a table");
    let measured = (0..resolution.bins()).filter(|b| !table.bin(*b)[0].is_nan()).count();
    assert_eq!(measured, binned.bins.len());
    assert!(binned.coverage_fraction() < 1.0 && binned.coverage_fraction() > 0.0);
}

#[test]
fn a_diffuse_reference_tells_the_strength_of_a_light() {
    let light = LIGHTS[0];
    let mut reference = Observations::new(3);
    let picture = photograph("lambert(reflectance=[0.5,0.6,0.9])", light, 1, (0.0, 0));
    scene(MANIFEST).observe(&picture, light, &[1.0; 3], None, &mut |s| reference.push(s)).expect("measured");
    let known = |reflectance: &[f64]| Reference { reflectance: reflectance.to_vec(), reflectance_sd: vec![0.01; 3] };
    let strength = strength_from(&reference, &known(&[0.5, 0.6, 0.9])).expect("a strength");
    assert!(strength.deviation_rms < 1e-6, "{strength:?}");
    for (found, truth) in strength.values.iter().zip(STRENGTH) {
        assert!((found / truth - 1.0).abs() < 1e-7, "{found} {truth}");
    }
    assert!(strength_from(&reference, &known(&[0.5, 0.6])).is_none());
    // What the certificate leaves open is in all values alike: u(ρ)/ρ.
    for (found, rho) in reference_factor_sd(&known(&[0.5, 0.6, 0.9])).into_iter().zip([0.5, 0.6, 0.9]) {
        assert!((found - 0.01 / rho).abs() < 1e-15, "{found}");
    }
    // Noise of 1 % of n measurements is 1/√n of that in the strength, and the strength is off by it.
    let mut noisy = Observations::new(3);
    let picture = photograph("lambert(reflectance=[0.5,0.6,0.9])", light, 1, (0.01, 2003));
    scene(MANIFEST).observe(&picture, light, &[1.0; 3], None, &mut |s| noisy.push(s)).expect("measured");
    let strength = strength_from(&noisy, &known(&[0.5, 0.6, 0.9])).expect("a strength");
    for ((found, error), truth) in strength.values.iter().zip(&strength.relative_errors).zip(STRENGTH) {
        let expected = 0.01 / (noisy.len() as f64).sqrt();
        // The scatter of n > 500 deviations is known to 1/√(2n), a thirtieth.
        assert!((error / expected - 1.0).abs() < 0.1, "{error} {expected}");
        assert!((found / truth - 1.0).abs() < 4.0 * error, "{found} ± {error}, expected {truth}");
    }
}

#[test]
fn what_cannot_be_measured_says_why() {
    let nothing = &mut |_: &Seen<'_>| panic!("nothing is valid");
    let s = scene(MANIFEST);
    let dark = s.observe(&black(), LIGHTS[0], &STRENGTH, None, nothing).expect("counts");
    assert!(dark.valid == 0 && dark.dark > 1000 && dark.why().starts_with("all that is lit is dark"), "{dark:?}");
    let behind = s.observe(&black(), Place::Near([-9.0, 0.1, 0.2]), &STRENGTH, None, nothing).expect("counts");
    assert!(behind.dark == 0 && behind.why().starts_with("the light is below the horizon"), "{behind:?}");
    let masked = s.observe(&black(), LIGHTS[0], &STRENGTH, Some(&[false; SIDE * SIDE]), nothing).expect("counts");
    assert!(masked.why().starts_with("the mask"), "{masked:?}");
    let mask = s.observe(&black(), LIGHTS[0], &STRENGTH, Some(&[true; 7]), nothing).unwrap_err();
    assert!(mask.to_string().starts_with("found a mask of another size than 96 × 96"), "{mask}");
    let inside = s.observe(&black(), Place::Near([0.0, 0.1, 0.3]), &STRENGTH, None, nothing).unwrap_err();
    assert!(inside.to_string().contains("inside of the sphere"), "{inside}");
    let bands = s.observe(&black(), LIGHTS[0], &STRENGTH[..2], None, nothing).unwrap_err();
    assert!(bands.to_string().contains("2 bands"), "{bands}");
    let saturated = MANIFEST.to_owned() + "saturated = 1e-6\n";
    let picture = photograph("lambert(reflectance=0.5)", LIGHTS[0], 1, (0.0, 0));
    let bright = scene(&saturated).observe(&picture, LIGHTS[0], &STRENGTH, None, nothing).expect("counts");
    assert!(bright.why().starts_with("all that is lit is saturated"), "{bright:?}");
}

/// The measurements of a material of the synthetic sphere, whose `scene.json` says where everything was.
fn synthetic(material: &str) -> Option<(Observations, f64)> {
    let folder = shared("capture/synthetic_sphere")?;
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("scene.json")).expect("read")).expect("JSON");
    let k = &json["K"];
    // The file has pixel centres at integer + 0.5, we at integers. It does not say over how many places a pixel is a mean: with the area of
    // pixels n comes out 7 ± 1 % of the whole correction too high, which is what 4 × 4 places lack of the area's variance (1/16). That is within
    // what the library takes as known of it where nothing is stated.
    let manifest = format!(
        "[camera]\nfx = {}\nfy = {}\ncx = {}\ncy = {}\nposition_m = [0, 0, 8]\nforward = [0, 0, -1]\nup = [0, 1, 0]\n
         [sphere]\ncentre_m = [0, 0, 0]\nradius_m = 1.0\n[radiance]\nunit_w_per_m2_sr = 1.0\nrelative_error = 2e-4\n",
        k[0][0],
        k[1][1],
        k[0][2].as_f64()? - 0.5,
        k[1][2].as_f64()? - 0.5
    );
    let scene = scene(&manifest);
    let numbers = |v: &serde_json::Value| {
        v.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect::<Vec<_>>()
    };
    let intensity = numbers(&json["light"]["intensity_W_per_sr_rgb"]);
    let mut all = Observations::new(3);
    for (n, position) in json["light"]["positions"].as_array()?.iter().enumerate() {
        let name = format!("{material}_L{n:02}.exr");
        let picture = Radiance::decode(&fs::read(folder.join(&name)).expect("read"), 1.0).expect("an EXR");
        let place = Place::Near(numbers(position).try_into().expect("three numbers"));
        scene.observe(&picture, place, &intensity, None, &mut |s| all.push(s)).expect("measured");
    }
    Some((all, scene.pixel_variance_sd))
}

fn median(mut errors: Vec<f64>) -> f64 {
    let half = errors.len() / 2;
    *errors.select_nth_unstable_by(half, f64::total_cmp).1
}

/// Median relative error of measurements against a formula per band.
fn against(all: &Observations, truth: impl Fn(usize, DVec3, DVec3) -> f64) -> f64 {
    let error = |(n, value): (usize, &f64)| {
        let (i, o) = all.directions[n / 3];
        (value / truth(n % 3, i, o) - 1.0).abs()
    };
    median(all.values.iter().enumerate().map(error).collect())
}

/// Pixels are halves, of 11 bits: a rounding is at most 2⁻¹¹ (0.049 %), its median about 2⁻¹³; the issue asks for 0.05 %.
const MEDIAN: f64 = 5e-4;

#[test]
fn the_diffuse_sphere_is_that_of_its_truth() {
    let Some((all, _)) = synthetic("diffuse") else { return };
    let error = against(&all, |band, _, _| [0.18, 0.45, 0.72][band] / PI);
    eprintln!("diffuse: median error {error:.2e} over {} measurements", all.len());
    assert!(error <= MEDIAN);
}

#[test]
fn the_phong_sphere_is_that_of_its_truth() {
    let Some((all, pixel_variance_sd)) = synthetic("phong_n40") else { return };
    let formula = |band: usize, i: DVec3, o: DVec3| {
        [0.3, 0.25, 0.1][band] / PI + 0.2 * 42.0 / (2.0 * PI) * mirror(i).dot(o).max(0.0).powi(40)
    };
    let error = against(&all, formula);
    eprintln!("phong: median error {error:.2e} over {} measurements", all.len());
    assert!(error <= MEDIAN);
    let options = Options { places: Some(40_000), ..Options::default() };
    let found = fit(&"phong".parse().expect("a template"), &all.samples(pixel_variance_sd).expect("samples"), &options);
    let found = found.expect("a fit");
    for ((value, error), truth) in estimates(&found).into_iter().zip([0.3, 0.25, 0.1, 0.2, 0.2, 0.2, 40.0]) {
        eprintln!("{value} ± {error}, truth {truth}");
        assert!((value - truth).abs() <= 3.0 * error, "{value} ± {error}, expected {truth}");
    }
}
