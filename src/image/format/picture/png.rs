//! PNG: reading with its statements on colour, and writing encoded RGB.

use std::io::{BufRead, Seek, Write};

use ::png::chunk::ChunkType;
use ::png::{BitDepth, ColorType, Decoder, DecodingError, Encoder, Info, SrgbRenderingIntent, Transformations};

use super::{Curve, Decoded, MOST_PIXELS, Stored, assumed, check_size, damaged, srgb};
use crate::colorimetry::rgb::{DISPLAY_P3, Encoding, REC2020, SRGB, Space};
use crate::finding::Finding;
use crate::image::description::Meaning;
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{Region, Source, rows_at_once};

pub(super) fn decode(input: impl BufRead + Seek) -> Result<Decoded, Error> {
    let failed = |e: DecodingError| damaged("PNG picture", &e);
    let limits = ::png::Limits { bytes: MOST_PIXELS * 8 };
    let mut decoder = Decoder::new_with_limits(input, limits);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_size(width, height)?;
    let (colour, depth) = reader.output_color_type();
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| damaged("PNG picture", &"its size"))?];
    reader.next_frame(&mut bytes).map_err(failed)?;
    let stored = if depth == BitDepth::Sixteen {
        let (pairs, _) = bytes.as_chunks::<2>();
        Stored::U16(pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect())
    } else {
        Stored::U8(bytes)
    };
    let mut findings = Vec::new();
    let (space, curve) = colours(reader.info(), &mut findings)?;
    Ok(Decoded { width, height, samples: colour.samples(), planar: false, stored, space, curve, findings })
}

/// What the file says of its colours, the strongest statement first.
fn colours(info: &Info<'_>, findings: &mut Vec<Finding>) -> Result<(Space, Curve), Error> {
    if let Some(points) = info.coding_independent_code_points {
        // ITU-T H.273, tables 2 and 3.
        let space = match points.color_primaries {
            1 => Some(SRGB),
            9 => Some(REC2020),
            12 => Some(DISPLAY_P3),
            _ => None,
        };
        let encoding = match points.transfer_function {
            1 | 6 | 14 | 15 => Some(Encoding::Rec2020),
            8 => Some(Encoding::Linear),
            13 => Some(Encoding::Srgb),
            _ => None,
        };
        let (Some(space), Some(encoding), true) = (space, encoding, points.is_video_full_range_image) else {
            let found = format!(
                "a PNG picture with primaries {} and curve {} of ITU-T H.273",
                points.color_primaries, points.transfer_function
            );
            let expected = "full range of primaries 1, 9 or 12, and curve 1, 6, 8, 13, 14 or 15".to_owned();
            return Err(ErrorKind::Unsupported { found, expected }.into());
        };
        return Ok((space, Curve::Of(encoding)));
    }
    if let Some(profile) = &info.icc_profile {
        findings.push(assumed(Some(profile)));
        return Ok(srgb());
    }
    if info.srgb.is_some() {
        return Ok(srgb());
    }
    let (gamma, chromaticities) = (info.gama_chunk.map(|g| g.into_value()), info.chrm_chunk);
    if gamma.is_none() && chromaticities.is_none() {
        findings.push(assumed(None));
        return Ok(srgb());
    }
    let (mut space, mut curve) = srgb();
    if let Some(c) = chromaticities {
        let pair = |(x, y): (::png::ScaledFloat, ::png::ScaledFloat)| [x, y].map(|v| f64::from(v.into_scaled()) / 1e5);
        let stated = Space::of([c.red, c.green, c.blue].map(pair), pair(c.white));
        if stated.to_xyz().is_some() {
            space = stated;
        } else {
            findings.push(Finding::warning("I110", "the chromaticities of cHRM span no colours; sRGB's taken"));
        }
    }
    if let Some(gamma) = gamma.filter(|g| *g > 0.0) {
        curve = Curve::Power(1.0 / f64::from(gamma));
        let message = format!("gAMA {gamma}: light is the sample to the power of {:.4}", 1.0 / f64::from(gamma));
        findings.push(Finding::info("I104", message));
    }
    Ok((space, curve))
}

/// Bits per sample of a picture to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bits {
    /// 0 to 255.
    #[default]
    Eight,
    /// 0 to 65535.
    Sixteen,
}

/// Writes encoded RGB as a PNG picture: 0 to 1 rounded to integers, the space as an sRGB or a cICP chunk, the attributes
/// `photopic:…` as text.
///
/// What lies outside of 0 to 1 is cut, NaN becomes 0, and findings say how often.
///
/// # Errors
/// Those of the source and of the writer; where the image is no encoded RGB, or of a space that PNG has no code for.
pub fn write<W: Write>(out: W, source: &mut dyn Source, bits: Bits) -> Result<Vec<Finding>, Error> {
    let description = source.description().clone();
    let channels: Option<Vec<usize>> = (0..3).map(|k| description.find(Meaning::Primary(k))).collect();
    let (Some(channels), Some(rgb)) = (channels, description.rgb.as_ref().filter(|rgb| rgb.encoded)) else {
        let found = description.attribute("photopic:target").unwrap_or("no encoded RGB").to_owned();
        let expected = "encoded RGB for a PNG picture (--to srgb-encoded)".to_owned();
        return Err(ErrorKind::Unsupported { found, expected }.into());
    };
    let edge = |pixels: usize| {
        u32::try_from(pixels).ok().filter(|n| *n <= i32::MAX.cast_unsigned()).ok_or_else(|| {
            let found = format!("{pixels} pixels along an edge");
            Error::from(ErrorKind::Unsupported { found, expected: "up to 2147483647 in a PNG picture".to_owned() })
        })
    };
    let mut encoder = Encoder::new(out, edge(description.width)?, edge(description.height)?);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(if bits == Bits::Sixteen { BitDepth::Sixteen } else { BitDepth::Eight });
    if rgb.space.key == SRGB.key {
        encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    }
    encoder
        .add_text_chunk("Software".to_owned(), format!("photopic {}", env!("CARGO_PKG_VERSION")))
        .map_err(refused)?;
    for (name, value) in description.attributes.iter().filter(|(name, _)| name.starts_with("photopic:")) {
        encoder.add_itxt_chunk(name.chars().take(LONGEST_KEYWORD).collect(), value.clone()).map_err(refused)?;
    }
    let code = code_points(&rgb.space)?;
    let mut writer = encoder.write_header().map_err(refused)?;
    if let Some(code) = code {
        writer.write_chunk(ChunkType(*b"cICP"), &code).map_err(refused)?;
    }
    let mut stream = writer.stream_writer().map_err(refused)?;
    let rows = rows_at_once(description.width, 3, source.block().1);
    let (mut samples, mut bytes) = (Vec::new(), Vec::new());
    let mut lost = Lost::default();
    for y in (0..description.height).step_by(rows) {
        let rows = rows.min(description.height - y);
        samples.resize(rows * description.width * 3, 0.0);
        source.read(Region::rows(&description, y, rows), &channels, &mut samples)?;
        for row in samples.chunks_exact(3 * description.width) {
            bytes.clear();
            for x in 0..description.width {
                for k in 0..3 {
                    lost.sample(row[k * description.width + x], bits, &mut bytes);
                }
            }
            stream.write_all(&bytes)?;
        }
    }
    stream.finish().map_err(refused)?;
    Ok(lost.findings((3 * description.pixels()) as u64))
}

/// The longest keyword of a text chunk.
const LONGEST_KEYWORD: usize = 79;

/// The cICP chunk of a space; sRGB has a chunk of its own.
fn code_points(space: &Space) -> Result<Option<[u8; 4]>, Error> {
    // Primaries and curve (ITU-T H.273, tables 2 and 3), RGB, full range.
    match space.key {
        key if key == SRGB.key => Ok(None),
        key if key == DISPLAY_P3.key => Ok(Some([12, 13, 0, 1])),
        key if key == REC2020.key => Ok(Some([9, 15, 0, 1])),
        _ => {
            let expected = "sRGB, Display P3 or Rec. 2020 for a PNG picture".to_owned();
            Err(ErrorKind::Unsupported { found: space.name.to_owned(), expected }.into())
        }
    }
}

fn refused(error: ::png::EncodingError) -> Error {
    match error {
        ::png::EncodingError::IoError(error) => error.into(),
        other => {
            ErrorKind::Unexpected { found: other.to_string(), expected: "a picture that PNG holds".to_owned() }.into()
        }
    }
}

/// Samples that a picture cannot hold.
#[derive(Debug, Clone, Copy, Default)]
struct Lost {
    above: u64,
    below: u64,
    not_a_number: u64,
}

impl Lost {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cut to the range and rounded before")]
    fn sample(&mut self, value: f32, bits: Bits, bytes: &mut Vec<u8>) {
        // Half a code of 16 bits: what rounds to an end has not been cut.
        const HALF: f32 = 0.5 / 65535.0;
        self.above += u64::from(value > 1.0 + HALF);
        self.below += u64::from(value < -HALF);
        self.not_a_number += u64::from(value.is_nan());
        let held = if value.is_nan() { 0.0 } else { f64::from(value).clamp(0.0, 1.0) };
        match bits {
            Bits::Eight => bytes.push((held * 255.0).round() as u8),
            Bits::Sixteen => bytes.extend(((held * 65535.0).round() as u16).to_be_bytes()),
        }
    }

    fn findings(self, all: u64) -> Vec<Finding> {
        let share = |count: u64| format!("{count} of {all} samples ({:.2} %)", 100.0 * count as f64 / all as f64);
        let mut out = Vec::new();
        if self.above > 0 {
            let message = format!("{} are brighter than white and were cut", share(self.above));
            out.push(Finding::warning("I121", message).hint("a higher --white-luminance, or --tone"));
        }
        if self.below > 0 {
            let message = format!("{} are out of the gamut, below 0, and were cut", share(self.below));
            out.push(Finding::warning("I121", message).hint("a larger space: display-p3-encoded, rec2020-encoded"));
        }
        if self.not_a_number > 0 {
            let message = format!("{} are not a number and became 0", share(self.not_a_number));
            out.push(Finding::warning("I020", message));
        }
        out
    }
}
