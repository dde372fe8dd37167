//! AWS Batch: an array job per at most 10,000 tasks, as `aws batch submit-job --cli-input-json` takes it.

use super::Submission;
use serde_json::{Value, json};

/// Children of one array job at most.
const MOST: u32 = 10_000;

/// One request per array job. `queue` and `definition` name what the account has; the definition's image holds the program.
pub fn aws_batch_job(submission: &Submission, queue: &str, definition: &str) -> Vec<Value> {
    let limited = Submission { array_limit: submission.array_limit.min(MOST), ..submission.clone() };
    limited.arrays().iter().enumerate().map(|(k, tasks)| request(&limited, k, tasks, queue, definition)).collect()
}

fn request(submission: &Submission, k: usize, tasks: &[u32], queue: &str, definition: &str) -> Value {
    let numbers: Vec<String> = tasks.iter().map(u32::to_string).collect();
    let look_up = format!(
        "set -- {}; shift \"${{AWS_BATCH_JOB_ARRAY_INDEX:-0}}\"; exec \"$0\" --threads \"$CPUS\" farm work \"$STORE\" --task \"$1\" --scratch /tmp/enfilade-farm",
        numbers.join(" ")
    );
    let mut request = json!({
        "jobName": format!("{}-{k}", submission.name),
        "jobQueue": queue,
        "jobDefinition": definition,
        "containerOverrides": {
            "command": ["sh", "-c", look_up, submission.program],
            "environment": [
                { "name": "STORE", "value": submission.store },
                { "name": "CPUS", "value": submission.cpus.to_string() },
            ],
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
}
