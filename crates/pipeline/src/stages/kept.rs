//! Which finished frames stay when a scene is planned again.

use super::{Job, render};
use crate::error::Error;
use enfilade_dataset::{Dataset, FrameRecord, StereoRecord, remove_folder};
use enfilade_scene::{Camera, Pose, Trajectory};
use std::collections::BTreeMap;

/// Folder within the work folder of a scene where a plan is tried out.
const FOLDER: &str = "planned";

/// A planned trajectory, its camera, and the other camera of a rig.
pub(super) struct Plan<'a> {
    pub trajectory: &'a Trajectory,
    pub camera: &'a Camera,
    pub stereo: Option<&'a StereoRecord>,
}

/// Removes pictures taken from elsewhere, or with another camera, which would be taken for pictures of these poses.
pub(super) fn remove_frames_of_other_poses(job: &Job, plan: &Plan) -> Result<(), Error> {
    let (name, trajectory) = (&job.scene.name, plan.trajectory);
    let poses: BTreeMap<u32, &Pose> = trajectory.poses.iter().map(|pose| (pose.frame, pose)).collect();
    let is_taken = |record: &FrameRecord| poses.get(&record.frame).is_some_and(|pose| record.is_taken(plan.camera, pose));
    // With motion blur, and with flow, a frame also depends on the poses before and after its own.
    let is_alone = plan.camera.shutter.is_none() && !job.scene.render.extra;
    let is_same = is_alone || job.dataset.read_trajectory(name, &trajectory.name).is_ok_and(|old| old == *trajectory);
    // The files of the earlier plan may be damaged. Then the records of the frames show whether the plan was the same.
    let hashes = if is_same { BTreeMap::new() } else { hashes(job, plan)? };
    let stays = |record: &FrameRecord| is_taken(record) && (is_same || hashes.get(&record.frame) == Some(&record.config_hash));
    job.dataset.retain_frames(name, &trajectory.name, stays).map_err(Error::stage)
}

/// The hashes that rendering will give the frames of the plan; empty where there is no frame to compare with.
fn hashes(job: &Job, plan: &Plan) -> Result<BTreeMap<u32, String>, Error> {
    let records = job.dataset.layout().records_dir(&job.scene.name, &plan.trajectory.name);
    if !std::fs::read_dir(records).is_ok_and(|mut entries| entries.next().is_some()) {
        return Ok(BTreeMap::new());
    }
    let folder = job.work_file(FOLDER)?;
    // A planning that was killed may have left it.
    remove_folder(&folder)?;
    let hashes = read_back(job, plan, &Dataset::create(&folder).map_err(Error::stage)?);
    remove_folder(&folder)?;
    hashes
}

/// Rendering reads cameras and poses from files, which may round them: so they are written to the dataset `aside` and read from there.
fn read_back(job: &Job, plan: &Plan, aside: &Dataset) -> Result<BTreeMap<u32, String>, Error> {
    let (name, of) = (&job.scene.name, &plan.trajectory.name);
    aside.write_trajectory(name, plan.trajectory, plan.camera, plan.stereo).map_err(Error::stage)?;
    aside.write_camera_parameters(name, plan.camera).map_err(Error::stage)?;
    let camera = aside.read_camera(name, of).map_err(Error::stage)?;
    let trajectory = aside.read_trajectory(name, of).map_err(Error::stage)?;
    render::config_hashes(job, &camera, &trajectory)
}
