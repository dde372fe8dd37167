//! MJCF, MuJoCo's own format: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.
//!
//! Bodies are nested; joints are `freejoint`, `hinge` and `slide` with `range`, `damping` and `frictionloss`. Convex pieces are meshes whose vertices
//! stand in the file, in group 3; visual meshes are OBJ files, in group 2, which touch nothing and have no mass. Inertia is MuJoCo's, from the
//! pieces and their masses.

use crate::files::{escaped, number, numbers, small, vector};
use crate::looks::mesh_name;
use crate::model::{Joint, JointKind, Model, Rigid};
use enfilade_compose::FRICTION;
use enfilade_math::DVec3;
use enfilade_scene::SceneFiles;
use std::fmt::Write;

/// Seconds of a step.
const STEP_S: f64 = 0.002;
/// Time constant of contacts and of friction in joints, seconds: the stiffest that steps of that length allow with some reserve.
const CONTACT_S: f64 = 0.006;
/// Friction about the normal, metres, and against rolling, metres.
const TURNING: [f64; 2] = [0.005, 0.0005];

/// A model as MJCF; `folder` is the name of the folder, beside the file, of what it names.
pub fn mjcf(model: &Model, name: &str, folder: &str) -> SceneFiles {
    let mut writer = Writer { model, assets: String::new(), out: String::new() };
    for number in (0..model.bodies.len()).filter(|number| model.bodies[*number].parent.is_none()) {
        writer.body(number, DVec3::ZERO, 2);
    }
    let bodies = writer.out;
    let text = format!(
        "<mujoco model=\"{name}\">\n{head}  <asset>\n{looks}{pieces}  </asset>\n  <worldbody>\n{bodies}  </worldbody>\n{excluded}</mujoco>\n",
        name = escaped(name),
        head = head(folder),
        looks = looks(model),
        pieces = writer.assets,
        excluded = excluded(model),
    );
    SceneFiles { main: text.into_bytes(), beside: model.looks.files(folder).collect(), notes: model.notes.clone() }
}

/// Settings, and what all geoms share.
fn head(folder: &str) -> String {
    let folder = escaped(folder);
    format!(
        "  <compiler angle=\"radian\" meshdir=\"{folder}\" texturedir=\"{folder}\"/>
  <option timestep=\"{STEP_S}\" integrator=\"implicitfast\" cone=\"elliptic\" impratio=\"10\">
    <flag multiccd=\"enable\"/>
  </option>
  <default>
    <default class=\"visual\">
      <geom type=\"mesh\" contype=\"0\" conaffinity=\"0\" group=\"2\" mass=\"0\"/>
    </default>
    <default class=\"piece\">
      <geom type=\"mesh\" group=\"3\" condim=\"6\" friction=\"{FRICTION} {}\" solref=\"{CONTACT_S} 1\"/>
    </default>
  </default>
",
        numbers(&TURNING)
    )
}

/// Pictures, materials and visual meshes.
fn looks(model: &Model) -> String {
    let mut text = String::new();
    for (file, _) in &model.looks.pictures {
        let name = stem(file);
        _ = writeln!(text, "    <texture name=\"{name}\" type=\"2d\" file=\"{file}\"/>");
    }
    for look in &model.looks.materials {
        let texture = look.picture.map(|picture| format!(" texture=\"{}\"", stem(&model.looks.pictures[picture].0))).unwrap_or_default();
        _ = writeln!(text, "    <material name=\"{}\" rgba=\"{}\"{texture}/>", look.name, numbers(&look.rgba));
    }
    for name in (0..model.looks.meshes.len()).map(mesh_name) {
        // Surfaces that enclose nothing have no inertia of a volume.
        _ = writeln!(text, "    <mesh name=\"{name}\" file=\"{name}.obj\" inertia=\"shell\"/>");
    }
    text
}

fn stem(file: &str) -> &str {
    file.split('.').next().unwrap_or(file)
}

fn excluded(model: &Model) -> String {
    if model.excluded.is_empty() {
        return String::new();
    }
    let mut text = String::from("  <contact>\n");
    for [a, b] in &model.excluded {
        _ = writeln!(text, "    <exclude body1=\"{}\" body2=\"{}\"/>", model.bodies[*a].name, model.bodies[*b].name);
    }
    text + "  </contact>\n"
}

struct Writer<'m> {
    model: &'m Model,
    assets: String,
    out: String,
}

impl Writer<'_> {
    /// A body and those on it; `from` is the origin of its parent.
    fn body(&mut self, number: usize, from: DVec3, depth: usize) {
        let body = &self.model.bodies[number];
        let indent = "  ".repeat(depth);
        _ = writeln!(self.out, "{indent}<body name=\"{}\" pos=\"{}\">", escaped(&body.name), vector(body.origin - from));
        joint(&mut self.out, body, &indent);
        for visual in &body.visuals {
            let (mesh, material) = (mesh_name(visual.mesh), &self.model.looks.materials[visual.material].name);
            let place = vector(visual.place);
            _ = writeln!(self.out, "{indent}  <geom class=\"visual\" mesh=\"{mesh}\" material=\"{material}\" pos=\"{place}\"/>");
        }
        for (piece, count) in body.pieces.iter().zip(1..) {
            let name = escaped(&format!("{}.{count}", body.name));
            let corners: Vec<f64> = piece.solid.corners.iter().flat_map(|corner| corner.to_array()).collect();
            _ = writeln!(self.assets, "    <mesh name=\"{name}\" vertex=\"{}\"/>", numbers(&corners));
            let mass = small(piece.mass_kg);
            _ = writeln!(self.out, "{indent}  <geom class=\"piece\" name=\"{name}\" mesh=\"{name}\" mass=\"{mass}\"/>");
        }
        for child in (0..self.model.bodies.len()).filter(|child| self.model.bodies[*child].parent == Some(number)) {
            self.body(child, body.origin, depth + 1);
        }
        _ = writeln!(self.out, "{indent}</body>");
    }
}

fn joint(out: &mut String, body: &Rigid, indent: &str) {
    let Joint { kind, limits, friction, damping } = body.joint;
    let name = escaped(&body.name);
    let (word, axis) = match kind {
        JointKind::Fixed => return,
        JointKind::Free => {
            _ = writeln!(out, "{indent}  <freejoint name=\"{name}\"/>");
            return;
        }
        JointKind::Hinge(axis) => ("hinge", axis),
        JointKind::Slide(axis) => ("slide", axis),
    };
    let range = limits.map(|[least, greatest]| format!(" range=\"{} {}\"", number(least), number(greatest))).unwrap_or_default();
    let (friction, damping) = (small(friction), small(damping));
    _ = writeln!(
        out,
        "{indent}  <joint name=\"{name}\" type=\"{word}\" axis=\"{}\"{range} frictionloss=\"{friction}\" solreffriction=\"{CONTACT_S} 1\" damping=\"{damping}\"/>",
        vector(axis)
    );
}
