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

/// `lamp ugr` for people, from the JSON object.
#[must_use]
pub fn ugr_text(path: &str, o: &Map<String, Value>) -> String {
    let mut out =
        format!("{path}: UGR (CIE 190, CIE 117), S/H {}, for the luminaire's own flux\n\n", ugr::SPACING_TO_HEIGHT);
    let line = |out: &mut String, room: &str, cells: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "  {room:<18}{}", format!("{cells}  |  {cells}").trim_end());
    };
    let share = |name: &str, of: fn(&(f64, f64, f64)) -> f64, out: &mut String| {
        line(out, name, &ugr::REFLECTANCES.iter().map(|r| format!("{:5.2}", of(r))).collect::<Vec<_>>().join(" "));
    };
    share("ceiling", |r| r.0, &mut out);
    share("walls", |r| r.1, &mut out);
    share("reference plane", |r| r.2, &mut out);
    let _ = writeln!(out, "\n  {:<18}{:<29}  |  endwise", "room x × y", "crosswise");
    for row in o["rows"].as_array().into_iter().flatten() {
        let room = format!("{:>2}H × {:>2}H", row["room_x_h"], row["room_y_h"]);
        let _ = writeln!(out, "  {room:<18}{}  |  {}", cells(&row["crosswise"], 1), cells(&row["endwise"], 1));
    }
    out
}

/// `lamp cu` for people, from the JSON object.
#[must_use]
pub fn cu_text(path: &str, o: &Map<String, Value>) -> String {
    let mut out = format!(
        "{path}: coefficients of utilisation, % (zonal cavity, floor cavity {:.0} %)\n\n",
        100.0 * cu::FLOOR_REFLECTANCE
    );
    let heading = |name: &str, of: fn(&(f64, f64)) -> f64, out: &mut String| {
        let list: Vec<String> = cu::REFLECTANCES.iter().map(|r| format!("{:5.0}", 100.0 * of(r))).collect();
        let _ = writeln!(out, "  {name:<14}{}", list.join(" "));
    };
    heading("ceiling, %", |r| r.0, &mut out);
    heading("walls, %", |r| r.1, &mut out);
    let _ = writeln!(out, "\n  RCR");
    for row in o["rows"].as_array().into_iter().flatten() {
        let _ = writeln!(out, "  {:<14}{}", row["rcr"].to_string(), cells(&row["cu_percent"], 0));
    }
    out
}

/// Numbers of one row, five characters each.
fn cells(list: &Value, decimals: usize) -> String {
    let cell = |v: &Value| v.as_f64().map_or_else(|| "    –".into(), |v| format!("{v:5.decimals$}"));
    list.as_array().into_iter().flatten().map(cell).collect::<Vec<_>>().join(" ")
}
