//! Robots, furniture and worlds of robotics: URDF (ROS, PyBullet, PartNet-Mobility) and SDF (Gazebo).
//!
//! | feature | what becomes of it |
//! |---|---|
//! | links | each an object of its own within the robot or model, where the joints have it at rest (URDF) or its `pose` (SDF) |
//! | `visual` | a part: mesh files (glTF, OBJ, STL, COLLADA, PLY, USD, FBX) with their `scale`, boxes, cylinders, spheres, capsules, planes of SDF |
//! | mesh files | beside the file, or by `package://`, `model://` and `file://` in the folders above; in their own unit, and in their own axes taken as they are, as RViz does. One that is missing is an error, unless [`ImportOptions::allow_missing_meshes`](crate::ImportOptions::allow_missing_meshes) is set |
//! | materials | colours (sRGB) and pictures of URDF; `diffuse`, `emissive` and the maps of `pbr` in SDF. A mesh with materials of its own keeps them |
//! | `world`, `model` and `include` of SDF | models within models; includes are looked for as mesh files are, as `model.sdf`. Where a world has a `state`, models, links and lights stand as the first one says, which Gazebo restores when it loads the world |
//! | `light` of SDF | point, spot and directional; SDF states no unit: strengths are W/sr and W/m², by `intensity` |
//! | joints of URDF | bodies that move, with axis and limits: `revolute`, `continuous`, `prismatic`, `floating`; `mimic` is followed by [`ImportOptions::states`](crate::ImportOptions::states) |
//! | joints of SDF | the same: `revolute`, `continuous`, `prismatic`, `ball`; `fixed` ones hold together. Axes by `expressed_in`, poses by `relative_to`. Of joints that close a circle one is left out with a warning, and so are screws, gears and universal joints |
//! | inertias, collisions, sensors, plug-ins | without effect |
//!
//! Both are in metres with z up. Xacro is a program that writes URDF; its elements are reported and left out. Vectors may have commas.

pub(crate) mod mjcf;
mod partnet;
mod sdf;
mod sdf_frames;
mod sdf_joints;
mod shapes;
mod urdf;

use crate::assembly::Assembly;
use crate::joints::elements::tell_of_xacro;
use crate::{ImportError, Imported, UpAxis};
use roxmltree::{Document, Node};

/// Imports a URDF file.
pub(crate) fn load_urdf(a: Assembly) -> Result<Imported, ImportError> {
    load(a, "robot", urdf::place)
}

/// Imports an SDF file.
pub(crate) fn load_sdf(a: Assembly) -> Result<Imported, ImportError> {
    load(a, "sdf", sdf::place)
}

fn load(
    mut a: Assembly,
    outermost: &str,
    place: impl FnOnce(Node, &mut shapes::Shapes, &mut Assembly) -> Result<(), ImportError>,
) -> Result<Imported, ImportError> {
    a.set_units(1.0, UpAxis::Z);
    let bytes = a.read_scene_file()?;
    let text = crate::xml::xml_text(&bytes);
    let document = Document::parse(&text)
        .map_err(|e| a.malformed(format!("line {}:{}", e.pos().row, e.pos().col), format!("not well-formed XML: {e}")))?;
    let root = document.root_element();
    let found = root.tag_name().name();
    let fits = found == outermost || (outermost == "sdf" && found == "gazebo");
    if !fits {
        return Err(a.malformed("line 1", format!("the outermost element is <{found}>, expected <{outermost}>")));
    }
    tell_of_xacro(root, &mut a);
    let mut shapes = shapes::Shapes::of(a.file());
    place(root, &mut shapes, &mut a)?;
    a.finish()
}
