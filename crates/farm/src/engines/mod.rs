//! Files for the engines that start workers. Each engine is a text that runs `enfilade farm work` once per index; none is asked what is done.

mod aws_batch;
mod kubernetes;
mod openjd;
mod slurm;

pub use aws_batch::aws_batch_job;
pub use kubernetes::kubernetes_job;
pub use openjd::openjd_template;
pub use slurm::{slurm_collect_script, slurm_scripts};

use crate::{Job, Ranges, print_ranges};

/// The description of a job for every engine.
#[derive(Clone, Debug, PartialEq)]
pub struct Submission {
    /// Name of the job, of letters, digits and `-`.
    pub name: String,
    /// The store, as workers name it.
    pub store: String,
    /// The program on the nodes, or the image that contains it.
    pub program: String,
    /// The tasks to be done.
    pub tasks: Ranges,
    /// Threads of a worker.
    pub cpus: u32,
    /// Memory of a worker, MiB.
    pub memory_mib: u64,
    /// After how many minutes an engine may end a worker.
    pub minutes: u64,
    /// Workers at once, where that is limited.
    pub at_once: Option<u32>,
    /// Most attempts at a task that fails in a way that another attempt may mend.
    pub attempts: u32,
    /// A folder of the node.
    pub scratch: String,
    /// Indices of one array at most.
    pub array_limit: u32,
}

impl Submission {
    /// The missing tasks of a job, sized by its forecast: twice the time of the longest task and a quarter more memory than expected.
    pub fn of(job: &Job, tasks: Ranges) -> Self {
        let plan = &job.plan;
        let longest_s = tasks.iter().filter_map(|&task| plan.tasks.get(task as usize)).map(|task| task.cpu_s).fold(0.0, f64::max);
        let memory = plan.scenes.iter().map(|scene| scene.memory_bytes.mean).fold(0.0, f64::max);
        let name: String = plan.dataset.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
        Self {
            name: format!("enfilade-{}", name.trim_matches('-')),
            store: job.store.url().into(),
            program: "enfilade".into(),
            tasks,
            cpus: plan.cpus,
            memory_mib: (1.25 * memory / f64::from(1 << 20)).ceil() as u64 + 512,
            minutes: (2.0 * longest_s / 60.0 / f64::from(plan.cpus.max(1))).ceil() as u64 + 10,
            at_once: None,
            attempts: 4,
            scratch: "${TMPDIR:-/tmp}/enfilade-farm".into(),
            array_limit: 1000,
        }
    }

    /// The tasks in arrays of at most [`Submission::array_limit`].
    pub(crate) fn arrays(&self) -> Vec<Vec<u32>> {
        let all: Vec<u32> = self.tasks.iter().copied().collect();
        all.chunks(self.array_limit.max(1) as usize).map(<[u32]>::to_vec).collect()
    }
}

/// The command of a container that does one of `tasks`: the one that the engine's index counts, which the program reads by itself, so that
/// an image needs no shell. Tasks are written as ranges, since engines limit the length of a command.
pub(crate) fn nth_task(submission: &Submission, tasks: &[u32], scratch: &str) -> Vec<String> {
    let (cpus, ranges) = (submission.cpus.to_string(), print_ranges(&tasks.iter().copied().collect()));
    let words =
        [&submission.program, "--threads", &cpus, "farm", "work", &submission.store, "--task", &ranges, "--nth", "--scratch", scratch];
    words.map(String::from).to_vec()
}

#[cfg(test)]
pub(crate) fn example() -> Submission {
    Submission {
        name: "enfilade-rooms".into(),
        store: "s3://bucket/rooms".into(),
        program: "enfilade".into(),
        tasks: crate::parse_ranges("0-2,7").unwrap_or_default(),
        cpus: 8,
        memory_mib: 4096,
        minutes: 40,
        at_once: Some(6),
        attempts: 4,
        scratch: "/tmp/enfilade-farm".into(),
        array_limit: 1000,
    }
}
