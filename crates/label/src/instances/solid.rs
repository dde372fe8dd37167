//! Instances as solids: the triangles of all their parts, including hidden ones and those cut out by textures.

use enfilade_geometry::Bvh;
use enfilade_math::{Bounds3, DVec3, Vec3};
use enfilade_scene::{Labels, WorldMesh};
use std::collections::BTreeMap;

/// An instance as rays meet it when nothing else is there.
pub struct Solid {
    /// Number of the instance.
    pub instance: i16,
    /// Class of the instance.
    pub semantic: i16,
    pub(super) bvh: Bvh,
    /// A ball around it.
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

/// Every instance of a scene, in ascending order. The class of an instance is the class of its first part.
pub fn solids(world: &WorldMesh, labels: &Labels) -> Vec<Solid> {
    let mut corners: BTreeMap<i16, (i16, Vec<[Vec3; 3]>)> = BTreeMap::new();
    for (triangle, source) in world.corners.iter().zip(&world.sources) {
        if let Some(label) = labels.parts.get(source.part as usize).filter(|label| label.instance >= 1) {
            corners.entry(label.instance).or_insert_with(|| (label.semantic, Vec::new())).1.push(*triangle);
        }
    }
    let instances: Vec<_> = corners.into_iter().collect();
    enfilade_parallel::map(&instances, |(instance, (semantic, corners))| Solid::new(*instance, *semantic, corners))
}

impl Solid {
    pub(super) fn new(instance: i16, semantic: i16, corners: &[[Vec3; 3]]) -> Self {
        let center = Bounds3::from_points(corners.iter().flatten().copied()).center().as_dvec3();
        let radius = corners.iter().flatten().map(|p| p.as_dvec3().distance(center)).fold(0.0, f64::max);
        Self { instance, semantic, bvh: Bvh::new(corners, &|_| false), center, radius }
    }
}
