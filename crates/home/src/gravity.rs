//! Moves things that float or run into something a little, so that they rest and are free.
//!
//! A thing that floats is lowered until it lies on what is below it, by the exact height between their triangles. One that runs into
//! something is moved by the shortest step, up or sideways, that sets it free, and lowered again. Things that rest on it move with it. Both
//! move a few centimetres at most; things that would have to move further stay, for [`crate::settle`] to remove.

use crate::check::contact::{Contacts, core, cores_meet, cuts, touches};
use crate::shell::is_shell;
use enfilade_furniture::meet::{Body, Triangle, overlap};
use enfilade_math::{Bounds3, Vec2, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// Largest height that a thing falls, metres: a thing that floats higher was not meant to lie there.
const FALL: f32 = 0.12;
/// Steps by which things are moved out of each other, metres.
const STEPS: [f32; 10] = [0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.065, 0.08, 0.1];
/// Distance that is left between what has fallen and what it lies on, metres: contact without faces in one plane.
const REST: f32 = 0.0005;
/// Most moves of an object.
const MOVES: usize = 4;

/// Moves `bodies` into places where they neither float nor run into others, where there are such. Returns how far each was moved.
pub fn settle(bodies: &mut [Body], contacts: &mut Contacts) -> BTreeMap<usize, Vec3> {
    let mut pile = Pile { bodies, contacts };
    let mut moves: BTreeMap<usize, usize> = BTreeMap::new();
    let mut moved: BTreeMap<usize, Vec3> = BTreeMap::new();
    let mut given_up = BTreeSet::new();
    while let Some(group) = pile.misplaced(&given_up) {
        let root = group[0];
        let tries = moves.entry(root).or_default();
        *tries += 1;
        // A step of zero gains nothing: it means that the object runs into something that it carries.
        let step = if *tries > MOVES { None } else { pile.way_out(&group).filter(|by| *by != Vec3::ZERO) };
        match step {
            None => _ = given_up.insert(root),
            Some(by) => {
                pile.shift(&group, by);
                group.iter().for_each(|&i| *moved.entry(i).or_default() += by);
            }
        }
    }
    moved
}

/// Bodies and what is known of their contacts.
struct Pile<'a> {
    bodies: &'a mut [Body],
    contacts: &'a mut Contacts,
}

impl Pile<'_> {
    /// An object that floats or runs into another, first, and all that goes where it goes; the lowest one that `given_up` lacks.
    fn misplaced(&self, given_up: &BTreeSet<usize>) -> Option<Vec<usize>> {
        let all = self.contacts.carried(self.bodies, |_| true);
        let low = |i: &usize| self.bodies[*i].bounds.min.z;
        let floating = (0..all.len()).filter(|&i| !all[i] && !given_up.contains(&i)).min_by(|a, b| low(a).total_cmp(&low(b)));
        if let Some(root) = floating {
            return Some(self.hanging_together(root, &all));
        }
        let movable = |i: usize| !is_shell(&self.bodies[i].name) && !given_up.contains(&i);
        let mut either: Vec<usize> = Vec::new();
        for &(a, b) in &self.contacts.meeting {
            // The smaller one gives way, and the larger one where it cannot.
            let [small, large] = if self.bodies[a].volume() < self.bodies[b].volume() { [a, b] } else { [b, a] };
            either.extend([small, large].into_iter().find(|&i| movable(i)));
        }
        let root = either.into_iter().min_by(|a, b| low(a).total_cmp(&low(b)))?;
        let without = self.contacts.carried(self.bodies, |i| i != root);
        // Things that lie on it move with it, even if something else would support them.
        let middle = self.bodies[root].bounds.center().z;
        let lies_on = |i: usize| low(&i) > middle && self.contacts.touching.contains(&(i.min(root), i.max(root)));
        let goes_along = |&i: &usize| i != root && !is_shell(&self.bodies[i].name) && all[i] && (!without[i] || lies_on(i));
        Some([root].into_iter().chain((0..all.len()).filter(goes_along)).collect())
    }

    /// `root`, and all that floats together with it.
    fn hanging_together(&self, root: usize, carried: &[bool]) -> Vec<usize> {
        let mut group = vec![root];
        let mut k = 0;
        while k < group.len() {
            for &(a, b) in &self.contacts.touching {
                let other = if a == group[k] { b } else { a };
                if (a == group[k] || b == group[k]) && !carried[other] && !group.contains(&other) {
                    group.push(other);
                }
            }
            k += 1;
        }
        group
    }

    /// The shortest step after which `group` is carried and free of all others.
    fn way_out(&self, group: &[usize]) -> Option<Vec3> {
        let without = self.contacts.carried(self.bodies, |i| !group.contains(&i));
        let around = group.iter().fold(Bounds3::EMPTY, |all, &i| all.union(self.bodies[i].bounds));
        let reach = Vec3::splat(FALL.max(STEPS[STEPS.len() - 1]) + 0.01);
        let window = Bounds3 { min: around.min - reach, max: around.max + reach };
        let near: Vec<usize> =
            (0..self.bodies.len()).filter(|i| !group.contains(i) && self.bodies[*i].boxes().any(|b| overlap(&b, &window, 0.0))).collect();
        let [own_cores, their_cores] = [group, &near].map(|some| some.iter().map(|&i| core(&self.bodies[i])).collect::<Vec<_>>());
        let meets = |g: usize, i: usize, by: Vec3| {
            let pair = [&self.bodies[group[g]], &self.bodies[near[i]]];
            cuts(pair[0], pair[1], by) && cores_meet(pair, [own_cores[g].as_ref(), their_cores[i].as_ref()], by)
        };
        let free = |by: Vec3| !(0..near.len()).any(|i| (0..group.len()).any(|g| meets(g, i, by)));
        let held = |by: Vec3| near.iter().any(|&i| without[i] && group.iter().any(|&g| touches(&self.bodies[g], &self.bodies[i], by)));
        let settled = |by: Vec3| {
            if !free(by) {
                return None;
            }
            if held(by) {
                return Some(by);
            }
            let down = by - Vec3::Z * (self.height_above(group, &near, by)? - REST).max(0.0);
            (free(down) && held(down)).then_some(down)
        };
        let up_or_aside = STEPS.into_iter().flat_map(|step| directions().map(move |way| way * step));
        [Vec3::ZERO].into_iter().chain(up_or_aside).find_map(settled)
    }

    /// How far `group`, moved by `by`, can fall until it lies on one of `others`; `None` when that is too far.
    fn height_above(&self, group: &[usize], others: &[usize], by: Vec3) -> Option<f32> {
        let mut lowest = FALL + by.z.max(0.0);
        let mut found = false;
        for &g in group {
            let bounds = self.bodies[g].bounds;
            let column = Bounds3 { min: bounds.min + by - Vec3::Z * lowest, max: bounds.max + by };
            for &i in others {
                let below: Vec<Triangle> = self.bodies[i].within(&column).copied().collect();
                if below.is_empty() {
                    continue;
                }
                let over = self.bodies[i].bounds;
                let own = Bounds3 { min: over.min - by, max: over.max - by + Vec3::Z * lowest };
                let above: Vec<Triangle> = self.bodies[g].within(&own).map(|t| t.map(|p| p + by)).collect();
                if let Some(height) = height_between(&above, &below, lowest) {
                    (lowest, found) = (height, true);
                }
            }
        }
        found.then_some(lowest)
    }

    /// Moves `group`, and updates what it touches and runs into.
    fn shift(&mut self, group: &[usize], by: Vec3) {
        group.iter().for_each(|&i| self.bodies[i].shift(by));
        self.contacts.renew(self.bodies, group);
    }
}

/// Sideways, aside and up, and up.
fn directions() -> impl Iterator<Item = Vec3> {
    let around = (0..8).map(|k| Vec2::from_angle(std::f32::consts::FRAC_PI_4 * k as f32).extend(0.0));
    around.clone().chain([Vec3::Z]).chain(around.map(|way| (way + Vec3::Z).normalize()))
}

/// The smallest height of triangles above those below them where both cover the same ground, if it is less than `limit`; 0 where they cut.
pub(crate) fn height_between(above: &[Triangle], below: &[Triangle], limit: f32) -> Option<f32> {
    let left = |t: &Triangle| t[0].x.min(t[1].x).min(t[2].x);
    let mut sorted: Vec<&Triangle> = below.iter().collect();
    sorted.sort_by(|s, t| left(s).total_cmp(&left(t)));
    let mut smallest = limit;
    for a in above {
        let box_a = Bounds3::from_points(*a);
        for b in sorted.iter().take_while(|b| left(b) <= box_a.max.x) {
            let box_b = Bounds3::from_points(**b);
            let apart = box_b.max.x < box_a.min.x || box_b.max.y < box_a.min.y || box_b.min.y > box_a.max.y;
            if apart || box_b.min.z > box_a.max.z || box_a.min.z - box_b.max.z >= smallest {
                continue;
            }
            let heights = shared_ground(a, b).into_iter().filter_map(|p| Some(height_at(a, p)? - height_at(b, p)?));
            let (low, high) = heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
            if high >= 0.0 {
                smallest = smallest.min(low.max(0.0));
            }
        }
    }
    (smallest < limit).then_some(smallest)
}

/// Height of the triangle's plane over the point; `None` where it stands upright.
fn height_at([a, b, c]: &Triangle, p: Vec2) -> Option<f32> {
    let n = (*b - *a).cross(*c - *a);
    (n.z.abs() > 1e-4 * n.length()).then(|| a.z - (n.x * (p.x - a.x) + n.y * (p.y - a.y)) / n.z)
}

/// Corners of the ground that both triangles cover, seen from above (Sutherland & Hodgman 1974).
fn shared_ground(a: &Triangle, b: &Triangle) -> Vec<Vec2> {
    let mut polygon: Vec<Vec2> = a.iter().map(|p| p.truncate()).collect();
    let clip = b.map(Vec3::truncate);
    let turn = (clip[1] - clip[0]).perp_dot(clip[2] - clip[0]).signum();
    for k in 0..3 {
        let (from, to) = (clip[k], clip[(k + 1) % 3]);
        let side = |p: Vec2| turn * (to - from).perp_dot(p - from);
        let whole = std::mem::take(&mut polygon);
        for (i, &p) in whole.iter().enumerate() {
            let q = whole[(i + 1) % whole.len()];
            let (s, t) = (side(p), side(q));
            if s >= 0.0 {
                polygon.push(p);
            }
            if (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0) {
                polygon.push(p.lerp(q, s / (s - t)));
            }
        }
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::shape::{Reshape, bevelled_box, sphere};
    use enfilade_geometry::Mesh;

    fn body(name: &str, mesh: Mesh) -> Body {
        let mut body = Body::new(name);
        body.push((0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect());
        body
    }

    fn block(name: &str, size: [f32; 3], at: [f32; 3]) -> Body {
        body(name, bevelled_box(Vec3::from_array(size), 0.001).moved(Vec3::from_array(at)))
    }

    fn settled(bodies: &mut [Body]) -> BTreeMap<usize, Vec3> {
        let mut contacts = Contacts::new(bodies);
        settle(bodies, &mut contacts)
    }

    #[test]
    fn what_floats_is_lowered_exactly_and_takes_along_what_rests_on_it() {
        let floor = block("floor_hall_1", [4.0, 4.0, 0.2], [0.0, 0.0, -0.1]);
        let books = block("books_1", [0.2, 0.3, 0.1], [0.0, 0.0, 0.1]);
        let ball = body("ball_1", sphere(0.05, 32).moved(Vec3::new(0.0, 0.0, 0.201)));
        let mut bodies = [floor, books, ball];
        let moved = settled(&mut bodies);
        assert_eq!(moved.keys().copied().collect::<Vec<_>>(), [1, 2]);
        for by in moved.values() {
            assert!((*by - Vec3::new(0.0, 0.0, REST - 0.05)).length() < 1e-5, "{by}");
        }
    }

    #[test]
    fn a_ball_falls_into_a_corner_until_it_touches_a_slope() {
        // A plane that rises at 45°: a ball of radius r over height h ends h − r√2 lower.
        let slope: Triangle = [Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::new(0.0, 2.0, 0.0)];
        let ball = sphere(0.1, 64).moved(Vec3::Z * 0.3);
        let above: Vec<Triangle> = (0..ball.triangles.len()).map(|t| ball.corners(t)).collect();
        let height = height_between(&above, &[slope], 1.0).expect("the slope is below");
        assert!((height - (0.3 - 0.1 * 2.0f32.sqrt())).abs() < 2e-4, "{height}");
        assert_eq!(height_between(&above, &[slope.map(|p| p + Vec3::Z)], 1.0), None);
    }

    #[test]
    fn what_runs_into_something_steps_aside_and_what_nothing_carries_stays() {
        let floor = block("floor_hall_1", [4.0, 4.0, 0.2], [0.0, 0.0, -0.1]);
        let wall = block("wall_hall_east_1", [0.2, 4.0, 2.4], [1.0, 0.0, 1.2]);
        let laptop = block("laptop_1", [0.3, 0.2, 0.02], [0.76, 0.0, 0.0105]);
        let lamp = block("lamp_1", [0.1, 0.1, 0.1], [0.0, 0.0, 1.0]);
        let mut bodies = [floor, wall, laptop, lamp];
        let moved = settled(&mut bodies);
        assert_eq!(moved.keys().copied().collect::<Vec<_>>(), [2]);
        // It was 10 mm deep in the wall; 4 mm are allowed.
        let by = moved[&2];
        assert!((-0.0101..=-0.006).contains(&by.x) && by.length() < 0.0101 && by.z == 0.0, "{by}");
    }
}
