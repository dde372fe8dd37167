//! The data of a triangle for shading, in one place: two cache lines instead of lookups of part, mesh and three vertices.

use enfilade_math::{Mat3, Vec2, Vec3};
use enfilade_scene::{Part, Scene};

/// A triangle in world space with its vertex attributes. Two adjacent cache lines are fetched together.
#[derive(Clone, Copy, Debug)]
#[repr(align(128))]
pub(crate) struct Triangle {
    /// Corners.
    pub corners: [Vec3; 3],
    /// Outward normals at the corners (not unit length); the face's, three times, for flat meshes.
    pub normals: [Vec3; 3],
    /// Texture coordinates at the corners; zero where the mesh has none.
    pub uvs: [Vec2; 3],
    /// The part.
    pub part: u32,
    /// The part's material.
    pub material: u32,
    /// Unit normal by winding, which is not always the outward one; zero for a triangle without area.
    pub winding: Vec3,
    /// Square of the texture coordinate per square metre; not finite for a triangle without area.
    pub uv_density: f32,
    /// How far a ray must start off the face beyond [`enfilade_math::offset_origin`], metres: nothing in ordinary rooms.
    pub slack: f32,
}

/// Points of a face are found within about this fraction of the coordinates of its corners: a few units in the last place.
const ROUNDING: f32 = 4e-7;
/// Distance by which [`enfilade_math::offset_origin`] moves points near the world's origin, metres.
const OFFSET: f32 = 1.0 / 65536.0;

/// The origin's offset grows with a point's own coordinates. A point in the middle of a face whose corners are far away has small
/// ones, and yet the rounding of large ones.
fn slack(corners: &[Vec3; 3]) -> f32 {
    let farthest = corners.iter().fold(0.0f32, |far, corner| far.max(corner.abs().max_element()));
    (ROUNDING * farthest - OFFSET).max(0.0)
}

impl Triangle {
    /// A triangle of a part: its corners in the world and its vertices in the mesh.
    pub fn new(scene: &Scene, (number, part): (u32, &Part), normal_from_mesh: &Mat3, corners: [Vec3; 3], vertices: [u32; 3]) -> Self {
        let mesh = &scene.meshes[part.mesh as usize];
        let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let normals = if mesh.normals.is_empty() {
            [face.normalize_or(Vec3::Z); 3]
        } else {
            vertices.map(|i| (*normal_from_mesh * mesh.normals[i as usize]).normalize_or(face.normalize_or(Vec3::Z)))
        };
        let uvs = if mesh.uvs.is_empty() { [Vec2::ZERO; 3] } else { vertices.map(|i| mesh.uvs[i as usize]) };
        let area2 = face.length();
        let winding = if area2 > 0.0 { face / area2 } else { Vec3::ZERO };
        let uv_density = (uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]).abs() / area2;
        Self { corners, normals, uvs, part: number, material: part.material, winding, uv_density, slack: slack(&corners) }
    }

    /// World position for these weights of the corners.
    #[inline]
    pub fn position(&self, [a, b, c]: [f32; 3]) -> Vec3 {
        self.corners[0] * a + self.corners[1] * b + self.corners[2] * c
    }

    /// Normal by winding times twice the area; its side follows from the corners' order and is not always outward.
    #[inline]
    pub fn cross(&self) -> Vec3 {
        (self.corners[1] - self.corners[0]).cross(self.corners[2] - self.corners[0])
    }

    /// Texture coordinates at a hit.
    #[inline]
    pub fn uv(&self, [a, b, c]: [f32; 3]) -> Vec2 {
        self.uvs[0] * a + self.uvs[1] * b + self.uvs[2] * c
    }
}
