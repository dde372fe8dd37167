//! The over-segmentation of a part's surface: patches that bend little, as ScanNet's `segs.json` has them.
//!
//! Felzenszwalb and Huttenlocher, *Efficient Graph-Based Image Segmentation* (IJCV 2004), over the edges of the mesh as ScanNet's segmentator
//! has it: an edge weighs by how much the normals of its ends differ, less where the surface bulges. A segment never leaves its part, so groups
//! of segments are exact.

use crate::mesh::SurfaceMesh;
use enfilade_geometry::DisjointSets;
use enfilade_math::DVec3;

/// Threshold of the difference of normals within a segment, divided by its number of vertices: the `0.010000` in the file's name.
pub(super) const THRESHOLD: f64 = 0.01;

/// Segments of fewer vertices join a neighbour.
pub(super) const FEWEST_VERTICES: u32 = 20;

/// The segment of every vertex, numbered from 0 in the order of their first vertices, and how many there are.
pub(super) fn segments(mesh: &SurfaceMesh) -> (Vec<u32>, u32) {
    let normals = normals(mesh);
    let ends = |face: &[u32; 3]| [[face[0], face[1]], [face[0], face[2]], [face[2], face[1]]];
    let mut edges: Vec<(f64, [u32; 2])> = mesh.faces.iter().flat_map(ends).map(|edge| (weight(mesh, &normals, edge), edge)).collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sets = DisjointSets::new(mesh.vertices.len());
    // The largest weight that still joins, at roots.
    let mut bounds = vec![THRESHOLD; mesh.vertices.len()];
    for &(weight, [a, b]) in &edges {
        let [a, b] = [sets.root(a), sets.root(b)];
        if a != b && weight <= bounds[a as usize] && weight <= bounds[b as usize] {
            let root = sets.unite(a, b);
            bounds[root as usize] = weight + THRESHOLD / f64::from(sets.size(root));
        }
    }
    for &(_, [a, b]) in &edges {
        if sets.size(a).min(sets.size(b)) < FEWEST_VERTICES {
            sets.unite(a, b);
        }
    }
    numbered(&mut sets, mesh.vertices.len())
}

fn numbered(sets: &mut DisjointSets, vertices: usize) -> (Vec<u32>, u32) {
    let (mut of_root, mut count) = (vec![None; vertices], 0);
    let mut number = |vertex: u32| {
        *of_root[sets.root(vertex) as usize].get_or_insert_with(|| {
            count += 1;
            count - 1
        })
    };
    let numbers = (0..vertices as u32).map(&mut number).collect();
    (numbers, count)
}

/// Normals of vertices: those of the triangles around, by their areas.
fn normals(mesh: &SurfaceMesh) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; mesh.vertices.len()];
    for face in &mesh.faces {
        let [a, b, c] = face.map(|corner| mesh.vertices[corner as usize]);
        let normal = (b - a).cross(c - a);
        face.iter().for_each(|&corner| normals[corner as usize] += normal);
    }
    normals.iter().map(|normal| normal.normalize_or_zero()).collect()
}

fn weight(mesh: &SurfaceMesh, normals: &[DVec3], [a, b]: [u32; 2]) -> f64 {
    let [a, b] = [a as usize, b as usize];
    let differ = 1.0 - normals[a].dot(normals[b]);
    let bulges = normals[b].dot(mesh.vertices[b] - mesh.vertices[a]) > 0.0;
    if bulges { differ * differ } else { differ }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::scannet::subdivide::{subdivide, welded};
    use std::collections::BTreeSet;

    #[test]
    fn the_faces_of_a_box_lie_in_segments_of_their_own_and_each_is_large_enough() {
        let corner = |i: usize| DVec3::from_array(std::array::from_fn(|axis| f64::from(u8::from(i >> axis & 1 == 1))));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mut mesh = welded(&SurfaceMesh { vertices: (0..8).map(corner).collect(), faces });
        subdivide(&mut mesh, 0.1);
        let (segments, count) = segments(&mesh);
        let is_inside = |v: f64| (0.2..0.8).contains(&v);
        let mut of_sides = BTreeSet::new();
        for (axis, side) in [(0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0), (2, 0.0), (2, 1.0)] {
            let on = |v: &DVec3| v[axis] == side && is_inside(v[(axis + 1) % 3]) && is_inside(v[(axis + 2) % 3]);
            let here: BTreeSet<u32> = mesh.vertices.iter().zip(&segments).filter(|(v, _)| on(v)).map(|(_, &s)| s).collect();
            assert_eq!(here.len(), 1, "the inner part of a side is one segment");
            of_sides.extend(here);
        }
        assert_eq!(of_sides.len(), 6);
        for segment in 0..count {
            assert!(segments.iter().filter(|&&s| s == segment).count() >= FEWEST_VERTICES as usize);
        }
    }

    #[test]
    fn what_is_not_joined_is_never_one_segment() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let vertices = vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(5.0, 0.0), at(6.0, 0.0), at(5.0, 1.0)];
        let mesh = SurfaceMesh { vertices, faces: vec![[0, 1, 2], [3, 4, 5]] };
        assert_eq!(segments(&mesh), (vec![0, 0, 0, 1, 1, 1], 2));
        assert_eq!(segments(&SurfaceMesh::default()), (Vec::new(), 0));
    }
}
