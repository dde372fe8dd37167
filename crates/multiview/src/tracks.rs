//! Points on surfaces, followed through the frames of a camera.
//!
//! Points are seeded evenly over time and over the image: point i of N in frame i T / N of T, at the pixel given by the evenly spaced R2
//! sequence (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"); if that pixel shows nothing, at the next one. A point
//! stays on its part, which may move. It is occluded where it is outside of the image, or a ray from the camera meets something before it,
//! as in `flow_visibility`.

use crate::filmed::SurfacePoint;
use crate::{Filmed, MultiviewError, ScenePackage};
use enfilade_dataset::Tracks;
use enfilade_math::{DVec3, hash_u64};
use enfilade_render::Lookout;
use enfilade_scene::{CameraView, Counted, Cx};

/// The generalised golden ratio of two dimensions, the real root of x³ = x + 1.
const GOLDEN: f64 = 1.324_717_957_244_746;
/// Number of pixels tried for a point. A point without a pixel is left out: its frame shows next to nothing.
const TRIES: u64 = 64;

/// How points are seeded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TracksConfig {
    /// Number of points.
    pub points: u32,
    /// Another seed gives other points.
    pub seed: u64,
}

impl Default for TracksConfig {
    fn default() -> Self {
        Self { points: 256, seed: 0 }
    }
}

/// A point, where it was seeded.
struct Seed {
    /// Place of the frame among those that are followed.
    frame: u32,
    pixel: [u32; 2],
    point: SurfacePoint,
}

/// Follows points through `frames`, which are of one camera, in their order. `package` is of the scene that was filmed.
///
/// # Errors
/// When a frame cannot be used.
pub fn tracks(
    filmed: &Filmed<'_>,
    package: &ScenePackage,
    frames: &[usize],
    config: TracksConfig,
    cx: &dyn Cx,
) -> Result<Tracks, MultiviewError> {
    let counted = Counted::new(cx, "frames", frames.len());
    let seeds = |place: usize| counted.unit(|| seeds(filmed, package, frames, place, config));
    let seeds: Vec<Vec<Seed>> = enfilade_parallel::try_map_up_to(frames.len(), seeds)?;
    let seeds: Vec<Seed> = seeds.into_iter().flatten().collect();
    // By frame, then point: a scene that moves is another one in each frame.
    let still = package.scene.is_still().then(|| package.lookout()).transpose()?;
    let mut followed = Vec::with_capacity(frames.len());
    for (place, &frame) in frames.iter().enumerate() {
        let view = filmed.view(frame);
        let moment = still.is_none().then(|| filmed.moments(&package.scene, frame));
        let own = moment.as_ref().map(|moment| package.ready(moment)).transpose()?;
        let Some(lookout) = still.as_ref().or(own.as_ref()) else { unreachable!("one of the two is there") };
        let image = |seed: &Seed| {
            let p_world = filmed.carry([frames[seed.frame as usize], frame], &seed.point, Some(lookout));
            image(lookout, &view, (seed, p_world), place == seed.frame as usize)
        };
        followed.push(enfilade_parallel::map::<_, ([f32; 2], bool)>(&seeds, image));
    }
    let by_point = || (0..seeds.len()).flat_map(|point| followed.iter().map(move |frame| frame[point]));
    Ok(Tracks {
        frames: frames.iter().map(|&frame| filmed.name(frame).1).collect(),
        positions: seeds.iter().map(|seed| seed.point.p_world).collect(),
        node_ids: if filmed.is_still() { Vec::new() } else { seeds.iter().map(|seed| i32::from(seed.point.part)).collect() },
        seeds: seeds.iter().map(|seed| (seed.frame, seed.pixel.map(|v| v as f32 + 0.5))).collect(),
        points: by_point().map(|(point, _)| point).collect(),
        occluded: by_point().map(|(_, occluded)| occluded).collect(),
    })
}

/// The points that are seeded in a frame.
fn seeds(
    filmed: &Filmed<'_>,
    package: &ScenePackage,
    frames: &[usize],
    place: usize,
    config: TracksConfig,
) -> Result<Vec<Seed>, MultiviewError> {
    let (n, t) = (u64::from(config.points), frames.len() as u64);
    // The points seeded in this frame: i T / N rounded down.
    let own = (place as u64 * n).div_ceil(t)..((place as u64 + 1) * n).div_ceil(t);
    if own.is_empty() {
        return Ok(Vec::new());
    }
    let frame = frames[place];
    let (distances_m, parts, size) = (filmed.distances_m(frame)?, filmed.parts(frame)?, filmed.view(frame).camera().size());
    let moment = filmed.deforms().then(|| filmed.moments(&package.scene, frame));
    let lookout = moment.as_ref().map(|moment| package.ready(moment)).transpose()?;
    let shown_at = |pixel| filmed.points(frame, (&distances_m, &parts), lookout.as_ref(), std::iter::once(pixel)).pop();
    let seed = |point: u64| {
        let pixels = (0..TRIES).map(|attempt| pixel(size, point + n * attempt, config.seed));
        let mut shown = pixels.filter_map(|pixel| Some((pixel, shown_at(pixel)?)));
        shown.next().map(|(pixel, point)| Seed { frame: place as u32, pixel, point })
    };
    Ok(own.filter_map(seed).collect())
}

/// Column and row of a point of the R2 sequence, which begins elsewhere for each seed.
fn pixel(size: [u32; 2], index: u64, seed: u64) -> [u32; 2] {
    let begin = hash_u64(seed);
    let begins = [begin >> 32, begin & 0xffff_ffff].map(|bits| bits as f64 / 4_294_967_296.0);
    let steps = [1.0 / GOLDEN, 1.0 / (GOLDEN * GOLDEN)];
    std::array::from_fn(|axis| {
        let share = (begins[axis] + steps[axis] * (index + 1) as f64).fract();
        ((share * f64::from(size[axis])) as u32).min(size[axis] - 1)
    })
}

/// Position of a point in a view, as shares of width and height, and whether it is occluded there; it is visible in the frame it was seeded
/// in.
fn image(lookout: &Lookout<'_>, view: &CameraView<'_>, (seed, p_world): (&Seed, DVec3), is_own: bool) -> ([f32; 2], bool) {
    let size = view.camera().size().map(f64::from);
    let share = |(x, y): (f64, f64)| [(x / size[0]) as f32, (y / size[1]) as f32];
    if is_own {
        return (share((f64::from(seed.pixel[0]) + 0.5, f64::from(seed.pixel[1]) + 0.5)), false);
    }
    match view.project(p_world) {
        None => ([-1.0; 2], true),
        Some(at) => (share(at), !lookout.shows(view, p_world)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_are_spread_evenly_and_differ_by_seed() {
        let cells = |seed: u64| {
            let mut counts = [0; 16];
            for index in 0..256 {
                let [x, y] = pixel([640, 480], index, seed);
                counts[(y / 120 * 4 + x / 160) as usize] += 1;
            }
            counts
        };
        assert!(cells(0).iter().all(|count| (12..=20).contains(count)), "{:?}", cells(0));
        assert_ne!(pixel([640, 480], 0, 0), pixel([640, 480], 0, 1));
    }
}
