//! From a scene's files to what is said of it.

use crate::captions::{Scope, caption};
use crate::questions::{Asker, of_frame, of_video};
use crate::relations::relations;
use crate::seen::{self, SeenFrame};
use crate::things::Things;
use enfilade_dataset::{Dataset, DatasetError};
use enfilade_math::DVec3;
use enfilade_scene::Cx;

/// How much was found and said.
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

/// Describes a scene and the finished frames of its cameras, all of them, and writes that into the dataset. `None` where nothing is labelled
/// as an instance.
///
/// # Errors
/// When a file of the scene or a layer of a frame is missing or damaged, or a file cannot be written.
pub fn describe(dataset: &Dataset, scene: &str, cx: &dyn Cx) -> Result<Option<Described>, DatasetError> {
    let Some(things) = Things::read(dataset, scene)? else { return Ok(None) };
    let mut filmed: Vec<(String, Vec<SeenFrame>, Vec<DVec3>)> = Vec::new();
    for camera in dataset.cameras(scene)? {
        let frames = dataset.whole_frames([scene, &camera], None, cx)?;
        if frames.is_empty() {
            continue;
        }
        let poses = dataset.read_trajectory(scene, &camera)?.poses;
        let eye = |number: &u32| poses.iter().find(|pose| pose.frame == *number).map(|pose| pose.position);
        let (frames, eyes): (Vec<u32>, Vec<DVec3>) = frames.iter().filter_map(|number| Some((*number, eye(number)?))).unzip();
        filmed.push((camera.clone(), seen::look(dataset, [scene, &camera], &frames, cx)?, eyes));
    }
    let mut described = things.described.clone();
    for thing in &mut described {
        let sights = filmed.iter().flat_map(|(_, seen, _)| seen).filter_map(|frame| frame.sights.get(&thing.instance));
        thing.color = seen::color(sights).unwrap_or_default().into();
    }
    let relations = relations(&things.bodies, |instance| things.place(instance).and_then(|place| described[place].front));
    dataset.write_described_instances(scene, &described)?;
    dataset.write_instance_relations(scene, &relations)?;
    let mut total = Described { instances: described.len(), relations: relations.len(), ..Described::default() };
    for (camera, seen, eyes) in &filmed {
        let names = [scene, camera];
        let scopes = || seen.iter().map(|seen| Scope { things: &things, described: &described, relations: &relations, seen });
        let captions: Vec<_> = scopes().zip(eyes).map(|(scope, eye)| caption(&scope, names, *eye)).collect();
        let mut asker = Asker::new(names);
        of_video(&mut asker, &things, &described, seen, eyes);
        scopes().for_each(|scope| of_frame(&mut asker, &scope));
        dataset.write_words(names, &captions, &asker.asked)?;
        total.captions += captions.len();
        total.questions += asker.asked.len();
    }
    Ok(Some(total))
}
