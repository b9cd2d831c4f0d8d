//! A false-colour picture with its legend: each value one colour, exactly the one that the legend shows for it.

use super::axis::{self, MARGIN, Scale, TICK_TEXT};
use super::clip;
use super::colour_map::ColourMap;
use super::font;
use super::labels::Labels;
use super::sheet::{Align, DARK, FRAME, Op, Point, Rect, SOFT, Sheet, WHITE};

/// Values that the colours stand for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ColourRange {
    /// Value of the first colour.
    pub low: f64,
    /// Value of the last colour, above `low`.
    pub high: f64,
    /// In proportion to the logarithm of the value; `low` is then above 0.
    pub logarithmic: bool,
}

/// Colour of values below the range.
pub(super) const UNDER: [u8; 3] = [64; 3];
/// Colour of values above it.
pub(super) const OVER: [u8; 3] = [255; 3];
/// Colour of no value. None of the three is in a map.
pub(super) const NONE: [u8; 3] = [160; 3];

impl ColourRange {
    /// The place of a value within the range: 0 at `low`, 1 at `high`.
    #[must_use]
    pub fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// The colour of a value: of the map within the range, white above, dark grey below, light grey for NaN.
    #[must_use]
    pub fn colour(&self, map: ColourMap, value: f64) -> [u8; 3] {
        match value {
            v if v.is_nan() => NONE,
            v if v < self.low => UNDER,
            v if v > self.high => OVER,
            v => map.at(self.share(v)),
        }
    }

    /// Round values within the range, about `count` of them.
    pub(super) fn ticks(&self, count: f64) -> Vec<f64> {
        let inside = |v: &f64| (self.low * (1.0 - 1e-12)..=self.high * (1.0 + 1e-12)).contains(v);
        let decades = if self.logarithmic { (self.high / self.low).log10() } else { 0.0 };
        if decades < 0.8 {
            return Scale::new(self.low, self.high, 0.0, count).ticks(1.0).values;
        }
        let factors: &[f64] = match count / decades {
            n if n >= 3.0 => &[1.0, 2.0, 5.0],
            n if n >= 2.0 => &[1.0, 3.0],
            _ => &[1.0],
        };
        // Where not every decade has room, every second, third …
        let every = (decades / count).ceil().max(1.0);
        let (first, last) = (self.low.log10().floor(), self.high.log10().ceil());
        let mut powers = Vec::new();
        let mut power = (first / every).floor() * every;
        while power <= last {
            powers.push(power);
            power += every;
        }
        powers.into_iter().flat_map(|p| factors.iter().map(move |f| f * 10f64.powf(p))).filter(inside).collect()
    }
}

/// Lines on which the picture has one value.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The value.
    pub value: f64,
    /// Lines through places in pixels of the picture, from its upper left corner.
    pub lines: Vec<Vec<(f64, f64)>>,
}

/// A picture of values in false colours.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FalseColourPanel {
    /// Above the picture.
    pub title: String,
    /// A line below the title.
    pub figures: String,
    /// Columns of the picture.
    pub columns: usize,
    /// Its rows.
    pub rows: usize,
    /// Row by row from the top; NaN where there is none.
    pub values: Vec<f32>,
    /// Unit of the values.
    pub unit: String,
    /// What the colours stand for.
    pub range: ColourRange,
    /// The colours.
    pub map: ColourMap,
    /// Contour lines.
    pub levels: Vec<Level>,
    /// What values below the range stand for, where that is more than that they are low.
    pub below: Option<Kind>,
}

/// A kind of place with a colour of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Kind {
    /// In the legend.
    pub name: String,
    /// Its colour, which no map has.
    pub colour: [u8; 3],
}

/// Pictures are enlarged to at least this side, each pixel by a whole number.
const SIDE: usize = 480;
/// Width of the legend.
const LEGEND: f64 = 118.0;
/// Least height of the legend.
const LEAST: f64 = 220.0;
/// Least width of the panel, for the title.
const NARROWEST: f64 = 420.0;
/// Height of the place for the title and the line below it.
const HEAD: f64 = 58.0;
/// Height of a box of the legend.
const BOX: f64 = 14.0;
const FIGURE_TEXT: f64 = 13.0;
const LINE_TEXT: f64 = 12.0;
/// Lines shorter than this many pixels are of noise and are left out.
const SHORTEST: f64 = 12.0;
/// Labels of one level.
const LABELS: usize = 4;

impl FalseColourPanel {
    /// Width and height at which each pixel is a whole number of pixels of the drawing.
    pub(super) fn natural(&self) -> (f64, f64) {
        let zoom = SIDE.div_ceil(self.columns.max(self.rows).max(1));
        let (width, height) = ((zoom * self.columns) as f64, (zoom * self.rows) as f64);
        ((MARGIN + width + LEGEND).max(NARROWEST), HEAD + height.max(LEAST) + MARGIN)
    }

    pub(super) fn draw(&self, sheet: &mut Sheet, area: Rect) {
        let below = axis::title(sheet, area, &self.title);
        let figures = font::fit(&self.figures, FIGURE_TEXT, area.width() - 2.0 * MARGIN);
        sheet.text((area.x0 + MARGIN, below + 8.0), &figures, FIGURE_TEXT, SOFT, Align::Start);
        if self.columns == 0 || self.rows == 0 || self.values.len() != self.columns * self.rows {
            return;
        }
        let (columns, rows) = (self.columns as f64, self.rows as f64);
        let room = (area.width() - MARGIN - LEGEND, area.height() - HEAD - MARGIN);
        let zoom = (room.0 / columns).min(room.1 / rows);
        let (x, y) = (area.x0 + MARGIN, area.y0 + HEAD);
        let picture = Rect::new(x, y, x + zoom * columns, y + zoom * rows);
        #[expect(clippy::cast_possible_truncation, reason = "pictures have a few thousand pixels per side")]
        sheet.ops.push(Op::Pixels {
            area: picture,
            columns: self.columns as u32,
            rows: self.rows as u32,
            pixels: self.values.iter().flat_map(|v| self.colour(f64::from(*v))).collect(),
        });
        self.contours(sheet, picture, zoom);
        // The frame stands outside, so that no pixel of the picture is touched.
        sheet.frame(picture.grown(0.5), 1.0, FRAME);
        self.legend(sheet, Rect::new(picture.x1 + 16.0, y, picture.x1 + 34.0, y + room.1));
    }

    fn colour(&self, value: f64) -> [u8; 3] {
        match &self.below {
            Some(kind) if value < self.range.low => kind.colour,
            _ => self.range.colour(self.map, value),
        }
    }

    fn contours(&self, sheet: &mut Sheet, picture: Rect, zoom: f64) {
        let place = |&(x, y): &(f64, f64)| -> Point { (picture.x0 + zoom * x, picture.y0 + zoom * y) };
        let long = |l: &Vec<Point>| length(l) >= SHORTEST;
        let drawn: Vec<(f64, Vec<Vec<Point>>)> = (self.levels.iter())
            .map(|l| (l.value, l.lines.iter().map(|l| l.iter().map(place).collect()).filter(long).collect()))
            .collect();
        for (value, lines) in &drawn {
            // Dark on light colours, light on dark ones.
            let ink = if self.range.share(*value) < 0.55 { WHITE } else { DARK };
            for line in lines {
                sheet.stroke(line.clone(), 1.2, ink);
            }
        }
        let mut labels = Labels::new(picture.grown(-2.0));
        for (value, mut lines) in drawn {
            let text = text(value);
            lines.sort_by(|a, b| length(b).total_cmp(&length(a)));
            let room = 3.0 * font::width(&text, LINE_TEXT);
            for line in lines.iter().filter(|l| length(l) > room).take(LABELS) {
                labels.on_line(sheet, line, &text, LINE_TEXT, DARK);
            }
        }
    }

    /// The colour scale, with boxes for what lies outside of it where there is any.
    fn legend(&self, sheet: &mut Sheet, mut bar: Rect) {
        sheet.text((bar.x0, bar.y0 + 10.0), &self.unit, TICK_TEXT, DARK, Align::Start);
        bar.y0 += 20.0;
        let any = |f: fn(&ColourRange, f64) -> bool| self.values.iter().any(|v| f(&self.range, f64::from(*v)));
        let (over, under, none) = (any(|r, v| v > r.high), any(|r, v| v < r.low), any(|_, v| v.is_nan()));
        let boxed = |sheet: &mut Sheet, y: f64, colour: [u8; 3], text: &str| {
            let area = Rect::new(bar.x0, y, bar.x1, y + BOX);
            sheet.ops.push(Op::Pixels { area, columns: 1, rows: 1, pixels: colour.to_vec() });
            sheet.frame(area.grown(0.5), 1.0, FRAME);
            sheet.text((area.x1 + 9.0, y + 11.5), text, TICK_TEXT, DARK, Align::Start);
        };
        if over {
            boxed(sheet, bar.y0, OVER, &format!("> {}", text(self.range.high)));
            bar.y0 += BOX + 10.0;
        }
        if none {
            bar.y1 -= BOX + 1.0;
            boxed(sheet, bar.y1, NONE, "no value");
            bar.y1 -= 10.0;
        }
        if under {
            bar.y1 -= BOX + 1.0;
            let low = || (UNDER, format!("< {}", text(self.range.low)));
            let (colour, words) = self.below.as_ref().map_or_else(low, |k| (k.colour, k.name.clone()));
            boxed(sheet, bar.y1, colour, &words);
            bar.y1 -= 10.0;
        }
        let rows = bar.height().floor().max(1.0);
        let colour = |i: f64| self.map.at(1.0 - (i + 0.5) / rows);
        let mut pixels = Vec::new();
        let mut row = 0.0;
        while row < rows {
            pixels.extend(colour(row));
            row += 1.0;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "height of a drawing")]
        sheet.ops.push(Op::Pixels { area: bar, columns: 1, rows: rows as u32, pixels });
        sheet.frame(bar.grown(0.5), 1.0, FRAME);
        let at = |v: f64| bar.y1 - self.range.share(v) * bar.height();
        let mut ticks = self.range.ticks(bar.height() / 38.0);
        // The ends are always told; a round value too near to one gives way.
        let ends = [self.range.low, self.range.high];
        ticks.retain(|t| ends.iter().all(|e| (at(*t) - at(*e)).abs() >= 15.0));
        for value in ticks.into_iter().chain(ends) {
            let y = at(value);
            sheet.line((bar.x1, y), (bar.x1 + 5.0, y), 1.0, FRAME);
            sheet.text((bar.x1 + 9.0, y + 0.36 * TICK_TEXT), &text(value), TICK_TEXT, DARK, Align::Start);
        }
        for level in &self.levels {
            let y = at(level.value);
            for part in clip::line(&[(bar.x0, y), (bar.x1, y)], bar) {
                sheet.stroke(part, 1.2, if self.range.share(level.value) < 0.55 { WHITE } else { DARK });
            }
        }
    }
}

/// A value in three digits, with a power of ten where it is very large or small.
fn text(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        return if value < 0.0 { format!("−{}", axis::plain(-value)) } else { axis::plain(value) };
    }
    let scientific = format!("{value:.2e}");
    let (digits, power) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let digits = digits.trim_end_matches('0').trim_end_matches('.').replace('-', "−");
    let power = axis::power_of_ten(power.parse().unwrap_or(0));
    if digits == "1" { power.trim_start_matches('×').to_owned() } else { format!("{digits}{power}") }
}

fn length(points: &[Point]) -> f64 {
    points.windows(2).map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let range = |low, high, logarithmic| ColourRange { low, high, logarithmic };
        assert_eq!(range(0.0, 100.0, false).ticks(5.0), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        let close =
            |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-12);
        let log = range(0.5, 2000.0, true).ticks(5.0);
        assert!(close(&log, &[1.0, 10.0, 100.0, 1000.0]), "{log:?}");
        let log = range(1.0, 100.0, true).ticks(8.0);
        assert!(close(&log, &[1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]), "{log:?}");
        let log = range(1e-6, 1e9, true).ticks(6.0);
        assert!(close(&log, &[1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9]), "{log:?}");
    }

    #[test]
    fn the_place_of_a_value_is_in_proportion_to_it_or_its_logarithm() {
        let linear = ColourRange { low: 10.0, high: 30.0, logarithmic: false };
        assert_eq!((linear.share(10.0), linear.share(15.0), linear.share(30.0)), (0.0, 0.25, 1.0));
        let log = ColourRange { low: 0.1, high: 1000.0, logarithmic: true };
        assert!((log.share(10.0) - 0.5).abs() < 1e-15);
        let map = ColourMap::Magma;
        assert_eq!(log.colour(map, 0.09), UNDER);
        assert_eq!(log.colour(map, -1.0), UNDER);
        assert_eq!(log.colour(map, 1000.1), OVER);
        assert_eq!(log.colour(map, f64::NAN), NONE);
        assert_eq!((log.colour(map, 0.1), log.colour(map, 1000.0)), (map.at(0.0), map.at(1.0)));
    }

    #[test]
    fn numbers_are_short() {
        for (value, want) in [
            (0.0, "0"),
            (0.5, "0.5"),
            (-2.5, "−2.5"),
            (1234.0, "1234"),
            (2e9, "2×10⁹"),
            (1e-6, "10⁻⁶"),
            (1.234e7, "1.23×10⁷"),
        ] {
            assert_eq!(text(value), want);
        }
    }
}
