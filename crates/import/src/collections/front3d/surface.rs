//! The meshes of the building, their classes and their materials.

use super::super::assets::unless_odd;
use super::house::{House, Paint, Surface};
use crate::ImportError;
use crate::assembly::{Assembly, Source};
use crate::images::Use;
use enfilade_geometry::Mesh;
use enfilade_math::{Rgb, Vec2, Vec3, linear_from_srgb};
use enfilade_scene::{Bsdf, ColorParam, Material, TextureRef};
use std::collections::HashMap;
use std::path::PathBuf;

/// The folder of pictures.
pub(super) const PICTURES: &str = "3D-FRONT-texture";
/// Reflectance of what has neither picture nor colour: the toolbox's light grey, 220 of 255.
const PLAIN: f32 = 220.0;

/// Classes by the type of a mesh, in lower case. Others are recognised by the words wall, floor and ceil in them, as in the toolbox.
const TYPES: [(&str, i16); 22] = [
    ("baseboard", 1),
    ("cornice", 1),
    ("customized_wainscot", 1),
    ("customizedbackgroundmodel", 1),
    ("slabtop", 2),
    ("cabinet", 3),
    ("door", 8),
    ("window", 9),
    ("baywindow", 9),
    ("lightband", 35),
    ("hole", 38),
    ("pocket", 38),
    ("beam", 38),
    ("column", 38),
    ("flue", 38),
    ("sewerpipe", 38),
    ("slabbottom", 38),
    ("slabside", 38),
    ("customizedplatform", 38),
    ("customizedfurniture", 39),
    ("customizedfixedfurniture", 39),
    ("customizedpersonalizedmodel", 39),
];

/// The class of a type of mesh.
fn class_of(kind: &str) -> Option<i16> {
    let kind = kind.to_lowercase();
    let listed = TYPES.iter().find(|(name, _)| *name == kind).map(|(_, class)| *class);
    let words = [("ceil", 22), ("floor", 2), ("wall", 1)];
    listed.or_else(|| words.into_iter().find(|(word, _)| kind.contains(word)).map(|(_, class)| class))
}

/// A mesh of the building in a room; mesh and material as indices into the scene.
pub(super) struct Placed {
    pub class: Option<i16>,
    pub name: String,
    pub mesh: u32,
    pub material: u32,
}

/// The meshes of a house, each made at first use.
pub(super) struct Surfaces<'h> {
    all: HashMap<&'h str, &'h Surface>,
    paints: HashMap<&'h str, &'h Paint>,
    pictures: Option<PathBuf>,
    /// `None` for those without faces.
    meshes: HashMap<&'h str, Option<u32>>,
    materials: HashMap<&'h str, u32>,
    /// True once it was reported that pictures are not available.
    told: bool,
}

impl<'h> Surfaces<'h> {
    /// Surfaces of a house; `pictures` is the folder of its pictures, where it is available.
    pub fn new(house: &'h House, pictures: Option<PathBuf>) -> Self {
        let all = house.mesh.iter().map(|mesh| (mesh.uid.as_str(), mesh)).collect();
        let paints = house.material.iter().map(|paint| (paint.uid.as_str(), paint)).collect();
        Self { all, paints, pictures, meshes: HashMap::new(), materials: HashMap::new(), told: false }
    }

    /// True for a mesh of the house.
    pub fn knows(&self, id: &str) -> bool {
        self.all.contains_key(id)
    }

    /// A mesh as it is called in a room; `None` where there is none, or none with faces, and, with a warning,
    /// for one whose lists make no mesh.
    ///
    /// # Errors
    /// When its picture cannot be decoded.
    pub fn get(&mut self, id: &str, room: &str, a: &mut Assembly) -> Result<Option<Placed>, ImportError> {
        let Some(&surface) = self.all.get(id) else { return Ok(None) };
        let mesh = match self.meshes.get(id) {
            Some(known) => *known,
            None => {
                let file = a.file().to_path_buf();
                let place = format!("mesh {:?}", surface.uid);
                let made = mesh(surface).map_err(|problem| a.malformed(&place, problem)).and_then(|mesh| a.push_mesh(mesh, &file, &place));
                let pushed = unless_odd(made, "mesh", "a mesh", a)?.flatten();
                self.meshes.insert(surface.uid.as_str(), pushed);
                pushed
            }
        };
        let Some(mesh) = mesh else { return Ok(None) };
        let material = self.material(surface, a)?;
        let kind = if surface.r#type.is_empty() { "mesh" } else { surface.r#type.as_str() };
        Ok(Some(Placed { class: class_of(kind), name: format!("{kind} ({room})"), mesh, material }))
    }

    fn material(&mut self, surface: &'h Surface, a: &mut Assembly) -> Result<u32, ImportError> {
        let id = surface.material.as_str();
        if let Some(known) = self.materials.get(id) {
            return Ok(*known);
        }
        let paint = self.paints.get(id).copied();
        let picture = paint.map(|paint| self.picture(paint, a)).transpose()?.flatten();
        let color = paint.and_then(|p| p.color.as_deref()).and_then(|c| Some([*c.first()?, *c.get(1)?, *c.get(2)?])).unwrap_or([PLAIN; 3]);
        let [r, g, b] = color.map(|v| linear_from_srgb((v / 255.0).clamp(0.0, 1.0)));
        let reflectance = match picture {
            Some(texture) => ColorParam { factor: Rgb::WHITE, texture: Some(texture) },
            None => Rgb::new(r, g, b).into(),
        };
        let name = paint.map_or("plain", |paint| if paint.jid.is_empty() { paint.uid.as_str() } else { paint.jid.as_str() });
        let index = a.push_material(Material::new(name, Bsdf::Diffuse { reflectance }));
        self.materials.insert(id, index);
        Ok(index)
    }

    /// The picture of a material, where it has one that is available.
    fn picture(&mut self, paint: &Paint, a: &mut Assembly) -> Result<Option<TextureRef>, ImportError> {
        if paint.jid.is_empty() || (paint.texture.is_empty() && self.pictures.is_none()) {
            return Ok(None);
        }
        let file = self.pictures.as_ref().map(|folder| folder.join(&paint.jid).join("texture.png"));
        let Some(file) = file.filter(|file| file.is_file()) else {
            if !std::mem::replace(&mut self.told, true) {
                let message = format!("pictures such as that of {:?} are not in a folder {}; colours stand in", paint.jid, PICTURES);
                a.warn("material", message);
            }
            return Ok(None);
        };
        let path = std::path::absolute(&file).unwrap_or(file);
        let found = a.image(&Source::File(&path.to_string_lossy()), Use::Color, &format!("material {:?}", paint.uid))?;
        let uv_transform = match paint.uv_transform.as_deref() {
            Some(&[a, b, _, c, d, ..]) if [a, b, c, d].iter().all(|v| v.is_finite()) => [[a, b, 0.0], [c, d, 0.0]],
            _ => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        };
        Ok(found.map(|image| TextureRef { uv_transform, ..TextureRef::new(image) }))
    }
}

/// The mesh, or what is wrong with its lists.
fn mesh(surface: &Surface) -> Result<Mesh, String> {
    let vertices = surface.xyz.len() / 3;
    let lists = [("xyz", surface.xyz.len(), 3), ("faces", surface.faces.len(), 3)];
    if let Some((list, found, of)) = lists.into_iter().find(|(_, found, of)| found % of != 0) {
        return Err(format!("found {found} numbers in {list}, expected a multiple of {of}; download the house again"));
    }
    let position = |c: &[f64]| Vec3::new(c[0] as f32, c[1] as f32, c[2] as f32);
    let mut mesh = Mesh {
        positions: surface.xyz.chunks_exact(3).map(position).collect(),
        triangles: surface.faces.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        ..Mesh::default()
    };
    if surface.normal.len() == 3 * vertices {
        mesh.normals = surface.normal.chunks_exact(3).map(|c| Vec3::new(c[0], c[1], c[2])).collect();
    }
    if surface.uv.len() == 2 * vertices {
        mesh.uvs = surface.uv.chunks_exact(2).map(|c| Vec2::new(c[0], c[1])).collect();
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_of_meshes_tell_classes() {
        let types =
            [("WallInner", 1), ("CustomizedFeatureWall", 1), ("SmartCustomizedCeiling", 22), ("Floor", 2), ("BayWindow", 9), ("Back", -1)];
        for (kind, class) in types {
            assert_eq!(class_of(kind).unwrap_or(-1), class, "{kind}");
        }
    }
}
