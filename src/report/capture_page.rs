//! The report on a photographed object: what it rests on, how well a model fits, what is missing.

use serde_json::{Map, Value, json};

use super::brdf_fit;
use super::capture_brdf::{Answer, Scale, total};
use super::envelope::Input;
use super::html::{Block, Figure, Page, Section, Table};
use crate::brdf::audit::Audit;
use crate::brdf::fit::{Fit, Uncertainty};
use crate::capture::brdf::{Next, Reciprocity};
use crate::capture::setup::{Camera, Place};
use crate::finding::Finding;
use crate::units::significant;

/// What is found out for a report, beyond the measurements and their fits.
#[derive(Debug, Clone)]
pub struct More {
    /// Of the best fit.
    pub audit: Option<Audit>,
    /// Of the measurements.
    pub reciprocity: Option<Reciprocity>,
    /// Part of the 3° bins within reach of the camera that is covered.
    pub reachable: f64,
    /// Lights that would cover most of the others.
    pub next: Vec<Next>,
    /// By stack: median of the absolute residuals of the best fit and root of the mean of their squares, relative.
    pub residuals: Vec<(String, f64, f64)>,
}

/// `audit`, `reciprocity`, `reachable_coverage_fraction`, `next_lights`, `residuals`.
#[must_use]
pub fn more(m: &More) -> Map<String, Value> {
    let mut out = Map::new();
    if let Some(audit) = &m.audit {
        let mut of = json!({
            "reciprocity_max_relative": audit.reciprocity.map(|w| w.value),
            "negative_fraction": audit.negative_fraction, "passes": audit.passes,
        });
        if let Some((albedo, _, value)) = audit.largest_albedo() {
            of["albedo_max"] = value.into();
            of["albedo_max_at_deg"] = albedo.theta_i_deg.into();
        }
        out.insert("audit".to_owned(), of);
    }
    if let Some(r) = m.reciprocity {
        let of = json!({"bins": r.bins, "median_relative": r.median_relative, "rms_relative": r.rms_relative});
        out.insert("reciprocity".to_owned(), of);
    }
    out.insert("reachable_coverage_fraction".to_owned(), m.reachable.into());
    let next = m.next.iter().map(|n| {
        json!({
            "to_camera_deg": n.to_camera_deg, "direction": n.direction, "new_bins": n.new_bins,
            "reachable_coverage_fraction": n.covered_fraction,
        })
    });
    out.insert("next_lights".to_owned(), next.collect());
    let residuals = m
        .residuals
        .iter()
        .map(|(stack, median, rms)| json!({"stack": stack, "median_absolute_relative": median, "rms_relative": rms}));
    out.insert("residuals".to_owned(), residuals.collect());
    out
}

/// The pictures of the report; a group without one is left out.
#[derive(Debug, Clone, Default)]
pub struct Pictures {
    /// The response curve.
    pub response: Vec<Figure>,
    /// What is covered.
    pub coverage: Vec<Figure>,
    /// Fitted lobes against data.
    pub lobes: Vec<Figure>,
    /// Photographs, model and difference, stack by stack.
    pub maps: Vec<Figure>,
    /// Albedo of the fit, and a sphere of it.
    pub energy: Vec<Figure>,
}

/// Everything that the report is made of.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// Title of the manifest.
    pub title: &'a str,
    /// Measurements and fits.
    pub answer: &'a Answer<'a>,
    /// What was found out besides.
    pub more: &'a More,
    /// Files that were read.
    pub inputs: &'a [Input],
    /// What was noticed.
    pub findings: &'a [Finding],
    /// The camera of the manifest.
    pub camera: &'a Camera,
    /// The pictures.
    pub pictures: &'a Pictures,
}

fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 3))
}

/// A number that rounds to 0 where it is 0 but for rounding.
fn number(value: f64) -> String {
    significant(value, 6)
}

/// The report.
#[must_use]
pub fn page(p: &Parts<'_>) -> Page {
    let a = p.answer;
    let lights = a.seen.iter().filter(|s| s.counts.valid > 0).count();
    let scale = match a.scale {
        Scale::Reference { .. } => "Values are absolute, from the reference.",
        Scale::Strengths { .. } => "Values are absolute, from the stated strengths of the lights.",
        Scale::Relative { .. } => "Values are relative: reflectances are ratios, not values.",
    };
    let best = a.fits.map(|f| &f.fits[brdf_fit::best(f)]);
    let model =
        best.map_or_else(String::new, |f| format!(" Of the models fitted, {} describes them best.", f.template));
    let lead = format!(
        "{} measurements of the BRDF of a {} from {lights} photograph(s). {scale}{model}",
        a.measurements, a.object
    );
    let mut sections = vec![summary(p)];
    sections.extend([coverage(p), fits(p), maps(p), physics(p), next(p), set_up(p), inputs(p)].into_iter().flatten());
    Page { title: p.title.to_owned(), lead, sections }
}

fn summary(p: &Parts<'_>) -> Section {
    let section = Section::new("Findings");
    if p.findings.is_empty() {
        return section.text("Nothing was noticed that would limit the use of the result.");
    }
    let mut findings = p.findings.to_vec();
    findings.sort_by_key(|f| std::cmp::Reverse(f.severity));
    Section { blocks: vec![Block::Findings(findings)], ..section }
}

fn coverage(p: &Parts<'_>) -> Option<Section> {
    let (a, r) = (p.answer, p.answer.binned.resolution);
    // What no pixel is masked for is left out.
    let all = total(a.seen);
    let shown: Vec<usize> = (0..all.len()).filter(|n| *n == 0 || all[*n].1 > 0).collect();
    let head = shown.iter().map(|n| all[*n].0.replace('_', if all[*n].0 == "inter_reflection" { "-" } else { " " }));
    let row = |name: &str, counts: &[(&str, usize)]| {
        std::iter::once(name.to_owned()).chain(shown.iter().map(|n| counts[*n].1.to_string())).collect()
    };
    let mut rows: Vec<Vec<String>> = a.seen.iter().map(|s| row(&s.name, &s.counts.named())).collect();
    rows.push(row("all", &all));
    let pixels = Table {
        caption: "What became of the pixels".to_owned(),
        head: std::iter::once("stack".to_owned()).chain(head).collect(),
        rows,
    };
    let words = format!(
        "{} of {} bins above the horizon are measured ({}), of {} × {} × {} in θh, θd, φd. Of the 3° bins that this camera can \
         see under any light, {} are covered. Where the map is dark or empty, nothing is known but what a model supposes.",
        a.binned.covered,
        a.binned.above_horizon,
        percent(a.binned.coverage_fraction()),
        r.theta_h,
        r.theta_d,
        r.phi_d,
        percent(p.more.reachable)
    );
    let mut section = Section::new("Coverage").text(words);
    if let Some(filling) = a.filling {
        let [measured, inferred, _] = filling.counts();
        section = section.text(format!(
            "On request {inferred} bins were filled by {}, beside {measured} measured ones. They are marked as inferred wherever they \
             are written; nobody measured them, and they have no standard error.",
            filling.by
        ));
    }
    let mut section = section.figures(p.pictures.coverage.clone());
    section.blocks.push(Block::Table(pixels));
    Some(section)
}

fn fits(p: &Parts<'_>) -> Option<Section> {
    let answer = p.answer.fits?;
    let measures = |f: &Fit| {
        let m = &f.measures;
        let delta =
            answer.comparison.and_then(|c| c.ranked.iter().find(|r| std::ptr::eq(&raw const answer.fits[r.fit], f)));
        [
            f.template.to_string(),
            f.estimates.len().to_string(),
            percent(m.relative_rms),
            significant(m.log_rms, 4),
            significant(m.cosine_rms, 4),
            delta.map_or_else(String::new, |r| significant(r.delta_aicc, 4)),
        ]
    };
    let best = &answer.fits[brdf_fit::best(answer)];
    let parameters = best.estimates.iter().map(|e| {
        let (standard, robust) = match e.uncertainty {
            Uncertainty::Known { standard, robust } => (significant(standard, 3), significant(robust, 3)),
            Uncertainty::AtLow => ("at its lower bound".to_owned(), String::new()),
            Uncertainty::AtHigh => ("at its upper bound".to_owned(), String::new()),
            Uncertainty::Inseparable => ("not told apart by the data".to_owned(), String::new()),
            Uncertainty::Undefined => ("unknown".to_owned(), String::new()),
        };
        [brdf_fit::label(answer.samples, best, e), number(e.value), standard, robust]
    });
    let caption = format!("Parameters of {}", best.template);
    Some(
        Section::new("Models")
            .table(
                "Models by how well they describe the measurements",
                ["model", "parameters", "relative rms", "log rms", "cosine rms, 1/sr", "ΔAICc"],
                answer.fits.iter().map(measures).collect(),
            )
            .table(&caption, ["parameter", "value", "standard error", "robust"], parameters.collect())
            .figures(p.pictures.lobes.clone()),
    )
}

fn maps(p: &Parts<'_>) -> Option<Section> {
    if p.pictures.maps.is_empty() {
        return None;
    }
    let row = |(stack, median, rms): &(String, f64, f64)| [stack.clone(), percent(*median), percent(*rms)];
    let object = p.answer.object;
    let words = format!(
        "Each photograph beside the same {object} rendered from the best model under the same light, and their difference where it was \
         measured. A difference that follows the highlight is the model's; one that runs across the {object} is the light's place or \
         strength; a rim is the {object}'s place or size."
    );
    Some(
        Section::new("Photograph and model")
            .text(words)
            .table(
                "Differences, measured over modelled less 1",
                ["stack", "median of absolute", "rms"],
                p.more.residuals.iter().map(row).collect(),
            )
            .figures(p.pictures.maps.clone()),
    )
}

fn physics(p: &Parts<'_>) -> Option<Section> {
    let mut rows = Vec::new();
    if let Some(r) = p.more.reciprocity {
        let what = format!("measurements, light and camera exchanged ({} bins)", r.bins);
        rows.push([what, format!("{} median, {} rms", percent(r.median_relative), percent(r.rms_relative))]);
    }
    if let Some(audit) = &p.more.audit {
        if let Some(worst) = audit.reciprocity {
            let value = if worst.value < 1e-9 {
                "exact".to_owned()
            } else {
                format!("differs by up to {}", percent(worst.value))
            };
            rows.push(["best model, light and camera exchanged".to_owned(), value]);
        }
        if let Some((albedo, _, value)) = audit.largest_albedo() {
            let limit = if value > 1.0 { ": more than arrives" } else { "" };
            let what = format!("best model, largest albedo (at θi = {}°)", albedo.theta_i_deg);
            rows.push([what, format!("{}{limit}", significant(value, 4))]);
        }
        let negative = if audit.negative_fraction > 0.0 { percent(audit.negative_fraction) } else { "none".to_owned() };
        rows.push(["best model, negative values".to_owned(), negative]);
    }
    (!rows.is_empty()).then(|| {
        Section::new("Energy and reciprocity")
            .table("What physics asks of a BRDF", ["of", "found"], rows)
            .figures(p.pictures.energy.clone())
    })
}

fn next(p: &Parts<'_>) -> Option<Section> {
    let section = Section::new("What to photograph next");
    if p.more.next.is_empty() {
        return Some(section.text(
            "No further light would cover bins that are not covered yet: move the camera, or take another shape.",
        ));
    }
    let row = |n: &Next| {
        let [x, y, z] = n.direction.map(|v| format!("{v:.3}"));
        [
            format!("{}°", n.to_camera_deg),
            format!("({x}, {y}, {z})"),
            n.new_bins.to_string(),
            percent(n.covered_fraction),
        ]
    };
    let mut words = "These lights cover most of what is missing, each after the ones above it. ".to_owned();
    words.push_str(match p.answer.object {
        "sphere" => {
            "What counts is the angle between light and camera as seen from the sphere (twice θd); on which side of the camera the \
             light stands makes no difference to an isotropic material."
        }
        _ => "Eight sides of the camera were tried at every angle to it; cast shadows are taken into account.",
    });
    Some(section.text(words).table(
        "Lights to add",
        ["angle to the camera", "direction, from the object", "new bins of 3°", "covered then"],
        p.more.next.iter().map(row).collect(),
    ))
}

fn set_up(p: &Parts<'_>) -> Option<Section> {
    let c = p.camera;
    let mut camera = Vec::new();
    if let Ok(lens) = c.lens() {
        let i = lens.intrinsics;
        camera.push(["fx, fy".to_owned(), format!("{}, {} px", number(i.fx), number(i.fy))]);
        camera.push(["cx, cy".to_owned(), format!("{}, {} px", number(i.cx), number(i.cy))]);
    }
    let lens = c.distortion.map(number).join(", ");
    camera.push(["k1, k2, p1, p2, k3".to_owned(), lens]);
    camera.push(["position".to_owned(), format!("({}) m", c.position_m.map(number).join(", "))]);
    let light = |s: &super::capture_brdf::StackSeen| {
        let place = match s.place {
            Place::Near(at) => format!("at ({}) m", at.map(number).join(", ")),
            Place::Distant(to) => format!("towards ({})", to.map(number).join(", ")),
        };
        [s.light.clone(), place, s.strength.iter().map(|v| number(*v)).collect::<Vec<_>>().join(", ")]
    };
    let mut scale = match p.answer.scale {
        Scale::Reference { reflectance, factor_sd, light_sd, deviation_rms } => {
            let list =
                |all: &[f64], of: &dyn Fn(f64) -> String| all.iter().map(|v| of(*v)).collect::<Vec<_>>().join(", ");
            format!(
                "The scale rests on a reference of reflectance {}, known to {}, which differs from a diffuse one by {} rms. All values \
                 have the first uncertainty in common; those under one light also that of its strength, {} or less. Neither is in the \
                 standard errors.",
                list(reflectance, &number),
                list(factor_sd, &percent),
                percent(*deviation_rms),
                percent(*light_sd)
            )
        }
        Scale::Strengths { unit_w_per_m2_sr } => format!(
            "The scale rests on the strengths of the lights and a radiance of {} W/(m² sr) of a sample of 1 at 1 s.",
            number(*unit_w_per_m2_sr)
        ),
        Scale::Relative { factor } => {
            format!("There is no scale: all was multiplied by {} so that the median is 0.3/π.", number(*factor))
        }
    };
    scale.push_str(" Strengths are over the radiance of a sample of 1 at 1 s.");
    Some(
        Section::new("Set-up")
            .table("Camera", ["", "value"], camera)
            .table("Lights", ["light", "place", "strength per band"], p.answer.seen.iter().map(light).collect())
            .text(scale)
            .figures(p.pictures.response.clone()),
    )
}

fn inputs(p: &Parts<'_>) -> Option<Section> {
    let row = |i: &Input| [i.path.clone(), i.sha256.clone().unwrap_or_default()];
    Some(Section::new("Inputs").table("Files read", ["file", "SHA-256"], p.inputs.iter().map(row).collect()))
}
