//! `make`: what can be made of finished frames without rendering, a noun for each.

mod frames;

pub use frames::cameras;

use crate::args::{MakeArgs, What};
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::Dataset;
use enfilade_pipeline::{FrameChoice, Made, MakeOptions, Product, ProductOptions, make_products, make_stale};

/// `make`: each noun once, in an order in which what one needs of another is there; with `--stale` what is out of date.
pub fn make(args: &MakeArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    if args.stale {
        return stale(args, &dataset, &scenes, quiet);
    }
    let of = FrameChoice { cameras: cameras(&dataset, &scenes, args.chosen.camera.as_deref())?, frames: args.chosen.frames.clone() };
    let (options, how) = (options(args), MakeOptions { force: args.force });
    let mut nouns = args.what.clone();
    nouns.sort();
    nouns.dedup();
    for what in nouns {
        let made = {
            let progress = Progress::new(quiet);
            let cx = progress.begin(&args.dataset.display().to_string(), what.name());
            make_products(&dataset, &scenes, &[what.product()], (&options, &of), how, &cx)?
        };
        print(&made, what.name());
        say(&format!("see  {}", place(what, args, &dataset)));
    }
    Ok(Verdict::Done)
}

/// Makes again what is out of date.
fn stale(args: &MakeArgs, dataset: &Dataset, scenes: &[String], quiet: bool) -> Result<Verdict, Problem> {
    let only: Vec<Product> = args.what.iter().map(|what| what.product()).collect();
    let made = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "make");
        make_stale(dataset, scenes, &only, &cx)?
    };
    if made.is_empty() {
        say("nothing is out of date");
    } else {
        print(&made, "dataset");
    }
    Ok(Verdict::Done)
}

/// Says what was made, or that nothing was to be done.
fn print(made: &[Made], name: &str) {
    for made in made {
        made.lines.iter().for_each(|line| say(line));
        if made.made > 0 && made.kept > 0 {
            say(&format!("{}: {} more were up to date", made.scene.as_deref().unwrap_or(name), made.kept));
        }
    }
    if made.iter().all(|made| made.made == 0) {
        say(&format!("{name}: nothing to do, all is up to date"));
    }
}

fn options(args: &MakeArgs) -> ProductOptions {
    let between = args.flow.between.as_ref().and_then(|frames| <[(String, u32); 2]>::try_from(frames.clone()).ok());
    ProductOptions {
        pixels: args.pairs.pixels,
        overlap: args.pairs.overlap,
        baseline_m: args.pairs.baseline,
        angle_deg: args.pairs.angle,
        list: args.list.pairs.clone(),
        step: args.flow.step,
        between,
        points: args.tracks.points,
        seed: args.tracks.seed,
        layers: args.surfaces.layers,
        sensors: args.sensors.sensors.clone(),
        mixes: args.relit.mixes.clone(),
    }
}

/// Where what was made lies.
fn place(what: What, args: &MakeArgs, dataset: &Dataset) -> String {
    let layout = dataset.layout();
    match what {
        What::Pairs => args.list.pairs.clone().unwrap_or_else(|| layout.pairs()).display().to_string(),
        What::Flow => "_detail/CAMERA/pairs of each scene".into(),
        What::Tracks => "_detail/CAMERA/tracks.npz of each scene".into(),
        What::Surfaces => "_detail/CAMERA/surfaces of each scene".into(),
        What::Rooms => "layout.json, layout.svg and metadata_planes.csv in _detail of each scene, and CAMERA/planes in it".into(),
        What::Words => {
            "metadata_instances.csv, metadata_instance_relations.csv, CAMERA/captions.jsonl and CAMERA/questions.jsonl in _detail of each scene"
                .into()
        }
        What::Sensors => layout.sensors_dir().display().to_string(),
        What::Relit => layout.relit_dir().display().to_string(),
    }
}
