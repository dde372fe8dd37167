//! Whether every link of the finished site leads to a file of it, and to a place in it.

use std::collections::{HashMap, HashSet};
use std::path::{Component, Path, PathBuf};

/// A page as far as links are concerned.
struct Page {
    ids: HashSet<String>,
    links: Vec<String>,
}

/// Follows the links of all pages below `site`, except links to other sites.
///
/// # Errors
/// With every link that leads nowhere.
pub fn check(site: &Path) -> Result<String, String> {
    let mut pages = HashMap::new();
    read(site, &mut pages)?;
    let (mut failures, mut count) = (Vec::new(), 0);
    for (file, page) in &pages {
        for link in page.links.iter().filter(|link| !link.contains(':') && !link.starts_with("//")) {
            count += 1;
            if let Some(reason) = problem(file, link, &pages) {
                failures.push(format!("{}: {link}: {reason}", file.strip_prefix(site).unwrap_or(file).display()));
            }
        }
    }
    failures.sort();
    if failures.is_empty() { Ok(format!("{count} links of {} pages", pages.len())) } else { Err(failures.join("\n")) }
}

fn read(folder: &Path, pages: &mut HashMap<PathBuf, Page>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("cannot read {}: {error}", folder.display()))?;
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            read(&path, pages)?;
        } else if path.extension().is_some_and(|extension| extension == "html") {
            let html = std::fs::read_to_string(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
            let links = [values(&html, "href"), values(&html, "src")].concat();
            pages.insert(path, Page { ids: values(&html, "id").into_iter().collect(), links });
        }
    }
    Ok(())
}

fn problem(file: &Path, link: &str, pages: &HashMap<PathBuf, Page>) -> Option<String> {
    let (path, id) = link.split_once('#').map_or((link, ""), |(path, id)| (path, id));
    let target = if path.is_empty() { file.to_path_buf() } else { joined(file.parent()?, path.split('?').next()?) };
    match pages.get(&target) {
        _ if !target.exists() => Some("there is no such file".into()),
        Some(page) if !id.is_empty() && !page.ids.contains(id) => Some(format!("there is no heading #{id}")),
        _ => None,
    }
}

/// `path` from `folder` on, without `..`.
fn joined(folder: &Path, path: &str) -> PathBuf {
    let mut whole = folder.to_path_buf();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => drop(whole.pop()),
            Component::CurDir => {}
            part => whole.push(part),
        }
    }
    whole
}

/// The values of an attribute, at any position in a tag.
fn values(html: &str, attribute: &str) -> Vec<String> {
    let begins = format!(" {attribute}=\"");
    let tags = html.split('<').filter_map(|tag| tag.split_once(&begins)).filter_map(|(_, rest)| rest.split('"').next());
    tags.map(|value| value.replace("&amp;", "&").replace("%20", " ")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_to_missing_files_and_headings_are_found() {
        let folder = std::env::temp_dir().join(format!("enfilade-links-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("b")).unwrap();
        std::fs::write(folder.join("a.html"), "<h1 id=\"top\"></h1><a href=\"b/c.html#x\"><img src=\"d.png\"></a><a href=\"https://e.f\">")
            .unwrap();
        std::fs::write(folder.join("b/c.html"), "<a class=\"k\" href=\"../a.html#top\">href=\"no\"</a><a href=\"#y\">").unwrap();
        let found = check(&folder).unwrap_err();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(
            found,
            "a.html: b/c.html#x: there is no heading #x\na.html: d.png: there is no such file\nb/c.html: #y: there is no heading #y"
        );
    }
}
