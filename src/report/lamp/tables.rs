//! The trade tables: UGR and coefficients of utilisation.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::luminaire::format::File;
use crate::luminaire::{Unavailable, cu, ugr};

/// The rows of `lamp ugr`; `null` where nothing of the luminaire is seen from the observer's place.
///
/// # Errors
/// [`Unavailable`] where the table is not defined for the luminaire.
pub fn ugr(file: &File) -> Result<Map<String, Value>, Unavailable> {
    let rows: Vec<Value> = ugr::ugr_table(&file.luminaire)?
        .iter()
        .map(
            |r| json!({"room_x_h": r.room_x_h, "room_y_h": r.room_y_h, "crosswise": r.crosswise, "endwise": r.endwise}),
        )
        .collect();
    Ok(Map::from_iter([("rows".to_owned(), rows.into()), ("spacing_to_height".to_owned(), json!(0.25))]))
}

/// The rows of `lamp cu`.
///
/// # Errors
/// [`Unavailable`] where the table is not defined for the luminaire.
pub fn cu(file: &File) -> Result<Map<String, Value>, Unavailable> {
    let rows: Vec<Value> =
        cu::cu_table(&file.luminaire)?.iter().map(|r| json!({"rcr": r.rcr, "cu_percent": r.cu_percent})).collect();
    Ok(Map::from_iter([("rows".to_owned(), rows.into()), ("floor_reflectance".to_owned(), json!(0.2))]))
}

/// A table of `lamp ugr` or `lamp cu` for people, from the JSON object.
#[must_use]
pub fn rows_text(path: &str, o: &Map<String, Value>) -> String {
    let mut out = format!("{path}\n\n");
    for row in o["rows"].as_array().into_iter().flatten() {
        let cells = |key: &str, digits: usize| -> String {
            let list = row[key].as_array().into_iter().flatten();
            list.map(|v| v.as_f64().map_or_else(|| "    –".into(), |v| format!("{v:5.digits$}")))
                .collect::<Vec<_>>()
                .join(" ")
        };
        let _ = if row.get("rcr").is_some() {
            writeln!(out, "  RCR {:>2}  {}", row["rcr"], cells("cu_percent", 0))
        } else {
            writeln!(
                out,
                "  {:>3}H × {:>3}H  {}  |  {}",
                row["room_x_h"],
                row["room_y_h"],
                cells("crosswise", 1),
                cells("endwise", 1)
            )
        };
    }
    out
}
