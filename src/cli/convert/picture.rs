//! `--plot`: which panels a picture of converted spectra has.

use std::path::Path;

use serde_json::{Map, Value};

use super::args::PlotKind;
use crate::cli::Failure;
use crate::conversion::{Conversion, Settings};
use crate::finding::Finding;
use crate::photometry::alpha_opic::RECEPTORS;
use crate::plot::conversion::{
    Drawn, chromaticity_panel, colour_vector_panel, melanopic_panel, spectrum_panel, tolerance_regions,
};
use crate::plot::uncertainty::budget_panel;
use crate::plot::{
    ChromaticityPanel, Diagram, Format, LevelPanel, Panel, SpectrumPanel, data_uri, draw as draw_panels,
};
use crate::report::conversion_page::{self, Parts};
use crate::report::envelope::Input;
use crate::report::html::{Figure, Page};
use crate::report::uncertainty::budgeted;
use crate::spectrum::{Quantity, Spectrum};
use crate::uncertainty::{Measurand, Uncertainty};

/// Curves in one drawing at most: more cannot be told apart.
const MOST_CURVES: usize = 64;

/// A converted spectrum kept for the drawing.
pub(super) struct Kept {
    pub name: String,
    pub conversion: Conversion,
    pub spectrum: Spectrum,
    pub uncertainty: Option<Uncertainty>,
    /// Its object in the results, where a report is written.
    pub result: Map<String, Value>,
}

/// The picture format that a file name asks for.
pub(in crate::cli) fn format_of(path: &Path) -> Result<Format, Failure> {
    match path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).as_deref() {
        Some("svg") => Ok(Format::Svg),
        Some("png") => Ok(Format::Png),
        _ => Err(Failure::Message(format!("--plot {}: expected a file name ending in .svg or .png", path.display()))),
    }
}

/// Draws the spectra kept.
pub(super) fn draw(
    kept: &[Kept],
    settings: &Settings,
    (kind, tolerances): (PlotKind, bool),
    format: Format,
) -> Result<Vec<u8>, Failure> {
    let fail = |message: String| Failure::Message(format!("--plot: {message}"));
    if kept.is_empty() {
        return Err(fail("nothing to draw: no spectrum was converted in memory (rows of a table are streamed; save the wanted ones as columns)".into()));
    }
    if kept.len() > MOST_CURVES {
        return Err(fail(format!("{} spectra; expected at most {MOST_CURVES}; choose with --select", kept.len())));
    }
    let drawn: Vec<Drawn<'_>> =
        kept.iter().map(|k| Drawn { name: &k.name, conversion: &k.conversion, spectrum: &k.spectrum }).collect();
    if drawn.iter().any(|d| d.conversion.quantity != drawn[0].conversion.quantity) {
        return Err(fail("spectra of different quantities do not share an axis; draw them one by one".into()));
    }
    let vector = |d: &Drawn<'_>| colour_vector_panel(d).map(Panel::from);
    let chromaticity = |diagram: Diagram| -> Panel {
        let regions = if tolerances { tolerance_regions() } else { Vec::new() };
        ChromaticityPanel { regions, ..chromaticity_panel(&drawn, diagram) }.into()
    };
    let panels: Vec<Panel> = match kind {
        PlotKind::Spectrum => vec![spectrum_panel(&drawn, settings).into()],
        PlotKind::Chromaticity => vec![chromaticity(Diagram::Cie1976)],
        PlotKind::ChromaticityXy => vec![chromaticity(Diagram::Cie1931)],
        PlotKind::Tm30 => {
            let [one] = drawn.as_slice() else {
                return Err(fail(format!("the colour vector graphic is of one spectrum, not of {}", drawn.len())));
            };
            vec![vector(one).ok_or_else(|| fail("this spectrum has no TM-30 figures".into()))?]
        }
        PlotKind::Melanopic => {
            let none =
                "no melanopic illuminance above zero; expected an irradiance (--quantity, --unit, or --distance)";
            vec![melanopic_panel(&drawn, &intervals(kept)).ok_or_else(|| fail(none.into()))?.into()]
        }
        PlotKind::All => {
            let mut panels: Vec<Panel> = vec![spectrum_panel(&drawn, settings).into(), chromaticity(Diagram::Cie1976)];
            if let [one] = drawn.as_slice() {
                panels.extend(vector(one));
            }
            panels
        }
    };
    draw_panels(&panels, None, format).map_err(|e| fail(e.to_string()))
}

/// The intervals of the melanopic illuminances, where a budget was given.
fn intervals(kept: &[Kept]) -> Vec<Option<[f64; 2]>> {
    let melanopic = RECEPTORS.iter().position(|r| *r == "melanopic").map(Measurand::EquivalentDaylight);
    let stated = |k: &Kept| k.uncertainty.as_ref()?.figure(melanopic?)?.stated.map(|s| s.expanded_95);
    kept.iter().map(stated).collect()
}

/// The report on the one spectrum kept; `inputs` are what it rests on.
pub(super) fn page(
    kept: &[Kept],
    settings: &Settings,
    settings_json: &Value,
    inputs: &[Input],
    findings: &[Finding],
) -> Result<Page, Failure> {
    let fail = |message: String| Failure::Message(format!("--report: {message}"));
    let [one] = kept else {
        return Err(fail(format!("{} spectra in memory; expected one; choose with --select", kept.len())));
    };
    let drawn = [Drawn { name: &one.name, conversion: &one.conversion, spectrum: &one.spectrum }];
    let chromaticity =
        ChromaticityPanel { regions: tolerance_regions(), ..chromaticity_panel(&drawn, Diagram::Cie1976) };
    let spectrum = SpectrumPanel { figures: Vec::new(), ..spectrum_panel(&drawn, settings) };
    let mut panels: Vec<(Panel, &str)> = vec![
        (spectrum.into(), "The spectrum, with V(λ) for comparison."),
        (
            chromaticity.into(),
            "Chromaticity; outlines: quadrangles of ANSI C78.377 and, where known, ellipses of three MacAdam steps.",
        ),
    ];
    panels.extend(colour_vector_panel(&drawn[0]).map(|p| (p.into(), "TM-30: shift of the sixteen hue bins.")));
    if one.conversion.quantity == Quantity::Irradiance {
        let panel = melanopic_panel(&drawn, &intervals(kept)).map(|p| LevelPanel { title: String::new(), ..p });
        panels.extend(panel.map(|p| (p.into(), "Melanopic illuminance and what is recommended for the eye.")));
    }
    if let Some(u) = &one.uncertainty {
        let panel = budget_panel("", u, &budgeted(one.conversion.quantity));
        panels.push((panel.into(), "The budget: share of each contribution in the variance."));
    }
    let figure = |(panel, caption): (Panel, &str)| -> Result<Figure, Failure> {
        let file = draw_panels(&[panel], None, Format::Svg).map_err(|e| fail(e.to_string()))?;
        let (uri, caption) = (data_uri(&file, Format::Svg), caption.to_owned());
        Ok(Figure { uri, alt: caption.clone(), caption, large_letters: false })
    };
    let figures = panels.into_iter().map(figure).collect::<Result<Vec<_>, _>>()?;
    Ok(conversion_page::page(&Parts {
        title: &one.name,
        inputs,
        settings: settings_json,
        conversion: &one.conversion,
        result: &one.result,
        uncertainty: one.uncertainty.as_ref(),
        figures: &figures,
        findings,
    }))
}

/// Draws the budget of the one spectrum kept.
pub(super) fn draw_budget(kept: &[Kept], format: Format) -> Result<Vec<u8>, Failure> {
    let fail = |message: String| Failure::Message(format!("--budget-plot: {message}"));
    let [Kept { name, conversion, uncertainty: Some(uncertainty), .. }] = kept else {
        return Err(fail(format!("{} spectra in memory; expected one; choose with --select", kept.len())));
    };
    let panel = budget_panel(name, uncertainty, &budgeted(conversion.quantity));
    draw_panels(&[panel.into()], None, format).map_err(|e| fail(e.to_string()))
}
