//! The models of furniture within an archive.

use crate::archive::Archive;
use crate::assembly::{Assembly, Piece};
use crate::{Format, ImportError, ImportOptions, ImportReport, Imported, UpAxis, obj};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Quiet, SceneError};
use std::collections::HashMap;
use std::rc::Rc;

// Sweet Home 3D knows some parts of models by how their names begin (`com.eteks.sweethome3d.j3d.ModelManager`).
const PANE: &str = "sweethome3d_window_pane";
const MIRROR: &str = "sweethome3d_window_mirror";
const LIGHT_MARK: &str = "sweethome3d_light";
/// Index of refraction of panes.
const GLASS: f32 = 1.5;

/// A model within the scene being built; its own unit, y up. A model of lines alone has no parts.
pub(super) struct Model {
    pub parts: Vec<ModelPart>,
}

/// One mesh of a model with its material, both as indices into the scene.
#[derive(Clone)]
pub(super) struct ModelPart {
    pub name: String,
    pub mesh: u32,
    pub material: u32,
    pub file_from_mesh: DAffine3,
}

/// The models met so far, and how many pieces have each name.
#[derive(Default)]
pub(super) struct Models {
    pub known: HashMap<String, Rc<Model>>,
    pub names: HashMap<String, usize>,
}

/// Smaller extents count as this, model units, so that flat models can be scaled.
const FLAT: f64 = 1e-4;

impl ModelPart {
    /// True for panes of windows.
    pub fn is_pane(&self) -> bool {
        self.name.starts_with(PANE)
    }

    /// True for mirrors.
    pub fn is_mirror(&self) -> bool {
        self.name.starts_with(MIRROR)
    }

    /// True for parts that mark a light source in the editor.
    pub fn is_light_mark(&self) -> bool {
        self.name.starts_with(LIGHT_MARK)
    }

    /// True for parts that move with a joint, such as `hinge_1`.
    pub fn hangs_on(&self, joint: &str) -> bool {
        let kinds = ["opening", "window_pane", "window_mirror", "arm"];
        let after = kinds.iter().find_map(|kind| self.name.strip_prefix(&format!("sweethome3d_{kind}_on_{joint}")));
        after.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
    }
}

impl Model {
    /// The box around the model as `placed`; without parts, the one that [`cuboid`] fills.
    pub fn bounds(&self, placed: DAffine3, a: &Assembly) -> (DVec3, DVec3) {
        let place = |p: &ModelPart| placed * p.file_from_mesh;
        let points =
            self.parts.iter().flat_map(|p| a.mesh_at(p.mesh).positions.iter().map(move |v| place(p).transform_point3(v.as_dvec3())));
        let corners = (0..8).filter(|_| self.parts.is_empty()).map(|k| placed.transform_point3(corner(k)));
        points.chain(corners).fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
    }

    /// From the model to a box of side one around the origin, turned by `rotation`. Without `recenter` the turned model keeps the middle of
    /// the unturned one as its centre, as in older versions of Sweet Home 3D.
    pub fn normalized(&self, rotation: Option<DMat3>, recenter: bool, a: &Assembly) -> DAffine3 {
        let (min, max) = self.bounds(DAffine3::IDENTITY, a);
        let centered = DAffine3::from_translation(-0.5 * (min + max));
        let Some(rotation) = rotation else { return unit_scale(max - min) * centered };
        let turned = DAffine3::from_mat3(rotation) * centered;
        let (min, max) = self.bounds(turned, a);
        let moved = if recenter { DAffine3::from_translation(-0.5 * (min + max)) } else { DAffine3::IDENTITY };
        unit_scale(max - min) * moved * turned
    }
}

fn unit_scale(size: DVec3) -> DAffine3 {
    DAffine3::from_scale(size.max(DVec3::splat(FLAT)).recip())
}

/// Reads the model that `file` names and adds its meshes, materials and pictures to the scene.
///
/// # Errors
/// Why it cannot be used, as the rest of a sentence that begins with its name.
pub(super) fn load(archive: &Archive, file: &str, a: &mut Assembly) -> Result<Model, String> {
    let Some(imported) = read(archive, file)? else { return Ok(Model { parts: Vec::new() }) };
    add(imported, a).map_err(|e| format!("cannot be used ({e})"))
}

/// Reads a model of an archive as a scene of its own, in the model's unit and axes. Pictures that are missing become grey. `None` for one
/// of lines alone.
///
/// # Errors
/// Why it cannot be used, as the rest of a sentence that begins with its name.
pub(super) fn read(archive: &Archive, file: &str) -> Result<Option<Imported>, String> {
    let found = archive.find(file).ok_or("is not in the archive")?.to_string();
    let bytes = archive.read(&found).map_err(|e| format!("cannot be read ({e})"))?;
    if bytes.starts_with(b"PK\x03\x04") {
        let inner = Archive::new(&archive.file().join(&found), bytes).map_err(|e| format!("is {e}"))?;
        let object = inner.names().iter().find(|n| n.to_ascii_lowercase().ends_with(".obj"));
        let object = object.ok_or("is an archive without an OBJ model; save the piece as OBJ")?.clone();
        return read_obj(&inner, &object);
    }
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(512)]).to_lowercase();
    match () {
        () if bytes.starts_with(b"MM") => Err("is in the format 3DS, which is not supported; save it as OBJ".into()),
        () if start.contains("<collada") => Err("is in the format Collada, which is not supported; save it as OBJ".into()),
        () if start.starts_with("lwsc") => Err("is in the format LWS, which is not supported; save it as OBJ".into()),
        () => read_obj(archive, &found),
    }
}

fn read_obj(archive: &Archive, name: &str) -> Result<Option<Imported>, String> {
    let options = ImportOptions { up_axis: Some(UpAxis::Z), allow_missing_textures: true, ..ImportOptions::default() };
    let assembly = Assembly::new(Format::Obj, &archive.file().join(name), UpAxis::Z, &options, &Quiet).within(archive);
    match obj::load_java3d(assembly) {
        Ok(imported) => Ok(Some(glazed(imported))),
        Err(ImportError::Scene { source: SceneError::NoParts, .. }) if has_lines(archive, name) => Ok(None),
        Err(e) => Err(format!("cannot be used ({e})")),
    }
}

/// True for an OBJ file with lines, such as the model of Sweet Home 3D's light sources, which draws a sphere in the plan.
fn has_lines(archive: &Archive, name: &str) -> bool {
    archive.read(name).is_ok_and(|bytes| String::from_utf8_lossy(&bytes).lines().any(|line| line.trim_start().starts_with("l ")))
}

/// The model with panes and mirrors as in Sweet Home 3D's photographs, which recognise them by the names of parts, not by their materials.
fn glazed(imported: Imported) -> Imported {
    let mut scene = imported.scene;
    let mut known = HashMap::new();
    for part in &mut scene.parts {
        let (is_pane, is_mirror) = (part.name.starts_with(PANE), part.name.starts_with(MIRROR));
        if !(is_pane || is_mirror) {
            continue;
        }
        let own = part.material;
        part.material = *known.entry((own, is_mirror)).or_insert_with(|| {
            let material = scene.materials[own as usize].clone();
            let Some(glass) = (if is_mirror { mirror(material) } else { pane(material) }) else { return own };
            scene.materials.push(glass);
            (scene.materials.len() - 1) as u32
        });
    }
    let report = ImportReport::new(Format::Obj, &scene, imported.report.warnings);
    Imported { scene, report, ..imported }
}

/// Glass instead of an opaque material; `None` for one that lets light through as it is.
fn pane(mut material: Material) -> Option<Material> {
    let transmittance = tinted(*base_color(&mut material.bsdf)?);
    let opaque = matches!(material.alpha, Alpha::Opaque) && !material.bsdf.transmits();
    opaque.then_some(Material { bsdf: Bsdf::ThinDielectric { eta: GLASS, transmittance }, ..material })
}

/// A mirror of a material's colour; `None` for glass.
fn mirror(mut material: Material) -> Option<Material> {
    let reflectance = *base_color(&mut material.bsdf)?;
    let bsdf = Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance, alpha: 0.0.into() };
    Some(Material { bsdf, alpha: Alpha::Opaque, ..material })
}

/// Transmittance of a pane of this colour: half of the light takes the colour. A picture is used unchanged.
pub(super) fn tinted(color: ColorParam) -> ColorParam {
    if color.texture.is_some() { color } else { color.factor.map(|c| 0.5 + 0.5 * c).into() }
}

/// The colour of a surface that does not let light through by itself.
pub(super) fn base_color(bsdf: &mut Bsdf) -> Option<&mut ColorParam> {
    match bsdf {
        Bsdf::Diffuse { reflectance } | Bsdf::Conductor { reflectance, .. } => Some(reflectance),
        Bsdf::Plastic { diffuse, .. } => Some(diffuse),
        Bsdf::Principled(p) => Some(&mut p.base_color),
        _ => None,
    }
}

fn add(imported: Imported, a: &mut Assembly) -> Result<Model, ImportError> {
    let file = a.file().to_path_buf();
    let pieces = a.adopt(imported, &file)?;
    let part = |p: Piece| ModelPart { name: p.name, mesh: p.mesh, material: p.material, file_from_mesh: p.model_from_mesh };
    Ok(Model { parts: pieces.into_iter().map(part).collect() })
}

/// A grey box of side one, in place of a model that cannot be used.
pub(super) fn cuboid(a: &mut Assembly) -> Result<Model, ImportError> {
    let positions = (0..8).map(|k| corner(k).as_vec3()).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[p, q, r, s]| [[p, q, r], [p, r, s]]).collect();
    let file = a.file().to_path_buf();
    let material = a.push_material(Material::diffuse("stand_in", Rgb::splat(0.5)));
    let mesh = a.push_mesh(Mesh { positions, triangles, ..Mesh::default() }, &file, "stand-in")?;
    let part = |mesh| ModelPart { name: "box".into(), mesh, material, file_from_mesh: DAffine3::IDENTITY };
    Ok(Model { parts: mesh.map(part).into_iter().collect() })
}

/// One of the eight corners of the box of side one around the origin.
fn corner(k: u32) -> DVec3 {
    let at = |bit: u32| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
    DVec3::new(at(0), at(1), at(2))
}
