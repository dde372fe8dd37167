//! The classes that a scene's labels choose from: NYU40, or a list of the user's.

use super::Viewer;
use crate::serve::ApiProblem;
use enfilade_dataset::Elements;
use enfilade_dataset::hdf5::read_array;
use enfilade_scene::NYU40;
use serde::Deserialize;
use serde_json::{Value, json};

/// The list, where the scene was annotated with one.
const LIST: &str = "semantic_label_descs.csv";
/// Row `i` is the colour of class `i`; -1 where there is none.
const COLORS: &str = "metadata_semantic_colors.hdf5";

/// A row of [`LIST`].
#[derive(Deserialize)]
struct Listed {
    semantic_id: i16,
    semantic_name: String,
    semantic_color_r: u8,
    semantic_color_g: u8,
    semantic_color_b: u8,
}

impl Viewer {
    /// Number, name and colour of each class of a scene.
    ///
    /// # Errors
    /// 403 when a file lies outside of the dataset, 500 when the list is damaged.
    pub(super) fn classes(&self, scene: &str) -> Result<Vec<Value>, ApiProblem> {
        let colors = self.colors_of_classes(scene)?;
        // A list that ends elsewhere than the colours is left over: the labels were made from another since.
        let is_current = |list: &Vec<Listed>| {
            let last = list.iter().map(|class| usize::try_from(class.semantic_id).unwrap_or(0)).max();
            colors.is_empty() || last.is_some_and(|last| last + 1 == colors.len())
        };
        if let Some(list) = self.mesh_table::<Listed>(scene, LIST)?.filter(is_current) {
            let class = |c: &Listed| {
                let color = [c.semantic_color_r, c.semantic_color_g, c.semantic_color_b];
                json!({ "id": c.semantic_id, "name": c.semantic_name, "color": color })
            };
            return Ok(list.iter().map(class).collect());
        }
        let class = |id: usize| {
            let known = NYU40.get(id - 1);
            let own = colors.get(id).filter(|color| color.iter().all(|channel| (0..256).contains(channel)));
            let color = own.copied().or(known.map(|class| class.color.map(i64::from)))?;
            Some(json!({ "id": id, "name": known.map_or_else(|| id.to_string(), |class| class.name.into()), "color": color }))
        };
        Ok((1..colors.len().max(NYU40.len() + 1)).filter_map(class).collect())
    }

    /// The scene's own colours; none where it has no table of them.
    fn colors_of_classes(&self, scene: &str) -> Result<Vec<[i64; 3]>, ApiProblem> {
        let path = self.layout().mesh_file(scene, COLORS);
        self.allow(&path)?;
        Ok(match read_array(&path).map(|array| array.values) {
            Ok(Elements::I64(values)) => values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
            _ => Vec::new(),
        })
    }
}
