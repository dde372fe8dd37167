//! Beds on an upholstered box: with sides, or as a box spring, and a padded headboard in one of several ways or none.

use super::bed_frame::{Bed, BedFrame, OUT, PADDED};
use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::pieces::seating::{buttoned, upright};
use crate::pieces::{board, leg, on};
use crate::shape::{Reshape, padded_box, rounded_box};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Adds the box below a mattress whose lower face is at `height`, and the headboard.
pub fn frame(this: &Bed, height: f32, b: &mut Builder, bed: &Object, rng: &mut Rng) {
    let cloth = [Finish::SofaCloth, Finish::ArmchairCloth, Finish::Velvet, Finish::Boucle][rng.below(4)];
    let (x, y) = (0.5 * this.width, 0.5 * this.length);
    let boxed = matches!(this.frame, BedFrame::BoxSpring | BedFrame::Divan);
    let top = if boxed { height } else { height + 0.06 };
    let low = 0.09;
    if boxed {
        let sleepers = if this.width < 1.3 { 1 } else { 2 };
        let half = 0.5 * this.width / sleepers as f32;
        for k in 0..sleepers {
            let base = rounded_box(Vec3::new(2.0 * half - 0.004, 2.0 * y, top - low - 0.001), 0.03, 3);
            let at = Vec3::new((2 * k + 1) as f32 * half - x, 0.0, 0.5 * (top + low));
            b.part(bed, &format!("base_{}", k + 1), base.moved(at), cloth);
        }
    } else {
        let side = |sx: f32| {
            let mesh = rounded_box(Vec3::new(OUT + 0.005, 2.0 * y + 0.02, top - low), 0.014, 3);
            mesh.moved(Vec3::new(sx * (x + 0.5 * OUT + 0.002), 0.01, 0.5 * (top + low)))
        };
        b.part(bed, "side_left", side(-1.0), cloth);
        b.part(bed, "side_right", side(1.0), cloth);
        let foot = rounded_box(Vec3::new(2.0 * (x + OUT), OUT, top - low + 0.001), 0.014, 3);
        b.part(bed, "foot", foot.moved(Vec3::new(0.0, y + 0.5 * OUT + 0.002, 0.5 * (top + low))), cloth);
        b.part(bed, "floor", board([-x, -y, low + 0.02], [x, y, height], 0.004), Finish::DarkWood);
    }
    for (i, s) in [Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)].into_iter().enumerate() {
        let at = on(DAffine3::IDENTITY, (s * Vec2::new(x - 0.1, y - 0.1)).extend(0.0), 0.0);
        b.part_at(bed, &format!("foot_{}", i + 1), leg(low + 0.021, [0.016, 0.024], Vec2::ZERO), at, Finish::DarkWood);
    }
    if this.frame != BedFrame::Divan {
        head(this, b, bed, cloth, rng);
    }
}

/// Adds a padded headboard: of channels, plain, buttoned, or between wings.
fn head(this: &Bed, b: &mut Builder, bed: &Object, cloth: Finish, rng: &mut Rng) {
    let (x, y) = (0.5 * this.width + OUT, -0.5 * this.length - 0.003);
    let core = board([-x, y - PADDED, 0.02], [x, y - PADDED + 0.03, this.headboard - 0.012], 0.006);
    b.part(bed, "headboard", core, cloth);
    if this.frame == BedFrame::Buttoned {
        let size = Vec2::new(2.0 * x, this.headboard - 0.14);
        let [panel, buttons] = buttoned(size, 0.058, Vec2::new(0.2, 0.14));
        let place = |mesh: enfilade_geometry::Mesh| mesh.moved(Vec3::new(0.0, y - PADDED + 0.0295, 0.5 * size.y + 0.12));
        b.part(bed, "head_pad", place(panel.uv_moved(Vec2::splat(rng.next_f32()))), cloth);
        return b.part(bed, "head_buttons", place(buttons), cloth);
    }
    if this.frame == BedFrame::Winged {
        // Wings stand beside the pillows and are as high as the headboard.
        for (name, s) in [("wing_left", -1.0f32), ("wing_right", 1.0)] {
            let wing = rounded_box(Vec3::new(0.07, 0.32, this.headboard - 0.02), 0.028, 4);
            let at = Vec3::new(s * (x + 0.038), y - PADDED + 0.16, 0.5 * (this.headboard + 0.02));
            b.part(bed, name, wing.moved(at), cloth);
        }
    }
    let count = if matches!(this.frame, BedFrame::BoxSpring | BedFrame::Winged) {
        1 + rng.below(2)
    } else {
        (2.0 * x / rng.range(0.13, 0.24)) as usize
    };
    let wide = 2.0 * x / count as f32;
    let (low, high) = (0.10, this.headboard);
    for k in 0..count {
        let pad = padded_box(Vec3::new(wide - 0.002, high - low, 0.05), 0.022, if count > 2 { 0.006 } else { 0.004 });
        let at = Vec3::new((k as f32 + 0.5) * wide - x, y - 0.0315, 0.5 * (low + high));
        b.part(bed, &format!("head_pad_{}", k + 1), upright(pad.uv_moved(Vec2::splat(rng.next_f32()))).moved(at), cloth);
    }
}
