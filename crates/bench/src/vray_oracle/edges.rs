//! The positions of the squares' edges in V-Ray's picture, relative to those that the imported geometry and camera predict.

use super::picture::Picture;
use enfilade_geometry::Bvh;
use enfilade_math::{DVec2, DVec3, Ray, Vec3};
use enfilade_scene::{CameraView, Part, Scene, WorldMesh};

/// Half the length of a profile across an edge, pixels.
const HALF_PX: f64 = 2.5;

/// Length at each end of a profile over which its level there is measured, pixels.
const LEVEL_PX: f64 = 1.0;

/// Share of a square that its white margin is wide.
const MARGIN: f64 = 0.1;

/// Points of a profile.
const POINTS: usize = 101;

/// An edge is clear when its two sides differ by this share of the brighter one.
const CONTRAST: f64 = 0.15;

/// A place on an edge of a square.
pub struct EdgePoint {
    /// Outward normal of the edge in the picture.
    pub normal: DVec2,
    /// How much further outward V-Ray's edge is, pixels.
    pub offset_px: f64,
}

/// The view of a scene from a camera.
pub struct Sight<'s> {
    scene: &'s Scene,
    world: WorldMesh,
    bvh: Bvh,
    view: CameraView<'s>,
}

impl<'s> Sight<'s> {
    pub fn new(scene: &'s Scene, view: CameraView<'s>) -> Self {
        let world = WorldMesh::new(scene);
        let bvh = Bvh::new(&world.corners, &|_| false);
        Self { scene, world, bvh, view }
    }

    /// The part at a place of the picture.
    pub fn part_at(&self, x: f64, y: f64) -> Option<&'s Part> {
        let ray = self.view.centre_ray(x, y)?;
        let hit = self.bvh.closest(&Ray::new(ray.origin.as_vec3(), ray.direction.as_vec3()))?;
        Some(&self.scene.parts[self.world.sources[hit.triangle as usize].part as usize])
    }

    fn project(&self, p: DVec3) -> Option<DVec2> {
        self.view.project_in_row(p, 0.0).map(DVec2::from)
    }

    /// All places on edges of squares that are seen against another part.
    pub fn edge_points(&self, picture: &Picture) -> Vec<EdgePoint> {
        let squares = self.scene.parts.iter().filter(|p| p.name.starts_with("quad_"));
        squares.flat_map(|square| self.edges_of(square, picture)).collect()
    }

    fn edges_of(&self, square: &Part, picture: &Picture) -> Vec<EdgePoint> {
        let mesh = &self.scene.meshes[square.mesh as usize];
        let size = mesh.positions.iter().fold(Vec3::ZERO, |m, p| m.max(*p)).as_dvec3();
        let corners = [DVec3::ZERO, DVec3::new(size.x, 0.0, 0.0), size, DVec3::new(0.0, size.y, 0.0)];
        let world = |p: DVec3| square.world_from_mesh.transform_point3(p);
        let Some(middle) = self.project(world(0.5 * size)) else { return Vec::new() };
        let mut found = Vec::new();
        for k in 0..4 {
            let (Some(a), Some(b)) = (self.project(world(corners[k])), self.project(world(corners[(k + 1) % 4]))) else { continue };
            let normal = (b - a).perp().normalize_or_zero();
            let normal = if normal.dot(middle - a) > 0.0 { -normal } else { normal };
            // What is left beyond the profile keeps the filter of the picture from the black within.
            if 2.0 * (a - middle).dot(normal) * MARGIN < HALF_PX + LEVEL_PX {
                continue;
            }
            for share in [0.25, 0.375, 0.5, 0.625, 0.75] {
                let at = a.lerp(b, share);
                found.extend(self.offset(square, at, normal, picture).map(|offset_px| EdgePoint { normal, offset_px }));
            }
        }
        found
    }

    /// The offset of V-Ray's edge at a place; `None` where the square is not seen there against another part.
    fn offset(&self, square: &Part, at: DVec2, normal: DVec2, picture: &Picture) -> Option<f64> {
        let border = 2.0 * HALF_PX;
        let inside = |v: f64, size: usize| v > border && v < size as f64 - border;
        if !(inside(at.x, picture.width) && inside(at.y, picture.height)) {
            return None;
        }
        let is_square = |distance: f64| {
            let p = at + normal * distance;
            self.part_at(p.x, p.y).is_some_and(|part| part.name == square.name)
        };
        let beyond = [0.5, HALF_PX].map(|d| at + normal * d).map(|p| self.part_at(p.x, p.y).map(|part| part.material));
        if !(is_square(-0.5) && is_square(-HALF_PX)) || beyond[0] != beyond[1] || beyond[0] == Some(square.material) {
            return None;
        }
        let step = 2.0 * HALF_PX / (POINTS - 1) as f64;
        let profile: Vec<f64> = (0..POINTS).map(|i| at + normal * (i as f64 * step - HALF_PX)).map(|p| picture.at(p.x, p.y)).collect();
        let ends = (LEVEL_PX / step) as usize;
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let (inner, outer) = (mean(&profile[..ends]), mean(&profile[POINTS - ends..]));
        if (inner - outer).abs() < CONTRAST * inner.max(outer) {
            return None;
        }
        // The place of a step that covers as much as the profile does.
        let covered = profile.iter().map(|v| (v - outer) / (inner - outer)).sum::<f64>() * step - 0.5 * step;
        Some(covered - HALF_PX)
    }
}
