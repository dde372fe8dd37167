//! Metadata in usda: the text in parentheses after the layer, a prim, or a property.

use super::lexer::Token;
use super::parser::{Parsed, Parser, add_edit};
use crate::usd::layer::{Fields, field};
use crate::usd::value::{Item, Numbers, Value};
use std::rc::Rc;

impl Parser<'_> {
    /// `( key = value … )`.
    pub(super) fn metadata(&mut self, fields: &mut Fields) -> Parsed {
        self.advance()?;
        while !self.at_sign(b')')? {
            match &self.token {
                Token::Sign(b';' | b',') | Token::Text(_) => {
                    self.advance()?;
                    continue;
                }
                _ => (),
            }
            let mut key = self.key("a name of metadata")?;
            let edit = ["prepend", "append", "add", "delete", "reorder"].into_iter().find(|e| *e == key);
            if edit.is_some() && self.token != Token::Sign(b'=') {
                key = self.key("a name of metadata")?;
            }
            self.expect(b'=')?;
            self.metadatum(&key, edit, fields)?;
        }
        self.advance()
    }

    fn metadatum(&mut self, key: &str, edit: Option<&str>, fields: &mut Fields) -> Parsed {
        let list = match key {
            "references" => Some(field::REFERENCES),
            "payload" => Some(field::PAYLOAD),
            "inherits" => Some(field::INHERITS),
            "specializes" => Some(field::SPECIALIZES),
            "variantSets" => Some(field::VARIANT_SETS),
            "apiSchemas" => Some(field::SCHEMAS),
            "subLayers" => Some(field::SUBLAYERS),
            _ => None,
        };
        if let Some(list) = list {
            let items = self.items()?;
            // The offset of time of a reference within the layer.
            if self.token == Token::Sign(b'(') {
                self.skip_brackets()?;
            }
            if list == field::SUBLAYERS {
                let offsets = items.iter().flat_map(|i| [i.retiming.offset, i.retiming.scale]).collect();
                let offsets = Numbers { width: 2, data: Rc::new(offsets), array: true };
                fields.push((field::SUBLAYER_OFFSETS.into(), Value::Numbers(offsets)));
                fields.push((list.into(), Value::texts(items.into_iter().map(|i| Rc::from(i.asset)))));
            } else {
                add_edit(fields, list, edit, items);
            }
            return Ok(());
        }
        // A list of numbers, whose items binary layers name alike.
        if key == "inactiveIds" {
            let ids = self.value()?;
            let items = ids.as_numbers(1).unwrap_or_default().iter().map(|id| Item::name(id.to_string())).collect();
            add_edit(fields, key, edit, items);
            return Ok(());
        }
        // Their keys are paths.
        if key == "relocates" {
            self.skip_lines()?;
            self.skip_brackets()?;
            fields.push((key.into(), Value::Other("relocates")));
            return Ok(());
        }
        let value = self.value()?;
        let name = if key == "variants" { field::VARIANTS } else { key };
        fields.push((name.into(), value));
        Ok(())
    }
}
