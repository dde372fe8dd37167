//! Cameras alone: `<scene>/<camera>/cameras_opencv.json` with K and the pose of every frame, and `intrinsics.csv` with a row per scene.
//!
//! Poses are camera to world with OpenCV's axes, metres; pixel centres are whole numbers. Our own datasets have these files beside their
//! trajectories, so this is for datasets that lack them, such as Hypersim's release.

use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::intrinsics::{Intrinsic, csv_of};
use crate::selected_frames::{SelectedFrames, Track};
use enfilade_dataset::opencv_cameras;
use enfilade_scene::Trajectory;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    for track in &selected.tracks {
        let poses = track.views().map(|view| *view.pose()).collect();
        let trajectory = Trajectory { name: track.name.clone(), poses };
        let text = opencv_cameras(&track.scene, &trajectory, &track.camera);
        out.write(&format!("{}/cameras_opencv.json", track.folder()), text.as_bytes())?;
    }
    let row = |track: &Track| (track.scene.clone(), Some(track.name.clone()), Intrinsic::of(&track.camera.projection));
    out.write("intrinsics.csv", csv_of(selected.tracks.iter().map(row)).as_bytes())
}
