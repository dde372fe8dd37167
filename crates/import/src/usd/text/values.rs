//! Values in usda: numbers, tuples, arrays, texts and dictionaries.

use super::lexer::Token;
use super::parser::Parser;
use crate::usd::layer::{MAX_DEPTH, absolute};
use crate::usd::value::{Item, Numbers, Value};
use std::collections::BTreeMap;
use std::rc::Rc;

/// The elements of an array or a value, gathered by type.
#[derive(Default)]
struct Gathered {
    numbers: Vec<f64>,
    texts: Vec<Rc<str>>,
    /// Numbers of the first tuple, 1 without one.
    width: usize,
}

impl Parser<'_> {
    /// A value of whatever kind comes.
    pub(super) fn value(&mut self) -> Result<Value, String> {
        self.skip_lines()?;
        match &self.token {
            Token::Word("None") => {
                self.advance()?;
                Ok(Value::Block)
            }
            Token::Sign(b'{') => self.dictionary(0),
            Token::Sign(b'[') => self.array(),
            _ => {
                let mut gathered = Gathered::default();
                let width = self.element(&mut gathered, 0)?;
                Ok(gathered.finish(width, false))
            }
        }
    }

    fn array(&mut self) -> Result<Value, String> {
        let mut gathered = Gathered::default();
        self.advance()?;
        while !self.at_sign(b']')? {
            let width = self.element(&mut gathered, 0)?;
            if gathered.width == 0 {
                gathered.width = width;
            } else if gathered.width != width {
                return Err(format!("found an element of {width} numbers among elements of {}; correct the array", gathered.width));
            }
            self.comma(b']')?;
        }
        self.advance()?;
        let width = gathered.width;
        Ok(gathered.finish(width, true))
    }

    /// One element; returns of how many numbers.
    fn element(&mut self, into: &mut Gathered, depth: usize) -> Result<usize, String> {
        if depth > MAX_DEPTH {
            return Err("tuples are nested too deeply; the file is damaged".into());
        }
        self.skip_lines()?;
        match &self.token {
            Token::Number(n) => into.numbers.push(*n),
            Token::Text(t) => into.texts.push(Rc::from(t.as_str())),
            Token::Asset(t) => into.texts.push(Rc::from(*t)),
            Token::Path(p) => into.texts.push(Rc::from(absolute(p, &self.prim))),
            Token::Word("true" | "True" | "yes") => into.numbers.push(1.0),
            Token::Word("false" | "False" | "no") => into.numbers.push(0.0),
            // Tokens of metadata are written without quotes.
            Token::Word(w) => into.texts.push(Rc::from(*w)),
            Token::Sign(b'(' | b'[') => {
                let close = if self.token == Token::Sign(b'(') { b')' } else { b']' };
                self.advance()?;
                let mut width = 0;
                while !self.at_sign(close)? {
                    width += self.element(into, depth + 1)?;
                    self.comma(close)?;
                }
                self.advance()?;
                return Ok(width);
            }
            other => return Err(format!("found {}, expected a value; correct the file", other.named())),
        }
        self.advance()?;
        Ok(1)
    }

    /// `{ type name = value … }`.
    pub(super) fn dictionary(&mut self, depth: usize) -> Result<Value, String> {
        if depth > MAX_DEPTH {
            return Err("dictionaries are nested too deeply; the file is damaged".into());
        }
        self.expect(b'{')?;
        let mut entries = BTreeMap::new();
        while !self.at_sign(b'}')? {
            if matches!(self.token, Token::Sign(b';' | b',')) {
                self.advance()?;
                continue;
            }
            let mut key = self.key("a type or a name")?;
            // A type comes first; `[]` may follow it.
            while !matches!(self.token, Token::Sign(b'=' | b':')) {
                if self.token == Token::Sign(b'[') {
                    self.advance()?;
                    self.expect(b']')?;
                } else {
                    key = self.key("a name")?;
                }
            }
            self.advance()?;
            self.skip_lines()?;
            let value = if self.token == Token::Sign(b'{') { self.dictionary(depth + 1)? } else { self.value()? };
            entries.insert(key, value);
        }
        self.advance()?;
        Ok(Value::Dictionary(Rc::new(entries)))
    }

    /// References, payloads, paths or names: one, several, or `None`.
    pub(super) fn items(&mut self) -> Result<Vec<Item>, String> {
        self.skip_lines()?;
        match &self.token {
            Token::Word("None") => {
                self.advance()?;
                Ok(Vec::new())
            }
            Token::Sign(b'[') => {
                let mut items = Vec::new();
                self.advance()?;
                while !self.at_sign(b']')? {
                    items.push(self.item()?);
                    if self.token == Token::Sign(b'(') {
                        self.skip_brackets()?;
                    }
                    self.comma(b']')?;
                }
                self.advance()?;
                Ok(items)
            }
            _ => Ok(vec![self.item()?]),
        }
    }

    fn item(&mut self) -> Result<Item, String> {
        let mut item = match &self.token {
            Token::Asset(asset) => Item { asset: (*asset).to_string(), ..Item::default() },
            Token::Path(path) => Item::name(absolute(path, &self.prim)),
            Token::Text(text) => Item::name(text.clone()),
            Token::Word(word) => Item::name(*word),
            // Lists of numbers exist in metadata only.
            Token::Number(n) => Item::name(n.to_string()),
            other => return Err(format!("found {}, expected an asset path, a path or a name; correct the file", other.named())),
        };
        self.advance()?;
        if let (Token::Path(path), false) = (&self.token, item.asset.is_empty()) {
            item.path = (*path).to_string();
            self.advance()?;
        }
        // Offset and scale of time, and custom data. Behind a path it is the metadata of a relationship.
        if self.token == Token::Sign(b'(') && !item.asset.is_empty() {
            item.retiming = self.retiming()?;
        }
        Ok(item)
    }
}

impl Gathered {
    fn finish(self, width: usize, array: bool) -> Value {
        if self.texts.is_empty() && !(self.numbers.is_empty() && array) {
            Value::Numbers(Numbers { width: width.max(1), data: Rc::new(self.numbers), array })
        } else {
            Value::Texts { data: Rc::new(self.texts), array }
        }
    }
}
