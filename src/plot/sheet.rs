//! A drawing as a list of strokes, areas and words in picture pixels, before it becomes SVG or PNG.
//!
//! Panels write here and know nothing of file formats; [`super::svg`] and [`super::png`] read the same list, which is
//! why both formats show the same picture.

use super::font;

/// A place on the sheet: pixels from the left, pixels from the top.
pub(super) type Point = (f64, f64);

/// An upright rectangle, `y` growing downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub x0: f64,
    pub y0: f64,
    pub x1: f64,
    pub y1: f64,
}

impl Rect {
    pub(super) fn new(x0: f64, y0: f64, x1: f64, y1: f64) -> Self {
        Self { x0, y0, x1, y1 }
    }

    pub(super) fn width(&self) -> f64 {
        self.x1 - self.x0
    }

    pub(super) fn height(&self) -> f64 {
        self.y1 - self.y0
    }

    pub(super) fn grown(&self, by: f64) -> Self {
        Self::new(self.x0 - by, self.y0 - by, self.x1 + by, self.y1 + by)
    }

    pub(super) fn contains(&self, (x, y): Point) -> bool {
        (self.x0..=self.x1).contains(&x) && (self.y0..=self.y1).contains(&y)
    }

    pub(super) fn holds(&self, other: &Self) -> bool {
        self.contains((other.x0, other.y0)) && self.contains((other.x1, other.y1))
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.x0 < other.x1 && other.x0 < self.x1 && self.y0 < other.y1 && other.y0 < self.y1
    }

    pub(super) fn corners(&self) -> [Point; 4] {
        [(self.x0, self.y0), (self.x1, self.y0), (self.x1, self.y1), (self.x0, self.y1)]
    }
}

/// A colour (sRGB) and how much it covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ink {
    pub rgb: [u8; 3],
    pub alpha: f64,
}

impl Ink {
    pub(super) const fn grey(level: u8) -> Self {
        Self { rgb: [level; 3], alpha: 1.0 }
    }

    pub(super) const fn rgb(rgb: [u8; 3]) -> Self {
        Self { rgb, alpha: 1.0 }
    }

    pub(super) const fn alpha(self, alpha: f64) -> Self {
        Self { rgb: self.rgb, alpha }
    }
}

/// Text and curves.
pub(super) const DARK: Ink = Ink::grey(25);
/// Secondary text.
pub(super) const SOFT: Ink = Ink::grey(75);
/// Frames and ticks.
pub(super) const FRAME: Ink = Ink::grey(90);
/// Grid lines.
pub(super) const GRID: Ink = Ink::grey(222);
pub(super) const WHITE: Ink = Ink::grey(255);

/// Which end of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    Start,
    Middle,
    End,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Text {
    /// On the baseline.
    pub at: Point,
    pub text: String,
    pub size: f64,
    pub ink: Ink,
    pub align: Align,
    /// Turned by a quarter, to be read from below upwards.
    pub turned: bool,
}

impl Text {
    /// The box around the letters, with accents and descenders.
    pub(super) fn bounds(&self) -> Rect {
        let width = font::width(&self.text, self.size);
        let start = match self.align {
            Align::Start => 0.0,
            Align::Middle => -width / 2.0,
            Align::End => -width,
        };
        let (up, down) = (0.78 * self.size, 0.24 * self.size);
        let (x, y) = self.at;
        if self.turned {
            Rect::new(x - up, y - start - width, x + down, y - start)
        } else {
            Rect::new(x + start, y - up, x + start + width, y + down)
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Op {
    /// A line through points.
    Stroke { points: Vec<Point>, width: f64, ink: Ink },
    /// A filled polygon.
    Fill { points: Vec<Point>, ink: Ink },
    /// A filled circle.
    Disc { centre: Point, radius: f64, ink: Ink },
    /// A polygon filled with colours that change from left to right: stops are (x, colour), x rising.
    Gradient { outline: Vec<Point>, stops: Vec<(f64, [u8; 3])> },
    /// RGB pixels stretched over `area`, seen only within the polygon `clip`.
    Image { area: Rect, columns: u32, rows: u32, pixels: Vec<u8>, clip: Vec<Point> },
    /// RGB pixels with sharp edges over `area`, their colours unchanged.
    Pixels { area: Rect, columns: u32, rows: u32, pixels: Vec<u8> },
    /// A line of text.
    Text(Text),
}

/// The sheet: its size and what is drawn on it, from the lowest to the topmost.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sheet {
    pub width: f64,
    pub height: f64,
    pub title: String,
    pub ops: Vec<Op>,
}

impl Sheet {
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self { width, height, title: String::new(), ops: Vec::new() }
    }

    pub(super) fn stroke(&mut self, points: Vec<Point>, width: f64, ink: Ink) {
        if points.len() > 1 {
            self.ops.push(Op::Stroke { points, width, ink });
        }
    }

    pub(super) fn line(&mut self, a: Point, b: Point, width: f64, ink: Ink) {
        self.stroke(vec![a, b], width, ink);
    }

    /// A dashed line; `pattern` is the lengths of dash and gap in turn.
    pub(super) fn dashed(&mut self, points: &[Point], pattern: &[f64], width: f64, ink: Ink) {
        for dash in dashes(points, pattern) {
            self.stroke(dash, width, ink);
        }
    }

    pub(super) fn fill(&mut self, points: Vec<Point>, ink: Ink) {
        if points.len() > 2 {
            self.ops.push(Op::Fill { points, ink });
        }
    }

    pub(super) fn disc(&mut self, centre: Point, radius: f64, ink: Ink) {
        self.ops.push(Op::Disc { centre, radius, ink });
    }

    pub(super) fn frame(&mut self, r: Rect, width: f64, ink: Ink) {
        let mut points = r.corners().to_vec();
        // One corner is passed twice so that it is mitred like the others.
        points.extend([points[0], points[1]]);
        self.stroke(points, width, ink);
    }

    /// Write one line; characters that XML forbids or that would break the line become blanks.
    pub(super) fn text(&mut self, at: Point, text: &str, size: f64, ink: Ink, align: Align) -> Rect {
        self.write(Text { at, text: text.to_owned(), size, ink, align, turned: false })
    }

    /// Write one line upwards.
    pub(super) fn text_up(&mut self, at: Point, text: &str, size: f64, ink: Ink, align: Align) -> Rect {
        self.write(Text { at, text: text.to_owned(), size, ink, align, turned: true })
    }

    pub(super) fn write(&mut self, mut text: Text) -> Rect {
        text.text = clean(&text.text);
        let bounds = text.bounds();
        if !text.text.is_empty() {
            self.ops.push(Op::Text(text));
        }
        bounds
    }
}

/// One line of printable text: control characters and runs of blanks become one blank.
pub(super) fn clean(text: &str) -> String {
    let printable = |c: char| if c.is_control() || ('\u{FFFE}'..='\u{FFFF}').contains(&c) { ' ' } else { c };
    let spaced: String = text.chars().map(printable).collect();
    spaced.split(' ').filter(|w| !w.is_empty()).collect::<Vec<_>>().join(" ")
}

fn dashes(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let mut out = Vec::new();
    let mut current: Vec<Point> = points.first().copied().into_iter().collect();
    let mut lengths = pattern.iter().copied().cycle();
    let (mut drawing, mut left) = (true, lengths.next().unwrap_or(f64::INFINITY));
    for pair in points.windows(2) {
        let (mut a, b) = (pair[0], pair[1]);
        loop {
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            if length < left || length == 0.0 {
                left -= length;
                current.push(b);
                break;
            }
            let t = left / length;
            a = (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
            current.push(a);
            if drawing {
                out.push(std::mem::take(&mut current));
            }
            current = vec![a];
            drawing = !drawing;
            left = lengths.next().unwrap_or(f64::INFINITY);
        }
    }
    // A last dash of no length would be a speck.
    let long = current.windows(2).any(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1) > 1e-6);
    if drawing && long {
        out.push(current);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_cover_their_share_of_the_line() {
        let parts = dashes(&[(0.0, 0.0), (30.0, 0.0), (30.0, 70.0)], &[6.0, 4.0]);
        let length = |p: &Vec<Point>| p.windows(2).map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1)).sum::<f64>();
        assert_eq!(parts.len(), 10);
        assert!((parts.iter().map(length).sum::<f64>() - 60.0).abs() < 1e-9);
    }

    #[test]
    fn text_is_one_printable_line() {
        assert_eq!(clean(" a\u{0}b\n c\u{FFFF}\t"), "a b c");
    }
}
