//! A dataset that many machines render: tasks, commits into a store, and files for the engines that start them.
//!
//! ```text
//! plan ──→ JOB/plan.json, JOB/objects/…        once, on one machine: scenes packaged, work divided into tasks
//! work ──→ JOB/frames/…, JOB/done/…            anywhere, any number of times, at the same time
//! collect ←── JOB                              once: the dataset, as one machine would have made it
//! ```
//!
//! The store is the truth. Engines (Slurm, Kubernetes, …) only start `work` with an index; they may start a task twice, kill it, or
//! let a node that they believe dead go on. So a frame is committed in two steps: its files go into one object whose name no other
//! attempt uses, and then a small marker, which only one writer can create, names that object. Whoever comes second has lost nothing
//! but time, since both made the same bytes.

mod bundle;
mod collect;
mod commit;
mod costs;
pub mod engines;
mod error;
mod feasible;
mod hand_in;
mod object_names;
mod plan;
mod plan_file;
mod program;
mod ranges;
mod signals;
mod status;
mod store;
mod submit;
mod work;

pub use bundle::unpack;
pub use collect::collect;
pub use commit::{Attempt, FrameKey, Marker};
pub use costs::{AttemptCost, Costs, Priced, Statement, costs};
pub use error::FarmError;
pub use feasible::Feasible;
pub use plan::{Job, Plan, PlanOptions, PlanStatement, PlannedScene, PricedPlan, StoredFile, Task, plan};
pub use ranges::{Ranges, parse_ranges, print_ranges};
pub use signals::stop_on_signals;
pub use status::{Status, status};
pub use store::{Created, Store, environment};
pub use submit::{Engine, EngineName, SubmitOptions, Submitted, how_to_submit, submit};
pub use work::{Assignment, AttemptRecord, Ended, Work, default_scratch, work};
