//! A measured table, with its own interpolation, on the bands of a render.
//!
//! ```text
//! f(λ_b) = Σ_c s_c(λ_b) max(f_c, 0)      f_c the table's channels, s_c what a channel is in the bands
//! ```
//!
//! - **Values** are those of [`Table`](crate::brdf::table::Table) as a [`Brdf`]: where nothing was measured its best guess. Values below 0,
//!   which noise about 0 brings, count as 0: a path cannot carry less than no light.
//! - **Directions** are drawn by [`SampledTable`]: a cosine, a lobe about the mirror direction and one back to the light, as the table reflects. The
//!   cosine reaches all directions above the horizon, so nothing is biased by the shape of the lobes.
//! - **Reciprocity** is that of the table. Those that are not reciprocal are asked for the light's direction and the observer's as they are,
//!   whether a path comes from the light or from the sensor.
//! - **Albedo** is a quadrature to 1e-4 at best; it may be above 1, as the instrument has it.

use std::sync::Arc;

use glam::DVec3;

use super::opaque::{flipped, upright};
use super::{Material, Nature, Scattered, Transport};
use crate::brdf::parameter::{Error, Parameter, same_bands};
use crate::brdf::table::SampledTable;
use crate::brdf::{Brdf, Sampled, reflectance, sample_by};

/// What a channel of a table is in the bands.
pub const CHANNEL: Parameter = Parameter::spectral("channel", f64::MIN, f64::MAX, "spectrum of a table's channel");

/// Channels that are carried without allocating; more are taken from the heap where the bands are not the channels themselves.
const FEW: usize = 64;

/// A surface as it was measured.
#[derive(Debug)]
pub struct Measured {
    brdf: OnBands,
    two_sided: bool,
}

/// The table on the bands.
#[derive(Debug)]
struct OnBands {
    table: Arc<SampledTable>,
    bands: usize,
    /// The channels that are not 0 in each band, as many for all bands, and their factors; empty where the bands are the channels.
    parts: Vec<(usize, f64)>,
    /// No value of the table is below 0.
    positive: bool,
}

impl Measured {
    /// A table whose channels stand for these spectra on the bands, one for each; a one-sided surface is black from the inside.
    ///
    /// # Errors
    /// [`Error::Bands`] for another number of spectra than channels or spectra of different lengths, [`Error::Range`] for a factor that is not
    /// finite.
    pub fn new(table: Arc<SampledTable>, spectra: &[Vec<f64>], two_sided: bool) -> Result<Self, Error> {
        let channels = table.bands();
        same_bands(channels, &[("channels", spectra.len())])?;
        let bands = spectra.first().map_or(0, Vec::len);
        for spectrum in spectra {
            same_bands(bands, &[("channel", spectrum.len())])?;
            CHANNEL.check_all(spectrum)?;
        }
        let own = bands == channels
            && (spectra.iter().enumerate())
                .all(|(c, s)| s.iter().enumerate().all(|(b, v)| *v == if b == c { 1.0 } else { 0.0 }));
        let of_band = |band: usize| -> Vec<(usize, f64)> {
            (spectra.iter().enumerate()).map(|(c, s)| (c, s[band])).filter(|(_, factor)| *factor != 0.0).collect()
        };
        let mut rows: Vec<_> = if own { Vec::new() } else { (0..bands).map(of_band).collect() };
        let width = rows.iter().map(Vec::len).max().unwrap_or(0).max(1);
        rows.iter_mut().for_each(|row| row.resize(width, (0, 0.0)));
        let positive = table.table().range().is_none_or(|[least, _]| least >= 0.0);
        let brdf = OnBands { table, bands, parts: rows.concat(), positive };
        Ok(Self { brdf, two_sided })
    }
}

impl OnBands {
    /// Writes the bands' values of what is given per channel.
    fn mix(&self, channels: &[f64], values: &mut [f64]) {
        let width = self.parts.len() / self.bands.max(1);
        for (value, parts) in values.iter_mut().zip(self.parts.chunks_exact(width)) {
            // Colours at the rim of what the parts of white light make are rounded to below 0.
            *value = parts.iter().map(|(c, factor)| factor * channels[*c]).sum::<f64>().max(0.0);
        }
    }

    /// Writes bands from what `channels` writes per channel.
    fn write<T>(&self, values: &mut [f64], channels: impl FnOnce(&mut [f64]) -> T) -> T {
        if self.parts.is_empty() {
            return channels(values);
        }
        let n = self.table.bands();
        let (mut few, mut many) = ([0.0; FEW], Vec::new());
        let scratch = if n <= FEW {
            &mut few[..n]
        } else {
            many.resize(n, 0.0);
            &mut many[..]
        };
        let out = channels(scratch);
        self.mix(scratch, values);
        out
    }
}

impl Brdf for OnBands {
    fn bands(&self) -> usize {
        self.bands
    }

    fn is_isotropic(&self) -> bool {
        self.table.is_isotropic()
    }

    fn is_tabulated(&self) -> bool {
        true
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        self.write(values, |channels| {
            self.table.evaluate(incident, outgoing, channels);
            channels.iter_mut().for_each(|c| *c = c.max(0.0));
        });
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let incident = if outgoing.z > 0.0 { self.table.draw(outgoing, u)? } else { return None };
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        self.table.pdf(outgoing, incident)
    }

    fn albedo(&self, incident: DVec3, albedo: &mut [f64]) -> f64 {
        if self.positive {
            // There are fewer channels than bands, and patches have a closed form.
            return self.write(albedo, |channels| self.table.albedo(incident, channels));
        }
        reflectance::directional(self, incident, &reflectance::Cone::HEMISPHERE, albedo)
    }
}

impl Material for Measured {
    fn evaluate(&self, incident: DVec3, outgoing: DVec3, transport: Transport, values: &mut [f64]) {
        match (upright(self.two_sided, incident, outgoing), transport) {
            (Some((i, o)), Transport::Radiance) => self.brdf.evaluate(i, o, values),
            // A path from the light: what it came from is the light's direction.
            (Some((i, o)), Transport::Flux) => self.brdf.evaluate(o, i, values),
            (None, _) => values.fill(0.0),
        }
    }

    fn sample(
        &self,
        outgoing: DVec3,
        u: [f64; 3],
        transport: Transport,
        _hero: usize,
        weights: &mut [f64],
    ) -> Option<Scattered> {
        let below = outgoing.z < 0.0;
        if below && !self.two_sided {
            return None;
        }
        let outgoing = if below { flipped(outgoing) } else { outgoing };
        let drawn = match transport {
            Transport::Radiance => self.brdf.sample(outgoing, u, weights)?,
            Transport::Flux => Backwards(&self.brdf).sample(outgoing, u, weights)?,
        };
        let direction = if below { flipped(drawn.incident) } else { drawn.incident };
        Some(Scattered { direction, pdf: drawn.pdf, delta: false, split: false, eta: 1.0 })
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3, _hero: usize) -> f64 {
        upright(self.two_sided, incident, outgoing).map_or(0.0, |(i, o)| self.brdf.pdf(o, i))
    }

    fn nature(&self) -> Nature {
        Nature { anisotropic: !self.brdf.is_isotropic(), ..Nature::default() }
    }

    fn albedo(&self, arriving: DVec3, share: &mut [f64]) -> Option<f64> {
        if let Some((i, _)) = upright(self.two_sided, arriving, arriving) {
            return Some(self.brdf.albedo(i, share));
        }
        share.fill(0.0);
        Some(0.0)
    }
}

/// The table with light and observer exchanged, for paths from the light.
#[derive(Debug)]
struct Backwards<'a>(&'a OnBands);

impl Brdf for Backwards<'_> {
    fn bands(&self) -> usize {
        self.0.bands()
    }

    fn is_isotropic(&self) -> bool {
        self.0.is_isotropic()
    }

    fn evaluate(&self, incident: DVec3, outgoing: DVec3, values: &mut [f64]) {
        self.0.evaluate(outgoing, incident, values);
    }

    fn sample(&self, outgoing: DVec3, u: [f64; 3], weights: &mut [f64]) -> Option<Sampled> {
        let incident = if outgoing.z > 0.0 { self.0.table.draw(outgoing, u)? } else { return None };
        sample_by(self, outgoing, incident, weights)
    }

    fn pdf(&self, outgoing: DVec3, incident: DVec3) -> f64 {
        self.0.pdf(outgoing, incident)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::brdf::coordinates::Parameterisation;
    use crate::brdf::table::{Channel, Points, Table};
    use crate::geometry::direction::from_degrees;

    /// Points of an isotropic sample: θ_i, θ_o, φ_o in degrees and the values of the channels.
    fn points(channels: usize, rows: &[(f64, f64, f64, &[f64])]) -> Arc<SampledTable> {
        let channels = (0..channels).map(|n| Channel::Named(format!("c{n}"))).collect();
        let places = rows.iter().map(|r| (from_degrees(r.0, 0.0), from_degrees(r.1, r.2))).collect();
        let values = rows.iter().flat_map(|r| r.3.iter().copied()).collect();
        let table = Points::new(Parameterisation::ViewLightAzimuth, channels, places, values).expect("points");
        Arc::new(SampledTable::new(Table::from(table)))
    }

    fn value(material: &Measured, i: DVec3, o: DVec3, transport: Transport) -> Vec<f64> {
        let mut values = vec![f64::NAN; material.brdf.bands];
        material.evaluate(i, o, transport, &mut values);
        values
    }

    /// Bands are sums of channels times their spectra; a channel below 0 counts as 0, in its albedo as well.
    #[test]
    fn channels_become_bands() {
        let table = points(2, &[(0.0, 0.0, 0.0, &[0.1, -0.2]), (40.0, 40.0, 180.0, &[0.1, -0.2])]);
        let spectra = [vec![1.0, 0.5, 0.0], vec![0.0, 0.5, 1.0]];
        let material = Measured::new(Arc::clone(&table), &spectra, true).expect("two channels");
        let (i, o) = (from_degrees(20.0, 0.0), from_degrees(50.0, 130.0));
        for (found, expected) in value(&material, i, o, Transport::Radiance).iter().zip([0.1, 0.05, 0.0]) {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
        let mut share = [0.0; 3];
        let error = Material::albedo(&material, i, &mut share).expect("known");
        assert!(share.iter().zip([0.1, 0.05, 0.0]).all(|(s, e)| (s - PI * e).abs() < 1e-4 + error), "{share:?}");
        // One spectrum per channel, all as long.
        assert!(Measured::new(Arc::clone(&table), &spectra[..1], true).is_err());
        assert!(Measured::new(Arc::clone(&table), &[vec![1.0], vec![1.0, 2.0]], true).is_err());
        assert!(Measured::new(table, &[vec![1.0], vec![f64::NAN]], true).is_err());
    }

    /// The inside is black or alike; nothing passes through.
    #[test]
    fn sides_are_kept() {
        let table = points(1, &[(0.0, 0.0, 0.0, &[0.2])]);
        let (i, o) = (from_degrees(20.0, 0.0), from_degrees(50.0, 130.0));
        for (two_sided, inside) in [(true, 0.2), (false, 0.0)] {
            let material = Measured::new(Arc::clone(&table), &[vec![1.0]], two_sided).expect("one channel");
            let at = |i, o| value(&material, i, o, Transport::Radiance)[0];
            assert_eq!([at(i, o), at(flipped(i), flipped(o)), at(i, flipped(o))], [0.2, inside, 0.0]);
            let drawn = material.sample(flipped(o), [0.3; 3], Transport::Radiance, 0, &mut [0.0]);
            assert_eq!(drawn.is_some_and(|d| d.direction.z < 0.0), two_sided);
        }
    }

    /// A table that is not reciprocal is asked for the light and the observer as they are, from whichever end a path comes.
    #[test]
    fn paths_from_the_light_ask_for_the_same_pair() {
        let (a, b) = (from_degrees(10.0, 0.0), from_degrees(60.0, 180.0));
        let table = points(1, &[(10.0, 60.0, 180.0, &[0.1]), (60.0, 10.0, 180.0, &[0.3])]);
        let material = Measured::new(table, &[vec![1.0]], false).expect("one channel");
        let close = |found: Vec<f64>, expected: f64| assert!((found[0] - expected).abs() < 1e-12, "{found:?}");
        close(value(&material, a, b, Transport::Radiance), 0.1);
        close(value(&material, b, a, Transport::Flux), 0.1);
        close(value(&material, b, a, Transport::Radiance), 0.3);
        // Drawn for light that arrives under 60°, the weight belongs to the pair that the light sees.
        let arriving = from_degrees(60.0, 0.0);
        let mut weights = [0.0];
        let drawn = material.sample(arriving, [0.9, 0.3, 0.6], Transport::Flux, 0, &mut weights).expect("above");
        let f = value(&material, arriving, drawn.direction, Transport::Radiance)[0];
        let pdf = material.pdf(arriving, drawn.direction, 0);
        assert!((weights[0] - f * drawn.direction.z / pdf).abs() < 1e-12);
    }
}
