//! `describe`: from arguments to calls of the crate of that name, and what came of them.

use crate::args::DescribeArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::counted;

/// `describe`: what the things of scenes are, how they stand to each other, and that in words.
pub fn describe(args: &DescribeArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?;
    let (mut lines, mut any) = (Vec::new(), false);
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "describe");
        for scene in &scenes {
            let found = enfilade_describe::describe(&dataset, scene, &cx)?;
            any |= found.is_some();
            lines.push(found.map_or_else(
                || format!("{scene}: nothing is labelled as an instance"),
                |found| {
                    let [things, relations] =
                        [(found.instances, "instance"), (found.relations, "relation")].map(|(n, word)| counted(n, word));
                    let [captions, questions] =
                        [(found.captions, "caption"), (found.questions, "question")].map(|(n, word)| counted(n, word));
                    format!("{scene}: {things}, {relations}, {captions}, {questions}")
                },
            ));
        }
    }
    lines.iter().for_each(|line| say(line));
    if !any {
        let problem = format!("no scene of {} that was chosen has labelled instances", args.dataset.display());
        return Err(Problem::of_data(problem, "label its parts: `enfilade suggest` proposes a table, `enfilade annotate` opens a scene"));
    }
    say(
        "see  metadata_instances.csv, metadata_instance_relations.csv, CAMERA/captions.jsonl and CAMERA/questions.jsonl in _detail of each scene",
    );
    Ok(Verdict::Done)
}
