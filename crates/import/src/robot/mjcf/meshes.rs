//! Meshes of a model: files in OBJ, STL and MuJoCo's MSH, or vertices and faces within the model.

use super::settings::Settings;
use super::smooth::smoothed;
use super::tree::Element;
use crate::ImportError;
use crate::assembly::Assembly;
use crate::collections::assets;
use crate::joints::joint::quaternion;
use crate::robot::shapes::find;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DQuat, DVec3, Vec2, Vec3};
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::rc::Rc;

/// Bytes before the arrays of an MSH file: four numbers.
const MSH_HEAD: usize = 16;

/// A mesh as its file has it, with what the model does to it.
pub(super) struct MeshAsset {
    pub mesh: Mesh,
    /// From the file's axes and unit to the geoms'.
    pub geom_from_mesh: DAffine3,
}

/// The meshes of a model, by name; each is read once, when it is used.
pub(super) struct Meshes {
    elements: BTreeMap<String, Element>,
    known: BTreeMap<String, Option<Rc<MeshAsset>>>,
}

impl Meshes {
    /// The meshes that a model declares.
    ///
    /// # Errors
    /// When one is of a class that is not there, or has neither a name nor a file.
    pub(super) fn of(root: &Element, settings: &Settings) -> Result<Self, ImportError> {
        let mut elements = BTreeMap::new();
        for (name, mesh) in settings.assets(root, "mesh")? {
            elements.insert(name.ok_or_else(|| mesh.wrong("a mesh needs a name or a file".into()))?, mesh);
        }
        Ok(Self { elements, known: BTreeMap::new() })
    }

    /// The mesh that `user` names; `None`, with a warning, if its file is missing or damaged and the options allow that.
    ///
    /// # Errors
    /// When there is no such mesh, or it cannot be read.
    pub(super) fn get(
        &mut self,
        name: &str,
        user: &Element,
        settings: &Settings,
        a: &mut Assembly,
    ) -> Result<Option<Rc<MeshAsset>>, ImportError> {
        if let Some(known) = self.known.get(name) {
            return Ok(known.clone());
        }
        let element = self.elements.get(name).ok_or_else(|| user.wrong(format!("there is no mesh {name:?} among the assets")))?;
        let mesh = match element.text("file") {
            Some(path) => {
                let path = settings.mesh_file(path);
                let read = read(&path, a);
                a.mesh_or_none(read, &path, &format!("mesh {name:?}"))?
            }
            None => inline(element, a)?,
        };
        let asset = match mesh {
            Some(mesh) => Some(Rc::new(MeshAsset { mesh: smoothed(mesh), geom_from_mesh: transform(element)? })),
            None => None,
        };
        self.known.insert(name.into(), asset.clone());
        Ok(asset)
    }
}

/// What a model does to the vertices of a file: it moves them by `refpos`, turns them by `refquat`, and scales them.
fn transform(element: &Element) -> Result<DAffine3, ImportError> {
    let scale = element.vector("scale")?.map_or(DVec3::ONE, DVec3::from_array);
    let position = element.vector("refpos")?.map_or(DVec3::ZERO, DVec3::from_array);
    let rotation = element.vector::<4>("refquat")?.and_then(|q| quaternion(&q)).unwrap_or(DQuat::IDENTITY);
    Ok(DAffine3::from_scale(scale) * DAffine3::from_quat(rotation.inverse()) * DAffine3::from_translation(-position))
}

fn read(path: &str, a: &mut Assembly) -> Result<Mesh, ImportError> {
    let scene = a.file().to_path_buf();
    let Some(file) = find(path, &scene, a) else {
        a.note_missing(&scene.with_file_name(path));
        let source = Error::new(ErrorKind::NotFound, "no such file beside the scene or in the folders above");
        return Err(ImportError::Read { file: path.into(), source, remedy: String::new() });
    };
    a.report_case(path, &file);
    if file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("msh")) {
        let bytes = a.read_input(&file, "check the permission to read it")?;
        return msh(&bytes).map_err(|problem| ImportError::malformed(&file, "whole file", problem));
    }
    // Of OBJ files MuJoCo uses the triangles alone: materials are the model's.
    let imported = assets::read(&file, true, a)?;
    a.note_inputs(&imported.inputs);
    let moved = imported.report.offset_m.map_or(DVec3::ZERO, DVec3::from);
    let scene = imported.scene;
    let parts: Vec<(&Mesh, DAffine3)> = scene
        .parts
        .iter()
        .map(|part| (&*scene.meshes[part.mesh as usize], DAffine3::from_translation(moved) * part.world_from_mesh))
        .collect();
    Ok(joined(&parts))
}

/// One mesh of several, each at a place of its own.
fn joined(parts: &[(&Mesh, DAffine3)]) -> Mesh {
    let mut all = Mesh::default();
    let [has_normals, has_uvs] =
        [parts.iter().all(|(mesh, _)| !mesh.normals.is_empty()), parts.iter().any(|(mesh, _)| !mesh.uvs.is_empty())];
    for (mesh, place) in parts {
        let base = all.positions.len() as u32;
        all.positions.extend(mesh.positions.iter().map(|p| place.transform_point3(p.as_dvec3()).as_vec3()));
        if has_normals {
            all.normals.extend(&mesh.normals);
        }
        if has_uvs {
            all.uvs.extend(mesh.positions.iter().enumerate().map(|(i, _)| mesh.uvs.get(i).copied().unwrap_or_default()));
        }
        all.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| base + corner)));
    }
    all
}

/// A mesh of vertices and faces in the model itself; `None`, with a warning, without faces.
fn inline(element: &Element, a: &mut Assembly) -> Result<Option<Mesh>, ImportError> {
    let list = |attribute: &str| Ok::<_, ImportError>(element.numbers(attribute, 0..=usize::MAX)?.unwrap_or_default());
    let (vertices, faces, uvs) = (list("vertex")?, list("face")?, list("texcoord")?);
    if faces.is_empty() || vertices.is_empty() {
        let place = element.place(a);
        a.warn(place, "a mesh without a file needs vertices and faces (convex hulls and built-in meshes are not made); it was left out");
        return Ok(None);
    }
    let positions: Vec<Vec3> = vertices.chunks_exact(3).map(|v| DVec3::from_slice(v).as_vec3()).collect();
    let triangles: Vec<[u32; 3]> = faces.chunks_exact(3).map(|f| [f[0] as u32, f[1] as u32, f[2] as u32]).collect();
    let uvs: Vec<Vec2> = uvs.chunks_exact(2).map(|v| Vec2::new(v[0] as f32, 1.0 - v[1] as f32)).collect();
    let uvs = if uvs.len() == positions.len() { uvs } else { Vec::new() };
    Ok(Some(Mesh { positions, triangles, uvs, ..Mesh::default() }))
}

/// The mesh of an MSH file: numbers of vertices, normals, texture coordinates (v downward) and faces, then these.
///
/// # Errors
/// What is wrong with it.
fn msh(bytes: &[u8]) -> Result<Mesh, String> {
    let (words, _) = bytes.as_chunks::<4>();
    let counts: Option<Vec<usize>> = words.get(..MSH_HEAD / 4).map(|head| head.iter().map(|&w| u32::from_le_bytes(w) as usize).collect());
    let Some(&[vertices, normals, uvs, faces]) = counts.as_deref() else { return Err("it is too short for an MSH file".into()) };
    let lengths = [3 * vertices, 3 * normals, 2 * uvs, 3 * faces];
    let total: usize = lengths.iter().sum();
    if total.checked_mul(4) != Some(bytes.len() - MSH_HEAD) || normals > 0 && normals != vertices || uvs > 0 && uvs != vertices {
        let found = format!("{vertices} vertices, {normals} normals, {uvs} texture coordinates, {faces} faces in {} bytes", bytes.len());
        return Err(format!("it is no MSH file of MuJoCo ({found}); save it again, or as OBJ"));
    }
    let mut rest = &words[MSH_HEAD / 4..];
    let mut next = |length: usize| {
        let (taken, after) = rest.split_at(length);
        rest = after;
        taken
    };
    let float = |w: &[u8; 4]| f32::from_le_bytes(*w);
    let vectors = |words: &[[u8; 4]]| words.chunks_exact(3).map(|w| Vec3::new(float(&w[0]), float(&w[1]), float(&w[2]))).collect();
    let positions = vectors(next(lengths[0]));
    let normals = vectors(next(lengths[1]));
    let uvs = next(lengths[2]).chunks_exact(2).map(|w| Vec2::new(float(&w[0]), 1.0 - float(&w[1]))).collect();
    let triangles = next(lengths[3]).chunks_exact(3).map(|w| [0, 1, 2].map(|i| u32::from_le_bytes(w[i]))).collect();
    Ok(Mesh { positions, normals, uvs, triangles })
}
