//! The sections of `dataset.toml` that say how stages work: every key is optional, and what is there replaces the value below.

use enfilade_dataset::ColorKind;
use enfilade_explore::{CarveConfig, Mode, PlanConfig, Saliency};
use enfilade_render::{Filter, RenderConfig};
use enfilade_verify::view_gates::{GateAction, GateConfig};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

/// Defines a section: its keys are the named fields of the target, with the same types.
macro_rules! section {
    ($name:ident => $target:ty { $($(#[$attribute:meta])* $field:ident: $type:ty),* $(,)? } $(with { $($(#[$doc:meta])* $extra:ident: $extra_type:ty),* $(,)? })?) => {
        #[derive(Clone, Debug, Default, Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub(super) struct $name {
            $($($(#[$doc])* pub $extra: Option<Spanned<$extra_type>>,)*)?
            $($(#[$attribute])* pub $field: Option<Spanned<$type>>,)*
        }

        impl $name {
            /// Lays the keys that are there over `target`.
            #[allow(clippy::clone_on_copy, clippy::useless_conversion, reason = "not every field is Copy; optional fields take their values")]
            pub fn apply(&self, target: &mut $target) {
                $(if let Some(value) = &self.$field {
                    target.$field = value.get_ref().clone().into();
                })*
            }

            /// Where the value of the key `name` stands, if it is there.
            pub fn span(&self, name: &str) -> Option<Range<usize>> {
                let spans = [
                    $((stringify!($field), self.$field.as_ref().map(Spanned::span)),)*
                    $($((stringify!($extra), self.$extra.as_ref().map(Spanned::span)),)*)?
                ];
                spans.into_iter().find(|(key, _)| *key == name)?.1
            }
        }
    };
}

section!(RenderPatch => RenderConfig {
    samples: u32,
    adaptive: bool,
    noise: f32,
    guiding: bool,
    max_bounces: u32,
    clamp: f32,
    /// Keeps the light of each pixel apart by its way and by its source, as layers of their own. Changes no other layer.
    // `splits` in the files of 0.1.0.
    #[serde(alias = "splits")]
    light_parts: bool,
    fixtures: bool,
    extra: bool,
    lambertian: bool,
    roulette_start: u32,
    filter: Filter,
    filter_radius: f32,
} with {
    /// Width and height of the pictures, pixels.
    size: [u32; 2],
    /// Horizontal field of view, degrees; without it that of the first start camera.
    fov_x_deg: f64,
    /// Wall-clock seconds that a frame may take; it then ends with the samples that it has.
    time_limit_s: f64,
    /// Wall-clock seconds between the moments when a frame in the making is saved.
    save_every_s: f64,
    /// What `color`, `diffuse_illumination` and `residual` hold.
    color: ColorKind,
    /// Where color is denoised, keeps what was rendered beside it, as layers named `*_rendered`.
    keep_rendered: bool,
});

section!(CarvePatch => CarveConfig { voxel_m: f64, extent_m: f64, rays: u32, iterations: u32, keep_outside: bool });

section!(GatePatch => GateConfig {
    action: GateAction,
    max_void_share: f64,
    enclosed_m: f64,
    max_enclosed_share: f64,
    max_open_share: f64,
    max_back_face_share: f64,
    min_depth_m: f64,
    max_near_share: f64,
    min_depth_range_m: f64,
    max_plane_share: f64,
    max_invalid_share: f64,
});

// The frames are a key of the level above; the test images have the field of view and the shape of the pictures.
section!(PlanPatch => PlanConfig {
    mode: Mode,
    candidates: u32,
    queries: u32,
    step_m: [f64; 3],
    height_range_m: f64,
    camera_height_m: [f64; 2],
    level: bool,
    pitch_limits_deg: [f64; 2],
    clearance_m: f64,
    min_look_distance_m: f64,
    roll_limit_deg: f64,
    overlap: [f64; 2],
    max_void_share: f64,
    max_back_face_share: f64,
    min_depth_m: f64,
    max_near_share: f64,
    max_open_share: f64,
    test_width: u32,
    saliency: Saliency,
});
