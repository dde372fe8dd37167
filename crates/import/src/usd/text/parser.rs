//! The structure of usda: prims, properties, variants and their metadata.

use super::lexer::{Lexer, Token};
use crate::usd::layer::{Fields, Layer, MAX_DEPTH, MAX_PATH, child_path, field, property_path};
use crate::usd::time::Retiming;
use crate::usd::value::{Item, ListEdit, Samples, Value};
use std::rc::Rc;

/// Reads tokens into the specs of a layer.
pub(super) struct Parser<'a> {
    lexer: Lexer<'a>,
    /// The next token.
    pub(super) token: Token<'a>,
    /// Line of the next token.
    pub(super) line: usize,
    pub(super) layer: Layer,
    /// Path of the prim around, without variants: relative paths begin there.
    pub(super) prim: String,
    depth: usize,
}

/// The parsed value, or the fault.
pub(super) type Parsed<T = ()> = Result<T, String>;

impl<'a> Parser<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { lexer: Lexer::new(text), token: Token::NewLine, line: 1, layer: Layer::default(), prim: "/".into(), depth: 0 }
    }

    pub(super) fn advance(&mut self) -> Parsed {
        self.token = self.lexer.next().inspect_err(|_| self.line = self.lexer.line)?;
        self.line = self.lexer.line;
        Ok(())
    }

    pub(super) fn skip_lines(&mut self) -> Parsed {
        while self.token == Token::NewLine {
            self.advance()?;
        }
        Ok(())
    }

    /// True when the next token that is no line's end is `sign`; at the file's end an error.
    pub(super) fn at_sign(&mut self, sign: u8) -> Parsed<bool> {
        self.skip_lines()?;
        match self.token {
            Token::End => {
                Err(format!("the file ends where `{}` was expected: it is cut short, so copy or export it again", char::from(sign)))
            }
            _ => Ok(self.token == Token::Sign(sign)),
        }
    }

    pub(super) fn expect(&mut self, sign: u8) -> Parsed {
        if self.at_sign(sign)? { self.advance() } else { Err(self.unexpected(&format!("`{}`", char::from(sign)))) }
    }

    /// The comma between elements, which may be absent before `close`.
    pub(super) fn comma(&mut self, close: u8) -> Parsed {
        if self.at_sign(b',')? {
            return self.advance();
        }
        if self.at_sign(close)? { Ok(()) } else { Err(self.unexpected(&format!("`,` or `{}`", char::from(close)))) }
    }

    /// Message about an unexpected next token.
    pub(super) fn unexpected(&self, expected: &str) -> String {
        format!("found {}, expected {expected}; correct the file or export it again", self.token.named())
    }

    /// A name, quoted or not.
    pub(super) fn key(&mut self, expected: &str) -> Parsed<String> {
        self.skip_lines()?;
        let key = match &self.token {
            Token::Word(w) => (*w).to_string(),
            Token::Text(t) => t.clone(),
            Token::Number(n) => n.to_string(),
            _ => return Err(self.unexpected(expected)),
        };
        self.advance()?;
        Ok(key)
    }

    /// Passes over brackets and what is between them.
    pub(super) fn skip_brackets(&mut self) -> Parsed {
        let mut open = 0usize;
        loop {
            match self.token {
                Token::Sign(b'(' | b'[' | b'{') => open += 1,
                Token::Sign(b')' | b']' | b'}') => open = open.saturating_sub(1),
                Token::End => return Err("the file ends within brackets: it is cut short, so copy or export it again".into()),
                _ => (),
            }
            self.advance()?;
            if open == 0 {
                return Ok(());
            }
        }
    }

    /// Reads the whole file, after its first line.
    pub(super) fn file(&mut self) -> Parsed {
        self.skip_lines()?;
        let mut fields = Fields::new();
        if self.token == Token::Sign(b'(') {
            self.metadata(&mut fields)?;
        }
        self.block("/", &mut fields, Token::End)?;
        self.layer.specs.insert("/".into(), fields);
        Ok(())
    }

    /// Parses the text between the braces of a prim or variant, or of the file.
    fn block(&mut self, path: &str, fields: &mut Fields, end: Token) -> Parsed {
        loop {
            self.skip_lines()?;
            if self.token == end {
                return self.advance();
            }
            match &self.token {
                Token::Word("def" | "over" | "class") => self.prim(path, fields)?,
                Token::Word("variantSet") => self.variant_set(path)?,
                Token::Word("reorder") => {
                    self.advance()?;
                    self.key("what is reordered")?;
                    if matches!(self.token, Token::Word(_)) {
                        self.advance()?;
                    }
                    self.expect(b'=')?;
                    self.items()?;
                }
                Token::Sign(b';') => self.advance()?,
                Token::Word(_) => self.property(path, fields)?,
                Token::End => return Err("the file ends inside of a prim: it is cut short, so copy or export it again".into()),
                _ => return Err(self.unexpected("a prim (def, over, class) or a property")),
            }
        }
    }

    fn prim(&mut self, parent: &str, parent_fields: &mut Fields) -> Parsed {
        let specifier = match self.token {
            Token::Word("def") => 0.0,
            Token::Word("over") => 1.0,
            _ => 2.0,
        };
        self.advance()?;
        let mut fields: Fields = vec![(field::SPECIFIER.into(), Value::number(specifier))];
        if let Token::Word(kind) = self.token {
            fields.push((field::TYPE.into(), Value::text(kind)));
            self.advance()?;
        }
        let Token::Text(name) = &self.token else { return Err(self.unexpected("the prim's name in quotes")) };
        let name = name.clone();
        if name.is_empty() || name.contains(['/', '.', '{', '}', '<', '>']) {
            return Err(format!("found {name:?} as the name of a prim, expected letters, digits and `_`; rename it"));
        }
        self.advance()?;
        add_name(parent_fields, field::CHILDREN, &name);
        let path = child_path(parent, &name);
        let own = child_path(&self.prim, &name);
        let around = std::mem::replace(&mut self.prim, own);
        self.enter(&path)?;
        self.body(path, fields)?;
        self.depth -= 1;
        self.prim = around;
        Ok(())
    }

    fn enter(&mut self, path: &str) -> Parsed {
        self.depth += 1;
        if self.depth > MAX_DEPTH || path.len() > MAX_PATH {
            return Err(format!("prims are nested more than {MAX_DEPTH} deep, or their path is too long; the file is damaged"));
        }
        Ok(())
    }

    /// Metadata and braces of a prim or variant.
    fn body(&mut self, path: String, mut fields: Fields) -> Parsed {
        self.skip_lines()?;
        if self.token == Token::Sign(b'(') {
            self.metadata(&mut fields)?;
        }
        self.expect(b'{')?;
        self.block(&path, &mut fields, Token::Sign(b'}'))?;
        self.layer.specs.insert(path, fields);
        Ok(())
    }

    fn variant_set(&mut self, path: &str) -> Parsed {
        self.advance()?;
        let set = self.key("the name of a variant set")?;
        self.expect(b'=')?;
        self.expect(b'{')?;
        while !self.at_sign(b'}')? {
            let name = self.key("the name of a variant")?;
            let variant = format!("{path}{{{set}={name}}}");
            self.enter(&variant)?;
            self.body(variant, Fields::new())?;
            self.depth -= 1;
        }
        self.advance()
    }

    fn property(&mut self, prim: &str, prim_fields: &mut Fields) -> Parsed {
        let mut edit = None;
        let mut kind = String::new();
        let mut name = String::new();
        // Words up to `=`, a bracket or the line's end: edits, keywords, the type, and last the name.
        while let Token::Word(word) = self.token {
            match word {
                "custom" | "uniform" | "varying" | "config" => (),
                "prepend" | "append" | "add" | "delete" | "reorder" if edit.is_none() && kind.is_empty() => edit = Some(word),
                _ if kind.is_empty() => kind = word.to_string(),
                _ => name = word.to_string(),
            }
            self.advance()?;
            if self.token == Token::Sign(b'[') && name.is_empty() {
                self.advance()?;
                self.expect(b']')?;
            }
        }
        if name.is_empty() {
            return Err(self.unexpected("the name of a property after its type"));
        }
        let (base, facet) = name.split_once('.').unwrap_or((&name, ""));
        let path = property_path(prim, base);
        let mut fields = self.layer.specs.remove(&path).unwrap_or_default();
        add_name(prim_fields, field::PROPERTIES, base);
        if self.token == Token::Sign(b'=') {
            self.advance()?;
            match (kind.as_str(), facet) {
                ("rel", _) | (_, "connect") => {
                    let items = self.items()?;
                    let list = if kind == "rel" { field::TARGETS } else { field::CONNECTIONS };
                    add_edit(&mut fields, list, edit, items);
                }
                (_, "timeSamples") => fields.push((field::SAMPLES.into(), self.samples()?)),
                (_, "") => {
                    let value = self.value()?;
                    fields.push((field::DEFAULT.into(), value));
                }
                _ => {
                    self.skip_lines()?;
                    self.skip_brackets()?;
                    fields.push((facet.into(), Value::Other("spline")));
                }
            }
        }
        if self.token == Token::Sign(b'(') {
            self.metadata(&mut fields)?;
        }
        if kind != "rel" {
            fields.push((field::TYPE.into(), Value::text(&kind)));
        }
        self.layer.specs.insert(path, fields);
        Ok(())
    }

    /// `{ time: value, … }`.
    fn samples(&mut self) -> Parsed<Value> {
        self.expect(b'{')?;
        let mut all = Vec::new();
        while !self.at_sign(b'}')? {
            let Token::Number(time) = self.token else { return Err(self.unexpected("the time of a sample")) };
            self.advance()?;
            self.expect(b':')?;
            all.push((time, self.value()?));
            self.comma(b'}')?;
        }
        self.advance()?;
        Ok(Samples::of(all).map_or(Value::Block, |samples| Value::Samples(Rc::new(samples))))
    }

    /// The offset and scale of time in the brackets behind an asset path, which are passed over.
    pub(super) fn retiming(&mut self) -> Parsed<Retiming> {
        let (mut offset, mut scale, mut open) = (0.0, 1.0, 0usize);
        loop {
            let mut word = None;
            match self.token {
                Token::Sign(b'(' | b'[' | b'{') => open += 1,
                Token::Sign(b')' | b']' | b'}') => open = open.saturating_sub(1),
                Token::Word(name @ ("offset" | "scale")) if open == 1 => word = Some(name),
                Token::End => return Err("the file ends within brackets: it is cut short, so copy or export it again".into()),
                _ => (),
            }
            self.advance()?;
            if let (Some(name), Token::Sign(b'=')) = (word, &self.token) {
                self.advance()?;
                let Token::Number(number) = self.token else { return Err(self.unexpected("a number")) };
                *(if name == "offset" { &mut offset } else { &mut scale }) = number;
                self.advance()?;
            }
            if open == 0 {
                return Ok(Retiming::new(offset, scale));
            }
        }
    }
}

/// Adds a name to an array of them, once.
fn add_name(fields: &mut Fields, list: &str, name: &str) {
    match fields.iter_mut().find(|(n, _)| &**n == list) {
        Some((_, Value::Texts { data, .. })) => {
            if !(list == field::PROPERTIES && data.iter().any(|n| &**n == name)) {
                Rc::make_mut(data).push(Rc::from(name));
            }
        }
        _ => fields.push((list.into(), Value::texts([Rc::from(name)]))),
    }
}

/// Adds an edit of a list; several edits of one list are kept together.
pub(super) fn add_edit(fields: &mut Fields, list: &str, edit: Option<&str>, items: Vec<Item>) {
    let at = fields.iter().position(|(n, _)| &**n == list).unwrap_or_else(|| {
        fields.push((list.into(), Value::List(Rc::new(ListEdit::default()))));
        fields.len() - 1
    });
    let Value::List(edits) = &mut fields[at].1 else { return };
    let edits = Rc::make_mut(edits);
    match edit {
        None => edits.explicit = Some(items),
        Some("prepend") => edits.prepended = items,
        Some("delete") => edits.deleted = items,
        Some("reorder") => (),
        _ => edits.appended = items,
    }
}
