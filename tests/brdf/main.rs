//! BRDF models against closed forms, 50-digit arithmetic, Mitsuba, published fits, and physics.

#[path = "../common/mod.rs"]
mod common;

mod extremes;
mod fits;
mod fitting;
mod oracles;
mod physics;
mod ranking;
mod sampling;
mod strd;
mod tables;

use photopic::brdf::Brdf;
use photopic::brdf::description::{Bands, Material};

/// A described material at one wavelength, or on its channels.
fn material(text: &str) -> Box<dyn Brdf> {
    let material: Material = text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
    let bands = material.channels().map_or(Bands::Wavelengths(&[555.0]), Bands::Channels);
    material.prepare(bands).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// The first band at two directions.
fn value(brdf: &dyn Brdf, incident: glam::DVec3, outgoing: glam::DVec3) -> f64 {
    let mut out = vec![0.0; brdf.bands()];
    brdf.evaluate(incident, outgoing, &mut out);
    out[0]
}

/// Every model and form in a middling state, each reciprocal and with an albedo of at most 1.
const SOUND: [&str; 19] = [
    "lambert(reflectance=0.5)",
    "oren-nayar(reflectance=0.8, sigma_deg=20)",
    "phong(kd=0.3, ks=0.6, n=20)",
    "blinn-phong(kd=0.3, ks=0.6, n=40)",
    "ward(kd=0.2, ks=0.5, alpha=0.2)",
    "ward(ks=0.8, alpha_x=0.1, alpha_y=0.4)",
    "ward(ks=0.8, alpha=0.3, form=ward)",
    "ashikhmin-shirley(rd=0.4, rs=0.2, nu=20, nv=100)",
    "ggx(alpha=0.3, medium=Au)",
    "ggx(alpha_x=0.1, alpha_y=0.5, reflectance=1)",
    "ggx(alpha=0.5, f0=0.1, masking=smith-separable)",
    "ggx(alpha=0.4, eta=1.5, masking=v-cavity)",
    "beckmann(alpha=0.3, medium=Al)",
    "beckmann(alpha_x=0.6, alpha_y=0.2, reflectance=1)",
    "beckmann(alpha=0.4, eta=1.5, masking=v-cavity)",
    "blinn(n=30, reflectance=1)",
    "blinn(n=100, eta=1.5, masking=v-cavity)",
    // alum-bronze as Löw et al. fitted it (first channel).
    "abc(kd=0.024514, a=51.714554, b=10482.133789, c=0.816737, eta=2.236525)",
    "0.5*lambert(reflectance=0.4) + 0.5*ggx(alpha=0.2, eta=1.5)",
];
