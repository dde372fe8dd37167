//! Statistics of a dataset: the contents of its images and their cost, as numbers, charts and one page for a browser.
//!
//! [`write_statistics`] counts every frame by the layers that it has, in Hypersim's bins, and draws the counts, over those of another
//! dataset if one is named. Results that differ between two runs (times, costs) are in `costs.json` and other separate files; all else is
//! the same for the same dataset.
//!
//! ```text
//! statistics/statistics.json              dataset, scenes, images, outliers
//! statistics/statistics.html              the page
//! statistics/image_statistics/*.hdf5      counts of all images, as Hypersim's toolkit stores them
//! statistics/plots/*.{png,svg}            the charts
//! statistics/costs.json, metadata_rendering_{jobs,tasks}.csv     if costs are requested
//! ```

mod canvas;
mod chart;
mod cost_tables;
mod costs;
mod gather;
mod histogram;
mod html;
mod maps;
mod measure;
mod outlier;
mod plots;
mod report;
mod toolkit;

pub use costs::{Cost, CostReport};

use crate::drawing::{paint, themed_svg};
use crate::picture::png;
use costs::is_costs;
use enfilade_dataset::{Dataset, DatasetError, Price, write_bytes, write_json};
use enfilade_frame::Pass;
use enfilade_scene::Cx;
use html::{Shown, statistics_page};
use outlier::Outlier;
use plots::{Plot, Reference, cost_plots, plots};
use report::{Report, cost_outliers, is_report};
use std::path::{Path, PathBuf};

/// Files of costs, which are removed if costs are not requested.
const COST_FILES: [&str; 3] = ["costs.json", cost_tables::JOBS, cost_tables::TASKS];

/// Extensions of the files of a chart, as [`write_plot`] writes them.
const EXTENSIONS: [&str; 2] = ["png", "svg"];

/// The requested statistics.
#[derive(Clone, Debug, Default)]
pub struct StatsConfig {
    /// Scenes to count; the files have the same order.
    pub scenes: Vec<String>,
    /// Folder to write instead of the dataset's own.
    pub folder: Option<PathBuf>,
    /// A folder of histograms to draw ours over: Hypersim's image statistics, or the statistics of another dataset.
    pub compare: Option<PathBuf>,
    /// Prices; costs are left out if this is empty.
    pub prices: Vec<Price>,
}

/// The written files, and a summary.
#[derive(Clone, Debug)]
pub struct StatsSummary {
    /// The page.
    pub page: PathBuf,
    /// All files.
    pub files: Vec<PathBuf>,
    /// Images counted.
    pub images: u64,
    /// Number of images that are outliers in some respect.
    pub outliers: usize,
    /// The cost of all frames, if costs are requested and times are known.
    pub cost: Option<Cost>,
}

/// Writes the statistics of a dataset; older ones in the folder are replaced, and files of others there are left alone.
///
/// # Errors
/// When a file cannot be read or written, or there is nothing to compare with.
pub fn write_statistics(dataset: &Dataset, config: &StatsConfig, cx: &dyn Cx) -> Result<StatsSummary, DatasetError> {
    let folder = config.folder.clone().unwrap_or_else(|| dataset.layout().statistics_dir());
    let reference = config.compare.as_deref().map(read_reference).transpose()?;
    let gathered = gather::gather(dataset, &config.scenes, cx)?;
    remove_older(&folder, config.folder.is_none())?;
    let costs = if config.prices.is_empty() { None } else { cost_tables::costs(dataset, &gathered.images, &config.prices)? };
    let mut files = toolkit::write_histograms(&folder.join(toolkit::FOLDER), &gathered.all)?;
    let shown = plots(&gathered.all, reference.as_ref());
    let report = Report::new(gathered);
    let mut outliers = report.outliers.clone();
    let mut cost_shown = Vec::new();
    if let Some(costs) = &costs {
        outliers.extend(cost_outliers(costs));
        cost_shown = cost_plots(costs);
        write_json(&folder.join("costs.json"), costs)?;
        cost_tables::write_tables(&folder, costs)?;
        files.extend(COST_FILES.map(|name| folder.join(name)));
    }
    let all: Vec<_> = shown.iter().chain(&cost_shown).collect();
    files.extend(enfilade_parallel::try_map(&all, |plot| write_plot(&folder, plot))?.into_iter().flatten());
    let preview = |outlier: &Outlier| preview_from(dataset, &folder, outlier);
    let name = name_of(dataset)?;
    let page = statistics_page(&Shown {
        dataset: &name,
        report: &report,
        costs: costs.as_ref(),
        plots: &shown,
        cost_plots: &cost_shown,
        outliers: &outliers,
        preview: &preview,
        reference: reference.as_ref().map(|r| r.name.as_str()),
    });
    let path = folder.join("statistics.html");
    write_bytes(&path, page)?;
    // Last: its existence means that all files are complete.
    let numbers = folder.join("statistics.json");
    write_json(&numbers, &report)?;
    files.extend([path.clone(), numbers]);
    let cost = costs.map(|costs| costs.total);
    Ok(StatsSummary { page: path, files, images: report.dataset.images, outliers: outliers.len(), cost })
}

/// The dataset's name, or without one the name of its folder.
fn name_of(dataset: &Dataset) -> Result<String, DatasetError> {
    let manifest = dataset.read_manifest()?;
    let given = manifest.as_ref().and_then(|manifest| manifest.config["name"].as_str());
    let folder = std::path::absolute(dataset.root()).unwrap_or_else(|_| dataset.root().into());
    Ok(given.map_or_else(|| folder.file_name().unwrap_or_default().to_string_lossy().into_owned(), str::to_string))
}

fn read_reference(folder: &Path) -> Result<Reference, DatasetError> {
    let counts = toolkit::read_histograms(folder)?.ok_or_else(|| DatasetError::NotADataset {
        root: folder.into(),
        problem: "it has no metadata_*_hist_*.hdf5; name a folder of Hypersim's image statistics, or of statistics of ours".into(),
    })?;
    let is_ours = folder.join("statistics.json").is_file();
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
    let owner = absolute.parent().filter(|_| is_ours).and_then(Path::file_name);
    let name = owner.map_or("the reference".into(), |name| name.to_string_lossy().into_owned());
    Ok(Reference { name, counts })
}

/// Charts and costs of earlier statistics would be taken for these. Unless the folder `is_own`, the dataset's, files of others may have
/// their names.
fn remove_older(folder: &Path, is_own: bool) -> Result<(), DatasetError> {
    let holds = |name: &str, is_ours: fn(&[u8]) -> bool| is_own || std::fs::read(folder.join(name)).is_ok_and(|text| is_ours(&text));
    let mut older = Vec::new();
    if holds("statistics.json", is_report) {
        // First: its existence means that all files are complete.
        older.push("statistics.json".into());
        older.extend(plots::names().into_iter().flat_map(|name| EXTENSIONS.map(|extension| format!("plots/{name}.{extension}"))));
    }
    if holds("costs.json", is_costs) {
        older.extend(COST_FILES.map(String::from));
    }
    for path in older.iter().map(|name| folder.join(name)) {
        match std::fs::remove_file(&path) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
                return Err(DatasetError::Io { action: "remove", path, source });
            }
            _ => {}
        }
    }
    Ok(())
}

fn write_plot(folder: &Path, plot: &Plot) -> Result<[PathBuf; 2], DatasetError> {
    let files = EXTENSIONS.map(|extension| folder.join("plots").join(format!("{}.{extension}", plot.name)));
    write_bytes(&files[0], png(&paint(&plot.drawing), None))?;
    write_bytes(&files[1], themed_svg(&plot.drawing, &chart::DARK))?;
    Ok(files)
}

/// The tone-mapped preview of an image, relative to the page's folder if both are in one dataset.
fn preview_from(dataset: &Dataset, folder: &Path, outlier: &Outlier) -> String {
    let path = dataset.layout().preview(&outlier.scene, &outlier.camera, outlier.frame, Pass::Final, "tonemap.jpg");
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.into());
    let (root, path, folder) = (absolute(dataset.root()), absolute(&path), absolute(folder));
    let (Ok(from), Ok(to)) = (folder.strip_prefix(&root), path.strip_prefix(&root)) else { return path.display().to_string() };
    let up = from.components().map(|_| "..");
    let down = to.components().map(|part| part.as_os_str().to_string_lossy());
    up.map(Into::into).chain(down).collect::<Vec<std::borrow::Cow<'_, str>>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;
    use std::collections::BTreeMap;

    fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        let mut folders = vec![folder.to_path_buf()];
        while let Some(next) = folders.pop() {
            for entry in std::fs::read_dir(&next).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    found.insert(path.strip_prefix(folder).unwrap().to_path_buf(), std::fs::read(&path).unwrap());
                }
            }
        }
        found
    }

    #[test]
    fn every_file_of_the_page_is_there_and_the_same_on_any_number_of_threads() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let config = StatsConfig { scenes: vec!["room".into()], ..StatsConfig::default() };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| write_statistics(&dataset, &config, &Quiet).unwrap());
            files(&folder.path().join("statistics"))
        };
        let (one, four) = (on(1), on(4));
        assert!(one == four);
        let mut told = write_statistics(&dataset, &config, &Quiet).unwrap().files;
        told.sort();
        assert!(told.iter().eq(one.keys().map(|name| folder.path().join("statistics").join(name)).collect::<Vec<_>>().iter()));
        let page = String::from_utf8(one[Path::new("statistics.html")].clone()).unwrap();
        let linked: Vec<&str> = page.split(['"']).filter(|part| part.starts_with("plots/")).collect();
        assert!(linked.len() > 30 && linked.iter().all(|file| one.contains_key(Path::new(file))), "{linked:?}");
        assert!(!page.contains("<script") && !page.contains("://") && !one.contains_key(Path::new("costs.json")));
    }

    #[test]
    fn a_dataset_is_compared_with_another_and_costs_come_and_go() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(&folder.path().join("a"));
        let config = StatsConfig { scenes: vec!["room".into()], ..StatsConfig::default() };
        let first = write_statistics(&dataset, &StatsConfig { prices: vec![Price::default()], ..config.clone() }, &Quiet).unwrap();
        assert_eq!((first.images, first.cost.unwrap().frames), (2, 2));
        let other =
            StatsConfig { folder: Some(folder.path().join("b")), compare: Some(dataset.layout().statistics_dir()), ..config.clone() };
        let second = write_statistics(&dataset, &other, &Quiet).unwrap();
        assert!(std::fs::read_to_string(second.page).unwrap().contains("Over the charts: a."));
        assert!(dataset.layout().statistics_dir().join("costs.json").is_file());
        write_statistics(&dataset, &config, &Quiet).unwrap();
        assert!(!dataset.layout().statistics_dir().join("costs.json").exists());
        let nothing = StatsConfig { compare: Some(folder.path().join("a/scenes")), ..config };
        assert!(write_statistics(&dataset, &nothing, &Quiet).unwrap_err().to_string().contains("metadata_*_hist_*.hdf5"));
    }

    #[test]
    fn charts_of_earlier_statistics_are_removed_and_files_of_others_never() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(&folder.path().join("a"));
        let out = folder.path().join("own");
        for name in ["plots/mine.pdf", "costs.json"] {
            write_bytes(&out.join(name), "mine").unwrap();
        }
        let config = StatsConfig { scenes: vec!["room".into()], folder: Some(out.clone()), ..StatsConfig::default() };
        for _ in 0..2 {
            write_statistics(&dataset, &config, &Quiet).unwrap();
            assert_eq!(std::fs::read_to_string(out.join("costs.json")).unwrap(), "mine");
        }
        write_statistics(&dataset, &StatsConfig { prices: vec![Price::default()], ..config.clone() }, &Quiet).unwrap();
        let is_known = |path: &PathBuf| plots::names().iter().any(|name| path.file_stem().unwrap() == name.as_str());
        let unknown: Vec<PathBuf> = files(&out.join("plots")).into_keys().filter(|path| !is_known(path)).collect();
        assert_eq!(unknown, [PathBuf::from("mine.pdf")]);
        assert!(out.join("plots/cost_wall.svg").is_file());
        write_statistics(&dataset, &config, &Quiet).unwrap();
        assert!(!out.join("plots/cost_wall.svg").exists() && !out.join("costs.json").exists());
        assert_eq!(std::fs::read_to_string(out.join("plots/mine.pdf")).unwrap(), "mine");
    }

    #[test]
    fn statistics_that_are_not_finished_have_no_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let config = StatsConfig { scenes: vec!["room".into()], ..StatsConfig::default() };
        let page = write_statistics(&dataset, &config, &Quiet).unwrap().page;
        assert!(dataset.layout().statistics().is_file());
        // A folder is in the place of the page.
        std::fs::remove_file(&page).unwrap();
        std::fs::create_dir_all(page.join("in the way")).unwrap();
        write_statistics(&dataset, &config, &Quiet).unwrap_err();
        assert!(!dataset.layout().statistics().exists());
    }

    #[test]
    fn previews_are_found_from_the_page() {
        let dataset = Dataset::create(tempfile::tempdir().unwrap().path()).unwrap();
        let outlier =
            Outlier { scene: "hall".into(), camera: "cam_01".into(), frame: 7, quantity: "noise", value: 1.0, median: 0.1, score: 9.0 };
        let preview = preview_from(&dataset, &dataset.layout().statistics_dir(), &outlier);
        assert_eq!(preview, "../scenes/hall/images/scene_cam_01_final_preview/frame.0007.tonemap.jpg");
        let elsewhere = preview_from(&dataset, Path::new("/elsewhere"), &outlier);
        assert!(
            elsewhere.ends_with("scenes/hall/images/scene_cam_01_final_preview/frame.0007.tonemap.jpg")
                && Path::new(&elsewhere).is_absolute()
        );
    }
}
