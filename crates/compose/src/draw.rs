//! Which models are taken, and how large.

use crate::{Extent, Number, ObjectGroup};
use enfilade_math::Rng;

/// An object to be placed.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// Index of the group.
    pub group: usize,
    /// The model's file.
    pub model: String,
    /// The size drawn.
    pub size: Size,
    /// Seed of everything else about it.
    pub seed: u64,
}

/// The size of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// Times that of the file.
    Scale(f64),
    /// Length of the longest side, metres.
    Longest(f64),
}

/// The objects of a group: models in turn, in an order drawn anew for each round.
pub fn draw(group: &ObjectGroup, index: usize, files: &[String], rng: &mut Rng) -> Vec<Wanted> {
    let count = match group.count {
        Some(Number([least, most])) => least as usize + rng.below((most - least + 1) as usize),
        None => files.len(),
    };
    let mut round: Vec<&String> = Vec::new();
    let mut next = |rng: &mut Rng| {
        if round.is_empty() {
            round = files.iter().collect();
            if group.count.is_some() {
                rng.shuffle(&mut round);
            }
            round.reverse();
        }
        round.pop().cloned()
    };
    let wanted = |_| {
        let model = next(rng)?;
        let size = match group.size_m {
            Some(size) => Size::Longest(uniform(size, rng)),
            None => Size::Scale(uniform(group.scale, rng)),
        };
        Some(Wanted { group: index, model, size, seed: rng.next_u64() })
    };
    (0..count).map_while(wanted).collect()
}

/// A number drawn uniformly.
pub fn uniform(Extent([least, most]): Extent, rng: &mut Rng) -> f64 {
    least + (most - least) * rng.next_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Many;
    use std::collections::BTreeSet;

    #[test]
    fn no_model_is_taken_twice_before_all_are_taken_once() {
        let files: Vec<String> = ["a", "b", "c"].map(String::from).to_vec();
        let group =
            ObjectGroup { files: Many(files.clone()), count: Some(Number([7, 7])), scale: Extent([0.5, 2.0]), ..ObjectGroup::default() };
        let wanted = draw(&group, 0, &files, &mut Rng::new(3));
        assert_eq!(wanted.len(), 7);
        for round in wanted.chunks(3).take(2) {
            assert_eq!(round.iter().map(|one| one.model.as_str()).collect::<BTreeSet<_>>().len(), 3);
        }
        assert!(wanted.iter().all(|one| matches!(one.size, Size::Scale(scale) if (0.5..2.0).contains(&scale))));
        let each = draw(&ObjectGroup { count: None, ..group }, 0, &files, &mut Rng::new(3));
        assert_eq!(each.iter().map(|one| one.model.as_str()).collect::<Vec<_>>(), ["a", "b", "c"]);
    }
}
