//! Depth by two eyes beside each other, of which one may be a projector.

use crate::depth::{Optics, check_range, check_within, forget, in_steps, reaches, reflectances};
use crate::reading::{Data, Reading, Subject};
use crate::{Amount, Glass, SensorError};
use enfilade_frame::{Layer, Values};
use enfilade_math::Rng;
use enfilade_scene::{Intrinsics, Projection};
use serde::{Deserialize, Serialize};

/// A structured-light or stereo sensor in the frame's camera: its second eye, a projector or another camera, is beside it on the camera's x
/// axis and looks in the same direction. It gives `depth_z_meters`: planar depth, NaN where nothing was matched.
///
/// A surface at depth z has the disparity f · b / z, where f is the focal length in pixels and b the baseline. Errors are made in the
/// disparity, so that errors of depth grow with z² / (f b) (Khoshelham and Oude Elberink 2012, "Accuracy and resolution of Kinect depth
/// data"). Surfaces that the second eye does not see have no depth: the shadow beside near things.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Triangulation {
    /// Name of its folder.
    pub name: String,
    /// Distance of the second eye to the right of the frame's camera (to the left if negative), metres. 0 casts no shadow.
    #[serde(default)]
    pub baseline_m: f64,
    /// Range: nearer or farther surfaces are not seen, metres.
    #[serde(default)]
    pub range_m: Option<[f64; 2]>,
    /// Standard deviation of the disparity, pixels.
    #[serde(default = "Amount::nothing")]
    pub noise_px: Amount,
    /// Disparities are whole multiples of this, pixels: 0.125 for the first Kinect.
    #[serde(default)]
    pub step_px: f64,
    /// Side of the square window that is matched, pixels, odd: a pixel has the median of its disparities, so that corners are rounded and
    /// thin things vanish.
    #[serde(default = "one")]
    pub window_px: u32,
    /// Surfaces that are seen at a greater angle to their normal are not matched, degrees.
    #[serde(default = "any_angle")]
    pub max_angle_deg: Amount,
    /// Surfaces of a smaller diffuse reflectance are not matched.
    #[serde(default = "Amount::nothing")]
    pub min_reflectance: Amount,
    /// The share of pixels that find no match for no reason.
    #[serde(default = "Amount::nothing")]
    pub dropout: Amount,
    /// How glass is seen.
    #[serde(default)]
    pub glass: Glass,
    /// Whether smooth metals are seen, as surfaces.
    #[serde(default = "crate::depth::seen")]
    pub mirrors: bool,
}

const fn any_angle() -> Amount {
    Amount::of(90.0)
}

const fn one() -> u32 {
    1
}

/// Kind of the second eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SecondEye {
    /// A projector, which lights everything that the camera sees except for shadows.
    Projector,
    /// A camera with the first one's field of view; points outside of it have no match.
    Camera,
}

impl Triangulation {
    fn optics(&self) -> Optics {
        Optics { glass: self.glass, mirrors: self.mirrors }
    }

    /// True if disparities differ from the stored depth's.
    fn measures_disparity(&self) -> bool {
        self.noise_px.bounds()[1] > 0.0 || self.step_px > 0.0 || self.window_px > 1
    }

    /// The layers that it looks at.
    pub(crate) fn layers(&self) -> Vec<Layer> {
        let mut layers = self.optics().layers();
        layers.push(Layer::DepthZMeters);
        if self.max_angle_deg.bounds()[0] < 90.0 {
            layers.push(Layer::NormalCam);
        }
        if self.min_reflectance.bounds()[1] > 0.0 {
            layers.push(Layer::DiffuseReflectance);
        }
        layers
    }

    /// Checks every key.
    pub(crate) fn check(&self) -> Result<(), String> {
        check_range(self.range_m)?;
        check_within("noise_px", self.noise_px, [0.0, f64::INFINITY])?;
        check_within("step_px", Amount::of(self.step_px), [0.0, f64::INFINITY])?;
        check_within("max_angle_deg", self.max_angle_deg, [0.0, 90.0])?;
        check_within("min_reflectance", self.min_reflectance, [0.0, 1.0])?;
        check_within("dropout", self.dropout, [0.0, 1.0])?;
        let looks_at_surface = self.min_reflectance.bounds()[1] > 0.0 || self.max_angle_deg.bounds()[0] < 90.0;
        if self.glass == Glass::Behind && looks_at_surface {
            let problem = "goes without min_reflectance and max_angle_deg: of what is behind glass these are not stored";
            return Err(format!("glass = \"behind\" {problem}"));
        }
        if self.window_px.is_multiple_of(2) || self.window_px > 63 {
            return Err(format!("window_px is {}, expected an odd number up to 63", self.window_px));
        }
        if !self.baseline_m.is_finite() || (self.baseline_m == 0.0 && self.measures_disparity()) {
            return Err(format!(
                "baseline_m is {}, expected the distance of the two eyes, since disparities are measured",
                self.baseline_m
            ));
        }
        Ok(())
    }

    /// The reading for a frame.
    pub(crate) fn sense(&self, eye: SecondEye, subject: &Subject<'_>, mut rng: Rng) -> Result<Reading, SensorError> {
        let Projection::Pinhole(k) = subject.projection else {
            let problem = "its camera is no pinhole; use a sensor of another kind, or choose cameras with --camera";
            return Err(subject.unseen(&self.name, problem.into()));
        };
        let [noise_px, max_angle_deg, min_reflectance, dropout] =
            [self.noise_px, self.max_angle_deg, self.min_reflectance, self.dropout].map(|amount| amount.draw(&mut rng));
        let mut depths = self.depths_m(subject)?;
        let focal_baseline = k.fx * self.baseline_m;
        let is_lit = lit(k, focal_baseline, eye, &depths);
        let optics = self.optics();
        optics.forget_unseen(&self.name, subject, &mut depths)?;
        if max_angle_deg < 90.0 {
            let least = max_angle_deg.to_radians().cos();
            forget(&mut depths, subject.cosines(&self.name)?.iter().map(|&cosine| cosine < least));
        }
        if min_reflectance > 0.0 {
            forget(&mut depths, reflectances(&self.name, subject)?.iter().map(|&reflectance| reflectance < min_reflectance));
        }
        forget(&mut depths, is_lit.iter().map(|is_lit| !is_lit));
        let pixels = rng.fork(0);
        if self.measures_disparity() {
            let disparities: Vec<f32> = depths.iter().map(|&z| (focal_baseline.abs() / f64::from(z)) as f32).collect();
            let matched = medians(subject.size(), &disparities, self.window_px as usize);
            for (i, (depth, &disparity)) in depths.iter_mut().zip(&matched).enumerate() {
                let noise = if noise_px > 0.0 { noise_px * pixels.fork(2 * i as u64).normal() } else { 0.0 };
                let told = in_steps(f64::from(disparity) + noise, self.step_px);
                *depth = if told > 0.0 { (focal_baseline.abs() / told) as f32 } else { f32::NAN };
            }
        }
        if dropout > 0.0 {
            forget(&mut depths, (0..).map(|i: u64| pixels.fork(2 * i + 1).next_f64() < dropout));
        }
        depths.iter_mut().filter(|depth| !reaches(self.range_m, f64::from(**depth))).for_each(|depth| *depth = f32::NAN);
        let names = ["noise_px", "max_angle_deg", "min_reflectance", "dropout"];
        let drawn = names.into_iter().zip([noise_px, max_angle_deg, min_reflectance, dropout]).collect();
        Ok(Reading { drawn, data: Data::Layer(Layer::DepthZMeters, Values::F32(depths)) })
    }

    /// Planar depth of the surfaces that are there, seen or not, metres: what is stored, except for what is behind glass.
    fn depths_m(&self, subject: &Subject<'_>) -> Result<Vec<f32>, SensorError> {
        let distances = self.optics().distances_m(&self.name, subject)?;
        let (stored, first) = (subject.floats(&self.name, Layer::DepthZMeters)?, subject.floats(&self.name, Layer::DepthMeters)?);
        let depth = |i: usize| {
            if distances[i] == first[i] {
                return stored[i];
            }
            subject.ray(i).map_or(f32::NAN, |ray| (f64::from(distances[i]) * -ray.z) as f32)
        };
        Ok((0..distances.len()).map(depth).collect())
    }
}

/// Subdivisions of a pixel of the second eye's image.
const PARTS: f64 = 4.0;
/// A surface hides those whose disparity is smaller by more than this, pixels: what is nearer by less casts no shadow that a pixel could show.
const NEARER_PX: f64 = 1.0;

/// Which pixels show what the second eye sees, too. Surfaces move by their disparity from one image to the other, along their row and
/// away from the side of the second eye; what something nearer covers there is hidden.
fn lit(k: &Intrinsics, focal_baseline: f64, eye: SecondEye, depths_m: &[f32]) -> Vec<bool> {
    let width = k.width as usize;
    let mut lit = vec![true; depths_m.len()];
    if focal_baseline == 0.0 {
        return lit;
    }
    for (depths, lit) in depths_m.chunks_exact(width).zip(lit.chunks_exact_mut(width)) {
        // Counted from the side of the second eye.
        let column = |step: usize| if focal_baseline > 0.0 { width - 1 - step } else { step };
        let disparity = |step: usize| {
            let depth = f64::from(depths[column(step)]);
            if depth > 0.0 { focal_baseline.abs() / depth } else { f64::NAN }
        };
        let disparities: Vec<f64> = (0..width).map(disparity).collect();
        let moved = |step: usize| step as f64 + 0.5 + disparities[step];

        // Only what is moved to a place within the row's own length, or beyond it by the largest disparity, can hide anything.
        let largest = disparities.iter().copied().fold(0.0, f64::max).min(width as f64);
        let part = |place: f64| (place * PARTS) as usize;
        let mut nearest = vec![0.0f64; part(width as f64 + largest) + 2];
        for step in 0..width {
            if moved(step).is_nan() || moved(step) > width as f64 + largest {
                continue;
            }
            // Up to halfway to the neighbours on the same surface, which may be stretched; half a pixel elsewhere.
            let reach = |other: Option<usize>| {
                let other = other.filter(|&other| (disparities[other] - disparities[step]).abs() <= NEARER_PX);
                other.map_or(0.5, |other| 0.5 * (moved(other) - moved(step)).abs())
            };
            let before = reach(step.checked_sub(1));
            let after = reach(Some(step + 1).filter(|&next| next < width));
            let (first, last) = (part((moved(step) - before).max(0.0)), part(moved(step) + after));
            for cell in nearest.iter_mut().take(last.max(first + 1)).skip(first) {
                *cell = cell.max(disparities[step]);
            }
        }
        for step in (0..width).filter(|&step| !moved(step).is_nan()) {
            let is_hidden = nearest.get(part(moved(step))).is_some_and(|&cover| cover > disparities[step] + NEARER_PX);
            let is_inside = eye == SecondEye::Projector || moved(step) < width as f64;
            lit[column(step)] = is_inside && !is_hidden;
        }
    }
    lit
}

/// The median of the values that are there in the square window around every pixel that has one, the lower of two in the middle.
fn medians([width, height]: [usize; 2], values: &[f32], window: usize) -> Vec<f32> {
    if window == 1 {
        return values.to_vec();
    }
    let reach = window / 2;
    let mut around = Vec::with_capacity(window * window);
    let mut median = |i: usize| {
        if values[i].is_nan() {
            return f32::NAN;
        }
        let (x, y) = (i % width, i / width);
        around.clear();
        for v in y.saturating_sub(reach)..=(y + reach).min(height - 1) {
            let row = &values[v * width..][x.saturating_sub(reach)..=(x + reach).min(width - 1)];
            around.extend(row.iter().copied().filter(|value| !value.is_nan()));
        }
        let middle = (around.len() - 1) / 2;
        *around.select_nth_unstable_by(middle, f32::total_cmp).1
    };
    (0..values.len()).map(&mut median).collect()
}
