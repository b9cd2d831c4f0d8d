//! Stanford PLY (G. Turk, *The PLY Polygon File Format*, 1994): text and binary of both byte orders.
//!
//! Read are `vertex` (x y z; nx ny nz; s t, u v or texture_u texture_v) and `face` (vertex_indices or vertex_index); all else is passed
//! over. A reader of our own, because it fits on a page and the size of what it allocates is bounded by the size of the file.

use glam::{DVec3, Vec2, Vec3};

use super::{Error, Object, Place, triangulate};
use crate::render::mesh::MeshData;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Encoding {
    Text,
    Little,
    Big,
}

/// Types of numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

struct Property {
    name: String,
    /// The type of a list's length, for a list.
    length: Option<Scalar>,
    scalar: Scalar,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Reads a PLY file.
///
/// # Errors
///
/// Where something else stands than the format asks for, or the file ends; a file without faces.
pub fn read(bytes: &[u8]) -> Result<Object, Error> {
    let (encoding, elements, body) = header(bytes)?;
    let mut values = Values { bytes, at: body, encoding };
    let mut mesh = MeshData::default();
    let mut faces = false;
    for element in &elements {
        values.announce(element)?;
        match element.name.as_str() {
            "vertex" => vertices(element, &mut values, &mut mesh)?,
            "face" => {
                faces = true;
                triangles(element, &mut values, &mut mesh)?;
            }
            _ => (0..element.count)
                .try_for_each(|_| element.properties.iter().try_for_each(|p| values.property(p, |_| ())))?,
        }
    }
    if !faces {
        return Err(values.error("no element `face`", "a mesh with faces"));
    }
    Ok(Object { name: None, material: None, mesh })
}

fn header(bytes: &[u8]) -> Result<(Encoding, Vec<Element>, usize), Error> {
    let (mut encoding, mut elements) = (None, Vec::<Element>::new());
    let mut at = 0;
    for number in 1.. {
        let error = |found: &str, expected: &str| Error {
            place: Place::Line(number, 1),
            found: found.to_owned(),
            expected: expected.to_owned(),
        };
        let rest = &bytes[at..];
        let Some(end) = rest.iter().position(|&b| b == b'\n') else {
            return Err(error("the end of the file", "a PLY header that ends with `end_header`"));
        };
        at += end + 1;
        let line = String::from_utf8_lossy(&rest[..end]);
        let line = line.trim_end();
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let scalar =
            |name: &str| Scalar::named(name).ok_or_else(|| error(&format!("the type `{name}`"), "char to double"));
        match words.as_slice() {
            _ if number == 1 => {
                if line != "ply" {
                    return Err(error("another first line", "`ply`"));
                }
            }
            [] | ["comment" | "obj_info", ..] => {}
            ["format", kind, "1.0"] => {
                encoding = Some(match *kind {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => return Err(error(line, "ascii, binary_little_endian or binary_big_endian")),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| error(line, "a number of elements"))?;
                elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
            }
            ["property", kind @ .., name] => {
                let Some(element) = elements.last_mut() else {
                    return Err(error("a property before any element", "an element first"));
                };
                let (length, scalar) = match kind {
                    ["list", length, of] => (Some(scalar(length)?), scalar(of)?),
                    [of] => (None, scalar(of)?),
                    _ => return Err(error(line, "`property TYPE NAME` or `property list TYPE TYPE NAME`")),
                };
                element.properties.push(Property { name: (*name).to_owned(), length, scalar });
            }
            ["end_header"] => {
                let encoding = encoding.ok_or_else(|| error("no line `format`", "one before the end of the header"))?;
                return Ok((encoding, elements, at));
            }
            _ => return Err(error(line, "a line of a PLY header")),
        }
    }
    unreachable!("the loop ends with the file")
}

/// The numbers of the body, one after the other.
struct Values<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
}

impl Values<'_> {
    fn error(&self, found: &str, expected: &str) -> Error {
        let place = match self.encoding {
            Encoding::Text => {
                let blank = self.bytes[self.at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
                let before = &self.bytes[..self.at + blank];
                let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
                Place::Line(line, before.iter().rev().take_while(|&&b| b != b'\n').count() + 1)
            }
            _ => Place::Byte(self.at),
        };
        Error { place, found: found.to_owned(), expected: expected.to_owned() }
    }

    /// Refuses an element that cannot be in what is left of the file.
    fn announce(&self, element: &Element) -> Result<(), Error> {
        // In text, a digit and a blank at least, but for the last number of a file.
        let least =
            |p: &Property| if self.encoding == Encoding::Text { 2 } else { p.length.unwrap_or(p.scalar).size() };
        let one: usize = element.properties.iter().map(least).sum();
        let left = self.bytes.len() - self.at;
        if one == 0 && element.count > 0 {
            return Err(self.error(&format!("the element `{}` without properties", element.name), "at least one"));
        }
        match element.count.checked_mul(one) {
            Some(size) if size <= left + 1 => Ok(()),
            _ => Err(self.error(
                &format!("{} of `{}` in {left} bytes", element.count, element.name),
                "no more than the file can hold",
            )),
        }
    }

    fn next(&mut self, scalar: Scalar) -> Result<f64, Error> {
        if self.encoding == Encoding::Text {
            return self.word();
        }
        let Some(bytes) = self.bytes.get(self.at..self.at + scalar.size()) else {
            return Err(self.error("the end of the file", "another number"));
        };
        let mut b = [0; 8];
        b[..bytes.len()].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            b[..bytes.len()].reverse();
        }
        self.at += bytes.len();
        let [b0, b1, b2, b3, ..] = b;
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes([b0]).into(),
            Scalar::U8 => b0.into(),
            Scalar::I16 => i16::from_le_bytes([b0, b1]).into(),
            Scalar::U16 => u16::from_le_bytes([b0, b1]).into(),
            Scalar::I32 => i32::from_le_bytes([b0, b1, b2, b3]).into(),
            Scalar::U32 => u32::from_le_bytes([b0, b1, b2, b3]).into(),
            Scalar::F32 => f32::from_le_bytes([b0, b1, b2, b3]).into(),
            Scalar::F64 => f64::from_le_bytes(b),
        })
    }

    fn word(&mut self) -> Result<f64, Error> {
        let rest = &self.bytes[self.at..];
        let blank = rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
        let length = rest[blank..].iter().take_while(|b| !b.is_ascii_whitespace()).count();
        self.at += blank;
        let word = String::from_utf8_lossy(&rest[blank..blank + length]);
        if word.is_empty() {
            return Err(self.error("the end of the file", "another number"));
        }
        let number = word.parse().map_err(|_| self.error(&format!("`{word}`"), "a number"))?;
        self.at += length;
        Ok(number)
    }

    /// Passes the numbers of a property on.
    fn property(&mut self, property: &Property, mut with: impl FnMut(f64)) -> Result<(), Error> {
        let count = match property.length {
            None => 1.0,
            Some(scalar) => self.next(scalar)?,
        };
        if !(0.0..=u32::MAX.into()).contains(&count) {
            return Err(self.error(&format!("a list of {count}"), "a length"));
        }
        for _ in 0..count as u32 {
            with(self.next(property.scalar)?);
        }
        Ok(())
    }
}

fn vertices(element: &Element, values: &mut Values, mesh: &mut MeshData) -> Result<(), Error> {
    const NAMES: [&[&str]; 8] =
        [&["x"], &["y"], &["z"], &["nx"], &["ny"], &["nz"], &["s", "u", "texture_u"], &["t", "v", "texture_v"]];
    let columns: Vec<Option<usize>> = (element.properties.iter())
        .map(|p| NAMES.iter().position(|names| p.length.is_none() && names.contains(&p.name.as_str())))
        .collect();
    let has = |wanted: std::ops::Range<usize>| wanted.into_iter().all(|i| columns.contains(&Some(i)));
    if !has(0..3) {
        return Err(values.error("vertices without all of x, y, z", "these three properties"));
    }
    let (normals, uvs) = (has(3..6), has(6..8));
    for _ in 0..element.count {
        let mut row = [0.0; 8];
        for (property, column) in element.properties.iter().zip(&columns) {
            values.property(property, |value| {
                if let Some(column) = column {
                    row[*column] = value;
                }
            })?;
        }
        let [x, y, z, nx, ny, nz, u, v] = row;
        mesh.positions.push(DVec3::new(x, y, z));
        if normals {
            mesh.normals.push(Vec3::new(nx as f32, ny as f32, nz as f32));
        }
        if uvs {
            mesh.uvs.push(Vec2::new(u as f32, v as f32));
        }
    }
    Ok(())
}

fn triangles(element: &Element, values: &mut Values, mesh: &mut MeshData) -> Result<(), Error> {
    let is_corners = |p: &Property| p.length.is_some() && matches!(p.name.as_str(), "vertex_indices" | "vertex_index");
    if !element.properties.iter().any(is_corners) {
        return Err(values.error("faces without corners", "a list `vertex_indices`"));
    }
    let corners = mesh.positions.len();
    let mut polygon = Vec::new();
    for _ in 0..element.count {
        for property in &element.properties {
            if !is_corners(property) {
                values.property(property, |_| ())?;
                continue;
            }
            polygon.clear();
            let mut bad = None;
            let at = values.at;
            values.property(property, |value| {
                if value >= 0.0 && value < corners as f64 && value.fract() == 0.0 {
                    polygon.push(value as u32);
                } else {
                    bad = Some(value);
                }
            })?;
            if let Some(value) = bad {
                values.at = at;
                return Err(values.error(&format!("a face with the corner {value}"), &format!("0 to {corners} − 1")));
            }
            triangulate(&polygon, &mesh.positions, &mut mesh.triangles);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty double x\nproperty double y\n\
        property double z\nproperty float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_indices\n\
        property uchar flags\nend_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0.5 1 1\n0 1 0 0 1\n4 0 1 2 3 7\n";

    /// The same file in binary.
    fn binary(big: bool) -> Vec<u8> {
        let (head, body) = TEXT.split_once("end_header\n").expect("a header");
        let kind = if big { "binary_big_endian" } else { "binary_little_endian" };
        let mut out = format!("{}end_header\n", head.replace("ascii", kind)).into_bytes();
        let mut put = |mut bytes: Vec<u8>| {
            if big {
                bytes.reverse();
            }
            out.extend(bytes);
        };
        for (row, line) in body.lines().enumerate() {
            for (i, word) in line.split(' ').enumerate() {
                match (row, i) {
                    (4, 0 | 5) => put(vec![word.parse().expect("a byte")]),
                    (4, _) => put(word.parse::<i32>().expect("an index").to_le_bytes().to_vec()),
                    (_, 0..3) => put(word.parse::<f64>().expect("a number").to_le_bytes().to_vec()),
                    _ => put(word.parse::<f32>().expect("a number").to_le_bytes().to_vec()),
                }
            }
        }
        out
    }

    #[test]
    fn text_and_both_byte_orders_hold_the_same() {
        let mesh = read(TEXT.as_bytes()).expect("sound").mesh;
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions[2], DVec3::new(1.0, 1.0, 0.5));
        assert_eq!(mesh.uvs[1], Vec2::X);
        assert!(mesh.normals.is_empty());
        for big in [false, true] {
            assert_eq!(read(&binary(big)).expect("sound").mesh, mesh);
        }
    }

    #[test]
    fn a_file_cut_anywhere_is_refused_with_its_place() {
        let whole = binary(false);
        for end in 0..whole.len() {
            let error = read(&whole[..end]).expect_err("cut");
            assert!(error.to_string().contains("; expected "), "{error}");
        }
        // The last number of a text may lose digits unseen, here the unread `flags`.
        for end in 0..TEXT.len() - 2 {
            assert!(read(&TEXT.as_bytes()[..end]).is_err(), "{end}");
        }
    }

    #[test]
    fn what_is_wrong_is_said_where_it_stands() {
        for (from, to, expected) in [
            ("4 0 1 2 3", "4 0 1 2 9", "18:1: found a face with the corner 9; expected 0 to 4 − 1"),
            ("1 0 0 1 0", "1 0 zero 1 0", "15:5: found `zero`; expected a number"),
            ("vertex 4", "vertex 4000000000", "14:1: found 4000000000 of `vertex` in 54 bytes; expected no more"),
            ("double z", "double w", "14:1: found vertices without all of x, y, z"),
            ("property double x", "property half x", "5:1: found the type `half`"),
            ("ascii", "utf-8", "2:1: found format utf-8 1.0; expected ascii"),
        ] {
            let error = read(TEXT.replace(from, to).as_bytes()).expect_err(to).to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
