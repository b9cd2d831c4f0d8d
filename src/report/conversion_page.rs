//! The report on one measured spectrum: inputs, method, figures with their uncertainties, pictures, budget, findings.

use serde_json::{Map, Value};

use super::csv::at;
use super::envelope::Input;
use super::html::{Block, Figure, Page, Section};
use super::uncertainty::{leading, measured_path, shown};
use crate::conversion::{Conversion, XyzScale};
use crate::finding::Finding;
use crate::photometry::alpha_opic::RECEPTORS;
use crate::photometry::hazard::WEIGHTINGS;
use crate::photometry::risk::{Assessment, Hazard, Risk};
use crate::uncertainty::{Measurand, Uncertainty};
use crate::units::{significant, to_uncertainty};

/// Everything that the report is made of.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// What was measured.
    pub title: &'a str,
    /// The files that were read: the measurement, the budget.
    pub inputs: &'a [Input],
    /// The settings as the envelope has them.
    pub settings: &'a Value,
    /// The conversion and its JSON object.
    pub conversion: &'a Conversion,
    /// The object in `results[]`.
    pub result: &'a Map<String, Value>,
    /// What the figures are worth, where a budget was given.
    pub uncertainty: Option<&'a Uncertainty>,
    /// The pictures.
    pub figures: &'a [Figure],
    /// What was noticed.
    pub findings: &'a [Finding],
}

/// The report.
#[must_use]
pub fn page(p: &Parts<'_>) -> Page {
    let quantity = match p.conversion.quantity {
        _ if p.conversion.xyz_scale == XyzScale::PerfectDiffuser => "A reflectance".to_owned(),
        crate::spectrum::Quantity::Relative => "A relative spectrum".to_owned(),
        q => format!("Spectral {q}"),
    };
    let (low, high) = p.conversion.integration.range_nm;
    let lead = format!("{quantity}, {low}–{high} nm, {} samples.", p.conversion.integration.samples);
    let mut sections = vec![figures(p)];
    if !p.figures.is_empty() {
        sections.push(Section::new("Pictures").figures(p.figures.to_vec()));
    }
    sections.extend(p.conversion.risk.as_ref().and_then(risk));
    sections.extend(p.uncertainty.map(|u| budget(u, p)));
    sections.extend(instrument(p.result));
    sections.push(method(p));
    let findings = match p.findings {
        [] => Block::Text("Nothing was noticed.".to_owned()),
        all => Block::Findings(all.to_vec()),
    };
    sections.push(Section { title: "Findings".to_owned(), blocks: vec![findings] });
    Page { title: p.title.to_owned(), lead, sections }
}

/// Figures of the report with label and unit: those of the text, then indices, α-opic and hazard-weighted quantities.
fn rows(p: &Parts<'_>) -> Vec<(Measurand, String, &'static str)> {
    use Measurand as M;
    let quantity = p.conversion.quantity;
    let mut all = shown(quantity);
    all.retain(|(m, ..)| !matches!(m, M::SpecialIndex(_)));
    all.extend((0..14).map(|k| (M::SpecialIndex(k), M::SpecialIndex(k).to_string(), "")));
    all.extend(
        (0..RECEPTORS.len()).map(|k| (M::DaylightEfficacyRatio(k), M::DaylightEfficacyRatio(k).to_string(), "")),
    );
    all.extend((0..RECEPTORS.len()).map(|k| {
        let label = M::EquivalentDaylight(k).to_string();
        (M::EquivalentDaylight(k), label, quantity.luminous_unit())
    }));
    all.extend(WEIGHTINGS.map(|(key, _)| (M::Hazard(key), M::Hazard(key).to_string(), quantity.unit())));
    let mut seen = Vec::new();
    all.retain(|(m, ..)| {
        let new = !seen.contains(m);
        seen.push(*m);
        new
    });
    all
}

fn figures(p: &Parts<'_>) -> Section {
    let value = |m: Measurand| at(p.result, &measured_path(m, p.conversion.quantity)?)?.as_f64();
    let row = |(m, label, unit): (Measurand, String, &str)| {
        let value = value(m)?;
        let stated = p.uncertainty.and_then(|u| u.figure(m)).and_then(|f| f.stated);
        // Ultraviolet that is less than its uncertainty would be a row of zeros.
        if matches!(m, Measurand::Hazard(_)) && stated.is_some_and(|s| value.abs() < s.standard) {
            return None;
        }
        // A unit is not broken at its stroke.
        let unit = unit.replace('/', "/\u{2060}");
        Some(match stated {
            None => [label, significant(value, 6), String::new(), String::new(), unit],
            Some(s) => {
                let [low, high] = s.expanded_95.map(|v| to_uncertainty(v, s.standard));
                let standard =
                    if s.standard > 1e-12 * value.abs() { significant(s.standard, 2) } else { "0".to_owned() };
                [label, to_uncertainty(value, s.standard), standard, format!("{low} to {high}"), unit]
            }
        })
    };
    let all: Vec<[String; 5]> = rows(p).into_iter().filter_map(row).collect();
    let section = Section::new("Figures");
    let mut section = match p.uncertainty {
        Some(_) => section.table(
            "Each with its standard uncertainty and the interval that holds 95 %",
            ["figure", "value", "standard", "95 % interval", "unit"],
            all,
        ),
        None => section.table("Without a budget nothing is said of their uncertainty", ["figure", "value", "unit"], {
            all.into_iter().map(|[label, value, _, _, unit]| [label, value, unit]).collect()
        }),
    };
    if let Some(t) = &p.conversion.tolerance {
        section = section.text(format!("Nearest nominal white (ANSI C78.377): {}.", super::text::nominal_white(t)));
    }
    if let Some(s) = &p.conversion.standard_colour {
        let name = super::conversion::standard_colour(s);
        section = section.text(format!("Nearest standard colour (IEC 60081): {name}, {:.1} SDCM.", s.sdcm));
    }
    section
}

/// The risk group, hazard by hazard.
fn risk(risk: &Risk) -> Option<Section> {
    let group = risk.group()?;
    // What is read as one is not broken.
    let whole = |text: &str| text.replace(' ', "\u{a0}").replace('/', "/\u{2060}").replace('–', "–\u{2060}");
    let name = |hazard: Hazard| whole(&format!("{}, {}", hazard.symbol(), hazard.word()));
    let row = |a: &Assessment| {
        let [exempt, one, two] = a.limits.map(super::text::limit);
        [
            name(a.hazard),
            whole(&format!("{} {}", significant(a.value, 4), a.hazard.quantity().unit())),
            a.group.word().to_owned(),
            format!("{exempt} / {one} / {two}"),
            a.longest_s.map_or_else(|| "no limit".to_owned(), |t| whole(&format!("{} s", significant(t, 3)))),
            whole(&format!("{}–{} nm{}", a.covered_nm.0, a.covered_nm.1, if a.complete { "" } else { " in part" })),
        ]
    };
    let missing = risk.missing.iter().map(|(hazard, why)| {
        let mut row = [const { String::new() }; 6];
        row[0] = name(*hazard);
        row[1] = format!("not assessed: {}", why.word());
        row
    });
    let rows = risk.assessments.iter().map(row).chain(missing).collect();
    let head = ["hazard", "value", "group", "exempt / 1 / 2 up to", "longest exposure", "from"];
    let bound =
        if risk.complete() { "" } else { ", a lower bound: not every hazard was assessed over its whole range" };
    let angle = risk.subtense_rad.map_or_else(
        || "An unknown angle of the source; the limits are those of 0.1 rad, the strictest.".to_owned(),
        |a| format!("The source subtends {} mrad.", significant(1e3 * a, 4)),
    );
    let section =
        Section::new("Photobiological safety").text(format!("By IEC 62471:2006 {}{bound}. {angle}", group.word()));
    Some(section.table("Hazards and their limits, in the unit of the value", head, rows))
}

fn budget(u: &Uncertainty, p: &Parts<'_>) -> Section {
    let by = leading(u);
    let columns: Vec<(Measurand, String)> =
        [by, Measurand::Chromaticity(0), Measurand::Cct, Measurand::Ra, Measurand::Rf]
            .into_iter()
            .filter(|m| u.figure(*m).is_some_and(|f| f.value.is_finite()))
            .map(|m| {
                (
                    m,
                    if m == Measurand::Photopic {
                        super::text::luminous_name(p.conversion.quantity).to_owned()
                    } else {
                        m.to_string()
                    },
                )
            })
            .fold(Vec::new(), |mut all, column| {
                if all.iter().all(|(m, _)| *m != column.0) {
                    all.push(column);
                }
                all
            });
    let share = |m: Measurand, name: &str| {
        let ranking = u.ranking(m);
        ranking.iter().find(|(n, _)| *n == name).map_or(String::new(), |(_, s)| format!("{:.1}", 100.0 * s))
    };
    let ranking = u.ranking(by);
    let rows = ranking.iter().map(|(name, _)| {
        std::iter::once((*name).to_owned()).chain(columns.iter().map(|(m, _)| share(*m, name))).collect::<Vec<_>>()
    });
    let table = super::html::Table {
        caption: "Share of each contribution in the variance, to first order, %".to_owned(),
        head: std::iter::once("contribution".to_owned()).chain(columns.iter().map(|(_, name)| name.clone())).collect(),
        rows: rows.collect(),
    };
    let how = if u.adaptive { "until the intervals had settled" } else { "as asked for" };
    Section { title: "Uncertainty".to_owned(), blocks: vec![Block::Table(table)] }.text(format!(
        "JCGM 100 and 101: figures proportional to the samples to first order, all others from {} trials ({how}, seed {}).",
        u.trials, u.seed
    ))
}

/// What the instrument printed beside ours.
fn instrument(result: &Map<String, Value>) -> Option<Section> {
    let compared = result.get("instrument")?.as_array()?;
    let number = |v: &Value, key: &str| v[key].as_f64().map_or(String::new(), |v| significant(v, 6));
    let row = |v: &Value| {
        let within = if v["within_printed_digits"] == true { "within its digits" } else { "" };
        [
            v["label"].as_str().unwrap_or_default().to_owned(),
            v["printed_text"].as_str().unwrap_or_default().to_owned(),
            number(v, "ours"),
            number(v, "difference"),
            within.to_owned(),
        ]
    };
    let rows = compared.iter().map(row).collect();
    let head = ["figure", "printed", "here", "difference", ""];
    Some(Section::new("The instrument's own figures").table("Printed in the file beside those found here", head, rows))
}

/// Settings as rows of dotted keys and values.
fn flat(key: &str, value: &Value, out: &mut Vec<[String; 2]>) {
    match value {
        Value::Object(inner) => inner.iter().for_each(|(k, v)| {
            flat(&if key.is_empty() { k.clone() } else { format!("{key}.{k}") }, v, out);
        }),
        Value::Array(items) => {
            let all: Vec<String> = items.iter().map(plain).collect();
            out.push([key.to_owned(), all.join(", ")]);
        }
        other => out.push([key.to_owned(), plain(other)]),
    }
}

fn plain(value: &Value) -> String {
    match value {
        Value::String(s) => s.clone(),
        Value::Null => "–".to_owned(),
        other => other.to_string(),
    }
}

fn method(p: &Parts<'_>) -> Section {
    let inputs =
        p.inputs.iter().map(|i| [i.path.clone(), i.sha256.clone().unwrap_or_else(|| "a source by name".to_owned())]);
    let mut settings = Vec::new();
    flat("", p.settings, &mut settings);
    let mut contract = Vec::new();
    if let Some(integration) = p.result.get("integration") {
        flat("", integration, &mut contract);
    }
    contract.retain(|row| !settings.contains(row));
    Section::new("Inputs and method")
        .table("Files", ["file", "SHA-256"], inputs.collect())
        .table("Settings", ["setting", "value"], settings)
        .table("How the integrals were taken", ["key", "value"], contract)
        .text(format!(
            "photopic {}. The figures have the keys of docs/json.md in full precision with --json.",
            env!("CARGO_PKG_VERSION")
        ))
}
