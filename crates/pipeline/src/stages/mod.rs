//! The stages, in one table.
//!
//! A stage is a pure function of some other crate plus the thin file here that reads its inputs from the work folder and the
//! dataset and writes its outputs there. [`advance`] runs one, or skips it where nothing has changed.

mod advance;
mod boxes;
mod camera_files;
mod carve;
mod denoise;
mod finisher;
mod gate;
mod import;
mod job;
mod kept;
mod label;
mod made;
mod pilot;
mod plan;
mod plan_preview;
mod preview;
mod progressive;
mod record;
mod render;
mod shift;
mod starts;
mod verify;

use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use record::{Input, Inputs, Outcome, Record};
use std::path::{Path, PathBuf};

pub use crate::stage::Stage;
pub use finisher::FinishedFrame;
pub use shift::Part;

pub(crate) use crate::stage::HASHED_AS;
pub(crate) use advance::{advance, is_up_to_date};
pub(crate) use finisher::frame_finisher;
pub(crate) use import::describe;
pub(crate) use job::{FramesByTrajectory, Job};
pub(crate) use label::{assign_table, read_table};
pub(crate) use pilot::pilot;
pub(crate) use plan_preview::draw_plan;
pub(crate) use progressive::{FOLDER as PARTIALS, file_name as kept_part};
pub(crate) use record::{Output, record_key};
pub(crate) use render::{FrameCx, add_extra, config_hash, missing_frames, program, render_frames, views};
pub(crate) use shift::Shift;
pub(crate) use verify::CARD;

/// What a stage is.
pub struct StageSpec {
    /// Which one.
    pub stage: Stage,
    /// The name, as `run --only` takes it.
    pub name: &'static str,
    /// What it reads and writes.
    pub about: &'static str,
    /// Everything of the configuration that the outputs depend on.
    settings: fn(&Job) -> Hash,
    /// Everything else that they depend on; `None` when that is only known after the stage has run.
    inputs: fn(&Job, Option<&Record>) -> Inputs,
    /// Does the work.
    run: fn(&Job, &StageCx) -> Result<Outcome, Error>,
    /// What sets it apart.
    exceptions: Exceptions,
}

/// What [`advance`] does otherwise for some stages than for the others.
struct Exceptions {
    /// Whether this output may differ from what the stage wrote, because people have changed it with another verb.
    may_be_changed: fn(&Job, &Path) -> bool,
    /// Whether all is well with outputs in ways that the stage's record does not tell. Of frames it has too many files to have their
    /// contents: layers are there in full length, under a record that is about this frame. A scene package is one that is read here.
    is_whole: fn(&Job) -> bool,
    /// A row that the stage writes into a table which scenes share.
    shared_row: Option<SharedRow>,
    /// Whether what it makes takes the place of finished frames: then inputs are refused that an earlier stage did not write so.
    replaces_frames: bool,
    /// Whether its outputs are among what `verify` looks at: then the report card goes before they change.
    is_verified: bool,
}

/// A scene's row in a table of the dataset. The table changes with every scene, so its length and content do not tell whether the row
/// is as the stage left it.
struct SharedRow {
    /// The file of the table.
    table: fn(&Job) -> PathBuf,
    /// Hash of the row; `None` where there is none.
    hash: fn(&Job) -> Option<Hash>,
}

impl Exceptions {
    /// Of a stage that follows the rule.
    const NONE: Self =
        Self { may_be_changed: |_, _| false, is_whole: |_| true, shared_row: None, replaces_frames: false, is_verified: true };
    /// Of one that comes before frames are finished.
    const BEFORE_FRAMES: Self = Self { replaces_frames: true, ..Self::NONE };
}

/// All stages in the order in which they run.
pub const STAGES: [StageSpec; 10] = [
    StageSpec {
        stage: Stage::Import,
        name: Stage::Import.name(),
        about: "scene file -> scene package",
        settings: import::settings,
        inputs: import::inputs,
        run: import::run,
        exceptions: Exceptions { may_be_changed: import::is_annotated, is_whole: import::package_is_current, ..Exceptions::BEFORE_FRAMES },
    },
    StageSpec {
        stage: Stage::Carve,
        name: Stage::Carve.name(),
        about: "scene -> free space (octomap.bt)",
        settings: carve::settings,
        inputs: carve::inputs,
        run: carve::run,
        exceptions: Exceptions::BEFORE_FRAMES,
    },
    StageSpec {
        stage: Stage::Plan,
        name: Stage::Plan.name(),
        about: "scene, free space -> camera trajectories",
        settings: plan::settings,
        inputs: plan::inputs,
        run: plan::run,
        exceptions: Exceptions {
            shared_row: Some(SharedRow { table: plan::camera_table, hash: plan::camera_row }),
            ..Exceptions::BEFORE_FRAMES
        },
    },
    StageSpec {
        stage: Stage::Gate,
        name: Stage::Gate.name(),
        about: "scene, trajectories -> which views are worth rendering",
        settings: gate::settings,
        inputs: gate::inputs,
        run: gate::run,
        exceptions: Exceptions::BEFORE_FRAMES,
    },
    StageSpec {
        stage: Stage::Render,
        name: Stage::Render.name(),
        about: "scene, trajectories -> frames",
        settings: render::settings,
        inputs: render::inputs,
        run: render::run,
        exceptions: Exceptions { is_whole: render::frames_are_whole, may_be_changed: render::is_chosen_later, ..Exceptions::BEFORE_FRAMES },
    },
    StageSpec {
        stage: Stage::Denoise,
        name: Stage::Denoise.name(),
        about: "frames -> colour without noise, unless what was rendered is asked for",
        settings: denoise::settings,
        inputs: denoise::inputs,
        run: denoise::run,
        exceptions: Exceptions { is_whole: denoise::frames_are_chosen, ..Exceptions::NONE },
    },
    StageSpec {
        stage: Stage::Label,
        name: Stage::Label.name(),
        about: "frames, label table -> semantic layers",
        settings: label::settings,
        inputs: label::inputs,
        run: label::run,
        exceptions: Exceptions { is_whole: label::frames_are_whole, ..Exceptions::NONE },
    },
    StageSpec {
        stage: Stage::Boxes,
        name: Stage::Boxes.name(),
        about: "scene, labels -> bounding boxes, and what each frame shows of each instance",
        settings: boxes::settings,
        inputs: boxes::inputs,
        run: boxes::run,
        exceptions: Exceptions::NONE,
    },
    StageSpec {
        stage: Stage::Preview,
        name: Stage::Preview.name(),
        about: "frames -> pictures and contact sheets",
        settings: preview::settings,
        inputs: preview::inputs,
        run: preview::run,
        exceptions: Exceptions { is_verified: false, ..Exceptions::NONE },
    },
    StageSpec {
        stage: Stage::Verify,
        name: Stage::Verify.name(),
        about: "dataset -> report card",
        settings: verify::settings,
        inputs: verify::inputs,
        run: verify::run,
        exceptions: Exceptions { is_verified: false, ..Exceptions::NONE },
    },
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
