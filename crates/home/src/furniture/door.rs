use super::board;
use crate::builder::{Builder, Class};
use crate::room::Room;
use crate::shape::{Reshape, lathe, picture_frame, tube};
use enfilade_math::{Vec2, Vec3};

/// The door in its opening: lining, casing, closed leaf with mouldings, handle, threshold.
#[derive(Clone, Copy, Debug)]
pub struct Door {
    /// Handle on the left (−1) or the right (+1) as the wall's x axis runs.
    pub hand: f32,
}

const LINING: f32 = 0.03;
/// The leaf's faces, behind the wall's inner face.
const LEAF: [f32; 2] = [-0.058, -0.018];

impl Door {
    /// Adds the door of `room`.
    pub fn build(&self, b: &mut Builder, room: &Room) {
        let opening = room.door;
        let pose = super::on(room.wall_pose(opening.wall), Vec3::new(opening.center_x(), 0.0, 0.0), 0.0);
        let door = b.object("door", Class::Door, pose);
        let white = b.materials.paint_white;
        let (half, top) = (0.5 * opening.size().x, opening.z[1]);
        let back = -room.thickness - 0.002;
        // The stop behind the leaf overlaps it on three sides, the threshold on the fourth.
        for (name, s) in [("left", -1.0f32), ("right", 1.0)] {
            let span = |from: f32, to: f32| if s < 0.0 { [-to, -from] } else { [from, to] };
            let [x0, x1] = span(half - LINING, half + 0.003);
            b.part(&door, &format!("lining_{name}"), board([x0, back, -0.01], [x1, 0.002, top], 0.0015), white);
            let [x0, x1] = span(half - LINING - 0.014, half - LINING + 0.002);
            b.part(
                &door,
                &format!("stop_{name}"),
                board([x0, LEAF[0] - 0.03, -0.01], [x1, LEAF[0] + 0.0005, top - LINING + 0.001], 0.001),
                white,
            );
            let [x0, x1] = span(half - 0.012, half + 0.052);
            b.part(&door, &format!("casing_{name}"), board([x0, -0.002, -0.002], [x1, 0.017, top + 0.0523], 0.004), white);
        }
        b.part(&door, "lining_top", board([-half - 0.002, back, top - LINING], [half + 0.002, 0.0025, top + 0.003], 0.0015), white);
        let stop = half - LINING + 0.001;
        b.part(
            &door,
            "stop_top",
            board([-stop, LEAF[0] - 0.03, top - LINING - 0.014], [stop, LEAF[0] + 0.0005, top - LINING + 0.002], 0.001),
            white,
        );
        b.part(&door, "casing_top", board([-half + 0.0118, -0.002, top - 0.012], [half - 0.0118, 0.0165, top + 0.052], 0.004), white);
        b.part(&door, "threshold", board([-half, back, -0.03], [half, LEAF[0] + 0.0005, 0.016], 0.002), b.materials.wood);
        b.part(
            &door,
            "sill_plate",
            board([-half - 0.001, LEAF[0] - 0.001, -0.03], [half + 0.001, 0.02, -0.0015], 0.0005),
            b.materials.wood,
        );
        self.leaf(b, &door, Vec2::new(half - LINING - 0.0025, top - LINING - 0.0025));
    }

    fn leaf(&self, b: &mut Builder, door: &crate::builder::Object, size: Vec2) {
        let white = b.materials.paint_white;
        b.part(door, "leaf", board([-size.x, LEAF[0], 0.005], [size.x, LEAF[1], size.y], 0.002), white);
        let width = 2.0 * size.x - 0.26;
        let section =
            [[0.0, -0.001], [0.002, 0.006], [0.012, 0.009], [0.022, 0.003], [0.024, -0.001]].map(|[inset, y]| [inset, LEAF[1] + y]);
        for (name, z0, z1) in [("panel_lower", 0.18, 0.84), ("panel_upper", 1.0, size.y - 0.15)] {
            let mesh = picture_frame(width, z1 - z0, &section).moved(Vec3::new(0.0, 0.0, 0.5 * (z0 + z1)));
            b.part(door, name, mesh, white);
        }
        let at = Vec3::new(self.hand * (size.x - 0.065), LEAF[1], 1.02);
        let rose = [[0.0, 0.0], [0.026, 0.0], [0.0255, 0.006], [0.022, 0.009], [0.0, 0.009]];
        let plate =
            lathe(&rose.map(Vec2::from_array), 32).turned(Vec3::X, -std::f32::consts::FRAC_PI_2).moved(at - Vec3::new(0.0, 0.0005, 0.0));
        let toward_hinge = -self.hand;
        let path: Vec<Vec3> = [[0.0, 0.0], [0.0, 0.035], [0.004, 0.046], [0.012, 0.052], [0.03, 0.054], [0.125, 0.054]]
            .iter()
            .map(|[x, y]| at + Vec3::new(toward_hinge * x, *y, 0.0))
            .collect();
        b.part(door, "handle", plate.with(tube(&path, 0.0085, 16)), b.materials.steel);
    }
}
