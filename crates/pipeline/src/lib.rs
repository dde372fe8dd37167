//! The stages, their work folder, and how a run resumes.
//!
//! [`Config`] describes a dataset, [`run`] makes it. [`STAGES`] is the one list of stages; each is skipped when nothing that it
//! depends on has changed, so that a second run does nothing and a killed run resumes where it was. This is the only crate below
//! the command line that reads clocks and the environment.

mod assets;
mod config;
mod error;
mod estimate;
mod forecast;
mod gatekeeper;
mod in_memory;
mod intake;
mod look;
mod partition;
mod parts;
mod pattern;
mod products;
mod relight;
mod replay;
mod report;
mod request;
mod run;
mod scene_types;
mod single;
mod stage;
mod stages;
mod suggest;
mod workdir;
mod world;

#[doc(hidden)]
pub use assets::read_library;
pub use config::{
    CameraChoice, CameraConfig, CameraModel, Config, FarmConfig, FileSource, LabelSource, Lamps, LensConfig, Overrides, Placeholder,
    Quality, RenderChoices, SceneConfig, Source, StereoConfig, demo, read_sensors, select,
};
pub use enfilade_compose::MotionGroup;
pub use enfilade_dataset::{ColorKind, PartitionConfig, WORKDIR};
pub use enfilade_home::light::Moment;
pub use enfilade_home::{Building, HomeConfig, RoomKind, State, StateWord, States};
pub use enfilade_import::{EnvironmentOverride, Format as SceneFormat, UpAxis};
pub use enfilade_verify::view_gates::{GateAction, GateConfig};
pub use error::{ConfigError, Error, Place};
pub use estimate::estimate;
pub use forecast::{Expected, Forecast};
pub use in_memory::{FilePlace, LoadedScene, Shot};
pub use look::{Looked, look};
pub use partition::{PartitionReport, partition};
pub use parts::{Prepared, PreparedScene, finish, gather, kept_frame, prepare, render_part};
pub use products::{
    Made, MakeOptions, OutOfDate, PRODUCTS, ProductSpec, When, choose_pairs_of, make, make_products, make_stale, out_of_date, read_mixes,
    write_statistics,
};
pub use replay::{Replay, ReplayedFile, replay};
pub use report::{Event, Failure, ProductOutcome, Reporter, SceneOutcome, Silent, StageOutcome, Stopwatch, Summary};
pub use request::{FlowPairs, FrameChoice, MixRequest, PairsRequest, Product, ProductOptions, Request, Scope};
pub use run::{draw_plans, relabel, run, run_stage, run_stages, stored_config, verify};
pub use single::{Checked, Imported, MadeHome, check_file, holds_scene, import_file, make_home, refuse_overwriting, scene_file_of};
pub use stage::Stage;
pub use stages::{FinishedFrame, Part, STAGES, StageSpec};
pub use suggest::{SuggestedLabels, UnsurePart, suggest_labels};
