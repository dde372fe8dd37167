//! `animate`: from arguments to calls of the crate `animate`, and their output.

use crate::args::AnimateArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_animate::{AnimateConfig, Animated, Film, NoFrames, animate_camera};

/// `animate`: films of the frames of each camera.
pub fn animate(args: &AnimateArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?;
    let chosen = enfilade_pipeline::select("camera", &dataset.camera_names(&scenes)?, args.camera.as_deref())?;
    let folder = args.output.clone().unwrap_or_else(|| dataset.layout().animations_dir());
    let layers = distinct(&args.layers);
    let config = AnimateConfig { format: args.format.into(), fps: args.fps };
    let (mut written, mut missing): (Vec<Animated>, Vec<NoFrames>) = (Vec::new(), Vec::new());
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "animate");
        for scene in &scenes {
            for camera in dataset.cameras(scene)?.iter().filter(|camera| chosen.contains(camera)) {
                let films = animate_camera(&dataset, [scene, camera], &layers, config, &folder, &cx);
                for film in films.map_err(|error| Problem::found(&error))? {
                    match film {
                        Ok(film) => written.push(film),
                        Err(none) => missing.push(none),
                    }
                }
            }
        }
    }
    for film in &written {
        let (name, megabytes) = (film.path.display(), film.bytes as f64 / 1e6);
        say(&format!("{name}: {} frames at {:.4} per second, {megabytes:.1} MB", film.frames, film.fps));
    }
    match missing.first() {
        Some(none) if written.is_empty() => return Err(Problem::found(none)),
        None if written.is_empty() => {
            let problem = format!("no camera that was chosen has frames in {}", args.dataset.display());
            return Err(Problem::of_data(problem, "make them with `enfilade run`, which also reports what failed"));
        }
        _ => missing.iter().for_each(|none| say(&format!("warning: {none}"))),
    }
    Ok(Verdict::Done)
}

/// Each film once, in their order: two of one name would be written to one file at the same time.
fn distinct(named: &[Film]) -> Vec<Film> {
    let mut films: Vec<Film> = Vec::new();
    for &film in named {
        if !films.contains(&film) {
            films.push(film);
        }
    }
    films
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_that_is_named_twice_is_made_once() {
        let films = ["depth_meters", "color", "depth_meters", "gamma", "color"].map(|name| Film::from_name(name).unwrap());
        let names: Vec<&str> = distinct(&films).iter().map(|film| film.name).collect();
        assert_eq!(names, ["depth_meters", "color", "gamma"]);
    }
}
