//! The charts of a dataset, and their contents.

use super::chart::{Axis, BLUE, Chart, Named, Series, VERMILION};
use super::costs::{CostReport, FrameCost};
use super::histogram::{Histogram, Scale};
use super::maps::{Frame, draw_maps};
use super::measure::{Counts, LIGHTS};
use super::toolkit::class_shares;
use crate::drawing::Drawing;
use enfilade_label::class_name;
use enfilade_math::quantile;

/// A chart under its name, with what it shows in a sentence.
pub struct Plot {
    /// Name of its files, without an extension.
    pub name: String,
    /// Caption.
    pub caption: String,
    /// The page.
    pub drawing: Drawing,
}

/// A dataset that ours is compared with.
pub struct Reference {
    /// For legends.
    pub name: String,
    /// Counts of the dataset.
    pub counts: Counts,
}

/// Points of a curve at most.
const POINTS: usize = 200;
/// Classes that a chart lists.
const MOST_CLASSES: usize = 30;
/// Names of the charts that are not of light.
const NAMES: [&str; 12] = [
    "depth_log",
    "depth_linear",
    "normals",
    "pixels_per_class",
    "objects_per_class",
    "classes_per_image",
    "objects_per_image",
    "object_volume",
    "cost_cpu",
    "cost_wall",
    "cost_samples",
    "cost_memory",
];

/// The name of every chart that may be drawn.
pub fn names() -> Vec<String> {
    let of_light = LIGHTS.iter().flat_map(|light| ["brightness", "hue_saturation"].map(|what| format!("{}_{what}", light.stem)));
    of_light.chain(NAMES.map(String::from)).collect()
}

/// Charts of the pictures' contents, over those of a reference if there is one.
pub fn plots(counts: &Counts, reference: Option<&Reference>) -> Vec<Plot> {
    let both = Both { ours: counts, reference };
    let mut plots = Vec::new();
    for (i, light) in LIGHTS.iter().enumerate() {
        let radiance = if i == 1 { "" } else { ", radiance as rendered" };
        let title = format!("{}: brightness", light.title);
        plots.extend(both.density(
            &format!("{}_brightness", light.stem),
            &title,
            &format!("brightness 0.3 R + 0.59 G + 0.11 B{radiance}"),
            "pixels",
            |counts| &counts.lights[i].log,
        ));
    }
    plots.extend(both.density("depth_log", "Depth", "distance to the camera (m)", "pixels", |counts| &counts.depth_log));
    plots.extend(both.density("depth_linear", "Depth up to 20 m", "distance to the camera (m)", "pixels", |counts| &counts.depth));
    plots.extend(LIGHTS.iter().enumerate().filter_map(|(i, light)| {
        let title = format!("{}: hue and saturation", light.title);
        both.map(&format!("{}_hue_saturation", light.stem), &title, Frame::Hue, |counts| &counts.lights[i].hue_saturation)
    }));
    plots.extend(both.map("normals", "Normals in camera axes", Frame::Normal, |counts| &counts.normals));
    plots.extend(both.class_bars("pixels_per_class", "Classes by pixels", "share of labelled pixels (%)", class_shares));
    plots.extend(both.class_bars("objects_per_class", "Classes by objects", "share of objects (%)", object_shares));
    plots.extend(both.numbers("classes_per_image", "Classes per image", "classes", |counts| &counts.classes_per_image));
    plots.extend(both.numbers("objects_per_image", "Objects per image", "objects", |counts| &counts.objects_per_image));
    plots.extend(
        both.density("object_volume", "Volume of objects", "volume of the upright box (m³)", "objects", |counts| &counts.volumes_log),
    );
    plots
}

fn object_shares(counts: &Counts) -> Vec<f64> {
    let all: u64 = counts.objects_per_class[1..].iter().sum();
    counts.objects_per_class.iter().enumerate().map(|(i, n)| if i < 2 { 0.0 } else { *n as f64 / all.max(1) as f64 }).collect()
}

struct Both<'a> {
    ours: &'a Counts,
    reference: Option<&'a Reference>,
}

impl Both<'_> {
    /// Series of both: ours filled, the reference as a line.
    fn series(&self, of: impl Fn(&Counts) -> Vec<(f64, f64)>) -> Vec<Named> {
        let ours = ("this dataset".to_string(), BLUE, Series::Area(of(self.ours)));
        let other = self.reference.map(|r| (r.name.clone(), VERMILION, Series::Line(of(&r.counts))));
        std::iter::once(ours).chain(other.filter(|(.., series)| !series.is_empty())).collect()
    }

    /// Density of a quantity; `None` when none of it was counted.
    fn density(&self, name: &str, title: &str, quantity: &str, things: &str, of: impl Fn(&Counts) -> &Histogram) -> Option<Plot> {
        let ours = of(self.ours);
        let median = ours.quantile(0.5)?;
        let log = ours.bins.scale == Scale::Log;
        let series = self.series(|counts| density(of(counts)));
        let high = 1.08 * series.iter().flat_map(|(.., series)| series.points()).map(|p| p.1).fold(0.0, f64::max);
        let (low, last) = (ours.bins.low, ours.bins.high);
        let x = if log { Axis::log(quantity, low.log10(), last.log10()) } else { Axis::linear(quantity, low, last) };
        let note = format!("share of {things} per {}", if log { "decade" } else { "metre" });
        let chart = Chart { title: title.into(), note, x, y: Axis::linear("", 0.0, high.max(1e-9)), series };
        let beyond = |n: u64| 100.0 * n as f64 / ours.total() as f64;
        let mut caption = format!("{title}: half of it below {}", number(median));
        for (share, side) in [(beyond(ours.below), "to the left"), (beyond(ours.above), "to the right")] {
            if share >= 0.05 {
                caption += &format!(", {share:.1} % beyond the axis {side}");
            }
        }
        if let Some(reference) = self.reference
            && let (Some(ours), Some(theirs)) = (ours.within().quantile(0.5), of(&reference.counts).within().quantile(0.5))
        {
            let names = format!("half of what lies on the axis below {} here, {} in {}", number(ours), number(theirs), reference.name);
            caption = format!("{title}: {names}");
        }
        Some(Plot { name: name.into(), caption, drawing: chart.draw() })
    }

    fn map(&self, name: &str, title: &str, frame: Frame, of: impl Fn(&Counts) -> &super::measure::Map) -> Option<Plot> {
        if of(self.ours).counts.iter().all(|count| *count == 0) {
            return None;
        }
        let mut maps = vec![("this dataset".to_string(), of(self.ours))];
        maps.extend(self.reference.map(|r| (r.name.clone(), of(&r.counts))));
        let note = match frame {
            Frame::Hue => "hue by direction, saturation outward",
            Frame::Normal => "x to the right, y up, towards the camera",
        };
        Some(Plot { name: name.into(), caption: title.into(), drawing: draw_maps(title, note, frame, &maps) })
    }

    /// Horizontal bars of the most frequent classes.
    fn class_bars(&self, name: &str, title: &str, axis: &str, shares: impl Fn(&Counts) -> Vec<f64>) -> Option<Plot> {
        let ours = shares(self.ours);
        let theirs = self.reference.map(|r| shares(&r.counts));
        let other = |i: usize| theirs.as_ref().map_or(0.0, |shares| shares[i]);
        let mut classes: Vec<usize> = (2..ours.len()).filter(|&i| ours[i] > 0.0 || other(i) >= 0.002).collect();
        if ours.iter().all(|share| *share == 0.0) {
            return None;
        }
        classes.sort_by(|&a, &b| (ours[b] + 1e-3 * other(b)).total_cmp(&(ours[a] + 1e-3 * other(a))).then(a.cmp(&b)));
        classes.truncate(MOST_CLASSES);
        let n = classes.len() as f64;
        let row = |k: usize| n - 1.0 - k as f64;
        let bars = |of: &dyn Fn(usize) -> f64, from: f64, to: f64| {
            classes.iter().enumerate().map(|(k, &i)| [0.0, row(k) + from, 100.0 * of(i), row(k) + to]).collect::<Vec<_>>()
        };
        let mut series: Vec<Named> = Vec::new();
        match self.reference {
            None => series.push((String::new(), BLUE, Series::Bars(bars(&|i| ours[i], 0.15, 0.85)))),
            Some(reference) => {
                series.push(("this dataset".into(), BLUE, Series::Bars(bars(&|i| ours[i], 0.5, 0.9))));
                series.push((reference.name.clone(), VERMILION, Series::Bars(bars(&other, 0.1, 0.5))));
            }
        }
        let most = 100.0 * classes.iter().map(|&i| ours[i].max(other(i))).fold(0.0, f64::max);
        let ticks = classes.iter().enumerate().map(|(k, &i)| (row(k) + 0.5, class_name(i as i16 - 1).to_string())).collect();
        let y = Axis { name: String::new(), low: 0.0, high: n, ticks };
        let chart = Chart { title: title.into(), note: String::new(), x: Axis::linear(axis, 0.0, 1.04 * most), y, series };
        let caption =
            format!("{title}: {} classes occur, {} most", ours.iter().filter(|s| **s > 0.0).count(), class_name(classes[0] as i16 - 1));
        Some(Plot { name: name.into(), caption, drawing: chart.draw() })
    }

    /// Shares of images by a number that each one has.
    fn numbers(&self, name: &str, title: &str, things: &str, of: impl Fn(&Counts) -> &Vec<u64>) -> Option<Plot> {
        let ours = of(self.ours);
        let total: u64 = ours.iter().sum();
        let last = ours.iter().rposition(|n| *n > 0)?;
        let reference_last = self.reference.map_or(0, |r| quantile_of_counts(of(&r.counts), 0.98));
        // Bars of several numbers each if there would be too many to distinguish.
        let last = last.max(reference_last).max(9);
        let step = (last + 1).div_ceil(60);
        let shares = |counts: &[u64]| -> Vec<f64> {
            let all = counts.iter().sum::<u64>().max(1) as f64;
            counts.chunks(step).map(|chunk| 100.0 * chunk.iter().sum::<u64>() as f64 / all).take(last / step + 1).collect()
        };
        let bars = |counts: &[u64], from: f64, to: f64| {
            let at = |i: usize, share: f64| (i as f64 + share) * step as f64 - 0.5;
            shares(counts).into_iter().enumerate().map(|(i, share)| [at(i, from), 0.0, at(i, to), share]).collect::<Vec<_>>()
        };
        let mut series = vec![("this dataset".to_string(), BLUE, Series::Bars(bars(ours, 0.1, 0.9)))];
        if let Some(r) = self.reference {
            let steps = shares(of(&r.counts)).into_iter().enumerate();
            let line = steps.flat_map(|(i, s)| [i, i + 1].map(|i| ((i * step) as f64 - 0.5, s))).collect();
            series.push((r.name.clone(), VERMILION, Series::Line(line)));
        }
        let most = series.iter().flat_map(|(.., series)| series.points()).map(|p| p.1).fold(0.0, f64::max);
        let x = Axis::linear(things, -0.5, last as f64 + 0.5);
        let chart = Chart { title: title.into(), note: "share of images (%)".into(), x, y: Axis::linear("", 0.0, 1.08 * most), series };
        let median = quantile_of_counts(ours, 0.5);
        Some(Plot { name: name.into(), caption: format!("{title}: half of {total} images have {median} or fewer"), drawing: chart.draw() })
    }
}

/// The number that a share of the images has at most.
fn quantile_of_counts(counts: &[u64], q: f64) -> usize {
    let wanted = q * counts.iter().sum::<u64>() as f64;
    let mut passed = 0;
    let reached = |n: &u64| {
        passed += n;
        passed as f64 >= wanted
    };
    counts.iter().position(reached).unwrap_or(0)
}

impl Series {
    /// Points that it passes through.
    fn points(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Area(points) | Self::Line(points) | Self::Dots(points) => points.clone(),
            Self::Bars(bars) => bars.iter().map(|bar| (bar[2], bar[3])).collect(),
        }
    }

    fn is_empty(&self) -> bool {
        self.points().iter().all(|(_, y)| *y == 0.0)
    }
}

/// Density as a curve: share of the values on the axis per unit of it, which is a decade where bins have equal ratios.
fn density(histogram: &Histogram) -> Vec<(f64, f64)> {
    let histogram = histogram.within();
    let log = histogram.bins.scale == Scale::Log;
    let at = |v: f64| if log { v.log10() } else { v };
    let curve = histogram.coarser(histogram.bins.count.div_ceil(POINTS));
    curve.shares().map(|[low, high, share]| (0.5 * (at(low) + at(high)), share / (at(high) - at(low)))).collect()
}

/// Three digits.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if (1e3..1e7).contains(&v) => format!("{value:.0}"),
        v if !(1e-4..1e7).contains(&v) => format!("{value:.2e}"),
        v => format!("{value:.*}", (2 - v.log10().floor() as i32).max(0) as usize),
    }
}

/// Charts of what frames cost.
pub fn cost_plots(report: &CostReport) -> Vec<Plot> {
    let frames = &report.frames;
    let mut plots = Vec::new();
    plots.extend(by_frame("cost_cpu", "Processor time per frame", "seconds of all threads", frames, |f| Some(f.cost.cpu_s)));
    plots.extend(by_frame("cost_wall", "Time per frame", "seconds on the wall clock", frames, |f| Some(f.cost.wall_s)));
    plots.extend(by_frame("cost_samples", "Samples per pixel", "mean over the image", frames, |f| f.cost.samples_per_pixel));
    plots.extend(by_frame("cost_memory", "Memory", "most that the process had until then (GiB)", frames, |f| f.cost.peak_memory_gib));
    plots
}

/// A dot per frame in the order of the dataset; scenes are separated by lines.
fn by_frame(name: &str, title: &str, unit: &str, frames: &[FrameCost], of: impl Fn(&FrameCost) -> Option<f64>) -> Option<Plot> {
    let dots: Vec<(f64, f64)> = frames.iter().enumerate().filter_map(|(i, frame)| Some((i as f64, of(frame)?))).collect();
    let mut values: Vec<f64> = dots.iter().map(|dot| dot.1).collect();
    let (low, median, high) = (quantile(&mut values, 0.0)?, quantile(&mut values, 0.5)?, quantile(&mut values, 1.0)?);
    let border = |i: &usize| *i > 0 && frames[*i].scene != frames[*i - 1].scene;
    let top = (1.1 * high).max(1e-9);
    let x = Axis::linear("frame, in the order of the dataset", -0.5, (frames.len() as f64 - 0.5).max(0.5));
    let mut series: Vec<Named> = Vec::new();
    let borders = (0..frames.len()).filter(border).map(|i| i as f64 - 0.5);
    series.extend(borders.map(|x| (String::new(), super::chart::GRID, Series::Line(vec![(x, 0.0), (x, top)]))));
    series.push((String::new(), BLUE, Series::Dots(dots)));
    let chart = Chart { title: title.into(), note: unit.into(), x, y: Axis::linear("", 0.0, top), series };
    let caption = format!("{title}, {unit}: {} to {}, median {}", number(low), number(high), number(median));
    Some(Plot { name: name.into(), caption, drawing: chart.draw() })
}
