//! The section `[vary]`: from a scene to its variations, which are scenes of their own.

use super::document::LevelKeys;
use super::settings::{SceneConfig, Varies};
use enfilade_options::{Keys, Whole};
use enfilade_vary::{Misset, VaryConfig, VaryKeys};
use std::ops::Range;

/// Least number of digits in the name of a variation.
const DIGITS: usize = 2;

/// What varies in a scene, by the keys of the levels from the weakest on; `None` where no key does.
///
/// # Errors
/// When keys say what varies and none how often, or a value cannot be; with its place.
pub(super) fn configured(levels: [&LevelKeys; 2]) -> Result<Option<VaryConfig>, (Misset, Option<Range<usize>>)> {
    let [document, scene] = levels.map(|level| &level.vary);
    let mut config = VaryConfig::default();
    document.apply(&mut config);
    scene.apply(&mut config);
    let span = |key: &str| scene.span(key).or_else(|| document.span(key));
    match (config.count, first_given(scene)) {
        // Of the keys at the top, other scenes may have the count.
        (None, None) => Ok(None),
        (None, Some(place)) => {
            let message = "[vary] has no `count`".into();
            Err((Misset { key: "count", message, help: "say how many variations to make: count = 20".into() }, Some(place)))
        }
        (Some(_), _) => match config.validate() {
            Ok(()) => Ok(Some(config)),
            Err(wrong) => {
                let place = span(wrong.key);
                Err((wrong, place))
            }
        },
    }
}

/// Where the first key of a section stands that is given.
pub(super) fn first_given(keys: &VaryKeys) -> Option<Range<usize>> {
    let mut names = Vec::new();
    VaryKeys::names(&mut names);
    names.iter().filter_map(|name| keys.span(name)).min_by_key(|span| span.start)
}

/// The variations of a scene, in the order of their numbers.
pub(super) fn variations(first: &SceneConfig, config: &VaryConfig) -> Vec<SceneConfig> {
    let count = config.count.map_or(0, Whole::get);
    let digits = count.to_string().len().max(DIGITS);
    let variation = |number: u32| SceneConfig {
        name: format!("{}_v{number:0digits$}", first.name),
        varies: Some(Varies { of: first.name.clone(), number, sets: config.sets(number), config: config.of_one() }),
        // Both come with the first scene, however it has got them.
        labels: None,
        objects: Vec::new(),
        motions: Vec::new(),
        ..first.clone()
    };
    (1..=count).map(variation).collect()
}
