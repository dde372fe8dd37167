//! Knives, forks and spoons of about 22 cm, and the place setting for one person: plates, cutlery, glasses, a napkin and perhaps a mat,
//! each an object of class other prop. A piece lies along y with its handle towards −y; in a place setting the person sits at +y.

use super::Drinkware;
use super::crockery::plate;
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::form::{all, cut_out, turned};
use crate::pieces::{CONTACT, Furniture, on};
use crate::shape::{Reshape, grid};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// One piece of cutlery; it lies along y, its handle towards −y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum Piece {
    Knife,
    Fork,
    Spoon,
}

/// A handle from y = −0.105 to 0.025 that becomes thin towards the neck.
fn handle() -> Mesh {
    let outline: Vec<Vec2> = [[0.0, -0.105], [0.0085, -0.1], [0.0095, -0.085], [0.0042, -0.01], [0.003, 0.025]]
        .into_iter()
        .chain([[-0.003, 0.025], [-0.0042, -0.01], [-0.0095, -0.085], [-0.0085, -0.1]])
        .map(Vec2::from_array)
        .collect();
    cut_out(&outline, 0.003, 0.0008)
}

impl Piece {
    /// The mesh of the piece, on z = 0.
    pub fn mesh(self) -> Mesh {
        match self {
            Self::Knife => {
                let blade =
                    [[0.0035, 0.02], [0.0085, 0.03], [0.010, 0.09], [0.004, 0.115], [-0.006, 0.11], [-0.008, 0.06], [-0.0055, 0.02]];
                let blade: Vec<Vec2> = blade.into_iter().map(Vec2::from_array).collect();
                handle().with(cut_out(&blade, 0.0018, 0.0006).moved(Vec3::new(0.0, 0.0, 0.0005)))
            }
            Self::Fork => {
                let tine = |x: f32| Piece::bent(x, 0.0016, [0.062, 0.105]);
                all([handle(), Piece::bent(0.0, 0.0035, [0.02, 0.045]), Piece::bent(0.0, 0.0105, [0.044, 0.063])]
                    .into_iter()
                    .chain([-0.0085, -0.0028, 0.0028, 0.0085].map(tine)))
            }
            Self::Spoon => {
                let bowl = grid(
                    20,
                    5,
                    |i, j| {
                        let (sin, cos) = ((i % 20) as f32 / 20.0 * std::f32::consts::TAU).sin_cos();
                        let t = 1.0 - j as f32 / 5.0;
                        Vec3::new(0.0205 * t * cos, 0.068 + 0.034 * t * sin, 0.0015 + 0.009 * t * t)
                    },
                    |i, j| Vec2::new(i as f32 * 0.003, j as f32 * 0.005),
                );
                let back = bowl.clone();
                let back = Mesh { triangles: back.triangles.iter().map(|&[p, q, r]| [p, r, q]).collect(), ..back }
                    .moved(Vec3::new(0.0, 0.0, -0.0011));
                all([handle(), Piece::bent(0.0, 0.0032, [0.02, 0.04]), bowl.smoothed(60.0), back.smoothed(60.0)])
            }
        }
    }

    /// A flat strip about x of half width `half` that follows the bend of a fork.
    fn bent(x: f32, half: f32, [y0, y1]: [f32; 2]) -> Mesh {
        let lift = |y: f32| 0.012 * ((y - 0.02) / 0.085).clamp(0.0, 1.0).powi(2) - 0.004 * ((y - 0.03) / 0.04).clamp(0.0, 1.0) + 0.004;
        crate::shape::bevelled_box(Vec3::new(2.0 * half, y1 - y0, 0.0018), 0.0006)
            .deformed(|p| {
                let y = p.y + 0.5 * (y0 + y1);
                Vec3::new(x + p.x, y, p.z + lift(y).max(0.0009))
            })
            .smoothed(30.0)
    }
}

impl Furniture for Piece {
    fn random(rng: &mut Rng) -> Self {
        [Self::Knife, Self::Fork, Self::Spoon][rng.below(3)]
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.042, 0.232, 0.014)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, _rng: &mut Rng) {
        let name = ["knife", "fork", "spoon"][*self as usize];
        let object = b.object(name, Class::OtherProp, pose);
        b.part(&object, "body", self.mesh().moved(Vec3::new(0.0, 0.0, CONTACT)), Finish::Chrome);
    }
}

/// A cover for one person at the front edge of a table: plates, cutlery, glasses and a napkin. The person sits at +y.
#[derive(Clone, Copy, Debug)]
pub struct PlaceSetting {
    /// A smaller plate is on the large one.
    pub starter: bool,
    /// A wine glass is beside the tumbler.
    pub wine: bool,
    /// A mat is under it all.
    pub mat: bool,
    /// Colour of mat and napkin.
    pub color: u8,
}

impl PlaceSetting {
    fn napkin(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let napkin = b.object("napkin", Class::OtherProp, pose);
        let folds = all((0..3).map(|k| {
            let size = Vec3::new(0.10 - 0.002 * k as f32, 0.20 - 0.003 * k as f32, 0.003);
            crate::shape::rounded_box(size, 0.0014, 1).moved(Vec3::new(0.001 * k as f32, 0.0, 0.002 + 0.0031 * k as f32))
        }));
        b.part(&napkin, "cloth", folds.uv_moved(Vec2::splat(rng.next_f32())), Finish::Accent(self.color));
    }
}

impl Furniture for PlaceSetting {
    fn random(rng: &mut Rng) -> Self {
        Self { starter: rng.below(2) == 0, wine: rng.below(3) > 0, mat: rng.below(2) == 0, color: rng.below(3) as u8 }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(0.58, if self.mat { 0.46 } else { 0.41 }, 0.22)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        // y of the middle of plates, cutlery and napkin.
        let middle = 0.02;
        let lift = if self.mat { 0.003 } else { 0.0 };
        if self.mat {
            let mat = b.object("place_mat", Class::OtherProp, pose);
            let outline = crate::pieces::form::rounded_rectangle(0.45, 0.33, 0.03, 5);
            b.part(&mat, "weave", cut_out(&outline, 0.0025, 0.0008).moved(Vec3::new(0.0, middle, CONTACT)), Finish::Wicker);
        }
        let at = |x: f32, y: f32, z: f32| on(pose, Vec3::new(x, y, z + lift), 0.0);
        // Pieces point away from the person.
        let piece = |x: f32| on(pose, Vec3::new(x, middle, lift), std::f32::consts::PI);
        let glaze = Finish::Ceramic(rng.below(2) as u8);
        let dinner = b.object("plate", Class::OtherProp, at(0.0, middle, CONTACT));
        b.part(&dinner, "body", plate(0.135), glaze);
        if self.starter {
            let small = b.object("plate", Class::OtherProp, at(0.0, middle, 0.009));
            b.part(&small, "body", plate(0.10), glaze);
        }
        Piece::Fork.build(b, piece(0.165), rng);
        Piece::Knife.build(b, piece(-0.165), rng);
        Piece::Spoon.build(b, piece(-0.195), rng);
        // Glasses stand behind the mat.
        let [tumbler, wine] = if self.mat { [-0.18, -0.185] } else { [-0.14, -0.16] };
        Drinkware::Tumbler.build(b, at(-0.15, tumbler, -lift), rng);
        if self.wine {
            Drinkware::Wine.build(b, at(-0.06, wine, -lift), rng);
        }
        let on_plate = rng.below(2) == 0;
        let napkin = if on_plate { at(0.0, middle, if self.starter { 0.017 } else { 0.009 }) } else { at(0.235, middle, -lift) };
        self.napkin(b, napkin, rng);
        if !on_plate {
            return;
        }
        // A napkin on the plate is held by a ring.
        let ring = b.object("napkin_ring", Class::OtherProp, napkin);
        let band = turned(&[[0.052, -0.012], [0.0535, -0.011], [0.0535, 0.011], [0.052, 0.012], [0.052, -0.012]], 32)
            .deformed(|p| Vec3::new(p.x, -p.z, 0.12 * p.y + 0.0065))
            .smoothed(40.0);
        b.part(&ring, "band", band, Finish::Brass);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::piece_tests::{bodies_of, scene_of};

    #[test]
    fn no_glass_stands_through_a_mat() {
        let scene = scene_of(&PlaceSetting { starter: true, wine: true, mat: true, color: 0 }, 0);
        let (glasses, mats) = (bodies_of(&scene, "glass_"), bodies_of(&scene, "place_mat_"));
        assert_eq!([glasses.len(), mats.len()], [2, 1]);
        assert!(glasses.iter().all(|glass| !glass.meets(&mats[0], Vec3::ZERO)));
    }
}
