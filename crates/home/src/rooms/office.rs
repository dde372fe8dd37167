//! Offices: one desk with its visitors, or many in pairs that face each other.

use super::Furnisher;
use super::stations::Part;
use super::wishes::{by_door, by_window, centred, cornered, in_view, tucked_away};
use crate::place::{Floor, Piece, Spot};
use enfilade_furniture::office::Partition;
use enfilade_furniture::school::StackingChair;
use enfilade_furniture::study::{Computer, Desk, DeskStand, Keyboard, Monitor, Mouse, OfficeChair};
use enfilade_furniture::{Finish, Furniture, on};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f32::consts::PI;

/// Distance of the middle of an office chair from the edge of its desk, metres.
const CHAIR: f32 = 0.32;
/// Distance of an office chair's middle from the wall behind it, metres.
const BEHIND: f32 = 0.62;
/// Distance of the edge of an open office's desks from the screen between them, metres.
const SCREEN: f32 = 0.022;
/// Free floor behind the chairs of an open office, metres.
const AISLE: f32 = 0.75;

/// Furnishes an office with one desk.
pub fn furnish(f: &mut Furnisher) {
    let free = f.room.area > 10.5 && f.chance(0.6) && free_desk(f);
    if !free {
        f.work_place(by_window);
    }
    let shelf = f.perhaps(0.75, "binder_shelf", centred).or_else(|| f.furnish("bookshelf", centred));
    f.accent = shelf.and_then(|shelf| shelf.spot.wall);
    f.perhaps(0.6, "office_cabinet", tucked_away);
    f.perhaps(0.35, "filing_cabinet", tucked_away);
    if !free {
        f.perhaps(0.6, "stacking_chair", by_door);
    }
    f.hang_one(0.6, "whiteboard", 1.5, in_view);
    f.hang_one(0.4, "pin_board", 1.5, |_, s| s.x.abs());
    f.perhaps(0.5, "coat_stand", by_door);
    f.perhaps(0.7, "waste_bin", by_window);
    f.perhaps(0.6, "plant", cornered);
    f.art(1, in_view);
    f.work_lights();
}

/// A desk across the room: its chair has the wall behind it, and visitors sit before it.
fn free_desk(f: &mut Furnisher) -> bool {
    let Some(chair) = f.any("office_chair") else { return false };
    let visitor = StackingChair::random(&mut f.rng);
    for visitors in [2, 1, 1, 0] {
        let Some(desk) = f.any("desk") else { return false };
        let size = desk.size();
        let edge = BEHIND + CHAIR;
        let mut parts = vec![
            Part::new(desk.as_ref(), [0.0, edge + 0.5 * size.y], PI),
            Part::new(chair.as_ref(), [0.0, BEHIND], f.rng.range(-0.3, 0.3)),
        ];
        for k in 0..visitors {
            let x = if visitors == 1 { 0.1 } else { 0.33 * (2.0 * k as f32 - 1.0) };
            parts.push(Part::new(&visitor, [x, edge + size.y + 0.36], PI + f.rng.range(-0.25, 0.25)));
        }
        let cost = |floor: &Floor, s: &Spot| {
            let windows = floor.room().windows().filter(|window| Some(window.wall) == s.wall).count() as f32;
            s.x.abs() + 0.6 * windows - floor.to_way(s.origin)
        };
        let Some(poses) = f.once(f.floor.along_walls(size.x.max(0.9)), &parts, cost) else { continue };
        f.plugs.push(poses[0].translation.truncate().as_vec2());
        f.litter(&desk.surfaces(), poses[0], 1.3);
        return true;
    }
    false
}

/// What all desks of a room have in common.
pub(super) struct Workplaces {
    desk: Desk,
    chair: OfficeChair,
    monitor: Monitor,
    /// Probability that a desk has two screens.
    twice: f32,
}

impl Workplaces {
    /// Desks of this width.
    pub fn new(width: f32, rng: &mut Rng) -> Self {
        let stand = [DeskStand::Columns, DeskStand::Columns, DeskStand::Drawers(1), DeskStand::Drawers(-1)][rng.below(4)];
        let finish = [Finish::WhiteLacquer, Finish::Wood, Finish::WhiteLacquer, Finish::DarkWood][rng.below(4)];
        let monitor = Monitor { shows: None, ..Monitor::random(rng) };
        let monitor = if monitor.width > 0.7 { Monitor { width: 0.56, aspect: 16.0 / 9.0, ..monitor } } else { monitor };
        let desk = Desk { width, depth: 0.8, stand, finish, computer: Computer::Nothing };
        Self { desk, chair: OfficeChair::random(rng), monitor, twice: [0.0, 0.4, 0.8][rng.below(3)] }
    }

    /// Width and depth of a desk, and the height of what is on it.
    pub fn size(&self) -> Vec3 {
        let screen = Computer::Screen(self.monitor, Keyboard { columns: 15, white: false }, Mouse { pad: false, white: false });
        Desk { computer: screen, ..self.desk }.size()
    }

    /// The room that a chair needs.
    pub fn chair(&self) -> Vec3 {
        self.chair.size()
    }

    /// One of the desks: with a computer that is on or off, or a laptop, or nothing.
    fn desk(&self, rng: &mut Rng) -> Desk {
        let usual = || Computer::Screen(self.monitor, Keyboard { columns: 15, white: false }, Mouse { pad: false, white: false });
        let computer = match (usual(), rng.below(10)) {
            (_, 0) => Computer::Nothing,
            (Computer::Screen(monitor, keyboard, mouse), 1..) => {
                let shows = (rng.below(3) > 0).then(|| rng.below(4) as u8);
                Computer::Screen(Monitor { shows, ..monitor }, Keyboard { white: rng.below(2) == 0, ..keyboard }, mouse)
            }
            (other, _) => other,
        };
        Desk { computer, ..self.desk }
    }

    /// Builds a desk with what is on it, and its chair.
    pub fn build(&self, f: &mut Furnisher, desk_pose: DAffine3, chair_pose: DAffine3, density: f32) {
        let desk = self.desk(&mut f.rng);
        f.build(&desk, desk_pose);
        let aside = desk.seat().x;
        let second = matches!(desk.computer, Computer::Screen(..)) && desk.width > 1.45 && f.chance(self.twice);
        if second {
            // A second screen beside the first, turned to the person.
            let side = if aside > 0.0 { -1.0 } else { 1.0 };
            let x = aside + side * (self.monitor.width + 0.03);
            if x.abs() + 0.5 * self.monitor.width < 0.5 * desk.width - 0.02 {
                let screen = Monitor { shows: (f.rng.below(3) > 0).then(|| f.rng.below(4) as u8), ..self.monitor };
                f.build(&screen, on(desk_pose, Vec3::new(x, 0.15 - 0.5 * desk.depth, 0.74), -side * 0.22));
            }
        }
        let turn = f.rng.range(-0.5, 0.5);
        let seat = on(chair_pose, Vec3::new(0.0, f.rng.range(-0.12, 0.02), 0.0), turn);
        f.build(&self.chair, seat);
        if !second {
            f.litter(&desk.surfaces(), desk_pose, density);
        }
    }
}

/// Furnishes an open office.
pub fn furnish_open(f: &mut Furnisher) {
    let width = [1.4, 1.6, 1.6][f.rng.below(3)];
    let places = Workplaces::new(width, &mut f.rng);
    let screened = f.chance(0.7);
    let screen = Partition { width, height: [1.18, 1.3][f.rng.below(2)], ..Partition::random(&mut f.rng) };
    let (size, chair) = (places.size(), places.chair());
    let half = if screened { SCREEN } else { 0.004 };
    let (desk_y, chair_y) = (half + 0.5 * size.y, half + size.y + CHAIR);
    let mut group = Vec::new();
    for s in [1.0f32, -1.0] {
        let yaw = if s > 0.0 { 0.0 } else { PI };
        group.push(Piece::standing(size, 0.0).at(0.0, s * desk_y, yaw));
        group.push(Piece::standing(chair, 0.0).at(0.0, s * chair_y, yaw + PI));
    }
    // Its feet reach below the desks.
    group.extend(screened.then(|| Piece::standing(Vec3::new(screen.width, 0.04, screen.height), 0.0).at(0.0, 0.0, 0.0)));
    let pitch = Vec2::new(width + 0.03, 2.0 * (half + size.y + 0.55) + AISLE);
    let margin = Vec2::new(0.5 * width + 0.25, half + size.y + 0.8);
    let lines = [0.0, 0.5 * PI].map(|yaw| f.lines(yaw, pitch, margin));
    let counts = [0, 1].map(|k| f.fitting_pieces(&lines[k], &group));
    let [along, across] = lines;
    for spot in if counts[0] >= counts[1] { along } else { across } {
        let Some((_, poses)) = f.floor.place(&group, vec![spot], |_, _| 0.0) else { continue };
        f.plugs.push(spot.origin);
        places.build(f, poses[0], poses[1], 0.7);
        places.build(f, poses[2], poses[3], 0.7);
        if screened {
            f.build(&screen, poses[4]);
        }
    }
    along_the_walls(f);
    f.work_lights();
}

/// What stands and hangs along the walls of an open office.
fn along_the_walls(f: &mut Furnisher) {
    for _ in 0..2 + f.rng.below(3) {
        let family = ["office_cabinet", "binder_shelf", "office_cabinet"][f.rng.below(3)];
        f.furnish(family, tucked_away);
    }
    f.perhaps(0.7, "copier", tucked_away);
    f.perhaps(0.35, "water_dispenser", cornered);
    f.hang_one(0.6, "whiteboard", 1.5, |_, s| s.x.abs());
    f.hang_one(0.5, "pin_board", 1.5, in_view);
    for _ in 0..f.rng.below(4) {
        f.furnish("plant", cornered);
    }
    f.perhaps(0.5, "waste_bin", tucked_away);
    f.perhaps(0.5, "coat_stand", by_door);
    f.art(2, in_view);
    f.public_things();
}
