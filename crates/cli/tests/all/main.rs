//! The program as people run it: its verbs, their files and their messages.

mod bad_input;
mod common;
mod denoise;
mod farm;
#[cfg(unix)]
mod farm_program;
mod hypersim;
mod ingest;
mod look;
mod pairs;
mod relight;
mod rendering;
mod replay;
mod resume;
mod rooms;
mod sense;
mod shell;
mod suggest;
mod verbs;
mod vray;
