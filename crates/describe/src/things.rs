//! The things of a scene, as its files have them.

use crate::body::Body;
use crate::words;
use enfilade_dataset::{Dataset, DatasetError, DescribedInstance, MeshGeometry};
use enfilade_label::boxes::upright_box;
use enfilade_label::class_name;
use enfilade_math::{DVec2, DVec3, Vec3};
use enfilade_scene::{Labels, PartLabel, RoomThing, Rooms};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Greatest distance of a thing in a wall's opening from the room that it belongs to, metres.
const IN_WALL_M: f64 = 0.5;

/// The bodies of a scene and what its instances are.
pub struct Things {
    /// Bodies of every instance, in ascending order, then of all else, by class: walls, floors, ceilings, what has no label.
    pub bodies: Vec<Body>,
    /// What the instances are, in the same order; their colours are not known yet.
    pub described: Vec<DescribedInstance>,
    /// Rooms, where they are known.
    pub rooms: Option<Rooms>,
}

/// Area by number of object or material, m².
type Areas = BTreeMap<u32, f64>;

/// Data gathered from the triangles of an instance.
#[derive(Default)]
struct Gathered {
    semantic: i16,
    corners: Vec<[Vec3; 3]>,
    points: Vec<DVec3>,
    objects: Areas,
    materials: Areas,
}

impl Things {
    /// Reads a scene's mesh, labels and rooms; `None` where nothing is labelled.
    ///
    /// # Errors
    /// When a file is missing or damaged.
    pub fn read(dataset: &Dataset, scene: &str) -> Result<Option<Self>, DatasetError> {
        let files = dataset.mesh_files(scene);
        let labels = match files.read_labels() {
            Err(error) if error.is_not_found() => return Ok(None),
            labels => labels?,
        };
        let own = files.read_classes()?.filter(|classes| !classes.are_nyu40());
        let (mut mesh, objects, metres) = (files.read()?, files.read_objects_of_faces()?, dataset.meters_per_asset_unit(scene)?);
        mesh.vertices.iter_mut().for_each(|v| *v *= metres);
        let rooms = dataset.read_rooms(scene)?;
        let [instances, stuff] = gathered(&mesh, &objects, &labels);
        if instances.is_empty() {
            return Ok(None);
        }
        let bodies = |list: BTreeMap<i16, Gathered>, instance: fn(i16) -> i16| {
            let body = |(key, gathered): (i16, Gathered)| {
                let upright = upright_box(&gathered.points)?;
                let facts = (key, gathered.objects, gathered.materials);
                let mut body = Body::new((instance(key), gathered.semantic), upright, gathered.corners);
                if own.is_some() {
                    body.class = -1;
                }
                Some((body, facts))
            };
            list.into_par_iter().filter_map(body).collect::<Vec<_>>()
        };
        let (things, shell) = (bodies(instances, |key| key), bodies(stuff, |_| -1));
        // By name: people may have given the instances other numbers since.
        let named: BTreeMap<&str, &RoomThing> =
            rooms.iter().flat_map(|rooms| &rooms.things).map(|thing| (thing.name.as_str(), thing)).collect();
        let describe = |(body, (key, objects, materials)): &(Body, (i16, Areas, Areas))| {
            let largest = |areas: &Areas| areas.iter().max_by(|a, b| a.1.total_cmp(b.1)).map(|(index, _)| *index as usize);
            let text = |names: &[String], index: Option<usize>| index.and_then(|i| names.get(i)).cloned().unwrap_or_default();
            let part = text(&mesh.objects, largest(objects));
            let named = named.get(part.split('/').next().unwrap_or_default()).copied();
            let class = own.as_ref().map_or_else(|| class_name(body.semantic).to_string(), |own| own.name(body.semantic));
            let room = rooms.as_ref().and_then(|all| all.room_near(body.center(), IN_WALL_M).map(|room| all.outlines[room].name.clone()));
            DescribedInstance {
                instance: *key,
                semantic: body.semantic,
                noun: match (named, &own) {
                    (Some(thing), _) => words::of_family(&thing.family),
                    (None, Some(own)) => words::of_own_class(own, body.semantic),
                    (None, None) => words::of_class(body.semantic),
                },
                semantic_name: class,
                name: named.map_or(part, |thing| thing.name.clone()),
                room: room.unwrap_or_default(),
                color: String::new(),
                material: text(&mesh.materials, largest(materials)),
                center: body.center(),
                size_m: body.upright.extents,
                front: named.and_then(|thing| thing.front).map(DVec2::from),
            }
        };
        let described = things.iter().map(describe).collect();
        let bodies = things.into_iter().chain(shell).map(|(body, _)| body).collect();
        Ok(Some(Self { bodies, described, rooms }))
    }

    /// Whether the labels are of NYU40's classes.
    pub fn has_nyu40(&self) -> bool {
        self.bodies.iter().all(|body| body.class == body.semantic)
    }

    /// The place of an instance in both lists.
    pub fn place(&self, instance: i16) -> Option<usize> {
        self.described.binary_search_by_key(&instance, |described| described.instance).ok()
    }
}

/// The triangles of each instance, and of all else by class: what is no instance carries others all the same.
fn gathered(mesh: &MeshGeometry, objects: &[u32], labels: &Labels) -> [BTreeMap<i16, Gathered>; 2] {
    let mut lists = [BTreeMap::new(), BTreeMap::new()];
    for (face, &object) in objects.iter().enumerate() {
        let label = labels.parts.get(object as usize).copied().unwrap_or(PartLabel::NONE);
        let (list, key) = if label.instance >= 1 { (0, label.instance) } else { (1, label.semantic) };
        let new = || Gathered { semantic: label.semantic, ..Gathered::default() };
        lists[list].entry(key).or_insert_with(new).add(mesh, face);
    }
    lists
}

impl Gathered {
    /// Adds a triangle of the mesh.
    fn add(&mut self, mesh: &MeshGeometry, face: usize) {
        let points = mesh.faces[face].map(|vertex| mesh.vertices[vertex as usize]);
        let area = 0.5 * (points[1] - points[0]).cross(points[2] - points[0]).length();
        *self.objects.entry(mesh.object_of_face[face]).or_default() += area;
        if let Some(material) = mesh.material_of_face[face] {
            *self.materials.entry(material).or_default() += area;
        }
        self.points.extend(points);
        self.corners.push(points.map(|p| p.as_vec3()));
    }
}
