//! Pages in the browser, served from the binary: [`label`] the parts of a scene, [`view`] a dataset.
//!
//! [`serve`] holds what both need: the server, who may talk to it, the files of the pages. The pages are plain modules for the
//! browser under `web/`; nothing is built, so what lies there is what runs.

pub mod label;
pub mod serve;
pub mod view;
