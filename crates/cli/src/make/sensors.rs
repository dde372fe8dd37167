//! `make sensors`: what cameras and depth sensors would make of the frames.

use super::frames::{chosen_frames, nothing_chosen};
use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{Dataset, counted};
use enfilade_pipeline::read_sensors;
use enfilade_scene::Cx;
use enfilade_sensors::sense;

/// Shows the chosen frames to the sensors of a file.
pub fn sensors(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let file = args.sensors.sensors.as_ref().ok_or_else(|| Problem::new("no sensors are named", "give --sensors examples/sensors.toml"))?;
    let sensors = read_sensors(file)?;
    let frames = sense(dataset, &sensors, &chosen_frames(dataset, &args.chosen)?, cx)?;
    if frames == 0 {
        return Err(nothing_chosen());
    }
    lines.extend(sensors.all().map(|sensor| format!("{}: {}", sensor.name(), counted(frames, "frame"))));
    lines.push(format!("see  {}", dataset.layout().sensors_dir().display()));
    Ok(())
}
