//! A rough interface between two transparent media: ground glass. GGX facets that reflect and refract, nothing lost.
//!
//! ```text
//! f_r = F D(h) G(ω_i, ω_o) / (4 |cosθ_i cosθ_o|),              h ∥ ω_i + ω_o
//! f_t = |ω_i·h| |ω_o·h| (1 − F) D(h) G₁G₁ / (|cosθ_i cosθ_o| |ω_o + η ω_i|²),   h ∥ ω_o + η ω_i,   η = n_i/n_o
//! ```
//!
//! | parameter | range | meaning |
//! |---|---|---|
//! | `alpha` | 1e-6 to 1, along x and y | roughness |
//! | `outside`, `inside` | 1 to 1e3, per band | indices as for [`dielectric`](super::dielectric), unlike each other |
//!
//! f_t is that of radiance; of flux it is η² times as much ([`Transport`]). Masking is Smith's, height-correlated for reflection,
//! separable for transmission. Where the indices disperse, a direction suits one wavelength, and the path carries its hero alone
//! ([`Material::splits`]).
//!
//! Light that meets a second facet is put back as in [`compensated`](super::compensated), on both sides. With E the albedo of one
//! scattering, reflection and transmission together, m = 1 − E what it loses, Ē, F̄ averages, A and B the two sides:
//!
//! ```text
//! f = ρ_A m_A(ω_i) m_A(ω_o) / (π (1 − Ē_A))          on one side
//! f = n_o² κ m_A(ω_o) m_B(ω_i) / π                   from side to side
//! κ = (1 − F̄_A)/n_B² / max(1 − Ē_A, 1 − Ē_B),   1 − ρ_A = κ n_B² (1 − Ē_B)
//! ```
//!
//! Since (1 − F̄_A)/n_B² = (1 − F̄_B)/n_A² for n_A, n_B relative to one another, both sides agree: f is reciprocal (f/n_o²), and all
//! flux is accounted for. κ shares out as facets do on the average; the shape of these lobes is a model, their amount is not.
//!
//! References: B. Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, EGSR 2007; E. Heitz, JCGT 3 (2014) and
//! JCGT 7 (2018); C. Kulla & A. Conty, SIGGRAPH 2017 course.

use std::f64::consts::PI;

use glam::DVec3;

use super::albedo::Albedo;
use super::dielectric::Interface;
use super::{Material, Scattered, Transport};
use crate::brdf::fresnel::dielectric;
use crate::brdf::microfacet::{ALPHA_X, ALPHA_Y, ggx};
use crate::brdf::parameter::Error;
use crate::math::sampling;

/// Nodes in η at which albedos are tabulated, where it differs from band to band.
const NODES: usize = 3;

/// A rough interface.
#[derive(Debug)]
pub struct RoughDielectric {
    alpha: [f64; 2],
    interface: Interface,
    /// Albedos of one scattering at the nodes, from the outside and from the inside.
    albedos: Vec<[Albedo; 2]>,
    again: Vec<Again>,
}

/// What a band does with the light that one scattering loses; [outside, inside].
#[derive(Debug, Clone, Copy)]
struct Again {
    /// Of the nodes: the band's albedo is the sum of theirs.
    nodes: [f64; NODES],
    /// ρ.
    reflects: [f64; 2],
    /// ρ/(π (1 − Ē)).
    back: [f64; 2],
    /// κ/π.
    through: f64,
}

/// f of one scattering, and the density of its sampling.
#[derive(Debug, Clone, Copy, Default)]
struct Single {
    value: f64,
    pdf: f64,
}

impl RoughDielectric {
    /// Between two media.
    ///
    /// # Errors
    /// [`Error::Range`] for roughness or indices out of range, and for indices that are the same in a band, as no roughness is seen
    /// then; [`Error::Bands`].
    pub fn new(alpha: [f64; 2], outside: &[f64], inside: &[f64]) -> Result<Self, Error> {
        ALPHA_X.check(alpha[0])?;
        ALPHA_Y.check(alpha[1])?;
        let interface = Interface::new(outside, inside)?;
        let etas: Vec<f64> = interface.all(DVec3::Z).collect();
        if let Some(band) = etas.iter().position(|eta| (eta - 1.0).abs() < 1e-6) {
            let expected = format!("other than `outside`, {}, by 1e-6 or more", outside[band]);
            return Err(Error::Range { name: "inside", value: inside[band], expected });
        }
        let (low, high) = etas.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), e| (l.min(*e), h.max(*e)));
        let nodes = if interface.disperses() { vec![low, 0.5 * (low + high), high] } else { vec![low] };
        let albedos: Vec<[Albedo; 2]> =
            nodes.iter().map(|eta| [*eta, 1.0 / eta].map(|eta| single_albedo(alpha, eta))).collect();
        let again = etas.iter().map(|eta| Again::new(*eta, lagrange(&nodes, *eta), &albedos)).collect();
        Ok(Self { alpha, interface, albedos, again })
    }

    /// One scattering, with ω_o above: `eta` = n_i/n_o if ω_i is below, n_below/n_above in any case.
    fn single(&self, incident: DVec3, outgoing: DVec3, eta: f64) -> Single {
        if incident.z == 0.0 {
            return Single::default();
        }
        let shadow_o = ggx::shadow(self.alpha, outgoing);
        if incident.z > 0.0 {
            let h = incident + outgoing;
            let facets = 0.25 * ggx::distribution(self.alpha, h) * dielectric(0.5 * h.length(), eta);
            let shadow_i = ggx::shadow(self.alpha, incident);
            let both = shadow_i * outgoing.z + shadow_o * incident.z - incident.z * outgoing.z;
            return Single { value: facets / both, pdf: facets / shadow_o };
        }
        let sum = outgoing + eta * incident;
        let length = sum.length();
        let h = if sum.z < 0.0 { -sum / length } else { sum / length };
        let (cos_o, cos_i) = (outgoing.dot(h), -incident.dot(h));
        if !(cos_o > 0.0 && cos_i > 0.0) {
            return Single::default();
        }
        let shadow_i = ggx::shadow(self.alpha, DVec3::new(incident.x, incident.y, -incident.z));
        let facets = cos_i * cos_o * ggx::distribution(self.alpha, h) * (1.0 - dielectric(cos_o, eta))
            / (shadow_o * length * length);
        Single { value: facets / shadow_i, pdf: facets * eta * eta }
    }

    /// What one scattering loses of the light of a direction, at the nodes.
    fn lost(&self, direction: DVec3) -> [f64; NODES] {
        let mut lost = [0.0; NODES];
        let side = usize::from(direction.z < 0.0);
        lost.iter_mut().zip(&self.albedos).for_each(|(l, albedos)| *l = albedos[side].lost(direction));
        lost
    }

    /// The rest of the scatterings for radiance: `side` is that of ω_o, `eta` = n_below/n_above as seen from there.
    fn again(&self, band: usize, lost: [[f64; NODES]; 2], side: usize, through: bool, from: DVec3) -> f64 {
        let again = &self.again[band];
        let both = again.lost(lost[0]) * again.lost(lost[1]);
        if through {
            // n_o² with the outside's n as 1.
            let n = if side == 0 { 1.0 } else { 1.0 / self.interface.relative(band, from) };
            n * n * again.through * both
        } else {
            again.back[side] * both
        }
    }
}

impl Again {
    fn new(eta: f64, nodes: [f64; NODES], albedos: &[[Albedo; 2]]) -> Self {
        let lost = [0, 1].map(|side| {
            let sum: f64 = nodes.iter().zip(albedos).map(|(w, a)| w * a[side].average_lost()).sum();
            sum.max(0.0)
        });
        // F̄ from the thinner side, that of the other from it: n_A² (1 − F̄_A) = n_B² (1 − F̄_B); here divided by both n².
        let passed = (1.0 - average(eta.max(1.0 / eta))) / (eta * eta).max(1.0);
        let kappa = if lost[0].max(lost[1]) > 1e-12 { passed / lost[0].max(lost[1]) } else { 0.0 };
        let reflects = [1.0 - kappa * eta * eta * lost[1], 1.0 - kappa * lost[0]];
        let back = [0, 1].map(|side| if lost[side] > 1e-12 { reflects[side] / (PI * lost[side]) } else { 0.0 });
        Self { nodes, reflects, back, through: kappa / PI }
    }

    fn lost(&self, nodes: [f64; NODES]) -> f64 {
        nodes.iter().zip(self.nodes).map(|(l, w)| l * w).sum::<f64>().clamp(0.0, 1.0)
    }
}

/// 2 ∫ F(µ) µ dµ of a dielectric of index `eta` above 1, by midpoints in µ = x².
fn average(eta: f64) -> f64 {
    let points = 256_u32;
    let x = |i: u32| (f64::from(i) + 0.5) / f64::from(points);
    (0..points).map(|i| 4.0 * x(i).powi(3) / f64::from(points) * dielectric(x(i) * x(i), eta)).sum()
}

/// The albedo of one scattering from the side of which the relative index is `eta`, of flux.
fn single_albedo(alpha: [f64; 2], eta: f64) -> Albedo {
    #[expect(clippy::float_cmp, reason = "the same roughness along both axes was given as the same number")]
    let isotropic = alpha[0] == alpha[1];
    Albedo::tabulate(alpha[0].max(alpha[1]), isotropic, |outgoing, u| {
        let h = ggx::sample_visible(alpha, outgoing, u);
        let cos = outgoing.dot(h);
        let reflectance = dielectric(cos.clamp(0.0, 1.0), eta);
        let shadow_o = ggx::shadow(alpha, outgoing);
        let mut sum = 0.0;
        let mirrored = 2.0 * cos * h - outgoing;
        if mirrored.z > 0.0 {
            let both = ggx::shadow(alpha, mirrored) * outgoing.z + shadow_o * mirrored.z - mirrored.z * outgoing.z;
            sum += reflectance * mirrored.z * shadow_o / both;
        }
        match refracted_at(outgoing, h, eta) {
            Some(through) if through.z < 0.0 => {
                let up = DVec3::new(through.x, through.y, -through.z);
                sum += (1.0 - reflectance) * up.z / ggx::shadow(alpha, up);
            }
            _ => {}
        }
        sum
    })
}

/// The direction beyond a facet of normal `h`; `None` under total reflection.
fn refracted_at(outgoing: DVec3, h: DVec3, eta: f64) -> Option<DVec3> {
    let cos = outgoing.dot(h);
    let cos2 = ((eta - 1.0) * (eta + 1.0) + cos * cos) / (eta * eta);
    (cos > 0.0 && cos2 > 0.0).then(|| ((cos / eta - cos2.sqrt()) * h - outgoing / eta).normalize())
}

/// The weights of the nodes in the polynomial through them.
fn lagrange(nodes: &[f64], x: f64) -> [f64; NODES] {
    let mut weights = [0.0; NODES];
    for (j, weight) in weights.iter_mut().enumerate().take(nodes.len()) {
        *weight = (0..nodes.len()).filter(|k| *k != j).map(|k| (x - nodes[k]) / (nodes[j] - nodes[k])).product();
    }
    weights
}

fn turned(direction: DVec3, over: bool) -> DVec3 {
    if over { DVec3::new(direction.x, direction.y, -direction.z) } else { direction }
}

impl Material for RoughDielectric {
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, transport: Transport, values: &mut [f64]) {
        if incident.z == 0.0 || outgoing.z == 0.0 {
            return values.fill(0.0);
        }
        let (below, through) = (outgoing.z < 0.0, incident.z * outgoing.z < 0.0);
        let lost = [self.lost(incident), self.lost(outgoing)];
        let (i, o) = (turned(incident, below), turned(outgoing, below));
        let at = |band: usize| {
            let eta = self.interface.relative(band, outgoing);
            let once = self.single(i, o, eta).value;
            let value = once + self.again(band, lost, usize::from(below), through, outgoing);
            // (n_i/n_o)² more of flux.
            if through && transport == Transport::Flux { value * eta * eta } else { value }
        };
        if self.interface.disperses() {
            values.iter_mut().enumerate().for_each(|(band, v)| *v = at(band));
        } else {
            values.fill(at(0));
        }
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        if outgoing.z == 0.0 {
            return None;
        }
        let below = outgoing.z < 0.0;
        let o = turned(outgoing, below);
        let (again, first) = sampling::split(u[0], self.again[hero].lost(self.lost(outgoing)));
        let direction = if again {
            let (reflects, _) = sampling::split(first, self.again[hero].reflects[usize::from(below)]);
            // Any node's density will do.
            let side = usize::from(below == reflects);
            turned(self.albedos[0][side].sample_lost([u[1], u[2]]), !reflects)
        } else {
            let eta = self.interface.relative(hero, outgoing);
            let h = ggx::sample_visible(self.alpha, o, [u[1], u[2]]);
            let cos = o.dot(h);
            let (reflects, _) = sampling::split(first, dielectric(cos.clamp(0.0, 1.0), eta));
            let direction = if reflects { 2.0 * cos * h - o } else { refracted_at(o, h, eta)? };
            if (direction.z > 0.0) != reflects {
                return None;
            }
            direction
        };
        let direction = turned(direction, below);
        let pdf = self.pdf(outgoing, direction, hero);
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        self.evaluate(direction, outgoing, transport, weights);
        let splits = self.interface.disperses();
        for (band, weight) in weights.iter_mut().enumerate() {
            *weight = if splits && band != hero { 0.0 } else { *weight * direction.z.abs() / pdf };
        }
        let through = direction.z * outgoing.z < 0.0;
        let eta = if through { self.interface.relative(hero, outgoing) } else { 1.0 };
        Some(Scattered { direction, pdf, delta: false, split: splits, eta })
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3, hero: usize) -> f64 {
        if incident.z == 0.0 || outgoing.z == 0.0 {
            return 0.0;
        }
        let (below, through) = (outgoing.z < 0.0, incident.z * outgoing.z < 0.0);
        let eta = self.interface.relative(hero, outgoing);
        let once = self.single(turned(incident, below), turned(outgoing, below), eta).pdf;
        let again = &self.again[hero];
        let (lost, reflects) = (again.lost(self.lost(outgoing)), again.reflects[usize::from(below)]);
        let share = if through { 1.0 - reflects } else { reflects };
        let density = self.albedos[0][usize::from(incident.z < 0.0)].lost_pdf(incident);
        (1.0 - lost) * once + lost * share * density
    }

    fn is_transmissive(&self) -> bool {
        true
    }

    fn splits(&self) -> bool {
        self.interface.disperses()
    }
}
