//! From the store to the dataset that one machine would have made.

use crate::bundle::unpack;
use crate::commit::read_marker;
use crate::object_names::object_name;
use crate::work::{damaged_object, missing_by_task};
use crate::{FarmError, FrameKey, Job, Marker, Ranges, print_ranges};
use enfilade_dataset::{Dataset, quoted, write_bytes};
use enfilade_pipeline::{Event, Reporter, Stage, Summary, finish, gather};
use std::path::Path;

/// Brings every frame into the folder `out`, checks it against its marker, and makes the rest of the dataset. What is there already
/// of this job is not fetched again.
///
/// # Errors
/// When frames are missing, `out` holds something else, or something in the store does not match its marker.
pub fn collect(job: &Job, out: &Path, reporter: &dyn Reporter) -> Result<Summary, FarmError> {
    let tasks = &job.plan.tasks;
    let missing: Ranges = missing_by_task(job)?.into_keys().collect();
    if !missing.is_empty() {
        let message = format!(
            "{} of {} tasks are not done; do them first: enfilade farm work {} --task {}",
            missing.len(),
            tasks.len(),
            quoted(job.store.url()),
            print_ranges(&missing)
        );
        return Err(FarmError::Request(message));
    }
    let taken = gather(out, &job.plan.id)?;
    fetch_files(job, out)?;
    let dataset = Dataset::create(out)?;
    let (mut done, total) = (0, tasks.iter().map(|task| task.part.frames.len() as u64).sum());
    for (number, task) in (0..).zip(tasks) {
        let part = &task.part;
        for &frame in &part.frames {
            reporter.on(&part.scene, Stage::Render, Event::Progress { what: "frames that come from the job", done, total });
            done += 1;
            let key = FrameKey { scene: part.scene.clone(), camera: part.camera.clone(), frame };
            let marker = read_marker(&job.store, &key)?.ok_or_else(|| damaged(job, &key.marker(), "is gone", number))?;
            if dataset.frame_record(&key.scene, &key.camera, frame).ok().flatten().is_none() {
                fetch_frame(job, &marker, out)?;
                dataset.append_time(&key.scene, &key.camera, frame, marker.time())?;
            }
        }
    }
    drop(taken);
    Ok(finish(out, reporter)?)
}

fn fetch_frame(job: &Job, marker: &Marker, out: &Path) -> Result<(), FarmError> {
    let wrong = |problem: &str| damaged(job, &marker.payload, problem, marker.task);
    let bytes = job.store.get(&marker.payload)?.ok_or_else(|| wrong("is missing"))?;
    if bytes.len() as u64 != marker.bytes {
        return Err(wrong(&format!("has {} bytes, expected {}", bytes.len(), marker.bytes)));
    }
    if blake3::hash(&bytes).to_hex().as_str() != marker.blake3 {
        // Workers look at lengths alone.
        return Err(wrong(&format!("is not what {} says; remove both", marker.key.marker())));
    }
    unpack(&bytes, out, &marker.payload)
}

/// The files that were there before rendering.
fn fetch_files(job: &Job, out: &Path) -> Result<(), FarmError> {
    let files = job.plan.files.iter().chain(job.plan.scenes.iter().flat_map(|scene| &scene.files));
    for (path, file) in files {
        let target = out.join(path);
        // Files appear whole, and stages may have written over them since.
        if target.is_file() {
            continue;
        }
        let name = object_name(&file.blake3);
        let bytes = job.store.get(&name)?.ok_or_else(|| damaged_object(job, &name, "is missing"))?;
        if blake3::hash(&bytes).to_hex().as_str() != file.blake3 {
            return Err(damaged_object(job, &name, "does not hold what its name says"));
        }
        write_bytes(&target, &bytes)?;
    }
    Ok(())
}

/// Something of a frame that its task makes again.
fn damaged(job: &Job, name: &str, problem: &str, task: u32) -> FarmError {
    let problem = format!("{problem}; do its task again: enfilade farm work {} --task {task}", quoted(job.store.url()));
    FarmError::Damaged { place: job.store.full_name(name), problem }
}
