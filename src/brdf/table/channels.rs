//! Other bands of a table: some of its channels, or wavelengths between its own.

use super::{Adaptive, Channel, Error, HalfAngle, Table};

/// New channels, each a mix of two of those there are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mix {
    pub(super) channels: Vec<Channel>,
    /// Index and weight of the two.
    pub(super) parts: Vec<[(usize, f64); 2]>,
    /// Number of channels that are mixed.
    of: usize,
}

impl Mix {
    /// The new values of places whose channels stand side by side.
    pub(super) fn interleaved(&self, values: &[f64]) -> Vec<f64> {
        let place = |old: &[f64]| self.parts.iter().map(|p| mixed(*p, |i| old[i])).collect::<Vec<_>>();
        values.chunks_exact(self.of).flat_map(place).collect()
    }
}

pub(super) fn mixed([(a, s), (b, t)]: [(usize, f64); 2], value: impl Fn(usize) -> f64) -> f64 {
    if t == 0.0 { s * value(a) } else { s * value(a) + t * value(b) }
}

impl Table {
    /// The table at other wavelengths, linear between its own.
    ///
    /// # Errors
    /// [`Error::Channel`] where its channels are no wavelengths, [`Error::Wavelength`] for one outside of them.
    pub fn at_wavelengths(&self, wavelengths_nm: &[f64]) -> Result<Self, Error> {
        let mut own: Vec<(f64, usize)> = Vec::new();
        for (i, channel) in self.channels().iter().enumerate() {
            let Channel::Wavelength(nm) = channel else {
                return Err(Error::Channel { found: "wavelengths".to_owned(), expected: self.channel_names() });
            };
            own.push((*nm, i));
        }
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        let part = |nm: &f64| {
            let above = own.partition_point(|(w, _)| w < nm);
            match (own.get(above), above.checked_sub(1).map(|i| own[i])) {
                (Some(&(w, i)), _) if w == *nm => Ok([(i, 1.0), (i, 0.0)]),
                (Some(&(high, j)), Some((low, i))) => {
                    let t = (nm - low) / (high - low);
                    Ok([(i, 1.0 - t), (j, t)])
                }
                _ => Err(Error::Wavelength { found: *nm, low: own[0].0, high: own[own.len() - 1].0 }),
            }
        };
        let parts = wavelengths_nm.iter().map(part).collect::<Result<Vec<_>, _>>()?;
        let channels = wavelengths_nm.iter().map(|nm| Channel::Wavelength(*nm)).collect();
        Ok(self.mixed(&Mix { channels, parts, of: self.channels().len() }))
    }

    /// Some of the table's channels by their names (`R`, `550 nm`), in the order asked for.
    ///
    /// # Errors
    /// [`Error::Channel`] for a name that it does not have.
    pub fn of_channels(&self, names: &[String]) -> Result<Self, Error> {
        let find = |name: &String| {
            let found = self.channels().iter().position(|c| c.to_string().eq_ignore_ascii_case(name.trim()));
            found.ok_or_else(|| Error::Channel { found: format!("`{name}`"), expected: self.channel_names() })
        };
        let chosen = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        let channels = chosen.iter().map(|i| self.channels()[*i].clone()).collect();
        let parts = chosen.into_iter().map(|i| [(i, 1.0), (i, 0.0)]).collect();
        Ok(self.mixed(&Mix { channels, parts, of: self.channels().len() }))
    }

    fn channel_names(&self) -> String {
        self.channels().iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    }

    fn mixed(&self, mix: &Mix) -> Self {
        match self {
            Self::HalfAngle(t) => Self::HalfAngle(half_angle(t, mix)),
            Self::Angular(t) => Self::Angular(t.mixed(mix)),
            Self::Specular(t) => Self::Specular(t.mixed(mix)),
            Self::Patches(t) => Self::Patches(t.mixed(mix)),
            Self::Points(t) => Self::Points(t.mixed(mix)),
            Self::Adaptive(t) => Self::Adaptive(Adaptive::mixed(t, mix)),
        }
    }
}

fn half_angle(table: &HalfAngle, mix: &Mix) -> HalfAngle {
    let bins = 0..table.resolution().bins();
    #[expect(clippy::cast_possible_truncation, reason = "kept in single precision")]
    let values = bins.flat_map(|b| mix.parts.iter().map(move |p| mixed(*p, |i| f64::from(table.bin(b)[i])) as f32));
    let values = values.collect();
    HalfAngle::new(table.resolution(), mix.channels.clone(), values).expect("the bins of a table")
}
