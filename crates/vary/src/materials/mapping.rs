//! Texture coordinates in metres for parts that have none, or some of another scale: box projection.
//!
//! Each triangle is seen along the axis that its normal is nearest to, so a picture lies on it at its true size, stretched by 1.73 at most
//! where a surface is oblique to all three axes. Axes are those of the world, turned about z with the part, so that what stands askew is
//! seen along its own sides. Triangles keep their order and corners their places; corners are doubled where neighbours are seen along
//! different axes.

use enfilade_geometry::{DisjointSets, Mesh};
use enfilade_math::{Bounds3, DAffine3, DMat3, DVec3, Vec2, Vec3};
use enfilade_scene::{PartId, Scene};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// How a picture lies on a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mapping {
    /// The upper edge points upward where the surface is upright.
    Upright,
    /// The u axis runs along the longest side of each piece, as grain does along boards.
    Grain,
    /// Once over the whole part, seen from above.
    Whole,
}

/// Lengths of a texture's unit on a surface that count as a metre.
const METRE: [f32; 2] = [0.8, 1.25];
/// Largest cosine between the axes of a texture that count as perpendicular.
const SKEW: f32 = 0.2;
/// Least share of a mesh's area whose coordinates are in metres.
const METRIC_SHARE: f32 = 0.9;

/// Meshes with coordinates that were made, by what they were made from.
#[derive(Default)]
pub struct Mapped {
    made: BTreeMap<(u32, [u64; 9], Mapping), u32>,
}

impl Mapped {
    /// Gives a part coordinates for pictures that are measured in metres, as a copy of its mesh; one whose coordinates are in metres keeps
    /// them, unless the picture is to cover the whole part.
    pub fn map(&mut self, scene: &mut Scene, part: PartId, mapping: Mapping) {
        let part = &mut scene.parts[part as usize];
        let linear = part.world_from_mesh.matrix3;
        let key = (part.mesh, linear.to_cols_array().map(f64::to_bits), mapping);
        if let Some(known) = self.made.get(&key) {
            part.mesh = *known;
            return;
        }
        let mesh = &scene.meshes[part.mesh as usize];
        let place = upright(linear);
        let made = if mapping != Mapping::Whole && is_metric(mesh, place) {
            part.mesh
        } else {
            scene.meshes.push(projected(mesh, place, mapping).into());
            scene.meshes.len() as u32 - 1
        };
        part.mesh = made;
        self.made.insert(key, made);
    }
}

/// A placement without its turn about z, up to quarter turns, and without its shift.
fn upright(linear: DMat3) -> DMat3 {
    let level = |c: DVec3| c.truncate().length();
    let axes = [linear.x_axis, linear.y_axis, linear.z_axis].map(|axis| axis.normalize_or_zero());
    let most = axes.into_iter().fold(axes[0], |most, axis| if level(axis) > level(most) + 1e-6 { axis } else { most });
    let turn = most.y.atan2(most.x);
    let rest = turn - (turn / FRAC_PI_2).round() * FRAC_PI_2;
    if rest.abs() < 1e-9 { linear } else { DMat3::from_rotation_z(-rest) * linear }
}

/// Whether the texture coordinates of a mesh are metres of its surface, nearly everywhere.
fn is_metric(mesh: &Mesh, place: DMat3) -> bool {
    if mesh.uvs.is_empty() {
        return false;
    }
    let (mut all, mut good) = (0.0, 0.0);
    for triangle in &mesh.triangles {
        let p = triangle.map(|i| (place * mesh.positions[i as usize].as_dvec3()).as_vec3());
        let uv = triangle.map(|i| mesh.uvs[i as usize]);
        let (e1, e2, d1, d2) = (p[1] - p[0], p[2] - p[0], uv[1] - uv[0], uv[2] - uv[0]);
        let area = e1.cross(e2).length();
        all += area;
        let turn = d1.perp_dot(d2);
        if turn == 0.0 {
            continue;
        }
        let (along_u, along_v) = ((e1 * d2.y - e2 * d1.y) / turn, (e2 * d1.x - e1 * d2.x) / turn);
        let (u, v) = (along_u.length(), along_v.length());
        if [u, v].iter().all(|side| (METRE[0]..=METRE[1]).contains(side)) && along_u.dot(along_v).abs() <= SKEW * u * v {
            good += area;
        }
    }
    all > 0.0 && good >= METRIC_SHARE * all
}

/// The mesh with coordinates by box projection.
fn projected(mesh: &Mesh, place: DMat3, mapping: Mapping) -> Mesh {
    let to_place = DAffine3::from_mat3(place);
    let points: Vec<Vec3> = mesh.positions.iter().map(|p| enfilade_math::place(&to_place, *p)).collect();
    if mapping == Mapping::Whole {
        return Mesh { uvs: whole(&points), ..mesh.clone() };
    }
    let longest = if mapping == Mapping::Grain { longest_axes(mesh, &points) } else { Vec::new() };
    let mut made = Mesh::default();
    let mut places = vec![[u32::MAX; 3]; points.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| points[i as usize]);
        let normal = (b - a).cross(c - a).abs();
        // Of normals between two axes, those that may be level are.
        let axis = [1, 0, 2].into_iter().fold(2, |most, axis| if normal[axis] > 1.0001 * normal[most] { axis } else { most });
        made.triangles.push(triangle.map(|i| {
            let place = &mut places[i as usize][axis];
            if *place == u32::MAX {
                *place = made.positions.len() as u32;
                made.positions.push(mesh.positions[i as usize]);
                made.normals.extend(mesh.normals.get(i as usize));
                made.uvs.push(seen(points[i as usize], axis, longest.get(i as usize).copied()));
            }
            *place
        }));
    }
    made
}

/// Coordinates of a point seen along an axis; u along `longest`, unless that is the axis itself.
fn seen(p: Vec3, axis: usize, longest: Option<[usize; 3]>) -> Vec2 {
    let [u, v] = match (axis, longest) {
        (_, Some(order)) => {
            let mut within = order.into_iter().filter(|other| *other != axis);
            [within.next().unwrap_or(0), within.next().unwrap_or(1)]
        }
        (2, None) => [0, 1],
        (0, None) => [1, 2],
        (_, None) => [0, 2],
    };
    Vec2::new(p[u], p[v])
}

/// The unit square over the box around the points, seen from above, u along its longer side.
fn whole(points: &[Vec3]) -> Vec<Vec2> {
    let bounds = Bounds3::from_points(points.iter().copied());
    let size = bounds.extent().max(Vec3::splat(1e-6));
    let [u, v] = if size.x >= size.y { [0, 1] } else { [1, 0] };
    points.iter().map(|p| Vec2::new((p[u] - bounds.min[u]) / size[u], (p[v] - bounds.min[v]) / size[v])).collect()
}

/// Of every corner the axes, sorted by the size of the piece that it is a corner of, the longest first. A piece is what is connected
/// by corners at the same place.
fn longest_axes(mesh: &Mesh, points: &[Vec3]) -> Vec<[usize; 3]> {
    let mut pieces = DisjointSets::new(points.len());
    let mut at: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    for (p, i) in points.iter().zip(0u32..) {
        let first = *at.entry(p.to_array().map(f32::to_bits)).or_insert(i);
        pieces.unite(first, i);
    }
    for [a, b, c] in &mesh.triangles {
        pieces.unite(*a, *b);
        pieces.unite(*a, *c);
    }
    let roots: Vec<u32> = (0..points.len() as u32).map(|i| pieces.root(i)).collect();
    let mut bounds: BTreeMap<u32, Bounds3> = BTreeMap::new();
    for (root, p) in roots.iter().zip(points) {
        let known = bounds.entry(*root).or_insert(Bounds3 { min: *p, max: *p });
        *known = Bounds3 { min: known.min.min(*p), max: known.max.max(*p) };
    }
    let order = |root: &u32| {
        let size = bounds[root].extent();
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| size[*b].total_cmp(&size[*a]));
        axes
    };
    roots.iter().map(order).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn board(size: [f32; 3]) -> Mesh {
        Mesh { uvs: Vec::new(), ..Mesh::cuboid(size.into()) }
    }

    /// Lengths of the unit of u and v on the surface, of every triangle.
    fn scales(mesh: &Mesh) -> Vec<[f32; 2]> {
        let scale = |triangle: &[u32; 3]| {
            let p = triangle.map(|i| mesh.positions[i as usize]);
            let uv = triangle.map(|i| mesh.uvs[i as usize]);
            let (e1, e2, d1, d2) = (p[1] - p[0], p[2] - p[0], uv[1] - uv[0], uv[2] - uv[0]);
            let turn = d1.perp_dot(d2);
            [((e1 * d2.y - e2 * d1.y) / turn).length(), ((e2 * d1.x - e1 * d2.x) / turn).length()]
        };
        mesh.triangles.iter().map(scale).collect()
    }

    #[test]
    fn coordinates_are_metres_and_triangles_stay() {
        let mesh = board([2.0, 0.5, 0.1]);
        for mapping in [Mapping::Upright, Mapping::Grain] {
            let made = projected(&mesh, DMat3::IDENTITY, mapping);
            assert_eq!(made.validate(), Ok(()));
            assert!((0..mesh.triangles.len()).all(|t| made.corners(t) == mesh.corners(t)));
            assert!(scales(&made).iter().flatten().all(|scale| (scale - 1.0).abs() < 1e-5), "{:?}", scales(&made));
            assert!(is_metric(&made, DMat3::IDENTITY) && !is_metric(&mesh, DMat3::IDENTITY));
            // Twice as large, its coordinates are half metres.
            assert!(!is_metric(&made, DMat3::from_diagonal(DVec3::splat(2.0))));
        }
    }

    #[test]
    fn grain_runs_along_the_longest_side_and_paper_stands_upright() {
        let span = |mesh: &Mesh, axis: usize| mesh.uvs.iter().map(|uv| uv[axis].abs()).fold(0.0, f32::max);
        let leg = board([0.05, 0.06, 0.7]);
        // Along the leg on its sides, and never across by more than its width.
        let made = projected(&leg, DMat3::IDENTITY, Mapping::Grain);
        assert!((span(&made, 0) - 0.35).abs() < 1e-6 && span(&made, 1) < 0.031, "{:?}", made.uvs);
        let made = projected(&leg, DMat3::IDENTITY, Mapping::Upright);
        assert!((span(&made, 1) - 0.35).abs() < 1e-6 && span(&made, 0) < 0.031, "{:?}", made.uvs);
    }

    #[test]
    fn what_stands_askew_is_seen_along_its_own_sides() {
        let turned = DMat3::from_rotation_z(0.4) * DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0));
        let place = upright(turned);
        assert!((place - DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0))).to_cols_array().iter().all(|v| v.abs() < 1e-9));
        assert_eq!(upright(DMat3::from_rotation_x(FRAC_PI_2)), DMat3::from_rotation_x(FRAC_PI_2));
    }

    #[test]
    fn a_rug_is_covered_once() {
        let made = projected(&board([1.4, 2.0, 0.01]), DMat3::IDENTITY, Mapping::Whole);
        let corners: Vec<[f32; 2]> = made.uvs.iter().map(|uv| uv.to_array()).collect();
        assert!(
            corners.contains(&[0.0, 0.0]) && corners.contains(&[1.0, 1.0]) && corners.iter().flatten().all(|v| (0.0..=1.0).contains(v))
        );
    }
}
