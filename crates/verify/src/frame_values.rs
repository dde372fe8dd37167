//! The values that the report card keeps of each frame: its gates, noise, exposure, labels, and numbers of pixels by use.

use crate::frame_gates::{Gate, gate_values};
use enfilade_dataset::FrameRecord;
use enfilade_frame::tonemap::{ToneMap, brightness};
use enfilade_frame::{Frame, Layer, Validity, Values, traits};
use enfilade_scene::Camera;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The largest finite half float.
const LARGEST_HALF: f64 = 65_504.0;

/// Values of one frame. `None` and absent entries mean that the frame lacks a layer; shares are from 0 to 1.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameValues {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// The value of each gate; `None` if it is not a number.
    pub gates: BTreeMap<Gate, Option<f64>>,
    /// Kind of `color`: `rendered`, or `denoised by PROGRAM`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
    /// Noise of the rendered color: the root mean square over the image of each pixel's standard error over (its luminance + 0.2 x
    /// the image's mean).
    pub noise: Option<f64>,
    /// The noise at which rendering was to stop, if a target was set.
    pub noise_target: Option<f32>,
    /// Mean samples per pixel.
    pub samples: Option<f64>,
    /// Factor of radiance before the gamma curve of the tone map.
    pub tone_map_scale: Option<f64>,
    /// Mean luminance of the pixels that see the scene, W/(sr m²); those beyond float16 count as its largest value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_luminance: Option<f64>,
    /// Share of the pixels with a channel that the tone map shows as 255.
    pub clipped_share: Option<f64>,
    /// Share of the pixels that the tone map shows as black.
    pub black_share: Option<f64>,
    /// Share of the pixels that see the scene that have a class.
    pub labelled_share: Option<f64>,
    /// Share of the parts in view that have a class.
    pub labelled_parts_share: Option<f64>,
    /// Share of the pixels by what is special about them: `void`, `saturated`, `no_diffuse`, and where surfaces were described `mirror`,
    /// `glass`, `emitter`, `partial` and `back`.
    pub pixels: BTreeMap<String, f64>,
}

impl FrameValues {
    /// The values of a frame; `filmed_with` is its camera, if known, and `record` the record of its rendering, if there is one.
    pub fn new([scene, camera]: [&str; 2], number: u32, frame: &Frame, filmed_with: Option<&Camera>, record: Option<&FrameRecord>) -> Self {
        let sampling = record.and_then(|record| record.sampling);
        let denoised = record.and_then(|record| record.denoised.as_ref());
        // If the rendered layers were not kept, the noise is only in the record.
        let is_gone = denoised.is_some() && frame.get(Layer::ColorRendered).is_none();
        let noise = if is_gone { sampling.and_then(|sampling| sampling.noise) } else { frame.noise() };
        let color = record.map(|_| denoised.map_or_else(|| "rendered".into(), |by| format!("denoised by {}", by.denoiser)));
        let noise_target = sampling.and_then(|sampling| sampling.noise_target);
        let mut gates = gate_values(frame, seeing(frame, filmed_with));
        gates.extend(noise.zip(noise_target).map(|(noise, target)| (Gate::Noise, noise / f64::from(target))));
        let tone = ToneMap::of_frame(frame);
        let [clipped_share, black_share] = exposure(frame, tone);
        let [labelled_share, labelled_parts_share] = labels(frame);
        Self {
            scene: scene.into(),
            camera: camera.into(),
            frame: number,
            gates: gates.into_iter().map(|(gate, value)| (gate, Some(value).filter(|v| v.is_finite()))).collect(),
            color,
            noise,
            noise_target,
            samples: sampling.map(|sampling| sampling.samples_taken),
            tone_map_scale: tone.map(|tone| tone.scale),
            mean_luminance: mean_luminance(frame),
            clipped_share,
            black_share,
            labelled_share,
            labelled_parts_share,
            pixels: special_pixels(frame),
        }
    }

    /// The gates that reject the frame.
    pub fn rejected_by(&self) -> impl Iterator<Item = Gate> {
        self.gates.iter().filter(|(gate, value)| !gate.passes(value.unwrap_or(f64::NAN))).map(|(gate, _)| *gate)
    }

    /// `scene/camera/frame.IIII`.
    pub fn place(&self) -> String {
        format!("{}/{}/frame.{:04}", self.scene, self.camera, self.frame)
    }
}

/// In how many pixels of a frame its camera sees at all: in all of them, where it is not known or the frame is of another size.
fn seeing(frame: &Frame, camera: Option<&Camera>) -> usize {
    let Some(camera) = camera.filter(|camera| camera.size() == [frame.width, frame.height]) else { return frame.pixels() };
    let sees = |x: u32, y: u32| camera.projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).is_some();
    (0..frame.height).map(|y| (0..frame.width).filter(|x| sees(*x, y)).count()).sum()
}

/// Share of `all` for which `holds` is true.
fn share(all: usize, holds: impl Fn(usize) -> bool) -> f64 {
    (0..all).filter(|&i| holds(i)).count() as f64 / all.max(1) as f64
}

/// Mean luminance of the pixels that see the scene; `None` without colour or where nothing is seen.
fn mean_luminance(frame: &Frame) -> Option<f64> {
    let (color, ids) = (frame.get(Layer::Color)?, frame.get(Layer::RenderEntityId)?);
    let luminance = |i: usize| brightness([0, 1, 2].map(|c| color.get(3 * i + c))).min(LARGEST_HALF);
    let seen: Vec<f64> = (0..frame.pixels()).filter(|&i| ids.get(i) != -1.0).map(luminance).filter(|v| !v.is_nan()).collect();
    (!seen.is_empty()).then(|| seen.iter().sum::<f64>() / seen.len() as f64)
}

/// Shares of clipped and of black pixels.
fn exposure(frame: &Frame, tone: Option<ToneMap>) -> [Option<f64>; 2] {
    let (Some(color), Some(tone)) = (frame.get(Layer::Color), tone) else { return [None; 2] };
    let brightest = |i: usize| (3 * i..3 * i + 3).map(|c| color.get(c)).fold(0.0, f64::max);
    let [black, clipped] = [0.5, 254.5].map(|byte| tone.radiance(byte / 255.0));
    let clipped = share(frame.pixels(), |i| brightest(i) >= clipped);
    [Some(clipped), Some(share(frame.pixels(), |i| brightest(i) < black))]
}

/// Shares of pixels and of parts in view that have a class.
fn labels(frame: &Frame) -> [Option<f64>; 2] {
    let (Some(ids), Some(classes)) = (frame.get(Layer::RenderEntityId), frame.get(Layer::Semantic)) else { return [None; 2] };
    let seen: Vec<(i64, bool)> =
        (0..ids.len()).filter(|&i| ids.get(i) != -1.0).map(|i| (ids.get(i) as i64, classes.get(i) != -1.0)).collect();
    let mut parts = seen.clone();
    parts.dedup(); // most neighbours are of one part
    parts.sort_unstable();
    parts.dedup();
    let labelled = parts.iter().filter(|(_, has_class)| *has_class).count() as f64 / parts.len().max(1) as f64;
    let there = |value| (!seen.is_empty()).then_some(value);
    [there(share(seen.len(), |i| seen[i].1)), there(labelled)]
}

fn special_pixels(frame: &Frame) -> BTreeMap<String, f64> {
    let mut shares = BTreeMap::new();
    let mut add = |name: &str, values: &Values, holds: &dyn Fn(f64) -> bool| {
        shares.insert(name.to_string(), share(values.len(), |i| holds(values.get(i))));
    };
    if let Some(valid) = frame.get(Layer::Valid) {
        for (name, code) in [("saturated", Validity::Saturated), ("no_diffuse", Validity::NoDiffuse)] {
            add(name, valid, &|v| v == f64::from(code as u8));
        }
    }
    if let Some(ids) = frame.get(Layer::RenderEntityId) {
        add("void", ids, &|v| v == -1.0);
    }
    if let Some(kinds) = frame.get(Layer::SurfaceTraits) {
        let names = ["mirror", "glass", "emitter", "partial", "back"];
        for (name, bit) in names.into_iter().zip([traits::MIRROR, traits::GLASS, traits::EMITTER, traits::PARTIAL, traits::BACK]) {
            add(name, kinds, &|v| v as u8 & bit != 0);
        }
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{Fisheye, Intrinsics, Projection};
    use enfilade_testroom as testroom;

    #[test]
    fn the_analytic_frame_has_the_values_it_was_made_with() {
        let frame = testroom::frame(&testroom::pose());
        let values = FrameValues::new(["room", "cam_00"], 3, &frame, None, None);
        assert_eq!(values.place(), "room/cam_00/frame.0003");
        let ids = frame.get(Layer::RenderEntityId).unwrap();
        let of = |id: f64| share(ids.len(), |i| ids.get(i) == id);
        assert_eq!((values.pixels["void"], values.pixels["mirror"]), (of(-1.0), of(3.0)));
        assert_eq!(values.pixels["saturated"], 1.0 / ids.len() as f64);
        assert!((values.pixels["no_diffuse"] - of(3.0) + values.pixels["saturated"]).abs() < 1e-12);
        assert_eq!((values.labelled_share, values.labelled_parts_share), (Some(1.0), Some(1.0)));
        // The error of every pixel is an eighth of its luminance: less than that over luminance and floor.
        let noise = values.noise.unwrap();
        assert!(noise > 0.01 && noise < 0.125, "{noise}");
        assert_eq!((values.samples, values.noise_target), (None, None));
        // The void is brighter than the room.
        assert!(values.clipped_share.unwrap() >= of(-1.0) && values.black_share == Some(0.0));
    }

    #[test]
    fn an_empty_frame_has_no_values() {
        let values = FrameValues::new(["s", "c"], 0, &Frame::new(4, 4), None, None);
        let none = FrameValues { scene: "s".into(), camera: "c".into(), ..FrameValues::default() };
        assert_eq!(values, none);
    }

    #[test]
    fn pixels_outside_of_the_image_circle_are_not_invalid() {
        // All around, in a closed room: the circle touches the borders of the image.
        let (size, focal) = (32, 16.0 / std::f64::consts::PI);
        let k = Intrinsics { width: size, height: size, fx: focal, fy: focal, cx: 16.0, cy: 16.0, skew: 0.0 };
        let camera: Camera = Projection::Fisheye(k, Fisheye::new([0.0; 4]).unwrap()).into();
        let sees = |i: u32| camera.projection.ray(f64::from(i % size) + 0.5, f64::from(i / size) + 0.5).is_some();
        let mut frame = Frame::new(size, size);
        for (layer, there, nothing) in [(Layer::RenderEntityId, 1.0, -1.0), (Layer::DepthMeters, 2.0, f64::NAN)] {
            let values = (0..size * size).map(|i| if sees(i) { there } else { nothing }).collect();
            frame.insert(layer, testroom::store(layer, values));
        }
        let invalid = |camera| FrameValues::new(["s", "c"], 0, &frame, camera, None).gates[&Gate::InvalidShare].unwrap();
        assert_eq!(invalid(Some(&camera)), 0.0);
        assert!((0.2..0.25).contains(&invalid(None)), "{}", invalid(None));
    }

    #[test]
    fn noise_is_that_of_a_grey_image() {
        let mut frame = Frame::new(4, 1);
        frame.insert(Layer::Color, testroom::store(Layer::Color, vec![0.5; 12]));
        frame.insert(Layer::ColorStandardError, testroom::store(Layer::ColorStandardError, vec![0.06; 4]));
        let expected = 0.06 / (0.5 * 1.2);
        assert!((frame.noise().unwrap() / expected - 1.0).abs() < 1e-3);
    }
}
