//! Options of an export, declared once: flags of `export`, and keywords of Python's.

use crate::error::ExportError;
use crate::{ExportConfig, Format, Selection};
use enfilade_frame::Layer;
use enfilade_options::{Whole, named, options, words};

options! {
    /// Options of an export beside its format and its frames.
    #[derive(Clone, Debug, PartialEq)]
    pub struct ExportOptions {
        /// Only these layers, of those that the format supports.
        pub layers: Option<Vec<String>> = None => named("NAME,NAME"),
        /// With webdataset and huggingface: largest size of a file in megabytes.
        pub shard_mb: Whole<1> = Whole::new(1000) => named("MB"),
        /// With spatiallm: points of what the frames show, and its rooms ("frames"); or of the whole mesh, and all rooms ("mesh").
        pub cloud: CloudSource = CloudSource::Frames => named("FROM"),
        /// With bop, for objects that `[[object]]` placed: which rotations of a model count as its symmetries.
        pub symmetries: SymmetryRule = SymmetryRule::Shape => named("RULE"),
    }
}

words! {
    /// Which rotations of a model count as its symmetries. Colours and pictures on a model are not looked at.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum SymmetryRule {
        /// Those that move no point of the surface away from it by more than 2 % of the model's diameter.
        Shape = "shape",
        /// By shape with BOP's tolerance: 15 mm, or 10 % of the diameter if that is more.
        Bop = "bop",
        /// None: for models that their colours tell apart from every side.
        None = "none",
    }
}

words! {
    /// The source of a point cloud.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum CloudSource {
        /// The surfaces that the frames show, one point for every cubic centimetre.
        Frames = "frames",
        /// The scene's mesh: all surfaces, those that no frame shows too, two centimetres apart. Colours are those of the frames, or grey.
        Mesh = "mesh",
    }
}

impl ExportOptions {
    /// The largest size of a file, bytes.
    pub(crate) fn shard_bytes(&self) -> u64 {
        u64::from(self.shard_mb.get()) * 1_000_000
    }

    /// The settings of an export of these frames, of which it uses the layers of the options.
    ///
    /// # Errors
    /// When there is no layer of a name.
    pub fn config(&self, format: Format, frames: Selection) -> Result<ExportConfig, ExportError> {
        let layer = |name: &String| Layer::named(name.trim()).map_err(ExportError::Selection);
        let layers = self.layers.as_ref().map(|names| names.iter().map(layer).collect()).transpose()?;
        let selection = Selection { layers, ..frames };
        Ok(ExportConfig { format, selection, shard_bytes: self.shard_bytes(), cloud: self.cloud, symmetries: self.symmetries })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_given_is_as_in_a_configuration_of_everything() {
        let config = ExportOptions::default().config(Format::Coco, Selection::default()).unwrap();
        assert_eq!(config, ExportConfig::new(Format::Coco, Vec::new()));
        assert_eq!((config.shard_bytes, config.cloud), (1_000_000_000, CloudSource::Frames));
    }

    #[test]
    fn layers_are_known_by_their_names() {
        let options = |name: &str| ExportOptions { layers: Some(vec![name.into()]), ..ExportOptions::default() };
        let config = options(" color").config(Format::Exr, Selection::default()).unwrap();
        assert_eq!(config.selection.layers, Some(vec![Layer::Color]));
        let error = options("colour").config(Format::Exr, Selection::default()).unwrap_err();
        assert!(error.is_usage() && error.to_string().contains("there is no layer \"colour\"; the layers are: color, "), "{error}");
    }
}
