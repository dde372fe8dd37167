//! From visible faces to selected pieces: the filters, then the expansion.

use super::pieces::{Piece, Pieces};
use enfilade_scene::PartLabel;
use serde::Deserialize;
use std::collections::{BTreeSet, HashSet};

/// Which faces a stroke may touch, by the labels of their pieces. Applied before the selection is expanded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Filters {
    only_without_instance: bool,
    only_with_instance: bool,
    only_without_class: bool,
    only_with_class: bool,
}

/// The pieces selected along with a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Expand {
    /// The piece alone.
    #[default]
    Piece,
    /// Every piece of its instance, where it has one.
    Instance,
    /// Every piece of its class, where it has one.
    Class,
}

impl Filters {
    /// Refuses filters that exclude each other.
    ///
    /// # Errors
    /// Which two contradict each other.
    pub fn check(&self) -> Result<(), String> {
        let both =
            |what: &str| Err(format!("filters.only_without_{what} and filters.only_with_{what} contradict each other; set one of them"));
        match self {
            Self { only_without_instance: true, only_with_instance: true, .. } => both("instance"),
            Self { only_without_class: true, only_with_class: true, .. } => both("class"),
            _ => Ok(()),
        }
    }

    fn pass(&self, label: PartLabel) -> bool {
        let (instance, class) = (label.instance >= 1, label.semantic >= 1);
        !(self.only_without_instance && instance
            || self.only_with_instance && !instance
            || self.only_without_class && class
            || self.only_with_class && !class)
    }
}

/// The faces that pass the filters, and the pieces that they select, ascending.
pub fn select(pieces: &Pieces, faces: &[u32], filters: &Filters, expand: Expand) -> (Vec<u32>, Vec<u32>) {
    let piece_of = |face: u32| pieces.of_face()[face as usize];
    let label_of = |piece: u32| pieces.list()[piece as usize].label;
    let faces: Vec<u32> = faces.iter().copied().filter(|&face| filters.pass(label_of(piece_of(face)))).collect();
    let touched: BTreeSet<u32> = faces.iter().map(|&face| piece_of(face)).collect();
    let kind = |label: PartLabel| match expand {
        Expand::Piece => -1,
        Expand::Instance => label.instance,
        Expand::Class => label.semantic,
    };
    let wanted: HashSet<i16> = touched.iter().map(|&piece| kind(label_of(piece))).filter(|&id| id >= 1).collect();
    let selected = |(number, piece): &(usize, &Piece)| touched.contains(&(*number as u32)) || wanted.contains(&kind(piece.label));
    let chosen = pieces.list().iter().enumerate().filter(selected).map(|(number, _)| number as u32).collect();
    (faces, chosen)
}
