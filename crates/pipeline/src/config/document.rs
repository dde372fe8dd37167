//! The text of `dataset.toml`: its keys, their ranges, and how the levels of it are laid over each other.
//!
//! From the weakest to the strongest: built-in defaults, the file's top level, the scene's own keys, the command line. On each
//! level `quality` sets the samples and `render.samples` wins over it.

use super::checks::{check_fov, check_frames, check_meters_per_unit, check_size};
use super::locate::{ConfigError, Source as Text, in_words};
use super::patch::{CarvePatch, GatePatch, PlanPatch, RenderPatch};
use super::{CameraChoice, CameraConfig, Config, EnvironmentChoice, FileSource, LabelSource, Overrides, Quality, SceneConfig, Source};
use enfilade_explore::{ExploreError, Mode};
use enfilade_home::HomeConfig;
use enfilade_import::UpAxis;
use serde::de::{MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer};
use std::cell::RefCell;
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Defaults of a dataset that are nobody else's.
const SIZE: [u32; 2] = [1024, 768];
const QUALITY: Quality = Quality::Normal;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    name: Option<Spanned<String>>,
    seed: Option<u64>,
    frames: Option<Spanned<u32>>,
    quality: Option<Quality>,
    labels: Option<Spanned<String>>,
    #[serde(default)]
    import: ImportKeys,
    #[serde(default)]
    render: RenderPatch,
    camera: Option<Spanned<CameraConfig>>,
    #[serde(default)]
    plan: PlanPatch,
    #[serde(default)]
    carve: CarvePatch,
    #[serde(default)]
    gate: GatePatch,
    #[serde(default)]
    scene: Vec<SceneKeys>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct ImportKeys {
    meters_per_unit: Option<Spanned<f64>>,
    up_axis: Option<UpAxis>,
    allow_missing_textures: Option<bool>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneKeys {
    name: Spanned<String>,
    file: Option<Spanned<String>>,
    home: Option<Spanned<toml::Table>>,
    meters_per_unit: Option<Spanned<f64>>,
    up_axis: Option<UpAxis>,
    environment: Option<Spanned<EnvironmentChoice>>,
    allow_missing_textures: Option<bool>,
    labels: Option<Spanned<String>>,
    label_scene: Option<String>,
    #[serde(default)]
    cameras: Vec<CameraKey>,
    seed: Option<u64>,
    frames: Option<Spanned<u32>>,
    quality: Option<Quality>,
    #[serde(default)]
    render: RenderPatch,
    /// Replaces that of the file as a whole.
    camera: Option<Spanned<CameraConfig>>,
    #[serde(default)]
    plan: PlanPatch,
    #[serde(default)]
    carve: CarvePatch,
    #[serde(default)]
    gate: GatePatch,
}

/// A camera's name, or a table with its place.
struct CameraKey(CameraChoice);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlacedCamera {
    position: [f64; 3],
    look_at: [f64; 3],
}

impl<'de> Deserialize<'de> for CameraKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrPlace;
        impl<'de> Visitor<'de> for NameOrPlace {
            type Value = CameraChoice;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a camera's name, or a table { position = [x, y, z], look_at = [x, y, z] }")
            }
            fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<CameraChoice, E> {
                Ok(CameraChoice::Named(name.into()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<CameraChoice, A::Error> {
                let PlacedCamera { position, look_at } = PlacedCamera::deserialize(MapAccessDeserializer::new(map))?;
                Ok(CameraChoice::Placed { position, look_at })
            }
        }
        deserializer.deserialize_any(NameOrPlace).map(CameraKey)
    }
}

/// The configuration in `text`, with `overrides` over it. Environment variables in paths are checked, not replaced. Label tables and
/// grids of rays are read, to refuse what a late stage could not use.
pub(super) fn resolve(
    file: &Path,
    text: &str,
    overrides: &Overrides,
    variable: &dyn Fn(&str) -> Option<String>,
) -> Result<Config, ConfigError> {
    let source = Text { file, text };
    let document: Document = toml::from_str(text).map_err(|e| source.toml_error(&e))?;
    let resolver = Resolver { source, document: &document, overrides, variable, looked_at: RefCell::default() };
    let name = match &document.name {
        Some(name) => resolver.checked_name(name)?,
        None => default_name(file),
    };
    if document.scene.is_empty() {
        let mut error = resolver.source.error(None, "there is no [[scene]] in it");
        error.help = Some("add at least one:\n\n  [[scene]]\n  name = \"my-room\"\n  file = \"my-room.gltf\"".into());
        return Err(error);
    }
    let mut names = HashSet::new();
    let mut scenes = Vec::new();
    for keys in &document.scene {
        if !names.insert(keys.name.get_ref().as_str()) {
            return Err(resolver.refuse(&keys.name, "two scenes have this name", "names of scenes must be unique"));
        }
        scenes.push(resolver.scene(keys)?);
    }
    resolver.check_homes(&scenes)?;
    Ok(Config { base: Default::default(), carried: Default::default(), name, scenes })
}

fn default_name(file: &Path) -> String {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.into());
    let stem = file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = absolute.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    if stem == "dataset" { folder.unwrap_or(stem) } else { stem }
}

/// From keys to a configuration; `checks.rs` has what it refuses.
pub(super) struct Resolver<'a> {
    pub(super) source: Text<'a>,
    document: &'a Document,
    overrides: &'a Overrides,
    pub(super) variable: &'a dyn Fn(&str) -> Option<String>,
    /// Files that were read and found good: scenes share them.
    pub(super) looked_at: RefCell<HashSet<PathBuf>>,
}

impl Resolver<'_> {
    pub(super) fn refuse<T>(&self, value: &Spanned<T>, message: impl Into<String>, help: impl Into<String>) -> ConfigError {
        let mut error = self.source.error(Some(value.span()), message);
        error.help = Some(help.into());
        error
    }

    fn scene(&self, keys: &SceneKeys) -> Result<SceneConfig, ConfigError> {
        let document = self.document;
        let name = self.checked_scene_name(&keys.name)?;
        let seed = self.overrides.seed.or(keys.seed).or(document.seed).unwrap_or(0);
        let camera = keys.camera.as_ref().or(document.camera.as_ref());
        let mut scene = SceneConfig {
            seed,
            source: self.scene_source(keys, seed)?,
            labels: self.labels(keys, &name)?,
            cameras: keys.cameras.iter().map(|c| c.0.clone()).collect(),
            size: SIZE,
            fov_x_deg: None,
            camera: camera.map_or_else(CameraConfig::default, |camera| camera.get_ref().clone()),
            carve: Default::default(),
            plan: Default::default(),
            gate: Default::default(),
            render: Default::default(),
            time_limit_s: None,
            save_every_s: super::save_every_s(),
            denoise: false,
            denoise_library: None,
            name,
        };
        scene.render.samples = QUALITY.samples();
        self.lay_over(&mut scene, document.quality, document.frames.as_ref(), &document.render, &document.plan, &document.carve)?;
        self.lay_over(&mut scene, keys.quality, keys.frames.as_ref(), &keys.render, &keys.plan, &keys.carve)?;
        for gate in [&document.gate, &keys.gate] {
            if let Some((value, message, example)) = gate.problem() {
                return Err(self.refuse(value, message, example));
            }
            gate.apply(&mut scene.gate);
        }
        if let Some(camera) = camera {
            self.check_camera(&mut scene, camera)?;
        }
        self.override_with_arguments(&mut scene)?;
        self.check_exploring(&scene, keys)?;
        Ok(scene)
    }

    /// Refuses what carving and planning would, at the key that says it.
    fn check_exploring(&self, scene: &SceneConfig, keys: &SceneKeys) -> Result<(), ConfigError> {
        let document = self.document;
        let carve = |field: &str| keys.carve.span(field).or_else(|| document.carve.span(field));
        let plan = |field: &str| keys.plan.span(field).or_else(|| document.plan.span(field));
        let help = "the defaults are voxel_m = 0.1, extent_m = 30, rays = 262144 and iterations = 5";
        scene.carve.validate().map_err(|e| self.misset(&e, &carve, keys, help))?;
        scene.plan.validate().map_err(|e| self.misset(&e, &plan, keys, "the keys of [plan] are explained in docs/trajectories.md"))
    }

    /// An error of exploring at the key whose place `span` tells; those of a mode stand in its table.
    fn misset(&self, error: &ExploreError, span: &dyn Fn(&str) -> Option<Range<usize>>, keys: &SceneKeys, help: &str) -> ConfigError {
        let own = if let ExploreError::Config { field, .. } = error { span(field) } else { None };
        let place = own.or_else(|| span("mode")).unwrap_or_else(|| keys.name.span());
        ConfigError { help: Some(help.into()), ..self.source.error(Some(place), error.to_string()) }
    }

    /// Refuses a home that an earlier scene is too: training and test could hold the same. Where both say its seed, it is meant.
    fn check_homes(&self, scenes: &[SceneConfig]) -> Result<(), ConfigError> {
        let homes = self.document.scene.iter().zip(scenes).filter_map(|(keys, scene)| Some((keys.home.as_ref()?, scene)));
        let homes: Vec<(&Spanned<toml::Table>, &SceneConfig)> = homes.collect();
        for (i, &(keys, scene)) in homes.iter().enumerate() {
            let meant = |other: &Spanned<toml::Table>| names_seed(keys) && names_seed(other);
            if let Some((_, earlier)) = homes[..i].iter().find(|(other, earlier)| earlier.source == scene.source && !meant(other)) {
                let message = format!("the scenes {:?} and {:?} would be the same home", earlier.name, scene.name);
                let help = "give each a seed, home = { seed = 1 } and home = { seed = 2 }; the same in both if one home is meant";
                return Err(self.refuse(keys, message, help));
            }
        }
        Ok(())
    }

    fn scene_source(&self, keys: &SceneKeys, seed: u64) -> Result<Source, ConfigError> {
        let file = match (&keys.file, &keys.home) {
            (Some(file), None) => file,
            (None, Some(home)) => return self.home(home, seed).map(Source::Home),
            _ => {
                let message = "a scene needs either `file` or `home`";
                return Err(self.refuse(
                    &keys.name,
                    message,
                    "add file = \"room.gltf\" for a scene of yours, or home = {} for a generated one",
                ));
            }
        };
        let defaults = &self.document.import;
        let meters_per_unit = keys.meters_per_unit.as_ref().or(defaults.meters_per_unit.as_ref());
        if let Some(value) = meters_per_unit {
            let help = "0.01 for a file in centimetres, 1 for one in metres";
            check_meters_per_unit(*value.get_ref()).map_err(|m| self.refuse(value, m, help))?;
        }
        if let Some(environment) = &keys.environment {
            self.check_path(&environment.get_ref().file, environment)?;
        }
        self.check_path(file.get_ref(), file)?;
        Ok(Source::File(FileSource {
            file: file.get_ref().clone(),
            meters_per_unit: meters_per_unit.map_or(1.0, |v| *v.get_ref()),
            up_axis: keys.up_axis.or(defaults.up_axis),
            environment: keys.environment.as_ref().map(|e| e.get_ref().clone()),
            allow_missing_textures: keys.allow_missing_textures.or(defaults.allow_missing_textures).unwrap_or(false),
        }))
    }

    /// A generated home; its seed is the scene's unless it has its own. That stays whatever the command line says, or all homes of
    /// a dataset would be one.
    fn home(&self, keys: &Spanned<toml::Table>, seed: u64) -> Result<HomeConfig, ConfigError> {
        let read: Result<HomeConfig, toml::de::Error> = keys.get_ref().clone().try_into();
        let help = "home = {} takes everything as it comes; home = { seed = 3, rooms = [\"living\", \"kitchen\", \"hall\"] } chooses";
        let mut home = read.map_err(|e| self.refuse(keys, format!("in `home`: {}", in_words(e.message()).0), help))?;
        if !names_seed(keys) {
            home.seed = seed;
        }
        home.assets.iter().try_for_each(|path| self.check_path(path, keys))?;
        match home.problem() {
            Some(problem) => Err(self.refuse(keys, format!("in `home`: {problem}"), help)),
            None => Ok(home),
        }
    }

    fn labels(&self, keys: &SceneKeys, name: &str) -> Result<Option<LabelSource>, ConfigError> {
        let table = match (&keys.labels, &keys.home) {
            (Some(table), _) => table,
            (None, Some(_)) => return Ok(None), // a home knows its own
            (None, None) => match &self.document.labels {
                Some(table) => table,
                None => return Ok(None),
            },
        };
        self.check_table(table)?;
        let scene = keys.label_scene.clone().unwrap_or_else(|| name.into());
        Ok(Some(LabelSource { table: table.get_ref().clone(), scene }))
    }

    fn lay_over(
        &self,
        scene: &mut SceneConfig,
        quality: Option<Quality>,
        frames: Option<&Spanned<u32>>,
        render: &RenderPatch,
        plan: &PlanPatch,
        carve: &CarvePatch,
    ) -> Result<(), ConfigError> {
        if let Some(quality) = quality {
            scene.render.samples = quality.samples();
        }
        if let Some(frames) = frames {
            scene.plan.frames = check_frames(*frames.get_ref()).map_err(|m| self.refuse(frames, m, "for example: frames = 100"))?;
        }
        if let Some(size) = &render.size {
            scene.size = check_size(*size.get_ref()).map_err(|m| self.refuse(size, m, "for example: size = [1024, 768]"))?;
        }
        if let Some(fov) = &render.fov_x_deg {
            check_fov(*fov.get_ref(), &scene.camera).map_err(|m| self.refuse(fov, m, "60 is a common choice"))?;
            scene.fov_x_deg = Some(*fov.get_ref());
        }
        if let Some(mode) = &plan.mode
            && let Mode::Keyframes(keyframes) = mode.get_ref()
        {
            keyframes.files.iter().try_for_each(|file| self.check_path(file, mode))?;
        }
        self.check_render(render)?;
        if let Some(limit) = &render.time_limit_s {
            scene.time_limit_s = Some(*limit.get_ref());
        }
        if let Some(interval) = &render.save_every_s {
            scene.save_every_s = *interval.get_ref();
        }
        if let Some(denoise) = &render.denoise {
            scene.denoise = *denoise.get_ref();
        }
        if let Some(library) = &render.denoise_library {
            self.check_path(library.get_ref(), library)?;
            scene.denoise_library = Some(library.get_ref().clone());
        }
        render.apply(&mut scene.render);
        plan.apply(&mut scene.plan);
        carve.apply(&mut scene.carve);
        Ok(())
    }

    fn override_with_arguments(&self, scene: &mut SceneConfig) -> Result<(), ConfigError> {
        let refuse = |message: String| ConfigError { file: "the command line".into(), ..self.source.error(None, message) };
        if let Some(frames) = self.overrides.frames {
            scene.plan.frames = check_frames(frames).map_err(refuse)?;
        }
        if let Some(size) = self.overrides.size {
            scene.size = check_size(size).map_err(refuse)?;
        }
        if let Some(quality) = self.overrides.quality {
            scene.render.samples = quality.samples();
        }
        if let Some(problem) = self.overrides.render.problem() {
            return Err(refuse(problem));
        }
        self.overrides.render.apply(scene);
        Ok(())
    }
}

/// True where a home says its own seed.
fn names_seed(home: &Spanned<toml::Table>) -> bool {
    home.get_ref().contains_key("seed")
}
