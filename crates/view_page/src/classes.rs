//! The classes that a scene's labels choose from: NYU40, or a list of the user's.

use super::place::problem;
use super::viewer::Viewer;
use enfilade_dataset::hdf5::read_array;
use enfilade_dataset::{CLASS_LIST, Elements, MeshFiles, mesh_names};
use enfilade_scene::NYU40;
use enfilade_serve::ApiProblem;
use serde_json::{Value, json};

impl Viewer {
    /// Number, name and colour of each class of a scene.
    ///
    /// # Errors
    /// 403 if a file is outside of the dataset, 500 if the list is damaged.
    pub(super) fn classes(&self, scene: &str) -> Result<Vec<Value>, ApiProblem> {
        let files = self.dataset.mesh_files(scene);
        self.allow_all([files.file(CLASS_LIST), files.file(mesh_names::SEMANTIC_COLORS)])?;
        if let Some(own) = files.read_classes().map_err(problem)? {
            return Ok(own.list().iter().map(|class| json!(class)).collect());
        }
        let colors = colors_of_classes(&files);
        let class = |id: usize| {
            let known = NYU40.get(id - 1);
            let own = colors.get(id).filter(|color| color.iter().all(|channel| (0..256).contains(channel)));
            let color = own.copied().or(known.map(|class| class.color.map(i64::from)))?;
            Some(json!({ "id": id, "name": known.map_or_else(|| id.to_string(), |class| class.name.into()), "color": color }))
        };
        Ok((1..colors.len().max(NYU40.len() + 1)).filter_map(class).collect())
    }
}

/// The scene's own colours: row `i` is for class `i`, -1 where there is none. Empty if it has no table of them.
fn colors_of_classes(files: &MeshFiles) -> Vec<[i64; 3]> {
    match read_array(&files.file(mesh_names::SEMANTIC_COLORS)).map(|array| array.values) {
        Ok(Elements::I64(values)) => values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        _ => Vec::new(),
    }
}
