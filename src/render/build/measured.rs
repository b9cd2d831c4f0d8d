//! Measured tables of materials: read once, brought to the bands, asked for their colours and for what they give back.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::Builder;
use super::colour::{Colour, Edge};
use super::material::Named;
use super::picture::parts_of_srgb;
use crate::brdf::Brdf;
use crate::brdf::table::{Channel, SampledTable};
use crate::geometry::direction::from_degrees;
use crate::render::bands::Bands;
use crate::render::description::Error;
use crate::render::material::measured::Measured;
use crate::render::material::{Material, Transport};
use crate::spectrum::integrate::Weighting;

/// Tables by file.
#[derive(Debug, Default)]
pub(super) struct Tables {
    /// With their own channels.
    read: RefCell<HashMap<String, Arc<SampledTable>>>,
    /// With the bands as channels, where those are fewer.
    on_bands: RefCell<HashMap<String, Arc<SampledTable>>>,
}

/// A measured material that gives back more than it gets: noise of its instrument, or another scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Gain {
    /// Its name.
    pub material: String,
    /// The largest reflectance of any band that was found, above 1.
    pub reflectance: f64,
    /// Under which angle to the normal the light arrives then, degrees.
    pub theta_deg: f64,
    /// Line of the scene where the table is asked for, from 1.
    pub line: u64,
    /// Column there, from 1.
    pub column: u64,
}

/// What a table's channels stand for.
enum Kind {
    /// Wavelengths, nm, each with its channel, rising.
    Wavelengths(Vec<(f64, usize)>),
    /// Red, green and blue, with their channels.
    Rgb([usize; 3]),
    /// The same for all wavelengths.
    Grey,
}

/// Directions of light that a table is asked for its reflectance: θ and φ, degrees.
const LIT_DEG: [(f64, f64); 6] = [(0.0, 0.0), (30.0, 0.0), (30.0, 90.0), (60.0, 0.0), (60.0, 90.0), (80.0, 0.0)];
/// Draws for one of them; well spread, they tell the reflectance to a per cent.
const DRAWS: u32 = 1024;
/// A reflectance that is worth a word: tables are known to some per cent.
const WORTH_SAYING: f64 = 1.02;

/// Points well spread in the cube: multiples of powers of 1/p modulo 1, p the root of p⁴ = p + 1 (M. Roberts 2018).
fn spread() -> impl Iterator<Item = [f64; 3]> {
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_3];
    (0..DRAWS).map(|n| STEPS.map(|step| (0.5 + f64::from(n) * step).fract()))
}

fn kind(channels: &[Channel]) -> Result<Kind, String> {
    let wavelengths = channels.iter().enumerate().map(|(i, channel)| match channel {
        Channel::Wavelength(nm) => Some((*nm, i)),
        Channel::Named(_) => None,
    });
    if let Some(mut own) = wavelengths.collect::<Option<Vec<_>>>() {
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        own.dedup_by(|a, b| a.0 == b.0);
        return Ok(Kind::Wavelengths(own));
    }
    if channels.len() == 1 {
        return Ok(Kind::Grey);
    }
    let named = |name: &str| channels.iter().position(|c| c.to_string().eq_ignore_ascii_case(name));
    match (named("R"), named("G"), named("B")) {
        (Some(r), Some(g), Some(b)) if channels.len() == 3 => Ok(Kind::Rgb([r, g, b])),
        _ => {
            let names: Vec<String> = channels.iter().take(6).map(ToString::to_string).collect();
            Err(format!("a table of {}; expected wavelengths, red, green and blue, or one channel", names.join(", ")))
        }
    }
}

impl Builder<'_> {
    /// The table of a file, read once, and what its channels are.
    fn table(&self, file: &str, at: &Range<usize>) -> Result<(Arc<SampledTable>, Kind), Error> {
        let known = self.tables.read.borrow().get(file).cloned();
        let table = match known {
            Some(known) => known,
            None => {
                let read = self.files.table(file).map_err(|e| self.wrong(at, e))?;
                let table = Arc::new(SampledTable::new(read));
                self.tables.read.borrow_mut().insert(file.to_owned(), Arc::clone(&table));
                table
            }
        };
        let kind = kind(table.table().channels()).map_err(|e| self.wrong(at, format!("{file}: {e}")))?;
        Ok((table, kind))
    }

    /// The material of a file's table: wavelengths linearly between the table's own and beyond them as at their end, red, green and blue as
    /// parts of white light, and one channel as it is.
    pub(super) fn measured(
        &self,
        file: &str,
        bands: &Bands,
        two_sided: bool,
        at: &Range<usize>,
    ) -> Result<Measured, Error> {
        let (table, kind) = self.table(file, at)?;
        let nm = bands.wavelengths_nm();
        let (table, spectra) = match kind {
            Kind::Grey => (table, vec![vec![1.0; nm.len()]]),
            Kind::Rgb(places) => {
                let mut spectra = vec![Vec::new(); 3];
                let parts = parts_of_srgb();
                for (colour, place) in places.into_iter().enumerate() {
                    let of = |nm: &f64| parts.iter().map(|(part, row)| part.at(*nm) * row[colour]).sum();
                    spectra[place] = nm.iter().map(of).collect();
                }
                (table, spectra)
            }
            Kind::Wavelengths(own) if bands.len() < own.len() => {
                let one = |b: usize| (0..bands.len()).map(|c| if b == c { 1.0 } else { 0.0 }).collect();
                (self.on_bands(file, &table, &own, bands), (0..bands.len()).map(one).collect())
            }
            Kind::Wavelengths(own) => {
                let mut spectra = vec![vec![0.0; nm.len()]; table.bands()];
                for (hat, (_, channel)) in own.iter().enumerate() {
                    spectra[*channel] = nm.iter().map(|nm| share(&own, hat, *nm)).collect();
                }
                (table, spectra)
            }
        };
        Measured::new(table, &spectra, two_sided).map_err(|e| self.wrong(at, format!("{file}: {e}")))
    }

    /// The table with the bands as channels.
    fn on_bands(&self, file: &str, table: &SampledTable, own: &[(f64, usize)], bands: &Bands) -> Arc<SampledTable> {
        if let Some(known) = self.tables.on_bands.borrow().get(file) {
            return Arc::clone(known);
        }
        let (first, last) = (own[0].0, own[own.len() - 1].0);
        let within: Vec<f64> = bands.wavelengths_nm().iter().map(|nm| nm.clamp(first, last)).collect();
        let mixed = table.table().at_wavelengths(&within).expect("wavelengths within those of the table");
        let mixed = Arc::new(SampledTable::new(mixed));
        self.tables.on_bands.borrow_mut().insert(file.to_owned(), Arc::clone(&mixed));
        mixed
    }

    /// How a file's table depends on wavelength, as far as the choice of wavelengths goes: its reflectances for light from some directions, the
    /// parts of white light that red, green and blue become.
    pub(super) fn colours_of_table(&self, file: &str, at: &Range<usize>) -> Result<Vec<Colour>, Error> {
        let (table, kind) = self.table(file, at)?;
        let own = match kind {
            Kind::Grey => return Ok(Vec::new()),
            Kind::Rgb(_) => return Ok(parts_of_srgb().map(|(part, _)| part).to_vec()),
            Kind::Wavelengths(own) if own.len() == 1 => return Ok(Vec::new()),
            Kind::Wavelengths(own) => own,
        };
        let mut weights = vec![0.0; table.bands()];
        let of = |(theta, phi): (f64, f64)| {
            let mut sum = vec![0.0; weights.len()];
            for u in spread() {
                if table.sample(from_degrees(theta, phi), u, &mut weights).is_some() {
                    sum.iter_mut().zip(&weights).for_each(|(s, w)| *s += w.max(0.0) / f64::from(DRAWS));
                }
            }
            let (nm, values): (Vec<f64>, Vec<f64>) = own.iter().map(|(nm, channel)| (*nm, sum[*channel])).unzip();
            Colour::Table(Weighting::table(nm, values), Edge::Constant)
        };
        Ok([LIT_DEG[1], LIT_DEG[3]].map(of).to_vec())
    }

    /// The measured materials that give back more than they get.
    pub(super) fn gains(&self, materials: &[Named], bands: usize) -> Vec<Gain> {
        let gain = |(described, (name, material)): (&crate::render::description::material::Material, &Named)| {
            let at = described.measured.as_ref()?.span();
            let (reflectance, theta_deg) = (LIT_DEG.iter())
                .map(|&(theta, phi)| (most_reflected(material.as_ref(), theta, phi, bands), theta))
                .max_by(|a, b| a.0.total_cmp(&b.0))?;
            let Error { line, column, .. } = self.wrong(&at, "");
            (reflectance > WORTH_SAYING).then(|| Gain { material: name.clone(), reflectance, theta_deg, line, column })
        };
        self.description.material.iter().zip(materials).filter_map(gain).collect()
    }
}

/// The largest reflectance of any band for light from a direction, to a per cent.
fn most_reflected(material: &dyn Material, theta: f64, phi: f64, bands: usize) -> f64 {
    let (mut sum, mut weights) = (vec![0.0; bands], vec![0.0; bands]);
    for u in spread() {
        if material.sample(from_degrees(theta, phi), u, Transport::Flux, 0, &mut weights).is_some() {
            sum.iter_mut().zip(&weights).for_each(|(s, w)| *s += w);
        }
    }
    sum.into_iter().fold(0.0, f64::max) / f64::from(DRAWS)
}

/// The share of one of a table's wavelengths in the value at another: linear between neighbours, all of the first or last beyond them.
fn share(own: &[(f64, usize)], hat: usize, nm: f64) -> f64 {
    let nm = nm.clamp(own[0].0, own[own.len() - 1].0);
    let here = own[hat].0;
    let neighbour = if nm < here { hat.checked_sub(1) } else { Some(hat + 1).filter(|n| *n < own.len()) };
    match neighbour {
        _ if nm == here => 1.0,
        Some(n) => (1.0 - (nm - here) / (own[n].0 - here)).max(0.0),
        None => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nm(all: &[f64]) -> Vec<Channel> {
        all.iter().map(|nm| Channel::Wavelength(*nm)).collect()
    }

    #[test]
    fn channels_are_wavelengths_colours_or_one() {
        let Ok(Kind::Wavelengths(own)) = kind(&nm(&[600.0, 500.0])) else { panic!("wavelengths") };
        assert_eq!(own, [(500.0, 1), (600.0, 0)]);
        let named = |names: &[&str]| names.iter().map(|n| Channel::Named((*n).to_owned())).collect::<Vec<_>>();
        assert!(matches!(kind(&named(&["b", "r", "g"])), Ok(Kind::Rgb([1, 2, 0]))));
        assert!(matches!(kind(&named(&["Visible"])), Ok(Kind::Grey)));
        let wrong = kind(&named(&["X", "Y", "Z"])).err().expect("not yet known");
        assert_eq!(wrong, "a table of X, Y, Z; expected wavelengths, red, green and blue, or one channel");
    }

    #[test]
    fn wavelengths_are_hats_that_go_on_beyond_their_ends() {
        let own = [(500.0, 1), (600.0, 0), (650.0, 2)];
        for (nm, expected) in [
            (400.0, [1.0, 0.0, 0.0]),
            (500.0, [1.0, 0.0, 0.0]),
            (525.0, [0.75, 0.25, 0.0]),
            (600.0, [0.0, 1.0, 0.0]),
            (640.0, [0.0, 0.2, 0.8]),
            (800.0, [0.0, 0.0, 1.0]),
        ] {
            let found = [0, 1, 2].map(|hat| share(&own, hat, nm));
            assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-15), "{nm}: {found:?}");
        }
    }
}
