//! COLLADA 1.4 and 1.5 (`.dae`), as SketchUp, Blender, 3ds Max, ROS and Gazebo have their models.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | `asset` | the unit and the upward axis (x, y or z) |
//! | `visual_scene` | that of `scene`, else the first; without any, every geometry in its own place |
//! | `node` | an object with its parts, named after its `name`, else its `id`; `matrix`, `translate`, `rotate`, `scale`, `lookat`, `skew` in their order; `instance_node` |
//! | `instance_geometry` | a part per primitive; `.<material>` is appended where a geometry has several. Meshes are shared between nodes |
//! | `triangles`, `polylist`, `polygons`, `tristrips`, `trifans` | polygons are cut into triangles; the outer line of those with holes; lines are left out |
//! | `instance_controller` | a skin in the pose of its joints, a morph (`NORMALIZED`, `RELATIVE`) by its weights, a skin of a morph too, over time where joints or weights move. What names no joints of the scene stays as it was bound, with a warning. Normals of morphs are made anew |
//! | texture coordinates | the set that `bind_vertex_input` names, else the first |
//! | `profile_COMMON` | `lambert`, `phong`, `blinn`, `constant`: a diffuse surface; with `specular` a clear-coated one of GGX alpha √(2/(shininess+2)); `emission`; `transparent` and `transparency` in all four modes. An opacity of zero is taken for one, with a warning, since programs disagree about what zero means |
//! | colours | sRGB, as three.js takes them; those of Blender linear, as it writes them |
//! | textures | by `sampler2D` and `surface`, or by the picture's own id; wrapping |
//! | cameras | perspective |
//! | lights | point, spot and directional ones. COLLADA states no unit: strengths are W/sr and W/m² (Blender's are its watts and are divided by 4π); attenuation is that of light. Ambient light is left out |
//! | `library_animations` | all channels of the transforms of nodes and of the weights of morphs, on their own clock: whole transforms, single numbers, elements of matrices; steps, lines, Bézier's and Hermite's curves. Matrices turn the shortest way between two moments; scales and shears stay those of the scene |
//! | left out, with a warning | animations of all else, bump maps, reflections, other profiles, physics, files that a file refers to |
//!
//! Surfaces have two sides and emit on both.

mod animation;
mod curve;
mod deform;
mod document;
mod geometry;
mod light;
mod material;
mod node;
mod transform;

use crate::assembly::Assembly;
use crate::xml::xml_text;
use crate::{ImportError, Imported};
use document::{Dae, child, number, text};
use enfilade_math::{DMat3, DVec3};
use roxmltree::Document;

/// Imports a COLLADA file.
pub(crate) fn load(mut a: Assembly) -> Result<Imported, ImportError> {
    let bytes = a.read_scene_file()?;
    let decoded = xml_text(&bytes);
    let document = Document::parse(&decoded).map_err(|e| {
        a.malformed(format!("line {}:{}", e.pos().row, e.pos().col), format!("not well-formed XML: {e}; export the file again"))
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        let problem =
            format!("the outermost element is <{}>, expected <COLLADA>; check that this is a COLLADA file", root.tag_name().name());
        return Err(a.malformed("line 1", problem));
    }
    let dae = Dae::new(root);
    state_space(&dae, &mut a);
    node::place_scene(&dae, &mut a)?;
    a.finish()
}

/// States the unit and the axes of the file.
fn state_space(dae: &Dae, a: &mut Assembly) {
    let asset = child(dae.root, "asset");
    let unit = asset.and_then(|asset| child(asset, "unit")).and_then(|unit| unit.attribute("meter")).map(number);
    let metres = match unit {
        None => 1.0,
        Some(Some(metres)) if metres > 0.0 => metres,
        Some(_) => {
            a.warn("asset", "the unit is no number above zero; metres were taken");
            1.0
        }
    };
    let up = asset.and_then(|asset| child(asset, "up_axis")).map(text).filter(|up| !up.is_empty());
    if let Some(up) = up.as_deref().filter(|up| !["X_UP", "Y_UP", "Z_UP"].iter().any(|known| known.eq_ignore_ascii_case(up))) {
        a.warn("asset", format!("found {up:?} as up_axis, expected X_UP, Y_UP or Z_UP; y was taken, up_axis (--up-axis) sets another"));
    }
    if up.is_none() {
        a.leaves_up_to_rules();
    }
    let axes = match up.map(|up| up.to_ascii_uppercase()).as_deref() {
        Some("Z_UP") => DMat3::IDENTITY,
        // x up, with y to the left and z towards the viewer.
        Some("X_UP") => DMat3::from_cols(DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y),
        _ => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
    };
    a.state_space(metres, axes);
}
