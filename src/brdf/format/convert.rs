//! Materials of any kind as what files of another kind hold: bins for MERL, points for ALTA and CSV.
//!
//! What such a file cannot carry is told in findings: where nothing was measured, which turn of an anisotropic sample was taken, the
//! names of channels, the shape of a grid.

use glam::DVec3;

use crate::brdf::Brdf;
use crate::brdf::coordinates::Parameterisation;
use crate::brdf::table::{Channel, Error, HalfAngle, Points, Resolution, Table, resample};
use crate::finding::{Checked, Finding};
use crate::geometry::direction::from_degrees;

/// Wavelengths that stand for red, green and blue where a material has wavelengths, nm.
pub const RGB_NM: [f64; 3] = [650.0, 550.0, 450.0];

/// Directions at which a material is asked, all combinations of angles in degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Net {
    /// Angles of incidence to the normal, 0 to below 90.
    pub theta_i_deg: Vec<f64>,
    /// Azimuths of incidence; of an isotropic material the first alone.
    pub phi_i_deg: Vec<f64>,
    /// Outgoing angles to the normal, 0 to below 90.
    pub theta_o_deg: Vec<f64>,
    /// Azimuths of ω_o less that of ω_i.
    pub phi_deg: Vec<f64>,
}

impl Net {
    /// Pairs of directions, ω_i first; along the normal, where azimuths are one, only once.
    fn directions(&self, isotropic: bool) -> Vec<(DVec3, DVec3)> {
        let mut out = Vec::new();
        let turns = if isotropic { 1 } else { self.phi_i_deg.len() };
        for &phi_i in self.phi_i_deg.iter().take(turns) {
            for &theta_i in self.theta_i_deg.iter().filter(|t| **t > 0.0 || phi_i == self.phi_i_deg[0]) {
                for &theta_o in &self.theta_o_deg {
                    let around = if theta_o > 0.0 { self.phi_deg.len() } else { 1 };
                    let at = |phi: &f64| (from_degrees(theta_i, phi_i), from_degrees(theta_o, phi_i + phi));
                    out.extend(self.phi_deg.iter().take(around).map(at));
                }
            }
        }
        out
    }
}

/// A material in MERL's bins: its value in the middle of each of them, in three channels (red, green, blue) or of its only one.
///
/// Bins that were not measured are missing, or with `fill` what the material guesses there. A negative value would be read as
/// the mark of a missing bin: such bins are missing, or with `fill` 0.
///
/// # Errors
/// [`Error::Count`] for another number of channels than 1 or 3; [`Error::Range`] for a resolution out of range.
pub fn bins(
    brdf: &dyn Brdf,
    channels: &[Channel],
    resolution: Resolution,
    fill: bool,
) -> Result<Checked<HalfAngle>, Error> {
    resolution.check()?;
    if channels.len() != 3 && channels.len() != 1 {
        return Err(Error::Count { what: "channels", found: channels.len(), expected: 3 });
    }
    let three = |values: &mut [f64]| {
        if channels.len() == 1 {
            values.fill(values[0]);
        }
    };
    let mut findings = Vec::new();
    if !brdf.is_isotropic() {
        let words = "bins in half and difference angles have no place for a turn of the sample; the half vector was kept at φ_h = 0";
        findings.push(Finding::warning("B401", words));
    }
    let known = resample(resolution, Channel::rgb(), |i, o, values| {
        brdf.evaluate(i, o, &mut values[..channels.len()]);
        three(values);
        fill || brdf.is_measured(i, o)
    });
    let mut all: Vec<f32> = Vec::with_capacity(3 * resolution.bins());
    let (mut above, mut missing, mut negative) = (0_usize, 0_usize, 0_usize);
    for bin in 0..resolution.bins() {
        let (i, o) = resolution.centre(bin).directions();
        let values = known.bin(bin);
        let below_zero = values.iter().any(|v| *v < 0.0);
        negative += usize::from(below_zero);
        if i.z > 0.0 && o.z > 0.0 {
            above += 1;
            missing += usize::from(if fill { !brdf.is_measured(i, o) } else { values[0].is_nan() });
        }
        all.extend(values.iter().map(|v| match below_zero {
            true if fill => v.max(0.0),
            true => f32::NAN,
            false => *v,
        }));
    }
    if missing > 0 {
        let done = if fill { "they hold the best guess" } else { "they are marked as missing" };
        findings.push(Finding::info("B402", format!("{missing} of {above} bins were not measured: {done}")));
    }
    if negative > 0 {
        let done = if fill { "became 0" } else { "are marked as missing" };
        let words = format!("{negative} bins with negative values {done}: the file marks a missing bin by one");
        findings.push(Finding::warning("B403", words));
    }
    if channels != Channel::rgb() {
        let words = format!("what is written as red, green and blue is {}", channel_names(channels));
        findings.push(Finding::info("B404", words));
    }
    Ok(Checked { value: HalfAngle::new(resolution, Channel::rgb(), all)?, findings })
}

/// The places of a table at which there is a value, as points.
///
/// # Errors
/// [`Error::Count`] for a table without any.
pub fn nodes(table: &Table) -> Result<Checked<Points>, Error> {
    if let Table::Points(points) = table {
        return Ok(Checked { value: points.clone(), findings: Vec::new() });
    }
    let (mut directions, mut values) = (Vec::new(), Vec::new());
    table.entries(&mut |entry| {
        directions.push((entry.incident, entry.outgoing));
        values.extend_from_slice(entry.values);
    });
    let mut findings = Vec::new();
    let (places, missing) = table.coverage();
    if missing > 0 {
        let words = format!("{missing} of {places} places are missing and are not written");
        findings.push(Finding::info("B402", words));
    }
    let words = format!(
        "the {} is written as {} points; readers interpolate between them by their own rule",
        table.kind(),
        directions.len()
    );
    findings.push(Finding::info("B405", words));
    let points = Points::new(table.parameterisation(), table.channels().to_vec(), directions, values)?;
    Ok(Checked { value: points, findings })
}

/// A material at the directions of a net, as points; places that were not measured are left out, or with `fill` what the material
/// guesses there.
///
/// # Errors
/// [`Error::Count`] where nothing was measured at any of them.
pub fn sampled(brdf: &dyn Brdf, channels: &[Channel], net: &Net, fill: bool) -> Result<Checked<Points>, Error> {
    let isotropic = brdf.is_isotropic();
    let mut directions = net.directions(isotropic);
    let asked = directions.len();
    let mut missing = 0;
    directions.retain(|(i, o)| {
        let measured = brdf.is_measured(*i, *o);
        missing += usize::from(!measured);
        measured || fill
    });
    let mut values = vec![0.0; directions.len() * channels.len()];
    for ((i, o), values) in directions.iter().zip(values.chunks_exact_mut(channels.len())) {
        brdf.evaluate(*i, *o, values);
    }
    let mut findings = Vec::new();
    if missing > 0 {
        let done = if fill { "they hold the best guess" } else { "they are not written" };
        findings.push(Finding::info("B402", format!("{missing} of {asked} directions were not measured: {done}")));
    }
    let parameterisation = if isotropic { Parameterisation::ViewLightAzimuth } else { Parameterisation::Spherical };
    let points = Points::new(parameterisation, channels.to_vec(), directions, values)?;
    Ok(Checked { value: points, findings })
}

/// `650 nm, 550 nm, channel X`.
pub(super) fn channel_names(channels: &[Channel]) -> String {
    let named = |c: &Channel| if let Channel::Named(name) = c { format!("channel {name}") } else { c.to_string() };
    let most = 6;
    let shown: Vec<String> = channels.iter().take(most).map(named).collect();
    let more = if channels.len() > most { format!(" … ({} in all)", channels.len()) } else { String::new() };
    shown.join(", ") + &more
}
