//! Scans whose faces have the number of their object: Replica, and Matterport3D in the layout of Habitat.
//!
//! A scene has no colours of vertices: each object has the mean of its own.

use super::objects::Objects;
use crate::assembly::Assembly;
use crate::{ImportError, ply};
use enfilade_math::{DAffine3, Rgb};
use enfilade_scene::Material;
use std::path::Path;

/// Reflectance of surfaces without a colour.
const GREY: f32 = 0.5;

/// Adds the objects of an annotated mesh. `category` maps the number of a face to the object's number and category.
///
/// # Errors
/// When the mesh cannot be read.
pub(super) fn add(
    file: &Path,
    category: &dyn Fn(i64) -> (i64, Option<String>),
    objects: &mut Objects,
    a: &mut Assembly,
) -> Result<(), ImportError> {
    let bytes = a.read_input(file, "it holds the scene's faces; unpack the collection again")?;
    let mut colored = false;
    for object in ply::read_objects(&bytes, file)? {
        let (number, category) = category(object.id);
        let Some(mesh) = a.push_mesh(object.mesh, file, &format!("object {}", object.id))? else { continue };
        colored |= object.color.is_some();
        let color = object.color.map_or(Rgb::splat(GREY), Rgb::from);
        let placed = objects.next(category.as_deref(), &number.to_string());
        let material = a.push_material(Material::diffuse(placed.name.clone(), color));
        a.push_part(&placed.name, mesh, material, DAffine3::IDENTITY, placed.label);
    }
    if colored {
        a.warn("colours", "colours of vertices are not supported; each object has the mean of its own");
    }
    Ok(())
}
