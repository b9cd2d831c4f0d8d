//! `image info`: what an image is and what its pixels hold.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::image::statistics::ChannelStatistics;
use crate::image::{Content, Description, Meaning, RgbSpace, Statistics};
use crate::units::significant;

/// Rows of the histogram in text.
const BARS: usize = 16;
/// Width of its longest bar.
const BAR: usize = 40;

/// The object of `image info` in `results[]`; `statistics` are those of all channels.
#[must_use]
pub fn info(image: &Description, statistics: &Statistics) -> Map<String, Value> {
    let mut out = Map::new();
    let mut set = |key: &str, value: Value| {
        out.insert(key.to_owned(), value);
    };
    set("width_px", image.width.into());
    set("height_px", image.height.into());
    set("content", content(image).into());
    if let Content::Light { quantity, unit } = &image.content {
        if let Some(quantity) = quantity {
            set("quantity", quantity.word().into());
        }
        if let Some(unit) = unit {
            set("unit", unit.text.clone().into());
        }
    }
    if let Ok(grid) = image.grid() {
        set("bands", grid.len().into());
        set("range_nm", json!([grid.range_nm().0, grid.range_nm().1]));
        if let Some(step) = grid.step_nm() {
            set("step_nm", step.into());
        }
    }
    if let Some(rgb) = &image.rgb {
        set("rgb", space(rgb, image.find(Meaning::Primary(0)).is_some()));
    }
    let channels = image.channels.iter().zip(&statistics.channels).map(|(channel, s)| {
        let mut out = Map::new();
        out.insert("name".to_owned(), channel.name.clone().into());
        out.insert("unit".to_owned(), channel.unit.clone().into());
        match channel.meaning {
            Meaning::Band { wavelength_nm, fwhm_nm, good } => {
                out.insert("wavelength_nm".to_owned(), wavelength_nm.into());
                if let Some(fwhm) = fwhm_nm {
                    out.insert("fwhm_nm".to_owned(), fwhm.into());
                }
                out.insert("good".to_owned(), good.into());
            }
            Meaning::Stokes { component, wavelength_nm } => {
                out.insert("wavelength_nm".to_owned(), wavelength_nm.into());
                out.insert("stokes_component".to_owned(), component.into());
            }
            _ => {}
        }
        let finite = s.finite > 0;
        out.insert("min".to_owned(), finite.then_some(s.min).into());
        out.insert("max".to_owned(), finite.then_some(s.max).into());
        out.insert("mean".to_owned(), s.mean().into());
        for (key, count) in counts(s) {
            out.insert(key.to_owned(), count.into());
        }
        Value::from(out)
    });
    set("channels", channels.collect::<Vec<_>>().into());
    let bins =
        statistics.histogram().into_iter().map(|(from, to, count)| json!({"from": from, "to": to, "count": count}));
    set("histogram", bins.collect::<Vec<_>>().into());
    let attributes = image.attributes.iter().map(|(name, value)| (name.clone(), value.clone().into()));
    set("attributes", Value::from(attributes.collect::<Map<_, _>>()));
    out
}

/// The space of R, G, B; of other planes only the luminance of 1 means something.
fn space(rgb: &RgbSpace, primaries: bool) -> Value {
    let mut out = Map::new();
    if primaries {
        out.insert("space".to_owned(), rgb.space.key.into());
        out.insert("encoded".to_owned(), rgb.encoded.into());
        out.insert("primaries_xy".to_owned(), json!(rgb.space.primaries));
        out.insert("white_xy".to_owned(), json!(rgb.space.white));
    }
    if let Some(luminance) = rgb.white_luminance {
        out.insert("white_luminance_cd_per_m2".to_owned(), luminance.into());
    }
    out.into()
}

fn content(image: &Description) -> &'static str {
    match image.content {
        Content::Light { .. } => "light",
        Content::Reflectance => "reflectance",
        Content::Planes => "planes",
    }
}

fn counts(s: &ChannelStatistics) -> [(&'static str, u64); 4] {
    [("nan", s.nan), ("infinite", s.infinite), ("negative", s.negative), ("zero", s.zero)]
}

/// The same for reading.
#[must_use]
pub fn info_text(path: &str, image: &Description, statistics: &Statistics) -> String {
    let plural = if image.channels.len() == 1 { "" } else { "s" };
    let mut out =
        format!("{path}: {} × {} pixels, {} channel{plural}", image.width, image.height, image.channels.len());
    // Writing to a string does not fail.
    let mut line = |text: String| {
        let _ = writeln!(out, "{text}");
    };
    let what = match &image.content {
        Content::Light { quantity, unit } => {
            let quantity = quantity.map_or("light".to_owned(), |q| q.to_string());
            let unit = unit.as_ref().map_or("of unknown unit".to_owned(), |u| format!("in {}", u.text));
            format!(", {quantity} {unit}")
        }
        Content::Reflectance => ", reflectance".to_owned(),
        Content::Planes => String::new(),
    };
    line(what);
    if let Ok(grid) = image.grid() {
        let (low, high) = grid.range_nm();
        let step = grid.step_nm().map_or("unequal steps".to_owned(), |s| format!("steps of {} nm", significant(s, 4)));
        line(format!("  {} bands from {low} to {high} nm, {step}", grid.len()));
    }
    if let Some(rgb) = &image.rgb {
        let white =
            rgb.white_luminance.map_or("of unknown luminance".to_owned(), |w| format!("{} cd/m²", significant(w, 6)));
        let kind = if rgb.encoded { "encoded" } else { "linear" };
        line(match image.find(Meaning::Primary(0)) {
            Some(_) => {
                format!("  RGB: {kind} {}, white {}, (1, 1, 1) is {white}", rgb.space.name, rgb.space.white_name)
            }
            None => format!("  1 is {white}"),
        });
    }
    let width = image.channels.iter().map(|c| c.name.chars().count()).max().unwrap_or(0).max(7);
    line(format!("  {:width$} {:>12} {:>12} {:>12}", "channel", "min", "mean", "max"));
    for (channel, s) in image.channels.iter().zip(&statistics.channels) {
        let number = |v: Option<f64>| v.map_or("–".to_owned(), |v| significant(v, 5));
        let some = |v: f32| (s.finite > 0).then(|| f64::from(v));
        let mut row = format!(
            "  {:width$} {:>12} {:>12} {:>12}",
            channel.name,
            number(some(s.min)),
            number(s.mean()),
            number(some(s.max))
        );
        if !channel.unit.is_empty() {
            let _ = write!(row, "  {}", channel.unit);
        }
        for (word, count) in counts(s).into_iter().filter(|(word, count)| *count > 0 && *word != "zero") {
            let _ = write!(row, "  {count} {word}");
        }
        line(row);
    }
    let bins = statistics.histogram();
    let group = bins.len().div_ceil(BARS).max(1);
    let rows: Vec<(f64, f64, u64)> =
        bins.chunks(group).map(|b| (b[0].0, b[b.len() - 1].1, b.iter().map(|b| b.2).sum())).collect();
    let most = rows.iter().map(|r| r.2).max().unwrap_or(0).max(1);
    if !rows.is_empty() {
        line("  samples above 0 of all channels".to_owned());
    }
    for (from, to, count) in rows {
        let length = (count as f64 / most as f64 * BAR as f64).round() as usize;
        let bar = format!("{:<BAR$}", "█".repeat(length));
        line(format!("  {:>10} – {:<10} {bar} {count}", significant(from, 3), significant(to, 3)));
    }
    out
}
