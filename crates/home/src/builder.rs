//! Puts parts, labels and materials together into a scene.

use crate::materials::Materials;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{Image, Labels, Material, Part, PartLabel, Scene};
use std::collections::BTreeMap;

/// The NYU40 classes that a home has; the number is the class's id.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i16)]
#[allow(missing_docs)]
pub enum Class {
    Wall = 1,
    Floor = 2,
    Cabinet = 3,
    Chair = 5,
    Sofa = 6,
    Table = 7,
    Door = 8,
    Window = 9,
    Bookshelf = 10,
    Picture = 11,
    Curtain = 16,
    Pillow = 18,
    Mirror = 19,
    FloorMat = 20,
    Ceiling = 22,
    Books = 23,
    Television = 25,
    Paper = 26,
    Towel = 27,
    Box = 29,
    Lamp = 35,
    OtherStructure = 38,
    OtherFurniture = 39,
    OtherProp = 40,
}

/// One thing that people count: its parts share its name, label and place.
#[derive(Clone, Debug)]
pub struct Object {
    name: String,
    label: PartLabel,
    /// Takes the object's own space (x right, y to its front, z up) to the world.
    pub pose: DAffine3,
}

/// A scene in the making.
pub struct Builder {
    /// Handles of everything that surfaces are made of.
    pub materials: Materials,
    scene: Scene,
    labels: Labels,
    families: BTreeMap<String, u32>,
    instances: i16,
}

/// The pose at (x, y, z), turned by `yaw` radians about the vertical.
pub fn pose(x: f64, y: f64, z: f64, yaw: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z)) * DAffine3::from_rotation_z(yaw)
}

impl Builder {
    /// Nothing yet but the materials.
    pub fn new(scene: Scene, materials: Materials) -> Self {
        Self { materials, scene, labels: Labels::default(), families: BTreeMap::new(), instances: 0 }
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
        Object { name: format!("{family}_{count}"), label: PartLabel { semantic, instance }, pose }
    }

    /// Adds a part of `object`, its mesh in the object's space.
    pub fn part(&mut self, object: &Object, name: &str, mesh: Mesh, material: u32) {
        self.part_at(object, name, mesh, DAffine3::IDENTITY, material);
    }

    /// Adds a part of `object` whose mesh is placed in the object's space by `object_from_mesh`.
    pub fn part_at(&mut self, object: &Object, name: &str, mesh: Mesh, object_from_mesh: DAffine3, material: u32) {
        let mesh = self.mesh(mesh);
        let world_from_mesh = object.pose * object_from_mesh;
        self.scene.parts.push(Part { name: format!("{}/{name}", object.name), mesh, material, world_from_mesh });
        self.labels.parts.push(object.label);
    }

    /// Adds a material that only one object has.
    pub fn material(&mut self, material: Material) -> u32 {
        self.scene.materials.push(material);
        self.scene.materials.len() as u32 - 1
    }

    /// Adds a picture that only one object has.
    pub fn image(&mut self, image: Image) -> u32 {
        self.scene.images.push(image);
        self.scene.images.len() as u32 - 1
    }

    /// The scene for its last touches, and the labels.
    pub fn finish(self) -> (Scene, Labels) {
        (self.scene, self.labels)
    }

    /// Equal meshes are stored once.
    fn mesh(&mut self, mesh: Mesh) -> u32 {
        let found = self.scene.meshes.iter().position(|m| *m == mesh);
        found.unwrap_or_else(|| {
            self.scene.meshes.push(mesh);
            self.scene.meshes.len() - 1
        }) as u32
    }
}
