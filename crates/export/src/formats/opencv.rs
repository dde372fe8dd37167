//! Cameras alone: `<scene>/<camera>/cameras_opencv.json` with K and the pose of every frame, and `intrinsics.csv` with a row per scene.
//!
//! Poses are camera to world with OpenCV's axes, metres; pixel centres are whole numbers. The files are those that stand beside the
//! trajectories of our own datasets, so this is for datasets that lack them, as Hypersim's release does.

use crate::ExportError;
use crate::intrinsics::{Intrinsic, csv_of};
use crate::place::Place;
use crate::source::{Source, Track};
use enfilade_dataset::opencv_cameras;
use enfilade_scene::Trajectory;

pub(crate) const README: &str = "\
# Cameras in OpenCV's conventions

`<scene>/<camera>/cameras_opencv.json` has K, distortion and the pose of every exported frame; `intrinsics.csv` K of every camera in one table.

- Camera axes x right, y down, z forward. `world_from_camera` takes camera coordinates (column vectors, metres) to the world, which is
  right-handed with z up.
- The centre of the upper left pixel is (0, 0): a world point p falls on K [I|0] inverse(world_from_camera) p.
- A tilted image plane (Hypersim's tilt-shift cameras) is a turned camera with a straight one. The poses are turned already; `r00` to `r22` of
  intrinsics.csv is the rotation that turned them: it takes Hypersim's camera axes (x right, y up, z backward) to those of K, so that
  camera_from_world = r * transpose(camera_keyframe_orientations[i]).
- `naive_error_px` is how far a centred camera of 60 degrees would be off in the worst corner of the image.
";

pub(crate) fn write(source: &Source<'_>, place: &Place) -> Result<(), ExportError> {
    for track in &source.tracks {
        let poses = track.views().map(|view| *view.pose()).collect();
        let trajectory = Trajectory { name: track.name.clone(), poses };
        let text = opencv_cameras(&track.scene, &trajectory, &track.camera);
        place.write(&format!("{}/cameras_opencv.json", track.folder()), text.as_bytes())?;
    }
    let row = |track: &Track| (track.scene.clone(), Some(track.name.clone()), Intrinsic::of(&track.camera.projection));
    place.write("intrinsics.csv", csv_of(source.tracks.iter().map(row)).as_bytes())
}
