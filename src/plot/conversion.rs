//! From conversions to panels: which curves, points and vectors stand for a spectrum.

use crate::colorimetry::adaptation::Transform;
use crate::colorimetry::observer::Observer;
use crate::colorimetry::{cct, dominant, rgb, tolerance};
use crate::constants::SecondRadiation;
use crate::conversion::{Conversion, Settings};
use crate::photometry::alpha_opic::RECOMMENDATIONS;
use crate::spectrum::{Quantity, Sampling, Spectrum};
use crate::units::significant;

use super::{
    ChromaticityPanel, ColourVectorPanel, Curve, Diagram, LevelFigure, LevelPanel, LocusPoint, MarkedPoint,
    PlanckPoint, SpectrumPanel, Weighting,
};

/// A converted spectrum to draw.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// What to call it.
    pub name: &'a str,
    /// Its figures.
    pub conversion: &'a Conversion,
    /// Its samples, SI per nm where it has a scale.
    pub spectrum: &'a Spectrum,
}

/// Name and unit of the spectral quantity, for the axis.
fn value_label(quantity: Quantity, sampling: Sampling) -> String {
    let unit = match (quantity, sampling) {
        (Quantity::Relative, _) => return "relative spectral power".to_owned(),
        (q, Sampling::Lines) => q.unit().to_owned(),
        (Quantity::Flux, _) => "W/nm".to_owned(),
        (Quantity::Energy, _) => "J/nm".to_owned(),
        (Quantity::Intensity, _) => "W/(sr·nm)".to_owned(),
        (Quantity::Irradiance | Quantity::Exitance, _) => "W/(m²·nm)".to_owned(),
        (Quantity::Radiance, _) => "W/(m²·sr·nm)".to_owned(),
        (Quantity::Exposure, _) => "J/(m²·nm)".to_owned(),
    };
    format!("spectral {} [{unit}]", quantity.word())
}

/// Melanopic equivalent daylight illuminances beside what is recommended for the eye; the intervals, where known, are in the order
/// of the spectra. `None` where none has an illuminance above zero.
#[must_use]
pub fn melanopic_panel(drawn: &[Drawn<'_>], intervals: &[Option<[f64; 2]>]) -> Option<LevelPanel> {
    let edi_lx = |c: &Conversion| {
        let factor = c.absolute.iter().find(|f| f.quantity == Quantity::Irradiance)?.factor;
        let melanopic = c.alpha_opic.iter().find(|a| a.receptor == "melanopic")?;
        Some(factor * melanopic.equivalent_daylight).filter(|v| *v > 0.0 && v.is_finite())
    };
    let figure = |(i, d): (usize, &Drawn<'_>)| {
        let value = edi_lx(d.conversion)?;
        let name = if drawn.len() > 1 { format!("{}: ", d.name) } else { String::new() };
        let text = format!("{name}{} lx", significant(value, 4));
        Some(LevelFigure { value, interval: intervals.get(i).copied().flatten(), text })
    };
    let figures: Vec<LevelFigure> = drawn.iter().enumerate().filter_map(figure).collect();
    (!figures.is_empty()).then(|| LevelPanel {
        title: if let [one] = drawn { one.name.to_owned() } else { String::new() },
        axis: "melanopic equivalent daylight illuminance [lx]; at the eye recommended (Brown et al. 2022)".to_owned(),
        figures,
        references: RECOMMENDATIONS.map(|r| (r.bound_lx, r.word.to_owned())).to_vec(),
    })
}

/// sRGB colours standing for wavelengths, every 5 nm: the spectral colour with some white added and cut to the gamut, as
/// bright as the display can, dimmed towards the ends of the visible range.
fn wavelength_colours() -> Vec<(f64, [u8; 3])> {
    let [x, y, z] = Observer::Cie1931.colour_matching_functions();
    (0..=94)
        .filter_map(|i| {
            let w = 360.0 + 5.0 * f64::from(i);
            let linear = rgb::colour([x.at(w), y.at(w), z.at(w)], &rgb::SRGB, Transform::None, None)?.linear;
            // All the white that the gamut asks for would turn red into crimson, none would make flat bands of green and red.
            let white = 0.35 * linear.iter().copied().fold(0.0, f64::min).abs();
            let inside = linear.map(|v| (v + white).max(0.0));
            let largest = inside.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            let dim = ((w - 360.0) / 60.0).clamp(0.0, 1.0) * ((790.0 - w) / 110.0).clamp(0.0, 1.0);
            let shown = inside.map(|v| rgb::SRGB.encoding.encode(dim * v / largest));
            Some((w, shown.map(|v| (255.0 * v).round().clamp(0.0, 255.0) as u8)))
        })
        .collect()
}

/// A real minus sign, as figures in a drawing have it.
fn signed(text: String) -> String {
    text.replace('-', "−")
}

/// The column of key figures.
fn key_figures(c: &Conversion) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(f) = c.absolute.first() {
        out.push(format!("{} {}", significant(f.photopic, 4), f.quantity.luminous_unit()));
        out.push(format!("{} {}", significant(f.radiometric, 4), f.quantity.unit()));
    }
    if let Some(k) = c.efficacy_lm_per_w {
        out.push(format!("{} lm/W", significant(k, 4)));
    }
    if let Some(cct) = c.cct {
        out.push(format!("CCT {:.0} K", cct.kelvin));
        out.push(format!("Duv {:+.4}", if cct.duv.abs() < 5e-5 { 0.0 } else { cct.duv }));
    }
    if let Some([x, y]) = c.xy {
        out.push(format!("x {x:.4}, y {y:.4}"));
    }
    if let Some(cri) = c.cri {
        out.push(format!("Ra {:.1}, R9 {:.1}", cri.ra, cri.r[8]));
    }
    if let Some(t) = &c.tm30 {
        out.push(format!("Rf {:.1}, Rg {}", t.rf, t.rg.map_or("–".to_owned(), |g| format!("{g:.1}"))));
    }
    if let Some(der) = c.alpha_opic.iter().find(|a| a.receptor == "melanopic").and_then(|a| a.der) {
        out.push(format!("melanopic DER {der:.3}"));
    }
    out.into_iter().map(signed).collect()
}

/// The spectra with V(λ) on top.
#[must_use]
pub fn spectrum_panel(drawn: &[Drawn<'_>], settings: &Settings) -> SpectrumPanel {
    // Several relative spectra have no common scale but their peaks.
    let by_peak = drawn.len() > 1 && drawn.iter().all(|d| d.conversion.quantity == Quantity::Relative);
    let curve = |d: &Drawn<'_>| {
        let peak = d.spectrum.peak().1;
        let scale = if by_peak && peak > 0.0 { 1.0 / peak } else { 1.0 };
        let w = d.spectrum.wavelengths_nm().to_vec();
        let v = d.spectrum.values().iter().map(|v| scale * v).collect();
        match d.spectrum.sampling() {
            Sampling::Density => Curve::density(d.name, w, v),
            Sampling::Lines => Curve::lines(d.name, w, v),
        }
    };
    let v = settings.efficiency.weighting();
    let first = drawn.first();
    SpectrumPanel {
        title: match drawn {
            [one] => one.name.to_owned(),
            _ => String::new(),
        },
        curves: drawn.iter().map(curve).collect(),
        value_label: match first {
            Some(_) if by_peak => "spectral power relative to the peak".to_owned(),
            Some(d) => value_label(d.conversion.quantity, d.spectrum.sampling()),
            None => String::new(),
        },
        colours: wavelength_colours(),
        weighting: Some(Weighting {
            name: "V(λ)".to_owned(),
            samples: v.wavelengths_nm().iter().copied().zip(v.values().iter().copied()).collect(),
        }),
        figures: match drawn {
            [one] => key_figures(one.conversion),
            _ => Vec::new(),
        },
        range_nm: None,
    }
}

/// The chromaticities in a diagram with the Planckian locus.
#[must_use]
pub fn chromaticity_panel(drawn: &[Drawn<'_>], diagram: Diagram) -> ChromaticityPanel {
    let xy_of_uv = |[u, v]: [f64; 2]| {
        // 1960 (u, v) to (x, y): the inverse of the projective map.
        let d = 2.0 * u - 8.0 * v + 4.0;
        [3.0 * u / d, 2.0 * v / d]
    };
    let planck = |mired: f64| {
        let temperature_k = 1e6 / mired;
        let [x, y] = xy_of_uv(cct::planckian_uv(temperature_k, SecondRadiation::default()));
        PlanckPoint { temperature_k, x, y }
    };
    let points = (drawn.iter())
        .filter_map(|d| d.conversion.xy.map(|[x, y]| MarkedPoint { name: d.name.to_owned(), x, y, reference: false }))
        .collect();
    ChromaticityPanel {
        title: match diagram {
            Diagram::Cie1976 => "CIE 1976 u′v′",
            Diagram::Cie1931 => "CIE 1931 xy",
        }
        .to_owned(),
        diagram,
        locus: (dominant::spectral_locus(Observer::Cie1931).into_iter())
            .map(|[wavelength_nm, x, y]| LocusPoint { wavelength_nm, x, y })
            .collect(),
        planck: (0..=200).map(|i| planck(5.0 * f64::from(i))).collect(),
        points,
        regions: Vec::new(),
    }
}

/// Steps of the ellipses that are drawn about nominal whites.
const ELLIPSE_STEPS: f64 = 3.0;

/// The quadrangles of ANSI C78.377 and ellipses of three MacAdam steps, as outlines of a chromaticity panel.
#[must_use]
pub fn tolerance_regions() -> Vec<Vec<(f64, f64)>> {
    let quadrangle =
        |n: &tolerance::Nominal| n.corners_xy.iter().chain(n.corners_xy.first()).copied().collect::<Vec<_>>();
    let ellipse = |n: &tolerance::Nominal| n.ellipse.map(|e| e.outline(n.centre_xy, ELLIPSE_STEPS));
    let all = tolerance::nominals().iter().flat_map(|n| std::iter::once(quadrangle(n)).chain(ellipse(n)));
    all.map(|line| line.into_iter().map(|[x, y]| (x, y)).collect()).collect()
}

/// The TM-30 colour vector graphic; `None` where there are no TM-30 figures or a hue bin is empty.
#[must_use]
pub fn colour_vector_panel(drawn: &Drawn<'_>) -> Option<ColourVectorPanel> {
    let tm30 = drawn.conversion.tm30.as_ref()?;
    let mut vectors = [([0.0; 2], [0.0; 2]); 16];
    for (vector, bin) in vectors.iter_mut().zip(&tm30.bins) {
        let bin = bin.as_ref()?;
        *vector = (bin.reference, bin.test);
    }
    Some(ColourVectorPanel {
        title: "TM-30 colour vector graphic".to_owned(),
        vectors,
        fidelity: tm30.rf,
        gamut: tm30.rg?,
        cct_k: drawn.conversion.cct.map(|c| c.kelvin),
        duv: drawn.conversion.cct.map(|c| c.duv),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colorimetry::chromaticity;

    #[test]
    fn the_planckian_locus_is_drawn_where_it_is() {
        let panel = chromaticity_panel(&[], Diagram::Cie1931);
        for p in panel.planck.iter().skip(1) {
            let uv = chromaticity::uv_prime_of_xy([p.x, p.y]).expect("a chromaticity");
            let [u, v] = cct::planckian_uv(p.temperature_k, SecondRadiation::default());
            assert!((uv[0] - u).abs() < 1e-12 && (uv[1] - 1.5 * v).abs() < 1e-12, "{p:?}");
        }
    }
}
