//! Position of a surface point in another frame: the next one, or any.

use crate::prepared::{AlphaTest, RenderScene};
use crate::rows::Moved;
use enfilade_math::{DVec3, Ray};
use enfilade_scene::{CameraRay, CameraView};

/// A point is seen when the ray to it is free up to this fraction of its length.
const REACH: f64 = 0.999;

/// A view that flow leads to.
#[derive(Clone, Copy)]
pub struct FlowTo<'a> {
    /// Camera and pose.
    pub view: &'a CameraView<'a>,
    /// The scene as that view finds it, if it moves.
    pub moved: Option<&'a Moved<'a>>,
}

impl<'a> FlowTo<'a> {
    /// A view of a scene that does not move.
    pub fn still(view: &'a CameraView<'a>) -> Self {
        Self { view, moved: None }
    }
}

/// The motion of one surface point as the camera sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flow {
    /// Pixels, x right and y down; `None` when the next camera has no image of the point.
    pub image: Option<[f32; 2]>,
    /// Camera axes, metres.
    pub camera: [f32; 3],
    /// The next frame shows it.
    pub visible: bool,
}

/// From the image point of `view` that shows `p_world` of a triangle to the image point of `to`. `None` for points that are not finite. `band`
/// is that of the image point's row, which shows `scene`.
pub(super) fn flow(
    (scene, band): (&RenderScene<'_>, usize),
    view: &CameraView<'_>,
    to: FlowTo<'_>,
    (x, y): (f64, f64),
    (triangle, p_world): (u32, DVec3),
) -> Option<Flow> {
    if !p_world.is_finite() {
        return None;
    }
    let next = to.view;
    let (p_then, scene) = to.moved.map_or((p_world, scene), |moved| moved.place(next, (scene, triangle), p_world, band));
    let there = next.project(p_then);
    let row = there.map_or(y, |(_, row)| row.clamp(0.0, f64::from(next.camera().size()[1])));
    let in_camera = |view: &CameraView, p: DVec3, row: f64| {
        let (position, world_from_camera) = view.row_placement(row);
        world_from_camera.transpose() * (p - position)
    };
    Some(Flow {
        image: there.map(|(next_x, next_y)| [(next_x - x) as f32, (next_y - y) as f32]),
        camera: (in_camera(next, p_then, row) - in_camera(view, p_world, y)).as_vec3().to_array(),
        visible: there.is_some_and(|there| shows(scene, next, there, p_then)),
    })
}

/// Whether the image point is inside the image, and nothing before the world point there.
pub(crate) fn shows(scene: &RenderScene<'_>, view: &CameraView<'_>, (x, y): (f64, f64), p_world: DVec3) -> bool {
    let [width, height] = view.camera().size().map(f64::from);
    if !(0.0..width).contains(&x) || !(0.0..height).contains(&y) {
        return false;
    }
    let Some(CameraRay { origin, .. }) = view.centre_ray(x, y) else { return false };
    let distance = origin.distance(p_world);
    let mut ray = Ray::new(origin.as_vec3(), ((p_world - origin) / distance).as_vec3());
    ray.t_max = (REACH * distance) as f32;
    !scene.is_met(&ray, AlphaTest::Half)
}
