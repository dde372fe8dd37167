//! The table of all layers, from `LAYERS` in `crates/frame/src/spec.rs`, with the pictures of `docs/layers/`.

use crate::house::House;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Expr, Ident, Item, LitInt, LitStr, Token};

const TABLE: &str = "crates/frame/src/spec.rs";
/// Folder in which `cargo xtask pictures` puts a picture of each.
pub const PICTURES: &str = "docs/layers";

/// Titles of the passes, in the order of the page.
const PASSES: [(&str, &str); 7] = [
    ("Final", "## Light and colour\n\nIn `scene_cam_XX_final_hdf5`, filtered over the pixel."),
    ("Geometry", "## Geometry\n\nIn `scene_cam_XX_geometry_hdf5`: point samples at pixel centres."),
    ("Label", "## Labels\n\nAlso in the geometry folder, joined from `render_entity_id` after rendering."),
    ("Rendered", "## As rendered, before denoising\n\nAlso in the final folder, unless `keep_rendered = false`."),
    ("Guides", "## What guides denoising\n\nAlso in the final folder, unless `keep_rendered = false`."),
    ("LightParts", "## Light in parts\n\nAlso in the final folder, with `--light-parts` or `light_parts = true`."),
    ("Extra", "## More per pixel\n\nAlso in the geometry folder, with `--extra` or `extra = true`."),
];

/// A row of the table.
pub struct Layer {
    pub name: String,
    pass: String,
    channels: usize,
    dtype: String,
    unit: String,
    space: String,
    sentinel: String,
    description: String,
}

impl Parse for Layer {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        input.parse::<Ident>()?;
        let name = input.parse::<LitStr>()?.value();
        let pass = input.parse::<Ident>()?.to_string();
        let channels = input.parse::<LitInt>()?.base10_parse()?;
        let dtype = input.parse::<Ident>()?.to_string();
        let text = || {
            input.parse::<Token![,]>()?;
            Ok::<_, syn::Error>(input.parse::<LitStr>()?.value())
        };
        let (unit, space, sentinel, description) = (text()?, text()?, text()?, text()?);
        Ok(Self { name, pass, channels, dtype, unit, space, sentinel, description })
    }
}

impl Layer {
    /// Row of the layer on the page; `picture` is that in the folder of the page, if there is one.
    fn row(&self, picture: Option<&str>) -> String {
        let Self { name, unit, space, sentinel, description, .. } = self;
        let picture = picture.map_or(String::new(), |file| format!("![{name}](layers/{file})"));
        let dtype = match self.dtype.as_str() {
            "F16" => "float16",
            "F32" => "float32",
            "I16" => "int16",
            "U8" => "uint8",
            other => other,
        };
        let shape = if self.channels == 1 { "H × W".to_string() } else { format!("H × W × {}", self.channels) };
        let unit = if unit.is_empty() { "pure number" } else { unit };
        let space = if space.is_empty() { String::new() } else { format!("; {space}") };
        format!("| {picture} | **`{name}`**<br>{dtype}, {shape} | {description} | {unit}{space} | {sentinel} |\n")
    }
}

/// The rows of the table in the code.
///
/// # Errors
/// When it cannot be read, or is not where it was.
pub fn read(house: &House) -> Result<Vec<Layer>, String> {
    let file = syn::parse_file(&house.read(TABLE)?).map_err(|error| format!("{TABLE}: {error}"))?;
    let table = file.items.iter().find_map(|item| match item {
        Item::Const(item) if item.ident == "LAYERS" => {
            if let Expr::Macro(table) = &*item.expr {
                Some(&table.mac)
            } else {
                None
            }
        }
        _ => None,
    });
    let table = table.ok_or_else(|| format!("{TABLE} has no LAYERS = layers![…]"))?;
    let rows = table.parse_body_with(Punctuated::<Layer, Token![;]>::parse_terminated);
    Ok(rows.map_err(|error| format!("{TABLE}: {error}"))?.into_iter().collect())
}

/// The page's tables.
///
/// # Errors
/// When the code cannot be read.
pub fn tables(house: &House) -> Result<String, String> {
    let (layers, mut page) = (read(house)?, String::new());
    for (pass, about) in PASSES {
        page += &format!("{about}\n\n| | layer | meaning | unit and space | where nothing is hit |\n|---|---|---|---|---|\n");
        for layer in layers.iter().filter(|layer| layer.pass == pass) {
            page += &layer.row(picture(house, &layer.name).as_deref());
        }
        page.push('\n');
    }
    Ok(page)
}

/// The picture of a layer, by its file's name, where there is one.
pub fn picture(house: &House, layer: &str) -> Option<String> {
    let file = format!("{layer}.jpg");
    house.root.join(PICTURES).join(&file).is_file().then_some(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layer_is_in_a_table_of_the_page() {
        let house = House::find().unwrap();
        let (layers, page) = (read(&house).unwrap(), tables(&house).unwrap());
        assert!(layers.len() > 40);
        for layer in layers {
            assert!(page.contains(&format!("**`{}`**", layer.name)), "{}", layer.name);
        }
        assert!(page.contains("| **`depth_z_meters`**<br>float32, H × W | Planar depth: distance along the viewing axis. | m | NaN |"));
    }
}
