//! `image falsecolor`: what the colours of a picture stand for.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::quantity;
use crate::image::{Photometric, Picture};
use crate::plot::FalseColourPanel;

/// The title of an image's picture: its name and quantity.
#[must_use]
pub fn title(path: &str, photometric: &Photometric) -> String {
    let file = Path::new(path).file_name().map_or(path.into(), |n| n.to_string_lossy());
    format!("{file}: {}", quantity::name(photometric))
}

/// The object of `image falsecolor` in `results[]`.
#[must_use]
pub fn falsecolor(
    path: &str,
    output: &Path,
    photometric: &Photometric,
    picture: &Picture,
    panel: &FalseColourPanel,
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
    set("range", json!([panel.range.low, panel.range.high]));
    set("scale", if panel.range.logarithmic { "log" } else { "linear" }.into());
    set("map", format!("{:?}", panel.map).to_lowercase().into());
    set("contours", panel.levels.iter().map(|l| l.value).collect::<Vec<_>>().into());
    out
}
