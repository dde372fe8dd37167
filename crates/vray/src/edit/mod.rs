//! The edits that Hypersim's toolkit makes to scenes of V-Ray before they are rendered, one file per purpose.
//!
//! Every function edits a [`Document`] in memory and returns what it did; settings that a scene lacks are added.
//! Constants are the toolkit's.
//!
//! ```
//! use enfilade_vray::edit;
//! use enfilade_vrscene::Document;
//!
//! let text = "FilterLanczos filter { size=2; }\nSettingsImageSampler sampler { type=3; filter=filter; }\n";
//! let mut scene = Document::parse(text.as_bytes()).unwrap();
//! let removed = edit::remove_kinds(&mut scene, &edit::IMAGE_FILTERS);
//! assert_eq!((removed.plugins, removed.references), (1, 1));
//! edit::reduce_quality(&mut scene);
//! assert_eq!(scene.of_kind("SettingsImageSampler").next().unwrap().parameter("type").unwrap().raw(), b"0");
//! ```

mod camera;
mod channels;
mod entities;
mod normalize;
mod passes;
mod paths;
mod quality;
mod removal;
mod strings;

pub use camera::{CameraKeyframe, CameraPath, LensTexture, set_camera};
pub use channels::{COLOR_CHANNELS, ColorChannel, add_color_channels, add_denoiser, add_geometry_channels, prepare_for_layers};
pub use entities::{Entity, EntityOptions, set_entity_ids};
pub use normalize::{Normalization, meters_per_asset_unit, normalize};
pub use passes::{GiCaches, GiFiles, Pass, gi_files, linear_output, make_pass, reduce_quality, reduce_size, save_gi_caches};
pub use paths::{FileReference, Platform, file_references, replace_paths};
pub use quality::{hypersim_quality, hypersim_surroundings};
pub use removal::{IMAGE_FILTERS, Removed, remove_kinds};
pub use strings::{NodeString, node_strings};

use enfilade_vrscene::{Document, Item, Plugin, Value};

/// Sets parameters of every plugin of a kind; adds one named `hypersim_<kind>` where the scene has none.
fn set_on_settings(scene: &mut Document, kind: &str, parameters: &[(&str, Value)]) {
    if scene.of_kind(kind).next().is_none() {
        scene.push(Plugin::new(kind, &format!("hypersim_{kind}")));
    }
    set_where_present(scene, kind, parameters);
}

/// Sets parameters of every plugin of a kind, if there is any.
fn set_where_present(scene: &mut Document, kind: &str, parameters: &[(&str, Value)]) {
    for plugin in scene.of_kind_mut(kind) {
        parameters.iter().for_each(|(name, value)| plugin.set(name, value));
    }
}

/// Adds a plugin, in place of one of its name.
fn add(scene: &mut Document, kind: &str, name: &str, parameters: &[(&str, Value)]) {
    scene.items.retain(|item| !matches!(item, Item::Plugin(plugin) if plugin.name() == name.as_bytes()));
    let mut plugin = Plugin::new(kind, name);
    parameters.iter().for_each(|(parameter, value)| plugin.set(parameter, value));
    scene.push(plugin);
}

/// A string value.
fn text(text: &str) -> Value {
    Value::Text(text.as_bytes().to_vec())
}
