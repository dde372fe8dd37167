//! The view from a pose: one ray per pixel of a small image.

use crate::palette::{id_color, viridis};
use crate::picture::{Picture, from_pixels};
use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Ray, Rng};
use enfilade_scene::{CameraView, PartId, WorldMesh};
use std::collections::HashSet;

/// Width of the pictures, the toolkit's. Their height follows the camera's aspect.
const WIDTH: u32 = 256;

/// The surface that one pixel sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// Index into the triangles of the world.
    pub triangle: u32,
    /// The part that it belongs to.
    pub part: PartId,
    /// Metres along the ray.
    pub distance_m: f64,
    /// The point seen.
    pub p_world: DVec3,
    /// Cosine between the ray and the surface's normal, positive: both sides of a surface are seen.
    pub cosine: f64,
}

/// The surfaces that all pixels see, row by row; `None` in the void.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sight {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<Option<Seen>>,
}

/// Looks through the middle of every pixel.
pub(super) fn look(world: &WorldMesh, bvh: &Bvh, view: &CameraView<'_>) -> Sight {
    let size = view.camera().size();
    let height =
        ((u64::from(WIDTH) * u64::from(size[1]) + u64::from(size[0]) / 2) / u64::from(size[0])).clamp(1, 4 * u64::from(WIDTH)) as u32;
    let step = [f64::from(size[0]) / f64::from(WIDTH), f64::from(size[1]) / f64::from(height)];
    let pixel = |i: u32| {
        let ray = view.centre_ray((f64::from(i % WIDTH) + 0.5) * step[0], (f64::from(i / WIDTH) + 0.5) * step[1])?;
        meet(world, bvh, ray.origin, ray.direction)
    };
    Sight { width: WIDTH, height, pixels: (0..WIDTH * height).map(pixel).collect() }
}

/// The first surface from `origin` along the unit vector `direction`.
pub(super) fn meet(world: &WorldMesh, bvh: &Bvh, origin: DVec3, direction: DVec3) -> Option<Seen> {
    let hit = bvh.closest(&Ray::new(origin.as_vec3(), direction.as_vec3()))?;
    let [a, b, c] = world.corners[hit.triangle as usize].map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let distance_m = f64::from(hit.t);
    let part = world.sources[hit.triangle as usize].part;
    Some(Seen { triangle: hit.triangle, part, distance_m, p_world: origin + distance_m * direction, cosine: normal.dot(direction).abs() })
}

impl Sight {
    /// Share of the pixels that see no surface.
    pub fn void_share(&self) -> f64 {
        self.pixels.iter().filter(|seen| seen.is_none()).count() as f64 / self.pixels.len() as f64
    }

    /// Distinct triangles and distinct parts.
    pub fn distinct(&self) -> (usize, usize) {
        let triangles: HashSet<u32> = self.pixels.iter().flatten().map(|seen| seen.triangle).collect();
        let parts: HashSet<PartId> = self.pixels.iter().flatten().map(|seen| seen.part).collect();
        (triangles.len(), parts.len())
    }

    /// Share of the surface points seen here that `view`, whose sight is `other`, sees too. `None` when there are none.
    pub fn share_seen_by(&self, view: &CameraView<'_>, other: &Self) -> Option<f64> {
        let [width, height] = view.camera().size().map(f64::from);
        let shared = |seen: &Seen| {
            let (x, y) = view.project(seen.p_world)?;
            let (column, row) = ((x / width * f64::from(other.width)).floor(), (y / height * f64::from(other.height)).floor());
            let inside = column >= 0.0 && row >= 0.0 && column < f64::from(other.width) && row < f64::from(other.height);
            let there = other.pixels[if inside { row as usize * other.width as usize + column as usize } else { return None }]?;
            let distance_m = seen.p_world.distance(view.pose().position);
            // A pixel away a surface seen at a slant is nearer or farther: this much is taken for the same surface.
            ((there.distance_m - distance_m).abs() <= 0.03 * distance_m + 0.02).then_some(())
        };
        let (mut points, mut both) = (0u32, 0u32);
        for seen in self.pixels.iter().flatten().step_by(7) {
            points += 1;
            both += u32::from(shared(seen).is_some());
        }
        (points > 0).then(|| f64::from(both) / f64::from(points))
    }

    /// Parts in the toolkit's colours: a random order of all parts, the same in every view, through viridis. The void is black.
    pub fn in_toolkit_colors(&self, colors: &[[u8; 3]]) -> Picture {
        self.colored(|seen| colors[seen.part as usize])
    }

    /// Parts in colours that distinguish neighbours, lit from the camera. The void is dark.
    pub fn lit(&self) -> Picture {
        self.colored(|seen| {
            // Ids repeat only after a number so large that colours are distinguished by place rather than by hue.
            let color = id_color((seen.part % 30_000 + 1) as i16);
            // Paler than for a layer of ids: large walls would glare.
            color.map(|v| ((0.72 * f64::from(v) + 62.0) * (0.3 + 0.7 * seen.cosine)).round() as u8)
        })
    }

    fn colored(&self, color: impl Fn(&Seen) -> [u8; 3]) -> Picture {
        from_pixels(self.width, self.height, |i| {
            let [r, g, b] = self.pixels[i].as_ref().map_or([0, 0, 0], &color);
            [r, g, b, 255]
        })
    }
}

/// The toolkit's colour of each of `parts` parts: a random order (its own, so not the toolkit's very colours) through viridis.
pub(super) fn toolkit_colors(parts: usize) -> Vec<[u8; 3]> {
    let mut order: Vec<usize> = (0..parts).collect();
    Rng::new(0).shuffle(&mut order);
    order.into_iter().map(|place| viridis(place as f64 / parts.saturating_sub(1).max(1) as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{Camera, Intrinsics, Pose};
    use enfilade_testroom::box_room;

    const FOV_X_RAD: f64 = 1.0;

    fn sight(from: DVec3, to: DVec3) -> (Camera, Pose, Sight) {
        let room = box_room(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        let bvh = Bvh::new(&room.corners, &|_| false);
        let camera: Camera = Intrinsics::from_fov_x(640, 480, FOV_X_RAD).into();
        let pose = Pose::look_at(0, from, to, DVec3::Z).unwrap();
        let sight = look(&room, &bvh, &CameraView::still(&camera, &pose));
        (camera, pose, sight)
    }

    #[test]
    fn a_view_at_a_wall_knows_its_distance_and_slant() {
        let (_, _, sight) = sight(DVec3::new(2.0, 1.5, 1.25), DVec3::new(4.0, 1.5, 1.25));
        assert_eq!((sight.width, sight.height, sight.void_share(), sight.distinct()), (256, 192, 0.0, (2, 1)));
        for seen in sight.pixels.iter().flatten() {
            assert!((seen.p_world.x - 4.0).abs() < 1e-5 && (seen.distance_m * seen.cosine - 2.0).abs() < 1e-5);
        }
    }

    #[test]
    fn overlap_is_whole_with_itself_half_with_half_a_turn_of_the_image_and_none_behind() {
        let center = DVec3::new(2.0, 1.5, 1.25);
        let (camera, pose, ahead) = sight(center, DVec3::new(4.0, 1.5, 1.25));
        let view = CameraView::still(&camera, &pose);
        assert_eq!(ahead.share_seen_by(&view, &ahead), Some(1.0));
        let half: f64 = 0.5 * FOV_X_RAD;
        let (_, _, turned) = sight(center, center + DVec3::new(half.cos(), half.sin(), 0.0));
        let share = turned.share_seen_by(&view, &ahead).unwrap();
        assert!((share - 0.5).abs() < 0.05, "{share}");
        let (_, _, behind) = sight(center, DVec3::new(0.0, 1.5, 1.25));
        assert_eq!(behind.share_seen_by(&view, &ahead), Some(0.0));
    }

    #[test]
    fn toolkit_colors_are_all_of_viridis_in_another_order() {
        let colors = toolkit_colors(50);
        let mut sorted: Vec<_> = (0..50).map(|i| viridis(f64::from(i) / 49.0)).collect();
        assert_ne!(colors, sorted);
        let mut same = colors.clone();
        same.sort_unstable();
        sorted.sort_unstable();
        assert_eq!(same, sorted);
        assert_eq!((toolkit_colors(0).len(), toolkit_colors(1)), (0, vec![viridis(0.0)]));
    }
}
