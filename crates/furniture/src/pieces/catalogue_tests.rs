//! Checks on the variants of every family: valid meshes that face outward, labels, sizes, and what carries them.

use super::catalogue::{FAMILIES, Family, Place, family_named};
use crate::builder::{Builder, pose};
use crate::lamplight::LampLight;
use crate::materials::Materials;
use crate::palette::Palette;
use enfilade_geometry::Mesh;
use enfilade_math::{Bounds3, DVec3, Rng, Vec2, Vec3};
use enfilade_scene::{Labels, Scene};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Variants of each family that are built.
fn seeds() -> usize {
    enfilade_testkit::seeds(5, 20) as usize
}
/// Variants of a family are built this far apart, metres.
const APART: f64 = 100.0;
/// Soft and slanted things may reach this far out of their box, metres.
pub const SLACK: f32 = 0.002;

/// Variants of one family, built side by side.
fn shown(family: &Family) -> (Scene, Labels, Vec<Bounds3>) {
    let mut b = Builder::new(Materials::new(Palette::all()[0], LampLight::default(), Rng::new(1)));
    let mut expected = Vec::new();
    for k in 0..seeds() {
        let mut rng = Rng::new(k as u64);
        let thing = (family.random)(&mut rng);
        expected.push(family.place.bounds(thing.size()));
        thing.build(&mut b, pose(APART * k as f64, 0.0, 0.0, 0.0), &mut rng);
    }
    let (scene, labels) = b.finish();
    (scene, labels, expected)
}

/// Bounds of each variant, in its own space.
fn filled(scene: &Scene) -> Vec<Bounds3> {
    let mut filled = vec![Bounds3::EMPTY; seeds()];
    for part in &scene.parts {
        for p in &scene.meshes[part.mesh as usize].positions {
            let p = part.world_from_mesh.transform_point3(p.as_dvec3());
            let k = (p.x / APART).round();
            filled[k as usize] = filled[k as usize].include((p - DVec3::X * (APART * k)).as_vec3());
        }
    }
    filled
}

/// The names of closed pieces of `mesh` that are inside out, and of shading normals that point inward.
pub fn inside_out(mesh: &Mesh) -> Option<&'static str> {
    let mut points: HashMap<[i64; 3], usize> = HashMap::new();
    let key = |i: u32| mesh.positions[i as usize].to_array().map(|v| (f64::from(v) * 1e6).round() as i64);
    let triangles: Vec<[usize; 3]> = mesh
        .triangles
        .iter()
        .map(|t| {
            t.map(|i| {
                let next = points.len();
                *points.entry(key(i)).or_insert(next)
            })
        })
        .collect();
    let mut root: Vec<usize> = (0..points.len()).collect();
    fn find(root: &mut [usize], mut i: usize) -> usize {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    }
    let mut edges: BTreeMap<(usize, usize), i32> = BTreeMap::new();
    for t in &triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (p, q) = (find(&mut root, a), find(&mut root, b));
            root[p] = q;
            *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    let open: BTreeSet<usize> = edges.iter().filter(|(_, n)| **n != 0).map(|(e, _)| find(&mut root, e.0)).collect();
    let mut volumes: BTreeMap<usize, f64> = BTreeMap::new();
    for (t, triangle) in triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(t).map(Vec3::as_dvec3);
        *volumes.entry(find(&mut root, triangle[0])).or_default() += a.dot(b.cross(c));
        let face = (b - a).cross(c - a).normalize_or_zero();
        if !mesh.normals.is_empty() && mesh.triangles[t].iter().any(|&i| mesh.normals[i as usize].as_dvec3().dot(face) < -0.1) {
            return Some("a shading normal points inward");
        }
    }
    volumes.iter().any(|(piece, v)| !open.contains(piece) && *v < -1e-9).then_some("a closed piece is inside out")
}

/// True when the texture coordinates run over the unit square.
fn covers_unit_square(mesh: &Mesh) -> bool {
    let low = mesh.uvs.iter().fold(Vec2::INFINITY, |low, uv| low.min(*uv));
    let high = mesh.uvs.iter().fold(Vec2::NEG_INFINITY, |high, uv| high.max(*uv));
    low == Vec2::ZERO && high == Vec2::ONE
}

#[test]
fn every_family_has_a_name_of_its_own_and_rooms() {
    let names: BTreeSet<&str> = FAMILIES.iter().map(|f| f.name).collect();
    assert_eq!(names.len(), FAMILIES.len());
    assert!(FAMILIES.iter().all(|f| !f.rooms.is_empty() && family_named(f.name).is_some_and(|g| g.class == f.class)));
}

#[test]
fn every_variant_is_valid_labelled_outward_within_its_box_and_held_as_its_place_says() {
    let mut problems = Vec::new();
    for family in FAMILIES {
        let (scene, labels, expected) = shown(family);
        let name = family.name;
        problems.extend(scene.validate().err().map(|error| format!("{name}: {error}")));
        assert_eq!(scene.parts.len(), labels.parts.len(), "{name}");
        if labels.parts[0].semantic != family.class as i16 {
            problems.push(format!("{name} does not come first in itself"));
        }
        for part in &scene.parts {
            let mesh = &scene.meshes[part.mesh as usize];
            problems.extend(inside_out(mesh).map(|wrong| format!("{name}, {}: {wrong}", part.name)));
            if scene.materials[part.material as usize].name == "lit screen" && !covers_unit_square(mesh) {
                problems.push(format!("{name}, {}, does not show its whole picture", part.name));
            }
        }
        for (seed, (found, expected)) in filled(&scene).iter().zip(&expected).enumerate() {
            let over = [expected.min - found.min, found.max - expected.max];
            if over[0].max(over[1]).max_element() > SLACK {
                problems.push(format!("{name}, seed {seed}, reaches {over:?} m below and beyond its box"));
            }
            if !held(family.place, found, expected) {
                problems.push(format!("{name}, seed {seed}, floats: {found:?} ({:?})", family.place));
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}

/// True when a thing that fills `found` is carried by floor, wall or ceiling, as its place requires.
pub fn held(place: Place, found: &Bounds3, expected: &Bounds3) -> bool {
    let near = |a: f32, b: f32| (a - b).abs() < 0.003;
    match place {
        Place::AgainstWall => near(found.min.z, 0.0) || near(found.min.y, expected.min.y),
        Place::OnWall => near(found.min.y, 0.0),
        Place::Ceiling => near(found.max.z, 0.0),
        Place::Free | Place::Corner | Place::OnSurface | Place::Underfoot => near(found.min.z, 0.0),
    }
}
