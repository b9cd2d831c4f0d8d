//! Intensity over all directions: the solid and the isocandela diagram.

use glam::DVec3;

use super::super::{IsocandelaPanel, Isoline, Web, WebPanel};
use super::{Drawn, Error, View, angle, factor, last_above, reach, signed, unit};
use crate::luminaire::cut::Cut;
use crate::luminaire::{Distribution, System};
use crate::units::significant;

/// Levels of the isocandela diagram, per cent of the maximum.
const LEVELS_PERCENT: [f64; 9] = [90.0, 80.0, 70.0, 50.0, 30.0, 20.0, 10.0, 5.0, 2.0];
/// Diagrams end where all values stay below this part of the maximum.
const FAINT: f64 = 0.05;
/// Step of the grid between the table's own angles, degrees.
const STEP_DEG: f64 = 2.5;
/// Most angles along one side of a grid; finer tables are sampled at this many.
const MOST: usize = 721;
/// Patches of the solid about the axis, and from the axis to the faint end.
const WEB_AZIMUTHS: u32 = 72;
const WEB_GAMMAS: u32 = 36;

/// The intensity solid.
///
/// # Errors
/// [`Error::Dark`], [`Error::PerKlm`].
pub fn web_panel(drawn: &Drawn<'_>, view: &View) -> Result<WebPanel, Error> {
    let d = &drawn.luminaire.distribution;
    let peak = peak(d)?;
    let factor = factor(drawn.luminaire, view)?;
    let reach = from_axis(d, FAINT * peak);
    let web_step = if reach > 60.0 { 10.0 } else { reach / 9.0 };
    let fine = reach / f64::from(WEB_GAMMAS);
    // Beyond the faint end a few rows more, down to the last direction.
    let far = (1..=18).map(|i| reach + (180.0 - reach) * f64::from(i) / 18.0).filter(|_| reach < 180.0);
    let gamma_deg: Vec<f64> = (0..=WEB_GAMMAS).map(|i| fine * f64::from(i)).chain(far).collect();
    let azimuth_deg: Vec<f64> = (0..=WEB_AZIMUTHS).map(|i| 360.0 * f64::from(i) / f64::from(WEB_AZIMUTHS)).collect();
    let value = |azimuth: f64, gamma: f64| match d.system() {
        System::TypeC => factor * d.at(azimuth, gamma),
        System::TypeA | System::TypeB => {
            let ((sa, ca), (sg, cg)) = (azimuth.to_radians().sin_cos(), gamma.to_radians().sin_cos());
            factor * d.towards(DVec3::new(sg * ca, sg * sa, -cg))
        }
    };
    let values = azimuth_deg.iter().flat_map(|a| gamma_deg.iter().map(|g| value(*a, *g)).collect::<Vec<_>>()).collect();
    let axes = if d.system() == System::TypeC { ["C0", "C90", "γ = 0"] } else { ["H", "V", "axis"] };
    Ok(WebPanel {
        title: title(drawn, view, "intensity solid"),
        azimuth_deg,
        gamma_deg,
        values,
        web_step_deg: web_step,
        ring: factor * peak,
        note: format!(
            "ring: {} {} (maximum)",
            signed(&significant(factor * peak, 4)),
            unit(drawn.luminaire.kind, view.per_klm)
        ),
        axes: axes.map(str::to_owned),
    })
}

/// The isocandela diagram: lines at per cents of the maximum, on an azimuthal web for Type C and an H–V web for Types A and B,
/// zoomed to the directions where there is light.
///
/// # Errors
/// [`Error::Dark`], [`Error::PerKlm`].
pub fn isocandela_panel(drawn: &Drawn<'_>, view: &View) -> Result<IsocandelaPanel, Error> {
    let d = &drawn.luminaire.distribution;
    let factor = factor(drawn.luminaire, view)?;
    let (_, h, v) = d.peak();
    let peak = peak(d)?;
    let type_c = d.system() == System::TypeC;
    let reach_deg = if type_c { from_axis(d, FAINT * peak) } else { either_way(d, FAINT * peak) };
    let (horizontal_deg, vertical_deg) = if type_c {
        // Every plane that the symmetry may have mirrored, so that the lines bend at the table's own planes.
        let own = d.horizontal_deg().iter().flat_map(|c| [*c, 360.0 - c, 180.0 - c, 180.0 + c]);
        (grid(own, 0.0, 360.0), grid(d.vertical_deg().iter().copied(), 0.0, reach_deg))
    } else {
        let own = d.horizontal_deg().iter().flat_map(|h| [*h, -h]);
        (grid(own, -reach_deg, reach_deg), grid(d.vertical_deg().iter().copied(), -reach_deg, reach_deg))
    };
    let values =
        vertical_deg.iter().flat_map(|v| horizontal_deg.iter().map(|h| factor * d.at(*h, *v)).collect::<Vec<_>>());
    let level = |percent: f64| Isoline {
        value: factor * peak * percent / 100.0,
        name: format!("{percent} %"),
        major: percent == 50.0 || percent == 10.0,
    };
    let unit = unit(drawn.luminaire.kind, view.per_klm);
    let [first, second] = if type_c { ["C ", "γ "] } else { ["H ", "V "] };
    Ok(IsocandelaPanel {
        title: title(drawn, view, "isocandela diagram"),
        web: if type_c { Web::Azimuthal } else { Web::Rectangular },
        values: values.collect(),
        horizontal_deg,
        vertical_deg,
        levels: LEVELS_PERCENT.map(level).to_vec(),
        peak_deg: (h, v),
        reach_deg,
        note: format!(
            "100 % = {} {unit} at {first}{}°, {second}{}°",
            signed(&significant(factor * peak, 4)),
            angle(h),
            angle(v)
        ),
    })
}

fn title(drawn: &Drawn<'_>, view: &View, kind: &str) -> String {
    if view.named { drawn.name.to_owned() } else { kind.to_owned() }
}

fn peak(d: &Distribution) -> Result<f64, Error> {
    let (peak, ..) = d.peak();
    if peak > 0.0 { Ok(peak) } else { Err(Error::Dark { in_planes: false }) }
}

/// Planes through the axis of a Type A or B table that are searched for light, degrees.
const SEARCHED_DEG: f64 = 5.0;

/// End of a scale of angles from the axis that takes in all values above the threshold.
fn from_axis(d: &Distribution, threshold: f64) -> f64 {
    let planes: Vec<f64> = match d.system() {
        System::TypeC => d.horizontal_deg().to_vec(),
        System::TypeA | System::TypeB => (0..36).map(|i| SEARCHED_DEG * f64::from(i)).collect(),
    };
    let lit = |plane: f64| {
        let cut = Cut::of(d, plane);
        last_above(cut.angles_deg.iter().copied().zip(cut.values.iter().copied()), threshold)
    };
    reach(planes.into_iter().map(lit).fold(0.0, f64::max))
}

/// End of a scale of H and V, either way, that takes in all values above the threshold.
fn either_way(d: &Distribution, threshold: f64) -> f64 {
    let (h, v) = (d.horizontal_deg(), d.vertical_deg());
    let along_v = (0..h.len()).map(|i| last_above(v.iter().copied().zip(d.plane(i).iter().copied()), threshold));
    let along_h = (0..v.len()).map(|j| last_above(h.iter().enumerate().map(|(i, h)| (*h, d.plane(i)[j])), threshold));
    reach(along_v.chain(along_h).fold(0.0, f64::max))
}

/// A table's own angles within the bounds and even ones between.
fn grid(own: impl Iterator<Item = f64>, low: f64, high: f64) -> Vec<f64> {
    let even = |count: u32| (0..=count).map(move |i| low + (high - low) * f64::from(i) / f64::from(count));
    let between = ((high - low) / STEP_DEG).ceil().max(24.0) as u32;
    let mut out: Vec<f64> = own.filter(|a| (low..=high).contains(a)).chain(even(between)).collect();
    out.sort_by(f64::total_cmp);
    out.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    if out.len() > MOST { even(MOST as u32 - 1).collect() } else { out }
}
