//! SDF, as <http://sdformat.org/spec> has it: worlds of models, whose links are placed by their poses.

use super::sdf_frames::{frame_in, own_pose, pose_in, told_from};
use super::sdf_joints::Joints;
use super::shapes::{Look, Shape, Shapes, find};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::joints::elements::{child, children, name_of};
use crate::joints::graph::Piece;
use crate::vectors::numbers;
use enfilade_math::{DAffine3, DVec3, Rgb, linear_from_srgb};
use enfilade_scene::{Light, ObjectId, SpotFalloff};
use roxmltree::{Document, Node};
use std::collections::HashMap;

/// Models within models, and includes within includes, deeper than this are taken for a cycle.
const MAX_DEPTH: usize = 16;
/// More models than this are taken for a mistake.
const MAX_MODELS: usize = 20_000;
/// Side of a plane that states no size.
const PLANE: f64 = 1.0;

/// Places the contents of the worlds or models of a file.
pub(super) fn place(root: Node, shapes: &mut Shapes, a: &mut Assembly) -> Result<(), ImportError> {
    let worlds: Vec<Node> = children(root, "world").collect();
    if worlds.len() > 1 {
        a.warn("world", format!("{} worlds, of which the first was imported", worlds.len()));
    }
    let scope = worlds.first().copied().unwrap_or(root);
    let mut placer = Placer { shapes, models: 0, joints: Joints::default(), state: state_of(scope, a) };
    placer.content(scope, &Place { path: String::new(), file_from_here: DAffine3::IDENTITY, object: None, depth: 0 }, a)?;
    placer.joints.add(a)
}

/// The placements in the first `state` of a world, by the paths of models, links and lights: Gazebo saves there where everything stands,
/// and puts it there again when it loads the world.
fn state_of(world: Node, a: &mut Assembly) -> HashMap<String, DAffine3> {
    fn add(scope: Node, path: &str, depth: usize, found: &mut HashMap<String, DAffine3>, a: &mut Assembly) {
        for tag in ["model", "link", "light"] {
            for element in children(scope, tag) {
                let own = format!("{path}{}", name_of(element));
                if child(element, "pose").is_some() {
                    let pose = own_pose(element, a);
                    found.insert(format!("{tag} {own}"), pose);
                }
                if depth < MAX_DEPTH {
                    add(element, &format!("{own}::"), depth + 1, found, a);
                }
            }
        }
    }
    let mut found = HashMap::new();
    children(world, "state").take(1).for_each(|state| add(state, "", 0, &mut found, a));
    if !found.is_empty() {
        a.warn("state", "models, links and lights stand where the world's state has them, as in Gazebo");
    }
    found
}

struct Placer<'s> {
    shapes: &'s mut Shapes,
    models: usize,
    joints: Joints,
    /// Placements in the world that replace those of models (`model table`), links (`link table::top`) and lights.
    state: HashMap<String, DAffine3>,
}

/// A world or model.
struct Place {
    /// What goes before the names of its links: `robot::arm::`.
    path: String,
    file_from_here: DAffine3,
    object: Option<ObjectId>,
    depth: usize,
}

impl Placer<'_> {
    /// Adds the models, includes and lights of a world or model.
    fn content(&mut self, scope: Node, here: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        self.models += 1;
        if here.depth > MAX_DEPTH || self.models > MAX_MODELS {
            return Err(a.malformed(
                format!("model {:?}", name_of(scope)),
                format!("models are nested more than {MAX_DEPTH} deep, or more than {MAX_MODELS}"),
            ));
        }
        for element in scope.children().filter(Node::is_element) {
            match element.tag_name().name() {
                "model" => {
                    let name = if name_of(element).is_empty() { "model" } else { name_of(element) };
                    let file_from_here = here.file_from_here * pose_in(scope, element, a)?;
                    self.model(element, name, file_from_here, here, a)?;
                }
                "include" => self.include(element, scope, here, a)?,
                "light" => {
                    let placed = here.file_from_here * pose_in(scope, element, a)?;
                    light(element, self.stated("light", &here.path, name_of(element)).unwrap_or(placed), a);
                }
                _ => (),
            }
        }
        Ok(())
    }

    /// Adds a model, which stands within `around`.
    fn model(&mut self, model: Node, name: &str, file_from_here: DAffine3, around: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        let object = a.push_object(name, around.object);
        let file_from_here = self.stated("model", &around.path, name).unwrap_or(file_from_here);
        let path = format!("{}{name}::", around.path);
        let here = Place { path, file_from_here, object: Some(object), depth: around.depth + 1 };
        self.links(model, &here, object, a)?;
        self.content(model, &here, a)?;
        self.joints.of_model(model, &here.path, file_from_here, a)
    }

    /// Where the world's state has something.
    fn stated(&self, tag: &str, path: &str, name: &str) -> Option<DAffine3> {
        self.state.get(&format!("{tag} {path}{name}")).copied()
    }

    fn links(&mut self, model: Node, here: &Place, object: ObjectId, a: &mut Assembly) -> Result<(), ImportError> {
        for link in children(model, "link") {
            let name = if name_of(link).is_empty() { "link" } else { name_of(link) };
            let own = a.push_object(name, Some(object));
            let placed = here.file_from_here * pose_in(model, link, a)?;
            let file_from_link = self.stated("link", &here.path, name).unwrap_or(placed);
            let before = a.contents();
            for element in children(link, "light") {
                light(element, within(element, model, here, file_from_link, a)?, a);
            }
            for visual in children(link, "visual") {
                let Some(shape) = child(visual, "geometry").and_then(shape) else {
                    a.warn(format!("link {name:?}"), "a visual has no geometry that is known and was left out");
                    continue;
                };
                let look = child(visual, "material").map(|m| look(m, name_of(visual)));
                let part = format!("{}.{name}", name_of(model));
                let placement = within(visual, model, here, file_from_link, a)?;
                self.shapes.place(&shape, look.as_ref(), &part, placement, own, a)?;
            }
            let contents = vec![[before, a.contents()]];
            self.joints.link(&here.path, Piece { name: name.to_string(), file_from_link, contents });
        }
        Ok(())
    }

    /// Adds the model of another file.
    fn include(&mut self, include: Node, scope: Node, around: &Place, a: &mut Assembly) -> Result<(), ImportError> {
        let uri = child(include, "uri").and_then(|n| n.text()).unwrap_or_default().trim();
        let named = child(include, "name").and_then(|n| n.text()).map(str::trim);
        let whole = uri.trim_end_matches('/');
        let found = [whole.to_string(), format!("{whole}/model.sdf")].into_iter().find_map(|path| find(&path, &self.shapes.from, a));
        let Some(file) = found else {
            a.warn("include", format!("{uri:?} is neither beside the scene nor in the folders above; it was left out"));
            return Ok(());
        };
        let bytes = a.read_input(&file, "check the permission to read it")?;
        let text = crate::xml::xml_text(&bytes);
        let Ok(document) = Document::parse(&text) else {
            a.warn("include", format!("{} is no well-formed XML; it was left out", file.display()));
            return Ok(());
        };
        let Some(model) = child(document.root_element(), "model") else {
            a.warn("include", format!("{} holds no model; it was left out", file.display()));
            return Ok(());
        };
        // The pose of an include replaces the model's own.
        let told = if child(include, "pose").is_some() { pose_in(scope, include, a)? } else { own_pose(model, a) };
        let from = std::mem::replace(&mut self.shapes.from, file);
        let name = named.unwrap_or_else(|| name_of(model));
        let done = self.model(model, name, around.file_from_here * told, around, a);
        self.shapes.from = from;
        done
    }
}

/// The placement of something in a link.
fn within(element: Node, model: Node, here: &Place, file_from_link: DAffine3, a: &mut Assembly) -> Result<DAffine3, ImportError> {
    let frame = told_from(element).map(|frame| frame_in(model, frame, a)).transpose()?.flatten();
    let base = frame.map_or(file_from_link, |model_from_frame| here.file_from_here * model_from_frame);
    Ok(base * own_pose(element, a))
}

fn vector<const N: usize>(node: Node, tag: &str) -> Option<[f64; N]> {
    numbers(child(node, tag)?.text()?)?.get(..N)?.try_into().ok()
}

fn shape(geometry: Node) -> Option<Shape> {
    let kind = geometry.children().find(Node::is_element)?;
    let number = |tag: &str| vector::<1>(kind, tag).map(|[v]| v);
    Some(match kind.tag_name().name() {
        "box" => Shape::Box(DVec3::from_array(vector(kind, "size")?)),
        "sphere" => Shape::Sphere(number("radius")?),
        "cylinder" => Shape::Cylinder { radius: number("radius")?, length: number("length")? },
        "capsule" => Shape::Capsule { radius: number("radius")?, length: number("length")? },
        "plane" => {
            let normal = vector(kind, "normal").map_or(DVec3::Z, DVec3::from_array);
            Shape::Plane { normal, size: vector(kind, "size").unwrap_or([PLANE; 2]) }
        }
        "mesh" => {
            let path = child(kind, "uri")?.text()?.trim().to_string();
            let scale = match vector::<3>(kind, "scale") {
                Some(scale) => DVec3::from_array(scale),
                None => vector::<1>(kind, "scale").map_or(DVec3::ONE, |[all]| DVec3::splat(all)),
            };
            Shape::Mesh { path, scale }
        }
        _ => return None,
    })
}

fn look(material: Node, name: &str) -> Look {
    let color = |tag: &str| vector::<4>(material, tag).or_else(|| vector::<3>(material, tag).map(|[r, g, b]| [r, g, b, 1.0]));
    let maps = child(material, "pbr").and_then(|pbr| child(pbr, "metal").or_else(|| child(pbr, "specular")));
    let texture = maps.and_then(|maps| child(maps, "albedo_map")).and_then(|m| m.text()).map(|t| t.trim().to_string());
    let emission = color("emissive").map(|[r, g, b, _]| [r, g, b]).filter(|c| c.iter().any(|v| *v > 0.0));
    Look { name: name.to_string(), rgba: color("diffuse"), texture: texture.filter(|t| !t.is_empty()), emission }
}

fn light(element: Node, placement: DAffine3, a: &mut Assembly) {
    let color = vector::<3>(element, "diffuse").unwrap_or([1.0; 3]).map(|v| linear_from_srgb(v.clamp(0.0, 1.0) as f32));
    let strength = Rgb::from(color) * vector::<1>(element, "intensity").map_or(1.0, |[v]| v.max(0.0) as f32);
    let direction = vector(element, "direction").map_or(DVec3::NEG_Z, DVec3::from_array);
    let direction = placement.transform_vector3(direction).normalize_or_zero().as_vec3();
    let (name, position) = (name_of(element).to_string(), placement.translation.as_vec3());
    match element.attribute("type").unwrap_or("point") {
        "directional" => a.push_light(Light::Directional { name, direction, irradiance: strength, angular_radius_rad: 0.0 }),
        "spot" => {
            let angle = |tag: &str, default: f64| {
                child(element, "spot").and_then(|spot| vector::<1>(spot, tag)).map_or(default, |[v]| 0.5 * v).clamp(0.01, 1.57) as f32
            };
            let outer_rad = angle("outer_angle", 0.5);
            let inner_rad = angle("inner_angle", 0.0).min(outer_rad);
            let falloff = SpotFalloff::CosineSquare;
            a.push_light_at(
                placement.translation,
                Light::Spot { name, position, direction, intensity: strength, inner_rad, outer_rad, falloff },
            );
        }
        _ => a.push_light_at(placement.translation, Light::Point { name, position, intensity: strength }),
    }
    a.warn("light", "SDF states no unit of light; strengths were taken as W/sr and W/m²");
}
