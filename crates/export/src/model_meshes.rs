//! Simpler and finer meshes of a model: clusters of vertices, sides of bounded length, points spread over the area.

use crate::mesh::SurfaceMesh;
use enfilade_math::DVec3;
use std::collections::BTreeMap;

/// The mesh with the vertices of each cell of a grid made one, the one nearest to their mean, and without the triangles that this makes
/// flat. Rossignac and Borrel 1993, "Multi-resolution 3D approximations for rendering complex scenes".
pub(crate) fn clustered(mesh: &SurfaceMesh, cell_m: f64) -> SurfaceMesh {
    let cell_of = |v: DVec3| (v / cell_m).floor().to_array().map(|x| x as i64);
    let mut cells: BTreeMap<[i64; 3], (DVec3, u32)> = BTreeMap::new();
    for v in &mesh.vertices {
        let (sum, count) = cells.entry(cell_of(*v)).or_default();
        (*sum, *count) = (*sum + *v, *count + 1);
    }
    let mut nearest: BTreeMap<[i64; 3], (f64, usize)> = BTreeMap::new();
    for (i, v) in mesh.vertices.iter().enumerate() {
        let cell = cell_of(*v);
        let (sum, count) = cells[&cell];
        let distance = v.distance_squared(sum / f64::from(count));
        let best = nearest.entry(cell).or_insert((distance, i));
        if distance < best.0 {
            *best = (distance, i);
        }
    }
    let numbers: BTreeMap<[i64; 3], u32> = nearest.keys().copied().zip(0..).collect();
    let vertices = nearest.values().map(|(_, i)| mesh.vertices[*i]).collect();
    let faces = mesh.faces.iter().map(|face| face.map(|i| numbers[&cell_of(mesh.vertices[i as usize])]));
    SurfaceMesh { vertices, faces: faces.filter(|[a, b, c]| a != b && b != c && c != a).collect() }
}

/// Subdivided surface with no side longer than `side_m`: sides that are longer are halved, in all triangles that share them, so no gaps open.
pub(crate) fn with_short_sides(mesh: &SurfaceMesh, side_m: f64) -> SurfaceMesh {
    let mut vertices = mesh.vertices.clone();
    let mut middles: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let (mut faces, mut todo) = (Vec::new(), mesh.faces.clone());
    while let Some(face) = todo.pop() {
        let length = |k: usize| vertices[face[k] as usize].distance_squared(vertices[face[(k + 1) % 3] as usize]);
        // The longest side, and of equal ones that of the lowest vertices, so that both of its triangles choose alike.
        let ends = |k: usize| [face[k].min(face[(k + 1) % 3]), face[k].max(face[(k + 1) % 3])];
        let long = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b)).then(ends(*b).cmp(&ends(*a)))).unwrap_or(0);
        if length(long) <= side_m * side_m {
            faces.push(face);
            continue;
        }
        let [a, b, c] = [face[long], face[(long + 1) % 3], face[(long + 2) % 3]];
        let middle = *middles.entry(ends(long)).or_insert_with(|| {
            vertices.push(0.5 * (vertices[a as usize] + vertices[b as usize]));
            vertices.len() as u32 - 1
        });
        todo.extend([[a, middle, c], [middle, b, c]]);
    }
    faces.reverse();
    SurfaceMesh { vertices, faces }
}

/// `n` points, spread evenly along the running sum of the triangles' areas; none without area.
pub(crate) fn spread(mesh: &SurfaceMesh, n: usize) -> Vec<DVec3> {
    let corners = |face: &[u32; 3]| face.map(|i| mesh.vertices[i as usize]);
    let area = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a).length();
    let total: f64 = mesh.faces.iter().map(|face| area(corners(face))).sum();
    let mut points = Vec::new();
    if !(total > 0.0 && total.is_finite()) {
        return points;
    }
    let mut sum = 0.0;
    for face in &mesh.faces {
        let [a, b, c] = corners(face);
        sum += area([a, b, c]);
        while points.len() < n && (points.len() as f64 + 0.5) / n as f64 * total < sum {
            // The R2 sequence (Roberts 2018), folded into the triangle.
            let k = points.len() as f64 + 0.5;
            let (u, v) = ((0.754_877_666_246_692_8 * k).fract(), (0.569_840_290_998_053_2 * k).fract());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            points.push(a + u * (b - a) + v * (c - a));
        }
    }
    points
}

/// The normal of every vertex: the normals of its triangles, weighted by the angle that each has there (Thürrner and Wüthrich 1998).
pub(crate) fn vertex_normals(mesh: &SurfaceMesh) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; mesh.vertices.len()];
    for face in &mesh.faces {
        let [a, b, c] = face.map(|i| mesh.vertices[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for (k, [at, one, other]) in [[a, b, c], [b, c, a], [c, a, b]].into_iter().enumerate() {
            let (one, other) = (one - at, other - at);
            let angle = if one.length() > 0.0 && other.length() > 0.0 { one.angle_between(other) } else { 0.0 };
            normals[face[k] as usize] += angle * normal;
        }
    }
    normals.into_iter().map(DVec3::normalize_or_zero).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> SurfaceMesh {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        SurfaceMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] }
    }

    fn area(mesh: &SurfaceMesh) -> f64 {
        let corners = |face: &[u32; 3]| face.map(|i| mesh.vertices[i as usize]);
        mesh.faces.iter().map(corners).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).z).sum()
    }

    #[test]
    fn long_sides_are_halved_without_gaps() {
        let fine = with_short_sides(&square(), 0.15);
        assert!((area(&fine) - 1.0).abs() < 1e-12);
        let mut sides: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for &[a, b, c] in &fine.faces {
            for [a, b] in [[a, b], [b, c], [c, a]] {
                assert!(fine.vertices[a as usize].distance(fine.vertices[b as usize]) <= 0.15);
                *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
        }
        let is_border = |[a, b]: &[u32; 2]| {
            let [a, b] = [fine.vertices[*a as usize], fine.vertices[*b as usize]];
            (0..2).any(|axis| a[axis] == b[axis] && (a[axis] == 0.0 || a[axis] == 1.0))
        };
        assert!(sides.iter().all(|(ends, count)| *count == if is_border(ends) { 1 } else { 2 }));
    }

    #[test]
    fn clusters_keep_the_shape_and_leave_fewer_triangles() {
        let fine = with_short_sides(&square(), 0.02);
        let simple = clustered(&fine, 0.1);
        assert!(simple.faces.len() * 10 < fine.faces.len() && simple.vertices.len() <= 121, "{}", simple.faces.len());
        assert!((area(&simple) - 1.0).abs() < 0.2, "{}", area(&simple));
    }

    #[test]
    fn points_are_spread_by_area_and_normals_weighted_by_angle() {
        let points = spread(&square(), 1000);
        let share = points.iter().filter(|p| p.x < 0.25).count() as f64 / 1000.0;
        assert!(points.len() == 1000 && (share - 0.25).abs() < 0.02, "{share}");
        // A corner of a cube, one of whose sides is cut into two triangles.
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 0.0)];
        let mesh = SurfaceMesh { vertices, faces: vec![[0, 1, 4], [0, 4, 2], [0, 2, 3], [0, 3, 1]] };
        assert!((vertex_normals(&mesh)[0] - DVec3::ONE.normalize()).length() < 1e-12);
    }
}
