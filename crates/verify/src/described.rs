//! The law of relations between instances: things recorded as touching do touch, checked by nearest points instead of rays; a thing
//! recorded as inside another has its middle there, and a thing recorded as under another is below it.

use super::boxes::there;
use super::card::Card;
use super::law::Law;
use super::read::readable;
use enfilade_dataset::{Dataset, DatasetError, InstanceRelation, RelationKind};
use enfilade_geometry::NearestTriangle;
use enfilade_label::rooms::{LabelledTriangle, labelled_triangles};
use enfilade_math::{Bounds3, DVec3, Vec3};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Spacing of the points from which distances are searched, metres, and their largest number along an edge.
const SPACING_M: f64 = 0.05;
const STEPS: f64 = 100.0;

/// The triangles of an instance, or of all walls, floors or ceilings, metres.
struct Surface {
    corners: Vec<[Vec3; 3]>,
    bounds: Bounds3,
    nearest: NearestTriangle,
}

/// Instance and, where that is −1, class.
type Key = (i16, i16);

/// Checks the recorded relations of a scene, if there are any.
pub(super) fn check(dataset: &Dataset, scene: &str, card: &mut Card) {
    let Some(relations) = there(dataset.read_instance_relations(scene)).and_then(|read| readable(card, read)) else { return };
    // A copy without the mesh has nothing to measure.
    let Some(surfaces) = there(surfaces(dataset, scene)).and_then(|read| readable(card, read)) else { return };
    let off = |relation: &InstanceRelation| {
        let object = if relation.object < 1 { (-1, relation.object_semantic) } else { (relation.object, 0) };
        let subject = surfaces.get(&(relation.subject, 0));
        subject.zip(surfaces.get(&object)).map_or(f64::INFINITY, |(a, b)| off_m(relation, a, b))
    };
    let found: Vec<f64> = enfilade_parallel::map(&relations, off);
    for (relation, off) in relations.iter().zip(found) {
        let at = || {
            let InstanceRelation { subject, kind, object, object_semantic, distance_m } = relation;
            format!("{scene}: instance {subject} {} {object} of class {object_semantic}, {distance_m} m apart", kind.name())
        };
        card.observe(Law::InstanceRelations, off, at);
    }
}

/// Deviation of two surfaces from their recorded relation, metres.
fn off_m(relation: &InstanceRelation, a: &Surface, b: &Surface) -> f64 {
    let outside = |p: Vec3, bounds: &Bounds3| f64::from(p.distance(p.clamp(bounds.min, bounds.max)));
    match relation.kind {
        RelationKind::In => outside(a.bounds.center(), &b.bounds),
        // Part of it is below the other's top, and they overlap from above.
        RelationKind::Under => f64::from(a.bounds.gap(&b.bounds).truncate().length().max(a.bounds.min.z - b.bounds.max.z)),
        RelationKind::Facing => 0.0,
        RelationKind::On | RelationKind::HangsFrom | RelationKind::Against | RelationKind::Beside => {
            let reach = relation.distance_m + Law::InstanceRelations.spec().bound;
            (a.distance_m(b, reach).min(b.distance_m(a, reach)) - relation.distance_m).max(0.0)
        }
    }
}

impl Surface {
    fn new(corners: Vec<[Vec3; 3]>) -> Self {
        let bounds = Bounds3::from_points(corners.iter().flatten().copied());
        Self { bounds, nearest: NearestTriangle::new(&corners), corners }
    }

    /// The least distance to another surface, from points all over its triangles; infinite beyond `reach_m`.
    fn distance_m(&self, other: &Self, reach_m: f64) -> f64 {
        let near = |p: &DVec3| p.distance(p.clamp(other.bounds.min.as_dvec3(), other.bounds.max.as_dvec3())) <= reach_m;
        let is_near = |t: &&[Vec3; 3]| f64::from(Bounds3::from_points(**t).gap(&other.bounds).length()) <= reach_m;
        let points: Vec<DVec3> = self.corners.iter().filter(is_near).flat_map(spread).filter(near).collect();
        self.nearest.distance_m(&other.nearest, &points)
    }
}

/// Points of a triangle some centimetres apart, its corners among them.
fn spread(triangle: &[Vec3; 3]) -> Vec<DVec3> {
    let [a, b, c] = triangle.map(|p| p.as_dvec3());
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let steps = (longest / SPACING_M).ceil().clamp(1.0, STEPS) as usize;
    let at = |i: usize| i as f64 / steps as f64;
    (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| a + (b - a) * at(i) + (c - a) * at(j))).collect()
}

/// The surfaces of a scene by what they are labelled as.
fn surfaces(dataset: &Dataset, scene: &str) -> Result<BTreeMap<Key, Surface>, DatasetError> {
    let mut found: BTreeMap<Key, Vec<[Vec3; 3]>> = BTreeMap::new();
    for LabelledTriangle { corners, label } in labelled_triangles(dataset, scene)? {
        let key = if label.instance >= 1 { (label.instance, 0) } else { (-1, label.semantic) };
        found.entry(key).or_default().push(corners.map(|p| p.as_vec3()));
    }
    Ok(found.into_par_iter().map(|(key, corners)| (key, Surface::new(corners))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_to_touch_and_does_not_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = enfilade_testroom::dataset(folder.path());
        let off = |relation: InstanceRelation| {
            dataset.write_instance_relations("room", &[relation]).unwrap();
            let mut card = Card::default();
            check(&dataset, "room", &mut card);
            card.finding(Law::InstanceRelations).unwrap().value
        };
        let hangs = InstanceRelation { subject: 1, kind: RelationKind::HangsFrom, object: -1, object_semantic: 1, distance_m: 0.0 };
        assert_eq!(off(hangs), 0.0);
        assert!(off(InstanceRelation { distance_m: -0.5, ..hangs }) >= 0.5);
        assert!(off(InstanceRelation { subject: 7, ..hangs }).is_infinite());
        assert!(off(InstanceRelation { object_semantic: 22, ..hangs }).is_infinite());
    }

    #[test]
    fn distances_in_and_under_are_told() {
        let square = |low: Vec3, side: f32| {
            let [x, y] = [Vec3::X * side, Vec3::Y * side];
            Surface::new(vec![[low, low + x, low + x + y], [low, low + x + y, low + y]])
        };
        let said = |kind| InstanceRelation { subject: 1, kind, object: 2, object_semantic: 7, distance_m: 0.01 };
        let (floor, above) = (square(Vec3::ZERO, 1.0), square(Vec3::new(0.25, 0.25, 0.5), 0.5));
        assert!((off_m(&said(RelationKind::On), &above, &square(Vec3::new(0.0, 0.0, 0.49), 1.0)) - 0.0).abs() < 1e-6);
        assert!(off_m(&said(RelationKind::On), &above, &floor).is_infinite());
        assert_eq!(off_m(&said(RelationKind::Under), &floor, &above), 0.0);
        assert_eq!(off_m(&said(RelationKind::Under), &above, &floor), 0.5);
        assert_eq!(off_m(&said(RelationKind::In), &above, &floor), 0.5);
    }
}
