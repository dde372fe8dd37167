//! Stanford PLY, as a scene of its own and as the mesh of a shape in Mitsuba's and pbrt's scenes.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | encodings | text, and binary in either byte order |
//! | rows of text | each a line, or several; one that ends within a line is an error, since its file does not match the header. What follows the last row is left out, with a warning |
//! | faces | any number of corners: convex polygons as fans, concave ones cut properly |
//! | `nx ny nz` | vertex normals; a mesh without any is shaded flat |
//! | `tristrips` | strips of triangles, which −1 ends |
//! | `u v`, `s t`, `texture_u texture_v` of vertices, `texcoord` of faces | texture coordinates, v upward |
//! | `comment TextureFile wood.png` | the picture of the colour; the first where there are several |
//! | `red green blue` of vertices or faces | a scene has no colours of vertices: their mean, read as sRGB, becomes the one colour of the part, and the report says so |
//! | dropped with a warning | edges, materials, whatever else is neither a vertex nor a face; other properties |
//! | an error | a file without faces: a cloud of points has no surface |
//!
//! A scene from a PLY file is one part, named after the file, with a diffuse grey surface of two sides. PLY knows neither lights nor
//! cameras, units or axes: name [`meters_per_unit`](crate::ImportOptions::meters_per_unit), [`up_axis`](crate::ImportOptions::up_axis)
//! (scans of rooms often have z up; y is the default) and an [`environment`](crate::ImportOptions::environment).

mod attributes;
mod faces;
mod header;
mod objects;
mod reader;
mod values;

pub(crate) use attributes::Means;
pub(crate) use objects::read_objects;
pub(crate) use reader::read;

use crate::assembly::{Assembly, Source};
use crate::images::Use;
use crate::{ImportError, Imported};
use enfilade_math::{DAffine3, Rgb, linear_from_srgb};
use enfilade_scene::{Bsdf, ColorParam, Material, PartLabel, TextureRef};
use reader::PlyFile;

/// Reflectance of a surface without colours.
const GREY: f32 = 0.5;

/// Imports a PLY file as a scene of one part.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = assembly.read_scene_file()?;
    let ply = read(&bytes, &file, false, assembly.meters_per_unit())?;
    if ply.mesh.triangles.is_empty() {
        let problem = format!(
            "the file has {} vertices but no faces: a cloud of points has no surface to render; make a mesh of it first",
            ply.mesh.positions.len()
        );
        return Err(assembly.malformed("element face", problem));
    }
    for element in &ply.skipped {
        assembly.warn(format!("element {element}"), "only vertices and faces are read; it was left out");
    }
    if let Some(trailing) = &ply.trailing {
        assembly.warn("end of the file", trailing);
    }
    for (element, properties) in &ply.unused {
        assembly.warn(format!("element {element}"), format!("the properties {} are not read", properties.join(", ")));
    }
    let name = file.file_stem().map_or_else(|| "mesh".to_string(), |s| s.to_string_lossy().into_owned());
    let picture = picture(&ply, &mut assembly)?;
    let mean = ply.mean_color.map(|[r, g, b]| Rgb::new(r as f32, g as f32, b as f32).map(linear_from_srgb));
    let reflectance = match (picture, mean) {
        (Some(picture), _) => ColorParam { factor: Rgb::WHITE, texture: Some(picture) },
        (None, Some(mean)) => {
            let message = "colours of vertices are not supported; their mean (or the faces') is the colour of the whole part";
            assembly.warn("element vertex", message);
            mean.into()
        }
        (None, None) => Rgb::splat(GREY).into(),
    };
    let material = Material { bsdf: Bsdf::Diffuse { reflectance }, ..Material::diffuse(name.clone(), Rgb::splat(GREY)) };
    let material = assembly.push_material(material);
    if let Some(mesh) = assembly.push_mesh_from(ply.origin, ply.mesh, &file, "mesh")? {
        assembly.push_part(&name, mesh, material, DAffine3::IDENTITY, PartLabel::NONE);
    }
    assembly.finish()
}

/// The picture that a comment of the file names; `None`, with a warning, where there are no coordinates for it.
fn picture(ply: &PlyFile, a: &mut Assembly) -> Result<Option<TextureRef>, ImportError> {
    let Some(name) = ply.pictures.first() else { return Ok(None) };
    let place = "comment TextureFile";
    if ply.pictures.len() > 1 {
        a.warn(place, format!("there are {} pictures; the first, {name}, was used for all faces", ply.pictures.len()));
    }
    if ply.mesh.uvs.is_empty() {
        a.warn(place, format!("{name} was not used, since neither vertices nor faces have texture coordinates"));
        return Ok(None);
    }
    if ply.mean_color.is_some() {
        a.warn(place, "the colours beside the picture were dropped");
    }
    let path = a.find(&[name], &["", "textures/", "Textures/"]).unwrap_or_else(|| name.clone());
    Ok(a.image(&Source::File(&path), Use::Color, place)?.map(TextureRef::new))
}
