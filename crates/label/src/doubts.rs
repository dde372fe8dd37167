//! Doubtful labels found from geometry: instances that are hardly one thing, and things that are hardly several.
//!
//! Parts are represented by their bounding boxes, so that only parts that are certainly apart are reported.

use enfilade_geometry::DisjointSets;
use enfilade_math::{Bounds3, Vec3};
use enfilade_scene::{Labels, PartId, Scene, is_stuff};
use std::collections::BTreeMap;

/// Distance between parts of one instance, with nothing between, above which they are hardly one thing, metres.
const APART_M: f32 = 0.8;
/// Distance between parts below which they touch, metres.
const TOUCHING_M: f32 = 0.01;
/// Instances of more parts than this are not looked at: their pairs would take long.
const MAX_PARTS: usize = 1000;
/// Share of the distance between two boxes, at either end, that does not count as between.
const AT_THE_ENDS: f32 = 0.05;
/// Number of names that a remark shows.
const SHOWN: usize = 3;

/// Doubts about the instances of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Doubts {
    /// Instances whose parts are apart: instance number, two of the parts, and their distance, metres.
    pub scattered: Vec<(i16, [PartId; 2], f32)>,
    /// Parts of one object and class that touch and are of two instances.
    pub torn: Vec<[PartId; 2]>,
}

/// Looks for instances whose parts are apart with nothing between, and for touching parts of one object that are several instances.
///
/// # Panics
/// When there is not one label per part.
pub fn doubts(scene: &Scene, labels: &Labels) -> Doubts {
    assert_eq!(scene.parts.len(), labels.parts.len(), "one label per part");
    let boxes: Vec<Bounds3> = scene.parts.iter().map(|part| Bounds3::from_points(scene.world_positions(part))).collect();
    let mut of_instance = BTreeMap::<i16, Vec<PartId>>::new();
    let mut of_object = BTreeMap::<(u32, i16), Vec<PartId>>::new();
    for (part, label) in (0..).zip(&labels.parts).filter(|(_, label)| label.instance >= 1) {
        of_instance.entry(label.instance).or_default().push(part);
        of_object.entry((scene.object_of(part), label.semantic)).or_default().push(part);
    }
    let few = |parts: &Vec<PartId>| (2..=MAX_PARTS).contains(&parts.len());
    let scattered = of_instance.iter().filter(|(_, parts)| few(parts));
    let torn = of_object.values().filter(|parts| few(parts));
    Doubts {
        scattered: scattered.filter_map(|(&instance, parts)| apart(parts, &boxes, labels).map(|(two, far)| (instance, two, far))).collect(),
        torn: torn.filter_map(|parts| two_of_one(parts, &boxes, labels)).collect(),
    }
}

impl Doubts {
    /// A remark for each kind of doubt, with a count and some names.
    pub fn remarks(&self, scene: &Scene) -> Vec<String> {
        let name = |part: PartId| &scene.parts[part as usize].name;
        let listed = |list: Vec<String>| list.into_iter().take(SHOWN).collect::<Vec<_>>().join("; ");
        let scattered = self.scattered.iter().map(|(_, [a, b], far)| format!("{:?} and {:?}, {far:.1} m apart", name(*a), name(*b)));
        let torn = self.torn.iter().map(|[a, b]| format!("{:?} and {:?}", name(*a), name(*b)));
        let mut remarks = Vec::new();
        if !self.scattered.is_empty() {
            let (count, some) = (self.scattered.len(), listed(scattered.collect()));
            remarks.push(format!(
                "{count} instances have parts that lie apart with nothing between, and may be several things: {some}; rows of a label table \
                 with numbers in the column instance part them"
            ));
        }
        if !self.torn.is_empty() {
            let (count, some) = (self.torn.len(), listed(torn.collect()));
            remarks.push(format!(
                "{count} objects have parts of one class that touch and are of several instances: {some}; one number in the column instance \
                 of the label table joins them"
            ));
        }
        remarks
    }
}

/// The two nearest parts of an instance that are apart, and their distance; `None` if all parts are connected.
fn apart(parts: &[PartId], boxes: &[Bounds3], labels: &Labels) -> Option<([PartId; 2], f32)> {
    let mut sets = DisjointSets::new(parts.len());
    let mut far: Vec<(f32, usize, usize)> = Vec::new();
    for i in 0..parts.len() {
        for k in 0..i {
            let [p, q] = nearest(&boxes[parts[i] as usize], &boxes[parts[k] as usize]);
            match p.distance(q) {
                gap if gap < APART_M || is_something_between(p, q, parts, boxes, labels) => _ = sets.unite(i as u32, k as u32),
                gap => far.push((gap, k, i)),
            }
        }
    }
    let of_two = |&(_, i, k): &(f32, usize, usize)| sets.root(i as u32) != sets.root(k as u32);
    far.into_iter().filter(of_two).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(gap, i, k)| ([parts[i], parts[k]], gap))
}

/// Two parts of an object and class that touch and are of different instances.
fn two_of_one(parts: &[PartId], boxes: &[Bounds3], labels: &Labels) -> Option<[PartId; 2]> {
    let instance = |part: PartId| labels.parts[part as usize].instance;
    let touch = |a: PartId, b: PartId| {
        let [p, q] = nearest(&boxes[a as usize], &boxes[b as usize]);
        p.distance(q) < TOUCHING_M
    };
    let pairs = parts.iter().enumerate().flat_map(|(i, &a)| parts[i + 1..].iter().map(move |&b| [a, b]));
    pairs.into_iter().find(|&[a, b]| instance(a) != instance(b) && touch(a, b))
}

/// True if something other than walls, floors and ceilings is between the points; what encloses both ends, as a room does, is not between.
fn is_something_between(p: Vec3, q: Vec3, parts: &[PartId], boxes: &[Bounds3], labels: &Labels) -> bool {
    let [from, to] = [p.lerp(q, AT_THE_ENDS), q.lerp(p, AT_THE_ENDS)];
    (0..).zip(boxes).filter(|(part, _)| !is_stuff(labels.parts[*part as usize].semantic) && !parts.contains(part)).any(|(_, other)| {
        let encloses = other.contains(p) && other.contains(q);
        !encloses && crosses(other, from, to)
    })
}

/// True where a straight way meets a box.
fn crosses(bounds: &Bounds3, from: Vec3, to: Vec3) -> bool {
    let (mut enter, mut leave) = (0.0f32, 1.0f32);
    for axis in 0..3 {
        let (start, along, low, high) = (from[axis], to[axis] - from[axis], bounds.min[axis], bounds.max[axis]);
        if along == 0.0 {
            if !(low..=high).contains(&start) {
                return false;
            }
            continue;
        }
        let (a, b) = ((low - start) / along, (high - start) / along);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    enter <= leave
}

/// The points of two boxes that are nearest to each other.
fn nearest(a: &Bounds3, b: &Bounds3) -> [Vec3; 2] {
    let mut points = [Vec3::ZERO; 2];
    for axis in 0..3 {
        let (low, high) = (a.min[axis].max(b.min[axis]), a.max[axis].min(b.max[axis]));
        // Where the boxes overlap along an axis, both points lie in the middle of the overlap.
        let [of_a, of_b] = if low <= high {
            [0.5 * (low + high); 2]
        } else if a.max[axis] < b.min[axis] {
            [a.max[axis], b.min[axis]]
        } else {
            [a.min[axis], b.max[axis]]
        };
        (points[0][axis], points[1][axis]) = (of_a, of_b);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_geometry::Mesh;
    use enfilade_math::{DAffine3, DVec3, Rgb};
    use enfilade_scene::{Material, Object, Part, PartLabel};

    /// Cubes of 60 cm around these points, each of the object of its number.
    fn cubes(at: &[([f64; 3], u32)]) -> Scene {
        let corner = |i: u32| {
            0.3 * Vec3::new(if i & 1 > 0 { 1.0 } else { -1.0 }, if i & 2 > 0 { 1.0 } else { -1.0 }, if i & 4 > 0 { 1.0 } else { -1.0 })
        };
        let mesh = Mesh { positions: (0..8).map(corner).collect(), triangles: vec![[0, 1, 2], [5, 6, 7]], ..Mesh::default() };
        let part = |(i, &(at, object)): (usize, &([f64; 3], u32))| Part {
            name: format!("cube_{i}"),
            object: Some(object),
            mesh: 0,
            material: 0,
            world_from_mesh: DAffine3::from_translation(DVec3::from_array(at)),
        };
        Scene {
            meshes: vec![mesh.into()],
            materials: vec![Material::diffuse("m", Rgb::WHITE)],
            objects: (0..9).map(|i| Object { name: format!("object_{i}"), parent: None }).collect(),
            parts: at.iter().enumerate().map(part).collect(),
            ..Scene::default()
        }
    }

    fn labels(of: &[(i16, i16)]) -> Labels {
        Labels { parts: of.iter().map(|&(semantic, instance)| PartLabel { semantic, instance }).collect() }
    }

    #[test]
    fn three_chairs_of_one_instance_are_told_and_three_instances_are_sound() {
        // 60 cm wide, 1.5 m from middle to middle: 90 cm apart. A slab of floor is below.
        let scene = cubes(&[([-1.5, 2.0, 0.5], 0), ([0.0, 2.0, 0.5], 1), ([1.5, 2.0, 0.5], 2), ([0.0, 2.0, -0.31], 3)]);
        let found = doubts(&scene, &labels(&[(5, 1), (5, 1), (5, 1), (2, -1)]));
        let [(1, [0, 1], far)] = found.scattered[..] else { panic!("{found:?}") };
        assert!((far - 0.9).abs() < 1e-5 && found.torn.is_empty(), "{found:?}");
        let told = found.remarks(&scene);
        assert!(told[0].starts_with("1 instances have parts that lie apart with nothing between") && told[0].contains("0.9 m"), "{told:?}");
        assert_eq!(doubts(&scene, &labels(&[(5, 1), (5, 2), (5, 3), (2, -1)])), Doubts::default());
    }

    #[test]
    fn parts_with_something_between_or_hanging_together_are_one_thing() {
        // Shelves to both sides of a television; a row of cubes without gaps.
        let scene = cubes(&[([-1.5, 0.0, 0.0], 0), ([1.5, 0.0, 0.0], 0), ([0.0, 0.0, 0.0], 1)]);
        assert_eq!(doubts(&scene, &labels(&[(15, 1), (15, 1), (25, 2)])), Doubts::default());
        let row = cubes(&[([0.0, 0.0, 0.0], 0), ([0.6, 0.0, 0.0], 0), ([1.2, 0.0, 0.0], 0)]);
        assert_eq!(doubts(&row, &labels(&[(6, 1), (6, 1), (6, 1)])), Doubts::default());
    }

    #[test]
    fn touching_parts_of_one_object_in_two_instances_are_told() {
        let chair = cubes(&[([0.0, 0.0, 0.0], 0), ([0.0, 0.0, 0.6], 0), ([0.0, 0.6, 0.0], 1)]);
        let found = doubts(&chair, &labels(&[(5, 1), (5, 2), (5, 3)]));
        assert_eq!((found.torn.clone(), found.scattered.len()), (vec![[0, 1]], 0));
        assert!(found.remarks(&chair)[0].contains("\"cube_0\" and \"cube_1\""));
        // Another class is another thing, and so is another object.
        assert_eq!(doubts(&chair, &labels(&[(5, 1), (18, 2), (5, 3)])), Doubts::default());
    }
}
