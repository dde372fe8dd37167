//! The pages of the site, made from the repository's: generated tables are inserted, and links changed to the places of their targets in
//! the site.
//!
//! `docs/SUMMARY.md` lists the pages. It and all of them are read on forges too, so links refer to the repository's files. A listed page
//! outside of `docs/` becomes a page of the site; other linked files are copied beside the pages as text.

use super::{commands, keys, layers, python_api};
use crate::house::House;
use pulldown_cmark::{Event, Options, Parser, Tag};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

const DOCS: &str = "docs";
const SUMMARY: &str = "docs/SUMMARY.md";
/// Files of `docs/` that are mdBook's.
const SETTINGS: [&str; 2] = ["docs/book.toml", "docs/site.css"];

/// A function that makes a text from the code.
type Maker = fn(&House) -> Result<String, String>;

/// The texts that replace lines `<!-- cargo xtask docs: NAME -->`.
const GENERATED: [(&str, Maker); 4] =
    [("keys", keys::tables), ("layers", layers::tables), ("python", python_api::page), ("commands", commands::help)];

/// The site in the making.
pub struct Site<'h> {
    house: &'h House,
    /// mdBook's folder.
    pub folder: PathBuf,
    /// The pages that the summary lists, by their paths in the repository.
    pub chapters: Vec<String>,
    /// Files that pages link to.
    linked: RefCell<BTreeSet<String>>,
}

impl<'h> Site<'h> {
    /// The site below the target folder.
    ///
    /// # Errors
    /// When the summary cannot be read.
    pub fn new(house: &'h House) -> Result<Self, String> {
        let summary = house.read(SUMMARY)?;
        let chapters = links(&summary).into_iter().map(|link| normal(DOCS, &link.to)).collect();
        Ok(Self { house, folder: house.target()?.join("docs"), chapters, linked: RefCell::default() })
    }

    /// Makes the sources of the site anew, except for notebooks.
    ///
    /// # Errors
    /// With the pages that cannot be made, and the links that lead nowhere.
    pub fn compose(&self) -> Result<String, String> {
        let source = self.folder.join("src");
        if source.exists() {
            std::fs::remove_dir_all(&source).map_err(|error| format!("cannot remove {}: {error}", source.display()))?;
        }
        let all: Vec<String> = files_below(&self.house.root, DOCS)?.into_iter().filter(|file| !SETTINGS.contains(&file.as_str())).collect();
        let (pages, others): (Vec<&String>, Vec<&String>) = all.iter().partition(|file| file.ends_with(".md"));
        for file in SETTINGS {
            self.copy(file, &self.folder.join(Path::new(file).file_name().unwrap_or_default()))?;
        }
        for file in others {
            self.copy(file, &source.join(place(file)))?;
        }
        let outside = self.chapters.iter().filter(|file| file.ends_with(".md") && !file.starts_with("docs/"));
        let failures: Vec<String> = pages.into_iter().chain(outside).filter_map(|file| self.page(file).err()).collect();
        if !failures.is_empty() {
            return Err(failures.join("\n"));
        }
        for file in &*self.linked.borrow() {
            self.copy(file, &source.join(place(file)))?;
        }
        Ok(format!("{} pages", self.chapters.len()))
    }

    fn page(&self, file: &str) -> Result<(), String> {
        let mut text = self.house.read(file)?;
        for (name, make) in GENERATED {
            let mark = format!("<!-- cargo xtask docs: {name} -->");
            if text.contains(&mark) {
                text = text.replace(&mark, make(self.house)?.trim_end());
            }
        }
        self.write(&place(file), &self.led(file, &text)?)
    }

    /// Writes a source of the site.
    ///
    /// # Errors
    /// When that fails.
    pub fn write(&self, place: &str, text: &str) -> Result<(), String> {
        let path = self.folder.join("src").join(place);
        make_folder_of(&path)?;
        std::fs::write(&path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
    }

    fn copy(&self, file: &str, to: &Path) -> Result<(), String> {
        make_folder_of(to)?;
        std::fs::copy(self.house.root.join(file), to).map(drop).map_err(|error| format!("cannot copy {file}: {error}"))
    }

    /// The text of the repository's file with links to where the site has their targets.
    ///
    /// # Errors
    /// With all links that lead nowhere.
    pub fn led(&self, file: &str, text: &str) -> Result<String, String> {
        let (mut led, mut failures) = (text.to_string(), Vec::new());
        for link in links(text).into_iter().rev() {
            let line = text[..link.range.start].matches('\n').count() + 1;
            match self.target(file, &link.to) {
                Ok(to) if to == link.to => {}
                Ok(to) => match text[link.range.clone()].rfind(&link.to) {
                    Some(at) => led.replace_range(link.range.start + at..link.range.start + at + link.to.len(), &to),
                    None => failures.push(format!("{file}:{line}: write the link to {} in place, as [text](path)", link.to)),
                },
                Err(reason) => failures.push(format!("{file}:{line}: {reason}")),
            }
        }
        if failures.is_empty() { Ok(led) } else { Err(failures.join("\n")) }
    }

    /// The target of a link of `file` in the site.
    fn target(&self, file: &str, link: &str) -> Result<String, String> {
        let (path, fragment) = link.split_at(link.find('#').unwrap_or(link.len()));
        if path.is_empty() || path.contains(':') || path.starts_with(&format!("{}_files/", stem(file))) {
            return Ok(link.into());
        }
        let mut target = normal(&parent(file), path);
        let on_disk = self.house.root.join(&target);
        if !on_disk.exists() {
            return Err(format!("there is no {target} to link to"));
        }
        if on_disk.is_dir() {
            let within = self.chapters.iter().find(|chapter| parent(chapter) == target);
            target = within.ok_or_else(|| format!("{target} is a folder, and none of its files is in {SUMMARY}; link a file"))?.clone();
        } else if !self.chapters.contains(&target) && !target.starts_with("docs/") {
            self.linked.borrow_mut().insert(target.clone());
        }
        Ok(relative(&parent(&place(file)), &place(&target)) + fragment)
    }
}

/// Path in the site of a file of the repository, relative to the site's sources. mdBook would rename a README.
pub fn place(file: &str) -> String {
    match (file.strip_prefix("docs/"), file.rsplit_once('.')) {
        (Some(page), _) => page.into(),
        (None, Some(("README", "md"))) => "index.md".into(),
        (None, Some((name, "md"))) => format!("repository/{}.md", name.strip_suffix("/README").unwrap_or(name)),
        (None, Some((_, "ipynb"))) => format!("notebooks/{}.md", stem(file)),
        _ => format!("files/{file}.txt"),
    }
}

/// A link or picture of a text.
struct Link {
    to: String,
    /// All of it, with its words.
    range: Range<usize>,
}

/// In the order of the text.
fn links(text: &str) -> Vec<Link> {
    let events = Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter();
    let mut found: Vec<Link> = events
        .filter_map(|(event, range)| match event {
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => Some(Link { to: dest_url.to_string(), range }),
            _ => None,
        })
        .collect();
    // A picture within a link comes before the link's own target.
    found.sort_by_key(|link| (link.range.end, std::cmp::Reverse(link.range.start)));
    found
}

/// `path` as seen from `folder`, without `..`.
fn normal(folder: &str, path: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/').filter(|part| !part.is_empty() && *part != ".") {
        if part == ".." {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    parts.join("/")
}

/// The way from a folder to a file.
fn relative(folder: &str, file: &str) -> String {
    let from: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    let to: Vec<&str> = file.split('/').collect();
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    [vec![".."; from.len() - shared], to[shared..].to_vec()].concat().join("/")
}

fn parent(file: &str) -> String {
    file.rsplit_once('/').map_or(String::new(), |(folder, _)| folder.into())
}

/// `a` of `folder/a.b`.
pub fn stem(file: &str) -> &str {
    Path::new(file).file_stem().and_then(|stem| stem.to_str()).unwrap_or(file)
}

/// All files below a folder of the repository, in order, by their paths from its root.
fn files_below(root: &Path, folder: &str) -> Result<Vec<String>, String> {
    let mut files = Vec::new();
    let entries = std::fs::read_dir(root.join(folder)).map_err(|error| format!("cannot read {folder}: {error}"))?;
    for entry in entries.flatten() {
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() { files.extend(files_below(root, &path)?) } else { files.push(path) }
    }
    files.sort();
    Ok(files)
}

fn make_folder_of(path: &Path) -> Result<(), String> {
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder).map_err(|error| format!("cannot make {}: {error}", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_lists_every_page_once_and_nothing_else() {
        let house = House::find().unwrap();
        let chapters = Site::new(&house).unwrap().chapters;
        let pages = files_below(&house.root, DOCS).unwrap();
        for page in pages.iter().filter(|file| file.ends_with(".md") && *file != SUMMARY) {
            assert_eq!(chapters.iter().filter(|chapter| *chapter == page).count(), 1, "{page} in {SUMMARY}");
        }
        for chapter in &chapters {
            assert!(house.root.join(chapter).is_file(), "{SUMMARY} lists {chapter}, which is not there");
        }
    }

    #[test]
    fn links_of_all_pages_lead_to_files() {
        let house = House::find().unwrap();
        let site = Site::new(&house).unwrap();
        for page in site.chapters.iter().filter(|chapter| chapter.ends_with(".md")) {
            site.led(page, &house.read(page).unwrap()).unwrap_or_else(|failures| panic!("{failures}"));
        }
    }

    #[test]
    fn links_lead_to_where_the_site_has_their_targets() {
        let house = House::find().unwrap();
        let site = Site::new(&house).unwrap();
        let led = |file: &str, text: &str| site.led(file, text);
        assert_eq!(
            led("docs/farm.md", "[a](homes.md#checks) [b](https://b.c) `[c](d)`").unwrap(),
            "[a](homes.md#checks) [b](https://b.c) `[c](d)`"
        );
        assert_eq!(led("README.md", "[![a](docs/home.jpg)](docs/farm.md)").unwrap(), "[![a](home.jpg)](farm.md)");
        assert_eq!(led("docs/farm.md", "[a](../examples/farm/README.md)").unwrap(), "[a](repository/examples/farm.md)");
        assert_eq!(led("docs/farm.md", "[a](../examples/farm/missing.sh)").unwrap(), "[a](files/examples/farm/missing.sh.txt)");
        assert_eq!(led("docs/farm.md", "\n[a](b.md)").unwrap_err(), "docs/farm.md:2: there is no docs/b.md to link to");
    }
}
