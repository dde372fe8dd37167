//! A scene file, and the options of its import: `[import]` and keys of a `[[scene]]`, flags of `import` and `look`, keywords of Python.

use enfilade_import::{EnvironmentOverride, ImportOptions, UpAxis};
use enfilade_options::{named, options, words};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

options! {
    /// A scene file and what it does not say itself.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct FileSource keys pub(super) ImportKeys {
        /// The file, as written: the path may be relative and may hold environment variables.
        pub file: String = String::new() => fixed,
        /// Metres per unit of the file, where the file states its unit a factor to that; always 1 for packages (.scene).
        pub meters_per_unit: f64 = 1.0,
        /// Axis that points up, where the file does not say; the format's own unless given, and always z in packages (.scene).
        pub up_axis: Option<UpAxis> = None => named("AXIS"),
        /// What surrounds the scene instead of the file's own surroundings: an equirectangular picture, or a sky that needs no file, "sky"
        /// (clear, with the sun of a summer afternoon) or "overcast".
        ///
        /// Files of TOML have a table for a picture, and for either sky at another moment. A path is as written.
        pub environment: Option<EnvironmentOverride> = None => named("FILE|sky|overcast"),
        /// Lamps to add to the file's own.
        pub lamps: Option<Lamps> = None => named("WHERE"),
        /// Keep only the first of faces with the same corners.
        #[serde(default)]
        pub drop_doubled_faces: bool = false,
        /// Leave motion out: everything stays where the file has it at rest.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        pub still: bool = false,
        /// A stored run of a simulator, by which the joints of the file move (MuJoCo's MJCF, URDF): `.npz` or `.csv`, see docs/motion.md.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub states: Option<PathBuf> = None => named("FILE"),
        /// Groups of geoms to read of a model of MuJoCo; 0, 1 and 2 unless given, as its viewer shows.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub geom_groups: Vec<u32> = Vec::new() => named("N,N"),
        /// Names of parts or materials to make clear panes of ("glass*,window pane"), where glass lost its transparency; `*` is any run of
        /// characters.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub panes: Vec<String> = Vec::new() => named("NAME,NAME"),
        /// Use plain grey, with a warning, where a texture is missing.
        #[serde(default)]
        pub allow_missing_textures: bool = false,
        /// Leave out meshes whose file is missing or damaged, with a warning (Mitsuba, pbrt, URDF, SDF, MJCF).
        #[serde(default)]
        pub allow_missing_meshes: bool = false,
    }
}

words! {
    /// Lamps for a scene whose file has none.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Lamps {
        /// Square ones below the ceiling of every room.
        Ceiling = "ceiling",
    }
}

impl FileSource {
    /// The file as it comes.
    pub fn of(file: impl Into<String>) -> Self {
        Self { file: file.into(), ..Self::default() }
    }

    /// The options that its importer takes; the paths of the environment and of the states are as written.
    pub(crate) fn importer(&self) -> ImportOptions {
        let Self { meters_per_unit, up_axis, allow_missing_textures, allow_missing_meshes, .. } = *self;
        ImportOptions {
            meters_per_unit,
            up_axis,
            environment: self.environment.clone(),
            allow_missing_textures,
            allow_missing_meshes,
            geom_groups: self.geom_groups.clone(),
            states: self.states.clone(),
        }
    }
}
