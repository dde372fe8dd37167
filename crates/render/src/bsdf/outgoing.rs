//! How the light that leaves a diffuse surface depends on the direction it leaves in, where that is independent of where the light came
//! from: what lets one path's light be sent to other viewers.

use super::coat::Coat;
use super::layers::Layers;

/// How diffusely reflected light depends on the viewer.
#[derive(Clone, Copy, Debug)]
pub struct Outgoing<'a> {
    /// The coat that it passes on its way out.
    pub(super) coat: Option<Coat<'a>>,
    pub(super) layers: Option<Layers>,
}

impl Outgoing<'_> {
    /// The same radiance in all directions.
    pub(super) const EVEN: Self = Self { coat: None, layers: None };

    /// What radiance towards a viewer at this cosine is in proportion to.
    #[inline]
    pub fn factor(&self, cos_o: f32) -> f32 {
        let coat = self.coat.map_or(1.0, |coat| coat.transmittance(cos_o));
        coat * self.layers.map_or(1.0, |layers| layers.passes(cos_o, 1.0))
    }
}
