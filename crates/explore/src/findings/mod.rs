//! Properties of a scene's geometry that its maker may not have intended: duplicate faces, parts without area, rooms without a ceiling,
//! shells seen from behind.

mod doubled;
mod overlapping;
mod seen;

pub use doubled::doubled_faces;
pub use overlapping::Overlap;
pub use seen::Backs;

use crate::Ceiling;
use enfilade_geometry::Bvh;
use enfilade_scene::{PartId, WorldMesh};

/// The findings of a scene.
#[derive(Clone, Debug)]
pub struct Findings {
    /// Triangles (of the world) with the corners of an earlier one, as `[earlier, later]`.
    pub doubled: Vec<[u32; 2]>,
    /// Parts whose surfaces coincide without being duplicates, those with the largest common area first.
    pub overlapping: Vec<Overlap>,
    /// Parts all of whose triangles are without area.
    pub without_area: Vec<PartId>,
    /// Area of floors between walls with nothing above, square metres.
    pub open_floor_m2: f64,
    /// Parts seen from behind in rooms; `None` without a room.
    pub backs: Option<Backs>,
    /// The ceilings of all rooms.
    pub ceilings: Vec<Ceiling>,
}

/// Looks at a scene, which takes about as long as building `bvh`. That has all triangles filtered, so that one can be looked past.
///
/// ```
/// use enfilade_explore::findings;
/// use enfilade_geometry::{Bvh, Mesh};
/// use enfilade_math::{DAffine3, Rgb, Vec3};
/// use enfilade_scene::{Material, Part, Scene, WorldMesh};
///
/// // A triangle, and the same once more.
/// let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2], [1, 2, 0]], ..Mesh::default() };
/// let part = Part { name: "sheet".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
/// let scene =
///     Scene { meshes: vec![mesh.into()], materials: vec![Material::diffuse("grey", Rgb::splat(0.5))], parts: vec![part], ..Scene::default() };
/// let world = WorldMesh::new(&scene);
/// let found = findings(&world, &Bvh::new(&world.corners, &|_| true));
/// assert_eq!(found.doubled, [[0, 1]]);
/// ```
pub fn findings(world: &WorldMesh, bvh: &Bvh) -> Findings {
    let ceilings = crate::ceilings(world, bvh);
    Findings {
        doubled: doubled_faces(world),
        overlapping: overlapping::overlaps(world, bvh),
        without_area: without_area(world),
        open_floor_m2: seen::open_floor_m2(world, bvh),
        backs: seen::backs(world, bvh, &ceilings),
        ceilings,
    }
}

fn without_area(world: &WorldMesh) -> Vec<PartId> {
    let parts = world.sources.last().map_or(0, |source| source.part as usize + 1);
    let mut has_area = vec![true; parts];
    world.sources.iter().for_each(|source| has_area[source.part as usize] = false);
    for (corners, source) in world.corners.iter().zip(&world.sources) {
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        has_area[source.part as usize] |= (b - a).cross(c - a).length_squared() > 0.0;
    }
    (0..parts).filter(|part| !has_area[*part]).map(|part| part as PartId).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testroom::{Room, cuboid};
    use enfilade_math::{DVec3, Vec3};

    fn look(parts: Vec<Vec<[Vec3; 3]>>) -> Findings {
        let world = Room::from_parts(parts).world;
        findings(&world, &Bvh::new(&world.corners, &|_| true))
    }

    fn shell(inward: bool) -> Vec<[Vec3; 3]> {
        cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), inward)
    }

    #[test]
    fn nothing_is_found_in_a_furnished_room() {
        // A cupboard on the floor touches it, and a box stands on the cupboard: contacts are no findings.
        for z in [0.001, 0.0] {
            let cupboard = cuboid(DVec3::new(1.0, 1.0, z), DVec3::new(1.6, 2.0, 1.0), false);
            let on_it = cuboid(DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.6, 1.8, 1.3), false);
            let found = look(vec![shell(true), cupboard, on_it]);
            assert!(found.doubled.is_empty() && found.overlapping.is_empty() && found.without_area.is_empty(), "{:?}", found.overlapping);
            assert_eq!((found.open_floor_m2, found.backs.map(|backs| backs.share)), (0.0, Some(0.0)));
        }
    }

    #[test]
    fn faces_that_lie_twice_are_found_whichever_corner_is_first_and_whichever_way_they_face() {
        let twice = vec![shell(true), shell(true), shell(false)];
        assert_eq!(look(twice).doubled.len(), 24);
    }

    #[test]
    fn surfaces_that_lie_in_each_other_are_found_with_their_parts() {
        // A carpet right in the floor: 2 m² of it.
        let carpet_at = |z: f32| {
            let [a, b, c, d] = [[1.0, 1.0], [3.0, 1.0], [3.0, 2.0], [1.0, 2.0]].map(|[x, y]| Vec3::new(x, y, z));
            vec![[a, b, c], [a, c, d]]
        };
        for inward in [true, false] {
            let found = look(vec![shell(inward), carpet_at(0.0)]);
            assert_eq!(found.overlapping.len(), 1, "{:?}", found.overlapping);
            assert_eq!(found.overlapping[0].parts, [0, 1]);
            assert!((found.overlapping[0].area_m2 - 2.0).abs() < 0.3, "{:?}", found.overlapping);
            assert!(found.doubled.is_empty());
        }
        // A sheet that a cupboard stands on, seen from the room below it.
        let sheet = carpet_at(1.2);
        let cupboard = cuboid(DVec3::new(1.0, 1.0, 1.2), DVec3::new(2.0, 2.0, 2.0), false);
        assert_eq!(look(vec![shell(true), sheet, cupboard]).overlapping.len(), 1);
    }

    #[test]
    fn parts_without_area_are_named() {
        let point = vec![[Vec3::ONE; 3], [Vec3::ONE, Vec3::ONE, Vec3::splat(1.5)]];
        assert_eq!(look(vec![shell(true), point]).without_area, [1]);
    }

    #[test]
    fn a_room_without_a_ceiling_is_found_and_a_roof_is_not() {
        let mut room = Room::from_corners(shell(true));
        room.remove_ceiling();
        let open = findings(&room.world, &room.bvh).open_floor_m2;
        assert!((10.0..12.5).contains(&open), "{open}");
        let house =
            look(vec![cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true), cuboid(DVec3::splat(-0.2), DVec3::new(4.2, 3.2, 2.7), false)]);
        assert_eq!(house.open_floor_m2, 0.0);
    }

    #[test]
    fn a_shell_that_faces_outward_is_seen_from_behind() {
        let backs = look(vec![shell(false)]).backs.unwrap();
        assert_eq!((backs.share, backs.parts), (1.0, vec![0]));
    }
}
