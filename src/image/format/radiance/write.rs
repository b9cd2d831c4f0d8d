//! Writing Radiance pictures.

use std::io::Write;

use super::LUMENS_PER_WATT;
use super::header::Pixels;
use super::scan::{self, Pixel};
use crate::colorimetry::rgb::{RADIANCE, Space};
use crate::finding::Finding;
use crate::image::description::{Description, Meaning};
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{Region, Source, rows_at_once};

/// What goes into the three components.
struct Planes {
    /// Channels of the image.
    channels: [usize; 3],
    pixels: Pixels,
    /// What the samples are multiplied by already, seen from Radiance's units; `None` where their unit is not known.
    exposure: Option<f64>,
    /// The space of RGB.
    space: Option<Space>,
}

impl Planes {
    fn of(description: &Description) -> Result<Self, Error> {
        let three = |meaning: fn(u8) -> Meaning| {
            let [a, b, c] = [0, 1, 2].map(|k| description.find(meaning(k)));
            Some([a?, b?, c?])
        };
        let white = description.rgb.as_ref().and_then(|rgb| rgb.white_luminance);
        let unit = |channel: usize| match description.channels[channel].unit.as_str() {
            "" => white,
            _ => Some(1.0),
        };
        if let Some(channels) = three(Meaning::Tristimulus) {
            let exposure = unit(channels[1]).map(|unit| 1.0 / unit);
            return Ok(Self { channels, pixels: Pixels::Xyze, exposure, space: None });
        }
        if let (Some(channels), Some(rgb)) = (three(Meaning::Primary), &description.rgb) {
            if rgb.encoded {
                let found = format!("encoded {}", rgb.space.name);
                return Err(
                    ErrorKind::Unsupported { found, expected: "linear RGB for a Radiance picture".to_owned() }.into()
                );
            }
            let exposure = white.map(|white| LUMENS_PER_WATT / white);
            return Ok(Self { channels, pixels: Pixels::Rgbe, exposure, space: Some(rgb.space) });
        }
        if let Some(channel) = description.find(Meaning::Photopic) {
            let exposure = unit(channel).map(|unit| LUMENS_PER_WATT / unit);
            return Ok(Self { channels: [channel; 3], pixels: Pixels::Rgbe, exposure, space: None });
        }
        let found = description.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
        let expected = "RGB, XYZ or luminance for a Radiance picture".to_owned();
        Err(ErrorKind::Unsupported { found: format!("channels {found}"), expected }.into())
    }
}

/// Writes an image of RGB, XYZ or luminance (as grey RGB). The samples are stored as they are, with the `EXPOSURE` by which
/// Radiance finds its own units: what is divided by it is W/(m²·sr) of RGB, and 179 times that in cd/m², or XYZ in cd/m².
///
/// Negative samples and NaN become 0, what is too large is cut, and findings say how often.
///
/// # Errors
/// Those of the source and of the writer; where the image has neither of the three, or RGB that is encoded.
pub fn write<W: Write>(mut out: W, source: &mut dyn Source) -> Result<Vec<Finding>, Error> {
    let description = source.description().clone();
    let planes = Planes::of(&description)?;
    out.write_all(header_text(&description, &planes).as_bytes())?;
    let width = description.width;
    let rows = rows_at_once(width, 3, source.block().1);
    let (mut samples, mut line, mut bytes) = (Vec::new(), Vec::with_capacity(width), Vec::new());
    let mut lost = Lost::default();
    for y in (0..description.height).step_by(rows) {
        let rows = rows.min(description.height - y);
        samples.resize(rows * width * 3, 0.0);
        source.read(Region::rows(&description, y, rows), &planes.channels, &mut samples)?;
        for row in samples.chunks_exact(3 * width) {
            line.clear();
            line.extend((0..width).map(|x| lost.pixel([row[x], row[width + x], row[2 * width + x]])));
            bytes.clear();
            scan::write(&line, &mut bytes);
            out.write_all(&bytes)?;
        }
    }
    out.flush()?;
    let mut findings = lost.findings();
    if planes.exposure.is_none() {
        let message = "the luminance of white is not known: Radiance will take 1 as 179 cd/m²";
        findings.push(Finding::warning("I113", message).hint("say --white-luminance"));
    }
    Ok(findings)
}

fn header_text(description: &Description, planes: &Planes) -> String {
    let mut out = format!("#?RADIANCE\nSOFTWARE= photopic {}\n", env!("CARGO_PKG_VERSION"));
    let one_line = |text: &str| text.replace(['\n', '\r'], " ");
    let kept = |name: &str| name.starts_with("photopic:") || ["VIEW", "CAPDATE"].contains(&name);
    for (name, value) in description.attributes.iter().filter(|(name, _)| kept(name)) {
        out.push_str(&format!("{}={}\n", one_line(name).replace('=', " "), one_line(value)));
    }
    if let Some(space) = planes.space.filter(|s| s.primaries != RADIANCE.primaries || s.white != RADIANCE.white) {
        let numbers = space.primaries.as_flattened().iter().chain(&space.white).map(|v| format!("{v:.5}"));
        out.push_str(&format!("PRIMARIES= {}\n", numbers.collect::<Vec<_>>().join(" ")));
    }
    if let Some(exposure) = planes.exposure.filter(|e| *e != 1.0) {
        out.push_str(&format!("EXPOSURE={exposure:e}\n"));
    }
    out.push_str(match planes.pixels {
        Pixels::Rgbe => "FORMAT=32-bit_rle_rgbe\n\n",
        Pixels::Xyze => "FORMAT=32-bit_rle_xyze\n\n",
    });
    out.push_str(&format!("-Y {} +X {}\n", description.height, description.width));
    out
}

/// Samples that the format cannot hold.
#[derive(Debug, Clone, Copy, Default)]
struct Lost {
    negative: u64,
    not_a_number: u64,
    large: u64,
}

impl Lost {
    fn pixel(&mut self, samples: [f32; 3]) -> Pixel {
        let values = samples.map(|v| {
            self.negative += u64::from(v < 0.0);
            self.not_a_number += u64::from(v.is_nan());
            f64::from(v).max(0.0)
        });
        scan::pixel(values).unwrap_or_else(|| {
            self.large += 1;
            let largest = scan::LARGEST.next_down();
            scan::pixel(values.map(|v| v.min(largest))).unwrap_or_default()
        })
    }

    fn findings(self) -> Vec<Finding> {
        let mut out = Vec::new();
        if self.negative > 0 {
            let message = format!("{} negative samples became 0: Radiance pictures have none", self.negative);
            out.push(Finding::warning("I120", message).hint("--to xyz has none"));
        }
        if self.not_a_number > 0 {
            let message = format!("{} samples that are not a number became 0", self.not_a_number);
            out.push(Finding::warning("I020", message));
        }
        if self.large > 0 {
            let message = format!("{} pixels exceed the largest exponent and were cut", self.large);
            out.push(Finding::warning("I020", message));
        }
        out
    }
}
