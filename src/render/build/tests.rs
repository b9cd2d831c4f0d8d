//! Which wavelengths a scene carries, and what dyes make of light in them. Expected are sums over the entries of the CIE's table of V at 1 nm,
//! in which the spectra here have their corners; the amounts are W.

use glam::DVec2;

use super::*;
use crate::render::bands::Width;
use crate::render::material::Transport;

/// Made of `wavelength_tolerance`'s default: the error of a sum over the wavelengths.
const TOLERANCE: f64 = 1e-3;
/// Corners of what absorbs and emits.
const ABSORPTION: [[f64; 2]; 4] = [[400.0, 0.0], [430.0, 0.6], [470.0, 0.6], [500.0, 0.0]];
const EMISSION: [[f64; 2]; 3] = [[520.0, 0.0], [560.0, 1.0], [600.0, 0.0]];
const ABSORPTION_2: [[f64; 2]; 4] = [[500.0, 0.0], [530.0, 0.7], [580.0, 0.7], [610.0, 0.0]];
const EMISSION_2: [[f64; 2]; 3] = [[610.0, 0.0], [640.0, 1.0], [680.0, 0.0]];
const CONTINUUM: [[f64; 2]; 4] = [[410.0, 0.0], [450.0, 1.0], [600.0, 0.5], [640.0, 0.0]];
const LINE: &str = "[[light]]\npoint = { at = [0, 0, 1], flux = \"1 W\" }\nspectrum = \"line:450nm\"\n";

fn scene(render: &str, lights: &str) -> Result<Built, Error> {
    let dye = |name: &str, a: &[[f64; 2]], e: &[[f64; 2]]| {
        let dye = format!("{{ reflectance = 0.2, absorption = {a:?}, emission = {e:?}, quantum_yield = 0.9 }}");
        format!("[[material]]\nname = \"{name}\"\ndye = {dye}\n")
    };
    let floor = |name: &str| {
        let floor = "rectangle = { corner = [-1, -1, 0], edges = [[2, 0, 0], [0, 2, 0]] }";
        format!("[[shape]]\nmaterial = \"{name}\"\n{floor}\n")
    };
    let meter = "[[sensor]]\nname = \"e\"\nilluminance = { at = [0, 0, 0.5] }\n";
    let (first, second) = (dye("first", &ABSORPTION, &EMISSION), dye("second", &ABSORPTION_2, &EMISSION_2));
    let text = ["[render]\n", render, "\n", &first, &second, &floor("first"), &floor("second"), lights, meter].concat();
    built_of(&text)
}

fn built_of(text: &str) -> Result<Built, Error> {
    build(text, &Description::parse(text).expect("a scene"), &NoFiles)
}

/// A function by straight lines between corners.
fn at(corners: &[[f64; 2]], nm: f64) -> f64 {
    let piece = corners.windows(2).find(|p| (p[0][0]..=p[1][0]).contains(&nm));
    piece.map_or(0.0, |p| p[0][1] + (nm - p[0][0]) / (p[1][0] - p[0][0]) * (p[1][1] - p[0][1]))
}

fn sum(f: impl Fn(f64) -> f64) -> f64 {
    (360..=830).map(|nm| f(f64::from(nm))).sum()
}

/// Luminous flux from the flux of all lights, behind some surfaces one after the other.
fn lumens(built: &Built, surfaces: &[usize]) -> f64 {
    let n = built.scene.bands().len();
    let (mut flux, mut of_light, mut scratch) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for light in built.scene.lights() {
        light.flux(&mut of_light);
        flux.iter_mut().zip(&of_light).for_each(|(f, l)| *f += l);
    }
    for &surface in surfaces {
        assert!(built.scene.material(surface).convert(DVec2::ZERO, Transport::Flux, &mut flux, &mut scratch));
    }
    flux.iter().zip(&built.quantities.luminous).map(|(f, w)| f * w).sum()
}

fn v(nm: f64) -> f64 {
    Efficiency::default().weighting().at(nm)
}

/// lm of the photons times nm that a dye gives: K_m ∫V e/∫e λ.
fn given(emission: &[[f64; 2]]) -> f64 {
    K_M * sum(|nm| v(nm) * at(emission, nm)) / sum(|nm| nm * at(emission, nm))
}

/// K_m [ρ V + Q a λ ∫V e/∫e λ] of 1 W in one line; two sums are off by the tolerance each, at 1 nm by nothing.
#[test]
fn a_line_excites_a_dye() {
    let expected = 0.2 * K_M * v(450.0) + 0.9 * 0.6 * 450.0 * given(&EMISSION);
    for (render, tolerance) in [("", 2.0 * TOLERANCE), ("model = \"full\"", 1e-12), ("wavelength_step_nm = 1", 1e-12)] {
        let built = scene(render, LINE).expect("built");
        let found = lumens(&built, &[0]);
        assert!((found / expected - 1.0).abs() < tolerance, "{render}: {found}, expected {expected}");
        assert_eq!(built.scene.bands().widths().iter().filter(|w| **w == Width::Line).count(), 1);
    }
    // Few wavelengths do.
    let built = scene("", LINE).expect("built");
    assert!(built.scene.bands().len() < 100 && built.wavelength_error.is_some_and(|e| e <= TOLERANCE));
}

/// The lines of mercury and a continuum; of 0.1 W more the dye takes what its absorption leaves of it. Three sums.
#[test]
fn lines_beside_a_continuum_excite_a_dye() {
    let light = |watts: f64, spectrum: &str| {
        format!("[[light]]\npoint = {{ at = [0, 0, 1], flux = \"{watts} W\" }}\nspectrum = {spectrum}\n")
    };
    let (lines, continuum) = ([(0.3, 404.656), (0.5, 435.833), (0.4, 546.074)], 2.0);
    let mut lights: String = lines.iter().map(|(w, nm)| light(*w, &format!("\"line:{nm}nm\""))).collect();
    lights += &light(continuum, &format!("{CONTINUUM:?}"));
    let density = |nm: f64| continuum * at(&CONTINUUM, nm) / sum(|nm| at(&CONTINUUM, nm));
    let taken = |nm: f64| 0.9 * nm * at(&ABSORPTION, nm);
    let photons = lines.iter().map(|(w, nm)| w * taken(*nm)).sum::<f64>() + sum(|nm| density(nm) * taken(nm));
    let reflected = lines.iter().map(|(w, nm)| w * v(*nm)).sum::<f64>() + sum(|nm| density(nm) * v(nm));
    let expected = 0.2 * K_M * reflected + photons * given(&EMISSION);
    for (render, tolerance) in [("", 3.0 * TOLERANCE), ("model = \"full\"", 1e-12)] {
        let found = lumens(&scene(render, &lights).expect("built"), &[0]);
        assert!((found / expected - 1.0).abs() < tolerance, "{render}: {found}, expected {expected}");
    }
}

/// What one dye emits excites another, which the line does not; it is reflected by it, too. Four sums.
#[test]
fn a_dye_excites_another() {
    let photons = 0.9 * 0.6 * 450.0;
    let energy = photons / sum(|nm| nm * at(&EMISSION, nm));
    let second = energy * sum(|nm| 0.9 * at(&ABSORPTION_2, nm) * nm * at(&EMISSION, nm)) * given(&EMISSION_2);
    let expected = 0.2 * (0.2 * K_M * v(450.0) + photons * given(&EMISSION)) + second;
    for (render, tolerance) in [("", 4.0 * TOLERANCE), ("model = \"full\"", 1e-12)] {
        let found = lumens(&scene(render, LINE).expect("built"), &[0, 1]);
        assert!((found / expected - 1.0).abs() < tolerance, "{render}: {found}, expected {expected}");
    }
}

/// What no light excites needs no wavelengths, and is not refused.
#[test]
fn a_dye_that_stays_dark_needs_no_wavelengths() {
    let built = scene("", &LINE.replace("450", "650")).expect("built");
    assert_eq!(built.scene.bands().wavelengths_nm(), [650.0]);
    let found = lumens(&built, &[0, 1]);
    assert!((found / (0.04 * K_M * v(650.0)) - 1.0).abs() < 1e-12, "{found}");
    // Wavelengths that were asked for have to meet its emission: at 410, 510, 610 nm there is none.
    let error = scene("wavelength_step_nm = 100", LINE).expect_err("refused");
    assert!(error.to_string().contains("expected a `wavelength_step_nm` below 100"), "{error}");
}

/// A flat light has no power in the line of another: 1 W of it over 470 nm.
#[test]
fn densities_have_no_power_in_lines() {
    let flat = "[[light]]\npoint = { at = [0, 0, 1], flux = \"1 W\" }\n";
    let built = scene("wavelength_step_nm = 1", &[LINE, flat].concat()).expect("built");
    let mut flux = vec![0.0; built.scene.bands().len()];
    built.scene.lights()[1].flux(&mut flux);
    assert!((flux[0] * 470.0 - 1.0).abs() < 1e-12 && flux[471] == 0.0, "{} {}", flux[0], flux[471]);
}

/// A sodium line beside lights that are left out: one without flux, one that faces away, and a surface that shines away from everything.
#[test]
fn lights_that_are_left_out_need_no_wavelengths() {
    let text = |model: &str| {
        format!(
            r#"
[render]
model = "{model}"
[[shape]]
rectangle = {{ corner = [-5, -5, 0], edges = [[10, 0, 0], [0, 10, 0]] }}
[[shape]]
name = "up"
rectangle = {{ corner = [-1, -1, 4], edges = [[2, 0, 0], [0, 2, 0]] }}
emission = {{ radiance = "1 W/m2/sr", spectrum = "line:500nm" }}
[[light]]
name = "away"
spot = {{ at = [0, 0, 5], aim = [0, 0, 9], half_angle = "10 deg", flux = "1000 lm" }}
[[light]]
name = "sodium"
point = {{ at = [0, 0, 1], flux = "1000 lm" }}
spectrum = "line:589.3nm"
[[light]]
name = "off"
point = {{ at = [0, 0, 1], flux = "0 lm" }}
spectrum = "LED-B3"
[[sensor]]
name = "e"
illuminance = {{ at = [0, 0, 0.5] }}
"#
        )
    };
    let built = built_of(&text("minimal")).expect("built");
    assert_eq!(built.scene.bands().wavelengths_nm(), [589.3]);
    assert_eq!(built.light_names, ["sodium"]);
    assert_eq!(
        (built.analysis.dark_lights, built.analysis.out_of_reach),
        (vec!["off".into()], vec!["away".into(), "up".into()])
    );
    let full = built_of(&text("full")).expect("built");
    assert_eq!((full.scene.bands().len(), full.light_names.len()), (471 + 2, 4));
}
