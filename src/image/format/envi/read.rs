//! Reading the numbers of an ENVI image region by region.

use std::io::{Read, Seek, SeekFrom};

use rayon::prelude::*;

use super::header::{Header, Interleave, parse_header};
use super::number::{Scaling, Tally, decode};
use crate::finding::{Checked, Finding, Location};
use crate::image::description::{Channel, Content, Description, Meaning};
use crate::image::error::{Error, ErrorKind};
use crate::image::source::{self, Region, Source};
use crate::spectrum::{SpectralUnit, WavelengthUnit};

/// Bytes read at a time.
const BYTES_AT_ONCE: usize = 4 << 20;
/// Pixels transposed together: their samples stay in the first cache.
const TRANSPOSED: usize = 64;

/// What the user says about a file that states less.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Unit of the wavelengths where the header states none.
    pub wavelength_unit: Option<WavelengthUnit>,
    /// The samples are reflectances, whatever the header says.
    pub reflectance: bool,
}

/// An ENVI image being read.
pub struct Envi<R> {
    input: R,
    header: Header,
    description: Description,
    /// Of each band.
    scaling: Vec<Scaling>,
    /// Bytes as they stand in the file; kept between reads.
    bytes: Vec<u8>,
    tally: Tally,
}

/// Opens an image by its header and its data.
///
/// # Errors
/// Those of [`parse_header`]; [`ErrorKind::CutOff`] where the data are shorter than the header announces.
pub fn open<R: Read + Seek + Send>(header: &[u8], data: R, options: Options) -> Result<Checked<Envi<R>>, Error> {
    let Checked { value: header, mut findings } = parse_header(header)?;
    let mut opened = open_numbers(header, data, options)?;
    findings.append(&mut opened.findings);
    opened.findings = findings;
    Ok(opened)
}

/// Opens numbers that a header describes, wherever the header comes from.
pub(in crate::image::format) fn open_numbers<R: Read + Seek + Send>(
    header: Header,
    mut data: R,
    options: Options,
) -> Result<Checked<Envi<R>>, Error> {
    let mut findings = Vec::new();
    let found = data.seek(SeekFrom::End(0))?;
    let sizes = [header.lines, header.bands, header.data_type.bytes()].map(|n| n as u64);
    let expected = (sizes.into_iter())
        .try_fold(header.samples as u64, u64::checked_mul)
        .and_then(|bytes| bytes.checked_add(header.offset))
        .unwrap_or(u64::MAX);
    if found < expected {
        let hint = format!(
            "{} samples × {} lines × {} bands of {} bytes after {} are announced",
            header.samples,
            header.lines,
            header.bands,
            header.data_type.bytes(),
            header.offset
        );
        return Err(Error::from(ErrorKind::CutOff { found, expected }).with_hint(hint));
    }
    if found > expected {
        let message = format!("{} bytes follow the image and were not read", found - expected);
        findings.push(Finding::warning("I002", message).hint("wrong samples, lines, bands or data type?"));
    }
    let description = describe(&header, options, &mut findings)?;
    let scaling = (0..header.bands)
        .map(|i| Scaling {
            gain: header.gains.get(i).copied().unwrap_or(1.0),
            offset: header.offsets.get(i).copied().unwrap_or(0.0),
            ignore: header.ignore,
        })
        .collect();
    let value = Envi { input: data, header, description, scaling, bytes: Vec::new(), tally: Tally::default() };
    Ok(Checked { value, findings })
}

fn describe(header: &Header, options: Options, findings: &mut Vec<Finding>) -> Result<Description, Error> {
    let spectral = !header.wavelengths.is_empty();
    let unit: Option<SpectralUnit> = header.data_units.as_ref().filter(|_| spectral).and_then(|text| {
        let parsed = text.parse();
        if let Err(error) = &parsed {
            findings.push(Finding::warning("S006", format!("`data units`: {error}; no unit taken")));
        }
        parsed.ok()
    });
    let reflectance = header.reflectance || options.reflectance;
    let text = match &header.data_units {
        Some(text) if !reflectance && (unit.is_some() || !spectral) => text.clone(),
        _ => String::new(),
    };
    let stated = header.wavelength_unit.or(options.wavelength_unit);
    if spectral && stated.is_none() && !header.wavenumbers {
        let message = "no unit of wavelength stated; nm taken by convention";
        findings.push(Finding::info("S003", message).hint("say --wavelength-unit if it is another"));
    }
    let nm = |w: f64| if header.wavenumbers { 1e7 / w } else { stated.unwrap_or_default().to_nm(w) };
    let channels = (0..header.bands)
        .map(|i| {
            let name = header.band_names.get(i).cloned();
            let Some(wavelength) = header.wavelengths.get(i) else {
                return Channel::new(name.unwrap_or_else(|| format!("band {}", i + 1)), &text, Meaning::Other);
            };
            let wavelength_nm = nm(*wavelength);
            // A width in wavenumbers is none in wavelengths by factor alone; it is left out.
            let fwhm_nm = header.fwhm.get(i).filter(|_| !header.wavenumbers).map(|w| nm(*w));
            let good = header.good.get(i).copied().unwrap_or(true);
            let meaning = Meaning::Band { wavelength_nm, fwhm_nm, good };
            Channel::new(name.unwrap_or_else(|| format!("{wavelength_nm} nm")), &text, meaning)
        })
        .collect();
    let mut description = Description::planes(header.samples, header.lines, channels);
    description.attributes.clone_from(&header.other);
    if spectral {
        description.content = if reflectance {
            Content::Reflectance
        } else {
            Content::Light { quantity: unit.as_ref().map(|u| u.quantity), unit }
        };
        let bad = header.good.iter().filter(|good| !**good).count();
        if bad > 0 {
            let message = format!("{bad} of {} bands are marked bad and take part in no integral", header.bands);
            findings.push(Finding::warning("I009", message));
        }
        if bad < header.bands {
            description.grid().map_err(|e| Error::new(Location::at(header.wavelength_line, 1), e))?;
        }
    } else {
        findings.push(Finding::warning("I001", "no `wavelength` in the header: the bands are planes without spectrum"));
    }
    Ok(description)
}

impl<R: Read + Seek> Envi<R> {
    fn fetch(&mut self, sample: u64, count: usize, at: usize) -> Result<(), Error> {
        let size = self.header.data_type.bytes();
        self.input.seek(SeekFrom::Start(self.header.offset + sample * size as u64))?;
        self.input.read_exact(&mut self.bytes[at..at + count * size])?;
        Ok(())
    }
}

impl<R: Read + Seek + Send> Source for Envi<R> {
    fn description(&self) -> &Description {
        &self.description
    }

    fn read(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        source::check(&self.description, region, channels, out);
        if region.pixels() == 0 || channels.is_empty() {
            return Ok(());
        }
        match self.header.interleave {
            Interleave::Bsq => self.read_bsq(region, channels, out),
            Interleave::Bil => self.read_lines(region, channels, out, false),
            Interleave::Bip => self.read_lines(region, channels, out, true),
        }
    }

    fn findings(&self) -> Vec<Finding> {
        let mut out = Vec::new();
        if self.tally.ignored > 0 {
            let message = format!("{} samples equal the data ignore value and became NaN", self.tally.ignored);
            out.push(Finding::info("I008", message));
        }
        if self.tally.overflowed > 0 {
            let message =
                format!("{} samples exceed the largest float (3.4e38) and became infinite", self.tally.overflowed);
            out.push(Finding::error("I022", message));
        }
        out
    }
}

impl<R: Read + Seek + Send> Envi<R> {
    /// Band after band: as many rows of one as are asked for and fit the buffer.
    fn read_bsq(&mut self, region: Region, channels: &[usize], out: &mut [f32]) -> Result<(), Error> {
        let (width, lines) = (self.header.samples, self.header.lines);
        let size = self.header.data_type.bytes();
        let rows_at_once = if region.width == width { (BYTES_AT_ONCE / (width * size)).max(1) } else { 1 };
        for (k, channel) in channels.iter().enumerate() {
            let scaling = self.scaling[*channel];
            let mut y = 0;
            while y < region.height {
                let rows = rows_at_once.min(region.height - y);
                let samples = (rows - 1) * width + region.width;
                self.bytes.resize(samples * size, 0);
                let first = ((channel * lines + region.y + y) * width + region.x) as u64;
                self.fetch(first, samples, 0)?;
                let (kind, order) = (self.header.data_type, self.header.byte_order);
                for row in 0..rows {
                    let start = ((y + row) * channels.len() + k) * region.width;
                    let out = &mut out[start..start + region.width];
                    self.tally = self.tally + decode(kind, order, scaling, &self.bytes[row * width * size..], 1, out);
                }
                y += rows;
            }
        }
        Ok(())
    }

    /// Rows with all of their bands; in each band after band, or pixel after pixel.
    fn read_lines(&mut self, region: Region, channels: &[usize], out: &mut [f32], pixels: bool) -> Result<(), Error> {
        let (width, bands) = (self.header.samples, self.header.bands);
        let size = self.header.data_type.bytes();
        // What is fetched of a row: of band-interleaved pixels those of the region, of bands those from first to last.
        let (low, high) = channels.iter().fold((bands, 0), |(low, high), c| (low.min(*c), high.max(*c)));
        let (before, span) = if pixels {
            (region.x * bands, region.width * bands)
        } else {
            (low * width + region.x, (high - low) * width + region.width)
        };
        let rows_at_once = (BYTES_AT_ONCE / (span * size)).max(1);
        let (kind, order) = (self.header.data_type, self.header.byte_order);
        let row_out = channels.len() * region.width;
        let whole = span == width * bands;
        for (batch, out) in out.chunks_mut(rows_at_once * row_out).enumerate() {
            let rows = out.len() / row_out;
            let y = region.y + batch * rows_at_once;
            self.bytes.resize(rows * span * size, 0);
            if whole {
                self.fetch((y * width * bands) as u64, rows * span, 0)?;
            } else {
                for row in 0..rows {
                    self.fetch(((y + row) * width * bands + before) as u64, span, row * span * size)?;
                }
            }
            let scaling = &self.scaling;
            let lines = self.bytes.par_chunks_exact(span * size).zip(out.par_chunks_exact_mut(row_out));
            let tally = lines.map(|(line, out)| {
                if pixels {
                    return transpose(line, bands * size, region.width, out, |c, bytes, out| {
                        decode(kind, order, scaling[channels[c]], &bytes[channels[c] * size..], bands, out)
                    });
                }
                let planes = channels.iter().zip(out.chunks_exact_mut(region.width));
                planes.fold(Tally::default(), |tally, (c, out)| {
                    tally + decode(kind, order, scaling[*c], &line[(c - low) * width * size..], 1, out)
                })
            });
            self.tally = self.tally + tally.reduce(Tally::default, |a, b| a + b);
        }
        Ok(())
    }
}

/// Pixels of `bytes` bytes to planes of `width` samples, a few pixels at a time.
fn transpose(
    line: &[u8],
    bytes: usize,
    width: usize,
    out: &mut [f32],
    plane: impl Fn(usize, &[u8], &mut [f32]) -> Tally,
) -> Tally {
    let mut tally = Tally::default();
    for x in (0..width).step_by(TRANSPOSED) {
        let count = TRANSPOSED.min(width - x);
        let block = &line[x * bytes..(x + count) * bytes];
        for (c, out) in out.chunks_exact_mut(width).enumerate() {
            tally = tally + plane(c, block, &mut out[x..x + count]);
        }
    }
    tally
}
