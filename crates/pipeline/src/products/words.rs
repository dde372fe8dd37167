//! Descriptions and relations of the things of a scene, with captions and questions about them: one part for the scene.

use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::Request;
use crate::workdir::Hash;
use enfilade_dataset::counted;
use enfilade_scene::{Cx, Quiet};
use std::path::PathBuf;

pub(super) fn parts(subject: &Subject, _request: &Request) -> Result<Vec<Part>, Error> {
    Ok(vec![Part { name: String::new(), frames: subject.chosen(|_, _| true)?, settings: Hash::of(&()) }])
}

pub(super) fn make(subject: &Subject, _asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let scene = subject.scene;
    let Some(found) = enfilade_describe::describe(subject.dataset, scene, cx).map_err(Error::stage)? else {
        return Ok(vec![format!("{scene}: nothing is labelled as an instance")]);
    };
    let [things, relations] = [(found.instances, "instance"), (found.relations, "relation")].map(|(n, word)| counted(n, word));
    let [captions, questions] = [(found.captions, "caption"), (found.questions, "question")].map(|(n, word)| counted(n, word));
    Ok(vec![format!("{scene}: {things}, {relations}, {captions}, {questions}")])
}

pub(super) fn files(subject: &Subject, _part: &Part) -> Result<Vec<PathBuf>, Error> {
    let (layout, scene) = (subject.dataset.layout(), subject.scene);
    let mut paths = vec![layout.described_instances(scene), layout.instance_relations(scene)];
    for (camera, _) in subject.frames(&Quiet)? {
        paths.extend([layout.captions(scene, camera), layout.questions(scene, camera)]);
    }
    paths.retain(|path| path.is_file());
    Ok(paths)
}

/// Refuses scenes none of which has labelled instances.
pub(super) fn refuse_none(subjects: &[Subject]) -> Result<(), Error> {
    let has_words = |subject: &Subject| subject.dataset.layout().described_instances(subject.scene).is_file();
    let Some(first) = subjects.first().filter(|_| !subjects.iter().any(has_words)) else { return Ok(()) };
    Err(Error::scene(
        format!("no scene of {} that was chosen has labelled instances", first.dataset.root().display()),
        "label its parts: `enfilade suggest` proposes a table, `enfilade annotate` opens a scene",
    ))
}
