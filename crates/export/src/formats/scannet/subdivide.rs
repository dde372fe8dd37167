//! Subdivision of triangles until no edge is longer than a limit, so that the values of a vertex are valid for a patch of that size.
//!
//! In every round each edge that is too long gets a vertex in its middle. Its length alone decides, and triangles that share an edge share the
//! middle, so a surface without gaps stays one without T-junctions.

use crate::mesh::SurfaceMesh;
use enfilade_math::DVec3;
use std::collections::{BTreeMap, HashMap};

/// The length that edges are cut to, metres: ScanNet's meshes have edges of 2 to 5 cm.
pub(super) const LONGEST_M: f64 = 0.05;

/// About how many vertices cutting may add to a scene; where it would be more, longer edges stay.
const MOST_ADDED: f64 = 2e6;

/// Shortest edges over the largest coordinate: about ten times the resolution of float32.
const FINEST: f64 = 1e-6;

/// Factor by which the length limit grows in the next attempt.
const LONGER: f64 = 1.25;

/// Vertices per square of the longest edge: cut edges are between half of it and all of it.
const VERTICES_PER_SQUARE: f64 = 4.0;

/// The mesh with vertices at the same place made one, and without triangles that have a corner twice.
pub(super) fn welded(mesh: &SurfaceMesh) -> SurfaceMesh {
    let mut known: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut welded = SurfaceMesh::default();
    for face in &mesh.faces {
        let corners = face.map(|corner| mesh.vertices[corner as usize]);
        if (0..3).any(|i| corners[i] == corners[(i + 1) % 3]) {
            continue;
        }
        let face = corners.map(|corner| {
            // Adding zero turns −0 into 0.
            *known.entry(corner.to_array().map(|v| (v + 0.0).to_bits())).or_insert_with(|| push(&mut welded.vertices, corner))
        });
        welded.faces.push(face);
    }
    welded
}

/// The length that the edges of a scene are cut to, metres: [`LONGEST_M`], or longer if the resolution of float32 or the limit on the
/// number of vertices requires it.
pub(super) fn edge_length_m<'m>(meshes: impl Iterator<Item = &'m SurfaceMesh> + Clone) -> f64 {
    let reach = |mesh: &SurfaceMesh| mesh.vertices.iter().map(|vertex| vertex.abs().max_element()).fold(0.0, f64::max);
    let mut longest_m = LONGEST_M.max(FINEST * meshes.clone().map(reach).fold(0.0, f64::max));
    while meshes.clone().map(|mesh| added(mesh, longest_m)).sum::<f64>() > MOST_ADDED {
        longest_m *= LONGER;
    }
    longest_m
}

/// About how many vertices cutting adds.
fn added(mesh: &SurfaceMesh, longest_m: f64) -> f64 {
    let of_face = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|corner| mesh.vertices[corner as usize]);
        let lengths = [a.distance(b), b.distance(c), c.distance(a)];
        if lengths.iter().all(|&length| length <= longest_m) {
            return 0.0;
        }
        let area = 0.5 * (b - a).cross(c - a).length();
        VERTICES_PER_SQUARE * area / (longest_m * longest_m) + lengths.iter().sum::<f64>() / longest_m
    };
    mesh.faces.iter().map(of_face).sum()
}

/// Cuts edges until none is longer than `longest_m`.
pub(super) fn subdivide(mesh: &mut SurfaceMesh, longest_m: f64) {
    loop {
        // Only looked up in, so its order reaches nothing.
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut cut = Vec::with_capacity(mesh.faces.len());
        for &face in &mesh.faces {
            let middle = |i: usize| middle(&mut mesh.vertices, &mut middles, [face[i], face[(i + 1) % 3]], longest_m);
            let of_edges = [0, 1, 2].map(middle);
            pieces(&mesh.vertices, face, of_edges, &mut cut);
        }
        mesh.faces = cut;
        if middles.is_empty() {
            return;
        }
    }
}

/// The vertex in the middle of an edge that is too long.
fn middle(vertices: &mut Vec<DVec3>, middles: &mut HashMap<[u32; 2], u32>, [a, b]: [u32; 2], longest_m: f64) -> Option<u32> {
    let ends = [vertices[a as usize], vertices[b as usize]];
    let is_too_long = ends[0].distance(ends[1]) > longest_m;
    is_too_long.then(|| *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| push(vertices, (ends[0] + ends[1]) * 0.5)))
}

fn push(vertices: &mut Vec<DVec3>, vertex: DVec3) -> u32 {
    vertices.push(vertex);
    vertices.len() as u32 - 1
}

/// The pieces of a triangle with these middles of its edges, the first of which begins at its first corner. They face where it faces.
fn pieces(vertices: &[DVec3], face: [u32; 3], middles: [Option<u32>; 3], cut: &mut Vec<[u32; 3]>) {
    let turned = |by: usize| ([0, 1, 2].map(|i| face[(i + by) % 3]), [0, 1, 2].map(|i| middles[(i + by) % 3]));
    match middles {
        [None, None, None] => cut.push(face),
        [Some(m), Some(n), Some(o)] => {
            let [a, b, c] = face;
            cut.extend([[a, m, o], [m, b, n], [o, n, c], [m, n, o]]);
        }
        _ => {
            // Turned so that the first edge is cut and the last is not.
            let by = (0..3).find(|&by| matches!(turned(by).1, [Some(_), _, None])).unwrap_or(0);
            match turned(by) {
                ([a, b, c], [Some(m), Some(n), _]) => {
                    let length = |from: u32, to: u32| vertices[from as usize].distance(vertices[to as usize]);
                    let rest = if length(a, n) <= length(m, c) { [[a, m, n], [a, n, c]] } else { [[a, m, c], [m, n, c]] };
                    cut.push([m, b, n]);
                    cut.extend(rest);
                }
                ([a, b, c], [Some(m), ..]) => cut.extend([[a, m, c], [m, b, c]]),
                _ => cut.push(face),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A floor of three metres by two, with a step to its side.
    fn corner() -> SurfaceMesh {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let vertices =
            vec![at(0.0, 0.0, 0.0), at(3.0, 0.0, 0.0), at(3.0, 2.0, 0.0), at(0.0, 2.0, 0.0), at(3.0, 0.0, 0.04), at(3.0, 2.0, 0.04)];
        SurfaceMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]] }
    }

    fn area(mesh: &SurfaceMesh) -> f64 {
        let of = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|i| mesh.vertices[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        mesh.faces.iter().map(of).sum()
    }

    /// Number of triangles of each edge.
    fn edges(mesh: &SurfaceMesh) -> BTreeMap<[u32; 2], usize> {
        let mut edges = BTreeMap::new();
        for face in &mesh.faces {
            (0..3).map(|i| [face[i], face[(i + 1) % 3]]).for_each(|[a, b]| *edges.entry([a.min(b), a.max(b)]).or_default() += 1);
        }
        edges
    }

    #[test]
    fn no_edge_is_too_long_and_the_surface_stays_one_without_t_junctions() {
        let (whole, mut mesh) = (corner(), corner());
        subdivide(&mut mesh, 0.1);
        assert!((area(&mesh) - area(&whole)).abs() < 1e-9);
        let length = |[a, b]: [u32; 2]| mesh.vertices[a as usize].distance(mesh.vertices[b as usize]);
        let edges = edges(&mesh);
        assert!(edges.keys().all(|&edge| length(edge) <= 0.1) && mesh.vertices.len() > 1000);
        // Edges of one triangle are those of the border: two sides, the ends of floor and step, and the step's upper edge.
        let border: f64 = edges.iter().filter(|(_, faces)| **faces == 1).map(|(&edge, _)| length(edge)).sum();
        assert!((border - (3.0 + 2.0 + 3.0 + 0.04 + 2.0 + 0.04)).abs() < 1e-9 && edges.values().all(|&faces| faces <= 2), "{border} m");
        let guess = added(&whole, 0.1);
        assert!((0.4..2.5).contains(&(guess / mesh.vertices.len() as f64)), "{guess} of {}", mesh.vertices.len());
    }

    #[test]
    fn vertices_at_one_place_are_one_and_empty_triangles_go() {
        let mut mesh = corner();
        mesh.vertices.push(DVec3::new(-0.0, 0.0, 0.0));
        mesh.faces.extend([[6, 2, 3], [0, 6, 2]]);
        let welded = welded(&mesh);
        assert_eq!((welded.vertices.len(), welded.faces.len()), (6, 5));
        assert_eq!(welded.faces[4], welded.faces[1]);
    }

    #[test]
    fn a_scene_of_any_size_is_cut_to_a_bounded_number_of_vertices() {
        let mut huge = corner();
        huge.vertices.iter_mut().for_each(|vertex| *vertex *= 1e6);
        let longest = edge_length_m([&huge].into_iter());
        assert!(longest > 1000.0 && added(&huge, longest) <= MOST_ADDED);
        assert_eq!(edge_length_m([&corner()].into_iter()), LONGEST_M);
        let mut far = corner();
        far.vertices.iter_mut().for_each(|vertex| vertex.x += 1e17);
        let longest = edge_length_m([&far].into_iter());
        subdivide(&mut far, longest);
        assert_eq!(far.faces, corner().faces, "there are no numbers between its corners");
    }
}
