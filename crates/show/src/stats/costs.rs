//! The cost of frames: processor hours and dollars at given prices.
//!
//! A vCPU-hour is the unit that clouds bill: an hour of one thread of a machine, busy or idle. A frame takes its wall-clock time times the
//! number of threads at work.

use enfilade_dataset::{FrameTime, Price};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Seconds of an hour.
const HOUR_S: f64 = 3600.0;
/// Bytes of a gibibyte.
const GIB: f64 = 1_073_741_824.0;

/// Time and memory of one frame, or of many together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Frames.
    pub frames: u64,
    /// Wall-clock seconds, one frame after the other.
    pub wall_s: f64,
    /// Seconds of all threads together.
    pub cpu_s: f64,
    /// Wall-clock hours times threads at work.
    pub vcpu_hours: f64,
    /// Most memory that the process ever had, GiB; `None` where it was not recorded.
    pub peak_memory_gib: Option<f64>,
    /// Mean samples per pixel; `None` where they were not recorded.
    pub samples_per_pixel: Option<f64>,
}

impl Cost {
    /// Cost of one frame. Without a number of threads, processor time counts as if no thread had ever waited.
    pub fn of(time: &FrameTime, samples_per_pixel: Option<f64>) -> Self {
        let vcpu_s = time.threads.map_or(time.cpu_s, |threads| time.wall_s * f64::from(threads));
        Self {
            frames: 1,
            wall_s: time.wall_s,
            cpu_s: time.cpu_s,
            vcpu_hours: vcpu_s / HOUR_S,
            peak_memory_gib: time.peak_memory_bytes.map(|bytes| bytes as f64 / GIB),
            samples_per_pixel,
        }
    }

    /// Cost of several together: sums, the largest memory, mean samples.
    pub fn sum<'a>(costs: impl Iterator<Item = &'a Self>) -> Self {
        let (mut all, mut samples) = (Self::default(), Vec::new());
        for cost in costs {
            all.frames += cost.frames;
            all.wall_s += cost.wall_s;
            all.cpu_s += cost.cpu_s;
            all.vcpu_hours += cost.vcpu_hours;
            all.peak_memory_gib = all.peak_memory_gib.into_iter().chain(cost.peak_memory_gib).reduce(f64::max);
            samples.extend(cost.samples_per_pixel.map(|taken| (taken, cost.frames)));
        }
        let weight: u64 = samples.iter().map(|(_, frames)| frames).sum();
        let taken: f64 = samples.iter().map(|(taken, frames)| taken * *frames as f64).sum();
        all.samples_per_pixel = (weight > 0).then(|| taken / weight as f64);
        all
    }

    /// Share of the paid processor time that was used, 0 to 1.
    pub fn utilization(&self) -> f64 {
        if self.vcpu_hours > 0.0 { self.cpu_s / HOUR_S / self.vcpu_hours } else { 0.0 }
    }

    /// Dollars at a price, all its rates together.
    pub fn dollars(&self, price: &Price) -> f64 {
        price.dollars(self.vcpu_hours)
    }
}

/// The cost of one frame.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameCost {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// The time and memory.
    #[serde(flatten)]
    pub cost: Cost,
    /// Dollars by name of the price.
    pub dollars: BTreeMap<String, f64>,
}

/// `costs.json`: the cost of the frames, one by one and together. Times differ from run to run, so it is a separate file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostReport {
    /// Prices.
    pub prices: Vec<Price>,
    /// All frames.
    pub total: Cost,
    /// Dollars of all frames by name of the price.
    pub dollars: BTreeMap<String, f64>,
    /// Dollars by name of the price and by rate, of prices with more than one rate.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub dollars_by_rate: BTreeMap<String, BTreeMap<String, f64>>,
    /// By scene.
    pub scenes: BTreeMap<String, Cost>,
    /// Frame by frame.
    pub frames: Vec<FrameCost>,
}

/// True for the text of a file of [`CostReport`].
pub fn is_costs(text: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Total {
        vcpu_hours: f64,
    }
    #[derive(Deserialize)]
    struct Head {
        total: Total,
    }
    serde_json::from_slice(text).is_ok_and(|head: Head| head.total.vcpu_hours >= 0.0)
}

impl CostReport {
    /// Report on frames by scene, camera and number.
    pub fn new(frames: &[((String, String, u32), Cost)], prices: &[Price]) -> Self {
        let dollars = |cost: &Cost| prices.iter().map(|price| (price.name.clone(), cost.dollars(price))).collect::<BTreeMap<_, _>>();
        let total = Cost::sum(frames.iter().map(|(_, cost)| cost));
        let mut scenes: BTreeMap<String, Vec<&Cost>> = BTreeMap::new();
        frames.iter().for_each(|((scene, ..), cost)| scenes.entry(scene.clone()).or_default().push(cost));
        let frame = |((scene, camera, frame), cost): &((String, String, u32), Cost)| FrameCost {
            scene: scene.clone(),
            camera: camera.clone(),
            frame: *frame,
            cost: *cost,
            dollars: dollars(cost),
        };
        let by_rate = prices.iter().map(|price| {
            let parts = price.parts(total.vcpu_hours).into_iter().map(|(rate, dollars)| (rate.to_string(), dollars));
            (price.name.clone(), parts.collect::<BTreeMap<_, _>>())
        });
        Self {
            dollars_by_rate: by_rate.filter(|(_, parts)| !parts.is_empty()).collect(),
            prices: prices.to_vec(),
            total,
            dollars: dollars(&total),
            scenes: scenes.into_iter().map(|(scene, costs)| (scene, Cost::sum(costs.into_iter()))).collect(),
            frames: frames.iter().map(frame).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::{Per, Rate};

    fn time(wall_s: f64, cpu_s: f64, threads: Option<u32>) -> FrameTime {
        FrameTime { wall_s, cpu_s, peak_memory_bytes: Some(1 << 30), threads }
    }

    #[test]
    fn threads_that_wait_are_paid_for() {
        let cost = Cost::of(&time(1800.0, 5400.0, Some(4)), Some(64.0));
        assert_eq!((cost.vcpu_hours, cost.utilization(), cost.peak_memory_gib), (2.0, 0.75, Some(1.0)));
        assert_eq!(cost.dollars(&Price::new("spot", 0.05)), 0.1);
        assert_eq!(Cost::of(&time(1800.0, 5400.0, None), None).vcpu_hours, 1.5);
    }

    #[test]
    fn the_sum_of_frames_is_the_cost_of_the_dataset() {
        let key = |scene: &str, frame| (scene.to_string(), "cam_00".to_string(), frame);
        let frames = [
            (key("hall", 0), Cost::of(&time(3600.0, 7200.0, Some(2)), Some(32.0))),
            (key("hall", 1), Cost::of(&time(1800.0, 3600.0, Some(2)), Some(64.0))),
            (key("room", 0), Cost::of(&time(900.0, 900.0, Some(2)), None)),
        ];
        let licences = vec![Rate { name: "licence".into(), dollars: 0.05, per: Per::CoreMinute }];
        let report = CostReport::new(&frames, &[Price::new("a", 2.0), Price { licences, ..Price::new("b", 2.0) }]);
        assert_eq!((report.dollars["b"], report.frames[1].dollars["b"]), (3.5 * 5.0, 5.0));
        assert_eq!(
            report.dollars_by_rate,
            BTreeMap::from([("b".into(), BTreeMap::from([("machine".into(), 7.0), ("licence".into(), 10.5)]))])
        );
        assert_eq!((report.total.frames, report.total.vcpu_hours, report.dollars["a"]), (3, 3.5, 7.0));
        assert_eq!((report.scenes["hall"].vcpu_hours, report.scenes["room"].vcpu_hours), (3.0, 0.5));
        assert_eq!((report.total.samples_per_pixel, report.frames[1].dollars["a"]), (Some(48.0), 2.0));
        assert!((report.total.utilization() - 11_700.0 / 12_600.0).abs() < 1e-12);
    }
}
