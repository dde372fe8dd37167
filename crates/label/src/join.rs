//! Label images, joined from entity ids and what each part is.

use enfilade_scene::{Labels, PartLabel};

/// An entity id that no part has.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "render_entity_id {id} at pixel index {index} is no part of the scene, which has parts 1 to {parts}; \
     the frame was rendered from another version of the scene: render it again"
)]
pub struct JoinError {
    /// The id found.
    pub id: i16,
    /// Index of the pixel, row by row from the top.
    pub index: usize,
    /// How many parts there are.
    pub parts: usize,
}

/// The `semantic` and `semantic_instance` images of an image of part numbers.
///
/// `entity_ids` has part numbers from 1, and −1 where nothing was hit, which stays −1 in both results.
///
/// # Errors
/// When an id is 0, below −1 or beyond the labels.
pub fn join(entity_ids: &[i16], labels: &Labels) -> Result<(Vec<i16>, Vec<i16>), JoinError> {
    let label_of = |(index, &id): (usize, &i16)| match id {
        -1 => Ok(PartLabel::NONE),
        1.. => labels.parts.get(id as usize - 1).copied().ok_or(JoinError { id, index, parts: labels.parts.len() }),
        _ => Err(JoinError { id, index, parts: labels.parts.len() }),
    };
    let joined: Vec<PartLabel> = entity_ids.iter().enumerate().map(label_of).collect::<Result<_, _>>()?;
    Ok((joined.iter().map(|l| l.semantic).collect(), joined.iter().map(|l| l.instance).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels() -> Labels {
        Labels { parts: vec![PartLabel { semantic: 2, instance: -1 }, PartLabel { semantic: 6, instance: 3 }, PartLabel::NONE] }
    }

    #[test]
    fn ids_become_classes_and_instances_and_nothing_stays_nothing() {
        let (semantic, instance) = join(&[1, 2, 3, -1, 2], &labels()).unwrap();
        assert_eq!(semantic, [2, 6, -1, -1, 6]);
        assert_eq!(instance, [-1, 3, -1, -1, 3]);
    }

    #[test]
    fn ids_beyond_the_parts_are_refused() {
        assert_eq!(join(&[1, 4], &labels()), Err(JoinError { id: 4, index: 1, parts: 3 }));
        assert_eq!(join(&[0], &labels()), Err(JoinError { id: 0, index: 0, parts: 3 }));
        assert!(join(&[1, 4], &labels()).unwrap_err().to_string().contains("parts 1 to 3"));
    }
}
