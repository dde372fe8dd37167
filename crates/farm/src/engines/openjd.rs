//! Open Job Description, which AWS Deadline Cloud runs: a template with a step that renders and one that collects.

use super::Submission;
use crate::print_ranges;
use serde_json::{Value, json};

/// The template, as JSON. Tasks are handed out in chunks that grow or shrink to about a quarter of an hour.
pub fn openjd_template(submission: &Submission) -> Value {
    let arguments = |words: &[&str]| words.iter().map(ToString::to_string).collect::<Vec<_>>();
    json!({
        "specificationVersion": "jobtemplate-2023-09",
        "extensions": ["TASK_CHUNKING"],
        "name": submission.name,
        "parameterDefinitions": [
            { "name": "Store", "type": "STRING", "default": submission.store, "description": "Place of the job" },
            { "name": "Program", "type": "STRING", "default": submission.program, "description": "enfilade on the worker" },
            { "name": "Dataset", "type": "STRING", "default": "dataset", "description": "Folder for the collected dataset" },
        ],
        "steps": [
            {
                "name": "Render",
                "hostRequirements": { "amounts": [
                    { "name": "amount.worker.vcpu", "min": submission.cpus },
                    { "name": "amount.worker.memory", "min": submission.memory_mib },
                ] },
                "parameterSpace": { "taskParameterDefinitions": [{
                    "name": "Task",
                    "type": "CHUNK[INT]",
                    "range": print_ranges(&submission.tasks),
                    "chunks": { "defaultTaskCount": 1, "targetRuntimeSeconds": 900, "rangeConstraint": "NONCONTIGUOUS" },
                }] },
                "script": { "actions": { "onRun": {
                    "command": "{{Param.Program}}",
                    "args": arguments(&[
                        "--threads", &submission.cpus.to_string(), "farm", "work", "{{Param.Store}}", "--task", "{{Task.Param.Task}}",
                        "--scratch", "{{Session.WorkingDirectory}}",
                    ]),
                    "timeout": 60 * submission.minutes.max(1),
                    "cancelation": { "mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": 90 },
                } } },
            },
            {
                "name": "Collect",
                "dependencies": [{ "dependsOn": "Render" }],
                "script": { "actions": { "onRun": {
                    "command": "{{Param.Program}}",
                    "args": arguments(&["farm", "collect", "{{Param.Store}}", "-o", "{{Param.Dataset}}"]),
                } } },
            },
        ],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engines::example;

    #[test]
    fn tasks_are_a_range_and_collecting_waits_for_them() {
        let template = openjd_template(&example());
        assert_eq!(template["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]["range"], "0-2,7");
        assert_eq!(template["steps"][1]["dependencies"][0]["dependsOn"], "Render");
    }
}
