//! Flow between any two frames of a scene, of one camera or of two, forward and backward in time: the layers `optical_flow`, `scene_flow`
//! and `flow_visibility` of a frame with another one in the place of the next. For the next they have the same bits.

use crate::{Filmed, MultiviewError, ScenePackage};
use enfilade_dataset::FramePair;
use enfilade_render::FlowTo;
use enfilade_scene::Cx;

impl Filmed<'_> {
    /// The frame of that camera and number.
    pub fn find(&self, camera: &str, number: u32) -> Option<usize> {
        (0..self.len()).find(|&frame| self.name(frame) == (camera, number))
    }

    /// Each frame with the one `step` poses later in its trajectory (earlier if negative), if that exists.
    pub fn steps(&self, step: i64) -> Vec<[usize; 2]> {
        let later = |frame: usize| {
            let (track, index) = self.frames[frame];
            let pose = usize::try_from(index as i64 + step).ok()?;
            Some([frame, self.frames.iter().position(|&other| other == (track, pose))?])
        };
        (0..self.len()).filter_map(later).collect()
    }

    /// Two frames by their names.
    pub fn pair(&self, frames: [usize; 2]) -> FramePair {
        let [first, second] = frames.map(|frame| {
            let (camera, number) = self.name(frame);
            (camera.to_string(), number)
        });
        FramePair { scene: self.scene.clone(), first, second }
    }
}

/// Writes the layers that lead from the first frame of each pair to the second.
///
/// # Errors
/// When the scene cannot be used, or a file cannot be written.
pub fn write_flow(filmed: &Filmed<'_>, package: &ScenePackage, pairs: &[[usize; 2]], cx: &dyn Cx) -> Result<(), MultiviewError> {
    let still = package.scene.is_still().then(|| package.lookout()).transpose()?;
    let total = pairs.len() as u64;
    for (done, &[first, second]) in pairs.iter().enumerate() {
        cx.progress("pairs", done as u64, total);
        let (from, to) = (filmed.view(first), filmed.view(second));
        let layers = match &still {
            Some(lookout) => lookout.flow(&from, FlowTo::still(&to)),
            None => {
                let [here, there] = [first, second].map(|frame| filmed.moments(&package.scene, frame));
                let moved = package.ready(&there)?.moved(filmed.ways(&package.scene, [first, second]));
                package.ready(&here)?.flow(&from, FlowTo { view: &to, moved: Some(&moved) })
            }
        };
        filmed.dataset.write_pair_layers(&filmed.pair([first, second]), &layers)?;
    }
    cx.progress("pairs", total, total);
    Ok(())
}
