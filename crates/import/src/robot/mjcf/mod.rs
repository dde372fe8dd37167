//! MuJoCo's models (MJCF), as <https://mujoco.readthedocs.io/en/stable/XMLreference.html> has them.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | `include`, `compiler`, `default` | followed: angles, folders, `eulerseq`, `autolimits`, classes with `childclass`. Global coordinates are refused |
//! | bodies | each an object within the one that it is in, as is each geom of the world itself; `frame` and `replicate` are followed; `attach` is refused |
//! | geoms | a part each, called after the geom, else after its body and mesh: planes, boxes, spheres, ellipsoids, capsules, cylinders, meshes (OBJ, STL, MSH), smooth across edges of less than 37° where the file has no normals. Groups 0 to 2 as in MuJoCo's viewer, or those of [`ImportOptions::geom_groups`](crate::ImportOptions::geom_groups). Planes without an end are cut at 10 m. Height fields and signed distances are left out with a warning |
//! | materials | colours (sRGB), textures (2d: by the mesh's coordinates, else from above; cube: on the six sides of the box around the thing), built-in checkers, gradients and edges; `specular`, `shininess` (GGX of Phong's exponent 128 × shininess), `metallic`, `roughness`, `emission` (radiance of the colour), `reflectance` (a clear coat) |
//! | joints | bodies that move: hinges, slides, balls and free ones, with limits; several joints of one body are a chain. Without states all is at rest (`qpos0`) |
//! | cameras | those of the mode `fixed` ride on the body that they are in; others are where they are at rest, also those that look at a body |
//! | lights | directional, point and spot; without a unit, see the warning |
//! | skies, fog, the headlight, tendons, skins, flexible bodies, sites | without effect |

mod forms;
mod geoms;
mod meshes;
mod omitted;
mod pictures;
mod settings;
mod shade;
mod smooth;
mod tree;
mod views;
mod walk;

use crate::assembly::Assembly;
use crate::joints::states::{self, States, Tree};
use crate::{ImportError, Imported, UpAxis};
use tree::Element;
use walk::Walk;

/// MuJoCo's time step where a model states none, seconds.
const STEP_S: f64 = 0.002;

/// Imports a model of MuJoCo.
pub(crate) fn load(mut a: Assembly) -> Result<Imported, ImportError> {
    a.set_units(1.0, UpAxis::Z);
    let root = tree::read(&mut a)?;
    let mut walk = Walk::of(&root)?;
    walk.world(&mut a)?;
    let step_s = root.all("option").find_map(|option| option.number("timestep").ok()?).unwrap_or(STEP_S);
    if let Some(states) = States::read(Some(step_s), &mut a)? {
        states::apply(&states, &Tree { joints: &walk.joints, links: &walk.links, ordered: true }, &mut a)?;
    }
    a.drop_unused_bodies();
    walk.omitted.report(&mut a);
    report(&root, &mut a);
    a.finish()
}

/// Says what of a model has no effect.
fn report(root: &Element, a: &mut Assembly) {
    let within = |outer: &str, inner: &str| root.all(outer).flat_map(|scope| scope.all(inner)).count();
    let skies = root.all("asset").flat_map(|asset| asset.all("texture")).filter(|texture| texture.text("type") == Some("skybox")).count();
    if skies > 0 {
        a.warn(
            "texture",
            "the sky (skybox) gives no light in MuJoCo and was left out; environment = \"sky\" or a picture surrounds the scene",
        );
    }
    let soft = within("deformable", "skin") + within("deformable", "flex") + within("asset", "skin");
    if soft > 0 {
        a.warn("deformable", format!("{soft} skins and flexible bodies were left out"));
    }
    if within("equality", "joint") + within("equality", "connect") + within("equality", "weld") > 0 {
        a.warn("equality", "constraints are not followed: states have the pose of every joint");
    }
    let glows = |material: &Element| material.number("emission").is_ok_and(|emission| emission.is_some_and(|emission| emission > 0.0));
    let has_light =
        root.all("worldbody").any(|world| contains(world, "light")) || root.all("asset").flat_map(|asset| asset.all("material")).any(glows);
    if !has_light {
        a.warn(
            "light",
            "the model has no light but MuJoCo's headlight, which is left out; environment = \"sky\" or lamps = \"ceiling\" add light",
        );
    }
}

fn contains(element: &Element, tag: &str) -> bool {
    element.children.iter().any(|child| child.tag == tag || contains(child, tag))
}
