//! One exposure for a whole trajectory, for people.
//!
//! Hypersim's rule looks at all of one picture, so that a window or a lamp that fills a tenth of it leaves the room in the dark, and
//! an animation flickers. Here the exposure follows from surfaces that show mostly diffusely reflected light, in all frames of the
//! trajectory together: lamps, windows, panes and mirrors are excluded. The median of their brightness sets the exposure, the mean colour
//! of their illumination the white balance.

use crate::display::Display;
use enfilade_frame::tonemap::{ToneMap, brightness, percentile, valid_brightness};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::quantile;

/// Least share of diffuse light in a pixel that counts.
const LEAST_DIFFUSE: f64 = 0.5;
/// With a smaller share of such pixels, all valid ones count.
const LEAST_PIXELS: f64 = 0.05;

/// The exposures of a frame's pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    /// Hypersim's: only of the frame.
    pub frame: ToneMap,
    /// Exposure of the trajectory.
    pub display: Display,
}

/// The frame's own, in every picture.
impl From<ToneMap> for Exposure {
    fn from(frame: ToneMap) -> Self {
        Self { frame, display: Display { scale: frame.scale, ..Display::default() } }
    }
}

/// The trajectory's, in every picture.
impl From<Display> for Exposure {
    fn from(display: Display) -> Self {
        Self { frame: display.tone(), display }
    }
}

/// Brightness of a frame, for the exposure.
#[derive(Clone, Debug, Default)]
pub struct Brightness {
    /// Hypersim's percentile of the frame.
    pub percentile: Option<f64>,
    /// Luminances of some of the valid pixels.
    valid: Vec<f64>,
    /// Luminances of the pixels that show mostly diffusely reflected light.
    diffuse: Vec<f64>,
    /// Sums of the logarithms of red, green and blue of the light on those, and their number.
    light: ([f64; 3], usize),
}

impl Brightness {
    /// Brightness by every `step`-th valid pixel of a frame, but the percentile of all; `None` without `color` and `render_entity_id`.
    /// Without `residual` no pixel is known to be diffuse.
    pub fn of_frame(frame: &Frame, step: usize) -> Option<Self> {
        let percentile = percentile(valid_brightness(frame)?);
        let (color, ids) = (frame.get(Layer::Color)?, frame.get(Layer::RenderEntityId)?);
        let (residual, light) = (frame.get(Layer::Residual), frame.get(Layer::DiffuseIllumination));
        let mut some = Self { percentile, ..Self::default() };
        for i in (0..frame.pixels()).step_by(step.max(1)).filter(|&i| ids.get(i) != -1.0) {
            let at = |values: &Values| [0, 1, 2].map(|c| values.get(3 * i + c));
            let whole = brightness(at(color));
            some.valid.push(whole);
            if residual.is_some_and(|residual| brightness(at(residual)) <= (1.0 - LEAST_DIFFUSE) * whole) {
                some.diffuse.push(whole);
                light.into_iter().for_each(|light| some.add_light(at(light)));
            }
        }
        Some(some)
    }

    fn add_light(&mut self, light: [f64; 3]) {
        if light.iter().all(|channel| *channel > 0.0 && channel.is_finite()) {
            let (sums, count) = &mut self.light;
            *count += 1;
            sums.iter_mut().zip(light).for_each(|(sum, channel)| *sum += channel.ln());
        }
    }
}

/// The exposure of a trajectory with these frames.
pub fn display_exposure(frames: &[Brightness]) -> Display {
    let pooled = |of: fn(&Brightness) -> &Vec<f64>| frames.iter().flat_map(of).copied().collect::<Vec<f64>>();
    let (valid, diffuse) = (pooled(|frame| &frame.valid), pooled(|frame| &frame.diffuse));
    let enough = diffuse.len() as f64 >= LEAST_PIXELS * valid.len() as f64;
    let mut room = if enough { diffuse } else { valid };
    room.retain(|brightness| !brightness.is_nan());
    let (Some(middle), Some(bright)) = (quantile(&mut room, 0.5), percentile(room)) else { return Display::default() };
    Display::of_room(middle, bright, light_color(frames))
}

/// The geometric mean of the light on diffuse surfaces, scaled to a brightness of 1; white where none is known.
fn light_color(frames: &[Brightness]) -> [f64; 3] {
    let count: usize = frames.iter().map(|frame| frame.light.1).sum();
    if count == 0 {
        return [1.0; 3];
    }
    let mean = [0, 1, 2].map(|c| (frames.iter().map(|frame| frame.light.0[c]).sum::<f64>() / count as f64).exp());
    mean.map(|channel| channel / brightness(mean))
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
        assert!((dim - 0.612 / 0.5).abs() < 1e-12 && dim == bright, "{dim} {bright}");
        assert!(ToneMap::of_frame(&room(0.5, 6000.0)).unwrap().scale < 1e-3, "by Hypersim's rule they do");
    }

    #[test]
    fn all_frames_of_a_trajectory_share_it() {
        let both = exposure(&[room(0.25, 1.0), room(0.5, 1.0), room(0.5, 1.0)]);
        assert!((both - exposure(&[room(0.5, 1.0)])).abs() < 1e-12, "the brighter two thirds decide");
    }

    #[test]
    fn where_nothing_is_diffuse_all_pixels_have_a_say() {
        let mut mirror = room(0.5, 0.5);
        let color = mirror.get(Layer::Color).unwrap().clone();
        mirror.insert(Layer::Residual, color);
        assert!((exposure(&[mirror]) - 0.612 / 0.5).abs() < 1e-12);
        assert_eq!(exposure(&[]), 1.0);
    }

    #[test]
    fn the_color_of_the_light_on_diffuse_surfaces_is_balanced_in_part() {
        let mut warm = room(0.5, 2.0);
        let light = (0..300).map(|i| f16::from_f64(if i / 3 % 5 == 0 { 9.0 } else { [2.0, 1.0, 0.5][i % 3] })).collect();
        warm.insert(Layer::DiffuseIllumination, Values::F16(light));
        let white = display_exposure(&[Brightness::of_frame(&warm, 1).unwrap()]).white;
        assert!((white[1] / white[0] - 2f64.sqrt()).abs() < 1e-3 && (white[2] / white[1] - 2f64.sqrt()).abs() < 1e-3, "{white:?}");
        assert_eq!(display_exposure(&[Brightness::of_frame(&room(0.5, 2.0), 1).unwrap()]).white, [1.0; 3]);
    }
}
