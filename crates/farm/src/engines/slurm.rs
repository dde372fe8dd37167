//! Slurm: a job array per at most [`Submission::array_limit`] tasks.
//!
//! A task is tried again by the script itself, since a site's `RequeueExit` is not the user's to set. It names the element by array
//! and index: `scontrol requeue $SLURM_JOB_ID` would start every element again where it is the array's last.

use super::Submission;
use enfilade_dataset::quoted;
use std::fmt::Write;

/// One batch script per array.
pub fn slurm_scripts(submission: &Submission) -> Vec<String> {
    submission.arrays().iter().map(|tasks| script(submission, tasks)).collect()
}

/// The script that collects the dataset into `out` when the arrays have ended.
pub fn slurm_collect_script(submission: &Submission, out: &str) -> String {
    let mut text = head(submission, &format!("{}-collect", submission.name));
    let _ = writeln!(text, "\n{} farm collect {} -o {}", quoted(&submission.program), quoted(&submission.store), quoted(out));
    text
}

fn head(submission: &Submission, name: &str) -> String {
    let mut text = String::from("#!/bin/bash\n");
    let mut option = |option: String| {
        let _ = writeln!(text, "#SBATCH --{option}");
    };
    option(format!("job-name={name}"));
    option(format!("cpus-per-task={}", submission.cpus));
    option(format!("mem={}M", submission.memory_mib));
    option(format!("time={}", submission.minutes));
    text
}

fn script(submission: &Submission, tasks: &[u32]) -> String {
    let mut text = head(submission, &submission.name);
    let at_once = submission.at_once.map_or(String::new(), |n| format!("%{n}"));
    let _ = writeln!(text, "#SBATCH --array=0-{}{at_once}", tasks.len().saturating_sub(1));
    text.push_str("#SBATCH --requeue\n#SBATCH --signal=B:TERM@90\n#SBATCH --open-mode=append\n\n");
    let numbers: Vec<String> = tasks.iter().map(u32::to_string).collect();
    let _ = writeln!(text, "tasks=({})", numbers.join(" "));
    let (program, store) = (quoted(&submission.program), quoted(&submission.store));
    let _ = writeln!(
        text,
        "{program} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" farm work {store} --task \"${{tasks[SLURM_ARRAY_TASK_ID]}}\" --scratch \"{}\" &",
        submission.scratch
    );
    let _ = write!(
        text,
        "worker=$!\n\
         # Slurm tells this script alone that time is over; the worker then keeps what it has.\n\
         trap 'kill -TERM \"$worker\" 2>/dev/null' TERM\n\
         wait \"$worker\"\n\
         code=$?\n\
         while kill -0 \"$worker\" 2>/dev/null; do wait \"$worker\"; code=$?; done\n\
         # 75: another try may succeed; 128 and more: it was killed.\n\
         if {{ [ \"$code\" -eq 75 ] || [ \"$code\" -ge 128 ]; }} && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt {} ]; then\n  \
           scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}\" && sleep 120\n\
         fi\n\
         exit \"$code\"\n",
        submission.attempts.saturating_sub(1)
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engines::example;

    #[test]
    fn an_element_knows_its_task_and_is_tried_again_alone() {
        let scripts = slurm_scripts(&example());
        assert_eq!(scripts.len(), 1);
        let script = &scripts[0];
        for line in [
            "#SBATCH --array=0-3%6",
            "#SBATCH --mem=4096M",
            "tasks=(0 1 2 7)",
            "enfilade --threads \"${SLURM_CPUS_PER_TASK:-1}\" farm work s3://bucket/rooms --task \"${tasks[SLURM_ARRAY_TASK_ID]}\" --scratch \"/tmp/enfilade-farm\" &",
            "  scontrol requeue \"${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}\" && sleep 120",
        ] {
            assert!(script.lines().any(|found| found == line), "{line:?} is not in\n{script}");
        }
        assert!(!script.contains("requeue \"$SLURM_JOB_ID\""));
    }

    #[test]
    fn more_tasks_than_an_array_holds_become_several() {
        let scripts = slurm_scripts(&Submission { array_limit: 3, ..example() });
        assert_eq!(scripts.len(), 2);
        assert!(scripts[1].contains("--array=0-0%6") && scripts[1].contains("tasks=(7)"), "{}", scripts[1]);
    }

    #[test]
    fn words_with_quotes_reach_the_program_whole() {
        let script = slurm_collect_script(&example(), "it's here");
        assert!(script.ends_with("enfilade farm collect s3://bucket/rooms -o 'it'\\''s here'\n"), "{script}");
    }
}
