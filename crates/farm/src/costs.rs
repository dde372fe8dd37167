//! The cost of a job, attempt by attempt: processor time that was paid for, used, and wasted.
//!
//! A vCPU-second is what a cloud bills: a second of one thread of a machine, busy or idle. What an attempt paid beyond its own committed
//! frames went into loading scenes, into frames that are kept for the next attempt, and into frames that another committed first.

use crate::commit::read_marker_at;
use crate::feasible::{feasible, machine_of};
use crate::object_names::DONE;
use crate::status::attempts;
use crate::work::{AttemptRecord, Ended};
use crate::{FarmError, Feasible, Job, Marker};
use enfilade_dataset::{Price, tells_sizes};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

const HOUR_S: f64 = 3600.0;
const GIB: f64 = 1_073_741_824.0;

/// The columns of [`Costs::table`]: the names of Hypersim's table of tasks where it has a column, and columns that tell where an attempt
/// ran. Hypersim's cost of V-Ray is here the cost of everything besides the machine.
const HEADER: &str = "job_name,task_id,attempt,host,engine_ids,ended,vcpu_per_instance,time_instance_seconds,time_vcpu_seconds,\
    time_vcpu_seconds_in_frames,cost_cloud_dollars,cost_vray_dollars,used_clock,total_clock,cpu_utilization,peak_memory_usage_gib,min_feasible_instance_type,\
    frames_committed,frames_lost\n";

/// One attempt at one task.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AttemptCost {
    /// Record of the attempt. An attempt that was killed has recorded no time; it counts with the times of the frames that it had
    /// committed.
    pub record: AttemptRecord,
    /// vCPU-seconds of its frames that count.
    pub in_frames_vcpu_s: f64,
    /// vCPU-seconds of the user's program on these frames.
    pub after_frame_vcpu_s: f64,
}

impl AttemptCost {
    /// vCPU-seconds that it had.
    pub fn vcpu_s(&self) -> f64 {
        self.record.wall_s * f64::from(self.record.threads)
    }
}

/// A job's attempts and frames together.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Costs {
    /// In the order of tasks.
    pub attempts: Vec<AttemptCost>,
    /// vCPU-seconds of all attempts; of one that was killed, those of the frames it had committed.
    pub vcpu_s: f64,
    /// vCPU-seconds of the frames that count.
    pub in_frames_vcpu_s: f64,
    /// vCPU-seconds of the user's program on these frames, busy or idle.
    pub after_frame_vcpu_s: f64,
    /// Processor seconds of these frames.
    pub frames_cpu_s: f64,
    /// Processor seconds that the plan expected of the same frames.
    pub expected_cpu_s: f64,
    /// Processor seconds of all attempts.
    pub cpu_s: f64,
    /// vCPU-seconds of attempts that ended before their tasks were done, or made frames that another committed first, beyond their own
    /// frames. What was kept of a frame is in it, though it is not lost.
    pub wasted_vcpu_s: f64,
    /// Attempts beyond the first of each task.
    pub retries: u32,
    /// Largest peak memory of an attempt, bytes.
    pub peak_memory_bytes: Option<u64>,
    /// Records of attempts that cannot be read and do not count, each with what is wrong.
    pub unreadable: Vec<String>,
}

/// The cost of a job at some prices, as one value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statement<'a> {
    /// Attempts, and sums of vCPU-seconds and processor seconds.
    #[serde(flatten)]
    pub costs: &'a Costs,
    /// vCPU-hours that are paid for.
    pub vcpu_hours: f64,
    /// Share of it that was used, 0 to 1.
    pub utilization: f64,
    /// In the order of the prices.
    pub prices: Vec<Priced>,
    /// Machines on which the attempts could have run, if the prices include sizes of machines.
    pub machines: Option<Feasible>,
}

/// The cost of all attempts at a price.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Priced {
    /// Name and rates of the price.
    #[serde(flatten)]
    pub price: Price,
    /// All rates together.
    pub dollars: f64,
    /// By rate, where there is more than one.
    pub dollars_by_rate: BTreeMap<String, f64>,
}

/// The cost of a job until now. Every marker and every record of an attempt is read.
///
/// # Errors
/// When the store does not answer, or something in it cannot be read.
pub fn costs(job: &Job) -> Result<Costs, FarmError> {
    let mut markers = Vec::new();
    for (name, _) in job.store.list(DONE)? {
        markers.extend(read_marker_at(&job.store, &name)?);
    }
    let expected =
        |marker: &Marker| job.plan.tasks.get(marker.task as usize).map_or(0.0, |task| task.cpu_s / task.part.frames.len() as f64);
    let (records, unreadable) = attempts(job)?;
    Ok(Costs { expected_cpu_s: markers.iter().map(expected).sum(), unreadable, ..sum(&markers, records) })
}

/// Time spent on the frames that an attempt has committed.
#[derive(Clone, Copy, Default)]
struct InFrames {
    wall_s: f64,
    cpu_s: f64,
    vcpu_s: f64,
    after_frame_vcpu_s: f64,
}

fn sum(markers: &[Marker], records: Vec<AttemptRecord>) -> Costs {
    let mut frames: BTreeMap<(&str, u32), InFrames> = BTreeMap::new();
    for marker in markers {
        let of_attempt = frames.entry((&marker.attempt, marker.task)).or_default();
        let (threads, after_frame_wall_s) = (f64::from(marker.threads.unwrap_or(1)), marker.after_frame_wall_s.unwrap_or(0.0));
        of_attempt.wall_s += marker.wall_s + after_frame_wall_s;
        of_attempt.cpu_s += marker.cpu_s;
        of_attempt.vcpu_s += marker.wall_s * threads;
        of_attempt.after_frame_vcpu_s += after_frame_wall_s * threads;
    }
    let mut costs = Costs { frames_cpu_s: markers.iter().map(|marker| marker.cpu_s).sum(), ..Costs::default() };
    costs.in_frames_vcpu_s = frames.values().map(|of_attempt| of_attempt.vcpu_s).sum();
    costs.after_frame_vcpu_s = frames.values().map(|of_attempt| of_attempt.after_frame_vcpu_s).sum();
    let mut tasks: BTreeMap<u32, u32> = BTreeMap::new();
    for mut record in records {
        let in_frames = frames.get(&(record.attempt.id.as_str(), record.task)).copied().unwrap_or_default();
        if record.ended.is_none() {
            (record.wall_s, record.cpu_s) = (in_frames.wall_s, in_frames.cpu_s);
        }
        let InFrames { vcpu_s: in_frames_vcpu_s, after_frame_vcpu_s, .. } = in_frames;
        let attempt = AttemptCost { record, in_frames_vcpu_s, after_frame_vcpu_s };
        let came_to_something = in_frames_vcpu_s + after_frame_vcpu_s;
        let paid = attempt.vcpu_s().max(came_to_something);
        costs.vcpu_s += paid;
        costs.cpu_s += attempt.record.cpu_s;
        if attempt.record.ended != Some(Ended::Done) || attempt.record.lost > 0 {
            costs.wasted_vcpu_s += paid - came_to_something;
        }
        costs.peak_memory_bytes = costs.peak_memory_bytes.max(attempt.record.peak_memory_bytes);
        *tasks.entry(attempt.record.task).or_default() += 1;
        costs.attempts.push(attempt);
    }
    costs.retries = tasks.values().map(|count| count - 1).sum();
    costs
}

impl Costs {
    /// Share of the paid processor time that was used, 0 to 1.
    pub fn utilization(&self) -> f64 {
        share(self.cpu_s, self.vcpu_s)
    }

    /// Frames of which two attempts made different bytes: there should be none.
    pub fn different(&self) -> u32 {
        self.attempts.iter().map(|attempt| attempt.record.different).sum()
    }

    /// Dollars at a price, all its rates together.
    pub fn dollars(&self, price: &Price) -> f64 {
        price.dollars(self.vcpu_hours())
    }

    /// With what follows from it, at some prices.
    pub fn statement(&self, prices: &[Price]) -> Statement<'_> {
        let priced = |price: &Price| Priced {
            dollars: self.dollars(price),
            dollars_by_rate: price.parts(self.vcpu_hours()).into_iter().map(|(rate, dollars)| (rate.to_string(), dollars)).collect(),
            price: price.clone(),
        };
        Statement {
            costs: self,
            vcpu_hours: self.vcpu_hours(),
            utilization: self.utilization(),
            prices: prices.iter().map(priced).collect(),
            machines: tells_sizes(prices).then(|| self.feasible(prices)),
        }
    }

    /// vCPU-hours of all attempts, which are paid for.
    pub fn vcpu_hours(&self) -> f64 {
        self.vcpu_s / HOUR_S
    }

    /// The machines of a price table on which the attempts could have run.
    pub fn feasible(&self, prices: &[Price]) -> Feasible {
        feasible(self.attempts.iter().map(|attempt| &attempt.record), prices)
    }

    /// A row of CSV per attempt, at the first price; the smallest machine is chosen from all prices.
    pub fn table(&self, job: &Job, prices: &[Price]) -> String {
        let name = |task: u32| {
            job.plan.tasks.get(task as usize).map_or(String::new(), |t| format!("{}@scene_{}_final", t.part.scene, t.part.camera))
        };
        self.attempts.iter().fold(HEADER.to_string(), |table, attempt| table + &row(attempt, &name(attempt.record.task), prices))
    }
}

fn row(attempt: &AttemptCost, job_name: &str, prices: &[Price]) -> String {
    let (record, vcpu_s) = (&attempt.record, attempt.vcpu_s());
    let engine: Vec<String> = record.attempt.engine.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let ended = record.ended.map_or("open", Ended::word);
    let vcpu_hours = vcpu_s / HOUR_S;
    let dollars = prices.first().map_or([0.0; 2], |price| [price.machine_dollars(vcpu_hours), price.licence_dollars(vcpu_hours)]);
    let machine = machine_of(record, prices).map_or("", |price| &price.name);
    let memory = record.peak_memory_bytes.map_or(String::new(), |bytes| format!("{:.3}", bytes as f64 / GIB));
    let mut row = format!(
        "{job_name},{},{},{},{},{ended},{},",
        record.task,
        record.attempt.id,
        record.attempt.host,
        engine.join(" "),
        record.threads
    );
    let _ = writeln!(
        row,
        "{:.3},{vcpu_s:.3},{:.3},{:.6},{:.6},{:.3},{vcpu_s:.3},{:.4},{memory},{machine},{},{}",
        record.wall_s,
        attempt.in_frames_vcpu_s,
        dollars[0],
        dollars[1],
        record.cpu_s,
        share(record.cpu_s, vcpu_s),
        record.committed,
        record.lost
    );
    row
}

fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Attempt, FrameKey};
    use enfilade_dataset::{Machine, Per, Rate};

    fn marker(attempt: &str, task: u32, frame: u32) -> Marker {
        let key = FrameKey { scene: "room".into(), camera: "cam_00".into(), frame };
        let (payload, blake3) = (String::new(), String::new());
        let attempt = attempt.to_string();
        Marker {
            key,
            payload,
            bytes: 0,
            blake3,
            attempt,
            task,
            broken: Vec::new(),
            wall_s: 10.0,
            cpu_s: 18.0,
            peak_memory_bytes: None,
            threads: Some(2),
            after_frame_wall_s: None,
        }
    }

    fn record(id: &str, task: u32, wall_s: f64, ended: Option<Ended>, lost: u32) -> AttemptRecord {
        let attempt = Attempt { id: id.into(), host: "n1".into(), engine: BTreeMap::from([("SLURM_JOB_ID".to_string(), "7".to_string())]) };
        let (committed, different, error) = (0, 0, None);
        let peak_memory_bytes = Some(1 << 30);
        AttemptRecord {
            attempt,
            task,
            wall_s,
            cpu_s: 1.5 * wall_s,
            threads: 2,
            peak_memory_bytes,
            committed,
            lost,
            different,
            broken: BTreeMap::new(),
            ended,
            error,
        }
    }

    #[test]
    fn what_came_to_nothing_is_told_from_what_did() {
        let markers = [marker("a", 0, 0), marker("c", 1, 1), marker("d", 1, 2)];
        let records = vec![
            record("a", 0, 12.0, Some(Ended::Done), 0),
            record("b", 0, 5.0, Some(Ended::Done), 1),
            record("c", 1, 0.0, None, 0),
            record("d", 1, 14.0, Some(Ended::Transient), 0),
        ];
        let costs = sum(&markers, records);
        // The killed attempt counts as its frame, 20 vCPU-seconds.
        assert_eq!((costs.vcpu_s, costs.in_frames_vcpu_s), (24.0 + 10.0 + 20.0 + 28.0, 60.0));
        // All of b, nothing of c that is known, and what d had beyond its frame.
        assert_eq!((costs.wasted_vcpu_s, costs.retries), (10.0 + 8.0, 2));
        assert_eq!((costs.frames_cpu_s, costs.peak_memory_bytes), (54.0, Some(1 << 30)));
        assert!((costs.dollars(&Price::new("a", 3600.0)) - 82.0).abs() < 1e-9 && (costs.utilization() - 64.5 / 82.0).abs() < 1e-12);
        // Rows sum to the totals.
        assert_eq!(costs.attempts.iter().map(AttemptCost::vcpu_s).sum::<f64>(), costs.vcpu_s);
        assert_eq!((costs.attempts[2].record.wall_s, costs.attempts[2].record.cpu_s), (10.0, 18.0));
    }

    #[test]
    fn the_users_program_is_told_apart_and_a_statement_has_every_rate() {
        let marker = Marker { after_frame_wall_s: Some(5.0), ..marker("a", 0, 0) };
        let costs = sum(
            &[marker.clone(), Marker { attempt: "b".into(), task: 1, ..marker }],
            vec![record("a", 0, 18.0, Some(Ended::Transient), 0), record("b", 1, 0.0, None, 0)],
        );
        // 36 vCPU-seconds, of which 20 + 10 came to something; and those 30 of the attempt that was killed.
        assert_eq!((costs.vcpu_s, costs.in_frames_vcpu_s, costs.after_frame_vcpu_s, costs.wasted_vcpu_s), (66.0, 40.0, 20.0, 6.0));
        let licences = vec![Rate { name: "licence".into(), dollars: 30.0, per: Per::CoreMinute }];
        let told = serde_json::to_value(costs.statement(&[Price { licences, ..Price::new("two", 3600.0) }])).unwrap();
        assert_eq!((told["vcpu_s"].as_f64(), told["prices"][0]["dollars"].as_f64()), (Some(66.0), Some(99.0)));
        assert_eq!(told["prices"][0]["dollars_by_rate"], serde_json::json!({ "machine": 66.0, "licence": 33.0 }));
        assert!(told["machines"].is_null() && told["attempts"].as_array().unwrap().len() == 2);
    }

    #[test]
    fn rows_have_the_columns_of_the_header() {
        let costs = sum(&[marker("a", 0, 0)], vec![record("a", 0, 12.0, Some(Ended::Done), 0)]);
        let machine = Some(Machine { vcpus: 2, memory_gib: 2.0 });
        let licences = vec![Rate { name: "licence".into(), dollars: 0.000_15, per: Per::CoreMinute }];
        let prices = [Price { machine, licences, ..Price::new("two", 0.036) }];
        let row = row(&costs.attempts[0], "room@scene_cam_00_final", &prices);
        assert_eq!(row.split(',').count(), HEADER.split(',').count());
        assert_eq!(
            row,
            "room@scene_cam_00_final,0,a,n1,SLURM_JOB_ID=7,done,2,12.000,24.000,20.000,0.000240,0.000060,18.000,24.000,0.7500,1.000,two,0,0\n"
        );
    }
}
