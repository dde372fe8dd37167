//! From a scene's files to its descriptions.

use crate::captions::{Scope, caption};
use crate::questions::{Asker, of_frame, of_video};
use crate::relations::relations;
use crate::seen::{self, SeenFrame};
use crate::things::Things;
use enfilade_dataset::{Caption, Dataset, DatasetError, remove_if_there};
use enfilade_math::DVec3;
use enfilade_scene::Cx;
use std::collections::BTreeMap;

/// Numbers of what was found and written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Described {
    /// Instances.
    pub instances: usize,
    /// Relations between them, and to walls, floors and ceilings.
    pub relations: usize,
    /// Frames with a caption.
    pub captions: usize,
    /// Questions.
    pub questions: usize,
}

/// Describes a scene and the finished frames of its cameras, all of them, and writes that into the dataset, replacing earlier descriptions.
/// `None` where nothing is labelled as an instance.
///
/// # Errors
/// When a file of the scene or a layer of a frame is damaged, the mesh is missing, or a file cannot be written.
pub fn describe(dataset: &Dataset, scene: &str, cx: &dyn Cx) -> Result<Option<Described>, DatasetError> {
    remove_words(dataset, scene)?;
    let Some(things) = Things::read(dataset, scene)? else { return Ok(None) };
    let mut filmed: Vec<(String, Vec<(SeenFrame, DVec3)>)> = Vec::new();
    for camera in dataset.cameras(scene)? {
        let poses = dataset.read_trajectory(scene, &camera)?.poses;
        let eyes: BTreeMap<u32, DVec3> = poses.iter().map(|pose| (pose.frame, pose.position)).collect();
        let mut frames = dataset.whole_frames([scene, &camera], None, cx)?;
        frames.retain(|number| eyes.contains_key(number));
        let seen = seen::look(dataset, [scene, &camera], &frames, cx)?;
        let with_eye = |seen: SeenFrame| {
            let eye = eyes[&seen.frame];
            (seen, eye)
        };
        filmed.push((camera, seen.into_iter().map(with_eye).collect()));
    }
    let mut described = things.described.clone();
    for thing in &mut described {
        let sights = filmed.iter().flat_map(|(_, seen)| seen).filter_map(|(frame, _)| frame.sights.get(&thing.instance));
        thing.color = seen::color(sights).unwrap_or_default().into();
    }
    let relations = relations(&things.bodies, |instance| things.place(instance).and_then(|place| described[place].front));
    dataset.write_described_instances(scene, &described)?;
    dataset.write_instance_relations(scene, &relations)?;
    let mut total = Described { instances: described.len(), relations: relations.len(), ..Described::default() };
    for (camera, seen) in filmed.iter().filter(|(_, seen)| !seen.is_empty()) {
        let names = [scene, camera];
        let scope = |seen| Scope::new(&things, &described, &relations, seen);
        let captions: Vec<Caption> = enfilade_parallel::map(seen, |(seen, eye)| caption(&scope(seen), names, *eye));
        let mut asker = Asker::new(names);
        let (frames, eyes): (Vec<&SeenFrame>, Vec<DVec3>) = seen.iter().map(|(seen, eye)| (seen, *eye)).unzip();
        of_video(&mut asker, &things, &described, &frames, &eyes);
        frames.into_iter().for_each(|seen| of_frame(&mut asker, &scope(seen)));
        dataset.write_words(names, &captions, &asker.asked)?;
        total.captions += captions.len();
        total.questions += asker.asked.len();
    }
    Ok(Some(total))
}

/// Removes earlier descriptions, since those of cameras that no longer have frames would not be overwritten.
fn remove_words(dataset: &Dataset, scene: &str) -> Result<(), DatasetError> {
    let layout = dataset.layout();
    let mut files = vec![layout.described_instances(scene), layout.instance_relations(scene)];
    files.extend(dataset.cameras_by_files(scene)?.iter().flat_map(|name| [layout.captions(scene, name), layout.questions(scene, name)]));
    files.iter().try_for_each(|path| remove_if_there(path))
}
