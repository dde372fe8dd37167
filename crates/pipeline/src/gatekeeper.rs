//! Judges views by their geometry: for `gate`, which decides what is rendered, and for `plan`, which looks for views that pass.

use crate::error::Error;
use crate::world::World;
use enfilade_explore::Surroundings;
use enfilade_frame::Layer;
use enfilade_render::{Look, Lookout};
use enfilade_scene::{CameraView, Scene, StartCamera};
use enfilade_show::picture::Picture;
use enfilade_show::thumbnail::thumbnail;
use enfilade_verify::view_gates::{GateConfig, Place, ViewGate, ViewMeasures};

/// Views are first measured through about this many of their columns, and in full only where a measure is close to its limit.
const COLUMNS: u32 = 256;

/// Everything needed to judge views of a scene.
pub(crate) struct Gatekeeper<'a> {
    lookout: Lookout<'a>,
    around: Surroundings<'a>,
    config: &'a GateConfig,
}

/// A judged view.
pub(crate) struct Judgement {
    pub measures: ViewMeasures,
    /// The worst fault.
    pub fault: Option<ViewGate>,
}

impl<'a> Gatekeeper<'a> {
    pub fn new(scene: &'a Scene, world: &'a World, starts: &[StartCamera], config: &'a GateConfig) -> Result<Self, Error> {
        let positions: Vec<_> = starts.iter().map(|start| start.position).collect();
        let around = Surroundings::new(&world.mesh, &world.bvh, &positions);
        Ok(Self { lookout: Lookout::new(scene).map_err(Error::stage)?, around, config })
    }

    /// Judges a view: through some of its pixels, and in full where that might change the outcome.
    pub fn judge(&self, view: &CameraView<'_>) -> Judgement {
        let position = view.pose().position;
        let enclosed_share = self.around.enclosed_share(position, self.config.enclosed_m);
        let place = Place { enclosed_share, open_share: self.around.open_shares(position)[0] };
        let step = step(view);
        let mut measures = self.measure(&self.lookout.look(view, step), place);
        if step > 1 && self.config.is_close(&measures) {
            measures = self.measure(&self.lookout.look(view, 1), place);
        }
        Judgement { measures, fault: self.config.fault(&measures) }
    }

    /// Judges a view, and shows what it sees if it has a fault.
    pub fn judged(&self, view: &CameraView<'_>) -> (Judgement, Option<Picture>) {
        let judgement = self.judge(view);
        let picture = judgement.fault.map(|_| self.thumbnail(view));
        (judgement, picture)
    }

    /// A small picture of what a view shows.
    fn thumbnail(&self, view: &CameraView<'_>) -> Picture {
        let look = self.lookout.look(view, step(view));
        thumbnail(&look.frame, &self.wrong_side(&look))
    }

    fn measure(&self, look: &Look, place: Place) -> ViewMeasures {
        ViewMeasures::new(&look.frame, &self.wrong_side(look), look.seeing, place, self.config.min_depth_m)
    }

    /// By pixel, whether it shows the back of something that has a front.
    fn wrong_side(&self, look: &Look) -> Vec<bool> {
        let Some(parts) = look.frame.get(Layer::RenderEntityId) else { return vec![false; look.behind.len()] };
        let has_front = |i: usize| self.around.has_front().get(parts.get(i) as usize - 1).copied().unwrap_or(false);
        look.behind.iter().enumerate().map(|(i, behind)| *behind && has_front(i)).collect()
    }
}

/// Distance in pixels of the columns and rows that a view is first measured through.
fn step(view: &CameraView<'_>) -> u32 {
    view.camera().size()[0].div_ceil(COLUMNS).max(1)
}
