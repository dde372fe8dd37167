//! What upholstered seats stand on.

use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::pieces::form::{all, corners, turned};
use crate::pieces::{board, leg};
use crate::shape::{Reshape, grid, rounded_loop};
use enfilade_geometry::Mesh;
use enfilade_math::Vec2;
use std::f32::consts::PI;

/// What an upholstered seat stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeatFeet {
    /// Four round legs that taper and slant outward.
    Tapered(Finish),
    /// Four square blocks.
    Blocks(Finish),
    /// Four turned balls.
    Buns(Finish),
    /// Two frames of flat metal.
    Runners(Finish),
    /// A plinth that is set back.
    Plinth,
    /// Cloth in folds that hides the feet.
    Skirt,
}

impl SeatFeet {
    /// Adds feet `height` high below a body of this half width and half depth; a skirt is of `cover`.
    pub fn add(self, b: &mut Builder, object: &Object, half: Vec2, height: f32, cover: Finish) {
        let blocks = |b: &mut Builder, finish: Finish| {
            for (i, at) in corners(half - 0.09).into_iter().enumerate() {
                let block = board([at.x - 0.03, at.y - 0.03, 0.0], [at.x + 0.03, at.y + 0.03, height + 0.003], 0.004);
                b.part(object, &format!("foot_{}", i + 1), block, finish);
            }
        };
        match self {
            Self::Tapered(finish) => {
                for (i, at) in corners(half - 0.1).into_iter().enumerate() {
                    let mesh = leg(height + 0.003, [0.012, 0.021], at.signum() * 0.03).moved(at.extend(0.0));
                    b.part(object, &format!("leg_{}", i + 1), mesh, finish);
                }
            }
            Self::Blocks(finish) => blocks(b, finish),
            Self::Buns(finish) => {
                let h = height + 0.003;
                let profile = [
                    [0.0, 0.0],
                    [0.026, 0.0],
                    [0.042, 0.3 * h],
                    [0.045, 0.5 * h],
                    [0.038, 0.75 * h],
                    [0.022, 0.88 * h],
                    [0.026, h],
                    [0.0, h],
                ];
                for (i, at) in corners(half - 0.09).into_iter().enumerate() {
                    b.part(object, &format!("foot_{}", i + 1), turned(&profile, 28).moved(at.extend(0.0)), finish);
                }
            }
            Self::Runners(finish) => {
                for (name, s) in [("runner_left", -1.0f32), ("runner_right", 1.0)] {
                    let (x, y) = (s * (half.x - 0.1), half.y - 0.09);
                    let bar = |y: [f32; 2], z: [f32; 2]| board([x - 0.025, y[0], z[0]], [x + 0.025, y[1], z[1]], 0.001);
                    let low = bar([-y, y], [0.0, 0.008]);
                    let posts = [-1.0f32, 1.0].map(|e| {
                        let end = [e * y, e * (y - 0.008)];
                        bar([end[0].min(end[1]), end[0].max(end[1])], [0.0078, height + 0.004])
                    });
                    b.part(object, name, low.with(all(posts)), finish);
                }
            }
            Self::Plinth => {
                let (x, y) = (half.x - 0.05, half.y - 0.06);
                b.part(object, "plinth", board([-x, -y, 0.0], [x, y, height + 0.003], 0.002), Finish::DarkWood);
            }
            Self::Skirt => {
                blocks(b, Finish::DarkWood);
                let folds = skirt(2.0 * half - 0.01, [0.012, height + 0.01]);
                b.part(object, "skirt", folds, cover);
            }
        }
    }
}

/// Cloth in folds around a rectangle of this width and depth, between two heights: a band that is closed.
pub fn skirt(size: Vec2, [low, high]: [f32; 2]) -> Mesh {
    /// Distance from fold to fold, metres.
    const FOLD: f32 = 0.09;
    let path = rounded_loop(size.x, size.y, 0.03, 4);
    let mut points: Vec<(Vec2, Vec2, f32)> = Vec::new();
    let mut along = 0.0;
    for pair in path.windows(2) {
        let (from, to) = (pair[0].truncate(), pair[1].truncate());
        let length = from.distance(to);
        let steps = (length / (0.125 * FOLD)).ceil() as usize;
        let out = -(to - from).normalize_or(Vec2::X).perp();
        points.extend((0..steps).map(|k| {
            let t = k as f32 / steps as f32;
            (from.lerp(to, t), out, along + t * length)
        }));
        along += length;
    }
    let folds = (along / FOLD).round();
    let n = points.len();
    let point = |i: usize, j: usize| {
        let (p, out, s) = points[j % n];
        let wave = 0.5 * (1.0 - (2.0 * PI * folds * s / along).cos());
        // The section runs around the cloth, which is 4 mm thick: up its inner side and down its outer one.
        let (outside, top) = ([false, false, true, true, false][i], [false, true, true, false, false][i]);
        let off = 0.005 * wave * if top { 0.2 } else { 1.0 } - if outside { 0.0 } else { 0.004 };
        (p + out * (off - 0.005)).extend(if top { high } else { low })
    };
    let uv = |i: usize, j: usize| Vec2::new(points.get(j).map_or(along, |p| p.2), 0.1 * i as f32);
    grid(4, n, point, uv).smoothed(50.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::volume;

    #[test]
    fn a_skirt_is_closed_and_within_its_rectangle() {
        let mesh = skirt(Vec2::new(2.0, 0.9), [0.01, 0.2]);
        assert_eq!(mesh.validate(), Ok(()));
        assert!(mesh.positions.iter().all(|p| p.x.abs() < 1.0 + 1e-4 && p.y.abs() < 0.45 + 1e-4 && p.z > 0.0099));
        // The perimeter is 5.75 m long, the cloth 19 cm high and 4 mm thick.
        let filled = volume(&mesh);
        assert!((filled - 5.75 * 0.19 * 0.004).abs() < 0.1 * filled, "{filled}");
    }

    #[test]
    fn every_kind_stands_on_the_floor_and_reaches_the_body() {
        let kinds = [
            SeatFeet::Tapered(Finish::Wood),
            SeatFeet::Blocks(Finish::Wood),
            SeatFeet::Buns(Finish::Wood),
            SeatFeet::Runners(Finish::BlackMetal),
            SeatFeet::Plinth,
            SeatFeet::Skirt,
        ];
        for kind in kinds {
            let mut b = crate::pieces::piece_tests::nothing();
            let object = b.object("sofa", crate::builder::Class::Sofa, enfilade_math::DAffine3::IDENTITY);
            kind.add(&mut b, &object, Vec2::new(1.0, 0.45), 0.12, Finish::SofaCloth);
            let scene = b.finish().0;
            let heights = scene.parts.iter().flat_map(|part| scene.world_positions(part)).map(|p| p.z);
            let (low, high) = heights.fold((f32::INFINITY, 0.0f32), |(low, high), z| (low.min(z), high.max(z)));
            assert!(low.abs() < 1e-5 && (0.12..0.135).contains(&high), "{kind:?}: {low} to {high}");
        }
    }
}
