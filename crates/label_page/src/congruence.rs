//! The motions that take one surface to another of the same shape, whatever the order of their faces, mirrored ones too.
//!
//! A surface is the set of its corners and the middles of its faces. The mean of the corners stays where it is under every motion; with it
//! two points determine a motion, and a mirrored one. The two points are those of the rarest distances, so that few pairs of the other
//! surface can be theirs.

use enfilade_math::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;

/// Points may be so far from where the motion takes them: the rounding of files, metres and as a share of the distance from the middle.
pub(super) const TOLERANCE_M: f64 = 1e-3;
pub(super) const TOLERANCE: f64 = 1e-4;
/// Points nearer to the middle than this share of the farthest determine no rotation well; so do those near to the line through the first.
const NEAR: f64 = 0.2;
/// Pairs of points that are tried, and motions that are returned: a wheel has one for each spoke, a smooth one any number.
const MAX_TRIED: usize = 4096;
const MAX_MOTIONS: usize = 64;

/// Edge of the cells that points are sorted into.
const CELL_M: f64 = 4.0 * TOLERANCE_M;

/// The points of a surface.
pub(super) struct Points {
    middle: DVec3,
    /// Each once: corners, and middles of faces.
    all: Vec<DVec3>,
    /// Numbers of the points in every cell.
    cells: HashMap<[i64; 3], Vec<u32>>,
    /// Largest distance from the middle.
    radius: f64,
}

impl Points {
    /// The points of a surface by the corners of its faces, three for each.
    pub(super) fn of(corners: &[DVec3]) -> Self {
        let middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
        let mut points = Self { middle, all: Vec::new(), cells: HashMap::new(), radius: 0.0 };
        corners.iter().for_each(|&corner| points.add(corner));
        corners.chunks_exact(3).for_each(|face| points.add(face.iter().sum::<DVec3>() / 3.0));
        points
    }

    fn add(&mut self, point: DVec3) {
        if !self.has_near(point, 0.1 * TOLERANCE_M) {
            self.radius = self.radius.max(point.distance(self.middle));
            self.cells.entry(cell(point)).or_default().push(self.all.len() as u32);
            self.all.push(point);
        }
    }

    /// Whether a point is within a distance of a place.
    fn has_near(&self, place: DVec3, distance: f64) -> bool {
        let ([x0, y0, z0], [x1, y1, z1]) = (cell(place - distance), cell(place + distance));
        let cells = (x0..=x1).flat_map(|x| (y0..=y1).flat_map(move |y| (z0..=z1).map(move |z| [x, y, z])));
        let is_near = |&i: &u32| self.all[i as usize].distance(place) <= distance;
        cells.filter_map(|cell| self.cells.get(&cell)).flatten().any(is_near)
    }

    fn tolerance(&self) -> f64 {
        TOLERANCE_M + TOLERANCE * self.radius
    }

    /// True where the motion takes each point to one of the others, and these are as many.
    pub(super) fn are_taken_to(&self, others: &Self, motion: &DAffine3) -> bool {
        let tolerance = self.tolerance();
        let fits = |&point: &DVec3| others.has_near(motion.transform_point3(point), tolerance);
        // Merging depends on rounding where points lie about as near to each other as what is merged.
        self.all.len().abs_diff(others.all.len()) <= self.all.len() / 100 && self.all.iter().all(fits)
    }

    /// The motions that take the points to others, those first that mirror nothing; none for points on a line, which turns freely.
    pub(super) fn motions_to(&self, others: &Self) -> Vec<DAffine3> {
        let Some([first, second]) = self.rarest() else { return Vec::new() };
        let tolerance = self.tolerance();
        let (along, aside) = (first - self.middle, second - self.middle);
        let (from_middle, apart) = ([along.length(), aside.length()], first.distance(second));
        let at = |distance: f64| others.all.iter().copied().filter(move |p| (p.distance(others.middle) - distance).abs() <= tolerance);
        let pairs = at(from_middle[0]).flat_map(|p| at(from_middle[1]).map(move |q| [p, q]));
        let pairs: Vec<[DVec3; 2]> = pairs.filter(|[p, q]| (p.distance(*q) - apart).abs() <= 2.0 * tolerance).take(MAX_TRIED).collect();
        let motion = |[p, q]: &[DVec3; 2], mirror: f64| {
            let [from, to] = [frame(along, aside)?, frame(*p - others.middle, *q - others.middle)?];
            let turn = to * DMat3::from_diagonal(DVec3::new(1.0, 1.0, mirror)) * from.transpose();
            Some(DAffine3::from_mat3_translation(turn, others.middle - turn * self.middle))
                .filter(|motion| self.are_taken_to(others, motion))
        };
        let all = [1.0, -1.0].into_iter().flat_map(|mirror| pairs.iter().filter_map(move |pair| motion(pair, mirror)));
        all.take(MAX_MOTIONS).collect()
    }

    /// Two points, off the middle and not in line with it, whose distances few others have.
    fn rarest(&self) -> Option<[DVec3; 2]> {
        let rare = |keys: Vec<Option<[i64; 2]>>| {
            let mut counts: HashMap<[i64; 2], usize> = HashMap::new();
            keys.iter().flatten().for_each(|key| *counts.entry(*key).or_default() += 1);
            // Of equally rare ones the farthest: it determines the motion best.
            let known = keys.iter().enumerate().filter_map(|(i, key)| Some((i, (*key)?)));
            known.min_by_key(|(i, key)| (counts[key], -key[0], *i)).map(|(i, _)| self.all[i])
        };
        let step = 4.0 * self.tolerance();
        let rounded = |distance: f64| (distance / step).round() as i64;
        let off = |point: &DVec3| Some(point.distance(self.middle)).filter(|distance| *distance > NEAR * self.radius);
        let first = rare(self.all.iter().map(|point| off(point).map(|distance| [rounded(distance), 0])).collect())?;
        let line = (first - self.middle).try_normalize()?;
        let from_line = |point: &DVec3| (*point - self.middle).reject_from_normalized(line).length();
        let farthest = self.all.iter().map(from_line).fold(0.0, f64::max);
        let is_aside = |point: &DVec3| from_line(point) > (NEAR * farthest).max(2.0 * self.tolerance());
        let aside = |point: &DVec3| is_aside(point).then(|| [rounded(point.distance(self.middle)), rounded(point.distance(first))]);
        let second = rare(self.all.iter().map(aside).collect())?;
        Some([first, second])
    }
}

fn cell(point: DVec3) -> [i64; 3] {
    (point / CELL_M).floor().to_array().map(|v| v as i64)
}

/// Axes by two directions: along the first, and square to both.
pub(super) fn frame(along: DVec3, aside: DVec3) -> Option<DMat3> {
    let x = along.try_normalize()?;
    let z = x.cross(aside).try_normalize()?;
    Some(DMat3::from_cols(x, z.cross(x), z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    /// The faces of a box with a lid that is not square to it, so that only one motion takes it to itself.
    fn crate_with_lid() -> Vec<DVec3> {
        let corner = |i: usize| DVec3::new((i & 1) as f64 * 0.8, (i >> 1 & 1) as f64 * 0.5, (i >> 2) as f64 * 0.3);
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).map(corner);
        faces.chain([DVec3::new(0.0, 0.0, 0.35), DVec3::new(0.8, 0.1, 0.4), DVec3::new(0.1, 0.5, 0.5)]).collect()
    }

    /// The faces in another order, each beginning with another corner.
    fn shuffled(corners: &[DVec3], rng: &mut Rng) -> Vec<DVec3> {
        let mut faces: Vec<[DVec3; 3]> = corners.chunks_exact(3).map(|face| [face[1], face[2], face[0]]).collect();
        (1..faces.len()).rev().for_each(|i| faces.swap(i, (rng.next_f32() * (i + 1) as f32) as usize));
        faces.concat()
    }

    fn placed(corners: &[DVec3], motion: DAffine3) -> Vec<DVec3> {
        // As precise as files are.
        corners.iter().map(|&corner| motion.transform_point3(corner).as_vec3().as_dvec3()).collect()
    }

    #[test]
    fn motions_and_mirrors_are_found_whatever_the_order_of_faces() {
        let mut rng = Rng::new(7);
        let from = crate_with_lid();
        let turn = DMat3::from_rotation_z(1.2) * DMat3::from_rotation_x(0.3);
        for mirror in [1.0, -1.0] {
            let motion =
                DAffine3::from_mat3_translation(turn * DMat3::from_diagonal(DVec3::new(mirror, 1.0, 1.0)), DVec3::new(5.0, -2.0, 1.0));
            let to = Points::of(&shuffled(&placed(&from, motion), &mut rng));
            let found = Points::of(&from).motions_to(&to);
            assert_eq!(found.len(), 1);
            assert!(found[0].abs_diff_eq(motion, 1e-5), "{:?}", found[0]);
        }
        // Another size, and a lid that stands otherwise.
        assert!(Points::of(&from).motions_to(&Points::of(&from.iter().map(|c| 1.02 * *c).collect::<Vec<_>>())).is_empty());
        let mut other = from.clone();
        other[36].z += 0.01;
        assert!(Points::of(&from).motions_to(&Points::of(&other)).is_empty());
    }

    #[test]
    fn what_is_symmetric_has_many_motions_and_a_line_none() {
        let round = |i: i32| DMat3::from_rotation_z(f64::from(i) * std::f64::consts::TAU / 5.0) * DVec3::new(0.4, 0.0, 0.1);
        let star: Vec<DVec3> = (0..5).flat_map(|i| [round(i), round(i + 2), DVec3::Z]).collect();
        let found = Points::of(&star).motions_to(&Points::of(&placed(&star, DAffine3::from_translation(DVec3::X))));
        assert_eq!(found.len(), 10, "five turns, and as many with a mirror");
        assert!(found[..5].iter().all(|motion| motion.matrix3.determinant() > 0.0));
        let line = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        assert!(Points::of(&line).motions_to(&Points::of(&line)).is_empty() && Points::of(&[]).motions_to(&Points::of(&[])).is_empty());
    }
}
