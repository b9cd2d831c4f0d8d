//! dev driver
use glam::DVec3;
use photopic::brdf::lambert::Lambert;
use photopic::colorimetry::observer::Observer;
use photopic::geometry::lens::Distortion;
use photopic::image::source::{Region, Source};
use photopic::render::bands::Bands;
use photopic::render::emission::Emission;
use photopic::render::film::Film;
use photopic::render::integrator::path::Limits;
use photopic::render::light::Light;
use photopic::render::material::{Material, opaque::Opaque};
use photopic::render::measure::Settings;
use photopic::render::scene::{Part, Scene};
use photopic::render::sensor::camera::{Camera, Projection};
use photopic::render::shape::rectangle::Rectangle;
use photopic::spectrum::integrate::Weighting;
use std::sync::Arc;

fn vec(v: &serde_json::Value) -> DVec3 {
    let a: Vec<f64> = v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    DVec3::new(a[0], a[1], a[2])
}
fn spec(v: &serde_json::Value, bands: &Bands) -> Vec<f64> {
    let g = |k: &str| -> Vec<f64> { v[k].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect() };
    let w = Weighting::table(g("lambda_nm"), g("values"));
    bands.wavelengths_nm().iter().map(|&n| w.at(n)).collect()
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let (name, spp, step): (&str, u64, f64) = (&args[1], args[2].parse().unwrap(), args[3].parse().unwrap());
    let out = &args[4];
    let seed: u64 = args.get(5).map_or(1, |s| s.parse().unwrap());
    let root = std::path::Path::new("../shared/render");
    let j: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(root.join(format!("scenes/{name}.json"))).unwrap()).unwrap();
    let bands = Bands::uniform(360.0 + if step > 5.0 { 2.0 } else { 0.0 }, step);
    let mats: std::collections::HashMap<String, Arc<dyn Material>> = j["materials"]
        .as_object()
        .unwrap()
        .iter()
        .map(|(k, m)| {
            (
                k.clone(),
                Arc::new(Opaque::new(Box::new(Lambert::new(spec(&m["reflectance"], &bands)).unwrap()), true))
                    as Arc<dyn Material>,
            )
        })
        .collect();
    let mut parts = Vec::new();
    for s in j["shapes"].as_array().unwrap() {
        let material = mats[s["material"].as_str().unwrap()].clone();
        let emission = s.get("emission").map(|e| Arc::new(Emission::diffuse(spec(e, &bands))));
        let shape: Arc<dyn photopic::render::shape::Shape> = if s["kind"] == "quad" {
            let c: Vec<DVec3> = s["corners"].as_array().unwrap().iter().map(vec).collect();
            Arc::new(Rectangle::new(c[0], c[1] - c[0], c[3] - c[0]).unwrap())
        } else {
            panic!()
        };
        parts.push(Part { shape, material, emission });
    }
    let lights: Vec<Arc<dyn Light>> = Vec::new();
    let scene = Scene::new(bands, parts, lights);
    let c = &j["camera"];
    let proj = Projection::Perspective {
        field_of_view_deg: c["fov_deg"].as_f64().unwrap(),
        distortion: Distortion::default(),
    };
    let camera = Camera::new(vec(&c["origin"]), vec(&c["target"]), vec(&c["up"]), proj, [256, 256]).unwrap();
    let mut settings = Settings::new(
        seed,
        Limits { max_edges: Some(j["integrator"]["max_path_edges"].as_u64().unwrap() as u32), ..Limits::default() },
        scene.bands().len(),
    );
    settings.limits.roulette_from = j["integrator"]["rr_start_edge"].as_u64().unwrap() as u32;
    let cmf = Observer::Cie1931.colour_matching_functions();
    let w: Vec<Vec<f64>> = cmf.iter().map(|w| scene.bands().weights(w)).collect();
    let tri: Vec<[f64; 3]> =
        (0..scene.bands().len()).map(|b| [w[0][b] * 683.002, w[1][b] * 683.002, w[2][b] * 683.002]).collect();
    let n = scene.bands().len();
    for _ in 0..1 {
        let t = std::time::Instant::now();
        let mut film = Film::new(&scene, &camera, &settings, 0, spp, &tri, |_| ());
        let ch = [n, n + 1, n + 2];
        let mut buf = vec![0.0_f32; 256 * 256 * 3];
        film.read(Region { x: 0, y: 0, width: 256, height: 256 }, &ch, &mut buf).unwrap();
        let dt = t.elapsed().as_secs_f64();
        println!(
            "{name} bands {n} spp {spp}: {dt:.3} s, {:.3} Msamples/s, noise {:.4}, faults {:?}",
            65536.0 * spp as f64 / dt / 1e6,
            film.noise().relative(),
            film.noise().faults
        );
        let bytes: Vec<u8> = buf.iter().flat_map(|v| v.to_le_bytes()).collect();
        std::fs::write(out, bytes).unwrap();
    }
}
