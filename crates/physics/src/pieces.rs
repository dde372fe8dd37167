//! Convex pieces of parts, with their masses.
//!
//! A part falls into what hangs together, such as the planks of a floor. Of that, what is convex is one piece; what is fixed and has few triangles
//! becomes slabs behind them (`skin`), so that openings of walls keep their edges; of what moves, what is small or nearly convex is its
//! hull; everything else is cut by V-HACD (`enfilade_compose::solids`).
//!
//! The mass of a part is its density times the volume that its surface encloses, or, where the surface is open, that of its pieces. Pieces share
//! it by their volumes.

use crate::bodies::{Group, Hold};
use crate::matter::density;
use crate::model::Piece;
use crate::skin::{ground, slabs};
use enfilade_compose::{Solid, convex_solid, solids};
use enfilade_geometry::DisjointSets;
use enfilade_math::{DAffine3, DMat3, DVec3, Vec3};
use enfilade_scene::{Labels, Scene};
use std::collections::BTreeMap;

/// What moves and hangs together in more pieces than this is cut as a whole.
const MOST_ISLANDS: usize = 64;
/// What moves and is smaller than this is its hull, metres.
const SMALL_M: f64 = 0.02;
/// What moves and fills this share of its hull is its hull.
const FILLED: f64 = 0.95;
/// How far the product of a matrix with its transpose may be from 1 for a rotation: coordinates of meshes have 24 bits.
const TURNED: f64 = 1e-9;
/// Fixed parts of at most so many triangles become slabs where they are not convex.
const MOST_SLABS: usize = 2500;

/// The pieces of every part, world, at rest.
pub(crate) fn of_parts(scene: &Scene, labels: &Labels, groups: &[Group]) -> Vec<Vec<Piece>> {
    let mut fixed = vec![false; scene.parts.len()];
    for group in groups.iter().filter(|group| group.joint == Hold::Fixed) {
        group.parts.iter().for_each(|part| fixed[*part as usize] = true);
    }
    // Parts with one mesh in one size are cut once.
    let same = same_meshes(scene);
    let key = |part: usize| {
        let part = &scene.parts[part];
        (same[part.mesh as usize], split(part.world_from_mesh.matrix3).0.to_cols_array().map(f64::to_bits))
    };
    let mut first: BTreeMap<_, usize> = BTreeMap::new();
    (0..scene.parts.len()).for_each(|part| {
        first.entry((key(part), fixed[part])).or_insert(part);
    });
    let distinct: Vec<usize> = first.values().copied().collect();
    let cut: Vec<(Vec<Solid>, Option<f64>)> = enfilade_parallel::map(&distinct, |&part| cut(scene, part, fixed[part]));
    let number: BTreeMap<usize, usize> = distinct.iter().copied().zip(0..).collect();
    let placed = |part: usize| {
        let (solids, volume) = &cut[number[&first[&(key(part), fixed[part])]]];
        let own: Vec<f64> = solids.iter().map(Solid::volume_m3).collect();
        let sum: f64 = own.iter().sum();
        let mass = density(scene, labels, part as u32) * volume.map_or(sum, |volume| volume.min(sum));
        let placed = scene.parts[part].world_from_mesh;
        let place = DAffine3 { matrix3: split(placed.matrix3).1, ..placed };
        let piece = |(solid, own): (&Solid, &f64)| {
            let corners = solid.corners.iter().map(|corner| place.transform_point3(*corner)).collect();
            Piece { solid: Solid { corners, triangles: solid.triangles.clone() }, mass_kg: mass * own / sum }
        };
        solids.iter().zip(&own).map(piece).collect()
    };
    (0..scene.parts.len()).map(placed).collect()
}

/// Of every mesh, the first one that has the same surface.
fn same_meshes(scene: &Scene) -> Vec<usize> {
    let mut first: BTreeMap<_, usize> = BTreeMap::new();
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    let surfaces = scene.meshes.iter().map(|mesh| (mesh.positions.iter().map(bits).collect::<Vec<_>>(), mesh.triangles.as_slice()));
    surfaces.enumerate().map(|(number, surface)| *first.entry(surface).or_insert(number)).collect()
}

/// A matrix as what is done before the cut, and the rotation after it: all of a rotation comes after it.
fn split(matrix: DMat3) -> (DMat3, DMat3) {
    let off = matrix * matrix.transpose() - DMat3::IDENTITY;
    let turns = matrix.determinant() > 0.0 && off.to_cols_array().iter().all(|value| value.abs() < TURNED);
    if turns { (DMat3::IDENTITY, matrix) } else { (matrix, DMat3::IDENTITY) }
}

/// The solids of a part about its own origin, before its rotation, and the volume of a closed surface.
fn cut(scene: &Scene, part: usize, fixed: bool) -> (Vec<Solid>, Option<f64>) {
    let part = &scene.parts[part];
    let mesh = &scene.meshes[part.mesh as usize];
    let shaped = split(part.world_from_mesh.matrix3).0;
    let points: Vec<DVec3> = mesh.positions.iter().map(|p| shaped * p.as_dvec3()).collect();
    let (points, triangles) = welded(&points, &mesh.triangles);
    let islands = islands(points.len(), &triangles);
    let cut = if islands.len() > MOST_ISLANDS && !fixed {
        solids(&points, &triangles)
    } else {
        let packed = islands.iter().map(|island| packed(&points, island));
        packed.flat_map(|(points, triangles)| whole(&points, &triangles, fixed)).collect()
    };
    (cut, enclosed(&points, &triangles))
}

/// The solids of what hangs together.
fn whole(points: &[DVec3], triangles: &[[u32; 3]], fixed: bool) -> Vec<Solid> {
    if let Some(solid) = convex_solid(points, triangles) {
        let ground = if fixed { ground(points, triangles) } else { None };
        return vec![ground.unwrap_or(solid)];
    }
    if fixed && triangles.len() <= MOST_SLABS {
        return slabs(points, triangles);
    }
    let filled = |solid: &Solid| enclosed(points, triangles).is_some_and(|volume| volume > FILLED * solid.volume_m3());
    let extent = |solid: &Solid| {
        let corners = solid.corners.iter();
        let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
        (high - low).max_element()
    };
    let hull = Solid::around(points).filter(|solid| !fixed && (extent(solid) < SMALL_M || filled(solid)));
    hull.map_or_else(|| solids(points, triangles), |solid| vec![solid])
}

/// Points of one place as one, and the triangles that keep three corners.
fn welded(points: &[DVec3], triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut known: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut kept = Vec::new();
    // Adding 0 makes -0 and 0 one.
    let number = |p: &DVec3| {
        *known.entry((*p + DVec3::ZERO).to_array().map(f64::to_bits)).or_insert_with(|| {
            kept.push(*p);
            kept.len() as u32 - 1
        })
    };
    let new: Vec<u32> = points.iter().map(number).collect();
    let triangles = triangles.iter().map(|t| t.map(|corner| new[corner as usize]));
    (kept, triangles.filter(|[a, b, c]| a != b && b != c && a != c).collect())
}

/// Triangles that hang together by their corners, in the order of their lowest corner.
fn islands(points: usize, triangles: &[[u32; 3]]) -> Vec<Vec<[u32; 3]>> {
    let mut sets = DisjointSets::new(points);
    for [a, b, c] in triangles {
        sets.unite(*a, *b);
        sets.unite(*a, *c);
    }
    let mut islands: BTreeMap<u32, Vec<[u32; 3]>> = BTreeMap::new();
    for triangle in triangles {
        islands.entry(sets.root(triangle[0])).or_default().push(*triangle);
    }
    islands.into_values().collect()
}

/// The points that triangles use, and the triangles with their numbers.
fn packed(points: &[DVec3], triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let used: BTreeMap<u32, u32> =
        triangles.iter().flatten().copied().collect::<std::collections::BTreeSet<_>>().into_iter().zip(0..).collect();
    (used.keys().map(|&i| points[i as usize]).collect(), triangles.iter().map(|t| t.map(|corner| used[&corner])).collect())
}

/// The volume that a surface encloses, cubic metres; `None` where it is open or inside out.
fn enclosed(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<f64> {
    let mut edges: BTreeMap<[u32; 2], i64> = BTreeMap::new();
    for [a, b, c] in triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([*from.min(to), *from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    if edges.values().any(|&turns| turns != 0) {
        return None;
    }
    let origin = *points.first()?;
    let at = |i: &u32| points[*i as usize] - origin;
    let volume: f64 = triangles.iter().map(|[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum();
    (volume > 0.0).then_some(volume)
}
