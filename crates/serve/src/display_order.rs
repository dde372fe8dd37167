//! The faces of a scene as one buffer for the 3D view of pages (`web/shared/stage3d`), the important ones first.
//!
//! A header of 64 bytes: `ENFGEOM1`, number of faces F and of pieces P (u32), the lower and upper corner of the scene's bounds (f32 × 3 each),
//! number of levels L (u32), zeros. Then the L ends of the levels (u32), filled with zeros to a multiple of 16 bytes. Then, in the order
//! of display: F × 3 corners of 4 × u16 (x, y and z as shares of the scene's extent in 65535ths, and 0), F face numbers (u32), F piece
//! numbers (u32). All little-endian. For a first view of the scene over a slow connection, the first levels alone have the same format.
//!
//! Drawing the faces up to the end of a level is a decimation of the scene like that of Hypersim's tool: a random choice in which a face
//! is left out with weight 2^(−area / half-life). Here the half-life is the median area, so it fits scenes of any unit.

use enfilade_math::{Bounds3, Rng, Vec3};
use rayon::prelude::*;

/// The coarsest level has about this many faces: any machine can draw them.
const MIN_LEVEL_FACES: usize = 16_384;
/// Size of the header.
const HEADER_BYTES: usize = 64;
/// Size of a face's corners.
const CORNER_BYTES: usize = 24;

/// The order in which faces are shown, made once per scene.
pub struct DisplayOrder {
    bounds: Bounds3,
    /// Face numbers.
    faces: Vec<u32>,
    level_ends: Vec<u32>,
    /// Encoded, face by face.
    corners: Vec<u8>,
}

impl DisplayOrder {
    /// Sorts the faces of a scene by importance into levels, and within a level by place.
    pub fn new(corners: &[[Vec3; 3]]) -> Self {
        let bounds = Bounds3::from_points(corners.iter().flatten().copied());
        let bounds = if bounds.is_empty() { Bounds3 { min: Vec3::ZERO, max: Vec3::ZERO } } else { bounds };
        let mut faces = by_importance(corners);
        let level_ends = level_ends(faces.len());
        let mut first = 0;
        for &end in &level_ends {
            faces[first..end as usize].par_sort_by_cached_key(|&face| morton(&corners[face as usize], &bounds));
            first = end as usize;
        }
        let mut order = Self { bounds, faces, level_ends, corners: Vec::new() };
        order.corners = order.encode_corners(corners);
        order
    }

    /// The smallest box around the scene.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// The bytes, with the current piece of every face: of all levels, or of those that end at or before `most` faces, at least one.
    pub fn encode(&self, piece_of_face: &[u32], pieces: usize, most: Option<usize>) -> Vec<u8> {
        let whole = |end: &&u32| most.is_none_or(|most| **end as usize <= most);
        let levels = self.level_ends.iter().take_while(whole).count().max(1);
        let ends = &self.level_ends[..levels];
        let faces = &self.faces[..ends[levels - 1] as usize];
        let padded = (4 * levels).next_multiple_of(16);
        let mut bytes = Vec::with_capacity(HEADER_BYTES + padded + (CORNER_BYTES + 8) * faces.len());
        bytes.extend_from_slice(b"ENFGEOM1");
        bytes.extend_from_slice(&(faces.len() as u32).to_le_bytes());
        bytes.extend_from_slice(&(pieces as u32).to_le_bytes());
        let limits = self.bounds.min.to_array().into_iter().chain(self.bounds.max.to_array());
        limits.for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
        bytes.extend_from_slice(&(levels as u32).to_le_bytes());
        bytes.resize(HEADER_BYTES, 0);
        ends.iter().for_each(|end| bytes.extend_from_slice(&end.to_le_bytes()));
        bytes.resize(HEADER_BYTES + padded, 0);
        bytes.extend_from_slice(&self.corners[..CORNER_BYTES * faces.len()]);
        faces.iter().for_each(|face| bytes.extend_from_slice(&face.to_le_bytes()));
        faces.iter().for_each(|&face| bytes.extend_from_slice(&piece_of_face[face as usize].to_le_bytes()));
        bytes
    }

    /// The corners of all faces, which do not change when faces move to other pieces.
    fn encode_corners(&self, corners: &[[Vec3; 3]]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(CORNER_BYTES * self.faces.len());
        let scale = 65535.0 / self.bounds.extent().max(Vec3::splat(f32::MIN_POSITIVE));
        for corner in self.faces.iter().flat_map(|&face| &corners[face as usize]) {
            let q = ((*corner - self.bounds.min) * scale).round().clamp(Vec3::ZERO, Vec3::splat(65535.0));
            [q.x as u16, q.y as u16, q.z as u16, 0].iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
        }
        bytes
    }
}

/// Area of a triangle, square metres.
pub fn area_m2([a, b, c]: &[Vec3; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
    0.5 * (b - a).cross(c - a).length()
}

/// Faces by falling importance.
///
/// The importance of a face is the time at which a random process with rate 2^(−area / half-life) removes it, which is exponentially
/// distributed (Efraimidis & Spirakis 2006). It is kept as a logarithm because the rates of large faces underflow.
fn by_importance(corners: &[[Vec3; 3]]) -> Vec<u32> {
    let areas: Vec<f64> = enfilade_parallel::map(corners, area_m2);
    let mut sorted = areas.clone();
    let half_life = match sorted.len() {
        0 => 1.0,
        n => sorted.select_nth_unstable_by(n / 2, f64::total_cmp).1.max(f64::MIN_POSITIVE),
    };
    let mut rng = Rng::new(0);
    let importance: Vec<f64> = areas.iter().map(|area| (-(1.0 - rng.next_f64()).ln()).log2() + area / half_life).collect();
    let mut faces: Vec<u32> = (0..corners.len() as u32).collect();
    faces.par_sort_by(|&a, &b| importance[b as usize].total_cmp(&importance[a as usize]).then(a.cmp(&b)));
    faces
}

/// Ends of levels, each about √2 times the one before.
fn level_ends(faces: usize) -> Vec<u32> {
    let mut ends = vec![faces as u32];
    let mut end = faces as f64;
    while end / std::f64::consts::SQRT_2 >= MIN_LEVEL_FACES as f64 {
        end /= std::f64::consts::SQRT_2;
        ends.push(end as u32);
    }
    ends.reverse();
    ends
}

/// Morton code of a face's centroid on a grid of 1024³: neighbours get similar codes.
fn morton(corners: &[Vec3; 3], bounds: &Bounds3) -> u32 {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let cell =
        ((middle - bounds.min) / bounds.extent().max(Vec3::splat(f32::MIN_POSITIVE)) * 1023.0).clamp(Vec3::ZERO, Vec3::splat(1023.0));
    let spread = |x: f32| (0..10).fold(0u32, |code, bit| code | ((x as u32 >> bit & 1) << (3 * bit)));
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_hold_every_face_once_and_large_ones_first() {
        let triangle = |x: f32, size: f32| [Vec3::new(x, 0.0, 0.0), Vec3::new(x + size, 0.0, 0.0), Vec3::new(x, size, 1.0)];
        let corners: Vec<_> = (0..100_000).map(|i| triangle(i as f32 * 0.01, if i % 1000 == 7 { 2.0 } else { 0.01 })).collect();
        let order = DisplayOrder::new(&corners);
        let pieces: Vec<u32> = (0..100_000).map(|face| face / 10).collect();
        let bytes = order.encode(&pieces, 10_000, None);
        let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!((&bytes[..8], u32_at(8), u32_at(12)), (&b"ENFGEOM1"[..], 100_000, 10_000));
        let levels = u32_at(40) as usize;
        let ends: Vec<u32> = (0..levels).map(|i| u32_at(HEADER_BYTES + 4 * i)).collect();
        assert_eq!((ends[levels - 1], ends[0] >= 16_384, ends.is_sorted()), (100_000, true, true));
        let start = HEADER_BYTES + (4 * levels).next_multiple_of(16);
        assert_eq!(bytes.len(), start + 32 * 100_000);
        let faces: Vec<u32> = (0..100_000).map(|i| u32_at(start + 24 * 100_000 + 4 * i)).collect();
        assert_eq!(faces[..ends[0] as usize].iter().filter(|face| *face % 1000 == 7).count(), 100);
        assert!((0..100_000).all(|i| u32_at(start + 28 * 100_000 + 4 * i) == faces[i] / 10));
        let mut all = faces.clone();
        all.sort_unstable();
        assert!(all.iter().enumerate().all(|(i, &face)| i as u32 == face));
        let u16_at = |at: usize| f32::from(u16::from_le_bytes(bytes[at..at + 2].try_into().unwrap()));
        let x = order.bounds().min.x + u16_at(start) / 65535.0 * order.bounds().extent().x;
        assert!((x - corners[faces[0] as usize][0].x).abs() < 0.01, "{x}");
        // The first levels alone are the beginning of each of the arrays.
        for (most, levels) in [(0, 1), (ends[1] as usize, 2), (usize::MAX, levels)] {
            let few = order.encode(&pieces, 10_000, Some(most));
            let (count, start) = (ends[levels - 1] as usize, HEADER_BYTES + (4 * levels).next_multiple_of(16));
            assert_eq!((few.len(), &few[8..12]), (start + 32 * count, &(count as u32).to_le_bytes()[..]));
            let all = HEADER_BYTES + (4 * ends.len()).next_multiple_of(16);
            assert!(few[start..start + 24 * count] == bytes[all..all + 24 * count]);
            assert!(few[start + 24 * count..start + 28 * count] == bytes[all + 24 * 100_000..all + 24 * 100_000 + 4 * count]);
        }
    }

    #[test]
    fn an_empty_scene_has_one_empty_level() {
        assert_eq!(DisplayOrder::new(&[]).encode(&[], 0, None).len(), HEADER_BYTES + 16);
    }
}
