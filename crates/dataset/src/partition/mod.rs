//! Partitions by scene: which scenes are for learning, for validation and for testing.
//!
//! Where a scene goes is a function of its name and the seed alone. So scenes never change sides when others are added, as they do
//! when a list is shuffled and cut, which is Hypersim's way; the price is that the shares are met only on average. The one exception are
//! datasets with nothing to learn from otherwise, see [`PartitionConfig::sides`].

mod assets;
mod files;

pub use assets::{ImageAsset, MeshAsset, SceneAssets, SharedAsset, shared_assets};
pub use files::{PartitionRow, Side};

use crate::{FrameEntry, FrameStatus, Manifest, SceneEntry};
use enfilade_math::hash_u64;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// The settings of a partition of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartitionConfig {
    /// Seed of the division.
    pub seed: u64,
    /// Expected shares of train, val and test, in any unit.
    pub shares: [f64; 3],
}

impl Default for PartitionConfig {
    /// Seed 0; 80, 10 and 10 percent.
    fn default() -> Self {
        Self { seed: 0, shares: [80.0, 10.0, 10.0] }
    }
}

impl PartitionConfig {
    /// The fault of the settings, if any.
    pub fn problem(&self) -> Option<String> {
        let sum: f64 = self.shares.iter().sum();
        let good = self.shares.iter().all(|share| *share >= 0.0) && sum > 0.0 && sum.is_finite();
        (!good).then(|| format!("the shares are {:?}; expected three numbers from 0 on, not all 0, as in 80,10,10", self.shares))
    }

    /// The side of every scene of a dataset.
    ///
    /// It is [`side`](Self::side)'s, but where fewer scenes than sides that get a share have images, or none of them is for
    /// learning: then the first of them by name is, for without anything to learn from a dataset is of no use. Variations of a scene are
    /// where that scene is, and count as one with it. `excluded` as in [`rows`](Self::rows).
    pub fn sides<'m>(
        &self,
        manifest: &'m Manifest,
        excluded: &BTreeMap<(String, String, u32), String>,
        first_of: &BTreeMap<String, String>,
    ) -> BTreeMap<&'m str, Side> {
        let first = |scene: &'m str| {
            first_of.get(scene).map_or(scene, |first| manifest.scenes.get_key_value(first).map_or(scene, |(name, _)| name))
        };
        let side = |scene: &str| self.side(first_of.get(scene).map_or(scene, String::as_str));
        let mut sides: BTreeMap<&str, Side> = manifest.scenes.keys().map(|scene| (scene.as_str(), side(scene))).collect();
        let has_image = |scene: &str, entry: &SceneEntry| {
            let is_there = |camera: &str, frame: &FrameEntry| {
                frame.status == FrameStatus::Complete && !excluded.contains_key(&(scene.to_string(), camera.to_string(), frame.frame))
            };
            entry.cameras.iter().any(|(name, camera)| camera.frames.iter().any(|frame| is_there(name, frame)))
        };
        let with_images: BTreeSet<&str> =
            manifest.scenes.iter().filter(|(scene, entry)| has_image(scene, entry)).map(|(scene, _)| first(scene)).collect();
        let is_few = with_images.len() < self.shares.iter().filter(|share| **share > 0.0).count();
        let lacks_train = with_images.iter().all(|scene| sides[scene] != Side::Train);
        if let Some(chosen) = with_images.first().filter(|_| self.shares[0] > 0.0 && (is_few || lacks_train)) {
            sides.iter_mut().filter(|(scene, _)| first(scene) == *chosen).for_each(|(_, side)| *side = Side::Train);
        }
        sides
    }

    /// The side of a scene among many.
    pub fn side(&self, scene: &str) -> Side {
        let hash = scene.bytes().fold(hash_u64(self.seed), |hash, byte| hash_u64(hash ^ u64::from(byte)));
        let place = (hash >> 11) as f64 / (1u64 << 53) as f64 * self.shares.iter().sum::<f64>();
        let [train, val, _] = self.shares;
        match place {
            p if p < train => Side::Train,
            p if p < train + val => Side::Val,
            _ => Side::Test,
        }
    }

    /// Every frame of every trajectory. Those that are not rendered are left out of the partition, with the reason; so are those in
    /// `excluded`, by scene, camera and frame. `first_of` has the scenes that variations vary, by the names of these.
    pub fn rows(
        &self,
        manifest: &Manifest,
        excluded: &BTreeMap<(String, String, u32), String>,
        first_of: &BTreeMap<String, String>,
    ) -> Vec<PartitionRow> {
        let (sides, mut rows) = (self.sides(manifest, excluded, first_of), Vec::new());
        for (scene, entry) in &manifest.scenes {
            for (camera, frame) in entry.cameras.iter().flat_map(|(name, camera)| camera.frames.iter().map(move |frame| (name, frame))) {
                let missing =
                    (frame.status != FrameStatus::Complete).then(|| frame.reason.clone().unwrap_or_else(|| "NOT RENDERED".to_string()));
                let reason = excluded.get(&(scene.clone(), camera.clone(), frame.frame)).cloned().or(missing);
                let side = reason.map_or(Ok(sides[scene.as_str()]), Err);
                rows.push(PartitionRow { scene: scene.clone(), camera: camera.clone(), frame: frame.frame, side });
            }
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CameraEntry, Conventions};

    fn frame(frame: u32, status: FrameStatus, reason: Option<&str>) -> FrameEntry {
        FrameEntry {
            frame,
            status,
            reason: reason.map(Into::into),
            seed: None,
            config_hash: None,
            color: None,
            denoiser: None,
            files: BTreeMap::new(),
        }
    }

    fn manifest<const N: usize>(scenes: [(&str, Vec<FrameEntry>); N]) -> Manifest {
        let entry = |frames| SceneEntry { failed: None, cameras: [("cam_00".to_string(), CameraEntry { frames })].into() };
        Manifest {
            format: String::new(),
            enfilade_version: String::new(),
            conventions: Conventions::default(),
            config: serde_json::Value::Null,
            seeds: BTreeMap::new(),
            scenes: scenes.map(|(name, frames)| (name.to_string(), entry(frames))).into(),
        }
    }

    #[test]
    fn of_few_scenes_the_first_with_images_is_to_learn_from() {
        let config = PartitionConfig::default();
        let name = |side| names(100).into_iter().filter(|name| config.side(name) == side).collect::<Vec<_>>();
        let (trains, vals, tests) = (name(Side::Train), name(Side::Val), name(Side::Test));
        let there = || vec![frame(0, FrameStatus::Complete, None)];
        let sides = |scenes: &Manifest| -> Vec<Side> { config.sides(scenes, &BTreeMap::new(), &BTreeMap::new()).into_values().collect() };
        for alone in [&trains[0], &vals[0], &tests[0]] {
            assert_eq!(sides(&manifest([(alone, there())])), [Side::Train]);
        }
        let two = [&tests[0], &tests[1]];
        assert_eq!(sides(&manifest(two.map(|name| (name.as_str(), there())))), [Side::Train, Side::Test]);
        let failed = vec![frame(0, FrameStatus::Failed, None)];
        assert_eq!(sides(&manifest([(&tests[0], failed), (&tests[1], there())])), [Side::Test, Side::Train], "the first has no image");
        // As many scenes as sides: only where none is to learn from.
        let four = [&tests[0], &tests[1], &tests[2], &tests[3]].map(|name| (name.as_str(), there()));
        assert_eq!(sides(&manifest(four.clone())), [Side::Train, Side::Test, Side::Test, Side::Test]);
        let mut first_is_test = [&tests[0], &trains[0], &vals[0]].map(|name| (name.as_str(), there()));
        first_is_test.sort_by_key(|(name, _)| name.to_string());
        let all = manifest(first_is_test);
        assert!(config.sides(&all, &BTreeMap::new(), &BTreeMap::new()).into_iter().all(|(name, side)| side == config.side(name)));
        // Nobody who wants all in test gets another side.
        let all_test = PartitionConfig { shares: [0.0, 0.0, 1.0], ..config };
        assert_eq!(all_test.sides(&manifest(four), &BTreeMap::new(), &BTreeMap::new()).into_values().collect::<Vec<_>>(), [Side::Test; 4]);
    }

    #[test]
    fn variations_are_on_the_side_of_their_first_scene_and_count_as_one_with_it() {
        let config = PartitionConfig::default();
        let (rooms, there) = (names(40), || vec![frame(0, FrameStatus::Complete, None)]);
        let mut listed = manifest([]);
        let mut first_of = BTreeMap::new();
        for room in &rooms {
            for name in std::iter::once(room.clone()).chain((1..4).map(|k| format!("{room}_v{k:02}"))) {
                listed.scenes.extend(manifest([(&name, there())]).scenes);
                first_of.insert(name, room.clone());
            }
        }
        rooms.iter().for_each(|room| drop(first_of.remove(room)));
        let sides = config.sides(&listed, &BTreeMap::new(), &first_of);
        assert!(Side::ALL.into_iter().all(|side| sides.values().any(|found| *found == side)));
        assert!(sides.iter().all(|(name, side)| *side == config.side(first_of.get(*name).map_or(name, |first| first))));
        // One room that would be for testing, with its variations: all of it is to learn from.
        let test = rooms.iter().find(|room| config.side(room) == Side::Test).unwrap();
        listed.scenes.retain(|name, _| name.starts_with(test.as_str()));
        assert_eq!(listed.scenes.len(), 4);
        assert!(config.sides(&listed, &BTreeMap::new(), &first_of).into_values().all(|side| side == Side::Train));
    }

    fn names(count: usize) -> Vec<String> {
        (0..count).map(|i| format!("ai_{:03}_{:03}", i / 10, i % 10)).collect()
    }

    #[test]
    fn shares_are_met_and_seeds_differ() {
        let config = PartitionConfig::default();
        let names = names(10_000);
        let share = |side| names.iter().filter(|name| config.side(name) == side).count() as f64 / 1e4;
        // Three standard deviations are 0.012 and 0.009.
        assert!((share(Side::Train) - 0.8).abs() < 0.012 && (share(Side::Val) - 0.1).abs() < 0.009);
        let other = PartitionConfig { seed: 1, ..config };
        let moved = names.iter().filter(|name| config.side(name) != other.side(name)).count();
        assert!((3000..3800).contains(&moved), "34 % are expected on another side: {moved}");
        let all_test = PartitionConfig { shares: [0.0, 0.0, 1.0], ..config };
        assert!(names.iter().all(|name| all_test.side(name) == Side::Test));
    }

    #[test]
    fn shares_that_mean_nothing_are_refused() {
        for shares in [[0.0; 3], [1.0, -1.0, 1.0], [f64::NAN, 1.0, 1.0], [f64::INFINITY, 1.0, 1.0]] {
            assert!(PartitionConfig { shares, ..PartitionConfig::default() }.problem().is_some(), "{shares:?}");
        }
        assert_eq!(PartitionConfig::default().problem(), None);
    }

    #[test]
    fn scenes_stay_whole_and_frames_that_are_not_there_are_left_out() {
        let frames = vec![
            frame(0, FrameStatus::Complete, None),
            frame(1, FrameStatus::Failed, Some("disk full")),
            frame(2, FrameStatus::Planned, None),
            frame(3, FrameStatus::Complete, None),
        ];
        let manifest = manifest([("room", frames)]);
        let excluded = [(("room".to_string(), "cam_00".to_string(), 3), "blank".to_string())].into();
        let config = PartitionConfig::default();
        let found: Vec<_> = config.rows(&manifest, &excluded, &BTreeMap::new()).into_iter().map(|row| row.side).collect();
        assert_eq!(found, [Ok(Side::Train), Err("disk full".into()), Err("NOT RENDERED".into()), Err("blank".into())]);
    }
}
