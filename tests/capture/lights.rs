//! Lights: the real chrome ball against OpenCV's directions, synthetic mirror balls against their scene, closed forms.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use glam::{DVec2, DVec3};
use photopic::capture::lights::adjust::{Evidence, Observation, Start, adjust};
use photopic::capture::lights::view::{Ball, Ray, View};
use photopic::capture::lights::{angle_deg, environment, highlight, list, outline::Outline, shading};
use photopic::capture::photo::Codes;
use photopic::capture::radiance::Radiance;
use photopic::capture::setup::Place;
use photopic::capture::{Manifest, Photo};
use photopic::math::random::Stream;

use crate::common::{rows, shared};

fn photo(path: &Path) -> Photo {
    Photo::decode(&fs::read(path).expect("a photograph")).expect("decoded")
}

fn mask(path: &Path) -> Outline {
    let mask = photo(path);
    let inside: Vec<bool> = mask.luma().iter().map(|v| *v > 127.5).collect();
    Outline::of_mask(&inside, mask.width).expect("a disc")
}

/// OpenCV's directions from the highlights, and those of the list that is widely copied.
fn opencv() -> Option<[Vec<DVec3>; 2]> {
    let table = rows(&shared("capture/sphere_photos/lights_from_chrome_opencv.csv")?);
    let of = |keys: [&str; 3]| {
        let cell = |row: &std::collections::HashMap<String, String>, k: &str| row[k].parse().expect("a number");
        table.iter().map(|r| DVec3::from_array(keys.map(|k| cell(r, k)))).collect()
    };
    Some([of(["Lx", "Ly", "Lz"]), of(["pub_x", "pub_y", "pub_z"])])
}

#[test]
fn the_chrome_ball_gives_opencvs_lights_and_tells_the_copied_list_from_them() {
    let Some([expected, copied]) = opencv() else { return };
    let Some(folder) = shared("capture/sphere_photos") else { return };
    let chrome = mask(&folder.join("chrome/chrome.mask.png"));
    let view = View::new(None).expect("a view");
    let ball = view.ball(&chrome, None).expect("a ball");
    let direction = |k: usize| {
        let name = format!("chrome/chrome.{k}.png");
        let found = highlight::find(&name, &photo(&folder.join(&name)), &chrome, &view, &ball).expect("a lamp");
        assert_eq!(found.others, 0, "{name}");
        ball.reflected(view.ray(found.pixel).expect("a ray")).expect("in the ball").towards
    };
    let found: Vec<DVec3> = (0..expected.len()).map(direction).collect();
    for (k, (ours, opencv)) in found.iter().zip(&expected).enumerate() {
        assert!(angle_deg(*ours, *opencv) < 1.0, "light {k}: {ours} {opencv}");
    }
    // The table prints how far the copied list is off: by 1.146 to 8.513 degrees. Ours may differ by what we differ from OpenCV.
    let printed = rows(&folder.join("lights_from_chrome_opencv.csv"));
    let difference = list::compare(&copied, &found);
    for (k, (angle, row)) in difference.angles_deg.iter().zip(&printed).enumerate() {
        let printed: f64 = row["angle_deg"].parse().expect("a number");
        assert!((angle - printed).abs() <= angle_deg(found[k], expected[k]) + 1e-5, "light {k}: {angle} {printed}");
    }
    // No rotation of the camera makes the list right, and no mirrored axis.
    assert!(difference.mirrored.is_none() && difference.turned_deg.iter().any(|a| *a > 3.0), "{difference:?}");
    // The gray ball, with another surface and in other photographs, says so too.
    let gray = mask(&folder.join("gray/gray.mask.png"));
    let ball = view.ball(&gray, None).expect("a ball");
    let (mut to_ours, mut to_copied) = (0.0, 0.0);
    for k in 0..found.len() {
        let name = format!("gray/gray.{k}.png");
        let points = shading::Points::of(&photo(&folder.join(&name)), &view, &ball, &gray);
        let shaded = shading::direction(&name, &points, false).expect("shading");
        to_ours += angle_deg(shaded.direction, found[k]);
        to_copied += angle_deg(shaded.direction, copied[k]);
        assert!(shaded.spread_deg > 0.1, "{name}: what is unknown of surface and response turns it: {shaded:?}");
    }
    assert!(to_ours < to_copied, "{to_ours} {to_copied}");
}

/// Camera and ball of the synthetic pictures, and the lamps' places.
fn synthetic() -> Option<(View, Ball, Vec<DVec3>)> {
    let folder = shared("capture/synthetic_sphere")?;
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("scene.json")).expect("read")).expect("JSON");
    let k = &json["K"];
    let number = |v: &serde_json::Value| v.as_f64().expect("a number");
    let text = format!(
        "[camera]\nfx = {}\nfy = {}\ncx = {}\ncy = {}\nposition_m = [0, 0, 8]\nforward = [0, 0, -1]\nup = [0, 1, 0]\n",
        number(&k[0][0]),
        number(&k[1][1]),
        number(&k[0][2]) - 0.5,
        number(&k[1][2]) - 0.5
    );
    let view = View::new(Manifest::parse(&text).expect("a manifest").camera.as_ref()).expect("a view");
    let place = |p: &serde_json::Value| DVec3::new(number(&p[0]), number(&p[1]), number(&p[2]));
    let lamps = json["light"]["positions"].as_array()?.iter().map(place).collect();
    Some((view, Ball { centre: DVec3::ZERO, radius: 1.0 }, lamps))
}

#[test]
fn the_synthetic_mirror_ball_points_at_its_lamps() {
    let Some((view, ball, lamps)) = synthetic() else { return };
    let Some(folder) = shared("capture/synthetic_sphere") else { return };
    // Its silhouette: seen from 8 radii away, asin(1/8) about the middle.
    let outline = Outline::stated([255.5, 255.5, 1712.9359970092567 * 0.125_f64.asin().tan()]);
    for (k, lamp) in lamps.iter().enumerate() {
        let name = format!("mirror_L{k:02}.exr");
        let found = highlight::find(&name, &photo(&folder.join(&name)), &outline, &view, &ball).expect("a lamp");
        // The first lamp stands in the picture itself, before the ball, larger than its image: a disc of 0.06 m, of which a part is seen.
        let disc_px = 0.06 * 1_712.935_997 / (8.0 - lamp.z);
        let itself = found.lamp.map(|seen| seen.distance(view.pixel(*lamp)));
        assert!(if k == 0 { itself.is_some_and(|d| d < disc_px) } else { itself.is_none() }, "{name}: {found:?}");
        let ray = ball.reflected(view.ray(found.pixel).expect("a ray")).expect("in the ball");
        let off = angle_deg(*lamp - ray.origin, ray.towards);
        // The lamps have a size: their images are blobs of pixels, cut by the circle's grid. A pixel is what they may be off.
        let pixel = ball.turn_per_pixel(&view, found.pixel).expect("inside").to_degrees();
        assert!(off < pixel, "{name}: {off} degrees, a pixel is {pixel}: {found:?}");
        let near = highlight::at_distance(&ray, ball.centre, lamp.length()).expect("beyond the ball");
        assert!(near.distance(*lamp) < pixel.to_radians() * lamp.length(), "{name}: {near} {lamp}");
    }
}

/// The pixel where a ball shows a lamp: the normal halves the way between lamp and camera.
fn image_of(view: &View, ball: &Ball, lamp: DVec3) -> DVec2 {
    let mut point = ball.centre;
    for _ in 0..200 {
        let half = (lamp - point).normalize() + view.back(point);
        point = ball.centre + ball.radius * half.normalize();
    }
    view.pixel(point)
}

#[test]
fn two_balls_tell_where_near_lamps_are_and_what_disagrees() {
    let text = "[camera]\nfx = 1500\nfy = 1500\ncx = 400\ncy = 300\ndistortion = [-0.1, 0.02, 0.001, 0.0, 0.0]\n";
    let view = View::new(Manifest::parse(text).expect("a manifest").camera.as_ref()).expect("a view");
    let balls = [
        Ball { centre: DVec3::new(-0.25, 0.02, 1.5), radius: 0.08 },
        Ball { centre: DVec3::new(0.25, -0.05, 1.6), radius: 0.1 },
    ];
    let lamps = [DVec3::new(0.8, -1.0, 0.4), DVec3::new(-0.9, -0.3, 0.2), DVec3::new(0.1, -1.2, 1.2)];
    let silhouette = |b: &Ball| {
        let away = b.centre.length_squared();
        let (along, across) = (1.0 - b.radius.powi(2) / away, b.radius * (1.0 - b.radius.powi(2) / away).sqrt());
        let t = b.centre.cross(DVec3::Y).normalize();
        let s = t.cross(b.centre.normalize());
        let touch = |k: i32| {
            let (sin, cos) = (0.07 * f64::from(k)).sin_cos();
            // Edges are found to a fifth of a pixel or so, here in a fixed pattern.
            view.pixel(b.centre * along + across * (cos * t + sin * s))
                + 0.2 * DVec2::new((2.1 * f64::from(k)).sin(), (1.7 * f64::from(k)).cos())
        };
        Outline::through((0..90).map(touch).collect()).expect("a circle")
    };
    let mut starts = Vec::new();
    for b in &balls {
        let outline = silhouette(b);
        let ball = view.ball(&outline, Some(b.radius)).expect("a ball");
        starts.push(Start { ball, outline: Some(outline), stated: false });
    }
    let mut observations = Vec::new();
    for (light, lamp) in lamps.iter().enumerate() {
        for (ball, b) in balls.iter().enumerate() {
            let wobble = 0.1 * DVec2::from_angle((2 * light + ball) as f64);
            let evidence = Evidence::Highlight(image_of(&view, b, *lamp) + wobble);
            observations.push(Observation { light, ball, evidence });
        }
    }
    let rays = |light: usize| -> Vec<Ray> {
        let mine = observations.iter().filter(|o| o.light == light);
        mine.map(|o| {
            let Evidence::Highlight(pixel) = o.evidence else { panic!("highlights only") };
            starts[o.ball].ball.reflected(view.ray(pixel).expect("a ray")).expect("in the ball")
        })
        .collect()
    };
    let places: Vec<Place> =
        (0..3).map(|k| Place::Near(highlight::position(&rays(k), 0.01).expect("a place").to_array())).collect();
    let found = adjust(view, &starts, &places, &observations).expect("adjusted");
    assert!(found.converged && found.disagreement.is_some_and(|d| d < 1.0), "{found:?}");
    for ((place, error), lamp) in found.lights.iter().zip(&found.errors_deg).zip(&lamps) {
        let Place::Near(p) = place else { panic!("near lamps") };
        let off = angle_deg(DVec3::from_array(*p) - balls[0].centre, *lamp - balls[0].centre);
        assert!(off < 3.0 * error && *error < 1.0, "{off} ± {error}");
        assert!(DVec3::from_array(*p).distance(*lamp) < 0.05, "{p:?} {lamp}");
    }
    // Two highlights of one photograph swapped with those of another: named, and far beyond the errors.
    observations.swap(1, 3);
    observations[1].light = 0;
    observations[3].light = 1;
    let wrong = adjust(view, &starts, &places, &observations).expect("adjusted");
    assert!(wrong.disagreement.is_some_and(|d| d > 10.0), "{wrong:?}");
}

/// Two mirror balls photographed 60 times, highlights rounded to pixels and edges scattered by 0.3 px: lamps are off by what is told, and the sum of
/// squares is its degrees of freedom. A turn per pixel is the larger of both ways, so that either is rather too large.
#[test]
fn standard_errors_are_the_scatter_of_repeated_photographs() {
    let text = "[camera]\nfx = 1500\nfy = 1500\ncx = 400\ncy = 300\n";
    let view = View::new(Manifest::parse(text).expect("a manifest").camera.as_ref()).expect("a view");
    let balls = [
        Ball { centre: DVec3::new(-0.25, 0.02, 1.5), radius: 0.08 },
        Ball { centre: DVec3::new(0.25, -0.05, 1.6), radius: 0.1 },
    ];
    // The last is seen in the first ball alone: two numbers for its three, which leave nothing over and take nothing from the others.
    let lamps = [DVec3::new(0.8, -1.0, 0.4), DVec3::new(-0.9, -0.3, 0.2), DVec3::new(0.1, -1.2, 1.2)];
    let seen: Vec<(usize, usize, DVec2)> = (0..3)
        .flat_map(|light| (0..2).map(move |ball| (light, ball)))
        .filter(|seen| *seen != (2, 1))
        .map(|(light, ball)| (light, ball, image_of(&view, &balls[ball], lamps[light])))
        .collect();
    let places = lamps.map(|lamp| Place::Near(lamp.to_array()));
    let repeats = 60;
    let (mut off, mut told, mut squares) = ([0.0; 2], [0.0; 2], 0.0);
    for seed in 0..repeats {
        let mut random = Stream::new(seed, 0);
        let starts = balls.map(|b| {
            let points = view.outline(&b).expect("in sight").points;
            let scattered = points.iter().map(|p| *p + 0.3 * DVec2::from_array(random.normals())).collect();
            Start { ball: b, outline: Outline::through(scattered), stated: false }
        });
        let observations: Vec<Observation> = (seen.iter())
            .map(|(light, ball, pixel)| {
                let [x, y] = random.uniforms();
                let evidence = Evidence::Highlight(*pixel + DVec2::new(x - 0.5, y - 0.5));
                Observation { light: *light, ball: *ball, evidence }
            })
            .collect();
        let found = adjust(view, &starts, &places, &observations).expect("adjusted");
        // 4 numbers for 3 of each of the first two lights.
        squares += 2.0 * found.disagreement.expect("two degrees of freedom").powi(2);
        for light in 0..2 {
            let Place::Near(p) = found.lights[light] else { panic!("near lamps") };
            // Both ways across.
            let away = angle_deg(DVec3::from_array(p) - balls[0].centre, lamps[light] - balls[0].centre);
            off[light] += 0.5 * away * away;
            told[light] += found.errors_deg[light].powi(2);
        }
    }
    // The root mean square of 120 numbers is known to 6.5 %: three times that above, and the larger of both ways below.
    for light in 0..2 {
        let ratio = (off[light] / told[light]).sqrt();
        assert!((0.6..1.2).contains(&ratio), "light {light}: {ratio}");
    }
    let each = (squares / (2.0 * repeats as f64)).sqrt();
    assert!((0.6..1.2).contains(&each), "{each}");
}

#[test]
fn balls_in_stated_places_tell_where_the_camera_stood() {
    let text = "[camera]\nfx = 1500\nfy = 1500\ncx = 400\ncy = 300\n";
    let stated = View::new(Manifest::parse(text).expect("a manifest").camera.as_ref()).expect("a view");
    // It was turned by 0.3° and more, and stood 4 mm aside and 6 mm behind; its focal length was 0.4 % shorter.
    let (turn, shift) = (DVec3::new(0.003, -0.005, 0.004), DVec3::new(0.004, -0.002, -0.006));
    let view = stated.moved(0.996, turn, shift);
    let balls = [
        Ball { centre: DVec3::new(-0.3, 0.1, 1.2), radius: 0.08 },
        Ball { centre: DVec3::new(0.3, -0.15, 1.6), radius: 0.1 },
        Ball { centre: DVec3::new(0.05, 0.25, 2.0), radius: 0.1 },
        Ball { centre: DVec3::new(-0.1, -0.3, 1.8), radius: 0.1 },
    ];
    // Edges are found to a fifth of a pixel or so, here in a fixed pattern.
    let seen = |b: &Ball| {
        let points = view.outline(b).expect("in sight").points;
        let off = |k: usize| 0.2 * DVec2::new((2.1 * k as f64).sin(), (1.7 * k as f64).cos());
        Outline::through(points.iter().enumerate().map(|(k, p)| *p + off(k)).collect()).expect("a circle")
    };
    let lamp = DVec3::new(0.8, -1.0, 0.4);
    let solve = |count: usize| {
        let start = |b: &Ball| Start { ball: *b, outline: Some(seen(b)), stated: true };
        let starts: Vec<Start> = balls[..count].iter().map(start).collect();
        let observe =
            |ball| Observation { light: 0, ball, evidence: Evidence::Highlight(image_of(&view, &balls[ball], lamp)) };
        let observations: Vec<Observation> = (0..count).map(observe).collect();
        let away = (lamp - balls[0].centre).to_array();
        let place = if count > 1 { Place::Near(lamp.to_array()) } else { Place::Distant(away) };
        adjust(stated, &starts, &[place], &observations).expect("adjusted")
    };
    let found = solve(4);
    let camera = found.camera.expect("stated balls");
    assert!(found.converged && camera.told == 7, "{camera:?}");
    let truth = [-0.004, turn.x, turn.y, turn.z, shift.x, shift.y, shift.z];
    for (k, (moved, truth)) in camera.moved.iter().zip(truth).enumerate() {
        assert!((moved - truth).abs() < 3.0 * camera.errors[k], "{k}: {moved} ± {} for {truth}", camera.errors[k]);
        assert!(camera.errors[k] < 0.5 * camera.stated[k], "{k}: {} of {}", camera.errors[k], camera.stated[k]);
    }
    let Place::Near(p) = found.lights[0] else { panic!("a near lamp") };
    let off = angle_deg(DVec3::from_array(p) - balls[0].centre, lamp - balls[0].centre);
    assert!(off < 3.0 * found.errors_deg[0].max(1e-3), "{off} ± {}", found.errors_deg[0]);
    // One ball has three numbers to tell: where its image is, and how large. A turn and a step aside look alike.
    let one = solve(1).camera.expect("a stated ball");
    assert_eq!(one.told, 3, "{one:?}");
    let alike = one.correlations[1][5].abs().min(one.correlations[2][4].abs());
    assert!(alike > 0.9, "{one:?}");
}

#[test]
fn a_diffuse_ball_tells_directions_and_what_it_cannot_tell() {
    let view = View::new(None).expect("a view");
    let outline = Outline::stated([60.0, 60.0, 50.0]);
    let ball = view.ball(&outline, None).expect("a ball");
    let lambert = |light: DVec3, offset: f64| {
        let value = |i: usize| {
            let ray = view.ray(DVec2::new((i % 120) as f64, (i / 120) as f64)).expect("a ray");
            ball.normal(ray).map_or(0.0, |n| offset + 180.0 * n.dot(light).max(0.0)) / 255.0
        };
        #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
        let values = (0..120 * 120).map(|i| value(i) as f32).collect();
        Photo { width: 120, height: 120, channels: 1, codes: Codes::Linear(values) }
    };
    for light in [DVec3::new(0.3, 0.4, 0.8), DVec3::new(-0.7, 0.1, 0.5), DVec3::new(0.5, -0.6, -0.1)] {
        let light = light.normalize();
        let points = shading::Points::of(&lambert(light, 12.0), &view, &ball, &outline);
        let found = shading::direction("a", &points, true).expect("shading");
        assert!(angle_deg(found.direction, light) < 1e-3 && (found.offset - 12.0).abs() < 1e-4, "{found:?}");
        // Codes under an unknown curve: the direction is the same, its uncertainty is not.
        let unknown = shading::direction("a", &points, false).expect("shading");
        assert!(unknown.spread_deg > found.spread_deg, "{unknown:?}");
    }
    let dark = shading::Points::of(&lambert(DVec3::ZERO, 0.0), &view, &ball, &outline);
    assert!(shading::direction("a", &dark, true).unwrap_err().to_string().contains("its ball is dark"));
    let flat = shading::Points::of(&lambert(DVec3::ZERO, 99.0), &view, &ball, &outline);
    assert!(shading::direction("a", &flat, true).unwrap_err().to_string().contains("equally bright"));
    // Three photographs of a Lambert ball, offset 12, exponent 1: within the errors of a fit to exact values, rounding.
    let lights =
        [DVec3::new(0.3, 0.4, 0.8), DVec3::new(-0.5, 0.1, 0.7), DVec3::new(0.1, -0.4, 0.6)].map(DVec3::normalize);
    let points = lights.map(|l| shading::Points::of(&lambert(l, 12.0), &view, &ball, &outline));
    let all: Vec<_> = points.iter().zip(lights).collect();
    let found = shading::entanglement(&all).expect("a fit");
    assert!((found.values[0] - 12.0).abs() < 0.05 && (found.values[1] - 1.0).abs() < 2e-3, "{found:?}");
    // Offset and gamma bend the same curve.
    assert!(found.correlations[0].abs() > 0.5, "{found:?}");
}

#[test]
fn a_mirror_ball_becomes_its_surroundings() {
    // Surroundings that are polynomials of the direction, seen in a ball by parallel rays.
    let light = |d: DVec3| 2.0 + d.x + 0.5 * d.y * d.z;
    let view = View::new(None).expect("a view");
    let ball = Ball { centre: DVec3::new(200.0, -200.0, 0.0), radius: 190.0 };
    let reflectance = 0.6;
    let value = |i: usize| {
        let ray = view.ray(DVec2::new((i % 400) as f64, (i / 400) as f64)).expect("a ray");
        ball.reflected(ray).map_or(0.0, |r| reflectance * light(r.towards))
    };
    #[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
    let values = (0..400 * 400).map(|i| value(i) as f32).collect();
    let picture = Radiance { width: 400, height: 400, channels: 1, time_s: 1.0, values, errors: None, states: None };
    let map = environment::equirectangular(&view, &ball, &picture, reflectance, 128);
    let (mut seen, mut worst) = (0.0, 0.0_f64);
    for y in 0..64 {
        for x in 0..128 {
            if map.at(x, y, 1) < 1.0 {
                continue;
            }
            // The middle looks along −z, the way of the camera; right is x, up is y.
            let (azimuth, theta) = (
                (x as f64 + 0.5) / 128.0 * std::f64::consts::TAU - std::f64::consts::PI,
                (y as f64 + 0.5) / 64.0 * std::f64::consts::PI,
            );
            let d = DVec3::new(theta.sin() * azimuth.sin(), theta.cos(), -theta.sin() * azimuth.cos());
            worst = worst.max((f64::from(map.at(x, y, 0)) - light(d)).abs());
            seen += theta.sin() * std::f64::consts::PI / 64.0 * std::f64::consts::TAU
                / 128.0
                / (4.0 * std::f64::consts::PI);
        }
    }
    // Interpolation between pixels is off by an eighth of the second derivative. Along the radius ρ = sin β, the direction turns as 2 asin ρ,
    // of second derivative 2 ρ/cos³β over r²; cos β is 0.1 at most outside, |∇L| at most 1.2. Curvature itself and areas: below 1e-3.
    assert!(worst < 2.0 / 0.1_f64.powi(3) / 190.0_f64.powi(2) / 8.0 * 1.2 + 1e-3, "{worst}");
    // Hidden: 2 asin(0.1) = 11.5 degrees about −z, (1 − cos)/2 = 1 % of the sphere, and pixels that are partly in it.
    assert!((0.98..0.995).contains(&seen), "{seen}");
}

#[test]
fn the_command_tells_lists_and_mistakes() {
    let Some(folder) = shared("capture/sphere_photos") else { return };
    let photos: Vec<String> =
        (0..12).map(|k| folder.join(format!("chrome/chrome.{k}.png")).display().to_string()).collect();
    let run = |photos: &[String], more: &[&str]| {
        Command::cargo_bin("photopic")
            .expect("the program")
            .args(["capture", "lights"])
            .args(photos)
            .args(more)
            .assert()
    };
    let chrome = folder.join("chrome/chrome.mask.png").display().to_string();
    let temp = tempfile::tempdir().expect("a folder");
    let copied = temp.path().join("lights.txt");
    let lines: Vec<String> = rows(&folder.join("lights_from_chrome_opencv.csv"))
        .iter()
        .map(|r| format!("{} {} {}", r["pub_x"], r["pub_y"], r["pub_z"]))
        .collect();
    fs::write(&copied, format!("12\n{}\n", lines.join("\n"))).expect("written");
    let list = copied.display().to_string();
    let told = run(&photos, &["--mask", &chrome, "--list", &list, "--json"]).success();
    let json: serde_json::Value = serde_json::from_slice(&told.get_output().stdout).expect("JSON");
    assert_eq!(json["results"][0]["lights"].as_array().map(Vec::len), Some(12));
    let finding = json["findings"].as_array().and_then(|f| f.iter().find(|f| f["code"] == "K024")).expect("a finding");
    assert!(
        finding["message"].as_str().is_some_and(|m| m.starts_with("12 of 12 directions") && m.contains("8.5 degrees"))
    );
    let message =
        |assert: assert_cmd::assert::Assert| String::from_utf8_lossy(&assert.code(2).get_output().stderr).into_owned();
    let cat = folder.join("cat/cat.mask.png").display().to_string();
    assert!(message(run(&photos[..1], &["--mask", &cat])).contains("no disc"), "a cat");
    let gray = [folder.join("gray/gray.4.png").display().to_string()];
    let mask = folder.join("gray/gray.mask.png").display().to_string();
    assert!(
        message(run(&gray, &["--mask", &mask])).contains("found no highlight of a lamp"),
        "a gray ball is no mirror"
    );
    let board = shared("capture/chessboard_left/left01.jpg").expect("beside").display().to_string();
    assert!(message(run(&photos[..1], &["--mask", &board])).contains("expected a mask of the size of the photographs"));
    assert!(message(run(&photos[..1], &["--mask", &chrome, "--list", &list])).contains("found 12 lights; expected 1"));
    let one = run(&photos[..1], &["--mask", &chrome]).success();
    assert!(String::from_utf8_lossy(&one.get_output().stderr).contains("K010"), "one light only");
}
