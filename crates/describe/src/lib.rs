//! The things of a scene, the relations between them, and descriptions of both in words.
//!
//! From the bottom up: a `body` is the surface of a thing, for queries by rays and distances; `contact` finds where bodies meet;
//! `relations` turns that into the relations that people name: on, in, under, against. `things` collects what each thing is, `seen` what
//! the frames show of it, `colors` names its colour. `words` has the vocabulary, `captions` and `questions` use it.
//!
//! Everything is read from files of the dataset: the mesh folder with its labels, the rooms where they are known, and the frames.
//! The same files give the same words on any number of threads.

mod body;
mod captions;
mod colors;
mod contact;
mod describe;
mod questions;
mod relations;
mod seen;
#[cfg(test)]
mod test_rooms;
mod things;
mod words;

pub use describe::{Described, describe};
