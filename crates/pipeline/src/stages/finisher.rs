//! Finishing a frame on the machine that rendered it, if the rest of the dataset is made elsewhere: labels, denoised colour, laws, visible
//! instances, and pictures.

use super::{Job, denoise, label, made};
use crate::error::Error;
use crate::report::StageCx;
use enfilade_dataset::FrameTime;
use enfilade_verify::FrameVerifier;
use std::path::PathBuf;

/// A frame that [`render_part`](crate::render_part) has made.
#[derive(Clone, Debug)]
pub struct FinishedFrame {
    /// Trajectory of the frame.
    pub camera: String,
    /// Number of the frame.
    pub frame: u32,
    /// Files of the frame, relative to the dataset's folder: layers, labels, pictures, and the records that vouch for them.
    pub files: Vec<PathBuf>,
    /// The laws of verification that it breaks; normally none.
    pub broken: Vec<&'static str>,
    /// Time and memory that it took.
    pub time: FrameTime,
}

/// Data for finishing the frames of a scene.
pub(crate) struct FrameFinisher {
    known: label::Known,
    furniture: made::Furniture,
    verifier: FrameVerifier,
}

/// Reads the data for finishing frames.
pub(crate) fn frame_finisher(job: &Job, cx: &StageCx) -> Result<FrameFinisher, Error> {
    let known = label::known(job, cx)?.0;
    let furniture = made::Furniture::of(job)?;
    Ok(FrameFinisher { known, furniture, verifier: FrameVerifier::new(job.dataset, &job.scene.name) })
}

impl FrameFinisher {
    /// Finishes a frame that was rendered.
    pub fn finish(&self, job: &Job, camera: &str, frame: u32) -> Result<FinishedFrame, Error> {
        let (dataset, name) = (job.dataset, &job.scene.name);
        label::label_frame(job, camera, frame, &self.known, &self.known.hash().0)?;
        denoise::make_color(job, camera, frame)?;
        let extra = made::make(job, camera, frame, &self.furniture)?;
        let times = dataset.read_times().map_err(Error::stage)?;
        let time = times.get(&(name.clone(), camera.to_string(), frame)).copied().unwrap_or_default();
        let broken = self.verifier.broken_laws(dataset, camera, frame);
        Ok(FinishedFrame { camera: camera.into(), frame, files: files(job, camera, frame, extra)?, broken, time })
    }
}

/// The files of a frame, relative to the dataset's folder; every record after the files that it vouches for, and the frame's record at the
/// end.
fn files(job: &Job, camera: &str, frame: u32, extra: Vec<PathBuf>) -> Result<Vec<PathBuf>, Error> {
    let (dataset, layout, name) = (job.dataset, job.dataset.layout(), &job.scene.name);
    let rendered = dataset.frame_record(name, camera, frame).map_err(Error::stage)?.map(|record| record.files);
    let labelled = dataset.label_record(name, camera, frame).map_err(Error::stage)?.map(|record| record.files);
    let records = [(labelled, layout.label_record(name, camera, frame)), (rendered, layout.frame_record(name, camera, frame))];
    let mut files = extra;
    for (layers, record) in records {
        let Some(layers) = layers else { continue };
        files.extend(layers.keys().map(|file| layout.scene_dir(name).join(file)));
        files.push(record);
    }
    Ok(files.iter().map(|path| path.strip_prefix(job.out()).unwrap_or(path).into()).collect())
}
