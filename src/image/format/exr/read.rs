//! Reading OpenEXR files block by block.

use std::io::{BufReader, Read, Seek, SeekFrom};

use ::exr::block::UncompressedBlock;
use ::exr::block::chunk::Chunk;
use ::exr::math::Vec2;
use ::exr::meta::attribute::{AttributeValue, SampleType};
use ::exr::meta::header::Header;
use ::exr::meta::{BlockDescription, MetaData};
use rayon::prelude::*;

use super::name::{Name, parse_name};
use super::refused;
use crate::colorimetry::rgb::{Encoding, SPACES, SRGB, Space};
use crate::finding::{Checked, Finding};
use crate::image::description::{Channel, Content, Description, Meaning, RgbSpace};
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{self, Region, Source};
use crate::spectrum::SpectralUnit;

/// Decoded bytes that are held at a time, at most, where single blocks are not larger.
const BYTES_AT_ONCE: usize = 32 << 20;
/// The largest block that is decoded: beyond it the header is not to be believed.
const LARGEST_BLOCK: usize = 1 << 30;

/// An OpenEXR file being read.
pub struct Exr<R> {
    input: BufReader<R>,
    meta: MetaData,
    parts: Vec<Part>,
    /// Part and number in the part of each channel of the description.
    places: Vec<(usize, usize)>,
    description: Description,
    block: (usize, usize),
    /// Blocks of the last read, with part and number: the next read may want them again.
    held: Vec<(usize, usize, UncompressedBlock)>,
}

/// One part of the file.
struct Part {
    /// Where each block of the full resolution begins, by rows of blocks.
    offsets: Vec<u64>,
    /// Size of a block.
    block: (usize, usize),
    /// Blocks side by side.
    across: usize,
    /// Bytes of each channel's samples, and of those before it, per pixel of a line.
    channels: Vec<(SampleType, usize)>,
    bytes_per_pixel: usize,
}

/// Opens a file: reads its headers and checks that all of its blocks are there.
///
/// # Errors
/// Where it is no OpenEXR file, damaged or cut off, or of a kind that is not read (deep images, subsampled channels).
pub fn open<R: Read + Seek + Send>(mut input: R) -> Result<Checked<Exr<R>>, Error> {
    let length = input.seek(SeekFrom::End(0))?;
    input.seek(SeekFrom::Start(0))?;
    let mut input = BufReader::new(input);
    let meta = MetaData::read_from_buffered(&mut input, false).map_err(refused)?;
    MetaData::validate(&meta.headers, false).map_err(refused)?;
    let parts = parts(&mut input, &meta, length)?;
    let mut findings = Vec::new();
    let (description, places) = describe(&meta, &mut findings)?;
    let used = |part: usize| places.iter().any(|(p, _)| *p == part);
    let block =
        (0..parts.len()).filter(|p| used(*p)).map(|p| parts[p].block).reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)));
    let block = block.unwrap_or((description.width, 1));
    Ok(Checked { value: Exr { input, meta, parts, places, description, block, held: Vec::new() }, findings })
}

/// Reads the tables of offsets, which follow the headers, and checks that the last block lies inside the file.
fn parts<R: Read + Seek>(input: &mut BufReader<R>, meta: &MetaData, length: u64) -> Result<Vec<Part>, Error> {
    let mut parts = Vec::new();
    for header in &meta.headers {
        if header.deep || header.channels.list.iter().any(|c| c.sampling.0 != 1 || c.sampling.1 != 1) {
            let found = if header.deep { "a deep image" } else { "subsampled channels (luminance-chroma: Y, RY, BY)" };
            let found = found.to_owned();
            return Err(
                ErrorKind::Unsupported { found, expected: "a flat image with a sample per pixel".to_owned() }.into()
            );
        }
        let (width, height) = (header.layer_size.0, header.layer_size.1);
        let block = match header.blocks {
            BlockDescription::ScanLines => (width, header.compression.scan_lines_per_block()),
            BlockDescription::Tiles(tiles) => (tiles.tile_size.0, tiles.tile_size.1),
        };
        let block = (block.0.min(width), block.1.min(height));
        let bytes_per_pixel = header.channels.bytes_per_pixel;
        if block.0.saturating_mul(block.1).saturating_mul(bytes_per_pixel) > LARGEST_BLOCK {
            let found = format!("blocks of {} × {} pixels with {bytes_per_pixel} bytes each", block.0, block.1);
            return Err(ErrorKind::Unsupported { found, expected: "blocks of up to 1 GiB".to_owned() }.into());
        }
        let here = input.stream_position()?;
        let end = (header.chunk_count as u64).saturating_mul(8).saturating_add(here);
        if end > length {
            return Err(ErrorKind::CutOff { found: length, expected: end }.into());
        }
        let mut offsets = vec![0; header.chunk_count];
        for offset in &mut offsets {
            let mut bytes = [0; 8];
            input.read_exact(&mut bytes)?;
            *offset = u64::from_le_bytes(bytes);
        }
        let across = width.div_ceil(block.0);
        // The blocks of the full resolution come first, by rows.
        offsets.truncate(across * height.div_ceil(block.1));
        let mut before = 0;
        let channels = (header.channels.list.iter())
            .map(|c| {
                let place = (c.sample_type, before);
                before += c.sample_type.bytes_per_sample();
                place
            })
            .collect();
        parts.push(Part { offsets, block, across, channels, bytes_per_pixel });
    }
    for (number, part) in parts.iter().enumerate() {
        if let Some(missing) = part.offsets.iter().position(|o| *o == 0) {
            let found = format!("no block {} of {} in part {}", missing + 1, part.offsets.len(), number + 1);
            let expected = "all of them: the program that wrote the file did not finish".to_owned();
            return Err(ErrorKind::Unexpected { found, expected }.into());
        }
        let last = part.offsets.iter().copied().max().unwrap_or(0);
        // Before a block's bytes: its part where there are several, its place, and its size.
        let place = if matches!(meta.headers[number].blocks, BlockDescription::Tiles(_)) { 16 } else { 4 };
        let size_at = last.saturating_add(if meta.requirements.is_multilayer() { 4 } else { 0 } + place);
        let expected = size_at.saturating_add(4);
        if expected > length {
            return Err(ErrorKind::CutOff { found: length, expected }.into());
        }
        input.seek(SeekFrom::Start(size_at))?;
        let mut size = [0; 4];
        input.read_exact(&mut size)?;
        let expected = expected.saturating_add(u64::from(u32::from_le_bytes(size)));
        if expected > length {
            return Err(ErrorKind::CutOff { found: length, expected }.into());
        }
    }
    Ok(parts)
}

/// The image in all parts, and where its channels are.
fn describe(meta: &MetaData, findings: &mut Vec<Finding>) -> Result<(Description, Vec<(usize, usize)>), Error> {
    let names: Vec<Vec<String>> =
        meta.headers.iter().map(|h| h.channels.list.iter().map(|c| c.name.to_string()).collect()).collect();
    let spectral = |part: &Vec<String>| part.iter().any(|n| parse_name(n).is_some());
    let first = names.iter().position(spectral).unwrap_or(0);
    let window = |h: &Header| (h.own_attributes.layer_position, h.layer_size);
    let size = meta.headers[first].layer_size;
    if size.0 == 0 || size.1 == 0 {
        return Err(
            ErrorKind::Unexpected { found: "an image without pixels".to_owned(), expected: "some".to_owned() }.into()
        );
    }
    let mut description = Description::planes(size.0, size.1, Vec::new());
    description.attributes = attributes(meta, first);
    let light = names.iter().flatten().any(|n| matches!(parse_name(n), Some(Name::Light(0, _))));
    let reflectance = names.iter().flatten().any(|n| matches!(parse_name(n), Some(Name::Reflectance(_))));
    let unit = if light { unit(&description, findings) } else { None };
    let text = unit.as_ref().map_or(String::new(), |u| u.text.clone());
    let colour = |names: &[String], of: [&str; 3]| of.iter().all(|n| names.iter().any(|m| m == n));
    let mut places = Vec::new();
    let mut carried = [0_usize; 3];
    for (part, header) in meta.headers.iter().enumerate() {
        if window(header) != window(&meta.headers[first]) {
            if spectral(&names[part]) {
                let found = format!("spectral channels of another size or place in part {}", part + 1);
                return Err(
                    ErrorKind::Unsupported { found, expected: "the same data window in all parts".to_owned() }.into()
                );
            }
            let message =
                format!("part {} has another data window and no spectral channels: it was not read", part + 1);
            findings.push(Finding::info("I006", message));
            continue;
        }
        let prefix = match &header.own_attributes.layer_name {
            Some(layer) if part != first => format!("{layer}."),
            _ => String::new(),
        };
        let (rgb, xyz) = (colour(&names[part], ["R", "G", "B"]), colour(&names[part], ["X", "Y", "Z"]));
        for (number, name) in names[part].iter().enumerate() {
            let mut channel = Channel::new(format!("{prefix}{name}"), "", Meaning::Other);
            channel.meaning = match parse_name(name) {
                Some(Name::Light(0, wavelength_nm)) => {
                    channel.unit.clone_from(&text);
                    Meaning::Band { wavelength_nm, fwhm_nm: None, good: true }
                }
                Some(Name::Light(component, wavelength_nm)) => {
                    channel.unit.clone_from(&text);
                    carried[0] += 1;
                    Meaning::Stokes { component, wavelength_nm }
                }
                Some(Name::Reflectance(wavelength_nm)) if !light => {
                    Meaning::Band { wavelength_nm, fwhm_nm: None, good: true }
                }
                Some(Name::Reflectance(_)) => {
                    carried[1] += 1;
                    Meaning::Other
                }
                Some(Name::Reradiation(..)) => {
                    carried[2] += 1;
                    Meaning::Other
                }
                None => plane(name, rgb, xyz),
            };
            // Names that are unique in a part may meet those of another.
            if !description.channels.iter().any(|c| c.name == channel.name) {
                description.channels.push(channel);
                places.push((part, number));
            }
        }
    }
    for (count, what) in carried.into_iter().zip(["polarised (S1–S3)", "reflective (beside light)", "re-radiation"]) {
        if count > 0 {
            let message = format!("{count} {what} channels are carried along and take part in no integral");
            findings.push(Finding::info("I004", message));
        }
    }
    description.content = match (light, reflectance) {
        (true, _) => Content::Light { quantity: unit.as_ref().map(|u| u.quantity), unit },
        (false, true) => Content::Reflectance,
        (false, false) => Content::Planes,
    };
    if (light || reflectance) && description.attribute("spectralLayoutVersion").is_none_or(|v| v != "1.0") {
        let found = description.attribute("spectralLayoutVersion").map_or("no".to_owned(), |v| format!("`{v}` as"));
        findings.push(Finding::info("I005", format!("{found} spectralLayoutVersion; read as 1.0")));
    }
    // The writer spells out what is not Latin text.
    if let Some(unit) = description.attribute("photopic:unit").map(|unit| unit.replace("m2", "m²")) {
        let plain = |m: Meaning| matches!(m, Meaning::Photopic | Meaning::Weighted | Meaning::Tristimulus(_));
        description.channels.iter_mut().filter(|c| plain(c.meaning)).for_each(|c| c.unit.clone_from(&unit));
    }
    let colour = |c: &Channel| matches!(c.meaning, Meaning::Primary(_) | Meaning::Tristimulus(_) | Meaning::Photopic);
    let rgb = description.channels.iter().any(colour).then(|| rgb_space(meta, first, &description));
    let primaries = description.find(Meaning::Primary(0)).is_some();
    description.rgb = rgb.filter(|rgb| primaries || rgb.white_luminance.is_some());
    if primaries && meta.headers[first].shared_attributes.chromaticities.is_none() {
        let message = "no chromaticities stated; those of Rec. ITU-R BT.709 taken, as OpenEXR has it";
        findings.push(Finding::info("I102", message));
    }
    if let Err(error) = if light || reflectance { description.grid() } else { return Ok((description, places)) } {
        return Err(ErrorKind::from(error).into());
    }
    Ok((description, places))
}

/// The meaning of a channel that is not spectral.
fn plane(name: &str, rgb: bool, xyz: bool) -> Meaning {
    match name {
        "R" if rgb => Meaning::Primary(0),
        "G" if rgb => Meaning::Primary(1),
        "B" if rgb => Meaning::Primary(2),
        "X" if xyz => Meaning::Tristimulus(0),
        "Y" if xyz => Meaning::Tristimulus(1),
        "Z" if xyz => Meaning::Tristimulus(2),
        // Beside R, G, B nobody says what a Y is; their luminance comes from them.
        "Y" if !rgb => Meaning::Photopic,
        "A" => Meaning::Alpha,
        _ => Meaning::Other,
    }
}

/// The unit of light that the file states: ours where it is there, else the layout's, per nanometre.
fn unit(description: &Description, findings: &mut Vec<Finding>) -> Option<SpectralUnit> {
    if let Some(unit) = description.attribute("photopic:samples_unit").and_then(|u| u.parse().ok()) {
        return Some(unit);
    }
    let stated = description.attribute("emissiveUnits")?;
    // ART and colour-science write full stops between units.
    let plain = stated.replace('.', " ");
    let per_nm = format!("{plain} nm^-1");
    match plain.parse::<SpectralUnit>() {
        Ok(unit) if unit.per == crate::spectrum::Per::Wavelength => Some(unit),
        Ok(_) => {
            let message =
                format!("emissiveUnits `{stated}` names no wavelength; taken per nm, as the layout's programs do");
            findings.push(Finding::info("I003", message).hint("say --unit if the samples are something else"));
            per_nm.parse().ok()
        }
        Err(error) => {
            findings.push(Finding::warning("S006", format!("emissiveUnits: {error}; no unit taken")));
            None
        }
    }
}

/// The space of R, G, B; of X, Y, Z and luminance alone only the luminance of 1 counts.
fn rgb_space(meta: &MetaData, first: usize, description: &Description) -> RgbSpace {
    // What OpenEXR prescribes where nothing is stated: Rec. ITU-R BT.709 with D65.
    let mut space = Space { encoding: Encoding::Linear, ..SRGB };
    if let Some(c) = meta.headers[first].shared_attributes.chromaticities {
        let pair = |v: Vec2<f32>| [f64::from(v.0), f64::from(v.1)];
        space = Space::of([c.red, c.green, c.blue].map(pair), pair(c.white));
    }
    // OpenEXR is linear, but for what was written as encoded here.
    let encoded = description.attribute("photopic:target").and_then(|t| t.strip_prefix("encoded "));
    let curve = SPACES.into_iter().find(|s| Some(s.name) == encoded).map(|s| s.encoding);
    let white_luminance = meta.headers[first].own_attributes.white_luminance.map(f64::from).filter(|w| *w > 0.0);
    space.encoding = curve.unwrap_or(Encoding::Linear);
    RgbSpace { space, encoded: curve.is_some(), white_luminance }
}

/// The attributes that are text or a number, by name.
fn attributes(meta: &MetaData, first: usize) -> Vec<(String, String)> {
    let header = &meta.headers[first];
    let all = header.shared_attributes.other.iter().chain(&header.own_attributes.other);
    let mut out: Vec<(String, String)> = all
        .filter_map(|(name, value)| {
            let text = match value {
                AttributeValue::Text(text) => text.to_string(),
                AttributeValue::F32(v) => v.to_string(),
                AttributeValue::F64(v) => v.to_string(),
                AttributeValue::I32(v) => v.to_string(),
                _ => return None,
            };
            Some((name.to_string(), text))
        })
        .collect();
    let own = &header.own_attributes;
    let texts = [("comments", &own.comments), ("owner", &own.owner), ("capDate", &own.capture_date)];
    for (name, text) in texts {
        out.extend(text.as_ref().map(|t| (name.to_owned(), t.to_string())));
    }
    out.sort();
    out
}

impl<R: Read + Seek + Send> Exr<R> {
    /// Decodes the blocks of a part, those held from the last read excepted, several at a time.
    fn decode(&mut self, part: usize, blocks: &[usize]) -> Result<Vec<(usize, usize, UncompressedBlock)>, Error> {
        let mut out = Vec::with_capacity(blocks.len());
        let mut chunks = Vec::new();
        for &number in blocks {
            if let Some(at) = self.held.iter().position(|(p, n, _)| (*p, *n) == (part, number)) {
                out.push(self.held.swap_remove(at));
                continue;
            }
            self.input.seek(SeekFrom::Start(self.parts[part].offsets[number]))?;
            chunks.push((number, Chunk::read(&mut self.input, &self.meta).map_err(refused)?));
        }
        let meta = &self.meta;
        let decoded: Result<Vec<_>, _> = (chunks.into_par_iter())
            .map(|(number, chunk)| Ok((part, number, UncompressedBlock::decompress_chunk(chunk, meta, false)?)))
            .collect();
        out.extend(decoded.map_err(refused)?);
        Ok(out)
    }
}

impl<R: Read + Seek + Send> Source for Exr<R> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn block(&self) -> (usize, usize) {
        self.block
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        for number in 0..self.parts.len() {
            let wanted: Vec<(usize, usize)> = (channels.iter().enumerate())
                .filter(|(_, c)| self.places[**c].0 == number)
                .map(|(k, c)| (k, self.places[*c].1))
                .collect();
            if wanted.is_empty() || region.pixels() == 0 {
                continue;
            }
            let part = &self.parts[number];
            let (across, (width, height)) = (part.across, part.block);
            let columns = region.x / width..=(region.x + region.width - 1) / width;
            let rows = region.y / height..=(region.y + region.height - 1) / height;
            let blocks: Vec<usize> = rows.flat_map(|r| columns.clone().map(move |c| r * across + c)).collect();
            let at_once = (BYTES_AT_ONCE / (width * height * part.bytes_per_pixel).max(1)).max(1);
            for blocks in blocks.chunks(at_once) {
                let decoded = self.decode(number, blocks)?;
                for (_, index, block) in &decoded {
                    self.parts[number].copy(block, *index, &wanted, region, channels.len(), out)?;
                }
                self.held = decoded;
            }
        }
        Ok(())
    }
}

impl Part {
    /// Copies the samples of a block that lie in a region: of each wanted channel, its number in the output and in the file.
    fn copy(
        &self,
        block: &UncompressedBlock,
        number: usize,
        wanted: &[(usize, usize)],
        region: Region,
        outputs: usize,
        out: &mut [f32],
    ) -> Result<(), Error> {
        let (left, top) = (number % self.across * self.block.0, number / self.across * self.block.1);
        let size = block.index.pixel_size;
        let place = block.index.pixel_position;
        if (place.0, place.1) != (left, top) || block.data.len() != size.0 * size.1 * self.bytes_per_pixel {
            let found = format!("the block of ({}, {}) at the place of ({left}, {top})", place.0, place.1);
            return Err(ErrorKind::Unexpected { found, expected: "blocks at their places".to_owned() }.into());
        }
        let (from, to) = (left.max(region.x), (left + size.0).min(region.x + region.width));
        for y in top.max(region.y)..(top + size.1).min(region.y + region.height) {
            let line = &block.data[(y - top) * size.0 * self.bytes_per_pixel..][..size.0 * self.bytes_per_pixel];
            for (k, channel) in wanted {
                let (kind, before) = self.channels[*channel];
                let bytes = kind.bytes_per_sample();
                let samples = &line[before * size.0 + (from - left) * bytes..][..(to - from) * bytes];
                let start = ((y - region.y) * outputs + k) * region.width + from - region.x;
                samples_to_f32(kind, samples, &mut out[start..start + to - from]);
            }
        }
        Ok(())
    }
}

/// Native-endian samples, as the crate decodes them, as `f32`.
#[expect(clippy::cast_precision_loss, reason = "pixels are f32")]
fn samples_to_f32(kind: SampleType, bytes: &[u8], out: &mut [f32]) {
    match kind {
        SampleType::F32 => {
            let (samples, _) = bytes.as_chunks::<4>();
            out.iter_mut().zip(samples).for_each(|(o, s)| *o = f32::from_ne_bytes(*s));
        }
        SampleType::F16 => {
            let (samples, _) = bytes.as_chunks::<2>();
            out.iter_mut().zip(samples).for_each(|(o, s)| *o = ::exr::prelude::f16::from_ne_bytes(*s).to_f32());
        }
        SampleType::U32 => {
            let (samples, _) = bytes.as_chunks::<4>();
            out.iter_mut().zip(samples).for_each(|(o, s)| *o = u32::from_ne_bytes(*s) as f32);
        }
    }
}
