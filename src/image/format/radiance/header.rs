//! The header: lines of text, an empty one, and the line of the size.

use crate::colorimetry::rgb::{Encoding, RADIANCE, Space};
use crate::finding::{Checked, Finding, Location};
use crate::image::error::{Error, ErrorKind};

/// The longest header that is read, in bytes: one line per program that the picture went through.
const LONGEST: usize = 1 << 20;
/// The most pixels along an edge: a scan line takes room before its bytes are seen.
const LONGEST_EDGE: u64 = 1 << 24;

/// What the four bytes of a pixel are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Pixels {
    /// Red, green, blue and exponent.
    #[default]
    Rgbe,
    /// X, Y, Z and exponent.
    Xyze,
}

/// How scan lines lie in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Orientation {
    /// Scan lines are columns of the picture.
    pub columns: bool,
    /// Pixels of a row run from the right.
    pub from_right: bool,
    /// Pixels of a column run from the bottom.
    pub from_bottom: bool,
}

/// A header.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Columns of the picture.
    pub width: usize,
    /// Its rows.
    pub height: usize,
    /// How they are stored.
    pub orientation: Orientation,
    /// What they are.
    pub pixels: Pixels,
    /// The product of all `EXPOSURE` lines.
    pub exposure: f64,
    /// The product of all `COLORCORR` lines.
    pub correction: [f64; 3],
    /// The space of RGB pixels.
    pub space: Space,
    /// The product of all `PIXASPECT` lines.
    pub pixel_aspect: f64,
    /// Other variables, the last of a name, and under `history` the lines that are none.
    pub attributes: Vec<(String, String)>,
    /// Bytes before the first scan line.
    pub length: usize,
}

/// Reads the header at the beginning of `bytes`.
///
/// # Errors
/// Where it is none, is not whole within the bytes, or a line that counts cannot be read; with its line.
pub fn parse_header(bytes: &[u8]) -> Result<Checked<Header>, Error> {
    if bytes.is_empty() {
        return Err(ErrorKind::Empty.into());
    }
    let mut header = Header {
        width: 0,
        height: 0,
        orientation: Orientation::default(),
        pixels: Pixels::default(),
        exposure: 1.0,
        correction: [1.0; 3],
        space: Space { encoding: Encoding::Linear, ..RADIANCE },
        pixel_aspect: 1.0,
        attributes: Vec::new(),
        length: 0,
    };
    let mut findings = Vec::new();
    let mut history = Vec::new();
    let mut number = 0;
    loop {
        number += 1;
        let line = line(bytes, header.length, number)?;
        header.length += line.len() + 1;
        let line = String::from_utf8_lossy(line);
        let text = line.trim_end();
        match (number, text) {
            (1, _) if text.starts_with("#?") => {}
            (1, _) => {
                let found = format!("`{}`", text.chars().take(20).collect::<String>());
                let expected = "a line beginning with #?RADIANCE".to_owned();
                return Err(Error::at(1, 1, ErrorKind::Unexpected { found, expected }));
            }
            (_, "") => break,
            _ => header.read_line(text, number, &mut history, &mut findings)?,
        }
    }
    let size = line(bytes, header.length, number + 1)?;
    header.length += size.len() + 1;
    header.read_size(&String::from_utf8_lossy(size), number + 1)?;
    if !history.is_empty() {
        header.attributes.push(("history".to_owned(), history.join(" | ")));
    }
    Ok(Checked { value: header, findings })
}

/// The line from a byte on, without its end.
fn line(bytes: &[u8], from: usize, number: u64) -> Result<&[u8], Error> {
    let rest = bytes.get(from..).unwrap_or_default();
    let end = rest.iter().take(LONGEST).position(|b| *b == b'\n');
    end.map(|end| &rest[..end]).ok_or_else(|| {
        let found = if rest.len() < LONGEST { "the end of the file" } else { "no end of the header" }.to_owned();
        let expected = "header lines, an empty line and a line such as -Y 512 +X 768".to_owned();
        Error::new(Location::line(number), ErrorKind::Unexpected { found, expected })
    })
}

impl Header {
    fn read_line(
        &mut self,
        text: &str,
        number: u64,
        history: &mut Vec<String>,
        findings: &mut Vec<Finding>,
    ) -> Result<(), Error> {
        let variable = text.split_once('=').filter(|(name, _)| {
            !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b"_-:".contains(&b))
        });
        let Some((name, value)) = variable else {
            // Indented lines speak of the parts of a composite picture.
            if !text.starts_with([' ', '\t', '#']) {
                history.push(text.to_owned());
            }
            return Ok(());
        };
        let value = value.trim();
        let wrong = |expected: &str| {
            let (found, field) = (format!("`{value}`"), name.to_owned());
            let column = name.len() as u64 + 2;
            Error::at(number, column, ErrorKind::Value { found, field, expected: expected.to_owned() })
        };
        let numbers = || -> Option<Vec<f64>> { value.split_whitespace().map(|v| v.parse().ok()).collect() };
        let positive = |values: &[f64]| values.iter().all(|v| *v > 0.0 && v.is_finite());
        match name {
            "FORMAT" => {
                self.pixels = match value {
                    "32-bit_rle_rgbe" => Pixels::Rgbe,
                    "32-bit_rle_xyze" => Pixels::Xyze,
                    _ => return Err(wrong("32-bit_rle_rgbe or 32-bit_rle_xyze")),
                }
            }
            "EXPOSURE" | "PIXASPECT" => match numbers().as_deref() {
                Some([one]) if positive(&[*one]) => {
                    *(if name == "EXPOSURE" { &mut self.exposure } else { &mut self.pixel_aspect }) *= one;
                }
                _ => return Err(wrong("a positive number")),
            },
            "COLORCORR" => match numbers().as_deref() {
                Some(three) if three.len() == 3 && positive(three) => {
                    self.correction.iter_mut().zip(three).for_each(|(c, v)| *c *= v);
                }
                _ => return Err(wrong("three positive numbers")),
            },
            "PRIMARIES" => match numbers().as_deref() {
                Some([rx, ry, gx, gy, bx, by, wx, wy]) => {
                    let space = Space::of([[*rx, *ry], [*gx, *gy], [*bx, *by]], [*wx, *wy]);
                    if space.to_xyz().is_some() {
                        self.space = space;
                    } else {
                        let message = format!("PRIMARIES `{value}` span no colours; Radiance's own taken");
                        findings.push(Finding::warning("I110", message).at(Location::line(number)));
                    }
                }
                _ => return Err(wrong("eight numbers: x y of red, green, blue and white")),
            },
            _ => {
                self.attributes.retain(|(n, _)| n != name);
                self.attributes.push((name.to_owned(), value.to_owned()));
            }
        }
        Ok(())
    }

    /// The line of the size: the axis that changes slowest comes first.
    fn read_size(&mut self, text: &str, number: u64) -> Result<(), Error> {
        let wrong = |expected: &str| {
            let (found, field) = (format!("`{}`", text.trim()), "the size".to_owned());
            Error::new(Location::line(number), ErrorKind::Value { found, field, expected: expected.to_owned() })
        };
        let shape = || wrong("a line such as -Y 512 +X 768");
        let words: Vec<&str> = text.split_whitespace().collect();
        let [first, slow, second, fast] = words.as_slice() else { return Err(shape()) };
        let axes = [first, second].map(|axis| match *axis {
            "+X" => Some((true, false)),
            "-X" => Some((true, true)),
            "+Y" => Some((false, true)),
            "-Y" => Some((false, false)),
            _ => None,
        });
        let [Some((slow_is_x, slow_reversed)), Some((fast_is_x, fast_reversed))] = axes else { return Err(shape()) };
        if slow_is_x == fast_is_x {
            return Err(shape());
        }
        let edge = |word: &str| {
            let edge = word.parse::<u64>().ok().filter(|n| (1..=LONGEST_EDGE).contains(n));
            edge.and_then(|n| usize::try_from(n).ok()).ok_or_else(|| wrong("edges of 1 to 16777216 pixels"))
        };
        let (slow, fast) = (edge(slow)?, edge(fast)?);
        (self.width, self.height) = if slow_is_x { (slow, fast) } else { (fast, slow) };
        let (from_right, from_bottom) =
            if slow_is_x { (slow_reversed, fast_reversed) } else { (fast_reversed, slow_reversed) };
        self.orientation = Orientation { columns: slow_is_x, from_right, from_bottom };
        Ok(())
    }

    /// Number of scan lines, and pixels in each.
    #[must_use]
    pub fn lines(&self) -> (usize, usize) {
        if self.orientation.columns { (self.width, self.height) } else { (self.height, self.width) }
    }

    /// What a stored value is multiplied by, by component.
    #[must_use]
    pub fn factors(&self) -> [f64; 3] {
        self.correction.map(|c| 1.0 / (self.exposure * c))
    }
}
