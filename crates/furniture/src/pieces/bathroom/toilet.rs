//! A toilet, of class toilet: hung on the wall with a flush plate (52 to 56 cm deep), or standing with its cistern (64 to 69 cm). Bowl and
//! cistern are of porcelain, with water in the bowl; seat and lid, sometimes open, are of white plastic. The wall is at −y; most distances
//! here are measured from it.

use super::ceramic::{Section, body, egg, hollow, rectangle};
use crate::builder::{Builder, Class, Object};
use crate::joint::Joint;
use crate::materials::Finish;
use crate::pieces::form::{all, cylinder};
use crate::pieces::{Furniture, board, on};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A toilet.
#[derive(Clone, Copy, Debug)]
pub struct Toilet {
    /// The bowl hangs on the wall, which has the cistern inside; otherwise it stands and carries its cistern.
    pub hung: bool,
    /// The lid is up.
    pub open: bool,
    /// From the wall to the front of the seat.
    pub depth: f32,
    /// Finish of the flush plate.
    pub plate: Finish,
}

/// Height of the ceramic rim, metres; the seat is 2 cm higher.
const RIM: f32 = 0.40;
/// Width of the bowl at its rim, metres.
const WIDTH: f32 = 0.365;
/// Depth of the cistern with its cover, metres.
const CISTERN: f32 = 0.17;

impl Toilet {
    /// Distance of the back of the bowl from the wall.
    fn back(&self) -> f32 {
        if self.hung { 0.0 } else { 0.02 }
    }

    /// An egg that reaches from `back` to `front`, both metres from the wall.
    fn at(&self, width: f32, back: f32, front: f32, z: f32) -> Section {
        egg(width, front - back, 0.5 * (back + front) - 0.5 * self.depth, z)
    }

    /// The bowl's sections from the floor, or its lower end, up to the rim.
    fn outside(&self) -> Vec<Section> {
        let (d, back) = (self.depth, self.back());
        let rim = self.at(WIDTH, back, d - 0.004, RIM - 0.012);
        let lip = self.at(WIDTH - 0.010, back + 0.005, d - 0.009, RIM);
        if self.hung {
            return vec![
                self.at(0.20, back, 0.44 * d, 0.065),
                self.at(0.235, back, 0.50 * d, 0.075),
                self.at(0.285, back, 0.77 * d, 0.16),
                self.at(0.33, back, 0.91 * d, 0.26),
                self.at(0.358, back, d - 0.016, 0.34),
                rim,
                lip,
            ];
        }
        vec![
            self.at(0.225, back + 0.05, 0.80 * d, 0.0),
            self.at(0.225, back + 0.05, 0.80 * d, 0.02),
            self.at(0.215, back + 0.05, 0.78 * d, 0.12),
            self.at(0.28, back + 0.03, 0.90 * d, 0.22),
            self.at(0.32, back + 0.01, 0.94 * d, 0.31),
            self.at(0.358, back, d - 0.014, 0.36),
            rim,
            lip,
        ]
    }

    /// Distance of the back of the mouth of the bowl from the wall.
    fn mouth(&self) -> f32 {
        self.depth - 0.40
    }

    /// The sections of the bowl's inside from the rim down.
    fn inside(&self) -> [Section; 5] {
        let (d, mouth) = (self.depth, self.mouth());
        [
            self.at(0.245, mouth, d - 0.055, RIM),
            self.at(0.225, mouth + 0.01, d - 0.065, RIM - 0.02),
            self.at(0.255, mouth - 0.005, d - 0.05, RIM - 0.06),
            self.at(0.20, mouth + 0.02, d - 0.10, 0.24),
            self.at(0.10, mouth + 0.07, d - 0.20, 0.15),
        ]
    }

    /// The water's sections: they reach a little into the ceramic, so that no air is between the two.
    fn water(&self) -> [Section; 3] {
        let (d, mouth) = (self.depth, self.mouth());
        [
            self.at(0.12, mouth + 0.06, d - 0.19, 0.149),
            self.at(0.157, mouth + 0.041, d - 0.148, 0.16),
            self.at(0.185, mouth + 0.028, d - 0.12, 0.18),
        ]
    }

    fn bowl(&self, b: &mut Builder, toilet: &Object) {
        b.part(toilet, "bowl", hollow(&self.outside(), &self.inside()), Finish::Porcelain);
        b.part(toilet, "water", body(&self.water()), Finish::Water);
    }

    fn seat(&self, b: &mut Builder, toilet: &Object, hinge: f32) {
        let d = self.depth;
        let white = Finish::WhitePlastic;
        let seat = |grow: f32, z: f32| self.at(WIDTH + 0.006 - grow, hinge + 0.5 * grow, d - 0.5 * grow, z);
        let hole = |grow: f32, z: f32| self.at(0.225 + grow, d - 0.385 - 0.5 * grow, d - 0.075 + 0.5 * grow, z);
        let z = RIM + 0.004;
        // A ring: up the outside, over, down the inside and back below.
        let ring = [
            seat(0.01, z),
            seat(0.0, z + 0.006),
            seat(0.004, z + 0.014),
            seat(0.03, z + 0.018),
            hole(0.02, z + 0.016),
            hole(0.0, z + 0.010),
            hole(0.01, z + 0.0003),
        ];
        let mut sections = ring.to_vec();
        sections.push(seat(0.012, z));
        b.part(toilet, "seat", ring_body(&sections), white);
        let top = z + 0.0185;
        let lid = [seat(0.012, top), seat(0.0, top + 0.004), seat(0.002, top + 0.010), seat(0.02, top + 0.015), seat(0.10, top + 0.018)];
        let mesh = body(&lid);
        let axis = Vec3::new(0.0, hinge + 0.012 - 0.5 * d, top + 0.006);
        // A cistern leaves less room to lean back.
        let angle = if self.hung { 1.72 } else { 1.60 };
        let lid = if self.open { mesh.moved(-axis).turned(Vec3::X, angle).moved(axis + Vec3::Z * 0.004) } else { mesh };
        b.part(toilet, "lid", lid, white);
        // As far above as an open lid is raised, so that its rear edge clears the seat.
        b.joint(toilet, "lid", &Joint::lid(axis.y, axis.z + 0.004, f64::from(angle), self.open), [b.part_count() - 1]);
        let hinges = [-0.075f32, 0.075].map(|x| cylinder(0.013, 0.022, 18).moved(Vec3::new(x, hinge - 0.5 * d - 0.008, RIM - 0.001)));
        b.part(toilet, "hinges", all(hinges), Finish::Chrome);
    }

    fn cistern(&self, b: &mut Builder, toilet: &Object) {
        let y = 0.5 * CISTERN - 0.5 * self.depth + 0.003;
        let at = |w: f32, d: f32, r: f32, z: f32| rectangle(w, d, r, y, z);
        let tank = [
            at(0.33, 0.14, 0.03, RIM + 0.001),
            at(0.36, 0.155, 0.035, RIM + 0.03),
            at(0.375, 0.160, 0.035, 0.76),
            at(0.37, 0.155, 0.03, 0.764),
        ];
        b.part(toilet, "cistern", body(&tank), Finish::Porcelain);
        let cover = [
            at(0.38, 0.164, 0.035, 0.7645),
            at(0.39, CISTERN - 0.002, 0.037, 0.768),
            at(0.39, CISTERN - 0.002, 0.037, 0.782),
            at(0.375, 0.155, 0.03, 0.79),
        ];
        b.part(toilet, "cistern_cover", body(&cover), Finish::Porcelain);
        b.part(toilet, "button", cylinder(0.024, 0.007, 28).moved(Vec3::new(0.0, y, 0.7898)), Finish::Chrome);
    }

    fn flush_plate(&self, b: &mut Builder, toilet: &Object) {
        let y = -0.5 * self.depth;
        let plate = board([-0.123, y - 0.001, 0.96], [0.123, y + 0.008, 1.124], 0.003);
        b.part(toilet, "flush_plate", plate, self.plate);
        let buttons = [(-0.04f32, 0.062f32), (0.068, 0.034)]
            .map(|(x, half)| board([x - half, y + 0.0078, 0.985], [x + half, y + 0.012, 1.10], 0.002));
        b.part(toilet, "flush_buttons", all(buttons), self.plate);
    }
}

/// A ring through `sections`, of which the first follows the last.
fn ring_body(sections: &[Section]) -> enfilade_geometry::Mesh {
    let (n, m) = (sections[0].outline.len(), sections.len());
    let point = |i: usize, j: usize| {
        let section = &sections[j % m];
        let p = section.outline[i % n];
        Vec3::new(p.x, p.y + section.y, section.z)
    };
    crate::shape::grid(n, m, point, |i, j| {
        let p = point(i, j);
        enfilade_math::Vec2::new(p.x, p.y + p.z)
    })
    .smoothed(60.0)
}

impl Furniture for Toilet {
    fn random(rng: &mut Rng) -> Self {
        let hung = rng.below(3) > 0;
        let depth = if hung { rng.range(0.52, 0.56) } else { rng.range(0.64, 0.69) };
        Self { hung, open: rng.below(5) == 0, depth, plate: [Finish::WhitePlastic, Finish::Chrome, Finish::BlackPlastic][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.40, self.depth + 0.004, if self.hung { 1.13 } else { 0.90 })
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let pose = on(pose, Vec3::new(0.0, -0.002, 0.0), 0.0);
        let toilet = b.object("toilet", Class::Toilet, pose);
        self.bowl(b, &toilet);
        if self.hung {
            self.flush_plate(b, &toilet);
        } else {
            self.cistern(b, &toilet);
        }
        self.seat(b, &toilet, if self.hung { 0.07 } else { CISTERN + 0.04 });
    }
}

#[cfg(test)]
mod tests {
    use super::super::ceramic::lining;
    use super::*;
    use crate::pieces::piece_tests::{bounds_of, encloses, scene_of, triangles};

    fn toilets() -> impl Iterator<Item = Toilet> {
        let of = |(hung, depth)| Toilet { hung, open: true, depth, plate: Finish::Chrome };
        [(false, 0.64), (false, 0.69), (true, 0.52), (true, 0.56)].into_iter().map(of)
    }

    #[test]
    fn the_inside_of_a_bowl_stays_within_its_outside() {
        for toilet in toilets() {
            let whole = triangles(&body(&toilet.outside()));
            for section in lining(&toilet.inside()).iter().filter(|section| section.z < RIM) {
                assert!(section.points().all(|p| encloses(&whole, p)), "{toilet:?} at height {}", section.z);
            }
        }
    }

    #[test]
    fn the_water_in_a_bowl_ends_in_the_ceramic() {
        for toilet in toilets() {
            let bowl = triangles(&hollow(&toilet.outside(), &toilet.inside()));
            for section in toilet.water() {
                assert!(section.points().all(|p| encloses(&bowl, p)), "{toilet:?} at height {}", section.z);
            }
        }
    }

    #[test]
    fn an_open_lid_stands_before_the_cistern() {
        for toilet in toilets().filter(|toilet| !toilet.hung) {
            let scene = scene_of(&toilet, 0);
            let [lid, cistern] = ["toilet_1/lid", "toilet_1/cistern_cover"].map(|part| bounds_of(&scene, part));
            assert!(lid.min.y > cistern.max.y, "{toilet:?}: {lid:?} {cistern:?}");
        }
    }
}
