//! Looking at a view by a small test image: which triangles it shows, and the numbers that come of it.

use crate::{Saliency, ViewStats};
use enfilade_geometry::{Bvh, NOTHING, PinholeRays, VisibilityBuffer};
use enfilade_math::DVec3;
use enfilade_scene::{Intrinsics, PartId, Pose, WorldMesh};

/// A part counts as seen when it covers at least one pixel of this many.
const PIXELS_PER_PART: u32 = 2000;

/// Looks through the centre of every pixel and counts what is seen.
pub fn view_stats(world: &WorldMesh, bvh: &Bvh, intrinsics: &Intrinsics, pose: &Pose) -> ViewStats {
    let image = TestImage::new(intrinsics);
    let mut sight = image.sight(world);
    sight.look(bvh, &image, pose);
    sight.stats(world, true)
}

/// A small pinhole image.
pub(crate) struct TestImage {
    intrinsics: Intrinsics,
}

impl TestImage {
    pub(crate) fn new(intrinsics: &Intrinsics) -> Self {
        Self { intrinsics: *intrinsics }
    }

    /// Unit directions in camera space, the one nearest to the optical axis first; of several at one distance the last in reading order.
    pub(crate) fn center_first(&self) -> Vec<DVec3> {
        let k = &self.intrinsics;
        let direction = |x: u32, y: u32| k.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).normalize();
        let mut sorted: Vec<DVec3> = (0..k.height).flat_map(|y| (0..k.width).map(move |x| direction(x, y))).collect();
        sorted.reverse();
        // Rounding must not decide the order of the four pixels around the centre.
        sorted.sort_by_key(|d| (d.z * 1e9).round() as i64);
        sorted
    }

    /// Rays of the image in the world.
    pub(crate) fn rays(&self, pose: &Pose) -> PinholeRays {
        let ray = |x: f64, y: f64| pose.world_from_camera * self.intrinsics.ray(x + 0.5, y + 0.5);
        let corner = ray(0.0, 0.0);
        let step = |other: DVec3| (other - corner).as_vec3();
        PinholeRays { origin: pose.position.as_vec3(), corner: corner.as_vec3(), right: step(ray(1.0, 0.0)), down: step(ray(0.0, 1.0)) }
    }

    /// A buffer and counters for looking at one view after the other.
    pub(crate) fn sight(&self, world: &WorldMesh) -> Sight {
        Sight {
            buffer: VisibilityBuffer::new(self.intrinsics.width, self.intrinsics.height),
            seen: SeenSet::new(world.corners.len()),
            areas: vec![0; world.contrasts.len()],
            parts: Vec::new(),
        }
    }
}

/// A test image as it was last seen, and room to count in.
pub(crate) struct Sight {
    pub(crate) buffer: VisibilityBuffer,
    seen: SeenSet,
    /// Pixels of every part; zero between calls.
    areas: Vec<u32>,
    /// Parts with pixels.
    parts: Vec<PartId>,
}

impl Sight {
    pub(crate) fn look(&mut self, bvh: &Bvh, image: &TestImage, pose: &Pose) {
        self.buffer.draw(bvh, &image.rays(pose));
    }

    /// The measurements of a view that its score needs.
    pub(crate) fn judge(&mut self, world: &WorldMesh, saliency: &Saliency) -> ViewStats {
        self.stats(world, saliency.asks_for_parts())
    }

    /// Counts what the buffer shows; parts only when asked to.
    fn stats(&mut self, world: &WorldMesh, parts: bool) -> ViewStats {
        self.seen.clear();
        let pixels = self.buffer.triangles();
        let (mut hits, mut last) = (0, NOTHING);
        for &triangle in pixels {
            hits += u32::from(triangle != NOTHING);
            if triangle != last && triangle != NOTHING {
                self.seen.insert(triangle);
            }
            last = triangle;
        }
        let stats = ViewStats { pixels: pixels.len() as u32, hits, triangles: self.seen.len, ..ViewStats::default() };
        if parts && hits > 0 { self.with_parts(world, stats) } else { stats }
    }

    fn with_parts(&mut self, world: &WorldMesh, stats: ViewStats) -> ViewStats {
        for &triangle in self.buffer.triangles().iter().filter(|t| **t != NOTHING) {
            let part = world.sources[triangle as usize].part;
            let area = &mut self.areas[part as usize];
            if *area == 0 {
                self.parts.push(part);
            }
            *area += 1;
        }
        let (mut count, mut entropy, mut contrast) = (0, 0.0, 0.0);
        for part in self.parts.drain(..) {
            let area = std::mem::take(&mut self.areas[part as usize]);
            let share = f64::from(area) / f64::from(stats.hits);
            count += u32::from(area * PIXELS_PER_PART >= stats.pixels);
            entropy -= share * share.ln();
            contrast += share * f64::from(world.contrasts[part as usize]);
        }
        ViewStats { parts: count, perplexity: entropy.exp(), contrast, ..stats }
    }
}

/// A set of triangles: one bit for each.
struct SeenSet {
    words: Vec<u64>,
    len: u32,
}

impl SeenSet {
    fn new(triangles: usize) -> Self {
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
    use crate::testroom::{Room, cuboid};
    use enfilade_scene::TriangleSource;

    fn look(room: &Room, from: DVec3, at: DVec3, fov_x_rad: f64) -> ViewStats {
        let pose = Pose::look_at(0, from, at, DVec3::Z).unwrap();
        view_stats(&room.world, &room.bvh, &Intrinsics::from_fov_x(64, 48, fov_x_rad), &pose)
    }

    #[test]
    fn a_view_at_a_wall_shows_its_two_triangles_and_no_void() {
        let room = Room::new(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5));
        let stats = look(&room, DVec3::new(2.0, 1.5, 1.25), DVec3::new(4.0, 1.5, 1.25), 0.5);
        let wall = ViewStats { pixels: 64 * 48, hits: 64 * 48, triangles: 2, parts: 1, perplexity: 1.0, contrast: 0.0 };
        assert_eq!(stats, wall);
        let outside = look(&room, DVec3::new(-1.0, 1.5, 1.25), DVec3::new(-4.0, 1.5, 1.25), 0.5);
        assert_eq!((outside.hits, outside.triangles, outside.void_share()), (0, 0, 1.0));
        assert_eq!((outside.parts, outside.perplexity), (0, 0.0));
    }

    #[test]
    fn perplexity_counts_parts_of_equal_area_and_not_their_triangles() {
        // Two boards side by side fill the view; one of them is cut into many triangles.
        let board = |y: f64| cuboid(DVec3::new(2.0, y, -1.0), DVec3::new(2.1, y + 1.5, 1.0), false);
        let halves = |triangles: Vec<[enfilade_math::Vec3; 3]>| -> Vec<_> {
            triangles.into_iter().flat_map(|[a, b, c]| [[(b + c) / 2.0, a, b], [(b + c) / 2.0, c, a]]).collect()
        };
        let fine = (0..6).fold(board(-1.5), |triangles, _| halves(triangles));
        let split = fine.len();
        let mut room = Room::from_corners([fine, board(0.0)].concat());
        room.world.contrasts = vec![0.5, 0.0];
        for (i, source) in room.world.sources.iter_mut().enumerate() {
            *source = TriangleSource { part: u32::from(i >= split), triangle: 0 };
        }
        let stats = look(&room, DVec3::ZERO, DVec3::X, 1.0);
        assert_eq!((stats.parts, stats.hits), (2, stats.pixels));
        assert!((stats.perplexity - 2.0).abs() < 1e-12 && (stats.contrast - 0.25).abs() < 1e-12, "{stats:?}");
        assert!(stats.triangles > 20);
    }
}
