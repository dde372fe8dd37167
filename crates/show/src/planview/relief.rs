//! The ground of a chart: what is known of space on the plane, and the surfaces behind it.

use super::chart::Chart;
use super::look::{Seen, meet};
use super::planned::Planned;
use crate::picture::Picture;
use enfilade_geometry::Voxel;
use enfilade_math::DVec3;
use enfilade_math::quantile;

/// sRGB of free space, where the surface behind is far from the plane.
pub(super) const FREE: [u8; 3] = [224, 238, 250];
/// Free, and no surface behind it.
pub(super) const FREE_OVER_VOID: [u8; 3] = [252, 226, 214];
/// A voxel that a surface passes through.
pub(super) const OCCUPIED: [u8; 3] = [160, 156, 152];
/// Space that no ray has reached.
pub(super) const UNKNOWN: [u8; 3] = [243, 241, 237];
pub(super) const UNKNOWN_HATCH: [u8; 3] = [221, 217, 210];
/// Furniture just behind the plane.
pub(super) const NEAR: [u8; 3] = [174, 184, 198];

/// Samples along each side of a pixel.
const OVERSAMPLING: u32 = 2;
/// Depths that differ by more than this are divided by a line, metres.
const EDGE_M: f32 = 0.05;
/// Brightness of that line, over what it would be without.
const EDGE_SHADE: f64 = 0.6;
/// Brightness of the line between two parts at about the same depth.
const SEAM_SHADE: f64 = 0.88;
/// Pixels from one hatch line to the next, along x.
const HATCH_PX: u32 = 12;
/// From this share of the depths on, surfaces are shown as far.
const FAR_QUANTILE: f64 = 0.9;

/// Space at one sample of the plane, and the surface behind it where it is free.
#[derive(Clone, Copy)]
enum Ground {
    Unknown,
    Occupied,
    Free(Option<Behind>),
}

#[derive(Clone, Copy)]
struct Behind {
    depth_m: f32,
    part: u32,
    cosine: f32,
}

/// The chart's rectangle, opaque.
pub(super) fn relief(planned: &Planned<'_>, chart: &Chart) -> Picture {
    let [left, top, width, height] = chart.place;
    let (columns, rows) = (width * OVERSAMPLING, height * OVERSAMPLING);
    let away = -chart.cut.look.axes()[2];
    let sample = |i: usize| {
        let i = i as u32;
        let part = |pixel: u32, sample: u32| f64::from(pixel) + (f64::from(sample) + 0.5) / f64::from(OVERSAMPLING);
        let p = chart.to_world([part(left, i % columns), part(top, i / columns)]);
        ground(planned, p, away)
    };
    let samples: Vec<Ground> = enfilade_parallel::map_up_to((columns * rows) as usize, sample);
    let far_m = far(&samples);
    let color_of = |x: u32, y: u32| {
        let at = |x: u32, y: u32| samples[(y.min(rows - 1) * columns + x.min(columns - 1)) as usize];
        let here = at(x, y);
        let shade = edge_shade(here, at(x + 1, y)).min(edge_shade(here, at(x, y + 1)));
        let [r, g, b] = color(here, far_m, (x + y) / OVERSAMPLING % HATCH_PX < 1);
        [shade * r, shade * g, shade * b]
    };
    Picture::from_fn(width, height, |x, y| {
        let mut sum = [0.0; 3];
        for i in 0..OVERSAMPLING * OVERSAMPLING {
            let color = color_of(x * OVERSAMPLING + i % OVERSAMPLING, y * OVERSAMPLING + i / OVERSAMPLING);
            (0..3).for_each(|c| sum[c] += color[c]);
        }
        let [r, g, b] = sum.map(|v| (v / f64::from(OVERSAMPLING * OVERSAMPLING)).round() as u8);
        image::Rgba([r, g, b, 255])
    })
}

fn ground(planned: &Planned<'_>, p: DVec3, away: DVec3) -> Ground {
    match planned.tree.state(p) {
        Voxel::Unknown => Ground::Unknown,
        Voxel::Occupied => Ground::Occupied,
        Voxel::Free => {
            let behind = |seen: Seen| Behind { depth_m: seen.distance_m as f32, part: seen.part, cosine: seen.cosine as f32 };
            Ground::Free(meet(planned.world, planned.bvh, p, away).map(behind))
        }
    }
}

fn far(samples: &[Ground]) -> f64 {
    let depth = |ground: &Ground| if let Ground::Free(Some(behind)) = ground { Some(f64::from(behind.depth_m)) } else { None };
    let mut depths: Vec<f64> = samples.iter().filter_map(depth).collect();
    quantile(&mut depths, FAR_QUANTILE).unwrap_or(1.0).max(0.1)
}

/// Brightness of the border between two samples, 1 where there is none.
fn edge_shade(a: Ground, b: Ground) -> f64 {
    match (a, b) {
        (Ground::Free(Some(a)), Ground::Free(Some(b))) => {
            // Neighbours on a slanted surface differ too.
            let jump = (a.depth_m - b.depth_m).abs() > EDGE_M * (0.5 + 0.5 / a.cosine.max(0.1));
            if jump {
                EDGE_SHADE
            } else if a.part != b.part {
                SEAM_SHADE
            } else {
                1.0
            }
        }
        (Ground::Free(a), Ground::Free(b)) if a.is_some() != b.is_some() => EDGE_SHADE,
        _ => 1.0,
    }
}

/// sRGB, 0 to 255. Nearer surfaces are greyer, slanted ones darker.
fn color(ground: Ground, far_m: f64, hatched: bool) -> [f64; 3] {
    match ground {
        Ground::Unknown => if hatched { UNKNOWN_HATCH } else { UNKNOWN }.map(f64::from),
        Ground::Occupied => OCCUPIED.map(f64::from),
        Ground::Free(None) => FREE_OVER_VOID.map(f64::from),
        Ground::Free(Some(behind)) => {
            let near = (1.0 - f64::from(behind.depth_m) / far_m).clamp(0.0, 1.0).powf(0.7);
            let light = 0.84 + 0.16 * f64::from(behind.cosine);
            std::array::from_fn(|c| light * (f64::from(FREE[c]) + near * (f64::from(NEAR[c]) - f64::from(FREE[c]))))
        }
    }
}
