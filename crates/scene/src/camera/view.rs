//! A camera at the moment of a frame: rays from image points and back, with lens, shutter and the motion between poses.

use super::Camera;
use crate::Pose;
use enfilade_math::{DMat3, DQuat, DVec2, DVec3};

/// The row of a rolling shutter that shows a point is searched for in this many stretches of the image: two before its middle row, while
/// the camera comes from the pose before, and two after it, while it continues to the next.
const STRETCHES: usize = 4;
/// The search ends at a row from which the point appears no farther away than this, pixels: less than float32 resolves in an image.
const ROW_TOLERANCE: f64 = 1e-6;
/// Steps of the search for a row. Every second one halves what is left, and after 32 halvings a stretch of 16,000 rows is short enough.
const ROW_STEPS: u32 = 64;

/// A ray of a camera, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Metres.
    pub origin: DVec3,
    /// Unit length.
    pub direction: DVec3,
}

/// A camera at the moment of a frame, with the motion around it.
///
/// Colour is the mean over the pixel, the aperture and the exposure ([`CameraView::ray`]). Geometry is a point sample: through the
/// pixel's centre and the lens's centre, in the middle of the exposure of the pixel's row ([`CameraView::centre_ray`]).
///
/// ```
/// use enfilade_math::DVec3;
/// use enfilade_scene::{Camera, CameraView, Intrinsics, Pose};
///
/// let camera = Camera::from(Intrinsics::from_fov_x(640, 480, 1.0));
/// let pose = Pose::look_at(0, DVec3::new(0.0, -2.0, 1.5), DVec3::new(0.0, 0.0, 1.5), DVec3::Z).unwrap();
/// let view = CameraView::still(&camera, &pose);
///
/// // The middle of the image shows what the camera looks at, and back.
/// let ray = view.centre_ray(320.0, 240.0).unwrap();
/// assert_eq!((ray.origin, ray.direction), (pose.position, DVec3::Y));
/// assert_eq!(view.project(pose.look_at), Some((320.0, 240.0)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CameraView<'c> {
    camera: &'c Camera,
    pose: Pose,
    before: Motion,
    after: Motion,
}

/// Steady motion of a camera.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    /// Metres per second.
    velocity: DVec3,
    /// In camera space, radians per second.
    turning: DVec3,
}

impl<'c> CameraView<'c> {
    /// The camera at rest.
    pub fn still(camera: &'c Camera, pose: &Pose) -> Self {
        Self { camera, pose: *pose, before: Motion::default(), after: Motion::default() }
    }

    /// The camera at pose `index` of a trajectory. Without a shutter it is at rest.
    ///
    /// # Panics
    /// When there is no such pose.
    pub fn of_frame(camera: &'c Camera, poses: &[Pose], index: usize) -> Self {
        let still = Self::still(camera, &poses[index]);
        let Some(shutter) = camera.shutter else { return still };
        let motion = |first: usize| poses.get(first..first + 2).map(|pair| Motion::between(&pair[0], &pair[1], shutter.frame_time_s));
        let before = index.checked_sub(1).and_then(motion);
        let after = motion(index).or(before).unwrap_or_default();
        Self { before: before.unwrap_or(after), after, ..still }
    }

    /// The camera.
    pub fn camera(&self) -> &'c Camera {
        self.camera
    }

    /// The frame's pose: the camera's in the middle of the exposure of the image's middle row.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Camera centre and world from camera, `time_s` after the frame's own moment.
    #[inline]
    pub fn placement(&self, time_s: f64) -> (DVec3, DMat3) {
        if time_s == 0.0 {
            return (self.pose.position, self.pose.world_from_camera);
        }
        let motion = if time_s < 0.0 { &self.before } else { &self.after };
        let turn = DMat3::from_quat(DQuat::from_scaled_axis(motion.turning * time_s));
        (self.pose.position + motion.velocity * time_s, self.pose.world_from_camera * turn)
    }

    /// [`CameraView::placement`] in the middle of the exposure of the row at image coordinate `y`.
    #[inline]
    pub fn row_placement(&self, y: f64) -> (DVec3, DMat3) {
        self.placement(self.row_time_s(y))
    }

    /// The ray through the image point (x, y) and the lens's centre in the middle of the row's exposure. `None` where the picture
    /// shows nothing. Every geometry layer, and every calibration file, is about these.
    #[inline]
    pub fn centre_ray(&self, x: f64, y: f64) -> Option<CameraRay> {
        let direction = self.camera.projection.ray(x, y)?;
        let (origin, world_from_camera) = self.row_placement(y);
        Some(CameraRay { origin, direction: (world_from_camera * direction).normalize() })
    }

    /// One ray of the light that the image point (x, y) gathers. `lens` is uniform on [0,1)² over the aperture, `time` on [0,1) over
    /// the exposure. `None` where the picture shows nothing.
    #[inline]
    pub fn ray(&self, x: f64, y: f64, lens: [f32; 2], time: f32) -> Option<CameraRay> {
        let time_s = match &self.camera.shutter {
            Some(shutter) => self.row_time_s(y) + shutter.exposure_s * (f64::from(time) - 0.5),
            None => 0.0,
        };
        let (position, world_from_camera) = self.placement(time_s);
        let direction = self.camera.projection.ray(x, y)?;
        let Some(thin) = &self.camera.lens else {
            return Some(CameraRay { origin: position, direction: (world_from_camera * direction).normalize() });
        };
        let has_plane = self.camera.projection.has_image_plane();
        let point = thin.point(lens);
        let point = if has_plane { point.extend(0.0) } else { across(direction, point) };
        let refracted = thin.refract(direction, point, has_plane);
        Some(CameraRay { origin: position + world_from_camera * point, direction: (world_from_camera * refracted).normalize() })
    }

    /// Image point of a world point as the row of the image at coordinate `y` sees it. `None` when it has none.
    pub fn project_in_row(&self, p_world: DVec3, y: f64) -> Option<(f64, f64)> {
        let (position, world_from_camera) = self.row_placement(y);
        self.camera.projection.project(world_from_camera.transpose() * (p_world - position))
    }

    /// Image point of a world point, with a rolling shutter as seen at the moment of the row that shows it. `None` if it has no image.
    ///
    /// A point that passes the upper or the lower border unseen is projected at the moment of that border's row, to a place beyond the
    /// border. A camera that turns as fast as it is read out may show a point in several rows; the result is one of them.
    pub fn project(&self, p_world: DVec3) -> Option<(f64, f64)> {
        if self.camera.shutter.is_none_or(|shutter| shutter.readout_s == 0.0) {
            return self.project_in_row(p_world, 0.0);
        }
        let height = f64::from(self.camera.size()[1]);

        // The row that shows the point at its own moment, in the first stretch of the image that contains one.
        let rows: [Row; STRETCHES + 1] = std::array::from_fn(|i| self.row(p_world, height * i as f64 / STRETCHES as f64));
        let shown = (0..STRETCHES).find_map(|i| self.own_row(p_world, rows[i], rows[i + 1]));

        // Else the border's row beyond which the point is.
        let [upper, lower] = [rows[0], rows[STRETCHES]];
        let above = || upper.off.is_some_and(|off| off < 0.0).then_some(upper.y);
        let below = || lower.off.is_some_and(|off| off >= 0.0).then_some(lower.y);
        self.project_in_row(p_world, shown.or_else(above).or_else(below)?)
    }

    /// The band of rows that shows something that moves by itself. The bands are exposed one after the other: `first_row` gives the first
    /// row of each of `count`, from 0 on and ascending, and `place` where the point is when that band is exposed. A point that falls between
    /// two bands, so that neither shows it, counts to the upper one.
    pub fn band_that_shows(&self, count: usize, first_row: impl Fn(usize) -> u32, place: impl Fn(usize) -> DVec3) -> usize {
        let (mut band, mut before) = (count / 2, None);
        // A point may jump from band to band at most as often as there are bands.
        for _ in 0..count.saturating_sub(1) {
            let Some((_, y)) = self.project(place(band)) else { break };
            let next = band_of_row(count, &first_row, y);
            if next == band || before == Some(next) {
                return next.min(band);
            }
            (band, before) = (next, Some(band));
        }
        band
    }

    /// The moment of the ray of [`CameraView::ray`] with this `time`, as a share of the whole exposure: from the first moment of the upper
    /// border's row to the last of the lower one's.
    #[inline]
    pub fn exposure_share(&self, y: f64, time: f32) -> f32 {
        match &self.camera.shutter {
            Some(shutter) if shutter.readout_s > 0.0 => {
                let time_s = self.row_time_s(y) + shutter.exposure_s * (f64::from(time) - 0.5);
                (time_s / (shutter.readout_s + shutter.exposure_s) + 0.5) as f32
            }
            _ => time,
        }
    }

    fn row(&self, p_world: DVec3, y: f64) -> Row {
        Row { y, off: self.project_in_row(p_world, y).map(|at| at.1 - y).filter(|off| off.is_finite()) }
    }

    /// The row between two that has the point in itself: the middle and the false position by turns. A row that has no image of the
    /// point counts as on the other side. `None` when both are on one side, or there is a leap between the sides.
    fn own_row(&self, p_world: DVec3, first: Row, second: Row) -> Option<f64> {
        let (mut near, mut far) = if first.off.is_some() { (first, second) } else { (second, first) };
        let side = near.off?;
        // Rounding may put a row at the end of the stretch on either side.
        if let Some(end) = [near, far].into_iter().find(|end| end.off.is_some_and(|off| off.abs() <= ROW_TOLERANCE)) {
            return Some(end.y);
        }
        if far.off.is_some_and(|off| off * side > 0.0) {
            return None;
        }
        for step in 0..ROW_STEPS {
            let off = near.off?;
            if off.abs() <= ROW_TOLERANCE {
                return Some(near.y);
            }
            let middle = match far.off {
                Some(far_off) if step % 2 == 1 => near.y + (far.y - near.y) * off / (off - far_off),
                _ => 0.5 * (near.y + far.y),
            };
            let next = self.row(p_world, middle);
            match next.off {
                None => far = next,
                Some(next_off) if next_off * off > 0.0 => near = next,
                Some(_) => (near, far) = (next, near),
            }
        }
        None
    }

    /// Width of the cone that the pixel around the image point (x, y) sees, radians: the square root of its solid angle. Zero where
    /// the picture shows nothing.
    pub fn pixel_angle(&self, x: f64, y: f64) -> f32 {
        let ray = |x, y| self.camera.projection.ray(x, y).map(DVec3::normalize);
        let across = |dx: f64, dy: f64| Some(ray(x + dx, y + dy)? - ray(x - dx, y - dy)?);
        let area = across(0.5, 0.0).zip(across(0.0, 0.5)).map_or(0.0, |(a, b)| a.cross(b).length());
        area.sqrt() as f32
    }

    fn row_time_s(&self, y: f64) -> f64 {
        self.camera.shutter.as_ref().map_or(0.0, |shutter| shutter.row_time_s(y, f64::from(self.camera.size()[1])))
    }
}

/// The one of `count` bands of rows that the row at image coordinate `y` belongs to: beyond a border that of the border. `first_row` gives the
/// first row of each.
pub fn band_of_row(count: usize, first_row: impl Fn(usize) -> u32, y: f64) -> usize {
    (1..count).rev().find(|&band| f64::from(first_row(band)) <= y).unwrap_or(0)
}

/// A row of the image, and the image of a point at its moment.
#[derive(Clone, Copy)]
struct Row {
    /// Image coordinate.
    y: f64,
    /// How far below the row it has the point, pixels; `None` when it has no image of it.
    off: Option<f64>,
}

impl Motion {
    /// Straight and evenly turning from one pose to the next.
    fn between(from: &Pose, to: &Pose, frame_time_s: f64) -> Self {
        let time_s = frame_time_s * (f64::from(to.frame) - f64::from(from.frame)).max(1.0);
        let turn = DQuat::from_mat3(&(from.world_from_camera.transpose() * to.world_from_camera)).normalize();
        // The short way around.
        let turn = if turn.w < 0.0 { -turn } else { turn };
        Self { velocity: (to.position - from.position) / time_s, turning: turn.to_scaled_axis() / time_s }
    }
}

/// A point of a disk across a direction: upright, which has a meaning everywhere but straight up and down.
fn across(direction: DVec3, point: DVec2) -> DVec3 {
    let right = direction.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X);
    let up = right.cross(direction).normalize();
    right * point.x + up * point.y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Intrinsics, Shutter, ThinLens};

    fn pose(frame: u32, x: f64, angle: f64) -> Pose {
        let position = DVec3::new(x, 0.0, 1.0);
        Pose::look_at(frame, position, position + DVec3::new(angle.sin(), angle.cos(), 0.0), DVec3::Z).unwrap()
    }

    fn camera(shutter: Option<Shutter>, lens: Option<ThinLens>) -> Camera {
        Camera { lens, shutter, ..Intrinsics::from_fov_x(64, 48, 1.0).into() }
    }

    const SHUTTER: Shutter = Shutter { exposure_s: 0.25, readout_s: 0.5, frame_time_s: 0.5 };

    #[test]
    fn halfway_between_two_poses_is_the_pose_between() {
        let camera = camera(Some(SHUTTER), None);
        let poses = [pose(3, 0.0, 0.0), pose(4, 1.0, 0.4), pose(5, 3.0, 0.2)];
        let view = CameraView::of_frame(&camera, &poses, 1);
        for (time_s, expected) in
            [(-0.5, poses[0]), (-0.25, pose(0, 0.5, 0.2)), (0.0, poses[1]), (0.25, pose(0, 2.0, 0.3)), (0.5, poses[2])]
        {
            let (position, turned) = view.placement(time_s);
            assert!(position.distance(expected.position) < 1e-14);
            assert!((turned - expected.world_from_camera).to_cols_array().iter().all(|v| v.abs() < 1e-14), "at {time_s}");
        }
        // Beyond the ends the motion continues.
        let first = CameraView::of_frame(&camera, &poses, 0).placement(-0.25);
        assert!(first.0.distance(DVec3::new(-0.5, 0.0, 1.0)) < 1e-14);
        let last = CameraView::of_frame(&camera, &poses, 2).placement(0.25);
        assert!(last.0.distance(DVec3::new(4.0, 0.0, 1.0)) < 1e-14);
        assert_eq!(CameraView::of_frame(&camera, &poses[..1], 0).placement(0.2).0, poses[0].position);
    }

    #[test]
    fn a_lens_without_an_image_plane_stands_upright_all_around() {
        let point = DVec2::new(0.3, 0.8);
        assert!(across(DVec3::NEG_Z, point).distance(point.extend(0.0)) < 1e-15, "as that of a pinhole");
        let direction_at = |angle: f64| DVec3::new(angle.sin(), 0.4, -angle.cos());
        for k in 0..64 {
            let angle = f64::from(k) * 0.1;
            let direction = direction_at(angle);
            let (up, next) = (across(direction, DVec2::Y), across(direction_at(angle + 1e-6), DVec2::Y));
            assert!(up.y > 0.9 && up.dot(direction).abs() < 1e-12 && up.distance(next) < 1e-5, "{direction}");
        }
        assert_eq!(across(DVec3::Y, DVec2::X), DVec3::X);
    }

    #[test]
    fn rows_are_exposed_one_after_the_other() {
        let camera = camera(Some(SHUTTER), None);
        let poses = [pose(0, 0.0, 0.0), pose(1, 1.0, 0.0)];
        let view = CameraView::of_frame(&camera, &poses, 0);
        let x = |y: f64| view.centre_ray(32.0, y).unwrap().origin.x;
        assert!((x(0.0) + 0.5).abs() < 1e-14 && (x(24.0)).abs() < 1e-14 && (x(48.0) - 0.5).abs() < 1e-14);
        let exposed = |time: f32| view.ray(32.0, 24.0, [0.5, 0.5], time).unwrap().origin.x;
        assert!((exposed(0.0) + 0.25).abs() < 1e-14 && (exposed(0.5)).abs() < 1e-14);
        // A point that a row sees projects back to that row.
        let seen = view.centre_ray(10.0, 40.0).unwrap();
        let (px, py) = view.project_in_row(seen.origin + seen.direction * 3.0, 40.0).unwrap();
        assert!((px - 10.0).abs() < 1e-9 && (py - 40.0).abs() < 1e-9);
    }

    #[test]
    fn a_point_that_moves_is_shown_by_the_band_whose_rows_have_it_when_they_are_exposed() {
        let camera = camera(Some(SHUTTER), None);
        let pose = pose(0, 0.0, 0.0);
        let view = CameraView::still(&camera, &pose);
        let first_rows = [0, 16, 32];
        let at = |y: f64| {
            let ray = view.centre_ray(30.0, y).unwrap();
            ray.origin + 3.0 * ray.direction
        };
        // By band: the row that would show the point.
        for (rows, band) in [
            ([20.0, 20.0, 20.0], 1),
            ([4.0, 12.0, 20.0], 0),
            ([60.0, 50.0, 40.0], 2),
            ([-9.0, -9.0, -9.0], 0),
            // Neither the first nor the second shows it.
            ([17.0, 15.0, 13.0], 0),
            ([40.0, 33.0, 31.0], 1),
        ] {
            assert_eq!(view.band_that_shows(3, |band| first_rows[band], |band| at(rows[band])), band, "{rows:?}");
        }
        assert_eq!(view.band_that_shows(1, |_| 0, |_| at(7.0)), 0);
        assert_eq!([-1.0, 15.9, 16.0, 47.0].map(|y| band_of_row(3, |band| first_rows[band], y)), [0, 0, 1, 2]);
        // The whole exposure is from the first moment of the upper border to the last of the lower one.
        let shares = [(0.0, 0.0), (24.0, 0.5), (48.0, 1.0)].map(|(y, time)| view.exposure_share(y, time));
        assert!(shares.iter().zip([0.0, 0.5, 1.0]).all(|(found, expected): (&f32, f32)| (found - expected).abs() < 1e-6), "{shares:?}");
    }

    /// A quick turn about the camera's x axis, or its y axis, and the frame in the middle of it.
    fn turning(about_x: bool, rad_per_frame: f64) -> [Pose; 3] {
        [0u32, 1, 2].map(|frame| {
            let (sin, cos) = (rad_per_frame * (f64::from(frame) - 1.0)).sin_cos();
            let position = DVec3::new(0.0, 0.0, 0.1 * f64::from(frame));
            let ahead = if about_x { DVec3::new(0.0, cos, sin) } else { DVec3::new(sin, cos, 0.0) };
            Pose::look_at(frame, position, position + ahead, DVec3::Z).unwrap()
        })
    }

    #[test]
    fn what_any_row_sees_projects_back_to_it_however_fast_the_camera_turns() {
        let camera = camera(Some(SHUTTER), None);
        // As fast as this a point moves half the image during the readout, or more than all of it, against the rows or with them.
        for rad_per_frame in [-1.0, -0.5, 0.01, 0.5, 1.0] {
            let poses = turning(true, rad_per_frame);
            let view = CameraView::of_frame(&camera, &poses, 1);
            for (x, y) in (0..=48).map(|i| (f64::from(i) + 3.25, f64::from(i))) {
                let seen = view.centre_ray(x, y).unwrap();
                let (px, py) = view.project(seen.origin + seen.direction * 3.0).unwrap();
                assert!((px - x).abs() < 1e-4 && (py - y).abs() < 1e-4, "at {rad_per_frame}: ({x}, {y}) became ({px}, {py})");
            }
        }
    }

    #[test]
    fn a_point_that_is_behind_the_camera_for_some_rows_is_where_the_others_see_it() {
        let camera = camera(Some(SHUTTER), None);
        let poses = turning(false, 2.5);
        let view = CameraView::of_frame(&camera, &poses, 1);
        for y in [8.0, 40.0] {
            let seen = view.centre_ray(32.0, y).unwrap();
            let p = seen.origin + seen.direction * 3.0;
            assert_eq!(view.project_in_row(p, 48.0 - 1.2 * y), None);
            let (px, py) = view.project(p).unwrap();
            assert!((px - 32.0).abs() < 1e-4 && (py - y).abs() < 1e-4, "row {y} became ({px}, {py})");
        }
    }

    #[test]
    fn what_no_row_sees_lies_beyond_the_border_and_what_is_behind_has_no_image() {
        let camera = camera(Some(SHUTTER), None);
        for rad_per_frame in [-0.5, 0.5] {
            let poses = turning(true, rad_per_frame);
            let view = CameraView::of_frame(&camera, &poses, 1);
            for beyond in [-9.0, 57.0] {
                let (origin, world_from_camera) = view.row_placement(beyond);
                let p = origin + world_from_camera * camera.projection.ray(20.0, beyond).unwrap();
                let (_, y) = view.project(p).unwrap();
                assert!(if beyond < 0.0 { y < 0.0 } else { y > 48.0 }, "{beyond} became {y}");
            }
            assert_eq!(view.project(DVec3::new(0.0, -9.0, 0.0)), None);
        }
    }

    #[test]
    fn without_a_readout_a_point_has_the_image_that_every_row_has() {
        let p = DVec3::new(0.3, 2.0, 1.2);
        for shutter in [None, Some(Shutter { readout_s: 0.0, ..SHUTTER })] {
            let camera = camera(shutter, None);
            let poses = turning(true, 0.5);
            let view = CameraView::of_frame(&camera, &poses, 1);
            assert_eq!(view.project(p), view.project_in_row(p, 7.0));
        }
    }

    #[test]
    fn a_plain_pinhole_has_one_ray_per_image_point() {
        let camera = camera(None, None);
        let view = CameraView::still(&camera, &pose(0, 2.0, 0.3));
        assert_eq!(view.ray(12.25, 7.5, [0.1, 0.9], 0.7), view.centre_ray(12.25, 7.5));
    }

    #[test]
    fn lens_rays_of_every_model_meet_at_the_distance_of_focus() {
        let lens = ThinLens { aperture_radius_m: 0.05, focus_distance_m: 1.5, blades: 5, focus_tilt_rad: [0.0; 2] };
        for projection in crate::camera::projection::tests::models() {
            let has_plane = projection.has_image_plane();
            let camera = Camera { projection, lens: Some(lens), shutter: None };
            let view = CameraView::still(&camera, &pose(0, 0.0, 0.0));
            let centre = view.centre_ray(20.0, 30.0).unwrap();
            let along = if has_plane { 1.5 / centre.direction.dot(DVec3::Y) } else { 1.5 };
            let focus = centre.origin + centre.direction * along;
            for u in [[0.1, 0.2], [0.9, 0.3], [0.5, 0.999]] {
                let ray = view.ray(20.0, 30.0, u, 0.0).unwrap();
                assert!((focus - ray.origin).cross(ray.direction).length() < 1e-12);
                assert!(ray.origin.distance(centre.origin) <= 0.05 + 1e-9);
            }
        }
    }

    #[test]
    fn pixel_angles_add_up_to_the_solid_angle() {
        let panorama: Camera = crate::Projection::Equirectangular { width: 64, height: 32 }.into();
        let view = CameraView::still(&panorama, &pose(0, 0.0, 0.0));
        let sum: f64 = (0..64 * 32).map(|i| f64::from(view.pixel_angle(f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5)).powi(2)).sum();
        assert!((sum / (4.0 * std::f64::consts::PI) - 1.0).abs() < 2e-3, "{sum}");
    }
}
