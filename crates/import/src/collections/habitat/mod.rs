//! Scenes of Habitat: `*.scene_instance.json` with the dataset's configuration, as HSSD-200 and ReplicaCAD have them.
//!
//! Made from the documentation of habitat-sim (`docs/pages/attributesJSON.rst`) and its attribute managers
//! (`src/esp/metadata/managers`), `physics/RigidObject.cpp` for what a translation means, `geo/CoordinateFrame.cpp` for frames. What
//! habitat-sim reads and does not use when it places things is not used here either, so that scenes look as they do there.
//!
//! | in the files | what becomes of it |
//! |---|---|
//! | `*.scene_dataset_config.json` | looked for in the scene's folder and the four above; of several that whose `scene_instances` list the scene. `default_attributes`, `paths` (with wildcards; folders are listed) and `configs` of `stages`, `objects`, `articulated_objects`, `light_setups` |
//! | `template_name` | the template whose handle is it, or ends with it, or holds it, in this order |
//! | `stage_instance` | the parts of the stage by their own names; those that are called wall, floor or ceiling have these classes. Scale is used, translation and rotation are not, as in habitat-sim |
//! | `object_instances` | `translation`, `rotation` (w x y z), `uniform_scale`, `non_uniform_scale`, `translation_origin` of each or of all; those that are not visible are left out |
//! | `*.stage_config.json`, `*.object_config.json` | `render_asset` (or `collision_asset`), `scale`, `up`, `front`, `COM`; a model alone is a template too. Stages from GLB files have z up by default |
//! | `articulated_object_instances` | the visual meshes of the URDF, with its joints as bodies that have limits; primitive shapes are left out, with a warning that counts them. `initial_joint_pose`, a list of states from the base on (depth first, in the order of the file), is their rest |
//! | `*.lighting_config.json` | point, spot and directional lights of the frame `global`; color × intensity as W/sr or W/m², because Habitat states no unit. Lights of negative intensity, which cannot be, are left out |
//! | categories | `semantics/objects.csv` by model (`main_category`, else the noun of `wnsynsetkey`), as in HSSD; else `semantic_id` in the dataset's lexicon |
//! | `units_to_meters`, `origin`, physics, shaders, navigation | not used, as in habitat-sim; a `units_to_meters` other than 1 is reported |
//!
//! A translation is the position of the middle of the box around the model (or of `COM`), unless `translation_origin` is `asset_local`.

mod categories;
mod dataset;
mod light;
mod scene;
mod template;
mod urdf;

use super::assets::Models;
use super::json;
use super::objects::Objects;
use crate::assembly::Assembly;
use crate::{ImportError, Imported};
use categories::Categories;
use dataset::Dataset;
pub(super) use dataset::{DATASET, SCENE};
use scene::{Placer, SceneInstance};

/// Imports a scene instance.
pub(super) fn load(bytes: &[u8], mut a: Assembly) -> Result<Imported, ImportError> {
    let file = a.file().to_path_buf();
    let scene: SceneInstance = json::parse(bytes, &file, "a scene instance of Habitat")?;
    let dataset = Dataset::of_scene(&mut a)?;
    let categories = Categories::read(&dataset, scene.semantic_scene_instance.as_deref(), &mut a)?;
    let (models, objects) = (Models::default(), Objects::default());
    let mut placer = Placer::new(&scene, &dataset, &categories, models, objects);
    placer.stage(&mut a)?;
    placer.objects(&mut a)?;
    placer.articulated(&mut a)?;
    placer.finish(&mut a);
    light::add(&scene, &dataset, &mut a)?;
    a.finish()
}
