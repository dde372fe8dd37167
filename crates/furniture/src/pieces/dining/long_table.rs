//! A rectangular dining table for four to eight people, 130 to 230 × 82 to 98 cm, of class table, in a style of the table [`STYLES`]. Some
//! are cut for a leaf in the middle, and one in three is laid for a meal at its long sides. The long side is along x.

use super::long_kind::{BOARD, LongTable, Outline, Stand, TOP};
use super::stand::{STYLES, Style};
use crate::builder::{Builder, Class, Object};
use crate::pieces::form::{all, cut_out, rounded_rectangle};
use crate::pieces::style::drawn;
use crate::pieces::tableware::PlaceSetting;
use crate::pieces::{Furniture, Surface, board, grained, on};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Exponent of an oval top.
const OVAL: f32 = 2.6;

impl LongTable {
    /// Places along one long side: 60 cm for a person (Neufert).
    pub fn places(&self) -> usize {
        ((self.length - 0.1) / 0.6) as usize
    }

    /// Seats: the edge of the table in front of a person, and the direction in which the person looks.
    pub fn seats(&self) -> Vec<(Vec2, Vec2)> {
        let n = self.places();
        let x = |k: usize| ((k as f32 + 0.5) / n as f32 - 0.5) * (self.length - 0.1);
        let half = |x: f32| {
            let off = if self.outline == Outline::Oval { (2.0 * x / self.length).abs().powf(OVAL) } else { 0.0 };
            0.5 * self.width * (1.0 - off).powf(1.0 / OVAL)
        };
        let mut seats: Vec<_> =
            (0..n).flat_map(|k| [(Vec2::new(x(k), half(x(k))), Vec2::NEG_Y), (Vec2::new(x(k), -half(x(k))), Vec2::Y)]).collect();
        if self.length > 1.7 {
            let end = 0.5 * self.length;
            seats.extend([(Vec2::new(end, 0.0), Vec2::NEG_X), (Vec2::new(-end, 0.0), Vec2::X)]);
        }
        seats
    }

    fn top(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let slab = |x0: f32, x1: f32| board([x0, -0.5 * self.width, TOP - BOARD], [x1, 0.5 * self.width, TOP], 0.003);
        let half = 0.5 * self.length;
        if self.extends {
            // Half the length of the leaf, and half of the joint at its ends.
            let (leaf, joint) = (0.22, 0.0008);
            for (i, [x0, x1]) in [[-half, -leaf - joint], [-leaf + joint, leaf - joint], [leaf + joint, half]].into_iter().enumerate() {
                b.part(table, &format!("top_{}", i + 1), grained(slab(x0, x1), rng), self.finish);
            }
            return;
        }
        let cut = |outline: &[Vec2]| cut_out(outline, BOARD, 0.006).moved(Vec3::new(0.0, 0.0, TOP - BOARD));
        let mesh = match self.outline {
            Outline::Rectangle => slab(-half, half),
            Outline::Rounded => cut(&rounded_rectangle(self.length, self.width, 0.08, 6)),
            Outline::Oval => {
                let point = |k: usize| {
                    let (sin, cos) = (k as f32 / 72.0 * std::f32::consts::TAU).sin_cos();
                    let round = |v: f32| v.signum() * v.abs().powf(2.0 / OVAL);
                    Vec2::new(half * round(cos), 0.5 * self.width * round(sin))
                };
                cut(&(0..72).map(point).collect::<Vec<_>>())
            }
            Outline::Planks => return self.planks(b, table, rng),
        };
        b.part(table, "top", grained(mesh, rng), self.finish);
    }
}

impl LongTable {
    /// A top of planks side by side between two across their ends.
    fn planks(&self, b: &mut Builder, table: &Object, rng: &mut Rng) {
        let (half, end, count) = (0.5 * self.length, 0.11, (self.width / 0.17).round());
        let wide = self.width / count;
        let plank = |k: usize| {
            let y = wide * k as f32 - 0.5 * self.width;
            board([end - half + 0.0004, y + 0.0003, TOP - BOARD], [half - end - 0.0004, y + wide - 0.0003, TOP], 0.0015)
        };
        let planks: Vec<_> = (0..count as usize).map(|k| grained(plank(k), rng)).collect();
        b.part(table, "top", all(planks), self.finish);
        for (name, [x0, x1]) in [("end_left", [-half, end - half]), ("end_right", [half - end, half])] {
            let plank = board([x0, -0.5 * self.width, TOP - BOARD - 0.0002], [x1, 0.5 * self.width, TOP + 0.0002], 0.0015);
            b.part(table, name, grained(plank, rng), self.finish);
        }
    }

    fn of((outline, stand, finishes): Style, rng: &mut Rng) -> Self {
        let laid = (outline != Outline::Oval && rng.below(3) == 0).then(|| PlaceSetting::random(rng));
        let [finish, below] = finishes[rng.below(finishes.len())];
        let extends = stand == Stand::Corners && outline == Outline::Rectangle && rng.below(2) == 0;
        Self { length: rng.range(1.3, 2.3), width: rng.range(0.82, 0.98), outline, stand, extends, finish, below, laid }
    }
}

impl Furniture for LongTable {
    fn random(rng: &mut Rng) -> Self {
        Self::of(drawn(STYLES, rng), rng)
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.length, self.width, TOP + self.laid.map_or(0.0, |laid| laid.size().z))
    }

    fn surfaces(&self) -> Vec<Surface> {
        let half = 0.5 * Vec2::new(self.length, self.width) - 0.05;
        // On a laid table only the middle between the glasses is free, and mats push the glasses further in.
        let taken = self.laid.map_or(0.0, |laid| if laid.mat { 0.395 } else { 0.37 });
        let half = Vec2::new(half.x, half.y - taken) * if self.outline == Outline::Oval { 0.72 } else { 1.0 };
        if half.y < 0.05 {
            return Vec::new();
        }
        vec![Surface { min: -half, max: half, z: TOP, headroom: f32::INFINITY }]
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let table = b.object("long_table", Class::Table, pose);
        self.top(b, &table, rng);
        self.stand(b, &table, rng);
        let Some(setting) = self.laid else { return };
        // Plates of all places are of one set.
        let set = rng.fork(1);
        for (edge, look) in self.seats().into_iter().filter(|(_, look)| look.x == 0.0) {
            let at = edge + look * 0.2;
            let yaw = if look.y < 0.0 { 0.0 } else { std::f32::consts::PI };
            setting.build(b, on(pose, at.extend(TOP), yaw), &mut set.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::{Place, style_tests::check};

    #[test]
    fn every_style_stands_and_is_of_one_piece() {
        let mut rng = Rng::new(1);
        let mut things: Vec<(String, Box<dyn Furniture>)> = Vec::new();
        for (i, &(_, style)) in STYLES.iter().enumerate() {
            let table = LongTable { laid: None, ..LongTable::of(style, &mut rng) };
            things.push((format!("{:?} {:?} {i}", style.0, style.1), Box::new(table)));
        }
        check(Place::Free, &things);
    }

    #[test]
    fn the_seats_of_an_oval_are_at_its_edge() {
        let table = LongTable { length: 2.0, width: 0.9, outline: Outline::Oval, ..LongTable::random(&mut Rng::new(1)) };
        for (edge, look) in table.seats().into_iter().filter(|(_, look)| look.x == 0.0) {
            let on = (edge.x.abs() / 1.0).powf(OVAL) + (edge.y.abs() / 0.45).powf(OVAL);
            assert!((on - 1.0).abs() < 1e-4 && look.y * edge.y < 0.0, "{edge} {look}");
        }
    }
}
