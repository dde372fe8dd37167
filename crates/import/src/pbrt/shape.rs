//! Shapes to meshes and parts, objects and their instances.

use super::gzip::unpacked;
use super::made::{Emission, Placed, Shape};
use super::params::{Params, Place, Values};
use super::reader::Reader;
use super::round;
use super::state::Saved;
use super::version::Version;
use crate::ImportError;
use crate::assembly::{origin_of, positions_from};
use crate::mesh;
use crate::ply;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Vec2, Vec3};
use enfilade_scene::{Alpha, ObjectId, PartLabel, ScalarParam};
use std::path::Path;

/// A scene has at most this many parts, instances counted one by one.
const MAX_PARTS: usize = 4_000_000;

/// Cuts along each edge of a bilinear patch that is not flat, where there are few and many patches.
const PATCH_CUTS: [u32; 2] = [16, 4];

/// More patches than this are many.
const MANY_PATCHES: usize = 4096;

impl Reader<'_> {
    /// Adds the part of a shape, or keeps it for the object being defined.
    pub(super) fn shape(&mut self, class: &str, params: &Params) -> Result<(), ImportError> {
        if self.object.is_none() && !self.in_world {
            return Err(params.place.error("the shape is before WorldBegin; move it after"));
        }
        let (shape, stem) = match class {
            "plymesh" => {
                let path = params.string("filename")?.ok_or_else(|| params.place.error("the plymesh has no filename"))?.to_string();
                (self.ply_mesh(&path, params)?, stem(&path))
            }
            _ => (self.own_mesh(class, params)?, class.to_string()),
        };
        let Some(shape) = shape else { return Ok(()) };
        let mask = self.mask(params)?;
        let emission = self.emission(shape, params)?;
        self.report_unused(params, &["S", "splitdepth", "edgelength"]);
        let index = self.state.material;
        let Some(material) = self.material(index, emission, mask)? else {
            self.warn(&params.place, "the shape scatters nothing and was left out");
            return Ok(());
        };
        if !shape.has_uvs && self.a.is_textured(material) {
            self.warn(&params.place, "the mesh has no texture coordinates; its textures show one colour");
        }
        let name = format!("{}_{stem}", self.material_name(index));
        let placed = Placed { name, mesh: shape.mesh, material, object_from_mesh: self.state.ctm };
        match &mut self.object {
            Some((_, shapes)) => shapes.push(placed),
            None => {
                let object = self.a.push_object(&placed.name, None);
                self.place(object, &placed, DAffine3::IDENTITY, &params.place)?;
            }
        }
        Ok(())
    }

    fn place(&mut self, object: ObjectId, placed: &Placed, world_from_object: DAffine3, place: &Place) -> Result<(), ImportError> {
        self.parts += 1;
        if self.parts > MAX_PARTS {
            return Err(place.error(format!("the scene has more than {MAX_PARTS} parts; check the instances")));
        }
        let file_from_mesh = self.file_from_world * world_from_object * placed.object_from_mesh;
        self.a.push_part_of(object, &placed.name, placed.mesh, placed.material, file_from_mesh, PartLabel::NONE);
        Ok(())
    }

    pub(super) fn object_begin(&mut self, name: String, place: &Place) -> Result<(), ImportError> {
        if self.object.is_some() {
            return Err(place.error("objects cannot be within objects; close the outer one by ObjectEnd first"));
        }
        self.saved.push(Saved::Attributes(self.state.clone()));
        self.object = Some((name, Vec::new()));
        Ok(())
    }

    pub(super) fn object_end(&mut self, place: &Place) -> Result<(), ImportError> {
        match (self.object.take(), self.saved.pop()) {
            (Some((name, shapes)), Some(Saved::Attributes(state))) => {
                self.state = state;
                self.objects.insert(name, shapes);
                Ok(())
            }
            _ => Err(place.error("no object is open, or a block within it is; close blocks in the order in which they were opened")),
        }
    }

    pub(super) fn object_instance(&mut self, name: &str, place: &Place) -> Result<(), ImportError> {
        if self.object.is_some() {
            return Err(place.error("instances cannot be within objects"));
        }
        let shapes = self.objects.remove(name).ok_or_else(|| place.error("no object before it has this name"))?;
        let object = self.a.push_object(name, None);
        shapes.iter().try_for_each(|placed| self.place(object, placed, self.state.ctm, place))?;
        self.objects.insert(name.to_string(), shapes);
        Ok(())
    }

    /// The mesh of a PLY file, read once.
    fn ply_mesh(&mut self, path: &str, params: &Params) -> Result<Option<Shape>, ImportError> {
        let key = (path.to_string(), self.state.reversed);
        if let Some(&known) = self.meshes.get(&key) {
            return Ok(known);
        }
        let unit = self.a.meters_per_unit();
        let read = self.a.read(path).and_then(|(file, bytes)| Ok((ply::read(&unpacked(bytes, &file)?, &file, false, unit)?, file)));
        let Some((ply, file)) = self.a.mesh_or_none(read, path, &params.place.text())? else {
            self.meshes.insert(key, None);
            return Ok(None);
        };
        if ply.mean_color.is_some() {
            self.warn(&params.place, "the colours of vertices were dropped");
        }
        for element in ply.skipped {
            self.warn(&params.place, format!("{}: the elements {element} were left out", file.display()));
        }
        if let Some(trailing) = ply.trailing {
            self.warn(&params.place, format!("{}: {trailing}", file.display()));
        }
        let shape = self.keep_mesh(ply.mesh, ply.origin, None, &file, "mesh")?;
        self.meshes.insert(key, shape);
        Ok(shape)
    }

    /// The mesh of a shape without a file. `None`, with a warning, for shapes that are not supported.
    fn own_mesh(&mut self, class: &str, params: &Params) -> Result<Option<Shape>, ImportError> {
        let round = round::measures(class, params)?.map(|measures| (measures, self.state.reversed));
        if let Some(known) = round.as_ref().and_then(|key| self.meshes.get(key)) {
            return Ok(*known);
        }
        let unit = self.a.meters_per_unit();
        let (mesh, origin, pieces) = match class {
            "trianglemesh" => {
                let (mesh, origin) = triangle_mesh(params, unit)?;
                (mesh, origin, None)
            }
            "loopsubdiv" => {
                self.warn(&params.place, "subdivision is not supported; the control mesh stands in, with smooth normals");
                params.ignore(&["levels", "nlevels", "scheme"]);
                let (mut mesh, origin) = triangle_mesh(params, unit)?;
                mesh::add_smooth_normals(&mut mesh);
                (mesh, origin, None)
            }
            "bilinearmesh" => {
                let (mesh, origin, patches) = bilinear_mesh(params, unit)?;
                (mesh, origin, Some(patches))
            }
            _ => match round::mesh(class, params)? {
                Some(mesh) => (mesh, DVec3::ZERO, Some(1)),
                None => {
                    self.warn(&params.place, format!("{class} shapes are not supported; it was left out"));
                    return Ok(None);
                }
            },
        };
        let file = params.place.file.clone();
        let shape = self.keep_mesh(mesh, origin, pieces, &file, &params.place.text())?;
        if let Some(key) = round {
            self.meshes.insert(key, shape);
        }
        Ok(shape)
    }

    /// Adds a mesh whose faces have been turned to its normals, or away from them under `ReverseOrientation`.
    fn keep_mesh(
        &mut self,
        mut mesh: Mesh,
        origin: DVec3,
        pieces: Option<usize>,
        file: &Path,
        place: &str,
    ) -> Result<Option<Shape>, ImportError> {
        mesh::turn_faces_to_normals(&mut mesh);
        if self.state.reversed {
            mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            mesh.normals.iter_mut().for_each(|n| *n = -*n);
        }
        let (pieces, has_uvs) = (pieces.unwrap_or(mesh.triangles.len()), !mesh.uvs.is_empty());
        Ok(self.a.push_mesh_from(origin, mesh, file, place)?.map(|mesh| Shape { mesh, pieces, has_uvs }))
    }

    /// Cut-outs by `alpha`: in version 3 only where it is zero, in version 4 with its probability.
    fn mask(&mut self, params: &Params) -> Result<Alpha, ImportError> {
        let opacity: ScalarParam = self.scalar(params, "alpha", 1.0)?;
        Ok(match self.version {
            _ if opacity.texture.is_none() && opacity.factor >= 1.0 => Alpha::Opaque,
            Version::V3 => Alpha::Mask { opacity, cutoff: 1e-3 },
            Version::V4 => Alpha::Blend { opacity },
        })
    }

    fn emission(&mut self, shape: Shape, params: &Params) -> Result<Option<Emission>, ImportError> {
        let Some(light) = self.state.area_light.clone() else { return Ok(None) };
        if self.object.is_some() {
            self.warn(&params.place, "area lights within objects do not shine, in pbrt as here");
            return Ok(None);
        }
        let area = self.a.area(shape.mesh, self.state.ctm);
        self.area_emission(&light, area, shape.pieces).map(Some)
    }
}

/// `P`, `N`, `uv` (or `st`) and `indices`, which a single triangle may omit; and the point from which positions count.
fn triangle_mesh(params: &Params, meters_per_unit: f64) -> Result<(Mesh, DVec3), ImportError> {
    let (mut mesh, origin) = vertices(params, meters_per_unit)?;
    let count = mesh.positions.len();
    let mut indices = params.indices("indices", count)?;
    if indices.is_empty() && count == 3 {
        indices = vec![0, 1, 2];
    }
    if !indices.len().is_multiple_of(3) || indices.is_empty() {
        return Err(params.place.error(format!("found {} indices, expected three to a triangle", indices.len())));
    }
    mesh.triangles = indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    params.ignore(&["faceIndices"]);
    Ok((mesh, origin))
}

fn vertices(params: &Params, meters_per_unit: f64) -> Result<(Mesh, DVec3), ImportError> {
    let points = |name: &str, size: usize| -> Result<Vec<DVec3>, ImportError> {
        let n = params.numbers(name)?;
        if !n.len().is_multiple_of(size) {
            return Err(params.place.error(format!("{name} has {} numbers, expected {size} to a vertex", n.len())));
        }
        Ok(n.chunks_exact(size).map(|p| DVec3::new(p[0], p[1], if size > 2 { p[2] } else { 0.0 })).collect())
    };
    let (positions, normals) = (points("P", 3)?, positions_from(DVec3::ZERO, &points("N", 3)?));
    let uv_name = if params.has("uv") { "uv" } else { "st" };
    // Version 3 allows plain numbers in pairs.
    let uvs: Vec<Vec2> = points(uv_name, 2)?.into_iter().map(|uv| uv.truncate().as_vec2()).collect();
    for (what, found) in [("normals (N)", normals.len()), ("texture coordinates (uv)", uvs.len())] {
        if found != 0 && found != positions.len() {
            return Err(params.place.error(format!("found {found} {what} for {} vertices (P), expected as many", positions.len())));
        }
    }
    let origin = origin_of(positions.iter().copied(), meters_per_unit);
    Ok((Mesh { positions: positions_from(origin, &positions), normals, uvs, triangles: Vec::new() }, origin))
}

/// Patches of four corners, (0,0), (1,0), (0,1), (1,1) in their own coordinates, each with vertices of its own; the point that positions
/// are relative to; and the number of patches.
fn bilinear_mesh(params: &Params, meters_per_unit: f64) -> Result<(Mesh, DVec3, usize), ImportError> {
    let (v, origin) = vertices(params, meters_per_unit)?;
    let mut indices = params.indices("indices", v.positions.len())?;
    if indices.is_empty() && v.positions.len() == 4 {
        indices = vec![0, 1, 2, 3];
    }
    if !indices.len().is_multiple_of(4) || indices.is_empty() {
        return Err(params.place.error(format!("found {} indices, expected four to a patch", indices.len())));
    }
    if matches!(params.get("emissionfilename").map(|p| &p.values), Some(Values::Strings(_))) {
        return Err(params.place.error("emissionfilename is not supported; give the light an image by AreaLightSource's filename"));
    }
    let mut mesh = Mesh::default();
    let cuts = PATCH_CUTS[usize::from(indices.len() / 4 > MANY_PATCHES)];
    for patch in indices.chunks_exact(4) {
        let p = [0, 1, 2, 3].map(|i| v.positions[patch[i] as usize]);
        let bent = (p[3] - p[0]).dot((p[1] - p[0]).cross(p[2] - p[0])).abs();
        let size = (p[1] - p[0]).length() * (p[2] - p[0]).length() * (p[3] - p[0]).length();
        add_patch(&mut mesh, &v, patch, if bent > 1e-4 * size { cuts } else { 1 });
    }
    Ok((mesh, origin, indices.len() / 4))
}

fn add_patch(mesh: &mut Mesh, v: &Mesh, patch: &[u32], cuts: u32) {
    let base = mesh.positions.len() as u32;
    for (j, i) in (0..=cuts).flat_map(|j| (0..=cuts).map(move |i| (j, i))) {
        let (s, t) = (i as f32 / cuts as f32, j as f32 / cuts as f32);
        let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
        let mean = |values: &[Vec3]| patch.iter().zip(weights).map(|(&k, w)| values[k as usize] * w).sum::<Vec3>();
        mesh.positions.push(mean(&v.positions));
        if !v.normals.is_empty() {
            mesh.normals.push(mean(&v.normals));
        }
        let uv = patch.iter().zip(weights).map(|(&k, w)| v.uvs.get(k as usize).copied().unwrap_or_default() * w).sum::<Vec2>();
        mesh.uvs.push(if v.uvs.is_empty() { Vec2::new(s, t) } else { uv });
    }
    let row = cuts + 1;
    for (j, i) in (0..cuts).flat_map(|j| (0..cuts).map(move |i| (j, i))) {
        let a = base + j * row + i;
        mesh.triangles.extend([[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]);
    }
}

fn stem(path: &str) -> String {
    let path = path.replace('\\', "/");
    let path = path.strip_suffix(".gz").unwrap_or(&path);
    Path::new(path).file_stem().map_or_else(|| "mesh".to_string(), |s| s.to_string_lossy().into_owned())
}
