//! Laws of the labels and their images.

use super::card::Card;
use super::law::Law;
use super::scan::Scan;
use enfilade_frame::{Layer, Values};
use enfilade_label::class_name;
use enfilade_scene::{Labels, PartLabel};
use std::collections::{BTreeMap, BTreeSet};

pub(super) fn check(scan: &mut Scan<'_>) {
    let (semantic, instance) = (scan.layer(Layer::Semantic), scan.layer(Layer::SemanticInstance));
    let strange = |values: &Values, max: f64| {
        (0..values.len()).filter(|&i| values.get(i) != -1.0 && !(1.0..=max).contains(&values.get(i))).collect::<Vec<_>>()
    };
    if let Some(values) = semantic {
        scan.broken(Law::SemanticRange, "no such class", strange(values, f64::from(scan.view.last_class)).into_iter());
    }
    if let Some(values) = instance {
        scan.broken(Law::InstanceRange, "no instance number", strange(values, f64::INFINITY).into_iter());
    }
    let (Some(ids), Some(labels)) = (scan.layer(Layer::RenderEntityId), scan.view.labels) else { return };
    join(scan, Law::SemanticJoin, semantic, ids, labels, |label| label.semantic);
    join(scan, Law::InstanceJoin, instance, ids, labels, |label| label.instance);
}

fn join(scan: &mut Scan<'_>, law: Law, image: Option<&Values>, ids: &Values, labels: &Labels, of: fn(&PartLabel) -> i16) {
    let Some(image) = image else { return };
    let expected = |pixel: usize| {
        let label = (ids.get(pixel) >= 1.0).then(|| labels.parts.get(ids.get(pixel) as usize - 1)).flatten();
        f64::from(label.map_or(-1, of))
    };
    // Of a part that was split a pixel shows one piece or another.
    let allowed: BTreeSet<(u32, i16)> = scan.view.pieces.iter().map(|(entity, label)| (*entity, of(label))).collect();
    let is_piece = |pixel: usize| !allowed.is_empty() && allowed.contains(&(ids.get(pixel) as u32, image.get(pixel) as i16));
    let mut wrong = (0..ids.len()).filter(|&i| image.get(i) != expected(i) && !is_piece(i)).peekable();
    let what = wrong.peek().map_or(String::new(), |&i| format!("{} where the tables say {}", image.get(i), expected(i)));
    scan.broken(law, &what, wrong);
}

/// Checks the labels of a scene: an instance has one class. `place` names the scene.
pub fn check_labels(labels: &Labels, place: &str) -> Card {
    let mut class_of: BTreeMap<i16, i16> = BTreeMap::new();
    let mut torn: BTreeMap<i16, String> = BTreeMap::new();
    for label in labels.parts.iter().filter(|label| label.instance >= 1) {
        let class = *class_of.entry(label.instance).or_insert(label.semantic);
        if class != label.semantic {
            let both = format!("instance {} is both {} and {}", label.instance, class_name(class), class_name(label.semantic));
            torn.entry(label.instance).or_insert(both);
        }
    }
    let mut card = Card::default();
    card.observe(Law::InstanceClass, torn.len() as f64, || format!("{place}: {}", torn.values().next().map_or("", |s| s)));
    card
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instance_of_two_classes_is_found() {
        let label = |semantic, instance| PartLabel { semantic, instance };
        let good = Labels { parts: vec![label(5, 1), label(5, 1), label(1, -1), label(2, -1)] };
        assert_eq!(check_labels(&good, "s").failures(), []);
        let bad = Labels { parts: vec![label(5, 1), label(6, 1), label(7, 1)] };
        let card = check_labels(&bad, "s");
        assert_eq!(card.failures(), [Law::InstanceClass]);
        assert!(
            super::super::VerifyReport::new(&card, 1, vec![], vec![], vec![]).to_text().contains("s: instance 1 is both chair and sofa")
        );
    }
}
