//! From BRDFs to panels: lobes in the plane of incidence, albedo over angle, a lit sphere, the lobe in space, MERL's slice.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, dvec3};

use crate::brdf::Brdf;
use crate::brdf::audit::{ALBEDO_DEG, MeasuredPart};
use crate::brdf::coordinates::HalfDiff;
use crate::colorimetry::observer::Observer;
use crate::colorimetry::rgb;
use crate::geometry::direction::{from_degrees, tangents};

use super::{CurvesPanel, Lobe, LobePanel, NamedCurve, RasterPanel, SurfacePanel};

/// Outgoing angles of a lobe in the plane of incidence, −90° to 90°, fine about the mirror direction.
fn angles(theta_i_deg: f64) -> Vec<f64> {
    let mut out: Vec<f64> = (-1799..=1799).map(|i| 0.05 * f64::from(i)).collect();
    // A logarithmic net about the mirror direction finds needles.
    for k in 0..60 {
        let d = 10f64.powf(-4.0 + 4.0 * f64::from(k) / 60.0);
        out.extend([theta_i_deg - d, theta_i_deg, theta_i_deg + d]);
    }
    out.extend([-89.999, 89.999]);
    out.retain(|t| t.abs() < 90.0);
    out.sort_by(f64::total_cmp);
    out.dedup();
    out
}

/// Values of a band in the plane of incidence.
struct Plane {
    /// NaN where it was not measured.
    measured: Vec<(f64, f64)>,
    /// The table's guess where it was not measured, up to the measured places beside it; NaN elsewhere.
    guessed: Vec<(f64, f64)>,
}

impl Plane {
    fn of(brdf: &dyn Brdf, theta_i_deg: f64, band: usize) -> Self {
        let incident = from_degrees(theta_i_deg, 180.0);
        let mut values = vec![0.0; brdf.bands()];
        let all: Vec<(f64, f64, bool)> = (angles(theta_i_deg).into_iter())
            .map(|t| {
                let outgoing = from_degrees(t.abs(), if t < 0.0 { 180.0 } else { 0.0 });
                brdf.evaluate(incident, outgoing, &mut values);
                (t, values[band], brdf.is_measured(incident, outgoing))
            })
            .collect();
        let shown = |(t, v, _): &(f64, f64, bool), is: bool| (*t, if is { *v } else { f64::NAN });
        let unknown = |i: usize| all.get(i).is_some_and(|a| !a.2);
        let beside = |i: usize| unknown(i) || unknown(i + 1) || i > 0 && unknown(i - 1);
        Self {
            measured: all.iter().map(|a| shown(a, a.2)).collect(),
            guessed: all.iter().enumerate().map(|(i, a)| shown(a, beside(i))).collect(),
        }
    }
}

/// Lobes of a band as a polar drawing.
#[must_use]
pub fn lobe_panel(brdf: &dyn Brdf, title: &str, thetas_deg: &[f64], band: usize) -> LobePanel {
    let mut specular = vec![0.0; brdf.bands()];
    let lobes = thetas_deg.iter().map(|t| {
        brdf.specular(from_degrees(*t, 180.0), &mut specular);
        let Plane { measured, guessed } = Plane::of(brdf, *t, band);
        Lobe { theta_i_deg: *t, samples: measured, guessed, dirac: specular[band] }
    });
    LobePanel { title: title.to_owned(), lobes: lobes.collect(), unit: "1/sr".to_owned() }
}

/// The same lobes over the outgoing angle, logarithmic.
#[must_use]
pub fn log_panel(brdf: &dyn Brdf, thetas_deg: &[f64], band: usize) -> CurvesPanel {
    let curve = |t: &f64| {
        let Plane { measured, guessed } = Plane::of(brdf, *t, band);
        NamedCurve { name: format!("light at {t}°"), points: measured, dashed: guessed }
    };
    CurvesPanel {
        title: "plane of incidence".to_owned(),
        x_label: "outgoing angle [°], the light comes from the left".to_owned(),
        x_step: Some(30.0),
        y_label: "BRDF [1/sr]".to_owned(),
        curves: thetas_deg.iter().map(curve).collect(),
        logarithmic: true,
        level: None,
        dashes: "not measured: the table's guess".to_owned(),
    }
}

/// Albedo over the angle of incidence, a curve per band. Of a table the part that was measured, and dashed what its guesses make of it.
#[must_use]
pub fn albedo_panel(brdf: &dyn Brdf, names: &[String]) -> CurvesPanel {
    let mut curves: Vec<NamedCurve> =
        names.iter().map(|n| NamedCurve { name: n.clone(), ..NamedCurve::default() }).collect();
    let [mut whole, mut measured] = [vec![0.0; brdf.bands()], vec![0.0; brdf.bands()]];
    let (phi, thetas) = lit_at(brdf);
    let mut all_measured = true;
    for theta in thetas {
        let incident = from_degrees(theta, phi);
        brdf.albedo(incident, &mut whole);
        if is_covered(brdf, incident) {
            measured.copy_from_slice(&whole);
        } else {
            all_measured = false;
            MeasuredPart(brdf).albedo(incident, &mut measured);
        }
        for (curve, (whole, measured)) in curves.iter_mut().zip(whole.iter().zip(&measured)) {
            curve.points.push((theta, *measured));
            curve.dashed.push((theta, *whole));
        }
    }
    if all_measured {
        curves.iter_mut().for_each(|c| c.dashed.clear());
    }
    CurvesPanel {
        title: "directional-hemispherical reflectance".to_owned(),
        x_label: "angle of incidence [°]".to_owned(),
        x_step: Some(15.0),
        y_label: "albedo".to_owned(),
        curves,
        logarithmic: false,
        level: Some(1.0),
        dashes: "with the table's guess where nothing was measured".to_owned(),
    }
}

/// The azimuth and the angles of incidence of an albedo: those at which a table was lit, where they are few.
fn lit_at(brdf: &dyn Brdf) -> (f64, Vec<f64>) {
    let lit = brdf.incidences_deg().unwrap_or_default();
    let phi = lit.first().map_or(180.0, |l| l[1]);
    let mut thetas: Vec<f64> = lit.iter().filter(|l| l[1] == phi).map(|l| l[0]).collect();
    thetas.sort_by(f64::total_cmp);
    thetas.dedup();
    // One angle makes no curve.
    if thetas.len() > 1 { (phi, thetas) } else { (180.0, ALBEDO_DEG.to_vec()) }
}

/// Whether all outgoing directions of a net were measured.
fn is_covered(brdf: &dyn Brdf, incident: DVec3) -> bool {
    let thetas = (0..30).map(|i| 1.5 + 3.0 * f64::from(i));
    let mut net = thetas.flat_map(|theta| (0..36).map(move |k| from_degrees(theta, 10.0 * f64::from(k))));
    net.all(|outgoing| brdf.is_measured(incident, outgoing))
}

/// From values per band to linear sRGB where a white diffuser is (1, 1, 1).
#[derive(Debug, Clone, PartialEq)]
pub struct Tint(Vec<[f64; 3]>);

impl Tint {
    /// For wavelengths: the CIE 1931 observer under light that looks like the display's white.
    #[must_use]
    pub fn of_wavelengths(wavelengths_nm: &[f64]) -> Self {
        let [x, y, z] = Observer::Cie1931.colour_matching_functions();
        let Some(matrix) = rgb::SRGB.from_xyz() else { return Self::grey(wavelengths_nm.len()) };
        let mut weights: Vec<DVec3> =
            wavelengths_nm.iter().map(|w| matrix * dvec3(x.at(*w), y.at(*w), z.at(*w))).collect();
        let white: DVec3 = weights.iter().copied().sum();
        // Each channel's weights sum to one: white stays white, whatever the wavelengths.
        if wavelengths_nm.len() < 8 || white.min_element() <= 0.0 {
            return Self::grey(wavelengths_nm.len());
        }
        weights.iter_mut().for_each(|w| *w /= white);
        Self(weights.into_iter().map(|w| w.to_array()).collect())
    }

    /// Three channels are red, green and blue; of others the mean is grey.
    #[must_use]
    pub fn of_channels(channels: usize) -> Self {
        match channels {
            3 => Self(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
            n => Self::grey(n),
        }
    }

    fn grey(bands: usize) -> Self {
        Self(vec![[1.0 / bands.max(1) as f64; 3]; bands])
    }

    pub(super) fn pixel(&self, values: &[f64], exposure: f64) -> [u8; 3] {
        let mut sum = [0.0; 3];
        for (v, weight) in values.iter().zip(&self.0) {
            sum.iter_mut().zip(weight).for_each(|(s, w)| *s += v * w);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let encode = |v: f64| (255.0 * rgb::SRGB.encoding.encode((exposure * v).clamp(0.0, 1.0))).round() as u8;
        sum.map(encode)
    }
}

/// A sphere seen from afar, lit by a small lamp from the upper right behind the eye, in some ambient light from everywhere (by the
/// albedo, so that mirrors are not black). Pixels for whose directions a table was not measured are [`UNMEASURED`].
#[must_use]
pub fn sphere_panel(brdf: &dyn Brdf, tint: &Tint) -> RasterPanel {
    const SIDE: u32 = 320;
    let light = dvec3(0.45, 0.55, 0.7).normalize();
    let mut values = vec![0.0; brdf.bands()];
    // Ambient light: the albedo towards the eye, tabulated over the angle.
    let ambient: Vec<Vec<f64>> = ALBEDO_DEG
        .map(|t| {
            brdf.albedo(from_degrees(t, 0.0), &mut values);
            values.clone()
        })
        .to_vec();
    let mut guesses = false;
    let mut pixels = Vec::with_capacity(3 * (SIDE * SIDE) as usize);
    for i in 0..SIDE * SIDE {
        let coordinate = |n: u32| 2.1 * (f64::from(n) + 0.5) / f64::from(SIDE) - 1.05;
        let (x, y) = (coordinate(i % SIDE), -coordinate(i / SIDE));
        let rest = 1.0 - x * x - y * y;
        if rest <= 0.0 {
            pixels.extend([236, 236, 238]);
            continue;
        }
        let normal = dvec3(x, y, rest.sqrt());
        let (t, b) = tangents(normal);
        let local = |d: DVec3| dvec3(d.dot(t), d.dot(b), d.dot(normal));
        let (incident, outgoing) = (local(light), local(DVec3::Z));
        if incident.z > 0.0 && !brdf.is_measured(incident, outgoing) {
            guesses = true;
            pixels.extend(UNMEASURED);
            continue;
        }
        brdf.evaluate(incident, outgoing, &mut values);
        let theta = normal.z.acos().to_degrees();
        let above = ALBEDO_DEG.partition_point(|a| *a < theta).clamp(1, ALBEDO_DEG.len() - 1);
        let (low, high) = (ALBEDO_DEG[above - 1], ALBEDO_DEG[above]);
        let share = ((theta - low) / (high - low)).min(1.0);
        for (v, (a, b)) in values.iter_mut().zip(ambient[above - 1].iter().zip(&ambient[above])) {
            *v = *v * incident.z.max(0.0) * PI + 0.12 * (a + share * (b - a));
        }
        pixels.extend(tint.pixel(&values, 0.9));
    }
    RasterPanel {
        title: "lit sphere".to_owned(),
        side: SIDE,
        pixels,
        caption: if guesses {
            "a small lamp, a little light from everywhere; lilac: not measured".to_owned()
        } else {
            "a small lamp, and a little light from everywhere".to_owned()
        },
    }
}

/// The slice of Burley's picture of MERL materials (S. McAuley, S. Hill et al. (eds.), "Practical physically based shading", SIGGRAPH
/// 2012 course): θ_h to the right, θ_d upwards, both 0° to 90°, at φ_d = 90°. Highlights stand at the left edge, Fresnel's rise at the
/// top, retro-reflection at the bottom, the diffuse part in the middle.
///
/// π f is drawn, encoded as sRGB: a white diffuser is white, what is brighter is cut. Places that were not measured have
/// [`UNMEASURED`].
#[must_use]
pub fn slice_panel(brdf: &dyn Brdf, tint: &Tint) -> RasterPanel {
    const SIDE: u32 = 180;
    let mut values = vec![0.0; brdf.bands()];
    let mut pixels = Vec::with_capacity(3 * (SIDE * SIDE) as usize);
    for i in 0..SIDE * SIDE {
        let angle = |n: u32| (f64::from(n) + 0.5) / f64::from(SIDE) * FRAC_PI_2;
        let (theta_h, theta_d) = (angle(i % SIDE), angle(SIDE - 1 - i / SIDE));
        let (incident, outgoing) = HalfDiff { theta_h, phi_h: 0.0, theta_d, phi_d: FRAC_PI_2 }.directions();
        if incident.z <= 0.0 || outgoing.z <= 0.0 || !brdf.is_measured(incident, outgoing) {
            pixels.extend(UNMEASURED);
            continue;
        }
        brdf.evaluate(incident, outgoing, &mut values);
        pixels.extend(tint.pixel(&values, PI));
    }
    RasterPanel {
        title: "slice at φd = 90°".to_owned(),
        side: SIDE,
        pixels,
        caption: "right: θh 0° to 90°; up: θd 0° to 90°; white is π f = 1; lilac: not measured".to_owned(),
    }
}

/// The colour of places that were not measured, or lie below the horizon.
pub const UNMEASURED: [u8; 3] = [214, 214, 236];

/// The lobe of one band in space, radius ∝ the cube root of the value: a needle on a broad foot shows both.
#[must_use]
pub fn surface_panel(brdf: &dyn Brdf, theta_i_deg: f64, band: usize) -> SurfacePanel {
    let incident = from_degrees(theta_i_deg, 180.0);
    let mut values = vec![0.0; brdf.bands()];
    let directions: Vec<Vec<DVec3>> = (0..=44)
        .map(|i| {
            let theta = (2.0 * f64::from(i)).max(0.01);
            (0..90).map(|k| from_degrees(theta, 4.0 * f64::from(k))).collect()
        })
        .collect();
    let measured: Vec<Vec<bool>> =
        directions.iter().map(|ring| ring.iter().map(|d| brdf.is_measured(incident, *d)).collect()).collect();
    let mut place = |direction: &DVec3| {
        brdf.evaluate(incident, *direction, &mut values);
        (*direction * values[band].max(0.0).cbrt()).to_array()
    };
    let mut rings: Vec<Vec<[f64; 3]>> = directions.iter().map(|ring| ring.iter().map(&mut place).collect()).collect();
    let largest = rings.iter().flatten().map(|p| DVec3::from_array(*p).length()).fold(0.0, f64::max);
    if largest > 0.0 {
        rings.iter_mut().flatten().for_each(|p| *p = p.map(|v| v / largest));
    }
    let mut caption = "radius: cube root of the BRDF, relative to the largest".to_owned();
    if measured.iter().flatten().any(|m| !m) {
        caption += "; pale: not measured";
    }
    SurfacePanel {
        title: format!("lobe, light at {theta_i_deg}°"),
        rings,
        measured,
        light: incident.to_array(),
        caption,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brdf::lambert::Lambert;

    #[test]
    fn the_slice_of_a_diffuser_is_one_grey() {
        let lambert = Lambert::new(vec![0.5; 3]).expect("a reflectance");
        let panel = slice_panel(&lambert, &Tint::of_channels(3));
        // IEC 61966-2-1: 0.5 is encoded as 187.5 of 255 (1.055 · 0.5^(1/2.4) − 0.055 = 0.73536).
        let (all, _) = panel.pixels.as_chunks::<3>();
        assert!(all.iter().all(|p| *p == [188; 3] || *p == UNMEASURED));
        let at = |x: usize, y: usize| all[y * panel.side as usize + x];
        // At φ_d = 90° both directions have the height cosθ_h cosθ_d: nothing lies below the horizon.
        assert_eq!([at(0, 0), at(179, 0), at(0, 179), at(179, 179), at(90, 90)], [[188; 3]; 5]);
    }
}
