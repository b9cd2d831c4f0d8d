//! What instruments write beside their readings: the lamp file of a goniophotometer, the BRDF table of a
//! gonioreflectometer, the light map and the table of a grid.

use std::path::Path;

use crate::brdf::format::merl;
use crate::cli::Failure;
use crate::cli::output::write_file;
use crate::finding::Finding;
use crate::luminaire::format::{eulumdat, ies};
use crate::plot::{self, grid::light_map_panel};
use crate::render::bands::Bands;
use crate::render::description::sensor::{Goniophotometer, Gonioreflectometer, Grid};
use crate::render::goniophotometer::Measured;
use crate::render::gonioreflectometer;
use crate::render::reading::{Points, Reading};
use crate::report::render as report;
use crate::units::significant;

/// Where files go.
pub(super) struct Place<'a> {
    pub folder: &'a Path,
    /// Paths that must not be overwritten.
    pub inputs: &'a [String],
}

impl Place<'_> {
    fn write(&self, file: &str, bytes: &[u8], written: &mut Vec<String>) -> Result<(), Failure> {
        let path = self.folder.join(file);
        write_file(&path, bytes, self.inputs)?;
        written.push(path.display().to_string());
        Ok(())
    }

    /// Writes the lamp file of a goniophotometer; what the format could not carry.
    pub(super) fn lamp(
        &self,
        described: &Goniophotometer,
        name: &str,
        measured: &Measured,
        written: &mut Vec<String>,
    ) -> Result<Vec<Finding>, Failure> {
        let Some(file) = &described.file else { return Ok(Vec::new()) };
        let wrong = |e: &dyn std::fmt::Display| Failure::Message(format!("{file}: {e}"));
        let lamp = measured.luminaire(name).map_err(|e| wrong(&e))?;
        let text = if file.to_lowercase().ends_with(".ies") {
            ies::write(&lamp, ies::Version::Lm63_2019).map_err(|e| wrong(&e))?
        } else {
            eulumdat::write(&lamp).map_err(|e| wrong(&e))?
        };
        self.write(file, text.value.as_bytes(), written)?;
        Ok(text.findings)
    }

    /// Writes the BRDF table of a gonioreflectometer; what the format could not carry.
    pub(super) fn brdf(
        &self,
        described: &Gonioreflectometer,
        measured: &gonioreflectometer::Measured,
        bands: &Bands,
        written: &mut Vec<String>,
    ) -> Result<Vec<Finding>, Failure> {
        let Some(file) = &described.file else { return Ok(Vec::new()) };
        if !file.to_lowercase().ends_with(".binary") {
            self.write(file, report::brdf_csv(measured, bands).as_bytes(), written)?;
            return Ok(Vec::new());
        }
        let table = measured.bins(bands).map_err(|e| Failure::Message(format!("{file}: {e}")))?;
        let bytes = merl::write(&table.value).expect("a table of three channels");
        self.write(file, &bytes, written)?;
        Ok(table.findings)
    }

    /// Writes the light map and the table of a grid.
    pub(super) fn grid(
        &self,
        described: &Grid,
        reading: &Reading,
        points: &Points,
        written: &mut Vec<String>,
    ) -> Result<(), Failure> {
        if let Some(file) = &described.csv {
            let text = report::grid_csv(points, reading.quantity, reading.unit);
            self.write(file, text.as_bytes(), written)?;
        }
        if let Some(file) = &described.isolux {
            let is_svg = file.to_lowercase().ends_with(".svg");
            let format = if is_svg { plot::Format::Svg } else { plot::Format::Png };
            let panel = light_map_panel(&reading.name, points, reading.unit, &figures(reading, points));
            let drawn = plot::draw(&[panel.into()], None, format);
            let bytes = drawn.map_err(|e| Failure::Message(format!("{file}: {e}")))?;
            self.write(file, &bytes, written)?;
        }
        Ok(())
    }
}

/// The line below the title of a map.
fn figures(reading: &Reading, points: &Points) -> String {
    let values = || points.figures.iter().map(|f| f.value);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let mean = reading.figure.value;
    let error = points.figures.iter().map(|f| f.standard_error).fold(0.0, f64::max);
    let u0 = if mean > 0.0 { format!("{:.2}", low / mean) } else { "–".to_owned() };
    format!(
        "min {}, mean {}, max {} {}, U0 {u0}; {} × {} points, each ± {} {} or better",
        significant(low, 3),
        significant(mean, 3),
        significant(high, 3),
        reading.unit,
        points.counts[0],
        points.counts[1],
        significant(error, 2),
        reading.unit
    )
}
