//! `preset`: carving, planning, rendering and gates in one word.
//!
//! A preset takes the place of the built-in defaults, so every key of the file wins over it, wherever that stands. Only keys of `[plan]`
//! for rules that the preset does not have are refused beside it: they would change nothing.

use super::document::LevelKeys;
use super::settings::SceneConfig;
use enfilade_dataset::LOADER_SIZE;
use enfilade_explore::{Mode, PhotosConfig, PlanConfig, Preset};
use enfilade_verify::view_gates::GateAction;
use std::ops::Range;

/// The width of Hypersim's pictures, which makes the focal length that its loaders take for granted, [`enfilade_dataset::LOADER_FOCAL_PX`].
const FOV_X_DEG: f64 = 60.0;

/// Keys of `[plan]` for rules that are ours alone, ...
const OURS: [&str; 11] = [
    "camera_height_m",
    "level",
    "pitch_limits_deg",
    "clearance_m",
    "min_look_distance_m",
    "overlap",
    "max_void_share",
    "max_back_face_share",
    "min_depth_m",
    "max_near_share",
    "max_open_share",
];

/// ... and for what the published program has no choice of.
const NOT_THE_PROGRAMS: [&str; 2] = ["roll_limit_deg", "saliency"];

/// Lays the choices of a preset over the built-in defaults of a scene, whose camera is there already.
pub(super) fn lay_over(preset: Preset, scene: &mut SceneConfig) {
    (scene.carve.preset, scene.plan.preset) = (preset, preset);
    if preset == Preset::Default {
        return;
    }
    scene.size = LOADER_SIZE;
    scene.fov_x_deg = scene.camera.takes_field_of_view().then_some(FOV_X_DEG);
    scene.gate.action = GateAction::Report;
    if preset == Preset::Paper {
        scene.plan.clearance_m = 0.0;
    }
}

/// Keys of `[plan]` that only modes other than photos take.
const OF_OTHER_MODES: [&str; 5] = ["queries", "step_m", "height_range_m", "overlap", "saliency"];

/// Views of homes are photos by default: where no level has a key that photos do not take, and no preset says that they are walks.
pub(super) fn photograph(plan: &mut PlanConfig, levels: &[&LevelKeys]) {
    let takes_others = |level: &&LevelKeys| OF_OTHER_MODES.iter().any(|key| level.plan.span(key).is_some());
    if plan.preset == Preset::Default && !levels.iter().any(takes_others) {
        plan.mode = Mode::Photos(PhotosConfig::default());
    }
}

/// A key of `[plan]` that says something about a rule which the preset does not have, and where it stands.
pub(super) fn unused_key(preset: Preset, level: &LevelKeys) -> Option<(&'static str, Range<usize>)> {
    let unused: Vec<&'static str> = match preset {
        Preset::Default => return None,
        Preset::Paper => OURS.to_vec(),
        Preset::Hypersim => [OURS.as_slice(), &NOT_THE_PROGRAMS].concat(),
    };
    unused.into_iter().find_map(|key| Some((key, level.plan.span(key)?)))
}
