//! The frames of a scene that show the same surfaces as a frame: from the matrix of `enfilade make OUT pairs`, its list, and the poses.

use super::pairs_of_scene::PairsOfScene;
use super::place::{FramePlace, problem, stamp};
use super::problems::Problems;
use super::viewer::{Viewer, work};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use enfilade_dataset::{Covisibility, check_name, read_pairs};
use enfilade_scene::Pose;
use enfilade_serve::{ApiProblem, reply};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

/// `GET /api/view/pairs/{scene}/{camera}/{frame}`.
pub async fn pairs(
    State(viewer): State<Arc<Viewer>>,
    Path((scene, camera, frame)): Path<(String, String, String)>,
    headers: HeaderMap,
) -> Result<Response, ApiProblem> {
    let gzip = reply::takes_gzip(&headers);
    let place = FramePlace::parse([scene, camera, frame])?;
    work(viewer, move |viewer| {
        viewer.check_camera(&place.scene, &place.camera)?;
        let known = viewer.pairs_of_scene(&place.scene)?;
        Ok(reply::json(gzip, &known.partners(&place)?))
    })
    .await
}

impl Viewer {
    /// The pairs of a scene, from memory while its files do not change.
    fn pairs_of_scene(&self, scene: &str) -> Result<Arc<PairsOfScene>, ApiProblem> {
        let layout = self.layout();
        let files = [layout.covisibility(scene), layout.covisibility_frames(scene), layout.pairs()];
        self.allow_all(&files)?;
        let stamps = files.each_ref().map(|path| stamp(path));
        let both = (stamps.iter().fold(0, |sum: u64, one| sum.wrapping_add(one.0)), stamps.iter().filter_map(|one| one.1).max());
        self.pairs.get(&scene.to_string(), both, || {
            let covisibility = self.dataset.read_covisibility(scene).map_err(problem)?;
            let mut lost = Problems::default();
            let poses = self.poses_of(scene, &covisibility, &mut lost);
            let listed = lost.or_nothing("pairs", self.listed(scene, &covisibility));
            Ok(PairsOfScene { covisibility, poses, listed, lost })
        })
    }

    /// The poses of the matrix's frames.
    fn poses_of(&self, scene: &str, covisibility: &Covisibility, lost: &mut Problems) -> Vec<Option<Pose>> {
        let cameras: BTreeSet<&str> = covisibility.frames.iter().map(|one| one.camera.as_str()).collect();
        let mut known: HashMap<(&str, u32), Pose> = HashMap::new();
        for camera in cameras {
            let poses = lost.or_nothing("pairs", self.poses(scene, camera));
            known.extend(poses.into_iter().map(|pose| ((camera, pose.frame), pose)));
        }
        covisibility.frames.iter().map(|one| known.get(&(one.camera.as_str(), one.frame)).copied()).collect()
    }

    fn poses(&self, scene: &str, camera: &str) -> Result<Vec<Pose>, ApiProblem> {
        check_name("camera name", camera).map_err(problem)?;
        self.allow(&self.layout().camera_dir(scene, camera))?;
        self.allow_all(self.keyframes(scene, camera))?;
        Ok(self.dataset.read_trajectory(scene, camera).map_err(problem)?.poses)
    }

    /// The pairs of a scene that the dataset's list has, as places in the matrix, the smaller first; `None` without a list.
    fn listed(&self, scene: &str, covisibility: &Covisibility) -> Result<Option<HashSet<[usize; 2]>>, ApiProblem> {
        let path = self.layout().pairs();
        if !path.is_file() {
            return Ok(None);
        }
        let frames = covisibility.frames.iter().enumerate();
        let places: HashMap<(&str, u32), usize> = frames.map(|(at, one)| ((one.camera.as_str(), one.frame), at)).collect();
        let pairs = read_pairs(&path).map_err(problem)?;
        let place = |(camera, frame): &(String, u32)| places.get(&(camera.as_str(), *frame)).copied();
        let of_scene = pairs.iter().filter(|pair| pair.scene == scene);
        let both = of_scene.filter_map(|pair| Some([place(&pair.first)?, place(&pair.second)?]));
        Ok(Some(both.map(|[a, b]| [a.min(b), a.max(b)]).collect()))
    }
}
