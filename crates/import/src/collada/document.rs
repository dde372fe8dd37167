//! The XML of a COLLADA file: elements by their ids, and numbers.

use crate::percent::percent_decoded;
use std::collections::HashMap;

/// An element.
pub(super) type Node<'d> = roxmltree::Node<'d, 'd>;

/// A COLLADA file.
pub(super) struct Dae<'d> {
    pub root: Node<'d>,
    ids: HashMap<&'d str, Node<'d>>,
}

impl<'d> Dae<'d> {
    pub(super) fn new(root: Node<'d>) -> Self {
        let mut ids = HashMap::new();
        for node in root.descendants() {
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node);
            }
        }
        Self { root, ids }
    }

    /// The element that a URL such as `#chair` means; `None` for one in another file, or of no element.
    pub(super) fn target(&self, url: &str) -> Option<Node<'d>> {
        let id = url.trim().strip_prefix('#')?;
        self.ids.get(id).copied().or_else(|| self.ids.get(&*String::from_utf8_lossy(&percent_decoded(id))).copied())
    }

    /// The element of an id.
    pub(super) fn by_id(&self, id: &str) -> Option<Node<'d>> {
        self.ids.get(id.trim().trim_start_matches('#')).copied()
    }

    /// The program that wrote the file.
    pub(super) fn tool(&self) -> String {
        let tools = self.root.descendants().find(|n| n.tag_name().name() == "authoring_tool");
        tools.map_or(String::new(), text)
    }
}

/// The first element of a name within another.
pub(super) fn child<'d>(node: Node<'d>, tag: &str) -> Option<Node<'d>> {
    children(node, tag).next()
}

/// The elements of a name within another.
pub(super) fn children<'d, 't>(node: Node<'d>, tag: &'t str) -> impl Iterator<Item = Node<'d>> + use<'d, 't> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == tag)
}

/// The element at the end of a way of names.
pub(super) fn at<'d>(node: Node<'d>, path: &[&str]) -> Option<Node<'d>> {
    path.iter().try_fold(node, |node, tag| child(node, tag))
}

/// The text of an element.
pub(super) fn text(node: Node) -> String {
    node.children().filter_map(|n| n.text().filter(|_| n.is_text())).collect::<String>().trim().to_string()
}

/// A finite number.
pub(super) fn number(word: &str) -> Option<f64> {
    let word = word.trim();
    word.parse().ok().or_else(|| word.replacen(',', ".", 1).parse().ok()).filter(|v: &f64| v.is_finite())
}

/// The numbers of an element; what is none is zero, and is counted.
pub(super) fn numbers(node: Node) -> (Vec<f64>, usize) {
    let mut odd = 0;
    let texts = node.children().filter_map(|n| n.text().filter(|_| n.is_text()));
    let mut found = Vec::new();
    for word in texts.flat_map(str::split_ascii_whitespace) {
        // A comma is a decimal point, between numbers what separates them.
        if let Some(number) = number(word) {
            found.push(number);
            continue;
        }
        for part in word.split(',').filter(|part| !part.is_empty()) {
            found.push(number(part).unwrap_or_else(|| {
                odd += 1;
                0.0
            }));
        }
    }
    (found, odd)
}

/// Numbers of an element, as many as are wanted; `None` where there are fewer, or something else.
pub(super) fn exactly<const N: usize>(node: Node) -> Option<[f64; N]> {
    let (found, odd) = numbers(node);
    found.get(..N).filter(|_| odd == 0)?.try_into().ok()
}

/// As [`exactly`], as many as `count`.
pub(super) fn several(node: Node, count: usize) -> Option<Vec<f64>> {
    let (mut found, odd) = numbers(node);
    let is_enough = odd == 0 && found.len() >= count;
    found.truncate(count);
    is_enough.then_some(found)
}

/// Numbers that an element's transform takes; `None` for elements that are none.
pub(super) fn width(tag: &str) -> Option<usize> {
    Some(match tag {
        "matrix" => 16,
        "translate" | "scale" => 3,
        "rotate" => 4,
        "lookat" => 9,
        "skew" => 7,
        _ => return None,
    })
}

/// Whole numbers of an element; `None` where something else is among them.
pub(super) fn indices(node: Node) -> Option<Vec<u32>> {
    let texts = node.children().filter_map(|n| n.text().filter(|_| n.is_text()));
    texts.flat_map(str::split_ascii_whitespace).map(|word| word.parse().ok()).collect()
}

/// The name of an element in messages: its kind with its name or id.
pub(super) fn called(node: Node) -> String {
    let name = node.attribute("id").or(node.attribute("name"));
    name.map_or_else(|| node.tag_name().name().to_string(), |name| format!("{} {name:?}", node.tag_name().name()))
}
