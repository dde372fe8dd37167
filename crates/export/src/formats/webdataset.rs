//! WebDataset: `shard-NNNNNN.tar`, in which the files of a sample follow each other and differ only in their extensions.
//!
//! A sample is a frame; its key is `<scene>/<camera>/IIII`. Members are `color.png` (tone-mapped), `<layer>.npy` for every layer with the
//! dataset's own values, and `json` with pose and calibration. Headers of the archive carry no time, user or group.

use crate::ExportError;
use crate::calibration::{Calibration, Distortion};
use crate::export_folder::ExportFolder;
use crate::numpy::npy;
use crate::picture::color_png;
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::Layer;
use serde::Serialize;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

/// Bytes that a tar file adds to a member: its header, and the padding of the last block of 512 bytes.
const MEMBER_OVERHEAD: u64 = 1024;

#[derive(Serialize)]
struct SampleInfo<'s> {
    scene: &'s str,
    camera: &'s str,
    frame: u32,
    width: u32,
    height: u32,
    model: &'static str,
    #[serde(rename = "K")]
    k: Option<[[f64; 3]; 3]>,
    distortion: Vec<f64>,
    world_from_camera: [[f64; 4]; 4],
}

/// Files of a sample: name and content.
type Sample = Vec<(String, Vec<u8>)>;

pub(crate) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder, shard_bytes: u64) -> Result<(), ExportError> {
    let views: Vec<View<'_>> = selected.views().collect();
    let mut shards = Shards { out, limit: shard_bytes, count: 0, current: None };
    // As many samples as threads at a time: a sample of all layers at 1024 x 768 has 70 MB.
    for batch in views.chunks(rayon::current_num_threads()) {
        for sample in selected.each_of(batch, |view| sample(selected, view))? {
            shards.add(&sample)?;
        }
    }
    shards.close()
}

fn sample(selected: &SelectedFrames<'_>, view: View<'_>) -> Result<Sample, ExportError> {
    let frame = selected.read_all(view)?;
    let key = format!("{}/{:04}", view.track.folder(), view.frame());
    let mut files = Vec::new();
    if frame.get(Layer::Color).is_some() {
        files.push((format!("{key}.color.png"), color_png(selected, view, &frame)?));
    }
    for (layer, values) in frame.iter() {
        let shape = [frame.height as usize, frame.width as usize, layer.spec().channels];
        let shape = if shape[2] == 1 { &shape[..2] } else { &shape[..] };
        files.push((format!("{key}.{}.npy", layer.spec().name), npy(values, shape)));
    }
    files.push((format!("{key}.json"), serde_json::to_vec(&info(view, frame.width, frame.height)).expect("plain data encodes")));
    Ok(files)
}

fn info(view: View<'_>, width: u32, height: u32) -> SampleInfo<'_> {
    let calibration = Calibration::of(view.track);
    let (model, distortion) = match calibration.as_ref().map(|c| &c.distortion) {
        None => ("rays", Vec::new()),
        Some(Distortion::None) => ("pinhole", Vec::new()),
        Some(Distortion::RadialTangential(d)) => ("opencv", d.to_vec()),
        Some(Distortion::Fisheye(d)) => ("opencv_fisheye", d.to_vec()),
    };
    SampleInfo {
        scene: &view.track.scene,
        camera: &view.track.name,
        frame: view.frame(),
        width,
        height,
        model,
        k: calibration.as_ref().map(|c| c.intrinsics.opencv_k()),
        distortion,
        world_from_camera: calibration.map_or_else(|| Calibration::opencv_pose_of(view.pose()), |c| c.opencv_pose(view)),
    }
}

/// The archives, one after the other.
struct Shards<'p> {
    out: &'p ExportFolder,
    limit: u64,
    count: usize,
    current: Option<Shard>,
}

struct Shard {
    path: PathBuf,
    archive: tar::Builder<BufWriter<File>>,
    bytes: u64,
}

impl Shards<'_> {
    /// Appends a sample, in a new shard where the current one would become too large.
    fn add(&mut self, sample: &Sample) -> Result<(), ExportError> {
        let bytes = sample.iter().map(|(_, content)| content.len() as u64 + MEMBER_OVERHEAD).sum::<u64>();
        if self.current.as_ref().is_some_and(|shard| shard.bytes + bytes > self.limit) {
            self.close()?;
        }
        if self.current.is_none() {
            let path = self.out.path(&format!("shard-{:06}.tar", self.count))?;
            let file = File::create(&path).map_err(ExportError::at("write", &path))?;
            self.current = Some(Shard { path, archive: tar::Builder::new(BufWriter::new(file)), bytes: 0 });
            self.count += 1;
        }
        let Some(shard) = &mut self.current else { return Ok(()) };
        shard.bytes += bytes;
        sample
            .iter()
            .try_for_each(|(name, content)| append(&mut shard.archive, name, content))
            .map_err(ExportError::at("write", &shard.path))
    }

    /// Ends the current shard.
    fn close(&mut self) -> Result<(), ExportError> {
        let Some(shard) = self.current.take() else { return Ok(()) };
        let mut writer = shard.archive.into_inner().map_err(ExportError::at("write", &shard.path))?;
        writer.flush().map_err(ExportError::at("write", &shard.path))?;
        let bytes = writer.get_ref().metadata().map_err(ExportError::at("write", &shard.path))?.len();
        self.out.count(bytes);
        Ok(())
    }
}

fn append(archive: &mut tar::Builder<BufWriter<File>>, name: &str, content: &[u8]) -> std::io::Result<()> {
    let mut header = tar::Header::new_gnu();
    header.set_size(content.len() as u64);
    header.set_mode(0o644);
    header.set_mtime(0);
    header.set_uid(0);
    header.set_gid(0);
    archive.append_data(&mut header, name, content)
}
