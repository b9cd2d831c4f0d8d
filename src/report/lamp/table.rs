//! Lamps as tables: columns that depend on the verb and on nothing else, so that a script can rely on them; what does not apply is
//! an empty cell.

use serde_json::{Map, Value};

use crate::luminaire::{beam, cu, luminance, ugr};
use crate::report::csv::cell;

/// Zones of the LCS in the standard's order.
const LCS: [&str; 10] = ["fl", "fm", "fh", "fvh", "bl", "bm", "bh", "bvh", "ul", "uh"];

/// A column whose header is its path.
fn named(path: &str) -> (String, String) {
    (path.to_owned(), path.to_owned())
}

/// A table of one verb: one row per file, or per row of the file's own table.
#[derive(Debug)]
pub struct Table {
    /// Header and path to the value in the JSON object (`a.b.0`).
    columns: Vec<(String, String)>,
    /// Where the object has a list of rows.
    rows: Option<&'static str>,
}

impl Table {
    /// The figures of `lamp info`, one row per file.
    #[must_use]
    pub fn info() -> Self {
        let mut columns = Vec::new();
        let mut add = |list: &[&str]| columns.extend(list.iter().map(|s| named(s)));
        add(&["path", "name", "manufacturer", "catalogue_number", "format", "format_version", "photometry_type"]);
        add(&["symmetry", "vertical_angles", "horizontal_angles", "absolute"]);
        add(&["declared_flux_lm", "total_flux_lm", "total_flux_zonal_lm", "peak_intensity_cd"]);
        add(&["declared_flux_w", "total_flux_w", "total_flux_zonal_w", "peak_intensity_w_per_sr"]);
        add(&["declared_flux_umol_per_s", "total_flux_umol_per_s", "total_flux_zonal_umol_per_s"]);
        add(&["peak_intensity_umol_per_s_sr", "peak_direction_deg.c", "peak_direction_deg.gamma"]);
        for angle in ["beam_angle_deg", "field_angle_deg"] {
            for (i, definition) in beam::Definition::ALL.into_iter().enumerate() {
                for plane in ["c0_c180", "c90_c270"] {
                    columns.push((format!("{angle}.{}.{plane}", definition.name()), format!("{angle}.{i}.{plane}")));
                }
            }
        }
        columns.push(("nema_type.horizontal".to_owned(), "nema_type.0".to_owned()));
        columns.push(("nema_type.vertical".to_owned(), "nema_type.1".to_owned()));
        columns.extend(LCS.map(|zone| named(&format!("lcs_lm.{zone}"))));
        let mut add = |list: &[&str]| columns.extend(list.iter().map(|s| named(s)));
        add(&["bug_rating", "downward_flux_fraction", "light_output_ratio", "input_power_w"]);
        add(&["luminous_efficacy_lm_per_w"]);
        columns.extend((0..5).map(|i| (format!("cie_flux_code.n{}", i + 1), format!("cie_flux_code.{i}"))));
        columns.extend(
            (0..18)
                .map(|i| (format!("zonal_flux_lm.{}_{}", 10 * i, 10 * (i + 1)), format!("zonal_flux_lm.{i}.flux_lm"))),
        );
        columns.extend(["c0_c180", "c90_c270", "diagonal"].map(|s| named(&format!("spacing_criterion.{s}"))));
        // Rows of the luminance table are 15° apart.
        for (c, row) in [(0, 0), (90, 6)] {
            for (i, gamma) in luminance::TABLE_GAMMA_DEG.into_iter().enumerate() {
                let path = format!("luminance_cd_per_m2.{row}.cd_per_m2.{i}");
                columns.push((format!("luminance_cd_per_m2.c{c}_gamma{gamma}"), path));
            }
        }
        columns.extend(["angle_deg", "solid_angle_sr"].map(|s| named(&format!("equivalent_cone.{s}"))));
        Self { columns, rows: None }
    }

    /// The verdict of `lamp check`, one row per file.
    #[must_use]
    pub fn check() -> Self {
        let columns = ["path", "format", "format_version", "passes", "errors", "warnings", "findings", "codes"];
        Self { columns: columns.map(named).into(), rows: None }
    }

    /// The rows of `lamp ugr`.
    #[must_use]
    pub fn ugr() -> Self {
        let mut columns: Vec<_> = ["path", "room_x_h", "room_y_h"].map(named).into();
        for direction in ["crosswise", "endwise"] {
            columns.extend(ugr::REFLECTANCES.iter().enumerate().map(|(i, (ceiling, walls, plane))| {
                let per_cent = [ceiling, walls, plane].map(|v| format!("{:.0}", 100.0 * v)).join("_");
                (format!("{direction}_{per_cent}"), format!("{direction}.{i}"))
            }));
        }
        Self { columns, rows: Some("rows") }
    }

    /// The rows of `lamp cu`.
    #[must_use]
    pub fn cu() -> Self {
        let mut columns: Vec<_> = ["path", "rcr"].map(named).into();
        columns.extend(cu::REFLECTANCES.iter().enumerate().map(|(i, (ceiling, walls))| {
            (format!("rc{:.0}_rw{:.0}", 100.0 * ceiling, 100.0 * walls), format!("cu_percent.{i}"))
        }));
        Self { columns, rows: Some("rows") }
    }

    /// The header row.
    #[must_use]
    pub fn header(&self) -> Vec<String> {
        self.columns.iter().map(|(name, _)| name.clone()).collect()
    }

    /// The rows of one file's object, which has its `path`.
    #[must_use]
    pub fn rows(&self, object: &Map<String, Value>) -> Vec<Vec<String>> {
        let Some(key) = self.rows else {
            return vec![self.columns.iter().map(|(_, path)| cell(object, path)).collect()];
        };
        let rows = object.get(key).and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_object);
        let of = |row: &Map<String, Value>| {
            self.columns.iter().map(|(_, path)| cell(if path == "path" { object } else { row }, path)).collect()
        };
        rows.map(of).collect()
    }
}
