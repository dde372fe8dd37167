//! A sample of a frame that is in memory, as [`Samples`](crate::Samples) gives it once it is on disk.

use crate::sample::{Image, Sample, Values};
use crate::samples::mask_of;
use enfilade_dataset::{OpencvCalibration, Window, turn_planar_depth};
use enfilade_frame::{Frame, Layer};
use enfilade_scene::{Camera, Pose};

/// The layers of `frame` that are `wanted` (all that it has where that is `None`), with mask, K and pose. `[scene, name]` are what scene and
/// camera are called.
///
/// # Errors
/// The first layer that the frame does not have.
pub fn sample_of(frame: &Frame, wanted: Option<&[Layer]>, camera: &Camera, pose: &Pose, [scene, name]: [&str; 2]) -> Result<Sample, Layer> {
    let [height, width] = [frame.height as usize, frame.width as usize];
    let window = Window { top: 0, left: 0, height, width };
    let image = |layer: Layer| {
        let mut values = frame.get(layer).ok_or(layer)?.clone();
        if layer == Layer::DepthZMeters {
            turn_planar_depth(&camera.projection, window, &mut values);
        }
        Ok((layer, Image { height, width, channels: layer.spec().channels, values }))
    };
    let layers = match wanted {
        Some(wanted) => wanted.iter().map(|&layer| image(layer)).collect::<Result<Vec<_>, _>>()?,
        None => frame.iter().map(|(layer, _)| image(layer)).collect::<Result<Vec<_>, _>>()?,
    };
    let mask = Image { height, width, channels: 1, values: Values::U8(mask_of(&layers, height * width)) };
    let calibration = OpencvCalibration::of(&camera.projection);
    Ok(Sample {
        scene: scene.into(),
        camera: name.into(),
        frame: pose.frame,
        window,
        layers,
        mask: Some(mask),
        k: calibration.intrinsics.map(|k| k.opencv_k()),
        world_from_camera: Some(calibration.world_from_camera(pose)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;
    use enfilade_scene::Intrinsics;

    #[test]
    fn a_frame_in_memory_is_a_sample_of_the_layers_that_are_wanted() {
        let camera = Camera::from(Intrinsics::from_fov_x(2, 1, 1.0));
        let pose = Pose::look_at(3, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
        let mut frame = Frame::new(2, 1);
        frame.insert(Layer::DepthMeters, Values::F32(vec![1.0, f32::NAN]));
        let sample = |wanted| sample_of(&frame, wanted, &camera, &pose, ["room", "cam"]);
        let all = sample(None).unwrap();
        assert_eq!((all.frame, all.layers.len(), all.mask.unwrap().values), (3, 1, Values::U8(vec![1, 0])));
        assert_eq!(all.k.unwrap()[0][2], 0.5);
        // Looking along y, the camera's right is x and its down is −z.
        assert_eq!(all.world_from_camera.unwrap()[..3], [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0]]);
        assert_eq!(sample(Some(&[Layer::Color])).unwrap_err(), Layer::Color);
    }
}
