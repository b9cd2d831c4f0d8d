//! Materials, prepared for the bands.

use std::ops::Range;
use std::str::FromStr;
use std::sync::Arc;

use toml::Spanned;

use super::colour::{Colour, Dye, Edge, Role};
use super::picture::Of;
use super::{Builder, Quantities};
use crate::brdf::Brdf;
use crate::brdf::description::{Bands as BrdfBands, ErrorKind, Material as Model};
use crate::brdf::fresnel::Fresnel;
use crate::brdf::lambert::Lambert;
use crate::brdf::medium::refractive_index;
use crate::brdf::microfacet::{Distribution, Masking, Microfacet};
use crate::brdf::specular::Specular;
use crate::geometry::direction;
use crate::render::audit::bias::{self, SingleScattering};
use crate::render::bands::{Bands, RANGE_NM, Width};
use crate::render::description::Error;
use crate::render::description::material::{
    Checkerboard as Fields, Dielectric as Glass, Material as Described, Metal, Pane, Texture as DescribedTexture,
};
use crate::render::description::spectrum::SpectrumSource;
use crate::render::material::Material;
use crate::render::material::compensated::Compensated;
use crate::render::material::dielectric::Dielectric;
use crate::render::material::fluorescent::Fluorescent;
use crate::render::material::mixture::Mixture;
use crate::render::material::opaque::Opaque;
use crate::render::material::rough_dielectric::RoughDielectric;
use crate::render::material::textured::{Checkerboard, Picture, Textured};
use crate::render::material::thin_slab::ThinSlab;
use crate::spectrum::integrate::Weighting;

/// A material by name.
pub(super) type Named = (String, Arc<dyn Material>);

/// A model's place in the scene's text, for errors within a description on one line.
fn place(b: &Builder<'_>, text: &Spanned<String>, e: &crate::brdf::description::Error) -> Error {
    let mut out = b.wrong(&text.span(), &e.kind);
    if e.place.line == 1 {
        out.column += e.place.column;
    }
    if matches!(e.kind, ErrorKind::Model { .. }) && !text.get_ref().contains('(') {
        out.message += "; a measured table is `measured = { file = \"NAME\" }`";
    }
    out
}

impl Builder<'_> {
    pub(super) fn materials(&self, bands: &Bands) -> Result<Vec<Named>, Error> {
        let mut done: Vec<Named> = Vec::new();
        for m in &self.description.material {
            let mut material = self.material(m, bands, &done)?;
            if let Some(fields) = &m.checkerboard {
                let board = self.checkerboard(fields.get_ref(), bands, &fields.span())?;
                material = Arc::new(Textured::new(material, Box::new(board)));
            }
            if let Some(texture) = &m.texture {
                let picture = self.texture(texture.get_ref(), bands, &texture.span())?;
                material = Arc::new(Textured::new(material, Box::new(picture)));
            }
            done.push((m.name.get_ref().clone(), material));
        }
        Ok(done)
    }

    fn material(&self, m: &Described, bands: &Bands, done: &[Named]) -> Result<Arc<dyn Material>, Error> {
        let mut kinds: Vec<Arc<dyn Material>> = Vec::new();
        if let Some(source) = &m.reflectance {
            let values = self.values(source, bands, &Role::factor("reflectance"))?;
            let lambert = Lambert::new(values).map_err(|e| self.wrong(&source.span(), e))?;
            kinds.push(Arc::new(Opaque::new(Box::new(lambert), !m.one_sided)));
        }
        if let Some(text) = &m.brdf {
            let brdf = self.model(text, bands)?;
            kinds.push(Arc::new(Opaque::new(brdf, !m.one_sided)));
        }
        if let Some(table) = &m.measured {
            kinds.push(Arc::new(self.measured(&table.get_ref().file, bands, !m.one_sided, &table.span())?));
        }
        if let Some(metal) = &m.metal {
            kinds.push(self.metal(metal.get_ref(), bands, &metal.span())?);
        }
        if let Some(glass) = &m.dielectric {
            kinds.push(self.dielectric(glass.get_ref(), bands, &glass.span())?);
        }
        if let Some(pane) = &m.pane {
            kinds.push(self.pane(pane.get_ref(), bands, &pane.span())?);
        }
        if let Some(parts) = &m.mixture {
            let part = |share: &crate::render::description::material::Share| {
                let values = self.values(&share.share, bands, &Role::factor("share"))?;
                Ok((values, self.named(done, &share.material)?))
            };
            let parts_built = parts.get_ref().iter().map(part).collect::<Result<Vec<_>, Error>>()?;
            self.at_most_all(&parts_built, bands, &parts.span())?;
            kinds.push(Arc::new(Mixture::new(parts_built).map_err(|e| self.wrong(&parts.span(), e))?));
        }
        if let Some(dye) = &m.dye {
            let (d, span) = (dye.get_ref(), dye.span());
            let (reflectance, absorption, emission) =
                (Role::factor("reflectance"), Role::absorption("absorption"), Role::emission("emission"));
            if let Colour::Lines(_) = Colour::of(self, &d.absorption, &absorption)? {
                let message = "lines as a dye's `absorption`; expected its share at every wavelength";
                return Err(self.wrong(&d.absorption.span(), message));
            }
            if !Colour::of(self, &d.emission, &emission)?.is_density() {
                let (low, high) = RANGE_NM;
                let message =
                    format!("an `emission` of nothing; expected a density above 0 between {low} and {high} nm");
                return Err(self.wrong(&d.emission.span(), message));
            }
            let reflectance = self.values(&d.reflectance, bands, &reflectance)?;
            let absorption = self.values(&d.absorption, bands, &absorption)?;
            let emission = self.values(&d.emission, bands, &emission)?;
            let nodes = emission.iter().zip(bands.widths()).filter(|(_, width)| **width != Width::Line);
            if let Some(step) = self.description.render.wavelength_step_nm
                && nodes.into_iter().all(|(e, _)| *e == 0.0)
            {
                let message =
                    format!("no wavelength in a dye's `emission`; expected a `wavelength_step_nm` below {step}");
                return Err(self.wrong(&d.emission.span(), message));
            }
            let made = Fluorescent::dye(bands, &reflectance, &absorption, &emission, d.quantum_yield, !m.one_sided);
            kinds.push(Arc::new(made.map_err(|e| self.wrong(&span, e))?));
        }
        let mut kinds = kinds.into_iter();
        let (Some(material), None) = (kinds.next(), kinds.next()) else {
            let message = format!(
                "material `{}` has not one kind; expected one of reflectance, brdf, measured, metal, dielectric, pane, mixture, dye",
                m.name.get_ref()
            );
            return Err(self.wrong(&m.name.span(), message));
        };
        Ok(material)
    }

    /// Shares of a mixture sum to at most 1, in every band.
    fn at_most_all(
        &self,
        parts: &[(Vec<f64>, Arc<dyn Material>)],
        bands: &Bands,
        at: &Range<usize>,
    ) -> Result<(), Error> {
        for (band, nm) in bands.wavelengths_nm().iter().enumerate() {
            let sum: f64 = parts.iter().map(|(shares, _)| shares[band]).sum();
            // As the mixture itself has it: shares such as 0.1 + 0.2 + 0.7 round.
            if sum > 1.0 + 8.0 * f64::EPSILON {
                let same = parts.iter().all(|(shares, _)| shares.iter().all(|s| *s == shares[0]));
                let place = if same { String::new() } else { format!(" at {nm} nm") };
                let sum = (1e9 * sum).round() / 1e9;
                let message = format!("the shares sum to {sum}{place}; expected at most 1");
                return Err(self.wrong(at, message));
            }
        }
        Ok(())
    }

    /// The material of a name, among those that are there already.
    pub(super) fn named(&self, materials: &[Named], wanted: &Spanned<String>) -> Result<Arc<dyn Material>, Error> {
        let found = materials.iter().find(|(name, _)| name == wanted.get_ref());
        let (_, material) = found.ok_or_else(|| {
            let known: Vec<&str> = materials.iter().map(|(n, _)| n.as_str()).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            let message = format!("no material is called `{}`; expected one of: {known}", wanted.get_ref());
            self.wrong(&wanted.span(), message)
        })?;
        Ok(Arc::clone(material))
    }

    fn model(&self, text: &Spanned<String>, bands: &Bands) -> Result<Box<dyn Brdf>, Error> {
        let model = Model::from_str(text.get_ref()).and_then(|m| m.with_spectra(|file| self.files.spectrum(file)));
        let model = model.map_err(|e| place(self, text, &e))?;
        model.prepare(BrdfBands::Wavelengths(bands.wavelengths_nm())).map_err(|e| place(self, text, &e))
    }

    /// What the materials that are described as BRDFs lose to a single scattering, weighed by V(λ).
    pub(super) fn single_scattering(
        &self,
        bands: &Bands,
        quantities: &Quantities,
    ) -> Result<Vec<(String, SingleScattering)>, Error> {
        let mut out = Vec::new();
        for (m, text) in self.description.material.iter().filter_map(|m| Some((m, m.brdf.as_ref()?))) {
            let lost = bias::single_scattering(self.model(text, bands)?.as_ref(), &quantities.luminous);
            if let Some(lost) = lost.map_err(|e| self.wrong(&text.span(), e))? {
                out.push((m.name.get_ref().clone(), lost));
            }
        }
        Ok(out)
    }

    fn metal(&self, metal: &Metal, bands: &Bands, at: &Range<usize>) -> Result<Arc<dyn Material>, Error> {
        let (n, k) = refractive_index(&metal.medium, bands.wavelengths_nm()).map_err(|e| self.wrong(at, e))?;
        let fresnel = Fresnel::conductor(&n, &k).map_err(|e| self.wrong(at, e))?;
        Ok(match metal.alpha {
            None => Arc::new(Opaque::new(Box::new(Specular::new(fresnel)), true)),
            Some(alpha) => {
                let facets = Microfacet::new(Distribution::Ggx([alpha; 2]), Masking::Smith, fresnel);
                let facets = facets.map_err(|e| self.wrong(at, e))?;
                let facets = Compensated::new(facets).map_err(|e| self.wrong(at, e))?;
                Arc::new(Opaque::new(Box::new(facets), true))
            }
        })
    }

    /// The index of a substance by name.
    fn medium(&self, name: &str, bands: &Bands, at: &Range<usize>) -> Result<Vec<f64>, Error> {
        let (n, k) = refractive_index(name, bands.wavelengths_nm()).map_err(|e| self.wrong(at, e))?;
        if k.iter().any(|k| *k > 0.0) {
            let message = format!("`{name}` is no transparent substance; expected BK7, SF10, water, or an index");
            return Err(self.wrong(at, message));
        }
        Ok(n)
    }

    fn dielectric(&self, glass: &Glass, bands: &Bands, at: &Range<usize>) -> Result<Arc<dyn Material>, Error> {
        let inside = match (&glass.medium, &glass.index, &glass.sellmeier, glass.cauchy) {
            (Some(name), None, None, None) => self.medium(name, bands, at)?,
            (None, Some(source), None, None) => self.values(source, bands, &Role::index("index"))?,
            (None, None, Some(terms), None) if terms.b.len() == terms.c_um2.len() => by_formula(bands, |l2| {
                let sum: f64 = terms.b.iter().zip(&terms.c_um2).map(|(b, c)| b * l2 / (l2 - c)).sum();
                (1.0 + sum).sqrt()
            }),
            (None, None, None, Some([a, b, c])) => by_formula(bands, |l2| a + b / l2 + c / (l2 * l2)),
            _ => {
                let message = "not one index; expected one of medium, index, sellmeier (as many b as c_um2), cauchy";
                return Err(self.wrong(at, message));
            }
        };
        let of = |s| self.values(s, bands, &Role::index("outside"));
        let outside = glass.outside.as_ref().map_or(Ok(vec![1.0; bands.len()]), of)?;
        Ok(match glass.alpha {
            None => Arc::new(Dielectric::new(&outside, &inside).map_err(|e| self.wrong(at, e))?),
            Some(alpha) => {
                Arc::new(RoughDielectric::new([alpha; 2], &outside, &inside).map_err(|e| self.wrong(at, e))?)
            }
        })
    }

    fn pane(&self, pane: &Pane, bands: &Bands, at: &Range<usize>) -> Result<Arc<dyn Material>, Error> {
        let index = match (&pane.medium, &pane.index) {
            (Some(name), None) => self.medium(name, bands, at)?,
            (None, Some(source)) => self.values(source, bands, &Role::index("index"))?,
            (medium, _) => return Err(self.not_one(at, medium.is_some(), ["medium", "index"])),
        };
        let of = |s| self.values(s, bands, &Role::factor("transmittance"));
        let passed = pane.transmittance.as_ref().map_or(Ok(vec![1.0; bands.len()]), of)?;
        Ok(Arc::new(ThinSlab::new(&index, &passed).map_err(|e| self.wrong(at, e))?))
    }

    fn texture(&self, t: &DescribedTexture, bands: &Bands, at: &Range<usize>) -> Result<Picture, Error> {
        let picture = self.picture(&t.file, Of::Factors, at)?;
        let basis = picture.spectra(bands, &vec![1.0; bands.len()]);
        let made = Picture::new([picture.width, picture.height], basis, picture.coefficients.clone());
        let made = made.map_err(|e| self.wrong(at, format!("{}: {e}", t.file)))?;
        let repeat = t.repeat.unwrap_or([1.0; 2]);
        if repeat.contains(&0.0) {
            return Err(self.wrong(at, "a `repeat` of 0; expected how often the picture is repeated"));
        }
        Ok(made.repeated(repeat))
    }

    fn checkerboard(&self, fields: &Fields, bands: &Bands, at: &Range<usize>) -> Result<Checkerboard, Error> {
        let even = self.values(&fields.even, bands, &Role::factor("even"))?;
        let odd = self.values(&fields.odd, bands, &Role::factor("odd"))?;
        Checkerboard::new(even, odd, fields.fields).map_err(|e| self.wrong(at, e))
    }
}

/// An index at the bands by a formula of λ², µm².
fn by_formula(bands: &Bands, formula: impl Fn(f64) -> f64) -> Vec<f64> {
    bands.wavelengths_nm().iter().map(|nm| formula((1e-3 * nm) * (1e-3 * nm))).collect()
}

/// How the materials depend on wavelength, as far as the choice of wavelengths goes.
pub(super) fn colours(b: &Builder<'_>) -> Result<Vec<Colour>, Error> {
    let (mut out, mut pictures) = (Vec::new(), Vec::new());
    let mut add = |source: &Spanned<SpectrumSource>, role: Role| {
        out.push(Colour::of(b, source, &role.going_on())?);
        Ok(())
    };
    for m in &b.description.material {
        if let Some(source) = &m.reflectance {
            add(source, Role::factor("reflectance"))?;
        }
        if let Some(board) = &m.checkerboard {
            add(&board.get_ref().even, Role::factor("even"))?;
            add(&board.get_ref().odd, Role::factor("odd"))?;
        }
        if let Some(texture) = &m.texture {
            pictures.extend(b.picture(&texture.get_ref().file, Of::Factors, &texture.span())?.typical());
        }
        if let Some(pane) = &m.pane
            && let Some(source) = &pane.get_ref().transmittance
        {
            add(source, Role::factor("transmittance"))?;
        }
        if let Some(parts) = &m.mixture {
            parts.get_ref().iter().try_for_each(|p| add(&p.share, Role::factor("share")))?;
        }
        if let Some(dye) = &m.dye {
            add(&dye.get_ref().reflectance, Role::factor("reflectance"))?;
        }
    }
    out.append(&mut pictures);
    for m in &b.description.material {
        if let Some(text) = &m.brdf {
            out.push(colour_of(b, text)?);
        }
        if let Some(table) = &m.measured {
            out.append(&mut b.colours_of_table(&table.get_ref().file, &table.span())?);
        }
        if let Some(metal) = &m.metal {
            let bands = Bands::uniform(RANGE_NM.0, 1.0);
            let at = metal.span();
            let (n, k) =
                refractive_index(&metal.get_ref().medium, bands.wavelengths_nm()).map_err(|e| b.wrong(&at, e))?;
            let mut values = vec![0.0; bands.len()];
            Fresnel::conductor(&n, &k).map_err(|e| b.wrong(&at, e))?.write(1.0, 1.0, &mut values);
            out.push(Colour::Table(Weighting::table(bands.wavelengths_nm().to_vec(), values), Edge::Constant));
        }
    }
    Ok(out)
}

/// The dyes of surfaces.
pub(super) fn dyes(b: &Builder<'_>) -> Result<Vec<Dye>, Error> {
    let of_a_surface = |m: &&Described| {
        b.description.shape.iter().filter_map(|s| s.material.as_ref()).any(|name| name.get_ref() == m.name.get_ref())
    };
    let dyes = b.description.material.iter().filter(of_a_surface).filter_map(|m| m.dye.as_ref());
    dyes.map(|dye| {
        let d = dye.get_ref();
        let absorption = Colour::of(b, &d.absorption, &Role::absorption("absorption"))?;
        Ok(Dye { absorption, emission: Colour::of(b, &d.emission, &Role::emission("emission"))? })
    })
    .collect()
}

/// A described BRDF's values for two pairs of directions, one near the mirror direction and one off it, and its mirror's, at 1 nm.
fn colour_of(b: &Builder<'_>, text: &Spanned<String>) -> Result<Colour, Error> {
    let bands = Bands::uniform(RANGE_NM.0, 1.0);
    let brdf = b.model(text, &bands)?;
    let mut sum = vec![0.0; bands.len()];
    let mut values = sum.clone();
    for (incident, outgoing) in [(0.2, 0.2), (1.0, 0.3)] {
        let (i, o) = (direction::from_angles(incident, 0.0), direction::from_angles(outgoing, std::f64::consts::PI));
        brdf.evaluate(i, o, &mut values);
        let scale = values.iter().copied().fold(0.0, f64::max);
        if scale > 0.0 {
            sum.iter_mut().zip(&values).for_each(|(s, v)| *s += v / scale);
        }
    }
    brdf.specular(direction::from_angles(0.2, 0.0), &mut values);
    sum.iter_mut().zip(&values).for_each(|(s, v)| *s += v);
    Ok(Colour::Table(Weighting::table(bands.wavelengths_nm().to_vec(), sum), Edge::Constant))
}
