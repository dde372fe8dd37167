//! Windows as portals: the environment reaches a room through them only, so its light is sampled there.
//!
//! A box is fitted around the room such that rays to the sky cross as little of its faces as possible: its faces are then in the planes of
//! the windows. Where light passes, the faces are covered with rectangular portals. Every direction from within the box leaves it in one
//! point, hence through at most one portal, so a density costs the same for any number of windows. Portals are sampled uniformly over their
//! area, regardless of the sky behind them: the simplest form of what Bitterli, Novák & Jarosz 2015, "Portal-Masked Environment Map
//! Sampling", do exactly.

use enfilade_math::{Bounds3, Mat3, Vec3};

/// Cells along the longest side of the box, by which light that passes is found.
const CELLS: f32 = 48.0;
/// Cells along a portal's side, at first: portals are small, so that one may be seen where another one is not.
const PORTAL_CELLS: usize = 8;
/// The most portals.
const MAX_PORTALS: usize = 32;
/// Least number of rays to the sky that are enough to find where its light comes from.
const MIN_GLIMPSES: usize = 64;
/// Rays that place the box, at most.
const PLACING: usize = 3000;
/// A box of whose surface more than this fraction is open is no room.
const OPEN: f32 = 0.3;
/// Positions tried for each side of the box.
const POSITIONS: usize = 24;
/// The box is larger than what it was placed around by this fraction of its longest side.
const MARGIN: f32 = 5e-4;
/// Points nearer to a portal's plane than this do not sample it, in metres: they see it edge-on.
const MIN_HEIGHT_M: f32 = 1e-3;

/// Results of random walks through a scene: surfaces, and directions in which the sky is visible from them.
#[derive(Debug, Default)]
pub(super) struct Glimpses {
    /// Places of surfaces and their normals.
    pub surfaces: Vec<(Vec3, Vec3)>,
    /// Rays that met nothing: where from and in which unit direction.
    pub escapes: Vec<(Vec3, Vec3)>,
}

/// The openings of a room, on the faces of a box.
#[derive(Clone, Debug)]
pub(super) struct Windows {
    /// A rotation about the vertical that aligns the walls with the axes of the box.
    box_from_world: Mat3,
    bounds: Bounds3,
    /// Portals of each face, tile by tile.
    faces: Vec<Face>,
    portals: Vec<Portal>,
}

/// A face's tiles: a number of portal or none.
#[derive(Clone, Debug)]
struct Face {
    size: [usize; 2],
    tile: f32,
    portals: Vec<u16>,
}

/// A rectangle through which the sky is seen.
#[derive(Clone, Copy, Debug)]
struct Portal {
    /// The face's axis; the other two are its own.
    axis: usize,
    /// Box coordinates.
    min: Vec3,
    max: Vec3,
    area: f32,
}

const NO_PORTAL: u16 = u16::MAX;

impl Windows {
    /// Finds the windows of the room that contains most of the surfaces seen. `None` when it is open or closed on all sides.
    pub fn find(seen: &Glimpses) -> Option<Self> {
        if seen.escapes.len() < MIN_GLIMPSES {
            return None;
        }
        let box_from_world = along_walls(&seen.surfaces);
        let surfaces: Vec<Vec3> = seen.surfaces.iter().map(|(p, _)| box_from_world * *p).collect();
        let escapes: Vec<(Vec3, Vec3)> = seen.escapes.iter().map(|(p, d)| (box_from_world * *p, box_from_world * *d)).collect();
        let bounds = place_box(&surfaces, &escapes);
        // Points of walls on its faces count as inside in spite of rounding.
        let margin = Vec3::splat(MARGIN * bounds.extent().max_element());
        let bounds = Bounds3 { min: bounds.min - margin, max: bounds.max + margin };
        let cell = bounds.extent().max_element() / CELLS;
        let crossings = Crossings::new(bounds, cell, &escapes);
        let e = bounds.extent();
        let surface = 2.0 * (e.x * e.y + e.y * e.z + e.z * e.x);
        if crossings.open_area() > OPEN * surface {
            return None;
        }
        let mut portal_cells = PORTAL_CELLS;
        loop {
            let (faces, portals) = crossings.portals(bounds, portal_cells);
            if portals.len() <= MAX_PORTALS {
                return (!portals.is_empty()).then_some(Self { box_from_world, bounds, faces, portals });
            }
            portal_cells *= 2;
        }
    }

    /// Number of portals.
    pub fn len(&self) -> usize {
        self.portals.len()
    }

    /// Roughly the solid angle of a portal seen from `p`; zero from outside the room.
    pub fn solid_angle(&self, portal: usize, p: Vec3) -> f32 {
        let p = self.box_from_world * p;
        let portal = &self.portals[portal];
        let to = 0.5 * (portal.min + portal.max) - p;
        if self.bounds.contains(p) { portal.area / (to.length_squared() + portal.area) } else { 0.0 }
    }

    /// A direction from `p` through a portal. `None` from outside the room or from the portal's own plane.
    #[inline]
    pub fn sample(&self, portal: usize, p: Vec3, u: [f32; 2]) -> Option<Vec3> {
        let p = self.box_from_world * p;
        let portal = &self.portals[portal];
        if !self.bounds.contains(p) || (p[portal.axis] - portal.min[portal.axis]).abs() < MIN_HEIGHT_M {
            return None;
        }
        let at = portal.place(u);
        Some(self.box_from_world.transpose() * (at - p).try_normalize()?)
    }

    /// Entry point into the room of light in the unit direction `d`, for `u` uniform on [0,1)³, and the area that it crosses there over its
    /// probability, m². `None` from a portal that it leaves through.
    pub fn entry(&self, d: Vec3, u: [f32; 3]) -> Option<(Vec3, f32)> {
        let count = self.portals.len();
        let portal = &self.portals[((u[2] * count as f32) as usize).min(count - 1)];
        let inwards = (self.bounds.center() - portal.min)[portal.axis].signum() * (self.box_from_world * d)[portal.axis];
        let at = portal.place([u[0], u[1]]);
        (inwards > 0.0).then(|| (self.box_from_world.transpose() * at, inwards * portal.area * count as f32))
    }

    /// The portal that the unit direction `d` from `p` passes, and the density per solid angle with which [`Windows::sample`] finds it
    /// there.
    #[inline]
    pub fn find_portal(&self, p: Vec3, d: Vec3) -> Option<(usize, f32)> {
        let (p, d) = (self.box_from_world * p, self.box_from_world * d);
        let (face, t) = exit(&self.bounds, p, d)?;
        let axis = face / 2;
        let at = p + d * t;
        let index = self.faces[face].portal_at(&self.bounds, axis, at)?;
        let portal = &self.portals[index];
        let inside = others(axis).iter().all(|&k| at[k] >= portal.min[k] && at[k] <= portal.max[k]);
        if !inside || (p[axis] - portal.min[axis]).abs() < MIN_HEIGHT_M {
            return None;
        }
        Some((index, t * t / (portal.area * d[axis].abs())))
    }
}

impl Portal {
    /// A place on it, in box coordinates, uniform for `u` uniform on [0,1)².
    #[inline]
    fn place(&self, u: [f32; 2]) -> Vec3 {
        let mut at = self.min;
        for (k, u) in others(self.axis).into_iter().zip(u) {
            at[k] += u * (self.max[k] - self.min[k]);
        }
        at
    }
}

impl Face {
    fn portal_at(&self, bounds: &Bounds3, axis: usize, at: Vec3) -> Option<usize> {
        let [x, y] = others(axis).map(|k| ((at[k] - bounds.min[k]) / self.tile).max(0.0) as usize);
        let portal = self.portals[y.min(self.size[1] - 1) * self.size[0] + x.min(self.size[0] - 1)];
        (portal != NO_PORTAL).then_some(usize::from(portal))
    }
}

/// Counts of rays that leave a box, in the cells of its faces.
struct Crossings {
    cell: f32,
    size: [[usize; 2]; 6],
    counts: [Vec<u32>; 6],
}

impl Crossings {
    fn new(bounds: Bounds3, cell: f32, escapes: &[(Vec3, Vec3)]) -> Self {
        let size = std::array::from_fn(|face| others(face / 2).map(|k| (bounds.extent()[k] / cell) as usize + 1));
        let mut crossings = Self { cell, size, counts: size.map(|[w, h]| vec![0; w * h]) };
        for &(p, d) in escapes {
            if let Some((face, t)) = exit(&bounds, p, d) {
                let at = p + d * t;
                let [x, y] = others(face / 2).map(|k| ((at[k] - bounds.min[k]) / cell).max(0.0) as usize);
                let [w, h] = crossings.size[face];
                crossings.counts[face][y.min(h - 1) * w + x.min(w - 1)] += 1;
            }
        }
        crossings
    }

    /// Square metres of the cells that light passes.
    fn open_area(&self) -> f32 {
        let cells = self.counts.iter().flatten().filter(|&&count| count > 0).count();
        cells as f32 * self.cell * self.cell
    }

    /// Covers the open cells with portals of at most `side` cells along a side.
    fn portals(&self, bounds: Bounds3, side: usize) -> (Vec<Face>, Vec<Portal>) {
        let mut portals = Vec::new();
        let mut faces = Vec::new();
        for face in 0..6 {
            let (axis, [a, b]) = (face / 2, others(face / 2));
            let [w, h] = self.size[face];
            let size = [w.div_ceil(side), h.div_ceil(side)];
            let mut tiles = vec![NO_PORTAL; size[0] * size[1]];
            for (tile, slot) in tiles.iter_mut().enumerate() {
                let (x0, y0) = (tile % size[0] * side, tile / size[0] * side);
                let open = |x: &usize, y: &usize| self.counts[face][y * w + x] > 0;
                let cells = (y0..h.min(y0 + side)).flat_map(|y| (x0..w.min(x0 + side)).map(move |x| (x, y))).filter(|(x, y)| open(x, y));
                let range = cells.fold(None, |range: Option<[usize; 4]>, (x, y)| {
                    let [xl, xh, yl, yh] = range.unwrap_or([x, x, y, y]);
                    Some([xl.min(x), xh.max(x), yl.min(y), yh.max(y)])
                });
                let Some([xl, xh, yl, yh]) = range else { continue };
                let mut min = Vec3::splat(if face.is_multiple_of(2) { bounds.max[axis] } else { bounds.min[axis] });
                let mut max = min;
                (min[a], max[a]) = (bounds.min[a] + xl as f32 * self.cell, bounds.min[a] + (xh + 1) as f32 * self.cell);
                (min[b], max[b]) = (bounds.min[b] + yl as f32 * self.cell, bounds.min[b] + (yh + 1) as f32 * self.cell);
                // The last cells may reach beyond the box, where no direction from within arrives.
                let max = max.min(bounds.max).max(min);
                let area = (max[a] - min[a]) * (max[b] - min[b]);
                if area > 0.0 && portals.len() < usize::from(NO_PORTAL) {
                    *slot = portals.len() as u16;
                    portals.push(Portal { axis, min, max, area });
                }
            }
            faces.push(Face { size, tile: side as f32 * self.cell, portals: tiles });
        }
        (faces, portals)
    }
}

/// The face of the box through which a ray from within leaves it (2·axis, +1 on the lower side), and where. `None` from outside.
#[inline]
fn exit(bounds: &Bounds3, p: Vec3, d: Vec3) -> Option<(usize, f32)> {
    if !bounds.contains(p) {
        return None;
    }
    let mut nearest = (0, f32::INFINITY);
    for axis in 0..3 {
        let t = if d[axis] > 0.0 {
            (bounds.max[axis] - p[axis]) / d[axis]
        } else if d[axis] < 0.0 {
            (bounds.min[axis] - p[axis]) / d[axis]
        } else {
            continue;
        };
        if t < nearest.1 {
            nearest = (2 * axis + usize::from(d[axis] < 0.0), t);
        }
    }
    nearest.1.is_finite().then_some(nearest)
}

/// The two axes of a face.
#[inline]
fn others(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// The rotation about the vertical that takes most walls to the axes: the phase of the fourfold turned normals.
fn along_walls(surfaces: &[(Vec3, Vec3)]) -> Mat3 {
    let (sin, cos) = surfaces.iter().filter(|(_, n)| n.z.abs() < 0.2).fold((0.0f64, 0.0f64), |(sin, cos), (_, n)| {
        let (s, c) = (4.0 * f64::from(n.y).atan2(f64::from(n.x))).sin_cos();
        (sin + s, cos + c)
    });
    Mat3::from_rotation_z(-(sin.atan2(cos) / 4.0) as f32)
}

/// The box around most of the surfaces whose faces the rays to the sky cross in the smallest area. Each side is tried at positions of
/// surfaces, and then near the best position.
fn place_box(surfaces: &[Vec3], escapes: &[(Vec3, Vec3)]) -> Bounds3 {
    let all = Bounds3::from_points(surfaces.iter().copied());
    let thin = |n: usize| n.div_ceil(PLACING).max(1);
    let rays: Vec<(Vec3, Vec3)> = escapes.iter().step_by(thin(escapes.len())).copied().collect();
    let points: Vec<Vec3> = surfaces.iter().step_by(thin(surfaces.len())).copied().collect();
    let cost = |bounds: Bounds3| {
        let held = points.iter().filter(|p| bounds.contains(**p)).count() as f32 / points.len() as f32;
        let cell = (bounds.extent().max_element() / CELLS).max(1e-3);
        let crossings = Crossings::new(bounds, cell, &rays);
        // An area that nothing crosses is no better than one cell.
        (crossings.open_area() + cell * cell) / held.powi(4).max(1e-6)
    };
    let mut best = all;
    let mut lowest = cost(best);
    for round in 0..3 {
        for side in 0..6 {
            let (axis, lower) = (side / 2, side % 2 == 1);
            let positions: Vec<f32> = if round == 0 {
                let mut sorted: Vec<f32> = points.iter().map(|p| p[axis]).collect();
                sorted.sort_by(f32::total_cmp);
                // The outer half on this side, a little beyond each surface.
                let pick = |k: usize| sorted[(k * (sorted.len() / 2)) / POSITIONS];
                let opposite = |k: usize| sorted[sorted.len() - 1 - (k * (sorted.len() / 2)) / POSITIONS];
                (0..POSITIONS).map(|k| if lower { pick(k) } else { opposite(k) }).collect()
            } else {
                let now = if lower { best.min[axis] } else { best.max[axis] };
                let reach = best.extent()[axis] * if round == 1 { 0.1 } else { 0.02 };
                (0..POSITIONS).map(|k| now + reach * (k as f32 / (POSITIONS - 1) as f32 * 2.0 - 1.0)).collect()
            };
            for position in positions {
                let mut bounds = best;
                if lower {
                    bounds.min[axis] = position;
                } else {
                    bounds.max[axis] = position;
                }
                if bounds.extent().min_element() <= 0.0 {
                    continue;
                }
                let found = cost(bounds);
                if found < lowest {
                    (best, lowest) = (bounds, found);
                }
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{Onb, Rng, Vec2, warp};

    /// Glimpses from the walls of a turned room of 4 × 5 × 3 m with a window of 1.2 × 1 m in the wall at x = 4, 0.2 m thick.
    fn room(turn_rad: f32, rays: usize) -> (Glimpses, Mat3) {
        let turn = Mat3::from_rotation_z(turn_rad);
        let size = Vec3::new(4.0, 5.0, 3.0);
        let mut rng = Rng::new(1);
        let mut seen = Glimpses::default();
        for i in 0..rays {
            let axis = i % 3;
            let mut p = Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * size;
            let mut n = Vec3::ZERO;
            n[axis] = if rng.next_f32() < 0.5 { 1.0 } else { -1.0 };
            p[axis] = if n[axis] > 0.0 { 0.0 } else { size[axis] };
            seen.surfaces.push((turn * p, turn * n));
            let d = Onb::from_z(n).to_world(warp::cosine_hemisphere([rng.next_f32(), rng.next_f32()]));
            let through = |x: f32| {
                let at = p + d * ((x - p.x) / d.x);
                (at - Vec3::new(x, 2.0, 1.0)).cmpge(Vec3::splat(-1e-4)).all() && at.y <= 3.2 && at.z <= 2.0
            };
            if d.x > 0.0 && n.x >= 0.0 && through(4.0) && through(4.2) {
                seen.escapes.push((turn * p, turn * d));
            }
        }
        (seen, turn)
    }

    #[test]
    fn a_window_is_found_where_it_is_in_a_turned_room() {
        let (seen, turn) = room(0.4, 60_000);
        let windows = Windows::find(&seen).unwrap();
        let area: f32 = windows.portals.iter().map(|p| p.area).sum();
        assert!((1.0..1.8).contains(&area), "{area} m² of portals for a window of 1.2 m²");
        let covered = seen.escapes.iter().filter(|(p, d)| windows.find_portal(*p, *d).is_some()).count();
        assert!(covered as f32 > 0.98 * seen.escapes.len() as f32, "{covered} of {}", seen.escapes.len());
        // From outside there are no portals.
        assert_eq!(windows.find_portal(turn * Vec3::new(9.0, 2.5, 1.5), turn * Vec3::NEG_X), None);
        assert!(windows.sample(0, turn * Vec3::new(9.0, 2.5, 1.5), [0.5; 2]).is_none());
    }

    #[test]
    fn in_the_open_and_in_closed_rooms_there_are_no_windows() {
        let mut rng = Rng::new(2);
        let mut seen = Glimpses::default();
        for _ in 0..5000 {
            let p = Vec2::new(rng.next_f32(), rng.next_f32()).extend(0.0) * 10.0;
            seen.surfaces.push((p, Vec3::Z));
            seen.escapes.push((p, warp::cosine_hemisphere([rng.next_f32(), rng.next_f32()])));
        }
        assert!(Windows::find(&seen).is_none());
        seen.escapes.clear();
        assert!(Windows::find(&seen).is_none());
    }

    #[test]
    fn light_enters_through_the_area_that_it_crosses() {
        let (seen, turn) = room(0.7, 60_000);
        let windows = Windows::find(&seen).unwrap();
        // From outside at 60° from the window's normal: half of its 1.2 m².
        let direction = turn * Vec3::new(-0.5, 0.0, -0.75f32.sqrt());
        let mut rng = Rng::new(4);
        let n = 20_000;
        let mut area = 0.0;
        for _ in 0..n {
            let Some((p, crossed)) = windows.entry(direction, [rng.next_f32(), rng.next_f32(), rng.next_f32()]) else { continue };
            let at = turn.transpose() * p;
            if (2.0..3.2).contains(&at.y) && (1.0..2.0).contains(&at.z) {
                assert!((3.9..4.3).contains(&at.x), "{at}");
                area += crossed / n as f32;
            }
        }
        assert!((area - 0.6).abs() < 0.06, "{area} m²");
        assert!(windows.entry(-direction, [0.5; 3]).is_none());
    }

    #[test]
    fn directions_through_portals_follow_their_density() {
        let (seen, turn) = room(-0.3, 30_000);
        let windows = Windows::find(&seen).unwrap();
        let p = turn * Vec3::new(1.0, 2.0, 1.2);
        for portal in 0..windows.len() {
            let Portal { axis, min, max, area } = windows.portals[portal];
            let [a, b] = others(axis);
            let eye = windows.box_from_world * p;
            let place = |d: Vec3| {
                let d = windows.box_from_world * d;
                let at = eye + d * ((min[axis] - eye[axis]) / d[axis]);
                [a, b].map(|k| ((at[k] - min[k]) / (max[k] - min[k])).clamp(0.0, 1.0))
            };
            let density = |[x, y]: [f32; 2]| {
                let mut at = min;
                at[a] += x * (max[a] - min[a]);
                at[b] += y * (max[b] - min[b]);
                let to = at - eye;
                let d = to.normalize();
                let found = windows.find_portal(p, windows.box_from_world.transpose() * d);
                found.map_or(0.0, |(index, pdf)| if index == portal { pdf * area * d[axis].abs() / to.length_squared() } else { 0.0 })
            };
            let test = enfilade_testkit::ChiSquare::square(50_000, |u| windows.sample(portal, p, [u[0], u[1]]).map(place), density);
            test.assert("portal", windows.len());
        }
    }
}
