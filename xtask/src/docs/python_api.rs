//! The Python module: signatures from its stubs, and documentation from their source, in Rust or in Python.

use super::fields::doc_lines;
use super::signatures::{options_of, without_marks};
use super::sources::{Sources, paragraph};
use crate::house::House;
use std::collections::HashMap;
use syn::{Attribute, ImplItem, Item, LitStr, Type};

/// A module, its stub, and the files with its part in Python.
const MODULES: [(&str, &str, &[&str]); 2] = [
    ("enfilade", "crates/python/enfilade/__init__.pyi", &["crates/python/enfilade/_frames.py", "crates/python/enfilade/_recorder.py"]),
    ("enfilade.farm", "crates/python/enfilade/farm.pyi", &["crates/python/enfilade/farm.py"]),
];

/// Folder of the part in Rust.
const RUST: &str = "crates/python/src";

/// A class, function or constant of a stub.
struct Declared<'s> {
    name: &'s str,
    /// Lines of the declaration.
    stub: String,
}

impl Declared<'_> {
    fn has_functions(&self) -> bool {
        self.stub.contains("def ")
    }
}

/// The page's headings, each with a signature and its documentation.
///
/// # Errors
/// When a file cannot be read.
pub fn page(house: &House) -> Result<String, String> {
    let docs = written_in_rust(house)?;
    let sources = Sources::read(house)?;
    let mut page = String::new();
    for (module, stub, source) in MODULES {
        let (stub, source) = (house.read(stub)?, read_all(house, source)?);
        let short = module.strip_prefix("enfilade.").map_or(String::new(), |name| format!("{name}."));
        let (explained, plain): (Vec<Declared>, Vec<Declared>) = declarations(&stub).into_iter().partition(Declared::has_functions);
        page += &format!("## {module}\n\n");
        for declared in explained {
            page += &entry(module, &short, &declared, &docs, &source, &sources)?;
        }
        if !plain.is_empty() {
            let stubs: Vec<&str> = plain.iter().map(|declared| declared.stub.as_str()).collect();
            page += &format!("### Constants, errors and types\n\n```python\n{}\n```\n\n", stubs.join("\n"));
        }
    }
    Ok(page)
}

/// A heading with what belongs to it.
fn entry(
    module: &str,
    short: &str,
    declared: &Declared,
    docs: &HashMap<String, Vec<String>>,
    source: &str,
    sources: &Sources,
) -> Result<String, String> {
    let Declared { name, stub } = declared;
    let mut text = format!("### {module}.{name}\n\n```python\n{}\n```\n\n", without_marks(stub));
    let own = written_in_python(source, name).or_else(|| docs.get(&format!("{short}{name}")).cloned());
    if let Some(lines) = own {
        text += &(markdown(&with_options(lines, stub, name, sources)?) + "\n");
    }
    let methods = stub.lines().filter_map(|line| line.strip_prefix("    def ")?.split('(').next());
    for method in methods {
        if let Some(lines) = docs.get(&format!("{name}.{method}")) {
            text += &format!("**`{method}`**: {}\n", markdown(&with_options(lines.clone(), stub, method, sources)?));
        }
    }
    Ok(text)
}

/// The lines of a doc comment with the options that a function takes in place of a line `{options}`.
fn with_options(mut lines: Vec<String>, stub: &str, function: &str, sources: &Sources) -> Result<Vec<String>, String> {
    let Some(at) = lines.iter().position(|line| line == "{options}") else { return Ok(lines) };
    let mut options = Vec::new();
    for of in options_of(stub, function) {
        options.extend(sources.fields(of)?.iter().map(|option| format!("{}: {}", option.name, paragraph(&option.doc))));
    }
    if options.is_empty() {
        return Err(format!("{function} says {{options}}, but the stub has none of it"));
    }
    lines.splice(at..=at, options);
    Ok(lines)
}

/// The declarations of a stub, except names of types that are only abbreviations.
fn declarations(stub: &str) -> Vec<Declared<'_>> {
    let mut found: Vec<Declared> = Vec::new();
    for line in stub.lines() {
        let begins = line.strip_prefix("class ").or_else(|| line.strip_prefix("def "));
        let constant = || line.split_once(": ").map(|(name, _)| name).filter(|name| !name.contains([' ', '"', '.', ')']));
        if let Some(name) = begins.and_then(|rest| rest.split([':', '(', '[']).next()).or_else(constant) {
            found.push(Declared { name, stub: line.into() });
        } else if line.starts_with([' ', ')'])
            && let Some(last) = found.last_mut()
        {
            last.stub += &format!("\n{line}");
        }
    }
    found.retain(|declared| !declared.name.starts_with("__"));
    found
}

/// Doc comments of what Python sees of the crate, by `name`, `Class.method` or `farm.name`.
fn written_in_rust(house: &House) -> Result<HashMap<String, Vec<String>>, String> {
    let mut docs = HashMap::new();
    let folder = std::fs::read_dir(house.root.join(RUST)).map_err(|error| format!("cannot read {RUST}: {error}"))?;
    for entry in folder.flatten().filter(|entry| entry.path().extension().is_some_and(|extension| extension == "rs")) {
        let file = format!("{RUST}/{}", entry.file_name().to_string_lossy());
        let module = if file.ends_with("/farm.rs") { "farm." } else { "" };
        for item in syn::parse_file(&house.read(&file)?).map_err(|error| format!("{file}: {error}"))?.items {
            match item {
                Item::Fn(item) if has(&item.attrs, "pyfunction") => {
                    docs.insert(format!("{module}{}", python_name(&item.attrs, &item.sig.ident)), doc_lines(&item.attrs));
                }
                Item::Struct(item) if has(&item.attrs, "pyclass") => {
                    docs.insert(item.ident.to_string(), doc_lines(&item.attrs));
                }
                Item::Impl(item) if has(&item.attrs, "pymethods") => docs.extend(methods(&item)),
                _ => {}
            }
        }
    }
    docs.retain(|_, lines| !lines.is_empty());
    Ok(docs)
}

fn methods(item: &syn::ItemImpl) -> Vec<(String, Vec<String>)> {
    let Type::Path(class) = &*item.self_ty else { return Vec::new() };
    let Some(class) = class.path.get_ident() else { return Vec::new() };
    let function = |item: &ImplItem| match item {
        ImplItem::Fn(f) => Some((format!("{class}.{}", python_name(&f.attrs, &f.sig.ident)), doc_lines(&f.attrs))),
        _ => None,
    };
    item.items.iter().filter_map(function).collect()
}

fn has(attributes: &[Attribute], name: &str) -> bool {
    attributes.iter().any(|attribute| attribute.path().is_ident(name))
}

/// `name` of `#[pyo3(name = "…")]`, or the function's own.
fn python_name(attributes: &[Attribute], own: &syn::Ident) -> String {
    let mut name = own.to_string();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("pyo3")) {
        // A signature has another form, and is in the stub.
        let _ = attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident("name") {
                name = meta.value()?.parse::<LitStr>()?.value();
            }
            Ok(())
        });
    }
    name
}

/// Files, one after the other.
fn read_all(house: &House, files: &[&str]) -> Result<String, String> {
    files.iter().map(|file| house.read(file)).collect()
}

/// The doc string of a class or function in Python's source.
fn written_in_python(source: &str, name: &str) -> Option<Vec<String>> {
    let begins = |line: &&str| {
        ["class ", "def "].iter().any(|word| line.strip_prefix(word).and_then(|rest| rest.split([':', '(']).next()) == Some(name))
    };
    let body = source.lines().skip_while(|line| !begins(line)).skip(1);
    let mut text =
        body.skip_while(|line| !line.trim_start().starts_with("\"\"\"")).take_while(|line| line.is_empty() || line.starts_with(' '));
    let first = text.next()?.trim_start().strip_prefix("\"\"\"")?;
    if let Some(only) = first.strip_suffix("\"\"\"") {
        return Some(vec![only.into()]);
    }
    let more =
        text.take_while(|line| !line.trim_end().ends_with("\"\"\"")).map(|line| line.strip_prefix("    ").unwrap_or(line).to_string());
    Some(std::iter::once(first.to_string()).chain(more).collect())
}

/// Doc strings list parameters by lines "name: what"; in Markdown these are items.
fn markdown(lines: &[String]) -> String {
    let mut text = String::new();
    let mut before = "";
    for line in lines.iter().map(String::as_str).filter(|line| *line != "Parameters" && !line.starts_with("-----")) {
        match parameters(line) {
            Some((names, what)) => {
                if !before.starts_with("- ") && !before.is_empty() && parameters(before).is_none() {
                    text.push('\n');
                }
                text += &format!("- `{names}`: {what}\n");
            }
            None => text += &format!("{line}\n"),
        }
        before = line;
    }
    text
}

/// "scenes, cameras" of "scenes, cameras: only these".
fn parameters(line: &str) -> Option<(&str, &str)> {
    let (names, what) = line.split_once(": ")?;
    let is_name = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    names.split(", ").all(is_name).then_some((names, what))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_and_class_with_methods_is_explained() {
        let house = House::find().unwrap();
        let docs = written_in_rust(&house).unwrap();
        for (module, stub, source) in MODULES {
            let (stub, source) = (house.read(stub).unwrap(), read_all(&house, source).unwrap());
            let short = module.strip_prefix("enfilade").unwrap().trim_start_matches('.');
            let key = |name: &str| if short.is_empty() { name.to_string() } else { format!("{short}.{name}") };
            for Declared { name, stub } in declarations(&stub).iter().filter(|declared| declared.has_functions()) {
                assert!(docs.contains_key(&key(name)) || written_in_python(&source, name).is_some(), "{module}.{name}: {stub}");
            }
        }
    }

    #[test]
    fn parameters_become_items() {
        let lines = ["Does it.", "", "scenes, cameras: only these.", "force: again.", "", "Gives a thing: this."].map(String::from);
        assert_eq!(markdown(&lines), "Does it.\n\n- `scenes, cameras`: only these.\n- `force`: again.\n\nGives a thing: this.\n");
    }

    #[test]
    fn doc_strings_of_python_are_found() {
        let source = "class A:\n    \"\"\"One.\n\n    Two.\n    \"\"\"\n\n\ndef b(x):\n    \"\"\"Only.\"\"\"\n";
        assert_eq!(written_in_python(source, "A").unwrap(), ["One.", "", "Two."]);
        assert_eq!(written_in_python(source, "b").unwrap(), ["Only."]);
        assert_eq!(written_in_python(source, "c"), None);
    }
}
