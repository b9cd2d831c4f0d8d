//! What a gonioreflectometer measured, in the bins of a MERL table.
//!
//! A bin holds the mean of the cells whose middles lie in it; one without a cell is missing, for nothing is put between cells. Bins are
//! some degrees wide at most, and where the half vector is near the normal far less (0.01° to 1°), so that cells of usual steps leave most of
//! them empty.
//!
//! Red, green and blue are the values at [`RGB_NM`], on straight lines between the wavelengths measured; of a single wavelength they are all
//! the same.

use super::Measured;
use crate::brdf::format::convert::RGB_NM;
use crate::brdf::table::{Channel, Error, HalfAngle, Resolution};
use crate::finding::{Checked, Finding};
use crate::geometry::direction::from_degrees;
use crate::render::bands::Bands;

impl Measured {
    /// The table, with what it cannot hold of the measurement: directions between cells, turns of the sample, wavelengths, errors.
    ///
    /// # Errors
    /// [`Error::Wavelength`] where red, green or blue is beyond the wavelengths measured.
    pub fn bins(&self, bands: &Bands) -> Result<Checked<HalfAngle>, Error> {
        let resolution = Resolution::MERL;
        let wavelengths = bands.wavelengths_nm();
        let parts = parts(wavelengths)?;
        let empty = HalfAngle::new(resolution, Channel::rgb(), vec![f32::NAN; 3 * resolution.bins()])?;
        let (mut sums, mut counts) = (vec![[0.0; 3]; resolution.bins()], vec![0_u32; resolution.bins()]);
        let (mut largest, mut peak) = (0.0_f64, 0.0_f64);
        for lobe in &self.lobes {
            let incident = from_degrees(lobe.incident_deg[0], lobe.incident_deg[1]);
            for (cell, figures) in lobe.values.chunks(wavelengths.len()).enumerate() {
                let (row, column) = (cell / self.phi_deg.len(), cell % self.phi_deg.len());
                // The normal has one direction, whatever its azimuth.
                if row == 0 && column > 0 {
                    continue;
                }
                let bin = empty.bin_of(incident, from_degrees(self.theta_deg[row], self.phi_deg[column]));
                counts[bin] += 1;
                for (sum, part) in sums[bin].iter_mut().zip(&parts) {
                    *sum += part.iter().map(|(band, share)| share * figures[*band].value).sum::<f64>();
                }
                largest = figures.iter().fold(largest, |most, f| most.max(f.standard_error));
                peak = figures.iter().fold(peak, |most, f| most.max(f.value));
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "kept in single precision")]
        let mean = |(sum, count): (&[f64; 3], &u32)| sum.map(|sum| (sum / f64::from(*count)) as f32);
        let values = sums.iter().zip(&counts).flat_map(mean).collect();
        let held = counts.iter().filter(|count| **count > 0).count();
        Ok(Checked {
            value: HalfAngle::new(resolution, Channel::rgb(), values)?,
            findings: self.lost(wavelengths, (held, above(resolution)), (largest, peak)),
        })
    }

    /// What the table does not hold: of so many bins, with standard errors up to so much beside so large a value.
    fn lost(&self, nm: &[f64], (held, bins): (usize, usize), (error, peak): (f64, f64)) -> Vec<Finding> {
        let words = format!(
            "{held} of {bins} bins of the MERL table hold a cell of the measurement, all others are marked as missing; a CSV file holds the measurement itself"
        );
        let mut findings = vec![Finding::warning("R008", words)];
        let first = self.lobes[0].incident_deg[1];
        #[expect(clippy::float_cmp, reason = "azimuths as they were given")]
        if self.lobes.iter().any(|lobe| lobe.incident_deg[1] != first) {
            let words =
                "the MERL table has no place for turns of the sample: all azimuths of incidence are in one mean";
            findings.push(Finding::warning("R008", words));
        }
        let bands = match nm {
            [one] => format!("all three of the value at {one} nm"),
            _ => "of the values at 650, 550 and 450 nm, on straight lines between the wavelengths measured".to_owned(),
        };
        let words = format!(
            "the MERL table's red, green and blue are {bands}; it has no place for standard errors, which are up to {error:.2e} beside values up to {peak:.2e} per sr"
        );
        findings.push(Finding::info("R008", words));
        findings
    }
}

/// Bins in whose middle both directions are above the horizon.
fn above(resolution: Resolution) -> usize {
    let is_above = |bin: &usize| {
        let (i, o) = resolution.centre(*bin).directions();
        i.z > 0.0 && o.z > 0.0
    };
    (0..resolution.bins()).filter(is_above).count()
}

/// Of red, green and blue: two bands each, with their shares.
fn parts(wavelengths_nm: &[f64]) -> Result<[[(usize, f64); 2]; 3], Error> {
    if let [_] = wavelengths_nm {
        return Ok([[(0, 1.0), (0, 0.0)]; 3]);
    }
    let mut order: Vec<usize> = (0..wavelengths_nm.len()).collect();
    order.sort_by(|a, b| wavelengths_nm[*a].total_cmp(&wavelengths_nm[*b]));
    let nm = |place: usize| wavelengths_nm[order[place]];
    let mut parts = [[(0, 0.0); 2]; 3];
    for (part, wanted) in parts.iter_mut().zip(RGB_NM) {
        let after = order.partition_point(|band| wavelengths_nm[*band] < wanted);
        *part = if after < order.len() && nm(after) <= wanted {
            [(order[after], 1.0), (order[after], 0.0)]
        } else if after > 0 && after < order.len() {
            let share = (wanted - nm(after - 1)) / (nm(after) - nm(after - 1));
            [(order[after - 1], 1.0 - share), (order[after], share)]
        } else {
            return Err(Error::Wavelength { found: wanted, low: nm(0), high: nm(order.len() - 1) });
        };
    }
    Ok(parts)
}
