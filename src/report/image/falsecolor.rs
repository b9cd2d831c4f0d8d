//! `image falsecolor`: what the colours of a picture stand for.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::quantity;
use crate::image::{Photometric, Picture};

/// The title of an image's picture: its name and quantity.
#[must_use]
pub fn title(path: &str, photometric: &Photometric) -> String {
    let file = Path::new(path).file_name().map_or(path.into(), |n| n.to_string_lossy());
    format!("{file}: {}", quantity::name(photometric))
}

/// What the colours stand for.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// Values of the first and the last colour.
    pub range: [f64; 2],
    /// In proportion to the logarithm.
    pub logarithmic: bool,
    /// Name of the colours.
    pub map: String,
    /// Values of the contour lines.
    pub contours: Vec<f64>,
}

/// The object of `image falsecolor` in `results[]`.
#[must_use]
pub fn falsecolor(
    path: &str,
    output: &Path,
    photometric: &Photometric,
    picture: &Picture,
    legend: &Legend,
) -> Map<String, Value> {
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    let s = &picture.statistics;
    let finite = s.finite > 0;
    set("path", path.into());
    set("output", output.to_string_lossy().into());
    set("width_px", picture.width.into());
    set("height_px", picture.height.into());
    let range = json!({"min": finite.then_some(s.min), "mean": s.mean(), "max": finite.then_some(s.max)});
    set(quantity::key(photometric), range);
    set("nan", s.nan.into());
    set("infinite", s.infinite.into());
    set("negative", s.negative.into());
    set("unit", photometric.unit().into());
    set("range", json!(legend.range));
    set("scale", if legend.logarithmic { "log" } else { "linear" }.into());
    set("map", legend.map.clone().into());
    set("contours", legend.contours.clone().into());
    out
}
