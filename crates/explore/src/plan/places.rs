//! The places that a camera can get to: voxels with room around them that hang together with the start's.

use super::rules::Rules;
use enfilade_geometry::VoxelKey;
use enfilade_math::{DVec3, Rng};
use std::collections::HashMap;

/// More places than this are not looked for: a scene that leaks has any number of them. The nearest come first.
const MAX_PLACES: usize = 1_000_000;

/// Additional clearance of ways between places, in voxels, so that every point on them is clear, and every point looked at.
const MARGIN_VOXELS: f64 = 0.625;

/// Where a band of heights is thinner than a voxel, places keep this share of its width from its ends, so that the ways between them stay
/// in the band too.
const BAND_MARGIN: f64 = 0.1;

/// Points of free voxels, mostly their centres, with room around them, in the order of the way from the start through their faces.
pub(super) struct Places {
    pub points: Vec<DVec3>,
    keys: Vec<VoxelKey>,
    /// Only ever asked for single keys, so its own order is of no consequence.
    index: HashMap<[u16; 3], u32>,
    /// There were more than are here.
    pub is_cut: bool,
}

impl Places {
    /// All places from the first one, which is nearest to `start`, on for which `allowed(first, place)`. Empty when there is none near the
    /// start.
    pub fn around(rules: &Rules, start: DVec3, allowed: impl Fn(DVec3, DVec3) -> bool) -> Self {
        let tree = &rules.space.tree;
        let clearance = rules.config.clearance_m + MARGIN_VOXELS * tree.resolution_m();
        let is_place =
            |p: DVec3| rules.is_free(p) && !tree.any_within(p, clearance, enfilade_geometry::Voxel::Occupied) && rules.is_at_height(p);
        let mut places = Self { points: Vec::new(), keys: Vec::new(), index: HashMap::new(), is_cut: false };
        let Some((first, origin)) = nearest(rules, start, &is_place) else { return places };
        places.add(first, origin);
        let mut done = 0;
        while done < places.keys.len() && !places.is_cut {
            for next in neighbours(places.keys[done]) {
                if places.index.contains_key(&next.0) {
                    continue;
                }
                let p = point(rules, next);
                if allowed(origin, p) && is_place(p) {
                    places.add(next, p);
                }
            }
            done += 1;
            places.is_cut = places.keys.len() >= MAX_PLACES;
        }
        places
    }

    fn add(&mut self, key: VoxelKey, p: DVec3) {
        self.index.insert(key.0, self.keys.len() as u32);
        self.keys.push(key);
        self.points.push(p);
    }

    /// Indices of all places in random order.
    pub fn shuffled(&self, rng: &mut Rng) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        rng.shuffle(&mut order);
        order
    }

    /// For every place, the neighbour through which the shortest way from `from` comes (its own index for `from`), and the number of
    /// steps of that way.
    pub fn ways_from(&self, from: usize) -> Vec<(u32, u32)> {
        let mut ways = vec![(u32::MAX, u32::MAX); self.points.len()];
        ways[from] = (from as u32, 0);
        let mut queue = std::collections::VecDeque::from([from]);
        while let Some(here) = queue.pop_front() {
            for next in neighbours(self.keys[here]) {
                let Some(&next) = self.index.get(&next.0) else { continue };
                if ways[next as usize].0 == u32::MAX {
                    ways[next as usize] = (here as u32, ways[here].1 + 1);
                    queue.push_back(next as usize);
                }
            }
        }
        ways
    }
}

/// The point that represents a voxel: its centre, or where a band of heights is thinner than a voxel and leaves out the centre, the
/// point above or below it in the band, if there is one in the voxel.
fn point(rules: &Rules, key: VoxelKey) -> DVec3 {
    let (center, voxel_m) = (rules.space.tree.center(key), rules.space.tree.resolution_m());
    let Some([min, max]) = rules.config.camera_height_m.filter(|[min, max]| max - min < voxel_m) else { return center };
    if !rules.is_free(center) || rules.is_at_height(center) {
        return center;
    }
    let Some(height_m) = rules.height_m(center) else { return center };
    let margin = BAND_MARGIN * (max - min);
    let up = height_m.clamp(min + margin, max - margin) - height_m;
    if up.abs() < 0.5 * voxel_m { center + up * DVec3::Z } else { center }
}

/// The place nearest to `start` that it sees, up to a metre away.
fn nearest(rules: &Rules, start: DVec3, is_place: &impl Fn(DVec3) -> bool) -> Option<(VoxelKey, DVec3)> {
    let tree = &rules.space.tree;
    let home = tree.key(start)?;
    let reach = (1.0 / tree.resolution_m()).ceil().clamp(1.0, 30.0) as i32;
    let mut near = Vec::new();
    for (x, y, z) in (-reach..=reach).flat_map(|x| (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |z| (x, y, z)))) {
        let shifted = |k: u16, by: i32| u16::try_from(i32::from(k) + by).ok();
        if let (Some(x), Some(y), Some(z)) = (shifted(home.0[0], x), shifted(home.0[1], y), shifted(home.0[2], z)) {
            near.push(VoxelKey([x, y, z]));
        }
    }
    near.sort_by(|a, b| tree.center(*a).distance_squared(start).total_cmp(&tree.center(*b).distance_squared(start)));
    near.into_iter().map(|key| (key, point(rules, key))).find(|(_, p)| is_place(*p) && rules.sees(start, *p))
}

/// The six voxels behind the faces of one.
fn neighbours(key: VoxelKey) -> impl Iterator<Item = VoxelKey> {
    [(0, 1i32), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1)].into_iter().filter_map(move |(axis, by)| {
        let mut next = key;
        next.0[axis] = u16::try_from(i32::from(key.0[axis]) + by).ok()?;
        Some(next)
    })
}
