//! `make words`: what the things of scenes are, how they stand to each other, and that in words.

use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{Dataset, counted};
use enfilade_describe::describe;
use enfilade_scene::Cx;

/// Writes relations, captions and questions of the chosen scenes.
pub fn words(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    let mut any = false;
    for scene in &scenes {
        let found = describe(dataset, scene, cx)?;
        any |= found.is_some();
        lines.push(found.map_or_else(
            || format!("{scene}: nothing is labelled as an instance"),
            |found| {
                let [things, relations] = [(found.instances, "instance"), (found.relations, "relation")].map(|(n, word)| counted(n, word));
                let [captions, questions] = [(found.captions, "caption"), (found.questions, "question")].map(|(n, word)| counted(n, word));
                format!("{scene}: {things}, {relations}, {captions}, {questions}")
            },
        ));
    }
    if !any {
        let problem = format!("no scene of {} that was chosen has labelled instances", args.dataset.display());
        return Err(Problem::of_data(problem, "label its parts: `enfilade suggest` proposes a table, `enfilade annotate` opens a scene"));
    }
    lines.push(
        "see  metadata_instances.csv, metadata_instance_relations.csv, CAMERA/captions.jsonl and CAMERA/questions.jsonl in _detail of each scene"
            .into(),
    );
    Ok(())
}
