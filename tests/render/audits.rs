//! The audits against closed forms: where energy goes, and what readings lose.

use std::f64::consts::{LN_2, PI};
use std::sync::Arc;

use glam::DVec3;
use photopic::brdf::lambert::Lambert;
use photopic::render::audit::bias;
use photopic::render::audit::energy::{self, Energy};
use photopic::render::integrator::limits::{Follow, Limits};
use photopic::render::light::Light;
use photopic::render::light::point::Point;
use photopic::render::material::opaque::Opaque;
use photopic::render::material::{Material, Scattered, Transport};
use photopic::render::measure::{Meter, Settings};
use photopic::render::ray::{Ray, Towards};
use photopic::render::scene::{Part, Scene};
use photopic::render::sensor::response::Response;
use photopic::render::shape::disk::Disk;
use photopic::render::shape::sphere::Sphere;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

use crate::analytic::{agrees, at, part, scene};
use crate::cli::{json, photopic};

fn lamp() -> Arc<dyn Light> {
    Arc::new(Point::new(DVec3::ZERO, &[100.0]).expect("a lamp"))
}

fn hollow(reflectance: f64) -> Scene {
    scene(vec![part(Sphere::new(DVec3::ZERO, 1.0).expect("a sphere"), reflectance, None)], vec![lamp()])
}

fn audit(scene: &Scene, material_of: &[usize], packets: u64) -> Energy {
    let settings = Settings::new(5, Limits::default(), 1);
    let materials = material_of.iter().max().map_or(0, |m| m + 1);
    energy::audit(scene, &settings, &[1.0], material_of, materials, packets).expect("something shines")
}

/// What is emitted in a closed sphere is absorbed by its wall, on which it falls 1/(1 − ρ) times.
#[test]
fn a_closed_sphere_absorbs_everything() {
    for rho in [0.0, 0.5, 0.9] {
        let found = audit(&hollow(rho), &[0], 1 << 15);
        let flux = 4.0 * PI * 100.0;
        assert!((found.lights[0].stated_w - flux).abs() < 1e-9 * flux);
        agrees(found.lights[0].emitted_w, flux, "emitted");
        agrees(found.materials[0].absorbed_w, flux, "absorbed");
        agrees(found.materials[0].arrived_w, flux / (1.0 - rho), "arrived");
        agrees(found.escaped_w, 0.0, "escaped");
        assert!(!found.is_unbalanced() && !found.lights[0].is_off() && !found.materials[0].is_off(), "{found:?}");
    }
}

/// A black disk of radius 1 m at a distance of 1 m takes (1 − cos 45°)/2 of an isotropic lamp's flux, another above it of the same kind
/// as much; the rest escapes.
#[test]
fn every_material_has_its_own_account() {
    let disk = |z: f64| Disk::new(z * DVec3::Z, -z * DVec3::Z, z.abs()).expect("a disk");
    let scene =
        scene(vec![part(disk(1.0), 0.0, None), part(disk(-1.0), 0.0, None), part(disk(2.0), 0.0, None)], vec![lamp()]);
    let found = audit(&scene, &[0, 1, 0], 1 << 16);
    let (flux, share) = (4.0 * PI * 100.0, 0.5 * (1.0 - 0.5_f64.sqrt()));
    // The third disk stands in the shadow of the first.
    for material in &found.materials {
        agrees(material.absorbed_w, share * flux, "absorbed");
    }
    agrees(found.escaped_w, (1.0 - 2.0 * share) * flux, "escaped");
}

/// A diffuser that scatters so many times what its reflectance allows.
#[derive(Debug)]
struct Wrong(Opaque, f64);

impl Material for Wrong {
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, transport: Transport, values: &mut [f64]) {
        self.0.evaluate(incident, outgoing, transport, values);
    }

    fn sample(
        &self,
        o: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let drawn = self.0.sample(o, u, transport, hero, weights);
        weights.iter_mut().for_each(|w| *w *= self.1);
        drawn
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3, hero: usize) -> f64 {
        self.0.pdf(outgoing, incident, hero)
    }

    fn albedo(&self, arriving: DVec3, share: &mut [f64]) -> Option<f64> {
        self.0.albedo(arriving, share)
    }
}

/// A light that states another flux than it emits.
#[derive(Debug)]
struct Boaster(Point);

impl Light for Boaster {
    fn sample_towards(&self, from: DVec3, u: [f64; 3], arriving: &mut [f64]) -> Option<Towards> {
        self.0.sample_towards(from, u, arriving)
    }

    fn emit(&self, u: [f64; 5], flux: &mut [f64]) -> Option<Ray> {
        self.0.emit(u, flux)
    }

    fn flux(&self, flux: &mut [f64]) {
        self.0.flux(flux);
        flux.iter_mut().for_each(|f| *f *= 1.1);
    }

    fn importance(&self, from: DVec3) -> f64 {
        self.0.importance(from)
    }
}

#[test]
fn materials_and_lights_that_are_wrong_are_found() {
    for (factor, wrong) in [(1.0, false), (1.05, true), (0.9, true)] {
        let lambert = Opaque::new(Box::new(Lambert::new(vec![0.5]).expect("a reflectance")), true);
        let wall = Part {
            shape: Arc::new(Sphere::new(DVec3::ZERO, 1.0).expect("a sphere")),
            material: Arc::new(Wrong(lambert, factor)),
            emission: None,
        };
        let found = audit(&scene(vec![wall], vec![lamp()]), &[0], 1 << 14);
        assert_eq!(found.materials[0].is_off(), wrong, "{factor}: {found:?}");
        let excess = found.materials[0].excess.expect("asked");
        assert!((excess.value - 0.5 * (factor - 1.0)).abs() < 3.0 * excess.standard_error + 1e-12, "{excess:?}");
    }
    let light = Boaster(Point::new(DVec3::ZERO, &[100.0]).expect("a lamp"));
    let found = audit(&scene(Vec::new(), vec![Arc::new(light)]), &[], 4096);
    assert!(found.lights[0].is_off(), "{found:?}");
}

/// A light whose share in the flux is a thousandth of a packet's is checked by packets of its own.
#[test]
fn faint_lights_have_packets_of_their_own() {
    let faint = || Point::new(DVec3::X, &[1e-6]).expect("a lamp");
    let found = audit(&scene(Vec::new(), vec![lamp(), Arc::new(faint())]), &[], 1 << 14);
    assert_eq!((found.packets, found.lights[0].packets, found.lights[1].packets), (1 << 14, (512 - 16) * 32, 16 * 32));
    for (light, intensity) in found.lights.iter().zip([100.0, 1e-6]) {
        let flux = 4.0 * PI * intensity;
        // A point light's packets are all alike.
        assert!((light.emitted_w.value - flux).abs() < 1e-9 * flux && !light.is_off(), "{found:?}");
    }
    let found = audit(&scene(Vec::new(), vec![lamp(), Arc::new(Boaster(faint()))]), &[], 1 << 14);
    assert!(!found.lights[0].is_off() && found.lights[1].is_off(), "{found:?}");
}

/// More lights than packets of a replicate: those of which few packets or none were drawn are not accused.
#[test]
fn lights_without_packets_are_not_accused() {
    let faint: Arc<dyn Light> = Arc::new(Point::new(DVec3::X, &[1e-6]).expect("a lamp"));
    let lights = [vec![lamp(); 40], vec![faint; 40]].concat();
    let found = audit(&scene(Vec::new(), lights), &[], 320);
    assert_eq!((found.packets, found.lights[79].packets), (320, 0));
    assert!(found.lights.iter().all(|l| !l.is_off()), "{found:?}");
}

/// A disk that takes 1e-6 ends one in a million packets, which no packet of few meets; those that go on are as much too strong. Of N
/// packets, a share h of which falls on it, that is a variance of h 1e-6/N of the flux squared.
#[test]
fn ends_that_no_packet_met_are_in_the_error_of_the_balance() {
    let disk = Disk::new(DVec3::Z, -DVec3::Z, 1.0).expect("a disk");
    let found = audit(&scene(vec![part(disk, 1.0 - 1e-6, None)], vec![lamp()]), &[0], 1 << 12);
    let (flux, share) = (4.0 * PI * 100.0, 0.5 * (1.0 - 0.5_f64.sqrt()));
    // About 600 packets fall on the disk: their number is within 4 of its standard deviations, 0.16, and its root within half of that.
    assert!((found.balance_w.value / (-1e-6 * share * flux) - 1.0).abs() < 0.16, "{found:?}");
    let expected = flux * (share * 1e-6 / 4096.0).sqrt();
    assert!((found.balance_w.standard_error / expected - 1.0).abs() < 0.08, "{found:?}");
    assert!(!found.is_unbalanced(), "{found:?}");
}

/// An integrating sphere of reflectance ρ with a lamp in its middle: E = E₀ Σ ρᵏ. Paths of n edges know n − 1 reflections, so that they
/// lack ρⁿ of the light: 47.8 % at ρ = 0.9 with seven reflections, 43.0 % with one more.
#[test]
fn what_cut_paths_lose_is_known() {
    let direct = 100.0;
    let wall = Meter { place: at(-DVec3::Z, DVec3::Z), response: Response::Planar };
    for (rho, edges) in [(0.9, 7), (0.9, 8), (0.98, 8), (0.5, 3)] {
        let limits = Limits { max_edges: Some(edges), ..Limits::default() };
        let settings = Settings::new(3, limits, 1);
        let lost =
            bias::of_meters(&hollow(rho), &settings, &[(0, wall.clone())], &[1.0], 1 << 16).expect("something is cut");
        let whole = direct / (1.0 - rho);
        agrees(lost.whole, whole, "whole");
        agrees(lost.lost, whole * rho.powi(edges.cast_signed()), "lost");
        assert!(lost.lost.standard_error < 0.02 * lost.lost.value, "{lost:?}");
        assert!((lost.share() - rho.powi(edges.cast_signed())).abs() < 0.02, "{lost:?}");
    }
    // Direct light is seen where it falls, so that a meter's reading knows one reflection: E₀ (ρ² + ρ³ + …) = E₀/2 is lacking.
    let limits = Limits { follow: Follow::Nothing, ..Limits::default() };
    let lost = bias::of_meters(&hollow(0.5), &Settings::new(3, limits, 1), &[(0, wall.clone())], &[1.0], 1 << 14);
    agrees(lost.expect("something is left out").lost, 0.5 * direct, "reflected");
    assert!(bias::of_meters(&hollow(0.5), &Settings::new(3, Limits::default(), 1), &[(0, wall)], &[1.0], 64).is_none());
}

/// The audits on the command line: everything in one document, and a word where a reading or a material lacks light. Facets of GGX at
/// α = 1 keep 1 − ln 2 of the light along the normal.
#[test]
fn the_audits_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
[render]
max_edges = 3
[[material]]
name = "white"
reflectance = 0.8
[[material]]
name = "facets"
brdf = "ggx(alpha=1, f0=1)"
[[shape]]
material = "white"
sphere = { centre = [0, 0, 0], radius = "1 m" }
[[shape]]
material = "facets"
sphere = { centre = [0.5, 0, 0], radius = "0.1 m" }
[[light]]
name = "lamp"
point = { at = [0, 0, 0], flux = "1000 lm" }
[[sensor]]
name = "wall"
illuminance = { at = [0, 0, -1] }
[[sensor]]
name = "view"
camera = { at = [0, 0, 0.5], look_at = [0.2, 0.1, -1], resolution = [4, 4] }
"#;
    let path = crate::cli::scene(&folder, text);
    let run = || {
        let mut command = photopic();
        command.current_dir(folder.path()).arg("render").arg(&path).args(["--meter-samples", "1024", "--samples", "1"]);
        command
    };
    let out = json(run().arg("--json"));
    let result = &out["results"][0];
    let energy = &result["energy"];
    let of = |v: &serde_json::Value| v["value_w"].as_f64().expect("a number");
    let (emitted, absorbed): (f64, f64) = (
        of(&energy["lights"][0]["emitted"]),
        energy["materials"].as_array().expect("materials").iter().map(|m| of(&m["absorbed"])).sum(),
    );
    assert_eq!(of(&energy["escaped"]), 0.0);
    let error = energy["balance"]["standard_error_w"].as_f64().expect("a number");
    assert!((emitted - absorbed).abs() < 4.0 * error && error < 0.05 * emitted, "{emitted} {absorbed} {error}");
    let bias = &result["bias"];
    assert_eq!(bias["clamping"], "none");
    assert_eq!(bias["paths"].as_array().map(Vec::len), Some(2));
    let lost = bias["single_scattering"][0]["lost_albedo"]["at_0_deg"].as_f64().expect("a number");
    // The table of what facets lose is good to 5e-4.
    assert!((lost - LN_2).abs() < 5e-4, "{lost}");
    let codes: Vec<&str> =
        out["findings"].as_array().expect("findings").iter().filter_map(|f| f["code"].as_str()).collect();
    assert_eq!(codes, ["R005"; 3]);
    run().assert().success().stdout(contains("W emitted (16384 packets)").and(contains("wall: the solver leaves out")));
    let out = json(run().args(["--json", "--packets", "0"]));
    assert!(out["results"][0]["energy"].is_null());
}
