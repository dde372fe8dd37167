//! Things that belong to a room whoever lives in it: radiators, curtains, lamps.

use super::Furnisher;
use crate::room::{Footprint, Opening, kind};
use enfilade_furniture::{Candles, CeilingDome, CeilingLamp, Curtains, Furniture, Pendant, Plant, Radiator, Window, on};
use enfilade_math::{DAffine3, Vec2, Vec3};

/// Minimum height of a sill with a radiator below it, metres.
const RADIATOR_SILL: f32 = 0.44;
/// Height over a window that its curtains need under a sloping ceiling, metres.
const ROD: f32 = 0.12;
/// Greatest height of things on a sill, metres.
const ON_SILL: f32 = 0.32;
/// The stream of random numbers of blinds, so that they do not change what else is in a room.
const BLINDS: u64 = 0xb11d;
/// Lower end of lamps in the middle of a room, metres: above people's heads.
const PENDANT_RIM: f32 = 2.05;
/// Height above which things are in the way of a lamp, metres; things below, and doors that swing below, are not.
const OVERHEAD: f32 = 2.12;
/// Minimum height of what hangs where people walk, metres.
const HEADS: f32 = 1.98;

impl Furnisher<'_> {
    /// Adds radiators, curtains and blinds to the windows, and switches to the doors.
    pub fn fittings(&mut self) {
        let room = self.room;
        // All windows of a room have blinds of one sort.
        let hand = self.rng.fork(BLINDS);
        for window in room.windows() {
            self.radiator(window);
            self.curtains(window);
            let free = self.blinds(window, hand.clone());
            if let Some(often) = kind::row(room.kind).fittings.on_sill.filter(|_| free > ON_SILL) {
                self.on_sill(window, often);
            }
        }
        for way in room.ways() {
            self.switch(way);
        }
    }

    fn radiator(&mut self, window: &Opening) {
        if window.z[0] < RADIATOR_SILL || !kind::row(self.room.kind).fittings.radiators {
            return;
        }
        let height = (window.z[0] - 0.24).min(0.6);
        let radiator = Radiator { width: (0.7 * window.size().x).clamp(0.4, 1.4), height };
        let size = radiator.size();
        let pose = on(self.room.wall_pose(window.wall), Vec3::new(window.center_x(), 0.5 * size.y - 0.0005, 0.0), 0.0);
        self.build(&radiator, pose);
        let half = 0.5 * size.x + 0.02;
        self.floor.take(self.floor.strip(window.wall, [window.center_x() - half, window.center_x() + half], size.y + 0.02), [0.0, size.z]);
    }

    fn curtains(&mut self, window: &Opening) {
        if !self.chance(kind::row(self.room.kind).fittings.curtains) {
            return;
        }
        let half = 0.5 * self.room.length(window.wall);
        // The rod ends before walls and doors.
        let mut ends = [-half, half];
        for way in self.room.ways().filter(|o| o.wall == window.wall) {
            if way.x[1] < window.x[0] {
                ends[0] = ends[0].max(way.x[1] + 0.06);
            } else {
                ends[1] = ends[1].min(way.x[0] - 0.06);
            }
        }
        let beyond = [window.x[0] - ends[0], ends[1] - window.x[1]].map(|free| (free - 0.06).min(0.42));
        if beyond[0].min(beyond[1]) < 0.12 {
            return;
        }
        let width = self.rng.range(0.36, 0.44).min(beyond[0].min(beyond[1]) + 0.12);
        let curtains = Curtains { width, beyond };
        let around = [window.x[0] - beyond[0] - 0.04, window.x[1] + beyond[1] + 0.04];
        let ceiling = self.room.lowest_before(window.wall, around, [0.0, Curtains::DEPTH]);
        if !self.room.slopes.is_empty() && ceiling < window.z[1] + ROD {
            return;
        }
        curtains.build(self.b, &self.room.wall_opening(window), ceiling, &mut self.rng);
        let [low, high] = around;
        for x in [[low, low + width + 0.1], [high - width - 0.1, high]] {
            self.floor.take(self.floor.strip(window.wall, x, Curtains::DEPTH), [0.0, self.room.size.z]);
        }
    }

    fn on_sill(&mut self, window: &Opening, often: f32) {
        let count = if self.chance(often * self.clutter.min(1.0)) { 1 + self.rng.below(3) } else { 0 };
        for k in 0..count {
            let x = window.center_x() + window.size().x * (0.36 - 0.30 * k as f32 + self.rng.range(-0.05, 0.05));
            let sill = on(self.room.wall_pose(window.wall), Vec3::new(x, 0.0, window.z[0] + Window::SILL), 0.0);
            if k == 1 {
                self.build(&Candles { count: 2 }, sill);
            } else {
                let plant = Plant::small(self.rng.range(0.09, 0.12), self.rng.range(0.042, 0.052));
                let turn = DAffine3::from_rotation_z(f64::from(self.rng.range(0.0, 6.0)));
                self.build(&plant, sill * turn);
            }
        }
    }

    /// A flat lamp of opal glass under the ceiling, for low or wet rooms.
    pub fn dome(&mut self) {
        let own = CeilingDome { radius: self.rng.range(0.14, 0.2) };
        let highest = self.room.size.z - HEADS;
        let model = self.borrow("ceiling_lamp", &own, |size| size.z < highest);
        let lamp: &dyn Furniture = model.as_ref().map_or(&own, |model| model);
        let pose = self.room.mounting(self.room.center);
        self.build(lamp, pose);
    }

    /// Hangs a lamp in the middle of the room, above people's heads, unless one hangs over a table there.
    pub fn ceiling_lamp(&mut self) {
        self.ceiling_lamps(&self.room.middles());
    }

    /// Hangs equal lamps over points of the floor, above people's heads, but where others hang already. Under a slope they hang where the
    /// ceiling is level; where it is nowhere, a flat lamp is on the slope.
    pub fn ceiling_lamps(&mut self, points: &[Vec2]) {
        let around = |&center: &Vec2| Footprint { center, half: Vec2::splat(0.3), yaw: 0.0 };
        let is_free = |p: &Vec2| self.floor.is_free(&around(p), [OVERHEAD, self.room.size.z]);
        let level = self.room.level_places(points);
        if level.is_empty() && !points.is_empty() {
            return self.dome();
        }
        let points: Vec<Vec2> = level.into_iter().filter(is_free).collect();
        if points.is_empty() {
            return;
        }
        let longest = self.room.size.z - PENDANT_RIM;
        let other = CeilingLamp::random(&mut self.rng);
        let pendant = Pendant { drop: longest, radius: self.rng.range(0.16, 0.21), ..Pendant::random(&mut self.rng) };
        let highest = self.room.size.z - HEADS;
        let mut model = self.borrow("pendant", &pendant, |size| size.z < highest);
        if model.is_none() {
            model = self.borrow("ceiling_lamp", &pendant, |size| size.z < highest);
        }
        let own: &dyn Furniture = if other.size().z <= longest { &other } else { &pendant };
        for at in points {
            self.above(at, model.as_ref().map_or(own, |model| model));
        }
    }

    /// Hangs a lamp from the ceiling over a point of the floor.
    pub fn above(&mut self, at: Vec2, lamp: &dyn Furniture) {
        let pose = enfilade_furniture::pose(f64::from(at.x), f64::from(at.y), f64::from(self.room.size.z), 0.0);
        self.build(lamp, pose);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::tests::furnished;
    use enfilade_furniture::RoomKind;
    use enfilade_furniture::assets::Library;
    use enfilade_furniture::models::{Body, Model};
    use enfilade_furniture::shape::bevelled_box;
    use enfilade_math::{DMat3, Rgb};
    use enfilade_scene::{Material, Part, Scene};
    use std::sync::Arc;

    /// A ceiling lamp of a library, `height` metres high.
    fn lantern(height: f32) -> Model {
        let size = Vec3::new(0.4, 0.4, height);
        let read = move || {
            let part = Part { name: "shade".into(), object: None, mesh: 0, material: 0, world_from_mesh: DAffine3::IDENTITY };
            let (meshes, materials) = (vec![bevelled_box(size, 0.0).into()], vec![Material::diffuse("paper", Rgb::WHITE)]);
            Body::new(Scene { meshes, materials, parts: vec![part], ..Scene::default() }, DMat3::IDENTITY, None).map(Arc::new)
        };
        let mut model = Model::new("lantern".into(), size, vec!["ceiling_lamp"], Box::new(read));
        model.shines = true;
        model
    }

    fn dome(f: &mut Furnisher) {
        f.dome();
    }

    #[test]
    fn lamps_of_a_library_hang_above_heads_in_wet_rooms_too() {
        for (height, fits) in [(1.2, false), (0.3, true)] {
            let library = Library::new(vec![lantern(height)], 1.0);
            let (scene, _) = furnished(RoomKind::Toilet, 1, 1.0, &library, dome);
            let lowest = scene.parts.iter().flat_map(|part| scene.world_positions(part)).fold(f32::INFINITY, |low, p| low.min(p.z));
            assert!(lowest > HEADS, "{height} m: {lowest}");
            assert_eq!(scene.parts.iter().any(|part| part.name == "ceiling_lamp_1/shade"), fits, "{height} m");
        }
    }
}
