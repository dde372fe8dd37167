//! `gate`: which of the planned views are worth rendering, by their geometry.

use super::{Input, Inputs, Job, Outcome, Record, Stage, camera_files, carve, moments};
use crate::error::Error;
use crate::gatekeeper::Gatekeeper;
use crate::report::StageCx;
use crate::workdir::{Hash, read_json};
use crate::world::World;
use enfilade_dataset::{JudgedView, ViewFault, ViewVerdict, counted, remove_folder, remove_if_there, write_bytes};
use enfilade_explore::PlanReport;
use enfilade_scene::{CameraView, Cx, Trajectory, Warning};
use enfilade_show::gates_page::{Judged, gates_page};
use enfilade_show::picture::jpeg;
use enfilade_verify::view_gates::{GateAction, GateConfig, VIEW_GATES};
use std::path::PathBuf;

/// Frames named in a warning; more are shown as `…`.
const FRAMES_NAMED: usize = 12;

pub(super) fn settings(job: &Job) -> Hash {
    Hash::of(&job.scene.gate)
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = vec![job.input_from(Stage::Import, &job.package()?)?, job.input_from(Stage::Carve, &job.work_file(carve::STARTS)?)?];
    inputs.extend(camera_files::inputs(job)?);
    inputs.extend(moments::inputs(job)?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    forget(job)?;
    let (layout, name, config) = (job.dataset.layout(), &job.scene.name, &config(job)?);
    if *config != job.scene.gate {
        let message = "a start camera is in the open, so no view is rejected for open surroundings or missing depth".into();
        cx.warn(Warning { place: "gates".into(), message });
    }
    let (scene, world) = (job.load_scene()?, job.load_world()?);
    let starts = carve::standing(job)?;
    let keeper = Gatekeeper::new(&scene, &world, &starts, config)?;
    let filmed = job.filmed()?;
    let total: usize = filmed.iter().map(|(_, trajectory)| trajectory.poses.len()).sum();
    let (mut judged, mut outputs): (Vec<Judged>, Vec<PathBuf>) = (Vec::new(), Vec::new());
    for (camera, trajectory) in filmed.iter() {
        let (first, given) = (judged.len(), given_frame(job, &trajectory.name));
        let frame_time_s = moments::frame_time(job.dataset, &job.package()?, name, &trajectory.name)?;
        for (index, pose) in trajectory.poses.iter().enumerate() {
            let view = CameraView::of_frame(camera, &trajectory.poses, index);
            let (judgement, picture) = match frame_time_s {
                None => keeper.judged(&view),
                // What moves may hide everything.
                Some(frame_time_s) => {
                    let scene = scene.at(pose.moment_s(frame_time_s));
                    Gatekeeper::new(&scene, &World::of(&scene), &starts, config)?.judged(&view)
                }
            };
            let thumbnail = match picture {
                None => None,
                Some(picture) => {
                    let path = layout.rejected_view(name, &trajectory.name, pose.frame);
                    write_bytes(&path, jpeg(&picture))?;
                    let relative = path.strip_prefix(layout.detail_dir(name)).unwrap_or(&path).display().to_string();
                    outputs.push(path);
                    Some(relative)
                }
            };
            let (measures, fault) = (judgement.measures, judgement.fault);
            let verdict = match (fault, config.action) {
                (None, _) => ViewVerdict::Passed,
                (Some(_), GateAction::Reject) if Some(pose.frame) != given => ViewVerdict::Rejected,
                (Some(_), _) => ViewVerdict::Reported,
            };
            judged.push(Judged { camera: trajectory.name.clone(), frame: pose.frame, measures, fault, verdict, thumbnail });
            cx.progress("views", judged.len() as u64, total as u64);
        }
        write_verdicts(job, config, trajectory, &judged[first..])?;
        outputs.push(layout.view_gates(name, &trajectory.name));
        warn(trajectory, &judged[first..], cx);
    }
    let page = layout.gates_page(name);
    write_bytes(&page, gates_page(name, config, &judged))?;
    outputs.push(page);
    let faulty = judged.iter().filter(|view| view.fault.is_some()).count();
    let rejected = rejected(&judged);
    if rejected == total && total > 0 {
        return Err(Error::scene(
            format!("all {} are rejected ({})", counted(total, "view"), tally(&judged)),
            format!(
                "see {}; place the cameras elsewhere, or set other limits or action = \"report\" in [gate]",
                layout.gates_page(name).display()
            ),
        ));
    }
    let verb = if rejected > 0 { "rejected" } else { "reported" };
    let summary = match faulty {
        0 => format!("all {} pass", counted(total, "view")),
        _ => format!("{} of {} pass, {verb}: {}", total - faulty, counted(total, "view"), tally(&judged)),
    };
    Ok(Outcome { summary, outputs, ..Outcome::default() })
}

/// The gates of a scene. In an open place the gates that assume a room are off: that there are surfaces around, and depth in nearly every
/// pixel.
pub(super) fn config(job: &Job) -> Result<GateConfig, Error> {
    let gate = job.scene.gate.clone();
    Ok(if carve::is_open_place(job)? { GateConfig { max_open_share: 1.0, max_invalid_share: 1.0, ..gate } } else { gate })
}

/// The frame of a trajectory that is a start camera's own pose, which is rendered in any case.
fn given_frame(job: &Job, trajectory: &str) -> Option<u32> {
    let path = job.dataset.layout().plan_report(&job.scene.name, trajectory);
    let report: PlanReport = read_json(&path)?;
    report.start.filter(|start| start.is_kept).map(|_| 0)
}

fn rejected(views: &[Judged]) -> usize {
    views.iter().filter(|view| view.verdict == ViewVerdict::Rejected).count()
}

/// The verdicts, as inputs of later stages.
pub(super) fn verdicts(job: &Job) -> Result<Vec<Input>, Error> {
    let layout = job.dataset.layout();
    let file = |trajectory: &Trajectory| job.input_from(Stage::Gate, &layout.view_gates(&job.scene.name, &trajectory.name));
    job.filmed()?.iter().map(|(_, trajectory)| file(trajectory)).collect()
}

/// Removes the results for an earlier plan.
pub(super) fn forget(job: &Job) -> Result<(), Error> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    remove_if_there(&layout.gates_page(name))?;
    for camera in job.there()? {
        remove_if_there(&layout.view_gates(name, &camera))?;
        remove_folder(&layout.rejected_dir(name, &camera))?;
    }
    Ok(())
}

fn write_verdicts(job: &Job, config: &GateConfig, trajectory: &Trajectory, views: &[Judged]) -> Result<(), Error> {
    let row = |view: &Judged| {
        let fault =
            view.fault.map(|gate| ViewFault { gate: gate.spec().name.into(), value: view.measures.value(gate), limit: config.limit(gate) });
        let measures = VIEW_GATES.iter().map(|spec| view.measures.value(spec.gate)).collect();
        (JudgedView { frame: view.frame, verdict: view.verdict, fault }, measures)
    };
    let rows: Vec<_> = views.iter().map(row).collect();
    let columns = VIEW_GATES.map(|spec| spec.column);
    job.dataset.write_view_gates(&job.scene.name, &trajectory.name, &columns, &rows).map_err(Error::stage)
}

/// One warning for a trajectory that has views with a fault.
fn warn(trajectory: &Trajectory, views: &[Judged], cx: &StageCx) {
    let faulty: Vec<&Judged> = views.iter().filter(|view| view.fault.is_some()).collect();
    if faulty.is_empty() {
        return;
    }
    let named: Vec<String> = faulty.iter().take(FRAMES_NAMED).map(|view| view.frame.to_string()).collect();
    let more = if faulty.len() > FRAMES_NAMED { ", …" } else { "" };
    let rejected = rejected(views);
    let verb = match rejected {
        0 => "not worth rendering, but rendered",
        n if n == faulty.len() => "rejected and not rendered",
        _ => "rejected and not rendered, except the start camera's own",
    };
    let (n, all, why) = (faulty.len(), counted(views.len(), "view"), tally(views));
    let mut message = format!("{n} of {all} {verb}: {why} (frames {}{more})", named.join(", "));
    if rejected == views.len() {
        message += "; none is left: place this camera elsewhere, or set other limits in [gate]";
    }
    cx.warn(Warning { place: trajectory.name.clone(), message });
}

/// "3 blocked, 1 bare_wall"
fn tally(views: &[Judged]) -> String {
    let with = |gate| views.iter().filter(|view| view.fault == Some(gate)).count();
    let found = VIEW_GATES.iter().map(|spec| (with(spec.gate), spec.name)).filter(|(n, _)| *n > 0);
    found.map(|(n, name)| format!("{n} {name}")).collect::<Vec<_>>().join(", ")
}
