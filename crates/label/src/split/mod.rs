//! Splits by scene: which scenes are for learning, for validation and for testing.
//!
//! Where a scene goes is a function of its name and the seed alone. So scenes never change sides when others are added, as they do
//! when a list is shuffled and cut, which is Hypersim's way; the price is that the shares are met only on average.

mod assets;

pub use assets::{ImageAsset, MeshAsset, SceneAssets, SharedAsset, shared_assets};

use enfilade_dataset::{FrameStatus, Manifest, Partition, SplitRow};
use enfilade_math::hash_u64;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How scenes are divided.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SplitConfig {
    /// Another seed is another division.
    pub seed: u64,
    /// Expected shares of train, val and test, in any unit.
    pub shares: [f64; 3],
}

impl Default for SplitConfig {
    /// Seed 0; 80, 10 and 10 percent.
    fn default() -> Self {
        Self { seed: 0, shares: [80.0, 10.0, 10.0] }
    }
}

impl SplitConfig {
    /// What is wrong with it, if anything is.
    pub fn problem(&self) -> Option<String> {
        let sum: f64 = self.shares.iter().sum();
        let good = self.shares.iter().all(|share| *share >= 0.0) && sum > 0.0 && sum.is_finite();
        (!good).then(|| format!("the shares are {:?}; expected three numbers from 0 on, not all 0, as in 80,10,10", self.shares))
    }

    /// The side of a scene.
    pub fn partition(&self, scene: &str) -> Partition {
        let hash = scene.bytes().fold(hash_u64(self.seed), |hash, byte| hash_u64(hash ^ u64::from(byte)));
        let place = (hash >> 11) as f64 / (1u64 << 53) as f64 * self.shares.iter().sum::<f64>();
        let [train, val, _] = self.shares;
        match place {
            p if p < train => Partition::Train,
            p if p < train + val => Partition::Val,
            _ => Partition::Test,
        }
    }

    /// Every frame of every trajectory. Those that are not rendered are left out of the split, with the reason; so are those in
    /// `excluded`, by scene, camera and frame.
    pub fn rows(&self, manifest: &Manifest, excluded: &BTreeMap<(String, String, u32), String>) -> Vec<SplitRow> {
        let mut rows = Vec::new();
        for (scene, entry) in &manifest.scenes {
            for (camera, frame) in entry.cameras.iter().flat_map(|(name, camera)| camera.frames.iter().map(move |frame| (name, frame))) {
                let missing =
                    (frame.status != FrameStatus::Complete).then(|| frame.reason.clone().unwrap_or_else(|| "NOT RENDERED".to_string()));
                let reason = excluded.get(&(scene.clone(), camera.clone(), frame.frame)).cloned().or(missing);
                let partition = reason.map_or(Ok(self.partition(scene)), Err);
                rows.push(SplitRow { scene: scene.clone(), camera: camera.clone(), frame: frame.frame, partition });
            }
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::{CameraEntry, Conventions, FrameEntry, SceneEntry};

    fn names(count: usize) -> Vec<String> {
        (0..count).map(|i| format!("ai_{:03}_{:03}", i / 10, i % 10)).collect()
    }

    #[test]
    fn shares_are_met_and_seeds_differ() {
        let split = SplitConfig::default();
        let names = names(10_000);
        let share = |partition| names.iter().filter(|name| split.partition(name) == partition).count() as f64 / 1e4;
        // Three standard deviations are 0.012 and 0.009.
        assert!((share(Partition::Train) - 0.8).abs() < 0.012 && (share(Partition::Val) - 0.1).abs() < 0.009);
        let other = SplitConfig { seed: 1, ..split };
        let moved = names.iter().filter(|name| split.partition(name) != other.partition(name)).count();
        assert!((3000..3800).contains(&moved), "34 % are expected on another side: {moved}");
        let all_test = SplitConfig { shares: [0.0, 0.0, 1.0], ..split };
        assert!(names.iter().all(|name| all_test.partition(name) == Partition::Test));
    }

    #[test]
    fn shares_that_mean_nothing_are_refused() {
        for shares in [[0.0; 3], [1.0, -1.0, 1.0], [f64::NAN, 1.0, 1.0], [f64::INFINITY, 1.0, 1.0]] {
            assert!(SplitConfig { shares, ..SplitConfig::default() }.problem().is_some(), "{shares:?}");
        }
        assert_eq!(SplitConfig::default().problem(), None);
    }

    #[test]
    fn scenes_stay_whole_and_frames_that_are_not_there_are_left_out() {
        let frame = |frame, status, reason: Option<&str>| FrameEntry {
            frame,
            status,
            reason: reason.map(Into::into),
            seed: None,
            config_hash: None,
            color: None,
            denoiser: None,
            files: BTreeMap::new(),
        };
        let frames = vec![
            frame(0, FrameStatus::Complete, None),
            frame(1, FrameStatus::Failed, Some("disk full")),
            frame(2, FrameStatus::Planned, None),
            frame(3, FrameStatus::Complete, None),
        ];
        let cameras = [("cam_00".to_string(), CameraEntry { frames })].into();
        let manifest = Manifest {
            format: String::new(),
            enfilade_version: String::new(),
            conventions: Conventions::default(),
            config: serde_json::Value::Null,
            seeds: BTreeMap::new(),
            scenes: [("room".to_string(), SceneEntry { failed: None, cameras })].into(),
        };
        let excluded = [(("room".to_string(), "cam_00".to_string(), 3), "blank".to_string())].into();
        let split = SplitConfig::default();
        let found: Vec<_> = split.rows(&manifest, &excluded).into_iter().map(|row| row.partition).collect();
        let side = split.partition("room");
        assert_eq!(found, [Ok(side), Err("disk full".into()), Err("NOT RENDERED".into()), Err("blank".into())]);
    }
}
