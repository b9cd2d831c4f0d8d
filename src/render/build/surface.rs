//! Shapes and what they emit.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use toml::Spanned;

use super::analysis::is_flat;
use super::colour::Colour;
use super::material::Named;
use super::reach::LeftOut;
use super::{Builder, Incomplete, Quantities};
use crate::brdf::lambert::Lambert;
use crate::render::bands::Bands;
use crate::render::description::Error;
use crate::render::description::light::Lamp;
use crate::render::description::surface::{Emission as Emitted, Mesh as DescribedMesh, Shape as Described, Step};
use crate::render::emission::Emission;
use crate::render::material::Material;
use crate::render::material::opaque::Opaque;
use crate::render::mesh::Mesh;
use crate::render::placed::PlacedMesh;
use crate::render::scene::Part;
use crate::render::shape::Shape;
use crate::render::shape::cylinder::Cylinder;
use crate::render::shape::disk::Disk;
use crate::render::shape::error::ShapeError;
use crate::render::shape::plane::Plane;
use crate::render::shape::polygon::Polygon;
use crate::render::shape::polyhedron::Polyhedron;
use crate::render::shape::rectangle::Rectangle;
use crate::render::shape::sphere::Sphere;
use crate::render::shape::triangle::Triangle;

/// The surfaces of a shape, or why there are none.
type Faces = Result<Vec<Arc<dyn Shape>>, ShapeError>;

/// Meshes by the name of their file, and whether without normals.
type Known = HashMap<(String, bool), Vec<Arc<Mesh>>>;

/// Files of meshes that were read, and their trees.
#[derive(Debug, Default)]
pub struct Meshes {
    known: RefCell<Known>,
    /// Those that lost triangles.
    incomplete: RefCell<Vec<Incomplete>>,
}

impl Meshes {
    /// Those that lost triangles.
    pub(super) fn incomplete(&self) -> Vec<Incomplete> {
        self.incomplete.borrow().clone()
    }
}

/// The name of a shape in reports.
pub(super) fn name(shape: &Described, number: usize) -> String {
    shape.name.as_ref().map_or_else(|| format!("shape {}", number + 1), |n| n.get_ref().clone())
}

impl Builder<'_> {
    /// All surfaces, and which of them each described shape is; what is left out does not shine. Those of a build with other bands are taken as
    /// they are.
    pub(super) fn parts(
        &self,
        materials: &[Named],
        bands: &Bands,
        quantities: &Quantities,
        left_out: &LeftOut,
        built: Option<(&[Part], &[Range<usize>])>,
    ) -> Result<(Vec<Part>, Vec<Range<usize>>), Error> {
        let black = Lambert::new(vec![0.0; bands.len()]).expect("a reflectance of 0");
        let black: Arc<dyn Material> = Arc::new(Opaque::new(Box::new(black), true));
        let (mut parts, mut ranges) = (Vec::new(), Vec::new());
        for (number, shape) in self.description.shape.iter().enumerate() {
            let material = match &shape.material {
                None => Arc::clone(&black),
                Some(wanted) => self.named(materials, wanted)?,
            };
            let faces = match built {
                Some((parts, surfaces)) => {
                    parts[surfaces[number].clone()].iter().map(|part| Arc::clone(&part.shape)).collect()
                }
                None => self.faces(shape, number)?,
            };
            // Asked for where it is needed: that of a mesh is added up over all triangles.
            let area = || faces.iter().map(|f| f.area()).sum::<f64>();
            if let Some(e) = shape.emission.as_ref().filter(|_| !area().is_finite()) {
                return Err(self.wrong(&e.span(), "a plane without bounds that emits; expected a shape of finite area"));
            }
            ranges.push(parts.len()..parts.len() + faces.len());
            let first = parts.len();
            let emission = match shape.emission.as_ref().filter(|_| !left_out.shapes.contains(&number)) {
                None => None,
                Some(e) if e.get_ref().lamp.is_some() => {
                    Some(Arc::new(self.lamp_emission(shape, e, &faces, bands, quantities)?))
                }
                Some(e) => Some(Arc::new(self.emission(e.get_ref(), &e.span(), area(), bands, quantities)?)),
            };
            parts.extend(faces.into_iter().enumerate().map(|(face, shape)| Part {
                shape,
                material: Arc::clone(&material),
                emission: emission.clone().filter(|_| !left_out.surfaces.contains(&(first + face))),
            }));
        }
        Ok((parts, ranges))
    }

    /// The surfaces of a described shape.
    fn faces(&self, shape: &Described, number: usize) -> Result<Vec<Arc<dyn Shape>>, Error> {
        let v = DVec3::from_array;
        let mut out: Vec<(Range<usize>, Faces)> = Vec::new();
        fn one<S: Shape + 'static>(shape: Result<S, ShapeError>) -> Faces {
            shape.map(|s| vec![Arc::new(s) as Arc<dyn Shape>])
        }
        if let Some(s) = &shape.sphere {
            out.push((s.span(), one(Sphere::new(v(s.get_ref().centre), s.get_ref().radius.0))));
        }
        if let Some(s) = &shape.plane {
            out.push((s.span(), one(Plane::new(v(s.get_ref().point), v(s.get_ref().normal)))));
        }
        if let Some(s) = &shape.disk {
            let d = s.get_ref();
            let disk = match d.inner_radius {
                None => Disk::new(v(d.centre), v(d.normal), d.radius.0),
                Some(inner) => Disk::annulus(v(d.centre), v(d.normal), d.radius.0, inner.0),
            };
            out.push((s.span(), one(disk)));
        }
        if let Some(s) = &shape.rectangle {
            let [a, b] = s.get_ref().edges;
            out.push((s.span(), one(Rectangle::new(v(s.get_ref().corner), v(a), v(b)))));
        }
        if let Some(s) = &shape.polygon {
            out.push((s.span(), one(Polygon::new(s.get_ref().corners.iter().copied().map(v).collect()))));
        }
        if let Some(s) = &shape.triangle {
            let [a, b, c] = s.get_ref().corners.map(v);
            out.push((s.span(), one(Triangle::new(a, b, c))));
        }
        if let Some(s) = &shape.polyhedron {
            let p = s.get_ref();
            let vertices: Vec<DVec3> = p.vertices.iter().copied().map(v).collect();
            out.push((s.span(), one(Polyhedron::new(&vertices, &p.faces))));
        }
        if let Some(s) = &shape.cuboid {
            let c = s.get_ref();
            out.push((s.span(), cuboid(v(c.from), v(c.to), c.inwards)));
        }
        if let Some(s) = &shape.cylinder {
            let c = s.get_ref();
            out.push((s.span(), one(Cylinder::new(v(c.from), v(c.to), c.radius.0, c.closed))));
        }
        if let Some(m) = &shape.mesh {
            let pattern = shape.material.as_ref().and_then(|name| Some((name, self.pattern(name.get_ref())?)));
            out.push((m.span(), Ok(self.meshes(m.get_ref(), &m.span(), pattern)?)));
        }
        let mut kinds = out.into_iter();
        match (kinds.next(), kinds.next()) {
            (Some((span, faces)), None) => faces.map_err(|e| self.wrong(&span, e)),
            (first, _) => {
                let at = first.map(|f| f.0).or_else(|| shape.name.as_ref().map(Spanned::span)).unwrap_or(0..0);
                let message = format!(
                    "{} has not one kind; expected one of sphere, plane, disk, rectangle, triangle, polygon, polyhedron, box, cylinder, mesh",
                    name(shape, number)
                );
                Err(self.wrong(&at, message))
            }
        }
    }

    /// What varies over the texture coordinates in a material.
    fn pattern(&self, material: &str) -> Option<&'static str> {
        let found = self.description.material.iter().find(|m| m.name.get_ref() == material)?;
        let texture = found.texture.is_some().then_some("texture");
        texture.or_else(|| found.checkerboard.is_some().then_some("checkerboard"))
    }

    /// The meshes of a file, in their places; the material's name and its pattern, where it has one.
    fn meshes(
        &self,
        m: &DescribedMesh,
        at: &Range<usize>,
        pattern: Option<(&Spanned<String>, &str)>,
    ) -> Result<Vec<Arc<dyn Shape>>, Error> {
        let mut out: Vec<Arc<dyn Shape>> = Vec::new();
        let base = self.transform(&m.transform, at)?;
        let copies = match &m.instances {
            None => vec![base],
            Some(all) => all.iter().map(|s| Ok(self.transform(s, at)? * base)).collect::<Result<_, Error>>()?,
        };
        for mesh in self.searched(m, at)? {
            if let Some((name, pattern)) = pattern.filter(|_| !mesh.has_uvs()) {
                let message = format!(
                    "material `{}` has a {pattern}, and {} no texture coordinates; expected a mesh with them (`vt` of OBJ, `u` and `v` or `s` and `t` of PLY, TEXCOORD_0 of glTF)",
                    name.get_ref(),
                    m.file
                );
                return Err(self.wrong(&name.span(), message));
            }
            for to_world in &copies {
                let placed = PlacedMesh::new(Arc::clone(&mesh), *to_world);
                let message = "a transform that cannot be undone; expected a scale other than 0";
                out.push(Arc::new(placed.ok_or_else(|| self.wrong(at, message))?));
            }
        }
        if out.is_empty() {
            return Err(self.wrong(at, format!("{}: no triangles, or no instance", m.file)));
        }
        Ok(out)
    }

    /// The meshes of a file with their trees; a file is read once, however many shapes name it.
    fn searched(&self, m: &DescribedMesh, at: &Range<usize>) -> Result<Vec<Arc<Mesh>>, Error> {
        let key = (m.file.clone(), m.flat);
        if let Some(known) = self.meshes.known.borrow().get(&key) {
            return Ok(known.clone());
        }
        let (mut meshes, mut incomplete) = (Vec::new(), Vec::new());
        for mut object in self.files.meshes(&m.file).map_err(|e| self.wrong(at, e))? {
            if m.flat {
                object.mesh.normals.clear();
            }
            let of = object.mesh.triangles.len();
            let mesh = Mesh::new(object.mesh).map_err(|e| self.wrong(at, format!("{}: {e}", m.file)))?;
            if let Some(first) = mesh.first_skipped() {
                let (file, triangles) = (m.file.clone(), mesh.skipped());
                let Error { line, column, .. } = self.wrong(at, "");
                let mesh = object.name;
                incomplete.push(Incomplete { file, mesh, triangles, of, first: first + 1, line, column });
            }
            meshes.push(Arc::new(mesh));
        }
        let mut known = self.meshes.known.borrow_mut();
        // Flat or not, the file's triangles are the same.
        if !known.contains_key(&(m.file.clone(), !m.flat)) {
            self.meshes.incomplete.borrow_mut().append(&mut incomplete);
        }
        known.insert(key, meshes.clone());
        Ok(meshes)
    }

    fn transform(&self, steps: &[Step], at: &Range<usize>) -> Result<DAffine3, Error> {
        steps.iter().try_fold(DAffine3::IDENTITY, |before, step| {
            let next = match (step.translate, &step.rotate, step.scale) {
                (Some(by), None, None) => DAffine3::from_translation(DVec3::from_array(by)),
                (None, Some(r), None) => {
                    let axis = DVec3::from_array(r.axis).try_normalize();
                    let axis = axis.ok_or_else(|| self.wrong(at, "an axis without length; expected a direction"))?;
                    DAffine3::from_axis_angle(axis, r.angle.0)
                }
                (None, None, Some(by)) => DAffine3::from_scale(DVec3::splat(by)),
                _ => return Err(self.wrong(at, "a step that is not one of translate, rotate, scale")),
            };
            Ok(next * before)
        })
    }

    /// A flat shape that shines as a photometric file says.
    fn lamp_emission(
        &self,
        shape: &Described,
        emission: &Spanned<Emitted>,
        faces: &[Arc<dyn Shape>],
        bands: &Bands,
        quantities: &Quantities,
    ) -> Result<Emission, Error> {
        let (e, at) = (emission.get_ref(), emission.span());
        let (Some(lamp), true, [face]) = (&e.lamp, is_flat(shape), faces) else {
            return Err(
                self.wrong(&at, "`lamp` of a shape that is not flat; expected a rectangle, disk, triangle or polygon")
            );
        };
        if e.radiance.is_some() || e.exitance.is_some() || e.two_sided || e.cosine_power != 0.0 {
            return Err(self.wrong(
                &at,
                "`lamp` beside another distribution or amount; expected at most a `flux` and a `spectrum`",
            ));
        }
        let colour = Colour::of_light(self, e.spectrum.as_ref())?;
        let middle = face.sample_area([0.5; 3]);
        let described = Lamp {
            file: lamp.file.clone(),
            at: middle.position.to_array(),
            aim: Some((middle.position + middle.normal).to_array()),
            rotation: None,
            tilt: None,
            spin: lamp.spin,
            flux: e.flux,
            dimming: 1.0,
            opening: false,
        };
        let light = Arc::new(self.goniometric(&described, &at, &colour, bands, quantities)?);
        Ok(Emission::of_lamp(light, face.area(), bands.len()))
    }

    fn emission(
        &self,
        e: &Emitted,
        at: &Range<usize>,
        area: f64,
        bands: &Bands,
        quantities: &Quantities,
    ) -> Result<Emission, Error> {
        if !(e.cosine_power >= 0.0 && e.cosine_power.is_finite()) {
            return Err(self.wrong(at, format!("a `cosine_power` of {}; expected 0 or more", e.cosine_power)));
        }
        let colour = Colour::of_light(self, e.spectrum.as_ref())?;
        let shape = Emission::new(Vec::new(), e.cosine_power, e.two_sided);
        let given = [
            e.radiance.map(|r| (r.value, r.kind)),
            e.exitance.map(|m| (m.value / shape.exitance_per_radiance(), m.kind)),
            e.flux.map(|f| (f.value / shape.exitance_per_radiance() / area, f.kind)),
        ];
        let mut given = given.into_iter().flatten();
        let radiance = match (given.next(), given.next()) {
            (Some((value, kind)), None) => self.scaled(&colour, value, kind, bands, quantities, at)?,
            // The radiance as the spectrum itself has it.
            (None, _) if e.spectrum.is_some() => {
                colour.values(bands).map_err(|nm| self.wrong(at, format!("a line at {nm} nm without a band")))?
            }
            _ => {
                return Err(self.wrong(
                    at,
                    "an emission without or with several amounts; expected one of radiance, exitance, flux",
                ));
            }
        };
        if let Some(bad) = radiance.iter().find(|r| !(**r >= 0.0 && r.is_finite())) {
            return Err(self.wrong(
                at,
                format!("a radiance of {bad}; expected 0 or more, and an area that is finite where a flux is given"),
            ));
        }
        Ok(Emission::new(radiance, e.cosine_power, e.two_sided))
    }
}

/// The six faces of a box; normals outwards, or inwards for a room.
fn cuboid(a: DVec3, b: DVec3, inwards: bool) -> Faces {
    let (min, max) = (a.min(b), a.max(b));
    let size = max - min;
    let mut faces: Vec<Arc<dyn Shape>> = Vec::with_capacity(6);
    for axis in 0..3 {
        let (s, t) = ((axis + 1) % 3, (axis + 2) % 3);
        let (s, t) = (DVec3::AXES[s] * size[s], DVec3::AXES[t] * size[t]);
        for far in [false, true] {
            let corner = if far { min + DVec3::AXES[axis] * size[axis] } else { min };
            // s × t points along +axis.
            let (first, second) = if far == inwards { (t, s) } else { (s, t) };
            faces.push(Arc::new(Rectangle::new(corner, first, second)?));
        }
    }
    Ok(faces)
}
