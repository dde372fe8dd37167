//! Previews of a dataset in another folder, straight from the frames, as for data of others; in the dataset they are a stage.

use crate::args::RunArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_show::drivers::{expose_camera, preview_boxes, preview_camera, write_contact_sheet, write_overview};
use enfilade_show::sheet::SheetConfig;
use std::collections::BTreeSet;
use std::path::Path;

/// Writes pictures of every layer below `folder`, in the tree of the dataset that `run` was given.
pub fn elsewhere(args: &RunArgs, folder: &Path, quiet: bool) -> Result<Verdict, Problem> {
    let Some(from) = &args.from else {
        return Err(Problem::new("no dataset is named", "give its folder: enfilade run DATASET --only preview -o FOLDER"));
    };
    let dataset = args.table.open(from)?.with_pictures_in(folder);
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scenes.as_deref())?;
    let progress = Progress::new(quiet);
    let cx = progress.begin(&from.display().to_string(), "preview");
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
    let name = from.file_name().map_or_else(|| "dataset".into(), |name| name.to_string_lossy().into_owned());
    let overview = write_overview(&dataset, &scenes, &name, &SheetConfig::default())?;
    drop(cx);
    drop(progress);
    say(&format!("{pictures} pictures below {}", folder.display()));
    say(&format!("see  {}", overview.display()));
    Ok(Verdict::Done)
}
