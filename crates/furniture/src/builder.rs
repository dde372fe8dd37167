//! Puts parts, labels and materials together into a scene.

use crate::joint::{Joint, Jointed};
use crate::lamplight::Glow;
use crate::materials::{Finish, Materials, Surfacing};
use crate::models::{Body, Model};
use crate::palette::Palette;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Rng, Vec2, Vec3, hash_text};
use enfilade_scene::{BodyMotion, Image, Labels, Material, ObjectId, Part, PartLabel, Scene};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The NYU40 classes that a home has; the number is the class's id.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i16)]
#[allow(missing_docs, reason = "plain words")]
pub enum Class {
    Wall = 1,
    Floor = 2,
    Cabinet = 3,
    Bed = 4,
    Chair = 5,
    Sofa = 6,
    Table = 7,
    Door = 8,
    Window = 9,
    Bookshelf = 10,
    Picture = 11,
    Counter = 12,
    Blinds = 13,
    Desk = 14,
    Shelves = 15,
    Curtain = 16,
    Dresser = 17,
    Pillow = 18,
    Mirror = 19,
    FloorMat = 20,
    Clothes = 21,
    Ceiling = 22,
    Books = 23,
    Refrigerator = 24,
    Television = 25,
    Paper = 26,
    Towel = 27,
    ShowerCurtain = 28,
    Box = 29,
    Whiteboard = 30,
    NightStand = 32,
    Toilet = 33,
    Sink = 34,
    Lamp = 35,
    Bathtub = 36,
    Bag = 37,
    OtherStructure = 38,
    OtherFurniture = 39,
    OtherProp = 40,
}

/// One thing that people count: its parts share its name, label and place.
#[derive(Clone, Debug)]
pub struct Object {
    name: String,
    id: ObjectId,
    label: PartLabel,
    /// Takes the object's own space (x right, y to its front, z up) to the world.
    pub pose: DAffine3,
}

/// A scene in the making.
pub struct Builder {
    materials: Materials,
    /// No daylight comes into the room: its lamps are lit.
    dark: bool,
    scene: Scene,
    labels: Labels,
    families: BTreeMap<String, u32>,
    /// To where the fronts of objects look, by the objects' names.
    fronts: BTreeMap<String, DVec3>,
    instances: i16,
    /// Meshes and materials in the scene of the library models used so far, by their numbers.
    loaned: BTreeMap<usize, Arc<Loaned>>,
    /// The models behind objects, by the objects' names.
    models: BTreeMap<String, Arc<Model>>,
    /// The joints so far, one for each body of the scene; `None` where nothing has joints.
    joints: Option<Vec<Jointed>>,
    /// Share of the objects that have joints, and the random numbers that choose them by their names.
    some: (f32, Rng),
    /// Whether the last object has joints.
    jointed: bool,
}

/// Indices of a model's meshes and materials in the scene.
#[derive(Debug)]
pub(crate) struct Loaned {
    pub meshes: Vec<u32>,
    pub materials: Vec<u32>,
}

/// A screen whose texture coordinates run over the unit square, upright as seen from its front: a flat mesh that faces +y, or lies on its
/// back.
fn unit_square(mut mesh: Mesh) -> Mesh {
    let (low, high) = mesh.uvs.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), uv| (low.min(*uv), high.max(*uv)));
    if low == Vec2::ZERO && high == Vec2::ONE {
        return mesh;
    }
    let bounds = mesh.bounds();
    let extent = bounds.extent().max(Vec3::splat(1e-6));
    let upright = extent.y < extent.z;
    let uv = |p: Vec3| {
        let q = (p - bounds.min) / extent;
        if upright { Vec2::new(1.0 - q.x, q.z) } else { Vec2::new(q.x, q.y) }
    };
    mesh.uvs = mesh.positions.iter().map(|p| uv(*p)).collect();
    mesh
}

/// Whether an object is among the `share` of all that `rng` chooses by their names.
pub fn is_among(object: &str, share: f32, rng: &Rng) -> bool {
    rng.fork(hash_text(object)).next_f32() < share
}

/// The pose at (x, y, z), turned by `yaw` radians about the vertical.
pub fn pose(x: f64, y: f64, z: f64, yaw: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z)) * DAffine3::from_rotation_z(yaw)
}

impl Builder {
    /// A builder of an empty scene; finishes become materials when they are first used.
    pub fn new(materials: Materials) -> Self {
        Self {
            materials,
            dark: false,
            scene: Scene::default(),
            labels: Labels::default(),
            families: BTreeMap::new(),
            fronts: BTreeMap::new(),
            instances: 0,
            loaned: BTreeMap::new(),
            models: BTreeMap::new(),
            joints: None,
            some: (0.0, Rng::new(0)),
            jointed: false,
        }
    }

    /// A builder of things that can be opened: they have joints, and an inside.
    #[must_use]
    pub fn with_joints(self) -> Self {
        self.with_some_joints(1.0, Rng::new(0))
    }

    /// A builder of things of which this share can be opened: whether one can depends on `rng` and its name.
    #[must_use]
    pub fn with_some_joints(self, share: f32, rng: Rng) -> Self {
        Self { joints: Some(Vec::new()), some: (share, rng), jointed: share >= 1.0, ..self }
    }

    /// True where the last object has joints, and needs what is to be seen when it is open.
    pub fn has_joints(&self) -> bool {
        self.jointed
    }

    /// Lets `parts` of `object`, in ascending order, move by a joint; nothing where things have none. `name` is that of what moves.
    pub fn joint(&mut self, object: &Object, name: &str, joint: &Joint, parts: impl IntoIterator<Item = usize>) {
        let Some(joints) = self.joints.as_mut().filter(|_| self.jointed) else { return };
        let body = format!("{}/{name}", object.name);
        joints.push(Jointed { body: body.clone(), kind: joint.kind });
        let motion = BodyMotion { times_s: vec![0.0], states: joint.at_rest(&object.pose) };
        let parts = parts.into_iter().map(|part| part as u32).collect();
        let limits = Some(joint.limits);
        self.scene.bodies.push(enfilade_scene::Body { name: body, parent: None, parts, lights: vec![], cameras: vec![], motion, limits });
    }

    /// The joints of the things built so far, one for each body of the scene.
    pub fn joints(&self) -> &[Jointed] {
        self.joints.as_deref().unwrap_or_default()
    }

    /// Parts added from now on have the colours of `palette`; in a `dark` room all lamps are lit at any hour.
    pub fn enter_room(&mut self, palette: Palette, dark: bool) {
        self.dark = dark;
        self.materials.enter_room(palette);
    }

    /// A new object of a family: named `family_1`, `family_2`, … with an instance number of its own.
    pub fn object(&mut self, family: &str, class: Class, pose: DAffine3) -> Object {
        let count = self.families.entry(family.to_string()).or_insert(0);
        *count += 1;
        let semantic = class as i16;
        let instance = if enfilade_scene::is_stuff(semantic) {
            -1
        } else {
            self.instances += 1;
            self.instances
        };
        let name = format!("{family}_{count}");
        self.fronts.insert(name.clone(), pose.transform_vector3(DVec3::Y));
        let (share, rng) = &self.some;
        self.jointed = self.joints.is_some() && (*share >= 1.0 || is_among(&name, *share, rng));
        let id = self.scene.objects.len() as ObjectId;
        self.scene.objects.push(enfilade_scene::Object { name: name.clone(), parent: None });
        Object { name, id, label: PartLabel { semantic, instance }, pose }
    }

    /// Adds a part of `object`, its mesh in the object's space.
    pub fn part(&mut self, object: &Object, name: &str, mesh: Mesh, made_of: impl Into<Surfacing>) {
        self.part_at(object, name, mesh, DAffine3::IDENTITY, made_of);
    }

    /// Adds a part of `object` whose mesh is placed in the object's space by `object_from_mesh`.
    pub fn part_at(&mut self, object: &Object, name: &str, mesh: Mesh, object_from_mesh: DAffine3, made_of: impl Into<Surfacing>) {
        let material = match made_of.into() {
            Surfacing::Finish(finish) => match finish.glow(&mesh) {
                Some(glow) => self.materials.glow(&mut self.scene, &object.name, self.dark, &mesh, glow),
                None => self.materials.get(&mut self.scene, finish),
            },
            Surfacing::Own(material) => material,
        };
        let mesh = self.mesh(mesh);
        self.push(object, name, mesh, material, object.pose * object_from_mesh);
    }

    fn push(&mut self, object: &Object, name: &str, mesh: u32, material: u32, world_from_mesh: DAffine3) {
        self.scene.parts.push(Part { name: format!("{}/{name}", object.name), object: Some(object.id), mesh, material, world_from_mesh });
        self.labels.parts.push(object.label);
    }

    /// Records that `object` is the model of this number, and adds the model's meshes and materials unless they are there. The materials
    /// do not emit light: only lamps do, by [`Builder::glow`].
    pub(crate) fn loan(&mut self, object: &Object, number: usize, model: &Arc<Model>, body: &Body) -> Arc<Loaned> {
        self.models.insert(object.name.clone(), Arc::clone(model));
        if let Some(known) = self.loaned.get(&number) {
            return Arc::clone(known);
        }
        let first_image = self.scene.images.len() as u32;
        self.scene.images.extend(body.images.iter().cloned());
        let dark = |m: &Material| Material { emission: Rgb::BLACK.into(), ..m.clone() };
        let materials = body.materials.iter().map(|m| self.material(dark(m).repictured(|k| k + first_image))).collect();
        let meshes = body.parts.iter().map(|part| self.mesh(part.mesh.clone())).collect();
        let loaned = Arc::new(Loaned { meshes, materials });
        self.loaned.insert(number, Arc::clone(&loaned));
        loaned
    }

    /// Adds a part of `object` whose mesh and material are in the scene already.
    pub(crate) fn loaned_part(&mut self, object: &Object, name: &str, mesh: u32, material: u32) {
        self.push(object, name, mesh, material, object.pose);
    }

    /// The models behind objects, by the objects' names.
    pub fn models(&self) -> &BTreeMap<String, Arc<Model>> {
        &self.models
    }

    /// Adds a luminous part of a lamp. Flux and area give its radiance; the light of the home decides whether it is lit.
    pub fn glow(&mut self, object: &Object, name: &str, mesh: Mesh, glow: Glow) {
        let material = self.materials.glow(&mut self.scene, &object.name, self.dark, &mesh, glow);
        self.part(object, name, mesh, material);
    }

    /// The scene so far.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Turns a screen on that is there already: its part gets this finish, its texture coordinates run over the unit square.
    pub fn turn_on(&mut self, part: usize, finish: Finish) {
        let material = self.materials.get(&mut self.scene, finish);
        let shown = unit_square((*self.scene.meshes[self.scene.parts[part].mesh as usize]).clone());
        let mesh = self.mesh(shown);
        let part = &mut self.scene.parts[part];
        (part.material, part.mesh) = (material, mesh);
    }

    /// Number of parts.
    pub fn part_count(&self) -> usize {
        self.scene.parts.len()
    }

    /// Removes all parts but the first `count`; meshes and materials that nothing else uses are dropped when the home settles.
    pub fn take_back(&mut self, count: usize) {
        self.scene.parts.truncate(count);
        self.labels.parts.truncate(count);
        let kept = self.scene.bodies.iter().take_while(|body| body.parts.iter().all(|&part| (part as usize) < count)).count();
        self.scene.bodies.truncate(kept);
        if let Some(joints) = &mut self.joints {
            joints.truncate(kept);
        }
    }

    /// Adds a material that only one object has.
    pub fn material(&mut self, material: Material) -> u32 {
        self.scene.materials.push(material);
        self.scene.materials.len() as u32 - 1
    }

    /// Adds a picture that only one object has.
    pub fn image(&mut self, image: Image) -> u32 {
        self.scene.images.push(image.into());
        self.scene.images.len() as u32 - 1
    }

    /// To where the fronts of objects look, by the objects' names.
    pub fn fronts(&self) -> &BTreeMap<String, DVec3> {
        &self.fronts
    }

    /// The scene for its last touches, and the labels.
    pub fn finish(self) -> (Scene, Labels) {
        (self.scene, self.labels)
    }

    /// Equal meshes are stored once.
    fn mesh(&mut self, mesh: Mesh) -> u32 {
        let found = self.scene.meshes.iter().position(|m| **m == mesh);
        found.unwrap_or_else(|| {
            self.scene.meshes.push(mesh.into());
            self.scene.meshes.len() - 1
        }) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::bevelled_box;

    #[test]
    fn a_screen_shows_its_picture_upright_and_whole() {
        // Seen from +y, the left edge of an upright screen is at +x.
        for (size, left_top) in
            [(Vec3::new(1.0, 0.02, 0.6), Vec3::new(0.5, 0.0, 0.3)), (Vec3::new(0.1, 0.2, 0.01), Vec3::new(-0.05, 0.1, 0.0))]
        {
            let mesh = unit_square(bevelled_box(size, 0.001));
            let nearest = (0..mesh.positions.len())
                .min_by(|&a, &b| mesh.positions[a].distance(left_top).total_cmp(&mesh.positions[b].distance(left_top)));
            assert!(mesh.uvs[nearest.unwrap()].distance(Vec2::new(0.0, 1.0)) < 0.02);
            assert_eq!(unit_square(mesh.clone()), mesh);
        }
    }
}
