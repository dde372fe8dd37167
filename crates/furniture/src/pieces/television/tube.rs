//! Television sets with a picture tube.

use super::set_kind::TelevisionSet;
use crate::builder::{Builder, Object};
use crate::materials::Finish;
use crate::pieces::board;
use crate::pieces::form::{all, rod};
use crate::shape::{Reshape, rounded_box};
use enfilade_math::Vec3;

/// A box with a picture tube: a deep case that narrows towards its rear.
pub fn tube(set: &TelevisionSet, b: &mut Builder, tv: &Object) {
    let [width, height] = set.screen();
    let (chin, depth) = (0.09, set.depth());
    let tall = chin + height + set.bezel;
    let front = rounded_box(Vec3::new(set.width, 0.09, tall), 0.014, 3);
    b.part(tv, "housing", front.moved(Vec3::new(0.0, 0.5 * depth - 0.045, 0.5 * tall)), set.finish);
    let long = depth - 0.08;
    let rear = rounded_box(Vec3::new(set.width - 0.03, long, tall - 0.02), 0.03, 3).deformed(|p| {
        let back = (0.5 - p.y / long).clamp(0.0, 1.0);
        let [wide, high] = [1.0 - 0.42 * back, 1.0 - 0.34 * back];
        Vec3::new(p.x * wide, p.y, (p.z + 0.5 * tall - 0.01) * high - 0.5 * tall + 0.01)
    });
    let at = Vec3::new(0.0, 0.5 * depth - 0.08 - 0.5 * long, 0.5 * tall + 0.0005);
    b.part(tv, "back", rear.smoothed(50.0).moved(at), Finish::BlackPlastic);
    let face = 0.5 * depth;
    let rim = crate::shape::picture_frame(width + 0.03, height + 0.03, &[[0.0, -0.004], [0.0, 0.002], [0.015, -0.002], [0.015, -0.004]]);
    let middle = Vec3::new(0.0, face + 0.0015, chin + 0.5 * height);
    b.part(tv, "rim", rim.moved(middle - Vec3::Y * 0.0015), Finish::BlackPlastic);
    // The screen bulges by 6 mm.
    let bulge = |p: Vec3| Vec3::new(p.x, p.y + 0.006 * (1.0 - (2.0 * p.x / width).powi(2)) * (1.0 - (2.0 * p.z / height).powi(2)), p.z);
    if let Some(shows) = set.shows {
        let at = |i: usize, j: usize| Vec3::new(width * (0.5 - i as f32 / 12.0), 0.0, height * (j as f32 / 12.0 - 0.5));
        let uv = |i: usize, j: usize| enfilade_math::Vec2::new(i as f32, j as f32) / 12.0;
        let mesh = crate::shape::grid(12, 12, |i, j| bulge(at(i, j)), uv).smoothed(60.0);
        b.part(tv, "screen", mesh.moved(middle), Finish::ScreenOn(shows));
    } else {
        let pane = crate::shape::bendable_box(Vec3::new(width, 0.004, height), 0.001, [12, 1, 12]).deformed(bulge).smoothed(60.0);
        b.part(tv, "screen", pane.moved(middle - Vec3::Y * 0.002), Finish::Screen);
    }
    let speaker =
        |s: f32| board([s * 0.3 * set.width - 0.06, face - 0.002, 0.022], [s * 0.3 * set.width + 0.06, face + 0.002, 0.06], 0.001);
    b.part(tv, "loudspeakers", speaker(-1.0).with(speaker(1.0)), Finish::Felt);
    let knobs = (0..4).map(|k| {
        let x = -0.03 + 0.02 * k as f32;
        rod([x, face - 0.002, 0.04], [x, face + 0.004, 0.04], 0.005, 10)
    });
    b.part(tv, "knobs", all(knobs), Finish::BlackPlastic);
}
