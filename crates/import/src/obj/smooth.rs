//! Normals of smoothing groups (`s 1` and above), which the format wants smooth where the file has none.

use super::file::{Face, NONE, ObjFile};
use crate::polygon::newell_normal;
use enfilade_math::Vec3;
use std::collections::HashMap;

impl ObjFile {
    /// Gives the corners without normals normals: within a smoothing group the mean of the faces around the vertex, weighted by their
    /// angles there, whatever part they are of; elsewhere in such a part the face's own. Parts without smoothing groups get none.
    pub(crate) fn smooth(&mut self) {
        let mut sums: HashMap<(u32, u32), Vec3> = HashMap::new();
        self.each_bare_face(|obj, corners, face| {
            if face.smoothing != 0 {
                let normal = obj.normal(corners);
                for (i, corner) in corners.iter().enumerate() {
                    *sums.entry((face.smoothing, corner[0])).or_default() += normal * obj.angle(corners, i);
                }
            }
        });
        if sums.is_empty() {
            return;
        }
        let mut numbers: HashMap<(u32, u32), u32> = HashMap::new();
        for g in 0..self.groups.len() {
            if self.groups[g].faces.iter().all(|face| face.smoothing == 0) {
                continue;
            }
            for f in 0..self.groups[g].faces.len() {
                let corners = self.groups[g].corners_of(f);
                if !is_bare(corners) {
                    continue;
                }
                let (own, smoothing, vertices) =
                    (self.normal(corners), self.groups[g].faces[f].smoothing, corners.iter().map(|c| c[0]).collect::<Vec<_>>());
                let first = self.groups[g].faces[f].first as usize;
                let flat = self.normals.len() as u32;
                if smoothing == 0 {
                    self.normals.push(own);
                }
                for (i, vertex) in vertices.into_iter().enumerate() {
                    let number = if smoothing == 0 {
                        flat
                    } else {
                        *numbers.entry((smoothing, vertex)).or_insert_with(|| {
                            let sum = sums.get(&(smoothing, vertex)).copied().unwrap_or_default();
                            self.normals.push(sum.try_normalize().unwrap_or(own));
                            (self.normals.len() - 1) as u32
                        })
                    };
                    self.groups[g].corners[first + i][2] = number;
                }
            }
        }
    }

    fn each_bare_face(&self, mut take: impl FnMut(&Self, &[[u32; 3]], &Face)) {
        for group in &self.groups {
            for (i, face) in group.faces.iter().enumerate() {
                let corners = group.corners_of(i);
                if is_bare(corners) {
                    take(self, corners, face);
                }
            }
        }
    }

    fn normal(&self, corners: &[[u32; 3]]) -> Vec3 {
        let points: Vec<Vec3> = corners.iter().map(|c| self.position(c[0])).collect();
        newell_normal(&points).normalize_or_zero()
    }

    /// The angle of a polygon at its corner `i`.
    fn angle(&self, corners: &[[u32; 3]], i: usize) -> f32 {
        let n = corners.len();
        let [before, here, after] = [(i + n - 1) % n, i, (i + 1) % n].map(|k| self.position(corners[k][0]));
        (before - here).normalize_or_zero().dot((after - here).normalize_or_zero()).clamp(-1.0, 1.0).acos()
    }
}

/// True for a face none of whose corners has a normal.
fn is_bare(corners: &[[u32; 3]]) -> bool {
    corners.iter().all(|corner| corner[2] == NONE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Two walls at a right angle with a floor-like flap that belongs to no smoothing group.
    const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n";

    fn normals(faces: &str) -> Vec<(Vec3, Vec3)> {
        let mut obj = ObjFile::parse(format!("{CORNER}{faces}").as_bytes(), Path::new("a.obj")).unwrap();
        obj.smooth();
        let mesh = obj.mesh(obj.groups.iter());
        mesh.positions.iter().copied().zip(mesh.normals.iter().copied()).collect()
    }

    #[test]
    fn smoothing_groups_are_smooth_within_and_sharp_between() {
        let diagonal = Vec3::new(1.0, 0.0, 1.0).normalize();
        let smooth = normals("s 1\nf 1 2 3 4\nusemtl other\nf 1 4 6 5\n");
        assert!(smooth.iter().filter(|(p, _)| p.x == 0.0 && p.z == 0.0).all(|(_, n)| (*n - diagonal).length() < 1e-6), "{smooth:?}");
        assert!(smooth.iter().filter(|(p, _)| p.x == 1.0).all(|(_, n)| *n == Vec3::Z));
        for sharp in ["s 1\nf 1 2 3 4\ns 2\nf 1 4 6 5\n", "s 1\nf 1 2 3 4\ns off\nf 1 4 6 5\n"] {
            assert!(normals(sharp).iter().all(|(_, n)| *n == Vec3::Z || *n == Vec3::X), "{sharp}");
        }
        assert!(normals("s off\nf 1 2 3 4\nf 1 4 6 5\n").is_empty());
    }
}
