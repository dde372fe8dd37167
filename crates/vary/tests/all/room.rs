//! A room of boxes: 4 × 5 × 2.5 m with a window, a table with a cup and books, a chair, a sofa, a shelf on the wall, and three lamps.

use enfilade_geometry::Mesh;
use enfilade_math::{Bounds3, DAffine3, DVec3, Rgb, Vec3};
use enfilade_scene::{Bsdf, Environment, LabelledScene, Labels, Light, Material, Object, Part, PartLabel, Scene};
use std::collections::BTreeMap;

/// Numbers of materials.
pub const CLOTH: usize = 2;
pub const STEEL: usize = 4;
const PAINT: usize = 0;
const PLANKS: usize = 1;
const OAK: usize = 3;
const BULB: usize = 5;

fn materials() -> Vec<Material> {
    let steel = Bsdf::Conductor { eta: Rgb::splat(2.0), k: Rgb::splat(3.0), reflectance: Rgb::WHITE.into(), alpha: 0.1.into() };
    vec![
        Material::diffuse("paint", Rgb::splat(0.8)),
        Material::diffuse("planks", Rgb::new(0.4, 0.3, 0.2)),
        Material::diffuse("cloth", Rgb::new(0.2, 0.25, 0.3)),
        Material::diffuse("oak", Rgb::new(0.5, 0.35, 0.2)),
        Material::new("steel", steel),
        Material::emitter("bulb", Rgb::splat(10.0)),
    ]
}

/// A box of `size` whose bottom has its middle at `at`.
struct Block(&'static str, usize, i16, [f32; 3], [f64; 3]);

/// Parts in the order of the scene: name, material, class, size and place.
const BLOCKS: [Block; 19] = [
    Block("floor", PLANKS, 2, [4.0, 5.0, 0.1], [0.0, 0.0, -0.1]),
    Block("ceiling", PAINT, 22, [4.0, 5.0, 0.1], [0.0, 0.0, 2.5]),
    Block("wall_west", PAINT, 1, [0.1, 5.0, 2.5], [-2.05, 0.0, 0.0]),
    Block("wall_east", PAINT, 1, [0.1, 5.0, 2.5], [2.05, 0.0, 0.0]),
    Block("wall_north", PAINT, 1, [4.0, 0.1, 2.5], [0.0, 2.55, 0.0]),
    Block("wall_south_left", PAINT, 1, [1.2, 0.1, 2.5], [-1.4, -2.55, 0.0]),
    Block("wall_south_right", PAINT, 1, [1.2, 0.1, 2.5], [1.4, -2.55, 0.0]),
    Block("table_1/top", OAK, 7, [1.2, 0.8, 0.04], [0.2, 0.3, 0.7]),
    Block("table_1/leg", STEEL, 7, [0.5, 0.5, 0.7], [0.2, 0.3, 0.0]),
    Block("cup_1/body", PAINT, 40, [0.08, 0.08, 0.1], [0.5, 0.4, 0.74]),
    Block("book_1/body", CLOTH, 23, [0.2, 0.15, 0.03], [-0.1, 0.4, 0.74]),
    Block("book_2/body", OAK, 23, [0.15, 0.1, 0.03], [-0.1, 0.4, 0.77]),
    Block("chair_1/seat", OAK, 5, [0.4, 0.4, 0.45], [0.2, -0.8, 0.0]),
    Block("sofa_1/body", CLOTH, 6, [0.8, 1.8, 0.7], [-1.55, 0.0, 0.0]),
    Block("shelf_1/board", OAK, 15, [1.0, 0.3, 0.04], [0.5, 2.35, 1.5]),
    Block("vase_1/body", PAINT, 40, [0.15, 0.15, 0.3], [0.5, 2.35, 1.54]),
    Block("lamp_1/bulb", BULB, 35, [0.2, 0.2, 0.1], [0.0, 1.0, 2.3]),
    Block("lamp_2/bulb", BULB, 35, [0.2, 0.2, 0.1], [0.0, -1.0, 2.3]),
    Block("steel_bin_1/body", STEEL, 39, [0.3, 0.3, 0.4], [1.7, -2.2, 0.0]),
];

/// The room.
pub fn room() -> LabelledScene {
    let mut scene = Scene { materials: materials(), ..Scene::default() };
    let mut labels = Labels::default();
    let mut instances: BTreeMap<&str, i16> = BTreeMap::new();
    for Block(name, material, class, size, at) in BLOCKS {
        let owner = name.split('/').next().unwrap_or(name);
        let is_thing = ![1, 2, 22].contains(&class);
        let next = instances.len() as i16 + 1;
        let instance = if is_thing { *instances.entry(owner).or_insert(next) } else { -1 };
        let object = is_thing.then(|| {
            let known = scene.objects.iter().position(|object| object.name == owner);
            known.unwrap_or_else(|| {
                scene.objects.push(Object { name: owner.into(), parent: None });
                scene.objects.len() - 1
            }) as u32
        });
        let size = Vec3::from(size);
        let world_from_mesh = DAffine3::from_translation(DVec3::from(at) + DVec3::Z * f64::from(0.5 * size.z));
        scene.meshes.push(Mesh::cuboid(size).into());
        let mesh = scene.meshes.len() as u32 - 1;
        scene.parts.push(Part { name: name.into(), object, mesh, material: material as u32, world_from_mesh });
        labels.parts.push(PartLabel { semantic: class, instance });
    }
    scene.environment = Some(Environment::Constant { radiance: Rgb::splat(1.0) });
    scene.lights.push(Light::Point { name: "spot".into(), position: Vec3::new(0.0, 0.0, 2.4), intensity: Rgb::splat(2.0) });
    scene.validate().unwrap();
    LabelledScene { scene, labels, ..LabelledScene::default() }
}

/// Material of a part.
pub fn material<'a>(scene: &'a LabelledScene, part: &str) -> &'a Material {
    let part = scene.scene.parts.iter().find(|known| known.name == part).unwrap();
    &scene.scene.materials[part.material as usize]
}

/// Instance of a part.
pub fn instance(scene: &LabelledScene, part: &str) -> i16 {
    let index = scene.scene.parts.iter().position(|known| known.name == part).unwrap();
    scene.labels.parts[index].instance
}

/// Checks that no box of one thing is in the box of another by more than a millimetre, seen from above and by height, unless it is turned.
pub fn check_boxes(scene: &LabelledScene) {
    let boxes: Vec<(String, i16, Bounds3)> = (0..scene.scene.parts.len())
        .map(|part| {
            let [min, max] = scene.scene.part_bounds(part as u32).map(|p| p.as_vec3());
            (scene.scene.parts[part].name.clone(), scene.labels.parts[part].instance, Bounds3 { min, max })
        })
        .collect();
    for (name, instance, bounds) in &boxes {
        // Inside of the walls, and not below the floor.
        if *instance >= 1 && !name.starts_with("lamp") {
            assert!(bounds.min.x > -2.001 && bounds.max.x < 2.001 && bounds.min.y > -2.501 && bounds.max.y < 2.501, "{name}: {bounds:?}");
            assert!(bounds.min.z > -1e-3, "{name}: {bounds:?}");
        }
        // What stood on something still does.
        let rests = |other: &Bounds3| (bounds.min.z - other.max.z).abs() < 2e-3 && overlaps(bounds, other);
        if *instance >= 1 && !name.starts_with("lamp") && !name.starts_with("shelf") && name != "table_1/top" {
            assert!(boxes.iter().any(|(_, other, bounds)| other != instance && rests(bounds)), "{name} floats: {bounds:?}");
        }
    }
}

fn overlaps(a: &Bounds3, b: &Bounds3) -> bool {
    a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y
}
