//! Values in crate files: within eight bytes, or at a place in the file.

use super::cursor::{Checked, Cursor, index, unpacked_limit};
use super::numbers::{Kind, SHORTEST_PACKED, layout, packed_numbers, plain_numbers};
use crate::usd::time::Retiming;
use crate::usd::value::{Item, ListEdit, Numbers, Samples, Value};
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

const IS_ARRAY: u64 = 1 << 63;
const IS_INLINED: u64 = 1 << 62;
const IS_PACKED: u64 = 1 << 61;
const PAYLOAD: u64 = (1 << 48) - 1;

/// Values are nested no deeper than this.
const MAX_NESTING: usize = 32;

/// The values of a file, each read once.
pub(super) struct Values<'a> {
    bytes: &'a [u8],
    version: [u8; 3],
    tokens: &'a [Rc<str>],
    strings: &'a [Rc<str>],
    paths: &'a [Rc<str>],
    known: HashMap<u64, Value>,
    /// Bytes that values may still take.
    budget: u64,
}

impl<'a> Values<'a> {
    pub(super) fn new(bytes: &'a [u8], version: [u8; 3], tokens: &'a [Rc<str>], strings: &'a [Rc<str>], paths: &'a [Rc<str>]) -> Self {
        let budget = unpacked_limit(bytes.len() as u64);
        Self { bytes, version, tokens, strings, paths, known: HashMap::new(), budget }
    }

    /// The value that eight bytes represent.
    pub(super) fn get(&mut self, rep: u64) -> Checked<Value> {
        self.nested(rep, 0)
    }

    fn nested(&mut self, rep: u64, depth: usize) -> Checked<Value> {
        if let Some(known) = self.known.get(&rep) {
            return Ok(known.clone());
        }
        let at = if rep & IS_INLINED == 0 { rep & PAYLOAD } else { 0 };
        let c = Cursor { bytes: self.bytes, at: at.min(self.bytes.len() as u64) };
        if depth > MAX_NESTING {
            return c.error("values are nested too deeply; the file is damaged");
        }
        let kind = (rep >> 48 & 0xff) as u8;
        // Before reading, so that a value that refers to itself ends the search.
        self.charge(64, &c)?;
        let value = if rep & IS_ARRAY != 0 {
            self.array(rep, kind, c)?
        } else if rep & IS_INLINED != 0 {
            self.inlined(rep, kind, &c)?
        } else {
            self.stored(kind, c, depth)?
        };
        self.charge(value.bytes(), &c)?;
        self.known.insert(rep, value.clone());
        Ok(value)
    }

    fn charge(&mut self, bytes: u64, at: &Cursor) -> Checked<()> {
        match self.budget.checked_sub(bytes) {
            Some(left) => self.budget = left,
            None => return at.error("the values take far more memory than the file; it is damaged, or packed to do harm"),
        }
        Ok(())
    }

    /// A value within its eight bytes.
    fn inlined(&self, rep: u64, kind: u8, c: &Cursor) -> Checked<Value> {
        let payload = (rep & PAYLOAD) as u32;
        let bytes = payload.to_le_bytes();
        let small = |i: usize| f64::from(bytes.get(i).copied().unwrap_or(0) as i8);
        let token = |table: &[Rc<str>]| index(table, i64::from(payload), "token", c).map(|t| Value::text(t));
        Ok(match kind {
            5 => Value::number(f64::from(payload as i32)),
            6 => Value::number(f64::from(payload)),
            9 => Value::number(f64::from(f32::from_bits(payload))),
            10 => return token(self.strings),
            11 | 12 => return token(self.tokens),
            13..=15 => {
                let n = usize::from(kind) - 11;
                let matrix = (0..n * n).map(|i| if i / n == i % n { small(i / n) } else { 0.0 }).collect();
                Value::Numbers(Numbers { width: n * n, data: Rc::new(matrix), array: false })
            }
            19..=30 => {
                let n = 2 + usize::from((kind - 19) / 4);
                Value::Numbers(Numbers { width: n, data: Rc::new((0..n).map(small).collect()), array: false })
            }
            31 => Value::Dictionary(Rc::default()),
            42..=44 => Value::number(f64::from(payload)),
            51 => Value::Block,
            _ => match layout(kind) {
                Some((1, number)) if number.size() <= 4 => Value::number(number.number(&bytes[..number.size()])),
                _ => Value::Other("unknown"),
            },
        })
    }

    fn array(&self, rep: u64, kind: u8, mut c: Cursor) -> Checked<Value> {
        if rep & PAYLOAD == 0 {
            return Ok(Value::texts([]));
        }
        if self.version < [0, 5, 0] {
            // The rank, which is always one.
            c.u32()?;
        }
        let here = c;
        let count = if self.version < [0, 7, 0] { u64::from(c.u32()?) } else { c.u64()? };
        let left = c.bytes.len() as u64 - c.at;
        let too_many = |size: u64| count.checked_mul(size).is_none_or(|bytes| bytes > left);
        if let Some(table) = match kind {
            10 => Some(self.strings),
            11 | 12 => Some(self.tokens),
            _ => None,
        } {
            if too_many(4) {
                return here
                    .error(format!("found an array of {count} texts, which is more than the rest of the file holds; the file is damaged"));
            }
            let texts: Checked<Vec<Rc<str>>> =
                (0..count).map(|_| c.u32().and_then(|i| index(table, i64::from(i), "token", &here).cloned())).collect();
            return Ok(Value::texts(texts?));
        }
        let Some((width, number)) = layout(kind) else { return Ok(Value::Other("an array of an unknown type")) };
        let packed = rep & IS_PACKED != 0 && width == 1 && count as usize >= SHORTEST_PACKED;
        if too_many((width * number.size()) as u64) && !(packed && count <= left.saturating_mul(1024) && 8 * count <= self.budget) {
            return here
                .error(format!("found an array of {count} elements, which is more than the rest of the file holds; the file is damaged"));
        }
        let mut data =
            if packed { packed_numbers(&mut c, count as usize, number)? } else { plain_numbers(&mut c, count * width as u64, number)? };
        if matches!(kind, 16..=18) {
            // Stored with the real part last.
            data.as_chunks_mut::<4>().0.iter_mut().for_each(|q| q.rotate_right(1));
        }
        Ok(Value::Numbers(Numbers { width, data: Rc::new(data), array: true }))
    }

    /// A value at a place in the file that is no array.
    fn stored(&mut self, kind: u8, mut c: Cursor, depth: usize) -> Checked<Value> {
        if let Some((width, number)) = layout(kind) {
            let mut data = plain_numbers(&mut c, width as u64, number)?;
            if matches!(kind, 16..=18) {
                data.rotate_right(1);
            }
            return Ok(Value::Numbers(Numbers { width, data: Rc::new(data), array: false }));
        }
        Ok(match kind {
            31 => {
                let mut entries = BTreeMap::new();
                for _ in 0..c.count(12)? {
                    let key = self.string(&mut c)?;
                    let value = self.jump(&mut c, depth)?;
                    entries.insert(key.to_string(), value);
                }
                Value::Dictionary(Rc::new(entries))
            }
            32..=39 | 55 => Value::List(Rc::new(self.list(kind, &mut c)?)),
            40 => Value::texts(self.many(&mut c, Self::path)?),
            41 => Value::texts(self.many(&mut c, Self::token)?),
            50 => Value::texts(self.many(&mut c, Self::string)?),
            45 => {
                let mut selections = BTreeMap::new();
                for _ in 0..c.count(8)? {
                    let set = self.string(&mut c)?;
                    selections.insert(set.to_string(), Value::text(&self.string(&mut c)?));
                }
                Value::Dictionary(Rc::new(selections))
            }
            46 => self.samples(&mut c, depth)?,
            47 => {
                let item = self.reference(&mut c, false)?;
                Value::List(Rc::new(ListEdit { explicit: Some(vec![item]), ..ListEdit::default() }))
            }
            48 => {
                let count = c.count(8)? as u64;
                Value::Numbers(Numbers { width: 1, data: Rc::new(plain_numbers(&mut c, count, Kind::F64)?), array: true })
            }
            // Offset and scale of the time of each sublayer.
            49 => {
                let count = c.count(16)? as u64;
                Value::Numbers(Numbers { width: 2, data: Rc::new(plain_numbers(&mut c, 2 * count, Kind::F64)?), array: true })
            }
            _ => Value::Other("an unknown type"),
        })
    }

    /// The value at a place that is given by its distance. The cursor continues after it.
    fn jump(&mut self, c: &mut Cursor, depth: usize) -> Checked<Value> {
        let mut at = c.jump()?;
        let rep = at.u64()?;
        c.at = at.at;
        self.nested(rep, depth + 1)
    }

    /// Time samples: their times, and the values; of arrays only the first is read where all would take more than half of what is left.
    fn samples(&mut self, c: &mut Cursor, depth: usize) -> Checked<Value> {
        let mut times = c.jump()?;
        let times_rep = times.u64()?;
        let codes = self.nested(times_rep, depth + 1)?;
        let codes = codes.as_numbers(1).unwrap_or(&[]);
        let mut values = times.jump()?;
        let here = values;
        let count = values.count(8)?;
        if count == 0 {
            return Ok(Value::Block);
        }
        if codes.len() != count {
            return here.error(format!("found {count} time samples at {} times; the file is damaged, so export it again", codes.len()));
        }
        let mut all = Vec::with_capacity(count);
        let mut are_read = true;
        for code in codes {
            let rep = values.u64()?;
            if !are_read && rep & IS_ARRAY != 0 {
                all.push((*code, Value::Block));
                continue;
            }
            let value = self.nested(rep, depth + 1)?;
            are_read &= value.bytes().saturating_mul(count as u64) <= self.budget / 2;
            all.push((*code, value));
        }
        let Some(mut samples) = Samples::of(all) else { return Ok(Value::Block) };
        if !are_read {
            samples.values.truncate(1);
        }
        Ok(Value::Samples(Rc::new(samples)))
    }

    fn list(&self, kind: u8, c: &mut Cursor) -> Checked<ListEdit> {
        let header = c.u8()?;
        let mut items = |bit: u8| -> Checked<Option<Vec<Item>>> {
            if header & bit == 0 {
                return Ok(None);
            }
            let count = c.count(4)?;
            (0..count)
                .map(|_| match kind {
                    32 => self.token(c).map(|t| Item::name(&*t)),
                    33 => self.string(c).map(|t| Item::name(&*t)),
                    34 => self.path(c).map(|t| Item::name(&*t)),
                    36 => c.u32().map(|n| Item::name((n as i32).to_string())),
                    37 => c.i64().map(|n| Item::name(n.to_string())),
                    38 => c.u32().map(|n| Item::name(n.to_string())),
                    39 => c.u64().map(|n| Item::name(n.to_string())),
                    _ => self.reference(c, kind == 35),
                })
                .collect::<Checked<Vec<Item>>>()
                .map(Some)
        };
        // In this order: explicit, added, prepended, appended, deleted, ordered.
        let (explicit, added, prepended, appended, deleted) = (items(2)?, items(4)?, items(32)?, items(64)?, items(8)?);
        let mut all_appended = added.unwrap_or_default();
        all_appended.extend(appended.unwrap_or_default());
        Ok(ListEdit {
            explicit: if header & 1 != 0 { Some(explicit.unwrap_or_default()) } else { None },
            prepended: prepended.unwrap_or_default(),
            appended: all_appended,
            deleted: deleted.unwrap_or_default(),
        })
    }

    /// A reference, or a payload, which has no custom data and until 0.8 no offset of time.
    fn reference(&self, c: &mut Cursor, has_data: bool) -> Checked<Item> {
        let (asset, path) = (self.string(c)?, self.path(c)?);
        let mut retiming = Retiming::default();
        if has_data || self.version >= [0, 8, 0] {
            retiming = Retiming::new(c.f64()?, c.f64()?);
        }
        if has_data {
            for _ in 0..c.count(12)? {
                c.u32()?;
                let mut at = c.jump()?;
                at.u64()?;
                c.at = at.at;
            }
        }
        // The layer's root means "no path" in references to the default prim.
        let path = if &*path == "/" { "" } else { &*path };
        Ok(Item { asset: asset.to_string(), path: path.to_string(), retiming })
    }

    fn many(&self, c: &mut Cursor, one: fn(&Self, &mut Cursor) -> Checked<Rc<str>>) -> Checked<Vec<Rc<str>>> {
        let count = c.count(4)?;
        (0..count).map(|_| one(self, c)).collect()
    }

    fn token(&self, c: &mut Cursor) -> Checked<Rc<str>> {
        let i = c.u32()?;
        index(self.tokens, i64::from(i), "token", c).cloned()
    }

    fn string(&self, c: &mut Cursor) -> Checked<Rc<str>> {
        let i = c.u32()?;
        index(self.strings, i64::from(i), "string", c).cloned()
    }

    fn path(&self, c: &mut Cursor) -> Checked<Rc<str>> {
        let i = c.u32()?;
        index(self.paths, i64::from(i), "path", c).cloned()
    }
}
