//! Kubernetes: an Indexed Job. Losing a node costs no retry, permanent failures are not retried, and every index has retries of
//! its own (Kubernetes 1.33 or later).

use super::{Submission, nth_task};
use serde_json::{Value, json};

/// The manifest, as JSON, which `kubectl apply -f` takes. `image` contains the program.
pub fn kubernetes_job(submission: &Submission, image: &str) -> Value {
    let tasks: Vec<u32> = submission.tasks.iter().copied().collect();
    let count = tasks.len();
    json!({
        "apiVersion": "batch/v1",
        "kind": "Job",
        "metadata": { "name": submission.name },
        "spec": {
            "completionMode": "Indexed",
            "completions": count,
            "parallelism": submission.at_once.map_or(count, |n| count.min(n as usize)),
            "backoffLimitPerIndex": submission.attempts.saturating_sub(1),
            "maxFailedIndexes": count,
            "podFailurePolicy": { "rules": [
                { "action": "FailIndex", "onExitCodes": { "containerName": "worker", "operator": "In", "values": [65] } },
                { "action": "Ignore", "onPodConditions": [{ "type": "DisruptionTarget", "status": "True" }] },
            ] },
            "template": { "spec": {
                "restartPolicy": "Never",
                "terminationGracePeriodSeconds": 90,
                "containers": [{
                    "name": "worker",
                    "image": image,
                    // The index counts the missing tasks.
                    "command": nth_task(submission, &tasks, "/scratch"),
                    "resources": {
                        "requests": { "cpu": submission.cpus.to_string(), "memory": format!("{}Mi", submission.memory_mib) },
                        "limits": { "memory": format!("{}Mi", submission.memory_mib) },
                    },
                    "volumeMounts": [{ "name": "scratch", "mountPath": "/scratch" }],
                }],
                "volumes": [{ "name": "scratch", "emptyDir": {} }],
            } },
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engines::example;

    #[test]
    fn every_index_is_a_missing_task() {
        let job = kubernetes_job(&example(), "registry/enfilade:1");
        assert_eq!(job["spec"]["completions"], 4);
        assert_eq!(job["spec"]["parallelism"], 4);
        assert_eq!(job["spec"]["backoffLimitPerIndex"], 3);
        let command = job["spec"]["template"]["spec"]["containers"][0]["command"].as_array().unwrap();
        assert_eq!(command[6..9], ["--task", "0-2,7", "--nth"]);
    }
}
