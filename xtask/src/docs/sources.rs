//! What doc comments in the code say of structs and enums that are read from files: names, types in words, and sentences.

use crate::house::House;
use std::collections::HashMap;
use syn::parse::{Parse, ParseStream};
use syn::{Attribute, Expr, Field, GenericArgument, Ident, Item, ItemEnum, Lit, Meta, PathArguments, Token, Type, braced};

/// Where what `dataset.toml` consists of is declared.
const FILES: [&str; 17] = [
    "crates/pipeline/src/config/document.rs",
    "crates/pipeline/src/config/patch.rs",
    "crates/pipeline/src/config/settings.rs",
    "crates/pipeline/src/config/choices.rs",
    "crates/pipeline/src/config/camera.rs",
    "crates/pipeline/src/config/farm.rs",
    "crates/explore/src/preset.rs",
    "crates/explore/src/saliency.rs",
    "crates/explore/src/carve/config.rs",
    "crates/explore/src/plan/config.rs",
    "crates/render/src/config.rs",
    "crates/verify/src/view_gates/config.rs",
    "crates/home/src/config.rs",
    "crates/home/src/room/kind.rs",
    "crates/home/src/light/mod.rs",
    "crates/import/src/environment.rs",
    "crates/import/src/options.rs",
];
/// More of them, whose crates are not about configuration.
const OTHERS: [&str; 2] = ["crates/scene/src/camera/lens.rs", "crates/dataset/src/record.rs"];

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
    /// True where variants hold values, so that files have a table with a `kind`.
    hold_values: bool,
}

/// A field of a struct, or of a struct variant.
pub struct Declared {
    /// Name of the field as files have it.
    pub name: String,
    /// Rust type of the field without `Option` and `Spanned`.
    pub of: Type,
    /// Doc comment of the field, on one line.
    pub doc: String,
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
            // `section!` of patch.rs.
            Item::Macro(item) if item.mac.path.is_ident("section") => {
                let section: Section = item.mac.parse_body()?;
                self.structs.insert(section.name, section.fields);
            }
            _ => {}
        }
        Ok(())
    }

    /// Variants with fields are structs called `Enum::variant`.
    fn take_enum(&mut self, item: ItemEnum) {
        let style = serde_word(&item.attrs, "rename_all").unwrap_or_default();
        let mut names = Vec::new();
        for variant in &item.variants {
            let name = serde_word(&variant.attrs, "rename").unwrap_or_else(|| renamed(&variant.ident.to_string(), &style));
            let fields = variant.fields.iter().filter_map(declared).collect();
            self.structs.insert(format!("{}::{name}", item.ident), fields);
            names.push(name);
        }
        let hold_values = item.variants.iter().any(|variant| !variant.fields.is_empty());
        self.enums.insert(item.ident.to_string(), Variants { names, hold_values });
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

    /// The doc comment of a field in the first of these structs that has one.
    pub fn doc(&self, name: &str, structs: &[&str]) -> Option<&str> {
        let fields = structs.iter().filter_map(|of| self.structs.get(*of)).flatten();
        fields.filter(|field| field.name == name).map(|field| field.doc.as_str()).find(|doc| !doc.is_empty())
    }

    /// Every value of an enum, as TOML; `None` for other types.
    pub fn values(&self, of: &Type) -> Option<Vec<String>> {
        let Variants { names, hold_values } = self.enums.get(&last_name(of)?)?;
        let value = |name: &String| if *hold_values { format!("{{ kind = \"{name}\" }}") } else { format!("\"{name}\"") };
        Some(names.iter().map(value).collect())
    }

    /// What to write for a type, in words.
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
                Some("u16" | "u32" | "u64" | "usize") => "whole number".into(),
                Some("f32" | "f64") => "number".into(),
                Some("bool") => "true or false".into(),
                Some("String" | "PathBuf") => "text".into(),
                Some("Vec") => argument(of).map_or("list".into(), |element| match self.in_words(element) {
                    words if words.contains('"') || words == "text" => format!("list of {words}"),
                    words => format!("list of {words}s"),
                }),
                Some("ProductKey") => "product".into(),
                Some("CamerasKey") => "list, or `\"found\"`".into(),
                _ => "table".into(),
            },
        }
    }
}

/// A section of patch.rs: `Name => Target { field: Type, … } with { /// doc field: Type, … }`.
struct Section {
    name: String,
    fields: Vec<Declared>,
}

impl Parse for Section {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let name: Ident = input.parse()?;
        input.parse::<Token![=>]>()?;
        input.parse::<Type>()?;
        let mut fields = Vec::new();
        loop {
            let content;
            braced!(content in input);
            let list = content.parse_terminated(Field::parse_named, Token![,])?;
            fields.splice(0..0, list.iter().filter_map(declared));
            if input.is_empty() {
                return Ok(Self { name: name.to_string(), fields });
            }
            input.parse::<Ident>()?;
        }
    }
}

fn declared(field: &Field) -> Option<Declared> {
    let name = serde_word(&field.attrs, "rename").or_else(|| Some(field.ident.as_ref()?.to_string()))?;
    let mut of = field.ty.clone();
    while matches!(last_name(&of).as_deref(), Some("Option" | "Spanned")) {
        of = argument(&of)?.clone();
    }
    Some(Declared { name, of, doc: doc(&field.attrs) })
}

/// A doc comment on one line.
pub fn doc(attributes: &[Attribute]) -> String {
    doc_lines(attributes).join(" ").trim().to_string()
}

/// The lines of a doc comment.
pub fn doc_lines(attributes: &[Attribute]) -> Vec<String> {
    let line = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(text) => {
                if let Lit::Str(text) = &text.lit {
                    Some(text.value())
                } else {
                    None
                }
            }
            _ => None,
        },
        _ => None,
    };
    attributes.iter().filter_map(line).map(|line| line.strip_prefix(' ').unwrap_or(&line).to_string()).collect()
}

/// The first sentence of a doc comment, with links to code as code.
pub fn sentence(doc: &str) -> String {
    let end = doc.match_indices(". ").map(|(at, _)| at).find(|at| !doc[..*at].ends_with(['.', 'g'])).map_or(doc.len(), |at| at + 1);
    let first = doc[..end].replace("[`", "`").replace("`]", "`");
    if first.ends_with(['.', '?']) { first } else { format!("{first}.") }
}

/// The value of `key` in a `#[serde(…)]` of these.
fn serde_word(attributes: &[Attribute], key: &str) -> Option<String> {
    let mut found = None;
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("serde")) {
        // What else serde is told has other forms, and is of no interest.
        let _ = attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident(key) {
                found = Some(meta.value()?.parse::<syn::LitStr>()?.value());
            } else if meta.input.peek(Token![=]) {
                meta.value()?.parse::<Expr>()?;
            }
            Ok(())
        });
    }
    found
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

/// `Vec` of `std::vec::Vec<T>`.
pub fn last_name(of: &Type) -> Option<String> {
    if let Type::Path(path) = of { Some(path.path.segments.last()?.ident.to_string()) } else { None }
}

/// `T` of `Vec<T>`.
fn argument(of: &Type) -> Option<&Type> {
    let Type::Path(path) = of else { return None };
    let PathArguments::AngleBracketed(arguments) = &path.path.segments.last()?.arguments else { return None };
    arguments.args.iter().find_map(|argument| if let GenericArgument::Type(of) = argument { Some(of) } else { None })
}
