//! The tables of all keys of `dataset.toml`.
//!
//! Names, types and sentences are read from the code. Defaults and ranges come from the program itself: it reads a file without the key,
//! and files with values that may be wrong, and its messages state what it expects.

use super::fields::Declared;
use super::sources::{Sources, sentence};
use crate::house::House;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Lines, Write};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

/// Keys of one table.
struct Group {
    heading: &'static str,
    /// The text above the table.
    about: &'static str,
    /// The struct that declares them.
    of: &'static str,
    /// Structs whose keys are in the same table.
    with: &'static [&'static str],
    /// Not in the table.
    without: &'static [&'static str],
    /// A file in which `§` is replaced by the key; [`SCENE`] is added if it has no scene.
    file: &'static str,
    /// Their places in the resolved configuration: JSON pointers without the first slash, in which `§` is the key.
    at: &'static [&'static str],
}

const NOTHING: Group = Group { heading: "", about: "", of: "", with: &[], without: &[], file: "", at: &[] };

/// A scene that is not looked for.
const SCENE: &str = "\n[[scene]]\nname = \"a\"\nfile = \"a.glb\"\n";

/// Sections, and the keys that have a table of their own.
const SECTIONS: [&str; 11] = ["import", "object", "motion", "render", "camera", "plan", "carve", "gate", "vary", "farm", "scene"];

/// All keys.
const GROUPS: [Group; 31] = [
    Group {
        heading: "At the top of the file",
        about: "All except `name` are also allowed in a `[[scene]]`, for that scene only.",
        of: "Document",
        with: &["LevelKeys"],
        without: &SECTIONS,
        file: "§\n",
        at: &["scenes/0/plan/§", "scenes/0/§"],
    },
    Group {
        heading: "`[[scene]]`",
        about: "One for each scene, with the keys above, and those of `[import]` without that heading. `[scene.render]`, `[scene.camera]`, \
                `[scene.plan]`, `[scene.carve]`, `[scene.gate]` and `[scene.vary]` are the sections below for one scene.",
        of: "SceneKeys",
        file: "[[scene]]\nname = \"a\"\nfile = \"a.glb\"\n§\n",
        ..NOTHING
    },
    Group {
        heading: "`[import]`",
        about: "What the scene files do not say themselves.",
        of: "ImportKeys",
        file: "[import]\n§\n",
        at: &["scenes/0/source/file/§"],
        ..NOTHING
    },
    Group {
        heading: "`environment = { … }`",
        about: "Of `[import]` or a scene. `date`, `hour` and `latitude_deg` go with `sky`.",
        of: "Keys",
        file: "[import.environment]\nsky = \"clear\"\n§\n",
        at: &["scenes/0/source/file/environment/§"],
        ..NOTHING
    },
    Group {
        heading: "`home = { … }`",
        about: "Of a scene; [generated homes](homes.md) says what comes of it. Seeds that are not given follow from `seed`.",
        of: "HomeConfig",
        file: "[[scene]]\nname = \"a\"\n[scene.home]\n§\n",
        at: &["scenes/0/source/home/§"],
        ..NOTHING
    },
    Group {
        heading: "`[[object]]`",
        about: "Models that are placed in every scene; `[[scene.object]]` in one: [your own objects](compose.md).",
        of: "ObjectGroup",
        file: "[[object]]\nfiles = \"a.glb\"\non = \"floor\"\n§\n",
        at: &["scenes/0/objects/0/§"],
        ..NOTHING
    },
    Group {
        heading: "`[[motion]]`",
        about: "Things that move in every scene; `[[scene.motion]]` in one: [scenes that move](motion.md).",
        of: "MotionGroup",
        file: "[[motion]]\nof = \"a\"\ntimes_s = [0.0]\nangles_deg = [0.0]\n§\n",
        at: &["scenes/0/motions/0/§"],
        ..NOTHING
    },
    Group {
        heading: "`[render]`",
        about: "How light is traced, and which layers are kept.",
        of: "RenderSection",
        with: &["RenderKeys"],
        file: "[render]\n§\n",
        at: &["scenes/0/render/§", "scenes/0/§"],
        ..NOTHING
    },
    Group {
        heading: "`[camera]`",
        about: "What pictures are taken with: [cameras](cameras.md).",
        of: "CameraConfig",
        without: &["lens", "shutter", "stereo"],
        file: "[camera]\n§\n",
        at: &["scenes/0/camera/§"],
        ..NOTHING
    },
    Group {
        heading: "`lens = { … }`",
        about: "Of `[camera]`, for depth of field: with `focus_distance_m`, and `aperture_radius_m` or `f_number` and `focal_length_mm`.",
        of: "LensConfig",
        file: "[camera.lens]\naperture_radius_m = 0.01\nfocus_distance_m = 2\n§\n",
        at: &["scenes/0/camera/lens/§"],
        ..NOTHING
    },
    Group {
        heading: "`shutter = { … }`",
        about: "Of `[camera]`, for motion blur and rolling shutter.",
        of: "Shutter",
        file: "[camera.shutter]\nexposure_s = 0\n§\n",
        at: &["scenes/0/camera/shutter/§"],
        ..NOTHING
    },
    Group {
        heading: "`stereo = { … }`",
        about: "Of `[camera]`: a second camera beside each.",
        of: "StereoConfig",
        file: "[camera.stereo]\nbaseline_m = 0.1\n§\n",
        ..NOTHING
    },
    Group {
        heading: "`[plan]`",
        about: "Where pictures are taken from: [trajectories](trajectories.md).",
        of: "PlanKeys",
        file: "[plan]\n§\n",
        at: &["scenes/0/plan/§"],
        ..NOTHING
    },
    mode("`mode = { kind = \"video\", … }`", "VideoConfig", "[plan.mode]\nkind = \"video\"\n§\n"),
    mode("`mode = { kind = \"stills\", … }`", "StillsConfig", "[plan.mode]\nkind = \"stills\"\n§\n"),
    mode("`mode = { kind = \"photos\", … }`", "PhotosConfig", "[plan.mode]\nkind = \"photos\"\n§\n"),
    mode("`mode = { kind = \"coverage\", … }`", "CoverageConfig", "[plan.mode]\nkind = \"coverage\"\n§\n"),
    mode("`mode = { kind = \"objects\", … }`", "ObjectsConfig", "[plan.mode]\nkind = \"objects\"\n§\n"),
    mode("`mode = { kind = \"cameras\", … }`", "CamerasConfig", "[plan.mode]\nkind = \"cameras\"\n§\n"),
    mode("`mode = { kind = \"keyframes\", … }`", "KeyframesConfig", "[plan.mode]\nkind = \"keyframes\"\nfiles = [\"a.csv\"]\n§\n"),
    Group {
        heading: "`saliency = { kind = \"texture\", … }`",
        about: "Of `[plan]`: poses are chosen in proportion to n^`alpha` · (1 − e)^`beta`, where e is the share of pixels without a \
                surface. n counts the `triangles` in view, or the `parts`, or parts by their areas (`entropy`), or that with the contrast of \
                textures (`texture`). The other kinds have the same keys without `weight`.",
        of: "Saliency::texture",
        file: "[plan.saliency]\nkind = \"texture\"\n§\n",
        at: &["scenes/0/plan/saliency/§"],
        ..NOTHING
    },
    Group {
        heading: "`[carve]`",
        about: "How free space is found.",
        of: "CarveKeys",
        file: "[carve]\n§\n",
        at: &["scenes/0/carve/§"],
        ..NOTHING
    },
    Group {
        heading: "`[gate]`",
        about: "Which views are rendered: [gates](trajectories.md#gates-before-rendering).",
        of: "GateKeys",
        file: "[gate]\n§\n",
        at: &["scenes/0/gate/§"],
        ..NOTHING
    },
    Group {
        heading: "`[vary]`",
        about: "Variations of every scene: [what varies](vary.md). Only what has a key does.",
        of: "VaryKeys",
        file: "[vary]\ncount = 2\nexposure = [0, 0]\n§\n",
        at: &["scenes/1/varies/config/§"],
        ..NOTHING
    },
    varied("`lamps = { … }`", "LampVary", "[vary]\ncount = 2\n[vary.lamps]\n§\n", &["scenes/1/varies/config/lamps/§"]),
    varied("`sky = { … }`", "SkyVary", "[vary]\ncount = 2\n[vary.sky]\n§\n", &["scenes/1/varies/config/sky/§"]),
    varied("`materials = { … }`", "MaterialVary", "[vary]\ncount = 2\n[vary.materials]\n§\n", &["scenes/1/varies/config/materials/§"]),
    Group {
        heading: "`classes = { wall = { … }, … }`",
        about: "Of `materials`: the colours that a class of NYU40 may have.",
        of: "ColorRange",
        file: "[vary]\ncount = 2\n[vary.materials.classes.wall]\n§\n",
        at: &["scenes/1/varies/config/materials/classes/wall/§"],
        ..NOTHING
    },
    varied("`furniture = { … }`", "FurnitureVary", "[vary]\ncount = 2\n[vary.furniture]\n§\n", &["scenes/1/varies/config/furniture/§"]),
    varied("`clutter = { … }`", "ClutterVary", "[vary]\ncount = 2\n[vary.clutter]\n§\n", &["scenes/1/varies/config/clutter/§"]),
    Group {
        heading: "`[farm]`",
        about: "What nodes of a [farm](farm.md) do besides; at the top of the file alone.",
        of: "FarmKeys",
        file: "[farm]\nafter_frame = [\"true\"]\n§\n",
        at: &["farm/§"],
        ..NOTHING
    },
];

const fn mode(heading: &'static str, of: &'static str, file: &'static str) -> Group {
    Group { heading, about: "Of `[plan]`.", of, file, at: &["scenes/0/plan/mode/§"], ..NOTHING }
}

const fn varied(heading: &'static str, of: &'static str, file: &'static str, at: &'static [&'static str]) -> Group {
    Group { heading, about: "Of `[vary]`.", of, file, at, ..NOTHING }
}

impl Group {
    /// The keys of the table.
    fn keys<'s>(&self, sources: &'s Sources) -> Result<Vec<&'s Declared>, String> {
        let mut keys = Vec::new();
        for of in std::iter::once(&self.of).chain(self.with) {
            keys.extend(sources.fields(of)?.iter().filter(|key| !self.without.contains(&key.name.as_str())));
        }
        Ok(keys)
    }

    /// The meaning of a key.
    ///
    /// # Errors
    /// If it is not documented.
    fn sentence(&self, key: &Declared) -> Result<String, String> {
        let found = Some(key.doc.as_str()).filter(|doc| !doc.is_empty());
        found.map(sentence).ok_or_else(|| format!("`{}` of {} has no doc comment", key.name, self.of))
    }

    /// The file with the key, or without it except for required lines.
    fn with(&self, key: &str, value: Option<&str>) -> String {
        let given = value.map_or(String::new(), |value| format!("{key} = {value}"));
        let needed = |line: &&str| value.is_none() || !line.starts_with(&format!("{key} = "));
        let text = self.file.lines().filter(needed).collect::<Vec<_>>().join("\n").replace('§', &given);
        if text.contains("[[scene]]") { text } else { text + SCENE }
    }

    /// Whether a file needs the key.
    fn needs(&self, key: &str) -> bool {
        self.file.lines().any(|line| line.starts_with(&format!("{key} = ")))
    }
}

/// The page's tables.
///
/// # Errors
/// When a key has no doc comment, or the program cannot be asked.
pub fn tables(house: &House) -> Result<String, String> {
    let sources = Sources::read(house)?;
    let mut program = Program::start(house)?;
    let mut page = String::new();
    for group in &GROUPS {
        page += &format!("## {}\n\n{}\n\n| key | type | default | range | |\n|---|---|---|---|---|\n", group.heading, group.about);
        for key in group.keys(&sources)? {
            let (of, says) = (sources.in_words(&key.of), group.sentence(key)?);
            let (default, range) = (program.default(group, key, &sources)?, program.range(group, key, &of)?);
            page += &format!("| `{}` | {of} | {default} | {range} | {} |\n", key.name, says.replace('|', "\\|"));
        }
        page.push('\n');
    }
    Ok(page)
}

/// The example `resolve` of the pipeline, which resolves a file.
struct Program {
    child: Child,
    questions: Option<ChildStdin>,
    answers: Lines<BufReader<ChildStdout>>,
}

impl Program {
    fn start(house: &House) -> Result<Self, String> {
        let mut command = house.command(house.tested("examples/resolve")?, &[]);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().map_err(|error| format!("cannot run the example `resolve`: {error}"))?;
        let (questions, answers) = (child.stdin.take(), child.stdout.take().ok_or("the example `resolve` has no output")?);
        Ok(Self { child, questions, answers: BufReader::new(answers).lines() })
    }

    fn ask(&mut self, file: &str) -> Result<Value, String> {
        let questions = self.questions.as_mut().ok_or("the example `resolve` cannot be asked")?;
        writeln!(questions, "{}", json!(file)).map_err(|error| format!("the example `resolve` does not listen: {error}"))?;
        let answer = self.answers.next().ok_or("the example `resolve` says nothing")?.map_err(|error| error.to_string())?;
        serde_json::from_str(&answer).map_err(|error| format!("the example `resolve` says {answer:?}: {error}"))
    }

    /// The value that counts where a key is not given.
    fn default(&mut self, group: &Group, key: &Declared, sources: &Sources) -> Result<String, String> {
        let name = &key.name;
        if group.needs(name) || sources.in_words(&key.of) == "text" {
            return Ok(String::new());
        }
        let without = self.ask(&group.with(name, None))?;
        let Some(config) = without.get("config") else { return Err(format!("`{name}` cannot be left out: {}", without["error"])) };
        if let Some(value) = group.at.iter().find_map(|at| config.pointer(&format!("/{}", at.replace('§', name)))) {
            let is_empty = value.is_null() || value.as_array().is_some_and(Vec::is_empty);
            return Ok(if is_empty { "none".into() } else { format!("`{}`", toml(value)) });
        }
        // Not written because it is the default: the value that changes nothing.
        let none = ["true", "false", "1", "[-90, 90]"].map(String::from).to_vec();
        for value in sources.values(&key.of).unwrap_or(none) {
            if self.ask(&group.with(name, Some(&value)))? == without {
                return Ok(format!("`{value}`"));
            }
        }
        Ok("none".into())
    }

    /// The range that the program expects, if it refuses values that the type allows.
    fn range(&mut self, group: &Group, key: &Declared, of: &str) -> Result<String, String> {
        let mut ranges: Vec<String> = Vec::new();
        for value in doubtful(of) {
            let answer = self.ask(&group.with(&key.name, Some(&value)))?;
            let range = answer["error"]
                .as_str()
                .and_then(|message| expected(message, |named| named == key.name || group.file.contains(&format!(".{named}]"))));
            ranges.extend(range.filter(|range| !ranges.contains(range)));
        }
        Ok(ranges.join("; "))
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // Without questions it ends by itself.
        self.questions = None;
        let _ = self.child.wait();
    }
}

/// Values of a type that many a key cannot have.
fn doubtful(of: &str) -> Vec<String> {
    let numbers = ["-1e9", "0", "1e9"];
    let list = |n: usize, values: &[&str]| values.iter().map(|value| format!("[{}]", vec![*value; n].join(", "))).collect();
    match of {
        "number" => numbers.map(String::from).to_vec(),
        "whole number" => ["0", "4000000000"].map(String::from).to_vec(),
        "list of numbers" => list(1, &numbers),
        "2 whole numbers" => list(2, &["0", "4000000000"]),
        "2 numbers" => [list(2, &numbers), vec!["[2, 1]".into()]].concat(),
        "3 numbers" => list(3, &numbers),
        _ => Vec::new(),
    }
}

/// "between 0 and 1" of "noise must lie between 0 and 1, found 2", and "1 or more" of "rays = 0: expected 1 or more"; `None` where the
/// message is about a key that is not `meant`.
fn expected(message: &str, meant: impl Fn(&str) -> bool) -> Option<String> {
    if let Some((found, range)) = message.split_once("expected ") {
        let named = found.split_once(" = ").and_then(|(before, _)| before.rsplit(' ').next());
        return named.is_none_or(meant).then(|| range.into());
    }
    let range = message.split_once(" must ")?.1.split(", found").next()?;
    Some(["lie ", "be "].iter().find_map(|verb| range.strip_prefix(verb)).unwrap_or(range).into())
}

/// A value as TOML has it, on one line.
fn toml(value: &Value) -> String {
    match value {
        Value::Number(number) => {
            number.as_f64().filter(|v| v.fract() == 0.0 && v.abs() < 1e15).map_or(number.to_string(), |v| format!("{v:.0}"))
        }
        Value::Array(values) => format!("[{}]", values.iter().map(toml).collect::<Vec<_>>().join(", ")),
        Value::Object(table) => {
            let (kind, others): (Vec<_>, Vec<_>) = table.iter().partition(|(key, _)| *key == "kind");
            let pairs: Vec<String> = kind.iter().chain(&others).map(|(key, value)| format!("{key} = {}", toml(value))).collect();
            format!("{{ {} }}", pairs.join(", "))
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_type_and_a_sentence() {
        let sources = Sources::read(&House::find().unwrap()).unwrap();
        let mut names = Vec::new();
        for group in &GROUPS {
            for key in group.keys(&sources).unwrap() {
                let sentence = group.sentence(key).unwrap();
                assert!(sentence.len() > 12 && sentence.ends_with('.'), "{}: {sentence}", key.name);
                assert!(!sources.in_words(&key.of).is_empty());
                names.push(key.name.clone());
            }
        }
        for key in ["samples", "size", "K", "blades", "fps", "weight", "rooms", "latitude_deg", "after_frame", "max_plane_share"] {
            assert!(names.iter().any(|name| name == key), "{key}");
        }
    }

    #[test]
    fn ranges_are_read_from_messages() {
        for (message, range) in [
            ("noise must lie between 0 and 1, found 2", "between 0 and 1"),
            ("rays = 0: expected 64 or more", "64 or more"),
            ("in `home`: clutter must lie between 0 and 4, found 9", "between 0 and 4"),
            ("a length must be 0 or more metres, found -1", "0 or more metres"),
        ] {
            assert_eq!(expected(message, |key| key == "rays").unwrap(), range);
        }
        assert_eq!(expected("two scenes have the name", |_| true), None);
        assert_eq!(expected("in `carve`: extent_m = 30: expected a length of at least one voxel", |key| key == "voxel_m"), None);
    }
}
