//! The geometry layers: point samples at pixel centres, evaluated in double precision. A lens or an open shutter changes nothing of
//! them: [`CameraView::centre_ray`] gives the ray of a pixel.

use crate::prepared::{AlphaTest, RenderScene};
use crate::surface::Surface;
use crate::texture::Cone;
use enfilade_frame::{F16_LIMIT, f16};
use enfilade_math::{DVec3, Ray, Vec3};
use enfilade_scene::{CameraRay, CameraView};

/// Geometry at the point that the ray through a pixel's centre meets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelGeometry {
    /// Euclidean distance, metres.
    pub distance_m: f32,
    /// Planar depth, metres; negative behind a camera that sees there.
    pub depth_z_m: f32,
    /// World position.
    pub position: [f32; 3],
    /// Without and with bump, in the world and in camera axes.
    pub normal_world: [f16; 3],
    pub normal_cam: [f16; 3],
    pub normal_bump_world: [f16; 3],
    pub normal_bump_cam: [f16; 3],
    pub tex_coord: [f16; 3],
    /// Part number from 1.
    pub entity: i16,
}

/// The surface that an image point shows.
pub(crate) struct Sighting<'s> {
    pub surface: Surface<'s>,
    /// Index into the scene's triangles.
    pub triangle: u32,
    /// From the camera centre, unit length.
    pub direction: DVec3,
    /// Along the exact ray, metres.
    pub distance_m: f64,
    /// World position.
    pub p_world: DVec3,
}

/// The first surface that the ray through an image point meets; `None` if there is none.
pub(crate) fn sighting<'s>(scene: &RenderScene<'s>, view: &CameraView<'_>, (x, y): (f64, f64)) -> Option<Sighting<'s>> {
    let CameraRay { origin, direction } = view.centre_ray(x, y)?;
    let ray = Ray::new(origin.as_vec3(), direction.as_vec3());
    let hit = scene.closest(&ray, AlphaTest::Half)?;
    let surface = scene.surface(&hit, ray.direction, &Cone::POINT);
    let triangle = hit.triangle;
    let distance_m = exact_distance(scene.triangles.get(triangle).corners, origin, direction).unwrap_or(f64::from(hit.t));
    Some(Sighting { surface, triangle, direction, distance_m, p_world: origin + direction * distance_m })
}

/// The geometry seen through the centre of pixel (x, y); `None` when nothing is.
pub(crate) fn pixel_geometry(scene: &RenderScene<'_>, view: &CameraView<'_>, x: u32, y: u32) -> Option<PixelGeometry> {
    let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
    sighting(scene, view, (x, y)).map(|found| geometry_of(scene, view, y, &found))
}

/// The stored geometry of the surface that an image point at the coordinate `y` shows.
pub(crate) fn geometry_of(scene: &RenderScene<'_>, view: &CameraView<'_>, y: f64, found: &Sighting<'_>) -> PixelGeometry {
    let &Sighting { ref surface, triangle, direction, distance_m: distance, p_world } = found;
    let cam_from_world = view.row_placement(y).1.transpose();
    let to_camera = |n: Vec3| halves((cam_from_world * n.as_dvec3()).as_vec3());
    PixelGeometry {
        distance_m: distance as f32,
        depth_z_m: (-(cam_from_world * direction).z * distance) as f32,
        position: p_world.as_vec3().to_array(),
        normal_world: halves(surface.ns_smooth),
        normal_cam: to_camera(surface.ns_smooth),
        normal_bump_world: halves(surface.ns),
        normal_bump_cam: to_camera(surface.ns),
        tex_coord: [finite_half(surface.uv.x), finite_half(surface.uv.y), f16::ZERO],
        entity: (scene.triangles.get(triangle).part + 1) as i16,
    }
}

/// Distance along the exact ray to the plane of a triangle. `None` if the ray is in the plane.
pub(crate) fn exact_distance(corners: [Vec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let n = (b - a).cross(c - a);
    let t = (a - origin).dot(n) / direction.dot(n);
    (t.is_finite() && t > 0.0).then_some(t)
}

fn halves(v: Vec3) -> [f16; 3] {
    v.to_array().map(f16::from_f32)
}

/// Texture coordinates of many repeats stay finite.
fn finite_half(v: f32) -> f16 {
    f16::from_f32(v.clamp(-F16_LIMIT, F16_LIMIT))
}
