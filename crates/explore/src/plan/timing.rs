//! When to be where along a path: as early as the bounds on speed, turning and acceleration allow. Slowing down changes no pose.

use super::VideoConfig;
use super::rules::turned_rad;
use enfilade_math::DVec3;
use enfilade_scene::Pose;

/// The schedule keeps to this share of each bound, so that rounding and the finite steps of the path do not break it.
const AIM: f64 = 0.98;

/// Times along a path that is given as many poses close to each other, its nodes.
pub(super) struct Schedule {
    /// When each node is reached, seconds.
    times_s: Vec<f64>,
    /// Speeds, metres per second.
    speeds_m_s: Vec<f64>,
}

impl Schedule {
    /// The earliest times, at rest at both ends. The speed is bounded, and so are its change along the path (faster and slower), the
    /// acceleration sideways where the path bends, and the rate of turning.
    pub fn earliest(nodes: &[Pose], bounds: &VideoConfig) -> Self {
        // The highest speed at each node by itself.
        let steps: Vec<DVec3> = nodes.windows(2).map(|pair| pair[1].position - pair[0].position).collect();
        let turns: Vec<f64> = nodes.windows(2).map(|pair| turned_rad(&pair[0], &pair[1])).collect();
        let turn = AIM * bounds.max_turn_deg_s.to_radians();
        let acceleration = AIM * bounds.max_acceleration_m_s2;
        let mut speeds = limits(&steps, &turns, AIM * bounds.max_speed_m_s, turn, acceleration);

        // At rest at both ends, and no node faster than can be reached from the one before or slowed down from before the next.
        speeds[0] = 0.0;
        speeds[steps.len()] = 0.0;
        for k in 0..steps.len() {
            speeds[k + 1] = speeds[k + 1].min((speeds[k] * speeds[k] + 2.0 * acceleration * steps[k].length()).sqrt());
        }
        for k in (0..steps.len()).rev() {
            speeds[k] = speeds[k].min((speeds[k + 1] * speeds[k + 1] + 2.0 * acceleration * steps[k].length()).sqrt());
        }

        // The time that each step takes, or longer where the view turns much in it.
        let mut times_s = vec![0.0];
        for k in 0..steps.len() {
            let sum = speeds[k] + speeds[k + 1];
            let moving = if sum > 0.0 { 2.0 * steps[k].length() / sum } else { 0.0 };
            times_s.push(times_s[k] + moving.max(turns[k] / turn));
        }
        Self { times_s, speeds_m_s: speeds }
    }

    /// The place at a time, in nodes: 2.5 is halfway between the third and the fourth. The last node is never left.
    pub fn at(&self, time_s: f64) -> f64 {
        let last = self.times_s.len() - 1;
        let k = self.times_s.partition_point(|t| *t <= time_s).max(1) - 1;
        if k >= last {
            return last as f64;
        }
        // Evenly accelerated between two nodes.
        let t = (time_s - self.times_s[k]) / (self.times_s[k + 1] - self.times_s[k]);
        let (v0, v1) = (self.speeds_m_s[k], self.speeds_m_s[k + 1]);
        let moved = if v0 + v1 > 0.0 { (2.0 * v0 * t + (v1 - v0) * t * t) / (v0 + v1) } else { t };
        k as f64 + moved
    }
}

/// The highest speed at each node by the steps on both sides of it alone.
fn limits(steps: &[DVec3], turns: &[f64], speed: f64, turn: f64, acceleration: f64) -> Vec<f64> {
    let of_step = |k: usize| if turns[k] > 0.0 { turn * steps[k].length() / turns[k] } else { f64::INFINITY };
    let of_bend = |k: usize| {
        let bend = if steps[k - 1].length() * steps[k].length() > 0.0 { steps[k - 1].angle_between(steps[k]) } else { 0.0 };
        // On a circle: acceleration = speed² · bend / length.
        if bend > 0.0 { (acceleration * steps[k - 1].length().min(steps[k].length()) / bend).sqrt() } else { f64::INFINITY }
    };
    let node = |k: usize| {
        let before = if k > 0 { of_step(k - 1) } else { f64::INFINITY };
        let after = if k < steps.len() { of_step(k) } else { f64::INFINITY };
        let bend = if k > 0 && k < steps.len() { of_bend(k) } else { f64::INFINITY };
        speed.min(before).min(after).min(bend)
    };
    (0..=steps.len()).map(node).collect()
}
