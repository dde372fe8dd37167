//! The differences of Hypersim's own release, as Apple publishes it: no manifest and no records, float16 distances and positions,
//! positions in asset units, no planar depth, and cameras in the tables that have no files.

use crate::{Dataset, DatasetError, Window};
use enfilade_frame::{Layer, Values};
use enfilade_math::DVec3;
use enfilade_scene::Projection;
use std::path::PathBuf;

/// The layers that a frame of Hypersim's release has.
pub const RELEASED_LAYERS: [Layer; 14] = [
    Layer::Color,
    Layer::DiffuseIllumination,
    Layer::DiffuseReflectance,
    Layer::Residual,
    Layer::DepthMeters,
    Layer::Position,
    Layer::NormalWorld,
    Layer::NormalCam,
    Layer::NormalBumpWorld,
    Layer::NormalBumpCam,
    Layer::TexCoord,
    Layer::RenderEntityId,
    Layer::Semantic,
    Layer::SemanticInstance,
];

impl Dataset {
    /// True for a scene that this program did not make: the dataset has no manifest, and no camera of the scene has records or, as in
    /// copies that [`Dataset::repack`] makes of ours, poses in OpenCV's conventions.
    pub fn is_released(&self, scene: &str) -> bool {
        let layout = self.layout();
        let is_ours = |camera: &String| layout.records_dir(scene, camera).is_dir() || layout.cameras_opencv(scene, camera).is_file();
        !layout.manifest().is_file() && !self.cameras(scene).unwrap_or_default().iter().any(is_ours)
    }

    /// True when [`Dataset::read_frame`] gives this layer of the frame: it is there, or it is planar depth of a camera with an image plane
    /// whose distances are there.
    pub fn gives_layer(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> bool {
        self.has_layer(scene, camera, frame, layer)
            || layer == Layer::DepthZMeters
                && self.has_layer(scene, camera, frame, Layer::DepthMeters)
                && self.read_camera(scene, camera).is_ok_and(|camera| camera.projection.has_image_plane())
    }

    /// The file that a layer is read from: its own, or the distances that planar depth is computed from.
    pub fn layer_source(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> PathBuf {
        self.layout().layer(scene, camera, frame, self.stored_layer(scene, camera, frame, layer))
    }

    /// The layer of that file: another one than `layer` if planar depth is computed.
    pub fn stored_layer(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> Layer {
        let computed = layer == Layer::DepthZMeters && !self.has_layer(scene, camera, frame, layer);
        if computed { Layer::DepthMeters } else { layer }
    }

    /// [`Dataset::meters_per_asset_unit`] of stored positions. If it is not recorded, it is 1 for our own scenes, and an error for a scene
    /// of the release, which is in asset units.
    pub(crate) fn meters_per_stored_unit(&self, scene: &str) -> Result<f64, DatasetError> {
        match self.meters_per_asset_unit(scene) {
            Err(error) if error.is_not_found() && !self.is_released(scene) => Ok(1.0),
            metres => metres,
        }
    }

    /// Positions in metres, in place.
    pub(crate) fn positions_in_metres(&self, scene: &str, positions: &mut Values) -> Result<(), DatasetError> {
        let metres = self.meters_per_stored_unit(scene)?;
        if let (Values::F32(values), true) = (positions, metres != 1.0) {
            values.iter_mut().for_each(|v| *v = (f64::from(*v) * metres) as f32);
        }
        Ok(())
    }
}

/// Planar depth along the viewing axis of K ([`Projection::image_axis`]) for distances along the rays of all pixels, row by row, both in
/// metres; NaN where there is no distance or no ray.
///
/// ```
/// use enfilade_dataset::planar_depth;
/// use enfilade_frame::Values;
/// use enfilade_scene::{Intrinsics, Projection};
/// // One row of three pixels, 45 degrees between neighbours: the outer rays are longer than their depth by the root of 2.
/// let camera = Projection::Pinhole(Intrinsics { width: 3, height: 1, fx: 1.0, fy: 1.0, cx: 1.5, cy: 0.5, skew: 0.0 });
/// let depth_z_m = planar_depth(&camera, &Values::F32(vec![2.0_f32.sqrt(), 1.0, 2.0_f32.sqrt()]));
/// assert!(depth_z_m.iter().all(|z| (z - 1.0).abs() < 1e-6));
/// ```
pub fn planar_depth(projection: &Projection, distance: &Values) -> Vec<f32> {
    let [width, height] = projection.size().map(|side| side as usize);
    planar_depth_of_part(projection, Window { top: 0, left: 0, height, width }, distance)
}

/// Turns stored `depth_z_meters`, which is along −z of camera space, to depth along the viewing axis of K ([`Projection::image_axis`]) in a
/// part of the image: they differ where the image plane is tilted.
pub fn turn_planar_depth(projection: &Projection, part: Window, depth_z: &mut Values) {
    let (axis, Values::F32(values)) = (projection.image_axis(), depth_z) else { return };
    if axis == DVec3::NEG_Z {
        return;
    }
    for (i, value) in values.iter_mut().enumerate() {
        let ray = ray_in_part(projection, part, i);
        *value = (f64::from(*value) * (ray.dot(axis) / -ray.z)) as f32;
    }
}

/// [`planar_depth`] of the pixels of a part of the image.
pub(crate) fn planar_depth_of_part(projection: &Projection, part: Window, distance: &Values) -> Vec<f32> {
    let axis = projection.image_axis();
    let forward = |i: usize| ray_in_part(projection, part, i).normalize().dot(axis);
    (0..distance.len()).map(|i| (distance.get(i) * forward(i)) as f32).collect()
}

/// The ray through the centre of pixel `i` of a part of the image, in camera space; NaN where it shows nothing.
fn ray_in_part(projection: &Projection, part: Window, i: usize) -> DVec3 {
    let (x, y) = (part.left + i % part.width, part.top + i / part.width);
    projection.ray(x as f64 + 0.5, y as f64 + 0.5).unwrap_or(DVec3::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DMat3;
    use enfilade_scene::{Intrinsics, TiltedPinhole};

    #[test]
    fn stored_depth_of_a_tilted_image_plane_is_turned_to_the_axis_of_k() {
        let k = Intrinsics { width: 40, height: 30, fx: 33.0, fy: 33.0, cx: 19.0, cy: 16.0, skew: 0.0 };
        let straight = Projection::Pinhole(k);
        let tilted = Projection::TiltedPinhole(TiltedPinhole::new(40, 30, DMat3::from_rotation_x(0.15) * k.cam_from_uv()).unwrap());
        let part = Window { top: 3, left: 7, height: 20, width: 30 };
        let ray = |projection: &Projection, i: usize| {
            let (x, y) = (part.left + i % part.width, part.top + i / part.width);
            projection.ray(x as f64 + 0.5, y as f64 + 0.5).unwrap().normalize()
        };
        for (projection, differs) in [(straight, false), (tilted, true)] {
            let stored: Vec<f32> = (0..600).map(|i| (-4.0 * ray(&projection, i).z) as f32).collect();
            let mut turned = Values::F32(stored.clone());
            turn_planar_depth(&projection, part, &mut turned);
            let Values::F32(turned) = turned else { panic!("it stays float32") };
            let expected = planar_depth_of_part(&projection, part, &Values::F32(vec![4.0; 600]));
            assert!(turned.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-5));
            assert_eq!(turned != stored, differs);
        }
    }
}
