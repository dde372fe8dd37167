//! The living room: which things it has and how they are arranged.

use crate::builder::Builder;
use crate::furniture::{
    Armchair, Basket, BookStack, Bookshelf, Bowl, Candles, Chair, CoffeeTable, Curtains, DiningTable, Door, FloorLamp, Furniture,
    Magazines, Mirror, Mug, Pendant, PictureOnWall, Plant, Radiator, Rug, SideTable, Sofa, Switch, TableLamp, TelevisionBench, Tray, Vase,
    Window, on,
};
use crate::layout::Plan;
use crate::palette::Palette;
use crate::room::{Opening, Room, Wall};
use crate::texture::PaintingStyle;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

const DOOR_WIDTH: f32 = 0.92;
const DOOR_HEIGHT: f32 = 2.06;

/// A room of random size with a window beside the sofa's wall and a door opposite the window.
pub fn plan_room(default: bool, rng: &mut Rng) -> Plan {
    let sofa_wall = if default { Wall::West } else { Wall::ALL[rng.below(4)] };
    let window_wall = if default { Wall::North } else { sofa_wall.turned(if rng.below(2) == 0 { 1 } else { 3 }) };
    let (long, short, height) = if default { (5.1, 4.25, 2.6) } else { (rng.range(4.9, 5.5), rng.range(4.1, 4.6), rng.range(2.5, 2.75)) };
    let size = if sofa_wall.along().x == 0.0 { Vec3::new(long, short, height) } else { Vec3::new(short, long, height) };
    let (width, sill, top) =
        if default { (3.0, 0.5, 2.28) } else { (rng.range(2.3, 3.0), rng.range(0.45, 0.75), height - rng.range(0.30, 0.38)) };
    let window_u = if default { -0.05 } else { rng.range(-0.3, 0.3) };
    let door_u = 0.5 * long - 0.5 * DOOR_WIDTH - rng.range(0.3, 0.42);
    let unset = Opening { wall: window_wall, x: [0.0; 2], z: [0.0; 2] };
    let room = Room { size, thickness: 0.3, window: unset, door: Opening { wall: window_wall.turned(2), ..unset }, accent: sofa_wall };
    let mut plan = Plan::new(room, sofa_wall);
    let opening = |wall: Wall, u: f32, width: f32, z: [f32; 2]| {
        let x = plan.along(wall, Vec2::new(u, 0.0));
        Opening { wall, x: [x - 0.5 * width, x + 0.5 * width], z }
    };
    let window = opening(window_wall, window_u, width, [sill, top]);
    let door = opening(window_wall.turned(2), door_u, DOOR_WIDTH, [0.0, DOOR_HEIGHT]);
    (plan.room.window, plan.room.door) = (window, door);
    let half = plan.half();
    plan.keep_clear(Vec2::new(door_u - 0.5, -half.y), Vec2::new(door_u + 0.5, 0.85 - half.y));
    plan
}

/// Everything in the room, from the shell to the mug.
pub fn furnish(b: &mut Builder, plan: &mut Plan, palette: &Palette, default: bool, rng: &Rng) {
    let room = plan.room;
    room.build(b, &mut rng.fork(1));
    Window { sashes: if room.window.size().x > 2.2 { 3 } else { 2 } }.build(b, &room, &mut rng.fork(2));
    Door { hand: if rng.fork(3).below(2) == 0 { -1.0 } else { 1.0 } }.build(b, &room);
    window_side(b, plan, &mut rng.fork(4));
    seating(b, plan, palette, default, &mut rng.fork(5));
    television_side(b, plan, palette, &mut rng.fork(6));
    dining(b, plan, default, &mut rng.fork(7));
    door_side(b, plan, palette, &mut rng.fork(8));
}

fn window_side(b: &mut Builder, plan: &mut Plan, rng: &mut Rng) {
    let room = plan.room;
    Curtains { width: rng.range(0.36, 0.44), beyond: 0.42 }.build(b, &room, rng);
    let half = plan.half();
    let opening = room.window;
    let middle = opening.center_x() * if plan.along(opening.wall, Vec2::X) > 0.0 { 1.0 } else { -1.0 };
    let reach = 0.5 * opening.size().x + 0.46;
    plan.keep_clear(Vec2::new(middle - reach, half.y - Curtains::DEPTH), Vec2::new((middle + reach).min(half.x), half.y));
    let radiator = Radiator { width: (0.62 * opening.size().x).min(1.4), height: opening.z[0] - 0.24 };
    let depth = radiator.size().y;
    radiator.build(b, on(room.wall_pose(opening.wall), Vec3::new(opening.center_x(), 0.5 * depth - 0.0005, 0.0), 0.0), rng);
    let sill = |x: f32, y: f32| on(room.wall_pose(opening.wall), Vec3::new(x, y, opening.z[0] + Window::SILL), 0.0);
    let count = 1 + rng.below(3);
    for k in 0..count {
        let x = opening.center_x() + opening.size().x * (0.36 - 0.30 * k as f32 + rng.range(-0.05, 0.05));
        let place = sill(x, -0.02) * DAffine3::from_rotation_z(f64::from(rng.range(0.0, 6.0)));
        if k == 1 {
            Candles { count: 2 }.build(b, sill(x, -0.02), rng);
        } else {
            Plant::small(rng.range(0.11, 0.13), rng.range(0.055, 0.065)).build(b, place, rng);
        }
    }
}

fn seating(b: &mut Builder, plan: &mut Plan, palette: &Palette, default: bool, rng: &mut Rng) {
    let half = plan.half();
    let wall = plan.sofa_wall;
    let mut sofa = Sofa::random(rng);
    if default {
        sofa = Sofa { seats: 3, seat_width: 0.65, arm: 0.16, arm_height: 0.6, pillows: 3, throw: None };
        sofa.throw = Some(plan_side(plan));
    }
    let v = rng.range(-0.05, 0.12);
    let Some(sofa_pose) = plan.against(wall, Vec2::new(0.0, v), sofa.size(), 0.0) else { return };
    sofa.build(b, sofa_pose, rng);
    let sofa_front = sofa.size().y - half.x + crate::layout::WALL_GAP;

    // The rug lies between the sofa and what faces it; the coffee table stands on it.
    let rug = Rug { size: Vec2::new(rng.range(2.1, 2.4), rng.range(1.40, 1.5)) };
    let rug_u = sofa_front + 0.04 + 0.5 * rug.size.y;
    rug.build(b, plan.pose(Vec2::new(rug_u, v), Vec2::X, 0.0) * DAffine3::from_rotation_z(f64::from(rng.range(-0.015, 0.015))), rng);
    let table = if default { CoffeeTable::Shelf { length: 1.08, depth: 0.56 } } else { CoffeeTable::random(rng) };
    let table_u = sofa_front + 0.40 + 0.5 * table.size().y;
    if let Some(pose) = plan.free(Vec2::new(table_u, v), Vec2::X, table.size(), 0.1) {
        let pose = on(pose, Vec3::new(0.0, 0.0, Rug::TOP), rng.range(-0.02, 0.02));
        table.build(b, pose, rng);
        on_coffee_table(b, &table, pose, rng);
    }
    plan.keep_clear(Vec2::new(rug_u - 0.5 * rug.size.y, v - 0.5 * rug.size.x), Vec2::new(rug_u + 0.5 * rug.size.y, v + 0.5 * rug.size.x));
    beside_sofa(b, plan, v, &sofa, rng);
    armchair(b, plan, rug_u + 0.5 * rug.size.y, rng);
    pictures_over_sofa(b, plan, v, palette, default, rng);
}

/// The sofa's arm that is farther from the window: −1 left, +1 right.
fn plan_side(plan: &Plan) -> f32 {
    -plan.along(plan.sofa_wall, Vec2::Y).signum()
}

fn on_coffee_table(b: &mut Builder, table: &CoffeeTable, pose: DAffine3, rng: &mut Rng) {
    let top = |x: f32, y: f32, yaw: f32| on(pose, Vec3::new(x, y, CoffeeTable::TOP), yaw);
    let side = if rng.below(2) == 0 { 1.0 } else { -1.0 };
    match *table {
        CoffeeTable::Shelf { length, depth } => {
            let tray = Tray { radius: 0.165 };
            tray.build(b, top(side * 0.24 * length, 0.02, 0.3), rng);
            let tray_top = |x: f32, y: f32| on(pose, Vec3::new(side * 0.24 * length + x, 0.02 + y, CoffeeTable::TOP + Tray::TOP), 0.0);
            Vase { height: 0.19, belly: 0.06, branches: 0 }.build(b, tray_top(-0.04, -0.06), rng);
            Candles { count: 1 }.build(b, tray_top(0.06, 0.05), rng);
            Magazines { count: 3 }.build(b, top(-side * 0.20 * length, 0.03, rng.range(1.2, 1.8)), rng);
            Mug.build(b, top(-side * 0.02, 0.26 * depth, rng.range(0.0, 6.0)), rng);
            let below = on(pose, Vec3::new(-side * 0.12 * length, 0.0, 0.161), rng.range(-0.2, 0.2));
            BookStack { count: 3 }.build(b, below, rng);
        }
        CoffeeTable::Round { diameter } => {
            Bowl { radius: 0.13 }.build(b, top(side * 0.16 * diameter, 0.08, 0.0), rng);
            Magazines { count: 2 }.build(b, top(-side * 0.19 * diameter, -0.02, rng.range(-0.6, 0.6)), rng);
            Mug.build(b, top(side * 0.1, -0.27 * diameter, rng.range(0.0, 6.0)), rng);
        }
    }
}

fn beside_sofa(b: &mut Builder, plan: &mut Plan, v: f32, sofa: &Sofa, rng: &mut Rng) {
    let (half, wall) = (plan.half(), plan.sofa_wall);
    let end = 0.5 * sofa.size().x;
    let table = SideTable::random(rng);
    let from_wall = Vec2::new(0.0, v - end - 0.06 - 0.5 * table.diameter);
    if let Some(pose) = plan.against(wall, from_wall, table.size() + Vec3::new(0.0, 0.12, 0.0), 0.02) {
        table.build(b, pose, rng);
        let top = |x: f32, y: f32| on(pose, Vec3::new(x, y, table.height), 0.0);
        TableLamp { globe: rng.range(0.105, 0.125) }.build(b, top(0.0, -0.05), rng);
        Mug.build(b, on(top(0.09, 0.11), Vec3::ZERO, rng.range(0.0, 6.0)), rng);
    }
    let lamp = FloorLamp::random(rng);
    let size = lamp.size();
    let corner = Vec2::new(0.06 + 0.5 * size.x - half.x, (v + end + 0.08 + 0.5 * size.x).min(half.y - 0.5 * size.x - 0.06));
    if let Some(pose) = plan.free(corner, Vec2::X, size, 0.015) {
        lamp.build(b, pose, rng);
    }
}

fn armchair(b: &mut Builder, plan: &mut Plan, rug_end: f32, rng: &mut Rng) {
    let chair = Armchair::random(rng);
    for attempt in 0..16 {
        let shift = 0.05 * attempt as f32;
        let uv = Vec2::new(rug_end + 0.36 + shift, -1.18 + rng.range(-0.06, 0.06));
        let toward = Vec2::new(-1.0, rng.range(0.9, 1.2));
        if let Some(pose) = plan.free(uv, toward, chair.size(), 0.02) {
            chair.build(b, pose, rng);
            return;
        }
    }
}

fn pictures_over_sofa(b: &mut Builder, plan: &Plan, v: f32, palette: &Palette, default: bool, rng: &mut Rng) {
    let (wall, black) = (plan.sofa_wall, rng.below(2) == 0);
    let mut hang = |v: f32, z: f32, size: [f32; 2], style: PaintingStyle, rng: &mut Rng| {
        let mount = if style == PaintingStyle::Hills { 0.05 } else { 0.07 };
        let picture = PictureOnWall { size: Vec2::from_array(size), mount, style, palette: *palette, black };
        picture.build(b, plan.hang(wall, Vec2::new(0.0, v), z), rng);
    };
    match if default { 0 } else { rng.below(3) } {
        0 => {
            hang(v - 0.30, 1.52, [0.78, 0.58], PaintingStyle::Hills, rng);
            hang(v + 0.36, 1.55, [0.42, 0.56], PaintingStyle::Shapes, rng);
        }
        1 => hang(v, 1.5, [1.15, 0.75], PaintingStyle::Bands, rng),
        _ => {
            let styles = [PaintingStyle::Shapes, PaintingStyle::Bands, PaintingStyle::Hills];
            (0..3).for_each(|k| hang(v + 0.56 * (k as f32 - 1.0), 1.53, [0.46, 0.62], styles[k], rng));
        }
    }
}

fn television_side(b: &mut Builder, plan: &mut Plan, palette: &Palette, rng: &mut Rng) {
    let wall = plan.sofa_wall.turned(2);
    let half = plan.half();
    let bench = TelevisionBench::random(rng);
    let v = (-0.12 + rng.range(-0.1, 0.1)).max(0.5 * bench.width + 0.1 - half.y);
    if let Some(pose) = plan.against(wall, Vec2::new(0.0, v), bench.size(), 0.0) {
        bench.build(b, pose, rng);
        let top = |x: f32, y: f32| on(pose, Vec3::new(x, y, TelevisionBench::TOP), 0.0);
        let beside = 0.25 * (bench.width + bench.screen);
        let side = if rng.below(2) == 0 { 1.0 } else { -1.0 };
        Vase { height: 0.24, belly: 0.075, branches: 5 }.build(b, top(side * beside, 0.0), rng);
        BookStack { count: 2 }.build(b, on(top(-side * beside, -0.02), Vec3::ZERO, rng.range(-0.15, 0.15)), rng);
    }
    let free = v - 0.5 * bench.width + half.y;
    if free > 0.75 {
        let size = Vec2::new(0.5, 0.7);
        let picture = PictureOnWall { size, mount: 0.06, style: PaintingStyle::Bands, palette: *palette, black: rng.below(2) == 0 };
        picture.build(b, plan.hang(wall, Vec2::new(0.0, 0.5 * free - half.y), 1.5), rng);
    }
    let plant = Plant::tall(rng);
    let size = Vec3::new(0.56, 0.56, plant.size().z);
    for k in 0..10 {
        let uv = Vec2::new(half.x - 0.36 - 0.05 * k as f32, half.y - 0.36);
        if let Some(pose) = plan.free(uv, -Vec2::X, size, 0.0) {
            plant.build(b, pose, rng);
            break;
        }
    }
}

fn dining(b: &mut Builder, plan: &mut Plan, default: bool, rng: &mut Rng) {
    let half = plan.half();
    let table = if default { DiningTable { width: 0.88, round: true } } else { DiningTable::random(rng) };
    let chair = Chair { pad: rng.below(2) == 0 };
    for attempt in 0..10 {
        let uv =
            Vec2::new(1.24 - 0.03 * attempt as f32 + rng.range(-0.03, 0.03), half.y - 0.52 - 0.5 * table.width - 0.02 * attempt as f32);
        let Some(pose) = plan.free(uv, Vec2::X, table.size(), 0.3) else { continue };
        table.build(b, pose, rng);
        for (along, pull) in [(-Vec2::X, 0.05), (-Vec2::Y, 0.03), (Vec2::X, 0.01)] {
            let out = 0.5 * table.width + 0.17 + pull + rng.range(0.0, 0.05);
            let turn = Vec2::from_angle(rng.range(-0.16, 0.16));
            if let Some(pose) = plan.seat(uv + along * out, turn.rotate(-along), chair.size()) {
                chair.build(b, pose, rng);
            }
        }
        let top = |x: f32, y: f32| on(pose, Vec3::new(x, y, DiningTable::TOP), rng.clone().range(0.0, 6.0));
        let (vase, bowl, mug) = (top(-0.05, 0.1), top(0.14, -0.14), top(-0.2, -0.16));
        Vase { height: 0.2, belly: 0.062, branches: 4 }.build(b, vase, rng);
        Bowl { radius: 0.12 }.build(b, bowl, rng);
        Mug.build(b, mug, rng);
        let drop = plan.room.size.z - 1.52;
        Pendant { drop, radius: 0.19 }.build(b, plan.pose(uv, Vec2::X, plan.room.size.z), rng);
        return;
    }
}

fn door_side(b: &mut Builder, plan: &mut Plan, palette: &Palette, rng: &mut Rng) {
    let half = plan.half();
    let wall = plan.room.door.wall;
    let door_u = plan.along(wall, Vec2::X) * plan.room.door.center_x();
    let shelf = Bookshelf::random(1.3, rng);
    let mut free_from = -half.x + 1.0;
    for k in 0..12 {
        let u = -half.x + 0.62 + 0.5 * shelf.size().x + 0.05 * k as f32;
        if let Some(pose) = plan.against(wall, Vec2::new(u, 0.0), shelf.size(), 0.02) {
            shelf.build(b, pose, rng);
            free_from = u + 0.5 * shelf.size().x;
            break;
        }
    }
    let door_from = door_u - 0.5 * DOOR_WIDTH - 0.06;
    let middle = 0.5 * (free_from + door_from - 0.16);
    let radius = (0.42 * (door_from - 0.16 - free_from)).min(0.34);
    if radius > 0.18 {
        Mirror { radius }.build(b, plan.hang(wall, Vec2::new(middle, 0.0), 1.52), rng);
    } else if radius > 0.12 {
        let picture = PictureOnWall { size: Vec2::new(0.3, 0.4), mount: 0.04, style: PaintingStyle::Bands, palette: *palette, black: true };
        picture.build(b, plan.hang(wall, Vec2::new(middle, 0.0), 1.55), rng);
    }
    Switch.build(b, plan.hang(wall, Vec2::new(door_from - 0.09, 0.0), 1.08), rng);
    let basket = Basket { radius: rng.range(0.19, 0.22) };
    for k in 0..8 {
        let uv = Vec2::new(middle - 0.04 * k as f32, basket.radius + 0.04 - half.y);
        if let Some(pose) = plan.free(uv, Vec2::Y, basket.size(), 0.02) {
            basket.build(b, pose, rng);
            break;
        }
    }
}
