//! From [`Eulumdat`] to the model.

use super::super::error::{Error, ErrorKind};
use super::super::plausible;
use super::{Eulumdat, Stored, checks, planes};
use crate::finding::{Checked, Location};
use crate::luminaire::{Body, Kind, LampSet, Luminaire, Shape, keyword};

impl Eulumdat {
    /// The luminaire, with one set of lamps (from 0) scaling the intensities: it comes first among the model's sets.
    ///
    /// The intensities are cd/klm × flux of the set / 1000 × conversion factor; a luminaire that was tilted while measured is
    /// not turned back (keyword `_TILT_DEG`). What the file declares is compared with what its table says: findings L210–L219 and those of
    /// [`plausible`].
    ///
    /// # Errors
    /// [`ErrorKind::OutOfRange`] where there is no such set, [`ErrorKind::Table`] where the angles make no table.
    pub fn luminaire(&self, set: usize) -> Result<Checked<Luminaire>, Error> {
        let Some(lamps) = self.lamp_sets.get(set) else {
            return Err(Error::new(
                Location::line(26),
                ErrorKind::OutOfRange {
                    found: format!("set {}", set + 1),
                    field: "the set of lamps".to_owned(),
                    expected: format!("1 to {}", self.lamp_sets.len()),
                },
            ));
        };
        let scale = lamps.flux_lm / 1000.0 * self.conversion_factor;
        let Checked { value: distribution, mut findings } = planes::distribution(self, scale)?;
        findings.extend(checks::check(self, &distribution, set));
        let absolute = lamps.number < 0.0;
        let percent = |p: f64| (p > 0.0).then_some(p / 100.0);
        let output_ratio = percent(self.light_output_ratio_percent);
        let mut order: Vec<usize> = vec![set];
        order.extend((0..self.lamp_sets.len()).filter(|i| *i != set));
        let luminaire = Luminaire {
            name: plain(&self.luminaire_name),
            manufacturer: plain(&self.company),
            catalogue_number: plain(&self.luminaire_number),
            kind: Kind::Luminous,
            distribution,
            absolute,
            lamps: order.into_iter().map(|i| self.lamp_set(i)).collect(),
            input_power_w: lamps.power_w.filter(|w| *w > 0.0),
            declared_flux: if absolute { Some(lamps.flux_lm) } else { output_ratio.map(|r| r * lamps.flux_lm) },
            declared_output_ratio: output_ratio,
            // 0 is what programs write that do not know; it is a statement where all light goes up.
            declared_downward_fraction: (self.downward_flux_percent > 0.0 || output_ratio.is_some())
                .then_some(self.downward_flux_percent / 100.0),
            opening: self.opening(),
            housing: body(self.length_mm, self.width_mm, self.height_mm),
            spectrum: None,
            angular_spectra: None,
            keywords: self.keywords(),
        };
        findings.extend(plausible::check(&luminaire));
        Ok(Checked { value: luminaire, findings })
    }

    fn lamp_set(&self, index: usize) -> LampSet {
        let set = &self.lamp_sets[index];
        LampSet {
            count: (set.number != 0.0).then_some(set.number.abs()),
            name: plain(&set.lamp_type),
            flux_lm: (set.number >= 0.0).then_some(set.flux_lm),
            colour: plain(&set.colour),
            rendering: plain(&set.rendering),
            power_w: set.power_w.filter(|w| *w > 0.0),
        }
    }

    /// The luminous area; the model has one height, the mean of the four, which stay as keyword where they differ.
    fn opening(&self) -> Option<Body> {
        let mean = self.opening_heights_mm.iter().sum::<f64>() / 4.0;
        body(self.opening_length_mm, self.opening_width_mm, mean)
    }

    fn keywords(&self) -> Vec<(String, String)> {
        let mut out = Vec::new();
        let mut keep = |label: &str, value: String| {
            if !value.is_empty() {
                out.push((label.to_owned(), value));
            }
        };
        keep(keyword::REPORT, plain(&self.report_number));
        keep(keyword::FILE, plain(&self.file_name));
        keep(keyword::DATE_USER, plain(&self.date_user));
        keep(keyword::TYPE, self.type_indicator.to_string());
        if self.tilt_deg != 0.0 {
            keep(keyword::TILT_DEG, self.tilt_deg.to_string());
        }
        let heights = self.opening_heights_mm;
        if heights.iter().any(|h| *h != heights[0]) {
            keep(keyword::HEIGHTS, heights.map(|h| h.to_string()).join(" "));
        }
        if self.direct_ratios.iter().any(|r| *r != 0.0) {
            keep(keyword::DIRECT_RATIOS, self.direct_ratios.map(|r| r.to_string()).join(" "));
        }
        out
    }

    /// How many planes have intensities.
    #[must_use]
    pub fn stored_plane_count(&self) -> usize {
        match &self.stored {
            Stored::One => 1,
            Stored::All => self.plane_angles_deg.len(),
            Stored::Some(indices) => indices.len(),
        }
    }
}

/// The bridge: the first set of lamps scales.
impl TryFrom<&Eulumdat> for Checked<Luminaire> {
    type Error = Error;

    fn try_from(file: &Eulumdat) -> Result<Self, Error> {
        file.luminaire(0)
    }
}

/// A body of millimetres, if it has an extent; width 0 is round.
fn body(length_mm: f64, width_mm: f64, height_mm: f64) -> Option<Body> {
    let metres = |mm: f64| mm.max(0.0) / 1000.0;
    let (length_m, width_m, height_m) = (metres(length_mm), metres(width_mm), metres(height_mm));
    if length_m == 0.0 && width_m == 0.0 {
        return None;
    }
    Some(if width_m == 0.0 {
        Body { shape: Shape::Round, length_m, width_m: length_m, height_m }
    } else {
        Body { shape: Shape::Rectangle, length_m, width_m, height_m }
    })
}

/// A text without the quotation marks that some programs put around it.
fn plain(text: &str) -> String {
    let text = text.trim();
    let inner = text.strip_prefix('"').and_then(|t| t.strip_suffix('"')).unwrap_or(text);
    inner.trim().to_owned()
}
