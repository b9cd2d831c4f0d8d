//! The embedded typeface: registered with plotters once, measured here, written into SVG files as base64.
//!
//! Text is placed by its baseline and by advance widths read from the font itself, without hinting or kerning, so that
//! an SVG viewer and our own PNG set the same letters at the same places.

use std::sync::{LazyLock, OnceLock};

use plotters::style::{FontStyle, register_font};

use super::Error;

/// What SVG text asks for: the embedded face first, then its nearest relatives on machines that ignore embedded fonts.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";
/// The name given to the embedded face in the `@font-face` rule.
pub(super) const FACE: &str = "DejaVu Sans";

static FILE: &[u8] = include_bytes!("../../data/fonts/DejaVuSans-subset.ttf");
static METRICS: LazyLock<Metrics> = LazyLock::new(|| Metrics::read(FILE).unwrap_or_default());

/// Make the embedded face known to plotters; the first call does it.
pub(super) fn register() -> Result<(), Error> {
    static DONE: OnceLock<bool> = OnceLock::new();
    let done = *DONE.get_or_init(|| register_font(FAMILY, FontStyle::Normal, FILE).is_ok());
    if done { Ok(()) } else { Err(Error::Font) }
}

/// Width of `text` set at `size` pixels per em.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| advance(c, size)).sum()
}

/// Pen movement after one character.
pub(super) fn advance(c: char, size: f64) -> f64 {
    let m = &*METRICS;
    f64::from(m.glyph(c).advance) * size / m.units_per_em
}

/// Distance from the pen to the left edge of the character's ink.
pub(super) fn left_bearing(c: char, size: f64) -> f64 {
    let m = &*METRICS;
    f64::from(m.glyph(c).left_bearing) * size / m.units_per_em
}

/// The size that plotters' rasteriser must be given (ascent to descent) for letters of `em` pixels per em.
pub(super) fn raster_size(em: f64) -> f64 {
    em * METRICS.height / METRICS.units_per_em
}

/// The `@font-face` rule that carries the font inside an SVG file.
pub(super) fn face_rule() -> &'static str {
    static RULE: OnceLock<String> = OnceLock::new();
    RULE.get_or_init(|| {
        format!("@font-face{{font-family:'{FACE}';src:url(data:font/ttf;base64,{}) format('truetype')}}", base64(FILE))
    })
}

/// Cut `text` to fit `room`, ending in an ellipsis where something was cut.
pub(super) fn fit(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let mut left = room - advance('…', size);
    let mut kept = String::new();
    for c in text.chars() {
        left -= advance(c, size);
        if left < 0.0 {
            break;
        }
        kept.push(c);
    }
    kept.truncate(kept.trim_end().len());
    kept.push('…');
    kept
}

/// Break `text` into lines no wider than `room`, at blanks where there are any.
pub(super) fn wrap(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if width(&longer, size) <= room || line.is_empty() {
            line = longer;
        } else {
            lines.push(fit(&line, size, room));
            word.clone_into(&mut line);
        }
    }
    if !line.is_empty() {
        lines.push(fit(&line, size, room));
    }
    lines
}

/// Base64 with padding (RFC 4648, section 4).
pub(super) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let b = [chunk[0], chunk.get(1).copied().unwrap_or(0), chunk.get(2).copied().unwrap_or(0)];
        let n = u32::from_be_bytes([0, b[0], b[1], b[2]]);
        for i in 0..4 {
            if i <= chunk.len() {
                out.push(char::from(DIGITS[(n >> (18 - 6 * i) & 63) as usize]));
            } else {
                out.push('=');
            }
        }
    }
    out
}

#[derive(Debug, Clone, Copy, Default)]
struct Glyph {
    advance: u16,
    left_bearing: i16,
}

/// The few tables of a TrueType file that tell how wide letters are.
#[derive(Debug, Default)]
struct Metrics {
    units_per_em: f64,
    height: f64,
    /// Ranges of characters: first, last, glyph of each.
    ranges: Vec<(u32, u32, Vec<usize>)>,
    glyphs: Vec<Glyph>,
}

impl Metrics {
    fn glyph(&self, c: char) -> Glyph {
        let c = u32::from(c);
        let at = self.ranges.partition_point(|r| r.1 < c);
        let index = self.ranges.get(at).filter(|r| r.0 <= c).map_or(0, |r| r.2[(c - r.0) as usize]);
        self.glyphs.get(index).or(self.glyphs.first()).copied().unwrap_or_default()
    }

    fn read(file: &[u8]) -> Option<Self> {
        let table = |tag: &[u8; 4]| -> Option<&[u8]> {
            let count = usize::from(u16_at(file, 4)?);
            let record = file.get(12..)?.chunks_exact(16).take(count).find(|r| &r[..4] == tag)?;
            file.get(u32_at(record, 8)? as usize..)?.get(..u32_at(record, 12)? as usize)
        };
        let (head, hhea, hmtx, cmap) = (table(b"head")?, table(b"hhea")?, table(b"hmtx")?, table(b"cmap")?);
        let count = usize::from(u16_at(hhea, 34)?);
        let full = hmtx.get(..4 * count)?.chunks_exact(4);
        let mut glyphs: Vec<Glyph> =
            full.map(|r| Some(Glyph { advance: u16_at(r, 0)?, left_bearing: i16_at(r, 2)? })).collect::<Option<_>>()?;
        let last = glyphs.last()?.advance;
        let rest = hmtx.get(4 * count..)?.chunks_exact(2);
        glyphs.extend(rest.filter_map(|r| Some(Glyph { advance: last, left_bearing: i16_at(r, 0)? })));
        Some(Self {
            units_per_em: f64::from(u16_at(head, 18)?),
            height: f64::from(i16_at(hhea, 4)?) - f64::from(i16_at(hhea, 6)?),
            ranges: character_map(cmap)?,
            glyphs,
        })
    }
}

/// The first format 4 subtable of `cmap`.
fn character_map(cmap: &[u8]) -> Option<Vec<(u32, u32, Vec<usize>)>> {
    let subtable = (0..usize::from(u16_at(cmap, 2)?))
        .filter_map(|i| cmap.get(u32_at(cmap, 4 + 8 * i + 4)? as usize..))
        .find(|t| u16_at(t, 0) == Some(4))?;
    let segments = usize::from(u16_at(subtable, 6)?) / 2;
    let mut ranges = Vec::with_capacity(segments);
    for i in 0..segments {
        let field = |n: usize| 14 + 2 * (n * segments + i) + if n > 0 { 2 } else { 0 };
        let (end, start) = (u16_at(subtable, field(0))?, u16_at(subtable, field(1))?);
        let (delta, offset) = (u16_at(subtable, field(2))?, u16_at(subtable, field(3))?);
        let glyph = |c: u16| -> Option<usize> {
            let g = if offset == 0 {
                c.wrapping_add(delta)
            } else {
                match u16_at(subtable, field(3) + usize::from(offset) + 2 * usize::from(c - start))? {
                    0 => 0,
                    g => g.wrapping_add(delta),
                }
            };
            Some(usize::from(g))
        };
        ranges.push((u32::from(start), u32::from(end), (start..=end).map(glyph).collect::<Option<_>>()?));
    }
    Some(ranges)
}

fn u16_at(b: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(b.get(at..at + 2)?.try_into().ok()?))
}

fn i16_at(b: &[u8], at: usize) -> Option<i16> {
    Some(i16::from_be_bytes(b.get(at..at + 2)?.try_into().ok()?))
}

fn u32_at(b: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(b.get(at..at + 4)?.try_into().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_those_of_the_font() {
        // Advance widths of DejaVu Sans 2.37 in units of 1/2048 em, as fonttools prints them.
        for (c, units) in [('0', 1303.0), ('W', 2025.0), ('λ', 1212.0), ('′', 465.0), ('−', 1716.0), ('⁻', 1081.0)]
        {
            assert_eq!(advance(c, 2048.0), units, "{c}");
        }
        assert_eq!(raster_size(2048.0), 2384.0);
    }

    #[test]
    fn every_character_that_we_print_ourselves_is_there() {
        let missing = METRICS.glyph('\u{3042}');
        assert_eq!(missing.advance, 1229, "the box for characters that the font lacks");
        for c in "²³⁻⁰¹⁴⁵⁶⁷⁸⁹₁′−Δλµ·°–×∞…%’".chars() {
            let c = u32::from(c);
            let found = METRICS.ranges.iter().find(|r| r.0 <= c && c <= r.1).map(|r| r.2[(c - r.0) as usize]);
            assert!(found.is_some_and(|g| g != 0), "U+{c:04X}");
        }
    }

    #[test]
    fn text_is_cut_and_wrapped_to_its_room() {
        assert_eq!(fit("short", 12.0, 100.0), "short");
        let cut = fit("a name much too long for its place", 12.0, 80.0);
        assert!(cut.ends_with('…') && width(&cut, 12.0) <= 80.0, "{cut}");
        assert_eq!(wrap("CCT 4012 K, Duv +0.0012", 12.0, 90.0), ["CCT 4012 K,", "Duv +0.0012"]);
    }

    #[test]
    fn base64_of_rfc_4648() {
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
