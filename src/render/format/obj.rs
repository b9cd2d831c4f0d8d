//! Wavefront OBJ: corners, texture coordinates, normals, faces, objects, groups and the names of materials.
//!
//! A mesh for each object (`o`, or `g` where there is none) and material (`usemtl`) that has faces. What a material is stands in the
//! scene, so `mtllib` is passed over, as are lines, points and free-form surfaces. Corners that a face names by negative numbers count
//! from the last one read. A mesh of which any corner has no normal (texture coordinates) has none.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

use super::{Error, Object, Place, triangulate};

/// Reads an OBJ file.
///
/// # Errors
///
/// Where something else stands than the format asks for; a file without faces.
pub fn read(bytes: &[u8]) -> Result<Vec<Object>, Error> {
    let mut reader = Reader::default();
    let mut lines = 0;
    for (number, line) in (1..).zip(bytes.split(|&b| b == b'\n')) {
        lines = number;
        reader.line(number, &String::from_utf8_lossy(line))?;
    }
    let objects = reader.finish();
    if objects.is_empty() {
        return Err(Error {
            place: Place::Line(lines, 1),
            found: "the end of the file without a face".to_owned(),
            expected: "a mesh with faces".to_owned(),
        });
    }
    Ok(objects)
}

/// A corner of a face: which position, texture coordinate and normal.
type Corner = (u32, Option<u32>, Option<u32>);

/// A mesh that grows.
#[derive(Default)]
struct Part {
    object: Object,
    corners: HashMap<Corner, u32>,
}

#[derive(Default)]
struct Reader {
    positions: Vec<DVec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    object: Option<String>,
    material: Option<String>,
    parts: Vec<Part>,
    /// Parts by name and material.
    known: HashMap<(Option<String>, Option<String>), usize>,
    /// An object was named: groups are its parts, not objects.
    named: bool,
    /// The last line, where it goes on.
    open: String,
}

impl Reader {
    fn line(&mut self, number: usize, line: &str) -> Result<(), Error> {
        let line = line.trim_end();
        if let Some(begun) = line.strip_suffix('\\') {
            self.open.push_str(begun);
            self.open.push(' ');
            return Ok(());
        }
        let whole = std::mem::take(&mut self.open) + line;
        let text = whole.split('#').next().unwrap_or_default();
        let words = Words { text, number };
        let mut all = text.split_ascii_whitespace();
        let Some(keyword) = all.next() else { return Ok(()) };
        let name = || Some(text.trim()[keyword.len()..].trim().to_owned()).filter(|name| !name.is_empty());
        match keyword {
            "v" => {
                let [x, y, z] = words.numbers(all)?;
                self.positions.push(DVec3::new(x, y, z));
            }
            "vn" => {
                let [x, y, z] = words.numbers(all)?;
                self.normals.push(Vec3::new(x as f32, y as f32, z as f32));
            }
            "vt" => {
                // The second coordinate of a one-dimensional texture is 0.
                let [u, v] = words.numbers(all.chain(["0"]))?;
                self.uvs.push(Vec2::new(u as f32, v as f32));
            }
            "f" => self.face(&words, all)?,
            "o" => {
                self.object = name();
                self.named = true;
            }
            "g" if !self.named => self.object = name(),
            "usemtl" => self.material = name(),
            _ => {}
        }
        Ok(())
    }

    fn face<'a>(&mut self, words: &Words, corners: impl Iterator<Item = &'a str>) -> Result<(), Error> {
        let mut face: Vec<Corner> = Vec::new();
        for word in corners {
            let mut fields = word.split('/');
            let index = |field: Option<&str>, count: usize| match field {
                None | Some("") => Ok(None),
                Some(field) => words.index(field, count).map(Some),
            };
            let position = index(fields.next(), self.positions.len())?;
            let uv = index(fields.next(), self.uvs.len())?;
            let normal = index(fields.next(), self.normals.len())?;
            let (Some(position), None) = (position, fields.next()) else {
                return Err(words.error(word, "a corner as v, v/vt, v//vn or v/vt/vn"));
            };
            face.push((position, uv, normal));
        }
        if face.len() < 3 {
            return Err(words.error("f", "at least three corners of a face"));
        }
        let key = (self.object.clone(), self.material.clone());
        let index = *self.known.entry(key).or_insert_with(|| {
            let object = Object { name: self.object.clone(), material: self.material.clone(), ..Object::default() };
            self.parts.push(Part { object, corners: HashMap::new() });
            self.parts.len() - 1
        });
        let Part { object, corners } = &mut self.parts[index];
        let mesh = &mut object.mesh;
        let mut polygon = Vec::with_capacity(face.len());
        for corner in face {
            let new = *corners.entry(corner).or_insert_with(|| {
                mesh.positions.push(self.positions[corner.0 as usize]);
                // Lists that stay shorter than the corners are dropped in the end.
                mesh.uvs.extend(corner.1.map(|i| self.uvs[i as usize]));
                mesh.normals.extend(corner.2.map(|i| self.normals[i as usize]));
                mesh.positions.len() as u32 - 1
            });
            polygon.push(new);
        }
        triangulate(&polygon, &mesh.positions, &mut mesh.triangles);
        Ok(())
    }

    fn finish(self) -> Vec<Object> {
        let close = |part: Part| {
            let mut object = part.object;
            let corners = object.mesh.positions.len();
            if object.mesh.uvs.len() < corners {
                object.mesh.uvs.clear();
            }
            if object.mesh.normals.len() < corners {
                object.mesh.normals.clear();
            }
            object
        };
        self.parts.into_iter().map(close).collect()
    }
}

/// A line and its number, for messages.
struct Words<'a> {
    text: &'a str,
    number: usize,
}

impl Words<'_> {
    fn error(&self, word: &str, expected: &str) -> Error {
        // A word is a piece of the text, or was put behind it.
        let column = (word.as_ptr() as usize).checked_sub(self.text.as_ptr() as usize).filter(|c| *c < self.text.len());
        Error {
            place: Place::Line(self.number, column.unwrap_or(0) + 1),
            found: format!("`{word}`"),
            expected: expected.to_owned(),
        }
    }

    fn numbers<'a, const N: usize>(&self, mut words: impl Iterator<Item = &'a str>) -> Result<[f64; N], Error> {
        let mut out = [0.0; N];
        for value in &mut out {
            let word = words.next().ok_or_else(|| self.error(self.text, &format!("{N} numbers")))?;
            *value = word.parse().map_err(|_| self.error(word, "a number"))?;
        }
        Ok(out)
    }

    /// An index from 1, or from the end if negative; from 0.
    fn index(&self, word: &str, count: usize) -> Result<u32, Error> {
        let expected = || format!("an index of 1 to {count}, or −{count} to −1");
        let given: i64 = word.parse().map_err(|_| self.error(word, &expected()))?;
        let from_zero = if given < 0 { given.checked_add_unsigned(count as u64) } else { given.checked_sub(1) };
        from_zero
            .filter(|i| usize::try_from(*i).is_ok_and(|i| i < count))
            .and_then(|i| u32::try_from(i).ok())
            .ok_or_else(|| self.error(word, &expected()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_materials_and_shared_corners() {
        let text = "# two\nmtllib a.mtl\no base plate\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\nvt 0.5\nvn 0 0 1\nusemtl red\n\
            f 1/1/1 2/1/1 \\\n 3/1/1 4/1/1\nusemtl blue\nf -4 -3 -2\ng part\nf 1 2 4 # again\r\nusemtl red\nf 1//1 2//1 3//1\n";
        let objects = read(text.as_bytes()).expect("sound");
        assert_eq!(objects.len(), 2);
        let [red, blue] = [&objects[0], &objects[1]];
        assert_eq!((red.name.as_deref(), red.material.as_deref()), (Some("base plate"), Some("red")));
        assert_eq!(red.mesh.triangles[..2], [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(red.mesh.normals, [Vec3::Z; 7]);
        assert!(red.mesh.uvs.is_empty(), "the last face has none");
        assert_eq!(blue.mesh.triangles, [[0, 1, 2], [0, 1, 3]]);
        assert_eq!(blue.mesh.positions[3], DVec3::Y);
    }

    #[test]
    fn what_is_wrong_is_said_where_it_stands() {
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
        for (text, expected) in [
            ("", "1:1: found the end of the file without a face; expected"),
            ("v 1 2", "1:1: found `v 1 2`; expected 3 numbers"),
            ("v 1 2 x", "1:7: found `x`; expected a number"),
            (&format!("{corners}f 1 2"), "4:1: found `f`; expected at least three corners"),
            (&format!("{corners}f 1 2 4"), "4:7: found `4`; expected an index of 1 to 3, or −3 to −1"),
            (&format!("{corners}f 1 2 0"), "4:7: found `0`; expected an index"),
            (&format!("{corners}f 1 2 -9223372036854775808"), "4:7: found"),
            (&format!("{corners}f 1/1 2 3"), "4:5: found `1`; expected an index of 1 to 0"),
            (&format!("{corners}f 1/// 2 3"), "4:3: found `1///`; expected a corner"),
        ] {
            let error = read(text.as_bytes()).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }

    #[test]
    fn a_quadrilateral_with_a_dent_is_cut_through_the_dent() {
        let text = "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 4 1 2 3\n";
        let mesh = &read(text.as_bytes()).expect("sound")[0].mesh;
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        // The shoelace formula by hand: two triangles of 1/2 each.
        assert_eq!(mesh.triangles.iter().map(area).collect::<Vec<_>>(), [0.5, 0.5]);
    }
}
