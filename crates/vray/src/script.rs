//! A job's steps as a script for one machine. The variables VRAY, IMAPVIEWER and VRIMG2EXR have the paths of the programs.

use crate::edit::Platform;
use crate::job_file::{Job, JobStep};

/// The script: it stops at the first step that fails.
pub(crate) fn write(job: &Job, platform: Platform) -> String {
    let mut lines = match platform {
        Platform::Unix => vec![
            "#!/bin/sh".to_string(),
            "# Renders the job beside this file with V-Ray. Set VRAY, IMAPVIEWER and VRIMG2EXR where the programs are not in the PATH."
                .into(),
            "set -e".into(),
            ": \"${VRAY:=vray}\" \"${IMAPVIEWER:=imapviewer}\" \"${VRIMG2EXR:=vrimg2exr}\"".into(),
        ],
        Platform::Windows => vec![
            "@echo off".to_string(),
            "rem Renders the job beside this file with V-Ray. Set VRAY, IMAPVIEWER and VRIMG2EXR where the programs are not in the PATH."
                .into(),
            "if not defined VRAY set VRAY=vray".into(),
            "if not defined IMAPVIEWER set IMAPVIEWER=imapviewer".into(),
            "if not defined VRIMG2EXR set VRIMG2EXR=vrimg2exr".into(),
        ],
    };
    for camera in &job.cameras {
        for step in &camera.steps {
            lines.push(String::new());
            lines.push(match platform {
                Platform::Unix => format!("echo {}", unix(&format!("{}: {}", camera.camera, step.step))),
                Platform::Windows => format!("echo {}: {}", camera.camera, step.step),
            });
            match platform {
                Platform::Unix => lines.extend(unix_step(step)),
                Platform::Windows => lines.extend(windows_step(step)),
            }
        }
    }
    let end = if platform == Platform::Windows { "\r\n" } else { "\n" };
    lines.push(String::new());
    lines.join(end)
}

fn unix_step(step: &JobStep) -> Vec<String> {
    let folders = step.folders.iter().map(|folder| format!("mkdir -p {}", unix(folder)));
    let arguments: Vec<String> = step.command.iter().skip(1).chain(&step.frames).map(|argument| unix(argument)).collect();
    folders.chain([format!("\"${}\" {}", variable(step), arguments.join(" "))]).collect()
}

fn windows_step(step: &JobStep) -> Vec<String> {
    let folders = step.folders.iter().map(|folder| format!("if not exist \"{folder}\" mkdir \"{folder}\""));
    let arguments: Vec<String> = step.command.iter().skip(1).chain(&step.frames).map(|argument| format!("\"{argument}\"")).collect();
    let command = format!("\"%{}%\" {} || exit /b 1", variable(step), arguments.join(" "));
    folders.chain([command]).collect()
}

/// The variable with the path of a program.
fn variable(step: &JobStep) -> String {
    step.command.first().map_or(String::new(), |program| program.to_ascii_uppercase())
}

/// An argument that the shell does not change.
fn unix(argument: &str) -> String {
    format!("'{}'", argument.replace('\'', r"'\''"))
}
