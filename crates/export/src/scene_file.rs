//! A scene with its labels as one file, and perhaps others beside it, in the form that the file's name calls for.

use crate::{ExportError, SceneGltf, scene_gltf};
use enfilade_physics::{Model, mjcf, simulated, urdf, usd};
use enfilade_scene::{EncodedScene, Labels, PictureFiles, Scene, SceneFiles, to_bytes, to_bytes_with_labels};
use std::path::Path;

/// A form of a scene's file.
struct Form {
    /// How names of such files end.
    extension: &'static str,
    /// What it is for, after the ending in a message.
    about: &'static str,
    encode: fn(&Given) -> EncodedScene,
}

/// All forms.
static FORMS: [Form; 5] = [
    Form { extension: "scene", about: "a package, nothing is lost", encode: package },
    Form { extension: "glb", about: "glTF, for other programs", encode: glb },
    Form { extension: "xml", about: "MJCF, for MuJoCo", encode: |given| simulator(given, mjcf) },
    Form { extension: "urdf", about: "for simulators of robots", encode: |given| simulator(given, urdf) },
    Form { extension: "usda", about: "USD with physics", encode: |given| simulator(given, usd) },
];

/// A scene to write.
struct Given<'s> {
    scene: &'s Scene,
    labels: Option<&'s Labels>,
    pictures: &'s PictureFiles,
    /// Name of the file without its ending.
    name: &'s str,
}

/// Returns the files of a scene with its labels, and notes on what they cannot represent; pictures whose files are available may be passed on
/// as they are.
pub type SceneEncoder = Box<dyn Fn(&Scene, Option<&Labels>, &PictureFiles) -> EncodedScene + Send + Sync>;

/// The encoder for a file of this name: as a package (`.scene`), as binary glTF (`.glb`), or as bodies for simulators (`.xml`, `.urdf`, `.usda`).
///
/// # Errors
/// When the name ends otherwise.
pub fn scene_encoder(output: &Path) -> Result<SceneEncoder, ExportError> {
    let extension = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let Some(form) = FORMS.iter().find(|form| Some(form.extension) == extension.as_deref()) else {
        let forms: Vec<String> = FORMS.iter().map(|form| format!(".{} ({})", form.extension, form.about)).collect();
        let (name, forms) = (output.display(), forms.join(", "));
        let problem = format!("cannot tell from the name {name} how to write the scene; end it with one of {forms}");
        return Err(ExportError::Selection(problem));
    };
    let name = output.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned());
    Ok(Box::new(move |scene, labels, pictures| (form.encode)(&Given { scene, labels, pictures, name: &name })))
}

fn package(given: &Given) -> EncodedScene {
    Ok(given.labels.map_or_else(|| to_bytes(given.scene), |labels| to_bytes_with_labels(given.scene, labels)).into())
}

fn glb(given: &Given) -> EncodedScene {
    let SceneGltf { glb, notes } = scene_gltf(given.scene, given.labels.unwrap_or(&Labels::default()), given.pictures);
    Ok(SceneFiles { notes, ..glb.into() })
}

fn simulator(given: &Given, write: fn(&Model, &str, &str) -> SceneFiles) -> EncodedScene {
    let model = simulated(given.scene, given.labels.unwrap_or(&Labels::default()))?;
    Ok(write(&model, given.name, &format!("{}_files", given.name)))
}
