//! Documentation of the structs and enums that are read from files, from doc comments in the code: names, types in words, and sentences.

use super::fields::{Declared, argument, declared, last_name, serde_word, text};
use super::tables::{self, Tables};
use crate::house::House;
use std::collections::HashMap;
use syn::{Expr, Item, ItemEnum, Lit, Macro, Type};

/// Files that declare the contents of `dataset.toml`.
const FILES: [&str; 24] = [
    "crates/pipeline/src/config/document.rs",
    "crates/pipeline/src/config/settings.rs",
    "crates/pipeline/src/config/choices.rs",
    "crates/pipeline/src/config/camera.rs",
    "crates/pipeline/src/config/farm.rs",
    "crates/pipeline/src/config/import.rs",
    "crates/pipeline/src/config/rendering.rs",
    "crates/explore/src/preset.rs",
    "crates/explore/src/saliency.rs",
    "crates/explore/src/carve/config.rs",
    "crates/explore/src/plan/config.rs",
    "crates/render/src/config.rs",
    "crates/verify/src/view_gates/config.rs",
    "crates/home/src/config.rs",
    "crates/home/src/states.rs",
    "crates/home/src/building.rs",
    "crates/furniture/src/room_kind.rs",
    "crates/home/src/light/mod.rs",
    "crates/home/src/light/outside/mod.rs",
    "crates/vary/src/config.rs",
    "crates/compose/src/group.rs",
    "crates/compose/src/motion.rs",
    "crates/import/src/environment.rs",
    "crates/import/src/options.rs",
];
/// More of them, whose crates are not about configuration.
const OTHERS: [&str; 8] = [
    "crates/python/src/dataset_options.rs",
    "crates/python/src/render_options.rs",
    "crates/scene/src/camera/lens.rs",
    "crates/dataset/src/record.rs",
    "crates/pipeline/src/request/options.rs",
    "crates/export/src/options.rs",
    "crates/farm/src/plan.rs",
    "crates/farm/src/submit.rs",
];

/// Structs and enums by name.
#[derive(Default)]
pub struct Sources {
    structs: HashMap<String, Vec<Declared>>,
    enums: HashMap<String, Variants>,
}

/// The variants of an enum.
struct Variants {
    /// Names of the variants as files have them.
    names: Vec<String>,
    /// Names of the variants in Rust.
    idents: Vec<String>,
    /// True if variants have values, so that files have a table with a `kind`.
    hold_values: bool,
}

impl Sources {
    /// Reads the code.
    ///
    /// # Errors
    /// When a file cannot be read or is not Rust.
    pub fn read(house: &House) -> Result<Self, String> {
        let mut sources = Self::default();
        for file in FILES.iter().chain(&OTHERS) {
            let items = syn::parse_file(&house.read(file)?).map_err(|error| format!("{file}: {error}"))?.items;
            items.into_iter().try_for_each(|item| sources.take(item)).map_err(|error| format!("{file}: {error}"))?;
        }
        Ok(sources)
    }

    fn take(&mut self, item: Item) -> syn::Result<()> {
        match item {
            Item::Struct(item) => {
                self.structs.insert(item.ident.to_string(), item.fields.iter().filter_map(declared).collect());
            }
            Item::Enum(item) => self.take_enum(item),
            Item::Macro(item) if item.mac.path.is_ident("words") => self.take_enum(item.mac.parse_body()?),
            Item::Macro(item) => self.take_structs(&item.mac)?,
            _ => {}
        }
        Ok(())
    }

    /// Takes the structs that the macros of `options` declare.
    fn take_structs(&mut self, found: &Macro) -> syn::Result<()> {
        let Tables(tables) = match found.path.get_ident().map(ToString::to_string).as_deref() {
            Some("options") => found.parse_body_with(tables::options)?,
            Some("keys") => found.parse_body_with(tables::keys)?,
            _ => return Ok(()),
        };
        self.structs.extend(tables);
        Ok(())
    }

    /// Variants with fields are structs called `Enum::variant`.
    fn take_enum(&mut self, item: ItemEnum) {
        let style = serde_word(&item.attrs, "rename_all").unwrap_or_default();
        let mut names = Vec::new();
        for variant in &item.variants {
            let own = || serde_word(&variant.attrs, "rename").unwrap_or_else(|| renamed(&variant.ident.to_string(), &style));
            let name = variant.discriminant.as_ref().and_then(|(_, word)| text(word)).unwrap_or_else(own);
            let fields = variant.fields.iter().filter_map(declared).collect();
            self.structs.insert(format!("{}::{name}", item.ident), fields);
            names.push(name);
        }
        let idents = item.variants.iter().map(|variant| variant.ident.to_string()).collect();
        let hold_values = item.variants.iter().any(|variant| !variant.fields.is_empty());
        self.enums.insert(item.ident.to_string(), Variants { names, idents, hold_values });
    }

    /// The fields of a struct.
    ///
    /// # Errors
    /// When there is no such struct in these files.
    pub fn fields(&self, name: &str) -> Result<&[Declared], String> {
        self.structs
            .get(name)
            .map(Vec::as_slice)
            .ok_or_else(|| format!("no struct {name} is declared in the files of xtask/src/docs/sources.rs"))
    }

    /// Every value of an enum, as TOML; `None` for other types.
    pub fn values(&self, of: &Type) -> Option<Vec<String>> {
        let Variants { names, hold_values, .. } = self.enums.get(&last_name(of)?)?;
        let value = |name: &String| if *hold_values { format!("{{ kind = \"{name}\" }}") } else { format!("\"{name}\"") };
        Some(names.iter().map(value).collect())
    }

    /// The value of an enum whose variant has this name in Rust, as TOML; `None` for other types.
    pub fn word(&self, of: &Type, variant: &str) -> Option<String> {
        let Variants { names, idents, .. } = self.enums.get(&last_name(of)?)?;
        idents.iter().position(|ident| ident == variant).map(|place| format!("\"{}\"", names[place]))
    }

    /// A type in words.
    pub fn in_words(&self, of: &Type) -> String {
        if let Some(values) = self.values(of) {
            return values.iter().map(|value| format!("`{value}`")).collect::<Vec<_>>().join(", ");
        }
        match of {
            Type::Array(array) => {
                let Expr::Lit(length) = &array.len else { return "list".into() };
                let Lit::Int(n) = &length.lit else { return "list".into() };
                match &*array.elem {
                    Type::Array(_) => format!("{n} rows of {}", self.in_words(&array.elem)),
                    element => format!("{n} {}s", self.in_words(element)),
                }
            }
            _ => match last_name(of).as_deref() {
                Some("u16" | "u32" | "u64" | "usize" | "Whole") => "whole number".into(),
                Some("f32" | "f64") => "number".into(),
                Some("bool") => "true or false".into(),
                Some("String" | "PathBuf") => "text".into(),
                Some("Vec") => argument(of).map_or("list".into(), |element| match self.in_words(element) {
                    words if words.contains('"') || words == "text" => format!("list of {words}"),
                    words => format!("list of {words}s"),
                }),
                Some("Many" | "Files") => "text, or list of texts".into(),
                Some("Number") => "whole number, or 2 of them".into(),
                Some("Extent") => "number, or 2 numbers".into(),
                Some("ClassWord") => "text, or number".into(),
                Some("ProductKey") => "product".into(),
                Some("CamerasKey") => "list, or `\"found\"`".into(),
                _ => "table".into(),
            },
        }
    }
}

/// The first paragraph of a doc comment on one line, with links to code as code.
pub fn paragraph(doc: &str) -> String {
    doc.split("  ").next().unwrap_or_default().replace("[`", "`").replace("`]", "`")
}

/// The first sentence of a doc comment, with links to code as code.
pub fn sentence(doc: &str) -> String {
    let end = doc.match_indices(". ").map(|(at, _)| at).find(|at| !doc[..*at].ends_with(['.', 'g'])).map_or(doc.len(), |at| at + 1);
    let first = doc[..end].replace("[`", "`").replace("`]", "`");
    if first.ends_with(['.', '?']) { first } else { format!("{first}.") }
}

/// Name of a variant as serde writes it in this style.
fn renamed(name: &str, style: &str) -> String {
    let separator = match style {
        "snake_case" => "_",
        "kebab-case" => "-",
        "lowercase" => "",
        _ => return name.into(),
    };
    let words = name.char_indices().map(|(i, c)| if i > 0 && c.is_uppercase() { format!("{separator}{c}") } else { c.to_string() });
    words.collect::<String>().to_lowercase()
}
