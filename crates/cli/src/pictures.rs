//! `preview`: a stage for datasets of ours; straight from the frames where another folder is named, as for data of others.

use crate::args::PreviewArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use crate::verbs;
use enfilade_pipeline::Stage;
use enfilade_show::drivers::{expose_camera, preview_boxes, preview_camera, write_contact_sheet, write_overview};
use enfilade_show::sheet::SheetConfig;
use std::collections::BTreeSet;

/// `preview`: pictures of every layer.
pub fn preview(args: &PreviewArgs, quiet: bool) -> Result<Verdict, Problem> {
    let Some(folder) = &args.output else {
        if args.table.cameras_csv.is_some() {
            let problem = "--cameras-csv is for previews that are written elsewhere; a dataset of ours has its own cameras";
            return Err(Problem::new(problem, "leave it out, or name a folder with -o"));
        }
        return verbs::stage(&args.stage, Stage::Preview, quiet);
    };
    let dataset = args.table.open(&args.stage.dataset)?.with_pictures_in(folder);
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.stage.scene.as_deref())?;
    let progress = Progress::new(quiet);
    let cx = progress.begin(&args.stage.dataset.display().to_string(), "preview");
    let mut pictures = 0;
    for scene in &scenes {
        for camera in dataset.cameras(scene)? {
            let frames = dataset.whole_frames([scene, &camera], None, &cx)?;
            let (exposures, _) = expose_camera(&dataset, scene, &camera, &frames)?;
            pictures += preview_camera(&dataset, [scene, &camera], &frames, &exposures, &BTreeSet::new(), &cx)?.len();
            pictures += preview_boxes(&dataset, scene, &camera, &frames, &cx)?.len();
            let sheet = write_contact_sheet(&dataset, [scene, &camera], &frames, exposures.display, &SheetConfig::default())?;
            pictures += usize::from(sheet.is_some());
        }
    }
    let name = args.stage.dataset.file_name().map_or_else(|| "dataset".into(), |name| name.to_string_lossy().into_owned());
    let overview = write_overview(&dataset, &scenes, &name, &SheetConfig::default())?;
    drop(cx);
    drop(progress);
    say(&format!("{pictures} pictures below {}", folder.display()));
    say(&format!("see  {}", overview.display()));
    Ok(Verdict::Done)
}
