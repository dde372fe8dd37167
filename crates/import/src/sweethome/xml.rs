//! Elements of `Home.xml` with their attributes as numbers, colours and flags, and their places for messages.

use crate::ImportError;
use enfilade_math::{Rgb, linear_from_srgb};
use roxmltree::Node;
use std::path::Path;

/// An element.
#[derive(Clone, Copy)]
pub(super) struct Element<'x> {
    node: Node<'x, 'x>,
    file: &'x Path,
}

impl<'x> Element<'x> {
    pub(super) fn new(node: Node<'x, 'x>, file: &'x Path) -> Self {
        Self { node, file }
    }

    pub(super) fn tag(&self) -> &'x str {
        self.node.tag_name().name()
    }

    /// The elements directly within, in the order of the file.
    pub(super) fn children(&self) -> impl Iterator<Item = Element<'x>> + use<'x> {
        let file = self.file;
        self.node.children().filter(Node::is_element).map(move |node| Element { node, file })
    }

    /// The first element of a tag directly within whose `attribute` is as given; `None` asks for any.
    pub(super) fn child(&self, tag: &str, attribute: Option<&str>) -> Option<Element<'x>> {
        self.children().find(|c| c.tag() == tag && attribute.is_none_or(|a| c.text("attribute") == Some(a)))
    }

    /// An attribute as it is; `None` also where it is empty.
    pub(super) fn text(&self, name: &str) -> Option<&'x str> {
        self.node.attribute(name).filter(|v| !v.is_empty())
    }

    /// All attributes as text, in the order of the file.
    pub(super) fn attributes(&self) -> String {
        self.node.attributes().map(|a| format!("{}={:?} ", a.name(), a.value())).collect()
    }

    pub(super) fn flag(&self, name: &str, default: bool) -> bool {
        self.text(name).map_or(default, |v| v == "true")
    }

    /// A number that must be finite where it is given.
    pub(super) fn number(&self, name: &str) -> Result<Option<f64>, ImportError> {
        let parse = |text: &str| {
            let number = text.trim().parse::<f64>().ok().filter(|n| n.is_finite());
            number
                .ok_or_else(|| self.error(format!("found {name}={text:?}, expected a finite number; fix the file or save the home again")))
        };
        self.text(name).map(parse).transpose()
    }

    pub(super) fn number_or(&self, name: &str, default: f64) -> Result<f64, ImportError> {
        Ok(self.number(name)?.unwrap_or(default))
    }

    /// A number without which the element makes no sense.
    pub(super) fn required(&self, name: &str) -> Result<f64, ImportError> {
        let missing = || self.error(format!("the attribute {name} is missing; save the home again"));
        self.number(name)?.ok_or_else(missing)
    }

    /// A length that must be above zero.
    pub(super) fn length(&self, name: &str) -> Result<f64, ImportError> {
        let found = self.required(name)?;
        let error = || self.error(format!("found {name}={found}, expected centimetres above zero; fix the file or save the home again"));
        if found > 0.0 { Ok(found) } else { Err(error()) }
    }

    /// Numbers separated by spaces.
    pub(super) fn numbers(&self, name: &str) -> Result<Option<Vec<f64>>, ImportError> {
        let Some(text) = self.text(name) else { return Ok(None) };
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(|w| w.parse().ok().filter(|n: &f64| n.is_finite())).collect();
        let error = || self.error(format!("found {name}={text:?}, expected finite numbers; fix the file or save the home again"));
        numbers.map(Some).ok_or_else(error)
    }

    /// A colour of eight hexadecimal digits, as its opacity and linear value.
    pub(super) fn color(&self, name: &str) -> Result<Option<(u8, Rgb)>, ImportError> {
        let Some(text) = self.text(name) else { return Ok(None) };
        let error = || self.error(format!("found {name}={text:?}, expected a colour as eight hexadecimal digits; save the home again"));
        let [alpha, r, g, b] = u32::from_str_radix(text, 16).map_err(|_| error())?.to_be_bytes();
        let linear = |v: u8| linear_from_srgb(f32::from(v) / 255.0);
        Ok(Some((alpha, Rgb::new(linear(r), linear(g), linear(b)))))
    }

    /// The place of the element, for messages.
    pub(super) fn place(&self) -> String {
        let at = self.node.document().text_pos_at(self.node.range().start);
        format!("line {} <{}>", at.row, self.tag())
    }

    pub(super) fn error(&self, problem: impl Into<String>) -> ImportError {
        ImportError::malformed(self.file, self.place(), problem)
    }
}
