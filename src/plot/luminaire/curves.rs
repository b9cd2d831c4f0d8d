//! Curves over the angle from the axis: the polar and the Cartesian diagram.

use super::super::{AngularCurve, CartesianPanel, IntensityLevel, MOST_ANGULAR_CURVES, PolarPanel};
use super::{Drawn, Error, View, angle, factor, last_above, reach, unit};
use crate::luminaire::beam::{BEAM_FRACTION, Definition, FIELD_FRACTION};
use crate::luminaire::cut::Cut;
use crate::luminaire::{Distribution, Symmetry, System};
use crate::math::interpolate;

/// A Cartesian diagram ends where all curves stay below this part of the largest value.
const FAINT: f64 = 0.01;
/// The same on a logarithmic axis.
const FAINT_LOGARITHMIC: f64 = 1e-4;

/// One curve with what it was made of.
struct Traced<'d> {
    curve: AngularCurve,
    cut: Cut<'d>,
    factor: f64,
}

/// The polar diagram.
///
/// # Errors
/// [`Error`]; cone and solid excepted.
pub fn polar_panel(drawn: &[Drawn<'_>], view: &View) -> Result<PolarPanel, Error> {
    let curves = traced(drawn, view)?.into_iter().map(|t| t.curve).collect();
    Ok(PolarPanel { title: title(drawn, view, "polar diagram"), curves, unit: unit_of(drawn, view).to_owned() })
}

/// The Cartesian diagram, zoomed to the angles where there is light; for one luminaire with the half-peak (beam) and tenth-peak
/// (field) angles of each plane by [`Definition::Fwhm`].
///
/// # Errors
/// As [`polar_panel`].
pub fn cartesian_panel(drawn: &[Drawn<'_>], view: &View) -> Result<CartesianPanel, Error> {
    let mut traced = traced(drawn, view)?;
    let largest = traced.iter().flat_map(|t| t.curve.values.iter().copied()).fold(0.0, f64::max);
    let faint = largest * if view.logarithmic { FAINT_LOGARITHMIC } else { FAINT };
    let lit = |t: &Traced<'_>| {
        let samples = t.curve.angles_deg.iter().copied().zip(t.curve.values.iter().map(|v| v.abs()));
        last_above(samples, faint)
    };
    let end = reach(traced.iter().map(lit).fold(0.0, f64::max));
    let mut levels = Vec::new();
    if let [one] = drawn {
        let peak = one.luminaire.distribution.peak().0;
        for (fraction, name) in [(BEAM_FRACTION, "beam"), (FIELD_FRACTION, "field")] {
            let mut level = IntensityLevel {
                name: format!("{:.0} %", 100.0 * fraction),
                value: fraction * largest,
                marks: Vec::new(),
            };
            for t in &mut traced {
                let Some((low, high)) = t.cut.limits(fraction, Definition::Fwhm, peak) else { continue };
                let at = |a: f64| (a, t.factor * interpolate::linear(&t.cut.angles_deg, &t.cut.values, a));
                level.marks.extend([at(low), at(high)]);
                t.curve.name.push_str(&format!(", {name} {}°", angle(high - low)));
            }
            levels.push(level);
        }
    }
    let unit = unit_of(drawn, view);
    let type_c = drawn.iter().all(|d| d.luminaire.distribution.system() == System::TypeC);
    Ok(CartesianPanel {
        title: title(drawn, view, "Cartesian diagram"),
        curves: traced.into_iter().map(|t| t.curve).collect(),
        value_label: format!("intensity [{unit}]"),
        angle_label: if type_c { "γ [°]" } else { "angle from the axis [°]" }.to_owned(),
        levels,
        range_deg: (-end, end),
        logarithmic: view.logarithmic,
    })
}

fn title(drawn: &[Drawn<'_>], view: &View, kind: &str) -> String {
    match drawn {
        [one] if view.named => one.name.to_owned(),
        _ => kind.to_owned(),
    }
}

fn unit_of(drawn: &[Drawn<'_>], view: &View) -> &'static str {
    drawn.first().map_or("", |d| unit(d.luminaire.kind, view.per_klm))
}

fn traced<'d>(drawn: &[Drawn<'d>], view: &View) -> Result<Vec<Traced<'d>>, Error> {
    if drawn.windows(2).any(|w| w[0].luminaire.kind != w[1].luminaire.kind) {
        return Err(Error::Kinds);
    }
    let mut out = Vec::new();
    for d in drawn {
        let distribution = &d.luminaire.distribution;
        let factor = factor(d.luminaire, view)?;
        for plane in planes(distribution, view, drawn.len()) {
            let cut = Cut::of(distribution, plane);
            let plane = plane_name(distribution, view, plane);
            let name = if drawn.len() > 1 { format!("{}, {plane}", d.name) } else { plane };
            let curve = curve(distribution, &cut, factor, name);
            out.push(Traced { curve, cut, factor });
        }
    }
    if out.len() > MOST_ANGULAR_CURVES {
        return Err(Error::TooMany { found: out.len() });
    }
    if out.iter().all(|t| t.cut.angles_deg.len() < 2) {
        return Err(Error::OneAngle);
    }
    if !out.iter().any(|t| t.cut.values.iter().any(|v| *v > 0.0)) {
        return Err(Error::Dark { in_planes: drawn.iter().any(|d| d.luminaire.distribution.peak().0 > 0.0) });
    }
    Ok(out)
}

fn planes(distribution: &Distribution, view: &View, luminaires: usize) -> Vec<f64> {
    if !view.planes_deg.is_empty() {
        return view.planes_deg.clone();
    }
    let alike = distribution.system() == System::TypeC && distribution.symmetry() == Symmetry::Rotational;
    if alike || 2 * luminaires > MOST_ANGULAR_CURVES { vec![0.0] } else { vec![0.0, 90.0] }
}

fn plane_name(distribution: &Distribution, view: &View, plane: f64) -> String {
    match (distribution.system(), distribution.symmetry()) {
        (System::TypeC, Symmetry::Rotational) if view.planes_deg.is_empty() => "all C planes".to_owned(),
        (System::TypeC, _) => format!("C{}–C{}", angle(plane), angle((plane + 180.0).rem_euclid(360.0))),
        _ if plane == 0.0 => "H (at V 0°)".to_owned(),
        _ if plane == 90.0 => "V (at H 0°)".to_owned(),
        _ => format!("{}° from H to V", angle(plane)),
    }
}

/// The cut as a curve that falls to zero where the table ends.
fn curve(distribution: &Distribution, cut: &Cut<'_>, factor: f64, name: String) -> AngularCurve {
    let mut samples: Vec<(f64, f64)> = Vec::with_capacity(cut.angles_deg.len() + 4);
    let end = if distribution.system() == System::TypeC { 180.0 } else { 90.0 };
    let inner = distribution.vertical_deg()[0];
    let gap = distribution.system() == System::TypeC && inner > 0.0;
    for (i, (a, v)) in cut.angles_deg.iter().zip(&cut.values).enumerate() {
        let (first, last) = (i == 0, i + 1 == cut.angles_deg.len());
        let falls = (first || last) && *v != 0.0 && a.abs() < end;
        if (first && falls) || (gap && *a == inner) {
            samples.push((*a, 0.0));
        }
        samples.push((*a, factor * v));
        if (last && falls) || (gap && *a == -inner) {
            samples.push((*a, 0.0));
        }
    }
    let (angles_deg, values) = samples.into_iter().unzip();
    AngularCurve { name, angles_deg, values }
}
