//! Checks that no piece of an object hangs in the air beside the others.
//!
//! A mesh may have many pieces that share no vertex: the rods of a rack, the keys of a keyboard. Each has to touch the support of its
//! object (the floor, the wall or the ceiling), directly or by way of others. If an object as a whole has no support, its lowest piece
//! counts as one, or under a ceiling its highest: a home lowers such objects when it settles.

use super::{FAMILIES, Family, Furniture, Place};
use crate::builder::{Builder, pose};
use crate::lamplight::LampLight;
use crate::materials::Materials;
use crate::meet::{Body, Triangle, overlap, triangles_cut};
use crate::names::{family_of, object_of};
use crate::palette::Palette;
use crate::shape::{Reshape, bevelled_box};
use crate::touch;
use enfilade_geometry::Mesh;
use enfilade_math::{Bounds3, DVec3, Rng, Vec3};
use enfilade_scene::Scene;
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;

/// Variants of each family that are built.
fn seeds() -> usize {
    enfilade_testkit::seeds(3, 8) as usize
}
/// Variants of a family are built this far apart, metres.
pub const APART: f64 = 100.0;
/// Pieces nearer than this are joined, metres: the gaps around fronts are 3 mm wide, those behind a refrigerator's doors 4 mm.
const JOINT: f32 = 0.0042;
/// Leaves that are nearer than this are joined, metres: they are set along a straight line, while the shoot that they grow from is bent.
const LEAF: f32 = 0.025;
/// Families of such plants.
const LEAFY: [&str; 3] = ["herbs", "flower_vase", "hanging_plant"];
/// Pieces this near to floor, wall or ceiling are carried by it, metres.
const HELD: f32 = 0.003;

/// A thing alone at the origin.
pub fn scene_of(thing: &dyn Furniture, seed: u64) -> Scene {
    let mut b = nothing();
    thing.build(&mut b, pose(0.0, 0.0, 0.0, 0.0), &mut Rng::new(seed));
    b.finish().0
}

/// The box around the part of this name, which the scene has.
pub fn bounds_of(scene: &Scene, name: &str) -> Bounds3 {
    let part = scene.parts.iter().find(|part| part.name == name).expect("the scene has the part");
    Bounds3::from_points(scene.world_positions(part))
}

/// The parts whose names have `word` in them.
pub fn bodies_of(scene: &Scene, word: &str) -> Vec<Body> {
    let found = scene.parts.iter().filter(|part| part.name.contains(word));
    found
        .map(|part| {
            let world: Vec<Vec3> = scene.world_positions(part).collect();
            let mut body = Body::new(&part.name);
            body.push(scene.meshes[part.mesh as usize].triangles.iter().map(|t| t.map(|i| world[i as usize])).collect());
            body
        })
        .collect()
}

/// The triangles of a mesh.
pub fn triangles(mesh: &Mesh) -> Vec<Triangle> {
    (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect()
}

/// True when `p` is within a closed surface, which then fills the whole solid angle of 4π around it; seen from outside, sides that face
/// `p` and sides that face away cancel to zero.
///
/// Solid angle of a triangle: Van Oosterom & Strackee 1983.
pub fn encloses(surface: &[Triangle], p: Vec3) -> bool {
    let filled = |t: &Triangle| {
        let [a, b, c] = t.map(|q| (q - p).as_dvec3());
        let [x, y, z] = [a, b, c].map(DVec3::length);
        2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    surface.iter().map(filled).sum::<f64>().abs() > TAU
}

pub fn nothing() -> Builder {
    Builder::new(Materials::new(Palette::all()[0], LampLight::default(), Rng::new(1)))
}

/// Sets of joined things, as a union-find.
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The number of the set that `i` is in.
    fn find(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a] = b;
    }
}

/// Triangles that share vertices.
struct Piece<'a> {
    part: &'a str,
    bounds: Bounds3,
    triangles: Vec<Triangle>,
}

impl<'a> Piece<'a> {
    fn new(part: &'a str, triangles: Vec<Triangle>) -> Self {
        Self { part, bounds: Bounds3::from_points(triangles.iter().flatten().copied()), triangles }
    }

    /// True when the two come nearer than `reach`, or one is inside the other.
    fn touches(&self, other: &Self, reach: f32) -> bool {
        overlap(&self.bounds, &other.bounds, reach) && (self.is_near(other, reach) || self.hides(other) || other.hides(self))
    }

    fn hides(&self, other: &Self) -> bool {
        let around = self.bounds.contains(other.bounds.min) && self.bounds.contains(other.bounds.max);
        around && encloses(&self.triangles, other.triangles[0][0])
    }

    fn is_near(&self, other: &Self, reach: f32) -> bool {
        let (mine, mut theirs) = (self.within(&other.bounds, reach), other.within(&self.bounds, reach));
        theirs.sort_by(|(a, _), (b, _)| a.min.x.total_cmp(&b.min.x));
        let widest = theirs.iter().map(|(bounds, _)| bounds.extent().x).fold(0.0, f32::max);
        mine.iter().any(|(bounds, t)| {
            let from = theirs.partition_point(|(b, _)| b.min.x < bounds.min.x - widest - reach);
            let beside = theirs[from..].iter().take_while(|(b, _)| b.min.x <= bounds.max.x + reach);
            beside.filter(|(b, _)| overlap(bounds, b, reach)).any(|(_, s)| are_near(t, s, reach))
        })
    }

    /// The triangles of the piece, with their boxes, that come near to `window`.
    fn within(&self, window: &Bounds3, reach: f32) -> Vec<(Bounds3, Triangle)> {
        let boxed = self.triangles.iter().map(|t| (Bounds3::from_points(*t), *t));
        boxed.filter(|(bounds, _)| overlap(bounds, window, reach)).collect()
    }
}

/// True when two triangles come nearer than `reach`: where they do not cut each other, two edges are nearest, or a corner and a face.
fn are_near(s: &Triangle, t: &Triangle, reach: f32) -> bool {
    let edges = |t: &Triangle| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    edges(s).into_iter().any(|e| edges(t).into_iter().any(|f| between(e, f) <= reach))
        || s.iter().any(|p| above(*p, t) <= reach)
        || t.iter().any(|p| above(*p, s) <= reach)
        || triangles_cut(s, t)
}

/// Distance of a point from a triangle if it is straight above or below it; infinity otherwise.
fn above(p: Vec3, [a, b, c]: &Triangle) -> f32 {
    let normal = (*b - *a).cross(*c - *a).normalize_or_zero();
    let left_of = |from: Vec3, to: Vec3| (to - from).cross(p - from).dot(normal) >= 0.0;
    let over = normal != Vec3::ZERO && left_of(*a, *b) && left_of(*b, *c) && left_of(*c, *a);
    if over { (p - *a).dot(normal).abs() } else { f32::INFINITY }
}

/// Distance between two line segments. Ericson, "Real-Time Collision Detection", section 5.1.9.
fn between([p, q]: [Vec3; 2], [r, s]: [Vec3; 2]) -> f32 {
    let (d, e, w) = (q - p, s - r, p - r);
    let (dd, ee, de, dw, ew) = (d.dot(d), e.dot(e), d.dot(e), d.dot(w), e.dot(w));
    let slant = dd * ee - de * de;
    let share = |part: f32, whole: f32| if whole > 1e-16 { (part / whole).clamp(0.0, 1.0) } else { 0.0 };
    // The point of the first segment nearest to the line of the second, then the point of the second nearest to that, then the first again.
    let first = share(de * ew - dw * ee, slant);
    let second = share(de * first + ew, ee);
    let first = share(de * second - dw, dd);
    (w + d * first - e * second).length()
}

/// The numbers of the triangles of each piece of a mesh.
fn split(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut known: HashMap<[i64; 3], usize> = HashMap::new();
    let number = |p: &Vec3| {
        let next = known.len();
        *known.entry(p.to_array().map(|v| (f64::from(v) * 1e6).round() as i64)).or_insert(next)
    };
    let points: Vec<usize> = mesh.positions.iter().map(number).collect();
    let mut groups = Groups::new(points.len());
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| points[i as usize]);
        groups.join(a, b);
        groups.join(b, c);
    }
    let mut pieces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        pieces.entry(groups.find(points[triangle[0] as usize])).or_default().push(t);
    }
    pieces.into_values().collect()
}

/// The pieces of each of `count` variants in a scene of separate variants.
fn pieces(scene: &Scene, count: usize) -> Vec<Vec<Piece<'_>>> {
    let splits: Vec<Vec<Vec<usize>>> = scene.meshes.iter().map(|mesh| split(mesh)).collect();
    let mut all: Vec<Vec<Piece>> = (0..count).map(|_| Vec::new()).collect();
    for part in &scene.parts {
        let mesh = &scene.meshes[part.mesh as usize];
        let world: Vec<DVec3> = mesh.positions.iter().map(|p| part.world_from_mesh.transform_point3(p.as_dvec3())).collect();
        let Some(first) = world.first() else { continue };
        let variant = (first.x / APART).round();
        let own = |i: u32| (world[i as usize] - DVec3::X * (APART * variant)).as_vec3();
        for numbers in &splits[part.mesh as usize] {
            let triangles = numbers.iter().map(|&t| mesh.triangles[t].map(own)).collect();
            all[variant as usize].push(Piece::new(&part.name, triangles));
        }
    }
    all
}

/// True when floor, wall or ceiling carries a piece of a thing with the box `whole`.
fn is_held(place: Place, piece: &Bounds3, whole: &Bounds3) -> bool {
    let (stands, at_wall) = (piece.min.z < HELD, piece.min.y < whole.min.y + HELD);
    match place {
        Place::AgainstWall => stands || at_wall,
        Place::OnWall => at_wall,
        Place::Ceiling => piece.max.z > -HELD,
        Place::Free | Place::Corner | Place::OnSurface | Place::Underfoot => stands,
    }
}

/// Greatest distance at which pieces of these parts count as joined, metres.
fn reach(a: &str, b: &str) -> f32 {
    let objects = [object_of(a), object_of(b)];
    let least = if objects.iter().any(|object| LEAFY.contains(&family_of(object))) { LEAF } else { JOINT };
    touch::reach(objects[0], objects[1]).max(least)
}

/// The groups of joined pieces; the last number, beyond theirs, is their support.
fn joined(pieces: &[Piece], place: Place, whole: &Bounds3) -> Groups {
    let mut groups = Groups::new(pieces.len() + 1);
    for (i, piece) in pieces.iter().enumerate() {
        if is_held(place, &piece.bounds, whole) {
            groups.join(i, pieces.len());
        }
    }
    let low = |i: usize| pieces[i].bounds.min.x;
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by(|&a, &b| low(a).total_cmp(&low(b)));
    for (k, &a) in order.iter().enumerate() {
        for &b in order[k + 1..].iter().take_while(|&&b| low(b) <= pieces[a].bounds.max.x + LEAF) {
            let apart = groups.find(a) != groups.find(b);
            if apart && pieces[a].touches(&pieces[b], reach(pieces[a].part, pieces[b].part)) {
                groups.join(a, b);
            }
        }
    }
    groups
}

/// The parts of one variant of which pieces are loose, and how many.
fn loose<'a>(pieces: &[Piece<'a>], place: Place, whole: &Bounds3) -> BTreeMap<&'a str, usize> {
    let mut groups = joined(pieces, place, whole);
    let held = groups.find(pieces.len());
    let mut objects: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, piece) in pieces.iter().enumerate() {
        objects.entry(object_of(piece.part)).or_default().push(i);
    }
    let end = |i: usize| if place == Place::Ceiling { -pieces[i].bounds.max.z } else { pieces[i].bounds.min.z };
    let mut found = BTreeMap::new();
    for own in objects.values() {
        let mut carrier = held;
        if own.iter().all(|&i| groups.find(i) != held) {
            let first = own.iter().copied().min_by(|&a, &b| end(a).total_cmp(&end(b)));
            carrier = first.map_or(held, |i| groups.find(i));
        }
        for &i in own {
            if groups.find(i) != carrier {
                *found.entry(pieces[i].part).or_default() += 1;
            }
        }
    }
    found
}

/// Builds things side by side, [`APART`] from each other, each with random numbers of its own.
pub fn side_by_side(things: &[(String, Box<dyn Furniture>)], mut b: Builder) -> Scene {
    for (k, (_, thing)) in things.iter().enumerate() {
        thing.build(&mut b, pose(APART * k as f64, 0.0, 0.0, 0.0), &mut Rng::new(k as u64));
    }
    b.finish().0
}

/// Loose pieces of things that `b` builds.
pub fn loose_among(things: &[(String, Box<dyn Furniture>)], place: Place, b: Builder) -> Vec<String> {
    let scene = side_by_side(things, b);
    let variants = pieces(&scene, things.len());
    let of = |k: usize| loose(&variants[k], place, &place.bounds(things[k].1.size()));
    let told = |k: usize| of(k).into_iter().map(move |(part, n)| format!("{}: {n} pieces of {part}", things[k].0));
    (0..things.len()).flat_map(told).collect()
}

/// Loose pieces in variants of a family that `b` builds.
fn faults(family: &Family, b: Builder) -> Vec<String> {
    let variant = |seed: usize| (format!("{}, seed {seed}", family.name), (family.random)(&mut Rng::new(seed as u64)));
    let things: Vec<_> = (0..seeds()).map(variant).collect();
    loose_among(&things, family.place, b)
}

#[test]
fn every_piece_is_joined_to_what_carries_its_object() {
    let found: Vec<String> = enfilade_parallel::flat_map(FAMILIES, |family| {
        [nothing(), nothing().with_joints()].into_iter().flat_map(|b| faults(family, b)).collect::<Vec<_>>()
    });
    assert!(found.is_empty(), "these hang in the air:\n{}", found.join("\n"));
}

#[test]
fn pieces_are_joined_by_touch_and_by_being_inside_and_not_through_the_air() {
    let cube = |size: f32, at: Vec3| Piece::new("cube_1/body", triangles(&bevelled_box(Vec3::splat(size), 0.01).moved(at)));
    let one = cube(1.0, Vec3::ZERO);
    assert!(one.touches(&cube(1.0, Vec3::new(0.2, 0.3, 1.004)), JOINT), "face to face");
    assert!(!one.touches(&cube(1.0, Vec3::new(0.2, 0.3, 1.005)), JOINT));
    assert!(one.touches(&cube(1.0, Vec3::new(0.9, 0.3, 0.3)), JOINT), "through each other");
    assert!(one.touches(&cube(0.2, Vec3::splat(0.1)), JOINT), "inside");
    assert!(!one.touches(&cube(0.2, Vec3::new(0.7, 0.0, 0.0)), JOINT));
    let rod = |from: Vec3, to: Vec3| Piece::new("rod_1/body", triangles(&crate::shape::tube(&[from, to], 0.01, 8)));
    let along = rod(Vec3::NEG_X, Vec3::X);
    assert!(along.touches(&rod(Vec3::new(0.3, -1.0, 0.022), Vec3::new(0.3, 1.0, 0.022)), JOINT), "crosswise, far from all corners");
    assert!(!along.touches(&rod(Vec3::new(0.3, -1.0, 0.03), Vec3::new(0.3, 1.0, 0.03)), JOINT));
    let whole = Bounds3 { min: Vec3::splat(-0.5), max: Vec3::splat(3.0) };
    let tower = [cube(1.0, Vec3::new(0.0, 0.0, 0.5)), cube(1.0, Vec3::new(0.0, 0.0, 1.502)), cube(0.5, Vec3::new(0.0, 0.0, 2.5))];
    assert_eq!(loose(&tower, Place::Free, &whole), BTreeMap::from([("cube_1/body", 1)]));
}
