//! JPEG.

use std::io::Cursor;

use image::codecs::jpeg::JpegDecoder;
use image::metadata::Orientation;
use image::{ColorType, ImageDecoder};

use super::{Decoded, Stored, assumed, check_size, damaged, not_rgb, srgb};
use crate::finding::Finding;
use crate::image::error::{Error, ErrorKind};

/// The mark at the end; the decoder would fill up with grey what is missing before it.
const END: [u8; 2] = [0xff, 0xd9];
/// Bytes that may follow it.
const AFTER_END: usize = 1 << 16;

pub(super) fn decode(bytes: &[u8]) -> Result<Decoded, Error> {
    let failed = |e: image::ImageError| damaged("JPEG picture", &e);
    let mut decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(failed)?;
    let (width, height) = decoder.dimensions();
    let (width, height) = (width as usize, height as usize);
    check_size(width, height)?;
    let tail = &bytes[bytes.len().saturating_sub(AFTER_END)..];
    if !tail.windows(2).any(|pair| pair == END) {
        let found = "no end of the picture".to_owned();
        let expected = "a mark of it: the file is cut off".to_owned();
        return Err(ErrorKind::Unexpected { found, expected }.into());
    }
    let samples = match decoder.color_type() {
        ColorType::L8 => 1,
        ColorType::Rgb8 => 3,
        other => return Err(not_rgb(format!("a JPEG picture of type {other:?}"))),
    };
    let profile = decoder.icc_profile().map_err(failed)?;
    let mut findings = vec![assumed(profile.as_deref())];
    if decoder.orientation().map_err(failed)? != Orientation::NoTransforms {
        let message = "the camera says that the picture is to be turned; it is read as stored";
        findings.push(Finding::info("I106", message));
    }
    let mut stored = vec![0; width * height * samples];
    decoder.read_image(&mut stored).map_err(failed)?;
    let (space, curve) = srgb();
    Ok(Decoded { width, height, samples, planar: false, stored: Stored::U8(stored), space, curve, findings })
}
