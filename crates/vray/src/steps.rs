//! The commands of a job: V-Ray, `imapviewer` that merges indirect light, and `vrimg2exr`, with the options that they document.
//!
//! Indirect light is computed for every frame by itself (`pre`), merged into one light cache and one irradiance map per camera, and
//! taken from there by the final pass, so that it does not flicker. Merging is V-Ray's: its files have no public form.

use crate::edit::{GiFiles, Platform};
use crate::error::VrayError;
use crate::job_file::JobStep;
use enfilade_dataset::print_number_ranges;

/// The folder on the machine that renders.
pub(crate) struct Place {
    pub folder: String,
    pub platform: Platform,
}

impl Place {
    /// Checks that the path can be written in scenes and scripts.
    ///
    /// # Errors
    /// If it cannot, or is not absolute.
    pub fn new(folder: &str) -> Result<Self, VrayError> {
        let platform = Platform::of(folder);
        let bytes = folder.as_bytes();
        let absolute = match platform {
            Platform::Unix => folder.starts_with('/'),
            Platform::Windows => folder.starts_with(r"\\") || (bytes.get(1) == Some(&b':') && matches!(bytes.get(2), Some(b'/' | b'\\'))),
        };
        // These end strings in scenes and commands.
        if !absolute || folder.contains(['"', '%', '\n', '\r']) {
            let message = format!("{folder:?} is no absolute path that a scene and a script can hold");
            return Err(VrayError::usage(message, "name the job's folder on the machine that renders, such as /mnt/job or D:\\job"));
        }
        let folder = folder.trim_end_matches(['/', '\\']);
        let folder = if platform == Platform::Windows { folder.replace('/', "\\") } else { folder.into() };
        Ok(Self { folder, platform })
    }

    /// A path in the folder, written with slashes, as the machine writes it.
    pub fn path(&self, inside: &str) -> String {
        self.platform.join(&self.folder, &inside.replace('/', &self.platform.separator().to_string()))
    }

    /// Name of the script that renders.
    pub fn script(&self) -> &'static str {
        match self.platform {
            Platform::Unix => "render.sh",
            Platform::Windows => "render.bat",
        }
    }
}

/// Windows takes no command of more than 8191 characters from a script; the program and the options need some.
const MAX_COMMAND: usize = 7000;
/// `"-load" ""` and blanks.
const LOAD_LENGTH: usize = 12;

/// The steps for a camera, whose scene makes the files `gi` of indirect light; without any, `pre` has nothing to do.
pub(crate) fn steps(name: &str, shared: &str, frames: &[u32], gi: GiFiles, there: &Place) -> Vec<JobStep> {
    let images = |pass: &str| format!("images/scene_{name}_{pass}");
    let render = |pass: &str, extension: &str| JobStep {
        step: pass.into(),
        folders: vec![there.path(&images(pass)), there.path(shared)],
        command: vec![
            "vray".into(),
            format!("-sceneFile={}", there.path(&format!("vrscenes/scene_{name}_{pass}.vrscene"))),
            format!("-imgFile={}", there.path(&format!("{}/frame.{extension}", images(pass)))),
            "-display=0".into(),
            "-autoClose=1".into(),
        ],
        frames: Some(format!("-frames={}", print_number_ranges(frames.iter().copied(), ";"))),
    };
    let convert = |pass: &str| JobStep {
        step: "convert".into(),
        folders: Vec::new(),
        command: vec!["vrimg2exr".into(), there.path(&format!("{}/frame.*.vrimg", images(pass)))],
        frames: None,
    };
    let cache = |file: &str| there.path(&format!("{shared}/_hypersim_{file}"));
    let mut steps = vec![render("geometry", "vrimg")];
    let files =
        [(gi.light_cache, "light cache", "light_cache", "vrlmap"), (gi.irradiance_map, "irradiance map", "irradiance_map", "vrmap")];
    if files.iter().any(|(made, ..)| *made) {
        steps.push(render("pre", "jpg"));
    }
    for (_, what, file, extension) in files.into_iter().filter(|(made, ..)| *made) {
        let of_frame = |frame: &u32| format!("{}.{frame:04}.{extension}", cache(file));
        let merged = format!("{}.{extension}", cache(file));
        steps.extend(merge(&format!("merge {what}"), &frames.iter().map(of_frame).collect::<Vec<_>>(), &merged));
    }
    steps.extend([render("final", "vrimg"), convert("geometry"), convert("final")]);
    steps
}

/// Merges files into one, in as many commands as necessary: each continues from the result of the one before.
fn merge(step: &str, files: &[String], merged: &str) -> Vec<JobStep> {
    let mut steps = Vec::new();
    let mut rest = files;
    while !rest.is_empty() {
        let mut command = vec!["imapviewer".to_string(), "-incremental".into()];
        if !steps.is_empty() {
            command.extend(["-load".into(), merged.to_string()]);
        }
        let mut length = 2 * merged.len();
        let fits = |file: &&String| {
            length += file.len() + LOAD_LENGTH;
            length < MAX_COMMAND
        };
        let count = rest.iter().take_while(fits).count().max(1);
        command.extend(rest[..count].iter().flat_map(|file| ["-load".to_string(), file.clone()]));
        command.extend(["-save".into(), merged.to_string(), "-nodisplay".into()]);
        steps.push(JobStep { step: step.into(), folders: Vec::new(), command, frames: None });
        rest = &rest[count..];
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: GiFiles = GiFiles { light_cache: true, irradiance_map: true };

    #[test]
    fn frames_are_runs_as_v_ray_takes_them() {
        let there = Place::new("/mnt/job").unwrap();
        let list = |frames: &[u32]| steps("cam_00", "shared", frames, BOTH, &there)[0].frames.clone().unwrap();
        assert_eq!(list(&[0, 1, 2, 5, 7, 8]), "-frames=0-2;5;7-8");
        assert_eq!(list(&[4]), "-frames=4");
    }

    #[test]
    fn folders_are_absolute_on_their_own_platform() {
        let unix = Place::new("/mnt/job/").unwrap();
        assert_eq!((unix.path("images/a.vrimg"), unix.script()), ("/mnt/job/images/a.vrimg".into(), "render.sh"));
        let windows = Place::new(r"D:\job").unwrap();
        assert_eq!((windows.path("images/a.vrimg"), windows.script()), (r"D:\job\images\a.vrimg".into(), "render.bat"));
        assert_eq!(Place::new("D:/job").unwrap().path("a"), r"D:\job\a");
        assert!(Place::new(r"\\farm\job").is_ok());
        for wrong in ["job", r"D:job", "/mnt/\"job\"", "/mnt/100%", ""] {
            assert!(Place::new(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_step_comes_after_what_it_needs() {
        let there = Place::new("/mnt/job").unwrap();
        let steps = steps("cam_00", "shared/scene_cam_00", &[0, 3], BOTH, &there);
        let names: Vec<&str> = steps.iter().map(|step| step.step.as_str()).collect();
        assert_eq!(names, ["geometry", "pre", "merge light cache", "merge irradiance map", "final", "convert", "convert"]);
        let cache = |frame: &str| format!("/mnt/job/shared/scene_cam_00/_hypersim_light_cache{frame}.vrlmap");
        let (a, b, all) = (cache(".0000"), cache(".0003"), cache(""));
        assert_eq!(steps[2].command, ["imapviewer", "-incremental", "-load", &a, "-load", &b, "-save", &all, "-nodisplay"]);
        let many: Vec<u32> = (0..250).collect();
        let long = super::steps("cam_00", "shared/scene_cam_00", &many, BOTH, &there);
        let loads: Vec<&Vec<String>> = long.iter().filter(|step| step.step == "merge light cache").map(|step| &step.command).collect();
        assert!(loads.len() > 2 && loads.iter().all(|command| command.join("\" \"").len() < 8000));
        assert_eq!(loads.iter().flat_map(|c| c.iter()).filter(|a| a.contains("light_cache.0")).count(), 250);
        assert_eq!(
            (&loads[1][2..4], &loads[0][2..4]),
            (["-load".to_string(), all.clone()].as_slice(), ["-load".to_string(), a.clone()].as_slice())
        );
        assert_eq!(steps[4].frames.as_deref(), Some("-frames=0;3"));
        assert_eq!(steps[4].command[2], "-imgFile=/mnt/job/images/scene_cam_00_final/frame.vrimg");
        assert_eq!(steps[6].command[1], "/mnt/job/images/scene_cam_00_final/frame.*.vrimg");
    }

    #[test]
    fn light_that_is_not_kept_in_files_is_not_merged() {
        let there = Place::new("/mnt/job").unwrap();
        let names = |light_cache, irradiance_map| {
            let steps = steps("cam_00", "shared", &[0], GiFiles { light_cache, irradiance_map }, &there);
            steps.into_iter().map(|step| step.step).collect::<Vec<_>>()
        };
        assert_eq!(names(true, false), ["geometry", "pre", "merge light cache", "final", "convert", "convert"]);
        assert_eq!(names(false, true), ["geometry", "pre", "merge irradiance map", "final", "convert", "convert"]);
        assert_eq!(names(false, false), ["geometry", "final", "convert", "convert"]);
    }
}
