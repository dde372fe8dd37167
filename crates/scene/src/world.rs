//! All triangles of a scene in world space, each with the part that it comes from: what rays meet.

use crate::{PartId, Scene, contrast};
use enfilade_math::{Bounds3, Vec3};

/// Which triangle of which part a world triangle is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleSource {
    /// The part.
    pub part: PartId,
    /// Index into the triangles of the part's mesh.
    pub triangle: u32,
}

/// All triangles of a scene in world space, in the order of parts and their triangles. This is what rays meet, in the
/// renderer and in the exploration of free space alike. Shared meshes are written out once per part.
///
/// ```
/// use enfilade_geometry::{Bvh, Mesh};
/// use enfilade_math::{DAffine3, DVec3, Ray, Rgb, Vec3};
/// use enfilade_scene::{Material, Part, Scene, WorldMesh};
///
/// let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
/// let part = |name: &str, z: f64| {
///     Part { name: name.into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::from_translation(DVec3::Z * z) }
/// };
/// let scene = Scene {
///     meshes: vec![mesh.into()],
///     materials: vec![Material::diffuse("grey", Rgb::splat(0.5))],
///     parts: vec![part("floor", 0.0), part("ceiling", 2.5)],
///     ..Scene::default()
/// };
///
/// // A ray upward meets the ceiling.
/// let world = WorldMesh::new(&scene);
/// let bvh = Bvh::new(&world.corners, &|_| false);
/// let hit = bvh.closest(&Ray::new(Vec3::new(0.25, 0.25, 1.5), Vec3::Z)).unwrap();
/// let source = world.sources[hit.triangle as usize];
/// assert_eq!((scene.parts[source.part as usize].name.as_str(), hit.t), ("ceiling", 1.0));
/// ```
#[derive(Clone, Debug)]
pub struct WorldMesh {
    /// Corners of every triangle.
    pub corners: Vec<[Vec3; 3]>,
    /// Source of each triangle.
    pub sources: Vec<TriangleSource>,
    /// The smallest box around all of them.
    pub bounds: Bounds3,
    /// RMS contrast of the colours of each part: the standard deviation of their luminance over its mean, 0 without a texture.
    pub contrasts: Vec<f32>,
}

impl WorldMesh {
    /// Places every part's mesh in the world. Positions are transformed in double precision and rounded once.
    pub fn new(scene: &Scene) -> Self {
        let total = scene.parts.iter().map(|p| scene.meshes[p.mesh as usize].triangles.len()).sum();
        let mut corners = Vec::with_capacity(total);
        let mut sources = Vec::with_capacity(total);
        let mut bounds = Bounds3::EMPTY;
        for (id, part) in scene.parts.iter().enumerate() {
            let mesh = &scene.meshes[part.mesh as usize];
            let world: Vec<Vec3> = scene.world_positions(part).collect();
            for (triangle, indices) in mesh.triangles.iter().enumerate() {
                let triangle_corners = indices.map(|i| world[i as usize]);
                bounds = triangle_corners.iter().fold(bounds, |b, &p| b.include(p));
                corners.push(triangle_corners);
                sources.push(TriangleSource { part: id as PartId, triangle: triangle as u32 });
            }
        }
        Self { corners, sources, bounds, contrasts: contrast::of_parts(scene) }
    }
}
