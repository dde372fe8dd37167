//! The living room: a sofa that faces a television, with what gathers around them.

use super::Furnisher;
use super::furnisher::Standing;
use super::television;
use super::wishes::centred;
use crate::place::{Piece, Spot};
use crate::room::Wall;
use enfilade_furniture::{
    Armchair, Basket, BookStack, Bookshelf, Bowl, Candles, CoffeeTable, CornerSofa, FloorLamp, Furniture, Magazines, Mirror, Mug,
    PictureOnWall, Plant, RoomKind, Rug, SideTable, TableLamp, TelevisionBench, Tray, Vase, on,
};
use enfilade_math::{DAffine3, Vec2, Vec3};
use enfilade_textures::PaintingStyle;
use std::f32::consts::PI;

/// From the sofa's front to the coffee table.
const KNEES: f32 = 0.40;

/// Furnishes the room.
pub fn furnish(f: &mut Furnisher) {
    if let Some(sofa) = seating(f) {
        f.accent = sofa.spot.wall;
        beside_sofa(f, &sofa);
        armchair(f, &sofa);
        pictures(f, &sofa);
    }
    if !f.home_has(RoomKind::Dining) {
        f.dine([2, 4], |floor, s| floor.to_window(s.origin));
    }
    bookshelf(f);
    f.perhaps(0.5, "sideboard", centred);
    plant(f);
    basket(f);
    f.hang_plant(0.4);
    f.ceiling_lamp();
}

/// Sofa, rug, coffee table and television, tried wall by wall.
fn seating(f: &mut Furnisher) -> Option<Standing> {
    let corner = (f.rng.below(7) == 0).then(|| CornerSofa::random(&mut f.rng));
    let model = ["sofa", "sofa", "sofa", "sofa", "chesterfield", "day_bed"][f.rng.below(6)];
    let sofa: Box<dyn Furniture> = match corner {
        Some(corner) => Box::new(corner),
        None => f.any(model)?,
    };
    let own = CoffeeTable::random(&mut f.rng);
    let model = f.borrow("coffee_table", &own, |_| true);
    let table: &dyn Furniture = model.as_ref().map_or(&own, |model| model);
    let bench = TelevisionBench::random(&mut f.rng);
    let mut rug = Rug { size: Vec2::new(f.rng.range(2.1, 2.4), f.rng.range(1.4, 1.5)) };
    let mut walls: Vec<(f32, Wall)> = Vec::new();
    for wall in f.room.walls() {
        walls.push((wall_cost(f, wall) + f.rng.range(0.0, 0.6), wall));
    }
    walls.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Before a sofa around a corner, table and rug are beside its chaise.
    let [beside, wide, depth] = corner.map_or([0.0, f32::INFINITY, sofa.size().y], |corner| corner.before());
    rug.size.x = rug.size.x.min(wide - 0.1);
    let seat = Piece::standing(sofa.size(), KNEES - 0.05);
    let low = Piece::standing(table.size() + Vec3::new(0.0, 0.0, Rug::TOP), 0.0).at(beside, depth + KNEES + 0.5 * table.size().y, 0.0);
    let mat = Piece { flat: true, ..Piece::standing(rug.size(), 0.0).at(beside, depth + 0.04 + 0.5 * rug.size.y, 0.0) };
    for (with_screen, with_table) in [(true, true), (true, false), (false, true), (false, false)] {
        for (across, wall) in walls.iter().flat_map(|&(_, wall)| f.room.depths(wall).into_iter().map(move |across| (across, wall))) {
            for aside in [0.0, 0.3, -0.3, 0.6, -0.6, 1.0, -1.0] {
                let mut group = vec![seat, mat];
                group.extend(with_table.then_some(low));
                let screen = Piece::standing(bench.size(), 0.5);
                group.extend(with_screen.then_some(screen.at(aside, across - 2.0 * f.floor.gap() - screen.at.y, PI)));
                let spots = f.floor.along(wall, sofa.size().x);
                let middle = |_: &crate::place::Floor, s: &Spot| s.x.abs();
                let Some((spot, poses)) = f.floor.place(&group, spots, middle) else { continue };
                f.build(sofa.as_ref(), poses[0]);
                f.build(&rug, poses[1] * DAffine3::from_rotation_z(f64::from(f.rng.clone().range(-0.015, 0.015))));
                if with_table {
                    let pose = on(poses[2], Vec3::new(0.0, 0.0, Rug::TOP), f.rng.range(-0.02, 0.02));
                    f.build(table, pose);
                    match &model {
                        Some(model) => f.litter(&model.surfaces(), pose, 1.0),
                        None => on_coffee_table(f, &own, pose),
                    }
                }
                if with_screen {
                    let pose = poses[poses.len() - 1];
                    f.plugs.push(pose.translation.truncate().as_vec2());
                    television::opposite(f, &bench, f.room.face(wall).opposite, pose);
                }
                return Some(Standing { pose: poses[0], size: sofa.size(), spot });
            }
        }
    }
    None
}

/// Cost of the sofa at a wall: its back to windows and doors, the screen in front of a window, too near or too far.
fn wall_cost(f: &Furnisher, wall: Wall) -> f32 {
    let on = |wall: Wall, window: f32, way: f32| {
        let cost = |o: &crate::room::Opening| if o.is_way() { way } else { window } * o.size().x;
        f.room.openings.iter().filter(|o| o.wall == wall).map(cost).sum::<f32>()
    };
    let face = f.room.face(wall);
    on(wall, 1.0, 0.8) + on(face.opposite, 0.8, 0.6) + (face.across - 3.9).abs()
}

fn on_coffee_table(f: &mut Furnisher, table: &CoffeeTable, pose: DAffine3) {
    let top = |x: f32, y: f32, yaw: f32| on(pose, Vec3::new(x, y, CoffeeTable::TOP), yaw);
    let side = if f.rng.below(2) == 0 { 1.0 } else { -1.0 };
    match *table {
        CoffeeTable::Shelf { length, depth } => {
            let tray = Tray { radius: 0.165 };
            f.build_small(&tray, top(side * 0.24 * length, 0.02, 0.3));
            let tray_top = |x: f32, y: f32| on(pose, Vec3::new(side * 0.24 * length + x, 0.02 + y, CoffeeTable::TOP + Tray::TOP), 0.0);
            f.build_small(&Vase { height: 0.19, belly: 0.06, branches: 0 }, tray_top(-0.04, -0.06));
            f.build_small(&Candles { count: 1 }, tray_top(0.06, 0.05));
            let turn = f.rng.range(1.2, 1.8);
            f.build_small(&Magazines { count: 3 }, top(-side * 0.20 * length, 0.03, turn));
            let turn = f.rng.range(0.0, 6.0);
            f.build_small(&Mug, top(-side * 0.02, 0.26 * depth, turn));
            let below = on(pose, Vec3::new(-side * 0.12 * length, 0.0, 0.161), f.rng.range(-0.2, 0.2));
            f.build_small(&BookStack { count: 3 }, below);
        }
        CoffeeTable::Round { diameter } => {
            f.build_small(&Bowl { radius: 0.13 }, top(side * 0.16 * diameter, 0.08, 0.0));
            let turn = f.rng.range(-0.6, 0.6);
            f.build_small(&Magazines { count: 2 }, top(-side * 0.19 * diameter, -0.02, turn));
            let turn = f.rng.range(0.0, 6.0);
            f.build_small(&Mug, top(side * 0.1, -0.27 * diameter, turn));
        }
        CoffeeTable::Styled(_) => f.litter(&table.surfaces(), pose, 1.0),
    }
}

/// A side table with a lamp at one end of the sofa, a floor lamp at the other.
fn beside_sofa(f: &mut Furnisher, sofa: &Standing) {
    let Some(wall) = sofa.spot.wall else { return };
    let (x, end) = (sofa.spot.x, 0.5 * sofa.size.x);
    let own = SideTable::random(&mut f.rng);
    let model = f.borrow("side_table", &own, |_| true);
    let table: &dyn Furniture = model.as_ref().map_or(&own, |model| model);
    let near = move |s: &Spot, reach: f32| {
        let gap = (s.x - x).abs() - end - reach;
        if !(0.0..=0.35).contains(&gap) { f32::INFINITY } else { gap }
    };
    let width = table.size().x;
    let reach = 0.5 * width + 0.04;
    let spots = f.floor.along(wall, width);
    if let Some(found) = f.stand_at(table, spots, |_, s| near(s, reach)) {
        let lamp = TableLamp::random(&mut f.rng);
        let lamp = f.or_borrowed("table_lamp", lamp);
        if let Some(model) = &model {
            f.scatter(&model.surfaces(), found.pose, &[lamp]);
        } else {
            let top = on(found.pose, Vec3::new(0.0, -0.05, own.height), 0.0);
            if f.is_below_slopes(lamp.size(), top) {
                f.build(lamp.as_ref(), top);
            }
            let turn = f.rng.range(0.0, 6.0);
            f.build_small(&Mug, on(found.pose, Vec3::new(0.09, 0.11, own.height), turn));
        }
    }
    let own = FloorLamp::random(&mut f.rng);
    let lamp = f.or_borrowed("floor_lamp", own);
    let reach = 0.5 * lamp.size().x + 0.03;
    let spots = f.floor.along(wall, lamp.size().x);
    f.stand_at(lamp.as_ref(), spots, |_, s| near(s, reach));
}

/// An easy chair that looks at the coffee table from the side.
fn armchair(f: &mut Furnisher, sofa: &Standing) {
    let own = Armchair::random(&mut f.rng);
    let chair = f.or_borrowed("armchair", own);
    let target = sofa.spot.point(Vec2::new(0.0, sofa.size.y + 0.7));
    let yaws: Vec<f32> = (0..16).map(|k| k as f32 * PI / 8.0).collect();
    f.stand_free(chair.as_ref(), &yaws, |floor, s| {
        let to = target - s.origin;
        let (distance, turn) = (to.length(), to.normalize_or(Vec2::X).dot(s.front()));
        let side = (s.origin - sofa.spot.origin).dot(sofa.spot.front());
        if turn < 0.9 || side < 0.6 || !(1.2..2.4).contains(&distance) {
            return f32::INFINITY;
        }
        (distance - 1.5).abs() + 2.0 * (1.0 - turn) + 0.3 * (1.5 - floor.to_way(s.origin)).max(0.0)
    });
}

fn bookshelf(f: &mut Furnisher) {
    let own = Bookshelf::random(&mut f.rng);
    let model = f.borrow("bookshelf", &own, |_| true);
    let shelf: &dyn Furniture = model.as_ref().map_or(&own, |model| model);
    let found = f.stand(shelf, |floor, s| floor.to_corner(s) + 0.4 * (2.0 - floor.to_way(s.origin)).max(0.0));
    if let (Some(found), Some(model)) = (found, &model) {
        f.litter(&model.surfaces(), found.pose, 1.0);
    }
}

fn plant(f: &mut Furnisher) {
    let own = Plant::tall(&mut f.rng);
    let plant = f.or_borrowed("plant", own);
    f.stand(plant.as_ref(), |floor, s| 1.5 * floor.to_corner(s) + 0.5 * floor.to_window(s.origin));
}

fn basket(f: &mut Furnisher) {
    let own = Basket { radius: f.rng.range(0.19, 0.22) };
    let basket = f.or_borrowed("basket", own);
    f.stand(basket.as_ref(), |floor, s| floor.to_corner(s) + floor.to_way(s.origin) * 0.1);
}

fn pictures(f: &mut Furnisher, sofa: &Standing) {
    let Some(wall) = sofa.spot.wall else { return };
    let (palette, black, x) = (*f.palette, f.chance(0.5), sofa.spot.x);
    let hang = |f: &mut Furnisher, aside: f32, z: f32, size: [f32; 2], style: PaintingStyle| {
        let mount = if style == PaintingStyle::Hills { 0.05 } else { 0.07 };
        let picture = PictureOnWall { size: Vec2::from_array(size), mount, style, palette, black };
        f.hang(&picture, z, &[wall], |_, s| {
            let off = (s.x - x - aside).abs();
            if off > 0.12 { f32::INFINITY } else { off }
        });
    };
    match f.rng.below(3) {
        0 => {
            hang(f, -0.30, 1.52, [0.78, 0.58], PaintingStyle::Hills);
            hang(f, 0.40, 1.55, [0.42, 0.56], PaintingStyle::Shapes);
        }
        1 => hang(f, 0.0, 1.5, [1.15, 0.75], PaintingStyle::Bands),
        _ => {
            let styles = [PaintingStyle::Shapes, PaintingStyle::Bands, PaintingStyle::Hills];
            (0..3).for_each(|k| hang(f, 0.58 * (k as f32 - 1.0), 1.53, [0.46, 0.62], styles[k]));
        }
    }
    let others: Vec<Wall> = f.room.walls().into_iter().filter(|&w| w != wall).collect();
    if f.chance(0.5) {
        let mirror = Mirror { radius: f.rng.range(0.26, 0.34) };
        f.hang(&mirror, 1.5, &others, |floor, s| floor.to_way(s.origin));
    } else {
        let picture = PictureOnWall { size: Vec2::new(0.5, 0.7), mount: 0.06, style: PaintingStyle::Bands, palette, black };
        f.hang(&picture, 1.5, &others, |_, s| s.x.abs());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::tests::lacks_without_clutter;

    fn sofa_and_television(f: &mut Furnisher) {
        if let Some(sofa) = seating(f) {
            beside_sofa(f, &sofa);
        }
    }

    #[test]
    fn without_clutter_nothing_lies_around_the_sofa() {
        let small = ["mug", "magazines", "vase", "bowl", "tray", "candlestick", "books"];
        lacks_without_clutter(RoomKind::Living, sofa_and_television, &small);
    }
}
