//! Let people see: previews of every layer, boxes drawn over frames, contact sheets, drawings of plans, statistics, pages.
//!
//! Most of it is a pure function of frames, labels and poses; [`drivers`], [`planview`], [`stats`] and [`report_card`] run these over a
//! dataset on disk.

pub mod display;
mod drawing;
pub mod drivers;
pub mod exposure;
pub mod gates_page;
pub mod inspect;
pub mod overlay;
mod page;
pub mod palette;
pub mod picture;
pub mod planview;
pub mod preview;
pub mod report_card;
pub mod sheet;
pub mod stats;
pub mod stretch;
pub mod thumbnail;
