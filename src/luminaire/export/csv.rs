//! The intensity table as CSV.
//!
//! Comment lines (`#`) say what the numbers are; then one header row and one row per vertical angle:
//!
//! ```text
//! gamma_deg,0,15,30,…      C-planes in degrees
//! 0,1234.5,1234.5,…        intensity in cd
//! ```
//!
//! `pandas.read_csv(FILE, comment="#", index_col=0)` gives a frame with γ as index and one column per plane. Mirrored planes are
//! written out, so that a sum over the columns is a sum over the turn; a rotational table has the one column that stands for all.
//! Types A and B have `vertical_deg` and their own horizontal angles.

use super::notes::{AXES, heading, not_carried, type_letter};
use super::table::Table;
use super::{ExportFile, Exported};
use crate::finding::Checked;
use crate::luminaire::{Luminaire, Symmetry, System};

/// Writes the table; numbers have all their digits.
///
/// # Errors
/// None; the signature is that of all targets.
pub fn write(luminaire: &Luminaire) -> Exported {
    let d = &luminaire.distribution;
    let table = Table::unfolded(d);
    let (rows, columns, corner) = match d.system() {
        System::TypeC => {
            ("gamma in degrees from the photometric axis (0 down, 180 up)", "C-planes in degrees", "gamma_deg")
        }
        System::TypeA => (
            "vertical angle V in degrees, a latitude towards +y",
            "horizontal angle H in degrees, a longitude towards +x",
            "vertical_deg",
        ),
        System::TypeB => (
            "vertical angle V in degrees, a longitude towards +y",
            "horizontal angle H in degrees, a latitude towards +x",
            "vertical_deg",
        ),
    };
    let symmetry = match d.symmetry() {
        Symmetry::Rotational => "rotational: the one plane stands for all",
        Symmetry::Quadrant if d.system() == System::TypeC => "C0-C180 and C90-C270; all planes are written out",
        Symmetry::Quadrant => "about H = 0; all planes are written out",
        Symmetry::BilateralC0 => "C0-C180; all planes are written out",
        Symmetry::BilateralC90 => "C90-C270; all planes are written out",
        Symmetry::None => "none",
    };
    let mut lines = heading(luminaire, "intensity table");
    lines.extend([
        format!("rows: {rows}; columns: {columns}"),
        format!("photometric type: {}; symmetry: {symmetry}", type_letter(d.system())),
        AXES.to_owned(),
        "between entries: linear in both angles; beyond the rows: 0".to_owned(),
    ]);
    let mut text: String = lines.iter().map(|line| format!("# {line}\n")).collect();
    text.push_str(corner);
    for angle in &table.horizontal_deg {
        text.push_str(&format!(",{angle}"));
    }
    text.push('\n');
    let count = table.vertical_deg.len();
    for (row, angle) in table.vertical_deg.iter().enumerate() {
        text.push_str(&angle.to_string());
        for value in table.values.iter().skip(row).step_by(count) {
            text.push_str(&format!(",{value}"));
        }
        text.push('\n');
    }
    let findings = not_carried(luminaire, "a table", false);
    Ok(Checked { value: vec![ExportFile { suffix: ".csv".to_owned(), bytes: text.into_bytes() }], findings })
}
