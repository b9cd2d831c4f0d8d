//! ALTA tables, text and binary: points in a named parameterisation ([`Points`]).
//!
//! Header lines `#KEY value`: `#DIM n m` (coordinates, values), `#PARAM_IN`, `#PARAM_OUT`, `#VS n` (columns of bounds after the
//! values, which are not read). Then one point per line, or with `#FORMAT binary` 64-bit floats, `#SAMPLE_COUNT` points of n + m.
//!
//! `INV_STERADIAN_COSINE_FACTOR` values carry the cosine of the outgoing direction, which is divided out; points within 1e-6 of
//! the horizon, where that has no meaning, are left out and counted.
//!
//! Reference: L. Belcour et al., *ALTA: A BRDF Analysis Library*, MAM workshop (2014), and its description of parameterisations.

use std::fmt::Write;

use glam::DVec3;

use super::convert::channel_names;
use super::error::{Error, ErrorKind};
use super::text::{Line, Word, decode, lines};
use crate::brdf::coordinates::Parameterisation;
use crate::brdf::table::{Channel, Points};
use crate::finding::{Checked, Finding, Location};

/// How the numbers of a table stand in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Decimal.
    Text,
    /// 64-bit floats, little-endian.
    Binary,
}

const END: &str = "#ALTA_END_HEADER";

/// What a header says.
#[derive(Default)]
struct Header {
    values: usize,
    input: Option<Parameterisation>,
    output: String,
    binary: bool,
    big_endian: bool,
    samples: Option<(usize, u64)>,
}

/// Reads a table.
///
/// # Errors
/// [`Error`] with the place of what is missing, not understood or no number.
pub fn parse(bytes: &[u8]) -> Result<Checked<Points>, Error> {
    let end = find(bytes, END.as_bytes()).map(|at| at + END.len());
    let data = end.map(|at| at + bytes[at..].iter().take_while(|b| **b != b'\n').count() + 1);
    let (text, assumed) = decode(&bytes[..end.unwrap_or(bytes.len())]);
    let header = header(&text)?;
    let input =
        header.input.ok_or_else(|| Error::whole(ErrorKind::unexpected("no `#PARAM_IN`", "a parameterisation")))?;
    if header.values == 0 {
        return Err(Error::whole(ErrorKind::unexpected("no `#DIM`", "the numbers of coordinates and values")));
    }
    let rows = if header.binary {
        binary_rows(&header, input, bytes.get(data.unwrap_or(bytes.len())..).unwrap_or_default())?
    } else {
        let (whole, _) = decode(bytes);
        text_rows(&whole, input.dimension(), header.values)?
    };
    let mut findings: Vec<Finding> = assumed.into_iter().collect();
    if let Some((announced, line)) =
        header.samples.filter(|(n, _)| *n != rows.len() / (input.dimension() + header.values))
    {
        let found = rows.len() / (input.dimension() + header.values);
        let words = format!("#SAMPLE_COUNT announces {announced} points; {found} are there and were read");
        findings.push(Finding::warning("B105", words).at(Location::line(line)));
    }
    points(&header, input, &rows, &mut findings).map(|value| Checked { value, findings })
}

fn find(bytes: &[u8], mark: &[u8]) -> Option<usize> {
    bytes.windows(mark.len()).position(|w| w == mark)
}

fn header(text: &str) -> Result<Header, Error> {
    let mut header = Header::default();
    let mut coordinates = None;
    for line in lines(text).filter(|l| l.text.starts_with('#')) {
        let words: Vec<Word<'_>> = line.words().collect();
        let Some(first) = words.first() else { continue };
        let value = |i: usize| {
            words
                .get(i)
                .copied()
                .ok_or_else(|| line.error(ErrorKind::unexpected(format!("`{}` alone", first.text), "a value")))
        };
        match first.text {
            "#DIM" => {
                coordinates = Some((value(1)?.count("the number of coordinates")?, value(1)?));
                header.values = value(2)?.count("the number of values")?;
                if !(1..=10_000).contains(&header.values) {
                    return Err(
                        value(2)?.error(ErrorKind::unexpected(format!("{} values", header.values), "1 to 10000"))
                    );
                }
            }
            "#PARAM_IN" => {
                let name = value(1)?;
                header.input = Some(Parameterisation::by_name(name.text).ok_or_else(|| {
                    let known: Vec<&str> = Parameterisation::ALL.iter().map(|(_, n)| *n).collect();
                    let found = format!("the parameterisation `{}`", name.text.chars().take(40).collect::<String>());
                    name.error(ErrorKind::unexpected(found, format!("one of {}", known.join(", "))))
                })?);
            }
            "#PARAM_OUT" => value(1)?.text.clone_into(&mut header.output),
            "#FORMAT" => header.binary = value(1)?.text == "binary",
            "#ENDIAN" => header.big_endian = value(1)?.text == "big",
            "#PRECISION" if value(1)?.text != "ieee754-double" => {
                let found = format!("the precision `{}`", value(1)?.text.chars().take(40).collect::<String>());
                return Err(value(1)?.error(ErrorKind::unexpected(found, "ieee754-double")));
            }
            "#SAMPLE_COUNT" => header.samples = Some((value(1)?.count("the number of points")?, line.number)),
            _ => {}
        }
    }
    if let (Some((n, word)), Some(input)) = (coordinates, header.input)
        && n != input.dimension()
    {
        let expected = format!("{} for {}", input.dimension(), input.name());
        return Err(word.error(ErrorKind::unexpected(format!("{n} coordinates"), expected)));
    }
    Ok(header)
}

fn text_rows(text: &str, coordinates: usize, values: usize) -> Result<Vec<f64>, Error> {
    let mut rows = Vec::new();
    let is_point = |l: &Line<'_>| !l.text.trim_start().starts_with('#') && !l.text.trim().is_empty();
    for line in lines(text).filter(is_point) {
        let mut found = 0;
        for word in line.words().take(coordinates + values) {
            rows.push(word.number(if found < coordinates { "a coordinate" } else { "a value" })?);
            found += 1;
        }
        if found < coordinates + values {
            let kind = ErrorKind::unexpected(
                format!("{found} numbers"),
                format!("{coordinates} coordinates and {values} values"),
            );
            return Err(line.error(kind));
        }
    }
    Ok(rows)
}

fn binary_rows(header: &Header, input: Parameterisation, data: &[u8]) -> Result<Vec<f64>, Error> {
    let (samples, line) = header
        .samples
        .ok_or_else(|| Error::whole(ErrorKind::unexpected("no `#SAMPLE_COUNT`", "one in a binary file")))?;
    let row = (input.dimension() + header.values) as u64 * 8;
    let expected = (samples as u64).saturating_mul(row);
    if (data.len() as u64) < expected {
        let what = format!("{samples} points after the header");
        return Err(Error::at(line, 1, ErrorKind::Length { found: data.len() as u64, expected, what }));
    }
    let number = |b: &[u8]| {
        let mut eight = [0; 8];
        eight.copy_from_slice(b);
        if header.big_endian { f64::from_be_bytes(eight) } else { f64::from_le_bytes(eight) }
    };
    Ok(data.chunks_exact(8).take(samples * (input.dimension() + header.values)).map(number).collect())
}

fn points(
    header: &Header,
    input: Parameterisation,
    rows: &[f64],
    findings: &mut Vec<Finding>,
) -> Result<Points, Error> {
    let n = input.dimension();
    let with_cosine = header.output == "INV_STERADIAN_COSINE_FACTOR";
    let (mut directions, mut values, mut left_out): (Vec<(DVec3, DVec3)>, Vec<f64>, usize) =
        (Vec::new(), Vec::new(), 0);
    for row in rows.chunks_exact(n + header.values) {
        let (incident, outgoing) = input.directions(&row[..n]);
        if with_cosine && outgoing.z < 1e-6 {
            left_out += 1;
            continue;
        }
        directions.push((incident, outgoing));
        values.extend(row[n..].iter().map(|v| if with_cosine { v / outgoing.z } else { *v }));
    }
    if with_cosine {
        let words =
            "values carry the cosine of the outgoing direction (INV_STERADIAN_COSINE_FACTOR), which was divided out";
        findings.push(Finding::info("B107", words));
    }
    if left_out > 0 {
        let words = format!("{left_out} points at or below the horizon were left out: their cosine factor is zero");
        findings.push(Finding::warning("B110", words));
    }
    let negative = values.iter().filter(|v| **v < 0.0).count();
    if negative > 0 {
        findings.push(Finding::warning("B108", format!("{negative} values are negative and were kept")));
    }
    let channels = match (header.output.as_str(), header.values) {
        ("XYZ_COLOR", 3) => ["X", "Y", "Z"].map(|c| Channel::Named(c.to_owned())).to_vec(),
        (_, 3) => Channel::rgb(),
        (_, n) => (1..=n).map(|i| Channel::Named(i.to_string())).collect(),
    };
    Ok(Points::new(input, channels, directions, values)?)
}

/// A table as a file, in its own parameterisation. Decimal numbers have the fewest digits that give the same double again.
///
/// Of channels the file names none but red, green, blue and X, Y, Z; others are counted by its readers, which a finding says.
#[must_use]
pub fn write(table: &Points, encoding: Encoding) -> Checked<Vec<u8>> {
    let input = table.parameterisation();
    let (n, m) = (input.dimension(), table.channels().len());
    let names: Vec<String> = table.channels().iter().map(ToString::to_string).collect();
    let output = match names.join("").as_str() {
        "RGB" => "RGB_COLOR",
        "XYZ" => "XYZ_COLOR",
        _ => "INV_STERADIAN",
    };
    let mut head =
        format!("#ALTA_BEGIN_HEADER\n#DIM {n} {m}\n#PARAM_IN {}\n#PARAM_OUT {output}\n#VS 0\n", input.name());
    if encoding == Encoding::Binary {
        let format = "#VERSION 0\n#FORMAT binary\n#ENDIAN little\n#PRECISION ieee754-double\n";
        let _ = writeln!(head, "{format}#SAMPLE_COUNT {}", table.len());
    }
    head += END;
    head.push('\n');
    let mut out = head.into_bytes();
    let mut c = [0.0; 6];
    for (incident, outgoing, values) in table.iter() {
        input.coordinates(incident, outgoing, &mut c);
        let numbers = c[..n].iter().chain(values);
        match encoding {
            Encoding::Binary => numbers.for_each(|v| out.extend_from_slice(&v.to_le_bytes())),
            Encoding::Text => {
                let words: Vec<String> = numbers.map(ToString::to_string).collect();
                out.extend_from_slice(words.join(" ").as_bytes());
                out.push(b'\n');
            }
        }
    }
    let mut findings = Vec::new();
    let counted = (1..=m).map(|i| i.to_string());
    if output == "INV_STERADIAN" && !names.iter().cloned().eq(counted) {
        let words = format!("the file has no names for its values: {}", channel_names(table.channels()));
        findings.push(Finding::info("B404", words));
    }
    Checked { value: out, findings }
}
