//! From the keys of `dataset.toml` to settings: how the levels are laid over each other, and where a value stands that cannot be.
//!
//! From the weakest to the strongest: built-in defaults or those of a `preset`, the file's top level, the scene's own keys, the command line. On each
//! level `quality` sets the samples (and for a reference what makes it one), `noise` takes as many as it needs, and the keys of `render` win
//! over both. What counts in the end is checked, `checks` has the ranges.

use super::camera::CameraConfig;
use super::checks::{HOME, Misset, NAMES, Section, check_scene_name, no_scene_name};
use super::choices::{MOST_SAMPLES, Overrides, Quality};
use super::document::{Document, LevelKeys, SceneKeys};
use super::expand::expand;
use super::farm::FarmConfig;
use super::files::{self, Entry};
use super::import::FileSource;
use super::locate::{Source as Text, in_words};
use super::presets;
use super::settings::{Config, Gone, LabelSource, SceneConfig, Source, keep_rendered, save_every_s};
use super::vary;
use crate::error::ConfigError;
use crate::request::{Product, Request};
use enfilade_compose::{ComposeError, MotionGroup, ObjectGroup};
use enfilade_dataset::{ColorKind, SCENE_TYPES, check_name, read_ray_grid, scene_type};
use enfilade_explore::Mode;
use enfilade_home::{HomeConfig, States};
use enfilade_import::EnvironmentOverride;
use enfilade_label::LabelTable;
use enfilade_options::with_nearest;
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// Defaults of a dataset that are nobody else's.
const SIZE: [u32; 2] = [1024, 768];
const QUALITY: Quality = Quality::Normal;
/// What colour layers hold unless the file says.
const COLOR: ColorKind = ColorKind::Denoised;
/// Where the keys of `[[object]]` are explained.
const OBJECTS: &str = "docs/compose.md explains the keys";
/// Where the keys of motion are.
const MOTIONS: &str = "docs/motion.md explains the keys";
/// Homes of one table.
const MAX_COUNT: u32 = 100_000;

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
    let mut entries = Vec::new();
    for keys in &document.scene {
        entries.extend(resolver.entries(keys)?);
    }
    for entry in &entries {
        if !names.insert(entry.name.get_ref().as_str()) {
            let message = format!("two scenes have the name {:?}", entry.name.get_ref());
            return Err(resolver.refuse(&entry.name, message, "names of scenes must be unique"));
        }
        scenes.push(resolver.scene(entry)?);
    }
    resolver.check_homes(&entries, &scenes)?;
    let scenes = resolver.with_variations(&entries, scenes)?;
    Ok(Config { base: Default::default(), carried: Default::default(), name, scenes, farm: resolver.farm()? })
}

fn default_name(file: &Path) -> String {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.into());
    let stem = file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = absolute.parent().and_then(Path::file_name).map(|s| s.to_string_lossy().into_owned());
    if stem == "dataset" { folder.unwrap_or(stem) } else { stem }
}

/// What resolving needs, scene after scene.
struct Resolver<'a> {
    source: Text<'a>,
    document: &'a Document,
    overrides: &'a Overrides,
    variable: &'a dyn Fn(&str) -> Option<String>,
    /// Files that were read and found good: scenes share them.
    looked_at: RefCell<HashSet<PathBuf>>,
}

impl Resolver<'_> {
    fn refuse<T>(&self, value: &Spanned<T>, message: impl Into<String>, help: impl Into<String>) -> ConfigError {
        ConfigError { help: Some(help.into()), ..self.source.error(Some(value.span()), message) }
    }

    /// The scenes of a table: one, those that its `files` mean, or as many homes as its `count` says.
    fn entries<'k>(&self, table: &'k Spanned<SceneKeys>) -> Result<Vec<Entry<'k>>, ConfigError> {
        let keys = table.get_ref();
        match (&keys.files, &keys.name) {
            (None, Some(name)) => match &keys.count {
                None => Ok(vec![Entry { keys, name: name.clone(), file: keys.file.clone(), nth: 0 }]),
                Some(count) => self.homes(keys, name, count),
            },
            (None, None) => Err(self.refuse(table, "missing field `name`", "add name = \"my-room\" to the scene")),
            (Some(files), None) if keys.file.is_none() && keys.home.is_none() && keys.count.is_none() => {
                let folder = self.source.file.parent().unwrap_or(Path::new(""));
                let expanded = self.expanded(files.get_ref(), files)?;
                files::entries(keys, files, &expanded, folder).map_err(|(message, help)| self.refuse(files, message, help))
            }
            (Some(files), _) => {
                let help = "leave them out: each file that `files` means is a scene, named after its file";
                Err(self.refuse(files, "`files` cannot be combined with `name`, `file`, `home` or `count`", help))
            }
        }
    }

    /// Entries for as many homes as `count` says, numbered from 0.
    fn homes<'k>(&self, keys: &'k SceneKeys, name: &Spanned<String>, count: &Spanned<u32>) -> Result<Vec<Entry<'k>>, ConfigError> {
        let homes = *count.get_ref();
        if !(1..=MAX_COUNT).contains(&homes) {
            let message = format!("count must lie between 1 and {MAX_COUNT}, found {homes}");
            return Err(self.refuse(count, message, "for example: count = 100"));
        }
        if keys.home.is_none() {
            return Err(self.refuse(count, "`count` needs `home`", "only homes are generated: add home = {}, or leave it out"));
        }
        let digits = (homes - 1).to_string().len();
        let entry = |nth| {
            let name = Spanned::new(name.span(), format!("{}_{nth:0digits$}", name.get_ref()));
            Entry { keys, name, file: None, nth }
        };
        Ok((0..homes).map(entry).collect())
    }

    /// The scenes, each followed by its variations.
    fn with_variations(&self, entries: &[Entry], scenes: Vec<SceneConfig>) -> Result<Vec<SceneConfig>, ConfigError> {
        let names: HashSet<String> = scenes.iter().map(|scene| scene.name.clone()).collect();
        let (mut all, mut varied) = (Vec::new(), false);
        for (entry, scene) in entries.iter().zip(scenes) {
            let misset = |(wrong, place): (enfilade_vary::Misset, Option<Range<usize>>)| ConfigError {
                help: Some(wrong.help),
                ..self.source.error(Some(place.unwrap_or_else(|| entry.name.span())), wrong.message)
            };
            let config = vary::configured([&self.document.level, &entry.keys.level]).map_err(misset)?;
            let variations = config.map_or_else(Vec::new, |config| vary::variations(&scene, &config));
            varied |= !variations.is_empty();
            all.push(scene);
            for variation in variations {
                if names.contains(&variation.name) {
                    let message = format!("the scene {:?} has the name of a variation", variation.name);
                    return Err(self.refuse(&entry.name, message, "give one of the two scenes another name"));
                }
                self.checked_scene_name(&Spanned::new(entry.name.span(), variation.name.clone()))?;
                all.push(variation);
            }
        }
        match vary::first_given(&self.document.level.vary).filter(|_| !varied) {
            Some(place) => {
                let help =
                    "say how many variations to make of every scene, count = 20, or give scenes a count of their own: vary.count = 20";
                Err(ConfigError {
                    help: Some(help.into()),
                    ..self.source.error(Some(place), "[vary] has no `count`, and no scene has one")
                })
            }
            None => Ok(all),
        }
    }

    fn scene(&self, entry: &Entry) -> Result<SceneConfig, ConfigError> {
        let (document, keys) = (&self.document.level, entry.keys);
        let name = self.checked_scene_name(&entry.name)?;
        let seed = self.overrides.seed.or(keys.level.seed).or(document.seed).unwrap_or(0);
        let camera = keys.level.camera.as_ref().or(document.camera.as_ref());

        // Built-in defaults.
        let motions = self.motions(keys)?;
        let mut source = self.scene_source(entry, seed)?;
        if let Source::Home(home) = &mut source
            && motions.iter().any(|group| !group.joint.is_empty())
        {
            // What is moved by its joint needs one, and an inside.
            home.states.get_or_insert(States::MADE);
        }
        let mut scene = SceneConfig {
            seed,
            source,
            varies: None,
            objects: self.objects(keys)?,
            motions,
            labels: self.labels(keys, &name)?,
            scene_type: keys.scene_type.as_ref().map(|word| self.scene_type(word)).transpose()?,
            cameras: keys.cameras.chosen.clone(),
            finds_cameras: keys.cameras.found,
            size: SIZE,
            fov_x_deg: None,
            camera: camera.map_or_else(CameraConfig::default, |camera| camera.get_ref().clone()),
            carve: Default::default(),
            plan: Default::default(),
            gate: Default::default(),
            render: Default::default(),
            time_limit_s: None,
            save_every_s: save_every_s(),
            color: COLOR,
            keep_rendered: keep_rendered(),
            denoiser: Gone,
            products: self.products(keys)?,
            name,
        };
        scene.render.samples = QUALITY.samples();
        presets::lay_over(keys.level.preset.or(document.preset).unwrap_or_default(), &mut scene);
        self.check_preset(keys)?;
        if matches!(scene.source, Source::Home(_)) {
            presets::photograph(&mut scene.plan, &[document, &keys.level]);
        }

        // The file over them, the scene's own keys over that, and the command line over all.
        self.lay_over(&mut scene, document, QUALITY)?;
        self.lay_over(&mut scene, &keys.level, document.quality.unwrap_or(QUALITY))?;
        if scene.camera.k.is_some() {
            // A camera matrix is of images of the file's size, whatever the command line says.
            scene.camera.k_size.get_or_insert(scene.size);
        }
        self.overrides.lay_over(&mut scene, keys.level.quality.or(document.quality).unwrap_or(QUALITY));

        scene.validate().map_err(|wrong| self.misset(wrong, entry))?;
        if let Some(camera) = camera {
            self.check_grid(&scene, camera)?;
        }
        self.check_products(&scene, keys)?;
        Ok(scene)
    }

    /// The models that are placed in a scene.
    fn objects(&self, keys: &SceneKeys) -> Result<Vec<ObjectGroup>, ConfigError> {
        let tables = keys.level.object.as_ref().or(self.document.level.object.as_ref());
        let groups = self.groups(tables, ("[[object]]", OBJECTS), ObjectGroup::validate)?;
        for (group, table) in groups.iter().zip(tables.into_iter().flatten()) {
            group.files.0.iter().try_for_each(|pattern| self.check_path(pattern, table))?;
        }
        Ok(groups)
    }

    /// What moves in a scene.
    fn motions(&self, keys: &SceneKeys) -> Result<Vec<MotionGroup>, ConfigError> {
        let tables = keys.level.motion.as_ref().or(self.document.level.motion.as_ref());
        self.groups(tables, ("[[motion]]", MOTIONS), MotionGroup::validate)
    }

    /// Reads and checks tables of one kind, which count from 1; `about` names the kind and where its keys are explained.
    fn groups<T: DeserializeOwned>(
        &self,
        tables: Option<&Vec<Spanned<toml::Table>>>,
        (kind, about): (&str, &str),
        validate: impl Fn(&T, usize) -> Result<(), ComposeError>,
    ) -> Result<Vec<T>, ConfigError> {
        let group = |(number, table): (usize, &Spanned<toml::Table>)| {
            let read: Result<T, toml::de::Error> = table.get_ref().clone().try_into();
            let group = read.map_err(|e| self.refuse(table, format!("in {kind}: {}", with_nearest(&in_words(e.message()).0)), about))?;
            validate(&group, number).map_err(|wrong| self.refuse(table, wrong.to_string(), about))?;
            Ok(group)
        };
        (1..).zip(tables.into_iter().flatten()).map(group).collect()
    }

    /// What is asked for of a scene; its own key replaces that of the file.
    fn products(&self, keys: &SceneKeys) -> Result<Vec<Request>, ConfigError> {
        let Some(list) = keys.level.products.as_ref().or(self.document.level.products.as_ref()) else { return Ok(Vec::new()) };
        let folder = self.source.file.parent().unwrap_or(Path::new(""));
        let mut requests = Vec::new();
        for key in list.get_ref() {
            let file = key.file().map(|file| self.expanded(file, list)).transpose()?;
            let path = |_: &str| Ok(folder.join(file.as_deref().unwrap_or_default()));
            requests.extend(key.requests(&path).map_err(|wrong| {
                let help = wrong.hint().unwrap_or_else(|| "docs/ground-truth.md has the products and their options".into());
                self.refuse(list, wrong.to_string(), help)
            })?);
        }
        Ok(requests)
    }

    /// Refuses products that nothing could be made of.
    fn check_products(&self, scene: &SceneConfig, keys: &SceneKeys) -> Result<(), ConfigError> {
        let Some(list) = keys.level.products.as_ref().or(self.document.level.products.as_ref()) else { return Ok(()) };
        let has = |is_meant: &dyn Fn(&Request) -> bool| scene.products.iter().any(is_meant);
        if has(&|request| request.is_made_after(Product::Pairs) && request.product() == Product::Flow)
            && !has(&|request| request.product() == Product::Pairs)
        {
            let help = "add \"pairs\", or say which frames: { flow = { step = 1 } }";
            return Err(self.refuse(list, "flow follows the list of pairs, which is not among the products", help));
        }
        if has(&|request| request.product() == Product::Relit) && !scene.render.fixtures {
            let message = format!("relit needs the light of each fixture apart, which scene {:?} has not", scene.name);
            return Err(self.refuse(list, message, "add fixtures = true below [render]"));
        }
        Ok(())
    }

    fn farm(&self) -> Result<FarmConfig, ConfigError> {
        let keys = &self.document.farm;
        let mut farm = FarmConfig::default();
        keys.apply(&mut farm);
        farm.validate()
            .map_err(|wrong| ConfigError { help: Some(wrong.help), ..self.source.error(keys.span(wrong.key), wrong.message) })?;
        Ok(farm)
    }

    /// Lays the keys of one level over those below, whose quality is `below`. Of paths it checks the environment variables.
    fn lay_over(&self, scene: &mut SceneConfig, level: &LevelKeys, below: Quality) -> Result<(), ConfigError> {
        let LevelKeys { frames, quality, render, plan, carve, gate, .. } = level;
        if let Some(quality) = *quality {
            quality.lay_over(scene, below);
        }
        if let Some(frames) = frames {
            scene.plan.frames = *frames.get_ref();
        }
        if let Some(mode) = &plan.mode
            && let Mode::Keyframes(keyframes) = mode.get_ref()
        {
            keyframes.files.iter().try_for_each(|file| self.check_path(file, mode))?;
        }
        let value = |value: &Option<Spanned<f64>>| value.as_ref().map(|value| *value.get_ref());
        scene.size = render.size.as_ref().map_or(scene.size, |size| *size.get_ref());
        scene.fov_x_deg = value(&render.fov_x_deg).or(scene.fov_x_deg);
        scene.time_limit_s = value(&render.time_limit_s).or(scene.time_limit_s);
        scene.save_every_s = value(&render.save_every_s).unwrap_or(scene.save_every_s);
        scene.color = render.color.as_ref().map_or(scene.color, |color| *color.get_ref());
        scene.keep_rendered = render.keep_rendered.as_ref().map_or(scene.keep_rendered, |keep| *keep.get_ref());
        if render.transport.noise.is_some() {
            scene.render.samples = MOST_SAMPLES;
        }
        render.transport.apply(&mut scene.render);
        plan.apply(&mut scene.plan);
        carve.apply(&mut scene.carve);
        gate.apply(&mut scene.gate);
        Ok(())
    }

    /// Refuses keys that a preset beside them, or above them, makes meaningless.
    fn check_preset(&self, keys: &SceneKeys) -> Result<(), ConfigError> {
        let (document, keys) = (&self.document.level, &keys.level);
        let of_document = document.preset.and_then(|preset| Some((preset, presets::unused_key(preset, document)?)));
        let of_scene = keys.preset.or(document.preset).and_then(|preset| Some((preset, presets::unused_key(preset, keys)?)));
        let Some((preset, (key, place))) = of_document.or(of_scene) else { return Ok(()) };
        let message = format!("preset {:?} has no rule for `{key}`", preset.name());
        let help = "leave the key out, or the preset; docs/trajectories.md has the table of what each preset does";
        Err(ConfigError { help: Some(help.into()), ..self.source.error(Some(place), message) })
    }

    /// The error of a value that cannot be, at the key that says it; those of a mode stand in its table.
    fn misset(&self, wrong: Misset, entry: &Entry) -> ConfigError {
        let Misset { section, key, message, help } = wrong;
        if self.overrides.say(section, key) {
            return ConfigError { file: "the command line".into(), ..self.source.error(None, message) };
        }
        let place = self.span(section, key, entry.keys).unwrap_or_else(|| entry.name.span());
        ConfigError { help: Some(help.into()), ..self.source.error(Some(place), message) }
    }

    /// Where the value of a key stands that counts for a scene; `None` for a default.
    fn span(&self, section: Section, key: &str, keys: &SceneKeys) -> Option<Range<usize>> {
        let levels = [&keys.level, &self.document.level];
        let in_levels = |span: &dyn Fn(&LevelKeys) -> Option<Range<usize>>| levels.into_iter().find_map(span);
        match section {
            Section::Scene => in_levels(&|level| level.frames.as_ref().map(Spanned::span)),
            Section::Import => [&keys.import, &self.document.import].into_iter().find_map(|keys| keys.span(key)),
            Section::Home => keys.home.as_ref().map(Spanned::span),
            Section::Camera => in_levels(&|level| level.camera.as_ref().map(Spanned::span)),
            Section::Render => in_levels(&|level| level.render.span(key)),
            Section::Carve => in_levels(&|level| level.carve.span(key)),
            Section::Plan => in_levels(&|level| level.plan.span(key)).or_else(|| in_levels(&|level| level.plan.span("mode"))),
            Section::Gate => in_levels(&|level| level.gate.span(key)),
        }
    }

    /// Refuses a home that an earlier scene is too: training and test could hold the same. Where both say its seed, it is meant.
    fn check_homes(&self, entries: &[Entry], scenes: &[SceneConfig]) -> Result<(), ConfigError> {
        let homes = entries.iter().zip(scenes).filter_map(|(entry, scene)| Some((entry.keys.home.as_ref()?, scene)));
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

    fn scene_source(&self, entry: &Entry, seed: u64) -> Result<Source, ConfigError> {
        let keys = entry.keys;
        let file = match (&entry.file, &keys.home) {
            (Some(file), None) => file,
            (None, Some(home)) => return self.home(home, seed, entry.nth).map(Source::Home),
            _ => {
                let message = "a scene needs either `file` or `home`";
                return Err(self.refuse(
                    &entry.name,
                    message,
                    "add file = \"room.gltf\" for a scene of yours, or home = {} for a generated one",
                ));
            }
        };
        let mut source = FileSource::of(file.get_ref());
        let levels = [&self.document.import, &keys.import];
        levels.iter().for_each(|level| level.apply(&mut source));
        if let Some(picture) = source.environment.as_ref().and_then(EnvironmentOverride::file)
            && let Some(place) = levels.iter().rev().find_map(|level| level.environment.as_ref())
        {
            self.check_path(&picture.to_string_lossy(), place)?;
        }
        if let Some(states) = &source.states
            && let Some(place) = levels.iter().rev().find_map(|level| level.states.as_ref())
        {
            self.check_path(&states.to_string_lossy(), place)?;
        }
        self.check_path(file.get_ref(), file)?;
        Ok(Source::File(source))
    }

    /// A generated home; its seed is the scene's unless it has its own, and `nth` more. A seed of its own stays whatever the command line
    /// says, or all homes of a dataset would be one.
    fn home(&self, keys: &Spanned<toml::Table>, seed: u64, nth: u32) -> Result<HomeConfig, ConfigError> {
        let read: Result<HomeConfig, toml::de::Error> = keys.get_ref().clone().try_into();
        let mut home = read.map_err(|e| self.refuse(keys, format!("in `home`: {}", with_nearest(&in_words(e.message()).0)), HOME))?;
        if !names_seed(keys) {
            home.seed = seed;
        }
        home.seed = home.seed.wrapping_add(nth.into());
        home.assets.iter().try_for_each(|path| self.check_path(path, keys))?;
        home.plan.iter().try_for_each(|file| self.new_file(file, keys, "floor plan").map(drop))?;
        Ok(home)
    }

    fn labels(&self, keys: &SceneKeys, name: &str) -> Result<Option<LabelSource>, ConfigError> {
        let table = match (&keys.level.labels, &keys.home) {
            (Some(table), _) => table,
            (None, Some(_)) => return Ok(None), // a home knows its own
            (None, None) => match &self.document.level.labels {
                Some(table) => table,
                None => return Ok(None),
            },
        };
        self.check_table(table)?;
        let scene = keys.label_scene.clone().unwrap_or_else(|| name.into());
        Ok(Some(LabelSource { table: table.get_ref().clone(), scene }))
    }

    /// Hypersim's spelling of a type of scene.
    fn scene_type(&self, word: &Spanned<String>) -> Result<String, ConfigError> {
        let unknown =
            || self.refuse(word, format!("there is no type of scene {:?}", word.get_ref()), format!("one of {}", SCENE_TYPES.join(", ")));
        scene_type(word.get_ref()).map(str::to_string).ok_or_else(unknown)
    }

    /// Refuses a label table that the last stages could not use.
    fn check_table(&self, table: &Spanned<String>) -> Result<(), ConfigError> {
        let Some(path) = self.new_file(table.get_ref(), table, "label table")? else { return Ok(()) };
        let refuse = |message: String| self.refuse(table, message, "correct the table, or name another one");
        let bytes = std::fs::read(&path).map_err(|e| refuse(format!("cannot read the label table {}: {e}", path.display())))?;
        LabelTable::parse(&bytes, &path.display().to_string()).map(drop).map_err(|e| refuse(e.to_string()))
    }

    /// Refuses a grid of rays that cannot be used.
    fn check_grid(&self, scene: &SceneConfig, camera: &Spanned<CameraConfig>) -> Result<(), ConfigError> {
        if let Some(file) = &scene.camera.ray_grid
            && let Some(path) = self.new_file(file, camera, "ray grid")?
        {
            read_ray_grid(&path, scene.size).map_err(|e| self.refuse(camera, e.to_string(), "docs/cameras.md explains the file"))?;
        }
        Ok(())
    }

    fn check_path<T>(&self, path: &str, place: &Spanned<T>) -> Result<(), ConfigError> {
        self.expanded(path, place).map(drop)
    }

    fn expanded<T>(&self, path: &str, place: &Spanned<T>) -> Result<String, ConfigError> {
        let help = "set the variable before running, as in: export NAME=/path/to/folder";
        expand(path, self.variable).map_err(|e| self.refuse(place, e, help))
    }

    /// The file that `path` means, which must be there; `None` when it was looked at before.
    fn new_file<T>(&self, path: &str, place: &Spanned<T>, what: &str) -> Result<Option<PathBuf>, ConfigError> {
        let folder = self.source.file.parent().unwrap_or(Path::new(""));
        let found = folder.join(self.expanded(path, place)?);
        if !found.is_file() {
            let help = "check the path for typing errors; it begins in the folder of the configuration";
            return Err(self.refuse(place, format!("there is no {what} {}", found.display()), help));
        }
        Ok(self.looked_at.borrow_mut().insert(found.clone()).then_some(found))
    }

    /// The name of the dataset.
    fn checked_name(&self, name: &Spanned<String>) -> Result<String, ConfigError> {
        let text = name.get_ref();
        check_name("name", text).map_err(|_| self.refuse(name, format!("{text:?} cannot be the name"), NAMES))?;
        Ok(text.clone())
    }

    fn checked_scene_name(&self, name: &Spanned<String>) -> Result<String, ConfigError> {
        let text = name.get_ref();
        check_scene_name(text).map_err(|help| self.refuse(name, no_scene_name(text), help))?;
        Ok(text.clone())
    }
}

/// True where a home says its own seed.
fn names_seed(home: &Spanned<toml::Table>) -> bool {
    home.get_ref().contains_key("seed")
}
