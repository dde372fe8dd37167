//! The pairs of a scene in memory, and the answer about the pairs of one frame.

use super::cache::Weight;
use super::place::FramePlace;
use super::problems::Problems;
use enfilade_dataset::Covisibility;
use enfilade_scene::Pose;
use enfilade_serve::ApiProblem;
use serde_json::{Value, json};
use std::collections::HashSet;

/// A frame is sent at most this many partners, those with the largest overlap.
const MOST_PARTNERS: usize = 200;

/// The pairs of a scene.
pub struct PairsOfScene {
    pub covisibility: Covisibility,
    /// The pose of each frame of the matrix, where it is known.
    pub poses: Vec<Option<Pose>>,
    /// Places in the matrix of the pairs that the dataset's list has; `None` without a list.
    pub listed: Option<HashSet<[usize; 2]>>,
    pub lost: Problems,
}

impl Weight for PairsOfScene {
    fn weight(&self) -> usize {
        size_of_val(self.covisibility.shares.as_slice()) + size_of_val(self.poses.as_slice())
    }
}

impl PairsOfScene {
    /// The frames that see what a frame shows, or the other way around, those with the largest overlap first: the smaller of both shares.
    pub fn partners(&self, place: &FramePlace) -> Result<Value, ApiProblem> {
        let frames = &self.covisibility.frames;
        let Some(here) = frames.iter().position(|one| one.camera == place.camera && one.frame == place.frame) else {
            let error = format!("frame {} of {} is not in covisibility_frames.csv", place.frame, place.camera);
            return Err(ApiProblem::not_found(error, "run enfilade make OUT pairs again"));
        };
        let shares = |there: usize| [self.covisibility.share(here, there), self.covisibility.share(there, here)];
        let known = |there: usize| shares(there).into_iter().filter(|share| share.is_finite());
        // The smaller share counts: a picture of a detail is seen whole by a wide one, and shows little of it.
        let overlap = |there: usize| known(there).reduce(f32::min).unwrap_or(0.0);
        let mut others: Vec<usize> = (0..frames.len()).filter(|&there| there != here && known(there).any(|share| share > 0.0)).collect();
        others.sort_by(|&a, &b| overlap(b).total_cmp(&overlap(a)));
        let count = others.len();
        let partner = |there: usize| {
            let [this_seen, that_seen] = shares(there).map(|share| share.is_finite().then_some(share));
            let listed = self.listed.as_ref().map(|listed| listed.contains(&[here.min(there), here.max(there)]));
            let poses = self.poses[here].as_ref().zip(self.poses[there].as_ref());
            json!({
                "camera": frames[there].camera, "frame": frames[there].frame, "this_seen": this_seen, "that_seen": that_seen,
                "baseline_m": poses.map(|(a, b)| a.position.distance(b.position)),
                "angle_deg": poses.map(|(a, b)| a.world_from_camera.z_axis.angle_between(b.world_from_camera.z_axis).to_degrees()),
                "listed": listed,
            })
        };
        let partners: Vec<Value> = others.into_iter().take(MOST_PARTNERS).map(partner).collect();
        Ok(json!({ "partners": partners, "count": count, "hidden_by": self.covisibility.hidden_by.name(), "problems": self.lost }))
    }
}
