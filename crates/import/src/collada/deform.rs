//! Skins, morphs and changing scales: how joints, weights and nodes move the vertices of a geometry, at rest and over time.
//!
//! A vertex of a skin is at Σ weight · joint · inverse bind matrix · bind shape · vertex (COLLADA 1.4.1, "Skinning a skeleton"), whatever the
//! place of its node. A morph is its base and the weighted differences of its targets from that.

use super::animation::{Animations, Channel, array_of};
use super::document::{Dae, Node, called, child, children, exactly, numbers, text};
use super::geometry::{Made, positions};
use super::transform::{Transforms, affine};
use crate::ImportError;
use crate::assembly::{Assembly, TimedShapes};
use crate::mesh::add_smooth_normals;
use crate::motion::{Shapes, Side, length_in, shapes};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Vec3};
use enfilade_scene::Shape;
use std::collections::HashMap;

/// A moment in seconds, and from which side; `None` for what the scene states at rest.
type Moment = Option<(f64, Side)>;

/// How the vertices of a geometry move.
pub(super) struct Deform<'p> {
    morph: Option<Morph<'p>>,
    skin: Option<Skin<'p>>,
}

struct Morph<'p> {
    is_relative: bool,
    /// Vertices of each target.
    targets: Vec<Vec<DVec3>>,
    weights: Vec<f64>,
    channels: &'p [Channel],
}

struct Skin<'p> {
    /// From the geometry's space to that in which it was bound.
    bind_shape: DAffine3,
    /// The nodes of the joints and what they are in, with the numbers of their parents, which come first.
    nodes: Vec<(Option<usize>, Transforms<'p>)>,
    /// The node of each joint, and its inverse bind matrix.
    joints: Vec<(usize, DAffine3)>,
    /// The joints that hold each vertex; `None` where the first one holds all.
    held: Option<Held>,
}

/// The joints that hold each vertex, with their weights; `None` for the bind shape itself.
type Held = Vec<Vec<(Option<usize>, f64)>>;

/// The geometry at the end of a controller, which may move what another one has changed.
pub(super) fn source<'d>(dae: &Dae<'d>, controller: Node<'d>) -> Option<Node<'d>> {
    let inner = skin_of(controller).or_else(|| child(controller, "morph")).and_then(|n| dae.target(n.attribute("source")?))?;
    let geometry = match child(inner, "morph") {
        Some(morph) => dae.target(morph.attribute("source")?)?,
        None => inner,
    };
    (geometry.tag_name().name() == "geometry").then_some(geometry)
}

pub(super) fn skin_of<'d>(controller: Node<'d>) -> Option<Node<'d>> {
    child(controller, "skin")
}

/// The placement that a skin was bound in.
pub(super) fn bind_shape(skin: Node) -> DAffine3 {
    child(skin, "bind_shape_matrix").and_then(exactly::<16>).map_or(DAffine3::IDENTITY, |m| affine(&m))
}

impl<'p> Deform<'p> {
    /// What a controller does where `instance` is, or why that cannot be known.
    ///
    /// # Errors
    /// When a node has a transform that is none.
    pub(super) fn read<'d: 'p>(
        dae: &Dae<'d>,
        controller: Node<'d>,
        instance: Node<'d>,
        animations: &'p Animations,
        a: &mut Assembly,
    ) -> Result<Result<Self, String>, ImportError> {
        let skin = skin_of(controller);
        let inner = skin.and_then(|skin| dae.target(skin.attribute("source")?)).and_then(|inner| child(inner, "morph"));
        let morph = match inner.or_else(|| child(controller, "morph")).map(|morph| Morph::read(dae, morph, animations, a)).transpose() {
            Ok(morph) => morph,
            Err(problem) => return Ok(Err(problem)),
        };
        let skin = match skin {
            Some(skin) => match Skin::read(dae, skin, instance, animations, a)? {
                Ok(skin) => Some(skin),
                Err(problem) => return Ok(Err(problem)),
            },
            None => None,
        };
        Ok(Ok(Self { morph, skin }))
    }

    /// A geometry in nodes of which one changes its scale or shear.
    ///
    /// # Errors
    /// When a node has a transform that is none.
    pub(super) fn of_nodes<'d: 'p>(nodes: &[Node<'d>], animations: &'p Animations, a: &Assembly) -> Result<Self, ImportError> {
        Ok(Self { morph: None, skin: Some(Skin::of_nodes(nodes, animations, a)?) })
    }

    /// A controller in nodes of which one changes its scale or shear; joints place a skin by themselves.
    ///
    /// # Errors
    /// When a node has a transform that is none.
    pub(super) fn within<'d: 'p>(self, nodes: &[Node<'d>], animations: &'p Animations, a: &Assembly) -> Result<Self, ImportError> {
        let skin = match self.skin {
            Some(skin) => skin,
            None => Skin::of_nodes(nodes, animations, a)?,
        };
        Ok(Self { skin: Some(skin), ..self })
    }

    /// Whether the joints turn the surface inside out.
    pub(super) fn mirrors(&self) -> bool {
        self.skin.as_ref().is_some_and(|skin| skin.maps(None).first().is_some_and(|map| map.matrix3.determinant() < 0.0))
    }

    /// The shape of a mesh at a moment: of a skin in the file's space, else in its own.
    pub(super) fn shape(&self, made: &Made, at: Moment) -> Shape {
        let points = self.morph.as_ref().map_or_else(|| made.all.clone(), |morph| morph.points(&made.all, at));
        let maps = self.skin.as_ref().map(|skin| skin.by_vertex(points.len(), at));
        let placed = |point: u32| {
            let stored = points[point as usize];
            maps.as_ref().map_or(stored, |maps| maps[point as usize].0.transform_point3(stored))
        };
        let positions: Vec<Vec3> = made.points.iter().map(|&point| (placed(point) - made.origin).as_vec3()).collect();
        if made.mesh.normals.is_empty() {
            return Shape { positions, normals: Vec::new() };
        }
        if self.morph.is_some() {
            // Corners with normals of their own are vertices of their own, so edges stay.
            let mut bent = Mesh { positions, triangles: self.triangles(&made.mesh), ..Mesh::default() };
            add_smooth_normals(&mut bent);
            return Shape { positions: bent.positions, normals: bent.normals };
        }
        let turned = |(&point, &normal): (&u32, &Vec3)| {
            let turned = maps.as_ref().map_or(normal.as_dvec3(), |maps| maps[point as usize].1 * normal.as_dvec3());
            turned.try_normalize().map_or(normal, |turned| turned.as_vec3())
        };
        let normals = made.points.iter().zip(&made.mesh.normals).map(turned).collect();
        Shape { positions, normals }
    }

    /// The triangles of a mesh, with their fronts where the surface has its own.
    pub(super) fn triangles(&self, mesh: &Mesh) -> Vec<[u32; 3]> {
        let mirrors = self.mirrors();
        mesh.triangles.iter().map(|&[a, b, c]| if mirrors { [a, c, b] } else { [a, b, c] }).collect()
    }

    /// Whether joints place it, in the file's space, so that its node does not.
    pub(super) fn has_joints(&self) -> bool {
        self.skin.is_some()
    }

    /// The shapes of a mesh over time; `None` where it keeps its shape and, with a warning, where it cannot be followed.
    pub(super) fn timed(&self, made: &Made, (file_from_mesh, place): (&DAffine3, &str), a: &mut Assembly) -> Option<TimedShapes> {
        let nodes = self.skin.iter().flat_map(|skin| &skin.nodes).flat_map(|(_, transforms)| transforms.moments());
        let weights = self.morph.iter().flat_map(|morph| morph.channels).flat_map(|channel| channel.curve.moments(None));
        let moments: Vec<f64> = nodes.chain(weights).collect();
        if moments.is_empty() {
            return None;
        }
        let length = length_in(file_from_mesh, a.meters_per_unit());
        match shapes(moments, true, length, |time_s, side| Ok::<_, ()>(self.shape(made, Some((time_s, side))))) {
            Ok(Shapes::Timed(shapes)) => Some(shapes),
            Ok(Shapes::Refused(problem)) => {
                a.warn(place, format!("its shape changes, but {problem}; it keeps that of rest"));
                None
            }
            _ => None,
        }
    }
}

impl<'p> Morph<'p> {
    fn read<'d: 'p>(dae: &Dae<'d>, morph: Node<'d>, animations: &'p Animations, a: &mut Assembly) -> Result<Self, String> {
        let inputs = child(morph, "targets").ok_or("the morph has no targets")?;
        let source = |semantic: &str| input(dae, inputs, semantic).ok_or_else(|| format!("the morph has no source of {semantic}"));
        let ids = array_of(dae, source("MORPH_TARGET")?, "IDREF_array").map(text).unwrap_or_default();
        let weights_source = source("MORPH_WEIGHT")?;
        let (weights, _) = array_of(dae, weights_source, "float_array").map(numbers).unwrap_or_default();
        let base = dae.target(morph.attribute("source").unwrap_or_default()).map(|base| positions(dae, base, a).len()).unwrap_or_default();
        let mut targets = Vec::new();
        for id in ids.split_ascii_whitespace() {
            let target = dae.by_id(id).filter(|n| n.tag_name().name() == "geometry");
            let points = positions(dae, target.ok_or_else(|| format!("the target {id:?} of the morph is not in the file"))?, a);
            if points.len() != base {
                return Err(format!("the target {id:?} of the morph has {} vertices, its base {base}", points.len()));
            }
            targets.push(points);
        }
        if weights.len() != targets.len() {
            return Err(format!("the morph has {} weights for {} targets", weights.len(), targets.len()));
        }
        Ok(Self { is_relative: morph.attribute("method") == Some("RELATIVE"), targets, weights, channels: animations.of(weights_source) })
    }

    fn points(&self, base: &[DVec3], at: Moment) -> Vec<DVec3> {
        let mut weights = self.weights.clone();
        if let Some((time_s, side)) = at {
            for channel in self.channels {
                let first = channel.first.unwrap_or(0);
                weights.iter_mut().skip(first).zip(channel.curve.at(time_s, side)).for_each(|(weight, now)| *weight = now);
            }
        }
        let mut points = base.to_vec();
        for (target, weight) in self.targets.iter().zip(weights).filter(|(_, weight)| *weight != 0.0) {
            for ((point, stored), there) in points.iter_mut().zip(base).zip(target) {
                *point += weight * if self.is_relative { *there } else { *there - *stored };
            }
        }
        points
    }
}

impl<'p> Skin<'p> {
    fn read<'d: 'p>(
        dae: &Dae<'d>,
        skin: Node<'d>,
        instance: Node<'d>,
        animations: &'p Animations,
        a: &Assembly,
    ) -> Result<Result<Self, String>, ImportError> {
        let (names, inverse_binds, held) = match parts(dae, skin) {
            Ok(parts) => parts,
            Err(problem) => return Ok(Err(problem)),
        };
        let by_name = joint_nodes(dae, instance);
        let mut known: HashMap<roxmltree::NodeId, usize> = HashMap::new();
        let mut found = Self { bind_shape: bind_shape(skin), nodes: Vec::new(), joints: Vec::new(), held: Some(held) };
        for (name, inverse_bind) in names.into_iter().zip(inverse_binds) {
            let joint = by_name.get(name.as_str()).copied().or_else(|| dae.by_id(&name));
            let mut chain: Vec<Node> = joint.iter().flat_map(Node::ancestors).filter(|n| n.tag_name().name() == "node").collect();
            chain.reverse();
            let mut parent = None;
            for node in chain {
                let number = match known.get(&node.id()) {
                    Some(number) => *number,
                    None => {
                        found.nodes.push((parent, Transforms::of(node, animations, a)?));
                        known.insert(node.id(), found.nodes.len() - 1);
                        found.nodes.len() - 1
                    }
                };
                parent = Some(number);
            }
            let Some(node) = parent else { return Ok(Err(format!("its joint {name:?} is no node of the scene"))) };
            found.joints.push((node, inverse_bind));
        }
        Ok(Ok(found))
    }

    /// The last of nodes within each other, which holds all.
    fn of_nodes<'d: 'p>(nodes: &[Node<'d>], animations: &'p Animations, a: &Assembly) -> Result<Self, ImportError> {
        let transforms = nodes.iter().map(|node| Transforms::of(*node, animations, a)).collect::<Result<Vec<_>, _>>()?;
        let joints = vec![(transforms.len().saturating_sub(1), DAffine3::IDENTITY)];
        let nodes = transforms.into_iter().enumerate().map(|(i, transforms)| (i.checked_sub(1), transforms)).collect();
        Ok(Self { bind_shape: DAffine3::IDENTITY, nodes, joints, held: None })
    }

    /// From the geometry's space to the file's by each joint.
    fn maps(&self, at: Moment) -> Vec<DAffine3> {
        let mut placements: Vec<DAffine3> = Vec::with_capacity(self.nodes.len());
        for (parent, transforms) in &self.nodes {
            let own = at.map_or_else(|| transforms.rest(), |(time_s, side)| transforms.at(time_s, side));
            placements.push(parent.map_or(own, |parent| placements[parent] * own));
        }
        self.joints.iter().map(|(node, inverse_bind)| placements[*node] * *inverse_bind * self.bind_shape).collect()
    }

    /// What places each vertex, and what turns its normal.
    fn by_vertex(&self, vertices: usize, at: Moment) -> Vec<(DAffine3, DMat3)> {
        let maps = self.maps(at);
        let blended = |held: &[(Option<usize>, f64)]| {
            let sum: f64 = held.iter().map(|(_, weight)| weight).sum();
            if !sum.is_finite() || sum.abs() < 1e-9 {
                return self.bind_shape;
            }
            let mut all = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
            for (joint, weight) in held {
                let map = joint.map_or(&self.bind_shape, |joint| &maps[joint]);
                all.matrix3 += map.matrix3 * (weight / sum);
                all.translation += map.translation * (weight / sum);
            }
            all
        };
        let with_normals = |map: DAffine3| {
            let inverse = map.matrix3.inverse();
            (map, if inverse.is_finite() { inverse.transpose() } else { map.matrix3 })
        };
        match &self.held {
            None => vec![with_normals(maps[0]); vertices],
            Some(held) => (0..vertices).map(|vertex| with_normals(blended(held.get(vertex).map_or(&[][..], Vec::as_slice)))).collect(),
        }
    }
}

/// Names of joints, their inverse bind matrices, and the joints that hold each vertex.
type Parts = (Vec<String>, Vec<DAffine3>, Held);

fn parts(dae: &Dae, skin: Node) -> Result<Parts, String> {
    let joints = child(skin, "joints").ok_or("it has no joints")?;
    let source = input(dae, joints, "JOINT").ok_or("it has no source of JOINT")?;
    let names = ["Name_array", "IDREF_array"].into_iter().find_map(|tag| array_of(dae, source, tag)).map(text).unwrap_or_default();
    let names: Vec<String> = names.split_ascii_whitespace().map(str::to_string).collect();
    let matrices = input(dae, joints, "INV_BIND_MATRIX").and_then(|source| array_of(dae, source, "float_array"));
    let (matrices, odd) = matrices.map(numbers).unwrap_or_default();
    if names.is_empty() || odd > 0 || matrices.len() != 16 * names.len() {
        return Err(format!("it has {} joints, but {} finite numbers of their inverse bind matrices", names.len(), matrices.len() - odd));
    }
    let inverse_binds = matrices.as_chunks::<16>().0.iter().map(affine).collect();
    let held = held(dae, skin, names.len())?;
    Ok((names, inverse_binds, held))
}

/// The joints that hold each vertex.
fn held(dae: &Dae, skin: Node, joints: usize) -> Result<Held, String> {
    let weights = child(skin, "vertex_weights").ok_or("it has no weights")?;
    let place = |semantic: &str| {
        let input = children(weights, "input").find(|input| input.attribute("semantic") == Some(semantic));
        let offset = input.map(|input| input.attribute("offset").and_then(|o| o.trim().parse::<usize>().ok()).unwrap_or(0));
        offset.filter(|offset| *offset < 16).ok_or_else(|| format!("its weights have no input of {semantic}"))
    };
    let (joint_at, weight_at) = (place("JOINT")?, place("WEIGHT")?);
    let stride = children(weights, "input").filter_map(|i| i.attribute("offset")?.trim().parse::<usize>().ok()).max().unwrap_or(0) + 1;
    let (values, _) =
        input(dae, weights, "WEIGHT").and_then(|source| array_of(dae, source, "float_array")).map(numbers).unwrap_or_default();
    let whole = |tag: &str| -> Result<Vec<i64>, String> {
        let all = child(weights, tag).map(text).unwrap_or_default();
        let numbers: Option<Vec<i64>> = all.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
        numbers.ok_or_else(|| format!("the {tag} of its weights are no whole numbers"))
    };
    let (counts, indices) = (whole("vcount")?, whole("v")?);
    let mut all = indices.chunks_exact(stride);
    let mut found = Vec::with_capacity(counts.len());
    for count in counts {
        let mut held = Vec::new();
        for _ in 0..count.max(0) {
            let pair = all.next().ok_or("its weights tell of more joints than there are")?;
            let joint = match pair[joint_at] {
                -1 => None,
                joint => Some(
                    usize::try_from(joint)
                        .ok()
                        .filter(|joint| *joint < joints)
                        .ok_or_else(|| format!("it names joint {joint} of {joints}"))?,
                ),
            };
            let weight = usize::try_from(pair[weight_at]).ok().and_then(|at| values.get(at));
            held.push((joint, *weight.ok_or_else(|| format!("it names weight {} of {}", pair[weight_at], values.len()))?));
        }
        found.push(held);
    }
    Ok(found)
}

/// Nodes by the names of joints: first those of the skeletons that the instance names, then all others.
fn joint_nodes<'d>(dae: &Dae<'d>, instance: Node<'d>) -> HashMap<&'d str, Node<'d>> {
    let skeletons = children(instance, "skeleton").filter_map(|skeleton| dae.target(&text(skeleton)));
    let mut found = HashMap::new();
    for root in skeletons.chain([dae.root]) {
        for node in root.descendants().filter(|n| n.tag_name().name() == "node") {
            if let Some(sid) = node.attribute("sid") {
                found.entry(sid).or_insert(node);
            }
        }
    }
    found
}

/// The source of an input.
fn input<'d>(dae: &Dae<'d>, node: Node<'d>, semantic: &str) -> Option<Node<'d>> {
    let input = children(node, "input").find(|input| input.attribute("semantic") == Some(semantic))?;
    dae.target(input.attribute("source")?)
}

/// The words of a warning that a controller moves nothing.
pub(super) fn stays(controller: Node, problem: &str, a: &mut Assembly) {
    a.warn(called(controller), format!("{problem}; it stays as it was bound, and a morph as its base"));
}
