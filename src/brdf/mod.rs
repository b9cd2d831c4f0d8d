//! Reflection at a surface: one trait for models and measured tables, and the conventions that both keep.
//!
//! ```text
//! f_r(ω_i, ω_o) = dL_o / (L_i cosθ_i dω_i)      1/sr
//! ```
//!
//! - Both directions are unit vectors **away** from the surface in its local frame (`geometry`): +z is the normal, ω_i points
//!   to the light, ω_o to the observer. f_r has **no** cosine in it.
//! - A BRDF here is *prepared* for a set of **bands**: the wavelengths that the caller works with, or the channels (R, G, B) in
//!   which a material was measured. Whatever depends on the wavelength alone is computed once, when it is prepared; an evaluation
//!   writes the values of all bands into a slice of the caller and allocates nothing.
//! - Dirac lobes (ideal mirrors, polished glass) have no value: they appear in [`Brdf::specular`] and in [`Brdf::sample`], with
//!   a flag, and never in [`Brdf::evaluate`].
//! - Below the horizon (z ≤ 0 of either direction) f_r is 0: a surface here is opaque and one-sided.
//! - Quantities over solid angles (albedo, reflectances between cones) come with the error of their quadrature.
//!
//! | file | what it is |
//! |---|---|
//! | [`lambert`], [`oren_nayar`] | diffuse reflection, ideal and of rough surfaces |
//! | [`specular`], [`fresnel`] | mirrors, polished glass and metal; Fresnel's reflectance |
//! | [`phong`], [`ward`], [`ashikhmin_shirley`] | empirical lobes |
//! | [`microfacet`] | Torrance-Sparrow with GGX, Beckmann and Blinn facets |
//! | [`abc`], [`sgd`] | microfacets fitted to measured materials |
//! | [`sum`] | sums and mixtures |
//! | [`table`], [`format`](mod@format), [`coordinates`] | measured tables, their files, their coordinates |
//! | [`medium`] | refractive indices of a few substances |
//! | [`description`] | materials in words, for the command line, files and scenes |
//! | [`audit`] | reciprocity, energy, sign, symmetry, coverage |
//! | [`fit`] | fitting models to measured tables |
//! | [`reflectance`] | reflectances between directions, cones, hemispheres |
//! | [`parameter`] | names and ranges of parameters |
//!
//! A new material implements [`Brdf`]: [`Brdf::bands`], [`Brdf::is_isotropic`] and [`Brdf::evaluate`] are all it must give. The
//! others have defaults that are right for any material without Dirac lobes, and slow for narrow ones.

use std::fmt;

use glam::DVec3;

use crate::math::sampling;

pub mod abc;
pub mod ashikhmin_shirley;
pub mod audit;
pub mod compress;
pub mod coordinates;
pub mod description;
pub mod fit;
pub mod format;
pub mod fresnel;
pub mod lambert;
pub mod medium;
pub mod microfacet;
pub mod oren_nayar;
pub mod parameter;
pub mod phong;
pub mod reflectance;
pub mod sgd;
pub mod specular;
pub mod sum;
pub mod table;
pub mod ward;

pub use parameter::Error;

/// A direction drawn by [`Brdf::sample`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampled {
    /// The drawn direction, ω_i.
    pub incident: DVec3,
    /// Its density in 1/sr; for a Dirac lobe the probability with which that lobe was chosen.
    pub pdf: f64,
    /// The direction belongs to a Dirac lobe: [`Brdf::evaluate`] and [`Brdf::pdf`] know nothing of it.
    pub delta: bool,
}

/// A bidirectional reflectance distribution function on a set of bands.
///
/// All slices have [`Brdf::bands`] elements. Directions are unit vectors away from the surface, +z its normal.
pub trait Brdf: fmt::Debug + Send + Sync {
    /// The number of bands: wavelengths or channels.
    fn bands(&self) -> usize;

    /// Whether turning the sample about its normal changes nothing.
    fn is_isotropic(&self) -> bool;

    /// The microfacets in it that know a single scattering only, each with its weight per band: light that meets a second facet is lost.
    fn microfacets(&self) -> Vec<(Vec<f64>, &microfacet::Microfacet)> {
        Vec::new()
    }

    /// Whether some of the light leaves in Dirac lobes: [`Brdf::specular`].
    fn has_delta(&self) -> bool {
        false
    }

    /// Whether all of the light leaves in Dirac lobes: [`Brdf::evaluate`] is zero everywhere.
    fn is_delta(&self) -> bool {
        false
    }

    /// Whether it is about the same for all pairs of directions above the horizon: there is no lobe in it.
    fn is_diffuse(&self) -> bool {
        false
    }

    /// Whether the values bend or jump between nodes, as those of tables do: quadratures, which converge slowly then, stop at 1e-4.
    fn is_tabulated(&self) -> bool {
        false
    }

    /// Writes f_r(ω_i, ω_o) in 1/sr, **without** cosine, one value per band; 0 where either direction is not above the horizon.
    /// Finite everywhere. Dirac lobes are not in it.
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]);

    /// Writes the reflectance of the Dirac lobe into the mirror direction of `incident`, per band: 0 where there is none.
    fn specular(&self, incident: DVec3, reflectance: &mut [f64]) {
        let _ = incident;
        reflectance.fill(0.0);
    }

    /// Writes what polarised light keeps in that lobe, per band and up to a factor; `false`: not known, the lobe depolarises.
    fn polarise(&self, incident: DVec3, components: &mut [fresnel::Components]) -> bool {
        let _ = (incident, components);
        false
    }

    /// Draws ω_i for a given ω_o from three uniform numbers in [0, 1): `u[0]` chooses among lobes, `u[1]`, `u[2]` the direction.
    ///
    /// Writes f_r cosθ_i / pdf per band (for a Dirac lobe: reflectance / probability), which is what a path's throughput is
    /// multiplied by. `None` where ω_o is not above the horizon or the draw fell below it; such a draw counts as a zero.
    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        sample_by(self, outgoing, sampling::cosine_hemisphere([u[1], u[2]]), weights)
    }

    /// Density in 1/sr with which [`Brdf::sample`] draws ω_i for ω_o, outside of Dirac lobes.
    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        if outgoing.z > 0.0 { sampling::cosine_hemisphere_pdf(incident.z) } else { 0.0 }
    }

    /// Writes the directional-hemispherical reflectance (albedo) ρ(ω_i; 2π) = ∫ f_r cosθ_o dω_o per band, Dirac lobes included,
    /// and gives a bound on its absolute error: rounding for a closed form, the quadrature's own estimate otherwise.
    fn albedo(&self, incident: DVec3, reflectance: &mut [f64]) -> f64 {
        reflectance::directional(self, incident, &reflectance::Cone::HEMISPHERE, reflectance)
    }

    /// The directions of incidence `[θ_i, φ_i]` in degrees under which a table was lit, where they are few; `None` for models, and for
    /// tables that hold as many directions of incidence as outgoing ones. φ_i is 0 in an isotropic table.
    fn incidences_deg(&self) -> Option<Vec<[f64; 2]>> {
        None
    }

    /// Whether the value for two directions is known: always for a model; in a measured table, whether the place was measured.
    /// [`Brdf::evaluate`] gives the table's best guess where it was not.
    fn is_measured(&self, incident: DVec3, outgoing: DVec3) -> bool {
        let _ = (incident, outgoing);
        true
    }
}

/// The rest of [`Brdf::sample`] once a direction is drawn that [`Brdf::pdf`] knows the density of: writes the weights.
pub(crate) fn sample_by<B: Brdf + ?Sized>(
    brdf: &B,
    outgoing: DVec3,
    incident: DVec3,
    weights: &mut [f64],
) -> Option<Sampled> {
    if outgoing.z <= 0.0 || incident.z <= 0.0 {
        return None;
    }
    let pdf = brdf.pdf(outgoing, incident);
    if !(pdf > 0.0 && pdf.is_finite()) {
        return None;
    }
    brdf.evaluate(incident, outgoing, weights);
    weights.iter_mut().for_each(|w| *w *= incident.z / pdf);
    Some(Sampled { incident, pdf, delta: false })
}

/// The reflection of ω_o at a facet of unit normal `normal`; `None` for a facet that ω_o does not see.
fn reflected(outgoing: DVec3, normal: DVec3) -> Option<DVec3> {
    let cos = outgoing.dot(normal);
    (cos > 0.0).then(|| 2.0 * cos * normal - outgoing)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / (values.len().max(1) as f64)
}

/// How often a sampler draws from a diffuse part of reflectance `diffuse` beside a lobe of reflectance `lobe`.
fn diffuse_probability(diffuse: &[f64], lobe: &[f64]) -> f64 {
    let (d, l) = (mean(diffuse), mean(lobe));
    if d + l > 0.0 { d / (d + l) } else { 1.0 }
}
