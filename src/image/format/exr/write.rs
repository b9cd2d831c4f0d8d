//! Writing OpenEXR files: one part, scan lines, ZIP of 16 lines.

use std::io::{Seek, Write};

use ::exr::block::writer::{ChunksWriter, write_chunks_with};
use ::exr::block::{BlockIndex, UncompressedBlock};
use ::exr::math::Vec2;
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::{
    AttributeValue, ChannelDescription, ChannelList, Chromaticities, LineOrder, SampleType, Text,
};
use ::exr::meta::header::Header;
use ::exr::prelude::{Compression, f16};
use rayon::prelude::*;

use super::name::{Name, channel_name};
use super::refused;
use crate::finding::Finding;
use crate::image::description::{Content, Description, Meaning};
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{Region, Source, rows_at_once};
use crate::spectrum::Quantity;

/// Lines compressed together.
const LINES: usize = 16;
/// The largest half-float, and half of the smallest one above zero.
const LARGEST_HALF: f32 = 65504.0;
const SMALLEST_HALF: f32 = 2.980_232_2e-8;

/// How samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Depth {
    /// 32-bit float. The default: nothing is lost.
    #[default]
    Float,
    /// 16-bit float: 3 significant digits, up to 65504.
    Half,
}

/// Writes an image. Bands of light are written in SI per nm, whatever unit the image has; half-floats never become infinite:
/// what is too large becomes the largest one, and a finding says how often.
///
/// # Errors
/// Those of the source and of the writer; where two channels have one name.
pub fn write<W: Write + Seek>(out: W, source: &mut dyn Source, depth: Depth) -> Result<Vec<Finding>, Error> {
    let description = source.description().clone();
    let mut channels = names(&description)?;
    // OpenEXR stores channels by ascending name.
    channels.sort_by(|a, b| a.name.cmp(&b.name));
    let header = header(&description, &channels, depth)?;
    let mut lost = Lost::default();
    // The closure may only return the crate's errors; ours waits here.
    let mut failed = None;
    let written = write_chunks_with(out, [header].into_iter().collect(), false, |meta, chunks| {
        let mut pixels = Pixels { source, description: &description, channels: &channels, depth };
        let rows = rows_at_once(description.width, channels.len(), LINES.max(pixels.source.block().1)).max(LINES);
        let rows = rows / LINES * LINES;
        for y in (0..description.height).step_by(rows) {
            let rows = rows.min(description.height - y);
            let (blocks, group) = match pixels.blocks(y, rows) {
                Ok(done) => done,
                Err(error) => {
                    failed = Some(error);
                    return Err(::exr::error::Error::Aborted);
                }
            };
            lost.add(group);
            let packed: Result<Vec<_>, _> =
                blocks.into_par_iter().map(|b| b.compress_to_chunk(&meta.headers)).collect();
            for (k, chunk) in packed?.into_iter().enumerate() {
                chunks.write_chunk(y / LINES + k, chunk)?;
            }
        }
        Ok(())
    });
    match (failed, written) {
        (Some(error), _) => Err(error),
        (None, Err(error)) => Err(refused(error)),
        (None, Ok(())) => Ok(lost.findings()),
    }
}

/// A channel to be written.
struct Written {
    name: String,
    /// Its number in the source.
    number: usize,
    /// What its samples are multiplied by.
    factor: f64,
}

fn names(description: &Description) -> Result<Vec<Written>, Error> {
    let unit = match &description.content {
        Content::Light { unit, .. } => unit.as_ref(),
        Content::Reflectance | Content::Planes => None,
    };
    let light = matches!(description.content, Content::Light { .. });
    let mut out: Vec<Written> = Vec::with_capacity(description.channels.len());
    for (number, channel) in description.channels.iter().enumerate() {
        let si = |wavelength_nm| unit.map_or(1.0, |u| u.to_si(wavelength_nm, 1.0));
        let (name, factor) = match channel.meaning {
            Meaning::Band { wavelength_nm, .. } if light => {
                (channel_name(Name::Light(0, wavelength_nm)), si(wavelength_nm))
            }
            Meaning::Band { wavelength_nm, .. } => (channel_name(Name::Reflectance(wavelength_nm)), 1.0),
            Meaning::Stokes { component, wavelength_nm } => {
                (channel_name(Name::Light(component, wavelength_nm)), si(wavelength_nm))
            }
            _ => (channel.name.clone(), 1.0),
        };
        if let Some(other) = out.iter().find(|w| w.name == name) {
            let found = format!("the name {name} for channels {} and {}", other.number + 1, number + 1);
            return Err(
                ErrorKind::Unexpected { found, expected: "a name of its own for each channel".to_owned() }.into()
            );
        }
        out.push(Written { name, number, factor });
    }
    Ok(out)
}

fn text(string: &str) -> Text {
    // OpenEXR's text is bytes; what is not Latin-1 is spelt out.
    let plain: String = string.replace('²', "2").replace('·', " ").replace('–', "-");
    Text::new_or_none(&plain).unwrap_or_else(|| Text::new_or_panic(plain.escape_default().to_string()))
}

fn header(description: &Description, channels: &[Written], depth: Depth) -> Result<Header, Error> {
    let sample = match depth {
        Depth::Float => SampleType::F32,
        Depth::Half => SampleType::F16,
    };
    let list = channels.iter().map(|c| ChannelDescription::named(text(&c.name), sample)).collect();
    let size = Vec2(description.width, description.height);
    let mut header = Header::new(Text::default(), size, list);
    header.own_attributes.layer_name = None;
    header.channels = ChannelList::new(header.channels.list);
    let mut header = header.with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing);
    let own = &mut header.own_attributes;
    own.software_name = Some(text(concat!("photopic ", env!("CARGO_PKG_VERSION"))));
    for (name, value) in &description.attributes {
        own.other.insert(text(name), AttributeValue::Text(text(value)));
    }
    let mut set = |name: &str, value: &str| {
        own.other.insert(text(name), AttributeValue::Text(text(value)));
    };
    if description.content != Content::Planes {
        set("spectralLayoutVersion", "1.0");
    }
    if let Content::Light { quantity, unit: Some(unit) } = &description.content {
        let (layout, ours) = match quantity.unwrap_or(unit.quantity) {
            Quantity::Radiance => ("W.m^-2.sr^-1", "W/m2/sr/nm"),
            Quantity::Irradiance | Quantity::Exitance => ("W.m^-2", "W/m2/nm"),
            Quantity::Flux => ("W", "W/nm"),
            Quantity::Intensity => ("W.sr^-1", "W/sr/nm"),
            Quantity::Energy => ("J", "J/nm"),
            Quantity::Exposure => ("J.m^-2", "J/m2/nm"),
            Quantity::Relative => ("", ""),
        };
        if !layout.is_empty() {
            set("emissiveUnits", layout);
            let ours =
                if unit.per == crate::spectrum::Per::Band { ours.replace("/nm", "/band") } else { ours.to_owned() };
            set("photopic:samples_unit", &ours);
        }
    }
    let unit = description.channels.iter().map(|c| (c.meaning, &c.unit));
    let plain = |m: Meaning| matches!(m, Meaning::Photopic | Meaning::Weighted | Meaning::Tristimulus(_));
    if let Some((_, unit)) = unit.into_iter().find(|(m, unit)| plain(*m) && !unit.is_empty()) {
        set("photopic:unit", unit);
    }
    if let Some(rgb) = &description.rgb {
        let [red, green, blue] = rgb.space.primaries.map(pair);
        let white = pair(rgb.space.white);
        header.shared_attributes.chromaticities = Some(Chromaticities { red, green, blue, white });
        header.own_attributes.white_luminance = rgb.white_luminance.map(narrow);
    }
    Ok(header)
}

fn pair([x, y]: [f64; 2]) -> Vec2<f32> {
    Vec2(narrow(x), narrow(y))
}

#[expect(clippy::cast_possible_truncation, reason = "the format's attributes are f32")]
fn narrow(value: f64) -> f32 {
    value as f32
}

/// Samples that half-floats could not hold.
#[derive(Debug, Clone, Copy, Default)]
struct Lost {
    large: u64,
    small: u64,
    largest: f32,
}

impl Lost {
    fn add(&mut self, other: Self) {
        self.large += other.large;
        self.small += other.small;
        self.largest = self.largest.max(other.largest);
    }

    fn findings(self) -> Vec<Finding> {
        let mut out = Vec::new();
        let hint = "write 32-bit floats (leave out --half)";
        if self.large > 0 {
            let message = format!(
                "{} samples up to {:e} exceed the largest half-float and were written as 65504",
                self.large, self.largest
            );
            out.push(Finding::warning("I020", message).hint(hint));
        }
        if self.small > 0 {
            let message = format!("{} samples below 3e-8 became 0 as half-floats", self.small);
            out.push(Finding::warning("I021", message).hint(hint));
        }
        out
    }
}

/// The pixels on their way into blocks.
struct Pixels<'a> {
    source: &'a mut dyn Source,
    description: &'a Description,
    channels: &'a [Written],
    depth: Depth,
}

impl Pixels<'_> {
    /// The blocks of rows from `y`, of [`LINES`] lines each.
    fn blocks(&mut self, y: usize, rows: usize) -> Result<(Vec<UncompressedBlock>, Lost), Error> {
        let width = self.description.width;
        let numbers: Vec<usize> = self.channels.iter().map(|c| c.number).collect();
        let mut samples = vec![0.0; rows * width * numbers.len()];
        self.source.read(Region::rows(self.description, y, rows), &numbers, &mut samples)?;
        let line = width * numbers.len();
        let (channels, depth) = (self.channels, self.depth);
        let blocks: Vec<(UncompressedBlock, Lost)> = (samples.par_chunks(LINES * line).enumerate())
            .map(|(k, samples)| {
                let (data, lost) = bytes(samples, width, channels, depth);
                let index = BlockIndex {
                    layer: 0,
                    pixel_position: Vec2(0, y + k * LINES),
                    pixel_size: Vec2(width, samples.len() / line),
                    level: Vec2(0, 0),
                };
                (UncompressedBlock { index, data }, lost)
            })
            .collect();
        let mut total = Lost::default();
        let blocks = blocks
            .into_iter()
            .map(|(block, lost)| {
                total.add(lost);
                block
            })
            .collect();
        Ok((blocks, total))
    }
}

/// Native-endian bytes of whole lines.
#[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
fn bytes(samples: &[f32], width: usize, channels: &[Written], depth: Depth) -> (Vec<u8>, Lost) {
    let mut out = Vec::with_capacity(samples.len() * 4);
    let mut lost = Lost::default();
    for (plane, channel) in samples.chunks_exact(width).zip(channels.iter().cycle()) {
        let scaled =
            plane.iter().map(|v| if channel.factor == 1.0 { *v } else { (f64::from(*v) * channel.factor) as f32 });
        match depth {
            Depth::Float => scaled.for_each(|v| out.extend(v.to_ne_bytes())),
            Depth::Half => scaled.for_each(|v| {
                let held = if v.is_finite() { v.clamp(-LARGEST_HALF, LARGEST_HALF) } else { v };
                if held != v && !v.is_nan() {
                    lost.large += 1;
                    lost.largest = lost.largest.max(v.abs());
                }
                lost.small += u64::from(v != 0.0 && v.abs() < SMALLEST_HALF);
                out.extend(f16::from_f32(held).to_ne_bytes());
            }),
        }
    }
    (out, lost)
}
