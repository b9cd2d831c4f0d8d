//! Writing ENVI images.

use std::io::{BufWriter, Seek, SeekFrom, Write};

use super::header::{Interleave, KNOWN, key};
use super::number::{ByteOrder, DataType};
use crate::finding::Finding;
use crate::image::description::{Content, Description, Meaning};
use crate::image::error::Error;
use crate::image::source::{Region, Source, rows_at_once};

/// How the numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteOptions {
    /// Their order.
    pub interleave: Interleave,
    /// Their type.
    pub data_type: DataType,
    /// Order of their bytes.
    pub byte_order: ByteOrder,
}

impl Default for WriteOptions {
    /// Little-endian 32-bit floats, line by line.
    fn default() -> Self {
        Self { interleave: Interleave::Bil, data_type: DataType::F32, byte_order: ByteOrder::Little }
    }
}

/// Writes the data of an image, and then its header.
///
/// Integers are rounded, and cut at the ends of their range with a finding.
///
/// # Errors
/// Those of the source and of the writers.
pub fn write<H: Write, D: Write + Seek>(
    mut header: H,
    data: D,
    source: &mut dyn Source,
    options: WriteOptions,
) -> Result<Vec<Finding>, Error> {
    let description = source.description().clone();
    let findings = write_numbers(data, source, options, 0)?;
    header.write_all(header_text(&description, options).as_bytes())?;
    header.flush()?;
    Ok(findings)
}

/// Writes the samples of an image as numbers from byte `start` on.
pub(in crate::image::format) fn write_numbers<D: Write + Seek>(
    data: D,
    source: &mut dyn Source,
    options: WriteOptions,
    start: u64,
) -> Result<Vec<Finding>, Error> {
    let description = source.description().clone();
    let (width, height) = (description.width, description.height);
    let channels: Vec<usize> = (0..description.channels.len()).collect();
    let mut data = BufWriter::new(data);
    data.seek(SeekFrom::Start(start))?;
    let (kind, size) = (options.data_type, options.data_type.bytes());
    let rows = rows_at_once(width, channels.len(), source.block().1);
    let (mut samples, mut bytes) = (Vec::new(), Vec::new());
    let push = |value: &f32, bytes: &mut Vec<u8>| kind.encode(options.byte_order, *value, bytes);
    let mut lost = 0_u64;
    for y in (0..height).step_by(rows) {
        let rows = rows.min(height - y);
        samples.resize(rows * width * channels.len(), 0.0);
        source.read(Region::rows(&description, y, rows), &channels, &mut samples)?;
        lost += samples.iter().filter(|v| kind.loses(**v)).count() as u64;
        if options.interleave == Interleave::Bsq {
            for c in 0..channels.len() {
                data.seek(SeekFrom::Start(start + ((c * height + y) * width * size) as u64))?;
                for row in samples.chunks_exact(width * channels.len()) {
                    bytes.clear();
                    row[c * width..(c + 1) * width].iter().for_each(|v| push(v, &mut bytes));
                    data.write_all(&bytes)?;
                }
            }
            continue;
        }
        for row in samples.chunks_exact(width * channels.len()) {
            bytes.clear();
            if options.interleave == Interleave::Bip {
                (0..width).for_each(|x| row[x..].iter().step_by(width).for_each(|v| push(v, &mut bytes)));
            } else {
                row.iter().for_each(|v| push(v, &mut bytes));
            }
            data.write_all(&bytes)?;
        }
    }
    data.flush()?;
    let mut findings = Vec::new();
    if lost > 0 {
        let message = format!("{lost} samples lie beyond the range of {kind} and were cut, NaN to 0");
        findings.push(Finding::warning("I020", message).hint("write f32"));
    }
    Ok(findings)
}

/// A word that may stand between braces and commas.
fn plain(text: &str) -> String {
    text.replace(['{', '}', ',', '\n', '\r', '='], " ")
}

fn braces(items: impl Iterator<Item = String>) -> String {
    format!("{{ {} }}", items.collect::<Vec<_>>().join(", "))
}

fn header_text(description: &Description, options: WriteOptions) -> String {
    let mut out = format!(
        "ENVI\ndescription = {{ photopic {} }}\nsamples = {}\nlines = {}\nbands = {}\nheader offset = 0\n\
         file type = ENVI Standard\ndata type = {}\ninterleave = {}\nbyte order = {}\n",
        env!("CARGO_PKG_VERSION"),
        description.width,
        description.height,
        description.channels.len(),
        options.data_type.code(),
        options.interleave.word(),
        if options.byte_order == ByteOrder::Big { 1 } else { 0 },
    );
    let bands: Option<Vec<_>> = (description.channels.iter())
        .map(|c| match c.meaning {
            Meaning::Band { wavelength_nm, fwhm_nm, good } => Some((wavelength_nm, fwhm_nm, good)),
            _ => None,
        })
        .collect();
    let names = braces(description.channels.iter().map(|c| plain(&c.name)));
    out.push_str(&format!("band names = {names}\n"));
    if let Some(bands) = bands.filter(|b| !b.is_empty()) {
        out.push_str("wavelength units = Nanometers\n");
        out.push_str(&format!("wavelength = {}\n", braces(bands.iter().map(|b| b.0.to_string()))));
        let widths: Option<Vec<String>> = bands.iter().map(|b| b.1.map(|w| w.to_string())).collect();
        if let Some(widths) = widths {
            out.push_str(&format!("fwhm = {}\n", braces(widths.into_iter())));
        }
        if bands.iter().any(|b| !b.2) {
            out.push_str(&format!("bbl = {}\n", braces(bands.iter().map(|b| u8::from(b.2).to_string()))));
        }
    }
    match &description.content {
        Content::Light { unit: Some(unit), .. } => out.push_str(&format!("data units = {}\n", plain(&unit.text))),
        Content::Reflectance => out.push_str("reflectance scale factor = 1\n"),
        Content::Light { .. } | Content::Planes => {
            let units: Vec<&str> = description.channels.iter().map(|c| c.unit.as_str()).collect();
            if let [first, rest @ ..] = units.as_slice()
                && !first.is_empty()
                && rest.iter().all(|u| u == first)
            {
                out.push_str(&format!("data units = {}\n", plain(first)));
            }
        }
    }
    let free = |name: &str| !KNOWN.contains(&key(name).as_str()) && key(name) != "description";
    for (name, value) in description.attributes.iter().filter(|(name, _)| free(name)) {
        out.push_str(&format!("{} = {{ {} }}\n", plain(name), value.replace(['{', '}'], " ")));
    }
    out
}
