//! From triangles to the cells of a cube that they touch (separating axes) or enclose (flood fill from outside).

use crate::surface::Surface;
use enfilade_math::DVec3;

/// The cells of a cube of `side`³ that the surface touches or encloses, x slowest; `None` when it has no extent.
pub(crate) fn solid(surface: &Surface, side: usize) -> Option<Vec<bool>> {
    let used = || surface.faces().iter().flatten().map(|&corner| surface.vertices()[corner as usize]);
    let (min, max) = used().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    let edge = (max - min).max_element();
    if side == 0 || !(edge > 0.0 && edge.is_finite()) {
        return None;
    }
    let origin = 0.5 * (min + max) - 0.5 * edge;
    let place = |corner: u32| (surface.vertices()[corner as usize] - origin) * (side as f64 / edge);
    let mut cells = vec![false; side.pow(3)];
    for face in surface.faces() {
        touch(face.map(place), side, &mut cells);
    }
    let outside = flood(&cells, side);
    cells.iter_mut().zip(outside).for_each(|(cell, outside)| *cell |= !outside);
    Some(cells)
}

/// Marks the cells, of edge 1, that a triangle touches.
fn touch(corners: [DVec3; 3], side: usize, cells: &mut [bool]) {
    let [a, b, c] = corners;
    let (min, max) = (a.min(b).min(c), a.max(b).max(c));
    let first = |v: f64| (v.floor().max(0.0) as usize).min(side - 1);
    let normal = (b - a).cross(c - a);
    // Columns of cells run along the axis that the plane crosses most directly, where few cells of each are near it.
    let w = normal.abs().max_position();
    let (u, v) = ((w + 1) % 3, (w + 2) % 3);
    for i in first(min[u])..=first(max[u]) {
        for j in first(min[v])..=first(max[v]) {
            let (from, to) = if normal[w] == 0.0 {
                (min[w], max[w])
            } else {
                let at =
                    |di: usize, dj: usize| a[w] - (normal[u] * ((i + di) as f64 - a[u]) + normal[v] * ((j + dj) as f64 - a[v])) / normal[w];
                let corners = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)];
                let (low, high) =
                    (corners.into_iter().fold(f64::INFINITY, f64::min), corners.into_iter().fold(f64::NEG_INFINITY, f64::max));
                (low.max(min[w]), high.min(max[w]))
            };
            if from > to {
                continue;
            }
            for k in first(from)..=first(to) {
                let mut cell = [0; 3];
                (cell[u], cell[v], cell[w]) = (i, j, k);
                let index = (cell[0] * side + cell[1]) * side + cell[2];
                let middle = DVec3::from_array(cell.map(|n| n as f64 + 0.5));
                cells[index] = cells[index] || touches([a - middle, b - middle, c - middle]);
            }
        }
    }
}

/// True when a triangle touches the cube of edge 1 around the origin: no axis separates them.
/// Akenine-Möller 2001, "Fast 3D triangle-box overlap testing".
fn touches(corners: [DVec3; 3]) -> bool {
    let [a, b, c] = corners;
    let edges = [b - a, c - b, a - c];
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let crossed = edges.iter().flat_map(|edge| axes.map(|axis| axis.cross(*edge)));
    axes.into_iter().chain([edges[0].cross(edges[1])]).chain(crossed).all(|axis| {
        let reach = 0.5 * axis.abs().element_sum();
        let along = corners.map(|corner| corner.dot(axis));
        // Cells share their borders, so a point on one touches both sides; rounding may not open a gap.
        let slack = 1e-9 * (reach + along[0].abs());
        along.into_iter().fold(f64::INFINITY, f64::min) <= reach + slack
            && along.into_iter().fold(f64::NEG_INFINITY, f64::max) >= -reach - slack
    })
}

/// The free cells that a way through faces of free cells joins to the outside of the cube.
fn flood(cells: &[bool], side: usize) -> Vec<bool> {
    let mut outside = vec![false; cells.len()];
    let mut next = Vec::new();
    let mut enter = |index: usize, next: &mut Vec<usize>| {
        if !cells[index] && !outside[index] {
            outside[index] = true;
            next.push(index);
        }
    };
    let index = |x: usize, y: usize, z: usize| (x * side + y) * side + z;
    for i in 0..side {
        for j in 0..side {
            let border =
                [index(0, i, j), index(side - 1, i, j), index(i, 0, j), index(i, side - 1, j), index(i, j, 0), index(i, j, side - 1)];
            border.into_iter().for_each(|at| enter(at, &mut next));
        }
    }
    while let Some(at) = next.pop() {
        for stride in [side * side, side, 1] {
            let place = at / stride % side;
            if place > 0 {
                enter(at - stride, &mut next);
            }
            if place + 1 < side {
                enter(at + stride, &mut next);
            }
        }
    }
    outside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::tests::block;

    fn count(cells: &[bool]) -> usize {
        cells.iter().filter(|c| **c).count()
    }

    /// A ball of radius 1 as an octahedron that is divided and pushed outward.
    fn ball(levels: usize) -> Surface {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let mut triangles = Vec::new();
        for signs in 0..8 {
            let corner = |i: usize| if signs >> i & 1 == 0 { axes[i] } else { -axes[i] };
            triangles.push([corner(0), corner(1), corner(2)]);
        }
        for _ in 0..levels {
            let divide = |[a, b, c]: [DVec3; 3]| {
                let [d, e, f] = [a + b, b + c, c + a].map(DVec3::normalize);
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            };
            triangles = triangles.into_iter().flat_map(divide).collect();
        }
        let faces = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Surface::new(triangles.into_iter().flatten().collect(), faces).unwrap()
    }

    #[test]
    fn a_closed_surface_is_filled() {
        let cells = solid(&ball(4), 32).unwrap();
        // Cells that the sphere touches are occupied, so the ball is thicker by half the mean width of a cell: radius 16.75.
        let expected = 4.0 / 3.0 * std::f64::consts::PI * 16.75f64.powi(3);
        assert!((count(&cells) as f64 / expected - 1.0).abs() < 0.02, "{} of {expected}", count(&cells));
        let far = |i: usize| {
            let cell = DVec3::new((i / 1024) as f64, (i / 32 % 32) as f64, (i % 32) as f64) - 15.5;
            cell.length()
        };
        assert!((0..cells.len()).all(|i| if far(i) < 15.0 { cells[i] } else { far(i) < 17.0 || !cells[i] }));
    }

    #[test]
    fn a_box_takes_its_share_of_the_cube() {
        let cells = solid(&block(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.25)), 16).unwrap();
        // 16 x 8 x 4 cells inside; a face between two cells belongs to the upper one, and the cube ends at its own faces.
        assert_eq!(count(&cells), 16 * 9 * 5);
    }

    #[test]
    fn an_open_surface_is_a_shell() {
        let open = block(DVec3::ZERO, DVec3::ONE);
        let lidless = Surface::new(open.vertices().to_vec(), open.faces()[2..].to_vec()).unwrap();
        assert_eq!((count(&solid(&open, 8).unwrap()), count(&solid(&lidless, 8).unwrap())), (512, 512 - 6 * 6 * 7));
    }

    #[test]
    fn the_cells_of_a_triangle_are_those_of_brute_force() {
        let side = 12;
        let mut rng = enfilade_math::Rng::new(9);
        for _ in 0..40 {
            let corners: [DVec3; 3] = std::array::from_fn(|_| DVec3::from_array(std::array::from_fn(|_| 12.0 * f64::from(rng.next_f32()))));
            let mut cells = vec![false; side * side * side];
            touch(corners, side, &mut cells);
            for (i, &cell) in cells.iter().enumerate() {
                let middle = DVec3::new((i / 144) as f64, (i / 12 % 12) as f64, (i % 12) as f64) + 0.5;
                assert_eq!(cell, touches(corners.map(|corner| corner - middle)), "cell {i} of {corners:?}");
            }
        }
    }

    #[test]
    fn a_point_has_no_cells() {
        let point = Surface::new(vec![DVec3::ONE; 3], vec![[0, 1, 2]]).unwrap();
        assert!(solid(&point, 8).is_none() && solid(&Surface::default(), 8).is_none());
    }
}
