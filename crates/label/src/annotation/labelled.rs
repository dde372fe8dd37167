//! What an annotation comes to.

use enfilade_scene::{Labels, PartId};

/// What every piece of a scene is called, and which faces it has.
#[derive(Clone, Debug, PartialEq)]
pub struct Annotation {
    /// The label of every piece: those of parts first, in the order of the scene.
    pub labels: Labels,
    /// Pieces that were split off, in order: the name of each, and the part that it is of.
    pub pieces: Vec<(String, PartId)>,
    /// The piece of every face.
    pub piece_of_face: Vec<u32>,
    /// How many instance numbers were given out, whether or not they are in use.
    pub instances: usize,
}
