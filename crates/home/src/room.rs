//! The shell: walls of real thickness with a window and a door, floor, ceiling, skirting.

use crate::builder::{Builder, Class, pose};
use crate::furniture::board;
use crate::shape::{Reshape, slab_with_openings};
use crate::texture::FLOOR_STRIPS;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// One of the four walls. The room's centre is the origin; north is +y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Wall {
    South,
    East,
    North,
    West,
}

impl Wall {
    /// All, counter-clockwise from the south.
    pub const ALL: [Self; 4] = [Self::South, Self::East, Self::North, Self::West];

    /// The wall `steps` further, counter-clockwise.
    pub fn turned(self, steps: usize) -> Self {
        Self::ALL[(self as usize + steps) % 4]
    }

    /// Unit vector into the room.
    pub fn inward(self) -> Vec2 {
        [Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y, Vec2::X][self as usize]
    }

    /// Unit vector along the wall: a wall's own x axis, to the left for someone who faces it.
    pub fn along(self) -> Vec2 {
        let n = self.inward();
        Vec2::new(n.y, -n.x)
    }

    /// Rotation that takes +y to [`Wall::inward`].
    pub fn yaw(self) -> f64 {
        [0.0, FRAC_PI_2, PI, -FRAC_PI_2][self as usize]
    }
}

/// A hole in a wall, in the wall's own coordinates: x along it from its middle, z up from the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Which wall.
    pub wall: Wall,
    /// From and to along the wall.
    pub x: [f32; 2],
    /// From and to above the floor.
    pub z: [f32; 2],
}

impl Opening {
    /// Width and height.
    pub fn size(&self) -> Vec2 {
        Vec2::new(self.x[1] - self.x[0], self.z[1] - self.z[0])
    }

    /// Middle along the wall.
    pub fn center_x(&self) -> f32 {
        0.5 * (self.x[0] + self.x[1])
    }
}

/// A rectangular room around the origin.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// Inner size: x, y, z.
    pub size: Vec3,
    /// Thickness of the walls.
    pub thickness: f32,
    /// The window.
    pub window: Opening,
    /// The door.
    pub door: Opening,
    /// The wall in the accent colour.
    pub accent: Wall,
}

/// How far floor, walls and ceiling reach into each other, so that no light comes through the joints.
const OVERLAP: f32 = 0.1;
const SKIRTING: Vec2 = Vec2::new(0.014, 0.085);

impl Room {
    /// Inner length of a wall.
    pub fn length(&self, wall: Wall) -> f32 {
        if wall.along().x == 0.0 { self.size.y } else { self.size.x }
    }

    /// A wall's own space: origin on the floor at the middle of its inner face, x along it, y into the room.
    pub fn wall_pose(&self, wall: Wall) -> DAffine3 {
        let p = -wall.inward() * 0.5 * Vec2::new(self.size.x, self.size.y);
        pose(f64::from(p.x), f64::from(p.y), 0.0, wall.yaw())
    }

    /// Adds walls, floor, ceiling and skirting.
    pub fn build(&self, b: &mut Builder, rng: &mut Rng) {
        for wall in Wall::ALL {
            let object = b.object(&format!("wall_{wall:?}").to_lowercase(), Class::Wall, self.wall_pose(wall));
            let corner = if wall.along().x == 0.0 { OVERLAP } else { self.thickness };
            let holes: Vec<[f32; 4]> = [self.window, self.door]
                .iter()
                .filter(|o| o.wall == wall)
                .map(|o| [o.x[0], o.x[1], if o.z[0] <= 0.0 { -OVERLAP } else { o.z[0] }, o.z[1]])
                .collect();
            let height = [-OVERLAP, self.size.z + OVERLAP];
            let mesh = slab_with_openings(self.length(wall) + 2.0 * corner, height, self.thickness, &holes);
            let paint = if wall == self.accent { b.materials.accent_wall } else { b.materials.wall };
            b.part(&object, "plaster", mesh.uv_moved(Vec2::new(rng.range(0.0, 2.0), rng.range(0.0, 2.0))), paint);
        }
        let outer = 0.5 * self.size.truncate() + self.thickness;
        let slab = |z0: f32, z1: f32| board([-outer.x, -outer.y, z0], [outer.x, outer.y, z1], 0.001);
        let ceiling = b.object("ceiling", Class::Ceiling, DAffine3::IDENTITY);
        b.part(&ceiling, "plaster", slab(self.size.z, self.size.z + 0.2), b.materials.ceiling);
        let floor = b.object("floor", Class::Floor, DAffine3::IDENTITY);
        b.part(&floor, "planks", self.planks(rng), b.materials.floor);
        b.part(&floor, "screed", slab(-0.3, -0.02), b.materials.ceiling);
        self.skirting(b);
    }

    fn skirting(&self, b: &mut Builder) {
        let object = b.object("skirting", Class::OtherStructure, DAffine3::IDENTITY);
        for wall in Wall::ALL {
            let half = 0.5 * self.length(wall) - if wall.along().x == 0.0 { SKIRTING.x + 0.0005 } else { 0.0 };
            let mut runs = vec![[-half, half]];
            if self.door.wall == wall {
                runs = vec![[-half, self.door.x[0] - 0.06], [self.door.x[1] + 0.06, half]];
            }
            for (i, run) in runs.iter().filter(|r| r[1] - r[0] > 0.02).enumerate() {
                let mesh = board([run[0], -0.002, -0.002], [run[1], SKIRTING.x, SKIRTING.y], 0.004);
                let name = format!("{wall:?}_{}", i + 1).to_lowercase();
                b.part_at(&object, &name, mesh, self.wall_pose(wall), b.materials.paint_white);
            }
        }
    }

    /// Floorboards along x, laid in staggered rows with bevelled joints, a little way under the walls.
    fn planks(&self, rng: &mut Rng) -> Mesh {
        const WIDTH: f32 = 0.165;
        const BEVEL: Vec2 = Vec2::new(0.0016, 0.0012);
        let half = 0.5 * self.size.truncate() + 0.05;
        let mut mesh = Mesh::default();
        let mut y = -half.y;
        while y < half.y {
            let y1 = (y + WIDTH).min(half.y);
            let mut x = -half.x;
            let mut length = rng.range(0.5, 1.8);
            while x < half.x {
                let x1 = if half.x - x - length < 0.35 { half.x } else { x + length };
                let strip = (rng.below(FLOOR_STRIPS) as f32 + 0.03) / FLOOR_STRIPS as f32;
                let start = Vec2::new(rng.range(0.0, 2.0 - (x1 - x).min(1.99)), strip);
                plank(&mut mesh, [x, x1], [y, y1], BEVEL, start, rng.below(2) == 0);
                x = x1;
                length = rng.range(1.1, 1.6);
            }
            y = y1;
        }
        mesh.smoothed(20.0)
    }
}

/// One floorboard with its top at z = 0: a raised field inside four bevels that go down to the joints.
fn plank(mesh: &mut Mesh, x: [f32; 2], y: [f32; 2], bevel: Vec2, uv: Vec2, turned: bool) {
    let base = mesh.positions.len() as u32;
    for (inset, z) in [(0.0, -bevel.y), (bevel.x, 0.0)] {
        for (cx, cy) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let shift = |c: usize| if c == 0 { inset } else { -inset };
            let p = Vec3::new(x[cx] + shift(cx), y[cy] + shift(cy), z);
            mesh.positions.push(p);
            let q = Vec2::new(p.x - x[0], p.y - y[0]);
            let q = if turned { Vec2::new(x[1] - x[0], y[1] - y[0]) - q } else { q };
            mesh.uvs.push(uv + Vec2::new(q.x, q.y * 0.7));
        }
    }
    let mut quad = |a: u32, b: u32, c: u32, d: u32| {
        mesh.triangles.extend([[base + a, base + b, base + c], [base + a, base + c, base + d]]);
    };
    quad(4, 5, 6, 7);
    (0..4).for_each(|k| quad(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k));
}
