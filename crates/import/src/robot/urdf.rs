//! URDF, as <http://wiki.ros.org/urdf/XML> has it: links, and joints that place them.

use super::partnet::Semantics;
use super::shapes::{Look, Shape, Shapes};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::joints::elements::{child, children, name_of, origin, vector};
use crate::joints::states::{self, States, Tree};
use crate::joints::urdf::Joints;
use crate::vectors::numbers;
use enfilade_math::DVec3;
use roxmltree::Node;
use std::collections::HashMap;

/// Places the links of a robot, and gives them the motion of the states.
pub(super) fn place(robot: Node, shapes: &mut Shapes, a: &mut Assembly) -> Result<(), ImportError> {
    let links: Vec<Node> = children(robot, "link").collect();
    let semantics = Semantics::read(a)?;
    let mut tree = Joints::of(robot, &links, a)?;
    tree.links.iter_mut().for_each(|link| link.name = semantics.name(&link.name).to_string());
    let whole = a.push_object(if name_of(robot).is_empty() { "robot" } else { name_of(robot) }, None);
    let looks: HashMap<&str, Look> = children(robot, "material").map(|m| (name_of(m), look(m))).collect();
    shapes.label = semantics.label(whole);
    tree.push(a);
    let mut loose = Vec::new();
    for link in &links {
        let name = if name_of(*link).is_empty() { "link" } else { semantics.name(name_of(*link)) };
        let Some(stand) = tree.stands.get(name_of(*link)).map(|at| &tree.links[*at]) else {
            loose.push(name);
            continue;
        };
        let object = a.push_object(name, Some(whole));
        let before = a.contents();
        for visual in children(*link, "visual") {
            let Some(shape) = shape(visual, a)? else {
                a.warn(format!("link {name:?}"), "a visual has no geometry that is known and was left out");
                continue;
            };
            let look = child(visual, "material").map(|m| {
                let own = look(m);
                if own.rgba.is_none() && own.texture.is_none() { looks.get(name_of(m)).cloned().unwrap_or(own) } else { own }
            });
            let part = if name_of(visual).is_empty() { name.to_string() } else { format!("{name}.{}", name_of(visual)) };
            let placement = stand.file_from_link * origin(visual, a)?;
            shapes.place(&shape, look.as_ref(), &part, placement, object, a)?;
        }
        if let Some(body) = stand.body {
            a.carry(body, before);
        }
    }
    if let Some(first) = loose.first() {
        a.warn("links", format!("{} links hang on themselves and were left out, such as {first:?}", loose.len()));
    }
    if let Some(states) = States::read(None, a)? {
        states::apply(&states, &Tree { joints: &tree.joints, links: &tree.links, ordered: false }, a)?;
    }
    a.drop_unused_bodies();
    Ok(())
}

fn shape(visual: Node, a: &Assembly) -> Result<Option<Shape>, ImportError> {
    let Some(geometry) = child(visual, "geometry") else { return Ok(None) };
    let Some(kind) = geometry.children().find(Node::is_element) else { return Ok(None) };
    let number = |name: &str| vector::<1>(kind, name, a).map(|v| v.map_or(0.0, |[v]| v));
    let round = || -> Result<(f64, f64), ImportError> { Ok((number("radius")?, number("length")?)) };
    Ok(Some(match kind.tag_name().name() {
        "box" => Shape::Box(vector::<3>(kind, "size", a)?.map_or(DVec3::ONE, DVec3::from_array)),
        "cylinder" => round().map(|(radius, length)| Shape::Cylinder { radius, length })?,
        "capsule" => round().map(|(radius, length)| Shape::Capsule { radius, length })?,
        "sphere" => Shape::Sphere(number("radius")?),
        "mesh" => {
            let path = kind.attribute("filename").unwrap_or_default().to_string();
            let scale = match kind.attribute("scale").and_then(numbers).as_deref() {
                Some(&[all]) => DVec3::splat(all),
                _ => vector::<3>(kind, "scale", a)?.map_or(DVec3::ONE, DVec3::from_array),
            };
            Shape::Mesh { path, scale }
        }
        _ => return Ok(None),
    }))
}

fn look(material: Node) -> Look {
    let rgba = child(material, "color").and_then(|c| numbers(c.attribute("rgba")?));
    let rgba = rgba.and_then(|v| match v[..] {
        [r, g, b] => Some([r, g, b, 1.0]),
        [r, g, b, alpha, ..] => Some([r, g, b, alpha]),
        _ => None,
    });
    let texture = child(material, "texture").and_then(|t| t.attribute("filename")).filter(|t| !t.trim().is_empty());
    Look { name: name_of(material).to_string(), rgba, texture: texture.map(str::to_string), emission: None }
}
