//! `statistics.html`: the numbers, the charts, and a picture of every outlier.

use super::costs::CostReport;
use super::outlier::Outlier;
use super::plots::{Plot, number};
use super::report::Report;
use crate::page::{contents, page};
use enfilade_dataset::counted;
use maud::{Markup, html};

/// Largest number of cards of outliers; the files list them all.
const MOST_CARDS: usize = 60;

/// The contents of the page.
pub struct Shown<'a> {
    /// Name of the dataset.
    pub dataset: &'a str,
    /// The numbers.
    pub report: &'a Report,
    /// The cost of the frames, if requested and known.
    pub costs: Option<&'a CostReport>,
    /// Charts of what the images show.
    pub plots: &'a [Plot],
    /// Charts of what they cost.
    pub cost_plots: &'a [Plot],
    /// Outliers among the images.
    pub outliers: &'a [Outlier],
    /// Path of an image's preview from the page.
    pub preview: &'a dyn Fn(&Outlier) -> String,
    /// The dataset that ours is compared with.
    pub reference: Option<&'a str>,
}

/// The page.
pub fn statistics_page(shown: &Shown<'_>) -> String {
    let summary = &shown.report.dataset;
    let compared = shown.reference.map_or(String::new(), |name| format!(" Over the charts: {name}."));
    let about = html! {
        (counted(summary.images as usize, "image")) " of " (counted(shown.report.scenes.len(), "scene")) ", " (number(summary.pixels as f64 / 1e6)) " million pixels." (compared)
        " The same as numbers: " a href="statistics.json" { "statistics.json" } ", " a href="image_statistics" { "image_statistics/" } "."
    };
    let mut parts = vec!["overview"];
    parts.extend(["brightness", "colour", "depth and normals", "classes and objects"]);
    parts.extend(shown.costs.map(|_| "costs"));
    parts.push("outliers");
    let section = |title: &str, wanted: &[&str]| {
        let is_wanted = |plot: &&Plot| wanted.iter().any(|end| plot.name.ends_with(end));
        plots(title, shown.plots.iter().filter(is_wanted))
    };
    let body = html! {
        (contents(parts))
        (overview(shown.report))
        (section("brightness", &["_brightness"]))
        (section("colour", &["_hue_saturation"]))
        (section("depth and normals", &["depth_log", "depth_linear", "normals"]))
        (section("classes and objects", &["per_class", "per_image", "object_volume"]))
        @if let Some(costs) = shown.costs { (costs_section(costs, shown.cost_plots)) }
        (outliers_section(shown))
    };
    page(&format!("{}: statistics", shown.dataset), &about, &body)
}

fn plots<'a>(title: &str, plots: impl Iterator<Item = &'a Plot>) -> Markup {
    let plots: Vec<&Plot> = plots.collect();
    html! {
        h2 id=(title) { (title) }
        @if plots.is_empty() { p { "The images have no layers for this." } }
        div class="grid" { @for plot in plots { (shown_plot(plot)) } }
    }
}

/// A plot as SVG, which is sharp on every screen, with the PNG beside it.
fn shown_plot(plot: &Plot) -> Markup {
    let file = |extension: &str| format!("plots/{}.{extension}", plot.name);
    html! {
        figure {
            a href=(file("svg")) { img src=(file("svg")) alt=(plot.caption) loading="lazy"; }
            figcaption { (plot.caption) " (" a href=(file("png")) { "PNG" } ")" }
        }
    }
}

fn overview(report: &Report) -> Markup {
    let optional = |value: Option<f64>| value.map_or("-".into(), number);
    let percent = |value: Option<f64>| value.map_or("-".into(), |v| format!("{:.1}", 100.0 * v));
    let rows = std::iter::once(("all", &report.dataset)).chain(report.scenes.iter().map(|(name, summary)| (name.as_str(), summary)));
    html! {
        h2 id="overview" { "overview" }
        div class="scroll" {
            table {
                thead { tr {
                    th { "scene" }
                    @for name in ["images", "shows the scene (%)", "labelled (%)", "brightness, median", "depth, median (m)", "classes per image", "objects per image", "object volume, median (m³)"] {
                        th class="number" { (name) }
                    }
                } }
                tbody {
                    @for (name, s) in rows {
                        tr {
                            td { (name) }
                            td class="number" { (s.images) }
                            td class="number" { (percent(Some(s.valid))) }
                            td class="number" { (percent(s.labelled)) }
                            td class="number" { (optional(s.brightness.get("color").map(|q| q.median))) }
                            td class="number" { (optional(s.depth_m.as_ref().map(|q| q.median))) }
                            td class="number" { (optional(s.classes_per_image)) }
                            td class="number" { (optional(s.objects_per_image)) }
                            td class="number" { (optional(s.volume_m3.as_ref().map(|q| q.median))) }
                        }
                    }
                }
            }
        }
    }
}

fn costs_section(costs: &CostReport, plots: &[Plot]) -> Markup {
    let rows = std::iter::once(("all", &costs.total)).chain(costs.scenes.iter().map(|(name, cost)| (name.as_str(), cost)));
    html! {
        h2 id="costs" { "costs" }
        p {
            "Rendering and writing of frames, one after the other; other stages come on top. A vCPU-hour is an hour of one thread, busy or idle. Numbers: "
            a href="costs.json" { "costs.json" } ", by trajectory " a href="metadata_rendering_jobs.csv" { "metadata_rendering_jobs.csv" } ", by frame "
            a href="metadata_rendering_tasks.csv" { "metadata_rendering_tasks.csv" } "."
        }
        div class="scroll" {
            table {
                thead { tr {
                    th { "scene" }
                    @for name in ["frames", "wall (s)", "processor (s)", "per frame (s)", "used (%)", "samples per pixel", "memory (GiB)", "vCPU-hours"] { th class="number" { (name) } }
                    @for price in &costs.prices {
                        th class="number" { "dollars, " (price.name) " (" (price.rates()) ")" }
                        @for (rate, _) in price.parts(0.0) { th class="number" { "of these, " (rate) } }
                    }
                } }
                tbody {
                    @for (name, cost) in rows {
                        tr {
                            td { (name) }
                            td class="number" { (cost.frames) }
                            td class="number" { (number(cost.wall_s)) }
                            td class="number" { (number(cost.cpu_s)) }
                            td class="number" { (number(cost.cpu_s / cost.frames.max(1) as f64)) }
                            td class="number" { (format!("{:.0}", 100.0 * cost.utilization())) }
                            td class="number" { (cost.samples_per_pixel.map_or("-".into(), number)) }
                            td class="number" { (cost.peak_memory_gib.map_or("-".into(), number)) }
                            td class="number" { (number(cost.vcpu_hours)) }
                            @for price in &costs.prices {
                                td class="number" { (number(cost.dollars(price))) }
                                @for (_, dollars) in price.parts(cost.vcpu_hours) { td class="number" { (number(dollars)) } }
                            }
                        }
                    }
                }
            }
        }
        div class="grid" { @for plot in plots { (shown_plot(plot)) } }
    }
}

fn outliers_section(shown: &Shown<'_>) -> Markup {
    let outliers = shown.outliers;
    html! {
        h2 id="outliers" { "outliers" }
        p {
            "Images whose value lies more than 3.5 robust standard deviations from the dataset's median (modified z-score); ratios are compared where a quantity has no natural zero."
            @if outliers.is_empty() { " There are none." }
            @if outliers.len() > MOST_CARDS { " The " (MOST_CARDS) " farthest of " (outliers.len()) " are shown." }
        }
        div class="grid small" {
            @for outlier in &outliers[..outliers.len().min(MOST_CARDS)] {
                @let file = (shown.preview)(outlier);
                @let name = format!("{}/{} frame {}", outlier.scene, outlier.camera, outlier.frame);
                figure {
                    a href=(file) { img src=(file) alt=(name) loading="lazy"; }
                    figcaption {
                        (name) br;
                        (outlier.quantity) " " (number(outlier.value)) ", median " (number(outlier.median)) ", score " (format!("{:+.1}", outlier.score))
                    }
                }
            }
        }
    }
}
