//! usdc: the binary encoding ("crate"), versions 0.4 to 0.13.
//!
//! Sections contain tokens, strings, fields (a name and the position of its value), sets of fields, paths as a tree, and specs, which join
//! a path and a set of fields. Values are read once however many specs share them, so that what a file unpacks to stays in proportion to
//! its size. The layout follows OpenUSD's `crateFile.cpp`.

mod cursor;
mod numbers;
mod values;

use super::layer::{Layer, MAX_PATH, child_path, property_path};
use cursor::{Checked, Cursor, index, unpacked_limit};
use std::collections::HashMap;
use std::rc::Rc;
use values::Values;

/// The first bytes of every crate file.
pub(super) const MAGIC: &[u8] = b"PXR-USDC";

/// Terminator of a set of fields.
const END_OF_SET: i64 = -1;

/// Reads a layer from the bytes of a crate file.
///
/// # Errors
/// The byte, and the fault there.
pub(super) fn parse(bytes: &[u8]) -> Result<Layer, (String, String)> {
    read(bytes).map_err(|(byte, problem)| (format!("byte {byte}"), problem))
}

fn read(bytes: &[u8]) -> Checked<Layer> {
    let mut head = Cursor { bytes, at: MAGIC.len() as u64 };
    let version = head.take(8)?;
    let version = [version[0], version[1], version[2]];
    if version < [0, 4, 0] || version[0] > 0 {
        let [a, b, c] = version;
        head.at = MAGIC.len() as u64;
        return head.error(format!(
            "found version {a}.{b}.{c} of usdc, expected 0.4 to 0.13; write the file again with a current USD (usdcat -o)"
        ));
    }
    let sections = Sections::read(bytes, head.u64()?)?;
    let tokens = tokens(sections.get("TOKENS")?)?;
    let strings = strings(sections.get("STRINGS")?, &tokens)?;
    let paths = paths(sections.get("PATHS")?, &tokens)?;
    let fields = fields(sections.get("FIELDS")?, &tokens)?;
    let sets = field_sets(sections.get("FIELDSETS")?)?;
    let mut values = Values::new(bytes, version, &tokens, &strings, &paths);
    let mut layer = Layer::default();
    let mut specs = sections.get("SPECS")?;
    let count = packed_count(&mut specs)?;
    let (path_of, set_of) = (specs.integers(count, false)?, specs.integers(count, false)?);
    for (path, set) in path_of.into_iter().zip(set_of) {
        let path = index(&paths, path, "path", &specs)?;
        let mut set_fields = Vec::new();
        for &field in sets.get(usize::try_from(set).unwrap_or(usize::MAX)..).unwrap_or(&[]).iter().take_while(|f| **f != END_OF_SET) {
            let (name, rep) = index(&fields, field, "field", &specs)?;
            set_fields.push((name.clone(), values.get(*rep)?));
        }
        layer.specs.insert(path.to_string(), set_fields);
    }
    Ok(layer)
}

/// Number of things in a packed section. Each takes two bits at least, and packing gains no more than 256 times.
fn packed_count(c: &mut Cursor) -> Checked<usize> {
    let here = *c;
    let count = c.u64()?;
    if count > (c.bytes.len() as u64).saturating_mul(1024) {
        return here.error(format!("found a count of {count}, which is more than the file can hold; the file is damaged"));
    }
    Ok(count as usize)
}

struct Sections<'a> {
    bytes: &'a [u8],
    at: HashMap<String, u64>,
}

impl<'a> Sections<'a> {
    fn read(bytes: &'a [u8], at: u64) -> Checked<Self> {
        let mut c = Cursor { bytes, at };
        let count = c.count(32)?;
        let mut sections = HashMap::new();
        for _ in 0..count {
            let name = c.take(16)?;
            let name = name.split(|b| *b == 0).next().unwrap_or_default();
            sections.insert(String::from_utf8_lossy(name).into_owned(), c.u64()?);
            c.u64()?;
        }
        Ok(Self { bytes, at: sections })
    }

    fn get(&self, name: &str) -> Checked<Cursor<'a>> {
        match self.at.get(name) {
            Some(&at) => Ok(Cursor { bytes: self.bytes, at }),
            None => Err((16, format!("there is no section {name}; the file is damaged, so export it again"))),
        }
    }
}

fn tokens(mut c: Cursor) -> Checked<Vec<Rc<str>>> {
    let here = c;
    let (count, unpacked, packed) = (c.u64()?, c.u64()?, c.count(1)?);
    let text = c.unpack(packed as u64, unpacked)?;
    let tokens: Vec<Rc<str>> =
        text.split(|b| *b == 0).map(|t| Rc::from(String::from_utf8_lossy(t))).take(count.min(text.len() as u64) as usize).collect();
    if tokens.len() as u64 != count {
        return here.error(format!("{count} tokens were expected, but only {} are there; the file is damaged", tokens.len()));
    }
    Ok(tokens)
}

fn strings(mut c: Cursor, tokens: &[Rc<str>]) -> Checked<Vec<Rc<str>>> {
    let count = c.count(4)?;
    (0..count).map(|_| c.u32().and_then(|t| index(tokens, i64::from(t), "token", &c).cloned())).collect()
}

/// Names of fields, and where their values are.
fn fields(mut c: Cursor, tokens: &[Rc<str>]) -> Checked<Vec<(Rc<str>, u64)>> {
    let count = packed_count(&mut c)?;
    let names = c.integers(count, false)?;
    let packed = c.count(1)? as u64;
    let here = c;
    let reps = c.unpack(packed, 8 * count as u64)?;
    if reps.len() != 8 * count {
        return here.error(format!("{count} values were expected, but only {} are there; the file is damaged", reps.len() / 8));
    }
    let reps = reps.as_chunks::<8>().0.iter().map(|b| u64::from_le_bytes(*b));
    names.into_iter().zip(reps).map(|(name, rep)| Ok((index(tokens, name, "token", &here)?.clone(), rep))).collect()
}

fn field_sets(mut c: Cursor) -> Checked<Vec<i64>> {
    let count = packed_count(&mut c)?;
    c.integers(count, false)
}

/// The paths: a tree in the order of a walk through it, depth first. One that the tree leaves out is empty, as are those of references
/// to a default prim.
fn paths(mut c: Cursor, tokens: &[Rc<str>]) -> Checked<Vec<Rc<str>>> {
    let here = c;
    let count = packed_count(&mut c)?;
    let encoded = packed_count(&mut c)?;
    // Long paths of many prims could otherwise take far more memory than the file.
    let mut budget = unpacked_limit(c.bytes.len() as u64);
    if count as u64 > budget / 16 {
        return here.error(format!("found {count} paths, which is more than the file can hold; the file is damaged"));
    }
    let (indices, elements, jumps) = (c.integers(encoded, false)?, c.integers(encoded, false)?, c.integers(encoded, false)?);
    let root: Rc<str> = Rc::from("/");
    let mut paths = vec![Rc::from(""); count];
    let mut visits: Vec<(usize, Option<Rc<str>>)> = if encoded > 0 { vec![(0, None)] } else { Vec::new() };
    let mut seen = vec![false; encoded];
    while let Some((at, parent)) = visits.pop() {
        if at >= encoded || std::mem::replace(&mut seen[at], true) {
            return here.error("the tree of paths leads out of itself or in a circle; the file is damaged, so export it again");
        }
        let path = match &parent {
            None => root.clone(),
            Some(parent) => {
                let name = index(tokens, elements[at].abs(), "token", &here)?;
                Rc::from(if elements[at] < 0 {
                    property_path(parent, name)
                } else if name.starts_with('{') {
                    format!("{parent}{name}")
                } else {
                    child_path(parent, name)
                })
            }
        };
        budget = budget.saturating_sub(path.len() as u64 + 16);
        if path.len() > MAX_PATH || budget == 0 {
            return here.error("paths are longer than any scene's; the file is damaged, so export it again");
        }
        let slot = usize::try_from(indices[at]).ok().and_then(|i| paths.get_mut(i));
        *slot.ok_or_else(|| (here.at, format!("found path {}, but there are only {count}; the file is damaged", indices[at])))? =
            path.clone();
        let jump = jumps[at];
        // 0: only a sibling, which is next. −1: only a child, which is next. Positive: a child next, and a sibling so far ahead.
        if jump >= 0 {
            visits.push((at.saturating_add(if jump == 0 { 1 } else { jump as usize }), parent));
        }
        if jump > 0 || jump == -1 {
            visits.push((at + 1, Some(path)));
        }
    }
    Ok(paths)
}
