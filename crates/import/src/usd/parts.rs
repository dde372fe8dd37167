//! Parts: the meshes of a gprim, one for each subset that binds a material or has a label, placed with their materials.

use super::bind::{self, Bindings};
use super::camera::name;
use super::deform::Deform;
use super::label;
use super::layer::child_path;
use super::light;
use super::polygons::Polygons;
use super::primvar::Sizes;
use super::stage::Prim;
use super::state::{Piece, Shape, State};
use super::surface::uvs;
use super::walk::Walk;
use crate::ImportError;
use crate::assembly::{Assembly, FileLabel};
use enfilade_geometry::Mesh;
use enfilade_math::DVec3;
use std::rc::Rc;

impl Walk<'_> {
    pub(super) fn shape(&mut self, prim: &Rc<Prim>, mesh: Mesh, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        let key = prim.identity();
        let shape = match self.pieces.get(&key) {
            Some(known) => known.clone(),
            None => {
                let mesh = pushed(DVec3::ZERO, mesh, prim, a)?;
                let pieces = mesh
                    .into_iter()
                    .map(|mesh| Piece { mesh, name: String::new(), bindings: Bindings::default(), semantic: None, deform: None })
                    .collect();
                Shape { pieces, origin: DVec3::ZERO, sizes: Sizes { faces: 1, points: 1, corners: 1 }, smooth: false }
            }
        };
        self.pieces.insert(key, shape.clone());
        self.place(prim, &shape, state, a)
    }

    pub(super) fn mesh(&mut self, prim: &Rc<Prim>, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        // Texture coordinates are those of the material, so meshes are shared among instances of one material.
        let uv_name = self.material_of(prim, state.bindings.material(&prim.path), a)?.map_or_else(|| "st".into(), |s| s.uv_name);
        let key = format!("{} {uv_name}", prim.identity());
        let shape = match self.pieces.get(&key) {
            Some(known) => known.clone(),
            None => {
                let polygons = match Polygons::read(prim, a) {
                    Ok(polygons) => polygons,
                    Err((attribute, problem)) => {
                        a.warn(format!("<{}>.{attribute}", prim.path), format!("{problem}; the mesh was left out"));
                        return Ok(());
                    }
                };
                let deform = Deform::of(prim, &polygons, (&state.rig, &mut self.skeletons), self.stage, a)?;
                let pieces = self.split(prim, &polygons, (&uv_name, deform.map(Rc::new).as_ref()), a)?;
                Shape { pieces, origin: polygons.origin, sizes: polygons.sizes(), smooth: polygons.smooth }
            }
        };
        self.cages += usize::from(shape.smooth);
        // Instances of what deforms may be moved by other animations.
        if shape.pieces.iter().all(|piece| piece.deform.is_none()) {
            self.pieces.insert(key, shape.clone());
        }
        self.place(prim, &shape, state, a)
    }

    /// The meshes of a prim: one for each subset that binds a material or has a label, and one for the remaining faces.
    fn split(
        &mut self,
        prim: &Rc<Prim>,
        polygons: &Polygons,
        (uv_name, deform): (&str, Option<&Rc<Deform>>),
        a: &mut Assembly,
    ) -> Result<Vec<Piece>, ImportError> {
        let sizes = polygons.sizes();
        let mut taken = vec![false; sizes.faces];
        let mut parts: Vec<(String, Vec<usize>, Bindings, Option<i16>)> = Vec::new();
        for name in prim.children() {
            let subset = self.stage.child(prim, &name, a)?;
            if subset.kind() != "GeomSubset" {
                continue;
            }
            let bindings = bind::at(&subset, &Bindings::default(), self.stage, a)?;
            let is_face = subset.text("elementType").unwrap_or("face") == "face";
            let semantic = label::class(&subset, &mut self.unknown_labels);
            if (!bindings.is_empty() || semantic.is_some()) && is_face {
                parts.push((name.to_string(), faces_of(&subset, &mut taken, a), bindings, semantic));
            }
        }
        let rest: Vec<usize> = (0..sizes.faces).filter(|f| !taken[*f]).collect();
        if !rest.is_empty() || parts.is_empty() {
            parts.insert(0, (String::new(), rest, Bindings::default(), None));
        }
        let mut pieces = Vec::new();
        for (name, faces, bindings, semantic) in parts {
            let wanted = match bindings.material(&child_path(&prim.path, &name)) {
                Some(material) => self.materials.get(self.stage, material, false, a)?.map(|s| s.uv_name),
                None => None,
            };
            let uvs = uvs(prim, wanted.as_deref().unwrap_or(uv_name), sizes, a);
            let (mut mesh, corners) = polygons.mesh(faces.into_iter(), uvs.as_ref());
            if let Some(deform) = deform {
                let rest = deform.shape(None, &corners, &mesh);
                (mesh.positions, mesh.normals) = (rest.positions, rest.normals);
            }
            if let Some(mesh) = pushed(polygons.origin, mesh, prim, a)? {
                let deform = deform.map(|deform| (deform.clone(), corners.into()));
                pieces.push(Piece { mesh, name, bindings, semantic, deform });
            }
        }
        Ok(pieces)
    }

    fn place(&mut self, prim: &Rc<Prim>, shape: &Shape, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        for piece in &shape.pieces {
            let path = if piece.name.is_empty() { prim.path.clone() } else { child_path(&prim.path, &piece.name) };
            let bindings = state.bindings.and(&piece.bindings);
            let mut material = match self.material_of(prim, bindings.material(&path), a)? {
                Some(surface) => self.colored(&surface, prim, shape.sizes, &state.constants, a),
                None => self.display_color(prim, shape.sizes, &state.constants, a),
            };
            if let Some(radiance) = light::of_mesh(prim, a.mesh_at(piece.mesh), state.file_from_parent) {
                material = self.glowing(material, radiance, a);
            }
            let own = name(prim);
            let suffix = if piece.name.is_empty() { String::new() } else { format!(".{}", piece.name) };
            let part = format!("{}{own}{suffix}", state.prefix);
            let object = state.object.unwrap_or_else(|| a.push_object(&own, None));
            let label = piece.semantic.map_or(state.label, |semantic| FileLabel::given(semantic, object));
            if let Some(part) = a.push_part_of(object, &part, piece.mesh, material, state.file_from_parent, label) {
                self.things.part(state.thing, object, part);
                if piece.deform.is_some() || state.stretch.is_some() {
                    self.animations.deform(prim, piece, shape.origin, (part, state), a);
                }
            }
        }
        Ok(())
    }
}

/// The faces of a subset that no other has taken. Those that are not there are left out with a warning.
fn faces_of(subset: &Prim, taken: &mut [bool], a: &mut Assembly) -> Vec<usize> {
    let indices = subset.value("indices").and_then(|v| v.as_numbers(1)).unwrap_or(&[]);
    let mut faces = Vec::with_capacity(indices.len());
    let mut missing = None;
    for &index in indices {
        match (index >= 0.0).then(|| taken.get_mut(index as usize)).flatten() {
            Some(flag) => {
                if !std::mem::replace(flag, true) {
                    faces.push(index as usize);
                }
            }
            None => missing = missing.or(Some(index)),
        }
    }
    if let Some(index) = missing {
        let problem = format!("found face {index}, but there are {}; faces that are not there were left out", taken.len());
        a.warn(format!("<{}>.indices", subset.path), problem);
    }
    faces
}

/// Scene index of a mesh; `None` for an empty one, and with a warning for one that makes no sense.
fn pushed(origin: DVec3, mesh: Mesh, prim: &Prim, a: &mut Assembly) -> Result<Option<u32>, ImportError> {
    let file = a.file().to_path_buf();
    match a.push_mesh_from(origin, mesh, &file, &prim.path) {
        Err(ImportError::Malformed { problem, .. }) => {
            a.warn(&prim.path, format!("{problem}; the mesh was left out"));
            Ok(None)
        }
        other => other,
    }
}
