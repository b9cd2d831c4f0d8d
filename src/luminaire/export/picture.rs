//! Pictures of one channel of 32-bit numbers, in OpenEXR.

use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder,
    Text, WritableImage,
};

use super::{Error, PIXELS};

/// Pixels row by row from the top.
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<f32>,
}

impl Picture {
    /// A picture whose pixels are f(column, row).
    pub(super) fn of(width: usize, height: usize, f: impl Fn(usize, usize) -> f32) -> Self {
        let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row))).map(|(c, r)| f(c, r));
        Self { width, height, pixels: pixels.collect() }
    }

    /// An OpenEXR file: channel `Y`, scan lines from the top, ZIP; `comments` as the attribute of that name.
    pub(super) fn to_exr(&self, comments: &[String]) -> Result<Vec<u8>, Error> {
        // Attributes are of bytes; names may have other characters.
        let ascii: String = comments.join("\n").chars().map(|c| if c.is_ascii() { c } else { '?' }).collect();
        let attributes = LayerAttributes {
            comments: Text::new_or_none(ascii),
            software_name: Text::new_or_none(concat!("photopic ", env!("CARGO_PKG_VERSION"))),
            ..LayerAttributes::default()
        };
        let encoding =
            Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
        let channel = AnyChannel::new("Y", FlatSamples::F32(self.pixels.clone()));
        let channels = AnyChannels { list: std::iter::once(channel).collect() };
        let image = Image::from_layer(Layer::new((self.width, self.height), attributes, encoding, channels));
        let mut out = Cursor::new(Vec::new());
        // Files are written side by side; threads within one would not help.
        let written = image.write().non_parallel().to_buffered(&mut out);
        written.map_err(|e| Error::Picture { message: e.to_string() })?;
        Ok(out.into_inner())
    }
}

/// The number of pixels asked for, or the target's own, if it is in range.
pub(super) fn side(asked: Option<usize>, default: usize) -> Result<usize, Error> {
    let pixels = asked.unwrap_or(default);
    if PIXELS.contains(&pixels) { Ok(pixels) } else { Err(Error::Pixels { found: pixels }) }
}
