//! Stanford PLY, as a scene of its own and as the mesh of a shape in Mitsuba's and pbrt's scenes.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | encodings | text, and binary in either byte order |
//! | faces | any number of corners: convex polygons as fans, concave ones cut properly |
//! | `nx ny nz` | vertex normals; a mesh without any is shaded flat |
//! | `u v`, `s t`, `texture_u texture_v` | texture coordinates, v upward |
//! | `red green blue` | a scene has no colours of vertices: their mean, read as sRGB, becomes the one colour of the part, and the report says so |
//! | dropped with a warning | edges, strips of triangles, materials, whatever else is neither a vertex nor a face; `texcoord` of faces |
//! | an error | a file without faces: a cloud of points has no surface |
//!
//! A scene from a PLY file is one part, named after the file, with a diffuse grey surface of two sides. PLY knows neither lights nor
//! cameras, units or axes: name [`meters_per_unit`](crate::ImportOptions::meters_per_unit), [`up_axis`](crate::ImportOptions::up_axis)
//! (scans of rooms often have z up; y is the default) and an [`environment`](crate::ImportOptions::environment).

mod header;
mod reader;

pub(crate) use reader::read;

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DAffine3, Rgb, linear_from_srgb};
use enfilade_scene::{Material, PartLabel};

/// Reflectance of a surface without colours.
const GREY: f32 = 0.5;

/// Imports a PLY file as a scene of one part.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = assembly.read_scene_file()?;
    let ply = read(&bytes, &file)?;
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
    if ply.has_face_uvs {
        assembly.warn("element face", "texture coordinates of faces are not supported and were dropped; write them to the vertices");
    }
    let name = file.file_stem().map_or_else(|| "mesh".to_string(), |s| s.to_string_lossy().into_owned());
    let color = ply.mean_color.map(|[r, g, b]| Rgb::new(r as f32, g as f32, b as f32).map(linear_from_srgb));
    if color.is_some() {
        assembly.warn("element vertex", "colours of vertices are not supported; their mean is the colour of the whole part");
    }
    let material = assembly.push_material(Material::diffuse(name.clone(), color.unwrap_or(Rgb::splat(GREY))));
    if let Some(mesh) = assembly.push_mesh(ply.mesh, &file, "mesh")? {
        assembly.push_part(&name, mesh, material, DAffine3::IDENTITY, PartLabel::NONE);
    }
    assembly.finish()
}
