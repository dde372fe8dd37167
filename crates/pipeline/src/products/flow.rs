//! Flow from frames of a scene to others of it: a part for each pair of frames, in the direction of the flow.

use super::record::{Asked, Part};
use super::sources::Subject;
use crate::error::Error;
use crate::request::{FlowPairs, Request};
use crate::workdir::Hash;
use enfilade_dataset::{FramePair, counted, read_pairs};
use enfilade_frame::Layer;
use enfilade_multiview::{Filmed, ScenePackage, write_flow};
use enfilade_scene::{Cx, Quiet};
use std::path::PathBuf;

/// A frame by camera and number.
type FrameName = (String, u32);

/// The layers of a pair.
const LAYERS: [Layer; 3] = [Layer::OpticalFlow, Layer::SceneFlow, Layer::FlowVisibility];

pub(super) fn parts(subject: &Subject, request: &Request) -> Result<Vec<Part>, Error> {
    let Request::Flow { pairs, cameras } = request else { return Ok(Vec::new()) };
    let filmed = Filmed::read(subject.dataset, subject.scene, cameras.as_deref(), &Quiet).map_err(Error::stage)?;
    let part = |[first, second]: [usize; 2]| {
        let FramePair { first, second, .. } = filmed.pair([first, second]);
        Part { name: format!("{}/{} {}/{}", first.0, first.1, second.0, second.1), frames: vec![first, second], settings: Hash::of(&()) }
    };
    Ok(chosen(subject, &filmed, pairs)?.into_iter().map(part).collect())
}

/// The requested pairs of a scene, of existing frames.
fn chosen(subject: &Subject, filmed: &Filmed, pairs: &FlowPairs) -> Result<Vec<[usize; 2]>, Error> {
    let find = |of: &FrameName| filmed.find(&of.0, of.1);
    let found = |pair: &FramePair| Some([find(&pair.first)?, find(&pair.second)?]);
    Ok(match pairs {
        FlowPairs::Step(step) => filmed.steps(*step),
        FlowPairs::Between(pairs) => pairs.iter().filter(|pair| pair.scene == subject.scene).filter_map(found).collect(),
        FlowPairs::Listed => {
            let list = subject.dataset.layout().pairs();
            let listed = if list.is_file() { read_pairs(&list).map_err(Error::stage)? } else { Vec::new() };
            let there = listed.iter().filter(|pair| pair.scene == subject.scene).filter_map(found);
            there.flat_map(|[first, second]| [[first, second], [second, first]]).collect()
        }
    })
}

/// Refuses pairs of frames that are not there.
pub(super) fn check(subjects: &[Subject], request: &Request) -> Result<(), Error> {
    let Request::Flow { pairs: FlowPairs::Between(pairs), cameras } = request else { return Ok(()) };
    for subject in subjects {
        let filmed = Filmed::read(subject.dataset, subject.scene, cameras.as_deref(), &Quiet).map_err(Error::stage)?;
        let own = pairs.iter().filter(|pair| pair.scene == subject.scene).flat_map(|pair| [&pair.first, &pair.second]);
        if let Some((camera, number)) = own.into_iter().find(|(camera, number)| filmed.find(camera, *number).is_none()) {
            let message = format!("{} has no finished frame {camera}/{number} among those chosen", subject.scene);
            return Err(Error::usage(message, "`enfilade make OUT pairs` writes pairs.csv, a list of pairs of existing frames"));
        }
    }
    Ok(())
}

pub(super) fn make(subject: &Subject, asked: &[Asked], cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let filmed = Filmed::read(subject.dataset, subject.scene, None, cx).map_err(Error::stage)?;
    let package = package(subject, &filmed, cx)?;
    let find = |(camera, number): &FrameName| filmed.find(camera, *number);
    let pairs = asked.iter().filter_map(|asked| Some([find(&asked.part.frames[0])?, find(&asked.part.frames[1])?]));
    let pairs: Vec<[usize; 2]> = pairs.collect();
    write_flow(&filmed, &package, &pairs, cx).map_err(Error::stage)?;
    Ok(vec![format!("{}: flow of {}", subject.scene, counted(pairs.len(), "pair"))])
}

pub(super) fn files(subject: &Subject, part: &Part) -> Result<Vec<PathBuf>, Error> {
    let pair = FramePair { scene: subject.scene.into(), first: part.frames[0].clone(), second: part.frames[1].clone() };
    let paths = LAYERS.map(|layer| subject.dataset.layout().pair_layer(&pair, layer));
    Ok(paths.into_iter().filter(|path| path.is_file()).collect())
}

/// The scene that was filmed, for what cannot do without.
///
/// # Errors
/// If it does not exist, or is not the one that the frames were rendered from.
pub(super) fn package(subject: &Subject, filmed: &Filmed<'_>, cx: &dyn Cx) -> Result<ScenePackage, Error> {
    ScenePackage::read(filmed, cx).map_err(Error::stage)?.ok_or_else(|| {
        let path = subject.dataset.layout().scene_package(subject.scene);
        let message = format!("{} is missing, or is not the scene that {} was rendered from", path.display(), subject.scene);
        Error::scene(message, "rays need it: use the dataset where `enfilade run` made it, and run it again where it is out of date")
    })
}
