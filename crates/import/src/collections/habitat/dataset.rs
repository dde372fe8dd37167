//! The configuration of a dataset, and the templates that it lists: found by the handles that scenes name.

use super::super::json;
use crate::ImportError;
use crate::assembly::Assembly;
use crate::wildcards::matches;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// The ends of the names of scenes and of the configurations of datasets.
pub(in crate::collections) const SCENE: &str = ".scene_instance.json";
pub(in crate::collections) const DATASET: &str = ".scene_dataset_config.json";

/// Number of folders above the scene's in which the configuration is sought.
const ABOVE: usize = 4;
/// Placeholder for a template's own name in default attributes.
const OWN_NAME: &str = "%%CONFIG_NAME_AS_ASSET_FILENAME%%";

/// A dataset: the folder of its configuration, and its templates.
pub(super) struct Dataset {
    pub root: PathBuf,
    pub stages: Templates,
    pub objects: Templates,
    pub articulated: Templates,
    pub lights: Templates,
    /// Files with the meanings of semantic numbers, by their handles.
    pub semantics: BTreeMap<String, String>,
}

#[derive(Deserialize)]
struct Config {
    #[serde(default)]
    stages: Section,
    #[serde(default)]
    objects: Section,
    #[serde(default)]
    articulated_objects: Section,
    #[serde(default)]
    light_setups: Section,
    #[serde(default)]
    scene_instances: Section,
    #[serde(default)]
    semantic_scene_descriptor_instances: Map<String, Value>,
}

#[derive(Default, Deserialize)]
struct Section {
    #[serde(default)]
    default_attributes: Map<String, Value>,
    #[serde(default)]
    paths: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    configs: Vec<Custom>,
}

/// A template that the configuration itself makes, perhaps from a file.
#[derive(Clone, Default, Deserialize)]
struct Custom {
    original_file: Option<String>,
    template_handle: Option<String>,
    #[serde(default)]
    attributes: Map<String, Value>,
}

/// The templates of one kind.
pub(super) struct Templates {
    root: PathBuf,
    /// The end of the names of their files.
    suffix: &'static str,
    defaults: Map<String, Value>,
    custom: Vec<Custom>,
    /// Handle, the path from the root without its end, and file; sorted.
    files: Vec<(String, PathBuf)>,
    by_name: HashMap<String, Vec<usize>>,
}

/// The attributes of a template, and the folder that its paths begin in.
pub(super) struct Attributes {
    pub values: Map<String, Value>,
    pub file: PathBuf,
}

impl Dataset {
    /// The dataset that the scene belongs to.
    ///
    /// # Errors
    /// When there is no configuration in the scene's folder or above, or it cannot be read.
    pub fn of_scene(a: &mut Assembly) -> Result<Self, ImportError> {
        let scene = a.file().to_path_buf();
        let mut folder = scene.parent().map(Path::to_path_buf).unwrap_or_default();
        for _ in 0..=ABOVE {
            let found = matches(&folder, &format!("*{DATASET}")).unwrap_or_default();
            let mut first = None;
            for config in found {
                let (file, config) = read(&folder.join(config.path), a)?;
                if config.scene_instances.lists(&folder, &scene) {
                    return Ok(Self::new(&folder, config));
                }
                first = first.or(Some((file, config)));
            }
            if let Some((file, config)) = first {
                a.warn("dataset", format!("no configuration lists this scene; {} was used", file.display()));
                return Ok(Self::new(&folder, config));
            }
            folder = if folder.as_os_str().is_empty() { PathBuf::from("..") } else { folder.join("..") };
        }
        let problem = format!(
            "found no *{DATASET} in its folder or the {ABOVE} above, which says where its models are; import the scene where the dataset was \
             unpacked"
        );
        Err(a.malformed("dataset", problem))
    }

    fn new(root: &Path, config: Config) -> Self {
        let of = |section, suffix| Templates::new(root, section, suffix);
        let semantics = config.semantic_scene_descriptor_instances.into_iter();
        Self {
            root: root.to_path_buf(),
            stages: of(config.stages, ".stage_config.json"),
            objects: of(config.objects, ".object_config.json"),
            articulated: of(config.articulated_objects, ".ao_config.json"),
            lights: of(config.light_setups, ".lighting_config.json"),
            semantics: semantics.filter_map(|(key, value)| Some((key, value.as_str()?.to_string()))).collect(),
        }
    }
}

fn read(file: &Path, a: &mut Assembly) -> Result<(PathBuf, Config), ImportError> {
    let bytes = a.read_input(file, "check the permission to read it")?;
    Ok((file.to_path_buf(), json::parse(&bytes, file, "a dataset configuration of Habitat")?))
}

impl Section {
    /// True where the section's paths lead to a file.
    fn lists(&self, root: &Path, file: &Path) -> bool {
        let same = |found: &Path| found.file_name() == file.file_name() && found.canonicalize().ok() == file.canonicalize().ok();
        self.files(root, SCENE).iter().any(|found| same(found))
    }

    /// All files that the paths lead to: those of this end in folders, and files themselves.
    fn files(&self, root: &Path, suffix: &str) -> Vec<PathBuf> {
        let mut files = Vec::new();
        for (extension, patterns) in &self.paths {
            let end = if extension.contains(".json") { suffix } else { extension.as_str() };
            for found in patterns.iter().flat_map(|pattern| matches(root, pattern).unwrap_or_default()) {
                let place = root.join(&found.path);
                if place.is_dir() {
                    let inside = matches(&place, &format!("*{end}")).unwrap_or_default();
                    files.extend(inside.into_iter().map(|m| place.join(m.path)));
                } else if found.path.ends_with(end) {
                    files.push(place);
                }
            }
        }
        files
    }
}

impl Templates {
    fn new(root: &Path, section: Section, suffix: &'static str) -> Self {
        let handle = |file: &Path| {
            let path = file.strip_prefix(root).unwrap_or(file).to_string_lossy().replace('\\', "/");
            let bare = path.strip_suffix(suffix).map(str::to_string);
            bare.unwrap_or_else(|| path.rsplit_once('.').map_or(path.clone(), |(bare, _)| bare.to_string()))
        };
        let mut files: Vec<(String, PathBuf)> = section.files(root, suffix).into_iter().map(|file| (handle(&file), file)).collect();
        // A model that has a description beside it is described by that.
        files.sort_by_key(|(handle, file)| (handle.clone(), !file.to_string_lossy().ends_with(suffix), file.clone()));
        files.dedup_by(|later, first| later.0 == first.0);
        let mut by_name: HashMap<String, Vec<usize>> = HashMap::new();
        for (i, (handle, _)) in files.iter().enumerate() {
            by_name.entry(last_name(handle).to_string()).or_default().push(i);
        }
        Self { root: root.to_path_buf(), suffix, defaults: section.default_attributes, custom: section.configs, files, by_name }
    }

    /// The attributes of the template that a scene names; `None` where there is none.
    ///
    /// # Errors
    /// When its file cannot be read or is no JSON.
    pub fn find(&self, name: &str, a: &mut Assembly) -> Result<Option<Attributes>, ImportError> {
        let bare = name.strip_suffix(self.suffix).unwrap_or(name);
        if let Some(custom) = self.custom.iter().find(|custom| custom.template_handle.as_deref() == Some(bare)) {
            let mut attributes = match &custom.original_file {
                Some(original) => self.of_file(&self.root.join(original), a)?,
                None => Attributes { values: self.defaults.clone(), file: self.root.join("dataset") },
            };
            attributes.values.extend(custom.attributes.clone());
            return Ok(Some(attributes));
        }
        self.file(bare).map(|file| self.of_file(file, a)).transpose()
    }

    /// The file of a handle: one that equals it or ends with it, else the first that contains it.
    fn file(&self, name: &str) -> Option<&Path> {
        let without = |name: &str| name.rsplit_once('.').map(|(bare, _)| bare.to_string());
        let ends = |name: &str| {
            let alike = self.by_name.get(last_name(name)).into_iter().flatten();
            let ends = |handle: &str| handle == name || handle.strip_suffix(name).is_some_and(|before| before.ends_with('/'));
            alike.map(|&i| &self.files[i]).find(|(handle, _)| ends(handle))
        };
        let exact = ends(name).or_else(|| ends(&without(name)?));
        let found = exact.or_else(|| self.files.iter().find(|(handle, _)| handle.contains(name)));
        found.map(|(_, file)| file.as_path())
    }

    fn of_file(&self, file: &Path, a: &mut Assembly) -> Result<Attributes, ImportError> {
        let name = file.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let own = name.strip_suffix(self.suffix).or_else(|| name.split('.').next()).unwrap_or(&name).to_string();
        let mut values = self.defaults.clone();
        if name.ends_with(".json") {
            let bytes = a.read_input(file, "the dataset lists it; copy or unpack it again")?;
            values.extend(json::parse::<Map<String, Value>>(&bytes, file, "a table of attributes")?);
        } else {
            values.insert("render_asset".into(), Value::String(name.clone()));
            values.insert("urdf_filepath".into(), Value::String(name.clone()));
        }
        for value in values.values_mut() {
            if let Value::String(text) = value {
                *text = text.replace(OWN_NAME, &own);
            }
        }
        Ok(Attributes { values, file: file.to_path_buf() })
    }
}

/// The last name of a path.
fn last_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}
