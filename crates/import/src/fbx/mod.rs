//! Autodesk FBX, versions 6100 to 7700, binary and as text.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | units and axes | the file's own: its `UnitScaleFactor` says how long a unit is, its axes which way is up. [`crate::ImportOptions::meters_per_unit`] multiplies the file's own length (so 1, its default, keeps it), and [`crate::ImportOptions::up_axis`], where it is given, overrides the file's axes |
//! | nodes | one part per node and material, named after the node, else its mesh, else `node_<index>`; `.<material>` is appended where a mesh has several; pivots, pre- and post-rotation, geometric transforms and modes of inheriting scale; meshes are shared between nodes |
//! | meshes | any number of corners, concave ones cut properly, holes left out; normals as in the file, else from its smoothing; material per face; texture coordinates of the set that the base colour wants, else the first |
//! | visibility | hidden nodes and those of hidden layers are left out with a warning each, as are all levels of detail but the first |
//! | Lambert | a diffuse surface |
//! | Phong | a clear-coated one of GGX alpha √(2/(exponent+2)), which loses no light; a highlight on black is a mirror of its colour |
//! | Arnold and OSL standard surface, OpenPBR, 3ds Max physical and PBR, Stingray, glTF, Blender's Phong | metallic-roughness with index of refraction, specular, transmission, coat, sheen, emission and opacity; glossiness becomes roughness |
//! | normals | a normal map where the picture is coloured, of Blender's strength in its files; else heights |
//! | bump | a normal map where the picture looks like one (most texels as long as a unit vector, out of the surface on average), else heights by its luminance (guessed: one means 5 mm times the factor) |
//! | textures | PNG, JPEG and all that [`crate`] decodes: from the file, else by relative path, by absolute path, and by name beside the file, in `<file>.fbm/` or `textures/`; scale (2 shows the picture twice; Blender writes one over it), turn (Blender writes it backwards, in radians), offset, wrapping. Of layered and computed ones the first picture |
//! | colours | taken as linear; textures as sRGB |
//! | point, spot, directional lights | see below; spots dim evenly with the angle, those of Blender by its own law |
//! | area lights | a square two units wide that shines along its axis, as FBX does not state its size |
//! | cameras | perspective, by field of view or focal length and aperture; orthographic ones, film offset and roll are dropped |
//! | animation | the first one moves nodes that keep their scale, from its first moment on, sixty states a second where they do not move evenly; else the pose of the nodes |
//! | skins, blend shapes, nodes whose scale changes | the first animation changes the shapes of their meshes, so that no vertex is more than 0.1 mm from the file's halfway between two states; lights and cameras in such nodes stay. Without an animation as at rest, with a warning |
//! | dropped with a warning | vertex colours, points and lines, NURBS, curves, subdivision, caches of positions, subsurface scattering, anisotropy, thin film, displacement, normal maps of coats, volume lights (replaced by a point) |
//!
//! Every surface has two sides, and emits on both, as FBX knows no sides.
//!
//! # Strength of lights
//!
//! FBX gives intensity as a percentage without a unit. Blender writes hundred times its watts: a lamp of W watts becomes W/(4π) W/sr,
//! its sun's strength irradiance, W/m². For other programs one (100 %) is 1 W/sr at a point or spot, with quadratic decay in the file's
//! own unit of length, as they compute it; 1 W/m² for a directional light; radiance 1 for an area.
//!
//! # Safety
//!
//! The C library [ufbx](https://github.com/ufbx/ufbx) reads the file, from memory, with a limit on what it allocates; it opens no
//! other file.

mod animation;
mod deform;
mod light;
mod material;
mod matrix;
mod mesh;
mod node;
mod reader;
mod texture;

use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use enfilade_math::{DMat3, DVec3};

/// Imports an FBX file.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let (scene, animations, clip) = reader::read(&mut assembly)?;
    let settings = &scene.settings;
    let axes = reader::world_from_axes(&settings.axes).unwrap_or_else(|| {
        assembly.warn("GlobalSettings", "the file does not say which axis is up; y was used");
        DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y)
    });
    let metres = settings.unit_meters;
    let usable = metres.is_finite() && metres > 0.0;
    if !usable {
        assembly.warn("GlobalSettings", format!("found a unit of {metres} m; one of 1 cm was used"));
    }
    assembly.state_space(if usable { metres } else { 0.01 }, axes);
    node::place(&scene, (&animations, clip.as_ref()), &mut assembly)?;
    assembly.finish()
}
