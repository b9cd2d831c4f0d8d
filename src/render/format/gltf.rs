//! glTF 2.0, as text (`.gltf`) with its buffers beside or inside it, and binary (`.glb`): triangles in their places.
//!
//! A mesh for each primitive of each node of the scene (the default one, else the first, else every node without a parent). Positions
//! are in the scene's coordinates, m; glTF's +y is up, which becomes +z: (x, y, z) → (x, −z, y). Texture coordinates become those of
//! this crate, v upwards. Nodes that mirror keep the outside outside. Materials, skins, cameras, lights, animations and morph targets are
//! passed over, as are points and lines.
//!
//! Limits: no sparse accessors, no compressed geometry (an extension that the file requires and that changes geometry is refused).
//!
//! Source: Khronos Group, *glTF 2.0 Specification* (ISO/IEC 12113:2022).

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3, Vec2, Vec3};
use serde::Deserialize;

use super::{Error, Object, Place};
use crate::render::mesh::MeshData;

/// More triangles or corners than this, all copies counted, are refused: a small file can ask for many copies.
const MOST: usize = 1 << 26;
/// Extensions that a file may require, because they leave the geometry as it is.
const HARMLESS: [&str; 3] = ["KHR_materials_", "KHR_texture_", "KHR_lights_"];

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
#[derive(Default)]
struct Document {
    scene: Option<usize>,
    scenes: Vec<Scene>,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    materials: Vec<Named>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<View>,
    buffers: Vec<Buffer>,
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Named {
    name: Option<String>,
}

#[derive(Deserialize)]
struct Node {
    name: Option<String>,
    mesh: Option<usize>,
    #[serde(default)]
    children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Mesh {
    name: Option<String>,
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    material: Option<usize>,
    mode: Option<u32>,
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
    #[serde(rename = "NORMAL")]
    normal: Option<usize>,
    #[serde(rename = "TEXCOORD_0")]
    uv: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    #[serde(default)]
    normalized: bool,
    count: usize,
    r#type: String,
    sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct View {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    uri: Option<String>,
    byte_length: usize,
}

fn refused(found: impl Into<String>, expected: &str) -> Error {
    Error { place: Place::Byte(0), found: found.into(), expected: expected.to_owned() }
}

/// Reads a glTF file; `beside` gives the bytes of a file that it names, or says why not.
///
/// # Errors
/// Where something else stands than the format asks for; a file without triangles; what `beside` says.
pub fn read(bytes: &[u8], beside: impl FnMut(&str) -> Result<Vec<u8>, String>) -> Result<Vec<Object>, Error> {
    let (json, binary) = chunks(bytes)?;
    let document: Document = serde_json::from_slice(json).map_err(|e| {
        // Its own place stands before it.
        let message = e.to_string();
        let found = message.rsplit_once(" at line ").map_or(message.as_str(), |(found, _)| found).to_owned();
        Error { place: Place::Line(e.line(), e.column().max(1)), found, expected: "glTF 2.0".to_owned() }
    })?;
    let unknown = |e: &&String| !HARMLESS.iter().any(|start| e.starts_with(start));
    if let Some(extension) = document.extensions_required.iter().find(unknown) {
        return Err(refused(format!("the extension `{extension}`, which the file requires"), "plain geometry"));
    }
    let buffers = buffers(&document, binary, beside)?;
    let mut reader = Reader { document: &document, buffers, objects: Vec::new(), size: 0 };
    let mut seen = vec![false; document.nodes.len()];
    // +y up becomes +z up.
    let upright = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y));
    let mut open: Vec<(usize, DAffine3)> = roots(&document)?.into_iter().rev().map(|n| (n, upright)).collect();
    while let Some((index, parent)) = open.pop() {
        let node =
            document.nodes.get(index).ok_or_else(|| refused(format!("no node {index}"), "a node that is there"))?;
        if std::mem::replace(&mut seen[index], true) {
            return Err(refused(format!("node {index} in two places"), "a tree of nodes"));
        }
        let to_world = parent * node.placement();
        if let Some(mesh) = node.mesh {
            reader.mesh(mesh, node, to_world)?;
        }
        open.extend(node.children.iter().rev().map(|child| (*child, to_world)));
    }
    if reader.objects.is_empty() {
        return Err(refused("a scene without triangles", "a mesh"));
    }
    Ok(reader.objects)
}

/// The JSON text, and the binary chunk of a `.glb`.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Error> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else { return Ok((bytes, None)) };
    let word = |at: usize| rest.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let cut = |at| Error {
        place: Place::Byte(at),
        found: "the end of the file".to_owned(),
        expected: "a chunk of glTF".to_owned(),
    };
    if word(0) != Some(2) {
        let found = word(0).map_or_else(|| "no version".to_owned(), |v| format!("version {v}"));
        return Err(Error { place: Place::Byte(4), found, expected: "version 2".to_owned() });
    }
    let (mut json, mut binary, mut at) = (None, None, 8);
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let chunk =
            (at + 8).checked_add(length as usize).and_then(|end| rest.get(at + 8..end)).ok_or_else(|| cut(at + 4))?;
        match kind {
            0x4E4F_534A => json = json.or(Some(chunk)),
            0x004E_4942 => binary = binary.or(Some(chunk)),
            _ => {}
        }
        at += 8 + chunk.len();
    }
    Ok((json.ok_or_else(|| cut(12))?, binary))
}

fn buffers(
    document: &Document,
    binary: Option<&[u8]>,
    mut beside: impl FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Vec<Vec<u8>>, Error> {
    let mut out = Vec::with_capacity(document.buffers.len());
    for (n, buffer) in document.buffers.iter().enumerate() {
        let bytes = match buffer.uri.as_deref() {
            None => binary.filter(|_| n == 0).map(<[u8]>::to_vec).ok_or_else(|| {
                refused(format!("buffer {n} without a `uri` and without a binary chunk"), "the bytes of a buffer")
            })?,
            Some(uri) if uri.starts_with("data:") => (uri.split_once(";base64,"))
                .and_then(|(_, text)| base64(text))
                .ok_or_else(|| refused(format!("a `uri` of buffer {n} that is no base64"), "data:…;base64,…"))?,
            Some(uri) => beside(&percent(uri)).map_err(|e| refused(e, "the file of a buffer"))?,
        };
        if bytes.len() < buffer.byte_length {
            let found = format!("{} bytes of buffer {n}", bytes.len());
            return Err(refused(found, &format!("{} of them", buffer.byte_length)));
        }
        out.push(bytes);
    }
    Ok(out)
}

fn roots(document: &Document) -> Result<Vec<usize>, Error> {
    if let Some(scene) = document.scene.or((!document.scenes.is_empty()).then_some(0)) {
        let found = document.scenes.get(scene);
        return found
            .map(|s| s.nodes.clone())
            .ok_or_else(|| refused(format!("no scene {scene}"), "a scene that is there"));
    }
    let children: Vec<usize> = document.nodes.iter().flat_map(|n| n.children.iter().copied()).collect();
    Ok((0..document.nodes.len()).filter(|n| !children.contains(n)).collect())
}

impl Node {
    fn placement(&self) -> DAffine3 {
        if let Some(matrix) = &self.matrix {
            return DAffine3::from_mat4(DMat4::from_cols_array(matrix));
        }
        let rotation = self.rotation.map_or(DQuat::IDENTITY, |[x, y, z, w]| DQuat::from_xyzw(x, y, z, w).normalize());
        let scale = DVec3::from_array(self.scale.unwrap_or([1.0; 3]));
        DAffine3::from_scale_rotation_translation(scale, rotation, self.translation.unwrap_or_default().into())
    }
}

struct Reader<'a> {
    document: &'a Document,
    buffers: Vec<Vec<u8>>,
    objects: Vec<Object>,
    size: usize,
}

impl Reader<'_> {
    fn mesh(&mut self, index: usize, node: &Node, to_world: DAffine3) -> Result<(), Error> {
        let document = self.document;
        let mesh =
            document.meshes.get(index).ok_or_else(|| refused(format!("no mesh {index}"), "a mesh that is there"))?;
        let turn = to_world.matrix3.inverse().transpose();
        let mirrored = to_world.matrix3.determinant() < 0.0;
        for primitive in &mesh.primitives {
            let (mode, Some(position)) = (primitive.mode.unwrap_or(4), primitive.attributes.position) else { continue };
            if !(4..=6).contains(&mode) {
                continue;
            }
            let positions: Vec<DVec3> = (self.values(position, 3)?.chunks_exact(3))
                .map(|p| to_world.transform_point3(DVec3::from_slice(p)))
                .collect();
            let normals: Vec<Vec3> = match primitive.attributes.normal {
                Some(accessor) => (self.values(accessor, 3)?.chunks_exact(3))
                    .map(|n| (turn * DVec3::from_slice(n)).normalize_or_zero().as_vec3())
                    .collect(),
                None => Vec::new(),
            };
            let uvs: Vec<Vec2> = match primitive.attributes.uv {
                Some(accessor) => (self.values(accessor, 2)?.chunks_exact(2))
                    .map(|t| Vec2::new(t[0] as f32, 1.0 - t[1] as f32))
                    .collect(),
                None => Vec::new(),
            };
            let corners: Vec<u32> = match primitive.indices {
                Some(accessor) => self.indices(accessor)?,
                None => (0..u32::try_from(positions.len()).unwrap_or(u32::MAX)).collect(),
            };
            for (what, count) in [("NORMAL", normals.len()), ("TEXCOORD_0", uvs.len())] {
                if count != 0 && count != positions.len() {
                    let found = format!("{count} of {what} in mesh {index}");
                    return Err(refused(found, &format!("{}, as many as positions", positions.len())));
                }
            }
            if let Some(corner) = corners.iter().find(|&&c| c as usize >= positions.len()) {
                let found = format!("the index {corner} in mesh {index}");
                return Err(refused(found, &format!("one of 0..{}", positions.len())));
            }
            let mut triangles = assembled(mode, &corners);
            if mirrored {
                triangles.iter_mut().for_each(|t| t.swap(1, 2));
            }
            self.size += triangles.len().max(positions.len());
            if self.size > MOST {
                return Err(refused("too many triangles or corners", &format!("at most {MOST}, all copies counted")));
            }
            if triangles.is_empty() {
                continue;
            }
            let material = primitive.material.and_then(|m| document.materials.get(m)).and_then(|m| m.name.clone());
            let name = node.name.clone().or_else(|| mesh.name.clone());
            self.objects.push(Object { name, material, mesh: MeshData { positions, triangles, normals, uvs } });
        }
        Ok(())
    }

    /// The bytes of an accessor: where its elements begin, their distance, and how many components of how many bytes they have.
    fn bytes(&self, index: usize, components: usize) -> Result<(&[u8], usize, &Accessor), Error> {
        let accessor = (self.document.accessors.get(index))
            .ok_or_else(|| refused(format!("no accessor {index}"), "an accessor that is there"))?;
        let name = match components {
            1 => "SCALAR",
            2 => "VEC2",
            _ => "VEC3",
        };
        if accessor.r#type != name || accessor.sparse.is_some() {
            let what = if accessor.sparse.is_some() { "sparse" } else { &accessor.r#type };
            return Err(refused(format!("accessor {index} of type {what}"), &format!("{name}, not sparse")));
        }
        let size = components * component_size(accessor.component_type)?;
        let short = || refused(format!("accessor {index} beyond its buffer"), "as many bytes as it has elements");
        let view = accessor.buffer_view.and_then(|v| self.document.buffer_views.get(v)).ok_or_else(short)?;
        let buffer = self.buffers.get(view.buffer).ok_or_else(short)?;
        let end = view.byte_offset.checked_add(view.byte_length).ok_or_else(short)?;
        let bytes = buffer.get(view.byte_offset..end).and_then(|b| b.get(accessor.byte_offset..)).ok_or_else(short)?;
        let stride = view.byte_stride.unwrap_or(size).max(size);
        let last = accessor.count.checked_sub(1).map(|n| n.checked_mul(stride).and_then(|b| b.checked_add(size)));
        match last {
            Some(needed) if needed.is_none_or(|needed| needed > bytes.len()) => Err(short()),
            _ => Ok((bytes, stride, accessor)),
        }
    }

    fn values(&self, index: usize, components: usize) -> Result<Vec<f64>, Error> {
        let (bytes, stride, accessor) = self.bytes(index, components)?;
        let size = component_size(accessor.component_type)?;
        let elements = (0..accessor.count).flat_map(|n| (0..components).map(move |c| n * stride + c * size));
        Ok(elements
            .map(|at| {
                let whole = |value: f64, most: f64| if accessor.normalized { (value / most).max(-1.0) } else { value };
                match accessor.component_type {
                    5120 => whole(f64::from(bytes[at].cast_signed()), 127.0),
                    5121 => whole(f64::from(bytes[at]), 255.0),
                    5122 => whole(f64::from(i16::from_le_bytes([bytes[at], bytes[at + 1]])), 32767.0),
                    5123 => whole(f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])), 65535.0),
                    5125 => f64::from(u32::from_le_bytes(four(&bytes[at..]))),
                    _ => f64::from(f32::from_le_bytes(four(&bytes[at..]))),
                }
            })
            .collect())
    }

    fn indices(&self, index: usize) -> Result<Vec<u32>, Error> {
        let (bytes, stride, accessor) = self.bytes(index, 1)?;
        let one = |at: usize| match accessor.component_type {
            5121 => Ok(u32::from(bytes[at])),
            5123 => Ok(u32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]))),
            5125 => Ok(u32::from_le_bytes(four(&bytes[at..]))),
            other => Err(refused(format!("indices of component type {other}"), "unsigned integers")),
        };
        (0..accessor.count).map(|n| one(n * stride)).collect()
    }
}

fn four(bytes: &[u8]) -> [u8; 4] {
    [bytes[0], bytes[1], bytes[2], bytes[3]]
}

fn component_size(kind: u32) -> Result<usize, Error> {
    match kind {
        5120 | 5121 => Ok(1),
        5122 | 5123 => Ok(2),
        5125 | 5126 => Ok(4),
        other => Err(refused(format!("component type {other}"), "one of 5120 to 5123, 5125, 5126")),
    }
}

/// Triangles (4), a strip (5) or a fan (6).
fn assembled(mode: u32, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        4 => corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        5 => (corners.windows(3).enumerate())
            .map(|(n, t)| if n % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] })
            .collect(),
        _ => (corners.get(1..).unwrap_or_default().windows(2)).map(|t| [corners[0], t[0], t[1]]).collect(),
    }
}

/// The bytes of a base64 text (RFC 4648, padding or none).
fn base64(text: &str) -> Option<Vec<u8>> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => Some(c - b'A'),
        b'a'..=b'z' => Some(c - b'a' + 26),
        b'0'..=b'9' => Some(c - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    };
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    for group in text.trim_end_matches('=').as_bytes().chunks(4) {
        let mut bits = 0_u32;
        for c in group {
            bits = bits << 6 | u32::from(digit(*c)?);
        }
        bits <<= 6 * (4 - group.len());
        out.extend_from_slice(bits.to_be_bytes().get(1..group.len())?);
    }
    Some(out)
}

/// A relative address with its `%20` undone; what is no such escape stays.
fn percent(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let (mut out, mut at) = (Vec::with_capacity(bytes.len()), 0);
    while at < bytes.len() {
        let escaped = (bytes[at] == b'%').then(|| uri.get(at + 1..at + 3)).flatten();
        match escaped.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                out.push(byte);
                at += 3;
            }
            None => {
                out.push(bytes[at]);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A right triangle in glTF's x-y plane, with normals, texture coordinates and 16-bit indices, under a node that doubles it and
    /// moves it by (0, 1, 0), and under one that mirrors it.
    fn text() -> (String, Vec<u8>) {
        let mut bytes = Vec::new();
        for p in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            p.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        (0..3).for_each(|_| [0.0_f32, 0.0, 1.0].iter().for_each(|x| bytes.extend(x.to_le_bytes())));
        for t in [[0.0_f32, 1.0], [1.0, 1.0], [0.0, 0.0]] {
            t.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        [0_u16, 1, 2].iter().for_each(|i| bytes.extend(i.to_le_bytes()));
        let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
            "nodes":[{"name":"a","mesh":0,"scale":[2,2,2],"translation":[0,1,0]},{"children":[2]},{"mesh":0,"scale":[-1,1,1]}],
            "meshes":[{"name":"triangle","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3}]}],
            "accessors":[
              {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
              {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
              {"bufferView":0,"byteOffset":72,"componentType":5126,"count":3,"type":"VEC2"},
              {"bufferView":0,"byteOffset":96,"componentType":5123,"count":3,"type":"SCALAR"}],
            "bufferViews":[{"buffer":0,"byteLength":102}],
            "buffers":[{"uri":"a%20b.bin","byteLength":102}]}"#;
        (json.to_owned(), bytes)
    }

    #[test]
    fn triangles_stand_in_their_places() {
        let (json, bytes) = text();
        let objects =
            read(json.as_bytes(), |name| (name == "a b.bin").then(|| bytes.clone()).ok_or_else(|| name.to_owned()));
        let objects = objects.expect("sound");
        let [doubled, mirrored] = [&objects[0], &objects[1]];
        assert_eq!((doubled.name.as_deref(), mirrored.name.as_deref()), (Some("a"), Some("triangle")));
        // glTF's (0, 1, 0) + 2·(0, 1, 0) is three metres up.
        assert_eq!(doubled.mesh.positions, [DVec3::Z, DVec3::new(2.0, 0.0, 1.0), 3.0 * DVec3::Z]);
        // The triangle looks along glTF's +z, which is −y here, and so do its normals; mirrored along x it does still.
        for object in [doubled, mirrored] {
            let [a, b, c] = object.mesh.triangles[0].map(|i| object.mesh.positions[i as usize]);
            assert_eq!((b - a).cross(c - a).normalize(), DVec3::NEG_Y);
            assert_eq!(object.mesh.normals, [Vec3::NEG_Y; 3]);
        }
        assert_eq!(doubled.mesh.uvs, [Vec2::ZERO, Vec2::X, Vec2::Y]);
    }

    #[test]
    fn binary_files_and_inline_buffers_are_the_same() {
        let (json, bytes) = text();
        let plain = read(json.as_bytes(), |_| Ok(bytes.clone())).expect("sound");
        let none = |_: &str| Err("nothing is beside it".to_owned());
        let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let coded: String = (bytes.chunks(3))
            .flat_map(|c| {
                let bits = c.iter().fold(0_u32, |bits, b| bits << 8 | u32::from(*b));
                (0..4).map(move |n| char::from(digits[(bits >> (18 - 6 * n) & 63) as usize]))
            })
            .collect();
        let inline = json.replace("a%20b.bin", &format!("data:application/octet-stream;base64,{coded}"));
        assert_eq!(read(inline.as_bytes(), none).expect("sound"), plain);
        let mut inner = json.replace("\"uri\":\"a%20b.bin\",", "").into_bytes();
        inner.resize(inner.len().next_multiple_of(4), b' ');
        let mut glb = b"glTF".to_vec();
        for (kind, chunk) in [(0x4E4F_534A_u32, &inner), (0x004E_4942, &bytes)] {
            if glb.len() == 4 {
                glb.extend(2_u32.to_le_bytes());
                glb.extend(0_u32.to_le_bytes());
            }
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind.to_le_bytes());
            glb.extend(chunk);
        }
        assert_eq!(read(&glb, none).expect("sound"), plain);
        assert!(read(&glb[..glb.len() - 1], none).is_err());
    }

    #[test]
    fn what_is_wrong_is_said() {
        let (json, bytes) = text();
        for (from, to, message) in [
            ("\"count\":3,\"type\":\"VEC3\"", "\"count\":300,\"type\":\"VEC3\"", "accessor 0 beyond its buffer"),
            ("\"indices\":3", "\"indices\":0", "accessor 0 of type VEC3"),
            ("\"indices\":3", "\"indices\":9", "no accessor 9"),
            ("\"byteOffset\":96,", "\"byteOffset\":14,", "in mesh 0; expected one of 0..3"),
            (
                "\"byteOffset\":36,\"componentType\":5126,\"count\":3",
                "\"byteOffset\":36,\"componentType\":5126,\"count\":2",
                "2 of NORMAL",
            ),
            ("\"children\":[2]", "\"children\":[1]", "node 1 in two places"),
            ("\"children\":[2]", "\"children\":[7]", "no node 7"),
            ("\"asset\"", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\"", "KHR_draco"),
            ("\"byteLength\":102}]}", "\"byteLength\":103}]}", "102 bytes of buffer 0"),
            ("{\"asset\"", "{\"asset\":1,}", "glTF 2.0"),
            ("\"nodes\":[0,1]", "\"nodes\":[]", "a scene without triangles"),
        ] {
            assert!(json.contains(from), "{from}");
            let error =
                read(json.replacen(from, to, 1).as_bytes(), |_| Ok(bytes.clone())).expect_err(message).to_string();
            assert!(error.contains(message), "{error}");
        }
        assert!(
            read(json.as_bytes(), |_| Err("no such file".to_owned()))
                .expect_err("none")
                .to_string()
                .contains("no such file")
        );
    }
}
