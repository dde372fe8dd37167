use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Ray};
use enfilade_scene::{Intrinsics, Pose};

/// What a test image of a view shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewStats {
    /// Pixels of the test image.
    pub pixels: u32,
    /// Pixels that show a surface.
    pub hits: u32,
    /// Distinct triangles seen.
    pub triangles: u32,
}

impl ViewStats {
    /// Share of the pixels that show no surface.
    pub fn void_share(&self) -> f64 {
        1.0 - f64::from(self.hits) / f64::from(self.pixels)
    }
}

/// Casts one ray through the centre of every pixel and counts what it meets.
///
/// `triangles` is the number of triangles in the hierarchy. Allocates one bit for each.
pub fn view_stats(bvh: &Bvh, triangles: usize, intrinsics: &Intrinsics, pose: &Pose) -> ViewStats {
    TestImage::new(intrinsics).look(bvh, pose, &mut SeenSet::new(triangles))
}

/// The rays of a small image, prepared once for many views.
pub(crate) struct TestImage {
    /// Unit directions in camera space, row by row.
    directions: Vec<DVec3>,
}

impl TestImage {
    pub(crate) fn new(intrinsics: &Intrinsics) -> Self {
        let direction = |x: u32, y: u32| intrinsics.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).normalize();
        Self { directions: (0..intrinsics.height).flat_map(|y| (0..intrinsics.width).map(move |x| direction(x, y))).collect() }
    }

    /// Directions in camera space, the one nearest to the optical axis first.
    pub(crate) fn center_first(&self) -> Vec<DVec3> {
        let mut sorted = self.directions.clone();
        sorted.sort_by(|a, b| a.z.total_cmp(&b.z));
        sorted
    }

    /// `seen` is emptied first.
    pub(crate) fn look(&self, bvh: &Bvh, pose: &Pose, seen: &mut SeenSet) -> ViewStats {
        seen.clear();
        let (origin, rotation) = (pose.position.as_vec3(), pose.world_from_camera);
        let mut hits = 0;
        for direction in &self.directions {
            if let Some(hit) = bvh.closest(&Ray::new(origin, (rotation * *direction).as_vec3())) {
                hits += 1;
                seen.insert(hit.triangle);
            }
        }
        ViewStats { pixels: self.directions.len() as u32, hits, triangles: seen.len }
    }
}

/// A set of triangles: one bit for each.
pub(crate) struct SeenSet {
    words: Vec<u64>,
    len: u32,
}

impl SeenSet {
    pub(crate) fn new(triangles: usize) -> Self {
        Self { words: vec![0; triangles.div_ceil(64)], len: 0 }
    }

    fn clear(&mut self) {
        self.words.fill(0);
        self.len = 0;
    }

    #[inline]
    fn insert(&mut self, triangle: u32) {
        let word = &mut self.words[triangle as usize / 64];
        let bit = 1 << (triangle % 64);
        self.len += u32::from(*word & bit == 0);
        *word |= bit;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testroom::Room;

    #[test]
    fn a_view_at_a_wall_shows_its_two_triangles_and_no_void() {
        let room = Room::new(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        let intrinsics = Intrinsics::from_fov_x(64, 48, 0.5);
        let pose = Pose::look_at(0, DVec3::new(2.0, 1.5, 1.25), DVec3::new(4.0, 1.5, 1.25), DVec3::Z).unwrap();
        let stats = view_stats(&room.bvh, room.world.corners.len(), &intrinsics, &pose);
        assert_eq!(stats, ViewStats { pixels: 64 * 48, hits: 64 * 48, triangles: 2 });
        let outside = Pose::look_at(0, DVec3::new(-1.0, 1.5, 1.25), DVec3::new(-4.0, 1.5, 1.25), DVec3::Z).unwrap();
        let stats = view_stats(&room.bvh, room.world.corners.len(), &intrinsics, &outside);
        assert_eq!((stats.hits, stats.triangles, stats.void_share()), (0, 0, 1.0));
    }
}
