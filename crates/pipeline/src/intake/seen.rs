//! An imported scene prepared for inspection.

use enfilade_explore::{Findings, findings};
use enfilade_geometry::Bvh;
use enfilade_math::Bounds3;
use enfilade_scene::{Scene, WorldMesh};

/// Factor by which a part that does not belong to the building is longer than all others together: flat ground, and the dome of a sky
/// around at least this many parts. The shell of a room around one thing is neither.
const GROUND: f32 = 2.0;
const DOME: f32 = 20.0;
const DOME_PARTS: usize = 5;
/// Extents of a part over each other from which on it is flat.
const FLAT: f32 = 0.02;

/// An imported scene as rays meet it, and what a look at it found.
pub(crate) struct Look {
    pub world: WorldMesh,
    pub bvh: Bvh,
    pub findings: Findings,
}

impl Look {
    /// Looks at a scene.
    pub fn at(scene: &Scene) -> Self {
        let world = WorldMesh::new(scene);
        let bvh = Bvh::new(&world.corners, &|_| true);
        let findings = findings(&world, &bvh);
        Self { world, bvh, findings }
    }

    /// The bounds of the scene, without its largest part where that dwarfs all others, as a landscape or the dome of a sky does.
    pub fn bounds_of_building(&self) -> Bounds3 {
        let [largest, others] = self.largest_and_others();
        if others.is_empty() || largest.is_empty() {
            return self.world.bounds;
        }
        let (size, times) = (largest.extent(), largest.extent().max_element() / others.extent().max_element());
        let is_ground = times > GROUND && size.min_element() < FLAT * size.max_element();
        let parts = self.world.sources.last().map_or(0, |source| source.part as usize + 1);
        let is_dome = times > DOME && parts > DOME_PARTS;
        if is_ground || is_dome { others } else { self.world.bounds }
    }

    /// The bounds of the largest part, and of all others together; empty for a single part.
    pub fn largest_and_others(&self) -> [Bounds3; 2] {
        let mut parts: Vec<Bounds3> = Vec::new();
        for (corners, source) in self.world.corners.iter().zip(&self.world.sources) {
            parts.resize(parts.len().max(source.part as usize + 1), Bounds3::EMPTY);
            let part = &mut parts[source.part as usize];
            *part = corners.iter().fold(*part, |bounds, &p| bounds.include(p));
        }
        let size = |bounds: &Bounds3| if bounds.is_empty() { 0.0 } else { bounds.extent().max_element() };
        let largest = (1..parts.len()).fold(0, |best, i| if size(&parts[i]) > size(&parts[best]) { i } else { best });
        let others = parts.iter().enumerate().filter(|(i, bounds)| *i != largest && !bounds.is_empty());
        let others = others.fold(Bounds3::EMPTY, |all, (_, bounds)| all.union(*bounds));
        [parts.get(largest).copied().unwrap_or(Bounds3::EMPTY), others]
    }
}
