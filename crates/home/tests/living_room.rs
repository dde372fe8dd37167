//! What every living room must be, whatever its seed.

use enfilade_geometry::Bvh;
use enfilade_home::{Home, HomeConfig, living_room};
use enfilade_math::{Bounds3, Ray, Vec3, warp};
use enfilade_scene::{Bsdf, Environment, Light, NYU40, Scene, WorldMesh, is_stuff, to_bytes};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

const SEEDS: u64 = 20;

static HOMES: LazyLock<Vec<Home>> = LazyLock::new(|| {
    let home = |seed| living_room(&HomeConfig { seed });
    std::thread::scope(|scope| {
        let second = scope.spawn(|| (SEEDS / 2..SEEDS).map(home).collect::<Vec<_>>());
        (0..SEEDS / 2).map(home).chain(second.join().expect("no home panics")).collect()
    })
});

/// World box of every part.
fn part_boxes(scene: &Scene) -> Vec<Bounds3> {
    let world = WorldMesh::new(scene);
    let mut boxes = vec![Bounds3::EMPTY; scene.parts.len()];
    for (corners, source) in world.corners.iter().zip(&world.sources) {
        boxes[source.part as usize] = corners.iter().fold(boxes[source.part as usize], |b, &p| b.include(p));
    }
    boxes
}

/// The part of a name before the slash.
fn object_of(name: &str) -> &str {
    name.split('/').next().unwrap_or(name)
}

/// The family of an object: `sofa` of `sofa_1`.
fn family_of(object: &str) -> &str {
    object.rsplit_once('_').map_or(object, |(family, _)| family)
}

/// Small things on the window sill stand within the wall's thickness.
fn on_the_sill(object: &str, bounds: &Bounds3) -> bool {
    ["plant", "candlestick"].contains(&family_of(object)) && bounds.min.z > 0.4
}

fn inner_box(scene: &Scene, boxes: &[Bounds3]) -> Bounds3 {
    let find = |name: &str| boxes[scene.parts.iter().position(|p| p.name == name).unwrap_or_else(|| panic!("no part {name}"))];
    let (west, east) = (find("wall_west_1/plaster"), find("wall_east_1/plaster"));
    let (south, north) = (find("wall_south_1/plaster"), find("wall_north_1/plaster"));
    let ceiling = find("ceiling_1/plaster");
    Bounds3 { min: Vec3::new(west.max.x, south.max.y, 0.0), max: Vec3::new(east.min.x, north.min.y, ceiling.min.z) }
}

#[test]
fn every_seed_gives_a_valid_scene_of_reasonable_size() {
    for (seed, home) in HOMES.iter().enumerate() {
        assert_eq!(home.scene.validate(), Ok(()), "seed {seed}");
        let triangles: usize = home.scene.parts.iter().map(|p| home.scene.meshes[p.mesh as usize].triangles.len()).sum();
        assert!((60_000..250_000).contains(&triangles), "seed {seed}: {triangles} triangles");
        assert!(home.scene.images.iter().all(|i| i.width <= 1024 && i.height <= 1024), "seed {seed}");
        assert!((2..=4).contains(&home.scene.cameras.len()), "seed {seed}: {} cameras", home.scene.cameras.len());
        assert_eq!(home.scene.cameras[0].name, "door", "seed {seed}: the demo starts at the door");
    }
}

#[test]
fn every_part_is_labelled_and_instances_have_no_gaps() {
    for (seed, home) in HOMES.iter().enumerate() {
        let (parts, labels) = (&home.scene.parts, &home.labels.parts);
        assert!(parts.len() >= 80 && parts.len() == labels.len(), "seed {seed}: {} parts, {} labels", parts.len(), labels.len());
        let mut objects: BTreeMap<&str, (i16, i16)> = BTreeMap::new();
        let mut instances = BTreeSet::new();
        for (part, label) in parts.iter().zip(labels) {
            assert!((1..=NYU40.len() as i16).contains(&label.semantic), "{}", part.name);
            assert_eq!(label.instance == -1, is_stuff(label.semantic), "{}", part.name);
            instances.insert(label.instance);
            let first = *objects.entry(object_of(&part.name)).or_insert((label.semantic, label.instance));
            assert_eq!(first, (label.semantic, label.instance), "parts of one object share its label: {}", part.name);
        }
        instances.remove(&-1);
        let expected: BTreeSet<i16> = (1..=instances.len() as i16).collect();
        assert_eq!(instances, expected, "seed {seed}");
        let classes: BTreeSet<i16> = labels.iter().map(|l| l.semantic).collect();
        assert!(classes.len() >= 12, "seed {seed}: only classes {classes:?}");
    }
}

#[test]
fn the_essentials_are_there() {
    for (seed, home) in HOMES.iter().enumerate() {
        let families: BTreeSet<&str> = home.scene.parts.iter().map(|p| family_of(object_of(&p.name))).collect();
        for family in
            ["sofa", "coffee_table", "tv_bench", "television", "rug", "window", "door", "curtain", "bookshelf", "books", "picture"]
        {
            assert!(families.contains(family), "seed {seed} has no {family}");
        }
        let materials = &home.scene.materials;
        let lit = home.scene.parts.iter().filter(|p| !materials[p.material as usize].emission.factor.is_black());
        let lamps: BTreeSet<&str> = lit.map(|p| object_of(&p.name)).collect();
        assert!(lamps.len() >= 2, "seed {seed}: lit lamps {lamps:?}");
        assert!(home.scene.parts.iter().any(|p| matches!(materials[p.material as usize].bsdf, Bsdf::ThinDielectric { .. })));
        assert!(matches!(home.scene.environment, Some(Environment::Map { .. })));
        assert!(home.scene.lights.iter().any(|l| matches!(l, Light::Directional { .. })));
    }
}

#[test]
fn furniture_stands_inside_and_does_not_run_into_other_furniture() {
    const BIG: [&str; 9] =
        ["sofa", "armchair", "coffee_table", "tv_bench", "bookshelf", "dining_table", "side_table", "floor_lamp", "radiator"];
    for (seed, home) in HOMES.iter().enumerate() {
        let boxes = part_boxes(&home.scene);
        let inside = inner_box(&home.scene, &boxes);
        let mut big: BTreeMap<&str, Vec<Bounds3>> = BTreeMap::new();
        for (part, bounds) in home.scene.parts.iter().zip(&boxes) {
            let object = object_of(&part.name);
            let fixed =
                ["wall_", "floor_1", "ceiling", "skirting", "window", "door", "switch", "picture", "mirror", "curtain_rod", "radiator"];
            if fixed.iter().any(|f| object.starts_with(f)) || on_the_sill(object, bounds) {
                continue;
            }
            let room = Bounds3 { min: inside.min - 0.001, max: inside.max + 0.001 };
            assert!(room.contains(bounds.min) && room.contains(bounds.max), "seed {seed}: {} at {bounds:?} in {inside:?}", part.name);
            if BIG.contains(&family_of(object)) {
                big.entry(object).or_default().push(*bounds);
            }
        }
        for (a, parts_a) in &big {
            for (_, parts_b) in big.range::<str, _>((std::ops::Bound::Excluded(*a), std::ops::Bound::Unbounded)) {
                for (p, q) in parts_a.iter().flat_map(|p| parts_b.iter().map(move |q| (p, q))) {
                    let apart = p.min.cmpge(q.max).any() || q.min.cmpge(p.max).any();
                    assert!(apart, "seed {seed}: {a} runs into another piece: {p:?} and {q:?}");
                }
            }
        }
    }
}

#[test]
fn cameras_stand_in_free_space() {
    for (seed, home) in HOMES.iter().enumerate() {
        let boxes = part_boxes(&home.scene);
        let inside = inner_box(&home.scene, &boxes);
        for camera in &home.scene.cameras {
            let eye = camera.position.as_vec3();
            assert!(inside.contains(eye) && (1.2..=1.6).contains(&eye.z), "seed {seed}: {} at {eye}", camera.name);
            for (part, bounds) in home.scene.parts.iter().zip(&boxes) {
                let distance = eye.distance(eye.clamp(bounds.min, bounds.max));
                assert!(distance >= 0.499, "seed {seed}: {} is {distance} m from {}", camera.name, part.name);
            }
        }
    }
}

#[test]
fn no_ray_leaves_the_room() {
    for (seed, home) in HOMES.iter().enumerate().take(6) {
        let world = WorldMesh::new(&home.scene);
        let bvh = Bvh::new(&world.corners, &|_| false);
        let outer = Bounds3 { min: world.bounds.min, max: world.bounds.max };
        for (i, camera) in home.scene.cameras.iter().enumerate() {
            for k in 0..20_000 {
                let u = [(k as f32 + 0.5) / 20_000.0, (k as f32 * 0.618_034 + 0.1 * i as f32).fract()];
                let ray = Ray::new(camera.position.as_vec3(), warp::sphere(u));
                let hit = bvh.closest(&ray).unwrap_or_else(|| panic!("seed {seed}: ray {ray:?} leaves the room"));
                assert!(outer.contains(ray.at(hit.t * 0.999)));
            }
        }
    }
}

#[test]
fn same_seed_same_bytes_and_other_seeds_other_rooms() {
    let again = living_room(&HomeConfig { seed: 3 });
    assert!(to_bytes(&again.scene) == to_bytes(&HOMES[3].scene));
    assert_eq!(again.labels, HOMES[3].labels);
    let bytes: BTreeSet<Vec<u8>> = HOMES.iter().take(4).map(|h| to_bytes(&h.scene)).collect();
    assert_eq!(bytes.len(), 4);
}
