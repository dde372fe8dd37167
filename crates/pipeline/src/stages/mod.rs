//! The stages, in one table.
//!
//! A stage is a pure function of some other crate plus the thin file here that reads its inputs from the work folder and the
//! dataset and writes its outputs there. [`advance`] runs one, or skips it where nothing has changed.

mod advance;
mod boxes;
mod camera_files;
mod carve;
mod denoise;
mod exposure;
mod finisher;
mod gate;
mod import;
mod imported;
mod job;
mod kept;
mod label;
mod made;
mod moments;
mod objects;
mod own_cameras;
mod pilot;
mod plan;
mod plan_preview;
mod planned;
mod preview;
mod progressive;
mod record;
mod render;
mod shift;
mod starts;
mod targets;
mod variation;
mod verify;
mod views;

use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use record::{Input, Inputs, Outcome, Record};
use std::path::PathBuf;

pub use crate::stage::Stage;
pub use finisher::FinishedFrame;
pub use shift::Part;

pub(crate) use crate::stage::HASHED_AS;
pub(crate) use advance::{advance, is_up_to_date};
pub(crate) use finisher::frame_finisher;
pub(crate) use imported::describe;
pub(crate) use job::{FramesByTrajectory, Job};
pub(crate) use label::assign_table;
pub(crate) use moments::{Moment, frame_time};
pub(crate) use pilot::pilot;
pub(crate) use plan_preview::draw_plan;
pub(crate) use progressive::{FOLDER as PARTIALS, file_name as kept_part};
pub(crate) use record::{Output, record_key};
pub(crate) use render::{FrameCx, Timing, add_extra, config_hash, missing_frames, program, render_frames, take_at};
pub(crate) use shift::Shift;
pub(crate) use verify::CARD;
pub(crate) use views::views;

/// The definition of a stage.
pub struct StageSpec {
    /// Which one.
    pub stage: Stage,
    /// The name, as `run --only` takes it.
    pub name: &'static str,
    /// Description of its inputs and outputs.
    pub about: &'static str,
    /// Everything of the configuration that the outputs depend on.
    settings: fn(&Job) -> Hash,
    /// Everything else that they depend on; `None` when that is only known after the stage has run.
    inputs: fn(&Job, Option<&Record>) -> Inputs,
    /// Does the work.
    run: fn(&Job, &StageCx) -> Result<Outcome, Error>,
    /// Further checks of outputs that the stage's record does not cover. Frames have too many files for their contents to be in it: they
    /// have their own records. A scene package must be readable by this version.
    is_whole: fn(&Job) -> bool,
    /// A row that the stage writes into a table which scenes share.
    shared_row: Option<SharedRow>,
}

/// A scene's row in a table of the dataset. The table changes with every scene, so its length and content do not show whether the row is
/// unchanged.
struct SharedRow {
    /// The file of the table.
    table: fn(&Job) -> PathBuf,
    /// Hash of the row; `None` where there is none.
    hash: fn(&Job) -> Option<Hash>,
}

impl StageSpec {
    /// A row with the usual values in the columns that few stages use.
    const fn plain(
        stage: Stage,
        about: &'static str,
        settings: fn(&Job) -> Hash,
        inputs: fn(&Job, Option<&Record>) -> Inputs,
        run: fn(&Job, &StageCx) -> Result<Outcome, Error>,
    ) -> Self {
        Self { stage, name: stage.name(), about, settings, inputs, run, is_whole: |_| true, shared_row: None }
    }

    /// Whether what the stage makes takes the place of finished frames: then inputs are refused that an earlier stage did not write so.
    fn replaces_frames(&self) -> bool {
        self.stage <= Stage::Render
    }

    /// Whether `verify` checks its outputs: then the report card is removed before they change.
    fn is_verified(&self) -> bool {
        self.stage < Stage::Preview
    }
}

/// All stages in the order in which they run.
pub const STAGES: [StageSpec; 10] = [
    StageSpec {
        is_whole: import::package_is_current,
        ..StageSpec::plain(Stage::Import, "scene file -> scene package", import::settings, import::inputs, import::run)
    },
    StageSpec::plain(Stage::Carve, "scene -> free space (octomap.bt)", carve::settings, carve::inputs, carve::run),
    StageSpec {
        shared_row: Some(SharedRow { table: plan::camera_table, hash: plan::camera_row }),
        ..StageSpec::plain(Stage::Plan, "scene, free space -> camera trajectories", plan::settings, plan::inputs, plan::run)
    },
    StageSpec::plain(Stage::Gate, "scene, trajectories -> which views are worth rendering", gate::settings, gate::inputs, gate::run),
    StageSpec {
        is_whole: render::frames_are_whole,
        ..StageSpec::plain(Stage::Render, "scene, trajectories -> frames", render::settings, render::inputs, render::run)
    },
    StageSpec {
        is_whole: denoise::frames_are_chosen,
        ..StageSpec::plain(
            Stage::Denoise,
            "frames -> colour without noise, unless what was rendered is asked for",
            denoise::settings,
            denoise::inputs,
            denoise::run,
        )
    },
    StageSpec {
        is_whole: label::frames_are_whole,
        ..StageSpec::plain(Stage::Label, "frames, label table -> semantic layers", label::settings, label::inputs, label::run)
    },
    StageSpec::plain(
        Stage::Boxes,
        "scene, labels -> bounding boxes, and what each frame shows of each instance",
        boxes::settings,
        boxes::inputs,
        boxes::run,
    ),
    StageSpec::plain(Stage::Preview, "frames -> pictures and contact sheets", preview::settings, preview::inputs, preview::run),
    StageSpec::plain(Stage::Verify, "dataset -> report card", verify::settings, verify::inputs, verify::run),
];

impl Stage {
    /// The stage's row of the table.
    pub fn spec(self) -> &'static StageSpec {
        &STAGES[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_enum() {
        for (i, spec) in STAGES.iter().enumerate() {
            assert_eq!(spec.stage as usize, i);
        }
    }
}
