//! Costs from the times of a dataset, and as the tables of Hypersim's toolkit: one row per trajectory and one per frame.

use super::costs::{Cost, CostReport, FrameCost};
use super::gather::NamedImage;
use enfilade_dataset::{Dataset, DatasetError, Price, smallest_feasible, write_bytes};
use std::collections::BTreeMap;
use std::path::Path;

/// By trajectory.
pub const JOBS: &str = "metadata_rendering_jobs.csv";
/// By frame.
pub const TASKS: &str = "metadata_rendering_tasks.csv";

const JOBS_HEADER: &str = "job_name,instance_type,vcpu_per_instance,time_instance_seconds,time_vcpu_seconds,cost_cloud_dollars,\
    cost_vray_dollars,used_clock,total_clock,cpu_utilization,peak_memory_usage_gib,min_feasible_instance_type,\
    camera_trajectory_included_in_dataset\n";
const TASKS_HEADER: &str = "job_name,task_id,time_instance_seconds,time_vcpu_seconds,cost_cloud_dollars,cost_vray_dollars,used_clock,\
    total_clock,cpu_utilization,peak_memory_usage_gib,samples_per_pixel,camera_trajectory_included_in_dataset\n";
const HOUR_S: f64 = 3600.0;
/// Bytes of a gibibyte.
const GIB: f64 = 1_073_741_824.0;

/// The cost of the given images; `None` if no times are known.
///
/// # Errors
/// When the table of times cannot be read.
pub fn costs(dataset: &Dataset, images: &[NamedImage], prices: &[Price]) -> Result<Option<CostReport>, DatasetError> {
    let times = dataset.read_times()?;
    let cost = |image: &NamedImage| {
        let key = (image.scene.clone(), image.camera.clone(), image.frame);
        let cost = Cost::of(times.get(&key)?, image.samples_per_pixel);
        Some((key, cost))
    };
    let frames: Vec<_> = images.iter().filter_map(cost).collect();
    Ok((!frames.is_empty()).then(|| CostReport::new(&frames, prices)))
}

/// Writes the tables, at the first price; with the smallest machine of all that could have made a trajectory.
///
/// # Errors
/// When a file cannot be written.
pub fn write_tables(folder: &Path, report: &CostReport) -> Result<(), DatasetError> {
    let free = Price::new("", 0.0);
    let price = report.prices.first().unwrap_or(&free);
    let mut jobs: BTreeMap<String, Vec<&Cost>> = BTreeMap::new();
    let mut tasks = TASKS_HEADER.to_string();
    for frame in &report.frames {
        jobs.entry(job_name(frame)).or_default().push(&frame.cost);
        tasks += &task_row(frame, price);
    }
    let rows: String = jobs.into_iter().map(|(name, costs)| job_row(&name, &Cost::sum(costs.into_iter()), price, &report.prices)).collect();
    write_bytes(&folder.join(JOBS), JOBS_HEADER.to_string() + &rows)?;
    write_bytes(&folder.join(TASKS), tasks)
}

/// Name of a job as the toolkit writes it.
fn job_name(frame: &FrameCost) -> String {
    format!("{}@scene_{}_final", frame.scene, frame.camera)
}

fn memory(cost: &Cost) -> String {
    cost.peak_memory_gib.map_or(String::new(), |gib| format!("{gib:.3}"))
}

/// Seconds on the wall clock and of all vCPUs, dollars of the machine and of licences (Hypersim's was V-Ray's), clocks and the share that
/// was used.
fn shared_cells(cost: &Cost, price: &Price) -> String {
    let vcpu_s = HOUR_S * cost.vcpu_hours;
    let machine = price.machine_dollars(cost.vcpu_hours);
    let licences = if price.licences.is_empty() { "0".into() } else { format!("{:.6}", price.licence_dollars(cost.vcpu_hours)) };
    format!("{:.3},{vcpu_s:.3},{machine:.6},{licences},{:.3},{vcpu_s:.3},{:.4}", cost.wall_s, cost.cpu_s, cost.utilization())
}

fn job_row(name: &str, cost: &Cost, price: &Price, prices: &[Price]) -> String {
    let vcpus = if cost.wall_s > 0.0 { (HOUR_S * cost.vcpu_hours / cost.wall_s).round() } else { 0.0 };
    let peak_bytes = cost.peak_memory_gib.map(|gib| (gib * GIB) as u64);
    let smallest = peak_bytes.and_then(|bytes| smallest_feasible(prices, vcpus as u32, bytes));
    let smallest = smallest.map_or(String::new(), |price| price.name.clone());
    format!("{name},,{vcpus},{},{},{smallest},True\n", shared_cells(cost, price), memory(cost))
}

fn task_row(frame: &FrameCost, price: &Price) -> String {
    let cost = &frame.cost;
    let samples = cost.samples_per_pixel.map_or(String::new(), |n| format!("{n:.3}"));
    format!("{},{},{},{},{samples},True\n", job_name(frame), frame.frame, shared_cells(cost, price), memory(cost))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::{Machine, Per, Rate};

    #[test]
    fn a_trajectory_is_a_job_and_its_frames_are_tasks() {
        let folder = tempfile::tempdir().unwrap();
        let cost = Cost {
            frames: 1,
            wall_s: 10.0,
            cpu_s: 30.0,
            vcpu_hours: 40.0 / HOUR_S,
            peak_memory_gib: Some(2.0),
            samples_per_pixel: Some(64.0),
        };
        let frames: Vec<_> = (0..2).map(|frame| (("room".to_string(), "cam_00".to_string(), frame), cost)).collect();
        let machine = |vcpus| Some(Machine { vcpus, memory_gib: 4.0 });
        let price = |name: &str, dollars_per_vcpu_hour, vcpus| Price { machine: machine(vcpus), ..Price::new(name, dollars_per_vcpu_hour) };
        let prices = [price("spot", 0.9, 16), price("four", 1.0, 4), price("two", 1.0, 2)];
        let report = CostReport::new(&frames, &prices);
        write_tables(folder.path(), &report).unwrap();
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let (jobs, tasks) = (read(JOBS), read(TASKS));
        assert_eq!(
            jobs.lines().nth(1).unwrap(),
            "room@scene_cam_00_final,,4,20.000,80.000,0.020000,0,60.000,80.000,0.7500,2.000,four,True"
        );
        assert_eq!(
            tasks.lines().nth(2).unwrap(),
            "room@scene_cam_00_final,1,10.000,40.000,0.010000,0,30.000,40.000,0.7500,2.000,64.000,True"
        );
        // As Hypersim's, of which half the dollars here go to the machine.
        let licences = vec![Rate { name: "licence".into(), dollars: 0.015, per: Per::CoreMinute }];
        write_tables(folder.path(), &CostReport::new(&frames, &[Price { licences, ..Price::new("licensed", 0.9) }])).unwrap();
        assert!(read(JOBS).lines().nth(1).unwrap().starts_with("room@scene_cam_00_final,,4,20.000,80.000,0.020000,0.020000,60.000,"));
        assert!(read(TASKS).lines().nth(1).unwrap().starts_with("room@scene_cam_00_final,0,10.000,40.000,0.010000,0.010000,30.000,"));
        for table in [&jobs, &tasks] {
            assert!(table.lines().all(|line| line.split(',').count() == table.lines().next().unwrap().split(',').count()));
        }
    }
}
