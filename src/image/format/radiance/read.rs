//! Reading Radiance pictures by rows.

use std::io::{BufReader, Read, Seek, SeekFrom};

use super::LUMENS_PER_WATT;
use super::header::{Header, Pixels, parse_header};
use super::scan::{self, Pixel};
use crate::finding::{Checked, Finding};
use crate::image::description::{Channel, Description, Meaning, RgbSpace};
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{self, Region, Source};

/// Bytes in which the header is looked for.
const HEADER: u64 = 1 << 21;

/// A Radiance picture being read.
pub struct Radiance<R> {
    input: BufReader<R>,
    header: Header,
    description: Description,
    /// Where each scan line begins.
    offsets: Vec<u64>,
    /// Room for one line: its pixels, its components, its values.
    line: Vec<Pixel>,
    planes: Vec<u8>,
    values: Vec<[f32; 3]>,
}

/// Opens a picture: reads its header and finds all of its scan lines.
///
/// # Errors
/// Those of [`parse_header`]; where the scan lines are damaged or the file is cut off.
pub fn open<R: Read + Seek + Send>(mut input: R) -> Result<Checked<Radiance<R>>, Error> {
    let size = input.seek(SeekFrom::End(0))?;
    input.seek(SeekFrom::Start(0))?;
    let mut start = Vec::new();
    input.by_ref().take(HEADER).read_to_end(&mut start)?;
    let Checked { value: header, mut findings } = parse_header(&start)?;
    let (lines, length) = header.lines();
    // A scan line takes four bytes at least.
    let least = (lines as u64).saturating_mul(4).saturating_add(header.length as u64);
    if size < least {
        return Err(ErrorKind::CutOff { found: size, expected: least }.into());
    }
    let mut input = BufReader::with_capacity(1 << 18, input);
    let mut at = input.seek(SeekFrom::Start(header.length as u64))?;
    let mut offsets = Vec::with_capacity(lines);
    let (mut line, mut planes) = (vec![[0; 4]; length], Vec::new());
    for number in 0..lines {
        offsets.push(at);
        at += scan::read(&mut input, number, &mut line, &mut planes)?;
    }
    if at < size {
        let message = format!("{} bytes follow the image and were not read", size - at);
        findings.push(Finding::warning("I002", message));
    }
    let description = describe(&header, &mut findings);
    let value = Radiance { input, header, description, offsets, line, planes, values: Vec::new() };
    Ok(Checked { value, findings })
}

fn describe(header: &Header, findings: &mut Vec<Finding>) -> Description {
    let names = match header.pixels {
        Pixels::Rgbe => ["R", "G", "B"],
        Pixels::Xyze => ["X", "Y", "Z"],
    };
    let channels = (0..).zip(names).map(|(k, name)| match header.pixels {
        Pixels::Rgbe => Channel::new(name, "", Meaning::Primary(k)),
        Pixels::Xyze => Channel::new(name, "cd/m²", Meaning::Tristimulus(k)),
    });
    let mut out = Description::planes(header.width, header.height, channels.collect());
    if header.pixels == Pixels::Rgbe {
        out.rgb = Some(RgbSpace { space: header.space, encoded: false, white_luminance: Some(LUMENS_PER_WATT) });
        let message = format!("(1, 1, 1) is taken as {LUMENS_PER_WATT} cd/m², Radiance's convention");
        findings.push(Finding::info("I111", message));
    }
    out.attributes.clone_from(&header.attributes);
    // What has been applied is told under another name: another reader must not apply it again.
    if header.exposure != 1.0 {
        out.set_attribute("radiance:exposure", header.exposure.to_string());
    }
    if header.correction != [1.0; 3] {
        let [r, g, b] = header.correction;
        out.set_attribute("radiance:colorcorr", format!("{r} {g} {b}"));
    }
    if (header.pixel_aspect - 1.0).abs() > 1e-3 {
        out.set_attribute("radiance:pixaspect", header.pixel_aspect.to_string());
        let message = format!("pixels are {} times as high as wide; they are not resampled", header.pixel_aspect);
        findings.push(Finding::info("I112", message));
    }
    out
}

impl<R: Read + Seek + Send> Radiance<R> {
    /// Reads a scan line into `self.values`.
    fn read_line(&mut self, number: usize) -> Result<(), Error> {
        let place = self.offsets[number];
        let here = self.input.stream_position()?;
        // Lines in order are read on from the buffer.
        self.input.seek_relative(place.cast_signed() - here.cast_signed())?;
        scan::read(&mut self.input, number, &mut self.line, &mut self.planes)?;
        let factors = self.header.factors();
        self.values.clear();
        self.values.extend(self.line.iter().map(|pixel| narrow(scan::value(*pixel), factors)));
        Ok(())
    }
}

#[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
fn narrow(values: [f64; 3], factors: [f64; 3]) -> [f32; 3] {
    [0, 1, 2].map(|k| (values[k] * factors[k]) as f32)
}

impl<R: Read + Seek + Send> Source for Radiance<R> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn block(&self) -> (usize, usize) {
        let (width, height) = (self.header.width, self.header.height);
        if self.header.orientation.columns { (1, height) } else { (width, 1) }
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        let (width, height) = (self.header.width, self.header.height);
        let orientation = self.header.orientation;
        let column = |x: usize| if orientation.from_right { width - 1 - x } else { x };
        let row = |y: usize| if orientation.from_bottom { height - 1 - y } else { y };
        let count = channels.len();
        // Scan lines in the order of the file, wherever they go.
        let (first, lines) = if orientation.columns { (region.x, region.width) } else { (region.y, region.height) };
        let backwards = if orientation.columns { orientation.from_right } else { orientation.from_bottom };
        for step in 0..lines {
            let place = if backwards { first + lines - 1 - step } else { first + step };
            self.read_line(if orientation.columns { column(place) } else { row(place) })?;
            for (k, channel) in channels.iter().enumerate() {
                if orientation.columns {
                    for y in 0..region.height {
                        let value = self.values[row(region.y + y)][*channel];
                        out[(y * count + k) * region.width + place - region.x] = value;
                    }
                } else {
                    let start = ((place - region.y) * count + k) * region.width;
                    for (x, out) in out[start..start + region.width].iter_mut().enumerate() {
                        *out = self.values[column(region.x + x)][*channel];
                    }
                }
            }
        }
        Ok(())
    }
}
