//! The arithmetic of forecasts from a pilot. `stages/pilot.rs` makes the pilot.
//!
//! The cost of a frame has a fixed part, which the pilot measures once (geometry, compressing and writing, and later stages), and a part in
//! proportion to its samples: pixels × the mean over squares of pixels of (samples wanted there × seconds per sample there). Squares and
//! frames are samples of the image and of the trajectory, so their spread gives the uncertainty of the mean; errors that the spread does
//! not show are added as shares of the whole.

use enfilade_render::FrameRender;
use serde::{Deserialize, Serialize};
use std::ops::Add;

/// Standard deviations to either side of the reported intervals: 95 of 100 contain the true value.
const DEVIATIONS: f64 = 1.96;
/// Processor time of the same work differs by this share between runs (shared caches, clock rates, neighbours), standard deviation.
const MACHINE_SHARE: f64 = 0.08;
/// Share by which it differs where other programs keep the machine busy during the pilot: processor time has been seen to double.
const BUSY_MACHINE_SHARE: f64 = 0.3;
/// Variance is estimated from few samples where a noise target decides how many are taken; standard deviation of the number taken.
const NOISE_SHARE: f64 = 0.2;
/// Threads of a frame are at work for this share of the time, with its standard deviation: passes end when their last tile does.
const BUSY: f64 = 0.95;
const BUSY_SHARE: f64 = 0.03;
/// Compressed sizes differ between frames by this share, standard deviation.
const SIZE_SHARE: f64 = 0.06;
/// Memory is estimated from the pilot and more frames at once; standard deviation as a share.
const MEMORY_SHARE: f64 = 0.1;
/// Work that is done once per scene after rendering is known from one frame to within this share.
const LATER_SHARE: f64 = 0.25;

/// A number that is not known for sure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// Expected value.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Expected {
    fn new(mean: f64, deviation: f64) -> Self {
        Self { mean, deviation }
    }

    /// With a further deviation that is a share of the mean.
    fn unsure(self, share: f64) -> Self {
        Self { deviation: self.deviation.hypot(share * self.mean), ..self }
    }

    fn times(self, factor: f64) -> Self {
        Self { mean: factor * self.mean, deviation: factor * self.deviation }
    }

    /// Ends of the interval that contains the true value in 95 of 100 cases; never below 0.
    pub fn interval(&self) -> [f64; 2] {
        [(self.mean - DEVIATIONS * self.deviation).max(0.0), self.mean + DEVIATIONS * self.deviation]
    }
}

/// Adds two numbers whose errors have the same causes, such as two scenes on one machine: deviations add up.
impl Add for Expected {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { mean: self.mean + other.mean, deviation: self.deviation + other.deviation }
    }
}

/// A square of pixels that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeCost {
    /// Mean samples per pixel that the frame will take there.
    pub samples: f64,
    /// Processor seconds of a sample.
    pub cpu_s: f64,
}

/// Measurements of the pilot for a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScenePilot {
    /// Frames that are to be rendered.
    pub frames: u64,
    /// Pixels of a frame.
    pub pixels: u64,
    /// Probes by frame that was tried.
    pub probes: Vec<Vec<ProbeCost>>,
    /// True where the noise decides how many samples are taken.
    pub noise_target: bool,
    /// Seconds on the wall clock after which a frame ends with the pass that is under way.
    pub time_limit_s: Option<f64>,
    /// Processor seconds before the first frame: hierarchy, lights, guides.
    pub before_cpu_s: f64,
    /// Processor seconds of a frame independent of its samples: geometry, compressing, writing.
    pub frame_cpu_s: f64,
    /// Processor seconds of later stages for each frame.
    pub later_frame_cpu_s: f64,
    /// Processor seconds of later stages once.
    pub later_cpu_s: f64,
    /// Bytes of a frame's files.
    pub frame_bytes: u64,
    /// Bytes of the scene's other files, its work folder's among them.
    pub scene_bytes: u64,
    /// Most memory that the pilot's process had.
    pub peak_memory_bytes: u64,
    /// Bytes of a frame's layers in memory.
    pub layers_bytes: u64,
    /// Threads that will be at work.
    pub threads: u32,
    /// True when other programs kept the machine busy during the pilot.
    pub busy: bool,
}

/// Forecast for a scene, or for all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// Frames.
    pub frames: u64,
    /// Seconds of all threads together.
    pub cpu_s: Expected,
    /// Seconds on the wall clock of this machine, if nothing else is at work on it.
    pub wall_s: Expected,
    /// Hours on the wall clock times threads.
    pub vcpu_hours: Expected,
    /// Bytes on disk.
    pub disk_bytes: Expected,
    /// Most memory at any moment; of several scenes the largest.
    pub memory_bytes: Expected,
    /// True when other programs kept the machine busy during the pilot: times are as under that load, and less sure.
    pub busy: bool,
}

impl Forecast {
    /// The forecast of a scene.
    pub fn of(pilot: &ScenePilot) -> Self {
        let frames = pilot.frames as f64;
        let threads = f64::from(pilot.threads.max(1));
        let sampling = sampling(pilot);
        let fixed = Expected::new(pilot.before_cpu_s + frames * pilot.frame_cpu_s, 0.0);
        let later = Expected::new(pilot.later_cpu_s + frames * pilot.later_frame_cpu_s, 0.0).unsure(LATER_SHARE);
        let all = Expected::new(sampling.mean + fixed.mean + later.mean, sampling.deviation.hypot(later.deviation));
        let cpu_s =
            if frames > 0.0 { all.unsure(if pilot.busy { BUSY_MACHINE_SHARE } else { MACHINE_SHARE }) } else { Expected::default() };
        let wall_s = cpu_s.times(1.0 / (threads * BUSY)).unsure(BUSY_SHARE);
        let disk = Expected::new(frames * pilot.frame_bytes as f64, 0.0).unsure(SIZE_SHARE);
        let disk_bytes = Expected::new(disk.mean + pilot.scene_bytes as f64, disk.deviation);
        // Pictures are made of as many frames at once as there are threads.
        let memory = pilot.peak_memory_bytes as f64 + (threads - 1.0).min(frames - 1.0).max(0.0) * pilot.layers_bytes as f64;
        let memory_bytes = Expected::new(memory, 0.0).unsure(MEMORY_SHARE);
        Self { frames: pilot.frames, cpu_s, wall_s, vcpu_hours: wall_s.times(threads / 3600.0), disk_bytes, memory_bytes, busy: pilot.busy }
    }

    /// The forecast of several scenes one after the other.
    pub fn sum(forecasts: impl Iterator<Item = Self>) -> Self {
        forecasts.fold(Self::default(), |a, b| Self {
            frames: a.frames + b.frames,
            cpu_s: a.cpu_s + b.cpu_s,
            wall_s: a.wall_s + b.wall_s,
            vcpu_hours: a.vcpu_hours + b.vcpu_hours,
            disk_bytes: a.disk_bytes + b.disk_bytes,
            memory_bytes: if a.memory_bytes.mean > b.memory_bytes.mean { a.memory_bytes } else { b.memory_bytes },
            busy: a.busy || b.busy,
        })
    }
}

/// Processor seconds of the samples of all frames.
fn sampling(pilot: &ScenePilot) -> Expected {
    let limit_s = pilot.time_limit_s.map(|limit| limit * f64::from(pilot.threads.max(1)));
    let frame = |probes: &Vec<ProbeCost>| {
        let all = mean_cost(probes, |probe| probe.samples * probe.cpu_s * pilot.pixels as f64);
        match limit_s {
            Some(limit) if all.0 > limit => ended(limit, mean_cost(probes, |probe| probe.cpu_s * pilot.pixels as f64), all.0),
            _ => all,
        }
    };
    let tried: Vec<(f64, f64)> = pilot.probes.iter().filter(|probes| !probes.is_empty()).map(frame).collect();
    let n = tried.len() as f64;
    if tried.is_empty() {
        return Expected::default();
    }
    let frames = pilot.frames as f64;
    let (mean, between) = mean_and_variance(&tried.iter().map(|t| t.0).collect::<Vec<_>>());
    let within = tried.iter().map(|t| t.1).sum::<f64>() / n;
    // Frames that were tried also differ by chance within them; only the remaining variance shows how much the others may differ.
    let others = (1.0 - n / frames.max(n)).max(0.0);
    let variance = ((between - within).max(0.0) * others + within) / n;
    let all = Expected::new(frames * mean, frames * variance.sqrt());
    if pilot.noise_target { all.unsure(NOISE_SHARE) } else { all }
}

/// Mean over probes, and its variance.
fn mean_cost(probes: &[ProbeCost], cost: impl Fn(&ProbeCost) -> f64) -> (f64, f64) {
    let costs: Vec<f64> = probes.iter().map(cost).collect();
    let (mean, variance) = mean_and_variance(&costs);
    (mean, variance / costs.len().max(1) as f64)
}

/// Processor seconds of a frame that is ended by its time limit, and their variance. `one` is for one sample of every pixel, which is
/// always taken, `all_s` for all samples.
fn ended(limit_s: f64, one: (f64, f64), all_s: f64) -> (f64, f64) {
    if limit_s <= one.0 {
        return one;
    }
    // The time is over anywhere within a pass, which doubles the samples until it has its full number.
    let pass_s = limit_s.min(f64::from(FrameRender::PASS) * one.0);
    ((limit_s + 0.5 * pass_s).min(all_s), pass_s.powi(2) / 12.0)
}

/// Mean, and variance of one value; the variance of a single value is taken to be its square.
fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n.max(1.0);
    if values.len() < 2 {
        return (mean, mean * mean);
    }
    (mean, values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    /// A pilot of `tried` of 40 frames with 30 probes each; the frames' mean costs per sample, and what they will take in all.
    fn made(tried: usize, seed: u64) -> (ScenePilot, f64) {
        let mut rng = Rng::new(seed);
        let means: Vec<f64> = (0..40).map(|_| 1e-6 * (0.7 + 0.6 * rng.next_f64())).collect();
        let probe = |mean: f64, rng: &mut Rng| ProbeCost { samples: 64.0, cpu_s: mean * (0.2 + 1.6 * rng.next_f64()) };
        let probes = (0..tried).map(|i| (0..30).map(|_| probe(means[i * 40 / tried], &mut rng)).collect()).collect();
        let pilot = ScenePilot {
            frames: 40,
            pixels: 10_000,
            probes,
            before_cpu_s: 3.0,
            frame_cpu_s: 0.25,
            later_frame_cpu_s: 0.1,
            later_cpu_s: 1.0,
            threads: 4,
            ..ScenePilot::default()
        };
        (pilot, means.iter().map(|mean| mean * 64.0 * 1e4).sum::<f64>() + 3.0 + 10.0 + 4.0 + 1.0)
    }

    #[test]
    fn the_interval_holds_the_truth_nearly_always_and_narrows_with_the_pilot() {
        let mut held = 0;
        for seed in 0..200 {
            let (pilot, truth) = made(5, seed);
            let [low, high] = Forecast::of(&pilot).cpu_s.interval();
            held += usize::from(low <= truth && truth <= high);
        }
        assert!(held >= 190, "{held} of 200");
        let width = |tried| sampling(&made(tried, 1).0).deviation;
        assert!(width(40) < width(10) && width(10) < width(3), "{} {} {}", width(3), width(10), width(40));
    }

    #[test]
    fn costs_that_are_all_alike_are_forecast_exactly() {
        let probe = ProbeCost { samples: 100.0, cpu_s: 2e-6 };
        let pilot = ScenePilot { frames: 10, pixels: 5000, probes: vec![vec![probe; 4]; 2], threads: 2, ..ScenePilot::default() };
        assert!((sampling(&pilot).mean - 10.0).abs() < 1e-9 && sampling(&pilot).deviation < 1e-9);
        let forecast = Forecast::of(&pilot);
        assert!((forecast.cpu_s.mean - 10.0).abs() < 1e-9);
        assert!((forecast.wall_s.mean - 10.0 / (2.0 * BUSY)).abs() < 1e-9);
        assert!((forecast.vcpu_hours.mean - 10.0 / BUSY / 3600.0).abs() < 1e-12);
    }

    #[test]
    fn a_time_limit_ends_frames_and_a_noise_target_is_less_sure() {
        let probe = ProbeCost { samples: 100.0, cpu_s: 2e-6 };
        let pilot = ScenePilot { frames: 10, pixels: 5000, probes: vec![vec![probe; 4]; 2], threads: 2, ..ScenePilot::default() };
        let limited = ScenePilot { time_limit_s: Some(0.1), ..pilot.clone() };
        // A sample of every pixel takes 0.01 s, so a pass is 0.16 s, half of which is to come when 0.2 s are over.
        assert!((sampling(&limited).mean - 2.8).abs() < 1e-9 && sampling(&limited).deviation > 0.1);
        let noisy = ScenePilot { noise_target: true, ..pilot.clone() };
        assert!(sampling(&noisy).deviation > 1.0);
        let sum = Forecast::sum([Forecast::of(&pilot), Forecast::of(&limited)].into_iter());
        assert_eq!(sum.frames, 20);
        assert!((sum.cpu_s.mean - 12.8).abs() < 1e-9);
    }

    #[test]
    fn one_sample_of_every_pixel_is_taken_whatever_the_time_limit() {
        let probe = ProbeCost { samples: 100.0, cpu_s: 2e-6 };
        let pilot = ScenePilot { frames: 10, pixels: 5000, probes: vec![vec![probe; 4]; 2], threads: 2, ..ScenePilot::default() };
        let hurried = sampling(&ScenePilot { time_limit_s: Some(1e-6), ..pilot.clone() });
        assert!((hurried.mean - 0.1).abs() < 1e-9, "{hurried:?}");
        let nearly_all = sampling(&ScenePilot { time_limit_s: Some(0.49), ..pilot });
        assert!((nearly_all.mean - 10.0).abs() < 1e-9, "{nearly_all:?}");
    }

    #[test]
    fn a_busy_machine_makes_times_less_sure() {
        let (quiet, truth) = made(5, 1);
        let busy = Forecast::of(&ScenePilot { busy: true, ..quiet.clone() });
        assert!(busy.busy && busy.cpu_s.deviation > 2.0 * Forecast::of(&quiet).cpu_s.deviation);
        assert!(busy.cpu_s.interval()[0] < 0.6 * truth);
    }

    #[test]
    fn nothing_to_do_costs_nothing() {
        let forecast = Forecast::of(&ScenePilot { threads: 2, before_cpu_s: 3.0, ..ScenePilot::default() });
        assert_eq!((forecast.cpu_s, forecast.wall_s.mean), (Expected::default(), 0.0));
    }
}
