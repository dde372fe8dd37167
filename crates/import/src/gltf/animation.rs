//! Animations of nodes over time.
//!
//! All animations are used together, on their own clock. Translations and rotations are rigid motion, of which linear channels and steps are
//! exact, and cubic splines are cut into straight pieces of a sixtieth of a second. Scales, weights of morph targets and joints change shapes
//! (`deform.rs`).

use super::container::Document;
use crate::assembly::{Assembly, TimedPoses};
use crate::motion::{self, Side};
use enfilade_math::{DAffine3, DQuat, DVec3};
use enfilade_scene::RigidPose;
use gltf::json::animation::{Animation, Interpolation, Property, Sampler};
use gltf::json::scene::UnitQuaternion;
use gltf::json::validation::Checked;
use std::collections::BTreeMap;

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
    /// Only where it changes.
    scale: Option<Channel<3>>,
    /// By morph target.
    weights: Vec<Channel<1>>,
}

/// Values over time.
pub(super) struct Channel<const N: usize> {
    times_s: Vec<f64>,
    values: Vec<[f64; N]>,
    /// Of cubic splines: the tangents before and after each value, per second.
    tangents: Vec<[[f64; N]; 2]>,
    steps: bool,
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
                let values = channel::<3>(document, sampler)?;
                let same = |value: &[f64; 3]| (0..3).all(|axis| (value[axis] as f32 - rest[axis]).abs() <= SAME_SCALE);
                if values.values.iter().all(same) {
                    return Ok(());
                }
                let motion = self.nodes.entry(node).or_default();
                if motion.scale.is_some() {
                    return twice();
                }
                motion.scale = Some(values);
            }
            Property::MorphTargetWeights => {
                let weights = weights(document, sampler)?;
                let motion = self.nodes.entry(node).or_default();
                if !motion.weights.is_empty() {
                    return twice();
                }
                motion.weights = weights;
            }
        }
        Ok(())
    }

    /// The states of a node relative to its own rest, in its own axes: moments, and poses. `None` of nodes that stay.
    ///
    /// # Errors
    /// As [`motion::states`].
    pub(super) fn states(&self, document: &Document, node: usize) -> Result<Option<TimedPoses>, String> {
        let Some(motion) = self.nodes.get(&node) else { return Ok(None) };
        let json = &document.root.nodes[node];
        let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let rest = RigidPose {
            rotation: json.rotation.as_ref().map_or(DQuat::IDENTITY, |q| quaternion(q.0.map(f64::from))),
            translation: json.translation.map_or(DVec3::ZERO, vector),
        };
        let moments = [motion.translation.as_ref().map(Channel::moments), motion.rotation.as_ref().map(Channel::moments)];
        motion::states(moments.into_iter().flatten().flatten().collect(), |time_s, side| {
            let translation =
                motion.translation.as_ref().map_or(rest.translation, |channel| DVec3::from_array(channel.linear(time_s, side)));
            let rotation = motion.rotation.as_ref().map_or(rest.rotation, |channel| channel.slerp(time_s, side));
            let back = rest.rotation.inverse();
            RigidPose { rotation: (back * rotation).normalize(), translation: back * (translation - rest.translation) }
        })
    }
}

impl Animations {
    /// True if anything jumps from one value to another.
    pub(super) fn jump(&self) -> bool {
        self.nodes.values().any(|motion| {
            let vectors = [motion.translation.as_ref(), motion.scale.as_ref()].into_iter().flatten().any(|channel| channel.steps);
            vectors || motion.rotation.as_ref().is_some_and(|channel| channel.steps) || motion.weights.iter().any(|channel| channel.steps)
        })
    }

    /// True if the scale of a node changes.
    pub(super) fn scales(&self, node: usize) -> bool {
        self.nodes.get(&node).is_some_and(|motion| motion.scale.is_some())
    }

    /// True if the weights of the morph targets of a node change.
    pub(super) fn morphs(&self, node: usize) -> bool {
        self.nodes.get(&node).is_some_and(|motion| !motion.weights.is_empty())
    }

    /// The moments at which straight pieces of any channel of a node end; none of nodes that stay.
    pub(super) fn moments(&self, node: usize) -> Vec<f64> {
        let Some(motion) = self.nodes.get(&node) else { return Vec::new() };
        let weights = motion.weights.iter().map(Channel::moments);
        let [translation, rotation] = [motion.translation.as_ref().map(Channel::moments), motion.rotation.as_ref().map(Channel::moments)];
        let scale = motion.scale.as_ref().map(Channel::moments);
        translation.into_iter().chain(rotation).chain(scale).chain(weights).flatten().collect()
    }

    /// The own transform of a node at a moment.
    pub(super) fn local(&self, document: &Document, node: usize, (time_s, side): (f64, Side)) -> DAffine3 {
        let rest = document.local_transform(node);
        let json = &document.root.nodes[node];
        let Some(motion) = self.nodes.get(&node).filter(|_| json.matrix.is_none()) else { return rest };
        let own = |rotation: &UnitQuaternion| quaternion(rotation.0.map(f64::from));
        let rotation = motion.rotation.as_ref().map(|channel| channel.slerp(time_s, side));
        let rotation = rotation.unwrap_or_else(|| json.rotation.as_ref().map_or(DQuat::IDENTITY, own));
        let at = |channel: &Option<Channel<3>>| channel.as_ref().map(|channel| DVec3::from_array(channel.linear(time_s, side)));
        let scale = at(&motion.scale).unwrap_or_else(|| json.scale.map_or(DVec3::ONE, |s| DVec3::from_array(s.map(f64::from))));
        DAffine3::from_scale_rotation_translation(scale, rotation, at(&motion.translation).unwrap_or(rest.translation))
    }

    /// The weights of the morph targets of a node at a moment, where they change.
    pub(super) fn weights(&self, node: usize, (time_s, side): (f64, Side)) -> Option<Vec<f32>> {
        let weights = &self.nodes.get(&node).filter(|motion| !motion.weights.is_empty())?.weights;
        Some(weights.iter().map(|channel| channel.linear(time_s, side)[0] as f32).collect())
    }
}

/// The weights of morph targets over time: a channel for each.
fn weights(document: &Document, sampler: &Sampler) -> Result<Vec<Channel<1>>, String> {
    let moments = document.vectors::<1>(sampler.input)?.len();
    let values: Vec<[f32; 1]> = document.vectors::<1>(sampler.output)?;
    let cubic = matches!(sampler.interpolation, Checked::Valid(Interpolation::CubicSpline));
    let parts = if cubic { 3 * moments } else { moments };
    let targets = values.len().checked_div(parts).unwrap_or(0);
    if targets == 0 || values.len() != targets * parts {
        return Err(format!("{} weights for {moments} moments, expected as many for each", values.len()));
    }
    // Of cubic splines, each moment has the tangents before of all targets, their values, and the tangents after.
    let of = |target: usize| values.iter().skip(target).step_by(targets).copied().collect();
    (0..targets).map(|target| channel_of(document, sampler, of(target))).collect()
}

fn sampler(animation: &Animation, index: usize) -> Result<&Sampler, String> {
    let count = animation.samplers.len();
    animation.samplers.get(index).ok_or_else(|| format!("it refers to sampler {index}, but there are only {count}"))
}

fn channel<const N: usize>(document: &Document, sampler: &Sampler) -> Result<Channel<N>, String> {
    channel_of(document, sampler, document.vectors::<N>(sampler.output)?)
}

/// The channel of a sampler with these values.
fn channel_of<const N: usize>(document: &Document, sampler: &Sampler, values: Vec<[f32; N]>) -> Result<Channel<N>, String> {
    let times: Vec<[f32; 1]> = document.vectors::<1>(sampler.input)?;
    let times_s: Vec<f64> = times.into_iter().map(|[time]| f64::from(time)).collect();
    if let Some(at) = times_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(format!("moment {} ({} s) does not come after the one ahead of it ({} s)", at + 1, times_s[at + 1], times_s[at]));
    }
    let values: Vec<[f64; N]> = values.into_iter().map(|value| value.map(f64::from)).collect();
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
                moments.extend(motion::pieces(pair[0], pair[1]));
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
