//! Floorboards.

use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};
use enfilade_textures::FLOOR_STRIPS;

/// Floorboards along x over a rectangle, laid in staggered rows with bevelled joints; without normals.
pub(super) fn planks([low, high]: [Vec2; 2], rng: &mut Rng) -> Mesh {
    /// Width of a board, metres.
    const WIDTH: f32 = 0.165;
    /// Width and depth of the bevel along its edges, metres.
    const BEVEL: Vec2 = Vec2::new(0.0016, 0.0012);
    let mut mesh = Mesh::default();
    let mut y = low.y;
    while y < high.y {
        let y1 = (y + WIDTH).min(high.y);
        let mut x = low.x;
        let mut length = rng.range(0.5, 1.8);
        while x < high.x {
            let x1 = if high.x - x - length < 0.35 { high.x } else { x + length };
            let strip = (rng.below(FLOOR_STRIPS) as f32 + 0.03) / FLOOR_STRIPS as f32;
            let start = Vec2::new(rng.range(0.0, 2.0 - (x1 - x).min(1.99)), strip);
            plank(&mut mesh, [x, x1], [y, y1], BEVEL, start, rng.below(2) == 0);
            x = x1;
            length = rng.range(1.1, 1.6);
        }
        y = y1;
    }
    mesh
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
