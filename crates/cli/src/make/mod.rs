//! `make`: what can be made of finished frames without rendering, a noun for each.

mod frames;

pub use frames::cameras;

use crate::args::MakeArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::Dataset;
use enfilade_pipeline::{FrameChoice, Made, MakeOptions, Product, ProductOptions, make_products, make_stale};

/// `make`: each noun once, in an order in which the inputs of each exist; with `--stale` everything that is out of date.
pub fn make(args: &MakeArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    if args.stale {
        return stale(args, &dataset, &scenes, quiet);
    }
    let of = FrameChoice { cameras: cameras(&dataset, &scenes, args.chosen.camera.as_deref())?, frames: args.chosen.frames.clone() };
    let (options, how) = (args.options.0.options()?, MakeOptions { force: args.force });
    let mut nouns = args.what.clone();
    nouns.sort();
    nouns.dedup();
    for what in nouns {
        let made = {
            let progress = Progress::new(quiet);
            let cx = progress.begin(&args.dataset.display().to_string(), what.name());
            make_products(&dataset, &scenes, &[what], (&options, &of), how, &cx)?
        };
        print(&made, what.name());
        say(&format!("see  {}", place(what, &options, &dataset)));
    }
    Ok(Verdict::Done)
}

/// Makes again what is out of date.
fn stale(args: &MakeArgs, dataset: &Dataset, scenes: &[String], quiet: bool) -> Result<Verdict, Problem> {
    let made = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "make");
        make_stale(dataset, scenes, &args.what, &cx)?
    };
    if made.is_empty() {
        say("nothing is out of date");
    } else {
        print(&made, "dataset");
    }
    Ok(Verdict::Done)
}

/// Prints what was made, or that there was nothing to do.
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

/// The place of the product, as it is printed.
fn place(product: Product, options: &ProductOptions, dataset: &Dataset) -> String {
    let layout = dataset.layout();
    match product {
        Product::Pairs => options.pairs.clone().unwrap_or_else(|| layout.pairs()).display().to_string(),
        Product::Flow => "_detail/CAMERA/pairs of each scene".into(),
        Product::Tracks => "_detail/CAMERA/tracks.npz of each scene".into(),
        Product::Surfaces => "_detail/CAMERA/surfaces of each scene".into(),
        Product::Rooms => "layout.json, layout.svg and metadata_planes.csv in _detail of each scene, and CAMERA/planes in it".into(),
        Product::Words => {
            "metadata_instances.csv, metadata_instance_relations.csv, CAMERA/captions.jsonl and CAMERA/questions.jsonl in _detail of each scene"
                .into()
        }
        Product::Sensors => layout.sensors_dir().display().to_string(),
        Product::Relit => layout.relit_dir().display().to_string(),
        Product::Covisibility | Product::Sheet | Product::Statistics => dataset.root().display().to_string(),
    }
}
