//! `render`: what a scene needs, and what its instruments read.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::render::bands::Bands;
use crate::render::build::{Built, Kind};
use crate::render::estimate::{Figure, T_975};
use crate::render::goniophotometer::Measured;
use crate::render::gonioreflectometer;
use crate::render::guiding;
use crate::render::integrator::limits::Follow;
use crate::render::integrator::virtual_lights::Source;
use crate::render::radiosity::Summary;
use crate::render::reading::{Points, Reading, Spectral};
use crate::units::significant;

/// What was modelled, and what was left out and why: `model` of the result.
#[must_use]
pub fn model(built: &Built) -> Value {
    let bands = built.scene.bands();
    let limits = &built.settings.limits;
    let (solver, light) = match limits.follow {
        _ if built.radiosity.is_some() => ("radiosity", "all light, between diffuse patches, without random numbers"),
        _ if !limits.shadows => ("preview", "direct light without shadows; no measurement"),
        Follow::All if built.settings.packets => {
            ("bidirectional", "all light, direct and reflected; by paths from the instruments and from the lights")
        }
        Follow::All => ("path", "all light, direct and reflected"),
        Follow::Specular => ("whitted", "direct light and its reflections in mirrors and glass"),
        Follow::Nothing => ("direct", "direct light alone"),
    };
    let mut left_out = Vec::new();
    if !limits.shadows {
        left_out.push("shadows");
    }
    if limits.follow != Follow::All {
        left_out.push("light that was reflected diffusely before");
    }
    if built.analysis.caustics_missed && limits.follow == Follow::All {
        left_out.push(if built.settings.packets {
            "light of one direction that polished surfaces throw on meters at a point"
        } else {
            "light of one direction that polished surfaces throw on others and on meters"
        });
    }
    if limits.max_edges.is_some() {
        left_out.push("paths longer than max_edges");
    }
    if !built.analysis.dark_lights.is_empty() {
        left_out.push("lights of no flux");
    }
    if !built.analysis.out_of_reach.is_empty() {
        left_out.push("lights that reach no surface and no instrument");
    }
    if built.analysis.polished_surfaces > 0 && !built.analysis.polarisation {
        left_out.push("polarisation");
    }
    let analysis = &built.analysis;
    let suited = !built.settings.packets && Source::of(&built.scene, limits).is_some();
    let virtual_lights = match (suited, built.settings.virtual_lights) {
        (false, _) | (_, Some(false)) => "in no picture",
        (true, Some(true)) => "in every picture",
        (true, None) => "in every picture that has less noise by them in the same time",
    };
    let guiding = match (guiding::suits(&built.scene, limits), built.settings.guiding) {
        (false, _) | (_, Some(false)) => "in no picture",
        (true, Some(true)) => "in every picture to whose diffuse surfaces packets come over polished ones",
        (true, None) => {
            "in every picture to whose diffuse surfaces packets come over polished ones, and which gains by it"
        }
    };
    let paths = match (limits.single_band, analysis.fluorescent.is_empty(), analysis.dispersive.is_empty()) {
        (true, true, _) => "every path carries one of them",
        (true, false, _) => "every path carries one of them, and exchanges it at materials that fluoresce",
        (_, true, true) => "every path carries all of them",
        (_, true, false) => {
            "every path carries all of them, and one from where it is refracted by a material that disperses"
        }
        (_, false, true) => "every path carries all of them, and exchanges them at materials that fluoresce",
        (_, false, false) => {
            "every path carries all of them, one from where it is refracted by a material that disperses, and exchanges them at materials that fluoresce"
        }
    };
    json!({
        "extent": if analysis.full { "full" } else { "minimal" },
        "solver": solver,
        "light": light,
        "reflected_light": if analysis.global { "global" } else { "none: nothing scatters" },
        "polarisation": {
            "followed": analysis.polarisation,
            "because": analysis.polarisation_because,
            "polished_surfaces": analysis.polished_surfaces,
        },
        "caustics": {
            "sought_from_the_lights": built.settings.packets,
            "advised": analysis.caustics,
            "because": analysis.caustics_because,
        },
        "virtual_lights": virtual_lights,
        "branches": if built.settings.packets { Some(1) } else { built.settings.branches },
        "guiding": guiding,
        "denoise": built.denoises,
        "materials": {
            "dispersive": analysis.dispersive,
            "fluorescent": analysis.fluorescent,
            "anisotropic": analysis.anisotropic,
        },
        "lights": {
            "in_closed_form": analysis.closed_form_lights,
            "without_flux": analysis.dark_lights,
            "out_of_reach": analysis.out_of_reach,
        },
        "wavelengths": {
            "count": bands.len(),
            "nm": bands.wavelengths_nm(),
            "relative_error": built.wavelength_error,
            "radiant_relative_error": built.radiant_error,
            "paths": paths,
        },
        "max_edges": limits.max_edges,
        "roulette_from": limits.roulette_from,
        "sampler": built.settings.points.word(),
        "left_out": left_out,
    })
}

/// One of `sensors`; `wavelength_error` is what sums over wavelength are off by at most, relative.
#[must_use]
pub fn sensor(reading: &Reading, wavelength_error: f64) -> Value {
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    set("name", reading.name.clone().into());
    set("quantity", reading.quantity.into());
    set("unit", reading.unit.into());
    set("value", reading.figure.value.into());
    set("standard_error", reading.figure.standard_error.into());
    // Radiosity has no scatter, and errs by its patches.
    if reading.discretisation.is_none()
        && let Some(interval) = interval(&reading.figure, wavelength_error)
    {
        set("expanded_95", json!(interval));
    }
    set("samples", reading.samples.into());
    if let Some(difference) = reading.discretisation {
        set("discretisation", difference.into());
    }
    if let Some(radiant) = reading.radiant {
        let unit = match reading.unit {
            "lx" => "W/m2",
            "lm" => "W",
            _ => "W/m2/sr",
        };
        set("radiant", json!({"unit": unit, "value": radiant.value, "standard_error": radiant.standard_error}));
    }
    if let Some((relative, reached)) = reading.target {
        set("target", json!({"relative_standard_error": relative, "reached": reached}));
    }
    if reading.faults.count() > 0 {
        let f = &reading.faults;
        set("faulty_samples", json!({"nan": f.nan, "infinite": f.infinite, "negative": f.negative}));
    }
    if let Some(price) = &reading.denoised {
        set("denoised", json!({"relative_error_before": price.before, "relative_error": price.after}));
    }
    if let Some(spectral) = &reading.spectral {
        set("spectrum", spectrum(spectral));
    }
    if let Some(points) = &reading.points {
        set("grid", grid(points));
    }
    if let Some(measured) = &reading.intensities {
        set("intensity", intensity(measured));
    }
    if let Some(measured) = &reading.brdf {
        let each = |of: &dyn Fn(&gonioreflectometer::Lobe) -> Value| measured.lobes.iter().map(of).collect::<Vec<_>>();
        let bands =
            |of: fn(&Figure) -> f64| each(&|lobe| lobe.reflectance.bands().iter().map(of).collect::<Vec<_>>().into());
        set(
            "brdf",
            json!({
                "theta_i_deg": each(&|lobe| lobe.incident_deg[0].into()),
                "phi_i_deg": each(&|lobe| lobe.incident_deg[1].into()),
                "theta_o_deg": measured.theta_deg,
                "phi_o_deg": measured.phi_deg,
                "reflectance": bands(|f| f.value),
                "standard_errors": bands(|f| f.standard_error),
            }),
        );
    }
    out.into()
}

/// The interval of 95 % of a reading, with what its wavelengths may leave out on both sides; `None` where neither is known to be above 0.
fn interval(figure: &Figure, wavelength_error: f64) -> Option<[f64; 2]> {
    let left_out = wavelength_error * figure.value.abs();
    let [low, high] = figure.stated().expanded_95;
    (figure.standard_error + left_out > 0.0).then_some([low - left_out, high + left_out])
}

/// By ascending wavelength: bands are those of densities, then lines.
fn ascending(s: &Spectral) -> Vec<(&f64, &Figure)> {
    let mut bands: Vec<_> = s.wavelengths_nm.iter().zip(&s.bands).collect();
    bands.sort_by(|a, b| a.0.total_cmp(b.0));
    bands
}

fn spectrum(s: &Spectral) -> Value {
    let bands = ascending(s);
    json!({
        "wavelengths_nm": bands.iter().map(|(nm, _)| **nm).collect::<Vec<_>>(),
        "values": bands.iter().map(|(_, b)| b.value).collect::<Vec<_>>(),
        "standard_errors": bands.iter().map(|(_, b)| b.standard_error).collect::<Vec<_>>(),
        "xyz": s.xyz,
        "chromaticity_xy": s.chromaticity_xy,
        "cct_k": s.cct_k,
        "duv": s.duv,
    })
}

fn grid(p: &Points) -> Value {
    let rows = |of: fn(&Figure) -> f64| -> Vec<Vec<f64>> {
        p.figures.chunks(p.counts[0]).map(|row| row.iter().map(of).collect()).collect()
    };
    let values = || p.figures.iter().map(|f| f.value);
    json!({
        "points": p.counts,
        "size_m": p.map.size_m(),
        "minimum": values().fold(f64::INFINITY, f64::min),
        "maximum": values().fold(f64::NEG_INFINITY, f64::max),
        "values": rows(|f| f.value),
        "standard_errors": rows(|f| f.standard_error),
    })
}

/// Row by row: one C-plane each.
fn intensity(m: &Measured) -> Value {
    let planes =
        |values: Vec<f64>| -> Vec<Vec<f64>> { values.chunks(m.gamma_deg.len()).map(<[f64]>::to_vec).collect() };
    json!({
        "unit": "cd",
        "table_flux_lm": m.luminaire("").map(|lamp| lamp.distribution.total_flux()).ok(),
        "c_deg": m.c_deg,
        "gamma_deg": m.gamma_deg,
        "values": planes(m.intensity.iter().map(|f| f.value).collect()),
        "standard_errors": planes(m.intensity.iter().map(|f| f.standard_error).collect()),
        "scattered": planes(m.scattered.clone()),
    })
}

/// The BRDF of a sample as the table that `photopic brdf` reads, with a column for the standard errors.
#[must_use]
pub fn brdf_csv(measured: &gonioreflectometer::Measured, bands: &Bands) -> String {
    let mut out = String::from("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,wavelength_nm,value,standard_error\n");
    let wavelengths = bands.wavelengths_nm();
    for lobe in &measured.lobes {
        let [theta_i, phi_i] = lobe.incident_deg;
        for (cell, figures) in lobe.values.chunks(wavelengths.len()).enumerate() {
            let (row, column) = (cell / measured.phi_deg.len(), cell % measured.phi_deg.len());
            // The normal has one direction, whatever its azimuth.
            if row == 0 && column > 0 {
                continue;
            }
            let (theta_o, phi_o) = (measured.theta_deg[row], measured.phi_deg[column]);
            for (index, (nm, f)) in wavelengths.iter().zip(figures).enumerate() {
                // A line may stand where a density is sampled as well; both have the same BRDF.
                if !wavelengths[..index].contains(nm) {
                    // Writing to a string cannot fail.
                    let _ = writeln!(out, "{theta_i},{phi_i},{theta_o},{phi_o},{nm},{},{}", f.value, f.standard_error);
                }
            }
        }
    }
    out
}

/// The points of a grid as a table: `x_m,y_m,z_m`, the reading and its standard error, row by row along the first edge.
#[must_use]
pub fn grid_csv(points: &Points, quantity: &str, unit: &str) -> String {
    let mut out = format!("x_m,y_m,z_m,{quantity}_{unit},standard_error_{unit}\n");
    for (index, figure) in points.figures.iter().enumerate() {
        let p = points.position(index);
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{},{},{},{},{}", p.x, p.y, p.z, figure.value, figure.standard_error);
    }
    out
}

/// What a render took, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seconds {
    /// All of it.
    pub total: f64,
    /// Reading and preparing the scene.
    pub scene: f64,
    /// Sampling, and what is left beside the others.
    pub rendering: f64,
    /// Packing and writing pictures, and making those for the eye.
    pub writing: f64,
    /// Looking where the energy goes and what the solver leaves out.
    pub audits: f64,
}

/// The result of a render, one object of `results`.
#[must_use]
pub fn result(built: &Built, readings: &[Reading], written: &[String], seconds: &Seconds) -> Value {
    json!({
        "sensors": readings.iter().map(|r| sensor(r, built.wavelength_error.unwrap_or(0.0))).collect::<Vec<_>>(),
        "model": model(built),
        "written": written,
        "seconds": seconds.total,
        "seconds_of": {
            "scene": seconds.scene,
            "rendering": seconds.rendering,
            "writing": seconds.writing,
            "audits": seconds.audits,
        },
    })
}

/// The readings for people.
#[must_use]
pub fn text(built: &Built, readings: &[Reading]) -> String {
    let mut out = String::new();
    let width = readings.iter().map(|r| r.name.chars().count()).max().unwrap_or(0);
    // Writing to a string cannot fail.
    for r in readings {
        if let Some(difference) = r.discretisation {
            let (value, unit) = (significant(r.figure.value, 5), r.unit.replace("m2", "m²"));
            let (difference, what) = (significant(difference, 2), r.quantity);
            let _ = writeln!(
                out,
                "{:width$}  {value} {unit} ({what}; within about {difference} {unit}, from patches twice as long)",
                r.name
            );
        } else {
            let percent =
                if r.figure.value == 0.0 { 0.0 } else { 100.0 * r.figure.standard_error / r.figure.value.abs() };
            // One sample does not tell its own error.
            let [error, share] = match r.figure.standard_error.is_nan() {
                true => ["unknown".to_owned(), String::new()],
                false => [significant(r.figure.standard_error, 2), format!(", {} %", significant(percent, 2))],
            };
            let _ = writeln!(
                out,
                "{:width$}  {} ± {error} {} ({}{share}, {} samples)",
                r.name,
                significant(r.figure.value, 5),
                r.unit.replace("m2", "m²"),
                r.quantity,
                r.samples
            );
        }
        if let Some(price) = &r.denoised {
            let [before, after] = [price.before, price.after].map(|error| significant(100.0 * error, 2));
            let _ = writeln!(out, "{:width$}  pixels filtered: off by {after} % (as sampled {before} %)", "");
        }
        if let Some(p) = &r.points {
            let values = || p.figures.iter().map(|f| f.value);
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            let _ = writeln!(
                out,
                "{:width$}  {} × {} points, {} to {} {}, {}",
                "",
                p.counts[0],
                p.counts[1],
                significant(low, 4),
                significant(high, 4),
                r.unit,
                if r.figure.value == 0.0 {
                    "no uniformity: all is dark".to_owned()
                } else {
                    format!("uniformity U0 {}", significant(low / r.figure.value, 3))
                }
            );
        }
        if let Some(m) = &r.intensities {
            let (index, peak) = (m.intensity.iter().enumerate())
                .fold((0, 0.0), |best, (i, f)| if f.value > best.1 { (i, f.value) } else { best });
            let rows = m.gamma_deg.len();
            let error = m.intensity.iter().map(|f| f.standard_error).fold(0.0, f64::max);
            let _ = writeln!(
                out,
                "{:width$}  {} × {} directions, peak {} cd at C {}°, γ {}°; largest standard error {} cd",
                "",
                m.c_deg.len(),
                rows,
                significant(peak, 5),
                m.c_deg[index / rows],
                m.gamma_deg[index % rows],
                significant(error, 2)
            );
        }
        if let Some(s) = &r.spectral {
            let cct =
                s.cct_k.map_or_else(|| "no colour temperature".to_owned(), |k| format!("{} K", significant(k, 4)));
            let duv = s.duv.map_or_else(String::new, |d| format!(", Duv {d:.4}"));
            let xy = s.chromaticity_xy.map_or_else(String::new, |[x, y]| format!(", x {x:.4}, y {y:.4}"));
            let _ = writeln!(out, "{:width$}  {cct}{duv}{xy}", "");
            out.push_str(&spectrum_text(s, r.unit, width));
        }
        if let Some((relative, reached)) = r.target {
            let reached = if reached { "reached" } else { "not reached" };
            let _ = writeln!(out, "{:width$}  the target of {} % was {reached}", "", significant(100.0 * relative, 3));
        }
        if r.faults.count() > 0 {
            let _ = writeln!(
                out,
                "{:width$}  {} samples were no numbers or negative and were left out",
                "",
                r.faults.count()
            );
        }
    }
    let bands = built.scene.bands().len();
    let error = wavelength_errors(built).map_or_else(String::new, |errors| format!(" ({errors})"));
    let _ = writeln!(out, "\n{bands} wavelengths on every path{error}");
    if readings.iter().any(|r| r.discretisation.is_none()) {
        let interval = format!(
            "{T_975:.2} times as much on either side, and the error of the sums over wavelength, hold the true value in 95 of 100 renders"
        );
        let _ = writeln!(out, "± is one standard error; {interval}");
    }
    out
}

/// What sums over wavelength are off by at most, in words; `None` where the step was asked for.
fn wavelength_errors(built: &Built) -> Option<String> {
    let [error, watts] = [built.wavelength_error?, built.radiant_error?].map(|e| significant(e, 2));
    Some(format!("error of their sum up to {error}, of watts up to {watts}"))
}

/// A spectrum in rows of as many wavelengths as a line holds.
fn spectrum_text(s: &Spectral, unit: &str, indent: usize) -> String {
    const ROW: usize = 6;
    let per_nm = match unit {
        "lx" => "W/(m² nm)",
        "lm" => "W/nm",
        _ => "W/(m² sr nm)",
    };
    let mut out = format!("{:indent$}  spectrum, nm: {per_nm} (of a line its whole amount)\n", "");
    let cells: Vec<String> =
        ascending(s).iter().map(|(nm, band)| format!("{nm}: {}", significant(band.value, 4))).collect();
    let wide = cells.iter().map(String::len).max().unwrap_or(0);
    for row in cells.chunks(ROW) {
        let row: Vec<String> = row.iter().map(|cell| format!("{cell:wide$}")).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{:indent$}    {}", "", row.join("  ").trim_end());
    }
    out
}

/// What a solution by radiosity was like: `radiosity` of the result.
#[must_use]
pub fn radiosity(s: &Summary) -> Value {
    json!({
        "patches": s.patches,
        "patch_edge_m": s.edge_m,
        "links": s.links,
        "sweeps": s.sweeps,
        "residual": s.residual,
        "greatest_sum_of_form_factors": s.greatest_sum,
        "emitted_w": s.emitted_w,
        "absorbed_w": s.absorbed_w,
        "escaped_w": s.escaped_w,
        "balance_w": s.balance_w(),
    })
}

/// The same for people.
#[must_use]
pub fn radiosity_text(s: &Summary) -> String {
    let f = significant;
    format!(
        "radiosity: {} patches with edges of {} m, {} sweeps, residual {}; form factors sum up to at most {}\n           {} W emitted, {} W absorbed, {} W escaped; unaccounted for: {} W\n",
        s.patches,
        f(s.edge_m, 3),
        s.sweeps,
        f(s.residual, 2),
        f(s.greatest_sum, 7),
        f(s.emitted_w, 5),
        f(s.absorbed_w, 5),
        f(s.escaped_w, 3),
        f(s.balance_w(), 2)
    )
}

/// What a scene holds: `--check`.
#[must_use]
pub fn contents(built: &Built) -> Value {
    let q = &built.quantities;
    let dot = |values: &[f64], weights: &[f64]| values.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>();
    let mut flux = vec![0.0; built.scene.bands().len()];
    let lights: Vec<Value> = (built.scene.lights().iter().enumerate())
        .map(|(n, light)| {
            light.flux(&mut flux);
            let name = built.light_names.get(n).cloned();
            json!({"name": name, "flux_lm": dot(&flux, &q.luminous), "flux_w": dot(&flux, &q.radiant)})
        })
        .collect();
    let sensors: Vec<Value> = (built.instruments.iter())
        .map(|i| {
            let (kind, count) = match &i.kind {
                Kind::Meter(m) => (crate::render::reading::quantity(&m.response).0, 1),
                Kind::Grid { meters, .. } => (crate::render::reading::quantity(&meters[0].response).0, meters.len()),
                Kind::Gonioreflectometer(g) => ("brdf", g.pairs()),
                Kind::Goniophotometer(g) => ("intensity", g.directions()),
                Kind::Camera(c) => ("picture", c.width() as usize * c.height() as usize),
            };
            json!({"name": i.name, "kind": kind, "points": count})
        })
        .collect();
    json!({
        "surfaces": built.scene.surfaces().shapes().len(),
        "lights": lights,
        "sensors": sensors,
        "model": model(built),
    })
}

/// What a scene holds, for people.
#[must_use]
pub fn contents_text(built: &Built) -> String {
    let contents = contents(built);
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(out, "{} surfaces", built.scene.surfaces().shapes().len());
    for light in contents["lights"].as_array().into_iter().flatten() {
        let figure = |key: &str| significant(light[key].as_f64().unwrap_or(0.0), 5);
        let name = light["name"].as_str().unwrap_or("light");
        let _ = writeln!(out, "light   {name}: {} lm, {} W", figure("flux_lm"), figure("flux_w"));
    }
    for sensor in contents["sensors"].as_array().into_iter().flatten() {
        let (name, kind) = (sensor["name"].as_str().unwrap_or(""), sensor["kind"].as_str().unwrap_or(""));
        let _ = writeln!(out, "sensor  {name}: {kind}, {} points", sensor["points"]);
    }
    let bands = built.scene.bands();
    let error = wavelength_errors(built).map_or_else(String::new, |errors| format!(", {errors}"));
    let analysis = &built.analysis;
    let paths = contents["model"]["wavelengths"]["paths"].as_str().unwrap_or_default();
    let _ = writeln!(out, "{} wavelengths{error}: {paths}", bands.len());
    let followed = if analysis.polarisation { "followed" } else { "left out" };
    let _ = writeln!(out, "polarisation is {followed}: {}", analysis.polarisation_because);
    if analysis.caustics && !built.settings.packets && built.settings.limits.follow == Follow::All {
        let _ = writeln!(
            out,
            "pictures, and meters on surfaces and flat grids, gain by `solver = \"bidirectional\"`: {}",
            analysis.caustics_because
        );
    }
    if !analysis.global {
        let _ = writeln!(out, "nothing scatters: there is only the light of the lamps");
    }
    for light in &analysis.dark_lights {
        let _ = writeln!(out, "light   {light}: left out, it has no flux");
    }
    for light in &analysis.out_of_reach {
        let _ = writeln!(out, "light   {light}: left out, it reaches no surface and no instrument");
    }
    out
}
