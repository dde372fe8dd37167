//! USD with physics (`UsdPhysics`), as text: <https://openusd.org/release/api/usd_physics_page_front.html>.
//!
//! Bodies are `Xform`s with `PhysicsRigidBodyAPI` and `PhysicsMassAPI` (mass, centre, principal moments and their axes); what is fixed to the world
//! has neither. Convex pieces are meshes of purpose `guide` with the approximation `convexHull`. Joints are `PhysicsRevoluteJoint`,
//! `PhysicsPrismaticJoint` and, for what is fixed to a free body, `PhysicsFixedJoint`. Pairs without contact are filtered.

use crate::files::{number, small};
use crate::looks::{Look, Surface};
use crate::model::{JointKind, Model, Piece, Rigid};
use enfilade_compose::{FRICTION, Moments};
use enfilade_math::{DMat3, DQuat, DVec3};
use enfilade_scene::SceneFiles;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Root of the file's tree.
const ROOT: &str = "/scene";

/// A model as USD; `folder` is the name of the folder, beside the file, of its pictures.
pub fn usd(model: &Model, name: &str, folder: &str) -> SceneFiles {
    let names = Names::of(model);
    let mut text = format!(
        "#usda 1.0\n(\n    defaultPrim = \"scene\"\n    doc = {}\n    kilogramsPerUnit = 1\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\n",
        quoted(name)
    );
    text.push_str("def Xform \"scene\"\n{\n");
    text.push_str("    def PhysicsScene \"physics\"\n    {\n        vector3f physics:gravityDirection = (0, 0, -1)\n        float physics:gravityMagnitude = 9.81\n    }\n");
    _ = write!(
        text,
        "    def Material \"friction\" (prepend apiSchemas = [\"PhysicsMaterialAPI\"])\n    {{\n        float physics:staticFriction = {FRICTION}\n        float physics:dynamicFriction = {FRICTION}\n        float physics:restitution = 0\n    }}\n"
    );
    text.push_str("    def Scope \"looks\"\n    {\n");
    model.looks.materials.iter().for_each(|look| material(&mut text, model, look, folder));
    text.push_str("    }\n");
    for (number, body) in model.bodies.iter().enumerate() {
        rigid(&mut text, model, &names, number, body);
    }
    for (number, body) in model.bodies.iter().enumerate() {
        joint(&mut text, model, &names, number, body);
    }
    text.push_str("}\n");
    let beside: BTreeMap<String, Vec<u8>> =
        model.looks.pictures.iter().map(|(file, bytes)| (format!("{folder}/{file}"), bytes.clone())).collect();
    SceneFiles { main: text.into_bytes(), beside, notes: model.notes.clone() }
}

/// Names of bodies as USD has them: letters, digits and `_`.
struct Names(Vec<String>);

impl Names {
    fn of(model: &Model) -> Self {
        let plain = |(number, body): (usize, &Rigid)| {
            let name: String = body.name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
            // Two names may have become one, and a digit cannot come first.
            format!("b{number}_{name}")
        };
        Self(model.bodies.iter().enumerate().map(plain).collect())
    }

    fn path(&self, number: usize) -> String {
        format!("{ROOT}/{}", self.0[number])
    }
}

fn material(text: &mut String, model: &Model, look: &Look, folder: &str) {
    let [r, g, b, opacity] = look.rgba;
    let path = format!("{ROOT}/looks/{}", look.name);
    _ = write!(
        text,
        "        def Material \"{}\"\n        {{\n            token outputs:surface.connect = <{path}/surface.outputs:surface>\n",
        look.name
    );
    text.push_str("            def Shader \"surface\"\n            {\n                uniform token info:id = \"UsdPreviewSurface\"\n");
    let color = [r, g, b].map(|v| number(linear(v))).join(", ");
    match look.picture {
        Some(_) => _ = writeln!(text, "                color3f inputs:diffuseColor.connect = <{path}/picture.outputs:rgb>"),
        None => _ = writeln!(text, "                color3f inputs:diffuseColor = ({color})"),
    }
    _ = write!(
        text,
        "                float inputs:opacity = {}\n                float inputs:roughness = 0.6\n                token outputs:surface\n            }}\n",
        number(opacity)
    );
    if let Some(picture) = look.picture {
        let file = &model.looks.pictures[picture].0;
        _ = write!(
            text,
            "            def Shader \"coordinates\"\n            {{\n                uniform token info:id = \"UsdPrimvarReader_float2\"\n                string inputs:varname = \"st\"\n                float2 outputs:result\n            }}\n            def Shader \"picture\"\n            {{\n                uniform token info:id = \"UsdUVTexture\"\n                asset inputs:file = @{folder}/{file}@\n                token inputs:sourceColorSpace = \"sRGB\"\n                token inputs:wrapS = \"repeat\"\n                token inputs:wrapT = \"repeat\"\n                float4 inputs:scale = ({color}, 1)\n                float2 inputs:st.connect = <{path}/coordinates.outputs:result>\n                float3 outputs:rgb\n            }}\n"
        );
    }
    text.push_str("        }\n");
}

fn linear(encoded: f64) -> f64 {
    f64::from(enfilade_math::linear_from_srgb(encoded as f32))
}

fn rigid(text: &mut String, model: &Model, names: &Names, number: usize, body: &Rigid) {
    // What is fixed to the world moves no more than it.
    let moves = body.joint.kind != JointKind::Fixed || body.parent.is_some_and(|parent| is_moving(model, parent));
    let filtered: Vec<String> = model.excluded.iter().filter(|[a, _]| *a == number).map(|[_, b]| format!("<{}>", names.path(*b))).collect();
    let mut schemas = if moves { vec!["\"PhysicsRigidBodyAPI\"", "\"PhysicsMassAPI\""] } else { Vec::new() };
    if !filtered.is_empty() {
        schemas.push("\"PhysicsFilteredPairsAPI\"");
    }
    let applied = if schemas.is_empty() { String::new() } else { format!(" (prepend apiSchemas = [{}])", schemas.join(", ")) };
    _ = write!(text, "    def Xform \"{}\"{applied}\n    {{\n", names.0[number]);
    _ = writeln!(
        text,
        "        double3 xformOp:translate = {}\n        uniform token[] xformOpOrder = [\"xformOp:translate\"]",
        tuple(body.origin)
    );
    if let Some(moments) = body.moments().filter(|_| moves) {
        mass(text, &moments);
    }
    if !filtered.is_empty() {
        _ = writeln!(text, "        rel physics:filteredPairs = [{}]", filtered.join(", "));
    }
    for (visual, count) in body.visuals.iter().zip(1..) {
        surface(text, &model.looks.meshes[visual.mesh], count, visual.place, &model.looks.materials[visual.material].name);
    }
    body.pieces.iter().zip(1..).for_each(|(piece, count)| collision(text, piece, count));
    text.push_str("    }\n");
}

fn is_moving(model: &Model, mut number: usize) -> bool {
    while model.bodies[number].joint.kind == JointKind::Fixed {
        let Some(parent) = model.bodies[number].parent else { return false };
        number = parent;
    }
    true
}

fn mass(text: &mut String, moments: &Moments) {
    let (diagonal, axes) = principal(moments.inertia);
    _ = writeln!(text, "        float physics:mass = {}", small(moments.mass_kg));
    _ = writeln!(text, "        point3f physics:centerOfMass = {}", tuple(moments.center));
    _ = writeln!(text, "        float3 physics:diagonalInertia = ({})", diagonal.to_array().map(small).join(", "));
    let q = axes.normalize();
    _ = writeln!(text, "        quatf physics:principalAxes = ({})", [q.w, q.x, q.y, q.z].map(number).join(", "));
}

/// Principal moments of a symmetric matrix, and the rotation whose columns are their axes (Jacobi's method).
fn principal(inertia: DMat3) -> (DVec3, DQuat) {
    let (mut m, mut axes) = (inertia, DMat3::IDENTITY);
    for _ in 0..16 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(p)[q];
            if off.abs() <= 1e-15 * (m.col(p)[p].abs() + m.col(q)[q].abs()) {
                continue;
            }
            let angle = 0.5 * (2.0 * off).atan2(m.col(q)[q] - m.col(p)[p]);
            let (sin, cos) = angle.sin_cos();
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = cos;
            turn.col_mut(p)[q] = -sin;
            turn.col_mut(q)[p] = sin;
            turn.col_mut(q)[q] = cos;
            m = turn.transpose() * m * turn;
            axes *= turn;
        }
    }
    (DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), DQuat::from_mat3(&axes))
}

fn surface(text: &mut String, surface: &Surface, count: usize, place: DVec3, material: &str) {
    _ = write!(text, "        def Mesh \"seen_{count}\" (prepend apiSchemas = [\"MaterialBindingAPI\"])\n        {{\n");
    _ = writeln!(
        text,
        "            double3 xformOp:translate = {}\n            uniform token[] xformOpOrder = [\"xformOp:translate\"]",
        tuple(place)
    );
    mesh(text, &surface.points, &surface.triangles);
    if !surface.coordinates.is_empty() {
        let st: Vec<String> = surface.coordinates.iter().map(|uv| format!("({})", uv.map(number).join(", "))).collect();
        _ = writeln!(text, "            texCoord2f[] primvars:st = [{}] (interpolation = \"vertex\")", st.join(", "));
    }
    _ = write!(text, "            rel material:binding = <{ROOT}/looks/{material}>\n        }}\n");
}

fn collision(text: &mut String, piece: &Piece, count: usize) {
    _ = write!(
        text,
        "        def Mesh \"piece_{count}\" (prepend apiSchemas = [\"PhysicsCollisionAPI\", \"PhysicsMeshCollisionAPI\", \"MaterialBindingAPI\"])\n        {{\n            uniform token purpose = \"guide\"\n            uniform token physics:approximation = \"convexHull\"\n            rel material:binding:physics = <{ROOT}/friction>\n"
    );
    mesh(text, &piece.solid.corners, &piece.solid.triangles);
    text.push_str("        }\n");
}

fn mesh(text: &mut String, points: &[DVec3], triangles: &[[u32; 3]]) {
    let (low, high) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    _ = writeln!(
        text,
        "            uniform token subdivisionScheme = \"none\"\n            float3[] extent = [{}, {}]",
        tuple(low),
        tuple(high)
    );
    _ = writeln!(text, "            int[] faceVertexCounts = [{}]", vec!["3"; triangles.len()].join(", "));
    let corners: Vec<String> = triangles.iter().flatten().map(ToString::to_string).collect();
    _ = writeln!(text, "            int[] faceVertexIndices = [{}]", corners.join(", "));
    let points: Vec<String> = points.iter().map(|p| tuple(*p)).collect();
    _ = writeln!(text, "            point3f[] points = [{}]", points.join(", "));
}

fn joint(text: &mut String, model: &Model, names: &Names, index: usize, body: &Rigid) {
    let (kind, axis) = match body.joint.kind {
        JointKind::Free => return,
        JointKind::Fixed if !body.parent.is_some_and(|parent| is_moving(model, parent)) => return,
        JointKind::Fixed => ("PhysicsFixedJoint", DVec3::X),
        JointKind::Hinge(axis) => ("PhysicsRevoluteJoint", axis),
        JointKind::Slide(axis) => ("PhysicsPrismaticJoint", axis),
    };
    let from = body.parent.map_or(DVec3::ZERO, |parent| model.bodies[parent].origin);
    let own = DQuat::from_rotation_arc(DVec3::X, axis);
    let turn = format!("({})", [own.w, own.x, own.y, own.z].map(number).join(", "));
    _ = write!(text, "    def {kind} \"{}_joint\"\n    {{\n", names.0[index]);
    if let Some(parent) = body.parent {
        _ = writeln!(text, "        rel physics:body0 = <{}>", names.path(parent));
    }
    _ = writeln!(text, "        rel physics:body1 = <{}>", names.path(index));
    _ = writeln!(text, "        point3f physics:localPos0 = {}\n        point3f physics:localPos1 = (0, 0, 0)", tuple(body.origin - from));
    _ = writeln!(text, "        quatf physics:localRot0 = {turn}\n        quatf physics:localRot1 = {turn}");
    if kind != "PhysicsFixedJoint" {
        _ = writeln!(text, "        uniform token physics:axis = \"X\"");
    }
    if let Some(limits) = body.joint.limits {
        let [low, high] = limits.map(|limit| if matches!(body.joint.kind, JointKind::Hinge(_)) { limit.to_degrees() } else { limit });
        _ = writeln!(text, "        float physics:lowerLimit = {}\n        float physics:upperLimit = {}", number(low), number(high));
    }
    text.push_str("    }\n");
}

fn tuple(v: DVec3) -> String {
    format!("({})", v.to_array().map(number).join(", "))
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_moments_make_the_matrix_again() {
        let turn = DMat3::from_quat(DQuat::from_rotation_x(0.3) * DQuat::from_rotation_y(-0.8));
        let inertia = turn * DMat3::from_diagonal(DVec3::new(1.0, 2.0, 5.0)) * turn.transpose();
        let (diagonal, axes) = principal(inertia);
        let axes = DMat3::from_quat(axes);
        let again = axes * DMat3::from_diagonal(diagonal) * axes.transpose();
        let worst = (again - inertia).to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst}");
    }
}
