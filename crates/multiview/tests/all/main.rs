//! Many views of scenes whose answer is known, through files.

mod common;
mod covisibility;
mod flow;
mod tracks;
