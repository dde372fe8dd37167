//! What the things of a scene are, how they stand to each other, and that in words.
//!
//! From the bottom up: a `body` is the surface of a thing that rays and distances are asked of; `contact` says where bodies meet;
//! `relations` makes of that what people say: on, in, under, against. `things` collects what each thing is, `seen` what the frames
//! show of it, `colors` what its colour is called. `words` knows how to speak of things, `captions` and `questions` do so.
//!
//! Everything is read from files of the dataset: the mesh folder with its labels, the layout of rooms where there is one, and the frames.
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
