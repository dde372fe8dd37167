//! Result of an annotation.

use enfilade_scene::{Labels, PartId};

/// The label and the faces of every piece of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Annotation {
    /// The label of every piece: parts first, in the order of the scene.
    pub labels: Labels,
    /// Pieces that were split off, in order: the name of each, and the part that it is of.
    pub pieces: Vec<(String, PartId)>,
    /// The piece of every face.
    pub piece_of_face: Vec<u32>,
    /// Number of instance numbers ever assigned, whether or not they are in use.
    pub instances: usize,
}
