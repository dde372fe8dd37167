//! Checks that the positions in an image are on the rays of the dataset's camera.
//!
//! A camera of V-Ray may shift its picture or stretch its pixels, and no header states it. Positions reveal it.

use crate::error::VrayError;
use crate::notes::Notes;
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::DVec3;
use enfilade_scene::{Pose, Projection};

/// Half of the positions are no farther than this from the middle of their pixels. Single ones are elsewhere, behind what is cut out.
const FAR_PX: f64 = 1.0;
/// About this many pixels are looked at.
const LOOKED_AT: usize = 1 << 14;

/// From where a frame is seen.
pub(crate) struct Sight<'a> {
    pub projection: &'a Projection,
    pub pose: &'a Pose,
    /// Metres per unit of the frame's positions.
    pub meters_per_unit: f64,
}

impl Sight<'_> {
    /// Checks the positions of a frame; `place` names the image.
    ///
    /// # Errors
    /// If they are off the rays; with `lenient` that is only a note.
    pub fn check(&self, frame: &Frame, place: &str, lenient: bool, notes: &mut Notes) -> Result<(), VrayError> {
        let Some(off_px) = self.offset_px(frame).filter(|off_px| *off_px > FAR_PX) else { return Ok(()) };
        let problem = format!("its positions lie {off_px:.1} pixels off the rays of the dataset's camera, in the median");
        if lenient {
            notes.add("positions lie off the rays of the dataset's camera", &format!("{place}: {problem}"));
            return Ok(());
        }
        Err(VrayError::usage(
            format!("{place}: {problem}"),
            "V-Ray's camera has a shift, a distortion or an aspect of pixels of its own: render it with the scene that `enfilade vray \
             camera` or `jobs` made for this dataset; --ignore-camera takes it as it is",
        ))
    }

    /// The median distance of positions from the middle of their pixels, pixels; `None` where the frame shows nothing.
    fn offset_px(&self, frame: &Frame) -> Option<f64> {
        let Some(Values::F32(positions)) = frame.get(Layer::Position) else { return None };
        let camera_from_world = self.pose.world_from_camera.transpose();
        let width = frame.width as usize;
        let offset = |i: usize| {
            let position = DVec3::from([0, 1, 2].map(|c| f64::from(positions[3 * i + c])));
            let p_camera = camera_from_world * (position * self.meters_per_unit - self.pose.position);
            let middle = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let seen = self.projection.project(p_camera);
            position.is_finite().then(|| seen.map_or(f64::INFINITY, |seen| self.projection.image_distance(seen, middle)))
        };
        // An odd step does not stay in the same columns.
        let step = (frame.pixels() / LOOKED_AT).max(1) | 1;
        let mut offsets: Vec<f64> = (0..frame.pixels()).step_by(step).filter_map(offset).collect();
        let middle = offsets.len() / 2;
        (!offsets.is_empty()).then(|| *offsets.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::trajectory;
    use enfilade_scene::Intrinsics;

    #[test]
    fn positions_of_a_shifted_camera_are_refused_and_single_ones_are_not() {
        let pose = trajectory().poses[1];
        let k = Intrinsics::from_fov_x(16, 12, 1.1);
        let projection = Projection::Pinhole(k);
        let position = |i: usize| {
            let ray = k.ray((i % 16) as f64 + 0.5, (i / 16) as f64 + 0.5);
            (pose.position + pose.world_from_camera * ray * (1.0 + 0.01 * i as f64)) / 0.5
        };
        let mut positions: Vec<f32> = (0..16 * 12).flat_map(|i| position(i).as_vec3().to_array()).collect();
        positions[..3].fill(f32::NAN);
        positions[30..90].fill(7.0);
        let mut frame = Frame::new(16, 12);
        frame.insert(Layer::Position, Values::F32(positions));
        let sight = Sight { projection: &projection, pose: &pose, meters_per_unit: 0.5 };
        assert!(sight.offset_px(&frame).unwrap() < 1e-4);
        let mut notes = Notes::default();
        sight.check(&frame, "frame.0000.exr", false, &mut notes).unwrap();
        let shifted = Projection::Pinhole(Intrinsics { cx: 10.0, ..k });
        let shifted = Sight { projection: &shifted, ..sight };
        let message = shifted.check(&frame, "frame.0000.exr", false, &mut notes).unwrap_err().to_string();
        assert!(message.contains("frame.0000.exr: its positions lie 2.0 pixels off the rays"), "{message}");
        shifted.check(&frame, "frame.0000.exr", true, &mut notes).unwrap();
        frame.insert(Layer::Position, Values::F32(vec![f32::NAN; 3 * 16 * 12]));
        assert_eq!(shifted.offset_px(&frame), None);
    }
}
