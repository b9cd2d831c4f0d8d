//! Writing OpenEXR files: one part, scan lines, ZIP of 16 lines.

use std::collections::BTreeMap;
use std::io::{Seek, SeekFrom, Write};

use ::exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{
    self, AttributeValue, ChannelDescription, Chromaticities, IntegerBounds, LineOrder, SampleType, Text,
};
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, Requirements, magic_number};
use ::exr::prelude::{Compression, f16};
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use super::name::{Name, channel_name};
use super::refused;
use crate::finding::Finding;
use crate::image::description::{Content, Description, Meaning};
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{Region, Source, rows_at_once};
use crate::spectrum::{Per, Quantity};

/// Lines compressed together.
const LINES: usize = 16;
/// How hard the deflating tries, of 1 to 9: higher levels gain less than half a per cent on pictures with noise and take up to twice as long.
const LEVEL: u32 = 2;
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
/// what is too large becomes the largest one, and a finding says how often. The same image gives the same bytes.
///
/// # Errors
/// Those of the source and of the writer; where two channels have one name.
pub fn write<W: Write + Seek>(mut out: W, source: &mut dyn Source, depth: Depth) -> Result<Vec<Finding>, Error> {
    let description = source.description().clone();
    let mut channels = names(&description)?;
    // OpenEXR stores channels by ascending name.
    channels.sort_by(|a, b| a.name.cmp(&b.name));
    let header = header(&description, &channels, depth);
    let start = out.stream_position()?;
    out.write_all(&head(&header, &attributes(&description))?)?;
    let table = out.stream_position()?;
    let mut offsets = vec![0_u64; header.chunk_count];
    out.write_all(&vec![0; 8 * offsets.len()])?;
    let mut lost = Lost::default();
    let rows = rows_at_once(description.width, channels.len(), LINES.max(source.block().1)).max(LINES) / LINES * LINES;
    let mut pixels = Pixels { source, description: &description, channels: &channels, depth };
    for y in (0..description.height).step_by(rows) {
        let chunks = pixels.chunks(y, rows.min(description.height - y))?;
        for ((chunk, group), offset) in chunks.into_iter().zip(&mut offsets[y / LINES..]) {
            lost.add(group);
            *offset = out.stream_position()? - start;
            chunk.write(&mut out, 1).map_err(refused)?;
        }
    }
    out.seek(SeekFrom::Start(table))?;
    offsets.iter().try_for_each(|offset| out.write_all(&offset.to_le_bytes()))?;
    out.flush()?;
    Ok(lost.findings())
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

/// What the blocks need to know of the file.
fn header(description: &Description, channels: &[Written], depth: Depth) -> Header {
    let sample = match depth {
        Depth::Float => SampleType::F32,
        Depth::Half => SampleType::F16,
    };
    let list = channels.iter().map(|c| ChannelDescription::named(text(&c.name), sample)).collect();
    let header = Header::new(Text::default(), Vec2(description.width, description.height), list);
    header.with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
}

/// Names of the standard's attributes that are no text.
const STANDARD: [&str; 38] = [
    "adoptedNeutral",
    "altitude",
    "aperture",
    "channels",
    "chromaticities",
    "chunkCount",
    "compression",
    "dataWindow",
    "deepImageState",
    "displayWindow",
    "dwaCompressionLevel",
    "envmap",
    "expTime",
    "far",
    "fieldOfViewHorizontal",
    "fieldOfViewVertical",
    "focus",
    "framesPerSecond",
    "isoSpeed",
    "keyCode",
    "latitude",
    "lineOrder",
    "longitude",
    "maxSamplesPerPixel",
    "multiView",
    "near",
    "originalDataWindow",
    "pixelAspectRatio",
    "preview",
    "screenWindowCenter",
    "screenWindowWidth",
    "tiles",
    "timeCode",
    "utcOffset",
    "version",
    "whiteLuminance",
    "worldToCamera",
    "worldToNDC",
];
/// The longest name of an attribute.
const LONGEST_NAME: usize = 255;
/// The longest one without a mark in the file's version.
const LONGEST_PLAIN_NAME: usize = 31;

/// The attributes of the image, by name.
fn attributes(description: &Description) -> BTreeMap<String, AttributeValue> {
    let mut out = BTreeMap::new();
    let string = |value: &str| AttributeValue::Text(text(value));
    for (name, value) in &description.attributes {
        // A field of another format must not stand in the place of an attribute of another type.
        let taken = STANDARD.contains(&name.as_str()) || ["name", "type"].contains(&name.as_str());
        let name = if taken { format!("field {name}") } else { name.clone() };
        if !name.is_empty() && name.len() <= LONGEST_NAME {
            out.insert(name, string(value));
        }
    }
    let mut set = |name: &str, value: AttributeValue| out.insert(name.to_owned(), value);
    set("software", string(concat!("photopic ", env!("CARGO_PKG_VERSION"))));
    if description.content != Content::Planes {
        set("spectralLayoutVersion", string("1.0"));
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
            let band = unit.per == Per::Band;
            set("emissiveUnits", string(layout));
            set("photopic:samples_unit", string(&if band { ours.replace("/nm", "/band") } else { ours.to_owned() }));
        }
    }
    let plain = |m: Meaning| matches!(m, Meaning::Photopic | Meaning::Weighted | Meaning::Tristimulus(_));
    let unit = description.channels.iter().find(|c| plain(c.meaning) && !c.unit.is_empty());
    if let Some(channel) = unit {
        set("photopic:unit", string(&channel.unit));
    }
    if let Some(rgb) = &description.rgb {
        let [red, green, blue] = rgb.space.primaries.map(pair);
        let white = pair(rgb.space.white);
        set("chromaticities", AttributeValue::Chromaticities(Chromaticities { red, green, blue, white }));
        if let Some(luminance) = rgb.white_luminance {
            set("whiteLuminance", AttributeValue::F32(narrow(luminance)));
        }
    }
    out
}

/// The bytes before the table of offsets: the crate `exr` would write attributes in another order each time.
fn head(header: &Header, attributes: &BTreeMap<String, AttributeValue>) -> Result<Vec<u8>, Error> {
    let window = AttributeValue::IntegerBounds(IntegerBounds::from_dimensions(header.layer_size));
    let required = [
        ("channels", AttributeValue::ChannelList(header.channels.clone())),
        ("compression", AttributeValue::Compression(header.compression)),
        ("dataWindow", window.clone()),
        ("displayWindow", window),
        ("lineOrder", AttributeValue::LineOrder(header.line_order)),
        ("pixelAspectRatio", AttributeValue::F32(1.0)),
        ("screenWindowCenter", AttributeValue::FloatVec2(Vec2(0.0, 0.0))),
        ("screenWindowWidth", AttributeValue::F32(1.0)),
    ];
    let required = required.into_iter().map(|(name, value)| (name.to_owned(), value));
    let all: BTreeMap<String, AttributeValue> = attributes.clone().into_iter().chain(required).collect();
    let channels = header.channels.list.iter().map(|c| c.name.to_string());
    let long = all.keys().cloned().chain(channels).any(|name| name.len() > LONGEST_PLAIN_NAME);
    let mut out = Vec::new();
    magic_number::write(&mut out).map_err(refused)?;
    let requirements = Requirements {
        file_format_version: 2,
        is_single_layer_and_tiled: false,
        has_long_names: long,
        has_deep_data: false,
        has_multiple_layers: false,
    };
    requirements.write(&mut out).map_err(refused)?;
    for (name, value) in &all {
        attribute::write(text(name).as_slice(), value, &mut out).map_err(refused)?;
    }
    out.push(0);
    Ok(out)
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
    /// The chunks of rows from `y`, of [`LINES`] lines each, and what was lost in each.
    fn chunks(&mut self, y: usize, rows: usize) -> Result<Vec<(Chunk, Lost)>, Error> {
        let width = self.description.width;
        let numbers: Vec<usize> = self.channels.iter().map(|c| c.number).collect();
        let mut samples = vec![0.0; rows * width * numbers.len()];
        self.source.read(Region::rows(self.description, y, rows), &numbers, &mut samples)?;
        let line = width * numbers.len();
        let (channels, depth) = (self.channels, self.depth);
        (samples.par_chunks(LINES * line).enumerate())
            .map(|(k, samples)| {
                let (data, lost) = bytes(samples, width, channels, depth);
                let line = y + k * LINES;
                let y_coordinate = i32::try_from(line).map_err(|_| ErrorKind::Unexpected {
                    found: format!("line {line}"),
                    expected: format!("at most {} lines", i32::MAX),
                })?;
                let block = CompressedScanLineBlock { y_coordinate, compressed_pixels_le: zip(data) };
                Ok((Chunk { layer_index: 0, compressed_block: CompressedBlock::ScanLine(block) }, lost))
            })
            .collect()
    }
}

/// Packed as the format's ZIP has it (OpenEXR's own ImfZip.cpp, as the crate `exr` reads it): the bytes at even places, then those at odd ones, each less the one before it, deflated; as they are where that is
/// not less. (The crate can write it too, with a compressor that takes twice as long for the same size.)
fn zip(data: Vec<u8>) -> Vec<u8> {
    let (even, odd) = (data.iter().step_by(2), data.iter().skip(1).step_by(2));
    let mut last = 128;
    let differences: Vec<u8> =
        even.chain(odd).map(|b| b.wrapping_sub(std::mem::replace(&mut last, *b)).wrapping_add(128)).collect();
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(data.len()), flate2::Compression::new(LEVEL));
    let packed = encoder.write_all(&differences).and_then(|()| encoder.finish());
    packed.ok().filter(|packed| packed.len() < data.len()).unwrap_or(data)
}

/// Little-endian bytes of whole lines.
#[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
fn bytes(samples: &[f32], width: usize, channels: &[Written], depth: Depth) -> (Vec<u8>, Lost) {
    let mut out = Vec::with_capacity(samples.len() * 4);
    let mut lost = Lost::default();
    for (plane, channel) in samples.chunks_exact(width).zip(channels.iter().cycle()) {
        let scaled =
            plane.iter().map(|v| if channel.factor == 1.0 { *v } else { (f64::from(*v) * channel.factor) as f32 });
        match depth {
            Depth::Float => scaled.for_each(|v| out.extend(v.to_le_bytes())),
            Depth::Half => scaled.for_each(|v| {
                let held = if v.is_finite() { v.clamp(-LARGEST_HALF, LARGEST_HALF) } else { v };
                if held != v && !v.is_nan() {
                    lost.large += 1;
                    lost.largest = lost.largest.max(v.abs());
                }
                lost.small += u64::from(v != 0.0 && v.abs() < SMALLEST_HALF);
                out.extend(f16::from_f32(held).to_le_bytes());
            }),
        }
    }
    (out, lost)
}
