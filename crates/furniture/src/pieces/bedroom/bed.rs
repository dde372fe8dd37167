//! Beds for one (mattress 90 to 120 cm wide) or two (140 to 180 cm), 200 to 210 cm long, on a frame of the tables [`FRAMES`], most of them
//! with a headboard 92 to 115 cm high; class bed. What lies on them is in `bedding`. The head is at −y; the frame is built in a space whose
//! origin is below the middle of the mattress.

use super::bed_frame::{BOARD, Bed, BedFrame, OUT, PADDED};
use super::bedding::{Bedding, Cover};
use super::{bunk, frames, upholstered};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::style::drawn;
use crate::pieces::{Furniture, on};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// The frames with their weights, for beds of one and of two.
const FRAMES: [&[(u32, BedFrame)]; 2] = [
    &[
        (3, BedFrame::Panel),
        (3, BedFrame::Slats),
        (2, BedFrame::Upholstered),
        (2, BedFrame::BoxSpring),
        (2, BedFrame::Metal),
        (1, BedFrame::Buttoned),
        (1, BedFrame::Divan),
        (1, BedFrame::Rattan),
        (1, BedFrame::FourPoster),
        (1, BedFrame::Sleigh),
        (2, BedFrame::Platform),
        (3, BedFrame::Storage),
        (2, BedFrame::Iron),
        (3, BedFrame::Sided),
        (3, BedFrame::Bunk),
    ],
    &[
        (2, BedFrame::Panel),
        (2, BedFrame::Slats),
        (2, BedFrame::Upholstered),
        (2, BedFrame::BoxSpring),
        (1, BedFrame::Metal),
        (2, BedFrame::Buttoned),
        (1, BedFrame::Winged),
        (1, BedFrame::Divan),
        (1, BedFrame::Rattan),
        (2, BedFrame::FourPoster),
        (2, BedFrame::Sleigh),
        (3, BedFrame::Platform),
        (2, BedFrame::Storage),
        (2, BedFrame::Iron),
    ],
];

impl Bed {
    /// A bed for this many sleepers, 1 or 2.
    pub fn for_sleepers(sleepers: usize, rng: &mut Rng) -> Self {
        let width = if sleepers == 1 { [0.9, 0.9, 1.0, 1.2][rng.below(4)] } else { [1.4, 1.6, 1.6, 1.8][rng.below(4)] };
        Self {
            width,
            length: [2.0, 2.0, 2.1][rng.below(3)],
            frame: drawn(FRAMES[sleepers.clamp(1, 2) - 1], rng),
            cover: [Cover::Duvet, Cover::Duvet, Cover::OpenCorner, Cover::Bedspread][rng.below(4)],
            cushions: if sleepers == 1 { rng.below(2) } else { rng.below(4) },
            throw: rng.below(3) == 0,
            headboard: rng.range(0.92, 1.15),
        }
    }

    fn head_depth(&self) -> f32 {
        match self.frame {
            BedFrame::Panel | BedFrame::Slats | BedFrame::Metal | BedFrame::Platform => BOARD,
            BedFrame::Upholstered | BedFrame::BoxSpring | BedFrame::Buttoned | BedFrame::Winged => PADDED,
            BedFrame::Divan => 0.03,
            BedFrame::Rattan | BedFrame::Iron | BedFrame::Sided => 0.055,
            BedFrame::FourPoster | BedFrame::Bunk => 0.08,
            BedFrame::Sleigh => 0.2,
            BedFrame::Storage => 0.21,
        }
    }

    /// Heights of the mattress's lower face, thickness of the mattress, half the width and length around which the cover hangs beyond the
    /// mattress's, and how far it hangs down at most.
    fn lying(&self) -> [f32; 5] {
        match self.frame {
            BedFrame::BoxSpring | BedFrame::Divan => [0.34, 0.24, OUT, OUT, 0.27],
            BedFrame::Upholstered | BedFrame::Buttoned | BedFrame::Winged => [0.28, 0.22, OUT, OUT, 0.27],
            BedFrame::Panel | BedFrame::Slats | BedFrame::Metal | BedFrame::Rattan => [0.26, 0.20, OUT, OUT, 0.27],
            BedFrame::Platform => [0.18, 0.22, 0.005, 0.005, 0.17],
            BedFrame::Storage => [0.34, 0.20, OUT, OUT, 0.15],
            BedFrame::Sleigh | BedFrame::Iron => [0.26, 0.22, OUT + 0.01, 0.005, 0.22],
            BedFrame::FourPoster => [0.26, 0.24, 0.005, 0.005, 0.22],
            BedFrame::Sided => [0.26, 0.17, 0.005, 0.005, 0.16],
            BedFrame::Bunk => [bunk::BUNKS[0], 0.16, 0.005, 0.005, 0.12],
        }
    }

    fn bedding(&self) -> Bedding {
        let mattress = Vec2::new(self.width, self.length);
        let [base, thickness, beside, before, most] = self.lying();
        // A corner of the bedspread hangs lower by the factor √2, and must not reach the floor.
        let free = (base + thickness - 0.09) / std::f32::consts::SQRT_2;
        // What stands around the mattress lets no cover hang to the floor.
        let hang = if self.cover == Cover::Bedspread && most > 0.26 { free } else { most };
        let sleepers = if self.width < 1.3 { 1 } else { 2 };
        let around = 0.5 * mattress + Vec2::new(beside, before);
        Bedding { mattress, base, thickness, around, hang, cover: self.cover, sleepers, cushions: self.cushions, throw: self.throw }
    }
}

impl Bed {
    /// Height of the box around bed and pillows.
    fn height(&self) -> f32 {
        match self.frame {
            BedFrame::FourPoster => frames::POSTS + 0.01,
            BedFrame::Bunk => bunk::BUNKS[1] + 0.76,
            _ => (self.headboard + 0.12).max(1.22),
        }
    }
}

impl Furniture for Bed {
    fn random(rng: &mut Rng) -> Self {
        let sleepers = 1 + usize::from(rng.below(4) > 0);
        Self::for_sleepers(sleepers, rng)
    }

    fn size(&self) -> Vec3 {
        // Covers hang around most frames, and what stands around the others is within the same space.
        let cover = 2.0 * (OUT + 0.17);
        let foot = if self.frame == BedFrame::Sleigh { 0.08 } else { 0.0 };
        Vec3::new(self.width + cover, self.length + self.head_depth() + 0.5 * cover + foot + 0.005, self.height())
    }

    fn reach(&self) -> f32 {
        0.6
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let middle = -0.5 * self.size().y + self.head_depth() + 0.005 + 0.5 * self.length;
        let pose = on(pose, Vec3::new(0.0, middle, 0.0), 0.0);
        let bed = b.object("bed", Class::Bed, pose);
        match self.frame {
            BedFrame::Panel | BedFrame::Slats => {
                self.wooden(b, &bed, rng);
                self.wooden_head(b, &bed, rng);
            }
            BedFrame::Rattan => {
                self.wooden(b, &bed, rng);
                frames::arched_head(self, b, &bed, Finish::Rattan);
            }
            BedFrame::Upholstered | BedFrame::BoxSpring | BedFrame::Buttoned | BedFrame::Winged | BedFrame::Divan => {
                upholstered::frame(self, self.bedding().base, b, &bed, rng);
            }
            BedFrame::Metal => self.metal(b, &bed),
            BedFrame::FourPoster => frames::four_poster(self, b, &bed, rng),
            BedFrame::Sleigh => frames::sleigh(self, b, &bed, rng),
            BedFrame::Platform => frames::platform(self, b, &bed, rng),
            BedFrame::Storage => frames::storage(self, b, &bed, rng),
            BedFrame::Iron => frames::iron(self, b, &bed, rng),
            BedFrame::Sided => bunk::sided(self, b, &bed, rng),
            BedFrame::Bunk => bunk::bunk(self, b, &bed, rng),
        }
        if self.frame == BedFrame::Bunk {
            let upper = Bedding { base: bunk::BUNKS[1], cushions: 0, throw: false, ..self.bedding() };
            // What lies on the upper bed is an object of its own: names of parts are unique.
            let above = b.object("bed", Class::Bed, pose);
            upper.build(b, &above, pose, rng);
        }
        self.bedding().build(b, &bed, pose, rng);
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
        for (sleepers, frames) in [1, 2].into_iter().zip(FRAMES) {
            for &(_, frame) in frames {
                let bed = Bed { frame, ..Bed::for_sleepers(sleepers, &mut rng) };
                things.push((format!("{frame:?} for {sleepers}"), Box::new(bed)));
            }
        }
        check(Place::AgainstWall, &things);
    }
}
