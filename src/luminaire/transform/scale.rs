//! More or less light of the same shape.

use super::super::model::{Kind, Luminaire};
use super::super::{keyword, zonal};
use super::{Error, facts};
use crate::finding::{Checked, Finding};
use crate::units::significant;

/// How much light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// Times a factor above 0.
    Factor(f64),
    /// So that the integrated flux is this: lm, W or µmol/s.
    Flux(f64),
    /// So that each lamp is rated this, the light output ratio staying, lm.
    FluxPerLamp(f64),
}

/// The luminaire with all intensities multiplied: lamps and declared flux go along, for it is taken to have other lamps; the
/// power stays, which a finding says, for no photometry knows it.
///
/// # Errors
/// [`Error::Argument`] for factors and fluxes that are not above 0, [`Error::Dark`], [`Error::NoLampFlux`].
pub fn scale(luminaire: &Luminaire, scale: &Scale) -> Result<Checked<Luminaire>, Error> {
    let positive = |what: &'static str, found: f64| {
        let sound = found > 0.0 && found.is_finite();
        if sound { Ok(found) } else { Err(Error::Argument { what, found, expected: "a finite number above 0" }) }
    };
    let factor = match *scale {
        Scale::Factor(factor) => positive("factor", factor)?,
        Scale::Flux(flux) => {
            let own = luminaire.distribution.total_flux();
            if own <= 0.0 {
                return Err(Error::Dark);
            }
            positive("flux", flux)? / own
        }
        Scale::FluxPerLamp(flux) => {
            let rated = zonal::lamp_flux_lm(luminaire).ok_or(Error::NoLampFlux)?;
            let count: f64 =
                luminaire.lamps.iter().filter(|l| l.flux_lm.is_some()).map(|l| l.count.unwrap_or(1.0)).sum();
            positive("flux per lamp", flux)? * count / rated
        }
    };
    let mut findings = Vec::new();
    let value = scaled(luminaire, factor, &mut findings);
    let unit = match luminaire.kind {
        Kind::Luminous => "lm",
        Kind::Radiant => "W",
        Kind::Photon => "µmol/s",
    };
    let flux = significant(value.distribution.total_flux(), 6);
    let mut message = format!("intensities and the flux declared times {}: {flux} {unit}", significant(factor, 6));
    if let Some(watts) = luminaire.input_power_w {
        message.push_str(&format!("; the input power stays {watts} W, so the efficacy changes likewise"));
    }
    findings.push(Finding::info("L405", message));
    Ok(Checked { value, findings })
}

/// All light times a factor.
pub(super) fn scaled(luminaire: &Luminaire, factor: f64, findings: &mut Vec<Finding>) -> Luminaire {
    let mut out = luminaire.clone();
    if factor == 1.0 {
        return out;
    }
    out.distribution = out.distribution.scaled(factor);
    let spectra = out.angular_spectra.take();
    // Finite values times a finite factor overflow only where the sum over wavelength does.
    out.angular_spectra = spectra.and_then(|s| s.map(|table| Ok::<_, super::Error>(table.scaled(factor))).ok());
    out.declared_flux = out.declared_flux.map(|flux| flux * factor);
    for set in &mut out.lamps {
        set.flux_lm = set.flux_lm.map(|flux| flux * factor);
    }
    // A text that declares the flux would contradict it.
    let lost = facts::drop_keywords(&mut out, keyword::declares_flux);
    facts::said(&lost, findings);
    facts::generated(&mut out, false, true);
    out
}
