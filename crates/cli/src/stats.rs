//! `stats`: from arguments to a call of `show`'s statistics, and its output.

use crate::args::StatsArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::price::{paid, prices};
use crate::progress::Progress;
use enfilade_dataset::DatasetError;
use enfilade_pipeline::{Error, write_statistics};
use enfilade_show::stats::StatsConfig;

/// `stats`: what the images show and what they cost.
pub fn stats(args: &StatsArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let all = dataset.scenes()?;
    let scenes = enfilade_pipeline::select("scene", &all, args.scene.as_deref())?;
    if args.output.is_none() && scenes.len() < all.len() {
        let message = format!("the dataset's statistics are of all its scenes, and {} of {} were chosen", scenes.len(), all.len());
        return Err(Problem::new(message, "name a folder for statistics of some scenes with -o"));
    }
    let config = StatsConfig { scenes, folder: args.output.clone(), compare: args.compare.clone(), prices: prices(args.price.as_deref())? };
    let written = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "stats");
        write_statistics(&dataset, &config, &cx).map_err(problem)?
    };
    say(&format!("{} images, {} outliers", written.images, written.outliers));
    if let Some(cost) = written.cost {
        let prices = config.prices.iter().map(|price| paid(price, cost.vcpu_hours));
        say(&format!("{:.3} vCPU-hours: {}", cost.vcpu_hours, prices.collect::<Vec<_>>().join("; ")));
    }
    say(&format!("see  {}", written.page.display()));
    Ok(Verdict::Done)
}

/// The problem to report when a dataset cannot be read, or compared with.
fn problem(error: Error) -> Problem {
    match error {
        Error::Stage(inner) => match inner.downcast::<DatasetError>() {
            Ok(error) => (*error).into(),
            Err(inner) => Error::Stage(inner).into(),
        },
        other => other.into(),
    }
}
