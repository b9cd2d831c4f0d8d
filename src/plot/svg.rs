//! A sheet as an SVG file, through plotters' SVG backend.
//!
//! That backend works in whole pixels, so the drawing is set ten times larger and shrunk by the `viewBox`. What it
//! lacks (colour gradients, clipped pictures, an embedded font, rounded joins) is written here around its output.

use std::fmt::Write as _;

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontDesc, FontFamily, FontStyle, FontTransform, RGBAColor, RGBColor, ShapeStyle, TextStyle,
};

use super::sheet::{Align, Ink, Op, Point, Rect, Sheet, Text, clean};
use super::{Error, font, png};

/// Units of the `viewBox` per pixel of the sheet.
const UNITS: f64 = 10.0;
/// plotters divides text sizes by this when it writes `font-size`.
const SIZE_DIVISOR: f64 = 1.24;
/// plotters moves the baseline down by this many ems for text hung from its top.
const TOP_TO_BASELINE: f64 = 0.76;

/// Write the sheet as SVG of the given size in pixels.
pub(super) fn write(sheet: &Sheet, size: (u32, u32)) -> Result<Vec<u8>, Error> {
    font::register()?;
    let (width, height) = (units(sheet.width), units(sheet.height));
    let mut body = String::new();
    let mut plain: Vec<&Op> = Vec::new();
    for op in &sheet.ops {
        if matches!(op, Op::Gradient { .. } | Op::Image { .. } | Op::Pixels { .. }) {
            body.push_str(&simple(&plain, (width, height))?);
            plain.clear();
            special(&mut body, op)?;
        } else {
            plain.push(op);
        }
    }
    body.push_str(&simple(&plain, (width, height))?);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {width} {height}\" role=\"img\">\n\
         <title>{}</title>\n<style>{}</style>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n\
         <g stroke-linejoin=\"round\">\n",
        size.0,
        size.1,
        escape(&clean(&sheet.title)),
        font::face_rule(),
    );
    out.push_str(&body);
    out.push_str("</g>\n</svg>\n");
    Ok(out.into_bytes())
}

#[expect(clippy::cast_possible_truncation, reason = "sheets are a few thousand pixels wide")]
fn units(v: f64) -> i32 {
    (v * UNITS).round() as i32
}

fn place((x, y): Point) -> (i32, i32) {
    (units(x), units(y))
}

fn colour(ink: Ink) -> RGBAColor {
    RGBColor(ink.rgb[0], ink.rgb[1], ink.rgb[2]).mix(ink.alpha)
}

/// Everything that plotters can write, as elements without the enclosing `<svg>`.
fn simple(ops: &[&Op], (width, height): (i32, i32)) -> Result<String, Error> {
    if ops.is_empty() {
        return Ok(String::new());
    }
    let mut buffer = String::new();
    {
        let mut backend = SVGBackend::with_string(&mut buffer, (width.unsigned_abs(), height.unsigned_abs()));
        for op in ops {
            draw(&mut backend, op).map_err(Error::Drawing)?;
        }
        backend.present().map_err(|e| Error::Drawing(e.to_string()))?;
    }
    let inner = buffer.split_once('>').map_or("", |(_, rest)| rest.trim_start());
    Ok(inner.strip_suffix("</svg>\n").unwrap_or(inner).to_owned())
}

fn draw(backend: &mut SVGBackend<'_>, op: &Op) -> Result<(), String> {
    let done = match op {
        Op::Stroke { points, width, ink } => {
            let style = ShapeStyle { color: colour(*ink), filled: false, stroke_width: units(*width).unsigned_abs() };
            backend.draw_path(points.iter().map(|&p| place(p)), &style)
        }
        Op::Fill { points, ink } => backend.fill_polygon(points.iter().map(|&p| place(p)), &colour(*ink)),
        Op::Disc { centre, radius, ink } => {
            backend.draw_circle(place(*centre), units(*radius).unsigned_abs(), &colour(*ink), true)
        }
        Op::Text(text) => return draw_text(backend, text),
        Op::Gradient { .. } | Op::Image { .. } | Op::Pixels { .. } => Ok(()),
    };
    done.map_err(|e| e.to_string())
}

fn draw_text(backend: &mut SVGBackend<'_>, text: &Text) -> Result<(), String> {
    let rise = TOP_TO_BASELINE * text.size;
    let (x, y) = text.at;
    let (at, transform) =
        if text.turned { ((x - rise, y), FontTransform::Rotate270) } else { ((x, y - rise), FontTransform::None) };
    let h_pos = match text.align {
        Align::Start => HPos::Left,
        Align::Middle => HPos::Center,
        Align::End => HPos::Right,
    };
    let size = (text.size * UNITS * SIZE_DIVISOR * 100.0).round() / 100.0;
    let desc = FontDesc::new(FontFamily::Name(font::FAMILY), size, FontStyle::Normal).transform(transform);
    let style = TextStyle { pos: Pos::new(h_pos, VPos::Top), ..desc.color(&colour(text.ink)) };
    backend.draw_text(&text.text, &style, place(at)).map_err(|e| e.to_string())
}

/// Gradients and pictures. Names of definitions are made from their content: several drawings may share one page.
fn special(out: &mut String, op: &Op) -> Result<(), Error> {
    match op {
        Op::Gradient { outline, stops } => {
            let (Some(first), Some(last)) = (stops.first(), stops.last()) else { return Ok(()) };
            let mut definition = format!(
                "gradientUnits=\"userSpaceOnUse\" x1=\"{}\" y1=\"0\" x2=\"{}\" y2=\"0\">",
                units(first.0),
                units(last.0)
            );
            for (x, [r, g, b]) in stops {
                let offset = (x - first.0) / (last.0 - first.0);
                let _ = write!(definition, "<stop offset=\"{offset:.4}\" stop-color=\"#{r:02X}{g:02X}{b:02X}\"/>");
            }
            let id = name("fill", &definition);
            let _ = writeln!(out, "<linearGradient id=\"{id}\" {definition}</linearGradient>");
            let _ = writeln!(out, "<polygon fill=\"url(#{id})\" points=\"{}\"/>", points(outline));
        }
        Op::Image { area, columns, rows, pixels, clip } => {
            let file = font::base64(&png::encode(pixels, *columns, *rows)?);
            let shape = points(clip);
            let Rect { x0, y0, .. } = *area;
            let (x, y, w, h) = (units(x0), units(y0), units(area.width()), units(area.height()));
            let id = name("clip", &format!("{shape}{x},{y},{w},{h}"));
            let _ = writeln!(out, "<clipPath id=\"{id}\"><polygon points=\"{shape}\"/></clipPath>");
            let _ = writeln!(
                out,
                "<image clip-path=\"url(#{id})\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" \
                 preserveAspectRatio=\"none\" href=\"data:image/png;base64,{file}\"/>"
            );
        }
        Op::Pixels { area, columns, rows, pixels } => {
            let file = font::base64(&png::encode(pixels, *columns, *rows)?);
            let (x, y, w, h) = (units(area.x0), units(area.y0), units(area.width()), units(area.height()));
            let _ = writeln!(
                out,
                "<image style=\"image-rendering:pixelated\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" \
                 preserveAspectRatio=\"none\" href=\"data:image/png;base64,{file}\"/>"
            );
        }
        _ => {}
    }
    Ok(())
}

fn points(points: &[Point]) -> String {
    let mut out = String::new();
    for &p in points {
        let (x, y) = place(p);
        let _ = write!(out, "{x},{y} ");
    }
    out.truncate(out.trim_end().len());
    out
}

/// A name that differs where the content differs (FNV-1a, 64 bits).
fn name(kind: &str, content: &str) -> String {
    let hash = content.bytes().fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    format!("photopic-{kind}-{hash:016x}")
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
