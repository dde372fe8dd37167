//! The walk through the stage: each prim with what it inherits becomes parts, lights and cameras.

use super::bind::{self, Binding};
use super::camera::{self, name};
use super::label::{self, Unknown};
use super::layer::field;
use super::light::{self, Lamp};
use super::material::Materials;
use super::polygons::Polygons;
use super::primvar::Sizes;
use super::shapes;
use super::stage::{Prim, Stage};
use super::surface::uvs;
use super::xform;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_geometry::Mesh;
use enfilade_math::DAffine3;
use enfilade_scene::PartLabel;
use std::collections::HashMap;
use std::rc::Rc;

/// What a prim has from those above it.
#[derive(Clone)]
pub(super) struct State {
    pub file_from_parent: DAffine3,
    pub label: PartLabel,
    pub binding: Option<Binding>,
    /// Goes before the names of parts: tells instances of one prototype apart.
    pub prefix: String,
}

/// Some faces of a mesh: their scene mesh, the subset's name, and what it binds.
#[derive(Clone)]
struct Piece {
    mesh: u32,
    name: String,
    binding: Option<Binding>,
}

/// What the meshes of a prim are made of.
#[derive(Clone)]
struct Shape {
    pieces: Vec<Piece>,
    sizes: Sizes,
    /// True for subdivision surfaces.
    smooth: bool,
}

/// More visits than this are taken for instances that multiply without end.
const MAX_VISITS: usize = 1 << 21;

pub(super) struct Walk<'s> {
    pub stage: &'s mut Stage,
    pub z_up: bool,
    pub(super) materials: Materials,
    pieces: HashMap<String, Shape>,
    visited: usize,
    unknown_labels: Unknown,
    /// Of what was noted more than once: how often.
    hidden: usize,
    cages: usize,
    /// Emitting variants of materials, for meshes that are lights.
    pub(super) glowing: HashMap<(u32, [u32; 3]), u32>,
}

impl<'s> Walk<'s> {
    pub(super) fn new(stage: &'s mut Stage, z_up: bool) -> Self {
        Self {
            stage,
            z_up,
            materials: Materials::default(),
            pieces: HashMap::new(),
            visited: 0,
            unknown_labels: Unknown::default(),
            hidden: 0,
            cages: 0,
            glowing: HashMap::new(),
        }
    }

    /// Adds all of the stage.
    pub(super) fn all(&mut self, a: &mut Assembly) -> Result<(), ImportError> {
        let root = self.stage.root();
        let state = State { file_from_parent: DAffine3::IDENTITY, label: PartLabel::NONE, binding: None, prefix: String::new() };
        let names = root.children();
        for (i, name) in names.iter().enumerate() {
            a.progress(i, names.len());
            let prim = self.stage.child(&root, name, a)?;
            self.visit(&prim, &state, a)?;
        }
        self.report(a);
        Ok(())
    }

    fn report(&self, a: &mut Assembly) {
        let sampled = self.stage.sampled.get();
        if sampled > 0 {
            a.warn("timeSamples", format!("{sampled} values change with time; those of the first moment were taken"));
        }
        if self.hidden > 0 {
            a.warn(
                "visibility",
                format!("{} prims that are invisible, or have the purpose guide or proxy, were left out with all below them", self.hidden),
            );
        }
        if self.cages > 0 {
            a.warn(
                "subdivisionScheme",
                format!("{} meshes are subdivision surfaces; their cages were taken, with smooth normals where there are none", self.cages),
            );
        }
        if let Some((name, path)) = &self.unknown_labels.first {
            let message = format!("{} labels name no class of NYU40 and were left out; the first is {name:?}", self.unknown_labels.count);
            a.warn(path, message);
        }
    }

    /// Adds a prim and what is below it.
    pub(super) fn visit(&mut self, prim: &Rc<Prim>, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        self.visited += 1;
        if self.visited > MAX_VISITS {
            return Err(a.malformed(&prim.path, format!("the scene has more than {MAX_VISITS} prims and instances; make it smaller")));
        }
        if !prim.is_defined() || !prim.is_active() {
            return Ok(());
        }
        if prim.text("visibility") == Some("invisible") || matches!(prim.text("purpose"), Some("guide" | "proxy")) {
            self.hidden += 1;
            return Ok(());
        }
        let (local, reset) = xform::local(prim, a);
        let state = State {
            file_from_parent: if reset { local } else { state.file_from_parent * local },
            label: label::at(prim, state.label, &mut self.unknown_labels),
            binding: bind::at(prim, state.binding.as_ref(), a),
            prefix: state.prefix.clone(),
        };
        match prim.kind() {
            "Mesh" => self.mesh(prim, &state, a)?,
            "Camera" => camera::add(prim, state.file_from_parent, a),
            "PointInstancer" => return self.instances(prim, &state, a),
            // Their shaders are read where they are bound.
            "Material" | "Shader" | "NodeGraph" | "GeomSubset" => return Ok(()),
            "" | "Xform" | "Scope" | "SkelRoot" => (),
            kind if kind.ends_with("Light") || kind == "DomeLight_1" => {
                let baked = &mut self.materials.baked;
                Lamp { prim, file_from_prim: state.file_from_parent, label: state.label, baked, z_up: self.z_up }.add(self.stage, a)?;
            }
            kind => match shapes::mesh(prim) {
                Some(mesh) => self.shape(prim, mesh, &state, a)?,
                None if ignored(kind) => (),
                None => a.warn(&prim.path, format!("prims of type {kind} are not supported; it was left out")),
            },
        }
        for name in prim.children() {
            let child = self.stage.child(prim, &name, a)?;
            self.visit(&child, &state, a)?;
        }
        Ok(())
    }

    fn shape(&mut self, prim: &Rc<Prim>, mesh: Mesh, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        let key = prim.identity();
        let shape = match self.pieces.get(&key) {
            Some(known) => known.clone(),
            None => {
                let file = a.file().to_path_buf();
                let mesh = a.push_mesh(mesh, &file, &prim.path)?;
                let pieces = mesh.into_iter().map(|mesh| Piece { mesh, name: String::new(), binding: None }).collect();
                Shape { pieces, sizes: Sizes { faces: 1, points: 1, corners: 1 }, smooth: false }
            }
        };
        self.pieces.insert(key, shape.clone());
        self.place(prim, &shape, state, a)
    }

    fn mesh(&mut self, prim: &Rc<Prim>, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        if prim.schemas().iter().any(|s| s == "SkelBindingAPI") || !prim.targets("skel:skeleton", field::TARGETS).is_empty() {
            a.warn(&prim.path, "the mesh's skeleton and blend shapes were left out; it stays in its rest pose");
        }
        // Texture coordinates are those of the material, so meshes are shared among instances of one material.
        let uv_name = self.material_of(prim, state.binding.as_ref(), a)?.map_or_else(|| "st".into(), |(_, uv_name)| uv_name);
        let key = format!("{} {uv_name}", prim.identity());
        let shape = match self.pieces.get(&key) {
            Some(known) => known.clone(),
            None => {
                let polygons = Polygons::read(prim, a)?;
                let pieces = self.split(prim, &polygons, &uv_name, a)?;
                Shape { pieces, sizes: polygons.sizes(), smooth: polygons.smooth }
            }
        };
        self.cages += usize::from(shape.smooth);
        self.pieces.insert(key, shape.clone());
        self.place(prim, &shape, state, a)
    }

    /// The meshes of a prim: one for each subset that binds a material, and one for the remaining faces.
    fn split(&mut self, prim: &Rc<Prim>, polygons: &Polygons, uv_name: &str, a: &mut Assembly) -> Result<Vec<Piece>, ImportError> {
        let sizes = polygons.sizes();
        let mut taken = vec![false; sizes.faces];
        let mut parts: Vec<(String, Vec<usize>, Option<Binding>)> = Vec::new();
        for name in prim.children() {
            let subset = self.stage.child(prim, &name, a)?;
            if subset.kind() != "GeomSubset" {
                continue;
            }
            let binding = bind::at(&subset, None, a);
            let is_face = subset.text("elementType").unwrap_or("face") == "face";
            if binding.is_none() || !is_face {
                continue;
            }
            let indices = subset.value("indices").and_then(|v| v.as_numbers(1)).unwrap_or(&[]);
            let mut faces = Vec::with_capacity(indices.len());
            for &index in indices {
                let Some(flag) = (index >= 0.0).then(|| taken.get_mut(index as usize)).flatten() else {
                    let problem = format!("found face {index}, but there are {}; export the file again", sizes.faces);
                    return Err(a.malformed(format!("<{}>.indices", subset.path), problem));
                };
                if !std::mem::replace(flag, true) {
                    faces.push(index as usize);
                }
            }
            parts.push((name.to_string(), faces, binding));
        }
        let rest: Vec<usize> = (0..sizes.faces).filter(|f| !taken[*f]).collect();
        if !rest.is_empty() || parts.is_empty() {
            parts.insert(0, (String::new(), rest, None));
        }
        let mut pieces = Vec::new();
        let file = a.file().to_path_buf();
        for (name, faces, binding) in parts {
            let wanted = match &binding {
                Some(b) => self.materials.get(self.stage, &b.material, false, a)?.map(|(_, uv)| uv),
                None => None,
            };
            let uvs = uvs(prim, wanted.as_deref().unwrap_or(uv_name), sizes, a)?;
            let mesh = polygons.mesh(faces.into_iter(), uvs.as_ref());
            if let Some(mesh) = a.push_mesh(mesh, &file, &prim.path)? {
                pieces.push(Piece { mesh, name, binding });
            }
        }
        Ok(pieces)
    }

    fn place(&mut self, prim: &Rc<Prim>, shape: &Shape, state: &State, a: &mut Assembly) -> Result<(), ImportError> {
        for piece in &shape.pieces {
            let stronger = state.binding.as_ref().filter(|b| b.is_stronger());
            let binding = stronger.or(piece.binding.as_ref()).or(state.binding.as_ref());
            let mut material = match self.material_of(prim, binding, a)? {
                Some((material, _)) => material,
                None => self.display_color(prim, shape.sizes, a)?,
            };
            if let Some(radiance) = light::of_mesh(prim, a.mesh_at(piece.mesh), state.file_from_parent) {
                material = self.glowing(material, radiance, a);
            }
            let own = name(prim);
            let suffix = if piece.name.is_empty() { String::new() } else { format!(".{}", piece.name) };
            a.push_part(&format!("{}{own}{suffix}", state.prefix), piece.mesh, material, state.file_from_parent, state.label);
        }
        Ok(())
    }
}

/// Types that have no place in a picture of a room and need no mention.
fn ignored(kind: &str) -> bool {
    kind.starts_with("Physics") || kind.starts_with("Render") || matches!(kind, "SkelAnimation" | "Skeleton" | "BlendShape")
}
