//! One exposure for a whole trajectory, for people.
//!
//! Hypersim's rule looks at all of one picture, so that a window or a lamp that fills a tenth of it leaves the room in the dark, and
//! an animation flickers. Here the same rule (the 90th percentile of brightness is shown at 0.8) looks at the surfaces that send
//! mostly diffusely reflected light, in all frames of the trajectory together: lamps, windows, panes and mirrors have no say.

use enfilade_frame::tonemap::{ToneMap, brightness, percentile, valid_brightness};
use enfilade_frame::{Frame, Layer};

/// The least share of diffuse light in a pixel that has a say.
const LEAST_DIFFUSE: f64 = 0.5;
/// With a smaller share of such pixels all valid ones have a say.
const LEAST_PIXELS: f64 = 0.05;

/// The exposures of a frame's pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    /// Hypersim's: of the frame alone.
    pub frame: ToneMap,
    /// The one of the trajectory.
    pub display: ToneMap,
}

/// What a frame says about exposure.
#[derive(Clone, Debug, Default)]
pub struct Brightness {
    /// Hypersim's percentile of the frame.
    pub percentile: Option<f64>,
    /// Some of the valid pixels.
    valid: Vec<f64>,
    /// Those of them that send mostly diffusely reflected light.
    diffuse: Vec<f64>,
}

impl Brightness {
    /// Of every `step`-th valid pixel of a frame, but the percentile of all; `None` without `color` and `render_entity_id`. Without
    /// `residual` no pixel is known to be diffuse.
    pub fn of_frame(frame: &Frame, step: usize) -> Option<Self> {
        let percentile = percentile(valid_brightness(frame)?);
        let (color, ids) = (frame.get(Layer::Color)?, frame.get(Layer::RenderEntityId)?);
        let residual = frame.get(Layer::Residual);
        let mut some = Self { percentile, ..Self::default() };
        for i in (0..frame.pixels()).step_by(step.max(1)).filter(|&i| ids.get(i) != -1.0) {
            let at = |values: &enfilade_frame::Values| brightness([0, 1, 2].map(|c| values.get(3 * i + c)));
            let whole = at(color);
            some.valid.push(whole);
            if residual.is_some_and(|residual| at(residual) <= (1.0 - LEAST_DIFFUSE) * whole) {
                some.diffuse.push(whole);
            }
        }
        Some(some)
    }
}

/// The exposure of a trajectory with these frames.
pub fn display_exposure(frames: &[Brightness]) -> ToneMap {
    let pooled = |of: fn(&Brightness) -> &Vec<f64>| frames.iter().flat_map(of).copied().collect::<Vec<f64>>();
    let (valid, diffuse) = (pooled(|frame| &frame.valid), pooled(|frame| &frame.diffuse));
    let enough = diffuse.len() as f64 >= LEAST_PIXELS * valid.len() as f64;
    ToneMap::fit(if enough { diffuse } else { valid })
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::{Values, f16};

    /// A wall of brightness `wall`, and in a fifth of the picture a lamp as bright as given.
    fn room(wall: f64, lamp: f64) -> Frame {
        let mut frame = Frame::new(20, 5);
        let values = |of: &dyn Fn(bool) -> f64| Values::F16((0..300).map(|i| f16::from_f64(of(i / 3 % 5 == 0))).collect());
        frame.insert(Layer::Color, values(&|is_lamp| if is_lamp { lamp } else { wall }));
        frame.insert(Layer::Residual, values(&|is_lamp| if is_lamp { lamp } else { 0.0 }));
        frame.insert(Layer::RenderEntityId, Values::I16(vec![1; 100]));
        frame
    }

    fn exposure(frames: &[Frame]) -> f64 {
        display_exposure(&frames.iter().map(|frame| Brightness::of_frame(frame, 1).unwrap()).collect::<Vec<_>>()).scale
    }

    #[test]
    fn lamps_and_windows_have_no_say() {
        let [dim, bright] = [exposure(&[room(0.5, 2.0)]), exposure(&[room(0.5, 6000.0)])];
        assert!((dim - 0.8f64.powf(2.2) / 0.5).abs() < 1e-12 && dim == bright, "{dim} {bright}");
        assert!(ToneMap::of_frame(&room(0.5, 6000.0)).unwrap().scale < 1e-3, "by Hypersim's rule they do");
    }

    #[test]
    fn all_frames_of_a_trajectory_share_it() {
        let both = exposure(&[room(0.25, 1.0), room(0.5, 1.0)]);
        assert!((both - exposure(&[room(0.5, 1.0)])).abs() < 1e-12, "the brighter half decides");
    }

    #[test]
    fn where_nothing_is_diffuse_all_pixels_have_a_say() {
        let mut mirror = room(0.5, 0.5);
        let color = mirror.get(Layer::Color).unwrap().clone();
        mirror.insert(Layer::Residual, color);
        assert!((exposure(&[mirror]) - 0.8f64.powf(2.2) / 0.5).abs() < 1e-12);
        assert_eq!(exposure(&[]), 1.0);
    }
}
