//! TIFF: grey and RGB, integers and floats.

use std::io::{BufRead, Seek};

use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::{Curve, Decoded, MOST_PIXELS, Stored, assumed, check_size, damaged, not_rgb, srgb};
use crate::colorimetry::rgb::Encoding;
use crate::finding::Finding;
use crate::image::error::Error;

/// Value of the tag where each component has a plane of its own.
const PLANAR: u32 = 2;
/// Four samples of 32 bits.
const MOST_BYTES: usize = 16;

#[expect(clippy::cast_possible_truncation, reason = "pixels are f32")]
pub(super) fn decode(input: impl BufRead + Seek) -> Result<Decoded, Error> {
    let failed = |e: tiff::TiffError| damaged("TIFF picture", &e);
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_PIXELS * MOST_BYTES;
    let mut decoder = Decoder::new(input).map_err(failed)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(failed)?;
    let (width, height) = (width as usize, height as usize);
    check_size(width, height)?;
    let kind = decoder.colortype().map_err(failed)?;
    let samples = match kind {
        ColorType::Gray(_) => 1,
        ColorType::GrayA(_) => 2,
        ColorType::RGB(_) => 3,
        ColorType::RGBA(_) => 4,
        other => return Err(not_rgb(format!("a TIFF picture of type {other:?}"))),
    };
    let planar = decoder.find_tag_unsigned::<u32>(Tag::PlanarConfiguration).map_err(failed)? == Some(PLANAR);
    let profile = decoder.get_tag_u8_vec(Tag::IccProfile).ok();
    let (space, mut curve) = srgb();
    // `read_image` would read the first plane only.
    let mut read = DecodingResult::U8(Vec::new());
    decoder.read_image_to_buffer(&mut read).map_err(failed)?;
    let stored = match read {
        DecodingResult::U8(v) => Stored::U8(v),
        DecodingResult::U16(v) => Stored::U16(v),
        DecodingResult::F16(v) => Stored::F32(v.into_iter().map(f32::from).collect()),
        DecodingResult::F32(v) => Stored::F32(v),
        DecodingResult::F64(v) => Stored::F32(v.into_iter().map(|v| v as f32).collect()),
        _ => return Err(not_rgb(format!("a TIFF picture of type {kind:?} in other than 8 or 16 bits or floats"))),
    };
    let mut findings = vec![assumed(profile.as_deref())];
    if matches!(stored, Stored::F32(_)) {
        curve = Curve::Of(Encoding::Linear);
        findings.push(Finding::info("I104", "the samples are floats: taken as linear"));
    }
    let count = match &stored {
        Stored::U8(v) => v.len(),
        Stored::U16(v) => v.len(),
        Stored::F32(v) => v.len(),
    };
    if count != width * height * samples {
        return Err(damaged("TIFF picture", &format!("{count} samples")));
    }
    Ok(Decoded { width, height, samples, planar, stored, space, curve, findings })
}
