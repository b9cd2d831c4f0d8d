//! A photograph by rows from the top, so that those of many megapixels need not be held whole.
//!
//! PNG, TIFF in strips and EXR are decoded as their rows are asked for; JPEG, interlaced PNG, TIFF in tiles and TIFF of separate planes have
//! to be decoded whole, and are held as their samples: 1, 2 or 4 bytes each.

use std::io::{BufReader, Read, Seek, SeekFrom};

use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::photo::{Codes, Photo};
use super::{Error, photo};
use crate::image::format::exr::{self, Exr};
use crate::image::{Description, Region, Source};

/// Value of the tag of a TIFF where each component has a plane of its own.
const PLANAR: u32 = 2;
/// The most that is held of a TIFF at once, bytes: what a header says may be wrong.
const MOST_BYTES: usize = 1 << 32;

/// A photograph that is being decoded.
pub struct PhotoRows<R: Read + Seek> {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1 (grey) or 3 (red, green, blue).
    pub channels: usize,
    /// Whether its format says that the codes are proportional to exposure.
    pub is_linear: bool,
    /// Rows given so far.
    given: usize,
    reader: Reader<R>,
}

enum Reader<R: Read + Seek> {
    /// With samples per pixel as the file has them, and whether they have 16 bits.
    Png(Box<png::Reader<BufReader<R>>>, usize, bool),
    /// With the number of the next strip, and what was decoded and not given.
    Strips(Box<Decoder<BufReader<R>>>, u32, Vec<f32>),
    /// With the numbers of the channels.
    Exr(Box<Exr<R>>, Vec<usize>),
    Whole(Codes),
}

impl<R: Read + Seek + Send> PhotoRows<R> {
    /// Opens a photograph: PNG, JPEG; TIFF of 16 bits or floats and EXR, which are taken as linear.
    ///
    /// # Errors
    /// [`Error::Undecodable`].
    pub fn open(mut input: R) -> Result<Self, Error> {
        let mut start = Vec::new();
        input.by_ref().take(4).read_to_end(&mut start).map_err(undecodable)?;
        input.seek(SeekFrom::Start(0)).map_err(undecodable)?;
        match start.as_slice() {
            [0x76, 0x2f, 0x31, 0x01] => Self::exr(input),
            [b'I', b'I', 42, 0] | [b'M', b'M', 0, 42] => Self::tiff(input),
            [0x89, b'P', b'N', b'G'] => Self::png(input),
            _ => Ok(Self::whole(photo::decode_whole(BufReader::new(input))?)),
        }
    }

    fn whole(photo: Photo) -> Self {
        let Photo { width, height, channels, codes } = photo;
        let is_linear = matches!(codes, Codes::Linear(_));
        Self { width, height, channels, is_linear, given: 0, reader: Reader::Whole(codes) }
    }

    fn png(input: R) -> Result<Self, Error> {
        let mut decoder = png::Decoder::new(BufReader::new(input));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(undecodable)?;
        let (width, height) = (reader.info().width as usize, reader.info().height as usize);
        let (colour, depth) = reader.output_color_type();
        let (samples, deep) = (colour.samples(), depth == png::BitDepth::Sixteen);
        let channels = if samples < 3 { 1 } else { 3 };
        let mut out = Self {
            width,
            height,
            channels,
            is_linear: false,
            given: 0,
            reader: Reader::Whole(Codes::Eight(Vec::new())),
        };
        out.reader = if reader.info().interlaced {
            let size = reader.output_buffer_size().ok_or_else(|| undecodable("its size"))?;
            let mut bytes = vec![0; size];
            reader.next_frame(&mut bytes).map_err(undecodable)?;
            let mut codes = if deep { Codes::Sixteen(Vec::new()) } else { Codes::Eight(Vec::new()) };
            push_png(&mut codes, &bytes, samples, channels);
            Reader::Whole(codes)
        } else {
            Reader::Png(Box::new(reader), samples, deep)
        };
        Ok(out)
    }

    fn tiff(input: R) -> Result<Self, Error> {
        let mut limits = Limits::default();
        limits.decoding_buffer_size = MOST_BYTES;
        let mut decoder = Decoder::new(BufReader::new(input)).map_err(undecodable)?.with_limits(limits);
        let (width, height) = decoder.dimensions().map_err(undecodable)?;
        let (width, height) = (width as usize, height as usize);
        let channels = match decoder.colortype().map_err(undecodable)? {
            tiff::ColorType::Gray(_) => 1,
            tiff::ColorType::RGB(_) => 3,
            other => return Err(undecodable(format!("a TIFF of {other:?}; expected grey or RGB"))),
        };
        let planar = decoder.find_tag_unsigned::<u32>(Tag::PlanarConfiguration).map_err(undecodable)? == Some(PLANAR);
        let planar = planar && channels > 1;
        if !planar && decoder.get_chunk_type() == ChunkType::Strip {
            let reader = Reader::Strips(Box::new(decoder), 0, Vec::new());
            return Ok(Self { width, height, channels, is_linear: true, given: 0, reader });
        }
        let mut read = DecodingResult::U8(Vec::new());
        decoder.read_image_to_buffer(&mut read).map_err(undecodable)?;
        let mut values = linear(read)?;
        if values.len() != width * height * channels {
            return Err(undecodable(format!("a TIFF of {} samples", values.len())));
        }
        if planar {
            let pixels = width * height;
            values = (0..pixels * channels).map(|i| values[i % channels * pixels + i / channels]).collect();
        }
        Ok(Self::whole(Photo { width, height, channels, codes: Codes::Linear(values) }))
    }

    fn exr(input: R) -> Result<Self, Error> {
        let source = exr::open(input).map_err(undecodable)?.value;
        let numbers = exr_channels(source.description())?;
        let (width, height) = (source.description().width, source.description().height);
        let channels = numbers.len();
        let reader = Reader::Exr(Box::new(source), numbers);
        Ok(Self { width, height, channels, is_linear: true, given: 0, reader })
    }

    /// Size and channels in words.
    #[must_use]
    pub fn size(&self) -> String {
        photo::size(self.width, self.height, self.channels)
    }

    /// The next rows, as many or what is left; when none is left, a photograph without rows.
    ///
    /// # Errors
    /// [`Error::Undecodable`] where the file is damaged there. What was given before was sound.
    pub fn next(&mut self, rows: usize) -> Result<Photo, Error> {
        let rows = rows.min(self.height - self.given);
        let first = self.given;
        let in_row = self.width * self.channels;
        let places = first * in_row..(first + rows) * in_row;
        let codes = match &mut self.reader {
            Reader::Whole(codes) if first == 0 && rows == self.height => {
                std::mem::replace(codes, Codes::Eight(Vec::new()))
            }
            Reader::Whole(Codes::Eight(v)) => Codes::Eight(v[places].to_vec()),
            Reader::Whole(Codes::Sixteen(v)) => Codes::Sixteen(v[places].to_vec()),
            Reader::Whole(Codes::Linear(v)) => Codes::Linear(v[places].to_vec()),
            Reader::Png(reader, samples, deep) => {
                let mut codes = if *deep {
                    Codes::Sixteen(Vec::with_capacity(places.len()))
                } else {
                    Codes::Eight(Vec::with_capacity(places.len()))
                };
                for _ in 0..rows {
                    let row = reader.next_row().map_err(undecodable)?.ok_or_else(|| undecodable("it is cut off"))?;
                    push_png(&mut codes, row.data(), *samples, self.channels);
                }
                codes
            }
            Reader::Strips(decoder, strip, rest) => {
                while rest.len() < places.len() {
                    let samples = linear(decoder.read_chunk(*strip).map_err(undecodable)?)?;
                    if samples.is_empty() {
                        return Err(undecodable("a TIFF with an empty strip"));
                    }
                    rest.extend(samples);
                    *strip += 1;
                }
                Codes::Linear(rest.drain(..places.len()).collect())
            }
            Reader::Exr(source, numbers) => Codes::Linear(interleaved(source.as_mut(), numbers, first, rows)?),
        };
        self.given += rows;
        Ok(Photo { width: self.width, height: rows, channels: self.channels, codes })
    }
}

/// Appends samples of a PNG without what there is beside grey or red, green, blue.
fn push_png(codes: &mut Codes, bytes: &[u8], samples: usize, channels: usize) {
    match codes {
        Codes::Eight(out) => bytes.chunks_exact(samples).for_each(|p| out.extend_from_slice(&p[..channels])),
        Codes::Sixteen(out) => {
            let (pairs, _) = bytes.as_chunks::<2>();
            for pixel in pairs.chunks_exact(samples) {
                out.extend(pixel[..channels].iter().map(|pair| u16::from_be_bytes(*pair)));
            }
        }
        Codes::Linear(_) => {}
    }
}

/// The channels of an EXR that are the picture: R, G and B, or else Y.
pub(super) fn exr_channels(description: &Description) -> Result<Vec<usize>, Error> {
    let number = |name: &str| description.channels.iter().position(|c| c.name == name);
    let rgb: Vec<usize> = ["R", "G", "B"].into_iter().filter_map(number).collect();
    match (rgb.len(), number("Y")) {
        (3, _) => Ok(rgb),
        (_, Some(grey)) => Ok(vec![grey]),
        _ => Err(undecodable("an EXR without channels R, G, B or Y")),
    }
}

/// Rows of some channels of an EXR, the samples of a pixel beside one another.
pub(super) fn interleaved(
    source: &mut dyn Source,
    numbers: &[usize],
    first: usize,
    rows: usize,
) -> Result<Vec<f32>, Error> {
    let (width, channels) = (source.description().width, numbers.len());
    let region = Region::rows(source.description(), first, rows);
    let mut lines = vec![0.0; width * rows * channels];
    source.read(region, numbers, &mut lines).map_err(undecodable)?;
    if channels == 1 {
        return Ok(lines);
    }
    let mut out = Vec::with_capacity(lines.len());
    for line in lines.chunks_exact(width * channels) {
        out.extend((0..width * channels).map(|i| line[i % channels * width + i / channels]));
    }
    Ok(out)
}

/// Samples of a TIFF, 1 where they saturate.
fn linear(read: DecodingResult) -> Result<Vec<f32>, Error> {
    match read {
        DecodingResult::U16(v) => Ok(v.into_iter().map(|v| f32::from(v) / 65535.0).collect()),
        DecodingResult::F32(v) => Ok(v),
        _ => Err(undecodable("a TIFF of other than 16 bits or 32-bit floats")),
    }
}

pub(super) fn undecodable(reason: impl ToString) -> Error {
    Error::Undecodable { reason: reason.to_string() }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{DynamicImage, ImageFormat};

    use super::*;

    /// What the rows of a file are, taken `at_once` at a time.
    fn by_rows(bytes: &[u8], at_once: usize) -> Vec<f64> {
        let mut rows = PhotoRows::open(Cursor::new(bytes)).expect("a photograph");
        let mut out = Vec::new();
        loop {
            let part = rows.next(at_once).expect("rows");
            if part.height == 0 {
                return out;
            }
            out.extend((0..part.width * part.height * part.channels).map(|i| part.code(i)));
        }
    }

    #[test]
    fn rows_are_those_of_the_whole_in_every_format() {
        let sample = |i: u32| u16::try_from(i * 7919 % 65521).expect("16 bits");
        let deep = DynamicImage::ImageRgba16(image::ImageBuffer::from_fn(7, 11, |x, y| {
            image::Rgba([0, 1, 2, 3].map(|c| sample(x * 44 + y * 4 + c)))
        }));
        for picture in [
            deep.clone(),
            DynamicImage::ImageRgb16(deep.to_rgb16()),
            DynamicImage::ImageRgb8(deep.to_rgb8()),
            DynamicImage::ImageLuma16(deep.to_luma16()),
            DynamicImage::ImageLumaA8(deep.to_luma_alpha8()),
        ] {
            let mut file = Cursor::new(Vec::new());
            picture.write_to(&mut file, ImageFormat::Png).expect("written");
            // The samples as the crate `image` has them.
            let expected: Vec<f64> = if picture.color().has_color() {
                picture.to_rgb16().into_raw().into_iter().map(|v| f64::from(v) / 257.0).collect()
            } else {
                picture.to_luma16().into_raw().into_iter().map(|v| f64::from(v) / 257.0).collect()
            };
            for at_once in [1, 4, 11, 100] {
                assert_eq!(by_rows(file.get_ref(), at_once), expected, "{:?} by {at_once}", picture.color());
            }
        }
        // Strips of a TIFF end where the file has them, not where they are asked for.
        let values: Vec<u16> = (0..7 * 11 * 3).map(sample).collect();
        let mut file = Cursor::new(Vec::new());
        let mut encoder = tiff::encoder::TiffEncoder::new(&mut file).expect("a file");
        let mut picture = encoder.new_image::<tiff::encoder::colortype::RGB16>(7, 11).expect("a picture");
        picture.rows_per_strip(3).expect("strips");
        picture.write_data(&values).expect("written");
        for at_once in [2, 3, 11] {
            let found = by_rows(file.get_ref(), at_once);
            assert!(found.iter().zip(&values).all(|(f, v)| (f * 257.0 - f64::from(*v)).abs() < 0.01), "by {at_once}");
            assert_eq!(found.len(), values.len());
        }
    }

    #[test]
    fn a_file_that_is_cut_off_gives_the_rows_before_the_cut() {
        let picture = DynamicImage::ImageLuma8(image::ImageBuffer::from_fn(64, 64, |x, y| {
            image::Luma([u8::try_from((x * 31 + y * 57) % 251).expect("8 bits")])
        }));
        let mut file = Cursor::new(Vec::new());
        picture.write_to(&mut file, ImageFormat::Png).expect("written");
        let whole = file.into_inner();
        let mut rows = PhotoRows::open(Cursor::new(&whole[..whole.len() * 3 / 4])).expect("its head");
        assert!(rows.next(4).is_ok_and(|p| p.height == 4));
        assert!(matches!(rows.next(60), Err(Error::Undecodable { .. })));
        assert!(matches!(PhotoRows::open(Cursor::new(b"no photograph")), Err(Error::Undecodable { .. })));
    }
}
