//! The things of a scene as bodies: what each stands on, what it carries, and whether it may stand elsewhere.
//!
//! A thing is an instance of the labels. Every other part, such as a wall, is a body by itself that stays where it is. What is judged are
//! triangles: a thing and all that it carries may be where no surface of theirs cuts another, where every foot that had a surface below it
//! has one at the same height, and where the way there leads through nothing.

use crate::sources::thing_name;
use enfilade_furniture::meet::{Body, Triangle, overlap};
use enfilade_geometry::Bvh;
use enfilade_math::{Bounds3, DAffine3, DVec3, Ray, Vec3, place};
use enfilade_scene::{LabelledScene, PartId, is_stuff};
use std::collections::{BTreeMap, BTreeSet};

/// Vertices this far above the lowest one of a thing are its feet, metres.
const FOOT_M: f32 = 0.015;
/// Feet that are looked at, at most.
const FEET: usize = 48;
/// A surface this far below a foot, or above it where the foot has sunk in, carries it, metres.
const CARRIED_M: f32 = 0.025;
/// Difference of the heights below a foot before and after, metres.
const LEVEL_M: f32 = 0.004;
/// What is nearer than this touches, metres.
const REACH_M: f32 = 0.008;
/// Things are lifted by this before they are compared with what carries them, metres.
const LIFT_M: f32 = 0.006;
/// Distance that is kept from cameras, metres.
pub const CAMERA_M: f32 = 0.4;

/// A thing, or a part that is none.
pub struct Thing {
    pub name: String,
    /// −1 for parts that are no things.
    pub instance: i16,
    pub class: i16,
    pub parts: Vec<PartId>,
    pub body: Body,
    feet: Vec<Vec3>,
    /// What is below its feet, and how high.
    below: Vec<Option<(usize, f32)>>,
    pub is_gone: bool,
    pub has_moved: bool,
}

/// All of them.
pub struct Things {
    pub list: Vec<Thing>,
    bvh: Bvh,
    /// Thing of each triangle of the hierarchy.
    of_triangle: Vec<u32>,
    cameras: Vec<Vec3>,
    /// Boxes before doors that stay free.
    ways: Vec<Bounds3>,
}

impl Things {
    /// Things of a scene. `ways` are boxes into which nothing may be moved.
    pub fn of(scene: &LabelledScene, ways: Vec<Bounds3>) -> Self {
        let mut number: BTreeMap<(bool, u32), usize> = BTreeMap::new();
        let mut list: Vec<Thing> = Vec::new();
        let (mut corners, mut of_triangle): (Vec<Triangle>, Vec<u32>) = (Vec::new(), Vec::new());
        for (part, id) in scene.scene.parts.iter().zip(0..) {
            let label = scene.labels.parts[id as usize];
            let is_thing = label.instance >= 1 && !is_stuff(label.semantic);
            let key = if is_thing { (true, label.instance as u32) } else { (false, id) };
            let thing = *number.entry(key).or_insert_with(|| {
                let name = if is_thing { thing_name(&scene.scene, id) } else { part.name.clone() };
                list.push(Thing::new(name, if is_thing { label.instance } else { -1 }, label.semantic));
                list.len() - 1
            });
            let mesh = &scene.scene.meshes[part.mesh as usize];
            let triangles: Vec<Triangle> = (0..mesh.triangles.len()).map(|t| scene.scene.world_corners(part, t)).collect();
            of_triangle.extend(std::iter::repeat_n(thing as u32, triangles.len()));
            corners.extend(&triangles);
            list[thing].parts.push(id);
            list[thing].body.push(triangles);
        }
        let bvh = Bvh::new(&corners, &|_| false);
        let cameras = scene.scene.cameras.iter().map(|camera| camera.position.as_vec3()).collect();
        let mut things = Self { list, bvh, of_triangle, cameras, ways };
        for index in 0..things.list.len() {
            if things.list[index].instance >= 1 {
                things.list[index].feet = feet(&things.list[index].body);
                let own = BTreeSet::from([index]);
                things.list[index].below = things.list[index].feet.iter().map(|foot| things.below(*foot, &own)).collect();
            }
        }
        things
    }

    /// The first surface below a foot that is none of `own`, within reach: whose, and how high.
    fn below(&self, foot: Vec3, own: &BTreeSet<usize>) -> Option<(usize, f32)> {
        let from = foot + Vec3::Z * CARRIED_M;
        let is_other = |triangle: u32| {
            let thing = self.of_triangle[triangle as usize] as usize;
            !own.contains(&thing) && !self.list[thing].is_gone
        };
        let ray = Ray { t_max: 2.0 * CARRIED_M, ..Ray::new(from, Vec3::NEG_Z) };
        let hit = self.bvh.closest_filtered(&ray, |hit| is_other(hit.triangle))?;
        Some((self.of_triangle[hit.triangle as usize] as usize, from.z - hit.t))
    }

    /// What carries a thing.
    pub fn carriers(&self, thing: usize) -> BTreeSet<usize> {
        self.list[thing].below.iter().flatten().map(|(below, _)| *below).collect()
    }

    /// True when at least half of its feet have something below them.
    pub fn rests(&self, thing: usize) -> bool {
        let below = &self.list[thing].below;
        !below.is_empty() && 2 * below.iter().flatten().count() >= below.len()
    }

    /// The things that move with one: those that it carries, and smaller ones that touch it, and so on.
    pub fn group(&self, thing: usize) -> BTreeSet<usize> {
        let mut group = BTreeSet::from([thing]);
        let mut new = vec![thing];
        while let Some(at) = new.pop() {
            for other in (0..self.list.len()).filter(|&other| self.list[other].instance >= 1 && !self.list[other].is_gone) {
                if !group.contains(&other) && self.goes_with(other, at, thing) {
                    group.insert(other);
                    new.push(other);
                }
            }
        }
        group
    }

    fn goes_with(&self, other: usize, at: usize, first: usize) -> bool {
        let (a, b) = (&self.list[other].body, &self.list[at].body);
        if !overlap(&a.bounds, &b.bounds, CARRIED_M) || self.carriers(first).contains(&other) {
            return false;
        }
        let ways = [Vec3::ZERO, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        self.carriers(other).contains(&at)
            || a.volume() < self.list[first].body.volume() && ways.iter().any(|way| a.meets(b, *way * REACH_M))
    }

    /// Whether the things of `group` may be where `to` puts them.
    pub fn fits(&self, group: &BTreeSet<usize>, to: &DAffine3) -> bool {
        let carriers: BTreeSet<usize> = group.iter().flat_map(|&member| self.carriers(member)).collect();
        group.iter().all(|&member| self.stands(member, group, to) && self.is_free(member, group, &carriers, to))
    }

    /// Whether every foot that has a surface below it outside of the group has one of the same height afterwards.
    fn stands(&self, member: usize, group: &BTreeSet<usize>, to: &DAffine3) -> bool {
        let thing = &self.list[member];
        thing.feet.iter().zip(&thing.below).all(|(foot, below)| match below {
            Some((carrier, height)) if !group.contains(carrier) => {
                let found = self.below(place(to, *foot), group);
                found.is_some_and(|(carrier, found)| (found - height).abs() < LEVEL_M && !self.list[carrier].has_moved)
            }
            _ => true,
        })
    }

    fn is_free(&self, member: usize, group: &BTreeSet<usize>, carriers: &BTreeSet<usize>, to: &DAffine3) -> bool {
        let before = &self.list[member].body;
        let body = moved(before, to);
        let mut others = (0..self.list.len()).filter(|other| !group.contains(other) && !self.list[*other].is_gone);
        let cuts = |other: usize| {
            let lift = if carriers.contains(&other) { Vec3::Z * LIFT_M } else { Vec3::ZERO };
            body.meets(&self.list[other].body, lift)
        };
        let near = |bounds: &Bounds3, camera: &Vec3| camera.distance(camera.clamp(bounds.min, bounds.max));
        self.cameras.iter().all(|camera| near(&body.bounds, camera) >= CAMERA_M.min(near(&before.bounds, camera)))
            && self.ways.iter().all(|way| !overlap(&body.bounds, way, 0.0) || overlap(&before.bounds, way, 0.0))
            && !self.is_parted(before.bounds.center(), body.bounds.center(), group)
            && !others.any(cuts)
    }

    /// True when something outside of the group is between two points.
    fn is_parted(&self, from: Vec3, to: Vec3, group: &BTreeSet<usize>) -> bool {
        let is_other = |triangle: u32| {
            let thing = self.of_triangle[triangle as usize] as usize;
            !group.contains(&thing) && !self.list[thing].is_gone
        };
        let ray = Ray { t_max: 1.0, ..Ray::new(from, to - from) };
        from != to && self.bvh.occluded_filtered(&ray, |hit| is_other(hit.triangle))
    }

    /// Moves the things of a group. Their feet keep what is below them: it is as high as before.
    pub fn shift(&mut self, group: &BTreeSet<usize>, to: &DAffine3) {
        for &member in group {
            let thing = &mut self.list[member];
            thing.body = moved(&thing.body, to);
            thing.feet.iter_mut().for_each(|foot| *foot = place(to, *foot));
            thing.has_moved = true;
        }
    }
}

impl Thing {
    fn new(name: String, instance: i16, class: i16) -> Self {
        let body = Body::new(&name);
        Self { name, instance, class, parts: Vec::new(), body, feet: Vec::new(), below: Vec::new(), is_gone: false, has_moved: false }
    }
}

/// Some of the lowest corners of a body.
fn feet(body: &Body) -> Vec<Vec3> {
    let window = Bounds3 { min: body.bounds.min, max: body.bounds.max.with_z(body.bounds.min.z + FOOT_M) };
    let lowest: Vec<Vec3> = body.within(&window).flatten().copied().filter(|p| p.z <= window.max.z).collect();
    let step = lowest.len().div_ceil(FEET).max(1);
    lowest.into_iter().step_by(step).map(|p| p.with_z(body.bounds.min.z)).collect()
}

fn moved(body: &Body, to: &DAffine3) -> Body {
    let mut moved = Body::new(&body.name);
    for triangles in body.parts() {
        moved.push(triangles.iter().map(|t| t.map(|p| place(to, p))).collect());
    }
    moved
}

/// The map of the world that turns about the vertical axis through a point and then shifts.
pub fn turned_and_shifted(about: Vec3, turn_rad: f64, shift: DVec3) -> DAffine3 {
    let about = about.as_dvec3();
    let turn = DAffine3::from_rotation_z(turn_rad);
    DAffine3 { translation: about + shift - turn.transform_vector3(about), ..turn }
}
