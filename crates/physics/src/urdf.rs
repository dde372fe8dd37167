//! URDF: <http://wiki.ros.org/urdf/XML>.
//!
//! Bodies are links. What is fixed hangs on the link `world` by `fixed` joints, free bodies by `floating` ones; hinges are `revolute` (`continuous`
//! without limits), slides `prismatic`. Masses, centres and inertias stand in the file. Visual meshes and convex pieces are OBJ files.
//! URDF has no pairs without contact; the format's readers leave out those of parent and child.

use crate::files::{escaped, number, numbers, small, solid_obj, vector};
use crate::looks::mesh_name;
use crate::model::{JointKind, Model, Rigid};
use enfilade_math::DVec3;
use enfilade_scene::SceneFiles;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Greatest force (N) or torque (N·m), and greatest speed (m/s, rad/s), of joints with limits: URDF asks for them, and nothing drives these.
const EFFORT: f64 = 1000.0;
const VELOCITY: f64 = 10.0;

/// A model as URDF; `folder` is the name of the folder, beside the file, of what it names.
pub fn urdf(model: &Model, name: &str, folder: &str) -> SceneFiles {
    let mut text = format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", escaped(name));
    for look in &model.looks.materials {
        let texture = look.picture.map(|picture| format!("<texture filename=\"{folder}/{}\"/>", model.looks.pictures[picture].0));
        let texture = texture.unwrap_or_default();
        _ = writeln!(text, "  <material name=\"{}\"><color rgba=\"{}\"/>{texture}</material>", look.name, numbers(&look.rgba));
    }
    text.push_str("  <link name=\"world\"/>\n");
    let mut beside = BTreeMap::new();
    for body in &model.bodies {
        link(&mut text, model, body, folder, &mut beside);
        joint(&mut text, model, body);
    }
    text.push_str("</robot>\n");
    beside.extend(model.looks.files(folder));
    let mut notes = model.notes.clone();
    if !model.excluded.is_empty() {
        notes.push(format!("{} pairs of bodies that touch at a joint are not named: URDF has no such list", model.excluded.len()));
    }
    SceneFiles { main: text.into_bytes(), beside, notes }
}

fn link(text: &mut String, model: &Model, body: &Rigid, folder: &str, beside: &mut BTreeMap<String, Vec<u8>>) {
    let name = escaped(&body.name);
    _ = writeln!(text, "  <link name=\"{name}\">");
    if let Some(moments) = body.moments() {
        let [x, y, z] = [moments.inertia.x_axis, moments.inertia.y_axis, moments.inertia.z_axis];
        let values = [("ixx", x.x), ("ixy", x.y), ("ixz", x.z), ("iyy", y.y), ("iyz", y.z), ("izz", z.z)];
        let inertia: Vec<String> = values.iter().map(|(name, value)| format!("{name}=\"{}\"", small(*value))).collect();
        let (center, mass) = (vector(moments.center), small(moments.mass_kg));
        _ = writeln!(text, "    <inertial><origin xyz=\"{center}\"/><mass value=\"{mass}\"/><inertia {}/></inertial>", inertia.join(" "));
    }
    for visual in &body.visuals {
        let (mesh, material) = (mesh_name(visual.mesh), &model.looks.materials[visual.material].name);
        _ = writeln!(
            text,
            "    <visual><origin xyz=\"{}\"/><geometry><mesh filename=\"{folder}/{mesh}.obj\"/></geometry><material name=\"{material}\"/></visual>",
            vector(visual.place)
        );
    }
    for (piece, count) in body.pieces.iter().zip(1..) {
        let file = format!("{folder}/pieces/{}.{count}.obj", body.name);
        _ = writeln!(text, "    <collision><geometry><mesh filename=\"{}\"/></geometry></collision>", escaped(&file));
        beside.insert(file, solid_obj(&piece.solid));
    }
    text.push_str("  </link>\n");
}

fn joint(text: &mut String, model: &Model, body: &Rigid) {
    let (parent, from) =
        body.parent.map_or(("world", DVec3::ZERO), |parent| (model.bodies[parent].name.as_str(), model.bodies[parent].origin));
    let (word, axis) = match body.joint.kind {
        JointKind::Fixed => ("fixed", None),
        JointKind::Free => ("floating", None),
        JointKind::Hinge(axis) => (if body.joint.limits.is_some() { "revolute" } else { "continuous" }, Some(axis)),
        JointKind::Slide(axis) => ("prismatic", Some(axis)),
    };
    let name = escaped(&body.name);
    _ = writeln!(text, "  <joint name=\"{name}.joint\" type=\"{word}\">");
    _ = writeln!(
        text,
        "    <parent link=\"{}\"/><child link=\"{name}\"/><origin xyz=\"{}\"/>",
        escaped(parent),
        vector(body.origin - from)
    );
    if let Some(axis) = axis {
        let range = body.joint.limits.map(|[least, greatest]| format!(" lower=\"{}\" upper=\"{}\"", number(least), number(greatest)));
        let range = range.or_else(|| (word == "prismatic").then(|| " lower=\"-1000\" upper=\"1000\"".into())).unwrap_or_default();
        _ = writeln!(text, "    <axis xyz=\"{}\"/><limit effort=\"{EFFORT}\" velocity=\"{VELOCITY}\"{range}/>", vector(axis));
        let (damping, friction) = (small(body.joint.damping), small(body.joint.friction));
        _ = writeln!(text, "    <dynamics damping=\"{damping}\" friction=\"{friction}\"/>");
    }
    text.push_str("  </joint>\n");
}
