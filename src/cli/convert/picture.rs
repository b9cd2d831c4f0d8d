//! `--plot`: which panels a picture of converted spectra has.

use std::path::Path;

use super::args::PlotKind;
use crate::cli::Failure;
use crate::conversion::{Conversion, Settings};
use crate::plot::conversion::{Drawn, chromaticity_panel, colour_vector_panel, spectrum_panel};
use crate::plot::uncertainty::budget_panel;
use crate::plot::{Diagram, Format, Panel, draw as draw_panels};
use crate::report::uncertainty::budgeted;
use crate::spectrum::Spectrum;
use crate::uncertainty::Uncertainty;

/// Curves in one drawing at most: more cannot be told apart.
const MOST_CURVES: usize = 64;

/// A converted spectrum kept for the drawing.
pub(super) struct Kept {
    pub name: String,
    pub conversion: Conversion,
    pub spectrum: Spectrum,
    pub uncertainty: Option<Uncertainty>,
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
pub(super) fn draw(kept: &[Kept], settings: &Settings, kind: PlotKind, format: Format) -> Result<Vec<u8>, Failure> {
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
    let panels: Vec<Panel> = match kind {
        PlotKind::Spectrum => vec![spectrum_panel(&drawn, settings).into()],
        PlotKind::Chromaticity => vec![chromaticity_panel(&drawn, Diagram::Cie1976).into()],
        PlotKind::ChromaticityXy => vec![chromaticity_panel(&drawn, Diagram::Cie1931).into()],
        PlotKind::Tm30 => {
            let [one] = drawn.as_slice() else {
                return Err(fail(format!("the colour vector graphic is of one spectrum, not of {}", drawn.len())));
            };
            vec![vector(one).ok_or_else(|| fail("this spectrum has no TM-30 figures".into()))?]
        }
        PlotKind::All => {
            let mut panels: Vec<Panel> =
                vec![spectrum_panel(&drawn, settings).into(), chromaticity_panel(&drawn, Diagram::Cie1976).into()];
            if let [one] = drawn.as_slice() {
                panels.extend(vector(one));
            }
            panels
        }
    };
    draw_panels(&panels, None, format).map_err(|e| fail(e.to_string()))
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
