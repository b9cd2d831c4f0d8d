//! A sheet as a PNG file, through plotters' bitmap backend.
//!
//! Everything is drawn several times larger and averaged down: thin lines, text and areas come out evenly smooth.
//! Areas and strokes are cut into rows here (non-zero winding), because the backend's own polygons leave holes where an
//! outline crosses itself, which measured spectra do.

use std::f64::consts::TAU;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use plotters::backend::{BitMapBackend, DrawingBackend};
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, RGBAColor, RGBColor};

use super::sheet::{Align, Ink, Op, Point, Sheet, Text};
use super::{Error, font};

/// Most pixels of the enlarged drawing.
const LARGEST: u64 = 64_000_000;

/// Write the sheet as PNG of the given size in pixels.
pub(super) fn write(sheet: &Sheet, (width, height): (u32, u32)) -> Result<Vec<u8>, Error> {
    font::register()?;
    let pixels = u64::from(width) * u64::from(height);
    let times = [4u32, 3, 2].into_iter().find(|&n| pixels * u64::from(n * n) <= LARGEST).unwrap_or(1);
    let (w, h) = (width * times, height * times);
    let mut buffer = vec![255u8; w as usize * h as usize * 3];
    {
        let backend = BitMapBackend::with_buffer(&mut buffer, (w, h));
        let scale = (f64::from(w) / sheet.width, f64::from(h) / sheet.height);
        let mut raster = Raster { backend, scale, size: (f64::from(w), f64::from(h)) };
        for op in &sheet.ops {
            raster.draw(op).map_err(Error::Drawing)?;
        }
        raster.backend.present().map_err(|e| Error::Drawing(e.to_string()))?;
    }
    encode(&average(&buffer, width as usize, height as usize, times as usize), width, height)
}

/// RGB pixels as a PNG file.
pub(super) fn encode(pixels: &[u8], width: u32, height: u32) -> Result<Vec<u8>, Error> {
    let mut out = Vec::new();
    PngEncoder::new_with_quality(&mut out, CompressionType::Default, FilterType::Adaptive).write_image(
        pixels,
        width,
        height,
        ExtendedColorType::Rgb8,
    )?;
    Ok(out)
}

/// Means of `n` × `n` pixels.
fn average(large: &[u8], width: usize, height: usize, n: usize) -> Vec<u8> {
    let mut out = Vec::with_capacity(width * height * 3);
    let count = (n * n) as u32;
    let mut sums = vec![0u32; width * 3];
    for rows in large.chunks_exact(width * n * 3 * n) {
        sums.fill(0);
        for row in rows.chunks_exact(width * n * 3) {
            for (block, sum) in row.chunks_exact(3 * n).zip(sums.chunks_exact_mut(3)) {
                for pixel in block.chunks_exact(3) {
                    sum.iter_mut().zip(pixel).for_each(|(s, &v)| *s += u32::from(v));
                }
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "a mean of bytes is a byte")]
        out.extend(sums.iter().map(|s| ((s + count / 2) / count) as u8));
    }
    out
}

struct Raster<'a> {
    backend: BitMapBackend<'a>,
    scale: (f64, f64),
    size: (f64, f64),
}

#[expect(clippy::cast_possible_truncation, reason = "cut to the picture before")]
fn whole(v: f64) -> i32 {
    v.round() as i32
}

impl Raster<'_> {
    fn place(&self, (x, y): Point) -> Point {
        (x * self.scale.0, y * self.scale.1)
    }

    fn draw(&mut self, op: &Op) -> Result<(), String> {
        match op {
            Op::Stroke { points, width, ink } => {
                let points: Vec<Point> = points.iter().map(|&p| self.place(p)).collect();
                self.fill(&outlines(&points, width * self.scale.1), *ink)
            }
            Op::Fill { points, ink } => {
                let points = points.iter().map(|&p| self.place(p)).collect();
                self.fill(&[points], *ink)
            }
            Op::Disc { centre, radius, ink } => self.fill(&[circle(self.place(*centre), radius * self.scale.1)], *ink),
            Op::Gradient { outline, stops } => {
                let outline: Vec<Point> = outline.iter().map(|&p| self.place(p)).collect();
                let stops: Vec<_> = stops.iter().map(|&(x, c)| (x * self.scale.0, c)).collect();
                self.shade(&outline, |x, _| gradient(&stops, x))
            }
            Op::Image { area, columns, rows, pixels, clip } => {
                let clip: Vec<Point> = clip.iter().map(|&p| self.place(p)).collect();
                let ((x0, y0), (x1, y1)) = (self.place((area.x0, area.y0)), self.place((area.x1, area.y1)));
                self.shade(&clip, |x, y| {
                    let u = (x - x0) / (x1 - x0) * f64::from(*columns) - 0.5;
                    let v = (y - y0) / (y1 - y0) * f64::from(*rows) - 0.5;
                    bilinear(pixels, *columns as usize, *rows as usize, u, v)
                })
            }
            Op::Pixels { area, columns, rows, pixels } => {
                let clip: Vec<Point> = area.corners().iter().map(|&p| self.place(p)).collect();
                let ((x0, y0), (x1, y1)) = (clip[0], clip[2]);
                self.shade(&clip, |x, y| {
                    let i = index((x - x0) / (x1 - x0), *columns);
                    let at = 3 * (index((y - y0) / (y1 - y0), *rows) * *columns as usize + i);
                    [pixels[at], pixels[at + 1], pixels[at + 2]]
                })
            }
            Op::Text(text) => self.text(text),
        }
    }

    fn fill(&mut self, polygons: &[Vec<Point>], ink: Ink) -> Result<(), String> {
        let colour = colour(ink);
        for (y, x0, x1) in spans(polygons, self.size) {
            self.backend.draw_rect((x0, y), (x1, y + 1), &colour, true).map_err(|e| e.to_string())?;
        }
        Ok(())
    }

    fn shade(&mut self, outline: &[Point], at: impl Fn(f64, f64) -> [u8; 3]) -> Result<(), String> {
        for (y, x0, x1) in spans(&[outline.to_vec()], self.size) {
            for x in x0..x1 {
                let [r, g, b] = at(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let colour = RGBColor(r, g, b).to_backend_color();
                self.backend.draw_pixel((x, y), colour).map_err(|e| e.to_string())?;
            }
        }
        Ok(())
    }

    /// Letter by letter: plotters leaves out the space to the left of each letter and rounds the pen to pixels.
    fn text(&mut self, text: &Text) -> Result<(), String> {
        let em = text.size * self.scale.1;
        let size = font::raster_size(em);
        let desc = FontDesc::new(FontFamily::Name(font::FAMILY), size, FontStyle::Normal);
        let width = font::width(&text.text, em);
        let mut pen = match text.align {
            Align::Start => 0.0,
            Align::Middle => -width / 2.0,
            Align::End => -width,
        };
        let (ox, oy) = self.place(text.at);
        let colour = colour(text.ink);
        let mut buffer = [0u8; 4];
        for c in text.text.chars() {
            // plotters puts the baseline half the size below the given place.
            let (left, top) = (whole(pen + font::left_bearing(c, em).floor()), whole(-size / 2.0));
            let mut inked: Vec<(i32, i32, f32)> = Vec::new();
            let keep = |x: i32, y: i32, cover: f32| -> Result<(), std::convert::Infallible> {
                inked.push((x, y, cover));
                Ok(())
            };
            let drawn = desc.draw(c.encode_utf8(&mut buffer), (left, top), keep);
            drawn.map_err(|e| e.to_string())?.unwrap_or_default();
            for (x, y, cover) in inked {
                let (x, y) = if text.turned { (y, -x) } else { (x, y) };
                let at = (whole(ox) + x, whole(oy) + y);
                let shade = colour.mix(f64::from(cover).min(1.0)).to_backend_color();
                self.backend.draw_pixel(at, shade).map_err(|e| e.to_string())?;
            }
            pen += font::advance(c, em);
        }
        Ok(())
    }
}

fn colour(ink: Ink) -> RGBAColor {
    RGBColor(ink.rgb[0], ink.rgb[1], ink.rgb[2]).mix(ink.alpha)
}

/// A stroked line as polygons of one winding direction: a bar for each segment, a disc for each joint.
fn outlines(points: &[Point], width: f64) -> Vec<Vec<Point>> {
    let r = width.max(1.0) / 2.0;
    let mut out = Vec::with_capacity(points.len() * 2);
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        if length > 0.0 {
            let (nx, ny) = ((b.1 - a.1) / length * r, -(b.0 - a.0) / length * r);
            out.push(vec![(a.0 + nx, a.1 + ny), (b.0 + nx, b.1 + ny), (b.0 - nx, b.1 - ny), (a.0 - nx, a.1 - ny)]);
        }
    }
    let joints = points.get(1..points.len().saturating_sub(1)).unwrap_or_default();
    out.extend(joints.iter().map(|&p| circle(p, r)));
    out
}

fn circle((x, y): Point, r: f64) -> Vec<Point> {
    let count = if r > 40.0 { 120 } else { 24 };
    let angle = |i: i32| TAU * f64::from(i) / f64::from(count);
    (0..count).map(|i| (x + r * angle(i).cos(), y + r * angle(i).sin())).collect()
}

/// Rows of pixels within polygons taken together (non-zero winding): y, first x, one past the last x.
fn spans(polygons: &[Vec<Point>], (width, height): (f64, f64)) -> Vec<(i32, i32, i32)> {
    let mut crossings: Vec<(i32, f64, i32)> = Vec::new();
    for polygon in polygons {
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            let (top, bottom, way) = if a.1 < b.1 { (a, b, 1) } else { (b, a, -1) };
            let first = whole((top.1 - 0.5).ceil().clamp(0.0, height));
            let last = whole((bottom.1 - 0.5).ceil().clamp(0.0, height));
            for y in first..last {
                let t = (f64::from(y) + 0.5 - top.1) / (bottom.1 - top.1);
                crossings.push((y, top.0 + t * (bottom.0 - top.0), way));
            }
        }
    }
    crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut out = Vec::new();
    let (mut winding, mut start) = (0, 0.0);
    for (y, x, way) in crossings {
        if winding == 0 {
            start = x;
        }
        winding += way;
        if winding == 0 {
            let (x0, x1) = (whole(start.clamp(0.0, width)), whole(x.clamp(0.0, width)));
            if x0 < x1 {
                out.push((y, x0, x1));
            }
        }
    }
    out
}

fn gradient(stops: &[(f64, [u8; 3])], x: f64) -> [u8; 3] {
    let after = stops.partition_point(|s| s.0 <= x);
    match (after.checked_sub(1).map(|i| stops[i]), stops.get(after)) {
        (Some((x0, c0)), Some(&(x1, c1))) => mix(c0, c1, (x - x0) / (x1 - x0)),
        (Some((_, c)), None) | (None, Some(&(_, c))) => c,
        (None, None) => [255; 3],
    }
}

/// The colour a part `t` of the way from `a` to `b`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
pub(super) fn mix(a: [u8; 3], b: [u8; 3], t: f64) -> [u8; 3] {
    std::array::from_fn(|i| (f64::from(a[i]) + t * (f64::from(b[i]) - f64::from(a[i]))).round() as u8)
}

/// Which of `count` cells a share from 0 to 1 falls into.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the cells")]
fn index(share: f64, count: u32) -> usize {
    ((share * f64::from(count)).max(0.0) as usize).min(count as usize - 1)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the picture")]
fn bilinear(pixels: &[u8], columns: usize, rows: usize, u: f64, v: f64) -> [u8; 3] {
    let (u, v) = (u.clamp(0.0, (columns - 1) as f64), v.clamp(0.0, (rows - 1) as f64));
    let (i, j) = (u as usize, v as usize);
    let pixel = |i: usize, j: usize| -> [u8; 3] {
        let at = 3 * (j.min(rows - 1) * columns + i.min(columns - 1));
        [pixels[at], pixels[at + 1], pixels[at + 2]]
    };
    let (s, t) = (u - i as f64, v - j as f64);
    mix(mix(pixel(i, j), pixel(i + 1, j), s), mix(pixel(i, j + 1), pixel(i + 1, j + 1), s), t)
}
