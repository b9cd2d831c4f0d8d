//! From compiled plans and one spectrum to all figures and findings.

use super::figures::{AbsoluteFigures, Conversion, Integration, Mesopic, RgbFigure, XyzScale};
use super::{Error, Plan, Settings, shape};
use crate::colorimetry::whiteness::Whiteness;
use crate::colorimetry::{cct, chromaticity, cri, dominant, iec_60081, rgb, tolerance};
use crate::finding::{Checked, Finding};
use crate::photometry::luminous::Luminous;
use crate::photometry::{alpha_opic, hazard, mesopic, photon, risk, transfer};
use crate::spectrum::integrate::{Rule, dot};
use crate::spectrum::{Quantity, Sampling, Spectrum, largest};
use crate::units::significant;

/// A relative error bound from which a finding becomes a warning.
const NOTABLE: f64 = 1e-3;
/// Colour temperatures, K, of lights that are held against nominal whites of 2700 K to 6500 K.
const NOMINAL_WHITE_K: std::ops::RangeInclusive<f64> = 2000.0..=10_000.0;
/// Nearer than this to the switch of references, K, the choice between them hangs on the last digits of a measurement.
const REFERENCE_SWITCH_K: f64 = 1.0;

pub(super) fn evaluate(
    settings: &Settings,
    plan: &Plan,
    name: &str,
    quantity: Quantity,
    spectrum: &Spectrum,
) -> Result<Checked<Conversion>, Error> {
    let mut findings = Vec::new();
    let values = spectrum.values();
    let groups = settings.groups;
    let luminous = plan.luminous.evaluate(values);
    let photons = plan.photon.as_ref().map(|p| p.evaluate(values));
    // Of a relative spectrum no photon numbers are reported.
    let count = photons.filter(|_| quantity != Quantity::Relative).map_or(0.0, |p| p.total_count);
    let integrals = [luminous.radiometric, luminous.photopic, luminous.scotopic, count];
    if !integrals.iter().all(|v| v.is_finite()) {
        findings.push(
            Finding::error("P011", "the integrals exceed the largest double (1.8e308)")
                .hint("give the spectrum in a larger unit"),
        );
    }
    let xyz = plan.colour.xyz(values);
    let integration = integration(settings, plan, spectrum, &luminous, &mut findings);
    negative_samples(plan, spectrum, &luminous, settings.efficacy.k_m, &mut findings);
    // Ratios to a luminous content that is zero, or negative from noise, mean nothing.
    let lit = luminous.photopic > 0.0 && luminous.photopic.is_finite() && xyz.iter().all(|v| v.is_finite());
    if !lit {
        findings.push(
            Finding::error(
                "P005",
                format!(
                    "no luminous content (∫ S V dλ · K_m = {}): ratios, colour and colour quality are not defined",
                    luminous.photopic
                ),
            )
            .hint("the spectrum has no light between 360 nm and 830 nm, or its noise outweighs it"),
        );
    }
    let mesopic = mesopic_state(settings, &luminous, lit, &mut findings)?;
    let absolute = absolute(settings, quantity, &luminous, mesopic.as_ref())?;
    for figures in absolute.iter().skip(1).filter(|f| !(f.photopic.is_finite() && f.radiometric.is_finite())) {
        let message = format!("the {} that the geometry gives exceeds the largest double (1.8e308)", figures.quantity);
        findings.push(Finding::error("P011", message));
    }
    let (xyz_scale, factor) = match &plan.light {
        Some(light) => (XyzScale::PerfectDiffuser, light.scale()),
        None if quantity == Quantity::Relative => (XyzScale::Hundred, 100.0 / xyz[1]),
        None => (XyzScale::Absolute, settings.efficacy.k_m),
    };
    let xyz_1931 = plan.colour_1931.as_ref().map_or(xyz, |p| p.xyz(values));
    let coloured = lit.then_some(xyz).filter(|v| v[1] > 0.0);
    let uv = if lit { chromaticity::uv_1960(xyz_1931) } else { None };
    let mut out = Conversion {
        name: name.to_owned(),
        quantity,
        absolute,
        mesopic,
        efficacy_lm_per_w: if lit { luminous.efficacy_lm_per_w().filter(|_| luminous.radiometric > 0.0) } else { None },
        scotopic_photopic_ratio: if lit { luminous.scotopic_photopic_ratio() } else { None },
        xyz: match xyz_scale {
            XyzScale::Absolute | XyzScale::PerfectDiffuser => Some(xyz.map(|v| v * factor)),
            XyzScale::Hundred => coloured.map(|v| v.map(|v| v * factor)),
        },
        xyz_scale,
        xy: coloured.and_then(chromaticity::xy),
        uv_prime: coloured.and_then(chromaticity::uv_prime),
        cct: None,
        tolerance: None,
        standard_colour: None,
        whiteness: None,
        dominant: None,
        peak_wavelength_nm: None,
        centroid_wavelength_nm: None,
        fwhm_nm: None,
        cri: None,
        tm30: None,
        alpha_opic: Vec::new(),
        hazard: Vec::new(),
        risk: None,
        photons,
        rgb: Vec::new(),
        integration,
    };
    if lit {
        colour(settings, plan, values, uv, &mut out, &mut findings);
        match &plan.light {
            Some(light) => whiteness(light.whiteness(xyz.map(|v| v * factor)), &mut out, &mut findings),
            None => {
                let white = out.cct.filter(|c| NOMINAL_WHITE_K.contains(&c.kelvin));
                let xy = white.and(chromaticity::xy(xyz_1931));
                out.tolerance = xy.and_then(tolerance::nearest);
                out.standard_colour = xy.and_then(iec_60081::nearest);
            }
        }
    }
    if groups.rgb {
        out.rgb = rgb_figures(settings, xyz_1931, lit, &mut findings);
    }
    if let Some(plan) = &plan.alpha_opic {
        out.alpha_opic = plan.evaluate(values).to_vec();
        coverage(spectrum, alpha_opic::RANGE_NM, "the action spectra of CIE S 026", &mut findings);
    }
    if plan.photon.is_some() {
        coverage(spectrum, photon::PAR_NM, "PAR", &mut findings);
    }
    if let Some(plan) = &plan.hazard {
        out.hazard = hazards(plan, values, &mut findings);
    }
    if let Some(plan) = &plan.risk {
        out.risk = risk_group(settings, plan, values, &out, &mut findings);
    }
    undefined_ratios(&out, lit, &luminous, &mut findings);
    if groups.shape {
        form(plan, spectrum, luminous.radiometric, &mut out, &mut findings);
    }
    Ok(Checked { value: out, findings })
}

fn whiteness(found: Option<Whiteness>, out: &mut Conversion, findings: &mut Vec<Finding>) {
    if let Some(why) = found.and_then(|w| w.outside()) {
        let message = format!("outside of the limits within which CIE 15:2004 speaks of whiteness and tint: {why}");
        findings.push(Finding::warning("C008", message));
    }
    out.whiteness = found;
}

/// Says why a ratio is null where the spectrum as a whole has light.
fn undefined_ratios(c: &Conversion, lit: bool, luminous: &Luminous, findings: &mut Vec<Finding>) {
    if !lit {
        return;
    }
    let mut say = |what: &str, why: &str| {
        findings.push(Finding::warning("P012", format!("no {what}: {why}")));
    };
    if c.efficacy_lm_per_w.is_none() {
        let total = significant(luminous.radiometric, 3);
        say("luminous efficacy", &format!("the radiant total is {total}, and a ratio to it means nothing"));
    }
    if c.alpha_opic.iter().any(|a| a.der.is_none()) {
        say("α-opic ratios", "there is no luminous content between 380 nm and 780 nm");
    }
    if let Some(p) = &c.photons {
        if p.umol_per_j.is_none() {
            say("photons per joule", "there is no radiant total to divide by");
        }
        if p.par_umol_per_par_j.is_none() {
            say("photons per joule of PAR", "there is no radiation between 400 nm and 700 nm");
        }
    }
}

fn integration(
    settings: &Settings,
    plan: &Plan,
    spectrum: &Spectrum,
    luminous: &Luminous,
    findings: &mut Vec<Finding>,
) -> Integration {
    let (first, last) = spectrum.grid().range_nm();
    let (low, high) = settings.contract.range_nm.unwrap_or((first, last));
    let error_bound = plan.luminous.photopic_error.bound(spectrum, luminous.photopic / settings.efficacy.k_m);
    if plan.sampling == Sampling::Density {
        if let Some(bound) = error_bound.truncation_relative.filter(|b| *b > 0.0) {
            let effect = if bound < 1.0 {
                format!("changes the photopic integral by at most {} %", significant(100.0 * bound, 2))
            } else {
                "may exceed what is measured".to_owned()
            };
            let message = format!(
                "the spectrum covers {first}–{last} nm; what it may have beyond {effect}, if it is nowhere larger there than its largest sample"
            );
            findings.push(if bound > NOTABLE {
                Finding::warning("P002", message)
            } else {
                Finding::info("P002", message)
            });
        }
        if let Some(bound) = error_bound.step_relative.filter(|b| *b > 0.01) {
            let widest = spectrum.grid().widest_step_nm();
            findings.push(
                Finding::warning(
                    "P003",
                    format!(
                        "with steps up to {} nm the photopic integral may be off by up to {:.1} %",
                        significant(widest, 3),
                        100.0 * bound
                    ),
                )
                .hint("measure with smaller steps; --rule exact or --resample show what interpolation makes of it"),
            );
        }
    }
    Integration {
        rule: plan.rule,
        photon_rule: if plan.rule == Rule::Summation { Rule::Trapezoid } else { plan.rule },
        // A range that misses the samples is told as it was asked for.
        range_nm: if first.max(low) <= last.min(high) { (first.max(low), last.min(high)) } else { (low, high) },
        step_nm: spectrum.grid().step_nm(),
        samples: spectrum.wavelengths_nm().iter().filter(|w| (low..=high).contains(*w)).count(),
        error_bound,
    }
}

fn negative_samples(plan: &Plan, spectrum: &Spectrum, luminous: &Luminous, k_m: f64, findings: &mut Vec<Finding>) {
    let count = spectrum.values().iter().filter(|v| **v < 0.0).count();
    if count == 0 {
        return;
    }
    let negative: Vec<f64> = spectrum.values().iter().map(|v| v.min(0.0)).collect();
    // ȳ of the observer and V(λ) are close enough to state a share; exact for the default pair.
    let share = k_m * dot(&plan.colour.weights()[1], &negative) / luminous.photopic;
    let effect = if share.is_finite() {
        format!("they lower the photopic integral by {:.2e} of it", share.abs())
    } else {
        "there is nothing to set them against".to_owned()
    };
    findings.push(
        Finding::warning(
            "P006",
            format!("{count} of {} samples are negative and were kept; {effect}", spectrum.values().len()),
        )
        .hint("negative samples are noise about zero; clipping them would raise every integral"),
    );
}

fn mesopic_state(
    settings: &Settings,
    luminous: &Luminous,
    lit: bool,
    findings: &mut Vec<Finding>,
) -> Result<Option<Mesopic>, Error> {
    let Some(adaptation_luminance) = settings.mesopic_adaptation else { return Ok(None) };
    let ratio = luminous.scotopic_photopic_ratio().filter(|r| lit && *r >= 0.0);
    let Some(ratio) = ratio else {
        findings.push(Finding::error("P010", "no S/P ratio, and so no mesopic figures"));
        return Ok(None);
    };
    let adaptation = mesopic::adaptation(adaptation_luminance, ratio)?;
    Ok(Some(Mesopic { adaptation_luminance, adaptation }))
}

fn absolute(
    settings: &Settings,
    quantity: Quantity,
    luminous: &Luminous,
    mesopic: Option<&Mesopic>,
) -> Result<Vec<AbsoluteFigures>, Error> {
    if quantity == Quantity::Relative {
        return Ok(Vec::new());
    }
    let figures = |quantity, factor: f64, relations| AbsoluteFigures {
        quantity,
        factor,
        radiometric: factor * luminous.radiometric,
        photopic: factor * luminous.photopic,
        scotopic: factor * luminous.scotopic,
        mesopic: mesopic
            .map(|m| mesopic::mesopic(factor * luminous.photopic, factor * luminous.scotopic, m.adaptation.m)),
        relations,
    };
    let mut all = vec![figures(quantity, 1.0, Vec::new())];
    let derived = transfer::derive(quantity, &settings.geometry)?;
    all.extend(derived.into_iter().map(|d| figures(d.quantity, d.factor, d.relations)));
    Ok(all)
}

/// CCT, dominant wavelength and colour rendition.
fn colour(
    settings: &Settings,
    plan: &Plan,
    values: &[f64],
    uv: Option<[f64; 2]>,
    out: &mut Conversion,
    findings: &mut Vec<Finding>,
) {
    let found = uv.ok_or(cct::Undefined::Black).and_then(|uv| cct::correlated(uv, settings.cct_method, settings.c2));
    if settings.groups.colour {
        match found {
            Ok(cct) => out.cct = Some(cct),
            Err(why) => findings.push(Finding::warning("C001", format!("no correlated colour temperature: {why}"))),
        }
        let white = plan.light.as_ref().map_or(settings.dominant_white_xy, |l| l.white_xy);
        out.dominant = out.xy.and_then(|xy| dominant::dominant(xy, white, settings.observer));
        if out.dominant.is_none() {
            findings.push(Finding::info("C005", "no dominant wavelength: the chromaticity is that of the white point"));
        }
    }
    // Rendition needs the temperature itself, whatever method the user wants to see printed.
    let exact = uv.ok_or(cct::Undefined::Black).and_then(|uv| cct::nearest(uv, settings.c2)).map(|cct| cct.kelvin);
    if let Some(cri_plan) = &plan.cri {
        match exact.map_err(|e| e.to_string()).and_then(|k| cri_plan.evaluate(values, k).map_err(|e| e.to_string())) {
            Ok(cri) => {
                if cri.distance_uv > cri::CHROMATICITY_TOLERANCE {
                    findings.push(Finding::warning(
                        "C003",
                        format!(
                            "the source is {:.4} from its reference in (u, v); beyond {} CIE 13.3 calls the colour rendering indices less accurate",
                            cri.distance_uv,
                            cri::CHROMATICITY_TOLERANCE
                        ),
                    ));
                }
                if exact.is_ok_and(|k| (k - cri::DAYLIGHT_FROM_K).abs() < REFERENCE_SWITCH_K) {
                    findings.push(Finding::info(
                        "C007",
                        "within 1 K of 5000 K, where CIE 13.3 changes from a blackbody to daylight as reference: the indices jump there by up to 1.5",
                    ));
                }
                out.cri = Some(cri);
            }
            Err(why) => findings.push(Finding::warning("C002", format!("no colour rendering index: {why}"))),
        }
    }
    if let Some((tm30_plan, observer)) = &plan.tm30 {
        let kelvin = (chromaticity::uv_1960(observer.xyz(values)).ok_or(cct::Undefined::Black))
            .and_then(|uv| cct::nearest(uv, settings.c2))
            .map(|cct| cct.kelvin);
        match kelvin.map_err(|e| e.to_string()).and_then(|k| tm30_plan.evaluate(values, k).map_err(|e| e.to_string())) {
            Ok(tm30) => {
                if tm30.rg.is_none() {
                    findings.push(Finding::warning("C004", "no gamut index Rg: a hue bin has no sample"));
                }
                out.tm30 = Some(tm30);
            }
            Err(why) => findings.push(Finding::warning("C004", format!("no TM-30 figures: {why}"))),
        }
    }
}

fn rgb_figures(settings: &Settings, xyz: [f64; 3], lit: bool, findings: &mut Vec<Finding>) -> Vec<RgbFigure> {
    if !lit {
        return Vec::new();
    }
    let all: Vec<RgbFigure> = (rgb::SPACES.iter())
        .filter_map(|space| {
            let colour = rgb::colour(xyz, space, settings.adaptation, settings.rgb_white)?;
            Some(RgbFigure { key: space.key, colour })
        })
        .collect();
    let clipped: Vec<String> = (all.iter())
        .filter(|f| f.colour.out_of_gamut)
        .map(|f| format!("{} ({:.0} % of the largest component)", f.key, 100.0 * f.colour.clipped))
        .collect();
    if !clipped.is_empty() {
        findings.push(Finding::info(
            "C006",
            format!(
                "the colour is outside the gamut of {}; negative components were cut in the encoded values",
                clipped.join(", ")
            ),
        ));
    }
    all
}

/// Says so where a spectrum ends inside the range of a weighting that has no bound of its own.
fn coverage(spectrum: &Spectrum, (low, high): (f64, f64), of: &str, findings: &mut Vec<Finding>) {
    let (first, last) = spectrum.grid().range_nm();
    if spectrum.sampling() == Sampling::Density && (first > low || last < high) {
        findings.push(Finding::warning(
            "P008",
            format!(
                "the spectrum covers {first}–{last} nm of the {low}–{high} nm of {of}; nothing is added for the rest"
            ),
        ));
    }
}

fn hazards(plan: &hazard::Plan, values: &[f64], findings: &mut Vec<Finding>) -> Vec<hazard::Hazard> {
    let all: Vec<hazard::Hazard> = plan.evaluate(values).filter(|h| h.covered_nm.is_some()).collect();
    let parts: Vec<String> = all
        .iter()
        .filter(|h| !h.complete)
        .filter_map(|h| h.covered_nm.map(|(low, high)| format!("{} over {low}–{high} nm", h.key)))
        .collect();
    if !parts.is_empty() {
        let message =
            format!("weighted in part: {}; the spectrum does not cover the rest of the weighting", parts.join(", "));
        findings.push(Finding::info("P007", message));
    }
    all
}

/// The risk group, and a word on what it does not rest on.
fn risk_group(
    settings: &Settings,
    plan: &risk::Plan,
    values: &[f64],
    found: &Conversion,
    findings: &mut Vec<Finding>,
) -> Option<risk::Risk> {
    let of = |quantity: Quantity| found.absolute.iter().find(|f| f.quantity == quantity);
    let source = risk::Source {
        to_irradiance: of(Quantity::Irradiance).map(|f| f.factor),
        to_radiance: of(Quantity::Radiance).map(|f| f.factor),
        luminance_cd_per_m2: of(Quantity::Radiance).map(|f| f.photopic),
        subtense_rad: risk::subtense_rad(found.quantity, &settings.geometry),
    };
    if source.to_irradiance.is_none() && source.to_radiance.is_none() {
        let message = "no risk group: it is one of an irradiance or a radiance, and none is known";
        findings.push(Finding::error("P013", message));
        return None;
    }
    let risk = plan.evaluate(values, &source);
    if !risk.complete() {
        let parts = risk.assessments.iter().filter(|a| !a.complete).map(|a| {
            let (low, high) = a.covered_nm;
            format!("{} over {low}–{high} nm only", a.hazard.symbol())
        });
        let missing = risk.missing.iter().map(|(hazard, why)| format!("{} not: {}", hazard.symbol(), why.word()));
        let all: Vec<String> = parts.chain(missing).collect();
        findings.push(Finding::warning("P014", format!("the risk group is a lower bound ({})", all.join("; "))));
    }
    Some(risk)
}

/// Peak, centroid and full width at half maximum.
fn form(plan: &Plan, spectrum: &Spectrum, radiometric: f64, out: &mut Conversion, findings: &mut Vec<Finding>) {
    let at = largest(spectrum.values());
    let peak = spectrum.values()[at];
    if peak <= 0.0 {
        return;
    }
    out.peak_wavelength_nm = Some(spectrum.wavelengths_nm()[at]);
    let centroid = dot(&plan.centroid, spectrum.values()) / radiometric;
    out.centroid_wavelength_nm = Some(centroid).filter(|c| c.is_finite() && radiometric > 0.0);
    if spectrum.sampling() == Sampling::Density {
        out.fwhm_nm = shape::full_width(spectrum.wavelengths_nm(), spectrum.values(), at, 0.5 * peak);
        if out.fwhm_nm.is_none() {
            findings.push(Finding::info(
                "P009",
                "no full width at half maximum: the spectrum does not fall to half on both sides of its peak",
            ));
        }
    }
}
