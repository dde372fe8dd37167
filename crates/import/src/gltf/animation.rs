//! Animations of nodes, as rigid motion over time.
//!
//! Translations and rotations are used, of all animations together, from their first moment on. Linear channels and steps are exact;
//! cubic splines are cut into straight pieces of a sixtieth of a second. Scales, weights of morph targets and skins stay as they are.

use super::container::Document;
use crate::assembly::{Assembly, TimedPoses};
use enfilade_math::{DQuat, DVec3};
use enfilade_scene::RigidPose;
use gltf::json::Index;
use gltf::json::accessor::Accessor;
use gltf::json::animation::{Animation, Interpolation, Property, Sampler};
use gltf::json::validation::Checked;
use std::collections::BTreeMap;

/// Length of the pieces of cubic splines, seconds.
const PIECE_S: f64 = 1.0 / 60.0;
/// Most states of one node.
const MOST_STATES: usize = 200_000;
/// Scales that differ by no more are the same.
const SAME_SCALE: f32 = 1e-5;

/// The motion of the nodes of a file.
#[derive(Default)]
pub(super) struct Animations {
    nodes: BTreeMap<usize, NodeMotion>,
}

#[derive(Default)]
struct NodeMotion {
    translation: Option<Channel<3>>,
    rotation: Option<Channel<4>>,
}

/// Values over time.
struct Channel<const N: usize> {
    times_s: Vec<f64>,
    values: Vec<[f64; N]>,
    /// Of cubic splines: the tangents before and after each value, per second.
    tangents: Vec<[[f64; N]; 2]>,
    steps: bool,
}

/// From which side a moment is approached: at a step, values differ.
#[derive(Clone, Copy)]
enum Side {
    Before,
    After,
}

impl Animations {
    /// Reads the animations of a file; what cannot be used is reported.
    pub(super) fn new(document: &Document, a: &mut Assembly) -> Self {
        let mut found = Self::default();
        for (number, animation) in document.root.animations.iter().enumerate() {
            for (at, channel) in animation.channels.iter().enumerate() {
                let place = format!("animations[{number}].channels[{at}]");
                let Checked::Valid(path) = channel.target.path else { continue };
                let node = channel.target.node.value();
                let read = sampler(animation, channel.sampler.value()).and_then(|sampler| found.add(document, node, path, sampler));
                if let Err(problem) = read {
                    a.warn(place, format!("{problem}; the channel was left out"));
                }
            }
        }
        found
    }

    fn add(&mut self, document: &Document, node: usize, path: Property, sampler: &Sampler) -> Result<(), String> {
        let Some(json) = document.root.nodes.get(node) else {
            return Err(format!("it refers to node {node}, but there are only {}", document.root.nodes.len()));
        };
        let twice = || Err(format!("another one moves node {node} the same way"));
        match path {
            Property::Translation => {
                let motion = self.nodes.entry(node).or_default();
                if motion.translation.is_some() {
                    return twice();
                }
                motion.translation = Some(channel(document, sampler)?);
            }
            Property::Rotation => {
                let motion = self.nodes.entry(node).or_default();
                if motion.rotation.is_some() {
                    return twice();
                }
                motion.rotation = Some(channel(document, sampler)?);
            }
            Property::Scale => {
                let rest = json.scale.unwrap_or([1.0; 3]);
                let values = channel::<3>(document, sampler)?.values;
                let same = |value: &[f64; 3]| (0..3).all(|axis| (value[axis] as f32 - rest[axis]).abs() <= SAME_SCALE);
                if !values.iter().all(same) {
                    return Err("it changes the scale, which no rigid motion does".into());
                }
            }
            Property::MorphTargetWeights => return Err("it moves morph targets, which stay as they are at rest".into()),
        }
        Ok(())
    }

    /// The states of a node relative to its own rest, in its own axes: moments, and poses. `None` of nodes that stay.
    ///
    /// # Errors
    /// When there are more states than a scene may have.
    pub(super) fn states(&self, document: &Document, node: usize) -> Result<Option<TimedPoses>, String> {
        let Some(motion) = self.nodes.get(&node) else { return Ok(None) };
        let json = &document.root.nodes[node];
        let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let rest = RigidPose {
            rotation: json.rotation.as_ref().map_or(DQuat::IDENTITY, |q| quaternion(q.0.map(f64::from))),
            translation: json.translation.map_or(DVec3::ZERO, vector),
        };
        let mut times_s: Vec<f64> = [motion.translation.as_ref().map(Channel::moments), motion.rotation.as_ref().map(Channel::moments)]
            .into_iter()
            .flatten()
            .flatten()
            .collect();
        times_s.sort_by(f64::total_cmp);
        times_s.dedup();
        if times_s.is_empty() {
            return Ok(None);
        }
        if times_s.len() > MOST_STATES {
            return Err(format!("{} states, more than {MOST_STATES}", times_s.len()));
        }
        let at = |time_s: f64, side: Side| {
            let translation =
                motion.translation.as_ref().map_or(rest.translation, |channel| DVec3::from_array(channel.linear(time_s, side)));
            let rotation = motion.rotation.as_ref().map_or(rest.rotation, |channel| channel.slerp(time_s, side));
            let back = rest.rotation.inverse();
            RigidPose { rotation: (back * rotation).normalize(), translation: back * (translation - rest.translation) }
        };
        let (mut moments, mut poses) = (Vec::new(), Vec::new());
        for time_s in times_s {
            let [before, after] = [at(time_s, Side::Before), at(time_s, Side::After)];
            let states = if before == after { &[before][..] } else { &[before, after] };
            for pose in states {
                moments.push(time_s);
                poses.push(*pose);
            }
        }
        Ok(Some((moments, poses)))
    }
}

fn sampler(animation: &Animation, index: usize) -> Result<&Sampler, String> {
    let count = animation.samplers.len();
    animation.samplers.get(index).ok_or_else(|| format!("it refers to sampler {index}, but there are only {count}"))
}

fn channel<const N: usize>(document: &Document, sampler: &Sampler) -> Result<Channel<N>, String> {
    let read = |accessor: Index<Accessor>| document.vectors::<N>(accessor);
    let times: Vec<[f32; 1]> = document.vectors::<1>(sampler.input)?;
    let times_s: Vec<f64> = times.into_iter().map(|[time]| f64::from(time)).collect();
    if let Some(at) = times_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(format!("moment {} ({} s) does not come after the one ahead of it ({} s)", at + 1, times_s[at + 1], times_s[at]));
    }
    let values: Vec<[f64; N]> = read(sampler.output)?.into_iter().map(|value| value.map(f64::from)).collect();
    let cubic = matches!(sampler.interpolation, Checked::Valid(Interpolation::CubicSpline));
    let expected = if cubic { 3 * times_s.len() } else { times_s.len() };
    if times_s.is_empty() || values.len() != expected {
        return Err(format!("{} values for {} moments, expected {expected}", values.len(), times_s.len()));
    }
    if let Some(at) = values.iter().position(|value| !value.iter().all(|v| v.is_finite())) {
        return Err(format!("value {at} is not finite"));
    }
    let steps = matches!(sampler.interpolation, Checked::Valid(Interpolation::Step));
    if !cubic {
        return Ok(Channel { times_s, values, tangents: Vec::new(), steps });
    }
    let (triples, _) = values.as_chunks::<3>();
    let tangents = triples.iter().map(|[before, _, after]| [*before, *after]).collect();
    Ok(Channel { times_s, values: triples.iter().map(|[_, value, _]| *value).collect(), tangents, steps })
}

impl<const N: usize> Channel<N> {
    /// The moments at which straight pieces end.
    fn moments(&self) -> Vec<f64> {
        let mut moments = self.times_s.clone();
        if !self.tangents.is_empty() {
            for pair in self.times_s.windows(2) {
                let pieces = ((pair[1] - pair[0]) / PIECE_S).ceil().clamp(1.0, MOST_STATES as f64) as usize;
                moments.extend((1..pieces).map(|piece| pair[0] + (pair[1] - pair[0]) * piece as f64 / pieces as f64));
            }
        }
        moments
    }

    /// The values around a moment, and the share of the second.
    fn between(&self, time_s: f64, side: Side) -> (usize, usize, f64) {
        let last = self.times_s.len() - 1;
        let after = match side {
            Side::Before => self.times_s.partition_point(|&t| t < time_s),
            Side::After => self.times_s.partition_point(|&t| t <= time_s),
        };
        if after == 0 || after > last {
            return (after.min(last), after.min(last), 0.0);
        }
        let [from, to] = [self.times_s[after - 1], self.times_s[after]];
        (after - 1, after, if self.steps { 0.0 } else { (time_s - from) / (to - from) })
    }

    fn linear(&self, time_s: f64, side: Side) -> [f64; N] {
        let (first, second, share) = self.between(time_s, side);
        if self.tangents.is_empty() || first == second {
            return std::array::from_fn(|i| self.values[first][i] + (self.values[second][i] - self.values[first][i]) * share);
        }
        // Hermite's spline, as glTF 2.0 states it in appendix C.
        let (s, step) = (share, self.times_s[second] - self.times_s[first]);
        let [h00, h10] = [2.0 * s.powi(3) - 3.0 * s * s + 1.0, s.powi(3) - 2.0 * s * s + s];
        let [h01, h11] = [3.0 * s * s - 2.0 * s.powi(3), s.powi(3) - s * s];
        let (from, to) = (self.tangents[first][1], self.tangents[second][0]);
        std::array::from_fn(|i| h00 * self.values[first][i] + h10 * step * from[i] + h01 * self.values[second][i] + h11 * step * to[i])
    }
}

impl Channel<4> {
    fn slerp(&self, time_s: f64, side: Side) -> DQuat {
        let (first, second, share) = self.between(time_s, side);
        if !self.tangents.is_empty() {
            return quaternion(self.linear(time_s, side));
        }
        quaternion(self.values[first]).slerp(quaternion(self.values[second]), share)
    }
}

/// The rotation of a quaternion (x, y, z, w) of any length; a zero one turns nothing.
fn quaternion(q: [f64; 4]) -> DQuat {
    let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    if length > 0.0 { DQuat::from_array(q.map(|v| v / length)) } else { DQuat::IDENTITY }
}
