//! AWS Batch: an array job per at most 10,000 tasks, as `aws batch submit-job --cli-input-json` takes it.

use super::{Submission, nth_task};
use serde_json::{Value, json};

/// Children of one array job at most.
const MAX_ARRAY: u32 = 10_000;
/// Bytes of a command at most: what a request overrides may have 8192 in all.
const MAX_BYTES: usize = 6000;

/// One request per array job. `queue` and `definition` are names in the account; the definition's image contains the program.
pub fn aws_batch_job(submission: &Submission, queue: &str, definition: &str) -> Vec<Value> {
    let limited = Submission { array_limit: submission.array_limit.min(MAX_ARRAY), ..submission.clone() };
    let arrays: Vec<Vec<u32>> = limited.arrays().iter().flat_map(|tasks| fitting(&limited, tasks)).collect();
    arrays.iter().enumerate().map(|(k, tasks)| request(&limited, k, tasks, queue, definition)).collect()
}

/// The tasks, halved until their command is short enough.
fn fitting(submission: &Submission, tasks: &[u32]) -> Vec<Vec<u32>> {
    if command(submission, tasks).iter().map(String::len).sum::<usize>() <= MAX_BYTES || tasks.len() < 2 {
        return vec![tasks.to_vec()];
    }
    let (low, high) = tasks.split_at(tasks.len() / 2);
    [fitting(submission, low), fitting(submission, high)].concat()
}

fn command(submission: &Submission, tasks: &[u32]) -> Vec<String> {
    nth_task(submission, tasks, "/tmp/enfilade-farm")
}

fn request(submission: &Submission, k: usize, tasks: &[u32], queue: &str, definition: &str) -> Value {
    let mut request = json!({
        "jobName": format!("{}-{k}", submission.name),
        "jobQueue": queue,
        "jobDefinition": definition,
        "containerOverrides": {
            "command": command(submission, tasks),
            "resourceRequirements": [
                { "type": "VCPU", "value": submission.cpus.to_string() },
                { "type": "MEMORY", "value": submission.memory_mib.to_string() },
            ],
        },
        "timeout": { "attemptDurationSeconds": 60 * submission.minutes.max(1) },
        "retryStrategy": {
            "attempts": submission.attempts.clamp(1, 10),
            "evaluateOnExit": [
                { "onExitCode": "65", "action": "EXIT" },
                { "onExitCode": "*", "action": "RETRY" },
                { "onStatusReason": "Host EC2*", "action": "RETRY" },
            ],
        },
    });
    // An array has two children at least.
    if tasks.len() > 1 {
        request["arrayProperties"] = json!({ "size": tasks.len() });
    }
    request
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engines::example;

    #[test]
    fn arrays_have_two_children_at_least_and_a_single_task_is_no_array() {
        let requests = aws_batch_job(&Submission { array_limit: 3, ..example() }, "spot", "enfilade:3");
        assert_eq!(requests.len(), 2);
        assert_eq!(requests[0]["arrayProperties"]["size"], 3);
        assert!(requests[1].get("arrayProperties").is_none());
        assert_eq!(requests[0]["retryStrategy"]["evaluateOnExit"][0]["action"], "EXIT");
    }

    #[test]
    fn commands_are_as_short_as_a_request_may_be() {
        let all = Submission { tasks: (0..20_000).collect(), array_limit: 10_000, ..example() };
        assert_eq!(aws_batch_job(&all, "spot", "enfilade:3").len(), 2);
        let every_other = Submission { tasks: (0..20_000).step_by(2).collect(), array_limit: 10_000, ..example() };
        let requests = aws_batch_job(&every_other, "spot", "enfilade:3");
        let count: u64 = requests.iter().filter_map(|request| request["arrayProperties"]["size"].as_u64()).sum();
        assert_eq!(count, 10_000);
        assert!(requests.iter().all(|request| request["containerOverrides"].to_string().len() < 8192));
    }
}
