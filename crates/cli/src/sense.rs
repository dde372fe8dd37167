//! `sense`: from arguments to a call of the crate `sensors`, and what came of it.

use crate::args::SenseArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::{chosen_frames, nothing_chosen};
use crate::progress::Progress;
use enfilade_dataset::counted;
use enfilade_pipeline::read_sensors;
use enfilade_sensors::sense as show;

/// `sense`: what sensors would make of the frames.
pub fn sense(args: &SenseArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let sensors = read_sensors(&args.sensors)?;
    let chosen = chosen_frames(&dataset, &args.chosen)?;
    let frames = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "sense");
        show(&dataset, &sensors, &chosen, &cx)?
    };
    if frames == 0 {
        return Err(nothing_chosen());
    }
    for sensor in sensors.all() {
        say(&format!("{}: {}", sensor.name(), counted(frames, "frame")));
    }
    say(&format!("see  {}", dataset.layout().sensors_dir().display()));
    Ok(Verdict::Done)
}
