//! A scene instance: the stage and the objects in their places.

use super::super::assets::{Models, unless_odd};
use super::super::listed::Listed;
use super::super::objects::Objects;
use super::categories::Categories;
use super::dataset::{Dataset, Templates};
use super::template::Template;
use super::urdf;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};
use serde::Deserialize;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// The stage that is none.
const NONE: &str = "NONE";
/// Words in the names of a stage's parts, and their classes.
const OF_STAGE: [(&str, i16); 4] = [("wall", 1), ("walltop", 1), ("floor", 2), ("ceiling", 22)];
/// Templates that a warning names.
const NAMED: usize = 6;

/// The file.
#[derive(Deserialize)]
pub(super) struct SceneInstance {
    stage_instance: Option<Instance>,
    #[serde(default)]
    object_instances: Listed<Instance>,
    #[serde(default)]
    articulated_object_instances: Listed<Instance>,
    translation_origin: Option<String>,
    pub default_lighting: Option<String>,
    pub semantic_scene_instance: Option<String>,
}

/// A placed stage or object.
#[derive(Deserialize)]
struct Instance {
    template_name: String,
    #[serde(default)]
    translation: DVec3,
    #[serde(default = "no_turn")]
    rotation: [f64; 4],
    #[serde(default = "unit")]
    uniform_scale: f64,
    #[serde(default = "one")]
    non_uniform_scale: DVec3,
    translation_origin: Option<String>,
    is_instance_visible: Option<bool>,
    initial_joint_pose: Option<serde_json::Value>,
}

fn no_turn() -> [f64; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

fn unit() -> f64 {
    1.0
}

fn one() -> DVec3 {
    DVec3::ONE
}

impl Instance {
    fn scale(&self) -> DVec3 {
        self.non_uniform_scale * self.uniform_scale
    }

    /// The rotation; none where the four numbers are no rotation.
    fn turn(&self) -> DQuat {
        let [w, x, y, z] = self.rotation;
        let turn = DQuat::from_xyzw(x, y, z, w);
        if turn.is_finite() && turn.length() > 1e-9 { turn.normalize() } else { DQuat::IDENTITY }
    }
}

/// Places what the scene lists.
pub(super) struct Placer<'s> {
    scene: &'s SceneInstance,
    dataset: &'s Dataset,
    categories: &'s Categories,
    models: Models,
    objects: Objects,
    known: HashMap<&'s str, Option<Rc<Template>>>,
    /// Templates that are not there or have no model, and of how many objects.
    lost: BTreeMap<&'s str, usize>,
    hidden: usize,
    asset_local: bool,
}

impl<'s> Placer<'s> {
    pub fn new(scene: &'s SceneInstance, dataset: &'s Dataset, categories: &'s Categories, models: Models, objects: Objects) -> Self {
        let asset_local = is_asset_local(scene.translation_origin.as_deref()).unwrap_or(false);
        let (known, lost) = (HashMap::new(), BTreeMap::new());
        Self { scene, dataset, categories, models, objects, known, lost, hidden: 0, asset_local }
    }

    /// Adds the stage.
    pub fn stage(&mut self, a: &mut Assembly) -> Result<(), ImportError> {
        let Some(stage) = self.scene.stage_instance.as_ref().filter(|stage| stage.template_name != NONE) else { return Ok(()) };
        let template = self.template(&self.dataset.stages, &stage.template_name, a)?;
        let model = match template.as_ref().and_then(|t| t.model()) {
            Some(file) => self.models.get(&file, a)?,
            None => None,
        };
        let (Some(template), Some(model)) = (template, model) else {
            a.warn("stage_instance", format!("the stage {:?} or its model is not in the dataset; it was left out", stage.template_name));
            return Ok(());
        };
        if stage.translation != DVec3::ZERO || stage.turn() != DQuat::IDENTITY {
            a.warn("stage_instance", "its translation and rotation were not used, since habitat-sim does not use them");
        }
        let placement = object_from_model(&template, stage.scale(), true, &stage.template_name, a);
        for piece in &model.pieces {
            match class_in_stage(&piece.name) {
                Some(class) => _ = self.objects.of_class(class, &piece.name).place(std::slice::from_ref(piece), placement, a),
                None => {
                    let object = piece.object.unwrap_or_else(|| a.push_object(&piece.name, None));
                    a.push_part_of(
                        object,
                        &piece.name,
                        piece.mesh,
                        piece.material,
                        placement * piece.model_from_mesh,
                        piece.label_in(object),
                    );
                }
            }
        }
        Ok(())
    }

    /// Adds the rigid objects.
    pub fn objects(&mut self, a: &mut Assembly) -> Result<(), ImportError> {
        let scene = self.scene;
        for (i, instance) in scene.object_instances.iter().enumerate() {
            a.progress(i + 1, scene.object_instances.len());
            if instance.is_instance_visible == Some(false) {
                self.hidden += 1;
                continue;
            }
            let name = instance.template_name.as_str();
            let template = self.template(&self.dataset.objects, name, a)?;
            let file = template.as_ref().and_then(|t| t.model());
            let model = file.map(|file| self.models.get(&file, a)).transpose()?.flatten();
            let (Some(template), Some(model)) = (template, model) else {
                *self.lost.entry(name).or_default() += 1;
                continue;
            };
            let placement = object_from_model(&template, instance.scale(), false, name, a);
            let center = match template.center_of_mass {
                _ if self.is_local(instance) => DVec3::ZERO,
                Some(center) => center * template.scale * instance.scale(),
                None => {
                    let (min, max) = model.bounds_at(placement, a);
                    0.5 * (min + max)
                }
            };
            let stand = DAffine3::from_rotation_translation(instance.turn(), instance.translation);
            let category = self.categories.of(name, template.semantic_id);
            let id = name.rsplit('/').next().unwrap_or(name);
            self.objects.next(category, id).place(&model.pieces, stand * DAffine3::from_translation(-center) * placement, a);
        }
        Ok(())
    }

    /// Adds the articulated objects, with their joints as bodies, in the states that their instances give them.
    pub fn articulated(&mut self, a: &mut Assembly) -> Result<(), ImportError> {
        let scene = self.scene;
        for instance in &scene.articulated_object_instances {
            let name = instance.template_name.as_str();
            let template = self.template(&self.dataset.articulated, name, a)?;
            let file = template.as_ref().and_then(|t| Some(t.beside(t.urdf_filepath.as_deref()?)));
            let (Some(template), Some(file)) = (template, file.filter(|file| file.is_file())) else {
                *self.lost.entry(name).or_default() += 1;
                continue;
            };
            let read = urdf::read(&file, &mut self.models, a);
            let Some(robot) = unless_odd(read, "articulated_object_instances", "a model", a)? else {
                *self.lost.entry(name).or_default() += 1;
                continue;
            };
            let mut stand = DAffine3::from_rotation_translation(instance.turn(), instance.translation);
            stand *= DAffine3::from_scale(instance.scale() * template.uniform_scale);
            let mut from_base = robot.inertial.inverse();
            if self.is_local(instance) {
                from_base.translation = DVec3::ZERO;
            }
            let category = self.categories.of(name, template.semantic_id);
            let id = name.rsplit('/').next().unwrap_or(name);
            let object = self.objects.next(category, id);
            let parts = object.place(&robot.pieces, stand * from_base, a);
            robot.add_bodies(&object.name, stand * from_base, &parts, instance.initial_joint_pose.as_ref(), a);
        }
        // The states are the scene's rest.
        a.settle_bodies();
        Ok(())
    }

    fn is_local(&self, instance: &Instance) -> bool {
        is_asset_local(instance.translation_origin.as_deref()).unwrap_or(self.asset_local)
    }

    fn template(&mut self, of: &Templates, name: &'s str, a: &mut Assembly) -> Result<Option<Rc<Template>>, ImportError> {
        if let Some(known) = self.known.get(name) {
            return Ok(known.clone());
        }
        let found = of.find(name, a).and_then(|found| found.map(Template::new).transpose());
        let found = unless_odd(found, "templates", "a template", a)?.flatten().map(Rc::new);
        if let Some(template) = found.as_ref().filter(|t| t.units_to_meters != 1.0) {
            let message =
                format!("{name:?} has units_to_meters {}, which was not used, since habitat-sim does not", template.units_to_meters);
            a.warn("templates", message);
        }
        self.known.insert(name, found.clone());
        Ok(found)
    }

    /// Reports what was left out.
    pub fn finish(self, a: &mut Assembly) {
        self.objects.finish(a);
        self.scene.object_instances.report("object_instances", a);
        self.scene.articulated_object_instances.report("articulated_object_instances", a);
        if self.hidden > 0 {
            a.warn("object_instances", format!("{} objects are not visible and were left out", self.hidden));
        }
        if !self.lost.is_empty() {
            let all = self.scene.object_instances.len() + self.scene.articulated_object_instances.len();
            let objects: usize = self.lost.values().sum();
            let named: Vec<&str> = self.lost.keys().take(NAMED).copied().collect();
            let message = format!(
                "{objects} of {all} objects were left out, because {} templates or their models are not in the dataset, such as {}",
                self.lost.len(),
                named.join(", ")
            );
            a.warn("object_instances", message);
        }
    }
}

/// True for `asset_local`, false for `COM`; `None` if it is not stated.
fn is_asset_local(origin: Option<&str>) -> Option<bool> {
    match origin.map(str::to_lowercase).as_deref() {
        Some("asset_local") => Some(true),
        Some("com") => Some(false),
        _ => None,
    }
}

/// From a model to an object or stage that is turned upright and scaled.
fn object_from_model(template: &Template, scale: DVec3, is_stage: bool, name: &str, a: &mut Assembly) -> DAffine3 {
    let frame = template.frame(is_stage).unwrap_or_else(|| {
        a.warn("templates", format!("up and front of {name:?} are not at right angles; it was not turned"));
        DMat3::IDENTITY
    });
    DAffine3::from_mat3(DMat3::from_diagonal(template.scale * scale) * frame)
}

/// The class in the name of a stage's part, as HSSD names them: `wall_0.003`, `geometry_wallTop.124`.
fn class_in_stage(name: &str) -> Option<i16> {
    let lower = name.to_lowercase();
    let words = lower.split(|c: char| !c.is_alphabetic());
    words.into_iter().find_map(|word| OF_STAGE.iter().find(|(known, _)| *known == word).map(|(_, class)| *class))
}
