//! Pictures against known answers.

mod cameras;
mod extra;
mod film;
mod glass;
mod known_answers;
mod layers;
mod look;
mod scene_to_frame;
mod terminator;
