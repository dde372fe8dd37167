//! `[render]`: the options of light transport, and what else a scene's pictures are made with.

use enfilade_dataset::ColorKind;
use enfilade_options::keys;
use enfilade_render::RenderKeys;
use std::ops::Range;
use toml::Spanned;

keys! {
    /// `[render]`.
    pub(super) struct RenderSection {
        /// Width and height of the pictures, pixels.
        pub size: Option<Spanned<[u32; 2]>>,
        /// Horizontal field of view, degrees; without it that of the first start camera.
        pub fov_x_deg: Option<Spanned<f64>>,
        /// Wall-clock seconds that a frame may take; it then ends with the samples that it has.
        pub time_limit_s: Option<Spanned<f64>>,
        /// Wall-clock seconds between the moments when a frame in the making is saved.
        pub save_every_s: Option<Spanned<f64>>,
        /// What `color`, `diffuse_illumination` and `residual` hold.
        pub color: Option<Spanned<ColorKind>>,
        /// Where color is denoised, keeps what was rendered beside it, as layers named `*_rendered`.
        pub keep_rendered: Option<Spanned<bool>>,
    } with {
        pub transport: RenderKeys,
    }
}

impl RenderSection {
    /// Place of the value of the key `name`, if it is there and its range is checked.
    pub fn span(&self, name: &str) -> Option<Range<usize>> {
        let own = match name {
            "size" => self.size.as_ref().map(Spanned::span),
            "fov_x_deg" => self.fov_x_deg.as_ref().map(Spanned::span),
            "time_limit_s" => self.time_limit_s.as_ref().map(Spanned::span),
            "save_every_s" => self.save_every_s.as_ref().map(Spanned::span),
            _ => None,
        };
        own.or_else(|| self.transport.span(name))
    }
}
