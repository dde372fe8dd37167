//! The modules of a crate: the file of each, the items that it defines, and the items that it takes from elsewhere.

use super::graph::Imports;
use crate::house::House;
use std::collections::{BTreeMap, BTreeSet};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree};

/// A path of names from the root of the crate.
pub type Path = Vec<String>;

/// How many re-exports a name may pass through; more are a loop.
const MOST_REEXPORTS: usize = 16;

/// All modules of a crate, tests apart.
pub struct Crate {
    /// Paths of the source files.
    pub files: Vec<String>,
    modules: BTreeMap<Path, Module>,
}

/// A module, in a file of its own or within another's.
#[derive(Default)]
struct Module {
    file: usize,
    /// Items defined here.
    defined: BTreeSet<String>,
    /// Names that `use` brings, with the path that it gives.
    taken: BTreeMap<String, Path>,
    /// Modules of which `use` brings everything.
    globs: Vec<Path>,
    /// Paths that are named here, except the paths of a re-exporting `use`, which are followed from the importing module.
    named: Vec<Path>,
}

impl Crate {
    /// The crate in a folder of the repository.
    ///
    /// # Errors
    /// When a file is missing or is no Rust.
    pub fn read(house: &House, folder: &str) -> Result<Self, String> {
        let text = |path: &str| house.read(path).ok();
        let root = ["lib.rs", "main.rs"].map(|name| format!("{folder}/src/{name}")).into_iter().find(|path| text(path).is_some());
        Self::parse(&root.ok_or_else(|| format!("{folder}/src has neither lib.rs nor main.rs"))?, &text)
    }

    /// The crate that begins with the file `root`, its files given by `text`.
    ///
    /// # Errors
    /// When a file is missing or is no Rust.
    pub fn parse(root: &str, text: &dyn Fn(&str) -> Option<String>) -> Result<Self, String> {
        let mut all = Self { files: Vec::new(), modules: BTreeMap::new() };
        let folder = root.rsplit_once('/').map_or("", |(folder, _)| folder).to_string();
        all.add_file(root.to_string(), folder, Vec::new(), text)?;
        Ok(all)
    }

    /// Reads a file; its children are in `folder`.
    fn add_file(&mut self, path: String, folder: String, module: Path, text: &dyn Fn(&str) -> Option<String>) -> Result<(), String> {
        let source = text(&path).ok_or_else(|| format!("cannot read {path}"))?;
        let parsed = syn::parse_file(&source).map_err(|error| format!("{path}: {error}"))?;
        self.files.push(path);
        self.add_items(&parsed.items, self.files.len() - 1, &folder, module, text)
    }

    fn add_items(
        &mut self,
        items: &[Item],
        file: usize,
        folder: &str,
        module: Path,
        text: &dyn Fn(&str) -> Option<String>,
    ) -> Result<(), String> {
        let mut own = Module { file, ..Module::default() };
        for item in items.iter().filter(|item| !attributes(item).iter().any(is_test)) {
            let Item::Mod(child) = item else {
                own.add(item);
                continue;
            };
            let name = child.ident.to_string();
            let (below, path) = (format!("{folder}/{name}"), [module.clone(), vec![name.clone()]].concat());
            own.defined.insert(name.clone());
            if child.attrs.iter().any(|attribute| attribute.path().is_ident("path")) {
                // Another crate's file, taken in whole.
                continue;
            }
            match &child.content {
                Some((_, items)) => self.add_items(items, file, &below, path, text)?,
                None => {
                    let places = [format!("{folder}/{name}.rs"), format!("{below}/mod.rs")];
                    let place = places.iter().find(|place| text(place).is_some());
                    let place = place.ok_or_else(|| format!("cannot read {} or {}", places[0], places[1]))?;
                    self.add_file(place.clone(), below, path, text)?;
                }
            }
        }
        self.modules.insert(module, own);
        Ok(())
    }

    /// Imports between files.
    pub fn imports(&self) -> Imports {
        let mut imports = Imports::new();
        for (at, module) in &self.modules {
            let mut import = |to: usize, name: String| {
                if to != module.file {
                    imports.entry((module.file, to)).or_default().insert(name);
                }
            };
            for path in &module.named {
                if let Some((to, name)) = self.definition(at, path, 0) {
                    import(to, name);
                }
            }
        }
        imports
    }

    /// Imports between the modules within each module, each taken as one with everything below it, from the `imports` of files.
    ///
    /// A module and the modules below it are not compared here: their files are, by [`Crate::imports`].
    pub fn imports_within(&self, imports: &Imports) -> BTreeMap<Path, Imports<Path>> {
        let (begins, mut within) = (self.modules_of_files(), BTreeMap::<Path, Imports<Path>>::new());
        for (&(from, to), names) in imports {
            let (a, b) = (begins[from], begins[to]);
            let shared = a.iter().zip(b).take_while(|(a, b)| a == b).count();
            if shared < a.len().min(b.len()) {
                let names = names.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
                let import = format!("{} -> {}: {names}", self.files[from], self.files[to]);
                let pair = (a[..=shared].to_vec(), b[..=shared].to_vec());
                within.entry(a[..shared].to_vec()).or_default().entry(pair).or_default().insert(import);
            }
        }
        within
    }

    /// The module that each file begins with; modules within it have longer paths.
    fn modules_of_files(&self) -> Vec<&[String]> {
        let mut begins: Vec<Option<&[String]>> = vec![None; self.files.len()];
        for (path, module) in &self.modules {
            let known = &mut begins[module.file];
            if known.is_none_or(|known| path.len() < known.len()) {
                *known = Some(path);
            }
        }
        begins.into_iter().map(Option::unwrap_or_default).collect()
    }

    /// File and name of the item that a path leads to from a module; `None` for other crates, local names and methods.
    fn definition(&self, from: &Path, path: &[String], reexports: usize) -> Option<(usize, String)> {
        let (mut at, rest) = self.start(from, path)?;
        for (index, name) in rest.iter().enumerate() {
            let child = [at.clone(), vec![name.clone()]].concat();
            if self.modules.contains_key(&child) {
                at = child;
                continue;
            }
            let module = self.modules.get(&at)?;
            if module.defined.contains(name) {
                return Some((module.file, name.clone()));
            }
            if reexports == MOST_REEXPORTS {
                return None;
            }
            if let Some(taken) = module.taken.get(name) {
                let onward = [taken.as_slice(), &rest[index + 1..]].concat();
                return if taken.first() == Some(name) && taken.len() == 1 { None } else { self.definition(&at, &onward, reexports + 1) };
            }
            return module.globs.iter().find_map(|glob| self.definition(&at, &[glob, &rest[index..]].concat(), reexports + 1));
        }
        // A module itself: a use of it imports nothing; what is named by way of it does.
        None
    }

    /// The module in which a path continues, and the rest of the path.
    fn start<'a>(&self, from: &Path, path: &'a [String]) -> Option<(Path, &'a [String])> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => Some((Vec::new(), rest)),
            "self" => Some((from.clone(), rest)),
            "super" => {
                let mut at = from.clone();
                at.pop()?;
                if rest.first().is_some_and(|next| next == "super") { self.start(&at, rest) } else { Some((at, rest)) }
            }
            _ => Some((from.clone(), path)),
        }
    }
}

impl Module {
    fn add(&mut self, item: &Item) {
        if let Item::Use(item) = item {
            let reexports = !matches!(item.vis, syn::Visibility::Inherited);
            return self.add_use(&item.tree, &mut Vec::new(), reexports);
        }
        self.defined.extend(name(item));
        let mut paths = Paths(Vec::new());
        paths.visit_item(item);
        self.named.extend(paths.0);
    }

    fn add_use(&mut self, tree: &UseTree, before: &mut Path, reexports: bool) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.add_use(&path.tree, before, reexports);
                before.pop();
            }
            UseTree::Name(name) => self.take(name.ident.to_string(), &name.ident.to_string(), before, reexports),
            UseTree::Rename(rename) => self.take(rename.rename.to_string(), &rename.ident.to_string(), before, reexports),
            UseTree::Glob(_) => self.globs.push(before.clone()),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_use(tree, before, reexports)),
        }
    }

    fn take(&mut self, name: String, item: &str, before: &Path, reexports: bool) {
        let mut path = before.clone();
        if item != "self" {
            path.push(item.to_string());
        }
        let name = if name == "self" { path.last().cloned().unwrap_or_default() } else { name };
        if !reexports {
            self.named.push(path.clone());
        }
        self.taken.insert(name, path);
    }
}

/// The paths that an item names.
struct Paths(Vec<Path>);

impl<'ast> Visit<'ast> for Paths {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_item_mod(&mut self, _: &'ast syn::ItemMod) {}

    fn visit_macro(&mut self, of: &'ast syn::Macro) {
        visit::visit_macro(self, of);
        self.0.extend(paths_of_tokens(&of.tokens.to_string()));
    }

    fn visit_use_path(&mut self, _: &'ast syn::UsePath) {}

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let mut local = Module::default();
        local.add_use(&item.tree, &mut Vec::new(), false);
        self.0.extend(local.named);
    }
}

/// The paths within what a macro is given, which has no grammar of its own: words joined by `::`.
fn paths_of_tokens(tokens: &str) -> Vec<Path> {
    let tokens = tokens.replace(" :: ", "::");
    let words = tokens.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
    let paths = words.filter(|word| word.contains("::") || word.starts_with(char::is_alphabetic));
    paths.map(|word| word.trim_matches(':').split("::").map(str::to_string).collect()).collect()
}

fn name(item: &Item) -> Option<String> {
    Some(match item {
        Item::Const(item) => item.ident.to_string(),
        Item::Enum(item) => item.ident.to_string(),
        Item::Fn(item) => item.sig.ident.to_string(),
        Item::Macro(item) => item.ident.as_ref()?.to_string(),
        Item::Static(item) => item.ident.to_string(),
        Item::Struct(item) => item.ident.to_string(),
        Item::Trait(item) => item.ident.to_string(),
        Item::Type(item) => item.ident.to_string(),
        Item::Union(item) => item.ident.to_string(),
        _ => return None,
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// True of `#[cfg(test)]`, alone or within `all`.
fn is_test(attribute: &Attribute) -> bool {
    let syn::Meta::List(list) = &attribute.meta else { return false };
    list.path.is_ident("cfg")
        && paths_of_tokens(&list.tokens.to_string()).iter().any(|path| path == &["test"])
        && !list.tokens.to_string().contains("not")
}
