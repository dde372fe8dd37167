//! Meshes that are placed several times and stored once.
//!
//! Their boxes are tested in the mesh's own space, by the ray brought there. Their triangles are placed in the world when they are
//! tested, with the rounding that they would have if they were stored there. So hits are the same, bit for bit, as without sharing.

use super::leaf::{FILTERED, LANES, Leaf, Words, row_at, word_of};
use super::node::{LEAF, MAX_DEPTH};
use super::prepared::{Prepared, SLACK};
use enfilade_math::{Bounds3, DAffine3, Ray, Vec3, place};

/// A placement of a shared mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Index of the mesh.
    pub mesh: usize,
    /// Places it in the world. Can be inverted.
    pub world_from_mesh: DAffine3,
    /// The number that hits report for the mesh's first triangle here; the others follow.
    pub first_triangle: u32,
    /// Whether its triangles ask the filter.
    pub filtered: bool,
}

impl Placement {
    /// A point of the mesh in the world: in double precision, rounded once.
    #[inline]
    pub fn world(&self, p: Vec3) -> Vec3 {
        place(&self.world_from_mesh, p)
    }
}

/// Marks, with [`LEAF`], a placement in place of a leaf.
pub(super) const PLACED: u32 = 1 << 30;
/// Entry on the stack below those inside a placement: when it is popped, the ray leaves the placement.
pub(super) const LEAVE: u32 = LEAF | PLACED | (PLACED - 1);
/// Levels of a tree in which placements lead to trees of their own.
pub(super) const MAX_LEVELS: usize = 2 * MAX_DEPTH;

/// A placement made ready.
#[derive(Clone, Copy)]
pub(super) struct Placed {
    /// The mesh's root node.
    pub root: u32,
    first_triangle: u32,
    /// [`FILTERED`] or nothing.
    flag: u32,
    /// The greatest absolute value of a coordinate of the mesh.
    largest_coordinate: f32,
    /// Largest factor by which a vector of the world can be longer in the mesh, measured by the greatest component.
    stretch: f32,
    world_from_mesh: DAffine3,
    mesh_from_world: DAffine3,
}

impl Placed {
    pub fn new(placement: &Placement, root: u32, bounds: Bounds3) -> Self {
        let mesh_from_world = placement.world_from_mesh.inverse();
        let rows = mesh_from_world.matrix3.transpose();
        let stretch = [rows.x_axis, rows.y_axis, rows.z_axis].into_iter().map(|row| row.abs().element_sum()).fold(0.0, f64::max);
        Self {
            root,
            first_triangle: placement.first_triangle,
            flag: if placement.filtered { FILTERED } else { 0 },
            largest_coordinate: bounds.min.abs().max(bounds.max.abs()).max_element(),
            stretch: stretch as f32,
            world_from_mesh: placement.world_from_mesh,
            mesh_from_world,
        }
    }

    /// The ray as the mesh sees it, for its boxes; parameters on it are those in the world.
    ///
    /// Boxes grow by what they would in the world, `world_slack`, for the triangles are tested there; and by the same share of the
    /// mesh's coordinates, for the ray's own rounding.
    #[inline(always)]
    pub fn prepared(&self, ray: &Ray, world_slack: f32) -> Prepared {
        let origin = place(&self.mesh_from_world, ray.origin);
        let direction = self.mesh_from_world.transform_vector3(ray.direction.as_dvec3()).as_vec3();
        let slack = SLACK * (self.largest_coordinate + origin.abs().max_element()) + self.stretch * world_slack;
        Prepared::with_slack(origin, direction, slack)
    }

    /// A leaf's triangles in the world, written to `words`.
    // No closures here: they would be compiled without vector instructions, and a ray would take six times as long.
    #[inline(always)]
    pub fn in_world<'w>(&self, leaf: Leaf<'_>, words: &'w mut Words) -> Leaf<'w> {
        let m = self.world_from_mesh.to_cols_array();
        let count = leaf.count();
        for (lane, word) in words[..count].iter_mut().enumerate() {
            *word = word_of((leaf.id(lane) + self.first_triangle) | self.flag);
        }
        // SAFETY: there are three axes.
        let [x, y, z] = unsafe { [leaf.rows(0), leaf.rows(1), leaf.rows(2)] };
        let mut rows = [[[0; LANES]; 3]; 3];
        for corner in 0..3 {
            for lane in 0..LANES {
                let (x, y, z) = (f64::from(x[corner][lane]), f64::from(y[corner][lane]), f64::from(z[corner][lane]));
                for k in 0..3 {
                    // In the order of `transform_point3`, so that the result equals `Placement::world` in every bit.
                    rows[k][corner][lane] = ((m[k] * x + m[3 + k] * y + m[6 + k] * z + m[9 + k]) as f32).to_bits();
                }
            }
        }
        for k in 0..3 {
            for corner in 0..3 {
                // It writes beyond the row; the next row overwrites that.
                let at = row_at(count, corner, k);
                words[at..at + LANES].copy_from_slice(&rows[k][corner]);
            }
        }
        Leaf::of(words, count)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{Triangle, bits, kernels, random_triangles, solid, unkind_ray};
    use super::super::{Bvh, Hit};
    use super::*;
    use enfilade_math::{DMat3, DQuat, DVec3, Rng};

    /// Loose triangles and placed meshes, and the same triangles all in the world.
    struct Pair {
        shared: Bvh,
        flat: Bvh,
        world: Vec<Triangle>,
    }

    /// `filtered` by the number of a triangle, the same for all of a placement.
    fn pair(loose: &[Triangle], meshes: &[Vec<Triangle>], places: &[(usize, DAffine3)], filtered: bool) -> Pair {
        // Every other loose triangle comes before the placements, the rest after them.
        let (mut world, mut numbers, mut corners, mut placements) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut flags = Vec::new();
        let mut stand = |triangles: &[Triangle], world: &mut Vec<Triangle>, flags: &mut Vec<bool>| {
            for triangle in triangles {
                numbers.push(world.len() as u32);
                corners.push(*triangle);
                flags.push(filtered && world.len().is_multiple_of(3));
                world.push(*triangle);
            }
        };
        let half = loose.len() / 2;
        stand(&loose[..half], &mut world, &mut flags);
        for (i, &(mesh, world_from_mesh)) in places.iter().enumerate() {
            let placement = Placement { mesh, world_from_mesh, first_triangle: world.len() as u32, filtered: filtered && i % 2 == 0 };
            world.extend(meshes[mesh].iter().map(|triangle| triangle.map(|p| placement.world(p))));
            flags.resize(world.len(), placement.filtered);
            placements.push(placement);
        }
        stand(&loose[half..], &mut world, &mut flags);
        let filter = |number: u32| flags[number as usize];
        Pair { shared: Bvh::with_placements(&corners, &numbers, &filter, meshes, &placements), flat: Bvh::new(&world, &filter), world }
    }

    fn any_placement(rng: &mut Rng, room: f32) -> DAffine3 {
        let mut unit = || f64::from(rng.range(-1.0, 1.0));
        let turn = DQuat::from_xyzw(unit(), unit(), unit(), unit()).normalize();
        let scale = DVec3::new(2f64.powf(3.0 * unit()), 2f64.powf(3.0 * unit()), unit());
        let at = DVec3::new(unit(), unit(), unit()) * f64::from(room);
        DAffine3 { matrix3: DMat3::from_quat(turn) * DMat3::from_diagonal(scale), translation: at }
    }

    #[test]
    fn rays_hit_what_they_hit_among_all_triangles_in_the_world_to_the_bit() {
        let mut rng = Rng::new(5);
        for (room, size, loose, places) in [(4.0, 0.3, 200, 20), (1.0, 1.0, 0, 3), (3000.0, 20.0, 30, 40), (0.01, 0.001, 5, 9)] {
            let loose = random_triangles(&mut rng, loose, room, size);
            let meshes: Vec<Vec<Triangle>> = [1, 7, 300].map(|count| random_triangles(&mut rng, count, 0.2 * room, size)).into();
            let places: Vec<(usize, DAffine3)> = (0..places).map(|i| (i % 3, any_placement(&mut rng, room))).collect();
            for filtered in [false, true] {
                let mut pair = pair(&loose, &meshes, &places, filtered);
                let mut hits = 0;
                for _ in 0..3000 {
                    let ray = unkind_ray(&mut rng, &pair.world, room);
                    let accept = |hit: &Hit| hit.triangle.is_multiple_of(2);
                    for kernel in kernels() {
                        pair.shared.kernel = kernel;
                        let expected = pair.flat.closest(&ray);
                        assert_eq!(bits(pair.shared.closest(&ray)), bits(expected), "{ray:?} {kernel:?}");
                        assert_eq!(pair.shared.occluded(&ray), expected.is_some(), "{ray:?} {kernel:?}");
                        let expected = pair.flat.closest_filtered(&ray, accept);
                        assert_eq!(bits(pair.shared.closest_filtered(&ray, accept)), bits(expected), "{ray:?} {kernel:?}");
                        assert_eq!(pair.shared.occluded_filtered(&ray, accept), expected.is_some(), "{ray:?} {kernel:?}");
                        hits += usize::from(expected.is_some());
                    }
                }
                assert!(hits > 300, "{hits} hits");
            }
        }
    }

    #[test]
    fn of_placements_in_the_same_place_the_first_is_hit() {
        let mesh = random_triangles(&mut Rng::new(1), 20, 1.0, 1.0);
        let Pair { shared, world, .. } = pair(&[], &[mesh], &[(0, DAffine3::IDENTITY); 30], false);
        assert_eq!(shared.triangle_count(), 600);
        let first = solid(&world[..20]);
        let mut rng = Rng::new(2);
        for _ in 0..1000 {
            let ray = unkind_ray(&mut rng, &world, 1.0);
            assert_eq!(bits(shared.closest(&ray)), bits(first.closest(&ray)));
        }
    }

    #[test]
    fn a_mesh_is_kept_once() {
        let mesh = random_triangles(&mut Rng::new(1), 5000, 1.0, 0.1);
        let memory = |count: usize| {
            let places: Vec<_> = (0..count).map(|i| (0, DAffine3::from_translation(DVec3::X * i as f64))).collect();
            pair(&[], std::slice::from_ref(&mesh), &places, false).shared.memory_bytes()
        };
        let (one, hundred) = (memory(1), memory(100));
        assert!(hundred < one + 100 * 512, "{one} bytes for one, {hundred} for a hundred");
    }

    #[test]
    fn placements_of_nothing_are_nowhere() {
        let places = [(0, DAffine3::IDENTITY)];
        let Pair { shared, .. } = pair(&[], &[Vec::new()], &places, false);
        assert!(shared.bounds().is_empty());
        assert!(!shared.occluded(&Ray::new(Vec3::ZERO, Vec3::X)));
        let flat = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0];
        let Pair { shared, .. } = pair(&[], &[vec![flat]], &places, false);
        assert!(!shared.occluded(&Ray::new(Vec3::Y, Vec3::NEG_Y)));
    }
}
